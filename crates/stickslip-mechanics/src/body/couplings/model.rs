//! What a kind of coupling says.

use super::definition::Tie;
use super::row::Row;
use crate::body::Space;
use crate::error::Diagnostic;
use crate::math::Vec3;
use crate::mesh::{FacetRef, Mesh, select};
use crate::system::{Component, Dofs, Link, Links};

/// The points that couplings tie together: those of the mesh, and behind them the reference points.
#[derive(Clone, Copy)]
pub struct Ground<'a> {
    /// The mesh of all bodies.
    pub mesh: &'a Mesh,
    /// Its space.
    pub space: Space,
    /// Rigid bodies and reference points.
    pub links: &'a Links,
}

impl Ground<'_> {
    /// Displacements a point.
    pub fn dim(&self) -> usize {
        self.space.dim()
    }

    /// The numbering of dofs, reference points counted.
    pub fn dofs(&self) -> Dofs {
        self.links.dofs()
    }

    /// The reference point that a point is; `None` for points of the mesh.
    pub fn reference(&self, point: usize) -> Option<&Link> {
        Some(&self.links.all()[self.links.of_hidden(point)?])
    }

    /// Where a point is `[m]`.
    pub fn place(&self, point: usize) -> Vec3 {
        self.reference(point)
            .map_or_else(|| self.mesh.points[point], |link| link.centre)
    }

    /// The facets that a set of the mesh brings along, or those of the boundary all of whose points are these.
    pub fn facets(&self, set: &str, points: &[usize]) -> Vec<FacetRef> {
        match self.mesh.facet_sets.get(set) {
            Some(facets) if !facets.is_empty() => facets.clone(),
            _ => select::boundary_within(self.mesh, points),
        }
    }

    /// The dof of a motion of a point as `(point, component)`, and how much of the motion one unit of it is.
    ///
    /// # Errors
    /// If the space has no such direction, or the point cannot turn.
    pub fn term(&self, point: usize, component: Component) -> Result<(usize, usize, f64), String> {
        let (index, dim) = (component as usize, self.dim());
        if index < 3 {
            return match index < dim {
                true => Ok((point, index, 1.0)),
                false => Err("a displacement along z in a plane model".into()),
            };
        }
        let Some(link) = self.reference(point) else {
            return Err("only reference points have rotations".into());
        };
        let Some(dof) = link.dof(self.dofs(), component.motion()) else {
            return Err(format!("there is no {} in this space", component.motion()));
        };
        let (point, slot) = self.dofs().locate(dof);
        Ok((point, slot, 1.0 / link.length))
    }
}

/// A kind of coupling.
pub trait CouplingModel {
    /// The sets of points it names, each with the key below that of the coupling.
    fn sets(&self) -> Vec<(String, &str)>;

    /// One row for every tuple of points, the `k`-th of each set; a set of one point pairs with all of the others. `points` holds those of each of
    /// [`sets`](CouplingModel::sets), ascending; of a reference point that of its translation.
    ///
    /// # Errors
    /// Sets that cannot be paired, directions that the space has not, or rows without meaning.
    fn rows(&self, points: &[Vec<usize>], ground: Ground) -> Result<Vec<Row>, Diagnostic>;

    /// What the rows do.
    fn tie(&self) -> Tie;

    /// The reference point it belongs to.
    fn reference(&self) -> Option<&str> {
        None
    }

    /// Whether each row says what a motion of the reference point is, given those of the points.
    fn leads(&self) -> bool {
        false
    }
}

/// The tuples of points that sets of `n` or of one point make.
pub(super) fn pair(
    points: &[Vec<usize>],
    keys: &[(String, &str)],
) -> Result<Vec<Vec<usize>>, Diagnostic> {
    let most = points.iter().map(Vec::len).max().unwrap_or(0);
    for (list, (key, name)) in points.iter().zip(keys) {
        if list.len() != 1 && list.len() != most {
            return Err(Diagnostic::new(
                key,
                format!(
                    "`{name}` has {} points, another set of the coupling {most}",
                    list.len()
                ),
            )
            .help("sets of a coupling have as many points as each other, or one"));
        }
    }
    let of = |k: usize| {
        points
            .iter()
            .map(move |l| l[if l.len() == 1 { 0 } else { k }])
    };
    Ok((0..most).map(|k| of(k).collect()).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sets_are_paired_in_order_and_a_single_point_with_all() {
        let keys = vec![("a".to_string(), "A"), ("b".to_string(), "B")];
        let pairs = pair(&[vec![3, 5, 8], vec![1]], &keys).unwrap();
        assert_eq!(pairs, [[3, 1], [5, 1], [8, 1]]);
        let pairs = pair(&[vec![3, 5], vec![1, 2]], &keys).unwrap();
        assert_eq!(pairs, [[3, 1], [5, 2]]);
        let error = pair(&[vec![3, 5, 8], vec![1, 2]], &keys).unwrap_err();
        assert_eq!(error.key, "b");
    }
}

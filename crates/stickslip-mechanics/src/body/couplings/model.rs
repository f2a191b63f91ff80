//! What a kind of coupling says.

use super::all::Tie;
use super::row::Row;
use crate::error::Diagnostic;
use crate::mesh::Mesh;

/// A kind of coupling.
pub trait CouplingModel {
    /// The sets of points it names, each with the key below that of the coupling.
    fn sets(&self) -> Vec<(String, &str)>;

    /// One row for every tuple of points, the `k`-th of each set; a set of one point pairs with all of the others. `points` holds those of each of
    /// [`sets`](CouplingModel::sets), ascending, `dim` is that of the space.
    ///
    /// # Errors
    /// Sets that cannot be paired, directions that the space has not, or rows without meaning.
    fn rows(&self, points: &[Vec<usize>], mesh: &Mesh, dim: usize) -> Result<Vec<Row>, Diagnostic>;

    /// What the rows do.
    fn tie(&self) -> Tie;
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

//! Stress at a single point without that of the whole body.

use std::sync::Arc;

use super::{At, Elastic, Part};
use crate::body::fields;
use crate::mesh::{CellRef, combine};
use crate::system::Dofs;

/// The cells of a body that meet at a point, as a body of their own.
#[derive(Debug, Clone)]
pub struct Around {
    elastic: Elastic,
    /// Points of the whole mesh, in the order of the part.
    points: Vec<usize>,
    /// Where the point is among them.
    at: usize,
}

/// What is needed for the stress at a point of the mesh; `None` if the body does not have it.
pub fn around(body: &Elastic, point: usize) -> Option<Around> {
    let mut cells = Vec::new();
    for part in &body.parts {
        let block = &body.mesh.blocks[part.block];
        let nodes = block.connectivity.chunks_exact(block.kind.node_count());
        let here = nodes.enumerate().filter(|(_, n)| n.contains(&point));
        cells.extend(here.map(|(cell, _)| CellRef {
            block: part.block,
            cell,
        }));
    }
    // the order in which `extract` takes them
    cells.sort_unstable();
    let points = body.mesh.points_of_cells(&cells);
    let at = points.binary_search(&point).ok()?;
    let mesh = combine::extract(&body.mesh, &cells);
    let mut blocks: Vec<usize> = cells.iter().map(|c| c.block).collect();
    blocks.dedup();
    let parts = blocks.iter().enumerate().filter_map(|(block, old)| {
        let part = body.parts.iter().find(|p| p.block == *old)?;
        let own = cells.iter().filter(|c| c.block == *old);
        let graded = part.cells.as_ref();
        let graded = graded.map(|all| own.map(|c| all[c.cell]).collect::<Vec<_>>());
        Some(Part {
            block,
            cells: graded.map(Arc::new),
            ..part.clone()
        })
    });
    let parts = parts.collect();
    let elastic = Elastic::new(
        body.name.clone(),
        Arc::new(mesh),
        body.space,
        body.formulation,
        parts,
    );
    let elastic = elastic.ok()?;
    Some(Around {
        elastic: match &body.temperatures {
            None => elastic,
            Some(all) => elastic.heated(Arc::new(all.extract(&points))),
        },
        points,
        at,
    })
}

impl Around {
    /// Stress at the point `[Pa]`, the same as [`nodal_stress`](super::fields::nodal_stress) has there, at displacements of the whole mesh.
    pub fn stress<'a>(&self, dofs: Dofs, at: impl Into<At<'a>>) -> [f64; 6] {
        let At { u, warm } = at.into();
        let own: Vec<f64> = self
            .points
            .iter()
            .flat_map(|&p| u[dofs.of(p, 0)..dofs.of(p, 0) + dofs.dim].iter().copied())
            .collect();
        fields::nodal_stress(&self.elastic, At { u: &own, warm })[self.at]
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing;
    use super::around;
    use crate::body::fields;
    use crate::system::Dofs;

    #[test]
    fn the_stress_is_that_of_the_whole_body() {
        for (kind, space, formulation) in testing::combinations() {
            let body = testing::patch(kind, space, formulation);
            let dofs = Dofs {
                dim: space.dim(),
                points: body.mesh().points.len(),
            };
            let u = testing::noise(dofs.count());
            let whole = fields::nodal_stress(&body, &u);
            for (&p, wanted) in body.points().iter().zip(&whole) {
                let around = around(&body, p).expect("a point of the body");
                assert_eq!(around.stress(dofs, &u), *wanted, "{kind:?} {space:?}");
            }
            assert!(around(&body, dofs.points).is_none());
        }
    }
}

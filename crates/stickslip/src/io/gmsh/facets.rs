//! Finds the cell faces that surface elements lie on.

use std::collections::HashMap;

use crate::mesh::{CellRef, FacetRef, Mesh};

/// The nodes of a face, sorted; the rest is filled up.
type Key = [usize; 8];

fn key(nodes: impl Iterator<Item = usize>) -> Key {
    let mut key = [usize::MAX; 8];
    for (slot, node) in key.iter_mut().zip(nodes) {
        *slot = node;
    }
    key.sort_unstable();
    key
}

/// The cell faces that have the nodes of given facets, in the order of the cells.
pub(in crate::io) struct Faces {
    owners: HashMap<Key, Vec<FacetRef>>,
}

impl Faces {
    /// Looks for the faces that have exactly the nodes of one of `facets`.
    pub fn of(mesh: &Mesh, facets: &[&[usize]]) -> Faces {
        let mut owners: HashMap<Key, Vec<FacetRef>> = HashMap::new();
        let mut near = vec![false; mesh.points.len()];
        for facet in facets {
            owners.insert(key(facet.iter().copied()), Vec::new());
            for &node in *facet {
                if let Some(near) = near.get_mut(node) {
                    *near = true;
                }
            }
        }
        for (block, cells) in mesh.blocks.iter().enumerate() {
            let faces = cells.kind.reference().faces();
            let cell_nodes = cells.connectivity.chunks_exact(cells.kind.node_count());
            for (cell, nodes) in cell_nodes.enumerate() {
                for (face, local) in faces.iter().enumerate() {
                    // Most faces are nowhere near a facet: do not hash them.
                    if !near[nodes[local.nodes[0]]] {
                        continue;
                    }
                    if let Some(list) = owners.get_mut(&key(local.nodes.iter().map(|&i| nodes[i])))
                    {
                        let cell = CellRef { block, cell };
                        list.push(FacetRef { cell, face });
                    }
                }
            }
        }
        Faces { owners }
    }

    /// The face with these nodes whose outward side is that of the facet (its back, if `reversed`); the first one if that
    /// does not tell.
    pub fn owner(&self, mesh: &Mesh, facet: &[usize], reversed: bool) -> Option<FacetRef> {
        let owners = self.owners.get(&key(facet.iter().copied()))?;
        owners
            .iter()
            .find(|owner| same_side(mesh, owner, facet) != reversed)
            .or(owners.first())
            .copied()
    }
}

/// Whether the facet runs around its corners as the face does.
fn same_side(mesh: &Mesh, owner: &FacetRef, facet: &[usize]) -> bool {
    let (kind, face) = mesh.facet_points(*owner);
    let corners = kind.corner_count();
    let at = |i: usize| face[i % corners];
    match (0..corners).find(|&i| at(i) == facet[0]) {
        Some(i) if mesh.dim == 2 => i == 0,
        Some(i) => at(i + 1) == facet[1],
        None => false,
    }
}

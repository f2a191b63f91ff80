//! From cells to points and facets.

use super::{CellRef, FacetRef, Mesh};
use crate::shape::{ElementKind, Face};

/// Corners of a face, sorted and padded: equal for the two cells that share it.
type FaceKey = [usize; 4];

impl Mesh {
    /// The points of a cell, in the order of its reference element.
    ///
    /// # Panics
    /// If the cell does not exist: a `CellRef` of this mesh always does.
    pub fn cell_points(&self, cell: CellRef) -> &[usize] {
        let block = &self.blocks[cell.block];
        let count = block.kind.node_count();
        &block.connectivity[cell.cell * count..(cell.cell + 1) * count]
    }

    /// The kind of a cell.
    pub fn cell_kind(&self, cell: CellRef) -> ElementKind {
        self.blocks[cell.block].kind
    }

    /// The user's number of a cell.
    pub fn cell_id(&self, cell: CellRef) -> u64 {
        self.blocks[cell.block].cell_ids[cell.cell]
    }

    /// Every cell, block by block.
    pub fn cells(&self) -> impl Iterator<Item = CellRef> + '_ {
        self.blocks
            .iter()
            .enumerate()
            .flat_map(|(block, b)| (0..b.cell_ids.len()).map(move |cell| CellRef { block, cell }))
    }

    /// Number of cells.
    pub fn cell_count(&self) -> usize {
        self.blocks.iter().map(|b| b.cell_ids.len()).sum()
    }

    /// The face of the reference element behind a facet.
    fn face(&self, facet: FacetRef) -> &'static Face {
        &self.cell_kind(facet.cell).reference().faces()[facet.face]
    }

    /// The kind of a facet as an element of its own.
    pub fn facet_kind(&self, facet: FacetRef) -> ElementKind {
        self.face(facet).kind
    }

    /// The kind of a facet and its points in the order of that element; its normal (see [`Face`]) points out of the
    /// cell.
    pub fn facet_points(&self, facet: FacetRef) -> (ElementKind, Vec<usize>) {
        let face = self.face(facet);
        let cell = self.cell_points(facet.cell);
        (face.kind, face.nodes.iter().map(|&i| cell[i]).collect())
    }

    /// The points of some facets, sorted, each once.
    pub fn points_of_facets(&self, facets: &[FacetRef]) -> Vec<usize> {
        let mut points: Vec<usize> = facets
            .iter()
            .flat_map(|&facet| self.facet_points(facet).1)
            .collect();
        points.sort_unstable();
        points.dedup();
        points
    }

    /// The points of some cells, sorted, each once.
    pub fn points_of_cells(&self, cells: &[CellRef]) -> Vec<usize> {
        let mut points: Vec<usize> = cells
            .iter()
            .flat_map(|&cell| self.cell_points(cell).iter().copied())
            .collect();
        points.sort_unstable();
        points.dedup();
        points
    }

    /// The points of a named set of facets, sorted; `None` if there is no such set.
    pub fn facet_set_points(&self, name: &str) -> Option<Vec<usize>> {
        Some(self.points_of_facets(self.facet_sets.get(name)?))
    }

    /// The facets that belong to one cell only, sorted by cell and face.
    pub fn boundary(&self) -> Vec<FacetRef> {
        let mut boundary: Vec<FacetRef> = self
            .shared_faces()
            .chunk_by(|a, b| a.0 == b.0)
            .filter(|users| users.len() == 1)
            .map(|users| users[0].1)
            .collect();
        boundary.sort_unstable();
        boundary
    }

    /// Every face of every cell with its corners, those with the same corners next to each other.
    pub(super) fn shared_faces(&self) -> Vec<(FaceKey, FacetRef)> {
        let mut faces = Vec::new();
        for cell in self.cells() {
            let points = self.cell_points(cell);
            for (face, f) in self.cell_kind(cell).reference().faces().iter().enumerate() {
                let mut key = [usize::MAX; 4];
                for (k, &i) in key.iter_mut().zip(&f.nodes[..f.kind.corner_count()]) {
                    *k = points[i];
                }
                key.sort_unstable();
                faces.push((key, FacetRef { cell, face }));
            }
        }
        faces.sort_unstable();
        faces
    }
}

#[cfg(test)]
mod tests {
    use super::super::generators::{Generate, Rectangle};
    use super::*;

    #[test]
    fn the_boundary_of_a_grid_is_its_rim() {
        let mesh = Rectangle::new([0.0, 0.0], [3.0, 2.0], [3, 2])
            .generate()
            .unwrap();
        let boundary = mesh.boundary();
        assert_eq!(boundary.len(), 10);
        assert!(boundary.is_sorted());
        for facet in boundary {
            let (kind, points) = mesh.facet_points(facet);
            assert_eq!(kind, ElementKind::Line2);
            let x = points.iter().map(|&p| mesh.points[p]);
            let same = |axis: usize, value: f64| x.clone().all(|x| x[axis] == value);
            assert!(same(0, 0.0) || same(0, 3.0) || same(1, 0.0) || same(1, 2.0));
        }
        assert_eq!(mesh.facet_set_points("left").map(|p| p.len()), Some(3));
        assert_eq!(mesh.facet_set_points("nowhere"), None);
    }
}

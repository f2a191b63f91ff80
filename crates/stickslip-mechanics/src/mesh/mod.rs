//! Meshes: points, blocks of cells of one kind, named sets, boundary, generators.

mod boundary;
pub mod check;
pub mod combine;
pub mod cut;
pub mod generators;
pub mod geometry;
pub mod select;

pub use combine::Appended;
pub use cut::Cut;

use std::collections::BTreeMap;

use crate::math::Vec3;
use crate::shape::ElementKind;

/// A mesh. Indices are positions (from 0); the numbers the user knows are kept in `point_ids` and `Block::cell_ids`.
#[derive(Debug, Clone, Default, PartialEq, crate::keep::Keep)]
pub struct Mesh {
    /// Dimension of the space: 2 or 3.
    pub dim: usize,
    /// Coordinates, shape `(n, 3)` `[length]`.
    pub points: Vec<Vec3>,
    /// The user's number of each point.
    pub point_ids: Vec<u64>,
    /// Cells of dimension `dim`, in blocks.
    pub blocks: Vec<Block>,
    /// Named sets of points, sorted.
    pub point_sets: BTreeMap<String, Vec<usize>>,
    /// Named sets of cells.
    pub cell_sets: BTreeMap<String, Vec<CellRef>>,
    /// Named sets of boundary facets.
    pub facet_sets: BTreeMap<String, Vec<FacetRef>>,
}

/// Cells of one kind.
#[derive(Debug, Clone, PartialEq, crate::keep::Keep)]
pub struct Block {
    /// Their kind.
    pub kind: ElementKind,
    /// Point indices, `kind.node_count()` a cell.
    pub connectivity: Vec<usize>,
    /// The user's number of each cell.
    pub cell_ids: Vec<u64>,
}

/// A cell: block and position in it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, crate::keep::Keep)]
pub struct CellRef {
    /// Index of the block.
    pub block: usize,
    /// Position in the block.
    pub cell: usize,
}

/// A face of a cell, as in `ReferenceElement::faces`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, crate::keep::Keep)]
pub struct FacetRef {
    /// The cell.
    pub cell: CellRef,
    /// Which of its faces.
    pub face: usize,
}

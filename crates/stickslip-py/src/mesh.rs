//! Meshes from arrays.

use std::collections::{BTreeMap, HashMap};
use std::sync::Arc;

use pyo3::exceptions::{PyIndexError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use stickslip::mesh::{Block, CellRef, FacetRef, check};
use stickslip::results::{seal, unseal};
use stickslip::shape::ElementKind;

use super::errors::raise;

/// Kinds of cells.
const KINDS: [ElementKind; 10] = [
    ElementKind::Tri3,
    ElementKind::Tri6,
    ElementKind::Quad4,
    ElementKind::Quad8,
    ElementKind::Tet4,
    ElementKind::Tet10,
    ElementKind::Wedge6,
    ElementKind::Wedge15,
    ElementKind::Hex8,
    ElementKind::Hex20,
];

/// A mesh for problems.
#[pyclass(frozen)]
pub struct Mesh {
    pub(super) mesh: Arc<stickslip::mesh::Mesh>,
}

/// A named list of cells: block and position.
type Cells = Vec<(usize, usize)>;

#[pymethods]
impl Mesh {
    /// `points`: coordinates, three a point, as little-endian doubles. `cells`: kind and node indices of each block.
    /// `facets`: the number of columns and the node indices of each named list.
    #[new]
    fn new(
        py: Python<'_>,
        dim: usize,
        points: &[u8],
        cells: Vec<(String, Vec<usize>)>,
        point_sets: BTreeMap<String, Vec<usize>>,
        cell_sets: BTreeMap<String, Cells>,
        facet_sets: BTreeMap<String, Vec<(usize, Vec<usize>)>>,
    ) -> PyResult<Self> {
        let points: Vec<[f64; 3]> = doubles(points)
            .chunks_exact(3)
            .map(|x| [x[0], x[1], x[2]])
            .collect();
        let mut blocks = Vec::new();
        let mut next = 1;
        for (kind, connectivity) in cells {
            let Some(kind) = KINDS.iter().find(|k| k.name() == kind) else {
                let known: Vec<&str> = KINDS.iter().map(|k| k.name()).collect();
                return Err(PyValueError::new_err(format!(
                    "there are no cells of kind `{kind}`; known are {}",
                    known.join(", ")
                )));
            };
            if let Some(node) = connectivity.iter().find(|n| **n >= points.len()) {
                return Err(outside(*node, points.len()));
            }
            let count = connectivity.len() / kind.node_count();
            blocks.push(Block {
                kind: *kind,
                connectivity,
                cell_ids: (next..next + count as u64).collect(),
            });
            next += count as u64;
        }
        let mut mesh = stickslip::mesh::Mesh {
            dim,
            point_ids: (1..=points.len() as u64).collect(),
            points,
            blocks,
            ..Default::default()
        };
        for (name, mut set) in point_sets {
            set.sort_unstable();
            set.dedup();
            if let Some(node) = set.last().filter(|n| **n >= mesh.points.len()) {
                return Err(outside(*node, mesh.points.len()));
            }
            mesh.point_sets.insert(name, set);
        }
        for (name, set) in cell_sets {
            let set = set.into_iter();
            let mut set: Vec<CellRef> = set.map(|(block, cell)| CellRef { block, cell }).collect();
            set.sort_unstable();
            set.dedup();
            mesh.cell_sets.insert(name, set);
        }
        let faces = faces(&mesh);
        for (name, lists) in facet_sets {
            let mut set = Vec::new();
            for (columns, nodes) in lists {
                for facet in nodes.chunks_exact(columns) {
                    let key = corners(dim, facet);
                    let Some(found) = faces.get(&key) else {
                        return Err(PyValueError::new_err(format!(
                            "facet set `{name}`: {facet:?} is on the boundary of no cell"
                        )));
                    };
                    set.push(*found);
                }
            }
            set.sort_unstable();
            set.dedup();
            mesh.facet_sets.insert(name, set);
        }
        check::check(&mesh).map_err(|e| raise(py, e.into()))?;
        Ok(Mesh {
            mesh: Arc::new(mesh),
        })
    }

    /// All of it as bytes, from which [`Mesh::restore`] makes it again.
    fn state<'py>(&self, py: Python<'py>) -> Bound<'py, PyBytes> {
        PyBytes::new(py, &seal(&self.mesh))
    }

    /// From what [`Mesh::state`] returned.
    #[staticmethod]
    fn restore(state: &[u8]) -> PyResult<Self> {
        let mesh = unseal(state, "the mesh").map_err(PyValueError::new_err)?;
        Ok(Mesh { mesh })
    }

    /// Numbers of points and of cells.
    #[getter]
    fn counts(&self) -> (usize, usize) {
        (self.mesh.points.len(), self.mesh.cell_count())
    }

    /// Names of point sets, cell sets and facet sets.
    #[getter]
    fn sets(&self) -> [Vec<String>; 3] {
        let mesh = &self.mesh;
        [
            mesh.point_sets.keys().cloned().collect(),
            mesh.cell_sets.keys().cloned().collect(),
            mesh.facet_sets.keys().cloned().collect(),
        ]
    }
}

fn outside(node: usize, count: usize) -> PyErr {
    PyIndexError::new_err(format!(
        "there is no point {node} among {count}; indices start from 0"
    ))
}

/// Little-endian doubles.
pub fn doubles(bytes: &[u8]) -> Vec<f64> {
    let all = bytes.chunks_exact(8);
    all.map(|b| f64::from_le_bytes(std::array::from_fn(|i| b[i])))
        .collect()
}

/// The corners of a facet, sorted: the first of its nodes.
fn corners(dim: usize, nodes: &[usize]) -> Vec<usize> {
    let count = match (dim, nodes.len()) {
        (2, _) => 2,
        (_, 6) => 3,
        (_, 8) => 4,
        (_, n) => n,
    };
    let mut key = nodes[..count.min(nodes.len())].to_vec();
    key.sort_unstable();
    key
}

/// The facets of the boundary by their corners.
fn faces(mesh: &stickslip::mesh::Mesh) -> HashMap<Vec<usize>, FacetRef> {
    let boundary = mesh.boundary().into_iter();
    boundary
        .map(|f| (corners(mesh.dim, &mesh.facet_points(f).1), f))
        .collect()
}

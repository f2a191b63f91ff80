//! Cells of any kind on an integer lattice.
//!
//! A lattice cell spans two steps in each of its directions, so that mid-side nodes have lattice positions of their
//! own and equal positions mean equal points: patches join without a search by distance.

use crate::error::MeshError;
use crate::math::Vec3;
use crate::mesh::{Block, FacetRef, Mesh};
use crate::shape::ElementKind;

/// A lattice position: three directions of a grid and the layer outside of it.
pub(super) type Key = [usize; 4];

/// More cells than this are taken for a slip of the pen.
pub(super) const MOST_CELLS: usize = 20_000_000;

/// Which diagonal splits a quadrilateral into two triangles. Of no effect on other plane elements.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum Diagonal {
    /// From lower left to upper right.
    Up,
    /// From upper left to lower right.
    Down,
    /// Up and down in turn along x.
    Alternating,
    /// Up and down in turn along x and y: the diagonals meet in every other point, and a mesh of an even number of
    /// cells is its own mirror image.
    #[default]
    UnionJack,
}

/// A block of two lattice steps in each direction.
pub(super) struct LatticeCell {
    /// Its lowest corner.
    pub base: Key,
    /// The entries of the key that are its directions; the first `dim` count.
    pub axes: [usize; 3],
    /// Whether its directions are left-handed in space.
    pub reversed: bool,
}

/// A mesh on the lattice with the lattice position of each point.
pub(super) struct Lattice {
    pub mesh: Mesh,
    keys: Vec<Key>,
    boundary: Vec<FacetRef>,
}

/// Corner offsets of a triangle or tetrahedron in a lattice cell.
type Simplex = [[usize; 3]; 4];

const UP: [Simplex; 2] = [
    [[0, 0, 0], [2, 0, 0], [2, 2, 0], [0; 3]],
    [[0, 0, 0], [2, 2, 0], [0, 2, 0], [0; 3]],
];
const DOWN: [Simplex; 2] = [
    [[0, 0, 0], [2, 0, 0], [0, 2, 0], [0; 3]],
    [[2, 0, 0], [2, 2, 0], [0, 2, 0], [0; 3]],
];
/// Six tetrahedra about the diagonal from the lowest to the highest corner, one for each order of the axes. Every
/// face is split from its lowest to its highest corner, so neighbours agree whatever their directions.
const SIX: [Simplex; 6] = [
    [[0, 0, 0], [2, 0, 0], [2, 2, 0], [2, 2, 2]],
    [[0, 0, 0], [0, 2, 0], [0, 2, 2], [2, 2, 2]],
    [[0, 0, 0], [0, 0, 2], [2, 0, 2], [2, 2, 2]],
    [[0, 0, 0], [2, 2, 0], [0, 2, 0], [2, 2, 2]],
    [[0, 0, 0], [2, 0, 2], [2, 0, 0], [2, 2, 2]],
    [[0, 0, 0], [0, 2, 2], [0, 0, 2], [2, 2, 2]],
];

impl Lattice {
    /// Fills the cells with elements and maps their nodes into space.
    pub fn new(
        dim: usize,
        element: ElementKind,
        diagonal: Diagonal,
        cells: &[LatticeCell],
        position: impl Fn(Key) -> Vec3,
    ) -> Result<Lattice, MeshError> {
        Lattice::closed(dim, element, diagonal, cells, usize::MAX, position)
    }

    /// The same where the first direction begins anew after `period` positions.
    pub fn closed(
        dim: usize,
        element: ElementKind,
        diagonal: Diagonal,
        cells: &[LatticeCell],
        period: usize,
        position: impl Fn(Key) -> Vec3,
    ) -> Result<Lattice, MeshError> {
        if element.dim() != dim {
            let fitting: Vec<&str> = ElementKind::ALL
                .into_iter()
                .filter(|kind| kind.dim() == dim)
                .map(ElementKind::name)
                .collect();
            return Err(
                MeshError::new(format!("a {dim}D body cannot be made of {element}"))
                    .help(format!("choose one of {}", fitting.join(", "))),
            );
        }
        if element.linear() == ElementKind::Wedge6 && cells.iter().any(|c| c.axes != [0, 1, 2]) {
            return Err(MeshError::new(format!(
                "patches in several directions cannot be made of {element}"
            ))
            .help("choose tetrahedra or hexahedra: triangles of one patch would meet quadrilaterals of another"));
        }
        let mut nodes: Vec<Key> = Vec::new();
        for cell in cells {
            fill(element, diagonal, cell, &mut nodes);
        }
        nodes.iter_mut().for_each(|key| key[0] %= period);
        // The first direction runs fastest, the layers come last.
        let mut keys = nodes.clone();
        keys.sort_unstable_by_key(order);
        keys.dedup();
        let connectivity: Vec<usize> = nodes
            .iter()
            .map(|key| keys.partition_point(|k| order(k) < order(key)))
            .collect();
        let cell_count = connectivity.len() / element.node_count();
        let mesh = Mesh {
            dim,
            points: keys.iter().map(|&key| position(key)).collect(),
            point_ids: (1..=keys.len() as u64).collect(),
            blocks: vec![Block {
                kind: element,
                connectivity,
                cell_ids: (1..=cell_count as u64).collect(),
            }],
            ..Mesh::default()
        };
        let boundary = mesh.boundary();
        Ok(Lattice {
            mesh,
            keys,
            boundary,
        })
    }

    /// Names the boundary facets all of whose points pass the test.
    pub fn name_facets(&mut self, name: &str, test: impl Fn(&Key) -> bool) {
        let facets = self
            .boundary
            .iter()
            .copied()
            .filter(|&f| {
                self.mesh
                    .facet_points(f)
                    .1
                    .iter()
                    .all(|&p| test(&self.keys[p]))
            })
            .collect();
        self.mesh.facet_sets.insert(name.to_string(), facets);
    }

    /// Names the point at a lattice position, if there is one.
    pub fn name_point(&mut self, name: &str, key: Key) {
        if let Ok(p) = self.keys.binary_search_by_key(&order(&key), order) {
            self.mesh.point_sets.insert(name.to_string(), vec![p]);
        }
    }
}

fn order(key: &Key) -> Key {
    [key[3], key[2], key[1], key[0]]
}

fn fill(element: ElementKind, diagonal: Diagonal, cell: &LatticeCell, nodes: &mut Vec<Key>) {
    let mut push = |mut offset: [usize; 3], mirror: bool| {
        if mirror {
            offset[0] = 2 - offset[0];
        }
        let mut key = cell.base;
        for (&axis, o) in cell.axes.iter().zip(offset).take(element.dim()) {
            key[axis] += o;
        }
        nodes.push(key);
    };
    let reference = element.reference().nodes();
    let wedge = element.linear() == ElementKind::Wedge6;
    if !element.is_simplex() && !wedge {
        for node in reference {
            // -1, 0, 1 become 0, 1, 2.
            push(node.map(|x| (x + 1.0) as usize), cell.reversed);
        }
        return;
    }
    let simplices: &[Simplex] = if element.dim() == 3 && !wedge {
        &SIX
    } else if goes_up(diagonal, cell) {
        &UP
    } else {
        &DOWN
    };
    for simplex in simplices {
        let mut c = *simplex;
        if cell.reversed {
            c.swap(1, 2);
        }
        for &[x, y, z] in reference {
            // Corner offsets are even: the middles of edges are integers.
            let third = if wedge { 0.0 } else { z };
            let w = [1.0 - x - y - third, x, y, third];
            let mut offset: [usize; 3] = std::array::from_fn(|i| {
                (0..4).map(|k| w[k] * c[k][i] as f64).sum::<f64>() as usize
            });
            if wedge {
                offset[2] = (z + 1.0) as usize;
            }
            push(offset, false);
        }
    }
}

fn goes_up(diagonal: Diagonal, cell: &LatticeCell) -> bool {
    let index = |i: usize| cell.base[cell.axes[i]] / 2;
    match diagonal {
        Diagonal::Up => true,
        Diagonal::Down => false,
        Diagonal::Alternating => index(0).is_multiple_of(2),
        Diagonal::UnionJack => (index(0) + index(1)).is_multiple_of(2),
    }
}

/// The coordinate at a lattice index: entries of the table at even ones, the middle between at odd ones.
pub(super) fn at(table: &[f64], index: usize) -> f64 {
    let i = index / 2;
    if index.is_multiple_of(2) {
        table[i]
    } else {
        0.5 * (table[i] + table[i + 1])
    }
}

use super::generate::Generate;
use super::grading::{Edge, Grading, affordable};
use super::lattice::{Diagonal, Lattice, LatticeCell, at};
use crate::error::MeshError;
use crate::mesh::Mesh;
use crate::registry::Samples;
use crate::shape::ElementKind;

/// A box with faces parallel to the axes.
///
/// Facet sets: `left`, `right` (x), `front`, `back` (y), `bottom`, `top` (z). Point sets: its corners, as in
/// `bottom-front-left`.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Cuboid {
    /// Corner with the lowest coordinates `[length]`.
    #[serde(default)]
    pub from: [f64; 3],
    /// Corner with the highest coordinates `[length]`. Needed unless `x`, `y` and `z` are given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub to: Option<[f64; 3]>,
    /// Number of cells along x, y and z. Needed unless `x`, `y` and `z` are given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cells: Option<[usize; 3]>,
    /// Element: hex8, hex20, tet4, tet10, wedge6 or wedge15. A cell is split into six tetrahedra, or into two wedges that stand on
    /// triangles in the xy plane.
    #[serde(default = "hex8")]
    pub element: ElementKind,
    /// How the cells grow along x, y and z.
    #[serde(default)]
    pub grading: Grading,
    /// The grid planes' x, increasing `[length]`; replaces `from`, `to`, `cells` and `grading` along x.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub x: Vec<f64>,
    /// The grid planes' y, likewise.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub y: Vec<f64>,
    /// The grid planes' z, likewise.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub z: Vec<f64>,
}

pub(super) fn hex8() -> ElementKind {
    ElementKind::Hex8
}

impl Cuboid {
    /// A box of equal hex8 cells.
    pub fn new(from: [f64; 3], to: [f64; 3], cells: [usize; 3]) -> Self {
        Cuboid {
            from,
            to: Some(to),
            cells: Some(cells),
            element: ElementKind::Hex8,
            grading: Grading::default(),
            x: Vec::new(),
            y: Vec::new(),
            z: Vec::new(),
        }
    }
}

impl Generate for Cuboid {
    fn generate(&self) -> Result<Mesh, MeshError> {
        let edge = |i: usize, name, stretch, explicit| Edge {
            name,
            from: self.from[i],
            to: self.to.map(|to| to[i]),
            cells: self.cells.map(|cells| cells[i]),
            stretch,
            explicit,
        };
        let x = edge(0, "x", self.grading.x, &self.x).coordinates()?;
        let y = edge(1, "y", self.grading.y, &self.y).coordinates()?;
        let z = edge(2, "z", self.grading.z, &self.z).coordinates()?;
        let n = [x.len() - 1, y.len() - 1, z.len() - 1];
        affordable(&n)?;
        let mut cells = Vec::with_capacity(n[0] * n[1] * n[2]);
        for k in 0..n[2] {
            for j in 0..n[1] {
                cells.extend((0..n[0]).map(|i| LatticeCell {
                    base: [2 * i, 2 * j, 2 * k, 0],
                    axes: [0, 1, 2],
                    reversed: false,
                }));
            }
        }
        let mut lattice = Lattice::new(3, self.element, Diagonal::default(), &cells, |k| {
            [at(&x, k[0]), at(&y, k[1]), at(&z, k[2])]
        })?;
        let faces = [["left", "right"], ["front", "back"], ["bottom", "top"]];
        for (axis, [low, high]) in faces.into_iter().enumerate() {
            lattice.name_facets(low, |k| k[axis] == 0);
            lattice.name_facets(high, |k| k[axis] == 2 * n[axis]);
        }
        for corner in 0..8 {
            let side = [corner & 1, corner >> 1 & 1, corner >> 2];
            let name = format!(
                "{}-{}-{}",
                faces[2][side[2]], faces[1][side[1]], faces[0][side[0]]
            );
            let key = [0, 1, 2].map(|i| 2 * n[i] * side[i]);
            lattice.name_point(&name, [key[0], key[1], key[2], 0]);
        }
        Ok(lattice.mesh)
    }
}

impl Samples for Cuboid {
    fn samples() -> Vec<Self> {
        [
            ElementKind::Tet4,
            ElementKind::Tet10,
            ElementKind::Hex8,
            ElementKind::Hex20,
            ElementKind::Wedge6,
            ElementKind::Wedge15,
        ]
        .into_iter()
        .map(|element| Cuboid {
            element,
            ..Cuboid::new([-0.01, 0.02, 0.0], [0.03, 0.03, 0.02], [4, 3, 2])
        })
        .collect()
    }
}

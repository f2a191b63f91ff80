use super::generate::Generate;
use super::grading::{Edge, Grading, affordable};
use super::lattice::{Diagonal, Lattice, LatticeCell, at};
use crate::error::MeshError;
use crate::mesh::Mesh;
use crate::registry::Samples;
use crate::shape::ElementKind;

/// A rectangle with sides parallel to the axes.
///
/// Facet sets: `left`, `right` (x), `bottom`, `top` (y). Point sets: `bottom-left`, `bottom-right`, `top-left`,
/// `top-right`.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Rectangle {
    /// Lower left corner `[length]`.
    #[serde(default)]
    pub from: [f64; 2],
    /// Upper right corner `[length]`. Needed unless `x` and `y` are given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub to: Option<[f64; 2]>,
    /// Number of cells along x and y. Needed unless `x` and `y` are given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cells: Option<[usize; 2]>,
    /// Element: quad4, quad8, tri3 or tri6. Triangles are halves of the cells.
    #[serde(default = "quad4")]
    pub element: ElementKind,
    /// How the cells grow along x and y.
    #[serde(default)]
    pub grading: Grading,
    /// The grid lines' x, increasing `[length]`; replaces `from`, `to`, `cells` and `grading` along x.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub x: Vec<f64>,
    /// The grid lines' y, increasing `[length]`; replaces `from`, `to`, `cells` and `grading` along y.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub y: Vec<f64>,
    /// Which diagonal splits a cell into triangles.
    #[serde(default)]
    pub diagonal: Diagonal,
}

pub(super) fn quad4() -> ElementKind {
    ElementKind::Quad4
}

impl Rectangle {
    /// A rectangle of equal quad4 cells.
    pub fn new(from: [f64; 2], to: [f64; 2], cells: [usize; 2]) -> Self {
        Rectangle {
            from,
            to: Some(to),
            cells: Some(cells),
            element: ElementKind::Quad4,
            grading: Grading::default(),
            x: Vec::new(),
            y: Vec::new(),
            diagonal: Diagonal::default(),
        }
    }
}

impl Generate for Rectangle {
    fn generate(&self) -> Result<Mesh, MeshError> {
        if self.grading.z.is_some() {
            return Err(MeshError::new("a rectangle has no grading along z")
                .help("grade x or y, or generate a box"));
        }
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
        let (nx, ny) = (x.len() - 1, y.len() - 1);
        affordable(&[nx, ny])?;
        let cells: Vec<LatticeCell> = (0..ny)
            .flat_map(|j| {
                (0..nx).map(move |i| LatticeCell {
                    base: [2 * i, 2 * j, 0, 0],
                    axes: [0, 1, 2],
                    reversed: false,
                })
            })
            .collect();
        let mut lattice = Lattice::new(2, self.element, self.diagonal, &cells, |k| {
            [at(&x, k[0]), at(&y, k[1]), 0.0]
        })?;
        lattice.name_facets("left", |k| k[0] == 0);
        lattice.name_facets("right", |k| k[0] == 2 * nx);
        lattice.name_facets("bottom", |k| k[1] == 0);
        lattice.name_facets("top", |k| k[1] == 2 * ny);
        for (row, j) in [("bottom", 0), ("top", 2 * ny)] {
            lattice.name_point(&format!("{row}-left"), [0, j, 0, 0]);
            lattice.name_point(&format!("{row}-right"), [2 * nx, j, 0, 0]);
        }
        Ok(lattice.mesh)
    }
}

impl Samples for Rectangle {
    fn samples() -> Vec<Self> {
        [
            ElementKind::Tri3,
            ElementKind::Tri6,
            ElementKind::Quad4,
            ElementKind::Quad8,
        ]
        .into_iter()
        .map(|element| Rectangle {
            element,
            ..Rectangle::new([-0.01, 0.02], [0.03, 0.03], [5, 4])
        })
        .collect()
    }
}

use std::f64::consts::TAU;

use super::annulus::{Annulus, positive, some};
use super::generate::Generate;
use super::grading::affordable;
use super::rectangle::quad4;
use crate::error::MeshError;
use crate::mesh::Mesh;
use crate::registry::Samples;
use crate::shape::ElementKind;

/// A ring, or a disc with a bore: a roller on its shaft, the race of a bearing, a cam.
///
/// Facet sets: `bore` (the inner circle), `rim` (the outer one). Every point of both lies on its circle.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Ring {
    /// Centre `[length]`.
    #[serde(default)]
    pub centre: [f64; 2],
    /// Radius of the bore `[length]`.
    pub bore: f64,
    /// Radius of the rim `[length]`.
    pub radius: f64,
    /// Cells around and from the bore to the rim.
    pub cells: [usize; 2],
    /// Size of the cells at the rim over that at the bore, along the radius `[-]`.
    #[serde(default = "one")]
    pub ratio: f64,
    /// Element: quad4, quad8, tri3 or tri6.
    #[serde(default = "quad4")]
    pub element: ElementKind,
}

fn one() -> f64 {
    1.0
}

impl Generate for Ring {
    fn generate(&self) -> Result<Mesh, MeshError> {
        let [around, across] = self.cells;
        positive(&[
            ("bore", self.bore),
            ("radius", self.radius),
            ("ratio", self.ratio),
        ])?;
        some(&[("cells across", across)])?;
        affordable(&self.cells)?;
        if around < 3 {
            return Err(
                MeshError::new(format!("{around} cells do not go round a circle"))
                    .help("give at least 3"),
            );
        }
        if self.bore >= self.radius {
            return Err(MeshError::new(format!(
                "the bore, {}, is not inside the rim, {}",
                self.bore, self.radius
            ))
            .help("both are radii: give a smaller bore"));
        }
        let q = self.ratio.powf(1.0 / (across.max(2) - 1) as f64);
        // The part of the way from the bore at half rows.
        let part = |j: usize| match (q - 1.0).abs() < 1e-12 {
            true => 0.5 * j as f64 / across as f64,
            false => (q.powf(0.5 * j as f64) - 1.0) / (q.powi(across as i32) - 1.0),
        };
        let mut lattice = Annulus {
            centre: self.centre,
            element: self.element,
            rows: &vec![across; around],
        }
        .lattice(|key| {
            let angle = TAU * key[0] as f64 / (2 * around) as f64;
            [angle, self.bore + (self.radius - self.bore) * part(key[1])]
        })?;
        lattice.name_facets("bore", |k| k[1] == 0);
        lattice.name_facets("rim", |k| k[1] == 2 * across);
        Ok(lattice.mesh)
    }
}

impl Samples for Ring {
    fn samples() -> Vec<Self> {
        let kinds = [
            ElementKind::Tri3,
            ElementKind::Tri6,
            ElementKind::Quad4,
            ElementKind::Quad8,
        ];
        let plain = |element| Ring {
            centre: [0.01, -0.02],
            bore: 0.02,
            radius: 0.05,
            cells: [12, 3],
            ratio: 1.0,
            element,
        };
        let mut all: Vec<Self> = kinds.into_iter().map(plain).collect();
        all.push(Ring {
            ratio: 0.3,
            ..plain(ElementKind::Quad8)
        });
        all
    }
}

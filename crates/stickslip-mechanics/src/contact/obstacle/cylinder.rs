use serde::{Deserialize, Serialize};

use super::chart::Chart;
use super::foot::{Foot, Shape, radial_foot, radial_slope_derivative, to_vec3, vector_fault};
use crate::contact::law::normal::positive;
use crate::math::{Mat3, Vec3, identity, normalize};
use crate::registry::Samples;

/// A rigid circular cylinder, infinitely long; in a plane problem a circle.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Cylinder {
    /// A point on its axis `[m]`.
    pub centre: Vec<f64>,
    /// Direction of its axis; not given in a plane problem.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub axis: Option<Vec<f64>>,
    /// Radius `[m]`.
    pub radius: f64,
    /// `true` for a bore: the bodies are inside. Default: `false`.
    #[serde(default)]
    pub inside: bool,
}

impl Cylinder {
    fn direction(&self) -> Vec3 {
        let axis = self.axis.as_deref();
        axis.and_then(|axis| normalize(to_vec3(axis)))
            .unwrap_or([0.0, 0.0, 1.0])
    }

    fn cross_section(&self) -> Mat3 {
        let axis = self.direction();
        let mut q = identity();
        for (i, row) in q.iter_mut().enumerate() {
            for (j, x) in row.iter_mut().enumerate() {
                *x -= axis[i] * axis[j];
            }
        }
        q
    }
}

impl Shape for Cylinder {
    fn foot(&self, x: Vec3) -> Option<Foot> {
        let q = self.cross_section();
        radial_foot(x, to_vec3(&self.centre), self.radius, self.inside, &q)
    }

    fn slope_derivative(&self, x: Vec3, v: Vec3) -> Mat3 {
        let q = self.cross_section();
        radial_slope_derivative(x, to_vec3(&self.centre), self.radius, &q, v)
    }

    fn radius(&self) -> f64 {
        if self.inside {
            -self.radius
        } else {
            self.radius
        }
    }

    fn chart(&self, dim: usize, spacing: f64) -> Chart {
        let centre = to_vec3(&self.centre);
        Chart::cylinder(centre, self.direction(), self.radius, dim, spacing)
    }

    fn faults(&self, dim: usize) -> Vec<(&'static str, String)> {
        let mut faults: Vec<_> = [
            vector_fault("centre", &self.centre, dim),
            positive("radius", self.radius),
        ]
        .into_iter()
        .flatten()
        .collect();
        match (&self.axis, dim) {
            (Some(_), 2) => faults.push(("axis", "has no meaning in a plane problem".into())),
            (None, 3) => faults.push(("axis", "is missing".into())),
            (Some(axis), _) => {
                faults.extend(vector_fault("axis", axis, dim));
                if normalize(to_vec3(axis)).is_none() {
                    faults.push(("axis", "is zero".into()));
                }
            }
            _ => {}
        }
        faults
    }
}

impl Samples for Cylinder {
    fn samples() -> Vec<Self> {
        let peg = Cylinder {
            centre: vec![0.1, 0.05, 0.0],
            axis: Some(vec![0.2, 0.1, 1.0]),
            radius: 0.3,
            inside: false,
        };
        vec![
            Cylinder {
                inside: true,
                ..peg.clone()
            },
            peg,
        ]
    }
}

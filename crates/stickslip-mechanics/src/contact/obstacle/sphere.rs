use serde::{Deserialize, Serialize};

use super::chart::Chart;
use super::foot::{Foot, Shape, radial_foot, radial_slope_derivative, to_vec3, vector_fault};
use crate::contact::law::normal::positive;
use crate::math::{Mat3, Vec3, identity};
use crate::registry::Samples;

/// A rigid sphere (in an axisymmetric problem with its centre on the axis).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Sphere {
    /// Centre `[m]`.
    pub centre: Vec<f64>,
    /// Radius `[m]`.
    pub radius: f64,
    /// `true` for a socket: the bodies are inside. Default: `false`.
    #[serde(default)]
    pub inside: bool,
}

impl Shape for Sphere {
    fn foot(&self, x: Vec3) -> Option<Foot> {
        let centre = to_vec3(&self.centre);
        radial_foot(x, centre, self.radius, self.inside, &identity())
    }

    fn slope_derivative(&self, x: Vec3, v: Vec3) -> Mat3 {
        radial_slope_derivative(x, to_vec3(&self.centre), self.radius, &identity(), v)
    }

    fn radius(&self) -> f64 {
        if self.inside {
            -self.radius
        } else {
            self.radius
        }
    }

    fn chart(&self, dim: usize, spacing: f64) -> Chart {
        Chart::sphere(to_vec3(&self.centre), self.radius, dim, spacing)
    }

    fn faults(&self, dim: usize) -> Vec<(&'static str, String)> {
        [
            vector_fault("centre", &self.centre, dim),
            positive("radius", self.radius),
        ]
        .into_iter()
        .flatten()
        .collect()
    }
}

impl Samples for Sphere {
    fn samples() -> Vec<Self> {
        let ball = Sphere {
            centre: vec![0.1, 0.05, -0.05],
            radius: 0.3,
            inside: false,
        };
        vec![
            Sphere {
                inside: true,
                ..ball.clone()
            },
            ball,
        ]
    }
}

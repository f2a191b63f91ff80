use serde::{Deserialize, Serialize};

use super::chart::Chart;
use super::foot::{Foot, Shape, to_vec3, vector_fault};
use crate::math::{Mat3, Vec3, add_scaled, dot, identity, normalize, sub};
use crate::registry::Samples;

/// A rigid half-space.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Plane {
    /// A point on its surface `[m]`.
    pub point: Vec<f64>,
    /// Normal out of it, towards the bodies; need not be a unit vector.
    pub normal: Vec<f64>,
}

impl Shape for Plane {
    fn foot(&self, x: Vec3) -> Option<Foot> {
        let normal = normalize(to_vec3(&self.normal))?;
        let gap = dot(sub(x, to_vec3(&self.point)), normal);
        let mut slope = identity();
        for (i, row) in slope.iter_mut().enumerate() {
            for (j, s) in row.iter_mut().enumerate() {
                *s -= normal[i] * normal[j];
            }
        }
        Some(Foot {
            gap,
            normal,
            point: add_scaled(x, -gap, normal),
            slope,
            curvature: [[0.0; 3]; 3],
        })
    }

    fn slope_derivative(&self, _x: Vec3, _v: Vec3) -> Mat3 {
        [[0.0; 3]; 3]
    }

    fn chart(&self, dim: usize, spacing: f64) -> Chart {
        let normal = normalize(to_vec3(&self.normal)).unwrap_or([0.0, 1.0, 0.0]);
        Chart::plane(to_vec3(&self.point), normal, dim, spacing)
    }

    fn faults(&self, dim: usize) -> Vec<(&'static str, String)> {
        let mut faults: Vec<_> = [
            vector_fault("point", &self.point, dim),
            vector_fault("normal", &self.normal, dim),
        ]
        .into_iter()
        .flatten()
        .collect();
        if faults.is_empty() && normalize(to_vec3(&self.normal)).is_none() {
            faults.push(("normal", "is zero".into()));
        }
        faults
    }
}

impl Samples for Plane {
    fn samples() -> Vec<Self> {
        vec![Plane {
            point: vec![0.0, 0.1, 0.0],
            normal: vec![0.1, 1.0, 0.2],
        }]
    }
}

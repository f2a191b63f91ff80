use super::model::{Spot, TemperatureModel, finite, vec3, vector};
use crate::body::Space;
use crate::math::{add_scaled, dot, norm, normalize, sub};
use crate::registry::Samples;
use crate::system::Amplitude;

/// A temperature over the distance from an axis, or in the plane from a point: linear between the rows of a table, constant outside.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Radial {
    /// Rows of distance `[length]` and temperature `[K]`; distances increase.
    pub table: Vec<[f64; 2]>,
    /// A point of the axis `[length]`, as many components as the space has; the origin if not given. In axial symmetry the axis is that of symmetry.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub point: Option<Vec<f64>>,
    /// Direction of the axis `[-]`, of any length: needed in 3D. In the plane it is perpendicular to it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub axis: Option<Vec<f64>>,
}

impl Radial {
    fn distance(&self, space: Space, spot: &Spot) -> Option<f64> {
        let from = sub(spot.x, vec3(self.point.as_deref().unwrap_or_default()));
        Some(match space {
            Space::Axisymmetric => spot.x[0],
            Space::Solid => {
                let axis = normalize(vec3(self.axis.as_deref()?))?;
                norm(add_scaled(from, -dot(from, axis), axis))
            }
            Space::PlaneStrain { .. } | Space::PlaneStress { .. } => norm(from),
        })
    }
}

impl TemperatureModel for Radial {
    fn at(&self, space: Space, spot: &Spot) -> Option<f64> {
        let table = Amplitude::new(self.table.clone()).ok()?;
        Some(table.at(self.distance(space, spot)?))
    }

    fn faults(&self, space: Space) -> Vec<(&'static str, String)> {
        let table = Amplitude::new(self.table.clone()).err().map(|_| {
            let message = "needs rows of distance and temperature, with distances that increase";
            ("table", message.to_string())
        });
        let point = match (&self.point, space) {
            (Some(_), Space::Axisymmetric) => {
                let message = "has no meaning in axial symmetry, where distances are those from the axis of symmetry: remove the key";
                Some(("point", message.to_string()))
            }
            (Some(point), _) => vector("point", point, space),
            (None, _) => None,
        };
        let axis = match (&self.axis, space) {
            (Some(axis), Space::Solid) => vector("axis", axis, space)
                .or_else(|| finite("axis", axis))
                .or_else(|| {
                    let none = normalize(vec3(axis)).is_none();
                    none.then(|| ("axis", "has no direction".to_string()))
                }),
            (None, Space::Solid) => Some((
                "axis",
                "is missing: give the direction of the axis, axis = [0, 0, 1]".into(),
            )),
            (Some(_), _) => Some((
                "axis",
                "has no meaning in a plane model, which has distances from a point: remove the key"
                    .into(),
            )),
            (None, _) => None,
        };
        [table, point, axis].into_iter().flatten().collect()
    }
}

impl Samples for Radial {
    fn samples() -> Vec<Self> {
        vec![Radial {
            table: vec![[0.02, 20.0], [0.05, 180.0]],
            point: Some(vec![0.0, 0.0, 0.1]),
            axis: Some(vec![0.0, 0.0, 1.0]),
        }]
    }
}

use serde::{Deserialize, Serialize};

pub use crate::system::Component;

/// `[support.NAME]`: displacements prescribed on a set. Components that are not given stay free.
///
/// Over the step in which it becomes active, a support moves linearly from the displacement the points have to the
/// one prescribed, unless an amplitude says otherwise. In a step that does not list it, it lets go.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct Support {
    /// The points: `body.set`, a `[set.NAME]`, a body, or a `[reference.NAME]`.
    pub set: String,
    /// Displacement along x `[length]`; in an axisymmetric problem the radial one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub x: Option<f64>,
    /// Displacement along y `[length]`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub y: Option<f64>,
    /// Displacement along z `[length]`, in 3D.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub z: Option<f64>,
    /// Rotation about x `[rad]`, in 3D, of a reference point.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rotation_x: Option<f64>,
    /// Rotation about y `[rad]`, in 3D, of a reference point.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rotation_y: Option<f64>,
    /// Rotation about z `[rad]`, of a reference point.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rotation_z: Option<f64>,
    /// Components that are held where they are when the support begins to act: `hold = ["y"]`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub hold: Vec<Component>,
    /// An `[amplitude.NAME]` over the time of the analysis, by which the displacements are multiplied.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub amplitude: Option<String>,
}

impl Support {
    /// The components by name and value, given or not, in the order of [`Component`].
    pub fn components(&self) -> [(&'static str, Option<f64>); 6] {
        [
            ("x", self.x),
            ("y", self.y),
            ("z", self.z),
            ("rotation-x", self.rotation_x),
            ("rotation-y", self.rotation_y),
            ("rotation-z", self.rotation_z),
        ]
    }
}

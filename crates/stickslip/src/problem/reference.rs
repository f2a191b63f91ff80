use serde::{Deserialize, Serialize};

use crate::math::Mat3;

/// `[reference.NAME]`: a point that belongs to no mesh. It moves and turns, can be supported, loaded and tied by equations and springs, and points of bodies
/// follow it (`coupling.kinematic`) or it them (`coupling.distributing`).
///
/// Its name stands for it wherever a set of one point does: in `support`, `load` (`nodal-force`, `moment`, `spring`), `mass`, `initial` and `coupling`.
/// The history has its displacement and rotation, and the force and moment of its supports. Rotations are small: above about 0.1 rad it shows. In the
/// plane it turns about z; around an axis of symmetry it moves along y alone. A motion that nothing resists is left out, and a load along it refused.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct Reference {
    /// Where it is, before any deformation `[length]`.
    pub point: Vec<f64>,
    /// Mass there `[mass]`, in dynamic steps: over the whole thickness of a plane body, around the whole circumference of an axisymmetric one.
    #[cfg_attr(feature = "schema", schemars(extend("exclusiveMinimum" = 0)))]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mass: Option<f64>,
    /// Moments of inertia about the axes through it `[mass length²]`: `[xx, yy, zz]` or `[xx, yy, zz, xy, yz, xz]`, in the plane the one about z, `[zz]`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub inertia: Option<Vec<f64>>,
}

/// Moments of inertia as a matrix: from the one about z, the three about the axes, or all six.
pub(super) fn spin_matrix(moments: &[f64]) -> Mat3 {
    match *moments {
        [zz] => [[zz, 0.0, 0.0], [0.0, zz, 0.0], [0.0, 0.0, zz]],
        [xx, yy, zz] => [[xx, 0.0, 0.0], [0.0, yy, 0.0], [0.0, 0.0, zz]],
        [xx, yy, zz, xy, yz, xz] => [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]],
        _ => [[0.0; 3]; 3],
    }
}

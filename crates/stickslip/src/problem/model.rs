use serde::{Deserialize, Serialize};

use crate::body::Space;
use crate::system::Component;

/// `[model]`: the space in which the bodies live.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct Model {
    /// Plane strain, plane stress, axisymmetric or solid (3D).
    pub space: SpaceKind,
    /// Thickness `[length]` of a plane problem, 1 if not given. Forces are those of this thickness.
    #[cfg_attr(feature = "schema", schemars(extend("exclusiveMinimum" = 0)))]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub thickness: Option<f64>,
}

/// The space in which the bodies live.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum SpaceKind {
    /// In the plane x, y; no strain along z.
    PlaneStrain,
    /// In the plane x, y; no stress along z.
    PlaneStress,
    /// Around the y axis, x is the radius; forces are those of the full turn.
    Axisymmetric,
    /// Three-dimensional.
    Solid,
}

impl SpaceKind {
    /// Displacement components a point: 2 or 3.
    pub fn dim(self) -> usize {
        match self {
            SpaceKind::Solid => 3,
            _ => 2,
        }
    }

    /// Whether points move, or reference points turn, like that.
    pub fn has(self, component: Component) -> bool {
        match component {
            Component::X | Component::Y => true,
            Component::Z | Component::RotationX | Component::RotationY => self == SpaceKind::Solid,
            Component::RotationZ => self != SpaceKind::Axisymmetric,
        }
    }

    /// The space, of unit thickness in the plane.
    pub(super) fn bare(self) -> Space {
        self.with(1.0)
    }

    /// The space, of a thickness in the plane.
    pub(super) fn with(self, thickness: f64) -> Space {
        match self {
            SpaceKind::PlaneStrain => Space::PlaneStrain { thickness },
            SpaceKind::PlaneStress => Space::PlaneStress { thickness },
            SpaceKind::Axisymmetric => Space::Axisymmetric,
            SpaceKind::Solid => Space::Solid,
        }
    }

    /// As written in the problem file.
    pub fn name(self) -> &'static str {
        match self {
            SpaceKind::PlaneStrain => "plane-strain",
            SpaceKind::PlaneStress => "plane-stress",
            SpaceKind::Axisymmetric => "axisymmetric",
            SpaceKind::Solid => "solid",
        }
    }
}

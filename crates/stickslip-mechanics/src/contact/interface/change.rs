//! Laws that are exchanged between two steps.

use super::definition::InterfaceDefinition;
use crate::contact::law::friction::FrictionModel;
use crate::contact::law::normal::NormalModel;

/// `change.INTERFACE` of a step: laws that hold from this step on. What is not given stays. Points keep their pressure, status and the shear that they
/// carry; the new laws are asked from the first increment on.
#[derive(Debug, Clone, Default, PartialEq, serde::Serialize, serde::Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct Change {
    /// How the surfaces resist being pressed together.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub normal: Option<NormalModel>,
    /// How much shear the interface carries.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub friction: Option<FrictionModel>,
}

/// The interface with these laws in place of those of the problem or the program.
pub fn changed(interface: &InterfaceDefinition, change: &Change) -> InterfaceDefinition {
    let mut laws = interface.laws.clone();
    if let Some(normal) = &change.normal {
        laws.normal = normal.clone();
        laws.user.normal = None;
    }
    if let Some(friction) = &change.friction {
        laws.friction = friction.clone();
        laws.user.friction = None;
        laws.own_friction = None;
    }
    interface.with_laws(laws)
}

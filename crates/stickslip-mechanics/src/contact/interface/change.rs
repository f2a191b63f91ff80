//! Laws that are exchanged between two steps.

use super::definition::InterfaceDefinition;
use crate::contact::law::friction::FrictionModel;
use crate::contact::law::normal::NormalModel;

/// Laws of an interface from this step on. Laws that are not given stay. Points keep their pressure, status and shear traction; the new laws apply from
/// the first increment on.
#[derive(Debug, Clone, Default, PartialEq, serde::Serialize, serde::Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct Change {
    /// The normal law: pressure as a function of the gap.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub normal: Option<NormalModel>,
    /// The friction law: the largest shear traction of the interface.
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

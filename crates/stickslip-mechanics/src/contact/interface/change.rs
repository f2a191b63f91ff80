//! Laws that are exchanged between two steps.

use super::energies::stored_energy;
use super::history::History;
use super::parts::Interface;
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

/// Takes other laws, between two increments, in place of those of the problem or the program. The energy `[J]` by which the law now stores more is returned.
pub fn change(interface: &mut Interface, state: &History, change: &Change) -> f64 {
    let before = stored_energy(interface.view(state));
    if let Some(normal) = &change.normal {
        interface.definition.laws.normal = normal.clone();
        interface.definition.laws.user.normal = None;
    }
    if let Some(friction) = &change.friction {
        interface.definition.laws.friction = friction.clone();
        interface.definition.laws.user.friction = None;
    }
    stored_energy(interface.view(state)) - before
}

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// `[probe.NAME]`: quantities written to `history.csv` at every increment and to the summary at the end.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct Probe {
    /// The body of a `point`; may be left out if there is only one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub of: Option<String>,
    /// What is probed.
    #[serde(flatten)]
    pub what: Probed,
}

/// What a [`Probe`] follows.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Probed {
    /// Displacement and stress at the mesh point nearest to these undeformed coordinates [length].
    Point(Vec<f64>),
    /// Force of an interface, its centre, and the areas open, in contact, sticking and sliding.
    Interface(String),
    /// Reaction force of a support.
    Support(String),
}

use serde::{Deserialize, Serialize};

/// `[probe.NAME]`: a point whose displacement and stress are written to `history.csv` at every increment and to the
/// summary at the end. The forces of interfaces and the reactions of supports are there without being asked for.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct Probe {
    /// Undeformed coordinates `[length]`; the nearest point of the mesh is taken.
    pub point: Vec<f64>,
    /// The body of the point; that with the nearest point if not given. Where points of several bodies are equally near, it has to be given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub of: Option<String>,
}

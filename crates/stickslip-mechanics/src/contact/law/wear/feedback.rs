use serde::{Deserialize, Serialize};

/// How the worn depth changes the gap.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum Feedback {
    /// The worn depth of both surfaces opens the gap within the increment: it acts as a compliance, wear rate times path, in series with the contact, and
    /// is stable for any increment.
    #[default]
    Implicit,
    /// The worn depth of both surfaces opens the gap in the next increment: stable only while the path of an increment, times the cycles that it stands
    /// for, is below about `4 dx / (π k E*)`, with the spacing `dx` of the nodes, the wear rates `k` and the plane moduli `E*` of both sides. For
    /// comparison.
    Explicit,
    /// The depth is reported only.
    None,
}

use serde::{Deserialize, Serialize};

/// Whether contact feels what is worn off.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum Feedback {
    /// The worn depth of both surfaces opens the gap, that of the increment at hand too: it acts as a compliance, wear rate times path, in series with
    /// the contact, and is stable whatever the increments.
    #[default]
    Implicit,
    /// The worn depth of both surfaces opens the gap from the next increment on: at no less cost, and stable only as long as the path of an increment, times the cycles
    /// that it stands for, is below about `4 dx / (π k E*)`, with the spacing `dx` of the nodes, the wear rates `k` and the plane moduli `E*` of both sides. For comparison.
    Explicit,
    /// The depth is reported, and the surfaces stay as they are.
    None,
}

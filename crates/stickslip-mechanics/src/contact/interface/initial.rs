//! What becomes of the gaps that the meshes have when an interface begins to act.

use serde::{Deserialize, Serialize};

use super::history::Origin;
use crate::tolerance::NEGLIGIBLE;

/// Treatment of initial gaps and overlaps of the meshes.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum Start {
    /// Gaps and overlaps are used as meshed.
    #[default]
    AsMeshed,
    /// Points of the secondary within the tolerance are moved onto the primary before the analysis, without strain.
    Snap,
    /// Gaps are measured from their initial value, where that is within the tolerance or negative: contact is closed at the start, or open by
    /// `initial-gap`.
    Offset,
    /// Overlap is resolved linearly over the first step in which the interface acts (shrink fit).
    Ramp,
}

/// How an interface starts.
#[derive(Debug, Clone, PartialEq)]
pub struct Initial {
    /// What becomes of the gaps.
    pub start: Start,
    /// Gap up to which points are moved, count as closed or are glued; what is usual if not given.
    pub within: Option<Within>,
    /// What the gap counts as where it does not count as it is `[m]`.
    pub gap: f64,
    /// Points of the mesh that may be moved, ascending; all if not given.
    pub only: Option<Vec<usize>>,
}

/// How near a point has to be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Within {
    /// Relative to the height of the cell beneath `[-]`.
    Fraction(f64),
    /// A length `[m]`.
    Distance(f64),
}

impl Within {
    /// The distance for a point above a cell of this height `[m]`.
    pub fn of(self, height: f64) -> f64 {
        match self {
            Within::Fraction(fraction) => fraction * height,
            Within::Distance(distance) => distance,
        }
    }
}

/// How near a point has to be to be moved or to count as closed, if nothing else is said.
pub const CLOSE: Within = Within::Fraction(0.1);

/// Gap relative to the cell beneath up to which a point counts as touching: one that makes no difference to a result.
pub(in crate::contact) const TOUCHING: f64 = NEGLIGIBLE;

/// How near tied surfaces have to be to be glued, if nothing else is said.
pub const GLUE: Within = Within::Fraction(0.5);

impl Default for Initial {
    fn default() -> Self {
        Initial::new(Start::default(), None)
    }
}

impl Initial {
    /// Of all points.
    pub fn new(start: Start, within: Option<Within>) -> Self {
        Initial {
            start,
            within,
            gap: 0.0,
            only: None,
        }
    }

    /// What is subtracted from the gap of a point at time `t` `[m]`.
    pub(in crate::contact) fn offset(&self, origin: &Origin, i: usize, t: f64) -> f64 {
        let Some(&offset) = origin.offset.get(i) else {
            return 0.0;
        };
        match self.start {
            Start::Ramp => {
                let [from, to] = origin.span;
                offset * (1.0 - ((t - from) / (to - from)).clamp(0.0, 1.0))
            }
            _ => offset,
        }
    }
}

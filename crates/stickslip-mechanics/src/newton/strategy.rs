//! What is tried, in which order, before an increment is made smaller.

use serde::Serialize;

use crate::keep::{Broken, Keep, Kept};

/// How an equilibrium is looked for. When one way fails the next one is tried; the order is always the same.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Strategy {
    /// Semi-smooth Newton. Steps are shortened only if they make matters much worse.
    #[default]
    Plain,
    /// Points that keep changing status keep a choice until the rest has settled; see [`ActiveSet`](crate::system::ActiveSet).
    StatusMemory,
    /// From the guess again, and every step has to reduce the merit function: `√(|r_u|² + |r_λ|²)`, the norm of the out-of-balance forces and
    /// of the residuals of the multipliers times the areas they act on, both forces. Newton's direction is one of descent for it. It is compared
    /// with the largest of the last three iterates ([Grippo, Lampariello and Lucidi](stickslip_base::references::grippo_1986)), as a change of status may have to go uphill.
    LineSearch,
    /// From the guess again, through easier forces of the [name](crate::system::Way::name) to those wanted.
    Continuation(&'static str),
    /// From the guess again, by the forces: the increment as a [friction problem](crate::friction), then plain iteration from its solution.
    FrictionProblem,
}

/// A way other than the plain one that was tried.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub struct Fallback {
    /// Which.
    pub kind: Strategy,
    /// Newton iterations it took.
    pub iterations: usize,
    /// Whether it found the equilibrium.
    pub converged: bool,
}

impl Strategy {
    /// The name in the summary.
    pub fn key(self) -> &'static str {
        match self {
            Strategy::Plain => "plain",
            Strategy::StatusMemory => "status-memory",
            Strategy::LineSearch => "line-search",
            Strategy::Continuation(name) => name,
            Strategy::FrictionProblem => "friction-problem",
        }
    }

    /// For messages.
    pub fn name(self) -> String {
        match self {
            Strategy::Plain => "plain iteration".to_string(),
            other => other.key().replace('-', " "),
        }
    }
}

impl Serialize for Strategy {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.key())
    }
}

impl Keep for Strategy {
    fn keep(&self, out: &mut Vec<u8>) {
        self.key().keep(out);
    }

    fn back(from: &mut Kept) -> Result<Self, Broken> {
        Ok(match <&str>::back(from)? {
            "plain" => Strategy::Plain,
            "status-memory" => Strategy::StatusMemory,
            "line-search" => Strategy::LineSearch,
            name => Strategy::Continuation(name),
        })
    }
}

crate::keep!(Fallback {
    kind,
    iterations,
    converged
});

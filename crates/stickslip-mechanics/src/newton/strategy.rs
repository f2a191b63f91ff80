//! What is tried, in which order, before an increment is made smaller.

use serde::Serialize;

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

crate::keep!(Strategy[Plain, StatusMemory, LineSearch, Continuation(name), FrictionProblem]);
crate::keep!(Fallback {
    kind,
    iterations,
    converged
});

#[cfg(test)]
mod tests {
    use super::*;
    use crate::keep::{Keep, Kept};

    #[test]
    fn every_strategy_comes_back_as_what_it_was() {
        for strategy in [
            Strategy::Plain,
            Strategy::StatusMemory,
            Strategy::LineSearch,
            Strategy::Continuation("softer-stick"),
            // A name that one of the others has in the summary, too.
            Strategy::Continuation("plain"),
            Strategy::FrictionProblem,
        ] {
            let mut bytes = Vec::new();
            strategy.keep(&mut bytes);
            assert_eq!(Strategy::back(&mut Kept::new(&bytes)), Ok(strategy));
        }
    }
}

//! What is tried before an increment is made smaller.

use serde::Serialize;

/// How an equilibrium is looked for. When the first way fails the other one is tried.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, crate::keep::Keep)]
pub enum Strategy {
    /// Semi-smooth Newton. Steps are shortened only if they make matters much worse.
    #[default]
    Plain,
    /// From the guess again, by the forces: the increment as a [friction problem](crate::friction), then plain iteration from its solution.
    FrictionProblem,
}

/// A way other than the plain one that was tried.
#[derive(Debug, Clone, PartialEq, Serialize, crate::keep::Keep)]
#[serde(rename_all = "kebab-case")]
pub struct Fallback {
    /// Which.
    pub kind: Strategy,
    /// Newton iterations it took.
    pub iterations: usize,
    /// Whether it found the equilibrium.
    pub converged: bool,
    /// Of the solvers that its friction problems took one after the other the one that comes last in the portfolio; `first guess` where they took none.
    pub solver: String,
}

impl Strategy {
    /// The name in the summary.
    pub fn key(self) -> &'static str {
        match self {
            Strategy::Plain => "plain",
            Strategy::FrictionProblem => "friction-problem",
        }
    }

    /// For messages.
    pub fn name(self) -> String {
        match self {
            Strategy::Plain => "plain iteration".to_string(),
            Strategy::FrictionProblem => "friction problem".to_string(),
        }
    }
}

impl Serialize for Strategy {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.key())
    }
}

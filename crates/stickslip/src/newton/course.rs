//! What is tried, in which order, before an increment is made smaller.

use serde::Serialize;

/// How an equilibrium is looked for. When one way fails the next one is tried; the order is always the same.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Course {
    /// Semi-smooth Newton. Steps are shortened only if they make matters much worse.
    #[default]
    Plain,
    /// Points that keep changing status keep a choice until the rest has settled; see [`steady`](crate::system::Force::steady).
    StatusMemory,
    /// From the guess again, and every step has to reduce the merit function: `√(|r_u|² + |r_λ|²)`, the norm of the out-of-balance forces and
    /// of the residuals of the multipliers times the areas they act on, both forces. Newton's direction is one of descent for it. It is compared
    /// with the largest of the last [`WINDOW`] iterates (Grippo, Lampariello and Lucidi), as a change of status may have to go uphill.
    LineSearch,
    /// Stick that yields like the bodies at first, then ever more stiffly.
    SofterStick,
    /// A part of the limit of friction at first, then all of it.
    PartialFriction,
}

/// Iterates over which the merit function may stay as it is.
pub const WINDOW: usize = 3;

/// Parts of friction through which a continuation goes.
pub const PARTS: [f64; 4] = [0.25, 0.5, 0.75, 0.9];

/// A way other than the plain one that was tried.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub struct Fallback {
    /// Which.
    pub kind: Course,
    /// Newton iterations it took.
    pub iterations: usize,
    /// Whether it found the equilibrium.
    pub converged: bool,
}

impl Course {
    /// For messages.
    pub fn name(self) -> &'static str {
        match self {
            Course::Plain => "plain iteration",
            Course::StatusMemory => "status memory",
            Course::LineSearch => "line search",
            Course::SofterStick => "softer stick",
            Course::PartialFriction => "partial friction",
        }
    }
}

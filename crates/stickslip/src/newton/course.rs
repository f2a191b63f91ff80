//! What is tried, in which order, before an increment is made smaller.

use serde::Serialize;

use super::settings::Progress;
use super::solve::{Converged, Newton, System};
use crate::system::{State, StepFailure};

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
    /// with the largest of the last three iterates (Grippo, Lampariello and Lucidi), as a change of status may have to go uphill.
    LineSearch,
    /// Stick that yields like the bodies at first, then ever more stiffly.
    SofterStick,
    /// A part of the limit of friction at first, then all of it.
    PartialFriction,
}

/// Iterates over which the merit function may stay as it is.
pub(super) const WINDOW: usize = 3;

/// Parts of friction through which a continuation goes.
const PARTS: [f64; 4] = [0.25, 0.5, 0.75, 0.9];

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

impl Newton {
    /// Tries one way; `None` if it does not apply.
    pub(super) fn follow(
        &mut self,
        course: Course,
        system: &mut System,
        from: &State,
        at: &mut State,
        guess: &[f64],
        log: &mut dyn FnMut(&Progress),
    ) -> Option<Result<Converged, StepFailure>> {
        match course {
            Course::Plain => None,
            Course::StatusMemory => {
                // It goes on from where the points went to and fro; if that is no good place, it starts again with those points sticking.
                if hold(system, true) == 0 {
                    hold(system, false);
                    return None;
                }
                let mut outcome = self.rounds(system, from, at, log);
                if outcome.is_err() {
                    restart(system, at, guess);
                    outcome = self.rounds(system, from, at, log);
                }
                hold(system, false);
                Some(outcome)
            }
            Course::LineSearch => {
                restart(system, at, guess);
                Some(self.rounds(system, from, at, log))
            }
            Course::SofterStick => {
                // What holds a body may be far softer than the body itself: then so must stick be.
                let mut last = None;
                for first in [1.0, 1e-3, 1e-6, 1e-9] {
                    restart(system, at, guess);
                    if !soften(system, Some(first)) {
                        return None;
                    }
                    self.statistics.continuations += 1;
                    let outcome = self.continuation(first, system, from, at, log);
                    soften(system, None);
                    let done = outcome.is_ok();
                    last = Some(outcome);
                    if done {
                        break;
                    }
                }
                last
            }
            Course::PartialFriction => {
                restart(system, at, guess);
                if !mobilise(system, Some(PARTS[0])) {
                    return None;
                }
                let outcome = self.mobilisation(system, from, at, log);
                mobilise(system, None);
                Some(outcome)
            }
        }
    }

    /// Equilibria under ever more friction, each from the one before.
    fn mobilisation(
        &mut self,
        system: &mut System,
        from: &State,
        at: &mut State,
        log: &mut dyn FnMut(&Progress),
    ) -> Result<Converged, StepFailure> {
        let mut iterations = 0;
        for part in PARTS {
            mobilise(system, Some(part));
            iterations += self.equilibrium(system, from, at, 0, log)?.iterations;
        }
        mobilise(system, None);
        let mut converged = self.rounds(system, from, at, log)?;
        converged.iterations += iterations;
        Ok(converged)
    }

    fn continuation(
        &mut self,
        first: f64,
        system: &mut System,
        from: &State,
        at: &mut State,
        log: &mut dyn FnMut(&Progress),
    ) -> Result<Converged, StepFailure> {
        let mut iterations = 0;
        let last = 3e4;
        for k in 0.. {
            // 1, 3, 10, 30, …
            let factor = first * 10_f64.powi(k / 2) * if k % 2 == 0 { 1.0 } else { 3.0 };
            if factor > last {
                break;
            }
            soften(system, Some(factor));
            iterations += self.equilibrium(system, from, at, 0, log)?.iterations;
        }
        soften(system, None);
        let mut converged = self.rounds(system, from, at, log)?;
        converged.iterations += iterations;
        Ok(converged)
    }
}

/// Starts an attempt at the guess.
pub(super) fn restart(system: &mut System, at: &mut State, guess: &[f64]) {
    at.u.copy_from_slice(guess);
    for force in &mut system.contact {
        force.begin();
    }
    system.bulk.begin();
}

/// Holds points that keep changing status from now on, or no more; returns how many there are.
pub(super) fn hold(system: &mut System, on: bool) -> usize {
    system.contact.iter_mut().map(|f| f.steady(on)).sum()
}

/// Softens stick; `false` if there is none.
fn soften(system: &mut System, factor: Option<f64>) -> bool {
    let forces = system.contact.iter_mut();
    // every force has to hear of it
    forces
        .map(|f| f.soften(factor))
        .filter(|&soft| soft)
        .count()
        > 0
}

/// Lets a part of friction act; `false` if there is none.
fn mobilise(system: &mut System, part: Option<f64>) -> bool {
    let forces = system.contact.iter_mut();
    forces
        .map(|f| f.mobilise(part))
        .filter(|&part| part)
        .count()
        > 0
}

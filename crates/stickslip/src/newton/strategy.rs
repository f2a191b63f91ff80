//! What is tried, in which order, before an increment is made smaller.

use serde::Serialize;

use super::settings::Progress;
use super::solve::{Converged, Newton, System};
use crate::system::{ActiveSet, State, StepFailure, Way};

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
    /// with the largest of the last three iterates ([Grippo, Lampariello and Lucidi](crate::references::grippo_1986)), as a change of status may have to go uphill.
    LineSearch,
    /// From the guess again, through easier forces of the [name](crate::system::Way::name) to those wanted.
    Continuation(&'static str),
}

/// Iterates over which the merit function may stay as it is.
pub(super) const WINDOW: usize = 3;

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

impl Newton {
    /// Tries one way; `None` if it does not apply.
    pub(super) fn follow(
        &mut self,
        strategy: Strategy,
        system: &mut System,
        from: &State,
        at: &mut State,
        guess: &[f64],
        log: &mut dyn FnMut(&Progress),
    ) -> Option<Result<Converged, StepFailure>> {
        match strategy {
            Strategy::Plain => None,
            Strategy::StatusMemory => {
                // It goes on from where the points went to and fro; if that is no good place, it starts again with those points sticking.
                if freeze(system, true) == 0 {
                    freeze(system, false);
                    return None;
                }
                let mut outcome = self.rounds(system, from, at, log);
                if outcome.is_err() {
                    restart(system, at, guess);
                    outcome = self.rounds(system, from, at, log);
                }
                freeze(system, false);
                Some(outcome)
            }
            Strategy::LineSearch => {
                restart(system, at, guess);
                Some(self.rounds(system, from, at, log))
            }
            Strategy::Continuation(name) => {
                let mut last = None;
                for way in ways(system).into_iter().filter(|way| way.name == name) {
                    restart(system, at, guess);
                    self.statistics.continuations += 1;
                    let outcome = self.continuation(&way, system, from, at, log);
                    ease(system, None);
                    let done = outcome.is_ok();
                    last = Some(outcome);
                    if done {
                        break;
                    }
                }
                last
            }
        }
    }

    /// Equilibria under forces that are ever less easy, each from the one before.
    fn continuation(
        &mut self,
        way: &Way,
        system: &mut System,
        from: &State,
        at: &mut State,
        log: &mut dyn FnMut(&Progress),
    ) -> Result<Converged, StepFailure> {
        let mut iterations = 0;
        for &value in &way.values {
            ease(system, Some((way.name, value)));
            iterations += self.equilibrium(system, from, at, 0, log)?.iterations;
        }
        ease(system, None);
        let mut converged = self.rounds(system, from, at, log)?;
        converged.iterations += iterations;
        Ok(converged)
    }
}

/// All strategies but the plain one, in the order in which they are tried.
pub(super) fn strategies(system: &mut System) -> Vec<Strategy> {
    let mut all = vec![Strategy::StatusMemory, Strategy::LineSearch];
    for way in ways(system) {
        let strategy = Strategy::Continuation(way.name);
        if !all.contains(&strategy) {
            all.push(strategy);
        }
    }
    all
}

/// The ways of the first force that has any; forces of a kind have the same.
fn ways(system: &mut System) -> Vec<Way> {
    let mut forces = system.contact.iter_mut();
    let found = forces.find_map(|f| f.continuation().map(|c| c.ways()));
    found.unwrap_or_default()
}

/// Makes all forces easier that can be made so.
fn ease(system: &mut System, to: Option<(&'static str, f64)>) {
    let forces = system.contact.iter_mut();
    forces
        .filter_map(|f| f.continuation())
        .for_each(|c| c.ease(to));
}

/// Starts an attempt at the guess.
pub(super) fn restart(system: &mut System, at: &mut State, guess: &[f64]) {
    at.u.copy_from_slice(guess);
    for force in &mut system.contact {
        force.begin();
    }
    system.bulk.begin();
}

/// Freezes points that chatter from now on, or no more; returns how many there are.
pub(super) fn freeze(system: &mut System, on: bool) -> usize {
    active_sets(system).map(|f| f.freeze(on)).sum()
}

/// The forces that have points which change status.
pub(super) fn active_sets<'a>(
    system: &'a mut System,
) -> impl Iterator<Item = &'a mut (dyn ActiveSet + 'a)> {
    system.contact.iter_mut().filter_map(|f| f.active_set())
}

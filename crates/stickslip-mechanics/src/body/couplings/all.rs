//! Couplings with all that they know.

use super::definition::{Act, Coupling, CouplingsDefinition, StepTimes, Tie};
use super::drawn::draw;
use super::elimination::Elimination;
use super::memory::CouplingsMemory;
use super::view::CouplingsView;
use crate::system::State;

/// All couplings of a model, as one force.
///
/// An equation has a multiplier `λ`, the force that acts along its row. It is an unknown of Newton's method, eliminated row by row with a stiffness
/// `ω` much above that of the bodies and of contact: `λ` goes on by `ω (g + B du)`, `g` what the equation is off. At the solution `g` is zero whatever `ω`, and equations
/// that repeat others do no harm. That is the method of multipliers with an update in every iteration, where the constraints are linear. A gap is
/// an equation where `λ + ω g < 0`, and where not `λ` goes to zero.
#[derive(Debug, Clone, Default)]
pub struct Couplings {
    /// What they are.
    pub definition: CouplingsDefinition,
    /// By row, over all couplings.
    pub(super) hold: Vec<Hold>,
    pub(super) iterate: Iterate,
    pub(super) elimination: Elimination,
    pub(super) explicit: bool,
    /// Forces with which equations hold over an explicit increment, by row; empty before one.
    pub(super) exact: Vec<ExactForce>,
}

/// Couplings as a force, which goes on from what accepted increments have left.
#[derive(Debug)]
pub struct CouplingsForce<'a> {
    pub(super) couplings: &'a mut Couplings,
    pub(super) memory: &'a CouplingsMemory,
}

/// The force along an equation that an explicit increment holds exactly `[N]`.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct ExactForce {
    /// From the start, so that the equation holds at the end.
    pub from: f64,
    /// At the end, so that it goes on holding.
    pub to: f64,
    /// What is reported: with what moving supports and values accelerate.
    pub shown: f64,
}

/// How an equation is enforced.
#[derive(Debug, Clone, Copy, Default, PartialEq, crate::keep::Keep)]
pub(super) struct Hold {
    /// Stiffness by which its multiplier is eliminated `[N/m]`.
    pub stiffness: f64,
    /// Everything in it is prescribed: there is nothing to be enforced.
    pub idle: bool,
}

/// Multipliers of an attempt.
#[derive(Debug, Clone, Default, crate::keep::Keep)]
pub(super) struct Iterate {
    /// At the last iterate, with what the equations are off there, and now. Gaps that are open are off by infinity; the multiplier of a dashpot is its
    /// force.
    pub last: Vec<f64>,
    pub off: Vec<f64>,
    pub now: Vec<f64>,
    pub off_now: Vec<f64>,
}

/// What acts along the rows beside springs: multipliers, and dashpots at these velocities.
#[derive(Clone, Copy)]
struct Forces<'a> {
    multipliers: &'a [f64],
    velocities: Option<&'a [f64]>,
}

impl std::ops::Deref for Couplings {
    type Target = CouplingsDefinition;

    fn deref(&self) -> &CouplingsDefinition {
        &self.definition
    }
}

impl Couplings {
    /// Couplings of the points of a space of this dimension.
    pub fn new(all: Vec<Coupling>, dim: usize) -> Self {
        let definition = CouplingsDefinition::new(all, dim);
        let none = vec![0.0; definition.rows().count()];
        Couplings {
            hold: vec![Hold::default(); none.len()],
            iterate: Iterate {
                last: none.clone(),
                off: none.clone(),
                now: none.clone(),
                off_now: none,
            },
            definition,
            ..Couplings::default()
        }
    }

    /// They as those see them who only look.
    pub fn view<'a>(&'a self, memory: &'a CouplingsMemory) -> CouplingsView<'a> {
        CouplingsView {
            definition: &self.definition,
            state: memory,
        }
    }

    /// They as a force that goes on from there.
    pub fn force<'a>(&'a mut self, memory: &'a CouplingsMemory) -> CouplingsForce<'a> {
        CouplingsForce {
            couplings: self,
            memory,
        }
    }

    /// Begins a step: equations that begin to act start from what their sums are at displacements `u`, and those that end hand out the forces
    /// they let go with, by dof `[N]`, as loads. Pretensions go on from force or shortening.
    pub fn begin_step(
        &self,
        memory: &mut CouplingsMemory,
        times: StepTimes,
        u: &[f64],
        let_go: &mut dyn FnMut(usize, f64),
    ) {
        let mut first = 0;
        for coupling in self.definition.all() {
            let rows = first..first + coupling.rows.len();
            first = rows.end;
            match &coupling.tie {
                Tie::Pretension(p) => {
                    draw(memory, p, times, rows, &coupling.rows, u);
                    continue;
                }
                tie if !tie.firm() => continue,
                _ => {}
            }
            let was = times.before.is_some_and(|t| coupling.schedule.active(t));
            let is = coupling.schedule.active(times.middle);
            for (i, row) in rows.zip(&coupling.rows) {
                if is && !was {
                    memory.start[i] = row.sum(u);
                    memory.targets[i] = memory.start[i];
                }
                if was && !is {
                    let multiplier = memory.multipliers[i];
                    row.terms()
                        .for_each(|(dof, a)| let_go(dof, -multiplier * a));
                    memory.multipliers[i] = 0.0;
                    memory.forces[i] = 0.0;
                }
            }
        }
    }

    /// Begins motion at velocities `v`: the forces that dashpots have there.
    pub fn begin_motion(&self, memory: &mut CouplingsMemory, t: f64, v: &[f64]) {
        let definition = &self.definition;
        for (i, coupling, row) in definition.rows() {
            if matches!(coupling.tie, Tie::Dashpot { .. }) && !v.is_empty() {
                memory.forces[i] = match definition.act(i, coupling, memory.start[i], t) {
                    Act::Damped(coefficient) => coefficient * row.sum(v),
                    _ => 0.0,
                };
            }
        }
    }

    /// Adds the forces of the last accepted state, which has these displacements and velocities, to the internal ones, by dof.
    pub fn add_initial(&self, memory: &CouplingsMemory, state: &State, out: &mut [f64]) {
        let State { t, u, v, .. } = state;
        let forces = Forces {
            multipliers: &memory.multipliers,
            velocities: Some(v),
        };
        self.add_forces(self.view(memory), *t, u, forces, out);
    }

    /// The same for the last attempt, which ended at `u`.
    pub fn add_tried(&self, memory: &CouplingsMemory, t: f64, u: &[f64], out: &mut [f64]) {
        let forces = Forces {
            multipliers: &self.iterate.now,
            velocities: None,
        };
        self.add_forces(self.view(memory), t, u, forces, out);
    }

    fn add_forces(&self, view: CouplingsView, t: f64, u: &[f64], forces: Forces, out: &mut [f64]) {
        let Forces {
            multipliers,
            velocities,
        } = forces;
        for (i, coupling, row) in self.rows() {
            let force = match (view.act(i, coupling, t), velocities) {
                (Act::Idle, _) | (Act::Damped(_), Some([])) => continue,
                (Act::Damped(coefficient), Some(v)) => coefficient * row.sum(v),
                (Act::Damped(_), None) | (Act::Held(_) | Act::Stopped(_), _) => {
                    multipliers.get(i).copied().unwrap_or(0.0)
                }
                (Act::Sprung(stiffness), _) => stiffness * coupling.tie.stretch(row.sum(u)),
                (Act::Pulled(force), _) => force,
            };
            row.terms().for_each(|(dof, a)| out[dof] += a * force);
        }
    }

    /// Multipliers take over from springs: they have the forces that these had. The energy of the springs that is gone, negative.
    pub(super) fn keep_forces(&self, memory: &mut CouplingsMemory) -> f64 {
        let Couplings {
            definition,
            iterate,
            ..
        } = self;
        let before = memory.stored;
        memory.multipliers.clone_from(&memory.forces);
        memory.stored = 0.0;
        for (i, coupling, _) in definition.rows() {
            let target = memory.targets[i];
            match coupling.tie {
                // The way back to where the equation holds costs work.
                Tie::Equation { .. } | Tie::Pretension(_) => {
                    memory.targets[i] += iterate.off_now[i];
                }
                Tie::Spring { .. } | Tie::Gap { .. } if target > 0.0 => {
                    memory.stored += 0.5 * memory.forces[i].powi(2) / target;
                }
                _ => {}
            }
        }
        memory.stored - before
    }

    /// What they know at the start of the analysis, at displacements `u`.
    pub fn begin_analysis(&self, t: f64, u: &[f64]) -> CouplingsMemory {
        let targets = self.rows().map(|(_, coupling, _)| {
            let own = match &coupling.tie {
                Tie::Dashpot { coefficient } => *coefficient,
                tie => tie.stiffness(),
            };
            let first = coupling.schedule.pieces.first();
            own * first.map_or(1.0, |p| coupling.schedule.at(p.start))
        });
        let targets: Vec<f64> = targets.collect();
        let none = vec![0.0; targets.len()];
        let mut memory = CouplingsMemory {
            multipliers: none.clone(),
            forces: none.clone(),
            start: none,
            targets,
            ..CouplingsMemory::default()
        };
        let mut stored = 0.0;
        for (i, coupling, row) in self.rows() {
            if let Act::Sprung(stiffness) = self.view(&memory).act(i, coupling, t) {
                let stretch = coupling.tie.stretch(row.sum(u));
                stored += 0.5 * stiffness * stretch.powi(2);
            }
        }
        memory.stored = stored;
        memory
    }
}

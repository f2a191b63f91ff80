//! Couplings as a force.

use super::all::Iterate;
use super::definition::Act;
use super::elimination::ELIMINATION_STIFFNESS;
use super::{Couplings, CouplingsForce, CouplingsMemory, Row, Tie};
use crate::body::couplings::fit;
use crate::math::larger;
use crate::number::figure;
use crate::system::{Assembler, Cause, Force, Stage, StepFailure, Tangent};
use crate::tolerance::SAME;

impl std::ops::Deref for CouplingsForce<'_> {
    type Target = Couplings;

    fn deref(&self) -> &Couplings {
        self.couplings
    }
}

impl std::ops::DerefMut for CouplingsForce<'_> {
    fn deref_mut(&mut self) -> &mut Couplings {
        self.couplings
    }
}

/// Force and stiffness of a gap that presses with a negative force; none where it would pull.
fn closed(force: f64, stiffness: f64) -> (f64, f64) {
    match force > 0.0 {
        true => (0.0, 0.0),
        false => (force, stiffness),
    }
}

/// A row with a multiplier that is eliminated.
struct Multiplied<'a> {
    row: &'a Row,
    gap: bool,
    /// The multiplier `[N]`.
    known: f64,
    /// By how much the row asks it to change `[N]`.
    pull: f64,
    /// Stiffness of the bodies over that with which it is eliminated.
    bodies: f64,
}

impl Multiplied<'_> {
    /// Enters what eliminating the multiplier adds; whether it is that of a gap that is open.
    fn eliminate(&self, out: &mut Assembler) -> bool {
        let open = self.gap && self.known + self.pull > 0.0;
        // The multiplier of a gap that is open goes to zero.
        let pull = if open { -self.known } else { self.pull };
        let terms = self.row.terms();
        terms.for_each(|(dof, a)| out.condensed[dof] += a * pull);
        let size = self.row.norm() * pull.abs();
        // A gap that has just closed is off by far more than what it will bear.
        let fresh = self.gap && self.known == 0.0;
        let size = if fresh { size * self.bodies } else { size };
        out.multiplier_residual = larger(out.multiplier_residual, size);
        open
    }
}

impl Force for CouplingsForce<'_> {
    fn begin(&mut self) {
        let multipliers = &self.memory.multipliers;
        self.couplings.iterate.now.clone_from(multipliers);
        self.couplings.iterate.last.clone_from(multipliers);
        self.iterate.off.fill(0.0);
        fit::fit_alone(self);
    }

    fn assemble(&mut self, stage: &Stage, out: &mut Assembler) -> Result<(), StepFailure> {
        let explicit = self.explicit;
        if out.wants_tangent && !explicit {
            fit::fit_beside(self, &out.blocks);
        }
        let memory = self.memory;
        let Couplings {
            definition,
            hold,
            iterate: Iterate { now, off_now, .. },
            elimination,
            ..
        } = &mut *self.couplings;
        let mut scratch = Scratch::default();
        let mut failure = None;
        let u = &stage.at.u;
        for (i, coupling, row) in definition.rows() {
            let sum = row.sum(u);
            let hold = hold[i];
            let act = definition.act(i, coupling, memory.start[i], stage.at.t);
            let (force, stiffness) = match act {
                Act::Idle => continue,
                Act::Sprung(stiffness) => {
                    let open =
                        matches!(coupling.tie, Tie::Gap { clearance, .. } if sum + clearance > 0.0);
                    let force = stiffness * coupling.tie.stretch(sum);
                    (force, if open { 0.0 } else { stiffness })
                }
                Act::Pulled(force) => {
                    scratch.push(row, force, out);
                    continue;
                }
                Act::Damped(coefficient) => {
                    let force = coefficient * rate_of(row, stage, explicit);
                    now[i] = force;
                    scratch.push(row, force, out);
                    out.add_coupling(&row.dofs);
                    if let Some(rate) = &stage.rate {
                        let gain = |k: usize| coefficient * rate.gain[row.dofs[k]] / stage.dt;
                        scratch.add(row, gain, out);
                    }
                    continue;
                }
                Act::Held(_) | Act::Stopped(_) => {
                    let (off, gap) = match act {
                        Act::Stopped(clearance) => (sum + clearance, true),
                        _ => (sum - act.target(), false),
                    };
                    off_now[i] = off;
                    if hold.idle {
                        let size = row.size(u).max((sum - off).abs());
                        let wrong = if gap { -off } else { off.abs() };
                        // An equation of nothing but prescribed displacements may be off by rounding.
                        if wrong > SAME * size {
                            failure.get_or_insert_with(|| contradiction(&coupling.name, off));
                        }
                        continue;
                    }
                    match (explicit, gap) {
                        // Held exactly, by whoever makes the increment.
                        (true, false) => continue,
                        (true, true) => {
                            let pull = hold.stiffness * (off - memory.rest(i));
                            closed(memory.multipliers[i] + pull, hold.stiffness)
                        }
                        (false, _) => {
                            let stiffness = elimination.of(i).unwrap_or(hold.stiffness);
                            let row = Multiplied {
                                row,
                                gap,
                                known: now[i],
                                pull: stiffness * off,
                                bodies: hold.stiffness / (ELIMINATION_STIFFNESS * stiffness),
                            };
                            match row.eliminate(out) {
                                true => {
                                    off_now[i] = f64::INFINITY;
                                    (now[i], 0.0)
                                }
                                false => (now[i], stiffness),
                            }
                        }
                    }
                }
            };
            // what rounding leaves of displacements that are large
            let rounding = 4.0 * f64::EPSILON * stiffness * row.size(u) * row.norm();
            out.rounding += rounding * rounding;
            out.add_coupling(&row.dofs);
            scratch.push(row, force, out);
            if stiffness != 0.0 {
                scratch.add(row, |_| stiffness, out);
            }
        }
        if !out.tentative {
            self.settle();
        }
        failure.map_or(Ok(()), Err)
    }

    fn settle(&mut self) {
        let Iterate {
            last,
            off,
            now,
            off_now,
        } = &mut self.couplings.iterate;
        last.clone_from(now);
        off.clone_from(off_now);
    }

    fn update_internal(&mut self, du: &[f64], step: f64) {
        let Couplings {
            definition,
            hold,
            iterate,
            elimination,
            ..
        } = &mut *self.couplings;
        for (i, coupling, row) in definition.rows() {
            let hold = hold[i];
            if !coupling.tie.firm() || hold.idle {
                continue;
            }
            let stiffness = elimination.of(i).unwrap_or(hold.stiffness);
            let (last, off) = (iterate.last[i], iterate.off[i]);
            iterate.now[i] = match off.is_finite() {
                true => last + step * stiffness * (off + row.sum(du)),
                false => (1.0 - step) * last,
            };
        }
    }
}

/// What they know after an attempt that is accepted.
pub fn commit(couplings: &Couplings, before: &CouplingsMemory, stage: &Stage) -> CouplingsMemory {
    let (explicit, now) = (couplings.explicit, &couplings.iterate.now);
    let definition = &couplings.definition;
    let mut memory = before.clone();
    let (u, before) = (&stage.at.u, &stage.from.u);
    let at_rest = stage.rate.is_none() && !explicit;
    memory.stored = 0.0;
    memory.work = 0.0;
    memory.damped = 0.0;
    for (i, coupling, row) in definition.rows() {
        let (sum, sum_before) = (row.sum(u), row.sum(before));
        let act = match (
            definition.act(i, coupling, memory.start[i], stage.at.t),
            &coupling.tie,
        ) {
            // what is taken away lets go of what it has
            (Act::Idle, Tie::Dashpot { .. }) => Act::Damped(0.0),
            (Act::Idle, tie) if !tie.firm() => Act::Sprung(0.0),
            (act, _) => act,
        };
        let target = act.target();
        let was = memory.targets[i];
        memory.targets[i] = target;
        match act {
            Act::Held(_) => {
                let [from, to, shown] = match explicit {
                    true => {
                        let exact = couplings.exact.get(i).copied().unwrap_or_default();
                        [exact.from, exact.to, exact.shown]
                    }
                    false => [memory.forces[i], now[i], now[i]],
                };
                memory.work -= 0.5 * (from + to) * (target - was);
                memory.multipliers[i] = to;
                memory.forces[i] = shown;
            }
            Act::Pulled(force) => {
                memory.work -= 0.5 * (memory.forces[i] + force) * (sum - sum_before);
                memory.forces[i] = force;
            }
            Act::Damped(coefficient) => {
                let force = match stage.rate {
                    _ if !coupling.schedule.active(stage.at.t) => 0.0,
                    // The force of the half-step, at which velocities are known there.
                    None => now[i],
                    Some(_) => coefficient * rate_of(row, stage, explicit),
                };
                memory.damped += 0.5 * (memory.forces[i] + force) * (sum - sum_before);
                memory.forces[i] = force;
            }
            Act::Stopped(clearance) => {
                let (held, hold) = (memory.multipliers[i], couplings.hold[i]);
                let rest = memory.rest(i);
                let force = match (hold.idle, explicit) {
                    (true, _) => 0.0,
                    (false, true) => (held + hold.stiffness * (sum + clearance - rest)).min(0.0),
                    (false, false) => now[i],
                };
                if explicit && !hold.idle && hold.stiffness > 0.0 {
                    memory.stored += (force * force - held * held) / (2.0 * hold.stiffness);
                } else {
                    memory.multipliers[i] = force;
                }
                let forces = [memory.forces[i], force];
                memory.forces[i] = force;
                let way = Way {
                    length: sum - sum_before,
                    stored: 0.0,
                };
                memory.work += missed(at_rest, forces, way);
            }
            Act::Sprung(_) => {
                let [x, y] = [sum, sum_before].map(|s| coupling.tie.stretch(s));
                memory.work += 0.25 * (x * x + y * y) * (target - was);
                memory.stored += 0.5 * target * x * x;
                if matches!(coupling.tie, Tie::Gap { .. }) {
                    let mean = 0.5 * (target + was);
                    let stored = 0.5 * mean * (x * x - y * y);
                    let way = Way {
                        length: sum - sum_before,
                        stored,
                    };
                    memory.work += missed(at_rest, [mean * y, mean * x], way);
                }
                memory.forces[i] = target * x;
            }
            Act::Idle => {}
        }
    }
    memory
}

/// What the sum of a row changes at per time: as the scheme of the increment has it, or as it is known. Nothing where inertia plays no part.
fn rate_of(row: &Row, stage: &Stage, explicit: bool) -> f64 {
    let Some(rate) = &stage.rate else {
        return match explicit {
            true => row.sum(&stage.at.v),
            false => 0.0,
        };
    };
    let (u, from) = (&stage.at.u, &stage.from.u);
    let moved = |dof: usize| rate.gain[dof] * (u[dof] - from[dof]) + rate.shift[dof];
    let sum: f64 = row.terms().map(|(dof, a)| a * moved(dof)).sum();
    sum / stage.dt
}

/// What the sum of a row changes by over an increment `[m]`, and what is stored on the way `[J]`.
struct Way {
    length: f64,
    stored: f64,
}

/// Work on the bodies that the trapezoidal rule counts over a way on which a gap opens or closes, less that along the way: what drives the bodies has done as
/// much more than that rule says. In motion it is an error of the scheme.
fn missed(at_rest: bool, [from, to]: [f64; 2], way: Way) -> f64 {
    match at_rest {
        true => way.stored - 0.5 * (from + to) * way.length,
        false => 0.0,
    }
}

fn contradiction(name: &str, off: f64) -> StepFailure {
    let message = format!(
        "coupling {name}: all displacements of an equation are prescribed, and it is off by {off}",
        off = figure(off)
    );
    StepFailure::new(Cause::NotConverged, message)
        .help("prescribe one displacement less, or values that satisfy the equation")
}

/// Memory for the force and the tangent of one row.
#[derive(Default)]
struct Scratch {
    rows: Vec<f64>,
    change: Vec<f64>,
    surrogate: Vec<f64>,
}

impl Scratch {
    /// Adds the force along a row.
    fn push(&mut self, row: &Row, force: f64, out: &mut Assembler) {
        self.change.clear();
        self.change.extend(row.factors.iter().map(|a| a * force));
        out.add_residual(&row.dofs, &self.change);
    }

    /// Adds the tangent of a row whose force grows by `stiffness` with each of its displacements, the factor apart.
    fn add(&mut self, row: &Row, stiffness: impl Fn(usize) -> f64, out: &mut Assembler) {
        if !out.wants_tangent {
            return;
        }
        let n = row.factors.len();
        self.rows.clear();
        self.rows.extend(&row.factors);
        self.change.clear();
        let change = row.factors.iter().enumerate();
        self.change.extend(change.map(|(k, a)| stiffness(k) * a));
        for to in [&mut self.rows, &mut self.change] {
            to.resize(3 * n, 0.0);
        }
        self.surrogate.clear();
        if out.wants_surrogate {
            for a in &row.factors {
                self.surrogate
                    .extend(self.change[..n].iter().map(|c| a * c));
            }
        }
        let tangent = Tangent {
            rows: &self.rows,
            change: &self.change,
            area: 1.0,
            hessian: &[],
            surrogate: &self.surrogate,
        };
        out.add_tangent(&row.dofs, tangent);
    }
}

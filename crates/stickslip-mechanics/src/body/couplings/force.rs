//! Couplings as a force.

use super::all::Act;
use super::elimination::FIRM;
use super::{Couplings, Row, Tie};
use crate::math::larger;
use crate::system::{Assembler, Cause, Energy, Force, Stage, StepFailure, Tangent};

/// How far an equation of nothing but prescribed displacements may be off, relative to their size.
const AGREED: f64 = 1e-9;

impl Force for Couplings {
    fn begin(&mut self) {
        self.iterate.now.clone_from(&self.memory.multipliers);
        self.iterate.last.clone_from(&self.memory.multipliers);
        self.iterate.off.fill(0.0);
        self.fit_alone();
    }

    fn assemble(&mut self, stage: &Stage, out: &mut Assembler) -> Result<(), StepFailure> {
        if out.wants_tangent && !self.explicit {
            self.fit_beside(&out.blocks);
        }
        let mut off_now = std::mem::take(&mut self.iterate.off_now);
        let mut now = std::mem::take(&mut self.iterate.now);
        let mut scratch = Scratch::default();
        let mut failure = None;
        let u = &stage.at.u;
        for (i, coupling, row) in self.rows() {
            let sum = row.sum(u);
            let hold = self.hold[i];
            let norm = row.norm();
            let act = self.act(i, coupling, stage.at.t);
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
                    let force = coefficient * self.rate_of(row, stage);
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
                        _ => (sum - Couplings::target(act), false),
                    };
                    off_now[i] = off;
                    if hold.idle {
                        let size = row.size(u).max((sum - off).abs());
                        let wrong = if gap { -off } else { off.abs() };
                        if wrong > AGREED * size {
                            failure.get_or_insert_with(|| contradiction(&coupling.name, off));
                        }
                        continue;
                    }
                    if self.explicit && !gap {
                        // Held exactly, by whoever makes the increment.
                        continue;
                    }
                    let stiffness = match self.explicit {
                        true => hold.stiffness,
                        false => self.eliminated_by(i),
                    };
                    let rest = if self.explicit { self.rest(i) } else { 0.0 };
                    let pull = stiffness * (off - rest);
                    let known = match self.explicit {
                        true => self.memory.multipliers[i],
                        false => now[i],
                    };
                    let open = gap && known + pull > 0.0;
                    if self.explicit {
                        match open {
                            true => (0.0, 0.0),
                            false => (known + pull, stiffness),
                        }
                    } else {
                        // The multiplier of a gap that is open goes to zero.
                        let pull = if open { -known } else { pull };
                        row.terms()
                            .for_each(|(dof, a)| out.condensed[dof] += a * pull);
                        let size = norm * pull.abs();
                        // A gap that has just closed is off by far more than what it will bear.
                        let fresh = gap && known == 0.0;
                        let bodies = hold.stiffness / (FIRM * stiffness);
                        let size = if fresh { size * bodies } else { size };
                        out.multiplier_residual = larger(out.multiplier_residual, size);
                        if open {
                            off_now[i] = f64::INFINITY;
                        }
                        (known, if open { 0.0 } else { stiffness })
                    }
                }
            };
            // what rounding leaves of displacements that are large
            let rounding = 4.0 * f64::EPSILON * stiffness * row.size(u) * norm;
            out.rounding += rounding * rounding;
            out.add_coupling(&row.dofs);
            scratch.push(row, force, out);
            if stiffness != 0.0 {
                scratch.add(row, |_| stiffness, out);
            }
        }
        self.iterate.off_now = off_now;
        self.iterate.now = now;
        if !out.tentative {
            self.settle();
        }
        failure.map_or(Ok(()), Err)
    }

    fn settle(&mut self) {
        self.iterate.last.clone_from(&self.iterate.now);
        self.iterate.off.clone_from(&self.iterate.off_now);
    }

    fn update_internal(&mut self, du: &[f64], step: f64) {
        let mut now = std::mem::take(&mut self.iterate.now);
        for (i, coupling, row) in self.rows() {
            if !coupling.tie.firm() || self.hold[i].idle {
                continue;
            }
            let (last, off) = (self.iterate.last[i], self.iterate.off[i]);
            now[i] = match off.is_finite() {
                true => last + step * self.eliminated_by(i) * (off + row.sum(du)),
                false => (1.0 - step) * last,
            };
        }
        self.iterate.now = now;
    }

    fn commit(&mut self, stage: &Stage) {
        let mut memory = std::mem::take(&mut self.memory);
        let (u, before) = (&stage.at.u, &stage.from.u);
        memory.stored = 0.0;
        memory.work = 0.0;
        memory.damped = 0.0;
        for (i, coupling, row) in self.rows() {
            let (sum, sum_before) = (row.sum(u), row.sum(before));
            let act = match (self.act(i, coupling, stage.at.t), &coupling.tie) {
                // what is taken away lets go of what it has
                (Act::Idle, Tie::Dashpot { .. }) => Act::Damped(0.0),
                (Act::Idle, tie) if !tie.firm() => Act::Sprung(0.0),
                (act, _) => act,
            };
            let target = Couplings::target(act);
            let was = std::mem::replace(&mut memory.targets[i], target);
            match act {
                Act::Held(_) => {
                    let [from, to, shown] = match self.explicit {
                        true => {
                            let exact = self.exact.get(i).copied().unwrap_or_default();
                            [exact.from, exact.to, exact.shown]
                        }
                        false => [memory.forces[i], self.iterate.now[i], self.iterate.now[i]],
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
                        None => self.iterate.now[i],
                        Some(_) => coefficient * self.rate_of(row, stage),
                    };
                    memory.damped += 0.5 * (memory.forces[i] + force) * (sum - sum_before);
                    memory.forces[i] = force;
                }
                Act::Stopped(clearance) => {
                    let (held, hold) = (memory.multipliers[i], self.hold[i]);
                    let rest = memory.rest.get(i).copied().unwrap_or(0.0);
                    let force = match (hold.idle, self.explicit) {
                        (true, _) => 0.0,
                        (false, true) => {
                            (held + hold.stiffness * (sum + clearance - rest)).min(0.0)
                        }
                        (false, false) => self.iterate.now[i],
                    };
                    if self.explicit && !hold.idle && hold.stiffness > 0.0 {
                        memory.stored += (force * force - held * held) / (2.0 * hold.stiffness);
                    } else {
                        memory.multipliers[i] = force;
                    }
                    let forces = [std::mem::replace(&mut memory.forces[i], force), force];
                    memory.work += self.missed(stage, forces, (sum - sum_before, 0.0));
                }
                Act::Sprung(_) => {
                    let [x, y] = [sum, sum_before].map(|s| coupling.tie.stretch(s));
                    memory.work += 0.25 * (x * x + y * y) * (target - was);
                    memory.stored += 0.5 * target * x * x;
                    if matches!(coupling.tie, Tie::Gap { .. }) {
                        let mean = 0.5 * (target + was);
                        let stored = 0.5 * mean * (x * x - y * y);
                        let way = (sum - sum_before, stored);
                        memory.work += self.missed(stage, [mean * y, mean * x], way);
                    }
                    memory.forces[i] = target * x;
                }
                Act::Idle => {}
            }
        }
        self.memory = memory;
    }
}

impl Couplings {
    /// Energies at the last committed state.
    pub fn energy(&self) -> Energy {
        Energy {
            stored: self.memory.stored,
            ..Energy::default()
        }
    }

    /// What the sum of a row changes at per time: as the scheme of the increment has it, or as it is known. Nothing where inertia plays no part.
    fn rate_of(&self, row: &Row, stage: &Stage) -> f64 {
        let Some(rate) = &stage.rate else {
            return match self.explicit {
                true => row.sum(&stage.at.v),
                false => 0.0,
            };
        };
        let (u, from) = (&stage.at.u, &stage.from.u);
        let moved = |dof: usize| rate.gain[dof] * (u[dof] - from[dof]) + rate.shift[dof];
        let sum: f64 = row.terms().map(|(dof, a)| a * moved(dof)).sum();
        sum / stage.dt
    }

    /// Work on the bodies that the trapezoidal rule counts over a way on which a gap opens or closes, less that along the way, which stores this much:
    /// what drives the bodies has done as much more than that rule says. In motion it is an error of the scheme.
    fn missed(&self, stage: &Stage, [from, to]: [f64; 2], (way, stored): (f64, f64)) -> f64 {
        match stage.rate.is_none() && !self.explicit {
            true => stored - 0.5 * (from + to) * way,
            false => 0.0,
        }
    }
}

fn contradiction(name: &str, off: f64) -> StepFailure {
    let message = format!(
        "coupling {name}: all displacements of an equation are prescribed, and it is off by {off:.3e}"
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

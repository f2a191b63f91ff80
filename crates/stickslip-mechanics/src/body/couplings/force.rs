//! Couplings as a force.

use super::{Couplings, Row, Tie};
use crate::system::{Assembler, Cause, Energy, Force, Stage, StepFailure, Tangent};

/// How far an equation of nothing but prescribed displacements may be off, relative to their size.
const AGREED: f64 = 1e-9;

impl Force for Couplings {
    fn begin(&mut self) {
        self.iterate.now.clone_from(&self.memory.multipliers);
        self.iterate.last.clone_from(&self.memory.multipliers);
        self.iterate.off.fill(0.0);
    }

    fn assemble(&mut self, stage: &Stage, out: &mut Assembler) -> Result<(), StepFailure> {
        let mut off_now = std::mem::take(&mut self.iterate.off_now);
        let mut scratch = Scratch::default();
        let mut failure = None;
        let u = &stage.at.u;
        for (i, coupling, row) in self.rows() {
            if !coupling.schedule.active(stage.at.t) {
                continue;
            }
            let target = self.target(i, coupling, stage.at.t);
            let sum = row.sum(u);
            let hold = self.hold[i];
            let norm = row.norm();
            let (force, stiffness) = match coupling.tie {
                Tie::Spring { .. } => (target * sum, target),
                Tie::Equation { .. } => {
                    let off = sum - target;
                    off_now[i] = off;
                    if hold.idle {
                        let size = row.size(u).max(target.abs());
                        if off.abs() > AGREED * size {
                            failure.get_or_insert_with(|| contradiction(&coupling.name, off));
                        }
                        continue;
                    }
                    let pull = hold.stiffness * off;
                    if self.explicit {
                        (self.memory.multipliers[i] + pull, hold.stiffness)
                    } else {
                        row.terms()
                            .for_each(|(dof, a)| out.condensed[dof] += a * pull);
                        let pull = norm * pull.abs();
                        out.multiplier_residual = out.multiplier_residual.max(pull);
                        (self.iterate.now[i], hold.stiffness)
                    }
                }
            };
            // what rounding leaves of displacements that are large
            let rounding = 4.0 * f64::EPSILON * stiffness * row.size(u) * norm;
            out.rounding += rounding * rounding;
            out.add_coupling(&row.dofs);
            scratch.push(row, force, out);
            scratch.add(row, stiffness, out);
        }
        self.iterate.off_now = off_now;
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
            if matches!(coupling.tie, Tie::Equation { .. }) && !self.hold[i].idle {
                let to_go = self.iterate.off[i] + row.sum(du);
                now[i] = self.iterate.last[i] + step * self.hold[i].stiffness * to_go;
            }
        }
        self.iterate.now = now;
    }

    fn commit(&mut self, stage: &Stage) {
        let mut memory = std::mem::take(&mut self.memory);
        let (u, before) = (&stage.at.u, &stage.from.u);
        memory.stored = 0.0;
        memory.work = 0.0;
        for (i, coupling, row) in self.rows() {
            let active = coupling.schedule.active(stage.at.t);
            let sum = row.sum(u);
            let target = self.target(i, coupling, stage.at.t);
            let was = std::mem::replace(&mut memory.targets[i], target);
            match coupling.tie {
                Tie::Equation { .. } if active => {
                    let pull = self.hold[i].stiffness * (sum - target);
                    let force = match self.explicit {
                        true => memory.multipliers[i] + pull,
                        false => self.iterate.now[i],
                    };
                    if self.explicit && !self.hold[i].idle {
                        // the spring, and the force with which it started
                        memory.stored += (sum - target) * (memory.multipliers[i] + 0.5 * pull);
                    } else {
                        memory.multipliers[i] = force;
                    }
                    memory.work -= 0.5 * (memory.forces[i] + force) * (target - was);
                    memory.forces[i] = force;
                }
                Tie::Equation { .. } => {}
                Tie::Spring { .. } => {
                    let mean = 0.5 * (sum.powi(2) + row.sum(before).powi(2));
                    memory.work += 0.5 * mean * (target - was);
                    memory.stored += 0.5 * target * sum * sum;
                    memory.forces[i] = target * sum;
                }
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

    fn add(&mut self, row: &Row, stiffness: f64, out: &mut Assembler) {
        if !out.wants_tangent {
            return;
        }
        let n = row.factors.len();
        for (to, scale) in [(&mut self.rows, 1.0), (&mut self.change, stiffness)] {
            to.clear();
            to.extend(row.factors.iter().map(|a| scale * a));
            to.resize(3 * n, 0.0);
        }
        self.surrogate.clear();
        if out.wants_surrogate {
            for a in &row.factors {
                let scaled = row.factors.iter().map(|b| stiffness * a * b);
                self.surrogate.extend(scaled);
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

use super::Row;
use crate::system::{
    Assembler, Cause, Energy, Force, Links, Role, Schedule, Stage, StepFailure, Tangent,
};

/// What the rows of a coupling do.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Tie {
    /// Every sum has this value `[m]`.
    Equation {
        /// The value.
        value: f64,
    },
    /// A spring acts against every sum.
    Spring {
        /// Its stiffness `[N/m]`.
        stiffness: f64,
    },
}

/// Rows with what they do, and when.
#[derive(Debug, Clone, PartialEq)]
pub struct Coupling {
    /// Name in the problem file.
    pub name: String,
    /// The sums.
    pub rows: Vec<Row>,
    /// What they do.
    pub tie: Tie,
    /// When it acts. Of an equation the factor says how far its sums have come; of a spring it multiplies the stiffness.
    pub schedule: Schedule,
    /// `true` if the factor multiplies the value of the equation; `false` if it leads to the value from what the sum was when it began to act.
    pub table: bool,
}

/// All couplings of a model, as one force.
///
/// An equation has a multiplier `λ`, the force that acts along its row. It is an unknown of Newton's method, eliminated row by row with a stiffness
/// `ω` much above that of the bodies: `λ` goes on by `ω (g + B du)`, `g` what the equation is off. At the solution `g` is zero whatever `ω`, and equations
/// that repeat others do no harm. That is the method of multipliers with an update in every iteration, where the constraints are linear.
#[derive(Debug, Clone, Default)]
pub struct Couplings {
    pub(super) all: Vec<Coupling>,
    /// By row, over all couplings.
    pub(super) hold: Vec<Hold>,
    /// What the sums of equations were when these began to act, by row `[m]`.
    start: Vec<f64>,
    iterate: Iterate,
    /// What counts.
    pub memory: CouplingsMemory,
    pub(super) explicit: bool,
    pub(super) dim: usize,
}

/// How an equation is enforced.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Hold {
    /// Stiffness by which its multiplier is eliminated `[N/m]`.
    pub stiffness: f64,
    /// Everything in it is prescribed: there is nothing to be enforced.
    pub idle: bool,
}

/// What couplings knew after an accepted increment.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct CouplingsMemory {
    /// Multipliers of equations, by row `[N]`.
    pub(super) multipliers: Vec<f64>,
    /// Forces along the rows, those of springs as well `[N]`.
    pub(super) forces: Vec<f64>,
    /// What the sums of equations had to be, and the stiffness of springs, by row.
    targets: Vec<f64>,
    /// Energy in springs `[J]`.
    stored: f64,
    /// Work over the increment of equations whose value changes, and of springs whose stiffness does `[J]`.
    work: f64,
}

/// Multipliers of an attempt.
#[derive(Debug, Clone, Default)]
struct Iterate {
    /// At the last iterate, with what the equations are off there, and now.
    last: Vec<f64>,
    off: Vec<f64>,
    now: Vec<f64>,
    off_now: Vec<f64>,
}

/// Stiffness by which multipliers are eliminated, relative to that of the bodies at the points of a row. Every iteration leaves about its inverse of
/// what an equation is off; what rounding of displacements leaves of forces grows with it.
const FIRM: f64 = 1e4;

/// How far an equation of nothing but prescribed displacements may be off, relative to their size.
const AGREED: f64 = 1e-9;

impl Couplings {
    /// Couplings of the points of a space of this dimension.
    pub fn new(all: Vec<Coupling>, dim: usize) -> Self {
        let rows = all.iter().map(|c| c.rows.len()).sum();
        let none = vec![0.0; rows];
        let mut targets = Vec::with_capacity(rows);
        for coupling in &all {
            let first = match coupling.tie {
                Tie::Equation { .. } => 0.0,
                Tie::Spring { stiffness } => {
                    let first = coupling.schedule.pieces.first();
                    stiffness * first.map_or(1.0, |p| coupling.schedule.at(p.start))
                }
            };
            targets.extend(coupling.rows.iter().map(|_| first));
        }
        Couplings {
            all,
            hold: vec![Hold::default(); rows],
            start: none.clone(),
            iterate: Iterate {
                last: none.clone(),
                off: none.clone(),
                now: none.clone(),
                off_now: none.clone(),
            },
            memory: CouplingsMemory {
                multipliers: none.clone(),
                forces: none,
                targets,
                ..CouplingsMemory::default()
            },
            explicit: false,
            dim,
        }
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.all.is_empty()
    }

    /// The couplings.
    pub fn all(&self) -> &[Coupling] {
        &self.all
    }

    /// The points they act on.
    pub fn points(&self) -> impl Iterator<Item = usize> + '_ {
        let dofs = self.rows().flat_map(|(.., row)| &row.dofs);
        dofs.step_by(self.dim.max(1)).map(|dof| dof / self.dim)
    }

    /// All rows with their number and coupling.
    pub(super) fn rows(&self) -> impl Iterator<Item = (usize, &Coupling, &Row)> {
        let rows = self
            .all
            .iter()
            .flat_map(|c| c.rows.iter().map(move |r| (c, r)));
        rows.enumerate().map(|(i, (c, r))| (i, c, r))
    }

    /// The rows that hold something at time `t`.
    pub fn acting(&self, t: f64) -> impl Iterator<Item = &Row> {
        self.rows()
            .filter_map(move |(_, c, row)| c.schedule.active(t).then_some(row))
    }

    /// What the sum of an equation has to be at time `t` `[m]`, or the stiffness of a spring then `[N/m]`.
    fn target(&self, i: usize, coupling: &Coupling, t: f64) -> f64 {
        let s = coupling.schedule.at(t);
        match coupling.tie {
            Tie::Spring { stiffness } => s * stiffness,
            Tie::Equation { value } if coupling.table => s * value,
            Tie::Equation { value } => self.start[i] + s * (value - self.start[i]),
        }
    }

    /// Begins a step: equations that begin to act start from what their sums are at displacements `u`, and those that end hand out the forces
    /// they let go with, by dof `[N]`, as loads.
    pub fn begin_step(
        &mut self,
        (before, middle): (Option<f64>, f64),
        u: &[f64],
        let_go: &mut dyn FnMut(usize, f64),
    ) {
        let mut first = 0;
        for coupling in &self.all {
            let rows = first..first + coupling.rows.len();
            first = rows.end;
            if !matches!(coupling.tie, Tie::Equation { .. }) {
                continue;
            }
            let was = before.is_some_and(|t| coupling.schedule.active(t));
            let is = coupling.schedule.active(middle);
            for (i, row) in rows.zip(&coupling.rows) {
                if is && !was {
                    self.start[i] = row.sum(u);
                    self.memory.targets[i] = self.start[i];
                }
                if was && !is {
                    let multiplier = std::mem::take(&mut self.memory.multipliers[i]);
                    self.memory.forces[i] = 0.0;
                    row.terms()
                        .for_each(|(dof, a)| let_go(dof, -multiplier * a));
                }
            }
        }
    }

    /// Chooses the stiffnesses of elimination for a bulk with this diagonal, by dof.
    pub fn fit(&mut self, diagonal: &[f64], fixed: &[bool], links: &Links) {
        let springs = self.all.iter().map(|c| match c.tie {
            Tie::Spring { stiffness } => stiffness,
            Tie::Equation { .. } => 0.0,
        });
        let typical = diagonal.iter().copied().chain(springs).fold(0.0, f64::max);
        // Where nothing has a stiffness any will do.
        let typical = if typical > 0.0 { typical } else { 1.0 };
        let mut hold = std::mem::take(&mut self.hold);
        for (i, _, row) in self.rows() {
            let mut free = false;
            let mut compliance = 0.0;
            for (dof, a) in moved_by(row, links) {
                if !fixed[dof] && a != 0.0 {
                    free = true;
                    if diagonal[dof] > 0.0 {
                        compliance += a * a / diagonal[dof];
                    }
                }
            }
            // What has no stiffness of its own, like a rigid body, follows whatever holds it.
            let norm = row.norm();
            let stiffness = match compliance > 0.0 {
                true => 1.0 / compliance,
                false => typical / (norm * norm),
            };
            hold[i] = Hold {
                stiffness: FIRM * stiffness,
                idle: !free,
            };
        }
        self.hold = hold;
    }

    /// Adds the forces of the last accepted state, which is at `u`, to the internal ones, by dof.
    pub fn add_initial(&self, t: f64, u: &[f64], out: &mut [f64]) {
        for (i, coupling, row) in self.rows() {
            if !coupling.schedule.active(t) {
                continue;
            }
            let force = match coupling.tie {
                Tie::Equation { .. } => self.memory.multipliers[i],
                Tie::Spring { .. } => self.target(i, coupling, t) * row.sum(u),
            };
            row.terms().for_each(|(dof, a)| out[dof] += a * force);
        }
    }

    /// Work over the last increment of equations whose value changes, and of springs whose stiffness does `[J]`.
    pub fn work(&self) -> f64 {
        self.memory.work
    }

    /// Multipliers take over from springs: they have the forces that these had. The energy of the springs that is gone, negative.
    pub(super) fn keep_forces(&mut self) -> f64 {
        let mut memory = std::mem::take(&mut self.memory);
        let before = memory.stored;
        memory.multipliers.clone_from(&memory.forces);
        memory.stored = 0.0;
        for (i, coupling, _) in self.rows() {
            let target = memory.targets[i];
            match coupling.tie {
                Tie::Spring { .. } if target > 0.0 => {
                    memory.stored += 0.5 * memory.forces[i].powi(2) / target;
                }
                Tie::Spring { .. } => {}
                // The way back to where the equation holds costs work.
                Tie::Equation { .. } => memory.targets[i] += self.iterate.off_now[i],
            }
        }
        let change = memory.stored - before;
        self.memory = memory;
        change
    }

    /// Energy in springs at displacements `u` at the start of the analysis `[J]`.
    pub fn begin_analysis(&mut self, t: f64, u: &[f64]) -> f64 {
        let mut stored = 0.0;
        for (i, coupling, row) in self.rows() {
            if let Tie::Spring { .. } = coupling.tie {
                stored += 0.5 * self.target(i, coupling, t) * row.sum(u).powi(2);
            }
        }
        self.memory.stored = stored;
        stored
    }

    /// The couplings with the sum of the forces along their rows at the last accepted state, and the mean of the sums of displacements.
    pub fn report<'a>(&'a self, u: &'a [f64]) -> impl Iterator<Item = (&'a str, f64, f64)> + 'a {
        let mut first = 0;
        self.all.iter().map(move |coupling| {
            let rows = first..first + coupling.rows.len();
            first = rows.end;
            let count = rows.len() as f64;
            let force = self.memory.forces[rows].iter().sum();
            let sum: f64 = coupling.rows.iter().map(|r| r.sum(u)).sum();
            (coupling.name.as_str(), force, sum / count)
        })
    }
}

/// The terms of a row, those of rigid bodies by the dofs that move them.
pub(super) fn moved_by(row: &Row, links: &Links) -> Vec<(usize, f64)> {
    let mut out: Vec<(usize, f64)> = Vec::new();
    let mut add = |dof: usize, a: f64| match out.iter_mut().find(|(d, _)| *d == dof) {
        Some(term) => term.1 += a,
        None => out.push((dof, a)),
    };
    for (dof, a) in row.terms() {
        match links.row(dof) {
            None => add(dof, a),
            Some(hidden) => hidden.into_iter().for_each(|(d, f)| add(d, f * a)),
        }
    }
    out
}

impl Force for Couplings {
    fn name(&self) -> &str {
        "couplings"
    }

    fn role(&self) -> Role {
        Role::Contact
    }

    fn begin(&mut self) {
        self.iterate.now.clone_from(&self.memory.multipliers);
        self.iterate.last.clone_from(&self.memory.multipliers);
        self.iterate.off.fill(0.0);
    }

    fn assemble(&mut self, stage: &Stage, out: &mut Assembler) -> Result<(), StepFailure> {
        let mut off_now = std::mem::take(&mut self.iterate.off_now);
        let mut tangent = RowTangent::default();
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
                        let shift: Vec<f64> = row.factors.iter().map(|a| a * pull).collect();
                        for (&dof, s) in row.dofs.iter().zip(&shift) {
                            out.condensed[dof] += s;
                        }
                        let pull = norm * pull.abs();
                        out.multiplier_residual = out.multiplier_residual.max(pull);
                        out.multiplier_merit += pull * pull;
                        (self.iterate.now[i], hold.stiffness)
                    }
                }
            };
            // what rounding leaves of displacements that are large
            let rounding = 4.0 * f64::EPSILON * stiffness * row.size(u) * norm;
            out.rounding += rounding * rounding;
            out.add_coupling(&row.dofs);
            let residual: Vec<f64> = row.factors.iter().map(|a| a * force).collect();
            out.add_residual(&row.dofs, &residual);
            tangent.add(row, stiffness, out);
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

    fn energy(&self) -> Energy {
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

/// Memory for the tangent of one row.
#[derive(Default)]
struct RowTangent {
    rows: Vec<f64>,
    change: Vec<f64>,
    surrogate: Vec<f64>,
}

impl RowTangent {
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

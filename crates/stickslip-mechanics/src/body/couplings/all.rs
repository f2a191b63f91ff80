use super::Row;
use super::elimination::Elimination;
use super::pretension::{Drawn, Part, Pretension};
use crate::system::Schedule;

/// What the rows of a coupling do.
#[derive(Debug, Clone, PartialEq)]
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
    /// No sum falls below minus the clearance.
    Gap {
        /// How far the sum may fall `[m]`.
        clearance: f64,
        /// Stiffness of what it meets there `[N/m]`; nothing that gives way if not given.
        stiffness: Option<f64>,
    },
    /// A force in proportion to its rate acts against every sum, in motion.
    Dashpot {
        /// Force per velocity `[N s/m]`.
        coefficient: f64,
    },
    /// They are those of a cut that is drawn together.
    Pretension(Pretension),
}

impl Tie {
    /// Whether it holds by a multiplier.
    pub fn firm(&self) -> bool {
        match self {
            Tie::Equation { .. } | Tie::Pretension(_) => true,
            Tie::Gap { stiffness, .. } => stiffness.is_none(),
            Tie::Spring { .. } | Tie::Dashpot { .. } => false,
        }
    }

    /// Its own stiffness `[N/m]`; zero if it has none.
    pub(super) fn stiffness(&self) -> f64 {
        match self {
            Tie::Spring { stiffness } => *stiffness,
            Tie::Gap { stiffness, .. } => stiffness.unwrap_or(0.0),
            Tie::Equation { .. } | Tie::Pretension(_) | Tie::Dashpot { .. } => 0.0,
        }
    }

    /// Of a sum what its spring is deformed by `[m]`.
    pub(super) fn stretch(&self, sum: f64) -> f64 {
        match self {
            Tie::Gap { clearance, .. } => (sum + clearance).min(0.0),
            _ => sum,
        }
    }
}

/// What a row does at a time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Act {
    /// Its sum has to be this `[m]`.
    Held(f64),
    /// It must not fall below minus this clearance `[m]`.
    Stopped(f64),
    /// It has a spring of this stiffness, which a gap meets where it is closed `[N/m]`.
    Sprung(f64),
    /// It has this force, whatever its sum `[N]`.
    Pulled(f64),
    /// A dashpot acts against its rate `[N s/m]`.
    Damped(f64),
    /// Nothing.
    Idle,
}

/// What small motions meet along a row.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Meets {
    /// Its sum stays what it is.
    Equation,
    /// A stiffness `[N/m]`.
    Spring(f64),
    /// A damping `[N s/m]`.
    Dashpot(f64),
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
    /// Whether it ties points to a reference point, which reports what acts on it.
    pub referred: bool,
    /// `true` if the factor multiplies the value of the equation; `false` if it leads to the value from what the sum was when it began to act.
    pub table: bool,
}

/// All couplings of a model, as one force.
///
/// An equation has a multiplier `λ`, the force that acts along its row. It is an unknown of Newton's method, eliminated row by row with a stiffness
/// `ω` much above that of the bodies and of contact: `λ` goes on by `ω (g + B du)`, `g` what the equation is off. At the solution `g` is zero whatever `ω`, and equations
/// that repeat others do no harm. That is the method of multipliers with an update in every iteration, where the constraints are linear. A gap is
/// an equation where `λ + ω g < 0`, and where not `λ` goes to zero.
#[derive(Debug, Clone, Default)]
pub struct Couplings {
    pub(super) all: Vec<Coupling>,
    /// By row, over all couplings.
    pub(super) hold: Vec<Hold>,
    /// What the sums of equations were when these began to act, by row `[m]`; of rows along the normal of a pretension their sum or their part of the
    /// force when the step began `[m, N]`.
    pub(super) start: Vec<f64>,
    /// What rows of pretensions are for, by row; of others the first.
    parts: Vec<Part>,
    pub(super) iterate: Iterate,
    pub(super) elimination: Elimination,
    /// What counts.
    pub memory: CouplingsMemory,
    pub(super) explicit: bool,
    /// Forces with which equations hold over an explicit increment, by row; empty before one.
    pub(super) exact: Vec<ExactForce>,
    pub(super) dim: usize,
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
    /// What the sums of equations had to be, the stiffness of springs and the coefficient of dashpots, by row.
    pub(super) targets: Vec<f64>,
    /// By how much the sums of equations were off when springs took their place in an explicit step, by row; empty before one.
    pub(super) rest: Vec<f64>,
    /// Energy in springs `[J]`.
    pub(super) stored: f64,
    /// Work over the increment of equations whose value changes, and of springs whose stiffness does `[J]`.
    pub(super) work: f64,
    /// What dashpots took over the increment `[J]`.
    pub(super) damped: f64,
}

/// Multipliers of an attempt.
#[derive(Debug, Clone, Default)]
pub(super) struct Iterate {
    /// At the last iterate, with what the equations are off there, and now. Gaps that are open are off by infinity; the multiplier of a dashpot is its
    /// force.
    pub last: Vec<f64>,
    pub off: Vec<f64>,
    pub now: Vec<f64>,
    pub off_now: Vec<f64>,
}

impl Couplings {
    /// Couplings of the points of a space of this dimension.
    pub fn new(all: Vec<Coupling>, dim: usize) -> Self {
        let rows = all.iter().map(|c| c.rows.len()).sum();
        let none = vec![0.0; rows];
        let mut targets = Vec::with_capacity(rows);
        let mut parts = Vec::with_capacity(rows);
        for coupling in &all {
            match &coupling.tie {
                Tie::Pretension(p) => parts.extend(p.parts(coupling.rows.len())),
                _ => parts.extend(coupling.rows.iter().map(|_| Part::Across)),
            }
            let own = match &coupling.tie {
                Tie::Dashpot { coefficient } => *coefficient,
                tie => tie.stiffness(),
            };
            let first = coupling.schedule.pieces.first();
            let first = own * first.map_or(1.0, |p| coupling.schedule.at(p.start));
            targets.extend(coupling.rows.iter().map(|_| first));
        }
        Couplings {
            all,
            hold: vec![Hold::default(); rows],
            start: none.clone(),
            parts,
            iterate: Iterate {
                last: none.clone(),
                off: none.clone(),
                now: none.clone(),
                off_now: none.clone(),
            },
            elimination: Elimination::default(),
            memory: CouplingsMemory {
                multipliers: none.clone(),
                forces: none,
                targets,
                ..CouplingsMemory::default()
            },
            explicit: false,
            exact: Vec::new(),
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

    /// The rows that hold something at time `t`: not those of dashpots, nor of gaps that are open.
    pub fn acting(&self, t: f64) -> impl Iterator<Item = &Row> {
        let holding = self.holding(t).filter(|(_, open)| !open);
        holding.map(|(row, _)| row)
    }

    /// The rows of gaps that are open at the last accepted state, and stop what closes them at time `t`.
    pub fn stops(&self, t: f64) -> impl Iterator<Item = &Row> {
        let holding = self.holding(t).filter(|(_, open)| *open);
        holding.map(|(row, _)| row)
    }

    /// The rows that hold something, and whether they are those of gaps that are open.
    fn holding(&self, t: f64) -> impl Iterator<Item = (&Row, bool)> {
        self.rows().filter_map(move |(i, c, row)| {
            let open = match c.tie {
                Tie::Gap { clearance, .. } => clearance > 0.0 && self.memory.forces[i] >= 0.0,
                _ => false,
            };
            let holds = match self.act(i, c, t) {
                Act::Held(_) | Act::Stopped(_) => true,
                Act::Sprung(stiffness) => stiffness != 0.0,
                Act::Pulled(_) | Act::Damped(_) | Act::Idle => false,
            };
            holds.then_some((row, open))
        })
    }

    /// What small motions about the last accepted state meet at time `t`, row by row. Gaps that are closed are equations.
    pub fn linearise(&self, t: f64) -> Vec<(&Row, Meets)> {
        let rows = self.rows().filter_map(|(i, coupling, row)| {
            let gap = matches!(coupling.tie, Tie::Gap { .. });
            if gap && self.memory.forces[i] >= 0.0 {
                return None;
            }
            match self.act(i, coupling, t) {
                Act::Held(_) | Act::Stopped(_) => Some((row, Meets::Equation)),
                Act::Sprung(stiffness) => Some((row, Meets::Spring(stiffness))),
                Act::Damped(coefficient) => Some((row, Meets::Dashpot(coefficient))),
                Act::Pulled(_) | Act::Idle => None,
            }
        });
        rows.collect()
    }

    /// What a row does at time `t`.
    pub(super) fn act(&self, i: usize, coupling: &Coupling, t: f64) -> Act {
        if !coupling.schedule.active(t) {
            return Act::Idle;
        }
        let s = coupling.schedule.at(t);
        match (&coupling.tie, self.parts[i]) {
            (
                Tie::Gap {
                    clearance,
                    stiffness: None,
                },
                _,
            ) => Act::Stopped(*clearance),
            (tie @ (Tie::Spring { .. } | Tie::Gap { .. }), _) => Act::Sprung(s * tie.stiffness()),
            (Tie::Dashpot { coefficient }, _) => Act::Damped(s * coefficient),
            (Tie::Equation { value }, _) if coupling.table => Act::Held(s * value),
            (Tie::Equation { value }, _) => Act::Held(self.start[i] + s * (value - self.start[i])),
            (Tie::Pretension(_), Part::Across) => Act::Held(0.0),
            (Tie::Pretension(p), Part::Along(share)) => match p.drawn(t, share, self.start[i]) {
                // A force that draws together acts with a growing sum; forces of rows act against it.
                Drawn::Force(part) => Act::Pulled(-part),
                Drawn::Length(sum) => Act::Held(sum),
            },
            (Tie::Pretension(p), Part::Equal) if p.pulled(t) => Act::Held(0.0),
            (Tie::Pretension(_), Part::Equal) => Act::Idle,
        }
    }

    /// What the sum of a row has to be, the stiffness of its spring or the coefficient of its dashpot; nothing of others.
    pub(super) fn target(act: Act) -> f64 {
        match act {
            Act::Held(value) | Act::Sprung(value) | Act::Damped(value) => value,
            Act::Stopped(_) | Act::Pulled(_) | Act::Idle => 0.0,
        }
    }

    /// Begins a step: equations that begin to act start from what their sums are at displacements `u`, and those that end hand out the forces
    /// they let go with, by dof `[N]`, as loads. Pretensions go on from force or shortening.
    pub fn begin_step(
        &mut self,
        (before, middle): (Option<f64>, f64),
        u: &[f64],
        let_go: &mut dyn FnMut(usize, f64),
    ) {
        let mut first = 0;
        let all = std::mem::take(&mut self.all);
        for coupling in &all {
            let rows = first..first + coupling.rows.len();
            first = rows.end;
            match &coupling.tie {
                Tie::Pretension(p) => {
                    self.draw(p, (before, middle), (rows, &coupling.rows), u);
                    continue;
                }
                tie if !tie.firm() => continue,
                _ => {}
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
        self.all = all;
    }

    /// Begins motion at velocities `v`: the forces that dashpots have there.
    pub fn begin_motion(&mut self, t: f64, v: &[f64]) {
        let mut forces = std::mem::take(&mut self.memory.forces);
        for (i, coupling, row) in self.rows() {
            if matches!(coupling.tie, Tie::Dashpot { .. }) && !v.is_empty() {
                forces[i] = match self.act(i, coupling, t) {
                    Act::Damped(coefficient) => coefficient * row.sum(v),
                    _ => 0.0,
                };
            }
        }
        self.memory.forces = forces;
    }

    /// Adds the forces of the last accepted state, which is at `u` with velocities `v`, to the internal ones, by dof.
    pub fn add_initial(&self, t: f64, (u, v): (&[f64], &[f64]), out: &mut [f64]) {
        self.add_forces(&self.memory.multipliers, (t, u, Some(v)), out);
    }

    /// The same for the last attempt, which ended at `u`.
    pub fn add_tried(&self, t: f64, u: &[f64], out: &mut [f64]) {
        self.add_forces(&self.iterate.now, (t, u, None), out);
    }

    fn add_forces(
        &self,
        multipliers: &[f64],
        (t, u, v): (f64, &[f64], Option<&[f64]>),
        out: &mut [f64],
    ) {
        for (i, coupling, row) in self.rows() {
            let force = match (self.act(i, coupling, t), v) {
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

    /// Work over the last increment of equations whose value changes, of springs whose stiffness does, and of forces of pretensions `[J]`.
    pub fn work(&self) -> f64 {
        self.memory.work
    }

    /// What dashpots took over the last increment `[J]`.
    pub fn damped(&self) -> f64 {
        self.memory.damped
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
                // The way back to where the equation holds costs work.
                Tie::Equation { .. } | Tie::Pretension(_) => {
                    memory.targets[i] += self.iterate.off_now[i];
                }
                Tie::Spring { .. } | Tie::Gap { .. } if target > 0.0 => {
                    memory.stored += 0.5 * memory.forces[i].powi(2) / target;
                }
                _ => {}
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
            if let Act::Sprung(stiffness) = self.act(i, coupling, t) {
                let stretch = coupling.tie.stretch(row.sum(u));
                stored += 0.5 * stiffness * stretch.powi(2);
            }
        }
        self.memory.stored = stored;
        stored
    }

    /// The couplings, but for those to reference points, with the sum of the forces along their rows at the last accepted state `[N]`, and the mean of the sums
    /// of displacements `[m]`. A force is positive where it acts against a growing sum, as that of a stretched spring. Of pretensions they are the force that
    /// draws the sides together and the shortening.
    pub fn report<'a>(&'a self, u: &'a [f64]) -> impl Iterator<Item = (&'a str, f64, f64)> + 'a {
        let mut first = 0;
        self.all.iter().filter_map(move |coupling| {
            let rows = first..first + coupling.rows.len();
            first = rows.end;
            let (own, sign) = match &coupling.tie {
                Tie::Pretension(p) => {
                    let from = rows.len() + 1 - 2 * p.shares.len();
                    (from..from + p.shares.len(), -1.0)
                }
                _ => (0..rows.len(), 1.0),
            };
            let count = own.len() as f64;
            let forces = &self.memory.forces[rows.start + own.start..rows.start + own.end];
            let force: f64 = forces.iter().sum();
            let sum: f64 = coupling.rows[own].iter().map(|r| r.sum(u)).sum();
            let said = (coupling.name.as_str(), sign * force, sum / count);
            (!coupling.referred).then_some(said)
        })
    }

    /// Adds what equations do to the displacements at the last accepted state, by dof `[N]`.
    pub fn add_equation_forces(&self, out: &mut [f64]) {
        let rows = self
            .all
            .iter()
            .flat_map(|c| c.rows.iter().map(move |r| (c, r)));
        for ((coupling, row), force) in rows.zip(&self.memory.forces) {
            if matches!(coupling.tie, Tie::Equation { .. } | Tie::Pretension(_)) {
                row.terms().for_each(|(dof, a)| out[dof] -= a * force);
            }
        }
    }
}

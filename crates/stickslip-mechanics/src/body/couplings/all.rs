use super::Row;
use crate::system::{Links, Schedule};

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
}

impl Tie {
    /// Whether it holds by a multiplier.
    pub(super) fn firm(self) -> bool {
        match self {
            Tie::Equation { .. } => true,
            Tie::Gap { stiffness, .. } => stiffness.is_none(),
            Tie::Spring { .. } | Tie::Dashpot { .. } => false,
        }
    }

    /// Its own stiffness `[N/m]`; zero if it has none.
    pub(super) fn stiffness(self) -> f64 {
        match self {
            Tie::Spring { stiffness } => stiffness,
            Tie::Gap { stiffness, .. } => stiffness.unwrap_or(0.0),
            Tie::Equation { .. } | Tie::Dashpot { .. } => 0.0,
        }
    }

    /// Of a sum what its spring is deformed by `[m]`.
    pub(super) fn stretch(self, sum: f64) -> f64 {
        match self {
            Tie::Gap { clearance, .. } => (sum + clearance).min(0.0),
            _ => sum,
        }
    }
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
/// that repeat others do no harm. That is the method of multipliers with an update in every iteration, where the constraints are linear. A gap is
/// an equation where `λ + ω g < 0`, and where not `λ` goes to zero.
#[derive(Debug, Clone, Default)]
pub struct Couplings {
    pub(super) all: Vec<Coupling>,
    /// By row, over all couplings.
    pub(super) hold: Vec<Hold>,
    /// What the sums of equations were when these began to act, by row `[m]`.
    start: Vec<f64>,
    pub(super) iterate: Iterate,
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
    /// What the sums of equations had to be, the stiffness of springs and the coefficient of dashpots, by row.
    pub(super) targets: Vec<f64>,
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

/// Stiffness by which multipliers are eliminated, relative to that of the bodies at the points of a row. Every iteration leaves about its inverse of
/// what an equation is off; what rounding of displacements leaves of forces grows with it.
pub(super) const FIRM: f64 = 1e4;

impl Couplings {
    /// Couplings of the points of a space of this dimension.
    pub fn new(all: Vec<Coupling>, dim: usize) -> Self {
        let rows = all.iter().map(|c| c.rows.len()).sum();
        let none = vec![0.0; rows];
        let mut targets = Vec::with_capacity(rows);
        for coupling in &all {
            let own = match coupling.tie {
                Tie::Dashpot { coefficient } => coefficient,
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

    /// The rows that hold something at time `t`: not those of dashpots, nor of gaps that are open.
    pub fn acting(&self, t: f64) -> impl Iterator<Item = &Row> {
        self.rows().filter_map(move |(i, c, row)| {
            let holds = match c.tie {
                Tie::Dashpot { .. } => false,
                Tie::Gap { clearance, .. } => clearance <= 0.0 || self.memory.forces[i] < 0.0,
                Tie::Equation { .. } | Tie::Spring { .. } => true,
            };
            (holds && c.schedule.active(t)).then_some(row)
        })
    }

    /// What the sum of an equation has to be at time `t` `[m]`, or the stiffness of a spring then `[N/m]`, or the coefficient of a dashpot.
    pub(super) fn target(&self, i: usize, coupling: &Coupling, t: f64) -> f64 {
        let s = coupling.schedule.at(t);
        match coupling.tie {
            Tie::Spring { .. } | Tie::Gap { .. } => s * coupling.tie.stiffness(),
            Tie::Dashpot { coefficient } => s * coefficient,
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
            if !coupling.tie.firm() {
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
        let springs = self.all.iter().map(|c| c.tie.stiffness());
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

    /// Begins motion at velocities `v`: the forces that dashpots have there.
    pub fn begin_motion(&mut self, t: f64, v: &[f64]) {
        let mut forces = std::mem::take(&mut self.memory.forces);
        for (i, coupling, row) in self.rows() {
            if matches!(coupling.tie, Tie::Dashpot { .. }) && !v.is_empty() {
                let acts = coupling.schedule.active(t);
                forces[i] = if acts {
                    self.target(i, coupling, t) * row.sum(v)
                } else {
                    0.0
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
            if !coupling.schedule.active(t) {
                continue;
            }
            let force = match (coupling.tie, v) {
                (Tie::Dashpot { .. }, Some([])) => 0.0,
                (Tie::Dashpot { .. }, Some(v)) => self.target(i, coupling, t) * row.sum(v),
                (Tie::Dashpot { .. }, None) => multipliers.get(i).copied().unwrap_or(0.0),
                (tie, _) if tie.firm() => multipliers.get(i).copied().unwrap_or(0.0),
                (tie, _) => self.target(i, coupling, t) * tie.stretch(row.sum(u)),
            };
            row.terms().for_each(|(dof, a)| out[dof] += a * force);
        }
    }

    /// Work over the last increment of equations whose value changes, and of springs whose stiffness does `[J]`.
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
                Tie::Equation { .. } => memory.targets[i] += self.iterate.off_now[i],
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
            if coupling.tie.stiffness() > 0.0 {
                let stretch = coupling.tie.stretch(row.sum(u));
                stored += 0.5 * self.target(i, coupling, t) * stretch.powi(2);
            }
        }
        self.memory.stored = stored;
        stored
    }

    /// The couplings with the sum of the forces along their rows at the last accepted state `[N]`, and the mean of the sums of displacements `[m]`. A
    /// force is positive where it acts against a growing sum, as that of a stretched spring.
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

    /// Adds what equations do to the displacements at the last accepted state, by dof `[N]`.
    pub fn add_equation_forces(&self, out: &mut [f64]) {
        let rows = self
            .all
            .iter()
            .flat_map(|c| c.rows.iter().map(move |r| (c, r)));
        for ((coupling, row), force) in rows.zip(&self.memory.forces) {
            if matches!(coupling.tie, Tie::Equation { .. }) {
                row.terms().for_each(|(dof, a)| out[dof] -= a * force);
            }
        }
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

crate::keep!(Hold { stiffness, idle });
crate::keep!(CouplingsMemory {
    multipliers,
    forces,
    targets,
    stored,
    work,
    damped
});
crate::keep!(Iterate {
    last,
    off,
    now,
    off_now
});

/// All that couplings know beyond their definition.
#[derive(Debug, Clone)]
pub struct CouplingsState {
    hold: Vec<Hold>,
    start: Vec<f64>,
    iterate: Iterate,
    memory: CouplingsMemory,
    explicit: bool,
}

crate::keep!(CouplingsState {
    hold,
    start,
    iterate,
    memory,
    explicit
});

impl Couplings {
    /// All that they know beyond their definition.
    pub fn state(&self) -> CouplingsState {
        CouplingsState {
            hold: self.hold.clone(),
            start: self.start.clone(),
            iterate: self.iterate.clone(),
            memory: self.memory.clone(),
            explicit: self.explicit,
        }
    }

    /// Goes on with that.
    pub fn go_on_from(&mut self, state: CouplingsState) {
        let CouplingsState {
            hold,
            start,
            iterate,
            memory,
            explicit,
        } = state;
        self.hold = hold;
        self.start = start;
        self.iterate = iterate;
        self.memory = memory;
        self.explicit = explicit;
    }
}

//! What couplings are: rows, what they do, and when.

use super::Row;
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

impl Act {
    /// What the sum of a row has to be, the stiffness of its spring or the coefficient of its dashpot; nothing of others.
    pub(super) fn target(self) -> f64 {
        match self {
            Act::Held(value) | Act::Sprung(value) | Act::Damped(value) => value,
            Act::Stopped(_) | Act::Pulled(_) | Act::Idle => 0.0,
        }
    }
}

/// Where a step begins: a time in the step before, if there was one, and one in the step itself `[s]`.
#[derive(Debug, Clone, Copy)]
pub struct StepTimes {
    /// In the step before.
    pub before: Option<f64>,
    /// In the middle of the step.
    pub middle: f64,
}

/// All couplings of a model, as the problem says them.
#[derive(Debug, Clone, Default)]
pub struct CouplingsDefinition {
    all: Vec<Coupling>,
    /// What rows of pretensions are for, by row; of others the first.
    parts: Vec<Part>,
    pub(super) dim: usize,
}

impl CouplingsDefinition {
    /// Couplings of the points of a space of this dimension.
    pub(super) fn new(all: Vec<Coupling>, dim: usize) -> Self {
        let parts = all.iter().flat_map(|coupling| match &coupling.tie {
            Tie::Pretension(p) => p.parts(coupling.rows.len()).collect(),
            _ => vec![Part::Across; coupling.rows.len()],
        });
        CouplingsDefinition {
            parts: parts.collect(),
            all,
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

    /// What a row does at time `t`, which began from `start`.
    pub(super) fn act(&self, i: usize, coupling: &Coupling, start: f64, t: f64) -> Act {
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
            (Tie::Equation { value }, _) => Act::Held(start + s * (value - start)),
            (Tie::Pretension(_), Part::Across) => Act::Held(0.0),
            (Tie::Pretension(p), Part::Along(share)) => match p.drawn(t, share, start) {
                // A force that draws together acts with a growing sum; forces of rows act against it.
                Drawn::Force(part) => Act::Pulled(-part),
                Drawn::Length(sum) => Act::Held(sum),
            },
            (Tie::Pretension(p), Part::Equal) if p.pulled(t) => Act::Held(0.0),
            (Tie::Pretension(_), Part::Equal) => Act::Idle,
        }
    }
}

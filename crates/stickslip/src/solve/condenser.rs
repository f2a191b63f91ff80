//! Bodies without their interiors, and what is known of them.

use std::sync::Arc;

use crate::model::course::Course;
use crate::model::frame::ContactMemory;
use crate::newton::condensed::{Amplitudes, Condensation, Library, LoadPatterns, ReducedSystem};
use crate::system::{State, StepFailure};

/// What is known of bodies without their interiors.
pub(crate) struct Condenser {
    /// Factors of this run and of others.
    pub(super) library: Arc<Library>,
    /// Points that may come into contact, and how often they were too few.
    pub(super) kept: Option<Vec<bool>>,
    pub(super) widened: usize,
    /// The dofs that are no unknowns for which condensing was found the cheapest.
    pub(super) decided: Option<Vec<bool>>,
    /// Those of a quasi-static step.
    pub(super) at_rest: Option<Condensed>,
    /// Those of increments in motion, the last used last.
    pub(super) moving: Vec<Moving>,
    /// Why the engine cannot go on: increments are not even tried any more.
    pub(super) broken: Option<StepFailure>,
    /// Largest scale of forces at any recovered increment `[N]`.
    pub(super) largest_forces: f64,
}

/// The bodies with the matrix of an increment in motion, without their interiors.
pub(super) struct Moving {
    /// Key of the matrix.
    pub(super) key: u64,
    pub(super) condensation: Condensation,
    /// The candidates it was made for.
    pub(super) kept: Vec<bool>,
    pub(super) reduced: ReducedSystem,
}

/// The bodies without their interiors, and where a quasi-static analysis stands.
pub(crate) struct Condensed {
    pub(super) condensation: Condensation,
    /// The candidates it was made for.
    pub(super) kept: Vec<bool>,
    pub(super) reduced: ReducedSystem,
    pub(super) patterns: LoadPatterns,
    /// The last accepted state: displacements are known at candidates and where prescribed.
    pub state: State,
    /// Forces under which the candidates are where they are.
    pub(super) carried: Vec<f64>,
    /// Displacements of the candidates over the last increments, and the forces behind them.
    pub(super) course: Course,
    /// What interfaces and couplings know after it where it waits to be reported; `None` where they know what the frame has.
    pub(super) ahead: Option<Arc<ContactMemory>>,
    /// What the last attempt found.
    pub(super) found: Option<(Amplitudes, Vec<f64>)>,
}

/// An increment whose interior is not known yet: its loads and the displacements of the candidates.
#[derive(Clone, crate::keep::Keep)]
pub(crate) struct Candidates {
    pub(super) amplitudes: Amplitudes,
    pub(super) displacements: Vec<f64>,
    /// Forces of contact where there are any, by dof `[N]`.
    pub(super) contact: Vec<(usize, f64)>,
}

/// Which matrix bodies are condensed with.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Which {
    Stiffness,
    Increment,
    /// That of an increment in motion with this key.
    Of(u64),
}

impl Condensed {
    /// The bodies without their interiors.
    pub fn condensation(&self) -> &Condensation {
        &self.condensation
    }
}

impl Condenser {
    /// With the factors of other runs.
    pub fn new(library: Arc<Library>) -> Self {
        Condenser {
            library,
            kept: None,
            widened: 0,
            decided: None,
            at_rest: None,
            moving: Vec::new(),
            broken: None,
            largest_forces: 0.0,
        }
    }

    /// The bodies of a quasi-static step; `None` where the sparse matrix serves it.
    pub fn at_rest(&self) -> Option<&Condensed> {
        self.at_rest.as_ref()
    }

    /// Why the engine cannot go on, if it cannot.
    pub fn broken(&self) -> Option<&StepFailure> {
        self.broken.as_ref()
    }

    /// Nothing is condensed in quasi-static steps until it is made anew.
    pub fn drop_at_rest(&mut self) {
        self.at_rest = None;
    }

    /// Nothing is condensed in motion until it is made anew.
    pub fn drop_in_motion(&mut self) {
        self.moving.clear();
    }

    /// Interfaces and couplings know this after increments that wait to be reported, or what the frame has where none does.
    pub fn go_ahead(&mut self, ahead: Option<Arc<ContactMemory>>) {
        if let Some(condensed) = &mut self.at_rest {
            condensed.ahead = ahead;
        }
    }

    /// It is later, and all that acts is as it was.
    pub fn pass_time(&mut self, t: f64) {
        if let Some(condensed) = &mut self.at_rest {
            condensed.state.t = t;
        }
    }

    /// What the last increment did is no guide for the next.
    pub fn reset_predictor(&mut self) {
        if let Some(condensed) = &mut self.at_rest {
            condensed.course.forget();
        }
    }
}

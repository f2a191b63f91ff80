//! What acts in the first instant of a motion.

use super::energies::initial_energy;
use super::evaluation::Evaluations;
use super::initial::TOUCHING;
use super::parts::Interface;
use super::scene::Wants;
use crate::contact::response::Status;
use crate::math::Vec3;
use crate::system::{Force, Stage, StepFailure};

/// Tractions at the end of an attempt, by point.
#[derive(Debug, Clone, Default)]
pub struct Tried(Vec<(Status, f64, Vec3)>);

impl Interface {
    /// Adds the forces that the laws ask for at `stage.at` to the residual, before anything is solved and without touching the
    /// history: for the acceleration at the start. What overlap stores then `[J]`.
    ///
    /// Multipliers against penetration have no force before something is solved, and nothing is stored in them: overlap is pressed out in the first
    /// increment, whose energy is told apart by the gaps that are noted here.
    pub fn add_initial(&mut self, stage: &Stage, residual: &mut [f64]) -> Result<f64, StepFailure> {
        if !self.schedule.active(stage.at.t) {
            return Ok(0.0);
        }
        let evaluations = self.evaluate_initial(stage);
        if self.view().unknown() && self.laws.needs_normal_stiffness() {
            let points = evaluations.points.iter();
            let overlap = points.map(|e| if e.over { e.gap.min(0.0) } else { 0.0 });
            self.history.start.overlap = match self.history.acting {
                true => Vec::new(),
                false => overlap.collect(),
            };
            self.cache.trial = evaluations;
            return Ok(0.0);
        }
        for (i, e) in evaluations.points.iter().enumerate() {
            let batch = evaluations.batch(i);
            let force = batch.force(e).unwrap_or_default();
            for (&dof, r) in batch.dofs(e).iter().zip(force) {
                residual[dof] += r;
            }
        }
        self.cache.trial = evaluations;
        let stored = initial_energy(self.view(), &self.cache.trial.points);
        if self.history.springs {
            // How stiff and viscous what touches is bounds explicit increments from the first on.
            std::mem::swap(&mut self.cache.last, &mut self.cache.trial);
        }
        Ok(stored)
    }

    /// Takes what laws say at `stage.at` for the last evaluation: how stiff and viscous they are there bounds explicit increments.
    pub fn look(&mut self, stage: &Stage) {
        self.cache.last = match self.schedule.active(stage.at.t) {
            true => self.evaluate_initial(stage),
            false => Evaluations::default(),
        };
    }

    /// What laws say before anything is solved.
    fn evaluate_initial(&mut self, stage: &Stage) -> Evaluations {
        self.prepare(stage);
        self.begin();
        let wants = Wants {
            initial: true,
            ..Wants::default()
        };
        self.evaluate_all(stage, wants)
    }

    /// Whether points without mass overlap what they meet at `stage.at`, before the interface has ever acted.
    pub fn presses_light_points(&mut self, stage: &Stage) -> bool {
        if !self.schedule.active(stage.at.t) || self.history.acting || self.laws.tied {
            return false;
        }
        let evaluations = self.evaluate_initial(stage);
        let masses = self.directives.inertia.iter().zip(&self.points);
        let mut points = evaluations.points.iter().zip(masses);
        points.any(|(e, (mass, point))| *mass == 0.0 && e.over && e.gap < -TOUCHING * point.size)
    }

    /// Takes the tractions of an attempt as those from which points without mass go on: what presses them has pressed them before the motion begins.
    pub fn adopt_light(&mut self, tried: &Tried) {
        let masses = self.directives.inertia.iter();
        let all = self.history.points.iter_mut().zip(&tried.0).zip(masses);
        for ((history, &(status, pressure, shear)), _) in all.filter(|(_, m)| **m == 0.0) {
            history.status = status;
            history.pressure = pressure;
            history.shear = shear;
        }
    }

    /// The tractions of the present attempt.
    pub fn tried(&self) -> Tried {
        let points = self.cache.last.points.iter();
        let traction = points.map(|e| {
            let r = &e.response;
            (r.status, r.traction[0], e.along(&e.frames.now))
        });
        Tried(traction.collect())
    }

    /// Takes the tractions of an attempt as those of the last accepted state: what acts from the first instant of a motion. Where a point sticks, what the
    /// others carry is only being built up, and all is left as it is.
    pub fn adopt(&mut self, tried: &Tried) {
        if tried.0.iter().any(|(status, ..)| *status == Status::Stick) {
            return;
        }
        let all = self.history.points.iter_mut().zip(&tried.0);
        for (history, &(_, pressure, shear)) in all.filter(|(_, t)| t.0 == Status::Slip) {
            history.pressure = pressure;
            history.shear = shear;
        }
    }
}

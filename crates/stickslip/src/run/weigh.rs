//! Increments in motion are weighed before they are accepted: where the balance of energies opens too far over one, it is made smaller.

use super::book::ledger_after;
use super::position::Increments;
use super::simulation::Simulation;
use crate::assess::quality::still_energy;
use crate::model::limits::GateMode;
use crate::solve::accepted::Accepted;
use crate::system::{Cause, StepFailure};
use crate::time::Trial;

/// The part of what the limit of the gate leaves open that one increment may use up: however many there are, the limit is kept.
const SHARE: f64 = 0.5;

/// By what twice the increment makes its error larger, that of all schemes here being of the third order.
const ORDER: f64 = 8.0;

/// Increments over the time that the fastest mass on a spring of contact takes for a radian, up to which they resolve it.
const RESOLVED: f64 = 1.0;

/// Halvings that may be of no use because of where in an increment a point opens or closes.
const SPOILT: i32 = 2;

impl Simulation {
    /// Commits an increment in motion, or takes it back as one to be made smaller.
    pub(super) fn weigh(
        &mut self,
        running: &mut Increments,
        trial: Trial,
        mut accepted: Accepted,
    ) -> Result<Accepted, StepFailure> {
        if self.step().dynamic.is_none() {
            return Ok(accepted);
        }
        let before = self.is_weighed().then(|| {
            let interfaces = self.contact.interfaces.iter();
            let histories = interfaces.map(|i| i.history.clone()).collect();
            (histories, self.contact.couplings.memory.clone())
        });
        let stage = accepted.stage(&self.frame.state, trial);
        self.contact.commit(&stage);
        if let Some(before) = before {
            let [opened, may] = self.opened(&accepted);
            let half = 0.5 * (trial.to - trial.from);
            let resolved = opened <= may || self.resolves(trial);
            if running.too_open((opened, may), resolved) && half >= self.step().increments.smallest
            {
                let known = running.opened.filter(|_| resolved);
                let (first, halvings) = known.unwrap_or((opened, 0));
                running.opened = Some((first, halvings + 1));
                self.exchange(before);
                let message = format!(
                    "the balance of energies opens by {opened:.3e} over the increment, more than half of what its limit leaves"
                );
                return Err(StepFailure::new(Cause::TooFar, message));
            }
            // Where the limit is passed already increments are as long as they would be without it.
            accepted.hard |= may > 0.0 && opened > may / ORDER;
        }
        running.tight = accepted.hard;
        running.opened = None;
        self.integration.as_dyn_mut().accept();
        Ok(accepted)
    }

    /// Whether the length of increments is the program's to choose, and the balance of energies is judged.
    fn is_weighed(&self) -> bool {
        self.model.quality.gate != GateMode::Off && !self.step().fixed
    }

    /// Whether an increment resolves how masses swing on the springs of contact, as they are pressed now.
    fn resolves(&self, trial: Trial) -> bool {
        let links = &self.model.links;
        let inverse = self.inverse_masses();
        let interfaces = self.contact.interfaces.iter();
        let squared: f64 = interfaces
            .map(|i| i.pressed_frequency(&inverse, links))
            .sum();
        squared.sqrt() * (trial.to - trial.from) <= RESOLVED
    }

    /// What a push on a point of the mesh moves `[1/kg]`, zero where that has no inertia of its own.
    fn inverse_masses(&self) -> Vec<f64> {
        let inverse = |m: f64| if m > 0.0 { 1.0 / m } else { 0.0 };
        match (self.integration.explicit(), &self.solver.inertia) {
            (Some(explicit), _) => {
                let points = 0..self.model.mesh.points.len();
                points
                    .map(|p| explicit.inverse[self.model.dofs.of(p, 0)])
                    .collect()
            }
            (None, Some(inertia)) => inertia
                .at_points(&self.model)
                .into_iter()
                .map(inverse)
                .collect(),
            (None, None) => vec![0.0; self.model.mesh.points.len()],
        }
    }

    /// By how much the balance of energies opens over a committed increment, and by how much it may `[J]`.
    fn opened(&self, accepted: &Accepted) -> [f64; 2] {
        let (model, frame) = (&self.model, &self.frame);
        let first = self.summary.increments == 0;
        let ledger = ledger_after(model, &self.contact, frame, (accepted, first));
        let mut quality = self.summary.energy_quality;
        quality.note(&ledger);
        let limit = model.quality.energy.unwrap_or(model.energy_limit);
        let [before, after] = [frame.ledger.open(), ledger.open()];
        let [opened, may] = [after - before, SHARE * (limit * quality.scale - before)];
        if opened <= may {
            return [opened, may];
        }
        // What the gate takes for no energy at all is none here.
        let forces = [&accepted.forces, &accepted.contact, &accepted.external];
        let largest = forces.into_iter().flatten();
        let largest = largest.fold(0.0, |m: f64, f| m.max(f.abs()));
        let scale = quality.scale.max(still_energy(model, largest));
        [opened, SHARE * (limit * scale - before)]
    }
}

impl Increments {
    /// Whether the balance opens too far, and a smaller increment would help. Where the limit is passed already none does; and where halving makes the
    /// error no smaller than by half each time, many small increments come to no less than one. What opens or closes on the way may spoil single ones,
    /// and increments that do not resolve how masses swing on the springs of contact are all alike.
    fn too_open(&self, (opened, may): (f64, f64), resolved: bool) -> bool {
        let helps = match self.opened {
            Some((first, halvings)) if resolved => {
                opened < first * f64::powi(0.5, halvings - SPOILT)
            }
            _ => true,
        };
        may > 0.0 && opened > may && helps
    }
}

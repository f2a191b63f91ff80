//! Increments that are accepted: what an attempt hands over, and how it becomes the state.

use super::history;
use super::inertia::strain_energy;
use super::run::Simulation;
use crate::newton::Converged;
use crate::system::{Force, Rate, Stage, State, Tally};
use crate::time::Trial;

/// Energy that flows over an increment.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Flow {
    /// Work of loads and reactions.
    pub work: f64,
    /// Dissipated by Rayleigh damping.
    pub damped: f64,
    /// Dissipated by the scheme.
    pub numerical: f64,
}

/// An increment that may be accepted.
#[derive(Default)]
pub(super) struct Accepted {
    pub state: State,
    /// Out-of-balance forces: reactions at fixed dofs.
    pub forces: Vec<f64>,
    pub contact: Vec<f64>,
    pub external: Vec<f64>,
    pub flow: Flow,
    pub rate: Option<(Vec<f64>, Vec<f64>)>,
    /// Energies, where the attempt knows them already.
    pub kinetic: Option<f64>,
    pub strain: Option<f64>,
    /// `K u`, where inertia plays a part.
    pub internal: Option<Vec<f64>>,
    pub iterations: usize,
    pub rounds: usize,
    pub residual: f64,
    pub tally: Tally,
    /// Bodies were followed to where contact holds them.
    pub followed: bool,
    /// The increment must not grow.
    pub hard: bool,
}

impl Accepted {
    pub(super) fn from_newton(converged: &Converged) -> Self {
        Accepted {
            iterations: converged.iterations,
            rounds: converged.rounds,
            residual: converged.residual,
            tally: converged.tally,
            ..Accepted::default()
        }
    }

    fn summary(&self) -> history::Effort {
        history::Effort {
            iterations: self.iterations,
            rounds: self.rounds,
            residual: self.residual,
            tally: self.tally,
        }
    }
}

impl Simulation {
    /// Tells the interfaces that an attempt is accepted.
    pub(super) fn commit(&mut self, from: &State, trial: Trial, accepted: &Accepted) {
        let stage = Stage {
            from,
            at: &accepted.state,
            dt: trial.to - trial.from,
            rate: accepted
                .rate
                .as_ref()
                .map(|(gain, shift)| Rate { gain, shift }),
        };
        for interface in &mut self.model.interfaces {
            interface.commit(&stage);
        }
        self.model.couplings.commit(&stage);
    }

    /// Makes an accepted attempt the last state, and enters it into the ledger.
    pub(super) fn book(&mut self, accepted: Accepted) -> history::Effort {
        let effort = accepted.summary();
        let followed = accepted.followed || self.pressed_at_start();
        let contact_work = match followed {
            true => self.contact_work(&accepted),
            false => 0.0,
        };
        self.state = accepted.state;
        self.forces = accepted.forces;
        self.contact = accepted.contact;
        self.load = accepted.external;
        let summary = &mut self.summary;
        summary.increments += 1;
        summary.iterations += effort.iterations;
        let turned = self.model.links.largest_rotation(&self.state.u);
        // Elastic bodies are looked at where there is a row of the history.
        summary.largest_rotation = summary.largest_rotation.max(turned);
        if let (Some(motion), Some(internal)) = (&mut self.motion, accepted.internal) {
            motion.internal = internal;
        }
        let kinetic = match (&self.motion, accepted.kinetic) {
            (_, Some(kinetic)) => kinetic,
            (Some(motion), None) => motion.inertia.kinetic_energy(&self.state.v),
            (None, None) => 0.0,
        };
        let strain = accepted
            .strain
            .unwrap_or_else(|| strain_energy(&self.matrix, &self.state.u));
        // The energy of couplings counts with that of the bodies.
        let couplings = &self.model.couplings;
        let (stored, coupled) = (couplings.energy().stored, couplings.work());
        let coupled_before = std::mem::replace(&mut self.coupled, stored);
        let flow = Flow {
            work: accepted.flow.work + coupled,
            ..accepted.flow
        };
        let contact: Vec<_> = self.model.interfaces.iter().map(|i| i.energy()).collect();
        let before = summary.energy.of_interfaces();
        summary
            .energy
            .enter(flow, [kinetic, strain + stored], &contact, followed);
        if followed {
            // Less what the interfaces have entered of it.
            let entered =
                summary.energy.of_interfaces() - before + stored - coupled_before - coupled;
            summary.energy.lose(contact_work - entered);
        }
        summary.energy_quality.note(&summary.energy);
        effort
    }

    /// Whether this is the first increment, at rest, with a normal law that presses where the gap is zero. Surfaces that touch as they are meshed are not in
    /// balance then, and the way to where they are costs nothing.
    fn pressed_at_start(&self) -> bool {
        self.summary.increments == 0
            && self.model.steps[self.step].dynamic.is_none()
            && self.model.interfaces.iter().any(|i| {
                let touching = i.laws.normal.as_dyn().pressure(0.0);
                touching.is_some_and(|p| p.value > 0.0)
            })
    }

    /// Work that contact took over an increment by the trapezoidal rule, as that of loads is entered.
    fn contact_work(&self, accepted: &Accepted) -> f64 {
        let mut work = 0.0;
        for (i, after) in accepted.contact.iter().enumerate() {
            let before = self.contact.get(i).copied().unwrap_or(0.0);
            work += 0.5 * (before + after) * (accepted.state.u[i] - self.state.u[i]);
        }
        work
    }
}

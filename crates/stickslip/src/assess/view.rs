//! An analysis between two increments, as those see it who only look.

use crate::contact::look;
use crate::integrate::explicit::Explicit;
use crate::model::scene::Scene;
use crate::solve::inertia::Inertia;
use crate::solve::solver::Solver;

/// An analysis between two increments: what quality, doctor and results look at.
#[derive(Clone, Copy)]
pub struct View<'a> {
    /// What is simulated and where it stands.
    pub scene: Scene<'a>,
    pub(crate) solver: &'a Solver,
    /// What explicit increments need, in an explicit step.
    pub(crate) explicit: Option<&'a Explicit>,
}

impl<'a> std::ops::Deref for View<'a> {
    type Target = Scene<'a>;

    fn deref(&self) -> &Scene<'a> {
        &self.scene
    }
}

impl<'a> View<'a> {
    /// What bodies, springs and interfaces resist with at the last accepted state, by dof `[N]`, without inertia and damping. At rest that is
    /// what acts from outside; in motion it is what CalculiX prints as `RF`.
    pub fn internal_forces(&self) -> Vec<f64> {
        let (mut out, contact): (Vec<f64>, &[f64]) = match (self.explicit, self.inertia()) {
            (Some(explicit), _) => (explicit.force.clone(), &explicit.out.residual),
            (None, Some(_)) => (self.frame.motion.internal.clone(), &self.frame.contact),
            (None, None) => return self.external_forces(),
        };
        out.iter_mut().zip(contact).for_each(|(out, c)| *out += c);
        let t = self.frame.state.t;
        (self.frame).add_thermal_forces(self.model, t, -1.0, &mut out);
        // Equations act like contact and do not count as what resists.
        self.couplings().add_equation_forces(&mut out);
        out
    }

    /// Momenta by dof with these velocities `[kg m/s]`.
    pub(crate) fn momenta(&self, v: &[f64]) -> Vec<f64> {
        match (self.explicit, self.inertia()) {
            (Some(explicit), _) => explicit.mass.iter().zip(v).map(|(m, v)| m * v).collect(),
            (None, Some(inertia)) => inertia.mass_times(v),
            (None, None) => vec![0.0; v.len()],
        }
    }

    /// What resists acceleration, in an implicit step.
    pub(crate) fn inertia(&self) -> Option<&'a Inertia> {
        let moves = self.step().is_some_and(|s| s.dynamic.is_some());
        (moves && self.explicit.is_none()).then_some(self.solver.inertia.as_ref())?
    }

    /// Elastic energy of bodies and compliant interfaces `[J]`.
    pub(super) fn elastic_energy(&self) -> f64 {
        let interfaces = self.contacts();
        let compliant = interfaces.map(|i| look::law_energy(i)).sum::<f64>();
        self.frame.ledger.strain + compliant
    }
}

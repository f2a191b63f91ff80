//! Forces, energies and tangents of models in which bodies turn cell by cell.

use crate::body::Elastic;
use crate::linear::BlockCsr;
use crate::math::vector::dot;
use crate::model::definition::Model;
use crate::newton::NonlinearBody;

/// Bodies of which some turn cell by cell ([`Elastic::corotational`](crate::body::Elastic::corotational)).
pub(super) struct Cells<'a> {
    pub model: &'a Model,
    /// The stiffness of all others.
    pub linear: &'a BlockCsr,
}

impl Cells<'_> {
    fn turning(&self) -> impl Iterator<Item = &Elastic> {
        let all = self.model.elastic().map(|b| &b.elastic);
        all.filter(|e| e.is_corotational())
    }

    pub fn forces(&self, u: &[f64], out: &mut [f64]) {
        self.linear.mul(u, out);
        self.turning().for_each(|e| e.internal_force(u, out));
    }

    /// Writes what pressures that follow do at a time `[N]`.
    fn press(&self, t: f64, u: &[f64], out: &mut [f64]) {
        out.fill(0.0);
        let (mesh, space) = (&*self.model.mesh, self.model.space);
        for pressing in self
            .model
            .actions
            .loads
            .iter()
            .filter(|l| l.pressing.is_some())
        {
            pressing.external_at(t, mesh, space, u, out);
        }
    }

    pub fn energy(&self, u: &[f64]) -> f64 {
        let mut forces = vec![0.0; u.len()];
        self.linear.mul(u, &mut forces);
        0.5 * dot(u, &forces) + self.turning().map(|e| e.strain_energy(u)).sum::<f64>()
    }
}

/// The same with pressures that follow faces, of which loads have those at the start of the increment.
pub(super) struct Pressed<'a> {
    bodies: Cells<'a>,
    t: f64,
    /// Those at the start `[N]`, by dof.
    known: Vec<f64>,
}

impl<'a> Pressed<'a> {
    /// At the end of an increment that begins at displacements `start`.
    pub fn new(bodies: Cells<'a>, t: f64, start: &[f64]) -> Self {
        let mut known = vec![0.0; start.len()];
        bodies.press(t, start, &mut known);
        Pressed { bodies, t, known }
    }
}

impl NonlinearBody for Pressed<'_> {
    fn forces(&self, u: &[f64], out: &mut [f64]) {
        self.bodies.press(self.t, u, out);
        let now = out.to_vec();
        self.bodies.forces(u, out);
        let change = now.iter().zip(&self.known).map(|(now, known)| now - known);
        out.iter_mut().zip(change).for_each(|(f, c)| *f -= c);
    }

    fn tangents(&self, u: &[f64]) -> [BlockCsr; 2] {
        let model = self.bodies.model;
        let linear = self.bodies.linear;
        let (mut exact, mut stiff) = (linear.clone(), linear.clone());
        let bodies = self.bodies.turning();
        bodies.for_each(|e| e.tangents(u, &mut exact, &mut stiff));
        let (mesh, space) = (&*model.mesh, model.space);
        for load in &model.actions.loads {
            if let Some(pressing) = &load.pressing {
                let factor = -load.schedule.at(self.t);
                pressing.add_tangent(mesh, space, factor, u, &mut exact);
            }
        }
        [exact, stiff]
    }
}

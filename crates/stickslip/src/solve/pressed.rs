//! Bodies that turn cell by cell, with the pressures that follow their faces.

use crate::linear::BlockCsr;
use crate::math::vector::difference;
use crate::model::definition::Model;
use crate::system::NonlinearBody;

/// Bodies with pressures that follow faces, of which loads have those at the start of the increment.
pub(super) struct Pressed<'a> {
    model: &'a Model,
    bodies: &'a dyn NonlinearBody,
    t: f64,
    /// Those at the start `[N]`, by dof.
    known: Vec<f64>,
}

impl<'a> Pressed<'a> {
    /// At the end of an increment that begins at displacements `start`.
    pub fn new(model: &'a Model, bodies: &'a dyn NonlinearBody, t: f64, start: &[f64]) -> Self {
        Pressed {
            known: pressures(model, t, start),
            model,
            bodies,
            t,
        }
    }
}

/// What pressures that follow do at a time `[N]`.
fn pressures(model: &Model, t: f64, u: &[f64]) -> Vec<f64> {
    let mut out = vec![0.0; u.len()];
    let pressing = model.actions.loads.iter().filter(|l| l.pressing.is_some());
    pressing.for_each(|load| load.external_at(t, &model.mesh, model.space, u, &mut out));
    out
}

impl NonlinearBody for Pressed<'_> {
    fn write_forces(&self, u: &[f64], out: &mut [f64]) {
        self.bodies.write_forces(u, out);
        let change = difference(&pressures(self.model, self.t, u), &self.known);
        out.iter_mut().zip(change).for_each(|(f, c)| *f -= c);
    }

    fn tangents(&self, u: &[f64]) -> [BlockCsr; 2] {
        let model = self.model;
        let [mut exact, stiff] = self.bodies.tangents(u);
        for load in &model.actions.loads {
            if let Some(pressing) = &load.pressing {
                let factor = -load.schedule.at(self.t);
                pressing.add_tangent(&model.mesh, model.space, factor, u, &mut exact);
            }
        }
        [exact, stiff]
    }
}

//! What is simulated and where it stands.

use crate::body::couplings::CouplingsView;
use crate::contact::interface::ContactView;
use crate::contact::look;
use std::borrow::Cow;

use super::contact::Contact;
use super::definition::{Model, Step};
use super::frame::Frame;
use super::second_field::FieldIncrement;
use crate::math::{add, cross, mat_vec, scale, sub};
use crate::system::{Constraints, Field, Fields, Location, State};

/// What is simulated and where it stands: enough to say what acts.
#[derive(Clone, Copy)]
pub struct Scene<'a> {
    /// What is simulated.
    pub model: &'a Model,
    /// Interfaces and couplings.
    pub contact: &'a Contact,
    /// The last accepted increment.
    pub frame: &'a Frame,
}

impl<'a> Scene<'a> {
    /// The interfaces as they were after the increment.
    pub fn contacts(&self) -> impl ExactSizeIterator<Item = ContactView<'a>> + use<'a> {
        self.contact.views(self.frame)
    }

    /// The couplings as they were after it.
    pub fn couplings(&self) -> CouplingsView<'a> {
        self.contact.coupled(self.frame)
    }

    /// Constraints at a time.
    pub(crate) fn constraints(&self, t: f64) -> Constraints {
        self.frame.constraints(self.model, t)
    }

    /// Displacements in space, by dof `[m]`.
    pub fn displacements(&self) -> Cow<'a, [f64]> {
        let (model, u) = (self.model, &self.frame.state.u);
        match model.frames.is_empty() {
            true => Cow::Borrowed(u),
            false => Cow::Owned(model.frames.in_space(&model.mesh.points, u)),
        }
    }

    /// Velocities and accelerations of points in space, by dof; empty where nothing has moved yet.
    pub fn velocities(&self) -> [Cow<'a, [f64]>; 2] {
        let (model, state) = (self.model, &self.frame.state);
        if !model.frames.any_rigid() || state.v.is_empty() {
            return [&state.v, &state.a].map(|x| Cow::Borrowed(x.as_slice()));
        }
        let (mut v, mut a) = (state.v.clone(), state.a.clone());
        a.resize(v.len(), 0.0);
        (model.frames).move_points(&model.mesh.points, &state.u, [&mut v, &mut a]);
        [Cow::Owned(v), Cow::Owned(a)]
    }

    /// What reference points hold against the inertia of rigid bodies that swing about them, by dof `[N]`: their own dofs stand still, and do not know of it.
    pub(crate) fn swinging(&self) -> Vec<(usize, f64)> {
        let (model, state) = (self.model, &self.frame.state);
        let mut out = Vec::new();
        if state.a.is_empty() {
            return out;
        }
        let links = &model.links;
        let poses = model.frames.poses(&state.u);
        for (frame, pose) in model.frames.all().iter().zip(poses) {
            let body = model.bodies.iter().find(|b| b.points == frame.points);
            let (Some(rigid), Some(hidden)) = (body.and_then(|b| b.rigid), frame.hidden()) else {
                continue;
            };
            let own = &links.all()[rigid.link];
            if own.hidden == hidden {
                continue;
            }
            let length = links
                .of_hidden(hidden)
                .map_or(1.0, |i| links.all()[i].length);
            let turning = |x: &[f64]| {
                let x = scale(1.0 / length, model.dofs.vector(x, hidden + 1));
                match model.dofs.dim {
                    2 => [0.0, 0.0, x[0]],
                    _ => x,
                }
            };
            let (spin, turn) = (turning(&state.v), turning(&state.a));
            let arm = sub(own.centre, pose.centre);
            let bent = add(cross(turn, arm), cross(spin, cross(spin, arm)));
            let force = scale(rigid.mass, mat_vec(&pose.turn, bent));
            out.extend((0..model.dofs.dim).map(|c| (model.dofs.of(hidden, c), force[c])));
        }
        out
    }

    /// The state for bodies without rotation: what is left of displacements in their frames.
    pub(crate) fn strained(&self) -> Cow<'a, State> {
        let (bodies, state) = (&self.model.corotations, &self.frame.state);
        match bodies.is_empty() {
            true => Cow::Borrowed(state),
            false => Cow::Owned(State {
                t: state.t,
                u: bodies.local(&bodies.turns(&state.u), &state.u),
                ..State::default()
            }),
        }
    }

    /// Turns stresses and strains of bodies that turn from the axes of their frames to those of space.
    pub(crate) fn turn_tensors(&self, fields: &mut Fields) {
        let (bodies, frames) = (&self.model.corotations, &self.model.frames);
        if bodies.is_empty() && frames.is_empty() {
            return;
        }
        let u = &self.frame.state.u;
        let turns = bodies.turns(u);
        for field in fields.all.iter_mut().filter(|f| f.components == 6) {
            field.as_tensors(|tensors| {
                bodies.turn_tensors(&turns, tensors);
                frames.turn_tensors(u, tensors);
            });
        }
    }

    /// Values of all second fields at the end of an increment of this length that the frame is at the end of.
    pub(crate) fn advanced_fields(&self, dt: f64) -> Vec<Vec<f64>> {
        let fields = self.model.actions.fields.iter().zip(&self.frame.fields);
        let advanced = fields.map(|(field, before)| {
            field.advance(&FieldIncrement {
                contacts: self.contacts().collect(),
                state: &self.frame.state,
                before,
                dt,
            })
        });
        advanced.collect()
    }

    /// Adds the second fields that have values at the points of the mesh.
    pub(crate) fn add_second_fields(&self, out: &mut Fields) {
        for (field, values) in self.model.actions.fields.iter().zip(&self.frame.fields) {
            let dofs = field.dofs();
            if dofs.points == self.model.mesh.points.len() {
                out.all.push(Field {
                    name: field.name().to_string(),
                    location: Location::Point,
                    components: dofs.dim,
                    values: values.clone(),
                });
            }
        }
    }

    /// Loads at a time: external forces that move bodies as wholes.
    pub(crate) fn loads(&self, t: f64) -> Vec<f64> {
        self.frame.loads(self.model, t)
    }

    /// Dofs that are prescribed at the time of the state, by dof.
    pub fn held_dofs(&self) -> Vec<bool> {
        let t = self.frame.state.t;
        self.frame.constraints(self.model, t).fixed
    }

    /// What supports prescribe at a time, by dof; nothing that follows or is left out.
    pub(crate) fn supported(&self, t: f64) -> Vec<bool> {
        let mut held = vec![false; self.model.dofs.count()];
        let acting = self.model.actions.supports.iter();
        for support in acting.filter(|s| s.schedule.active(t)) {
            support.entries.iter().for_each(|e| held[e.dof] = true);
        }
        held
    }

    /// What acts on the points from outside, by dof `[N]`: loads, reactions of supports, and equations. In equilibrium it is what bodies,
    /// springs and interfaces resist with.
    pub fn external_forces(&self) -> Vec<f64> {
        let both = self.frame.forces.iter().zip(&self.frame.load);
        let mut out: Vec<f64> = both.map(|(reaction, load)| reaction + load).collect();
        // What bodies press with themselves, being warm, is none of it.
        let t = self.frame.state.t;
        (self.frame).add_thermal_forces(self.model, t, -1.0, &mut out);
        self.couplings().add_equation_forces(&mut out);
        out
    }

    /// The number of the point whose forces are farthest from balance, if any are.
    pub fn worst_point(&self) -> Option<u64> {
        let fixed = self.held_dofs();
        let dofs = self.model.dofs;
        let points = 0..self.model.mesh.points.len();
        let size = |p: usize| -> f64 {
            let free = (0..dofs.dim).map(|c| dofs.of(p, c)).filter(|&d| !fixed[d]);
            free.map(|d| self.frame.forces[d].powi(2)).sum()
        };
        let worst = points
            .map(|p| (size(p), p))
            .max_by(|a, b| a.0.total_cmp(&b.0))?;
        (worst.0 > 0.0).then(|| self.model.mesh.point_ids[worst.1])
    }

    /// The step at hand; `None` in an analysis without steps.
    pub fn step(&self) -> Option<&'a Step> {
        self.model.steps.get(self.frame.step)
    }

    /// Its name.
    pub fn step_name(&self) -> &'a str {
        self.step().map_or("", |s| s.name.as_str())
    }

    /// Its index.
    pub fn step_index(&self) -> usize {
        self.frame.step
    }

    /// The step at hand, for a sentence.
    pub(crate) fn called(&self) -> String {
        match self.step_name() {
            name if name.starts_with("step") => name.to_string(),
            name => format!("step {name}"),
        }
    }

    /// Whether a body is in contact at the last accepted state.
    pub(crate) fn touches(&self, body: usize) -> bool {
        let points = &self.model.bodies[body].points;
        let mut all = self.contacts().filter(|i| !i.laws.tied);
        all.any(|i| look::touched(i) && i.nodes.iter().any(|n| points.contains(n)))
    }
}

//! Rigid bodies that turn by any angle in space, without equations.
//!
//! Central differences let moments act in an instant at both ends of an increment, and nothing in between. So a body drifts from the one to the other with its
//! angular momentum and its energy, which [`IncrementalRotation::drift`] keeps:
//!
//! ```text
//! J Ω½ = J Ω₀ + dt/2 m₀,   R₁ = R₀ exp(ψ),   J Ω₁ = exp(ψ)ᵀ J Ω½ + dt/2 m₁
//! ```
//!
//! with moments along the axes of the body at the time.

use std::borrow::Cow;

use super::explicit::Explicit;
use crate::math::{Vec3, add, add_scaled, cross, dot, scale, sub};
use crate::model::definition::Model;
use crate::model::frame::Frame;
use crate::solve::spin::Spin;
use crate::system::{Constraints, Dofs, IncrementalRotation, State};

/// The rigid bodies that turn freely in space over an explicit increment.
pub(super) struct Drift<'a> {
    dofs: Dofs,
    spinning: IncrementalRotation,
    /// The rotation nodes of rigid bodies without rotational supports.
    free: Vec<usize>,
    /// The start, rotations counted from there and moments along the axes of the bodies.
    from: Cow<'a, Frame>,
}

impl<'a> Drift<'a> {
    pub fn new(model: &Model, frame: &'a Frame, constraints: &Constraints) -> Self {
        let dofs = model.dofs;
        let spinning = IncrementalRotation::new(&model.frames, &frame.state.u);
        let own = |p: usize| dofs.of(p, 0)..dofs.of(p + 1, 0);
        let points = spinning.points();
        let free = points.filter(|&p| constraints.fixed[own(p)].iter().all(|f| !f));
        let free = free.collect();
        let mut from = Cow::Borrowed(frame);
        if !spinning.is_empty() {
            let own = from.to_mut();
            spinning.enter(&mut own.state.u);
            for x in [&mut own.load, &mut own.forces, &mut own.contact] {
                if !x.is_empty() {
                    spinning.to_body_axes(x);
                }
            }
        }
        Drift {
            dofs,
            spinning,
            free,
            from,
        }
    }

    /// The start of the increment as it is seen.
    pub fn from(&self) -> &Frame {
        &self.from
    }

    /// The same, to be changed.
    pub fn start(&mut self) -> &mut Frame {
        self.from.to_mut()
    }

    /// What the rate of a body makes of its moment of momentum, where it turns freely: no moment is needed for that.
    pub fn turning(&self, spin: &Spin, v: &[f64]) -> Vec3 {
        if !self.has(spin) {
            return [0.0; 3];
        }
        let rate = spin.of(v);
        cross(scale(1.0 / self.length(spin), rate), spin.force(rate))
    }

    /// Whether it is one of these.
    pub fn has(&self, spin: &Spin) -> bool {
        self.free.contains(&self.dofs.locate(spin.range().start).0)
    }

    /// What acted on a body at the start, but for its inertia.
    fn moment(&self, spin: &Spin, from: &State) -> Vec3 {
        let rate = spin.of(&from.v);
        let momentum = spin.force(rate);
        let turned = cross(scale(1.0 / self.length(spin), rate), momentum);
        add(spin.force(spin.of(&from.a)), turned)
    }

    fn length(&self, spin: &Spin) -> f64 {
        let point = self.dofs.locate(spin.range().start).0;
        self.spinning.length(point)
    }

    /// Replaces rotations and spins at the end by those of a drift.
    pub fn predict(&self, explicit: &Explicit, fixed: &[bool], dt: f64, at: &mut State) {
        if self.spinning.is_empty() {
            return;
        }
        let from = &self.from.state;
        let mut pushed = explicit.angular(&from.v);
        for spin in explicit.spins.iter().filter(|s| self.has(s)) {
            let half = scale(0.5 * dt, self.moment(spin, from));
            for (i, m) in spin.range().zip(half) {
                pushed[i] += m;
            }
        }
        let of = |point: usize| {
            let mut all = explicit.spins.iter();
            all.find(|s| self.dofs.locate(s.range().start).0 == point)
        };
        let rate = |point: usize, p: Vec3| of(point).map_or([0.0; 3], |s| s.turned_by(p));
        let found = self.spinning.drift(&pushed, dt, rate);
        self.spinning.enter_prescribed(&mut at.u, fixed);
        for (point, [turned, momentum]) in self.spinning.points().zip(found) {
            let own = self.dofs.of(point, 0)..self.dofs.of(point + 1, 0);
            if self.free.contains(&point) {
                at.u[own.clone()].copy_from_slice(&turned);
                at.v[own].copy_from_slice(&rate(point, momentum));
            } else {
                self.spinning.count_from_start(point, fixed, &mut at.u);
            }
        }
    }

    /// Displacements in space, with rotations counted from the start.
    pub fn place(&self, u: &[f64]) -> Vec<f64> {
        let mut u = u.to_vec();
        self.spinning.leave(&mut u);
        u
    }

    /// Lets a moment at the end act on a body; by how much its energy has grown more than by the mean of the moments at both ends.
    pub fn kick(&self, spin: &Spin, from: &Frame, dt: f64, moment: Vec3, at: &mut State) -> f64 {
        let first = self.moment(spin, &from.state);
        let rate = add_scaled(spin.of(&at.v), 0.5 * dt, spin.turned_by(moment));
        let turned = cross(scale(1.0 / self.length(spin), rate), spin.force(rate));
        let change = spin.turned_by(sub(moment, turned));
        let before = spin.square(spin.of(&from.state.v));
        let way = spin.of(&at.u);
        for (k, i) in spin.range().enumerate() {
            at.v[i] = rate[k];
            at.a[i] = change[k];
        }
        let gained = 0.5 * (spin.square(rate) - before);
        gained - 0.5 * dot(add(first, moment), way)
    }
}

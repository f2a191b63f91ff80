//! From where bodies that turn freely are seen in an increment.
//!
//! Nodal masses do not depend on direction, so that motion has the same equations along the axes of any frame that stands still. From one that stands where the
//! body will be, it turns by as little as that is wrong, so that matrices that were factored once are good derivatives.
//!
//! Rigid bodies have their motion among the unknowns; in space it is counted from the start of the increment ([`IncrementalRotation`]).

use std::sync::Arc;

use crate::math::{Vec3, norm, scale};
use crate::model::definition::Model;
use crate::model::frame::{Frame, Motion};
use crate::newton::Converged;
use crate::number::digits;
use crate::solve::accepted::Accepted;
use crate::system::{
    BodyFrame, BodyFrames, BodyTurn, Carrier, Cause, Constraints, IncrementalRotation, State,
    StepFailure,
};
use crate::time::newmark::Increment;
use crate::time::scheme::Alphas;

/// Most times that an increment is solved again with forces that have been found where it ended. Each leaves the part of the imbalance by which bodies are
/// strained, and by which they have turned otherwise than expected.
const SOLUTION_PASSES: usize = 40;

/// What acts at the end of an increment.
pub(super) struct Acting<'a> {
    /// What is prescribed.
    pub constraints: Constraints,
    /// External forces `[N]`.
    pub external: Vec<f64>,
    /// From where bodies that turn freely are seen, if any do.
    pub sight: Option<InertialFrame<'a>>,
}

impl<'a> Acting<'a> {
    pub fn new(model: &Model, frame: &Frame, t: f64) -> Acting<'a> {
        Acting {
            constraints: frame.constraints(model, t),
            external: frame.external(model, t),
            sight: None,
        }
    }
}

/// Forces where an increment ended without those of interfaces, and the size of what balances in them `[N]`.
#[derive(Clone, Copy)]
pub(super) struct Ended<'a> {
    pub forces: &'a [f64],
    pub size: f64,
}

/// From where bodies that turn freely are seen in an increment.
pub(super) struct InertialFrame<'a> {
    /// The start, along the axes of space.
    pub outer: &'a Frame,
    /// The frames of elastic bodies.
    pub frames: BodyFrames,
    /// Those and the ones of rigid bodies: what interfaces need.
    pub all: Arc<BodyFrames>,
    /// How rigid bodies turn.
    pub spinning: IncrementalRotation,
}

impl<'a> InertialFrame<'a> {
    /// From where the frames of the bodies will be after this time, if they go on as they do.
    pub fn new(model: &Model, frame: &'a Frame, after: f64) -> Self {
        let bodies = &model.corotations;
        let turns = bodies.turns(&frame.state.u);
        let spins = bodies.spins(&turns, &frame.state.v);
        let each = turns.iter().zip(spins);
        let ahead = each
            .map(|(turn, [spin, velocity])| turn.moved(scale(after, spin), scale(after, velocity)));
        InertialFrame::from(model, frame, &ahead.collect::<Vec<_>>())
    }

    /// From frames that are there.
    pub fn from(model: &Model, frame: &'a Frame, turns: &[BodyTurn]) -> Self {
        let each = model.corotations.points().zip(turns);
        let all = each.map(|(points, turn)| BodyFrame {
            points,
            carrier: Carrier::Still(turn.pose()),
            rigid: false,
        });
        let all: Vec<BodyFrame> = all.collect();
        let carried = model.frames.from_here(&frame.state.u);
        InertialFrame {
            outer: frame,
            all: Arc::new(carried.with(all.iter().cloned())),
            frames: BodyFrames::new(model.dofs, all),
            spinning: IncrementalRotation::new(&model.frames, &frame.state.u),
        }
    }

    /// The start as it is seen.
    pub fn inside(&self, model: &Model) -> Frame {
        let (outer, points) = (self.outer, &model.mesh.points);
        let turned = |values: &[f64]| {
            let mut values = values.to_vec();
            if !values.is_empty() {
                self.frames.turn_in(&[], &mut values);
            }
            values
        };
        let acting = |values: &[f64]| {
            let mut values = turned(values);
            if !values.is_empty() {
                self.spinning.to_body_axes(&mut values);
            }
            values
        };
        Frame {
            state: State {
                t: outer.state.t,
                u: self.place(points, &outer.state.u),
                v: turned(&outer.state.v),
                a: turned(&outer.state.a),
            },
            forces: acting(&outer.forces),
            contact: acting(&outer.contact),
            load: acting(&outer.load),
            motion: Motion {
                internal: acting(&outer.motion.internal),
                start: match outer.motion.start.is_empty() {
                    true => Vec::new(),
                    false => self.place(points, &outer.motion.start),
                },
                travel: outer.motion.travel,
            },
            ..outer.clone()
        }
    }

    /// Displacements as they are seen.
    pub fn place(&self, points: &[Vec3], u: &[f64]) -> Vec<f64> {
        let mut u = self.frames.in_frames(points, u);
        self.spinning.enter(&mut u);
        u
    }

    /// Displacements in space.
    fn out(&self, points: &[Vec3], u: &[f64]) -> Vec<f64> {
        let mut u = self.frames.in_space(points, u);
        self.spinning.leave(&mut u);
        u
    }

    /// Where bodies that turn freely are expected to end. Their accelerations have no part in it: those of a scheme without dissipation ring.
    pub fn expect(&self, model: &Model, start: &State, dt: f64, u: &mut [f64]) {
        model.corotations.go_on(&start.u, &start.v, dt, u);
    }

    /// Lets the points of unconstrained rigid bodies have the velocities that Newmark's relations give their bodies.
    pub fn rate(
        &self,
        model: &Model,
        increment: &Increment,
        fixed: &[bool],
        gain: &mut [f64],
        shift: &mut [f64],
    ) {
        let (dofs, from) = (model.dofs, increment.from);
        if !model.frames.any_rigid() {
            return;
        }
        let (mut v, mut a) = (from.v.clone(), from.a.clone());
        self.all
            .move_points(&model.mesh.points, &from.u, [&mut v, &mut a]);
        let Alphas { beta, gamma, .. } = increment.alphas;
        let dt = increment.dt;
        for frame in self.all.all().iter().filter(|f| f.rigid) {
            let hidden = frame.hidden().unwrap_or_default();
            let own = dofs.of(hidden, 0)..dofs.of(hidden + 2, 0);
            if fixed[own].iter().all(|f| *f) {
                continue;
            }
            for i in dofs.of(frame.points.start, 0)..dofs.of(frame.points.end, 0) {
                gain[i] = gamma / beta;
                let turned = dt * (1.0 - 0.5 * gamma / beta) * a[i];
                shift[i] = dt * ((1.0 - gamma / beta) * v[i] + turned);
            }
        }
    }

    /// What acts from outside at a time, where displacements are as seen.
    pub fn load(&self, model: &Model, u: &[f64], t: f64, out: &mut Vec<f64>) {
        let turning = model.frames.any_rigid() || model.actions.loads.iter().any(|l| l.follows);
        if (model.actions.loads.is_empty() || !turning) && !out.is_empty() {
            return;
        }
        let seen = self.out(&model.mesh.points, u);
        *out = self.outer.external_at(model, t, &seen);
        self.frames.turn_in(&[], out);
        self.spinning.to_body_axes(out);
        self.spinning.lean(u, out);
    }

    /// What is prescribed: points of bodies that turn are held altogether.
    pub fn constraints(&self, model: &Model, t: f64) -> Constraints {
        let mut constraints = self.outer.constraints(model, t);
        let (dofs, points) = (model.dofs, &model.mesh.points);
        let placed = self.frames.in_frames(points, &constraints.values);
        for p in model.corotations.points().flatten() {
            let own = dofs.of(p, 0)..dofs.of(p + 1, 0);
            let fixed = constraints.fixed[own.clone()].iter();
            let placed = placed[own.clone()].iter();
            let values = constraints.values[own].iter_mut();
            let all = values.zip(placed).zip(fixed).filter(|(_, fixed)| **fixed);
            all.for_each(|((value, placed), _)| *value = *placed);
        }
        let Constraints { values, fixed, .. } = &mut constraints;
        self.spinning.enter_prescribed(values, fixed);
        constraints
    }

    /// Turns vectors by dof from how they are seen to space.
    pub fn turn_out(&self, vectors: &mut [f64]) {
        self.frames.turn_out(&[], vectors);
    }

    /// It without the start.
    pub fn outlook(&self) -> Outlook {
        (self.frames.clone(), self.spinning.clone())
    }

    /// Whether an increment that Newton's method has found balances with the forces where it ended without those of interfaces, and the size of what
    /// balances in them; with these, if it does.
    pub fn met(
        &self,
        model: &Model,
        converged: &Converged,
        end: Ended,
        fixed: &[bool],
        diagonal: &[f64],
        passes: usize,
    ) -> Result<Option<Converged>, StepFailure> {
        let size = |forces: &[f64]| {
            let free = forces.iter().zip(fixed).filter(|(_, fixed)| !**fixed);
            free.map(|(f, _)| f * f).sum::<f64>().sqrt()
        };
        let both = end.forces.iter().zip(&converged.contact);
        let forces: Vec<f64> = both.map(|(a, b)| a + b).collect();
        let off = size(&forces);
        // Of places: what strains is a difference of these.
        let places = model
            .mesh
            .points
            .iter()
            .zip(diagonal.chunks(model.dofs.dim));
        let worst = places.map(|(x, k)| (norm(*x) * k[0]).powi(2)).sum::<f64>();
        // The forces on points may be off by four roundings of places.
        let rounding = 4.0 * f64::EPSILON * worst.sqrt();
        let scale = end.size.max(size(&converged.contact));
        let enough = (model.solution.settings.tolerance * scale)
            // Twice as much as Newton's method left may be out of balance where that cannot do better.
            .max(2.0 * size(&converged.forces))
            .max(rounding);
        if off <= enough {
            return Ok(Some(Converged {
                forces,
                ..converged.clone()
            }));
        }
        if off.is_nan() || passes >= SOLUTION_PASSES {
            return Err(StepFailure::new(
                Cause::NotConverged,
                format!(
                    "bodies that turn are out of balance by {} of the forces on them after {passes} passes",
                    digits(off / scale.max(f64::MIN_POSITIVE), 2),
                ),
            )
            .help("take smaller increments; bodies must not be strained by more than a few per cent"));
        }
        Ok(None)
    }
}

/// The frames in which interfaces see rigid bodies that turn in space, from where they are at displacements `u`; `None` where there are no such bodies.
pub(super) fn frames_here(model: &Model, u: &[f64]) -> Option<Arc<BodyFrames>> {
    let spun = !model.frames.spun().is_empty();
    spun.then(|| Arc::new(model.frames.from_here(u)))
}

/// What an increment is seen from, without its start.
pub(super) type Outlook = (BodyFrames, IncrementalRotation);

/// An increment that was found as bodies are seen, along the axes of space.
pub(super) fn in_space(
    model: &Model,
    (frames, spinning): &Outlook,
    mut accepted: Accepted,
) -> Accepted {
    let seen = accepted.state.u;
    accepted.state.u = frames.in_space(&model.mesh.points, &seen);
    let state = &mut accepted.state;
    spinning.leave(&mut state.u);
    let motion = [&mut state.v, &mut state.a].into_iter();
    let moving = motion.filter(|x| !x.is_empty());
    moving.for_each(|x| frames.turn_out(&[], x));
    let vectors = [
        &mut accepted.forces,
        &mut accepted.contact,
        &mut accepted.external,
    ];
    let acting = vectors.into_iter().chain(accepted.internal.as_mut());
    for vector in acting.filter(|x| !x.is_empty()) {
        frames.turn_out(&[], vector);
        spinning.outward(&seen, vector);
    }
    accepted
}

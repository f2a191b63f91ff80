//! What an accepted increment leaves behind: histories, and the energies that went through the interface on the way.

use std::sync::Arc;

use super::belt::belt_path;
use super::cache::Cache;
use super::cone::friction_error;
use super::definition::{InterfaceDefinition, Primary};
use super::energies::stored_energy;
use super::evaluation::{Evaluation, Evaluations};
use super::faces::integrate_accepted;
use super::history::{History, PointHistory};
use super::input::InterfaceInput;
use super::parts::InterfaceForce;
use super::pass::evaluate_all;
use super::scene::Wants;
use super::sides::{leave_traces, opposite};
use super::view::ContactView;
use super::wear::{add_nodal_wear, path, sliding_distance, wear_increment, wear_track};
use crate::contact::enforcement::Multipliers;
use crate::contact::law::friction::LawState;
use crate::contact::response::Status;
use crate::math::{Vec3, add, add_scaled, cross, dot, norm, scale, sub};
use crate::system::Stage;
use crate::tolerance::SAME;

/// What the committed history of a point becomes, and what happened on the way, per area.
struct Passed {
    history: PointHistory,
    /// Dissipated by friction `[J/m²]`, and by how much that may be off.
    dissipated: f64,
    uncertain: f64,
    /// See [`Energy::excess`](crate::system::Energy::excess) `[J/m²]`.
    excess: f64,
    /// Depth worn off the side with the points and the other `[m]`, and the part of its area that the point covers.
    worn: [f64; 2],
    covered: f64,
    /// Work on the bodies by the trapezoidal rule, but for damping `[J/m²]`.
    work: f64,
}

/// An increment as all points see it.
struct Increment {
    /// Contact is followed along its path: nothing moves fast, and multipliers hold it.
    resolved: bool,
    /// Way of the belt.
    belt: Vec3,
    /// Start and end `[s]`.
    times: [f64; 2],
    dt: f64,
    /// Points that stick creep.
    creeps: bool,
}

/// What the committed history becomes: the trial, and what that adds to the energies.
pub fn commit(interface: &mut InterfaceForce, stage: &Stage) -> History {
    let active = interface.schedule.active(stage.at.t);
    let cone = friction_error(interface, stage);
    let nodal = nodal_forces(interface.definition, &interface.cache.last, active);
    trust_multipliers(&mut interface.cache.last.points);
    let (input, cache) = interface.parts();
    let state = input.state;
    let mut next = History {
        points: Vec::with_capacity(state.points.len()),
        law_states: Vec::new(),
        acting: active && !cache.last.points.is_empty(),
        opposite: opposite(input.definition, &cache.last),
        start: Arc::clone(&state.start),
        springs: state.springs,
        rest: Arc::clone(&state.rest),
        energy: state.energy,
        worn: state.worn.clone(),
        nodal,
        dissipated: state.dissipated.clone(),
        pushed: state.pushed,
        creep: state.creep,
        cone,
    };
    next.law_states = law_states(input, &cache.last, stage.dt);
    push(input.definition, &mut next, stage);
    if !next.acting {
        next.points
            .extend(state.points.iter().map(PointHistory::at_rest));
        next.energy.stored = 0.0;
        return next;
    }
    let increment = Increment {
        resolved: stage.rate.is_none() && !state.springs,
        belt: belt_path(input, stage),
        times: [stage.from.t, stage.at.t],
        dt: stage.dt,
        creeps: input.laws.friction_law().frictional() && !input.laws.slip.as_dyn().sticks(),
    };
    let gaps = match increment.resolved {
        true => gaps_before(input, cache, stage),
        false => Vec::new(),
    };
    let last = &cache.last;
    let mut traces = Vec::with_capacity(state.points.len());
    let mut volumes = traces.clone();
    next.creep = 0.0;
    let (mut dissipated, mut work) = (0.0, 0.0);
    for (i, h) in state.points.iter().enumerate() {
        let gap = gaps.get(i).copied().unwrap_or(h.gap);
        let passed = take_over(input, last, &mut next, i, gap, &increment);
        let area = passed.history.area;
        traces.push(passed.dissipated);
        volumes.push(passed.worn[1] * area);
        dissipated += passed.dissipated * area;
        work += passed.work * area;
    }
    share_accumulated(input.definition, last, &mut next);
    if !state.start.overlap.is_empty() {
        Arc::make_mut(&mut next.start).overlap.clear();
    }
    next.energy.dissipated += dissipated;
    leave_traces(input.definition, last, &traces, &mut next);
    add_nodal_wear(input.definition, last, &volumes, &mut next);
    wear_track(input, last, &volumes, stage, &mut next);
    let stored = stored_energy(ContactView {
        definition: input.definition,
        state: &next,
    });
    next.energy.stored = stored;
    integrate_accepted(input, &mut cache.geometry, stage);
    if increment.resolved {
        // Along its path contact gave what it no longer stores, and took what friction has turned into heat.
        next.energy.path += work - (state.energy.stored - stored - dissipated);
    }
    next
}

/// Takes multipliers for the tractions where what the laws answer is not quite the same: because they are so steep that it is rounding to some digits, or
/// because the forces by which the balance is judged are larger by far. Multipliers are what acts on the bodies.
fn trust_multipliers(points: &mut [Evaluation]) {
    let size = |t: &[f64; 3]| t.iter().fold(0.0, |m: f64, t| m.max(t.abs()));
    let forces = points.iter().map(|e| size(&e.kept.multiplier) * e.area);
    let largest = forces.fold(0.0, f64::max);
    for e in points {
        let open = e.response.status == Status::Open;
        let off = e.saddle.map_or(0.0, |(rest, _)| size(&rest) * e.area);
        // Where multipliers differ by more from what the laws answer, the laws decide.
        if !open && off > SAME * largest {
            e.response.traction = e.kept.multiplier;
        }
    }
}

/// State variables of the friction law at the end of an increment: those that the law has answered at points in contact, and at the others what it makes of them while
/// nothing touches.
fn law_states(input: InterfaceInput, last: &Evaluations, dt: f64) -> Vec<LawState> {
    let law = input.laws.friction_law();
    let states = input.state.law_states.iter().enumerate();
    states
        .map(|(i, before)| match last.points.get(i) {
            Some(e) if e.response.status != Status::Open => e.response.state,
            _ => law.open_state(before, dt),
        })
        .collect()
}

/// Copies to all points that move alike the wear, slip, path and law states of the one of them that is in contact, and to points whose multiplier others have
/// the wear, work, path and law states per area of these.
fn share_accumulated(definition: &InterfaceDefinition, last: &Evaluations, next: &mut History) {
    let (points, states) = (&mut next.points, &mut next.law_states);
    let worn = &mut next.worn;
    for (i, earlier) in definition.alike.iter().enumerate() {
        for &j in earlier {
            let (carries, other) = match [i, j].map(|k| last.points[k].foot.facet.is_some()) {
                [true, false] => (i, j),
                [false, true] => (j, i),
                _ => continue,
            };
            points[other] = points[carries].accumulated_into(&points[other]);
            worn.copy(carries, other);
            if !states.is_empty() {
                states[other] = states[carries];
            }
        }
    }
    let merged = definition.mortar.iter().flat_map(|m| m.merged.all());
    for (point, heirs) in merged {
        let whole: f64 = heirs.iter().map(|(_, area)| area).sum();
        let mean_of = |of: &dyn Fn(usize) -> f64| -> f64 {
            let parts = heirs.iter().map(|&(k, area)| area * of(k));
            parts.sum::<f64>() / whole
        };
        if !states.is_empty() {
            states[point] = std::array::from_fn(|s| mean_of(&|k| states[k][s]));
        }
        let depth = mean_of(&|k| worn.own_depth(k));
        worn.set_own_depth(point, depth);
        let mean = |of: fn(&PointHistory) -> f64| mean_of(&|k| of(&points[k]));
        points[point] = PointHistory {
            dissipated: mean(|h| h.dissipated),
            path: mean(|h| h.path),
            spent: mean(|h| h.spent),
            ..points[point]
        };
    }
}

impl PointHistory {
    /// The accumulated history of this point with the status and gap of the other.
    fn accumulated_into(&self, other: &Self) -> Self {
        PointHistory {
            status: other.status,
            gap: other.gap,
            ..self.at_rest()
        }
    }

    /// What is kept where nothing acts: what adds up.
    fn at_rest(&self) -> Self {
        PointHistory {
            slip: self.slip,
            dissipated: self.dissipated,
            path: self.path,
            spent: self.spent,
            ..PointHistory::default()
        }
    }
}

/// Enters a point into the history, and what it did into the energies. `gap`: at the start.
fn take_over(
    input: InterfaceInput,
    last: &Evaluations,
    next: &mut History,
    i: usize,
    gap: f64,
    increment: &Increment,
) -> Passed {
    let (e, h) = (&last.points[i], &input.state.points[i]);
    let passed = pass(input, i, e, gap, increment);
    let (area, r) = (e.area, &e.response);
    let shear = passed.history.shear;
    let sheared = match input.conditions.impulses {
        true => shear,
        false => scale(0.5, add(h.shear, shear)),
    };
    let mut belt_work = dot(sheared, increment.belt) * area;
    // Overlap that is resolved drives the surfaces apart.
    let [before, now] = increment.times.map(|t| input.offset_at_start(i, t));
    // So does what is worn off, the other way: the bodies come together as it goes.
    let [before, now] = [before - input.state.worn.opened(i), now - e.wear_gap];
    belt_work += 0.5 * (h.pressure + r.traction[0]) * (now - before) * area;
    belt_work += pressed_out(input, i, e) * area;
    let mut damped = 0.0;
    if r.damping != 0.0 || h.damping != 0.0 {
        let closed = if h.normal == [0.0; 3] {
            0.0
        } else {
            h.gap - e.gap
        };
        damped = (0.5 * (h.damping + r.damping) * closed * area).max(0.0);
    }
    let creep = match increment.creeps && r.status == Status::Stick {
        // Not what the spring gives.
        true if input.state.springs => evaluated_path(e, true) / increment.dt,
        true => norm(e.moved) / increment.dt,
        false => 0.0,
    };
    next.energy.uncertain += passed.uncertain * area;
    next.energy.excess += passed.excess * area;
    if input.wears() {
        next.worn
            .deepen(i, passed.worn[0] * passed.covered, e.wear_gap);
    }
    for (total, depth) in next.worn.volume.iter_mut().zip(passed.worn) {
        *total += depth * area;
    }
    next.energy.work += belt_work;
    next.energy.damped += damped;
    next.creep = next.creep.max(creep);
    next.points.push(passed.history);
    passed
}

/// Work per area that multipliers did on the bodies as they pressed out what overlapped when the motion began. A point without mass is taken from
/// one equilibrium to the other, in however short an increment, and one that contact acts on by impulses is stopped there. What else has mass is thrown
/// off the faster, the shorter the increment is: that is no work of the overlap.
fn pressed_out(interface: InterfaceInput, i: usize, e: &Evaluation) -> f64 {
    let Some(&gap) = interface.state.start.overlap.get(i) else {
        return 0.0;
    };
    let light = interface.conditions.inertia.get(i) == Some(&0.0);
    let part = match (interface.conditions.impulses, light) {
        (true, _) => 1.0,
        (false, true) => 0.5,
        (false, false) => return 0.0,
    };
    match gap < 0.0 && e.gap.is_finite() {
        true => part * e.response.traction[0] * (e.gap - gap),
        false => 0.0,
    }
}

/// A point over an increment. `gap`: at its start.
fn pass(
    interface: InterfaceInput,
    i: usize,
    e: &Evaluation,
    gap: f64,
    increment: &Increment,
) -> Passed {
    let h = &interface.state.points[i];
    let Increment { resolved, dt, .. } = *increment;
    let r = &e.response;
    let frictional = interface.laws.friction_law().frictional();
    let shear = e.along(&e.frames.now);
    // At the edge of a mortar a point stands for less and less: forces at the start are those on the area then.
    let part = match resolved && h.area > 0.0 && e.area > 0.0 {
        true => h.area / e.area,
        false => 1.0,
    };
    let limit = match frictional {
        true => r.limit,
        false => 0.0,
    };
    let [dissipated, uncertain, excess] = dissipated(interface, h, e, part, resolved);
    let path = sliding_distance(interface.definition, r, e.frames.before, e.moved);
    let pressed = (0.5 * (h.pressure + r.traction[0]) * path).max(0.0);
    let worn = wear_increment(interface, h, e, pressed, dissipated, dt);
    let taken = (interface.mortar.as_ref()).map_or(0.0, |mortar| mortar.merged.taken(i));
    let whole = (interface.points[i].area + taken) * interface.share;
    let covered = if whole > 0.0 { e.area / whole } else { 0.0 };
    // Slip so far goes along with the surface, as tractions do.
    let dim = interface.dofs.dim;
    let so_far = e.forward(h.slip, h.normal, dim);
    let slid = match r.status {
        Status::Open => [0.0; 3],
        _ => e.forward(e.moved, e.frames.normal_before, dim),
    };
    // The shear of both ends in the directions at the start.
    let [a, b] = e.kept.shear.map(|t| part * t);
    let [e1, e2] = e.frames.before;
    let both = add(add_scaled(scale(a, e1), b, e2), e.along(&e.frames.before));
    // Without damping, which is no part of what is stored.
    let pressures = part * (h.pressure - h.damping) + (r.traction[0] - r.damping);
    let opened = match gap.is_finite() && e.gap.is_finite() {
        true => e.gap - gap,
        false => 0.0,
    };
    Passed {
        dissipated,
        uncertain,
        excess,
        worn,
        covered,
        work: 0.5 * (pressures * opened + dot(both, e.moved)),
        history: PointHistory {
            pressure: r.traction[0],
            shear,
            slip: add(so_far, slid),
            moved: norm(e.moved),
            gap: e.gap,
            normal: e.frames.normal,
            status: r.status,
            facet: e.foot.facet,
            area: e.area,
            damping: r.damping,
            dissipated: h.dissipated + dissipated,
            path: h.path + interface.conditions.cycles() * path,
            spent: h.spent + interface.conditions.cycles() * dissipated,
            limit,
            sheared: sheared(interface.contact, shear, e.stiffness[1]),
            stiffness: e.stiffness,
        },
    }
}

/// Elastic energy per area of the spring by which a point sticks; multipliers that are updated leave nothing in it.
pub(super) fn sheared(interface: ContactView, shear: Vec3, stiffness: f64) -> f64 {
    let updated = matches!(
        interface.laws.enforcement.as_dyn().multipliers(),
        Multipliers::Augmented { .. }
    );
    let springs = match interface.state.springs {
        true if interface.holds_exactly() => false,
        true => interface.laws.tied || interface.laws.friction_law().frictional(),
        false => interface.laws.needs_tangential_stiffness() && !updated,
    };
    match springs && stiffness.is_finite() && stiffness > 0.0 {
        true => 0.5 * dot(shear, shear) / stiffness,
        false => 0.0,
    }
}

/// Energy per area that friction has dissipated over an increment, by how much that may be off, and by how much it exceeds the trapezoidal rule in
/// motion.
///
/// In motion by the trapezoidal rule, like the work of the loads. A quasi-static increment may have any length, and shear may turn
/// round in it, or rise to the limit and stay there. Then the point slides along its shear traction all the time that it slides,
/// at the limit: `∫ limit |ds|`. The limit is taken as growing in proportion to the way, from its value at the start where the
/// point slid already, and from half-way where it stuck, as it is not known when it began to slide.
fn dissipated(
    interface: InterfaceInput,
    h: &PointHistory,
    e: &Evaluation,
    part: f64,
    resolved: bool,
) -> [f64; 3] {
    let r = &e.response;
    // What a spring held is lost where the surfaces part.
    let released = match r.status {
        Status::Open => part * h.sheared,
        _ => 0.0,
    };
    let along = |t: [f64; 2]| -(t[0] * r.sliding_path[0] + t[1] * r.sliding_path[1]);
    let now = along([r.traction[1], r.traction[2]]);
    let mean = match interface.conditions.impulses {
        true => now,
        false => 0.5 * (along(e.kept.shear) + now),
    };
    if resolved && r.status == Status::Open {
        // It may have slid before the surfaces parted.
        return [released, 0.5 * part * h.limit * norm(e.moved), 0.0];
    }
    let slides = resolved && r.status == Status::Slip && r.limit > 0.0;
    if !slides || !interface.laws.slip.as_dyn().sticks() {
        // Friction gives nothing back: where the slip turns round, the scheme took less than it enters.
        let excess = if resolved { 0.0 } else { (-mean).max(0.0) };
        return [mean.max(0.0) + released, 0.0, excess];
    }
    let start = part * h.limit / r.limit;
    let (onset, unknown) = match h.status {
        Status::Slip => (start, 0.0),
        Status::Stick => (0.5 * (1.0 + start), 0.25 * (1.0 - start).abs()),
        // It may have slid before it touched.
        Status::Open => (0.0, 0.5),
    };
    let now = now.max(0.0);
    [0.5 * (1.0 + onset) * now + released, unknown * now, 0.0]
}

/// Gaps of all points at the start of an increment. Where that is not known, as nothing was opposite or nothing had been accepted yet, they are
/// looked up.
fn gaps_before(interface: InterfaceInput, cache: &mut Cache, stage: &Stage) -> Vec<f64> {
    let committed = &interface.state.points;
    let points = cache.last.points.iter().zip(committed);
    let unknown = |(e, h): (&Evaluation, &PointHistory)| {
        h.normal == [0.0; 3] && e.response.traction != [0.0; 3]
    };
    if !points.into_iter().any(unknown) {
        return committed.iter().map(|h| h.gap).collect();
    }
    let start = Stage {
        from: stage.from,
        at: stage.from,
        ..*stage
    };
    let evaluations = evaluate_all(interface, cache, &start, Wants::default());
    let known = interface.state.points.iter().zip(&evaluations.points);
    let gaps = known.map(|(h, e)| match h.normal == [0.0; 3] {
        true => e.known_gap(),
        false => h.gap,
    });
    gaps.collect()
}

/// Forces on the nodes in the last evaluation: those that the bodies resist, gradients of gap and slip and all. Pressure and shear times the
/// weights of the nodes have the same sum, but where the gradient of a gap or slip turns from node to node they are other forces.
fn nodal_forces(interface: &InterfaceDefinition, last: &Evaluations, active: bool) -> Vec<Vec3> {
    let mut forces = vec![[0.0; 3]; interface.nodes.len()];
    for (i, e) in last.points.iter().enumerate().filter(|_| active) {
        let batch = last.batch(i);
        let Some(force) = batch.force(e) else {
            continue;
        };
        // Residuals are internal less external forces.
        for (&(node, _), part) in batch.sides(e).iter().zip(force.chunks(interface.dofs.dim)) {
            for (total, f) in forces[node].iter_mut().zip(part) {
                *total -= f;
            }
        }
    }
    forces
}

/// Enters the work of a moving obstacle: force times shift and moment times angle, by the trapezoidal rule.
fn push(definition: &InterfaceDefinition, next: &mut History, stage: &Stage) {
    let Primary::Rigid(_, motion) = &definition.primary else {
        return;
    };
    let [shift, turn] = motion.way(stage.from.t, stage.at.t);
    let centre = motion.pose(stage.at.t).centre();
    let x = definition.coordinates(&stage.at.u);
    let mut now = [[0.0; 3]; 2];
    for (&force, &x) in next.nodal.iter().zip(&x) {
        now[0] = add(now[0], force);
        now[1] = add(now[1], cross(sub(x, centre), force));
    }
    let before = next.pushed;
    next.pushed = now;
    let mean = [0, 1].map(|k| scale(0.5, add(before[k], now[k])));
    next.energy.work += dot(mean[0], shift) + dot(mean[1], turn);
}

/// Length of the way that the point slid over the increment; a sticking point slides nowhere, a frictionless one all the way it moves.
pub(super) fn evaluated_path(evaluation: &Evaluation, frictional: bool) -> f64 {
    path(
        &evaluation.response,
        frictional,
        evaluation.frames.before,
        evaluation.moved,
    )
}

//! What a cycle of a fretting contact was: forces, displacements, what was dissipated and worn off.
//!
//! The loop of the tangential force `Q` over the displacement `δ` is judged as in fretting tests (see [`fouvry_1995`](crate::references::fouvry_1995)): the energy ratio is the
//! area of the loop over that of the box around it, `A = E_d / (4 δ* Q*)`, with the amplitudes `δ*` and `Q*`.

use super::history::Row;
use crate::assess::view::View;
use crate::body::mass;
use crate::contact::interface::ContactView;
use crate::contact::look;
use crate::math::{Vec3, add_scaled, dot, norm, sub};
use crate::model::cycling::Block;
use crate::model::definition::{Body, Model};
use crate::time::Trial;
use crate::tolerance::SAME;

/// Two vectors between whose components all lie that have been seen.
#[derive(Debug, Clone, Copy, Default, crate::keep::Keep)]
struct Range {
    low: Vec3,
    high: Vec3,
}

impl Range {
    fn at(v: Vec3) -> Self {
        Range { low: v, high: v }
    }

    fn take_in(&mut self, v: Vec3) {
        for (i, x) in v.into_iter().enumerate() {
            self.low[i] = self.low[i].min(x);
            self.high[i] = self.high[i].max(x);
        }
    }

    /// Half of the way from end to end.
    fn amplitude(&self) -> f64 {
        0.5 * norm(sub(self.high, self.low))
    }
}

/// The cycle at hand of an interface.
#[derive(Debug, Clone, Default, crate::keep::Keep)]
pub(crate) struct Loop {
    shear: Range,
    displacement: Range,
    /// Of the last increment.
    last: [Vec3; 2],
    pressed: f64,
    peak: f64,
    /// Largest part of the area in contact that slides at one time.
    sliding: f64,
    /// Dissipated before the cycle, and in all cycles of the step, those that are not computed too `[J]`.
    start: f64,
    sum: f64,
}

/// The part of the volume of its body that lies around each point, where loops are looked at; a mean over a body is a sum with these weights.
pub(crate) fn shares(model: &Model) -> Vec<f64> {
    let mut shares = Vec::new();
    if model.steps.iter().any(|s| s.cycles.is_some()) {
        shares.resize(model.mesh.points.len(), 0.0);
        for body in &model.bodies {
            mass::add_lumped_volume(&body.elastic, &mut shares);
            let own = &mut shares[body.points.clone()];
            let volume: f64 = own.iter().sum();
            own.iter_mut().for_each(|s| *s /= volume);
        }
    }
    shares
}

/// Mean displacement of a body.
fn mean(view: &View, shares: &[f64], body: &Body) -> Vec3 {
    let (dofs, u) = (view.model.dofs, &view.frame.state.u);
    let mut mean = [0.0; 3];
    for point in body.points.clone() {
        let moved = dofs.vector(u, point);
        mean.iter_mut()
            .zip(moved)
            .for_each(|(m, x)| *m += shares[point] * x);
    }
    mean
}

/// How far one body has moved over the other, by their means.
fn displacement(view: &View, shares: &[f64], interface: ContactView) -> Vec3 {
    let (primary, secondary) = interface.nodes.split_at(interface.primary_nodes);
    let of = |nodes: &[usize]| {
        let node = *nodes.first()?;
        let mut bodies = view.model.bodies.iter();
        let body = bodies.find(|b| b.points.contains(&node))?;
        Some(mean(view, shares, body))
    };
    sub(
        of(secondary).unwrap_or_default(),
        of(primary).unwrap_or_default(),
    )
}

/// Takes note of an increment that has been accepted. A row where a cycle ends with it.
pub(crate) fn follow(view: &View, shares: &[f64], loops: &mut [Loop], trial: Trial) -> Option<Row> {
    if shares.is_empty() {
        return None;
    }
    let step = &view.model.steps[view.step_index()];
    let since = [trial.from - step.start, trial.to - step.start];
    let cycles = step.cycles;
    let begins = cycles.is_none_or(|c| c.begins(since[0]));
    for (interface, at) in view.contacts().zip(&mut *loops) {
        if begins {
            at.begin(trial.from <= step.start);
        }
        at.go_on(view, shares, interface);
        if cycles.is_none() {
            at.start = look::energy(interface).dissipated;
        }
    }
    let cycles = cycles.filter(|c| c.ends(since))?;
    let block = cycles.block(since[0], view.frame.block);
    Some(row(view, loops, trial.to, block))
}

impl Loop {
    fn begin(&mut self, step: bool) {
        let [shear, displacement] = self.last;
        *self = Loop {
            shear: Range::at(shear),
            displacement: Range::at(displacement),
            last: self.last,
            start: self.start,
            sum: if step { 0.0 } else { self.sum },
            ..Loop::default()
        };
    }

    fn go_on(&mut self, view: &View, shares: &[f64], interface: ContactView) {
        let force = look::resultant(interface, &view.frame.state.u);
        let displacement = displacement(view, shares, interface);
        // Across the resultant of the pressure: on a curved surface shear has a part along it.
        let along = dot(force.shear, force.normal) / dot(force.normal, force.normal);
        let shear = match along.is_finite() {
            true => add_scaled(force.shear, -along, force.normal),
            false => force.shear,
        };
        self.last = [shear, displacement];
        self.shear.take_in(shear);
        self.displacement.take_in(displacement);
        self.pressed = self.pressed.max(force.total);
        self.peak = self.peak.max(force.peak);
        let [sliding, touching] = look::sliding_area(interface);
        if touching > 0.0 {
            self.sliding = self.sliding.max(sliding / touching);
        }
    }
}

/// The row of a cycle.
fn row(view: &View, loops: &mut [Loop], t: f64, block: Block) -> Row {
    let mut row = Row::default();
    row.push("STEP", view.step_index() as f64 + 1.0);
    row.push("TIME", t);
    row.push("CYCLES", (block.before + block.stands_for) as f64);
    row.push("STANDS", block.stands_for as f64);
    for (interface, at) in view.contacts().zip(loops) {
        let dissipated = look::energy(interface).dissipated;
        let energy = dissipated - at.start;
        at.start = dissipated;
        at.sum += energy * block.stands_for as f64;
        let [force, displacement] = [at.shear.amplitude(), at.displacement.amplitude()];
        let total = 4.0 * force * displacement;
        let condition = match at.sliding {
            // All of the area in contact slides.
            s if s >= 1.0 - SAME => 2.0,
            s if s > 0.0 => 1.0,
            _ => 0.0,
        };
        // Tied surfaces do not rub.
        if interface.laws.tied {
            continue;
        }
        let mut push = |name: &str, value: f64| {
            row.push(format!("{}.{name}", interface.name), value);
        };
        push("ED", energy);
        push("EDSUM", at.sum);
        push("FT", force);
        push("FN", at.pressed);
        push("DELTA", displacement);
        push("RATIO", if total > 0.0 { energy / total } else { 0.0 });
        push("SLIDING", at.sliding);
        push("CONDITION", condition);
        push("CPRESSMAX", at.peak);
        if let Some(wear) = look::wear(interface) {
            push("CWEARVOL", wear.volume[0] + wear.volume[1]);
            push("CWEARMAX", wear.depth[0].max(wear.depth[1]));
        }
    }
    row
}

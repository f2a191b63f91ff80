//! Evaluation of one contact point: pairing, kinematics, response, force and tangent.

use super::cache::Cache;
use super::definition::{Interface, Primary};
use super::evaluation::{Batch, Evaluation, Question, components};
use super::initial::TOUCHING;
use super::pass::Wants;
use super::turning;
use crate::contact::enforcement::Multipliers;
use crate::contact::kinematics::{
    Pair, Stencil, add_average_hessian, add_rigid_hessian, average, carried_over, rigid_stencil,
    tangents,
};
use crate::contact::law::friction::FrictionPoint;
use crate::contact::obstacle::Pose;
use crate::contact::pairing::{Anchor, FACET_NODES, Previous};
use crate::contact::response::{Circumstances, Status, Told};
use crate::contact::surface::Facet;
use crate::math::{
    Mat3, Vec3, add, add_scaled, dot, identity, inverse, mat_vec, norm, normalize, scale, sub,
};
use crate::system::Rate;

/// By how much the first trial traction of an attempt may exceed the limit and count as stick.
const FIRST_SLACK: f64 = 1e-2;

/// Part of the area of a point of a mortar that has to have something opposite for it to take part.
const LEAST_AREA: f64 = 1e-6;

/// Roundings of the largest coordinate that a gap of a mortar may be off.
const ROUNDING: f64 = 32.0;

/// What is wanted of laws that are asked for all points at once, instead of a response.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Asking {
    Nothing,
    Gaps,
    Friction,
}

/// What all points of one evaluation share.
#[derive(Clone, Copy)]
pub(super) struct Scene<'a> {
    /// Coordinates, boxes, integrals and the iterate before.
    pub cache: &'a Cache,
    /// Pose of the obstacle now and at the last accepted state.
    pub poses: Option<&'a (Pose, Pose)>,
    /// Displacement of the belt over the increment, and its velocity at the end times the length of the increment.
    pub belt: Vec3,
    pub belt_end: Vec3,
    pub rate: Option<Rate<'a>>,
    pub dt: f64,
    /// Time at the end of the increment.
    pub t: f64,
    pub wants: Wants,
    /// What laws that are asked for all points at once have said, by point; empty where none is asked so.
    pub told: &'a [Told],
    pub asking: Asking,
}

impl Scene<'_> {
    /// Way of the belt as friction sees it.
    fn belt_seen(&self) -> Vec3 {
        match self.rate {
            Some(_) => self.belt_end,
            None => self.belt,
        }
    }
}

/// The positive semi-definite part of a symmetric 2×2 matrix given as `[a11, a22, a12]`.
fn positive_part([a, b, c]: [f64; 3]) -> [f64; 3] {
    let mean = 0.5 * (a + b);
    let radius = (0.5 * (a - b)).hypot(c);
    let (high, low) = (mean + radius, mean - radius);
    if low >= 0.0 {
        return [a, b, c];
    }
    if high <= 0.0 {
        return [0.0; 3];
    }
    // high · v vᵀ with v vᵀ = (A - low I) / (high - low)
    let s = high / (high - low);
    [s * (a - low), s * (b - low), s * c]
}

impl Interface {
    /// `last`: this point at the evaluation before, in this attempt.
    pub(super) fn evaluate(
        &self,
        i: usize,
        scene: &Scene,
        last: Option<&Evaluation>,
        anchor: &mut Option<Anchor>,
        batch: &mut Batch,
    ) -> Evaluation {
        let unglued = self
            .history
            .start
            .glued
            .get(i)
            .is_some_and(|gap| gap.is_nan());
        if unglued || self.directives.asleep.get(i) == Some(&true) {
            return Evaluation::open(f64::INFINITY);
        }
        match &self.primary {
            Primary::Rigid(..) => self.evaluate_rigid(i, scene, batch),
            Primary::Facets(_) if self.mortar.is_some() => self.evaluate_mortar(i, scene, batch),
            Primary::Facets(facets) => self.evaluate_facet(i, facets, scene, last, anchor, batch),
        }
    }

    fn evaluate_facet(
        &self,
        i: usize,
        facets: &[Facet],
        scene: &Scene,
        last: Option<&Evaluation>,
        anchor: &mut Option<Anchor>,
        batch: &mut Batch,
    ) -> Evaluation {
        let point = &self.points[i];
        let frozen = self.kinematics.as_dyn().frozen();
        let mut position = point.position(&scene.cache.x);
        let mut position_before = point.position(&scene.cache.before);
        let found = if frozen {
            scene.cache.frozen[i].ok_or(f64::INFINITY)
        } else {
            let previous = last.and_then(|e| e.facet);
            let previous = previous.or(self.history.points[i].facet);
            // The projection starts from that at the last accepted state, not from that of the last iteration: what comes out must not
            // depend on the way to it.
            let near = previous.and_then(|f| {
                let foot = Anchor::at(anchor, f, &facets[f], &scene.cache.before, position_before);
                foot.map(|foot| foot.xi)
            });
            let cache = scene.cache;
            let previous = Previous {
                facet: previous,
                near,
            };
            self.closest(i, (&cache.x, &cache.boxes), &cache.search, previous)
        };
        // At an outer edge there may be no solution with the point on it and none with it off: after the second time it stays
        // off until the rest has settled, and if it leaves twice again until the next increment.
        let found = match found {
            Ok((_, p)) if self.attempt.flips[i].left >= 2 => {
                let away = sub(position, p.x);
                return Evaluation {
                    stranded: dot(away, p.normal) < 0.0,
                    ..Evaluation::open(norm(away))
                };
            }
            found => found,
        };
        let (f, foot) = match found {
            Ok(found) => found,
            Err(distance) => return Evaluation::open(distance),
        };
        let facet = &facets[f];
        let mut now = [[0.0; 3]; FACET_NODES];
        let now = facet.gather(&scene.cache.x, &mut now);
        let anchor = if frozen {
            // relative to the material place of the frozen foot
            let mut then = [[0.0; 3]; FACET_NODES];
            let then = facet.gather(&scene.cache.before, &mut then);
            let place = |nodes: &[Vec3]| {
                nodes
                    .iter()
                    .zip(&foot.n)
                    .fold([0.0; 3], |s, (&x, &n)| add_scaled(s, n, x))
            };
            position = add(foot.x, sub(position, place(now)));
            position_before = add(foot.x, sub(position_before, place(then)));
            &foot
        } else {
            match Anchor::at(anchor, f, facet, &scene.cache.before, position_before) {
                Some(anchor) => anchor,
                None => return Evaluation::open(dot(sub(position, foot.x), foot.normal)),
            }
        };
        let pair = Pair {
            dim: self.dofs.dim,
            weights: &point.weights,
            point: position,
            kind: facet.kind,
            facet: now,
            foot: &foot,
            anchor,
            point_before: position_before,
            belt: scene.belt_seen(),
        };
        let kinematics = self.kinematics.as_dyn();
        kinematics.stencil(&pair, &mut batch.stencil);
        let reach = now.iter().map(|&x| dot(x, x));
        batch.stencil.reach = reach.fold(dot(position, position), f64::max).sqrt();
        let sides = batch.sides.len();
        let own = point
            .nodes
            .iter()
            .copied()
            .zip(point.weights.iter().copied());
        batch.sides.extend(own);
        let theirs = facet.nodes.iter().copied().zip(foot.n.iter().map(|n| -n));
        batch.sides.extend(theirs);
        let mut e = self.respond(i, point.area, sides, scene, batch);
        e.facet = Some(f);
        self.finish(scene, &mut e, batch, |stencil, weights, out| {
            let curved = kinematics.curved();
            if curved {
                kinematics.add_hessian(&pair, stencil, weights, out);
            }
            curved
        });
        e
    }

    fn evaluate_rigid(&self, i: usize, scene: &Scene, batch: &mut Batch) -> Evaluation {
        let (Primary::Rigid(shape, _), Some(poses)) = (&self.primary, scene.poses) else {
            return Evaluation::open(f64::INFINITY);
        };
        let point = &self.points[i];
        let (x, before) = (
            point.position(&scene.cache.x),
            point.position(&scene.cache.before),
        );
        let dim = self.dofs.dim;
        let Some(feet) = rigid_stencil(
            shape.as_dyn(),
            (&poses.0, &poses.1),
            point,
            (x, before),
            scene.belt_seen(),
            dim,
            &mut batch.stencil,
        ) else {
            return Evaluation::open(f64::INFINITY);
        };
        // One with several nodes has the mean of their gaps.
        let mean = point.nodes.len() > 1;
        let shape_now = (shape.as_dyn(), &poses.0);
        if mean
            && average(
                shape_now.0,
                shape_now.1,
                point,
                &scene.cache.x,
                dim,
                &mut batch.stencil,
            )
            .is_none()
        {
            return Evaluation::open(f64::INFINITY);
        }
        // A curved obstacle measures the gap from its centre.
        batch.stencil.reach = norm(x) + 2.0 * shape.as_dyn().radius().abs();
        let sides = batch.sides.len();
        let own = point
            .nodes
            .iter()
            .copied()
            .zip(point.weights.iter().copied());
        batch.sides.extend(own);
        let mut e = self.respond(i, point.area, sides, scene, batch);
        self.finish(scene, &mut e, batch, |_, weights, out| {
            let [normal, t1, t2] = weights;
            let (shape, pose) = shape_now;
            if !mean {
                return add_rigid_hessian(pose, point, &feet, dim, weights, out);
            }
            let along = [0.0, t1, t2];
            let slips = add_rigid_hessian(pose, point, &feet, dim, along, out);
            add_average_hessian(shape, pose, point, &scene.cache.x, dim, normal, out) || slips
        });
        e
    }

    /// A point of a mortar: sums over the faces around it.
    fn evaluate_mortar(&self, i: usize, scene: &Scene, batch: &mut Batch) -> Evaluation {
        let (Some(mortar), true) = (&self.mortar, !scene.cache.integrals.is_empty()) else {
            return Evaluation::open(f64::INFINITY);
        };
        let point = &self.points[i];
        let dim = self.dofs.dim;
        let (mut area, mut gap, mut normal) = (0.0, 0.0, [0.0; 3]);
        let sides = batch.sides.len();
        batch.gradients.clear();
        // The node itself first.
        for &node in &point.nodes {
            batch.gradients.push([0.0; 3]);
            batch.sides.push((node, 0.0));
        }
        let around = &mortar.around[i];
        let whole: f64 = around
            .iter()
            .map(|&(f, a)| scene.cache.integrals[f].area[a])
            .sum();
        // What is left of weights that cancel is rounding.
        let least = 1e-13 * whole;
        for &(f, a) in around {
            let face = &scene.cache.integrals[f];
            area += face.area[a];
            gap += face.gap[a];
            let own = &mortar.faces[f].nodes;
            let secondary = face.secondary.chunks_exact(own.len()).nth(a).unwrap_or(&[]);
            let primary = match face.nodes.len() {
                0 => &[],
                n => &face.primary[a * n..(a + 1) * n],
            };
            let entries = (own.iter().zip(secondary).map(|(n, e)| (n, e, 1.0)))
                .chain(face.nodes.iter().zip(primary).map(|(n, e)| (n, e, -1.0)));
            for (&node, entry, sign) in entries {
                if entry.weight.abs() <= least && norm(entry.gradient) <= least {
                    continue;
                }
                // So few that looking through them is faster than a map.
                let known = batch.sides[sides..].iter().position(|s| s.0 == node);
                let k = known.unwrap_or_else(|| {
                    batch.gradients.push([0.0; 3]);
                    batch.sides.push((node, 0.0));
                    batch.gradients.len() - 1
                });
                batch.sides[sides + k].1 += sign * entry.weight;
                batch.gradients[k] = add_scaled(batch.gradients[k], sign, entry.gradient);
                if sign > 0.0 {
                    normal = add(normal, entry.gradient);
                }
            }
        }
        if area <= LEAST_AREA * point.area {
            batch.sides.truncate(sides);
            return Evaluation::open(f64::INFINITY);
        }
        // Facets seen at an angle make the mean gradient longer than a unit vector: the gap is measured along the mean normal, and a pressure
        // acts on the area along it.
        let per_area = 1.0 / area;
        let length = norm(normal) * per_area;
        if length.is_nan() || length <= 0.0 {
            batch.sides.truncate(sides);
            return Evaluation::open(f64::INFINITY);
        }
        gap *= per_area / length;
        let n = batch.gradients.len() * dim;
        batch.stencil.reset(n);
        let mut reach: f64 = 0.0;
        for ((_, weight), gradient) in batch.sides[sides..].iter_mut().zip(&mut batch.gradients) {
            *weight *= per_area;
            *gradient = scale(per_area / length, *gradient);
        }
        let frozen = self.kinematics.as_dyn().frozen();
        let normal = normalize(normal).unwrap_or(normal);
        let frame = tangents(normal, dim);
        let (own, other) = if frozen {
            (identity(), identity())
        } else {
            self.turned(i, scene)
        };
        // What was carried before is carried on by the point as it turns, and from there to where the surface is met now.
        let before = &self.history.points[i];
        let normal_before = match frozen || before.normal == [0.0; 3] {
            true => turning::back(&own, normal),
            false => before.normal,
        };
        let carried = mat_vec(&own, normal_before);
        let stencil = &mut batch.stencil;
        let (mut moved, mut arm) = ([0.0; 3], [0.0; 3]);
        for (k, (&(node, w), gradient)) in batch.sides[sides..]
            .iter()
            .zip(&batch.gradients)
            .enumerate()
        {
            let x = scene.cache.x[node];
            moved = add_scaled(moved, w, sub(x, scene.cache.before[node]));
            arm = add_scaled(arm, w, scene.cache.before[node]);
            reach = reach.max(dot(x, x));
            if frozen {
                gap += dot(*gradient, sub(x, self.reference[node]));
            }
            for c in 0..dim {
                stencil.rows[0][k * dim + c] = gradient[c];
                for (t, e) in frame.iter().enumerate().take(dim - 1) {
                    stencil.rows[t + 1][k * dim + c] = w * e[c];
                }
            }
        }
        if !frozen {
            // The distance of the two sides turns with them, but for that which is no gap.
            let glued = self.history.start.glued.get(i).copied().unwrap_or(0.0);
            let apart = glued + self.offset(i, scene.t);
            let arm = add_scaled(arm, -apart, normal_before);
            moved = turning::slid(sub(moved, turning::swung(&own, arm)), &own, &other);
        }
        stencil.slip = frame.map(|e| dot(e, moved));
        if dim == 2 {
            stencil.slip[1] = 0.0;
        }
        // Surfaces that just touch must not be in contact or apart by the rounding of the integrals.
        let rounding = ROUNDING * f64::EPSILON * (reach.sqrt() + norm(self.origin));
        if self.attempt.untouched && gap.abs() <= rounding {
            gap = 0.0;
        }
        stencil.gap = gap;
        stencil.normal = normal;
        stencil.frame = frame;
        stencil.frame_before = frame.map(|e| turning::back(&own, carried_over(e, normal, carried)));
        stencil.normal_before = normal_before;
        stencil.reach = reach.sqrt();
        let mut e = self.respond(i, self.share * area, sides, scene, batch);
        self.finish(scene, &mut e, batch, |_, _, _| false);
        e
    }

    /// How the surfaces have turned since the last accepted state: the faces around a point of a mortar, and what lies opposite.
    fn turned(&self, i: usize, scene: &Scene) -> (Mat3, Mat3) {
        let (Some(mortar), Primary::Facets(facets)) = (&self.mortar, &self.primary) else {
            return (identity(), identity());
        };
        let (at, dim) = (
            (scene.cache.x.as_slice(), scene.cache.before.as_slice()),
            self.dofs.dim,
        );
        let around = mortar.around[i].iter().map(|&(f, _)| f);
        let other = around
            .flat_map(|f| &scene.cache.integrals[f].pieces)
            .map(|piece| {
                let facet = &facets[piece.facet];
                (&facet.nodes[..facet.kind.corner_count()], piece.area)
            });
        (
            turning::rotation_of(self.faces_around(i), at, dim),
            turning::rotation_of(other, at, dim),
        )
    }

    /// Closing velocity over the increment; zero for a point that had no gap before.
    fn closing(&self, i: usize, gap: f64, dt: f64) -> f64 {
        let before = &self.history.points[i];
        if before.normal == [0.0; 3] || !before.gap.is_finite() {
            return 0.0;
        }
        (before.gap - gap) / dt
    }

    /// Gap that counts as none.
    ///
    /// A constraint that is met to a tolerance leaves a gap, which multipliers would go on to correct in every increment to come. Where supports hold the
    /// point in it, that has no end: pressure would grow without anything that asks for it. What the tolerance has accepted is accepted for
    /// as long as the point is in contact.
    fn rest(&self, i: usize) -> f64 {
        if !self.unknown() {
            return self.history.rest.get(i).copied().unwrap_or(0.0);
        }
        let before = &self.history.points[i];
        match before.status {
            Status::Open => 0.0,
            _ => before
                .gap
                .clamp(-self.attempt.accepted, self.attempt.accepted),
        }
    }

    /// Laws at the stencil of the batch, of a point that stands for `area` and whose nodes are those from `sides` on.
    fn respond(
        &self,
        i: usize,
        area: f64,
        sides: usize,
        scene: &Scene,
        batch: &mut Batch,
    ) -> Evaluation {
        let dim = self.dofs.dim;
        let point = &self.points[i];
        if let Some(glued) = self.history.start.glued.get(i) {
            batch.stencil.gap -= glued;
        }
        batch.stencil.gap -= self.offset(i, scene.t);
        let stencil = &batch.stencil;
        let first = batch.dofs.len();
        for &(node, _) in &batch.sides[sides..] {
            for c in 0..dim {
                batch.dofs.push(self.dofs.of(self.nodes[node], c));
            }
        }
        let unknown = self.unknown();
        let enforcement = self.laws.enforcement.as_dyn();
        // Multipliers are exact in the end: how fast they get there depends on all that resists, inertia included. What springs do
        // must not depend on the increment.
        let own = match enforcement.multipliers() {
            Multipliers::Augmented { .. } => self.own_stiffness(i, scene.rate.map(|_| scene.dt)),
            _ => point.stiffness,
        };
        let normal_stiffness = if self.laws.needs_normal_stiffness() {
            self.spring(enforcement.normal(), own)
        } else {
            f64::INFINITY
        };
        let tangential_stiffness = if self.laws.needs_tangential_stiffness() {
            self.spring(enforcement.tangential(), own)
        } else {
            f64::INFINITY
        };
        let multiplier = &self.attempt.multipliers[i];
        // Softened, stick yields like a few cells of the body instead of as stiffly as it should.
        let soft = self.directives.softening.map(|factor| factor * own);
        let tangential_stiffness = tangential_stiffness.min(soft.unwrap_or(f64::INFINITY));
        // Where the surface was met before it may have had another normal.
        let in_frame = |shear: Vec3, normal: Vec3| {
            let there = match normal == [0.0; 3] {
                true => shear,
                false => carried_over(shear, normal, stencil.normal_before),
            };
            components(there, &stencil.frame_before, dim)
        };
        let before = &self.history.points[i];
        let shear = in_frame(multiplier.shear, multiplier.normal);
        let carried = in_frame(before.shear, before.normal);
        let centre = match enforcement.multipliers() {
            Multipliers::Augmented { .. } => {
                let t = in_frame(multiplier.centre_shear, multiplier.centre_normal);
                [multiplier.centre_pressure, t[0], t[1]]
            }
            _ => [0.0, carried[0], carried[1]],
        };
        let belt = stencil.frame.map(|e| dot(e, scene.belt));
        let slid = [stencil.slip[0] - belt[0], stencil.slip[1] - belt[1]];
        let at = Circumstances {
            dt: scene.dt,
            normal_stiffness,
            tangential_stiffness,
            multiplier: [multiplier.pressure, shear[0], shear[1]],
            centre,
            carried,
            slack: if scene.wants.tangent && self.attempt.flips[i].last[0].is_none() {
                FIRST_SLACK
            } else {
                0.0
            },
            softness: soft.map_or(0.0, |soft| 1.0 / soft),
            weight: own.min(normal_stiffness).min(tangential_stiffness),
            touching: if self.attempt.untouched && stencil.gap <= TOUCHING * point.size {
                point.stiffness
            } else {
                0.0
            },
            slip: slid,
            path: None,
            unknown,
            rest: self.rest(i),
            sticking: self.history.points[i].status != Status::Slip,
            closing: self.closing(i, stencil.gap, scene.dt),
            held: self.attempt.freezing.held(i, &stencil.frame_before, dim),
            mobilised: self.directives.mobilised.unwrap_or(1.0),
            told: scene.told.get(i).copied().unwrap_or_default(),
        };
        for row in &mut batch.rated {
            row.clear();
        }
        let at = match scene.rate {
            Some(rate) => {
                let nodes = batch.sides[sides..].iter().map(|(node, _)| node);
                let dofs = &batch.dofs[first..];
                let seen = rate_slip(stencil, nodes, dofs, scene, rate, dim, &mut batch.rated);
                let belt = stencil.frame.map(|e| dot(e, scene.belt_end));
                Circumstances {
                    slip: [seen[0] - belt[0], seen[1] - belt[1]],
                    path: Some(slid),
                    ..at
                }
            }
            None => at,
        };
        let friction = match scene.asking {
            Asking::Nothing => None,
            Asking::Gaps => Some(FrictionPoint::default()),
            Asking::Friction => self.laws.question(stencil, &at),
        };
        if scene.asking != Asking::Nothing {
            batch.questions.extend(friction.map(|friction| Question {
                point: i,
                gap: stencil.gap - at.rest,
                friction,
            }));
            return Evaluation::default();
        }
        let response = self.laws.respond(stencil, &at);
        Evaluation {
            n: batch.dofs.len() - first,
            dofs: first,
            response,
            gap: stencil.gap,
            normal: stencil.normal,
            frame: stencil.frame,
            frame_before: stencil.frame_before,
            normal_before: stencil.normal_before,
            moved: add_scaled(
                scale(slid[0], stencil.frame_before[0]),
                slid[1],
                stencil.frame_before[1],
            ),
            normal_stiffness,
            tangential_stiffness,
            multiplier: at.multiplier,
            carried: at.carried,
            over: true,
            area,
            nodes: batch.sides.len() - sides,
            sides,
            ..Evaluation::default()
        }
    }

    /// Residual and tangent from stencil and response. `hessian` adds second derivatives with these weights, or says that there are none.
    fn finish(
        &self,
        scene: &Scene,
        e: &mut Evaluation,
        batch: &mut Batch,
        hessian: impl FnOnce(&Stencil, [f64; 3], &mut [f64]) -> bool,
    ) {
        let r = &e.response;
        let unknown = self.unknown() && !scene.wants.initial;
        let traction = if unknown { e.multiplier } else { r.traction };
        let stencil = &batch.stencil;
        let (n, area) = (stencil.n, e.area);
        if traction == [0.0; 3] && r.traction == [0.0; 3] && r.d_gap == [[0.0; 3]; 3] {
            return;
        }
        let rows = stencil.rows.each_ref().map(|row| &row[..n]);
        e.force = Some(batch.force.len());
        batch.force.extend((0..n).map(|k| {
            -area * (traction[0] * rows[0][k] + traction[1] * rows[1][k] + traction[2] * rows[2][k])
        }));
        // What rounding of coordinates of this size leaves of the force.
        let slope = r
            .d_gap
            .iter()
            .flatten()
            .fold(0.0_f64, |m, d| m.max(d.abs()));
        e.rounding = 4.0 * f64::EPSILON * stencil.reach * slope * area;
        // K_ll = I - ∂T/∂Σ is 1/ω times the weight in contact, and the unit matrix where open: never singular for a finite ω.
        let k_ll_inverse = (unknown && scene.wants.tangent).then(|| {
            let k_ll: Mat3 = std::array::from_fn(|i| {
                std::array::from_fn(|j| (if i == j { 1.0 } else { 0.0 }) - r.d_multiplier[i][j])
            });
            inverse(&k_ll).map_or(identity(), |(m, _)| m)
        });
        if unknown {
            // The multiplier rows `Σ - T(gap, Σ) = 0`; in contact and stick they are the paper's `G - Σ/ω = 0`, up to a factor.
            let rest: [f64; 3] = std::array::from_fn(|q| e.multiplier[q] - r.traction[q]);
            let shift = k_ll_inverse.map_or([0.0; 3], |k| k.map(|k| dot(k, rest)));
            e.saddle = Some((rest, shift));
        }
        if !scene.wants.tangent {
            return;
        }
        let first = batch.rows.len();
        e.rows = Some(first);
        for row in rows {
            batch.rows.extend_from_slice(row);
        }
        // -d_gap · B (- the skew), shape (3, n); with multipliers as unknowns, what remains after their elimination is K_ll⁻¹ times as stiff.
        let seen: [&[f64]; 3] = if !batch.rated[0].is_empty() {
            [rows[0], &batch.rated[0][..n], &batch.rated[1][..n]]
        } else if !stencil.slip_rows[0].is_empty() {
            [
                rows[0],
                &stencil.slip_rows[0][..n],
                &stencil.slip_rows[1][..n],
            ]
        } else {
            rows
        };
        let (d, d_skew) = match &k_ll_inverse {
            Some(k) => (condensed_slope(k, &r.d_gap), k.map(|k| dot(k, r.d_skew))),
            None => (r.d_gap, r.d_skew),
        };
        for (d, d_skew) in d.iter().zip(d_skew) {
            let start = batch.change.len();
            batch.change.extend(
                (0..n).map(|k| -(d[0] * seen[0][k] + d[1] * seen[1][k] + d[2] * seen[2][k])),
            );
            if d_skew != 0.0 {
                for (c, skew) in batch.change[start..].iter_mut().zip(&stencil.skew_row) {
                    *c -= d_skew * skew;
                }
            }
        }
        if traction != [0.0; 3] {
            let start = batch.hessian.len();
            batch.hessian.resize(start + n * n, 0.0);
            let weights = traction.map(|t| -area * t);
            if hessian(stencil, weights, &mut batch.hessian[start..]) {
                e.hessian = Some(start);
            } else {
                batch.hessian.truncate(start);
            }
        }
        if scene.wants.surrogate {
            let start = batch.surrogate.len();
            e.surrogate = Some(start);
            batch.surrogate.resize(start + n * n, 0.0);
            // Friction that looks at velocities is stiffer by the gain.
            let gain = stencil_gain(stencil, &batch.rated);
            let out = &mut batch.surrogate[start..];
            surrogate(&d, gain, area, rows, out);
        }
    }
}

/// A symmetric positive semi-definite matrix close to `-Bᵀ d B` times the area, for the preconditioner.
fn surrogate(d: &Mat3, gain: f64, area: f64, rows: [&[f64]; 3], out: &mut [f64]) {
    let [t11, t22, t12] =
        positive_part([-d[1][1], -d[2][2], -0.5 * (d[1][2] + d[2][1])]).map(|t| gain * t);
    let normal = (-d[0][0]).max(0.0);
    let n = rows[0].len();
    for (k, out) in out.chunks_exact_mut(n).enumerate() {
        let left = [
            area * normal * rows[0][k],
            area * (t11 * rows[1][k] + t12 * rows[2][k]),
            area * (t12 * rows[1][k] + t22 * rows[2][k]),
        ];
        for (l, out) in out.iter_mut().enumerate() {
            *out = left[0] * rows[0][l] + left[1] * rows[1][l] + left[2] * rows[2][l];
        }
    }
}

/// The slip as friction sees it, `dt v` along the frame, and its gradients: `s + Σ row ((gain - 1) Δu + shift)`.
fn rate_slip<'a>(
    stencil: &Stencil,
    nodes: impl Iterator<Item = &'a usize>,
    dofs: &[usize],
    scene: &Scene,
    rate: Rate,
    dim: usize,
    rows: &mut [Vec<f64>; 2],
) -> [f64; 2] {
    let mut slip = stencil.slip;
    let mut k = 0;
    for &node in nodes {
        let (x, before) = (scene.cache.x[node], scene.cache.before[node]);
        for (x, before) in x.iter().zip(before).take(dim) {
            let dof = dofs[k];
            for i in 0..2 {
                let r = stencil.rows[i + 1][k];
                slip[i] += r * ((rate.gain[dof] - 1.0) * (x - before) + rate.shift[dof]);
                let own = stencil.slip_rows[i].get(k).copied().unwrap_or(r);
                rows[i].push(own + r * (rate.gain[dof] - 1.0));
            }
            k += 1;
        }
    }
    slip
}

/// The largest ratio of what friction sees of a displacement to the slip it is.
fn stencil_gain(stencil: &Stencil, rated: &[Vec<f64>; 2]) -> f64 {
    let pairs = (0..2).flat_map(|i| stencil.rows[i + 1].iter().zip(&rated[i]));
    let ratio = pairs
        .filter(|(row, _)| **row != 0.0)
        .map(|(row, seen)| seen / row);
    let largest = ratio.fold(0.0_f64, f64::max);
    if largest > 0.0 { largest } else { 1.0 }
}

/// `K_ll⁻¹ ∂T/∂gap`: the slope of the multipliers after their elimination.
fn condensed_slope(inverse: &Mat3, d_gap: &Mat3) -> Mat3 {
    inverse.map(|row| {
        std::array::from_fn(|j| row[0] * d_gap[0][j] + row[1] * d_gap[1][j] + row[2] * d_gap[2][j])
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_positive_part_is_a_projection() {
        assert_eq!(positive_part([2.0, 1.0, 0.5]), [2.0, 1.0, 0.5]);
        assert_eq!(positive_part([-2.0, -1.0, 0.5]), [0.0; 3]);
        let [a, b, c] = positive_part([1.0, -1.0, 0.0]);
        assert!((a - 1.0).abs() < 1e-15 && b.abs() < 1e-15 && c == 0.0);
    }
}

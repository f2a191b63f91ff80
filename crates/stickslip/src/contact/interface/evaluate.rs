//! Evaluation of one contact point: pairing, kinematics, response, force and tangent.

use super::{Interface, Primary, turning};
use crate::contact::enforcement::Multipliers;
use crate::contact::kinematics::{
    Pair, Stencil, add_average_hessian, add_rigid_hessian, average, carried_over, rigid_stencil,
    tangents,
};
use crate::contact::law::friction::FrictionPoint;
use crate::contact::mortar::FaceIntegral;
use crate::contact::obstacle::Pose;
use crate::contact::pairing::{
    FACET_NODES, FacetPoint, beyond, facet_distance, project, project_near,
};
use crate::contact::response::{Circumstances, Response, Status, Told};
use crate::contact::search::Box3;
use crate::contact::surface::Facet;
use crate::math::{
    Mat3, Vec3, add, add_scaled, cross, dot, identity, inverse, mat_vec, norm, normalize, scale,
    sub,
};
use crate::system::{Rate, Tangent};

/// By how much the first trial traction of an attempt may exceed the limit and count as stick.
const FIRST_SLACK: f64 = 1e-2;

/// How far beyond a facet, relative to its size, a point may be and stay on it while the surface is flat.
const KEPT: f64 = 1e-3;

/// Distances from facets, relative to their size, and cosines that are equal but for rounding.
const TIE: f64 = 1e-9;

/// One minus the cosine of the angle between facets that make a flat surface. Together with `KEPT` it bounds the error of the gap to
/// some 1e-6 of the facet.
const FLAT: f64 = 1e-5;

/// Part of the area of a point of a mortar that has to have something opposite for it to take part.
const LEAST_AREA: f64 = 1e-6;

/// Roundings of the largest coordinate that a gap of a mortar may be off.
const ROUNDING: f64 = 32.0;

/// Gap relative to the cell beneath up to which a point counts as touching at the very start.
pub(super) const TOUCHING: f64 = 1e-6;

/// What is wanted of laws that are asked for all points at once, instead of a response.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Asking {
    Nothing,
    Gaps,
    Friction,
}

/// What a law is asked at a point.
#[derive(Debug, Clone, Copy)]
pub(super) struct Question {
    pub point: usize,
    pub gap: f64,
    pub friction: FrictionPoint,
}

/// What all points of one evaluation share.
#[derive(Clone, Copy)]
pub(super) struct Scene<'a> {
    pub x: &'a [Vec3],
    pub before: &'a [Vec3],
    /// Boxes around the facets; empty where they are not looked for.
    pub boxes: &'a [Box3],
    /// Integrals over the faces of a mortar; empty without one.
    pub integrals: &'a [FaceIntegral],
    /// Pose of the obstacle now and at the last accepted state.
    pub poses: Option<&'a (Pose, Pose)>,
    /// Displacement of the belt over the increment, and its velocity at the end times the length of the increment.
    pub belt: Vec3,
    pub belt_end: Vec3,
    pub rate: Option<Rate<'a>>,
    pub dt: f64,
    /// Time at the end of the increment.
    pub t: f64,
    /// Tractions are those of the laws, not of multipliers: what acts before anything has been solved.
    pub initial: bool,
    pub tangent: bool,
    pub surrogate: bool,
    /// What such laws have said, by point; empty where none is asked so.
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

/// The outcome at one point. What has a size of its own lies in a [`Batch`].
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Evaluation {
    /// Number of dofs, zero where there is no force, and where they start.
    n: usize,
    dofs: usize,
    /// Where force, `3 × n` gradients and changes, and matrices start, where there are such.
    force: Option<usize>,
    rows: Option<usize>,
    hessian: Option<usize>,
    surrogate: Option<usize>,
    /// Where multipliers are unknowns: the residual of their rows, and after a tangent evaluation `K_ll⁻¹` times that.
    pub saddle: Option<([f64; 3], [f64; 3])>,
    /// Force that rounding may leave.
    pub rounding: f64,
    pub response: Response,
    pub gap: f64,
    pub normal: Vec3,
    /// Directions of the shear traction now, and at the last accepted state, in which multipliers are kept.
    pub frame: [Vec3; 2],
    pub frame_before: [Vec3; 2],
    /// Unit normal to the directions at the last accepted state.
    pub normal_before: Vec3,
    /// Relative slip since the last accepted state, belt included, along the frame of that state.
    pub moved: Vec3,
    pub facet: Option<usize>,
    /// It stays off the outer edge of the primary, but lies beneath its surface.
    pub stranded: bool,
    /// Whether something lies opposite.
    pub over: bool,
    /// Area that the point stands for.
    pub area: f64,
    /// Number of nodes that take part, and where their weights start.
    nodes: usize,
    sides: usize,
    pub normal_stiffness: f64,
    pub tangential_stiffness: f64,
    /// Shear traction at the last accepted state, in the frame.
    pub carried: [f64; 2],
    /// Multipliers as components in the frame, where they are unknowns.
    pub multiplier: [f64; 3],
}

impl Evaluation {
    /// A point that carries nothing.
    pub fn open(gap: f64) -> Self {
        Evaluation {
            gap,
            ..Evaluation::default()
        }
    }
}

/// Numbers of the points of one chunk, one point after the other, and room to work in. The memory is used again by the next evaluation.
#[derive(Debug, Clone, Default)]
pub(super) struct Batch {
    dofs: Vec<usize>,
    /// Nodes and their weights in gap and slip: positive on the secondary, negative on the primary.
    sides: Vec<(usize, f64)>,
    force: Vec<f64>,
    /// Gradients of gap and slip and how the tractions along them change, multipliers eliminated; `(3, n)` a point.
    rows: Vec<f64>,
    change: Vec<f64>,
    hessian: Vec<f64>,
    surrogate: Vec<f64>,
    stencil: Stencil,
    /// Gradients of the slip as friction sees it; empty where they are those of the slip.
    rated: [Vec<f64>; 2],
    /// The gradient of the gap of a mortar's point by node.
    gradients: Vec<Vec3>,
    /// What laws are to be asked for all points at once.
    pub questions: Vec<Question>,
}

impl Batch {
    pub fn clear(&mut self) {
        self.questions.clear();
        self.dofs.clear();
        self.sides.clear();
        self.force.clear();
        self.rows.clear();
        self.change.clear();
        self.hessian.clear();
        self.surrogate.clear();
    }

    /// Dofs of a point; none where there is no force.
    pub fn dofs(&self, e: &Evaluation) -> &[usize] {
        &self.dofs[e.dofs..e.dofs + e.n]
    }

    /// Nodes that take part and their weights: positive on the secondary, negative on the primary.
    pub fn sides(&self, e: &Evaluation) -> &[(usize, f64)] {
        &self.sides[e.sides..e.sides + e.nodes]
    }

    /// Force on them; `None` where a point carries nothing.
    pub fn force(&self, e: &Evaluation) -> Option<&[f64]> {
        e.force.map(|start| &self.force[start..start + e.n])
    }

    /// What a tangent evaluation leaves for the assembler.
    pub fn tangent(&self, e: &Evaluation) -> Option<Tangent<'_>> {
        let start = e.rows?;
        let matrix = |all: &'_ [f64], start: Option<usize>| -> std::ops::Range<usize> {
            start.map_or(all.len()..all.len(), |s| s..s + e.n * e.n)
        };
        Some(Tangent {
            rows: &self.rows[start..start + 3 * e.n],
            change: &self.change[start..start + 3 * e.n],
            area: e.area,
            hessian: &self.hessian[matrix(&self.hessian, e.hessian)],
            surrogate: &self.surrogate[matrix(&self.surrogate, e.surrogate)],
        })
    }
}

/// The projection of a point on a facet at the last accepted state. It is kept from one evaluation to the next with the coordinates that it
/// follows from.
#[derive(Debug, Clone)]
pub(super) struct Anchor {
    facet: usize,
    point: Vec3,
    nodes: [Vec3; FACET_NODES],
    foot: Option<FacetPoint>,
}

impl Anchor {
    /// The projection, made anew if `kept` is another one.
    fn at<'a>(
        kept: &'a mut Option<Anchor>,
        f: usize,
        facet: &Facet,
        before: &[Vec3],
        point: Vec3,
    ) -> Option<&'a FacetPoint> {
        let mut nodes = [[0.0; 3]; FACET_NODES];
        let then = gather(facet, before, &mut nodes);
        let same = matches!(kept, Some(k) if k.facet == f && k.point == point
            && k.nodes[..then.len()] == *then);
        if !same {
            let foot = project(facet.kind, then, point);
            *kept = Some(Anchor {
                facet: f,
                point,
                nodes,
                foot,
            });
        }
        kept.as_ref()?.foot.as_ref()
    }
}

/// Coordinates of the nodes of a facet.
#[inline]
fn gather<'a>(facet: &Facet, x: &[Vec3], out: &'a mut [Vec3; FACET_NODES]) -> &'a [Vec3] {
    for (c, &n) in out.iter_mut().zip(&facet.nodes) {
        *c = x[n];
    }
    &out[..facet.nodes.len()]
}

/// A point over one of its candidates.
struct Look {
    p: FacetPoint,
    /// A length of the facet, for tolerances.
    size: f64,
    away: f64,
    beyond: f64,
    carried: bool,
}

/// Components `c` with `v ≈ c₁ e₁ + c₂ e₂`, for directions that need not be orthogonal.
pub(super) fn components(v: Vec3, e: &[Vec3; 2], dim: usize) -> [f64; 2] {
    let g11 = dot(e[0], e[0]);
    let b1 = dot(v, e[0]);
    if dim == 2 {
        return [b1 / g11, 0.0];
    }
    let (g12, g22, b2) = (dot(e[0], e[1]), dot(e[1], e[1]), dot(v, e[1]));
    let det = g11 * g22 - g12 * g12;
    if det == 0.0 {
        return [0.0; 2];
    }
    [(g22 * b1 - g12 * b2) / det, (g11 * b2 - g12 * b1) / det]
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
    /// A length of a facet, for tolerances.
    fn facet_size(facet: &Facet, p: &FacetPoint) -> f64 {
        match facet.kind.dim() {
            1 => 2.0 * norm(p.a[0]),
            _ => norm(cross(p.a[0], p.a[1])).sqrt(),
        }
    }

    /// Normal out of the secondary at a point.
    fn outward(&self, i: usize) -> Vec3 {
        let turned = self.memory.facing.get(i).copied();
        turned.unwrap_or(self.points[i].normal)
    }

    /// A point at `position` over a facet; `None` if it has no projection there, or if the two do not face each other.
    fn look(
        &self,
        facet: &Facet,
        x: &[Vec3],
        (i, position): (usize, Vec3),
        near: Option<[f64; 2]>,
    ) -> Option<Look> {
        let mut nodes = [[0.0; 3]; FACET_NODES];
        let nodes = gather(facet, x, &mut nodes);
        let p = match near {
            Some(xi) => project_near(facet.kind, nodes, position, xi)?,
            None => project(facet.kind, nodes, position)?,
        };
        if dot(p.normal, self.outward(i)) >= 0.0 {
            return None;
        }
        let size = Self::facet_size(facet, &p);
        let over = beyond(facet.kind, nodes, &p);
        // A facet is extended for points near its edge. Behind the plane of a distant one lie points that no facet nearby faces, such as
        // those on the far side of a ball.
        let behind = dot(sub(position, p.x), p.normal) < 0.0;
        let extended = facet.continues[over.edge] && !(behind && over.distance > size);
        Some(Look {
            p,
            size,
            away: facet_distance(position, &p, over),
            beyond: over.distance,
            carried: over.distance <= self.edge_tolerance * size || extended,
        })
    }

    /// The facet a point belongs to and its projection there; the distance to the surface if it belongs to none.
    ///
    /// The nearest facet wins; between equally near ones the one it was on, `previous`, where its projection was at `near`. Beyond an edge
    /// where the surface goes on the facet is extended, so that a point in a re-entrant corner is not lost; beyond an outer edge the
    /// point is free.
    pub(super) fn closest(
        &self,
        i: usize,
        x: &[Vec3],
        boxes: &[Box3],
        previous: Option<usize>,
        near: Option<[f64; 2]>,
    ) -> Result<(usize, FacetPoint), f64> {
        let Primary::Facets(facets) = &self.primary else {
            return Err(f64::INFINITY);
        };
        let point = &self.points[i];
        let position = point.position(x);
        let candidates = &self.memory.candidates[i];
        let box_distance2 = |f: usize| boxes[f].distance2(position);
        // The likely one first: facets that cannot be as near need not be projected on.
        let first = previous.filter(|f| candidates.binary_search(f).is_ok());
        let first = first.or_else(|| {
            let nearest = candidates.iter().map(|&f| (box_distance2(f), f));
            nearest.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, f)| f)
        });
        let Some(first) = first else {
            return Err(f64::INFINITY);
        };
        let near = near.filter(|_| previous == Some(first));
        let mut seed = self.look(&facets[first], x, (i, position), near);
        let mut nearest = seed.as_ref().map_or(f64::INFINITY, |look| look.away);
        let mut best: Option<(usize, Look)> = None;
        let mut kept: Option<FacetPoint> = None;
        for &f in candidates {
            let look = if f == first {
                seed.take()
            } else {
                // Beyond a facet `away` is the distance to a place of it, at least that to its box. The summand leaves room for ties.
                let limit = 1.5 * (nearest + 1e-8 * self.memory.margin);
                if box_distance2(f) > limit * limit {
                    continue;
                }
                self.look(&facets[f], x, (i, position), None)
            };
            let Some(look) = look else {
                continue;
            };
            nearest = nearest.min(look.away);
            if previous == Some(f) && look.carried && look.beyond <= KEPT * look.size {
                kept = Some(look.p);
            }
            let better = match &best {
                None => true,
                Some((b, held)) => {
                    // Distances equal but for rounding: an edge both facets share.
                    let tie = (look.away - held.away).abs() <= TIE * look.size;
                    match (look.carried, held.carried, tie) {
                        (true, false, true) => true,
                        (false, true, true) => false,
                        (_, _, true) if previous == Some(f) || previous == Some(*b) => {
                            previous == Some(f)
                        }
                        (_, _, true) => self.precedes((f, &look), (*b, held), i),
                        _ => look.away < held.away,
                    }
                }
            };
            if better {
                best = Some((f, look));
            }
        }
        match (best, kept, previous) {
            // Where the surface is flat the facet makes no difference: staying on it keeps Newton from going to and fro.
            (Some((_, look)), Some(k), Some(f))
                if look.carried && dot(look.p.normal, k.normal) > 1.0 - FLAT =>
            {
                Ok((f, k))
            }
            (Some((f, look)), ..) if look.carried => Ok((f, look.p)),
            _ => Err(nearest),
        }
    }

    /// Which of two facets that are equally near a point is its own, whatever their numbers: the one that looks at it more, or, where they look alike, the one
    /// whose middle comes first in the reference configuration.
    fn precedes(&self, a: (usize, &Look), b: (usize, &Look), i: usize) -> bool {
        let Primary::Facets(facets) = &self.primary else {
            return false;
        };
        let outward = self.outward(i);
        let facing = |look: &Look| dot(look.p.normal, outward);
        let apart = facing(a.1) - facing(b.1);
        if apart.abs() > TIE {
            return apart < 0.0;
        }
        let middle = |f: usize| {
            let nodes = &facets[f].nodes;
            let sum = nodes
                .iter()
                .fold([0.0; 3], |s, &n| add(s, self.reference[n]));
            scale(1.0 / nodes.len() as f64, sum)
        };
        let first = sub(middle(a.0), middle(b.0));
        let tie = TIE.sqrt() * a.1.size;
        first
            .iter()
            .find(|d| d.abs() > tie)
            .is_some_and(|d| *d < 0.0)
    }

    /// `last`: this point at the evaluation before, in this attempt.
    pub(super) fn evaluate(
        &self,
        i: usize,
        scene: &Scene,
        last: Option<&Evaluation>,
        anchor: &mut Option<Anchor>,
        batch: &mut Batch,
    ) -> Evaluation {
        let unglued = self.memory.glued.get(i).is_some_and(|gap| gap.is_nan());
        if unglued || self.memory.asleep.get(i) == Some(&true) {
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
        let mut position = point.position(scene.x);
        let mut position_before = point.position(scene.before);
        let found = if frozen {
            self.memory.frozen[i].ok_or(f64::INFINITY)
        } else {
            let previous = last.and_then(|e| e.facet);
            let previous = previous.or(self.memory.committed[i].facet);
            // The projection starts from that at the last accepted state, not from that of the last iteration: what comes out must not
            // depend on the way to it.
            let near = previous.and_then(|f| {
                let foot = Anchor::at(anchor, f, &facets[f], scene.before, position_before);
                foot.map(|foot| foot.xi)
            });
            self.closest(i, scene.x, scene.boxes, previous, near)
        };
        // At an outer edge there may be no solution with the point on it and none with it off: after the second time it stays
        // off until the rest has settled, and if it leaves twice again until the next increment.
        let found = match found {
            Ok((_, p)) if self.memory.flips[i].left >= 2 => {
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
        let now = gather(facet, scene.x, &mut now);
        let anchor = if frozen {
            // relative to the material place of the frozen foot
            let mut then = [[0.0; 3]; FACET_NODES];
            let then = gather(facet, scene.before, &mut then);
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
            match Anchor::at(anchor, f, facet, scene.before, position_before) {
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
        let (x, before) = (point.position(scene.x), point.position(scene.before));
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
                scene.x,
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
            add_average_hessian(shape, pose, point, scene.x, dim, normal, out) || slips
        });
        e
    }

    /// A point of a mortar: sums over the faces around it.
    fn evaluate_mortar(&self, i: usize, scene: &Scene, batch: &mut Batch) -> Evaluation {
        let (Some(mortar), true) = (&self.mortar, !scene.integrals.is_empty()) else {
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
            .map(|&(f, a)| scene.integrals[f].area[a])
            .sum();
        // What is left of weights that cancel is rounding.
        let least = 1e-13 * whole;
        for &(f, a) in around {
            let face = &scene.integrals[f];
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
        let before = &self.memory.committed[i];
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
            let x = scene.x[node];
            moved = add_scaled(moved, w, sub(x, scene.before[node]));
            arm = add_scaled(arm, w, scene.before[node]);
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
            let glued = self.memory.glued.get(i).copied().unwrap_or(0.0);
            let apart = glued + self.initial.offset(i, scene.t);
            let arm = add_scaled(arm, -apart, normal_before);
            moved = turning::slid(sub(moved, turning::swung(&own, arm)), &own, &other);
        }
        stencil.slip = frame.map(|e| dot(e, moved));
        if dim == 2 {
            stencil.slip[1] = 0.0;
        }
        // Surfaces that just touch must not be in contact or apart by the rounding of the integrals.
        let rounding = ROUNDING * f64::EPSILON * (reach.sqrt() + norm(self.origin));
        if self.memory.untouched && gap.abs() <= rounding {
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
        let (at, dim) = ((scene.x, scene.before), self.dofs.dim);
        let around = mortar.around[i].iter().map(|&(f, _)| f);
        let other = around
            .flat_map(|f| &scene.integrals[f].pieces)
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
        let before = &self.memory.committed[i];
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
            return self.memory.rest.get(i).copied().unwrap_or(0.0);
        }
        let before = &self.memory.committed[i];
        match before.status {
            Status::Open => 0.0,
            _ => before
                .gap
                .clamp(-self.memory.accepted, self.memory.accepted),
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
        if let Some(glued) = self.memory.glued.get(i) {
            batch.stencil.gap -= glued;
        }
        batch.stencil.gap -= self.initial.offset(i, scene.t);
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
        let multiplier = &self.memory.multipliers[i];
        // Softened, stick yields like a few cells of the body instead of as stiffly as it should.
        let soft = self.memory.softening.map(|factor| factor * own);
        let tangential_stiffness = tangential_stiffness.min(soft.unwrap_or(f64::INFINITY));
        // Where the surface was met before it may have had another normal.
        let in_frame = |shear: Vec3, normal: Vec3| {
            let there = match normal == [0.0; 3] {
                true => shear,
                false => carried_over(shear, normal, stencil.normal_before),
            };
            components(there, &stencil.frame_before, dim)
        };
        let before = &self.memory.committed[i];
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
            slack: if scene.tangent && self.memory.flips[i].last[0].is_none() {
                FIRST_SLACK
            } else {
                0.0
            },
            softness: soft.map_or(0.0, |soft| 1.0 / soft),
            weight: own.min(normal_stiffness).min(tangential_stiffness),
            touching: if self.memory.untouched && stencil.gap <= TOUCHING * point.size {
                point.stiffness
            } else {
                0.0
            },
            slip: slid,
            path: None,
            unknown,
            rest: self.rest(i),
            sticking: self.memory.committed[i].status != Status::Slip,
            closing: self.closing(i, stencil.gap, scene.dt),
            held: self.held(i, &stencil.frame_before, dim),
            mobilised: self.memory.mobilised.unwrap_or(1.0),
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
        let unknown = self.unknown() && !scene.initial;
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
        let k_ll_inverse = (unknown && scene.tangent).then(|| {
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
        if !scene.tangent {
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
        if scene.surrogate {
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
        let (x, before) = (scene.x[node], scene.before[node]);
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

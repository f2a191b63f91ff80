//! Evaluation of one contact point: pairing, kinematics, response, force and tangent.

use super::{Interface, Primary, SaddleRows};
use crate::contact::enforcement::Multipliers;
use crate::contact::kinematics::{Pair, Stencil, add_rigid_hessian, rigid_stencil};
use crate::contact::obstacle::Pose;
use crate::contact::pairing::{FacetPoint, beyond, facet_distance, project};
use crate::contact::response::{Circumstances, Response, Status};
use crate::contact::surface::Facet;
use crate::math::{Mat3, Vec3, add, add_scaled, cross, dot, identity, inverse, norm, scale, sub};
use crate::system::Rate;

/// By how much the first trial traction of an attempt may exceed the limit and count as stick.
const FIRST_SLACK: f64 = 1e-2;

/// How far beyond a facet, relative to its size, a point may be and stay on it while the surface is flat.
const KEPT: f64 = 1e-3;

/// One minus the cosine of the angle between facets that make a flat surface. Together with `KEPT` it bounds the error of the gap to
/// some 1e-6 of the facet.
const FLAT: f64 = 1e-5;

/// Gap relative to the cell beneath up to which a point counts as touching at the very start.
const TOUCHING: f64 = 1e-6;

/// What all points of one evaluation share.
pub(super) struct Scene<'a> {
    pub x: &'a [Vec3],
    pub before: &'a [Vec3],
    /// Pose of the obstacle now and at the last accepted state.
    pub poses: Option<&'a (Pose, Pose)>,
    /// Displacement of the belt over the increment, and its velocity at the end times the length of the increment.
    pub belt: Vec3,
    pub belt_end: Vec3,
    pub rate: Option<Rate<'a>>,
    pub dt: f64,
    /// Tractions are those of the laws, not of multipliers: what acts before anything has been solved.
    pub initial: bool,
    pub tangent: bool,
}

/// The outcome at one point.
#[derive(Debug, Clone, Default)]
pub(super) struct Evaluation {
    /// Global dofs; empty where there is no force.
    pub dofs: Vec<usize>,
    pub residual: Vec<f64>,
    pub tangent: Vec<f64>,
    pub surrogate: Vec<f64>,
    /// Gradients of gap and slip and how the forces along them change, shape `(3, n)` each.
    pub rows: Vec<f64>,
    pub change: Vec<f64>,
    pub saddle: Option<SaddleRows>,
    /// Force that rounding may leave.
    pub rounding: f64,
    pub response: Response,
    pub gap: f64,
    pub normal: Vec3,
    /// Directions of the shear traction now, and at the last accepted state, in which multipliers are kept.
    pub frame: [Vec3; 2],
    pub frame_before: [Vec3; 2],
    /// Relative slip since the last accepted state, in space, belt included.
    pub moved: Vec3,
    pub facet: Option<usize>,
    /// Facet weights, for output on the primary side.
    pub facet_weights: Vec<(usize, f64)>,
    pub normal_stiffness: f64,
    pub tangential_stiffness: f64,
    /// Shear traction at the last accepted state, in the frame.
    pub carried: [f64; 2],
    /// Multipliers as components in the frame, where they are unknowns.
    pub multiplier: [f64; 3],
    /// Gradients of the slip as friction sees it; empty where they are those of the slip.
    pub rated: [Vec<f64>; 2],
}

/// Components `c` with `v ≈ c₁ e₁ + c₂ e₂`, for directions that need not be orthogonal.
fn components(v: Vec3, e: &[Vec3; 2], dim: usize) -> [f64; 2] {
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

    /// The facet a point belongs to and its projection there; the distance to the surface if it belongs to none.
    ///
    /// The nearest facet wins; between equally near ones the one it was on. Beyond an edge where the surface goes on the facet is
    /// extended, so that a point in a re-entrant corner is not lost; beyond an outer edge the point is free.
    pub(super) fn closest(
        &self,
        i: usize,
        x: &[Vec3],
        previous: Option<usize>,
    ) -> Result<(usize, FacetPoint), f64> {
        let Primary::Facets(facets) = &self.primary else {
            return Err(f64::INFINITY);
        };
        let point = &self.points[i];
        let position = point.position(x);
        let mut best: Option<(f64, usize, FacetPoint, bool)> = None;
        let mut nearest = f64::INFINITY;
        let mut kept: Option<FacetPoint> = None;
        let mut nodes = [[0.0; 3]; crate::contact::pairing::FACET_NODES];
        for &f in &self.memory.candidates[i] {
            let facet = &facets[f];
            for (c, &n) in nodes.iter_mut().zip(&facet.nodes) {
                *c = x[n];
            }
            let nodes = &nodes[..facet.nodes.len()];
            let Some(p) = project(facet.kind, nodes, position) else {
                continue;
            };
            if dot(p.normal, point.normal) >= 0.0 {
                continue;
            }
            let size = Self::facet_size(facet, &p);
            let over = beyond(facet.kind, nodes, &p);
            let away = facet_distance(position, &p, over);
            nearest = nearest.min(away);
            let carried = over.distance <= self.edge_tolerance * size || facet.continues[over.edge];
            if previous == Some(f) && carried && over.distance <= KEPT * size {
                kept = Some(p);
            }
            let better = match &best {
                None => true,
                Some((d, b, _, was_carried)) => {
                    // Distances equal but for rounding: an edge both facets share.
                    let tie = (away - d).abs() <= 1e-9 * size;
                    match (carried, was_carried, tie) {
                        (true, false, true) => true,
                        (false, true, true) => false,
                        (_, _, true) => previous == Some(f) && previous != Some(*b),
                        _ => away < *d,
                    }
                }
            };
            if better {
                best = Some((away, f, p, carried));
            }
        }
        match (best, kept, previous) {
            // Where the surface is flat the facet makes no difference: staying on it keeps Newton from going to and fro.
            (Some((_, _, p, true)), Some(k), Some(f)) if dot(p.normal, k.normal) > 1.0 - FLAT => {
                Ok((f, k))
            }
            (Some((_, f, p, true)), ..) => Ok((f, p)),
            _ => Err(nearest),
        }
    }

    pub(super) fn evaluate(&self, i: usize, scene: &Scene) -> Evaluation {
        match &self.primary {
            Primary::Rigid(..) => self.evaluate_rigid(i, scene),
            Primary::Facets(facets) => self.evaluate_facet(i, facets, scene),
        }
    }

    fn evaluate_facet(&self, i: usize, facets: &[Facet], scene: &Scene) -> Evaluation {
        let point = &self.points[i];
        let frozen = self.kinematics.as_dyn().frozen();
        let found = if frozen {
            self.memory.frozen[i].ok_or(f64::INFINITY)
        } else {
            let previous = self.memory.last.get(i).and_then(|e| e.facet);
            let previous = previous.or(self.memory.committed[i].facet);
            self.closest(i, scene.x, previous)
        };
        // At an outer edge there may be no solution with the point on it and none with it off: after the second time it stays
        // off until the next increment.
        let found = match found {
            Ok((_, p)) if self.memory.flips[i].left >= 2 => {
                Err(norm(sub(point.position(scene.x), p.x)))
            }
            found => found,
        };
        let (f, foot) = match found {
            Ok(found) => found,
            Err(distance) => return Evaluation::open(distance),
        };
        let facet = &facets[f];
        let at = |x: &[Vec3]| -> Vec<Vec3> { facet.nodes.iter().map(|&n| x[n]).collect() };
        let (now, then) = (at(scene.x), at(scene.before));
        let mut position = point.position(scene.x);
        let mut position_before = point.position(scene.before);
        let anchor = if frozen {
            // relative to the material place of the frozen foot
            let place = |nodes: &[Vec3]| {
                nodes
                    .iter()
                    .zip(&foot.n)
                    .fold([0.0; 3], |s, (&x, &n)| add_scaled(s, n, x))
            };
            position = add(foot.x, sub(position, place(&now)));
            position_before = add(foot.x, sub(position_before, place(&then)));
            foot
        } else {
            match project(facet.kind, &then, position_before) {
                Some(anchor) => anchor,
                None => return Evaluation::open(dot(sub(position, foot.x), foot.normal)),
            }
        };
        let pair = Pair {
            dim: self.dofs.dim,
            weights: &point.weights,
            point: position,
            kind: facet.kind,
            facet: &now,
            foot: &foot,
            anchor: &anchor,
            point_before: position_before,
        };
        let kinematics = self.kinematics.as_dyn();
        let mut stencil = Stencil::default();
        kinematics.stencil(&pair, &mut stencil);
        stencil.reach = now.iter().map(|&x| norm(x)).fold(norm(position), f64::max);
        let nodes = point.nodes.iter().chain(&facet.nodes);
        let mut e = self.respond(i, &stencil, nodes, scene);
        e.facet = Some(f);
        e.facet_weights = facet
            .nodes
            .iter()
            .copied()
            .zip(foot.n[..facet.nodes.len()].iter().copied())
            .collect();
        self.finish(i, &stencil, scene, &mut e, |weights, out| {
            kinematics.add_hessian(&pair, &stencil, weights, out);
        });
        e
    }

    fn evaluate_rigid(&self, i: usize, scene: &Scene) -> Evaluation {
        let (Primary::Rigid(shape, _), Some(poses)) = (&self.primary, scene.poses) else {
            return Evaluation::open(f64::INFINITY);
        };
        let point = &self.points[i];
        let (x, before) = (point.position(scene.x), point.position(scene.before));
        let dim = self.dofs.dim;
        let mut stencil = Stencil::default();
        let Some(feet) = rigid_stencil(
            shape.as_dyn(),
            (&poses.0, &poses.1),
            point,
            (x, before),
            dim,
            &mut stencil,
        ) else {
            return Evaluation::open(f64::INFINITY);
        };
        // A curved obstacle measures the gap from its centre.
        let curvature = feet[0].curvature.iter().flatten();
        let curvature = curvature.fold(0.0_f64, |m, c| m.max(c.abs()));
        let radius = if curvature > 0.0 {
            1.0 / curvature
        } else {
            0.0
        };
        stencil.reach = norm(x) + 2.0 * radius;
        let mut e = self.respond(i, &stencil, point.nodes.iter(), scene);
        self.finish(i, &stencil, scene, &mut e, |weights, out| {
            add_rigid_hessian(shape.as_dyn(), &poses.0, point, x, &feet, dim, weights, out);
        });
        e
    }

    /// Closing velocity over the increment; zero for a point that had no gap before.
    fn closing(&self, i: usize, gap: f64, dt: f64) -> f64 {
        let before = &self.memory.committed[i];
        if before.normal == [0.0; 3] || !before.gap.is_finite() {
            return 0.0;
        }
        (before.gap - gap) / dt
    }

    /// Laws at a stencil.
    fn respond<'a>(
        &self,
        i: usize,
        stencil: &Stencil,
        nodes: impl Iterator<Item = &'a usize>,
        scene: &Scene,
    ) -> Evaluation {
        let dim = self.dofs.dim;
        let point = &self.points[i];
        let nodes: Vec<usize> = nodes.copied().collect();
        let dofs: Vec<usize> = nodes
            .iter()
            .flat_map(|&node| (0..dim).map(move |c| (node, c)))
            .map(|(node, c)| self.dofs.of(self.nodes[node], c))
            .collect();
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
        let shear = components(multiplier.shear, &stencil.frame_before, dim);
        let carried = components(self.memory.committed[i].shear, &stencil.frame_before, dim);
        let centre = match enforcement.multipliers() {
            Multipliers::Augmented { .. } => {
                let t = components(multiplier.centre_shear, &stencil.frame_before, dim);
                [multiplier.centre_pressure, t[0], t[1]]
            }
            _ => [0.0, carried[0], carried[1]],
        };
        let belt = stencil.frame_before.map(|e| dot(e, scene.belt));
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
            rest: self.memory.rest.get(i).copied().unwrap_or(0.0),
            sticking: self.memory.committed[i].status != Status::Slip,
            closing: self.closing(i, stencil.gap, scene.dt),
        };
        let mut rated = [Vec::new(), Vec::new()];
        let at = match scene.rate {
            Some(rate) => {
                let (seen, rows) = rate_slip(stencil, &nodes, &dofs, scene, rate);
                rated = rows;
                let belt = stencil.frame_before.map(|e| dot(e, scene.belt_end));
                Circumstances {
                    slip: [seen[0] - belt[0], seen[1] - belt[1]],
                    path: Some(slid),
                    ..at
                }
            }
            None => at,
        };
        let response = self.laws.respond(stencil, &at);
        Evaluation {
            dofs,
            rated,
            response,
            gap: stencil.gap,
            normal: stencil.normal,
            frame: stencil.frame,
            frame_before: stencil.frame_before,
            moved: add_scaled(
                scale(slid[0], stencil.frame_before[0]),
                slid[1],
                stencil.frame_before[1],
            ),
            normal_stiffness,
            tangential_stiffness,
            multiplier: at.multiplier,
            carried: at.carried,
            ..Evaluation::default()
        }
    }

    /// Residual and tangent from stencil and response.
    fn finish(
        &self,
        i: usize,
        stencil: &Stencil,
        scene: &Scene,
        e: &mut Evaluation,
        hessian: impl FnOnce([f64; 3], &mut [f64]),
    ) {
        let r = &e.response;
        let unknown = self.unknown() && !scene.initial;
        let traction = if unknown { e.multiplier } else { r.traction };
        let (n, area) = (stencil.n, self.points[i].area);
        if traction == [0.0; 3] && r.traction == [0.0; 3] && r.d_gap == [[0.0; 3]; 3] {
            return;
        }
        e.residual = (0..n)
            .map(|k| {
                -area
                    * (0..3)
                        .map(|q| traction[q] * stencil.rows[q][k])
                        .sum::<f64>()
            })
            .collect();
        // What rounding of coordinates of this size leaves of the force.
        let slope = r
            .d_gap
            .iter()
            .flatten()
            .fold(0.0_f64, |m, d| m.max(d.abs()));
        e.rounding = 4.0 * f64::EPSILON * stencil.reach * slope * area;
        let rows = &stencil.rows;
        // d_gap · B (+ the skew), shape (3, n)
        let seen: [&[f64]; 3] = if e.rated[0].is_empty() {
            [&rows[0], &rows[1], &rows[2]]
        } else {
            [&rows[0], &e.rated[0], &e.rated[1]]
        };
        let change = |q: usize, k: usize| -> f64 {
            let mut c: f64 = (0..3).map(|p| r.d_gap[q][p] * seen[p][k]).sum();
            if !stencil.skew_row.is_empty() {
                c += r.d_skew[q] * stencil.skew_row[k];
            }
            c
        };
        if unknown {
            e.saddle = Some(saddle(r, e.multiplier, area, rows, n, change));
        }
        if !scene.tangent {
            return;
        }
        e.rows = rows.concat();
        e.change = (0..3)
            .flat_map(|q| (0..n).map(move |k| (q, k)))
            .map(|(q, k)| match &e.saddle {
                None => -area * change(q, k),
                Some(s) => {
                    let inverse = &s.k_ll_inverse[3 * q..3 * q + 3];
                    let sum: f64 = (0..3).map(|p| inverse[p] * s.k_lu[p * n + k]).sum();
                    area * sum
                }
            })
            .collect();
        let mut tangent = vec![0.0; n * n];
        hessian(traction.map(|t| -area * t), &mut tangent);
        if !unknown {
            for k in 0..n {
                for (q, row) in rows.iter().enumerate() {
                    let row = -area * row[k];
                    if row != 0.0 {
                        for l in 0..n {
                            tangent[k * n + l] += row * change(q, l);
                        }
                    }
                }
            }
        }
        // With multipliers as unknowns, what remains after their elimination is K_ll⁻¹ times as stiff.
        let condensed = e
            .saddle
            .as_ref()
            .map(|s| condensed_slope(&s.k_ll_inverse, &r.d_gap));
        let d = condensed.as_ref().unwrap_or(&r.d_gap);
        // Friction that looks at velocities is stiffer by the gain.
        let gain = stencil_gain(stencil, &e.rated);
        let [t11, t22, t12] =
            positive_part([-d[1][1], -d[2][2], -0.5 * (d[1][2] + d[2][1])]).map(|t| gain * t);
        let normal = (-d[0][0]).max(0.0);
        let mut surrogate = vec![0.0; n * n];
        for k in 0..n {
            let left = [
                area * normal * rows[0][k],
                area * (t11 * rows[1][k] + t12 * rows[2][k]),
                area * (t12 * rows[1][k] + t22 * rows[2][k]),
            ];
            for l in 0..n {
                surrogate[k * n + l] =
                    left[0] * rows[0][l] + left[1] * rows[1][l] + left[2] * rows[2][l];
            }
        }
        e.tangent = tangent;
        e.surrogate = surrogate;
    }
}

/// The slip as friction sees it, `dt v` along the frame, and its gradients: `s + Σ row ((gain - 1) Δu + shift)`.
fn rate_slip(
    stencil: &Stencil,
    nodes: &[usize],
    dofs: &[usize],
    scene: &Scene,
    rate: Rate,
) -> ([f64; 2], [Vec<f64>; 2]) {
    let dim = dofs.len() / nodes.len();
    let mut slip = stencil.slip;
    let rows = [0, 1].map(|i| {
        let row = &stencil.rows[i + 1];
        row.iter()
            .zip(dofs)
            .enumerate()
            .map(|(k, (&r, &dof))| {
                let node = nodes[k / dim];
                let moved = scene.x[node][k % dim] - scene.before[node][k % dim];
                slip[i] += r * ((rate.gain[dof] - 1.0) * moved + rate.shift[dof]);
                r * rate.gain[dof]
            })
            .collect()
    });
    (slip, rows)
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
fn condensed_slope(inverse: &[f64], d_gap: &Mat3) -> Mat3 {
    std::array::from_fn(|i| {
        std::array::from_fn(|j| (0..3).map(|k| inverse[3 * i + k] * d_gap[k][j]).sum())
    })
}

/// The multiplier rows `Σ - T(gap, Σ) = 0`; in contact and stick they are the paper's `G - Σ/ω = 0`, up to a
/// factor.
fn saddle(
    r: &Response,
    multiplier: [f64; 3],
    area: f64,
    rows: &[Vec<f64>; 3],
    n: usize,
    change: impl Fn(usize, usize) -> f64,
) -> SaddleRows {
    let mut k_ul = vec![0.0; n * 3];
    let mut k_lu = vec![0.0; 3 * n];
    for k in 0..n {
        for q in 0..3 {
            k_ul[k * 3 + q] = -area * rows[q][k];
            k_lu[q * n + k] = -change(q, k);
        }
    }
    // K_ll = I - ∂T/∂Σ
    let k_ll: Mat3 = std::array::from_fn(|i| {
        std::array::from_fn(|j| (if i == j { 1.0 } else { 0.0 }) - r.d_multiplier[i][j])
    });
    // It is 1/ω times the weight in contact, and the unit matrix where open: never singular for a finite ω.
    let inverse = inverse(&k_ll).map_or(identity(), |(m, _)| m);
    SaddleRows {
        k_ul,
        k_lu,
        k_ll_inverse: inverse.concat(),
        r_l: (0..3).map(|q| multiplier[q] - r.traction[q]).collect(),
    }
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

//! Gap and slip of a point of a mortar: means over the faces around it.

use super::moment::{self, NodeSums};
use super::rigid::{carried_over, tangents};
use super::stencil::Stencil;
use super::turning;
use crate::contact::mortar::{FaceIntegral, Mortar};
use crate::contact::symmetry::Across;
use crate::math::{
    Mat3, Vec3, add, add_scaled, dot, identity, mat_vec, norm, normalize, scale, sub,
};

/// Part of the weights around a point below which one that is left of a sum is rounding.
const NO_WEIGHT: f64 = 1e-13;

/// Sums over the faces around a point, which are means once they are divided by the area.
#[derive(Debug, Clone, Copy, Default)]
pub struct Gathered {
    /// Area that has something opposite `[m²]`.
    pub area: f64,
    /// Gap times area.
    pub gap: f64,
    /// Sum of the gradients of the gap on the side of the secondary.
    pub normal: Vec3,
}

/// Adds up what faces have integrated for point `i`, which hangs on `own` nodes: `nodes` and their weights, its own first, and what else they have in the `parts`.
pub fn gather(
    mortar: &Mortar,
    integrals: &[FaceIntegral],
    i: usize,
    own: &[usize],
    across: Across,
    nodes: &mut Vec<(usize, f64)>,
    parts: &mut Vec<NodeSums>,
) -> Gathered {
    let mut sums = Gathered::default();
    let first = nodes.len();
    parts.clear();
    parts.resize(own.len(), NodeSums::default());
    nodes.extend(own.iter().map(|&node| (node, 0.0)));
    let mut enter = |node: usize, weight: f64, part: NodeSums| {
        // So few that looking through them is faster than a map.
        let known = nodes[first..].iter().position(|s| s.0 == node);
        let k = known.unwrap_or_else(|| {
            parts.push(NodeSums::default());
            nodes.push((node, 0.0));
            parts.len() - 1
        });
        nodes[first + k].1 += weight;
        let sum = &mut parts[k];
        sum.gradient = add(sum.gradient, part.gradient);
        sum.lever = add(sum.lever, part.lever);
        sum.reach += part.reach;
    };
    let around = &mortar.around[i];
    let whole: f64 = around.iter().map(|&(f, a)| integrals[f].area[a]).sum();
    let least = NO_WEIGHT * whole;
    for &(f, a) in around {
        let face = &integrals[f];
        sums.area += face.area[a];
        sums.gap += face.gap[a];
        let own = &mortar.faces[f].nodes;
        let secondary = face.secondary.chunks_exact(own.len()).nth(a).unwrap_or(&[]);
        for (&node, entry) in own.iter().zip(secondary) {
            if entry.weight.abs() <= least && norm(entry.gradient) <= least {
                continue;
            }
            sums.normal = add(sums.normal, entry.gradient);
            let part = NodeSums {
                gradient: entry.gradient,
                ..NodeSums::default()
            };
            enter(node, entry.weight, part);
        }
        let count = face.nodes.len();
        for (k, &node) in face.nodes.iter().enumerate() {
            if face.reach[k] == 0.0 {
                continue;
            }
            let entry = &face.primary[a * count + k];
            let part = NodeSums {
                gradient: scale(-1.0, entry.gradient),
                lever: face.levers[a * count + k],
                reach: face.reach[k],
            };
            enter(node, -entry.weight, part);
        }
    }
    sums.normal = across.within(sums.normal);
    sums
}

impl Gathered {
    /// Length of the mean gradient. Facets seen at an angle make it longer than a unit vector: the gap is measured along the mean normal, and a pressure acts on
    /// the area along it. `None` where there is none.
    pub fn length(&self) -> Option<f64> {
        let length = norm(self.normal) * (1.0 / self.area);
        (length > 0.0).then_some(length)
    }
}

/// What was at the last accepted state, and how the surfaces have turned since.
#[derive(Debug, Clone, Copy)]
pub struct Carried {
    /// Rotation of the faces around the point, and of what lies opposite.
    pub turns: [Mat3; 2],
    /// The normal; zero where there was none.
    pub normal: Vec3,
}

/// A point whose sums are known.
#[derive(Debug, Clone, Copy)]
pub struct MeanPoint<'a> {
    /// 2 or 3.
    pub dim: usize,
    /// Coordinates of all nodes now, at the last accepted state and in the reference configuration.
    pub x: &'a [Vec3],
    /// At the last accepted state.
    pub before: &'a [Vec3],
    /// In the reference configuration.
    pub reference: &'a [Vec3],
    /// Size of what coordinates were taken off, which rounding knows of `[m]`.
    pub origin: f64,
    /// What was; `None` if pairs and normals are those of the reference configuration.
    pub carried: Option<Carried>,
    /// Sums are those of the last accepted state, and turn with the secondary from there.
    pub held: bool,
    /// What its normal, slip and turn do not have.
    pub across: Across,
    /// Nothing has been in contact yet: surfaces that just touch must not be in contact or apart by the rounding of the integrals.
    pub before_first_contact: bool,
}

impl MeanPoint<'_> {
    /// Makes means of sums whose gradient has this mean `length`, and of these the stencil. The nodes of the point are those from `first` on; those that turn out to
    /// have no part in it are removed.
    pub fn stencil(
        &self,
        sums: &Gathered,
        length: f64,
        all: &mut Vec<(usize, f64)>,
        first: usize,
        parts: &mut [NodeSums],
        out: &mut Stencil,
    ) {
        let per_area = 1.0 / sums.area;
        // What was carried before is carried on by the point as it turns, and from there to where the surface is met now.
        let turns = self.carried.map_or([identity(), identity()], |c| c.turns);
        let [own, other] = turns.map(|t| self.across.turn(t));
        let turn = |v: Vec3| if self.held { mat_vec(&own, v) } else { v };
        for ((_, weight), part) in all[first..].iter_mut().zip(parts.iter_mut()) {
            *weight *= per_area;
            if weight.abs() <= NO_WEIGHT {
                *weight = 0.0;
            }
            part.gradient = turn(scale(per_area / length, part.gradient));
            part.lever = turn(scale(per_area, part.lever));
        }
        let nodes = &all[first..];
        let dim = self.dim;
        out.reset(nodes.len() * dim);
        let normal = turn(normalize(sums.normal).unwrap_or(sums.normal));
        let frame = tangents(normal, dim);
        let along = frame.map(|e| self.across.within(e));
        let normal_before = match self.carried {
            Some(c) if c.normal != [0.0; 3] => c.normal,
            _ => turning::back(&own, normal),
        };
        let turned = mat_vec(&own, normal_before);
        let mut gap = sums.gap * (per_area / length);
        let mut largest: f64 = 0.0;
        // The distance of the two sides, at the last accepted state and now.
        let (mut moved, mut arm, mut arm_now) = ([0.0; 3], [0.0; 3], [0.0; 3]);
        for (k, (&(node, w), part)) in nodes.iter().zip(&*parts).enumerate() {
            let x = self.x[node];
            moved = add_scaled(moved, w, sub(x, self.before[node]));
            arm = add_scaled(arm, w, self.before[node]);
            arm_now = add_scaled(arm_now, w, x);
            largest = largest.max(dot(x, x));
            if self.carried.is_none() {
                gap += dot(part.gradient, sub(x, self.reference[node]));
            } else if self.held {
                gap += dot(part.gradient, sub(x, turn(self.before[node])));
            }
            for c in 0..dim {
                out.rows[0][k * dim + c] = part.gradient[c];
                for (t, e) in along.iter().enumerate().take(dim - 1) {
                    out.rows[t + 1][k * dim + c] = w * e[c];
                }
            }
        }
        if self.carried.is_some() {
            for (t, e) in along.iter().enumerate().take(dim - 1) {
                moment::add_arm(*e, normal, parts, dim, &mut out.rows[t + 1]);
            }
            let axes = match dim {
                2 if self.across.any() => [false; 3],
                2 => [false, false, true],
                _ => self.across.axes(),
            };
            moment::remove(nodes, parts, self.x, axes, dim, &mut out.rows);
        }
        let mut bent = [0.0; 2];
        [moved, arm, arm_now] = [moved, arm, arm_now].map(|v| self.across.within(v));
        if self.carried.is_some() {
            // The distance turns with both, be it gap or what counts as none. Where the primary turns otherwise, shear, which has its moment on the primary, acts on
            // the way of that, too.
            let swings = turning::swung(&own, arm);
            let apart = turning::swung_apart(&own, &other, arm_now);
            moved = turning::slid(add(sub(moved, swings), apart), &own, &other);
            bent = self.bent(&other, nodes, &along, &out.rows);
        }
        remove_idle(all, first, parts, dim, out);
        out.slip = std::array::from_fn(|t| dot(frame[t], moved) + bent[t]);
        if dim == 2 {
            out.slip[1] = 0.0;
        }
        // A gap may be off by 32 roundings of the largest coordinate.
        let rounding = 32.0 * f64::EPSILON * (largest.sqrt() + self.origin);
        if self.before_first_contact && gap.abs() <= rounding {
            gap = 0.0;
        }
        out.gap = gap;
        out.normal = normal;
        out.frame = frame;
        out.frame_before = frame.map(|e| turning::back(&own, carried_over(e, normal, turned)));
        out.normal_before = normal_before;
        out.coordinate_scale = largest.sqrt();
    }

    /// The part that the moment of shear has in the slip, of nodes that do not turn as one: shear does work on it, so that slip without it would not be what
    /// friction dissipates. `other` is the rotation of what lies opposite.
    fn bent(
        &self,
        other: &Mat3,
        nodes: &[(usize, f64)],
        along: &[Vec3; 2],
        rows: &[Vec<f64>; 3],
    ) -> [f64; 2] {
        let mut bent = [0.0; 2];
        let turned = |node: usize| sub(self.x[node], mat_vec(other, self.before[node]));
        for (k, &(node, w)) in nodes.iter().enumerate() {
            let way = turned(node);
            for (t, bent) in bent.iter_mut().enumerate().take(self.dim - 1) {
                let row = &rows[t + 1][k * self.dim..(k + 1) * self.dim];
                let moments = row.iter().zip(along[t]).map(|(r, e)| r - w * e);
                *bent += moments.zip(way).map(|(m, x)| m * x).sum::<f64>();
            }
        }
        bent
    }
}

/// Removes nodes of the primary that have a part neither in gap nor in slip.
fn remove_idle(
    all: &mut Vec<(usize, f64)>,
    first: usize,
    parts: &[NodeSums],
    dim: usize,
    out: &mut Stencil,
) {
    let mut kept = 0;
    for (k, part) in parts.iter().enumerate() {
        let dofs = k * dim..(k + 1) * dim;
        let entries = out.rows.iter().flat_map(|row| &row[dofs.clone()]);
        let idle = entries.fold(all[first + k].1.abs(), |m, r| m.max(r.abs())) <= NO_WEIGHT;
        if idle && part.reach > 0.0 {
            continue;
        }
        all[first + kept] = all[first + k];
        for row in &mut out.rows {
            row.copy_within(dofs.clone(), kept * dim);
        }
        kept += 1;
    }
    all.truncate(first + kept);
    out.n = kept * dim;
    for row in &mut out.rows {
        row.truncate(out.n);
    }
}

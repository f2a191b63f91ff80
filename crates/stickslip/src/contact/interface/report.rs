//! What an interface says of itself: energy, resultants, output fields, quality.

use super::evaluate::Evaluation;
use super::{Interface, Primary, Wants};
use crate::contact::response::Status;
use crate::math::{Vec3, add, add_scaled, cross, dot, norm, normalize, scale};
use crate::system::{Fields, Force, Location, Stage};

/// Forces of an interface on its secondary.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Resultant {
    /// Sum of pressure forces `[N]`.
    pub normal: Vec3,
    /// Sum of shear forces `[N]`.
    pub shear: Vec3,
    /// Centre of pressure `[m]`; the origin where there is none.
    pub centre: Vec3,
    /// Moment of all forces about the origin `[N m]`.
    pub moment: Vec3,
    /// Area in contact `[m²]`.
    pub area: f64,
    /// Largest pressure `[Pa]`.
    pub peak: f64,
}

/// Figures by which a solution can be judged.
#[derive(Debug, Clone, Copy, Default, PartialEq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub struct Quality {
    /// Largest penetration that the normal law did not ask for `[m]`.
    pub penetration: f64,
    /// The same relative to the height of the cell beneath `[-]`.
    pub relative_to_size: f64,
    /// Largest false slip of a sticking point over the last increment `[m]`.
    pub false_slip: f64,
    /// Largest velocity of slip at a point that carries less than its limit, over the last increment `[m/s]`: the creep of a regularised
    /// slip rule, see [`creep`](crate::contact::law::slip::creep).
    pub creep: f64,
}

/// Two output directions in a surface: the x axis (or y, z where the normal is along it) laid into it, and the one across.
fn output_frame(normal: Vec3, dim: usize) -> [Vec3; 2] {
    let along = if normal[0].abs() < 0.99 {
        [1.0, 0.0, 0.0]
    } else if dim == 2 {
        [0.0, 1.0, 0.0]
    } else {
        [0.0, 0.0, 1.0]
    };
    let t = normalize(add_scaled(along, -dot(along, normal), normal)).unwrap_or(along);
    [t, cross(normal, t)]
}

impl Interface {
    /// Recoverable energy of the interface: of the normal law, and of the springs of the enforcement where they yield.
    pub(super) fn stored_energy(&self) -> f64 {
        let law = self.laws.normal.as_dyn();
        self.points
            .iter()
            .zip(&self.memory.committed)
            .zip(&self.memory.last.points)
            .enumerate()
            .map(|(i, ((p, h), e))| {
                let own = law.energy(h.gap);
                let spring = if e.normal_stiffness.is_finite() && self.laws.needs_normal_stiffness()
                {
                    // what is left of the constraint's violation, a spring from λ to p
                    let rest = self.memory.rest.get(i).copied().unwrap_or(0.0);
                    0.5 * (h.pressure - h.damping) * (rest - h.gap).max(0.0)
                } else {
                    0.0
                };
                p.area * (own + spring)
            })
            .sum()
    }

    /// Nodes of the facet that a point lies on and its weights there; nothing where it lies on none.
    pub(super) fn facet_weights(&self, i: usize) -> impl Iterator<Item = (usize, f64)> {
        let e = self.memory.last.points.get(i);
        let on = match &self.primary {
            Primary::Facets(facets) => e.and_then(|e| Some((&facets[e.facet?], e))),
            Primary::Rigid(..) => None,
        };
        on.into_iter().flat_map(|(facet, e)| {
            let nodes = facet.nodes.iter().copied();
            nodes.zip(e.facet_weights)
        })
    }

    /// Forces on the secondary at the last committed state `u`.
    pub fn resultant(&self, u: &[f64]) -> Resultant {
        let x = self.coordinates(u);
        let mut r = Resultant::default();
        let mut total = 0.0;
        for (p, h) in self.points.iter().zip(&self.memory.committed) {
            if h.status == Status::Open {
                continue;
            }
            let place = p.position(&x);
            let normal = scale(h.pressure * p.area, h.normal);
            let shear = scale(p.area, h.shear);
            r.normal = add(r.normal, normal);
            r.shear = add(r.shear, shear);
            r.moment = add(r.moment, cross(place, add(normal, shear)));
            r.centre = add_scaled(r.centre, h.pressure * p.area, place);
            total += h.pressure * p.area;
            r.area += p.area;
            r.peak = r.peak.max(h.pressure);
        }
        if total > 0.0 {
            r.centre = scale(1.0 / total, r.centre);
        }
        r
    }

    /// How well contact and stick hold at the last committed state.
    pub fn quality(&self) -> Quality {
        let mut q = Quality {
            creep: self.memory.creep,
            ..Quality::default()
        };
        let law = self.laws.normal.as_dyn();
        let evaluations = self.memory.last.points.iter();
        for ((p, h), e) in self
            .points
            .iter()
            .zip(&self.memory.committed)
            .zip(evaluations)
        {
            if h.pressure > 0.0 {
                let wanted = law.gap(h.pressure).value;
                let over = (wanted - h.gap).max(0.0);
                q.penetration = q.penetration.max(over);
                q.relative_to_size = q.relative_to_size.max(over / p.size);
            }
            if h.status == Status::Stick && self.laws.needs_tangential_stiffness() {
                q.false_slip = q.false_slip.max(norm(e.moved));
            }
        }
        q
    }

    /// Adds CPRESS, CSHEAR1/2, COPEN, CSLIP1/2, CSTATUS (0 open, 1 stick, 2 slip) on both sides, and the nodal contact
    /// force CFORCE. Where no interface is the values are NaN, except for forces, which are zero.
    pub(super) fn add_fields(&self, out: &mut Fields) {
        let (points, dim) = (self.dofs.points, self.dofs.dim);
        let mut sums = vec![[0.0; 7]; self.nodes.len()];
        let mut statuses = vec![(0.0, 0.0); self.nodes.len()];
        let mut forces = vec![[0.0; 3]; self.nodes.len()];
        for (i, (p, h)) in self.points.iter().zip(&self.memory.committed).enumerate() {
            let frame = output_frame(
                if h.normal == [0.0; 3] {
                    scale(-1.0, p.normal)
                } else {
                    h.normal
                },
                dim,
            );
            let status = match h.status {
                Status::Open => 0.0,
                Status::Stick => 1.0,
                Status::Slip => 2.0,
            };
            let values = [
                h.pressure,
                dot(h.shear, frame[0]),
                dot(h.shear, frame[1]),
                h.gap,
                dot(h.slip, frame[0]),
                dot(h.slip, frame[1]),
            ];
            let force = scale(p.area, add_scaled(h.shear, h.pressure, h.normal));
            let mut give = |node: usize, weight: f64, sign: f64| {
                let share = p.area * weight.max(0.0);
                if values[3].is_finite() && share > 0.0 {
                    for (sum, v) in sums[node].iter_mut().zip(values) {
                        *sum += share * v;
                    }
                    sums[node][6] += share;
                    if share > statuses[node].0 {
                        statuses[node] = (share, status);
                    }
                }
                forces[node] = add_scaled(forces[node], sign * weight, force);
            };
            for (&node, &w) in p.nodes.iter().zip(&p.weights) {
                give(node, w, 1.0);
            }
            for (node, w) in self.facet_weights(i) {
                give(node, w, -1.0);
            }
        }
        let names = ["CPRESS", "CSHEAR1", "CSHEAR2", "COPEN", "CSLIP1", "CSLIP2"];
        for (k, name) in names.into_iter().enumerate() {
            if dim == 2 && name.ends_with('2') {
                continue;
            }
            let field = out.shared(name, Location::Point, 1, points, f64::NAN);
            for (local, &node) in self.nodes.iter().enumerate() {
                if sums[local][6] > 0.0 {
                    field.values[node] = sums[local][k] / sums[local][6];
                }
            }
        }
        let field = out.shared("CSTATUS", Location::Point, 1, points, f64::NAN);
        for (local, &node) in self.nodes.iter().enumerate() {
            if sums[local][6] > 0.0 {
                field.values[node] = statuses[local].1;
            }
        }
        let field = out.shared("CFORCE", Location::Point, 3, points, 0.0);
        for (local, &node) in self.nodes.iter().enumerate() {
            for (total, f) in field.values[3 * node..].iter_mut().zip(forces[local]) {
                *total += f;
            }
        }
    }

    /// The table of the secondary: names of columns and the columns, one entry a point, for `interfaces/<name>.csv`.
    pub fn table(&self, u: &[f64]) -> (Vec<String>, Vec<Vec<f64>>) {
        let header = [
            "node", "x", "y", "z", "CPRESS", "CSHEAR1", "CSHEAR2", "COPEN", "CSLIP1", "CSLIP2",
            "CSTATUS", "CNORMF", "CSHEARF1", "CSHEARF2", "U1", "U2", "U3",
        ];
        let dim = self.dofs.dim;
        let moved = self.coordinates(u);
        let rows: Vec<Vec<f64>> = self
            .points
            .iter()
            .zip(&self.memory.committed)
            .map(|(p, h)| {
                let x = p.position(&self.reference);
                let now = p.position(&moved);
                let normal = if h.normal == [0.0; 3] {
                    scale(-1.0, p.normal)
                } else {
                    h.normal
                };
                let frame = output_frame(normal, dim);
                let shear = [dot(h.shear, frame[0]), dot(h.shear, frame[1])];
                let id = match p.nodes.as_slice() {
                    [one] => self.node_ids[*one] as f64,
                    _ => f64::NAN,
                };
                vec![
                    id,
                    x[0],
                    x[1],
                    x[2],
                    h.pressure,
                    shear[0],
                    shear[1],
                    h.gap,
                    dot(h.slip, frame[0]),
                    dot(h.slip, frame[1]),
                    f64::from(h.status as u8),
                    h.pressure * p.area,
                    shear[0] * p.area,
                    shear[1] * p.area,
                    now[0] - x[0],
                    now[1] - x[1],
                    now[2] - x[2],
                ]
            })
            .collect();
        let columns = (0..header.len())
            .map(|k| rows.iter().map(|row| row[k]).collect())
            .collect();
        (header.map(str::to_string).to_vec(), columns)
    }

    /// Gaps of all points in the reference configuration; NaN or infinite where there is nothing opposite.
    pub fn initial_gaps(&self) -> Vec<f64> {
        self.memory.committed.iter().map(|h| h.gap).collect()
    }

    /// Gaps of all points at a stage, without touching the history; infinite where nothing lies opposite.
    pub fn gaps_at(&mut self, stage: &Stage) -> Vec<f64> {
        let _ = self.prepare(stage);
        self.begin();
        let evaluations = self.evaluate_all(stage, Wants::default());
        let opposite = |e: &Evaluation| e.facet.is_some() || self.rigid();
        let gaps = evaluations.points.iter();
        let gaps = gaps.map(|e| if opposite(e) { e.gap } else { f64::INFINITY });
        let gaps = gaps.collect();
        self.memory.trial = evaluations;
        gaps
    }

    /// Whether the primary is an obstacle.
    pub fn rigid(&self) -> bool {
        matches!(self.primary, Primary::Rigid(..))
    }
}

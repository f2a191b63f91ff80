//! What an interface says of itself: energy, resultants, output fields.

use super::definition::{Interface, Primary};
use crate::contact::response::Status;
use crate::math::{Vec3, add, add_scaled, cross, dot, norm, normalize, scale, sub};
use crate::system::{Energy, Fields, Location};

/// Forces of an interface on what the problem calls its secondary.
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
    /// The part of it that shear has `[N m]`.
    pub moment_of_shear: Vec3,
    /// Area in contact `[m²]`.
    pub area: f64,
    /// Largest pressure `[Pa]`.
    pub peak: f64,
    /// Sum of the magnitudes of pressure forces, whatever their directions `[N]`.
    pub total: f64,
    /// The same of all forces, shear included `[N]`.
    pub carried: f64,
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

/// What pressure and pull leave of their sum, relative to the sum of their magnitudes, where they have no centre.
const CANCELLED: f64 = 1e-9;

impl Interface {
    /// Recoverable energy of the interface: of the normal law, and of the springs of the enforcement where they yield, in both directions.
    pub(super) fn stored_energy(&self) -> f64 {
        if !self.history.acting {
            return 0.0;
        }
        let own = self.law_energies();
        (self.history.points.iter().enumerate())
            .map(|(i, h)| {
                let spring = if h.stiffness[0].is_finite() && self.laws.needs_normal_stiffness() {
                    // what is left of the constraint's violation, a spring from λ to p
                    let rest = self.history.rest.get(i).copied().unwrap_or(0.0);
                    let left = rest - h.gap;
                    // Tied surfaces pull as well, where something is opposite.
                    let pulls = self.laws.tied && h.gap.is_finite();
                    let left = if pulls { left } else { left.max(0.0) };
                    0.5 * (h.pressure - h.damping) * left
                } else {
                    0.0
                };
                self.area_of(i) * (own[i] + spring + h.sheared)
            })
            .sum()
    }

    /// Energies at the last committed state.
    pub fn energy(&self) -> Energy {
        Energy {
            stored: self.stored_energy(),
            ..self.history.energy
        }
    }

    /// Recoverable energy of the normal law alone `[J]`.
    pub fn law_energy(&self) -> f64 {
        let energies = self.law_energies();
        let energies = energies.iter().enumerate();
        energies.map(|(i, own)| self.area_of(i) * own).sum()
    }

    /// The same by point and per area `[J/m²]`.
    fn law_energies(&self) -> Vec<f64> {
        let gaps = self.history.points.iter().map(|h| h.gap);
        match &self.laws.own.normal {
            Some(own) => own.energies(&gaps.collect::<Vec<_>>()),
            None => {
                let law = self.laws.normal_law();
                gaps.map(|gap| law.energy(gap)).collect()
            }
        }
    }

    /// Forces on the secondary, as it is named, at the last committed state `u`.
    pub fn resultant(&self, u: &[f64]) -> Resultant {
        let x = self.coordinates(u);
        let mut r = Resultant::default();
        // Tied surfaces pull as well as they press.
        let mut signed = 0.0;
        for (i, (p, h)) in self.points.iter().zip(&self.history.points).enumerate() {
            if h.status == Status::Open {
                continue;
            }
            let area = self.area_of(i);
            let place = p.position(&x);
            let normal = scale(h.pressure * area, h.normal);
            let shear = scale(area, h.shear);
            r.normal = add(r.normal, normal);
            r.shear = add(r.shear, shear);
            r.moment = add(r.moment, cross(place, add(normal, shear)));
            r.moment_of_shear = add(r.moment_of_shear, cross(place, shear));
            r.centre = add_scaled(r.centre, h.pressure * area, place);
            signed += h.pressure * area;
            r.total += h.pressure.abs() * area;
            r.carried += h.pressure.hypot(norm(h.shear)) * area;
            r.area += area;
            r.peak = r.peak.max(h.pressure);
        }
        let averaged = self.points.iter().any(|p| p.nodes.len() > 1);
        if matches!(self.primary, Primary::Rigid(..)) && averaged {
            // The mean of normals around a point is shorter than one: what nodes are given is the force.
            let all = self.history.nodal.iter().fold([0.0; 3], |s, &f| add(s, f));
            r.normal = sub(all, r.shear);
        }
        r.centre = match signed.abs() > CANCELLED * r.total {
            true => add(scale(1.0 / signed, r.centre), self.origin),
            false => [0.0; 3],
        };
        // As the user counts.
        r.moment = add(r.moment, cross(self.origin, add(r.normal, r.shear)));
        for v in [&mut r.normal, &mut r.shear, &mut r.moment] {
            *v = scale(self.named(), *v);
        }
        r
    }

    /// Normal of the primary, shear on the secondary and slip of it at a point, of the sides as they are named.
    fn vectors(&self, i: usize) -> [Vec3; 3] {
        let h = &self.history.points[i];
        let normal = match h.normal == [0.0; 3] {
            true => scale(-1.0, self.points[i].normal),
            false => h.normal,
        };
        [normal, h.shear, h.slip].map(|v| scale(self.named(), v))
    }

    /// Centre of the area in contact at the displacements `u` `[m]`, and the mean outward normal of the secondary there; zero where nothing touches.
    pub fn centre_and_normal(&self, u: &[f64]) -> (Vec3, Vec3) {
        let x = self.coordinates(u);
        let (mut centre, mut normal, mut area) = ([0.0; 3], [0.0; 3], 0.0);
        for (i, (p, h)) in self.points.iter().zip(&self.history.points).enumerate() {
            if h.status != Status::Open {
                centre = add_scaled(centre, self.area_of(i), p.position(&x));
                // Pressure pushes the secondary along the normal of the primary.
                normal = add_scaled(normal, -self.area_of(i), h.normal);
                area += self.area_of(i);
            }
        }
        if area > 0.0 {
            centre = add(scale(1.0 / area, centre), self.origin);
        }
        let normal = normalize(normal).unwrap_or_default();
        (centre, scale(self.named(), normal))
    }

    /// Forces on the nodes in the last evaluation: those that the bodies resist, gradients of gap and slip and all. Pressure and shear times the
    /// weights of the nodes have the same sum, but where the gradient of a gap or slip turns from node to node they are other forces.
    pub(super) fn nodal_forces(&self, active: bool) -> Vec<Vec3> {
        let mut forces = vec![[0.0; 3]; self.nodes.len()];
        let last = &self.cache.last;
        for (i, e) in last.points.iter().enumerate().filter(|_| active) {
            let batch = last.batch(i);
            let Some(force) = batch.force(e) else {
                continue;
            };
            // Residuals are internal less external forces.
            for (&(node, _), part) in batch.sides(e).iter().zip(force.chunks(self.dofs.dim)) {
                for (total, f) in forces[node].iter_mut().zip(part) {
                    *total -= f;
                }
            }
        }
        forces
    }

    /// Adds the fields of the last committed state: CPRESS, CSHEAR1/2, COPEN, CSLIP1/2, CSTATUS (0 open, 1 stick, 2 slip) on both sides, CFORCE, the force on each node, and
    /// what sliding leaves: CDISS and CWEAR. A value at a node is the mean of the points that hang on it or lie over it, weighted by
    /// their areas there; where both surfaces are secondary only of those that hang on it, as slip and shear of the other half have the other sign. Where no
    /// interface is the values are NaN, except for forces, which are zero.
    pub fn fields(&self, out: &mut Fields) {
        let (points, dim) = (self.dofs.points, self.dofs.dim);
        let mut sums = vec![[0.0; 7]; self.nodes.len()];
        let mut statuses = vec![(0.0, 0.0); self.nodes.len()];
        for (i, h) in self.history.points.iter().enumerate() {
            let [normal, shear, slip] = self.vectors(i);
            let frame = output_frame(normal, dim);
            let status = match h.status {
                Status::Open => 0.0,
                Status::Stick => 1.0,
                Status::Slip => 2.0,
            };
            let values = [
                h.pressure,
                dot(shear, frame[0]),
                dot(shear, frame[1]),
                h.gap,
                dot(slip, frame[0]),
                dot(slip, frame[1]),
            ];
            let area = self.area_of(i);
            let mut give = |node: usize, weight: f64| {
                let share = area * weight;
                if values[3].is_finite() && share > 0.0 {
                    for (sum, v) in sums[node].iter_mut().zip(values) {
                        *sum += share * v;
                    }
                    sums[node][6] += share;
                    if share > statuses[node].0 {
                        statuses[node] = (share, status);
                    }
                }
            };
            let half = self.share < 1.0;
            let opposite = self.history.opposite.of(i).iter().filter(|_| !half);
            for (node, w) in self.own_weights(i).chain(opposite.copied()) {
                give(node, w.max(0.0));
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
        for (&force, &node) in self.history.nodal.iter().zip(&self.nodes) {
            for (total, f) in field.values[3 * node..].iter_mut().zip(force) {
                *total += f;
            }
        }
        self.add_traces(out);
    }

    /// Adds what sliding has left: CDISS, the energy dissipated per area `[J/m²]`, where there is friction, and CWEAR, the depth worn off
    /// `[m]`, where wear is followed.
    fn add_traces(&self, out: &mut Fields) {
        let points = self.dofs.points;
        let mut sums = vec![[0.0; 3]; self.nodes.len()];
        for (i, h) in self.history.points.iter().enumerate() {
            let area = self.area_of(i);
            for (node, w) in self.own_weights(i) {
                let share = area * w.max(0.0);
                sums[node][0] += share * h.dissipated;
                sums[node][1] += share * h.rubbed;
                sums[node][2] += share;
            }
        }
        // energy and depth: factors of the two accumulated numbers on the secondary and on the primary
        let friction = self.laws.friction_law().frictional();
        let wear = self.laws.wear;
        let wear = wear.map(|w| [w.coefficient, w.primary_coefficient]);
        let kinds = [
            ("CDISS", 0, friction.then_some([1.0; 2])),
            ("CWEAR", 1, wear),
        ];
        for (name, k, factors) in kinds {
            let Some([own, other]) = factors else {
                continue;
            };
            let field = out.shared(name, Location::Point, 1, points, f64::NAN);
            for (sum, &node) in sums.iter().zip(&self.nodes) {
                if sum[2] > 0.0 {
                    field.values[node] = own * sum[k] / sum[2];
                }
            }
            for local in self.primary_nodes() {
                let trace = self.history.traces.get(local).map_or(0.0, |t| t[k]);
                field.values[self.nodes[local]] = other * trace;
            }
        }
    }

    /// The table of the contact points: names of columns and the columns, one entry a point, for `interfaces/<name>.csv`.
    pub fn table(&self, u: &[f64]) -> (Vec<String>, Vec<Vec<f64>>) {
        let header = [
            "node", "x", "y", "z", "CPRESS", "CSHEAR1", "CSHEAR2", "COPEN", "CSLIP1", "CSLIP2",
            "CSTATUS", "CNORMF", "CSHEARF1", "CSHEARF2", "U1", "U2", "U3", "CDISS", "CWEAR",
        ];
        let wear = self.laws.wear.map_or(0.0, |w| w.coefficient);
        let dim = self.dofs.dim;
        let moved = self.coordinates(u);
        let rows: Vec<Vec<f64>> = self
            .points
            .iter()
            .zip(&self.history.points)
            .enumerate()
            .map(|(i, (p, h))| {
                let area = self.area_of(i);
                let x = p.place(&self.reference);
                let now = sub(p.place(&moved), x);
                let x = add(x, self.origin);
                let [normal, shear, slip] = self.vectors(i);
                let frame = output_frame(normal, dim);
                let shear = [dot(shear, frame[0]), dot(shear, frame[1])];
                let id = p.node().map_or(f64::NAN, |n| self.node_ids[n] as f64);
                vec![
                    id,
                    x[0],
                    x[1],
                    x[2],
                    h.pressure,
                    shear[0],
                    shear[1],
                    h.gap,
                    dot(slip, frame[0]),
                    dot(slip, frame[1]),
                    f64::from(h.status as u8),
                    h.pressure * area,
                    shear[0] * area,
                    shear[1] * area,
                    now[0],
                    now[1],
                    now[2],
                    h.dissipated,
                    wear * h.rubbed,
                ]
            })
            .collect();
        let columns = (0..header.len())
            .map(|k| rows.iter().map(|row| row[k]).collect())
            .collect();
        (header.map(str::to_string).to_vec(), columns)
    }

    /// Gaps of all points at the last accepted state; NaN or infinite where there is nothing opposite.
    pub fn initial_gaps(&self) -> Vec<f64> {
        self.history.points.iter().map(|h| h.gap).collect()
    }
}

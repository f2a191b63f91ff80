//! Whether contact can balance loads on bodies that move as wholes.
//!
//! There is an equilibrium only if the loads along all free motions are a sum of forces in the cones of friction of the points that may touch: linear inequalities
//! in as many unknowns as there are free motions. Where there is no such sum, what is left of the loads is the motion that nothing stops. Of contact
//! the most is believed: every point meets what it faces, and friction is as large as it may be.

use super::super::scene::Scene;
use super::drivers;
use super::held::{Unheld, unheld};
use super::modes::{Mode, modes};
use crate::contact::interface::InterfaceDefinition;
use crate::contact::law::friction::FrictionPoint;
use crate::contact::look::{FACING_COSINE, Opposite};
use crate::friction::cone::Cone;
use crate::friction::ellipse::Ellipse;
use crate::math::{
    Vec3, add, add_scaled, cross, distance, dot, norm, normalize, rest_of_nonnegative, vector,
};

/// Displacements and gaps over the size of the smallest body up to which points are where they were meshed. Levers and slopes change by as much, so that
/// friction is wider by it, and twice as much of the loads may be left. Between 0.3 and 3 times this value the short cases (see
/// [`tolerance`](crate::tolerance)) are the same in every digit, and none is refused that was solved.
pub(crate) const UNMOVED: f64 = 1e-3;

/// The part that may be left where a figure is wanted as of the mesh. Between 3e-9 and 1e-6 the tests of loads that friction cannot balance pass; with 3e-6 the
/// time at which a load becomes too large is told wrong.
pub(crate) const EXACT_REST: f64 = 1e-7;

/// Coefficient of friction that counts as unlimited. No pair of surfaces has as much.
const UNLIMITED: f64 = 1e3;

/// Pressures, over the stiffness of the cells beneath, and speeds, in sizes of a cell in a unit of time, at which friction is asked for.
const PRESSURES: [f64; 4] = [1e-6, 1e-4, 1e-3, 1e-1];
const SLIDING_SPEEDS: [f64; 4] = [0.0, 1e-3, 1.0, 1e3];

/// Most motions, and most points, that are looked at.
const MOST_MOTIONS: usize = 60;
const MOST_POINTS_ASKED: usize = 50_000;

/// Halvings by which a coefficient is found.
const HALVINGS: usize = 40;

/// A place where contact may push, or the stop of a coupling.
struct Spot {
    /// The push and the directions across, as forces along the motions; none of a stop, which has no friction.
    normal: Vec<f64>,
    across: Vec<Vec<f64>>,
    /// The largest coefficient of friction, and how it depends on the direction across.
    mu: f64,
    ellipse: Option<Ellipse>,
}

/// Free motions, and the contact that may balance loads along them.
pub(crate) struct Balance {
    /// The motions of all bodies, of which free ones are made.
    pub all: Vec<Mode>,
    /// The free motions: those that supports, springs and couplings leave.
    pub motions: Vec<Unheld>,
    spots: Vec<Spot>,
    /// The largest coefficient of friction at a spot.
    pub mu: f64,
    /// Whether surfaces touch as meshed.
    pub close: bool,
}

impl Balance {
    /// Of the free motions at a time, while bodies are where they were meshed; `None` where there are none, or nothing certain can be said.
    pub fn new(scene: &Scene, t: f64) -> Option<Balance> {
        let all = modes(scene.model);
        let motions = unheld(scene, t, &all, false);
        if motions.is_empty() || motions.len() > MOST_MOTIONS {
            return None;
        }
        let size = smallest_body(scene);
        if largest_displacement(scene, t) > UNMOVED * size {
            return None;
        }
        let mut balance = Balance {
            all,
            motions,
            spots: Vec::new(),
            mu: 0.0,
            close: false,
        };
        let interfaces = scene.contact.interfaces.iter();
        for interface in interfaces.filter(|i| i.schedule.active(t) && !i.laws.tied) {
            let gap = balance.add_interface(scene, interface, t)?;
            if gap > UNMOVED * size {
                return None;
            }
            balance.close |= gap <= 1e-9 * size;
        }
        for row in scene.couplings().stops(t) {
            let speed = |motion: &Unheld| -> f64 {
                let parts = balance.all.iter().zip(motion);
                parts.map(|(m, c)| c * m.along(scene.model, row)).sum()
            };
            let normal = balance.motions.iter().map(speed).collect();
            balance.spots.push(Spot {
                normal,
                across: Vec::new(),
                mu: 0.0,
                ellipse: None,
            });
        }
        (!balance.spots.is_empty()).then_some(balance)
    }

    /// Adds the places of an interface where contact may push free motions; the smallest gap. `None` where that cannot be told.
    fn add_interface(
        &mut self,
        scene: &Scene,
        interface: &InterfaceDefinition,
        t: f64,
    ) -> Option<f64> {
        let mu = largest_friction(interface)?;
        if interface.points.len() + self.spots.len() > MOST_POINTS_ASKED {
            return None;
        }
        let mut opposite = Opposite::new(interface, t);
        let mut gap = f64::INFINITY;
        for point in &interface.points {
            let Some(nearest) = opposite.nearest(point.position(&interface.reference)) else {
                continue;
            };
            if dot(nearest.normal, point.normal) >= FACING_COSINE {
                continue;
            }
            gap = gap.min(nearest.gap.abs());
            // Beside the primary nothing pushes; the farthest that contact may is its edge.
            let x = match opposite.edge(&nearest, point.position(&interface.reference)) {
                Some(edge) => add(edge, interface.origin),
                None => interface.place(point),
            };
            let own = interface.nodes[point.nodes[0]];
            let facing = opposite.node_of(&nearest);
            let along = |d: Vec3| -> Vec<f64> {
                let speed = |motion: &Unheld| -> f64 {
                    let parts = self.all.iter().zip(motion).filter(|(_, c)| **c != 0.0);
                    let parts = parts.map(|(m, c)| {
                        m.relative(scene.model, own, facing) * c * dot(d, m.velocity(x))
                    });
                    parts.sum()
                };
                self.motions.iter().map(speed).collect()
            };
            let dim = interface.dofs.dim;
            let tangents = tangents(nearest.normal, dim);
            let frame = [tangents[0], cross(nearest.normal, tangents[0])];
            let orthotropy = interface.laws.friction_law().orthotropy();
            self.spots.push(Spot {
                normal: along(nearest.normal),
                across: tangents.into_iter().map(along).collect(),
                mu,
                ellipse: orthotropy.and_then(|o| o.ellipse(x, frame, dim)),
            });
            self.mu = self.mu.max(mu);
        }
        // Surfaces that do not face each other hold nothing yet.
        gap.is_finite().then_some(gap)
    }

    /// The loads along the motions at a time `[N]`; zero where they are rounding.
    pub fn loads(&self, scene: &Scene, t: f64) -> Vec<f64> {
        let each = self.motions.iter();
        let pushes = each.map(|m| drivers::push(scene, &self.all, m, t));
        pushes
            .map(|push| if push.is_felt() { push.total } else { 0.0 })
            .collect()
    }

    /// Forces of contact of size one along the motions, of which all are sums with positive coefficients: the edges of the cones of friction.
    fn edges(&self, friction: impl Fn(f64) -> f64) -> Vec<Vec<f64>> {
        let mut edges = Vec::new();
        for spot in &self.spots {
            let cone = Cone {
                limit: friction(spot.mu),
                skew: 0.0,
                ellipse: spot.ellipse,
            };
            for corner in cone.corners(spot.across.len()) {
                let mut edge = spot.normal.clone();
                for (factor, across) in corner.into_iter().zip(&spot.across) {
                    let both = edge.iter_mut().zip(across);
                    both.for_each(|(e, t)| *e += factor * t);
                }
                edges.push(edge);
            }
        }
        edges
    }

    /// What is left of loads along the motions, if it is more than the part `left` of them: friction is what it is made of the coefficient at each spot.
    pub fn rest(
        &self,
        loads: &[f64],
        friction: impl Fn(f64) -> f64,
        left: f64,
    ) -> Option<Vec<f64>> {
        let target: Vec<f64> = loads.iter().map(|f| -f).collect();
        let rest = rest_of_nonnegative(&self.edges(friction), &target);
        (vector::norm(&rest) > left * vector::norm(&target)).then_some(rest)
    }

    /// The motion that loads drive of which this is left, over all modes, the largest part of size one.
    pub fn driven(&self, rest: &[f64]) -> Unheld {
        let mut motion = vec![0.0; self.all.len()];
        // What is left pushes against the loads.
        for (part, own) in rest.iter().zip(&self.motions) {
            motion.iter_mut().zip(own).for_each(|(m, o)| *m -= part * o);
        }
        let sizes = motion.iter().map(|m| m.abs());
        let largest = sizes.fold(f64::MIN_POSITIVE, f64::max);
        motion.iter_mut().for_each(|m| *m /= largest);
        motion
    }

    /// Whether contact pushes free bodies away wherever it acts, as no forces of contact balance each other.
    pub fn is_one_sided(&self) -> bool {
        // Forces whose sizes add up to one and that cancel: an equation more.
        let mut edges = self.edges(|mu| mu);
        for edge in &mut edges {
            let size = vector::norm(edge);
            edge.iter_mut()
                .for_each(|e| *e /= size.max(f64::MIN_POSITIVE));
            edge.push(1.0);
        }
        let mut target = vec![0.0; self.motions.len()];
        target.push(1.0);
        vector::norm(&rest_of_nonnegative(&edges, &target)) > EXACT_REST
    }

    /// The coefficient of friction that would balance loads along the motions, if there is one.
    pub fn least_friction(&self, loads: &[f64]) -> Option<f64> {
        if self.rest(loads, |_| UNLIMITED, EXACT_REST).is_some() {
            return None;
        }
        let (mut low, mut high) = (0.0, UNLIMITED);
        for _ in 0..HALVINGS {
            // Halvings of its size first.
            let middle = f64::midpoint(low, f64::min(high, 2.0 * low + 0.1));
            match self.rest(loads, |_| middle, EXACT_REST) {
                Some(_) => low = middle,
                None => high = middle,
            }
        }
        Some(high)
    }
}

/// The extent of the smallest body `[m]`.
fn smallest_body(scene: &Scene) -> f64 {
    let bodies = scene.model.bodies.iter().map(|b| {
        let points = &scene.model.mesh.points[b.points.clone()];
        let first = points.first().copied().unwrap_or_default();
        let across = points.iter().map(|&x| distance(x, first));
        across.fold(0.0, f64::max)
    });
    bodies.fold(f64::INFINITY, f64::min)
}

/// The largest displacement so far, and that supports prescribe at a time `[m]`.
fn largest_displacement(scene: &Scene, t: f64) -> f64 {
    let constraints = scene.constraints(t);
    let prescribed = constraints.fixed.iter().zip(&constraints.values);
    let prescribed = prescribed.filter(|(fixed, _)| **fixed).map(|(_, v)| v);
    let all = prescribed.chain(&scene.frame.state.u);
    all.fold(0.0, |most, u| most.max(u.abs()))
}

/// Directions across a normal.
fn tangents(normal: Vec3, dim: usize) -> Vec<Vec3> {
    if dim == 2 {
        return vec![[-normal[1], normal[0], 0.0]];
    }
    let smallest = (0..3).min_by(|&a, &b| normal[a].abs().total_cmp(&normal[b].abs()));
    let mut axis = [0.0; 3];
    axis[smallest.unwrap_or(0)] = 1.0;
    let first = add_scaled(axis, -dot(axis, normal), normal);
    let first = normalize(first).unwrap_or(axis);
    debug_assert!(norm(first) > 0.0);
    vec![first, cross(normal, first)]
}

/// The largest coefficient of friction of an interface, whatever the pressure and speed; `None` where it is not known, or not limited by pressure.
fn largest_friction(interface: &InterfaceDefinition) -> Option<f64> {
    let law = interface.laws.friction_law();
    if interface.laws.user.any() || !law.states().is_empty() {
        return None;
    }
    if !law.frictional() {
        return Some(0.0);
    }
    if law.needs_penetration() {
        return None;
    }
    let point = interface.points.first()?;
    let mut most = 0.0_f64;
    for pressure in PRESSURES.map(|p| p * point.stiffness * point.size) {
        for speed in SLIDING_SPEEDS.map(|v| v * point.size) {
            for sticking in [true, false] {
                let limit = law.limit(&FrictionPoint {
                    speed,
                    sticking,
                    ..FrictionPoint::at_rest(law, pressure)
                });
                most = most.max(limit.value / pressure);
            }
        }
    }
    (most.is_finite() && most < UNLIMITED).then_some(most)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::friction::ellipse::SlipDirection;

    /// A block in the plane on a floor, by its two translations.
    fn block(normals: &[[f64; 2]], mu: f64) -> Balance {
        let spot = |n: &[f64; 2]| Spot {
            normal: n.to_vec(),
            across: vec![vec![-n[1], n[0]]],
            mu,
            ellipse: None,
        };
        Balance {
            all: Vec::new(),
            motions: vec![Vec::new(); 2],
            spots: normals.iter().map(spot).collect(),
            mu,
            close: true,
        }
    }

    #[test]
    fn friction_holds_a_block_up_to_its_limit() {
        let flat = block(&[[0.0, 1.0]], 0.3);
        let rest = |load: [f64; 2]| flat.rest(&load, |mu| mu, EXACT_REST);
        assert!(rest([0.29, -1.0]).is_none());
        assert!(rest([0.31, -1.0]).is_some());
        assert!(rest([0.0, 0.1]).is_some());
        let least = flat.least_friction(&[0.25, -1.0]).expect("it can be held");
        assert!((least - 0.25).abs() < 1e-6, "{least}");
        assert_eq!(flat.least_friction(&[0.0, 0.1]), None);
    }

    /// A block in space on a floor that is rough along x and half as rough across, with scratches at 45 degrees from a load.
    #[test]
    fn friction_holds_a_block_as_far_as_it_does_in_the_direction_of_the_load() {
        for flow in [SlipDirection::Associated, SlipDirection::AgainstTraction] {
            let floor = Balance {
                all: Vec::new(),
                motions: vec![Vec::new(); 3],
                spots: vec![Spot {
                    normal: vec![0.0, 0.0, 1.0],
                    across: vec![vec![1.0, 0.0, 0.0], vec![0.0, 1.0, 0.0]],
                    mu: 0.4,
                    ellipse: Some(Ellipse {
                        half: [1.0, 0.5],
                        angle: 0.0,
                        flow,
                    }),
                }],
                mu: 0.4,
                close: true,
            };
            let least = |load: [f64; 2]| floor.least_friction(&[load[0], load[1], -1.0]);
            for (load, expected) in [
                ([0.1, 0.0], 0.1),
                ([0.0, 0.1], 0.2),
                ([0.1, 0.1], 0.1 * 5.0_f64.sqrt()),
            ] {
                let found = least(load).expect("it can be held");
                // The polygon around the ellipse is wider by 1 - cos(π/24).
                assert!(
                    (found / expected - 1.0).abs() < 0.009,
                    "{flow:?} {load:?}: {found}"
                );
            }
        }
    }

    #[test]
    fn contact_from_both_sides_needs_no_load() {
        assert!(block(&[[0.0, 1.0]], 0.3).is_one_sided());
        assert!(!block(&[[0.0, 1.0], [0.0, -1.0]], 0.0).is_one_sided());
        // A wedge of 30 degrees from either side: friction grips it from tan 30 degrees = 0.577 on.
        let (sine, cosine) = 30.0_f64.to_radians().sin_cos();
        let wedge = [[cosine, sine], [-cosine, sine]];
        assert!(block(&wedge, 0.57).is_one_sided());
        assert!(!block(&wedge, 0.58).is_one_sided());
    }
}

//! Figures by which a solution can be judged: what is left of the conditions of contact, and whether the two sides balance.

use super::oscillation::oscillation;
use crate::contact::enforcement::Multipliers;
use crate::contact::interface::energies::stored_energy;
use crate::contact::interface::view::ContactView;
use crate::contact::response::Status;
use crate::math::{Vec3, add, cross, norm, sub};

/// Figures by which a solution can be judged.
#[derive(Debug, Clone, Copy, Default, PartialEq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub struct Quality {
    /// Largest penetration that the normal law did not ask for `[m]`.
    pub penetration: f64,
    /// The same relative to the height of the cell beneath `[-]`.
    pub relative_to_size: f64,
    /// Largest false slip of a sticking point over the last increment `[m]`.
    pub elastic_slip: f64,
    /// Largest velocity of slip at a point that carries less than its limit, over the last increment `[m/s]`: the creep of a regularised
    /// slip rule, see [`creep`](crate::contact::law::slip::creep).
    pub creep: f64,
    /// Mean gap, beyond what the normal law asks for, that pressure bridges, relative to the height of the cell beneath:
    /// `Σ A p max(0, g - h(p)) / Σ A p height` `[-]`.
    pub complementarity: f64,
    /// How much of the pressure goes up and down from point to point `[-]`; see [`oscillation`].
    pub oscillation: f64,
    /// Largest shear beyond the limit of friction, relative to the largest limit of the interface `[-]`.
    pub cone_violation: f64,
    /// Largest amount by which the shear of a point that slips is not its limit, or by which that of one that sticks is above it, over the last
    /// increment and relative to the largest limit of the interface `[-]`. Limits follow from the pressure and the law, slip from how the nodes have moved:
    /// it is judged by what is reported, not by what made it.
    pub friction_law: f64,
    /// Mean compression of one layer of cells over what carries, `Σ A p / Σ A k` `[m]`: the least that the bodies have come nearer, as no other pressure of
    /// the same force takes less energy. Of a face with points inside it is the whole, as its cell gives way as a whole. Not that under the largest pressure, which grows with every cell under an edge.
    pub layer: f64,
    /// What `complementarity` is relative to, `Σ A p height` `[N m]`.
    #[serde(skip)]
    pub pressed: f64,
    /// What `cone_violation` is relative to: the largest limit of friction `[Pa]`.
    #[serde(skip)]
    pub limit: f64,
    /// Work of the tractions along what is left of the violations of gap and stick, `Σ A (p |v_n| + |t| |v_t|)` `[J]`.
    pub violation_work: f64,
}

/// Sums of the forces and moments that the two sides receive.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Balance {
    /// Sum of all forces; zero if action equals reaction `[N]`.
    pub force: Vec3,
    /// Sum of their moments `[N m]`.
    pub moment: Vec3,
    /// Sum of the magnitudes of the forces on one side `[N]`.
    pub scale: f64,
    /// Size of the interface `[m]`.
    pub size: f64,
}

/// Whether the interface acts through springs in place of its enforcement: in an explicit step.
pub fn on_springs(contact: ContactView) -> bool {
    contact.state.springs
}

/// Energy of the springs that a tie by a penalty is in an explicit step `[J]`; `None` where there are none.
pub fn tie_spring_energy(contact: ContactView) -> Option<f64> {
    let springs = contact.state.springs && contact.laws.tied && !contact.holds_exactly();
    springs.then(|| stored_energy(contact))
}

/// Stiffness of the layer of cells beneath what presses, `Σ A k` `[N/m]`.
fn pressed_stiffness(contact: ContactView) -> f64 {
    let presses = |i: &usize| contact.state.acting && contact.state.points[*i].pressure > 0.0;
    let stiffness = |i: usize| contact.area_of(i) * contact.points[i].stiffness;
    let inside = |i: &usize| contact.points[*i].node().is_none();
    let at_nodes = (0..contact.state.points.len()).filter(|i| !inside(i) && presses(i));
    let faces = (contact.skin.iter()).map(|s| s.points.iter().copied().filter(inside));
    let pressed = faces.filter(|points| points.clone().any(|i| presses(&i)));
    at_nodes.chain(pressed.flatten()).map(stiffness).sum()
}

/// How well contact and stick hold at the last committed state.
pub fn quality(contact: ContactView) -> Quality {
    let mut q = Quality {
        creep: contact.state.creep,
        oscillation: oscillation(contact),
        ..Quality::default()
    };
    let law = contact.laws.normal_law();
    let friction = contact.laws.friction_law();
    let exact = contact.laws.needs_normal_stiffness();
    let sticks = contact.laws.needs_tangential_stiffness();
    let updated = matches!(
        contact.laws.enforcement.as_dyn().multipliers(),
        Multipliers::Augmented { .. }
    );
    // What rounding of the coordinates may leave is no violation.
    let largest = contact
        .reference
        .iter()
        .map(|&x| norm(x))
        .fold(0.0, f64::max);
    let rounding = 16.0 * f64::EPSILON * (largest + norm(contact.origin));
    let (mut bridged, mut pressed) = (0.0, 0.0);
    let mut carried = 0.0;
    let (mut most, mut over_limit) = (0.0_f64, 0.0_f64);
    let acting = contact.state.points.iter().filter(|_| contact.state.acting);
    for (i, h) in acting.enumerate() {
        let (p, area) = (&contact.points[i], contact.area_of(i));
        let shear = norm(h.shear);
        if h.pressure > 0.0 {
            // The pressure of a law of the program is the law's; asking for its inverse would take long.
            let wanted = match contact.laws.user.normal {
                Some(_) => h.gap,
                None => law.gap(h.pressure - h.damping).value,
            };
            let over = (wanted - h.gap - rounding).max(0.0);
            let under = (h.gap - wanted - rounding).max(0.0);
            q.penetration = q.penetration.max(over);
            q.relative_to_size = q.relative_to_size.max(over / p.size);
            carried += area * h.pressure;
            bridged += area * h.pressure * under;
            pressed += area * h.pressure * p.size;
            if exact {
                q.violation_work += area * h.pressure * (over + under);
            }
        }
        if h.status == Status::Stick && sticks {
            let slid = h.moved;
            q.elastic_slip = q.elastic_slip.max(slid);
            // Springs that nothing removes hold what all increments have put into them.
            let left = match updated {
                true => slid,
                false => shear / h.stiffness[1],
            };
            q.violation_work += area * shear * left;
        }
        if h.status != Status::Open && friction.frictional() {
            most = most.max(h.limit);
            // Where the limit depends on the direction, the increment has judged it.
            over_limit = match friction.orthotropy() {
                None => over_limit.max(shear - h.limit),
                Some(_) => contact.state.cone.over,
            };
        }
    }
    let stiffness = pressed_stiffness(contact);
    if stiffness > 0.0 {
        q.layer = carried / stiffness;
    }
    q.pressed = pressed;
    q.limit = most;
    if pressed > 0.0 {
        q.complementarity = bridged / pressed;
    }
    if most > 0.0 {
        q.cone_violation = over_limit / most;
    }
    let cone = contact.state.cone;
    if cone.limit > 0.0 {
        q.friction_law = cone.worst / cone.limit;
    }
    q
}

/// The smallest stiffness of the enforcement in use, as a multiple of the bodies' own; `None` where nothing numerical is between the
/// laws and the solution, or nothing is in contact.
pub fn numerical_factor(contact: ContactView) -> Option<f64> {
    let points = contact.points.iter().zip(&contact.state.points);
    let closed = points.filter(|(_, h)| h.status != Status::Open);
    let ratio = closed.map(|(p, h)| h.stiffness[0].min(h.stiffness[1]) / p.stiffness);
    let least = ratio.fold(f64::INFINITY, f64::min);
    (least.is_finite() && !contact.state.springs).then_some(least)
}

/// Forces and moments on both sides at the last committed state, with displacements `u` of the mesh points. On an obstacle only one side is known:
/// nothing is summed.
pub fn balance(contact: ContactView, u: &[f64]) -> Balance {
    let mut b = Balance::default();
    if contact.rigid() || !contact.state.acting {
        return b;
    }
    let x = contact.coordinates(u);
    let origin = x.first().copied().unwrap_or_default();
    for (&x, &force) in x.iter().zip(&contact.state.nodal) {
        b.force = add(b.force, force);
        b.moment = add(b.moment, cross(sub(x, origin), force));
    }
    let mut low = [f64::INFINITY; 3];
    let mut high = [f64::NEG_INFINITY; 3];
    for (i, (point, h)) in contact.points.iter().zip(&contact.state.points).enumerate() {
        let place = point.position(&x);
        for c in 0..3 {
            low[c] = low[c].min(place[c]);
            high[c] = high[c].max(place[c]);
        }
        b.scale += contact.area_of(i) * h.pressure.hypot(norm(h.shear));
    }
    b.size = norm(sub(high, low));
    b
}

//! Output fields of an interface.

use super::table::law_states;
use super::values::{MEANS, shown_means, values};
use crate::contact::interface::view::ContactView;
use crate::math::{Vec3, add_scaled, scale};
use crate::system::{Fields, Location};

/// Sums at a node: of values times shares, and of shares; the largest share, and the status of the point that has it.
#[derive(Debug, Clone, Copy, Default)]
struct Sums {
    values: [f64; MEANS.len()],
    /// Normal, shear and slip.
    vectors: [Vec3; 3],
    share: f64,
    largest: f64,
    status: f64,
}

/// Adds the fields of the last committed state: CPRESS, CSHEAR1/2, COPEN, CSLIP1/2, CSTATUS (0 open, 1 stick, 2 slip) on both sides, of tied surfaces TNORMAL, positive in tension, and TSHEAR1/2 instead, CFORCE, the force on each node, and
/// what sliding leaves: CDISS and CWEAR. A value at a node is the mean of the points that hang on it or lie over it, weighted by
/// their areas there; where both surfaces are secondary only of those that hang on it, as slip and shear of the other half have the other sign. Where no
/// interface is the values are NaN, except for forces, which are zero.
pub fn fields(contact: ContactView, out: &mut Fields) {
    let (points, dim) = (contact.dofs.points, contact.dofs.dim);
    let sums = sums(contact);
    // A node of several interfaces shows the one that carries most there.
    let means = shown_means(contact);
    let field = out.shared(means[0].0, Location::Point, 1, points, f64::NAN);
    let shows = |(sum, node): &(&Sums, usize)| {
        let (carried, other) = (sum.values[0] / sum.share, field.values[*node]);
        sum.share > 0.0 && (other.is_nan() || carried.abs() >= other.abs())
    };
    let all = sums.iter().zip(contact.nodes.iter().copied());
    let shown: Vec<(&Sums, usize)> = all.filter(shows).collect();
    for (k, &(name, _)) in means.iter().enumerate() {
        if dim == 2 && name.ends_with('2') {
            continue;
        }
        let field = out.shared(name, Location::Point, 1, points, f64::NAN);
        for (sum, node) in &shown {
            field.values[*node] = sum.values[k] / sum.share;
        }
    }
    if !contact.laws.tied {
        let field = out.shared("CSTATUS", Location::Point, 1, points, f64::NAN);
        for (sum, node) in &shown {
            field.values[*node] = sum.status;
        }
    }
    let field = out.shared("CFORCE", Location::Point, 3, points, 0.0);
    for (&force, &node) in contact.state.nodal.iter().zip(&contact.nodes) {
        for (total, f) in field.values[3 * node..].iter_mut().zip(force) {
            *total += f;
        }
    }
    add_traces(contact, out);
}

/// Normal out of the primary, shear on the secondary `[Pa]` and slip `[m]` at each of [`nodes`](crate::contact::interface::InterfaceMesh::nodes), means as those of [`fields`]; zero where nothing lies opposite.
pub fn rubbing(contact: ContactView) -> Vec<[Vec3; 3]> {
    let mean = |sum: Sums| match sum.share > 0.0 {
        true => sum.vectors.map(|v| scale(1.0 / sum.share, v)),
        false => [[0.0; 3]; 3],
    };
    sums(contact).into_iter().map(mean).collect()
}

/// What points give to the nodes that they hang on or lie over.
fn sums(contact: ContactView) -> Vec<Sums> {
    let half = contact.share < 1.0;
    let mut sums = vec![Sums::default(); contact.nodes.len()];
    for i in 0..contact.state.points.len() {
        let values = values(contact, i);
        if !values.gap.is_finite() {
            continue;
        }
        let opposite = contact.state.opposite.of(i).iter().filter(|_| !half);
        for (node, w) in contact.own_weights(i).chain(opposite.copied()) {
            let share = values.share * w.max(0.0);
            if share <= 0.0 {
                continue;
            }
            let at = &mut sums[node];
            for (sum, (_, value)) in at.values.iter_mut().zip(shown_means(contact)) {
                *sum += share * value(&values);
            }
            let [_, shear, slip] = values.vectors;
            for (sum, v) in at.vectors.iter_mut().zip([values.normal, shear, slip]) {
                *sum = add_scaled(*sum, share, v);
            }
            at.share += share;
            if share > at.largest {
                (at.largest, at.status) = (share, values.status);
            }
        }
    }
    sums
}

/// Adds what sliding has left: CDISS, the energy dissipated per area `[J/m²]`, where there is friction, CWEAR, the depth worn off
/// `[m]`, where wear is followed, and the state variables of the friction law at the side with the points.
fn add_traces(contact: ContactView, out: &mut Fields) {
    let points = contact.dofs.points;
    let mut sums = vec![[0.0; 3]; contact.nodes.len()];
    for (i, h) in contact.state.points.iter().enumerate() {
        let area = contact.area_of(i);
        for (node, w) in contact.own_weights(i) {
            let share = area * w.max(0.0);
            sums[node][0] += share * h.dissipated;
            sums[node][1] += share * contact.state.worn.own_depth(i);
            sums[node][2] += share;
        }
    }
    let kinds = [
        ("CDISS", 0, contact.laws.friction_law().frictional()),
        ("CWEAR", 1, contact.laws.wear.as_dyn().active()),
    ];
    for (name, values) in law_states(contact) {
        let mut sums = vec![[0.0; 2]; contact.nodes.len()];
        for (i, value) in values.iter().enumerate() {
            for (node, w) in contact.own_weights(i) {
                let share = contact.area_of(i) * w.max(0.0);
                sums[node][0] += share * value;
                sums[node][1] += share;
            }
        }
        let field = out.shared(&name, Location::Point, 1, points, f64::NAN);
        for (sum, &node) in sums.iter().zip(&contact.nodes) {
            if sum[1] > 0.0 {
                field.values[node] = sum[0] / sum[1];
            }
        }
    }
    for (name, k, followed) in kinds {
        if !followed {
            continue;
        }
        let field = out.shared(name, Location::Point, 1, points, f64::NAN);
        for (sum, &node) in sums.iter().zip(&contact.nodes) {
            if sum[2] > 0.0 {
                field.values[node] = sum[k] / sum[2];
            }
        }
        for local in contact.primary_nodes() {
            field.values[contact.nodes[local]] = match k {
                0 => contact.state.dissipated.get(local).copied().unwrap_or(0.0),
                _ => contact.state.worn.opposite_depth(local),
            };
        }
    }
}

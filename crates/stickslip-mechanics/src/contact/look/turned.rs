//! By how much the surfaces have turned since the start: what small sliding leaves out.

use crate::contact::facet_point::evaluate;
use crate::contact::interface::Primary;
use crate::contact::interface::view::ContactView;
use crate::contact::surface::{Facet, turns};
use crate::math::{Vec3, add, angle, norm};

/// The largest angle by which the normal of a point that presses differs from what it is now, at displacements `u` `[rad]`; zero unless normals are those
/// of the reference configuration.
///
/// It has two parts: by how much the secondary has turned there, and by how much the primary turns over the path that the point has slid.
pub fn normals_turned(contact: ContactView, u: &[f64]) -> f64 {
    let points = &contact.state.points;
    let most = points.iter().map(|h| h.pressure).fold(0.0, f64::max);
    let turns = turns_of_normals(contact, u).into_iter();
    // Part of the largest pressure that counts as pressing.
    let pressed = turns.filter(|(i, _)| points[*i].pressure > 0.1 * most);
    pressed.map(|(_, turn)| turn).fold(0.0, f64::max)
}

/// Force that pressure has along the surfaces as they are now, as normals are those of the reference configuration, and what it is judged beside: the limit of friction, or the
/// force of pressure where there is none, `Σ A p sin θ` and `Σ A q` or `Σ A p` `[N]`; `None` unless normals are those of the reference configuration.
pub fn outdated_normals(contact: ContactView, u: &[f64]) -> Option<[f64; 2]> {
    let turns = turns_of_normals(contact, u);
    let frictional = contact.laws.friction_law().frictional();
    let sum = turns.iter().fold([0.0; 2], |[along, beside], &(i, turn)| {
        let h = &contact.state.points[i];
        let most = if frictional { h.limit } else { h.pressure };
        let area = contact.area_of(i);
        [along + area * h.pressure * turn.sin(), beside + area * most]
    });
    (!turns.is_empty()).then_some(sum)
}

/// The points that press, and by how much the normal of each differs from what it is now; none unless normals are those of the reference configuration.
fn turns_of_normals(contact: ContactView, u: &[f64]) -> Vec<(usize, f64)> {
    let committed = &contact.state.points;
    let frozen = contact.kinematics.as_dyn().frozen() && !contact.rigid() && !contact.laws.tied;
    if !frozen || committed.len() != contact.points.len() {
        return Vec::new();
    }
    let [before, now] =
        [&contact.reference, &contact.coordinates(u)].map(|x| mean_normals(contact, x));
    let bend = bend(contact);
    let pressed = (committed.iter().enumerate()).filter(|(_, h)| h.pressure > 0.0);
    pressed
        .map(|(i, h)| (i, angle(before[i], now[i]).max(bend * norm(h.slip))))
        .collect()
}

/// Sums of the normals of the faces around each point of the secondary.
fn mean_normals(contact: ContactView, x: &[Vec3]) -> Vec<Vec3> {
    let mut sums = vec![[0.0; 3]; contact.points.len()];
    for skin in &contact.skin {
        let nodes: Vec<Vec3> = skin.facet.nodes.iter().map(|&n| x[n]).collect();
        let [s, t, _] = skin.facet.kind.centre();
        let normal = evaluate(skin.facet.kind, &nodes, [s, t]).normal;
        for &p in &skin.points {
            sums[p] = add(sums[p], normal);
        }
    }
    sums
}

/// Mean curvature of the primary, edges of the body left out `[1/m]`.
fn bend(contact: ContactView) -> f64 {
    let Primary::Facets(facets) = &contact.primary else {
        return 0.0;
    };
    let facets: Vec<&Facet> = facets.iter().collect();
    let turns = turns(&facets, &contact.reference);
    let length = turns.iter().map(|t| t[1]).sum::<f64>();
    match length > 0.0 {
        true => turns.iter().map(|t| t[0]).sum::<f64>() / length,
        false => 0.0,
    }
}

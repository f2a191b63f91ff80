//! What an interface carries, and where.

use crate::contact::interface::view::ContactView;
use crate::contact::response::Status;
use crate::math::{Vec3, add, add_scaled, cross, norm, normalize, scale, sub};
use crate::system::Tally;
use crate::tolerance::SAME;

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
    /// Largest pressure; of tied surfaces the largest magnitude of the traction `[Pa]`.
    pub peak: f64,
    /// Where it is `[m]`, displaced; of points that are alike the first. The origin where nothing acts.
    pub peak_at: Vec3,
    /// Sum of the magnitudes of pressure forces, whatever their directions `[N]`.
    pub total: f64,
    /// The same of all forces, shear included `[N]`.
    pub carried: f64,
}

/// Forces on the secondary, as it is named, at the last committed state `u`.
pub fn resultant(contact: ContactView, u: &[f64]) -> Resultant {
    let x = contact.coordinates(u);
    let mut r = Resultant::default();
    // Tied surfaces pull as well as they press.
    let mut signed = 0.0;
    for (i, (p, h)) in contact.points.iter().zip(&contact.state.points).enumerate() {
        if h.status == Status::Open {
            continue;
        }
        let area = contact.area_of(i);
        let place = p.position(&x);
        let shear = scale(area, h.shear);
        r.shear = add(r.shear, shear);
        r.moment_of_shear = add(r.moment_of_shear, cross(place, shear));
        r.centre = add_scaled(r.centre, h.pressure * area, place);
        signed += h.pressure * area;
        r.total += h.pressure.abs() * area;
        let traction = h.pressure.hypot(norm(h.shear));
        r.carried += traction * area;
        r.area += area;
        let most = match contact.laws.tied {
            true => traction,
            false => h.pressure,
        };
        // What is larger by rounding only is no other place.
        // Pressures that differ by less are alike.
        if most > (1.0 + SAME) * r.peak {
            r.peak_at = add(place, contact.origin);
        }
        r.peak = r.peak.max(most);
    }
    // What nodes are given is the force: the mean of normals around a point is shorter than one, and multipliers are met to a tolerance.
    let mut all = [0.0; 3];
    for (&force, &place) in contact
        .state
        .nodal
        .iter()
        .zip(&x)
        .skip(contact.primary_nodes)
    {
        all = add(all, force);
        r.moment = add(r.moment, cross(place, force));
    }
    r.normal = sub(all, r.shear);
    // Where pressure and pull cancel each other, they have no centre.
    r.centre = match signed.abs() > SAME * r.total {
        true => add(scale(1.0 / signed, r.centre), contact.origin),
        false => [0.0; 3],
    };
    // As the user counts.
    r.moment = add(r.moment, cross(contact.origin, all));
    r.moment_of_shear = add(r.moment_of_shear, cross(contact.origin, r.shear));
    for v in [
        &mut r.normal,
        &mut r.shear,
        &mut r.moment,
        &mut r.moment_of_shear,
    ] {
        *v = scale(contact.named(), *v);
    }
    r
}

/// Points by what they did at the last committed state; `changed` is zero.
pub fn committed_tally(contact: ContactView) -> Tally {
    let mut tally = Tally::default();
    for point in &contact.state.points {
        *match point.status {
            Status::Open => &mut tally.open,
            Status::Stick => &mut tally.stick,
            Status::Slip => &mut tally.slip,
        } += 1;
    }
    tally
}

/// The points in contact at the last committed state.
pub fn closed(contact: ContactView) -> Vec<usize> {
    let points = contact.state.points.iter().enumerate();
    let closed = points.filter(|(_, h)| h.status != Status::Open);
    closed.map(|(i, _)| i).collect()
}

/// Area that slides and area in contact, at the last committed state `[m²]`.
pub fn sliding_area(contact: ContactView) -> [f64; 2] {
    let mut areas = [0.0; 2];
    let frictional = contact.laws.friction_law().frictional();
    for (i, h) in contact.state.points.iter().enumerate() {
        if h.status != Status::Open {
            let slides = h.status == Status::Slip || !frictional;
            areas[0] += if slides { contact.area_of(i) } else { 0.0 };
            areas[1] += contact.area_of(i);
        }
    }
    areas
}

/// Centre of the area in contact at the displacements `u` `[m]`, and the mean outward normal of the secondary there; zero where nothing touches.
pub fn centre_and_normal(contact: ContactView, u: &[f64]) -> (Vec3, Vec3) {
    let x = contact.coordinates(u);
    let (mut centre, mut normal, mut area) = ([0.0; 3], [0.0; 3], 0.0);
    for (i, (p, h)) in contact.points.iter().zip(&contact.state.points).enumerate() {
        if h.status != Status::Open {
            centre = add_scaled(centre, contact.area_of(i), p.position(&x));
            // Pressure pushes the secondary along the normal of the primary.
            normal = add_scaled(normal, -contact.area_of(i), h.normal);
            area += contact.area_of(i);
        }
    }
    if area > 0.0 {
        centre = add(scale(1.0 / area, centre), contact.origin);
    }
    let normal = normalize(normal).unwrap_or_default();
    (centre, scale(contact.named(), normal))
}

//! What is shown of a contact point, in fields and in the table: one list of names and values.

use crate::contact::interface::view::ContactView;
use crate::contact::response::Status;
use crate::math::{Vec3, add_scaled, cross, dot, normalize, scale};

/// Values at a point at the last committed state, of the sides as they are named.
#[derive(Debug, Clone, Copy)]
pub(super) struct PointValues {
    pub pressure: f64,
    /// Shear on the secondary and slip of it along the two output directions.
    pub shear: [f64; 2],
    pub slip: [f64; 2],
    pub gap: f64,
    /// Out of the primary.
    pub normal: Vec3,
    /// What acts on the secondary `[Pa]`, its shear alone, and the slip, as vectors.
    pub vectors: [Vec3; 3],
    /// 0 open, 1 stick, 2 slip.
    pub status: f64,
    pub area: f64,
    /// What it counts in means at nodes: its area, and without a multiplier that of its node.
    pub share: f64,
}

/// A name and the value that goes by it.
pub(super) type Shown = (&'static str, fn(&PointValues) -> f64);

/// What is shown of contact as a mean at nodes.
pub(super) const MEANS: [Shown; 6] = [
    ("CPRESS", |v| v.pressure),
    ("CSHEAR1", |v| v.shear[0]),
    ("CSHEAR2", |v| v.shear[1]),
    ("COPEN", |v| v.gap),
    ("CSLIP1", |v| v.slip[0]),
    ("CSLIP2", |v| v.slip[1]),
];

/// What is shown of tied surfaces as a mean at nodes: they pull as well as they press, and neither part nor slide.
const TRACTIONS: [Shown; 3] = [
    ("TNORMAL", |v| -v.pressure),
    ("TSHEAR1", |v| v.shear[0]),
    ("TSHEAR2", |v| v.shear[1]),
];

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

/// What is shown as a mean at nodes.
pub(super) fn shown_means(contact: ContactView) -> &'static [Shown] {
    match contact.laws.tied {
        true => &TRACTIONS,
        false => &MEANS,
    }
}

/// What is shown of a point. One without a multiplier, as its motion is given, shows what the one of those that took its part has that presses most.
pub(super) fn values(contact: ContactView, i: usize) -> PointValues {
    let own = own_values(contact, i);
    let heirs = (contact.mortar.as_ref()).map_or(&[][..], |mortar| mortar.merged.heirs(i));
    let of = heirs.iter().map(|&(k, _)| own_values(contact, k));
    // Over nothing there is nothing to show.
    let of = of.filter(|v| v.gap.is_finite());
    match of.max_by(|a, b| a.pressure.abs().total_cmp(&b.pressure.abs())) {
        Some(heir) => PointValues {
            normal: own.normal,
            area: own.area,
            share: contact.points[i].area * contact.share,
            ..heir
        },
        None => own,
    }
}

/// What a point itself has.
fn own_values(contact: ContactView, i: usize) -> PointValues {
    let h = &contact.state.points[i];
    let normal = match h.normal == [0.0; 3] {
        true => scale(-1.0, contact.points[i].normal),
        false => h.normal,
    };
    let [normal, shear, slip] = [normal, h.shear, h.slip].map(|v| scale(contact.named(), v));
    let frame = output_frame(normal, contact.dofs.dim);
    PointValues {
        pressure: h.pressure,
        shear: frame.map(|e| dot(shear, e)),
        slip: frame.map(|e| dot(slip, e)),
        gap: h.gap,
        normal,
        vectors: [add_scaled(shear, h.pressure, normal), shear, slip],
        status: match h.status {
            Status::Open => 0.0,
            Status::Stick => 1.0,
            Status::Slip => 2.0,
        },
        area: contact.area_of(i),
        share: contact.area_of(i),
    }
}

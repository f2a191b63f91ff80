//! Axes of materials and nodes, from vectors and `*TRANSFORM`s.

use stickslip::math::{add_scaled, cross, dot, normalize, sub};

use crate::deck::Transform;

/// Orthonormal axes from a vector along the first and one in the plane of the first two.
pub(crate) fn frame(a: [f64; 3], b: [f64; 3]) -> Option<[[f64; 3]; 3]> {
    let one = normalize(a)?;
    let three = normalize(cross(one, b))?;
    Some([one, cross(three, one), three])
}

/// The local axes of a node in a `*TRANSFORM`.
pub(crate) fn at_node(t: &Transform, x: [f64; 3]) -> Option<[[f64; 3]; 3]> {
    if !t.cylindrical {
        return frame(t.a, t.b);
    }
    let axial = normalize(sub(t.b, t.a))?;
    let arm = sub(x, t.a);
    let radial = normalize(add_scaled(arm, -dot(arm, axial), axial))?;
    Some([radial, cross(axial, radial), axial])
}

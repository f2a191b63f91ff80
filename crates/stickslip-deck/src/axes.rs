//! Axes of materials and nodes, from vectors and `*TRANSFORM`s.

use stickslip::math::{add_scaled, cross, dot, normalize, sub};

/// `*TRANSFORM`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Transform {
    /// Cylindrical (radial, tangential, axial) about the line from `a` to `b`; otherwise `a` is a point of the local x axis and `b` one of the xy plane.
    pub cylindrical: bool,
    /// First point.
    pub a: [f64; 3],
    /// Second point.
    pub b: [f64; 3],
}

/// Local axes.
#[derive(Debug, Clone, PartialEq)]
pub enum Local {
    /// The same everywhere; rows are the axes.
    Axes([[f64; 3]; 3]),
    /// Radial, tangential and axial about the line through two points.
    Cylinder([[f64; 3]; 2]),
}

impl Local {
    /// The axes at a place; `None` on the axis of a cylinder.
    pub(crate) fn at(&self, x: [f64; 3]) -> Option<[[f64; 3]; 3]> {
        match self {
            Local::Axes(axes) => Some(*axes),
            Local::Cylinder([a, b]) => cylindrical(*a, *b, x),
        }
    }
}

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
    cylindrical(t.a, t.b, x)
}

/// Radial, tangential and axial direction about the line from `a` to `b`.
pub(crate) fn cylindrical(a: [f64; 3], b: [f64; 3], x: [f64; 3]) -> Option<[[f64; 3]; 3]> {
    let axial = normalize(sub(b, a))?;
    let arm = sub(x, a);
    let radial = normalize(add_scaled(arm, -dot(arm, axial), axial))?;
    Some([radial, cross(axial, radial), axial])
}

/// Radius, angle in degrees from x to y, and z as x, y and z.
pub(crate) fn polar([r, degrees, z]: [f64; 3]) -> [f64; 3] {
    let (s, c) = sine_and_cosine(degrees);
    [r * c, r * s, z]
}

/// Exact at right angles, so that what is turned by them stays along the axes.
pub(crate) fn sine_and_cosine(degrees: f64) -> (f64, f64) {
    match degrees.rem_euclid(360.0) {
        0.0 => (0.0, 1.0),
        90.0 => (1.0, 0.0),
        180.0 => (0.0, -1.0),
        270.0 => (-1.0, 0.0),
        _ => degrees.to_radians().sin_cos(),
    }
}

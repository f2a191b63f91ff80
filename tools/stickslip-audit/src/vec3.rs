//! Vectors of three components.

/// A vector; in the plane the third component is zero.
pub type Vec3 = [f64; 3];

/// `a + b`
pub fn add(a: Vec3, b: Vec3) -> Vec3 {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

/// `a - b`
pub fn sub(a: Vec3, b: Vec3) -> Vec3 {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// `s a`
pub fn scale(s: f64, a: Vec3) -> Vec3 {
    a.map(|x| s * x)
}

/// `a + s b`
pub fn along(a: Vec3, s: f64, b: Vec3) -> Vec3 {
    add(a, scale(s, b))
}

/// `a · b`
pub fn dot(a: Vec3, b: Vec3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// `a × b`
pub fn cross(a: Vec3, b: Vec3) -> Vec3 {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// `|a|`
pub fn norm(a: Vec3) -> f64 {
    dot(a, a).sqrt()
}

/// `a / |a|`; the vector itself where it is zero.
pub fn unit(a: Vec3) -> Vec3 {
    match norm(a) {
        0.0 => a,
        length => scale(1.0 / length, a),
    }
}

/// What is left of `a` without its part along the unit vector `n`.
pub fn tangential(a: Vec3, n: Vec3) -> Vec3 {
    along(a, -dot(a, n), n)
}

/// `a` turned by an angle about a unit axis, counter-clockwise: the formula of Rodrigues (Goldstein 1980, eq. 4-92).
pub fn turned(a: Vec3, axis: Vec3, angle: f64) -> Vec3 {
    let (s, c) = angle.sin_cos();
    let with = scale(c, a);
    let across = along(with, s, cross(axis, a));
    along(across, (1.0 - c) * dot(axis, a), axis)
}

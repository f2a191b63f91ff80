//! The eight modes of a hexahedron: 1, ξ, η, ζ, ξη, ηζ, ζξ, ξηζ.
//!
//! A trilinear field is a sum of them, and its derivative by ξ is `a_ξ + a_ξη η + a_ζξ ζ + a_ξηζ ηζ`: additions only
//! at the points of the 2×2×2 rule, once the mixed coefficients are multiplied by the coordinate `1/√3` of the points.
//! What follows from the values at the nodes is left eight times too large; the laws of the kernels make up for it.

use pulp::Simd;

use super::lane::{Lane, Nodes};
use super::tensor::Vector;
use crate::shape::gauss::ROOT_THIRD;

/// Coefficients of the modes in the order of this file, eight times those of the field, mixed ones times `1/√3` a
/// coordinate beyond the first.
pub type Modes<S> = [Lane<S>; 8];

/// From the values at the nodes of component `i`.
#[inline(always)]
pub fn modes<S: Simd>(simd: S, part: usize, nodes: &Nodes<8, 3>, i: usize) -> Modes<S> {
    let zero = Lane::splat(simd, 0.0);
    let mut n = [zero; 8];
    for a in 0..8 {
        n[a] = Lane::load(simd, &nodes[a][i], part);
    }
    // Sums and differences along ξ, then η (below and above), then ζ.
    let (s, d) = (
        [n[0] + n[1], n[3] + n[2], n[4] + n[5], n[7] + n[6]],
        [n[1] - n[0], n[2] - n[3], n[5] - n[4], n[6] - n[7]],
    );
    let (ss, sd) = ([s[0] + s[1], s[2] + s[3]], [s[1] - s[0], s[3] - s[2]]);
    let (ds, dd) = ([d[0] + d[1], d[2] + d[3]], [d[1] - d[0], d[3] - d[2]]);
    let point = Lane::splat(simd, ROOT_THIRD);
    let third = Lane::splat(simd, 1.0 / 3.0);
    [
        ss[0] + ss[1],
        ds[0] + ds[1],
        sd[0] + sd[1],
        ss[1] - ss[0],
        point * (dd[0] + dd[1]),
        point * (sd[1] - sd[0]),
        point * (ds[1] - ds[0]),
        third * (dd[1] - dd[0]),
    ]
}

/// The transpose of [`modes`]: writes the forces at the nodes that belong to the forces `m` on the modes. The force on
/// the constant mode is zero in equilibrium and not asked for.
#[inline(always)]
pub fn store_nodes<S: Simd>(simd: S, part: usize, m: &Modes<S>, nodes: &mut Nodes<8, 3>, i: usize) {
    let point = Lane::splat(simd, ROOT_THIRD);
    let third = Lane::splat(simd, 1.0 / 3.0);
    let (xy, yz, zx, xyz) = (point * m[4], point * m[5], point * m[6], third * m[7]);
    let zero = Lane::splat(simd, 0.0);
    let layers = [
        (zero - m[3], m[2] - yz, m[1] - zx, xy - xyz),
        (m[3], m[2] + yz, m[1] + zx, xy + xyz),
    ];
    for (layer, (ss, sd, ds, dd)) in layers.into_iter().enumerate() {
        let a = 4 * layer;
        let (s, d) = (ss - sd, ds - dd);
        (s - d).store(&mut nodes[a][i], part);
        (s + d).store(&mut nodes[a + 1][i], part);
        let (s, d) = (ss + sd, ds + dd);
        (s + d).store(&mut nodes[a + 2][i], part);
        (s - d).store(&mut nodes[a + 3][i], part);
    }
}

/// Derivatives of a component by each reference coordinate at the points of the rule. They do not depend on that
/// coordinate: four values each, numbered as by [`place`].
pub type Derivatives<S> = [[Lane<S>; 4]; 3];

/// Which of the four values of the derivative by each coordinate belongs to point `q` of the rule, ξ running fastest.
#[inline(always)]
pub fn place(q: usize) -> [usize; 3] {
    let (x, y, z) = (q & 1, q >> 1 & 1, q >> 2);
    [y + 2 * z, x + 2 * z, x + 2 * y]
}

/// From the modes of the component.
#[inline(always)]
pub fn derivatives<S: Simd>(m: &Modes<S>) -> Derivatives<S> {
    // `four(a, b, c, d)` is `a ± b ± c ± d`, the first sign of b, the second of c, their product that of d.
    [
        four(m[1], m[4], m[6], m[7]),
        four(m[2], m[4], m[5], m[7]),
        four(m[3], m[6], m[5], m[7]),
    ]
}

/// The transpose of [`derivatives`]; the constant mode, which they do not see, gets `zero`.
#[inline(always)]
pub fn gather_modes<S: Simd>(zero: Lane<S>, d: &Derivatives<S>) -> Modes<S> {
    let [x, y, z] = [
        four_transposed(&d[0]),
        four_transposed(&d[1]),
        four_transposed(&d[2]),
    ];
    [
        zero,
        x[0],
        y[0],
        z[0],
        x[1] + y[1],
        y[2] + z[2],
        x[2] + z[1],
        x[3] + y[3] + z[3],
    ]
}

#[inline(always)]
fn four<S: Simd>(a: Lane<S>, b: Lane<S>, c: Lane<S>, d: Lane<S>) -> [Lane<S>; 4] {
    let (a, b) = ([a - c, a + c], [b - d, b + d]);
    [a[0] - b[0], a[0] + b[0], a[1] - b[1], a[1] + b[1]]
}

#[inline(always)]
fn four_transposed<S: Simd>(v: &[Lane<S>; 4]) -> [Lane<S>; 4] {
    let (a, b) = ([v[0] + v[1], v[2] + v[3]], [v[1] - v[0], v[3] - v[2]]);
    [a[0] + a[1], b[0] + b[1], a[1] - a[0], b[1] - b[0]]
}

/// The derivatives of three components at one point, by reference coordinate.
#[inline(always)]
pub fn at<S: Simd>(d: &[Derivatives<S>; 3], place: [usize; 3]) -> [Vector<S, 3>; 3] {
    let mut columns = [[d[0][0][0]; 3]; 3];
    for k in 0..3 {
        for i in 0..3 {
            columns[k][i] = d[i][k][place[k]];
        }
    }
    columns
}

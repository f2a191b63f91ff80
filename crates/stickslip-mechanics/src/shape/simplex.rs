//! The quadratic shape functions of triangles and tetrahedra in barycentric coordinates: `L (2 L - 1)` at a corner,
//! `4 L_i L_j` at the middle of the edge `ij`.

/// The barycentric coordinates `L_0 = 1 - ξ - η - ζ`, `ξ`, `η`, `ζ`; with `xi[2] = 0` those of a triangle come first.
pub(super) fn barycentric(xi: [f64; 3]) -> [f64; 4] {
    [1.0 - xi[0] - xi[1] - xi[2], xi[0], xi[1], xi[2]]
}

/// Values; the corners are as many as `n` has entries beyond the edges.
pub(super) fn values(l: &[f64; 4], edges: &[[usize; 2]], n: &mut [f64]) {
    let corners = n.len() - edges.len();
    for (i, n) in n[..corners].iter_mut().enumerate() {
        *n = l[i] * (2.0 * l[i] - 1.0);
    }
    for (n, &[i, j]) in n[corners..].iter_mut().zip(edges) {
        *n = 4.0 * l[i] * l[j];
    }
}

/// Gradients, given those of the barycentric coordinates.
pub(super) fn gradients(l: &[f64; 4], dl: &[[f64; 3]], edges: &[[usize; 2]], d: &mut [[f64; 3]]) {
    let corners = d.len() - edges.len();
    for (i, d) in d[..corners].iter_mut().enumerate() {
        *d = dl[i].map(|x| (4.0 * l[i] - 1.0) * x);
    }
    for (d, &[i, j]) in d[corners..].iter_mut().zip(edges) {
        *d = std::array::from_fn(|a| 4.0 * (l[i] * dl[j][a] + l[j] * dl[i][a]));
    }
}

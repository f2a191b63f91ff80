//! Functions of the multipliers.

use super::face::FACE_NODES;
use crate::math::{Vec3, add_scaled, cross, norm};
use crate::shape::{ElementKind, mass_rule};

/// Part of the function of a middle node that its corners take over.
///
/// A corner of a quadratic face has no area of its own or a negative one. With a fifth of its middle nodes all areas are positive, and
/// the functions span the same space ([Popp et al. 2012](stickslip_base::references::popp_2012)).
const CORNER_SHARE: f64 = 0.2;

/// One number each pair of nodes.
pub type Matrix = [[f64; FACE_NODES]; FACE_NODES];

/// Shape functions to functions whose integrals are positive: `N_corner + α Σ N_middle`, `(1 - 2α) N_middle`.
pub fn positive(kind: ElementKind, n: &mut [f64; FACE_NODES]) {
    if kind.order() == 1 {
        return;
    }
    let corners = kind.corner_count();
    if kind.dim() == 1 {
        n[0] += CORNER_SHARE * n[2];
        n[1] += CORNER_SHARE * n[2];
        n[2] *= 1.0 - 2.0 * CORNER_SHARE;
        return;
    }
    for k in 0..corners {
        let middle = n[corners + k];
        n[k] += CORNER_SHARE * middle;
        n[(k + 1) % corners] += CORNER_SHARE * middle;
    }
    for middle in &mut n[corners..2 * corners] {
        *middle *= 1.0 - 2.0 * CORNER_SHARE;
    }
}

/// The mean over the faces around the node `k` of a face, weighted by its dual function: nodes, its own first, and their weights.
///
/// `∫ Φ_k N_i` over `∫ Φ_k`, where Φ is dual to the functions `positive` makes, `N̂`: with `N` written in `N̂`, `N_middle = N̂_middle / (1 - 2α)` and
/// `N_corner = N̂_corner - α / (1 - 2α) Σ N̂_middle`, only the node itself and, of one in the middle of an edge, the corners of that edge take part, whatever the shape of the
/// faces.
pub fn mean_weights(kind: ElementKind, k: usize) -> (Vec<usize>, Vec<f64>) {
    let corners = kind.corner_count();
    if k < corners {
        return (vec![k], vec![1.0]);
    }
    let ends = match kind.dim() {
        1 => [0, 1],
        _ => [k - corners, (k - corners + 1) % corners],
    };
    let rest = 1.0 - 2.0 * CORNER_SHARE;
    (
        vec![k, ends[0], ends[1]],
        vec![1.0 / rest, -CORNER_SHARE / rest, -CORNER_SHARE / rest],
    )
}

/// The area that the point at each node stands for, of a face with nodes at `x` and this extent out of the plane by place.
pub fn positive_areas(kind: ElementKind, x: &[Vec3], extent: impl Fn(Vec3) -> f64) -> Vec<f64> {
    let n = kind.node_count();
    let mut areas = vec![0.0; n];
    for q in mass_rule(kind) {
        let mut v = [0.0; FACE_NODES];
        let mut d = [[0.0; 3]; FACE_NODES];
        kind.reference().values(q.xi, &mut v[..n]);
        kind.reference().gradients(q.xi, &mut d[..n]);
        let (mut place, mut a, mut b) = ([0.0; 3], [0.0; 3], [0.0; 3]);
        for (k, &x) in x.iter().enumerate() {
            place = add_scaled(place, v[k], x);
            a = add_scaled(a, d[k][0], x);
            b = add_scaled(b, d[k][1], x);
        }
        let measure = if kind.dim() == 1 {
            norm(a)
        } else {
            norm(cross(a, b))
        };
        positive(kind, &mut v);
        for (area, v) in areas.iter_mut().zip(v) {
            *area += q.weight * measure * extent(place) * v;
        }
    }
    areas
}

/// The matrix `A` of the dual functions `Φ = A N̂`: `A = D M⁻¹` with `M = ∫ N̂ N̂ᵀ` and `D` the diagonal of its row sums. `None` where the part of the
/// face is so small that `M` is singular.
pub fn dual(m: &Matrix, n: usize) -> Option<Matrix> {
    // Cholesky of M scaled to a unit diagonal, then A = D M⁻¹ row by row.
    let mut scale = [0.0; FACE_NODES];
    for (k, s) in scale.iter_mut().enumerate().take(n) {
        if m[k][k] <= 0.0 {
            return None;
        }
        *s = 1.0 / m[k][k].sqrt();
    }
    let mut l = [[0.0; FACE_NODES]; FACE_NODES];
    for i in 0..n {
        for j in 0..=i {
            let mut sum = m[i][j] * scale[i] * scale[j];
            let known = l[i][..j].iter().zip(&l[j][..j]);
            sum -= known.map(|(a, b)| a * b).sum::<f64>();
            if i == j {
                if sum < 1e-13 {
                    return None;
                }
                l[i][i] = sum.sqrt();
            } else {
                l[i][j] = sum / l[j][j];
            }
        }
    }
    let mut a = [[0.0; FACE_NODES]; FACE_NODES];
    for row in 0..n {
        let d: f64 = m[row][..n].iter().sum();
        let mut x = [0.0; FACE_NODES];
        x[row] = d * scale[row];
        for i in 0..n {
            let known: f64 = (0..i).map(|k| l[i][k] * x[k]).sum();
            x[i] = (x[i] - known) / l[i][i];
        }
        for i in (0..n).rev() {
            let known: f64 = (i + 1..n).map(|k| l[k][i] * x[k]).sum();
            x[i] = (x[i] - known) / l[i][i];
        }
        for i in 0..n {
            a[row][i] = x[i] * scale[i];
        }
    }
    Some(a)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dual_functions_are_dual_and_add_up_to_one() {
        for kind in [
            ElementKind::Line2,
            ElementKind::Line3,
            ElementKind::Tri3,
            ElementKind::Tri6,
            ElementKind::Quad4,
            ElementKind::Quad8,
        ] {
            let n = kind.node_count();
            let at = |xi: [f64; 3]| {
                let mut v = [0.0; FACE_NODES];
                kind.reference().values(xi, &mut v[..n]);
                positive(kind, &mut v);
                v
            };
            let mut m = Matrix::default();
            let rule = mass_rule(kind);
            for q in &rule {
                let v = at(q.xi);
                for i in 0..n {
                    for j in 0..n {
                        m[i][j] += q.weight * v[i] * v[j];
                    }
                }
            }
            let a = dual(&m, n).unwrap();
            let area = |i: usize| m[i][..n].iter().sum::<f64>();
            for q in &rule {
                let v = at(q.xi);
                let phi = |i: usize| (0..n).map(|k| a[i][k] * v[k]).sum::<f64>();
                assert!(((0..n).map(phi).sum::<f64>() - 1.0).abs() < 1e-12, "{kind}");
            }
            for (i, row) in a.iter().enumerate().take(n) {
                assert!(area(i) > 0.0, "{kind}");
                for j in 0..n {
                    let product: f64 = row.iter().zip(&m).take(n).map(|(a, m)| a * m[j]).sum();
                    let expected = if i == j { area(i) } else { 0.0 };
                    assert!((product - expected).abs() < 1e-12, "{kind} {i} {j}");
                }
            }
        }
    }
}

//! The largest eigenvalue of an operator divided by its block diagonal.

use super::blocks::Block;

/// Factor by which the largest eigenvalue may exceed its estimate, which comes from below: ten steps of Lanczos' method are within a tenth of it in the test
/// below. With 0.9 to 1.4 in its place the example `rough-block` takes 25 or 26 iterations and keeps its expected values.
const ESTIMATE_MARGIN: f64 = 1.1;

/// The product of a matrix with a vector: what to multiply, and the result.
type Product<'a, const B: usize> = dyn FnMut(&[[f64; B]], &mut [[f64; B]]) + 'a;

/// An upper estimate of the largest eigenvalue of `D⁻¹ A`, for the product with a symmetric positive semidefinite `A`
/// and the inverse blocks of `D`: conjugate gradients from a fixed vector, whose coefficients make Lanczos' matrix.
pub(super) fn largest<const B: usize>(
    product: &mut Product<B>,
    inverse: &[Block<f64, B, B>],
    steps: usize,
) -> f64 {
    let n = inverse.len();
    let divide = |r: &[[f64; B]]| -> Vec<[f64; B]> {
        let rows = inverse.iter().zip(r);
        rows.map(|(d, r)| d.map(|line| line.iter().zip(r).map(|(d, r)| d * r).sum()))
            .collect()
    };
    // Sums run on one thread, in order.
    let dot = |a: &[[f64; B]], b: &[[f64; B]]| -> f64 {
        let pairs = a.as_flattened().iter().zip(b.as_flattened());
        pairs.map(|(a, b)| a * b).sum()
    };
    // A start with all frequencies, scaled like a residual so that no node dominates.
    let mut state = 12_345_u64;
    let mut r: Vec<[f64; B]> = inverse
        .iter()
        .map(|d| {
            std::array::from_fn(|c| {
                state = state
                    .wrapping_mul(6364136223846793005)
                    .wrapping_add(1442695040888963407);
                let noise = (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0;
                if d[c][c] > 0.0 {
                    noise / d[c][c].sqrt()
                } else {
                    0.0
                }
            })
        })
        .collect();
    let mut z = divide(&r);
    let mut p = z.clone();
    let mut q = vec![[0.0; B]; n];
    let mut rz = dot(&r, &z);
    let (mut diagonal, mut beside): (Vec<f64>, Vec<f64>) = (Vec::new(), Vec::new());
    let mut last = (0.0, 0.0);
    for _ in 0..steps {
        product(&p, &mut q);
        let pq = dot(&p, &q);
        if !(rz > 0.0 && pq > 0.0) {
            break;
        }
        let alpha = rz / pq;
        // Entries of Lanczos' matrix: 1/α_k + β_k-1/α_k-1 and sqrt(β_k)/α_k.
        let (alpha_before, beta_before): (f64, f64) = last;
        let carried = if diagonal.is_empty() {
            0.0
        } else {
            beta_before / alpha_before
        };
        diagonal.push(1.0 / alpha + carried);
        for (r, q) in r.as_flattened_mut().iter_mut().zip(q.as_flattened()) {
            *r -= alpha * q;
        }
        z = divide(&r);
        let next = dot(&r, &z);
        let beta = next / rz;
        beside.push(beta.max(0.0).sqrt() / alpha);
        for (p, z) in p.as_flattened_mut().iter_mut().zip(z.as_flattened()) {
            *p = z + beta * *p;
        }
        (rz, last) = (next, (alpha, beta));
    }
    ESTIMATE_MARGIN * largest_of_tridiagonal(&diagonal, &beside).max(1.0)
}

/// The largest eigenvalue of a symmetric tridiagonal matrix, by bisection on the signs of its pivots.
fn largest_of_tridiagonal(diagonal: &[f64], beside: &[f64]) -> f64 {
    let n = diagonal.len();
    let radius = |i: usize| {
        let left = if i > 0 { beside[i - 1].abs() } else { 0.0 };
        let right = if i + 1 < n { beside[i].abs() } else { 0.0 };
        diagonal[i].abs() + left + right
    };
    let mut high = (0..n).map(radius).fold(0.0, f64::max);
    let mut low = 0.0;
    for _ in 0..40 {
        let middle = 0.5 * (low + high);
        // All pivots of `T - middle` negative: no eigenvalue above.
        let mut pivot = -1.0;
        let below = (0..n).all(|i| {
            let coupling = if i > 0 {
                beside[i - 1] * beside[i - 1]
            } else {
                0.0
            };
            pivot = diagonal[i] - middle - coupling / pivot;
            pivot < 0.0
        });
        if below {
            high = middle;
        } else {
            low = middle;
        }
    }
    high
}

#[cfg(test)]
mod tests {
    use super::{ESTIMATE_MARGIN, largest};

    #[test]
    fn finds_the_top_of_a_known_spectrum() {
        // Second differences: eigenvalues 2 - 2 cos(k π / (n + 1)), divided by the diagonal 2.
        let n = 40;
        let mut product = |x: &[[f64; 1]], y: &mut [[f64; 1]]| {
            for i in 0..n {
                let left = if i > 0 { x[i - 1][0] } else { 0.0 };
                let right = if i + 1 < n { x[i + 1][0] } else { 0.0 };
                y[i][0] = 2.0 * x[i][0] - left - right;
            }
        };
        let exact = 1.0 - (n as f64 * std::f64::consts::PI / (n + 1) as f64).cos();
        let found = largest(&mut product, &vec![[[0.5]]; n], 40) / ESTIMATE_MARGIN;
        assert!((found / exact - 1.0).abs() < 1e-6, "{found} {exact}");
        let early = largest(&mut product, &vec![[[0.5]]; n], 10) / ESTIMATE_MARGIN;
        assert!(early < exact && early > 0.9 * exact, "{early} {exact}");
    }
}

//! Vectors and blocks of one point: two or three components.

/// The Euclidean norm.
pub fn norm(x: &[f64]) -> f64 {
    x.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// Solves `a x = b` of up to three rows by elimination with row exchanges; `None` where `a` is singular to rounding.
pub fn solve(d: usize, mut a: [f64; 9], mut b: [f64; 3]) -> Option<[f64; 3]> {
    let size = a[..d * d].iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    for k in 0..d {
        let best = (k..d).max_by(|&i, &j| a[i * d + k].abs().total_cmp(&a[j * d + k].abs()))?;
        // not a number is no pivot either
        // A block with a pivot below this part of its largest entry counts as singular.
        if a[best * d + k].abs().partial_cmp(&(1e-13 * size)) != Some(std::cmp::Ordering::Greater) {
            return None;
        }
        for c in 0..d {
            a.swap(k * d + c, best * d + c);
        }
        b.swap(k, best);
        for i in k + 1..d {
            let factor = a[i * d + k] / a[k * d + k];
            for c in k..d {
                a[i * d + c] -= factor * a[k * d + c];
            }
            b[i] -= factor * b[k];
        }
    }
    for k in (0..d).rev() {
        let known: f64 = (k + 1..d).map(|c| a[k * d + c] * b[c]).sum();
        b[k] = (b[k] - known) / a[k * d + k];
    }
    Some(b)
}

//! Vectors of any length.

use rayon::prelude::*;

/// Entries of a long vector that one task works on; fixed, so that results never depend on the number of threads.
pub const ENTRIES_PER_TASK: usize = 8192;

/// The scalar product, entry by entry in order.
#[inline]
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// `a - b`.
pub fn difference(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a - b).collect()
}

/// `first a + (1 - first) b`.
pub fn weighted_mean(first: f64, a: &[f64], b: &[f64]) -> Vec<f64> {
    let both = a.iter().zip(b);
    both.map(|(a, b)| first * a + (1.0 - first) * b).collect()
}

/// The Euclidean norm.
#[inline]
pub fn norm(a: &[f64]) -> f64 {
    dot(a, a).sqrt()
}

/// The scalar product in four sums at once, over the shorter of both: that keeps the processor busy and the rounding low.
#[inline]
pub fn dot_in_fours(a: &[f64], b: &[f64]) -> f64 {
    let length = a.len().min(b.len());
    let (fours_a, rest_a) = a[..length].as_chunks::<4>();
    let (fours_b, rest_b) = b[..length].as_chunks::<4>();
    let mut sums = [0.0; 4];
    for (a, b) in fours_a.iter().zip(fours_b) {
        for k in 0..4 {
            sums[k] += a[k] * b[k];
        }
    }
    sums[0] + sums[1] + (sums[2] + sums[3]) + dot(rest_a, rest_b)
}

/// The scalar product of long vectors, on all threads.
pub fn par_dot(a: &[f64], b: &[f64]) -> f64 {
    let parts: Vec<f64> = a
        .par_chunks(ENTRIES_PER_TASK)
        .zip(b.par_chunks(ENTRIES_PER_TASK))
        .map(|(a, b)| dot_in_fours(a, b))
        .collect();
    parts.iter().sum()
}

/// The Euclidean norm of a long vector, on all threads.
pub fn par_norm(a: &[f64]) -> f64 {
    par_dot(a, a).sqrt()
}

#[cfg(test)]
mod tests {
    use super::{ENTRIES_PER_TASK, dot, dot_in_fours, norm, par_dot, par_norm};

    #[test]
    fn long_vectors_are_those_of_one_task() {
        let a: Vec<f64> = (0..2 * ENTRIES_PER_TASK + 7)
            .map(|i| f64::from(i as u8))
            .collect();
        let b: Vec<f64> = a.iter().map(|a| 3.0 - a).collect();
        assert_eq!(par_dot(&a, &b), dot(&a, &b));
        assert_eq!(par_norm(&a), norm(&a));
    }

    #[test]
    fn sums_in_fours_are_those_in_order() {
        for length in 0..11 {
            let a: Vec<f64> = (0..length).map(|i| f64::from(i) - 3.0).collect();
            let b: Vec<f64> = (0..length + 1).map(|i| f64::from(i * i)).collect();
            assert_eq!(dot_in_fours(&a, &b), dot(&a, &b));
            assert_eq!(norm(&a).powi(2).round(), dot(&a, &a));
        }
    }
}

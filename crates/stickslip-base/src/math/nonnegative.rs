//! Least squares with coefficients that are not negative.

use super::symmetric_eigen;
use super::vector::{dot, norm};

/// Part of the sizes below which a column is rounding or does not help: coefficients come from products of columns, with half of the digits that a direction
/// has. Between 3e-11 and 1e-9 all short cases (see `tolerance`) have the same digits, and tests of unconstrained bodies pass.
const NO_HELP: f64 = 1e-10;

/// Most changes of the active set, a row.
const CHANGES_A_ROW: usize = 60;

/// What is left of `target` after the sum of the `columns` with coefficients ≥ 0 that comes nearest to it
/// ([Lawson and Hanson](crate::references::lawson_hanson_1974), algorithm NNLS). The rest has no positive product with any column: where it is not zero, it is a
/// direction that proves the target to be no such sum.
pub fn rest_of_nonnegative(columns: &[Vec<f64>], target: &[f64]) -> Vec<f64> {
    let (mut active, mut x): (Vec<usize>, Vec<f64>) = Default::default();
    let size = norm(target);
    // A column counts by its direction, which one that is rounding beside the others has none of.
    let largest = columns.iter().map(|c| norm(c)).fold(0.0, f64::max);
    let columns = columns.iter().map(|c| (c, norm(c)));
    let columns = columns.filter(|(_, length)| *length > NO_HELP * largest);
    let columns = columns.map(|(c, length)| c.iter().map(|v| v / length).collect());
    let columns: &[Vec<f64>] = &columns.collect::<Vec<_>>();
    let mut rest = target.to_vec();
    for _ in 0..CHANGES_A_ROW * target.len().max(1) {
        let passive = (0..columns.len()).filter(|k| !active.contains(k));
        let best = passive.map(|k| (k, dot(&columns[k], &rest)));
        let best = best.max_by(|a, b| a.1.total_cmp(&b.1));
        let Some((k, _)) = best.filter(|(_, gain)| *gain > NO_HELP * size) else {
            break;
        };
        active.push(k);
        x.push(0.0);
        loop {
            let wanted = least_squares(columns, &active, target);
            // As far as no coefficient becomes negative.
            let both = x.iter().zip(&wanted).filter(|(_, w)| **w <= 0.0);
            let part = both.map(|(x, w)| x / (x - w).max(f64::MIN_POSITIVE));
            let part = part.fold(1.0, f64::min);
            let moved = x.iter().zip(&wanted).map(|(x, w)| x + part * (w - x));
            let moved: Vec<f64> = moved.collect();
            if part == 1.0 && wanted.iter().all(|w| *w > 0.0) {
                x = moved;
                break;
            }
            let largest = moved.iter().copied().fold(0.0, f64::max);
            let kept = |(_, x): &(usize, f64)| *x > NO_HELP * largest;
            let both = active.iter().copied().zip(moved).filter(kept);
            (active, x) = both.unzip();
            if active.is_empty() {
                break;
            }
        }
        if !active.contains(&k) {
            // Rounding: it does not help after all.
            break;
        }
        rest = target.to_vec();
        for (&k, x) in active.iter().zip(&x) {
            rest.iter_mut()
                .zip(&columns[k])
                .for_each(|(r, c)| *r -= x * c);
        }
    }
    rest
}

/// Coefficients of some columns that come nearest to the target, the shortest where there are several.
fn least_squares(columns: &[Vec<f64>], active: &[usize], target: &[f64]) -> Vec<f64> {
    let of = |k: &usize| &columns[*k];
    let row = |a: &usize| active.iter().map(|b| dot(of(a), of(b))).collect();
    let gram: Vec<Vec<f64>> = active.iter().map(row).collect();
    let right: Vec<f64> = active.iter().map(|a| dot(of(a), target)).collect();
    let (values, vectors) = symmetric_eigen(&gram);
    // Smaller eigenvalues are rounding.
    let least = 1e-12 * values.last().copied().unwrap_or(0.0);
    let mut out = vec![0.0; active.len()];
    for (k, value) in values.iter().enumerate().filter(|(_, v)| **v > least) {
        let along: f64 = right.iter().zip(&vectors).map(|(r, v)| r * v[k]).sum();
        out.iter_mut()
            .zip(&vectors)
            .for_each(|(o, v)| *o += along / value * v[k]);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_in_a_cone_is_found_and_what_is_not_leaves_a_normal() {
        let cone = [
            vec![1.0, 0.3, 0.0],
            vec![1.0, -0.3, 0.0],
            vec![1.0, 0.0, 0.3],
        ];
        let inside = rest_of_nonnegative(&cone, &[2.0, 0.1, 0.2]);
        assert!(norm(&inside) < 1e-9, "{inside:?}");
        let rest = rest_of_nonnegative(&cone, &[1.0, 0.5, 0.0]);
        assert!(norm(&rest) > 0.1);
        // Not farther along any column, and it is what the target has beyond the cone.
        assert!(cone.iter().all(|c| dot(c, &rest) < 1e-9), "{rest:?}");
        let [a, b] = [1.0 / 0.3_f64.hypot(1.0), 0.3 / 0.3_f64.hypot(1.0)];
        assert!((norm(&rest) - (0.5 * a - b)).abs() < 1e-9, "{rest:?}");
        // Against all of them.
        let rest = rest_of_nonnegative(&cone, &[-1.0, 0.0, 0.0]);
        assert!((norm(&rest) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn neither_columns_of_rounding_nor_their_sizes_hide_the_others() {
        let cone = [
            vec![1.0, 0.5],
            vec![0.0, -1e-16],
            vec![1e-8, -1e-8],
            vec![0.0, 0.0],
        ];
        let inside = rest_of_nonnegative(&cone, &[100.0, 0.0]);
        assert!(norm(&inside) < 1e-9, "{inside:?}");
    }
}

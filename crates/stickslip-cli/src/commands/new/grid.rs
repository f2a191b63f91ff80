//! Lines of a grid that is fine where bodies touch.

use super::written::number;
use crate::print;
use crate::style::WIDTH;

/// Size of a cell over that of its neighbour nearer to the contact: ten times the size after nine cells.
pub const CELL_GROWTH: f64 = 1.3;

/// Distances from the contact: cells of the size `finest` out to `fine`, then growing ones, to `last` exactly.
pub fn outward(finest: f64, fine: f64, last: f64) -> Vec<f64> {
    let equal = (fine / finest).ceil() as usize;
    let mut lines: Vec<f64> = (0..=equal).map(|i| i as f64 * finest).collect();
    let start = lines[equal];
    // As many growing cells as come nearest, stretched a little to end where they should.
    let mut grown = vec![];
    let (mut at, mut size) = (0.0, finest);
    while at < last - start {
        size *= CELL_GROWTH;
        at += size;
        grown.push(at);
    }
    let stretch = (last - start) / at;
    lines.extend(grown.into_iter().map(|x| start + x * stretch));
    lines
}

/// The same to both sides, in increasing order.
pub fn both_ways(lines: &[f64]) -> Vec<f64> {
    let left = lines.iter().skip(1).rev().map(|x| -x);
    left.chain(lines.iter().copied()).collect()
}

/// From the greatest depth up to the surface at zero.
pub fn downward(lines: &[f64]) -> Vec<f64> {
    lines.iter().rev().map(|x| 0.0 - x).collect()
}

/// A list of TOML over several lines, for lengths in metres times `unit`.
pub fn list(lines: &[f64], unit: f64) -> String {
    let items: Vec<String> = lines.iter().map(|x| number(x * unit)).collect();
    format!("[\n{}]", print::wrap(&(items.join(", ") + ","), 2, WIDTH))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_equal_at_first_then_grow_and_end_where_they_should() {
        let lines = outward(0.1, 0.75, 10.0);
        let sizes: Vec<f64> = lines.windows(2).map(|w| w[1] - w[0]).collect();
        assert!(sizes[..8].iter().all(|s| (s - 0.1).abs() < 1e-12));
        assert!((lines.last().unwrap() - 10.0).abs() < 1e-12);
        // Stretched by less than one cell more or less would.
        assert!(
            sizes
                .windows(2)
                .all(|w| w[1] / w[0] > 0.9 && w[1] / w[0] < 1.5),
            "{sizes:?}"
        );
        let all = both_ways(&lines);
        assert!(all.windows(2).all(|w| w[0] < w[1]) && all.len() == 2 * lines.len() - 1);
        assert_eq!(downward(&[0.0, 1.0, 3.0]), [-3.0, -1.0, 0.0]);
    }
}

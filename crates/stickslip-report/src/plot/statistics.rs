//! Which values a picture shows, and which of them its colours span.

use stickslip::math::{cross, norm, sub};

use crate::field;
use crate::skin::Skin;

/// The part of the area, and of the points, at each end of the values that colours may leave out.
const LEFT_OUT: f64 = 0.01;

/// How much of what is drawn each point stands for: area of triangles, or in a plane length of the rim where only the rim has values. Zero where nothing is drawn.
pub fn weights(skin: &Skin, values: &[f64], bodies: &[bool]) -> Vec<f64> {
    let drawn = |i: u32| bodies[skin.owner[i as usize] as usize] && !values[i as usize].is_nan();
    let x = |i: u32| skin.positions[i as usize];
    let mut weights = vec![0.0; values.len()];
    if skin.dim == 2 && values.iter().any(|v| v.is_nan()) {
        for e in skin.rim.iter().filter(|e| e.iter().all(|&i| drawn(i))) {
            let length = norm(sub(x(e[1]), x(e[0])));
            e.iter().for_each(|&i| weights[i as usize] += length / 2.0);
        }
        return weights;
    }
    for t in skin
        .triangles
        .iter()
        .filter(|t| t.iter().all(|&i| drawn(i)))
    {
        let [a, b, c] = t.map(x);
        let area = norm(cross(sub(b, a), sub(c, a))) / 2.0;
        t.iter().for_each(|&i| weights[i as usize] += area / 3.0);
    }
    weights
}

/// The range that holds 99 % of the area and 99 % of the points at each end: values beyond it are left out only where they are further from the rest than half of its width, as
/// those of single nodes at corners and slivers are. Where the mesh is fine, as in teeth of gears that carry, a small area is what one looks at, and keeps its colours. `values`:
/// each with the area that it stands for; `zero`: whether colours begin at zero.
pub fn robust(mut values: Vec<[f64; 2]>, zero: bool) -> Option<[f64; 2]> {
    let all = field::range(values.iter().map(|v| v[0]))?;
    values.retain(|[value, weight]| value.is_finite() && *weight > 0.0);
    values.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let quantile = |part: f64, weight: &dyn Fn(&[f64; 2]) -> f64| {
        let total: f64 = values.iter().map(weight).sum();
        let mut sum = 0.0;
        let mut up = values.iter();
        let found = up.find(|v| {
            sum += weight(v);
            sum >= part * total
        });
        found.map(|v| v[0])
    };
    let ends = |weight: &dyn Fn(&[f64; 2]) -> f64| {
        Some([
            quantile(LEFT_OUT, weight)?,
            quantile(1.0 - LEFT_OUT, weight)?,
        ])
    };
    let (Some(area), Some(points)) = (ends(&|v| v[1]), ends(&|_| 1.0)) else {
        return Some(all);
    };
    let [low, high] = [area[0].min(points[0]), area[1].max(points[1])];
    let width = if zero {
        high - low.min(0.0)
    } else {
        high - low
    };
    let far = 0.5 * width.max(0.1 * low.abs().max(high.abs()));
    Some([
        if low - all[0] > far { low } else { all[0] },
        if all[1] - high > far { high } else { all[1] },
    ])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_single_node_does_not_set_the_range_and_a_smooth_peak_does() {
        let smooth = (0..1000).map(|i| [(f64::from(i) / 1000.0).sqrt(), 1.0]);
        let top = robust(smooth.clone().collect(), false).unwrap();
        assert_eq!(top, [0.0, 0.999f64.sqrt()]);
        // The same with a node of little area at each end that is a hundred times larger.
        let with = smooth.chain([[100.0, 0.5], [-100.0, 0.5]]);
        let [low, high] = robust(with.collect(), false).unwrap();
        assert!(
            (0.0..0.2).contains(&low) && (0.98..1.0).contains(&high),
            "{low} {high}"
        );
        // Two teeth of a gear that carry: little area, but many points.
        let disc = (0..500).map(|i| [f64::from(i) / 500.0, 1.0]);
        let teeth = (0..100).map(|i| [f64::from(i), 0.01]);
        let gear = robust(disc.chain(teeth).collect(), false).unwrap();
        assert!(gear[1] > 90.0, "{gear:?}");
        // A node that stands for more than a hundredth of the area is kept.
        let coarse = robust(vec![[1.0, 1.0], [2.0, 1.0], [100.0, 1.0]], false);
        assert_eq!(coarse, Some([1.0, 100.0]));
        // What begins at zero is narrow only beside that.
        let narrow: Vec<[f64; 2]> = (0..1000)
            .map(|i| [90.0 + f64::from(i) / 100.0, 1.0])
            .chain([[120.0, 0.5]])
            .collect();
        assert_eq!(robust(narrow.clone(), true).unwrap()[1], 120.0);
        assert!(robust(narrow, false).unwrap()[1] < 100.0);
        assert_eq!(robust(vec![[f64::NAN, 1.0]], false), None);
        assert_eq!(
            robust(vec![[3.0, 0.0], [f64::INFINITY, 1.0]], false),
            Some([3.0, 3.0])
        );
    }
}

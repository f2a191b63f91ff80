//! The smallest circle around points: the mean and the amplitude of a shear that turns.

use crate::tolerance::ROUNDING;

type Point = [f64; 2];

fn between(a: Point, b: Point) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

fn around_two(a: Point, b: Point) -> (Point, f64) {
    let middle = [0, 1].map(|k| 0.5 * (a[k] + b[k]));
    (middle, 0.5 * between(a, b))
}

/// The circle through three points; through the farthest two where they lie on a line.
fn around_three([a, b, c]: [Point; 3]) -> (Point, f64) {
    let [u, v] = [b, c].map(|p| [p[0] - a[0], p[1] - a[1]]);
    let [uu, vv] = [u, v].map(|p| p[0] * p[0] + p[1] * p[1]);
    let area = 2.0 * (u[0] * v[1] - u[1] * v[0]);
    if area.abs() <= ROUNDING * (uu + vv) {
        let pairs = [around_two(a, b), around_two(a, c), around_two(b, c)];
        let larger = |x: (Point, f64), y: (Point, f64)| if y.1 > x.1 { y } else { x };
        return pairs.into_iter().fold((a, 0.0), larger);
    }
    let middle = [
        (v[1] * uu - u[1] * vv) / area,
        (u[0] * vv - v[0] * uu) / area,
    ];
    let radius = middle[0].hypot(middle[1]);
    ([a[0] + middle[0], a[1] + middle[1]], radius)
}

/// Centre and radius of the smallest circle around points, one after the other: a point that lies outside of that of those before it is on the edge of the next.
pub(super) fn smallest_circle(points: &[Point]) -> (Point, f64) {
    let Some(&first) = points.first() else {
        return ([0.0; 2], 0.0);
    };
    let size = points
        .iter()
        .map(|&p| between(p, first))
        .fold(0.0, f64::max);
    let outside = |p: Point, (c, r): (Point, f64)| between(p, c) > r + ROUNDING * size;
    let mut circle = (first, 0.0);
    for (i, &a) in points.iter().enumerate() {
        if !outside(a, circle) {
            continue;
        }
        circle = (a, 0.0);
        for (j, &b) in points[..i].iter().enumerate() {
            if !outside(b, circle) {
                continue;
            }
            circle = around_two(a, b);
            for &c in &points[..j] {
                if outside(c, circle) {
                    circle = around_three([a, b, c]);
                }
            }
        }
    }
    circle
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn circles_that_are_known() {
        let close = |points: &[Point], middle: Point, radius: f64| {
            let (c, r) = smallest_circle(points);
            assert!(between(c, middle) < 1e-12 && (r - radius).abs() < 1e-12);
        };
        close(&[[1.0, 2.0]], [1.0, 2.0], 0.0);
        close(
            &[[0.0, 0.0], [2.0, 0.0], [1.0, 0.0], [0.5, 0.0]],
            [1.0, 0.0],
            1.0,
        );
        close(&[[0.0, 0.0], [3.0, 4.0], [1.5, 2.0]], [1.5, 2.0], 2.5);
        // A blunt triangle is within the circle about its longest side.
        close(&[[-1.0, 0.0], [0.0, 0.1], [1.0, 0.0]], [0.0, 0.0], 1.0);
        let turning: Vec<Point> = (0..12)
            .map(|i| f64::from(i) * 0.7)
            .map(|t| [5.0 + 2.0 * t.cos(), 2.0 * t.sin() - 1.0])
            .collect();
        close(&turning, [5.0, -1.0], 2.0);
    }
}

//! A surface in space laid into a plane: in plan where it has a side that it faces, unrolled where it goes around an axis.

use stickslip::math::{cross, dot, norm};

use super::super::camera::unit;
use crate::sheet::Sheet;

type Vec3 = [f64; 3];

/// How a surface is laid into a plane.
enum Lay {
    /// In plan, with these directions to the right and up.
    Plan([Vec3; 2]),
    /// Unrolled about an axis through a centre, with two directions across it.
    Around {
        centre: Vec3,
        across: [Vec3; 2],
        axis: Vec3,
    },
}

fn lay(sheet: &Sheet) -> Lay {
    let x = &sheet.grid.points.points;
    let (mean, spread, area) = normals(sheet);
    // Half of the area has to face one side for a plan.
    if norm(mean) > 0.5 * area || area <= 0.0 {
        let out = if area > 0.0 {
            unit(mean)
        } else {
            [0.0, 0.0, 1.0]
        };
        return Lay::Plan(directions(out));
    }
    // The axis is that along which the surface faces least.
    let axis = least(spread);
    let mut bounds = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
    for (p, c) in x.iter().flat_map(|p| (0..3).map(move |c| (p, c))) {
        bounds[0][c] = bounds[0][c].min(p[c]);
        bounds[1][c] = bounds[1][c].max(p[c]);
    }
    Lay::Around {
        centre: [0, 1, 2].map(|c| (bounds[0][c] + bounds[1][c]) / 2.0),
        across: directions(axis),
        axis,
    }
}

/// Where each point is on the map `[length]`, shape `(n, 2)`.
pub fn plan(sheet: &Sheet) -> Vec<[f64; 2]> {
    let x = &sheet.grid.points.points;
    match lay(sheet) {
        Lay::Plan([a, b]) => x.iter().map(|x| [dot(a, *x), dot(b, *x)]).collect(),
        Lay::Around {
            centre,
            across,
            axis,
        } => {
            let polar = x.iter().map(|p| {
                let d = [0, 1, 2].map(|c| p[c] - centre[c]);
                let [a, b] = across.map(|e| dot(e, d));
                (a.hypot(b), b.atan2(a), dot(axis, *p))
            });
            let polar: Vec<(f64, f64, f64)> = polar.collect();
            let radius = polar.iter().map(|p| p.0).sum::<f64>() / polar.len().max(1) as f64;
            let on_map = |(_, turn, along): &(f64, f64, f64)| [radius * turn, *along];
            polar.iter().map(on_map).collect()
        }
    }
}

/// The directions of space that go to the right and up on the map at a place.
pub fn base(sheet: &Sheet) -> impl Fn(Vec3) -> [Vec3; 2] {
    let lay = lay(sheet);
    move |x| match &lay {
        Lay::Plan(directions) => *directions,
        Lay::Around {
            centre,
            across,
            axis,
        } => {
            let d = [0, 1, 2].map(|c| x[c] - centre[c]);
            let [a, b] = across.map(|e| dot(e, d));
            let turn = unit([0, 1, 2].map(|c| a * across[1][c] - b * across[0][c]));
            [turn, *axis]
        }
    }
}

/// Directions of the map, right and up, for a surface that faces `out`: x to the right where it can be.
fn directions(out: Vec3) -> [Vec3; 2] {
    let right = if out[0].abs() < 0.9 {
        [1.0, 0.0, 0.0]
    } else {
        [0.0, 1.0, 0.0]
    };
    let along = dot(right, out);
    let right = unit([0, 1, 2].map(|c| right[c] - along * out[c]));
    [right, cross(out, right)]
}

/// Sums over all faces: area as a vector, its products, and area.
fn normals(sheet: &Sheet) -> (Vec3, [Vec3; 3], f64) {
    let (grid, mut mean, mut spread, mut area) = (&sheet.grid, [0.0; 3], [[0.0; 3]; 3], 0.0);
    for i in 0..grid.types.len() {
        let x: Vec<Vec3> = grid
            .cell(i)
            .iter()
            .map(|&p| grid.points.points[p])
            .collect();
        let [a, b] = match x.as_slice() {
            [p, q, r] => [[*p, *q], [*p, *r]],
            [p, q, r, s] => [[*p, *r], [*q, *s]],
            _ => continue,
        };
        let edge = |[p, q]: [Vec3; 2]| [0, 1, 2].map(|c| q[c] - p[c]);
        let n = cross(edge(a), edge(b)).map(|v| v / 2.0);
        let size = norm(n);
        area += size;
        for c in 0..3 {
            mean[c] += n[c];
            for k in 0..3 {
                spread[c][k] += n[c] * n[k] / size.max(f64::MIN_POSITIVE);
            }
        }
    }
    (mean, spread, area)
}

/// The direction along which a symmetric matrix is least, by iteration with what is left of its trace.
fn least(m: [Vec3; 3]) -> Vec3 {
    let trace = m[0][0] + m[1][1] + m[2][2];
    let mut v = [0.31, 0.47, 0.83];
    for _ in 0..200 {
        v = unit([0, 1, 2].map(|c| trace * v[c] - dot(m[c], v)));
    }
    // Pointing the way of its largest component.
    let largest = v
        .iter()
        .fold(0.0f64, |m, x| if x.abs() > m.abs() { *x } else { m });
    v.map(|x| x * largest.signum())
}

#[cfg(test)]
mod tests {
    use super::*;
    use stickslip::io::vtu::Grid;

    /// A grid of quadrilaterals over two parameters.
    fn sheet(n: [usize; 2], place: impl Fn(f64, f64) -> Vec3) -> Sheet {
        let mut grid = Grid::default();
        for j in 0..=n[1] {
            for i in 0..=n[0] {
                grid.points
                    .points
                    .push(place(i as f64 / n[0] as f64, j as f64 / n[1] as f64));
            }
        }
        for j in 0..n[1] {
            for i in 0..n[0] {
                let p = j * (n[0] + 1) + i;
                grid.types.push(9);
                grid.connectivity
                    .extend([p, p + 1, p + n[0] + 2, p + n[0] + 1]);
                grid.offsets.push(grid.connectivity.len());
            }
        }
        Sheet {
            name: "a".into(),
            grid,
        }
    }

    #[test]
    fn a_flat_surface_is_seen_in_plan_and_a_cylinder_is_unrolled() {
        let flat = sheet([2, 2], |s, t| [3.0 * s, t, 5.0]);
        let map = plan(&flat);
        assert_eq!(map[8], [3.0, 1.0]);
        let (radius, length) = (2.0, 7.0);
        let tube = sheet([40, 3], |s, t| {
            let (sin, cos) = (std::f64::consts::TAU * (s - 0.5)).sin_cos();
            [1.0 + radius * cos, length * t, radius * sin]
        });
        let map = plan(&tube);
        let wide = |c: usize| crate::field::range(map.iter().map(|p| p[c])).unwrap();
        let [low, high] = wide(0);
        assert!(
            (high - low - std::f64::consts::TAU * radius).abs() < 0.2 * radius,
            "{low} {high}"
        );
        assert!((wide(1)[1] - wide(1)[0] - length).abs() < 1e-9);
    }
}

//! Friction problems of rigid bodies in an instant: `W = H M⁻¹ Hᵀ` and `q = H v` from where bodies are and how they move.

use super::super::{FrictionProblem, PointLaw};
use super::random::Random;
use crate::math::{Vec3, cross, dot, normalize, scale, sub};

/// A box or a ball: centre, mass, and the moments of inertia about its axes, which are those of space.
struct Rigid {
    centre: Vec3,
    mass: f64,
    inertia: Vec3,
}

/// Where two bodies meet; `b` is `None` for the ground. The normal points to `a`.
struct Place {
    a: usize,
    b: Option<usize>,
    at: Vec3,
    normal: Vec3,
}

/// Impulse that gravity gives a unit of mass in one step of time.
const FALL: f64 = 9.81 * 0.005;

fn cuboid(centre: Vec3, mass: f64, [x, y, z]: Vec3) -> Rigid {
    let inertia = [y * y + z * z, x * x + z * z, x * x + y * y].map(|s| mass / 12.0 * s);
    Rigid {
        centre,
        mass,
        inertia,
    }
}

/// Boxes on each other, four points between two.
pub fn stack(random: &mut Random, boxes: usize, mu: f64) -> FrictionProblem {
    let (mut bodies, mut places) = (Vec::new(), Vec::new());
    let mut z = 0.0;
    for k in 0..boxes {
        let (height, width) = (random.between(0.05, 0.2), random.between(0.1, 0.3));
        let (x, y) = (random.between(-0.03, 0.03), random.between(-0.03, 0.03));
        let mass = 10_f64.powf(random.between(-1.0, 1.5));
        bodies.push(cuboid(
            [x, y, z + 0.5 * height],
            mass,
            [width, width, height],
        ));
        for (sx, sy) in [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)] {
            places.push(Place {
                a: k,
                b: k.checked_sub(1),
                at: [x + sx * 0.4 * width, y + sy * 0.4 * width, z],
                normal: [0.0, 0.0, 1.0],
            });
        }
        z += height;
    }
    problem(random, &bodies, &places, mu)
}

/// Balls of one metre that have been thrown into a corner.
pub fn heap(random: &mut Random, balls: usize, mu: f64) -> FrictionProblem {
    let side = 0.9 * (balls as f64).cbrt();
    let mut place = || [1.0, 1.0, 0.7].map(|s: f64| s * side * random.between(0.0, 1.0));
    let centres: Vec<Vec3> = (0..balls).map(|_| place()).collect();
    let mut places = Vec::new();
    for (a, &at) in centres.iter().enumerate() {
        for (b, &other) in centres[..a].iter().enumerate() {
            let apart = sub(at, other);
            if dot(apart, apart) < 1.1 {
                let middle = scale(0.5, [0, 1, 2].map(|c| at[c] + other[c]));
                places.push(Place {
                    a,
                    b: Some(b),
                    at: middle,
                    normal: normalize(apart).expect("two centres"),
                });
            }
        }
        for c in 0..3 {
            if at[c] < 0.5 {
                let mut normal = [0.0; 3];
                normal[c] = 1.0;
                places.push(Place {
                    a,
                    b: None,
                    at: sub(at, scale(0.5, normal)),
                    normal,
                });
            }
        }
    }
    let bodies: Vec<Rigid> = centres
        .into_iter()
        .map(|centre| cuboid(centre, random.between(0.5, 2.0), [0.5; 3]))
        .collect();
    problem(random, &bodies, &places, mu)
}

/// A body's six velocities in the direction `e` at a place.
fn row(body: &Rigid, at: Vec3, e: Vec3) -> [f64; 6] {
    let turn = cross(sub(at, body.centre), e);
    [e[0], e[1], e[2], turn[0], turn[1], turn[2]]
}

fn problem(random: &mut Random, bodies: &[Rigid], places: &[Place], mu: f64) -> FrictionProblem {
    let shaken = random.between(0.0, 1.0);
    let speeds: Vec<[f64; 6]> = bodies
        .iter()
        .map(|_| {
            let mut v = [0; 6].map(|_: i32| shaken * random.between(-0.5, 0.5));
            v[2] -= FALL;
            v
        })
        .collect();
    // By row the bodies that take part and how.
    let mut rows: Vec<Vec<(usize, [f64; 6])>> = Vec::new();
    for place in places {
        let n = place.normal;
        let aside = if n[0].abs() < 0.9 {
            [1.0, 0.0, 0.0]
        } else {
            [0.0, 1.0, 0.0]
        };
        let t = normalize(cross(n, aside)).expect("a direction along the surface");
        for e in [n, t, cross(n, t)] {
            let mut parts = vec![(place.a, row(&bodies[place.a], place.at, e))];
            if let Some(b) = place.b {
                parts.push((b, row(&bodies[b], place.at, e).map(|x| -x)));
            }
            rows.push(parts);
        }
    }
    let inverse = |k: usize, c: usize| match c {
        0..3 => 1.0 / bodies[k].mass,
        _ => 1.0 / bodies[k].inertia[c - 3],
    };
    let mut operator = Vec::new();
    for one in &rows {
        for other in &rows {
            let mut sum = 0.0;
            for (k, x) in one {
                for (_, y) in other.iter().filter(|(l, _)| l == k) {
                    sum += (0..6).map(|c| x[c] * inverse(*k, c) * y[c]).sum::<f64>();
                }
            }
            operator.push(sum);
        }
    }
    let moving = |(k, x): &(usize, [f64; 6])| -> f64 { (0..6).map(|c| x[c] * speeds[*k][c]).sum() };
    FrictionProblem {
        dimension: 3,
        operator,
        free: rows
            .iter()
            .map(|parts| parts.iter().map(moving).sum())
            .collect(),
        laws: vec![PointLaw::coulomb(mu); places.len()],
    }
}

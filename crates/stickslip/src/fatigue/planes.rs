//! The worst of all planes through a point.
//!
//! Planes are tried about six degrees apart, on the half sphere in space and in half a turn in the plane (planes that hold the direction across it). From those that are nearly as bad as the worst of them, and not neighbours, worse ones are looked
//! for nearby, by steps that are halved until they are below [`LAST_ANGLE`]. A value that is smooth over the planes is off by the square of that, beside its range over all of them: 1e-7. A criterion with a
//! narrower peak than six degrees could be missed; stresses turn by the double of an angle, so that those here have none.

use std::f64::consts::PI;

use super::criterion::{Criterion, OnPlane};
use crate::math::{Vec3, add_scaled, cross, dot, normalize};

/// Distance of the planes that are tried at first. It is six degrees, as said above.
const FIRST_ANGLE: f64 = PI / 30.0;

/// Steps at the end: angle by which the worst plane may be off `[rad]`, a fortieth of a degree or so.
pub const LAST_ANGLE: f64 = PI / 9000.0;

/// How many planes are looked around at most.
const MOST_PLANES: usize = 6;

/// Which planes there are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Directions {
    /// Those with a normal in the plane of x and y.
    Plane,
    /// All of them.
    Space,
}

/// Stress and elastic strain of a point over a cycle, one entry an increment; components xx yy zz xy yz xz, shear strains engineering ones.
#[derive(Debug, Clone, Default)]
pub struct History {
    /// Stress `[Pa]`.
    pub stress: Vec<[f64; 6]>,
    /// Elastic strain `[-]`.
    pub strain: Vec<[f64; 6]>,
}

/// The worst plane.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Worst {
    /// What the criterion says of it.
    pub value: f64,
    /// Its normal.
    pub normal: Vec3,
}

/// A symmetric tensor times a vector. `half`: shear components are engineering strains.
fn times(t: &[f64; 6], n: Vec3, half: bool) -> Vec3 {
    let [xx, yy, zz, xy, yz, xz] = *t;
    let [xy, yz, xz] = [xy, yz, xz].map(|x| if half { 0.5 * x } else { x });
    [
        xx * n[0] + xy * n[1] + xz * n[2],
        xy * n[0] + yy * n[1] + yz * n[2],
        xz * n[0] + yz * n[1] + zz * n[2],
    ]
}

/// Two directions in the plane with a normal.
fn within(normal: Vec3) -> [Vec3; 2] {
    let axis = match normal[2].abs() < 0.9 {
        true => [0.0, 0.0, 1.0],
        false => [1.0, 0.0, 0.0],
    };
    let first = normalize(cross(axis, normal)).unwrap_or(axis);
    [first, cross(normal, first)]
}

impl History {
    /// What a plane sees of it.
    pub fn on(&self, normal: Vec3, at: &mut OnPlane) {
        let axes = within(normal);
        at.normal.clear();
        at.shear.clear();
        at.strain.clear();
        at.hydrostatic.clear();
        for (stress, strain) in self.stress.iter().zip(&self.strain) {
            let traction = times(stress, normal, false);
            at.normal.push(dot(traction, normal));
            at.shear.push(axes.map(|e| dot(traction, e)));
            at.strain.push(dot(times(strain, normal, true), normal));
            at.hydrostatic
                .push((stress[0] + stress[1] + stress[2]) / 3.0);
        }
    }
}

impl Directions {
    /// The normals that are tried at first.
    fn coarse(self) -> Vec<Vec3> {
        match self {
            Directions::Plane => {
                let count = (PI / FIRST_ANGLE).round() as usize;
                let angles = (0..count).map(|i| PI * i as f64 / count as f64);
                angles.map(|a| [a.cos(), a.sin(), 0.0]).collect()
            }
            Directions::Space => {
                let mut all = vec![[0.0, 0.0, 1.0]];
                let rings = (0.5 * PI / FIRST_ANGLE).round() as usize;
                for ring in 1..=rings {
                    let polar = 0.5 * PI * ring as f64 / rings as f64;
                    // The equator is its own other half.
                    let round = if ring == rings { PI } else { 2.0 * PI };
                    let count = (round * polar.sin() / FIRST_ANGLE).ceil() as usize;
                    let angles = (0..count).map(|i| round * i as f64 / count as f64);
                    let (s, c) = polar.sin_cos();
                    all.extend(angles.map(|a| [s * a.cos(), s * a.sin(), c]));
                }
                all
            }
        }
    }

    /// Ways to turn a normal.
    fn ways(self, normal: Vec3) -> Vec<Vec3> {
        let [e, f] = within(normal);
        match self {
            // The first lies in the plane of x and y.
            Directions::Plane => vec![e, e.map(|x| -x)],
            Directions::Space => (0..8)
                .map(|i| PI * 0.25 * f64::from(i))
                .map(|a| add_scaled(e.map(|x| a.cos() * x), a.sin(), f))
                .collect(),
        }
    }
}

/// Looks around for a worse plane.
fn climb(directions: Directions, value: &mut dyn FnMut(Vec3) -> f64, start: Worst) -> Worst {
    let mut best = start;
    let mut step = 0.5 * FIRST_ANGLE;
    while step >= LAST_ANGLE {
        let mut next = best;
        for way in directions.ways(best.normal) {
            let turned = add_scaled(best.normal, step.tan(), way);
            let normal = normalize(turned).unwrap_or(best.normal);
            let found = value(normal);
            if found > next.value {
                next = Worst {
                    value: found,
                    normal,
                };
            }
        }
        match next.value > best.value {
            true => best = next,
            false => step *= 0.5,
        }
    }
    best
}

/// The plane on which a criterion is largest, and how large; `None` of one that looks at surfaces.
pub fn worst(
    criterion: &dyn Criterion,
    history: &History,
    directions: Directions,
) -> Option<Worst> {
    let mut at = OnPlane::default();
    criterion.on_plane(&at)?;
    let mut value = |normal: Vec3| {
        history.on(normal, &mut at);
        criterion.on_plane(&at).unwrap_or(f64::NEG_INFINITY)
    };
    let normals = directions.coarse().into_iter();
    let mut all: Vec<Worst> = normals
        .map(|normal| Worst {
            value: value(normal),
            normal,
        })
        .collect();
    all.sort_by(|a, b| b.value.total_cmp(&a.value));
    let (top, low) = (all.first()?.value, all.last()?.value);
    let mut starts: Vec<Worst> = Vec::new();
    for &one in all
        .iter()
        // A plane is still looked around if it is better than the worst by no more than a twentieth of the range of values.
        .take_while(|w| w.value >= top - 0.05 * (top - low))
    {
        let near = |s: &Worst| dot(s.normal, one.normal).abs() > (2.5 * FIRST_ANGLE).cos();
        if starts.len() < MOST_PLANES && !starts.iter().any(near) {
            starts.push(one);
        }
    }
    let found = starts.into_iter();
    let found = found.map(|start| climb(directions, &mut value, start));
    found.reduce(|a, b| if b.value > a.value { b } else { a })
}

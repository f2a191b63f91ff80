//! Taking the mass away from points in contact and giving it to their neighbours.
//!
//! A point with mass that meets a rigid surface has to stop at once: whatever the time step, its momentum turns into an oscillation of
//! the contact force, and Newmark's method can gain energy by it. Without mass the point just follows
//! ([`khenous_2008`](crate::references::khenous_2008)). Total mass, centre of mass and moments of inertia of the body stay as
//! they were, so its rigid motion is the same.

use crate::linear::BlockCsr;
use crate::math::{Vec3, symmetric_eigen};

/// Layers of neighbours that take mass.
const LAYERS: usize = 5;

/// Weight of a layer relative to the one before.
const DECAY: f64 = 0.25;

/// Largest part of its mass that a point may give instead of take.
const MOST_GIVEN: f64 = 0.5;

/// Takes the mass of the points `light` of one body away and gives it to the others. `points` are all points of the body and `x` the
/// coordinates of all points of the mesh. `false`, and nothing changed, if no other point could take it.
pub fn redistribute(mass: &mut BlockCsr, x: &[Vec3], points: &[usize], light: &[bool]) -> bool {
    let dim = mass.block_size();
    let layer = layers(mass, points, light);
    let before = moments(mass, x, points, dim);
    let mut changed = mass.clone();
    changed.remove_points(light);
    let after = moments(&changed, x, points, dim);
    let missing: Vec<f64> = before.iter().zip(&after).map(|(b, a)| b - a).collect();
    let takers: Vec<usize> = points
        .iter()
        .copied()
        .filter(|&p| layer[p].is_some_and(|l| l > 0) && !light[p])
        .collect();
    let own: Vec<f64> = takers.iter().map(|&p| row_sum(&changed, p)).collect();
    // All moments; without the second ones; the mass alone.
    for kept in [missing.len(), 1 + dim, 1] {
        let Some(given) = shares(&takers, &own, x, &layer, &missing[..kept], dim) else {
            continue;
        };
        for (&p, g) in takers.iter().zip(&given) {
            for i in 0..dim {
                changed.add_diagonal(p * dim + i, *g);
            }
        }
        *mass = changed;
        return true;
    }
    false
}

/// How far points are from the light ones, in cells.
fn layers(mass: &BlockCsr, points: &[usize], light: &[bool]) -> Vec<Option<usize>> {
    let mut layer: Vec<Option<usize>> = vec![None; light.len()];
    let mut front: Vec<usize> = points.iter().copied().filter(|&p| light[p]).collect();
    for &p in &front {
        layer[p] = Some(0);
    }
    for l in 1..=LAYERS {
        let mut next = Vec::new();
        for &p in &front {
            for &q in mass.neighbours(p) {
                let q = q as usize;
                if layer[q].is_none() {
                    layer[q] = Some(l);
                    next.push(q);
                }
            }
        }
        front = next;
    }
    layer
}

fn row_sum(mass: &BlockCsr, p: usize) -> f64 {
    let size = mass.block_size().pow(2);
    mass.row_blocks(p).chunks(size).map(|b| b[0]).sum()
}

/// Monomials to the second degree, `1, x, y, (z), xx, xy, …`.
fn monomials(x: Vec3, dim: usize) -> Vec<f64> {
    let mut out = vec![1.0];
    out.extend(&x[..dim]);
    for i in 0..dim {
        for j in i..dim {
            out.push(x[i] * x[j]);
        }
    }
    out
}

/// Mass, first and second moments of a body.
fn moments(mass: &BlockCsr, x: &[Vec3], points: &[usize], dim: usize) -> Vec<f64> {
    let size = dim * dim;
    let mut sums = vec![0.0; monomials([0.0; 3], dim).len()];
    for &a in points {
        for (&b, block) in mass
            .neighbours(a)
            .iter()
            .zip(mass.row_blocks(a).chunks(size))
        {
            let (m, xa, xb) = (block[0], x[a], x[b as usize]);
            sums[0] += m;
            for i in 0..dim {
                sums[1 + i] += m * xa[i];
            }
            let mut k = 1 + dim;
            for i in 0..dim {
                for j in i..dim {
                    sums[k] += 0.5 * m * (xa[i] * xb[j] + xb[i] * xa[j]);
                    k += 1;
                }
            }
        }
    }
    sums
}

/// What each taker is given, so that the moments are `missing`: close to where mass was taken, and as evenly as that allows.
fn shares(
    takers: &[usize],
    own: &[f64],
    x: &[Vec3],
    layer: &[Option<usize>],
    missing: &[f64],
    dim: usize,
) -> Option<Vec<f64>> {
    if takers.is_empty() {
        return None;
    }
    let kept = missing.len();
    // Coordinates about the takers' middle, in their own size, so that the small system is well scaled.
    let n = takers.len() as f64;
    let mut centre = [0.0; 3];
    for &p in takers {
        for i in 0..dim {
            centre[i] += x[p][i] / n;
        }
    }
    let size = takers
        .iter()
        .flat_map(|&p| (0..dim).map(move |i| (p, i)))
        .map(|(p, i)| (x[p][i] - centre[i]).abs())
        .fold(0.0, f64::max)
        .max(f64::MIN_POSITIVE);
    let local = |p: Vec3| -> Vec3 {
        std::array::from_fn(|i| {
            if i < dim {
                (p[i] - centre[i]) / size
            } else {
                0.0
            }
        })
    };
    let wanted = shift_moments(missing, centre, size, dim);
    let basis: Vec<Vec<f64>> = takers
        .iter()
        .map(|&p| monomials(local(x[p]), dim)[..kept].to_vec())
        .collect();
    let weight: Vec<f64> = takers
        .iter()
        .zip(own)
        .map(|(&p, m)| m * DECAY.powi(layer[p].unwrap_or(LAYERS) as i32))
        .collect();
    let gram: Vec<Vec<f64>> = (0..kept)
        .map(|k| {
            (0..kept)
                .map(|l| {
                    let terms = basis.iter().zip(&weight);
                    terms.map(|(q, w)| w * q[k] * q[l]).sum()
                })
                .collect()
        })
        .collect();
    let (values, vectors) = symmetric_eigen(&gram);
    let largest = values.last().copied().unwrap_or(0.0);
    let mut c = vec![0.0; kept];
    for (e, value) in values.iter().enumerate() {
        if *value > 1e-10 * largest {
            let along: f64 = (0..kept).map(|k| vectors[k][e] * wanted[k]).sum();
            for (k, c) in c.iter_mut().enumerate() {
                *c += vectors[k][e] * along / value;
            }
        }
    }
    let given: Vec<f64> = basis
        .iter()
        .zip(&weight)
        .map(|(q, w)| w * q.iter().zip(&c).map(|(q, c)| q * c).sum::<f64>())
        .collect();
    // Where the takers lie in a plane not all moments can be had.
    let reached = (0..kept).all(|k| {
        let sum: f64 = basis.iter().zip(&given).map(|(q, g)| q[k] * g).sum();
        (sum - wanted[k]).abs() <= 1e-9 * wanted[0].abs()
    });
    let sound = given.iter().zip(own).all(|(g, m)| *g > -MOST_GIVEN * m);
    (reached && sound).then_some(given)
}

/// Moments about `centre` in units of `size`.
fn shift_moments(m: &[f64], centre: Vec3, size: f64, dim: usize) -> Vec<f64> {
    let mut out = m.to_vec();
    if m.len() > 1 {
        for i in 0..dim {
            out[1 + i] = (m[1 + i] - centre[i] * m[0]) / size;
        }
    }
    if m.len() > 1 + dim {
        let mut k = 1 + dim;
        for i in 0..dim {
            for j in i..dim {
                let about = m[k] - centre[i] * m[1 + j] - centre[j] * m[1 + i]
                    + centre[i] * centre[j] * m[0];
                out[k] = about / (size * size);
                k += 1;
            }
        }
    }
    out
}

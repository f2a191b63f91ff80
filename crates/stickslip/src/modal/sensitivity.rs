//! How eigenvalues change with friction, moduli and densities, by left and right eigenvectors.
//!
//! With `P(λ) x = 0` and `yᵀ P(λ) = 0` an eigenvalue changes by `dλ = -yᵀ (dK + λ dC + λ² dM) x / yᵀ (2 λ M + C) x`. The contact state is kept.

use std::f64::consts::TAU;

use super::linear::{Linear, Pair, add_pairs};
use super::outcome::Sensitivity;
use super::quadratic::{Eigen, solve};
use super::shifted::{Root, Shifted};
use crate::linear::{BlockCsr, Complex};
use crate::math::vector::dot;
use crate::model::definition::Model;

/// Distance of two eigenvalues that are one, relative to their size.
const SAME: f64 = 1e-6;

/// What stiffness, damping and mass change by, times a vector.
type Change<'a> = Box<dyn Fn(&[f64]) -> [Vec<f64>; 3] + 'a>;

/// A quantity, and the change of stiffness, damping and mass times a vector that goes with a relative change of it by one.
struct Quantity<'a> {
    name: String,
    change: Change<'a>,
}

/// The changes of all modes with all quantities.
pub(crate) fn all(
    model: &Model,
    shifted: &Shifted,
    root: &mut Root,
    modes: &[Eigen],
    solves: &mut usize,
) -> Vec<Sensitivity> {
    let linear = shifted.linear;
    root.set(1.0, true);
    // A few more, so that none is missing where sizes are nearly equal.
    let asked = (modes.len() + 4, f64::INFINITY);
    let left = solve(shifted, root, asked, true, solves);
    root.set(1.0, false);
    let quantities = quantities(model, linear);
    let mut out = Vec::new();
    for (k, mode) in modes.iter().enumerate() {
        let away = |e: &&Eigen| {
            let [a, b] = [0, 1].map(|i| e.value[i] - mode.value[i]);
            a.hypot(b)
        };
        let partner = left.iter().min_by(|a, b| away(a).total_cmp(&away(b)));
        let size = mode.value[0].hypot(mode.value[1]);
        let Some(partner) = partner.filter(|p| away(p) <= SAME * size) else {
            continue;
        };
        let [x, y] = [0, 1].map(|i| linear.forces(&mode.vector[i], 1.0));
        let [l, w] = mode.value;
        let double = [2.0 * l, 2.0 * w];
        let masses = bilinear(&partner.vector, [&x[2], &y[2]]);
        let damping = bilinear(&partner.vector, [&x[1], &y[1]]);
        let below = add(times(double, masses), damping);
        for quantity in &quantities {
            let [x, y] = [0, 1].map(|i| (quantity.change)(&mode.vector[i]));
            let part = |q: usize| bilinear(&partner.vector, [&x[q], &y[q]]);
            let value = mode.value;
            let above = add(
                add(part(0), times(value, part(1))),
                times(times(value, value), part(2)),
            );
            let change = over(above, below);
            out.push(Sensitivity {
                mode: k + 1,
                of: quantity.name.clone(),
                growth: -change[0],
                frequency: -change[1] / TAU,
            });
        }
    }
    out
}

fn add(a: Complex, b: Complex) -> Complex {
    [a[0] + b[0], a[1] + b[1]]
}

fn times(a: Complex, b: Complex) -> Complex {
    [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]]
}

fn over(a: Complex, b: Complex) -> Complex {
    let square = b[0] * b[0] + b[1] * b[1];
    let product = times(a, [b[0], -b[1]]);
    product.map(|p| p / square)
}

/// `yᵀ f`, without conjugation.
fn bilinear(y: &[Vec<f64>; 2], f: [&Vec<f64>; 2]) -> Complex {
    [
        dot(&y[0], f[0]) - dot(&y[1], f[1]),
        dot(&y[0], f[1]) + dot(&y[1], f[0]),
    ]
}

fn quantities<'a>(model: &'a Model, linear: &'a Linear) -> Vec<Quantity<'a>> {
    let mut out = Vec::new();
    for (i, name) in linear.sliding.iter().enumerate() {
        let change = move |x: &[f64]| {
            let of = |pairs: &[Pair]| {
                let mut out = vec![0.0; x.len()];
                add_pairs(pairs.iter().filter(|p| p.interface == i), 1.0, x, &mut out);
                out
            };
            [of(&linear.friction), of(&linear.drag), vec![0.0; x.len()]]
        };
        out.push(Quantity {
            name: format!("friction.{name}"),
            change: Box::new(change),
        });
    }
    for body in model.elastic() {
        let mut own: BlockCsr = linear.stiffness.zeros_like();
        body.elastic.stiffness(&mut own);
        let [alpha, beta] = body.rayleigh;
        let change = move |x: &[f64]| {
            let k = linear.times(&own, x);
            let c = k.iter().map(|k| beta * k).collect();
            let none = vec![0.0; x.len()];
            [k, c, none]
        };
        out.push(Quantity {
            name: format!("modulus.{}", body.name),
            change: Box::new(change),
        });
        let mut own = linear.mass.zeros_like();
        own.add_scaled_rows(1.0, &linear.mass, body.points.clone());
        let change = move |x: &[f64]| {
            let m = linear.times(&own, x);
            let c = m.iter().map(|m| alpha * m).collect();
            let none = vec![0.0; x.len()];
            [none, c, m]
        };
        out.push(Quantity {
            name: format!("density.{}", body.name),
            change: Box::new(change),
        });
    }
    out
}

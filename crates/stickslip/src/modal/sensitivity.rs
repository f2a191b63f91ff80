//! How eigenvalues change with friction, contact stiffness, moduli, densities and damping, by left and right eigenvectors.
//!
//! With `P(λ) x = 0` and `yᵀ P(λ) = 0` an eigenvalue changes by `dλ = -yᵀ (dK + λ dC + λ² dM) x / yᵀ (2 λ M + C) x`. The contact state is kept.

use std::f64::consts::TAU;
use std::ops::Range;
use std::sync::Arc;

use super::linear::{Linear, Pair, add_pairs};
use super::outcome::Sensitivity;
use super::quadratic::{Eigen, solve};
use super::shifted::{Root, Shifted};
use crate::linear::{BlockCsr, Complex, pencil};
use crate::math::vector::dot;
use crate::modal::shifted;
use crate::model::definition::Model;
use crate::tolerance::NEGLIGIBLE;

/// What stiffness, damping and mass change by, times a vector.
type Change<'a> = Box<dyn Fn(&[f64]) -> [Vec<f64>; 3] + 'a>;

/// A quantity, and the change of stiffness, damping and mass times a vector that goes with a relative change of it by one.
struct Quantity<'a> {
    name: String,
    change: Change<'a>,
}

impl<'a> Quantity<'a> {
    fn new(what: &str, whose: &str, change: impl Fn(&[f64]) -> [Vec<f64>; 3] + 'a) -> Quantity<'a> {
        Quantity {
            name: format!("{what}.{whose}"),
            change: Box::new(change),
        }
    }
}

/// The changes of all modes with all quantities. Equal eigenvalues split: what is told of each is an eigenvalue of the change in the space of their vectors.
pub(crate) fn all(
    model: &Model,
    shifted: &Shifted,
    root: &mut Root,
    modes: &[Eigen],
    solves: &mut usize,
) -> (Vec<Sensitivity>, Vec<String>) {
    let linear = shifted.linear;
    root.set(1.0, true);
    // A few more, so that none is missing where sizes are nearly equal.
    let left = solve(shifted, root, modes.len() + 4, f64::INFINITY, true, solves);
    root.set(1.0, false);
    let quantities = quantities(model, linear);
    let (mut out, mut notes) = (Vec::new(), Vec::new());
    for group in groups(modes) {
        let own = &modes[group.clone()];
        let partners: Vec<&Eigen> = left.iter().filter(|e| same(e, &own[0])).collect();
        let mut changes = (partners.len() == own.len())
            .then(|| changes(linear, own, &partners, &quantities))
            .flatten()
            .unwrap_or_default();
        if changes.is_empty() {
            notes.push(format!(
                "mode {} has no sensitivities: its eigenvalue comes several times, and not all vectors that belong to it were found; ask for more modes",
                group.start + 1
            ));
        }
        for (k, mode) in group.enumerate() {
            for (quantity, values) in quantities.iter().zip(&mut changes) {
                out.push(Sensitivity {
                    mode: mode + 1,
                    of: quantity.name.clone(),
                    growth: -values[k][0],
                    frequency: -values[k][1] / TAU,
                });
            }
        }
    }
    (out, notes)
}

/// Whether two eigenvalues are one.
fn same(a: &Eigen, b: &Eigen) -> bool {
    let [re, im] = [0, 1].map(|i| a.value[i] - b.value[i]);
    // Two eigenvalues that are nearer to each other are one.
    re.hypot(im) <= NEGLIGIBLE * b.value[0].hypot(b.value[1])
}

/// Modes, by frequency, whose eigenvalues are equal.
fn groups(modes: &[Eigen]) -> Vec<Range<usize>> {
    let mut out: Vec<Range<usize>> = Vec::new();
    for (k, mode) in modes.iter().enumerate() {
        match out.last_mut() {
            Some(last) if same(mode, &modes[last.start]) => last.end = k + 1,
            _ => out.push(k..k + 1),
        }
    }
    out
}

/// By quantity the changes of a group of equal eigenvalues, with the sign turned: eigenvalues of `Yᵀ (dK + λ dC + λ² dM) X` against `Yᵀ (2 λ M + C) X`. `None` where
/// that is singular.
fn changes(
    linear: &Linear,
    modes: &[Eigen],
    partners: &[&Eigen],
    quantities: &[Quantity],
) -> Option<Vec<Vec<Complex>>> {
    let m = modes.len();
    let project = |forces: &dyn Fn(&[f64]) -> [Vec<f64>; 3],
                   factors: &dyn Fn(Complex) -> [Complex; 3]| {
        let mut out = vec![[0.0; 2]; m * m];
        for (j, mode) in modes.iter().enumerate() {
            let [x, y] = [0, 1].map(|i| forces(&mode.vector[i]));
            let factors = factors(mode.value);
            for (i, partner) in partners.iter().enumerate() {
                let parts =
                    (0..3).map(|q| times(factors[q], bilinear(&partner.vector, [&x[q], &y[q]])));
                out[i * m + j] = parts.fold([0.0; 2], add);
            }
        }
        out
    };
    let below =
        project(
            &|x| shifted::forces(linear, x, linear.rub(1.0)),
            &|[l, w]| [[0.0; 2], [1.0, 0.0], [2.0 * l, 2.0 * w]],
        );
    let each = quantities.iter().map(|quantity| {
        let above = project(&*quantity.change, &|v| [[1.0, 0.0], v, times(v, v)]);
        let mut values = pencil(m, &above, &below)?;
        values.sort_by(|a, b| b[1].total_cmp(&a[1]).then(b[0].total_cmp(&a[0])));
        Some(values)
    });
    each.collect()
}

fn add(a: Complex, b: Complex) -> Complex {
    [a[0] + b[0], a[1] + b[1]]
}

fn times(a: Complex, b: Complex) -> Complex {
    [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]]
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
        let of = move |pairs: &[Pair], x: &[f64]| {
            let mut out = vec![0.0; x.len()];
            add_pairs(pairs.iter().filter(|p| p.interface == i), 1.0, x, &mut out);
            out
        };
        let none = |x: &[f64]| vec![0.0; x.len()];
        out.push(Quantity::new("friction", name, move |x| {
            [of(&linear.friction, x), of(&linear.drag, x), none(x)]
        }));
        // Friction follows the pressure, and so how surfaces resist their approach.
        out.push(Quantity::new("contact", name, move |x| {
            let mut k = of(&linear.approach, x);
            let shear = of(&linear.friction, x);
            k.iter_mut().zip(shear).for_each(|(k, s)| *k += s);
            [k, none(x), none(x)]
        }));
    }
    for body in model.elastic() {
        let mut stiffness: BlockCsr = linear.masses().zeros_like();
        body.elastic.stiffness(&mut stiffness);
        let mut mass = linear.masses().zeros_like();
        mass.add_scaled_rows(1.0, linear.masses(), body.points.clone());
        let [alpha, beta] = body.rayleigh;
        let [stiffness, mass] = [stiffness, mass].map(Arc::new);
        let times = move |matrix: &Arc<BlockCsr>, factor: f64| {
            let matrix = Arc::clone(matrix);
            move |x: &[f64]| -> Vec<f64> {
                let product = linear.times_of_all(&matrix, x);
                product.into_iter().map(|v| factor * v).collect()
            }
        };
        let none = |x: &[f64]| vec![0.0; x.len()];
        let (k, c) = (times(&stiffness, 1.0), times(&stiffness, beta));
        out.push(Quantity::new("modulus", &body.name, move |x| {
            [k(x), c(x), none(x)]
        }));
        let (m, c) = (times(&mass, 1.0), times(&mass, alpha));
        out.push(Quantity::new("density", &body.name, move |x| {
            [none(x), c(x), m(x)]
        }));
        if alpha != 0.0 || beta != 0.0 {
            let (m, k) = (times(&mass, alpha), times(&stiffness, beta));
            out.push(Quantity::new("damping", &body.name, move |x| {
                let both = m(x).into_iter().zip(k(x)).map(|(m, k)| m + k);
                [none(x), both.collect(), none(x)]
            }));
        }
    }
    out
}

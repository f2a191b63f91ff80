//! Modes of steady sliding: `(λ² M + λ C + K) x = 0` with the unsymmetric matrices of friction.

use std::f64::consts::TAU;

use super::linear::{Linear, Pair, add_pairs};
use super::map::Over;
use super::outcome::{ModalOutcome, Mode};
use super::quadratic::{Eigen, residuals, solve};
use super::shifted::{Root, Shifted};
use super::{export, map, sensitivity};
use crate::contact::interface::Conditions;
use crate::error::RunError;
use crate::linear::Complex;
use crate::math::vector::dot;
use crate::model::contact::Contact;
use crate::model::definition::Model;
use crate::model::frame::Frame;
use crate::model::modal::{ComplexPlan, MapOver, MapPlan};
use crate::number::digits;

/// The modes that a step asks for.
pub(crate) fn modes(
    model: &Model,
    frame: &Frame,
    contact: &mut Contact,
    conditions: &[Conditions],
    linear: &Linear,
    plan: &ComplexPlan,
) -> Result<ModalOutcome, RunError> {
    let shifted = Shifted::new(linear, frame, true)?;
    let mut root = Root::new(&shifted, frame)?;
    let mut solves = root.pairs.len();
    let asked = (plan.count, plan.to);
    let found = solve(&shifted, &root, plan.count, plan.to, false, &mut solves);
    let mut out = ModalOutcome {
        step: model.steps[frame.step].name.clone(),
        complex: true,
        sliding: linear.sliding.clone(),
        points: linear.points,
        factorisations: shifted.factorisations,
        shapes: plan.shapes,
        notes: notes(linear),
        ..ModalOutcome::default()
    };
    let (open, _) = residuals(&shifted, &found, linear.rub(1.0), &mut solves);
    for (eigen, residual) in found.iter().zip(open) {
        let mut mode = Mode {
            residual,
            ..mode(linear, eigen)
        };
        for part in &mut mode.shape {
            linear.bound.expand(part);
            model.links.impose(part);
        }
        out.modes.push(mode);
    }
    let worst = out.modes.iter().fold(0.0, |w: f64, m| w.max(m.residual));
    // Above this residual of the equations of motion a note says so.
    if worst > 1e-4 {
        out.notes.push(format!(
            "the relative residual of the equations of motion is {worst} in the worst mode: ask for fewer modes",
            worst = digits(worst, 2),
        ));
    }
    if plan.sensitivity {
        let (changes, notes) = sensitivity::all(model, &shifted, &mut root, &found, &mut solves);
        out.sensitivities = changes;
        out.notes.extend(notes);
    }
    if plan.map.is_some() || plan.export {
        let over = plan.map.as_ref().map_or(MapOver::default(), |m| m.over);
        let mut at_speed = |factor: f64| {
            let mut found = linear.at_speed(model, frame, contact, conditions, factor);
            if !plan.friction_damping {
                found.drag.clear();
            }
            found
        };
        let mut over = Over::new(&shifted, over, &mut at_speed);
        let tried = plan.map.as_ref().map_or(vec![1.0], MapPlan::tried);
        let before = solves;
        let (reduced, estimate) = map::space(&mut over, asked, &found, &tried, &mut solves);
        if plan.export {
            out.export = export::matrices(&shifted);
            out.arrays = export::arrays(&shifted, &root, &reduced);
        }
        if let Some(plan) = &plan.map {
            let mut map = map::rows(&mut over, reduced, &estimate, plan, asked, &mut solves);
            map.solves = solves - before;
            out.notes.extend(map::notes(&map));
            out.map = Some(map);
        }
    }
    out.solves = solves;
    Ok(out)
}

/// `xᴴ y` of complex vectors.
fn hermitian(x: &[Vec<f64>; 2], y: &[Vec<f64>; 2]) -> Complex {
    [
        dot(&x[0], &y[0]) + dot(&x[1], &y[1]),
        dot(&x[0], &y[1]) - dot(&x[1], &y[0]),
    ]
}

/// A mode with its figures.
fn mode(linear: &Linear, eigen: &Eigen) -> Mode {
    let [growth, omega] = eigen.value;
    let mut shape = eigen.vector.clone();
    let largest =
        (0..linear.size())
            .map(|i| [shape[0][i], shape[1][i]])
            .fold([0.0, 0.0], |m: Complex, z| {
                if z[0].hypot(z[1]) > m[0].hypot(m[1]) {
                    z
                } else {
                    m
                }
            });
    let [re, im] = [0, 1].map(|k| shape[k].clone());
    let mass = hermitian(
        &shape,
        &[0, 1].map(|k| linear.times(&linear.mass, &shape[k])),
    )[0];
    // A mode has neither size nor phase: mass one, and the largest displacement is real.
    let scale = 1.0 / (largest[0].hypot(largest[1]) * mass.max(f64::MIN_POSITIVE).sqrt());
    let turn = [scale * largest[0], -scale * largest[1]];
    for i in 0..linear.size() {
        shape[0][i] = turn[0] * re[i] - turn[1] * im[i];
        shape[1][i] = turn[0] * im[i] + turn[1] * re[i];
    }
    let size = growth.hypot(omega);
    Mode {
        frequency: omega / TAU,
        growth,
        damping_ratio: if size > 0.0 { -growth / size } else { 0.0 },
        feed: feed(linear, &shape, omega),
        shape,
        ..Mode::default()
    }
}

/// The parts of the growth by interface, and that of damping: `(Im xᴴ K x + ω Re xᴴ C x) / (-2 ω xᴴ M x)`, whose sum is the growth.
fn feed(linear: &Linear, shape: &[Vec<f64>; 2], omega: f64) -> Vec<f64> {
    let mass = hermitian(
        shape,
        &[0, 1].map(|k| linear.times(&linear.mass, &shape[k])),
    )[0];
    let of = |k: &[&Pair], c: &[&Pair]| -> f64 {
        let forces = |pairs: &[&Pair]| {
            [0, 1].map(|q| {
                let mut out = vec![0.0; linear.size()];
                add_pairs(pairs.iter().copied(), 1.0, &shape[q], &mut out);
                out
            })
        };
        let stiffness = hermitian(shape, &forces(k))[1];
        let damping = hermitian(shape, &forces(c))[0];
        let divisor = -2.0 * mass;
        if omega == 0.0 {
            return damping / divisor;
        }
        (stiffness / omega + damping) / divisor
    };
    let mut all: Vec<f64> = (0..linear.sliding.len())
        .map(|i| {
            let own = |pairs: &'_ [Pair]| -> Vec<usize> {
                let all = pairs.iter().enumerate();
                all.filter(|(_, p)| p.interface == i)
                    .map(|(k, _)| k)
                    .collect()
            };
            let k: Vec<&Pair> = own(&linear.friction)
                .into_iter()
                .map(|k| &linear.friction[k])
                .collect();
            let c: Vec<&Pair> = own(&linear.drag)
                .into_iter()
                .map(|k| &linear.drag[k])
                .collect();
            of(&k, &c)
        })
        .collect();
    let damped = [0, 1].map(|k| linear.damped(&shape[k]));
    all.push(-hermitian(shape, &damped)[0] / (2.0 * mass));
    all
}

fn notes(linear: &Linear) -> Vec<String> {
    let mut notes = Vec::new();
    let [stick, steady, others] = linear.points;
    if steady == 0 {
        notes.push("nothing slides all the time: give an interface a `primary-velocity`, `steady.velocity` or `steady.turning`, and press its surfaces in a step with `steady` before".into());
    }
    if others > 0 {
        notes.push(format!(
            "{others} points slide without a direction that lasts: they have no stiffness along the surface, and no friction"
        ));
    }
    if stick > 0 && steady > 0 {
        notes.push(format!(
            "{stick} sticking or tied points have their full tangential stiffness"
        ));
    }
    if linear.damping.is_none() {
        notes.push("no body has damping: how many modes are unstable depends on the mesh, as finer ones have more of them; their growth rates converge".into());
    }
    notes
}

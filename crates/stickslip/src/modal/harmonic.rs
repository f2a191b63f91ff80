//! The answer to harmonic forces: `(K + i ω C - ω² M) x = f`, by superposition of modes.
//!
//! The space is that of the real modes up to above the highest frequency, of the displacements at rest under the forces, by which all higher modes answer, and of
//! those under the friction of both. Damping and friction are projected as they are: nothing says that modes do not share them. Damping that is given by mode is
//! `Σ d (M φ)(M φ)ᵀ`, `d` = 2 ζ ω, which changes no other mode. What the space leaves open in the equations of all dofs is added to it while it is too much, and is
//! told of every frequency.

use std::f64::consts::TAU;

use super::linear::{Linear, fault};
use super::outcome::{ModalOutcome, Response, ResponseRow};
use super::quadratic::UNSTABLE_GROWTH;
use super::real::{frequency, lowest};
use super::reduced::{Reduced, images};
use super::shifted::Shifted;
use crate::error::RunError;
use crate::linear::{DenseLu, RealModes};
use crate::math::vector::dot;
use crate::modal::{companion, shifted};
use crate::model::definition::Model;
use crate::model::frame::Frame;
use crate::model::modal::HarmonicPlan;
use crate::number::digits;

/// Rounds in which what is left open is added, at most.
const HARMONIC_ROUNDS: usize = 5;

/// At so many frequencies it is seen whether the space is good enough, before it is used at all of them.
const TRIED_FREQUENCIES: usize = 12;

/// Amplitudes, real and imaginary part.
type Pair = [Vec<f64>; 2];

/// The answers that a step asks for.
pub(crate) fn response(
    model: &Model,
    frame: &Frame,
    linear: &Linear,
    plan: &HarmonicPlan,
) -> Result<ModalOutcome, RunError> {
    let shifted = Shifted::new(linear, frame, true)?;
    let mut solves = 0;
    let mut shaken = Shaken {
        shifted: &shifted,
        forces: forces(model, linear, plan),
        frequencies: Vec::new(),
        modal: Vec::new(),
    };
    let reduced = shaken.space(plan, &mut solves);
    let mut answer = Response {
        columns: columns(model),
        dimension: reduced.basis.len(),
        ..Response::default()
    };
    for frequencies in shaken.frequencies.chunks(TRIED_FREQUENCIES) {
        let found = shaken.answers(&reduced, frequencies, &mut solves);
        for (frequency, (mut shape, residual, _)) in frequencies.iter().zip(found) {
            if !residual.is_finite() {
                let message = format!("nothing resists the forces at the frequency {frequency}");
                return Err(fault(frame, message));
            }
            for part in &mut shape {
                linear.bound.expand(part);
                model.links.impose(part);
            }
            let values = values(model, &shape);
            if !plan.shapes {
                shape = Pair::default();
            }
            answer.rows.push(ResponseRow {
                frequency: *frequency,
                residual,
                values,
                shape,
            });
        }
    }
    Ok(ModalOutcome {
        step: model.steps[frame.step].name.clone(),
        sliding: linear.sliding.clone(),
        points: linear.points,
        factorisations: shifted.factorisations,
        solves,
        shapes: plan.shapes,
        notes: notes(linear, &reduced, &answer, plan),
        response: Some(answer),
        ..ModalOutcome::default()
    })
}

/// Forces by dof, cosine and sine part.
fn forces(model: &Model, linear: &Linear, plan: &HarmonicPlan) -> Pair {
    let mut forces = [0, 1].map(|_| vec![0.0; linear.size()]);
    for (name, phase) in &plan.loads {
        let (s, c) = phase.sin_cos();
        for load in model.actions.loads.iter().filter(|l| l.name == *name) {
            for &(dof, force) in &load.entries {
                forces[0][dof] += c * force;
                forces[1][dof] += s * force;
            }
        }
    }
    for part in &mut forces {
        model.links.transfer(part);
        linear.bound.gather(part);
        let free = part.iter_mut().zip(&linear.fixed);
        free.filter(|(_, fixed)| **fixed)
            .for_each(|(f, _)| *f = 0.0);
    }
    forces
}

/// What is solved.
struct Shaken<'a> {
    shifted: &'a Shifted<'a>,
    /// Forces by dof.
    forces: Pair,
    frequencies: Vec<f64>,
    /// Damping by mode: `d` and `M φ`.
    modal: Vec<(f64, Vec<f64>)>,
}

/// An answer, what it leaves open relative to what is in it, and the displacements at rest under that.
type Answer = (Pair, f64, Vec<Vec<f64>>);

impl Shaken<'_> {
    /// The space in which the equations are solved; frequencies and damping follow from its modes.
    fn space(&mut self, plan: &HarmonicPlan, solves: &mut usize) -> Reduced {
        let shifted = self.shifted;
        let highest = plan.frequencies.highest();
        // Modes up to 1.5 times the highest frequency are in the space.
        let below = (1.5 * TAU * highest).powi(2);
        let count = plan.count.min(shifted.linear.free());
        let modes = lowest(shifted, count, below);
        *solves += modes.solves + 2;
        self.take(plan, &modes);
        let mut reduced = Reduced::new(shifted, (TAU * highest).max(f64::MIN_POSITIVE));
        let damped = |x: &[f64]| self.damped(x);
        let mut block = reduced.grow(shifted, &damped, modes.vectors);
        let still = shifted.solved(&self.forces);
        block.extend(reduced.grow(shifted, &damped, still));
        let images = images(shifted, &block, solves);
        reduced.grow(shifted, &damped, images);
        let every = self.frequencies.len().div_ceil(TRIED_FREQUENCIES).max(1);
        let tried: Vec<f64> = self.frequencies.iter().copied().step_by(every).collect();
        for _ in 0..HARMONIC_ROUNDS {
            let found = self.answers(&reduced, &tried, solves);
            let open = found
                .into_iter()
                // A smaller residual in the equations of all dofs is good enough.
                .filter(|(_, residual, _)| *residual > 1e-5);
            let rests: Vec<Vec<f64>> = open.flat_map(|(.., rest)| rest).collect();
            if rests.is_empty() {
                break;
            }
            reduced.grow(shifted, &damped, rests);
        }
        reduced
    }

    /// What follows from the modes.
    fn take(&mut self, plan: &HarmonicPlan, modes: &RealModes) {
        let (linear, shift) = (self.shifted.linear, self.shifted.shift());
        let values = modes.values.iter();
        let frequencies: Vec<f64> = values.map(|v| frequency(*v, shift)).collect();
        self.frequencies = plan.frequencies.among(&frequencies);
        let each = frequencies.iter().zip(&modes.vectors).enumerate();
        let damped = each.filter_map(|(i, (frequency, x))| {
            let d = plan.damping.of(i, TAU * frequency);
            (d > 0.0).then(|| (d, linear.times(&linear.mass, x)))
        });
        self.modal = damped.collect();
    }

    /// What damping that has no friction makes of velocities.
    fn damped(&self, x: &[f64]) -> Vec<f64> {
        let mut out = self.shifted.linear.damped(x);
        self.add_modal(x, &mut out);
        out
    }

    /// Adds what damping by mode makes of velocities.
    fn add_modal(&self, x: &[f64], out: &mut [f64]) {
        for (d, image) in &self.modal {
            let along = d * dot(image, x);
            out.iter_mut().zip(image).for_each(|(c, m)| *c += along * m);
        }
    }

    /// The answers at frequencies.
    fn answers(&self, reduced: &Reduced, frequencies: &[f64], solves: &mut usize) -> Vec<Answer> {
        let found: Vec<Pair> = frequencies
            .iter()
            .map(|f| answer(reduced, &self.forces, TAU * f))
            .collect();
        let each = found.iter().zip(frequencies);
        let open: Vec<Vec<f64>> = each.flat_map(|(x, f)| self.open(x, TAU * f)).collect();
        let solved = self.shifted.solved(&open);
        *solves += solved.len();
        let rests = open.chunks(2).zip(solved.chunks(2));
        let all = found.into_iter().zip(rests).map(|(x, (open, solved))| {
            let residual = self.shifted.relative(open, solved, &x);
            (x, residual, solved.to_vec())
        });
        all.collect()
    }

    /// `f - (K + i ω C - ω² M) x`.
    fn open(&self, x: &Pair, omega: f64) -> Pair {
        let linear = self.shifted.linear;
        let mut parts = [0, 1].map(|q| shifted::forces(linear, &x[q], linear.rub(1.0)));
        for (part, x) in parts.iter_mut().zip(x) {
            self.add_modal(x, &mut part[1]);
        }
        let mut open = self.forces.clone();
        for (q, sign) in [(0, -1.0), (1, 1.0)] {
            let ([k, _, m], [_, c, _]) = (&parts[q], &parts[1 - q]);
            for i in (0..linear.size()).filter(|&i| !linear.fixed[i]) {
                open[q][i] -= k[i] - omega * omega * m[i] + sign * omega * c[i];
            }
        }
        open
    }
}

/// Displacements under forces of an angular frequency.
fn answer(reduced: &Reduced, forces: &Pair, omega: f64) -> Pair {
    let r = reduced.basis.len();
    if r == 0 {
        // Forces of no size, and no mode near: nothing moves.
        return forces.clone().map(|part| vec![0.0; part.len()]);
    }
    let still =
        |k: usize| reduced.stiffness[k] + reduced.friction[k] - omega * omega * reduced.mass[k];
    let damped = |k: usize| omega * (reduced.damping[k] + reduced.drag[k]);
    let entry = |k: usize| {
        let (i, j) = (k / (2 * r), k % (2 * r));
        let at = i % r * r + j % r;
        match (i < r, j < r) {
            (true, false) => -damped(at),
            (false, true) => damped(at),
            _ => still(at),
        }
    };
    let matrix: Vec<f64> = (0..4 * r * r).map(entry).collect();
    let parts = forces.iter();
    let mut z: Vec<f64> = parts
        .flat_map(|f| reduced.basis.iter().map(|q| dot(q, f)))
        .collect();
    DenseLu::new(2 * r, &matrix).solve(&mut z);
    [0, 1].map(|q| {
        let mut x = vec![0.0; forces[0].len()];
        for (z, b) in z[q * r..].iter().zip(&reduced.basis) {
            x.iter_mut().zip(b).for_each(|(x, b)| *x += z * b);
        }
        x
    })
}

/// Columns of displacements of probes.
fn columns(model: &Model) -> Vec<String> {
    let probes = model.reports.probes.iter();
    let all = probes.flat_map(|p| (1..=model.dofs.dim).map(move |c| format!("{}.U{c}", p.name)));
    all.collect()
}

fn values(model: &Model, shape: &Pair) -> Vec<[f64; 2]> {
    let dofs = model.dofs;
    let probes = model.reports.probes.iter();
    let all = probes.flat_map(|p| (0..dofs.dim).map(move |c| dofs.of(p.point, c)));
    all.map(|dof| [shape[0][dof], shape[1][dof]]).collect()
}

fn notes(
    linear: &Linear,
    reduced: &Reduced,
    answer: &Response,
    plan: &HarmonicPlan,
) -> Vec<String> {
    let mut notes = Vec::new();
    let worst = answer.rows.iter().fold(0.0, |w: f64, r| w.max(r.residual));
    // Above this residual a note says so.
    if worst > 1e-3 {
        notes.push(format!(
            "the relative residual of the equations of motion is {worst} at the worst frequency: give the step a larger `count` of modes",
            worst = digits(worst, 2),
        ));
    }
    // Without friction nothing grows.
    let [value, omega] = match linear.friction.is_empty() && linear.drag.is_empty() {
        true => [0.0; 2],
        false => companion::fastest_of(reduced, (plan.count, f64::INFINITY)),
    };
    if value > UNSTABLE_GROWTH * value.hypot(omega) {
        notes.push(format!(
            "sliding is unstable: a motion of the frequency {} grows by {value}, so that no motion settles at the answer to the forces",
            digits(omega / TAU, 5),
            value = digits(value, 5),
        ));
    }
    let [_, _, others] = linear.points;
    if others > 0 {
        notes.push(format!(
            "{others} points slide without a direction that lasts: they have no stiffness along the surface, and no friction"
        ));
    }
    notes
}

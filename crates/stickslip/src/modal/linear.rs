//! The model linearised about the state that it has reached.

use std::collections::BTreeSet;

use super::bound::{Bound, Sparse};
use crate::body::MassKind;
use crate::body::couplings::{Meets, Row};
use crate::contact::interface::{Conditions, LinearPoint, linearise};
use crate::contact::response::Status;
use crate::error::RunError;
use crate::linear::BlockCsr;
use crate::model::contact::Contact;
use crate::model::definition::{Model, Step};
use crate::model::frame::Frame;
use crate::solve::inertia::Inertia;
use crate::solve::solver::{Solver, entries};
use crate::system::{ContactBlock, Links, Stage};

/// The time at which modes of a step are asked for `[s]`.
fn soon(step: &Step) -> f64 {
    // What acts in a step acts after a thousandth of it.
    step.start + 1e-3 * (step.end - step.start)
}

/// A matrix of rank one, `left rightᵀ`.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Pair {
    pub left: Sparse,
    pub right: Sparse,
    /// Index of the interface in [`Linear::sliding`].
    pub interface: usize,
    /// Number of the contact point in the interface.
    pub point: usize,
    /// Whether it follows from how surfaces approach, and not from the pressure at hand.
    pub approach: bool,
}

impl Pair {
    /// Left and right; the other way round in the transposed problem.
    pub fn sides(&self, transposed: bool) -> (&Sparse, &Sparse) {
        match transposed {
            true => (&self.right, &self.left),
            false => (&self.left, &self.right),
        }
    }
}

/// Friction: what it adds to stiffness and damping. Factors: of what follows motion across the surface, and of what goes with the pressure at hand.
#[derive(Debug, Clone, Copy)]
pub(crate) struct FrictionTerms<'a> {
    pub friction: &'a [Pair],
    pub drag: &'a [Pair],
    pub factors: [f64; 2],
}

/// Matrices of small motions: `M ẍ + (C + f Σ drag) ẋ + (K + f Σ friction) x = 0` with the friction `f` relative to that of the state.
pub(crate) struct Linear {
    /// Bodies, springs, couplings and closed contacts, symmetric.
    pub stiffness: BlockCsr,
    /// Masses.
    pub mass: BlockCsr,
    /// Bodies, dashpots and the approach of surfaces, symmetric.
    pub damping: Option<BlockCsr>,
    /// The part of the stiffness by which surfaces that slide resist their approach.
    pub approach: Vec<Pair>,
    /// What friction adds to the stiffness: shear that follows the pressure.
    pub friction: Vec<Pair>,
    /// What friction adds to the damping: shear that turns with the sliding, and follows its speed.
    pub drag: Vec<Pair>,
    /// Dofs that are no unknowns.
    pub fixed: Vec<bool>,
    /// Those among them that follow others by equations: the matrices are those of the others.
    pub bound: Bound,
    /// The masses of all dofs, where some follow others.
    pub masses: Option<BlockCsr>,
    /// Interfaces that slide all the time.
    pub sliding: Vec<String>,
    /// Points that stick, slide all the time, and slide otherwise.
    pub points: [usize; 3],
    /// Mean coefficient of friction where sliding lasts.
    pub mu: f64,
}

impl Linear {
    pub fn new(
        model: &Model,
        frame: &Frame,
        contact: &mut Contact,
        solver: &Solver,
    ) -> Result<Self, RunError> {
        let step = &model.steps[frame.step];
        let t = soon(step);
        let fixed = frame.constraints(model, t).fixed;
        let (mut parts, mut equations) = (Parts::default(), Vec::new());
        for (row, meets) in contact.coupled(frame).linearise(t) {
            let (stiffness, damping) = match meets {
                Meets::Equation => {
                    equations.push(moved(row, &model.links));
                    continue;
                }
                Meets::Spring(stiffness) => (stiffness, 0.0),
                Meets::Dashpot(coefficient) => (0.0, coefficient),
            };
            let block = ContactBlock {
                dofs: row.dofs.clone(),
                rows: row.factors.clone(),
                ..ContactBlock::default()
            };
            parts.couple(&model.links, block, stiffness, damping);
        }
        let bound = Bound::new(equations, &fixed);
        let lines = points(model, frame, contact, &solver.conditions, 1.0);
        let mut linear = Linear::empty(model.dofs.dim, fixed, bound);
        linear.add_all(model, &lines, &mut parts);
        parts.assemble(model, contact, solver, &mut linear);
        match linear.stiffness.first_not_finite() {
            None => Ok(linear),
            Some(_) => Err(fault(frame, "the linearised stiffness is not finite")),
        }
    }

    fn empty(dim: usize, mut fixed: Vec<bool>, bound: Bound) -> Self {
        bound.dofs().for_each(|dof| fixed[dof] = true);
        Linear {
            stiffness: BlockCsr::empty(dim),
            mass: BlockCsr::empty(dim),
            damping: None,
            approach: Vec::new(),
            friction: Vec::new(),
            drag: Vec::new(),
            fixed,
            bound,
            masses: None,
            sliding: Vec::new(),
            points: [0; 3],
            mu: 0.0,
        }
    }

    /// All friction times a factor.
    pub fn rub(&self, factor: f64) -> FrictionTerms<'_> {
        FrictionTerms {
            friction: &self.friction,
            drag: &self.drag,
            factors: [factor; 2],
        }
    }

    /// Friction alone, at so many times the speed of sliding and the pressures of the state: laws are evaluated there. The rest is as it was.
    pub fn at_speed(
        &self,
        model: &Model,
        frame: &Frame,
        contact: &mut Contact,
        conditions: &[Conditions],
        factor: f64,
    ) -> Linear {
        let lines = points(model, frame, contact, conditions, factor);
        let mut linear = Linear::empty(model.dofs.dim, self.fixed.clone(), self.bound.clone());
        linear.add_all(model, &lines, &mut Parts::default());
        linear
    }

    /// Adds the points of all interfaces.
    fn add_all(&mut self, model: &Model, lines: &[(String, Vec<LinearPoint>)], parts: &mut Parts) {
        let (mut limit, mut pressure) = (0.0, 0.0);
        for (name, points) in lines {
            if points.iter().any(|p| p.steady) {
                self.sliding.push(name.clone());
            }
            for point in points {
                self.count(point);
                if point.steady {
                    limit += point.area * point.limit;
                    pressure += point.area * point.pressure;
                }
                self.add(model, point, parts);
            }
        }
        self.mu = if pressure > 0.0 {
            limit / pressure
        } else {
            0.0
        };
    }

    fn count(&mut self, point: &LinearPoint) {
        let which = match (point.status, point.steady) {
            (Status::Stick, _) => 0,
            (_, true) => 1,
            _ => 2,
        };
        self.points[which] += 1;
    }

    /// Adds a contact point.
    fn add(&mut self, model: &Model, point: &LinearPoint, parts: &mut Parts) {
        let n = point.dofs.len();
        let block = ContactBlock {
            dofs: point.dofs.clone(),
            rows: point.rows.clone(),
            change: vec![0.0; 3 * n],
            ..ContactBlock::default()
        };
        let block = model.links.transform(&block).unwrap_or(block);
        let n = block.dofs.len();
        let row = |q: usize| &block.rows[q * n..(q + 1) * n];
        // Against the gap, and against slip where it sticks; all of it is symmetric.
        for (q, own) in point.stiffness.iter().enumerate() {
            for (j, k) in own.iter().enumerate() {
                let shear = q > 0 && j > 0 && !point.steady;
                let mean = 0.5 * (k + point.stiffness[j][q]);
                if (q + j == 0 || shear) && mean != 0.0 {
                    parts.dense(&block.dofs, row(q), row(j), mean, false);
                }
            }
        }
        let approach = point.damping[0][0];
        if approach != 0.0 {
            parts.dense(&block.dofs, row(0), row(0), approach, true);
        }
        if point.steady {
            self.add_friction(point, &block);
        }
    }

    /// Adds what friction does at a point that slides all the time.
    fn add_friction(&mut self, point: &LinearPoint, block: &ContactBlock) {
        let n = block.dofs.len();
        let (k, c) = (point.stiffness, point.damping);
        let interface = self.sliding.len() - 1;
        let sum = |factors: [f64; 3]| -> Sparse {
            let rows = block.rows.chunks_exact(n).zip(factors);
            let mut sum = vec![0.0; n];
            for (row, factor) in rows {
                sum.iter_mut().zip(row).for_each(|(s, r)| *s += factor * r);
            }
            let entries: Sparse = block.dofs.iter().copied().zip(sum).collect();
            let mut entries = self.bound.row(&entries);
            entries.retain(|(dof, v)| !self.fixed[*dof] && *v != 0.0);
            entries
        };
        let unit = |q: usize| std::array::from_fn(|i| if i == q { 1.0 } else { 0.0 });
        let pair = |left: [f64; 3], right: [f64; 3], approach: bool| Pair {
            left: sum(left),
            right: sum(right),
            interface,
            point: point.point,
            approach,
        };
        let across = pair([k[0][0], 0.0, 0.0], unit(0), true);
        let friction = pair([0.0, k[1][0], k[2][0]], unit(0), true);
        let drags = [
            pair([0.0, c[1][0], c[2][0]], unit(0), true),
            pair(unit(1), [0.0, c[1][1], c[1][2]], false),
            pair(unit(2), [0.0, c[2][1], c[2][2]], false),
        ];
        let acts = |p: &Pair| !p.left.is_empty() && !p.right.is_empty();
        self.approach.extend(Some(across).filter(acts));
        self.friction.extend(Some(friction).filter(acts));
        self.drag.extend(drags.into_iter().filter(acts));
    }

    /// Makes the matrices those of the dofs that follow no others.
    fn leave_out_bound(&mut self) {
        if self.bound.is_empty() {
            return;
        }
        let damping = self.damping.as_ref();
        let all: Vec<&BlockCsr> = [&self.stiffness, &self.mass]
            .into_iter()
            .chain(damping)
            .collect();
        let mut reduced = self.bound.reduce(&all).into_iter();
        if let (Some(stiffness), Some(mass)) = (reduced.next(), reduced.next()) {
            self.damping = reduced.next();
            self.stiffness = stiffness;
            self.masses = Some(std::mem::replace(&mut self.mass, mass));
        }
    }

    /// The masses of all dofs, those that follow others among them.
    pub fn masses(&self) -> &BlockCsr {
        self.masses.as_ref().unwrap_or(&self.mass)
    }

    /// `Tᵀ A T x` of a matrix of all dofs, without the rows of what is no unknown.
    pub fn times_of_all(&self, matrix: &BlockCsr, x: &[f64]) -> Vec<f64> {
        let mut moved = x.to_vec();
        self.bound.expand(&mut moved);
        let mut out = vec![0.0; x.len()];
        matrix.mul(&moved, &mut out);
        self.bound.gather(&mut out);
        for (o, &fixed) in out.iter_mut().zip(&self.fixed) {
            if fixed {
                *o = 0.0;
            }
        }
        out
    }

    /// Entries of a vector.
    pub fn size(&self) -> usize {
        self.fixed.len()
    }

    /// How many unknowns there are.
    pub fn free(&self) -> usize {
        self.fixed.iter().filter(|f| !**f).count()
    }

    /// `out = A x` without the rows of what is fixed.
    pub fn times(&self, matrix: &BlockCsr, x: &[f64]) -> Vec<f64> {
        let mut out = vec![0.0; x.len()];
        matrix.mul(x, &mut out);
        for (o, &fixed) in out.iter_mut().zip(&self.fixed) {
            if fixed {
                *o = 0.0;
            }
        }
        out
    }

    /// `C x` of what has a symmetric damping.
    pub fn damped(&self, x: &[f64]) -> Vec<f64> {
        match &self.damping {
            Some(damping) => self.times(damping, x),
            None => vec![0.0; x.len()],
        }
    }
}

/// `out += factor Σ left (rightᵀ x)`.
pub(crate) fn add_pairs<'a>(
    pairs: impl IntoIterator<Item = &'a Pair>,
    factor: f64,
    x: &[f64],
    out: &mut [f64],
) {
    for pair in pairs {
        let along = factor * product(&pair.right, x);
        pair.left.iter().for_each(|&(dof, v)| out[dof] += along * v);
    }
}

/// `rowᵀ x`.
pub(crate) fn product(row: &Sparse, x: &[f64]) -> f64 {
    row.iter().map(|&(dof, v)| v * x[dof]).sum()
}

/// An error at the time of the state.
pub(crate) fn fault(frame: &Frame, message: impl Into<String>) -> RunError {
    RunError {
        message: message.into(),
        time: frame.state.t,
        culprits: Vec::new(),
        help: None,
    }
}

/// Contact points by interface, at the state that was reached.
fn points(
    model: &Model,
    frame: &Frame,
    contact: &mut Contact,
    conditions: &[Conditions],
    pace: f64,
) -> Vec<(String, Vec<LinearPoint>)> {
    let step = &model.steps[frame.step];
    let from = &frame.state;
    let mut at = from.clone();
    at.t = soon(step);
    let stage = Stage {
        from,
        at: &at,
        dt: step.end - step.start,
        rate: None,
        frames: None,
    };
    let all = contact.interfaces.iter().zip(conditions);
    let at_pace = all.map(|(i, c)| c.at_pace(model.sliding(frame.step, &i.name), pace));
    let conditions: Vec<Conditions> = at_pace.collect();
    let mut forces = contact.forces(&frame.contacts, &conditions).interfaces;
    let lines = forces.iter_mut();
    lines
        .map(|i| (i.name.clone(), linearise(i, &stage)))
        .collect()
}

/// Dense symmetric blocks between points.
#[derive(Default)]
struct Parts {
    stiffness: Vec<(Vec<usize>, Vec<f64>)>,
    damping: Vec<(Vec<usize>, Vec<f64>)>,
}

impl Parts {
    /// Adds a row of a coupling with its stiffness and damping.
    fn couple(&mut self, links: &Links, block: ContactBlock, stiffness: f64, damping: f64) {
        let mut block = block;
        let n = block.dofs.len();
        block.rows.resize(3 * n, 0.0);
        block.change = vec![0.0; 3 * n];
        let block = links.transform(&block).unwrap_or(block);
        let row = &block.rows[..block.dofs.len()];
        for (value, damping) in [(stiffness, false), (damping, true)] {
            if value != 0.0 {
                self.dense(&block.dofs, row, row, value, damping);
            }
        }
    }

    /// Adds `value a bᵀ`, by dofs as they come.
    fn dense(&mut self, dofs: &[usize], a: &[f64], b: &[f64], value: f64, damping: bool) {
        let n = dofs.len();
        let values = (0..n * n).map(|k| value * a[k / n] * b[k % n]).collect();
        let to = if damping {
            &mut self.damping
        } else {
            &mut self.stiffness
        };
        match to.last_mut() {
            Some((known, sum)) if known == dofs => {
                let values: Vec<f64> = values;
                sum.iter_mut().zip(values).for_each(|(s, v)| *s += v);
            }
            _ => to.push((dofs.to_vec(), values)),
        }
    }

    /// Puts bodies and blocks together.
    fn assemble(self, model: &Model, contact: &Contact, solver: &Solver, linear: &mut Linear) {
        let dim = model.dofs.dim;
        let each = |(dofs, dense): &(Vec<usize>, Vec<f64>)| by_points(dofs, dense, dim);
        let stiffness: Vec<_> = self.stiffness.iter().map(each).collect();
        let damping: Vec<_> = self.damping.iter().map(each).collect();
        let mut all = stiffness.clone();
        // One pattern for all matrices.
        all.extend(damping.iter().map(|(p, d)| (p.clone(), vec![0.0; d.len()])));
        linear.stiffness = match all.is_empty() {
            true => entries(&solver.stiffness).clone(),
            false => entries(&solver.stiffness).with_groups(&all),
        };
        let kind = MassKind::default();
        let inertia = Inertia::of_modes(model, contact, &linear.stiffness, kind);
        let (mass, rayleigh) = inertia.into_matrices();
        linear.mass = mass;
        linear.damping = rayleigh;
        if !damping.is_empty() {
            let matrix = linear
                .damping
                .get_or_insert_with(|| linear.mass.zeros_like());
            for (points, dense) in &damping {
                matrix.add_group(points, dense);
            }
        }
        linear.leave_out_bound();
    }
}

/// A row over what moves its dofs.
fn moved(row: &Row, links: &Links) -> Sparse {
    let terms = row.terms().flat_map(|(dof, a)| match links.row(dof) {
        Some(hidden) => hidden.map(|(other, factor)| (other, factor * a)).to_vec(),
        None => vec![(dof, a)],
    });
    terms.collect()
}

/// A block by dofs as one over all dofs of its points.
fn by_points(dofs: &[usize], dense: &[f64], dim: usize) -> (Vec<usize>, Vec<f64>) {
    let points: BTreeSet<usize> = dofs.iter().map(|d| d / dim).collect();
    let points: Vec<usize> = points.into_iter().collect();
    let width = points.len() * dim;
    let place = |dof: usize| -> usize {
        let at = points.binary_search(&(dof / dim)).unwrap_or_default();
        at * dim + dof % dim
    };
    let mut out = vec![0.0; width * width];
    for (row, &i) in dense.chunks_exact(dofs.len()).zip(dofs) {
        for (value, &j) in row.iter().zip(dofs) {
            out[place(i) * width + place(j)] += value;
        }
    }
    (points, out)
}

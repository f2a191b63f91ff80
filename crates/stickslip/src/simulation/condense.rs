//! Quasi-static increments on the contact candidates.

use std::time::Instant;

use super::accepted::{Accepted, Flow};
use super::choice::cost_fits;
use super::inertia;
use super::model::Solution;
use super::pending::Pending;
use super::run::{Observer, Simulation};
use crate::contact::interface::Reach;
use crate::error::Error;
use crate::linear::BlockCsr;
use crate::math::Vec3;
use crate::math::vector::dot;
use crate::newton::condensed::{
    Amplitudes, Condensation, CondensedBulk, LoadPatterns, Places, Plan, ReducedSystem,
};
use crate::newton::{Factors, Progress, System};
use crate::system::{Cause, State, StepFailure};
use crate::time::Trial;

/// Points of interfaces below which all of them are candidates.
const FEW: usize = 60;

/// How often candidates are added before all points are.
const MOST_WIDENED: usize = 4;

/// Times within a step at which supports are looked at.
const SAMPLES: usize = 16;

/// The bodies without their interiors, and where the analysis stands.
pub(super) struct Condensed {
    condensation: Condensation,
    /// The candidates it was made for.
    kept: Vec<bool>,
    gaps: ReducedSystem,
    shapes: LoadPatterns,
    /// The last accepted state: displacements are known at candidates and where prescribed.
    pub(super) state: State,
    /// Forces with which the candidates yield to where they are.
    carried: Vec<f64>,
    /// The increment before: its length, displacements of the candidates and forces.
    previous: Option<(f64, Vec<f64>, Vec<f64>)>,
    /// What the last attempt found.
    found: Option<(Amplitudes, Vec<f64>)>,
}

/// Out-of-balance force relative to the forces in play that rounding may leave in the interior.
pub(super) const LEFT: f64 = 1e-6;

/// Forces that are none, relative to the largest there were in the analysis.
const NOTHING: f64 = 1e-8;

impl Condensed {
    /// The bodies without their interiors.
    pub(super) fn condensation(&self) -> &Condensation {
        &self.condensation
    }

    pub(super) fn forget_direction(&mut self) {
        self.previous = None;
    }
}

impl Simulation {
    /// Makes the bodies ready for a quasi-static step.
    pub(super) fn condense(&mut self) -> Result<(), Error> {
        if !self.model.method.condenses() {
            return Ok(());
        }
        let step = &self.model.steps[self.step];
        let held = self.constraints(0.5 * (step.start + step.end)).fixed;
        let kept = self.kept.clone().unwrap_or_default();
        if let Some(condensed) = &mut self.condensed
            && condensed.condensation.held == held
            && condensed.kept == kept
        {
            condensed.forget_direction();
            return Ok(());
        }
        let matrix = std::mem::replace(&mut self.matrix, BlockCsr::empty(self.model.dofs.dim));
        let made = self.condensation(&held, &kept, &matrix);
        self.matrix = matrix;
        let Some(condensation) = made else {
            self.condensed = None;
            return Ok(());
        };
        // Forces that go with the displacements the step starts from.
        let mut at = vec![0.0; held.len()];
        let u = condensation.gather(&self.state.u);
        condensation.scatter(&u, &mut at);
        let mut carried = vec![0.0; u.len()];
        if u.iter().any(|u| *u != 0.0) {
            carried = condensation.sweep(&inertia::times(&self.matrix, &at)).0;
            let mut springs = vec![0.0; u.len()];
            condensation.release(&u, &mut springs);
            carried.iter_mut().zip(&springs).for_each(|(c, s)| *c -= s);
        }
        self.condensed = Some(Condensed {
            condensation,
            kept,
            gaps: ReducedSystem::default(),
            shapes: LoadPatterns::default(),
            state: self.state.clone(),
            carried,
            previous: None,
            found: None,
        });
        Ok(())
    }

    /// Factors the bodies with one of their matrices, as far as the library does not have them; `None` where the analysis goes on with the sparse matrix.
    pub(super) fn condensation(
        &mut self,
        held: &[bool],
        kept: &[bool],
        matrix: &BlockCsr,
    ) -> Option<Condensation> {
        let typical = self.diagonal.iter().fold(0.0_f64, |m, d| m.max(*d));
        let typical = if typical > 0.0 { typical } else { 1.0 };
        let points = &self.model.mesh.points;
        let places = |p: usize| -> Option<Vec3> { points.get(p).copied() };
        let springs: (Places, f64) = (&places, typical);
        let library = &*self.library;
        let plan = match Plan::new(matrix, &self.parts(), (held, kept), springs, library) {
            Ok(plan) => plan,
            Err(e) => return self.not_condensed(&e.to_string()),
        };
        if self.decided.as_deref() != Some(held) {
            let choice = self.choose(&plan.cost(), (matrix, held));
            let forced = self.model.method == Solution::Condensed;
            let fits = cost_fits(plan.cost().bytes);
            let method = if forced && fits {
                Solution::Condensed
            } else {
                choice.method
            };
            if forced && !fits {
                self.notes.push(format!(
                    "`solver.method = \"condensed\"` needs about {:.1} GB, more than is free",
                    plan.cost().bytes as f64 / 1e9
                ));
            }
            let name = match method {
                Solution::Condensed => "condensed",
                Solution::Multigrid => "multigrid",
                _ => "sparse matrix",
            };
            self.notes.push(format!("{name}: {}", choice.reason));
            self.summary.method_reason = choice.reason;
            if method != Solution::Condensed {
                self.model.method = method;
                if method == Solution::Multigrid {
                    self.factors = Factors::multigrid(self.model.places());
                }
                self.choose_candidates();
                return None;
            }
            self.decided = Some(held.to_vec());
        }
        let cost = plan.cost();
        if !cost_fits(cost.bytes) {
            return self.not_condensed("it would take more memory than is free");
        }
        let started = Instant::now();
        let made = Condensation::new(plan, matrix, held, springs, library);
        let (condensation, effort) = match made {
            Ok(made) => made,
            Err(e) => return self.not_condensed(&e.to_string()),
        };
        let statistics = &mut self.newton.statistics;
        statistics.factor_nonzeros = cost.nonzeros as usize;
        statistics.factor_bytes = cost.bytes;
        if effort.made > 0 {
            statistics.flops += cost.factor + cost.condense;
        }
        statistics.analyses += effort.analysed;
        statistics.factorisations += effort.made;
        statistics.substructures_made += effort.made;
        statistics.substructures_shared += effort.shared;
        statistics.substructures_read += effort.read;
        statistics.seconds_find += effort.seconds_find;
        statistics.seconds_order += effort.seconds_order;
        // Bodies are factored side by side: their times are shares of the time that has passed.
        let passed = (started.elapsed().as_secs_f64() - effort.seconds_find).max(0.0);
        let spent = effort.seconds.factor + effort.seconds.condense;
        let share = if spent > 0.0 { passed / spent } else { 0.0 };
        let (factor, condense) = (
            share * effort.seconds.factor,
            share * effort.seconds.condense,
        );
        statistics.seconds_factor += factor;
        statistics.seconds_condense += condense;
        if statistics.linear_solve == 0.0 && effort.made > 0 {
            // To factor the root costs a third of its inverse.
            statistics.linear_solve = effort.seconds_order + factor + condense / 3.0;
        }
        self.notes.extend(effort.notes);
        self.summary.method = "condensed".into();
        Some(condensation)
    }

    /// The analysis goes on with the sparse matrix.
    fn not_condensed(&mut self, why: &str) -> Option<Condensation> {
        self.condensed = None;
        self.notes.push(format!("not condensed: {why}"));
        self.model.method = Solution::Sparse;
        self.choose_candidates();
        None
    }

    /// Points of the parts of the model that are not coupled but by contact.
    fn parts(&self) -> Vec<std::ops::Range<usize>> {
        let bodies = self.model.elastic().map(|b| b.points.clone());
        let links = self.model.links.all().iter();
        bodies
            .chain(links.map(|l| l.hidden..l.hidden + 2))
            .collect()
    }

    /// Points that may come into contact in this step, as far as can be told; never fewer than before. Those that may not are
    /// not looked at.
    pub(super) fn choose_candidates(&mut self) {
        match self.model.method {
            Solution::Multigrid => self.summary.method = "multigrid".into(),
            Solution::Sparse => self.summary.method = "sparse".into(),
            Solution::Automatic | Solution::Condensed => {}
        }
        let points = self.model.dofs.points;
        let mut kept = self.kept.take().unwrap_or_else(|| vec![false; points]);
        let mut all = vec![false; points];
        for &node in self.model.interfaces.iter().flat_map(|i| &i.nodes) {
            all[node] = true;
        }
        let count = all.iter().filter(|a| **a).count();
        if count < FEW || self.widened >= MOST_WIDENED || !self.model.method.condenses() {
            for interface in &mut self.model.interfaces {
                interface.wake(&mut kept);
            }
        } else {
            let step = &self.model.steps[self.step];
            let travel = self.travel() * f64::powi(2.0, self.widened as i32);
            let reach = Reach {
                approach: travel + self.extra(),
                along: travel,
                span: [step.start, step.end],
            };
            for interface in &mut self.model.interfaces {
                interface.limit(&self.state.u, reach, &mut kept);
            }
        }
        for point in self.loose.points() {
            kept[point] = true;
        }
        for point in self.model.couplings.points() {
            kept[point] = true;
        }
        for link in self.model.links.all() {
            kept[link.points.clone()].fill(false);
            kept[link.hidden..link.hidden + 2].fill(true);
        }
        self.kept = Some(kept);
    }

    /// Lets all points take part.
    pub(super) fn wake(&mut self) {
        let mut kept = vec![false; self.model.dofs.points];
        for interface in &mut self.model.interfaces {
            interface.wake(&mut kept);
        }
        self.kept = None;
        self.summary.method = "explicit".into();
    }

    /// Distance beyond that of prescribed motion in which contact is looked for: more each time that it was too little.
    fn extra(&self) -> f64 {
        match self.widened {
            0 => 0.0,
            n => 0.01 * f64::powi(4.0, n as i32 - 1) * self.model.mesh.diameter(),
        }
    }

    /// How far supports and initial velocities move anything in this step, at most.
    fn travel(&self) -> f64 {
        let step = &self.model.steps[self.step];
        let mut times: Vec<f64> = (0..=SAMPLES)
            .map(|k| step.start + (step.end - step.start) * k as f64 / SAMPLES as f64)
            .collect();
        times.extend(&step.milestones);
        let mut largest = vec![0.0_f64; self.state.u.len()];
        for t in times {
            let constraints = self.constraints(t);
            for (i, largest) in largest.iter_mut().enumerate() {
                if constraints.fixed[i] {
                    *largest = largest.max((constraints.values[i] - self.state.u[i]).abs());
                }
            }
        }
        for rigid in self.model.links.all() {
            // the points of rigid bodies have no values of their own
            largest[self.model.dofs.of(rigid.points.start, 0)
                ..self.model.dofs.of(rigid.points.end, 0)]
                .fill(0.0);
        }
        let dim = self.model.dofs.dim;
        let moved = largest
            .chunks(dim)
            .map(|p| p.iter().map(|v| v * v).sum::<f64>().sqrt())
            .fold(0.0, f64::max);
        let speed = self
            .state
            .v
            .chunks(dim)
            .map(|p| p.iter().map(|v| v * v).sum::<f64>().sqrt())
            .fold(0.0, f64::max);
        2.0 * moved + 2.0 * speed * (step.end - step.start)
    }

    /// Contact has come to points that do not take part: lets more of them.
    pub(super) fn widen(&mut self, observers: &mut [&mut dyn Observer]) -> Result<(), Error> {
        self.flush(observers)?;
        self.widened += 1;
        let before = self.kept.iter().flatten().filter(|k| **k).count();
        self.choose_candidates();
        let after = self.kept.iter().flatten().filter(|k| **k).count();
        self.notes.push(format!(
            "contact comes near to points that were not expected to be touched: {after} candidates instead of {before}, factored anew"
        ));
        self.condensed = None;
        self.moving.clear();
        if self.model.steps[self.step].dynamic.is_none() {
            self.condense()?;
        }
        self.tell_notes(observers)
    }

    /// Tries a quasi-static increment on the candidates.
    pub(super) fn attempt_condensed(&mut self, trial: Trial) -> Result<Accepted, StepFailure> {
        let dt = trial.to - trial.from;
        let external = self.external(trial.to);
        let constraints = self.constraints(trial.to);
        let model = &mut self.model;
        (model.couplings).fit(&self.diagonal, &constraints.fixed, &model.links);
        let condensed =
            (self.condensed.as_mut()).expect("bodies were condensed when the step was begun");
        let Condensed {
            condensation,
            gaps,
            shapes,
            state: from,
            carried,
            previous,
            found,
            ..
        } = condensed;
        let held = &condensation.held;
        let started = Instant::now();
        let free_external: Vec<f64> = external
            .iter()
            .zip(held)
            .map(|(e, &held)| if held { 0.0 } else { *e })
            .collect();
        let mut prescribed = vec![0.0; external.len()];
        constraints.impose(&mut prescribed);
        let amplitudes = shapes.resolve(condensation, &self.matrix, &free_external, &prescribed);
        let load = shapes.load(&amplitudes, condensation.size());
        self.newton.statistics.seconds_solve += started.elapsed().as_secs_f64();
        let scale = external.iter().map(|e| e * e).sum::<f64>().sqrt();
        let mut at = State {
            t: trial.to,
            u: from.u.clone(),
            ..State::default()
        };
        let mut guess = carried.clone();
        if let Some((before, u, s)) = previous {
            // the last increment goes on
            let ratio = dt / *before;
            for ((&dof, then), (g, s)) in
                condensation.dofs.iter().zip(u).zip(guess.iter_mut().zip(s))
            {
                at.u[dof] += ratio * (from.u[dof] - *then);
                *g += ratio * (*g - *s);
            }
        }
        let mut seen: Vec<Progress> = Vec::new();
        let base = vec![0.0; condensation.size()];
        let mut bulk = CondensedBulk::new(
            (condensation, gaps),
            &self.diagonal,
            load,
            base,
            guess,
            scale,
        );
        let mut system = System {
            dofs: self.model.dofs,
            bulk: &mut bulk,
            rate: None,
            constraints,
            links: &self.model.links,
            contact: (self.loose).with(inertia::contact(
                &mut self.model.interfaces,
                &mut self.model.couplings,
            )),
        };
        let converged = self
            .newton
            .solve(&mut system, from, &mut at, &mut |p| seen.push(*p));
        let now = bulk.carried();
        *found = Some((amplitudes, now));
        self.seen = seen;
        let converged = converged?;
        if let Some(condensed) = &self.condensed {
            let dofs = &condensed.condensation.dofs;
            let moved = dofs.iter().map(|&d| at.u[d] - condensed.state.u[d]);
            self.judge_change(moved.fold(0.0_f64, |m, d| m.max(d.abs())))?;
        }
        self.check_reach()?;
        Ok(Accepted {
            contact: converged.contact.clone(),
            external,
            state: at,
            ..Accepted::from_newton(&converged)
        })
    }

    /// Refuses a solution with contact near points that do not take part.
    pub(super) fn check_reach(&self) -> Result<(), StepFailure> {
        if self.model.interfaces.iter().any(|i| i.spreads()) {
            return Err(StepFailure::new(
                Cause::Reach,
                "contact comes near to points that were not expected to be touched",
            ));
        }
        Ok(())
    }

    /// Makes an accepted attempt the state from which the next starts.
    pub(super) fn move_ahead(&mut self, pending: &mut Pending) {
        let Some(mut condensed) = self.condensed.take() else {
            return;
        };
        self.commit(&condensed.state, pending.trial, &pending.accepted);
        pending.seen = std::mem::take(&mut self.seen);
        let interfaces = self.model.interfaces.iter();
        pending.histories = interfaces.map(|i| i.history.clone()).collect();
        pending.couplings = self.model.couplings.memory.clone();
        let Condensed {
            condensation,
            state,
            carried,
            previous,
            found,
            ..
        } = &mut condensed;
        if let Some((amplitudes, now)) = found.take() {
            let length = pending.trial.to - pending.trial.from;
            let before = condensation.gather(&state.u);
            *previous = Some((length, before, std::mem::replace(carried, now)));
            state.clone_from(&pending.accepted.state);
            pending.found = Some((amplitudes, condensation.gather(&state.u)));
        }
        self.condensed = Some(condensed);
    }

    /// Finds the interiors of increments, all in one sweep.
    pub(super) fn recover(&mut self, pending: &mut [Pending]) {
        let started = Instant::now();
        let Some(condensed) = &self.condensed else {
            return;
        };
        let (mut swept, mut at, mut all) = (Vec::new(), Vec::new(), Vec::new());
        for one in pending.iter_mut() {
            if let Some((amplitudes, u)) = &one.found {
                swept.push(
                    condensed
                        .shapes
                        .interior(amplitudes, &condensed.condensation),
                );
                at.push(u.clone());
                all.push(std::mem::take(&mut one.accepted.state.u));
            }
        }
        condensed.condensation.recover(swept, &at, &mut all);
        let with_interior = pending.iter_mut().filter(|p| p.found.is_some());
        for (one, u) in with_interior.zip(all) {
            one.accepted.state.u = u;
        }
        self.newton.statistics.seconds_recover += started.elapsed().as_secs_f64();
    }

    /// Completes a recovered increment by its forces, and checks that they balance.
    pub(super) fn complete(&mut self, pending: &mut Pending) -> Result<(), Error> {
        if pending.found.is_none() {
            return Ok(());
        }
        let started = Instant::now();
        let accepted = &mut pending.accepted;
        let u = &accepted.state.u;
        let internal = inertia::times(&self.matrix, u);
        let fixed = self.constraints(pending.trial.to).fixed;
        let (mut left, mut rounding, mut size) = (0.0, 0.0, 0.0_f64);
        let mut reactions = 0.0;
        let mut forces = vec![0.0; u.len()];
        for i in 0..u.len() {
            forces[i] = internal[i] + accepted.contact[i] - accepted.external[i];
            size += accepted.external[i].powi(2);
            if fixed[i] {
                reactions += internal[i] * internal[i];
            } else {
                left += forces[i] * forces[i];
                rounding += (self.diagonal[i] * u[i]).powi(2);
            }
        }
        let contact: f64 = accepted.contact.iter().map(|c| c * c).sum();
        let size = size.max(reactions).max(contact).sqrt();
        self.largest_forces = self.largest_forces.max(size);
        let limit = ((10.0 * self.model.settings.tolerance).max(LEFT) * size)
            .max(1e4 * f64::EPSILON * rounding.sqrt())
            // Where a path passes through the unloaded state, there is nothing but rounding in play.
            .max(NOTHING * self.largest_forces);
        if left.sqrt() > limit || left.is_nan() {
            return Err(StepFailure::new(
                Cause::LinearSolver,
                format!(
                    "the recovered interior is not in balance: {:.1e} of the forces in play",
                    left.sqrt() / size
                ),
            )
            .help("set `solver.method = \"sparse\"`")
            .at(pending.trial.to)
            .into());
        }
        let t = pending.trial.to;
        for interface in &mut self.model.interfaces {
            let overlooked = interface.overlooked(&pending.accepted.state.u, t);
            if overlooked > 0 {
                return Err(StepFailure::new(
                    Cause::Reach,
                    format!(
                        "interface {}: {overlooked} points penetrate that were not expected to be touched",
                        interface.name
                    ),
                )
                .help("set `solver.method = \"sparse\"`, or take smaller increments")
                .at(t)
                .into());
            }
        }
        let accepted = &mut pending.accepted;
        let u = &accepted.state.u;
        accepted.strain = Some(0.5 * dot(u, &internal));
        accepted.forces = forces;
        let work = self.work(
            &fixed,
            (&pending.accepted.state.u, &pending.accepted.forces),
            &pending.accepted.external,
        );
        pending.accepted.flow = Flow {
            work,
            ..Flow::default()
        };
        self.newton.statistics.seconds_recover += started.elapsed().as_secs_f64();
        Ok(())
    }
}

//! Quasi-static increments on the contact candidates.

use std::sync::Arc;
use std::time::Instant;

use super::accepted::{Accepted, Flow};
use super::inertia;
use super::model::Solution;
use super::pending::Pending;
use super::run::{Observer, Simulation};
use crate::contact::interface::Reach;
use crate::error::Error;
use crate::linear::BlockCsr;
use crate::math::Vec3;
use crate::newton::condensed::{Amplitudes, Condensation, Gaps, Plan, Reduced, Shapes};
use crate::newton::{Progress, System};
use crate::system::{Cause, State, StepFailure};
use crate::time::Trial;

/// Points of interfaces below which all of them are candidates.
const FEW: usize = 60;

/// How often candidates are added before all points are.
const MOST_WIDENED: usize = 4;

/// Times within a step at which supports are looked at.
const SAMPLES: usize = 16;

/// What was analysed for condensing: for these dofs that are no unknowns and these candidates.
pub(super) struct Planned {
    held: Vec<bool>,
    kept: Vec<bool>,
    plan: Plan,
}

/// The bodies without their interiors, and where the analysis stands.
pub(super) struct Condensed {
    condensation: Condensation,
    gaps: Gaps,
    shapes: Shapes,
    /// The last accepted state: displacements are known at candidates and where prescribed.
    state: State,
    /// Forces with which the candidates yield to where they are.
    carried: Vec<f64>,
    /// The increment before: its length, displacements of the candidates and forces.
    previous: Option<(f64, Vec<f64>, Vec<f64>)>,
    /// What the last attempt found.
    found: Option<(Amplitudes, Vec<f64>)>,
}

/// Out-of-balance force relative to the forces in play that rounding may leave in the interior.
pub(super) const LEFT: f64 = 1e-7;

impl Condensed {
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
            && self
                .plan
                .as_ref()
                .is_some_and(|p| p.held == held && p.kept == kept)
        {
            condensed.forget_direction();
            return Ok(());
        }
        let matrix = std::mem::replace(&mut self.matrix, BlockCsr::empty(self.model.dofs.dim));
        let made = self.condensation(&held, &kept, (&matrix, 0));
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
            gaps: Gaps::default(),
            shapes: Shapes::default(),
            state: self.state.clone(),
            carried,
            previous: None,
            found: None,
        });
        Ok(())
    }

    /// Factors the bodies with one of their matrices, told apart by a key; `None` where the analysis goes on with the sparse matrix.
    pub(super) fn condensation(
        &mut self,
        held: &[bool],
        kept: &[bool],
        (matrix, key): (&BlockCsr, u64),
    ) -> Option<Condensation> {
        let started = Instant::now();
        let planned = match self.plan.take() {
            Some(planned) if planned.held == held && planned.kept == kept => planned,
            _ => {
                let parts = self.parts();
                match Plan::new(matrix, &parts, held, kept, key) {
                    Ok(plan) => {
                        self.newton.statistics.analyses += 1;
                        Planned {
                            held: held.to_vec(),
                            kept: kept.to_vec(),
                            plan,
                        }
                    }
                    Err(e) => return self.not_condensed(&e.to_string()),
                }
            }
        };
        self.newton.statistics.seconds_order += started.elapsed().as_secs_f64();
        let plan = planned.plan.for_matrix(key);
        self.newton.statistics.factor_nonzeros = plan.cost().nonzeros as usize;
        self.plan = Some(planned);
        let typical = self.diagonal.iter().fold(0.0_f64, |m, d| m.max(*d));
        let points = &self.model.mesh.points;
        let point = |p: usize| -> Option<Vec3> { points.get(p).copied() };
        let made = Condensation::new(
            &plan,
            matrix,
            held,
            &self.substructures,
            &point,
            if typical > 0.0 { typical } else { 1.0 },
        );
        let (condensation, count) = match made {
            Ok(made) => made,
            Err(e) => return self.not_condensed(&e.to_string()),
        };
        let statistics = &mut self.newton.statistics;
        statistics.factorisations += count;
        for part in &condensation.parts {
            if !self.substructures.iter().any(|s| Arc::ptr_eq(s, part)) {
                statistics.seconds_factor += part.seconds.factor;
                statistics.seconds_condense += part.seconds.condense;
                self.substructures.push(Arc::clone(part));
            }
        }
        Some(condensation)
    }

    /// The analysis goes on with the sparse matrix.
    fn not_condensed(&mut self, why: &str) -> Option<Condensation> {
        self.condensed = None;
        self.notes.push(format!("bodies are not condensed: {why}"));
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
        for link in self.model.links.all() {
            kept[link.points.clone()].fill(false);
            kept[link.hidden..link.hidden + 2].fill(true);
        }
        self.kept = Some(kept);
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
    pub(super) fn attempt_condensed(
        &mut self,
        trial: Trial,
        observers: &mut [&mut dyn Observer],
    ) -> Result<Accepted, StepFailure> {
        let dt = trial.to - trial.from;
        let external = self.external(trial.to);
        let constraints = self.constraints(trial.to);
        let Some(condensed) = &mut self.condensed else {
            return Err(StepFailure::new(Cause::NotFinite, "nothing is condensed"));
        };
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
        let mut bulk = Reduced::new(
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
            contact: inertia::contact(&mut self.model.interfaces),
        };
        let converged = self
            .newton
            .solve(&mut system, from, &mut at, &mut |p| seen.push(*p));
        let now = bulk.carried();
        *found = Some((amplitudes, now));
        self.tell(&seen, observers);
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
        pending.memories = self
            .model
            .interfaces
            .iter()
            .map(|i| i.memory.clone())
            .collect();
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
        let limit = ((10.0 * self.model.settings.tolerance).max(LEFT) * size)
            .max(1e4 * f64::EPSILON * rounding.sqrt());
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
        accepted.strain = Some(0.5 * inertia::dot(u, &internal));
        accepted.forces = forces;
        let work = self.work(
            pending.trial,
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

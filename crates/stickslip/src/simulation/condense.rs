//! Quasi-static increments on the contact candidates.

use std::time::Instant;

use super::accepted::{Accepted, Flow};
use super::inertia;
use super::model::Solution;
use super::pending::Pending;
use super::run::{Observer, Simulation};
use crate::error::Error;
use crate::linear::BlockCsr;
use crate::math::Vec3;
use crate::newton::condensed::{Amplitudes, Condensation, Gaps, Places, Plan, Reduced, Shapes};
use crate::newton::{Progress, System};
use crate::system::{Cause, State, StepFailure};
use crate::time::Trial;

/// The bodies without their interiors, and where the analysis stands.
pub(super) struct Condensed {
    condensation: Condensation,
    /// The candidates it was made for.
    kept: Vec<bool>,
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
        if self.model.method == Solution::Sparse {
            return Ok(());
        }
        let step = &self.model.steps[self.step];
        let held = self.constraints(0.5 * (step.start + step.end)).fixed;
        let kept = self.candidates();
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
            gaps: Gaps::default(),
            shapes: Shapes::default(),
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
        let nonzeros = plan.cost().nonzeros as usize;
        let made = Condensation::new(plan, matrix, held, springs, library);
        let (condensation, effort) = match made {
            Ok(made) => made,
            Err(e) => return self.not_condensed(&e.to_string()),
        };
        let statistics = &mut self.newton.statistics;
        statistics.factor_nonzeros = nonzeros;
        statistics.analyses += effort.analysed;
        statistics.factorisations += effort.made;
        statistics.substructures_made += effort.made;
        statistics.substructures_shared += effort.shared;
        statistics.substructures_read += effort.read;
        statistics.seconds_find += effort.seconds_find;
        statistics.seconds_order += effort.seconds_order;
        statistics.seconds_factor += effort.seconds.factor;
        statistics.seconds_condense += effort.seconds.condense;
        self.summary.notes.extend(effort.notes);
        Some(condensation)
    }

    /// The analysis goes on with the sparse matrix.
    fn not_condensed(&mut self, why: &str) -> Option<Condensation> {
        self.condensed = None;
        self.summary.method_reason = why.to_string();
        self.model.method = Solution::Sparse;
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

    /// Points that may come into contact.
    pub(super) fn candidates(&self) -> Vec<bool> {
        let mut kept = vec![false; self.model.dofs.points];
        for interface in &self.model.interfaces {
            for &node in &interface.nodes {
                kept[node] = true;
            }
        }
        for link in self.model.links.all() {
            kept[link.points.clone()].fill(false);
            kept[link.hidden..link.hidden + 2].fill(true);
        }
        kept
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
        self.check_change(&at.u)?;
        Ok(Accepted {
            contact: converged.contact.clone(),
            external,
            state: at,
            ..Accepted::from_newton(&converged)
        })
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

//! Static condensation: increments on the contact candidates.

use std::sync::Arc;
use std::time::Instant;

use super::accepted::Accepted;
use super::choice::cost_fits;
use super::contact::Contact;
use super::frame::Frame;
use super::inertia;
use super::ledger::Flow;
use super::model::{Model, Solution};
use super::scene::Scene;
use super::solver::{
    Iteration, Load, Recovered, Solver, Task, check_candidates, check_change, in_motion,
};
use crate::contact::interface::CandidateRange;
use crate::linear::BlockCsr;
use crate::math::Vec3;
use crate::math::vector::dot;
use crate::newton::condensed::{
    Amplitudes, Condensation, CondensedBulk, Cost, Effort, Library, LoadPatterns, Places, Plan,
    ReducedSystem,
};
use crate::newton::{Converged, Factors};
use crate::system::{Cause, Constraints, State, StepFailure};
use crate::time::Trial;

/// Points of interfaces below which all of them are candidates.
const FEW: usize = 60;

/// How often candidates are added before all points are.
const MOST_WIDENED: usize = 4;

/// Times within a step at which supports are looked at.
const SAMPLES: usize = 16;

/// Most step lengths whose condensed bodies are kept.
const MOST_CONDENSED: usize = 4;

/// What is known of bodies without their interiors.
pub(super) struct Condenser {
    /// Factors of this run and of others.
    library: Arc<Library>,
    /// Points that may come into contact, and how often they were too few.
    kept: Option<Vec<bool>>,
    widened: usize,
    /// The dofs that are no unknowns for which condensing was found the cheapest.
    decided: Option<Vec<bool>>,
    /// Those of a quasi-static step.
    at_rest: Option<Condensed>,
    /// Those of increments in motion, the last used last.
    moving: Vec<Moving>,
    /// Largest norm of the forces in play at any recovered increment `[N]`.
    largest_forces: f64,
}

/// The bodies with the matrix of an increment in motion, without their interiors.
struct Moving {
    /// Key of the matrix.
    key: u64,
    condensation: Condensation,
    reduced: ReducedSystem,
}

/// The bodies without their interiors, and where a quasi-static analysis stands.
pub(super) struct Condensed {
    condensation: Condensation,
    /// The candidates it was made for.
    kept: Vec<bool>,
    reduced: ReducedSystem,
    patterns: LoadPatterns,
    /// The last accepted state: displacements are known at candidates and where prescribed.
    pub state: State,
    /// Forces under which the candidates are where they are.
    carried: Vec<f64>,
    /// The increment before: its length, displacements of the candidates and forces.
    previous: Option<(f64, Vec<f64>, Vec<f64>)>,
    /// What the last attempt found.
    found: Option<(Amplitudes, Vec<f64>)>,
}

/// An increment whose interior is not known yet: its loads and the displacements of the candidates.
pub(super) struct Candidates {
    amplitudes: Amplitudes,
    displacements: Vec<f64>,
}

/// Which matrix bodies are condensed with.
#[derive(Clone, Copy, PartialEq)]
enum Which {
    Stiffness,
    Increment,
}

impl Condensed {
    /// The bodies without their interiors.
    pub fn condensation(&self) -> &Condensation {
        &self.condensation
    }
}

impl Condenser {
    /// With the factors of other runs.
    pub fn new(library: Arc<Library>) -> Self {
        Condenser {
            library,
            kept: None,
            widened: 0,
            decided: None,
            at_rest: None,
            moving: Vec::new(),
            largest_forces: 0.0,
        }
    }

    /// The bodies of a quasi-static step; `None` where the sparse matrix serves it.
    pub fn at_rest(&self) -> Option<&Condensed> {
        self.at_rest.as_ref()
    }

    /// Nothing is condensed in quasi-static steps until it is made anew.
    pub fn drop_at_rest(&mut self) {
        self.at_rest = None;
    }

    /// What the last increment did is no guide for the next.
    pub fn forget_direction(&mut self) {
        if let Some(condensed) = &mut self.at_rest {
            condensed.previous = None;
        }
    }
}

impl Solver {
    /// Makes the bodies ready for a quasi-static step.
    pub fn condense(&mut self, model: &Model, frame: &Frame, contact: &mut Contact) {
        if !self.method.condenses() {
            return;
        }
        let step = &model.steps[frame.step];
        let held = frame
            .constraints(model, 0.5 * (step.start + step.end))
            .fixed;
        let kept = self.condenser.kept.clone().unwrap_or_default();
        if let Some(condensed) = &mut self.condenser.at_rest
            && condensed.condensation.held == held
            && condensed.kept == kept
        {
            condensed.previous = None;
            return;
        }
        let made = self.condensation(model, frame, contact, &held, Which::Stiffness);
        let Some(condensation) = made else {
            self.condenser.at_rest = None;
            return;
        };
        // Forces that go with the displacements the step starts from.
        let mut at = vec![0.0; held.len()];
        let u = condensation.gather(&frame.state.u);
        condensation.scatter(&u, &mut at);
        let mut carried = vec![0.0; u.len()];
        if u.iter().any(|u| *u != 0.0) {
            carried = condensation.sweep(&inertia::times(&self.stiffness, &at)).0;
            let mut springs = vec![0.0; u.len()];
            condensation.release(&u, &mut springs);
            carried.iter_mut().zip(&springs).for_each(|(c, s)| *c -= s);
        }
        self.condenser.at_rest = Some(Condensed {
            condensation,
            kept,
            reduced: ReducedSystem::default(),
            patterns: LoadPatterns::default(),
            state: frame.state.clone(),
            carried,
            previous: None,
            found: None,
        });
    }

    /// Factors the bodies with one of their matrices, as far as the library does not have them; `None` where the analysis goes on with the sparse matrix.
    fn condensation(
        &mut self,
        model: &Model,
        frame: &Frame,
        contact: &mut Contact,
        held: &[bool],
        which: Which,
    ) -> Option<Condensation> {
        let typical = self.diagonal.iter().fold(0.0_f64, |m, d| m.max(*d));
        let typical = if typical > 0.0 { typical } else { 1.0 };
        let points = &model.mesh.points;
        let places = |p: usize| -> Option<Vec3> { points.get(p).copied() };
        let springs: (Places, f64) = (&places, typical);
        let library = Arc::clone(&self.condenser.library);
        let kept = self.condenser.kept.clone().unwrap_or_default();
        let parts = parts(model);
        let plan = Plan::new(self.matrix(which), &parts, (held, &kept), springs, &library);
        let plan = match plan {
            Ok(plan) => plan,
            Err(e) => return self.not_condensed(model, frame, contact, &e.to_string()),
        };
        if self.condenser.decided.as_deref() != Some(held) {
            let scene = Scene {
                model,
                contact,
                frame,
            };
            if !self.decide(scene, &plan, held, which) {
                self.choose_candidates(model, frame, contact);
                return None;
            }
        }
        let cost = plan.cost();
        if !cost_fits(cost.bytes) {
            let why = "it would take more memory than is free";
            return self.not_condensed(model, frame, contact, why);
        }
        let started = Instant::now();
        let matrix = self.matrix(which);
        match Condensation::new(plan, matrix, held, springs, &library) {
            Ok((condensation, effort)) => {
                let passed = started.elapsed().as_secs_f64();
                self.count(&cost, effort, passed);
                self.log.method = "condensed";
                Some(condensation)
            }
            Err(e) => self.not_condensed(model, frame, contact, &e.to_string()),
        }
    }

    fn matrix(&self, which: Which) -> &BlockCsr {
        match which {
            Which::Stiffness => &self.stiffness,
            Which::Increment => in_motion(&self.inertia).matrix().0,
        }
    }

    /// Chooses the cheapest way to solve, and says why; whether it is to condense.
    fn decide(&mut self, scene: Scene, plan: &Plan, held: &[bool], which: Which) -> bool {
        let cost = plan.cost();
        let choice = scene.choose(&cost, (self.matrix(which), held));
        let forced = self.method == Solution::Condensed;
        let fits = cost_fits(cost.bytes);
        let method = if forced && fits {
            Solution::Condensed
        } else {
            choice.method
        };
        if forced && !fits {
            self.log.notes.push(format!(
                "`solver.method = \"condensed\"` needs about {:.1} GB, more than is free",
                cost.bytes as f64 / 1e9
            ));
        }
        let name = match method {
            Solution::Condensed => "condensed",
            Solution::Multigrid => "multigrid",
            _ => "sparse matrix",
        };
        self.log.notes.push(format!("{name}: {}", choice.reason));
        self.log.reason = choice.reason;
        if method == Solution::Condensed {
            self.condenser.decided = Some(held.to_vec());
            return true;
        }
        self.method = method;
        if method == Solution::Multigrid {
            self.factors = Factors::multigrid(scene.model.places());
        }
        false
    }

    /// Counts what condensing took, `passed` seconds in all.
    fn count(&mut self, cost: &Cost, effort: Effort, passed: f64) {
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
        let passed = (passed - effort.seconds_find).max(0.0);
        let spent = effort.seconds.factor + effort.seconds.condense;
        let share = if spent > 0.0 { passed / spent } else { 0.0 };
        let factor = share * effort.seconds.factor;
        let condense = share * effort.seconds.condense;
        statistics.seconds_factor += factor;
        statistics.seconds_condense += condense;
        if statistics.linear_solve == 0.0 && effort.made > 0 {
            // To factor the root costs a third of its inverse.
            statistics.linear_solve = effort.seconds_order + factor + condense / 3.0;
        }
        self.log.notes.extend(effort.notes);
    }

    /// The analysis goes on with the sparse matrix.
    fn not_condensed(
        &mut self,
        model: &Model,
        frame: &Frame,
        contact: &mut Contact,
        why: &str,
    ) -> Option<Condensation> {
        self.condenser.at_rest = None;
        self.log.notes.push(format!("not condensed: {why}"));
        self.method = Solution::Sparse;
        self.choose_candidates(model, frame, contact);
        None
    }

    /// Points that may come into contact in this step, as far as can be told; never fewer than before. Those that may not are
    /// not looked at.
    pub fn choose_candidates(&mut self, model: &Model, frame: &Frame, contact: &mut Contact) {
        match self.method {
            Solution::Multigrid => self.log.method = "multigrid",
            Solution::Sparse => self.log.method = "sparse",
            Solution::Automatic | Solution::Condensed => {}
        }
        let points = model.dofs.points;
        let known = self.condenser.kept.take();
        let mut kept = known.unwrap_or_else(|| vec![false; points]);
        let mut all = vec![false; points];
        for &node in contact.interfaces.iter().flat_map(|i| &i.nodes) {
            all[node] = true;
        }
        let count = all.iter().filter(|a| **a).count();
        let widened = self.condenser.widened;
        if count < FEW || widened >= MOST_WIDENED || !self.method.condenses() {
            for interface in &mut contact.interfaces {
                interface.include_all(&mut kept);
            }
        } else {
            let step = &model.steps[frame.step];
            let travel = travel(model, frame) * f64::powi(2.0, widened as i32);
            let range = CandidateRange {
                distance: travel + extra(widened, model),
                along: travel,
                span: [step.start, step.end],
            };
            for interface in &mut contact.interfaces {
                interface.restrict_to_candidates(&frame.state.u, range, &mut kept);
            }
        }
        for point in self.floating.points() {
            kept[point] = true;
        }
        for point in contact.couplings.points() {
            kept[point] = true;
        }
        for link in model.links.all() {
            kept[link.points.clone()].fill(false);
            kept[link.hidden..link.hidden + 2].fill(true);
        }
        self.condenser.kept = Some(kept);
    }

    /// Lets all points take part.
    pub fn include_all(&mut self, model: &Model, contact: &mut Contact) {
        let mut kept = vec![false; model.dofs.points];
        for interface in &mut contact.interfaces {
            interface.include_all(&mut kept);
        }
        self.condenser.kept = None;
        self.log.method = "explicit";
    }

    /// Contact has come to points that do not take part: lets more of them.
    pub fn widen(&mut self, model: &Model, frame: &Frame, contact: &mut Contact) {
        self.condenser.widened += 1;
        let count = |c: &Condenser| c.kept.iter().flatten().filter(|k| **k).count();
        let before = count(&self.condenser);
        self.choose_candidates(model, frame, contact);
        let after = count(&self.condenser);
        self.log.notes.push(format!(
            "contact comes near to points that were not expected to be touched: {after} candidates instead of {before}, factored anew"
        ));
        self.condenser.at_rest = None;
        self.condenser.moving.clear();
        if model.steps[frame.step].dynamic.is_none() {
            self.condense(model, frame, contact);
        }
    }

    /// Tries a quasi-static increment on the candidates of bodies that were condensed.
    pub fn attempt_condensed(
        &mut self,
        model: &Model,
        contact: &mut Contact,
        (external, constraints): (Vec<f64>, Constraints),
        trial: Trial,
    ) -> Result<Accepted, StepFailure> {
        let Solver {
            newton,
            seen,
            stiffness,
            diagonal,
            condenser,
            floating,
            ..
        } = self;
        let condensed =
            (condenser.at_rest.as_mut()).expect("bodies were condensed when the step was begun");
        let started = Instant::now();
        let amplitudes = condensed.amplitudes(stiffness, &external, &constraints);
        let Condensed {
            condensation,
            reduced,
            patterns,
            state: from,
            carried,
            previous,
            found,
            ..
        } = condensed;
        let load = patterns.load(&amplitudes, condensation.size());
        newton.statistics.seconds_solve += started.elapsed().as_secs_f64();
        let scale = external.iter().map(|e| e * e).sum::<f64>().sqrt();
        let mut at = State {
            t: trial.to,
            u: from.u.clone(),
            ..State::default()
        };
        let mut guess = carried.clone();
        if let Some((before, u, s)) = previous {
            // the last increment goes on
            let ratio = (trial.to - trial.from) / *before;
            for ((&dof, then), (g, s)) in
                condensation.dofs.iter().zip(u).zip(guess.iter_mut().zip(s))
            {
                at.u[dof] += ratio * (from.u[dof] - *then);
                *g += ratio * (*g - *s);
            }
        }
        let base = vec![0.0; condensation.size()];
        let mut bulk =
            CondensedBulk::new((condensation, reduced), diagonal, load, base, guess, scale);
        let converged = Iteration {
            newton,
            seen,
            model,
            forces: floating.with(contact.forces()),
            bulk: &mut bulk,
        }
        .solve(constraints, None, (from, &mut at));
        *found = Some((amplitudes, bulk.carried()));
        let converged = converged?;
        let dofs = condensation.dofs.iter();
        check_change(model, dofs.map(|&d| (at.u[d], from.u[d])))?;
        check_candidates(contact)?;
        Ok(Accepted {
            contact: converged.contact.clone(),
            external,
            state: at,
            ..Accepted::from_newton(&converged)
        })
    }

    /// Makes an accepted attempt the state from which the next starts; what its interior follows from. `None` where it is known.
    pub fn move_ahead(&mut self, accepted: &Accepted, trial: Trial) -> Option<Candidates> {
        let condensed = self.condenser.at_rest.as_mut()?;
        let (amplitudes, now) = condensed.found.take()?;
        let Condensed {
            condensation,
            state,
            carried,
            previous,
            ..
        } = condensed;
        let before = condensation.gather(&state.u);
        let length = trial.to - trial.from;
        *previous = Some((length, before, std::mem::replace(carried, now)));
        state.clone_from(&accepted.state);
        Some(Candidates {
            amplitudes,
            displacements: condensation.gather(&state.u),
        })
    }

    /// Finds the interiors of increments, all in one sweep.
    pub fn recover<'a>(
        &mut self,
        pending: impl Iterator<Item = (&'a Candidates, &'a mut Accepted)>,
    ) {
        let started = Instant::now();
        let Some(condensed) = &self.condenser.at_rest else {
            return;
        };
        let (mut swept, mut at, mut all) = (Vec::new(), Vec::new(), Vec::new());
        let mut owners = Vec::new();
        for (found, accepted) in pending {
            let Condensed {
                patterns,
                condensation,
                ..
            } = condensed;
            swept.push(patterns.interior(&found.amplitudes, condensation));
            at.push(found.displacements.clone());
            all.push(std::mem::take(&mut accepted.state.u));
            owners.push(accepted);
        }
        condensed.condensation.recover(swept, &at, &mut all);
        for (accepted, u) in owners.into_iter().zip(all) {
            accepted.state.u = u;
        }
        self.newton.statistics.seconds_recover += started.elapsed().as_secs_f64();
    }

    /// Completes a recovered increment by its forces, and checks that they balance.
    pub fn complete(
        &mut self,
        model: &Model,
        frame: &Frame,
        contact: &mut Contact,
        accepted: &mut Accepted,
    ) -> Result<(), StepFailure> {
        let started = Instant::now();
        let t = accepted.state.t;
        let u = &accepted.state.u;
        let internal = inertia::times(&self.stiffness, u);
        let fixed = frame.constraints(model, t).fixed;
        let both = accepted.contact.iter().zip(&accepted.external);
        let forces = internal.iter().zip(both);
        let forces: Vec<f64> = forces
            .map(|(i, (contact, load))| i + contact - load)
            .collect();
        let squares = |x: &[f64]| x.iter().map(|x| x * x).sum::<f64>();
        let recovered = Recovered {
            forces: &forces,
            u,
            diagonal: &self.diagonal,
            fixed: &fixed,
            contact: squares(&accepted.contact),
            others: squares(&accepted.external),
        };
        let largest = &mut self.condenser.largest_forces;
        recovered.check(model.settings.tolerance, largest)?;
        for interface in &mut contact.interfaces {
            let overlooked = interface.overlooked(u, t);
            if overlooked > 0 {
                return Err(StepFailure::new(
                    Cause::Reach,
                    format!(
                        "interface {}: {overlooked} points penetrate that were not expected to be touched",
                        interface.name
                    ),
                )
                .help("set `solver.method = \"sparse\"`, or take smaller increments"));
            }
        }
        accepted.strain = 0.5 * dot(u, &internal);
        accepted.flow = Flow {
            work: frame.work(&fixed, (u, &forces), &accepted.external),
            ..Flow::default()
        };
        accepted.forces = forces;
        self.newton.statistics.seconds_recover += started.elapsed().as_secs_f64();
        Ok(())
    }

    /// Makes the bodies with the matrix of increments that was made ready last known without their interiors; `false` where the increment is solved with
    /// the sparse matrix.
    pub fn condense_in_motion(
        &mut self,
        model: &Model,
        frame: &Frame,
        contact: &mut Contact,
        held: &[bool],
    ) -> bool {
        let (_, _, key) = in_motion(&self.inertia).matrix();
        let mut known = self.condenser.moving.iter();
        let last = match known.position(|m| m.key == key && m.condensation.held == held) {
            Some(i) => self.condenser.moving.remove(i),
            None => {
                if !self.method.condenses() {
                    return false;
                }
                let made = self.condensation(model, frame, contact, held, Which::Increment);
                let Some(condensation) = made else {
                    return false;
                };
                Moving {
                    key,
                    condensation,
                    reduced: ReducedSystem::default(),
                }
            }
        };
        let moving = &mut self.condenser.moving;
        if moving.len() == MOST_CONDENSED {
            moving.remove(0);
        }
        moving.push(last);
        true
    }

    /// Solves an increment in motion on the contact candidates of the bodies condensed last, and finds the interior. The forces that come out are those of the
    /// candidates.
    pub fn solve_condensed(
        &mut self,
        model: &Model,
        contact: &mut Contact,
        task: Task,
        at: &mut State,
    ) -> Result<Converged, StepFailure> {
        let Load::Known(origin) = &task.load else {
            unreachable!("the forces of an increment in motion are known at the guess");
        };
        let (_, diagonal, _) = in_motion(&self.inertia).matrix();
        let Moving {
            condensation,
            reduced,
            ..
        } = (self.condenser.moving.last_mut()).expect("the matrix of this length was condensed");
        let newton = &mut self.newton;
        let started = Instant::now();
        let opposite: Vec<f64> = origin.forces.iter().map(|f| -f).collect();
        let (load, interior) = condensation.sweep(&opposite);
        newton.statistics.seconds_solve += started.elapsed().as_secs_f64();
        let base = condensation.gather(&origin.at);
        let still = vec![0.0; base.len()];
        let mut bulk = CondensedBulk::new(
            (condensation, reduced),
            diagonal,
            load,
            base.clone(),
            still,
            origin.scale,
        );
        let fixed = task.constraints.fixed.clone();
        let converged = Iteration {
            newton,
            seen: &mut self.seen,
            model,
            forces: contact.forces(),
            bulk: &mut bulk,
        }
        .solve(task.constraints, task.rate, (task.from, at))?;
        let started = Instant::now();
        let mut moved = condensation.gather(&at.u);
        moved.iter_mut().zip(&base).for_each(|(m, b)| *m -= b);
        let mut all = vec![vec![0.0; origin.at.len()]];
        condensation.recover(vec![interior], &[moved], &mut all);
        let moved = all.swap_remove(0);
        for i in 0..moved.len() {
            if !fixed[i] {
                at.u[i] = origin.at[i] + moved[i];
            }
        }
        self.newton.statistics.seconds_recover += started.elapsed().as_secs_f64();
        Ok(converged)
    }

    /// Checks the interior of an increment in motion, in which forces of the size `scale` balance beside those of interfaces.
    pub fn check_in_motion(
        &mut self,
        model: &Model,
        (converged, scale): (&Converged, f64),
        u: &[f64],
        fixed: &[bool],
    ) -> Result<(), StepFailure> {
        let recovered = Recovered {
            forces: &converged.forces,
            u,
            diagonal: in_motion(&self.inertia).matrix().1,
            fixed,
            contact: dot(&converged.contact, &converged.contact),
            others: scale * scale,
        };
        let largest = &mut self.condenser.largest_forces;
        recovered.check(model.settings.tolerance, largest)
    }
}

impl Condensed {
    /// How much of each load pattern there is in an increment.
    fn amplitudes(
        &mut self,
        stiffness: &BlockCsr,
        external: &[f64],
        constraints: &Constraints,
    ) -> Amplitudes {
        let held = &self.condensation.held;
        let free: Vec<f64> = external
            .iter()
            .zip(held)
            .map(|(e, &held)| if held { 0.0 } else { *e })
            .collect();
        let mut prescribed = vec![0.0; external.len()];
        constraints.impose(&mut prescribed);
        (self.patterns).resolve(&self.condensation, stiffness, &free, &prescribed)
    }
}

/// Points of the parts of the model that are not coupled but by contact.
fn parts(model: &Model) -> Vec<std::ops::Range<usize>> {
    let bodies = model.elastic().map(|b| b.points.clone());
    let links = model.links.all().iter();
    bodies
        .chain(links.map(|l| l.hidden..l.hidden + 2))
        .collect()
}

/// Distance beyond that of prescribed motion in which contact is looked for: more each time that it was too little.
fn extra(widened: usize, model: &Model) -> f64 {
    match widened {
        0 => 0.0,
        n => 0.01 * f64::powi(4.0, n as i32 - 1) * model.mesh.diameter(),
    }
}

/// How far supports and initial velocities move anything in the step, at most.
fn travel(model: &Model, frame: &Frame) -> f64 {
    let step = &model.steps[frame.step];
    let mut times: Vec<f64> = (0..=SAMPLES)
        .map(|k| step.start + (step.end - step.start) * k as f64 / SAMPLES as f64)
        .collect();
    times.extend(&step.milestones);
    let u = &frame.state.u;
    let mut largest = vec![0.0_f64; u.len()];
    for t in times {
        let constraints = frame.constraints(model, t);
        for (i, largest) in largest.iter_mut().enumerate() {
            if constraints.fixed[i] {
                *largest = largest.max((constraints.values[i] - u[i]).abs());
            }
        }
    }
    for rigid in model.links.all() {
        // the points of rigid bodies have no values of their own
        let own = model.dofs.of(rigid.points.start, 0)..model.dofs.of(rigid.points.end, 0);
        largest[own].fill(0.0);
    }
    let dim = model.dofs.dim;
    let most = |values: &[f64]| {
        let sizes = values
            .chunks(dim)
            .map(|p| p.iter().map(|v| v * v).sum::<f64>().sqrt());
        sizes.fold(0.0, f64::max)
    };
    let (moved, speed) = (most(&largest), most(&frame.state.v));
    2.0 * moved + 2.0 * speed * (step.end - step.start)
}

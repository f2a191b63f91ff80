//! Implicit increments in motion: balance of inertia, damping, elasticity, loads and interfaces at the stage of the scheme.

use super::accepted::{Accepted, Flow};
use super::condense::LEFT;
use super::inertia::{self, Inertia, times};
use super::model::{ContactAt, Dynamic};
use super::run::{Observer, Simulation};

use crate::linear::BlockCsr;
use crate::math::vector::dot;
use crate::newton::condensed::{CondensedBulk, ReducedSystem};
use crate::newton::{Converged, Origin, Progress, SparseBulk, System};
use crate::system::{Cause, Constraints, Rate, State, StepFailure};
use crate::time::Trial;
use crate::time::newmark::{Increment, error_factor};
use crate::time::scheme::Alphas;

/// What motion needs beside the state.
pub(super) struct Motion {
    pub inertia: Inertia,
    /// `K u` at the last accepted state.
    pub internal: Vec<f64>,
    /// Displacements at the start of the step, and the farthest the bodies have been from there (in the norm of the mass).
    pub start: Vec<f64>,
    pub reach: f64,
}

/// Most step lengths whose condensed bodies are kept.
const MOST_CONDENSED: usize = 4;

/// One implicit increment that has converged.
struct Solved {
    state: State,
    /// Out-of-balance force at the stage: reactions at fixed dofs.
    reactions: Vec<f64>,
    contact: Vec<f64>,
    external: Vec<f64>,
    /// `K u`.
    internal: Vec<f64>,
}

impl Simulation {
    /// Tries one implicit increment.
    pub(super) fn attempt_implicit(
        &mut self,
        trial: Trial,
        dynamic: &Dynamic,
        alphas: Alphas,
        observers: &mut [&mut dyn Observer],
    ) -> Result<Accepted, StepFailure> {
        let constraints = self.constraints(trial.to);
        let external = self.external(trial.to);
        let mut motion = (self.motion.take()).expect("a dynamic step has begun its motion");
        let outcome = self.integrate(
            &mut motion,
            trial,
            dynamic,
            alphas,
            (constraints, external),
            observers,
        );
        self.motion = Some(motion);
        outcome
    }

    fn integrate(
        &mut self,
        motion: &mut Motion,
        trial: Trial,
        dynamic: &Dynamic,
        alphas: Alphas,
        (constraints, external): (Constraints, Vec<f64>),
        observers: &mut [&mut dyn Observer],
    ) -> Result<Accepted, StepFailure> {
        // The weight that the forces of the interfaces at the end have in the balance at the stage.
        let weight = match dynamic.contact_at {
            ContactAt::End => 1.0,
            ContactAt::Stage => 1.0 - alphas.alpha_f,
        };
        let inertia = &mut motion.inertia;
        let dt = inertia.ready(&self.matrix, alphas, trial.to - trial.from, weight);
        let inertia = &motion.inertia;
        let plain = inertia.plain(&constraints.fixed, &self.model.links);
        let fixed = constraints.fixed.clone();
        let from = self.state.clone();
        let increment = Increment {
            alphas,
            dt,
            from: &from,
            plain: &plain,
        };
        let mut guess = increment.predict();
        constraints.impose(&mut guess);
        self.model.links.impose(&mut guess);
        let balance = Balance {
            simulation: self,
            inertia,
            alphas,
            weight,
            external: &external,
        };
        let internal = times(&self.matrix, &guess);
        let stage = mix(alphas.alpha_f, &motion.internal, &internal);
        let (mut forces, scale) = balance.at(&increment, &guess, &stage);
        let start = guess.clone();
        forces.iter_mut().for_each(|f| *f /= weight);
        let known = forces.clone();
        let (gain, shift) = increment.rate();
        let mut at = State {
            t: trial.to,
            u: guess.clone(),
            ..State::default()
        };
        let mut seen = Vec::new();
        let origin = Origin {
            at: guess,
            forces,
            scale: scale / weight,
        };
        let rate = Rate {
            gain: &gain,
            shift: &shift,
        };
        let inertia = &motion.inertia;
        let (matrix, diagonal, key) =
            (inertia.matrix()).expect("the matrix of this length was made");
        let condensed = self.ready_to_move(&constraints.fixed, (matrix, key));
        (self.model.couplings).fit(diagonal, &constraints.fixed, &self.model.links);
        let converged = if condensed {
            self.solve_condensed(
                (diagonal, key),
                origin,
                (&from, &mut at),
                constraints,
                rate,
                &mut seen,
            )
        } else {
            let Simulation {
                model,
                newton,
                factors,
                ..
            } = self;
            let mut bulk = SparseBulk::new(
                (matrix, diagonal),
                vec![0.0; at.u.len()],
                fixed.clone(),
                Some(origin),
                factors.of(key),
            );
            let mut system = System {
                dofs: model.dofs,
                bulk: &mut bulk,
                constraints,
                links: &model.links,
                rate: Some(rate),
                contact: inertia::contact(&mut model.interfaces, &mut model.couplings),
            };
            newton.solve(&mut system, &from, &mut at, &mut |p| seen.push(*p))
        };
        self.tell(&seen, observers);
        let mut converged = converged?;
        let moved = difference(&at.u, &start);
        let change = times(&self.matrix, &moved);
        if condensed {
            let stage = motion.inertia.stage_times(&moved, &change);
            converged.forces = (0..moved.len())
                .map(|i| known[i] + stage[i] + converged.contact[i])
                .collect();
            let (_, diagonal, _) = motion.inertia.matrix().unwrap_or((&self.matrix, &[], 0));
            self.check_balance(&converged, &at.u, (diagonal, &fixed), scale / weight)?;
        }
        let internal: Vec<f64> = internal.iter().zip(&change).map(|(a, b)| a + b).collect();
        (at.v, at.a) = increment.motion(&at.u);
        for (a, _) in at.a.iter_mut().zip(&inertia.light).filter(|(_, l)| **l) {
            *a = 0.0;
        }
        self.model.links.impose(&mut at.v);
        self.model.links.impose(&mut at.a);
        let solved = Solved {
            reactions: converged.forces.iter().map(|f| weight * f).collect(),
            contact: converged.contact.clone(),
            external: external.clone(),
            internal,
            state: at,
        };
        self.check_reach()?;
        let easy = self.judge(motion, dynamic, alphas, (dt, trial), &solved)?;
        let flow = self.flow(motion, alphas, weight, &fixed, &solved);
        Ok(Accepted {
            forces: solved.reactions.clone(),
            contact: solved.contact,
            external,
            flow,
            rate: Some((gain, shift)),
            strain: Some(0.5 * dot(&solved.state.u, &solved.internal)),
            internal: Some(solved.internal),
            hard: !easy,
            state: solved.state,
            ..Accepted::from_newton(&converged)
        })
    }

    /// Makes the condensed bodies for a matrix ready; `false` where the increment is solved with the sparse matrix.
    fn ready_to_move(&mut self, held: &[bool], (matrix, key): (&BlockCsr, u64)) -> bool {
        let kept = self.kept.clone().unwrap_or_default();
        let found = self
            .moving
            .iter()
            .position(|(k, c, _)| *k == key && c.held == held);
        let last = match found {
            Some(i) => self.moving.remove(i),
            None => {
                if !self.model.method.condenses() {
                    return false;
                }
                let Some(made) = self.condensation(held, &kept, matrix) else {
                    return false;
                };
                (key, made, ReducedSystem::default())
            }
        };
        if self.moving.len() == MOST_CONDENSED {
            self.moving.remove(0);
        }
        self.moving.push(last);
        true
    }

    /// Solves an increment on the contact candidates and finds the interior.
    fn solve_condensed(
        &mut self,
        (diagonal, key): (&[f64], u64),
        origin: Origin,
        (from, at): (&State, &mut State),
        constraints: Constraints,
        rate: Rate,
        seen: &mut Vec<Progress>,
    ) -> Result<Converged, StepFailure> {
        let Simulation {
            model,
            newton,
            moving,
            ..
        } = self;
        let (_, condensation, gaps) = (moving.iter_mut().find(|(k, ..)| *k == key))
            .expect("the matrix of this length was condensed");
        let started = std::time::Instant::now();
        let Origin {
            at: guess,
            forces,
            scale,
        } = origin;
        let opposite: Vec<f64> = forces.iter().map(|f| -f).collect();
        let (load, interior) = condensation.sweep(&opposite);
        newton.statistics.seconds_solve += started.elapsed().as_secs_f64();
        let base = condensation.gather(&guess);
        let still = vec![0.0; base.len()];
        let mut bulk = CondensedBulk::new(
            (condensation, gaps),
            diagonal,
            load,
            base.clone(),
            still,
            scale,
        );
        let fixed = constraints.fixed.clone();
        let mut system = System {
            dofs: model.dofs,
            bulk: &mut bulk,
            constraints,
            links: &model.links,
            rate: Some(rate),
            contact: inertia::contact(&mut model.interfaces, &mut model.couplings),
        };
        let converged = newton.solve(&mut system, from, at, &mut |p| seen.push(*p))?;
        let started = std::time::Instant::now();
        let mut moved = condensation.gather(&at.u);
        moved.iter_mut().zip(&base).for_each(|(m, b)| *m -= b);
        let mut all = vec![vec![0.0; guess.len()]];
        condensation.recover(vec![interior], &[moved], &mut all);
        let moved = all.swap_remove(0);
        for i in 0..moved.len() {
            if !fixed[i] {
                at.u[i] = guess[i] + moved[i];
            }
        }
        newton.statistics.seconds_recover += started.elapsed().as_secs_f64();
        Ok(converged)
    }

    /// Refuses a solution whose interior is not in balance.
    fn check_balance(
        &self,
        converged: &Converged,
        u: &[f64],
        (diagonal, fixed): (&[f64], &[bool]),
        scale: f64,
    ) -> Result<(), StepFailure> {
        let (mut left, mut size, mut rounding) = (0.0, scale * scale, 0.0);
        for (i, f) in converged.forces.iter().enumerate() {
            if fixed[i] {
                size += f * f;
            } else {
                left += f * f;
                rounding += (diagonal[i] * u[i]).powi(2);
            }
        }
        let size: f64 = size + dot(&converged.contact, &converged.contact);
        let rounding: f64 = rounding;
        let limit = ((10.0 * self.model.settings.tolerance).max(LEFT) * size.sqrt())
            .max(1e4 * f64::EPSILON * rounding.sqrt());
        if left.is_nan() || left.sqrt() > limit {
            return Err(StepFailure::new(
                Cause::LinearSolver,
                format!(
                    "the recovered interior is not in balance: {:.1e} of the forces in play",
                    (left / size).sqrt()
                ),
            )
            .help("set `solver.method = \"sparse\"`"));
        }
        Ok(())
    }

    /// Whether the increment is small enough for the errors and events that are to be resolved; `false` if only just.
    fn judge(
        &self,
        motion: &mut Motion,
        dynamic: &Dynamic,
        alphas: Alphas,
        (dt, trial): (f64, Trial),
        solved: &Solved,
    ) -> Result<bool, StepFailure> {
        self.check_change(&solved.state.u)?;
        let mut easy = true;
        let inertia = &motion.inertia;
        let norm = |x: &[f64]| dot(x, &inertia.mass_times(x)).max(0.0).sqrt();
        let smallest = self.model.steps[self.step].increments.smallest;
        if let Some(limit) = dynamic.error {
            let moved: Vec<f64> = difference(&solved.state.u, &motion.start);
            motion.reach = motion.reach.max(norm(&moved));
            let turn = difference(&solved.state.a, &self.state.a);
            let error = error_factor(alphas.beta) * dt * dt * norm(&turn);
            let relative = error / motion.reach.max(f64::MIN_POSITIVE);
            if relative > limit && 0.5 * dt >= smallest {
                return Err(StepFailure::new(
                    Cause::TooFar,
                    format!("local error {relative:.1e} of the motion, more than `error` allows"),
                ));
            }
            // It grows with the square of the increment: twice the length would be too much.
            easy = relative <= 0.25 * limit;
        }
        self.locate(dynamic, trial)?;
        Ok(easy)
    }

    /// Rejects an increment over which points change status until it is as short as `events` asks for.
    pub(super) fn locate(&self, dynamic: &Dynamic, trial: Trial) -> Result<(), StepFailure> {
        let Some(tolerance) = dynamic.events else {
            return Ok(());
        };
        let dt = trial.to - trial.from;
        let smallest = self.model.steps[self.step].increments.smallest;
        let switched: usize = self
            .model
            .interfaces
            .iter()
            .map(|interface| interface.switched())
            .sum();
        if switched > 0 && dt > tolerance && 0.5 * dt >= smallest {
            return Err(StepFailure::new(
                Cause::Event,
                format!("{switched} points open, close, stick or slip: the time is being located"),
            ));
        }
        Ok(())
    }

    /// What flows in and out over the increment. With `Δ` for differences and bars for means of the two ends,
    ///
    /// ```text
    /// ΔT + ΔU = v̄ᵀ M Δv + ūᵀ K Δu
    /// ```
    ///
    /// and the balance at the stage times `Δu` gives what the scheme itself takes:
    ///
    /// ```text
    /// D = Δuᵀ M a_m - v̄ᵀ M Δv + (½ - α_f) (Δuᵀ K Δu + Δvᵀ C Δu) + (w - ½) ΔRᵀ Δu - (½ - α_f) ΔFᵀ Δu
    /// ```
    ///
    /// `w` is the weight of the interfaces' forces `R` at the end. For the trapezoidal rule it vanishes but for the last residual.
    fn flow(
        &self,
        motion: &Motion,
        alphas: Alphas,
        weight: f64,
        fixed: &[bool],
        solved: &Solved,
    ) -> Flow {
        let inertia = &motion.inertia;
        let (from, to) = (&self.state, &solved.state);
        let du = difference(&to.u, &from.u);
        let dv = difference(&to.v, &from.v);
        let mean_v: Vec<f64> = mix(0.5, &from.v, &to.v);
        let stage_a = mix(alphas.alpha_m, &from.a, &to.a);
        let half = 0.5 - alphas.alpha_f;
        let mean_f = mix(0.5, &self.load, &solved.external);
        let mut work = dot(&mean_f, &du);
        for (i, _) in fixed.iter().enumerate().filter(|(_, f)| **f) {
            work += solved.reactions[i] * du[i];
        }
        let contact = difference(&solved.contact, &self.contact);
        let load = difference(&solved.external, &self.load);
        let mut numerical = dot(&du, &inertia.mass_times(&stage_a))
            - dot(&mean_v, &inertia.mass_times(&dv))
            + half * dot(&du, &difference(&solved.internal, &motion.internal))
            + (weight - 0.5) * dot(&contact, &du)
            - half * dot(&load, &du);
        let mut damped = 0.0;
        if let Some(damping) = &inertia.damping {
            damped = dot(&du, &times(damping, &mean_v));
            numerical += half * dot(&dv, &times(damping, &du));
        }
        Flow {
            work,
            damped,
            numerical,
        }
    }
}

/// The balance at the stage without the interfaces' forces at the end.
struct Balance<'a> {
    simulation: &'a Simulation,
    inertia: &'a Inertia,
    alphas: Alphas,
    weight: f64,
    external: &'a [f64],
}

impl Balance<'_> {
    /// Forces with displacements `u` at the end and elastic forces `internal` at the stage, and the size of what balances in them.
    fn at(&self, increment: &Increment, u: &[f64], internal: &[f64]) -> (Vec<f64>, f64) {
        let Alphas {
            alpha_m, alpha_f, ..
        } = self.alphas;
        let from = &self.simulation.state;
        let (v, a) = increment.motion(u);
        let mut a = mix(alpha_m, &from.a, &a);
        for (a, _) in a.iter_mut().zip(&self.inertia.light).filter(|(_, l)| **l) {
            *a = 0.0;
        }
        let inertial = self.inertia.mass_times(&a);
        let damping = self.inertia.damping_force(&mix(alpha_f, &from.v, &v));
        let load = mix(alpha_f, &self.simulation.load, self.external);
        let old = 1.0 - self.weight;
        let forces = (0..u.len())
            .map(|i| {
                inertial[i] + internal[i] + damping[i] - load[i] + old * self.simulation.contact[i]
            })
            .collect();
        let size = |x: &[f64]| dot(x, x).sqrt();
        let scale = size(&inertial).max(size(&load)).max(size(internal));
        (forces, scale)
    }
}

/// `(1 - old) b + old a`.
fn mix(old: f64, a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter()
        .zip(b)
        .map(|(a, b)| old * a + (1.0 - old) * b)
        .collect()
}

pub(super) fn difference(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a - b).collect()
}

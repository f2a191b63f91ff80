use std::sync::Arc;
use std::time::Instant;

use super::bulk::Bulk;
use super::settings::{Progress, Settings, Statistics};
use super::strategy::{Fallback, Strategy, WINDOW, active_sets, freeze, restart, strategies};
use crate::system::{
    Assembler, Augmentation, Cause, Constraints, Dofs, Force, Links, Rate, Stage, State,
    StepFailure, Tally,
};

/// Failures after which no other way is tried.
const HOPELESS: [Cause; 4] = [
    Cause::NotFinite,
    Cause::Reach,
    Cause::Memory,
    Cause::Interrupted,
];

/// What is solved: the balance of the bulk and the interfaces with prescribed displacements.
pub struct System<'a> {
    /// Numbering.
    pub dofs: Dofs,
    /// Everything but the interfaces.
    pub bulk: &'a mut dyn Bulk,
    /// The interfaces.
    pub contact: Vec<&'a mut dyn Force>,
    /// How velocities follow from displacements, for friction.
    pub rate: Option<Rate<'a>>,
    /// Prescribed displacements at the time of evaluation.
    pub constraints: Constraints,
    /// Rigid bodies; the dofs of their points are fixed, and the bulk has nothing there.
    pub links: &'a Links,
}

/// An equilibrium.
#[derive(Debug, Clone, PartialEq)]
pub struct Converged {
    /// Newton iterations, over all multiplier updates and all that was tried.
    pub iterations: usize,
    /// Multiplier updates.
    pub rounds: usize,
    /// Out-of-balance force relative to the forces in play.
    pub residual: f64,
    /// Internal minus external forces at the dofs of the bulk: reactions at the fixed ones.
    pub forces: Vec<f64>,
    /// The part of the interfaces, at all dofs.
    pub contact: Vec<f64>,
    /// Points by status.
    pub tally: Tally,
}

/// Newton's method with a line search and multiplier updates.
#[derive(Default)]
pub struct Newton {
    /// Settings.
    pub settings: Settings,
    /// Counts since the start.
    pub statistics: Statistics,
    /// What was tried in the last solution when plain iteration had failed, in this order.
    pub fallbacks: Vec<Fallback>,
    /// Asked in every iteration whether the solution shall be given up.
    pub interrupt: Option<Arc<dyn Fn() -> bool + Send + Sync>>,
    strategy: Strategy,
}

/// A residual and what it is compared with.
struct Balance {
    /// Bulk and interfaces, by dof.
    forces: Vec<f64>,
    /// Norm over the free dofs.
    norm: f64,
    /// Size of the forces in play.
    scale: f64,
    /// What rounding leaves of the forces.
    floor: f64,
    /// The merit function: out-of-balance forces and residuals of multipliers.
    merit: f64,
}

impl Balance {
    fn relative(&self) -> f64 {
        if self.norm == 0.0 {
            0.0
        } else {
            self.norm / self.scale.max(f64::MIN_POSITIVE)
        }
    }
}

impl Newton {
    /// A solver with these settings.
    pub fn new(settings: Settings) -> Self {
        Newton {
            settings,
            ..Newton::default()
        }
    }

    /// Whether the solution shall be given up.
    pub fn interrupted(&self) -> bool {
        self.interrupt.as_ref().is_some_and(|asked| asked())
    }

    /// Finds equilibrium at `at.t` from the guess `at.u`; every interface starts from its committed history.
    pub fn solve(
        &mut self,
        system: &mut System,
        from: &State,
        at: &mut State,
        log: &mut dyn FnMut(&Progress),
    ) -> Result<Converged, StepFailure> {
        system.constraints.impose(&mut at.u);
        system.links.impose(&mut at.u);
        let guess = at.u.clone();
        let begun = self.statistics.iterations;
        self.fallbacks.clear();
        self.strategy = Strategy::Plain;
        freeze(system, false);
        restart(system, at, &guess);
        let failure = match self.rounds(system, from, at, log) {
            Err(failure) if !HOPELESS.contains(&failure.cause) => failure,
            outcome => return outcome,
        };
        for strategy in strategies(system) {
            let before = self.statistics.iterations;
            self.strategy = strategy;
            let outcome = self.follow(strategy, system, from, at, &guess, log);
            self.strategy = Strategy::Plain;
            let outcome = match outcome {
                None => continue,
                Some(Err(failure)) if failure.cause == Cause::Interrupted => return Err(failure),
                Some(outcome) => outcome,
            };
            self.statistics.fallbacks += 1;
            self.fallbacks.push(Fallback {
                kind: strategy,
                iterations: self.statistics.iterations - before,
                converged: outcome.is_ok(),
            });
            if let Ok(converged) = outcome {
                return Ok(Converged {
                    iterations: self.statistics.iterations - begun,
                    ..converged
                });
            }
        }
        Err(failure)
    }

    /// Equilibrium, then multiplier updates until they settle.
    pub(super) fn rounds(
        &mut self,
        system: &mut System,
        from: &State,
        at: &mut State,
        log: &mut dyn FnMut(&Progress),
    ) -> Result<Converged, StepFailure> {
        let mut total = 0;
        let mut round = 0;
        let mut exchanges = 0;
        let patience = system.contact.iter().map(|f| f.patience()).max();
        let most = MOST_ROUNDS + patience.unwrap_or(0);
        loop {
            let mut converged = self.equilibrium(system, from, at, round, log)?;
            total += converged.iterations;
            let held: usize = active_sets(system).map(|f| f.recheck()).sum();
            if held > 0 {
                exchanges += 1;
                if exchanges > MOST_EXCHANGES {
                    return Err(StepFailure {
                        culprits: diagnose(system),
                        ..StepFailure::new(Cause::NotConverged, "points keep changing status")
                    });
                }
                continue;
            }
            let rate = system.rate;
            let stage = Stage {
                from,
                at,
                dt: at.t - from.t,
                rate,
            };
            let mut worst: f64 = 0.0;
            for force in &mut system.contact {
                if let Augmentation::Again(error) = force.augment(&stage) {
                    worst = worst.max(error);
                }
            }
            if worst == 0.0 {
                converged.iterations = total;
                converged.rounds = round;
                return Ok(converged);
            }
            round += 1;
            self.statistics.augmentations += 1;
            if round > most {
                return Err(StepFailure {
                    culprits: diagnose(system),
                    ..StepFailure::new(
                        Cause::NotConverged,
                        format!("the multipliers did not settle in {most} updates; the gap error is still {worst:.1e} times its limit"),
                    )
                }
                .help("allow a larger `error` or a larger `factor` in the augmented Lagrangian, or smaller increments"));
            }
        }
    }

    pub(super) fn equilibrium(
        &mut self,
        system: &mut System,
        from: &State,
        at: &mut State,
        round: usize,
        log: &mut dyn FnMut(&Progress),
    ) -> Result<Converged, StepFailure> {
        let settings = self.settings;
        let n = system.dofs.count();
        let mut out = Assembler::new(n);
        out.wants_surrogate = system.bulk.wants_surrogates();
        out.wants_pairs = system.bulk.wants_pairs();
        // Bodies that are being followed roll on their anchors, whose steps are tuned to what they feel without it.
        out.wants_curvature = system.contact.iter().all(|f| f.patience() == 0);
        out.holds_turns = !out.wants_curvature;
        let (mut b, mut du) = (vec![0.0; n], vec![0.0; n]);
        let mut balance = self.evaluate(system, from, at, &mut out, true)?;
        let mut residuals = Vec::new();
        let strict_merit = self.strategy == Strategy::LineSearch;
        let mut merits = [balance.merit; WINDOW];
        // Residual at which steps began to have to gain; they have to until a hundredth of it is left.
        let mut strict: f64 = 0.0;
        for iteration in 0..=settings.max_iterations {
            if self.interrupted() {
                return Err(StepFailure::new(Cause::Interrupted, "interrupted"));
            }
            let relative = balance.relative();
            residuals.push(relative);
            let multipliers = out.multiplier_residual;
            let target = (settings.tolerance * balance.scale).max(balance.floor);
            if balance.norm <= target && multipliers <= target {
                return Ok(Converged {
                    iterations: iteration,
                    rounds: round,
                    // what is below rounding is none
                    residual: if balance.norm <= balance.floor {
                        0.0
                    } else {
                        relative
                    },
                    tally: tally(system),
                    forces: balance.forces,
                    contact: std::mem::take(&mut out.residual),
                });
            }
            // Points that keep changing status are better held than given more time.
            let chatter = self.strategy == Strategy::Plain
                && stalled(&residuals)
                && active_sets(system).any(|f| f.chattering() > 0);
            if chatter || iteration == settings.max_iterations {
                break;
            }
            b.fill(0.0);
            let mut size = 0.0;
            for &i in system.bulk.dofs() {
                if !system.bulk.fixed()[i] {
                    b[i] = -(balance.forces[i] + out.condensed[i]);
                    size += b[i] * b[i];
                }
            }
            // While points still change status the linear problem is not the last one: digits would be thrown away.
            let loose = settings.linear_tolerance;
            let wanted = if iteration == 0 || tally(system).changed > 0 {
                loose
            } else {
                0.1 * target / f64::sqrt(size).max(f64::MIN_POSITIVE)
            };
            let wanted = wanted.clamp(1e-13, loose.max(1e-13));
            let counts = &mut self.statistics;
            let solved = (system.bulk).solve(&out, &b, wanted, &mut du, (&settings, counts));
            let krylov = match solved {
                // Preconditioners know nothing of the curvature. Where it is so large that they fail, slower iterations are better than none.
                Err(failure) if failure.cause == Cause::LinearSolver && out.drop_curvature() => {
                    let counts = &mut self.statistics;
                    (system.bulk).solve(&out, &b, wanted, &mut du, (&settings, counts))?
                }
                solved => solved?,
            };
            system.links.impose(&mut du);
            self.statistics.iterations += 1;
            let before = balance.norm.max(multipliers);
            let reported = before / balance.scale.max(f64::MIN_POSITIVE);
            // Status may have to change against the residual: at first only a step that makes it much worse is shortened.
            // Once three iterations have gained nothing, points are going to and fro, and every step has to gain.
            let stuck = iteration >= 4 && relative > 0.5 * residuals[iteration - 3];
            strict = if stuck {
                strict.max(relative)
            } else if relative < 0.01 * strict {
                0.0
            } else {
                strict
            };
            let stuck = strict > 0.0;
            let patience = match (stuck, iteration < 4) {
                (true, _) => 0.99,
                (false, true) => 1e3,
                (false, false) => 10.0,
            };
            let most_merit = merits.iter().copied().fold(0.0, f64::max);
            let start = at.u.clone();
            let mut step = 1.0;
            let mut best: Option<(f64, f64)> = None;
            let mut halvings = 0;
            loop {
                for ((u, s), d) in at.u.iter_mut().zip(&start).zip(&du) {
                    *u = s + step * d;
                }
                system.bulk.advance(step);
                for force in &mut system.contact {
                    force.update_internal(&du, step);
                }
                // Most full steps are taken: their tangent is made at once.
                out.tentative = halvings == 0;
                balance = self.evaluate(system, from, at, &mut out, halvings == 0)?;
                let now = if strict_merit {
                    balance.merit
                } else {
                    balance.norm.max(out.multiplier_residual)
                };
                if now.is_finite() && best.is_none_or(|(b, _)| now < b) {
                    best = Some((now, step));
                }
                // A compliant law that has hardly been touched is so soft that the step overshoots by orders of magnitude.
                let lost = now.is_nan() || now > LOST * before;
                let most = match settings.line_search {
                    n if n > 0 && lost => MOST_HALVINGS,
                    _ if strict_merit => MERIT_HALVINGS,
                    n => n,
                };
                let good = if strict_merit {
                    now <= (1.0 - ARMIJO * step) * most_merit
                } else {
                    now <= patience * before
                };
                if good || halvings >= most {
                    break;
                }
                halvings += 1;
                step *= 0.5;
            }
            let Some((_, chosen)) = best else {
                return Err(StepFailure {
                    culprits: diagnose(system),
                    ..StepFailure::new(Cause::NotFinite, "the forces are not finite")
                });
            };
            let tried = if strict_merit {
                MERIT_HALVINGS
            } else {
                settings.line_search
            };
            let step = if halvings >= tried { chosen } else { step };
            out.tentative = false;
            if halvings == 0 {
                for force in &mut system.contact {
                    force.settle();
                }
                system.bulk.covers(&out)?;
            } else {
                for ((u, s), d) in at.u.iter_mut().zip(&start).zip(&du) {
                    *u = s + step * d;
                }
                system.bulk.advance(step);
                for force in &mut system.contact {
                    force.update_internal(&du, step);
                }
                balance = self.evaluate(system, from, at, &mut out, true)?;
            }
            merits[iteration % WINDOW] = balance.merit;
            log(&Progress {
                strategy: self.strategy,
                iteration,
                round,
                residual: reported,
                step,
                krylov,
                tally: tally(system),
            });
        }
        let last: Vec<String> = residuals
            .iter()
            .rev()
            .take(5)
            .rev()
            .map(|r| format!("{r:.1e}"))
            .collect();
        Err(StepFailure {
            culprits: diagnose(system),
            ..StepFailure::new(
                Cause::NotConverged,
                format!(
                    "no equilibrium in {} iterations; out-of-balance force relative to the forces in play: … {}",
                    residuals.len() - 1,
                    last.join(", ")
                ),
            )
        }
        .help("smaller increments; if the same points keep changing status, a larger `epsilon` or a smaller enforcement `factor`; if a body can slide off as a whole, no equilibrium exists"))
    }

    fn evaluate(
        &mut self,
        system: &mut System,
        from: &State,
        at: &State,
        out: &mut Assembler,
        tangent: bool,
    ) -> Result<Balance, StepFailure> {
        let started = Instant::now();
        let stage = Stage {
            from,
            at,
            dt: at.t - from.t,
            rate: system.rate,
        };
        out.reset(tangent);
        for force in &mut system.contact {
            force.prepare(&stage);
            force.assemble(&stage, out)?;
        }
        self.statistics.seconds_contact += started.elapsed().as_secs_f64();
        let mut forces = vec![0.0; at.u.len()];
        let others = system.bulk.forces(&at.u, &mut forces);
        // Forces in play are those on the points: what a rigid body gets from two sides may cancel.
        let contact: f64 = out.residual.iter().map(|r| r * r).sum();
        transfer(system.links, out);
        if tangent && !out.tentative {
            system.bulk.covers(out)?;
        }
        let (mut norm, mut bulk) = (0.0, 0.0);
        let fixed = system.bulk.fixed();
        for &i in system.bulk.dofs() {
            forces[i] += out.residual[i];
            if !fixed[i] {
                let stiffness = system.bulk.diagonal(i);
                bulk += (4.0 * f64::EPSILON * stiffness * at.u[i]).powi(2);
                norm += forces[i] * forces[i];
            }
        }
        Ok(Balance {
            forces,
            norm: norm.sqrt(),
            merit: (norm + out.multiplier_merit).sqrt(),
            scale: others.max(contact.sqrt()),
            floor: (out.rounding + bulk).sqrt(),
        })
    }
}

/// Growth of the out-of-balance force after which a step is halved without counting.
const LOST: f64 = 1e4;

/// Most halvings even so.
const MOST_HALVINGS: usize = 40;

/// Most halvings of a step that has to reduce the merit function, and by how much it has to, relative to what Newton's direction promises.
const MERIT_HALVINGS: usize = 10;
const ARMIJO: f64 = 1e-4;

/// How often the choices of points that keep changing status are exchanged.
const MOST_EXCHANGES: usize = 20;

/// Iterations after which a residual that has not fallen counts as stalled.
const STALL: usize = 8;

/// Most multiplier updates in one increment.
const MOST_ROUNDS: usize = 25;

/// Lets what acts on the points of rigid bodies act on the bodies.
fn transfer(links: &Links, out: &mut Assembler) {
    if links.is_empty() {
        return;
    }
    links.transfer(&mut out.residual);
    links.transfer(&mut out.condensed);
    for block in &mut out.blocks {
        if let Some(moved) = links.transform(block) {
            *block = moved;
        }
    }
    for dofs in &mut out.couplings {
        if let Some(moved) = links.transform_dofs(dofs) {
            *dofs = moved;
        }
    }
}

/// Whether the last iterations have not brought the residual down by an order of magnitude.
fn stalled(residuals: &[f64]) -> bool {
    let Some(split) = residuals.len().checked_sub(STALL) else {
        return false;
    };
    let (before, after) = residuals.split_at(split);
    let least = |r: &[f64]| r.iter().copied().fold(f64::INFINITY, f64::min);
    before.len() >= STALL && least(after) > 0.1 * least(before)
}

fn tally(system: &System) -> Tally {
    system.contact.iter().filter_map(|f| f.tally()).sum()
}

fn diagnose(system: &System) -> Vec<crate::system::Culprit> {
    let mut all: Vec<_> = system.contact.iter().flat_map(|f| f.diagnose()).collect();
    all.truncate(10);
    all
}

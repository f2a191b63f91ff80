//! The driver of increments with an integrator that is none of the library's, and the integrators of the library with bodies that are none.

use std::path::Path;
use std::sync::{Arc, Mutex};

use super::begin::begin_step;
use super::position::Increments;
use super::simulation::Simulation;
use crate::error::Error;
use crate::integrate::integrator::Integrator;
use crate::linear::{BlockCsr, Matrix};
use crate::math::vector::dot;
use crate::model::contact::Contact;
use crate::model::definition::Model;
use crate::model::frame::Frame;
use crate::problem::Problem;
use crate::solve::accepted::{Accepted, Effort};
use crate::solve::solver::Solver;
use crate::system::{BodyModel, Cause, Deformed, NonlinearBody, State, StepFailure};
use crate::time::Trial;

/// A cell on a frame, pulled upwards at two points, with a ceiling where one is asked for.
fn simulation(step: &str, ceiling: Option<f64>) -> Simulation {
    let ceiling = ceiling.map_or(String::new(), |at| {
        format!(
            "[obstacle.ceiling]\nplane = {{ point = [0, {at}], normal = [0, -1] }}\n\
             [interface.stop]\nsecondary = \"cell.top\"\nprimary = \"ceiling\"\n"
        )
    });
    let text = format!(
        r#"
        format = 1
        [model]
        space = "plane-strain"
        [body.cell]
        generate.rectangle = {{ to = [1, 1], cells = [1, 1] }}
        material = "m"
        [material.m]
        isotropic = {{ young = 1.0, poisson = 0.0, density = 2.0 }}
        {ceiling}
        [support.sides]
        set = "cell"
        x = 0
        [support.bottom]
        set = "cell.bottom"
        y = 0
        [load.pull]
        set = "cell.top"
        pressure.value = -{PULL}
        {step}
        [solver]
        method = "sparse"
        tolerance = 1e-12
        "#
    );
    let problem = Problem::from_toml(&text, None).unwrap_or_else(|e| panic!("{e}"));
    let setup = problem
        .build(Path::new("."))
        .unwrap_or_else(|e| panic!("{e}"));
    Simulation::new(setup).unwrap_or_else(|e| panic!("{e}"))
}

const PULL: f64 = 0.2;

/// Begins the first step with another integrator in the place of its own.
fn begin_with(simulation: &mut Simulation, integrator: Box<dyn Integrator>) {
    let run = &mut simulation.run;
    run.steps.begun = true;
    run.steps.next = 1;
    begin_step(run, 0).unwrap_or_else(|e| panic!("{e}"));
    run.integrator = integrator;
    run.steps.running = Some(Increments::of(run.step()));
}

/// Accepts increments that a rule allows, and moves nothing.
struct Scripted {
    allows: fn(Trial) -> Result<usize, Cause>,
    tried: Arc<Mutex<Vec<Trial>>>,
}

impl Scripted {
    fn new(allows: fn(Trial) -> Result<usize, Cause>) -> (Box<Self>, Arc<Mutex<Vec<Trial>>>) {
        let tried = Arc::default();
        let own = Arc::clone(&tried);
        (Box::new(Scripted { allows, tried: own }), tried)
    }
}

impl Integrator for Scripted {
    fn attempt(
        &mut self,
        _model: &Model,
        frame: &Frame,
        _contact: &mut Contact,
        _solver: &mut Solver,
        trial: Trial,
    ) -> Result<Accepted, StepFailure> {
        if let Ok(mut tried) = self.tried.lock() {
            tried.push(trial);
        }
        let none = || vec![0.0; frame.state.u.len()];
        match (self.allows)(trial) {
            Ok(iterations) => Ok(Accepted {
                state: State {
                    t: trial.to,
                    u: none(),
                    ..State::default()
                },
                forces: none(),
                contact: none(),
                external: none(),
                effort: Effort {
                    iterations,
                    ..Effort::default()
                },
                ..Accepted::default()
            }),
            Err(cause) => Err(StepFailure::new(cause, "the script says no")),
        }
    }
}

/// Lengths that were tried, in sixteenths of a second.
fn sixteenths(tried: &Mutex<Vec<Trial>>) -> Vec<f64> {
    let tried = tried.lock().unwrap_or_else(|e| panic!("{e}"));
    let lengths = tried.iter().map(|t| 16.0 * (t.to - t.from));
    lengths.map(|x| (1e6 * x).round() / 1e6).collect()
}

#[test]
fn increments_are_halved_until_they_work_and_grow_where_they_are_easy() {
    let mut simulation = simulation(
        "[[step]]\nduration = 1\nincrements = { initial = 0.5, smallest = 0.01, largest = 0.5 }\n",
        None,
    );
    // Nothing longer than an eighth before the middle of the step; the second half is easy.
    let (integrator, tried) = Scripted::new(|trial| {
        match trial.from < 0.5 - 1e-9 && trial.to - trial.from > 0.125 + 1e-9 {
            true => Err(Cause::NotConverged),
            false => Ok(if trial.from < 0.5 - 1e-9 { 20 } else { 1 }),
        }
    });
    begin_with(&mut simulation, integrator);
    simulation.run(&mut []).unwrap_or_else(|e| panic!("{e}"));
    let attempts = &simulation.run.summary.attempts;
    // Two halvings; hard increments stay as they are; two easy ones in a row let the next grow by half, and what is left is divided evenly.
    let expected = [8.0, 4.0, 2.0, 2.0, 2.0, 2.0, 2.0, 2.0, 2.0, 2.0];
    assert_eq!(sixteenths(&tried), expected);
    assert_eq!((attempts.increments, attempts.cutbacks), (8, 2));
    assert!((simulation.frame.state.t - 1.0).abs() < 1e-15);
    assert!(attempts.cutback_reasons[0].contains("the script says no"));
}

#[test]
fn an_increment_that_cannot_be_smaller_ends_the_run_where_it_was() {
    let mut simulation = simulation(
        "[[step]]\nduration = 1\nincrements = { initial = 0.25, smallest = 0.1, largest = 0.25 }\n",
        None,
    );
    let (integrator, tried) = Scripted::new(|trial| match trial.to > 0.6 {
        true => Err(Cause::NotConverged),
        false => Ok(1),
    });
    begin_with(&mut simulation, integrator);
    let error = simulation
        .run(&mut [])
        .expect_err("the script does not go on");
    let Error::Run(error) = error else {
        panic!("{error}")
    };
    assert!(
        error.message.contains("the script says no"),
        "{}",
        error.message
    );
    assert_eq!((error.time, simulation.frame.state.t), (0.5, 0.5));
    // A quarter from the half, an eighth; half of that is too small.
    assert_eq!(sixteenths(&tried), [4.0, 4.0, 4.0, 2.0]);
    assert_eq!(simulation.run.summary.attempts.cutbacks, 2);
}

#[test]
fn an_attempt_that_was_interrupted_is_tried_again() {
    let mut simulation = simulation("[[step]]\nincrements = { fixed = 2 }\n", None);
    let (integrator, tried) = Scripted::new(|_| Err(Cause::Interrupted));
    begin_with(&mut simulation, integrator);
    let error = simulation.run(&mut []).expect_err("stopped");
    assert!(
        matches!(error, Error::Interrupted(t) if t == 0.0),
        "{error}"
    );
    let (integrator, more) = Scripted::new(|_| Ok(1));
    simulation.run.integrator = integrator;
    simulation.run(&mut []).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(sixteenths(&tried), [8.0]);
    assert_eq!(sixteenths(&more), [8.0, 8.0]);
    assert_eq!(simulation.run.summary.attempts.cutbacks, 0);
}

/// A spring at every dof, `k u + c u³`.
#[derive(Debug)]
struct Hardening {
    k: f64,
    c: f64,
    /// A matrix with the pattern of the model.
    like: BlockCsr,
}

impl Hardening {
    fn force(&self, u: f64) -> f64 {
        self.k * u + self.c * u.powi(3)
    }
}

impl BodyModel for Hardening {
    fn forces(&self, u: &[f64]) -> Vec<f64> {
        u.iter().map(|&u| self.force(u)).collect()
    }

    fn energy(&self, at: Deformed) -> f64 {
        let one = |u: &f64| 0.5 * self.k * u.powi(2) + 0.25 * self.c * u.powi(4);
        at.u.iter().map(one).sum()
    }

    fn stage_forces(&self, first: f64, [from, to]: [Deformed; 2]) -> Vec<f64> {
        let ends = from.u.iter().zip(to.u);
        ends.map(|(a, b)| self.force(first * a + (1.0 - first) * b))
            .collect()
    }

    fn nonlinear(&self) -> Option<&dyn NonlinearBody> {
        Some(self)
    }
}

impl NonlinearBody for Hardening {
    fn write_forces(&self, u: &[f64], out: &mut [f64]) {
        out.copy_from_slice(&self.forces(u));
    }

    fn tangents(&self, u: &[f64]) -> [BlockCsr; 2] {
        let mut tangent = self.like.zeros_like();
        for p in 0..u.len() / 2 {
            let own = [0, 1].map(|c| self.k + 3.0 * self.c * u[2 * p + c].powi(2));
            tangent.add_group(&[p], &[own[0], 0.0, 0.0, own[1]]);
        }
        [tangent.clone(), tangent]
    }
}

/// With springs that harden in the place of the cell.
fn hardening(ceiling: Option<f64>) -> Simulation {
    let mut simulation = simulation("[[step]]\nincrements = { fixed = 4 }\n", ceiling);
    let solver = &mut simulation.run.solver;
    solver.bodies = Arc::new(Hardening {
        k: 0.3,
        c: 20.0,
        like: solver.stiffness.make(),
    });
    simulation.run(&mut []).unwrap_or_else(|e| panic!("{e}"));
    simulation
}

/// The displacement of a spring under a force, by bisection.
fn stretched(force: f64) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        match 0.3 * middle + 20.0 * f64::powi(middle, 3) < force {
            true => low = middle,
            false => high = middle,
        }
    }
    low
}

#[test]
fn increments_at_rest_follow_bodies_of_any_formulation() {
    let simulation = hardening(None);
    let top = stretched(0.5 * PULL);
    let u = &simulation.frame.state.u;
    let moved: Vec<f64> = u.iter().copied().filter(|u| *u != 0.0).collect();
    assert_eq!(moved.len(), 2);
    assert!(
        moved.iter().all(|u| (u - top).abs() < 1e-10),
        "{moved:?} {top}"
    );
    // Energy and work of the trapezoidal rule over four increments that are cubic.
    let stored = 2.0 * (0.15 * top * top + 5.0 * top.powi(4));
    assert!((simulation.frame.ledger.strain - stored).abs() < 1e-10);
}

#[test]
fn contact_takes_what_bodies_of_any_formulation_leave() {
    let gap = 0.6 * stretched(0.5 * PULL);
    let simulation = hardening(Some(1.0 + gap));
    let frame = &simulation.frame;
    let top = frame.state.u.iter().fold(0.0_f64, |m, u| m.max(*u));
    // Multipliers are updated until the gap is a small part of the approach.
    assert!((top / gap - 1.0).abs() < 1e-5, "{top} {gap}");
    let pressed: f64 = frame.contact.iter().sum();
    let left = PULL - 2.0 * (0.3 * top + 20.0 * top.powi(3));
    assert!(
        left > 0.1 * PULL && (pressed - left).abs() < 1e-10,
        "{pressed} {left}"
    );
}

/// A linear model that leaves the work of stage forces to what all formulations share.
#[derive(Debug)]
struct Plain(Arc<dyn Matrix>);

impl BodyModel for Plain {
    fn forces(&self, u: &[f64]) -> Vec<f64> {
        self.0.times(u)
    }

    fn energy(&self, at: Deformed) -> f64 {
        0.5 * dot(at.u, &self.0.times(at.u))
    }

    fn stage_forces(&self, first: f64, [from, to]: [Deformed; 2]) -> Vec<f64> {
        let ends = from.u.iter().zip(to.u);
        let stage: Vec<f64> = ends.map(|(a, b)| first * a + (1.0 - first) * b).collect();
        self.0.times(&stage)
    }
}

#[test]
fn steps_in_motion_close_the_ledger_with_bodies_of_any_formulation() {
    let step = "[[step]]\nduration = 2\nincrements = { fixed = 40 }\n[step.dynamic]\nscheme.hht = { alpha = -0.2 }\n";
    let ends = [false, true].map(|plain| {
        let mut simulation = simulation(step, None);
        if plain {
            let solver = &mut simulation.run.solver;
            solver.bodies = Arc::new(Plain(Arc::clone(&solver.stiffness)));
        }
        simulation.run(&mut []).unwrap_or_else(|e| panic!("{e}"));
        let frame = &simulation.frame;
        let ledger = &frame.ledger;
        assert!(ledger.numerical.abs() > 1e-6, "the scheme dissipates");
        (
            frame.state.u.clone(),
            [ledger.strain, ledger.kinetic, ledger.numerical],
        )
    });
    let [(u, ledger), (plain_u, plain)] = &ends;
    let near = |a: &[f64], b: &[f64]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-12);
    assert!(
        near(u, plain_u) && near(ledger, plain),
        "{ledger:?} {plain:?}"
    );
}

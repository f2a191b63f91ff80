//! An analysis goes on by one increment at a time, can be interrupted, and takes laws from the program that runs it.

use crate::support;
use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};
use stickslip::contact::look;

use stickslip::Error;
use stickslip::assess::View;
use stickslip::contact::interface::with_user_laws;
use stickslip::contact::law::user::{LimitFunction, PressureFunction};
use stickslip::model::Solution;
use stickslip::problem::Problem;
use stickslip::results::{Analysis, Event, Observer};
use stickslip::run::{Simulation, Work};

/// The block that is dragged; the second step has more increments than are recovered in one sweep.
fn case(method: &str) -> String {
    let numbers = ["[12, 4]", "[5, 5]", "2e12", "1e-3", "2"];
    support::dragged(method, numbers)
        + r#"
[material.m.isotropic]
young = 210e9
poisson = 0.3

[[step]]
increments.fixed = 2

[[step]]
increments.fixed = 20
"#
}

fn simulation(method: &str) -> Simulation {
    let problem = support::problem(&case(method));
    support::build(&problem).unwrap_or_else(|e| panic!("{e}"))
}

/// What was known at every reported increment.
#[derive(Default, PartialEq, Debug)]
struct Diary {
    rows: Vec<Vec<f64>>,
    states: Vec<Vec<f64>>,
    pressures: Vec<Vec<f64>>,
    ended: usize,
}

/// Pressures of the interface.
fn pressures(simulation: &View) -> Vec<f64> {
    let interface = simulation.contacts().next().expect("there is one");
    let table = look::table(interface, &simulation.frame.state.u);
    table.1[4].clone()
}

impl Observer for Diary {
    fn see(&mut self, simulation: &Analysis, event: Event) -> Result<(), Error> {
        match event {
            Event::Increment(row) => {
                self.rows.push(row.values.clone());
                self.states.push(simulation.frame.state.u.clone());
                self.pressures.push(pressures(simulation));
            }
            Event::End => self.ended += 1,
            _ => {}
        }
        Ok(())
    }
}

#[test]
fn going_on_by_one_increment_shows_the_state_of_each_and_gives_the_bits_of_a_run() {
    for method in ["sparse", "condensed"] {
        let mut whole = Diary::default();
        let mut run = simulation(method);
        run.run(&mut [&mut whole]).unwrap();
        assert_eq!(run.summary.solved_by.method, method);
        assert_eq!(whole.rows.len(), 22);

        let mut seen = Diary::default();
        let mut stepwise = simulation(method);
        loop {
            let before = seen.rows.len();
            let more = stepwise.advance(&mut [&mut seen]).unwrap();
            assert!(seen.rows.len() <= before + 1);
            if seen.rows.len() > before {
                assert_eq!(seen.states.last(), Some(&stepwise.frame.state.u));
                assert_eq!(seen.pressures.last(), Some(&pressures(&stepwise.view())));
            }
            if !more {
                break;
            }
        }
        assert_eq!(seen, whole, "{method}");
        assert!(stepwise.summary.run.completed);
        // It is over, and nothing more is told.
        assert!(!stepwise.advance(&mut [&mut seen]).unwrap());
        assert_eq!(seen.ended, 1);
    }
}

#[test]
fn an_interrupted_analysis_keeps_its_results_and_goes_on() {
    for method in ["sparse", "condensed"] {
        let mut whole = Diary::default();
        simulation(method).run(&mut [&mut whole]).unwrap();

        // Once in the middle of Newton's iteration.
        let asked = Arc::new(AtomicUsize::new(0));
        let counter = Arc::clone(&asked);
        let mut interrupted = simulation(method);
        interrupted.set_interrupt(Arc::new(move || {
            counter.fetch_add(1, Ordering::Relaxed) == 40
        }));
        let mut seen = Diary::default();
        let outcome = interrupted.run(&mut [&mut seen]);
        assert!(matches!(outcome, Err(Error::Interrupted(_))), "{method}");
        assert!(!seen.rows.is_empty() && seen.rows.len() < 22, "{method}");
        assert_eq!(seen.ended, 1);
        assert!(!interrupted.summary.run.completed);
        assert!(
            interrupted
                .summary
                .run
                .outcome
                .starts_with("interrupted at")
        );
        assert_eq!(interrupted.summary.attempts.cutbacks, 0);
        assert_eq!(seen.rows[..], whole.rows[..seen.rows.len()], "{method}");

        interrupted.run(&mut [&mut seen]).unwrap();
        assert!(interrupted.summary.run.completed);
        assert_eq!(seen.rows.len(), 22);
        let (a, b) = (&seen.states[21], &whole.states[21]);
        let size = b.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        assert!(a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-9 * size));
    }
}

/// Runs a problem that asks the program whether to stop, and tells it of iterations; by question how many iterations it had heard of by then. It is
/// stopped at one of the questions, if there is such.
fn asked(problem: &Problem, stop: Option<usize>) -> (Vec<usize>, Simulation, Result<(), Error>) {
    let (iterations, questions) = (Arc::new(AtomicUsize::new(0)), Arc::new(Mutex::new(vec![])));
    let mut simulation = support::build(problem).unwrap_or_else(|e| panic!("{e}"));
    let heard = Arc::clone(&iterations);
    simulation.set_watch(Arc::new(move |work: &Work| {
        if let Work::Iteration(_) = work {
            heard.fetch_add(1, Ordering::Relaxed);
        }
    }));
    let all = Arc::clone(&questions);
    simulation.set_interrupt(Arc::new(move || {
        let mut all = all.lock().expect("one thread");
        all.push(iterations.load(Ordering::Relaxed));
        stop == Some(all.len() - 1)
    }));
    let outcome = simulation.run(&mut []);
    let questions = questions.lock().expect("one thread").clone();
    (questions, simulation, outcome)
}

#[test]
fn a_search_by_forces_is_interrupted_between_two_columns_of_its_operator() {
    for method in [Solution::Condensed, Solution::Sparse] {
        let greco = include_str!("chatter/greco.toml").replace("[32, 32]", "[20, 20]");
        let mut problem = support::problem(&greco);
        problem.solver.method = method;
        // Too few for plain iteration.
        problem.solver.max_iterations = 3;
        let (questions, whole, outcome) = asked(&problem, None);
        outcome.unwrap_or_else(|e| panic!("{e}"));
        // Where nobody hears of an iteration columns are solved for: one for each of some dozens of forces.
        let streak = |from: usize| {
            let same = questions[from..].iter();
            same.take_while(|n| **n == questions[from]).count()
        };
        let begin = (0..questions.len()).max_by_key(|&k| (streak(k), usize::MAX - k));
        let begin = begin.expect("questions");
        assert!(streak(begin) > 20, "{method:?}: {}", streak(begin));
        // One an increment for each component of a point, however many friction problems it takes.
        let columns = whole.summary.cost.solver.columns;
        assert!(
            columns > 20 && columns <= 2 * 21 * whole.summary.attempts.fallbacks.len(),
            "{method:?}: {columns}"
        );

        let middle = begin + streak(begin) / 2;
        let (asked, mut stopped, outcome) = asked(&problem, Some(middle));
        assert!(matches!(outcome, Err(Error::Interrupted(_))), "{method:?}");
        // It is answered at once, and what is asked of no solution any more.
        assert!(asked.len() <= middle + 2, "{} {middle}", asked.len());
        assert_eq!(asked[..middle], questions[..middle]);
        assert!(stopped.summary.attempts.fallbacks.len() < whole.summary.attempts.fallbacks.len());
        assert_eq!(stopped.summary.attempts.cutbacks, 0);

        stopped.run(&mut []).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(stopped.frame.state.u, whole.frame.state.u, "{method:?}");
        assert_eq!(
            stopped.summary.attempts.fallbacks,
            whole.summary.attempts.fallbacks
        );
    }
}

#[test]
fn an_analysis_can_be_interrupted_between_increments() {
    let stop = Arc::new(AtomicBool::new(true));
    let flag = Arc::clone(&stop);
    let mut simulation = simulation("sparse");
    simulation.set_interrupt(Arc::new(move || flag.load(Ordering::Relaxed)));
    assert!(matches!(simulation.run(&mut []), Err(Error::Interrupted(t)) if t == 0.0));
    stop.store(false, Ordering::Relaxed);
    simulation.run(&mut []).unwrap();
    assert_eq!(simulation.frame.state.t, 2.0);
}

/// The laws of the case as functions, and how often they are asked about how many points.
#[derive(Default)]
struct Functions {
    calls: AtomicUsize,
    asked: AtomicUsize,
}

impl PressureFunction for Functions {
    fn pressures(&self, gaps: &[f64]) -> (Vec<f64>, Option<Vec<f64>>) {
        self.calls.fetch_add(1, Ordering::Relaxed);
        self.asked.fetch_add(gaps.len(), Ordering::Relaxed);
        let value = gaps.iter().map(|g| 2e12 * (-g).max(0.0)).collect();
        let slope = |g: &f64| if *g < 0.0 { -2e12 } else { 0.0 };
        (value, Some(gaps.iter().map(slope).collect()))
    }
}

impl LimitFunction for Functions {
    fn limits(&self, pressures: &[f64], _: &[f64]) -> (Vec<f64>, Option<[Vec<f64>; 2]>) {
        (pressures.iter().map(|p| 0.3 * p).collect(), None)
    }
}

#[test]
fn laws_of_the_program_do_what_the_same_laws_of_the_problem_do() {
    for method in ["sparse", "condensed"] {
        let mut wanted = Diary::default();
        let mut plain = simulation(method);
        plain.run(&mut [&mut wanted]).unwrap();

        let other = case(method)
            .replace("normal.linear = { c = 2e12 }", "")
            .replace("friction.coulomb = { mu = 0.3 }", "");
        let mut setup = support::problem(&other).build(Path::new("")).unwrap();
        let functions = Arc::new(Functions::default());
        let interface = &mut setup.contact.interfaces[0];
        interface.definition =
            with_user_laws(interface, Some(functions.clone()), Some(functions.clone()));
        let mut simulation = Simulation::new(setup).unwrap();
        let mut seen = Diary::default();
        simulation.run(&mut [&mut seen]).unwrap();

        for (a, b) in seen.states.iter().zip(&wanted.states) {
            let size = b.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
            assert!(a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-8 * size));
        }
        let (own, plain) = (&simulation.summary, &plain.summary);
        assert!(own.quality.met);
        for (a, b) in [
            (own.balance.energy.friction, plain.balance.energy.friction),
            (own.balance.energy.contact, plain.balance.energy.contact),
        ] {
            assert!((a / b - 1.0).abs() < 1e-6, "{a} {b}");
        }
        // One call an evaluation, not one a point.
        let points = simulation.contact.interfaces[0].points.len();
        let calls = functions.calls.load(Ordering::Relaxed);
        assert!(functions.asked.load(Ordering::Relaxed) >= points * calls);
        assert!(
            calls < 8 * (own.attempts.iterations + own.attempts.increments),
            "{calls}"
        );
    }
}

/// What is told of work and of results, in one order.
#[derive(Default, Clone)]
struct Heard(Arc<Mutex<Vec<String>>>);

impl Heard {
    fn hear(&self, what: String) {
        self.0.lock().expect("one thread").push(what);
    }
}

impl Observer for Heard {
    fn see(&mut self, _: &Analysis, event: Event) -> Result<(), Error> {
        match event {
            Event::Iteration(p) => self.hear(format!("told of {}", p.strategy.name())),
            Event::Increment(_) => self.hear("increment".into()),
            _ => {}
        }
        Ok(())
    }
}

#[test]
fn somebody_who_waits_hears_of_iterations_and_ways_while_they_go_on() {
    // Its side load is too much for one increment without other ways than plain iteration.
    let greco = support::problem(include_str!("chatter/greco.toml"));
    for method in ["condensed", "sparse"] {
        let mut problem = greco.clone();
        problem.solver.method = match method {
            "sparse" => Solution::Sparse,
            _ => Solution::Condensed,
        };
        let heard = Heard::default();
        let mut simulation = support::build(&problem).unwrap_or_else(|e| panic!("{e}"));
        let listener = heard.clone();
        simulation.set_watch(Arc::new(move |work: &Work| match work {
            Work::Iteration(p) => listener.hear(format!("at {}", p.strategy.name())),
            Work::Increment { attempt, .. } => listener.hear(format!("attempt {attempt}")),
            Work::Condensing => listener.hear("condensing".into()),
            Work::Recovering(_) => listener.hear("recovering".into()),
            Work::Waiting | Work::Following | Work::Modes => {}
        }));
        simulation.run(&mut [&mut heard.clone()]).unwrap();
        let heard = heard.0.lock().expect("one thread").clone();
        let count = |what: &str| heard.iter().filter(|h| h.starts_with(what)).count();
        // Each iteration is heard of twice: at once, and when the increment is reported.
        let first = heard
            .iter()
            .position(|h| h == "increment")
            .expect("a report");
        assert!(
            heard[..first].iter().any(|h| h == "at plain iteration"),
            "{method}"
        );
        assert!(
            count("at ") >= count("told of ") && count("told of ") > 0,
            "{method}"
        );
        let others = count("at ") - count("at plain iteration");
        assert_eq!(
            others > 0,
            simulation
                .summary
                .attempts
                .fallbacks
                .iter()
                .any(|f| f.tried.iterations > 0)
        );
        assert!(count("attempt ") >= count("increment"), "{method}");
        if method == "condensed" {
            let made = heard
                .iter()
                .position(|h| h == "condensing")
                .expect("condensed");
            let found = heard
                .iter()
                .position(|h| h == "recovering")
                .expect("recovered");
            assert!(made < found && found < first, "{method}");
        }
    }
}

//! A friction law with a state variable, the path that a point has slid, in every way to compute: implicit and explicit, condensed and sparse, both discretisations.

use std::path::Path;
use std::sync::Arc;

use crate::{restart, support};
use stickslip::Error;
use stickslip::contact::interface::with_friction_law;
use stickslip::contact::law::friction::{
    FrictionLaw, FrictionPoint, LawState, Limit, StateVariable,
};
use stickslip::contact::look;
use stickslip::model::Setup;
use stickslip::problem::Problem;
use stickslip::results::{Analysis, Event, Observer};
use stickslip::run::Simulation;

/// Slip weakening: the coefficient falls with the path `s` as `μ_d + (μ_s - μ_d) e^(-s/D)`, and heals with the time that a point is open.
struct SlipWeakening {
    first: f64,
    last: f64,
    over: f64,
    heals: f64,
}

const LAW: SlipWeakening = SlipWeakening {
    first: 0.4,
    last: 0.1,
    over: 0.02,
    heals: 0.5,
};

const PATH: [StateVariable; 1] = [StateVariable {
    name: "SLIDPATH",
    unit: "m",
}];

impl SlipWeakening {
    fn coefficient(&self, path: f64) -> f64 {
        self.last + (self.first - self.last) * (-path / self.over).exp()
    }
}

impl FrictionLaw for SlipWeakening {
    fn limit(&self, at: &FrictionPoint) -> Limit {
        let path = at.state[0] + at.speed * at.dt;
        let mu = self.coefficient(path);
        Limit {
            value: mu * at.pressure,
            d_pressure: mu,
            // The path at the end of the increment grows with the speed in it.
            d_speed: -at.pressure * (mu - self.last) / self.over * at.dt,
            state: [path, 0.0, 0.0, 0.0],
            ..Limit::default()
        }
    }

    fn states(&self) -> &'static [StateVariable] {
        &PATH
    }

    fn open_state(&self, state: &LawState, dt: f64) -> LawState {
        state.map(|path| path * (-dt / self.heals).exp())
    }

    fn faults(&self) -> Vec<(&'static str, String)> {
        Vec::new()
    }
}

/// A problem with the law in the place of that of its first interface.
pub fn setup(problem: &Problem) -> Setup {
    let mut setup = problem
        .build(Path::new("."))
        .unwrap_or_else(|e| panic!("{e}"));
    let interface = &mut setup.contact.interfaces[0];
    interface.definition = with_friction_law(interface, Arc::new(LAW));
    setup
}

fn run(problem: &Problem) -> Simulation {
    let mut simulation = Simulation::new(setup(problem)).unwrap_or_else(|e| panic!("{e}"));
    simulation.run(&mut []).unwrap_or_else(|e| panic!("{e}"));
    simulation
}

/// A block that is pressed on a base and dragged over it, as far as it slides everywhere.
fn dragged(method: &str, more: &str) -> String {
    let numbers = ["[9, 3]", "[4, 4]", "2e9", "0.03", "3"];
    support::dragged(method, numbers)
        + "\n[material.m]\nisotropic = { young = 2e7, poisson = 0.3, density = 1000 }\n"
        + more
}

const STEP: &str = "[[step]]\nduration = 3\nincrements.initial = 0.05\nincrements.largest = 0.05\n";

/// A column of the table of contact points.
fn column(simulation: &Simulation, name: &str) -> Vec<f64> {
    let u = &simulation.view().frame.state.u;
    let (names, columns) = look::table(support::contact(simulation), u);
    let k = names.iter().position(|n| n == name);
    columns[k.unwrap_or_else(|| panic!("no {name} in {names:?}"))].clone()
}

/// Points carry what the law says after the way that they have slid, which another road reports as CSLIP1; that may be
/// so much longer or shorter.
fn obeys(what: &str, simulation: &Simulation, tolerance: f64, way: [f64; 2]) {
    let [pressure, shear, slip, path, status] =
        ["CPRESS", "CSHEAR1", "CSLIP1", "SLIDPATH", "CSTATUS"].map(|name| column(simulation, name));
    let mut slid = 0;
    for i in (0..pressure.len()).filter(|&i| status[i] == 2.0) {
        slid += 1;
        let limit = LAW.coefficient(path[i]) * pressure[i];
        assert!(
            (shear[i].abs() - limit).abs() <= tolerance * limit,
            "{what}: {} {limit}",
            shear[i]
        );
        assert!(path[i] > LAW.over / 2.0, "{what}: {}", path[i]);
        let apart = path[i] - slip[i].abs();
        let [short, long] = way.map(|part| part * path[i]);
        assert!(
            apart >= -short && apart <= long,
            "{what}: {} {}",
            path[i],
            slip[i]
        );
    }
    assert!(slid >= 3, "{what}: {slid} points slide");
}

#[test]
fn shear_follows_the_state_in_every_way_to_compute() {
    for method in ["condensed", "sparse", "multigrid"] {
        for discretisation in ["mortar", "node-to-facet"] {
            let more = format!("[interface.press.discretisation.{discretisation}]\n{STEP}");
            let simulation = run(&support::problem(&dragged(method, &more)));
            obeys(
                &format!("{method} {discretisation}"),
                &simulation,
                1e-9,
                [1e-3; 2],
            );
        }
    }
    let motion = "[body.block.rayleigh]\nmass = 20\n[[step]]\nduration = 3\n";
    for scheme in [
        "generalised-alpha = { rho = 0.6 }",
        "central-difference = {}",
    ] {
        let more = format!("{motion}dynamic.scheme.{scheme}\n");
        let simulation = run(&support::problem(&dragged("sparse", &more)));
        // What vibrates goes a longer way than it gets on.
        obeys(scheme, &simulation, 1e-6, [0.05, 0.5]);
    }
}

/// The derivatives that the law gives are those of its increments, so Newton's method ends in a few iterations.
#[test]
fn the_tangent_is_consistent() {
    let simulation = run(&support::problem(&dragged("sparse", STEP)));
    let attempts = &simulation.summary.attempts;
    assert_eq!(attempts.cutbacks, 0);
    let mean = attempts.iterations as f64 / attempts.increments as f64;
    assert!(mean < 5.0, "{mean}");
}

#[test]
fn a_checkpoint_holds_the_state() {
    for method in ["condensed", "sparse"] {
        let problem = support::problem(&dragged(method, STEP));
        restart::check_setups(method, &|| setup(&problem), 3);
    }
}

/// Time and state variable of every point at the end of each increment in which no point touches.
#[derive(Default)]
struct Open(Vec<(f64, Vec<f64>)>);

impl Observer for Open {
    fn see(&mut self, analysis: &Analysis, event: Event) -> Result<(), Error> {
        let (Event::Increment(_), Some(contact)) = (event, analysis.contacts().next()) else {
            return Ok(());
        };
        let state = &analysis.frame.state;
        let (names, columns) = look::table(contact, &state.u);
        let column = |name: &str| names.iter().position(|n| n == name).map(|k| &columns[k]);
        if let (Some(path), Some(status)) = (column("SLIDPATH"), column("CSTATUS"))
            && status.iter().all(|s| *s == 0.0)
        {
            self.0.push((state.t, path.clone()));
        }
        Ok(())
    }
}

/// What a law does to the state of open points is done in every increment, and a law that changes between steps begins anew.
#[test]
fn states_of_open_points_and_of_laws_that_change() {
    let lifted = dragged("sparse", STEP).replace(
        "table = [[0, 0], [1, 1]]",
        "table = [[0, 0], [1, 1], [3, 1], [3.2, -1], [5, -1]]",
    ) + STEP.replace("duration = 3", "duration = 2").as_str();
    let mut open = Open::default();
    let mut simulation = Simulation::new(setup(&support::problem(&lifted))).expect("a problem");
    simulation
        .run(&mut [&mut open])
        .unwrap_or_else(|e| panic!("{e}"));
    assert!(open.0.len() > 10, "{}", open.0.len());
    let ((start, first), (end, last)) = (&open.0[0], &open.0[open.0.len() - 1]);
    let healed = (-(end - start) / LAW.heals).exp();
    for (a, b) in first.iter().zip(last) {
        assert!(
            *a > 1e-4 && (b / a / healed - 1.0).abs() < 1e-12,
            "{a} {b} {healed}"
        );
    }
    let changed = lifted + "change.press.friction.coulomb.mu = 0.3\n";
    let simulation = run(&support::problem(&changed));
    let u = &simulation.view().frame.state.u;
    let (names, _) = look::table(support::contact(&simulation), u);
    assert!(!names.contains(&"SLIDPATH".to_string()));
}
/// An interface that ends to act is open, though its points slid in the last increment in which it did.
#[test]
fn states_change_while_an_interface_does_not_act() {
    let text = dragged("sparse", STEP) + "[[step]]\ninterfaces = []\nincrements.fixed = 4\n";
    let before = run(&support::problem(&dragged("sparse", STEP)));
    let after = run(&support::problem(&text));
    let healed = (-1.0 / LAW.heals).exp();
    let paths = column(&before, "SLIDPATH");
    for (a, b) in paths.iter().zip(column(&after, "SLIDPATH")) {
        assert!(*a > 1e-4 && (b / a / healed - 1.0).abs() < 1e-12, "{a} {b}");
    }
}

#[test]
fn modes_of_sliding_refuse_a_law_with_states() {
    let text = dragged("sparse", STEP) + "[[step]]\ncomplex-modes = { count = 2 }\n";
    let mut simulation = Simulation::new(setup(&support::problem(&text))).expect("a sound problem");
    let error = simulation.run(&mut []).expect_err("a refusal").to_string();
    assert!(
        error.contains("keeps a state") && error.contains("press"),
        "{error}"
    );
}

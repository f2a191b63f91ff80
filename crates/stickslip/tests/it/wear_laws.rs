//! Wear laws against closed forms on a block whose pressure is uniform, and wear in motion.

use crate::support;
use stickslip::contact::look;
use stickslip::run::Simulation;

const PRESSURE: f64 = 40.0;
const PATH: f64 = 0.5;
const MU: f64 = 0.25;

fn run(text: &str) -> Simulation {
    let mut simulation = support::build(&support::problem(text)).unwrap_or_else(|e| panic!("{e}"));
    simulation.run(&mut []).unwrap_or_else(|e| panic!("{e}"));
    simulation
}

fn close(found: f64, expected: f64, tolerance: f64, what: &str) {
    assert!(
        (found / expected - 1.0).abs() < tolerance,
        "{what}: {found} for {expected}"
    );
}

/// Friction where a law asks for its energy: a point sticks at first by a spring, which takes a part of the way below [`STUCK`]. Other laws are tried without.
fn friction(law: &str) -> String {
    match law.contains("energy") {
        true => format!("friction.coulomb = {{ mu = {MU} }}"),
        false => String::new(),
    }
}

const STUCK: f64 = 5e-6;

fn tolerance(law: &str) -> f64 {
    if law.contains("energy") { STUCK } else { 1e-8 }
}

/// A block held across and pressed by a load on a rigid flat, which slides by `PATH` beneath it in one unit of time.
fn pressed(wear: &str, increments: usize) -> Simulation {
    run(&format!(
        r#"format = 1
model.space = "plane-strain"
body.block = {{ generate.rectangle = {{ to = [1, 1], cells = [3, 2] }}, material = "m" }}
material.m.isotropic = {{ young = 1e4, poisson = 0.0 }}
obstacle.flat = {{ plane = {{ point = [0, 0], normal = [0, 1] }}, motion.translation = [[0, 0, 0], [1, 0, 0], [2, {PATH}, 0]] }}
support.hold = {{ set = "block", x = 0.0 }}
load.press = {{ set = "block.top", pressure.value = {PRESSURE} }}
step = [{{ name = "press", increments.fixed = 1 }}, {{ name = "slide", increments.fixed = {increments} }}]
[interface.joint]
secondary = "block.bottom"
primary = "flat"
enforcement.augmented-lagrangian = {{ error = 1e-10 }}
{friction}
{wear}
"#,
        friction = friction(wear)
    ))
}

/// Each law as a user writes it, and the depth that it has after `PATH` under `PRESSURE`.
fn laws() -> [(&'static str, f64); 10] {
    let (p, s) = (PRESSURE, PATH);
    // Thresholds of path and energy that are met on the way.
    let late = s - 0.2;
    [
        ("archard = { coefficient = 1e-6 }", 1e-6 * p * s),
        (
            "archard-hardness = { coefficient = 1e-3, hardness = 500 }",
            2e-6 * p * s,
        ),
        (
            "archard-threshold = { coefficient = 1e-6, pressure = 15 }",
            1e-6 * (p - 15.0) * s,
        ),
        (
            "archard-threshold = { coefficient = 1e-6, path = 0.2 }",
            1e-6 * p * late,
        ),
        (
            "archard-threshold = { coefficient = 1e-6, energy = 2 }",
            1e-6 * p * late,
        ),
        (
            "archard-threshold = { coefficient = 1e-6, energy = 2, path = 0.3, pressure = 15 }",
            1e-6 * (p - 15.0) * (s - 0.3),
        ),
        (
            "tabular = { pressures = [0, 100], coefficient = [[1e-6, 3e-6]] }",
            1.8e-6 * p * s,
        ),
        (
            "tabular = { speeds = [0, 1], coefficient = [[1e-6, 3e-6]] }",
            2e-6 * p * s,
        ),
        (
            "dissipated-energy = { coefficient = 1e-6, energy = 2 }",
            1e-6 * MU * p * late,
        ),
        (
            "archard = { coefficient = 1e-6, running-in = 2, running-in-path = 0.3 }",
            1e-6 * p * (s + 2.0 * 0.3 * (1.0 - (-s / 0.3_f64).exp())),
        ),
    ]
}

#[test]
fn every_law_takes_off_the_depth_of_its_formula() {
    for (law, depth) in laws() {
        for more in [
            "",
            "wear-feedback = \"explicit\"",
            "wear-feedback = \"none\"",
        ] {
            let simulation = pressed(&format!("wear.{law}\n{more}"), 3);
            let found = simulation.summary.last["joint.CWEARMAX"];
            close(found, depth, tolerance(law), &format!("{law} {more}"));
            assert!(simulation.summary.quality.met, "{law} {more}");
        }
    }
}

#[test]
fn thresholds_count_the_cycles_that_one_stands_for() {
    // A path of 0.4 a cycle, ten of them.
    for (jump, law, expected) in [
        (
            1,
            "archard-threshold = { coefficient = 1e-6, path = 0.9 }",
            3.1,
        ),
        (
            5,
            "archard-threshold = { coefficient = 1e-6, path = 0.9 }",
            3.1,
        ),
        (
            5,
            "archard-threshold = { coefficient = 1e-6, energy = 9 }",
            3.1,
        ),
        (
            5,
            "archard = { coefficient = 1e-6, running-in = 2, running-in-path = 0.5 }",
            5.0 - (-8.0_f64).exp(),
        ),
    ] {
        let text = format!(
            r#"format = 1
model.space = "plane-strain"
body.block = {{ generate.rectangle = {{ to = [1, 1], cells = [3, 2] }}, material = "m" }}
material.m.isotropic = {{ young = 1e4, poisson = 0.0 }}
obstacle.flat = {{ plane = {{ point = [0, 0], normal = [0, 1] }} }}
support.hold = {{ set = "block", x = 0.1, amplitude = "triangle" }}
amplitude.triangle.table = [[1, 0], [1.25, 1], [1.75, -1], [2, 0]]
load.press = {{ set = "block.top", pressure.value = {PRESSURE} }}
step = [{{ name = "press", increments.fixed = 1 }}, {{ name = "fret", cycles = {{ count = 10, jump = {jump} }}, increments.fixed = 4 }}]
[interface.joint]
secondary = "block.bottom"
primary = "flat"
enforcement.augmented-lagrangian = {{ error = 1e-10 }}
{friction}
wear.{law}
"#,
            friction = friction(law)
        );
        let found = run(&text).summary.last["joint.CWEARMAX"];
        close(
            found,
            1e-6 * PRESSURE * expected,
            // It sticks anew at every turn, four times in what is computed.
            4.0 * tolerance(law),
            &format!("{law} {jump}"),
        );
    }
}

/// Stiffness of a bed on which a stiff punch is held at a constant approach, its first pressure, and the path.
const BED: f64 = 1e-6;
const FIRST: f64 = 1e-9;

/// Pressure of a punch on a bed of springs, at the end of each increment, and iterations in all. `more`: law and enforcement.
fn relaxing(more: &str, increments: usize) -> (Vec<f64>, usize) {
    let down = FIRST / BED;
    let text = format!(
        r#"format = 1
model.space = "plane-strain"
body.punch = {{ generate.rectangle = {{ to = [1, 1], cells = [2, 2] }}, material = "m" }}
material.m.isotropic = {{ young = 1.0, poisson = 0.0 }}
support.hold = {{ set = "punch.top", x = 0.0, y = 0.0 }}
support.sides = {{ set = "punch", x = 0.0 }}
obstacle.flat = {{ plane = {{ point = [0, 0], normal = [0, 1] }}, motion.translation = [[0, 0, 0], [1, 0, {down}], [2, 1, {down}]] }}
step = [{{ name = "press", increments.fixed = 1 }}, {{ name = "slide", increments.fixed = {increments} }}]
[interface.joint]
secondary = "punch.bottom"
primary = "flat"
normal.linear = {{ c = {BED} }}
{more}
"#
    );
    let record = support::run(&support::problem(&text)).unwrap_or_else(|e| panic!("{e}"));
    let rows = record.increments.iter().map(|(_, row)| row);
    let pressures = rows
        .clone()
        .map(|r| r.get("joint.CPRESSMAX").expect("a column"));
    let iterations = rows.skip(1).map(|r| r.get("ITRS").expect("a column"));
    (pressures.collect(), iterations.sum::<f64>() as usize)
}

/// A punch held at its approach loses pressure as it wears: `dp/ds = -K k (p - p₀)` with a threshold, which the backward Euler rule solves by powers; with a rate that rises by a line,
/// `dp/ds = -K k p (1 + p/P)`, by a quadratic equation an increment, and in the limit `p = 1 / ((1/p₁ + 1/P) e^{K k s} - 1/P)`.
#[test]
fn a_law_that_depends_on_the_pressure_is_solved_for_together_with_it() {
    let k = 1.0 / BED;
    for enforcement in ["", "enforcement.penalty = {}"] {
        let limit = 0.4 * FIRST;
        let threshold = format!(
            "wear.archard-threshold = {{ coefficient = {k:?}, pressure = {limit:?} }}\n{enforcement}"
        );
        let (found, iterations) = relaxing(&threshold, 5);
        let factor = 1.0 / (1.0 + BED * k / 5.0);
        for (n, p) in found.iter().enumerate() {
            let expected = limit + (FIRST - limit) * factor.powi(n as i32);
            close(*p, expected, 1e-5, &threshold);
        }
        // What one iteration predicts is what the next finds.
        assert!(iterations <= 3 * 5, "{iterations}");

        let top = 2.0 * FIRST;
        let table = format!(
            "wear.tabular = {{ pressures = [0, {top:?}], coefficient = [[{k:?}, {:?}]] }}\n{enforcement}",
            3.0 * k
        );
        // k (1 + p / P)
        let scale = top / 2.0;
        let mut off = Vec::new();
        for increments in [10, 20] {
            let (found, iterations) = relaxing(&table, increments);
            let a = BED * k / increments as f64;
            let mut expected = FIRST;
            for p in &found {
                close(*p, expected, 1e-5, &table);
                // a/P p² + (1 + a) p = the pressure before
                let b = 1.0 + a;
                let root = (b * b + 4.0 * a / scale * expected).sqrt();
                expected = 2.0 * expected / (b + root);
            }
            assert!(iterations <= 3 * increments, "{iterations}");
            let exact = 1.0 / ((1.0 / FIRST + 1.0 / scale) * (BED * k).exp() - 1.0 / scale);
            off.push(found[increments] / exact - 1.0);
        }
        let ratio = off[0] / off[1];
        assert!((1.8..2.2).contains(&ratio), "{off:?}");
    }
}

/// A slider that is driven over a rail in one unit of time, under a constant pressure.
fn driven(dynamic: &str, feedback: &str) -> Simulation {
    run(&format!(
        r#"format = 1
model.space = "plane-strain"
body.rail = {{ generate.rectangle = {{ to = [3, 0.5], cells = [24, 2] }}, material = "soft" }}
body.slider = {{ generate.rectangle = {{ from = [0.5, 0.5], to = [1.5, 1], cells = [7, 2] }}, material = "soft" }}
material.soft.isotropic = {{ young = 1e4, poisson = 0.2, density = 0.1 }}
support.rail = {{ set = "rail.bottom", x = 0.0, y = 0.0 }}
support.slider = {{ set = "slider.top", x = 1.0, amplitude = "way" }}
amplitude.way.table = [[0, 0], [1, 0], [1.1, 0.01], [1.2, 0.04], [1.3, 0.09], [1.4, 0.16], [2, 0.64]]
load.press = {{ set = "slider.top", pressure.value = 40 }}
step = [{{ name = "press", increments.fixed = 2 }}, {{ name = "slide"{dynamic} }}]
quality.gate = "off"
[interface.joint]
secondary = "slider.bottom"
primary = "rail.top"
roles = "as-named"
friction.coulomb = {{ mu = 0.1 }}
wear.archard = {{ coefficient = 2e-6, primary-coefficient = 1e-6 }}
{feedback}
"#
    ))
}

#[test]
fn both_surfaces_wear_in_motion_as_they_do_at_rest() {
    let volume = |s: &Simulation| s.summary.last["joint.CWEARVOL"];
    let at_rest = volume(&driven(", increments.fixed = 20", ""));
    close(at_rest, 3e-6 * 40.0 * 0.64, 0.01, "at rest");
    // An explicit step is not damped: slider and rail go on swinging from the moment in which springs take over, and the mean force is not the load.
    for (dynamic, tolerance) in [
        (", increments.fixed = 40, dynamic = {}", 0.01),
        (
            ", increments.fixed = 40, dynamic = { scheme.newmark = {} }",
            0.01,
        ),
        (", dynamic = { scheme.central-difference = {} }", 0.05),
    ] {
        for feedback in ["", "wear-feedback = \"explicit\""] {
            let what = format!("{dynamic} {feedback}");
            let simulation = driven(dynamic, feedback);
            let interface = support::contact(&simulation);
            let lost = look::wear(interface).expect("is followed").volume;
            for (lost, worn_volume) in lost.iter().zip(look::worn_volume(interface)) {
                close(worn_volume, *lost, 1e-12, &what);
            }
            close(lost[0] / lost[1], 2.0, 1e-12, &what);
            close(volume(&simulation), at_rest, tolerance, &what);
            // Whatever the force is, friction takes its part of what wears.
            let rubbed = simulation.summary.last["joint.ALLFD"] / 0.1;
            close(volume(&simulation), 3e-6 * rubbed, 2e-3, &what);
            let energy = &simulation.summary.balance.energy_quality;
            assert!(energy.residual < 0.02, "{what}: {energy:?}");
        }
    }
}

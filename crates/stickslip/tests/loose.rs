//! Bodies that only contact can hold: forces close the gaps, whatever their size, and what helped on the way is gone at the end.

mod support;

use std::path::Path;

use stickslip::problem::Problem;
use stickslip::simulation::{Simulation, Summary};
use support::Record;

/// Gaps `[m]`.
const GAPS: [f64; 6] = [0.0, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2];

/// Residual of the energy ledger over the energy in play. The rule by which work is summed up is exact where forces and motions are
/// proportional; what contact does before it touches is entered as artificial.
const LEDGER: f64 = 3e-6;

const FRICTION: [&str; 2] = ["none = {}", "coulomb = { mu = 0.2 }"];

/// Units of length and stress, as multiples of the metre and the pascal.
type Units = (f64, f64);
const SI: Units = (1.0, 1.0);
const MILLIMETRES: Units = (1e3, 1e-6);

/// What came of a run.
struct Outcome {
    record: Record,
    summary: Summary,
}

impl Outcome {
    fn last(&self, column: &str) -> f64 {
        self.summary.last[column]
    }

    /// Iterations of each increment.
    fn iterations(&self) -> Vec<usize> {
        self.record.increments.iter().map(|i| i.0.len()).collect()
    }

    /// Converged, without anything artificial left, and in balance with the load.
    fn is_sound(&self, what: &str, (columns, load): (&[&str], f64)) {
        let s = &self.summary;
        assert!(s.completed, "{what}");
        assert!(
            s.artificial_energy < 1e-10,
            "{what}: {:e}",
            s.artificial_energy
        );
        assert!(s.energy.strain > 0.0, "{what}");
        let left = s.energy_quality.residual;
        assert!(left < LEDGER, "{what}: {left:e} of the energy is missing");
        let carried: f64 = columns.iter().map(|c| self.last(c)).sum();
        let error = (carried / load - 1.0).abs();
        assert!(error < 1e-6, "{what}: {carried:e} instead of {load:e}");
    }
}

fn simulation(text: &str) -> Simulation {
    let problem: Problem = support::problem(text);
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/closing-gaps");
    let model = problem.build(&folder).unwrap_or_else(|e| panic!("{e}"));
    Simulation::new(model).unwrap_or_else(|e| panic!("{e}"))
}

fn run(what: &str, text: &str) -> Outcome {
    let mut record = Record::default();
    let mut simulation = simulation(text);
    let outcome = simulation.run(&mut [&mut record]);
    outcome.unwrap_or_else(|e| panic!("{what}: {e}"));
    Outcome {
        record,
        summary: simulation.summary,
    }
}

/// A block above another; nothing but contact holds it.
fn plane_blocks(gap: f64, friction: &str, (length, stress): Units) -> String {
    let l = |x: f64| x * length;
    format!(
        r#"
format = 1
model = {{ space = "plane-strain", thickness = {t:?} }}
body.lower = {{ generate.rectangle = {{ to = [{w:?}, {h:?}], cells = [10, 4] }}, material = "steel" }}
body.upper = {{ generate.rectangle = {{ from = [{a:?}, {h:?}], to = [{b:?}, {top:?}], cells = [7, 5] }}, translate = [0, {gap:?}], material = "steel" }}
material.steel.isotropic = {{ young = {young:?}, poisson = 0.3 }}
support.base = {{ set = "lower.bottom", x = 0, y = 0 }}
load.press = {{ set = "upper.top", pressure = {{ value = {p:?} }} }}
interface.joint = {{ secondary = "upper.bottom", primary = "lower.top", friction.{friction} }}
step = [{{ increments.fixed = 2 }}]
"#,
        t = l(1.0),
        w = l(0.05),
        h = l(0.02),
        a = l(0.01),
        b = l(0.04),
        top = l(0.04),
        gap = l(gap),
        young = 210e9 * stress,
        p = 50e6 * stress,
    )
}

fn solid_blocks(gap: f64, friction: &str) -> String {
    format!(
        r#"
format = 1
model.space = "solid"
body.lower = {{ generate.box = {{ to = [0.03, 0.03, 0.01], cells = [5, 5, 2] }}, material = "steel" }}
body.upper = {{ generate.box = {{ from = [0.005, 0.005, 0.01], to = [0.025, 0.025, 0.02], cells = [4, 4, 2] }}, translate = [0, 0, {gap:?}], material = "steel" }}
material.steel.isotropic = {{ young = 210e9, poisson = 0.3 }}
support.base = {{ set = "lower.bottom", x = 0, y = 0, z = 0 }}
load.press = {{ set = "upper.top", pressure = {{ value = 50e6 }} }}
interface.joint = {{ secondary = "upper.bottom", primary = "lower.top", friction.{friction} }}
step = [{{ increments.fixed = 1 }}]
"#
    )
}

/// A pin in a hole 1 mm larger in radius, so far above the bottom of the hole.
fn pin(gap: f64, friction: &str) -> String {
    format!(
        r#"
format = 1
model.space = "plane-strain"
body.block = {{ gmsh.file = "hole.msh", scale = 1e-3, material = "steel" }}
body.pin = {{ generate.disc = {{ radius = 0.01, size = 1e-3 }}, translate = [0, {shift:?}], material = "steel" }}
material.steel.isotropic = {{ young = 210e9, poisson = 0.3 }}
interface.seat = {{ secondary = "pin.arc", primary = "block.hole", friction.{friction} }}
support.base = {{ set = "block.bottom", x = 0, y = 0 }}
load.push = {{ set = "pin", body-force = {{ value = [0, -3e9] }} }}
step = [{{ increments.fixed = 1 }}]
"#,
        shift = gap - 1e-3,
    )
}

/// A ball of 10 mm radius so far above three half-balls, of which each holds it at one place.
fn balls(gap: f64, friction: &str) -> String {
    let (radius, apart) = (0.01, 0.0115_f64);
    let height = ((2.0 * radius) * (2.0 * radius) - apart * apart).sqrt();
    let mut text = format!(
        r#"
format = 1
model.space = "solid"
body.top = {{ generate.ball = {{ centre = [0, 0, {height:?}], radius = {radius:?}, size = 0.004 }}, translate = [0, 0, {gap:?}], material = "steel" }}
material.steel.isotropic = {{ young = 210e9, poisson = 0.3 }}
load.weight = {{ set = "top", body-force = {{ value = [0, 0, -2.4e8] }} }}
step = [{{ increments.fixed = 1 }}]
"#
    );
    for (name, angle) in [("a", 0.0), ("b", 120.0), ("c", 240.0_f64)] {
        let (sin, cos) = angle.to_radians().sin_cos();
        let (x, y) = (apart * cos, apart * sin);
        text += &format!(
            r#"
body.{name} = {{ generate.half-ball = {{ centre = [{x:?}, {y:?}, 0], radius = {radius:?}, size = 0.004, direction = [{dx:?}, {dy:?}, {height:?}] }}, material = "steel" }}
support.{name} = {{ set = "{name}.flat", x = 0, y = 0, z = 0 }}
set.near-{name} = {{ of = "top.arc", ball = {{ centre = [{mx:?}, {my:?}, {mz:?}], radius = 0.006 }} }}
interface.on-{name} = {{ secondary = "near-{name}", primary = "{name}.arc", friction.{friction} }}
"#,
            dx = -x,
            dy = -y,
            mx = 0.5 * x,
            my = 0.5 * y,
            mz = 0.5 * height + gap,
        );
    }
    text
}

#[test]
fn blocks_in_the_plane_are_pressed_together() {
    for gap in GAPS {
        for friction in FRICTION {
            let what = format!("gap {gap:e}, {friction}");
            let outcome = run(&what, &plane_blocks(gap, friction, SI));
            outcome.is_sound(&what, (&["joint.CFN2", "joint.CFS2"], 1.5e6));
        }
    }
}

#[test]
fn millimetres_make_no_difference() {
    for gap in [1e-5, 1e-3] {
        for friction in FRICTION {
            let of = |units| run("blocks", &plane_blocks(gap, friction, units)).iterations();
            let (metres, millimetres) = (of(SI), of(MILLIMETRES));
            assert_eq!(metres.len(), millimetres.len(), "gap {gap:e}, {friction}");
            // Coordinates are rounded in another way: a residual next to the tolerance may need one iteration more.
            let near = |(a, b): (&usize, &usize)| a.abs_diff(*b) <= 1;
            assert!(
                metres.iter().zip(&millimetres).all(near),
                "gap {gap:e}, {friction}: {metres:?} {millimetres:?}"
            );
        }
    }
}

#[test]
fn blocks_in_space_are_pressed_together() {
    for gap in GAPS {
        for friction in FRICTION {
            let what = format!("gap {gap:e}, {friction}");
            let outcome = run(&what, &solid_blocks(gap, friction));
            outcome.is_sound(&what, (&["joint.CFN3", "joint.CFS3"], 2e4));
        }
    }
}

#[test]
fn the_sparse_matrix_finds_the_same() {
    let text = plane_blocks(1e-3, FRICTION[1], SI);
    let other = format!("{text}\nsolver.method = \"sparse\"");
    let [a, b] = [text, other].map(|t| run("blocks", &t));
    let [p, q] = [&a, &b].map(|o| o.last("joint.CPRESSMAX"));
    assert!((p / q - 1.0).abs() < 1e-6, "{p:e} {q:e}");
}

#[test]
fn a_pin_falls_into_its_seat() {
    for gap in [0.0, 1e-6, 1e-5, 1e-4, 1e-3, 2e-3] {
        for friction in FRICTION {
            let what = format!("gap {gap:e}, {friction}");
            let outcome = run(&what, &pin(gap, friction));
            // the section of the pin is a polygon
            let load = outcome.last("seat.CFN2") + outcome.last("seat.CFS2");
            outcome.is_sound(&what, (&["seat.CFN2", "seat.CFS2"], load));
            assert!((load / (3e9 * 3.14159e-4) - 1.0).abs() < 1e-2, "{load:e}");
        }
    }
}

#[test]
fn a_ball_falls_onto_three() {
    // without friction the ball has to find out how it comes to rest, which takes long
    for (friction, every) in FRICTION.into_iter().zip([3, 1]) {
        let mut first = None;
        for gap in GAPS.into_iter().step_by(every) {
            let what = format!("gap {gap:e}, {friction}");
            let outcome = run(&what, &balls(gap, friction));
            let reaction: f64 = ["a.RF3", "b.RF3", "c.RF3"]
                .map(|r| outcome.last(r))
                .iter()
                .sum();
            let contact = [
                "on-a.CFN3",
                "on-a.CFS3",
                "on-b.CFN3",
                "on-b.CFS3",
                "on-c.CFN3",
                "on-c.CFS3",
            ];
            outcome.is_sound(&what, (&contact, reaction));
            // the ball is a polyhedron, the same for every gap
            let ball = 2.4e8 * 4.0 / 3.0 * std::f64::consts::PI * 1e-6;
            assert!(
                (0.9..1.0).contains(&(reaction / ball)),
                "{what}: {reaction:e}"
            );
            let load = *first.get_or_insert(reaction);
            assert!((reaction / load - 1.0).abs() < 1e-6, "{what}: {reaction:e}");
        }
    }
}

/// A load along a motion that contact does not resist has no equilibrium.
#[test]
fn a_body_that_slides_off_is_not_followed_for_ever() {
    let text = plane_blocks(1e-5, FRICTION[0], SI);
    let pushed = format!(
        "{text}\nload.side = {{ set = \"upper.left\", traction = {{ value = [1e6, 0] }} }}"
    );
    let message = support::complaint(&pushed);
    assert!(message.contains("body upper"), "{message}");
    assert!(message.contains("translation x"), "{message}");
}

/// Nothing lies in the way of the load.
#[test]
fn a_body_that_is_pulled_away_is_not_followed() {
    let text =
        plane_blocks(1e-5, FRICTION[0], SI).replace("value = 50000000.0", "value = -50000000.0");
    let message = support::complaint(&text);
    assert!(
        message.contains("free to move as a rigid body"),
        "{message}"
    );
}

#[test]
fn following_can_be_switched_off() {
    let text = plane_blocks(1e-5, FRICTION[0], SI) + "\nsolver.follow-loose-bodies = false";
    let message = support::complaint(&text);
    assert!(
        message.contains("free to move as a rigid body"),
        "{message}"
    );
}

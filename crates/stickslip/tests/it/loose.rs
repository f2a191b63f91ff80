//! Bodies that only contact can hold: forces close the gaps, whatever their size, and what helped on the way is gone at the end.

use crate::support;
use std::path::Path;

use stickslip::Error;
use stickslip::assess::doctor::DoctorCause;
use stickslip::problem::Problem;
use stickslip::results::Summary;
use stickslip::run::Simulation;
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
        assert!(s.run.completed, "{what}");
        assert!(
            s.loose.artificial_energy < 1e-10,
            "{what}: {:e}",
            s.loose.artificial_energy
        );
        assert!(s.balance.energy.strain > 0.0, "{what}");
        let left = s.balance.energy_quality.residual;
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
    attempt(text).unwrap_or_else(|e| panic!("{what}: {e}"))
}

fn attempt(text: &str) -> Result<Outcome, Error> {
    let mut record = Record::default();
    let mut simulation = simulation(text);
    simulation.run(&mut [&mut record])?;
    Ok(Outcome {
        record,
        summary: simulation.run.summary,
    })
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
    // Without friction the ball is a polyhedron that has to find out how it comes to rest among edges and corners, which takes long. Whether it
    // does is decided by rounding, so that several moduli are tried which differ by a few roundings: most of them have to end well.
    for (friction, every, moduli) in [(FRICTION[0], 3, 4), (FRICTION[1], 1, 1)] {
        let mut first = None;
        let (mut runs, mut rests) = (0, 0);
        let gaps = GAPS.into_iter().step_by(every);
        for (gap, k) in gaps.flat_map(|gap| (0..moduli).map(move |k| (gap, k))) {
            let what = format!("gap {gap:e}, {friction}, modulus {k}");
            let young = format!("young = {:?}", 210e9 * (1.0 + 3e-15 * f64::from(k)));
            let text = balls(gap, friction).replace("young = 210e9", &young);
            runs += 1;
            let outcome = match attempt(&text) {
                Ok(outcome) => outcome,
                Err(e) if moduli > 1 => {
                    let message = e.to_string();
                    let said = ["body top is free to move", "no equilibrium in"];
                    assert!(said.iter().any(|s| message.contains(s)), "{message}");
                    continue;
                }
                Err(e) => panic!("{what}: {e}"),
            };
            rests += 1;
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
        assert!(
            2 * rests > runs,
            "{friction}: {rests} of {runs} come to rest"
        );
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

/// A loose block 25 µm from both neighbours, the upper of which is pressed down by more than both gaps. The law presses hard where the gap
/// has gone, so that one large increment can throw the block.
const SANDWICH: &str = r#"format = 1
model.space = "plane-strain"
body.lower = { generate.rectangle = { to = [0.0106, 0.00507], cells = [6, 3], element = "tri6" }, material = "a" }
body.mid = { generate.rectangle = { from = [0.001, 0.005095], to = [0.0098, 0.00967], cells = [3, 2], element = "tri6" }, material = "b" }
body.upper = { generate.rectangle = { from = [0.0012, 0.009695], to = [0.0096, 0.0139], cells = [8, 4], element = "tri6" }, material = "a" }
material.a.isotropic = { young = 170e9, poisson = 0.33 }
material.b.isotropic = { young = 1268e9, poisson = 0.01 }
interface.j1 = { secondary = "mid.bottom", primary = "lower.top" }
interface.j2 = { secondary = "upper.bottom", primary = "mid.top", normal.exponential = { p0 = 44e6, c0 = 1.8e-7 }, friction.coulomb = { mu = 0.7 }, slip.regularised = { epsilon = 8e-7 }, enforcement.penalty = {}, discretisation.node-to-facet = {} }
support.base = { set = "lower.bottom", x = 0, y = 0 }
support.top = { set = "upper.top", x = 0, y = -5.7e-5 }
step = [{ name = "press" }]
"#;

#[test]
fn a_body_between_others_is_never_thrown_out_of_the_model() {
    let mut simulation = simulation(SANDWICH);
    let outcome = simulation.run(&mut []);
    let u = &simulation.frame.state.u;
    let farthest = u.iter().fold(0.0_f64, |m, u| m.max(u.abs()));
    match outcome {
        // The gaps are closed, and both interfaces carry the same.
        Ok(()) => {
            let last = &simulation.summary.last;
            // The one without friction, the other with it on a surface that is not quite level.
            let [lower, upper] = [
                last["j1.CFN2"].abs(),
                (last["j2.CFN2"] + last["j2.CFS2"]).abs(),
            ];
            assert!(
                lower > 0.0 && (lower / upper - 1.0).abs() < 1e-6,
                "{lower} {upper}"
            );
            assert!(farthest < 1e-4, "{farthest:e}");
        }
        // Or the run ends, and the body is still there.
        Err(_) => {
            assert!(farthest < 1e-2, "{farthest:e}");
        }
    }
}

/// The pin of the example `lug`, 45 µm loose in its hole, pushed upwards and let go again. Nothing else holds it.
fn loose_pin(mu: f64, increments: &str) -> Outcome {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/lug");
    let text = std::fs::read_to_string(folder.join("case.toml")).expect("the example");
    let (text, _) = text.split_once("[amplitude.pull]").expect("its amplitude");
    let [whole, friction] = ["scale = 1e-3\nmaterial = \"steel\"", "mu = 0.2"];
    assert!(text.contains(whole) && text.contains(friction));
    let text = text.replace(whole, "scale = 0.995e-3\nmaterial = \"steel\"");
    let text = text.replace(friction, &format!("mu = {mu}"));
    let steps = format!(
        r#"
amplitude.pull = {{ table = [[0, 0], [1, 1], [2, 0]] }}
probe.top = {{ of = "pin", point = [0, 0.009954975] }}
probe.side = {{ of = "pin", point = [0.009954975, 0] }}
step = [{{ name = "pull", {increments} }}, {{ name = "release", {increments} }}]
"#
    );
    let text = format!("{steps}\n{text}");
    let problem: Problem = support::problem(&text.replacen("format = 1\n", "", 1).replacen(
        '\n',
        "\nformat = 1\n",
        1,
    ));
    let model = problem.build(&folder).unwrap_or_else(|e| panic!("{e}"));
    let mut simulation = Simulation::new(model).unwrap_or_else(|e| panic!("{e}"));
    let mut record = Record::default();
    let outcome = simulation.run(&mut [&mut record]);
    outcome.unwrap_or_else(|e| panic!("mu {mu}, {increments}: {e}"));
    Outcome {
        record,
        summary: simulation.run.summary,
    }
}

#[test]
fn a_pin_that_is_let_go_stays_where_it_was() {
    for (mu, increments) in [
        (0.1, "increments.fixed = 5"),
        (0.3, "increments.fixed = 10"),
        (0.3, "increments = {}"),
    ] {
        let outcome = loose_pin(mu, increments);
        let what = format!("mu {mu}, {increments}");
        let summary = &outcome.summary;
        assert!(
            summary.run.completed && summary.attempts.cutbacks == 0,
            "{what}"
        );
        let said = summary
            .notes
            .iter()
            .any(|n| n.contains("body pin lost all contact"));
        assert!(said, "{what}: {:?}", summary.notes);
        // It has come up by the clearance, less what the hole gave way, and is stress-free there: its points have moved as one.
        let [top, side] = ["top.U2", "side.U2"].map(|name| outcome.last(name));
        assert!((4.4e-5..4.8e-5).contains(&top), "{what}: {top:e}");
        let turned = (top - side).hypot(outcome.last("top.U1") - outcome.last("side.U1")) / 0.01;
        assert!(turned < 1e-3, "{what}: {turned:e}");
        for force in ["fit.CFN1", "fit.CFN2", "fit.CFS1", "fit.CFS2"] {
            // Of 20 kN.
            assert!(
                outcome.last(force).abs() < 1e-2,
                "{what}: {:e}",
                outcome.last(force)
            );
        }
    }
}

/// A plate between a block and a cap, pressed by the cap, which slides, is unloaded and let go. The plate has no load of its own and no point in contact is left.
#[test]
fn a_stack_that_is_unloaded_and_let_go_stays_where_it_was() {
    for law in [
        "",
        "normal.linear = { c = 2e2 }, slip.regularised = { epsilon = 10 }, ",
    ] {
        let outcome = run(
            "a stack that is let go",
            &format!(
                r#"format = 1
model.space = "plane-stress"
material.m.isotropic = {{ young = 3e3, poisson = 0.25 }}
body.base = {{ generate.rectangle = {{ from = [-2, -2], to = [2, 0], cells = [5, 3] }}, material = "m" }}
body.plate = {{ generate.rectangle = {{ from = [-2, 0], to = [2, 2], cells = [7, 2] }}, material = "m" }}
body.cap = {{ generate.rectangle = {{ from = [-2.2, 2], to = [2.4, 3], cells = [8, 2] }}, material = "m" }}
interface.low = {{ secondary = "plate.bottom", primary = "base.top", {law}friction.coulomb.mu = 0.5 }}
interface.high = {{ secondary = "plate.top", primary = "cap.bottom", {law}friction.coulomb.mu = 0.5 }}
amplitude.press.table = [[0, 0], [1, 1], [2, 0]]
amplitude.slide.table = [[0, 0], [1, 1]]
support.base = {{ set = "base.bottom", x = 0, y = 0 }}
support.guide = {{ set = "cap.top", x = 0.01, amplitude = "slide" }}
load.press = {{ set = "cap.top", pressure.value = 2.5, amplitude = "press" }}
probe.cap = {{ of = "cap", point = [0, 3] }}
step = [
    {{ name = "press", increments.fixed = 4 }},
    {{ name = "unload", increments.fixed = 2 }},
    {{ name = "let go", increments.fixed = 2, supports = ["base"] }},
]
"#
            ),
        );
        let at =
            |row: usize, column: &str| outcome.record.increments[row].1.get(column).expect(column);
        let pressed = at(3, "low.CFN2");
        assert!((pressed / 11.5 - 1.0).abs() < 0.01, "{law}: {pressed}");
        for force in ["low.CFN2", "high.CFN2", "low.CFS1", "high.CFS1"] {
            assert!(outcome.last(force).abs() < 1e-6 * pressed, "{law}: {force}");
        }
        let [unloaded, end] = [5, 7].map(|row| at(row, "cap.U1"));
        assert!(
            unloaded > 5e-3 && (unloaded - end).abs() < 1e-5,
            "{law}: {unloaded} {end}"
        );
    }
}

#[test]
fn a_block_between_jaws_that_open_stays_on_the_lower_one() {
    let text = r#"format = 1
model.space = "plane-strain"
body.lower = { generate.rectangle = { to = [0.05, 0.02], cells = [10, 4] }, material = "steel" }
body.mid = { generate.rectangle = { from = [0.012, 0.02], to = [0.038, 0.03], cells = [7, 3] }, material = "steel" }
body.upper = { generate.rectangle = { from = [0.01, 0.03], to = [0.04, 0.05], cells = [6, 4] }, material = "steel" }
material.steel.isotropic = { young = 210e9, poisson = 0.3 }
support.base = { set = "lower.bottom", x = 0, y = 0 }
support.top = { set = "upper.top", x = 0, y = -1e-5, amplitude = "a" }
amplitude.a = { table = [[0, 0], [1, 1], [2, -1], [3, 1]] }
interface.j1 = { secondary = "mid.bottom", primary = "lower.top", friction.coulomb = { mu = 0.2 } }
interface.j2 = { secondary = "upper.bottom", primary = "mid.top", friction.coulomb = { mu = 0.2 } }
probe.corner = { of = "mid", point = [0.038, 0.03] }
step = [{ name = "press" }, { name = "open" }, { name = "again" }]
"#;
    let outcome = run("jaws", text);
    let notes = &outcome.summary.notes;
    assert!(
        notes
            .iter()
            .any(|n| n.contains("open: body mid lost all contact")),
        "{notes:?}"
    );
    let rows = &outcome.record.increments;
    assert!(rows.len() > 3);
    // Pressed again it hands on what it gets; normals are not quite upright.
    let [lower, upper] = ["j1", "j2"]
        .map(|i| outcome.last(&format!("{i}.CFN2")) + outcome.last(&format!("{i}.CFS2")));
    assert!(
        lower.abs() > 1e5 && (lower / upper - 1.0).abs() < 1e-6,
        "{lower} {upper}"
    );
    assert!(outcome.last("corner.U2").abs() < 1e-5);
}

/// What a run ends with that cannot be done.
fn refused(text: &str) -> (String, Summary) {
    let mut simulation = simulation(text);
    let outcome = simulation.run(&mut []);
    let said = outcome.expect_err("nothing holds the body").to_string();
    (said, simulation.run.summary)
}

#[test]
fn what_nothing_can_hold_is_refused_before_the_first_iteration() {
    // Neither of two blocks is supported, and what pushes them does not balance.
    let unsupported = r#"format = 1
model.space = "plane-strain"
body.lower = { generate.rectangle = { to = [1, 1], cells = [2, 2] }, material = "m" }
body.upper = { generate.rectangle = { from = [0.2, 1], to = [0.8, 2], cells = [2, 2] }, material = "m" }
material.m.isotropic = { young = 1e9, poisson = 0.3 }
interface.joint = { secondary = "upper.bottom", primary = "lower.top", friction.coulomb = { mu = 0.3 } }
load.weight = { set = "upper.top", pressure.value = 1e5 }
step = [{ name = "press" }]
"#;
    let (said, summary) = refused(unsupported);
    for part in ["step press", "translation y", "load.weight", "with 60000"] {
        assert!(said.contains(part), "`{part}` is missing in {said}");
    }
    assert_eq!(
        (summary.attempts.iterations, summary.attempts.increments),
        (0, 0)
    );
    assert_eq!(summary.cost.solver.iterations, 0);
    let last = summary.findings.last().expect("a finding");
    assert_eq!(last.cause, DoctorCause::FreeRigidMode);

    // A hinge: held at one point, pushed about it.
    let hinged = r#"format = 1
model.space = "plane-strain"
body.bar = { generate.rectangle = { to = [8, 1], cells = [16, 2] }, material = "m" }
material.m.isotropic = { young = 1e9, poisson = 0.3 }
set.pin = { of = "bar", point = [0, 0] }
support.pin = { set = "pin", x = 0, y = 0 }
load.push = { set = "bar.top", pressure.value = 10 }
step = [{ name = "push" }]
"#;
    let (said, _) = refused(hinged);
    assert!(
        said.contains("rotation about z") && said.contains("load.push"),
        "{said}"
    );
    // What nothing drives is singular all the same, as nothing says where the body is.
    let idle = hinged.replace("pressure.value = 10", "pressure.value = 0");
    assert!(refused(&idle).0.contains("nothing drives it"));

    // Held in the first step, let go in the second.
    let let_go = hinged.replace("step = [{ name = \"push\" }]\n", "")
        + r#"support.end = { set = "bar.right", y = 0 }
[[step]]
name = "hold"
[[step]]
name = "release"
supports = ["pin"]
"#;
    let (said, summary) = refused(&let_go);
    assert!(
        said.contains("step release") && said.contains("load.push"),
        "{said}"
    );
    assert!(summary.attempts.increments > 0);
}

/// Four points of a cell of eight nodes do not see one of its motions.
#[test]
fn reduced_integration_that_leaves_a_motion_without_strain_is_named() {
    let text = r#"
format = 1
model.space = "plane-strain"
body.cell = { generate.rectangle = { from = [0, 0], to = [1, 1], cells = [1, 1], element = "quad8" }, material = "m", formulation = "reduced" }
material.m.isotropic = { young = 1e9, poisson = 0.3 }
set.low = { of = "cell", point = [0, 0] }
set.right = { of = "cell", point = [1, 0] }
support.low = { set = "low", x = 0, y = 0 }
support.right = { set = "right", y = 0 }
load.pull = { set = "cell.top", traction.value = [1e3, 0] }
step = [{}]
"#;
    let (said, _) = refused(text);
    assert!(said.contains("body cell has reduced integration"), "{said}");
}

#[test]
fn what_loads_do_not_drive_and_contact_may_hold_is_not_refused() {
    // No support at all, but the loads balance and contact holds one block against the other.
    let text = r#"format = 1
model.space = "plane-strain"
body.lower = { generate.rectangle = { to = [1, 1], cells = [2, 2] }, material = "m" }
body.upper = { generate.rectangle = { from = [0, 1], to = [1, 2], cells = [3, 3] }, material = "m" }
material.m.isotropic = { young = 1e9, poisson = 0.3 }
interface.joint = { secondary = "upper.bottom", primary = "lower.top" }
load.down = { set = "upper.top", pressure.value = 1e5 }
load.up = { set = "lower.bottom", pressure.value = 1e5 }
step = [{ name = "press", increments = { fixed = 1 } }]
"#;
    let outcome = run("squeezed", text);
    assert!((outcome.last("joint.CFN2") / 1e5 - 1.0).abs() < 1e-6);
}

#[test]
fn the_error_for_a_body_in_contact_says_that_it_slides_and_what_pushes_it() {
    let text = r#"format = 1
model.space = "plane-strain"
body.block = { generate.rectangle = { to = [2, 1], cells = [4, 2] }, material = "m" }
material.m.isotropic = { young = 1e9, poisson = 0.3 }
obstacle.floor.plane = { point = [0, 0], normal = [0, 1] }
interface.base = { secondary = "block.bottom", primary = "floor", friction.coulomb = { mu = 0.2 } }
load.weight = { set = "block.top", pressure.value = 1e5 }
load.wind = { set = "block.left", traction.value = [5e4, 0], amplitude = "later" }
amplitude.later.table = [[0, 0], [1, 0], [2, 1]]
step = [{ name = "settle" }, { name = "blow" }]
"#;
    let (said, summary) = refused(text);
    for part in [
        "step blow",
        "slides, rolls or lifts off",
        "load.wind",
        "dynamic",
    ] {
        assert!(said.contains(part), "`{part}` is missing in {said}");
    }
    assert!(!said.contains("until they touch"), "{said}");
    let last = summary.findings.last().expect("a finding");
    assert_eq!(last.cause, DoctorCause::SlidesAway, "{last}");
    assert!(
        last.suspects.iter().any(|g| g.name == "load.wind"),
        "{last}"
    );
}

/// A block on another, pressed and pushed sideways in proportion.
fn pushed(sideways: f64, mu: f64) -> String {
    format!(
        "{}\nload.side = {{ set = \"upper.top\", traction = {{ value = [{sideways:?}, 0] }} }}",
        plane_blocks(0.0, &format!("coulomb = {{ mu = {mu:?} }}"), SI)
    )
}

#[test]
fn a_load_that_friction_cannot_balance_is_refused_with_the_friction_that_would() {
    // Statics of a rigid block, 30 mm wide and 20 mm high, by hand: sideways 0.4 of the pressure needs friction of 0.4, and less than 0.75, from where on
    // the block tips about its edge whatever friction there is.
    let (said, summary) = refused(&pushed(20e6, 0.3));
    for part in [
        "no equilibrium",
        "translation x",
        "load.side",
        "friction of 0.4000 would hold it",
    ] {
        assert!(said.contains(part), "`{part}` is missing in {said}");
    }
    assert_eq!(
        (summary.attempts.increments, summary.cost.solver.iterations),
        (0, 0)
    );
    assert!(
        summary
            .findings
            .last()
            .is_some_and(|f| f.cause == DoctorCause::SlidesAway)
    );
    let (said, summary) = refused(&pushed(40e6, 5.0));
    for part in ["rotation about z", "load.side", "no friction would hold it"] {
        assert!(said.contains(part), "`{part}` is missing in {said}");
    }
    assert_eq!(summary.cost.solver.iterations, 0);
    // What friction can just hold is not refused.
    assert!(run("held", &pushed(20e6, 0.41)).summary.run.completed);
}

#[test]
fn a_load_that_grows_beyond_friction_is_told_with_its_time_and_not_by_halving() {
    let text = pushed(20e6, 0.3).replace("step = [{ increments.fixed = 2 }]", "")
        + r#"
amplitude.later.table = [[0, 0], [1, 0], [2, 1]]
step = [{ name = "press", increments.fixed = 2 }, { name = "push", increments.fixed = 10 }]
"#;
    let text = text.replace(
        "value = [20000000.0, 0] }",
        "value = [20000000.0, 0] }, amplitude = \"later\"",
    );
    // In full from the start.
    let text = text.replace(
        "pressure = { value = 50000000.0 }",
        "pressure = { value = 50000000.0 }, amplitude = \"full\"",
    ) + "amplitude.full.table = [[0, 0], [1, 1], [2, 1]]\n";
    let (said, summary) = refused(&text);
    // 0.3 * 50 MPa are reached after three quarters of the second step.
    for part in [
        "there is no equilibrium from 1.75 on",
        "load.side",
        "friction of 0.3200",
    ] {
        assert!(said.contains(part), "`{part}` is missing in {said}");
    }
    assert_eq!(
        (summary.attempts.increments, summary.attempts.cutbacks),
        (9, 1)
    );
}

#[test]
fn a_block_in_space_is_held_by_a_cone_of_friction() {
    let text = |mu: f64| {
        solid_blocks(0.0, &format!("coulomb = {{ mu = {mu:?} }}"))
            + "load.side = { set = \"upper.top\", traction = { value = [12e6, 16e6, 0] } }\n"
    };
    // 20 MPa across and 50 MPa down, wherever across points.
    let (said, _) = refused(&text(0.35));
    let found = said
        .split("friction of ")
        .nth(1)
        .and_then(|s| s.split(' ').next());
    let found: f64 = found.and_then(|s| s.parse().ok()).expect("the friction");
    assert!((0.395..=0.4001).contains(&found), "{said}");
}

/// A block that two walls squeeze is pushed down until it slides, and comes to rest on a floor: whatever the way, all of it is friction on the walls. Where it is
/// long, the block has to be followed; moved to the floor at once it would have left out the work of the way.
#[test]
fn what_slides_off_between_walls_rubs_all_the_way() {
    let work = |way: f64| {
        let text = format!(
            r#"
format = 1
model.space = "plane-strain"
body.block = {{ generate.rectangle = {{ from = [-1, 0], to = [1, 1], cells = [6, 3] }}, material = "m" }}
material.m.isotropic = {{ young = 1e3, poisson = 0.3 }}
obstacle.left.plane = {{ point = [-1, 0], normal = [1, 0] }}
obstacle.right = {{ plane = {{ point = [1, 0], normal = [-1, 0] }}, motion.translation = [[0, 0, 0], [1, -0.02, 0]] }}
obstacle.floor.plane = {{ point = [0, {floor:?}], normal = [0, 1] }}
interface.left = {{ secondary = "block.left", primary = "left", friction.coulomb.mu = 0.3 }}
interface.right = {{ secondary = "block.right", primary = "right", friction.coulomb.mu = 0.3 }}
interface.floor = {{ secondary = "block.bottom", primary = "floor", friction.coulomb.mu = 0.3 }}
load.down = {{ set = "block.top", traction.value = [0, -10], amplitude = "down" }}
amplitude.down.table = [[0, 0], [1, 0], [2, 1]]
step = [{{ increments.fixed = 2 }}, {{ increments = {{ initial = 0.25, largest = 0.25 }} }}]
"#,
            floor = -way
        );
        let outcome = run(&format!("{way:e}"), &text);
        assert!(outcome.summary.run.completed);
        outcome.last("ALLFD")
    };
    let ways = [0.3, 1.0, 3.0];
    let works = ways.map(work);
    // The walls hold with the same force wherever the block is.
    let slope = (works[1] - works[0]) / (ways[1] - ways[0]);
    let far = works[1] + slope * (ways[2] - ways[1]);
    assert!(slope > 7.0, "{works:?}");
    assert!((works[2] / far - 1.0).abs() < 1e-3, "{works:?}, {far}");
}

/// A block that only contact holds, on another, with weight; in metres and seconds.
fn laid(steps: &str, lift: f64) -> String {
    format!(
        r#"
format = 1
model.space = "plane-strain"
body.a = {{ generate.rectangle = {{ from = [0, -1], to = [1, 0], cells = [1, 1] }}, material = "m" }}
body.b = {{ generate.rectangle = {{ to = [1, 1], cells = [1, 1] }}, translate = [0, {lift:?}], material = "m" }}
material.m.isotropic = {{ young = 2e9, poisson = 0.3, density = 7800.0 }}
interface.f = {{ secondary = "b.bottom", primary = "a.top" }}
load.w = {{ set = "b", gravity.acceleration = [0, -10] }}
support.s = {{ set = "a.bottom", x = 0, y = 0 }}
quality.gate = "off"
step = [{steps}]
"#
    )
}

#[test]
fn what_followed_a_loose_body_at_rest_has_no_part_in_motion() {
    const REST: &str = "{ duration = 1 }";
    const MODES: &str = "{ duration = 1, modes = { count = 2 } }";
    let explicit = "{ duration = 1e-3, dynamic.scheme.central-difference = {} }";
    let implicit = "{ duration = 1e-3, dynamic.scheme.generalised-alpha = {} }";
    let weight = 78e3;
    for steps in [
        vec![REST, explicit],
        vec![REST, implicit],
        vec![REST, MODES, explicit],
        vec![REST, explicit, REST],
        vec![REST, implicit, explicit, REST],
    ] {
        let text = laid(&steps.join(", "), 0.0);
        let found = run(&steps.join(" "), &text);
        let force = found.last("f.CFN2");
        // A weight that lay still goes on doing so.
        assert!((force / weight - 1.0).abs() < 0.02, "{steps:?}: {force}");
        let followed = found.summary.loose.followed;
        let rests = steps.iter().filter(|s| **s == REST).count();
        assert!(followed >= 1 && followed <= 20 * rests, "{followed}");
        // What anchors were left in is not seen in motion.
        let mut simulation = simulation(&text);
        while simulation
            .advance(&mut [])
            .unwrap_or_else(|e| panic!("{e}"))
        {
            let step = simulation.frame.step;
            let moves = steps[step] == explicit || steps[step] == implicit;
            let notes = &simulation.summary.notes;
            assert!(
                !moves || !notes.iter().any(|n| n.contains("rigid-body motion")),
                "{notes:?}"
            );
        }
    }
}

#[test]
fn a_body_that_fell_explicitly_is_followed_at_rest() {
    let explicit = "{ duration = 1e-3, dynamic.scheme.central-difference = {} }";
    let found = run(
        "fall, rest",
        &laid(&format!("{explicit}, {{ duration = 1 }}"), 0.01),
    );
    let force = found.last("f.CFN2");
    assert!((force / 78e3 - 1.0).abs() < 1e-6, "{force}");
}

/// A block on another, pushed aside, without friction.
const PUSHED: &str = r#"
format = 1
model.space = "plane-strain"
body.lower = { generate.rectangle = { to = [0.05, 0.02], cells = [10, 4] }, material = "steel" }
body.upper = { generate.rectangle = { from = [0.01, 0.02], to = [0.04, 0.04], cells = [7, 5] }, material = "steel" }
material.steel.isotropic = { young = 210e9, poisson = 0.3 }
support.base = { set = "lower.bottom", x = 0, y = 0 }
load.press = { set = "upper.top", pressure.value = 50e6 }
load.push = { set = "upper.left", traction.value = [20e6, 0] }
interface.joint = { secondary = "upper.bottom", primary = "lower.top" }
step = [{ increments.fixed = 2 }]
"#;

/// What holds a body to another one counts before the run as well as in it: a spring, and a stop that has to be reached first.
#[test]
fn springs_and_stops_between_bodies_hold() {
    let terms = "terms = [{ set = \"upper.bottom-right\", component = \"x\", factor = -1 }, { set = \"lower.bottom-right\", component = \"x\" }]";
    for coupling in [
        format!("coupling.c.spring = {{ {terms}, stiffness = 1e9 }}"),
        format!("coupling.c.gap = {{ {terms}, clearance = 1e-5 }}"),
    ] {
        let outcome = run(&coupling, &format!("{PUSHED}{coupling}\n"));
        let causes = outcome.summary.findings.iter().map(|f| f.cause);
        let causes: Vec<DoctorCause> = causes.collect();
        assert!(
            !causes.contains(&DoctorCause::SlidesAway)
                && !causes.contains(&DoctorCause::FreeRigidMode),
            "{causes:?}"
        );
        let force = outcome.last("c.F").abs();
        // Contact on slopes of a thousandth takes a little.
        assert!((force / 4e5 - 1.0).abs() < 1e-3, "{force:e}");
        assert!(outcome.summary.quality.met);
    }
}

/// Two posts stand on a base, a cap lies on them, and a bolt between them draws it down. Less than its force lifts the cap.
fn bolted(lift: f64) -> String {
    format!(
        r#"
format = 1
model.space = "plane-strain"
body.base = {{ generate.rectangle = {{ to = [0.1, 0.02], cells = [20, 4] }}, material = "steel" }}
body.left = {{ generate.rectangle = {{ from = [0.01, 0.02], to = [0.03, 0.05], cells = [4, 6] }}, material = "steel" }}
body.right = {{ generate.rectangle = {{ from = [0.07, 0.02], to = [0.09, 0.05], cells = [4, 6] }}, material = "steel" }}
body.bolt = {{ generate.rectangle = {{ from = [0.045, 0.02], to = [0.055, 0.05], cells = [2, 6] }}, material = "steel" }}
body.cap = {{ generate.rectangle = {{ from = [0, 0.05], to = [0.1, 0.07], cells = [20, 4] }}, material = "steel" }}
material.steel.isotropic = {{ young = 210e9, poisson = 0.3 }}
support.base = {{ set = "base.bottom", x = 0, y = 0 }}
interface.foot-left = {{ secondary = "left.bottom", primary = "base.top", friction.coulomb.mu = 0.3 }}
interface.foot-right = {{ secondary = "right.bottom", primary = "base.top", friction.coulomb.mu = 0.3 }}
interface.head-left = {{ secondary = "left.top", primary = "cap.bottom", friction.coulomb.mu = 0.3 }}
interface.head-right = {{ secondary = "right.top", primary = "cap.bottom", friction.coulomb.mu = 0.3 }}
interface.bolt-foot = {{ secondary = "bolt.bottom", primary = "base.top", tied = true }}
interface.bolt-head = {{ secondary = "bolt.top", primary = "cap.bottom", tied = true }}
pretension.bolt = {{ of = "bolt", plane = {{ point = [0.05, 0.035], normal = [0, 1] }} }}
load.lift = {{ set = "cap.top", traction.value = [0, {lift:?}] }}
step = [{{ pretension.bolt.force = 1e6, increments.fixed = 2 }}]
"#
    )
}

/// A pretension is a pair of forces inside a body: each presses what only it acts on.
#[test]
fn what_a_bolt_draws_down_is_held_against_less_than_its_force() {
    let outcome = run("lifted", &bolted(5e6));
    let pressed = outcome.last("head-left.CFN2") + outcome.last("head-right.CFN2");
    assert!((pressed / -5e5 - 1.0).abs() < 1e-3, "{pressed:e}");
    let message = match attempt(&bolted(2e7)) {
        Ok(_) => panic!("twice the force of the bolt is held"),
        Err(e) => e.to_string(),
    };
    assert!(
        message.contains("no equilibrium") && message.contains("load.lift"),
        "{message}"
    );
}

/// A jack between a roof and a floor: the part below the cut is pushed down, and it alone touches the floor.
#[test]
fn what_a_jack_pushes_apart_is_held_by_what_touches() {
    let outcome = run(
        "jacked",
        r#"
format = 1
model.space = "plane-strain"
body.floor = { generate.rectangle = { to = [0.1, 0.02], cells = [20, 4] }, material = "steel" }
body.jack = { generate.rectangle = { from = [0.03, 0.02], to = [0.07, 0.06], cells = [7, 6] }, material = "steel" }
material.steel.isotropic = { young = 210e9, poisson = 0.3 }
support.base = { set = "floor.bottom", x = 0, y = 0 }
support.roof = { set = "jack.top", x = 0, y = 0 }
interface.foot = { secondary = "jack.bottom", primary = "floor.top", friction.coulomb.mu = 0.3 }
pretension.jack = { of = "jack", plane = { point = [0.05, 0.04], normal = [0, 1] } }
step = [{ pretension.jack.force = -1e6, increments.fixed = 2 }]
"#,
    );
    let pressed = outcome.last("foot.CFN2") + outcome.last("foot.CFS2");
    assert!((pressed / 1e6 - 1.0).abs() < 1e-6, "{pressed:e}");
}

/// A cap that is glued to a loose block which enters what it lies on, as meshed: both are one unconstrained body.
#[test]
fn bodies_that_are_tied_are_followed_as_one() {
    let glued = |y: f64| {
        format!(
            r#"
format = 1
model.space = "plane-strain"
body.lower = {{ generate.rectangle = {{ to = [0.05, 0.02], cells = [10, 4] }}, material = "steel" }}
body.upper = {{ generate.rectangle = {{ from = [0.01, 0.02], to = [0.04, 0.04], cells = [7, 5] }}, translate = [0, {y:?}], material = "steel" }}
body.cap = {{ generate.rectangle = {{ from = [0.01, 0.04], to = [0.04, 0.05], cells = [6, 2] }}, translate = [0, {y:?}], material = "steel" }}
material.steel.isotropic = {{ young = 210e9, poisson = 0.3 }}
support.base = {{ set = "lower.bottom", x = 0, y = 0 }}
load.press = {{ set = "cap.top", pressure.value = 50e6 }}
load.push = {{ set = "cap.left", traction.value = [2e6, 0] }}
interface.joint = {{ secondary = "upper.bottom", primary = "lower.top", friction.coulomb.mu = 0.5 }}
interface.tie = {{ secondary = "cap.bottom", primary = "upper.top", tied = true }}
step = [{{ increments.fixed = 2 }}]
"#
        )
    };
    for y in [-1e-5, 0.0, 1e-5] {
        let outcome = run("glued", &glued(y));
        assert!(outcome.summary.quality.met, "{y}");
        let normal = outcome.last("joint.CFN2");
        assert!((normal / 1.5e6 - 1.0).abs() < 1e-3, "{y}: {normal:e}");
        let free = outcome.summary.notes.join(" ");
        assert_eq!(
            free.contains("cap and upper") || free.contains("upper and cap"),
            y > 0.0,
            "{free}"
        );
    }
}

/// A force on a reference point that a glued cap follows pushes both bodies: where it presses they are not taken for bodies that other loads lift.
#[test]
fn what_acts_on_a_reference_point_pushes_its_body() {
    let outcome = run(
        "headed",
        r#"
format = 1
model.space = "plane-strain"
body.lower = { generate.rectangle = { to = [0.05, 0.02], cells = [10, 4] }, material = "steel" }
body.upper = { generate.rectangle = { from = [0.01, 0.02], to = [0.04, 0.04], cells = [7, 5] }, translate = [0, 1e-5], material = "steel" }
body.cap = { generate.rectangle = { from = [0.01, 0.04], to = [0.04, 0.05], cells = [6, 2] }, translate = [0, 1e-5], material = "steel" }
material.steel.isotropic = { young = 210e9, poisson = 0.3 }
reference.head.point = [0.025, 0.05]
coupling.head.kinematic = { reference = "head", set = "cap.top" }
support.base = { set = "lower.bottom", x = 0, y = 0 }
support.guide = { set = "head", x = 0, rotation-z = 0 }
load.press = { set = "head", nodal-force.value = [0, -1.5e6] }
load.lift = { set = "upper.right", traction.value = [0, 5e6] }
interface.joint = { secondary = "upper.bottom", primary = "lower.top", friction.coulomb.mu = 0.5 }
interface.tie = { secondary = "cap.bottom", primary = "upper.top", tied = true }
step = [{ increments.fixed = 2 }]
"#,
    );
    let normal = outcome.last("joint.CFN2");
    assert!((normal / 1.4e6 - 1.0).abs() < 1e-3, "{normal:e}");
}

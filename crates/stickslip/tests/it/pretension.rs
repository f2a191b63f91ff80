//! Cuts through bolts: drawn together by force or length, held, and what that does to a joint.

use std::path::Path;

use crate::support;
use support::{Record, build, complaint, problem};

const METHODS: [&str; 3] = ["sparse", "condensed", "multigrid"];

fn value(row: &support::Row, name: &str) -> f64 {
    row.get(name).unwrap_or_else(|| panic!("no column {name}"))
}

/// Runs a problem, by the way to solve that it asks for.
fn record(text: &str) -> Record {
    let mut simulation = build(&problem(text)).unwrap_or_else(|e| panic!("{e}"));
    let mut record = Record::default();
    let outcome = simulation.run(&mut [&mut record]);
    outcome.unwrap_or_else(|e| panic!("{e}\n{text}"));
    for method in METHODS {
        if text.contains(&format!("solver.method = \"{method}\"")) {
            assert_eq!(simulation.summary.solved_by.method, method, "{text}");
        }
    }
    record
}

fn near(found: f64, expected: f64, tolerance: f64) {
    assert!(
        (found - expected).abs() <= tolerance,
        "{found} is not {expected}: {:e} apart",
        found - expected
    );
}

/// A bar of the stiffness 250 between two walls, cut in the middle; the far wall moves in the second step.
fn bar(space: &str, generate: &str, method: &str) -> String {
    format!(
        r#"
format = 1
model.space = "{space}"
solver.method = "{method}"
body.bar = {{ {generate}, material = "m" }}
material.m.isotropic = {{ young = 1000.0, poisson = 0.0, density = 1.0 }}
pretension.bolt = {{ of = "bar", plane = {{ point = [1.9, 0.5, 0.5], normal = [2, 0, 0] }} }}
support.wall = {{ set = "bar.left", x = 0, y = 0, z = 0 }}
support.far = {{ set = "bar.right", x = 0.01, y = 0, z = 0, amplitude = "pull" }}
amplitude.pull.table = [[1, 0], [2, 1]]
amplitude.pulse.table = [[3, 1], [3.5, 2], [4, 0.5]]
[[step]]
pretension.bolt = {{ force = 10 }}
increments.fixed = 2
[[step]]
pretension.bolt = {{ hold = true }}
increments.fixed = 2
[[step]]
pretension.bolt = {{ shortening = 0.06 }}
increments.fixed = 2
[[step]]
pretension.bolt = {{ force = 15, amplitude = "pulse" }}
increments.fixed = 4
[[step]]
increments.fixed = 1
"#
    )
}

#[test]
fn a_bar_between_walls_has_the_force_that_is_given_and_keeps_the_shortening_that_is_held() {
    let plane = "generate.rectangle = { to = [4, 1], cells = [8, 2] }";
    let solid = "generate.box = { to = [4, 1, 1], cells = [4, 2, 2] }";
    let curved = "generate.box = { to = [4, 1, 1], cells = [4, 1, 1], element = \"hex20\" }";
    let tetrahedra = "generate.box = { to = [4, 1, 1], cells = [5, 2, 2], element = \"tet4\" }";
    let cases = [
        ("plane-stress", plane, &METHODS[..]),
        ("solid", solid, &METHODS[..]),
        ("solid", curved, &METHODS[..2]),
        ("solid", tetrahedra, &METHODS[..1]),
    ];
    for (space, generate, methods) in cases {
        for method in methods {
            let mut text = bar(space, generate, method);
            if space != "solid" {
                text = text
                    .replace(", 0.5, 0.5]", ", 0.5]")
                    .replace("[2, 0, 0]", "[2, 0]");
                text = text.replace(", z = 0", "");
            }
            let rows = record(&text).increments;
            let force: Vec<f64> = rows.iter().map(|(_, r)| value(r, "bolt.F")).collect();
            let short: Vec<f64> = rows.iter().map(|(_, r)| value(r, "bolt.U")).collect();
            // F = 250 (s + u) with the far wall at u
            let expected = [
                (5.0, 0.02),
                (10.0, 0.04),
                (11.25, 0.04),
                (12.5, 0.04),
                (15.0, 0.05),
                (17.5, 0.06),
                (22.5, 0.08),
                (30.0, 0.11),
                (18.75, 0.065),
                (7.5, 0.02),
                (7.5, 0.02),
            ];
            assert_eq!(force.len(), expected.len());
            for (k, (f, s)) in expected.into_iter().enumerate() {
                near(force[k], f, 1e-6);
                near(short[k], s, 1e-9);
                let row = &rows[k].1;
                near(value(row, "wall.RF1"), -f, 1e-6);
                near(value(row, "ALLSE"), f * f / 500.0, 1e-8);
                near(value(row, "ERESIDUAL"), 0.0, 1e-8);
            }
        }
    }
}

#[test]
fn in_motion_a_bolt_is_tightened_and_held_and_the_energies_close() {
    let steps = |scheme: &str| {
        let dynamic = format!("dynamic = {{ scheme.{scheme} = {{}} }}");
        format!(
            r#"
[[step]]
pretension.bolt = {{ force = 10 }}
increments.fixed = 40
{dynamic}
[[step]]
pretension.bolt = {{ hold = true }}
increments.fixed = 40
{dynamic}
"#
        )
    };
    for scheme in ["newmark", "generalised-alpha"] {
        let text = bar(
            "plane-stress",
            "generate.rectangle = { to = [4, 1], cells = [8, 2] }",
            "sparse",
        );
        let text = text
            .replace(", 0.5, 0.5]", ", 0.5]")
            .replace("[2, 0, 0]", "[2, 0]");
        let text = text
            .replace(", z = 0", "")
            .replace(", amplitude = \"pull\"", "");
        let text = text.replace("x = 0.01", "x = 0");
        let head = text.split("[[step]]").next().expect("a head").to_string();
        let head = head.replace("amplitude.pulse.table = [[3, 1], [3.5, 2], [4, 0.5]]", "");
        let rows = record(&format!("{head}{}", steps(scheme))).increments;
        let tight = value(&rows[39].1, "bolt.U");
        near(value(&rows[39].1, "bolt.F"), 10.0, 1e-9);
        // A wave runs four times through the bar in a step: what is left swings about the equilibrium.
        near(tight, 0.04, 0.004);
        for (_, row) in &rows[40..] {
            near(value(row, "bolt.U"), tight, 1e-9);
        }
        let mean = rows[40..]
            .iter()
            .map(|(_, r)| value(r, "bolt.F"))
            .sum::<f64>()
            / 40.0;
        near(mean, 10.0, 1.0);
        for (_, row) in &rows {
            near(value(row, "ERESIDUAL"), 0.0, 2e-4 * 0.2);
        }
    }
}

/// A bolt of the stiffness 250 beside a sleeve of 1000, both 4 long, between the ground and a stiff plate that is pulled off; only the bolt is
/// fast at both ends.
fn joint(method: &str) -> String {
    format!(
        r#"
format = 1
model.space = "plane-stress"
solver.method = "{method}"
body.bolt = {{ generate.rectangle = {{ to = [1, 4], cells = [2, 8] }}, material = "m" }}
body.sleeve = {{ generate.rectangle = {{ from = [2, 0], to = [4, 4], cells = [4, 8] }}, material = "twice" }}
body.plate = {{ generate.rectangle = {{ from = [0, 4], to = [4, 5], cells = [8, 2] }}, material = "stiff" }}
material.m.isotropic = {{ young = 1000.0, poisson = 0.0 }}
material.twice.isotropic = {{ young = 2000.0, poisson = 0.0 }}
material.stiff.isotropic = {{ young = 1e8, poisson = 0.0 }}
pretension.screw = {{ of = "bolt", plane = {{ point = [0.5, 2], normal = [0, 1] }} }}
support.ground = {{ set = "foot", x = 0, y = 0 }}
support.guide = {{ set = "plate.top", x = 0 }}
coupling.level.equation = {{ terms = [{{ set = "plate.top", component = "y" }}, {{ set = "corner", component = "y", factor = -1 }}] }}
set.corner = {{ of = "plate", point = [4, 5] }}
set.foot = {{ union = ["bolt.bottom", "sleeve.bottom"] }}
interface.thread = {{ secondary = "bolt.top", primary = "plate.bottom", tied = true }}
interface.seat = {{ secondary = "sleeve.top", primary = "plate.bottom" }}
load.pull = {{ set = "plate.top", traction = {{ value = [0, 10] }} }}
probe.plate = {{ of = "plate", point = [4, 5] }}
[[step]]
name = "tighten"
loads = []
pretension.screw = {{ force = 20 }}
increments.fixed = 2
[[step]]
name = "service"
pretension.screw = {{ hold = true }}
increments.fixed = 4
"#
    )
}

#[test]
fn a_load_on_a_joint_is_split_by_stiffness_until_it_opens_and_is_all_in_the_bolt_after() {
    for method in METHODS {
        let rows = record(&joint(method)).increments;
        let (bolt, sleeve) = (250.0, 1000.0);
        let tight = &rows[1].1;
        near(value(tight, "screw.F"), 20.0, 1e-6);
        near(value(tight, "screw.U"), 20.0 / bolt + 20.0 / sleeve, 1e-5);
        near(value(tight, "seat.CFN2"), -20.0, 1e-3);
        for (k, (_, row)) in rows[2..].iter().enumerate() {
            let pull = 10.0 * (k + 1) as f64;
            // It opens where the sleeve has lost the pretension: at 20 (bolt + sleeve) / sleeve = 25.
            let expected = match pull < 25.0 {
                true => 20.0 + pull * bolt / (bolt + sleeve),
                false => pull,
            };
            near(value(row, "screw.F"), expected, 1e-3);
            near(value(row, "screw.U"), value(tight, "screw.U"), 1e-9);
            near(value(row, "seat.CFN2"), pull - expected, 1e-3);
        }
        let last = &rows[5].1;
        near(value(last, "ERESIDUAL"), 0.0, 1e-2 * value(last, "ALLSE"));
    }
}

/// Half of a bolt through two plates, as high as the middle of the bolt is wide: nothing holds the bolt and the upper plate along it but contact. With a gap under
/// the head.
fn loose(method: &str, gap: f64) -> String {
    let (top, end) = (4.0 + gap, 5.0 + gap);
    format!(
        r#"
format = 1
model.space = "plane-strain"
solver.method = "{method}"
body.shank = {{ generate.rectangle = {{ to = [1, {top}], cells = [2, 8] }}, material = "m" }}
body.head = {{ generate.rectangle = {{ from = [0, {top}], to = [2.5, {end}], cells = [5, 2] }}, material = "m" }}
body.foot = {{ generate.rectangle = {{ from = [0, -1], to = [2.5, 0], cells = [5, 2] }}, material = "m" }}
body.lower = {{ generate.rectangle = {{ from = [1.2, 0], to = [4, 2], cells = [6, 4] }}, material = "m" }}
body.upper = {{ generate.rectangle = {{ from = [1.2, 2], to = [4, 4], cells = [6, 4] }}, material = "m" }}
material.m.isotropic = {{ young = 1000.0, poisson = 0.3 }}
pretension.screw = {{ of = "shank", plane = {{ point = [0, 2], normal = [0, 1] }} }}
support.middle = {{ set = "middle", x = 0 }}
support.guide = {{ set = "upper.right", x = 0 }}
support.wall = {{ set = "lower.right", x = 0, y = 0 }}
set.middle = {{ union = ["shank.left", "head.left", "foot.left"] }}
interface.neck = {{ secondary = "shank.top", primary = "head.bottom", tied = true }}
interface.root = {{ secondary = "shank.bottom", primary = "foot.top", tied = true }}
interface.seat = {{ secondary = "upper.top", primary = "head.bottom" }}
interface.joint = {{ secondary = "upper.bottom", primary = "lower.top", friction.coulomb = {{ mu = 0.1 }} }}
interface.base = {{ secondary = "lower.bottom", primary = "foot.top" }}
[[step]]
pretension.screw = {{ force = 20 }}
increments.initial = 0.5
[[step]]
pretension.screw = {{ hold = true }}
increments.fixed = 1
"#
    )
}

#[test]
fn a_bolt_that_only_contact_holds_is_tightened_with_and_without_a_gap() {
    for method in ["sparse", "condensed"] {
        for gap in [0.0, 1e-3] {
            let rows = record(&loose(method, gap)).increments;
            let last = &rows.last().expect("a row").1;
            near(value(last, "screw.F"), 20.0, 1e-5);
            for interface in ["seat", "joint", "base"] {
                near(value(last, &format!("{interface}.CFN2")).abs(), 20.0, 1e-4);
            }
            let other = &record(&loose("multigrid", 0.0))
                .increments
                .last()
                .expect("a row")
                .1
                .clone();
            near(value(last, "screw.U"), value(other, "screw.U") + gap, 1e-4);
        }
    }
}

#[test]
fn a_run_that_stopped_goes_on_with_the_bits_of_one_that_did_not() {
    let generate = "generate.box = { to = [4, 1, 1], cells = [4, 2, 2] }";
    let condensed = bar("solid", generate, "condensed");
    for (name, text) in [("sparse", joint("sparse")), ("condensed", condensed)] {
        crate::restart::check(name, &problem(&text), Path::new("."), 4);
    }
}

#[test]
fn a_condensed_joint_without_a_pretension_goes_on_with_the_same_bits() {
    let text: String = joint("condensed")
        .lines()
        .filter(|line| !line.starts_with("pretension"))
        .flat_map(|line| [line, "\n"])
        .collect();
    crate::restart::check("loose bolt", &problem(&text), Path::new("."), 5);
}

#[test]
fn what_cannot_be_cut_or_drawn_is_said_at_its_key() {
    let wrong = [
        (
            "point = [0.5, 2]",
            "point = [0.5, 7]",
            "pretension.screw.plane",
        ),
        (
            "point = [0.5, 2]",
            "point = [0.5]",
            "pretension.screw.plane.point",
        ),
        (
            "normal = [0, 1] } }",
            "normal = [0, 0] } }",
            "pretension.screw.plane.normal",
        ),
        ("of = \"bolt\", plane", "plane", "pretension.screw"),
        (
            "of = \"bolt\", plane",
            "of = \"blot\", plane",
            "pretension.screw.of",
        ),
        (
            "of = \"bolt\", plane",
            "of = \"bolt.shank\", plane",
            "pretension.screw.of",
        ),
        (
            "pretension.screw = { hold = true }",
            "pretension.crew = { hold = true }",
            "step.2.pretension.crew",
        ),
        (
            "{ hold = true }",
            "{ hold = true, force = 2 }",
            "step.2.pretension.screw",
        ),
        ("{ hold = true }", "{}", "step.2.pretension.screw"),
        (
            "{ force = 20 }",
            "{ force = 20, amplitude = \"a\" }",
            "step.1.pretension.screw.amplitude",
        ),
    ];
    for (right, new, key) in wrong {
        let text = joint("sparse").replacen(right, new, 1);
        let message = complaint(&text);
        assert!(message.contains(key), "{key}: {message}");
    }
}

/// A bolt whose thread, the primary of a tie, reaches over the cut: the nut hangs on the part beyond the cut, and the plate holds the nut.
#[test]
fn a_thread_may_reach_over_the_cut() {
    let text = r#"
format = 1
model.space = "plane-strain"
body.bolt = { generate.rectangle = { to = [1, 10], cells = [1, 10] }, material = "m" }
body.nut = { generate.rectangle = { from = [1, 8], to = [3, 9], cells = [2, 1] }, material = "m" }
body.plate = { generate.rectangle = { from = [1.5, 6], to = [3, 8], cells = [2, 2] }, material = "m" }
material.m.isotropic = { young = 1000.0, poisson = 0.0 }
interface.thread = { secondary = "nut.left", primary = "bolt.right", tied = true }
interface.seat = { secondary = "nut.bottom", primary = "plate.top", friction.coulomb = { mu = 0.3 } }
support.head = { set = "bolt.bottom", x = 0, y = 0 }
support.ground = { set = "plate.bottom", x = 0, y = 0 }
pretension.tight = { of = "bolt", plane = { point = [0.5, 5], normal = [0, 1] } }
[[step]]
pretension.tight = { force = 1 }
increments.fixed = 2
"#;
    let rows = record(text).increments;
    let last = &rows.last().expect("a row").1;
    // The nut bends a little, so that friction carries a part.
    let carried = value(last, "seat.CFN2") + value(last, "seat.CFS2");
    near(carried.abs(), 1.0, 1e-6);
}

//! Friction that depends on the direction of slip, through whole problems.

use std::path::Path;

use crate::restart;
use crate::support::{self, Row};

/// Coefficients along x and across.
const MU: [f64; 2] = [0.5, 0.2];

/// Shear over pressure for slip at 30, 45 and 60 degrees from the axis, by the associated rule and against the traction.
const TABLE: [(f64, [f64; 2], [f64; 2]); 3] = [
    (
        30.0,
        [-0.487177352, -0.045003516],
        [-0.284747399, -0.164398987],
    ),
    (
        45.0,
        [-0.464238345, -0.074278135],
        [-0.185695338, -0.185695338],
    ),
    (
        60.0,
        [-0.410997468, -0.113898959],
        [-0.112508790, -0.194870941],
    ),
];

/// Slip directions and rules of the table.
fn cases() -> impl Iterator<Item = (f64, &'static str, [f64; 2])> {
    TABLE.into_iter().flat_map(|(angle, associated, against)| {
        [
            (angle, "associated", associated),
            (angle, "against-traction", against),
        ]
    })
}

/// A block that a unit of pressure presses on a floor, and that is dragged over it by 0.2 at an angle from x, or stands while the material of the floor moves past.
fn dragged(angle: f64, joint: &str, head: &str, steps: &str) -> String {
    let (sine, cosine) = angle.to_radians().sin_cos();
    format!(
        r#"
format = 1
model.space = "solid"
{head}

[body.floor]
generate.box = {{ from = [-1, -1, -0.5], to = [2, 2, 0], cells = [2, 2, 1] }}
material = "m"

[body.block]
generate.box = {{ to = [1, 1, 0.3], cells = [2, 2, 1] }}
material = "m"

[material.m]
isotropic = {{ young = 1e4, poisson = 0.3, density = 1 }}

[interface.sole]
secondary = "block.bottom"
primary = "floor.top"
roles = "as-named"
{joint}

[support.floor]
set = "floor.bottom"
x = 0
y = 0
z = 0

[support.drag]
set = "block.top"
x = {x:?}
y = {y:?}
amplitude = "drag"

[amplitude.drag]
table = [[0, 0], [1, 0], [2, 1]]

[load.press]
set = "block.top"
pressure.value = 1.0
amplitude = "press"

[amplitude.press]
table = [[0, 0], [1, 1]]

{steps}
"#,
        x = 0.2 * cosine,
        y = 0.2 * sine,
    )
}

const PRESS: &str = "[[step]]\nname = \"press\"\nincrements.fixed = 1\n";
const DRAG: &str = "[[step]]\nname = \"press\"\nincrements.fixed = 1\n[[step]]\nname = \"drag\"\nincrements.fixed = 8\n";

fn scratched(slip: &str, joint: &str) -> String {
    let [along, across] = MU;
    format!(
        "friction.orthotropic = {{ mu = [{along}, {across}], axis = [1, 0, 0], slip = \"{slip}\" }}\n{joint}"
    )
}

fn rows(text: &str, what: &str) -> Vec<Row> {
    let record = support::run(&support::problem(text)).unwrap_or_else(|e| panic!("{what}: {e}"));
    record.increments.into_iter().map(|(_, row)| row).collect()
}

fn of(row: &Row, name: &str) -> f64 {
    row.get(name).unwrap_or_else(|| panic!("no column {name}"))
}

/// Shear of the interface over what presses it.
fn shear_over_pressure(row: &Row) -> [f64; 2] {
    let push = of(row, "sole.CFN3").abs();
    ["CFS1", "CFS2"].map(|name| of(row, &format!("sole.{name}")) / push)
}

fn assert_close(what: &str, found: [f64; 2], expected: [f64; 2], close: f64) {
    let off = (found[0] - expected[0])
        .abs()
        .max((found[1] - expected[1]).abs());
    assert!(off < close, "{what}: {found:?}, {expected:?}");
}

#[test]
fn a_block_that_is_dragged_carries_the_shear_of_its_direction() {
    for (angle, slip, expected) in cases() {
        let what = format!("{angle} {slip}");
        let text = dragged(angle, &scratched(slip, ""), "", DRAG);
        let rows = rows(&text, &what);
        let last = rows.last().expect("a row");
        // The floor sinks unevenly under the block, and turns the normal by some micrometres a unit.
        assert_close(&what, shear_over_pressure(last), expected, 1e-5);
    }
}

#[test]
fn all_methods_and_slip_rules_find_the_same_shear() {
    let ways = [
        ("slip.regularised.epsilon = 0.02", ""),
        ("enforcement.penalty = {}", ""),
        ("enforcement.perturbed-lagrangian = {}", ""),
        (
            "enforcement.augmented-lagrangian = {}",
            "solver.method = \"condensed\"",
        ),
        ("", "solver.method = \"sparse\""),
        ("discretisation.node-to-facet = {}", ""),
        (
            "kinematics.small-sliding = {}",
            "quality.gate = \"off\"\nsolver.method = \"condensed\"",
        ),
    ];
    let all = cases().filter(|(angle, ..)| *angle == 30.0);
    for (angle, slip, expected) in all {
        for (joint, head) in ways {
            let what = format!("{slip}, {joint} {head}");
            let text = dragged(angle, &scratched(slip, joint), head, DRAG);
            let rows = rows(&text, &what);
            let last = rows.last().expect("a row");
            assert_close(&what, shear_over_pressure(last), expected, 1e-5);
        }
    }
}

#[test]
fn a_floor_that_moves_past_all_the_time_carries_it_too() {
    let (sine, cosine) = 30.0_f64.to_radians().sin_cos();
    let steps = format!("{PRESS}[[step]]\nname = \"past\"\nsteady = {{}}\nincrements.fixed = 1\n");
    for (_, slip, expected) in cases().filter(|(angle, ..)| *angle == 30.0) {
        for rule in ["", "slip.regularised.epsilon = 0.02"] {
            let belt = format!("{rule}\nprimary-velocity = [{:?}, {:?}, 0]", -cosine, -sine);
            let text = dragged(30.0, &scratched(slip, &belt), "", &steps);
            let text = text.replace("[[0, 0], [1, 0], [2, 1]]", "[[0, 0], [9, 0]]");
            let rows = rows(&text, slip);
            let last = rows.last().expect("a row");
            assert_close(slip, shear_over_pressure(last), expected, 1e-8);
        }
    }
}

/// What wears off by the energy law is the energy times its coefficient, and the energy is that of the shear along the slip: the limit times the way would be more.
#[test]
fn friction_dissipates_and_wears_by_the_shear_along_the_slip() {
    let (sine, cosine) = 30.0_f64.to_radians().sin_cos();
    for (angle, slip, [first, second]) in cases().filter(|(angle, ..)| *angle == 30.0) {
        let wears = "wear.dissipated-energy = { coefficient = 1e-4 }";
        let text = dragged(angle, &scratched(slip, wears), "", DRAG);
        let rows = rows(&text, slip);
        let last = rows.last().expect("a row");
        let dissipated = of(last, "sole.ALLFD");
        let expected = -0.2 * (first * cosine + second * sine);
        // It is not known when the block began to slide in the first of eight increments.
        assert!(
            (dissipated / expected - 1.0).abs() < 2e-3,
            "{slip}: {dissipated} {expected}"
        );
        let worn = of(last, "sole.CWEARVOL");
        assert!(
            (worn / (1e-4 * dissipated) - 1.0).abs() < 1e-9,
            "{slip}: {worn}"
        );
        assert!(of(last, "ERESIDUAL").abs() < 1e-6 * dissipated, "{slip}");
    }
}

#[test]
fn equal_coefficients_are_coulombs_law_to_the_bit() {
    let bits = |friction: &str, joint: &str| -> Vec<Vec<u64>> {
        let text = dragged(30.0, &format!("{friction}\n{joint}"), "", DRAG);
        let rows = rows(&text, joint);
        let bits = |row: Row| row.values.iter().map(|v| v.to_bits()).collect();
        rows.into_iter().map(bits).collect()
    };
    for joint in [
        "",
        "slip.regularised.epsilon = 0.02",
        "enforcement.penalty = {}",
    ] {
        let coulomb = bits("friction.coulomb.mu = 0.3", joint);
        for slip in ["associated", "against-traction"] {
            let same = format!(
                "friction.orthotropic = {{ mu = [0.3, 0.3], axis = [1, 2, 0], slip = \"{slip}\" }}"
            );
            assert!(bits(&same, joint) == coulomb, "{joint} {slip}");
        }
    }
}

/// In the plane a point slides in one direction, and the coefficient is that of this direction.
#[test]
fn in_the_plane_the_coefficient_is_that_of_the_direction_of_slip() {
    let (first, second) = (0.3_f64, 0.1_f64);
    let root = 0.5_f64.sqrt();
    for (axis, slip, mu) in [
        ("[1, 0]", "associated", first),
        ("[0, 0, 1]", "associated", second),
        ("[1, 0, 1]", "associated", root * first.hypot(second)),
        (
            "[1, 0, 1]",
            "against-traction",
            1.0 / (root * (1.0 / first).hypot(1.0 / second)),
        ),
    ] {
        let text = support::dragged("automatic", ["[6, 2]", "[2, 2]", "1e5", "0.1", "2"]);
        let law = format!(
            "friction.orthotropic = {{ mu = [{first}, {second}], axis = {axis}, slip = \"{slip}\" }}"
        );
        let text = text.replace("friction.coulomb = { mu = 0.3 }", &law)
            + "[material.m.isotropic]\nyoung = 1e4\npoisson = 0.3\n"
            + DRAG;
        let rows = rows(&text, axis);
        let last = rows.last().expect("a row");
        let found = of(last, "press.CFS1").abs() / of(last, "press.CFN2").abs();
        assert!((found / mu - 1.0).abs() < 1e-6, "{axis} {slip}: {found}");
    }
}

/// Shear over pressure of a point that slides with a velocity, times gravity.
fn braking(v: [f64; 2], associated: bool) -> [f64; 2] {
    let speed = v[0].hypot(v[1]).max(f64::MIN_POSITIVE);
    let d = v.map(|v| v / speed);
    let [first, second] = MU;
    match associated {
        true => {
            let size = (first * d[0]).hypot(second * d[1]);
            [first * first * d[0], second * second * d[1]].map(|t| -9.81 * t / size)
        }
        false => {
            let size = (d[0] / first).hypot(d[1] / second);
            d.map(|d| -9.81 * d / size)
        }
    }
}

/// The way of a point that is pushed with an acceleration at 45 degrees for half a second and slides to rest, by Heun's rule. At rest it sets out in the direction in which it goes on.
fn slid(associated: bool) -> [f64; 2] {
    let h = 1e-5;
    let rate = |v: [f64; 2], push: f64| braking(v, associated).map(|t| t + push);
    // The direction at the start is that of its own acceleration.
    let mut v = [1e-9, 1e-9];
    for _ in 0..200 {
        let a = rate(v, 5.0);
        let size = a[0].hypot(a[1]);
        v = [0, 1].map(|i| 0.5 * v[i] + 0.5e-9 * a[i] / size);
    }
    let mut x = [0.0; 2];
    for k in 0..400_000 {
        let push = if k < 50_000 { 5.0 } else { 0.0 };
        if k > 50_000 && v[0].hypot(v[1]) < 1e-4 {
            break;
        }
        let a = rate(v, push);
        let b = rate([0, 1].map(|i| v[i] + h * a[i]), push);
        let next = [0, 1].map(|i| v[i] + 0.5 * h * (a[i] + b[i]));
        x = [0, 1].map(|i| x[i] + 0.5 * h * (v[i] + next[i]));
        v = next;
    }
    x
}

/// The block of the example: pushed at 45 degrees to the scratches it drifts across them by the associated rule, and not against the traction.
#[test]
fn a_block_that_is_pushed_drifts_as_a_point_does() {
    let text = include_str!("../../../../examples/scratched-floor/case.toml");
    let rule = |slip: &str| {
        let law = "axis = [1, 0, 0] }";
        assert!(text.contains(law));
        text.replace(law, &format!("axis = [1, 0, 0], slip = \"{slip}\" }}"))
    };
    for (slip, associated) in [("associated", true), ("against-traction", false)] {
        let expected = slid(associated);
        let drift = expected[1] / expected[0];
        assert!(if associated {
            drift > 4.0
        } else {
            (drift - 1.0).abs() < 1e-6
        });
        let implicit = rule(slip);
        let explicit = implicit
            .replace("\ndynamic = {}", "\ndynamic.scheme.central-difference = {}")
            .replace("increments = { initial", "# increments = { initial");
        assert!(implicit != explicit);
        let smooth = |text: &str| {
            let key = "primary = \"floor\"\n";
            text.replace(key, &format!("{key}slip.regularised.epsilon = 1e-3\n"))
        };
        let ways = [
            ("implicit", implicit.clone(), 4e-3),
            ("implicit, regularised", smooth(&implicit), 4e-3),
            ("explicit", explicit.clone(), 4e-3),
            ("explicit, regularised", smooth(&explicit), 4e-3),
        ];
        for (way, text, close) in ways {
            let what = format!("{slip}, {way}");
            let rows = rows(&text, &what);
            let last = rows.last().expect("a row");
            let found = ["corner.U1", "corner.U2"].map(|name| of(last, name));
            assert_close(&what, found, expected, close * expected[1]);
        }
    }
}

#[test]
fn an_analysis_on_ellipses_goes_on_from_a_checkpoint_with_the_same_bits() {
    for slip in ["associated", "against-traction"] {
        let text = dragged(60.0, &scratched(slip, ""), "", DRAG);
        restart::check(slip, &support::problem(&text), Path::new("."), 2);
    }
}

#[test]
fn what_is_wrong_with_the_axes_is_said() {
    for (law, says) in [
        ("mu = [0.3, 0.1]", "`axis` is missing"),
        (
            "mu = [0.3, 0.1], axis = [0, 0, 0]",
            "a vector of two or three finite components that has a direction",
        ),
        (
            "mu = [0.3, 0.1], axis = [0, 0, 1]",
            "normal to the surface at (0, 0, 0), and at 9 of its 9 points",
        ),
        (
            "mu = [0.3, 0.1], around = { centre = [0.5, 0.5], axis = [0, 0, 1] }",
            "at (0.5, 0.5, 0), and at 1 of its 9 points",
        ),
        (
            "mu = [0.3, 0.1], around = { axis = [0, 0] }",
            "has a direction",
        ),
        (
            "mu = [0.3, 0.1], axis = [1, 0, 0], around = { axis = [0, 0, 1] }",
            "remove one of them",
        ),
        (
            "mu = [0.3, 0], axis = [1, 0, 0], slip = \"against-traction\"",
            "larger than zero in both directions",
        ),
        ("mu = [-0.3, 0.1], axis = [1, 0, 0]", "must not be negative"),
    ] {
        let joint = format!("friction.orthotropic = {{ {law} }}");
        let said = support::complaint(&dragged(30.0, &joint, "", DRAG));
        assert!(said.contains(says), "{law}: {said}");
    }
}

/// A law that comes with a step is looked at like that of the interface.
#[test]
fn axes_of_a_law_that_comes_with_a_step_are_checked() {
    let change =
        "[[step]]\nchange.sole.friction.orthotropic = { mu = [0.3, 0.1], axis = [0, 0, 1] }\n";
    let steps = format!("{DRAG}\n{change}");
    let said = support::complaint(&dragged(30.0, "friction.coulomb.mu = 0.3", "", &steps));
    assert!(
        said.contains("normal to the surface") && said.contains("change.sole"),
        "{said}"
    );
    let along = steps.replace("axis = [0, 0, 1]", "axis = [1, 0, 0]");
    let text = dragged(30.0, "friction.coulomb.mu = 0.3", "", &along);
    let built = support::problem(&text).build(Path::new("."));
    assert!(built.is_ok(), "{:?}", built.err().map(|e| e.to_string()));
}

/// No friction across the scratches: what is left is that along them, and across the block slides freely.
#[test]
fn a_coefficient_may_be_zero_across_the_axis() {
    let joint = "friction.orthotropic = { mu = [0.3, 0], axis = [1, 0, 0] }";
    for rule in ["", "slip.regularised.epsilon = 0.02"] {
        let text = dragged(30.0, &format!("{joint}\n{rule}"), "", DRAG);
        let rows = rows(&text, rule);
        let last = rows.last().expect("a row");
        assert_close(rule, shear_over_pressure(last), [-0.3, 0.0], 1e-6);
    }
}

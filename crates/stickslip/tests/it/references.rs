//! Reference points: remote loads, what follows them and what they follow, masses at them, and what is refused.

use crate::support;
use support::{Record, complaint, problem, run};

const METHODS: [&str; 3] = ["sparse", "condensed", "multigrid"];

fn value(row: &support::Row, name: &str) -> f64 {
    row.get(name).unwrap_or_else(|| panic!("no column {name}"))
}

fn record(text: &str) -> Record {
    run(&problem(text)).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

/// Runs a problem and gives its last row.
fn end(text: &str) -> support::Row {
    record(text).increments.last().expect("a row").1.clone()
}

fn near(found: f64, expected: f64, tolerance: f64) {
    assert!(
        (found - expected).abs() <= tolerance,
        "{found} is not {expected}: {:e} apart",
        found - expected
    );
}

/// A bar along z, 1 by 1 by 4, held at its foot, and a point 2 above its middle.
fn bar(poisson: f64) -> String {
    format!(
        r#"
format = 1
model.space = "solid"
body.a = {{ generate.box = {{ to = [1, 1, 4], cells = [2, 2, 8] }}, material = "m", formulation = "incompatible-modes" }}
material.m.isotropic = {{ young = 1000.0, poisson = {poisson}, density = 1.0 }}
support.foot = {{ set = "a.bottom", x = 0, y = 0, z = 0 }}
reference.hub = {{ point = [0.5, 0.5, 6] }}
probe.tip = {{ of = "a", point = [0.5, 0.5, 4] }}
step = [{{ increments.fixed = 1 }}]
"#
    )
}

#[test]
fn a_force_and_a_torque_spread_over_a_surface() {
    for method in METHODS {
        let row = end(&format!(
            r#"{}
solver.method = "{method}"
coupling.spread.distributing = {{ set = "a.top", reference = "hub" }}
load.push = {{ set = "hub", nodal-force = {{ value = [0.3, -0.2, 4] }} }}
load.turn = {{ set = "hub", moment = {{ value = [0.1, 0.25, 0.5] }} }}
"#,
            bar(0.0)
        ));
        // What the foot bears: the force, and its moment seen at the base through the sum of forces.
        for (name, force) in [("foot.RF1", -0.3), ("foot.RF2", 0.2), ("foot.RF3", -4.0)] {
            near(value(&row, name), force, 1e-8 * 4.0);
        }
        // Pull: F l / E A.
        near(value(&row, "hub.U3"), 4.0 * 4.0 / 1000.0, 1e-9);
        // Bending about y by a force at an arm of 2 and a moment: the beam of Timoshenko, its end's rotation `F l² / 2 E I + M l / E I`.
        let inertia = 1.0 / 12.0;
        let about_y = 0.3 * 2.0 + 0.25;
        let turned = (0.3 * 8.0 + about_y * 4.0) / (1000.0 * inertia);
        near(value(&row, "hub.UR2"), turned, 0.01 * turned);
        near(value(&row, "hub.RF1"), 0.0, 0.0);
    }
}

/// What follows a held point rigidly carries what the foot does: force and moment balance to rounding.
#[test]
fn a_held_reference_point_bears_force_and_moment() {
    for method in METHODS {
        for kind in ["kinematic", "distributing"] {
            let text = format!(
                r#"{}
solver.method = "{method}"
coupling.grip.{kind} = {{ set = "a.top", reference = "hub" }}
support.hub = {{ set = "hub", x = 1e-3, y = 0, z = 2e-3, rotation-x = 0, rotation-y = 1e-3, rotation-z = 3e-3 }}
"#,
                bar(0.3).replace(
                    r#"support.foot = { set = "a.bottom", x = 0, y = 0, z = 0 }"#,
                    r#"
reference.base = { point = [0.5, 0.5, 0] }
coupling.base.kinematic = { set = "a.bottom", reference = "base" }
support.base = { set = "base", x = 0, y = 0, z = 0, rotation-x = 0, rotation-y = 0, rotation-z = 0 }
"#
                )
            );
            let row = end(&text);
            let get = |what: &str| -> [f64; 3] {
                std::array::from_fn(|i| value(&row, &format!("{what}{}", i + 1)))
            };
            let (top, foot) = (get("hub.RF"), get("base.RF"));
            let (top_m, foot_m) = (get("hub.RM"), get("base.RM"));
            let size = top.iter().fold(0.0_f64, |m, f| m.max(f.abs()));
            assert!(size > 0.1, "{size}");
            for i in 0..3 {
                near(top[i] + foot[i], 0.0, 1e-8 * size);
            }
            // About the base, 6 below.
            let moment = [
                top_m[0] + foot_m[0] - 6.0 * top[1],
                top_m[1] + foot_m[1] + 6.0 * top[0],
                top_m[2] + foot_m[2],
            ];
            moment.iter().for_each(|m| near(*m, 0.0, 1e-8 * 6.0 * size));
            near(value(&row, "hub.U3"), 2e-3, 1e-14);
            near(value(&row, "hub.UR3"), 3e-3, 1e-14);
            // The tip is where the point is rigid with it; its rotation has moved it by 2 along -x.
            if kind == "kinematic" {
                near(value(&row, "tip.U3"), 2e-3, 1e-11);
                near(value(&row, "tip.U1"), 1e-3 - 2.0 * 1e-3, 1e-11);
            }
        }
    }
}

/// Saint-Venant: a stiff cap turns a square bar by `T l / (0.1406 G a⁴)`, less what the warp that the ends lack stiffens.
#[test]
fn a_torque_on_what_follows_a_point_turns_a_bar() {
    let fine = bar(0.0).replace("[2, 2, 8]", "[6, 6, 6]");
    let row = end(&format!(
        r#"{fine}
coupling.cap.kinematic = {{ set = "a.top", reference = "hub", components = ["x", "y"] }}
load.turn = {{ set = "hub", moment = {{ value = [0, 0, 0.5] }} }}
"#
    ));
    let turned = 0.5 * 4.0 / (0.1406 * 500.0);
    near(value(&row, "hub.UR3"), turned, 0.1 * turned);
    near(value(&row, "hub.U1"), 0.0, 1e-9);
}

/// In the plane and around an axis, with springs and an equation at the point.
#[test]
fn springs_and_equations_hold_reference_points() {
    let plane = r#"
format = 1
model.space = "plane-stress"
body.a = { generate.rectangle = { to = [4, 1], cells = [8, 4] }, material = "m" }
material.m.isotropic = { young = 1000.0, poisson = 0.0 }
support.left = { set = "a.left", x = 0, y = 0 }
reference.hub = { point = [6, 0.5] }
coupling.spread.distributing = { set = "a.right", reference = "hub" }
load.pull = { set = "hub", nodal-force = { value = [5, 0] } }
step = [{ increments.fixed = 1 }]
"#;
    // a spring of 250 beside the bar's own 250
    for spring in [
        r#"load.spring = { set = "hub", spring = { stiffness = [250, 0] } }"#,
        r#"coupling.spring.spring = { terms = [{ set = "hub", component = "x" }], stiffness = 250 }"#,
    ] {
        for method in METHODS {
            let row = end(&format!("{plane}\n{spring}\nsolver.method = \"{method}\""));
            near(value(&row, "hub.U1"), 0.01, 1e-9);
        }
    }
    let row = end(&format!(
        r#"{plane}
load.turn = {{ set = "hub", moment = {{ value = [3] }} }}
coupling.spring.spring = {{ terms = [{{ set = "hub", component = "rotation-z" }}], stiffness = 1e9 }}
"#
    ));
    near(value(&row, "hub.UR3"), 0.0, 1e-8);
    near(value(&row, "spring.F"), 3.0, 1e-5);
    let around = end(r#"
format = 1
model.space = "axisymmetric"
body.a = { generate.rectangle = { to = [1, 4], cells = [4, 8] }, material = "m" }
material.m.isotropic = { young = 1000.0, poisson = 0.0 }
support.foot = { set = "a.bottom", y = 0 }
reference.hub = { point = [0, 5] }
coupling.spread.distributing = { set = "a.top", reference = "hub" }
load.pull = { set = "hub", nodal-force = { value = [0, 5] } }
step = [{ increments.fixed = 1 }]
"#);
    let stretched = 5.0 * 4.0 / (1000.0 * std::f64::consts::PI);
    near(value(&around, "hub.U2"), stretched, 1e-9);
}

/// A block that hangs by a point with a mass on a spring: the period is that of both masses on the spring, however the block is tied to the point and the
/// motion integrated.
#[test]
fn a_mass_at_a_reference_point_swings_with_its_period() {
    let schemes = [
        "scheme.newmark = {}",
        "scheme.generalised-alpha = {}",
        "scheme.central-difference = {}",
    ];
    for kind in ["kinematic", "distributing"] {
        for scheme in schemes {
            let omega = (250.0_f64 / (20.0 + 4.0)).sqrt();
            let period = std::f64::consts::TAU / omega;
            let increments = match scheme.contains("central") {
                true => "",
                false => "increments.fixed = 100, ",
            };
            let text = format!(
                r#"
format = 1
model.space = "plane-stress"
body.a = {{ generate.rectangle = {{ to = [4, 1], cells = [4, 2] }}, material = "m" }}
material.m.isotropic = {{ young = 1e5, poisson = 0.0, density = 1.0 }}
support.guide = {{ set = "a.bottom", y = 0 }}
reference.hub = {{ point = [5, 0.5], mass = 20, inertia = [3] }}
coupling.grip.{kind} = {{ set = "a.right", reference = "hub" }}
load.spring = {{ set = "hub", spring = {{ stiffness = [250, 0] }} }}
load.pull = {{ set = "hub", nodal-force = {{ value = [2.5, 0] }} }}
output.every = 0
step = [{{ duration = {}, {increments}dynamic = {{ {scheme} }} }}]
"#,
                0.5 * period
            );
            let record = record(&text);
            // From rest under a sudden force: after half a period at twice the rest, `2 F / k`.
            let row = &record.increments.last().expect("a row").1;
            let found = value(row, "hub.U1");
            assert!((found - 0.02).abs() < 2e-4, "{kind} {scheme}: {found}");
            near(
                value(row, "ERESIDUAL"),
                0.0,
                1e-3 * value(row, "ALLWK").abs(),
            );
            // Forces of the supports: none on the point.
            near(value(row, "hub.RF1"), 0.0, 0.0);
        }
    }
}

/// Nothing holds the block but the base that it is pressed on through a point, and the point's own supports.
#[test]
fn a_block_is_pressed_on_a_base_through_a_reference_point() {
    let two = r#"
format = 1
model.space = "plane-strain"
body.base = { generate.rectangle = { from = [-1, -1], to = [3, 0], cells = [8, 2] }, material = "m" }
body.block = { generate.rectangle = { to = [2, 1], cells = [4, 2] }, material = "m" }
material.m.isotropic = { young = 1e4, poisson = 0.3 }
support.base = { set = "base.bottom", x = 0, y = 0 }
interface.press = { secondary = "block.bottom", primary = "base.top", friction.coulomb = { mu = 0.3 } }
reference.hub = { point = [1, 2] }
load.push = { set = "hub", nodal-force = { value = [1, -10] } }
step = [{ increments.fixed = 2 }]
"#;
    for kind in ["kinematic", "distributing"] {
        for method in METHODS {
            let row = end(&format!(
                "{two}\nsolver.method = \"{method}\"\ncoupling.grip.{kind} = {{ set = \"block.top\", reference = \"hub\" }}"
            ));
            // The surface turns a little, and friction with it.
            let whole = |c: &str| {
                value(&row, &format!("press.CFN{c}")) + value(&row, &format!("press.CFS{c}"))
            };
            near(whole("2"), 10.0, 1e-7);
            near(whole("1"), -1.0, 1e-7);
        }
    }
}

/// What a free point is tied to is as free as before: `check` and the run say so.
#[test]
fn a_body_that_only_a_free_point_holds_is_free() {
    for kind in ["kinematic", "distributing"] {
        let text = format!(
            "{}\ncoupling.grip.{kind} = {{ set = \"a.top\", reference = \"hub\" }}\nload.pull = {{ set = \"hub\", nodal-force = {{ value = [0, 0, 1] }} }}",
            bar(0.0).replace("x = 0, y = 0, z = 0", "x = 0, y = 0")
        );
        let error = run(&problem(&text)).expect_err("free to move").to_string();
        assert!(
            error.contains("free to move as a rigid body (translation z)"),
            "{error}"
        );
        assert!(error.contains("load.pull"), "{error}");
    }
}

#[test]
fn what_has_no_meaning_is_refused() {
    let said = |more: &str| complaint(&format!("{}\n{more}", bar(0.0)));
    let spread = r#"coupling.spread.distributing = { set = "a.top", reference = "hub" }"#;
    let wrong = [
        (
            r#"load.turn = { set = "hub", moment = { value = [0, 0, 1] } }"#,
            "nothing resists",
        ),
        (
            r#"load.turn = { set = "a.top", moment = { value = [0, 0, 1] } }"#,
            "cannot turn",
        ),
        (
            r#"support.turn = { set = "a.top", rotation-x = 0 }"#,
            "cannot turn",
        ),
        (
            r#"load.p = { set = "hub", pressure = { value = 1 } }"#,
            "reference point",
        ),
        (
            r#"coupling.b.kinematic = { set = "a.top", reference = "a" }"#,
            "no reference point",
        ),
        (r#"reference.a = { point = [0, 0, 0] }"#, "already"),
        (r#"reference.b = { point = [0, 0] }"#, "3 components"),
        (
            r#"reference.b = { point = [0, 0, 0], inertia = [1, 1, 1, 5, 0, 0] }"#,
            "not those of a body",
        ),
    ];
    for (text, expected) in wrong {
        let found = said(text);
        assert!(found.contains(expected), "{text}: {found}");
    }
    let grip = r#"coupling.grip.kinematic = { set = "a.top", reference = "hub" }"#;
    let explicit = format!("{}\n{grip}", bar(0.0)).replace(
        "increments.fixed = 1",
        "dynamic = { scheme.central-difference = {} }",
    );
    let found = complaint(&explicit);
    assert!(found.contains("has no mass"), "{found}");
    // Points on a line do not turn about it.
    let line = r#"
set.edge = { of = "a.top", plane = { point = [0, 0, 4], normal = [1, 0, 0] } }
coupling.spread.distributing = { set = "edge", reference = "hub", weights = "uniform" }
load.turn = { set = "hub", moment = { value = [0, 1, 0] } }
"#;
    let found = said(line);
    assert!(found.contains("rotation about y"), "{found}");
    problem(&format!("{}\n{spread}", bar(0.0)));
}

/// A beam whose end moves as one: tied to a reference point without mass, that does not turn, or by equations to a corner; pulled there in these steps.
fn ended(referred: bool, steps: &str) -> String {
    let (tie, at) = match referred {
        true => (
            "reference.r.point = [5, 0.5]\ncoupling.k.kinematic = { reference = \"r\", set = \"b.right\" }\nsupport.turn = { set = \"r\", rotation-z = 0 }",
            "r",
        ),
        false => (
            "set.corner = { of = \"b\", point = [4, 0] }\nset.rest = { of = \"b.right\", box = { from = [4, 0.1], to = [4, 1] } }\ncoupling.x.equation = { terms = [{ set = \"rest\", component = \"x\" }, { set = \"corner\", component = \"x\", factor = -1 }] }\ncoupling.y.equation = { terms = [{ set = \"rest\", component = \"y\" }, { set = \"corner\", component = \"y\", factor = -1 }] }",
            "corner",
        ),
    };
    format!(
        r#"
format = 1
model.space = "plane-strain"
solver.method = "sparse"
quality.gate = "off"
body.b = {{ generate.rectangle = {{ to = [4, 1], cells = [8, 4] }}, material = "m", rayleigh = {{ mass = 0, stiffness = 1e-3 }} }}
material.m.isotropic = {{ young = 1000.0, poisson = 0.3, density = 1.0 }}
support.wall = {{ set = "b.left", x = 0, y = 0 }}
{tie}
load.pull = {{ set = "{at}", nodal-force.value = [0.5, 1] }}
probe.tip = {{ of = "b", point = [4, 0.5] }}
{steps}
"#
    )
}

const STILL: &str = "[[step]]\nincrements.fixed = 1\n";

fn moving(loads: &str, scheme: &str) -> String {
    format!(
        "[[step]]\nduration = 1\n{loads}\ndynamic = {{ scheme.{scheme} = {{}} }}\nincrements.fixed = 40\n"
    )
}

#[test]
fn a_reference_point_without_mass_goes_with_what_it_is_tied_to() {
    let ways = [
        ["tip.U1", "r.U1"],
        ["tip.U2", "r.U2"],
        ["tip.V1", "tip.V1"],
        ["tip.V2", "tip.V2"],
        ["tip.A2", "tip.A2"],
    ];
    for scheme in ["newmark", "hht", "generalised-alpha"] {
        // let go of, and pulled at once
        for steps in [
            STILL.to_string() + &moving("loads = []", scheme),
            moving("", scheme),
        ] {
            let [with, without] = [true, false].map(|referred| {
                let text = ended(referred, &steps);
                let record = support::run(&support::problem(&text));
                record.unwrap_or_else(|e| panic!("{e}\n{text}")).increments
            });
            assert_eq!(with.len(), without.len());
            for [name, own] in ways {
                let column = |rows: &[(Vec<_>, support::Row)], name: &str| -> Vec<f64> {
                    rows.iter()
                        .map(|(_, r)| r.get(name).expect("a column"))
                        .collect()
                };
                let expected = column(&without, name);
                let largest = expected.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
                assert!(largest > 0.0);
                for found in [column(&with, name), column(&with, own)] {
                    for (a, b) in found.iter().zip(&expected) {
                        assert!((a - b).abs() < 1e-6 * largest, "{scheme} {name}: {a} {b}");
                    }
                }
            }
        }
    }
}

#[test]
fn what_a_load_on_a_reference_point_holds_still_stays_still_in_motion() {
    let text = ended(true, &(STILL.to_string() + &moving("", "newmark")));
    let text = text.replace("support.turn = { set = \"r\", rotation-z = 0 }", "");
    let rows = support::run(&support::problem(&text))
        .expect("it runs")
        .increments;
    let at = |row: &support::Row, name: &str| row.get(name).expect("a column");
    let rest = at(&rows[0].1, "tip.U2");
    assert!(rest > 0.0);
    for (_, row) in &rows[1..] {
        assert!((at(row, "tip.U2") - rest).abs() < 1e-9 * rest);
        assert!(at(row, "tip.V2").abs() < 1e-7 * rest);
    }
}

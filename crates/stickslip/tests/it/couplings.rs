//! Equations between displacements and springs between points, alone and beside contact; masses at points, spinning bodies, laws that change.

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

/// Two bars one above the other, each 4 long and 1 high, not in touch, without lateral contraction: in tension each is a spring of `E / 4`.
const BARS: &str = r#"
format = 1
model.space = "plane-stress"
body.a = { generate.rectangle = { to = [4, 1], cells = [8, 2] }, material = "m" }
body.b = { generate.rectangle = { from = [0, 3], to = [4, 4], cells = [8, 2] }, material = "m" }
material.m.isotropic = { young = 1000.0, poisson = 0.0, density = 1.0 }
support.a = { set = "a.left", x = 0 }
support.b = { set = "b.left", x = 0 }
support.sides = { set = "ends", y = 0 }
set.ends = { union = ["a.bottom", "b.bottom"] }
load.pull = { set = "a.right", traction = { value = [8, 0] } }
probe.a = { of = "a", point = [4, 0.5] }
probe.b = { of = "b", point = [4, 3.5] }
"#;

#[test]
fn an_equation_makes_two_bars_move_as_one_whatever_the_method() {
    for method in METHODS {
        let row = end(&format!(
            r#"{BARS}
solver.method = "{method}"
coupling.join.equation = {{ terms = [
    {{ set = "a.right", component = "x" }},
    {{ set = "b.right", component = "x", factor = -1 }},
] }}
step = [{{ increments.fixed = 2 }}]
"#
        ));
        // 8 on two springs of 250 side by side
        let u = 8.0 / 500.0;
        near(value(&row, "a.U1"), u, 1e-9 * u);
        near(value(&row, "b.U1"), value(&row, "a.U1"), 1e-10 * u);
        // Half of the load goes through the equations, and the support of each bar has a half.
        near(value(&row, "join.F"), 4.0, 1e-7);
        near(value(&row, "join.U"), 0.0, 1e-10 * u);
        near(value(&row, "a.RF1"), -4.0, 1e-7);
        near(value(&row, "b.RF1"), -4.0, 1e-7);
        near(value(&row, "ALLSE"), 0.5 * 8.0 * u, 1e-9);
        near(value(&row, "ERESIDUAL"), 0.0, 1e-9);
    }
}

#[test]
fn an_equation_with_a_value_does_work_and_reactions_of_its_points_stay_right() {
    for method in ["sparse", "condensed"] {
        let row = end(&format!(
            r#"{BARS}
solver.method = "{method}"
support.held = {{ set = "b.right", x = 0.001 }}
coupling.apart.equation = {{ terms = [
    {{ set = "a.right", component = "x", factor = 2 }},
    {{ set = "b.right", component = "x", factor = -1 }},
], value = 0.01 }}
step = [{{ increments.fixed = 3 }}]
"#
        ));
        // 2 u_a - u_b = 0.01
        let u = 0.5 * 0.011;
        near(value(&row, "a.U1"), u, 1e-12);
        let force = (8.0 - 250.0 * u) / 2.0;
        near(value(&row, "apart.F"), force, 1e-6);
        near(value(&row, "b.RF1"), -0.25, 1e-6);
        near(value(&row, "held.RF1"), 0.25 - force, 1e-6);
        let strain = 0.5 * 250.0 * (u * u + 1e-6);
        near(value(&row, "ALLSE"), strain, 1e-9);
        near(value(&row, "ERESIDUAL"), 0.0, 1e-9);
    }
}

#[test]
fn a_slanted_support_is_an_equation_of_two_components() {
    // A block that slides along a support at 30 degrees moves as one in a frame that is turned.
    let (s, c) = (30.0_f64.to_radians().sin(), 30.0_f64.to_radians().cos());
    let row = end(&format!(
        r#"
format = 1
model.space = "plane-strain"
body.a = {{ generate.rectangle = {{ to = [1, 1], cells = [3, 3] }}, material = "m" }}
material.m.isotropic = {{ young = 1000.0, poisson = 0.3 }}
load.push = {{ set = "a", spring = {{ stiffness = [10, 10] }} }}
load.right = {{ set = "a", body-force = {{ value = [1, 0] }} }}
coupling.slope.equation = {{ terms = [
    {{ set = "a", component = "x", factor = {} }},
    {{ set = "a", component = "y", factor = {c} }},
] }}
probe.p = {{ of = "a", point = [1, 0] }}
step = [{{}}]
"#,
        -s
    ));
    // 16 springs, and of the load what acts along the slope; not uniform, as springs are at points and the load is not
    let along = value(&row, "p.U1") * c + value(&row, "p.U2") * s;
    near(along, c / 160.0, 0.05 * c / 160.0);
    near(value(&row, "p.U2"), value(&row, "p.U1") * s / c, 1e-12);
}

#[test]
fn springs_share_a_load_by_their_stiffness_and_their_energy_counts() {
    for method in METHODS {
        let row = end(&format!(
            r#"{BARS}
solver.method = "{method}"
set.ta = {{ of = "a", point = [4, 0.5] }}
set.tb = {{ of = "b", point = [4, 3.5] }}
set.a1 = {{ of = "a", point = [4, 0] }}
set.a2 = {{ of = "a", point = [4, 1] }}
set.b1 = {{ of = "b", point = [4, 3] }}
set.b2 = {{ of = "b", point = [4, 4] }}
set.corners-a = {{ union = ["a1", "a2"] }}
set.corners-b = {{ union = ["b1", "b2"] }}
# straight ends, so that a spring at a point pulls at all of an end
coupling.end-a.equation = {{ terms = [{{ set = "corners-a", component = "x" }}, {{ set = "ta", component = "x", factor = -1 }}] }}
coupling.end-b.equation = {{ terms = [{{ set = "corners-b", component = "x" }}, {{ set = "tb", component = "x", factor = -1 }}] }}
coupling.between.spring = {{ stiffness = 500.0, terms = [
    {{ set = "ta", component = "x" }}, {{ set = "tb", component = "x", factor = -1 }},
] }}
coupling.ground.spring = {{ stiffness = 50.0, terms = [{{ set = "tb", component = "x" }}] }}
step = [{{ increments.fixed = 2 }}]
"#
        ));
        // The end of `a` on its bar; through the spring to the end of `b` on its bar and the ground.
        let (bar, between, ground) = (250.0, 500.0, 50.0);
        let far = bar + ground;
        let series = between * far / (between + far);
        let a = 8.0 / (bar + series);
        let b = a * between / (between + far);
        near(value(&row, "a.U1"), a, 1e-9);
        near(value(&row, "b.U1"), b, 1e-9);
        near(value(&row, "between.F"), between * (a - b), 1e-6);
        near(value(&row, "ground.F"), ground * b, 1e-6);
        near(value(&row, "ALLSE"), 0.5 * 8.0 * a, 1e-8);
        near(value(&row, "ERESIDUAL"), 0.0, 1e-9);
    }
}

/// Two blocks side by side that move along x only.
const BLOCKS: &str = r#"
format = 1
model.space = "plane-stress"
body.a = { generate.rectangle = { to = [1, 1], cells = [2, 2] }, material = "m" }
body.b = { generate.rectangle = { from = [0, 3], to = [1, 4], cells = [2, 2] }, material = "m" }
material.m.isotropic = { young = 1000.0, poisson = 0.0, density = 2.0 }
support.rails = { set = "all", y = 0 }
set.all = { union = ["a", "b"] }
probe.a = { of = "a", point = [1, 0.5] }
probe.b = { of = "b", point = [1, 3.5] }
output.every = 0
"#;

/// One of them is pushed, and both are joined.
const JOINED: &str = r#"
load.push = { set = "a", body-force = { value = [8, 0] } }
coupling.join.equation = { terms = [
    { set = "a", component = "x" },
    { set = "b", component = "x", factor = -1 },
] }
"#;

#[test]
fn what_an_equation_joins_is_accelerated_as_one() {
    for method in ["sparse", "condensed"] {
        for scheme in ["newmark", "generalised-alpha"] {
            let row = end(&format!(
                r#"{BLOCKS}{JOINED}
solver.method = "{method}"
step = [{{ duration = 0.5, increments.fixed = 9, dynamic = {{ scheme.{scheme} = {{}} }} }}]
"#
            ));
            // half of 8 over a density of 2
            for block in ["a", "b"] {
                near(value(&row, &format!("{block}.A1")), 2.0, 1e-7);
                near(value(&row, &format!("{block}.V1")), 1.0, 1e-8);
                near(value(&row, &format!("{block}.U1")), 0.25, 1e-8);
            }
            near(value(&row, "join.F"), 4.0, 1e-6);
            near(value(&row, "ERESIDUAL"), 0.0, 1e-8);
        }
    }
}

#[test]
fn in_explicit_steps_equations_hold_and_energies_close() {
    let record = record(&format!(
        r#"{BLOCKS}{JOINED}
step = [
    {{ duration = 0.5, dynamic = {{ scheme.central-difference = {{}} }} }},
    {{ duration = 0.5, dynamic = {{}}, increments.fixed = 20 }},
]
"#
    ));
    let row = &record.increments.last().expect("a row").1;
    let join = value(row, "a.U1") - value(row, "b.U1");
    near(join, 0.0, 1e-12);
    near(value(row, "b.U1"), 1.0, 1e-2);
    let supplied = value(row, "ALLWK");
    near(value(row, "ERESIDUAL"), 0.0, 1e-6 * supplied);
}

#[test]
fn a_mass_on_a_spring_swings_at_its_frequency() {
    // Block `a` of mass 2 against block `b` of mass 2 by a spring: two masses about their centre, (k/m)(1 + 1).
    for (scheme, error) in [("newmark", 2e-3), ("central-difference", 1e-3)] {
        let increments = match scheme {
            "newmark" => "increments.fixed = 200,",
            _ => "",
        };
        let k = 8.0_f64;
        let period = std::f64::consts::TAU / (k / 2.0 * 2.0).sqrt();
        let row = end(&format!(
            r#"{BLOCKS}
initial.throw = {{ set = "a", velocity = [1, 0] }}
coupling.join.spring = {{ stiffness = {}, terms = [
    {{ set = "a", component = "x" }},
    {{ set = "b", component = "x", factor = -1 }},
] }}
step = [{{ duration = {}, {increments} dynamic = {{ scheme.{scheme} = {{}} }} }}]
"#,
            k / 9.0,
            0.25 * period,
        ));
        // After a quarter of a period both have the velocity of their centre, and half of the energy is in the springs.
        near(value(&row, "ALLKE"), 0.5, 1e-2);
        near(value(&row, "ALLSE"), 0.5, 1e-2);
        let apart = value(&row, "a.U1") - value(&row, "b.U1");
        near(apart, 1.0 / k.sqrt(), error + 2e-2);
        near(value(&row, "ERESIDUAL"), 0.0, 1e-8);
    }
}

/// A block on a rigid floor, pressed down and pulled by an axial spring whose far end a slider moves; `u` multiplies lengths, `p` stresses.
fn dragged([u, p]: [f64; 2], method: &str) -> String {
    format!(
        r#"
format = 1
model.space = "plane-stress"
model.thickness = {u:?}
solver.method = "{method}"
body.block = {{ generate.rectangle = {{ to = [{l2:?}, {u:?}], cells = [8, 4] }}, material = "m" }}
body.slider = {{ generate.rectangle = {{ from = [{l4:?}, 0], to = [{l5:?}, {u:?}], cells = [2, 2] }}, material = "m" }}
material.m.isotropic = {{ young = {young:?}, poisson = 0.3 }}
obstacle.floor.plane = {{ point = [0, 0], normal = [0, 1] }}
set.top = {{ of = "block", point = [{u:?}, {u:?}] }}
set.hook = {{ of = "block", point = [{l2:?}, {half:?}] }}
set.eye = {{ of = "slider", point = [{l4:?}, {half:?}] }}
load.press = {{ set = "block.top", pressure = {{ value = {press:?} }} }}
support.slider = {{ set = "slider", x = {way:?}, y = 0, amplitude = "drag" }}
amplitude.drag.table = [[0, 0], [1, 0], [2, 1]]
# the upper side of the block stays level
coupling.level.equation = {{ terms = [
    {{ set = "block.top", component = "y" }},
    {{ set = "top", component = "y", factor = -1 }},
] }}
coupling.pull.axial-spring = {{ from = "hook", to = "eye", stiffness = {k:?} }}
interface.base = {{ secondary = "block.bottom", primary = "floor", friction.coulomb = {{ mu = 0.25 }} }}
probe.top = {{ of = "block", point = [{u:?}, {u:?}] }}
probe.edge = {{ of = "block", point = [0, {u:?}] }}
[[step]]
increments.fixed = 2
[[step]]
increments.fixed = 5
"#,
        l2 = 2.0 * u,
        l4 = 4.0 * u,
        l5 = 5.0 * u,
        half = 0.5 * u,
        young = 1e9 * p,
        press = 1e6 * p,
        way = 0.01 * u,
        k = 1e8 * p * u,
    )
}

#[test]
fn couplings_beside_contact_and_friction_are_the_same_for_all_methods_and_units() {
    let sparse = record(&dragged([1.0, 1.0], "sparse"));
    let condensed = record(&dragged([1.0, 1.0], "condensed"));
    // Other units whose ratio is a power of two leave rounding as it is, of which the last digits of a linear solution hang.
    let (length, stress) = (1024.0, 1.0 / 1_048_576.0);
    let smaller = record(&dragged([length, stress], "sparse"));
    let last = |r: &Record| r.increments.last().expect("a row").1.clone();
    let row = last(&sparse);
    // The block slides: the spring carries the limit of friction.
    near(value(&row, "pull.F"), 0.25 * 2e6, 1.0);
    near(value(&row, "base.CFS1"), -0.25 * 2e6, 1.0);
    near(value(&row, "edge.U2"), value(&row, "top.U2"), 1e-12);
    near(value(&row, "ERESIDUAL"), 0.0, 1e-2 * value(&row, "ALLSE"));
    for other in [last(&condensed), last(&smaller)] {
        let scale = value(&other, "top.U1") / value(&row, "top.U1");
        assert!(
            (scale - 1.0).abs() < 1e-6 || (scale / length - 1.0).abs() < 1e-6,
            "{scale}"
        );
    }
    let iterations = |r: &Record| r.increments.iter().map(|i| i.0.len()).collect::<Vec<_>>();
    assert_eq!(iterations(&sparse), iterations(&smaller));
}

#[test]
fn an_equation_of_a_later_step_starts_from_where_points_are_and_lets_go_gently() {
    let record = record(&format!(
        r#"{BARS}
coupling.join.equation = {{ terms = [
    {{ set = "a.right", component = "x" }},
    {{ set = "b.right", component = "x", factor = -1 }},
] }}
[[step]]
couplings = []
increments.fixed = 1
[[step]]
increments.fixed = 2
[[step]]
couplings = []
increments.fixed = 2
"#
    ));
    let u: Vec<[f64; 2]> = record
        .increments
        .iter()
        .map(|(_, row)| [value(row, "a.U1"), value(row, "b.U1")])
        .collect();
    let (free, joined) = (8.0 / 250.0, 8.0 / 500.0);
    let expected = [
        [free, 0.0],
        // half way to where they are as far as each other
        [0.75 * free, 0.25 * free],
        [joined, joined],
        [0.75 * free, 0.25 * free],
        [free, 0.0],
    ];
    for (found, expected) in u.iter().zip(expected) {
        near(found[0], expected[0], 1e-9);
        near(found[1], expected[1], 1e-9);
    }
    for (_, row) in &record.increments {
        near(value(row, "ERESIDUAL"), 0.0, 1e-9);
    }
}

#[test]
fn a_body_that_only_equations_hold_is_held_in_space() {
    for method in ["sparse", "condensed"] {
        let row = end(&format!(
            r#"
format = 1
model.space = "solid"
solver.method = "{method}"
body.a = {{ generate.box = {{ to = [1, 1, 1], cells = [2, 2, 2] }}, material = "m" }}
body.b = {{ generate.box = {{ from = [3, 0, 0], to = [4, 1, 1], cells = [2, 2, 2] }}, material = "m" }}
material.m.isotropic = {{ young = 1000.0, poisson = 0.3 }}
support.wall = {{ set = "a.left", x = 0, y = 0, z = 0 }}
load.pull = {{ set = "b.right", traction = {{ value = [1, 2, 3] }} }}
coupling.x.equation = {{ terms = [{{ set = "b.left", component = "x" }}, {{ set = "a.right", component = "x", factor = -1 }}] }}
coupling.y.equation = {{ terms = [{{ set = "b.left", component = "y" }}, {{ set = "a.right", component = "y", factor = -1 }}] }}
coupling.z.equation = {{ terms = [{{ set = "b.left", component = "z" }}, {{ set = "a.right", component = "z", factor = -1 }}] }}
probe.p = {{ of = "b", point = [4, 1, 1] }}
probe.q = {{ of = "b", point = [3, 1, 1] }}
probe.r = {{ of = "a", point = [1, 1, 1] }}
step = [{{}}]
"#
        ));
        for c in 1..4 {
            let size = value(&row, &format!("p.U{c}")).abs();
            let apart = value(&row, &format!("q.U{c}")) - value(&row, &format!("r.U{c}"));
            assert!(size > 1e-4);
            near(apart, 0.0, 1e-10 * size);
            near(value(&row, &format!("wall.RF{c}")), -(c as f64), 1e-6);
        }
        near(value(&row, "ALLSE"), value(&row, "ALLWK"), 1e-9);
    }
}

#[test]
fn equations_hold_points_of_rigid_bodies_with_their_rotation() {
    for method in ["sparse", "condensed"] {
        let row = end(&format!(
            r#"
format = 1
model.space = "plane-strain"
solver.method = "{method}"
body.a = {{ generate.rectangle = {{ to = [2, 1], cells = [2, 1] }}, material = "m", rigid = true }}
material.m.isotropic = {{ young = 1000.0, poisson = 0.3, density = 1.0 }}
set.left = {{ of = "a", point = [0, 0] }}
set.right = {{ of = "a", point = [2, 0] }}
set.above = {{ of = "a", point = [2, 1] }}
load.up = {{ set = "right", nodal-force = {{ value = [0, 1] }} }}
coupling.pin-x.equation = {{ terms = [{{ set = "left", component = "x" }}] }}
coupling.pin-y.equation = {{ terms = [{{ set = "left", component = "y" }}] }}
coupling.strut.spring = {{ stiffness = 100.0, terms = [{{ set = "above", component = "y" }}] }}
probe.left = {{ of = "a", point = [0, 0] }}
probe.right = {{ of = "a", point = [2, 0] }}
probe.above = {{ of = "a", point = [2, 1] }}
step = [{{}}]
"#
        ));
        near(value(&row, "right.U2"), 0.01, 1e-9);
        near(value(&row, "above.U1"), -0.005, 1e-9);
        near(value(&row, "left.U1"), 0.0, 1e-12);
        near(value(&row, "left.U2"), 0.0, 1e-12);
        near(value(&row, "strut.F"), 1.0, 1e-7);
        near(value(&row, "pin-y.F"), 0.0, 1e-7);
    }
}

#[test]
fn what_is_wrong_with_a_coupling_is_said_with_its_place() {
    let with = |coupling: &str| complaint(&format!("{BARS}coupling.c.{coupling}\nstep = [{{}}]\n"));
    let cases = [
        (
            r#"equation = { terms = [{ set = "a.right", component = "z" }] }"#,
            "a displacement along z in a plane model",
        ),
        (
            r#"equation = { terms = [{ set = "a.rihgt", component = "x" }] }"#,
            "a.rihgt",
        ),
        (
            r#"equation = { terms = [{ set = "a.right", component = "x" }, { set = "b.top", component = "x" }] }"#,
            "`a.right` has 3 points, another set of the coupling 9",
        ),
        (
            r#"equation = { terms = [{ set = "a.right", component = "x" }, { set = "a.right", component = "x", factor = -1 }] }"#,
            "without terms",
        ),
        (
            r#"spring = { stiffness = 0, terms = [{ set = "a.right", component = "x" }] }"#,
            "stiffness",
        ),
        (
            r#"axial-spring = { stiffness = 1, from = "a.right", to = "a.right" }"#,
            "lie at the same place",
        ),
        (
            r#"equation = { value = 1, terms = [{ set = "a.left", component = "x" }] }"#,
            "coupling c: all displacements of an equation are prescribed",
        ),
    ];
    for (coupling, expected) in cases {
        let said = with(coupling);
        assert!(said.contains(expected), "{said}");
    }
}

#[test]
fn a_bar_that_turns_about_its_end_is_stretched_as_the_formula_says() {
    // ρ = 1, E = 1000, ω = 3, length 4; without lateral contraction nodes are exact
    let (rho, young, omega, l) = (1.0, 1000.0, 3.0_f64, 4.0_f64);
    let bar = BARS.split("load.pull").next().expect("a text");
    for (mass, extra) in [
        ("", 0.0),
        ("mass.tip = { set = \"a.right\", mass = 0.5 }", 1.5),
    ] {
        let row = end(&format!(
            r#"{bar}{mass}
support.flat = {{ set = "a", y = 0 }}
load.spin = {{ set = "a", centrifugal = {{ speed = {omega}, point = [0, 0.5] }} }}
probe.a = {{ of = "a", point = [4, 0.5] }}
step = [{{}}]
"#
        ));
        let own = rho * omega.powi(2) * l.powi(3) / (3.0 * young);
        let tip = extra * omega.powi(2) * l * l / young;
        let u = value(&row, "a.U1");
        // three equal masses at the corners and the middle of an end that is one cell high each
        near(
            u,
            own + tip,
            if extra > 0.0 { 0.05 * tip } else { 1e-9 * own },
        );
        let pull = omega.powi(2) * (rho * l * l / 2.0 + extra * l);
        near(value(&row, "a.RF1"), -pull, 1e-8 * pull);
    }
}

#[test]
fn centrifugal_force_in_space_and_about_the_axis_of_symmetry() {
    let cube = |load: &str, space: &str, body: &str| {
        format!(
            r#"
format = 1
model.space = "{space}"
body.a = {{ {body}, material = "m" }}
material.m.isotropic = {{ young = 1000.0, poisson = 0.3, density = 2.0 }}
support.all = {{ set = "a", x = 0, y = 0{} }}
load.spin = {{ set = "a", centrifugal = {{ {load} }} }}
step = [{{}}]
"#,
            if space == "solid" { ", z = 0" } else { "" }
        )
    };
    // mass 2 with its centre at (1.5, 0.5, 0.5), axis through (0, 0, 7) along z, and along (1, 1, 0)
    let block = "generate.box = { from = [1, 0, 0], to = [2, 1, 1], cells = [2, 1, 1] }";
    let row = end(&cube(
        "speed = 2, point = [0, 0, 7], axis = [0, 0, 3]",
        "solid",
        block,
    ));
    for (c, r) in [1.5, 0.5, 0.0].into_iter().enumerate() {
        near(
            value(&row, &format!("all.RF{}", c + 1)),
            -2.0 * 4.0 * r,
            1e-10,
        );
    }
    let row = end(&cube("speed = 2, axis = [1, 1, 0]", "solid", block));
    for (c, r) in [0.5, -0.5, 0.5].into_iter().enumerate() {
        near(
            value(&row, &format!("all.RF{}", c + 1)),
            -2.0 * 4.0 * r,
            1e-10,
        );
    }
    // ∫ ρ ω² r 2π r dr over a ring from 1 to 2, one high
    let ring = "generate.rectangle = { from = [1, 0], to = [2, 1], cells = [3, 1] }";
    let row = end(&cube("speed = 2", "axisymmetric", ring));
    let radial = 2.0 * 4.0 * std::f64::consts::TAU * 7.0 / 3.0;
    near(value(&row, "all.RF1"), -radial, 1e-10 * radial);
    near(value(&row, "all.RF2"), 0.0, 1e-10);
    let said = complaint(&cube("speed = 2", "solid", block));
    assert!(said.contains("without an axis"), "{said}");
}

#[test]
fn a_point_mass_has_inertia_and_weight() {
    let body = r#"
set.corner = { of = "a", point = [0, 0] }
mass.engine = { set = "corner", mass = 6.0 }
coupling.stiff.equation = { terms = [{ set = "a", component = "x" }, { set = "corner", component = "x", factor = -1 }] }
"#;
    for (scheme, error) in [("newmark", 1e-8), ("central-difference", 3e-2)] {
        let fixed = match scheme {
            "newmark" => "increments.fixed = 6,",
            _ => "",
        };
        let row = end(&format!(
            r#"{BLOCKS}{body}
load.push = {{ set = "a", body-force = {{ value = [8, 0] }} }}
step = [{{ duration = 2, {fixed} dynamic = {{ scheme.{scheme} = {{}} }} }}]
"#
        ));
        // 8 on a mass of 2 + 6
        near(value(&row, "a.V1"), 2.0, 2.0 * error);
        near(value(&row, "a.U1"), 2.0, 2.0 * error);
        near(value(&row, "ALLKE"), 0.5 * 8.0 * 4.0, 32.0 * error);
        near(value(&row, "ERESIDUAL"), 0.0, 1e-6);
    }
    let row = end(&format!(
        r#"{BLOCKS}{body}
support.post = {{ set = "corner", x = 0 }}
support.other = {{ set = "b", x = 0 }}
load.weight = {{ set = "a", gravity = {{ acceleration = [-10, 0] }} }}
step = [{{}}]
"#
    ));
    near(value(&row, "post.RF1"), 80.0, 1e-6);
}

#[test]
fn friction_and_normal_law_change_with_a_step_and_history_stays() {
    for method in ["sparse", "condensed"] {
        let text = dragged([1.0, 1.0], method);
        let text = text.replace(
            "table = [[0, 0], [1, 0], [2, 1]]",
            "table = [[0, 0], [1, 0], [2, 1], [4, 2]]",
        );
        let record = record(&format!(
            r#"{text}
[[step]]
increments.fixed = 4
change.base.friction.coulomb = {{ mu = 0.1 }}
[[step]]
increments.fixed = 2
change.base.normal.linear = {{ c = 1e10 }}
"#
        ));
        let rows: Vec<&support::Row> = record.increments.iter().map(|(_, row)| row).collect();
        let shear = |i: usize| value(rows[i], "base.CFS1").abs();
        near(shear(6), 0.25 * 2e6, 1.0);
        for (i, row) in rows.iter().enumerate().skip(7) {
            near(shear(i), 0.1 * 2e6, 1.0);
            near(value(row, "base.CFN2"), 2e6, 1.0);
        }
        // The last law lets the surface in.
        let sink = value(rows[12], "top.U2") - value(rows[10], "top.U2");
        assert!(sink < -0.5e-4, "{sink}");
    }
    let said = complaint(&format!(
        "{}[[step]]\nchange.bace.friction.coulomb = {{ mu = 0.1 }}\n",
        dragged([1.0, 1.0], "sparse")
    ));
    assert!(
        said.contains("`bace` is not among the interfaces"),
        "{said}"
    );
    let said = complaint(&format!(
        "{}[[step]]\nchange.base.friction.coulomb = {{ mu = -0.1 }}\n",
        dragged([1.0, 1.0], "sparse")
    ));
    assert!(said.contains("mu"), "{said}");
}

#[test]
fn an_exponential_surface_yields_by_the_logarithm_of_the_pressure() {
    for (pressure, method) in [(2e6, "sparse"), (2e7, "condensed"), (2e9, "sparse")] {
        let row = end(&format!(
            r#"
format = 1
model.space = "plane-stress"
solver.method = "{method}"
body.block = {{ generate.rectangle = {{ to = [1, 1], cells = [3, 2] }}, material = "m" }}
material.m.isotropic = {{ young = 1e12, poisson = 0.0 }}
obstacle.floor.plane = {{ point = [0, 0], normal = [0, 1] }}
support.rail = {{ set = "block", x = 0 }}
load.press = {{ set = "block.top", pressure = {{ value = {pressure:?} }} }}
interface.base = {{ secondary = "block.bottom", primary = "floor", normal.exponential = {{ c0 = 1e-4, p0 = 1e7 }} }}
probe.low = {{ of = "block", point = [0.3333333333, 0] }}
step = [{{ increments.fixed = 20 }}]
"#
        ));
        let gap = -1e-4 * (pressure / 1e7_f64).ln() / 100.0_f64.ln();
        near(value(&row, "low.U2"), gap, 1e-9);
        near(value(&row, "base.CFN2"), pressure, 1e-6 * pressure);
        let energy = value(&row, "ALLSE") + value(&row, "ALLCE");
        near(value(&row, "ERESIDUAL"), 0.0, 0.02 * energy);
    }
}

#[test]
fn a_spring_on_a_reference_point_is_one_however_it_is_given() {
    let run = |spring: &str| -> f64 {
        let text = format!(
            r#"
format = 1
model.space = "plane-strain"
body.follower = {{ generate.rectangle = {{ from = [-0.04, 0.05], to = [0.04, 0.06], cells = [16, 4] }}, material = "m" }}
material.m.isotropic = {{ young = 2e11, poisson = 0.3, density = 7800 }}
obstacle.disc.cylinder = {{ centre = [0.01, 0], radius = 0.05 }}
interface.c = {{ secondary = "follower.bottom", primary = "disc" }}
reference.stem.point = [0, 0.06]
coupling.stem.kinematic = {{ reference = "stem", set = "follower.top" }}
support.stem = {{ set = "stem", x = 0, rotation-z = 0 }}
load.press = {{ set = "stem", nodal-force.value = [0, -1000.0] }}
step = [{{ increments.fixed = 2 }}]
{spring}
"#
        );
        let mut simulation =
            support::build(&support::problem(&text)).unwrap_or_else(|e| panic!("{e}"));
        simulation.run(&mut []).unwrap_or_else(|e| panic!("{e}"));
        simulation.summary.last["c.CFN2"]
    };
    // The disc is far stiffer: it bears the force, whatever the spring.
    for stiffness in [1e-3, 1.0, 1e3, 1e6] {
        let load = run(&format!(
            r#"load.soft = {{ set = "stem", spring.stiffness = [0, {stiffness:?}] }}"#
        ));
        let coupling = run(&format!(
            r#"coupling.soft.spring = {{ stiffness = {stiffness:?}, terms = [{{ set = "stem", component = "y" }}] }}"#
        ));
        assert!(
            (load / coupling - 1.0).abs() < 1e-9,
            "{stiffness}: {load} {coupling}"
        );
        assert!((load / 1000.0 - 1.0).abs() < 1e-2, "{stiffness}: {load}");
    }
}

#[test]
fn what_holds_in_an_explicit_step_does_not_hang_on_where_the_model_lies() {
    // A reference point that holds the mean of a surface: factors of its equations that should be zero are rounding, and are other ones elsewhere.
    let history = |[x, y]: [f64; 2]| {
        let text = format!(
            r#"format = 1
model.space = "plane-strain"
body.b = {{ generate.rectangle = {{ from = [{}, {y}], to = [{}, {}], cells = [3, 2], element = "quad8" }}, material = "m" }}
material.m.isotropic = {{ young = 2.8e7, poisson = 0.29, density = 0.69 }}
obstacle.floor.plane = {{ point = [{x}, {y}], normal = [0, 1] }}
interface.joint = {{ secondary = "b.bottom", primary = "floor", friction.coulomb.mu = 0.33 }}
reference.head = {{ point = [{x}, {}], mass = 3e-5, inertia = [3.6e-10] }}
coupling.head.distributing = {{ reference = "head", set = "b.top" }}
support.head = {{ set = "head", x = 0, y = -6e-5, rotation-z = 0, amplitude = "press" }}
amplitude.press.table = [[0, 0], [4e-6, 1]]
load.side = {{ set = "b.right", traction.value = [-5000, 2500], amplitude = "press" }}
step = [{{ duration = 4e-6, increments.fixed = 2 }}, {{ duration = 4e-6, dynamic.scheme.central-difference = {{}} }}]
"#,
            x - 7.55e-3,
            x + 7.55e-3,
            y + 6.8856e-3,
            y + 6.8856e-3
        );
        record(&text).increments
    };
    let (here, there) = (history([0.0, 0.0]), history([4.53e-2, 4.53e-2]));
    assert!(here.len() > 20 && here.len() == there.len());
    for ((_, a), (_, b)) in here.iter().zip(&there) {
        for (name, scale) in [("head.RF1", 1e3), ("joint.CFN2", 1e3), ("ALLSE", 1e-2)] {
            near(value(b, name), value(a, name), 1e-6 * scale);
        }
    }
    // Equations go on with the forces that they had at rest.
    let forces = |k: usize| value(&here[k].1, "head.RF2");
    near(forces(2), forces(1), 0.02 * forces(1).abs());
}

/// A column that falls over: whole, of two tied blocks, and of two that equations hold together. Lumped masses add up, so that all three are the same problem.
#[test]
fn what_holds_two_bodies_together_in_explicit_steps_makes_them_one() {
    let end = |bodies: &str, top: &str, joint: &str| {
        end(&format!(
            r#"format = 1
model.space = "plane-strain"
{bodies}
material.m.isotropic = {{ young = 1e6, poisson = 0.3, density = 1 }}
{joint}
support.base = {{ set = "a.bottom", x = 0, y = 0 }}
load.push = {{ set = "{top}.top", traction.value = [100, -300] }}
probe.top = {{ of = "{top}", point = [1, 4] }}
step = [{{ duration = 8e-3, increments.fixed = 200, dynamic.scheme.central-difference = {{}} }}]
"#
        ))
    };
    let body = |name: &str, [from, to]: [f64; 2], cells: usize| {
        format!(
            "body.{name} = {{ generate.rectangle = {{ from = [0, {from}], to = [1, {to}], cells = [3, {cells}] }}, material = \"m\" }}\n"
        )
    };
    let whole = end(&body("a", [0.0, 4.0], 8), "a", "");
    let both = body("a", [0.0, 2.0], 4) + &body("b", [2.0, 4.0], 4);
    let tied = "interface.tie = { secondary = \"b.bottom\", primary = \"a.top\", tied = true }";
    let equal = |c: &str| {
        let terms = format!(
            "{{ set = \"a.top\", component = \"{c}\" }}, {{ set = \"b.bottom\", component = \"{c}\", factor = -1 }}"
        );
        format!("coupling.{c}.equation.terms = [{terms}]\n")
    };
    let moved = value(&whole, "top.U1");
    assert!(moved.abs() > 1e-3);
    for joint in [
        tied,
        &tied.replace(" }", ", discretisation.node-to-facet = {} }"),
        &(equal("x") + &equal("y")),
    ] {
        let row = end(&both, "b", joint);
        for name in ["top.U1", "top.U2"] {
            near(value(&row, name), value(&whole, name), 1e-9 * moved.abs());
        }
        for name in ["ALLSE", "ALLKE", "ALLWK", "ERESIDUAL"] {
            near(
                value(&row, name),
                value(&whole, name),
                1e-9 * value(&whole, "ALLWK"),
            );
        }
    }
}

/// Two rigid squares, glued face to face, of which one is thrown and spins: what they do together follows from the angular momentum about their common centre, `1/2 + 3/6` at `5/6`.
#[test]
fn tied_rigid_bodies_turn_as_one_in_explicit_steps() {
    let row = end(r#"format = 1
model = { space = "plane-stress", thickness = 1 }
body.a = { generate.rectangle = { to = [1, 1], cells = [2, 2] }, material = "m", rigid = true, rotation = "large" }
body.b = { generate.rectangle = { from = [0, 1], to = [1, 2], cells = [3, 3] }, material = "m", rigid = true, rotation = "large" }
material.m.isotropic = { young = 1e6, poisson = 0.3, density = 1 }
interface.tie = { secondary = "b.bottom", primary = "a.top", tied = true }
initial.throw = { set = "a", velocity = [1, 0], spin = [3] }
quality.scheme-dissipation = inf
step = [{ duration = 2, increments.fixed = 2000, dynamic.scheme.central-difference = {} }]
"#);
    for body in ["a", "b"] {
        near(value(&row, &format!("{body}.UR3")), 2.4, 1e-5);
        near(value(&row, &format!("{body}.VR3")), 1.2, 1e-5);
    }
    near(value(&row, "a.V1") + value(&row, "b.V1"), 1.0, 1e-12);
    near(value(&row, "a.V2") + value(&row, "b.V2"), 0.0, 1e-12);
    // What two masses that are joined at once lose, `1/2 + 9/12 - 0.85`, the scheme enters.
    near(value(&row, "ALLKE"), 0.85, 1e-5);
    near(value(&row, "ERESIDUAL"), 0.0, 2e-3);
}

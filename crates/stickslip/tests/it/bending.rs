//! Bodies that turn cell by cell (`rotation = "corotational"`): bars that bend as the elastica has it, which is integrated here as an ordinary differential equation.

use std::path::Path;

use crate::restart;
use crate::support::{self, Record};

fn run(text: &str) -> Record {
    let mut record = Record::default();
    let problem = support::problem(text);
    let mut simulation = support::build(&problem).unwrap_or_else(|e| panic!("{e}\n{text}"));
    let outcome = simulation.run(&mut [&mut record]);
    outcome.unwrap_or_else(|e| panic!("{e}\n{text}"));
    record
}

fn last(record: &Record, name: &str) -> f64 {
    let (_, row) = record.increments.last().expect("an increment");
    row.get(name).unwrap_or_else(|| panic!("no column {name}"))
}

const LENGTH: f64 = 10.0;
const HEIGHT: f64 = 0.1;
const YOUNG: f64 = 1.2e6;

/// `E I`, of a strip of thickness 1 in plane stress.
const STIFFNESS: f64 = YOUNG * HEIGHT * HEIGHT * HEIGHT / 12.0;

/// A strip along x that is clamped at its left end.
fn strip(cells: usize, rotation: &str, rest: &str) -> String {
    format!(
        r#"
        format = 1
        model.space = "plane-stress"
        [body.strip]
        material = "m"
        rotation = "{rotation}"
        formulation = "incompatible-modes"
        generate.rectangle = {{ to = [{LENGTH}, {HEIGHT}], cells = [{cells}, 1] }}
        [material.m]
        isotropic = {{ young = {YOUNG}, poisson = 0 }}
        [probe.tip]
        point = [{LENGTH}, 0]
        [probe.top]
        point = [{LENGTH}, {HEIGHT}]
        {rest}
        "#
    )
}

const CLAMP: &str = r#"
    [support.root]
    set = "strip.left"
    x = 0
    y = 0
"#;

/// The middle of the right end.
fn tip(record: &Record) -> [f64; 2] {
    ["U1", "U2"]
        .map(|u| 0.5 * (last(record, &format!("tip.{u}")) + last(record, &format!("top.{u}"))))
}

/// What acts on a rod: a force at its tip that keeps its direction `[N]`, and a force along its normal per length, which turns with it `[N/m]`.
#[derive(Clone, Copy)]
struct Acting {
    tip: [f64; 2],
    pressure: f64,
}

/// The clamped inextensible rod along x, from the tip back, where it stands at `angle` and has no moment. Returns the angle at the root, which is zero for the right
/// `angle`, and the displacement of the tip.
fn backwards(acting: Acting, angle: f64) -> (f64, [f64; 2]) {
    // θ, moment, way from here to the tip, and the force on all that lies there.
    let slope = |y: &[f64; 6]| {
        let (sin, cos) = y[0].sin_cos();
        let q = acting.pressure;
        let across = y[5] * cos - y[4] * sin;
        [-y[1] / STIFFNESS, across, cos, sin, -q * sin, q * cos]
    };
    let (n, mut y) = (2000, [angle, 0.0, 0.0, 0.0, acting.tip[0], acting.tip[1]]);
    let h = LENGTH / f64::from(n);
    for _ in 0..n {
        let moved = |k: &[f64; 6], h: f64| -> [f64; 6] { std::array::from_fn(|i| y[i] + h * k[i]) };
        let k1 = slope(&y);
        let k2 = slope(&moved(&k1, 0.5 * h));
        let k3 = slope(&moved(&k2, 0.5 * h));
        let k4 = slope(&moved(&k3, h));
        y = std::array::from_fn(|i| y[i] + h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]));
    }
    (y[0], [y[2] - LENGTH, y[3]])
}

/// The displacement of its tip.
fn elastica(acting: Acting) -> [f64; 2] {
    let (mut low, mut high) = (0.0, 2.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        match backwards(acting, middle).0 < 0.0 {
            true => low = middle,
            false => high = middle,
        }
    }
    backwards(acting, 0.5 * (low + high)).1
}

/// Runs a strip under loads and holds it against the elastica; returns what was run.
fn compare(cells: usize, loads: &str, acting: Acting, tolerance: f64) -> Record {
    let steps = "[[step]]\nincrements = { initial = 0.25 }";
    let record = run(&strip(
        cells,
        "corotational",
        &format!("{CLAMP}{loads}{steps}"),
    ));
    let (found, wanted) = (tip(&record), elastica(acting));
    for (found, wanted) in found.iter().zip(wanted) {
        let off = (found - wanted).abs() / LENGTH;
        assert!(off < tolerance, "{loads}: {found} for {wanted}");
    }
    record
}

/// A force across the tip of so many times `E I / L²`, and the load of the problem file.
fn across(load: f64) -> (Acting, String) {
    let force = load * STIFFNESS / (LENGTH * LENGTH);
    let text = format!(
        "[load.tip]\nset = \"strip.right\"\ntraction.value = [0, {}]\n",
        force / HEIGHT
    );
    let tip = [0.0, force];
    (Acting { tip, pressure: 0.0 }, text)
}

#[test]
fn a_cantilever_bends_as_the_elastica() {
    for load in [1.0, 4.0] {
        let (acting, text) = across(load);
        let record = compare(40, &text, acting, 1e-3);
        // The linear theory, P L³ / 3 E I, is nowhere near.
        assert!((tip(&record)[1] - load * LENGTH / 3.0).abs() > 0.03 * LENGTH);
        // What is stored has been done, but for the trapezoidal rule over the increments.
        let (stored, work) = (last(&record, "ALLSE"), last(&record, "ALLWK"));
        assert!((stored / work - 1.0).abs() < 0.02, "{stored} {work}");
    }
}

#[test]
fn a_pressure_follows_the_faces_it_presses_on() {
    let pressure = 5.0 * STIFFNESS / LENGTH.powi(3);
    let faces = [("bottom", 0.5 * pressure), ("top", -0.5 * pressure)];
    let load = |(face, value): (&str, f64)| {
        format!("[load.{face}]\nset = \"strip.{face}\"\npressure.value = {value}\n")
    };
    let acting = Acting {
        tip: [0.0; 2],
        pressure,
    };
    compare(40, &faces.map(load).concat(), acting, 1e-3);
}

#[test]
fn the_error_of_cells_that_bend_falls_with_the_square_of_their_size() {
    let (acting, text) = across(4.0);
    let off = |cells: usize| {
        let record = compare(cells, &text, acting, 0.2);
        (tip(&record)[1] - elastica(acting)[1]).abs()
    };
    let (coarse, fine) = (off(6), off(12));
    assert!(fine < 0.35 * coarse, "{coarse} {fine}");
}

#[test]
fn a_bar_that_is_turned_by_its_end_is_not_strained() {
    // The left end goes round by three quarters of a turn, each of its points along axes of space.
    let count = 24;
    let angle = |k: usize| 1.5 * std::f64::consts::PI * k as f64 / count as f64;
    let table = |of: &dyn Fn(f64) -> f64| {
        let rows = (0..=count).map(|k| format!("[{}, {}]", k as f64 / count as f64, of(angle(k))));
        rows.collect::<Vec<_>>().join(", ")
    };
    let record = run(&format!(
        r#"
        format = 1
        model.space = "plane-strain"
        [body.bar]
        material = "m"
        rotation = "corotational"
        generate.rectangle = {{ to = [3, 1], cells = [6, 2] }}
        [material.m]
        isotropic = {{ young = 1e6, poisson = 0.3 }}
        [amplitude.sine]
        table = [{}]
        [amplitude.versine]
        table = [{}]
        [support.low]
        set = "bar.bottom-left"
        x = 0
        y = 0
        [support.high-x]
        set = "bar.top-left"
        x = -1
        amplitude = "sine"
        [support.high-y]
        set = "bar.top-left"
        y = -1
        amplitude = "versine"
        [probe.far]
        point = [3, 1]
        [[step]]
        increments = {{ fixed = {count} }}
        "#,
        table(&|a: f64| a.sin()),
        table(&|a: f64| 1.0 - a.cos()),
    ));
    // From (3, 1), a turn by -90° leads to (1, -3).
    let found = ["far.U1", "far.U2"].map(|u| last(&record, u));
    assert!(
        (found[0] + 2.0).abs() < 1e-6 && (found[1] + 4.0).abs() < 1e-6,
        "{found:?}"
    );
    assert!(last(&record, "ALLSE") < 1e-9 * 1e6);
}

#[test]
fn runs_with_bodies_that_bend_go_on_where_they_stopped() {
    // Bent over a peg, on which the strip slides, and let go; a pressure follows its faces.
    let (_, tip) = across(4.0);
    let rest = format!(
        r#"
        {CLAMP}{tip}
        amplitude = "bend"
        [load.top]
        set = "strip.top"
        pressure.value = {}
        amplitude = "bend"
        [amplitude.bend]
        table = [[0, 0], [1, 1], [2, 0.3]]
        [obstacle.peg]
        cylinder = {{ centre = [6, 1.2], radius = 1 }}
        [interface.peg]
        secondary = "strip.top"
        primary = "peg"
        normal.linear.c = 1e6
        friction.coulomb.mu = 0.3
        [[step]]
        increments = {{ initial = 0.25 }}
        [[step]]
        increments.fixed = 4
        "#,
        0.5 * STIFFNESS / LENGTH.powi(3)
    );
    let text = strip(20, "corotational", &rest);
    let record = run(&text);
    let pressed = record.increments.iter();
    let pressed = pressed.filter(|(_, row)| row.get("peg.CFN2").unwrap_or(0.0) != 0.0);
    assert!(pressed.count() > 2, "it never touches");
    restart::check("strip", &support::problem(&text), Path::new("."), 4);
}

/// Two blocks that are pressed on each other and then turned as one by an angle in each step, by what supports prescribe for their far ends.
fn turned_as_one(angle: f64, turns: usize) -> String {
    let mut text = r#"format = 1
model.space = "plane-strain"
body.lower = { generate.rectangle = { from = [-1, -0.5], to = [1, 0], cells = [5, 2] }, material = "m", formulation = "incompatible-modes", rotation = "corotational" }
body.upper = { generate.rectangle = { from = [-0.6, 0], to = [0.6, 0.9], cells = [7, 3] }, material = "m", formulation = "incompatible-modes", rotation = "corotational" }
material.m.isotropic = { young = 4000, poisson = 0.3 }
interface.joint = { secondary = "upper.bottom", primary = "lower.top", friction.coulomb.mu = 0.3 }
"#
    .to_string();
    let lower = (0..=5).map(|k| [-1.0 + 0.4 * f64::from(k), -0.5]);
    let upper = (0..=7).map(|k| [-0.6 + 1.2 / 7.0 * f64::from(k), 0.9]);
    let held = lower
        .map(|x| (x, "lower", 0.0))
        .chain(upper.map(|x| (x, "upper", -4e-3)));
    let mut steps = vec![String::new(); turns + 1];
    for (p, (x, body, way)) in held.enumerate() {
        text += &format!("set.q{p} = {{ of = \"{body}\", point = {x:?} }}\n");
        for (k, list) in steps.iter_mut().enumerate() {
            let (s, c) = (k as f64 * angle).sin_cos();
            let y = x[1] + way;
            let moved = [c * x[0] - s * y - x[0], s * x[0] + c * y - x[1]];
            text += &format!(
                "support.s{k}-{p} = {{ set = \"q{p}\", x = {}, y = {} }}\n",
                moved[0], moved[1]
            );
            list.push_str(&format!("\"s{k}-{p}\", "));
        }
    }
    let steps: Vec<String> = (steps.iter())
        .map(|list| format!("{{ increments.fixed = 1, supports = [{list}] }}"))
        .collect();
    text + &format!("step = [{}]\n", steps.join(", "))
}

#[test]
fn what_supports_turn_is_expected_to_turn_with_them() {
    let record = run(&turned_as_one(0.19, 3));
    let all = &record.increments;
    assert_eq!((all.len(), record.cutbacks), (4, 0));
    let force = |row: &support::Row| {
        let of = |name: &str| row.get(name).expect("a force");
        of("joint.CFN1").hypot(of("joint.CFN2"))
    };
    let pressed = force(&all[0].1);
    for (_, row) in &all[1..] {
        // The turned state is a solution, and next to nothing is to be done to it.
        assert!(
            (force(row) / pressed - 1.0).abs() < 1e-6,
            "{} for {pressed}",
            force(row)
        );
        assert_eq!(row.get("SLIP"), Some(0.0));
        let iterations = row.get("ITRS").expect("a count");
        assert!(iterations <= 8.0, "{iterations}");
    }
}

/// A strip that is clamped at its left end, and a block whose left edge presses it down near the other. Roles as named.
fn edge_on_strip(sides: [&str; 2]) -> String {
    format!(
        r#"format = 1
model.space = "plane-stress"
body.strip = {{ generate.rectangle = {{ to = [10, 0.5], cells = [20, 2] }}, material = "s", formulation = "incompatible-modes", rotation = "corotational" }}
body.block = {{ generate.rectangle = {{ from = [8.4, 0.5], to = [9.4, 1], cells = [2, 1] }}, material = "h", formulation = "incompatible-modes", rotation = "corotational" }}
material.s.isotropic = {{ young = 200000, poisson = 0.3 }}
material.h.isotropic = {{ young = 2000000, poisson = 0.3 }}
interface.i = {{ secondary = "{}", primary = "{}", normal.linear.c = 1e6, roles = "as-named" }}
support.fix = {{ set = "strip.left", x = 0, y = 0 }}
support.push = {{ set = "block.top", x = 0, y = -1 }}
step = [{{ increments.fixed = 10 }}]
"#,
        sides[0], sides[1]
    )
}

#[test]
fn an_edge_of_the_primary_presses_along_the_normal_of_what_it_presses() {
    let force = |sides: [&str; 2]| {
        let record = run(&edge_on_strip(sides));
        ["i.CFN1", "i.CFN2"].map(|name| last(&record, name))
    };
    // The elastica with shear and axial strain has (1.84, 10.26) on the block.
    let [x, y] = force(["strip.top", "block.bottom"]);
    assert!((x / -1.84 - 1.0).abs() < 0.05, "{x}");
    assert!((y / -10.26 - 1.0).abs() < 0.03, "{y}");
    let [x, y] = force(["block.bottom", "strip.top"]);
    assert!((x / 1.84 - 1.0).abs() < 0.05, "{x}");
    assert!((y / 10.26 - 1.0).abs() < 0.03, "{y}");
}

//! Temperatures that are given: against closed forms, in every kind of step, and what is refused.

use crate::support;
use support::{Row, complaint, problem, run};

const METHODS: [&str; 3] = ["sparse", "condensed", "multigrid"];

fn value(row: &Row, name: &str) -> f64 {
    row.get(name).unwrap_or_else(|| panic!("no column {name}"))
}

/// All rows of a run.
fn rows(text: &str) -> Vec<Row> {
    let record = run(&problem(text)).unwrap_or_else(|e| panic!("{e}\n{text}"));
    record.increments.into_iter().map(|(_, row)| row).collect()
}

fn end(text: &str) -> Row {
    rows(text).pop().expect("a row")
}

fn near(found: f64, expected: f64, tolerance: f64) {
    assert!(
        (found - expected).abs() <= tolerance * expected.abs(),
        "{found} is not {expected}: {:e} apart",
        found / expected - 1.0
    );
}

/// A bar of steel, 0.2 long and 0.1 high, that starts at 20.
fn bar(space: &str, formulation: &str) -> String {
    format!(
        r#"
format = 1
model.space = "{space}"
body.bar = {{ generate.rectangle = {{ from = [0, 0], to = [0.2, 0.1], cells = [4, 2] }}, material = "steel", formulation = "{formulation}" }}
material.steel = {{ isotropic = {{ young = 200e9, poisson = 0.3, density = 7800 }}, expansion = 12e-6 }}
initial.room = {{ set = "bar", temperature.uniform = {{ value = 20 }} }}
temperature.hot = {{ set = "bar", uniform = {{ value = 120 }} }}
probe.end = {{ point = [0.2, 0.1] }}
"#
    )
}

#[test]
fn a_bar_between_walls_is_pressed_by_what_it_would_expand() {
    let stress = -200e9 * 12e-6 * 100.0;
    for (space, formulation, across) in [
        ("plane-stress", "standard", 0.0),
        ("plane-stress", "incompatible-modes", 0.0),
        ("plane-stress", "reduced", 0.0),
        // Held along the bar and across the plane: σ = -E α ΔT / (1 - ν).
        ("plane-strain", "standard", 1.0),
        ("plane-strain", "mean-dilatation", 1.0),
    ] {
        for method in METHODS {
            let row = end(&format!(
                r#"{}
solver.method = "{method}"
support.walls = {{ set = "sides", x = 0 }}
support.floor = {{ set = "bar.bottom", y = 0 }}
set.sides = {{ union = ["bar.left", "bar.right"] }}
step = [{{ increments.fixed = 2 }}]
"#,
                bar(space, formulation)
            ));
            let whole = stress / (1.0 - 0.3 * across);
            near(value(&row, "end.S11"), whole, 1e-7);
            let size = whole.abs();
            let wall = value(&row, "end.S33") + across * size;
            assert!(wall.abs() < 1e-7 * size, "{wall}");
            assert!(value(&row, "end.S22").abs() < 1e-7 * size);
            // ½ σ ε over all, and nothing is left of the balance.
            let energy = 0.5 * whole * whole * (1.0 - 0.3 * across) / 200e9 * 0.02 * (1.0 + across);
            near(value(&row, "ALLSE"), energy, 1e-7);
            near(value(&row, "ALLWK"), energy, 1e-7);
            assert!(value(&row, "ERESIDUAL").abs() < 1e-7 * energy);
        }
    }
}

#[test]
fn a_body_that_is_free_grows_without_stress_and_keeps_its_quality() {
    for space in ["plane-stress", "axisymmetric"] {
        let supports = match space {
            "axisymmetric" => "support.y = { set = \"bar.bottom\", y = 0 }",
            _ => {
                "support.y = { set = \"bar.bottom\", y = 0 }\nsupport.x = { set = \"bar.left\", x = 0 }"
            }
        };
        let text = format!("{}{supports}\nstep = [{{}}]\n", bar(space, "standard"));
        let mut simulation = support::build(&problem(&text)).expect("sound");
        simulation.run(&mut []).expect("runs");
        let summary = &simulation.summary;
        assert!(summary.quality.met && summary.balance.energy_quality.met);
        let row = end(&text);
        near(value(&row, "end.U1"), 12e-6 * 100.0 * 0.2, 1e-9);
        near(value(&row, "end.U2"), 12e-6 * 100.0 * 0.1, 1e-9);
        for stress in ["end.S11", "end.S22", "end.S33", "end.S12"] {
            assert!(value(&row, stress).abs() < 1e-9 * 240e6, "{stress}");
        }
    }
}

/// Two strips, one on the other, of thicknesses 0.4 and 0.6.
#[test]
fn a_bimetal_strip_bends_as_timoshenko_says() {
    let (t, e, alpha, rise, length) = ([0.4, 0.6], [100e3, 200e3], [20e-6, 12e-6], 50.0, 20.0);
    let text = r#"
format = 1
model.space = "plane-stress"
body.upper = { generate.rectangle = { from = [0, 0.6], to = [20, 1.0], cells = [40, 2] }, material = "brass", formulation = "incompatible-modes" }
body.lower = { generate.rectangle = { from = [0, 0], to = [20, 0.6], cells = [40, 2] }, material = "steel", formulation = "incompatible-modes" }
material.brass = { isotropic = { young = 100e3, poisson = 0.3 }, expansion = 20e-6 }
material.steel = { isotropic = { young = 200e3, poisson = 0.3 }, expansion = 12e-6 }
interface.weld = { secondary = "upper.bottom", primary = "lower.top", tied = true }
temperature.hot = { set = "all", uniform = { value = 50 } }
set.all = { union = ["upper", "lower"] }
set.corner = { of = "lower", point = [0, 0] }
set.end = { union = ["upper.left", "lower.left"] }
support.end = { set = "end", x = 0 }
support.corner = { set = "corner", y = 0 }
probe.tip = { of = "lower", point = [20, 0] }
probe.root = { of = "lower", point = [0, 0] }
step = [{}]
"#;
    let row = end(text);
    let (m, n) = (t[0] / t[1], e[0] / e[1]);
    let curvature = 6.0 * (alpha[0] - alpha[1]) * rise * (1.0_f64 + m).powi(2)
        / (3.0 * (1.0_f64 + m).powi(2) + (1.0 + m * n) * (m * m + 1.0 / (m * n)));
    let tip = value(&row, "tip.U2") - value(&row, "root.U2");
    near(tip, -0.5 * curvature * length * length, 5e-3);
}

/// The integral of `T r` from `a` to `r`, for a temperature that falls linearly from `t` at `a` to nothing at `b`.
fn moment(r: f64, a: f64, b: f64, t: f64) -> f64 {
    let of = |r: f64| t / (b - a) * (0.5 * b * r * r - r * r * r / 3.0);
    of(r) - of(a)
}

#[test]
fn a_ring_that_is_hot_inside_has_the_stresses_of_the_closed_form() {
    let (a, b, hot, young, nu, alpha) = (1.0, 2.0, 100.0, 200e3, 0.3, 12e-6);
    let text = r#"
format = 1
model.space = "axisymmetric"
body.ring = { generate.rectangle = { from = [1, 0], to = [2, 0.1], cells = [20, 1], element = "quad8" }, material = "steel" }
material.steel = { isotropic = { young = 200e3, poisson = 0.3 }, expansion = 12e-6 }
temperature.hot = { set = "ring", radial = { table = [[1, 100], [2, 0]] } }
set.ends = { union = ["ring.bottom", "ring.top"] }
support.ends = { set = "ends", y = 0 }
probe.inner = { point = [1, 0] }
probe.middle = { point = [1.5, 0] }
probe.outer = { point = [2, 0] }
step = [{}]
"#;
    let row = end(text);
    let all = moment(b, a, b, hot);
    let factor = alpha * young / (1.0 - nu);
    for (name, r) in [("inner", a), ("middle", 1.5), ("outer", b)] {
        let (part, t) = (moment(r, a, b, hot), hot * (b - r) / (b - a));
        let square = b * b - a * a;
        let hoop = factor / (r * r) * ((r * r + a * a) / square * all + part - t * r * r);
        let radial = factor / (r * r) * ((r * r - a * a) / square * all - part);
        let largest = factor * hot;
        assert!(
            (value(&row, &format!("{name}.S33")) - hoop).abs() < 6e-3 * largest,
            "{name}"
        );
        assert!(
            (value(&row, &format!("{name}.S11")) - radial).abs() < 6e-3 * largest,
            "{name}"
        );
        let axial = nu * (hoop + radial) - alpha * young * t;
        assert!(
            (value(&row, &format!("{name}.S22")) - axial).abs() < 6e-3 * largest,
            "{name}"
        );
        let free = (1.0 + nu) / (1.0 - nu) * alpha / r;
        let u = free * (part + ((1.0 - 2.0 * nu) * r * r + a * a) / square * all);
        near(value(&row, &format!("{name}.U1")), u, 1e-3);
    }
}

/// A shaft of radius 1 in a hub from there to 2, thin discs, and what else is said.
fn fit(hub: &str, initial: &str, rest: &str) -> Row {
    end(&format!(
        r#"
format = 1
model.space = "axisymmetric"
body.shaft = {{ generate.rectangle = {{ from = [0, 0], to = [1, 0.2], cells = [16, 2] }}, material = "steel" }}
body.hub = {{ generate.rectangle = {{ from = [{hub}, 0], to = [2, 0.2], cells = [24, 2] }}, material = "steel" }}
material.steel = {{ isotropic = {{ young = 200e3, poisson = 0.3 }}, expansion = 12e-6 }}
interface.fit = {{ secondary = "shaft.right", primary = "hub.left"{initial} }}
set.floor = {{ union = ["shaft.bottom", "hub.bottom"] }}
support.floor = {{ set = "floor", y = 0 }}
step = [{{}}]
{rest}
"#
    ))
}

#[test]
fn a_shaft_that_is_heated_sits_as_one_with_interference() {
    let interference = 12e-6 * 80.0;
    let heated = fit(
        "1",
        "",
        "temperature.hot = { set = \"shaft\", uniform = { value = 80 } }",
    );
    let tight = fit(
        &format!("{}", 1.0 - interference),
        ", initial = \"ramp\"",
        "",
    );
    // Lamé: u = p r / E ((b² + a²) / (b² - a²) + ν) of the hub, and -p r / E (1 - ν) of the shaft.
    let pressure = 200e3 * interference / (5.0 / 3.0 + 0.3 + 0.7);
    for row in [&heated, &tight] {
        near(value(row, "fit.CPRESSMAX"), pressure, 1e-2);
    }
    let [a, b] = [&heated, &tight].map(|row| value(row, "fit.CFN1"));
    near(a, b, 3e-3);
}

#[test]
fn temperatures_go_from_step_to_step_and_by_amplitudes() {
    let steps = r#"
support.y = { set = "bar.bottom", y = 0 }
support.x = { set = "bar.left", x = 0 }
temperature.hotter = { set = "bar", uniform = { value = 320 } }
temperature.swing = { set = "bar", uniform = { value = 50 }, amplitude = "swing" }
amplitude.swing = { table = [[3, 2], [4, 1]] }
step = [
    { temperatures = ["hot"], increments.fixed = 2 },
    { temperatures = ["hotter"], increments.fixed = 2 },
    { temperatures = [], increments.fixed = 2 },
    { temperatures = ["swing"], increments.fixed = 2 },
]
"#;
    for method in METHODS {
        let text = format!(
            "{}solver.method = \"{method}\"\n{steps}",
            bar("plane-stress", "standard")
        );
        let found: Vec<f64> = rows(&text)
            .iter()
            .map(|row| value(row, "end.U1") / (12e-6 * 0.2) + 20.0)
            .collect();
        let expected = [70.0, 120.0, 220.0, 320.0, 170.0, 20.0, 75.0, 50.0];
        for (found, expected) in found.iter().zip(expected) {
            near(*found, expected, 1e-9);
        }
    }
}

/// Secant coefficients: at 70 and 120 the bar is as long as they say, and in between it is no straight line.
#[test]
fn coefficients_by_temperature_are_secants_from_their_zero() {
    for method in METHODS {
        let text = format!(
            r#"{}
solver.method = "{method}"
support.y = {{ set = "bar.bottom", y = 0 }}
support.x = {{ set = "bar.left", x = 0 }}
step = [{{ increments.fixed = 2 }}]
"#,
            bar("plane-stress", "standard").replace(
                "expansion = 12e-6",
                "expansion = { table = [[0, 10e-6], [100, 12e-6], [200, 13e-6]], zero = 10 }"
            )
        );
        let all = rows(&text);
        let secant = [11.4e-6 * 60.0, 12.2e-6 * 110.0].map(|s| s - 10.4e-6 * 10.0);
        for (row, secant) in all.iter().zip(secant) {
            near(value(row, "end.U1"), 0.2 * secant, 1e-9);
        }
    }
}

#[test]
fn an_orthotropic_bar_expands_along_its_axes() {
    let text = bar("plane-stress", "standard").replace(
        "isotropic = { young = 200e9, poisson = 0.3, density = 7800 }, expansion = 12e-6",
        "orthotropic = { e1 = 200e9, e2 = 50e9, e3 = 20e9, nu12 = 0.3, nu13 = 0.2, nu23 = 0.1, g12 = 20e9, g13 = 10e9, g23 = 5e9, axes = [[0, 1, 0], [-1, 0, 0]] }, expansion = [12e-6, 30e-6, 1e-6]",
    );
    let row = end(&format!(
        "{text}support.y = {{ set = \"bar.bottom\", y = 0 }}\nsupport.x = {{ set = \"bar.left\", x = 0 }}\nstep = [{{}}]\n"
    ));
    near(value(&row, "end.U1"), 30e-6 * 100.0 * 0.2, 1e-9);
    near(value(&row, "end.U2"), 12e-6 * 100.0 * 0.1, 1e-9);
}

/// A bar whose cells are softer to the right pulls out as springs in a row do.
#[test]
fn elastic_constants_are_those_of_the_temperature_of_each_cell() {
    let text = r#"
format = 1
model.space = "plane-stress"
body.bar = { generate.rectangle = { to = [4, 1], cells = [4, 1] }, material = "m" }
material.m = { temperature = 0, isotropic = { young = 1000, poisson = 0 }, at = [{ temperature = 400, isotropic = { young = 200, poisson = 0 } }] }
initial.graded = { set = "bar", temperature.linear = { value = 0, point = [0, 0], gradient = [100, 0] } }
support.left = { set = "bar.left", x = 0 }
support.floor = { set = "bar.bottom", y = 0 }
load.pull = { set = "bar.right", traction = { value = [2, 0] } }
probe.end = { point = [4, 0] }
step = [{}]
"#;
    let each = [50.0, 150.0, 250.0, 350.0].map(|t| 2.0 / (1000.0 - 2.0 * t));
    for method in METHODS {
        let row = end(&format!("{text}solver.method = \"{method}\"\n"));
        near(value(&row, "end.U1"), each.iter().sum(), 1e-9);
    }
}

/// Heated at once, a bar swings about what it grows by, up to twice of it, and energies close.
#[test]
fn a_bar_that_is_heated_at_once_swings() {
    for scheme in ["central-difference", "newmark", "hht"] {
        // A cell has the period 2π √(m / k) = 2π L √(ρ / 2 E): half of its mass moves.
        let text = format!(
            r#"
format = 1
model.space = "plane-stress"
body.bar = {{ generate.rectangle = {{ to = [1, 1], cells = [1, 1] }}, material = "m" }}
material.m = {{ isotropic = {{ young = 2, poisson = 0, density = 1 }}, expansion = [1e-3, 0, 0] }}
temperature.hot = {{ set = "bar", uniform = {{ value = 10 }} }}
support.left = {{ set = "bar.left", x = 0 }}
support.floor = {{ set = "sides", y = 0 }}
set.sides = {{ union = ["bar.bottom", "bar.top"] }}
probe.end = {{ point = [1, 0] }}
solver.energy-limit = 0.02
step = [{{ duration = 6.3, increments = {{ initial = 0.01, largest = 0.01 }}, dynamic = {{ scheme.{scheme} = {{}}, mass = "lumped" }} }}]
"#
        );
        let all = rows(&text);
        let most = all
            .iter()
            .fold(0.0_f64, |m, row| m.max(value(row, "end.U1")));
        near(most, 0.02, 0.03);
        for row in &all {
            let scale = 0.5 * 2.0 * 0.01 * 0.01;
            assert!(value(row, "ERESIDUAL").abs() < 0.01 * scale, "{scheme}");
        }
        // At the start it is held as it was: all energy is strain.
        near(value(&all[0], "ALLSE"), 1e-4, 0.02);
    }
}

#[test]
fn what_would_be_wrong_is_refused_with_its_reason() {
    let supports = "support.y = { set = \"bar.bottom\", y = 0 }\nsupport.x = { set = \"bar.left\", x = 0 }\nstep = [{}]\n";
    let of = |from: &str, to: &str, more: &str| {
        let text = bar("plane-stress", "standard").replacen(from, to, 1);
        complaint(&format!("{text}{more}\n{supports}"))
    };
    let says = |found: String, wanted: &str| assert!(found.contains(wanted), "{found}");
    let cold = "temperature.too = { set = \"bar.left\", uniform = { value = 1 } }";
    says(of("", "", cold), "by this table and by `temperature.hot`");
    let two = "initial.cold = { set = \"bar.left\", temperature.uniform = { value = 1 } }";
    says(of("", "", two), "a point has one temperature at the start");
    let graded = "temperature = 20, at = [{ temperature = 100, isotropic = { young = 100e9, poisson = 0.3 } }], isotropic";
    says(
        of("isotropic", graded, ""),
        "that of body `bar` goes from 20 to 120",
    );
    let missing = graded.replace("temperature = 20, at", "at");
    says(
        of("isotropic", &missing, ""),
        "the temperature of the first elastic constants is missing",
    );
    let falls = graded.replace("temperature = 100", "temperature = 10");
    says(
        of("isotropic", &falls, ""),
        "does not follow the one before",
    );
    let nodes = of(
        "uniform = { value = 120 }",
        "nodes = { values = [[1, 20]] }",
        "",
    );
    says(nodes, "of the set has no temperature");
    let axis = "radial = { table = [[1, 2]], axis = [0, 1] }";
    says(
        of("uniform = { value = 120 }", axis, ""),
        "has no meaning in a plane model",
    );
    says(
        of("expansion = 12e-6", "expansion = { table = [] }", ""),
        "the table is empty",
    );
    says(
        of("expansion = 12e-6", "expansion = \"steel\"", ""),
        "expansion",
    );
}

#[test]
fn constants_that_are_the_same_over_the_range_are_taken() {
    let text = bar("plane-stress", "standard").replacen(
        "isotropic",
        "temperature = 0, at = [{ temperature = 400, isotropic = { young = 200e9, poisson = 0.3 } }], isotropic",
        1,
    );
    let text = format!(
        "{text}support.walls = {{ set = \"sides\", x = 0 }}\nsupport.floor = {{ set = \"bar.bottom\", y = 0 }}\nset.sides = {{ union = [\"bar.left\", \"bar.right\"] }}\nstep = [{{}}]\n"
    );
    near(value(&end(&text), "end.S11"), -240e6, 1e-9);
}

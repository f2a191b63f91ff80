//! What sliding leaves on both sides: dissipated energy and wear against closed forms, and fields that are uniform where they should be.

use crate::support;
use stickslip::contact::look;
use stickslip::results::fields;
use stickslip::run::Simulation;

const PRESSURE: f64 = 40.0;
const SLIP: f64 = 0.05;
const MU: f64 = 0.25;
/// Slip of the step in which sliding begins. The shear is at its limit all the time that the block slides: under a constant pressure what rubs is the path.
const BEGIN: f64 = 1e-3;
const PATH: f64 = BEGIN + SLIP;
const RUBBED: f64 = PATH;

/// A block that is pressed on another, held across and with a mesh of its own, whose surface moves by `SLIP` in the last step: the pressure
/// is that of the load everywhere, and the shear `MU` times that. It begins to slide in the step before.
fn belt(dim: usize, element: &str) -> Simulation {
    let block = |from: &str, to: &str, cells: &str, element: &str| match dim {
        2 => format!(
            "generate.rectangle = {{ from = [{from}], to = [{to}], cells = [{cells}]{element} }}"
        ),
        _ => {
            format!("generate.box = {{ from = [{from}], to = [{to}], cells = [{cells}]{element} }}")
        }
    };
    let (space, lower, upper, across, belt) = match dim {
        2 => (
            "plane-strain",
            block("0, 0", "1, 1", "4, 1", ""),
            block("0, 1", "1, 2", "3, 2", element),
            "x = 0.0",
            format!(
                "[1, 0, 0], [1.5, 2e-3, 0], [2, 0, 0], [2.5, {}, 0], [3, 0, 0]",
                2.0 * SLIP
            ),
        ),
        _ => (
            "solid",
            block("0, 0, 0", "1, 1, 1", "4, 4, 1", ""),
            block("0, 0, 1", "1, 1, 2", "3, 3, 1", element),
            "x = 0.0, y = 0.0",
            format!(
                "[1, 0, 0, 0], [1.5, 2e-3, 0, 0], [2, 0, 0, 0], [2.5, {}, 0, 0], [3, 0, 0, 0]",
                2.0 * SLIP
            ),
        ),
    };
    let fixed = if dim == 2 {
        "x = 0.0, y = 0.0"
    } else {
        "x = 0.0, y = 0.0, z = 0.0"
    };
    let text = format!(
        r#"format = 1
model.space = "{space}"
body.lower = {{ {lower}, material = "soft" }}
body.upper = {{ {upper}, material = "soft" }}
material.soft.isotropic = {{ young = 1e4, poisson = 0.3 }}
support.lower = {{ set = "lower", {fixed} }}
support.upper = {{ set = "upper", {across} }}
load.press = {{ set = "upper.top", pressure.value = {PRESSURE} }}
step = [{{ name = "press", increments = {{ fixed = 1 }} }}, {{ name = "begin", increments = {{ fixed = 1 }} }}, {{ name = "slide", increments = {{ fixed = 4 }} }}]
[interface.joint]
secondary = "upper.bottom"
primary = "lower.top"
friction.coulomb = {{ mu = {MU} }}
enforcement.augmented-lagrangian = {{ error = 1e-9 }}
wear.archard = {{ coefficient = 1e-6, primary-coefficient = 3e-6 }}
wear-feedback = "none"
primary-velocity-table = [{belt}]
"#
    );
    let mut simulation = support::build(&support::problem(&text)).unwrap_or_else(|e| panic!("{e}"));
    simulation.run(&mut []).unwrap_or_else(|e| panic!("{e}"));
    simulation
}

/// Values of a field at the nodes of a body that lie in the interface, and have one.
fn on(simulation: &Simulation, body: usize, name: &str) -> Vec<f64> {
    let all = fields(&simulation.view());
    let field = all.get(name).unwrap_or_else(|| panic!("no field {name}"));
    let points = simulation.model.bodies[body].points.clone();
    let values = field.values[points].iter().copied();
    values.filter(|v| !v.is_nan()).collect()
}

fn uniform(values: &[f64], expected: f64, what: &str) {
    assert!(values.len() > 2, "{what}: {values:?}");
    for v in values {
        assert!(
            (v / expected - 1.0).abs() < 1e-4,
            "{what}: {v} for {expected}"
        );
    }
}

#[test]
fn a_block_that_slides_under_pressure_wears_and_dissipates_as_the_laws_say_on_both_sides() {
    for (dim, element) in [
        (2, ""),
        (2, ", element = \"quad8\""),
        (3, ""),
        (3, ", element = \"hex20\""),
        (3, ", element = \"tet10\""),
    ] {
        let simulation = belt(dim, element);
        let what = format!("{dim}D {element}");
        for body in 0..2 {
            let what = format!("{what}, body {body}");
            uniform(&on(&simulation, body, "CPRESS"), PRESSURE, &what);
            uniform(
                &on(&simulation, body, "CDISS"),
                MU * PRESSURE * RUBBED,
                &what,
            );
            let k = [3e-6, 1e-6][body];
            uniform(&on(&simulation, body, "CWEAR"), k * PRESSURE * PATH, &what);
        }
        let last = &simulation.summary.last;
        let close = |name: &str, expected: f64| {
            let value = last[name];
            assert!(
                (value / expected - 1.0).abs() < 1e-4,
                "{what}: {name} {value} for {expected}"
            );
        };
        close("joint.CWEARMAX", 3e-6 * PRESSURE * PATH);
        close("joint.CWEARVOL", 4e-6 * PRESSURE * PATH);
        close("joint.ALLFD", MU * PRESSURE * RUBBED);
        close("joint.CAREA", 1.0);
        close("joint.XN1", 0.5);
        close("joint.XN2", if dim == 2 { 1.0 } else { 0.5 });
    }
}

#[test]
fn what_slides_away_leaves_its_trace_where_it_was() {
    let text = r#"format = 1
model.space = "plane-strain"
body.rail = { generate.rectangle = { to = [4, 0.5], cells = [160, 1] }, material = "soft" }
body.slider = { generate.rectangle = { from = [0.5, 0.5], to = [1.5, 1], cells = [50, 2] }, material = "soft" }
material.soft.isotropic = { young = 1e4, poisson = 0.0 }
support.rail = { set = "rail", x = 0.0, y = 0.0 }
support.slider = { set = "slider", x = 2.0 }
load.press = { set = "slider.top", pressure.value = 40 }
step = [{ name = "press", increments = { fixed = 1 }, supports = ["rail", "still"] }, { name = "slide", increments = { fixed = 80 }, supports = ["rail", "slider"] }]
support.still = { set = "slider", x = 0.0 }
[interface.joint]
secondary = "slider.bottom"
primary = "rail.top"
friction.coulomb = { mu = 0.25 }
wear.archard = { coefficient = 1e-6, primary-coefficient = 1e-6 }
wear-feedback = "none"
"#;
    let mut simulation = support::build(&support::problem(text)).unwrap_or_else(|e| panic!("{e}"));
    simulation.run(&mut []).unwrap_or_else(|e| panic!("{e}"));
    let all = fields(&simulation.view());
    let worn = all.get("CWEAR").expect("wear is followed");
    let pressed = all.get("CPRESS").expect("an interface");
    let at = |x: f64| {
        let points = &simulation.model.mesh.points;
        let near = |p: usize| (points[p][0] - x).abs() < 1e-9 && (points[p][1] - 0.5).abs() < 1e-9;
        let point = simulation.model.bodies[0].points.clone().find(|&p| near(p));
        point.expect("a node of the rail")
    };
    let full = 1e-6 * 40.0;
    // All of the slider, one unit long, has passed over the middle of the rail; it has left where it began. A node is met from a facet
    // before to a facet behind, 0.025 each.
    for (x, depth) in [
        (1.8, 1.0),
        (2.0, 1.0),
        (2.2, 1.0),
        (1.0, 0.5),
        (3.0, 0.5),
        (0.2, 0.0),
        (3.8, 0.0),
    ] {
        let value = worn.values[at(x)];
        assert!((value - full * depth).abs() < 0.08 * full, "{x}: {value}");
    }
    assert!(pressed.values[at(1.0)].is_nan());
    let secondary = simulation.summary.last["joint.CWEARVOL"] / 2.0;
    assert!((secondary / (full * 2.0) - 1.0).abs() < 1e-3, "{secondary}");
}

/// Length and height of the layer whose surface is wavy, its modulus and Poisson's ratio.
const LENGTH: f64 = 1.0;
const HEIGHT: f64 = 1.0;
const POISSON: f64 = 0.3;

/// A layer on a rigid ground, under a rigid flat that is pressed on it in the first step and slides by `path` in the second, in `increments`, following
/// what is worn off so that the mean pressure stays. `bed`: stiffness of the contact. The surface is moved by `wave` of each place: as a gap alone, so that
/// all is linear.
fn wavy(
    cells: usize,
    (laws, k): (&str, f64),
    (mean, path, increments): (f64, f64, usize),
    bed: f64,
    wave: impl Fn(f64) -> f64,
) -> Simulation {
    let soft = (1.0 + POISSON) * (1.0 - 2.0 * POISSON) / (1.0 - POISSON) * HEIGHT;
    let down = (soft + 1.0 / bed) * mean;
    let further = down + k * mean * path;
    let text = format!(
        r#"format = 1
model.space = "plane-strain"
body.layer = {{ generate.rectangle = {{ to = [{LENGTH}, {HEIGHT}], cells = [{cells}, {cells}] }}, material = "soft" }}
material.soft.isotropic = {{ young = 1.0, poisson = {POISSON} }}
support.ground = {{ set = "layer.bottom", x = 0.0, y = 0.0 }}
support.left = {{ set = "layer.left", x = 0.0 }}
support.right = {{ set = "layer.right", x = 0.0 }}
obstacle.flat = {{ plane = {{ point = [0.0, {HEIGHT}], normal = [0.0, -1.0] }}, motion.translation = [[0, 0, 0], [1, 0, -{down}], [2, {path}, -{further}]] }}
step = [{{ name = "press", increments = {{ fixed = 1 }} }}, {{ name = "slide", increments = {{ fixed = {increments} }} }}]
[interface.joint]
secondary = "layer.top"
primary = "flat"
wear.archard = {{ coefficient = {k} }}
{laws}
"#
    );
    let mut simulation = support::build(&support::problem(&text)).unwrap_or_else(|e| panic!("{e}"));
    let interface = &mut simulation.run.contact.interfaces[0];
    for x in &mut interface.definition.mesh_mut().reference {
        x[1] += wave(x[0]);
    }
    simulation
}

/// Part of the pressure at the nodes along a wave: the other waves have none in common with it.
fn part(simulation: &Simulation, wave: impl Fn(f64) -> f64) -> f64 {
    let (names, columns) = look::table(support::contact(simulation), &simulation.frame.state.u);
    let column = |name: &str| {
        let k = names.iter().position(|n| n == name);
        &columns[k.expect("a column")]
    };
    let mut sums = [0.0; 2];
    for (x, force) in column("x").iter().zip(column("CNORMF")) {
        sums[0] += force * wave(*x);
    }
    let (x, pressure) = (column("x"), column("CPRESS"));
    for ((x, p), force) in x.iter().zip(pressure).zip(column("CNORMF")) {
        sums[1] += force / p * wave(*x).powi(2);
    }
    sums[0] / sums[1]
}

/// The part at the end of each increment from the time at which it is pressed.
fn parts(mut simulation: Simulation, wave: impl Fn(f64) -> f64) -> Vec<f64> {
    let mut out = Vec::new();
    let mut last = 0;
    loop {
        let more = simulation
            .advance(&mut [])
            .unwrap_or_else(|e| panic!("{e}"));
        if simulation.summary.attempts.increments > last {
            last = simulation.summary.attempts.increments;
            out.push(part(&simulation, &wave));
        }
        if !more {
            return out;
        }
    }
}

const EXACT: &str = "enforcement.augmented-lagrangian = { error = 1e-12 }";

/// Amplitude of the waves: so low that all of the surface stays in contact.
const LOW: f64 = 1e-7;

fn cosine(x: f64) -> f64 {
    (std::f64::consts::TAU * x).cos()
}

/// W1: compliance of a bonded layer, one unit high, for a cosine of that length, without friction, in plane strain.
fn compliance() -> f64 {
    let q = std::f64::consts::TAU;
    let (nu, t) = (POISSON, q * HEIGHT);
    let (s, c) = ((2.0 * t).sinh(), (2.0 * t).cosh());
    let num = (3.0 - 4.0 * nu) * s - 2.0 * t;
    let den = (3.0 - 4.0 * nu) * c + 2.0 * t * t + 5.0 - 12.0 * nu + 8.0 * nu * nu;
    2.0 * (1.0 - nu * nu) / q * num / den
}

#[test]
fn a_wave_is_worn_off_as_it_is_soft() {
    let exact = compliance();
    assert!((exact - 0.289_556_925_3).abs() < 1e-10, "{exact}");
    let (k, path) = (0.2, 1.5);
    let mut off = Vec::new();
    for (cells, increments) in [(8, 4), (16, 4), (32, 4), (32, 8)] {
        let laws = (EXACT, k);
        let simulation = wavy(cells, laws, (1e-5, path, increments), f64::INFINITY, |x| {
            LOW * cosine(x)
        });
        let found = parts(simulation, cosine);
        // To the last digits what the backward Euler rule makes of the compliance of the mesh.
        let soft = LOW / found[0];
        let factor = 1.0 / (1.0 + k * path / increments as f64 / soft);
        for (n, p) in found.iter().enumerate() {
            let expected = found[0] * factor.powi(n as i32);
            assert!(
                (p / expected - 1.0).abs() < 1e-7,
                "{cells} {n}: {p} {expected}"
            );
        }
        let last = found[increments];
        let decay = LOW / soft * (-k * path / soft).exp();
        off.push((soft / exact - 1.0, last / decay - 1.0));
    }
    // Second order in the cells, first order in the increments.
    for pair in off.windows(2).take(2) {
        let ratio = pair[0].0 / pair[1].0;
        assert!((3.7..5.2).contains(&ratio), "{off:?}");
    }
    assert!(off[2].0.abs() < 5e-3, "{off:?}");
    let ratio = off[2].1 / off[3].1;
    assert!((1.7..2.4).contains(&ratio), "{off:?}");
}

#[test]
fn explicit_wear_is_stable_up_to_its_limit_and_implicit_wear_beyond() {
    const CELLS: usize = 16;
    let saw = |x: f64| match (x * CELLS as f64).round() as usize % 2 {
        0 => 1.0,
        _ => -1.0,
    };
    let k = 0.2;
    let run = |feedback: &str, path: f64, increments: usize| {
        let laws = format!("{EXACT}\nwear-feedback = \"{feedback}\"");
        let wave = |x: f64| 1e-9 * saw(x);
        let simulation = wavy(
            CELLS,
            (&laws, k),
            (1e-4, path, increments),
            f64::INFINITY,
            wave,
        );
        parts(simulation, saw)
    };
    let first = run("explicit", 1e-9, 1)[0];
    // The limit of this mesh, from its own compliance of the shortest wave.
    let limit = 2.0 * (1e-9 / first) / k;
    for (part, increments, decays) in [(0.95, 40, true), (1.05, 40, false)] {
        let found = run("explicit", part * limit * increments as f64, increments);
        let last = (found[increments] / found[0]).abs();
        // What the first increment wears off is felt by the second.
        let expected = (1.0 - 2.0 * part).abs().powi(increments as i32 - 1);
        assert!(
            (last / expected - 1.0).abs() < 1e-2,
            "{part}: {last} {expected}"
        );
        assert_eq!(last < 1.0, decays);
    }
    let found = run("implicit", 100.0 * limit * 5.0, 5);
    assert!((found[5] / found[0]).abs() < 1e-6, "{found:?}");
}

#[test]
fn a_punch_on_a_bed_of_springs_wears_to_a_uniform_pressure() {
    // W3, in units of its own: a bed so soft that the layer is a rigid punch on it, under a pressure from 1.5 to 0.5 of the mean.
    let (bed, mean, path) = (1e-6, 1e-9, 1.0);
    let k = 1.0 / (bed * path);
    let tilt = |x: f64| 0.5 - x;
    let mut off = Vec::new();
    let laws = format!("normal.linear = {{ c = {bed} }}\n");
    for (more, increments) in [("", 10), ("", 20), ("enforcement.penalty = {}", 10)] {
        let laws = format!("{laws}{more}");
        let wave = |x: f64| mean / bed * tilt(x);
        let simulation = wavy(4, (&laws, k), (mean, path, increments), bed, wave);
        let found = parts(simulation, tilt);
        assert!((found[0] / mean - 1.0).abs() < 1e-5, "{found:?}");
        let factor = 1.0 / (1.0 + bed * k * path / increments as f64);
        for (n, p) in found.iter().enumerate() {
            let expected = mean * factor.powi(n as i32);
            assert!((p / expected - 1.0).abs() < 1e-5, "{laws}: {p} {expected}");
        }
        off.push(found[increments] / mean - (-1.0_f64).exp());
    }
    // p(0) = 1.18393972 of the mean: once the error, of first order, is taken out.
    let extrapolated = 1.0 + 0.5 * ((-1.0_f64).exp() + 2.0 * off[1] - off[0]);
    assert!((extrapolated - 1.183_939_72).abs() < 2e-4, "{extrapolated}");
}

/// A block with a mesh of its own that slides on a longer one, whose surface both wear; 2D or 3D, with a mortar or at points.
fn slides(dim: usize, elements: [&str; 2], more: &str) -> Simulation {
    let body = |name: &str, low: [f64; 3], high: [f64; 3], cells: [usize; 3], element: &str| {
        let list = |v: &[f64]| {
            let v: Vec<String> = v[..dim].iter().map(|x| format!("{x:?}")).collect();
            v.join(", ")
        };
        let kind = if dim == 2 { "rectangle" } else { "box" };
        let cells: Vec<String> = cells[..dim].iter().map(ToString::to_string).collect();
        format!(
            "body.{name} = {{ generate.{kind} = {{ from = [{}], to = [{}], cells = [{}], element = \"{element}\" }}, material = \"soft\" }}",
            list(&low),
            list(&high),
            cells.join(", ")
        )
    };
    // The vertical is the last direction.
    let at = |x: f64, z: f64| if dim == 2 { [x, z, 0.0] } else { [x, 0.0, z] };
    let to = |x: f64, z: f64| if dim == 2 { [x, z, 0.0] } else { [x, 1.0, z] };
    let (rail, slider) = match dim {
        2 => ([24, 2, 0], [7, 2, 0]),
        _ => ([12, 3, 1], [4, 2, 1]),
    };
    let space = if dim == 2 { "plane-strain" } else { "solid" };
    let down = if dim == 2 { "y" } else { "z" };
    let side = if dim == 2 { "" } else { ", y = 0.0" };
    let text = format!(
        r#"format = 1
model.space = "{space}"
{}
{}
material.soft.isotropic = {{ young = 1e4, poisson = 0.2 }}
support.rail = {{ set = "rail.bottom", x = 0.0, {down} = 0.0{side} }}
support.still = {{ set = "slider.top", x = 0.0{side} }}
support.slider = {{ set = "slider.top", x = 1.0{side} }}
load.press = {{ set = "slider.top", pressure.value = 40 }}
step = [{{ name = "press", increments = {{ fixed = 2 }}, supports = ["rail", "still"] }}, {{ name = "slide", increments = {{ fixed = 12 }}, supports = ["rail", "slider"] }}]
[interface.joint]
secondary = "slider.bottom"
primary = "rail.top"
roles = "as-named"
friction.coulomb = {{ mu = 0.1 }}
wear.archard = {{ coefficient = 2e-6, primary-coefficient = 1e-6 }}
{more}
"#,
        body("rail", at(0.0, 0.0), to(3.0, 0.5), rail, elements[0]),
        body("slider", at(0.5, 0.5), to(1.5, 1.0), slider, elements[1]),
    );
    let mut simulation = support::build(&support::problem(&text)).unwrap_or_else(|e| panic!("{e}"));
    simulation.run(&mut []).unwrap_or_else(|e| panic!("{e}"));
    simulation
}

#[test]
fn what_both_surfaces_lose_is_what_the_law_says() {
    for (dim, elements, more) in [
        (2, ["quad4", "quad4"], ""),
        (2, ["quad8", "quad4"], ""),
        (2, ["quad4", "quad8"], ""),
        (2, ["quad4", "quad4"], "discretisation.node-to-facet = {}"),
        (2, ["quad4", "quad4"], "wear-feedback = \"explicit\""),
        (3, ["hex8", "hex8"], ""),
        (3, ["hex20", "hex20"], ""),
        (3, ["hex8", "hex8"], "discretisation.node-to-facet = {}"),
    ] {
        let simulation = slides(dim, elements, more);
        let what = format!("{dim}D {elements:?} {more}");
        let interface = support::contact(&simulation);
        let lost = look::wear(interface).expect("is followed").volume;
        for (lost, worn_volume) in lost.iter().zip(look::worn_volume(interface)) {
            assert!(
                (worn_volume / lost - 1.0).abs() < 1e-12,
                "{what}: {worn_volume} {lost}"
            );
        }
        assert!((lost[0] / lost[1] - 2.0).abs() < 1e-12, "{what}: {lost:?}");
        // Load times path, but for what the blocks give way until they slide.
        let expected = 3e-6 * 40.0;
        let sum = lost[0] + lost[1];
        assert!(
            (sum / expected - 1.0).abs() < 0.01,
            "{what}: {sum} {expected}"
        );
        // The slider has come down by what is gone, and the balance of energies counts that.
        let quality = &simulation.summary.quality;
        assert!(quality.met, "{what}: {quality:?}");
    }
}

#[test]
fn a_cycle_that_stands_for_ten_wears_as_ten_do() {
    let run = |cycles: &str| {
        let text = format!(
            r#"format = 1
model.space = "plane-strain"
body.layer = {{ generate.rectangle = {{ to = [1, 1], cells = [4, 4] }}, material = "soft" }}
body.flat = {{ generate.rectangle = {{ from = [-1, 1], to = [2, 1.5], cells = [12, 2] }}, material = "soft" }}
material.soft.isotropic = {{ young = 1.0, poisson = 0.3 }}
support.ground = {{ set = "layer.bottom", x = 0.0, y = 0.0 }}
support.drive = {{ set = "flat.top", x = 0.1, amplitude = "triangle" }}
load.press = {{ set = "flat.top", pressure.value = 1e-4 }}
amplitude.triangle.table = [[1, 0], [1.25, 1], [1.75, -1], [2, 0], [2.5, 0], [3, 1]]
probe.flat = {{ point = [-1, 1.5], of = "flat" }}
step = [{{ name = "press", increments = {{ fixed = 1 }} }}, {{ name = "fret", cycles = {{ {cycles} }}, increments = {{ fixed = 4 }} }}, {{ name = "on", increments = {{ fixed = 2 }} }}]
[interface.joint]
secondary = "layer.top"
primary = "flat.bottom"
roles = "as-named"
friction.coulomb = {{ mu = 0.1 }}
wear.archard = {{ coefficient = 1e-3, primary-coefficient = 1e-3 }}
"#
        );
        let mut simulation =
            support::build(&support::problem(&text)).unwrap_or_else(|e| panic!("{e}"));
        simulation.run(&mut []).unwrap_or_else(|e| panic!("{e}"));
        simulation
    };
    let [all, some] = ["count = 20", "count = 20, jump = 8"].map(run);
    assert_eq!(all.summary.attempts.increments, 1 + 80 + 2);
    assert_eq!(some.summary.attempts.increments, 1 + 12 + 2);
    for simulation in [&all, &some] {
        assert_eq!(simulation.summary.last["CYCLES"], 20.0);
        // What comes after the cycles in the amplitude comes after all of them.
        let u = simulation.summary.last["flat.U1"];
        assert!((u - 0.1).abs() < 1e-12, "{u}");
    }
    let [a, b] = [&all, &some].map(|s| s.summary.last["joint.CWEARVOL"]);
    assert!((a / b - 1.0).abs() < 2e-3, "{a} {b}");
}

/// Points that stick wear nothing, whatever their springs give way: a block that is pressed and pushed while all of it sticks answers with the same force, bit for bit, where it
/// would wear very fast and where nothing wears; and where some of it slides both sides lose what the law says of the path that is slid.
#[test]
fn what_sticks_does_not_wear() {
    let run = |push: f64, wear: &str| {
        let text = format!(
            r#"format = 1
model.space = "plane-strain"
body.block = {{ generate.rectangle = {{ to = [2, 1], cells = [8, 4] }}, material = "m" }}
material.m.isotropic = {{ young = 1.0, poisson = 0.3 }}
obstacle.floor.plane = {{ point = [0, 0], normal = [0, 1] }}
interface.base = {{ secondary = "block.bottom", primary = "floor", friction.coulomb = {{ mu = 0.5 }}, enforcement.penalty = {{ stiffness = 10.0, tangential-stiffness = 5.0 }}{wear} }}
support.press = {{ set = "block.top", y = -0.01, x = 0 }}
support.push = {{ set = "block.top", y = -0.01, x = {push:?} }}
quality.gate = "off"
step = [{{ supports = ["press"], increments.fixed = 1 }}, {{ supports = ["push"], increments.fixed = 4 }}]
"#
        );
        let record = support::run(&support::problem(&text)).unwrap_or_else(|e| panic!("{e}"));
        let row = record.increments.last().expect("an increment").1.clone();
        move |name: &str| row.get(name).unwrap_or_else(|| panic!("no column {name}"))
    };
    let wear = ", wear.archard = { coefficient = 500.0 }";
    let [worn, plain] = [wear, ""].map(|wear| run(1e-4, wear));
    assert_eq!(worn("SLIP"), 0.0);
    assert_eq!(worn("base.CWEARMAX"), 0.0);
    for name in ["base.CFN2", "base.CFS1", "push.RF1", "push.RF2"] {
        assert_eq!(worn(name), plain(name), "{name}");
    }
    // Beyond that the whole base slides, and the more it wears the less it carries.
    let [fast, slow, plain] = [
        ", wear.archard = { coefficient = 10.0 }",
        ", wear.archard = { coefficient = 1e-3 }",
        "",
    ]
    .map(|wear| run(0.05, wear));
    assert!(fast("base.CWEARMAX") > 0.0 && fast("base.CFN2") < 0.9 * slow("base.CFN2"));
    assert!((slow("base.CFN2") / plain("base.CFN2") - 1.0).abs() < 1e-2);
}

#[test]
fn explicit_wear_beyond_its_limit_is_above_the_limit_of_the_gate() {
    let run = |times: f64| -> Simulation {
        // The way up to which 16 points on a layer are stable, as it is told.
        let limit = 4.0 / 16.0 / (std::f64::consts::PI * 1.0 / 0.91);
        let way = times * limit;
        let text = format!(
            r#"format = 1
model.space = "plane-strain"
body.layer = {{ generate.rectangle = {{ from = [0, -1], to = [1, 0], cells = [16, 8] }}, material = "m" }}
material.m.isotropic = {{ young = 1.0, poisson = 0.3 }}
obstacle.flat.plane = {{ point = [0, 0], normal = [0, -1] }}
interface.c = {{ secondary = "layer.top", primary = "flat", wear.archard = {{ coefficient = 1.0 }}, wear-feedback = "explicit", primary-velocity-table = [[1, 0, 0], [1.0000001, {speed:?}, 0], [3, {speed:?}, 0]] }}
support.side = {{ set = "layer.bottom", x = 0 }}
support.bottom = {{ set = "layer.bottom", y = 1e-3 }}
step = [{{ increments.fixed = 1 }}, {{ increments.fixed = 4 }}]
output.every = 0
"#,
            speed = 4.0 * way
        );
        let mut simulation =
            support::build(&support::problem(&text)).unwrap_or_else(|e| panic!("{e}"));
        simulation.run(&mut []).unwrap_or_else(|e| panic!("{e}"));
        simulation
    };
    for times in [0.5, 3.0] {
        let simulation = run(times);
        let figures = &simulation.summary.quality.figures;
        let figure = figures.iter().find(|f| f.figure == "explicit-wear");
        let figure = figure.expect("it is judged");
        assert!(
            (figure.value / times - 1.0).abs() < 1e-3,
            "{times}: {figure:?}"
        );
        assert_eq!(figure.met, times < 1.0);
        assert_eq!(simulation.summary.quality.failed(), times > 1.0);
    }
}

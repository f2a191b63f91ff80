//! Motion: order of accuracy, energy, initial conditions, and what is refused.

use crate::support;
use stickslip::contact::look;
use support::{complaint, problem, run};

/// A rod of four cells, held at one end and pulled at the other at once. `SCHEME` and `STEPS` are filled in.
const ROD: &str = r#"
format = 1
model.space = "plane-stress"
body.rod = { generate.rectangle = { to = [4, 1], cells = [4, 1] }, material = "soft" }
material.soft.isotropic = { young = 100.0, poisson = 0.3, density = 1.0 }
support.wall = { set = "rod.left", x = 0, y = 0 }
load.pull = { set = "rod.right", traction = { value = [1, 0.2] } }
probe.end = { of = "rod", point = [4, 1] }
output.every = 0
[[step]]
duration = 1.6
increments.fixed = STEPS
dynamic = { DYNAMIC }
"#;

fn rod(dynamic: &str, steps: usize) -> Vec<support::Row> {
    let text = ROD
        .replace("STEPS", &steps.to_string())
        .replace("DYNAMIC", dynamic);
    let record = run(&problem(&text)).unwrap_or_else(|e| panic!("{dynamic}: {e}"));
    record.increments.into_iter().map(|(_, row)| row).collect()
}

fn end(rows: &[support::Row]) -> [f64; 4] {
    let last = rows.last().expect("a row");
    ["end.U1", "end.U2", "end.V1", "end.V2"].map(|name| last.get(name).expect("a column"))
}

fn apart(a: [f64; 4], b: [f64; 4]) -> f64 {
    let sum: f64 = a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum();
    sum.sqrt()
}

/// A table is constant outside its rows, in motion as well: one that ends early is one that goes on with its last value.
#[test]
fn a_table_that_ends_early_holds_its_last_value() {
    let pulled = |table: &str| {
        let text = ROD
            .replace("STEPS", "100")
            .replace("DYNAMIC", "")
            .replace("traction =", "amplitude = \"pull\", traction =");
        let record = run(&problem(&format!(
            "{text}[amplitude.pull]\ntable = {table}\n"
        )));
        let record = record.unwrap_or_else(|e| panic!("{table}: {e}"));
        let last = record.increments.last().expect("an increment");
        ["end.U1", "end.V1"].map(|name| last.1.get(name).expect("a column"))
    };
    let early = pulled("[[0, 0.5], [0.8, 1]]");
    assert_eq!(early, pulled("[[0, 0.5], [0.8, 1], [1.6, 1]]"));
    assert_ne!(early, pulled("[[0, 0.5], [0.8, 1], [1.6, 0]]"));
}

/// The error of every scheme falls with the square of the increment.
#[test]
fn schemes_are_of_second_order() {
    for mass in ["consistent", "lumped"] {
        let with = |scheme: &str| format!("scheme.{scheme}, mass = \"{mass}\"");
        // Richardson extrapolation of a run much finer than the others
        let [a, b] = [3200, 6400].map(|n| end(&rod(&with("newmark = {}"), n)));
        let exact: [f64; 4] = std::array::from_fn(|i| (4.0 * b[i] - a[i]) / 3.0);
        let mut schemes = vec![
            "newmark = {}",
            "hht = { alpha = -0.1 }",
            "generalised-alpha = {}",
            "generalised-alpha = { rho = 0.3 }",
        ];
        if mass == "lumped" {
            schemes.push("central-difference = {}");
        }
        for scheme in schemes {
            let errors = [200, 400, 800].map(|n| apart(end(&rod(&with(scheme), n)), exact));
            for pair in errors.windows(2) {
                let order = (pair[0] / pair[1]).log2();
                assert!(
                    (1.85..2.2).contains(&order),
                    "{scheme}, {mass}: order {order:.2}, errors {errors:?}"
                );
            }
        }
    }
}

/// Without contact the trapezoidal rule neither gains nor loses energy, and the ledger closes for every scheme.
#[test]
fn the_ledger_closes() {
    for dynamic in [
        "scheme.newmark = {}",
        "scheme.hht = { alpha = -0.3 }",
        "scheme.generalised-alpha = {}",
        "scheme.newmark = { beta = 0.3025, gamma = 0.6 }",
        "scheme.central-difference = {}",
    ] {
        let rows = rod(dynamic, 400);
        let scale = rows.iter().map(|r| value(r, "ALLKE") + value(r, "ALLSE"));
        let scale = scale.fold(0.0, f64::max);
        let mut lost: f64 = 0.0;
        for row in &rows {
            let left = value(row, "ERESIDUAL");
            assert!(left.abs() <= 1e-9 * scale, "{dynamic}: {left:e} of {scale}");
            lost = lost.max(value(row, "ALLND").abs());
        }
        match dynamic {
            "scheme.newmark = {}" => assert!(lost <= 1e-9 * scale, "{lost:e}"),
            _ => assert!(lost > 1e-7 * scale, "{dynamic}: {lost:e}"),
        }
    }
}

fn value(row: &support::Row, name: &str) -> f64 {
    row.get(name).unwrap_or_else(|| panic!("no column {name}"))
}

/// Rayleigh damping takes out what the ledger says it does, and as fast as theory says.
#[test]
fn rayleigh_damping_decays() {
    // One cell as a mass on its own stiffness: 2 m ü + k u = 0 with ζ = (α/ω + β ω) / 2.
    let text = r#"
format = 1
model.space = "plane-stress"
body.cell = { generate.rectangle = { to = [1, 1], cells = [1, 1] }, material = "m", rayleigh = { mass = 0.3, stiffness = 0.01 } }
material.m.isotropic = { young = 50.0, poisson = 0.0, density = 1.0 }
support.wall = { set = "cell.left", x = 0, y = 0 }
support.rail = { set = "cell.right", y = 0 }
initial.push = { set = "cell.right", velocity = [1, 0] }
probe.end = { of = "cell", point = [1, 1] }
output.every = 0
[[step]]
duration = 2.0
increments.fixed = 4000
dynamic = { SCHEME }
"#;
    for scheme in [
        "scheme.newmark = {}, mass = \"lumped\"",
        "scheme.central-difference = {}",
    ] {
        let record =
            run(&problem(&text.replace("SCHEME", scheme))).unwrap_or_else(|e| panic!("{e}"));
        let row = &record.increments.last().expect("a row").1;
        let omega = (50.0_f64 / 0.5).sqrt();
        let zeta = 0.5 * (0.3 / omega + 0.01 * omega);
        let damped = omega * (1.0 - zeta * zeta).sqrt();
        let exact = (-zeta * omega * 2.0_f64).exp() * (damped * 2.0).sin() / damped;
        let u = value(row, "end.U1");
        assert!((u / exact - 1.0).abs() < 2e-3, "{scheme}: {u} {exact}");
        assert!(value(row, "ALLVD") > 0.2);
        assert!(value(row, "ERESIDUAL").abs() < 1e-9);
    }
}

/// A block thrown up comes back as the parabola says, whatever the increment.
#[test]
fn free_flight_is_exact() {
    let text = r#"
format = 1
model.space = "plane-strain"
body.block = { generate.rectangle = { to = [1, 1], cells = [2, 2] }, material = "m" }
material.m.isotropic = { young = 1e4, poisson = 0.3, density = 2.0 }
load.weight = { set = "block", gravity = { acceleration = [0, -10] } }
initial.throw = { set = "block", velocity = [3, 4], displacement = [0.5, 0] }
probe.corner = { of = "block", point = [0, 0] }
output.every = 0
[[step]]
duration = 0.6
increments.fixed = 7
dynamic = {}
"#;
    let record = run(&problem(text)).unwrap_or_else(|e| panic!("{e}"));
    let row = &record.increments.last().expect("a row").1;
    assert!((value(row, "corner.U1") - (0.5 + 1.8)).abs() < 1e-9);
    assert!((value(row, "corner.U2") - (2.4 - 1.8)).abs() < 1e-9);
    assert!((value(row, "corner.V2") + 2.0).abs() < 1e-9);
    assert!(value(row, "ERESIDUAL").abs() < 1e-9);
}

/// Energy of a rod that bounces on a wall, and the force it meets, with and without mass in the point of contact.
#[test]
fn redistributed_mass_cures_impact() {
    let text = r#"
format = 1
model = { space = "plane-stress", thickness = 1.0 }
body.bar = { generate.rectangle = { from = [0, 0], to = [1, 0.05], cells = [20, 1] }, material = "m" }
material.m.isotropic = { young = 1.0, poisson = 0.0, density = 1.0 }
obstacle.wall.plane = { point = [-1e-3, 0], normal = [1, 0] }
interface.hit = { secondary = "bar.left", primary = "wall" }
support.rail = { set = "bar", y = 0 }
initial.throw = { set = "bar", velocity = [-0.01, 0] }
output.every = 0
[[step]]
duration = 2.8
increments.fixed = 560
dynamic = { scheme.newmark = {}, contact-mass = "KIND" }
"#;
    let [cured, classical] = ["redistributed", "as-meshed"].map(|kind| {
        let record = run(&problem(&text.replace("KIND", kind))).unwrap_or_else(|e| panic!("{e}"));
        let energy: Vec<f64> = record
            .increments
            .iter()
            .map(|(_, r)| value(r, "ALLKE") + value(r, "ALLSE"))
            .collect();
        let start = 0.5 * 0.05 * 1e-4;
        let worst = energy
            .iter()
            .map(|e| (e / start - 1.0).abs())
            .fold(0.0, f64::max);
        let forces = record.increments.iter().filter(|(_, r)| {
            let t = value(r, "TIME");
            t > 0.7 && t < 1.9
        });
        // the plane wave: ρ c v A
        let chatter = forces
            .map(|(_, r)| (value(r, "hit.CFN1") / (0.01 * 0.05) - 1.0).abs())
            .fold(0.0, f64::max);
        [worst, chatter]
    });
    assert!(cured[0] < 5e-3 && cured[1] < 0.3, "{cured:?}");
    assert!(classical[1] > 0.5, "{classical:?}");
}

/// What an earlier run left goes on where it ended.
#[test]
fn a_result_is_an_initial_condition() {
    let folder = support::folder("a-result-is-an-initial-condition");
    let whole = rod("scheme.newmark = {}", 160);
    let write = |text: &str, out: &str| {
        let model = problem(text)
            .build(&folder)
            .unwrap_or_else(|e| panic!("{e}"));
        let mut simulation = stickslip::run::Simulation::new(model).expect("sound");
        let mut record = support::Record::default();
        let mut files =
            stickslip::results::ResultFiles::new(&folder.join(out), &Default::default())
                .expect("a folder");
        simulation
            .run(&mut [&mut record, &mut files])
            .unwrap_or_else(|e| panic!("{e}"));
        record
    };
    let half = |n: usize| {
        ROD.replace("STEPS", &n.to_string())
            .replace("DYNAMIC", "scheme.newmark = {}")
            .replace("duration = 1.6", "duration = 0.8")
    };
    write(&half(80), "first");
    let more = format!(
        "{}\n[initial.rest]\nset = \"rod\"\nresult = \"first/fields_00000.vtu\"\n",
        half(80)
    );
    let record = write(&more, "second");
    let a = end(&whole);
    let b = end(&[record.increments.last().expect("a row").1.clone()]);
    assert!(apart(a, b) < 1e-9, "{a:?} {b:?}");
}

#[test]
fn mistakes_of_motion_are_refused() {
    let rod = |dynamic: &str| ROD.replace("STEPS", "100").replace("DYNAMIC", dynamic);
    let has = |text: String, parts: &[&str]| {
        let message = complaint(&text);
        for part in parts {
            assert!(message.contains(part), "`{part}` is not in\n{message}");
        }
    };
    has(
        rod("").replace(", density = 1.0", ""),
        &["has no density", "material.soft"],
    );
    has(
        rod("").replace("density = 1.0", "density = 0.0"),
        &["has no density"],
    );
    has(
        rod("scheme.central-difference = {}").replace("= 100\n", "= 5\n"),
        &["above the stable one", "increments.fixed ="],
    );
    has(
        rod("") + "[initial.push]\nset = \"rod\"\nvelocity = [1, 0]\n",
        &["does not agree with support `wall`", "node 1"],
    );
    has(rod("scheme.newmark = { gamma = 0.4 }"), &["gamma", "0.5"]);
    has(rod("scheme.hht = { alpha = 0.1 }"), &["alpha", "-1/3"]);
    has(
        ROD.replace("STEPS", "1")
            .replace("dynamic = { DYNAMIC }", "")
            + "[initial.push]\nset = \"rod.right\"\nvelocity = [1, 0]\n",
        &["no step is dynamic"],
    );
}

/// A rigid block of 1 kg on one square metre falls on a compliant floor at 1 m/s.
const FALL: &str = r#"
format = 1
model.space = "plane-strain"
body.block = { rigid = true, generate.rectangle = { to = [1, 0.5], cells = [1, 1] }, material = "m" }
material.m.isotropic = { young = 1e8, poisson = 0.0, density = 2.0 }
obstacle.floor.plane = { point = [0, 0], normal = [0, 1] }
interface.foot = { secondary = "block.bottom", primary = "floor", normal.linear = { c = 1e6 }, DAMPING }
initial.fall = { set = "block", velocity = [0, -1] }
probe.corner = { of = "block", point = [0, 0] }
output.every = 0
[[step]]
duration = 8e-3
SCHEME
"#;

/// The rebound that Hunt and Crossley's law gives: `(1 + e) c v = ln((1 + c v) / (1 - e c v))`, whatever the stiffness.
#[test]
fn damping_across_an_interface_takes_what_it_says() {
    let cv = 0.5_f64;
    let mut e: f64 = 0.7;
    for _ in 0..100 {
        let f = (1.0 + e) * cv - ((1.0 + cv) / (1.0 - e * cv)).ln();
        let slope = cv - cv / (1.0 - e * cv);
        e -= f / slope;
    }
    for scheme in [
        "increments.fixed = 4000\ndynamic = { scheme.newmark = {} }",
        "increments.fixed = 4000\ndynamic = { scheme.central-difference = {} }",
    ] {
        let text = FALL
            .replace("DAMPING", "damping.hunt-crossley = { coefficient = 0.5 }")
            .replace("SCHEME", scheme);
        let record = run(&problem(&text)).unwrap_or_else(|e| panic!("{e}"));
        let row = &record.increments.last().expect("a row").1;
        let rebound = value(row, "corner.V2");
        assert!((rebound - e).abs() < 2e-3, "{scheme}: {rebound}, not {e}");
        let lost = value(row, "ALLCD");
        assert!(
            (lost - 0.5 * (1.0 - e * e)).abs() < 2e-3,
            "{scheme}: {lost}"
        );
        assert!(value(row, "ERESIDUAL").abs() < 2e-3);
        let damped = record.increments.iter().map(|(_, r)| value(r, "ALLCD"));
        let damped: Vec<f64> = damped.collect();
        assert!(
            damped.windows(2).all(|w| w[1] >= w[0]),
            "damping gave energy back"
        );
    }
}

/// Opening and closing are located in time: the foot leaves the floor after half a period, `π √(m/k)`.
#[test]
fn events_are_located() {
    let text = FALL
        .replace(", DAMPING", "")
        .replace("SCHEME", "increments = { initial = 0.01, largest = 0.01, smallest = 1e-9 }\ndynamic = { scheme.newmark = {}, events = 1e-7 }");
    let record = run(&problem(&text)).unwrap_or_else(|e| panic!("{e}"));
    let open: Vec<(f64, f64, f64)> = record
        .increments
        .iter()
        .map(|(_, r)| (value(r, "TIME"), value(r, "DT"), value(r, "OPEN")))
        .collect();
    let left = open.windows(2).find(|w| w[0].2 == 0.0 && w[1].2 > 0.0);
    let (time, dt, _) = left.expect("the foot leaves")[1];
    let exact = std::f64::consts::PI * 1e-3;
    assert!(dt <= 1e-7, "the increment of the event is {dt:e}");
    assert!((time / exact - 1.0).abs() < 2e-3, "{time} is not {exact}");
    assert!(record.cutbacks > 5);
    // and most increments are as long as they may be
    let long = open.iter().filter(|o| o.1 > 5e-5).count();
    assert!(long > 80, "{long} of {}", open.len());
}

/// Mass scaling lengthens the stable increment to what is asked for and says what it costs; without being asked nothing is added.
#[test]
fn mass_scaling_is_reported() {
    let summary = |scheme: &str| {
        let text = ROD
            .replace("increments.fixed = STEPS\n", "")
            .replace("DYNAMIC", scheme);
        let mut simulation = support::build(&problem(&text)).unwrap_or_else(|e| panic!("{e}"));
        simulation.run(&mut []).unwrap_or_else(|e| panic!("{e}"));
        simulation.run.summary
    };
    let plain = summary("scheme.central-difference = {}");
    assert_eq!(plain.explicit.mass_added, 0.0);
    let wanted = 3.0 * plain.explicit.stable_increment;
    let scaled = summary(&format!(
        "scheme.central-difference = {{ mass-scaling = {wanted:?} }}"
    ));
    assert!(
        scaled.explicit.mass_added > 1.0,
        "{}",
        scaled.explicit.mass_added
    );
    assert!(
        scaled.explicit.stable_increment >= wanted * (1.0 - 1e-9),
        "{}",
        scaled.explicit.stable_increment
    );
    assert!(scaled.attempts.increments * 2 < plain.attempts.increments);
}

/// A rigid block of 1 kg, pressed with 10 N, friction 0.1, on a spring of 10⁴ N/m. It is caught where it is pulled to, then let go.
const LET_GO: &str = r#"
format = 1
model.space = "plane-strain"
body.mass = { rigid = true, generate.rectangle = { from = [-0.5, 0], to = [0.5, 0.2], cells = [1, 1] }, material = "any" }
material.any.isotropic = { young = 1e6, poisson = 0, density = 5 }
obstacle.ground.plane = { point = [0, 0], normal = [0, 1] }
interface.rub = { secondary = "mass.bottom", primary = "ground", friction.coulomb = { mu = 0.1 } }
load.press = { set = "mass.top", pressure = { value = 10 } }
load.spring = { set = "mass.bottom", spring = { stiffness = [5000, 0] } }
initial.pulled = { set = "mass", displacement = [PULLED, 0] }
support.catch = { set = "mass", hold = ["x"] }
probe.m = { of = "mass", point = [0, 0] }
output.every = 0
[[step]]
supports = ["catch"]
duration = 1e-3
increments.fixed = 1
[[step]]
supports = []
duration = 0.02
increments.fixed = 40
dynamic = { DYNAMIC }
"#;

/// Compliant laws and springs act at the stage of an increment unless a step says otherwise; what is held by multipliers acts at its end.
#[test]
fn where_contact_acts_follows_from_the_laws() {
    use stickslip::time::ContactAt::{End, Stage};
    let drop = r#"format = 1
model.space = "plane-strain"
body.m = { generate.rectangle = { to = [1, 1], cells = [1, 1] }, material = "m" }
material.m.isotropic = { young = 1e6, poisson = 0.3, density = 1 }
obstacle.floor.plane = { point = [0, 0], normal = [0, 1] }
interface.c = { secondary = "m.bottom", primary = "floor", LAW }
set.left = { of = "m", point = [0, 1] }
set.right = { of = "m", point = [1, 1] }
step = [{ dynamic = { AT }, increments.fixed = 1 }]
"#;
    let terms = r#"terms = [{ set = "left", component = "x" }, { set = "right", component = "x", factor = -1 }]"#;
    let spring = format!("coupling.a.spring = {{ stiffness = 1, {terms} }}\n");
    let equation = format!("coupling.a.equation = {{ {terms} }}\n");
    let stop = format!("coupling.a.gap = {{ clearance = 1, {terms} }}\n");
    for (law, at, coupling, expected) in [
        ("normal.linear.c = 1e6", "", "", Stage),
        ("normal.power-law = { c = 1e6, m = 2 }", "", "", Stage),
        ("normal.linear.c = 1e6", "", &*spring, Stage),
        ("normal.linear.c = 1e6", "contact-at = \"end\"", "", End),
        ("normal.linear.c = 1e6", "", &*equation, End),
        ("normal.linear.c = 1e6", "", &*stop, End),
        ("friction.coulomb.mu = 0.1", "", "", End),
        (
            "friction.coulomb.mu = 0.1",
            "contact-at = \"stage\"",
            "",
            Stage,
        ),
    ] {
        let text = drop.replace("LAW", law).replace("AT", at);
        let (head, steps) = text.split_once("step =").expect("a step");
        let text = format!("{head}{coupling}step ={steps}");
        let simulation = support::build(&problem(&text)).unwrap_or_else(|e| panic!("{e}"));
        let dynamic = simulation.model.steps[0].dynamic.expect("in motion");
        assert_eq!(dynamic.contact_at, expected, "{law}, {at}, {coupling}");
    }
}

/// Friction and pressure act from the first instant: the path of the block is that of the closed solution from the first increment on, which is
/// not shorter than the others.
#[test]
fn friction_acts_on_the_first_acceleration() {
    let exact = |t: f64| 1e-4 + 7.5e-4 * (100.0 * t).cos();
    for (dynamic, allowed) in [
        ("scheme.newmark = {}, contact-at = \"stage\"", 1e-3),
        ("contact-at = \"stage\"", 1e-3),
        ("scheme.hht = {}", 3e-3),
    ] {
        let text = LET_GO
            .replace("PULLED", "0.85e-3")
            .replace("DYNAMIC", dynamic);
        let record = run(&problem(&text)).unwrap_or_else(|e| panic!("{dynamic}: {e}"));
        for (t, row) in record
            .increments
            .iter()
            .skip(1)
            .map(|(_, r)| (value(r, "TIME") - 1e-3, r))
        {
            let off = (value(row, "m.U1") - exact(t)).abs() / 8.5e-4;
            assert!(off < allowed, "{dynamic}: {off:e} at {t}");
            // Its work is there from the start too.
            let left = value(row, "ERESIDUAL");
            assert!(left.abs() < 1e-6 * 3.6e-3, "{dynamic}: {left:e} J at {t}");
            let pressed = value(row, "rub.CFN2");
            assert!(
                (pressed - 10.0).abs() < 0.05,
                "{dynamic}: {pressed} N at {t}"
            );
        }
    }
    // Within the limit it stays where it is.
    let text = LET_GO.replace("PULLED", "0.09e-3").replace("DYNAMIC", "");
    let record = run(&problem(&text)).unwrap_or_else(|e| panic!("{e}"));
    for (_, row) in record.increments.iter().skip(1) {
        assert!((value(row, "m.U1") / 0.09e-3 - 1.0).abs() < 1e-4);
        assert!((value(row, "rub.CFS1").abs() - 0.9).abs() < 0.01);
    }
}

/// Damping that is stiff against the increment has put an end to the first acceleration long before the increment is over. The cell creeps with the
/// velocity at which damping takes the load.
#[test]
fn stiff_damping_does_not_throw_the_first_increment() {
    let text = r#"
format = 1
model.space = "plane-stress"
body.cell = { generate.rectangle = { to = [1, 1], cells = [1, 1] }, material = "m", rayleigh = { stiffness = 10 } }
material.m.isotropic = { young = 50.0, poisson = 0.0, density = 1.0 }
support.wall = { set = "cell.left", x = 0, y = 0 }
support.rail = { set = "cell.right", y = 0 }
load.pull = { set = "cell.right", traction = { value = [1, 0] } }
probe.end = { of = "cell", point = [1, 1] }
output.every = 0
[[step]]
duration = 1.0
increments.fixed = 10
dynamic = { mass = "lumped", SCHEME }
"#;
    for scheme in [
        "scheme.newmark = {}",
        "scheme.newmark = { beta = 0.3025, gamma = 0.6 }",
        "scheme.hht = { alpha = -0.05 }",
        "scheme.hht = { alpha = -0.3 }",
        "scheme.generalised-alpha = { rho = 0.5 }",
    ] {
        let record =
            run(&problem(&text.replace("SCHEME", scheme))).unwrap_or_else(|e| panic!("{e}"));
        for (i, (_, row)) in record.increments.iter().enumerate() {
            // k u + c v = F but for an instant of m/c = 1 ms
            let t = 0.1 * (i + 1) as f64;
            let exact = (1.0 - (-t / 10.0).exp()) / 50.0;
            let u = value(row, "end.U1");
            // Half an increment may be lost where the velocity jumps.
            let allowed = 0.6 * 0.1 / 500.0;
            assert!((u - exact).abs() < allowed, "{scheme}, {t}: {u} {exact}");
        }
    }
}

/// Steady sliding of an elastic block is unstable for any coefficient of friction, and stiffness damping cures it. The eigenvalues of the block linearised
/// about sliding (dense, by another program) are 478 rad/s and 42.4 per second; damping takes `β ω²/2` from them, here 57 per second.
#[test]
fn a_sliding_block_flutters_as_its_eigenvalue_says() {
    let text = r#"
format = 1
model.space = "plane-strain"
body.block = { generate.rectangle = { to = [1, 0.3], cells = [20, 6] }, material = "m", rayleigh = { stiffness = DAMPING } }
material.m.isotropic = { young = 1e7, poisson = 0.3, density = 1000 }
obstacle.floor.plane = { point = [0, 0], normal = [0, 1] }
interface.base = { secondary = "block.bottom", primary = "floor", friction.coulomb = { mu = 0.3676 } }
load.weight = { set = "block", gravity.acceleration = [3.36, -9.22] }
support.catch = { set = "block", hold = ["x"] }
initial.push = { set = "block", velocity = [1, 0] }
probe.p = { of = "block", point = [1, 0.3] }
output.every = 0
[[step]]
supports = ["catch"]
increments.fixed = 1
[[step]]
supports = []
duration = 0.075
increments.fixed = 750
dynamic = { scheme.newmark = {} }
"#;
    let growth = |damping: &str| {
        let record =
            run(&problem(&text.replace("DAMPING", damping))).unwrap_or_else(|e| panic!("{e}"));
        let peak = |from: f64, to: f64| {
            let rows = record.increments.iter().map(|(_, r)| r);
            let within = rows.filter(|r| (1.0 + from..1.0 + to).contains(&value(r, "TIME")));
            within.fold(0.0_f64, |m, r| m.max(value(r, "p.V2").abs()))
        };
        (peak(0.06, 0.075) / peak(0.015, 0.03)).ln() / 0.045
    };
    let free = growth("0");
    assert!((30.0..55.0).contains(&free), "{free} per second");
    let damped = growth("5e-4");
    assert!(damped < 0.0, "{damped} per second");
}

/// A block that lies 3 % of its cells deep in a compliant floor, and is let go. `DYNAMIC` and `NORMAL` are filled in.
const SPRUNG: &str = r#"
format = 1
model.space = "plane-stress"
body.block = { generate.rectangle = { from = [0, -0.01], to = [4, 1.99], cells = [8, 4] }, material = "soft" }
material.soft.isotropic = { young = 1000.0, poisson = 0.3, density = 1.0 }
obstacle.floor.plane = { point = [0, 0], normal = [0, 1] }
interface.joint = { secondary = "block.bottom", primary = "floor", normal.NORMAL, friction.coulomb.mu = 0.3 }
output.every = 0
[[step]]
duration = 1
dynamic = { DYNAMIC }
INCREMENTS
"#;

/// What overlap stores in a compliant law is energy that was there from the start, and increments are as small as the balance of energies asks for,
/// with a first one that is much too long as well.
#[test]
fn energy_of_overlap_at_the_start_is_kept_by_increments_that_are_small_enough() {
    let linear = ("linear = { c = 2e4 }", 0.5 * 2e4 * 0.01_f64.powi(2) * 4.0);
    let power = (
        "power-law = { c = 4e6, m = 2.2 }",
        4e6 / 3.2 * 0.01_f64.powf(3.2) * 4.0,
    );
    for (normal, stored) in [linear, power] {
        for scheme in [
            "newmark = {}",
            "generalised-alpha = { rho = 0.5 }",
            "central-difference = {}",
        ] {
            let long = match scheme.starts_with("central") {
                true => "",
                false => "increments = { initial = 0.2, largest = 0.2 }",
            };
            let text = SPRUNG.replace("NORMAL", normal).replace("INCREMENTS", long);
            let text = text.replace("DYNAMIC", &format!("scheme.{scheme}"));
            let record = run(&problem(&text)).unwrap_or_else(|e| panic!("{scheme}: {e}"));
            // What the scheme feeds in for a while is part of its own energy, that of a state half an increment away.
            let most = if scheme.starts_with("central") {
                1.06
            } else {
                1.011
            };
            let rows: Vec<_> = record.increments.iter().map(|(_, row)| row).collect();
            let what = format!("{normal}, {scheme}, {} increments", rows.len());
            for row in rows {
                let initial = value(row, "EINITIAL");
                assert!(
                    (initial / stored - 1.0).abs() < 1e-9,
                    "{what}: {initial:e} of {stored:e}"
                );
                let now: f64 = ["ALLKE", "ALLSE", "ALLCE", "ALLFD"]
                    .map(|e| value(row, e))
                    .iter()
                    .sum();
                assert!(now < most * stored, "{what}: {now:e} of {stored:e}");
                let left = value(row, "ERESIDUAL");
                assert!(
                    left.abs() < 0.011 * stored,
                    "{what}: {left:e} of {stored:e}"
                );
            }
        }
    }
}

/// A support that starts at once gives its points half of `m v²`, and no more, as work: the mean of the velocities counts.
#[test]
fn a_support_that_starts_at_once_does_the_work_that_the_bodies_take_up() {
    let text = ROD
        .replace("STEPS", "400")
        .replace("DYNAMIC", "scheme.central-difference = {}")
        .replace("load.pull = { set = \"rod.right\", traction = { value = [1, 0.2] } }", 
            "support.push = { set = \"rod.right\", x = 0.4, amplitude = \"push\" }\namplitude.push.table = [[0, 0], [0.8, 1], [1.6, 1]]");
    let record = run(&problem(&text)).expect("a rod that is pulled");
    let rows: Vec<_> = record.increments.iter().map(|(_, row)| row).collect();
    let scale = rows
        .iter()
        .map(|r| value(r, "ALLKE") + value(r, "ALLSE"))
        .fold(0.0, f64::max);
    for row in rows {
        let left = value(row, "ERESIDUAL");
        assert!(left.abs() < 1e-9 * scale, "{left:e} of {scale:e}");
    }
}

/// A bar that is thrown at a wall. `LEFT`, `CONTACT`, `LENGTH` and `DYNAMIC` are filled in.
const THROWN: &str = r#"
format = 1
model = { space = "plane-stress", thickness = 1.0 }
body.bar = { generate.rectangle = { from = [LEFT, 0], to = [1, 0.25], cells = [12, 3] }, material = "m" }
material.m.isotropic = { young = 1.0, poisson = 0.3, density = 1.0 }
obstacle.wall.plane = { point = [-1e-3, 0], normal = [1, 0] }
interface.hit = { secondary = "bar.left", primary = "wall", CONTACT }
initial.throw = { set = "bar", velocity = [-0.01, 0.003] }
output.every = 0
[[step]]
duration = DURATION
increments = { initial = LENGTH, largest = LENGTH }
dynamic = { DYNAMIC }
"#;

/// The stiffer the spring of a contact is, the less is gained by halving increments that do not resolve it: they are made small enough all the same.
#[test]
fn increments_resolve_the_springs_of_contact_however_stiff() {
    for stiffness in [1e5, 1e7] {
        let text = THROWN
            .replace("LEFT", "0")
            .replace(
                "CONTACT",
                &format!("normal.linear = {{ c = {stiffness:e} }}"),
            )
            .replace("DURATION", "1.4")
            .replace("LENGTH", "0.02")
            .replace("DYNAMIC", "scheme.newmark = {}");
        let record = run(&problem(&text)).unwrap_or_else(|e| panic!("{stiffness:e}: {e}"));
        let start = 0.5 * 0.25 * (1e-4 + 9e-6);
        for (_, row) in &record.increments {
            let left = value(row, "ERESIDUAL");
            assert!(
                left.abs() < 0.0101 * start,
                "{stiffness:e}: {left:e} of {start:e}"
            );
            let parts = ["ALLKE", "ALLSE", "ALLCE"].map(|e| value(row, e));
            let now: f64 = parts.iter().sum();
            assert!(now < 1.0101 * start, "{stiffness:e}: {now:e} of {start:e}");
        }
    }
}

/// A law that is soft where surfaces come near and a million times as stiff as the bodies soon after: an increment that went too far into it says nothing of the
/// stiffness that the next one will meet.
#[test]
fn increments_go_on_after_one_that_went_far_into_a_stiff_law() {
    let text = THROWN
        .replace("LEFT", "0")
        .replace("CONTACT", "normal.exponential = { p0 = 1e-3, c0 = 2e-5 }")
        .replace("DURATION", "0.5")
        .replace("increments = { initial = LENGTH, largest = LENGTH }\n", "")
        .replace("DYNAMIC", "scheme.central-difference = {}");
    let mut simulation = support::build(&problem(&text)).unwrap_or_else(|e| panic!("{e}"));
    let mut calls = 0;
    while simulation
        .advance(&mut [])
        .unwrap_or_else(|e| panic!("{e}"))
    {
        calls += 1;
        assert!(calls < 4000, "at {}", simulation.frame.state.t);
    }
    let quality = simulation.summary.balance.energy_quality;
    assert!(quality.met, "{quality:?}");
}

/// Multipliers press overlap out in the first increment, and what that strains the bodies by is the work of the overlap: the same in increments a tenth as
/// long, as points without mass have no velocity to be given.
#[test]
fn overlap_that_multipliers_press_out_is_in_the_ledger() {
    for mass in ["consistent", "lumped"] {
        let strained = [0.1, 0.01].map(|length| {
            let text = format!(
                r#"
format = 1
model.space = "plane-strain"
body.lower = {{ generate.rectangle = {{ from = [-1, -0.5], to = [1, 0], cells = [7, 2] }}, material = "m" }}
body.upper = {{ generate.rectangle = {{ from = [-1, -2e-3], to = [1, 0.7], cells = [14, 4] }}, material = "m" }}
material.m.isotropic = {{ young = 1.0, poisson = 0.2, density = 1.0 }}
support.base = {{ set = "lower.bottom", x = 0, y = 0 }}
interface.hit = {{ secondary = "upper.bottom", primary = "lower.top", friction.coulomb.mu = 0.3 }}
initial.throw = {{ set = "upper", velocity = [0, -0.006] }}
output.every = 0
[[step]]
duration = 0.2
increments = {{ initial = {length}, largest = {length} }}
dynamic = {{ scheme.newmark = {{}}, mass = "{mass}" }}
"#
            );
            let record = run(&problem(&text)).unwrap_or_else(|e| panic!("{mass} {length}: {e}"));
            let thrown = 0.5 * 1.404 * 0.006_f64.powi(2);
            for (_, row) in &record.increments {
                // No spring of the laws has any part in it.
                assert!((value(row, "EINITIAL") / thrown - 1.0).abs() < 1e-9, "{mass}");
                let left = value(row, "ERESIDUAL") / thrown;
                assert!(left.abs() < 0.01, "{mass} {length}: {left:e}");
            }
            let first = &record.increments[0].1;
            let gained = value(first, "ALLKE") + value(first, "ALLSE") - thrown;
            assert!((gained / value(first, "ALLWK") - 1.0).abs() < 1e-2, "{mass}");
            gained
        });
        assert!(
            strained[1] > 0.2 * 0.5 * 1.404 * 0.006_f64.powi(2),
            "{strained:?}"
        );
        assert!(
            (strained[0] / strained[1] - 1.0).abs() < 0.1,
            "{strained:?}"
        );
    }
}

/// Points without mass are where overlap has pressed them when a motion begins: what springs of a penalty had stored before is nothing that the bodies ever get, and
/// schemes that weigh elastic forces over an increment do not begin to swing.
#[test]
fn overlap_presses_points_without_mass_before_a_motion_begins() {
    let mut strained = Vec::new();
    for enforcement in [
        "penalty = {}",
        "penalty = { factor = 1e4 }",
        "augmented-lagrangian = {}",
    ] {
        for scheme in ["newmark = {}", "generalised-alpha = { rho = 0.5 }"] {
            let text = THROWN
                .replace("LEFT", "-4e-3")
                .replace("CONTACT", &format!("enforcement.{enforcement}"))
                .replace("DURATION", "0.2")
                .replace("LENGTH", "0.01")
                .replace("DYNAMIC", &format!("scheme.{scheme}"));
            let what = format!("{enforcement}, {scheme}");
            let record = run(&problem(&text)).unwrap_or_else(|e| panic!("{what}: {e}"));
            let rows: Vec<_> = record.increments.iter().map(|(_, row)| row).collect();
            let thrown = 0.5 * 0.251 * (1e-4 + 9e-6);
            let now = |row: &support::Row| {
                ["ALLKE", "ALLSE", "ALLCE"]
                    .map(|e| value(row, e))
                    .iter()
                    .sum::<f64>()
            };
            strained.push(now(rows[0]) - thrown);
            for row in rows {
                let left = value(row, "ERESIDUAL").abs() / thrown;
                assert!(left < 0.01, "{what}: {left:e}");
                assert!(value(row, "EINITIAL") < 1.05 * thrown, "{what}");
            }
            // Pressure does not swing from the first increment to the second.
            let force = |k: usize| value(&record.increments[k].1, "hit.CFN1");
            assert!(
                (force(1) / force(0) - 1.0).abs() < 0.1,
                "{what}: {:e} and {:e}",
                force(0),
                force(1)
            );
        }
    }
    // The same work of the overlap, however it is resolved.
    for work in &strained {
        assert!(
            (work / strained[4] - 1.0).abs() < 0.05 && *work > 0.0,
            "{strained:?}"
        );
    }
}

/// Creep at a velocity of 1e-6 m/s over increments of 1e-8 s is a slip of 1e-14 m, of which rounding leaves a few digits: what an interface is said to carry is
/// what it carries all the same.
#[test]
fn resultants_are_what_acts_on_the_bodies_however_steep_the_laws() {
    for enforcement in ["perturbed-lagrangian", "augmented-lagrangian"] {
        let text = format!(
            r#"
format = 1
model.space = "plane-strain"
body.lower = {{ generate.rectangle = {{ from = [-4e-3, -4e-3], to = [4e-3, 0], cells = [9, 4] }}, material = "soft" }}
body.upper = {{ generate.rectangle = {{ from = [-3e-3, 0], to = [3e-3, 3e-3], cells = [8, 4] }}, material = "stiff" }}
material.soft.isotropic = {{ young = 9e9, poisson = 0.2, density = 8e3 }}
material.stiff.isotropic = {{ young = 9e10, poisson = 0.1, density = 8e3 }}
interface.joint = {{ secondary = "upper.bottom", primary = "lower.top", friction.coulomb.mu = 0.6, slip.regularised.epsilon = 1e-6, enforcement.{enforcement} = {{}} }}
support.base = {{ set = "lower.bottom", x = 0, y = 0 }}
support.press = {{ set = "upper.top", y = -8e-5 }}
support.shake = {{ set = "upper.top", x = 4e-5, amplitude = "shake" }}
amplitude.shake.table = [[0, 0], [1, 0], [1.0000003, 1]]
output.every = 0
[[step]]
increments.fixed = 1
[[step]]
duration = 3e-7
increments.fixed = 10
dynamic.scheme.hht.alpha = -0.05
"#
        );
        let mut simulation = support::build(&problem(&text)).unwrap_or_else(|e| panic!("{e}"));
        let mut largest: f64 = 0.0;
        loop {
            let view = simulation.view();
            let u = &view.frame.state.u;
            let said = look::resultant(view.contacts().next().expect("there is one"), u);
            let fields = stickslip::results::fields(&view);
            let force = &fields
                .all
                .iter()
                .find(|f| f.name == "CFORCE")
                .expect("forces")
                .values;
            // Points of the upper body come last.
            let acts = |c: usize| -> f64 { force.chunks(3).skip(50).map(|f| f[c]).sum() };
            largest = largest.max(acts(0).hypot(acts(1)));
            for c in 0..2 {
                let off = said.normal[c] + said.shear[c] - acts(c);
                assert!(
                    off.abs() <= 1e-13 * largest,
                    "{enforcement} at {}: {off:e} of {largest:e}",
                    view.frame.state.t
                );
            }
            if !simulation
                .advance(&mut [])
                .unwrap_or_else(|e| panic!("{e}"))
            {
                break;
            }
        }
        assert!(largest > 0.0);
    }
}

#[test]
fn the_first_explicit_increment_knows_what_is_in_contact() {
    // A law a million times as stiff as the cells beneath, at rest.
    let text = r#"
format = 1
model.space = "plane-strain"
body.b = { generate.rectangle = { to = [1, 1], cells = [4, 4] }, material = "m" }
material.m.isotropic = { young = 2e9, poisson = 0.3, density = 7800.0 }
obstacle.o.plane = { point = [0, 0], normal = [0, 1] }
interface.f = { secondary = "b.bottom", primary = "o", normal.linear.c = 1e16 }
support.s = { set = "b.left", x = 0 }
support.t = { set = "b.top", y = -1e-4 }
step = [{}, { duration = 5e-5, dynamic.scheme.central-difference = {} }]
output.every = 0
"#;
    let mut record = support::Record::default();
    let mut simulation = support::build(&support::problem(text)).unwrap_or_else(|e| panic!("{e}"));
    simulation
        .run(&mut [&mut record])
        .unwrap_or_else(|e| panic!("{e}"));
    let rows: Vec<_> = record.increments.iter().map(|(_, row)| row).collect();
    let at_rest = rows.iter().rfind(|r| value(r, "STEP") == 1.0);
    let at_rest = value(at_rest.expect("a row"), "f.CFN2");
    for row in rows.iter().filter(|r| value(r, "STEP") == 2.0) {
        let force = value(row, "f.CFN2");
        assert!((force / at_rest - 1.0).abs() < 1e-3, "{force} {at_rest}");
    }
    // By the rows of what springs of 1e16 Pa/m add to points of a quarter of a cell: ω² = c A / m with A = 1/4 and m = ρ/32.
    let longest = 2.0 / f64::sqrt(1e16 * 0.25 / (7800.0 / 32.0));
    let stable = simulation.summary.explicit.stable_increment;
    assert!(
        stable > 0.5 * longest && stable < longest,
        "{stable} {longest}"
    );
}

/// A tie neither closes nor opens: what is glued swings like one piece, its mass where the cells have it.
#[test]
fn tied_surfaces_keep_their_mass() {
    let column = |bodies: &str| {
        let text = format!(
            r#"
format = 1
model = {{ space = "plane-stress", thickness = 1.0 }}
{bodies}
material.m.isotropic = {{ young = 1e6, poisson = 0.3, density = 1.0 }}
support.base = {{ set = "low.bottom", x = 0, y = 0 }}
output.every = 0
[[step]]
duration = 8e-3
increments.fixed = 40
dynamic = {{}}
"#
        );
        let record = run(&problem(&text)).unwrap_or_else(|e| panic!("{e}"));
        let reactions = record.increments.iter().map(|(_, r)| value(r, "base.RF2"));
        reactions.collect::<Vec<f64>>()
    };
    let whole = column(
        "body.low.generate.rectangle = { to = [1, 2], cells = [2, 4] }\nbody.low.material = \"m\"\nload.pull = { set = \"low.top\", traction.value = [0, 100] }",
    );
    let glued = column(
        "body.low.generate.rectangle = { to = [1, 1], cells = [2, 2] }\nbody.low.material = \"m\"\nbody.high.generate.rectangle = { from = [0, 1], to = [1, 2], cells = [2, 2] }\nbody.high.material = \"m\"\ninterface.tie = { secondary = \"high.bottom\", primary = \"low.top\", tied = true }\nload.pull = { set = \"high.top\", traction.value = [0, 100] }",
    );
    let largest = whole.iter().fold(0.0_f64, |m, f| m.max(f.abs()));
    let off = whole.iter().zip(&glued).map(|(a, b)| (a - b).abs());
    let off = off.fold(0.0, f64::max) / largest;
    assert!(off < 1e-3, "{off:e}");
}

//! Rigid bodies that turn by any angle: tops, pendulums and what rolls, against equations of motion that are integrated here, and closed forms.

use std::f64::consts::{FRAC_PI_2, PI};
use std::path::Path;

use crate::flying::{GYRATION, roller, rolling};
use crate::restart;
use crate::support::{self, Record};
use stickslip::problem::Problem;

fn run(text: &str) -> Record {
    let mut record = Record::default();
    let mut simulation =
        support::build(&support::problem(text)).unwrap_or_else(|e| panic!("{e}\n{text}"));
    let outcome = simulation.run(&mut [&mut record]);
    outcome.unwrap_or_else(|e| panic!("{e}\n{text}"));
    record
}

fn column(record: &Record, name: &str) -> Vec<f64> {
    let rows = record.increments.iter();
    rows.map(|(_, row)| row.get(name).unwrap_or_else(|| panic!("no column {name}")))
        .collect()
}

fn last(record: &Record, name: &str) -> f64 {
    *column(record, name).last().expect("a row")
}

/// By how much a column leaves a value.
fn drift(record: &Record, name: &str, from: f64) -> f64 {
    let values = column(record, name).into_iter();
    values.fold(0.0, |m, v| m.max((v - from).abs()))
}

/// The largest part of the energy in play that the ledger cannot place.
fn open(record: &Record) -> f64 {
    let scale = drift(record, "ALLKE", 0.0) + drift(record, "ALLSE", 0.0);
    drift(record, "ERESIDUAL", 0.0) / scale
}

type Vec3 = [f64; 3];

fn cross(a: Vec3, b: Vec3) -> Vec3 {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// A rigid body with principal moments of inertia, and what has come of its spin along its axes, and of these axes in space, after a time: Euler's equations
/// with `ė = ω × e`, by the method of Runge and Kutta. `weight` acts at an arm along the first axis.
fn euler(j: Vec3, spin: Vec3, (arm, weight): (f64, Vec3), end: f64) -> (Vec3, [Vec3; 3]) {
    type State = [f64; 12];
    let rate = |y: &State| -> State {
        let w = [y[0], y[1], y[2]];
        let axis = |k: usize| [y[3 + 3 * k], y[4 + 3 * k], y[5 + 3 * k]];
        let dot = |a: Vec3, b: Vec3| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        let push = [0, 1, 2].map(|k| dot(axis(k), weight));
        let moment = cross([arm, 0.0, 0.0], push);
        let turned = cross(w, [j[0] * w[0], j[1] * w[1], j[2] * w[2]]);
        let mut out = [0.0; 12];
        let mut space = [0.0; 3];
        for k in 0..3 {
            out[k] = (moment[k] - turned[k]) / j[k];
            (0..3).for_each(|i| space[i] += w[k] * axis(k)[i]);
        }
        for k in 0..3 {
            out[3 + 3 * k..6 + 3 * k].copy_from_slice(&cross(space, axis(k)));
        }
        out
    };
    let mut y: State = [0.0; 12];
    y[..3].copy_from_slice(&spin);
    (0..3).for_each(|k| y[3 + 4 * k] = 1.0);
    let steps = 20_000;
    let h = end / f64::from(steps);
    let ahead =
        |y: &State, s: f64, d: &State| -> State { std::array::from_fn(|i| y[i] + s * d[i]) };
    for _ in 0..steps {
        let a = rate(&y);
        let b = rate(&ahead(&y, 0.5 * h, &a));
        let c = rate(&ahead(&y, 0.5 * h, &b));
        let d = rate(&ahead(&y, h, &c));
        y = std::array::from_fn(|i| y[i] + h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]));
    }
    let axis = |k: usize| [y[3 + 3 * k], y[4 + 3 * k], y[5 + 3 * k]];
    ([y[0], y[1], y[2]], [axis(0), axis(1), axis(2)])
}

/// The trapezoidal rule in the middle of increments: no numerical dissipation.
const MIDPOINT: &str = "{ scheme.generalised-alpha.rho = 1 }";
const EXPLICIT: &str = "{ scheme.central-difference = {} }";

/// A block of 3 by 2 by 1 that spins about its middle axis, or nearly so.
fn thrown(dynamic: &str, dt: f64) -> String {
    format!(
        r#"
        format = 1
        model.space = "solid"
        solver.tolerance = 1e-12
        [body.block]
        material = "m"
        rigid = true
        rotation = "large"
        generate.box = {{ from = [-1.5, -1, -0.5], to = [1.5, 1, 0.5], cells = [1, 1, 1] }}
        [material.m]
        isotropic = {{ young = 1e6, poisson = 0.3, density = 1 }}
        [initial.throw]
        set = "block"
        spin = [0.05, 4, 0.02]
        velocity = [1, 0.5, 0.2]
        [[step]]
        duration = 6
        dynamic = {dynamic}
        increments = {{ initial = {dt}, largest = {dt} }}
        "#
    )
}

/// Its moments of inertia.
const BLOCK: Vec3 = [6.0 / 12.0 * 5.0, 6.0 / 12.0 * 10.0, 6.0 / 12.0 * 13.0];

#[test]
fn a_block_that_spins_about_its_middle_axis_turns_over_and_keeps_its_momenta() {
    let spin = [0.05, 4.0, 0.02];
    let (last_spin, axes) = euler(BLOCK, spin, (0.0, [0.0; 3]), 6.0);
    // It has turned over on the way.
    assert!(
        axes[1][1].abs() < 0.9 || last_spin[1] * 4.0 < 0.0,
        "{axes:?}"
    );
    let expected: Vec3 = std::array::from_fn(|i| (0..3).map(|k| last_spin[k] * axes[k][i]).sum());
    let off = |dynamic: &str, dt: f64| {
        let record = run(&thrown(dynamic, dt));
        let exact = dynamic != "{ scheme.generalised-alpha.rho = 0.8 }";
        for k in 0..3 {
            let name = format!("block.L{}", k + 1);
            let scale = BLOCK[1] * 4.0;
            let limit = if exact { 1e-10 } else { 0.1 };
            let moved = drift(&record, &name, BLOCK[k] * spin[k]) / scale;
            assert!(moved < limit, "{dynamic} {name}: {moved:e}");
            let name = format!("block.P{}", k + 1);
            let first = column(&record, &name)[0];
            assert!(drift(&record, &name, first) < 1e-10 * first, "{name}");
        }
        let energy = last(&record, "EINITIAL");
        let kept = drift(&record, "ALLKE", energy) / energy;
        assert!(!exact || kept < 1e-10, "{dynamic}: {kept:e}");
        assert!(open(&record) < 1e-9, "{dynamic}: {:e}", open(&record));
        let found: Vec3 = std::array::from_fn(|i| last(&record, &format!("block.VR{}", i + 1)));
        let off = (0..3)
            .map(|i| (found[i] - expected[i]).powi(2))
            .sum::<f64>();
        off.sqrt() / 4.0
    };
    for dynamic in [MIDPOINT, EXPLICIT, "{ scheme.generalised-alpha.rho = 0.8 }"] {
        let [coarse, fine] = [0.01, 0.005].map(|dt| off(dynamic, dt));
        // Second order: a small error of the time at which it turns over is a large one of the spin.
        assert!(
            fine < 0.05 && fine < 0.3 * coarse,
            "{dynamic}: {coarse} {fine}"
        );
    }
}

/// A slab on a pin at the middle of its face, which spins about its axis and falls.
fn top(dynamic: &str, [spin, turn]: [f64; 2], dt: f64) -> String {
    format!(
        r#"
        format = 1
        model.space = "solid"
        solver.tolerance = 1e-12
        [body.top]
        material = "m"
        rigid = true
        rotation.with = "pin"
        generate.box = {{ from = [0, -0.1, -0.1], to = [0.1, 0.1, 0.1], cells = [2, 2, 2] }}
        [material.m]
        isotropic = {{ young = 1e9, poisson = 0.3, density = 1000 }}
        [reference.pin]
        point = [0, 0, 0]
        [support.pin]
        set = "pin"
        x = 0
        y = 0
        z = 0
        [probe.nose]
        point = [0.1, 0.1, 0.1]
        [load.weight]
        set = "top"
        gravity.acceleration = [0, 0, -9.81]
        [initial.spin]
        set = "pin"
        spin = [{spin}, 0, {turn}]
        [[step]]
        duration = 0.6
        dynamic = {dynamic}
        increments = {{ initial = {dt}, largest = {dt} }}
        "#
    )
}

#[test]
fn a_heavy_top_nods_as_eulers_equations_have_it() {
    let (mass, a, h) = (4.0, 0.2, 0.1);
    let across = mass * ((a * a + h * h) / 12.0 + 0.0025);
    let j = [mass * a * a / 6.0, across, across];
    // At rest but for its spin, and with what it precesses by steadily.
    let steady = mass * 9.81 * 0.05 / (j[0] * 50.0);
    for (spin, turn) in [(50.0, 0.0), (50.0, steady)] {
        let weight = (0.05, [0.0, 0.0, -9.81 * mass]);
        let (_, axes) = euler(j, [spin, 0.0, turn], weight, 0.6);
        let corner: Vec3 =
            std::array::from_fn(|i| 0.1 * (axes[0][i] + axes[1][i] + axes[2][i]) - 0.1);
        let off = |dynamic: &str, dt: f64| {
            let record = run(&top(dynamic, [spin, turn], dt));
            assert!(open(&record) < 1e-6, "{dynamic}: {:e}", open(&record));
            let found: Vec3 = std::array::from_fn(|i| last(&record, &format!("nose.U{}", i + 1)));
            (0..3)
                .map(|i| (found[i] - corner[i]).powi(2))
                .sum::<f64>()
                .sqrt()
                / 0.17
        };
        for dynamic in [MIDPOINT, EXPLICIT] {
            let [coarse, fine] = [0.002, 0.001].map(|dt| off(dynamic, dt));
            assert!(
                fine < 0.01 && fine < 0.3 * coarse,
                "{dynamic} {turn}: {coarse} {fine}"
            );
        }
    }
}

/// A rod of length 1 that is let go where it lies; `dim` 3 is a hinge along z.
fn pendulum(dim: usize, dynamic: &str) -> String {
    let (space, mesh, g, more) = match dim {
        2 => (
            "plane-strain",
            "rectangle = { from = [0, -0.05], to = [1, 0.05], cells = [4, 1] }",
            "[0, -9.81]",
            "",
        ),
        _ => (
            "solid",
            "box = { from = [0, -0.05, -0.05], to = [1, 0.05, 0.05], cells = [4, 1, 1] }",
            "[0, -9.81, 0]",
            "z = 0\nrotation-x = 0\nrotation-y = 0",
        ),
    };
    let point = if dim == 2 { "[0, 0]" } else { "[0, 0, 0]" };
    format!(
        r#"
        format = 1
        model.space = "{space}"
        [body.rod]
        material = "m"
        rigid = true
        rotation.with = "pin"
        generate.{mesh}
        [material.m]
        isotropic = {{ young = 1e8, poisson = 0.3, density = 1000 }}
        [reference.pin]
        point = {point}
        [support.pin]
        set = "pin"
        x = 0
        y = 0
        {more}
        [load.weight]
        set = "rod"
        gravity.acceleration = {g}
        [[step]]
        duration = 3
        dynamic = {dynamic}
        increments = {{ initial = 0.005, largest = 0.005 }}
        "#
    )
}

#[test]
fn a_pendulum_swings_through_as_slowly_as_its_angle_asks_for() {
    // K(sin 45°) = 1.8540746773: from level to level and back in four of these.
    let (d, inertia) = (0.5, (1.0 + 0.01) / 12.0 + 0.25);
    let quarter = 1.8540746773 * f64::sqrt(inertia / (9.81 * d));
    for (dim, dynamic) in [(2, MIDPOINT), (2, EXPLICIT), (3, MIDPOINT), (3, EXPLICIT)] {
        let record = run(&pendulum(dim, dynamic));
        let (times, angles) = (column(&record, "TIME"), column(&record, "pin.UR3"));
        // Down, up on the other side, down again: three quarters.
        let crossings: Vec<f64> = (1..angles.len())
            .filter(|&i| (angles[i - 1] + FRAC_PI_2) * (angles[i] + FRAC_PI_2) < 0.0)
            .map(|i| {
                let part = (-FRAC_PI_2 - angles[i - 1]) / (angles[i] - angles[i - 1]);
                times[i - 1] + part * (times[i] - times[i - 1])
            })
            .collect();
        for (k, found) in crossings.iter().take(2).enumerate() {
            let expected = (1 + 2 * k) as f64 * quarter;
            assert!(
                (found / expected - 1.0).abs() < 3e-4,
                "{dim} {dynamic}: {found} {expected}"
            );
        }
        assert!(crossings.len() >= 2);
        let farthest = angles.iter().fold(0.0_f64, |m, a| m.min(*a));
        assert!((farthest + PI).abs() < 1e-3, "{dim} {dynamic}: {farthest}");
        assert!(open(&record) < 1e-6, "{dim} {dynamic}: {:e}", open(&record));
        // What holds it where it comes through: m g (1 + 2 m d² / I), and more than nothing along the rod.
        let held = column(&record, "pin.RF2");
        let mass = if dim == 2 { 100.0 } else { 10.0 };
        let expected = mass * 9.81 * (1.0 + 2.0 * d * d / inertia);
        let most = held.iter().fold(0.0_f64, |m, f| m.max(*f));
        assert!(
            (most / expected - 1.0).abs() < 2e-3,
            "{dim} {dynamic}: {most} {expected}"
        );
    }
}

/// The tyre of the tests of elastic bodies, rigid and on a floor that hardly gives way.
fn tyre(method: &str, motion: [f64; 3], gravity: [f64; 2], end: f64) -> String {
    let text = rolling(method, motion, gravity, end);
    text.replacen(
        "rotation = \"large\"",
        "rotation = \"large\"\nrigid = true",
        1,
    )
}

#[test]
fn a_rigid_tyre_thrown_with_backspin_ends_rolling() {
    let record = run(&tyre("condensed", [0.6, 1.0, 10.0], [0.0, -9.81], 0.2));
    // Friction acts along the road: the moment of momentum about it stays, R V - k² ω for one of mass.
    let about = |v: f64, spin: f64| 0.1 * v - GYRATION * 0.01 * spin;
    let (velocity, spin) = (last(&record, "tyre.V1"), last(&record, "tyre.VR3"));
    let (found, expected) = (about(velocity, spin), about(1.0, 10.0));
    assert!((found / expected - 1.0).abs() < 0.01, "{found} {expected}");
    let rolled = (1.0 - GYRATION) / (1.0 + GYRATION);
    assert!(
        (velocity / rolled - 1.0).abs() < 0.05,
        "{velocity} {rolled}"
    );
    assert!((-0.1 * spin / rolled - 1.0).abs() < 0.05, "{spin} {rolled}");
    // A polygon that lands on its corners: some per mille of the energy cannot be placed.
    assert!(open(&record) < 1e-2, "{:e}", open(&record));
}

#[test]
fn a_rigid_tyre_rolls_or_slides_down_a_slope() {
    // g sin α / (1 + k²/R²) as long as μ > tan α / (1 + R²/k²); else g (sin α - μ cos α), and it spins up by μ g cos α R / k².
    for (slope, mu, rolls) in [(0.2_f64, 0.5, true), (0.8, 0.15, false)] {
        let gravity = [9.81 * slope.sin(), -9.81 * slope.cos()];
        for method in ["sparse", "condensed"] {
            let record = run(&tyre(method, [mu, 0.0, 0.0], gravity, 0.3));
            let (down, spun) = match rolls {
                true => (
                    gravity[0] / (1.0 + GYRATION),
                    gravity[0] / (1.0 + GYRATION) / 0.1,
                ),
                false => (
                    gravity[0] + mu * gravity[1],
                    -mu * gravity[1] * 0.1 / (GYRATION * 0.01),
                ),
            };
            let (way, angle) = (last(&record, "tyre.U1"), -last(&record, "tyre.UR3"));
            let half = 0.5 * 0.3 * 0.3;
            assert!(
                (way / (half * down) - 1.0).abs() < 0.01,
                "{method}: {way} {}",
                half * down
            );
            assert!(
                (angle / (half * spun) - 1.0).abs() < 0.02,
                "{method}: {angle} {}",
                half * spun
            );
        }
    }
}

#[test]
fn an_explicit_step_rolls_it_as_well() {
    let slope = 0.2_f64;
    let gravity = [9.81 * slope.sin(), -9.81 * slope.cos()];
    let text = tyre("automatic", [0.5, 0.0, 0.0], gravity, 0.3);
    let scheme = "dynamic.scheme.generalised-alpha.rho = 0.8";
    let explicit = text.replace(scheme, "dynamic.scheme.central-difference = {}");
    let explicit = explicit.replace("increments = { initial = 0.002, largest = 0.002 }", "");
    let record = run(&explicit);
    let expected = 0.5 * gravity[0] / (1.0 + GYRATION) * 0.3 * 0.3;
    let way = last(&record, "tyre.U1");
    assert!((way / expected - 1.0).abs() < 0.02, "{way} {expected}");
}

/// A rigid ball on a plane that stands still.
fn ball(dynamic: &str, end: f64, increments: &str) -> String {
    format!(
        r#"
        format = 1
        model.space = "solid"
        [body.ball]
        material = "m"
        rigid = true
        rotation = "large"
        generate.ball = {{ centre = [0, 0, 0], radius = 0.1, direction = [0, 0, 1], size = 0.03 }}
        [material.m]
        isotropic = {{ young = 1e7, poisson = 0.3, density = 1000 }}
        [obstacle.table]
        plane = {{ point = [0, 0, -0.1], normal = [0, 0, 1] }}
        [interface.table]
        secondary = "ball.arc"
        primary = "table"
        normal.linear.c = 1e10
        friction.coulomb.mu = 0.5
        [load.weight]
        set = "ball"
        gravity.acceleration = [0, 0, -9.81]
        [initial.throw]
        set = "ball"
        velocity = [1, 0, 0]
        spin = [0, -10, 0]
        [[step]]
        duration = {end}
        dynamic = {dynamic}
        {increments}
        "#
    )
}

#[test]
fn a_ball_thrown_with_backspin_ends_with_five_sevenths_of_its_velocity_less_two_of_its_spin() {
    let record = run(&ball(
        "{ scheme.generalised-alpha.rho = 0.8 }",
        0.25,
        "increments = { initial = 0.001, largest = 0.001 }",
    ));
    // Backspin, -ω about y: the moment of momentum about the table stays.
    let expected = 5.0 / 7.0 - 2.0 / 7.0 * 0.1 * 10.0;
    let (velocity, spin) = (last(&record, "ball.V1"), last(&record, "ball.VR2"));
    assert!(
        (velocity / expected - 1.0).abs() < 0.05,
        "{velocity} {expected}"
    );
    assert!(
        (0.1 * spin / expected - 1.0).abs() < 0.05,
        "{spin} {expected}"
    );
    for name in ["ball.V2", "ball.VR1", "ball.VR3"] {
        assert!(last(&record, name).abs() < 0.05, "{name}");
    }
}

/// The roller of the tests of elastic bodies, rigid.
fn rigid_roller(increments: usize) -> String {
    let text = roller(true, increments).replacen(
        "rotation = \"large\"",
        "rotation = \"large\"\nrigid = true",
        1,
    );
    text.replace("poisson = 0.3 }", "poisson = 0.3, density = 1000 }")
}

#[test]
fn a_rigid_roller_goes_half_the_way_of_what_it_carries() {
    let record = run(&rigid_roller(40));
    let (way, angle) = (column(&record, "roller.U1"), column(&record, "roller.UR3"));
    let (end, middle) = (way.len() - 1, way.len() / 2 - 1);
    let gone = way[end] - way[middle];
    assert!((gone - 0.1).abs() < 1e-3, "{gone}");
    let radius = -gone / (angle[end] - angle[middle]);
    assert!((0.0985..0.1005).contains(&radius), "{radius}");
    let (below, above) = (last(&record, "below.CFN2"), last(&record, "above.CFN2"));
    assert!((below + above).abs() < 1e-6 * below, "{below} {above}");
}

#[test]
fn runs_with_rigid_bodies_that_turn_go_on_where_they_stopped() {
    let increments = "increments = { initial = 0.001, largest = 0.001 }";
    let cases = [
        (
            "tyre",
            tyre("condensed", [0.6, 1.0, 10.0], [0.0, -9.81], 0.03),
        ),
        (
            "ball",
            ball("{ scheme.generalised-alpha.rho = 0.8 }", 0.02, increments),
        ),
        ("explicit ball", ball(EXPLICIT, 0.002, "")),
        (
            "top",
            top(MIDPOINT, [50.0, 1.0], 0.002).replace("= 0.6", "= 0.02"),
        ),
        ("roller at rest", rigid_roller(20)),
        ("drum", driven(true, [90, 100])),
    ];
    for (name, text) in cases {
        restart::check(name, &support::problem(&text), Path::new("."), 3);
    }
}

/// A roller of so many sides on an axle that is pressed against a rigid drum, an obstacle, which turns by two revolutions in so many increments.
fn driven(rigid: bool, [sides, increments]: [usize; 2]) -> String {
    let body = match rigid {
        true => "rigid = true",
        false => "",
    };
    let hub = match rigid {
        true => "",
        false => "[support.hub]\nset = \"wheel.bore\"\nx = 0\ny = 0",
    };
    format!(
        r#"
        format = 1
        model.space = "plane-strain"
        [body.wheel]
        material = "m"
        {body}
        rotation.with = "axle"
        generate.ring = {{ bore = 0.03, radius = 0.1, cells = [{sides}, 3] }}
        [material.m]
        isotropic = {{ young = 1e7, poisson = 0.3, density = 1000 }}
        [reference.axle]
        point = [0, 0]
        {hub}
        [obstacle.drum]
        cylinder = {{ centre = [0, -0.15], radius = 0.05 }}
        motion.rotation = {{ centre = [0, -0.15], angle = [[1, 0], [2, 12.566370614359172]] }}
        [interface.nip]
        secondary = "wheel.rim"
        primary = "drum"
        normal.linear.c = 1e10
        friction.coulomb.mu = 0.4
        [support.axle]
        set = "axle"
        x = 0
        [load.press]
        set = "axle"
        nodal-force.value = [0, -2000]
        amplitude = "press"
        [amplitude.press]
        table = [[0, 0], [1, 1]]
        [[step]]
        increments.fixed = 5
        [[step]]
        increments.fixed = {increments}
        "#
    )
}

#[test]
fn a_drum_that_turns_by_revolutions_drives_a_wheel_by_the_ratio_of_radii() {
    // In increments as long as a side, and longer than three of them, too.
    for (rigid, cells) in [
        (true, [360, 500]),
        (false, [360, 500]),
        (true, [90, 100]),
        (true, [360, 133]),
    ] {
        let record = run(&driven(rigid, cells));
        let angle = last(&record, "axle.UR3");
        let expected = -0.5 * 4.0 * PI;
        // A polygon, and a rim that is pressed in.
        assert!(
            (angle / expected - 1.0).abs() < 0.01,
            "{rigid} {cells:?}: {angle} {expected}"
        );
    }
}

#[test]
fn what_rigid_bodies_that_turn_cannot_bear_is_refused() {
    let expect = |text: &str, part: &str| {
        let found = match Problem::from_toml(text, None) {
            Err(e) => e.to_string(),
            Ok(problem) => match support::build(&problem) {
                Err(e) => e.to_string(),
                Ok(_) => panic!("{part}: accepted"),
            },
        };
        assert!(found.contains(part), "{found}");
    };
    let base = tyre("automatic", [0.5, 0.0, 0.0], [0.0, -9.81], 0.1);
    expect(
        &format!("{base}\n[[step]]\nmodes.count = 3\n"),
        "does not support",
    );
    let spring = "\n[load.spring]\nset = \"tyre.bore\"\nspring.stiffness = [1, 1]\n";
    expect(&format!("{base}{spring}"), "would turn");
    let base = pendulum(2, MIDPOINT);
    let loose = base.replacen("x = 0", "", 1);
    expect(&loose, "does not stand still");
    let held = format!("{base}\n[support.end]\nset = \"rod.right\"\nx = 0\n");
    expect(&held, "is carried by a reference point");
    let thrown = format!("{base}\n[initial.throw]\nset = \"rod\"\nspin = [3]\n");
    expect(&thrown, "is carried by a reference point");
}

#[test]
fn a_prescribed_rotation_in_space_takes_points_where_rodrigues_formula_does() {
    let axis = [2.0 / 3.0, -1.0 / 3.0, 2.0 / 3.0];
    let angle = 7.5_f64;
    let turn = axis.map(|a| a * angle);
    let text = |step: &str| {
        format!(
            r#"
            format = 1
            model.space = "solid"
            [body.block]
            material = "m"
            rigid = true
            rotation.with = "axle"
            generate.box = {{ to = [0.3, 0.2, 0.1], cells = [1, 1, 1] }}
            [body.other]
            material = "m"
            generate.box = {{ from = [2, 0, 0], to = [3, 1, 1], cells = [1, 1, 1] }}
            [material.m]
            isotropic = {{ young = 1e7, poisson = 0.3, density = 1000 }}
            [reference.axle]
            point = [0, 0, 0]
            [support.other]
            set = "other.bottom"
            x = 0
            y = 0
            z = 0
            [support.axle]
            set = "axle"
            x = 0
            y = 0
            z = 0
            rotation-x = {:?}
            rotation-y = {:?}
            rotation-z = {:?}
            [probe.corner]
            of = "block"
            point = [0.3, 0.2, 0.1]
            [[step]]
            duration = 1
            {step}
            "#,
            turn[0], turn[1], turn[2]
        )
    };
    let x = [0.3, 0.2, 0.1];
    let (along, swept) = ((0..3).map(|i| axis[i] * x[i]).sum::<f64>(), cross(axis, x));
    let (s, c) = angle.sin_cos();
    for step in [
        "increments.fixed = 15",
        "dynamic = {}\nincrements.fixed = 15",
        "dynamic.scheme.central-difference = {}",
    ] {
        let record = run(&text(step));
        for i in 0..3 {
            let expected = (c - 1.0) * x[i] + s * swept[i] + (1.0 - c) * along * axis[i];
            let found = last(&record, &format!("corner.U{}", i + 1));
            assert!(
                (found - expected).abs() < 1e-12,
                "{step}: {found} {expected}"
            );
        }
    }
}

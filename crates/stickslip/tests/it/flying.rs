//! Bodies that turn freely by any angle in motion: what nothing acts on keeps its momenta, what rolls and swings does so as textbooks have it.

use std::f64::consts::{FRAC_PI_2, PI};
use std::path::Path;

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

/// By how much a column leaves its first value.
fn drift(record: &Record, name: &str) -> f64 {
    let values = column(record, name);
    values.iter().fold(0.0, |m, v| m.max((v - values[0]).abs()))
}

/// The trapezoidal rule in the middle of increments: no numerical dissipation.
const MIDPOINT: &str = "{ scheme.generalised-alpha.rho = 1 }";

fn thrown(dim: usize, dynamic: &str, increments: &str) -> String {
    let (space, mesh, spin, velocity) = match dim {
        2 => (
            "plane-strain",
            "rectangle = { to = [4, 1], cells = [12, 3] }",
            "[9.0]",
            "[1.0, 0.5]",
        ),
        _ => (
            "solid",
            "box = { to = [3, 2, 1], cells = [4, 3, 2] }",
            "[1.0, 8.0, 1.0]",
            "[1.0, 0.5, 0.2]",
        ),
    };
    format!(
        r#"
        format = 1
        model.space = "{space}"
        solver.tolerance = 1e-11
        [body.block]
        material = "m"
        rotation = "large"
        generate.{mesh}
        [material.m]
        isotropic = {{ young = 1e6, poisson = 0.3, density = 1 }}
        [initial.throw]
        set = "block"
        spin = {spin}
        velocity = {velocity}
        [[step]]
        duration = 1.5
        dynamic = {dynamic}
        increments = {increments}
        "#
    )
}

#[test]
fn what_is_thrown_keeps_its_momenta() {
    let implicit = "{ initial = 0.015, largest = 0.015 }";
    for (dim, dynamic, increments, energy) in [
        (2, MIDPOINT, implicit, 1e-4),
        (3, MIDPOINT, implicit, 1e-4),
        (2, "{ scheme.central-difference = {} }", "{}", 1e-3),
        (3, "{ scheme.central-difference = {} }", "{}", 1e-3),
    ] {
        let record = run(&thrown(dim, dynamic, increments));
        let names: &[&str] = match dim {
            2 => &["P1", "P2", "L3"],
            _ => &["P1", "P2", "P3", "L1", "L2", "L3"],
        };
        for name in names {
            let name = format!("block.{name}");
            let size = column(&record, &name)[0].abs();
            let off = drift(&record, &name) / size;
            assert!(off < 1e-10, "{dim} {dynamic} {name}: {off:e}");
        }
        // It has turned more than once, and what numbers take is told.
        let kept: Vec<f64> = (column(&record, "ALLKE").iter())
            .zip(column(&record, "ALLSE"))
            .map(|(k, s)| k + s)
            .collect();
        let brought = last(&record, "EINITIAL");
        let worst = kept.iter().fold(0.0_f64, |m, e| m.max((e - brought).abs()));
        assert!(
            worst < energy * brought,
            "{dim} {dynamic}: {worst} of {brought}"
        );
        if dynamic == MIDPOINT {
            let open = column(&record, "ERESIDUAL");
            let open = open.iter().fold(0.0_f64, |m, e| m.max(e.abs()));
            assert!(open < 1e-9 * brought, "{dim}: {open}");
        }
    }
}

#[test]
fn what_numbers_take_falls_with_the_square_of_the_increment() {
    let taken = |dt: f64| {
        let text = thrown(
            2,
            MIDPOINT,
            &format!("{{ initial = {dt}, largest = {dt} }}"),
        );
        let values = column(&run(&text), "ALLND");
        values.iter().fold(0.0_f64, |m, e| m.max(e.abs()))
    };
    let (coarse, fine) = (taken(0.01), taken(0.005));
    assert!(fine < 0.4 * coarse, "{coarse} {fine}");
}

/// A plate that spins, damped by its stiffness.
fn spinning(rho: f64) -> String {
    format!(
        r#"
        format = 1
        model.space = "plane-stress"
        solver.tolerance = 1e-11
        [body.disc]
        material = "m"
        rotation = "large"
        rayleigh.stiffness = 2e-2
        generate.ring = {{ bore = 0.25, radius = 1, cells = [32, 12] }}
        [material.m]
        isotropic = {{ young = 1e5, poisson = 0.3, density = 1 }}
        [probe.bore]
        point = [0.25, 0]
        [initial.spin]
        set = "disc"
        spin = [10]
        [[step]]
        duration = 1.256637
        dynamic.scheme.generalised-alpha.rho = {rho}
        increments = {{ initial = 0.01, largest = 0.01 }}
        "#
    )
}

#[test]
fn a_disc_that_spins_is_strained_by_that_alone_and_damping_does_not_brake_it() {
    let record = run(&spinning(1.0));
    let turned = last(&record, "disc.UR3");
    let spin = last(&record, "disc.VR3");
    assert!((spin / 10.0 - 1.0).abs() < 2e-3, "{spin}");
    let off = drift(&record, "disc.L3") / column(&record, "disc.L3")[0];
    assert!(off < 1e-10, "{off:e}");
    // Twice round: hoop stress at the bore, (3 + ν)/4 ρ ω² b² (1 + (1 - ν)/(3 + ν) (a/b)²), along the tangent there.
    let stress: Vec<f64> = ["S11", "S22", "S12"]
        .iter()
        .map(|s| last(&record, &format!("bore.{s}")))
        .collect();
    let (s, c) = turned.sin_cos();
    let hoop = s * s * stress[0] + c * c * stress[1] - 2.0 * s * c * stress[2];
    let expected = 0.25 * 3.3 * spin * spin * (1.0 + 0.7 / 3.3 * 0.0625);
    assert!((hoop / expected - 1.0).abs() < 0.03, "{hoop} {expected}");
}

#[test]
fn a_pendulum_swings_as_slowly_as_its_angle_asks_for() {
    // A rod of length 1 and height h, held at a corner and let go where it lies: K(sin 45°) = 1.8540746773.
    let text = r#"
        format = 1
        model.space = "plane-strain"
        [body.rod]
        material = "m"
        rotation = "large"
        generate.rectangle = { from = [0, -0.05], to = [1, 0.05], cells = [20, 2] }
        [material.m]
        isotropic = { young = 1e8, poisson = 0.3, density = 1000 }
        [set.pin]
        of = "rod"
        point = [0, 0]
        [support.pin]
        set = "pin"
        x = 0
        y = 0
        [load.weight]
        set = "rod"
        gravity.acceleration = [0, -9.81]
        [[step]]
        duration = 0.7
        dynamic.scheme.generalised-alpha.rho = 0.9
        increments = { initial = 0.005, largest = 0.005 }
    "#;
    let record = run(text);
    let (d, inertia) = (0.5, (1.0 + 0.01) / 12.0 + 0.25);
    let quarter = 1.8540746773 * f64::sqrt(inertia / (9.81 * d));
    let (times, angles) = (column(&record, "TIME"), column(&record, "rod.UR3"));
    let after = angles
        .iter()
        .position(|a| *a <= -FRAC_PI_2)
        .expect("it comes down");
    let part = (-FRAC_PI_2 - angles[after - 1]) / (angles[after] - angles[after - 1]);
    let found = times[after - 1] + part * (times[after] - times[after - 1]);
    assert!((found / quarter - 1.0).abs() < 2e-3, "{found} {quarter}");
    // What holds it there: m g (1 + 2 m d² / I).
    let held = column(&record, "pin.RF2");
    let mass = 100.0;
    let expected = mass * 9.81 * (1.0 + 2.0 * d * d / inertia);
    let near = &held[after - 2..after + 2];
    let mean = near.iter().sum::<f64>() / near.len() as f64;
    assert!((mean / expected - 1.0).abs() < 0.02, "{mean} {expected}");
}

/// A tyre of radius 0.1 on a floor.
pub(crate) fn rolling(
    method: &str,
    [mu, velocity, spin]: [f64; 3],
    gravity: [f64; 2],
    end: f64,
) -> String {
    format!(
        r#"
        format = 1
        model.space = "plane-strain"
        solver.method = "{method}"
        [body.tyre]
        material = "m"
        rotation = "large"
        generate.ring = {{ bore = 0.03, radius = 0.1, cells = [160, 3] }}
        [body.floor]
        material = "m"
        generate.rectangle = {{ from = [-0.3, -0.2], to = [0.3, -0.1], cells = [60, 3] }}
        [material.m]
        isotropic = {{ young = 1e7, poisson = 0.3, density = 1000 }}
        [interface.road]
        secondary = "tyre.rim"
        primary = "floor.top"
        normal.linear.c = 1e10
        friction.coulomb.mu = {mu}
        [support.floor]
        set = "floor.bottom"
        x = 0
        y = 0
        [load.weight]
        set = "tyre"
        gravity.acceleration = {gravity:?}
        [initial.throw]
        set = "tyre"
        velocity = [{velocity}, 0]
        spin = [{spin}]
        [[step]]
        duration = {end}
        dynamic.scheme.generalised-alpha.rho = 0.8
        increments = {{ initial = 0.002, largest = 0.002 }}
        "#
    )
}

/// `k²/R²` of the tyre.
pub(crate) const GYRATION: f64 = 0.5 * (1.0 + 0.09);

#[test]
fn a_tyre_thrown_with_backspin_ends_rolling_with_what_momentum_is_left_about_the_road() {
    let record = run(&rolling("condensed", [0.6, 1.0, 10.0], [0.0, -9.81], 0.2));
    // Friction acts along the road: the moment of momentum about it stays, R V - k² ω for one of mass.
    let about = |v: f64, spin: f64| 0.1 * v - GYRATION * 0.01 * spin;
    let (velocity, spin) = (last(&record, "tyre.V1"), last(&record, "tyre.VR3"));
    let (found, expected) = (about(velocity, spin), about(1.0, 10.0));
    assert!((found / expected - 1.0).abs() < 0.01, "{found} {expected}");
    // A polygon rocks on its sides: velocity and rim agree in the mean.
    let rolled = (1.0 - GYRATION) / (1.0 + GYRATION);
    assert!(
        (velocity / rolled - 1.0).abs() < 0.05,
        "{velocity} {rolled}"
    );
    assert!((-0.1 * spin / rolled - 1.0).abs() < 0.05, "{spin} {rolled}");
    // Before it rolls, friction has the limit: the velocity falls by μ g t.
    let (times, velocities) = (column(&record, "TIME"), column(&record, "tyre.V1"));
    let early = times.iter().position(|t| *t > 0.05).expect("a row");
    let expected = 1.0 - 0.6 * 9.81 * times[early];
    assert!(
        (velocities[early] - expected).abs() < 0.03,
        "{} {expected}",
        velocities[early]
    );
}

#[test]
fn a_tyre_rolls_down_a_slope_by_its_gyration() {
    let slope = 0.2_f64;
    let gravity = [9.81 * slope.sin(), -9.81 * slope.cos()];
    let record = run(&rolling("sparse", [0.5, 0.0, 0.0], gravity, 0.3));
    let expected = 0.5 * gravity[0] / (1.0 + GYRATION) * 0.3 * 0.3;
    let way = last(&record, "tyre.U1");
    assert!((way / expected - 1.0).abs() < 0.01, "{way} {expected}");
    let rolled = -0.1 * last(&record, "tyre.UR3");
    assert!(
        (rolled / expected - 1.0).abs() < 0.01,
        "{rolled} {expected}"
    );
}

#[test]
fn all_ways_to_solve_find_the_same_and_runs_go_on_where_they_stopped() {
    let text = |method| rolling(method, [0.6, 1.0, 10.0], [0.0, -9.81], 0.03);
    let records = ["condensed", "sparse", "multigrid"].map(|m| run(&text(m)));
    for name in [
        "tyre.U1",
        "tyre.U2",
        "tyre.VR3",
        "ALLKE",
        "ALLFD",
        "road.CFN2",
    ] {
        let found = records.each_ref().map(|r| last(r, name));
        let scale = found[0].abs().max(1e-3);
        assert!(
            (found[1] - found[0]).abs() < 1e-6 * scale,
            "{name}: {found:?}"
        );
        assert!(
            (found[2] - found[0]).abs() < 1e-6 * scale,
            "{name}: {found:?}"
        );
    }
    for method in ["condensed", "sparse"] {
        let problem = support::problem(&text(method));
        restart::check(method, &problem, Path::new("."), 3);
    }
}

#[test]
fn loads_keep_their_direction_or_follow() {
    // A steady acceleration along an axis that turns: v = a/ω (sin ωt, 1 - cos ωt).
    let text = |follow: bool, scheme: &str| {
        format!(
            r#"
            format = 1
            model.space = "plane-strain"
            [body.block]
            material = "m"
            rotation = "large"
            generate.rectangle = {{ from = [-1, -1], to = [1, 1], cells = [4, 4] }}
            [material.m]
            isotropic = {{ young = 1e7, poisson = 0.3, density = 1 }}
            [load.thrust]
            set = "block"
            gravity.acceleration = [3, 0]
            follow = {follow}
            [initial.spin]
            set = "block"
            spin = [4]
            [[step]]
            duration = 1
            dynamic.scheme = {scheme}
            increments = {{ initial = 0.01, largest = 0.01 }}
            "#
        )
    };
    for scheme in [
        "{ generalised-alpha.rho = 1 }",
        "{ central-difference = {} }",
    ] {
        let record = run(&text(true, scheme));
        let expected = [0.75 * 4.0_f64.sin(), 0.75 * (1.0 - 4.0_f64.cos())];
        for (i, expected) in expected.into_iter().enumerate() {
            let found = last(&record, &format!("block.V{}", i + 1));
            assert!(
                (found - expected).abs() < 5e-3,
                "{scheme}: {found} {expected}"
            );
        }
        let record = run(&text(false, scheme));
        assert!((last(&record, "block.V1") - 3.0).abs() < 1e-8);
        assert!(last(&record, "block.V2").abs() < 1e-8);
        let turned = last(&record, "block.UR3");
        assert!((turned - (4.0 - 2.0 * PI)).abs() < 1e-3, "{turned}");
    }
}

#[test]
fn what_such_bodies_cannot_bear_is_refused() {
    let base = rolling("automatic", [0.5, 0.0, 0.0], [0.0, -9.81], 0.1);
    let expect = |text: &str, part: &str| {
        let text = format!("{base}{text}");
        let found = match Problem::from_toml(&text, None) {
            Err(e) => e.to_string(),
            Ok(problem) => match support::build(&problem) {
                Err(e) => e.to_string(),
                Ok(_) => panic!("{part}: accepted"),
            },
        };
        assert!(found.contains(part), "{found}");
    };
    expect("\n[[step]]\nmodes.count = 3\n", "does not support");
    expect(
        "\n[support.rail]\nset = \"tyre.bore\"\ny = 0\n",
        "all directions",
    );
    expect(
        "\n[load.spring]\nset = \"tyre.bore\"\nspring.stiffness = [1, 1]\n",
        "would turn",
    );
}

#[test]
fn a_heavy_top_precesses_with_its_axis_level() {
    // A square slab on a pin at the middle of its face: Ω = m g d / (I₃ ω), exact for an axis that stays level, with which the motion begins.
    let (spin, d) = (50.0, 0.05);
    let turn = 9.81 * d / (0.04 / 6.0 * spin);
    let text = format!(
        r#"
        format = 1
        model.space = "solid"
        [body.top]
        material = "m"
        rotation = "large"
        generate.box = {{ from = [0, -0.1, -0.1], to = [0.1, 0.1, 0.1], cells = [2, 4, 4] }}
        [material.m]
        isotropic = {{ young = 1e9, poisson = 0.3, density = 1000 }}
        [set.pin]
        of = "top"
        point = [0, 0, 0]
        [support.pin]
        set = "pin"
        x = 0
        y = 0
        z = 0
        [load.weight]
        set = "top"
        gravity.acceleration = [0, 0, -9.81]
        [initial.spin]
        set = "top"
        spin = [{spin}, 0, {turn}]
        velocity = [0, {}, 0]
        [[step]]
        duration = 0.4
        dynamic = {MIDPOINT}
        increments = {{ initial = 0.004, largest = 0.004 }}
        "#,
        turn * d
    );
    let record = run(&text);
    let way = |i: usize| last(&record, &format!("top.U{i}")) / d;
    let axis = [1.0 + way(1), way(2), way(3)];
    let found = axis[1].atan2(axis[0]);
    assert!(
        (found / (0.4 * turn) - 1.0).abs() < 1e-3,
        "{found} {}",
        0.4 * turn
    );
    assert!(axis[2].abs() < 1e-3, "{axis:?}");
}

/// A roller between a floor and a lid that is pressed down and then drawn along.
pub(crate) fn roller(large: bool, increments: usize) -> String {
    let rotation = if large { "rotation = \"large\"" } else { "" };
    format!(
        r#"
        format = 1
        model.space = "plane-strain"
        [body.roller]
        material = "m"
        {rotation}
        generate.ring = {{ bore = 0.03, radius = 0.1, cells = [120, 4] }}
        [body.floor]
        material = "m"
        generate.rectangle = {{ from = [-0.1, -0.15], to = [0.3, -0.1], cells = [80, 4] }}
        [body.lid]
        material = "m"
        generate.rectangle = {{ from = [-0.3, 0.1], to = [0.2, 0.15], cells = [100, 4] }}
        [material.m]
        isotropic = {{ young = 1e7, poisson = 0.3 }}
        [support.floor]
        set = "floor.bottom"
        x = 0
        y = 0
        [support.press]
        set = "lid.top"
        y = -1e-3
        amplitude = "press"
        [support.drag]
        set = "lid.top"
        x = 0.2
        amplitude = "drag"
        [amplitude.press]
        table = [[0, 0], [1, 1]]
        [amplitude.drag]
        table = [[0, 0], [1, 0], [2, 1]]
        [interface.below]
        secondary = "roller.rim"
        primary = "floor.top"
        normal.linear.c = 1e11
        friction.coulomb.mu = 0.3
        [interface.above]
        secondary = "roller.rim"
        primary = "lid.bottom"
        normal.linear.c = 1e11
        friction.coulomb.mu = 0.3
        [[step]]
        duration = 2
        increments = {{ initial = {0}, largest = {0} }}
        "#,
        2.0 / increments as f64
    )
}

#[test]
fn a_roller_goes_half_the_way_of_what_it_carries_and_turns_with_it() {
    let record = run(&roller(true, 40));
    let way = column(&record, "roller.U1");
    let angle = column(&record, "roller.UR3");
    let (end, middle) = (way.len() - 1, way.len() / 2 - 1);
    // All of it is symmetric about the centre: the lid goes by 0.2.
    assert!((way[end] - way[middle] - 0.1).abs() < 2e-4, "{way:?}");
    // Its radius is what the lid leaves of it, or a little more: the rim between the contacts keeps its length.
    let radius = -(way[end] - way[middle]) / (angle[end] - angle[middle]);
    assert!((0.0995..0.1002).contains(&radius), "{radius}");
    let (below, above) = (last(&record, "below.CFN2"), last(&record, "above.CFN2"));
    assert!((below + above).abs() < 1e-6 * below, "{below} {above}");
    // Pressed by as much whatever the angle, but for the sides of the polygon.
    let pressed = column(&record, "below.CFN2");
    assert!(
        (pressed[end] / pressed[middle] - 1.0).abs() < 0.06,
        "{pressed:?}"
    );
}

#[test]
fn a_roller_goes_on_where_it_was_stopped() {
    let problem = support::problem(&roller(true, 20));
    restart::check("roller", &problem, Path::new("."), 3);
}

#[test]
fn small_rotations_are_those_of_the_linear_theory() {
    let press = |large| {
        let text = roller(large, 40).replace("duration = 2", "duration = 1");
        let text = text
            .replace("y = -1e-3", "y = -1e-6")
            .replace("1e11", "1e9");
        run(&text)
    };
    let (large, small) = (press(true), press(false));
    for name in ["below.CFN2", "above.CFN2", "ALLSE", "ALLCE"] {
        let (a, b) = (last(&large, name), last(&small, name));
        assert!((a / b - 1.0).abs() < 1e-4, "{name}: {a} {b}");
    }
}

/// A ring on a rigid hub that a torque turns.
fn on_a_hub(dynamic: &str, increments: usize) -> String {
    format!(
        r#"
        format = 1
        model = {{ space = "plane-strain", thickness = 0.01 }}
        reference.axle.point = [0, 0]
        [body.hub]
        rigid = true
        rotation.with = "axle"
        material = "steel"
        generate.ring = {{ radius = 0.02, bore = 0.01, cells = [16, 2] }}
        [body.ring]
        rotation = "large"
        material = "steel"
        generate.ring = {{ radius = 0.06, bore = 0.02, cells = [16, 3] }}
        [material.steel.isotropic]
        young = 2.1e11
        poisson = 0.3
        density = 7800
        [interface.press]
        secondary = "ring.bore"
        primary = "hub.rim"
        tied = true
        [support.axle]
        set = "axle"
        x = 0
        y = 0
        [load.drive]
        set = "axle"
        moment.value = [10.0]
        [[step]]
        duration = 0.03
        increments.fixed = {increments}
        dynamic = {dynamic}
        "#
    )
}

/// What turns on an axle in motion is an elastic body on a rigid hub: the moment on the axle is the rate of angular momentum, its work the energy of both, and where they are tied they stay together. By the forces at the ends of increments the tie would brake them, and is refused.
#[test]
fn a_ring_on_a_rigid_hub_takes_what_a_torque_gives() {
    let stage = r#"{ scheme.generalised-alpha.rho = 0.8, contact-at = "stage" }"#;
    // Half the mass times the sum of the squares of the radii, and what a polygon of sixteen sides has less than its circle: a fortieth.
    let polygon = |r: f64| 8.0 * r * r * (PI / 8.0).sin();
    let mass = 78.0 * (polygon(0.02) - polygon(0.01));
    let sides = 1.0 - 2.0 / 3.0 * (PI / 16.0).sin().powi(2);
    let hub = sides * mass * (0.02_f64.powi(2) + 0.01_f64.powi(2)) / 2.0;
    let record = run(&on_a_hub(stage, 240));
    let [time, ring, spin, angle] =
        ["TIME", "ring.L3", "ring.VR3", "axle.UR3"].map(|c| last(&record, c));
    let (given, there) = (10.0 * time, ring + hub * spin);
    assert!(angle > 2.0 && spin > 150.0, "it hardly turns");
    assert!((there / given - 1.0).abs() < 1e-4, "{there} of {given}");
    let lag = last(&record, "ring.UR3") - angle;
    assert!(lag.abs() < 1e-5 * angle, "the hub lags by {lag}");
    let [work, kinetic] = ["ALLWK", "ALLKE"].map(|c| last(&record, c));
    assert!((work / (10.0 * angle) - 1.0).abs() < 1e-3, "{work}");
    assert!((kinetic / work - 1.0).abs() < 2e-4, "{kinetic} {work}");

    let said = support::complaint(&on_a_hub("{ scheme.generalised-alpha.rho = 0.8 }", 10));
    assert!(
        said.contains("interface.press.tied") && said.contains("brakes both"),
        "{said}"
    );
}

/// A rigid body that nothing acts on has no forces to compare its balance with but those that would stop it: rounding over rounding is no figure.
#[test]
fn a_rigid_body_that_flies_freely_is_in_balance() {
    let text = r#"
        format = 1
        model.space = "plane-strain"
        body.b = { generate.rectangle = { to = [1, 1], cells = [1, 1] }, material = "m", rigid = true, rotation = "large" }
        material.m.isotropic = { young = 1e7, poisson = 0.3, density = 1000 }
        initial.throw = { set = "b", velocity = [1, 0], spin = [1] }
        step = [{ increments.fixed = 10, dynamic.scheme.generalised-alpha.rho = 1 }]
    "#;
    let mut simulation = support::build(&support::problem(text)).expect("sound");
    simulation.run(&mut []).expect("a flight");
    let gate = &simulation.summary.quality;
    let figure = gate.figures.iter().find(|f| f.figure == "equilibrium");
    assert!(gate.met, "{figure:?}");
    assert!(figure.expect("judged").value < 1e-9, "{figure:?}");
}

//! Bodies that turn by any angle: forces and iterations do not see a turn of everything, forces on frames balance where points are, loads keep their direction
//! in space or turn, gears hand on torque as their numbers of teeth say.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use crate::support::{self, Record};
use stickslip::math::{Vec3, mat_vec, rotation, scale, sub};
use stickslip::problem::Problem;
use stickslip::run::Simulation;

/// A run that must succeed.
fn run(text: &str) -> (Record, Simulation) {
    let mut record = Record::default();
    let problem = support::problem(text);
    let mut simulation = support::build(&problem).unwrap_or_else(|e| panic!("{e}"));
    let outcome = simulation.run(&mut [&mut record]);
    outcome.unwrap_or_else(|e| panic!("{e}"));
    (record, simulation)
}

/// The value of a column in every row.
fn column(record: &Record, name: &str) -> Vec<f64> {
    let rows = record.increments.iter();
    rows.map(|(_, row)| row.get(name).unwrap_or_else(|| panic!("no column {name}")))
        .collect()
}

fn vector(record: &Record, row: usize, name: &str, dim: usize) -> Vec3 {
    std::array::from_fn(|c| match c < dim {
        true => column(record, &format!("{name}{}", c + 1))[row],
        false => 0.0,
    })
}

fn close(a: Vec3, b: Vec3, tolerance: f64, what: &str) {
    let apart = stickslip::math::norm(sub(a, b));
    assert!(apart <= tolerance, "{what}: {a:?} and {b:?}");
}

/// Two blocks with friction, pressed and sheared in one frame, which then turns by an angle about an axis.
fn assembly(dim: usize, axis: Vec3, angle: f64, increments: usize, method: &str) -> String {
    let (space, at) = match dim {
        2 => ("plane-strain", "[0.2, -0.3]"),
        _ => ("solid", "[0.2, -0.3, 0.1]"),
    };
    let block = |from: [f64; 3], to: [f64; 3], cells: [usize; 3]| match dim {
        2 => format!(
            "generate.rectangle = {{ from = {:?}, to = {:?}, cells = {:?} }}",
            &from[..2],
            &to[..2],
            &cells[..2]
        ),
        _ => {
            let turned = |v: [f64; 3]| [v[0], v[2], v[1]];
            let cells = [cells[0], cells[2], cells[1]];
            format!(
                "generate.box = {{ from = {:?}, to = {:?}, cells = {cells:?} }}",
                turned(from),
                turned(to)
            )
        }
    };
    let lower = block([-1.0, -1.0, -0.5], [1.0, 0.0, 0.5], [8, 4, 3]);
    let upper = block([-0.5, 0.0, -0.3], [0.5, 1.0, 0.3], [5, 5, 2]);
    let (base, press) = match dim {
        2 => ("x = 0, y = 0", "x = 5e-4, y = -1e-3"),
        _ => ("x = 0, y = 0, z = 0", "x = 5e-4, y = 1e-4, z = -1e-3"),
    };
    let turn = scale(angle, axis);
    let turn = match dim {
        2 => format!("x = 0, y = 0, rotation-z = {:?}", turn[2]),
        _ => format!(
            "x = 0, y = 0, z = 0, rotation-x = {:?}, rotation-y = {:?}, rotation-z = {:?}",
            turn[0], turn[1], turn[2]
        ),
    };
    format!(
        r#"
        format = 1
        model.space = "{space}"
        solver.method = "{method}"
        reference.axle = {{ point = {at} }}
        body.lower = {{ {lower}, material = "steel", rotation.with = "axle" }}
        body.upper = {{ {upper}, material = "steel", rotation.with = "axle" }}
        material.steel.isotropic = {{ young = 1e5, poisson = 0.3 }}
        interface.joint = {{ secondary = "upper.bottom", primary = "lower.top", friction.coulomb.mu = 0.3 }}
        support.base = {{ set = "lower.bottom", {base} }}
        support.press = {{ set = "upper.top", {press} }}
        support.turn = {{ set = "axle", {turn}, amplitude = "turn" }}
        amplitude.turn.table = [[0, 0], [1, 0], [2, 1]]
        probe.corner = {{ of = "upper", point = {corner} }}
        step = [{{ increments.fixed = 4 }}, {{ increments.fixed = {increments} }}]
        output.history-every = 1
        "#,
        corner = match dim {
            2 => "[0.5, 1.0]",
            _ => "[0.5, 0.3, 1.0]",
        },
    )
}

#[test]
fn an_assembly_under_stress_turns_as_a_rigid_one() {
    let cases = [
        (2, [0.0, 0.0, 1.0], PI / 180.0, 1, "condensed"),
        (2, [0.0, 0.0, 1.0], PI / 6.0, 1, "sparse"),
        (2, [0.0, 0.0, 1.0], TAU, 1, "condensed"),
        (2, [0.0, 0.0, 1.0], 3.0 * TAU, 100, "condensed"),
        (2, [0.0, 0.0, 1.0], TAU, 10, "sparse"),
        (3, [2.0 / 3.0, -1.0 / 3.0, 2.0 / 3.0], 2.5, 1, "condensed"),
        (
            3,
            [2.0 / 3.0, -1.0 / 3.0, 2.0 / 3.0],
            -1.2 * PI,
            7,
            "sparse",
        ),
    ];
    for (dim, axis, angle, increments, method) in cases {
        let what = format!("{dim}D, {angle} in {increments}, {method}");
        let (record, _) = run(&assembly(dim, axis, angle, increments, method));
        assert_eq!(record.cutbacks, 0, "{what}");
        let rows = record.increments.len();
        let before = 3;
        let turned = column(&record, "axle.UR3");
        let iterations = column(&record, "ITRS");
        let force = stickslip::math::norm(vector(&record, before, "joint.CFN", dim));
        assert!(force > 10.0, "{what}: {force}");
        for row in before + 1..rows {
            let part = turned[row] / (angle * axis[2]);
            let turn = rotation(axis, part * angle);
            for name in ["joint.CFN", "joint.CFS"] {
                let expected = mat_vec(&turn, vector(&record, before, name, dim));
                let found = vector(&record, row, name, dim);
                close(found, expected, 1e-9 * force, &format!("{what}, {name}"));
            }
            // In the axes of the frame supports carry what they did.
            let held = vector(&record, row, "press.RF", dim);
            let was = vector(&record, before, "press.RF", dim);
            close(held, was, 1e-9 * force, &format!("{what}, press"));
            // Nothing turns the frame.
            let torque = vector(&record, row, "axle.RM", 0);
            close(torque, [0.0; 3], 1e-7 * force, &what);
            assert!(
                iterations[row] <= 1.0,
                "{what}: {} iterations",
                iterations[row]
            );
        }
        for name in ["ALLSE", "ALLFD", "joint.CAREA", "joint.CPRESSMAX", "OPEN"] {
            let values = column(&record, name);
            let apart = (values[rows - 1] - values[before]).abs();
            assert!(
                apart <= 1e-9 * values[before].abs().max(1e-6),
                "{what}, {name}: {apart}"
            );
        }
        let work = column(&record, "ALLWK");
        let grown = (work[rows - 1] - work[before]).abs();
        assert!(grown < 1e-5 * work[before], "{what}: work {grown}");
        // What is written is in space: a corner goes round, and its stress turns with it.
        let at = match dim {
            2 => [0.5 - 0.2, 1.0 + 0.3, 0.0],
            _ => [0.5 - 0.2, 0.3 + 0.3, 1.0 - 0.1],
        };
        let moved = |row| vector(&record, row, "corner.U", dim);
        let turn = rotation(axis, angle);
        let place = stickslip::math::add(at, moved(before));
        let expected = sub(mat_vec(&turn, place), at);
        close(moved(rows - 1), expected, 1e-12, &what);
        let stress = |row: usize| -> [[f64; 3]; 3] {
            let s = |name: &str| {
                let rows = &record.increments[row].1;
                rows.get(&format!("corner.S{name}")).unwrap_or(0.0)
            };
            let (a, b, c) = (s("12"), s("23"), s("13"));
            [[s("11"), a, c], [a, s("22"), b], [c, b, s("33")]]
        };
        let (was, now) = (stress(before), stress(rows - 1));
        for i in 0..3 {
            for j in 0..3 {
                let expected: f64 = (0..3)
                    .flat_map(|k| (0..3).map(move |l| (k, l)))
                    .map(|(k, l)| turn[i][k] * was[k][l] * turn[j][l])
                    .sum();
                assert!((now[i][j] - expected).abs() < 1e-6, "{what}: stress {i}{j}");
            }
        }
    }
}

/// A cam, a disc that turns about a shaft off its centre, lifts a follower with a flat face against a spring: by `e (1 - cos θ)`, and the force acts at the arm
/// `e sin θ`.
#[test]
fn an_eccentric_cam_lifts_its_follower_as_its_circle_says() {
    let (e, radius) = (5.0, 20.0);
    let text = |method: &str, increments: usize| {
        format!(
            r#"
            format = 1
            model.space = "plane-strain"
            solver.method = "{method}"
            reference.shaft = {{ point = [0, 0] }}
            body.cam = {{ material = "steel", rotation.with = "shaft", generate.ring = {{ centre = [0, -{e:?}], bore = 3, radius = {radius:?}, cells = [240, 5], element = "quad8" }} }}
            body.follower = {{ material = "steel", generate.rectangle = {{ from = [-8, 15], to = [8, 25], cells = [48, 5], element = "quad8" }} }}
            material.steel.isotropic = {{ young = 2e4, poisson = 0.3 }}
            interface.contact = {{ secondary = "follower.bottom", primary = "cam.rim" }}
            support.hub = {{ set = "cam.bore", x = 0, y = 0 }}
            support.shaft = {{ set = "shaft", x = 0, y = 0, rotation-z = {angle:?}, amplitude = "turn" }}
            support.guide = {{ set = "follower.top", x = 0 }}
            support.slide = {{ set = "follower.left", x = 0 }}
            load.weight = {{ set = "follower.top", pressure.value = 2 }}
            load.spring = {{ set = "follower.top", spring.stiffness = [0, 0.5] }}
            amplitude.turn.table = [[0, 0], [1, 0], [2, 1]]
            probe.lift = {{ of = "follower", point = [0, 25] }}
            step = [{{ increments.fixed = 2 }}, {{ increments.fixed = {increments} }}]
            quality.gate = "off"
            "#,
            angle = TAU * increments as f64 / 36.0
        )
    };
    let (condensed, _) = run(&text("condensed", 36));
    let (sparse, _) = run(&text("sparse", 5));
    let angles = column(&condensed, "shaft.UR3");
    let lift = column(&condensed, "lift.U2");
    let torque = column(&condensed, "shaft.RM3");
    let other = column(&sparse, "shaft.RM3");
    let pressed = column(&condensed, "contact.CFN2");
    for (k, &angle) in angles.iter().enumerate().skip(2) {
        let expected = e * (1.0 - angle.cos());
        // By what both give way, which the spring presses more when the follower is high.
        let moved = lift[k] - lift[1];
        assert!(
            (moved - expected).abs() < 2e-2 * e,
            "{angle}: {moved} for {expected}"
        );
        let expected = pressed[k] * e * angle.sin();
        let off = (torque[k] - expected).abs() / (pressed[k] * e);
        assert!(off < 5e-3, "{angle}: {} for {expected}", torque[k]);
        if let Some(other) = other.get(k) {
            let apart = (torque[k] - other).abs() / (pressed[k] * e);
            assert!(apart < 1e-6, "{angle}: {} and {other}", torque[k]);
        }
    }
    let iterations = column(&condensed, "ITRS");
    let mean = iterations.iter().sum::<f64>() / iterations.len() as f64;
    assert!(mean < 20.0, "{mean} iterations an increment");
}

/// A lever that a torque presses against a block, with friction: nothing but contact resists, and what it carries balances the torque about the pin at the places
/// where points are.
#[test]
fn a_lever_turns_until_contact_balances_its_torque() {
    let text = |method: &str| {
        format!(
            r#"
            format = 1
            model.space = "plane-strain"
            solver.method = "{method}"
            reference.pin = {{ point = [0, 0] }}
            body.lever = {{ material = "steel", rotation.with = "pin", generate.rectangle = {{ from = [-2, -3], to = [30, 3], cells = [48, 8] }} }}
            body.block = {{ material = "steel", generate.rectangle = {{ from = [15, 12], to = [25, 20], cells = [20, 8] }} }}
            material.steel.isotropic = {{ young = 2.1e5, poisson = 0.3 }}
            interface.contact = {{ secondary = "block.bottom", primary = "lever.top", friction.coulomb.mu = 0.2, discretisation.node-to-facet = {{}} }}
            support.hub = {{ set = "lever.left", x = 0, y = 0 }}
            support.pin = {{ set = "pin", x = 0, y = 0 }}
            support.start = {{ set = "pin", rotation-z = 0.4 }}
            support.base = {{ set = "block.top", x = 0, y = 0 }}
            load.torque = {{ set = "pin", moment.value = [200] }}
            step = [
                {{ supports = ["hub", "pin", "start", "base"], loads = [], increments.fixed = 20 }},
                {{ supports = ["hub", "pin", "base"], loads = ["torque"], increments.fixed = 4 }},
            ]
            quality.gate = "off"
            "#
        )
    };
    for method in ["condensed", "sparse"] {
        let (record, _) = run(&text(method));
        let last = record.increments.len() - 1;
        let part = |name: &str| vector(&record, last, name, 2);
        let force = stickslip::math::add(part("contact.CFN"), part("contact.CFS"));
        let at = part("contact.XN");
        let moment = at[0] * force[1] - at[1] * force[0];
        assert!((moment / 200.0 - 1.0).abs() < 1e-7, "{method}: {moment}");
        assert_eq!(column(&record, "pin.RM3")[last], 0.0);
        let turned = column(&record, "pin.UR3")[last];
        assert!((0.3..0.41).contains(&turned), "{method}: {turned}");
    }
}

/// A beam whose frame is turned by a quarter under loads that keep their direction, and that turn, deflects as one that is meshed where it then stands.
#[test]
fn loads_keep_their_direction_or_turn() {
    let turned = |load: &str| {
        format!(
            r#"
            format = 1
            model.space = "plane-stress"
            reference.clamp = {{ point = [0, 0] }}
            body.beam = {{ material = "steel", rotation.with = "clamp", generate.rectangle = {{ from = [0, -0.1], to = [2, 0.1], cells = [20, 4], element = "quad8" }} }}
            material.steel.isotropic = {{ young = 1e5, poisson = 0.3, density = 1 }}
            support.root = {{ set = "beam.left", x = 0, y = 0 }}
            support.clamp = {{ set = "clamp", x = 0, y = 0, rotation-z = {FRAC_PI_2:?} }}
            load.push = {{ {load} }}
            probe.end = {{ of = "beam", point = [2, 0] }}
            step = [{{ increments.fixed = 5 }}]
            "#
        )
    };
    // The same beam upright from the start.
    let upright = |load: &str| {
        format!(
            r#"
            format = 1
            model.space = "plane-stress"
            body.beam = {{ material = "steel", generate.rectangle = {{ from = [-0.1, 0], to = [0.1, 2], cells = [4, 20], element = "quad8" }} }}
            material.steel.isotropic = {{ young = 1e5, poisson = 0.3, density = 1 }}
            support.root = {{ set = "beam.bottom", x = 0, y = 0 }}
            load.push = {{ {load} }}
            probe.end = {{ of = "beam", point = [0, 2] }}
            step = [{{ increments.fixed = 5 }}]
            "#
        )
    };
    let cases = [
        (
            "set = \"beam.right\", traction.value = [1, 0.5]",
            "set = \"beam.top\", traction.value = [1, 0.5]",
            [0.2, 0.1],
        ),
        (
            "set = \"beam\", gravity.acceleration = [3, -1]",
            "set = \"beam\", gravity.acceleration = [3, -1]",
            [1.2, -0.4],
        ),
        (
            "set = \"beam.right\", traction.value = [1, 0.5], follow = true",
            "set = \"beam.top\", traction.value = [-0.5, 1]",
            [-0.1, 0.2],
        ),
        (
            "set = \"beam.top\", pressure.value = 1",
            "set = \"beam.left\", pressure.value = 1",
            [2.0, 0.0],
        ),
    ];
    for (load, same, force) in cases {
        let (record, _) = run(&turned(load));
        let (expected, _) = run(&upright(same));
        let end = vector(&record, 4, "end.U", 2);
        // From where the middle of the end was at first to where it is.
        let moved = sub(end, [-2.0, 2.0, 0.0]);
        let other = vector(&expected, 4, "end.U", 2);
        close(moved, other, 1e-10, load);
        // The clamp carries it all, and its moment where the beam stands by now, bent.
        let carried = vector(&record, 4, "clamp.RF", 2);
        let along = !load.contains("follow") && !load.contains("pressure");
        if along {
            close(carried, [-force[0], -force[1], 0.0], 1e-9, load);
        }
    }
}

/// A pinion and a wheel, frictionless: whatever the position, torques are as the numbers of teeth. Two pitches, and the second is the first again.
#[test]
fn gears_hand_on_torque_as_their_numbers_of_teeth_say() {
    let (z1, z2, module, backlash) = (20, 30, 2.0, 0.05);
    let (pitch, ratio) = (TAU / z1 as f64, f64::from(z2) / f64::from(z1));
    let distance = 0.5 * module * f64::from(z1 + z2);
    // Half the play, and 6 micrometres more.
    let start = 0.25 * backlash / (0.5 * module * f64::from(z1)) + 3e-4;
    let text = format!(
        r#"
        format = 1
        model = {{ space = "plane-strain", thickness = 10 }}
        reference.one = {{ point = [0, 0] }}
        reference.two = {{ point = [{distance:?}, 0] }}
        body.pinion = {{ material = "steel", rotation.with = "one", generate.gear = {{ teeth = {z1}, module = {module:?}, bore = 8, backlash = {backlash:?}, cells = [16, 4, 2, 3], element = "quad8" }} }}
        body.wheel = {{ material = "steel", rotation.with = "two", generate.gear = {{ centre = [{distance:?}, 0], teeth = {z2}, module = {module:?}, bore = 15, angle = {angle:?}, cells = [16, 4, 2, 3], element = "quad8" }} }}
        material.steel.isotropic = {{ young = 2.1e5, poisson = 0.3 }}
        interface.mesh = {{ secondary = "pinion.teeth", primary = "wheel.teeth", discretisation.node-to-facet = {{}} }}
        support.pinion = {{ set = "pinion.bore", x = 0, y = 0 }}
        support.wheel = {{ set = "wheel.bore", x = 0, y = 0 }}
        support.one = {{ set = "one", x = 0, y = 0, rotation-z = 1, amplitude = "drive" }}
        support.two = {{ set = "two", x = 0, y = 0, rotation-z = 1, amplitude = "driven" }}
        amplitude.drive.table = [[0, 0], [1, {start:?}], [2, {end:?}]]
        amplitude.driven.table = [[0, 0], [1, 0], [2, {driven:?}]]
        step = [{{ increments.fixed = 1 }}, {{ increments.fixed = 16 }}]
        quality.gate = "off"
        "#,
        angle = PI + PI / f64::from(z2),
        end = start + 2.0 * pitch,
        driven = -2.0 * pitch / ratio,
    );
    let (record, _) = run(&text);
    let (one, two) = (column(&record, "one.RM3"), column(&record, "two.RM3"));
    for k in 1..one.len() {
        let found = two[k] / one[k];
        // Facets are parabolas through points of the involute, and teeth that come into mesh touch with the edge of the tip.
        assert!((found / ratio - 1.0).abs() < 6e-3, "{k}: {found}");
    }
    for k in 1..9 {
        assert!(
            (one[k] / one[k + 8] - 1.0).abs() < 1e-6,
            "one pitch on: {} and {}",
            one[k],
            one[k + 8]
        );
    }
}

/// Why a problem is refused.
fn refused(text: &str) -> String {
    match Problem::from_toml(text, None) {
        Err(e) => e.to_string(),
        Ok(problem) => match support::build(&problem) {
            Ok(_) => panic!("taken: {text}"),
            Err(e) => e.to_string(),
        },
    }
}

#[test]
fn what_bodies_that_turn_cannot_do_is_said_at_its_key() {
    let text = |extra: &str| {
        format!(
            r#"
            format = 1
            model.space = "plane-strain"
            reference.axle = {{ point = [0, 0] }}
            body.block = {{ generate.rectangle = {{ to = [1, 1], cells = [2, 2] }}, material = "steel", rotation.with = "axle" }}
            material.steel.isotropic = {{ young = 1e5, poisson = 0.3, density = 1 }}
            support.base = {{ set = "block.bottom", x = 0, y = 0 }}
            support.axle = {{ set = "axle", x = 0, y = 0, rotation-z = 1 }}
            {extra}
            "#
        )
    };
    let step = "step = [{}]\n";
    let cases = [
        (
            "step = [{ dynamic = {} }]".to_string(),
            "quasi-static steps alone",
        ),
        (
            format!("{step}solver.method = \"multigrid\""),
            "multigrid does not know",
        ),
        (
            format!(
                "{step}body.wall = {{ generate.rectangle = {{ from = [0, 1], to = [1, 2], cells = [2, 2] }}, material = \"steel\" }}\nsupport.wall = {{ set = \"wall.top\", x = 0, y = 0 }}\ninterface.joint = {{ secondary = \"wall.bottom\", primary = \"block.top\", kinematics.small-sliding = {{}} }}"
            ),
            "pairs are those of the start",
        ),
        (
            format!("{step}load.spring = {{ set = \"block.top\", spring.stiffness = [1, 1] }}"),
            "would turn with this body",
        ),
        (
            format!(
                "{step}reference.other = {{ point = [2, 0] }}\ncoupling.tie = {{ kinematic = {{ reference = \"other\", set = \"block.top\" }} }}\nsupport.other = {{ set = \"other\", x = 0, y = 0, rotation-z = 0 }}"
            ),
            "does not turn with it",
        ),
    ];
    for (extra, expected) in cases {
        let said = refused(&text(&extra));
        assert!(said.contains(expected), "{extra}: {said}");
    }
    let unknown = text(step).replace("rotation.with = \"axle\"", "rotation.with = \"axel\"");
    let said = refused(&unknown);
    assert!(
        said.contains("`axel` is not among the reference points"),
        "{said}"
    );
}

/// Bodies that rest on one axle and press and shear each other through a soft law are in equilibrium with themselves.
#[test]
fn an_assembly_on_a_soft_law_asks_for_no_torque() {
    for cells in ["[2, 1]", "[3, 1]"] {
        let (record, simulation) = run(&format!(
            r#"
format = 1
model.space = "plane-strain"
reference.axle.point = [0, 0]
body.lower = {{ generate.rectangle = {{ from = [-1, -1], to = [1, 0], cells = {cells} }}, material = "s", rotation.with = "axle" }}
body.upper = {{ generate.rectangle = {{ from = [-0.5, 0], to = [0.5, 1], cells = [2, 2] }}, material = "s", rotation.with = "axle" }}
material.s.isotropic = {{ young = 1e5, poisson = 0.3 }}
interface.joint = {{ secondary = "upper.bottom", primary = "lower.top", friction.coulomb.mu = 0.5, normal.linear.c = 1e5 }}
support.base = {{ set = "lower.bottom", x = 0, y = 0 }}
support.press = {{ set = "upper.top", x = 1e-3, y = -1e-3 }}
support.turn = {{ set = "axle", x = 0, y = 0, rotation-z = 1, amplitude = "turn" }}
amplitude.turn.table = [[0, 0], [1, 0], [2, 1]]
step = [{{ increments.fixed = 4 }}, {{ increments.fixed = 10 }}]
"#
        ));
        let force = stickslip::math::norm(vector(&record, 3, "joint.CFN", 2));
        let torque = column(&record, "axle.RM3");
        let most = torque.iter().fold(0.0_f64, |m, t| m.max(t.abs()));
        assert!(most < 1e-12 * force, "{cells}: {most:e} of {force}");
        assert!(simulation.summary.quality.met, "{cells}");
    }
}

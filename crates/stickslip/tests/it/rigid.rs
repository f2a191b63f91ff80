//! Rigid bodies: how they move, stand, swing and touch, and what is refused.

use crate::support;
use std::f64::consts::TAU;

use stickslip::run::Simulation;
use support::{Record, complaint, problem, run};

const SCHEMES: [&str; 3] = [
    "scheme.newmark = {}",
    "scheme.generalised-alpha = {}",
    "scheme.central-difference = {}",
];

fn value(row: &support::Row, name: &str) -> f64 {
    row.get(name).unwrap_or_else(|| panic!("no column {name}"))
}

fn last(record: &Record) -> &support::Row {
    &record.increments.last().expect("a row").1
}

/// Runs a problem and gives its last row.
fn end(text: &str) -> support::Row {
    let record = run(&problem(text)).unwrap_or_else(|e| panic!("{e}\n{text}"));
    last(&record).clone()
}

fn near(found: f64, expected: f64, tolerance: f64) {
    assert!(
        (found - expected).abs() <= tolerance,
        "{found} is not {expected}: {:e} apart",
        found - expected
    );
}

/// A block 2 wide and 1 high whose lower side lies on `y = 0`.
const BLOCK: &str = r#"
format = 1
model.space = "plane-strain"
body.block = { generate.rectangle = { to = [2, 1], cells = [4, 2] }, material = "m", rigid = true }
material.m.isotropic = { young = 1e4, poisson = 0.3, density = 3.0 }
set.centre = { of = "block", point = [1, 0.5] }
# A step wants something that acts.
load.nothing = { set = "centre", nodal-force = { value = [0, 0] } }
probe.left = { of = "block", point = [0, 0] }
probe.right = { of = "block", point = [2, 0] }
probe.top = { of = "block", point = [1, 1] }
output.every = 0
"#;

#[test]
fn free_fall_is_exact() {
    for dynamic in SCHEMES {
        let row = end(&format!(
            r#"{BLOCK}
load.weight = {{ set = "block", gravity = {{ acceleration = [0, -10] }} }}
initial.throw = {{ set = "block", velocity = [3, 4], displacement = [0.5, 0] }}
[[step]]
duration = 0.6
increments.fixed = 7
dynamic = {{ {dynamic} }}
"#
        ));
        for corner in ["left", "right", "top"] {
            near(value(&row, &format!("{corner}.U1")), 0.5 + 1.8, 1e-12);
            near(value(&row, &format!("{corner}.U2")), 2.4 - 1.8, 1e-12);
            near(value(&row, &format!("{corner}.V2")), -2.0, 1e-12);
            near(value(&row, &format!("{corner}.S22")), 0.0, 0.0);
        }
        near(value(&row, "ALLKE"), 0.5 * 6.0 * (9.0 + 4.0), 1e-11);
        near(value(&row, "ALLSE"), 0.0, 0.0);
        near(value(&row, "ERESIDUAL"), 0.0, 1e-11);
    }
}

/// Without anything stiff no increment is too long.
#[test]
fn free_flight_needs_no_short_increments() {
    let text = format!(
        r#"{BLOCK}
initial.throw = {{ set = "block", velocity = [3, 4] }}
step = [{{ duration = 2.0, dynamic = {{ scheme.central-difference = {{}} }} }}]
"#
    );
    let mut simulation = support::build(&problem(&text)).expect("sound");
    simulation.run(&mut []).unwrap_or_else(|e| panic!("{e}"));
    assert!(simulation.summary.attempts.increments < 200);
    assert_eq!(simulation.summary.explicit.stable_increment, 0.0);
    near(simulation.summary.last["top.U1"], 6.0, 1e-12);
}

#[test]
fn a_spinning_plate_goes_on_spinning() {
    for dynamic in SCHEMES {
        let text = format!(
            r#"{BLOCK}
initial.spin = {{ set = "block", spin = [0.3] }}
[[step]]
duration = 0.5
increments.fixed = 10
dynamic = {{ {dynamic} }}
"#
        );
        let mut simulation = support::build(&problem(&text)).expect("sound");
        simulation.run(&mut []).unwrap_or_else(|e| panic!("{e}"));
        let row = &simulation.summary.last;
        near(row["right.V1"], 0.3 * 0.5, 1e-13);
        near(row["right.V2"], 0.3, 1e-13);
        near(row["right.U2"], 0.15, 1e-13);
        near(row["left.U2"], -0.15, 1e-13);
        near(row["top.U1"], -0.075, 1e-13);
        // polar moment of a rectangle
        near(row["ALLKE"], 0.5 * 0.09 * 6.0 * (4.0 + 1.0) / 12.0, 1e-12);
        near(simulation.summary.largest_rotation, 0.15, 1e-13);
    }
}

/// One tetrahedron of unit mass, whose moments of inertia are no diagonal.
fn tetrahedron(name: &str, more: &str) -> support::Row {
    let folder = support::folder(name);
    std::fs::write(
        folder.join("tet.msh"),
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n$EndNodes\n$Elements\n1\n1 4 2 1 1 1 2 3 4\n$EndElements\n",
    )
    .expect("a file");
    let text = format!(
        r#"
format = 1
model.space = "solid"
body.tet = {{ gmsh.file = "tet.msh", material = "m", rigid = true }}
material.m.isotropic = {{ young = 1e4, poisson = 0.3, density = 6.0 }}
load.nothing = {{ set = "tet", nodal-force = {{ value = [0, 0, 0] }} }}
probe.apex = {{ of = "tet", point = [0, 0, 1] }}
probe.origin = {{ of = "tet", point = [0, 0, 0] }}
output.every = 0
{more}
"#
    );
    let model = problem(&text)
        .build(&folder)
        .unwrap_or_else(|e| panic!("{e}"));
    let mut simulation = Simulation::new(model).expect("sound");
    let mut record = Record::default();
    simulation
        .run(&mut [&mut record])
        .unwrap_or_else(|e| panic!("{e}"));
    last(&record).clone()
}

#[test]
fn moments_of_inertia_in_space() {
    for (i, dynamic) in SCHEMES.iter().enumerate() {
        let row = tetrahedron(
            &format!("rigid-spin-{i}"),
            &format!(
                r#"
initial.spin = {{ set = "tet", spin = [0.1, 0.1, 0] }}
[[step]]
duration = 1.0
increments.fixed = 9
dynamic = {{ {dynamic} }}
"#
            ),
        );
        // ∫ x² = 3/80 and ∫ x y = -1/80 about the centre
        let energy = 0.5 * 0.01 * (6.0 / 80.0 + 6.0 / 80.0 + 2.0 / 80.0);
        near(value(&row, "ALLKE"), energy, 1e-15);
        // ω × arm with the arm (-1/4, -1/4, 3/4)
        near(value(&row, "apex.V1"), 0.075, 1e-14);
        near(value(&row, "apex.V2"), -0.075, 1e-14);
        near(value(&row, "apex.V3"), 0.0, 1e-14);
        near(value(&row, "apex.U1"), 0.075, 1e-14);
    }
}

/// Springs at two corners, which couple all six motions.
#[test]
fn explicit_and_implicit_vibration_agree() {
    let row = |name: &str, dynamic: &str| {
        tetrahedron(
            name,
            &format!(
                r#"
set.a = {{ of = "tet", numbers = [1] }}
set.b = {{ of = "tet", numbers = [2] }}
load.a = {{ set = "a", spring = {{ stiffness = [3, 2, 4] }} }}
load.b = {{ set = "b", spring = {{ stiffness = [1, 2, 3] }} }}
initial.throw = {{ set = "tet", velocity = [0.02, -0.01, 0.03], spin = [0.01, 0.02, -0.01] }}
[[step]]
duration = 1.5
increments.fixed = 3000
dynamic = {{ {dynamic} }}
"#
            ),
        )
    };
    let a = row("rigid-implicit", "scheme.newmark = {}");
    let b = row("rigid-explicit", "scheme.central-difference = {}");
    assert!(value(&a, "ALLSE") > 1e-5, "the springs do nothing");
    for column in ["apex.U1", "apex.U2", "apex.U3", "origin.U1", "apex.V1"] {
        near(value(&a, column), value(&b, column), 1e-6);
    }
    for row in [&a, &b] {
        near(value(row, "ERESIDUAL"), 0.0, 1e-10);
    }
}

/// Bouncing and rocking on springs, each with its own period.
#[test]
fn a_block_on_springs_has_its_periods() {
    // five springs of 30 each
    let (m, k): (f64, f64) = (6.0, 5.0 * 30.0);
    let rocking: f64 = 30.0 * 2.0 * (1.0 + 0.25);
    let polar = m * (4.0 + 1.0) / 12.0;
    let (bounce, rock) = ((k / m).sqrt(), (rocking / polar).sqrt());
    let t = 0.9 * TAU / bounce;
    for dynamic in SCHEMES {
        let row = end(&format!(
            r#"{BLOCK}
load.feet = {{ set = "block.bottom", spring = {{ stiffness = [0, 30] }} }}
initial.kick = {{ set = "block", velocity = [0, 0.2], spin = [0.1] }}
[[step]]
duration = {t}
increments.fixed = 4000
dynamic = {{ {dynamic} }}
"#
        ));
        let middle = 0.2 / bounce * (bounce * t).sin();
        let turned = 0.1 / rock * (rock * t).sin();
        near(value(&row, "right.U2"), middle + turned, 1e-6);
        near(value(&row, "left.U2"), middle - turned, 1e-6);
        near(value(&row, "ERESIDUAL"), 0.0, 1e-10);
    }
}

/// Pressed on a soft layer beside its middle.
fn seat(body: &str) -> support::Row {
    end(&format!(
        r#"{body}
obstacle.floor.plane = {{ point = [0, 0], normal = [0, 1] }}
interface.seat = {{ secondary = "block.bottom", primary = "floor", normal.linear = {{ c = 50 }} }}
support.guide = {{ set = "centre", x = 0 }}
set.corner = {{ of = "block", point = [2, 1] }}
load.press = {{ set = "block.top", pressure = {{ value = 0.5 }} }}
load.edge = {{ set = "corner", nodal-force = {{ value = [0, -0.1] }} }}
[[step]]
duration = 1.0
"#
    ))
}

#[test]
fn a_block_sinks_and_tilts() {
    let row = seat(BLOCK);
    // nodes of the lower side and their areas
    let nodes = [
        (-1.0, 0.25),
        (-0.5, 0.5),
        (0.0, 0.5),
        (0.5, 0.5),
        (1.0, 0.25),
    ];
    let second: f64 = nodes.iter().map(|(x, a)| x * x * a).sum();
    let sunk = -1.1 / (50.0 * 2.0);
    let turned = -0.1 / (50.0 * second);
    near(value(&row, "right.U2"), sunk + turned, 1e-10);
    near(value(&row, "left.U2"), sunk - turned, 1e-10);
    // the middle of the upper side turns about the centre
    near(value(&row, "top.U1"), -0.5 * turned, 1e-10);
    near(value(&row, "seat.CFN2"), 1.1, 1e-8);
    near(value(&row, "ERESIDUAL"), 0.0, 1e-10);
}

/// The same in space, held so that it can only sink and tilt; and fields are those of the points of the mesh.
#[test]
fn a_box_sinks_and_tilts_both_ways() {
    let text = r#"
format = 1
model.space = "solid"
body.box = { generate.box = { to = [2, 2, 1], cells = [2, 2, 2] }, material = "m", rigid = true }
material.m.isotropic = { young = 1e4, poisson = 0.3, density = 3.0 }
obstacle.floor.plane = { point = [0, 0, 0], normal = [0, 0, 1] }
interface.seat = { secondary = "box.bottom", primary = "floor", normal.linear = { c = 50 } }
set.centre = { of = "box", point = [1, 1, 0.5] }
set.rod = { of = "box", box = { from = [1, 0, 0.5], to = [1, 2, 0.5] } }
support.pin = { set = "centre", y = 0 }
support.guide = { set = "rod", x = 0 }
set.corner = { of = "box", point = [2, 2, 1] }
load.press = { set = "box.top", pressure = { value = 0.5 } }
load.edge = { set = "corner", nodal-force = { value = [0, 0, -0.1] } }
probe.low = { of = "box", point = [2, 2, 0] }
probe.high = { of = "box", point = [0, 0, 0] }
output.every = 0
[[step]]
duration = 1.0
"#;
    let mut simulation = support::build(&problem(text)).expect("sound");
    simulation.run(&mut []).unwrap_or_else(|e| panic!("{e}"));
    let (sunk, turned) = (2.1 / 200.0, 0.1 / (50.0 * 2.0));
    let row = &simulation.summary.last;
    near(row["low.U3"], -sunk - 2.0 * turned, 1e-10);
    near(row["high.U3"], -sunk + 2.0 * turned, 1e-10);
    near(
        simulation.summary.largest_rotation,
        2.0_f64.sqrt() * turned,
        1e-10,
    );
    let fields = stickslip::results::fields(&simulation.view());
    for field in &fields.all {
        let count = match field.location {
            stickslip::system::Location::Point => 27,
            stickslip::system::Location::Cell => 8,
        };
        assert_eq!(
            field.values.len(),
            count * field.components,
            "{}",
            field.name
        );
    }
    let stress = fields.get("S").expect("stresses");
    assert!(stress.values.iter().all(|s| *s == 0.0));
}

#[test]
fn a_very_stiff_block_does_the_same() {
    let elastic = BLOCK.replace(", rigid = true", "").replace("1e4", "1e7");
    let (a, b) = (seat(BLOCK), seat(&elastic));
    for column in ["left.U2", "right.U2", "top.U1", "seat.CPRESSMAX"] {
        let (a, b) = (value(&a, column), value(&b, column));
        near(a, b, 1e-3 * b.abs());
    }
}

#[test]
fn around_an_axis_only_the_axial_motion_is_left() {
    let text = r#"
format = 1
model.space = "axisymmetric"
body.punch = { generate.rectangle = { to = [2, 1], cells = [4, 2] }, material = "m", rigid = true }
material.m.isotropic = { young = 1e4, poisson = 0.3, density = 3.0 }
obstacle.floor.plane = { point = [0, 0], normal = [0, 1] }
interface.seat = { secondary = "punch.bottom", primary = "floor", normal.linear = { c = 50 } }
support.axis = { set = "punch.left", x = 0 }
load.press = { set = "punch.top", pressure = { value = 0.5 } }
probe.rim = { of = "punch", point = [2, 1] }
output.every = 0
[[step]]
duration = 1.0
"#;
    let row = end(text);
    near(value(&row, "rim.U2"), -0.01, 1e-11);
    near(value(&row, "rim.U1"), 0.0, 0.0);
    let message = complaint(&text.replace("x = 0 }", "x = 0.1 }"));
    assert!(message.contains("cannot move like that"), "{message}");
}

/// An elastic base and a body on it, pressed and then pushed with friction.
fn stack(upper: &str, sides: &str, more: &str) -> support::Row {
    end(&format!(
        r#"
format = 1
model.space = "plane-strain"
body.base = {{ generate.rectangle = {{ to = [2, 1], cells = [6, 3] }}, material = "m" }}
body.upper = {{ generate.rectangle = {{ from = [0.4, 1], to = [1.6, 1.5], cells = [5, 2] }}, material = "m" {upper} }}
material.m.isotropic = {{ young = 1e3, poisson = 0.3, density = 1.0 }}
interface.joint = {{ {sides}, roles = "as-named", friction.coulomb = {{ mu = 0.2 }} }}
support.ground = {{ set = "base.bottom", x = 0, y = 0 }}
probe.corner = {{ of = "upper", point = [0.4, 1.5] }}
probe.side = {{ of = "base", point = [2, 1] }}
output.every = 0
{more}
"#
    ))
}

const SIDES: [&str; 2] = [
    r#"secondary = "base.top", primary = "upper.bottom""#,
    r#"secondary = "upper.bottom", primary = "base.top""#,
];

#[test]
fn a_rigid_body_on_an_elastic_one_is_a_body_with_prescribed_points() {
    let driven = r#"
support.press = { set = "upper", y = -0.01, amplitude = "down" }
support.push = { set = "upper", x = 0.01, amplitude = "along" }
amplitude.down = { table = [[0, 0], [1, 1]] }
amplitude.along = { table = [[1, 0], [2, 1]] }
[[step]]
duration = 1.0
increments.fixed = 4
[[step]]
duration = 1.0
increments.fixed = 5
"#;
    for sides in SIDES {
        let rigid = stack(", rigid = true", sides, driven);
        let elastic = stack("", sides, driven);
        assert!(value(&elastic, "SLIP") > 0.0 && value(&elastic, "joint.CFN2").abs() > 1.0);
        let columns = [
            "joint.CFN2",
            "joint.CFS1",
            "side.U1",
            "side.U2",
            "joint.ALLFD",
            "press.RF2",
            "push.RF1",
            "ground.RF1",
            "corner.U2",
            "ALLSE",
            "ALLWK",
        ];
        for column in columns {
            let (a, b) = (value(&rigid, column), value(&elastic, column));
            near(a, b, 1e-6 * b.abs().max(1e-3));
        }
    }
}

/// The force that a prescribed approach takes gives that approach.
#[test]
fn force_and_displacement_agree() {
    let step = "[[step]]\nduration = 1.0\nincrements.fixed = 4\n";
    for sides in SIDES {
        let driven = format!("support.press = {{ set = \"upper\", x = 0, y = -0.01 }}\n{step}");
        let row = stack(", rigid = true", sides, &driven);
        let pressure = -value(&row, "press.RF2") / 1.2;
        assert!(pressure > 1.0);
        let loaded = format!(
            "support.guide = {{ set = \"upper\", x = 0 }}\nload.press = {{ set = \"upper.top\", pressure = {{ value = {pressure} }} }}\n{step}"
        );
        let row = stack(", rigid = true", sides, &loaded);
        near(value(&row, "corner.U2"), -0.01, 1e-8);
        // held at all its points along x, it cannot turn
        near(value(&row, "corner.U1"), 0.0, 1e-14);
    }
}

/// Sliding on a floor takes `μ g` from the velocity, however the block rocks.
#[test]
fn friction_brakes_a_sliding_block() {
    for dynamic in SCHEMES {
        let row = end(&format!(
            r#"{BLOCK}
obstacle.floor.plane = {{ point = [0, 0], normal = [0, 1] }}
interface.seat = {{ secondary = "block.bottom", primary = "floor", normal.linear = {{ c = 5000 }}, friction.coulomb = {{ mu = 0.2 }} }}
load.weight = {{ set = "block", gravity = {{ acceleration = [0, -10] }} }}
initial.push = {{ set = "block", velocity = [1.5, 0] }}
support.guide = {{ set = "centre", x = 0 }}
[[step]]
duration = 1.0
supports = ["guide"]
increments.fixed = 1
[[step]]
duration = 0.5
supports = []
increments.fixed = 2000
dynamic = {{ {dynamic} }}
"#
        ));
        let speed = 0.5 * (value(&row, "left.V1") + value(&row, "right.V1"));
        // the lower side moves with the rocking about the centre
        let rocking = 0.5 * 0.5 * (value(&row, "right.V2") - value(&row, "left.V2"));
        near(speed - rocking, 0.5, 2e-3);
        near(value(&row, "ERESIDUAL"), 0.0, 0.05);
    }
}

/// Pressed on a floor by a constant way and pushed along it, with regularised friction: `m v' = -T` down to ε, and from there
/// `r' = -T/(m ε) (2 - r) r` of `r = v/ε`, whose solution is `r = 2 / (1 + exp(2 T t/(m ε)))`. However small ε is, it does not make increments small.
#[test]
fn regularised_friction_brakes_explicitly_in_any_regularisation() {
    let (mass, limit, start, duration) = (6.0, 0.2 * 5000.0 * 0.01 * 2.0, 1.5, 0.5);
    let after = |epsilon: f64| {
        let sliding = (start - epsilon) * mass / limit;
        let left = 2.0 * limit * (duration - sliding) / (mass * epsilon);
        epsilon * 2.0 / (1.0 + left.exp())
    };
    let mut counts = Vec::new();
    for epsilon in [1.0, 0.3, 1e-2, 1e-5, 1e-9] {
        let text = format!(
            r#"{BLOCK}
obstacle.floor.plane = {{ point = [0, 0], normal = [0, 1] }}
interface.seat = {{ secondary = "block.bottom", primary = "floor", normal.linear = {{ c = 5000 }}, friction.coulomb = {{ mu = 0.2 }}, slip.regularised.epsilon = {epsilon:e} }}
initial.push = {{ set = "block", velocity = [{start}, 0], displacement = [0, -0.01] }}
support.rail = {{ set = "block", y = -0.01, amplitude = "kept" }}
amplitude.kept.table = [[0, 1], [{duration}, 1]]
[[step]]
duration = {duration}
dynamic.scheme.central-difference = {{}}
"#
        );
        let mut simulation = support::build(&problem(&text)).expect("sound");
        simulation
            .run(&mut [])
            .unwrap_or_else(|e| panic!("{epsilon:e}: {e}"));
        counts.push(simulation.summary.attempts.increments);
        let row = &simulation.summary.last;
        // What the spring of the interface swings with after it has stopped a body that it lets creep no more.
        let spring = limit / (2.0 * 1e4 / 0.5 * mass).sqrt();
        near(row["top.V1"], after(epsilon), 2e-3 + spring);
        let all = 0.5 * mass * start * start;
        near(row["ERESIDUAL"], 0.0, 1e-2 * all);
        assert!(row["ALLFD"] > 0.9 * all, "{epsilon:e}: {}", row["ALLFD"]);
    }
    let most = counts.iter().max().copied().unwrap_or(0);
    assert!(most < 2 * counts[0], "{counts:?}");
}

/// Pressed on the floor and pulled along it with half of what friction carries, a block creeps at `ε (1 - √½)`: what swings beside that is the block on the
/// spring of the interface, from which half of the limit was let go. The smallest ε takes no more increments than that spring.
#[test]
fn regularised_friction_creeps_explicitly_in_any_regularisation() {
    let (mass, limit, duration) = (6.0_f64, 0.2 * 5000.0 * 0.01 * 2.0, 0.5);
    let modulus = 1e4 * 0.7 / (1.3 * 0.4);
    let spring = 2.0 * modulus / 0.5;
    let pull = 0.5 * limit;
    for epsilon in [0.3, 1e-2, 1e-5, 1e-9, 1e-14] {
        let text = format!(
            r#"{BLOCK}
obstacle.floor.plane = {{ point = [0, 0], normal = [0, 1] }}
interface.seat = {{ secondary = "block.bottom", primary = "floor", normal.linear = {{ c = 5000 }}, friction.coulomb = {{ mu = 0.2 }}, slip.regularised.epsilon = {epsilon:e} }}
initial.push = {{ set = "block", displacement = [0, -0.01] }}
load.pull = {{ set = "block", gravity = {{ acceleration = [{}, 0] }} }}
support.rail = {{ set = "block", y = -0.01, amplitude = "kept" }}
amplitude.kept.table = [[0, 1], [{duration}, 1]]
[[step]]
duration = {duration}
dynamic.scheme.central-difference = {{}}
"#,
            pull / mass
        );
        let mut simulation = support::build(&problem(&text)).expect("sound");
        simulation
            .run(&mut [])
            .unwrap_or_else(|e| panic!("{epsilon:e}: {e}"));
        let count = simulation.summary.attempts.increments;
        assert!(count < 100, "{epsilon:e}: {count} increments");
        let row = &simulation.summary.last;
        let creep = epsilon * (1.0 - 0.5_f64.sqrt());
        near(row["top.V1"], creep, 1.01 * pull / (spring * mass).sqrt());
        // It takes some time to come to that velocity: `m ε / (2 T √½)` of it.
        let late = creep * mass * epsilon / (2.0_f64.sqrt() * limit);
        near(row["top.U1"], creep * duration, 2.02 * pull / spring + late);
        near(row["ERESIDUAL"], 0.0, 1e-12);
    }
}

/// A floor that takes velocity away faster than its spring gives it back bounds increments by `2 m/c`, and takes what was there.
#[test]
fn a_stiff_dashpot_bounds_explicit_increments() {
    let text = format!(
        r#"{BLOCK}
obstacle.floor.plane = {{ point = [0, -0.05], normal = [0, 1] }}
interface.seat = {{ secondary = "block.bottom", primary = "floor", normal.linear = {{ c = 4000 }}, damping.viscous = {{ coefficient = 1e5 }} }}
initial.drop = {{ set = "block", velocity = [0, -1] }}
[[step]]
duration = 0.1
dynamic.scheme.central-difference = {{}}
"#
    );
    let record = run(&problem(&text)).unwrap_or_else(|e| panic!("{e}"));
    for (_, row) in &record.increments {
        assert!(value(row, "top.V2").abs() < 1.001 && value(row, "ALLKE") < 3.0001);
        near(value(row, "ERESIDUAL"), 0.0, 3e-2);
    }
    let row = last(&record);
    near(value(row, "top.V2"), 0.0, 2e-2);
    near(value(row, "ALLKE"), 0.0, 1e-3);
    // The scheme takes some of it, as the dashpot lags by half an increment.
    near(value(row, "ALLCD"), 3.0, 0.3);
    near(value(row, "ALLCD") + value(row, "ALLND"), 3.0, 3e-2);
}

/// Dropped on a floor that does not give way, flat or on a corner, a block comes to rest: whatever it has on the way down is lost in impacts and rubbed
/// off, and at no time is there more than its weight has brought in.
#[test]
fn a_block_that_falls_on_a_hard_floor_comes_to_rest() {
    for dynamic in [
        "scheme.newmark = {}",
        "scheme.generalised-alpha = {}",
        "scheme.hht = {}",
    ] {
        for (spin, steps) in [(0.0, 50), (0.2, 50), (0.2, 400)] {
            let text = format!(
                r#"{BLOCK}
obstacle.floor.plane = {{ point = [0, -0.05], normal = [0, 1] }}
interface.seat = {{ secondary = "block.bottom", primary = "floor", friction.coulomb.mu = 0.3 }}
load.weight = {{ set = "block", gravity = {{ acceleration = [0, -10] }} }}
initial.tip = {{ set = "block", spin = [{spin}] }}
[[step]]
duration = 1.0
increments = {{ initial = {0}, largest = {0} }}
dynamic = {{ {dynamic} }}
"#,
                1.0 / f64::from(steps)
            );
            let what = format!("{dynamic}, {spin}, {steps}");
            let record = run(&problem(&text)).unwrap_or_else(|e| panic!("{what}: {e}"));
            for (_, row) in &record.increments {
                let supplied = value(row, "EINITIAL") + value(row, "ALLWK");
                let now = value(row, "ALLKE");
                assert!(now < supplied + 0.03, "{what}: {now} of {supplied}");
                let left = value(row, "ERESIDUAL");
                assert!(left.abs() < 1e-3, "{what}: {left:e}");
            }
            let row = last(&record);
            near(value(row, "ALLKE"), 0.0, 1e-5);
            near(value(row, "top.U2"), -0.05, 1e-6);
            // Weight times way.
            near(value(row, "ALLWK"), 60.0 * 0.05, 1e-4);
            let lost = value(row, "ALLCD") + value(row, "ALLFD");
            near(lost, 60.0 * 0.05 + value(row, "EINITIAL"), 0.1);
            assert!(value(row, "ALLCD") > 2.5, "{what}");
        }
    }
}

/// Dropped on a compliant floor, it comes back with the energy it had.
#[test]
fn a_bounce_keeps_the_energy() {
    let explicit = "scheme.central-difference = {}";
    for (dynamic, steps, tolerance) in [
        ("scheme.newmark = {}", "fixed = 1000", 2e-2),
        (explicit, "fixed = 1000", 2e-2),
        (explicit, "initial = 0.01\nincrements.largest = 0.01", 2e-2),
        // the stable increment takes account of the floor before it is met
        (explicit, "initial = 1.0", 0.3),
    ] {
        let row = end(&format!(
            r#"{BLOCK}
obstacle.floor.plane = {{ point = [0, -0.05], normal = [0, 1] }}
interface.seat = {{ secondary = "block.bottom", primary = "floor", normal.linear = {{ c = 4000 }} }}
initial.drop = {{ set = "block", velocity = [0, -1] }}
[[step]]
duration = 0.2
increments.{steps}
dynamic = {{ {dynamic} }}
"#
        ));
        near(value(&row, "top.V2"), 1.0, tolerance);
        near(value(&row, "ALLKE"), 3.0, 6.0 * tolerance);
        near(value(&row, "top.V1"), 0.0, 1e-9);
    }
}

#[test]
fn what_holds_a_body_bears_its_weight() {
    let row = end(&format!(
        r#"{BLOCK}
load.weight = {{ set = "block", gravity = {{ acceleration = [0, -10] }} }}
support.wall = {{ set = "block.left", x = 0, y = 0.25 }}
[[step]]
duration = 1.0
"#
    ));
    near(value(&row, "wall.RF2"), 60.0, 1e-9);
    near(value(&row, "wall.RF1"), 0.0, 1e-9);
    near(value(&row, "right.U2"), 0.25, 1e-14);
    near(value(&row, "ALLWK"), 0.0, 1e-9);
}

#[test]
fn free_motions_are_listed() {
    let free = |more: &str| -> Vec<String> {
        let text = format!("{BLOCK}{more}\nstep = [{{ duration = 1.0 }}]");
        let mut simulation = support::build(&problem(&text)).expect("sound");
        let report = simulation.check();
        assert!(report.to_string().contains("rigid, of mass 6\n"));
        report.free.into_iter().map(|m| m.motion).collect()
    };
    let all = ["translation x", "translation y", "rotation about z"];
    let mut listed = free("");
    listed.sort();
    let mut expected = all.to_vec();
    expected.sort_unstable();
    assert_eq!(listed, expected);
    let centre = "support.pin = { set = \"centre\", x = 0, y = 0 }";
    assert_eq!(free(centre), ["rotation about z"]);
    let guide = "support.guide = { set = \"block\", x = 0 }";
    assert_eq!(free(guide), ["translation y"]);
    let feet = "load.feet = { set = \"block.bottom\", spring = { stiffness = [0, 30] } }";
    assert_eq!(free(feet), ["translation x"]);
    assert!(free("support.all = { set = \"block\", x = 0, y = 0 }").is_empty());
}

#[test]
fn what_does_not_go_with_a_rigid_body_is_refused() {
    let has = |text: String, parts: &[&str]| {
        let message = complaint(&text);
        for part in parts {
            assert!(message.contains(part), "`{part}` is not in\n{message}");
        }
    };
    let with = |more: &str| format!("{BLOCK}{more}\nstep = [{{ duration = 1.0 }}]");
    let moving =
        |more: &str| format!("{BLOCK}{more}\nstep = [{{ duration = 1.0, dynamic = {{}} }}]");
    has(
        with(
            "set.corner = { of = \"block\", point = [0, 0] }\nsupport.pin = { set = \"corner\", x = 0, y = 0 }",
        ),
        &[
            "rigid body `block`",
            "translation x",
            "centre of mass",
            "support.pin",
        ],
    );
    has(
        with("support.rail = { set = \"block.bottom\", x = 0 }"),
        &["translation x", "support the whole body"],
    );
    has(
        with("").replace(", density = 3.0", ""),
        &["is rigid", "no density"],
    );
    has(
        with("").replace(
            "rigid = true",
            "rigid = true, formulation = \"mean-dilatation\"",
        ),
        &["`formulation` has no meaning"],
    );
    has(
        with("").replace("rigid = true", "rigid = true, rayleigh = { mass = 0.1 }"),
        &["`rayleigh` has no meaning"],
    );
    has(
        moving(
            "set.corner = { of = \"block\", point = [0, 0] }\ninitial.kick = { set = \"corner\", velocity = [1, 0] }",
        ),
        &["do not determine", "whole body"],
    );
    has(
        moving(
            "initial.a = { set = \"block\", velocity = [1, 0] }\nsupport.guide = { set = \"block\", x = 0 }",
        ),
        &["does not agree with support `guide`", "rigid body `block`"],
    );
    has(
        with("load.push = { set = \"block.right\", traction = { value = [1, 0] } }"),
        &[
            "free to move as a rigid body",
            "translation x is held neither",
        ],
    );
}

/// A support holds a rigid body as a whole. The reactions at its nodes sum up to what the history says.
#[test]
fn reactions_are_shown_at_the_points_of_rigid_bodies() {
    let text = r#"
format = 1
model.space = "plane-strain"
body.lower = { generate.rectangle = { to = [3, 1], cells = [6, 2] }, material = "m" }
body.punch = { generate.rectangle = { from = [1, 1], to = [2, 2], cells = [3, 2] }, material = "m", rigid = true }
material.m.isotropic = { young = 1e4, poisson = 0.3, density = 1.0 }
interface.joint = { secondary = "lower.top", primary = "punch.bottom", friction.coulomb.mu = 0.3 }
support.base = { set = "lower.bottom", x = 0, y = 0 }
support.punch = { set = "punch", x = 2e-4, y = -1e-3 }
step = [{ increments.fixed = 1 }]
"#;
    let mut simulation = support::build(&problem(text)).unwrap_or_else(|e| panic!("{e}"));
    let mut record = Record::default();
    (simulation.run(&mut [&mut record])).unwrap_or_else(|e| panic!("{e}"));
    let fields = stickslip::results::fields(&simulation.view());
    let shown = fields
        .all
        .iter()
        .find(|f| f.name == "RF")
        .expect("reactions");
    let body = simulation.model.bodies.iter().find(|b| b.name == "punch");
    let row = last(&record);
    for (c, name) in ["punch.RF1", "punch.RF2"].into_iter().enumerate() {
        let points = body.expect("the punch").points.clone();
        let sum: f64 = points.map(|p| shown.values[3 * p + c]).sum();
        let held = value(row, name);
        assert!(held.abs() > 1e-2, "{name}: {held}");
        near(sum, held, 1e-9 * held.abs());
    }
}

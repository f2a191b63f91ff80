//! What the history says of supports: how far their points have moved, and the loop of force over displacement.

use crate::support::{self, Row};

fn rows(text: &str) -> Vec<Row> {
    let record = support::run(&support::problem(text)).unwrap_or_else(|e| panic!("{e}"));
    record.increments.into_iter().map(|(_, row)| row).collect()
}

#[track_caller]
fn value(row: &Row, name: &str) -> f64 {
    row.get(name)
        .unwrap_or_else(|| panic!("no column {name} in {:?}", row.names))
}

#[track_caller]
fn near(found: f64, wanted: f64, scale: f64) {
    assert!((found - wanted).abs() <= 1e-9 * scale, "{found}, {wanted}");
}

/// A bar of length 4 and modulus 1000 is pulled by a traction of 2 at its free end, which moves by `σ l / E`; it is held there while the traction goes, and is then brought to another
/// displacement by a force `E A u / l`.
#[test]
fn a_support_has_the_displacement_of_its_points_also_while_it_does_not_act() {
    let rows = rows(
        r#"
format = 1
model.space = "plane-stress"
body.bar = { generate.rectangle = { to = [4, 1], cells = [4, 2] }, material = "m" }
material.m.isotropic = { young = 1000.0, poisson = 0.3 }
support.wall = { set = "bar.left", x = 0 }
support.foot = { set = "bar.bottom", y = 0 }
support.tip = { set = "bar.right", hold = ["x"] }
support.pull = { set = "bar.right", x = -0.03 }
probe.foot.point = [0, 1]
load.traction = { set = "bar.right", traction = { value = [2, 0] } }
step = [
  { name = "pull", supports = ["wall", "foot"], increments.fixed = 2 },
  { name = "hold", supports = ["wall", "foot", "tip"], loads = [], increments.fixed = 2 },
  { name = "press", supports = ["wall", "foot", "pull"], loads = [], increments.fixed = 2 },
]
"#,
    );
    let free = 2.0 * 4.0 / 1000.0;
    let wanted = [0.5, 1.0, 1.0, 1.0]
        .map(|part| part * free)
        .into_iter()
        .chain([0.5 * (free - 0.03), -0.03]);
    assert_eq!(rows.len(), 6);
    for (row, u) in rows.iter().zip(wanted) {
        near(value(row, "tip.U1"), u, 0.03);
        near(value(row, "pull.U1"), u, 0.03);
        near(value(row, "wall.U1"), 0.0, 0.0);
        // The upper side comes down by ν times the strain; the column of the probe is not that of the support, which rests.
        near(value(row, "foot.U2"), -0.3 * u / 4.0, 0.03);
        assert_eq!(row.get("tip.U2"), None);
        assert_eq!(row.get("wall.UR3"), None);
    }
    near(value(&rows[5], "pull.RF1"), -0.03 * 1000.0 / 4.0, 7.5);
}

/// A rigid lever in the plane and one in space, whose reference points are turned by supports.
#[test]
fn a_support_that_turns_a_point_has_its_rotation() {
    let plane = rows(
        r#"
format = 1
model.space = "plane-strain"
body.lever = { generate.rectangle = { to = [4, 1], cells = [4, 1] }, material = "m" }
material.m.isotropic = { young = 1000.0, poisson = 0.3 }
reference.pin.point = [0, 0]
coupling.pin.kinematic = { set = "lever.left", reference = "pin" }
support.drive = { set = "pin", x = 0.1, y = 0, rotation-z = 1e-3 }
step = [{ increments.fixed = 4 }]
"#,
    );
    for (row, part) in plane.iter().zip([0.25, 0.5, 0.75, 1.0]) {
        near(value(row, "drive.U1"), 0.1 * part, 0.1);
        near(value(row, "drive.UR3"), 1e-3 * part, 1e-3);
        near(value(row, "drive.UR3"), value(row, "pin.UR3"), 1e-3);
    }
    let space = rows(
        r#"
format = 1
model.space = "solid"
body.lever = { generate.box = { to = [4, 1, 1], cells = [4, 1, 1] }, material = "m" }
material.m.isotropic = { young = 1000.0, poisson = 0.3 }
reference.pin.point = [0, 0, 0]
coupling.pin.kinematic = { set = "lever.left", reference = "pin" }
support.ground = { set = "pin", x = 0, y = 0, z = 0, rotation-y = 0 }
support.twist = { set = "pin", rotation-x = 2e-3, rotation-z = -1e-3 }
step = [{ increments.fixed = 1 }]
"#,
    );
    near(value(&space[0], "twist.UR1"), 2e-3, 2e-3);
    near(value(&space[0], "twist.UR3"), -1e-3, 1e-3);
    near(value(&space[0], "ground.UR2"), 0.0, 0.0);
    assert_eq!(space[0].get("twist.U1"), None);
    assert_eq!(space[0].get("twist.UR2"), None);
}

/// A pressed block is driven back and forth beyond the limit of friction. Over a cycle that closes the elastic energy is what it was, so that the area of the loop is what friction took.
/// Straight lines between rows cut the corners of the loop: of shorter increments less is cut.
#[test]
fn the_area_of_a_fretting_loop_is_the_work_of_friction() {
    for (increments, tolerance) in [(50, 5e-3), (200, 5e-4)] {
        let rows = rows(&format!(
            r#"
format = 1
model.space = "plane-strain"
body.base = {{ generate.rectangle = {{ from = [0, -1], to = [3, 0], cells = [12, 3] }}, material = "m" }}
body.block = {{ generate.rectangle = {{ from = [1, 0], to = [2, 1], cells = [4, 4] }}, material = "m" }}
material.m.isotropic = {{ young = 1000.0, poisson = 0.3 }}
interface.contact = {{ secondary = "block.bottom", primary = "base.top", friction.coulomb = {{ mu = 0.3 }} }}
support.ground = {{ set = "base.bottom", x = 0, y = 0 }}
support.press = {{ set = "block.top", y = -0.01 }}
support.drive = {{ set = "block.top", x = 0.02, amplitude = "triangle" }}
amplitude.triangle.table = [[1, 0], [2, 1], [4, -1], [6, 1]]
step = [
  {{ name = "press", supports = ["ground", "press", "drive"], increments.fixed = 2 }},
  {{ name = "fret", duration = 5, increments.fixed = {increments} }},
]
"#
        ));
        let cycle: Vec<[f64; 3]> = rows
            .iter()
            .filter(|row| value(row, "TIME") > 2.0 - 1e-9)
            .map(|row| ["drive.U1", "drive.RF1", "ALLFD"].map(|name| value(row, name)))
            .collect();
        let [first, last] = [cycle[0], cycle[cycle.len() - 1]];
        near(first[0], 0.02, 0.02);
        near(last[0], 0.02, 0.02);
        let pairs = cycle.windows(2);
        let area: f64 = pairs
            .map(|p| 0.5 * (p[0][1] + p[1][1]) * (p[1][0] - p[0][0]))
            .sum();
        let work = last[2] - first[2];
        assert!(work > 0.07);
        assert!((area - work).abs() < tolerance * work, "{area}, {work}");
    }
}

/// A block under a pressure on the facets that look along a direction, and what its support holds.
fn pressed(space: &str, body: &str, set: &str) -> Vec<f64> {
    let (bottom, z) = match space {
        "solid" => ("bottom", ", z = 0"),
        _ => ("bottom", ""),
    };
    let rows = rows(&format!(
        r#"
format = 1
model.space = "{space}"
body.block = {{ generate.{body}, material = "m" }}
material.m.isotropic = {{ young = 1000.0, poisson = 0.3 }}
set.pressed = {{ of = "block", normal = {set} }}
support.base = {{ set = "block.{bottom}", x = 0, y = 0{z} }}
load.p = {{ set = "pressed", pressure.value = 3 }}
step = [{{ increments.fixed = 1 }}]
"#
    ));
    let forces = ["base.RF1", "base.RF2", "base.RF3"];
    forces.iter().filter_map(|name| rows[0].get(name)).collect()
}

#[test]
fn facets_are_chosen_by_where_they_look() {
    let plane = "rectangle = { to = [4, 1], cells = [4, 2] }";
    let solid = "box = { to = [4, 1, 2], cells = [4, 1, 1], element = \"hex20\" }";
    // Pressure times the area of the sides, against the normals; a side of one cell is not taken for the top because all its nodes are on the two.
    for (space, body, set, wanted) in [
        (
            "plane-strain",
            plane,
            "{ direction = [0, 2] }",
            vec![0.0, 12.0],
        ),
        (
            "plane-strain",
            plane,
            "{ direction = [1, 1], angle = 46 }",
            vec![3.0, 12.0],
        ),
        (
            "solid",
            solid,
            "{ direction = [0, 0, 1] }",
            vec![0.0, 0.0, 12.0],
        ),
        (
            "solid",
            solid,
            "{ direction = [1, 0, 1], angle = 46 }",
            vec![6.0, 0.0, 12.0],
        ),
    ] {
        let forces = pressed(space, body, set);
        assert_eq!(forces.len(), wanted.len());
        for (force, wanted) in forces.into_iter().zip(wanted) {
            near(force, wanted, 12.0);
        }
    }
}

#[test]
fn a_probe_finds_the_body_that_has_a_point_there() {
    let problem = |point: &str| {
        format!(
            r#"
format = 1
model.space = "plane-strain"
body.lower = {{ generate.rectangle = {{ to = [1, 1], cells = [2, 2] }}, material = "m" }}
body.upper = {{ generate.rectangle = {{ from = [0, 1], to = [1, 2], cells = [2, 2] }}, material = "m" }}
material.m.isotropic = {{ young = 1000.0, poisson = 0.0 }}
interface.joint = {{ secondary = "upper.bottom", primary = "lower.top" }}
support.base = {{ set = "lower.bottom", x = 0, y = 0 }}
support.guide = {{ set = "upper.top", x = 0, y = -0.002 }}
probe.p.point = {point}
step = [{{ increments.fixed = 1 }}]
"#
        )
    };
    // A column without lateral strain: displacements are linear from the foot to the top.
    for (point, wanted) in [("[0.5, 1.5]", -0.0015), ("[0.5, 0.5]", -0.0005)] {
        let rows = rows(&problem(point));
        assert!((value(&rows[0], "p.U2") - wanted).abs() < 1e-6, "{point}");
    }
    let there = support::problem(&problem("[0.5, 1]")).build(std::path::Path::new("."));
    let message = there
        .err()
        .expect("both bodies have a point there")
        .to_string();
    for part in [
        "probe.p",
        "bodies `lower` and `upper` both have a point there",
        "of = \"lower\"",
    ] {
        assert!(message.contains(part), "`{part}` is missing in {message}");
    }
}

//! Problems that have a solution which an iteration may miss.

use crate::support;
use support::{Record, problem, run};

fn record(text: &str) -> Record {
    run(&problem(text)).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

/// Iterations of each increment.
fn iterations(record: &Record) -> Vec<usize> {
    record.increments.iter().map(|i| i.0.len()).collect()
}

/// One side of a layer moves like the other, and both are pressed on a plane: only the sum of what contact carries there is determined. An iteration leaves a hundredth of what
/// equations are off, as it does where nothing touches.
#[test]
fn an_equation_between_points_in_contact_costs_few_iterations() {
    for element in ["quad4", "quad8"] {
        let layer = |equations: bool| {
            let equations = match equations {
                true => {
                    r#"
coupling.px.equation = { terms = [{ set = "layer.left", component = "x" }, { set = "layer.right", component = "x", factor = -1 }] }
coupling.py.equation = { terms = [{ set = "layer.left", component = "y" }, { set = "layer.right", component = "y", factor = -1 }] }"#
                }
                false => "",
            };
            format!(
                r#"
format = 1
model.space = "plane-strain"
body.layer = {{ generate.rectangle = {{ to = [4, 1], cells = [8, 4], element = "{element}" }}, material = "m" }}
material.m.isotropic = {{ young = 1.0, poisson = 0.3, density = 1.0 }}
obstacle.floor.plane = {{ point = [0, 0], normal = [0, 1] }}
interface.rub = {{ secondary = "layer.bottom", primary = "floor", friction.coulomb.mu = 0.3 }}
support.top = {{ set = "layer.top", x = 1e-4, y = -1e-3 }}{equations}
step = [{{ increments.fixed = 1 }}]
"#
            )
        };
        let records = [false, true].map(|equations| record(&layer(equations)));
        assert_eq!(records[1].cutbacks, 0, "{element}");
        let [alone, tied] = records.map(|record| iterations(&record)[0]);
        assert!(tied <= alone + 7, "{element}: {alone} and {tied}");
    }
}

/// What takes part in an equation between two points in contact shares its pressure evenly: the smallest of all pressures that are in balance.
#[test]
fn pressures_that_only_their_sum_determines_are_equal() {
    let text = r#"
format = 1
model.space = "plane-strain"
body.b = { generate.rectangle = { to = [4, 1], cells = [1, 1] }, material = "m" }
material.m.isotropic = { young = 2e11, poisson = 0.3 }
obstacle.floor.plane = { point = [0, 0], normal = [0, 1] }
interface.i = { secondary = "b.bottom", primary = "floor", friction.coulomb = { mu = 0.3 } }
coupling.py.equation = { terms = [{ set = "b.left", component = "y" }, { set = "b.right", component = "y", factor = -1 }] }
support.top = { set = "b.top", x = 1e-4, y = -1e-3 }
step = [{ increments.fixed = 1 }]
"#;
    let record = record(text);
    assert!(iterations(&record)[0] <= 9, "{:?}", iterations(&record));
    assert_eq!(record.cutbacks, 0);
    let (_, last) = record.increments.last().expect("an increment");
    let value = |name: &str| last.get(name).unwrap_or_else(|| panic!("no column {name}"));
    let mean = value("i.CFN2") / 4.0;
    let largest = value("i.CPRESSMAX");
    assert!((largest / mean - 1.0).abs() < 1e-6, "{largest} of {mean}");
}

/// A block that a support drags back and forth on a plane under pressure, all of which slides: it comes along however long the increments are, and rests on the plane.
#[test]
fn a_block_that_is_rubbed_to_and_fro_comes_along_in_increments_of_any_length() {
    for increments in [4, 8, 12, 16] {
        let text = format!(
            r#"
format = 1
model.space = "plane-strain"
body.upper = {{ generate.rectangle = {{ to = [0.31, 0.155], cells = [4, 3], element = "tri3" }}, material = "m" }}
material.m.isotropic = {{ young = 2741, poisson = 0.3 }}
obstacle.floor.plane = {{ point = [0, 0], normal = [0, 1] }}
interface.joint = {{ secondary = "upper.bottom", primary = "floor", friction.coulomb.mu = 0.4 }}
load.press = {{ set = "upper.top", pressure.value = 0.473 }}
support.drive = {{ set = "upper.top", x = 0.234, amplitude = "go" }}
amplitude.go.table = [[0, 0], [1, 0], [2, 1], [4, -1]]
step = [{{ increments.fixed = 1 }}, {{ increments.fixed = 2 }}, {{ duration = 2, increments.fixed = {increments} }}]
"#
        );
        let record = record(&text);
        assert_eq!(record.cutbacks, 0, "{increments}");
        let (_, last) = record.increments.last().expect("increments");
        let load = 0.473 * 0.31;
        let normal = last.get("joint.CFN2").expect("a normal force");
        let shear = last.get("joint.CFS1").expect("a shear force").abs();
        assert!((normal / load - 1.0).abs() < 1e-6, "{increments}: {normal}");
        assert!(
            (shear / (0.4 * load) - 1.0).abs() < 1e-6,
            "{increments}: {shear}"
        );
    }
}

/// A block pressed on another through a law that begins with no stiffness at all, friction by springs: the first friction problem finds nothing that touches, as its law
/// is hardly touched where it begins, and is not the last one.
#[test]
fn a_soft_law_with_friction_by_springs_is_pressed() {
    let text = r#"
format = 1
model.space = "plane-strain"
body.lower = { generate.rectangle = { from = [0, -0.08], to = [0.126, 0], cells = [2, 1] }, material = "a" }
body.upper = { generate.rectangle = { from = [0, 0], to = [0.12, 0.066], cells = [8, 4] }, material = "b" }
material.a.isotropic = { young = 2e10, poisson = 0.42 }
material.b.isotropic = { young = 2e10, poisson = 0.34 }
interface.joint = { secondary = "upper.bottom", primary = "lower.top", normal.power-law = { c = 6.3e16, m = 2.08 }, friction.coulomb.mu = 0.28, enforcement.penalty = {}, discretisation.node-to-facet = {} }
support.base = { set = "lower.bottom", x = 0, y = 0 }
support.top = { set = "upper.top", x = 0, y = -1.8e-5 }
step = [{}]
"#;
    let record = record(text);
    assert!(record.increments.len() < 30, "{}", record.increments.len());
    assert!(record.cutbacks <= 2, "{}", record.cutbacks);
}

/// Both faces of a thin wall are the primary, and both ends of a block above it the secondary: the top of the block looks the way that the bottom of the wall could
/// be entered, and lies far beyond it.
#[test]
fn a_block_meets_the_face_of_a_thin_wall_that_it_stands_on() {
    let text = |faces: &str, rest: &str| {
        format!(
            r#"
format = 1
model.space = "plane-strain"
material.m.isotropic = {{ young = 1e9, poisson = 0.3 }}
body.wall = {{ generate.rectangle = {{ from = [0, -0.001], to = [0.1, 0], cells = [20, 1] }}, material = "m", formulation = "incompatible-modes" }}
body.block = {{ generate.rectangle = {{ from = [0.03, 0.0005], to = [0.06, 0.0305], cells = [6, 4] }}, material = "m" }}
{faces}
interface.c = {{ secondary = "cube", primary = "skin"{rest} }}
support.l = {{ set = "wall.left", x = 0, y = 0 }}
support.r = {{ set = "wall.right", x = 0, y = 0 }}
support.down = {{ set = "block.top", x = 0, y = -0.0007 }}
step = [{{}}]
"#
        )
    };
    let both = "set.skin = { union = [\"wall.top\", \"wall.bottom\"] }\nset.cube = { union = [\"block.top\", \"block.bottom\"] }";
    let one = "set.skin = { union = [\"wall.top\"] }\nset.cube = { union = [\"block.bottom\"] }";
    for rest in ["", ", discretisation.node-to-facet = {}"] {
        let [both, one] = [both, one].map(|faces| {
            let record = record(&text(faces, rest));
            let (_, last) = record.increments.last().expect("increments");
            last.get("c.CFN2").expect("a normal force")
        });
        assert!((both / one - 1.0).abs() < 1e-6, "{rest}: {both} for {one}");
    }
}

/// The last row of the history of a problem that is solved without a smaller increment.
fn solved_at_once(text: &str) -> support::Row {
    let record = record(text);
    assert_eq!(record.cutbacks, 0, "{text}");
    record.increments.last().expect("a row").1.clone()
}

/// Equations beside soft bodies keep a linear solver from as many digits as a friction problem is asked with: it is solved with those that there are.
#[test]
fn a_friction_problem_takes_the_digits_that_there_are() {
    solved_at_once(
        r#"
format = 1
model.space = "solid"
solver.method = "sparse"
material.low.isotropic = { young = 19200, poisson = 0.18 }
material.foot.isotropic = { young = 5683.2, poisson = 0.426 }
material.up.isotropic = { young = 1.7664e7, poisson = 0.249 }
body.lower = { generate.box = { from = [-980, -490, -834.96], to = [980, 490, 0], cells = [2, 2, 2], element = "tet10" }, material = "low" }
body.upper = { generate.box = { from = [-392, -490, 0], to = [1381.8, 490, 856.52], cells = [3, 2, 2], element = "tet4" }, material = "up" }
body.foot = { generate.box = { from = [-980, -490, -1422.96], to = [980, 490, -834.96], cells = [3, 2, 2] }, material = "foot" }
interface.joint = { secondary = "upper.bottom", primary = "lower.top", friction.coulomb.mu = 0.399, primary-velocity = [3.92, 0, 0] }
interface.tie = { secondary = "lower.bottom", primary = "foot.top", tied = true }
reference.head = { point = [494.9, 0, 856.52] }
coupling.head.kinematic = { reference = "head", set = "upper.top" }
support.base = { set = "foot.bottom", x = 0, y = 0, z = 0 }
support.guide = { set = "head", x = 0, y = 0, rotation-x = 0, rotation-y = 0, rotation-z = 0 }
load.press = { set = "head", nodal-force.value = [0, 0, -1.278e8] }
step = [{ increments.fixed = 3 }]
"#,
    );
}

/// A load lifts what a jack presses down, by much less: nothing goes the way of the load.
#[test]
fn a_load_does_not_move_a_part_against_its_pretension() {
    let row = solved_at_once(
        r#"
format = 1
model.space = "plane-strain"
material.soft.isotropic = { young = 2.4e5, poisson = 0.1 }
material.hard.isotropic = { young = 2.2e6, poisson = 0.3 }
body.lower = { generate.rectangle = { from = [-3, -2], to = [3, 0], cells = [6, 2] }, material = "soft" }
body.upper = { generate.rectangle = { from = [-3, 0], to = [3, 2.5], cells = [7, 2] }, material = "hard" }
body.side = { generate.rectangle = { from = [3, -2], to = [4.5, 2], cells = [2, 5] }, material = "soft" }
interface.joint = { secondary = "upper.bottom", primary = "lower.top", friction.coulomb.mu = 0.6, roles = "as-named" }
interface.side-low = { secondary = "lower.right", primary = "side.left", friction.coulomb.mu = 0.6 }
interface.side-up = { secondary = "upper.right", primary = "side.left", friction.coulomb.mu = 0.6 }
support.side = { set = "side.right", x = -6e-3, y = 0 }
support.base = { set = "lower.bottom", x = 0, y = 0 }
support.roof = { set = "upper.top", x = 0, y = 0 }
load.side = { set = "upper.right", traction.value = [-40, 20] }
pretension.jack = { of = "upper", plane = { point = [0, 1.25], normal = [0, 1] } }
step = [{ increments.fixed = 4, pretension.jack = { force = -5e3 } }]
"#,
    );
    // What the side takes by friction is no more than it is pressed.
    let pressed = row.get("joint.CFN2").expect("a force");
    assert!((4e3..5e3).contains(&pressed), "{pressed}");
}

/// A head that presses by a coupling, and by a support of the same points: where Newton's method fails a friction problem stands in, and equations hold in it too.
#[test]
fn friction_problems_know_what_equations_are_off() {
    let head = |held: &str| {
        let row = solved_at_once(&format!(
            r#"
format = 1
model.space = "plane-strain"
material.m = {{ isotropic = {{ young = 2e5, poisson = 0.35 }}, expansion = 4e-5 }}
body.block = {{ generate.rectangle = {{ from = [-1.2, 0], to = [1.2, 1], cells = [8, 3] }}, material = "m" }}
obstacle.floor.plane = {{ point = [0, 0], normal = [0, 1] }}
interface.sole = {{ secondary = "block.bottom", primary = "floor", friction.coulomb.mu = 0.5, slip.regularised.epsilon = 2e-4 }}
temperature.hot = {{ set = "block", uniform.value = 50 }}
step = [{{ increments.fixed = 1 }}]
{held}
"#
        ));
        ["sole.CFN2", "sole.CPRESSMAX", "sole.ALLFD"].map(|name| row.get(name).expect("a figure"))
    };
    let coupled = head(
        r#"
reference.head.point = [0, 1]
coupling.head.kinematic = { reference = "head", set = "block.top" }
support.press = { set = "head", x = 0, y = -1e-2, rotation-z = 0 }"#,
    );
    let held = head("support.press = { set = \"block.top\", x = 0, y = -1e-2 }");
    for (a, b) in coupled.iter().zip(held) {
        assert!((a / b - 1.0).abs() < 1e-6, "{a} and {b}");
    }
}

/// A rigid block on a layer with a period, both of whose ends contact holds as well: how stiff it is there does not hang on what else is fastened to the block, nor on nodes beside
/// that it holds, too.
#[test]
fn a_period_beneath_a_rigid_block_costs_few_iterations() {
    for bed in [
        "",
        r#"load.bed = { set = "upper.right", spring.stiffness = [7.7, 7.7] }"#,
    ] {
        let text = format!(
            r#"
format = 1
model.space = "plane-strain"
body.lower = {{ generate.rectangle = {{ from = [-4.4, -4], to = [4.4, 0], cells = [4, 2] }}, material = "m" }}
body.upper = {{ generate.rectangle = {{ from = [-4.4, 0], to = [4.4, 3], cells = [7, 2] }}, material = "m", rigid = true }}
material.m.isotropic = {{ young = 38.0, poisson = 0.3, density = 1.0 }}
reference.head = {{ point = [0, 3] }}
coupling.head.kinematic = {{ reference = "head", set = "upper.top" }}
coupling.px.equation.terms = [{{ set = "lower.left", component = "x" }}, {{ set = "lower.right", component = "x", factor = -1 }}]
coupling.py.equation.terms = [{{ set = "lower.left", component = "y" }}, {{ set = "lower.right", component = "y", factor = -1 }}]
interface.joint = {{ secondary = "upper.bottom", primary = "lower.top", friction.coulomb.mu = 0.76, enforcement.perturbed-lagrangian = {{}} }}
support.base = {{ set = "lower.bottom", x = 0, y = 0 }}
support.press = {{ set = "head", x = 0, y = -3.5e-2, rotation-z = 0 }}
{bed}
step = [{{ increments.fixed = 1 }}]
"#
        );
        let record = record(&text);
        assert_eq!(record.cutbacks, 0, "{bed}");
        let iterations = iterations(&record);
        assert!(iterations[0] <= 8, "{bed}: {iterations:?}");
    }
}

/// A face that is kept level by equations with its point on the axis, next to which there is little of the body: the other points are held to each other as firmly as they resist.
#[test]
fn a_face_is_kept_level_with_a_soft_point_in_few_iterations() {
    let record = record(
        r#"
format = 1
model.space = "axisymmetric"
body.lower = { generate.rectangle = { from = [0, -2.6], to = [2.5, 0], cells = [2, 2], element = "tri6", diagonal = "up" }, material = "m" }
body.upper = { generate.rectangle = { to = [2.5, 2.6], cells = [5, 2], element = "tri6", diagonal = "up" }, material = "m" }
material.m.isotropic = { young = 2.75e12, poisson = 0.1 }
interface.joint = { secondary = "upper.bottom", primary = "lower.top" }
set.corner = { of = "upper", point = [0, 2.6] }
coupling.level.equation.terms = [{ set = "upper.top", component = "y" }, { set = "corner", component = "y", factor = -1 }]
load.press = { set = "upper.top", pressure.value = 3.8e9 }
support.axis = { set = "upper.left", x = 0 }
support.lower = { set = "lower.left", x = 0 }
support.base = { set = "lower.bottom", y = 0 }
step = [{ increments.fixed = 1 }]
"#,
    );
    let iterations = iterations(&record);
    assert!(iterations[0] <= 12, "{iterations:?}");
}

/// A clamped block is pressed and let go to where it was before: nothing is left to which an out-of-balance force could be compared but what rounding leaves of the way.
#[test]
fn what_is_let_go_comes_back_to_nothing() {
    let record = record(
        r#"
format = 1
model.space = "plane-stress"
body.b = { generate.rectangle = { from = [-2, 0], to = [2, 1.3], cells = [5, 2] }, material = "m" }
material.m.isotropic = { young = 6.7e5, poisson = 0.16 }
obstacle.floor.plane = { point = [0, 0], normal = [0, 1] }
interface.joint = { secondary = "b.bottom", primary = "floor", normal.power-law = { c = 7.8e12, m = 2.65 }, enforcement.penalty = {} }
reference.head = { point = [0, 1.3] }
coupling.head.distributing = { reference = "head", set = "b.top" }
support.clamp = { set = "b.right", x = 0, y = 0 }
support.press = { set = "head", y = -1.6e-2, amplitude = "press" }
support.guide = { set = "head", rotation-z = 0 }
amplitude.press.table = [[0, 0], [1, 1], [2, 0]]
solver.method = "sparse"
step = [{ increments.fixed = 3 }, { increments.fixed = 6 }]
"#,
    );
    assert_eq!(record.cutbacks, 0);
    let force = |k: usize| record.increments[k].1.get("joint.CFN2").expect("a force");
    let (pressed, left) = (force(2), force(8));
    assert!(
        pressed > 0.0 && left.abs() < 1e-9 * pressed,
        "{pressed} {left}"
    );
}

/// Three blocks that are pressed and dragged at once, with multigrid: a friction problem of all points costs more than an attempt, and no more than those that have come to nothing.
#[test]
fn after_attempts_in_vain_a_friction_problem_may_cost_as_much() {
    let record = record(
        r#"
format = 1
model.space = "solid"
solver.method = "multigrid"
body.lower = { generate.box = { from = [-2.45, -1.225, -1.8], to = [2.45, 1.225, 0], cells = [3, 2, 2] }, material = "soft" }
body.upper = { generate.box = { from = [-2.45, -1.225, 0], to = [2.45, 1.225, 1.9], cells = [4, 2, 2] }, material = "hard" }
body.cap = { generate.box = { from = [-2.7, -1.225, 1.9], to = [2.9, 1.225, 2.9], cells = [3, 2, 2] }, material = "soft" }
material.soft.isotropic = { young = 6.22e9, poisson = 0.02 }
material.hard.isotropic = { young = 1.11e10, poisson = 0.35 }
interface.joint = { secondary = "upper.bottom", primary = "lower.top", friction.coulomb.mu = 0.323, enforcement.penalty = {}, discretisation.node-to-facet = {}, roles = "as-named" }
interface.second = { secondary = "upper.top", primary = "cap.bottom", friction.coulomb.mu = 0.323, enforcement.penalty = {} }
load.bed = { set = "upper.right", spring.stiffness = [7.4e7, 7.4e7, 7.4e7] }
support.base = { set = "lower.bottom", x = 0, y = 0, z = 0 }
support.press = { set = "cap.top", x = 1.47e-2, y = 0, z = -1.96e-2 }
step = [{ increments.initial = 0.333 }]
"#,
    );
    assert!(record.cutbacks <= 8, "{}", record.cutbacks);
}

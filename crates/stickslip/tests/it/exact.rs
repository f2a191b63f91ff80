//! Exact contact and stick: no numerical stiffness shows in the answer, and points that open, close, stick and slip in turn are no reason to fail.

use crate::support;
use crate::support::resistance;
use resistance::{Medium, Space, resist};
use std::sync::Arc;
use stickslip::contact::look;

use stickslip::math::{
    Mat3, Vec3, add, identity, mat_vec, norm, rotation, scale, sub, transpose_vec,
};
use stickslip::mesh::generators::{Cuboid, Generate, Rectangle};
use stickslip::newton::Strategy;
use stickslip::problem::{Meshes, Problem};
use stickslip::results::{Analysis, Event, Observer};
use stickslip::run::Simulation;
use stickslip::shape::ElementKind;
use support::Record;

/// Two cubes with edges of 10 mm, meshes that do not match; numbers for a unit of length that is `1/length` metres.
fn cubes(length: f64, friction: &str, enforcement: &str) -> String {
    let l = |x: f64| x * length;
    let young = 210e9 / (length * length);
    format!(
        r#"
format = 1
model.space = "solid"
body.lower = {{ generate.box = {{ to = [{a:?}, {a:?}, {a:?}], cells = [6, 6, 6] }}, material = "steel" }}
body.upper = {{ generate.box = {{ from = [0, 0, {a:?}], to = [{a:?}, {a:?}, {b:?}], cells = [5, 5, 5] }}, material = "steel" }}
material.steel.isotropic = {{ young = {young:?}, poisson = 0.3 }}
support.base = {{ set = "lower.bottom", x = 0, y = 0, z = 0 }}
support.down = {{ set = "upper.top", x = 0, y = 0, z = {down:?} }}
step = [{{ increments = {{ fixed = 1 }} }}]

[interface.joint]
secondary = "upper.bottom"
primary = "lower.top"
{friction}
{enforcement}
"#,
        a = l(0.01),
        b = l(0.02),
        down = l(-2e-5),
    )
}

/// A run that must succeed, and the simulation at its end.
fn run(problem: &Problem) -> (Record, Simulation) {
    let mut record = Record::default();
    let mut simulation = support::build(problem).unwrap_or_else(|e| panic!("{e}"));
    let outcome = simulation.run(&mut [&mut record]);
    outcome.unwrap_or_else(|e| panic!("{e}"));
    (record, simulation)
}

/// Force of the cubes and iterations.
fn press(text: &str) -> (f64, f64) {
    let (record, _) = run(&support::problem(text));
    assert_eq!(record.cutbacks, 0);
    let (_, row) = &record.increments[0];
    let last = |column: &str| row.get(column).expect(column);
    (last("down.RF3"), last("ITRS"))
}

#[test]
fn the_force_does_not_depend_on_the_numerical_stiffness() {
    for friction in ["", "friction.coulomb = { mu = 0.2 }"] {
        let (limit, _) = press(&cubes(
            1.0,
            friction,
            "enforcement.augmented-lagrangian = { error = 1e-8 }",
        ));
        assert!(limit < -1e4, "{limit}");
        for factor in [0.1, 1.0, 10.0, 1e2, 1e3, 1e4, 1e5] {
            let enforcement =
                format!("enforcement.augmented-lagrangian = {{ factor = {factor:?} }}");
            let (metres, n) = press(&cubes(1.0, friction, &enforcement));
            assert!(
                (metres / limit - 1.0).abs() < 1e-3,
                "factor {factor}: {metres}, limit {limit}"
            );
            let (millimetres, m) = press(&cubes(1e3, friction, &enforcement));
            assert!(
                (millimetres / limit - 1.0).abs() < 1e-3,
                "factor {factor}: {millimetres}"
            );
            // The outer edges of the cubes coincide: rounding decides on which side of the other's edge a corner falls while
            // iterations are under way, and with it the size of the next residual. It may land on either side of the tolerance.
            assert!((n - m).abs() <= 1.0, "factor {factor}: {n} and {m}");
        }
    }
}

#[test]
fn an_absolute_stiffness_is_only_where_it_starts() {
    let (limit, _) = press(&cubes(1.0, "", ""));
    // from far too soft to far too stiff; the bodies have some 1e14 Pa/m
    for stiffness in [1e10, 1e12, 1e17] {
        let enforcement =
            format!("enforcement.augmented-lagrangian = {{ stiffness = {stiffness:?} }}");
        let (force, _) = press(&cubes(1.0, "", &enforcement));
        assert!(
            (force / limit - 1.0).abs() < 1e-3,
            "stiffness {stiffness}: {force}"
        );
    }
    let both = "enforcement.augmented-lagrangian = { stiffness = 1e12, factor = 10.0 }";
    let said = support::complaint(&cubes(1.0, "", both));
    assert!(said.contains("not both"), "{said}");
}

#[test]
fn a_penalty_stays_what_it_is() {
    let of = |factor: f64| {
        let enforcement = format!("enforcement.penalty = {{ factor = {factor:?} }}");
        press(&cubes(1.0, "", &enforcement)).0
    };
    // In series with the bodies such a spring yields about as much as they do.
    assert!(of(0.1) / of(10.0) < 0.7);
}

/// The median of the Newton iterations an increment took.
fn median(record: &Record) -> f64 {
    let mut all: Vec<f64> = record
        .increments
        .iter()
        .map(|(_, row)| row.get("ITRS").expect("ITRS"))
        .collect();
    all.sort_by(f64::total_cmp);
    0.5 * (all[(all.len() - 1) / 2] + all[all.len() / 2])
}

/// Runs without a cut-back, in few iterations; the numbers of open points.
fn settles(text: &str) -> Vec<f64> {
    settles_within(text, 12.0)
}

/// The same in other than few.
fn settles_within(text: &str, most: f64) -> Vec<f64> {
    let (record, simulation) = run(&support::problem(text));
    assert_eq!(
        record.cutbacks, 0,
        "{:?}",
        simulation.summary.attempts.cutback_reasons
    );
    let median = median(&record);
    assert!(median <= most, "{median}");
    let rows = record.increments.iter();
    rows.map(|(_, row)| row.get("OPEN").expect("OPEN"))
        .collect()
}

#[test]
fn a_block_whose_corner_lifts_and_closes_again() {
    let text = include_str!("chatter/greco.toml");
    for steps in [1, 5, 20] {
        let open = settles(&text.replace("fixed = 1 ", &format!("fixed = {steps} ")));
        assert_eq!(open.len(), 4 * steps);
        assert!(open[steps - 1] > 0.0, "{open:?}");
        assert_eq!(open[2 * steps - 1], 0.0, "{open:?}");
        assert!(open[3 * steps - 1] > 0.0, "{open:?}");
    }
}

#[test]
fn a_block_that_rocks_from_edge_to_edge() {
    let open = settles(include_str!("chatter/rocking.toml"));
    assert_eq!(open[0], 0.0, "{open:?}");
    assert!(open.iter().filter(|&&n| n >= 3.0).count() >= 4, "{open:?}");
}

/// The block of `examples/greco-compliance` with the whole load in one increment from nothing: slip of 30 µm, friction that is nearly a jump at 1 nm.
/// Plain iteration sends points from slip in one direction to slip in the other.
#[test]
fn slip_that_goes_to_and_fro_is_found_by_its_forces() {
    let text = r#"
format = 1
model.space = "plane-strain"
body.block = { generate.rectangle = { to = [0.04, 0.04], cells = [32, 10] }, material = "steel" }
material.steel.isotropic = { young = 130e9, poisson = 0.2 }
obstacle.floor.plane = { point = [0, 0], normal = [0, 1] }
support.symmetry = { set = "block.right", x = 0 }
load.top = { set = "block.top", pressure = { value = 5e7 } }
load.side = { set = "block.left", pressure = { value = 15e7 } }
probe.A = { point = [0, 0] }
step = [{ increments = { fixed = 1 } }]

[interface.base]
secondary = "block.bottom"
primary = "floor"
normal.power-law = { c = 1e15, m = 1.0 }
friction.power-law = { c = 1e15, m = 1.0 }
slip.regularised = { epsilon = 1e-9 }
"#;
    let (record, simulation) = run(&support::problem(text));
    assert_eq!(record.cutbacks, 0);
    let (iterations, row) = &record.increments[0];
    // VERIFICATION P2 A, with the same exact solution as from the seated block
    let u = row.get("A.U1").expect("A.U1");
    assert!((u / 2.840_424_1e-5 - 1.0).abs() < 1e-6, "{u}");
    let tried = &simulation.summary.attempts.fallbacks;
    let kinds: Vec<Strategy> = tried.iter().map(|f| f.tried.kind).collect();
    assert_eq!(kinds, [Strategy::FrictionProblem]);
    assert!(tried[0].tried.converged);
    assert_eq!((tried[0].from, tried[0].to), (0.0, 1.0));
    let noted = &simulation.summary.notes;
    assert!(
        noted.iter().any(|n| n.contains("friction problem")),
        "{noted:?}"
    );
    assert!(
        iterations
            .last()
            .is_some_and(|p| p.strategy == Strategy::FrictionProblem)
    );
}

#[test]
fn a_soft_slab_under_an_iron() {
    let text = include_str!("chatter/ironing.toml");
    let points = "discretisation.node-to-facet = {}\nfriction.coulomb";
    assert_eq!(settles(&text.replace("friction.coulomb", points)).len(), 32);
    // The tangent of whole surfaces does not know that normals jump where facets meet, and at the edges of the iron they do.
    assert_eq!(settles_within(text, 16.0).len(), 32);
}

/// A curved body, pressed into another one and slid over it; numbers of the finest cells are small.
const ROLLER: &str = r#"
model.space = "plane-strain"
body.upper = { generate.half-disc = { radius = 6.0, centre = [6.0, 14.5], size = 1.0, refine = { finest = 0.15, width = 0.4, growth = 1.7 } }, material = "m", formulation = "standard" }
body.lower = { generate.rectangle = { to = [12.0, 8.5], cells = [5, 4] }, material = "m", formulation = "standard" }
interface.joint = { secondary = "upper.arc", primary = "lower.top", friction.coulomb.mu = 0.7, KIND }
support.base = { set = "lower.bottom", x = 0.0, y = 0.0 }
support.top = { set = "upper.flat", y = -0.02, amplitude = "press" }
support.top-x = { set = "upper.flat", x = 0.4, amplitude = "slide" }
"#;

const PLATES: &str = r#"
body.upper = { generate.rectangle = { from = [2.1, 1], to = [2.9, 2], cells = [3, 3], ELEMENT }, material = "m", formulation = "standard" }
body.lower = { generate.rectangle = { from = [2, 0], to = [3, 1], cells = [4, 4], ELEMENT }, material = "m", formulation = "standard" }
interface.joint = { secondary = "upper.bottom", primary = "lower.top", KIND }
support.base = { set = "lower.bottom", x = 0.0, y = 0.0 }
support.top = { set = "upper.top", x = 0.03, y = -0.03, amplitude = "press" }
load.side = { set = "upper.right", traction.value = [-2.0, 1.0] }
"#;

const FLOOR: &str = r#"
model.space = "plane-strain"
body.upper = { generate.half-disc = { radius = 6.0, centre = [0.0, 6.0], size = 1.0, refine = { finest = 0.15, width = 0.4, growth = 1.7 } }, material = "m", formulation = "standard" }
obstacle.drum.cylinder = { centre = [0.0, -20.0], radius = 20.0 }
interface.joint = { secondary = "upper.arc", primary = "drum", friction.coulomb.mu = 0.3 }
support.top = { set = "upper.flat", x = 0.3, y = -0.02, amplitude = "press" }
"#;

const BRICKS: &str = r#"
model.space = "solid"
body.upper = { generate.box = { from = [0.1, 0.1, 1], to = [0.9, 0.8, 1.8], cells = [3, 2, 2], ELEMENT }, material = "m", formulation = "standard" }
body.lower = { generate.box = { to = [1, 1, 1], cells = [2, 3, 2], ELEMENT }, material = "m", formulation = "standard" }
interface.joint = { secondary = "upper.bottom", primary = "lower.top", KIND }
support.base = { set = "lower.bottom", x = 0.0, y = 0.0, z = 0.0 }
support.top = { set = "upper.top", x = 0.01, y = 0.02, z = -0.03, amplitude = "press" }
"#;

/// Largest difference, at any node, between what contact, loads and supports do and what the bodies resist with, relative to the largest contact
/// force, at the end of every increment.
fn out_of_balance(text: &str, space: Space, thickness: f64) -> f64 {
    let medium = Medium {
        young: 1e3,
        poisson: 0.3,
        space,
        thickness,
    };
    let all = format!(
        "format = 1\nmaterial.m.isotropic = {{ young = 1e3, poisson = 0.3 }}\n{text}\n[amplitude]\n         press.table = [[0, 0], [1, 1]]\nslide.table = [[1, 0], [2, 1]]\n         [[step]]\nincrements.fixed = 2\n[[step]]\nincrements.fixed = 3\n"
    );
    let mut simulation = support::build(&support::problem(&all)).unwrap_or_else(|e| panic!("{e}"));
    let mut audit = Audit { medium, worst: 0.0 };
    let outcome = simulation.run(&mut [&mut audit]);
    outcome.unwrap_or_else(|e| panic!("{text}: {e}"));
    audit.worst
}

/// Looks at every increment.
struct Audit {
    medium: Medium,
    worst: f64,
}

impl Observer for Audit {
    fn see(&mut self, simulation: &Analysis, event: Event) -> Result<(), stickslip::Error> {
        if !matches!(event, Event::Increment(_)) {
            return Ok(());
        }
        let fields = stickslip::results::fields(simulation);
        let field = |name: &str| {
            let mut all = fields.all.iter();
            &all.find(|f| f.name == name).expect(name).values
        };
        let (u, contact) = (field("U"), field("CFORCE"));
        let resisted = resist(&simulation.model.mesh, &|_| self.medium, u);
        let external = simulation.external_forces();
        let largest = contact.iter().fold(0.0_f64, |m, f| m.max(f.abs()));
        let dim = simulation.model.dofs.dim;
        for (p, k) in resisted.iter().enumerate() {
            for c in 0..dim {
                let acting = external[dim * p + c] + contact[3 * p + c];
                if largest > 0.0 {
                    self.worst = self.worst.max((k[c] - acting).abs() / largest);
                }
            }
        }
        Ok(())
    }
}

#[test]
fn contact_forces_at_nodes_are_those_that_bodies_resist() {
    let friction = "friction.coulomb.mu = 0.3";
    let nodes = "discretisation.node-to-facet = {}";
    let mut cases = Vec::new();
    for kind in [
        "kinematics.pop-1995 = {}, discretisation.node-to-facet = {}",
        "kinematics.convective = {}, discretisation.node-to-facet = {}",
        "kinematics.small-sliding = {}, discretisation.node-to-facet = {}",
        "enforcement.penalty = {}",
        "enforcement.augmented-lagrangian = {}",
    ] {
        cases.push((ROLLER.replace("KIND", kind), Space::Strain, 1.0));
    }
    for element in ["quad4", "quad8", "tri3"] {
        for kind in [friction, nodes, "tied = true"] {
            let text = PLATES.replace("KIND", kind);
            let text = text.replace("ELEMENT", &format!("element = \"{element}\""));
            let around = format!("model.space = \"axisymmetric\"\n{text}");
            let thick = format!("model.space = \"plane-stress\"\nmodel.thickness = 0.2\n{text}");
            cases.push((thick, Space::Stress, 0.2));
            // The rule by which triangles around the axis are integrated is a matter of choice.
            if element != "tri3" {
                cases.push((around, Space::Axisymmetric, 1.0));
            }
        }
    }
    cases.push((FLOOR.to_string(), Space::Strain, 1.0));
    for element in ["hex8", "tet4", "tet10"] {
        for kind in [friction, nodes, "tied = true"] {
            let text = BRICKS.replace("KIND", kind);
            let text = text.replace("ELEMENT", &format!("element = \"{element}\""));
            cases.push((text, Space::Solid, 1.0));
        }
    }
    for (text, space, thickness) in cases {
        for method in ["sparse", "condensed"] {
            let text = format!("solver.method = \"{method}\"\n{text}");
            let worst = out_of_balance(&text, space, thickness);
            assert!(worst < 1e-6, "{text}: {worst:.1e} of the largest force");
        }
    }
}

/// Largest distance of |q| / p from μ over the points that slip, and how many slip.
fn ratio(simulation: &Simulation, mu: f64) -> (f64, usize) {
    let interface = support::contact(simulation);
    let (names, columns) = look::table(interface, &simulation.frame.state.u);
    let column = |name: &str| {
        let k = names.iter().position(|n| n == name).expect(name);
        &columns[k]
    };
    let [p, a, b, status] = ["CPRESS", "CSHEAR1", "CSHEAR2", "CSTATUS"].map(column);
    let slipping = (0..p.len()).filter(|&i| status[i] == 2.0);
    slipping.fold((0.0, 0), |(worst, count), i| {
        let ratio = a[i].hypot(b[i]) / p[i];
        (f64::max(worst, (ratio - mu).abs()), count + 1)
    })
}

/// A pad on a drum, and on a ball, that turn by `angle` an increment. What multipliers carry is within the limit as nearly as balance is met.
fn pads(angle: f64, more: &str) -> [String; 2] {
    let turned = 2.0 * angle;
    let pad = format!(
        r#"
format = 1
solver.tolerance = 1e-12
material.m.isotropic = {{ young = 1e4, poisson = 0.3 }}
step = [{{ increments.fixed = 2 }}, {{ increments.fixed = 2 }}]
interface.sole = {{ secondary = "pad.bottom", primary = "turning", friction.coulomb.mu = 0.3 }}
{more}
"#
    );
    let motion = format!("angle = [[0, 0], [1, 0], [2, {turned:?}]] }}");
    let drum = format!(
        r#"{pad}
model.space = "plane-strain"
body.pad = {{ generate.rectangle = {{ from = [-0.4, 0], to = [0.4, 0.3], cells = [12, 3] }}, material = "m" }}
obstacle.turning = {{ cylinder = {{ centre = [0, -1], radius = 1.0 }}, motion.rotation = {{ centre = [0, -1], {motion} }}
support.back = {{ set = "pad.top", x = 0, y = -0.06 }}
"#
    );
    let ball = format!(
        r#"{pad}
model.space = "solid"
body.pad = {{ generate.box = {{ from = [-0.4, -0.4, 0], to = [0.4, 0.4, 0.3], cells = [4, 4, 2] }}, material = "m" }}
obstacle.turning = {{ sphere = {{ centre = [0, 0, -1], radius = 1.0 }}, motion.rotation = {{ centre = [0, 0, -1], axis = [0.4, 1, 0.2], {motion} }}
support.back = {{ set = "pad.top", x = 0, y = 0, z = -0.06 }}
"#
    );
    [drum, ball]
}

#[test]
fn what_slips_on_a_drum_or_a_ball_carries_its_limit_for_turns_of_any_size() {
    for angle in [0.01, 0.1, 0.5, 1.0] {
        for text in pads(angle, "") {
            let (record, simulation) = run(&support::problem(&text));
            let (worst, slipping) = ratio(&simulation, 0.3);
            assert!(slipping >= 4, "{angle}: {slipping} slip");
            assert!(worst < 3e-11, "{angle}: {worst:e}\n{text}");
            let gate = &simulation.summary.quality;
            let figure = gate.figures.iter().find(|f| f.figure == "friction-law");
            assert!(figure.expect("judged").value < 1e-9, "{gate:#?}");
            // The last increment went on as the one before: by what the surface has gone by, the arc.
            let (_, row) = record.increments.last().expect("a row");
            let [shear, work] = ["sole.CFS1", "sole.ALLFD"].map(|c| row.get(c).expect(c));
            let (_, before) = &record.increments[record.increments.len() - 2];
            let work = work - before.get("sole.ALLFD").expect("work");
            // With the smallest turn the pad has not yet given way as far as it will.
            if text.contains("plane-strain") && angle >= 0.5 {
                // All of the shear acts at the radius of the drum, across the direction to its centre.
                let interface = support::contact(&simulation);
                let force = look::resultant(interface, &simulation.frame.state.u);
                let torque = (force.moment[2] - force.shear[0] - force.normal[0]).abs();
                assert!(
                    (torque - 0.3 * force.total).abs() < 2e-3 * torque,
                    "{torque}"
                );
                assert!(
                    (work - torque * angle).abs() < 2e-3 * work,
                    "{angle}: {work} {torque}"
                );
                assert!(shear < 0.0);
            }
        }
    }
}

/// A pad on a rigid disc, and on a rigid ball, that turn by `angle` in one increment. Linearised, that makes them grow by `√(1 + angle²)`: the pad gives way.
fn pads_on_bodies(angle: f64, more: &str) -> [String; 2] {
    let way = (1.0 + angle * angle).sqrt() - 1.0 - 0.06;
    let common = format!(
        r#"
format = 1
material.m.isotropic = {{ young = 1e4, poisson = 0.3, density = 1 }}
step = [
    {{ supports = ["centre", "press"], couplings = ["rest"HELD], increments.fixed = 2 }},
    {{ supports = ["centre", "follow"], couplings = ["turn"HELD], increments.fixed = 1 }},
]
{more}
"#
    );
    let disc = format!(
        r#"{common}
model.space = "plane-strain"
body.pad = {{ generate.rectangle = {{ from = [-0.4, 0], to = [0.4, 0.3], cells = [12, 3] }}, material = "m" }}
body.wheel = {{ rigid = true, generate.disc = {{ centre = [0, -1], radius = 1, direction = [0, 1], size = 0.11 }}, material = "m" }}
support.centre = {{ set = "wheel.centre", x = 0, y = 0 }}
support.press = {{ set = "pad.top", x = 0, y = -0.06 }}
support.follow = {{ set = "pad.top", x = 0, y = {way:?} }}
coupling.rest.equation = {{ terms = [{{ set = "wheel.pole", component = "x" }}] }}
coupling.turn.equation = {{ terms = [{{ set = "wheel.pole", component = "x" }}], value = {angle:?} }}
"#
    );
    let ball = format!(
        r#"{common}
model.space = "solid"
body.pad = {{ generate.box = {{ from = [-0.4, -0.4, 0], to = [0.4, 0.4, 0.3], cells = [4, 4, 2] }}, material = "m" }}
body.wheel = {{ rigid = true, generate.ball = {{ centre = [0, 0, -1], radius = 1, direction = [0, 0, 1], size = 0.3 }}, material = "m" }}
support.centre = {{ set = "wheel.centre", x = 0, y = 0, z = 0 }}
support.press = {{ set = "pad.top", x = 0, y = 0, z = -0.06 }}
support.follow = {{ set = "pad.top", x = 0, y = 0, z = {way:?} }}
coupling.rest.equation = {{ terms = [{{ set = "wheel.pole", component = "x" }}] }}
coupling.turn.equation = {{ terms = [{{ set = "wheel.pole", component = "x" }}], value = {angle:?} }}
coupling.level.equation = {{ terms = [{{ set = "wheel.pole", component = "y" }}] }}
coupling.straight.equation = {{ terms = [{{ set = "side", component = "x" }}] }}
set.side = {{ of = "wheel", point = [0, 1, -1] }}
"#
    );
    [
        disc.replace("HELD", ""),
        ball.replace("HELD", ", \"level\", \"straight\""),
    ]
}

#[test]
fn what_slips_on_a_rigid_body_that_turns_carries_its_limit() {
    let [pad, wheel] = [["pad.bottom", "wheel.arc"], ["wheel.arc", "pad.bottom"]];
    // A pad against facets and facets against a pad; how far that goes with one increment is a matter of Newton's method.
    let cases = [
        (pad, "mortar", [true, true], 1.0),
        (pad, "node-to-facet", [true, false], 1.0),
        (wheel, "mortar", [true, true], 0.1),
    ];
    for angle in [0.01, 0.1, 0.5, 1.0] {
        for ([secondary, primary], kind, spaces, most) in cases {
            let sole = format!(
                r#"interface.sole = {{ secondary = "{secondary}", primary = "{primary}", discretisation.{kind} = {{}}, friction.coulomb.mu = 0.3 }}"#
            );
            let texts = pads_on_bodies(angle, &sole).into_iter().zip(spaces);
            for (text, _) in texts.filter(|t| t.1 && angle <= most) {
                let (record, simulation) = run(&support::problem(&text));
                assert_eq!(record.cutbacks, 0, "{text}");
                let (worst, slipping) = ratio(&simulation, 0.3);
                // Of the wheel's points those beyond the edge of the pad have no multiplier.
                let many = if secondary == wheel[0] { 4 } else { 6 };
                assert!(
                    slipping >= if angle < 0.1 { 2 } else { many },
                    "{slipping}: {text}"
                );
                assert!(worst < 1e-10, "{worst:e}: {text}");
                let gate = &simulation.summary.quality;
                let figure = |name: &str, place: &str| {
                    let mut all = gate.figures.iter();
                    all.find(|f| f.figure == name && f.place.ends_with(place))
                        .expect("judged")
                };
                assert!(figure("friction-law", "sole").value < 1e-9, "{gate:#?}");
                // What a linearised rotation makes of far turns is said to be wrong.
                let turned = figure("rotation", "wheel");
                assert!((turned.value - angle).abs() < 1e-10, "{turned:?}");
                assert_eq!(turned.met, angle < 0.05);
                assert!(gate.failed() || turned.met);
            }
        }
    }
}

/// Part of the circle that a band lies around, its thickness and the friction of the drum beneath.
const BAND: (f64, f64, f64) = (std::f64::consts::PI, 0.02, 0.3);

/// The ratio of the tensions in an elastic band around a drum that turns by `angle` an increment.
fn capstan(angle: f64, element: ElementKind) -> f64 {
    let (around, thickness, mu) = BAND;
    let mut mesh = Rectangle {
        element,
        ..Rectangle::new([0.0, 0.0], [around, thickness], [48, 2])
    }
    .generate()
    .expect("a mesh");
    for x in &mut mesh.points {
        let (s, c) = (around - x[0]).sin_cos();
        *x = [(1.0 + x[1]) * c, (1.0 + x[1]) * s, 0.0];
    }
    let mut meshes = Meshes::default();
    meshes.insert("band.msh".into(), Arc::new(mesh));
    let text = format!(
        r#"
format = 1
model.space = "plane-strain"
solver.method = "sparse"
body.band = {{ gmsh.file = "band.msh", material = "m" }}
material.m.isotropic = {{ young = 3e6, poisson = 0.3 }}
obstacle.drum = {{ cylinder = {{ centre = [0, 0], radius = 1.0 }}, motion.rotation = {{ centre = [0, 0], angle = [[0, 0], [1, 0], [2, {turned:?}]] }} }}
interface.grip = {{ secondary = "band.bottom", primary = "drum", friction.coulomb.mu = {mu} }}
support.held = {{ set = "band.left", y = 0 }}
load.pull = {{ set = "band.right", traction.value = [0, {traction:?}] }}
step = [{{ increments.fixed = 2 }}, {{ increments.fixed = 2 }}]
"#,
        turned = -2.0 * angle,
        traction = -1.0 / thickness,
    );
    let problem = support::problem(&text);
    let model = problem.build_with(std::path::Path::new(""), &meshes);
    let mut simulation = Simulation::new(model.unwrap_or_else(|e| panic!("{e}"))).expect("sound");
    let outcome = simulation.run(&mut []);
    outcome.unwrap_or_else(|e| panic!("{e}"));
    let gate = &simulation.summary.quality;
    // A straight edge over 1/48 of half a circle goes into the drum by more of these thin cells than the gate likes.
    assert!(gate.met || element.order() == 1, "{gate:#?}");
    simulation.summary.last["held.RF2"].abs()
}

#[test]
fn the_tensions_of_a_band_around_a_drum_are_those_of_the_capstan() {
    let (around, thickness, mu) = BAND;
    // Euler's formula; friction acts beneath the middle of the band, where the tension is, by half the thickness.
    let exact = (mu * around / (1.0 + 0.5 * thickness)).exp();
    for element in [ElementKind::Quad4, ElementKind::Quad8] {
        let slow = capstan(0.05, element);
        assert!(
            (slow / exact - 1.0).abs() < 1e-3,
            "{element}: {slow} {exact}"
        );
        // What slips does not know how far.
        let fast = capstan(1.0, element);
        assert!((fast / slow - 1.0).abs() < 1e-7, "{element}: {fast} {slow}");
    }
}

/// What a support holds against an obstacle bears what it bore before, however long and by however many increments.
#[test]
fn pressure_that_is_held_stays() {
    let text = r#"
format = 1
model.space = "plane-strain"
body.b = { rigid = true, generate.rectangle = { to = [1, 0.1], cells = [4, 1] }, material = "m" }
material.m.isotropic = { young = 1e7, poisson = 0.25, density = 100 }
obstacle.ground.plane = { point = [0, 0], normal = [0, 1] }
interface.sole = { secondary = "b.bottom", primary = "ground", friction.coulomb.mu = 0.5 }
load.w = { set = "b", gravity.acceleration = [0, -9.81] }
support.catch = { set = "b", hold = ["x"] }
support.guide = { set = "b", hold = ["y"] }
initial.v = { set = "b", velocity = [1, 0] }
output.every = 0
step = [
    { supports = ["catch"], increments.fixed = 1 },
    { supports = ["guide"], duration = 0.3, increments = { initial = 1e-7, smallest = 1e-8, largest = 1e-2 }, dynamic = {} },
]
"#;
    let (record, _) = run(&support::problem(text));
    assert!(record.increments.len() > 50);
    for (_, row) in &record.increments {
        let n = row.get("sole.CFN2").expect("the normal force");
        assert!((n - 98.1).abs() < 1e-4 * 98.1, "{n}");
    }
}

/// Two stressed bodies on an obstacle, as they lie in space: turned, and moved by a thousand sizes.
fn posed(dim: usize, (more, solver): (&str, &str), turn: &Mat3, shift: Vec3) -> Vec<Vec3> {
    // Numbers that lose no digits where they are moved to. No node lies on another: where it sticks, rounding would choose its facet.
    let part = 1.0 / 256.0;
    let cells = [[8, 6, 2], [6, 4, 4]];
    let ends = [
        [[0.0, 0.0, 0.0], [8.0, 6.0, 2.0]],
        [[2.125, 1.125, 2.0], [5.125, 3.125, 4.0]],
    ];
    let ends = ends.map(|ends| ends.map(|x| scale(part, x)));
    let place = |x: Vec3| add(mat_vec(turn, x), shift);
    let numbers = |x: Vec3| format!("{:?}", &x[..dim]);
    // In the plane z is y.
    let flat = |x: Vec3| if dim == 2 { [x[0], x[2], 0.0] } else { x };
    let mut meshes = Meshes::default();
    for (name, ([from, to], cells)) in ["lower", "upper"].iter().zip(ends.into_iter().zip(cells)) {
        let mut mesh = match dim {
            2 => {
                Rectangle::new([from[0], from[2]], [to[0], to[2]], [cells[0], cells[2]]).generate()
            }
            _ => Cuboid::new(from, to, cells).generate(),
        }
        .expect("a mesh");
        mesh.points.iter_mut().for_each(|x| *x = place(*x));
        meshes.insert(format!("{name}.msh").into(), Arc::new(mesh));
    }
    let space = if dim == 2 { "plane-strain" } else { "solid" };
    let up = mat_vec(turn, flat([0.0, 0.0, 1.0]));
    let moved = mat_vec(turn, flat([4e-5, 0.0, -3e-4]));
    let axes = ["x", "y", "z"];
    let components: Vec<String> = (0..dim)
        .map(|i| format!("{} = {:?}", axes[i], moved[i]))
        .collect();
    let text = format!(
        r#"
format = 1
model.space = "{space}"
material.steel.isotropic = {{ young = 210e9, poisson = 0.3 }}
body.lower = {{ gmsh.file = "lower.msh", material = "steel" }}
body.upper = {{ gmsh.file = "upper.msh", material = "steel" }}
obstacle.floor.plane = {{ point = {point}, normal = {normal} }}
interface.base = {{ secondary = "lower.bottom", primary = "floor", friction.coulomb = {{ mu = 0.3 }}{more} }}
interface.joint = {{ secondary = "upper.bottom", primary = "lower.top", friction.coulomb = {{ mu = 0.3 }}{more} }}
support.press = {{ set = "upper.top", {components} }}
{solver}
step = [{{ increments.fixed = 2 }}]
"#,
        point = numbers(shift),
        normal = numbers(up),
        components = components.join(", "),
    );
    let problem = support::problem(&text);
    let model = problem
        .build_with(std::path::Path::new(""), &meshes)
        .unwrap_or_else(|e| panic!("{e}"));
    let mut simulation = Simulation::new(model).unwrap_or_else(|e| panic!("{e}"));
    let outcome = simulation.run(&mut []);
    outcome.unwrap_or_else(|e| panic!("{e}"));
    let last = &simulation.summary.last;
    let force = |name: &str| -> Vec3 {
        let value = |i: usize| last.get(&format!("{name}{}", i + 1)).copied();
        let now = std::array::from_fn(|i| value(i).unwrap_or(0.0));
        // Back to where it was.
        transpose_vec(turn, now)
    };
    ["base.CFN", "base.CFS", "joint.CFN", "joint.CFS"]
        .map(force)
        .to_vec()
}

/// Largest difference of two sets of forces, relative to the largest of them.
fn apart(a: &[Vec3], b: &[Vec3]) -> f64 {
    let most = a.iter().map(|f| norm(*f)).fold(0.0, f64::max);
    assert!(most > 0.0);
    let pairs = a.iter().zip(b);
    pairs
        .map(|(a, b)| norm(sub(*a, *b)) / most)
        .fold(0.0, f64::max)
}

/// A thousand sizes.
const FAR: f64 = 32.0;

fn far(dim: usize) -> Vec3 {
    match dim {
        2 => [FAR, -FAR, 0.0],
        _ => [FAR, -FAR, 0.5 * FAR],
    }
}

#[test]
fn forces_do_not_depend_on_where_and_how_an_assembly_lies() {
    let exact = ("", "solver.tolerance = 1e-11");
    for (dim, axis) in [(2, [0.0, 0.0, 1.0]), (3, [0.48, 0.6, 0.64])] {
        let home = posed(dim, exact, &identity(), [0.0; 3]);
        for angle in [0.7, 2.5] {
            for shift in [[0.0; 3], far(dim)] {
                let there = posed(dim, exact, &rotation(axis, angle), shift);
                let off = apart(&home, &there);
                assert!(off < 1e-9, "{dim}D, {angle} rad, {shift:?}: {off:e}");
            }
        }
    }
}

/// With settings as they are, whatever enforces contact: springs make gaps of 1e-14 of where the model lies into pressure.
#[test]
fn forces_do_not_depend_on_how_far_away_an_assembly_lies() {
    for (dim, axis) in [(2, [0.0, 0.0, 1.0]), (3, [0.48, 0.6, 0.64])] {
        for more in [
            "",
            ", enforcement.penalty = {}",
            ", discretisation.node-to-facet = {}",
            ", discretisation.node-to-facet = {}, enforcement.penalty = {}",
            ", enforcement.perturbed-lagrangian = {}",
        ] {
            for angle in [0.0, 0.7] {
                if dim == 3 && (angle > 0.0 || more.starts_with(", disc")) {
                    continue;
                }
                let turn = rotation(axis, angle);
                let home = posed(dim, (more, ""), &turn, [0.0; 3]);
                let there = posed(dim, (more, ""), &turn, far(dim));
                let off = apart(&home, &there);
                // No better than the balance is solved.
                assert!(off < 1e-8, "{dim}D{more}, {angle} rad: {off:e}");
            }
        }
    }
}

/// What is said of places and moments is said as the user counts.
#[test]
fn places_and_moments_are_those_of_space_wherever_that_is() {
    let turned = |s: f64| {
        let text = format!(
            r#"
format = 1
model.space = "plane-strain"
body.pad = {{ generate.rectangle = {{ from = [{a:?}, {s:?}], to = [{b:?}, {c:?}], cells = [12, 3] }}, material = "m" }}
material.m.isotropic = {{ young = 1e4, poisson = 0.3 }}
obstacle.drum = {{ cylinder = {{ centre = [{s:?}, {below:?}], radius = 1.0 }}, motion.rotation = {{ centre = [{s:?}, {below:?}], angle = [[0, 0], [1, 0], [2, 0.5]] }} }}
interface.sole = {{ secondary = "pad.bottom", primary = "drum", friction.coulomb.mu = 0.3 }}
support.back = {{ set = "pad.top", x = 0, y = -0.0625 }}
step = [{{ increments.fixed = 2 }}, {{ increments.fixed = 2 }}]
"#,
            a = s - 0.375,
            b = s + 0.375,
            c = s + 0.25,
            below = s - 1.0,
        );
        let (_, simulation) = run(&support::problem(&text));
        let interface = support::contact(&simulation);
        let (names, columns) = look::table(interface, &simulation.frame.state.u);
        let column =
            |name: &str| columns[names.iter().position(|n| n == name).expect(name)].clone();
        let of = look::resultant(interface, &simulation.frame.state.u);
        let force = add(of.normal, of.shear);
        let place = interface.place(&interface.points[0]);
        // Counted from the top of the drum.
        let moment = of.moment[2] - (s * force[1] - s * force[0]);
        let x = [
            column("x")[0] - s,
            column("y")[0] - s,
            of.centre[0] - s,
            of.centre[1] - s,
            place[0] - s,
        ];
        (force, moment, x, [column("U1")[0], column("U2")[0]])
    };
    let (here, there) = (turned(0.0), turned(1024.0));
    let size = norm(here.0);
    assert!(size > 0.0 && here.1.abs() > 1e-3 * size);
    assert!(norm(sub(here.0, there.0)) < 1e-9 * size);
    // The moment itself is a thousand times as large.
    assert!(
        (here.1 - there.1).abs() < 1e-9 * size,
        "{} {}",
        here.1,
        there.1
    );
    let pairs = (here.2.iter().zip(&there.2)).chain(here.3.iter().zip(&there.3));
    for (a, b) in pairs {
        assert!((a - b).abs() < 1e-11, "{here:?} {there:?}");
    }
}

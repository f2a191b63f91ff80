//! The quality gate: what trips each limit, what passes, and whether the stated dependence on the numerical stiffness is the true one.

use crate::support;
use stickslip::assess::Figure;
use stickslip::assess::doctor::DoctorCause;
use stickslip::contact::look;
use stickslip::model::GateMode;
use stickslip::run::Simulation;

/// Two blocks with meshes that do not match; the top is moved down and aside.
const BLOCKS: &str = r#"format = 1
model.space = "plane-strain"
body.lower = { generate.rectangle = { to = [1, 1], cells = [4, 4] }, material = "soft" }
body.upper = { generate.rectangle = { from = [0.1, 1], to = [0.9, 2], cells = [3, 3] }, material = "soft" }
material.soft.isotropic = { young = 1e3, poisson = 0.3 }
interface.joint.secondary = "upper.bottom"
interface.joint.primary = "lower.top"
interface.joint.friction.coulomb.mu = 0.3
support.base = { set = "lower.bottom", x = 0.0, y = 0.0 }
support.top = { set = "upper.top", x = 1e-4, y = -1e-2 }
step = [{ name = "press", increments = { fixed = 2 } }]
"#;

fn run(text: &str) -> Simulation {
    let mut simulation = support::build(&support::problem(text)).unwrap_or_else(|e| panic!("{e}"));
    simulation.run(&mut []).unwrap_or_else(|e| panic!("{e}"));
    simulation
}

/// The case with a line more.
fn with(line: &str) -> Simulation {
    run(&format!("{BLOCKS}{line}\n"))
}

fn violated(simulation: &Simulation) -> Vec<&Figure> {
    simulation.summary.quality.violations().collect()
}

/// Whether this figure alone, or with others, is above its limit.
fn trips(simulation: &Simulation, figure: &str) {
    let gate = &simulation.summary.quality;
    let found = gate.violations().find(|f| f.figure == figure);
    let found = found.unwrap_or_else(|| panic!("{figure} is not among {:#?}", gate.figures));
    assert!(found.limit.is_some_and(|limit| found.value > limit));
    assert!(found.sentence(&[]).contains(figure) && found.sentence(&[]).contains(&found.place));
    assert!(gate.failed() && !gate.met);
}

#[test]
fn a_good_solution_passes_and_every_figure_is_listed() {
    let simulation = with("");
    let gate = &simulation.summary.quality;
    assert!(gate.met && !gate.failed(), "{:#?}", violated(&simulation));
    for figure in [
        "penetration-to-size",
        "penetration-to-approach",
        "elastic-slip",
        "complementarity",
        "undetected-penetration",
        "undetected-approach",
        "oscillation",
        "cone-violation",
        "friction-law",
        "action-reaction",
        "moment",
        "equilibrium",
        "rotation",
        "local-rotation",
        "displacement",
        "energy",
    ] {
        let f = gate.figures.iter().find(|f| f.figure == figure);
        let f = f.unwrap_or_else(|| panic!("{figure} is missing"));
        assert!(f.value.is_finite() && f.met, "{f:?}");
    }
    let bodies = gate.figures.iter().filter(|f| f.figure == "equilibrium");
    let places: Vec<&str> = bodies.map(|f| f.place.as_str()).collect();
    assert_eq!(places, ["body lower", "body upper"]);
}

#[test]
fn soft_springs_penetrate_too_far() {
    let simulation =
        with("interface.joint.enforcement.penalty.factor = 1\nquality.penetration-to-size = 1e-3");
    trips(&simulation, "penetration-to-approach");
    trips(&simulation, "penetration-to-size");
}

#[test]
fn soft_springs_of_stick_slip_falsely() {
    let simulation =
        with("interface.joint.enforcement.penalty = { factor = 1e4, tangential-factor = 1e-3 }");
    trips(&simulation, "elastic-slip");
    let normal = simulation.summary.quality.figures.iter();
    let mut normal = normal.filter(|f| f.figure == "penetration-to-approach");
    assert!(normal.all(|f| f.met));
}

#[test]
fn a_coarse_primary_under_a_fine_secondary_makes_the_pressure_oscillate() {
    // The other way round nodes of the fine side fall between those of the coarse one and are pressed the more.
    let text = BLOCKS
        .replace("cells = [3, 3]", "cells = [16, 12]")
        .replace("poisson = 0.3", "poisson = 0.0")
        .replace("x = 1e-4, ", "");
    let smooth = run(&text).summary.interfaces[0].quality.oscillation;
    let simulation = run(&format!("{text}quality.oscillation = {}\n", 0.5 * smooth));
    assert!(smooth > 1e-3, "{smooth}");
    trips(&simulation, "oscillation");
}

#[test]
fn loose_tolerances_leave_bodies_out_of_balance() {
    let simulation =
        with("solver = { tolerance = 0.1, method = \"sparse\" }\nquality.equilibrium = 1e-12");
    trips(&simulation, "equilibrium");
}

#[test]
fn surfaces_that_slide_far_with_small_sliding_lack_a_moment() {
    let text = BLOCKS
        .replace("x = 1e-4", "x = 0.09")
        .replace("mu = 0.3", "mu = 0.01");
    let line = "interface.joint.kinematics.small-sliding = {}\n";
    let simulation = run(&format!("{text}{line}"));
    trips(&simulation, "moment");
    let right = run(&text);
    let mut moments = right.summary.quality.figures.iter();
    assert!(moments.all(|f| f.figure != "moment" || f.value < 1e-6));
}

/// Three blocks in a pile, the middle one apart from the lower: before the gap closes next to nothing acts on it.
const PILE: &str = r#"format = 1
model.space = "plane-strain"
body.lower = { generate.rectangle = { to = [0.06, 0.045], cells = [9, 7] }, material = "soft" }
body.middle = { generate.rectangle = { from = [-0.001, 0.0452], to = [0.06, 0.096], cells = [2, 2] }, material = "soft" }
body.upper = { generate.rectangle = { from = [0, 0.096], to = [0.059, 0.125], cells = [4, 3] }, material = "soft" }
material.soft.isotropic = { young = 2e9, poisson = 0.15 }
interface.low = { secondary = "middle.bottom", primary = "lower.top", normal.power-law = { c = 2e22, m = 2.6 }, friction.coulomb.mu = 0.9 }
interface.high = { secondary = "middle.top", primary = "upper.bottom", normal.LAW, friction.coulomb.mu = 0.9, enforcement.augmented-lagrangian = {} }
support.base = { set = "lower.bottom", x = 0.0, y = 0.0 }
support.top = { set = "upper.top", x = 0.0, y = -4e-4, amplitude = "press" }
amplitude.press = { table = [[0, 0], [1, 1]] }
step = [{ name = "press", increments = { initial = 0.1, largest = 0.2 } }]
"#;

#[test]
fn forces_that_are_as_good_as_none_are_no_alarm() {
    for law in [
        "linear.c = 6e11",
        "power-law = { c = 2e22, m = 2.6 }",
        "power-law = { c = 1e17, m = 2.0 }",
    ] {
        let simulation = run(&PILE.replace("LAW", law));
        let gate = &simulation.summary.quality;
        assert!(gate.met, "{law}: {:#?}", violated(&simulation));
    }
}

#[test]
fn what_is_wrong_at_a_hundredth_of_the_load_is_found_whatever_comes_before() {
    // Pressed hard where surfaces lie opposite, then slid far with a hundredth of that.
    let text = BLOCKS.replace("mu = 0.3", "mu = 0.01").replace(
        "y = -1e-2 }",
        "y = -1e-2, amplitude = \"press\" }\nsupport.aside = { set = \"upper.top\", x = 0.09, amplitude = \"slide\" }",
    );
    let text = text.replace("x = 1e-4, ", "").replace(
        "step = [{ name = \"press\", increments = { fixed = 2 } }]",
        "step = [{ name = \"press\", increments.fixed = 2 }, { name = \"ease\", increments.fixed = 2 }, { name = \"slide\", increments.fixed = 2 }]",
    );
    let tables = "amplitude.press.table = [[0, 0], [1, 1], [2, 0.01], [3, 0.01]]\namplitude.slide.table = [[0, 0], [2, 0], [3, 1]]\n";
    let small = "interface.joint.kinematics.small-sliding = {}\n";
    let simulation = run(&format!("{text}{tables}{small}"));
    trips(&simulation, "moment");
    let worst = violated(&simulation)[0];
    assert!(worst.time > 2.0, "{worst:?}");
    let right = run(&format!("{text}{tables}"));
    assert!(right.summary.quality.met, "{:#?}", violated(&right));
}

#[test]
fn surfaces_that_are_tied_are_judged_in_tension_too() {
    let text = BLOCKS
        .replace(
            "interface.joint.friction.coulomb.mu = 0.3",
            "interface.joint.tied = true",
        )
        .replace("y = -1e-2", "y = 1e-2");
    let simulation = run(&text);
    let mut figures = simulation.summary.quality.figures.iter();
    let figure = figures.find(|f| f.figure == "action-reaction");
    assert!(figure.is_some_and(|f| f.met && f.place == "interface joint"));
}

#[test]
fn an_energy_balance_that_is_open_is_found_where_it_is_asked_for() {
    let simulation = with("quality.energy = 1e-9");
    trips(&simulation, "energy");
}

#[test]
fn limits_below_what_arithmetic_can_do_are_exceeded() {
    let lines = [
        "quality.penetration-to-size = 1e-300",
        "quality.action-reaction = 1e-300",
    ];
    for line in lines {
        let figure = &line["quality.".len()..line.len() - " = 1e-300".len()];
        trips(&with(line), figure);
    }
}

#[test]
fn the_gate_can_warn_or_be_off() {
    let soft = "interface.joint.enforcement.penalty.factor = 1\n";
    let warned = with(&format!("{soft}quality.gate = \"warn\""));
    let gate = &warned.summary.quality;
    assert!(gate.gate == GateMode::Warn && !gate.met && !gate.failed());
    let off = with(&format!("{soft}quality.gate = \"off\""));
    assert!(off.summary.quality.met && off.summary.quality.figures.is_empty());
    let unlimited = with(&format!(
        "{soft}quality = {{ penetration-to-size = inf, penetration-to-approach = inf, elastic-slip = inf }}"
    ));
    assert!(unlimited.summary.quality.met, "{:?}", violated(&unlimited));
}

#[test]
fn what_the_numerical_stiffness_does_is_estimated_within_a_factor_of_two() {
    let press = |factor: f64| {
        let text = BLOCKS.replace("x = 1e-4", "x = 0.0");
        let text = text.replace("interface.joint.friction.coulomb.mu = 0.3\n", "");
        let line = format!("interface.joint.enforcement.penalty.factor = {factor}\n");
        let simulation = run(&format!("{text}{line}quality.gate = \"off\"\n"));
        let force = simulation.summary.last["joint.CFN2"];
        let stated = simulation.summary.interfaces[0].numerical_stiffness;
        (force, stated.expect("a penalty has a stiffness"))
    };
    let (limit, stiff) = press(1e6);
    assert!(stiff.independent_to < 1e-5, "{stiff:?}");
    for factor in [3.0, 10.0, 100.0] {
        let (force, stated) = press(factor);
        let change = (limit - force) / force;
        let ratio = stated.independent_to / change;
        assert!(
            change > 0.0 && (0.5..2.0).contains(&ratio),
            "{factor}: {change} {stated:?}"
        );
        assert!((stated.factor / factor - 1.0).abs() < 1e-12, "{stated:?}");
    }
    let exact = with("").summary.interfaces[0].numerical_stiffness;
    assert!(exact.is_some_and(|n| n.independent_to < 1e-4), "{exact:?}");
}

/// A half-disc of small cells pressed into a block of so many cells across.
fn disc(cells: usize, secondary: &str, primary: &str, more: &str) -> Simulation {
    run(&format!(
        r#"format = 1
model.space = "plane-strain"
body.disc = {{ generate.half-disc = {{ centre = [0.05, 0.09], radius = 0.04, size = 0.004 }}, material = "steel" }}
body.block = {{ generate.rectangle = {{ to = [0.1, 0.05], cells = [{cells}, 3] }}, material = "steel" }}
material.steel.isotropic = {{ young = 210e9, poisson = 0.3 }}
interface.joint = {{ secondary = "{secondary}", primary = "{primary}", friction.coulomb = {{ mu = 0.3 }}{more} }}
support.base = {{ set = "block.bottom", x = 0, y = 0 }}
support.press = {{ set = "disc.flat", x = 0, y = -2e-4 }}
step = [{{ name = "press", increments = {{ fixed = 2 }} }}]"#
    ))
}

/// The sides of an interface as they are named, whatever their meshes.
const AS_NAMED: &str = ", roles = \"as-named\"";

fn force(simulation: &Simulation) -> f64 {
    let interface = support::contact(simulation);
    look::resultant(interface, &simulation.frame.state.u).total
}

#[test]
fn contact_that_a_coarse_secondary_misses_is_found_or_said() {
    let sides = ("disc.arc", "block.top");
    // With the finer side as secondary the force comes down to its limit as the block gets finer, and nothing goes unseen.
    let fine = [5, 6, 8, 12, 20].map(|cells| {
        let run = disc(cells, sides.0, sides.1, "");
        assert!(run.summary.quality.met, "{:#?}", violated(&run));
        force(&run)
    });
    assert!(fine.windows(2).all(|f| f[1] < f[0]), "{fine:?}");
    assert!(fine[4] > 0.75 * fine[0], "{fine:?}");
    // With the sides kept the other way round forces are right within a part, or the gate says so: where nothing is found, and where a mean over large faces finds
    // too much.
    for cells in [5, 6, 7, 8, 10, 12, 16, 20] {
        for more in ["", ", discretisation.node-to-facet = {}"] {
            let more = format!("{AS_NAMED}{more}");
            let simulation = disc(cells, sides.1, sides.0, &more);
            if simulation.summary.quality.met {
                let error = force(&simulation) / fine[4] - 1.0;
                assert!(error.abs() < 0.25, "{cells}{more}: {error}");
            } else {
                trips(&simulation, "undetected-approach");
            }
        }
    }
}

#[test]
fn the_finer_side_is_secondary_whichever_is_named_so() {
    let more = ", wear.archard = { coefficient = 1e-12, primary-coefficient = 3e-12 }, wear-feedback = \"none\", primary-velocity = [0.01, 0]";
    for cells in [5, 6, 8, 12, 20] {
        let named = disc(cells, "disc.arc", "block.top", more);
        // A belt the other way is the same belt seen from the other side.
        let more = more.replace("0.01", "-0.01").replace(
            "1e-12, primary-coefficient = 3e-12",
            "3e-12, primary-coefficient = 1e-12",
        );
        let other = disc(cells, "block.top", "disc.arc", &more);
        assert!(!named.summary.interfaces[0].exchanged && other.summary.interfaces[0].exchanged);
        assert!(other.summary.quality.met, "{:#?}", violated(&other));
        let [a, b] = [&named, &other].map(|s| {
            let i = support::contact(s);
            (
                look::resultant(i, &s.frame.state.u),
                look::wear(i).expect("is followed"),
                look::centre_and_normal(i, &s.frame.state.u),
            )
        });
        let same = |p: [f64; 3], q: [f64; 3], size: f64| {
            for (p, q) in p.iter().zip(q) {
                assert!((p - q).abs() <= 1e-9 * size, "{cells}: {p} {q}");
            }
        };
        // Forces are those on the side that is named secondary, whichever carries the points.
        let turned = |v: [f64; 3]| v.map(|v| -v);
        assert!(
            b.0.normal[1] < -1e7 && a.0.normal[1] > 1e7,
            "{cells}: {a:?} {b:?}"
        );
        same(a.0.normal, turned(b.0.normal), a.0.total);
        same(a.0.shear, turned(b.0.shear), a.0.total);
        same(a.0.moment, turned(b.0.moment), a.0.total);
        same(a.2.0, b.2.0, 1.0);
        same(a.2.1, turned(b.2.1), 1.0);
        let (a, b) = (a.1, b.1);
        assert!(
            a.volume[0] > 0.0 && (a.volume[1] / a.volume[0] - 3.0).abs() < 1e-9,
            "{a:?}"
        );
        assert!((b.volume[0] / b.volume[1] - 3.0).abs() < 1e-9, "{b:?}");
        same(
            [a.depth[0], a.depth[1], 0.0],
            [b.depth[1], b.depth[0], 0.0],
            a.depth[1],
        );
    }
}

#[test]
fn an_interface_that_never_carried_is_named() {
    let simulation = disc(5, "block.top", "disc.arc", AS_NAMED);
    assert_eq!(force(&simulation), 0.0);
    let causes: Vec<DoctorCause> = (simulation.summary.findings.iter())
        .map(|f| f.cause)
        .collect();
    assert!(causes.contains(&DoctorCause::NeverCarried), "{causes:?}");
}

#[test]
fn contact_at_one_point_is_called_coarse() {
    let simulation = disc(20, "disc.arc", "block.top", "");
    let found = simulation.summary.findings.iter();
    let mut found = found.filter(|f| f.cause == DoctorCause::CoarseContact);
    let finding = found.next().expect("a finding");
    assert!(finding.message.contains("1 point of 33"), "{finding}");
    // Blocks in contact all over are resolved by any mesh.
    assert!(with("").summary.findings.is_empty());
}

/// A block on the floor or on another body that is narrower than one of its faces.
fn narrow(below: &str, secondary: &str, primary: &str, more: &str) -> Simulation {
    run(&format!(
        r#"format = 1
model.space = "solid"
body.upper = {{ generate.box = {{ from = [0, 0, 1], to = [2, 2, 2], cells = [1, 1, 2] }}, material = "soft" }}
material.soft.isotropic = {{ young = 1e3, poisson = 0.3 }}
{below}
interface.joint = {{ secondary = "{secondary}", primary = "{primary}", discretisation.node-to-facet = {{}}{more} }}
support.top = {{ set = "upper.top", x = 0, y = 0, z = -2e-2 }}
step = [{{ name = "press", increments = {{ fixed = 1 }} }}]"#
    ))
}

#[test]
fn what_pokes_between_points_is_seen() {
    let body = |element: &str| {
        format!(
            r#"body.lower = {{ generate.box = {{ from = [0.7, 0.7, 0], to = [1.2, 1.2, 1], cells = [2, 2, 2], element = "{element}" }}, material = "soft" }}
support.base = {{ set = "lower.bottom", x = 0, y = 0, z = 0 }}"#
        )
    };
    for element in ["hex8", "tet4", "hex20"] {
        let simulation = narrow(&body(element), "upper.bottom", "lower.top", AS_NAMED);
        assert_eq!(force(&simulation), 0.0);
        trips(&simulation, "undetected-approach");
        // With the narrow body as secondary nothing is missed; its cells make it that.
        for (secondary, primary) in [("lower.top", "upper.bottom"), ("upper.bottom", "lower.top")] {
            let simulation = narrow(&body(element), secondary, primary, "");
            assert!(force(&simulation) > 0.0);
            assert!(
                simulation.summary.quality.met,
                "{:#?}",
                violated(&simulation)
            );
        }
    }
    // A ball smaller than the face above it.
    let ball = "obstacle.ball.sphere = { centre = [1, 1, 0.7], radius = 0.3 }";
    let simulation = narrow(ball, "upper.bottom", "ball", "");
    assert_eq!(force(&simulation), 0.0);
    trips(&simulation, "undetected-approach");
}

#[test]
fn a_corner_that_enters_is_of_the_way_that_the_bodies_came() {
    // A rigid block with sharp edges over faces that end elsewhere: the pressure under the edges is several times the mean.
    let simulation = run(r#"format = 1
model.space = "solid"
body.lower = { generate.box = { from = [-5, -5, -3.5], to = [5, 5, 0], cells = [5, 5, 1], element = "hex20" }, material = "soft" }
body.upper = { generate.box = { from = [-4.15, -4.15, 0], to = [4.15, 4.15, 2.5], cells = [4, 4, 1] }, material = "hard", rigid = true }
material.soft.isotropic = { young = 1e3, poisson = 0.2 }
material.hard.isotropic = { young = 1e6, poisson = 0.2, density = 1 }
interface.joint = { secondary = "lower.top", primary = "upper.bottom", roles = "as-named", discretisation.node-to-facet = {} }
support.base = { set = "lower.bottom", x = 0, y = 0, z = 0 }
support.press = { set = "upper.top", x = 0, y = 0, z = -0.1 }
step = [{ name = "press", increments = { fixed = 1 } }]"#);
    let interface = support::contact(&simulation);
    let between = look::between(
        interface,
        &simulation.frame.state.u,
        simulation.frame.state.t,
    );
    // The bodies have come nearer by 0.1, and a layer of cells is all of the lower body: under the largest pressure it would be shorter by 0.49.
    assert!(between.penetration > 0.03, "{between:?}");
    let layer = look::quality(interface).layer;
    assert!((0.05..0.25).contains(&layer), "{layer}");
    trips(&simulation, "undetected-approach");
}

#[test]
fn laws_that_yield_are_integrated_over_a_part_of_a_quadratic_face() {
    // Nothing deforms: overlap times stiffness times the area in common is the force.
    let (overlap, stiffness) = (1e-3, 1e6);
    for element in ["hex20", "tet10"] {
        for width in [0.15, 0.45, 0.8] {
            let simulation = run(&format!(
                r#"format = 1
model.space = "solid"
body.lower = {{ generate.box = {{ to = [{width}, 1, 1], cells = [1, 1, 1] }}, material = "soft" }}
body.upper = {{ generate.box = {{ from = [0, 0, 1], to = [1, 1, 2], cells = [1, 1, 1], element = "{element}" }}, material = "soft" }}
material.soft.isotropic = {{ young = 1e3, poisson = 0.3 }}
interface.joint = {{ secondary = "upper.bottom", primary = "lower.top", roles = "as-named", discretisation.node-to-facet = {{}}, normal.linear = {{ c = {stiffness:e} }} }}
support.lower = {{ set = "lower", x = 0, y = 0, z = 0 }}
support.upper = {{ set = "upper", x = 0, y = 0, z = -{overlap} }}
quality.gate = "off"
step = [{{ name = "press", increments = {{ fixed = 1 }} }}]"#
            ));
            let wanted = overlap * stiffness * width;
            let error = force(&simulation) / wanted - 1.0;
            assert!(error.abs() < 0.25, "{element} {width}: {error}");
        }
    }
}

#[test]
fn cells_that_no_contact_can_be_resolved_by_are_named_before_the_run() {
    let found = |cells: usize, more: &str| {
        let simulation = disc(cells, "disc.arc", "block.top", more);
        let found = simulation.summary.findings.iter();
        found
            .filter(|f| f.cause == DoctorCause::CoarseContact && f.time.is_none())
            .map(|f| f.message.clone())
            .collect::<Vec<_>>()
    };
    let said = found(5, "");
    assert!(
        said.len() == 1 && said[0].contains("the primary (body block) are 0.5"),
        "{said:?}"
    );
    assert!(found(20, "").is_empty());
}

/// Two half-discs pressed together and pulled aside.
fn discs(more: &str) -> Simulation {
    run(&format!(
        r#"format = 1
model.space = "plane-strain"
body.lower = {{ generate.half-disc = {{ centre = [0, -8], radius = 8, direction = [0, 1], size = 2, refine = {{ finest = 0.08, width = 0.8, growth = 1.7 }} }}, material = "m" }}
body.upper = {{ generate.half-disc = {{ centre = [0, 8], radius = 8, direction = [0, -1], size = 2, refine = {{ finest = 0.08, width = 0.8, growth = 1.7 }} }}, material = "m" }}
material.m.isotropic = {{ young = 200, poisson = 0.3 }}
interface.contact = {{ secondary = "upper.arc", primary = "lower.arc", friction.coulomb.mu = 0.2{more} }}
support.base = {{ set = "lower.flat", x = 0, y = 0 }}
support.press = {{ set = "upper.flat", x = 0.005, y = -0.1 }}
step = [{{ increments = {{ fixed = 2 }} }}]"#
    ))
}

#[test]
fn small_sliding_says_by_how_much_surfaces_have_turned() {
    let turned = |simulation: &Simulation| {
        let findings = simulation.summary.findings.iter();
        let mut findings = findings.filter(|f| f.cause == DoctorCause::TurnedNormals);
        findings.next().cloned()
    };
    let simulation = discs(", kinematics.small-sliding = {}");
    let finding = turned(&simulation).expect("a finding");
    // Round surfaces become flat where they press: at x the normal of the start is off by x over R, up to the last points that press by a tenth.
    let interface = support::contact(&simulation);
    let (names, columns) = look::table(interface, &simulation.frame.state.u);
    let column = |name: &str| &columns[names.iter().position(|n| n == name).unwrap()];
    let peak = column("CPRESS").iter().fold(0.0, |m: f64, p| m.max(*p));
    let pressed = column("x").iter().zip(column("CPRESS"));
    let widest = pressed.filter(|(_, p)| **p > 0.1 * peak);
    let widest = widest.fold(0.0, |m: f64, (x, _)| m.max(x.abs()));
    let said = finding.message.split("up to ").nth(1);
    let said = said.and_then(|s| s.split(' ').next()?.parse::<f64>().ok());
    let said = said.expect("an angle");
    assert!(
        (said / (widest / 8.0) - 1.0).abs() < 0.15,
        "{finding} {widest}"
    );
    // Pressure has as much along the surface: in the mean of what presses, beside a limit of a fifth of the pressure.
    let figure = |simulation: &Simulation| {
        let figures = simulation.summary.quality.figures.iter();
        let mut figures = figures.filter(|f| f.figure == "outdated-normals");
        figures.next().cloned()
    };
    let figure_of = |simulation| figure(simulation).expect("a figure");
    let [along, force] = column("x")
        .iter()
        .zip(column("CNORMF"))
        .fold([0.0; 2], |[along, force]: [f64; 2], (x, f)| {
            [along + f * x.abs() / 8.0, force + f]
        });
    let judged = figure_of(&simulation);
    let strict = discs(", kinematics.small-sliding = {} }\nquality.outdated-normals = 0.1 #");
    assert!(!figure_of(&strict).met && !strict.summary.quality.met);
    let expected = along / (0.2 * force);
    assert!(
        (judged.value / expected - 1.0).abs() < 0.1,
        "{judged:?} {expected}"
    );
    assert!(turned(&discs("")).is_none() && figure(&discs("")).is_none());
}

#[test]
fn facets_that_are_off_by_a_part_of_the_fit_are_named() {
    let fit = |size: f64, element: &str| {
        let text = format!(
            r#"format = 1
model.space = "plane-strain"
body.disc = {{ generate.half-disc = {{ centre = [0, 0], radius = 1, size = {size}, element = "{element}" }}, material = "m" }}
material.m.isotropic = {{ young = 200, poisson = 0.3 }}
obstacle.hole.cylinder = {{ centre = [0, 0], radius = 0.999, inside = true }}
interface.fit = {{ secondary = "disc.arc", primary = "hole", initial = "ramp" }}
support.flat = {{ set = "disc.flat", y = 0 }}
step = [{{}}]"#
        );
        let mut simulation =
            support::build(&support::problem(&text)).unwrap_or_else(|e| panic!("{e}"));
        let findings = simulation.check().findings;
        findings
            .iter()
            .any(|f| f.cause == DoctorCause::CoarseFacets)
    };
    // An eighth of the square of a facet over the radius, beside an overlap of a thousandth.
    assert!(fit(0.1, "quad4"));
    assert!(!fit(0.02, "quad4"));
    assert!(!fit(0.1, "quad8"));
}

/// A block that is held at its left end and pushed up at the other.
const BEAM: &str = r#"format = 1
model.space = "plane-strain"
body.beam = { generate.rectangle = { to = [8, 1], cells = [16, 2] }, material = "soft", formulation = "incompatible-modes" }
material.soft.isotropic = { young = 1e3, poisson = 0.3 }
support.base = { set = "beam.left", x = 0.0, y = 0.0 }
load.tip = { set = "beam.right", traction.value = [0, 1] }
step = [{ name = "bend", increments = { fixed = 1 } }]
"#;

/// The figure of this name at its worst.
fn figure<'a>(simulation: &'a Simulation, name: &str) -> &'a Figure {
    let mut all = simulation.summary.quality.figures.iter();
    let found = all.find(|f| f.figure == name);
    found.unwrap_or_else(|| panic!("{name} is missing"))
}

#[test]
fn a_beam_that_bends_far_is_beyond_small_rotations() {
    let simulation = run(BEAM);
    trips(&simulation, "rotation");
    trips(&simulation, "local-rotation");
    // Euler and Bernoulli: the end turns by F L² / 2 E' I, the beam by two thirds of it; shear adds a little of its own.
    let bending = 1.0 * 8.0_f64.powi(2) / (2.0 * 1e3 / 0.91 / 12.0);
    let (mean, end) = (
        figure(&simulation, "rotation").value,
        figure(&simulation, "local-rotation").value,
    );
    assert!((mean / (bending * 2.0 / 3.0) - 1.0).abs() < 0.05, "{mean}");
    assert!((end / bending - 1.0).abs() < 0.08, "{end} of {bending}");
    assert_eq!(simulation.summary.largest_rotation, mean);
    let gently = run(&BEAM.replace("[0, 1] }", "[0, 0.1] }"));
    let turned = gently.summary.largest_rotation;
    assert!(gently.summary.quality.met && turned > 0.005, "{turned}");
}

/// Frames of cells turn by any angle; what is tied to a reference point follows its rotation linearly all the same, and is stretched by half the square of it.
#[test]
fn a_reference_point_that_turns_farther_than_small_is_named() {
    let turned = |angle: f64| {
        run(&format!(
            r#"format = 1
model.space = "plane-strain"
body.beam = {{ generate.rectangle = {{ to = [8, 1], cells = [16, 2] }}, material = "soft", rotation = "corotational" }}
material.soft.isotropic = {{ young = 1e3, poisson = 0.3 }}
support.base = {{ set = "beam.left", x = 0.0, y = 0.0 }}
reference.end.point = [8, 0.5]
coupling.end.kinematic = {{ reference = "end", set = "beam.right" }}
support.turn = {{ set = "end", rotation-z = {angle} }}
step = [{{ name = "turn", increments = {{ fixed = 4 }} }}]
"#
        ))
    };
    let far = turned(0.3);
    trips(&far, "rotation");
    let mut all = far.summary.quality.figures.iter();
    let found = all.find(|f| f.figure == "rotation" && f.place == "reference point end");
    let value = found.expect("judged").value;
    assert!((value - 0.3).abs() < 1e-12, "{value}");
    assert!(turned(0.03).summary.quality.met);
}

#[test]
fn a_body_that_is_strained_by_more_than_a_twentieth_is_beyond_the_theory_of_its_frame() {
    let axle = format!(
        "reference.axle.point = [0, 0]\nsupport.axle = {{ set = \"axle\", x = 0, y = 0, rotation-z = {} }}\n",
        std::f64::consts::FRAC_PI_2
    );
    for (rotation, more, turned) in [
        ("rotation = \"corotational\"", "", false),
        ("rotation = \"large\"", "", false),
        ("rotation.with = \"axle\"", axle.as_str(), true),
    ] {
        // A bar that a force draws out evenly: by that over its section and its modulus.
        let drawn = |strain: f64| {
            let along = match turned {
                true => [0.0, 1e3 * strain],
                false => [1e3 * strain, 0.0],
            };
            run(&format!(
                r#"format = 1
model.space = "plane-stress"
body.bar = {{ generate.rectangle = {{ to = [4, 1], cells = [4, 2] }}, material = "m", {rotation} }}
material.m.isotropic = {{ young = 1e3, poisson = 0 }}
support.root = {{ set = "bar.left", x = 0, y = 0 }}
load.pull = {{ set = "bar.right", traction.value = {along:?} }}
step = [{{ increments = {{ fixed = 1 }} }}]
{more}"#
            ))
        };
        let (far, near) = (drawn(0.06), drawn(0.04));
        trips(&far, "strain");
        for (simulation, strain) in [(&far, 0.06), (&near, 0.04)] {
            let found = figure(simulation, "strain");
            assert_eq!(found.met, strain < 0.05, "{rotation}: {found:?}");
            let value = found.value;
            assert!((value / strain - 1.0).abs() < 1e-6, "{rotation}: {value}");
        }
    }
    // Bodies without frames have other figures.
    let mut figures = with("").run.summary.quality.figures.into_iter();
    assert!(figures.all(|f| f.figure != "strain"));
}

#[test]
fn a_body_that_spins_by_more_than_the_theory_knows_is_not_a_good_result() {
    for rigid in [false, true] {
        let text = format!(
            r#"format = 1
model.space = "plane-stress"
body.disc = {{ generate.rectangle = {{ to = [1, 1], cells = [2, 2] }}, material = "m", rigid = {rigid} }}
material.m.isotropic = {{ young = 1e9, poisson = 0.3, density = 1000 }}
initial.spin = {{ set = "disc", spin = [5] }}
step = [{{ name = "spin", duration = 0.1, dynamic = {{}}, increments = {{ fixed = 20 }} }}]
"#
        );
        let simulation = run(&text);
        trips(&simulation, "rotation");
        let turned = simulation.summary.largest_rotation;
        assert!((turned / 0.5 - 1.0).abs() < 0.05, "{rigid}: {turned}");
    }
}

#[test]
fn a_body_on_a_spring_too_soft_has_left_the_model() {
    let text = |stiffness: f64| {
        format!(
            r#"format = 1
model.space = "plane-strain"
body.block = {{ generate.rectangle = {{ to = [1, 1], cells = [2, 2] }}, material = "m" }}
material.m.isotropic = {{ young = 1e9, poisson = 0.3 }}
support.rail = {{ set = "block.bottom", y = 0 }}
load.spring = {{ set = "block.left", spring.stiffness = [{stiffness}, 0] }}
load.pull = {{ set = "block.right", traction.value = [30, 0] }}
step = [{{ name = "pull", increments = {{ fixed = 1 }} }}]
"#
        )
    };
    trips(&run(&text(1.0)), "displacement");
    let held = run(&text(1e3));
    assert!(held.summary.quality.met, "{:#?}", violated(&held));
    // What is prescribed is no loss.
    let moved = BLOCKS
        .replace("x = 0.0, y = 0.0 }", "x = 9.0, y = 0.0 }")
        .replace("x = 1e-4", "x = 9.0");
    let moved = run(&moved);
    assert!(figure(&moved, "displacement").met && figure(&moved, "displacement").value > 0.5);
}

#[test]
fn a_body_that_flies_off_in_motion_is_a_finding() {
    let text = r#"format = 1
model.space = "plane-strain"
body.block = { generate.rectangle = { to = [1, 1], cells = [2, 2] }, material = "m" }
material.m.isotropic = { young = 1e9, poisson = 0.3, density = 1000 }
initial.throw = { set = "block", velocity = [0, 5] }
step = [{ name = "fly", duration = 1, dynamic = {}, increments = { fixed = 4 } }]
"#;
    let simulation = run(text);
    assert!(
        simulation.summary.quality.met,
        "{:#?}",
        violated(&simulation)
    );
    let findings = &simulation.summary.findings;
    let far: Vec<_> = findings
        .iter()
        .filter(|f| f.cause == DoctorCause::FarAway)
        .collect();
    assert_eq!(far.len(), 1, "{findings:#?}");
    assert!(far[0].message.contains("body block"), "{far:?}");
}

/// A block over a gap; what presses and slides it comes behind.
const OVER_A_GAP: &str = r#"format = 1
model.space = "plane-strain"
body.block = { generate.rectangle = { from = [0, 1e-5], to = [0.04, 0.02001], cells = [10, 5] }, material = "steel" }
material.steel.isotropic = { young = 210e9, poisson = 0.3 }
obstacle.floor.plane = { point = [0, 0], normal = [0, 1] }
interface.base = { secondary = "block.bottom", primary = "floor" }
"#;

/// The same as the obstacle comes up.
const FLOOR_COMES: &str = "support.hold = { set = \"block.top\", x = 0.0, y = 0.0 }\nobstacle.floor.motion.translation = [[0, 0, 0], [1, 0, 1.2e-5]]\n";

/// Largest residual over the largest energy in play, at the end of every increment.
fn residual(simulation: &Simulation) -> f64 {
    simulation.summary.balance.energy_quality.residual
}

#[test]
fn work_is_that_along_the_path_where_gaps_close_within_increments() {
    let pressed = "support.press = { set = \"block.top\", x = 0.0, y = -1.2e-5 }\n";
    for (what, driven) in [("support", pressed), ("obstacle", FLOOR_COMES)] {
        for increments in ["fixed = 1", "fixed = 3", "initial = 0.1"] {
            let step = format!("step = [{{ increments = {{ {increments} }} }}]\n");
            let simulation = run(&format!("{OVER_A_GAP}{driven}{step}"));
            let e = &simulation.summary.balance.energy;
            let stored = e.strain + e.contact;
            let work = [e.external_work, e.belt_work];
            let [all, none] = match what {
                "support" => work,
                _ => [work[1], work[0]],
            };
            assert!(
                (all / stored - 1.0).abs() < 1e-6 && none.abs() < 1e-9 * stored,
                "{what}, {increments}: {work:?} for {stored:e}"
            );
            assert!(residual(&simulation) < 1e-6, "{what}, {increments}");
        }
    }
}

#[test]
fn the_ledger_closes_where_points_open_close_and_begin_to_slide_within_increments() {
    let bodies = BLOCKS.replace(
        "from = [0.1, 1], to = [0.9, 2]",
        "from = [0.1, 1.0004], to = [0.9, 2.0004]",
    );
    let bodies = bodies.replace("x = 1e-4, y = -1e-2", "y = -1e-3, amplitude = \"press\"");
    let slid = "support.aside = { set = \"upper.top\", x = 4e-4, amplitude = \"slide\" }\n\
        amplitude.press.table = [[0, 0], [1, 1], [2, 1], [3, 0.2]]\n\
        amplitude.slide.table = [[0, 0], [1, 0], [2, 1], [3, -1]]\n";
    let run_in = |text: &str, increments: usize| {
        let from = text.find("step = ").expect("a step");
        let steps = format!("[[step]]\nincrements.fixed = {increments}\n").repeat(3);
        run(&format!("{}{slid}{steps}", &text[..from]))
    };
    let laws = [
        ("", "unilateral"),
        ("interface.joint.normal.linear.c = 1e4\n", "linear"),
        ("interface.joint.enforcement.penalty = {}\n", "penalty"),
        (
            "interface.joint.discretisation.node-to-facet = {}\n",
            "node-to-facet",
        ),
    ];
    for (line, what) in laws {
        let text = bodies.replace("support.base", &format!("{line}support.base"));
        let fine = run_in(&text, 40).summary.balance.energy;
        for increments in [1, 2, 5, 10] {
            let simulation = run_in(&text, increments);
            let left = residual(&simulation);
            assert!(left < 1e-3, "{what}, {increments}: {left:e}");
            // What friction took is known as well as is said.
            let e = &simulation.summary.balance.energy;
            let off = (e.friction - fine.friction).abs();
            let most = e.uncertain + fine.uncertain + 0.02 * fine.friction;
            assert!(
                off < most,
                "{what}, {increments}: {:e} for {:e} ± {most:e}",
                e.friction,
                fine.friction
            );
        }
    }
}

/// From one equilibrium to the next the bodies go with their loads and reactions in proportion, however a table of time jumps.
#[test]
fn the_ledger_closes_where_loads_jump_and_supports_let_go() {
    let bodies = BLOCKS.replace(
        "support.top = { set = \"upper.top\", x = 1e-4, y = -1e-2 }",
        "",
    );
    let bodies = bodies.replace("interface.joint.friction.coulomb.mu = 0.3\n", "");
    let (bodies, _) = bodies.split_once("step = ").expect("a step");
    let driven = "support.side = { set = \"upper.left\", x = 0.0 }\n\
        support.pull = { set = \"upper.right\", x = 1e-3 }\n\
        load.press = { set = \"upper.top\", pressure = { value = 1.0 }, amplitude = \"at-once\" }\n\
        amplitude.at-once.table = [[0, 1], [1, 1], [1.001, 3], [2, 3], [2.5, 3], [2.501, 0.5], [3, 0.5]]\n";
    for method in ["sparse", "condensed"] {
        for increments in [1, 4] {
            let steps = format!(
                "[[step]]\nincrements.fixed = {increments}\nsupports = [\"base\", \"side\", \"pull\"]\n\
                 [[step]]\nincrements.fixed = {increments}\nsupports = [\"base\", \"side\"]\n\
                 [[step]]\nincrements.fixed = {}\nsupports = [\"base\", \"side\"]\n",
                2 * increments
            );
            let simulation = run(&format!(
                "{bodies}{driven}solver.method = \"{method}\"\n{steps}"
            ));
            let (left, e) = (residual(&simulation), &simulation.summary.balance.energy);
            // Sliding by 1e-3 of the size changes who faces whom.
            assert!(left < 1e-4, "{method}, {increments}: {left:e}, {e:?}");
            assert!(e.strain > 0.0);
        }
    }
}

#[test]
fn an_obstacle_that_turns_does_the_work_of_its_moment() {
    let simulation = run(r#"format = 1
model.space = "solid"
body.block = { generate.box = { from = [-1, -1, 0], to = [1, 1, 1], cells = [4, 4, 2] }, material = "soft" }
material.soft.isotropic = { young = 1e6, poisson = 0.3 }
obstacle.table = { plane = { point = [0, 0, 0], normal = [0, 0, 1] }, motion.rotation = { centre = [0, 0, 0], axis = [0, 0, 1], angle = [[0, 0], [1, 0], [2, 0.05]] } }
interface.base = { secondary = "block.bottom", primary = "table", friction.coulomb.mu = 0.1 }
support.press = { set = "block.top", x = 0.0, y = 0.0, z = -0.01, amplitude = "press" }
amplitude.press.table = [[0, 0], [1, 1]]
step = [{ increments.fixed = 1 }, { increments.fixed = 10 }]
"#);
    let e = &simulation.summary.balance.energy;
    assert!(e.friction > 0.0 && residual(&simulation) < 1e-3, "{e:?}");
    // Nothing else moves in the second step.
    assert!(e.belt_work > e.friction, "{e:?}");
}

#[test]
fn a_table_that_shakes_a_block_does_work() {
    let rows: Vec<String> = (0..=50)
        .map(|k| {
            let t = 0.01 * f64::from(k);
            let x = 0.01 * (1.0 - (std::f64::consts::TAU * t).cos());
            format!("[{:.2}, {x}, 0]", 1.0 + t)
        })
        .collect();
    let text = format!(
        r#"format = 1
model.space = "plane-strain"
body.b = {{ generate.rectangle = {{ to = [0.4, 0.1], cells = [4, 2] }}, rayleigh.stiffness = 1e-4, material = "m" }}
material.m.isotropic = {{ young = 1e7, poisson = 0.3, density = 1000 }}
obstacle.table = {{ plane = {{ point = [0, 0], normal = [0, 1] }}, motion.translation = [[0, 0, 0], {}] }}
interface.i = {{ secondary = "b.bottom", primary = "table", friction.coulomb.mu = 0.3 }}
load.w = {{ set = "b", gravity.acceleration = [0, -9.81] }}
support.catch = {{ set = "b", hold = ["x"] }}
"#,
        rows.join(", ")
    );
    for dynamic in [
        "increments.fixed = 100, dynamic = {}",
        "dynamic.scheme.central-difference = {}",
    ] {
        let steps = format!(
            "step = [{{ supports = [\"catch\"], increments.fixed = 1 }}, {{ supports = [], duration = 0.5, {dynamic} }}]\n"
        );
        let simulation = run(&format!("{text}{steps}"));
        let e = &simulation.summary.balance.energy;
        // The block has the velocity of the table, 0 at the end; half-way it had 0.0628 m/s: 0.079 J.
        assert!(e.belt_work.abs() < 1e-2, "{dynamic}: {e:?}");
        let scale = simulation.summary.balance.energy_quality.scale;
        assert!(scale > 0.075, "{dynamic}: {scale:e}");
        assert!(
            simulation.summary.quality.met,
            "{dynamic}: {:?}",
            violated(&simulation)
        );
    }
}

/// Discs that close a gap in one increment turn their surfaces against each other while these are still apart: that is no slip, and shear that goes with it
/// is not along the slip.
#[test]
fn surfaces_that_turn_while_they_close_have_not_slipped() {
    let simulation = run(r#"format = 1
model.space = "plane-strain"
body.lower = { generate.half-disc = { centre = [0, -10], direction = [0, 1], radius = 10, size = 5, refine = { finest = 0.2, width = 1.2, growth = 1.6 } }, material = "soft" }
body.upper = { generate.half-disc = { centre = [0, 10.0174], direction = [0, -1], radius = 10, size = 5, element = "tri3", refine = { finest = 0.8, width = 1.6, growth = 1.6 } }, material = "hard" }
material.soft.isotropic = { young = 1.43e4, poisson = 0.227 }
material.hard.isotropic = { young = 3.25e4, poisson = 0.277 }
interface.joint = { secondary = "lower.arc", primary = "upper.arc", friction.coulomb.mu = 0.762 }
support.base = { set = "lower.flat", x = 0, y = 0 }
support.press = { set = "upper.flat", x = 0, y = -0.169 }
step = [{ increments.fixed = 1 }]
"#);
    let interface = support::contact(&simulation);
    let (names, columns) = look::table(interface, &simulation.frame.state.u);
    let status = names.iter().position(|n| n == "CSTATUS").expect("CSTATUS");
    assert!(columns[status].contains(&2.0), "nothing slips");
    let figures = &simulation.summary.quality.figures;
    let figure = figures.iter().find(|f| f.figure == "friction-law");
    assert!(figure.expect("judged").value < 1e-6, "{figure:?}");
}

/// Beside the edge of a punch the mean over the corner of a quadratic face that it covers is no depth of the whole face.
#[test]
fn a_corner_of_a_face_that_is_covered_is_not_contact_that_is_missed() {
    for half in [3.6, 3.65, 4.0] {
        let simulation = run(&format!(
            r#"format = 1
model.space = "plane-strain"
body.lower = {{ generate.rectangle = {{ from = [-5, -3.4], to = [5, 0], cells = [7, 2], element = "tri6" }}, material = "soft" }}
body.upper = {{ generate.rectangle = {{ from = [-{half}, 0], to = [{half}, 3], cells = [4, 1], element = "tri6" }}, material = "hard" }}
material.soft.isotropic = {{ young = 8e3, poisson = 0.25 }}
material.hard.isotropic = {{ young = 3.2e4, poisson = 0.15 }}
interface.joint = {{ secondary = "lower.top", primary = "upper.bottom", normal.linear.c = 1.1e4 }}
support.base = {{ set = "lower.bottom", x = 0, y = 0 }}
support.press = {{ set = "upper.top", x = 0, y = -0.03 }}
step = [{{ increments.fixed = 1 }}]
"#
        ));
        let figures = &simulation.summary.quality.figures;
        let figure = figures.iter().find(|f| f.figure == "undetected-approach");
        assert!(figure.expect("judged").value < 0.05, "{half}: {figure:?}");
        assert!(
            simulation.summary.quality.met,
            "{half}: {:?}",
            violated(&simulation)
        );
    }
}

#[test]
fn a_body_that_leaves_without_any_force_has_a_balance() {
    // The upper block rises by twice its cells and nothing resists: energies are rounding, and no part of anything.
    let text = BLOCKS
        .replace("x = 1e-4, y = -1e-2", "x = 0.0, y = 2e-3")
        .replace("friction.coulomb.mu = 0.3", "normal.linear.c = 1e4");
    let simulation = run(&text);
    let gate = &simulation.summary.quality;
    assert!(gate.met && !gate.failed(), "{:#?}", violated(&simulation));
    assert!(simulation.summary.balance.energy.strain.abs() < 1e-16);
}

/// A shaft in a hub, larger by this much, whose axle turns by this angle: `rotation` of the shaft, and what ties it to its axle.
fn turned_fit(angle: f64, [rotation, tie]: [&str; 2]) -> String {
    format!(
        r#"format = 1
model.space = "plane-strain"
material.steel.isotropic = {{ young = 210000, poisson = 0.3 }}
body.shaft = {{ generate.ring = {{ bore = 5, radius = 20.01, cells = [16, 2], element = "quad8" }}, material = "steel"{rotation} }}
body.hub = {{ generate.ring = {{ bore = 20, radius = 40, cells = [16, 2], element = "quad8" }}, material = "steel" }}
interface.fit = {{ secondary = "shaft.rim", primary = "hub.bore", initial = "ramp" }}
reference.axle.point = [0, 0]
{tie}
support.hub = {{ set = "hub.rim", x = 0, y = 0 }}
support.axle = {{ set = "axle", x = 0, y = 0, rotation-z = {angle}, amplitude = "turn" }}
amplitude.turn.table = [[0, 0], [1, 0], [2, 1]]
step = [{{ increments = {{ fixed = 1 }} }}, {{ increments = {{ fixed = 2 }} }}]
"#
    )
}

const TIED: [&str; 2] = [
    "",
    r#"coupling.core.kinematic = { set = "shaft.bore", reference = "axle" }"#,
];

const FRAMED: [&str; 2] = [
    r#", rotation.with = "axle""#,
    r#"support.core = { set = "shaft.bore", x = 0, y = 0 }"#,
];

#[test]
fn a_shaft_that_turns_by_a_small_rotation_is_judged_beside_its_interference() {
    let peak = |simulation: &Simulation| {
        simulation.summary.interfaces[0]
            .pressure
            .expect("a pressure")
    };
    let rest = run(&turned_fit(0.0, TIED));
    assert!(rest.summary.quality.met);
    // It grows by R θ² / 2: at 0.04 by 16 on 10 micrometres of interference, whose approach becomes 26.
    let far = run(&turned_fit(0.04, TIED));
    trips(&far, "rotation-to-approach");
    let value = figure(&far, "rotation-to-approach").value;
    assert!((value - 16.0 / 26.0).abs() < 0.03, "{value}");
    assert!(peak(&far) > 2.4 * peak(&rest));
    assert!(run(&turned_fit(0.006, TIED)).summary.quality.met);
    let framed = run(&turned_fit(0.04, FRAMED));
    assert!(framed.summary.quality.met, "{:#?}", violated(&framed));
    assert!((peak(&framed) / peak(&rest) - 1.0).abs() < 0.01);
}

#[test]
fn a_rotation_that_is_prescribed_too_far_is_found_before_the_run() {
    let found = |text: &str| -> Vec<String> {
        let built = support::build(&support::problem(text));
        let findings = built.unwrap_or_else(|e| panic!("{e}")).check().findings;
        let large = findings.into_iter();
        large
            .filter(|f| f.cause == DoctorCause::LargeRotation)
            .map(|f| format!("{f}"))
            .collect()
    };
    let [far] = found(&turned_fit(0.04, TIED)).try_into().expect("one");
    assert!(
        far.contains("support axle turns axle and with it shaft by 0.040 rad"),
        "{far}"
    );
    assert!(
        far.contains("1.6") && far.contains("body.shaft.rotation.with = \"axle\""),
        "{far}"
    );
    assert_eq!(found(&turned_fit(0.006, TIED)), [""; 0]);
    assert_eq!(found(&turned_fit(0.4, FRAMED)), [""; 0]);
    // Beyond small rotations whatever touches.
    let loose = turned_fit(0.4, TIED).replace("radius = 20.01", "radius = 12");
    let [far] = found(&loose).try_into().expect("one");
    assert!(far.contains("quality.rotation"), "{far}");
}

#[test]
fn normals_of_the_start_that_have_turned_are_told_at_the_end() {
    // By symmetry two equal cylinders have no shear between them.
    let pressed = |kinematics: &str| {
        let half = |y: f64| {
            let radius = 8.0_f64;
            format!(
                "generate.half-disc = {{ centre = [0, {}], radius = {radius}, direction = [0, {}], size = 1.5, refine = {{ finest = 0.12, width = 0.8, growth = 1.5 }} }}, material = \"elastic\"",
                y * radius,
                -y
            )
        };
        run(&format!(
            r#"format = 1
model.space = "plane-strain"
body.lower = {{ {} }}
body.upper = {{ {} }}
material.elastic.isotropic = {{ young = 200, poisson = 0.3 }}
interface.c = {{ secondary = "upper.arc", primary = "lower.arc", friction.coulomb.mu = 0.2{kinematics} }}
support.base = {{ set = "lower.flat", x = 0, y = 0 }}
support.close = {{ set = "upper.flat", x = 0, y = -0.19 }}
step = [{{ increments = {{ fixed = 2 }} }}]
"#,
            half(-1.0),
            half(1.0)
        ))
    };
    let frozen = pressed(", kinematics.small-sliding = {}");
    let said = |simulation: &Simulation| {
        let notes = simulation.summary.notes.iter();
        notes.filter(|n| n.contains("small sliding")).count()
    };
    assert_eq!(said(&frozen), 1, "{:?}", frozen.summary.notes);
    assert_eq!(said(&pressed("")), 0);
}

#[test]
fn cells_that_cannot_keep_their_volume_are_told_before_the_run() {
    let told = |element: &str, formulation: &str, poisson: f64| {
        let text = BLOCKS
            .replace(
                "cells = [4, 4]",
                &format!("cells = [4, 4], element = \"{element}\""),
            )
            .replacen(
                "material = \"soft\"",
                &format!("material = \"soft\", formulation = \"{formulation}\""),
                1,
            )
            .replace("poisson = 0.3", &format!("poisson = {poisson}"));
        let mut simulation =
            support::build(&support::problem(&text)).unwrap_or_else(|e| panic!("{e}"));
        let findings = simulation.check().findings.into_iter();
        let of_lower = |f: &stickslip::assess::doctor::Finding| {
            f.cause == DoctorCause::Locking && f.message.contains("lower")
        };
        findings.filter(of_lower).map(|f| f.message).next()
    };
    assert!(told("quad4", "standard", 0.4999).is_some_and(|m| m.contains("too stiff")));
    // Fully integrated, quad8 is as stiff as it should be, and its pressures are not what they should be.
    assert!(told("quad8", "standard", 0.4999).is_some_and(|m| m.contains("forces are right")));
    for (element, formulation, poisson) in [
        ("quad8", "mean-dilatation", 0.4999),
        ("quad8", "reduced", 0.4999),
        ("quad8", "standard", 0.495),
        ("quad4", "mean-dilatation", 0.4999),
        ("quad4", "standard", 0.3),
    ] {
        let found = told(element, formulation, poisson);
        assert_eq!(found, None, "{element}, {formulation}, {poisson}");
    }
}

/// A belt around a quarter of a drum, as a mesh of Gmsh: `n` cells around, two through its thickness.
fn belt(n: usize) -> String {
    let mut nodes = String::new();
    let mut cells = String::new();
    let at = |i: usize, j: usize| 3 * i + j + 1;
    for i in 0..=n {
        let angle = std::f64::consts::FRAC_PI_2 * (0.5 + i as f64 / n as f64);
        for j in 0..3 {
            let r = 1.0 + 0.01 * j as f64;
            nodes += &format!("{} {} {} 0\n", at(i, j), r * angle.cos(), r * angle.sin());
        }
    }
    let mut count = 0;
    let mut cell = |text: String| {
        count += 1;
        cells += &format!("{count} {text}\n");
    };
    for i in 0..n {
        cell(format!("1 2 1 1 {} {}", at(i, 0), at(i + 1, 0)));
    }
    for (group, i) in [(2, 0), (3, n)] {
        for j in 0..2 {
            cell(format!("1 2 {group} {group} {} {}", at(i, j), at(i, j + 1)));
        }
    }
    for i in 0..n {
        for j in 0..2 {
            let [a, b] = [at(i, j), at(i, j + 1)];
            let [c, d] = [at(i + 1, j + 1), at(i + 1, j)];
            cell(format!("3 2 4 4 {a} {b} {c} {d}"));
        }
    }
    format!(
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n4\n1 1 \"inner\"\n1 2 \"pulled\"\n1 3 \"fixed\"\n2 4 \"belt\"\n$EndPhysicalNames\n$Nodes\n{}\n{nodes}$EndNodes\n$Elements\n{count}\n{cells}$EndElements\n",
        3 * (n + 1)
    )
}

/// Straight faces of a belt lie within the drum that it is wrapped around, as chords in a circle, and its forces are right all the same (Euler): what holds it is `exp(μ α)` times less.
#[test]
fn straight_faces_around_a_drum_are_no_contact_unseen() {
    let folder = support::folder("quality-belt");
    std::fs::write(folder.join("belt.msh"), belt(24)).expect("a mesh file");
    let text = r#"format = 1
model.space = "plane-strain"
body.belt = { gmsh.file = "belt.msh", material = "m" }
material.m.isotropic = { young = 1e9, poisson = 0.3 }
obstacle.drum.cylinder = { centre = [0, 0], radius = 1 }
interface.wrap = { secondary = "belt.inner", primary = "drum", friction.coulomb.mu = 0.2 }
support.hold = { set = "belt.fixed", x = 0, y = 0 }
load.pull = { set = "belt.pulled", traction.value = [707106.8, -707106.8] }
step = [{ increments.fixed = 4 }]
"#;
    let setup = support::problem(text).build(&folder).expect("sound");
    let mut simulation = Simulation::new(setup).expect("sound");
    simulation.run(&mut []).expect("it is in balance");
    let gate = &simulation.summary.quality;
    assert!(gate.met, "{:#?}", violated(&simulation));
    assert!(figure(&simulation, "undetected-approach").value < 0.05);
    let shear = simulation.summary.interfaces[0].shear_force;
    let normal = simulation.summary.interfaces[0].normal_force;
    let force = |f: [f64; 3]| f[0].hypot(f[1]);
    assert!((force(shear) / force(normal) - 0.2).abs() < 1e-3);
}

/// A mass that falls on a spring with an implicit scheme of first order at the interface loses part of its energy to the scheme in one bounce; taken at the stage it loses next to nothing.
#[test]
fn what_the_scheme_dissipates_has_a_limit() {
    let drop = |dynamic: &str| {
        run(&format!(
            r#"format = 1
model = {{ space = "plane-stress", thickness = 1 }}
body.m = {{ generate.rectangle = {{ from = [-0.5, 0], to = [0.5, 1], cells = [1, 1] }}, material = "m", rigid = true }}
material.m.isotropic = {{ young = 3e7, poisson = 0.3, density = 0.5 }}
obstacle.stop.plane = {{ point = [0, -1], normal = [0, 1] }}
interface.c = {{ secondary = "m.bottom", primary = "stop", normal.linear.c = 1973.92088 }}
load.g = {{ set = "m", gravity.acceleration = [0, -386] }}
support.x = {{ set = "m", x = 0 }}
step = [{{ name = "fall", duration = 0.14, dynamic = {dynamic}, increments = {{ initial = 0.0025, largest = 0.0025 }} }}]
"#
        ))
    };
    let lossy = drop("{ contact-at = \"end\" }");
    trips(&lossy, "scheme-dissipation");
    let found = figure(&lossy, "scheme-dissipation").value;
    assert!((found - 0.028).abs() < 0.002, "{found}");
    let good = drop("{}");
    assert!(good.summary.quality.met, "{:#?}", violated(&good));
    assert!(figure(&good, "scheme-dissipation").value < 1e-3);
}

/// Two blocks that are glued by a penalty, or held apart by a rigid stop, swing in an explicit step: springs give way, those of a stop as much as the cells beside it, and the gate says by how much. Glued by multipliers or held
/// together by equations, they open by nothing.
#[test]
fn what_springs_hold_in_an_explicit_step_has_a_limit() {
    let swing = |cells: usize, joint: &str| {
        run(&format!(
            r#"format = 1
model = {{ space = "plane-stress", thickness = 1 }}
body.a = {{ generate.rectangle = {{ to = [1, 1], cells = [{cells}, {cells}] }}, material = "m" }}
body.b = {{ generate.rectangle = {{ from = [0, 1], to = [1, 2], cells = [{cells}, {cells}] }}, material = "m" }}
material.m.isotropic = {{ young = 1e6, poisson = 0.3, density = 1 }}
{joint}
support.base = {{ set = "a.bottom", x = 0, y = 0 }}
support.guide = {{ set = "b.bottom", x = 0 }}
load.pull = {{ set = "b.top", traction.value = [0, -100] }}
step = [{{ duration = 8e-3, dynamic.scheme.central-difference = {{}} }}]
"#
        ))
    };
    let tied = "interface.tie = { secondary = \"b.bottom\", primary = \"a.top\", tied = true }";
    let penalty = tied.replace(" }", ", enforcement.penalty = {} }");
    let coupling = |kind: &str| {
        let terms = "terms = [{ set = \"b.bottom\", component = \"y\" }, { set = \"a.top\", component = \"y\", factor = -1 }]";
        format!("coupling.c.{kind} = {{ {terms} }}")
    };
    for joint in [&penalty, &coupling("gap")] {
        let coarse = swing(1, joint);
        if !joint.contains("penalty") {
            trips(&coarse, "explicit-opening");
        }
        let [few, many] =
            [4, 16].map(|cells| figure(&swing(cells, joint), "explicit-opening").value);
        let worst = figure(&coarse, "explicit-opening").value;
        assert!(
            worst > 2.0 * few && few > 2.0 * many && many > 0.0,
            "{worst} {few} {many}"
        );
    }
    for joint in [tied, &coupling("equation")] {
        let figures = swing(1, joint).run.summary.quality.figures;
        assert!(figures.iter().all(|f| f.figure != "explicit-opening"));
    }
}

/// A stiff cap that is tied to a soft block by means over its two faces: the block bulges between them. With the finer side as secondary, or a finer cap, the tie holds.
#[test]
fn a_tie_that_opens_between_its_points_has_a_limit() {
    let pressed = |cells: usize, secondary: &str, primary: &str| {
        run(&format!(
            r#"format = 1
model = {{ space = "plane-strain" }}
body.block = {{ generate.rectangle = {{ to = [2, 1], cells = [16, 8] }}, material = "soft" }}
body.cap = {{ generate.rectangle = {{ from = [0, 1], to = [2, 1.5], cells = [{cells}, 1] }}, material = "stiff" }}
material.soft.isotropic = {{ young = 1e6, poisson = 0.3 }}
material.stiff.isotropic = {{ young = 1e7, poisson = 0.3 }}
interface.tie = {{ secondary = "{secondary}", primary = "{primary}", tied = true }}
support.base = {{ set = "block.bottom", x = 0, y = 0 }}
load.push = {{ set = "cap.top", traction.value = [1e3, 0] }}
step = [{{}}]
"#
        ))
    };
    let coarse = pressed(1, "cap.bottom", "block.top");
    trips(&coarse, "tie-opening");
    let value = |s: &Simulation| figure(s, "tie-opening").value;
    let [swapped, fine] = [
        pressed(1, "block.top", "cap.bottom"),
        pressed(16, "cap.bottom", "block.top"),
    ];
    assert!(
        value(&swapped) < 1e-6 && value(&fine) < 1e-6,
        "{} {}",
        value(&swapped),
        value(&fine)
    );
    let half = pressed(4, "cap.bottom", "block.top");
    assert!(half.summary.quality.met, "{:#?}", violated(&half));
    assert!(value(&half) < 0.5 * value(&coarse), "{}", value(&half));
}

/// Units explain what is far too large. How well a contact is resolved is no question of them.
#[test]
fn units_are_blamed_for_sizes_alone() {
    let heavy = BLOCKS.replace("poisson = 0.3", "poisson = 0.3, density = 1e6");
    let simulation = run(&format!(
        "{heavy}[quality]\nundetected-approach = 1e-9\nrotation = 1e-12\n"
    ));
    let findings = &simulation.summary.findings;
    assert!(
        findings.iter().any(|f| f.cause == DoctorCause::MixedUnits),
        "{findings:?}"
    );
    for (name, blamed) in [("undetected-approach", false), ("rotation", true)] {
        let said = figure(&simulation, name).sentence(findings);
        assert_eq!(said.contains("mixed-units"), blamed, "{said}");
    }
}

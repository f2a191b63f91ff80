//! Which facet a point belongs to, on whole bodies.

use std::path::Path;

use stickslip::problem::Document;
use stickslip::run::Simulation;

/// Two half-balls that meet pole on pole, the upper one pressed down by so much, with what else the interface has.
fn balls(lower: &str, upper: &str, down: f64, joint: &str) -> Simulation {
    let text = format!(
        r#"
        format = 1
        model.space = "solid"
        body.lower = {{ generate.half-ball = {{ centre = [0, 0, -10], direction = [0, 0, 1], radius = 10, size = 5, element = "{lower}" }}, material = "steel" }}
        body.upper = {{ generate.half-ball = {{ centre = [0, 0, 10], radius = 10, size = 5, element = "{upper}" }}, material = "steel" }}
        material.steel.isotropic = {{ young = 1e5, poisson = 0.3 }}
        interface.joint = {{ secondary = "lower.arc", primary = "upper.arc", discretisation.node-to-facet = {{}}{joint} }}
        support.base = {{ set = "lower.flat", x = 0, y = 0, z = 0 }}
        support.top = {{ set = "upper.flat", x = 0, y = 0, z = -{down} }}
        step = [{{ increments = {{ initial = 0.25, largest = 0.25 }} }}]
        "#
    );
    let problem = Document::new(text, None).problem().expect("a problem");
    let model = problem.build(Path::new(".")).expect("a model");
    Simulation::new(model).expect("a simulation")
}

/// Of most nodes the nearest facets face away, and the planes of those that do not are far from them.
#[test]
fn balls_that_touch_in_one_point_do_not_overlap() {
    for lower in ["hex8", "tet4", "hex20"] {
        for upper in ["hex8", "tet4", "hex20", "tet10"] {
            let report = balls(lower, upper, 0.1, "").check();
            let gaps = &report.interfaces[0];
            let (smallest, overlapping) = (gaps.smallest, gaps.overlapping);
            assert!(smallest > -1e-6, "{lower} on {upper}: {smallest}");
            assert!(overlapping <= 1, "{lower} on {upper}: {overlapping}");
        }
    }
}

/// Behind the faces below a ball, through the ball, lies what looks back at them.
#[test]
fn faces_meet_nothing_through_their_own_body() {
    for lower in ["tet4", "hex8", "hex20"] {
        let text = format!(
            r#"
            format = 1
            model.space = "solid"
            body.lower = {{ generate.ball = {{ centre = [0, 0, -10], direction = [0, 0, 1], radius = 10, size = 5, element = "{lower}", refine = {{ finest = 1.8, width = 2, growth = 2.5 }} }}, material = "steel" }}
            body.upper = {{ generate.half-ball = {{ centre = [0, 0, 10], direction = [0, 0, -1], radius = 10, size = 5, element = "hex8", refine = {{ finest = 1.3, width = 2, growth = 2.5 }} }}, material = "steel" }}
            material.steel.isotropic = {{ young = 1e5, poisson = 0.3 }}
            interface.joint = {{ secondary = "lower.arc", primary = "upper.arc", roles = "as-named" }}
            set.cap = {{ of = "lower", box = {{ from = [-20, -20, -20], to = [20, 20, -12] }} }}
            support.base = {{ set = "cap", x = 0, y = 0, z = 0 }}
            support.top = {{ set = "upper.flat", x = 0, y = 0, z = -0.1 }}
            step = [{{ increments = {{ initial = 0.25, largest = 0.25 }} }}]
            "#
        );
        let problem = Document::new(text, None).problem().expect("a problem");
        let model = problem.build(Path::new(".")).expect("a model");
        let mut simulation = Simulation::new(model).expect("a simulation");
        let report = simulation.check();
        let smallest = report.interfaces[0].smallest;
        assert!(smallest > -0.05, "{lower}: {smallest}");
        simulation.run(&mut []).expect("equilibria");
        assert_eq!(simulation.summary.attempts.cutbacks, 0, "{lower}");
    }
}

/// A node under the pole of a ball of flat facets is as near to one of them as to the next, and held by friction it would come to lie under the other
/// wherever it was held by one: it stays on the one until its foot leaves it.
#[test]
fn a_pole_pressed_on_a_pole_comes_to_rest_on_one_of_its_facets() {
    for friction in [
        "coulomb = { mu = 0.5 }",
        "exponential-decay = { static = 0.532, kinetic = 0.323, decay = 7.97 }",
    ] {
        let joint = format!(", normal.linear = {{ c = 6e4 }}, friction.{friction}");
        let mut simulation = balls("tet4", "tet4", 0.15, &joint);
        simulation.run(&mut []).expect("equilibria");
        let summary = &simulation.summary;
        assert_eq!(summary.attempts.cutbacks, 0, "{friction}");
        assert!(
            summary.attempts.iterations <= 15 * summary.attempts.increments,
            "{friction}: {}",
            summary.attempts.iterations
        );
    }
}

/// Where the edges of two bodies lie on one another the softer one is pressed out beyond the other by its strains: its edges go on to carry what their part of the surface does.
#[test]
fn edges_that_lie_on_one_another_do_not_part_by_strains() {
    let text = r#"
        format = 1
        model.space = "plane-strain"
        body.lower = { generate.rectangle = { from = [-1, -1], to = [1, 0], cells = [4, 3] }, material = "stiff" }
        body.upper = { generate.rectangle = { from = [-1, 0], to = [1, 1], cells = [6, 4] }, material = "soft" }
        material.stiff.isotropic = { young = 1000, poisson = 0.3 }
        material.soft.isotropic = { young = 100, poisson = 0.4 }
        interface.joint = { secondary = "upper.bottom", primary = "lower.top", roles = "as-named", friction.coulomb.mu = 0.1, discretisation.node-to-facet = {} }
        support.base = { set = "lower.bottom", x = 0, y = 0 }
        support.guide = { set = "upper.top", x = 0 }
        load.press = { set = "upper.top", pressure.value = 0.2 }
        step = [{ increments.fixed = 4 }]
    "#;
    let problem = Document::new(text.to_string(), None).problem();
    let model = problem.expect("a problem").build(Path::new("."));
    let mut simulation = Simulation::new(model.expect("a model")).expect("a simulation");
    simulation.run(&mut []).expect("equilibria");
    let gate = &simulation.summary.quality;
    assert!(gate.met, "{:?}", gate.violations().next());
}

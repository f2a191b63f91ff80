//! Which facet a point belongs to, on whole bodies.

use std::path::Path;

use stickslip::problem::Document;
use stickslip::run::Simulation;

/// The gaps of two half-balls that meet pole on pole: of most nodes the nearest facets face away, and the planes of those that do not are
/// far from them.
fn balls(lower: &str, upper: &str) -> (f64, usize) {
    let text = format!(
        r#"
        format = 1
        model.space = "solid"
        body.lower = {{ generate.half-ball = {{ centre = [0, 0, -10], direction = [0, 0, 1], radius = 10, size = 5, element = "{lower}" }}, material = "steel" }}
        body.upper = {{ generate.half-ball = {{ centre = [0, 0, 10], radius = 10, size = 5, element = "{upper}" }}, material = "steel" }}
        material.steel.isotropic = {{ young = 1e5, poisson = 0.3 }}
        interface.joint = {{ secondary = "lower.arc", primary = "upper.arc", discretisation.node-to-facet = {{}} }}
        support.base = {{ set = "lower.flat", x = 0, y = 0, z = 0 }}
        support.top = {{ set = "upper.flat", x = 0, y = 0, z = -0.1 }}
        step = [{{}}]
        "#
    );
    let problem = Document::new(text, None).problem().expect("a problem");
    let model = problem.build(Path::new(".")).expect("a model");
    let report = Simulation::new(model).expect("a simulation").check();
    (
        report.interfaces[0].smallest,
        report.interfaces[0].overlapping,
    )
}

#[test]
fn balls_that_touch_in_one_point_do_not_overlap() {
    for lower in ["hex8", "tet4", "hex20"] {
        for upper in ["hex8", "tet4", "hex20", "tet10"] {
            let (smallest, overlapping) = balls(lower, upper);
            assert!(smallest > -1e-6, "{lower} on {upper}: {smallest}");
            assert!(overlapping <= 1, "{lower} on {upper}: {overlapping}");
        }
    }
}

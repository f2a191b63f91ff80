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

/// One side of a layer moves like the other, and both are pressed on a plane: only the sum of what contact carries there is determined. That takes no more iterations than
/// without the equations, and both have the same.
#[test]
fn an_equation_between_points_in_contact_costs_no_iterations() {
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
        let [alone, tied] = [false, true].map(|equations| record(&layer(equations)));
        let [alone, tied] = [iterations(&alone), iterations(&tied)];
        assert!(tied[0] <= alone[0] + 2, "{element}: {alone:?} and {tied:?}");
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
    assert!(iterations(&record)[0] <= 6, "{:?}", iterations(&record));
    assert_eq!(record.cutbacks, 0);
}

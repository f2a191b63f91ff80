//! Contact and ties that run into clamps, follow something else, or hang over an edge: what an interface carries is what loads bring, and its pressure is that of meshes
//! that match.

use crate::support::{self, problem, run};

fn end(text: &str) -> support::Row {
    let record = run(&problem(text)).unwrap_or_else(|e| panic!("{e}\n{text}"));
    record.increments.last().expect("a row").1.clone()
}

fn value(row: &support::Row, name: &str) -> f64 {
    row.get(name).unwrap_or_else(|| panic!("no column {name}"))
}

/// Two leaves one upon the other that are clamped over `clamp` at the same end, a pressure on the upper one.
fn leaves(solid: bool, cells: [usize; 2], clamp: f64, interface: &str) -> String {
    let [low, up] = cells;
    let (space, shape, load) = match solid {
        true => ("solid", "box", "top"),
        false => ("plane-strain", "rectangle", "top"),
    };
    let body = |z: f64, n: usize| match solid {
        true => format!(
            "from = [0, 0, {z}], to = [0.1, 0.02, {}], cells = [{n}, 2, 2]",
            z + 0.01
        ),
        false => format!(
            "from = [0, {z}], to = [0.1, {}], cells = [{n}, 2]",
            z + 0.01
        ),
    };
    let (held, low_corner, high_corner) = match solid {
        true => ("x = 0, y = 0, z = 0", "-1, -1, -1", "1, 1"),
        false => ("x = 0, y = 0", "-1, -1", "1"),
    };
    let reach = format!("from = [{low_corner}], to = [{clamp}, {high_corner}]");
    format!(
        "format = 1\nmodel.space = \"{space}\"\n\
         material.m.isotropic = {{ young = 2e11, poisson = 0.3 }}\n\
         body.low = {{ generate.{shape} = {{ {} }}, material = \"m\" }}\n\
         body.up = {{ generate.{shape} = {{ {} }}, material = \"m\" }}\n\
         interface.c = {{ secondary = \"up.bottom\", primary = \"low.top\", {interface} }}\n\
         set.a = {{ of = \"low\", box = {{ {reach} }} }}\n\
         set.b = {{ of = \"up\", box = {{ {reach} }} }}\n\
         support.a = {{ set = \"a\", {held} }}\n\
         support.b = {{ set = \"b\", {held} }}\n\
         load.p = {{ set = \"up.{load}\", pressure.value = 1000 }}\n\
         step = [{{ name = \"press\" }}]\n",
        body(0.0, low),
        body(0.01, up)
    )
}

/// Contact force and reactions of meshes that do not match are those of meshes that do.
#[test]
fn surfaces_that_run_into_a_common_clamp_carry_what_loads_bring() {
    for (solid, axis) in [(false, 2), (true, 3)] {
        // Points against facets pass on a constant pressure to 5 to 20 % only.
        for (interface, within) in [
            ("friction.coulomb = { mu = 0.3 }", 0.08),
            ("tied = true", 0.08),
            ("discretisation.node-to-facet = {}", 0.13),
        ] {
            // Over a length that ends at nodes of both meshes: otherwise one leaf is clamped to another place than the other.
            let at_end: &[[usize; 2]] = &[[20, 18], [20, 19], [20, 21], [8, 7]];
            let over_a_length: &[[usize; 2]] = &[[20, 16], [20, 24], [16, 20]];
            for (clamp, all) in [(1e-6, at_end), (0.025 + 1e-6, over_a_length)] {
                let of = |cells| {
                    let row = end(&leaves(solid, cells, clamp, interface));
                    ["a.RF", "b.RF"].map(|name| value(&row, &format!("{name}{axis}")))
                };
                let matching = of([20, 20]);
                for &cells in all {
                    let found = of(cells);
                    let load = 1000.0 * 0.1 * if solid { 0.02 } else { 1.0 };
                    for (found, right) in found.iter().zip(matching) {
                        assert!(
                            (found - right).abs() < within * load,
                            "solid {solid}, {interface}, clamped to {clamp}, {cells:?}: {found} for {right}"
                        );
                    }
                }
            }
        }
    }
}

/// A plate of `cells` cells of equal length over a block that ends under the share `part` of one of them, `beyond` cells before the end of the plate.
fn overhang(cells: usize, part: f64, beyond: usize) -> String {
    let h = 0.02 / (cells as f64 + part);
    let n = cells + beyond + usize::from(part > 0.0);
    format!(
        "format = 1\nmodel.space = \"plane-strain\"\n\
         material.m.isotropic = {{ young = 2e11, poisson = 0.3 }}\n\
         body.plate = {{ generate.rectangle = {{ from = [0, 0.02], to = [{}, 0.03], cells = [{n}, 8] }}, material = \"m\" }}\n\
         body.block = {{ generate.rectangle = {{ to = [0.02, 0.02], cells = [{}, 16] }}, material = \"m\" }}\n\
         interface.c = {{ secondary = \"plate.bottom\", primary = \"block.top\", friction.coulomb = {{ mu = 0.2 }}, roles = \"as-named\" }}\n\
         support.s = {{ set = \"plate.left\", x = 0 }}\n\
         support.s2 = {{ set = \"block.left\", x = 0 }}\n\
         support.b = {{ set = \"block.bottom\", y = 0 }}\n\
         support.p = {{ set = \"plate.top\", y = -1e-5 }}\n\
         step = [{{ name = \"press\" }}]\n",
        h * n as f64,
        cells + 1
    )
}

/// The largest pressure does not grow as the part of a face that has the primary opposite shrinks, and lies at the end of the block.
#[test]
fn pressure_is_finite_where_a_face_hangs_over_an_edge() {
    for (cells, beyond) in [(4, 2), (9, 3)] {
        let matching = end(&overhang(cells, 0.0, beyond));
        let right = value(&matching, "c.CPRESSMAX");
        for part in [0.001, 0.02, 0.2, 0.5, 0.75, 0.85, 0.95] {
            let row = end(&overhang(cells, part, beyond));
            let found = value(&row, "c.CPRESSMAX");
            assert!(
                found < 1.25 * right && found > 0.65 * right,
                "{cells} cells and {part} of one: {found:e} for {right:e}"
            );
        }
    }
}

/// Two layers with a period, of which the upper one slides to either side: where points meet facets, that end of the period carries which lies over the primary.
#[test]
fn the_end_of_a_period_that_is_over_the_primary_carries() {
    let equations = periodic();
    for friction in [
        "",
        "friction.coulomb.mu = 0.2, ",
        "wear.archard = { coefficient = 1e-12 }, ",
    ] {
        let [right, left] = [0.02, -0.02].map(|way| {
            end(&format!(
                "format = 1\nmodel.space = \"plane-strain\"\n\
                 material.m.isotropic = {{ young = 1.2e7, poisson = 0.2 }}\n\
                 body.low = {{ generate.rectangle = {{ from = [0, -2], to = [6, 0], cells = [6, 2] }}, material = \"m\" }}\n\
                 body.up = {{ generate.rectangle = {{ to = [6, 3], cells = [6, 5] }}, material = \"m\" }}\n\
                 interface.c = {{ secondary = \"up.bottom\", primary = \"low.top\", {friction}roles = \"as-named\", discretisation.node-to-facet = {{}} }}\n\
                 support.base = {{ set = \"low.bottom\", x = 0, y = 0 }}\n\
                 amplitude.slide.table = [[0, 0], [1, 0], [2, 1]]\n\
                 support.slide = {{ set = \"up.top\", x = {way}, amplitude = \"slide\" }}\n\
                 load.p = {{ set = \"up.top\", pressure.value = 1.5e4 }}\n{equations}\
                 step = [{{ increments.fixed = 1 }}, {{ increments.fixed = 2 }}]\n"
            ))
        });
        let names = ["c.CFN2", "c.CAREA", "c.CPRESSMAX"];
        let [one, other] = [&right, &left].map(|row| names.map(|name| value(row, name)));
        for (a, b) in one.iter().zip(&other) {
            assert!((a - b).abs() < 1e-6 * a, "{friction}{one:?} {other:?}");
        }
        assert!(
            (one[0] - 9e4).abs() < 1.0 && (one[1] - 6.0).abs() < 1e-9,
            "{friction}{one:?}"
        );
        assert!((one[2] / 1.5e4 - 1.0).abs() < 0.05, "{friction}{one:?}");
    }
}

/// Two layers with a period that rub: the nodes at its ends, of which one has the multiplier of both or another that of both, are worn like all others.
#[test]
fn ends_of_a_period_wear_like_the_rest() {
    let equations = periodic();
    for met in ["mortar", "node-to-facet"] {
        let row = end(&format!(
            "format = 1\nmodel.space = \"plane-strain\"\n\
             material.m.isotropic = {{ young = 1.2e7, poisson = 0.2 }}\n\
             body.low = {{ generate.rectangle = {{ from = [0, -2], to = [6, 0], cells = [6, 2] }}, material = \"m\" }}\n\
             body.up = {{ generate.rectangle = {{ to = [6, 3], cells = [6, 5] }}, material = \"m\" }}\n\
             interface.c = {{ secondary = \"up.bottom\", primary = \"low.top\", friction.coulomb.mu = 0.2, wear.archard.coefficient = 1e-9, roles = \"as-named\", discretisation.{met} = {{}} }}\n\
             support.base = {{ set = \"low.bottom\", x = 0, y = 0 }}\n\
             amplitude.slide.table = [[0, 0], [1, 0], [2, 1]]\n\
             support.slide = {{ set = \"up.top\", x = 0.01, amplitude = \"slide\" }}\n\
             load.p = {{ set = \"up.top\", pressure.value = 1.5e4 }}\n{equations}\
             step = [{{ increments.fixed = 1 }}, {{ increments.fixed = 4 }}]\n"
        ));
        let [most, volume] = ["c.CWEARMAX", "c.CWEARVOL"].map(|name| value(&row, name));
        assert!(
            (most * 6.0 / volume - 1.0).abs() < 0.03,
            "{met}: {most:e} of a mean of {:e}",
            volume / 6.0
        );
    }
}

/// What follows a reference point that supports hold is held: a wall beside it has nothing to keep out, be the body rigid or elastic at the points that follow.
#[test]
fn a_wall_beside_what_follows_a_held_reference_point_carries_nothing() {
    for rigid in [true, false] {
        let row = end(&format!(
            r#"format = 1
model.space = "plane-stress"
body.low = {{ generate.rectangle = {{ from = [-3, -4], to = [3, 0], cells = [8, 5] }}, material = "m" }}
body.up = {{ generate.rectangle = {{ from = [-3, 0], to = [3, 2], cells = [10, 2] }}, material = "m", rigid = {rigid} }}
material.m.isotropic = {{ young = 2e4, poisson = 0.15, density = 1 }}
obstacle.wall.plane = {{ point = [3, 0], normal = [-1, 0] }}
reference.head.point = [0, 2]
coupling.head.kinematic = {{ reference = "head", set = "up.top" }}
interface.joint = {{ secondary = "up.bottom", primary = "low.top", friction.coulomb.mu = 0.6, slip.regularised.epsilon = 0.06, primary-velocity = [1.1, 0] }}
interface.wall = {{ secondary = "up.right", primary = "wall", friction.coulomb.mu = 0.6, slip.regularised.epsilon = 0.06 }}
support.base = {{ set = "low.bottom", x = 0, y = 0 }}
support.head = {{ set = "head", x = 0, y = -0.03, rotation-z = 0 }}
step = [{{ increments.fixed = 2 }}]
"#
        ));
        let [normal, support] = ["joint.CFN2", "head.RF2"].map(|name| value(&row, name));
        let shear = value(&row, "wall.CFS2") + value(&row, "joint.CFS2");
        let off = normal + shear + support;
        assert!(
            normal > 1.0 && off.abs() < 1e-6 * normal,
            "{rigid}: {normal} {shear} {support}"
        );
        let beside = value(&row, "wall.CFN1").abs();
        assert!(!rigid || beside == 0.0, "{beside}");
    }
}

/// A block on an obstacle that a support holds inside it at a corner: no force parts the two there, and none is made up.
#[test]
fn a_corner_that_is_clamped_inside_an_obstacle_carries_nothing() {
    let block = |raised: f64| {
        format!(
            "format = 1\nmodel.space = \"plane-strain\"\n\
             material.m.isotropic = {{ young = 1e7, poisson = 0.3 }}\n\
             body.b = {{ generate.rectangle = {{ to = [3, 1], cells = [12, 4] }}, material = \"m\" }}\n\
             obstacle.floor.plane = {{ point = [0, {raised}], normal = [0, 1] }}\n\
             interface.c = {{ secondary = \"b.bottom\", primary = \"floor\", initial = \"ramp\", friction.coulomb.mu = 0.3 }}\n\
             support.clamp = {{ set = \"b.right\", x = 0, y = 0 }}\n\
             load.p = {{ set = \"b.top\", pressure.value = 1e4 }}\n\
             quality.gate = \"warn\"\nstep = [{{}}]\n"
        )
    };
    let [flush, inside] = [0.0, 1e-4].map(|raised| end(&block(raised)));
    // Lifted by a ten-thousandth of its height the block bends at the clamp: far less than a force that would part the corner from the floor.
    let lift = 0.5 * 1e7 * 1e-4;
    for (row, more) in [(&flush, 0.0), (&inside, lift)] {
        let carried = value(row, "c.CFN2");
        assert!((0.0..3e4 + 3.0 * more).contains(&carried), "{carried}");
        let sum = carried + value(row, "clamp.RF2");
        assert!((sum - 3e4).abs() < 1e-4 * 3e4, "{sum}");
    }
    assert!(value(&inside, "c.CPRESSMAX") < 10.0 * value(&flush, "c.CPRESSMAX"));
}

/// Equations by which both ends of the bodies `low` and `up` move alike.
fn periodic() -> String {
    let equation = |(body, c): (&str, &str)| {
        format!(
            "coupling.{body}-{c}.equation.terms = [{{ set = \"{body}.left\", component = \"{c}\" }}, {{ set = \"{body}.right\", component = \"{c}\", factor = -1 }}]\n"
        )
    };
    let all = [("low", "x"), ("low", "y"), ("up", "x"), ("up", "y")];
    all.into_iter().map(equation).collect()
}

/// Two layers with a period, the upper one slid aside by a part of a cell: the ends of a period are one place, with one multiplier.
#[test]
fn ends_of_a_period_take_no_more_iterations_than_ends_that_are_free() {
    let layers = |tied: bool, met: &str| {
        let equations = periodic();
        format!(
            "format = 1\nmodel.space = \"plane-strain\"\n\
             material.m.isotropic = {{ young = 1.2e7, poisson = 0.2 }}\n\
             body.low = {{ generate.rectangle = {{ from = [0, -2], to = [6, 0], cells = [6, 2] }}, material = \"m\" }}\n\
             body.up = {{ generate.rectangle = {{ to = [6, 3], cells = [7, 5] }}, material = \"m\" }}\n\
             interface.c = {{ secondary = \"up.bottom\", primary = \"low.top\", friction.coulomb.mu = 0.17, roles = \"as-named\", discretisation.{met} = {{}} }}\n\
             support.base = {{ set = \"low.bottom\", x = 0, y = 0 }}\n\
             reference.head = {{ point = [3, 3] }}\n\
             coupling.head.kinematic = {{ reference = \"head\", set = \"up.top\" }}\n\
             support.head = {{ set = \"head\", x = 0.0176, rotation-z = 0 }}\n\
             load.p = {{ set = \"head\", nodal-force.value = [0, -9e4] }}\n{}step = [{{ increments.fixed = 1 }}]\n",
            if tied { &equations } else { "" }
        )
    };
    for met in ["mortar", "node-to-facet"] {
        let [free, periodic] = [false, true].map(|tied| {
            let record = run(&problem(&layers(tied, met))).unwrap_or_else(|e| panic!("{met}: {e}"));
            record.increments.last().expect("a row").1.clone()
        });
        let [least, most] = [&free, &periodic].map(|row| value(row, "ITRS"));
        assert!(
            most <= least + 2.0,
            "{met}: {most} iterations, {least} without"
        );
        assert!((value(&periodic, "c.CFN2") - 9e4).abs() < 1.0);
        // With a period nothing depends on the place along it, but that meshes do not match.
        let mean = 9e4 / 6.0;
        let most = value(&periodic, "c.CPRESSMAX") / mean;
        assert!((most - 1.0).abs() < 0.05, "{met}: {most}");
    }
}

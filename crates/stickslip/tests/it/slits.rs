//! A slit: two faces of one body that meet at its tips.

use crate::support;
use std::fmt::Write;
use std::path::Path;
use stickslip::contact::look;

use stickslip::problem::{Document, Problem};
use stickslip::run::Simulation;

/// Places of nodes along the slit, symmetric about zero: cells grow from the size `tip` at its tips, at `x = ±1`, both ways.
fn places(tip: f64, growth: f64, end: f64) -> Vec<f64> {
    let mut steps: Vec<f64> = Vec::new();
    let mut step = tip;
    while steps.iter().sum::<f64>() < 1.0 {
        steps.push(step.min(0.1));
        step *= growth;
    }
    let total: f64 = steps.iter().sum();
    let mut half: Vec<f64> = Vec::new();
    for step in steps.iter().rev() {
        half.push(half.last().copied().unwrap_or(0.0) + step / total);
    }
    half.pop();
    half.push(1.0);
    half.extend(away(tip, growth, end - 1.0).iter().map(|d| 1.0 + d));
    mirrored(&half)
}

/// Distances of nodes from where cells of the size `tip` begin to grow.
fn away(tip: f64, growth: f64, end: f64) -> Vec<f64> {
    let mut out = vec![tip];
    let mut step = tip;
    while out[out.len() - 1] < end {
        step *= growth;
        out.push(out[out.len() - 1] + step);
    }
    out
}

fn mirrored(half: &[f64]) -> Vec<f64> {
    let below = half.iter().rev().map(|x| -x);
    below.chain([0.0]).chain(half.iter().copied()).collect()
}

/// A plate of quadrilaterals with a slit along `y = 0`, `|x| < 1`, the tips of which belong to both faces: the file, and half of the plate along both axes.
fn plate(tip: f64, growth: f64, end: f64) -> (String, [f64; 2]) {
    let x = places(tip, growth, end);
    let y = mirrored(&away(tip, growth, end));
    let (nx, ny) = (x.len(), y.len());
    let middle = ny / 2;
    let within: Vec<usize> = (0..nx).filter(|&i| x[i].abs() < 1.0 - 1e-9).collect();
    let mut nodes = String::new();
    for (j, y) in y.iter().enumerate() {
        for (i, x) in x.iter().enumerate() {
            writeln!(nodes, "{} {x:?} {y:?} 0", j * nx + i + 1).unwrap();
        }
    }
    let doubled = |i: usize| nx * ny + (i - within[0]) + 1;
    for &i in &within {
        writeln!(nodes, "{} {:?} 0 0", doubled(i), x[i]).unwrap();
    }
    // The cells below the slit have the doubled nodes.
    let below = |i: usize| match within.contains(&i) {
        true => doubled(i),
        false => middle * nx + i + 1,
    };
    let at = |i: usize, j: usize| j * nx + i + 1;
    let mut cells = Vec::new();
    for j in 0..ny - 1 {
        for i in 0..nx - 1 {
            let upper = |i: usize| {
                if j + 1 == middle {
                    below(i)
                } else {
                    at(i, j + 1)
                }
            };
            let corners = [at(i, j), at(i + 1, j), upper(i + 1), upper(i)];
            cells.push(format!(
                "3 2 1 1 {} {} {} {}",
                corners[0], corners[1], corners[2], corners[3]
            ));
        }
    }
    let first = within[0] - 1;
    for i in first..=within[within.len() - 1] {
        cells.push(format!("1 2 2 2 {} {}", at(i, middle), at(i + 1, middle)));
        cells.push(format!("1 2 3 3 {} {}", below(i), below(i + 1)));
    }
    let mut text = format!(
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n3\n2 1 \"all\"\n1 2 \"upper\"\n1 3 \"lower\"\n$EndPhysicalNames\n$Nodes\n{}\n{nodes}$EndNodes\n$Elements\n{}\n",
        nx * ny + within.len(),
        cells.len()
    );
    for (k, cell) in cells.iter().enumerate() {
        writeln!(text, "{} {cell}", k + 1).unwrap();
    }
    (text + "$EndElements\n", [x[nx - 1], y[ny - 1]])
}

/// Compression of 100 MPa at 20 degrees to the slit.
const ANGLE: f64 = 20.0;
const STRESS: f64 = 100e6;

/// A closed slit in a plate under compression; `rest` says how contact is found.
fn compressed(folder: &Path, rest: &str) -> Simulation {
    let (mesh, [w, h]) = plate(0.01, 1.3, 16.0);
    std::fs::write(folder.join("plate.msh"), mesh).expect("a mesh");
    let (s, c) = ANGLE.to_radians().sin_cos();
    let [xx, yy, xy] = [c * c, s * s, s * c].map(|part| -STRESS * part);
    let mut text = format!(
        r#"
format = 1
model.space = "plane-strain"
body.plate = {{ gmsh = {{ file = "plate.msh" }}, material = "rock", formulation = "incompatible-modes" }}
material.rock.isotropic = {{ young = 25e9, poisson = 0.25 }}
interface.slit = {{ secondary = "plate.upper", primary = "plate.lower", friction.coulomb.mu = 0.5773502691896258, {rest} }}
set.corner = {{ of = "plate", point = [-{w:?}, -{h:?}] }}
set.other = {{ of = "plate", point = [{w:?}, -{h:?}] }}
support.corner = {{ set = "corner", x = 0, y = 0 }}
support.other = {{ set = "other", y = 0 }}
step = [{{ increments.fixed = 1 }}]
"#
    );
    for (name, from, to, [tx, ty]) in [
        ("right", [w, -h], [w, h], [xx, xy]),
        ("left", [-w, -h], [-w, h], [-xx, -xy]),
        ("top", [-w, h], [w, h], [xy, yy]),
        ("bottom", [-w, -h], [w, -h], [-xy, -yy]),
    ] {
        writeln!(
            text,
            "set.{name} = {{ of = \"plate\", box = {{ from = {from:?}, to = {to:?} }} }}\n\
             load.{name} = {{ set = \"{name}\", traction.value = [{tx:?}, {ty:?}] }}"
        )
        .unwrap();
    }
    let problem = Problem::from_toml(&text, None).unwrap_or_else(|e| panic!("{e}"));
    let model = problem.build(folder).unwrap_or_else(|e| panic!("{e}"));
    let mut simulation = Simulation::new(model).unwrap_or_else(|e| panic!("{e}"));
    simulation.run(&mut []).unwrap_or_else(|e| panic!("{e}"));
    simulation
}

/// The faces of a slit under compression slide as the formula for an infinite plate says, `4 (1 - ν²) / E (τ - μ p) √(a² - x²)`, and press as if there were no slit.
#[test]
fn the_faces_of_a_closed_slit_slide_as_in_an_infinite_plate() {
    let folder = support::folder("slit");
    for rest in ["", "discretisation.node-to-facet = {}"] {
        let simulation = compressed(&folder, rest);
        let (s, c) = ANGLE.to_radians().sin_cos();
        let pressure = STRESS * s * s;
        let driving = STRESS * s * c - pressure / 3.0_f64.sqrt();
        let interface = support::contact(&simulation);
        let state = &simulation.frame;
        let sheet = look::sheet(interface, &state.state.u, state.state.t);
        let field = |name: &str| {
            let found = sheet.fields.all.iter().find(|f| f.name == name);
            &found.unwrap_or_else(|| panic!("no field {name}")).values
        };
        let mut seen = 0;
        for (k, x) in sheet.points.iter().enumerate() {
            // Next to a tip a cell says little of a root.
            if x[0].abs() > 0.8 {
                continue;
            }
            seen += 1;
            let slip = 4.0 * (1.0 - 0.25 * 0.25) / 25e9 * driving * (1.0 - x[0] * x[0]).sqrt();
            let found = field("CSLIP1")[k].abs();
            assert!(
                (found / slip - 1.0).abs() < 0.01,
                "{rest} {x:?}: {found:e} of {slip:e}"
            );
            let found = field("CPRESS")[k];
            assert!(
                (found / pressure - 1.0).abs() < 0.01,
                "{rest} {x:?}: {found:e} of {pressure:e}"
            );
        }
        assert!(seen > 15, "{seen} points");
    }
}

/// Two surfaces that share more than tips are refused as before.
#[test]
fn surfaces_with_common_points_that_are_no_tips_are_refused() {
    let text = r#"
format = 1
model.space = "plane-strain"
body.block = { generate.rectangle = { to = [1, 1], cells = [2, 2] }, material = "m" }
material.m.isotropic = { young = 1.0, poisson = 0.3 }
set.both = { union = ["block.bottom", "block.left"] }
interface.i = { secondary = "block.bottom", primary = "both" }
support.top = { set = "block.top", x = 0, y = 0 }
step = [{}]
"#;
    let document = Document::new(text, None);
    let problem = document.problem().unwrap_or_else(|e| panic!("{e}"));
    let Err(error) = problem.build(Path::new(".")) else {
        panic!("no complaint");
    };
    let said = error.to_string();
    assert!(
        said.contains("primary and secondary share points"),
        "{said}"
    );
}

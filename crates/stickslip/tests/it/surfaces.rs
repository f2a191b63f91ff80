//! The surfaces of interfaces as files: what stands on them is what the tables and the history say.

use crate::support;
use crate::support::{build, folder, problem};
use stickslip::contact::look;
use stickslip::io::vtu::Grid;
use stickslip::io::{csv, pvd, vtu};
use stickslip::results::ResultFiles;

/// Two blocks pressed without friction, meshes that do not match; a block on a floor; with linear and quadratic cells.
fn case(space: &str, order: usize, floor: bool) -> String {
    let (kind, up, [base, block], out) = match space {
        "solid" => (
            "box",
            "z",
            [
                "to = [2, 1, 1], cells = [3, 2, 1]",
                "from = [0, 0, 1], to = [2, 1, 2], cells = [2, 1, 1]",
            ],
            "y = 0, ",
        ),
        _ => (
            "rectangle",
            "y",
            [
                "to = [2, 1], cells = [3, 1]",
                "from = [0, 1], to = [2, 2], cells = [2, 1]",
            ],
            "",
        ),
    };
    let element = match (space, order) {
        (_, 1) => "",
        ("solid", _) => ", element = \"hex20\"",
        _ => ", element = \"quad8\"",
    };
    let (normal, primary) = match (floor, space) {
        (false, _) => ("", "base.top"),
        (true, "solid") => ("point = [0, 0, 1], normal = [0, 0, 1]", "floor"),
        (true, _) => ("point = [0, 1], normal = [0, 1]", "floor"),
    };
    let mut text = format!(
        "format = 1\nmodel.space = \"{space}\"\n\
         body.block = {{ generate.{kind} = {{ {block}{element} }}, material = \"m\" }}\n\
         material.m.isotropic = {{ young = 1e9, poisson = 0.0 }}\n\
         interface.joint = {{ secondary = \"block.bottom\", primary = \"{primary}\", roles = \"as-named\" }}\n\
         support.top = {{ set = \"block.top\", x = 0, {out}{up} = -1e-3 }}\n\
         step = [{{ duration = 1, increments = {{ fixed = 2 }} }}]\n"
    );
    text += &match floor {
        true => format!("obstacle.floor.plane = {{ {normal} }}\n"),
        false => format!(
            "body.base = {{ generate.{kind} = {{ {base}{element} }}, material = \"m\" }}\n\
             support.base = {{ set = \"base.bottom\", x = 0, {out}{up} = 0 }}\n"
        ),
    };
    text
}

fn difference(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|c| a[c] - b[c])
}

/// The integral of a field over lines or flat faces, with its mean at the corners of each.
fn integral(grid: &Grid, name: &str) -> f64 {
    let values = &grid.points.arrays[name].values;
    let size = |v: [f64; 3]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
    let cross = |a: [f64; 3], b: [f64; 3]| {
        [0, 1, 2].map(|c| a[(c + 1) % 3] * b[(c + 2) % 3] - a[(c + 2) % 3] * b[(c + 1) % 3])
    };
    let of = |i: usize| {
        let cell = grid.cell(i);
        let x: Vec<[f64; 3]> = cell.iter().map(|&p| grid.points.points[p]).collect();
        let area = match x.as_slice() {
            [a, b] => size(difference(*b, *a)),
            [a, b, c] => size(cross(difference(*b, *a), difference(*c, *a))) / 2.0,
            [a, b, c, d] => size(cross(difference(*c, *a), difference(*d, *b))) / 2.0,
            _ => panic!("{cell:?}"),
        };
        area * cell.iter().map(|&p| values[p]).sum::<f64>() / cell.len() as f64
    };
    (0..grid.types.len()).map(of).sum()
}

#[test]
fn surfaces_carry_what_the_history_and_the_tables_say() {
    for (space, order, floor, cells) in [
        ("solid", 1, false, 2),
        ("solid", 2, false, 10),
        ("solid", 2, true, 10),
        ("plane-strain", 1, false, 2),
        ("plane-strain", 2, false, 4),
        ("plane-strain", 2, true, 4),
    ] {
        let name = format!("surfaces-{space}-{order}-{floor}");
        let folder = folder(&name);
        let mut simulation = build(&problem(&case(space, order, floor))).unwrap();
        let mut files = ResultFiles::new(&folder, &Default::default()).unwrap();
        simulation.run(&mut [&mut files]).unwrap();
        let listed = pvd::read_parts(&folder.join("interfaces.pvd")).unwrap();
        let times = pvd::read(&folder.join("fields.pvd")).unwrap();
        assert_eq!(listed.len(), times.len());
        let history = csv::read(&folder.join("history.csv")).unwrap();
        let force = if space == "solid" {
            "joint.CFN3"
        } else {
            "joint.CFN2"
        };
        for (part, (time, _)) in listed.iter().zip(&times) {
            assert_eq!((part.name.as_str(), part.time), ("joint", *time));
            let grid = vtu::read_surface(&folder.join(&part.file)).unwrap();
            let arrays = &grid.points.arrays;
            assert_eq!(grid.types.len(), cells, "{name}");
            let row = history
                .column("TIME")
                .unwrap()
                .iter()
                .position(|t| t == time);
            let wanted = history.column(force).unwrap()[row.unwrap()];
            let found = integral(&grid, "CPRESS");
            assert!(
                (found - wanted).abs() < 1e-6 * wanted.abs(),
                "{name}: {found} {wanted}"
            );
            let count = grid.points.points.len();
            for i in 0..count {
                let v = |name: &str| [0, 1, 2].map(|c| arrays[name].values[3 * i + c]);
                let (n, t) = (v("CNORMAL"), v("CTRACTION"));
                let along: f64 = (0..3).map(|c| n[c] * t[c]).sum();
                let pressure = arrays["CPRESS"].values[i];
                assert!((along - pressure).abs() < 1e-9 * pressure.abs(), "{name}");
                // Half of what the top goes down is left at the joint of two blocks, nothing at a floor; both sides touch.
                let up = if space == "solid" { 2 } else { 1 };
                assert!(v("UREL")[up].abs() < 1e-9, "{name}: {:?}", v("UREL"));
                assert!(arrays["CSTATUS"].values[i] > 0.0);
            }
        }
        if !floor {
            // A row of the table is a point of the surface.
            let table = csv::read(&folder.join("interfaces/joint.csv")).unwrap();
            let last = vtu::read_surface(&folder.join(&listed.last().unwrap().file)).unwrap();
            for name in ["CPRESS", "COPEN", "CSTATUS"] {
                let values = &last.points.arrays[name].values;
                assert_eq!(table.column(name).unwrap(), values, "{name}");
            }
        }
    }
}

#[test]
fn tied_surfaces_show_tractions_and_are_in_no_count_of_contact() {
    let text = r#"format = 1
model.space = "plane-strain"
body.low = { generate.rectangle = { to = [2, 1], cells = [4, 2] }, material = "m" }
body.up = { generate.rectangle = { from = [0, 1], to = [2, 2], cells = [3, 2] }, material = "m" }
material.m.isotropic = { young = 1e3, poisson = 0 }
interface.glue = { secondary = "up.bottom", primary = "low.top", tied = true }
support.base = { set = "low.bottom", x = 0, y = 0 }
load.pull = { set = "up.top", traction.value = [0, 7] }
step = [{}]
"#;
    let mut simulation = build(&problem(text)).unwrap_or_else(|e| panic!("{e}"));
    simulation.run(&mut []).unwrap_or_else(|e| panic!("{e}"));
    let interface = support::contact(&simulation);
    let frame = &simulation.frame.state;
    let sheet = look::sheet(interface, &frame.u, frame.t);
    let names: Vec<&str> = sheet.fields.all.iter().map(|f| f.name.as_str()).collect();
    assert!(
        !names.iter().any(|n| n.starts_with('C') && *n != "CNORMAL"),
        "{names:?}"
    );
    let all = stickslip::results::fields(&simulation.view());
    assert!(
        all.all
            .iter()
            .all(|f| !["CPRESS", "CSTATUS", "COPEN"].contains(&f.name.as_str()))
    );
    let of = |fields: &[stickslip::system::Field]| {
        let field = fields
            .iter()
            .find(|f| f.name == "TNORMAL")
            .expect("tractions");
        let known: Vec<f64> = field
            .values
            .iter()
            .copied()
            .filter(|v| !v.is_nan())
            .collect();
        assert!(
            known.len() >= 4 && known.iter().all(|v| (v - 7.0).abs() < 1e-6),
            "{known:?}"
        );
    };
    of(&sheet.fields.all);
    of(&all.all);
    let summary = &simulation.summary.interfaces[0];
    assert!(summary.tied && summary.pressure.is_none() && summary.points.is_none());
    assert!(summary.traction.is_some_and(|t| (t - 7.0).abs() < 1e-6));
    let last = &simulation.summary.last;
    assert_eq!([last["OPEN"], last["STICK"], last["SLIP"]], [0.0; 3]);
    assert!((last["glue.TMAX"] - 7.0).abs() < 1e-6 && !last.contains_key("glue.CPRESSMAX"));
}

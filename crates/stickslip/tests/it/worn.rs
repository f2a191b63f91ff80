//! Surfaces that begin as an earlier run has worn them: its depths as geometry.

use crate::support;
use std::path::Path;
use stickslip::io::pvd;
use stickslip::problem::Problem;
use stickslip::results::{ResultFiles, fields};
use stickslip::run::Simulation;
use stickslip_mechanics::mesh::geometry;

/// The example `fretting-wear` over some of its cycles, fifty at a time, after runs that have worn it.
fn case(cycles: usize, worn: &[String]) -> String {
    let text = include_str!("../../../../examples/fretting-wear/case.toml");
    let replaced = |text: String, from: &str, to: &str| {
        assert!(text.contains(from), "{from}");
        text.replace(from, to)
    };
    let text = replaced(
        text.into(),
        "cycles = { count = 18000, jump = { error = 0.1, first = 20, largest = 500 } }",
        &format!("cycles = {{ count = {cycles}, jump = 50 }}"),
    );
    let text = replaced(
        text,
        "increments = { fixed = 40 }",
        "increments = { fixed = 8 }",
    );
    let text = replaced(text, "times = [202, 1002, 3002, 9002]", "");
    replaced(
        text,
        "roles = \"as-named\"",
        &format!("roles = \"as-named\"\nworn = {worn:?}"),
    )
}

/// Runs it into a folder; what it was, and the name of its last fields.
fn run(folder: &Path, out: &str, text: &str) -> (Simulation, String) {
    let problem = Problem::from_toml(text, None).unwrap_or_else(|e| panic!("{e}"));
    let setup = problem.build(folder).unwrap_or_else(|e| panic!("{e}"));
    let mut simulation = Simulation::new(setup).unwrap_or_else(|e| panic!("{e}"));
    let place = folder.join(out);
    let mut files = ResultFiles::new(&place, &Default::default()).expect("a folder");
    simulation
        .run(&mut [&mut files])
        .unwrap_or_else(|e| panic!("{e}"));
    let all = pvd::read(&place.join("fields.pvd")).expect("fields");
    let (_, last) = all.last().expect("a time").clone();
    (simulation, format!("{out}/{last}"))
}

fn area(simulation: &Simulation) -> f64 {
    let mesh = &simulation.model.mesh;
    mesh.cells()
        .map(|cell| geometry::cell_measure(mesh, cell))
        .sum()
}

/// Depths at all points of the mesh; zero where nothing wears.
fn depths(simulation: &Simulation) -> Vec<f64> {
    let all = fields(&simulation.view());
    let worn = &all.get("CWEAR").expect("depths").values;
    worn.iter()
        .map(|h| if h.is_finite() { *h } else { 0.0 })
        .collect()
}

/// Two hundred cycles, their depths made geometry, and two hundred more wear as four hundred: the scar is shallow, so that first order holds. The bodies have lost the area that the law says.
#[test]
fn a_run_on_worn_surfaces_goes_on_where_the_one_before_ended() {
    let folder = support::folder("worn");
    let (first, name) = run(&folder, "first", &case(200, &[]));
    let (second, again) = run(&folder, "second", &case(200, std::slice::from_ref(&name)));
    let (whole, _) = run(&folder, "whole", &case(400, &[]));
    let note = format!("as worn in {name}");
    assert!(
        second.summary.notes.iter().any(|n| n.contains(&note)),
        "{:?}",
        second.summary.notes
    );
    let lost = first.summary.last["contact.CWEARVOL"];
    let gone = area(&first) - area(&second);
    println!("area {gone}, volume {lost}");
    assert!((gone / lost - 1.0).abs() < 1e-3, "{gone} {lost}");
    let [a, b, c] = [&first, &second, &whole].map(depths);
    let deepest = c.iter().copied().fold(0.0, f64::max);
    let off = a
        .iter()
        .zip(&b)
        .zip(&c)
        .map(|((a, b), c)| (a + b - c).abs());
    let off = off.fold(0.0, f64::max);
    println!("off {off} of {deepest}");
    assert!(off < 0.01 * deepest, "{off} {deepest}");
    let pressures = [&second, &whole].map(|s| s.summary.last["contact.CPRESSMAX"]);
    println!("{pressures:?}");
    assert!(
        (pressures[0] / pressures[1] - 1.0).abs() < 0.01,
        "{pressures:?}"
    );
    // And once more, on what two runs have worn: the second file is of the mesh that the first has made.
    let problem = Problem::from_toml(&case(50, &[name, again.clone()]), None);
    let setup = problem.unwrap_or_else(|e| panic!("{e}")).build(&folder);
    let third = Simulation::new(setup.unwrap_or_else(|e| panic!("{e}")));
    let third = third.unwrap_or_else(|e| panic!("{e}"));
    let more = area(&second) - area(&third);
    let lost = second.summary.last["contact.CWEARVOL"];
    assert!((more / lost - 1.0).abs() < 1e-3, "{more} {lost}");
    // A result of another mesh is none.
    let problem = Problem::from_toml(&case(50, &[again]), None).unwrap_or_else(|e| panic!("{e}"));
    let said = problem
        .build(&folder)
        .err()
        .map(|e| e.to_string())
        .unwrap_or_default();
    assert!(said.contains("has no point where node"), "{said}");
}

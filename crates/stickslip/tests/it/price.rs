//! What an analysis costs, in counts that are the same on every machine: a change that makes it dearer is seen here, and says so by its bound.

use std::path::Path;

use stickslip::problem::Document;
use stickslip::results::Summary;
use stickslip::run::Simulation;

/// The press-and-slide cubes with 14 cells along the edges of the lower one.
fn press_and_slide(case: &str) -> Summary {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/press-and-slide");
    let document = Document::read(&folder.join(case)).unwrap();
    let document = document.with_overrides(
        [
            "body.lower.generate.box.cells=[14,14,14]",
            "body.upper.generate.box.cells=[13,13,13]",
            "solver.method=\"condensed\"",
        ]
        .map(String::from),
    );
    let model = document.problem().unwrap().build(&document.folder());
    let mut simulation = Simulation::new(model.unwrap()).unwrap();
    simulation.run(&mut []).unwrap();
    simulation.run.summary
}

#[test]
fn an_analysis_costs_no_more_than_it_did() {
    // Fifteen increments. Products with the compliance are made for every Krylov step and every iteration; a reduced factor is as dear as some ten
    // of them. Bounds are a tenth above what was counted when they were set.
    for (case, iterations, krylov, reduced) in
        [("case.toml", 15, 65, 1), ("case-slip.toml", 33, 302, 7)]
    {
        let summary = press_and_slide(case);
        let solver = &summary.cost.solver;
        let counted = format!("{case}: {solver:?}");
        assert!(solver.iterations <= iterations, "{counted}");
        assert!(solver.krylov <= krylov, "{counted}");
        assert!(solver.reduced <= reduced, "{counted}");
        assert_eq!(
            (solver.factorisations, summary.attempts.cutbacks),
            (2, 0),
            "{case}"
        );
        assert!(solver.factors.flops <= 5.4e9, "{counted}");
        assert!(solver.factors.bytes <= 150 << 20, "{counted}");
    }
}

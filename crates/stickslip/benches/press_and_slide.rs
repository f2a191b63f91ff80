//! `cargo bench`: the press-and-slide problem of `examples/press-and-slide` in three sizes, stick and slip, with the time of every phase and the
//! price of the whole analysis in linear solves of the same bodies.
//!
//! Times are those of this machine now; what counts is their ratio to another program's in the same session
//! (`cargo xtask peers`).

use std::path::Path;

use stickslip::problem::Document;
use stickslip::run::Simulation;

fn run(case: &str, n: usize) -> Result<(), stickslip::Error> {
    let file = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../examples/press-and-slide")
        .join(case);
    let m = n - 1;
    let document = Document::read(&file)?.with_overrides([
        format!("body.lower.generate.box.cells=[{n},{n},{n}]"),
        format!("body.upper.generate.box.cells=[{m},{m},{m}]"),
    ]);
    let model = document.problem()?.build(&document.folder())?;
    let mut simulation = Simulation::new(model)?;
    simulation.run(&mut [])?;
    let s = &simulation.summary;
    println!(
        "{case:<22} N {n:>3} {:>7} dofs {:>3} its {:>3} factors {:>4} krylov | assemble {:.2} order {:.2} factor {:.2} condense {:.2} iterate {:.2} contact {:.2} recover {:.2} total {:.2} s = {:.2} linear solves of {:.2} s",
        s.size.dofs,
        s.cost.solver.iterations,
        s.cost.solver.factorisations,
        s.cost.solver.krylov,
        s.cost.phases.assemble,
        s.cost.phases.order,
        s.cost.phases.factor,
        s.cost.phases.condense,
        s.cost.phases.iterate,
        s.cost.phases.contact,
        s.cost.phases.recover,
        s.cost.phases.total,
        s.cost.relative_to_linear,
        s.cost.linear_solve
    );
    Ok(())
}

fn main() {
    for case in ["case.toml", "case-slip.toml"] {
        for n in [11, 18, 27] {
            if let Err(e) = run(case, n) {
                eprintln!("{case} at N = {n}: {e}");
            }
        }
    }
}

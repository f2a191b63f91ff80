//! Two equal bodies on one and on two threads.

use super::bench::{Bench, example};
use super::table::Table;

/// Runs press-and-slide with `n` cells an edge of both cubes.
pub fn measure(bench: &Bench, sizes: &[usize]) -> Result<(), String> {
    let n = match sizes {
        [] => 24,
        [n] => *n,
        _ => return Err("threads takes one size".into()),
    };
    let case = example("press-and-slide/case.toml")?;
    let cells = |body: &str| format!("body.{body}.generate.box.cells=[{n},{n},{n}]");
    let settings = [cells("lower"), cells("upper")];
    let table = Table::new(
        "Two equal cubes, wall seconds",
        &[
            "N",
            "dofs",
            "threads",
            "order",
            "factor and condense",
            "iterate",
            "whole process",
            "CPU s",
        ],
    );
    let (mut factors, mut walls, mut phases) = (Vec::new(), Vec::new(), Vec::new());
    for threads in [1, 2] {
        let run = bench.analyse_on(threads, &case, &settings)?;
        let factor = run.phase("factor") + run.phase("condense");
        factors.push(factor);
        walls.push(run.run.wall);
        phases.push(format!("- {threads}: {} s", run.phases()));
        table.row([
            n.to_string(),
            run.dofs().to_string(),
            threads.to_string(),
            format!("{:.2}", run.phase("order")),
            format!("{factor:.2}"),
            format!("{:.2}", run.phase("iterate")),
            format!("{:.2}", run.run.wall),
            format!("{:.2}", run.run.cpu),
        ]);
    }
    println!();
    phases.iter().for_each(|line| println!("{line}"));
    if let ([one, two], [first, second]) = (&factors[..], &walls[..]) {
        println!(
            "\nfactor and condense on two threads: {:.2} of the time on one; the whole analysis {:.2} times as fast",
            two / one,
            first / second
        );
    }
    Ok(())
}

//! A ball that frets on a block: 100 increments against one linear solve.

use super::bench::{Bench, example, ratio, seconds};
use super::table::Table;

/// What the whole analysis should stay below, in linear solves.
const GOAL: f64 = 1.5;

/// Runs both sizes.
pub fn measure(bench: &Bench) -> Result<(), String> {
    let table = Table::new(
        "Fretting: ball on block, 100 increments of a loop, one thread, CPU seconds",
        &[
            "dofs",
            "increments",
            "iterations",
            "whole analysis",
            "MB",
            "one linear solve, sparse",
            "analysis / linear solve",
        ],
    );
    let mut lines = Vec::new();
    for file in ["case.toml", "case-large.toml"] {
        let case = example(&format!("fretting-sphere/{file}"))?;
        let loops = bench.analyse(&case, &[])?;
        // Hardly pressed: the first factor is what is wanted, and few follow.
        let settings = [
            "solver.method=\"sparse\"".to_string(),
            "step=[{name=\"press\",duration=0.01,increments={fixed=1}}]".to_string(),
        ];
        let linear = bench.analyse(&case, &settings)?.linear_solve();
        table.row([
            loops.dofs().to_string(),
            loops.number("/increments").to_string(),
            loops.number("/iterations").to_string(),
            seconds(Some(loops.run.cpu)),
            format!("{:.0}", loops.megabytes()),
            seconds(Some(linear)),
            ratio(loops.run.cpu, Some(linear)),
        ]);
        let word = if loops.run.cpu <= GOAL * linear {
            "yes"
        } else {
            "no"
        };
        lines.push(format!(
            "{} dofs: at most {GOAL} linear solves: {word}; {} s",
            loops.dofs(),
            loops.phases()
        ));
    }
    println!();
    for line in lines {
        println!("- {line}");
    }
    Ok(())
}

//! Press-and-slide: two cubes, stick and slip.

use std::fs;

use super::bench::{Analysis, Bench, example, ratio, seconds};
use super::cpu::Run;
use super::deck;
use super::table::Table;

/// Cells an edge of the lower cube if the command line names none.
const SIZES: [usize; 2] = [11, 18];

/// Name, problem file and how far the top face moves sideways `[m]`.
const CASES: [(&str, &str, f64); 2] = [
    ("stick", "case.toml", 5e-4),
    ("slip", "case-slip.toml", 3e-3),
];

/// Settings for `n` cells an edge of the lower cube and `n - 1` of the upper.
pub fn cells(n: usize) -> Vec<String> {
    let cells = |body: &str, n: usize| format!("body.{body}.generate.box.cells=[{n},{n},{n}]");
    vec![cells("lower", n), cells("upper", n - 1)]
}

/// Runs both cases for every size in both programs.
pub fn measure(bench: &Bench, sizes: &[usize]) -> Result<(), String> {
    let sizes = if sizes.is_empty() { &SIZES } else { sizes };
    let table = Table::new(
        "Press and slide: 15 increments, one thread, CPU seconds of the whole process",
        &[
            "N",
            "dofs",
            "case",
            "increments",
            "iterations",
            "stickslip",
            "MB",
            "one linear solve, tied",
            "analysis / linear solve",
            "CalculiX",
            "stickslip / CalculiX",
        ],
    );
    let mut phases = Vec::new();
    let mut forces = Vec::new();
    for &n in sizes {
        let linear = tied(bench, n)?.linear_solve();
        for (name, file, slide) in CASES {
            let case = example(&format!("press-and-slide/{file}"))?;
            let ours = bench.analyse(&case, &cells(n))?;
            let theirs = match bench.calculix {
                true => {
                    let (run, force) = run_calculix(bench, n, name, slide)?;
                    let force =
                        force.map_or("unknown".into(), |[x, _, z]| format!("{x:.4e} / {z:.4e}"));
                    forces.push(format!(
                        "N = {n}, {name}: R_x / R_z of the top face {:.4e} / {:.4e} N, CalculiX {force} N",
                        ours.number("/last/top-x.RF1"),
                        ours.number("/last/top-z.RF3")
                    ));
                    Some(run.cpu)
                }
                false => None,
            };
            table.row([
                n.to_string(),
                ours.dofs().to_string(),
                name.to_string(),
                ours.number("/increments").to_string(),
                ours.number("/iterations").to_string(),
                seconds(Some(ours.run.cpu)),
                format!("{:.0}", ours.megabytes()),
                seconds(Some(linear)),
                ratio(ours.run.cpu, Some(linear)),
                seconds(theirs),
                ratio(ours.run.cpu, theirs),
            ]);
            phases.push(format!("N = {n}, {name}: {} s", ours.phases()));
        }
    }
    println!();
    for line in phases.iter().chain(&forces) {
        println!("- {line}");
    }
    Ok(())
}

/// The sparse matrix of both bodies and the springs between them, for the price of one linear solve.
fn tied(bench: &Bench, n: usize) -> Result<Analysis, String> {
    let mut settings = cells(n);
    settings.push("solver.method=\"sparse\"".into());
    settings.push("step=[{name=\"press\",increments={fixed=1}}]".into());
    bench.analyse(&example("press-and-slide/case.toml")?, &settings)
}

/// Runs CalculiX; also the force on the top face at the end `[N]`.
fn run_calculix(
    bench: &Bench,
    n: usize,
    name: &str,
    slide: f64,
) -> Result<(Run, Option<[f64; 3]>), String> {
    let folder = bench.folder(&format!("calculix-{name}-{n}"))?;
    let file = folder.join("slide.inp");
    fs::write(&file, deck::press_and_slide(n, slide))
        .map_err(|e| format!("{}: {e}", file.display()))?;
    let run = bench.calculix(&folder, "slide")?;
    let printed = fs::read_to_string(folder.join("slide.dat")).unwrap_or_default();
    Ok((run, last_total_force(&printed, "TOP")))
}

/// The last total force of a node set that CalculiX printed.
fn last_total_force(printed: &str, set: &str) -> Option<[f64; 3]> {
    let title = format!("set {set} ");
    let mut lines = printed.lines();
    let mut force = None;
    while let Some(line) = lines.next() {
        if line.contains("total force") && line.contains(&title) {
            let numbers = lines.find(|line| !line.trim().is_empty())?;
            let numbers: Vec<f64> = numbers.split_whitespace().flat_map(str::parse).collect();
            force = numbers.try_into().ok();
        }
    }
    force
}

#[cfg(test)]
mod tests {
    use super::last_total_force;

    #[test]
    fn reads_the_last_total() {
        let printed = "
 total force (fx,fy,fz) for set TOP and time  0.1000000E+01

        1.0E+00  2.0E+00 -3.0E+00

 total force (fx,fy,fz) for set BOT and time  0.2000000E+01

        7.0E+00  8.0E+00  9.0E+00

 total force (fx,fy,fz) for set TOP and time  0.2000000E+01

        4.0E+00  5.0E+00 -6.0E+00
";
        assert_eq!(last_total_force(printed, "TOP"), Some([4.0, 5.0, -6.0]));
        assert_eq!(last_total_force(printed, "SIDE"), None);
    }
}

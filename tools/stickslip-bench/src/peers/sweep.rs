//! A parameter study: many coefficients of friction on one pair of bodies.

use std::fs;
use std::process::{Command, Stdio};

use super::bench::{Bench, example};
use super::cpu;
use super::slide::cells;
use super::table::Table;

/// Runs the study with `sizes[0]` cells an edge and `sizes[1]` coefficients.
pub fn measure(bench: &Bench, sizes: &[usize]) -> Result<(), String> {
    let (n, runs) = match sizes {
        [] => (18, 50),
        [n] => (*n, 50),
        [n, runs] => (*n, *runs),
        _ => return Err("sweep takes cells an edge and a number of runs".into()),
    };
    let file = bench.folder("sweep")?.join("sweep.csv");
    let mut command = Command::new(&bench.binary);
    command
        .arg("sweep")
        .arg(example("press-and-slide/case.toml")?);
    let axis = format!("interface.joint.friction.coulomb.mu=0.02..1:{runs}");
    command.args(["--threads", "1", "--quiet", "--set", &axis]);
    for setting in cells(n) {
        command.args(["--fix", &setting]);
    }
    command.args(["--column", "SLIP", "-o"]).arg(&file);
    let run = cpu::measure(command.stdout(Stdio::null()))?;
    let file = file.with_extension("effort.csv");
    let text = fs::read_to_string(&file).map_err(|e| format!("{}: {e}", file.display()))?;
    let seconds =
        column(&text, "seconds").ok_or("the table of what the runs took has no seconds")?;
    let first = seconds.first().copied().unwrap_or(0.0);
    let total: f64 = seconds.iter().sum();
    let table = Table::new(
        "Sweep of the coefficient of friction, press-and-slide, one thread, wall seconds",
        &[
            "N",
            "runs",
            "first run",
            "mean of the others",
            "all",
            "all / first",
            "CPU s of the process",
        ],
    );
    table.row([
        n.to_string(),
        seconds.len().to_string(),
        format!("{first:.2}"),
        format!(
            "{:.3}",
            (total - first) / (seconds.len() as f64 - 1.0).max(1.0)
        ),
        format!("{total:.2}"),
        format!("{:.2}", total / first),
        format!("{:.2}", run.cpu),
    ]);
    Ok(())
}

/// The numbers of a column of a table; `None` without that column.
fn column(csv: &str, name: &str) -> Option<Vec<f64>> {
    let mut lines = csv.lines();
    let place = lines.next()?.split(',').position(|head| head == name)?;
    // Only what a run failed for may hold commas, and then it is quoted.
    Some(
        lines
            .filter(|line| !line.contains('"'))
            .filter_map(|line| line.split(',').nth(place)?.parse().ok())
            .collect(),
    )
}

#[cfg(test)]
mod tests {
    use super::column;

    #[test]
    fn reads_a_column_by_its_head() {
        let csv = "run,seconds,SLIP\n1,2.5,0\n2,\"a, b\",0\n3,0.5,1\n";
        assert_eq!(column(csv, "seconds"), Some(vec![2.5, 0.5]));
        assert_eq!(column(csv, "hours"), None);
    }
}

//! What the runs of a sweep took: a table beside that of their results, since it depends on the machine and on what runs share.

use std::path::{Path, PathBuf};

use stickslip::Error;
use stickslip::io::write_atomically;
use stickslip::results::Summary;

/// The columns. Seconds are those from reading to the end; then come counts of bodies, the phases of the summary, and memory.
const NAMES: &[&str] = &[
    "run",
    "seconds",
    "factorisations",
    "shared",
    "from-cache",
    "read",
    "assemble",
    "order",
    "factor",
    "condense",
    "iterate",
    "contact",
    "recover",
    "write",
    "peak-memory",
    "threads",
];

/// The table, a line of text a run.
#[derive(Debug)]
pub struct EffortTable {
    /// The file.
    pub path: PathBuf,
    lines: Vec<String>,
}

impl EffortTable {
    /// A table without rows, beside that of the results.
    pub fn beside(table: &Path) -> Self {
        EffortTable {
            path: table.with_extension("effort.csv"),
            lines: Vec::new(),
        }
    }

    /// Takes over the rows of the first runs, as far as they are there: they are nothing that a sweep could not do without.
    pub fn take_over(&mut self, runs: usize) {
        let text = std::fs::read_to_string(&self.path).unwrap_or_default();
        let mut lines = text.lines();
        if lines.next() == Some(&NAMES.join(",")) {
            let of_first = |line: &&str| {
                let run = line.split(',').next().and_then(|run| run.parse().ok());
                run.is_some_and(|run: usize| (1..=runs).contains(&run))
            };
            self.lines = lines.filter(of_first).map(str::to_string).collect();
        }
    }

    /// Adds a row.
    pub fn add(&mut self, line: String) {
        self.lines.push(line);
    }

    /// Writes it, aside and renamed.
    ///
    /// # Errors
    /// [`Error::Io`].
    pub fn write(&self) -> Result<(), Error> {
        let mut text = NAMES.join(",") + "\n";
        for line in &self.lines {
            text += line;
            text.push('\n');
        }
        write_atomically(&self.path, text.as_bytes())
    }
}

/// The row of a run, counted from 1.
pub fn line(run: usize, seconds: f64, summary: Option<&Summary>) -> String {
    let mut cells = vec![run.to_string(), format!("{seconds:.6}")];
    match summary {
        None => cells.resize(NAMES.len(), String::new()),
        Some(s) => {
            let solver = &s.cost.solver;
            let counts = [
                solver.factorisations,
                solver.substructures.shared,
                solver.substructures.read,
            ];
            cells.extend(counts.map(|n| n.to_string()));
            let p = &s.cost.phases;
            let phases = [
                p.read, p.assemble, p.order, p.factor, p.condense, p.iterate, p.contact, p.recover,
                p.write,
            ];
            cells.extend(phases.map(|seconds| format!("{seconds:.6}")));
            cells.push(s.cost.peak_memory.to_string());
            cells.push(s.cost.threads.to_string());
        }
    }
    cells.join(",")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_have_a_cell_a_column_with_and_without_a_simulation() {
        for summary in [None, Some(&Summary::default())] {
            let line = line(3, 0.25, summary);
            assert!(line.starts_with("3,0.250000,"), "{line}");
            assert_eq!(line.split(',').count(), NAMES.len());
        }
        let table = EffortTable::beside(Path::new("a/case.sweep.csv"));
        assert_eq!(table.path, Path::new("a/case.sweep.effort.csv"));
    }
}

//! What the runs of a sweep took: a table beside that of their results, since it depends on the machine and on what runs share.

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

/// The line of the names of columns.
pub fn head() -> String {
    NAMES.join(",") + "\n"
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
    }
}

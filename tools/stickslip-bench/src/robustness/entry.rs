//! A problem that was run.

use super::outcome::Outcome;

/// A problem that was run.
pub struct Entry {
    pub name: String,
    pub family: &'static str,
    pub words: String,
    pub outcome: Outcome,
}

/// Prints the heads of the table.
pub fn heads() {
    println!("| problem | what | dofs | verdict | increments | iterations | cut-backs | s |");
    println!("|{}", "---|".repeat(8));
}

impl Entry {
    /// Prints its row.
    pub fn print(&self) {
        let outcome = &self.outcome;
        println!(
            "| {} | {}: {} | {} | {} | {} | {} | {} | {:.2} |",
            self.name,
            self.family,
            self.words,
            outcome.dofs,
            outcome.verdict.words(),
            outcome.iterations.len(),
            outcome.total,
            outcome.cutbacks,
            outcome.seconds
        );
    }
}

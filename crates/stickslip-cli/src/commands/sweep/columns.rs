//! The columns that histories have, known from the first row of the first run on.

use stickslip::Error;
use stickslip::error::RunError;
use stickslip::simulation::{Event, Observer, Simulation};

use crate::commands::Failure;

/// Looks at the first row of a run. Ends the run if a column that was asked for is not there: a wrong name should
/// not cost a whole run.
pub struct Columns<'a> {
    wanted: &'a [String],
    /// All names, in the order of the history; empty before the first row.
    pub names: Vec<String>,
    /// The first name asked for that no column has.
    pub unknown: Option<String>,
}

impl<'a> Columns<'a> {
    /// Asks for `wanted`.
    pub fn new(wanted: &'a [String]) -> Self {
        Columns {
            wanted,
            names: Vec::new(),
            unknown: None,
        }
    }

    /// Why the command ends, if a column is unknown.
    pub fn refusal(&self) -> Option<Failure> {
        let name = self.unknown.as_ref()?;
        Some(Failure::Arguments(
            format!("there is no column `{name}`"),
            format!(
                "near it: {}; without --column the table has all",
                near(name, &self.names).join(", ")
            ),
        ))
    }
}

impl Observer for Columns<'_> {
    fn see(&mut self, _: &Simulation, event: Event) -> Result<(), Error> {
        let Event::Increment(row) = event else {
            return Ok(());
        };
        if !self.names.is_empty() {
            return Ok(());
        }
        self.names = row.names.clone();
        let mut wanted = self.wanted.iter();
        self.unknown = wanted.find(|name| !row.names.contains(name)).cloned();
        match &self.unknown {
            None => Ok(()),
            Some(name) => Err(Error::Run(RunError {
                message: format!("there is no column `{name}`"),
                time: row.get("TIME").unwrap_or(0.0),
                culprits: Vec::new(),
                help: None,
            })),
        }
    }
}

/// Number of names that are suggested.
const NEAR: usize = 6;

/// The names that take the fewest changes of letters to become `word`, nearest first.
fn near<'a>(word: &str, names: &'a [String]) -> Vec<&'a str> {
    let word = word.to_lowercase();
    let mut all: Vec<(usize, &str)> = names
        .iter()
        .map(|name| (changes(&word, &name.to_lowercase()), name.as_str()))
        .collect();
    // Stable: names that are equally near stay in the order of the history.
    all.sort_by_key(|&(n, _)| n);
    all.into_iter().take(NEAR).map(|(_, name)| name).collect()
}

/// Insertions, deletions and replacements between two words.
fn changes(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, letter) in a.chars().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for j in 0..b.len() {
            let replaced = diagonal + usize::from(letter != b[j]);
            diagonal = row[j + 1];
            row[j + 1] = replaced.min(diagonal + 1).min(row[j] + 1);
        }
    }
    row[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_names_come_first() {
        let names = [
            "TIME",
            "ALLSE",
            "ALLCE",
            "base.CFN1",
            "base.CFN2",
            "top.RF1",
            "X",
            "Y",
        ];
        let names: Vec<String> = names.iter().map(ToString::to_string).collect();
        assert_eq!(near("base.CNF2", &names)[0], "base.CFN2");
        assert_eq!(near("allse", &names)[..2], ["ALLSE", "ALLCE"]);
        assert_eq!(near("", &names).len(), NEAR);
        assert!(near("a", &[]).is_empty());
    }

    #[test]
    fn changes_are_counted() {
        for (a, b, n) in [("", "abc", 3), ("abc", "abc", 0), ("kitten", "sitting", 3)] {
            assert_eq!(changes(a, b), n);
            assert_eq!(changes(b, a), n);
        }
    }
}

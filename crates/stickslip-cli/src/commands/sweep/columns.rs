//! The columns that histories have, known from the first row of the first run on.

use stickslip::Error;
use stickslip::error::RunError;
use stickslip::modal::{FIGURES, TOLD, figures_of_mode};
use stickslip::model::Modal;
use stickslip::results::compare::near;
use stickslip::results::{Analysis, Event, Observer};

use crate::failure::Failure;

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
            format!(
                "there is no column `{name}`{}",
                near(name, self.names.iter().map(String::as_str))
            ),
            "without --column the table has all".into(),
        ))
    }
}

impl Observer for Columns<'_> {
    fn see(&mut self, analysis: &Analysis, event: Event) -> Result<(), Error> {
        let Event::Increment(row) = event else {
            return Ok(());
        };
        if !self.names.is_empty() {
            return Ok(());
        }
        self.names = row.names.clone();
        let modal = analysis
            .view
            .model
            .steps
            .iter()
            .filter_map(|s| s.modal.as_ref());
        if let Some(count) = modal.map(Modal::count).max().filter(|count| *count > 0) {
            self.names.extend(FIGURES.map(String::from));
            self.names
                .extend((1..=count.min(TOLD)).flat_map(figures_of_mode));
        }
        let mut wanted = self.wanted.iter();
        self.unknown = wanted.find(|name| !self.names.contains(name)).cloned();
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

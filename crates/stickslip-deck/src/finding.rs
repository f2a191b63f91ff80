//! What is to be said about a deck, with places.

use std::fmt;
use std::path::{Path, PathBuf};

/// How grave a finding is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Severity {
    /// The deck cannot be run as it is.
    Error,
    /// The deck runs, but most likely not as it was meant.
    Warning,
    /// Something that was left out or taken differently, and does not change the answer, or says how.
    Note,
}

/// One thing to say about a deck.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Finding {
    /// How grave.
    pub severity: Severity,
    /// The file; one of those included, perhaps.
    pub file: PathBuf,
    /// The line, from 1; 0 for the file as a whole.
    pub line: usize,
    /// What, in a sentence without a final stop.
    pub message: String,
    /// What to do about it.
    pub help: Option<String>,
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.file.display())?;
        if self.line > 0 {
            write!(f, ":{}", self.line)?;
        }
        let word = match self.severity {
            Severity::Error => "error",
            Severity::Warning => "warning",
            Severity::Note => "note",
        };
        write!(f, ": {word}: {}", self.message)?;
        match &self.help {
            Some(help) => write!(f, "\n  help: {help}"),
            None => Ok(()),
        }
    }
}

/// A deck that cannot be run: every error that was found, in the order of the lines.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct DeckError {
    /// The errors; never empty.
    pub findings: Vec<Finding>,
}

impl DeckError {
    pub(crate) fn io(file: &Path, error: &std::io::Error, place: Option<(&Path, usize)>) -> Self {
        let (at, line) = place.unwrap_or((file, 0));
        let message = format!("{} cannot be read: {error}", file.display());
        DeckError {
            findings: vec![Finding {
                severity: Severity::Error,
                file: at.to_path_buf(),
                line,
                message,
                help: Some("check the path; that of an included file is relative to the file that includes it".into()),
            }],
        }
    }
}

impl fmt::Display for DeckError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, finding) in self.findings.iter().enumerate() {
            if i > 0 {
                writeln!(f)?;
            }
            finding.fmt(f)?;
        }
        Ok(())
    }
}

impl std::error::Error for DeckError {}

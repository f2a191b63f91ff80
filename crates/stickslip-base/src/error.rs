//! Errors by phase: the problem file, the mesh, the run, files.

use std::borrow::Cow;
use std::fmt;
use std::ops::Range;
use std::path::{Path, PathBuf};

use crate::number::digits;

/// What can go wrong, by the phase in which it does. The command line maps the phases to exit codes.
#[derive(Debug, Clone)]
pub enum Error {
    /// The problem file is wrong: syntax, unknown keys, values that make no sense.
    Problem(ProblemError),
    /// A mesh is wrong or cannot be read.
    Mesh(MeshError),
    /// The analysis did not finish.
    Run(RunError),
    /// A file cannot be read or written.
    Io(IoError),
    /// The analysis was asked to stop, at this time `[the problem's unit of time]`; what was accepted so far stays.
    Interrupted(f64),
}

/// One finding in a problem file.
#[derive(Debug, Clone, PartialEq)]
pub struct Diagnostic {
    /// What is wrong, in a sentence without a final stop.
    pub message: String,
    /// Where, as the path of the key: `interface.base.friction`. Empty for the whole file.
    pub key: String,
    /// Bytes of the source text the finding is about, when known.
    pub span: Option<Range<usize>>,
    /// What to do about it.
    pub help: Option<String>,
}

impl Diagnostic {
    /// A finding about the value at `key`.
    pub fn new(key: impl Into<String>, message: impl Into<String>) -> Self {
        Diagnostic {
            message: message.into(),
            key: key.into(),
            span: None,
            help: None,
        }
    }

    /// Adds what to do.
    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }

    /// The same with its key below `parent`.
    pub fn under(mut self, parent: &str) -> Self {
        self.key = match self.key.as_str() {
            "" => parent.to_string(),
            key => format!("{parent}.{key}"),
        };
        self
    }
}

/// A problem file with one finding or more.
#[derive(Debug, Clone)]
pub struct ProblemError {
    /// The file, if the problem came from one.
    pub file: Option<PathBuf>,
    /// Its text, for rendering the spans.
    pub source: String,
    /// The findings; never empty.
    pub findings: Vec<Diagnostic>,
}

/// A mesh that cannot be used.
#[derive(Debug, Clone)]
pub struct MeshError {
    /// The mesh file, if there is one.
    pub file: Option<PathBuf>,
    /// Line (ASCII formats) in that file, from 1.
    pub line: Option<usize>,
    /// What is wrong.
    pub message: String,
    /// What to do about it.
    pub help: Option<String>,
}

impl MeshError {
    /// A finding without a place in a file.
    pub fn new(message: impl Into<String>) -> Self {
        MeshError {
            file: None,
            line: None,
            message: message.into(),
            help: None,
        }
    }

    /// Adds what to do.
    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }
}

/// An analysis that stopped before its end.
#[derive(Debug, Clone)]
pub struct RunError {
    /// What happened, in a sentence.
    pub message: String,
    /// Time reached `[the problem's unit of time]`.
    pub time: f64,
    /// The nodes, facets or dofs to look at, most suspect first, one line each.
    pub culprits: Vec<String>,
    /// What to try.
    pub help: Option<String>,
}

/// A file that cannot be read or written.
#[derive(Debug, Clone)]
pub struct IoError {
    /// The file.
    pub file: PathBuf,
    /// What the system said.
    pub message: String,
}

impl Error {
    /// Wraps what the system said about `file`.
    pub fn io(file: &Path, error: std::io::Error) -> Self {
        Error::Io(IoError {
            file: file.to_path_buf(),
            message: error.to_string(),
        })
    }
}

impl From<MeshError> for Error {
    fn from(e: MeshError) -> Self {
        Error::Mesh(e)
    }
}

impl From<Vec<Diagnostic>> for ProblemError {
    fn from(findings: Vec<Diagnostic>) -> Self {
        ProblemError {
            file: None,
            source: String::new(),
            findings,
        }
    }
}

impl From<ProblemError> for Error {
    fn from(e: ProblemError) -> Self {
        Error::Problem(e)
    }
}

impl From<RunError> for Error {
    fn from(e: RunError) -> Self {
        Error::Run(e)
    }
}

/// Text of files, paths and names as it may be printed: what would move the cursor, ring, colour, or turn the order of what is read is written as `\u001b`.
/// Lines and tabs stay. JSON that has passed is the same JSON.
pub fn shown(text: &str) -> Cow<'_, str> {
    let acts = |c: char| match c {
        '\n' | '\t' => false,
        // Marks of direction that hold for what follows.
        '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}' => true,
        c => c.is_control(),
    };
    if !text.contains(acts) {
        return Cow::Borrowed(text);
    }
    let mut out = String::with_capacity(text.len() + 16);
    for c in text.chars() {
        match acts(c) {
            true => out += &format!("\\u{:04x}", u32::from(c)),
            false => out.push(c),
        }
    }
    Cow::Owned(out)
}

fn help_line(f: &mut fmt::Formatter<'_>, help: &Option<String>) -> fmt::Result {
    match help {
        Some(help) => write!(f, "\n  help: {help}"),
        None => Ok(()),
    }
}

impl fmt::Display for ProblemError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, finding) in self.findings.iter().enumerate() {
            if i > 0 {
                writeln!(f)?;
            }
            if let Some(file) = &self.file {
                write!(f, "{}", file.display())?;
                if let Some(span) = &finding.span {
                    let (line, column) = line_column(&self.source, span.start);
                    write!(f, ":{line}:{column}")?;
                }
                write!(f, ": ")?;
            }
            if !finding.key.is_empty() {
                write!(f, "{}: ", finding.key)?;
            }
            write!(f, "{}", finding.message)?;
            help_line(f, &finding.help)?;
        }
        Ok(())
    }
}

/// Line and column (both from 1) of a byte of `text`.
pub fn line_column(text: &str, byte: usize) -> (usize, usize) {
    let before = &text.as_bytes()[..byte.min(text.len())];
    let line = before.iter().filter(|&&b| b == b'\n').count() + 1;
    let start = before
        .iter()
        .rposition(|&b| b == b'\n')
        .map_or(0, |p| p + 1);
    let column = String::from_utf8_lossy(&before[start..]).chars().count() + 1;
    (line, column)
}

impl fmt::Display for MeshError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(file) = &self.file {
            write!(f, "{}", file.display())?;
            if let Some(line) = self.line {
                write!(f, ":{line}")?;
            }
            write!(f, ": ")?;
        }
        write!(f, "{}", self.message)?;
        help_line(f, &self.help)
    }
}

impl fmt::Display for RunError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "at time {}: {}", digits(self.time, 6), self.message)?;
        for culprit in &self.culprits {
            write!(f, "\n  - {culprit}")?;
        }
        help_line(f, &self.help)
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Error::Problem(e) => e.fmt(f),
            Error::Mesh(e) => e.fmt(f),
            Error::Run(e) => e.fmt(f),
            Error::Io(e) => write!(f, "{}: {}", e.file.display(), e.message),
            Error::Interrupted(time) => {
                write!(f, "interrupted at time {time}", time = digits(time, 6))
            }
        }
    }
}

impl std::error::Error for Error {}
impl std::error::Error for ProblemError {}
impl std::error::Error for MeshError {}
impl std::error::Error for RunError {}

#[cfg(test)]
mod tests {
    use super::shown;

    #[test]
    fn what_acts_on_a_terminal_is_written_out() {
        assert_eq!(shown("a\tb\né"), "a\tb\né");
        assert_eq!(
            shown("\u{1b}]0;t\u{7}\r\u{9b}1m\u{202e}"),
            "\\u001b]0;t\\u0007\\u000d\\u009b1m\\u202e"
        );
        let json = "{\"a\": \"\u{7f}\"}";
        assert_eq!(shown(json), "{\"a\": \"\\u007f\"}");
    }
}

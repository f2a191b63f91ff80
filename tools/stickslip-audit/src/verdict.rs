//! What became of a problem: the word of the program against the figures of the audit.

use crate::figure::Report;

/// The judgement on one run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Verdict {
    /// Passed, and the audit finds nothing wrong.
    Sound,
    /// Passed, and the audit finds it wrong. This must never happen.
    Wrong,
    /// The quality gate failed a result in which the audit finds something as well.
    Rightly,
    /// The quality gate failed a result in which the audit finds nothing.
    FalseAlarm,
    /// Two runs that must agree do not, and both passed.
    Disagreement,
    /// No solution was found.
    Failure,
    /// Ended by a panic, a signal, or with a code that is not in the table of exit codes.
    Crash,
    /// Refused before it began.
    Refused,
    /// Stopped after the limit of time.
    Late,
    /// The result folder cannot be read, though the program says that it finished.
    Unreadable,
}

impl Verdict {
    /// From the exit code (`None` if the run was stopped) and the audit of what it left.
    pub fn new(exit: Option<i32>, report: &Result<Report, String>) -> Verdict {
        match (exit, report) {
            (None, _) => Verdict::Late,
            (Some(0 | 2), Err(_)) => Verdict::Unreadable,
            (Some(0), Ok(report)) if report.wrong().is_empty() => Verdict::Sound,
            (Some(0), Ok(_)) => Verdict::Wrong,
            (Some(2), Ok(report)) if report.doubtful().is_empty() => Verdict::FalseAlarm,
            (Some(2), Ok(_)) => Verdict::Rightly,
            (Some(1), _) => Verdict::Refused,
            (Some(3), _) => Verdict::Failure,
            (Some(_), _) => Verdict::Crash,
        }
    }

    /// In a few words.
    pub fn words(self) -> &'static str {
        match self {
            Verdict::Sound => "sound",
            Verdict::Wrong => "WRONG with exit 0",
            Verdict::Rightly => "gate failed rightly",
            Verdict::FalseAlarm => "FALSE ALARM of the gate",
            Verdict::Disagreement => "DISAGREES with itself",
            Verdict::Failure => "solver failure",
            Verdict::Crash => "CRASH",
            Verdict::Refused => "refused",
            Verdict::Late => "late",
            Verdict::Unreadable => "UNREADABLE",
        }
    }

    /// Whether the program broke its promise.
    pub fn broken(self) -> bool {
        matches!(
            self,
            Verdict::Wrong
                | Verdict::FalseAlarm
                | Verdict::Disagreement
                | Verdict::Unreadable
                | Verdict::Crash
        )
    }
}

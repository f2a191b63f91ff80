//! Progress on standard error: a line an increment, of what contact does; what the solver does is for who asks for it.

use std::io::IsTerminal;
use std::time::{Duration, Instant};

use stickslip::Error;
use stickslip::assess::doctor::{Finding, Severity};
use stickslip::modal::ModalOutcome;
use stickslip::newton::Strategy;
use stickslip::number::{digits, figure};
use stickslip::results::{Analysis, Event, Observer, Row};

use crate::remaining::{Remaining, part};
use crate::style::{Look, paint, sentence, short};
use crate::voice::ProgressPrinter;
pub use crate::voice::say;

/// Lines of increments that a file or a pipe gets before they become fewer, and how far apart they are from then on.
const FIRST_LINES: usize = 40;
const LINE_INTERVAL: Duration = Duration::from_secs(10);

/// What the columns of the line of an increment are.
const TABLE_HEAD: [&str; 9] = [
    "step", "inc", "time", "its", "stick", "slip", "open", "force", "left",
];

/// Columns that fit into a line.
fn columns([step, inc, time, its, stick, slip, open, force, left]: [&str; 9]) -> String {
    let step = short(step, 16);
    format!(
        "{step:<16} {inc:>6} {time:>12} {its:>5} {stick:>7} {slip:>7} {open:>7} {force:>12} {left:>8}"
    )
    .trim_end()
    .to_string()
}

/// Prints what happens.
pub struct Progress {
    verbose: bool,
    /// Whether somebody looks on: then there is a line for each increment, however many there are.
    terminal: bool,
    /// Lines of increments so far, and when the last was said.
    lines: usize,
    last: Instant,
    started: Instant,
    remaining: Remaining,
    voice: ProgressPrinter,
}

impl Progress {
    /// `verbose` shows every Newton iteration. Where standard error is no terminal, lines become fewer after a while.
    pub fn new(verbose: bool, voice: ProgressPrinter) -> Self {
        let now = Instant::now();
        Progress {
            verbose,
            terminal: std::io::stderr().is_terminal(),
            lines: 0,
            last: now,
            started: now,
            remaining: Remaining::default(),
            voice,
        }
    }

    /// A line that stays.
    fn line(&mut self, text: &str) {
        self.voice.line(text);
    }

    /// Whether the next increment has a line.
    fn due(&mut self) -> bool {
        let few = self.terminal || self.verbose || self.lines < FIRST_LINES;
        let due = few || self.last.elapsed() >= LINE_INTERVAL;
        if due {
            self.lines += 1;
            self.last = Instant::now();
        }
        due
    }

    fn increment(&mut self, analysis: &Analysis, row: &Row) {
        if !self.due() {
            return;
        }
        if self.lines == 1 {
            self.line(&sentence(&legend(analysis)));
            self.line(&paint(Look::Strong, &columns(TABLE_HEAD)));
        }
        let column = |name: &str| row.get(name).unwrap_or(0.0);
        let count = |name: &str| column(name).to_string();
        let text = columns([
            analysis.step_name(),
            &count("INC"),
            &digits(column("TIME"), 6),
            &count("ITRS"),
            &count("STICK"),
            &count("SLIP"),
            &count("OPEN"),
            &figure(largest_force(analysis, row)),
            &self.left(),
        ]);
        self.line(&text);
        if self.verbose {
            let text = internals(analysis, row);
            self.line(&text);
        }
        if self.lines == FIRST_LINES && !self.terminal && !self.verbose {
            let apart = LINE_INTERVAL.as_secs();
            self.line(&format!(
                "  from here on a line every {apart} s; all increments are in history.csv"
            ));
        }
    }

    /// An increment was accepted that ends at this time.
    fn look(&mut self, analysis: &Analysis, time: f64) {
        if let Some(done) = part(&analysis.model.steps, analysis.frame.step, time) {
            let seconds = self.started.elapsed().as_secs_f64();
            self.remaining.note(done, seconds);
        }
    }

    /// The time that is left; nothing where it is not known.
    fn left(&self) -> String {
        match self.remaining.seconds() {
            None => String::new(),
            Some(s) if s < 100.0 => format!("{s:.0} s"),
            Some(s) if s < 6000.0 => format!("{:.0} min", s / 60.0),
            Some(s) => format!("{:.1} h", s / 3600.0),
        }
    }
}

impl Progress {
    /// The table of modes.
    fn modes(&mut self, outcome: &ModalOutcome) {
        self.line(&format!("  {}", outcome.step));
        if let Some(response) = &outcome.response {
            self.line(&format!(
                "  {} frequencies in a space of {} displacements",
                response.rows.len(),
                response.dimension
            ));
            return;
        }
        self.line("  mode      frequency         growth  damping ratio   residual");
        for (k, mode) in outcome.modes.iter().enumerate() {
            self.line(&format!(
                "  {:>4} {:>14} {:>14} {:>14} {:>10}{}",
                k + 1,
                digits(mode.frequency, 5),
                figure(mode.growth),
                figure(mode.damping_ratio),
                digits(mode.residual, 2),
                if mode.is_unstable() { "  unstable" } else { "" }
            ));
        }
    }
}

impl Observer for Progress {
    fn see(&mut self, analysis: &Analysis, event: Event) -> Result<(), Error> {
        if let Event::Accepted(advance) = &event {
            self.look(analysis, advance.time);
        }
        match event {
            Event::Accepted(a) if self.terminal && !self.verbose => {
                self.voice.passing(&format!(
                    "{:<16} {:>6} {:>12} {:>5} ...",
                    short(analysis.step_name(), 16),
                    a.increment,
                    digits(a.time, 6),
                    a.iterations
                ));
            }
            Event::Increment(row) => self.increment(analysis, row),
            Event::Modes(outcome) => self.modes(outcome),
            Event::Iteration(p) if self.verbose => {
                self.line(&format!(
                    "    {:>2}.{:<3} residual {:>9.2e}  step {:<7} krylov {:>3}  stick {} slip {} open {} changed {}{}",
                    p.round,
                    p.iteration,
                    p.residual,
                    p.step,
                    p.krylov,
                    p.tally.stick,
                    p.tally.slip,
                    p.tally.open,
                    p.tally.changed,
                    match p.strategy {
                        Strategy::Plain => String::new(),
                        strategy => format!("  ({})", strategy.name()),
                    }
                ));
            }
            Event::Finding(finding) if finding.severity >= Severity::Warning => {
                self.line(&sentence(&found(finding)));
            }
            Event::Note(text) if !self.verbose && of_solver(analysis, text) => {}
            Event::Note(text) => self.line(&sentence(&format!("  {text}"))),
            Event::Cutback(trial, failure) => {
                self.line(&sentence(&format!(
                    "  cut back: {} to {}: {}",
                    digits(trial.from, 6),
                    digits(trial.to, 6),
                    failure.message
                )));
                for culprit in failure.culprits.iter().take(3) {
                    self.line(&sentence(&format!("    {culprit}")));
                }
            }
            _ => {}
        }
        Ok(())
    }
}

/// Whether a note says how the systems of equations are solved, and why so: `method-reason` of the summary has it as well.
fn of_solver(analysis: &Analysis, note: &str) -> bool {
    let reason = &analysis.summary.solved_by.method_reason;
    !reason.is_empty() && note.ends_with(reason.as_str())
}

/// What the columns are, in a line.
fn legend(analysis: &Analysis) -> String {
    let force = match analysis.contact.interfaces.as_slice() {
        [only] => format!("contact force of {}", only.name),
        _ => "largest contact force of an interface".to_string(),
    };
    format!("its: Newton iterations; stick, slip, open: contact points; force: {force}")
}

/// The largest force that an interface carries, of all interfaces.
fn largest_force(analysis: &Analysis, row: &Row) -> f64 {
    let dim = analysis.model.dofs.dim;
    let of = |name: &str| {
        let component = |c: usize| {
            let part = |kind: &str| row.get(&format!("{name}.{kind}{}", c + 1)).unwrap_or(0.0);
            part("CFN") + part("CFS")
        };
        (0..dim).map(component).map(|f| f * f).sum::<f64>().sqrt()
    };
    let interfaces = analysis.contact.interfaces.iter();
    interfaces.map(|i| of(&i.name)).fold(0.0, f64::max)
}

/// How well an increment was solved, for who works on the solver.
fn internals(analysis: &Analysis, row: &Row) -> String {
    let column = |name: &str| row.get(name).unwrap_or(0.0);
    let energies = ["ALLSE", "ALLCE", "ALLFD", "ALLWK", "ALLKE"].map(|n| column(n).abs());
    let scale = energies.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
    let worst = analysis.worst_point();
    let worst = worst.map_or(String::new(), |p| format!(", worst node {p}"));
    format!(
        "    residual {}, attempt {}, energy error {}{worst}",
        digits(column("RESIDUAL"), 2),
        column("ATT"),
        digits(column("ERESIDUAL") / scale, 2)
    )
}

/// A finding of the doctor in a line; `check` and `explain` say all of it.
pub fn found(finding: &Finding) -> String {
    format!(
        "{} ({}): {}",
        finding.severity, finding.cause, finding.message
    )
}

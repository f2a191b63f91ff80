//! Progress on standard error: a line an increment.

use std::io::IsTerminal;
use std::path::Path;
use std::time::Instant;

use stickslip::Error;
use stickslip::assess::Gate;
use stickslip::assess::doctor::{Finding, Severity};
use stickslip::contact::response::Status;
use stickslip::newton::Strategy;
use stickslip::results::{Analysis, Event, Observer, Row};

use crate::remaining::{Remaining, part};
use crate::voice::Voice;
pub use crate::voice::say;

/// Prints what happens.
pub struct Progress {
    verbose: bool,
    /// Whether somebody looks on: then there is a line an increment.
    terminal: bool,
    headed: bool,
    /// Statuses of all contact points after the last increment.
    statuses: Vec<Status>,
    started: Instant,
    remaining: Remaining,
    voice: Voice,
}

impl Progress {
    /// `verbose` shows every Newton iteration. Where standard error is no terminal, notes and cut-backs are said, and an increment now and then.
    pub fn new(verbose: bool, voice: Voice) -> Self {
        Progress {
            verbose,
            terminal: verbose || std::io::stderr().is_terminal(),
            headed: false,
            statuses: Vec::new(),
            started: Instant::now(),
            remaining: Remaining::default(),
            voice,
        }
    }

    /// A line that stays.
    fn line(&mut self, text: &str) {
        self.voice.line(text);
    }

    /// Points that have another status than after the last increment.
    fn changes(&mut self, analysis: &Analysis) -> usize {
        let now: Vec<Status> = analysis
            .contact
            .interfaces
            .iter()
            .flat_map(|i| i.statuses())
            .collect();
        let before = std::mem::replace(&mut self.statuses, now);
        match before.len() == self.statuses.len() {
            true => before
                .iter()
                .zip(&self.statuses)
                .filter(|(a, b)| a != b)
                .count(),
            false => self.statuses.iter().filter(|s| **s != Status::Open).count(),
        }
    }

    fn increment(&mut self, analysis: &Analysis, row: &Row) {
        let changes = self.changes(analysis);
        if !self.terminal && !self.voice.is_silent() {
            return;
        }
        if !self.headed {
            self.line("step                inc att its        time  residual     open  stick   slip changed  worst node    energy      left");
            self.headed = true;
        }
        let column = |name: &str| row.get(name).unwrap_or(0.0);
        let energies = ["ALLSE", "ALLCE", "ALLFD", "ALLWK", "ALLKE"].map(|n| column(n).abs());
        let scale = energies.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
        let worst = analysis
            .worst_point()
            .map_or(String::new(), |p| p.to_string());
        let text = format!(
            "{:<18} {:>4} {:>3} {:>3} {:>11.5e} {:>9.1e} {:>8} {:>6} {:>6} {changes:>7} {worst:>11} {:>9.1e} {:>9}",
            analysis.step_name(),
            column("INC"),
            column("ATT"),
            column("ITRS"),
            column("TIME"),
            column("RESIDUAL"),
            column("OPEN"),
            column("STICK"),
            column("SLIP"),
            column("ERESIDUAL") / scale,
            self.left(),
        );
        self.line(&text);
    }

    /// An increment was accepted that ends at this time.
    fn look(&mut self, analysis: &Analysis, time: f64) {
        if let Some(done) = part(&analysis.model.steps, analysis.frame.step, time) {
            let seconds = self.started.elapsed().as_secs_f64();
            self.remaining.note(done, seconds);
        }
    }

    /// The time that is left, if it is known.
    fn left(&self) -> String {
        match self.remaining.seconds() {
            None => "?".to_string(),
            Some(s) if s < 100.0 => format!("{s:.0} s"),
            Some(s) if s < 6000.0 => format!("{:.0} min", s / 60.0),
            Some(s) => format!("{:.1} h", s / 3600.0),
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
                    "{:<18} {:>4} {:>3} {:>3} {:>11.5e} ...",
                    analysis.step_name(),
                    a.increment,
                    a.attempt,
                    a.iterations,
                    a.time
                ));
            }
            Event::Increment(row) => self.increment(analysis, row),
            Event::Iteration(p) if self.verbose => {
                self.line(&format!(
                    "    {:>2}.{:<3} residual {:>9.2e}  step {:<7} krylov {:>3}  open {} stick {} slip {} changed {}{}",
                    p.round,
                    p.iteration,
                    p.residual,
                    p.step,
                    p.krylov,
                    p.tally.open,
                    p.tally.stick,
                    p.tally.slip,
                    p.tally.changed,
                    match p.strategy {
                        Strategy::Plain => String::new(),
                        strategy => format!("  ({})", strategy.name()),
                    }
                ));
            }
            Event::Finding(finding) if finding.severity >= Severity::Warning => {
                self.line(&found(finding));
            }
            Event::Note(text) => self.line(&format!("  {text}")),
            Event::Cutback(trial, failure) => {
                self.line(&format!(
                    "  cut back: {:.5e} to {:.5e}: {}",
                    trial.from, trial.to, failure.message
                ));
                for culprit in failure.culprits.iter().take(3) {
                    self.line(&format!("    {culprit}"));
                }
            }
            _ => {}
        }
        Ok(())
    }
}

/// A finding of the doctor in a line; `check` and `explain` say all of it.
pub fn found(finding: &Finding) -> String {
    format!(
        "{} ({}): {}",
        finding.severity, finding.cause, finding.message
    )
}

/// Says which figures of the quality gate are above their limits.
pub fn gate(gate: &Gate, findings: &[Finding]) {
    let word = if gate.failed() { "error" } else { "warning" };
    for figure in gate.violations() {
        say(&format!("{word}: quality: {}", figure.sentence(findings)));
    }
    if !gate.met {
        say("  the results are kept; `[quality]` in the problem file sets the limits");
    }
}

/// What a user wants to know at the end.
pub fn closing(analysis: &Analysis, directory: &Path) {
    let s = &analysis.summary;
    say(&format!(
        "done: {} increments, {} iterations, {} cut-backs, {}{} factorisations, {:.2} s",
        s.increments,
        s.iterations,
        s.cutbacks,
        match s.events {
            0 => String::new(),
            n => format!("{n} halvings to locate events, "),
        },
        s.solver.factorisations,
        s.phases.total
    ));
    if !s.friction_solvers.is_empty() {
        let each = s
            .friction_solvers
            .iter()
            .map(|(name, n)| format!("{n} by {name}"));
        say(&format!(
            "  solved as friction problems: {}",
            each.collect::<Vec<_>>().join("; ")
        ));
    }
    let p = &s.phases;
    say(&format!(
        "  read {:.2}, assemble {:.2}, order {:.2}, factor {:.2}, condense {:.2}, iterate {:.2}, contact {:.2}, recover {:.2}, write {:.2} s; {:.2e} flops, {:.2} GB",
        p.read,
        p.assemble,
        p.order,
        p.factor,
        p.condense,
        p.iterate,
        p.contact,
        p.recover,
        p.write,
        s.solver.flops,
        s.peak_memory as f64 / 1e9
    ));
    if s.relative_to_linear > 0.0 {
        say(&format!(
            "  without writing {:.2} times one assembly, factorisation and solution of the same bodies ({:.2} s)",
            s.relative_to_linear, s.linear_solve
        ));
    }
    if s.mass_added > 0.0 {
        say(&format!(
            "  mass scaling added {:.2} % to the mass of the bodies",
            100.0 * s.mass_added
        ));
    }
    if analysis.model.moves() {
        let q = &s.energy_quality;
        say(&format!(
            "  energy: the balance is open by {:.1e} of the energies in play{}",
            q.residual,
            if q.met {
                String::new()
            } else {
                format!(
                    ", more than the {:.1e} of `solver.energy-limit`: try other increments, or damping where bodies bounce",
                    q.limit
                )
            }
        ));
    }
    for i in &s.interfaces {
        say(&format!(
            "  {}: largest penetration {:.1e} of the cell size, {:.1e} of the elastic approach",
            i.name, i.quality.relative_to_size, i.relative_to_approach
        ));
        if let Some(n) = &i.numerical_stiffness {
            say(&format!(
                "  {}: independent of the numerical stiffness to {:.1e} % (factor {:.3e})",
                i.name,
                100.0 * n.independent_to,
                n.factor
            ));
        }
    }
    say(&format!("results in {}", directory.display()));
}

//! Progress on standard error: a line an increment.

use std::io::Write;
use std::path::Path;

use stickslip::Error;
use stickslip::newton::Course;
use stickslip::simulation::{Event, Gate, Observer, Simulation};

/// Prints what happens.
pub struct Progress {
    verbose: bool,
    headed: bool,
}

impl Progress {
    /// `verbose` shows every Newton iteration.
    pub fn new(verbose: bool) -> Self {
        Progress {
            verbose,
            headed: false,
        }
    }
}

/// Prints a line. A closed standard error is no reason to stop.
pub fn say(text: &str) {
    let _ = writeln!(std::io::stderr(), "{text}");
}

impl Observer for Progress {
    fn see(&mut self, simulation: &Simulation, event: Event) -> Result<(), Error> {
        match event {
            Event::Accepted(a) => {
                if !self.headed {
                    say(
                        "step                inc att its        time    residual     open  stick   slip",
                    );
                    self.headed = true;
                }
                say(&format!(
                    "{:<18} {:>4} {:>3} {:>3} {:>11.5e} {:>11.2e} {:>8} {:>6} {:>6}",
                    simulation.step_name(),
                    a.increment,
                    a.attempt,
                    a.iterations,
                    a.time,
                    a.residual,
                    a.tally.open,
                    a.tally.stick,
                    a.tally.slip
                ));
            }
            Event::Iteration(p) if self.verbose => {
                say(&format!(
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
                    match p.course {
                        Course::Plain => String::new(),
                        course => format!("  ({})", course.name()),
                    }
                ));
            }
            Event::Note(text) => say(&format!("  {text}")),
            Event::Cutback(trial, failure) => {
                say(&format!(
                    "  cut back: {:.5e} to {:.5e}: {}",
                    trial.from, trial.to, failure.message
                ));
                for culprit in failure.culprits.iter().take(3) {
                    say(&format!("    {culprit}"));
                }
            }
            _ => {}
        }
        Ok(())
    }
}

/// Says which figures of the quality gate are above their limits.
pub fn gate(gate: &Gate) {
    let word = if gate.failed() { "error" } else { "warning" };
    for figure in gate.violations() {
        say(&format!("{word}: quality: {}", figure.sentence()));
    }
    if !gate.met {
        say("  the results are kept; `[quality]` in the problem file sets the limits");
    }
}

/// What a user wants to know at the end.
pub fn closing(simulation: &Simulation, directory: &Path) {
    let s = &simulation.summary;
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
    if simulation.model.moves() {
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

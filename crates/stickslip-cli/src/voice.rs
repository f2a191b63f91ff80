//! What is said on standard error while an analysis goes on, and a message where nothing has been printed for a while.

use std::io::IsTerminal;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use serde_json::{Value, json};
use stickslip::error::shown;
use stickslip::newton::Strategy;
use stickslip::run::{Watch, Work};

use crate::print;
use stickslip::number::digits;

/// How long nothing may be said on a terminal, and in a file or a pipe.
const ON_TERMINAL: Duration = Duration::from_secs(3);
const IN_PIPE: Duration = Duration::from_secs(30);

/// How often is looked whether it is time to say something.
const LOOK: Duration = Duration::from_millis(500);

/// Who listens, and how long nothing may be said to them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Listener {
    Terminal,
    Pipe,
    /// Reads lines of JSON on standard output.
    Program,
}

impl Listener {
    fn patience(self) -> Duration {
        match self {
            Listener::Terminal => ON_TERMINAL,
            Listener::Pipe | Listener::Program => IN_PIPE,
        }
    }
}

/// Prints a line. A closed standard error is no reason to stop.
pub fn say(text: &str) {
    print::err(&format!("{text}\n"));
}

/// One voice for all who speak: cheap to clone.
#[derive(Clone)]
pub struct ProgressPrinter {
    state: Arc<Mutex<State>>,
}

struct State {
    /// Characters of the line that is to be overwritten.
    transient: usize,
    /// When something was said last.
    said: Instant,
    begun: Instant,
    doing: Doing,
}

impl ProgressPrinter {
    /// Nothing has been said yet.
    pub fn new() -> Self {
        let now = Instant::now();
        let state = State {
            transient: 0,
            said: now,
            begun: now,
            doing: Doing::default(),
        };
        ProgressPrinter {
            state: Arc::new(Mutex::new(state)),
        }
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// A line that stays.
    pub fn line(&self, text: &str) {
        self.state().line(text);
    }

    /// A line that the next one overwrites.
    pub fn passing(&self, text: &str) {
        self.state().passing(text);
    }

    /// Something was said elsewhere.
    pub fn is_heard(&self) {
        self.state().said = Instant::now();
    }

    /// What a simulation is to tell what it works on.
    pub fn watch(&self) -> Watch {
        let voice = self.clone();
        Arc::new(move |work: &Work| voice.state().doing.note(work, Instant::now()))
    }

    /// What is done now, where no simulation tells it.
    pub fn does(&self, what: &str) {
        self.state().doing.what = what.to_string();
    }

    /// One of several runs begins.
    pub fn begins(&self, run: &str) {
        self.state().doing = Doing {
            run: run.to_string(),
            what: "reading and assembling".to_string(),
            ..Doing::default()
        };
    }
}

impl State {
    fn line(&mut self, text: &str) {
        if self.transient > 0 {
            print::again(self.transient);
            self.transient = 0;
        }
        say(text);
        self.said = Instant::now();
    }

    fn passing(&mut self, text: &str) {
        let text = shown(text);
        let fill = " ".repeat(self.transient.saturating_sub(text.chars().count()));
        print::again(0);
        print::err(&format!("{text}{fill}"));
        print::again(0);
        self.transient = text.chars().count();
        self.said = Instant::now();
    }

    /// Says what is being worked on, if nothing has been said for so long.
    fn beat(&mut self, listener: Listener, patience: Duration) {
        if self.said.elapsed() < patience {
            return;
        }
        let now = Instant::now();
        match listener {
            Listener::Terminal => self.passing(&self.doing.sentence(self.begun, now)),
            Listener::Pipe => self.line(&self.doing.sentence(self.begun, now)),
            Listener::Program => {
                let event = self.doing.event(self.begun, now);
                // Whoever does not listen any more is told so by the next event of the run.
                let _ = print::out(&format!("{event}\n"));
                self.said = now;
            }
        }
    }
}

/// Prints a line when none was printed for a while, until it is dropped.
pub struct Heartbeat {
    over: Arc<(Mutex<bool>, Condvar)>,
    thread: Option<JoinHandle<()>>,
}

impl Heartbeat {
    /// Begins to listen to a voice that people hear.
    pub fn start(voice: &ProgressPrinter) -> Self {
        Heartbeat::to(
            match std::io::stderr().is_terminal() {
                true => Listener::Terminal,
                false => Listener::Pipe,
            },
            voice,
        )
    }

    /// Begins to listen to a voice that a program hears.
    pub fn to_program(voice: &ProgressPrinter) -> Self {
        Heartbeat::to(Listener::Program, voice)
    }

    fn to(listener: Listener, voice: &ProgressPrinter) -> Self {
        let over = Arc::new((Mutex::new(false), Condvar::new()));
        let (voice, ended) = (voice.clone(), Arc::clone(&over));
        let listen = move || {
            let (flag, condition) = &*ended;
            let mut over = flag.lock().unwrap_or_else(PoisonError::into_inner);
            while !*over {
                let waited = condition.wait_timeout(over, LOOK);
                over = waited.unwrap_or_else(PoisonError::into_inner).0;
                if !*over {
                    voice.state().beat(listener, listener.patience());
                }
            }
        };
        // Without it nothing is wrong but that it is quiet.
        let thread = std::thread::Builder::new().spawn(listen).ok();
        Heartbeat { over, thread }
    }
}

impl Drop for Heartbeat {
    fn drop(&mut self) {
        let (flag, condition) = &*self.over;
        *flag.lock().unwrap_or_else(PoisonError::into_inner) = true;
        condition.notify_all();
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

/// What is being worked on, as far as it was told.
#[derive(Default)]
struct Doing {
    /// Which run of several.
    run: String,
    /// Where there is no increment.
    what: String,
    step: String,
    /// Start and end of the increment, and its attempt.
    increment: Option<(f64, f64, usize)>,
    /// When that one began.
    since: Option<Instant>,
    /// Multiplier update, iteration and residual of the last Newton iteration, and the way it belongs to.
    iteration: Option<(usize, usize, f64, Strategy)>,
    /// Something beside iterations.
    beside: String,
}

impl Doing {
    fn note(&mut self, work: &Work, now: Instant) {
        self.beside.clear();
        match work {
            Work::Increment {
                step,
                from,
                to,
                attempt,
            } => {
                if self.step != *step {
                    self.step = (*step).to_string();
                }
                self.increment = Some((*from, *to, *attempt));
                self.since = Some(now);
                self.iteration = None;
            }
            Work::Iteration(p) => {
                self.iteration = Some((p.round, p.iteration, p.residual, p.strategy));
            }
            Work::Condensing => self.beside.push_str("freeing bodies of their interiors"),
            Work::Waiting => self.beside.push_str(
                "waiting for another process that frees the same bodies of their interiors",
            ),
            Work::Recovering(count) => {
                self.beside = format!("finding the interiors of {count} increments");
            }
            Work::Modes => self.beside.push_str("looking for modes"),
            Work::Following => self
                .beside
                .push_str("moving unconstrained bodies until they touch"),
        }
    }

    /// The same for programs; what is not known is null.
    fn event(&self, begun: Instant, now: Instant) -> Value {
        let seconds = |since: Instant| now.duration_since(since).as_secs_f64();
        let what = match (self.beside.as_str(), self.increment) {
            ("", None) => Some(&self.what),
            ("", Some(_)) => None,
            _ => Some(&self.beside),
        };
        let iteration = self.iteration.map(|(round, iteration, residual, strategy)| {
            json!({ "augmentation": round, "iteration": iteration, "residual": residual, "strategy": strategy.key() })
        });
        let increment = self.increment.map(|(from, to, attempt)| {
            json!({
                "step": self.step, "from": from, "to": to, "attempt": attempt,
                "seconds": self.since.map(seconds), "last": iteration,
            })
        });
        json!({ "event": "heartbeat", "seconds": seconds(begun), "what": what, "increment": increment })
    }

    /// What is going on, and for how long.
    fn sentence(&self, begun: Instant, now: Instant) -> String {
        let mut parts = Vec::new();
        if !self.run.is_empty() {
            parts.push(self.run.clone());
        }
        if let Some((from, to, attempt)) = self.increment {
            let spent = self
                .since
                .map_or(0.0, |s| now.duration_since(s).as_secs_f64());
            parts.push(format!(
                "{} {from} to {to}, attempt {attempt}, {spent:.0} s in it",
                self.step,
                from = digits(from, 6),
                to = digits(to, 6)
            ));
        }
        if !self.beside.is_empty() {
            parts.push(self.beside.clone());
        } else if let Some((round, iteration, residual, strategy)) = self.iteration {
            parts.push(format!(
                "iteration {round}.{iteration} done ({}), residual {residual}",
                strategy.name(),
                residual = digits(residual, 2)
            ));
        } else if self.increment.is_none() {
            parts.push(self.what.clone());
        }
        let all = now.duration_since(begun).as_secs_f64();
        format!("  ... {}; {all:.0} s in all", parts.join(": "))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use stickslip::newton::Progress;

    #[test]
    fn programs_hear_what_is_being_done() {
        let begun = Instant::now();
        let at = |seconds| begun + Duration::from_secs(seconds);
        let mut doing = Doing {
            what: "reading and assembling".into(),
            ..Doing::default()
        };
        let event = doing.event(begun, at(40));
        assert_eq!(event["event"], "heartbeat");
        assert_eq!(event["seconds"], 40.0);
        assert_eq!(event["what"], "reading and assembling");
        assert!(event["increment"].is_null());
        let increment = Work::Increment {
            step: "push",
            from: 0.25,
            to: 0.5,
            attempt: 2,
        };
        doing.note(&increment, at(50));
        doing.note(&Work::Recovering(16), at(60));
        let event = doing.event(begun, at(90));
        assert_eq!(event["increment"]["step"], "push");
        assert_eq!(event["increment"]["seconds"], 40.0);
        assert_eq!(event["what"], "finding the interiors of 16 increments");
        assert!(event["increment"]["last"].is_null());
    }

    #[test]
    fn nothing_is_said_where_something_has_just_been_said() {
        let voice = ProgressPrinter::new();
        let said = |voice: &ProgressPrinter| voice.state().said;
        let before = said(&voice);
        voice.state().beat(Listener::Program, Duration::MAX);
        assert_eq!(said(&voice), before);
        voice.state().beat(Listener::Program, Duration::ZERO);
        assert!(said(&voice) > before);
    }

    #[test]
    fn whatever_is_being_done_has_a_sentence() {
        let begun = Instant::now();
        let at = |seconds| begun + Duration::from_secs(seconds);
        let mut doing = Doing {
            what: "reading and assembling".into(),
            ..Doing::default()
        };
        assert_eq!(
            doing.sentence(begun, at(40)),
            "  ... reading and assembling; 40 s in all"
        );
        let increment = Work::Increment {
            step: "push",
            from: 0.25,
            to: 0.5,
            attempt: 2,
        };
        doing.note(&increment, at(50));
        assert_eq!(
            doing.sentence(begun, at(90)),
            "  ... push 0.25 to 0.5, attempt 2, 40 s in it; 90 s in all"
        );
        let progress = Progress {
            iteration: 7,
            round: 1,
            residual: 3.25e-4,
            step: 1.0,
            krylov: 3,
            tally: Default::default(),
            strategy: Strategy::FrictionProblem,
        };
        doing.note(&Work::Iteration(&progress), at(95));
        let said = doing.sentence(begun, at(100));
        assert!(
            said.contains("50 s in it: iteration 1.7 done (friction problem), residual 320e-6"),
            "{said}"
        );
        doing.note(&Work::Recovering(16), at(101));
        assert!(
            doing
                .sentence(begun, at(102))
                .contains("the interiors of 16 increments")
        );
    }
}

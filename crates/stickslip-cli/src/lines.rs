//! What happens in a run as lines of JSON, for programs.

use std::time::Instant;

use serde_json::json;
use stickslip::Error;
use stickslip::results::{Analysis, Event, Observer};

use crate::print;
use crate::remaining::{Remaining, part};
use crate::voice::ProgressPrinter;

/// Prints an object a line on standard output: `{"event": "increment", ...}`, `cutback`, `finding`, `note`, `end`; a [`Heartbeat`](crate::voice::Heartbeat) adds
/// `heartbeat` where nothing else is printed for half a minute.
pub struct Lines {
    voice: ProgressPrinter,
    started: Instant,
    remaining: Remaining,
}

impl Lines {
    /// Lines of a run that begins now.
    pub fn new(voice: ProgressPrinter) -> Self {
        Lines {
            voice,
            started: Instant::now(),
            remaining: Remaining::default(),
        }
    }

    /// An increment was accepted that ends at time `t`.
    fn look(&mut self, analysis: &Analysis, t: f64) {
        if let Some(done) = part(&analysis.model.steps, analysis.frame.step, t) {
            let seconds = self.started.elapsed().as_secs_f64();
            self.remaining.note(done, seconds);
        }
    }
}

impl Observer for Lines {
    fn see(&mut self, analysis: &Analysis, event: Event) -> Result<(), Error> {
        let line = match event {
            Event::Increment(row) => {
                let names = row.names.iter().cloned();
                // JSON has no NaN; what is not known is null.
                let values: serde_json::Map<_, _> =
                    names.zip(row.values.iter().map(|v| json!(v))).collect();
                let left = self.remaining.seconds();
                json!({ "event": "increment", "step": analysis.step_name(), "row": values, "seconds-left": left })
            }
            Event::Cutback(trial, failure) => json!({
                "event": "cutback", "from": trial.from, "to": trial.to,
                "cause": format!("{:?}", failure.cause), "message": failure.message, "culprits": failure.culprits.iter().map(ToString::to_string).collect::<Vec<_>>(),
            }),
            Event::Finding(finding) => json!({ "event": "finding", "finding": finding }),
            Event::Accepted(advance) => {
                self.look(analysis, advance.time);
                return Ok(());
            }
            Event::Modes(outcome) => json!({ "event": "modes", "modes": outcome }),
            Event::Note(text) => json!({ "event": "note", "text": text }),
            Event::End => json!({ "event": "end", "summary": analysis.summary }),
            _ => return Ok(()),
        };
        self.voice.is_heard();
        print::out(&format!("{line}\n"))
            .map_err(|e| Error::io(std::path::Path::new("standard output"), e))
    }
}

//! What happens in a run as lines of JSON, for programs.

use serde_json::json;
use stickslip::Error;
use stickslip::results::{Analysis, Event, Observer};

use crate::print;

/// Prints an object a line on standard output: `{"event": "increment", ...}`, `cutback`, `finding`, `note`, `end`.
#[derive(Debug, Default)]
pub struct Lines {}

impl Observer for Lines {
    fn see(&mut self, analysis: &Analysis, event: Event) -> Result<(), Error> {
        let line = match event {
            Event::Increment(row) => {
                let names = row.names.iter().cloned();
                // JSON has no NaN; what is not known is null.
                let values: serde_json::Map<_, _> =
                    names.zip(row.values.iter().map(|v| json!(v))).collect();
                json!({ "event": "increment", "step": analysis.step_name(), "row": values })
            }
            Event::Cutback(trial, failure) => json!({
                "event": "cutback", "from": trial.from, "to": trial.to,
                "cause": format!("{:?}", failure.cause), "message": failure.message, "culprits": failure.culprits.iter().map(ToString::to_string).collect::<Vec<_>>(),
            }),
            Event::Finding(finding) => json!({ "event": "finding", "finding": finding }),
            Event::Note(text) => json!({ "event": "note", "text": text }),
            Event::End => json!({ "event": "end", "summary": analysis.summary }),
            _ => return Ok(()),
        };
        print::out(&format!("{line}\n"))
            .map_err(|e| Error::io(std::path::Path::new("standard output"), e))
    }
}

//! The `.sta` file: a line an increment, in the columns of Abaqus.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use stickslip::Error;
use stickslip::io::write_atomically;
use stickslip::results::{Analysis, Event, Observer};

/// Writes the `.sta` file of a run.
#[derive(Debug)]
pub struct Status {
    path: PathBuf,
    text: String,
}

impl Status {
    /// A file with the two lines of headings.
    pub fn new(path: &Path) -> Self {
        Status {
            path: path.to_path_buf(),
            text: " SUMMARY OF JOB INFORMATION:\n STEP  INC ATT SEVERE EQUIL TOTAL  TOTAL      STEP       INC OF\n                 DISCON ITERS ITERS  TIME/      TIME/LPF   TIME/LPF\n                 ITERS               FREQ\n".into(),
        }
    }
}

impl Status {
    /// Goes on with the file that is there.
    ///
    /// # Errors
    /// [`Error::Io`] if it cannot be read.
    pub fn resume(self) -> Result<Self, Error> {
        let text = std::fs::read_to_string(&self.path).map_err(|e| Error::io(&self.path, e))?;
        Ok(Status { text, ..self })
    }
}

impl Observer for Status {
    fn see(&mut self, analysis: &Analysis, event: Event) -> Result<(), Error> {
        match event {
            Event::Increment(row) => {
                let column = |name: &str| row.get(name).unwrap_or(0.0);
                let step = column("STEP") as usize;
                let (time, dt) = (column("TIME"), column("DT"));
                let start = analysis
                    .model
                    .steps
                    .get(step.saturating_sub(1))
                    .map_or(0.0, |s| s.start);
                let iterations = column("ITRS") as usize;
                let _ = writeln!(
                    self.text,
                    "{step:>5} {:>4} {:>3} {:>6} {:>5} {:>5} {:>10} {:>10} {:>10}",
                    column("INC") as usize,
                    column("ATT") as usize,
                    0,
                    iterations,
                    iterations,
                    short(time),
                    short(time - start),
                    short(dt)
                );
            }
            Event::Checkpoint(_) => write_atomically(&self.path, self.text.as_bytes())?,
            Event::End => {
                let total = analysis.model.steps.last().map_or(0.0, |s| s.end);
                self.text
                    .push_str(match analysis.frame.state.t >= total * (1.0 - 1e-12) {
                        true => "\n THE ANALYSIS HAS COMPLETED SUCCESSFULLY\n",
                        false => "\n THE ANALYSIS HAS NOT BEEN COMPLETED\n",
                    });
                write_atomically(&self.path, self.text.as_bytes())?;
            }
            _ => {}
        }
        Ok(())
    }
}

/// A time in ten characters.
fn short(t: f64) -> String {
    let plain = format!("{t:.6}");
    match (t == 0.0 || t >= 1e-3) && plain.len() <= 10 {
        true => plain
            .trim_end_matches('0')
            .trim_end_matches('.')
            .to_string(),
        false => format!("{t:.3e}"),
    }
}

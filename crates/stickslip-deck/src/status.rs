//! The `.sta` file: a line an increment, in the columns of Abaqus.

use std::path::{Path, PathBuf};

use stickslip::Error;
use stickslip::io::Growing;
use stickslip::results::{Analysis, Event, Observer};

/// The lines of headings.
const HEAD: &str = " SUMMARY OF JOB INFORMATION:\n STEP  INC ATT SEVERE EQUIL TOTAL  TOTAL      STEP       INC OF\n                 DISCON ITERS ITERS  TIME/      TIME/LPF   TIME/LPF\n                 ITERS               FREQ\n";

/// Writes the `.sta` file of a run, a line when an increment is told of.
#[derive(Debug)]
pub struct Status {
    path: PathBuf,
    /// Made by the first thing that is to be in it, or to be read from it.
    file: Option<Growing>,
}

impl Status {
    /// A file with the lines of headings, when there is more.
    pub fn new(path: &Path) -> Self {
        Status {
            path: path.to_path_buf(),
            file: None,
        }
    }

    /// Goes on with the file that is there.
    ///
    /// # Errors
    /// [`Error::Io`] if it cannot be opened.
    pub fn resume(self) -> Result<Self, Error> {
        let file = Some(Growing::resume(&self.path)?);
        Ok(Status { file, ..self })
    }

    fn add(&mut self, text: &str) -> Result<(), Error> {
        let file = match self.file.take() {
            Some(file) => file,
            None => Growing::create(&self.path, HEAD)?,
        };
        self.file.insert(file).add(text)
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
                self.add(&format!(
                    "{step:>5} {:>4} {:>3} {:>6} {:>5} {:>5} {:>10} {:>10} {:>10}\n",
                    column("INC") as usize,
                    column("ATT") as usize,
                    0,
                    iterations,
                    iterations,
                    short(time),
                    short(time - start),
                    short(dt)
                ))?;
            }
            // What is noted of how far it is has to find it.
            Event::Checkpoint(_) => self.add("")?,
            Event::End => {
                let total = analysis.model.steps.last().map_or(0.0, |s| s.end);
                self.add(match analysis.frame.state.t >= total * (1.0 - 1e-12) {
                    true => "\n THE ANALYSIS HAS COMPLETED SUCCESSFULLY\n",
                    false => "\n THE ANALYSIS HAS NOT BEEN COMPLETED\n",
                })?;
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

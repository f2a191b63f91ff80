//! One run of a sweep.

use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

use stickslip::Error;
use stickslip::io::own;
use stickslip::model::Setup;
use stickslip::newton::condensed::Library;
use stickslip::results::{Claim, Observer, ResultFiles, Summary};
use stickslip::run::{Interrupt, Simulation, Watch};

use super::columns::Columns;
use crate::failure::Failure;
use crate::input::Input;

/// What runs share.
pub struct Shared {
    /// Factors of bodies that stay the same.
    pub library: Arc<Library>,
    /// Whether the user wants to stop.
    pub interrupt: Interrupt,
    /// Who is told what is being worked on.
    pub watch: Watch,
    /// Who may have been killed in a folder of results, see [`Claim::dead`].
    pub dead: Option<String>,
}

/// How a run ended: its error if it failed, and what is known of it if there was a simulation.
pub struct Ended {
    pub error: Option<Failure>,
    pub summary: Option<Summary>,
}

impl Ended {
    /// `done`, what the quality gate found, or why not, in one line.
    pub fn outcome(&self) -> String {
        let quality = self.summary.as_ref().map(|s| &s.quality);
        let poor = quality.filter(|q| q.failed());
        match (&self.error, poor.and_then(|q| q.violations().next())) {
            (Some(error), _) => error.line(),
            (None, Some(figure)) => format!("quality: {}", figure.brief()),
            (None, None) => "done".into(),
        }
    }
}

/// From the problem file to the end of its run.
pub fn analyse(
    input: Result<Input, Failure>,
    directory: Option<&Path>,
    columns: &mut Columns,
    shared: &Shared,
) -> Ended {
    let failed = |error| Ended {
        error: Some(error),
        summary: None,
    };
    let started = Instant::now();
    let built = input.and_then(|input| Ok((input.build()?, input.files())));
    let (setup, inputs) = match built {
        Ok(built) => built,
        Err(e) => return failed(e),
    };
    let read = started.elapsed().as_secs_f64();
    let mut observers: Vec<&mut dyn Observer> = vec![columns];
    let claim = Claim {
        inputs,
        alike: true,
        dead: shared.dead.clone(),
        ..Claim::default()
    };
    let files = directory.map(|directory| {
        // It lies within the folder of the sweep, and what lies there may be a link out of it.
        own::is_own_folder(directory).map_err(|e| Error::io(directory, e))?;
        ResultFiles::new(directory, &claim)
    });
    let mut files = match files.transpose() {
        Ok(files) => files,
        Err(e) => return failed(e.into()),
    };
    if let Some(files) = &mut files {
        observers.push(files);
    }
    simulate(setup, read, &mut observers, shared)
}

/// Runs a model. The one place where a sweep makes a simulation.
fn simulate(
    setup: Setup,
    read: f64,
    observers: &mut [&mut dyn Observer],
    shared: &Shared,
) -> Ended {
    match Simulation::with_library(setup, Arc::clone(&shared.library)) {
        Ok(mut simulation) => {
            simulation.run.summary.cost.phases.read = read;
            simulation.set_interrupt(Arc::clone(&shared.interrupt));
            simulation.set_watch(Arc::clone(&shared.watch));
            let error = simulation.run(observers).err();
            Ended {
                error: error.map(Failure::from),
                summary: Some(simulation.run.summary),
            }
        }
        Err(error) => Ended {
            error: Some(error.into()),
            summary: None,
        },
    }
}

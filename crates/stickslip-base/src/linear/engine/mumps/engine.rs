use std::sync::Arc;
use std::sync::atomic::Ordering;

use super::body::Body;
use super::job::Job;
use super::options::MumpsOptions;
use crate::linear::engine::bare::Undivided;
use crate::linear::engine::contract::{Analysed, Cut, Engine, EngineReport};
use crate::linear::engine::split::Split;
use crate::linear::{LinearError, Matrix};

/// MUMPS on the ranks of an MPI job, which ends with the last factor of its bodies.
#[derive(Debug)]
pub struct Mumps {
    options: MumpsOptions,
    job: Arc<Job>,
}

impl Mumps {
    /// Starts the ranks.
    ///
    /// # Errors
    /// [`LinearError::Engine`] with what is missing.
    pub fn start(options: MumpsOptions) -> Result<Mumps, LinearError> {
        let job = Arc::new(Job::start(options.ranks)?);
        Ok(Mumps { options, job })
    }
}

impl Engine for Mumps {
    fn report(&self) -> EngineReport {
        let [rank, all] = &self.job.memory;
        let dealt = self.job.dealt().clone();
        EngineReport {
            name: "mumps",
            version: self.job.version.clone(),
            ranks: self.options.ranks,
            reproducible: false,
            memory_of_rank: rank.load(Ordering::Relaxed),
            memory_of_all: all.load(Ordering::Relaxed),
            cells_of_ranks: dealt.cells,
            bytes_of_ranks: dealt.bytes,
            entries_dealt: dealt.entries,
        }
    }

    fn identity(&self) -> u64 {
        self.options.identity()
    }

    fn is_alive(&self) -> bool {
        self.job.is_alive()
    }

    fn order(
        self: Arc<Self>,
        matrix: &dyn Matrix,
        body: Cut,
    ) -> Result<Arc<dyn Analysed>, LinearError> {
        let split = Split::new(matrix, body)?;
        if split.interior.is_empty() {
            // There is nothing to eliminate, as in rigid bodies.
            return Ok(Arc::new(Undivided(split)));
        }
        Ok(Arc::new(Body::new(
            Arc::clone(&self.job),
            self.options,
            split,
        )))
    }
}

//! What is being worked on, for somebody who waits: told while an attempt goes on, of which observers hear when it is over.

use std::sync::Arc;

use crate::newton::Progress;

/// Something that may take a while, when it begins.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Work<'a> {
    /// An increment is tried.
    Increment {
        /// Name of its step.
        step: &'a str,
        /// Its start `[s]`.
        from: f64,
        /// Its end `[s]`.
        to: f64,
        /// How often it, or a longer one from the same start, was tried, from 1.
        attempt: usize,
    },
    /// A Newton iteration is over; the next begins.
    Iteration(&'a Progress),
    /// Bodies are freed of their interiors.
    Condensing,
    /// Another process is doing that with the same body, and its result is waited for.
    Waiting,
    /// The interiors of so many increments are found.
    Recovering(usize),
    /// Modes are looked for.
    Modes,
    /// Unconstrained bodies are moved until they touch.
    Following,
}

/// Who is told, on the thread on which the analysis goes on, and often: it has to be quick.
pub type Watch = Arc<dyn Fn(&Work) + Send + Sync>;

/// Iterations that observers have not been told of, and who was told at once.
#[derive(Default)]
pub(crate) struct Seen {
    iterations: Vec<Progress>,
    pub watch: Option<Watch>,
}

impl Seen {
    /// Something begins.
    pub fn tell(&self, work: &Work) {
        if let Some(watch) = &self.watch {
            watch(work);
        }
    }

    /// An iteration is over.
    pub fn push(&mut self, progress: &Progress) {
        self.tell(&Work::Iteration(progress));
        self.iterations.push(*progress);
    }

    /// What observers have not been told of.
    pub fn take(&mut self) -> Vec<Progress> {
        self.iterations.drain(..).collect()
    }

    /// Forgets what observers have not been told of.
    pub fn clear(&mut self) {
        self.iterations.clear();
    }
}

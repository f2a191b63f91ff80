//! What comes of an analysis: history, fields, summary, files, and their comparison with what is expected.

pub(crate) mod analysis;
pub mod compare;
pub(crate) mod fatigue;
pub(crate) mod files;
pub(crate) mod folder;
pub(crate) mod frd;
mod free_bodies;
mod growth;
pub(crate) mod history;
pub(crate) mod loops;
pub(crate) mod modes;
pub(crate) mod observer;
pub(crate) mod saved;
pub(crate) mod sealed;
mod slip_events;
pub(crate) mod summary;

pub use analysis::Analysis;
pub use files::{ResultFiles, fields};
pub use folder::{Claim, FileClaim, FolderClaim, OPPOSITE, running};
pub use frd::{Due, FrdPlan, Quantity, Request};
pub use history::Row;
pub use observer::{Advance, Event, Observer, Snapshot};
pub use saved::{Lent, Saved, Source, checkpoints, digest_of};
pub use sealed::{digest_of_state, seal, unseal};
pub use summary::{
    AttemptCounts, EnergySummary, ExplicitStart, FollowedBodies, Phases, RunCost, RunOutcome,
    SolvedBy, Status, Summary, Vibrations,
};

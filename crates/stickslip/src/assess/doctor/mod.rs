//! The doctor: what is wrong with a model or a run, what is suspect, and what to try.
//!
//! Before the run `examine` looks at the model: motions that nothing can hold, gaps and overlaps, surfaces that do not face each other, meshes
//! that do not go together, numbers in mixed units. In the run every attempt that fails is turned into a [`Finding`]: the cause is read from what
//! the points of the interfaces did ([`Evidence`](crate::system::Evidence)), from unconstrained motions, and from the stiffness at the suspect
//! points. Findings of both kinds are the same type; they go into `summary.json`, and their places into `culprits.vtu`.
//!
//! The doctor only looks: nothing here changes a result.

mod balance;
mod check;
mod coupling;
mod culprits;
mod diagnose;
mod finding;
mod friction;
mod motions;
mod places;
mod record;
mod released;
mod signs;
mod suspect;
mod unjoined;
mod watch;

pub use check::WIDEST_CONTACT;
pub use finding::{DoctorCause, Finding, MOST_SUSPECTS};
pub use suspect::{LocationKind, Severity, Suspect};

pub(crate) use balance::refuse_unbalanced;
pub(crate) use check::{examine, longest_way};
pub(crate) use culprits::write as write_culprits;
pub(crate) use diagnose::{MORE_MEMORY, diagnose, singular_help, stopped};
pub(crate) use places::body as body_at;
pub(crate) use record::{Counters, mistake, note};
pub(crate) use released::let_go;
pub(crate) use unjoined::MissingInterface;
pub use watch::Peak;
pub(crate) use watch::{Watch, watched};

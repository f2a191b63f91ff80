//! What is common to all forces: state, degrees of freedom, the [`Force`] trait, assembly, constraints, rigid bodies, amplitudes.

mod amplitude;
mod assembler;
mod constraints;
mod dofs;
mod failure;
mod fields;
mod force;
mod links;
mod schedule;

pub use amplitude::{Amplitude, AmplitudeError};
pub use assembler::{Assembler, ContactBlock, ContactPair, Tangent};
pub use constraints::Constraints;
pub use dofs::{Component, Dofs, Motion};
pub use failure::{Cause, Culprit, Evidence, Otherwise, StepFailure};
pub use fields::{Field, Fields, Location};
pub use force::{ActiveSet, Augmentation, Energy, Force, PointAlone, Rate, Stage, State, Tally};
pub use links::{Follower, Freedom, Link, Links, Row};
pub use schedule::{Course, Piece, Schedule};

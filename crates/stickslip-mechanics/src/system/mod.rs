//! What is common to all forces: state, degrees of freedom, the [`Force`] trait, assembly, constraints, rigid bodies, frames of bodies that turn, amplitudes.

mod amplitude;
mod assembler;
mod body_frames;
mod body_model;
mod constraints;
mod corotation;
mod dofs;
mod failure;
mod fields;
mod force;
mod frame_pose;
mod in_space;
mod links;
mod schedule;
mod spinning;

pub use amplitude::{Amplitude, AmplitudeError};
pub use assembler::{Assembler, ContactBlock, ContactPair, Tangent};
pub use body_frames::{BodyFrame, BodyFrames, Carrier};
pub use body_model::{BodyModel, Deformed, NonlinearBody, Product};
pub use constraints::Constraints;
pub use corotation::{BodyTurn, Corotations, frame_of};
pub use dofs::{Component, Dofs, Motion};
pub use failure::{Cause, Culprit, Evidence, Otherwise, StepFailure};
pub use fields::{Field, Fields, Location};
pub use force::{ActiveSet, Augmentation, Energy, Force, Rate, Stage, State, StickTrial, Tally};
pub use frame_pose::{FramePose, rotation_vector};
pub use in_space::InSpace;
pub use links::{DependentNode, Freedom, Link, Links, Row};
pub use schedule::{Course, Piece, Schedule};
pub use spinning::{Carried, IncrementalRotation};

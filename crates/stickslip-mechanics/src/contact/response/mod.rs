//! From gap and slip to traction.

mod input;
mod laws;
mod outcome;
pub(crate) mod respond;
mod shear;

pub use input::{Answers, Kept, LawInput, Sliding, Stiffnesses, Worn};
pub use laws::{Laws, OwnFriction};
pub use outcome::{Response, Status};

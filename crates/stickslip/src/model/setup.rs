//! What a problem is built to.

use super::contact::Contact;
use super::definition::Model;

/// What a problem is built to, and a simulation begins with.
pub struct Setup {
    /// What is simulated.
    pub model: Model,
    /// Interfaces and couplings before anything has happened.
    pub contact: Contact,
    /// What a user should know of how it was made.
    pub notes: Vec<String>,
}

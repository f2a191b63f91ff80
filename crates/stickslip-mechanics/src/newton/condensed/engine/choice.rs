use std::fmt::Debug;
use std::sync::Arc;

use crate::linear::{Engine, LinearError};

/// An engine that has been chosen.
pub trait EngineChoice: Debug {
    /// Makes it ready.
    ///
    /// # Errors
    /// [`LinearError::Engine`] with what is missing.
    fn start(&self) -> Result<Arc<dyn Engine>, LinearError>;

    /// Whether it is chosen for condensed bodies alone, so that the way to solve is no question.
    fn condenses(&self) -> bool;
}

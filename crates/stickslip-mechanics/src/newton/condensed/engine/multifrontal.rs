use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::EngineChoice;
use crate::linear::{self, Engine, LinearError};
use crate::registry::Samples;

/// The built-in multifrontal factorisation, on the threads of this process: the same bits in every run, on any number of threads. No parameters.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct Multifrontal {}

impl EngineChoice for Multifrontal {
    fn start(&self) -> Result<Arc<dyn Engine>, LinearError> {
        Ok(Arc::new(linear::Multifrontal))
    }

    fn condenses(&self) -> bool {
        false
    }
}

impl Samples for Multifrontal {
    fn samples() -> Vec<Self> {
        vec![Multifrontal {}]
    }
}

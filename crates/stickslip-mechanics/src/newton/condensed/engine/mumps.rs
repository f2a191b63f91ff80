use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::EngineChoice;
use crate::linear::{self, Engine, LinearError, MumpsOptions};
use crate::registry::Samples;

/// MUMPS on the ranks of an MPI job: one body over many processes, for factors that are too large for one.
///
/// The job is started by `mpirun`, the program of its ranks is built by `cargo xtask engine mumps`. Last digits may differ from run to run.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields, default)]
pub struct Mumps {
    /// Processes.
    #[cfg_attr(feature = "schema", schemars(range(min = 1)))]
    pub ranks: usize,
    /// Whether factors are kept in files instead of in memory.
    pub out_of_core: bool,
    /// Accuracy, relative to the matrix, to which blocks of the factor are compressed: less work for large bodies. Nothing is compressed if not given.
    #[cfg_attr(feature = "schema", schemars(extend("exclusiveMinimum" = 0, "exclusiveMaximum" = 1)))]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub low_rank: Option<f64>,
    /// Most memory that a rank may take for a body, in MB: a body that takes more is refused. No limit if not given.
    #[cfg_attr(feature = "schema", schemars(extend("exclusiveMinimum" = 0)))]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub memory: Option<f64>,
    /// Whether the compliance of the contact candidates stays with the ranks. If not given, where it would take more than half of what is free in the first process.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub spread: Option<bool>,
}

impl Default for Mumps {
    fn default() -> Self {
        Mumps {
            ranks: 1,
            out_of_core: false,
            low_rank: None,
            memory: None,
            spread: None,
        }
    }
}

impl EngineChoice for Mumps {
    fn start(&self) -> Result<Arc<dyn Engine>, LinearError> {
        let engine = linear::Mumps::start(MumpsOptions {
            ranks: self.ranks,
            out_of_core: self.out_of_core,
            low_rank: self.low_rank,
            memory: self.memory.map(|mb| (1e6 * mb) as u64),
            spread: self.spread,
        })?;
        Ok(Arc::new(engine))
    }

    fn condenses(&self) -> bool {
        true
    }
}

impl Samples for Mumps {
    fn samples() -> Vec<Self> {
        let compressed = Mumps {
            ranks: 4,
            out_of_core: true,
            low_rank: Some(1e-10),
            memory: Some(2000.0),
            spread: Some(true),
        };
        vec![Mumps::default(), compressed]
    }
}

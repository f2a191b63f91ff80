use std::fmt;

use crate::machine::{self, available_memory};
use crate::number::digits;

/// Why a linear system could not be analysed, factored or solved.
#[derive(Debug, Clone, PartialEq)]
pub enum LinearError {
    /// A value is NaN or infinite in the row of this dof.
    NotFinite {
        /// The dof.
        dof: usize,
    },
    /// The pivot of this dof is zero or negative: the matrix is singular or indefinite.
    NotPositive {
        /// The dof.
        dof: usize,
    },
    /// Next to nothing is left of the diagonal of this dof: the matrix is singular up to rounding.
    /// An unconstrained body ends here or in [`NotPositive`](LinearError::NotPositive).
    Singular {
        /// The dof.
        dof: usize,
        /// What elimination leaves of the diagonal, relative to it \[1\].
        ratio: f64,
    },
    /// The matrix of a body without its kept dofs is singular or indefinite, up to rounding; where, is not known.
    Indefinite,
    /// An extra block couples these two dofs, which the symbolic analysis did not foresee: analyse again.
    NotAnalysed {
        /// The two dofs.
        dofs: [usize; 2],
    },
    /// The factor does not fit into memory.
    OutOfMemory {
        /// Its size \[bytes\], zero if not known.
        bytes: u64,
    },
    /// The engine cannot be used, or cannot go on.
    Engine {
        /// In a sentence.
        message: String,
        /// What to try.
        help: String,
    },
}

impl LinearError {
    /// Refuses to take `bytes` of memory where less is free: on most systems memory is promised without being there, and who takes it is
    /// killed without a word.
    ///
    /// # Errors
    /// [`LinearError::OutOfMemory`].
    pub fn unless_free(bytes: u64) -> Result<(), LinearError> {
        match available_memory() {
            Some(free) if bytes > free => Err(LinearError::OutOfMemory { bytes }),
            _ => Ok(()),
        }
    }

    /// The dof to look at, if there is one.
    pub fn dof(&self) -> Option<usize> {
        match *self {
            LinearError::NotFinite { dof }
            | LinearError::NotPositive { dof }
            | LinearError::Singular { dof, .. } => Some(dof),
            LinearError::NotAnalysed { dofs } => Some(dofs[0]),
            LinearError::Indefinite
            | LinearError::OutOfMemory { .. }
            | LinearError::Engine { .. } => None,
        }
    }
}

/// Zeros, or the news that they do not fit.
pub(super) fn zeros(length: usize) -> Result<Vec<f64>, LinearError> {
    bytemuck::try_zeroed_vec(length).map_err(|()| LinearError::OutOfMemory {
        bytes: 8 * length as u64,
    })
}

impl fmt::Display for LinearError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            LinearError::NotFinite { dof } => {
                write!(f, "the stiffness is not a finite number at dof {dof}")
            }
            LinearError::NotPositive { dof } => write!(
                f,
                "the stiffness is singular or not positive definite at dof {dof}"
            ),
            LinearError::Singular { dof, ratio } => write!(
                f,
                "the stiffness is singular: elimination leaves {ratio} of the diagonal at dof {dof}",
                ratio = digits(ratio, 2)
            ),
            LinearError::Indefinite => write!(
                f,
                "the stiffness is singular or not positive definite inside a body"
            ),
            LinearError::NotAnalysed { dofs: [i, j] } => write!(
                f,
                "dofs {i} and {j} are coupled outside the analysed pattern"
            ),
            LinearError::Engine { message, .. } => write!(f, "{message}"),
            LinearError::OutOfMemory { bytes: 0 } => {
                write!(f, "the factorisation does not fit into memory")
            }
            LinearError::OutOfMemory { bytes } => write!(
                f,
                "the factorisation takes {}, more memory than is free",
                machine::bytes(*bytes)
            ),
        }
    }
}

impl std::error::Error for LinearError {}

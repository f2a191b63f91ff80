use std::fmt::Debug;
use std::ops::Range;
use std::sync::Arc;

use crate::linear::{LinearError, Matrix, PartialFactor, Schur, Workspace};

/// Points of a matrix that are one body, one mark a dof of the matrix that is no unknown, and one mark a point that is kept.
pub type Cut<'a> = (Range<usize>, &'a [bool], &'a [bool]);

/// Eliminates the interiors of bodies.
pub trait Engine: Debug + Send + Sync {
    /// What it is, for the summary.
    fn report(&self) -> EngineReport;

    /// What tells its factors from those of other engines; 0 is the built-in one.
    fn identity(&self) -> u64;

    /// Whether it can still be used: processes may die.
    fn is_alive(&self) -> bool {
        true
    }

    /// Whether its factors can be written to files, for other processes to read.
    fn keeps_files(&self) -> bool {
        false
    }

    /// Orders a body, before any arithmetic.
    ///
    /// # Errors
    /// [`LinearError::NotAnalysed`] if a free dof of the body is coupled to a free dof of another; [`LinearError::OutOfMemory`].
    fn order(
        self: Arc<Self>,
        matrix: &dyn Matrix,
        body: Cut,
    ) -> Result<Arc<dyn Analysed>, LinearError>;
}

/// A body before it is factored.
pub trait Analysed: Debug + Send + Sync {
    /// The eliminated dofs, in the order of vectors that [`Interior`] takes.
    fn interior(&self) -> &[u32];

    /// The kept free dofs, ascending.
    fn root(&self) -> &[u32];

    /// What it will take, as far as that is known here.
    fn effort(&self) -> FactorEffort;

    /// The most numbers that a factorisation asks of its workspace at once.
    fn longest(&self) -> usize;

    /// About the memory held here `[bytes]`.
    fn bytes(&self) -> u64;

    /// Whether it can still be factored.
    fn is_alive(&self) -> bool {
        true
    }

    /// Whether the compliance of the kept dofs will be in this process.
    fn compliance_is_here(&self) -> bool {
        true
    }

    /// What the user should know.
    fn note(&self) -> Option<String> {
        None
    }

    /// Factors the body. Returns the Schur complement of the kept dofs too.
    ///
    /// # Errors
    /// [`LinearError::NotAnalysed`] as for [`order`](Engine::order), where it was not seen there; [`LinearError::NotFinite`], [`LinearError::NotPositive`], [`LinearError::Singular`] with the dof to look at; [`LinearError::OutOfMemory`];
    /// [`LinearError::Engine`].
    fn factor(
        self: Arc<Self>,
        matrix: &dyn Matrix,
        workspace: &Workspace,
    ) -> Result<(Box<dyn Interior>, Schur), LinearError>;
}

/// The factor of the interior of a body. Vectors are in the order of [`Analysed::interior`] and [`Analysed::root`], several columns one after the other.
pub trait Interior: Debug + Send + Sync {
    /// What was factored.
    fn ordered(&self) -> &dyn Analysed;

    /// Reduces forces: `root -= K_CI K_II⁻¹ f_I`. Leaves in `interior` what [`recover`](Interior::recover) wants of them, which is linear in the forces.
    ///
    /// # Errors
    /// [`LinearError::Engine`].
    ///
    /// # Panics
    /// If `interior` or `root` has the wrong length.
    fn reduce(
        &self,
        interior: &mut [f64],
        root: &mut [f64],
        columns: usize,
    ) -> Result<(), LinearError>;

    /// Displacements of the interior, in place of what [`reduce`](Interior::reduce) has left; `root` has those of the kept dofs.
    ///
    /// # Errors
    /// [`LinearError::Engine`].
    ///
    /// # Panics
    /// If `interior` or `root` has the wrong length.
    fn recover(
        &self,
        interior: &mut [f64],
        root: &[f64],
        columns: usize,
    ) -> Result<(), LinearError>;

    /// About the memory held in this process `[bytes]`.
    fn bytes(&self) -> u64;

    /// What factoring took, where that is known only afterwards.
    fn effort(&self) -> FactorEffort;

    /// The factor as one that can be written to a file.
    fn to_file(&self) -> Option<&PartialFactor> {
        None
    }

    /// Why it cannot be used any more.
    fn fault(&self) -> Option<LinearError> {
        None
    }
}

/// What a factor takes.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct FactorEffort {
    /// Additions and multiplications; 0 if not known.
    pub flops: f64,
    /// Entries; 0 if not known.
    pub nonzeros: f64,
    /// Peak memory in this process `[bytes]`.
    pub bytes: u64,
}

/// An engine as the summary has it.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct EngineReport {
    /// Its key in the problem file.
    pub name: &'static str,
    /// Its version.
    pub version: String,
    /// Processes that factor.
    pub ranks: usize,
    /// Whether results have the same bits in every run.
    pub reproducible: bool,
    /// Largest memory of one of these processes so far `[bytes]`; 0 for this one.
    pub memory_of_rank: u64,
    /// The sum of what each of them has taken at most `[bytes]`.
    pub memory_of_all: u64,
    /// Cells of all bodies whose matrices each of them has made; empty where this process has made all.
    pub cells_of_ranks: Vec<u64>,
    /// What each of them was sent for that `[bytes]`.
    pub bytes_of_ranks: Vec<u64>,
    /// Entries that this process has made for them, sums of which it has sent.
    pub entries_dealt: u64,
}

//! All state from which an analysis goes on, as plain data that can be written and read back.
//!
//! Between two increments an analysis consists of
//!
//! | what | where | in a checkpoint |
//! |---|---|---|
//! | the model and the definitions of interfaces and couplings | `Model`, `Contact` | built again from the problem |
//! | laws that steps have changed | `Interface::laws` | changed again, step by step |
//! | step, state, forces, starts of supports, direction, ledger; histories of interfaces, multipliers and targets of couplings | `Frame` | as it is |
//! | holds of couplings | `CouplingsState` | as they are |
//! | under which conditions interfaces are evaluated; the end of their last attempt; places of their last search, slopes and nodes of their last evaluation | `Memory` | as they are; facets found again |
//! | increments that wait for their interiors, or to be reported; an attempt that failed and waits until they are | `Pending`, `Failed` | as they are |
//! | how far the steps are: increments, attempts, the length that is wished, jumps over cycles | `Steps` | as it is |
//! | damping forces and constraints of an explicit step | `ExplicitState` | as they are; masses, springs and frequencies made again |
//! | the way to solve, candidates, condensed state and direction, floating bodies with their anchors, counts | `SolverState` | as they are |
//! | factors, hierarchies, condensed bodies, load patterns, the matrices of increments in motion | `SolverState` | what they were made of |
//! | figures, findings, notes, counts, the last row; the cycle at hand | `Summary`, `Watch`, `Loop` | as they are |
//! | points at which criteria of fatigue are asked | `Watched` | nothing: functions of the model |
//! | facets, boxes, evaluations, projections | `Cache` | nothing: functions of the above |
//! | cells at probes, shares of bodies by point, pairs of bodies that nothing joins | `Run` | nothing: functions of the model |
//!
//! Condensed increments that wait are in those that observers are handed only where a run is stopped: how many interiors are found together shows in
//! their last digits. They are reported twice then, and who goes on cuts back what they left. Others are taken where none waits.
//!
//! Where jumps over cycles are chosen there is a checkpoint between two blocks only: what a block has found may be taken back.
//!
//! An attempt changes nothing of this but what is in [`AttemptState`]; a run that is stopped in the middle of one goes back to that of its beginning, so that
//! the increment is tried again with the same bits.

use std::collections::VecDeque;
use std::path::Path;

use super::jumps::Jumps;
use super::queue::{Failed, Pending};
use crate::assess::doctor::Watch;
use crate::body::couplings::CouplingsState;
use crate::contact::interface::Memory;
use crate::error::{Error, IoError};
use crate::integrate::explicit::ExplicitState;
use crate::model::frame::Frame;
use crate::results::loops::Loop;
use crate::results::saved::Saved;
use crate::results::sealed::{laid_out, read};
use crate::results::summary::Summary;
use crate::solve::state::SolverState;
use crate::time::Pace;

/// All state from which an analysis goes on.
#[derive(Clone, crate::keep::Keep)]
pub struct Checkpoint {
    pub(super) frame: Frame,
    pub(super) position: Position,
    /// Increments that wait for their interiors.
    pub(super) pending: Vec<Pending>,
    /// Those whose interiors are known and that have not been reported.
    pub(super) recovered: Option<VecDeque<Pending>>,
    pub(super) summary: Summary,
    pub(super) watches: Vec<Watch>,
    pub(super) loops: Vec<Loop>,
    pub(super) working: AttemptState,
}

/// How far the steps are.
#[derive(Clone, crate::keep::Keep)]
pub(super) struct Position {
    pub next: usize,
    pub running: Option<StepProgress>,
    /// The analysis has ended, well or not.
    pub over: bool,
}

/// Where the increments of the step at hand stand: their length, how many were accepted, the attempt, and what [`Increments`] knows of the balance.
///
/// [`Increments`]: super::position::Increments
#[derive(Clone, crate::keep::Keep)]
pub(super) struct StepProgress {
    pub pace: Pace,
    pub accepted: usize,
    pub attempt: usize,
    pub opened: Option<(f64, i32)>,
    pub no_progress: bool,
    pub too_long: f64,
    pub tight: bool,
    pub failed: Option<Failed>,
    pub jumps: Jumps,
}

/// The state that attempts change.
#[derive(Clone, crate::keep::Keep)]
pub(crate) struct AttemptState {
    pub(super) interfaces: Vec<Memory>,
    pub(super) couplings: CouplingsState,
    pub(super) explicit: Option<ExplicitState>,
    pub(super) solver: SolverState,
}

impl Checkpoint {
    /// Its bytes.
    pub fn to_bytes(&self) -> Vec<u8> {
        laid_out(self)
    }

    /// From its bytes; `None` where they are no checkpoint, or one of a program that keeps other state.
    pub fn from_bytes(bytes: &[u8]) -> Option<Self> {
        read(bytes).ok()
    }

    /// That of a file in a folder of results.
    ///
    /// # Errors
    /// [`Error::Io`] if another build of the program, of the same version, wrote it.
    pub fn of(saved: &Saved, directory: &Path) -> Result<Self, Error> {
        Checkpoint::from_bytes(&saved.snapshot.state).ok_or_else(|| {
            Error::Io(IoError {
                file: directory.to_path_buf(),
                message: "the state in the checkpoint is one of another build of stickslip: resume with the build that wrote it".into(),
            })
        })
    }

    /// The time it was taken at.
    pub fn time(&self) -> f64 {
        self.frame.state.t
    }

    /// Accepted increments.
    pub fn increments(&self) -> usize {
        self.summary.attempts.increments
    }

    /// The index of the step at hand, and whether it has ended.
    pub fn step(&self) -> (usize, bool) {
        (self.frame.step, self.position.running.is_none())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::keep::layout;

    #[test]
    fn the_layout_of_a_checkpoint_goes_down_to_single_numbers() {
        let text = layout::<Checkpoint>();
        for words in [
            "Frame {",
            "History {",
            "pending list Pending {",
            "krylov usize",
        ] {
            assert!(text.contains(words), "{words}: {text}");
        }
    }
}

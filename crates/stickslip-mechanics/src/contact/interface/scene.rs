//! What all points of one evaluation share.

use super::cache::Geometry;
use super::evaluation::Evaluation;
use super::input::InterfaceInput;
use crate::contact::obstacle::Pose;
use crate::contact::response::Answers;
use crate::math::Vec3;
use crate::system::Rate;

/// What is asked of an evaluation.
#[derive(Debug, Clone, Copy, Default)]
pub(in crate::contact) struct Wants {
    pub tangent: bool,
    pub surrogate: bool,
    /// See [`Assembler`](crate::system::Assembler).
    pub holds_turns: bool,
    /// All points are pressed and stick, whatever the laws say: what they would do is asked, not what they do.
    pub pressed: bool,
    /// Points that do not take part are asked as well.
    pub everywhere: bool,
    /// Tractions are those of the laws, not of multipliers: what acts before anything has been solved.
    pub initial: bool,
}

/// What is wanted of laws that are asked for all points at once, instead of a response.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::contact) enum LawQuery {
    Nothing,
    Gaps,
    Friction,
}

/// What all points of one evaluation share.
#[derive(Clone, Copy)]
pub(in crate::contact) struct Scene<'a> {
    pub interface: InterfaceInput<'a>,
    /// Coordinates, bounds and integrals.
    pub geometry: &'a Geometry,
    /// The iterate before.
    pub last: &'a [Evaluation],
    /// Pose of the obstacle now and at the last accepted state.
    pub poses: Option<&'a (Pose, Pose)>,
    /// Displacement of the belt over the increment, and its velocity at the end times the length of the increment.
    pub belt: Vec3,
    pub belt_end: Vec3,
    pub rate: Option<Rate<'a>>,
    pub dt: f64,
    /// Time at the end of the increment.
    pub t: f64,
    pub wants: Wants,
    /// What laws that are asked for all points at once have said, by point; empty where none is asked so.
    pub answers: &'a [Answers],
    pub query: LawQuery,
}

impl Scene<'_> {
    /// Way of the belt as friction sees it.
    pub fn belt_seen(&self) -> Vec3 {
        match self.rate {
            Some(_) => self.belt_end,
            None => self.belt,
        }
    }
}

/// A point whose stencil is made: the area it stands for, and where its nodes begin among those of the batch.
#[derive(Debug, Clone, Copy)]
pub(super) struct Met {
    pub i: usize,
    pub area: f64,
    pub sides: usize,
}

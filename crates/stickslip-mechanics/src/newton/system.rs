//! The equations: balance of the bulk and the interfaces, with prescribed displacements.

use std::sync::Arc;

use super::bulk::Bulk;
use crate::system::{
    ActiveSet, Assembler, BodyFrames, Constraints, Culprit, Dofs, Force, Links, Rate, State, Tally,
};

/// What is solved: the balance of the bulk and the interfaces with prescribed displacements.
pub struct System<'a> {
    /// Numbering.
    pub dofs: Dofs,
    /// Everything but the interfaces.
    pub bulk: &'a mut dyn Bulk,
    /// The interfaces.
    pub contact: Vec<&'a mut dyn Force>,
    /// How velocities follow from displacements, for forces that depend on them.
    pub rate: Option<Rate<'a>>,
    /// The frames in which forces see bodies that turn freely; `None` where these are those of the model.
    pub frames: Option<&'a Arc<BodyFrames>>,
    /// Prescribed displacements at the time of evaluation.
    pub constraints: Constraints,
    /// Rigid bodies; the dofs of their points are fixed, and the bulk has nothing there.
    pub links: &'a Links,
    /// Whether the solution is given up when the analysis is asked to stop.
    pub stoppable: bool,
}

/// Most points that a failure names.
const MOST_CULPRITS: usize = 10;

impl System<'_> {
    /// Starts an attempt at the guess.
    pub(super) fn restart(&mut self, at: &mut State, guess: &[f64]) {
        at.u.copy_from_slice(guess);
        for force in &mut self.contact {
            force.begin();
        }
        self.bulk.begin();
    }

    /// Moves from `start` by `step` times the last solution `du`, multipliers included.
    pub(super) fn advance(&mut self, at: &mut State, start: &[f64], du: &[f64], step: f64) {
        for ((u, s), d) in at.u.iter_mut().zip(start).zip(du) {
            *u = s + step * d;
        }
        self.bulk.advance(step);
        for force in &mut self.contact {
            force.update_internal(du, step);
        }
    }

    /// Adds the curvature of all interfaces to the tangent of the last evaluation.
    pub(super) fn curve(&self, out: &mut Assembler) {
        self.contact.iter().for_each(|force| force.curve(out));
    }

    /// Adds to the tangent of the last evaluation what holds back the step that forces `b` ask for. In motion inertia does.
    pub(super) fn damp_step(&self, b: &[f64], out: &mut Assembler) {
        if self.rate.is_none() {
            self.contact
                .iter()
                .for_each(|force| force.damp_step(b, out));
        }
    }

    /// The state of the last evaluation is the next iterate.
    pub(super) fn settle(&mut self) {
        for force in &mut self.contact {
            force.settle();
        }
    }

    /// Whether points chatter: they have changed status or the direction of slip several times.
    pub(super) fn chatters(&mut self) -> bool {
        !self.chattering().is_empty()
    }

    /// The points that chatter: force and point.
    pub(super) fn chattering(&mut self) -> Vec<(usize, usize)> {
        let forces = self.contact.iter_mut().enumerate();
        let points = forces.filter_map(|(k, f)| Some((k, f.active_set()?.chattering())));
        points
            .flat_map(|(k, points)| points.into_iter().map(move |i| (k, i)))
            .collect()
    }

    /// Gives points that were lost on the way another chance, once; returns how many there were.
    pub(super) fn put_back(&mut self) -> usize {
        let sets = self.contact.iter_mut().filter_map(|f| f.active_set());
        sets.map(ActiveSet::put_back).sum()
    }

    /// Whether points pass outer edges with a tentative evaluation.
    pub(super) fn passes_edges(&mut self) -> bool {
        let mut sets = self.contact.iter_mut().filter_map(|f| f.active_set());
        sets.any(|set| set.passes_edges())
    }

    /// The most rounds that a force may need beyond those of multipliers.
    pub(super) fn patience(&self) -> usize {
        let most = self.contact.iter().map(|f| f.patience()).max();
        most.unwrap_or(0)
    }

    /// Points by status.
    pub(super) fn tally(&self) -> Tally {
        self.contact.iter().filter_map(|f| f.tally()).sum()
    }

    /// The points that are difficult, for a failure.
    pub(super) fn culprits(&self) -> Vec<Culprit> {
        let mut all: Vec<_> = self.contact.iter().flat_map(|f| f.diagnose()).collect();
        all.truncate(MOST_CULPRITS);
        all
    }
}

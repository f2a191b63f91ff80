//! The equations: balance of the bulk and the interfaces, with prescribed displacements.

use super::bulk::Bulk;
use crate::system::{ActiveSet, Constraints, Culprit, Dofs, Force, Links, Rate, State, Tally, Way};

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
    /// Prescribed displacements at the time of evaluation.
    pub constraints: Constraints,
    /// Rigid bodies; the dofs of their points are fixed, and the bulk has nothing there.
    pub links: &'a Links,
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

    /// The state of the last evaluation is the next iterate.
    pub(super) fn settle(&mut self) {
        for force in &mut self.contact {
            force.settle();
        }
    }

    /// The forces that have points which change status.
    pub(super) fn active_sets(&mut self) -> impl Iterator<Item = &mut (dyn ActiveSet + '_)> {
        self.contact.iter_mut().filter_map(|f| f.active_set())
    }

    /// Whether points chatter: they have changed status or the direction of slip several times.
    pub(super) fn chatters(&mut self) -> bool {
        self.active_sets().any(|f| f.chattering() > 0)
    }

    /// Freezes points that chatter from now on, or no more; returns how many there are.
    pub(super) fn freeze(&mut self, on: bool) -> usize {
        self.active_sets().map(|f| f.freeze(on)).sum()
    }

    /// Lets frozen points go, or changes what they were frozen to; returns how many there were.
    pub(super) fn recheck(&mut self) -> usize {
        self.active_sets().map(|f| f.recheck()).sum()
    }

    /// The ways of the first force that has any; forces of a kind have the same.
    pub(super) fn ways(&mut self) -> Vec<Way> {
        let mut forces = self.contact.iter_mut();
        let found = forces.find_map(|f| f.continuation().map(|c| c.ways()));
        found.unwrap_or_default()
    }

    /// Makes all forces easier that can be made so.
    pub(super) fn ease(&mut self, to: Option<(&'static str, f64)>) {
        let forces = self.contact.iter_mut();
        forces
            .filter_map(|f| f.continuation())
            .for_each(|c| c.ease(to));
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

//! An interface as those see it who only look: what it is, and what accepted increments have left.

use super::definition::InterfaceDefinition;
use super::history::History;
use crate::contact::enforcement::Multipliers;

/// Shared references to the definition of an interface and to a history of it: that of now, or that of an increment which is reported later.
#[derive(Debug, Clone, Copy)]
pub struct ContactView<'a> {
    /// What the interface is.
    pub definition: &'a InterfaceDefinition,
    /// What accepted increments have left.
    pub state: &'a History,
}

impl std::ops::Deref for ContactView<'_> {
    type Target = InterfaceDefinition;

    fn deref(&self) -> &InterfaceDefinition {
        self.definition
    }
}

impl ContactView<'_> {
    /// What is subtracted from the gap of a point at time `t` `[m]`, with what was worn off at the last accepted state.
    pub(in crate::contact) fn offset(&self, i: usize, t: f64) -> f64 {
        self.offset_at_start(i, t) - self.state.worn.opened(i)
    }

    /// The same without what is worn off.
    pub(in crate::contact) fn offset_at_start(&self, i: usize, t: f64) -> f64 {
        let relief = self.relief.get(i).copied().unwrap_or(0.0);
        relief + self.initial.offset(&self.state.start, i, t)
    }

    /// Area that a point stands for `[m²]`, at the last committed state; what it would stand for with the whole primary opposite where
    /// nothing is.
    pub(in crate::contact) fn area_of(&self, i: usize) -> f64 {
        match self.state.points.get(i) {
            Some(h) if h.area > 0.0 => h.area,
            _ => self.points[i].area * self.share,
        }
    }

    /// Area of the secondary that a point has to itself `[m²]`: of points that move alike the first has that of all.
    pub(in crate::contact) fn own_area(&self, i: usize) -> f64 {
        match self.alike.get(i) {
            Some(earlier) if !earlier.is_empty() => 0.0,
            _ => self.points[i].area * self.share,
        }
    }

    /// Whether explicit increments hold the interface exactly: it is a tie, and not one by a penalty, which is a spring.
    pub(in crate::contact) fn holds_exactly(&self) -> bool {
        let multipliers = self.laws.enforcement.as_dyn().multipliers() != Multipliers::None;
        self.laws.tied && self.state.springs && multipliers
    }

    /// Whether multipliers are unknowns of the present attempt.
    pub(in crate::contact) fn unknown(&self) -> bool {
        self.laws.unknown_multipliers() && !self.state.springs
    }

    /// The gap that an augmented Lagrangian may leave, by half: the part `error` of the elastic approach of the last accepted state.
    pub(super) fn accepted_gap(&self) -> f64 {
        let Multipliers::Augmented { error } = self.laws.enforcement.as_dyn().multipliers() else {
            return 0.0;
        };
        if !self.laws.needs_normal_stiffness() {
            return 0.0;
        }
        let points = self.points.iter().zip(&self.state.points);
        let approach = points.map(|(p, h)| h.pressure.abs() / p.stiffness);
        // Where a point stays in contact, a gap of half of the tolerance is left as it is.
        0.5 * error * approach.fold(0.0, f64::max)
    }
}

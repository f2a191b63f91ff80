//! What an interface keeps during an attempt at an increment, and forgets with it.

use super::evaluation::Evaluation;
use super::history::PointHistory;
use crate::contact::response::Status;
use crate::math::{Vec3, dot};

/// The course of an attempt. An attempt that is given up leaves no trace: the next one begins from the history.
#[derive(Debug, Clone, Default, crate::keep::Keep)]
pub struct Attempt {
    pub(in crate::contact) multipliers: Vec<Multiplier>,
    /// Status changes, by point.
    pub(in crate::contact) flips: Vec<StatusHistory>,
    /// Points whose status changed with the last iterate.
    pub(in crate::contact) changed: usize,
    /// The last evaluation, a tentative one, may become the next iterate.
    pub(in crate::contact) tentative: bool,
    /// Nothing has been in contact yet, and this is the first tangent of the attempt.
    pub(in crate::contact) before_first_contact: bool,
    /// Gap that multipliers leave as it is where a point stays in contact `[m]`.
    pub(in crate::contact) accepted_gap: f64,
    /// How often the stiffness of the enforcement has been raised tenfold, and the violation after the round before.
    pub(in crate::contact) tightened: u32,
    pub(in crate::contact) violation: Option<f64>,
}

impl Attempt {
    /// Begins the next one, from these histories; vectors keep their memory.
    pub(in crate::contact) fn restart(&mut self, histories: &[PointHistory], accepted_gap: f64) {
        self.multipliers.clear();
        self.multipliers
            .extend(histories.iter().map(Multiplier::from));
        self.flips.clear();
        self.flips.resize(histories.len(), StatusHistory::default());
        self.changed = 0;
        self.tentative = false;
        self.before_first_contact = histories.iter().all(|h| h.status == Status::Open);
        self.accepted_gap = accepted_gap;
        self.tightened = 0;
        self.violation = None;
    }
}

/// Multipliers of a contact point in the current attempt.
#[derive(Debug, Clone, Copy, Default, PartialEq, crate::keep::Keep)]
pub(in crate::contact) struct Multiplier {
    pub pressure: f64,
    pub shear: Vec3,
    /// The normal it is perpendicular to; zero where that is not known.
    pub normal: Vec3,
    /// What an augmented Lagrangian pulls them to: the estimate of the last round.
    pub centre_pressure: f64,
    pub centre_shear: Vec3,
    pub centre_normal: Vec3,
    /// The same as components, at the last tangent: Newton steps from here.
    pub base: [f64; 3],
    pub frame: [Vec3; 2],
    pub frame_normal: Vec3,
}

impl From<&PointHistory> for Multiplier {
    fn from(h: &PointHistory) -> Self {
        Multiplier {
            pressure: h.pressure,
            shear: h.shear,
            normal: h.normal,
            centre_pressure: h.pressure,
            centre_shear: h.shear,
            centre_normal: h.normal,
            ..Multiplier::default()
        }
    }
}

/// Changes of status, or reversals of slip, of a point that chatters.
const CHATTERS: usize = 3;

/// How often a point may come back to a facet that it has left.
const RETURNS: usize = 3;

/// Status changes of a point over the iterations of an attempt.
#[derive(Debug, Clone, Copy, Default, PartialEq, crate::keep::Keep)]
pub(in crate::contact) struct StatusHistory {
    pub count: usize,
    /// How often the direction of slip was reversed, and the shear traction when it slid last.
    pub reversals: usize,
    shear: Vec3,
    /// The last statuses that differ from the one before, latest first.
    pub last: [Option<Status>; 4],
    /// Whether it lay over the primary, and how often it has slid off its outer edge.
    pub over: bool,
    pub left: usize,
    /// It has been put back onto the primary.
    pub returned: bool,
    /// The facets it has been over, latest first, and how often it has come back to one of them.
    facets: [Option<usize>; 3],
    returns: usize,
}

impl StatusHistory {
    /// Takes note of the status after an iteration; whether it has changed.
    pub fn note(&mut self, now: Status) -> bool {
        if self.last[0] == Some(now) {
            return false;
        }
        let changed = self.last[0].is_some();
        self.count += usize::from(changed);
        self.last.rotate_right(1);
        self.last[0] = Some(now);
        changed
    }

    /// Takes note of the slip of an iteration.
    pub fn slid(&mut self, e: &Evaluation) {
        let shear = match e.response.status {
            Status::Slip => e.along(&e.frames.before),
            _ => [0.0; 3],
        };
        self.reversals += usize::from(dot(self.shear, shear) < 0.0);
        self.shear = shear;
    }

    /// Takes note of the facet of an evaluation, tentative ones too: steps that are cut short lie on one side of an edge and those that are not on the other.
    pub fn meets(&mut self, facet: Option<usize>) {
        if facet.is_none() || self.facets[0] == facet {
            return;
        }
        self.returns += usize::from(self.facets.contains(&facet));
        self.facets.rotate_right(1);
        self.facets[0] = facet;
    }

    /// Whether it keeps going back and forth between facets.
    pub fn oscillates(&self) -> bool {
        self.returns >= RETURNS
    }

    /// Whether the point keeps changing.
    pub fn chatters(&self) -> bool {
        self.count + self.reversals >= CHATTERS
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_attempt_begins_as_if_there_had_been_none() {
        let history = PointHistory {
            pressure: 2.0,
            shear: [0.5, 0.0, 0.0],
            status: Status::Stick,
            ..PointHistory::default()
        };
        let histories = [history; 3];
        let mut first = Attempt::default();
        first.restart(&histories, 0.25);
        let mut spoiled = first.clone();
        spoiled.multipliers[1].pressure = 7.0;
        spoiled.flips[2].note(Status::Slip);
        spoiled.flips[2].left = 2;
        spoiled.changed = 3;
        spoiled.tentative = true;
        spoiled.tightened = 2;
        spoiled.violation = Some(1.0);
        spoiled.restart(&histories, 0.25);
        let again = spoiled;
        assert_eq!(again.multipliers, first.multipliers);
        assert_eq!(again.flips, first.flips);
        let rest = |a: &Attempt| {
            (
                a.changed,
                a.tentative,
                a.before_first_contact,
                a.tightened,
                a.violation,
            )
        };
        assert_eq!(rest(&again), rest(&first));
        assert!(!first.before_first_contact);
    }
}

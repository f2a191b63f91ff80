//! Memory of status: points that keep changing it keep a choice until the rest has settled.
//!
//! Semi-smooth Newton is an active-set method that changes all points at once, and may go round in a circle: two neighbours that open and close in
//! turn, a point whose slip goes to and fro across stick. A point that has been seen to do so is frozen, in contact and sticking if that is among
//! what it does. Its branch of the laws goes on beyond where they would leave it, so the rest settles; then the choice is checked against the laws,
//! and exchanged where they refuse it. At the end nothing is frozen: what comes out obeys the laws.

use super::evaluation::{Evaluation, components};
use crate::contact::response::{Frozen, Status};
use crate::math::{Vec3, dot};

/// Changes of status or reversals of slip after which a point is frozen.
const MOST_CHANGES: u32 = 3;

/// How often all choices may be exchanged without fewer being refused.
const MOST_IDLE: u32 = 1;

/// What a point is frozen in.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Choice {
    Open,
    Stick,
    /// With the direction of the shear traction, of length one.
    Slip(Vec3),
}

/// What a point did since the attempt began or since it was let go.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct StatusRecord {
    status: Option<Status>,
    /// Shear traction while it slid.
    shear: Vec3,
    changes: u32,
    pub frozen: Option<Choice>,
    /// How often it has been closed while it was frozen.
    pub closed: u32,
}

/// What the points of an interface did, and what they are frozen in.
#[derive(Debug, Clone, Default)]
pub(super) struct Freezing {
    on: bool,
    pub points: Vec<StatusRecord>,
    /// The fewest choices that the laws have refused so far, and how often there were not fewer since.
    fewest: Option<usize>,
    idle: u32,
}

impl Freezing {
    /// A new attempt. While points are frozen those that were go on, sticking.
    pub fn begin(&mut self) {
        for p in &mut self.points {
            *p = StatusRecord {
                frozen: p.frozen.filter(|_| self.on).map(|_| Choice::Stick),
                ..StatusRecord::default()
            };
        }
        self.fewest = None;
        self.idle = 0;
    }

    /// Takes note of an iterate.
    pub fn note(&mut self, iterate: &[Evaluation]) {
        self.points.resize(iterate.len(), StatusRecord::default());
        for (p, e) in self.points.iter_mut().zip(iterate) {
            let status = e.response.status;
            let shear = match status {
                Status::Slip => e.along(&e.frames.before),
                _ => [0.0; 3],
            };
            let turned = dot(p.shear, shear) < 0.0;
            p.changes += u32::from(p.status.is_some_and(|before| before != status) || turned);
            p.status = Some(status);
            p.shear = shear;
            if self.on {
                p.judge();
            }
        }
    }

    /// What a point is frozen in, in this frame.
    pub fn frozen(&self, i: usize, frame: &[Vec3; 2], dim: usize) -> Option<Frozen> {
        let frozen = self.points.get(i)?.frozen?;
        Some(match frozen {
            Choice::Open => Frozen::Open,
            Choice::Stick => Frozen::Stick,
            Choice::Slip(direction) => Frozen::Slip(components(direction, frame, dim)),
        })
    }

    /// Points that have changed often.
    pub fn chattering(&self) -> usize {
        let often = self.points.iter().filter(|p| p.changes >= MOST_CHANGES);
        often.count()
    }

    /// Holds points from now on; returns how many there are.
    pub fn freeze(&mut self, on: bool) -> usize {
        self.on = on;
        for p in &mut self.points {
            if on {
                p.judge();
            } else {
                p.frozen = None;
            }
        }
        self.points.iter().filter(|p| p.frozen.is_some()).count()
    }
}

impl Freezing {
    /// While the laws refuse choices, these are exchanged for what the laws want; when they refuse none all points are let go.
    ///
    /// All refused choices are exchanged at once as long as fewer and fewer are refused, after that one at a time: the first goes round in a circle at
    /// times ([`judice_pires_1994`](stickslip_base::references::judice_pires_1994)), the second does not where friction is moderate
    /// ([`murty_1974`](stickslip_base::references::murty_1974)).
    pub fn exchange(&mut self, refused: &[(usize, Choice)]) {
        if self.fewest.is_none_or(|fewest| refused.len() < fewest) {
            self.fewest = Some(refused.len());
            self.idle = 0;
        } else {
            self.idle += 1;
        }
        let first = match self.idle <= MOST_IDLE {
            true => 0,
            false => refused.len().saturating_sub(1),
        };
        for &(i, wanted) in &refused[first..] {
            let p = &mut self.points[i];
            p.closed += u32::from(p.frozen == Some(Choice::Open));
            p.frozen = Some(wanted);
        }
        if refused.is_empty() {
            self.fewest = None;
            for p in self.points.iter_mut().filter(|p| p.frozen.is_some()) {
                *p = StatusRecord::default();
            }
        }
    }
}

impl StatusRecord {
    fn judge(&mut self) {
        if self.frozen.is_none() && self.changes >= MOST_CHANGES {
            self.frozen = Some(Choice::Stick);
        }
    }
}

crate::keep!(Freezing {
    on,
    points,
    fewest,
    idle
});
crate::keep!(StatusRecord {
    status,
    shear,
    changes,
    frozen,
    closed
});

crate::keep!(Choice[Open, Stick, Slip(shear)]);

//! Memory of status: points that keep changing it keep a choice until the rest has settled.
//!
//! Semi-smooth Newton is an active-set method that changes all points at once, and may go round in a circle: two neighbours that open and close in
//! turn, a point whose slip goes to and fro across stick. A point that has been seen to do so is held, in contact and sticking if that is among
//! what it does. Its branch of the laws goes on beyond where they would leave it, so the rest settles; then the choice is checked against the laws,
//! and exchanged where they refuse it. At the end nothing is held: what comes out obeys the laws.

use super::evaluate::{Evaluation, components};
use super::{Interface, Status};
use crate::contact::response::Held;
use crate::math::{Vec3, add_scaled, dot, norm, scale};
use crate::system::ActiveSet;

/// Changes of status or reversals of slip after which a point is held.
const MOST_CHANGES: u32 = 3;

/// How often all choices may be exchanged without fewer being refused.
const MOST_IDLE: u32 = 1;

/// What a point is held in.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Choice {
    Open,
    Stick,
    /// With the direction of the shear traction, of length one.
    Slip(Vec3),
}

/// What a point did since the attempt began or since it was let go.
#[derive(Debug, Clone, Copy, Default)]
struct StatusRecord {
    status: Option<Status>,
    /// Shear traction while it slid.
    shear: Vec3,
    changes: u32,
    held: Option<Choice>,
    /// How often it has been closed while it was held.
    closed: u32,
}

/// What the points of an interface did, and what they are held in.
#[derive(Debug, Clone, Default)]
pub(super) struct Steady {
    on: bool,
    points: Vec<StatusRecord>,
    /// The fewest choices that the laws have refused so far, and how often there were not fewer since.
    fewest: Option<usize>,
    idle: u32,
}

impl Steady {
    /// A new attempt. While points are being held those that were go on, sticking.
    pub fn clear(&mut self) {
        for p in &mut self.points {
            *p = StatusRecord {
                held: p.held.filter(|_| self.on).map(|_| Choice::Stick),
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
                Status::Slip => e.along_before(),
                _ => [0.0; 3],
            };
            let turned = dot(p.shear, shear) < 0.0;
            p.changes += u32::from(p.status.is_some_and(|before| before != status) || turned);
            p.status = Some(status);
            p.shear = shear;
            if self.on {
                p.hold();
            }
        }
    }

    /// Points that have changed often.
    pub fn restless(&self) -> usize {
        let often = self.points.iter().filter(|p| p.changes >= MOST_CHANGES);
        often.count()
    }

    /// Holds points from now on; returns how many there are.
    pub fn engage(&mut self, on: bool) -> usize {
        self.on = on;
        for p in &mut self.points {
            if on {
                p.hold();
            } else {
                p.held = None;
            }
        }
        self.points.iter().filter(|p| p.held.is_some()).count()
    }
}

impl StatusRecord {
    fn hold(&mut self) {
        if self.held.is_none() && self.changes >= MOST_CHANGES {
            self.held = Some(Choice::Stick);
        }
    }
}

impl Evaluation {
    /// Shear traction in space, as components along the frame of the last accepted state.
    fn along_before(&self) -> Vec3 {
        let t = self.response.traction;
        add_scaled(
            scale(t[1], self.frame_before[0]),
            t[2],
            self.frame_before[1],
        )
    }
}

impl Interface {
    /// What a point is held in, in this frame.
    pub(super) fn held(&self, i: usize, frame: &[Vec3; 2], dim: usize) -> Option<Held> {
        let held = self.memory.steady.points.get(i)?.held?;
        Some(match held {
            Choice::Open => Held::Open,
            Choice::Stick => Held::Stick,
            Choice::Slip(direction) => Held::Slip(components(direction, frame, dim)),
        })
    }
}

impl ActiveSet for Interface {
    fn chattering(&self) -> usize {
        self.memory.steady.restless()
    }

    fn freeze(&mut self, on: bool) -> usize {
        self.memory.steady.engage(on)
    }

    // Checks what points are held in against the laws. While the laws refuse something, that is exchanged for what they want; when they refuse
    // nothing all points are let go. Returns how many points were held.
    //
    // All refused choices are exchanged at once as long as fewer and fewer are refused, after that one at a time: the first goes round in a circle at
    // times, the second does not where friction is moderate (references: `judice_pires_1994`, `murty_1974`).
    fn recheck(&mut self) -> usize {
        let memory = &mut self.memory;
        let set_valued = self.laws.set_valued();
        let mut held = 0;
        let mut refused = Vec::new();
        // Points that left the outer edge on the way, but lie over the surface and in it where the way has ended, get another chance.
        for (flips, e) in memory.flips.iter_mut().zip(&memory.last.points) {
            if e.stranded && !flips.returned {
                flips.left = 0;
                flips.returned = true;
                held += 1;
            }
        }
        for (i, (p, e)) in (memory.steady.points.iter_mut().zip(&memory.last.points)).enumerate() {
            let Some(choice) = p.held else {
                continue;
            };
            held += 1;
            let r = &e.response;
            let shear = e.along_before();
            let size = norm(shear);
            let wanted = match choice {
                Choice::Open => {
                    let rest = memory.rest.get(i).copied().unwrap_or(0.0);
                    let pulled = memory.multipliers[i].centre_pressure / e.normal_stiffness;
                    let slid = norm(e.moved);
                    (pulled > e.gap - rest).then(|| {
                        // It opened when it stuck: then it may slide.
                        if p.closed % 2 == 1 && slid > 0.0 {
                            Choice::Slip(scale(-1.0 / slid, e.moved))
                        } else {
                            Choice::Stick
                        }
                    })
                }
                _ if r.traction[0] <= 0.0 && set_valued => Some(Choice::Open),
                Choice::Stick => (size > r.limit).then(|| Choice::Slip(scale(1.0 / size, shear))),
                Choice::Slip(direction) => (dot(direction, e.moved) > 0.0).then_some(Choice::Stick),
            };
            refused.extend(wanted.map(|wanted| (i, wanted)));
        }
        let steady = &mut memory.steady;
        if steady.fewest.is_none_or(|fewest| refused.len() < fewest) {
            steady.fewest = Some(refused.len());
            steady.idle = 0;
        } else {
            steady.idle += 1;
        }
        let all = steady.idle <= MOST_IDLE;
        let first = if all {
            0
        } else {
            refused.len().saturating_sub(1)
        };
        for &(i, wanted) in &refused[first..] {
            let p = &mut steady.points[i];
            p.closed += u32::from(p.held == Some(Choice::Open));
            p.held = Some(wanted);
        }
        if refused.is_empty() {
            steady.fewest = None;
            for p in &mut steady.points {
                if p.held.is_some() {
                    *p = StatusRecord::default();
                }
            }
        }
        held
    }
}

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

/// Changes of status or reversals of slip after which a point is held.
const MOST_CHANGES: u32 = 3;

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
struct Course {
    status: Option<Status>,
    /// Shear traction while it slid.
    shear: Vec3,
    changes: u32,
    held: Option<Choice>,
}

/// What the points of an interface did, and what they are held in.
#[derive(Debug, Clone, Default)]
pub(super) struct Steady {
    on: bool,
    points: Vec<Course>,
}

impl Steady {
    /// A new attempt.
    pub fn clear(&mut self) {
        self.on = false;
        self.points.clear();
    }

    /// Takes note of an iterate.
    pub fn note(&mut self, iterate: &[Evaluation]) {
        self.points.resize(iterate.len(), Course::default());
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

impl Course {
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
        add_scaled(scale(t[1], self.frame_before[0]), t[2], self.frame_before[1])
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

    /// Checks what points are held in against the laws. While the laws refuse something, that is exchanged for what they want; when they refuse
    /// nothing all points are let go. Returns how many points were held.
    pub(super) fn reconsider_held(&mut self) -> usize {
        let memory = &mut self.memory;
        let set_valued = self.laws.normal.as_dyn().pressure(0.0).is_none();
        let (mut held, mut refused) = (0, 0);
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
                    (pulled > e.gap - rest).then_some(Choice::Stick)
                }
                _ if r.traction[0] <= 0.0 && set_valued => Some(Choice::Open),
                Choice::Stick => (size > r.limit).then(|| Choice::Slip(scale(1.0 / size, shear))),
                Choice::Slip(direction) => {
                    (dot(direction, e.moved) > 0.0).then_some(Choice::Stick)
                }
            };
            if wanted.is_some() {
                p.held = wanted;
                refused += 1;
            }
        }
        if refused == 0 {
            for p in &mut memory.steady.points {
                if p.held.is_some() {
                    *p = Course::default();
                }
            }
        }
        held
    }
}

//! Points that chatter, as Newton's method sees them: they are frozen, and what they are frozen in is checked against the laws.

use super::definition::Interface;
use super::evaluation::Evaluation;
use super::freezing::Choice;
use crate::math::{dot, norm, scale};
use crate::system::ActiveSet;

impl ActiveSet for Interface {
    fn chattering(&self) -> usize {
        self.attempt.freezing.chattering()
    }

    fn freeze(&mut self, on: bool) -> usize {
        self.attempt.freezing.freeze(on)
    }

    fn recheck(&mut self) -> usize {
        let put_back = self.put_back();
        let (frozen, refused) = self.refused();
        self.attempt.freezing.exchange(&refused);
        put_back + frozen
    }
}

impl Interface {
    /// Points that left the outer edge on the way, but lie over the surface and in it where the way has ended, get another chance, once. How many there
    /// were.
    fn put_back(&mut self) -> usize {
        let mut count = 0;
        for (flips, e) in (self.attempt.flips.iter_mut()).zip(&self.cache.last.points) {
            if e.stranded && !flips.returned {
                flips.left = 0;
                flips.returned = true;
                count += 1;
            }
        }
        count
    }

    /// How many points are frozen, and those whose choice the laws refuse, with what they want instead.
    fn refused(&self) -> (usize, Vec<(usize, Choice)>) {
        let points = self.attempt.freezing.points.iter();
        let mut frozen = 0;
        let mut refused = Vec::new();
        for (i, (p, e)) in points.zip(&self.cache.last.points).enumerate() {
            if let Some(choice) = p.frozen {
                frozen += 1;
                let wanted = self.wanted(i, choice, p.closed, e);
                refused.extend(wanted.map(|wanted| (i, wanted)));
            }
        }
        (frozen, refused)
    }

    /// What the laws want of a point instead of what it is frozen in, after it has been closed so many times; `None` if nothing else.
    fn wanted(&self, i: usize, choice: Choice, closed: u32, e: &Evaluation) -> Option<Choice> {
        let r = &e.response;
        let shear = e.along(&e.frames.before);
        let size = norm(shear);
        match choice {
            Choice::Open => {
                let rest = self.history.rest.get(i).copied().unwrap_or(0.0);
                let pulled = self.attempt.multipliers[i].centre_pressure / e.normal_stiffness;
                let slid = norm(e.moved);
                (pulled > e.gap - rest).then(|| {
                    // It opened when it stuck: then it may slide.
                    if closed % 2 == 1 && slid > 0.0 {
                        Choice::Slip(scale(-1.0 / slid, e.moved))
                    } else {
                        Choice::Stick
                    }
                })
            }
            _ if r.traction[0] <= 0.0 && self.laws.set_valued() => Some(Choice::Open),
            Choice::Stick => (size > r.limit).then(|| Choice::Slip(scale(1.0 / size, shear))),
            Choice::Slip(direction) => (dot(direction, e.moved) > 0.0).then_some(Choice::Stick),
        }
    }
}

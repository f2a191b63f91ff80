//! A cell that is a line: what it has in common with others is an interval.

use super::clip::Point;
use super::rules::LINE_RULE;
use super::view::View;
use super::window::{Window, frame};
use crate::math::{Vec3, dot, sub};
use crate::shape::ElementKind;
use crate::tolerance::ROUNDING;

/// A line from `origin` along a direction.
pub(super) struct Interval {
    origin: Vec3,
    along: Vec3,
    length: f64,
    /// Reference coordinates of its ends on the face.
    ends: [f64; 2],
}

impl Interval {
    /// `None` of a line along its normal.
    pub fn new(view: &View, cell: &[usize], normal: Vec3) -> Option<Self> {
        let (a, b) = (view.x[cell[0]], view.x[cell[1]]);
        let [along, _] = frame(normal, sub(b, a))?;
        Some(Interval {
            origin: a,
            along,
            length: dot(sub(b, a), along),
            ends: [cell[0], cell[1]].map(|k| view.face.kind.reference().nodes()[k][0]),
        })
    }
}

impl Window for Interval {
    type Part = [f64; 2];

    fn common(&self, x: &[Vec3], other: &[usize]) -> Option<[f64; 2]> {
        let at = |k: usize| dot(sub(x[other[k]], self.origin), self.along) / self.length;
        let (low, high) = (at(0).min(at(1)).max(0.0), at(0).max(at(1)).min(1.0));
        // A NaN is nothing as well as what is too short.
        let nothing = high - low <= ROUNDING;
        (!nothing).then_some([low, high])
    }

    fn places(&self, &[low, high]: &[f64; 2], _: ElementKind, sample: &mut dyn FnMut(Point, f64)) {
        let way = self.ends[1] - self.ends[0];
        for (point, weight) in LINE_RULE {
            let t = low + 0.5 * (1.0 + point) * (high - low);
            let w = 0.5 * weight * (high - low) * way.abs();
            sample([self.ends[0] + t * way, 0.0], w);
        }
    }
}

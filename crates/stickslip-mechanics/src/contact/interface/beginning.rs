//! How an interface begins to act: the gaps it counts from, and the places its points are moved to.

use super::initial::{CLOSE, Start, Within};
use super::parts::Interface;
use crate::system::Stage;

impl Interface {
    /// Takes note of the gaps with which the interface begins to act, if it has not begun yet, in a step from `span[0]` to `span[1]`.
    pub fn begin_acting(&mut self, stage: &Stage, span: [f64; 2]) {
        if self.history.start.begun || !self.schedule.active(0.5 * (span[0] + span[1])) {
            return;
        }
        self.history.start.begun = true;
        self.history.start.span = span;
        if !matches!(self.initial.start, Start::Offset | Start::Ramp) {
            return;
        }
        let gaps = self.all_gaps_at(stage);
        let largest = match self.initial.start {
            Start::Offset => self.initial.within.unwrap_or(CLOSE),
            _ => Within::Distance(0.0),
        };
        let points = gaps.iter().zip(&self.points).enumerate();
        self.history.start.offset = points
            .map(|(i, (&gap, point))| {
                // It is the gap of the meshes that counts as another one: heights stay.
                let gap = gap + self.relief.get(i).copied().unwrap_or(0.0);
                if gap <= largest.of(point.size) {
                    gap - self.initial.gap
                } else {
                    0.0
                }
            })
            .collect();
    }
}

//! Points that change status, as Newton's method sees them.

use super::on_facet::MOST_LEFT;
use super::parts::InterfaceForce;
use crate::system::ActiveSet;

impl ActiveSet for InterfaceForce<'_> {
    fn chattering(&self) -> Vec<usize> {
        let flips = self.attempt.flips.iter().enumerate();
        flips
            .filter(|(_, f)| f.chatters())
            .map(|(i, _)| i)
            .collect()
    }

    /// Points that left the outer edge on the way, but lie over the surface and in it where the way has ended.
    fn put_back(&mut self) -> usize {
        let mut count = 0;
        for (flips, e) in (self.attempt.flips.iter_mut()).zip(&self.cache.last.points) {
            if e.foot.off_edge && !flips.returned {
                flips.left = 0;
                flips.returned = true;
                count += 1;
            }
        }
        count
    }

    fn passes_edges(&self) -> bool {
        let evaluations = match self.view().unknown() && self.attempt.tentative {
            true => &self.cache.trial,
            false => &self.cache.last,
        };
        let both = self.attempt.flips.iter().zip(&evaluations.points);
        let mut passing = both.filter(|(flips, e)| flips.over != e.over);
        passing.any(|(flips, _)| flips.left < MOST_LEFT)
    }
}

//! The two sides of an interface: which nodes a point hangs on, for what area it stands, and what sliding leaves on them.

use super::history::Opposite;
use super::parts::Interface;

impl Interface {
    /// Nodes that take part in a point and their weights at the last evaluation.
    fn met(&self, i: usize) -> &[(usize, f64)] {
        let last = &self.cache.last;
        let e = last.points.get(i).filter(|e| e.over);
        e.map_or(&[], |e| last.batch(i).sides(e))
    }

    /// Nodes of the primary that a point lies over at the last evaluation and its weights there; nothing where it lies over none.
    pub(super) fn facet_weights(&self, i: usize) -> impl Iterator<Item = (usize, f64)> {
        let met = self.met(i).iter();
        met.filter(|(node, _)| *node < self.primary_nodes)
            .map(|&(node, w)| (node, -w))
    }

    /// Takes note of them in the history.
    pub(super) fn note_opposite(&mut self) {
        let mut opposite = Opposite::default();
        for i in 0..self.points.len() {
            opposite.push(self.facet_weights(i));
        }
        self.history.opposite = opposite;
    }

    /// Nodes of both sides with the share of the force of a point that each receives: positive on the secondary (but for corners of
    /// quadratic faces), negative on the primary.
    pub(in crate::contact) fn weights_of(&self, i: usize) -> impl Iterator<Item = (usize, f64)> {
        let met = self.met(i);
        let alone = met.is_empty();
        let own = self.own_weights(i).filter(move |_| alone);
        met.iter().copied().chain(own)
    }

    /// Adds what the last increment dissipated per area at each point to the nodes of the primary that it met: the mean of the
    /// points over a node, weighted by their areas there. What slides over the primary so leaves its trace where it was.
    pub(super) fn leave_traces(&mut self, traces: &[f64]) {
        if self.rigid() || traces.iter().all(|t| *t == 0.0) {
            return;
        }
        let mut sums = vec![[0.0; 2]; self.nodes.len()];
        for (i, trace) in traces.iter().enumerate() {
            let area = self.view().area_of(i);
            for (node, w) in self.facet_weights(i) {
                let share = area * w.max(0.0);
                sums[node][0] += share * trace;
                sums[node][1] += share;
            }
        }
        let all = &mut self.history.traces;
        all.resize(self.definition.nodes.len(), [0.0; 2]);
        for (t, [dissipated, share]) in all.iter_mut().zip(sums) {
            if share > 0.0 {
                t[0] += dissipated / share;
            }
        }
    }
}

//! The two sides of an interface: which nodes a point hangs on, for what area it stands, and what sliding leaves on them.

use super::definition::{Interface, Primary};
use super::history::History;

/// What sliding has worn off both surfaces.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct WearReport {
    /// Largest depth on the secondary and on the primary `[m]`.
    pub depth: [f64; 2],
    /// Volume lost by the secondary and by the primary `[m³]`.
    pub volume: [f64; 2],
}

impl Interface {
    /// Factor of vectors on the secondary that makes them those on the side that the problem calls so.
    pub(super) fn named(&self) -> f64 {
        if self.exchanged { -1.0 } else { 1.0 }
    }

    /// Area that a point stands for `[m²]`, at the last committed state; what it would stand for with the whole primary opposite where
    /// nothing is.
    pub(super) fn area_of(&self, i: usize) -> f64 {
        match self.history.points.get(i) {
            Some(h) if h.area > 0.0 => h.area,
            _ => self.points[i].area * self.share,
        }
    }

    /// Nodes of the secondary that a point hangs on, with weights that add up to one.
    pub(super) fn own_weights(&self, i: usize) -> impl Iterator<Item = (usize, f64)> {
        let p = &self.points[i];
        p.nodes.iter().copied().zip(p.weights.iter().copied())
    }

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

    /// Memory that a history takes `[bytes]`. A point of a mortar is taken to meet a facet more than it has faces around it.
    pub fn history_bytes(&self) -> usize {
        let facet = self.facets().iter().map(|f| f.nodes.len()).max();
        let facets: usize = match &self.mortar {
            Some(mortar) => mortar.around.iter().map(|faces| faces.len() + 1).sum(),
            None => self.points.len(),
        };
        let opposite = facets * facet.unwrap_or(0);
        History::bytes(self.points.len(), opposite, self.nodes.len())
    }

    /// Memory that what goes into a factor takes, point by point `[bytes]`, about: its dofs twice, and a matrix over them.
    pub fn stand_in_bytes(&self, dim: usize) -> usize {
        let facet = self.facets().iter().map(|f| f.nodes.len()).max();
        let facet = facet.unwrap_or(0);
        let bytes = |nodes: usize| {
            let dofs = dim * nodes;
            size_of::<f64>() * (dofs * dofs + 3 * dofs)
        };
        match &self.mortar {
            // A node meets a facet more than it has faces around it, and shares each of these with another node.
            Some(mortar) => (mortar.around.iter())
                .map(|faces| bytes((faces.len() + 1) * (facet + 1)))
                .sum(),
            None => self.points.len() * bytes(facet + 2),
        }
    }

    /// Takes note of them in the history.
    pub(super) fn note_opposite(&mut self) {
        let mut opposite = std::mem::take(&mut self.history.opposite);
        opposite.clear();
        for i in 0..self.points.len() {
            opposite.push(self.facet_weights(i));
        }
        self.history.opposite = opposite;
    }

    /// Nodes of both sides with the share of the force of a point that each receives: positive on the secondary (but for corners of
    /// quadratic faces), negative on the primary.
    pub(super) fn weights_of(&self, i: usize) -> impl Iterator<Item = (usize, f64)> {
        let met = self.met(i);
        let alone = met.is_empty();
        let own = self.own_weights(i).filter(move |_| alone);
        met.iter().copied().chain(own)
    }

    /// Nodes of the primary, each as often as it has facets.
    pub(super) fn primary_nodes(&self) -> impl Iterator<Item = usize> {
        let facets = match &self.primary {
            Primary::Facets(facets) => facets.as_slice(),
            Primary::Rigid(..) => &[],
        };
        facets.iter().flat_map(|f| f.nodes.iter().copied())
    }

    /// Adds what the last increment dissipated per area at each point to the nodes of the primary that it met: the mean of the
    /// points over a node, weighted by their areas there. What slides over the primary so leaves its trace where it was.
    pub(super) fn leave_traces(&mut self, traces: &[f64]) {
        if self.rigid() || traces.iter().all(|t| *t == 0.0) {
            return;
        }
        let mut sums = vec![[0.0; 2]; self.nodes.len()];
        for (i, trace) in traces.iter().enumerate() {
            let area = self.area_of(i);
            for (node, w) in self.facet_weights(i) {
                let share = area * w.max(0.0);
                sums[node][0] += share * trace;
                sums[node][1] += share;
            }
        }
        let all = &mut self.history.traces;
        all.resize(self.nodes.len(), [0.0; 2]);
        for (t, [dissipated, share]) in all.iter_mut().zip(sums) {
            if share > 0.0 {
                t[0] += dissipated / share;
            }
        }
    }

    /// Depth and volume of wear so far; `None` where it is not followed.
    pub fn wear(&self) -> Option<WearReport> {
        if !self.laws.wear.as_dyn().active() {
            return None;
        }
        let secondary = self.history.points.iter().map(|h| h.worn);
        let nodes = self.history.traces.iter().map(|t| t[1]);
        let ground = self.ground_lost().map_or(0.0, |[deepest, _]| deepest);
        let mut report = WearReport {
            depth: [secondary.fold(0.0, f64::max), nodes.fold(ground, f64::max)],
            volume: self.history.worn,
        };
        if self.exchanged {
            report.depth.reverse();
            report.volume.reverse();
        }
        Some(report)
    }
}

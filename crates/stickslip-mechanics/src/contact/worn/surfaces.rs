//! The depths that sliding has worn off both surfaces of an interface.

use super::track::TrackDepths;

/// What accepted increments have worn off.
#[derive(Debug, Clone, Default, PartialEq, crate::keep::Keep)]
pub(in crate::contact) struct WornSurfaces {
    /// Depth of the side with the points, by contact point `[m]`; empty where nothing wears.
    own: Vec<f64>,
    /// By how much the depths of both sides opened the gap at the end of the last increment, by contact point `[m]`.
    opened: Vec<f64>,
    /// Depth of the primary by node `[m]`; empty before it was worn, and where it has none.
    pub opposite: Vec<f64>,
    /// Depth of the primary in coordinates of its matter, where that is no node.
    pub track: TrackDepths,
    /// Volume that the side with the points and the other have lost `[m³]`.
    pub volume: [f64; 2],
}

impl WornSurfaces {
    /// Depth of the side with the points at one of them `[m]`.
    pub fn own_depth(&self, i: usize) -> f64 {
        self.own.get(i).copied().unwrap_or(0.0)
    }

    /// Depth of the primary at a node of the interface `[m]`.
    pub fn opposite_depth(&self, node: usize) -> f64 {
        self.opposite.get(node).copied().unwrap_or(0.0)
    }

    /// By how much both opened the gap of a point at the end of the last increment `[m]`.
    pub fn opened(&self, i: usize) -> f64 {
        self.opened.get(i).copied().unwrap_or(0.0)
    }

    /// Largest depth of the side with the points `[m]`.
    pub fn deepest_own(&self) -> f64 {
        self.own.iter().copied().fold(0.0, f64::max)
    }

    /// Adds what a point has lost over an increment; `opened`: the gap that its depths open now `[m]`.
    pub fn deepen(&mut self, i: usize, depth: f64, opened: f64) {
        let count = self.own.len().max(i + 1);
        self.own.resize(count, 0.0);
        self.opened.resize(count, 0.0);
        self.own[i] += depth;
        self.opened[i] = opened;
    }

    /// Gives a point the depths of another.
    pub fn copy(&mut self, from: usize, to: usize) {
        for values in [&mut self.own, &mut self.opened] {
            if let Some(&value) = values.get(from) {
                values[to] = value;
            }
        }
    }

    /// Gives a point a depth.
    pub fn set_own_depth(&mut self, i: usize, depth: f64) {
        if let Some(own) = self.own.get_mut(i) {
            *own = depth;
        }
    }

    /// Memory that it takes `[bytes]`, without the track.
    #[cfg(test)]
    pub fn bytes(&self) -> usize {
        let all = [&self.own, &self.opened, &self.opposite];
        all.map(|values| size_of_val(values.as_slice()))
            .iter()
            .sum()
    }
}

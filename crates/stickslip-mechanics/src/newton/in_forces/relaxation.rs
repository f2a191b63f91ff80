//! How far a pass goes towards its solution.

use crate::math::vector::dot;

/// How much of a step from one solution to the next is taken, where surfaces and laws make them go back and forth or creep: Aitken's relaxation
/// ([Küttler and Wall 2008](stickslip_base::references::kuettler_2008)), which at most doubles from step to step.
#[derive(Debug)]
pub(super) struct Relaxation {
    length: f64,
    last: Option<Vec<f64>>,
}

impl Default for Relaxation {
    fn default() -> Self {
        Self {
            length: 1.0,
            last: None,
        }
    }
}

impl Relaxation {
    /// The part of this step that is taken.
    pub fn length(&mut self, du: &[f64]) -> f64 {
        if let Some(last) = &self.last {
            let change: Vec<f64> = du.iter().zip(last).map(|(now, then)| now - then).collect();
            let length = -self.length * dot(last, &change) / dot(&change, &change);
            self.length = if length > 0.0 {
                length.min(2.0 * self.length)
            } else {
                1.0
            };
        }
        self.last = Some(du.to_vec());
        self.length
    }
}

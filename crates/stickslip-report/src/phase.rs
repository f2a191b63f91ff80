//! The shape of a mode at a phase.

use std::sync::Arc;

use stickslip::io::vtu::{PointArray, PointFields};

/// The arrays of a shape: its real part, and the imaginary one if it has one.
pub const SHAPE_ARRAYS: [&str; 2] = ["PHI", "PHI_IMAGINARY"];

/// A shape at a phase.
#[derive(Debug, Clone, PartialEq)]
pub struct Phase {
    /// What it is, for people.
    pub label: Arc<str>,
    /// The phase `[rad]`.
    pub angle: f64,
}

impl Phase {
    /// Puts the displacements at the phase in place of the shape: `Re(φ e^{iα})`, the largest of a cycle about one.
    pub fn place(&self, points: &mut PointFields) {
        let parts = SHAPE_ARRAYS.map(|name| points.arrays.remove(name));
        let count = 3 * points.points.len();
        let whole = |part: &&PointArray| part.components == 3 && part.values.len() == count;
        let [real, imaginary] = [0, 1].map(|k| parts[k].as_ref().filter(whole));
        let at = |part: Option<&PointArray>, i: usize| part.map_or(0.0, |p| p.values[i]);
        let size = |p: usize| -> f64 {
            let own = 3 * p..3 * p + 3;
            own.map(|i| at(real, i).powi(2) + at(imaginary, i).powi(2))
                .sum()
        };
        let largest = (0..points.points.len()).map(size).fold(0.0, f64::max);
        let factor = 1.0 / largest.sqrt().max(f64::MIN_POSITIVE);
        let (sine, cosine) = self.angle.sin_cos();
        let values = (0..count).map(|i| factor * (cosine * at(real, i) - sine * at(imaginary, i)));
        let values = values.collect();
        points.arrays.clear();
        points.arrays.insert(
            "U".into(),
            PointArray {
                components: 3,
                values,
            },
        );
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_shape_goes_through_its_phases() {
        let array = |values: [f64; 6]| PointArray {
            components: 3,
            values: values.to_vec(),
        };
        // One point goes round a circle of radius 2, the other back and forth by 1.
        let fields = || PointFields {
            points: vec![[0.0; 3]; 2],
            arrays: [
                ("PHI".to_string(), array([2.0, 0.0, 0.0, 0.0, 1.0, 0.0])),
                (
                    "PHI_IMAGINARY".to_string(),
                    array([0.0, -2.0, 0.0, 0.0, 0.0, 0.0]),
                ),
            ]
            .into(),
        };
        let at = |angle: f64| {
            let mut fields = fields();
            let label = "".into();
            Phase { label, angle }.place(&mut fields);
            fields.arrays["U"].values.clone()
        };
        let quarter = std::f64::consts::FRAC_PI_2;
        let diagonal = 8.0_f64.sqrt();
        for (angle, expected) in [
            (0.0, [2.0, 0.0, 0.0, 0.0, 1.0, 0.0]),
            (quarter, [0.0, 2.0, 0.0, 0.0, 0.0, 0.0]),
            (2.0 * quarter, [-2.0, 0.0, 0.0, 0.0, -1.0, 0.0]),
        ] {
            for (value, expected) in at(angle).iter().zip(expected) {
                assert!((value - expected / diagonal).abs() < 1e-15, "{angle}");
            }
        }
    }
}

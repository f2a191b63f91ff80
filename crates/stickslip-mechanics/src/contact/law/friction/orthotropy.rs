//! Friction that depends on the direction: where the axes of a surface point.

use crate::friction::ellipse::{Ellipse, SlipDirection};
use crate::math::{Vec3, add_scaled, cross, dot, norm, normalize, sub};

/// Sine of the angle between an axis and the normal of a surface below which the axis has no direction in the surface.
const NO_AXIS: f64 = 1e-6;

/// The lines along which the first coefficient of friction acts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Lines {
    /// Straight lines.
    Along(Vec3),
    /// Circles around a line.
    Around {
        /// A point of the line `[m]`.
        centre: Vec3,
        /// Its direction.
        axis: Vec3,
    },
}

/// How friction depends on the direction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Orthotropy {
    /// Where the first axis points.
    pub lines: Lines,
    /// The largest shear along the first axis and across it, over the larger one.
    pub half: [f64; 2],
    /// The direction of slip.
    pub flow: SlipDirection,
}

impl Orthotropy {
    /// The direction of the first axis at a place in a surface with this unit normal; `None` where it has none.
    pub fn axis(&self, x: Vec3, normal: Vec3) -> Option<Vec3> {
        let line = match self.lines {
            Lines::Along(axis) => axis,
            Lines::Around { centre, axis } => cross(axis, sub(x, centre)),
        };
        let line = normalize(line)?;
        let across = add_scaled(line, -dot(line, normal), normal);
        (norm(across) > NO_AXIS)
            .then(|| normalize(across))
            .flatten()
    }

    /// The shape of what friction allows at a place, in a frame of `dim - 1` directions of slip; `None` where it is a circle.
    pub fn ellipse(&self, x: Vec3, frame: [Vec3; 2], dim: usize) -> Option<Ellipse> {
        let [first, second] = frame;
        let normal = normalize(cross(first, second))?;
        // An axis without a direction in the surface has been refused where surfaces lie; where a point gets there later, the coefficients go by the frame.
        let axis = self.axis(x, normal).unwrap_or(first);
        let angle = dot(axis, cross(normal, first)).atan2(dot(axis, first));
        if dim == 3 {
            return Some(Ellipse {
                half: self.half,
                // An axis has no sense.
                angle: angle.rem_euclid(std::f64::consts::PI),
                flow: self.flow,
            });
        }
        // Shear that would drive the point out of the plane is taken by what keeps it there: what dissipates most in the plane remains.
        let (sine, cosine) = angle.sin_cos();
        let [first, second] = self.half;
        let along = match self.flow {
            SlipDirection::Associated => (first * cosine).hypot(second * sine),
            SlipDirection::AgainstTraction => 1.0 / (cosine / first).hypot(sine / second),
        };
        Some(Ellipse {
            half: [along, 1.0],
            angle: 0.0,
            flow: self.flow,
        })
    }
}

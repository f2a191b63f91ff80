//! How the points that an `*ORIENTATION` gives are taken.

use crate::axes::{Local, frame};
use crate::motion::Motion;

/// How the points of an orientation, or of one of its elements, are taken.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Taken {
    pub cylindrical: bool,
    /// Local axis, from 0, and angle of a further rotation.
    pub turn: Option<(usize, f64)>,
    pub motion: Motion,
    /// Name of the `*DISTRIBUTION` with the points.
    pub distribution: Option<String>,
}

impl Taken {
    /// Axes from two points and the origin; `None` if they make none.
    pub fn local(&self, [a, b, c]: [[f64; 3]; 3]) -> Option<Local> {
        if self.cylindrical {
            let ends = [a, b].map(|x| self.motion.point(x));
            return (a != b).then_some(Local::Cylinder(ends));
        }
        let less = |x: [f64; 3]| [x[0] - c[0], x[1] - c[1], x[2] - c[2]];
        let mut axes = frame(less(a), less(b))?;
        if let Some((about, angle)) = self.turn {
            let (i, j) = ((about + 1) % 3, (about + 2) % 3);
            let (s, c) = angle.sin_cos();
            let (p, q) = (axes[i], axes[j]);
            axes[i] = std::array::from_fn(|k| c * p[k] + s * q[k]);
            axes[j] = std::array::from_fn(|k| c * q[k] - s * p[k]);
        }
        // Those of a part go with its instance.
        Some(Local::Axes(axes.map(|axis| self.motion.vector(axis))))
    }
}

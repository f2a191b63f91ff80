use std::fmt;

/// The numbering of unknowns: `dim` displacements a point, point by point.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, crate::keep::Keep)]
pub struct Dofs {
    /// Displacements a point: 2 or 3.
    pub dim: usize,
    /// Number of points.
    pub points: usize,
}

impl Dofs {
    /// The dof of `component` (0 = x) at `point`.
    #[inline]
    pub fn of(&self, point: usize, component: usize) -> usize {
        point * self.dim + component
    }

    /// Number of dofs.
    #[inline]
    pub fn count(&self) -> usize {
        self.dim * self.points
    }

    /// The point and component of a dof.
    #[inline]
    pub fn locate(&self, dof: usize) -> (usize, usize) {
        (dof / self.dim, dof % self.dim)
    }

    /// The vector at `point` in a dof vector, with a zero third component in 2D.
    #[inline]
    pub fn vector(&self, values: &[f64], point: usize) -> [f64; 3] {
        let mut v = [0.0; 3];
        v[..self.dim].copy_from_slice(&values[point * self.dim..(point + 1) * self.dim]);
        v
    }
}

/// A motion of a rigid body, by its axis (0 = x).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Motion {
    /// Of the centre of mass.
    Translation(usize),
    /// About the centre of mass.
    Rotation(usize),
}

impl fmt::Display for Motion {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let axis = |i: &usize| ["x", "y", "z"][*i];
        match self {
            Motion::Translation(i) => write!(f, "translation {}", axis(i)),
            Motion::Rotation(i) => write!(f, "rotation about {}", axis(i)),
        }
    }
}

/// A direction of space, or an axis about which reference points turn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum Component {
    /// Along x.
    X,
    /// Along y.
    Y,
    /// Along z.
    Z,
    /// About x `[rad]`, of reference points alone.
    RotationX,
    /// About y `[rad]`, of reference points alone.
    RotationY,
    /// About z `[rad]`, of reference points alone.
    RotationZ,
}

impl Component {
    /// As the motion of a reference point.
    pub fn motion(self) -> Motion {
        match self as usize {
            i @ 0..3 => Motion::Translation(i),
            i => Motion::Rotation(i - 3),
        }
    }
}

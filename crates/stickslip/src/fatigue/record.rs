//! What is kept of a cycle, and what was found of the last.

use crate::math::Vec3;

/// The cycle at hand and the last one that was judged: plain data, which a checkpoint holds.
#[derive(Debug, Clone, Default, crate::keep::Keep)]
pub struct Record {
    /// Stress of the points that are looked at `[Pa]`, six components each, by increment of the cycle at hand.
    pub stress: Vec<Vec<f64>>,
    /// Normal out of the primary, shear on the secondary `[Pa]` and slip `[m]`, at the nodes of interfaces one after the other, by increment.
    pub rubbed: Vec<Vec<[Vec3; 3]>>,
    /// What the last cycle was found to do, by criterion.
    pub found: Vec<Found>,
}

/// What there is to note of an increment.
pub struct CycleIncrement {
    /// A cycle begins with it.
    pub begins: bool,
    /// Stress of the points that are looked at `[Pa]`.
    pub stress: Vec<f64>,
    /// Normal, shear and slip at the nodes of interfaces.
    pub rubbed: Vec<[Vec3; 3]>,
}

impl Record {
    /// Takes note of an increment.
    pub fn enter(&mut self, increment: CycleIncrement) {
        if increment.begins {
            self.clear();
        }
        self.stress.push(increment.stress);
        self.rubbed.push(increment.rubbed);
    }

    /// The cycle is over, and this was found of it.
    pub fn close(&mut self, found: Vec<Found>) {
        self.found = found;
        self.clear();
    }

    fn clear(&mut self) {
        self.stress.clear();
        self.rubbed.clear();
    }
}

/// What a criterion said of a cycle.
#[derive(Debug, Clone, Default, crate::keep::Keep)]
pub struct Found {
    /// The criterion, as in tables and fields.
    pub name: String,
    /// Points, body by body.
    pub points: Vec<usize>,
    /// Its value at each.
    pub values: Vec<f64>,
    /// The normal of the worst plane there; that of the surface where it looks at that.
    pub normals: Vec<Vec3>,
}

/// Where a criterion was largest in a cycle.
#[derive(Debug, Clone, Default, PartialEq, serde::Serialize, crate::keep::Keep)]
#[serde(rename_all = "kebab-case")]
pub struct Maximum {
    /// The criterion, as in tables and fields.
    pub criterion: String,
    /// Its value: `[Pa]` of those that look at planes.
    pub value: f64,
    /// Step and cycle, those that are not computed counted too.
    pub step: usize,
    /// See `step`.
    pub cycle: usize,
    /// Number of the point in its mesh, and its place as meshed `[m]`.
    pub node: u64,
    /// See `node`.
    pub place: Vec3,
    /// Normal of the worst plane, that of the surface where the criterion looks at that.
    pub plane: Vec3,
}

//! What an interface knows of accepted increments: plain data, which a checkpoint holds and an increment that waits for its report keeps.

use std::sync::Arc;

use crate::contact::law::friction::{FrictionLaw, LawState};
use crate::contact::response::Status;
use crate::contact::worn::WornSurfaces;
use crate::math::Vec3;
use crate::system::Energy;

/// What commits have written. Everything that is reported follows from it, from the definition of the interface and from displacements.
#[derive(Debug, Clone, Default, PartialEq, crate::keep::Keep)]
pub struct History {
    /// By contact point.
    pub(in crate::contact) points: Vec<PointHistory>,
    /// Whether the points are those of an evaluation: not before the first commit, nor while the interface does not act.
    pub(in crate::contact) acting: bool,
    /// State variables of the friction law by contact point; empty where it has none.
    pub(in crate::contact) law_states: Vec<LawState>,
    /// Where points lay over the primary.
    pub(in crate::contact) opposite: Opposite,
    /// What was found when the interface began to act.
    pub(in crate::contact) start: Arc<Origin>,
    /// Springs act in place of multipliers, as explicit dynamics has it.
    pub(in crate::contact) springs: bool,
    /// Gaps at which springs that replace multipliers carry nothing `[m]`; empty where all of them are zero.
    pub(in crate::contact) rest: Arc<Vec<f64>>,
    /// Energies, of which all but the stored one add up over increments.
    pub(in crate::contact) energy: Energy,
    /// What sliding has worn off both surfaces.
    pub(in crate::contact) worn: WornSurfaces,
    /// Forces on the nodes `[N]`; empty before there was an accepted state.
    pub(in crate::contact) nodal: Vec<Vec3>,
    /// Energy dissipated per area at the nodes of the primary, by node `[J/m²]`; empty before anything slid.
    pub(in crate::contact) dissipated: Vec<f64>,
    /// Force, and moment about the centre of rotation, with which a moving obstacle pushed.
    pub(in crate::contact) pushed: [Vec3; 2],
    /// Largest velocity of slip below the limit over the last increment `[m/s]`.
    pub(in crate::contact) creep: f64,
    /// Whether the shear is what friction says.
    pub(in crate::contact) cone: FrictionError,
}

/// Committed history of a contact point.
#[derive(Debug, Clone, Copy, Default, PartialEq, crate::keep::Keep)]
pub(in crate::contact) struct PointHistory {
    pub pressure: f64,
    /// Shear traction on the secondary.
    pub shear: Vec3,
    /// Accumulated slip of the secondary over the primary.
    pub slip: Vec3,
    /// Length of the slip over the last increment, sticking points included `[m]`.
    pub moved: f64,
    pub gap: f64,
    pub normal: Vec3,
    pub status: Status,
    pub facet: Option<usize>,
    /// Area that the point stands for.
    pub area: f64,
    /// The part of the pressure that damping added.
    pub damping: f64,
    /// Energy that friction has dissipated here `[J/m²]`.
    pub dissipated: f64,
    /// Path over which it has worn, cycles that were not computed included `[m]`, and what friction dissipated on it `[J/m²]`.
    pub path: f64,
    pub spent: f64,
    /// The largest shear traction that could be carried `[Pa]`.
    pub limit: f64,
    /// Elastic energy of the spring that sticks `[J/m²]`.
    pub sheared: f64,
    /// Stiffness with which the enforcement acted against penetration, and of sticking `[Pa/m]`; infinite where the law itself was followed.
    pub stiffness: [f64; 2],
}

/// Nodes of the primary that points lay over, with their weights there.
#[derive(Debug, Clone, Default, PartialEq, crate::keep::Keep)]
pub(in crate::contact) struct Opposite {
    /// Where the nodes of each point end.
    ends: Vec<usize>,
    nodes: Vec<(usize, f64)>,
}

impl Opposite {
    /// Adds those of the next point.
    pub fn push(&mut self, nodes: impl Iterator<Item = (usize, f64)>) {
        self.nodes.extend(nodes);
        self.ends.push(self.nodes.len());
    }

    /// Those of a point; none where nothing was opposite.
    pub fn of(&self, i: usize) -> &[(usize, f64)] {
        let Some(&end) = self.ends.get(i) else {
            return &[];
        };
        let start = i.checked_sub(1).map_or(0, |before| self.ends[before]);
        &self.nodes[start..end]
    }
}

/// The gaps from which an interface counts.
#[derive(Debug, Clone, Default, PartialEq, crate::keep::Keep)]
pub(in crate::contact) struct Origin {
    /// It has begun to act.
    pub begun: bool,
    /// The time over which overlap is resolved `[s]`.
    pub span: [f64; 2],
    /// Gap at which a point counts as closed `[m]`, by point; empty until the interface acts, and where there is nothing to subtract.
    pub offset: Vec<f64>,
    /// Tied surfaces: distances that stay, by point, NaN where nothing near lies opposite; empty until they are found.
    pub glued: Vec<f64>,
    /// Gaps `[m]` of a motion that begins with overlap which multipliers will have pressed out at the end of the first increment, by point; empty
    /// after that, and where there is none.
    pub overlap: Vec<f64>,
}

/// What is wrong with the shear of an interface after an increment, and what that is relative to.
#[derive(Debug, Clone, Copy, Default, PartialEq, crate::keep::Keep)]
pub(in crate::contact) struct FrictionError {
    /// Largest amount by which the shear is not what friction says `[Pa]`.
    pub worst: f64,
    /// Largest amount by which the shear is beyond its limit `[Pa]`.
    pub over: f64,
    /// Largest limit `[Pa]`.
    pub limit: f64,
}

impl History {
    /// That of points at these places of the reference configuration under a friction law to which nothing has happened yet.
    pub fn new(places: &[Vec3], law: &dyn FrictionLaw) -> Self {
        let mut history = History {
            points: vec![PointHistory::default(); places.len()],
            ..History::default()
        };
        history.begin_law(places, law);
        history
    }

    /// Gives points the state variables with which the friction law begins.
    pub fn begin_law(&mut self, places: &[Vec3], law: &dyn FrictionLaw) {
        self.law_states = match law.states().is_empty() {
            true => Vec::new(),
            false => places
                .iter()
                .map(|&place| law.initial_state(place))
                .collect(),
        };
    }

    /// State variables of the friction law at a point; zeros where it has none.
    pub(in crate::contact) fn law_state(&self, i: usize) -> LawState {
        self.law_states.get(i).copied().unwrap_or_default()
    }

    /// Takes note of the gaps `[m]` of points that do not take part.
    pub fn note_gaps(&mut self, gaps: &[(usize, f64)]) {
        for &(i, gap) in gaps {
            if let Some(point) = self.points.get_mut(i) {
                point.gap = gap;
            }
        }
    }

    /// Whether it can be that of an interface with so many points.
    pub fn fits(&self, points: usize) -> bool {
        self.points.len() == points
    }

    /// Memory that it takes `[bytes]`.
    #[cfg(test)]
    pub(in crate::contact) fn taken(&self) -> usize {
        size_of_val(self.points.as_slice())
            + size_of_val(self.law_states.as_slice())
            + size_of_val(self.opposite.ends.as_slice())
            + size_of_val(self.opposite.nodes.as_slice())
            + size_of_val(self.nodal.as_slice())
            + size_of_val(self.dissipated.as_slice())
            + self.worn.bytes()
            + size_of_val(self.rest.as_slice())
            + size_of_val(self.start.offset.as_slice())
            + size_of_val(self.start.glued.as_slice())
    }

    /// Memory that it will take `[bytes]`, of an interface with so many points that lie over so many nodes of the primary in all, and so many nodes.
    pub(in crate::contact) fn bytes(points: usize, opposite: usize, nodes: usize) -> usize {
        let point = size_of::<PointHistory>() + size_of::<usize>() + 5 * size_of::<f64>();
        let node = size_of::<Vec3>() + size_of::<[f64; 2]>();
        points * point + opposite * size_of::<(usize, f64)>() + nodes * node
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nodes_opposite_are_kept_point_by_point() {
        let mut opposite = Opposite::default();
        let all = [vec![(3, 0.25), (4, 0.75)], vec![], vec![(1, 1.0)]];
        for nodes in &all {
            opposite.push(nodes.iter().copied());
        }
        for (i, nodes) in all.iter().enumerate() {
            assert_eq!(opposite.of(i), nodes.as_slice());
        }
        assert!(opposite.of(3).is_empty());
    }
}

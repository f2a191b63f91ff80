//! What is measured of an interface once for all rules.

use crate::contact::interface::InterfaceDefinition;
use crate::contact::look::Opposite;
use crate::contact::surface::spacing;
use crate::math::Vec3;

/// What is measured once for all rules, by interface.
pub(super) struct Measured {
    /// Gaps at the start, infinite where nothing lies opposite.
    pub(super) gaps: Vec<f64>,
    /// What lies nearest to each point, whichever way it faces: distance, outward normal, length of the facet.
    pub(super) nearest: Vec<Option<Beside>>,
}

/// What lies nearest to a point of the secondary.
#[derive(Debug, Clone, Copy)]
pub(super) struct Beside {
    pub(super) distance: f64,
    pub(super) normal: Vec3,
    /// Spacing of the nodes of the facet `[m]`; none of an obstacle.
    pub(super) facet: Option<f64>,
}

/// Measures an interface, given its gaps at the start.
pub(super) fn measure(interface: &InterfaceDefinition, gaps: &[f64], t: f64) -> Measured {
    use crate::contact::interface::Primary;
    let mut opposite = Opposite::new(interface, t);
    let nearest = interface.points.iter().map(|p| {
        let nearest = opposite.nearest(p.position(&interface.reference))?;
        let facet = match &interface.primary {
            Primary::Facets(facets) => Some(spacing(&facets[nearest.facet], &interface.reference)),
            Primary::Rigid(..) => None,
        };
        Some(Beside {
            distance: nearest.distance,
            normal: nearest.normal,
            facet,
        })
    });
    Measured {
        nearest: nearest.collect(),
        gaps: gaps.to_vec(),
    }
}

//! How far what is worn off goes beyond first order: a scar is added to gaps, and the surfaces themselves stay as they are.

use super::wear::track_profile;
use std::collections::HashMap;

use crate::contact::facet_point::evaluate;
use crate::contact::interface::view::ContactView;
use crate::contact::interface::{InterfaceDefinition, Primary};
use crate::contact::surface::{Facet, spacing};
use crate::math::{Vec3, cross, dot, norm, scale, sub};

/// The deepest and the steepest of what is worn off, each beside what it has to be small against.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct WearProfile {
    /// Largest slope of the depth along the surface `[-]`.
    pub slope: f64,
    /// Largest depth times the curvature of the surface it was worn off, as it was meshed `[-]`.
    pub curved: f64,
}

/// How far wear goes beyond first order; `None` where nothing is worn off that contact feels.
pub fn wear_profile(contact: ContactView) -> Option<WearProfile> {
    if !contact.laws.wears_away() {
        return None;
    }
    let mut depths = vec![0.0; contact.nodes.len()];
    let worn = &contact.state.worn;
    depths[..worn.opposite.len()].copy_from_slice(&worn.opposite);
    for (i, p) in contact.points.iter().enumerate() {
        if let Some(node) = p.node() {
            depths[node] = worn.own_depth(i);
        }
    }
    let own: Vec<&Facet> = contact.skin.iter().map(|s| &s.facet).collect();
    let theirs: Vec<&Facet> = match &contact.primary {
        Primary::Facets(facets) => facets.iter().collect(),
        Primary::Rigid(..) => Vec::new(),
    };
    let sides = [own, theirs].map(|facets| profile_of(contact, &facets, &depths));
    let [a, b] = sides;
    let [slope, curved] = track_profile(contact);
    Some(WearProfile {
        slope: a.slope.max(b.slope).max(slope),
        curved: a.curved.max(b.curved).max(curved),
    })
}

fn profile_of(contact: ContactView, facets: &[&Facet], depths: &[f64]) -> WearProfile {
    let mut profile = WearProfile::default();
    // Normal and centre of the faces around each node.
    let mut around: HashMap<usize, Vec<(Vec3, Vec3)>> = HashMap::new();
    for facet in facets {
        let nodes: Vec<Vec3> = facet.nodes.iter().map(|&n| contact.reference[n]).collect();
        let [s, t, _] = facet.kind.centre();
        let at = evaluate(facet.kind, &nodes, [s, t]);
        let across = cross(at.a[0], at.a[1]);
        let normal = scale(1.0 / norm(across), across);
        for (k, &a) in facet.nodes.iter().enumerate() {
            around.entry(a).or_default().push((normal, at.x));
            for (l, &b) in facet.nodes.iter().enumerate().skip(k + 1) {
                let way = norm(sub(nodes[k], nodes[l]));
                profile.slope = profile.slope.max((depths[a] - depths[b]).abs() / way);
            }
        }
    }
    for (node, faces) in around {
        for (i, (n, x)) in faces.iter().enumerate() {
            for (m, y) in &faces[i + 1..] {
                // Cosine of the angle between faces that meet at an edge, which is no curvature.
                if dot(*n, *m) > 0.9 {
                    let curvature = norm(sub(*n, *m)) / norm(sub(*x, *y));
                    profile.curved = profile.curved.max(depths[node] * curvature);
                }
            }
        }
    }
    profile
}

/// The longest way `[m]` that an increment may slide, times the cycles that it stands for, where what is worn off is felt from the next one on: a wave of the surface as
/// short as the mesh has it, of compliance `2 Δx / (π E*)`, is stable up to `4 Δx / (π k E*)`. `modulus`: the plane modulus of both bodies together `[Pa]`; `shear`: the
/// shear over the pressure. `None` where nothing is worn off.
pub fn explicit_limit(definition: &InterfaceDefinition, modulus: f64, shear: f64) -> Option<f64> {
    let rates = definition.laws.wear.as_dyn().fastest();
    let rate: f64 = rates.iter().map(|r| r.per_path(shear)).sum();
    let facets = definition
        .skin
        .iter()
        .map(|s| spacing(&s.facet, &definition.reference));
    let finest = facets.fold(f64::INFINITY, f64::min);
    let limit = 4.0 * finest / (std::f64::consts::PI * rate * modulus);
    (limit.is_finite() && definition.laws.wears_away()).then_some(limit)
}

//! How far what is worn off goes beyond first order: a scar is added to gaps, and the surfaces themselves stay as they are.

use std::collections::HashMap;

use super::definition::{Interface, Primary};
use crate::contact::facet_point::evaluate;
use crate::contact::surface::{Facet, spacing};
use crate::math::{Vec3, cross, dot, norm, scale, sub};

/// Cosine of the angle between faces from which they meet at an edge, which is no curvature.
const EDGE: f64 = 0.9;

/// The deepest and the steepest of what is worn off, each beside what it has to be small against.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Scar {
    /// Largest slope of the depth along the surface `[-]`.
    pub slope: f64,
    /// Largest depth times the curvature of the surface it was worn off, as it was meshed `[-]`.
    pub curved: f64,
}

impl Interface {
    /// How far wear goes beyond first order; `None` where nothing is worn off that contact feels.
    pub fn scar(&self) -> Option<Scar> {
        if !self.laws.wears_away() {
            return None;
        }
        let mut depths = vec![0.0; self.nodes.len()];
        for (depth, trace) in depths.iter_mut().zip(&self.history.traces) {
            *depth = trace[1];
        }
        for (h, p) in self.history.points.iter().zip(&self.points) {
            if let Some(node) = p.node() {
                depths[node] = h.worn;
            }
        }
        let own: Vec<&Facet> = self.skin.iter().map(|s| &s.facet).collect();
        let theirs: Vec<&Facet> = match &self.primary {
            Primary::Facets(facets) => facets.iter().collect(),
            Primary::Rigid(..) => Vec::new(),
        };
        let sides = [own, theirs].map(|facets| self.scar_of(&facets, &depths));
        let [a, b] = sides;
        let [slope, curved] = self.ground_scar();
        Some(Scar {
            slope: a.slope.max(b.slope).max(slope),
            curved: a.curved.max(b.curved).max(curved),
        })
    }

    fn scar_of(&self, facets: &[&Facet], depths: &[f64]) -> Scar {
        let mut scar = Scar::default();
        // Normal and centre of the faces around each node.
        let mut around: HashMap<usize, Vec<(Vec3, Vec3)>> = HashMap::new();
        for facet in facets {
            let nodes: Vec<Vec3> = facet.nodes.iter().map(|&n| self.reference[n]).collect();
            let [s, t, _] = facet.kind.centre();
            let at = evaluate(facet.kind, &nodes, [s, t]);
            let across = cross(at.a[0], at.a[1]);
            let normal = scale(1.0 / norm(across), across);
            for (k, &a) in facet.nodes.iter().enumerate() {
                around.entry(a).or_default().push((normal, at.x));
                for (l, &b) in facet.nodes.iter().enumerate().skip(k + 1) {
                    let way = norm(sub(nodes[k], nodes[l]));
                    scar.slope = scar.slope.max((depths[a] - depths[b]).abs() / way);
                }
            }
        }
        for (node, faces) in around {
            for (i, (n, x)) in faces.iter().enumerate() {
                for (m, y) in &faces[i + 1..] {
                    if dot(*n, *m) > EDGE {
                        let curvature = norm(sub(*n, *m)) / norm(sub(*x, *y));
                        scar.curved = scar.curved.max(depths[node] * curvature);
                    }
                }
            }
        }
        scar
    }

    /// The longest way `[m]` that an increment may slide, times the cycles that it stands for, where what is worn off is felt from the next one on: a wave of the surface as
    /// short as the mesh has it, of compliance `2 Δx / (π E*)`, is stable up to `4 Δx / (π k E*)`. `modulus`: the plane modulus of both bodies together `[Pa]`; `shear`: the
    /// shear over the pressure. `None` where nothing is worn off.
    pub fn explicit_limit(&self, modulus: f64, shear: f64) -> Option<f64> {
        let rates = self.laws.wear.as_dyn().fastest();
        let rate: f64 = rates.iter().map(|r| r.per_path(shear)).sum();
        let facets = self.skin.iter().map(|s| spacing(&s.facet, &self.reference));
        let finest = facets.fold(f64::INFINITY, f64::min);
        let limit = 4.0 * finest / (std::f64::consts::PI * rate * modulus);
        (limit.is_finite() && self.laws.wears_away()).then_some(limit)
    }

    /// The longest way `[m]` that a point which presses has slid over the last increment, times the cycles that it stands for: what [`Interface::explicit_limit`] is a limit of.
    pub fn slid(&self) -> f64 {
        let pressed = (self.cache.last.points.iter()).filter(|e| e.response.traction[0] > 0.0);
        let ways = pressed.map(|e| self.rubbed(&e.response, e.frames.before, e.moved));
        ways.fold(0.0, f64::max) * (1.0 + self.directives.skipped)
    }
}

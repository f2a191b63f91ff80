//! By how much the surfaces have turned since the start: what small sliding leaves out.

use super::definition::{Interface, Primary};
use crate::contact::facet_point::evaluate;
use crate::contact::surface::{Facet, turns};
use crate::math::{Vec3, add, angle, norm};

/// Part of the largest pressure that counts as pressing.
const PRESSED: f64 = 0.1;

impl Interface {
    /// The largest angle by which the normal of a point that presses differs from what it is now, at displacements `u` `[rad]`; zero unless normals are those
    /// of the reference configuration.
    ///
    /// It has two parts: by how much the secondary has turned there, and by how much the primary turns over the path that the point has slid.
    pub fn normals_turned(&self, u: &[f64]) -> f64 {
        let committed = &self.history.points;
        if !self.kinematics.as_dyn().frozen()
            || self.rigid()
            || committed.len() != self.points.len()
        {
            return 0.0;
        }
        let most = committed.iter().map(|h| h.pressure).fold(0.0, f64::max);
        if most <= 0.0 {
            return 0.0;
        }
        let (before, now) = (
            self.means(&self.reference),
            self.means(&self.coordinates(u)),
        );
        let bend = self.bend();
        let pressed = (committed.iter().enumerate()).filter(|(_, h)| h.pressure > PRESSED * most);
        pressed
            .map(|(i, h)| angle(before[i], now[i]).max(bend * norm(h.slip)))
            .fold(0.0, f64::max)
    }

    /// Sums of the normals of the faces around each point of the secondary.
    fn means(&self, x: &[Vec3]) -> Vec<Vec3> {
        let mut sums = vec![[0.0; 3]; self.points.len()];
        for skin in &self.skin {
            let nodes: Vec<Vec3> = skin.facet.nodes.iter().map(|&n| x[n]).collect();
            let [s, t, _] = skin.facet.kind.centre();
            let normal = evaluate(skin.facet.kind, &nodes, [s, t]).normal;
            for &p in &skin.points {
                sums[p] = add(sums[p], normal);
            }
        }
        sums
    }

    /// Mean curvature of the primary, edges of the body left out `[1/m]`.
    fn bend(&self) -> f64 {
        let Primary::Facets(facets) = &self.primary else {
            return 0.0;
        };
        let facets: Vec<&Facet> = facets.iter().collect();
        let turns = turns(&facets, &self.reference);
        let length = turns.iter().map(|t| t[1]).sum::<f64>();
        match length > 0.0 {
            true => turns.iter().map(|t| t[0]).sum::<f64>() / length,
            false => 0.0,
        }
    }
}

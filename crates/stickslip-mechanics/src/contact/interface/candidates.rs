//! Facets that may belong to the points of an interface, looked for when points have moved, and that which does.

use rayon::prelude::*;

use super::cache::Cache;
use super::definition::{Interface, Primary};
use super::evaluation::CHUNK;
use super::search::Search;
use crate::contact::bounds::Bounds;
use crate::contact::facet_point::FacetPoint;
use crate::contact::kinematics::{Part, rotation_of};
use crate::contact::pairing::{Choice, Previous};
use crate::contact::surface::ContactPoint;
use crate::math::{Vec3, dot, mat_vec};

/// Cosine of the angle up to which a surface looks where it looked in the reference configuration, for finding facets that look back.
const UNTURNED: f64 = 0.95;

impl Interface {
    /// Searches anew when the points have moved so far that a nearer facet might be missing from the candidates.
    pub(super) fn search(&self, search: &mut Search, x: &[Vec3]) {
        let Primary::Facets(facets) = &self.primary else {
            return;
        };
        if search.stale(x) {
            search.renew(&self.points, facets, x, self.facing(x));
        }
    }

    /// Outward normals of the contact points that have turned far since the reference configuration, by their faces; empty if none has.
    fn facing(&self, x: &[Vec3]) -> Vec<Vec3> {
        let mut around = vec![Vec::new(); self.points.len()];
        for skin in &self.skin {
            let corners = &skin.facet.nodes[..skin.facet.kind.corner_count()];
            for &p in &skin.points {
                around[p].push((corners, 1.0));
            }
        }
        let turned = |(point, around): (&ContactPoint, &Vec<Part>)| {
            let parts = around.iter().copied();
            let turn = rotation_of(parts, (x, &self.reference), self.dofs.dim);
            mat_vec(&turn, point.normal)
        };
        let normals: Vec<Vec3> = self.points.iter().zip(&around).map(turned).collect();
        let mut pairs = normals.iter().zip(&self.points);
        match pairs.any(|(n, p)| dot(*n, p.normal) < UNTURNED) {
            true => normals,
            false => Vec::new(),
        }
    }

    /// Bounds of the facets.
    pub(super) fn enclose(&self, x: &[Vec3], out: &mut Vec<Bounds>) {
        let around = self.facets().par_iter().with_min_len(CHUNK);
        around.map(|f| Bounds::around(f, x)).collect_into_vec(out);
    }

    /// The facet that a point belongs to, of those found by the search, and its projection there; the distance to the surface if it belongs to none.
    pub(super) fn closest(
        &self,
        i: usize,
        (x, before, bounds): (&[Vec3], &[Vec3], &[Bounds]),
        search: &Search,
        previous: Previous,
    ) -> Result<(usize, FacetPoint), f64> {
        let turned = search.facing.get(i).copied();
        let choice = Choice {
            facets: self.facets(),
            bounds,
            candidates: search.candidates.get(i).map_or(&[], Vec::as_slice),
            margin: search.margin,
            x,
            reference: &self.reference,
            position: self.points[i].position(x),
            outward: turned.unwrap_or(self.points[i].normal),
            edge_tolerance: self.edge_tolerance,
            walls: self.walls.of(self.facets(), &self.reference),
            before: match before.is_empty() {
                true => (before, [0.0; 3]),
                false => (before, self.points[i].position(before)),
            },
        };
        choice.closest(previous)
    }

    /// The same of all points, wherever they were.
    pub(super) fn closest_of_all(
        &self,
        x: &[Vec3],
        search: &Search,
    ) -> Vec<Result<(usize, FacetPoint), f64>> {
        let mut bounds = Vec::new();
        self.enclose(x, &mut bounds);
        (0..self.points.len())
            .map(|i| self.closest(i, (x, &[], &bounds), search, Previous::default()))
            .collect()
    }

    /// Pairs in the reference configuration, for small sliding.
    pub(super) fn pair_reference(&self, cache: &mut Cache) {
        let needed = self.mortar.is_none() && self.kinematics.as_dyn().frozen();
        if !needed || !cache.frozen.is_empty() {
            return;
        }
        self.search(&mut cache.search, &self.reference);
        let pairs = self.closest_of_all(&self.reference, &cache.search);
        cache.frozen = pairs.into_iter().map(Result::ok).collect();
    }
}

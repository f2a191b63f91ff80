//! What an interface has to know of the primary to keep a depth on it: at its nodes, or on a track.

use super::track::WearTrack;
use crate::contact::mortar::positive_areas;
use crate::contact::surface::{Facet, edges};
use crate::math::Vec3;

/// How the depth of the primary is divided among its nodes.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct OppositeWear {
    /// Area of each node `[m²]`, zero of those between corners; empty where nothing wears.
    pub(in crate::contact) area: Vec<f64>,
    /// The two corners whose mean a node has: twice itself of a corner.
    pub(in crate::contact) ends: Vec<[usize; 2]>,
    /// Where the depth is kept in place of nodes: of an obstacle, and where material moves past.
    pub(in crate::contact) track: Option<WearTrack>,
}

impl OppositeWear {
    /// Of facets with their nodes at `x`; `extent` is that out of the plane, thickness or `2πr`.
    pub fn new(facets: &[Facet], x: &[Vec3], extent: impl Fn(Vec3) -> f64 + Copy) -> Self {
        let mut out = OppositeWear {
            area: vec![0.0; x.len()],
            ends: (0..x.len()).map(|n| [n, n]).collect(),
            track: None,
        };
        for facet in facets {
            let corners = facet.kind.corner_count();
            let places: Vec<Vec3> = facet.nodes[..corners].iter().map(|&n| x[n]).collect();
            let areas = positive_areas(facet.kind.linear(), &places, extent);
            for (&n, area) in facet.nodes.iter().zip(areas) {
                out.area[n] += area;
            }
            let between = &facet.nodes[corners..];
            let all = [0, 1];
            let lines = edges(facet.kind).iter().map(|edge| match edge.len() {
                // Of a line both ends are one edge.
                1 => all.as_slice(),
                _ => edge,
            });
            for (&n, edge) in between.iter().zip(lines) {
                out.ends[n] = [facet.nodes[edge[0]], facet.nodes[edge[1]]];
            }
        }
        out
    }

    /// Of a primary whose depth is kept on a track.
    pub fn on(track: WearTrack) -> Self {
        OppositeWear {
            track: Some(track),
            ..OppositeWear::default()
        }
    }

    /// Whether there are nodes with a depth.
    pub fn is_empty(&self) -> bool {
        self.area.is_empty()
    }
}

//! Integrals over the part of one face of the secondary that has the primary opposite.

use super::cells::cells;
use super::face::Face;
use super::integral::FaceIntegral;
use super::interval::Interval;
use super::merge::Merged;
use super::plane::Plane;
use super::rim::{self, Rim};
use super::sides::Sides;
use super::sum::sum;
use super::view::{MetFacet, Sample, View, Wall, gather, looks_back};
use super::window::Window;
use crate::contact::projection::Patch;
use crate::contact::walls::depth_behind;
use crate::math::Vec3;

/// Room to work in.
#[derive(Debug, Default)]
pub struct Scratch {
    samples: Vec<Sample>,
}

/// Integrates over `face`, of which the facets `candidates` may lie opposite and the nodes `merged` have no multiplier.
pub fn integrate(
    face: &Face,
    merged: Merged,
    sides: &Sides,
    candidates: &[usize],
    scratch: &mut Scratch,
    out: &mut FaceIntegral,
) {
    out.clear();
    scratch.samples.clear();
    let view = View {
        face,
        x: gather(&face.nodes, sides.x),
        reference: gather(&face.nodes, sides.reference),
        normals: sides.normals(face),
    };
    let ends = |f: &usize| sides.facets[*f].continues.contains(&false);
    let opposite = Opposite {
        ends: candidates.iter().any(ends),
        candidates,
    };
    for cell in cells(face.kind, &face.nodes, sides.reference) {
        let normal = view.cell_normal(cell);
        match face.kind.dim() {
            1 => Interval::new(&view, cell, normal)
                .iter()
                .for_each(|w| meet(w, &view, normal, sides, opposite, scratch, out)),
            _ => Plane::new(&view, cell, normal)
                .iter()
                .for_each(|w| meet(w, &view, normal, sides, opposite, scratch, out)),
        }
    }
    let covered: f64 = scratch.samples.iter().map(|s| s.w).sum();
    // What covers less than this part of a face is left out.
    if covered < 1e-4 * face.area {
        out.clear();
        return;
    }
    sum(face, merged, sides, &scratch.samples, out);
}

/// Facets that may lie opposite, and whether an outer edge of the primary is among theirs.
#[derive(Clone, Copy)]
struct Opposite<'a> {
    candidates: &'a [usize],
    ends: bool,
}

/// Adds the quadrature points of a cell that have facets opposite.
fn meet<W: Window>(
    window: &W,
    view: &View,
    normal: Vec3,
    sides: &Sides,
    opposite: Opposite,
    scratch: &mut Scratch,
    out: &mut FaceIntegral,
) {
    let outward = match opposite.ends {
        true => {
            let own = Patch::new(view.face.kind, &view.x[..view.face.nodes.len()]);
            rim::normal(&own).unwrap_or(normal)
        }
        false => normal,
    };
    for &f in opposite.candidates {
        let facet = &sides.facets[f];
        let x = gather(&facet.nodes, sides.x);
        let x = &x[..facet.nodes.len()];
        let wall = Wall {
            depth: depth_behind(sides.walls, f),
            nodes: &facet.nodes,
            before: sides.before,
        };
        let mut known = None;
        for other in cells(facet.kind, &facet.nodes, sides.reference) {
            let Some(part) = window.common(x, other) else {
                continue;
            };
            let patch = Patch::new(facet.kind, x);
            if !looks_back(&patch, normal) {
                continue;
            }
            let piece = *known.get_or_insert_with(|| out.piece_of(f));
            let centre = facet.kind.centre();
            let mut start = [centre[0], centre[1]];
            let rim = Rim {
                face: view.face,
                x: &view.x[..view.face.nodes.len()],
                outward,
                sides,
                candidates: opposite.candidates,
                ends: opposite.ends,
                facet: f,
            };
            window.places(&part, facet.kind, &mut |xi, w| {
                let met = MetFacet {
                    piece,
                    facet: &patch,
                    wall: &wall,
                    rim: &rim,
                };
                view.sample(xi, w, met, &mut start, &mut scratch.samples);
            });
        }
    }
}

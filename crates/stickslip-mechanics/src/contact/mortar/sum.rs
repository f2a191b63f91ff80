//! Sums over the quadrature points of a face.

use super::dual::{Matrix, dual};
use super::face::{FACE_NODES, Face};
use super::integral::{Entry, FaceIntegral};
use super::sides::Sides;
use super::view::Sample;
use crate::math::add_scaled;

/// Sums over the quadrature points.
pub(super) fn sum(face: &Face, sides: &Sides, samples: &[Sample], out: &mut FaceIntegral) {
    let n = face.nodes.len();
    let mut m = Matrix::default();
    for s in samples {
        for (row, a) in m.iter_mut().zip(&s.positive[..n]) {
            for (m, b) in row.iter_mut().zip(&s.positive[..n]) {
                *m += s.w * a * b;
            }
        }
    }
    let functions = dual(&m, n);
    // Nodes of the primary, and where those of each piece are among them.
    let mut places: Vec<[usize; FACE_NODES]> = Vec::with_capacity(out.pieces.len());
    for piece in &out.pieces {
        let mut at = [0; FACE_NODES];
        for (at, &node) in at.iter_mut().zip(&sides.facets[piece.facet].nodes) {
            *at = match out.nodes.iter().position(|&known| known == node) {
                Some(known) => known,
                None => {
                    out.nodes.push(node);
                    out.nodes.len() - 1
                }
            };
        }
        places.push(at);
    }
    let opposite = out.nodes.len();
    out.secondary.resize(n * n, Entry::default());
    out.primary.resize(n * opposite, Entry::default());
    for s in samples {
        let piece = &mut out.pieces[s.piece];
        let count = sides.facets[piece.facet].nodes.len();
        let at = &places[s.piece][..count];
        piece.area += s.w;
        piece.direction = add_scaled(piece.direction, s.w, s.direction);
        for (sum, x) in piece.place.iter_mut().zip(s.place) {
            *sum += s.w * x;
        }
        for (sum, n) in piece.own[..n].iter_mut().zip(&s.n) {
            *sum += s.w * n;
        }
        for (sum, n) in piece.sums.iter_mut().zip(&s.opposite[..count]) {
            *sum += s.w * n;
        }
        for a in 0..n {
            let phi = match &functions {
                Some(f) => (0..n).map(|k| f[a][k] * s.positive[k]).sum(),
                // a sliver: functions that are not dual serve as well
                None => s.positive[a],
            };
            let w = s.w * phi;
            out.area[a] += w;
            out.gap[a] += w * s.gap;
            piece.shares[a] += w;
            for (b, entry) in out.secondary[a * n..(a + 1) * n].iter_mut().enumerate() {
                entry.add(w * s.n[b], s.direction);
            }
            let row = &mut out.primary[a * opposite..(a + 1) * opposite];
            for (&k, n) in at.iter().zip(s.opposite) {
                row[k].add(w * n, s.direction);
            }
        }
    }
}

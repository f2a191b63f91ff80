//! Which facet a point belongs to.

use crate::contact::bounds::Bounds;
use crate::contact::facet_point::{FACET_NODES, FacetPoint, evaluate};
use crate::contact::projection::{Foot, facet_distance};
use crate::contact::surface::{EDGE_ANGLE, Facet};
use crate::contact::walls::depth_behind;
use crate::math::{Vec3, add, cross, dot, norm, scale, sub};
use crate::tolerance::SAME;

/// How far a point may hang over an outer edge of the primary, relative to the facet. Where edges of both bodies coincide, strains move points over the edge: a tolerance below the strain
/// lets these points come and go with the pressure that they carry, and then some problems have no solution. Tuned: of the random problems that failed with 1e-3 all are solved with any
/// value from 3e-3 to 0.1. Abaqus extends its surfaces by 0.1; CalculiX lets points go at about 1.5e-3, and with 5e-3 they still leave in the same increment of the example press-and-slide.
const EDGE_TOLERANCE: f64 = 5e-3;

/// How far beyond a facet, relative to its size, a point may be and stay on it while the surface is flat. With
/// 3e-4 all short cases (see [`tolerance`](crate::tolerance)) agree to 1e-8; with 3e-3 the centre of pressure of the random problem 41 moves
/// by a third, as it stays on a facet beside which it lies.
const KEPT_BEYOND: f64 = 1e-3;

/// How far beyond a facet, relative to its size, a point that goes back and forth in a valley may be and stay on it. Where facets turn by an angle from each
/// to the next, the smooth surface that they stand for lies up to an eighth of it, times their size, away from them; so far the next facet is missed.
const HELD_BEYOND: f64 = 0.125;

/// One minus the cosine of the angle between facets that make a flat surface. Together with `KEPT_BEYOND` it bounds the error of the gap to
/// some 1e-6 of the facet.
const FLAT_COSINE: f64 = 1e-5;

/// A point and the facets among which its own is.
#[derive(Debug, Clone, Copy)]
pub struct Choice<'a> {
    /// All facets of the primary.
    pub facets: &'a [Facet],
    /// Where they lie, and which way they look.
    pub bounds: &'a [Bounds],
    /// Those that come into question, ascending.
    pub candidates: &'a [usize],
    /// Distance up to which facets were looked for `[m]`.
    pub margin: f64,
    /// Coordinates of all nodes now and in the reference configuration.
    pub x: &'a [Vec3],
    /// In the reference configuration.
    pub reference: &'a [Vec3],
    /// Place of the point, and the outward normal of its surface.
    pub position: Vec3,
    /// Outward normal of the surface of the point.
    pub outward: Vec3,
    /// How deep behind each facet a point may lie and meet it `[m]`; empty where any depth will do.
    pub walls: &'a [f64],
    /// Coordinates of all nodes at the last accepted state, and the place of the point then; no coordinates where they are not known.
    pub before: (&'a [Vec3], Vec3),
}

/// The facet on which a point was, and where.
#[derive(Debug, Clone, Copy, Default)]
pub struct Previous {
    /// The facet.
    pub facet: Option<usize>,
    /// The coordinates of the projection on it; `None` where they are no guide.
    pub near: Option<[f64; 2]>,
    /// The point has gone back and forth between facets.
    pub held: bool,
}

/// A point over one of its candidates.
#[derive(Clone, Copy)]
struct Look {
    p: Foot,
    /// A length of the facet, for tolerances.
    size: f64,
    away: f64,
    beyond: f64,
    carried: bool,
}

/// A length of a facet, for tolerances.
fn facet_size(facet: &Facet, p: &Foot) -> f64 {
    match facet.kind.dim() {
        1 => 2.0 * norm(p.a[0]),
        _ => norm(cross(p.a[0], p.a[1])).sqrt(),
    }
}

impl Choice<'_> {
    /// The facet that the point belongs to and its projection there.
    ///
    /// The nearest facet wins; between equally near ones, and behind a ridge, the previous one. Beyond an edge where the surface goes on the facet is extended, so that a point
    /// in a re-entrant corner is not lost; beyond an outer edge the point is free.
    ///
    /// # Errors
    /// The distance to the surface, where the point belongs to none.
    pub fn closest(&self, previous: Previous) -> Result<(usize, FacetPoint), f64> {
        let Some(first) = self.likely(previous.facet) else {
            return Err(f64::INFINITY);
        };
        let near = previous.near.filter(|_| previous.facet == Some(first));
        let mut seed = self.look(first, near);
        let mut nearest = seed.as_ref().map_or(f64::INFINITY, |look| look.away);
        let mut best: Option<(usize, Look)> = None;
        let mut kept: Option<Look> = None;
        for &f in self.candidates {
            let look = if f == first {
                seed.take()
            } else {
                // Beyond a facet `away` is the distance to a place of it, at least that to its box.
                // There is room for facets that are equally near.
                let limit = nearest + 1e-8 * self.margin;
                if self.box_distance2(f) > limit * limit || !self.may_face(f) {
                    continue;
                }
                self.look(f, None)
            };
            let Some(look) = look else {
                continue;
            };
            nearest = nearest.min(look.away);
            let reach = if previous.held {
                HELD_BEYOND
            } else {
                KEPT_BEYOND
            };
            if previous.facet == Some(f) && look.carried && look.beyond <= reach * look.size {
                kept = Some(look);
            }
            let better = match &best {
                None => true,
                Some((b, held)) => self.better(f, &look, *b, held, previous.facet),
            };
            if better {
                best = Some((f, look));
            }
        }
        match (best, kept, previous.facet) {
            // Where the surface is flat the facet makes no difference: staying on it keeps Newton from going back and forth. Under a ridge it does, and
            // nearest changes where the feet on both facets still lie within them: a point that is held there would have an equilibrium on neither.
            // The point goes over the ridge when its foot does. In a valley each facet pushes it onto the other: if that takes it farther than it may go, it has
            // an equilibrium on neither, and stays on the one that it has come back to.
            (Some((_, look)), Some(k), Some(f))
                if look.carried && self.stays(&k, &look, previous.held) =>
            {
                Ok((f, self.meets(f, k.p)))
            }
            (Some((f, look)), ..) if look.carried => Ok((f, self.meets(f, look.p))),
            _ => Err(nearest),
        }
    }

    /// The place of a facet with its shape functions.
    fn meets(&self, f: usize, foot: Foot) -> FacetPoint {
        let facet = &self.facets[f];
        let mut nodes = [[0.0; 3]; FACET_NODES];
        evaluate(facet.kind, facet.gather(self.x, &mut nodes), foot.xi)
    }

    /// Whether a point that may stay where it was does, though another facet is nearest.
    fn stays(&self, k: &Look, nearest: &Look, held: bool) -> bool {
        let cosine = dot(nearest.p.normal, k.p.normal);
        let near = k.beyond <= KEPT_BEYOND * k.size;
        let within = |above: f64| {
            let mut both = [k, nearest].into_iter();
            both.all(|look| self.height(&look.p) <= above * look.size)
        };
        // A point that is held by next to no force may be on either side of a facet, one that goes back and forth a little above it.
        near && (cosine > 1.0 - FLAT_COSINE || within(SAME))
            || held && cosine > EDGE_ANGLE.cos() && within(KEPT_BEYOND)
    }

    /// Height of the point above the plane of its projection.
    fn height(&self, p: &Foot) -> f64 {
        dot(sub(self.position, p.x), p.normal)
    }

    /// Whether the point lies on the inner side of its projection's plane.
    fn behind(&self, p: &Foot) -> bool {
        self.height(p) < 0.0
    }

    /// Whether the point is behind a facet because it lies beyond the body there: it is deeper than the wall allows, and was so at the last accepted state.
    fn beyond_wall(&self, f: usize, p: &Foot) -> bool {
        let depth = depth_behind(self.walls, f);
        if self.height(p) >= -depth {
            return false;
        }
        let (before, position) = self.before;
        if before.is_empty() {
            return true;
        }
        let facet = &self.facets[f];
        let mut nodes = [[0.0; 3]; FACET_NODES];
        let then = evaluate(facet.kind, facet.gather(before, &mut nodes), p.xi);
        dot(sub(position, then.x), p.normal) < -depth
    }

    fn box_distance2(&self, f: usize) -> f64 {
        self.bounds[f].space.distance2(self.position)
    }

    fn may_face(&self, f: usize) -> bool {
        self.bounds[f].may_face(self.outward)
    }

    /// The candidate to look at first: the previous one, or of those that may face the point that with the nearest box. Facets that cannot be as near need not be
    /// projected on.
    fn likely(&self, previous: Option<usize>) -> Option<usize> {
        let previous = previous.filter(|f| self.candidates.binary_search(f).is_ok());
        previous.or_else(|| {
            let facing = self.candidates.iter().filter(|&&f| self.may_face(f));
            let nearest = facing.map(|&f| (self.box_distance2(f), f));
            nearest.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, f)| f)
        })
    }

    /// The point over a facet; `None` if it has no projection there, or if the two do not face each other.
    fn look(&self, f: usize, near: Option<[f64; 2]>) -> Option<Look> {
        let facet = &self.facets[f];
        let patch = &self.bounds[f].patch;
        let position = self.position;
        let p = match near {
            Some(xi) => patch.project_near(position, xi)?,
            None => patch.project(position)?,
        };
        if dot(p.normal, self.outward) >= 0.0 || self.beyond_wall(f, &p) {
            return None;
        }
        let size = facet_size(facet, &p);
        let over = patch.beyond(&p);
        // A facet is extended for points near its edge. Behind the plane of a distant one lie points that no facet nearby faces, such as
        // those on the far side of a ball.
        let far_behind = self.behind(&p) && over.distance > size;
        let extended = facet.continues[over.edge] && !far_behind;
        Some(Look {
            p,
            size,
            away: facet_distance(position, &p, over),
            beyond: over.distance,
            carried: over.distance <= EDGE_TOLERANCE * size || extended,
        })
    }

    /// Whether facet `f` is the point's own rather than `b`.
    fn better(
        &self,
        f: usize,
        look: &Look,
        b: usize,
        held: &Look,
        previous: Option<usize>,
    ) -> bool {
        // Distances equal but for rounding: an edge both facets share.
        let tie = (look.away - held.away).abs() <= SAME * look.size;
        match (look.carried, held.carried, tie) {
            (true, false, true) => true,
            (false, true, true) => false,
            (_, _, true) if previous == Some(f) || previous == Some(b) => previous == Some(f),
            (_, _, true) => self.precedes(f, look, b, held),
            _ => look.away < held.away,
        }
    }

    /// Which of two facets that are equally near the point is its own, whatever their numbers: the one that looks at it more, or, where they look alike, the
    /// one whose middle comes first in the reference configuration.
    fn precedes(&self, f: usize, look: &Look, b: usize, held: &Look) -> bool {
        let facing = |look: &Look| dot(look.p.normal, self.outward);
        let apart = facing(look) - facing(held);
        if apart.abs() > SAME {
            return apart < 0.0;
        }
        let middle = |f: usize| {
            let nodes = &self.facets[f].nodes;
            let sum = nodes
                .iter()
                .fold([0.0; 3], |s, &n| add(s, self.reference[n]));
            scale(1.0 / nodes.len() as f64, sum)
        };
        let first = sub(middle(f), middle(b));
        let tie = SAME.sqrt() * look.size;
        first
            .iter()
            .find(|d| d.abs() > tie)
            .is_some_and(|d| *d < 0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::ElementKind;

    fn line(nodes: [usize; 2]) -> Facet {
        Facet {
            kind: ElementKind::Line2,
            nodes: nodes.to_vec(),
            continues: vec![true; 2],
            modulus: 1.0,
            cell: 1,
        }
    }

    /// The facet of two, from the first to the second node and on to the third, that a point above them belongs to.
    fn chosen(x: &[Vec3; 3], position: Vec3, previous: usize, held: bool) -> usize {
        let facets = [line([0, 1]), line([1, 2])];
        let bounds = [0, 1].map(|f| Bounds::around(&facets[f], x));
        let choice = Choice {
            facets: &facets,
            bounds: &bounds,
            candidates: &[0, 1],
            margin: 1.0,
            x,
            reference: x,
            position,
            outward: [0.0, -1.0, 0.0],
            walls: &[],
            before: (&[], position),
        };
        let previous = Previous {
            facet: Some(previous),
            held,
            ..Previous::default()
        };
        choice.closest(previous).expect("a facet").0
    }

    /// In a valley, where a point goes over to the next facet and is pushed back by it, it stays on the one it is on once it is held there: as far beyond as the
    /// facets differ from a smooth surface, and not where they make a corner.
    #[test]
    fn a_point_that_goes_to_and_fro_in_a_valley_is_held_by_the_facet_it_is_on() {
        let valley = [[1.0, 0.02, 0.0], [0.0; 3], [-1.0, 0.02, 0.0]];
        // On the plane of the first facet, this far beyond its end, or next to it.
        let beyond = |x: &[Vec3; 3], s: f64, height: f64| [-s * x[0][0], height - s * x[0][1], 0.0];
        for height in [0.0, 1e-6] {
            let at = |s: f64| beyond(&valley, s, height);
            assert_eq!(
                [
                    chosen(&valley, at(0.05), 0, false),
                    chosen(&valley, at(0.05), 0, true)
                ],
                [1, 0]
            );
            assert_eq!(chosen(&valley, at(0.05), 1, true), 1, "its own");
            assert_eq!(chosen(&valley, at(0.2), 0, true), 1, "too far");
        }
        let high = beyond(&valley, 0.05, 0.1);
        assert_eq!(
            chosen(&valley, high, 0, true),
            1,
            "nowhere near the surface"
        );
        let corner = [[1.0, 0.5, 0.0], [0.0; 3], [-1.0, 0.5, 0.0]];
        assert_eq!(chosen(&corner, beyond(&corner, 0.05, 0.0), 0, true), 1);
        // What goes back and forth loses nothing of what holds the others.
        let next_to = beyond(&corner, 5e-4, 0.0);
        assert_eq!(
            [false, true].map(|held| chosen(&corner, next_to, 0, held)),
            [0, 0]
        );
    }

    /// A point that a thousandth of a billionth of a facet of play lets lie above or below a ridge stays on the facet on which it is held: Newton's method went to
    /// and fro between the two, whose normals differ.
    #[test]
    fn a_point_on_a_ridge_stays_on_its_facet_whichever_side_rounding_puts_it() {
        let x = [[1.0, -0.02, 0.0], [0.0; 3], [-1.0, -0.02, 0.0]];
        let on = |position: Vec3, previous: usize| chosen(&x, position, previous, false);
        for height in [-1e-10, -1e-14, 0.0, 1e-14, 1e-10] {
            for aside in [-1e-9, 0.0, 1e-9] {
                let position = [aside, height, 0.0];
                assert_eq!([on(position, 0), on(position, 1)], [0, 1], "{position:?}");
            }
        }
        // It goes over where its foot does, and well above the ridge the nearest facet is its own.
        assert_eq!(on([-1e-2, -1e-3, 0.0], 0), 1);
        assert_eq!(on([-1e-3, 1e-2, 0.0], 0), 1);
    }
}

//! Cutting polygons in a plane.

/// A point in the plane.
pub type Point = [f64; 2];

/// Most corners: each of the four sides of a face adds one at most to the four corners of a facet.
pub const MOST_CORNERS: usize = 8;

/// A convex polygon, counter-clockwise.
#[derive(Debug, Clone, Copy, Default)]
pub struct Polygon {
    corners: [Point; MOST_CORNERS],
    count: usize,
}

impl Polygon {
    /// From its corners.
    pub fn new(corners: impl Iterator<Item = Point>) -> Self {
        let mut polygon = Polygon::default();
        for corner in corners.take(MOST_CORNERS) {
            polygon.push(corner);
        }
        polygon
    }

    fn push(&mut self, corner: Point) {
        if self.count < MOST_CORNERS {
            self.corners[self.count] = corner;
            self.count += 1;
        }
    }

    /// Its corners.
    pub fn corners(&self) -> &[Point] {
        &self.corners[..self.count]
    }

    /// The same the other way round.
    pub fn reversed(mut self) -> Self {
        self.corners[..self.count].reverse();
        self
    }

    /// The same without corners that hardly stick out, each by a triangle of no more than `least`, and from another corner on: the first one along a
    /// direction in which corners of ordinary meshes do not lie side by side.
    ///
    /// Where edges coincide rounding decides at which corner cutting begins, and whether there is another corner somewhere along the edge. The
    /// triangles that the polygon is divided into must not depend on that.
    pub fn in_order(mut self, least: f64) -> Self {
        const DIRECTION: Point = [0.833, 0.553];
        let mut k = 0;
        while k < self.count && self.count > 2 {
            let c = self.corners();
            let (a, p, b) = (c[(k + c.len() - 1) % c.len()], c[k], c[(k + 1) % c.len()]);
            let out = (p[0] - a[0]) * (b[1] - a[1]) - (p[1] - a[1]) * (b[0] - a[0]);
            if 0.5 * out.abs() <= least {
                self.corners[k..self.count].rotate_left(1);
                self.count -= 1;
            } else {
                k += 1;
            }
        }
        let along = |p: &Point| DIRECTION[0] * p[0] + DIRECTION[1] * p[1];
        let all = &mut self.corners[..self.count];
        let first = (0..all.len()).min_by(|&i, &j| along(&all[i]).total_cmp(&along(&all[j])));
        all.rotate_left(first.unwrap_or(0));
        self
    }

    /// Signed area, positive if counter-clockwise.
    pub fn area(&self) -> f64 {
        let c = self.corners();
        let Some(&first) = c.first() else {
            return 0.0;
        };
        let from = |p: Point| [p[0] - first[0], p[1] - first[1]];
        let pairs = c.windows(2).map(|w| (from(w[0]), from(w[1])));
        0.5 * pairs.map(|(a, b)| a[0] * b[1] - a[1] * b[0]).sum::<f64>()
    }

    /// The part of it inside `window`, a convex polygon that is counter-clockwise too ([Sutherland and Hodgman](stickslip_base::references::sutherland_hodgman_1974)).
    pub fn cut(&self, window: &Polygon) -> Polygon {
        let mut out = *self;
        let sides = window.corners();
        for (k, &from) in sides.iter().enumerate() {
            let to = sides[(k + 1) % sides.len()];
            let along = [to[0] - from[0], to[1] - from[1]];
            let height = |p: Point| along[0] * (p[1] - from[1]) - along[1] * (p[0] - from[0]);
            let subject = out;
            out.count = 0;
            let corners = subject.corners();
            for (i, &a) in corners.iter().enumerate() {
                let b = corners[(i + 1) % corners.len()];
                let (ha, hb) = (height(a), height(b));
                if ha >= 0.0 {
                    out.push(a);
                }
                if (ha > 0.0 && hb < 0.0) || (ha < 0.0 && hb > 0.0) {
                    // From the inner end, so that neighbours find the same point.
                    let (inner, outer, hi, ho) = if ha > hb {
                        (a, b, ha, hb)
                    } else {
                        (b, a, hb, ha)
                    };
                    let t = hi / (hi - ho);
                    out.push([
                        inner[0] + t * (outer[0] - inner[0]),
                        inner[1] + t * (outer[1] - inner[1]),
                    ]);
                }
            }
            if out.count < 3 {
                return Polygon::default();
            }
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(x: f64, y: f64, s: f64) -> Polygon {
        Polygon::new([[x, y], [x + s, y], [x + s, y + s], [x, y + s]].into_iter())
    }

    #[test]
    fn pieces_of_a_grid_make_up_the_whole() {
        let turned = [[0.1, 0.05], [0.93, 0.2], [0.8, 0.9], [0.02, 0.7]];
        let whole = Polygon::new(turned.into_iter());
        let mut sum = 0.0;
        for i in 0..5 {
            for j in 0..5 {
                sum += square(0.2 * f64::from(i), 0.2 * f64::from(j), 0.2)
                    .cut(&whole)
                    .area();
            }
        }
        assert!((sum - whole.area()).abs() < 1e-14);
    }

    #[test]
    fn corners_are_no_matter_of_rounding_and_order() {
        let mut corners = [
            [0.0, 0.0],
            [0.3, -1e-17],
            [1.0, 0.0],
            [1.0, 1.0],
            [0.0, 1.0],
        ];
        for _ in 0..5 {
            corners.rotate_left(1);
            let polygon = Polygon::new(corners.into_iter()).in_order(1e-14);
            let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
            assert_eq!(polygon.corners(), square);
        }
    }

    #[test]
    fn what_lies_apart_leaves_nothing() {
        assert_eq!(
            square(0.0, 0.0, 1.0).cut(&square(1.5, 0.0, 1.0)).area(),
            0.0
        );
        assert!(
            square(0.0, 0.0, 1.0)
                .cut(&square(1.0, 0.0, 1.0))
                .area()
                .abs()
                < 1e-15
        );
        assert_eq!(square(0.0, 0.0, 1.0).reversed().area(), -1.0);
    }
}

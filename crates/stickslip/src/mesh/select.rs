//! Points and boundary facets by where they are.

use super::{FacetRef, Mesh};
use crate::math::{Vec3, distance, dot, normalize, sub};

impl Mesh {
    /// The points within `tolerance` `[length]` of a place, sorted.
    pub fn points_near(&self, place: Vec3, tolerance: f64) -> Vec<usize> {
        self.points_where(|x| distance(x, place) <= tolerance)
    }

    /// The point nearest to a place, the first of several; `None` without points.
    pub fn nearest_point(&self, place: Vec3) -> Option<usize> {
        (0..self.points.len()).min_by(|&a, &b| {
            distance(self.points[a], place).total_cmp(&distance(self.points[b], place))
        })
    }

    /// The points in a box, its faces included, sorted.
    pub fn points_in_box(&self, lo: Vec3, hi: Vec3) -> Vec<usize> {
        self.points_where(|x| (0..3).all(|i| lo[i] <= x[i] && x[i] <= hi[i]))
    }

    /// The points within `tolerance` `[length]` of the plane through `origin` with normal `normal`, sorted; none if the
    /// normal is zero.
    pub fn points_on_plane(&self, origin: Vec3, normal: Vec3, tolerance: f64) -> Vec<usize> {
        match normalize(normal) {
            Some(n) => self.points_where(|x| dot(sub(x, origin), n).abs() <= tolerance),
            None => Vec::new(),
        }
    }

    /// The boundary facets all of whose points are among `points` (sorted).
    pub fn boundary_within(&self, points: &[usize]) -> Vec<FacetRef> {
        let mut boundary = self.boundary();
        boundary.retain(|&facet| {
            let (_, nodes) = self.facet_points(facet);
            nodes.iter().all(|p| points.binary_search(p).is_ok())
        });
        boundary
    }

    /// The boundary facets all of whose points lie in a box.
    pub fn boundary_in_box(&self, lo: Vec3, hi: Vec3) -> Vec<FacetRef> {
        self.boundary_within(&self.points_in_box(lo, hi))
    }

    /// The boundary facets all of whose points lie within `tolerance` `[length]` of a plane.
    pub fn boundary_on_plane(&self, origin: Vec3, normal: Vec3, tolerance: f64) -> Vec<FacetRef> {
        self.boundary_within(&self.points_on_plane(origin, normal, tolerance))
    }

    fn points_where(&self, test: impl Fn(Vec3) -> bool) -> Vec<usize> {
        (0..self.points.len())
            .filter(|&p| test(self.points[p]))
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::super::generators::{Generate, Rectangle};

    #[test]
    fn places_find_points_and_facets() {
        let mesh = Rectangle::new([0.0, 0.0], [4.0, 2.0], [4, 2])
            .generate()
            .unwrap();
        let near = mesh.points_near([1.0, 1.0, 0.0], 0.1);
        assert_eq!(near.len(), 1);
        assert_eq!(mesh.points[near[0]], [1.0, 1.0, 0.0]);
        assert_eq!(mesh.nearest_point([1.2, 0.9, 0.0]), Some(near[0]));
        assert_eq!(mesh.points_near([1.0, 1.0, 0.0], 1.0).len(), 5);

        let top = mesh.boundary_on_plane([0.0, 2.0, 0.0], [0.0, 3.0, 0.0], 1e-9);
        assert_eq!(&top, &mesh.facet_sets["top"]);
        let part = mesh.boundary_in_box([0.9, 1.9, -1.0], [3.1, 2.1, 1.0]);
        assert_eq!(part.len(), 2);
        assert!(part.iter().all(|f| top.contains(f)));
        assert!(mesh.points_on_plane([0.0; 3], [0.0; 3], 1.0).is_empty());
    }
}

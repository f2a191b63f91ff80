//! Boundary facets by their points.

use super::{FacetRef, Mesh};

/// The boundary facets all of whose points are among `points` (sorted).
pub fn boundary_within(mesh: &Mesh, points: &[usize]) -> Vec<FacetRef> {
    let mut boundary = mesh.boundary();
    boundary.retain(|&facet| {
        let (_, nodes) = mesh.facet_points(facet);
        nodes.iter().all(|p| points.binary_search(p).is_ok())
    });
    boundary
}

#[cfg(test)]
mod tests {
    use super::super::generators::{Generate, Rectangle};
    use super::boundary_within;

    #[test]
    fn facets_are_found_by_their_points() {
        let mesh = Rectangle::new([0.0, 0.0], [4.0, 2.0], [4, 2])
            .generate()
            .unwrap();
        let high = |lo: f64, hi: f64| -> Vec<usize> {
            let points = 0..mesh.points.len();
            points
                .filter(|&p| {
                    let x = mesh.points[p];
                    x[1] > 1.9 && lo < x[0] && x[0] < hi
                })
                .collect()
        };
        let top = boundary_within(&mesh, &high(-1.0, 5.0));
        assert_eq!(&top, &mesh.facet_sets["top"]);
        let part = boundary_within(&mesh, &high(0.9, 3.1));
        assert_eq!(part.len(), 2);
        assert!(part.iter().all(|f| top.contains(f)));
    }
}

//! How large a surface is, and which way it looks.

use stickslip::math::{Vec3, add, cross, norm, scale, sub};
use stickslip::mesh::FacetRef;

use super::bodies::Bodies;

/// The sum of area vectors, the area, and the number of facets of a surface.
pub(super) fn measure(bodies: &Bodies, facets: &[FacetRef]) -> (Vec3, f64) {
    let mesh = bodies.mesh();
    let (mut sum, mut total) = ([0.0; 3], 0.0);
    for facet in facets {
        let (kind, points) = mesh.facet_points(*facet);
        let x: Vec<Vec3> = points.iter().map(|p| mesh.points[*p]).collect();
        let corners = kind.corner_count().min(x.len());
        let area = match corners {
            2 => {
                let d = sub(x[1], x[0]);
                [d[1], -d[0], 0.0]
            }
            _ => (1..corners.saturating_sub(1)).fold([0.0; 3], |s, i| {
                add(s, scale(0.5, cross(sub(x[i], x[0]), sub(x[i + 1], x[0]))))
            }),
        };
        sum = add(sum, area);
        total += norm(area);
    }
    (sum, total)
}

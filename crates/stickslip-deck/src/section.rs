//! What a surface carries: `*SECTION PRINT`.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use stickslip::body::fields;

use stickslip::body::Elastic;
use stickslip::math::{Vec3, add_scaled, cross, dot, norm, normalize, sub};
use stickslip::mesh::{CellRef, FacetRef, Mesh};
use stickslip::results::Analysis;
use stickslip::shape::MAX_NODES;

use crate::fortran::{row, time};

/// Sums over a surface.
#[derive(Debug, Default)]
struct Sums {
    force: Vec3,
    /// About the origin.
    moment: Vec3,
    area: f64,
    /// Area times place.
    first: Vec3,
    /// Area times normal.
    normal: Vec3,
}

/// Prints force and moment of a surface, which has these faces: element, and face of its cell from 0. Stresses are those at the nodes, as in CalculiX:
/// extrapolated from the points of integration and averaged over the elements that meet there.
pub(crate) fn print(
    analysis: &Analysis,
    out: &mut String,
    name: &str,
    faces: &[(u64, usize)],
    at: f64,
) {
    let mesh = &analysis.model.mesh;
    let cells: BTreeMap<u64, CellRef> = mesh.cells().map(|c| (mesh.cell_id(c), c)).collect();
    let facets = faces.iter().filter_map(|(element, face)| {
        Some(FacetRef {
            cell: *cells.get(element)?,
            face: *face,
        })
    });
    let facets: Vec<FacetRef> = facets.collect();
    let mut sums = Sums::default();
    for body in &analysis.model.bodies {
        let elastic = &body.elastic;
        let own = |f: &&FacetRef| {
            let points = mesh.cell_points(f.cell);
            points.first().is_some_and(|p| body.points.contains(p))
        };
        let mine: Vec<&FacetRef> = facets.iter().filter(own).collect();
        if mine.is_empty() {
            continue;
        }
        let stress = fields::nodal_stress(elastic, &analysis.frame.state.u);
        let by_point: BTreeMap<usize, [f64; 6]> =
            elastic.points().iter().copied().zip(stress).collect();
        for facet in mine {
            sums.add(mesh, elastic, *facet, &by_point);
        }
    }
    sums.write(out, name, at);
}

impl Sums {
    /// Adds a face, by the points of integration of its shape.
    fn add(
        &mut self,
        mesh: &Mesh,
        elastic: &Elastic,
        facet: FacetRef,
        stress: &BTreeMap<usize, [f64; 6]>,
    ) {
        let (kind, points) = mesh.facet_points(facet);
        let element = kind.reference();
        let count = points.len();
        let mut n = [0.0; MAX_NODES];
        let mut d = [[0.0; 3]; MAX_NODES];
        for q in element.quadrature() {
            element.values(q.xi, &mut n[..count]);
            element.gradients(q.xi, &mut d[..count]);
            let (mut x, mut t1, mut t2, mut s) = ([0.0; 3], [0.0; 3], [0.0; 3], [0.0; 6]);
            for (a, p) in points.iter().enumerate() {
                x = add_scaled(x, n[a], mesh.points[*p]);
                t1 = add_scaled(t1, d[a][0], mesh.points[*p]);
                t2 = add_scaled(t2, d[a][1], mesh.points[*p]);
                if let Some(own) = stress.get(p) {
                    s.iter_mut().zip(own).for_each(|(s, o)| *s += n[a] * o);
                }
            }
            let across = match mesh.dim {
                2 => [t1[1], -t1[0], 0.0],
                _ => cross(t1, t2),
            };
            let Some(normal) = normalize(across) else {
                continue;
            };
            let area = q.weight * norm(across) * elastic.space().extent(x);
            // Components come in the order xx yy zz xy yz xz.
            let [xx, yy, zz, xy, yz, xz] = s;
            let rows = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
            let traction = rows.map(|row| dot(row, normal));
            self.force = add_scaled(self.force, area, traction);
            self.moment = add_scaled(self.moment, area, cross(x, traction));
            self.area += area;
            self.first = add_scaled(self.first, area, x);
            self.normal = add_scaled(self.normal, area, normal);
        }
    }

    /// The block of the `.dat` file.
    fn write(&self, out: &mut String, name: &str, at: f64) {
        let Sums { force, moment, .. } = *self;
        let centre = match self.area > 0.0 {
            true => self.first.map(|c| c / self.area),
            false => [0.0; 3],
        };
        let normal = normalize(self.normal).unwrap_or_default();
        let about = sub(moment, cross(centre, force));
        let parts = |v: Vec3| {
            let along = dot(v, normal);
            (along, norm(add_scaled(v, -along, normal)))
        };
        let ((pull, shear), (torque, bending)) = (parts(force), parts(about));
        let _ = write!(
            out,
            "\n statistics for surface set {name} and time {}\n",
            time(at)
        );
        out.push_str(
            "\n   total surface force (fx,fy,fz) and moment about the origin(mx,my,mz)\n\n",
        );
        row(out, "  ", &[force, moment].concat());
        out.push_str("\n   center of gravity and mean normal\n\n");
        row(out, "  ", &[centre, normal].concat());
        out.push_str("\n   moment about the center of gravity(mx,my,mz)\n\n");
        row(out, "  ", &about);
        out.push_str("\n   area, normal force (+ = tension), shear force (size), torque and bending moment (size)\n\n");
        row(out, "  ", &[self.area, pull, shear, torque, bending]);
    }
}

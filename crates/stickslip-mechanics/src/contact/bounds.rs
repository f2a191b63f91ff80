//! What bounds a facet in space and in direction: most facets near a point are passed over by it, without a projection on them.

use super::facet_point::FACET_NODES;
use super::projection::Patch;
use super::search::Box3;
use super::surface::Facet;
use crate::math::{Vec3, add, add_scaled, cross, dot, norm, scale};
use crate::shape::ElementKind;
use crate::tolerance::ROUNDING;

/// A box around a facet, a cone around its normals, and its geometry.
#[derive(Debug, Clone, Copy)]
pub struct Bounds {
    /// The facet itself.
    pub patch: Patch,
    /// The box, bulges included.
    pub space: Box3,
    /// The axis of the cone.
    axis: Vec3,
    /// Sine of the angle between the axis and the normal farthest from it; above one where nothing is known of the normals.
    spread: f64,
}

/// Nothing is known of the normals.
const ANY: (Vec3, f64) = ([0.0; 3], 2.0);

impl Bounds {
    /// Of a facet, with the coordinates of all nodes.
    pub fn around(facet: &Facet, x: &[Vec3]) -> Bounds {
        let mut nodes = [[0.0; 3]; FACET_NODES];
        let nodes = facet.gather(x, &mut nodes);
        let patch = Patch::new(facet.kind, nodes);
        let (axis, spread) = cone(&patch).unwrap_or(ANY);
        Bounds {
            patch,
            space: Box3::around(facet.kind, nodes.iter().copied()),
            axis,
            spread,
        }
    }

    /// The same facet, with bounds that rule nothing out.
    #[cfg(test)]
    pub fn endless(self) -> Bounds {
        let corners = [[f64::NEG_INFINITY; 3], [f64::INFINITY; 3]];
        Bounds {
            space: Box3::around(ElementKind::Line2, corners.into_iter()),
            axis: ANY.0,
            spread: ANY.1,
            ..self
        }
    }

    /// Whether the facet may look at a surface with the unit normal `outward`. Where this is false none of its normals does.
    #[inline]
    pub fn may_face(&self, outward: Vec3) -> bool {
        dot(self.axis, outward) < self.spread + ROUNDING
    }
}

/// The direction in the midst of the normals of a facet, and the sine of the angle to the farthest; `None` where they do not lie within a right angle of one
/// direction.
fn cone(patch: &Patch) -> Option<(Vec3, f64)> {
    let mut hull = [[0.0; 3]; CONTROLS];
    let hull = &mut hull[..count(patch.kind)];
    normal_hull(patch, hull);
    for v in &mut *hull {
        *v = unit(*v)?;
    }
    let axis = unit(hull.iter().fold([0.0; 3], |s, &v| add(s, v)))?;
    let cosine = hull.iter().map(|&v| dot(axis, v)).fold(1.0, f64::min);
    (cosine > 0.0).then(|| (axis, (1.0 - cosine * cosine).max(0.0).sqrt()))
}

fn unit(v: Vec3) -> Option<Vec3> {
    let length = norm(v);
    (length > 0.0).then(|| scale(1.0 / length, v))
}

/// Most vectors of [`normal_hull`].
const CONTROLS: usize = 16;

/// Vectors of [`normal_hull`].
fn count(kind: ElementKind) -> usize {
    match kind {
        ElementKind::Line2 | ElementKind::Tri3 => 1,
        ElementKind::Line3 => 2,
        ElementKind::Quad4 => 4,
        ElementKind::Tri6 => 6,
        _ => CONTROLS,
    }
}

/// Vectors whose convex hull has all `∂x/∂ξ × ∂x/∂η` of a facet in it: their coefficients as a polynomial in Bernstein's form, of degree 1 on lines and
/// bilinear facets (where the part with `ξη` vanishes), 2 on triangles and 3 x 3 on serendipity facets, each from as many values.
fn normal_hull(patch: &Patch, hull: &mut [Vec3]) {
    let at = |xi: [f64; 2]| {
        let (_, a) = patch.at(xi);
        cross(a[0], a[1])
    };
    match patch.kind {
        ElementKind::Line2 | ElementKind::Tri3 => hull[0] = at([0.0; 2]),
        ElementKind::Line3 => {
            hull[0] = at([-1.0, 0.0]);
            hull[1] = at([1.0, 0.0]);
        }
        ElementKind::Quad4 => {
            let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
            hull.copy_from_slice(&corners.map(at));
        }
        ElementKind::Tri6 => {
            let corners = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]].map(at);
            let middles = [[0.5, 0.0], [0.5, 0.5], [0.0, 0.5]].map(at);
            hull[..3].copy_from_slice(&corners);
            for k in 0..3 {
                let ends = add(corners[k], corners[(k + 1) % 3]);
                hull[3 + k] = add_scaled(scale(2.0, middles[k]), -0.5, ends);
            }
        }
        _ => {
            let third = |i: usize| 2.0 * i as f64 / 3.0 - 1.0;
            for (k, v) in hull.iter_mut().enumerate() {
                *v = at([third(k % 4), third(k / 4)]);
            }
            for k in 0..4 {
                from_thirds(hull, 4 * k, 1);
            }
            for k in 0..4 {
                from_thirds(hull, k, 4);
            }
        }
    }
}

/// Makes four values of a cubic polynomial, at the ends and thirds of an interval, its coefficients in Bernstein's form.
fn from_thirds(v: &mut [Vec3], first: usize, stride: usize) {
    let at = [0, 1, 2, 3].map(|k| first + k * stride);
    let values = at.map(|k| v[k]);
    let weighted = |w: [f64; 4]| {
        let terms = w.iter().zip(&values);
        terms.fold([0.0; 3], |s, (w, &x)| add_scaled(s, w / 6.0, x))
    };
    v[at[1]] = weighted([-5.0, 18.0, -9.0, 2.0]);
    v[at[2]] = weighted([2.0, -9.0, 18.0, -5.0]);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::facet_point::evaluate;

    fn cone_of(kind: ElementKind, nodes: &[Vec3]) -> Option<(Vec3, f64)> {
        cone(&Patch::new(kind, nodes))
    }

    const KINDS: [ElementKind; 6] = [
        ElementKind::Line2,
        ElementKind::Line3,
        ElementKind::Tri3,
        ElementKind::Tri6,
        ElementKind::Quad4,
        ElementKind::Quad8,
    ];

    /// A facet bent by as much as `bend` times its size, the same way each time.
    fn bent(kind: ElementKind, bend: f64, seed: usize) -> Vec<Vec3> {
        let wave = |k: usize| bend * (1.0 + 2.3 * (k + 7 * seed) as f64).sin();
        let places = kind.reference().nodes().iter().enumerate();
        let node = |(k, xi): (usize, &[f64; 3])| {
            let out = if kind.dim() == 1 {
                0.0
            } else {
                wave(3 * k + 2)
            };
            [xi[0] + wave(3 * k), xi[1] + wave(3 * k + 1), out]
        };
        places.map(node).collect()
    }

    fn places(kind: ElementKind) -> Vec<[f64; 2]> {
        let steps = || (0..=12).map(|i| f64::from(i) / 12.0);
        let all = steps().flat_map(|s| steps().map(move |t| [s, t]));
        match kind {
            ElementKind::Line2 | ElementKind::Line3 => {
                steps().map(|s| [2.0 * s - 1.0, 0.0]).collect()
            }
            ElementKind::Tri3 | ElementKind::Tri6 => all.filter(|p| p[0] + p[1] <= 1.0).collect(),
            _ => all.map(|p| p.map(|s| 2.0 * s - 1.0)).collect(),
        }
    }

    /// All normals of a bent facet lie in its cone, and the cone is hardly wider than they ask: it closes on a flat one.
    #[test]
    fn all_normals_of_a_facet_lie_in_its_cone() {
        for kind in KINDS {
            let mut widest = [0.0_f64; 2];
            for seed in 0..40 {
                let nodes = bent(kind, 0.08, seed);
                let (axis, spread) = cone_of(kind, &nodes).expect("a cone");
                let sine = |xi: [f64; 2]| norm(cross(axis, evaluate(kind, &nodes, xi).normal));
                let most = places(kind).into_iter().map(sine).fold(0.0, f64::max);
                assert!(most <= spread + 1e-7, "{kind}: {most} of {spread}");
                widest = [widest[0].max(most), widest[1].max(spread)];
            }
            assert!(widest[1] <= 2.0 * widest[0] + 1e-7, "{kind}: {widest:?}");
            let flat = cone_of(kind, &bent(kind, 0.0, 0)).expect("a cone");
            assert!(flat.1 < 1e-7, "{kind}: {flat:?}");
        }
    }

    /// A facet that bends through more than a right angle, or has no size, is ruled out by nothing.
    #[test]
    fn a_facet_whose_normals_turn_too_far_may_face_anything() {
        let folded = [[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 5.0, 0.0]];
        assert!(cone_of(ElementKind::Line3, &folded).is_some_and(|(_, spread)| spread < 1.0));
        let nothing = [[0.0; 3]; 2];
        assert!(cone_of(ElementKind::Line2, &nothing).is_none());
        let facet = Facet {
            kind: ElementKind::Line2,
            nodes: vec![0, 1],
            continues: Vec::new(),
            modulus: 1.0,
            cell: 1,
        };
        let bounds = Bounds::around(&facet, &nothing);
        for outward in [[1.0, 0.0, 0.0], [0.0, 0.0, -1.0]] {
            assert!(bounds.may_face(outward));
        }
    }

    /// What is passed over faces nowhere: the tightest case is a flat facet, which looks away at a right angle already.
    #[test]
    fn a_facet_is_passed_over_where_none_of_its_normals_looks_at_the_point() {
        for kind in KINDS {
            let nodes = bent(kind, 0.05, 3);
            let facet = Facet {
                kind,
                nodes: (0..nodes.len()).collect(),
                continues: Vec::new(),
                modulus: 1.0,
                cell: 1,
            };
            let bounds = Bounds::around(&facet, &nodes);
            let mut passed = 0;
            for k in 0..200 {
                let (s, c) = (0.17 * f64::from(k)).sin_cos();
                let (t, d) = (0.29 * f64::from(k)).sin_cos();
                let outward = match kind.dim() {
                    1 => [s, c, 0.0],
                    _ => [s * d, c * d, t],
                };
                if !bounds.may_face(outward) {
                    passed += 1;
                    for xi in places(kind) {
                        let p = evaluate(kind, &nodes, xi);
                        assert!(dot(p.normal, outward) >= 0.0, "{kind}");
                    }
                }
            }
            assert!(passed > 60, "{kind}: {passed}");
        }
    }
}

//! Gauss rules on `[-1, 1]^d` as tensor products of the line rules, and on wedges as products of a triangle's and a line's.

use super::reference::QuadraturePoint;

/// Point and weight of the 1-point rule, exact for linear functions.
const ONE: [(f64, f64); 1] = [(0.0, 2.0)];
/// Points and weights of the 2-point rule, exact for cubics.
const TWO: [(f64, f64); 2] = [(-ROOT_THIRD, 1.0), (ROOT_THIRD, 1.0)];
/// Points and weights of the 3-point rule, exact for quintics.
const LINE_OF_THREE: [(f64, f64); 3] = [
    (-ROOT_THREE_FIFTHS, 5.0 / 9.0),
    (0.0, 8.0 / 9.0),
    (ROOT_THREE_FIFTHS, 5.0 / 9.0),
];
/// Points and weights of the 4-point rule, exact to degree seven.
const FOUR: [(f64, f64); 4] = [
    (-0.861_136_311_594_052_6, 0.347_854_845_137_453_85),
    (-0.339_981_043_584_856_3, 0.652_145_154_862_546_1),
    (0.339_981_043_584_856_3, 0.652_145_154_862_546_1),
    (0.861_136_311_594_052_6, 0.347_854_845_137_453_85),
];
/// `1 / √3`, the coordinate of the 2-point rule.
pub const ROOT_THIRD: f64 = 0.577_350_269_189_625_8;
/// `√(3/5)`, the coordinate of the 3-point rule.
const ROOT_THREE_FIFTHS: f64 = 0.774_596_669_241_483_4;

/// The product of `n` points a direction in `dim` directions; `N = n^dim`. The first direction runs fastest.
const fn product<const N: usize>(line: &[(f64, f64)], dim: usize) -> [QuadraturePoint; N] {
    let mut rule = [QuadraturePoint {
        xi: [0.0; 3],
        weight: 1.0,
    }; N];
    let mut q = 0;
    while q < N {
        let mut rest = q;
        let mut direction = 0;
        while direction < dim {
            let (x, w) = line[rest % line.len()];
            rule[q].xi[direction] = x;
            rule[q].weight *= w;
            rest /= line.len();
            direction += 1;
        }
        q += 1;
    }
    rule
}

pub(super) static LINE_2: [QuadraturePoint; 2] = product(&TWO, 1);
pub(super) static LINE_3: [QuadraturePoint; 3] = product(&LINE_OF_THREE, 1);
pub(super) static QUAD_2X2: [QuadraturePoint; 4] = product(&TWO, 2);
pub(super) static QUAD_3X3: [QuadraturePoint; 9] = product(&LINE_OF_THREE, 2);
pub(super) static HEX_2X2X2: [QuadraturePoint; 8] = product(&TWO, 3);
pub(super) static HEX_3X3X3: [QuadraturePoint; 27] = product(&LINE_OF_THREE, 3);
pub(super) static QUAD_1: [QuadraturePoint; 1] = product(&ONE, 2);
pub(super) static HEX_1: [QuadraturePoint; 1] = product(&ONE, 3);

/// Points and weights on a triangle of area 1/2: one point, exact for linear functions.
const CENTRE: [(f64, f64, f64); 1] = [(1.0 / 3.0, 1.0 / 3.0, 0.5)];
/// Three points, exact for quadratics.
const INSIDE: [(f64, f64, f64); 3] = [
    (1.0 / 6.0, 1.0 / 6.0, 1.0 / 6.0),
    (2.0 / 3.0, 1.0 / 6.0, 1.0 / 6.0),
    (1.0 / 6.0, 2.0 / 3.0, 1.0 / 6.0),
];
/// The product of a rule on the triangle and one along the line; the triangle runs fastest.
const fn prism<const N: usize>(
    triangle: &[(f64, f64, f64)],
    line: &[(f64, f64)],
) -> [QuadraturePoint; N] {
    let mut rule = [QuadraturePoint {
        xi: [0.0; 3],
        weight: 0.0,
    }; N];
    let mut q = 0;
    while q < N {
        let (x, y, area) = triangle[q % triangle.len()];
        let (z, length) = line[q / triangle.len()];
        rule[q] = QuadraturePoint {
            xi: [x, y, z],
            weight: area * length,
        };
        q += 1;
    }
    rule
}

pub(super) static WEDGE_1X2: [QuadraturePoint; 2] = prism(&CENTRE, &TWO);
pub(super) static WEDGE_3X2: [QuadraturePoint; 6] = prism(&INSIDE, &TWO);
pub(super) static WEDGE_3X3: [QuadraturePoint; 9] = prism(&INSIDE, &LINE_OF_THREE);

/// A rule on the wedge of the degree that [`collapsed`] has on the triangle, and quintic along it.
pub(super) fn fine_wedge() -> Vec<QuadraturePoint> {
    let triangle = collapsed(2);
    let along = |(z, w): (f64, f64)| {
        triangle.clone().into_iter().map(move |p| QuadraturePoint {
            xi: [p.xi[0], p.xi[1], z],
            weight: p.weight * w,
        })
    };
    LINE_OF_THREE.into_iter().flat_map(along).collect()
}

/// A rule on the unit simplex: 4 points a direction on the cube, collapsed onto a corner. On a triangle exact to degree six, on a
/// tetrahedron to degree five.
pub(super) fn collapsed(dim: usize) -> Vec<QuadraturePoint> {
    let unit = FOUR.map(|(x, w)| (0.5 * (1.0 + x), 0.5 * w));
    let mut rule = Vec::new();
    for (a, wa) in unit {
        for (b, wb) in unit {
            if dim == 2 {
                // x = a, y = b (1 - a)
                rule.push(QuadraturePoint {
                    xi: [a, b * (1.0 - a), 0.0],
                    weight: wa * wb * (1.0 - a),
                });
                continue;
            }
            for (c, wc) in unit {
                rule.push(QuadraturePoint {
                    xi: [a, b * (1.0 - a), c * (1.0 - a) * (1.0 - b)],
                    weight: wa * wb * wc * (1.0 - a).powi(2) * (1.0 - b),
                });
            }
        }
    }
    rule
}

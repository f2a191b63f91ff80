//! Gauss rules on `[-1, 1]^d` as tensor products of the line rules.

use super::QuadraturePoint;

/// Points and weights of the 2-point rule, exact for cubics.
const TWO: [(f64, f64); 2] = [(-ROOT_THIRD, 1.0), (ROOT_THIRD, 1.0)];
/// Points and weights of the 3-point rule, exact for quintics.
const THREE: [(f64, f64); 3] = [
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
const ROOT_THIRD: f64 = 0.577_350_269_189_625_8;
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
pub(super) static LINE_3: [QuadraturePoint; 3] = product(&THREE, 1);
pub(super) static QUAD_2X2: [QuadraturePoint; 4] = product(&TWO, 2);
pub(super) static QUAD_3X3: [QuadraturePoint; 9] = product(&THREE, 2);
pub(super) static HEX_2X2X2: [QuadraturePoint; 8] = product(&TWO, 3);
pub(super) static HEX_3X3X3: [QuadraturePoint; 27] = product(&THREE, 3);

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

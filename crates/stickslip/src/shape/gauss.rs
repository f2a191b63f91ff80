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

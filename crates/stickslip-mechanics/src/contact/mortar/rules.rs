//! Quadrature on the pieces that cutting leaves.

use std::sync::LazyLock;

use crate::shape::{ElementKind, mass_rule};

/// Barycentric coordinates and weight relative to the area.
pub type Rule = [([f64; 3], f64)];

/// Exact for quadratics.
const TRIANGLE_OF_THREE: [([f64; 3], f64); 3] = [
    ([2.0 / 3.0, 1.0 / 6.0, 1.0 / 6.0], 1.0 / 3.0),
    ([1.0 / 6.0, 2.0 / 3.0, 1.0 / 6.0], 1.0 / 3.0),
    ([1.0 / 6.0, 1.0 / 6.0, 2.0 / 3.0], 1.0 / 3.0),
];

/// Radon's rule, exact to degree five.
static SEVEN: LazyLock<[([f64; 3], f64); 7]> = LazyLock::new(|| {
    let root = 15.0_f64.sqrt();
    let mut rule = [([1.0 / 3.0; 3], 9.0 / 40.0); 7];
    for (k, sign) in [1.0, -1.0].into_iter().enumerate() {
        let a = (6.0 + sign * root) / 21.0;
        let weight = (155.0 + sign * root) / 1200.0;
        for corner in 0..3 {
            let mut l = [a; 3];
            l[corner] = 1.0 - 2.0 * a;
            rule[1 + 3 * k + corner] = (l, weight);
        }
    }
    rule
});

/// Exact to degree six.
static SIXTEEN: LazyLock<Vec<([f64; 3], f64)>> = LazyLock::new(|| {
    mass_rule(ElementKind::Tri3)
        .iter()
        .map(|q| {
            let [x, y, _] = q.xi;
            ([1.0 - x - y, x, y], 2.0 * q.weight)
        })
        .collect()
});

/// The rule for a triangle on faces of these kinds.
pub fn triangle(secondary: ElementKind, primary: ElementKind) -> &'static Rule {
    if secondary == ElementKind::Tri3 && primary == ElementKind::Tri3 {
        &TRIANGLE_OF_THREE
    } else if secondary.order() == 1 && primary.order() == 1 {
        &*SEVEN
    } else {
        &SIXTEEN
    }
}

/// Three points on `[-1, 1]` and their weights, which add up to two.
pub const LINE_RULE: [(f64, f64); 3] = [
    (-0.774_596_669_241_483_4, 5.0 / 9.0),
    (0.0, 8.0 / 9.0),
    (0.774_596_669_241_483_4, 5.0 / 9.0),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rules_are_exact_to_their_degree() {
        // ∫ L1^a L2^b = 2A a! b! / (a + b + 2)!
        let factorial = |n: usize| (1..=n).product::<usize>() as f64;
        for (rule, degree) in [(&TRIANGLE_OF_THREE[..], 2), (&*SEVEN, 5), (&SIXTEEN, 6)] {
            for a in 0..=degree {
                for b in 0..=(degree - a) {
                    let exact = 2.0 * factorial(a) * factorial(b) / factorial(a + b + 2);
                    let sum: f64 = (rule.iter())
                        .map(|(l, w)| w * l[0].powi(a as i32) * l[1].powi(b as i32))
                        .sum();
                    assert!((sum - exact).abs() < 1e-14, "{a} {b} {degree}");
                }
            }
        }
    }
}

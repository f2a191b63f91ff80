//! Thermal strain in a cell.
//!
//! A cell has the temperatures that suit its strains: with strains that are constant in it, the mean of its nodes; in quadratic cells the linear
//! field that has, at as many Gauss points as there are corners, what the quadratic one of all nodes has. So the mean is that of the quadratic field
//! (CalculiX does the same), and nothing of a higher order presses on strains that the cell does not have.

use super::scheme::Scheme;
use crate::material::Dilation;
use crate::shape::{ElementKind, QuadraturePoint};

/// The warmth of one cell.
#[derive(Debug, Clone, Copy)]
pub(super) struct Warmth<'a, const N: usize> {
    pub dilation: &'a Dilation,
    /// Temperatures of the nodes at the start.
    pub start: [f64; N],
    /// By how much they are warmer now.
    pub rise: [f64; N],
}

impl<const N: usize> Warmth<'_, N> {
    /// The thermal strain where the nodes have these weights.
    pub fn strain(&self, weights: &[f64; N]) -> [f64; 6] {
        let mean = |values: &[f64; N]| values.iter().zip(weights).map(|(v, w)| v * w).sum();
        self.dilation.strain(mean(&self.start), mean(&self.rise))
    }
}

/// What the temperatures of the nodes weigh at each point of a rule.
pub(super) fn weights<const N: usize>(
    kind: ElementKind,
    scheme: Scheme,
    rule: &[QuadraturePoint],
) -> Vec<[f64; N]> {
    let quadratic = kind.order() == 2;
    if !quadratic && scheme != Scheme::Incompatible {
        return vec![[1.0 / N as f64; N]; rule.len()];
    }
    let corners = kind.linear();
    let stretch = if quadratic {
        stretch(corners)
    } else {
        [1.0; 3]
    };
    let centre = kind.centre();
    let away = |xi: [f64; 3], by: &dyn Fn(f64) -> f64| -> [f64; 3] {
        std::array::from_fn(|d| centre[d] + by(stretch[d]) * (xi[d] - centre[d]))
    };
    // What all nodes weigh at the Gauss points, which lie between the centre and the corners.
    let nodes = corners.reference().nodes().iter();
    let inner: Vec<[f64; N]> = nodes
        .map(|corner| {
            let mut weights = [0.0; N];
            let at = away(*corner, &|s| 1.0 / s);
            kind.reference().values(at, &mut weights);
            weights
        })
        .collect();
    let at = |q: &QuadraturePoint| {
        let mut linear = [0.0; N];
        let xi = away(q.xi, &|s| s);
        corners.reference().values(xi, &mut linear[..inner.len()]);
        std::array::from_fn(|n| inner.iter().zip(&linear).map(|(w, l)| l * w[n]).sum())
    };
    rule.iter().map(at).collect()
}

/// How much farther from the centre corners are than Gauss points, along each direction.
fn stretch(corners: ElementKind) -> [f64; 3] {
    let line = 3.0_f64.sqrt();
    match corners {
        ElementKind::Tri3 => [2.0; 3],
        ElementKind::Tet4 => [5.0_f64.sqrt(); 3],
        ElementKind::Wedge6 => [2.0, 2.0, line],
        _ => [line; 3],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::scheme::stiffness_rule;
    use crate::body::{Formulation, Space};

    /// The mean of `x²` over the reference element: exact for the quadratic field, and so for the linear one that stands for it.
    fn mean_of_square<const N: usize>(kind: ElementKind, wanted: f64) {
        let rule = stiffness_rule(kind, Space::Solid, Formulation::Standard);
        let weights = weights::<N>(kind, Scheme::of(kind, Formulation::Standard), rule);
        let nodes = kind.reference().nodes();
        let (mut sum, mut measure) = (0.0, 0.0);
        for (q, weights) in rule.iter().zip(&weights) {
            let t: f64 = nodes
                .iter()
                .zip(weights)
                .map(|(x, w)| w * x[0] * x[0])
                .sum();
            sum += q.weight * t;
            measure += q.weight;
        }
        assert!(
            (sum / measure - wanted).abs() < 1e-12,
            "{kind}: {}",
            sum / measure
        );
    }

    #[test]
    fn the_mean_temperature_of_a_cell_is_that_of_its_quadratic_field() {
        mean_of_square::<20>(ElementKind::Hex20, 1.0 / 3.0);
        mean_of_square::<8>(ElementKind::Quad8, 1.0 / 3.0);
        mean_of_square::<6>(ElementKind::Tri6, 1.0 / 6.0);
        mean_of_square::<10>(ElementKind::Tet10, 0.1);
        mean_of_square::<15>(ElementKind::Wedge15, 1.0 / 6.0);
    }
}

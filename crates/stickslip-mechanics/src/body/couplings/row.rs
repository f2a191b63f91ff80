use crate::error::Diagnostic;
use crate::system::Dofs;
use crate::tolerance::ROUNDING;

/// A weighted sum of the displacements of a few points.
///
/// It goes over all components of its points, so that what precedes by blocks of points can take it for a stiffness between them.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// The dofs of its points, all components of one after the other.
    pub dofs: Vec<usize>,
    /// What each displacement is multiplied by `[-]`.
    pub factors: Vec<f64>,
}

impl Row {
    /// From terms `(point, component, factor)`; those of the same displacement add up, and what is rounding beside the largest is none.
    ///
    /// # Errors
    /// If nothing is left of the sum.
    pub fn new(
        terms: impl IntoIterator<Item = (usize, usize, f64)>,
        dim: usize,
    ) -> Result<Self, Diagnostic> {
        let mut points: Vec<usize> = Vec::new();
        let mut known = std::collections::BTreeMap::new();
        let mut factors: Vec<f64> = Vec::new();
        let mut largest = 0.0_f64;
        for (point, component, factor) in terms {
            let at = *known.entry(point).or_insert_with(|| {
                points.push(point);
                factors.resize(factors.len() + dim, 0.0);
                points.len() - 1
            });
            factors[at * dim + component] += factor;
            largest = largest.max(factor.abs());
        }
        // What rounding leaves of arms that cancel would tie the row to what it does not move.
        let counts = |f: &f64| f.abs() > ROUNDING * largest;
        factors
            .iter_mut()
            .filter(|f| !counts(f))
            .for_each(|f| *f = 0.0);
        if !factors.iter().any(counts) {
            return Err(Diagnostic::new("", "a sum of displacements without terms")
                .help("factors that are not zero, and that do not cancel at a point"));
        }
        // the number of points has no meaning for the numbering of dofs
        let numbering = Dofs { dim, points: 0 };
        let dofs = points
            .iter()
            .flat_map(|&p| (0..dim).map(move |c| numbering.of(p, c)))
            .collect();
        Ok(Row { dofs, factors })
    }

    /// The sum at displacements `u`, by dof.
    pub fn sum(&self, u: &[f64]) -> f64 {
        let pairs = self.dofs.iter().zip(&self.factors);
        pairs.map(|(&dof, a)| a * u[dof]).sum()
    }

    /// The same with all terms positive: what its rounding is to be compared with.
    pub fn size(&self, u: &[f64]) -> f64 {
        let pairs = self.dofs.iter().zip(&self.factors);
        pairs.map(|(&dof, a)| (a * u[dof]).abs()).sum()
    }

    /// `√(Σ factor²)`.
    pub fn norm(&self) -> f64 {
        self.factors.iter().map(|a| a * a).sum::<f64>().sqrt()
    }

    /// Dofs and factors of the terms.
    pub fn terms(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        let pairs = self.dofs.iter().zip(&self.factors);
        pairs.map(|(&d, &a)| (d, a)).filter(|(_, a)| *a != 0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn terms_of_a_point_are_gathered() {
        let row = Row::new([(4, 1, 2.0), (1, 0, -1.0), (4, 1, 1.0)], 2).unwrap();
        assert_eq!(row.dofs, [8, 9, 2, 3]);
        assert_eq!(row.factors, [0.0, 3.0, -1.0, 0.0]);
        let u: Vec<f64> = (0..10).map(f64::from).collect();
        assert_eq!(row.sum(&u), 25.0);
        assert!(Row::new([(4, 1, 2.0), (4, 1, -2.0)], 2).is_err());
        let row = Row::new([(4, 1, 2.0), (1, 0, 1e-16)], 2).unwrap();
        assert_eq!(row.terms().collect::<Vec<_>>(), [(9, 2.0)]);
    }
}

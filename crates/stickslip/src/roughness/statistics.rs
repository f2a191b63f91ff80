/// Figures of the heights of a surface or profile (ISO 25178-2, ISO 4287), counted from their mean.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Statistics {
    /// Mean `[m]`.
    pub mean: f64,
    /// Root mean square, Sq or Rq `[m]`.
    pub rq: f64,
    /// Mean of magnitudes, Sa or Ra `[m]`.
    pub ra: f64,
    /// Skewness `[-]`.
    pub skewness: f64,
    /// Kurtosis `[-]`, 3 of a normal distribution.
    pub kurtosis: f64,
    /// Root mean square of the gradient, Sdq or Rdq `[-]`.
    pub slope: f64,
    /// Mean magnitude of the slope along a profile `[-]`, which laws of asperities ask for.
    pub mean_slope: f64,
    /// Spectral moments of profiles `m₀` `[m²]`, `m₂` `[-]`, `m₄` `[1/m²]`: mean squares of height, slope and curvature along a profile.
    pub moments: [f64; 3],
}

impl Statistics {
    /// Of `columns × rows` heights, row by row, at distances `spacing` along rows and across them.
    ///
    /// # Panics
    /// If there are not as many heights.
    pub fn of(columns: usize, rows: usize, spacing: [f64; 2], heights: &[f64]) -> Statistics {
        assert_eq!(heights.len(), columns * rows, "number of heights");
        let n = heights.len() as f64;
        let mean = heights.iter().sum::<f64>() / n;
        let moment = |k: i32| heights.iter().map(|h| (h - mean).powi(k)).sum::<f64>() / n;
        let rq = moment(2).sqrt();
        let at = |i: usize, j: usize| heights[j * columns + i];
        let (mut slopes, mut curvatures, mut magnitudes) = ([0.0; 2], [0.0; 2], [0.0; 2]);
        let mut counts = [[0.0; 2]; 2];
        for j in 0..rows {
            for i in 0..columns {
                let here = at(i, j);
                let right = (i + 1 < columns).then(|| at(i + 1, j));
                let above = (j + 1 < rows).then(|| at(i, j + 1));
                let left = (i > 0).then(|| at(i - 1, j));
                let below = (j > 0).then(|| at(i, j - 1));
                for (k, (next, last)) in [(right, left), (above, below)].into_iter().enumerate() {
                    let Some(next) = next else { continue };
                    let slope = (next - here) / spacing[k];
                    slopes[k] += slope * slope;
                    magnitudes[k] += slope.abs();
                    counts[k][0] += 1.0;
                    if let Some(last) = last {
                        curvatures[k] += ((next - 2.0 * here + last) / spacing[k].powi(2)).powi(2);
                        counts[k][1] += 1.0;
                    }
                }
            }
        }
        // Directions in which there is something.
        let along = |sums: [f64; 2], order: usize| -> Vec<f64> {
            let pairs = sums.into_iter().zip(counts);
            let pairs = pairs.filter(|(_, c)| c[order] > 0.0);
            pairs.map(|(sum, c)| sum / c[order]).collect()
        };
        let mean_of = |v: Vec<f64>| v.iter().sum::<f64>() / (v.len() as f64).max(1.0);
        let flat = rq == 0.0;
        Statistics {
            mean,
            rq,
            ra: heights.iter().map(|h| (h - mean).abs()).sum::<f64>() / n,
            skewness: if flat { 0.0 } else { moment(3) / rq.powi(3) },
            kurtosis: if flat { 0.0 } else { moment(4) / rq.powi(4) },
            slope: along(slopes, 0).iter().sum::<f64>().sqrt(),
            mean_slope: mean_of(along(magnitudes, 0)),
            moments: [
                rq * rq,
                mean_of(along(slopes, 0)),
                mean_of(along(curvatures, 1)),
            ],
        }
    }

    /// Density of summits `[1/m²]`, their mean radius `[m]`, and Nayak's bandwidth `α = m₀ m₄/m₂²` `[-]` of a surface of normally distributed heights
    /// ([McCool 1986](stickslip_base::references::mccool_1986)); `None` of a plane.
    pub fn summits(&self) -> Option<[f64; 3]> {
        let [m0, m2, m4] = self.moments;
        let density = m4 / m2 / (6.0 * std::f64::consts::PI * 3.0_f64.sqrt());
        let radius = 0.375 * (std::f64::consts::PI / m4).sqrt();
        let all = [density, radius, m0 * m4 / (m2 * m2)];
        all.iter().all(|v| v.is_finite()).then_some(all)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    #[test]
    fn a_cosine_has_the_figures_of_a_cosine() {
        let (n, length, a) = (4000, 0.5, 2e-3);
        let h = length / n as f64;
        let wave: Vec<f64> = (0..n)
            .map(|i| a * (3.0 * TAU * i as f64 / n as f64).cos())
            .collect();
        let s = Statistics::of(n, 1, [h, h], &wave);
        let q = 3.0 * TAU / length;
        let near =
            |is: f64, should: f64| assert!((is / should - 1.0).abs() < 2e-3, "{is} {should}");
        near(s.rq, a / 2.0_f64.sqrt());
        near(s.ra, a * 2.0 / std::f64::consts::PI);
        near(s.kurtosis, 1.5);
        near(s.slope, a * q / 2.0_f64.sqrt());
        near(s.mean_slope, a * q * 2.0 / std::f64::consts::PI);
        near(s.moments[2], (a * q * q).powi(2) / 2.0);
        assert!(s.skewness.abs() < 1e-9 && s.mean.abs() < 1e-12);
        // The same along rows of a map that does not vary across them: the slope is that of one direction, the moments are means of two.
        let map: Vec<f64> = (0..3).flat_map(|_| wave.clone()).collect();
        let m = Statistics::of(n, 3, [h, h], &map);
        near(m.slope, s.slope);
        near(m.moments[1], 0.5 * s.moments[1]);
        assert_eq!(Statistics::of(2, 2, [1.0, 1.0], &[1.0; 4]).summits(), None);
    }
}

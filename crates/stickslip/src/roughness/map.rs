use crate::tolerance::NEGLIGIBLE;

use super::model::Heights;

/// Heights at the nodes of a grid, bilinear between them.
#[derive(Debug, Clone, PartialEq)]
pub struct HeightMap {
    /// Heights along a row, and rows.
    pub columns: usize,
    /// See `columns`; one row is a profile.
    pub rows: usize,
    /// Distances along rows and between them `[m]`.
    pub spacing: [f64; 2],
    /// Row by row `[m]`.
    pub heights: Vec<f64>,
    /// Whether it goes on beyond its edges with a copy of itself.
    pub repeat: bool,
}

impl HeightMap {
    /// Gives nodes without a number the mean of those beside them, from the rim of each hole inward; how many there were.
    ///
    /// # Errors
    /// How many there are, if it is more than half of all.
    pub fn fill(&mut self) -> Result<usize, usize> {
        let missing = self.heights.iter().filter(|h| !h.is_finite()).count();
        if 2 * missing > self.heights.len() {
            return Err(missing);
        }
        while self.heights.iter().any(|h| !h.is_finite()) {
            let before = self.heights.clone();
            for k in 0..before.len() {
                if before[k].is_finite() {
                    continue;
                }
                let (i, j) = (k % self.columns, k / self.columns);
                let beside = [
                    (i > 0).then(|| k - 1),
                    (i + 1 < self.columns).then(|| k + 1),
                    (j > 0).then(|| k - self.columns),
                    (j + 1 < self.rows).then(|| k + self.columns),
                ];
                let known = beside.into_iter().flatten().map(|b| before[b]);
                let known: Vec<f64> = known.filter(|h| h.is_finite()).collect();
                if !known.is_empty() {
                    self.heights[k] = known.iter().sum::<f64>() / known.len() as f64;
                }
            }
        }
        Ok(missing)
    }

    /// Takes away the plane, of a profile the line, that lies nearest to all heights.
    pub fn level(&mut self) {
        // Over a full grid coordinates from the middle are orthogonal to each other and to the mean.
        let middle = [self.columns, self.rows].map(|n| 0.5 * (n as f64 - 1.0));
        let columns = self.columns;
        let place = move |k: usize| {
            [
                (k % columns) as f64 - middle[0],
                (k / columns) as f64 - middle[1],
            ]
        };
        let n = self.heights.len() as f64;
        let mean = self.heights.iter().sum::<f64>() / n;
        let tilt = [0, 1].map(|d| {
            let squares: f64 = (0..self.heights.len()).map(|k| place(k)[d].powi(2)).sum();
            let product: f64 = self
                .heights
                .iter()
                .enumerate()
                .map(|(k, h)| h * place(k)[d])
                .sum();
            if squares > 0.0 {
                product / squares
            } else {
                0.0
            }
        });
        for (k, h) in self.heights.iter_mut().enumerate() {
            let x = place(k);
            *h -= mean + tilt[0] * x[0] + tilt[1] * x[1];
        }
    }

    /// The two nodes around a place along an axis of `n` nodes, and how far it lies from the first to the second.
    fn between(&self, x: f64, n: usize) -> Option<(usize, usize, f64)> {
        if n == 1 {
            return Some((0, 0, 0.0));
        }
        let x = match self.repeat {
            true => x.rem_euclid(n as f64),
            false => x,
        };
        let last = if self.repeat { n } else { n - 1 } as f64;
        // A place may lie beyond the last node by rounding.
        if !(-NEGLIGIBLE..=last + NEGLIGIBLE).contains(&x) {
            return None;
        }
        let first = (x.max(0.0) as usize).min(last as usize - 1);
        Some((first, (first + 1) % n, (x - first as f64).clamp(0.0, 1.0)))
    }
}

impl Heights for HeightMap {
    fn at(&self, place: [f64; 2]) -> Option<f64> {
        let (i, next, a) = self.between(place[0] / self.spacing[0], self.columns)?;
        let (j, above, b) = self.between(place[1] / self.spacing[1], self.rows)?;
        let h = |i: usize, j: usize| self.heights[j * self.columns + i];
        let low = (1.0 - a) * h(i, j) + a * h(next, j);
        let high = (1.0 - a) * h(i, above) + a * h(next, above);
        Some((1.0 - b) * low + b * high)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn map(repeat: bool) -> HeightMap {
        HeightMap {
            columns: 4,
            rows: 3,
            spacing: [2.0, 1.0],
            // 10 + x/2 - 3 y
            heights: (0..12)
                .map(|k| 10.0 + (k % 4) as f64 - 3.0 * (k / 4) as f64)
                .collect(),
            repeat,
        }
    }

    #[test]
    fn places_between_nodes_are_met_and_those_beyond_are_not() {
        let m = map(false);
        assert_eq!(m.at([3.0, 0.5]), Some(10.0));
        assert_eq!(m.at([6.0, 2.0]), Some(7.0));
        assert_eq!(m.at([6.0 + 1e-9, 2.0]), Some(7.0));
        assert_eq!(
            (m.at([6.1, 0.0]), m.at([0.0, -0.1]), m.at([f64::NAN, 0.0])),
            (None, None, None)
        );
        let r = map(true);
        assert_eq!(r.at([3.0 - 16.0, 0.5 + 6.0]), Some(10.0));
        // Half way from the last node to the first.
        assert_eq!(r.at([7.0, 0.0]), Some(11.5));
        let profile = HeightMap {
            columns: 2,
            rows: 1,
            spacing: [1.0, 1.0],
            heights: vec![1.0, 3.0],
            repeat: false,
        };
        assert_eq!(profile.at([0.5, 77.0]), Some(2.0));
    }

    #[test]
    fn planes_are_taken_away_and_holes_filled() {
        let mut m = map(false);
        m.heights[5] = f64::NAN;
        assert_eq!(m.fill(), Ok(1));
        assert!((m.heights[5] - 8.0).abs() < 1e-12);
        m.heights[0] += 1.0;
        m.level();
        let sum: f64 = m.heights.iter().sum();
        let tilted: f64 = m
            .heights
            .iter()
            .enumerate()
            .map(|(k, h)| h * (k % 4) as f64)
            .sum();
        assert!(sum.abs() < 1e-12 && tilted.abs() < 1e-12);
        assert!(m.heights[0] > 0.3 && m.heights.iter().all(|h| h.abs() < 1.0));
        let mut holes = map(false);
        holes.heights[..7].fill(f64::NAN);
        assert_eq!(holes.fill(), Err(7));
    }
}

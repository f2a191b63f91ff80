/// A factor as a function of time: a table, linear in between, constant outside.
#[derive(Debug, Clone, PartialEq)]
pub struct Amplitude {
    table: Vec<[f64; 2]>,
}

/// Why a table is not an amplitude.
#[derive(Debug, Clone, PartialEq)]
pub enum AmplitudeError {
    /// No rows.
    Empty,
    /// Time does not increase, or something is not finite, at this row (from 0).
    Row(usize),
}

impl Amplitude {
    /// From rows of `[time, factor]` with increasing times.
    pub fn new(table: Vec<[f64; 2]>) -> Result<Self, AmplitudeError> {
        if table.is_empty() {
            return Err(AmplitudeError::Empty);
        }
        for (i, row) in table.iter().enumerate() {
            let follows = i == 0 || row[0] > table[i - 1][0];
            if !follows || !row[0].is_finite() || !row[1].is_finite() {
                return Err(AmplitudeError::Row(i));
            }
        }
        Ok(Amplitude { table })
    }

    /// The factor at time `t`.
    pub fn at(&self, t: f64) -> f64 {
        let i = self.table.partition_point(|row| row[0] <= t);
        if i == 0 {
            return self.table[0][1];
        }
        let [t0, f0] = self.table[i - 1];
        match self.table.get(i) {
            Some(&[t1, f1]) => f0 + (f1 - f0) * (t - t0) / (t1 - t0),
            None => f0,
        }
    }

    /// Its rows of `[time, factor]`.
    pub fn rows(&self) -> &[[f64; 2]] {
        &self.table
    }

    /// The times of its rows: increments land on them.
    pub fn times(&self) -> impl Iterator<Item = f64> + '_ {
        self.table.iter().map(|row| row[0])
    }
}

use serde::{Deserialize, Serialize};

use super::law::{WearLaw, WearPoint, WearRate};
use crate::contact::law::grid::Grid;
use crate::registry::Samples;
use crate::tolerance::ROUNDING;

/// Measured rates over pressure and speed: depth `k(p, v) p |ds|`, with k bilinear between the entries of the table and
/// constant outside.
///
/// One row a pressure, one column a speed, as in `friction.tabular`; a list that is left out does not matter to wear. In a quasi-static analysis "speed" is path per unit of the problem's
/// time, in cycles of the one that is computed. Where the rate falls with the pressure it must not fall so fast that more pressure wears less.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Tabular {
    /// Pressures of the rows `[Pa]`, increasing. Default: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pressures: Option<Vec<f64>>,
    /// Sliding speeds of the columns `[m/s]`, increasing. Default: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub speeds: Option<Vec<f64>>,
    /// Specific wear rates of the secondary `[1/Pa]`, one row a pressure.
    pub coefficient: Vec<Vec<f64>>,
    /// The same of the primary `[1/Pa]`, whose surface has a depth of its own. Default: none, it does not wear.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub primary_coefficient: Option<Vec<Vec<f64>>>,
}

impl Tabular {
    fn grids(&self) -> impl Iterator<Item = Grid<'_>> {
        let grid = |key, values| Grid {
            pressures: self.pressures.as_deref(),
            speeds: self.speeds.as_deref(),
            key,
            values,
        };
        let own = grid("coefficient", self.coefficient.as_slice());
        let other = self.primary_coefficient.as_deref();
        let other = other.map(|values| grid("primary-coefficient", values));
        [Some(own), other].into_iter().flatten()
    }
}

/// A rate and its slope at both ends of every interval of pressures, in every column: the depth over the path is a parabola in between.
fn slopes(grid: &Grid) -> Vec<f64> {
    let [rows, columns] = grid.shape();
    let pressures = grid.pressures.unwrap_or(&[]);
    let mut slopes = Vec::new();
    for column in 0..columns {
        slopes.extend((0..rows).map(|row| grid.entry(row, column)));
        for (row, pair) in pressures.windows(2).enumerate() {
            let [low, high] = [row, row + 1].map(|row| grid.entry(row, column));
            let change = (high - low) / (pair[1] - pair[0]);
            slopes.extend([low + pair[0] * change, high + pair[1] * change]);
        }
    }
    slopes
}

impl WearLaw for Tabular {
    fn rates(&self, at: &WearPoint) -> [WearRate; 2] {
        let mut rates = [WearRate::default(); 2];
        for (rate, grid) in rates.iter_mut().zip(self.grids()) {
            let [pressed, d_pressure, _] = grid.at(at.pressure, at.speed);
            *rate = WearRate {
                pressed,
                d_pressure,
                ..WearRate::default()
            };
        }
        rates
    }

    fn fastest(&self) -> [WearRate; 2] {
        let mut rates = [WearRate::default(); 2];
        for (rate, grid) in rates.iter_mut().zip(self.grids()) {
            *rate = WearRate::pressed(slopes(&grid).into_iter().fold(0.0, f64::max));
        }
        rates
    }

    fn faults(&self) -> Vec<(&'static str, String)> {
        let mut faults = Vec::new();
        for fault in self.grids().flat_map(|grid| grid.faults()) {
            if !faults.contains(&fault) {
                faults.push(fault);
            }
        }
        if !faults.is_empty() {
            return faults;
        }
        let mut most = 0.0_f64;
        for grid in self.grids() {
            let slopes = slopes(&grid);
            let largest = slopes.iter().copied().fold(0.0, f64::max);
            most = most.max(largest);
            if slopes.iter().any(|s| *s < -ROUNDING * largest) {
                faults.push((
                    grid.key,
                    "falls so fast with the pressure that more pressure would wear less: between two rows k p has to rise".into(),
                ));
            }
        }
        if most == 0.0 {
            faults.push(("coefficient", "one rate must be positive".into()));
        }
        faults
    }
}

impl Samples for Tabular {
    fn samples() -> Vec<Self> {
        vec![
            Tabular {
                pressures: Some(vec![0.0, 4.0, 8.0]),
                speeds: Some(vec![0.0, 0.1]),
                coefficient: vec![vec![1e-14, 2e-14], vec![3e-14, 5e-14], vec![4e-14, 4.5e-14]],
                primary_coefficient: None,
            },
            Tabular {
                pressures: Some(vec![1.0, 9.0]),
                speeds: None,
                coefficient: vec![vec![3e-14, 2e-14]],
                primary_coefficient: Some(vec![vec![1e-14, 2e-14]]),
            },
        ]
    }
}

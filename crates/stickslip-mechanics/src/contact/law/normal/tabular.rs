use serde::{Deserialize, Serialize};

use super::law::NormalLaw;
use crate::math::Slope;
use crate::registry::Samples;

/// A measured curve of pressure over penetration: linear between the rows, continued with the slope of the last piece.
/// The first row is where contact begins and must have zero pressure; both columns increase.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Tabular {
    /// Rows of `[penetration [m], pressure [Pa]]`.
    pub table: Vec<[f64; 2]>,
}

impl Tabular {
    /// The piece whose column `column` (0 penetration, 1 pressure) holds `x`; the last one beyond the end.
    fn piece(&self, column: usize, x: f64) -> ([f64; 2], [f64; 2]) {
        let i = self.table.partition_point(|row| row[column] <= x);
        let i = i.clamp(1, self.table.len() - 1);
        (self.table[i - 1], self.table[i])
    }
}

impl NormalLaw for Tabular {
    fn pressure(&self, gap: f64) -> Option<Slope> {
        let d = -gap;
        if d <= self.table[0][0] {
            return Some(Slope::default());
        }
        let (a, b) = self.piece(0, d);
        let k = (b[1] - a[1]) / (b[0] - a[0]);
        Some(Slope {
            value: a[1] + k * (d - a[0]),
            slope: -k,
        })
    }

    fn gap(&self, pressure: f64) -> Slope {
        let (a, b) = self.piece(1, pressure);
        let c = (b[0] - a[0]) / (b[1] - a[1]);
        Slope {
            value: -(a[0] + c * (pressure - a[1])),
            slope: -c,
        }
    }

    fn energy(&self, gap: f64) -> f64 {
        let d = -gap;
        let mut sum = 0.0;
        for (i, pair) in self.table.windows(2).enumerate() {
            let (a, b) = (pair[0], pair[1]);
            let last = i + 2 == self.table.len();
            let x = if last { d } else { d.min(b[0]) };
            if x <= a[0] {
                break;
            }
            let k = (b[1] - a[1]) / (b[0] - a[0]);
            let w = x - a[0];
            sum += a[1] * w + 0.5 * k * w * w;
        }
        sum
    }

    fn faults(&self) -> Vec<(&'static str, String)> {
        let message = if self.table.len() < 2 {
            "needs at least two rows".into()
        } else if self.table.iter().flatten().any(|x| !x.is_finite()) {
            "has a number that is not finite".into()
        } else if self.table[0][1] != 0.0 {
            format!("must begin at zero pressure, not {}", self.table[0][1])
        } else if let Some(i) = self
            .table
            .windows(2)
            .position(|w| !(w[1][0] > w[0][0] && w[1][1] > w[0][1]))
        {
            format!("must increase in both columns; row {} does not", i + 2)
        } else {
            return Vec::new();
        };
        vec![("table", message)]
    }
}

impl Samples for Tabular {
    fn samples() -> Vec<Self> {
        vec![Tabular {
            table: vec![[0.0, 0.0], [1.03e-6, 2e6], [2.17e-6, 9e6], [4.03e-6, 4e7]],
        }]
    }
}

use serde::{Deserialize, Serialize};

use super::law::{FrictionLaw, FrictionPoint, Limit};
use crate::contact::law::grid::Grid;
use crate::registry::Samples;

/// Measured coefficients over pressure and speed: limit `μ(p, v) p`, with μ bilinear between the entries of the table and
/// constant outside.
///
/// One row a pressure, one column a speed. A list that is left out does not matter to friction. Without `pressures` there
/// is one row: `tabular = { speeds = [0, 0.1, 1], mu = [[0.5, 0.4, 0.3]] }`. Without `speeds` there is one column, which
/// may be written as a row as well. In a quasi-static analysis "speed" is slip per unit of the problem's time.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Tabular {
    /// Pressures of the rows `[Pa]`, increasing. Default: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pressures: Option<Vec<f64>>,
    /// Sliding speeds of the columns `[m/s]`, increasing. Default: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub speeds: Option<Vec<f64>>,
    /// Coefficients of friction `[-]`, one row a pressure.
    pub mu: Vec<Vec<f64>>,
}

impl Tabular {
    fn grid(&self) -> Grid<'_> {
        Grid {
            pressures: self.pressures.as_deref(),
            speeds: self.speeds.as_deref(),
            key: "mu",
            values: &self.mu,
        }
    }
}

impl FrictionLaw for Tabular {
    fn limit(&self, at: &FrictionPoint) -> Limit {
        let [mu, d_pressure, d_speed] = self.grid().at(at.pressure, at.speed);
        Limit {
            value: mu * at.pressure,
            d_pressure: mu + d_pressure * at.pressure,
            d_speed: d_speed * at.pressure,
            ..Limit::default()
        }
    }

    fn frictional(&self) -> bool {
        self.mu.iter().flatten().any(|&mu| mu > 0.0)
    }

    fn faults(&self) -> Vec<(&'static str, String)> {
        self.grid().faults()
    }
}

impl Samples for Tabular {
    fn samples() -> Vec<Self> {
        vec![
            Tabular {
                pressures: Some(vec![1e6, 2e7, 1.5e8]),
                speeds: Some(vec![0.0, 0.1, 1.0]),
                mu: vec![
                    vec![0.5, 0.42, 0.35],
                    vec![0.45, 0.4, 0.3],
                    vec![0.3, 0.28, 0.24],
                ],
            },
            Tabular {
                pressures: None,
                speeds: Some(vec![0.01, 0.5, 2.0]),
                mu: vec![vec![0.5, 0.4, 0.45]],
            },
            Tabular {
                pressures: Some(vec![0.0, 1e8]),
                speeds: None,
                mu: vec![vec![0.5], vec![0.2]],
            },
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(pressures: &[f64], speeds: &[f64], mu: &[&[f64]]) -> Tabular {
        // none where empty
        let list = |list: &[f64]| (!list.is_empty()).then(|| list.to_vec());
        Tabular {
            pressures: list(pressures),
            speeds: list(speeds),
            mu: mu.iter().map(|row| row.to_vec()).collect(),
        }
    }

    fn mu(law: &Tabular, pressure: f64, speed: f64) -> f64 {
        let at = FrictionPoint {
            pressure,
            speed,
            ..FrictionPoint::default()
        };
        law.limit(&at).value / pressure
    }

    #[test]
    fn between_and_beyond_the_entries() {
        let law = table(&[100.0, 200.0], &[1.0, 3.0], &[&[0.8, 0.4], &[0.2, 0.2]]);
        for (pressure, speed, expected) in [
            (100.0, 1.0, 0.8),
            (100.0, 3.0, 0.4),
            (200.0, 3.0, 0.2),
            (100.0, 2.0, 0.6),
            (150.0, 1.0, 0.5),
            (175.0, 1.5, 0.325),
            (10.0, 0.0, 0.8),
            (10.0, 9.0, 0.4),
            (900.0, 0.0, 0.2),
        ] {
            let found = mu(&law, pressure, speed);
            assert!(
                (found - expected).abs() < 1e-15,
                "{pressure} {speed} {found}"
            );
        }
    }

    #[test]
    fn a_list_left_out_does_not_matter() {
        let over_speed = table(&[], &[0.0, 2.0], &[&[0.5, 0.3]]);
        assert!((mu(&over_speed, 7.0, 1.0) - 0.4).abs() < 1e-15);
        assert_eq!(mu(&over_speed, 7.0, 1.0), mu(&over_speed, 7e9, 1.0));
        let column = table(&[0.0, 10.0], &[], &[&[0.5], &[0.3]]);
        let row = table(&[0.0, 10.0], &[], &[&[0.5, 0.3]]);
        for law in [&column, &row] {
            assert!(law.faults().is_empty());
            assert!((mu(law, 5.0, 3.0) - 0.4).abs() < 1e-15);
            assert_eq!(mu(law, 20.0, 3.0), 0.3);
        }
        let constant = table(&[], &[], &[&[0.3]]);
        assert!(constant.faults().is_empty());
        assert_eq!(mu(&constant, 2.0, 1.0), 0.3);
    }

    #[test]
    fn a_product_of_linear_functions_is_met_exactly_with_its_derivatives() {
        // μ = (1 - p/10)(1 - v/4) lies in every bilinear patch
        let (p, v) = ([0.0, 3.0, 5.0], [0.0, 1.0, 2.0]);
        let f = |p: f64, v: f64| (1.0 - p / 10.0) * (1.0 - v / 4.0);
        let rows = p.map(|p| v.map(|v| f(p, v)));
        let rows: Vec<&[f64]> = rows.iter().map(|row| &row[..]).collect();
        let law = table(&p, &v, &rows);
        for (p, v) in [(0.0, 0.0), (1.1, 0.3), (3.0, 1.0), (4.2, 1.7)] {
            let limit = law.limit(&FrictionPoint {
                pressure: p,
                speed: v,
                ..FrictionPoint::default()
            });
            assert!((limit.value - f(p, v) * p).abs() < 1e-14);
            let d_pressure = (1.0 - p / 5.0) * (1.0 - v / 4.0);
            assert!((limit.d_pressure - d_pressure).abs() < 1e-14, "{p} {v}");
            let d_speed = -(1.0 - p / 10.0) * p / 4.0;
            assert!((limit.d_speed - d_speed).abs() < 1e-14, "{p} {v}");
        }
    }

    #[test]
    fn faults_say_what_is_wrong_with_the_table() {
        let says = |law: &Tabular, expected: &[(&str, &str)]| {
            let faults = law.faults();
            let found: Vec<_> = faults.iter().map(|(k, m)| (*k, m.as_str())).collect();
            assert_eq!(found, expected, "{law:?}");
        };
        let two = [1.0, 2.0];
        says(
            &table(&[1.0, 1.0], &[2.0, 1.0], &[&[0.1, 0.1], &[0.1, 0.1]]),
            &[
                ("pressures", "must increase; entry 2 does not"),
                ("speeds", "must increase; entry 2 does not"),
            ],
        );
        says(
            &table(&[-1.0, 1.0], &[], &[&[0.1], &[0.1]]),
            &[("pressures", "must not be negative, but begins with -1")],
        );
        says(
            &table(&[1.0, f64::INFINITY], &[], &[&[0.1], &[0.1]]),
            &[("pressures", "must be finite, but has inf")],
        );
        says(
            &table(&two, &[], &[&[0.1], &[-0.1]]),
            &[("mu", "must not be negative, but has -0.1")],
        );
        says(
            &table(&two, &[], &[&[0.1], &[f64::NAN]]),
            &[("mu", "must be finite, but has NaN")],
        );
        says(&table(&two, &[], &[]), &[("mu", "has no numbers")]);
        says(&table(&two, &[], &[&[], &[]]), &[("mu", "has no numbers")]);
        says(
            &table(&two, &two, &[&[0.1, 0.1]]),
            &[("mu", "must have 2 rows, one for each pressure, but has 1")],
        );
        says(
            &table(&two, &two, &[&[0.1, 0.1], &[0.1]]),
            &[(
                "mu",
                "must have 2 numbers in a row, one for each speed; row 2 has 1",
            )],
        );
        says(
            &table(&[], &two, &[&[0.1, 0.1], &[0.1, 0.1]]),
            &[(
                "mu",
                "must have 1 row, because there are no `pressures`, but has 2",
            )],
        );
        says(
            &table(&two, &[], &[&[0.1], &[0.1, 0.2]]),
            &[(
                "mu",
                "must have 1 number in a row, because there are no `speeds`; row 2 has 2",
            )],
        );
        let empty = Tabular {
            speeds: Some(Vec::new()),
            ..table(&[], &[], &[&[0.1]])
        };
        says(
            &empty,
            &[(
                "speeds",
                "is empty; leave the key out if nothing depends on it",
            )],
        );
    }
}

use super::model::{Spot, TemperatureModel, finite};
use crate::body::Space;
use crate::registry::Samples;

/// A temperature for each node, by its number in the mesh file: what a heat analysis elsewhere has found.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Nodes {
    /// Rows of the number of a node and its temperature `[K]`, one for each node of the set; numbers increase.
    pub values: Vec<[f64; 2]>,
}

impl TemperatureModel for Nodes {
    fn at(&self, _space: Space, spot: &Spot) -> Option<f64> {
        let number = spot.node as f64;
        let order = |row: &[f64; 2]| row[0].total_cmp(&number);
        let row = self.values.binary_search_by(order).ok()?;
        Some(self.values[row][1])
    }

    fn faults(&self, _space: Space) -> Vec<(&'static str, String)> {
        let number = |n: f64| n >= 0.0 && n.fract() == 0.0 && n < 2_f64.powi(53);
        let odd = self.values.iter().find(|row| !number(row[0]));
        let odd = odd.map(|row| {
            (
                "values",
                format!("has {}, which is no number of a node", row[0]),
            )
        });
        let mut pairs = self.values.windows(2);
        let back = pairs.find(|w| w[0][0] >= w[1][0]).map(|w| {
            let message = format!("has node {} behind {}: numbers increase", w[1][0], w[0][0]);
            ("values", message)
        });
        let temperatures: Vec<f64> = self.values.iter().map(|row| row[1]).collect();
        let value = finite("values", &temperatures);
        [odd, back, value].into_iter().flatten().collect()
    }
}

impl Samples for Nodes {
    fn samples() -> Vec<Self> {
        vec![Nodes {
            values: vec![[7.0, 20.0], [8.0, 35.5]],
        }]
    }
}

use serde::{Deserialize, Serialize};

use crate::math::{Vec3, dot};

/// A parameter of a law: one number, or a table over a coordinate.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(untagged)]
pub enum Profile {
    /// The same everywhere.
    Constant(f64),
    /// It varies over the surface.
    Along(Along),
}

/// A table over the reference coordinate along a direction, linear between its rows and constant beyond them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Along {
    /// Direction of the coordinate, which is `along · x` for a point at `x`: `[0, -1]` is the depth below `y = 0`.
    pub along: Vec<f64>,
    /// Rows `[coordinate, value]`; coordinates ascend.
    pub table: Vec<[f64; 2]>,
}

impl Profile {
    /// The value at a point of the reference configuration.
    pub fn at(&self, place: Vec3) -> f64 {
        match self {
            Profile::Constant(value) => *value,
            Profile::Along(along) => along.at(place),
        }
    }

    /// All values that are given.
    pub fn values(&self) -> Vec<f64> {
        match self {
            Profile::Constant(value) => vec![*value],
            Profile::Along(along) => along.table.iter().map(|row| row[1]).collect(),
        }
    }

    /// What is wrong with it, where each of its values has to be of a kind.
    pub fn fault(
        &self,
        key: &'static str,
        kind: fn(&'static str, f64) -> Option<(&'static str, String)>,
    ) -> Option<(&'static str, String)> {
        let wrong = |message: &str| Some((key, message.to_string()));
        if let Profile::Along(Along { along, table }) = self {
            let size: f64 = along.iter().map(|c| c.abs()).sum();
            let points_somewhere = size > 0.0 && size.is_finite();
            if !(2..=3).contains(&along.len()) || !points_somewhere {
                return wrong("`along` is a direction: two or three numbers that are not all zero");
            }
            let ascends = table.windows(2).all(|rows| rows[0][0] < rows[1][0]);
            if table.is_empty() || !ascends || !table.iter().all(|row| row[0].is_finite()) {
                return wrong(
                    "`table` needs rows `[coordinate, value]` with ascending coordinates",
                );
            }
        }
        self.values().into_iter().find_map(|value| kind(key, value))
    }
}

impl Along {
    fn at(&self, place: Vec3) -> f64 {
        let mut direction = [0.0; 3];
        direction
            .iter_mut()
            .zip(&self.along)
            .for_each(|(d, a)| *d = *a);
        let x = dot(direction, place);
        let after = self.table.partition_point(|row| row[0] < x);
        match (
            after.checked_sub(1).map(|k| self.table[k]),
            self.table.get(after),
        ) {
            (Some([from, low]), Some(&[to, high])) => low + (high - low) * (x - from) / (to - from),
            (None, Some(row)) => row[1],
            (Some(row), None) => row[1],
            (None, None) => f64::NAN,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::law::normal::positive;

    #[test]
    fn a_table_is_linear_between_its_rows_and_constant_beyond_them() {
        let depth = Profile::Along(Along {
            along: vec![0.0, -1.0],
            table: vec![[15.0, 0.010], [18.0, 0.025]],
        });
        for (y, value) in [
            (0.0, 0.010),
            (-15.0, 0.010),
            (-16.0, 0.015),
            (-18.0, 0.025),
            (-90.0, 0.025),
        ] {
            assert!((depth.at([3.0, y, 0.0]) - value).abs() < 1e-15, "{y}");
        }
        assert_eq!(depth.fault("a", positive), None);
        assert_eq!(Profile::Constant(0.3).at([1.0; 3]), 0.3);
    }

    #[test]
    fn what_is_no_table_is_refused() {
        let profile = |along: &[f64], table: &[[f64; 2]]| {
            let (along, table) = (along.to_vec(), table.to_vec());
            Profile::Along(Along { along, table }).fault("a", positive)
        };
        for (fault, part) in [
            (profile(&[0.0, 0.0], &[[0.0, 1.0]]), "direction"),
            (profile(&[1.0], &[[0.0, 1.0]]), "direction"),
            (profile(&[1.0, 0.0], &[]), "rows"),
            (profile(&[1.0, 0.0], &[[1.0, 1.0], [1.0, 2.0]]), "ascending"),
            (profile(&[1.0, 0.0], &[[0.0, 1.0], [1.0, -2.0]]), "-2"),
        ] {
            let message = fault.expect("a fault").1;
            assert!(message.contains(part), "{message}");
        }
    }
}

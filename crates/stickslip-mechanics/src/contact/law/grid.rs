//! Values over pressure and speed, as tables of measured coefficients give them.

/// A place between two entries of a list: the two, the weight of the second, and its derivative.
struct Between {
    entries: [usize; 2],
    weight: f64,
    d_weight: f64,
}

impl Between {
    /// Where `x` is in an increasing list; at an entry in the interval to its right, outside at the first or last.
    fn find(list: Option<&[f64]>, x: f64) -> Self {
        let list = list.unwrap_or(&[]);
        let after = list.partition_point(|&entry| entry <= x);
        if after == 0 || after == list.len() {
            let end = after.saturating_sub(1);
            return Between {
                entries: [end, end],
                weight: 0.0,
                d_weight: 0.0,
            };
        }
        let (a, b) = (list[after - 1], list[after]);
        Between {
            entries: [after - 1, after],
            weight: (x - a) / (b - a),
            d_weight: 1.0 / (b - a),
        }
    }
}

/// A table of one row a pressure and one column a speed, bilinear between its entries and constant outside. A list that is left out does not matter; one column may be
/// written as a row.
#[derive(Clone, Copy)]
pub(super) struct Grid<'a> {
    pub pressures: Option<&'a [f64]>,
    pub speeds: Option<&'a [f64]>,
    /// Key of the values, and they themselves.
    pub key: &'static str,
    pub values: &'a [Vec<f64>],
}

impl Grid<'_> {
    pub fn entry(&self, row: usize, column: usize) -> f64 {
        // one column written as a row
        if self.speeds.is_none() && self.values.len() == 1 {
            return self.values[0][row];
        }
        self.values[row][column]
    }

    /// The value and its derivatives with respect to pressure and speed.
    pub fn at(&self, pressure: f64, speed: f64) -> [f64; 3] {
        let row = Between::find(self.pressures, pressure);
        let column = Between::find(self.speeds, speed);
        // across the columns, in either row
        let mut value = [0.0; 2];
        let mut d_speed = [0.0; 2];
        for (k, &i) in row.entries.iter().enumerate() {
            let [a, b] = column.entries.map(|j| self.entry(i, j));
            value[k] = a + (b - a) * column.weight;
            d_speed[k] = (b - a) * column.d_weight;
        }
        let mix = |[a, b]: [f64; 2]| a + (b - a) * row.weight;
        [
            mix(value),
            (value[1] - value[0]) * row.d_weight,
            mix(d_speed),
        ]
    }

    /// Numbers of rows and columns.
    pub fn shape(&self) -> [usize; 2] {
        [self.pressures, self.speeds].map(|list| list.map_or(1, <[f64]>::len))
    }

    /// What is wrong with it, by key.
    pub fn faults(&self) -> Vec<(&'static str, String)> {
        let lists = [("pressures", self.pressures), ("speeds", self.speeds)];
        let mut faults: Vec<_> = lists
            .into_iter()
            .filter_map(|(key, list)| Some((key, unsorted(list?)?)))
            .collect();
        let numbers = || self.values.iter().flatten();
        let values = if let Some(x) = numbers().find(|x| !x.is_finite()) {
            Some(format!("must be finite, but has {x}"))
        } else if let Some(x) = numbers().find(|&&x| x < 0.0) {
            Some(format!("must not be negative, but has {x}"))
        } else if numbers().next().is_none() {
            Some("has no numbers".into())
        } else if self.shape().contains(&0) {
            None // said already
        } else {
            self.misshapen()
        };
        faults.extend(values.map(|message| (self.key, message)));
        faults
    }

    /// What is wrong with the shape of the values.
    fn misshapen(&self) -> Option<String> {
        let [rows, columns] = self.shape();
        let values = self.values;
        if self.speeds.is_none() && values.len() == 1 && values[0].len() == rows {
            return None;
        }
        if values.len() != rows {
            let reason = match self.pressures {
                Some(_) => "one for each pressure",
                None => "because there are no `pressures`",
            };
            return Some(format!(
                "must have {rows} row{}, {reason}, but has {}",
                if rows == 1 { "" } else { "s" },
                values.len()
            ));
        }
        let i = values.iter().position(|row| row.len() != columns)?;
        let reason = match self.speeds {
            Some(_) => "one for each speed",
            None => "because there are no `speeds`",
        };
        Some(format!(
            "must have {columns} number{} in a row, {reason}; row {} has {}",
            if columns == 1 { "" } else { "s" },
            i + 1,
            values[i].len()
        ))
    }
}

/// What is wrong with the pressures or speeds of a table.
fn unsorted(list: &[f64]) -> Option<String> {
    if list.is_empty() {
        return Some("is empty; leave the key out if nothing depends on it".into());
    }
    if let Some(x) = list.iter().find(|x| !x.is_finite()) {
        return Some(format!("must be finite, but has {x}"));
    }
    if list[0] < 0.0 {
        return Some(format!("must not be negative, but begins with {}", list[0]));
    }
    let i = list.windows(2).position(|w| w[1] <= w[0])?;
    Some(format!("must increase; entry {} does not", i + 2))
}

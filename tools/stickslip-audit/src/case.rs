//! The problem file, read anew: `problem.toml` of a result folder has every default filled in.

use std::path::Path;

use toml::{Table, Value};

use crate::vec3::Vec3;

/// The space of a problem.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Space {
    /// Plane strain with a thickness.
    Strain(f64),
    /// Plane stress with a thickness.
    Stress(f64),
    /// Around the axis x = 0.
    Ring,
    /// Three dimensions.
    Solid,
}

impl Space {
    /// Number of displacements of a point.
    pub fn dim(self) -> usize {
        if self == Space::Solid { 3 } else { 2 }
    }

    /// What an integral over the mesh is multiplied by.
    pub fn extent(self, x: Vec3) -> f64 {
        match self {
            Space::Strain(t) | Space::Stress(t) => t,
            Space::Ring => std::f64::consts::TAU * x[0],
            Space::Solid => 1.0,
        }
    }
}

/// A problem file.
#[derive(Debug, Clone)]
pub struct Case {
    /// The whole of it.
    pub table: Table,
    /// Its space.
    pub space: Space,
    /// Its steps with their starts and ends.
    pub steps: Vec<Step>,
}

/// A step.
#[derive(Debug, Clone)]
pub struct Step {
    /// When it begins.
    pub start: f64,
    /// When it ends.
    pub end: f64,
    /// Its keys.
    pub table: Table,
    /// How long one of its cycles is, if it has some.
    pub cycle: Option<f64>,
}

impl Step {
    /// The time that amplitudes see: in a step with cycles that of the first one.
    pub fn clock(&self, t: f64) -> f64 {
        let Some(cycle) = self.cycle else {
            return t;
        };
        let over = ((t - self.start) / cycle * (1.0 - 1e-9)).floor().max(0.0);
        t - over * cycle
    }

    /// Whether the bodies have inertia.
    pub fn dynamic(&self) -> bool {
        self.table.contains_key("dynamic")
    }

    /// Whether it goes without a matrix, by central differences.
    pub fn explicit(&self) -> bool {
        let dynamic = self.table.get("dynamic").and_then(Value::as_table);
        dynamic
            .and_then(|d| kind(d, "scheme"))
            .is_some_and(|s| s.0 == "central-difference")
    }

    /// Whether an item acts: all do where there is no list.
    pub fn lists(&self, kind: &str, name: &str) -> bool {
        match self.table.get(kind).and_then(Value::as_array) {
            Some(list) => list.iter().any(|item| item.as_str() == Some(name)),
            None => true,
        }
    }
}

impl Case {
    /// Reads a file.
    pub fn read(path: &Path) -> Result<Case, String> {
        let say = |e: String| format!("{}: {e}", path.display());
        let text = std::fs::read_to_string(path).map_err(|e| say(e.to_string()))?;
        Case::parse(&text).map_err(say)
    }

    /// Reads a text.
    pub fn parse(text: &str) -> Result<Case, String> {
        let table: Table = toml::from_str(text).map_err(|e| e.to_string())?;
        let model = table.get("model").and_then(Value::as_table);
        let thickness = model.and_then(|m| number(m, "thickness")).unwrap_or(1.0);
        let space = match model.and_then(|m| text_of(m, "space")) {
            Some("plane-strain") => Space::Strain(thickness),
            Some("plane-stress") => Space::Stress(thickness),
            Some("axisymmetric") => Space::Ring,
            _ => Space::Solid,
        };
        let mut at = 0.0;
        let steps = table
            .get("step")
            .and_then(Value::as_array)
            .into_iter()
            .flatten();
        let steps = steps.filter_map(Value::as_table).map(|step| {
            let start = at;
            let duration = number(step, "duration").unwrap_or(1.0);
            let cycles = step.get("cycles").and_then(Value::as_table);
            // Of cycles that are jumped over only those that are computed take time.
            let computed = cycles.map_or(1.0, |c| {
                let each = |key: &str| number(c, key).unwrap_or(1.0);
                (each("count") / each("jump")).ceil()
            });
            at += computed * duration;
            Step {
                start,
                end: at,
                cycle: cycles.map(|_| duration),
                table: step.clone(),
            }
        });
        let steps = steps.collect();
        Ok(Case {
            space,
            steps,
            table,
        })
    }

    /// The named tables of a kind, in the order of their names.
    pub fn named(&self, kind: &str) -> Vec<(&str, &Table)> {
        let tables = self.table.get(kind).and_then(Value::as_table);
        let tables = tables.into_iter().flatten();
        let mut named: Vec<_> = tables
            .filter_map(|(name, value)| Some((name.as_str(), value.as_table()?)))
            .collect();
        named.sort_by(|a, b| a.0.cmp(b.0));
        named
    }

    /// A named table.
    pub fn of<'a>(&'a self, kind: &str, name: &str) -> Option<&'a Table> {
        self.table.get(kind)?.as_table()?.get(name)?.as_table()
    }

    /// The step that owns a time: the times after its start, and its end.
    pub fn step_at(&self, t: f64) -> usize {
        let rounding = 1e-9 * self.steps.last().map_or(1.0, |s| s.end);
        let found = self.steps.iter().position(|s| t <= s.end + rounding);
        found.unwrap_or(self.steps.len().saturating_sub(1))
    }

    /// The value of an amplitude table: linear between rows, constant outside.
    pub fn amplitude(&self, name: &str, t: f64) -> f64 {
        let table = self.of("amplitude", name).and_then(|a| a.get("table"));
        interpolate(&rows(table), t, 1)
    }

    /// The factor of a load at a time: it grows over the first step in which it acts and falls over the first in which it does not;
    /// in dynamic steps it comes and goes at once.
    pub fn load_factor(&self, name: &str, load: &Table, t: f64) -> f64 {
        self.factor("loads", name, load, t, true)
    }

    /// The factor of a support at a time, and whether it acts.
    pub fn support_factor(&self, name: &str, support: &Table, t: f64) -> (f64, bool) {
        let acts = self.steps[self.step_at(t)].lists("supports", name);
        (self.factor("supports", name, support, t, false), acts)
    }

    fn factor(&self, kind: &str, name: &str, item: &Table, t: f64, lingers: bool) -> f64 {
        let table = text_of(item, "amplitude");
        let last = self.step_at(t);
        let mut before: f64 = 0.0;
        let mut value = 0.0;
        for (i, step) in self.steps.iter().enumerate().take(last + 1) {
            let share = match i == last {
                true => ((t - step.start) / (step.end - step.start)).clamp(0.0, 1.0),
                false => 1.0,
            };
            let sudden = lingers && step.dynamic();
            value = match (step.lists(kind, name), table) {
                (true, Some(table)) => self.amplitude(table, step.clock(t.min(step.end))),
                (true, None) if sudden => 1.0,
                (true, None) => before + (1.0 - before) * share,
                (false, _) if sudden || !lingers => 0.0,
                (false, _) => before * (1.0 - share),
            };
            before = value;
        }
        value
    }
}

/// A number of a table.
pub fn number(table: &Table, key: &str) -> Option<f64> {
    as_number(table.get(key)?)
}

/// A text of a table.
pub fn text_of<'a>(table: &'a Table, key: &str) -> Option<&'a str> {
    table.get(key)?.as_str()
}

/// The numbers of a list; none if it is missing.
pub fn numbers(table: &Table, key: &str) -> Vec<f64> {
    let list = table.get(key).and_then(Value::as_array);
    list.into_iter().flatten().filter_map(as_number).collect()
}

/// A vector of a table, filled with zeros.
pub fn vector(table: &Table, key: &str) -> Vec3 {
    let list = numbers(table, key);
    std::array::from_fn(|i| list.get(i).copied().unwrap_or(0.0))
}

/// Rows of numbers.
pub fn rows(value: Option<&Value>) -> Vec<Vec<f64>> {
    let list = value.and_then(Value::as_array).into_iter().flatten();
    let row = |row: &Value| Some(row.as_array()?.iter().filter_map(as_number).collect());
    list.filter_map(row).collect()
}

/// The one key of a table that names a kind, and its keys: `friction.coulomb = { … }`.
pub fn kind<'a>(table: &'a Table, key: &str) -> Option<(&'a str, &'a Table)> {
    let (name, value) = table.get(key)?.as_table()?.iter().next()?;
    Some((name.as_str(), value.as_table()?))
}

/// A column of rows at a value of their first: linear in between, constant outside.
pub fn interpolate(rows: &[Vec<f64>], x: f64, column: usize) -> f64 {
    let value = |row: &Vec<f64>| row.get(column).copied().unwrap_or(0.0);
    let (Some(first), Some(last)) = (rows.first(), rows.last()) else {
        return 0.0;
    };
    if x <= first[0] {
        return value(first);
    }
    for pair in rows.windows(2) {
        if x <= pair[1][0] {
            let s = (x - pair[0][0]) / (pair[1][0] - pair[0][0]);
            return value(&pair[0]) + s * (value(&pair[1]) - value(&pair[0]));
        }
    }
    value(last)
}

fn as_number(value: &Value) -> Option<f64> {
    value.as_float().or(value.as_integer().map(|i| i as f64))
}

#[cfg(test)]
mod tests {
    use super::{Case, interpolate};

    #[test]
    fn a_load_grows_stays_and_falls() {
        let text = "load.a = { set = \"b\" }\n[[step]]\nloads = []\n[[step]]\n[[step]]\n[[step]]\nloads = []\n";
        let case = Case::parse(text).expect("a case");
        let load = case.of("load", "a").expect("the load");
        let factors = [0.5, 1.5, 2.5, 3.25].map(|t| case.load_factor("a", load, t));
        assert_eq!(factors, [0.0, 0.5, 1.0, 0.75]);
        assert_eq!(case.support_factor("a", load, 3.5).0, 1.0);
    }

    #[test]
    fn tables_are_constant_outside() {
        let rows = [vec![1.0, 2.0], vec![3.0, 4.0]];
        assert_eq!(
            [0.0, 2.0, 9.0].map(|x| interpolate(&rows, x, 1)),
            [2.0, 3.0, 4.0]
        );
    }
}

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde_json::Value;

use crate::io::csv::{self, Table};

use super::expected::{Check, Curve, Reduce};
use super::near::near;
use super::report::{Comparison, Target, Verdict};
use super::select::{Line, at_time, column, number, reduce, rows_where};

/// The results of a run, read as checks ask for them.
pub(super) struct Results<'a> {
    dir: &'a Path,
    /// Folder of the reference curves.
    beside: PathBuf,
    tables: BTreeMap<PathBuf, Result<Table, String>>,
    summary: Option<Result<Value, String>>,
}

impl<'a> Results<'a> {
    pub fn new(dir: &'a Path, expected: &Path) -> Self {
        Results {
            dir,
            beside: expected.parent().unwrap_or(Path::new("")).to_path_buf(),
            tables: BTreeMap::new(),
            summary: None,
        }
    }

    /// Carries out one check.
    pub fn judge(&mut self, check: &Check) -> Verdict {
        let comparison = match &check.curve {
            Some(curve) => self.curve(check, curve),
            None => self.value(check).map(|found| {
                let target = match check.value {
                    Some(value) => Target::Value {
                        value,
                        tolerance: tolerance(check, value.abs()),
                    },
                    None => Target::Bounds {
                        above: check.above,
                        below: check.below,
                    },
                };
                Comparison { found, target }
            }),
        };
        comparison.map_or_else(Verdict::Missing, Verdict::Compared)
    }

    fn value(&mut self, check: &Check) -> Result<f64, String> {
        if let Some(path) = &check.summary {
            return number(self.summary()?, path);
        }
        let how = check.reduce.unwrap_or(Reduce::Last);
        if let Some(name) = &check.history {
            let file = "history.csv";
            let table = self.table(self.dir.join(file), file)?;
            let values = column(table, file, name)?;
            return match check.at {
                Some(t) => at_time(column(table, file, "TIME")?, values, t),
                None => reduce(values, how),
            };
        }
        match (&check.along, check.at) {
            (Some(along), Some(x)) => self.line(check, along)?.at(x),
            _ => reduce(&self.column(check, check.column.as_deref())?, how),
        }
    }

    /// Largest difference to a reference curve, as a value that should be zero.
    fn curve(&mut self, check: &Check, curve: &Curve) -> Result<Comparison, String> {
        let line = self.line(check, check.along.as_deref().unwrap_or_default())?;
        let reference = self.table(self.beside.join(&curve.file), &curve.file)?;
        let abscissae = column(reference, &curve.file, &curve.along)?;
        let values = column(reference, &curve.file, &curve.column)?;
        if values.is_empty() {
            return Err(format!("{} has no rows", curve.file));
        }
        let mut differences = Vec::with_capacity(values.len());
        for (&x, &value) in abscissae.iter().zip(values) {
            differences.push(line.at(x)? - value);
        }
        let largest = reduce(values, Reduce::MaxAbs)?;
        Ok(Comparison {
            found: reduce(&differences, Reduce::MaxAbs)?,
            target: Target::Curve {
                largest,
                tolerance: tolerance(check, largest),
            },
        })
    }

    fn line(&mut self, check: &Check, along: &str) -> Result<Line, String> {
        let x = self.column(check, Some(along))?;
        let y = self.column(check, check.column.as_deref())?;
        Line::new(&x, &y, along)
    }

    /// A column of the table of a check, in the rows it chooses.
    fn column(&mut self, check: &Check, name: Option<&str>) -> Result<Vec<f64>, String> {
        let file = check.table.as_deref().unwrap_or_default();
        let table = self.table(self.dir.join(file), file)?;
        let values = column(table, file, name.unwrap_or_default())?;
        let rows = rows_where(table, file, &check.only)?;
        Ok(rows.into_iter().map(|row| values[row]).collect())
    }

    fn table(&mut self, path: PathBuf, name: &str) -> Result<&Table, String> {
        let entry = self.tables.entry(path);
        let path = entry.key().clone();
        let table = entry.or_insert_with(|| {
            csv::read(&path).map_err(|e| match path.exists() {
                true => e.to_string(),
                false => format!("there is no {name}{}", siblings(&path)),
            })
        });
        table.as_ref().map_err(String::clone)
    }

    fn summary(&mut self) -> Result<&Value, String> {
        let path = self.dir.join("summary.json");
        let summary = self.summary.get_or_insert_with(|| {
            let text = crate::io::input::read_text(&path)
                .map_err(|_| format!("there is no summary.json{}", siblings(&path)))?;
            serde_json::from_str(&text).map_err(|e| format!("summary.json: {e}"))
        });
        summary.as_ref().map_err(|e| e.clone())
    }
}

/// Files in the folder of a missing one with names like it.
fn siblings(path: &Path) -> String {
    let wanted = path.file_name().unwrap_or_default().to_string_lossy();
    let folder = path.parent().unwrap_or(Path::new("."));
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let mut names: Vec<String> = entries
        .map(|entry| entry.file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    near(&wanted, names.iter().map(String::as_str))
}

/// The larger of both tolerances.
fn tolerance(check: &Check, size: f64) -> f64 {
    let relative = check.relative.map_or(0.0, |relative| relative * size);
    relative.max(check.absolute.unwrap_or(0.0))
}

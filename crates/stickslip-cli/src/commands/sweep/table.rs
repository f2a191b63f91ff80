//! The table of a sweep: a row a run, as CSV.

use std::path::{Path, PathBuf};

use stickslip::Error;
use stickslip::error::IoError;
use stickslip::io::csv::split;
use stickslip::io::{own, write_atomically};

use super::done::{Done, Row};
use super::effort;

/// The rows so far and the file they are written to.
#[derive(Debug)]
pub struct Table {
    /// The file.
    pub path: PathBuf,
    axes: Vec<String>,
    quantities: Vec<String>,
    grows: bool,
    rows: Vec<Row>,
    /// The rows as text. Only a new column changes those that are there.
    text: String,
    /// The rows of the table beside it, of what runs took.
    effort: String,
}

/// Columns between the outcome and the quantities of the history.
const COUNTS: [&str; 3] = ["increments", "iterations", "cutbacks"];

impl Table {
    /// A table without rows. Without `quantities` it gets all that the histories of its runs have.
    pub fn new(path: PathBuf, axes: Vec<String>, quantities: &[String]) -> Self {
        let mut table = Table {
            path,
            axes,
            quantities: Vec::new(),
            grows: true,
            rows: Vec::new(),
            text: String::new(),
            effort: String::new(),
        };
        table.add_quantities(quantities);
        table.grows = quantities.is_empty();
        table
    }

    /// Adds columns for quantities of a history, unless they were chosen.
    fn add_quantities(&mut self, names: &[String]) {
        let before = self.quantities.len();
        for name in names {
            if self.grows && !self.quantities.contains(name) {
                self.quantities.push(name.clone());
            }
        }
        if self.quantities.len() > before {
            let rows = self.rows.iter().enumerate();
            self.text = rows.map(|(i, row)| self.line(i, row)).collect();
        }
    }

    /// Tries whether the file can be written, without changing it.
    ///
    /// # Errors
    /// [`Error::Io`] if it cannot.
    pub fn try_file(&self) -> Result<(), Error> {
        let path = &self.path;
        if path.exists() {
            let file = own::open(path, own::Use::Append);
            return file.map(drop).map_err(|e| Error::io(path, e));
        }
        // A file aside: an empty table, were it for a moment, would be half of one to who looks then.
        let mut aside = path.as_os_str().to_owned();
        aside.push(format!(".{}.tmp", std::process::id()));
        own::make(Path::new(&aside))
            .and_then(|_| std::fs::remove_file(&aside))
            .map_err(|e| Error::io(path, e))
    }

    /// Takes over the rows of a table that was begun, of runs with these values in this order; how many there are.
    ///
    /// # Errors
    /// [`Error::Io`] if the file is no table of this sweep.
    pub fn take_over(&mut self, values: impl Fn(usize) -> Vec<String>) -> Result<usize, Error> {
        let other = |what: &str| {
            Error::Io(IoError {
                file: self.path.clone(),
                message: format!("this is no table of the same sweep: {what}"),
            })
        };
        let text = std::fs::read_to_string(&self.path).map_err(|e| Error::io(&self.path, e))?;
        let mut lines = text.lines().map(split);
        let names = lines.next().unwrap_or_default();
        let mut wanted = vec!["run".to_string()];
        wanted.extend(self.axes.iter().cloned());
        wanted.push("outcome".into());
        wanted.extend(COUNTS.map(str::to_string));
        if names.get(..wanted.len()) != Some(&wanted) {
            return Err(other("its columns are others"));
        }
        let quantities = names[wanted.len()..].to_vec();
        let mut rows = Vec::new();
        for cells in lines {
            let run = rows.len();
            let axes = cells.get(1..=self.axes.len());
            if cells.len() != names.len() || axes != Some(&values(run)) {
                return Err(other(&format!("line {} is none of its runs", run + 2)));
            }
            rows.push(self.read(&cells, &quantities));
        }
        let count = rows.len();
        self.add_quantities(&quantities);
        rows.into_iter().for_each(|row| self.add_row(row));
        Ok(count)
    }

    fn read(&self, cells: &[String], quantities: &[String]) -> Row {
        let at = 1 + self.axes.len();
        let count = |i: usize| cells[at + 1 + i].parse::<usize>().ok();
        let counts = [count(0), count(1), count(2)];
        let numbers = cells[at + 4..].iter().map(|cell| cell.parse::<f64>().ok());
        let named = quantities.iter().zip(numbers);
        Row {
            values: cells[1..at].to_vec(),
            outcome: cells[at].clone(),
            counts: match counts {
                [Some(a), Some(b), Some(c)] => Some([a, b, c]),
                _ => None,
            },
            last: named
                .filter_map(|(name, x)| Some((name.clone(), x?)))
                .collect(),
        }
    }

    /// Writes the table and that of what runs took, aside and renamed: a reader never sees half of them.
    ///
    /// # Errors
    /// [`Error::Io`].
    pub fn write(&self) -> Result<(), Error> {
        let effort = effort::head() + &self.effort;
        write_atomically(&self.path.with_extension("effort.csv"), effort.as_bytes())?;
        write_atomically(&self.path, (self.header() + &self.text).as_bytes())
    }

    /// The rows so far.
    pub fn rows(&self) -> &[Row] {
        &self.rows
    }

    /// Adds a run that is over.
    pub fn add(&mut self, done: &Done) {
        self.add_quantities(&done.names);
        self.add_row(done.row.clone());
        self.effort += &format!("{}\n", done.effort);
    }

    fn add_row(&mut self, row: Row) {
        self.text += &self.line(self.rows.len(), &row);
        self.rows.push(row);
    }

    fn header(&self) -> String {
        let mut names = vec!["run"];
        names.extend(self.axes.iter().map(String::as_str));
        names.push("outcome");
        names.extend(COUNTS);
        names.extend(self.quantities.iter().map(String::as_str));
        line(names.into_iter().map(str::to_string))
    }

    fn line(&self, index: usize, row: &Row) -> String {
        let mut cells = vec![(index + 1).to_string()];
        cells.extend(row.values.iter().cloned());
        cells.push(row.outcome.clone());
        match row.counts {
            Some(counts) => cells.extend(counts.map(|n| n.to_string())),
            None => cells.extend(COUNTS.map(|_| String::new())),
        }
        let values = self.quantities.iter().map(|name| row.last.get(name));
        cells.extend(values.map(|value| value.map_or(String::new(), |&x| number(x))));
        line(cells.into_iter())
    }
}

/// A line of a table.
pub fn line(cells: impl Iterator<Item = String>) -> String {
    let cells: Vec<String> = cells.map(quoted).collect();
    cells.join(",") + "\n"
}

fn quoted(cell: String) -> String {
    if cell.contains([',', '"', '\n', '\r', '#']) {
        format!("\"{}\"", cell.replace('"', "\"\""))
    } else {
        cell
    }
}

/// In the shortest form that reads back to the same bits, as in `history.csv`.
fn number(value: f64) -> String {
    if value.fract() == 0.0 && value.abs() < 1e15 {
        format!("{value}")
    } else {
        format!("{value:e}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn strings(all: &[&str]) -> Vec<String> {
        all.iter().map(ToString::to_string).collect()
    }

    fn text(table: &Table) -> String {
        table.header() + &table.text
    }

    fn row(value: &str, outcome: &str, last: &[(&str, f64)]) -> Row {
        Row {
            values: vec![value.into()],
            outcome: outcome.into(),
            counts: (!last.is_empty()).then_some([2, 7, 0]),
            last: last.iter().map(|(n, x)| (n.to_string(), *x)).collect(),
        }
    }

    #[test]
    fn missing_numbers_are_empty_and_text_is_quoted() {
        let mut table = Table::new("t.csv".into(), strings(&["a.'b,c'"]), &[]);
        assert_eq!(
            text(&table),
            "run,\"a.'b,c'\",outcome,increments,iterations,cutbacks\n"
        );
        table.add_row(row("[1,2]", "no \"set\" b, c", &[]));
        table.add_quantities(&strings(&["U", "B"]));
        table
            .rows
            .push(row("3", "done", &[("B", -0.1), ("U", 2.0)]));
        table.add_quantities(&strings(&["B", "V"]));
        table.add_row(row("4", "done", &[("V", f64::NAN)]));
        assert_eq!(
            text(&table),
            "run,\"a.'b,c'\",outcome,increments,iterations,cutbacks,U,B,V\n\
             1,\"[1,2]\",\"no \"\"set\"\" b, c\",,,,,,\n\
             2,3,done,2,7,0,2,-1e-1,\n\
             3,4,done,2,7,0,,,NaN\n"
        );
    }

    #[test]
    fn chosen_quantities_stay_as_they_are() {
        let mut table = Table::new("t.csv".into(), strings(&["a"]), &strings(&["V", "U", "V"]));
        table.add_quantities(&strings(&["B"]));
        table.add_row(row("1", "done", &[("B", 1.0), ("U", 5e-324)]));
        let all = text(&table);
        assert!(all.contains(",cutbacks,V,U\n"), "{all}");
        assert!(all.ends_with(",0,,5e-324\n"), "{all}");
    }

    #[test]
    fn numbers_read_back_to_the_bit() {
        for x in [0.1 + 0.2, -1.0 / 3.0, 5e-324, 1e300, 17.0, -0.0, f64::MAX] {
            let back: f64 = number(x).parse().unwrap();
            assert_eq!(back.to_bits(), x.to_bits());
        }
    }
}

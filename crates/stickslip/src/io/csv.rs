//! Tables of numbers as comma-separated values: histories that grow by a row, and whole tables.
//!
//! The first line holds the names of the columns. Numbers are written in the shortest form that reads back to the same
//! bits. Names with commas or quotes are quoted.

use std::path::Path;

use crate::error::{Error, IoError};

use super::{Growing, write_atomically};

/// A history that is written as the analysis goes: one row an increment, on disk after each.
#[derive(Debug)]
pub struct History {
    file: Growing,
    columns: usize,
}

impl History {
    /// Starts the file at `path` with the names of the columns, replacing an older one.
    ///
    /// # Errors
    /// [`Error::Io`] if it cannot be written.
    pub fn create(path: &Path, names: &[String]) -> Result<Self, Error> {
        Ok(History {
            file: Growing::create(path, &header(names))?,
            columns: names.len(),
        })
    }

    /// Goes on with a file that has so many columns.
    ///
    /// # Errors
    /// [`Error::Io`] if it cannot be opened.
    pub fn resume(path: &Path, columns: usize) -> Result<Self, Error> {
        let file = Growing::resume(path)?;
        Ok(History { file, columns })
    }

    /// How many columns it has.
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// Appends a row.
    ///
    /// # Errors
    /// [`Error::Io`] if it cannot be written, or has another length than the header.
    pub fn row(&mut self, values: &[f64]) -> Result<(), Error> {
        check_length(self.file.path(), values.len(), self.columns)?;
        self.file.add(&line(values))
    }
}

/// A table in memory, column by column.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Table {
    /// Names of the columns.
    pub names: Vec<String>,
    /// The columns, all of one length.
    pub columns: Vec<Vec<f64>>,
}

impl Table {
    /// The column of this name.
    pub fn column(&self, name: &str) -> Option<&[f64]> {
        let i = self.names.iter().position(|n| n == name)?;
        self.columns.get(i).map(Vec::as_slice)
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.columns.first().map_or(0, Vec::len)
    }
}

/// Writes a whole table.
///
/// # Errors
/// [`Error::Io`] if it cannot be written, or a column is missing or of another length than the first.
pub fn write(path: &Path, table: &Table) -> Result<(), Error> {
    check_length(path, table.columns.len(), table.names.len())?;
    for column in &table.columns {
        check_length(path, column.len(), table.rows())?;
    }
    let mut text = header(&table.names);
    for row in 0..table.rows() {
        let values: Vec<f64> = table.columns.iter().map(|column| column[row]).collect();
        text += &line(&values);
    }
    write_atomically(path, text.as_bytes())
}

/// Reads a table. Entries that are no numbers become NaN; lines beginning with `#` are comments.
///
/// # Errors
/// [`Error::Io`] if it cannot be read, is empty, or a row has another number of entries than the header.
pub fn read(path: &Path) -> Result<Table, Error> {
    let text = super::input::read_text(path).map_err(|e| Error::io(path, e))?;
    let mut lines = (1..)
        .zip(text.lines())
        .filter(|(_, line)| !line.trim().is_empty() && !line.starts_with('#'));
    let Some((_, first)) = lines.next() else {
        return Err(malformed(path, "the table is empty".into()));
    };
    let names = split(first);
    let mut columns = vec![Vec::new(); names.len()];
    for (number, line) in lines {
        let entries = split(line);
        if entries.len() != names.len() {
            let (found, wanted) = (entries.len(), names.len());
            let message = format!("line {number} has {found} entries, the header has {wanted}");
            return Err(malformed(path, message));
        }
        for (column, entry) in columns.iter_mut().zip(&entries) {
            column.push(entry.trim().parse().unwrap_or(f64::NAN));
        }
    }
    Ok(Table { names, columns })
}

fn malformed(path: &Path, message: String) -> Error {
    Error::Io(IoError {
        file: path.to_path_buf(),
        message,
    })
}

fn check_length(path: &Path, found: usize, wanted: usize) -> Result<(), Error> {
    if found == wanted {
        return Ok(());
    }
    Err(malformed(
        path,
        format!("{found} values do not fit into {wanted} places of the table"),
    ))
}

fn header(names: &[String]) -> String {
    let quoted: Vec<String> = names.iter().map(|name| quote(name)).collect();
    quoted.join(",") + "\n"
}

fn quote(name: &str) -> String {
    if name.contains([',', '"', '\n', '#']) {
        format!("\"{}\"", name.replace('"', "\"\"").replace('\n', " "))
    } else {
        name.to_string()
    }
}

fn line(values: &[f64]) -> String {
    let numbers: Vec<String> = values.iter().map(|&v| number(v)).collect();
    numbers.join(",") + "\n"
}

/// Whole numbers as such, so that node numbers and counts read well.
fn number(value: f64) -> String {
    if value.fract() == 0.0 && value.abs() < 1e15 {
        format!("{value}")
    } else {
        format!("{value:e}")
    }
}

/// The entries of a line; a quote within quotes is doubled.
pub fn split(line: &str) -> Vec<String> {
    let mut entries = vec![String::new()];
    let mut quoted = false;
    let mut letters = line.trim_end_matches('\r').chars().peekable();
    while let Some(letter) = letters.next() {
        let entry = entries.len() - 1;
        match letter {
            '"' if quoted && letters.peek() == Some(&'"') => {
                letters.next();
                entries[entry].push('"');
            }
            '"' => quoted = !quoted,
            ',' if !quoted => entries.push(String::new()),
            _ => entries[entry].push(letter),
        }
    }
    entries
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use super::*;

    fn temporary(name: &str) -> PathBuf {
        std::env::temp_dir().join(format!("stickslip-{}-{name}", std::process::id()))
    }

    #[test]
    fn every_row_is_on_disk_and_reads_back_to_the_bit() {
        let path = temporary("history.csv");
        let names = ["time".to_string(), "a, \"b\"".to_string()];
        let mut history = History::create(&path, &names).unwrap();
        let values = [0.1 + 0.2, -1.0 / 3.0, 5e-324, 1e300, 17.0, -0.0, f64::MAX];
        for (i, &value) in values.iter().enumerate() {
            history.row(&[i as f64, value]).unwrap();
            let table = read(&path).unwrap();
            assert_eq!(table.names, names);
            assert_eq!(table.rows(), i + 1);
            assert_eq!(table.columns[1][i].to_bits(), value.to_bits());
        }
        history.row(&[7.0, f64::NAN]).unwrap();
        assert!(read(&path).unwrap().column("a, \"b\"").unwrap()[7].is_nan());
        assert!(history.row(&[1.0]).is_err());
        std::fs::remove_file(path).unwrap();
    }

    #[test]
    fn tables_survive() {
        let path = temporary("table.csv");
        let table = Table {
            names: vec!["node".into(), "CPRESS".into()],
            columns: vec![vec![1.0, 200.0], vec![1.5e6, f64::INFINITY]],
        };
        write(&path, &table).unwrap();
        assert_eq!(
            std::fs::read_to_string(&path).unwrap(),
            "node,CPRESS\n1,1500000\n200,inf\n"
        );
        assert_eq!(read(&path).unwrap(), table);
        std::fs::write(&path, "# a source\na,b\r\n1,x\r\n\n2\n").unwrap();
        assert!(
            read(&path)
                .unwrap_err()
                .to_string()
                .contains("line 5 has 1")
        );
        std::fs::write(&path, "").unwrap();
        assert!(read(&path).is_err());
        std::fs::remove_file(&path).unwrap();
        assert!(read(&path).is_err());
    }
}

//! Tables of numbers with one line of heads.

use std::path::Path;

/// A table, column by column.
#[derive(Debug, Clone, Default)]
pub struct Table {
    /// Heads and their columns.
    pub columns: Vec<(String, Vec<f64>)>,
}

impl Table {
    /// The column under a head.
    pub fn column(&self, head: &str) -> Option<&[f64]> {
        let found = self.columns.iter().find(|(name, _)| name == head);
        found.map(|(_, values)| values.as_slice())
    }

    /// A number of a column, zero where there is no such column.
    pub fn at(&self, head: &str, row: usize) -> f64 {
        let column = self.column(head).unwrap_or(&[]);
        column.get(row).copied().unwrap_or(0.0)
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.columns.first().map_or(0, |(_, values)| values.len())
    }
}

/// Reads a file; what is no number becomes NaN.
pub fn read(path: &Path) -> Result<Table, String> {
    let text = std::fs::read_to_string(path).map_err(|e| format!("{}: {e}", path.display()))?;
    let mut lines = text.lines();
    let heads = lines.next().unwrap_or_default().split(',');
    let mut columns: Vec<(String, Vec<f64>)> =
        heads.map(|h| (h.trim().to_string(), Vec::new())).collect();
    for line in lines.filter(|l| !l.trim().is_empty()) {
        for ((_, column), cell) in columns.iter_mut().zip(line.split(',')) {
            column.push(cell.trim().parse().unwrap_or(f64::NAN));
        }
    }
    Ok(Table { columns })
}

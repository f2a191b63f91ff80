//! The history, packed for the plots.

use serde_json::{Value, json};
use stickslip::io::csv::Table;

use super::model::Packed;
use crate::pack;

/// Packs the rows of a history, thinned out to at most `limit`.
pub fn pack(table: &Table, limit: usize, notes: &mut Vec<String>) -> Packed {
    let rows = table.rows();
    if rows == 0 || table.names.is_empty() {
        return Packed {
            meta: Value::Null,
            blobs: Vec::new(),
        };
    }
    let kept = pack::spread(rows, limit.max(2));
    if kept.len() < rows {
        notes.push(format!(
            "plots have {} of the {rows} rows of history.csv, at even distances: a peak between them is not seen",
            kept.len()
        ));
    }
    let values = table
        .columns
        .iter()
        .flat_map(|column| kept.iter().map(|&row| column[row]));
    Packed {
        meta: json!({"names": table.names, "rows": kept.len()}),
        blobs: vec![("history".to_string(), pack::doubles(values))],
    }
}

//! Events of fast slip, found in the rows of the history.

use std::path::Path;

use super::history::{FARTHEST, FASTEST, POTENCY};
use crate::error::Error;
use crate::io::csv::{self, Table};
use crate::model::definition::EventPlan;

/// Writes the table of events of each interface whose law keeps its speed.
pub(super) fn write(
    directory: &Path,
    interfaces: impl Iterator<Item = String>,
    plan: EventPlan,
) -> Result<(), Error> {
    let history = csv::read(&directory.join("history.csv"))?;
    for name in interfaces {
        if let Some(table) = events(&history, &name, plan) {
            csv::write(
                &directory.join(format!("interfaces/{name}-events.csv")),
                &table,
            )?;
        }
    }
    Ok(())
}

/// Events of an interface: onset and end, by the logarithm of speed between rows; the peak; how far the point that slid farthest has got by the end; by how much slip integrated over the surface
/// has grown, and the moment of that. An event that is not over ends with the last row.
fn events(history: &Table, name: &str, plan: EventPlan) -> Option<Table> {
    let column = |part: &str| history.column(&format!("{name}.{part}"));
    let time = history.column("TIME")?;
    let [speed, slip, potency] = [column(FASTEST)?, column(FARTHEST)?, column(POTENCY)?];
    let mut names = vec!["onset", "end", "peak-time", "peak-speed", "slip", "potency"];
    names.extend(plan.modulus.map(|_| "moment"));
    let mut table = Table {
        names: names.into_iter().map(String::from).collect(),
        ..Table::default()
    };
    table.columns = vec![Vec::new(); table.names.len()];
    let fast = |i: usize| speed[i] > plan.speed;
    let mut i = 0;
    while i < speed.len() {
        if !fast(i) {
            i += 1;
            continue;
        }
        let first = i;
        while i < speed.len() && fast(i) {
            i += 1;
        }
        let before = first.saturating_sub(1);
        let after = i.min(speed.len() - 1);
        let crossing = |a: usize, b: usize| {
            let part = (plan.speed / speed[a]).ln() / (speed[b] / speed[a]).ln();
            match part.is_finite() {
                true => time[a] + part.clamp(0.0, 1.0) * (time[b] - time[a]),
                false => time[b],
            }
        };
        let peak = (first..i).max_by(|&a, &b| speed[a].total_cmp(&speed[b]))?;
        let released = potency[after] - potency[before];
        let mut row = vec![
            crossing(before, first),
            crossing(i - 1, after),
            time[peak],
            speed[peak],
            slip[after],
            released,
        ];
        row.extend(plan.modulus.map(|modulus| modulus * released));
        for (column, value) in table.columns.iter_mut().zip(row) {
            column.push(value);
        }
    }
    Some(table)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn events_begin_and_end_between_rows() {
        let names = ["TIME", "f.VMAX", "f.SLIPMAX", "f.POTENCY"];
        let history = Table {
            names: names.map(String::from).to_vec(),
            columns: vec![
                vec![0.0, 1.0, 2.0, 3.0, 4.0, 5.0],
                vec![1e-6, 1e-4, 1e-2, 1.0, 1e-4, 1e-2],
                vec![0.0, 0.1, 0.2, 1.5, 1.6, 1.7],
                vec![0.0, 1.0, 2.0, 20.0, 21.0, 23.0],
            ],
        };
        let plan = EventPlan {
            speed: 1e-3,
            modulus: Some(10.0),
        };
        let table = events(&history, "f", plan).expect("columns of sliding");
        let of = |name: &str| table.column(name).expect("a column").to_vec();
        assert_eq!(of("peak-time"), [3.0, 5.0]);
        assert_eq!(of("peak-speed"), [1.0, 1e-2]);
        assert_eq!(of("slip"), [1.6, 1.7]);
        assert_eq!(of("potency"), [20.0, 2.0]);
        assert_eq!(of("moment"), [200.0, 20.0]);
        for (found, due) in of("onset")
            .iter()
            .chain(&of("end"))
            .zip([1.5, 4.5, 3.75, 5.0])
        {
            assert!((found - due).abs() < 1e-12, "{found} {due}");
        }
        assert!(events(&history, "other", plan).is_none());
    }
}

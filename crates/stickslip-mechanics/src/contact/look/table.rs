//! The table of the contact points.

use super::values::{MEANS, PointValues, values};
use crate::contact::interface::view::ContactView;
use crate::math::{Vec3, add, sub};

/// A point as the table shows it.
struct Row {
    /// Number of its node; NaN of a place within a face.
    node: f64,
    /// Where it lies in the reference configuration, and by how much it has moved.
    x: Vec3,
    moved: Vec3,
    values: PointValues,
    dissipated: f64,
    worn: f64,
}

/// A column: its name, and its value of a row.
type Column = (&'static str, fn(&Row) -> f64);

/// Columns before those that are shown as fields too.
const FIRST_COLUMNS: [Column; 4] = [
    ("node", |r| r.node),
    ("x", |r| r.x[0]),
    ("y", |r| r.x[1]),
    ("z", |r| r.x[2]),
];

/// And behind them.
const LAST: [Column; 9] = [
    ("CSTATUS", |r| r.values.status),
    ("CNORMF", |r| r.values.pressure * r.values.area),
    ("CSHEARF1", |r| r.values.shear[0] * r.values.area),
    ("CSHEARF2", |r| r.values.shear[1] * r.values.area),
    ("U1", |r| r.moved[0]),
    ("U2", |r| r.moved[1]),
    ("U3", |r| r.moved[2]),
    ("CDISS", |r| r.dissipated),
    ("CWEAR", |r| r.worn),
];

/// The table of the contact points: names of columns and the columns, one entry a point, for `interfaces/<name>.csv`.
pub fn table(contact: ContactView, u: &[f64]) -> (Vec<String>, Vec<Vec<f64>>) {
    let rows = rows(contact, u);
    let column = |(name, value): Column| {
        let values: Vec<f64> = rows.iter().map(value).collect();
        (name.to_string(), values)
    };
    let means = MEANS.into_iter().map(|(name, value)| {
        let values: Vec<f64> = rows.iter().map(|r| value(&r.values)).collect();
        (name.to_string(), values)
    });
    let first = FIRST_COLUMNS.into_iter().map(column);
    first
        .chain(means)
        .chain(LAST.into_iter().map(column))
        .chain(law_states(contact))
        .unzip()
}

/// The state variables of the friction law, by name with one entry a point.
pub(super) fn law_states(contact: ContactView) -> impl Iterator<Item = (String, Vec<f64>)> {
    let states = contact.laws.friction_law().states().iter().enumerate();
    states.map(move |(k, variable)| {
        let points = 0..contact.points.len();
        let values = points.map(|i| contact.state.law_state(i)[k]);
        (variable.name.to_string(), values.collect())
    })
}

fn rows(contact: ContactView, u: &[f64]) -> Vec<Row> {
    let now = contact.coordinates(u);
    let points = contact.points.iter().zip(&contact.state.points);
    points
        .enumerate()
        .map(|(i, (p, h))| {
            let x = p.place(&contact.reference);
            Row {
                node: p.node().map_or(f64::NAN, |n| contact.node_ids[n] as f64),
                x: add(x, contact.origin),
                moved: sub(p.place(&now), x),
                values: values(contact, i),
                dissipated: h.dissipated,
                worn: contact.state.worn.own_depth(i),
            }
        })
        .collect()
}

/// Gaps of all points at the last accepted state; NaN or infinite where there is nothing opposite.
pub fn initial_gaps(contact: ContactView) -> Vec<f64> {
    contact.state.points.iter().map(|h| h.gap).collect()
}

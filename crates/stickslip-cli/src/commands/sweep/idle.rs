//! Axes of a sweep that change nothing: all runs that differ in such a value alone have the same results.

use std::collections::BTreeMap;

use super::done::Row;

/// Positions of the axes that change nothing, as far as the runs that went to their end show.
pub fn idle(axes: usize, rows: &[Row]) -> Vec<usize> {
    let all: Vec<&Row> = rows.iter().filter(|row| !row.last.is_empty()).collect();
    let idle = |axis: &usize| {
        let mut groups: BTreeMap<Vec<&str>, Vec<&Row>> = BTreeMap::new();
        for row in &all {
            let mut others: Vec<&str> = row.values.iter().map(String::as_str).collect();
            others.remove(*axis);
            groups.entry(others).or_default().push(row);
        }
        let mut compared = groups.values().filter(|g| g.len() > 1).peekable();
        let some = compared.peek().is_some();
        let same = |group: &Vec<&Row>| group.iter().all(|row| alike(row, group[0]));
        some && compared.all(same)
    };
    (0..axes).filter(idle).collect()
}

/// Whether two runs have the same numbers in all columns; a number that is none is like another one.
fn alike(a: &Row, b: &Row) -> bool {
    let same = |(x, y): ((&String, &f64), (&String, &f64))| {
        x.0 == y.0 && (x.1 == y.1 || x.1.is_nan() && y.1.is_nan())
    };
    a.last.len() == b.last.len() && a.last.iter().zip(&b.last).all(same)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(values: [&str; 2], force: f64) -> Row {
        Row {
            values: values.map(str::to_string).to_vec(),
            last: [("base.CFN2".to_string(), force)].into(),
            ..Row::default()
        }
    }

    #[test]
    fn an_axis_that_changes_nothing_is_told_from_one_that_does() {
        let rows = [
            row(["0.1", "1"], 5.0),
            row(["0.1", "2"], 7.0),
            row(["0.2", "1"], 5.0),
            row(["0.2", "2"], 7.0),
        ];
        assert_eq!(idle(2, &rows), [0]);
        // One run says nothing, and one that failed neither.
        assert!(idle(2, &rows[..1]).is_empty());
        let mut failed = rows.to_vec();
        failed.iter_mut().for_each(|row| row.last.clear());
        assert!(idle(2, &failed).is_empty());
        let mut one = rows.to_vec();
        one[2] = row(["0.2", "1"], 5.1);
        assert!(idle(2, &one).is_empty());
    }
}

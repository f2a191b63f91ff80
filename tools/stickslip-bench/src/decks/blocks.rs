//! What `.dat` files hold, and how two of them differ.

use std::collections::BTreeMap;

/// The rows of one title over time.
type Series = BTreeMap<String, Vec<(f64, Vec<Vec<f64>>)>>;

/// How the numbers of a reference are met.
#[derive(Debug, Clone, Default)]
pub struct Comparison {
    /// By quantity: how many numbers were compared, and the worst difference relative to the largest number of its kind in its block.
    pub quantities: BTreeMap<String, (usize, f64)>,
    /// Rows of the reference that have no counterpart.
    pub missing: usize,
}

impl Comparison {
    /// The worst of all.
    pub fn worst(&self) -> f64 {
        self.quantities.values().fold(0.0, |m, q| m.max(q.1))
    }

    /// How many numbers were compared.
    pub fn count(&self) -> usize {
        self.quantities.values().map(|q| q.0).sum()
    }
}

/// Titles begin with a small letter; whether node or face is meant differs between ways to print, so that what is in brackets is left out.
fn read(text: &str) -> Series {
    let mut out = Series::new();
    let (mut title, mut time) = (String::new(), 0.0);
    for line in text.lines() {
        if line
            .trim_start()
            .starts_with(|c: char| c.is_ascii_lowercase())
        {
            let (head, tail) = match line.split_once(" time") {
                Some((head, tail)) => (head, tail.trim().parse().unwrap_or(0.0)),
                None => (line, time),
            };
            time = tail;
            let name = head.split('(').next().unwrap_or_default();
            let name = name.split(" for ").next().unwrap_or_default().trim();
            let name = name.trim_end_matches(" for");
            let set = head.split_once(" for set ").map_or("", |s| s.1);
            let set = set.split_whitespace().next().unwrap_or_default();
            title = format!("{name} {set}").trim().to_string();
            let series = out.entry(title.clone()).or_default();
            series.push((time, Vec::new()));
            continue;
        }
        let row: Result<Vec<f64>, _> = line.split_whitespace().map(str::parse).collect();
        let block = out.get_mut(&title).and_then(|s| s.last_mut());
        if let (Ok(row), Some(block)) = (row, block)
            && !row.is_empty()
        {
            block.1.push(row);
        }
    }
    out
}

/// Columns that name the row.
fn keys(title: &str) -> usize {
    let starts = |words: &[&str]| words.iter().any(|w| title.starts_with(w));
    if starts(&["stresses", "strains", "contact spring"]) {
        2
    } else if starts(&["total", "statistics", "center", "moment", "area"]) {
        0
    } else {
        1
    }
}

/// Columns that are of one kind.
fn kind(title: &str, column: usize) -> usize {
    match title {
        t if t.starts_with("total surface force") || t.starts_with("center") => column / 3,
        t if t.starts_with("area") => usize::from(column > 0),
        _ => 0,
    }
}

/// The rows at a time, between two blocks where there is none.
fn at(series: &[(f64, Vec<Vec<f64>>)], time: f64, keys: usize) -> Option<Vec<Vec<f64>>> {
    let near = |b: &&(f64, Vec<Vec<f64>>)| (b.0 - time).abs() <= 1e-6 * time.abs();
    if let Some(block) = series.iter().find(near) {
        return Some(block.1.clone());
    }
    let after = series.iter().position(|b| b.0 > time)?;
    let (a, b) = (series.get(after.checked_sub(1)?)?, &series[after]);
    let s = (time - a.0) / (b.0 - a.0);
    let rows = a.1.iter().zip(&b.1).map(|(a, b)| {
        let mix = |(i, (x, y)): (usize, (&f64, &f64))| if i < keys { *x } else { x + s * (y - x) };
        a.iter().zip(b).enumerate().map(mix).collect()
    });
    Some(rows.collect())
}

/// Compares every number of the reference.
pub fn compare(ours: &str, reference: &str) -> Comparison {
    let (mut ours, mut reference) = (read(ours), read(reference));
    // Contact elements are not the same: their sum is.
    for (series, of) in [
        (&mut reference, "contact spring energy"),
        (&mut ours, "total contact spring energy"),
    ] {
        if let Some(all) = series.remove(of) {
            let sums = all
                .iter()
                .map(|(t, rows)| (*t, vec![vec![rows.iter().filter_map(|r| r.last()).sum()]]));
            series.insert("total contact spring energy".into(), sums.collect());
        }
    }
    let mut out = Comparison::default();
    for (title, blocks) in &reference {
        let keys = keys(title);
        // What is nothing but rounding all the time says nothing.
        let largest = |rows: &[Vec<f64>], k: usize| {
            let all = rows
                .iter()
                .flat_map(|r| r[keys.min(r.len())..].iter().enumerate());
            all.filter(|(c, _)| kind(title, *c) == k)
                .fold(0.0_f64, |m, (_, v)| m.max(v.abs()))
        };
        let overall = [0, 1].map(|k| blocks.iter().fold(0.0_f64, |m, b| m.max(largest(&b.1, k))));
        // The history of a single point is one block.
        let history = blocks.len() > 10 && blocks.iter().all(|b| b.1.len() == 1);
        let own = ours.get(title).map(Vec::as_slice).unwrap_or_default();
        let quantity = title
            .split_whitespace()
            .take(2)
            .collect::<Vec<_>>()
            .join(" ");
        let entry = out.quantities.entry(quantity).or_default();
        for (time, rows) in blocks {
            let Some(found) = at(own, *time, keys) else {
                out.missing += rows.len();
                continue;
            };
            for (i, row) in rows.iter().enumerate() {
                let head = &row[..keys.min(row.len())];
                let same = match keys {
                    0 => found.get(i),
                    _ => found.iter().find(|r| r.starts_with(head)),
                };
                let Some(same) = same else {
                    out.missing += 1;
                    continue;
                };
                for (c, (a, b)) in row.iter().zip(same).enumerate().skip(keys) {
                    let k = kind(title, c - keys);
                    let scale = match history {
                        true => overall[k],
                        false => largest(rows, k).max(1e-6 * overall[k]),
                    };
                    entry.0 += 1;
                    if scale > 1e-12 {
                        entry.1 = entry.1.max((a - b).abs() / scale);
                    }
                }
            }
        }
    }
    out
}

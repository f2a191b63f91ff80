//! How far the results of two runs are apart: histories, fields, and tables of interfaces.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt;
use std::path::Path;

use crate::error::{Error, IoError};
use crate::io::csv::{self, Table};
use crate::io::{pvd, vtu};
use crate::math::{Vec3, distance, norm, sub};
use crate::number::{digits, figure};
use crate::tolerance::{NEGLIGIBLE, SAME};

/// What two folders of results have in common, and where they are farthest apart.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Differences {
    /// By quantity, the largest relative difference first.
    pub quantities: Vec<Difference>,
    /// What could not be compared: what only one of the two has, and meshes that are not the same.
    pub uncompared: Vec<String>,
    /// What is to be known of the comparison.
    pub notes: Vec<String>,
}

/// A quantity where the two differ most.
#[derive(Debug, Clone, PartialEq)]
pub struct Difference {
    /// `history base.CPRESSMAX`, `fields U`, `interfaces/base.csv CPRESS`.
    pub quantity: String,
    /// The largest difference, in the unit of the quantity; of vectors its length.
    pub largest: f64,
    /// The largest value of either, of all components: what the difference is relative to.
    pub scale: f64,
    /// Where and when.
    pub place: String,
}

impl Difference {
    /// The difference over the largest value; infinite where one of the two has no value.
    pub fn relative(&self) -> f64 {
        match self.largest {
            0.0 => 0.0,
            d => d / self.scale,
        }
    }
}

/// Columns that tell how a row was found, not what it is.
const OF_THE_SOLVER: [&str; 7] = [
    "STEP",
    "INC",
    "ATT",
    "ITRS",
    "DT",
    "AUGMENTATIONS",
    "RESIDUAL",
];

/// Compares two folders of results, each written by a run.
///
/// Histories are compared at the rows of `a`, with what `b` has there, linear between its rows; fields at the times that both have, on meshes with the same
/// points; tables of interfaces row by row. Differences are relative to the largest value of either in the whole history or field; components of a
/// vector or tensor have one such value, and all energies one. It is at least 1e-9 of that of the same quantity anywhere.
///
/// # Errors
/// [`Error::Io`] if one of them is no folder with a history, or one of the files is damaged.
pub fn differences(a: &Path, b: &Path) -> Result<Differences, Error> {
    for folder in [a, b] {
        if !folder.join("history.csv").is_file() {
            return Err(Error::Io(IoError {
                file: folder.to_path_buf(),
                message:
                    "there is no history.csv here: name the folders that two runs have written"
                        .into(),
            }));
        }
    }
    let mut out = Differences::default();
    let tables =
        |name: &str| Ok::<_, Error>([csv::read(&a.join(name))?, csv::read(&b.join(name))?]);
    history(&tables("history.csv")?, &mut out);
    fields(a, b, &mut out)?;
    let both = interfaces(a, b, &mut out.uncompared);
    for name in both {
        table(&name, &tables(&name)?, &mut out);
    }
    out.quantities
        .sort_by(|x, y| y.relative().total_cmp(&x.relative()));
    Ok(out)
}

/// What a component belongs to: `base.CFN` of `base.CFN2`, `ALL` of all energies.
fn family(column: &str) -> &str {
    let (owner, name) = column.rsplit_once('.').unwrap_or(("", column));
    match name {
        _ if owner.is_empty() && (name.starts_with("ALL") || name.starts_with('E')) => "ALL",
        _ => column.trim_end_matches(|c: char| c.is_ascii_digit()),
    }
}

/// Notes names that only one of the two has.
fn alone<'n>(what: &str, names: [BTreeSet<&'n str>; 2], notes: &mut Vec<String>) -> Vec<&'n str> {
    for (k, which) in ["first", "second"].into_iter().enumerate() {
        let only: Vec<&str> = names[k].difference(&names[1 - k]).copied().collect();
        if !only.is_empty() {
            notes.push(format!("{what}: only the {which} has {}", only.join(", ")));
        }
    }
    names[0].intersection(&names[1]).copied().collect()
}

/// The largest difference that has been met, and the largest values by family.
#[derive(Default)]
struct Largest {
    found: BTreeMap<String, (f64, String)>,
    scales: BTreeMap<String, f64>,
}

impl Largest {
    /// Notes a difference of two values of a quantity.
    fn see(&mut self, name: &str, [x, y]: [f64; 2], place: impl FnOnce() -> String) {
        let apart = match (x.is_nan(), y.is_nan()) {
            (true, true) => 0.0,
            (false, false) => (x - y).abs(),
            _ => f64::INFINITY,
        };
        self.note(name, apart, [x.abs(), y.abs()], place);
    }

    fn note(&mut self, name: &str, apart: f64, sizes: [f64; 2], place: impl FnOnce() -> String) {
        let scale = self.scales.entry(family(name).to_string()).or_default();
        *scale = scale.max(sizes[0]).max(sizes[1]);
        let known = self
            .found
            .entry(name.to_string())
            .or_insert((0.0, String::new()));
        if apart > known.0 {
            *known = (apart, place());
        }
    }

    fn finish(self, prefix: &str, out: &mut Differences) {
        let kind = |family: &str| family.rsplit('.').next().unwrap_or(family).to_string();
        let mut kinds: BTreeMap<String, f64> = BTreeMap::new();
        for (family, scale) in &self.scales {
            let most = kinds.entry(kind(family)).or_default();
            *most = most.max(*scale);
        }
        for (name, (largest, place)) in self.found {
            let family = family(&name);
            // Below this part of the largest value of its kind in any part of the model a quantity is rounding: a reaction that is zero has
            // no digits to compare.
            let least = SAME * kinds[&kind(family)];
            out.quantities.push(Difference {
                scale: self.scales[family].max(least),
                quantity: format!("{prefix} {name}"),
                largest,
                place,
            });
        }
    }
}

/// The value of a column at a time, linear between rows; the last of rows with the same time. `None` outside.
fn at(times: &[f64], values: &[f64], t: f64, same: f64) -> Option<f64> {
    let after = times.partition_point(|&x| x <= t + same);
    let before = after.checked_sub(1)?;
    if (times[before] - t).abs() <= same {
        return values.get(before).copied();
    }
    let (t0, t1) = (times[before], *times.get(after)?);
    let s = (t - t0) / (t1 - t0);
    Some((1.0 - s) * values[before] + s * values[after])
}

fn history(tables: &[Table; 2], out: &mut Differences) {
    let names = tables.each_ref().map(|t| {
        let names = t.names.iter().map(String::as_str);
        names
            .filter(|n| !OF_THE_SOLVER.contains(n) && *n != "TIME")
            .collect()
    });
    let common = alone("history", names, &mut out.uncompared);
    let times = tables.each_ref().map(|t| t.column("TIME").unwrap_or(&[]));
    let last = times
        .iter()
        .filter_map(|t| t.last())
        .fold(0.0_f64, |m, t| m.max(t.abs()));
    let same = SAME * last;
    let met = |t: &&f64| times[1].iter().any(|other| (*other - **t).abs() <= same);
    let shared = times[0].iter().filter(met).count();
    if shared != times[0].len() || shared != times[1].len() {
        out.notes.push(format!(
            "history: {} and {} rows, {shared} at the same times; the second is taken as linear between its rows",
            times[0].len(),
            times[1].len()
        ));
    }
    let mut largest = Largest::default();
    for name in common {
        let columns = tables.each_ref().map(|t| t.column(name).unwrap_or(&[]));
        for (&t, &x) in times[0].iter().zip(columns[0]) {
            if let Some(y) = at(times[1], columns[1], t, same) {
                largest.see(name, [x, y], || format!("time {t:.6}"));
            }
        }
    }
    largest.finish("history", out);
}

/// Fields at the times that both have.
fn fields(a: &Path, b: &Path, out: &mut Differences) -> Result<(), Error> {
    let list = |folder: &Path| match folder.join("fields.pvd") {
        file if file.is_file() => pvd::read(&file),
        _ => Ok(Vec::new()),
    };
    let (mine, theirs) = (list(a)?, list(b)?);
    let last = mine
        .iter()
        .chain(&theirs)
        .fold(0.0_f64, |m, (t, _)| m.max(t.abs()));
    let mut largest = Largest::default();
    let mut compared = 0;
    for (t, file) in &mine {
        let Some((_, other)) = theirs.iter().rfind(|(o, _)| (o - t).abs() <= SAME * last) else {
            continue;
        };
        let grids = [vtu::read(&a.join(file))?, vtu::read(&b.join(other))?];
        let points = grids.each_ref().map(|g| g.points.as_slice());
        if let Some(why) = unlike(points) {
            out.uncompared.push(format!("fields: {why}"));
            return Ok(());
        }
        compared += 1;
        let names = grids
            .each_ref()
            .map(|g| g.arrays.keys().map(String::as_str).collect());
        let mut notes = Vec::new();
        for name in alone("fields", names, &mut notes) {
            let arrays = grids.each_ref().map(|g| &g.arrays[name]);
            if arrays[0].components != arrays[1].components {
                notes.push(format!("fields: {name} has not as many components in both"));
                continue;
            }
            let of = |k: usize| arrays[k].values.chunks(arrays[k].components.max(1));
            for (i, (x, y)) in of(0).zip(of(1)).enumerate() {
                let (apart, sizes) = lengths(x, y);
                let at = || format!("time {t:.6}, {}", place(points[0][i]));
                largest.note(name, apart, sizes, at);
            }
        }
        for note in notes {
            if !out.uncompared.contains(&note) {
                out.uncompared.push(note);
            }
        }
    }
    if compared < mine.len().max(theirs.len()) {
        let list = match compared {
            0 => &mut out.uncompared,
            _ => &mut out.notes,
        };
        list.push(format!(
            "fields: at {compared} times of {} and {}, those that both have",
            mine.len(),
            theirs.len()
        ));
    }
    largest.finish("fields", out);
    Ok(())
}

/// Length of the difference of two vectors, and their own. What both leave open does not count; what one does is infinitely far.
fn lengths(x: &[f64], y: &[f64]) -> (f64, [f64; 2]) {
    let length = |values: &mut dyn Iterator<Item = f64>| values.map(|v| v * v).sum::<f64>().sqrt();
    let open = |v: &[f64]| v.iter().any(|v| v.is_nan());
    match (open(x), open(y)) {
        (true, true) => (0.0, [0.0; 2]),
        (false, false) => (
            length(&mut x.iter().zip(y).map(|(x, y)| x - y)),
            [
                length(&mut x.iter().copied()),
                length(&mut y.iter().copied()),
            ],
        ),
        _ => (f64::INFINITY, [0.0; 2]),
    }
}

/// Why points of two meshes are not the same; `None` if they are.
fn unlike([a, b]: [&[Vec3]; 2]) -> Option<String> {
    if a.len() != b.len() {
        return Some(format!(
            "the meshes have {} and {} points",
            a.len(),
            b.len()
        ));
    }
    let size = a.iter().map(|x| distance(*x, a[0])).fold(0.0, f64::max);
    let moved = a
        .iter()
        .zip(b)
        .map(|(x, y)| norm(sub(*x, *y)))
        .fold(0.0, f64::max);
    // Places are written with fewer digits.
    (moved > NEGLIGIBLE * size).then(|| {
        format!(
            "points of the meshes lie up to {moved} apart",
            moved = figure(moved)
        )
    })
}

fn place(x: Vec3) -> String {
    format!("at ({:.4}, {:.4}, {:.4})", x[0], x[1], x[2])
}

/// The tables of interfaces that both have.
fn interfaces(a: &Path, b: &Path, notes: &mut Vec<String>) -> Vec<String> {
    let list = |folder: &Path| -> BTreeSet<String> {
        let entries = std::fs::read_dir(folder.join("interfaces"));
        let names = entries.into_iter().flatten().flatten();
        let names = names.map(|e| e.file_name().to_string_lossy().into_owned());
        names.filter(|n| n.ends_with(".csv")).collect()
    };
    let names = [list(a), list(b)];
    let both = names
        .each_ref()
        .map(|n| n.iter().map(String::as_str).collect());
    let common = alone("interfaces", both, notes);
    common.iter().map(|n| format!("interfaces/{n}")).collect()
}

/// A table of points, whose rows are those of the same points.
fn table(name: &str, tables: &[Table; 2], out: &mut Differences) {
    let coordinates = |t: &Table| -> Vec<Vec3> {
        let columns = ["x", "y", "z"].map(|c| t.column(c).unwrap_or(&[]));
        let value = |c: usize, i: usize| columns[c].get(i).copied().unwrap_or(0.0);
        (0..t.rows())
            .map(|i| [0, 1, 2].map(|c| value(c, i)))
            .collect()
    };
    let points = tables.each_ref().map(coordinates);
    if let Some(why) = unlike([&points[0], &points[1]]) {
        out.uncompared.push(format!("{name}: {why}"));
        return;
    }
    let names = tables.each_ref().map(|t| {
        let names = t.names.iter().map(String::as_str);
        names
            .filter(|n| !["node", "x", "y", "z"].contains(n))
            .collect()
    });
    let mut largest = Largest::default();
    for column in alone(name, names, &mut out.uncompared) {
        let columns = tables.each_ref().map(|t| t.column(column).unwrap_or(&[]));
        for (i, (&x, &y)) in columns[0].iter().zip(columns[1]).enumerate() {
            largest.see(column, [x, y], || place(points[0][i]));
        }
    }
    largest.finish(name, out);
}

/// Lines of the longest list of quantities.
const MOST_QUANTITIES: usize = 40;

impl fmt::Display for Differences {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let differ: Vec<&Difference> = self.quantities.iter().filter(|d| d.largest > 0.0).collect();
        let equal = self.quantities.len() - differ.len();
        let shown = &differ[..differ.len().min(MOST_QUANTITIES)];
        let width = shown
            .iter()
            .map(|d| d.quantity.chars().count())
            .max()
            .unwrap_or(0);
        if !shown.is_empty() {
            writeln!(
                f,
                "{:width$}  relative   difference  of           where",
                "quantity"
            )?;
        }
        for d in shown {
            writeln!(
                f,
                "{:width$}  {:<9}  {:<10}  {:<11}  {}",
                d.quantity,
                digits(d.relative(), 3),
                figure(d.largest),
                figure(d.scale),
                d.place
            )?;
        }
        if differ.len() > shown.len() {
            writeln!(f, "{} more differ by less", differ.len() - shown.len())?;
        }
        for note in &self.notes {
            writeln!(f, "{note}")?;
        }
        for what in &self.uncompared {
            writeln!(f, "not compared: {what}")?;
        }
        write!(
            f,
            "{} quantities compared, {equal} equal to the last digit",
            self.quantities.len()
        )
    }
}

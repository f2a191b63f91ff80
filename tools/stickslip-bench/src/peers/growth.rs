//! How time and memory grow with the number of unknowns.

use std::fmt::Write;
use std::fs;

use super::bench::{Bench, example};
use super::plot::{self, Panel, Series};
use super::slide::cells;
use super::table::Table;

/// Methods and the cells an edge that each is tried with.
const METHODS: [(&str, &[usize]); 2] = [
    ("condensed", &[11, 14, 18, 23, 29, 36]),
    ("multigrid", &[18, 23, 29, 36, 45, 54]),
];

/// One run.
#[derive(Debug, Clone, PartialEq)]
struct Point {
    method: String,
    n: usize,
    dofs: f64,
    cpu: f64,
    megabytes: f64,
}

/// Runs `[METHOD] [N ...]`. What earlier calls measured is kept in `growth.csv` and enters the table, the exponents and the plot.
pub fn measure(bench: &Bench, words: &[String]) -> Result<(), String> {
    let (only, sizes) = match words.split_first() {
        Some((word, sizes)) if METHODS.iter().any(|(name, _)| name == word) => (Some(word), sizes),
        _ => (None, words),
    };
    let counts = sizes.iter().map(|s| s.parse().ok().filter(|n| *n >= 2));
    let counts: Option<Vec<usize>> = counts.collect();
    let counts =
        counts.ok_or("growth takes condensed or multigrid and cells an edge, 2 or more")?;
    let case = example("press-and-slide/case.toml")?;
    let folder = bench.folder("growth")?;
    let file = folder.join("growth.csv");
    let mut points = read(&fs::read_to_string(&file).unwrap_or_default());
    for (method, sizes) in METHODS {
        if only.is_some_and(|o| o != method) {
            continue;
        }
        if method == "multigrid" && !bench.has_method("multigrid")? {
            println!("this binary has no multigrid");
            continue;
        }
        let sizes = if counts.is_empty() { sizes } else { &counts };
        for &n in sizes {
            let mut settings = cells(n);
            settings.push(format!("solver.method=\"{method}\""));
            let run = bench.analyse(&case, &settings)?;
            let point = Point {
                method: method.into(),
                n,
                dofs: run.dofs(),
                cpu: run.run.cpu,
                megabytes: run.megabytes(),
            };
            points.retain(|p| p.method != method || p.n != n);
            points.push(point);
            points.sort_by(|a, b| (&a.method, a.n).cmp(&(&b.method, b.n)));
            fs::write(&file, write(&points)).map_err(|e| format!("{}: {e}", file.display()))?;
        }
    }
    let table = Table::new(
        "Growth: press-and-slide, stick, 15 increments, one thread",
        &["method", "N", "dofs", "CPU s", "peak MB"],
    );
    for p in &points {
        table.row([
            p.method.clone(),
            p.n.to_string(),
            p.dofs.to_string(),
            format!("{:.2}", p.cpu),
            format!("{:.0}", p.megabytes),
        ]);
    }
    println!();
    let mut panels = [
        Panel {
            title: "CPU time",
            unit: "s",
            series: Vec::new(),
        },
        Panel {
            title: "peak memory",
            unit: "MB",
            series: Vec::new(),
        },
    ];
    for (method, _) in METHODS {
        let of: Vec<&Point> = points.iter().filter(|p| p.method == method).collect();
        let values = |of_point: fn(&Point) -> f64| -> Vec<(f64, f64)> {
            of.iter().map(|p| (p.dofs, of_point(p))).collect()
        };
        let (cpu, memory) = (values(|p| p.cpu), values(|p| p.megabytes));
        if let (Some(a), Some(b)) = (exponent(&cpu), exponent(&memory)) {
            println!("- {method}: time grows like dofs^{a:.2}, memory like dofs^{b:.2}");
            for (panel, (points, power)) in panels.iter_mut().zip([(cpu, a), (memory, b)]) {
                panel.series.push(Series {
                    name: format!("{method}: dofs^{power:.2}"),
                    points,
                });
            }
        }
    }
    let picture = folder.join("growth.svg");
    fs::write(&picture, plot::svg("displacement dofs", &panels))
        .map_err(|e| format!("{}: {e}", picture.display()))?;
    println!("- plot: {}", picture.display());
    Ok(())
}

/// The slope of the straight line that fits the logarithms best; `None` from fewer than two different abscissae.
fn exponent(points: &[(f64, f64)]) -> Option<f64> {
    let count = points.len() as f64;
    let logs = points.iter().map(|(x, y)| (x.ln(), y.ln()));
    let (x, y) = logs.clone().fold((0.0, 0.0), |s, p| (s.0 + p.0, s.1 + p.1));
    let (x, y) = (x / count, y / count);
    let (over, under) = logs.fold((0.0, 0.0), |s, p| {
        (s.0 + (p.0 - x) * (p.1 - y), s.1 + (p.0 - x).powi(2))
    });
    (under > 0.0).then(|| over / under)
}

fn write(points: &[Point]) -> String {
    let mut out = String::from("method,n,dofs,cpu,megabytes\n");
    for p in points {
        // writing to a string cannot fail
        let _ = writeln!(
            out,
            "{},{},{},{},{}",
            p.method, p.n, p.dofs, p.cpu, p.megabytes
        );
    }
    out
}

/// Lines that make no sense are left out.
fn read(text: &str) -> Vec<Point> {
    let point = |line: &str| {
        let cells: Vec<&str> = line.split(',').collect();
        let [method, n, dofs, cpu, megabytes] = cells[..] else {
            return None;
        };
        Some(Point {
            method: method.into(),
            n: n.parse().ok()?,
            dofs: dofs.parse().ok()?,
            cpu: cpu.parse().ok()?,
            megabytes: megabytes.parse().ok()?,
        })
    };
    text.lines().filter_map(point).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_power_law_has_its_exponent() {
        let points: Vec<(f64, f64)> = (1..5)
            .map(|k| k as f64)
            .map(|x| (x, 3.0 * x.powf(1.7)))
            .collect();
        assert!((exponent(&points).unwrap_or(0.0) - 1.7).abs() < 1e-12);
        assert_eq!(exponent(&points[..1]), None);
        assert_eq!(exponent(&[]), None);
    }

    #[test]
    fn what_is_written_is_read() {
        let points = vec![Point {
            method: "condensed".into(),
            n: 11,
            dofs: 9177.0,
            cpu: 0.5,
            megabytes: 70.25,
        }];
        assert_eq!(read(&write(&points)), points);
    }
}

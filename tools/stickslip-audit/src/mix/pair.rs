//! The second run of a relation, and whether it agrees with the first.

use std::fs;
use std::path::{Path, PathBuf};

use super::mixture::Mix;
use super::relation::{Again, Agreement, Relation};
use super::view::View;
use crate::compare::{Tolerance, difference, trace};

/// Two runs that differ by the tolerance of the solver and rounding alone do so by less than this. The tolerance is 1e-8 of the forces in play; multipliers are
/// updated until 1e-4 of the approach is left, and a point that is at its limit may be called stuck or slipping.
const SOLVER: f64 = 1e-3;

/// What two meshes with cells of a tenth to a third of the bodies may differ by: of linear cells the error in energy falls with their size. So does that of friction, which
/// acts over an increment as it does at the end, with the length of increments, of which a step has one to six.
const MESH: f64 = 0.25;

/// A run to be made: words behind the name of the program, and where its results will be.
pub struct Job {
    /// The words.
    pub words: Vec<String>,
    /// The folder of results.
    pub out: PathBuf,
    /// Whether it is a run of its own, which an audit can judge.
    pub own: bool,
}

fn words(list: &[&str]) -> Vec<String> {
    list.iter().map(|w| w.to_string()).collect()
}

/// The words that run a problem file into a folder.
pub fn run(file: &Path, out: &Path, threads: &str) -> Vec<String> {
    let (file, out) = (file.display().to_string(), out.display().to_string());
    // Laws over speed are audited between one increment and the next.
    words(&[
        "run",
        &file,
        "--threads",
        threads,
        "--quiet",
        "--set",
        "output.every=1",
        "-o",
        &out,
    ])
}

/// The same for a run that is gone on with from the middle.
pub fn run_with_checkpoints(file: &Path, out: &Path) -> Vec<String> {
    let mut all = run(file, out, "1");
    all.extend(words(&["--set", "output.checkpoint.increments=1"]));
    all
}

/// The words that run a mix, with checkpoints if one of its relations needs them.
pub fn first(mix: &Mix, file: &Path, out: &Path) -> Vec<String> {
    match mix
        .relations
        .iter()
        .any(|r| matches!(r.again, Again::Resume))
    {
        true => run_with_checkpoints(file, out),
        false => run(file, out, "1"),
    }
}

/// Prepares the second run in a folder of its own: a text, or a copy of the results of the first that is gone on with.
///
/// # Errors
/// A file cannot be written, or there is nothing to go on with.
pub fn prepare(mix: &Mix, relation: &Relation, first: &Path, place: &Path) -> Result<Job, String> {
    let say = |e: std::io::Error| format!("{}: {e}", place.display());
    let _ = fs::remove_dir_all(place);
    fs::create_dir_all(place).map_err(say)?;
    let (file, out) = (place.join("case.toml"), place.join("case.out"));
    let (threads, view) = match relation.again {
        Again::Text(change) => {
            let mut view = mix.view;
            change(&mut view);
            ("1", view)
        }
        Again::Threads => ("2", mix.view),
        Again::Resume => {
            copy(first, &out).map_err(say)?;
            let mut kept: Vec<usize> = fs::read_dir(&out)
                .map_err(say)?
                .flatten()
                .filter_map(|f| {
                    f.file_name()
                        .to_str()?
                        .strip_prefix("checkpoint_")?
                        .strip_suffix(".bin")?
                        .parse()
                        .ok()
                })
                .collect();
            kept.sort_unstable();
            let middle = kept
                .get(kept.len() / 2)
                .ok_or("there is no checkpoint to go on from")?;
            let folder = out.display().to_string();
            let words = words(&[
                "resume",
                &folder,
                "--from",
                &middle.to_string(),
                "--threads",
                "1",
                "--quiet",
            ]);
            return Ok(Job {
                words,
                out,
                own: false,
            });
        }
    };
    fs::write(&file, mix.text(view, relation.name)).map_err(say)?;
    Ok(Job {
        words: run(&file, &out, threads),
        out,
        own: true,
    })
}

/// What two runs that must agree differ by, as a part of what they may, and in what.
///
/// # Errors
/// A history cannot be read.
pub fn judge(
    mix: &Mix,
    relation: &Relation,
    first: &Path,
    second: &Path,
) -> Result<(f64, String), String> {
    if relation.agreement == Agreement::Bytes {
        let read = |folder: &Path| {
            fs::read(folder.join("history.csv")).map_err(|e| format!("{}: {e}", folder.display()))
        };
        let same = read(first)? == read(second)?;
        return Ok(match same {
            true => (0.0, String::new()),
            false => (f64::INFINITY, "the histories are not the same bytes".into()),
        });
    }
    let mut other = mix.view;
    if let Again::Text(change) = relation.again {
        change(&mut other);
    }
    let units = |v: &View| [v.length, v.modulus, v.time()];
    let (a, b) = (
        trace(first, units(&mix.view))?,
        trace(second, units(&other))?,
    );
    let exact = relation.agreement == Agreement::Solver;
    let path = |feature: &&str| ["implicit", "explicit", "implicit-explicit"].contains(feature);
    let depends = !mix.features.contains("no-friction") || mix.features.iter().any(path);
    let tolerance = Tolerance {
        same: if exact { SOLVER } else { MESH },
        others: if exact && !depends { SOLVER } else { MESH },
        moving: exact,
    };
    Ok(difference(&a, &b, tolerance))
}

fn copy(from: &Path, to: &Path) -> std::io::Result<()> {
    fs::create_dir_all(to)?;
    for entry in fs::read_dir(from)? {
        let entry = entry?;
        let target = to.join(entry.file_name());
        match entry.file_type()?.is_dir() {
            true => copy(&entry.path(), &target)?,
            false => fs::copy(entry.path(), target).map(|_| ())?,
        }
    }
    Ok(())
}

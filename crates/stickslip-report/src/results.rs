//! A result folder as `stickslip run` leaves it: what is there, and what is missing.

use std::path::{Path, PathBuf};

use serde_json::Value;
use stickslip::Error;
use stickslip::error::IoError;
use stickslip::io::vtu::{Grid, PointFields};
use stickslip::io::{csv, pvd, vtu};

use crate::phase::Phase;

/// An error about a file.
pub(crate) fn fault(file: &Path, message: impl Into<String>) -> Error {
    Error::Io(IoError {
        file: file.to_path_buf(),
        message: message.into(),
    })
}

/// One time at which fields were written.
#[derive(Debug, Clone, PartialEq)]
pub struct Frame {
    /// Time `[time]`.
    pub time: f64,
    /// The file with the fields.
    pub file: PathBuf,
    /// The phase at which the file is looked at, if it has the shape of a mode.
    pub(crate) phase: Option<Phase>,
}

/// What a result folder holds. Fields are read when they are asked for.
#[derive(Debug, Clone)]
pub struct Results {
    /// The folder.
    pub directory: PathBuf,
    /// `summary.json`; `null` where the run has not come to its end.
    pub summary: Value,
    /// The problem as it was run, from `problem.toml`; empty where there is none.
    pub problem: toml::Table,
    /// The text of `problem.toml`.
    pub problem_text: String,
    /// The rows of `history.csv`; no columns where there is none.
    pub history: csv::Table,
    /// The times of `fields.pvd`.
    pub frames: Vec<Frame>,
    /// What `interfaces.pvd` lists: the surfaces of the interfaces at these times.
    pub surfaces: Vec<pvd::Part>,
    /// What is missing, a sentence each.
    pub missing: Vec<String>,
}

impl Results {
    /// Looks into a folder. A file that is not there is noted in [`Results::missing`]: a run that was stopped leaves no summary, and one
    /// without an accepted increment no history.
    ///
    /// # Errors
    /// [`Error::Io`] if the folder is not there or holds none of the files, or one of them is damaged.
    pub fn open(directory: &Path) -> Result<Self, Error> {
        if !directory.is_dir() {
            let what = match directory.exists() {
                true => "this is a file; the folder with the results of a run is needed",
                false => "there is no such folder",
            };
            return Err(fault(directory, what));
        }
        let mut missing = Vec::new();
        let mut find = |name: &str, sentence: &str| {
            let path = directory.join(name);
            let found = path.is_file();
            if !found {
                missing.push(format!("{name} is missing: {sentence}"));
            }
            found.then_some(path)
        };
        let summary = find(
            "summary.json",
            "the run has not come to its end, or was stopped",
        );
        let history = find("history.csv", "no increment was accepted");
        let fields = find("fields.pvd", "no fields were written");
        let problem = find(
            "problem.toml",
            "the results are of an older version, or were not made by `stickslip run`",
        );
        if summary.is_none() && history.is_none() && fields.is_none() {
            return Err(fault(
                directory,
                "this is no folder of results: it has neither summary.json nor history.csv nor fields.pvd",
            ));
        }
        let mut results = Results {
            directory: directory.to_path_buf(),
            summary: Value::Null,
            problem: toml::Table::new(),
            problem_text: String::new(),
            history: csv::Table::default(),
            frames: Vec::new(),
            surfaces: Vec::new(),
            missing,
        };
        if let Some(path) = summary {
            let text = read(&path)?;
            results.summary = serde_json::from_str(&text)
                .map_err(|e| fault(&path, format!("the summary is damaged: {e}")))?;
            if !results.summary.is_object() {
                return Err(fault(&path, "the summary is damaged: it is no JSON object"));
            }
        }
        if let Some(path) = history {
            results.history = csv::read(&path)?;
        }
        if let Some(path) = problem {
            results.problem_text = read(&path)?;
            results.problem = results
                .problem_text
                .parse()
                .map_err(|e| fault(&path, format!("the problem is damaged: {e}")))?;
        }
        if let Some(path) = fields {
            for (time, name) in pvd::read(&path)? {
                let file = directory.join(&name);
                if !file.is_file() {
                    return Err(fault(
                        &path,
                        format!("it lists `{name}`, which is not there"),
                    ));
                }
                results.frames.push(Frame {
                    time,
                    file,
                    phase: None,
                });
            }
        }
        // A run without interfaces has none.
        let surfaces = directory.join("interfaces.pvd");
        if surfaces.is_file() && !results.frames.is_empty() {
            results.surfaces = listed(&surfaces)?;
        }
        Ok(results)
    }

    /// How many steps the problem has; none, where it is not known.
    pub fn steps(&self) -> usize {
        let steps = self.problem.get("step").and_then(toml::Value::as_array);
        steps.map_or(0, Vec::len)
    }

    /// The number of a step, from 1, by that or its name.
    pub(crate) fn step(&self, name: &str) -> Option<usize> {
        let steps = self.problem.get("step").and_then(toml::Value::as_array)?;
        let called =
            |step: &toml::Value| step.get("name").and_then(toml::Value::as_str) == Some(name);
        let named = steps.iter().position(called).map(|k| k + 1);
        named.or_else(|| name.parse().ok())
    }

    /// The title of the problem, or the name of the folder.
    pub fn title(&self) -> String {
        let of_summary = self.summary.get("title").and_then(Value::as_str);
        let of_problem = self.problem.get("title").and_then(toml::Value::as_str);
        let title = of_summary.or(of_problem).unwrap_or_default().trim();
        if !title.is_empty() {
            return title.to_string();
        }
        let name = self.directory.file_name();
        name.map_or_else(|| "results".into(), |n| n.to_string_lossy().into_owned())
    }

    /// The names of the bodies in the order of their numbers; those that are not known are `body 1`, `body 2` ...
    pub fn bodies(&self, count: usize) -> Vec<String> {
        let table = self.problem.get("body").and_then(toml::Value::as_table);
        let mut names: Vec<String> = table.map_or_else(Vec::new, |t| t.keys().cloned().collect());
        // The problem has them sorted by name, and so has the model.
        names.sort();
        if names.len() < count {
            names = (1..=count).map(|i| format!("body {i}")).collect();
        }
        names
    }

    /// The last row of the history at a time.
    fn row_at(&self, time: f64) -> Option<usize> {
        let times = self.history.column("TIME")?;
        let room = 1e-9 * time.abs();
        times.iter().rposition(|t| (t - time).abs() <= room)
    }

    /// How many contact points are open, stick and slip at a time, as the run has counted them; `None` where the history does not say.
    pub(crate) fn statuses_at(&self, time: f64) -> Option<[usize; 3]> {
        let row = self.row_at(time)?;
        let of = |name: &str| Some(*self.history.column(name)?.get(row)? as usize);
        Some([of("OPEN")?, of("STICK")?, of("SLIP")?])
    }

    /// The largest pressure of an interface at a time, as the run has found it; `None` where the history does not say.
    pub(crate) fn peak_at(&self, interface: &str, time: f64) -> Option<f64> {
        let column = self.history.column(&format!("{interface}.CPRESSMAX"))?;
        column.get(self.row_at(time)?).copied()
    }

    /// Points, cells and data of a frame.
    ///
    /// # Errors
    /// [`Error::Io`] if the file cannot be read or is damaged.
    pub fn grid(&self, frame: usize) -> Result<Grid, Error> {
        let Frame { file, phase, .. } = &self.frames[frame];
        let mut grid = vtu::read_grid(file)?;
        if let Some(phase) = phase {
            phase.place(&mut grid.points);
        }
        Ok(grid)
    }

    /// Points and their data of a frame.
    ///
    /// # Errors
    /// As [`Results::grid`].
    pub fn points(&self, frame: usize) -> Result<PointFields, Error> {
        let Frame { file, phase, .. } = &self.frames[frame];
        let mut points = vtu::read(file)?;
        if let Some(phase) = phase {
            phase.place(&mut points);
        }
        Ok(points)
    }
}

fn read(path: &Path) -> Result<String, Error> {
    stickslip::io::input::read_text(path).map_err(|e| Error::io(path, e))
}

/// Reads the list of surfaces; a file of it that is not there is an error.
fn listed(path: &Path) -> Result<Vec<pvd::Part>, Error> {
    let parts = pvd::read_parts(path)?;
    let folder = path.parent().unwrap_or(Path::new(""));
    match parts.iter().find(|part| !folder.join(&part.file).is_file()) {
        Some(gone) => Err(fault(
            path,
            format!("it lists `{}`, which is not there", gone.file),
        )),
        None => Ok(parts),
    }
}

//! Which runs a sweep consists of, and the check of all of them before the first.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use rayon::prelude::*;
use stickslip::Diagnostic;
use stickslip::error::ProblemError;
use stickslip::problem::Document;

use super::values::{self, Axis, MOST_RUNS};
use crate::failure::Failure;

/// The runs: what is the same in all, and what differs.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Plan {
    /// The changes that are the same in all.
    pub fixed: Vec<String>,
    /// What differs.
    pub axes: Vec<Axis>,
    /// Whether axes run side by side instead of in all combinations.
    pub zip: bool,
}

impl Plan {
    /// Reads the axes (`set`) and the values that stay (`fix`).
    ///
    /// # Errors
    /// [`Failure::Arguments`]: text that cannot be read, a key given twice, axes of different lengths side by side,
    /// too many runs.
    pub fn new(set: &[String], fix: &[String], zip: bool) -> Result<Self, Failure> {
        let mut axes: Vec<Axis> = Vec::new();
        let mut paths: Vec<&str> = Vec::new();
        for text in fix {
            let help = "write --fix path=value, for example --fix step.1.duration=2";
            let (path, _) = values::split(text)
                .map_err(|message| Failure::Arguments(format!("--fix: {message}"), help.into()))?;
            paths.push(path);
        }
        for text in set {
            let help = "write --set path=v1,v2,... or --set path=from..to:count, for example \
                        --set interface.base.friction.coulomb.mu=0.1,0.2";
            let axis = values::axis(text)
                .map_err(|message| Failure::Arguments(format!("--set: {message}"), help.into()))?;
            axes.push(axis);
        }
        paths.extend(axes.iter().map(|axis| axis.path.as_str()));
        let again = (1..paths.len()).find(|&i| paths[..i].contains(&paths[i]));
        if let Some(path) = again.map(|i| paths[i]) {
            return Err(Failure::Arguments(
                format!("`{path}` is given twice"),
                "give all values of a key in one --set".into(),
            ));
        }
        match zip {
            true => side_by_side(&axes)?,
            false => product(&axes)?,
        };
        Ok(Plan {
            fixed: fix.to_vec(),
            axes,
            zip,
        })
    }

    /// Number of runs.
    pub fn count(&self) -> usize {
        match self.zip {
            true => self.axes.first().map_or(0, |axis| axis.values.len()),
            false => self.axes.iter().map(|axis| axis.values.len()).product(),
        }
    }

    /// The values of a run, counted from 0, in the order of the axes. The last axis changes fastest.
    pub fn values(&self, run: usize) -> Vec<&str> {
        let mut rest = run;
        let mut chosen: Vec<&str> = Vec::with_capacity(self.axes.len());
        for axis in self.axes.iter().rev() {
            let n = axis.values.len();
            let index = if self.zip { run } else { rest % n };
            rest /= n;
            chosen.push(&axis.values[index]);
        }
        chosen.reverse();
        chosen
    }

    /// The changes of the problem file that make it the one of a run.
    pub fn overrides(&self, run: usize) -> Vec<String> {
        let values = self.values(run);
        let chosen = self.axes.iter().zip(values);
        let chosen = chosen.map(|(axis, value)| format!("{}={value}", axis.path));
        self.fixed.iter().cloned().chain(chosen).collect()
    }

    /// Reads and checks the problem of every run, without meshes. Returns the files that any of them reads.
    ///
    /// # Errors
    /// The findings, each once, with the first run in which it occurs if it does not in all.
    pub fn check(&self, case: &Document) -> Result<BTreeSet<PathBuf>, ProblemError> {
        let read = |run: usize| {
            let document = case.clone().with_overrides(self.overrides(run));
            let problem = document.problem();
            problem.map(|problem| document.inputs(&problem))
        };
        let checked = (0..self.count())
            .into_par_iter()
            .map(|run| (run, read(run)));
        let checked = checked.fold(Checked::default, |known, (run, read)| known.with(run, read));
        let Checked { mut failed, files } = checked.reduce(Checked::default, Checked::and);
        failed.sort_by_key(|(run, _)| *run);
        let mut found: Vec<(Diagnostic, usize, usize)> = Vec::new();
        let mut more = false;
        for (run, findings) in failed {
            for finding in findings {
                match found.iter().position(|(known, ..)| *known == finding) {
                    Some(i) => found[i].2 += 1,
                    None if found.len() < LISTED_FINDINGS => found.push((finding, run, 1)),
                    None => more = true,
                }
            }
        }
        if found.is_empty() {
            return Ok(files);
        }
        let mut findings: Vec<Diagnostic> = found
            .into_iter()
            .map(|(finding, run, times)| match times == self.count() {
                true => finding,
                false => self.in_run(finding, run),
            })
            .collect();
        if more {
            findings.push(Diagnostic::new("", "there are more findings in other runs"));
        }
        Err(ProblemError {
            file: case.file.clone(),
            source: case.source.clone(),
            findings,
        })
    }

    /// Says in which run something was found.
    fn in_run(&self, finding: Diagnostic, run: usize) -> Diagnostic {
        let axes = self.axes.iter().zip(self.values(run));
        let values: Vec<String> = axes.map(|(a, v)| format!("{}={v}", a.path)).collect();
        let place = format!(
            "in run {} of {}: {}",
            run + 1,
            self.count(),
            values.join(", ")
        );
        let help = match &finding.help {
            Some(help) => format!("{help}; {place}"),
            None => place,
        };
        finding.help(help)
    }
}

/// What came of reading some of the runs.
#[derive(Default)]
struct Checked {
    failed: Vec<(usize, Vec<Diagnostic>)>,
    files: BTreeSet<PathBuf>,
}

impl Checked {
    fn with(mut self, run: usize, read: Result<Vec<PathBuf>, ProblemError>) -> Self {
        match read {
            Ok(files) => self.files.extend(files),
            Err(e) => self.failed.push((run, e.findings)),
        }
        self
    }

    fn and(mut self, mut other: Self) -> Self {
        self.failed.append(&mut other.failed);
        self.files.append(&mut other.files);
        self
    }
}

/// Most findings that are listed: a wrong key shows once, but each wrong value of an axis does.
const LISTED_FINDINGS: usize = 10;

fn product(axes: &[Axis]) -> Result<usize, Failure> {
    let count = axes
        .iter()
        .try_fold(1_usize, |n, axis| n.checked_mul(axis.values.len()));
    count.filter(|&n| n <= MOST_RUNS).ok_or_else(|| {
        Failure::Arguments(
            format!("these axes make more than {MOST_RUNS} runs"),
            "take fewer values, or --zip if the axes belong side by side".into(),
        )
    })
}

fn side_by_side(axes: &[Axis]) -> Result<usize, Failure> {
    let count = axes.first().map_or(0, |axis| axis.values.len());
    if let Some(other) = axes.iter().find(|axis| axis.values.len() != count) {
        return Err(Failure::Arguments(
            format!(
                "--zip: `{}` has {count} values, `{}` has {}",
                axes[0].path,
                other.path,
                other.values.len()
            ),
            "axes side by side have equally many values; --fix sets one value in all runs".into(),
        ));
    }
    product(&axes[..axes.len().min(1)])
}

/// The folder of the results of a run, counted from 0.
pub fn folder_of_run(results: &Path, run: usize) -> PathBuf {
    results.join(format!("{:04}", run + 1))
}

/// So many runs, as one says it.
pub fn runs(count: usize) -> String {
    match count {
        1 => "1 run".into(),
        n => format!("{n} runs"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plan(set: &[&str], fix: &[&str], zip: bool) -> Result<Plan, String> {
        let strings = |all: &[&str]| all.iter().map(ToString::to_string).collect::<Vec<_>>();
        Plan::new(&strings(set), &strings(fix), zip).map_err(|failure| match failure {
            Failure::Arguments(message, _) => message,
            other => panic!("{other:?}"),
        })
    }

    fn all(plan: &Plan) -> Vec<String> {
        let runs = 0..plan.count();
        runs.map(|run| plan.overrides(run).join(" ")).collect()
    }

    #[test]
    fn the_last_axis_changes_fastest() {
        let plan = plan(&["a=1,2", "b=x", "c=[3,4],5,6"], &["d=7"], false).unwrap();
        let expected = [
            "d=7 a=1 b=x c=[3,4]",
            "d=7 a=1 b=x c=5",
            "d=7 a=1 b=x c=6",
            "d=7 a=2 b=x c=[3,4]",
            "d=7 a=2 b=x c=5",
            "d=7 a=2 b=x c=6",
        ];
        assert_eq!(all(&plan), expected);
    }

    #[test]
    fn axes_side_by_side_are_equally_long() {
        let together = plan(&["a=1,2,3", "b=0..4:3"], &[], true).unwrap();
        assert_eq!(all(&together), ["a=1 b=0", "a=2 b=2", "a=3 b=4"]);
        assert_eq!(
            plan(&["a=1,2", "b=1,2,3"], &[], true).unwrap_err(),
            "--zip: `a` has 2 values, `b` has 3"
        );
    }

    #[test]
    fn a_key_has_one_place_and_a_sweep_an_end() {
        for (set, fix) in [
            (&["a=1", "a=2"][..], &[][..]),
            (&["b=1", "a=1,2"], &["a =3"]),
            (&["b=1"], &["a=3", "a=4"]),
        ] {
            assert_eq!(plan(set, fix, false).unwrap_err(), "`a` is given twice");
        }
        let many: Vec<String> = (0..30).map(|i| format!("k{i}=0..999:1000")).collect();
        let many: Vec<&str> = many.iter().map(String::as_str).collect();
        assert!(
            plan(&many, &[], false)
                .unwrap_err()
                .starts_with("these axes make more than")
        );
        assert_eq!(plan(&many, &[], true).unwrap().count(), 1000);
    }

    const CASE: &str = r#"format = 1
model.space = "plane-strain"
body.block = { generate.rectangle = { to = [0.04, 0.02], cells = [4, 2] }, material = "steel" }
material.steel.isotropic = { young = 210e9, poisson = 0.3 }
support.top = { set = "block.top", x = 0.0, y = -1e-5 }
step = [{ name = "press" }]
"#;

    fn findings(set: &[&str]) -> Vec<(String, Option<String>)> {
        let case = Document::new(CASE, None);
        let checked = plan(set, &[], false).unwrap().check(&case);
        let findings = checked.err().map_or(Vec::new(), |e| e.findings);
        findings.into_iter().map(|f| (f.key, f.help)).collect()
    }

    #[test]
    fn what_is_wrong_is_said_once_with_its_run() {
        let young = "material.steel.isotropic.young";
        let poisson = "material.steel.isotropic.poisson";
        assert_eq!(findings(&[&format!("{young}=1e9,2e9")]), []);
        let set = [format!("{poisson}=0.2,0.3"), format!("{young}=1e9,-1,-2")];
        let found = findings(&[&set[0], &set[1]]);
        assert_eq!(found.len(), 2, "{found:?}");
        assert!(found.iter().all(|(key, _)| key == young));
        for ((_, help), (run, value)) in found.iter().zip([(2, -1), (3, -2)]) {
            let end = format!("in run {run} of 6: {poisson}=0.2, {young}={value}");
            assert!(help.as_deref().unwrap().ends_with(&end), "{help:?}");
        }
        // A wrong key is no matter of its values.
        let found = findings(&["material.steel.isotropic.yuong=1e9,2e9"]);
        assert_eq!(found.len(), 1, "{found:?}");
        assert!(!found[0].1.as_deref().unwrap().contains("in run"));
        // Not a wall of text.
        let range = format!("{young}=-1..-50:50");
        assert_eq!(findings(&[&range]).len(), LISTED_FINDINGS + 1);
    }
}

//! What all figures need: the binary, a place to work in, analyses and what they report.

use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use serde_json::Value;

use super::cpu::{Run, measure};
use xtask::workspace;

/// Where the comparison runs.
pub struct Bench {
    /// The binary `stickslip`.
    pub binary: PathBuf,
    /// Where results go.
    pub scratch: PathBuf,
    /// Whether CalculiX can be run.
    pub calculix: bool,
}

/// An analysis that was run to its end.
pub struct Analysis {
    /// Times of the whole process.
    pub run: Run,
    summary: Value,
}

impl Bench {
    /// Builds the binary, or takes the one that `STICKSLIP` names.
    pub fn new() -> Result<Self, String> {
        let bench = Bench {
            binary: workspace::stickslip()?,
            scratch: workspace::target().join("peers"),
            calculix: Command::new(ccx()).arg("-v").output().is_ok(),
        };
        if !bench.calculix {
            println!(
                "ccx is not installed (Debian: apt-get install calculix-ccx): stickslip alone\n"
            );
        }
        Ok(bench)
    }

    /// A folder for results, made if it is not there.
    pub fn folder(&self, name: &str) -> Result<PathBuf, String> {
        let folder = self.scratch.join(name);
        fs::create_dir_all(&folder).map_err(|e| format!("{}: {e}", folder.display()))?;
        Ok(folder)
    }

    /// Runs a case with these settings on one thread.
    pub fn analyse(&self, case: &Path, settings: &[String]) -> Result<Analysis, String> {
        self.analyse_on(1, case, settings)
    }

    /// Runs a case with these settings.
    pub fn analyse_on(
        &self,
        threads: usize,
        case: &Path,
        settings: &[String],
    ) -> Result<Analysis, String> {
        let out = self.folder("stickslip.out")?;
        let file = out.join("summary.json");
        // What an earlier run left must not pass for the result of this one.
        let _ = fs::remove_dir_all(&out);
        let mut command = Command::new(&self.binary);
        command.arg("run").arg(case).arg("--quiet");
        command.args(["--threads", &threads.to_string()]);
        command.args(["--set", "output.every=0"]);
        for setting in settings {
            command.args(["--set", setting]);
        }
        command.arg("-o").arg(&out).stdout(Stdio::null());
        let run = measure(&mut command)?;
        let text = fs::read_to_string(&file).map_err(|e| format!("{}: {e}", file.display()))?;
        let summary =
            serde_json::from_str(&text).map_err(|e| format!("{}: {e}", file.display()))?;
        Ok(Analysis { run, summary })
    }

    /// Whether the binary knows this `solver.method`.
    pub fn has_method(&self, method: &str) -> Result<bool, String> {
        let output = Command::new(&self.binary)
            .arg("schema")
            .output()
            .map_err(|e| format!("cannot run {}: {e}", self.binary.display()))?;
        let schema = String::from_utf8_lossy(&output.stdout);
        Ok(schema.contains(&format!("\"{method}\"")))
    }

    /// Runs CalculiX on the deck `name.inp` of a folder, on one thread.
    pub fn calculix(&self, folder: &Path, name: &str) -> Result<Run, String> {
        let mut command = Command::new(ccx());
        command.args(["-i", name]).current_dir(folder);
        command.env("OMP_NUM_THREADS", "1").stdout(Stdio::null());
        measure(&mut command)
    }
}

impl Analysis {
    /// A number of `summary.json` by its path, as in `/size/dofs`; 0 if it is not there.
    pub fn number(&self, path: &str) -> f64 {
        self.summary
            .pointer(path)
            .and_then(Value::as_f64)
            .unwrap_or(0.0)
    }

    /// A text of `summary.json`; empty if it is not there.
    pub fn text(&self, path: &str) -> &str {
        self.summary
            .pointer(path)
            .and_then(Value::as_str)
            .unwrap_or("")
    }

    /// Displacement dofs.
    pub fn dofs(&self) -> f64 {
        self.number("/size/dofs")
    }

    /// Seconds of a phase.
    pub fn phase(&self, name: &str) -> f64 {
        self.number(&format!("/phases/{name}"))
    }

    /// CPU seconds of what took `wall` seconds: the program computes on one thread, and others take their share of the machine.
    fn processor(&self, wall: f64) -> f64 {
        wall * (self.run.cpu / self.run.wall).min(1.0)
    }

    /// CPU seconds of one assembly, ordering, factorisation and solution, as far as this run met them; for runs on one thread.
    pub fn linear_solve(&self) -> f64 {
        self.processor(self.number("/linear-solve"))
    }

    /// CPU seconds of one factorisation, the inverse at the candidates included; for runs of one body on one thread.
    pub fn one_factor(&self) -> f64 {
        let made = self.number("/solver/factorisations").max(1.0);
        self.processor(self.phase("factor") + self.phase("condense")) / made
    }

    /// CPU seconds that an increment takes when all factors are there, on the average; for runs on one thread.
    pub fn increment(&self) -> f64 {
        let spent = self.phase("iterate") + self.phase("recover") + self.phase("contact");
        self.processor(spent) / self.number("/increments").max(1.0)
    }

    /// Peak memory `[MB]`.
    pub fn megabytes(&self) -> f64 {
        self.number("/peak-memory") / 1e6
    }

    /// Seconds by phase, in one line.
    pub fn phases(&self) -> String {
        let names = [
            "read", "assemble", "order", "factor", "condense", "iterate", "contact", "recover",
        ];
        let parts: Vec<String> = names
            .iter()
            .map(|n| format!("{n} {:.2}", self.processor(self.phase(n))))
            .collect();
        parts.join(", ")
    }

    /// `condensed`, `sparse` or `multigrid`. A run that made substructures counts as condensed, whatever its last step did.
    pub fn method(&self) -> &str {
        if self.number("/solver/substructures-made") > 0.0 {
            "condensed"
        } else {
            self.text("/method")
        }
    }
}

/// CalculiX: `ccx`, or what the environment variable `CCX` names.
fn ccx() -> OsString {
    std::env::var_os("CCX").unwrap_or_else(|| "ccx".into())
}

/// `a / b` with three digits, `-` without `b`.
pub fn ratio(a: f64, b: Option<f64>) -> String {
    match b {
        Some(b) if b > 0.0 => format!("{:.3}", a / b),
        _ => "-".into(),
    }
}

/// Seconds with two decimals, `-` if there are none.
pub fn seconds(s: Option<f64>) -> String {
    s.map_or("-".into(), |s| format!("{s:.2}"))
}

/// An example.
pub fn example(path: &str) -> Result<PathBuf, String> {
    let case = workspace::root().join("examples").join(path);
    if case.exists() {
        Ok(case)
    } else {
        Err(format!("{} is missing", case.display()))
    }
}

//! Planted defects: sound models, each spoilt by one mistake, which an error, `check` or the findings of the run have to name, and nothing else.

mod conditions;
mod examples;
mod geometry;
mod laws;
mod models;
mod numbers;

use crate::support;
use std::path::Path;

use stickslip::Error;
use stickslip::assess::doctor::{DoctorCause, Finding, Severity};
use stickslip::model::Contact;
use stickslip::problem::Document;
use stickslip::run::Simulation;

/// What has to be said of a defect.
pub enum Expected {
    /// The file or a mesh is refused with these words.
    Refused(&'static str),
    /// `check` or the run finds this cause, and names this.
    Found(DoctorCause, &'static str),
}
use Expected::{Found, Refused};

/// A sound model and the mistake.
pub struct Defect {
    name: &'static str,
    base: &'static str,
    /// What is replaced by what, once each.
    changes: &'static [(&'static str, &'static str)],
    /// The same in the mesh file.
    mesh: &'static [(&'static str, &'static str)],
    expected: Expected,
    /// Other causes that are right as well: what the mistake leads to.
    also: &'static [DoctorCause],
}

/// A mistake in the problem file.
pub const fn defect(
    name: &'static str,
    base: &'static str,
    changes: &'static [(&'static str, &'static str)],
    expected: Expected,
) -> Defect {
    Defect {
        name,
        base,
        changes,
        mesh: &[],
        expected,
        also: &[],
    }
}

/// A mistake in the mesh file.
pub const fn meshed(
    name: &'static str,
    mesh: &'static [(&'static str, &'static str)],
    expected: Expected,
) -> Defect {
    Defect {
        name,
        base: models::MESHED,
        changes: &[],
        mesh,
        expected,
        also: &[],
    }
}

impl Defect {
    /// The same where other causes are right as well.
    pub const fn also(self, also: &'static [DoctorCause]) -> Defect {
        Defect { also, ..self }
    }
}

/// Advice that helps with none of the defects: it treats the mistake as a difficulty of the solver.
const WRONG_ADVICE: [&str; 4] = [
    "solver.method",
    "lower `solver.tolerance`",
    "kinematics other than",
    "please report",
];

fn changed(text: &str, changes: &[(&str, &str)]) -> String {
    changes.iter().fold(text.to_string(), |text, (from, to)| {
        assert!(text.contains(from), "`{from}` is not in\n{text}");
        text.replacen(from, to, 1)
    })
}

/// What is said of a model that is read.
pub struct Examined {
    /// Findings before the run.
    pub before: Vec<Finding>,
    /// Findings of the run.
    pub during: Vec<Finding>,
    /// How it ended.
    pub error: Option<Error>,
}

impl Examined {
    /// All findings.
    pub fn findings(&self) -> impl Iterator<Item = &Finding> {
        self.before.iter().chain(&self.during)
    }

    /// All of it in words.
    pub fn text(&self) -> String {
        let mut all: Vec<String> = self.findings().map(Finding::to_string).collect();
        let end = self.error.as_ref();
        all.push(end.map_or("finished".to_string(), |e| format!("=> {e}")));
        all.join("\n")
    }
}

/// The error that refuses a model, or the findings before and of the run; `prepare` does to it what a program may do before.
pub fn examined(
    text: &str,
    folder: &Path,
    prepare: &dyn Fn(&mut Contact),
) -> Result<Examined, Error> {
    let document = Document::new(text, None);
    let simulation = || -> Result<Simulation, Error> {
        let built = document.problem()?.build(folder);
        let mut setup = built.map_err(|e| match e {
            Error::Problem(e) => Error::Problem(document.error(e.findings)),
            e => e,
        })?;
        prepare(&mut setup.contact);
        Simulation::new(setup)
    };
    let before = simulation()?.check().findings;
    let mut simulation = simulation()?;
    let error = simulation.run(&mut []).err();
    Ok(Examined {
        before,
        during: simulation.run.summary.findings,
        error,
    })
}

/// A folder of a test with the mesh file in it.
pub fn folder(name: &str, mesh: &[(&str, &str)]) -> std::path::PathBuf {
    let folder = support::folder(&format!("defects-{}", name.replace(' ', "-")));
    std::fs::write(folder.join("block.msh"), changed(models::MESH, mesh)).expect("a mesh file");
    folder
}

/// What is wrong with what is said of a defect.
fn misses(defect: &Defect) -> Option<String> {
    let text = changed(defect.base, defect.changes);
    let said = examined(&text, &folder(defect.name, defect.mesh), &|_| {});
    let fault = match (&defect.expected, &said) {
        (Refused(words), Err(error)) => {
            let error = error.to_string();
            (!error.contains(words)).then(|| format!("`{words}` is not named"))
        }
        (Refused(_), Ok(_)) => Some("not refused".to_string()),
        (Found(..), Err(_)) => Some("refused".to_string()),
        (Found(cause, entity), Ok(said)) => judged(said, (*cause, entity), defect.also),
    };
    let said = said.map_or_else(|e| e.to_string(), |e| e.text());
    fault.map(|f| format!("## {}: {f}\n{said}", defect.name))
}

/// What is wrong with findings that have to name a cause and an entity, and no other cause but some.
pub fn judged(
    said: &Examined,
    (cause, entity): (DoctorCause, &str),
    also: &[DoctorCause],
) -> Option<String> {
    let found = |f: &Finding| f.cause == cause && f.to_string().contains(entity);
    if !said.findings().any(found) {
        return Some(format!("{cause} of {entity} is not found"));
    }
    // What came of the defect by the end of the run is no other cause.
    const OUTCOME: [DoctorCause; 3] = [
        DoctorCause::NeverCarried,
        DoctorCause::CoarseContact,
        DoctorCause::FarAway,
    ];
    let serious = || {
        let findings = said.findings().filter(|f| !OUTCOME.contains(&f.cause));
        let findings = findings
            .filter(|f| f.cause != DoctorCause::LargeStrain || !f.message.contains("in the end"));
        findings.filter(|f| f.severity >= Severity::Warning)
    };
    if let Some(f) = serious().find(|f| f.cause != cause && !also.contains(&f.cause)) {
        return Some(format!("{} is not the cause", f.cause));
    }
    let text = said.text();
    let wrong = WRONG_ADVICE.iter().find(|a| text.contains(**a));
    wrong.map(|a| format!("`{a}` is no advice"))
}

fn all_are_named(defects: &[Defect]) {
    let missed: Vec<String> = defects.iter().filter_map(misses).collect();
    assert!(
        missed.is_empty(),
        "{} of {} missed:\n{}",
        missed.len(),
        defects.len(),
        missed.join("\n\n")
    );
}

#[test]
fn sound_models_raise_no_alarm() {
    for (name, base) in models::SOUND {
        let said = examined(base, &folder(name, &[]), &|_| {});
        let said = said.unwrap_or_else(|e| panic!("{name}: {e}"));
        assert!(said.error.is_none(), "{name}: {}", said.text());
        for finding in said.findings() {
            assert!(finding.severity < Severity::Warning, "{name}: {finding}");
        }
    }
}

#[test]
fn defects_of_geometry_are_named() {
    all_are_named(geometry::GEOMETRY);
}

#[test]
fn defects_of_numbers_are_named() {
    all_are_named(numbers::NUMBERS);
}

#[test]
fn defects_of_conditions_are_named() {
    all_are_named(conditions::CONDITIONS);
}

#[test]
fn there_are_enough_of_them() {
    let lists = [geometry::GEOMETRY, numbers::NUMBERS, conditions::CONDITIONS];
    let count: usize = lists.iter().map(|l| l.len()).sum();
    assert!(count + laws::COUNT >= 60, "{count}");
}

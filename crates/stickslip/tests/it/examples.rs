//! Every example is a regression test: it is run as a user runs it and compared with what is expected of it.
//!
//! A folder of `examples/` holds a `case.toml` and one `expected*.toml` or more; each of those names the case and the overrides it is
//! about, so that large cases are tested in a reduced size.

use std::path::{Path, PathBuf};

use stickslip::problem::Document;
use stickslip::results::compare::{Expected, compare};
use stickslip::results::{Observer, ResultFiles};
use stickslip::run::Simulation;

fn folder(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../examples")
        .join(name)
}

fn expectations(folder: &Path) -> Vec<PathBuf> {
    let mut files: Vec<PathBuf> = std::fs::read_dir(folder)
        .expect("the folder of an example")
        .map(|entry| entry.expect("an entry").path())
        .filter(|path| {
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            name.starts_with("expected") && name.ends_with(".toml")
        })
        .collect();
    files.sort();
    files
}

/// Runs and compares one example.
fn check(name: &str) {
    let folder = folder(name);
    let files = expectations(&folder);
    assert!(!files.is_empty(), "{name} has no expected.toml");
    for file in files {
        let expected = Expected::read(&file).unwrap_or_else(|e| panic!("{e}"));
        if !expected.tested {
            continue;
        }
        let case = folder.join(expected.case.as_deref().unwrap_or("case.toml"));
        let stem = file.file_stem().unwrap_or_default().to_string_lossy();
        let out = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("{name}-{stem}"));
        let document = Document::read(&case)
            .unwrap_or_else(|e| panic!("{e}"))
            .with_overrides(expected.overrides.clone());
        let problem = document.problem().unwrap_or_else(|e| panic!("{e}"));
        let model = problem
            .build(&document.folder())
            .unwrap_or_else(|e| panic!("{name}: {e}"));
        let mut simulation = Simulation::new(model).unwrap_or_else(|e| panic!("{name}: {e}"));
        let mut files =
            ResultFiles::new(&out, &Default::default()).unwrap_or_else(|e| panic!("{e}"));
        let mut observers: Vec<&mut dyn Observer> = vec![&mut files];
        simulation
            .run(&mut observers)
            .unwrap_or_else(|e| panic!("{name}, {stem}: {e}"));
        let quality = &simulation.summary.quality;
        let poor: Vec<String> = quality.violations().map(|f| f.sentence(&[])).collect();
        assert!(!quality.failed(), "{name}, {stem}: {poor:#?}");
        let report = compare(&out, &file).unwrap_or_else(|e| panic!("{e}"));
        assert!(report.passes(), "{name}, {stem}:\n{report}");
    }
}

every_example!(check);

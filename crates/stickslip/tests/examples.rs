//! Every example is a regression test: it is run as a user runs it and compared with what is expected of it.
//!
//! A folder of `examples/` holds a `case.toml` and one `expected*.toml` or more; each of those names the case and the overrides it is
//! about, so that large cases are tested in a reduced size.

use std::path::{Path, PathBuf};

use stickslip::problem::Document;
use stickslip::simulation::compare::{Expected, compare};
use stickslip::simulation::{Observer, ResultFiles, Simulation};

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
        let mut files = ResultFiles::new(&out).unwrap_or_else(|e| panic!("{e}"));
        let mut observers: Vec<&mut dyn Observer> = vec![&mut files];
        simulation
            .run(&mut observers)
            .unwrap_or_else(|e| panic!("{name}, {stem}: {e}"));
        let report = compare(&out, &file).unwrap_or_else(|e| panic!("{e}"));
        assert!(report.passes(), "{name}, {stem}:\n{report}");
    }
}

macro_rules! examples {
    ($($test:ident = $folder:literal),+ $(,)?) => {
        $(#[test] fn $test() { check($folder); })+

        /// No example goes untested.
        #[test]
        fn every_example_is_listed() {
            let mut found: Vec<String> = std::fs::read_dir(folder(""))
                .expect("the folder of examples")
                .map(|entry| entry.expect("an entry"))
                .filter(|entry| entry.path().is_dir())
                .map(|entry| entry.file_name().to_string_lossy().into_owned())
                .collect();
            found.sort();
            let mut listed = vec![$($folder.to_string()),+];
            listed.sort();
            assert_eq!(found, listed);
            for name in found {
                assert!(folder(&name).join("README.md").exists(), "{name} has no README");
            }
        }
    };
}

examples! {
    cattaneo_mindlin = "cattaneo-mindlin",
    hertz_line = "hertz-line",
    hertz_sphere = "hertz-sphere",
    mindlin_sphere = "mindlin-sphere",
    fretting_sphere = "fretting-sphere",
    belt_block = "belt-block",
    belt_mass = "belt-mass",
    block_limits = "block-limits",
    bouncing_bar = "bouncing-bar",
    braking_block = "braking-block",
    compliance_bar = "compliance-bar",
    compliance_impact = "compliance-impact",
    flat_punch = "flat-punch",
    forced_slider = "forced-slider",
    free_slider = "free-slider",
    greco = "greco",
    greco_compliance = "greco-compliance",
    impact_bar = "impact-bar",
    lug = "lug",
    patch_friction = "patch-friction",
    patch_matching = "patch-matching",
    patch_taylor = "patch-taylor",
    press_and_slide = "press-and-slide",
    shear_column = "shear-column",
    shear_lag = "shear-lag",
    steel_bar = "steel-bar",
    two_bars = "two-bars",
}

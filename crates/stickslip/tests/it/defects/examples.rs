//! The examples are sound: `check` says of them what is listed here, and nothing else.

use std::path::Path;

use stickslip::assess::doctor::{DoctorCause, Severity};
use stickslip::problem::Document;
use stickslip::run::Simulation;

/// Warnings that are right: example, cause, why.
const RIGHT: &[(&str, DoctorCause, &str)] = &[(
    "closing-gaps",
    DoctorCause::InitialGap,
    "it shows how bodies under load close gaps of a hundred cells",
)];

#[test]
fn examples_raise_no_false_alarm() {
    let examples = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples");
    let folders = std::fs::read_dir(&examples).expect("the folder of examples");
    let mut cases = 0;
    let mut wrong = Vec::new();
    let mut said: Vec<(String, DoctorCause)> = Vec::new();
    for folder in folders
        .map(|f| f.expect("an entry").path())
        .filter(|f| f.is_dir())
    {
        let example = folder
            .file_name()
            .unwrap_or_default()
            .to_string_lossy()
            .into_owned();
        for file in std::fs::read_dir(&folder).expect("an example") {
            let file = file.expect("an entry").path();
            let name = file
                .file_name()
                .unwrap_or_default()
                .to_string_lossy()
                .into_owned();
            if !(name.starts_with("case") && name.ends_with(".toml")) {
                continue;
            }
            cases += 1;
            let document = Document::read(&file).expect("an example");
            let problem = document
                .problem()
                .unwrap_or_else(|e| panic!("{example}/{name}: {e}"));
            let model = problem
                .build(&folder)
                .unwrap_or_else(|e| panic!("{example}/{name}: {e}"));
            let simulation = Simulation::new(model);
            let mut simulation = simulation.unwrap_or_else(|e| panic!("{example}/{name}: {e}"));
            for finding in simulation.check().findings {
                if finding.severity < Severity::Warning {
                    continue;
                }
                match RIGHT.iter().any(|r| r.0 == example && r.1 == finding.cause) {
                    true => said.push((example.clone(), finding.cause)),
                    false => wrong.push(format!("{example}/{name}: {finding}")),
                }
            }
        }
    }
    assert!(cases >= 49, "{cases} cases");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    for (example, cause, why) in RIGHT {
        let found = said.iter().any(|s| s.0 == *example && s.1 == *cause);
        assert!(found, "{example} should be told of {cause}: {why}");
    }
}

//! The table of what goes with what is true: everything in it is tried, and runs or is refused in the words of the table.

use super::law_with_state;
use crate::support;
use stickslip::model::capability::{Feature, Subject, limit};
use stickslip::problem::Problem;
use stickslip::run::Simulation;

/// Keys of the body, and the tables that hold it where it presses on the base.
fn body(subject: Subject) -> (&'static str, String) {
    let held = |set: &str, rest: &str| format!("[support.hold]\nset = \"{set}\"\nx = 0\n{rest}\n");
    let axle = |y: &str| format!("[reference.axle]\npoint = [0.5, {y}]\n");
    let pressed = held("block.top", "y = -1e-3");
    match subject {
        Subject::Linear | Subject::FrictionState => ("", pressed),
        Subject::Free => ("rotation = \"large\"", pressed),
        Subject::Cells => ("rotation = \"corotational\"", pressed),
        Subject::Rigid => ("rigid = true", pressed),
        Subject::RigidFree => ("rigid = true\nrotation = \"large\"", pressed),
        Subject::Axle => {
            let way = "[support.axle]\nset = \"axle\"\nx = 0\ny = -1e-3\nrotation-z = 0\n";
            let tables = axle("1.0") + &held("block.top", "y = 0") + way;
            ("rotation.with = \"axle\"", tables)
        }
        Subject::RigidAxle => {
            let tables = axle("0.5") + &held("axle", "y = -1e-3\nrotation-z = 0");
            ("rigid = true\nrotation.with = \"axle\"", tables)
        }
    }
}

/// What a feature adds to the top of the problem, to the interface and at the end, and the steps.
fn parts(feature: Feature) -> [&'static str; 4] {
    const STEP: &str = "[[step]]\nincrements.fixed = 1\n";
    const BELT: &str = "primary-velocity = [1, 0]";
    let end = |tables: &'static str| ["", "", tables, STEP];
    match feature {
        Feature::Statics | Feature::Axisymmetric => end(""),
        Feature::CycleJumps => [
            "",
            "",
            "",
            "[[step]]\nincrements.fixed = 1\n[[step]]\ncycles = { count = 4, jump = 2 }\nincrements.fixed = 2\n",
        ],
        Feature::Implicit => [
            "",
            "",
            "",
            "[[step]]\nduration = 1e-4\ndynamic = {}\nincrements.fixed = 2\n",
        ],
        Feature::Explicit => [
            "",
            "",
            "",
            "[[step]]\nduration = 1e-4\ndynamic.scheme.central-difference = {}\n",
        ],
        Feature::Steady => [
            "",
            BELT,
            "",
            "[[step]]\nincrements.fixed = 1\n[[step]]\nsteady = {}\nincrements.fixed = 1\n",
        ],
        Feature::Modes => [
            "",
            "",
            "",
            "[[step]]\nincrements.fixed = 1\n[[step]]\nmodes.count = 2\n",
        ],
        Feature::ComplexModes => [
            "",
            BELT,
            "",
            "[[step]]\nsteady = {}\nincrements.fixed = 1\n[[step]]\ncomplex-modes.count = 2\n",
        ],
        Feature::Harmonic => [
            "",
            "",
            "[load.shake]\nset = \"block.right\"\ntraction.value = [1, 0]\n[probe.corner]\nof = \"base\"\npoint = [0, 0]\n",
            "[[step]]\nloads = []\nincrements.fixed = 1\n[[step]]\nharmonic = { loads = [\"shake\"], from = 1, to = 10, points = 3 }\n",
        ],
        Feature::Sparse => ["solver.method = \"sparse\"", "", "", STEP],
        Feature::Condensed => ["solver.method = \"condensed\"", "", "", STEP],
        Feature::Multigrid => ["solver.method = \"multigrid\"", "", "", STEP],
        Feature::Pressure => end("[load.push]\nset = \"block.right\"\npressure.value = 1\n"),
        Feature::Following => {
            end("[load.push]\nset = \"block.right\"\ntraction.value = [1, 0]\nfollow = true\n")
        }
        Feature::Centrifugal => {
            end("[load.spin]\nset = \"block\"\ncentrifugal = { speed = 1, point = [0, 0] }\n")
        }
        Feature::GroundSpring => {
            end("[load.spring]\nset = \"block.right\"\nspring.stiffness = [1, 1]\n")
        }
        Feature::Temperature => end("[temperature.warm]\nset = \"block\"\nuniform.value = 10\n"),
        Feature::InitialTemperature => end(
            "[initial.cold]\nset = \"block\"\ntemperature.uniform.value = 10\n[temperature.warm]\nset = \"base\"\nuniform.value = 10\n",
        ),
        Feature::InitialDisplacement => {
            end("[initial.there]\nset = \"block\"\ndisplacement = [0, 0]\n")
        }
        Feature::PartialSupport => end("[support.side]\nset = \"block.left\"\nx = 0\n"),
        Feature::Coupling => end(
            "[reference.other]\npoint = [2, 0.5]\n[coupling.spread]\ndistributing = { reference = \"other\", set = \"block.right\" }\n[load.push]\nset = \"other\"\nnodal-force.value = [0, -1]\n",
        ),
        Feature::FrictionAxes => end(""),
        Feature::SmallSliding => ["", "kinematics.small-sliding = {}", "", STEP],
        Feature::Tie => ["", "tied = true", "", STEP],
    }
}

/// A block on a base.
fn text(subject: Subject, feature: Feature) -> String {
    let (keys, mut held) = body(subject);
    let [head, joint, tables, steps] = parts(feature);
    let (space, base) = match feature {
        Feature::Axisymmetric => {
            held = held.replace("x = 0\n", "").replace("[0.5,", "[0,");
            ("axisymmetric", "")
        }
        _ => ("plane-strain", "x = 0"),
    };
    let friction = match feature {
        Feature::Tie => "",
        Feature::FrictionAxes => "friction.orthotropic = { mu = [0.3, 0.1], axis = [1, 0] }",
        _ => "friction.coulomb.mu = 0.3",
    };
    let (secondary, primary) = match feature {
        Feature::FrictionAxes => ("base.top", "block.bottom"),
        _ => ("block.bottom", "base.top"),
    };
    format!(
        r#"
format = 1
model.space = "{space}"
quality.gate = "off"
{head}

[body.base]
generate.rectangle = {{ from = [0, -1], to = [3, 0], cells = [6, 2] }}
material = "steel"

[body.block]
generate.rectangle = {{ from = [0, 0], to = [1, 1], cells = [2, 2] }}
material = "steel"
{keys}

[material.steel]
isotropic = {{ young = 1e5, poisson = 0.3, density = 1e-3 }}
expansion = 1e-5

[interface.joint]
secondary = "{secondary}"
primary = "{primary}"
{friction}
{joint}

[support.base]
set = "base.bottom"
{base}
y = 0

{held}
{tables}
{steps}
"#
    )
}

/// Why a problem is refused, if so asked with a friction law that keeps a state; `None` where it is computed to its end.
fn refusal(text: &str, with_state: bool) -> Option<String> {
    let problem = match Problem::from_toml(text, None) {
        Ok(problem) => problem,
        Err(e) => return Some(e.to_string()),
    };
    let built = match with_state {
        true => Simulation::new(law_with_state::setup(&problem)),
        false => support::build(&problem),
    };
    match built {
        Ok(mut simulation) => simulation.run(&mut []).err().map(|e| format!("run: {e}")),
        Err(e) => Some(e.to_string()),
    }
}

#[test]
fn everything_in_the_table_runs_or_is_refused_in_its_words() {
    for &subject in Subject::ALL {
        for &feature in Feature::ALL {
            let with_state = subject == Subject::FrictionState;
            let said = refusal(&text(subject, feature), with_state);
            match limit(subject, feature) {
                None => assert_eq!(said, None, "{subject:?} {feature:?}"),
                Some(limit) => {
                    let said = said.unwrap_or_else(|| panic!("{subject:?} {feature:?}: computed"));
                    assert!(said.contains(limit.why), "{subject:?} {feature:?}: {said}");
                }
            }
        }
    }
}

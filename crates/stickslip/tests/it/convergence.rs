//! Newton's iteration converges quadratically for every normal law × friction law × slip rule × enforcement × kinematics of contact elements; between
//! whole surfaces it gains a factor a step that pressure over modulus says (`mortar.rs`).
//!
//! Soft bodies (strains of per cent) slide over each other by a good part of a facet, so that a wrong or missing derivative shows: in
//! the laws, in the frame, or in the second derivatives of gap and slip.

use crate::support;
use std::fmt::Write;

use rayon::prelude::*;
use stickslip::contact::enforcement::EnforcementModel;
use stickslip::contact::kinematics::KinematicsModel;
use stickslip::contact::law::friction::FrictionModel;
use stickslip::contact::law::normal::NormalModel;
use stickslip::contact::law::slip::{Regularised, SlipModel};
use stickslip::newton::Progress;
use stickslip::problem::{Interface, Problem};
use stickslip::registry::Family;

/// Residuals below this are rounding.
const FLOOR: f64 = 2e-11;
/// Residuals above this are not near the solution yet.
const NEAR: f64 = 1e-4;
/// Smallest order that counts as quadratic. Linear convergence gives 1 whatever its rate. What takes a little off 2 is rounding, and
/// points that approach with a larger constant than the one that shows first.
const ORDER: f64 = 1.5;

/// Press while all points slide one way, turn back so that they stick, slide on.
const COURSE: &str = r#"
[amplitude.press]
table = [[0, 0], [1, 1], [3, 1.1]]

[amplitude.slide]
table = [[0, 0], [1, 0.2], [2, 0.19], [3, 1]]

[[step]]
name = "press"
increments = { initial = 0.5, largest = 0.5 }

[[step]]
name = "back"
increments = { initial = 0.5, largest = 0.5 }

[[step]]
name = "slide"
increments = { initial = 0.5, largest = 0.5 }

[solver]
tolerance = 1e-12
max-iterations = 60
linear.tolerance = 1e-9
"#;

/// A block pressed on a larger one and dragged over it.
const BLOCKS: &str = r#"
format = 1
model.space = "plane-strain"

[body.lower]
generate.rectangle = { from = [-0.02, -0.02], to = [0.06, 0], cells = [4, 1] }
material = "soft"

[body.upper]
generate.rectangle = { from = [0.003, 0], to = [0.017, 0.01], cells = [2, 1] }
material = "soft"

[material.soft.isotropic]
young = 8e9
poisson = 0.3

[interface.joint]
secondary = "upper.bottom"
primary = "lower.top"
discretisation.node-to-facet = {}

[support.base]
set = "lower.bottom"
x = 0
y = 0

[support.down]
set = "upper.top"
y = -3e-4
amplitude = "press"

[support.along]
set = "upper.top"
x = 2e-3
amplitude = "slide"

"#;

/// The same in space, with meshes that do not match and a drag across both.
const BOXES: &str = r#"
format = 1
model.space = "solid"

[body.lower]
generate.box = { from = [-0.02, -0.02, -0.01], to = [0.04, 0.04, 0], cells = [2, 2, 1] }
material = "soft"

[body.upper]
generate.box = { from = [0.012, 0.011, 0], to = [0.018, 0.019, 0.006], cells = [1, 1, 1] }
material = "soft"

[material.soft.isotropic]
young = 8e9
poisson = 0.3

[interface.joint]
secondary = "upper.bottom"
primary = "lower.top"
discretisation.node-to-facet = {}

[support.base]
set = "lower.bottom"
x = 0
y = 0
z = 0

[support.down]
set = "upper.top"
z = -2e-4
amplitude = "press"

[support.along]
set = "upper.top"
x = -1e-3
y = 6e-4
amplitude = "slide"

"#;

/// A block on a rigid cylinder.
const CYLINDER: &str = r#"
format = 1
model.space = "plane-strain"

[body.upper]
generate.rectangle = { from = [-0.005, 0], to = [0.005, 0.01], cells = [2, 1] }
material = "soft"

[material.soft.isotropic]
young = 8e9
poisson = 0.3

[obstacle.floor]
cylinder = { centre = [0.001, -0.03], radius = 0.03 }

[interface.joint]
secondary = "upper.bottom"
primary = "floor"

[support.down]
set = "upper.top"
y = -8e-4
amplitude = "press"

[support.along]
set = "upper.top"
x = 2e-3
amplitude = "slide"
"#;

/// A box on a rigid sphere.
const SPHERE: &str = r#"
format = 1
model.space = "solid"

[body.upper]
generate.box = { from = [-0.004, -0.005, 0], to = [0.006, 0.005, 0.008], cells = [2, 2, 1] }
material = "soft"

[material.soft.isotropic]
young = 8e9
poisson = 0.3

[obstacle.floor]
sphere = { centre = [0, 0, -0.03], radius = 0.03 }

[interface.joint]
secondary = "upper.bottom"
primary = "floor"

[support.down]
set = "upper.top"
z = -8e-4
amplitude = "press"

[support.along]
set = "upper.top"
x = 2e-3
y = -1e-3
amplitude = "slide"
"#;

/// The first sample of every kind.
fn one_of_each<F: Family>() -> Vec<F> {
    let mut out: Vec<F> = Vec::new();
    for sample in F::samples() {
        if out.iter().all(|other| other.kind() != sample.kind()) {
            out.push(sample);
        }
    }
    out
}

/// The slip rules, with a velocity that the slow points stay below and the fast ones exceed.
fn slips() -> Vec<SlipModel> {
    let mut all = one_of_each::<SlipModel>();
    for slip in &mut all {
        if let SlipModel::Regularised(_) = slip {
            *slip = SlipModel::Regularised(Regularised { epsilon: 1e-3 });
        }
    }
    all
}

/// Every combination that the rules of the problem file allow.
fn combinations(
    text: &str,
    normals: &[NormalModel],
    frictions: &[FrictionModel],
    kinematics: &[KinematicsModel],
) -> Vec<Problem> {
    let base = support::problem(&format!("{text}{COURSE}"));
    let mut out = Vec::new();
    for normal in normals {
        for friction in frictions {
            for slip in slips() {
                for enforcement in one_of_each::<EnforcementModel>() {
                    for kinematics in kinematics {
                        let mut problem = base.clone();
                        let joint = joint(&mut problem);
                        joint.normal = normal.clone();
                        joint.friction = friction.clone();
                        joint.slip = slip.clone();
                        joint.enforcement = enforcement.clone();
                        joint.kinematics = kinematics.clone();
                        if problem.check().is_empty() {
                            out.push(problem);
                        }
                    }
                }
            }
        }
    }
    out
}

fn joint(problem: &mut Problem) -> &mut Interface {
    problem
        .interface
        .get_mut("joint")
        .expect("the interface of the text above")
}

fn name(problem: &Problem) -> String {
    let i = &problem.interface["joint"];
    let kinds = [i.normal.kind(), i.friction.kind(), i.slip.kind()];
    let kinds = [&kinds[..], &[i.enforcement.kind(), i.kinematics.kind()]].concat();
    kinds.join(" × ")
}

/// What the iterations of a run say about the order of convergence.
#[derive(Default)]
struct Verdict {
    /// Places at which the order could be told.
    evidence: usize,
    /// Sequences that are not quadratic.
    slow: String,
}

impl Verdict {
    /// The iterations of one equilibrium, and the residual after the last.
    fn judge(&mut self, iterations: &[Progress], end: Option<f64>) {
        let residuals: Vec<f64> = iterations.iter().map(|p| p.residual).chain(end).collect();
        // after each step, whether a point changed its status
        let changed: Vec<bool> = iterations.iter().map(|p| p.tally.changed > 0).collect();
        for k in 0..residuals.len().saturating_sub(1) {
            if changed[k] || residuals[k] <= FLOOR {
                continue;
            }
            // A linear problem is solved in one step, and the last step of any other comes close to that.
            self.evidence += usize::from(residuals[k + 1] <= 1e-4 * residuals[k]);
            if residuals[k + 1] <= FLOOR || residuals[k] > NEAR {
                continue;
            }
            let (Some(last), Some(false)) = (residuals.get(k + 2), changed.get(k + 1)) else {
                continue;
            };
            let rate = residuals[k + 1] / residuals[k];
            self.evidence += 1;
            if rate >= 1.0 || *last > FLOOR.max(residuals[k + 1] * rate.powf(ORDER)) {
                for (i, r) in residuals.iter().enumerate() {
                    let flips = changed.get(i).is_some_and(|&c| c);
                    let _ = write!(self.slow, "  {r:.1e}{}", if flips { " *" } else { "" });
                }
                self.slow.push('\n');
                return;
            }
        }
    }
}

fn examine(problem: &Problem) -> Verdict {
    let mut verdict = Verdict::default();
    let record = match support::run(problem) {
        Ok(record) => record,
        Err(e) => {
            verdict.slow = format!("  {e}\n");
            return verdict;
        }
    };
    for (iterations, row) in &record.increments {
        // Every equilibrium of the increment starts to count from 0 again; only of the last one the final residual is told.
        let mut equilibria: Vec<&[Progress]> = iterations
            .chunk_by(|a, b| b.iteration == a.iteration + 1)
            .collect();
        let last = equilibria.pop();
        for equilibrium in equilibria {
            verdict.judge(equilibrium, None);
        }
        if let Some(last) = last {
            verdict.judge(last, row.get("RESIDUAL"));
        }
    }
    verdict
}

/// All problems converge quadratically, each with something to tell it from.
fn converge(problems: &[Problem]) {
    let verdicts: Vec<Verdict> = problems.par_iter().map(examine).collect();
    let mut failures = String::new();
    for (problem, verdict) in problems.iter().zip(&verdicts) {
        if !verdict.slow.is_empty() {
            let _ = write!(failures, "{}\n{}", name(problem), verdict.slow);
        } else if verdict.evidence < 2 {
            let _ = writeln!(
                failures,
                "{}: nothing to tell the order from",
                name(problem)
            );
        }
    }
    let count = failures.lines().filter(|l| !l.starts_with(' ')).count();
    assert!(
        failures.is_empty(),
        "{count} of {} are not quadratic:\n{failures}",
        problems.len()
    );
}

#[test]
fn bodies_in_the_plane() {
    let problems = combinations(
        BLOCKS,
        &NormalModel::samples(),
        &FrictionModel::samples(),
        &one_of_each::<KinematicsModel>(),
    );
    assert!(problems.len() > 400, "{}", problems.len());
    converge(&problems);
}

#[test]
fn bodies_in_space() {
    // Of the normal laws the exact one and a curved one.
    let mut normals = one_of_each::<NormalModel>();
    normals.retain(|n| matches!(n, NormalModel::Unilateral(_) | NormalModel::MicroContact(_)));
    let problems = combinations(
        BOXES,
        &normals,
        &one_of_each::<FrictionModel>(),
        &one_of_each::<KinematicsModel>(),
    );
    assert!(problems.len() > 80, "{}", problems.len());
    converge(&problems);
}

#[test]
fn rigid_obstacles() {
    for text in [CYLINDER, SPHERE] {
        let problems = combinations(
            text,
            &one_of_each::<NormalModel>(),
            &one_of_each::<FrictionModel>(),
            // The kinematics of an interface concerns bodies only.
            &one_of_each::<KinematicsModel>()[..1],
        );
        assert!(problems.len() > 70, "{}", problems.len());
        converge(&problems);
    }
}

/// Without strain and contact all forces are rounding: there is nothing to converge to but that.
#[test]
fn a_body_on_its_way_to_contact_is_in_equilibrium() {
    let far = CYLINDER
        .replace("[0.001, -0.03]", "[0.001, -0.0305]")
        .replace("y = -8e-4", "y = -4e-4");
    assert_ne!(far, CYLINDER);
    let record = support::run(&support::problem(&format!("{far}{COURSE}")));
    let record = record.unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(record.cutbacks, 0);
    for (iterations, row) in &record.increments {
        assert_eq!(row.get("OPEN"), Some(3.0));
        assert!(iterations.len() <= 2, "{iterations:?}");
    }
}

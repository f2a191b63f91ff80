//! An attempt that is given up leaves no trace: repeating it gives the same bits, and only a commit moves the history on.

use crate::support;
use stickslip::contact::enforcement::EnforcementModel;
use stickslip::contact::interface::{Conditions, History, Interface, InterfaceForce, commit};
use stickslip::contact::kinematics::KinematicsModel;
use stickslip::contact::law::slip::SlipModel;
use stickslip::contact::look;
use stickslip::problem::Problem;
use stickslip::registry::Family;
use stickslip::system::{Assembler, ContactBlock, Force, Stage, State};

const CASE: &str = r#"
format = 1
model.space = "solid"

[body.lower]
generate.box = { from = [0, 0, -0.01], to = [0.03, 0.03, 0], cells = [3, 3, 1] }
material = "steel"

[body.upper]
generate.box = { from = [0.004, 0.003, 0], to = [0.021, 0.023, 0.01], cells = [4, 4, 1] }
material = "steel"

[material.steel.isotropic]
young = 210e9
poisson = 0.3

[interface.joint]
secondary = "upper.bottom"
primary = "lower.top"
friction.coulomb = { mu = 0.3 }

[support.base]
set = "lower.bottom"
x = 0

[[step]]
"#;

/// What an evaluation gives, bit by bit.
#[derive(Debug, PartialEq)]
struct Bits {
    residual: Vec<u64>,
    condensed: Vec<u64>,
    multipliers: u64,
    blocks: Vec<(Vec<usize>, Vec<u64>, Vec<u64>)>,
}

fn bits(values: &[f64]) -> Vec<u64> {
    values.iter().map(|x| x.to_bits()).collect()
}

impl Bits {
    fn of(out: &Assembler) -> Self {
        let block = |b: &ContactBlock| (b.dofs.clone(), bits(&b.tangent()), bits(&b.surrogate));
        Bits {
            residual: bits(&out.residual),
            condensed: bits(&out.condensed),
            multipliers: out.multiplier_residual.to_bits(),
            blocks: out.blocks.iter().map(block).collect(),
        }
    }
}

/// Displacements that press the upper body into the lower one by about `depth`, unevenly, and shift it.
fn state(interface: &Interface, t: f64, depth: f64, shift: [f64; 2]) -> State {
    let dofs = interface.dofs;
    let mut u = vec![0.0; dofs.count()];
    for point in &interface.points {
        for &local in &point.nodes {
            let x = interface.reference[local];
            let node = interface.nodes[local];
            u[dofs.of(node, 0)] = shift[0] * (1.0 + 10.0 * x[1]);
            u[dofs.of(node, 1)] = shift[1] * (1.0 - 20.0 * x[0]);
            u[dofs.of(node, 2)] = -depth * (1.0 + 40.0 * x[0] - 100.0 * x[1]);
        }
    }
    State {
        t,
        u,
        ..State::default()
    }
}

/// One attempt: two evaluations with an increment and a multiplier update in between, as the solver makes them.
fn attempt(interface: &mut Interface, history: &History, from: &State, at: &State) -> [Bits; 3] {
    let conditions = Conditions::default();
    let interface = &mut interface.force(history, &conditions);
    let stage = Stage {
        from,
        at,
        dt: at.t - from.t,
        rate: None,
        frames: None,
    };
    let mut out = Assembler::new(interface.dofs.count());
    let mut evaluate = |interface: &mut InterfaceForce, tangent: bool| {
        out.reset(tangent);
        interface.prepare(&stage);
        interface.assemble(&stage, &mut out).expect("forces");
        Bits::of(&out)
    };
    interface.begin();
    let first = evaluate(interface, true);
    let du: Vec<f64> = at.u.iter().map(|u| 1e-3 * u).collect();
    interface.update_internal(&du, 1.0);
    let second = evaluate(interface, true);
    interface.augment(&stage);
    let third = evaluate(interface, false);
    [first, second, third]
}

fn cases() -> Vec<Problem> {
    let base = support::problem(CASE);
    let mut out = Vec::new();
    for enforcement in EnforcementModel::samples() {
        for kinematics in KinematicsModel::samples() {
            for slip in SlipModel::samples() {
                let mut problem = base.clone();
                let joint = problem.interface.get_mut("joint").expect("in the text");
                joint.enforcement = enforcement.clone();
                joint.kinematics = kinematics.clone();
                joint.slip = slip;
                out.push(problem);
            }
        }
    }
    out
}

#[test]
fn an_attempt_repeated_gives_the_same_bits() {
    for problem in cases() {
        let joint = &problem.interface["joint"];
        let what = format!(
            "{} {} {}",
            joint.enforcement.kind(),
            joint.kinematics.kind(),
            joint.slip.kind()
        );
        let contact = support::build(&problem)
            .unwrap_or_else(|e| panic!("{e}"))
            .run
            .contact;
        let mut interface = contact
            .interfaces
            .into_iter()
            .next()
            .expect("one interface");
        let mut history = interface.first_history();
        let start = state(&interface, 0.0, 0.0, [0.0; 2]);
        let pressed = state(&interface, 1.0, 1e-6, [2e-7, 1e-7]);
        attempt(&mut interface, &history, &start, &pressed);
        let stage = Stage {
            from: &start,
            at: &pressed,
            dt: 1.0,
            rate: None,
            frames: None,
        };
        history = commit(
            &mut interface.force(&history, &Conditions::default()),
            &stage,
        );
        let energy = look::energy(interface.view(&history));

        let slid = state(&interface, 2.0, 1.5e-6, [3e-3, -2e-3]);
        let first = attempt(&mut interface, &history, &pressed, &slid);
        assert!(
            first[0].blocks.len() > 10 && first[0].residual.iter().any(|&r| r != 0),
            "{what}: no contact"
        );
        // Far away, onto other facets, off the surface altogether, and back.
        for (depth, shift) in [(4e-6, [9e-3, 8e-3]), (-1e-3, [0.0; 2]), (2e-6, [0.1, 0.1])] {
            let wild = state(&interface, 1.7, depth, shift);
            attempt(&mut interface, &history, &pressed, &wild);
        }
        let again = attempt(&mut interface, &history, &pressed, &slid);
        assert_eq!(first, again, "{what}: an attempt left a trace");
        assert_eq!(
            look::energy(interface.view(&history)).dissipated,
            energy.dissipated,
            "{what}"
        );
        assert_eq!(
            look::energy(interface.view(&history)).work,
            energy.work,
            "{what}"
        );

        let stage = Stage {
            from: &pressed,
            at: &slid,
            dt: 1.0,
            rate: None,
            frames: None,
        };
        history = commit(
            &mut interface.force(&history, &Conditions::default()),
            &stage,
        );
        assert!(
            look::energy(interface.view(&history)).dissipated > energy.dissipated,
            "{what}"
        );
        let after = attempt(&mut interface, &history, &pressed, &slid);
        if joint.slip == SlipModel::samples()[0] {
            assert_ne!(first, after, "{what}: a commit changed nothing");
        }
    }
}

/// A run some of whose increments are refused ends where a run over the accepted ones ends.
#[test]
fn a_run_with_cutbacks_ends_like_one_without() {
    let text = CASE.replace("[[step]]", "") + DRIVE;
    let run = |change: Option<f64>, times: &[f64]| {
        let mut problem = support::problem(&text);
        problem.solver.largest_change = change;
        problem.output.times = times.to_vec();
        let mut record = support::Record::default();
        let mut simulation = support::build(&problem).unwrap_or_else(|e| panic!("{e}"));
        simulation
            .run(&mut [&mut record])
            .unwrap_or_else(|e| panic!("{e}"));
        let times: Vec<f64> = record
            .increments
            .iter()
            .filter_map(|(_, row)| row.get("TIME"))
            .collect();
        (simulation, record.cutbacks, times)
    };
    let (with, cutbacks, times) = run(Some(5e-5), &[]);
    assert!(cutbacks > 1, "nothing was cut");
    let (without, cutbacks, same) = run(None, &times);
    assert_eq!((cutbacks, &same), (0, &times));
    let size = with
        .frame
        .state
        .u
        .iter()
        .fold(0.0_f64, |m, u| m.max(u.abs()));
    for (a, b) in with.frame.state.u.iter().zip(&without.frame.state.u) {
        assert!((a - b).abs() <= 1e-9 * size, "{a} {b}");
    }
    let friction = [&with, &without].map(|s| s.summary.balance.energy.friction);
    assert!(friction[0] > 0.0, "nothing slid");
    assert!(
        (friction[0] / friction[1] - 1.0).abs() < 1e-8,
        "{friction:?}"
    );
}

/// Where increments go on as they did, so does the guess of the next one, whether fields are written there or not.
#[test]
fn times_of_output_change_no_digit() {
    for method in ["condensed", "sparse"] {
        let text = (CASE.replace("[[step]]", "") + DRIVE)
            .replace("[solver]", &format!("[solver]\nmethod = \"{method}\""))
            .replace("increments.initial = 1.0", "increments.fixed = 8");
        let run = |times: &[f64]| {
            let mut problem = support::problem(&text);
            problem.output.times = times.to_vec();
            let record = support::run(&problem).unwrap_or_else(|e| panic!("{e}"));
            let numbers = record.increments.into_iter().map(|(_, row)| {
                let columns = ["TIME", "ITRS", "RESIDUAL", "joint.CFS1", "ALLSE"];
                columns.map(|c| row.get(c).expect("a column").to_bits())
            });
            numbers.collect::<Vec<_>>()
        };
        let plain = run(&[]);
        let times: Vec<f64> = plain.iter().map(|row| f64::from_bits(row[0])).collect();
        assert!(times.len() > 4, "{method}: {times:?}");
        assert_eq!(run(&times), plain, "{method}");
    }
}

const DRIVE: &str = r#"
[support.hold]
set = "lower.bottom"
y = 0
z = 0

[support.press]
set = "upper.top"
x = 1e-5
y = 0
z = -4e-6

[solver]
tolerance = 1e-12

[[step]]
name = "press and slide"
increments.initial = 1.0
"#;

#[test]
fn every_enforcement_and_kinematics_is_covered() {
    let kinds =
        EnforcementModel::KINDS.len() * KinematicsModel::KINDS.len() * SlipModel::KINDS.len();
    assert!(cases().len() >= kinds);
}

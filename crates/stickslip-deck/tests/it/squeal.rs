//! Decks of brake squeal: pressing, `*MOTION` and `*CHANGE FRICTION`, `*FREQUENCY`, `*COMPLEX FREQUENCY`.

use std::fmt::Write;
use std::path::Path;

use crate::support::{place, refused, translate};
use stickslip::modal::ModalOutcome;
use stickslip::problem::Problem;
use stickslip::run::Simulation;

/// A grid of plane cells; nodes and elements are numbered from `first`, row by row.
fn grid(name: &str, first: usize, from: [f64; 2], to: [f64; 2], cells: [usize; 2]) -> String {
    let mut text = format!("*NODE, NSET=N{name}\n");
    let [nx, ny] = cells;
    for k in 0..(nx + 1) * (ny + 1) {
        let at = [k % (nx + 1), k / (nx + 1)];
        let x: [f64; 2] =
            std::array::from_fn(|i| from[i] + (to[i] - from[i]) * at[i] as f64 / cells[i] as f64);
        let _ = writeln!(text, "{}, {:?}, {:?}, 0.", first + k, x[0], x[1]);
    }
    let _ = writeln!(text, "*ELEMENT, TYPE=CPE4, ELSET={name}");
    for k in 0..nx * ny {
        let a = first + k % nx + k / nx * (nx + 1);
        let _ = writeln!(
            text,
            "{}, {a}, {}, {}, {}",
            first + k,
            a + 1,
            a + nx + 2,
            a + nx + 1
        );
    }
    text
}

/// A pad on a block that slides beneath it.
fn pad(steps: &str) -> String {
    let block = grid("BLOCK", 1, [0.0, 0.0], [4.0, 1.0], [8, 2]);
    let pad = grid("PAD", 101, [1.0, 1.0], [3.0, 2.0], [4, 2]);
    format!(
        "{block}{pad}*NSET, NSET=BASE, GENERATE\n1, 9, 1\n*NSET, NSET=BACK, GENERATE\n111, 115, 1\n\
         *ELSET, ELSET=ETOP, GENERATE\n9, 16, 1\n*ELSET, ELSET=EBOTTOM, GENERATE\n101, 104, 1\n*ELSET, ELSET=EBACK, GENERATE\n105, 108, 1\n\
         *SURFACE, NAME=TOP\nETOP, S3\n*SURFACE, NAME=BOTTOM\nEBOTTOM, S1\n\
         *MATERIAL, NAME=M\n*ELASTIC\n1e4, .3\n*DENSITY\n1.\n\
         *SOLID SECTION, ELSET=BLOCK, MATERIAL=M\n*SOLID SECTION, ELSET=PAD, MATERIAL=M\n\
         *SURFACE INTERACTION, NAME=RUB\n*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n1e5\n*FRICTION\n0.\n\
         *CONTACT PAIR, INTERACTION=RUB, TYPE=SURFACE TO SURFACE\nBOTTOM, TOP\n\
         *BOUNDARY\nBASE, 1, 2\nBACK, 1\n\
         *STEP\n*STATIC\n*DLOAD\nEBACK, P3, 10.\n*END STEP\n{steps}"
    )
}

/// The step of steady sliding and those behind it.
fn sliding(motion: &str, complex: &str) -> String {
    format!(
        "*STEP, UNSYMM=YES\n*STATIC\n*CHANGE FRICTION, INTERACTION=RUB\n*FRICTION\n.4\n*MOTION, TYPE=VELOCITY{motion}*END STEP\n\
         *STEP, PERTURBATION\n*FREQUENCY\n8\n*END STEP\n*STEP, PERTURBATION, UNSYMM=YES\n*COMPLEX FREQUENCY{complex}*END STEP\n"
    )
}

/// The same as a problem file, of which a velocity of the belt moves the block from the start.
fn same(damping: bool) -> String {
    format!(
        r#"
format = 1
model.space = "plane-strain"
body.block = {{ generate.rectangle = {{ to = [4, 1], cells = [8, 2] }}, material = "m" }}
body.pad = {{ generate.rectangle = {{ from = [1, 1], to = [3, 2], cells = [4, 2] }}, material = "m" }}
material.m.isotropic = {{ young = 1e4, poisson = 0.3, density = 1.0 }}
interface.rub = {{ secondary = "pad.bottom", primary = "block.top", roles = "as-named", normal.linear = {{ c = 1e5 }}, friction.coulomb = {{ mu = 0.4 }}, primary-velocity = [2, 0] }}
support.base = {{ set = "block.bottom", x = 0, y = 0 }}
support.back = {{ set = "pad.top", x = 0 }}
load.press = {{ set = "pad.top", pressure = {{ value = 10 }} }}
[[step]]
steady = {{}}
[[step]]
complex-modes = {{ count = 8, friction-damping = {damping} }}
"#
    )
}

fn last_modes(mut simulation: Simulation) -> ModalOutcome {
    simulation.run(&mut []).unwrap_or_else(|e| panic!("{e}"));
    simulation.run.modes.pop().expect("modes")
}

fn of_deck(text: &str) -> ModalOutcome {
    let translation = translate(text);
    let problem = translation.document(Vec::new()).problem();
    let problem = problem.unwrap_or_else(|e| panic!("{e}\n{}", translation.toml));
    let setup = problem.build_with(&place(""), &translation.meshes());
    let setup = setup.unwrap_or_else(|e| panic!("{e}"));
    last_modes(Simulation::new(setup).expect("a simulation"))
}

fn of_file(text: &str) -> ModalOutcome {
    let problem = Problem::from_toml(text, None).unwrap_or_else(|e| panic!("{e}"));
    let setup = problem
        .build(Path::new("."))
        .unwrap_or_else(|e| panic!("{e}"));
    last_modes(Simulation::new(setup).expect("a simulation"))
}

/// The largest difference of eigenvalues, relative to their size.
fn apart(a: &ModalOutcome, b: &ModalOutcome) -> f64 {
    assert_eq!(a.modes.len(), 8);
    assert_eq!(b.modes.len(), 8);
    let differences = a.modes.iter().zip(&b.modes).map(|(a, b)| {
        let omega = std::f64::consts::TAU * a.frequency;
        let by = std::f64::consts::TAU * (a.frequency - b.frequency);
        by.hypot(a.growth - b.growth) / omega.hypot(a.growth)
    });
    differences.fold(0.0, f64::max)
}

#[test]
fn complex_modes_of_a_deck_are_those_of_the_same_problem_file() {
    let file = of_file(&same(true));
    // Friction does something: pressures depend on it, and so do motions.
    let smooth = of_file(&same(true).replace("mu = 0.4", "mu = 0.0"));
    assert!(apart(&file, &smooth) > 1e-3, "{:e}", apart(&file, &smooth));
    // The block moves to the right, or the pad to the left.
    for motion in [
        ", TRANSLATION\nNBLOCK, 1, 1, 2.\n",
        "\nNPAD, 1, , -2.\nNBLOCK, 2, 2, 0.\n",
    ] {
        let deck = of_deck(&pad(&sliding(motion, ", FRICTION DAMPING=YES\n")));
        assert_eq!(deck.points, file.points);
        let apart = apart(&deck, &file);
        assert!(apart < 1e-9, "{motion}: {apart:e}");
    }
    // About an axis far below, the surface moves along; 1e6 away, to 1e-6 alike.
    let turning = ", ROTATION\nNBLOCK, -2e-6, 2., -999999.\n";
    let deck = of_deck(&pad(&sliding(turning, ", FRICTION DAMPING=YES\n8\n")));
    let apart = apart(&deck, &file);
    assert!(apart < 1e-5, "{apart:e}");
}

#[test]
fn friction_does_not_damp_unless_the_deck_says_so() {
    let motion = ", TRANSLATION\nNBLOCK, 1, 1, 2.\n";
    let deck = of_deck(&pad(&sliding(motion, "\n")));
    let [with, without] = [true, false].map(|damping| of_file(&same(damping)));
    assert!(apart(&deck, &without) < 1e-9);
    // Coulomb's law in a plane damps nothing either: there is no direction across, and no slope over the speed.
    assert!(apart(&with, &without) < 1e-9);
}

#[test]
fn what_steps_of_squeal_cannot_say_is_refused() {
    let motion = ", TRANSLATION\nNBLOCK, 1, 1, 2.\n";
    for (motion, complex, words) in [
        (motion, ", CORIOLIS\n", "gyroscopic"),
        (motion, "\n8, 100.\n", "from the lowest frequency on"),
        (motion, ", FRICTION DAMPING=MAYBE\n", "YES or NO"),
        (
            motion,
            "\n8\n*MOTION, TYPE=VELOCITY\nNBLOCK, 1, 1, 2.\n",
            "nothing moves in a step",
        ),
        (
            ", TRANSLATION\n19, 1, 1, 2.\n",
            "\n",
            "all nodes of the surface TOP alike",
        ),
        (", TRANSLATION\nNOWHERE, 1, 1, 2.\n", "\n", "set of nodes"),
        (
            ", ROTATION, TRANSLATION\nNBLOCK, 1, 1, 2.\n",
            "\n",
            "not both",
        ),
        (
            ", ROTATION\nNBLOCK, 1., 0., 0., 0., 0., 0., 0.\n",
            "\n",
            "no length",
        ),
        (
            ", AMPLITUDE=A\nNBLOCK, 1, 1, 2.\n",
            "\n",
            "leave AMPLITUDE out",
        ),
    ] {
        let said = refused(&pad(&sliding(motion, complex)));
        assert!(said.contains(words), "{motion}{complex}: {said}");
    }
    let displaced = sliding(motion, "\n").replace("TYPE=VELOCITY", "TYPE=DISPLACEMENT");
    assert!(refused(&pad(&displaced)).contains("write TYPE=VELOCITY"));
    let alone = "*STEP\n*COMPLEX FREQUENCY\n*END STEP\n";
    assert!(refused(&pad(alone)).contains("how many modes"));
    let still = translate(&pad("*STEP\n*COMPLEX FREQUENCY\n3\n*END STEP\n"));
    assert!(
        still
            .notes
            .iter()
            .any(|n| n.message.contains("which way surfaces slide"))
    );
}

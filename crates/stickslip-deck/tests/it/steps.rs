//! Steps: how values go from one to the next, amplitudes, dynamics, and when something is printed.

use stickslip::Error;
use stickslip::results::{Analysis, Event, Observer};

use crate::support::{
    column, cube, near, pair, place, refused, run, run_before, sections, translate,
};

/// A rod with E A = 1000 and length 1 through these steps; the displacement of its end.
fn rod(name: &str, steps: &str) -> Vec<(f64, f64)> {
    let text = format!("{}*NSET, NSET=END\n7\n{steps}", column());
    run(name, &text).course("displacements", 3)
}

/// Compares with pairs of time and displacement in thousandths.
#[track_caller]
fn is(course: &[(f64, f64)], wanted: &[(f64, f64)]) {
    let close =
        |a: &(f64, f64), b: &(f64, f64)| (a.0 - b.0).abs() < 1e-6 && (1e3 * a.1 - b.1).abs() < 1e-4;
    assert!(
        course.len() == wanted.len() && course.iter().zip(wanted).all(|(a, b)| close(a, b)),
        "{course:?} is not {wanted:?}"
    );
}

const PRINT: &str = "*NODE PRINT, NSET=END\nU\n*END STEP\n";

#[test]
fn forces_stay_until_they_are_changed_or_cleared() {
    // Each node of the end has a quarter. CalculiX 2.20 gives the same: values go linearly from one step to the next.
    let steps = format!(
        "*STEP\n*STATIC, DIRECT\n.5, 1.\n*CLOAD\nNTOP, 3, 1.\n{PRINT}\
         *STEP\n*STATIC, DIRECT\n.5, 1.\n*CLOAD\nNTOP, 3, 2.\n{PRINT}\
         *STEP\n*STATIC, DIRECT\n.5, 1.\n*CLOAD, OP=MOD\n*DLOAD\nEN, P2, 4.\n{PRINT}\
         *STEP\n*STATIC, DIRECT\n.5, 1.\n*CLOAD, OP=NEW\n*DLOAD, OP=NEW\n{PRINT}"
    );
    let wanted = [2.0, 4.0, 6.0, 8.0, 6.0, 4.0, 2.0, 0.0];
    let wanted: Vec<(f64, f64)> = (1..).map(|i| 0.5 * i as f64).zip(wanted).collect();
    is(&rod("op", &steps), &wanted);
}

#[test]
fn new_counts_on_the_first_card_of_a_step() {
    // Two cards with OP=NEW, as PrePoMax writes them, keep what both say.
    let steps = format!(
        "*STEP\n*STATIC\n*CLOAD\nNTOP, 3, 9.\n*END STEP\n\
         *STEP\n*STATIC\n*BOUNDARY, OP=NEW\n*BOUNDARY, OP=NEW\nN, 1, 2\n*BOUNDARY, OP=NEW\nNBOT, 3\n\
         *CLOAD, OP=NEW\n5, 3, 1.\n6, 3, 1.\n*CLOAD, OP=NEW\n7, 3, 1.\n8, 3, 1.\n{PRINT}"
    );
    is(&rod("op-new", &steps), &[(2.0, 4.0)]);
}

#[test]
fn several_forces_on_a_node_add_up() {
    let steps =
        format!("*STEP\n*STATIC\n*CLOAD\nNTOP, 3, 1.\n7, 3, .5\nNTOP, 3, 1.\n7, 3, -.5\n{PRINT}");
    is(&rod("sum", &steps), &[(1.0, 8.0)]);
}

#[test]
fn prescribed_displacements_stay_are_replaced_or_let_go() {
    let steps = format!(
        "*STEP\n*STATIC, DIRECT\n.5, 1.\n*BOUNDARY\nNTOP, 3, 3, .004\n{PRINT}\
         *STEP\n*STATIC, DIRECT\n.5, 1.\n{PRINT}\
         *STEP\n*STATIC, DIRECT\n.5, 1.\n*BOUNDARY\nNTOP, 3, 3, -.002\n{PRINT}\
         *STEP\n*STATIC, DIRECT\n.5, 1.\n*BOUNDARY, OP=NEW\nN, 1, 2\nNBOT, 3\nNTOP, 3, 3, 0.\n{PRINT}"
    );
    let wanted = [2.0, 4.0, 4.0, 4.0, 1.0, -2.0, -1.0, 0.0];
    let wanted: Vec<(f64, f64)> = (1..).map(|i| 0.5 * i as f64).zip(wanted).collect();
    is(&rod("boundary", &steps), &wanted);
}

#[test]
fn fixed_holds_where_things_are() {
    let steps = format!(
        "*STEP\n*STATIC\n*CLOAD\nNTOP, 3, 1.\n*END STEP\n\
         *STEP\n*STATIC\n*BOUNDARY, FIXED\nNTOP, 3\n*CLOAD, OP=NEW\n{PRINT}"
    );
    is(&rod("fixed", &steps), &[(2.0, 4.0)]);
}

#[test]
fn amplitudes_run_over_the_time_of_the_step_or_of_the_analysis() {
    let steps = |amplitude: &str| {
        format!(
            "*AMPLITUDE, NAME=A{amplitude}\n0., 0., .5, 2., 1.5, 2.,\n2., 1.\n\
             *STEP\n*STATIC, DIRECT\n.25, 1.\n*CLOAD, AMPLITUDE=A\nNTOP, 3, 1.\n{PRINT}\
             *STEP\n*STATIC, DIRECT\n.5, 1.\n*CLOAD, AMPLITUDE=A\nNTOP, 3, 2.\n{PRINT}"
        )
    };
    let times = [0.25, 0.5, 0.75, 1.0, 1.5, 2.0];
    let course = |values: [f64; 6]| -> Vec<(f64, f64)> { times.into_iter().zip(values).collect() };
    is(
        &rod("amplitude-step", &steps("")),
        &course([4.0, 8.0, 8.0, 8.0, 16.0, 16.0]),
    );
    is(
        &rod("amplitude-total", &steps(", TIME=TOTAL TIME")),
        &course([4.0, 8.0, 8.0, 8.0, 16.0, 8.0]),
    );
}

#[test]
fn an_amplitude_of_a_step_that_is_over_leaves_its_last_value() {
    // A step that only keeps what the one before gave does not run through the amplitude again; CalculiX 2.20 gives the same.
    let table = "0., 0., .5, 1., 1., .25";
    let step = |card: &str| format!("*STEP\n*STATIC, DIRECT\n.5, 1.\n{card}{PRINT}");
    for (name, card, line) in [
        ("force", "*CLOAD", "NTOP, 3, 1."),
        ("moved", "*BOUNDARY", "NTOP, 3, 3, .004"),
        ("pressed", "*DLOAD", "EN, P2, -4."),
        ("weight", "*DLOAD", "EN, GRAV, 8., 0., 0., 1."),
        ("volume", "*DLOAD", "EN, BZ, 8."),
    ] {
        let steps = format!(
            "*AMPLITUDE, NAME=A\n{table}\n{}{}{}",
            step(&format!("{card}, AMPLITUDE=A\n{line}\n")),
            step(""),
            step(&format!("{card}\n{line}\n"))
        );
        let wanted = [4.0, 1.0, 1.0, 1.0, 2.5, 4.0];
        let wanted: Vec<(f64, f64)> = (1..).map(|i| 0.5 * i as f64).zip(wanted).collect();
        is(&rod(&format!("over-{name}"), &steps), &wanted);
    }
    // Given anew, or over the time of the analysis, it goes on.
    let again = format!(
        "*AMPLITUDE, NAME=A\n{table}\n{}{}",
        step("*CLOAD, AMPLITUDE=A\nNTOP, 3, 1.\n"),
        step("*CLOAD, AMPLITUDE=A\nNTOP, 3, 1.\n")
    );
    is(
        &rod("over-again", &again),
        &[(0.5, 4.0), (1.0, 1.0), (1.5, 4.0), (2.0, 1.0)],
    );
    let total = format!(
        "*AMPLITUDE, NAME=A, TIME=TOTAL TIME\n0., 0., 2., 1.\n{}{}",
        step("*CLOAD, AMPLITUDE=A\nNTOP, 3, 1.\n"),
        step("")
    );
    is(
        &rod("over-total", &total),
        &[(0.5, 1.0), (1.0, 2.0), (1.5, 3.0), (2.0, 4.0)],
    );
}

#[test]
fn displacements_that_would_jump_in_a_dynamic_step_are_refused() {
    let text = |step: &str, amplitude: &str| {
        format!(
            "{}*AMPLITUDE, NAME=A\n0., 0., 1., 1.\n*STEP{step}\n*DYNAMIC, DIRECT\n.01, .1\n*BOUNDARY{amplitude}\nNTOP, 3, 3, .01\n*END STEP\n",
            column()
        )
    };
    let message = refused(&text("", ""));
    assert!(
        message.contains("job.inp:23: error: what is prescribed here jumps"),
        "{message}"
    );
    assert!(refused(&text(", AMPLITUDE=STEP", "")).contains("jumps"));
    translate(&text("", ", AMPLITUDE=A"));
    let grows = run(
        "dynamic-ramp",
        &text(", AMPLITUDE=RAMP", "").replace("*END", "*NODE PRINT, NSET=NTOP\nU\n*END"),
    );
    near(grows.course("displacements", 3)[0].1, 1e-3, 1e-9);
    // What a step before has moved stays.
    let stays = text("", "").replace(
        "*STEP\n*DYNAMIC",
        "*STEP\n*STATIC\n*BOUNDARY\nNTOP, 3, 3, .01\n*END STEP\n*STEP\n*DYNAMIC",
    );
    translate(&stays);
}

#[test]
fn what_is_printed_goes_on_until_cards_of_its_kind_say_otherwise() {
    let step = |cards: &str| format!("*STEP\n*STATIC\n*CLOAD\nNTOP, 3, 1.\n{cards}*END STEP\n");
    let steps = [
        "*NODE PRINT, NSET=N\nU\n*EL PRINT, ELSET=EN\nS\n",
        "",
        "*NODE PRINT, NSET=NTOP\nRF\n",
        "*EL PRINT, ELSET=EN, FREQUENCY=0\nS\n",
    ];
    let steps: String = steps.iter().map(|s| step(s)).collect();
    let r = run("prints-go-on", &format!("{}{steps}", column()));
    let times = |title: &str| -> Vec<f64> { r.all(title).iter().map(|b| b.1).collect() };
    assert_eq!(times("displacements"), [1.0, 2.0]);
    assert_eq!(times("forces"), [3.0, 4.0]);
    assert_eq!(times("stresses"), [1.0, 2.0, 3.0]);
}

#[test]
fn what_is_written_to_the_frd_file_goes_on_until_cards_of_its_kind_say_otherwise() {
    use stickslip::results::{Due, Quantity, Request};
    let step = |cards: &str| format!("*STEP\n*STATIC\n*CLOAD\nNTOP, 3, 1.\n{cards}*END STEP\n");
    let steps = [
        "*NODE FILE\nU, RF, NT, RFL\n*EL FILE, FREQUENCY=3\nS\nE\n",
        "",
        "*EL FILE\nENER\n*EL FILE, FREQUENCY=0\nS\n*CONTACT FILE\nCSTR, CDIS\n",
    ];
    let steps: String = steps.iter().map(|s| step(s)).collect();
    let deck = translate(&format!("{}{steps}", column()));
    let plan = deck.frd("job");
    assert_eq!(plan.name, "job.frd");
    let request = |quantities: &[Quantity], n| Request {
        quantities: quantities.to_vec(),
        due: Due::Every(n),
    };
    use Quantity::{Contact, Displacement, Energy, Force, Strain, Stress, Temperature};
    let nodes = request(&[Displacement, Force, Temperature], 1);
    let first = vec![nodes.clone(), request(&[Stress, Strain], 3)];
    let last = vec![
        nodes,
        request(&[Energy], 1),
        request(&[Contact, Contact], 1),
    ];
    assert_eq!(plan.steps, Some(vec![first.clone(), first, last]));
    assert!(deck.toml.contains("frd = \"text\""), "{}", deck.toml);
    let noted = deck.notes.iter().filter(|n| n.message.contains(".frd"));
    let noted: Vec<&str> = noted.map(|n| n.message.as_str()).collect();
    assert_eq!(
        noted,
        ["*NODE FILE: RFL is left out: it is not written to the .frd file"]
    );
}

#[test]
fn cards_with_output_ask_for_a_binary_frd_file_unless_they_are_abaqus_s() {
    use stickslip::results::Quantity::{Displacement, Force, Strain, Stress};
    let read = |cards: &str| {
        let step = format!("*STEP\n*STATIC\n*CLOAD\nNTOP, 3, 1.\n{cards}*END STEP\n");
        translate(&format!("{}{step}", column()))
    };
    let of = |cards: &str| {
        let steps = read(cards).frd("job").steps.unwrap_or_default();
        let all = steps.into_iter().flatten();
        all.flat_map(|r| r.quantities).collect::<Vec<_>>()
    };
    assert!(read("*NODE OUTPUT\nU\n").toml.contains("frd = \"binary\""));
    let fields = "*OUTPUT, FIELD\n*NODE OUTPUT\nU\n*ELEMENT OUTPUT, VARIABLE=PRESELECT\n";
    assert!(read(fields).toml.contains("frd = \"text\""));
    assert_eq!(of(fields), [Displacement, Stress, Strain]);
    let history = "*OUTPUT, HISTORY\n*NODE OUTPUT, NSET=N\nRF\n";
    assert!(!read(history).toml.contains("frd"));
    assert_eq!(of(history), []);
    assert_eq!(of("*NODE FILE\nRF\n"), [Force]);
}

#[test]
fn time_points_and_frequencies_say_when_something_is_printed() {
    let steps = "*TIME POINTS, NAME=T, GENERATE\n.25, .75, .5\n*STEP\n*STATIC, DIRECT\n.125, 1.\n*CLOAD\nNTOP, 3, 1.\n\
                 *NODE PRINT, NSET=END, TIME POINTS=T\nU\n*END STEP\n";
    is(
        &rod("time-points", steps),
        &[(0.25, 1.0), (0.75, 3.0), (1.0, 4.0)],
    );
    let steps = "*STEP\n*STATIC, DIRECT\n.125, 1.\n*CLOAD\nNTOP, 3, 1.\n*NODE PRINT, NSET=END, FREQUENCY=3\nU\n\
                 *EL PRINT, ELSET=EN, FREQUENCY=2, TOTALS=ONLY\nEVOL\n*NODE PRINT, NSET=N, FREQUENCY=0\nV\n*END STEP\n";
    let r = run(
        "frequency",
        &format!("{}*NSET, NSET=END\n7\n{steps}", column()),
    );
    is(
        &r.course("displacements", 3),
        &[(0.375, 1.5), (0.75, 3.0), (1.0, 4.0)],
    );
    assert_eq!(r.all("total volume").len(), 4);
    assert!(r.all("velocities").is_empty());
}

#[test]
fn bodies_fly_from_their_initial_velocity() {
    let free = |procedure: &str| {
        format!(
            "{}{}*INITIAL CONDITIONS, TYPE=VELOCITY\nN, 3, 2.\nN, 1, -1.\n*STEP\n*DYNAMIC{procedure}\n*NODE PRINT, NSET=NTOP\nU, V\n*END STEP\n",
            cube("N", 1, 0.0),
            sections(&["EN"])
        )
    };
    for (name, procedure) in [
        ("implicit", "\n.1, .5"),
        ("direct", ", DIRECT\n.1, .5"),
        ("alpha", ", ALPHA=-.1\n.1, .5"),
        ("explicit", ", EXPLICIT\n.1, .5"),
    ] {
        let r = run(&format!("fly-{name}"), &free(procedure));
        near(r.u(7)[2], 1.0, 1e-6);
        near(r.u(7)[0], -0.5, 1e-6);
        near(r.last("velocities")[3], 2.0, 1e-6);
    }
}

#[test]
fn masses_swing_on_springs() {
    // Eight springs of 12.5 and eight masses of 0.375 beside the cube of mass 1: omega² = 100 / 4, u = v / omega sin(omega t).
    let elements = |from: u64| {
        (1..9)
            .map(|n| format!("{}, {n}\n", from + n))
            .collect::<String>()
    };
    let text = format!(
        "{}{}*ELEMENT, TYPE=SPRING1, ELSET=SP\n{}*SPRING, ELSET=SP\n3\n12.5\n*ELEMENT, TYPE=MASS, ELSET=MA\n{}*MASS, ELSET=MA\n.375\n\
         *BOUNDARY\nN, 1, 2\n*INITIAL CONDITIONS, TYPE=VELOCITY\nN, 3, 1.\n*STEP, INC=1000\n*DYNAMIC, DIRECT, ALPHA=0.\n.002, .3141592653589793\n\
         *NODE PRINT, NSET=N, FREQUENCY=1000\nU\n*END STEP\n",
        cube("N", 1, 0.0),
        sections(&["EN"]),
        elements(100),
        elements(200)
    );
    near(run("swing", &text).u(7)[2], 0.2, 1e-3);
}

#[test]
fn loads_act_at_once_in_dynamic_steps() {
    // A free cube under a constant force of 4: u = 2 t².
    let text = format!(
        "{}{}*STEP\n*DYNAMIC, DIRECT\n.01, .1\n*CLOAD\nN, 3, .5\n*NODE PRINT, NSET=N\nU\n*END STEP\n",
        cube("N", 1, 0.0),
        sections(&["EN"])
    );
    near(run("at-once", &text).u(7)[2], 0.02, 2e-2);
}

#[test]
fn what_a_step_says_of_its_increments_is_kept() {
    let toml = translate(&format!(
        "{}*STEP, INC=50\n*STATIC\n.1, 2., 1.E-3, .5\n*CLOAD\n7, 3, 1.\n*END STEP\n",
        column()
    ))
    .toml;
    for wanted in [
        "duration = 2.0",
        "initial = 0.05",
        "smallest = 0.0005",
        "largest = 0.25",
    ] {
        assert!(toml.contains(wanted), "{toml}");
    }
}

#[test]
fn forces_in_motion_are_those_of_the_elements() {
    // Free in space under gravity nothing is strained, and CalculiX 2.20 prints zeros at all nodes.
    for procedure in [", DIRECT\n.01, .05", ", EXPLICIT\n.01, .05"] {
        let text = format!(
            "{}{}*STEP\n*DYNAMIC{procedure}\n*DLOAD\nEN, GRAV, 8., 0., 0., -1.\n*NODE PRINT, NSET=N, TOTALS=YES\nRF\n*END STEP\n",
            cube("N", 1, 0.0),
            sections(&["EN"])
        );
        let run = run("free-forces", &text);
        for title in ["forces", "total force"] {
            for (_, time, rows) in run.all(title) {
                for v in rows.iter().flat_map(|r| &r[r.len() - 3..]) {
                    assert!(v.abs() < 1e-9, "{procedure}, {title} at {time}: {v}");
                }
            }
        }
    }
    // A rod held at one end: the stretch times its stiffness at both, at every time.
    let steps = "*STEP\n*DYNAMIC, DIRECT\n.01, .05\n*CLOAD\nNTOP, 3, 2.\n*NODE PRINT, NSET=N\nU, RF\n*END STEP\n";
    let run = run("rod-forces", &format!("{}{steps}", column()));
    for (u, f) in run.all("displacements").iter().zip(run.all("forces")) {
        let stretch = u.2[7][3];
        assert!(stretch > 0.0, "{stretch}");
        for (node, row) in f.2.iter().enumerate() {
            let side = if node < 4 { -1.0 } else { 1.0 };
            let wanted = side * 250.0 * stretch;
            assert!(
                (row[3] / wanted - 1.0).abs() < 1e-5,
                "node {node}: {} is not {wanted}",
                row[3]
            );
        }
    }
}

/// Another process that looks into the files of a run.
#[derive(Default)]
struct Reader {
    increments: usize,
    outputs: usize,
}

impl Observer for Reader {
    fn see(&mut self, _: &Analysis, event: Event) -> Result<(), Error> {
        let count = |name: &str, is: fn(&str) -> bool| {
            let text = std::fs::read_to_string(place(name)).unwrap_or_default();
            text.lines().filter(|line| is(line)).count()
        };
        match event {
            Event::Increment(_) => {
                self.increments += 1;
                let rows = count("grows.sta", |line| {
                    line.trim_start().starts_with(|c: char| c.is_ascii_digit())
                });
                assert_eq!(rows, self.increments);
            }
            Event::Output => {
                self.outputs += 1;
                let printed = count("grows.dat", |line| line.contains("INCREMENT"));
                assert_eq!(printed, self.outputs);
                let nodes = count("grows.dat", |line| line.trim_start().starts_with("7 "));
                assert_eq!(nodes, self.outputs);
            }
            _ => {}
        }
        Ok(())
    }
}

#[test]
fn what_is_printed_is_in_the_files_while_the_run_goes_on() {
    let mut reader = Reader::default();
    let steps = format!("*STEP\n*STATIC, DIRECT\n.125, 1.\n*CLOAD\nNTOP, 3, 1.\n{PRINT}");
    let text = format!("{}*NSET, NSET=END\n7\n{steps}", column());
    let printed = run_before("grows", &text, Some(&mut reader)).course("displacements", 3);
    assert_eq!((reader.increments, reader.outputs), (8, 8));
    assert_eq!(printed.len(), 8);
}

/// Frequencies that a deck asks for in its last step.
fn frequencies(text: &str) -> Vec<f64> {
    let translation = translate(text);
    let problem = translation.document(Vec::new()).problem();
    let problem = problem.unwrap_or_else(|e| panic!("{e}"));
    let setup = problem.build_with(&place(""), &translation.meshes());
    let setup = setup.unwrap_or_else(|e| panic!("{e}"));
    let mut simulation = stickslip::run::Simulation::new(setup).expect("a simulation");
    simulation.run(&mut []).unwrap_or_else(|e| panic!("{e}"));
    let modes = &simulation.modes.last().expect("modes").modes;
    modes.iter().map(|m| m.frequency).collect()
}

/// A cantilever of 6 × 1 × 2 bricks, and what CalculiX 2.20 prints for it.
const CANTILEVER: &str = include_str!("../jobs/cantilever-modes.inp");
const CALCULIX: [f64; 6] = [
    1.119025e3, 1.342705e3, 7.025182e3, 7.498055e3, 8.177559e3, 1.317306e4,
];

#[test]
fn a_cantilever_has_the_frequencies_of_calculix() {
    let ours = frequencies(CANTILEVER);
    assert_eq!(ours.len(), 6);
    for (ours, theirs) in ours.iter().zip(CALCULIX) {
        near(*ours, theirs, 5e-7 * theirs);
    }
}

#[test]
fn frequency_steps_find_modes_about_the_state_before() {
    let rod = frequencies(&format!("{}*STEP\n*FREQUENCY\n4\n*END STEP\n", column()));
    // The first is that of one linear element, √(3 E/ρ)/(2 π L).
    assert_eq!(rod.len(), 4);
    near(rod[0], 3000.0_f64.sqrt() / std::f64::consts::TAU, 1e-9);
    let some = format!(
        "{}*STEP\n*FREQUENCY, SOLVER=SPOOLES\n9, 10., 16.\n*END STEP\n",
        column()
    );
    assert_eq!(frequencies(&some).len(), 2);
    // Two cubes that are pressed together are one rod of twice the length.
    let pressed = pair(
        0.0,
        "SURFACE TO SURFACE",
        "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD\n",
    );
    let steps = "*BOUNDARY\nA, 1\nB, 1\n*STEP\n*STATIC\n*CLOAD\nBTOP, 3, -.1\n*END STEP\n*STEP, PERTURBATION\n*FREQUENCY\n1\n*END STEP\n";
    let both = frequencies(&format!("{pressed}{steps}"));
    // Two linear elements: ω² = 6 k/m (1 - c)/(2 + c) with c = cos(π/4).
    let c = std::f64::consts::FRAC_1_SQRT_2;
    let omega = (6.0 * 1000.0 * (1.0 - c) / (2.0 + c)).sqrt();
    near(both[0], omega / std::f64::consts::TAU, 1e-4);
}

#[test]
fn what_frequency_steps_cannot_say_is_refused() {
    for (card, words) in [
        ("*FREQUENCY\n", "does not say how many modes"),
        ("*FREQUENCY\n3, 5., 2.\n", "go from a lower to a higher one"),
        ("*FREQUENCY, GLOBAL=YES\n3\n", "leave GLOBAL out"),
        ("*FREQUENCY\n3\n*STATIC\n", "a second procedure"),
    ] {
        let said = refused(&format!("{}*STEP\n{card}*END STEP\n", column()));
        assert!(said.contains(words), "{card}: {said}");
    }
    let said = refused(&format!(
        "{}*STEP, PERTURBATION\n*STATIC\n*END STEP\n",
        column()
    ));
    assert!(said.contains("take PERTURBATION out"), "{said}");
}

#[test]
fn free_bodies_turn_by_any_angle_where_motion_is_nonlinear() {
    // A cube far above another, turned by a couple that keeps its directions: θ'' = 24 F cos θ for a mass of one.
    let text = |step: &str| {
        let turn: String = [
            (11, -1),
            (14, -1),
            (15, -1),
            (18, -1),
            (12, 1),
            (13, 1),
            (16, 1),
            (17, 1),
        ]
        .iter()
        .map(|(node, sign)| format!("{node}, 2, {}\n", 0.125 * f64::from(*sign)))
        .collect();
        format!(
            "{}{}{}*SURFACE, NAME=SLAVE\nEB, S1\n*SURFACE, NAME=MASTER\nEA, S2\n*SURFACE INTERACTION, NAME=SI\n*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n1E4\n\
             *CONTACT PAIR, INTERACTION=SI, TYPE=SURFACE TO SURFACE\nSLAVE, MASTER\n*BOUNDARY\nA, 1, 3\n\
             *STEP, INC=1000{step}\n*DYNAMIC, DIRECT\n.01, 1.\n*CLOAD\n{turn}*NODE PRINT, NSET=B, FREQUENCY=1000\nU\n*END STEP\n",
            cube("A", 1, 0.0),
            cube("B", 11, 6.0),
            sections(&["EA", "EB"]),
        )
    };
    let free = translate(&text(", NLGEOM"));
    assert_eq!(free.toml.matches("rotation = \"large\"").count(), 1);
    assert!(!translate(&text("")).toml.contains("rotation"));
    let run = run("tumble", &text(", NLGEOM"));
    let (_, _, rows) = run.blocks.last().expect("a table");
    // From node 11 to node 12, along x at first.
    let edge: Vec<f64> = (1..4)
        .map(|i| rows[1][i] - rows[0][i] + if i == 1 { 1.0 } else { 0.0 })
        .collect();
    let length = edge.iter().map(|e| e * e).sum::<f64>().sqrt();
    assert!((length - 1.0).abs() < 5e-3, "{edge:?}");
    // θ'' = 3 cos θ from rest, at t = 1 by a fine Runge-Kutta rule.
    let (mut angle, mut spin, n) = (0.0_f64, 0.0, 10_000);
    let h = 1.0 / f64::from(n);
    for _ in 0..n {
        let middle = angle + 0.5 * h * spin;
        spin += h * 3.0 * middle.cos();
        angle = middle + 0.5 * h * spin;
    }
    let found = edge[1].atan2(edge[0]);
    assert!((found - angle).abs() < 5e-3, "{found} {angle}");
}

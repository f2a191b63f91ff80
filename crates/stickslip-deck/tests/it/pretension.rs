//! `*PRE-TENSION SECTION`: a bolt that is tightened by force or shortening, in decks of both styles, against CalculiX's numbers.

use crate::support::{near, refused, run, translate};

/// Two plates, quarters of square rings, and a bolt whose foot is tied to one; the other hangs on a reference point by a coupling. As Abaqus/CAE would write it,
/// and flat, as CalculiX reads it.
const JOB: &str = include_str!("../jobs/bolted.inp");
const FLAT: &str = include_str!("../jobs/bolted-flat.inp");

/// What `ccx` 2.20 prints for the flat deck at times 1 and 2: shortening, force between head and plate, force between the plates.
const CALCULIX: [[f64; 3]; 2] = [
    [1.250209e-2, -500.0002, -500.0],
    [1.250209e-2, -499.1499, -469.1490],
];

#[test]
fn a_job_with_parts_a_tie_a_coupling_two_pairs_and_a_bolt_agrees_with_calculix() {
    let flat = run("bolted-flat", FLAT);
    let at = |t: f64, title: &str, column: usize| -> Vec<f64> {
        let course = flat.course(title, column).into_iter();
        course
            .filter(|(s, _)| (s - t).abs() < 1e-9)
            .map(|(_, v)| v)
            .collect()
    };
    for (t, [shortening, head, joint]) in [1.0, 2.0].into_iter().zip(CALCULIX) {
        near(at(t, "displacements", 1)[0], shortening, 0.01);
        let pulls = at(t, "area,  normal force", 1);
        near(pulls[0], head, 0.001);
        near(pulls[1], joint, 0.01);
        // The force of the bolt is what its head presses with.
        near(at(t, "forces", 1)[0], -head, 0.001);
    }
    near(at(2.0, "total force", 2)[0], -30.0, 1e-6);
    // An increment that waits for the interior of its bodies prints its own contact: half of the force is there after half of the step.
    let halfway = at(0.5, "area,  normal force", 1);
    assert_eq!(halfway.len(), 2);
    halfway
        .into_iter()
        .for_each(|pull| near(pull, -250.0, 1e-3));

    // The same model from parts and instances, to the digits that are printed.
    let job = run("bolted", JOB);
    for title in ["displacements", "forces"] {
        let (a, b) = (job.course(title, 1), flat.course(title, 1));
        assert_eq!(a.len(), b.len());
        for ((_, a), (_, b)) in a.into_iter().zip(b) {
            near(a, b, 1e-5);
        }
    }
}

#[test]
fn steps_of_a_bolt_are_force_shortening_or_hold_as_loads_and_supports_of_its_node_say() {
    let (head, _) = FLAT.split_once("*STEP").expect("a step");
    let deck = |steps: &str| format!("{head}*AMPLITUDE, NAME=A\n0., 0., 1., .5, 2., 1.\n{steps}");
    let step = |cards: &str| format!("*STEP\n*STATIC\n1., 1.\n{cards}*END STEP\n");
    let lines = |steps: &str| -> Vec<String> {
        let toml = translate(&deck(steps)).toml;
        let drawn = toml.lines().filter(|l| l.starts_with("pretension."));
        drawn
            .map(|l| l.trim_start_matches("pretension.SCUT = ").to_string())
            .collect()
    };
    let force = "*CLOAD\n999, 1, 500.\n";
    assert_eq!(
        lines(&[step(force), step("*BOUNDARY, FIXED\n999, 1, 1\n"), step("")].concat()),
        ["{ force = 500.0 }", "{ hold = true }", "{ hold = true }"]
    );
    assert_eq!(
        lines(&[step(""), step(force), step("*CLOAD, OP=NEW\n205, 1, 1.\n")].concat()),
        ["{ force = 0.0 }", "{ force = 500.0 }", "{ force = 0.0 }"]
    );
    assert_eq!(
        lines(
            &[
                step("*BOUNDARY\nREF, 1, 1, .01\n"),
                step(
                    "*BOUNDARY, OP=NEW\nMIDX, 1\nMIDY, 2\n*CLOAD\nREF, 1, 3.\n*CLOAD\nREF, 1, 4.\n"
                )
            ]
            .concat()
        ),
        ["{ shortening = 0.01 }", "{ force = 7.0 }"]
    );
    let followed = lines(&[step("*CLOAD, AMPLITUDE=A\n999, 1, 500.\n"), step("")].concat());
    assert_eq!(followed[0], "{ force = 500.0, amplitude = \"A-SCUT\" }");
    assert_eq!(followed[1], followed[0]);
}

#[test]
fn sections_that_cannot_be_cut_are_refused_at_their_line() {
    let card = "*PRE-TENSION SECTION, SURFACE=SCut, NODE=999\n0., 0., 1.\n";
    let with = |new: &str| FLAT.replace(card, new);
    for (text, said) in [
        (
            with("*PRE-TENSION SECTION, ELEMENT=5, NODE=999\n"),
            "ELEMENT is not supported",
        ),
        (
            with("*PRE-TENSION SECTION, SURFACE=SCut, NODE=1\n"),
            "node 1 is one of a body",
        ),
        (
            with("*PRE-TENSION SECTION, SURFACE=SCut, NODE=12345\n"),
            "which is no node",
        ),
        (
            with("*PRE-TENSION SECTION, SURFACE=SCut\n"),
            "needs the parameter NODE",
        ),
        (
            with("*PRE-TENSION SECTION, SURFACE=SCat, NODE=999\n"),
            "there is no surface SCAT",
        ),
        (with(&card.repeat(2)), "has a pretension already"),
        (
            with(
                "*NSET, NSET=N\n1, 2\n*SURFACE, NAME=SN, TYPE=NODE\nN\n*PRE-TENSION SECTION, SURFACE=SN, NODE=999\n",
            ),
            "consists of nodes",
        ),
        (
            FLAT.replace("999, 1, 500.", "999, 2, 500."),
            "has no direction 2",
        ),
        (
            FLAT.replace("*STATIC\n.5, 1.\n*CLOAD", "*DYNAMIC\n.5, 1.\n*CLOAD"),
            "acts at once in step 1",
        ),
    ] {
        let message = refused(&text);
        assert!(message.contains(said), "{said}: {message}");
        assert!(message.contains("job.inp:"), "{message}");
    }
}

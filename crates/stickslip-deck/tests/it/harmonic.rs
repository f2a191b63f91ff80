//! `*STEADY STATE DYNAMICS`: amplitudes and phases of CalculiX, and what is refused.

use crate::support::{blocks, column, near, place, refused, translate};
use stickslip::modal::Response;
use stickslip_deck::Translation;

/// A cantilever that is shaken at its end, and what CalculiX 2.20 prints: at each frequency real and imaginary parts of the displacements of two nodes.
const CANTILEVER: &str = include_str!("../jobs/cantilever-shaken.inp");
const CALCULIX: &str = include_str!("../jobs/cantilever-shaken.dat");

fn answer(translation: &Translation) -> Response {
    let problem = translation.document(Vec::new()).problem();
    let problem = problem.unwrap_or_else(|e| panic!("{e}\n{}", translation.toml));
    let setup = problem.build_with(&place(""), &translation.meshes());
    let setup = setup.unwrap_or_else(|e| panic!("{e}"));
    let mut simulation = stickslip::run::Simulation::new(setup).expect("a simulation");
    simulation.run(&mut []).unwrap_or_else(|e| panic!("{e}"));
    let last = simulation.run.modes.pop().expect("an outcome");
    last.response.expect("a response")
}

#[test]
fn a_cantilever_answers_as_in_calculix() {
    let ours = answer(&translate(CANTILEVER));
    // Probes stand by name, nodes of CalculiX by number.
    let columns: Vec<String> = ["node-42", "node-7"]
        .iter()
        .flat_map(|n| (1..=3).map(move |c| format!("{n}.U{c}")))
        .collect();
    assert_eq!(ours.columns, columns);
    let theirs = blocks(CALCULIX);
    assert_eq!(theirs.len(), 2 * ours.rows.len());
    let (mut worst, mut turned) = (0.0_f64, 0.0_f64);
    // CalculiX superposes 20 of 108 modes and leaves out the give of all others, which is here: what both differ by at the lowest frequency, where the others are at
    // rest. It is small, but more than the answer where modes cancel.
    let mut give: Option<Vec<[f64; 2]>> = None;
    for (row, parts) in ours.rows.iter().zip(theirs.chunks(2)) {
        near(row.frequency, parts[0].1, 1e-6);
        let value = |k: usize, q: usize| parts[q].2[1 - k / 3][1 + k % 3];
        let of = |k: usize| [value(k, 0), value(k, 1)];
        let largest = (0..6).fold(0.0_f64, |m, k| m.max(of(k)[0].hypot(of(k)[1])));
        let give = give.get_or_insert_with(|| {
            let each = row.values.iter().enumerate();
            each.map(|(k, own)| [0, 1].map(|i| own[i] - of(k)[i]))
                .collect()
        });
        for (k, (own, give)) in row.values.iter().zip(&*give).enumerate() {
            assert!(give[0].hypot(give[1]) < 6e-4 * 1.55e-2, "{give:?}");
            let own = [0, 1].map(|i| own[i] - give[i]);
            let theirs = of(k);
            let off = (own[0] - theirs[0]).hypot(own[1] - theirs[1]);
            worst = worst.max(off / largest);
            if theirs[0].hypot(theirs[1]) > 0.1 * largest {
                // Of the quotient of both the argument is the difference of the phases.
                let cross = own[1] * theirs[0] - own[0] * theirs[1];
                let along = own[0] * theirs[0] + own[1] * theirs[1];
                turned = turned.max(cross.atan2(along).to_degrees().abs());
            }
        }
    }
    println!("amplitudes {worst:e}, phases {turned:e} degrees");
    // The others begin to move: their give changes by a quarter up to 8 kHz, which is 2.4e-3 of what is left where modes cancel, and less elsewhere.
    assert!(worst < 2.5e-3, "{worst:e}");
    assert!(turned < 0.2, "{turned:e}");
}

/// A column after `*FREQUENCY`, with this step.
fn shaken(step: &str) -> String {
    format!(
        "{}*STEP\n*FREQUENCY\n4\n*END STEP\n*STEP\n{step}*END STEP\n",
        column()
    )
}

#[test]
fn only_what_the_step_loads_shakes_and_it_is_as_large_as_its_equation_says() {
    // A rod of one element: k = E A / L = 1000, and of its mass of 1 a third at the end. Three quarters of a force of 4 and the fourth by the surface: 4 in phase.
    let card = "*STEADY STATE DYNAMICS, INTERVAL=RANGE, FREQUENCY SCALE=LINEAR\n0., 8., 5\n*MODAL DAMPING, RAYLEIGH\n, , 6., .01\n";
    let load = "*CLOAD\nNTOP, 3, .75\n*DLOAD\nEN, P2, -1.\n*CLOAD, LOAD CASE=2\nNTOP, 3, .5\n*NODE PRINT, NSET=NTOP\nU\n";
    let text = shaken(&format!("{card}{load}"));
    let before = "*STEP\n*STATIC\n*CLOAD\nNTOP, 3, 9.\n*END STEP\n*STEP\n*FREQUENCY";
    for text in [text.clone(), text.replacen("*STEP\n*FREQUENCY", before, 1)] {
        let translation = translate(&text);
        let answer = answer(&translation);
        assert_eq!(answer.rows.len(), 5);
        for (row, f) in answer.rows.iter().zip([0.0, 2.0, 4.0, 6.0, 8.0]) {
            near(row.frequency, f, 1e-12);
            let omega = std::f64::consts::TAU * f;
            let m = 1.0 / 3.0;
            let (still, damped) = (
                1000.0 - omega * omega * m,
                omega * (6.0 * m + 0.01 * 1000.0),
            );
            let square = still * still + damped * damped;
            // (4 + 2 i) / (still + i damped).
            near(
                row.values[2][0],
                (4.0 * still + 2.0 * damped) / square,
                1e-8,
            );
            near(
                row.values[2][1],
                (2.0 * still - 4.0 * damped) / square,
                1e-8,
            );
        }
    }
}

#[test]
fn nodes_that_are_not_printed_are_told_as_fields() {
    let card = "*STEADY STATE DYNAMICS\n1., 8., 3, 2.\n*CLOAD\nNTOP, 3, 1.\n";
    let fields = translate(&shaken(card)).toml;
    assert!(fields.contains("shapes = true"), "{fields}");
    assert!(
        fields.contains("from = 1.0, to = 8.0, points = 3, bias = 2.0"),
        "{fields}"
    );
    let printed = translate(&shaken(&format!("{card}*NODE PRINT, NSET=NTOP\nU\n"))).toml;
    assert!(!printed.contains("shapes"), "{printed}");
    assert_eq!(printed.matches("[probe.").count(), 4);
    let both = "*NODE PRINT, NSET=NTOP\nU\n*NODE FILE\nU\n";
    assert!(
        translate(&shaken(&format!("{card}{both}")))
            .toml
            .contains("shapes = true")
    );
}

#[test]
fn what_steady_vibrations_cannot_say_is_refused() {
    let force = "*CLOAD\nNTOP, 3, 1.\n";
    for (step, words) in [
        ("*STEADY STATE DYNAMICS\n", "at which frequencies"),
        (
            "*STEADY STATE DYNAMICS\n5., 2.\n",
            "from a lower to a higher one",
        ),
        (
            "*STEADY STATE DYNAMICS\n1., 2., 5, .5\n",
            "bias of at least 1",
        ),
        (
            "*STEADY STATE DYNAMICS, INTERVAL=SPREAD\n1., 2.\n",
            "EIGENFREQUENCY or RANGE",
        ),
        (
            "*STEADY STATE DYNAMICS, INTERVAL=RANGE\n1., 2., 5, 3.\n",
            "spread evenly",
        ),
        (
            "*STEADY STATE DYNAMICS, FREQUENCY SCALE=LOGARITHMIC\n1., 2.\n",
            "linear scale",
        ),
        (
            "*STEADY STATE DYNAMICS, HARMONIC=NO\n1., 2., 5, 3., 4, 0., 1.\n",
            "is not read",
        ),
        (
            "*STEADY STATE DYNAMICS, HARMONIC=NO\n1., 2.\n",
            "leave HARMONIC out",
        ),
        ("*STEADY STATE DYNAMICS, DIRECT\n1., 2.\n", "leave it out"),
        (
            "*STEADY STATE DYNAMICS\n1., 2.\n*MODAL DAMPING, STRUCTURAL\n1, 2, .1\n",
            "half its size",
        ),
        (
            "*STEADY STATE DYNAMICS\n1., 2.\n*MODAL DAMPING\n3, 2, .1\n",
            "from a lower number",
        ),
        (
            "*STEADY STATE DYNAMICS\n1., 2.\n*BOUNDARY\nNBOT, 3, 3, .1\n",
            "base excitation is not supported",
        ),
        (
            "*STEADY STATE DYNAMICS\n1., 2.\n*CLOAD, LOAD CASE=3\nNTOP, 3, 1.\n",
            "no load case 3",
        ),
        (
            "*STATIC\n*CLOAD, LOAD CASE=2\nNTOP, 3, 1.\n",
            "in which nothing shakes",
        ),
        ("*STATIC\n*MODAL DAMPING\n1, 2, .1\n", "superposes no modes"),
        (
            "*STEADY STATE DYNAMICS\n1., 2.\n*AMPLITUDE, NAME=A\n0., 1., 9., 1.\n*CLOAD, AMPLITUDE=A\nNTOP, 3, 1.\n",
            "leave AMPLITUDE out",
        ),
    ] {
        let said = refused(&shaken(&format!("{step}{force}")));
        assert!(said.contains(words), "{step}: {said}");
    }
    let step = "*STEADY STATE DYNAMICS\n1., 2.\n";
    assert!(refused(&shaken(step)).contains("no load shakes in this step"));
    let alone = format!("{}*STEP\n{step}{force}*END STEP\n", column());
    assert!(refused(&alone).contains("no *FREQUENCY before it"));
}

//! Elements between nodes: gaps and dashpots.

use crate::support::{Run, cube, near, refused, run, sections};

/// Two cubes that move along z, the lower one held, with gaps between the nodes that face each other; the numbers of `*GAP`.
fn gaps(numbers: &str, top: &str) -> String {
    format!(
        "{}{}{}*ELEMENT, TYPE=GAPUNI, ELSET=EG\n101, 5, 11\n102, 6, 12\n103, 7, 13\n104, 8, 14\n*GAP, ELSET=EG\n{numbers}\n\
         *BOUNDARY\nA, 1, 2\nB, 1, 2\nABOT, 3\n*STEP, NLGEOM\n*STATIC, DIRECT\n.5, 1.\n{top}\
         *NODE PRINT, NSET=ABOT, TOTALS=ONLY\nRF\n*NODE PRINT, NSET=BBOT\nU\n*END STEP\n",
        cube("A", 1, 0.0),
        cube("B", 11, 1.0),
        sections(&["EA", "EB"])
    )
}

/// Forces on the ground and displacements above the gaps at the two increments.
fn courses(run: &Run) -> ([f64; 2], [f64; 2]) {
    let force = run.course("total force", 2);
    let u = run.course("displacements", 3);
    ([force[0].1, force[1].1], [u[0].1, u[1].1])
}

#[test]
fn gaps_close_and_press() {
    let moved = "*BOUNDARY\nBTOP, 3, 3, -.01\n";
    // CalculiX 2.20 with strains that are finite: 2.490633 and -7.5e-3.
    let (force, u) = courses(&run("gap-hard", &gaps("0.005, 0., 0., 1.", moved)));
    assert!(force[0].abs() < 1e-9, "{force:?}");
    near(force[1], 2.5, 1e-6);
    near(force[1], 2.490633, 5e-3);
    near(u[1], -7.5e-3, 1e-6);
    // With a stiffness of each; CalculiX: 2.215637 and -7.776955e-3.
    let soft = gaps("0.005, 0., 0., 1., , 1.E3", moved);
    let (force, u) = courses(&run("gap-soft", &soft));
    near(force[1], 2.215637, 5e-3);
    near(u[1], -7.776955e-3, 1e-3);
    near(force[1], 0.005 / (1e-3 + 1e-3 + 1.0 / 4e3), 1e-6);
}

#[test]
fn gaps_hold_what_only_they_hold() {
    // Closed from the start; CalculiX 2.20: -2.011032e-3 and -4.034259e-3 with finite strains and springs of 1e5.
    let pressed = "*CLOAD\nBTOP, 3, -1.\n";
    let (force, u) = courses(&run("gap-closed", &gaps("0., 0., 0., 1.", pressed)));
    near(force[0], 2.0, 1e-6);
    near(force[1], 4.0, 1e-6);
    near(u[0], -2e-3, 1e-6);
    near(u[1], -4.034259e-3, 1e-2);
}

#[test]
fn gaps_open_again_and_act_against_the_ground() {
    // A cube that is moved up and down above a node that is held; the direction is that from the first node to the second.
    let text = format!(
        "{}{}*NODE\n20, 0., 0., 1.5\n*ELEMENT, TYPE=GAPUNI, ELSET=EG\n9, 5, 20\n*GAP, ELSET=EG\n.5\n*BOUNDARY\nN, 1, 2\n20, 1, 3\n\
         *STEP\n*STATIC\n*BOUNDARY\nNBOT, 3, 3, .7\n*NODE PRINT, NSET=NBOT, TOTALS=ONLY\nRF\n*NODE PRINT, NSET=NTOP\nU\n*END STEP\n\
         *STEP\n*STATIC\n*BOUNDARY\nNBOT, 3, 3, .2\n*END STEP\n",
        cube("N", 1, 0.0),
        sections(&["EN"])
    );
    let run = run("gap-again", &text);
    let u = run.course("displacements", 3);
    near(u[0].1, 0.5, 1e-9);
    near(u[1].1, 0.2, 1e-9);
    let force = run.course("total force", 2);
    assert!(force[0].1 > 10.0 && force[1].1.abs() < 1e-9, "{force:?}");
}

#[test]
fn gaps_along_nothing_are_refused() {
    let message = refused(&gaps("0.005", ""));
    assert!(message.contains("lie at the same place"), "{message}");
    let spring = gaps("0.005, 0., 0., 1.", "").replace("TYPE=GAPUNI", "TYPE=SPRINGA");
    let message = refused(&spring);
    assert!(message.contains("is none of *GAP"), "{message}");
}

/// A cube of mass 1 that moves along z as a whole on a spring of stiffness 10 with a dashpot of coefficient 2 beside it, under a force of 1 from rest.
fn damped(elements: &str, cards: &str, step: &str) -> Run {
    let tied: String = (2..9)
        .map(|n| format!("2\n{n}, 3, 1., 1, 3, -1.\n"))
        .collect();
    let text = format!(
        "{}*NODE\n21, 0., 0., -1.\n{elements}{cards}{}*BOUNDARY\nN, 1, 2\n21, 1, 3\n*EQUATION\n{tied}*NSET, NSET=N1\n1\n*STEP\n{step}\n\
         *CLOAD\n1, 3, 1.\n*NODE PRINT, NSET=N1, FREQUENCY=20\nU, V\n*END STEP\n",
        cube("N", 1, 0.0),
        sections(&["EN"]).replace("1000., 0.", "1.E4, 0.")
    );
    run(&step.replace([' ', '\n', '*', ',', '=', '.'], ""), &text)
}

/// `F/k (1 - exp(-t) (cos 3t + sin 3t / 3))`.
fn closed_form(t: f64) -> f64 {
    let (s, c) = (3.0 * t).sin_cos();
    0.1 * (1.0 - (-t).exp() * (c + s / 3.0))
}

#[test]
fn a_dashpot_damps_a_mass_on_a_spring() {
    let elements =
        "*ELEMENT, TYPE=SPRINGA, ELSET=ES\n2, 21, 1\n*ELEMENT, TYPE=DASHPOTA, ELSET=ED\n3, 21, 1\n";
    let cards = "*SPRING, ELSET=ES\n\n10.\n*DASHPOT, ELSET=ED\n\n2.\n";
    let implicit = damped(elements, cards, "*DYNAMIC, DIRECT, ALPHA=0.\n.005, 1.");
    let found = implicit.course("displacements", 3);
    // CalculiX 2.20 at 0.5.
    let at = |t: f64| {
        found
            .iter()
            .find(|p| (p.0 - t).abs() < 1e-9)
            .expect("a time")
            .1
    };
    near(at(0.5), 7.554076e-2, 1e-3);
    for (t, u) in &found {
        near(*u, closed_form(*t), 2e-3);
    }
    let velocities = implicit.course("velocities", 3);
    near(velocities[4].1, 2.016756e-1, 1e-3);
    // Along an axis, and in explicit steps.
    let elements = elements.replace("DASHPOTA, ELSET=ED\n3, 21, 1", "DASHPOT1, ELSET=ED\n3, 1");
    let cards = cards.replace("ELSET=ED\n\n", "ELSET=ED\n3\n");
    let explicit = damped(&elements, &cards, "*DYNAMIC, EXPLICIT\n.001, 1.");
    let found = explicit.course("displacements", 3);
    let (t, u) = found[found.len() - 1];
    near(t, 1.0, 1e-9);
    near(u, closed_form(1.0), 5e-3);
}

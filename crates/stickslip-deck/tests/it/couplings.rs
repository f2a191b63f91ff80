//! `*COUPLING`, `*MPC` and `*RIGID BODY` of nodes against CalculiX 2.20, whose numbers stand here, and what is refused of them.

use std::fmt::Write as _;

use crate::support::{Run, near, refused, run, translate};

/// A bar along z of 2 by 2 by 4 cells, 1 by 1 by 4, held at its foot. Nodes 37 to 45 are its top, 41 the middle of that; node 1001 lies 2 above.
fn bar() -> String {
    let node = |i: usize, j: usize, k: usize| 1 + i + 3 * j + 9 * k;
    let mut text = "*NODE, NSET=ALL\n".to_string();
    for k in 0..5 {
        for j in 0..3 {
            for i in 0..3 {
                let (x, y) = (0.5 * i as f64, 0.5 * j as f64);
                let _ = writeln!(text, "{}, {x}, {y}, {k}", node(i, j, k));
            }
        }
    }
    text += "*ELEMENT, TYPE=C3D8I, ELSET=E\n";
    for k in 0..4 {
        for j in 0..2 {
            for i in 0..2 {
                let id = 1 + i + 2 * j + 4 * k;
                let low = [(0, 0), (1, 0), (1, 1), (0, 1)];
                let corner = |up: usize| low.map(|(a, b)| node(i + a, j + b, k + up).to_string());
                let _ = writeln!(
                    text,
                    "{id}, {}, {}",
                    corner(0).join(", "),
                    corner(1).join(", ")
                );
            }
        }
    }
    text + "*NSET, NSET=TOP, GENERATE\n37, 45\n*NSET, NSET=BOT, GENERATE\n1, 9\n*SURFACE, NAME=STOP\n13, S2\n14, S2\n15, S2\n16, S2\n\
        *MATERIAL, NAME=M\n*ELASTIC\n1000., .3\n*SOLID SECTION, ELSET=E, MATERIAL=M\n*BOUNDARY\nBOT, 1, 3\n\
        *NODE, NSET=REF\n1001, .5, .5, 6.\n*NODE, NSET=ROT\n1002, .5, .5, 6.\n*NSET, NSET=TIP\n37, 41, 45\n"
}

const PRINT: &str = "*NODE PRINT, NSET=REF\nU, RF\n*NODE PRINT, NSET=TIP\nU\n*NODE PRINT, NSET=BOT, TOTALS=ONLY\nRF\n*END STEP\n";

/// The rows of the last block with a title for which there are so many, without the numbers of the nodes.
fn rows(run: &Run, title: &str, count: usize) -> Vec<Vec<f64>> {
    let all = run.all(title).into_iter().rev();
    let mut all = all.filter(|b| b.2.len() == count);
    let rows = all.next().unwrap_or_else(|| panic!("no {title}")).2;
    rows.into_iter().map(|r| r[1..].to_vec()).collect()
}

/// The tip moves as CalculiX says, to a fraction of the largest of its displacements.
#[track_caller]
fn tip(run: &Run, expected: [[f64; 3]; 3], tolerance: f64) {
    let found = rows(run, "displacements", 3);
    let largest = expected
        .as_flattened()
        .iter()
        .fold(0.0_f64, |m, u| m.max(u.abs()));
    for (f, e) in found.iter().flatten().zip(expected.as_flattened()) {
        assert!(
            (f - e).abs() < tolerance * largest,
            "{found:?} is not {expected:?}"
        );
    }
}

#[track_caller]
fn force(run: &Run, expected: [f64; 3]) {
    let found = run.last("total force");
    for (f, e) in found.iter().zip(expected) {
        assert!((f - e).abs() < 1e-8, "{found:?} is not {expected:?}");
    }
}

const LOADS: &str = "*STEP\n*STATIC\n*CLOAD\n1001, 1, .3\n1001, 3, 2.\n1001, 5, .2\n1001, 6, .4\n";
const COUPLING: &str = "*COUPLING, REF NODE=1001, SURFACE=STOP, CONSTRAINT NAME=C\n";

/// What CalculiX says of nodes that are rigid with a loaded reference node.
const RIGID: [[f64; 3]; 3] = [
    [1.616956e-1, -1.248e-2, 4.012742e-2],
    [1.492156e-1, 0.0, 7.681922e-3],
    [1.367356e-1, 1.248e-2, -2.476358e-2],
];

#[test]
fn a_kinematic_coupling_takes_forces_and_moments() {
    for way in ["*KINEMATIC\n1, 3\n", "*KINEMATIC\n1, 6\n", "*KINEMATIC\n"] {
        let text = format!(
            "{}{COUPLING}{way}{LOADS}*NODE PRINT, NSET=REF\nUR, RM\n{PRINT}",
            bar()
        );
        let run = run("coupling-kinematic", &text);
        tip(&run, RIGID, 1e-3);
        force(&run, [-0.3, 0.0, -2.0]);
        let u = &rows(&run, "displacements", 1)[0];
        near(u[0], 2.789976e-1, 1e-3);
        let turned = &rows(&run, "rotations", 1)[0];
        near(turned[1], 6.489101e-2, 1e-3);
        near(turned[2], 2.496e-2, 1e-3);
    }
    let old = format!(
        "{}*KINEMATIC COUPLING, REF NODE=1001\nTOP, 1, 3\n{LOADS}{PRINT}",
        bar()
    );
    tip(&run("coupling-old", &old), RIGID, 1e-3);
}

#[test]
fn a_distributing_coupling_spreads_forces_and_moments() {
    let expected = [
        [1.62191e-1, -1.136824e-2, 4.062008e-2],
        [1.494441e-1, 0.0, 7.853533e-3],
        [1.366337e-1, 1.29945e-2, -2.496207e-2],
    ];
    let text = format!("{}{COUPLING}*DISTRIBUTING\n1, 6\n{LOADS}{PRINT}", bar());
    let found = run("coupling-distributing", &text);
    tip(&found, expected, 1e-2);
    force(&found, [-0.3, 0.0, -2.0]);
    // Weights by area, as nodes of an element of the old kind have them given.
    let old = format!(
        "{}*ELEMENT, TYPE=DCOUP3D, ELSET=D\n900, 1001\n*DISTRIBUTING COUPLING, ELSET=D\n37, 1.\n39, 1.\n43, 1.\n45, 1.\n\
         38, 2.\n40, 2.\n42, 2.\n44, 2.\n41, 4.\n{LOADS}{PRINT}",
        bar()
    );
    let old = run("coupling-distributing-old", &old);
    let (a, b) = (
        rows(&found, "displacements", 3),
        rows(&old, "displacements", 3),
    );
    for (a, b) in a.iter().flatten().zip(b.iter().flatten()) {
        assert!((a - b).abs() < 1e-9, "{a} {b}");
    }
}

#[test]
fn nodes_of_a_body_are_rigid_with_a_loaded_reference_node() {
    let text = format!(
        "{}*RIGID BODY, NSET=TOP, REF NODE=1001, ROT NODE=1002\n*STEP\n*STATIC\n*CLOAD\n1001, 1, .3\n1001, 3, 2.\n1002, 2, .2\n1002, 3, .4\n\
         *NODE PRINT, NSET=ROT\nU\n{PRINT}",
        bar()
    );
    let run = run("rigid-loaded", &text);
    tip(&run, RIGID, 1e-3);
    let first = &run.all("displacements")[0].2[0];
    near(first[2], 6.489101e-2, 1e-3);
    near(first[3], 2.496e-2, 1e-3);
}

#[test]
fn a_reference_node_is_held_in_part() {
    let text = format!(
        "{}*RIGID BODY, NSET=TOP, REF NODE=1001, ROT NODE=1002\n*BOUNDARY\n1001, 1, 1\n1002, 3, 3\n*STEP\n*STATIC\n*CLOAD\n1001, 3, 2.\n\
         1001, 2, .2\n{PRINT}",
        bar()
    );
    let run = run("rigid-half", &text);
    let expected = [
        [0.0, 8.711684e-2, 2.622221e-2],
        [0.0, 8.711684e-2, 7.681922e-3],
        [0.0, 8.711684e-2, -1.085837e-2],
    ];
    tip(&run, expected, 1e-3);
    let all = run.all("forces");
    let reaction = &all.iter().find(|b| b.2.len() == 1).expect("of the node").2[0];
    near(reaction[2], 0.2, 1e-6);
    near(reaction[3], 2.0, 1e-6);
    force(&run, [0.0, -0.2, -2.0]);
    near(rows(&run, "displacements", 1)[0][1], 1.61278e-1, 1e-3);
}

fn constrained(name: &str, mpc: &str, loads: &str) -> Run {
    let text = format!(
        "{}{mpc}*STEP\n*STATIC\n*CLOAD\n{loads}*NODE PRINT, NSET=TOP\nU\n{PRINT}",
        bar()
    );
    run(name, &text)
}

#[test]
fn multi_point_constraints_agree_with_calculix() {
    let run = constrained(
        "mpc-plane",
        "*MPC\nPLANE, 37, 39, 43, 38, 40, 41, 42, 44, 45\n",
        "45, 3, .01\n41, 1, .002\n",
    );
    let plane = [
        [3.199996e-5, -4.65445e-4, -1.036609e-4],
        [3.866073e-5, -4.643434e-4, 3.916832e-5],
        [2.893903e-5, -4.684172e-4, 1.819955e-4],
    ];
    tip(&run, plane, 1e-2);
    // The same over two lines.
    let again = constrained(
        "mpc-plane-lines",
        "*MPC\nPLANE, 37, 39, 43, 38, 40\n0, 41, 42, 44, 45\n",
        "45, 3, .01\n41, 1, .002\n",
    );
    tip(&again, plane, 1e-2);
    let run = constrained(
        "mpc-beam",
        "*MPC\nBEAM, 37, 45\n",
        "45, 1, .01\n45, 2, .003\n",
    );
    let beam = [
        [2.413423e-3, 8.759438e-4, 6.128723e-4],
        [2.500608e-3, 7.585903e-4, -1.037132e-6],
        [2.655392e-3, 6.331614e-4, -6.149037e-4],
    ];
    tip(&run, beam, 1e-2);
}

#[test]
fn a_mean_rotation_is_prescribed_by_the_node_of_its_axis() {
    let text = format!(
        "{}*MPC\nMEANROT, 37, 37, 37, 39, 39, 39, 43, 43, 43, 45, 45, 45, 2001\n*STEP\n*STATIC\n*BOUNDARY\n2001, 1, 1, .001\n\
         *NODE PRINT, NSET=REF\nRF\n{PRINT}",
        bar().replace("1001, .5, .5, 6.", "2001, 0., 0., 1.")
    );
    let run = run("mpc-meanrot", &text);
    tip(
        &run,
        [[5e-4, -5e-4, 0.0], [0.0; 3], [-5e-4, 5e-4, 0.0]],
        1e-2,
    );
    near(rows(&run, "forces", 1)[0][0], 1.567779e-2, 1e-2);
}

#[test]
fn lines_stay_straight_and_distances_as_they_are() {
    let run = constrained(
        "mpc-straight",
        "*MPC\nSTRAIGHT, 37, 39, 38\nPIN, 43, 45\nLINK, 37, 45\n",
        "38, 3, .01\n44, 1, .002\n",
    );
    let u = rows(&run, "displacements", 9);
    for (middle, ends) in u[1].iter().zip(u[0].iter().zip(&u[2])).skip(1) {
        assert!((middle - 0.5 * (ends.0 + ends.1)).abs() < 1e-9);
        assert!(middle.abs() > 1e-7);
    }
    for (one, other) in u[6].iter().zip(&u[8]) {
        assert!((one - other).abs() < 1e-12);
    }
    let along = (u[8][0] - u[0][0]) + (u[8][1] - u[0][1]);
    // Seven digits are printed.
    assert!(along.abs() < 1e-9, "{along}");
    // The distance grows by what is prescribed at the third node.
    let text = format!(
        "{}*NODE\n2001, 1.4142136, 0., 0.\n*MPC\nDIST, 37, 37, 37, 45, 45, 45, 2001\n*BOUNDARY\n2001, 1, 1, 1e-3\n*STEP\n*STATIC\n*NODE PRINT, NSET=TOP\nU\n{PRINT}",
        bar()
    )
    .replace("*BOUNDARY\n2001, 1, 1, 1e-3\n*STEP\n*STATIC\n", "*STEP\n*STATIC\n*BOUNDARY\n2001, 1, 1, 1e-3\n");
    let u = rows(&crate::support::run("mpc-dist", &text), "displacements", 9);
    let along = ((u[8][0] - u[0][0]) + (u[8][1] - u[0][1])) / 2f64.sqrt();
    near(along, 1e-3, 1e-6);
}

#[test]
fn a_node_between_springs_moves() {
    let text = format!(
        "{}*NODE\n1003, .5, .5, 9.\n*ELEMENT, TYPE=SPRINGA, ELSET=ES\n901, 41, 1001\n902, 1001, 1003\n*SPRING, ELSET=ES\n\n500.\n*BOUNDARY\n\
         1003, 1, 3\n1001, 1, 2\n*STEP\n*STATIC\n*CLOAD\n1001, 3, 2.\n{PRINT}",
        bar()
    );
    let run = run("spring-node", &text);
    near(rows(&run, "displacements", 1)[0][2], 3.20696e-3, 1e-3);
    near(run.last("total force")[2], -0.39652, 1e-3);
}

#[test]
fn couplings_without_meaning_are_refused() {
    let step = "*STEP\n*STATIC\n*CLOAD\n1001, 1, 1.\n*END STEP\n";
    for (text, expected) in [
        (COUPLING.to_string(), "does not say how it ties"),
        ("*KINEMATIC\n1, 3\n".into(), "belongs to no *COUPLING"),
        ("*MPC\nELBOW, 1, 2\n".into(), "ELBOW is not supported"),
        ("*MPC\nPLANE, 37, 39, 38, 41\n".into(), "on one line"),
        ("*MPC\nPIN, 37\n".into(), "has 1 nodes"),
        (
            "*MPC\nPIN, 37, 9999\n".into(),
            "no node and no set of nodes 9999",
        ),
        (
            "*COUPLING, REF NODE=9999, SURFACE=STOP, CONSTRAINT NAME=C\n*KINEMATIC\n".into(),
            "which is no node",
        ),
        (
            format!("{COUPLING}*KINEMATIC\n4, 6\n"),
            "ties no displacement",
        ),
        (format!("{COUPLING}*KINEMATIC\n3, 1\n"), "before the first"),
    ] {
        let found = refused(&format!("{}{text}{step}", bar()));
        assert!(found.contains(expected), "{text}: {found}");
    }
    let turned = "*STEP\n*STATIC\n*CLOAD\n41, 4, 1.\n*END STEP\n";
    let found = refused(&format!("{}{turned}", bar()));
    assert!(found.contains("cannot turn"), "{found}");
}

#[test]
fn directions_that_a_distributing_coupling_leaves_out_are_refused_where_something_acts_in_them() {
    let deck = |list: &str| format!("{}{COUPLING}*DISTRIBUTING\n{list}\n{LOADS}{PRINT}", bar());
    // Force and moment act on the reference node.
    let message = refused(&deck("1, 3"));
    assert!(message.contains("leaves out direction"), "{message}");
    translate(&deck("1, 6"));
}

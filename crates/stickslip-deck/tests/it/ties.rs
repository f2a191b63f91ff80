//! Ties, tied contact, and nodes that are moved onto the surface opposite.

use crate::support::{cube, near, near3, pair, refused, run, sections};

/// Two cubes of 1000 at a distance, the upper one pulled up by 0.01, tied with these parameters. The force that the tie carries.
fn tied(name: &str, gap: f64, parameters: &str) -> f64 {
    let text = format!(
        "{}{}{}*SURFACE, NAME=SLAVE\nEB, S1\n*SURFACE, NAME=MASTER\nEA, S2\n*TIE, NAME=T{parameters}\nSLAVE, MASTER\n*BOUNDARY\nA, 1, 2\nB, 1, 2\nABOT, 3\n\
         *STEP\n*STATIC\n*BOUNDARY\nBTOP, 3, 3, .01\n*NODE PRINT, NSET=BTOP, TOTALS=ONLY\nRF\n*END STEP\n",
        cube("A", 1, 0.0),
        cube("B", 11, 1.0 + gap),
        sections(&["EA", "EB"]),
    );
    run(name, &text).last("total force")[2]
}

#[test]
fn surfaces_are_tied_up_to_the_position_tolerance() {
    let still = ", ADJUST=NO";
    for (name, gap, parameters, force) in [
        ("wide", 0.8, ", POSITION TOLERANCE=1.", 5.0),
        ("far", 0.8, ", POSITION TOLERANCE=.5", 0.0),
        ("narrow", 0.05, ", POSITION TOLERANCE=.01", 0.0),
        ("near", 0.05, ", POSITION TOLERANCE=.1", 5.0),
        // CalculiX's default is a fortieth of the size of an element.
        ("default", 0.01, "", 5.0),
        ("beyond-default", 0.05, "", 0.0),
        ("zero", 0.01, ", POSITION TOLERANCE=0.", 5.0),
    ] {
        let found = tied(&format!("tie-{name}"), gap, &format!("{parameters}{still}"));
        assert!((found - force).abs() < 1e-5, "{name}: {found}");
    }
}

#[test]
fn tied_nodes_are_moved_onto_the_master_unless_it_is_said_not_to() {
    // The upper cube fills the gap: a rod of 2.05 instead of two of 1.
    near(
        tied("tie-adjust", 0.05, ", POSITION TOLERANCE=.1"),
        0.01 / (1e-3 + 1.05e-3),
        1e-6,
    );
    near(
        tied(
            "tie-adjust-yes",
            0.05,
            ", POSITION TOLERANCE=.1, ADJUST=YES",
        ),
        0.01 / (1e-3 + 1.05e-3),
        1e-6,
    );
}

/// A base of two cubes with two towers of two cubes each on it, with a slit between the towers. `closed` takes the nodes of one side of the slit for
/// those of the other; otherwise the upper storeys have surfaces at the slit.
fn towers(closed: bool, tie: &str) -> String {
    let id = |x: usize, y: usize, z: usize, right: bool| {
        let doubled = x == 1 && z > 1 && right && !closed;
        1 + x + 3 * y + 6 * z + if doubled { 100 } else { 0 }
    };
    let mut nodes = std::collections::BTreeMap::new();
    let mut elements = String::new();
    for (e, (x, z)) in [(0, 0), (1, 0), (0, 1), (1, 1), (0, 2), (1, 2)]
        .into_iter()
        .enumerate()
    {
        let mut list = Vec::new();
        for dz in [0, 1] {
            for (dx, y) in [(0, 0), (1, 0), (1, 1), (0, 1)] {
                let n = id(x + dx, y, z + dz, x == 1);
                nodes.insert(n, [x + dx, y, z + dz]);
                list.push(n.to_string());
            }
        }
        elements += &format!("{}, {}\n", e + 1, list.join(", "));
    }
    let nodes: String = nodes
        .iter()
        .map(|(n, [x, y, z])| format!("{n}, {x}., {y}., {z}.\n"))
        .collect();
    format!(
        "*NODE, NSET=ALL\n{nodes}*ELEMENT, TYPE=C3D8, ELSET=E\n{elements}*NSET, NSET=BOT, GENERATE\n1, 6\n*NSET, NSET=LOAD\n19, 22\n*SURFACE, NAME=LEFT\n5, S4\n\
         *SURFACE, NAME=RIGHT\n6, S6\n{}{tie}*BOUNDARY\nBOT, 1, 3\n*STEP\n*STATIC\n*CLOAD\nLOAD, 1, 1.\nLOAD, 2, .5\n*END STEP\n",
        sections(&["E"])
    )
}

#[test]
fn surfaces_of_one_mesh_are_tied() {
    // As stiff as the towers in one piece. Node 19 is a loaded corner of the left tower.
    let solid = run("towers-solid", &towers(true, "")).u(19);
    near3(
        run(
            "towers-tied",
            &towers(false, "*TIE, NAME=T, POSITION TOLERANCE=.1\nRIGHT, LEFT\n"),
        )
        .u(19),
        solid,
        1e-6,
    );
    let apart = run("towers-apart", &towers(false, "")).u(19);
    assert!(apart[0] > 1.5 * solid[0], "{apart:?} {solid:?}");
    // Faces that have nodes in common cannot be tied.
    let corner = towers(
        false,
        "*SURFACE, NAME=TOP\n5, S2\n*TIE, NAME=T\nTOP, LEFT\n",
    );
    let message = refused(&corner);
    assert!(
        message.contains("2 nodes in common, such as node"),
        "{message}"
    );
}

/// Pulls the upper of two cubes up by 4, or shifts its top.
const PULL: &str = "*STEP\n*STATIC\n*BOUNDARY\nB, 1\n*DLOAD\nEB, P2, -4.\n*END STEP\n";

#[test]
fn tied_contact_has_the_stiffness_that_is_given() {
    let behavior = "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=TIED\n800.\n";
    let text = pair(
        0.0,
        "SURFACE TO SURFACE",
        &format!("{behavior}*FRICTION\n.1, 200.\n"),
    ) + PULL;
    // 0.004 a cube, and 4 over 800.
    near(run("tied-soft", &text).u(17)[2], 0.013, 1e-6);
    // Along the faces it is the stick slope that counts, whatever the coefficient says: nodes that only move along x shear two cubes of 500 and the
    // interface in series.
    let shear = text
        .replace("*BOUNDARY\nA, 2\nB, 2\n", "*BOUNDARY\nA, 2, 3\nB, 2, 3\n")
        .replace(
            "*BOUNDARY\nB, 1\n*DLOAD\nEB, P2, -4.\n",
            "*BOUNDARY\nBTOP, 1, 1, .01\n*NODE PRINT, NSET=BTOP, TOTALS=ONLY\nRF\n",
        );
    let force = run("tied-shear", &shear).last("total force")[0];
    near(
        force,
        0.01 / (1.0 / 500.0 + 1.0 / 500.0 + 1.0 / 200.0),
        1e-6,
    );
    for (without, wanted) in [
        (
            pair(0.0, "SURFACE TO SURFACE", behavior),
            "has none against sliding",
        ),
        (
            pair(
                0.0,
                "NODE TO SURFACE",
                &format!("{behavior}*FRICTION\n.1, 200.\n"),
            ),
            "for pairs of faces",
        ),
    ] {
        let message = refused(&(without + PULL));
        assert!(message.contains(wanted), "{message}");
    }
}

/// Presses the upper cube down by 4.
const PRESS: &str = "*STEP\n*STATIC\n*BOUNDARY\nB, 1\n*DLOAD\nEB, P2, 4.\n*END STEP\n";

#[test]
fn adjust_closes_gaps_by_distance_or_for_a_set_of_nodes() {
    let adjusted = |gap: f64, adjust: &str| {
        let text = pair(gap, "SURFACE TO SURFACE", "");
        let text = text.replace(
            "SURFACE\nSLAVE",
            &format!("SURFACE, ADJUST={adjust}\nSLAVE"),
        );
        text.replace(
            "*SURFACE INTERACTION",
            "*NSET, NSET=HALF\n11, 14\n*SURFACE INTERACTION",
        ) + PRESS
    };
    // What is adjusted is pressed as if it had touched; the cube that was made longer by the gap is a little softer.
    let closed = |gap: f64| -0.004 - 0.004 * (1.0 + gap);
    near(
        run("adjust-within", &adjusted(0.05, ".06")).u(17)[2],
        closed(0.05),
        1e-6,
    );
    near(
        run("adjust-set", &adjusted(0.05, "BBOT")).u(17)[2],
        closed(0.05),
        1e-6,
    );
    // A gap beyond the distance stays: the cube has to come down first.
    near(
        run("adjust-not", &adjusted(0.05, "0.")).u(17)[2],
        -0.058,
        1e-6,
    );
    // Only nodes of the set are moved: half of the gap is left.
    let half = run("adjust-half", &adjusted(0.001, "HALF"));
    near(half.u(17)[2], -0.0085, 1e-3);
    // Overlaps are always taken away, whatever the distance.
    near(
        run("adjust-overlap", &adjusted(-0.05, "0.")).u(17)[2],
        closed(-0.05),
        1e-6,
    );
    let message = refused(&adjusted(0.0, "NOWHERE"));
    assert!(message.contains("no set of nodes NOWHERE"), "{message}");
}

/// Slides the upper cube, pressed by `pressure`, by 0.002 in the time 1. The ratio of the forces along and across. The interface is soft, so that the
/// pressure is the same everywhere.
fn ratio(name: &str, friction: &str, pressure: f64) -> f64 {
    let text = pair(
        0.0,
        "SURFACE TO SURFACE",
        &format!("*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n1.\n*FRICTION\n{friction}"),
    ) + &format!(
        "*STEP\n*STATIC\n*BOUNDARY\nB, 1, 1, 0.\n*DLOAD\nEB, P2, {pressure}\n*END STEP\n*STEP\n*STATIC\n.25, 1.\n*BOUNDARY\nB, 1, 1, .002\n\
         *NODE PRINT, NSET=B, TOTALS=ONLY\nRF\n*END STEP\n"
    );
    run(name, &text).last("total force")[0] / pressure
}

#[test]
fn friction_follows_its_table_over_slip_rate_and_pressure() {
    // At rest 0.3, at twice the rate of this step 0.1.
    near(
        ratio("friction-rate", ".3, 0.\n.1, .004\n", 0.04),
        0.2,
        2e-2,
    );
    near(
        ratio("friction-pressure", ".4, 0., .02\n.2, 0., .06\n", 0.04),
        0.3,
        2e-2,
    );
    let both = ".4, 0., .02\n.2, .004, .02\n.2, 0., .06\n0., .004, .06\n";
    near(ratio("friction-both", both, 0.04), 0.2, 2e-2);
    for (rows, wanted) in [
        (
            ".4, 0., .02\n.2, .004, .02\n.2, 0., .06\n",
            "the table of coefficients has gaps",
        ),
        (".4, 0., .02\n.2, 0., .02\n", "already"),
        (".4, 0., 0., 20.\n.2, 0., 0., 80.\n", "field 4 of this line"),
    ] {
        let text = pair(0.0, "SURFACE TO SURFACE", &format!("*FRICTION\n{rows}")) + PRESS;
        let message = refused(&text);
        assert!(message.contains(wanted), "{message}");
    }
}

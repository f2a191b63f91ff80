//! What decks as people have them contain beside the plain cards: each against what it means in numbers.

use std::path::Path;

use crate::support::{cube, near, pair, refused, run, sections};
use stickslip_deck::{Deck, SurfaceParts};

fn read(text: &str) -> Deck {
    stickslip_deck::parse(text.as_bytes(), Path::new("job.inp")).unwrap_or_else(|e| panic!("{e}"))
}

fn pressed(gap: f64, kind: &str, step: &str) -> String {
    let law = "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n1.E4\n";
    format!("{}*STEP\n{step}*END STEP\n", pair(gap, kind, law))
}

const HELD: &str = "*STATIC, DIRECT\n.5, 1.\n*BOUNDARY\nBTOP, 1, 3\n*NODE PRINT, NSET=BTOP, TOTALS=ONLY\nRF\n*CONTACT PRINT, TOTALS=YES\nCELS\n";

#[test]
fn overlap_goes_away_over_the_first_step_where_faces_meet_faces() {
    let run = run("habit-overlap", &pressed(-0.01, "SURFACE TO SURFACE", HELD));
    // Two cubes and the spring between them, in series; CalculiX 2.20 prints -2.380952 and -4.761905.
    let whole = 0.01 / (2.0 / 1000.0 + 1.0 / 1e4);
    let course = run.course("total force", 2);
    assert_eq!(course.len(), 2);
    near(course[0].1, -0.5 * whole, 1e-6);
    near(course[1].1, -whole, 1e-6);
}

#[test]
fn contact_energy_is_printed_by_node() {
    let run = run("habit-energy", &pressed(-0.01, "SURFACE TO SURFACE", HELD));
    let (_, _, rows) = run.all("contact print energy").pop().expect("a block");
    let p: f64 = 0.01 / (2.0 / 1000.0 + 1.0 / 1e4);
    let whole = p * p / 2.0 / 1e4;
    assert_eq!(rows.len(), 4);
    for row in &rows {
        assert!((11.0..=14.0).contains(&row[0]), "{row:?}");
        near(row[1], 0.25 * whole, 1e-6);
    }
    // CalculiX 2.20: 1.133787e-3.
    near(run.last("total contact spring energy")[0], whole, 1e-6);
}

#[test]
fn tied_pairs_of_abaqus_are_ties() {
    // Pulled by 0.01 over a height of 2.
    let step = "*STATIC\n*BOUNDARY\nBTOP, 1, 2\nBTOP, 3, 3, .01\n*NODE PRINT, NSET=BTOP, TOTALS=ONLY\nRF\n";
    let text = pressed(0.0, "SURFACE TO SURFACE", step);
    let tied = text.replace("*CONTACT PAIR, ", "*CONTACT PAIR, TIED, ADJUST=0.001, ");
    near(run("habit-tied", &tied).last("total force")[2], 5.0, 1e-5);
    let bare = refused(&text.replace("*CONTACT PAIR, ", "*CONTACT PAIR, TIED, "));
    assert!(bare.contains("does not say how far"), "{bare}");
}

#[test]
fn surfaces_are_combined() {
    let text = format!(
        "{}{}*SURFACE, NAME=A\nEN, S1\nEN, S2\n*SURFACE, NAME=B\nEN, S2\nEN, S3\n*SURFACE, NAME=U, COMBINE=UNION\nA, B\n\
         *SURFACE, NAME=I, COMBINE=INTERSECTION\nA, B\n*SURFACE, NAME=D, COMBINE=DIFFERENCE\nA, B\n*SURFACE, TYPE=NODE, NAME=N\nNTOP, 1.\n\
         *SURFACE, TYPE=NODE, NAME=M, COMBINE=UNION\nN, N\n",
        cube("N", 1, 0.0),
        sections(&["EN"])
    );
    let deck = read(&text);
    let faces = |name: &str| match &deck.surfaces[name].parts {
        SurfaceParts::Faces(f) => f.iter().map(|(_, face)| face.unwrap_or(0)).collect(),
        SurfaceParts::Nodes(n) => n.iter().map(|n| *n as usize).collect::<Vec<_>>(),
    };
    assert_eq!(faces("U"), [1, 2, 3]);
    assert_eq!(faces("I"), [2]);
    assert_eq!(faces("D"), [1]);
    assert_eq!(faces("M"), [5, 6, 7, 8]);
    for (card, said) in [
        ("COMBINE=UNION\nA, C\n", "there is no surface C"),
        ("COMBINE=SUM\nA, B\n", "COMBINE=SUM is not known"),
        ("COMBINE=UNION\nA, N\n", "do not go together"),
        ("COMBINE=DIFFERENCE\nA, A\n", "nothing is left"),
    ] {
        let found = refused(&format!(
            "{text}*SURFACE, NAME=X, {card}*STEP\n*STATIC\n*END STEP\n"
        ));
        assert!(found.contains(said), "{found}");
    }
}

#[test]
fn names_of_parameters_may_be_cut_short_and_titles_may_have_any() {
    let deck = read(&format!(
        "*HEADING, SPARSE, UNSYMM\nA title, with a comma\n{}{}*STEP\n*STATIC\n1., 1.\n*NODE PRINT, NSET=N, FREQ=2\nU\n*END STEP\n",
        cube("N", 1, 0.0),
        sections(&["EN"])
    ));
    assert_eq!(deck.output.title.as_deref(), Some("A title, with a comma"));
    let notes: Vec<String> = deck.notes.iter().map(ToString::to_string).collect();
    assert!(
        notes
            .iter()
            .any(|n| n.contains("FREQ is taken as FREQUENCY")),
        "{notes:?}"
    );
    // What could be two things is neither.
    let said = refused(&format!("{}*SURFACE, NAM=A\nEN, S1\n", cube("N", 1, 0.0)));
    assert!(said.contains("has no parameter NAM"), "{said}");
}

#[test]
fn nodes_may_come_after_their_elements() {
    let text = pressed(-0.01, "SURFACE TO SURFACE", HELD);
    // The nodes of the second cube to the end of the model.
    let at = text.rfind("*NODE, NSET=B").expect("nodes");
    let end = at + text[at..].find("*ELEMENT").expect("elements");
    let moved = text[at..end].replace(", NSET=B", "");
    let rest = format!("{}{}", &text[..at], &text[end..]);
    let at = rest.find("*NSET, NSET=BBOT").expect("a set");
    let late = format!(
        "{}{moved}*NSET, NSET=B, GENERATE\n11, 18\n{}",
        &rest[..at],
        &rest[at..]
    );
    let whole = 0.01 / (2.0 / 1000.0 + 1.0 / 1e4);
    near(
        run("habit-late-nodes", &late).last("total force")[2],
        -whole,
        1e-6,
    );
}

#[test]
fn what_goes_with_an_analysis_that_is_refused_is_no_error_of_its_own() {
    let said = refused(&format!(
        "{}{}*STEP, PERTURBATION\n*COMPLEX FREQUENCY, CORIOLIS\n10\n*END STEP\n",
        cube("N", 1, 0.0),
        sections(&["EN"])
    ));
    let errors = said.lines().filter(|l| l.contains(": error: ")).count();
    assert_eq!(errors, 1, "{said}");
    assert!(
        said.contains("*COMPLEX FREQUENCY, CORIOLIS is not supported"),
        "{said}"
    );
}

#[test]
fn what_acts_along_other_axes_in_each_program_is_refused() {
    let deck = format!(
        "{}{}*NODE\n99, .5, .5, 2.\n*SURFACE, NAME=S\nEN, S2\n*ORIENTATION, NAME=O\n0., 1., 0., -1., 0., 0.\n\
         *COUPLING, REF NODE=99, SURFACE=S, CONSTRAINT NAME=C, ORIENTATION=O\n*DISTRIBUTING\n*BOUNDARY\nNBOT, 1, 3\n\
         *STEP\n*STATIC\n*CLOAD\n99, 4, 1.\n*END STEP\n",
        cube("N", 1, 0.0),
        sections(&["EN"])
    );
    let said = refused(&deck);
    assert!(said.contains("along its axes in CalculiX"), "{said}");
}

/// Two cells C3D20 in a row along x, 4 by 1 by 1, that move along x only.
fn quadratic_bar(kind: &str) -> String {
    let mut at = std::collections::BTreeMap::new();
    let (mut nodes, mut elements) = (String::new(), String::new());
    let corners = [[0, 0], [2, 0], [2, 2], [0, 2]];
    let middles = [[1, 0], [2, 1], [1, 2], [0, 1]];
    let layer = |of: [[usize; 2]; 4], z: usize| of.map(|[x, y]| [x, y, z]);
    let order = [
        layer(corners, 0),
        layer(corners, 2),
        layer(middles, 0),
        layer(middles, 2),
        layer(corners, 1),
    ];
    for cell in 0..2 {
        let mut ids = Vec::new();
        for [x, y, z] in order.iter().flatten() {
            let next = at.len() + 1;
            let key = [x + 2 * cell, *y, *z];
            let id = *at.entry(key).or_insert(next);
            if id == next {
                let x = key.map(|c| c as f64 / 2.0);
                nodes += &format!("{id}, {}, {}, {}\n", 2.0 * x[0], x[1], x[2]);
            }
            ids.push(id.to_string());
        }
        elements += &format!("{}, {}\n", cell + 1, ids.join(", "));
    }
    let mut warm = String::new();
    let (mut near, mut far) = (String::new(), String::new());
    for (key, id) in &at {
        let x = key[0] as f64 / 4.0;
        warm += &format!("{id}, {}\n", 1000.0 * x * x);
        match key[0] {
            0 => near += &format!("{id},\n"),
            4 => far += &format!("{id},\n"),
            _ => {}
        }
    }
    format!(
        "*NODE, NSET=N\n{nodes}*ELEMENT, TYPE={kind}, ELSET=E\n{elements}*NSET, NSET=X0\n{near}*NSET, NSET=X1\n{far}\
         *MATERIAL, NAME=M\n*ELASTIC\n200000., 0.\n*EXPANSION\n1.E-5\n*SOLID SECTION, ELSET=E, MATERIAL=M\n*BOUNDARY\nX0, 1\nN, 2, 3\n\
         *INITIAL CONDITIONS, TYPE=TEMPERATURE\nN, 0.\n*STEP\n*STATIC\n*TEMPERATURE\n{warm}*NODE PRINT, NSET=X1\nU\n*END STEP\n"
    )
}

#[test]
fn quadratic_cells_expand_by_the_temperatures_of_all_their_nodes() {
    for kind in ["C3D20", "C3D20R"] {
        let run = run(&format!("habit-warm-{kind}"), &quadratic_bar(kind));
        // The integral of α T = 1e-5 * 1000 (x / 4)² over 4; CalculiX 2.20 prints 1.333333E-02 for both.
        near(run.last("displacements")[1], 4.0e-2 / 3.0, 1e-6);
    }
}

#[test]
fn the_arm_of_a_reference_node_is_told_where_calculix_has_none() {
    let deck = |z: f64| {
        let text = format!(
            "{}{}*NODE\n99, .5, .5, {z}\n*ELEMENT, TYPE=DCOUP3D, ELSET=D\n99, 99\n*DISTRIBUTING COUPLING, ELSET=D\nNTOP, 1.\n\
             *BOUNDARY\nNBOT, 1, 3\n*STEP\n*STATIC\n*CLOAD\n99, 1, 1.\n*END STEP\n",
            cube("N", 1, 0.0),
            sections(&["EN"])
        );
        run(&format!("habit-arm-{z}"), &text).notes.join("\n")
    };
    assert!(
        deck(3.0).contains("lies 2 from the centre"),
        "{}",
        deck(3.0)
    );
    assert!(!deck(1.0).contains("from the centre"), "{}", deck(1.0));
}

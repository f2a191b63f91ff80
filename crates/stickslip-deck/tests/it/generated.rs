//! Nodes and elements that decks generate as in Abaqus, against places and results that are computed by hand.

use std::path::Path;

use crate::support::{near, near3, refused, run};
use stickslip_deck::Deck;

fn read(text: &str) -> Deck {
    stickslip_deck::parse(text.as_bytes(), Path::new("job.inp")).unwrap_or_else(|e| panic!("{e}"))
}

/// A bar of 4 by 2 by 1 in cells with edges of one, generated from eight nodes and one element, held at x = 0 and drawn by 30 at x = 4.
const BAR: &str = "*NODE\n1, 0., 0., 0.\n5, 4., 0., 0.\n21, 0., 2., 0.\n25, 4., 2., 0.\n101, 0., 0., 1.\n105, 4., 0., 1.\n121, 0., 2., 1.\n125, 4., 2., 1.\n\
    *NGEN, NSET=L\n1, 5\n*NGEN, NSET=H\n21, 25, 1\n*NFILL, NSET=LOW\nL, H, 2, 10\n\
    *NCOPY, OLD SET=LOW, CHANGE NUMBER=100, SHIFT, NEW SET=HIGH\n0., 0., 1.\n\
    *ELEMENT, TYPE=C3D8\n1, 1, 2, 12, 11, 101, 102, 112, 111\n*ELGEN, ELSET=E\n1, 4, 1, 1, 2, 10, 10\n";

const PULLED: &str = "*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.25\n*SOLID SECTION, ELSET=E, MATERIAL=M\n*NSET, NSET=X0\n1, 11, 21, 101, 111, 121\n\
    *NSET, NSET=X4\n5, 15, 25, 105, 115, 125\n*BOUNDARY\nX0, 1\n1, 1, 3\n101, 2\n21, 3\n\
    *STEP\n*STATIC\n*DLOAD\n4, P4, -30.\n14, P4, -30.\n*NODE PRINT, NSET=X0, TOTALS=ONLY\nRF\n*END STEP\n";

#[test]
fn a_generated_bar_stretches_as_one_that_is_written_out() {
    // σ = 30, ε = 0.03, ν ε across.
    let run = run("generated-bar", &format!("{BAR}{PULLED}"));
    near3(run.u(125), [0.12, -0.015, -0.0075], 1e-9);
    near3(run.u(12), [0.03, -0.0075, 0.0], 1e-9);
    near(run.last("total force")[0], -60.0, 1e-9);
}

#[test]
fn generated_bars_of_instances_are_the_same() {
    let part = BAR.to_string();
    let text = format!(
        "*PART, NAME=P\n{part}*SOLID SECTION, ELSET=E, MATERIAL=M\n*NSET, NSET=X0\n1, 11, 21, 101, 111, 121\n*END PART\n*ASSEMBLY, NAME=A\n\
         *INSTANCE, NAME=I, PART=P\n*END INSTANCE\n*INSTANCE, NAME=J, PART=P\n0., 0., 9.\n0., 0., 0., 0., 0., 1., 90.\n*END INSTANCE\n*END ASSEMBLY\n\
         *MATERIAL, NAME=M\n*ELASTIC\n1000., 0.25\n*BOUNDARY\nI.X0, 1\nI.1, 2, 3\nI.101, 2\nI.21, 3\nJ.X0, 2\nJ.1, 1\nJ.1, 3\nJ.101, 1\nJ.21, 3\n\
         *STEP\n*STATIC\n*DLOAD\nI.4, P4, -30.\nI.14, P4, -30.\nJ.4, P4, -30.\nJ.14, P4, -30.\n*END STEP\n"
    );
    let run = run("generated-instances", &text);
    let deck = read(&text);
    let of = |label: &str| {
        let mut all = deck.nodes.keys();
        *all.find(|n| deck.label(**n) == label).expect(label)
    };
    near3(run.u(of("I.125")), [0.12, -0.015, -0.0075], 1e-9);
    near3(run.u(of("J.125")), [0.015, 0.12, -0.0075], 1e-9);
}

#[test]
fn nodes_lie_on_lines_arcs_and_parabolas() {
    let deck = read(
        "*NODE, SYSTEM=C\n1, 2., 0., 3.\n9, 2., 90., 3.\n*NODE\n20, 0., 0., 3.\n31, 0., 0., 0.\n35, 4., 0., 0.\n36, 2., 4., 0.\n\
         41, 5., 0.\n49, 5., 0.\n*NGEN, LINE=C, NSET=ARC\n1, 9, 4, 20\n*NGEN, LINE=C\n9, 1, -2, , 0., 0., 3., 0., 0., 1.\n\
         *NGEN, LINE=P\n31, 35, 1, 36\n*NGEN, LINE=C, SYSTEM=C, NSET=RING\n41, 49, 1, , 3., 0., 0., 0., 0., 1.\n\
         *NODE, NSET=LAST\n50, 7., 7., 7.\n*ELEMENT, TYPE=MASS\n1, 1\n",
    );
    let h = 2.0_f64.sqrt();
    near3(deck.nodes[&5], [-h, -h, 3.0], 1e-12);
    // Backwards about +z from the y axis: 270 degrees in steps of 67.5.
    let (s, c) = 157.5_f64.to_radians().sin_cos();
    near3(deck.nodes[&7], [2.0 * c, 2.0 * s, 3.0], 1e-12);
    assert_eq!(deck.node_sets["ARC"], [1, 5, 9]);
    near3(deck.nodes[&32], [1.0, 3.0, 0.0], 1e-12);
    near3(deck.nodes[&33], [2.0, 4.0, 0.0], 1e-12);
    // A full turn about (3, 0) with a radius of 2.
    near3(deck.nodes[&45], [1.0, 0.0, 0.0], 1e-12);
    near3(deck.nodes[&43], [3.0, 2.0, 0.0], 1e-12);
    assert_eq!(deck.node_sets["RING"].len(), 9);
}

#[test]
fn bounds_are_joined_in_the_order_of_their_numbers_unless_they_are_unsorted() {
    let nodes = "*NODE\n1, 0., 0.\n2, 0., 1.\n11, 7., 0.\n12, 7., 1.\n*NSET, NSET=B\n12, 11\n*NSET, NSET=U, UNSORTED\n12, 11\n*NSET, NSET=A\n1, 2\n\
                 *ELEMENT, TYPE=CPS4\n1, 1, 2, 12, 11\n";
    let sorted = read(&format!("{nodes}*NFILL, BIAS=.5\nA, B, 3, 100\n"));
    // Distances of 1, 2 and 4.
    near3(sorted.nodes[&101], [1.0, 0.0, 0.0], 1e-12);
    near3(sorted.nodes[&202], [3.0, 1.0, 0.0], 1e-12);
    let crossed = read(&format!("{nodes}*NFILL, NSET=ALL\nA, U, 7, 100\n"));
    near3(crossed.nodes[&101], [1.0, 1.0 / 7.0, 0.0], 1e-12);
    assert_eq!(crossed.node_sets["ALL"].len(), 16);
}

#[test]
fn copies_are_moved_turned_and_reflected() {
    let nodes = "*NODE, NSET=N\n1, 1., 2., 3.\n*ELEMENT, TYPE=MASS\n1, 1\n";
    for (how, place) in [
        (
            "SHIFT\n1., 0., 0.\n0., 0., 0., 0., 0., 1., 90.",
            [-2.0, 2.0, 3.0],
        ),
        ("SHIFT\n0., 0., -3.\n", [1.0, 2.0, 0.0]),
        ("REFLECT=POINT\n0., 0., 1.", [-1.0, -2.0, -1.0]),
        ("REFLECT=LINE\n0., 0., 0., 0., 5., 0.", [-1.0, 2.0, -3.0]),
        (
            "REFLECT=MIRROR\n0., 0., 1., 1., 0., 1.\n0., 1., 1.",
            [1.0, 2.0, -1.0],
        ),
    ] {
        let deck = read(&format!(
            "{nodes}*NCOPY, OLD SET=N, CHANGE NUMBER=5, NEW SET=M, {how}\n"
        ));
        near3(deck.nodes[&6], place, 1e-12);
        assert_eq!(deck.node_sets["M"], [6]);
    }
}

#[test]
fn a_reflected_block_is_not_inside_out_and_its_faces_have_no_known_numbers() {
    for kind in ["C3D8", "C3D20"] {
        let mut text = "*NODE, NSET=N\n1, 1., 0., 0.\n2, 2., 0., 0.\n3, 2., 1., 0.\n4, 1., 1., 0.\n5, 1., 0., 1.\n6, 2., 0., 1.\n7, 2., 1., 1.\n8, 1., 1., 1.\n".to_string();
        if kind == "C3D20" {
            text += "9, 1.5, 0., 0.\n10, 2., .5, 0.\n11, 1.5, 1., 0.\n12, 1., .5, 0.\n13, 1.5, 0., 1.\n14, 2., .5, 1.\n15, 1.5, 1., 1.\n16, 1., .5, 1.\n\
                     17, 1., 0., .5\n18, 2., 0., .5\n19, 2., 1., .5\n20, 1., 1., .5\n";
        }
        let count = if kind == "C3D8" { 8 } else { 20 };
        let all: Vec<String> = (1..=count).map(|n: u32| n.to_string()).collect();
        text += &format!("*ELEMENT, TYPE={kind}, ELSET=E\n1, {}\n", all.join(", "));
        let (low, high) = match kind {
            "C3D8" => ("101, 102, 103, 104", "105, 106, 107, 108"),
            _ => (
                "101, 102, 103, 104, 109, 110, 111, 112",
                "105, 106, 107, 108, 113, 114, 115, 116",
            ),
        };
        text += &format!(
            "*NCOPY, OLD SET=N, CHANGE NUMBER=100, REFLECT=MIRROR, NEW SET=M\n1., 0., 0., 1., 1., 0.\n1., 0., 1.\n\
             *ELCOPY, OLD SET=E, ELEMENT SHIFT=1, SHIFT NODES=100, REFLECT, NEW SET=F\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.\n\
             *SOLID SECTION, ELSET=E, MATERIAL=M\n*SOLID SECTION, ELSET=F, MATERIAL=M\n*NSET, NSET=LOW\n{low}\n*NSET, NSET=TOP\n{high}\n"
        );
        let moved = "*BOUNDARY\nM, 1, 2\nLOW, 3\nN, 1, 3\n*STEP\n*STATIC\n*BOUNDARY\nTOP, 3, 3, .01\n*NODE PRINT, NSET=TOP, TOTALS=ONLY\nRF\n*END STEP\n";
        // A unit cube with E = 1000 that is stretched by 0.01.
        let run = run(
            &format!("generated-mirror-{kind}"),
            &format!("{text}{moved}"),
        );
        near(run.last("total force")[2], 10.0, 1e-9);
        let said = refused(&format!(
            "{text}*SURFACE, NAME=S\nF, S3\n*STEP\n*STATIC\n*END STEP\n"
        ));
        assert!(said.contains("*ELCOPY, REFLECT"), "{said}");
    }
}

#[test]
fn mistakes_are_said_at_their_lines() {
    let nodes =
        "*NODE\n1, 0., 0.\n4, 1., 0.\n*NSET, NSET=A\n1\n*ELEMENT, TYPE=MASS, ELSET=E\n1, 1\n";
    for (card, said) in [
        ("*NGEN\n1, 4, 2\n", "do not divide into steps of 2"),
        ("*NGEN\n1, 9\n", "there is no node 9"),
        (
            "*NGEN, LINE=C\n1, 4\n",
            "the ends of the arc are 0 and 1 from its center",
        ),
        (
            "*NGEN, LINE=C\n1, 4, 1, , .5, 0.\n",
            "its plane is not known",
        ),
        ("*NFILL\nA, B, 2, 1\n", "there is no set of nodes B"),
        ("*NFILL, BIAS=-1.\nA, A, 2, 1\n", "BIAS is -1"),
        (
            "*NCOPY, OLD SET=A, CHANGE NUMBER=1\n1., 0., 0.\n",
            "does not say where",
        ),
        (
            "*NCOPY, OLD SET=A, CHANGE NUMBER=-1, SHIFT\n1., 0., 0.\n",
            "would have the number 0",
        ),
        (
            "*NCOPY, OLD SET=A, CHANGE NUMBER=1.5, SHIFT\n1., 0., 0.\n",
            "CHANGE NUMBER is `1.5`",
        ),
        ("*ELGEN\n2, 4\n", "there is no element 2"),
        ("*ELGEN\n1, 4\n", "uses node 2, which does not exist"),
        ("*ELGEN\n1, 1, 1, 1, 3, 2\n", "field 7 is missing"),
        (
            "*ELCOPY, OLD SET=F, ELEMENT SHIFT=1, SHIFT NODES=1\n",
            "there is no set of elements F",
        ),
        (
            "*ELCOPY, OLD SET=E, ELEMENT SHIFT=1, SHIFT NODES=1, REFLECT\n",
            "MASS cannot be reflected",
        ),
    ] {
        let text = refused(&format!("{nodes}{card}"));
        let line = nodes.lines().count() + card.lines().count();
        let at = [line, line - 1].map(|l| format!("job.inp:{l}: error"));
        assert!(text.contains(said), "{card}{text}");
        assert!(at.iter().any(|a| text.contains(a)), "{card}{text}");
    }
}

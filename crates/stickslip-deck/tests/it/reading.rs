//! How files become cards, and cards a deck.

use std::path::Path;

use stickslip_deck::{Action, Deck, Elastic, Print, Severity};

use crate::support::{place, refused};

fn read(text: &str) -> Deck {
    stickslip_deck::parse(text.as_bytes(), Path::new("job.inp")).unwrap_or_else(|e| panic!("{e}"))
}

const TET: &str = "*NODE, NSET=N\n1, 0., 0., 0.\n2, 1., 0., 0.\n3, 0., 1., 0.\n4, 0., 0., 1.\n*ELEMENT, TYPE=C3D4, ELSET=E\n1, 1, 2, 3, 4\n";

fn with(more: &str) -> Deck {
    read(&format!("{TET}{more}"))
}

#[test]
fn case_blanks_comments_and_line_ends_do_not_matter() {
    let plain =
        with("*NSET, NSET=SIDE\n1, 2\n*MATERIAL, NAME=STEEL\n*ELASTIC, TYPE=ISO\n2.1E5, .3\n");
    let odd = format!(
        "\u{feff}** made by hand\r\n{}  * nSet ,  NSet = Side \r\n\r\n 1 ,\t2 , \r\n** ++++ Materials ++++\r\n**\r\n*Material, Name= steel\r\n\
         *ELASTIC , Type = Iso\r\n 2.1d+5 , 3.e-1\r\n",
        TET.replace('\n', "\r\n")
    );
    let odd = read(&odd);
    assert_eq!(odd.node_sets, plain.node_sets);
    assert_eq!(odd.nodes, plain.nodes);
    assert_eq!(
        odd.properties.materials["STEEL"].elastic,
        Some(Elastic::Isotropic([2.1e5, 0.3]))
    );
    assert_eq!(odd.elements.len(), 1);
}

#[test]
fn numbers_are_those_of_fortran() {
    let deck = with(
        "*MATERIAL, NAME=A\n*ELASTIC\n1.5+3, .25D0\n*MATERIAL, NAME=B\n*ELASTIC\n+2.d-3, 1\n*MATERIAL, NAME=C\n*ELASTIC\n7, -1.-1\n",
    );
    let of = |name: &str| deck.properties.materials[name].elastic.clone();
    assert_eq!(of("A"), Some(Elastic::Isotropic([1500.0, 0.25])));
    assert_eq!(of("B"), Some(Elastic::Isotropic([2e-3, 1.0])));
    assert_eq!(of("C"), Some(Elastic::Isotropic([7.0, -0.1])));
    for wrong in ["inf", "0x10", "1e", "1..2", "--1"] {
        let message = refused(&format!("{TET}*MATERIAL, NAME=A\n*ELASTIC\n{wrong}, .3\n"));
        assert!(message.contains("job.inp:10: error: field 1"), "{message}");
    }
}

#[test]
fn keyword_lines_go_on_after_a_comma() {
    let deck = with(
        "*SURFACE INTERACTION,\n** between\n  NAME=SI\n*NSET, NSET=A,\n1, 2\n*NSET,\nNSET=B,\nGENERATE\n1, 3, 2\n",
    );
    assert!(deck.contact.interactions.contains_key("SI"));
    // A comma too many before data is no continuation.
    assert_eq!(deck.node_sets["A"], [1, 2]);
    assert_eq!(deck.node_sets["B"], [1, 3]);
}

#[test]
fn a_comma_too_many_is_forgiven() {
    let step = "*MATERIAL, NAME=M\n*ELASTIC\n1., .3\n*STEP\n*STATIC\n";
    let deck = with(&format!(
        "{step}*NODE PRINT, NSET=N,\nU, RF\n*BOUNDARY,\nN, 1, 3\n*BOUNDARY,\nOP=NEW\nN, 2\n*END STEP\n"
    ));
    let [Print::Node { keys, .. }] = deck.steps[0].prints.as_slice() else {
        panic!("{:?}", deck.steps[0].prints);
    };
    assert_eq!(keys, &["U", "RF"]);
    let lines = deck.steps[0]
        .actions
        .iter()
        .filter(|a| matches!(a, Action::Boundary(_)));
    assert_eq!(lines.count(), 2);
    let forgiven = deck
        .notes
        .iter()
        .filter(|n| n.message.contains("one too many"));
    assert_eq!(forgiven.map(|n| n.line).collect::<Vec<_>>(), [13, 15]);
}

#[test]
fn what_calculix_forgives_is_forgiven_where_it_changes_nothing() {
    // A set that is only printed may name nodes that are not there.
    let step = "*STEP\n*STATIC\n*NODE PRINT, NSET=A\nU\n*END STEP\n";
    let deck = with(&format!("*NSET, NSET=A\n1, 29\n{step}"));
    assert_eq!(deck.node_sets["A"], [1]);
    assert!(
        deck.notes
            .iter()
            .any(|n| n.message.contains("there is no node 29"))
    );
    for used in [
        "*BOUNDARY\nA, 1\n",
        "*NSET, NSET=B\nA\n",
        "*TRANSFORM, NSET=A\n1., 0., 0., 0., 1., 0.\n",
    ] {
        let message = refused(&format!("{TET}*NSET, NSET=A\n1, 29\n{used}{step}"));
        assert!(
            message.contains("job.inp:9: error: there is no node 29"),
            "{message}"
        );
    }
    // Numbers behind the nodes of an element, unless they are those of another type.
    let filled = TET.replace("1, 1, 2, 3, 4\n", "1, 1, 2, 3, 4, 0, 0, 0, 0\n");
    assert_eq!(read(&filled).elements[&1].nodes, [1, 2, 3, 4]);
    let wide = TET.replace("1, 1, 2, 3, 4\n", "1, 1, 2, 3, 4, 1, 1, 1\n");
    let deck = read(&wide);
    assert_eq!(deck.elements[&1].nodes, [1, 2, 3, 4]);
    assert!(
        deck.notes
            .iter()
            .any(|n| n.message.contains("further numbers"))
    );
    let message = refused(&TET.replace("1, 1, 2, 3, 4\n", "1, 1, 2, 3, 4, 1, 1, 1, 1, 1, 1\n"));
    assert!(message.contains("has 10 nodes; C3D4 has 4"), "{message}");
}

#[test]
fn a_restart_is_the_only_thing_said_of_a_deck_that_goes_on_from_one() {
    let message =
        refused("*RESTART, READ, STEP=1\n*STEP\n*STATIC\n*EL PRINT, ELSET=NOWHERE\nS\n*END STEP\n");
    assert_eq!(message.matches("error:").count(), 2, "{message}");
    assert!(
        message
            .lines()
            .next()
            .is_some_and(|l| l.contains("*RESTART, READ")),
        "{message}"
    );
    assert!(!message.contains("NOWHERE"), "{message}");
}

#[test]
fn messages_name_what_is_meant() {
    for (card, wanted) in [
        (
            "*ELEMENT, TYPE=D\n7, 1, 2, 3\n",
            "networks of flows are not computed: 1 element of type D",
        ),
        (
            "*STEP\n*STATIC\n*DLOAD\nE, P, 1.\n*END STEP\n",
            "P1 to P6; on a surface use *DSLOAD",
        ),
        (
            "*STEP\n*STATIC\n*DLOAD\nE, P1, 1., 3.\n*END STEP\n",
            "field 4 of this line, `3.`",
        ),
        (
            "*SPRING, ELSET=E\n\n1.\n2., 1.\n",
            "a spring has one stiffness",
        ),
        (
            "*SOLID SECTION, ELSET=E, MATERAIL=M\n",
            "did you mean MATERIAL?",
        ),
        (
            "*NORMAL, TYPE=CONTACT SURFACE\n1, 2, 0., 0., 1.\n",
            "those of their faces",
        ),
        (
            "*AMPLITUDE, NAME=A, VALUE=ABSOLUTE\n0., 1.\n",
            "amplitudes multiply",
        ),
    ] {
        let message = refused(&format!("{TET}{card}"));
        assert!(message.contains(wanted), "{message}");
    }
}

#[test]
fn quoted_names_keep_blanks_case_and_commas() {
    let deck = with(
        "*NSET, NSET=\"My set, 1\"\n1\n*NSET, NSET=my set\n2\n*NSET, NSET=BOTH\n\"My set, 1\", MySet\n",
    );
    assert_eq!(deck.node_sets["My set, 1"], [1]);
    assert_eq!(deck.node_sets["MYSET"], [2]);
    assert_eq!(deck.node_sets["BOTH"], [1, 2]);
}

#[test]
fn sets_are_generated_joined_and_made_of_elements() {
    let deck = with(
        "*NSET, NSET=A, GENERATE\n1, 9, 3\n*NSET, NSET=B\n2, A,\n3\n*NSET, NSET=B\n3, 4\n*ELSET, ELSET=X, GENERATE\n1, 4000000000\n\
         *ELSET, ELSET=Y\nX, 1\n*NSET, NSET=C, ELSET=Y\n",
    );
    assert_eq!(deck.node_sets["A"], [1, 4]);
    assert_eq!(deck.node_sets["B"], [2, 1, 4, 3]);
    assert_eq!(deck.element_sets["Y"], [1]);
    assert_eq!(deck.node_sets["C"], [1, 2, 3, 4]);
}

#[test]
fn elements_go_on_until_they_have_their_nodes() {
    let nodes: String = (1..=20).map(|i| format!("{i}, {i}., 0., 0.\n")).collect();
    let deck = read(&format!(
        "*NODE\n{nodes}*ELEMENT, TYPE=C3D20, ELSET=E\n7, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10,\n11, 12, 13, 14, 15,\n16, 17, 18, 19, 20\n8, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10\n 11, 12, 13, 14, 15, 16, 17, 18, 19, 20,\n"
    ));
    assert_eq!(deck.elements[&7].nodes, (1..=20).collect::<Vec<u64>>());
    assert_eq!(deck.elements[&8].nodes, (1..=20).collect::<Vec<u64>>());
    assert_eq!(deck.element_sets["E"], [7, 8]);
}

#[test]
fn included_files_stand_in_the_middle_of_data() {
    let folder = place("include");
    std::fs::create_dir_all(folder.join("inner")).expect("a folder");
    let write = |name: &str, text: &str| std::fs::write(folder.join(name), text).expect("a file");
    write(
        "nodes.inp",
        "3, 0., 1., 0.\n*INCLUDE, INPUT=inner\\more.inp\n",
    );
    // Beside the file that includes it, or in the folder of the job.
    write("inner/more.inp", "4, 0., 0., 1.\n*include, input=set.inp\n");
    write("set.inp", "*NSET, NSET=A\n1\n");
    write(
        "job.inp",
        "*NODE\n1, 0., 0., 0.\n2, 1., 0., 0.\n*INCLUDE, INPUT=\"nodes.inp\",\n*ELEMENT, TYPE=C3D4, ELSET=E\n1, 1, 2, 3, 4\n",
    );
    let deck = stickslip_deck::read(&folder.join("job.inp")).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!((deck.nodes.len(), deck.output.files.len()), (4, 4));
    assert_eq!(deck.node_sets["A"], [1]);
    // A mistake is found in the file it is in.
    write("set.inp", "*NSET, NSET=A\n1, 9\n");
    let message = stickslip_deck::read(&folder.join("job.inp"))
        .expect_err("no node 9")
        .to_string();
    assert!(
        message.contains("set.inp:2: error: there is no node 9"),
        "{message}"
    );
}

#[test]
fn keywords_that_do_not_matter_are_noted_and_others_refused() {
    let deck = with("*PREPRINT, ECHO=NO\n*RESTART, WRITE\n*CONDUCTIVITY\n");
    assert!(deck.properties.materials.is_empty());
    assert_eq!(
        deck.notes
            .iter()
            .filter(|n| n.severity == Severity::Note)
            .count(),
        3
    );
    for (keyword, help) in [
        ("*PLASTIC", "linear elastic"),
        ("*HEAT TRANSFER", "temperatures"),
        ("*FRICTON", "did you mean *FRICTION?"),
        ("*WHATEVER THIS IS", "no keyword"),
    ] {
        let message = refused(&format!("{TET}{keyword}\n"));
        assert!(
            message.contains("job.inp:8: error") && message.contains(help),
            "{message}"
        );
    }
}

#[test]
fn names_are_given_once() {
    for card in [
        "*AMPLITUDE, NAME=X\n0., 0., 1., 1.\n",
        "*TIME POINTS, NAME=X\n1.\n",
        "*ORIENTATION, NAME=X\n1., 0., 0., 0., 1., 0.\n",
        "*MATERIAL, NAME=X\n*ELASTIC\n1., .3\n",
        "*SURFACE INTERACTION, NAME=X\n*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD\n",
        "*SURFACE, NAME=X\nEN, S1\n",
    ] {
        let message = refused(&format!("{}{card}{card}", crate::support::column()));
        assert!(
            message.contains("X") && message.contains("given twice"),
            "{message}"
        );
    }
}

//! What is not computed: one line a kind, with how much there is of it, and nothing that only follows from it.

use crate::support::{cube, refused, sections};

/// Lines of a message that are no help.
fn lines(message: &str) -> Vec<&str> {
    let all = message.lines();
    all.filter(|l| !l.starts_with("  help")).collect()
}

#[track_caller]
fn says(text: &str, wanted: &[&str]) {
    let message = refused(text);
    let found = lines(&message);
    assert!(
        found.len() == wanted.len() && found.iter().zip(wanted).all(|(f, w)| f.contains(w)),
        "{message}\nis not {wanted:#?}"
    );
    // Each error says what to do.
    let errors = message.matches(": error: ").count();
    assert_eq!(message.matches("  help: ").count(), errors, "{message}");
}

#[test]
fn shells_are_counted_with_their_sections() {
    let text = "*NODE\n1, 0., 0., 0.\n2, 1., 0., 0.\n3, 1., 1., 0.\n4, 0., 1., 0.\n5, 2., 0., 0.\n\
                *ELEMENT, TYPE=S4, ELSET=E\n1, 1, 2, 3, 4\n*ELEMENT, TYPE=S3R, ELSET=E\n2, 2, 5, 3\n3, 2, 5, 3\n\
                *MATERIAL, NAME=M\n*ELASTIC\n1., .3\n*SHELL SECTION, ELSET=E, MATERIAL=M\n.1\n*BOUNDARY\n1, 1, 6\n*STEP\n*STATIC\n*CLOAD\n5, 3, 1.\n\
                5, 5, 1.\n*DLOAD\nE, P, 1.\n*DLOAD\nE, EDNOR1, 1.\n*END STEP\n";
    let shells = "job.inp:7: error: shells are not computed: 1 element of type S4, 2 elements of type S3R, 1 *SHELL SECTION";
    says(text, &[shells, "what else there is to say"]);
}

#[test]
fn networks_heat_and_other_analyses_are_one_line_each() {
    let text = "*NODE, NSET=N\n1, 0., 0., 0.\n2, 1., 0., 0.\n3, 2., 0., 0.\n*ELEMENT, TYPE=D, ELSET=G\n1, 1, 2, 3\n2, 3, 2, 1\n\
                *MATERIAL, NAME=GAS\n*SPECIFIC HEAT\n1000.\n*FLUID SECTION, TYPE=PIPE, ELSET=G, MATERIAL=GAS\n1.\n*INITIAL CONDITIONS, TYPE=MASS FLOW\nN, 1.\n\
                *STEP\n*HEAT TRANSFER\n1., 1.\n*BOUNDARY\n1, 11, 11, 300.\nN, 0, 0, 3.\n*DFLUX\nG, S1, 1.\n*END STEP\n\
                *STEP\n*BUCKLE\n5\n*END STEP\n*STEP\n*MODAL DYNAMIC\n1., 2.\n*END STEP\n";
    says(
        text,
        &[
            "job.inp:5: error: networks of flows are not computed: 2 elements of type D, 1 *FLUID SECTION",
            "job.inp:16: error: temperatures by heat transfer are not computed: 1 *HEAT TRANSFER, 1 *DFLUX",
            "job.inp:25: error: analyses other than *STATIC, *DYNAMIC, *FREQUENCY, *COMPLEX FREQUENCY and *STEADY STATE DYNAMICS are not computed: 1 *BUCKLE, 1 *MODAL DYNAMIC",
            "what else there is to say",
        ],
    );
}

#[test]
fn materials_and_beams_do_not_hide_what_is_misspelt() {
    let text = format!(
        "{}{}*NODE\n100, 0., 0., 3.\n*ELEMENT, TYPE=B31, ELSET=EB\n50, 5, 100\n*BEAM SECTION, ELSET=EB, MATERIAL=EL, SECTION=RECT\n1., 1.\n0., 1., 0.\n\
         *MATERIAL, NAME=P\n*ELASTIC\n1., .3\n*PLASTIC\n1., 0.\n*MATERIAL, NAME=Q\n*HYPERELASTIC, NEO HOOKE\n1., 1.\n*PLASTIC\n1., 0.\n\
         *STEP\n*STATIC, TYPO=3\n*CLOADS\n100, 4, 1.\n*CLOAD\n100, 7, 1.\n*END STEP\n",
        cube("N", 1, 0.0),
        sections(&["EN"])
    );
    says(
        &text,
        &[
            "beams are not computed: 1 element of type B31, 1 *BEAM SECTION",
            "materials that are not linear elastic are not computed: 2 *PLASTIC, 1 *HYPERELASTIC",
            "*STATIC has no parameter TYPO",
            "unknown keyword *CLOADS",
            "what else there is to say",
        ],
    );
}

#[test]
fn cards_of_no_kind_are_counted_by_keyword() {
    let text = format!(
        "{}{}*NMAP, NSET=N, TYPE=RECTANGULAR\n1., 1., 1.\n\n*NMap, NSET=N, TYPE=RECTANGULAR\n1., 1., 1.\n\n*NSET, NSET=MORE\n11\n\
         *BOUNDARY\nMORE, 1\n*STEP\n*STATIC\n*END STEP\n",
        cube("N", 1, 0.0),
        sections(&["EN"])
    );
    let found = lines(&refused(&text)).len();
    assert!(found <= 2, "{}", refused(&text));
    assert!(
        refused(&text).contains("*NMAP is not supported (2 cards)"),
        "{}",
        refused(&text)
    );
}

#[test]
fn a_deck_that_goes_on_from_another_says_only_that() {
    let text = "*HEADING\nrun\n*SHELL SECTION, ELSET=E\n1.\n*RESTART, READ, STEP=1\n*STEP\n*STATIC\n*CLOAD\n29, 3, 1.\n*EL PRINT, ELSET=E29\nS\n*END STEP\n";
    let message = refused(text);
    let said = lines(&message);
    assert!(
        said.iter()
            .all(|l| l.contains("RESTART") && l.contains("job.inp:5")),
        "{message}"
    );
}

//! The table is whole, and the parser does what it says: every row is walked.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use super::row::{Data, Fate, Row};
use super::rows;
use crate::card::asked;
use crate::finding::{Finding, Severity};

/// What stands before the card that is looked at: all that it may refer to.
const MODEL: &str = "*NODE, NSET=N\n1, 0., 0., 0.\n2, 1., 0., 0.\n3, 0., 1., 0.\n4, 0., 0., 1.\n5, 2., 2., 2.\n*ELEMENT, TYPE=C3D4, ELSET=E\n1, 1, 2, 3, 4\n\
    *ELEMENT, TYPE=MASS, ELSET=EM\n2, 1\n*ELEMENT, TYPE=SPRINGA, ELSET=ES\n3, 1, 2\n*ELEMENT, TYPE=DASHPOTA, ELSET=ED\n4, 1, 2\n*ELEMENT, TYPE=GAPUNI, ELSET=EG\n5, 1, 2\n*ELEMENT, TYPE=DCOUP3D, ELSET=EC\n6, 5\n*SURFACE, NAME=S\nE, S1\n*SURFACE, NAME=T\nE, S2\n*AMPLITUDE, NAME=A\n0., 0., 1., 1.\n*TIME POINTS, NAME=P\n.5\n*ORIENTATION, NAME=O\n1., 0., 0., 0., 1., 0.\n\
    *MATERIAL, NAME=M\n*ELASTIC\n1., .3\n*SOLID SECTION, ELSET=E, MATERIAL=M\n*SURFACE INTERACTION, NAME=I\n*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n1.\n";

/// A part and the beginning of an assembly.
const ASSEMBLY: &str = "*PART, NAME=P\n*NODE\n1, 0., 0., 0.\n2, 1., 0., 0.\n3, 0., 1., 0.\n4, 0., 0., 1.\n*ELEMENT, TYPE=C3D4\n1, 1, 2, 3, 4\n3, 1, 2, 3, 4\n\
    *END PART\n*ASSEMBLY, NAME=B\n";

/// The same with an instance.
const ASSEMBLED: &str = "*PART, NAME=P\n*NODE\n1, 0., 0., 0.\n2, 1., 0., 0.\n3, 0., 1., 0.\n4, 0., 0., 1.\n*ELEMENT, TYPE=C3D4\n1, 1, 2, 3, 4\n3, 1, 2, 3, 4\n\
    *END PART\n*ASSEMBLY, NAME=B\n*INSTANCE, NAME=J, PART=P\n*END INSTANCE\n*END ASSEMBLY\n";

/// What has to stand behind a card, so that nothing is left open.
fn after(keyword: &str) -> &'static str {
    match keyword {
        "PART" => {
            "*END PART\n*ASSEMBLY, NAME=B\n*INSTANCE, NAME=J, PART=X\n*END INSTANCE\n*END ASSEMBLY\n"
        }
        "ENDPART" => "*ASSEMBLY, NAME=B\n*INSTANCE, NAME=J, PART=X\n*END INSTANCE\n*END ASSEMBLY\n",
        "ASSEMBLY" => "*END ASSEMBLY\n",
        "INSTANCE" => "*END INSTANCE\n*END ASSEMBLY\n",
        "ENDINSTANCE" => "*END ASSEMBLY\n",
        _ => "",
    }
}

/// The cards that have to stand before one, and the one itself with the parameters that it needs and data: what is read without complaint.
fn sample(row: &Row) -> (&'static str, &'static str, &'static str) {
    match row.keyword {
        "PART" => ("", "NAME=X", ""),
        "ENDPART" => ("*PART, NAME=X\n", "", ""),
        "ASSEMBLY" => ("", "NAME=X", ""),
        "ENDASSEMBLY" => ("*ASSEMBLY, NAME=X\n", "", ""),
        "INSTANCE" => (ASSEMBLY, "NAME=J, PART=P", "1., 2., 3.\n"),
        "ENDINSTANCE" => ("*ASSEMBLY, NAME=X\n*INSTANCE, NAME=J\n", "", ""),
        "SYSTEM" => ("", "", "0., 0., 0., 1., 1., 0.\n"),
        "NODE" => ("", "", "9, 0., 0., 0.\n"),
        "ELEMENT" => ("", "TYPE=C3D4", "9, 1, 2, 3, 4\n"),
        "NGEN" => ("*NODE\n10, 1., 0., 0.\n20, 0., 1., 0.\n", "", "10, 20, 5\n"),
        "NFILL" => (
            "*NSET, NSET=L\n1, 3\n*NSET, NSET=H\n2, 5\n",
            "",
            "L, H, 2, 20\n",
        ),
        "NCOPY" => ("", "OLDSET=N, CHANGENUMBER=100, SHIFT", "1., 0., 0.\n"),
        "ELGEN" => ("", "", "1\n"),
        "ELCOPY" => (
            "*NCOPY, OLD SET=N, CHANGE NUMBER=100, SHIFT\n1., 0., 0.\n",
            "OLDSET=E, ELEMENTSHIFT=100, SHIFTNODES=100",
            "",
        ),
        "NSET" => (ASSEMBLED, "NSET=X", "1, 3, 1\n"),
        "ELSET" => (ASSEMBLED, "ELSET=X", "1, 3, 1\n"),
        "SURFACE" => ("", "NAME=X", "E, S3\n"),
        "TRANSFORM" => ("", "NSET=N", "1., 0., 0., 0., 1., 0.\n"),
        "EQUATION" => ("", "", "2\n1, 1, 1., 2, 1, 1.\n"),
        "RIGIDBODY" => ("", "REFNODE=5, ELSET=E", ""),
        "PRE-TENSIONSECTION" => ("", "SURFACE=S, NODE=5", "1., 0., 0.\n"),
        "COUPLING" => ("", "REFNODE=5, SURFACE=S", ""),
        "KINEMATIC" | "DISTRIBUTING" => (
            "*COUPLING, REF NODE=5, SURFACE=S, CONSTRAINT NAME=X\n",
            "",
            "1, 3\n",
        ),
        "KINEMATICCOUPLING" => ("", "REFNODE=5", "N, 1, 3\n"),
        "DISTRIBUTINGCOUPLING" => ("", "ELSET=EC", "N, 1.\n"),
        "MPC" => ("", "", "PIN, 1, 2\n"),
        "SPRING" => ("", "ELSET=ES", "\n1.\n"),
        "DASHPOT" => ("", "ELSET=ED", "\n1.\n"),
        "GAP" => ("", "ELSET=EG", "0., 1., 0., 0.\n"),
        "MASS" => ("", "ELSET=EM", "1.\n"),
        "INITIALCONDITIONS" => ("", "TYPE=VELOCITY", "N, 1, 1.\n"),
        "AMPLITUDE" => ("", "NAME=X", "0., 0., 1., 1.\n"),
        "TIMEPOINTS" => ("", "NAME=X", "1., 2., 1.\n"),
        "MATERIAL" => ("", "NAME=X", ""),
        "ELASTIC" => ("*MATERIAL, NAME=X\n", "", "1., .3\n"),
        "DENSITY" => ("*MATERIAL, NAME=X\n", "", "1.\n"),
        "DAMPING" => ("*MATERIAL, NAME=X\n", "", ""),
        "SOLIDSECTION" => ("", "ELSET=E, MATERIAL=M", ""),
        "DISTRIBUTION" => (
            "",
            "NAME=X",
            ", 1., 0., 0., 0., 1., 0.\n1, 0., 1., 0., 0., 0., 1.\n",
        ),
        "DISTRIBUTIONTABLE" => ("", "NAME=X", "COORD3D, COORD3D\n"),
        "SECTIONPRINT" => ("*STEP\n*STATIC\n", "SURFACE=S", "SOF\n"),
        "ORIENTATION" => ("", "NAME=X", "1., 0., 0., 0., 1., 0.\n"),
        "SURFACEINTERACTION" => ("", "NAME=X", ""),
        "SURFACEBEHAVIOR" => (
            "*SURFACE INTERACTION, NAME=X\n",
            "PRESSURE-OVERCLOSURE=LINEAR",
            "1.\n",
        ),
        "FRICTION" => ("*SURFACE INTERACTION, NAME=X\n", "", ".3, .2, 1.\n"),
        "CHANGEFRICTION" | "CHANGESURFACEBEHAVIOR" => ("*STEP\n*STATIC\n", "INTERACTION=I", ""),
        "CONTACTDAMPING" => ("*SURFACE INTERACTION, NAME=X\n", "", "1.\n"),
        "CONTACTPAIR" => ("", "INTERACTION=I", "S, T\n"),
        "MODELCHANGE" => (
            "*CONTACT PAIR, INTERACTION=I\nS, T\n*STEP\n*STATIC\n",
            "TYPE=CONTACT PAIR, ADD",
            "S, T\n",
        ),
        "CLEARANCE" => ("", "MASTER=T, SLAVE=S, VALUE=0.", ""),
        "TIE" => ("", "", "S, T\n"),
        "EXPANSION" => ("*MATERIAL, NAME=X\n*ELASTIC\n1., .3\n", "", "1e-5\n"),
        "TEMPERATURE" => ("*STEP\n*STATIC\n", "", "N, 1.\n"),
        "STEP" => ("", "", "*STATIC\n"),
        "ENDSTEP" => ("*STEP\n*STATIC\n", "", ""),
        "STATIC" => ("*STEP\n", "", ".1, 1.\n"),
        "DYNAMIC" => ("*STEP\n", "", ".1, 1.\n"),
        "FREQUENCY" | "COMPLEXFREQUENCY" => ("*STEP\n", "", "3\n"),
        "STEADYSTATEDYNAMICS" => (
            "*STEP\n*FREQUENCY\n3\n*END STEP\n*STEP\n",
            "",
            "1., 2., 5, 3.\n",
        ),
        "MODALDAMPING" => ("*STEP\n*STATIC\n", "", "1, 3, .02\n"),
        "MOTION" => ("*STEP\n*STATIC\n", "", "N, 1, 1, 2.\n"),
        "BOUNDARY" => ("*STEP\n*STATIC\n", "", "N, 1, 1\n"),
        "CLOAD" => ("*STEP\n*STATIC\n", "", "1, 1, 1.\n"),
        "DLOAD" => ("*STEP\n*STATIC\n", "", "E, P1, 1.\n"),
        "DSLOAD" => ("*STEP\n*STATIC\n", "", "S, P, 1.\n"),
        "NODEPRINT" => ("*STEP\n*STATIC\n", "NSET=N", "U\n"),
        "ELPRINT" => ("*STEP\n*STATIC\n", "ELSET=E", "S\n"),
        "CONTACTPRINT" => ("*STEP\n*STATIC\n", "SLAVE=S, MASTER=T", "CF\n"),
        "NODEFILE" | "ELFILE" | "CONTACTFILE" | "NODEOUTPUT" | "ELEMENTOUTPUT"
        | "CONTACTOUTPUT" | "OUTPUT" => ("*STEP\n*STATIC\n", "", ""),
        _ => ("", "", ""),
    }
}

/// A value with which a parameter is as good as without a special meaning.
fn value(keyword: &str, parameter: &str) -> &'static str {
    match (keyword, parameter) {
        ("NSET", "ELSET") => "=E",
        ("NGEN", "LINE") => "=C",
        ("NGEN", "SYSTEM") => "=RC",
        ("NFILL", "BIAS") => "=2.",
        ("NFILL", "TWOSTEP") | ("NCOPY", "SHIFT") => "",
        ("NCOPY", "REFLECT") => "=POINT",
        ("SURFACE", "COMBINE") => "=UNION",
        ("CONTACTPAIR", "TIED") => ", ADJUST=0.1",
        (_, "INSTANCE") => "=J",
        ("SOLIDSECTION", "ORIENTATION") => "=O",
        (_, "AMPLITUDE") if keyword == "STEP" => "=RAMP",
        (_, "AMPLITUDE") => "=A",
        ("NSET" | "ELSET" | "TIMEPOINTS", "GENERATE") => "",
        (_, "TIMEPOINTS") => "=P",
        (_, "TIMEDELAY") => "=0., AMPLITUDE=A",
        (_, "OP") => "=MOD",
        (_, "TOTALS" | "GLOBAL") => "=YES",
        ("TIE", "ADJUST") | (_, "TRIM") => "=NO",
        ("TIE", "NAME") => "=X",
        ("NODE" | "ELEMENT", "NSET" | "ELSET") => "=X",
        ("NODE", "SYSTEM") | ("TRANSFORM", "TYPE") => "=R",
        ("BOUNDARY", "TYPE") => "=DISPLACEMENT",
        ("MOTION", "TYPE") => "=VELOCITY",
        (_, "FRICTIONDAMPING" | "HARMONIC") => "=YES",
        (_, "INTERVAL") => "=EIGENFREQUENCY",
        (_, "FREQUENCYSCALE") => "=LINEAR",
        (_, "MODAL") => "=DIRECT",
        (_, "LOADCASE") => "=2",
        (_, "REAL" | "IMAGINARY" | "RAYLEIGH") => "",
        ("SURFACE", "TYPE") => "=ELEMENT",
        ("ELASTIC" | "EXPANSION", "TYPE") => "=ISO",
        ("CONTACTPAIR", "TYPE") => "=SURFACE TO SURFACE",
        ("NORMAL", "TYPE") => "=ELEMENT",
        (_, "POSITION") => "=INPUT",
        ("RIGIDBODY", "NSET") => "=N",
        (_, "WEIGHTINGMETHOD") => "=UNIFORM",
        ("COUPLING" | "KINEMATICCOUPLING", "ORIENTATION") => "=O",
        ("RIGIDBODY", "ROTNODE") => "=5",
        (_, "LOCATION") => "=ELEMENT",
        ("ORIENTATION", "SYSTEM") => "=RECTANGULAR",
        ("ORIENTATION", "DEFINITION") => "=COORDINATES",
        ("AMPLITUDE", "DEFINITION") => "=TABULAR",
        ("AMPLITUDE", "VALUE") => "=RELATIVE",
        ("AMPLITUDE" | "TIMEPOINTS", "TIME") => "=TOTAL TIME",
        ("CONTACTDAMPING", "DEFINITION") => "=DAMPING COEFFICIENT",
        ("DYNAMIC", "APPLICATION") => "=TRANSIENT FIDELITY",
        ("DYNAMIC", "INITIAL") => "=YES",
        ("DYNAMIC", "ALPHA") => "=0.",
        ("FRICTION", "ROUGH" | "EXPONENTIALDECAY")
        | (_, "NLGEOM" | "DIRECT" | "EXPLICIT" | "FIXED" | "SMALLSLIDING") => "",
        ("STEP", "PERTURBATION") => "",
        (_, "FREQUENCY" | "FREQUENCYF") => "=1",
        (_, "REMOVE" | "REMOVEALL") => "",
        _ => "=0.",
    }
}

/// The same where a parameter makes another card of it.
fn sample_with<'a>(row: &Row, more: &str, data: &'a str) -> (&'static str, &'static str, &'a str) {
    let (before, needs, _) = sample(row);
    match (row.keyword, more.split('=').next()) {
        ("STEP", Some("PERTURBATION")) => (before, needs, "*FREQUENCY\n3\n"),
        ("EQUATION", Some("REMOVE")) => ("*STEP\n*STATIC\n", needs, "1, 1\n"),
        ("EQUATION", Some("REMOVEALL")) => ("*STEP\n*STATIC\n", needs, ""),
        ("MOTION", Some("ROTATION")) => (before, needs, "N, 2., 0., 0., 0., 0., 0., 1.\n"),
        ("NCOPY", Some("REFLECT")) => (before, "OLDSET=N, CHANGENUMBER=100", data),
        ("SURFACE", Some("COMBINE")) => (before, needs, "S, T\n"),
        ("MODELCHANGE", Some("REMOVE")) => (before, "TYPE=CONTACT PAIR", data),
        _ => (before, needs, data),
    }
}

fn deck(row: &Row, more: &str, data: &str) -> String {
    let (before, needs, data) = sample_with(row, more, data);
    let comma = |text: &str| {
        if text.is_empty() {
            String::new()
        } else {
            format!(", {text}")
        }
    };
    format!(
        "{MODEL}{before}*{}{}{}\n{data}{}",
        row.keyword,
        comma(needs),
        comma(more),
        after(row.keyword)
    )
}

/// What is said of a deck: errors, or the rest.
fn said(text: &str) -> Vec<Finding> {
    match crate::parse(text.as_bytes(), Path::new("job.inp")) {
        Ok(deck) => deck.notes,
        Err(e) => e.findings,
    }
}

/// Errors, but for what a deck lacks that is not whole.
fn errors(text: &str) -> Vec<String> {
    let found = said(text).into_iter();
    let errors = found.filter(|f| f.severity == Severity::Error);
    errors.map(|f| f.to_string()).collect()
}

#[test]
fn rows_are_unique_and_say_why_or_what_to_do() {
    let mut seen = BTreeSet::new();
    for row in rows() {
        assert!(seen.insert(row.keyword), "{} has two rows", row.keyword);
        assert!(!row.keyword.contains([' ', '*']), "{}", row.keyword);
        let mut parameters = BTreeSet::new();
        for p in row.parameters {
            assert!(
                parameters.insert(p.name),
                "{}: {} twice",
                row.keyword,
                p.name
            );
            assert!(!p.name.contains(' '), "{}", p.name);
        }
        let fates = row
            .parameters
            .iter()
            .map(|p| p.fate)
            .chain([row.fate])
            .chain(row.others);
        for fate in fates {
            if let Fate::Harmless(why) | Fate::Idle(why) | Fate::Refused(why) = fate {
                assert!(why.len() > 10, "{}: `{why}`", row.keyword);
            }
        }
    }
}

#[test]
fn every_card_is_read_noted_or_refused_as_its_row_says() {
    for row in rows() {
        let (_, _, data) = sample(row);
        let found = said(&deck(row, "", data));
        let here = |f: &&Finding| f.message.contains(&format!("*{}", row.keyword));
        match row.fate {
            Fate::Read => assert_eq!(
                errors(&deck(row, "", data)),
                Vec::<String>::new(),
                "{}",
                row.keyword
            ),
            Fate::Harmless(why) | Fate::Idle(why) => {
                let note = found
                    .iter()
                    .find(here)
                    .unwrap_or_else(|| panic!("{} is dropped", row.keyword));
                assert_eq!(note.severity, Severity::Note);
                assert!(note.message.contains(why), "{note}");
            }
            Fate::Refused(help) => {
                let error = found
                    .iter()
                    .find(here)
                    .unwrap_or_else(|| panic!("{} is dropped", row.keyword));
                assert_eq!(error.severity, Severity::Error);
                assert_eq!(error.help.as_deref(), Some(help));
            }
        }
    }
}

#[test]
fn every_parameter_is_read_noted_or_refused_as_its_row_says() {
    for row in rows().filter(|r| r.fate == Fate::Read) {
        let (_, needs, data) = sample(row);
        for p in row
            .parameters
            .iter()
            .filter(|p| !needs.contains(p.name) || p.name == "NSET")
        {
            let text = deck(
                row,
                &format!("{}{}", p.name, value(row.keyword, p.name)),
                data,
            );
            let found = said(&text);
            let what = format!("{} of {}: {found:#?}", p.name, row.keyword);
            let twice = needs.contains(&format!("{}=", p.name));
            match p.fate {
                _ if twice => assert!(
                    found.iter().any(|f| f.message.contains("given twice")),
                    "{what}"
                ),
                Fate::Read | Fate::Idle(_) => {
                    assert_eq!(errors(&text), Vec::<String>::new(), "{what}")
                }
                Fate::Harmless(why) => {
                    let note = found
                        .iter()
                        .any(|f| f.severity == Severity::Note && f.message.contains(why));
                    assert!(note && errors(&text).is_empty(), "{what}");
                }
                Fate::Refused(help) => {
                    let error = |f: &Finding| {
                        f.severity == Severity::Error && f.help.as_deref() == Some(help)
                    };
                    assert!(found.iter().any(error), "{what}");
                }
            }
        }
        if row.others.is_none() {
            let text = deck(row, "QWERTY=1", data);
            assert!(
                errors(&text)
                    .iter()
                    .any(|e| e.contains("has no parameter QWERTY")),
                "{}",
                row.keyword
            );
        }
    }
}

#[test]
fn what_stands_beyond_the_fields_that_are_read_is_an_error() {
    for row in rows().filter(|r| r.fate == Fate::Read) {
        let (fields, lines) = match row.data {
            Data::Any => continue,
            Data::Nothing => (0, 0),
            Data::Line(fields) => (fields.split(", ").count(), 1),
            Data::Lines(fields) => (fields.split(", ").count(), 2),
        };
        let (_, _, data) = sample(row);
        // A further field in the first line, and a further line.
        let first = data.lines().next().unwrap_or_default();
        let given = if first.is_empty() {
            0
        } else {
            first.split(',').count()
        };
        let wider = format!(
            "{first}{}7.\n",
            ",".repeat((fields + 1).saturating_sub(given.max(1)))
        );
        let found = errors(&deck(row, "", &wider));
        assert!(
            found.iter().any(|e| e.contains("is not read")),
            "{}: {wider}{found:?}",
            row.keyword
        );
        if lines == 1 && !first.is_empty() {
            let found = errors(&deck(row, "", &format!("{first}\n{first}\n")));
            assert!(
                found.iter().any(|e| e.contains("is not read")),
                "{}: {found:?}",
                row.keyword
            );
        }
    }
}

#[test]
fn the_parser_asks_for_what_the_rows_call_read_and_for_nothing_else() {
    // Every card with every parameter that is read, one at a time, so that every question is asked.
    for row in rows().filter(|r| r.fate == Fate::Read) {
        let (_, needs, data) = sample(row);
        said(&deck(row, "", data));
        for p in row
            .parameters
            .iter()
            .filter(|p| p.fate == Fate::Read && !needs.contains(p.name))
        {
            said(&deck(
                row,
                &format!("{}{}", p.name, value(row.keyword, p.name)),
                data,
            ));
        }
        if row.keyword == "SURFACE" {
            said(&deck(row, "TRIM=YES", "E\n"));
        }
    }
    let mut asked_of: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for (keyword, parameter) in asked::all() {
        asked_of.entry(keyword).or_default().insert(parameter);
    }
    for row in rows() {
        let asked = asked_of.remove(row.keyword).unwrap_or_default();
        let read: BTreeSet<String> = row.known().into_iter().map(str::to_string).collect();
        assert_eq!(
            asked, read,
            "{}: what is asked for, what is called read",
            row.keyword
        );
    }
    assert!(asked_of.is_empty(), "{asked_of:?}");
}

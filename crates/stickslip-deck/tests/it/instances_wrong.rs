//! What is said of parts, instances and assemblies that are wrong.

use crate::support::refused;

const MESH: &str = "*Node\n1, 0., 0., 0.\n2, 1., 0., 0.\n3, 0., 1., 0.\n4, 0., 0., 1.\n*Element, type=C3D4, elset=E\n1, 1, 2, 3, 4\n*Solid Section, elset=E, material=M\n";
const REST: &str = "*Material, name=M\n*Elastic\n1., 0.\n*Step\n*Static\n*End Step\n";

/// A deck with these lines in the part, the instance, the assembly, and before the material.
fn deck(part: &str, instance: &str, assembly: &str, model: &str) -> String {
    format!(
        "*Part, name=Wheel\n{MESH}{part}*End Part\n*Assembly, name=S\n*Instance, name=Wheel-1, part=Wheel\n{instance}*End Instance\n{assembly}*End Assembly\n{model}{REST}"
    )
}

/// All errors have file and line, and one of them says this, at a line and with a help.
#[track_caller]
fn says(deck: &str, line: &str, message: &str, help: &str) {
    let found = refused(deck);
    let number = 1 + deck
        .lines()
        .position(|l| l == line)
        .unwrap_or_else(|| panic!("no line {line}"));
    let wanted = format!("job.inp:{number}: error: {message}");
    let at = found
        .find(&wanted)
        .unwrap_or_else(|| panic!("`{wanted}` is not in\n{found}"));
    let lines: Vec<&str> = found[at..].lines().take(2).collect();
    assert!(
        lines.len() == 2 && lines[1].contains(help),
        "`{help}` is not in\n{found}"
    );
}

/// The same, and nothing else is said.
#[track_caller]
fn says_only(deck: &str, line: &str, message: &str, help: &str) {
    says(deck, line, message, help);
    let found = refused(deck);
    assert_eq!(found.matches(": error: ").count(), 1, "{found}");
}

#[test]
fn parts_and_instances_that_are_not_there() {
    let text = deck("", "", "", "").replace("part=Wheel\n", "part=Whel\n");
    says_only(
        &text,
        "*Instance, name=Wheel-1, part=Whel",
        "there is no part WHEL",
        "did you mean WHEEL? parts: WHEEL",
    );
    let set = deck("", "", "*Nset, nset=X, instance=Wheel-2\n1\n", "");
    says_only(
        &set,
        "*Nset, nset=X, instance=Wheel-2",
        "there is no instance WHEEL-2",
        "did you mean WHEEL-1?",
    );
    let set = deck("", "", "*Elset, elset=X, instance=Rim-9-9\n1\n", "");
    says_only(
        &set,
        "*Elset, elset=X, instance=Rim-9-9",
        "there is no instance RIM-9-9",
        "instances: WHEEL-1",
    );
    let dotted = deck("", "", "", "*Boundary\nWheel-2.E, 1\n");
    says_only(
        &dotted,
        "Wheel-2.E, 1",
        "there is no set of nodes WHEEL-2.E: no instance is called WHEEL-2",
        "did you mean WHEEL-1?",
    );
    let dotted = deck("", "", "*Surface, name=F\nWhel-1.E, S1\n", "");
    says(
        &dotted,
        "Whel-1.E, S1",
        "there is no set of elements WHEL-1.E: no instance is called WHEL-1",
        "did you mean WHEEL-1?",
    );
    let none = format!("*Part, name=Wheel\n{MESH}*End Part\n{REST}");
    says_only(
        &none,
        "*Part, name=Wheel",
        "the part WHEEL has no instance",
        "*INSTANCE, NAME=...",
    );
}

#[test]
fn labels_and_sets_that_an_instance_does_not_have() {
    let of_wheel = "the nodes of the instance WHEEL-1 run from WHEEL-1.1 to WHEEL-1.4";
    for (line, message, help) in [
        ("Wheel-1.9, 1", "there is no node WHEEL-1.9", of_wheel),
        // Not a node of the next instance.
        ("Wheel-1.11, 1", "there is no node WHEEL-1.11", of_wheel),
        (
            "Wheel-1.Rim, 1",
            "there is no set of nodes WHEEL-1.RIM",
            "sets of nodes: WHEEL-1.HUB",
        ),
        (
            "S.Rim, 1",
            "there is no set of nodes RIM",
            "no sets of nodes",
        ),
        ("1, 1", "there is no node 1", "write instance.number"),
        (
            "Hub, 1",
            "there is no set of nodes HUB",
            "did you mean WHEEL-1.HUB or WHEEL-2.HUB?",
        ),
    ] {
        let more = "*Instance, name=Wheel-2, part=Wheel\n*End Instance\n";
        let text = deck(
            "*Nset, nset=Hub\n1\n",
            "",
            more,
            &format!("*Boundary\n{line}\n"),
        );
        says_only(&text, line, message, help);
    }
    let text = deck(
        "",
        "",
        "*Nset, nset=X, instance=Wheel-1\n77,\n",
        "*Boundary\nX, 1\n",
    );
    says_only(&text, "77,", "there is no node WHEEL-1.77", "*NODE");
    let text = deck("", "", "*Elset, elset=X, instance=Wheel-1\n78,\n", "");
    says_only(
        &text,
        "78,",
        "there is no element WHEEL-1.78",
        "elements must stand before",
    );
}

#[test]
fn ends_that_are_missing() {
    let text = deck("", "", "", "").replace("*End Part\n", "");
    says_only(
        &text,
        "*Part, name=Wheel",
        "the part WHEEL has no *END PART",
        "write it before line 10",
    );
    // The part within is closed, the one around it is not.
    let text = deck("*Part, name=Hub\n", "", "", "").replace("part=Wheel", "part=Hub");
    says_only(
        &text,
        "*Part, name=Wheel",
        "the part WHEEL has no *END PART",
        "parts do not stand in each other",
    );
}

#[test]
fn more_ends_that_are_missing() {
    let text = deck("", "", "", "").replace("*End Instance\n", "");
    says_only(
        &text,
        "*Instance, name=Wheel-1, part=Wheel",
        "the instance WHEEL-1 has no *END INSTANCE",
        "write it behind",
    );
    let text = deck("", "", "", "")
        .replace("*End Assembly\n", "")
        .replace("*Material, name=M\n*Elastic\n1., 0.\n", "");
    let text = format!("*Material, name=M\n*Elastic\n1., 0.\n{text}");
    says_only(
        &text,
        "*Assembly, name=S",
        "*ASSEMBLY has no *END ASSEMBLY",
        "before materials and steps",
    );
    let open = format!("*Material, name=M\n*Elastic\n1., 0.\n*Part, name=Wheel\n{MESH}");
    says(
        &open,
        "*Part, name=Wheel",
        "the part WHEEL has no *END PART",
        "behind the last card",
    );
    for (card, begin) in [
        ("*End Part", "*PART"),
        ("*End Instance", "*INSTANCE"),
        ("*End Assembly", "*ASSEMBLY"),
    ] {
        let text = format!("{card}\n{}", deck("", "", "", ""));
        says_only(
            &text,
            card,
            &format!("{card} without {begin}"),
            "begins with",
        );
    }
}

#[test]
fn cards_at_the_wrong_level() {
    let part = deck("*Amplitude, name=A\n0., 0., 1., 1.\n", "", "", "");
    says_only(
        &part,
        "*Amplitude, name=A",
        "*Amplitude stands in the part WHEEL",
        "behind *END ASSEMBLY",
    );
    let part = deck("*Tie, name=T\nS1, S2\n", "", "", "");
    says_only(
        &part,
        "*Tie, name=T",
        "*Tie stands in the part WHEEL",
        "in *ASSEMBLY",
    );
    let instance = deck("", "*Boundary\nE, 1\n", "", "");
    says_only(
        &instance,
        "*Boundary",
        "*Boundary stands in the instance WHEEL-1",
        "behind *END ASSEMBLY",
    );
    let assembly = deck("", "", "*Amplitude, name=A\n0., 0., 1., 1.\n", "");
    says_only(
        &assembly,
        "*Amplitude, name=A",
        "*Amplitude stands in the assembly",
        "behind *END ASSEMBLY",
    );
    let late = deck(
        "",
        "",
        "",
        "*Instance, name=Late, part=Wheel\n*End Instance\n",
    );
    says_only(
        &late,
        "*Instance, name=Late, part=Wheel",
        "*Instance stands outside of *ASSEMBLY",
        "between *ASSEMBLY and *END ASSEMBLY",
    );
    let nested = deck("", "", "*Part, name=Hub\n*End Part\n", "");
    says_only(
        &nested,
        "*Part, name=Hub",
        "*Part stands in the assembly",
        "write the parts before",
    );
    let within = deck("*Nset, nset=X, instance=Wheel-1\n1\n", "", "", "");
    says_only(
        &within,
        "*Nset, nset=X, instance=Wheel-1",
        "*Nset, INSTANCE stands in a part",
        "leave INSTANCE out",
    );
}

#[test]
fn names_that_are_given_twice() {
    let more = "*Part, name=WHEEL\n*End Part\n";
    let text = format!("{}{more}", deck("", "", "", ""));
    says_only(
        &text,
        "*Part, name=WHEEL",
        "the part WHEEL is given twice",
        "unique",
    );
    let more = "*Instance, name=WHEEL-1, part=Wheel\n*End Instance\n";
    says(
        &deck("", "", more, ""),
        "*Instance, name=WHEEL-1, part=Wheel",
        "the instance WHEEL-1 is given twice",
        "unique",
    );
    let more = "*Assembly, name=T\n*End Assembly\n";
    says_only(
        &deck("", "", "", more),
        "*Assembly, name=T",
        "there is an *ASSEMBLY already",
        "put all instances into it",
    );
}

#[test]
fn places_that_are_wrong() {
    for (lines, message, help) in [
        (
            "1., 0., 0., 0., 0., 1., 90.\n",
            "*Instance: the first line has three numbers",
            "behind it",
        ),
        (
            "0.\n0., 0., 1., 90.\n",
            "*Instance: a rotation has seven numbers",
            "two points",
        ),
        (
            "0.\n0., 0., 1., 0., 0., 1., 90.\n",
            "*Instance: the points of the axis are one",
            "that differ",
        ),
        (
            "0.\n0., 0., 0., 0., 0., 1., 9.\n5.\n",
            "*Instance: this line is not read",
            "translation x, y, z",
        ),
        (
            "here\n",
            "field 1 is `here`: a finite number is expected",
            "separated by commas",
        ),
    ] {
        let last = lines.lines().last().unwrap_or_default();
        says_only(&deck("", lines, "", ""), last, message, help);
    }
    for (lines, message, help) in [
        (
            "*System\n0., 0., 0., 0., 0., 1.\n",
            "*SYSTEM: the points do not span a plane",
            "xy plane",
        ),
        (
            "*System\n0., 0., 0., 1., 0., 0.\n0., 1., 0., 4.\n",
            "*SYSTEM: this line is not read",
            "cx, cy, cz",
        ),
    ] {
        let last = lines.lines().last().unwrap_or_default();
        says_only(&deck(lines, "", "", ""), last, message, help);
    }
}

#[test]
fn plane_elements_stay_in_their_plane() {
    let part = "*Node\n1, 0., 0.\n2, 1., 0.\n3, 1., 1.\n4, 0., 1.\n*Element, type=CPE4, elset=E\n1, 1, 2, 3, 4\n*Solid Section, elset=E, material=M\n1.,\n";
    let text = |axis: &str| {
        format!(
            "*Part, name=P\n{part}*End Part\n*Assembly, name=S\n*Instance, name=P-1, part=P\n0., 0., 0.\n0., 0., 0., {axis}, 30.\n*End Instance\n*End Assembly\n{REST}"
        )
    };
    says_only(
        &text("1., 0., 0."),
        "*Instance, name=P-1, part=P",
        "the instance P-1 is turned out of the plane in which its elements (CPE4) lie",
        "about an axis along z",
    );
    crate::support::translate(&text("0., 0., 1."));
}

#[test]
fn a_mistake_in_a_part_is_said_once() {
    let more = "*Instance, name=Wheel-2, part=Wheel\n*End Instance\n*Instance, name=Wheel-3, part=Wheel\n*End Instance\n";
    says_only(
        &deck("*Element, type=C3D4\n2, 1, 2, 3, 44\n", "", more, ""),
        "2, 1, 2, 3, 44",
        "element WHEEL-1.2 uses node WHEEL-1.44, which does not exist",
        "*NODE",
    );
    says_only(
        &deck(
            "*Nset, nset=X\n3, 66\n",
            "",
            more,
            "*Boundary\nWheel-2.X, 1\n",
        ),
        "3, 66",
        "there is no node WHEEL-1.66",
        "*NODE",
    );
    says_only(
        &deck("*Nset, nset=X\nRim\n", "", more, ""),
        "Rim",
        "there is no set of nodes Rim",
        "before those it is part of",
    );
    says_only(
        &deck("*Solid Section, elset=Rim, material=M\n", "", more, ""),
        "*Solid Section, elset=Rim, material=M",
        "there is no set of elements WHEEL-1.RIM",
        "sets of elements: WHEEL-1.E",
    );
}

//! Decks of parts, instances and an assembly, against the same decks written flat.

use std::path::Path;

use stickslip_deck::{Deck, Local, Severity};

use crate::support::{Run, cube, near, near3, run, sections, translate};

/// Nodes of a block of one cell, 1 by 1 by 0.5, at a place: `turned` as the second block of the assembly lies.
fn block(first: u64, turned: bool, by: [f64; 3]) -> String {
    let mut out = String::from("*NODE\n");
    let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    for (k, z) in [0.0, 0.5].into_iter().enumerate() {
        for (i, [x, y]) in corners.into_iter().enumerate() {
            let [u, v]: [f64; 2] = if turned { [-y, x] } else { [x, y] };
            let id = first + 4 * k as u64 + i as u64;
            out += &format!("{id}, {}, {}, {}\n", u + by[0], v + by[1], z + by[2]);
        }
    }
    out
}

/// Nodes of a plate of three cells in a row, 3 by 1 by 0.5, at the origin, and its cells.
fn plate() -> String {
    let mut out = String::from("*NODE\n");
    for (k, z) in ["0.", "0.5"].into_iter().enumerate() {
        for (j, y) in ["0.", "1."].into_iter().enumerate() {
            for x in 0..4 {
                out += &format!("{}, {x}., {y}, {z}\n", 1 + 8 * k + 4 * j + x);
            }
        }
    }
    out += "*Element, type=C3D8\n";
    for e in 1..4 {
        let below = [e, e + 1, e + 5, e + 4];
        let nodes: Vec<String> = (below.into_iter().chain(below.map(|n| n + 8)))
            .map(|n| n.to_string())
            .collect();
        out += &format!("{e}, {}\n", nodes.join(", "));
    }
    out
}

const MATERIALS: &str = "*Material, name=Ply\n*Density\n0.5\n*Elastic, type=ENGINEERING CONSTANTS\n2000., 700., 900., 0.2, 0.1, 0.15, 300., 250.,\n200.,\n\
    *Material, name=Base\n*Elastic\n800., 0.3\n*Surface Interaction, name=Dry\n1.,\n*Friction\n0.4,\n*Surface Behavior, pressure-overclosure=HARD\n";

/// The job as Abaqus/CAE lays one out: two parts, three instances, one of them moved and turned.
fn assembled() -> String {
    format!(
        "*Heading\n** Job name: Clamp Model name: Model-1\n*Preprint, echo=NO, model=NO, history=NO, contact=NO\n**\n** PARTS\n**\n\
         *Part, name=Plate\n{}*Nset, nset=Under, generate\n 1, 8, 1\n*Elset, elset=All, generate\n 1, 3, 1\n*Elset, elset=_Upper_S2, internal, generate\n1, 3, 1\n\
         *Surface, type=ELEMENT, name=Upper\n_Upper_S2, S2\n** Section: Base\n*Solid Section, elset=All, material=Base\n,\n*End Part\n**\n\
         *Part, name=\"Solid block\"\n{}*Element, type=C3D8\n1, 1, 2, 3, 4, 5, 6, 7, 8\n*Nset, nset=Top, internal\n 5, 6, 7, 8\n*Elset, elset=All\n 1,\n\
         *Orientation, name=Ply-axes\n1., 0.5, 0., 0., 1., 0.\n3, 10.\n*Solid Section, elset=all, orientation=PLY-AXES, material=Ply\n,\n*End Part\n**\n** ASSEMBLY\n**\n\
         *Assembly, name=Assembly\n**\n*Instance, name=Plate-1, part=PLATE\n*End Instance\n**\n\
         *Instance, name=\"Solid block-1\", part=\"Solid block\"\n        0.25,           0.,          0.5\n*End Instance\n**\n\
         *Instance, name=\"Solid block-2\", part=\"Solid block\"\n          2.,           0.,          0.5\n 2.5, 0.5, 0., 2.5, 0.5, 1., 90.\n*End Instance\n**\n\
         *Nset, nset=Held, instance=Plate-1\n Under,\n*Nset, nset=Tops, instance=\"Solid block-1\"\n 5, 6, 7, 8\n*Nset, nset=Tops, instance=\"Solid block-2\"\n Top,\n\
         *Elset, elset=_Down_S1, internal, instance=\"Solid block-1\"\n 1,\n*Surface, type=ELEMENT, name=Down\n_Down_S1, S1\n\
         *Elset, elset=_Press_S2, internal, instance=\"Solid block-1\"\n 1,\n*Surface, type=ELEMENT, name=Press\n_Press_S2, S2\n\
         *Surface, type=ELEMENT, name=Glued\n\"Solid block-2\".All, S1\n\
         ** Constraint: Glue\n*Tie, name=Glue, adjust=yes\nGlued, Plate-1.Upper\n*End Assembly\n**\n** MATERIALS\n**\n{MATERIALS}\
         ** Interaction: Int-1\n*Contact Pair, interaction=Dry, type=SURFACE TO SURFACE\nAssembly.Down, Plate-1.Upper\n** STEP: Step-1\n**\n\
         *Step, name=Step-1, nlgeom=NO\n*Static\n0.5, 1., 1e-05, 1.\n*Boundary\nHeld, ENCASTRE\n\"Solid block-1\".5, 2\n*Cload\n\"Solid block-2\".7, 1, 3.\n\"Solid block-1\".6, 1, 2.\n\
         *Cload\n\"Solid block-2\".Top, 3, 0.5\n*Dsload\nPress, P, 20.\n*Dload\n\"Solid block-2\".All, GRAV, 9.81, 0., 0., -1.\n*Restart, write, frequency=0\n\
         *Output, field, variable=PRESELECT\n*Output, history\n*Node Output\nU, RF\n*Element Output, directions=YES\nS,\n*Contact Output\nCSTRESS,\n\
         *Node Print, nset=Assembly.Held, totals=ONLY\nRF\n*Node Print, nset=Tops\nU\n*El Print, elset=\"Solid block-2\".All\nS\n*Contact Print, slave=Down, master=Plate-1.Upper, totals=ONLY\nCF\n*End Step\n",
        plate(),
        block(1, false, [0.0; 3]),
    )
}

/// The same job written flat, with the numbers that instances have in the deck.
fn flat() -> String {
    // The axes of the block, turned by a right angle with it.
    let axes = |x: [&str; 2], y: [&str; 2], name: &str| {
        format!(
            "*Orientation, name={name}\n{}, {}, 0., {}, {}, 0.\n3, 10.\n",
            x[0], x[1], y[0], y[1]
        )
    };
    let cell = |e: u64| {
        let nodes: Vec<String> = (e..e + 8).map(|n| n.to_string()).collect();
        format!(
            "*Element, type=C3D8, elset=B{e}\n{e}, {}\n",
            nodes.join(", ")
        )
    };
    format!(
        "*Heading\nthe same, flat\n{}*Elset, elset=PlateAll\n1, 2, 3\n{}{}{}{}*Nset, nset=Held, generate\n1, 8\n*Nset, nset=Tops\n105, 106, 107, 108, 205, 206, 207, 208\n\
         *Surface, name=Upper\nPlateAll, S2\n*Surface, name=Down\nB101, S1\n*Surface, name=Press\nB101, S2\n*Surface, name=Glued\nB201, S1\n{}{}{MATERIALS}\
         *Solid Section, elset=PlateAll, material=Base\n*Solid Section, elset=B101, orientation=O1, material=Ply\n*Solid Section, elset=B201, orientation=O2, material=Ply\n\
         *Tie, name=Glue\nGlued, Upper\n*Contact Pair, interaction=Dry, type=SURFACE TO SURFACE\nDown, Upper\n\
         *Step\n*Static\n0.5, 1., 1e-05, 1.\n*Boundary\nHeld, 1, 3\n105, 2\n*Cload\n207, 1, 3.\n106, 1, 2.\n205, 3, .5\n206, 3, .5\n207, 3, .5\n208, 3, .5\n\
         *Dsload\nPress, P, 20.\n*Dload\nB201, GRAV, 9.81, 0., 0., -1.\n*Node Print, nset=Held, totals=ONLY\nRF\n*Node Print, nset=Tops\nU\n*El Print, elset=B201\nS\n\
         *Contact Print, slave=Down, master=Upper, totals=ONLY\nCF\n*End Step\n",
        plate(),
        block(101, false, [0.25, 0.0, 0.5]),
        cell(101),
        block(201, true, [3.0, 0.0, 0.5]),
        cell(201),
        axes(["1.", "0.5"], ["0.", "1."], "O1"),
        axes(["-0.5", "1."], ["-1.", "0."], "O2"),
    )
}

/// Whether two runs print the same numbers.
#[track_caller]
fn alike(a: &Run, b: &Run, title: &str) {
    let (a, b) = (a.all(title), b.all(title));
    assert!(!b.is_empty() && a.len() == b.len(), "{title}: {a:?} {b:?}");
    for (a, b) in a.iter().zip(&b) {
        assert_eq!(a.2.len(), b.2.len(), "{title}");
        for (a, b) in a.2.iter().flatten().zip(b.2.iter().flatten()) {
            // Numbers are printed with seven digits.
            assert!(
                (a - b).abs() <= 2e-6 * b.abs().max(1e-4),
                "{title}: {a} is not {b}"
            );
        }
    }
}

#[test]
fn an_assembly_gives_what_the_flat_deck_gives() {
    let (a, b) = (run("assembled", &assembled()), run("flat", &flat()));
    let nodes = (1..17).chain(101..109).chain(201..209);
    for n in nodes {
        near3(a.u(n), b.u(n), 1e-10);
    }
    assert!(b.u(106)[0].abs() > 1e-4 && b.u(207)[0].abs() > 1e-4);
    alike(&a, &b, "total force");
    alike(&a, &b, "total surface force");
}

#[test]
fn nodes_and_elements_are_printed_by_their_instance() {
    run("labels", &assembled());
    let path = crate::support::place("labels.dat");
    let text = std::fs::read_to_string(path).expect("a .dat file");
    for wanted in [
        "for set TOPS and time",
        "\nSolid block-1.5 ",
        "\nSolid block-2.8 ",
        "for set Solid block-2.ALL and time",
        "\nSolid block-2.1   1 ",
    ] {
        assert!(text.contains(wanted), "{wanted}: {text}");
    }
}

#[test]
fn bodies_are_called_like_their_instances() {
    let t = translate(&assembled());
    for name in [
        "[body.PLATE-1]",
        "[body.\"Solid block-1\"]",
        "[body.\"Solid block-2\"]",
    ] {
        assert!(t.toml.contains(name), "{name}: {}", t.toml);
    }
    assert_eq!(t.plan.numbering.label(207), "Solid block-2.7");
    assert_eq!(t.plan.numbering.label(301), "1");
}

/// A part of one cube with sets, and what stands behind the assembly.
const PART: &str = "*Element, type=C3D8\n1, 1, 2, 3, 4, 5, 6, 7, 8\n*Nset, nset=Bottom, generate\n1, 4, 1\n*Nset, nset=Top\n5, 6, 7, 8\n*Elset, elset=All\n1\n\
    *Surface, name=Over\nAll, S2\n";
const STEP: &str = "*Step\n*Static\n1., 1.\n*Dsload\nA-1.Over, P, -10.\n*End Step\n";
const HOLD: &str = "*Boundary\nA-1.Bottom, 1, 3\n";
const STEEL: &str = "*Material, name=Steel\n*Elastic\n1000., 0.\n";

fn nodes() -> String {
    let all = cube("N", 1, 0.0);
    let end = all.find("*ELEMENT").expect("elements behind the nodes");
    all[..end].replace(", NSET=N", "")
}

#[test]
fn the_mesh_stands_in_the_part_or_in_the_instance_or_in_both() {
    let (nodes, section) = (nodes(), "*Solid Section, elset=All, material=Steel\n,\n");
    let whole = format!("{nodes}{PART}{section}");
    let rest = format!("{PART}{section}");
    for (i, (part, instance)) in [(&*whole, ""), ("", &*whole), (&*nodes, &*rest)]
        .into_iter()
        .enumerate()
    {
        let before = format!("{STEEL}*Part, name=A\n{part}*End Part\n");
        let assembly = format!(
            "*Assembly, name=S\n*Instance, name=A-1, part=A\n{instance}*End Instance\n*End Assembly\n"
        );
        let r = run(
            &format!("mesh-{i}"),
            &format!("{before}{assembly}{HOLD}{STEP}"),
        );
        near(r.u(7)[2], 0.01, 1e-6);
    }
}

#[test]
fn an_instance_may_have_no_part() {
    let deck = format!(
        "*Assembly, name=S\n*Instance, name=A-1\n{}{PART}*Solid Section, elset=All, material=Steel\n*End Instance\n*End Assembly\n{STEEL}{HOLD}{STEP}",
        nodes()
    );
    near(run("no-part", &deck).u(7)[2], 0.01, 1e-6);
}

#[test]
fn flat_cards_and_an_assembly_share_a_deck() {
    // The flat cube comes before or behind the instance; numbers may be the same.
    let flat = cube("N", 1, 0.0) + &sections(&["EN"]);
    let one = |order: [&str; 2]| {
        let part = format!(
            "*Part, name=A\n{}{PART}*Solid Section, elset=All, material=EL\n*End Part\n",
            nodes()
        );
        let held = "*Nset, nset=All\nNBot, A-1.Bottom\n*Boundary\nAll, 1, 3\n";
        format!("{part}{}{}{held}{STEP}", order[0], order[1])
    };
    let assembly = "*Assembly, name=S\n*Instance, name=A-1, part=A\n5., 0., 0.\n*End Instance\n*End Assembly\n";
    for (i, order) in [[&*flat, assembly], [assembly, &*flat]]
        .into_iter()
        .enumerate()
    {
        let r = run(&format!("mixed-{i}"), &one(order));
        near(r.u(7)[2], 0.01, 1e-6);
        near(r.u(17)[2].abs() + 1.0, 1.0, 1e-12);
    }
}

#[test]
fn a_reference_point_of_the_assembly_moves_a_rigid_instance() {
    let deck = format!(
        "*Part, name=A\n{}{PART}*Solid Section, elset=All, material=Steel\n*End Part\n*Assembly, name=S\n*Node\n1, 0.5, 0.5, 3.\n*Nset, nset=RP\n1,\n\
         *Instance, name=A-1, part=A\n*End Instance\n*Instance, name=A-2, part=A\n0., 0., 1.\n*End Instance\n\
         *Rigid Body, ref node=RP, elset=A-2.All\n*Surface, name=Below\nA-2.All, S1\n*Tie, name=T\nBelow, A-1.Over\n*End Assembly\n{STEEL}*Density\n1.\n{HOLD}\
         *Step\n*Static\n1., 1.\n*Boundary\nS.RP, 1, 2\nRP, 3, 3, 0.02\nRP, 4, 6\n*End Step\n",
        nodes()
    );
    let r = run("reference", &deck);
    // The tie gives way by a millionth.
    near3(r.u(7), [0.0, 0.0, 0.02], 1e-5);
    near3(r.u(17), [0.0, 0.0, 0.02], 1e-9);
}

#[test]
fn equations_springs_and_masses_name_nodes_of_instances() {
    let deck = format!(
        "*Part, name=A\n{}{PART}*Element, type=SPRING1, elset=Soft\n9, 7\n*Spring, elset=Soft\n3\n100.\n*Solid Section, elset=All, material=Steel\n*End Part\n\
         *Assembly, name=S\n*Instance, name=A-1, part=A\n*End Instance\n*Instance, name=A-2, part=A\n3., 0., 0.\n*End Instance\n\
         *Element, type=SPRINGA, elset=Link\n1, A-1.6, A-2.5\n*Spring, elset=Link\n\n40.\n*Equation\n2\nA-1.7, 3, 1., A-2.7, 3, -1.\n*End Assembly\n{STEEL}\
         *Boundary\nA-1.Bottom, 1, 3\nA-2.Bottom, 1, 3\n{STEP}",
        nodes()
    );
    let r = run("linked", &deck);
    near(r.u(7)[2], r.u(17)[2], 1e-9);
    assert!(r.u(7)[2] > 1e-3 && r.u(15)[0] < 0.0, "{:?}", r.u(15));
}

fn deck(text: &str) -> Deck {
    stickslip_deck::parse(text.as_bytes(), Path::new("job.inp")).unwrap_or_else(|e| panic!("{e}"))
}

/// A tetrahedron in a part with its instance lines.
fn tetrahedron(before: &str, lines: &str) -> Deck {
    deck(&format!(
        "*Part, name=A\n{before}*Node\n1, 0., 0., 0.\n2, 1., 0., 0.\n3, 0., 1., 0.\n4, 0., 0., 1.\n*Element, type=C3D4, elset=E\n1, 1, 2, 3, 4\n\
         *Transform, nset=4, type=C\n0., 0., 0., 0., 0., 1.\n*Transform, nset=2\n1., 0., 0., 0., 1., 0.\n*End Part\n\
         *Assembly, name=S\n*Instance, name=A-1, part=A\n{lines}*End Instance\n*End Assembly\n"
    ))
}

#[test]
fn the_rotation_follows_the_translation() {
    // To (2, 0, 0) and (3, 0, 0), then by 30 degrees about z.
    let d = tetrahedron("", "2., 0., 0.\n0., 0., 0., 0., 0., 4., 30.\n");
    let (s, c) = (0.5, 0.75_f64.sqrt());
    near3(d.nodes[&1], [2.0 * c, 2.0 * s, 0.0], 1e-14);
    near3(d.nodes[&2], [3.0 * c, 3.0 * s, 0.0], 1e-14);
    near3(d.nodes[&3], [2.0 * c - s, 2.0 * s + c, 0.0], 1e-14);
    // An axis elsewhere, the other way round.
    let d = tetrahedron("", "0., 0., 0.\n1., 0., 5., 1., 0., 0., 90.\n");
    assert_eq!(d.nodes[&1], [1.0, 1.0, 0.0]);
    assert_eq!(d.nodes[&3], [2.0, 1.0, 0.0]);
    // No translation, written as a line without numbers.
    let d = tetrahedron("", ",\n0., 0., 0., 1., 0., 0., 180.\n");
    assert_eq!(d.nodes[&4], [0.0, 0.0, -1.0]);
}

#[test]
fn local_axes_go_with_the_instance() {
    let d = tetrahedron("", "1., 0., 0.\n0., 0., 0., 1., 0., 0., 90.\n");
    let axis = d.properties.transforms[&4];
    near3(axis.a, [1.0, 0.0, 0.0], 1e-15);
    near3(axis.b, [1.0, -1.0, 0.0], 1e-15);
    near3(d.properties.transforms[&2].b, [0.0, 0.0, 1.0], 1e-15);
}

#[test]
fn sections_have_the_orientation_of_their_part_or_of_the_model() {
    let text = |within: &str, outside: &str| {
        format!(
            "*Part, name=A\n{within}{}{PART}*Solid Section, elset=All, material=Steel, orientation=O\n*End Part\n*Assembly, name=S\n\
             *Instance, name=A-1, part=A\n0., 0., 0.\n0., 0., 0., 0., 0., 1., 90.\n*End Instance\n*End Assembly\n{outside}{STEEL}",
            nodes()
        )
    };
    let axes = "*Orientation, name=O\n1., 0., 0., 0., 1., 0.\n";
    let axis = |d: &Deck| {
        let name = d.properties.sections[0]
            .orientation
            .clone()
            .expect("an orientation");
        match &d.properties.orientations[&name].local {
            Local::Axes(axes) => axes[0],
            other => panic!("{other:?}"),
        }
    };
    near3(axis(&deck(&text(axes, ""))), [0.0, 1.0, 0.0], 1e-15);
    near3(axis(&deck(&text("", axes))), [1.0, 0.0, 0.0], 1e-15);
}

#[test]
fn nodes_of_a_set_that_is_only_printed_may_be_missing() {
    let d = deck(&format!(
        "*Part, name=A\n{}{PART}*Nset, nset=Far\n7, 99\n*Solid Section, elset=All, material=Steel\n*End Part\n*Assembly, name=S\n\
         *Instance, name=A-1, part=A\n*End Instance\n*Instance, name=A-2, part=A\n9.\n*End Instance\n*End Assembly\n{STEEL}\
         *Step\n*Static\n*Node Print, nset=A-2.Far\nU\n*Node Print, nset=A-1.Far\nU\n*End Step\n",
        nodes()
    ));
    let said = d.notes.iter().map(|n| n.message.as_str());
    let said: Vec<&str> = said.filter(|m| m.contains("99")).collect();
    assert_eq!(
        said,
        ["there is no node A-1.99: it is left out of the set A-1.FAR, which is only printed"]
    );
}

#[test]
fn a_system_moves_the_nodes_behind_it() {
    // The origin at (1, 2, 3), x along y, y along -x.
    let d = tetrahedron("*System\n1., 2., 3., 1., 5., 3.\n-4., 2., 3.\n", "10.\n");
    assert_eq!(d.nodes[&2], [11.0, 3.0, 3.0]);
    assert_eq!(d.nodes[&3], [10.0, 2.0, 3.0]);
    // Only moved; and it ends with the part, and with a card without lines.
    let d = tetrahedron("*System\n1., 2., 3.\n*Node\n9, 0., 0., 0.\n*System\n", "");
    assert_eq!(d.nodes[&9], [1.0, 2.0, 3.0]);
    assert_eq!(d.nodes[&1], [0.0; 3]);
    // The z axis stays where no third point is given.
    let flat = deck(
        "*System\n0., 0., 1., 0., 2., 1.\n*Node\n1, 1., 0., 0.\n2, 0., 1., 0.\n3, 0., 0., 1.\n4, 0., 0., 0.\n*Element, type=C3D4\n1, 1, 2, 3, 4\n",
    );
    assert_eq!(flat.nodes[&1], [0.0, 1.0, 1.0]);
    assert_eq!(flat.nodes[&2], [-1.0, 0.0, 1.0]);
    assert_eq!(flat.nodes[&3], [0.0, 0.0, 2.0]);
}

#[test]
fn names_are_looked_up_in_their_instance_first() {
    let part = |name: &str, last: &str| {
        format!(
            "*Part, name={name}\n{}{PART}*Nset, nset=Corner\n{last}\n*Solid Section, elset=All, material=Steel\n*End Part\n",
            nodes()
        )
    };
    let d = deck(&format!(
        "{}{}*Assembly, name=\"The whole\"\n*Instance, name=A-1, part=A\n*End Instance\n*Instance, name=\"b 1\", part=B\n9., 0., 0.\n*End Instance\n\
         *Node\n5, 0., 0., 9.\n*Nset, nset=Corner\n5\n*Nset, nset=Both\na-1.Corner, \"b 1\".Corner, B1.3, Corner\n*Nset, nset=Some, instance=\"b 1\", generate\n2, 8, 3\n*End Assembly\n{STEEL}\
         *Boundary\n\"The whole\".Both, 1\n\"The whole\".A-1.8, 2\n",
        part("A", "7"),
        part("B", "6"),
    ));
    assert_eq!(d.node_sets["A-1.CORNER"], [7]);
    assert_eq!(d.node_sets["b 1.CORNER"], [16]);
    assert_eq!(d.node_sets["CORNER"], [25]);
    assert_eq!(d.node_sets["BOTH"], [7, 16, 13, 25]);
    assert_eq!(d.node_sets["SOME"], [12, 15, 18]);
    assert_eq!(d.label(16), "b 1.6");
    assert_eq!(d.supports.len(), 2);
}

#[test]
fn a_part_that_stands_nowhere_is_left_out() {
    let d = deck(&format!(
        "*Part, name=Spare\n{0}{PART}*End Part\n*Part, name=A\n{0}{PART}*End Part\n*Assembly, name=S\n*Instance, name=A-1, part=A\n*End Instance\n*End Assembly\n",
        nodes()
    ));
    assert_eq!(d.nodes.len(), 8);
    let notes: Vec<&str> = d.notes.iter().map(|n| n.message.as_str()).collect();
    assert_eq!(notes, ["the part SPARE has no instance: it is left out"]);
    assert_eq!(d.notes[0].severity, Severity::Note);
}

//! Keywords one by one, against what can be computed by hand. CalculiX 2.20 gives the same numbers where that is said.

use crate::support::{column, cube, near, near3, pair, run, sections, translate};

/// A cube under a stress of 10 along x, with this material; symmetric supports.
fn pulled(material: &str) -> String {
    format!(
        "{}*NSET, NSET=X0\n1, 4, 5, 8\n*NSET, NSET=Y0\n1, 2, 5, 6\n*MATERIAL, NAME=M\n{material}*BOUNDARY\nX0, 1\nY0, 2\nNBOT, 3\n\
         *STEP\n*STATIC\n*DLOAD\nEN, P4, -10.\n*NODE PRINT, NSET=N\nU\n*EL PRINT, ELSET=EN\nS\n*END STEP\n",
        cube("N", 1, 0.0)
    )
}

const ENGINEERING: &str = "1000., 2000., 4000., .1, .2, .3, 500., 600.,\n700.\n";

/// The stiffness of [`ENGINEERING`] in the order 11 22 33 12 13 23.
fn stiffness() -> [[f64; 3]; 3] {
    let (e, n12, n13, n23) = ([1000.0, 2000.0, 4000.0], 0.1, 0.2, 0.3);
    let c = [
        [1.0 / e[0], -n12 / e[0], -n13 / e[0]],
        [-n12 / e[0], 1.0 / e[1], -n23 / e[1]],
        [-n13 / e[0], -n23 / e[1], 1.0 / e[2]],
    ];
    let minor = |i: usize, j: usize| {
        let [a, b] = [(i + 1) % 3, (i + 2) % 3];
        let [p, q] = [(j + 1) % 3, (j + 2) % 3];
        c[a][p] * c[b][q] - c[a][q] * c[b][p]
    };
    let det: f64 = (0..3).map(|j| c[0][j] * minor(0, j)).sum();
    std::array::from_fn(|i| std::array::from_fn(|j| minor(j, i) / det))
}

#[test]
fn elastic_constants_of_every_type_give_their_moduli() {
    let section = "*SOLID SECTION, ELSET=EN, MATERIAL=M\n";
    let c = stiffness();
    let ortho = format!(
        "{}, {}, {}, {}, {}, {}, 500., 600.\n700.\n",
        c[0][0], c[0][1], c[1][1], c[0][2], c[1][2], c[2][2]
    );
    let aniso = format!(
        "{}, {}, {}, {}, {}, {}, 0., 0.\n0., 500., 0., 0., 0., 0., 600., 0.\n0., 0., 0., 0., 700.\n",
        c[0][0], c[0][1], c[1][1], c[0][2], c[1][2], c[2][2]
    );
    for (name, material, wanted) in [
        (
            "iso",
            "*ELASTIC\n1000., .25, 20.\n900., .25, 400.\n".to_string(),
            [0.01, -0.0025, -0.0025],
        ),
        (
            "constants",
            format!("*ELASTIC, TYPE=ENGINEERING CONSTANTS\n{ENGINEERING}"),
            [0.01, -0.001, -0.002],
        ),
        (
            "ortho",
            format!("*ELASTIC, TYPE=ORTHO\n{ortho}"),
            [0.01, -0.001, -0.002],
        ),
        (
            "aniso",
            format!("*ELASTIC, TYPE=ANISO\n{aniso}"),
            [0.01, -0.001, -0.002],
        ),
    ] {
        let r = run(&format!("elastic-{name}"), &pulled(&(material + section)));
        near3(r.u(7), wanted, 1e-8);
    }
}

#[test]
fn orientations_turn_the_material_and_what_is_printed() {
    // The axis 1 of the material is y, its axis 2 is -x: along x the modulus is 2000. u = 10 (1/E2, -nu12/E1, -nu23/E2).
    let turned = |definition: &str| {
        format!(
            "*ELASTIC, TYPE=ENGINEERING CONSTANTS\n{ENGINEERING}*ORIENTATION, NAME=O, SYSTEM=RECTANGULAR\n{definition}\
             *SOLID SECTION, ELSET=EN, MATERIAL=M, ORIENTATION=O\n"
        )
    };
    for (name, definition) in [
        ("axes", "0., 1., 0., -1., 0., 0.\n"),
        ("about", "1., 0., 0., 0., 1., 0.\n3, 90.\n"),
    ] {
        let r = run(&format!("orientation-{name}"), &pulled(&turned(definition)));
        near3(r.u(7), [0.005, -0.001, -0.0015], 1e-8);
        // CalculiX prints along the axes of the material: the stress along x is that in direction 2.
        let stress = r.last("stresses");
        near(stress[3], 10.0, 1e-8);
        assert!(stress[2].abs() < 1e-6);
    }
    let cylindrical = turned("0., 0., 0., 0., 0., 1.\n").replace("RECTANGULAR", "CYLINDRICAL");
    // Radial at the centre of the cell, between x and y.
    let text = translate(&pulled(&cylindrical)).toml;
    assert!(text.contains("axes = [[0.7071067811865"), "{text}");
}

#[test]
fn transforms_turn_supports_forces_and_what_is_printed() {
    // A rigid motion of 0.1 along the local axis 1, at 30 degrees to x.
    let deck = |print: &str| {
        format!(
            "{}{}*TRANSFORM, NSET=N, TYPE=R\n.8660254037844386, .5, 0., -.5, .8660254037844386, 0.\n*STEP\n*STATIC\n*BOUNDARY\nN, 1, 1, .1\nN, 2, 3\n\
             *NODE PRINT, NSET=N{print}\nU\n*END STEP\n",
            cube("N", 1, 0.0),
            sections(&["EN"])
        )
    };
    let local = run("transform-local", &deck(""));
    near3(local.u(7), [0.1 * 0.75_f64.sqrt(), 0.05, 0.0], 1e-9);
    near3(
        local.last("displacements")[1..].try_into().expect("three"),
        [0.1, 0.0, 0.0],
        1e-9,
    );
    let global = run("transform-global", &deck(", GLOBAL=YES"));
    near3(
        global.last("displacements")[1..].try_into().expect("three"),
        [0.1 * 0.75_f64.sqrt(), 0.05, 0.0],
        1e-6,
    );

    // Radial, about the axis through (0.5, 0.5): corners move along the diagonals.
    let radial = format!(
        "{}{}*TRANSFORM, NSET=N, TYPE=C\n.5, .5, 0., .5, .5, 1.\n*STEP\n*STATIC\n*BOUNDARY\nN, 1, 1, .1\nN, 2, 3\n*END STEP\n",
        cube("N", 1, 0.0),
        sections(&["EN"])
    );
    let radial = run("transform-radial", &radial);
    let d = 0.1 / 2f64.sqrt();
    near3(radial.u(7), [d, d, 0.0], 1e-9);
    near3(radial.u(5), [-d, -d, 0.0], 1e-9);

    // A force along a local axis that is z.
    let force = format!(
        "{}{}*BOUNDARY\nNBOT, 1, 3\nNTOP, 2, 3\n*TRANSFORM, NSET=NTOP\n0., 0., 1., 1., 0., 0.\n*STEP\n*STATIC\n*CLOAD\nNTOP, 1, 2.5\n*END STEP\n",
        cube("N", 1, 0.0),
        sections(&["EN"])
    );
    near(run("transform-force", &force).u(7)[2], 0.01, 1e-9);
}

#[test]
fn weight_and_centrifugal_force_act_on_volumes() {
    // A rod of one linear cell: half of the weight acts at its end.
    let text = format!(
        "{}*STEP\n*STATIC\n*DLOAD\nEN, GRAV, 9.81, 0., 0., -1.\n*END STEP\n",
        column()
    );
    near(run("gravity", &text).u(7)[2], -9.81 / 2.0 / 1000.0, 1e-9);
    // About the y axis: density omega² z, a third of omega² at the end.
    let text = format!(
        "{}*STEP\n*STATIC\n*DLOAD\nEN, CENTRIF, 100., 0., 0., 0., 0., 1., 0.\n*END STEP\n",
        column()
    );
    near(run("centrif", &text).u(7)[2], 100.0 / 3.0 / 1000.0, 1e-9);
    let text = format!(
        "{}*STEP\n*STATIC\n*DLOAD\nEN, BZ, 3.\n*END STEP\n",
        column()
    );
    near(run("body-force", &text).u(7)[2], 1.5 / 1000.0, 1e-9);
}

/// Presses the upper cube on the lower one by 4.
const PRESS: &str = "*STEP\n*STATIC\n*BOUNDARY\nB, 1\n*DLOAD\nEB, P2, 4.\n*END STEP\n";

#[test]
fn surface_behaviours_give_their_overclosures() {
    // Two cubes with E = 1000 shorten by 0.004 each; the interface gives the rest.
    let elastic = -0.008;
    for (name, behavior, gap) in [
        (
            "linear",
            "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n800.\n",
            -0.005,
        ),
        (
            "hard",
            "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD\n",
            0.0,
        ),
        ("none", "", 0.0),
        (
            "tabular",
            "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=TABULAR\n0., 0.\n2., .001\n6., .002\n",
            -0.0015,
        ),
        // p0 at contact, a hundredth of it at c0: p = p0 exp(-ln(100) g / c0).
        (
            "exponential",
            "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=EXPONENTIAL\n.01, 10.\n",
            0.01 * (2.5_f64).ln() / 100_f64.ln(),
        ),
    ] {
        for kind in ["SURFACE TO SURFACE", "NODE TO SURFACE"] {
            let tag = if kind.starts_with('N') { "n2f" } else { "f2f" };
            let r = run(
                &format!("behavior-{name}-{tag}"),
                &(pair(0.0, kind, behavior) + PRESS),
            );
            near(r.u(17)[2], elastic + gap, 1e-4);
        }
    }
}

#[test]
fn tied_surfaces_carry_tension() {
    let pull = PRESS.replace("4.", "-4.");
    let tied = pair(
        0.0,
        "SURFACE TO SURFACE",
        "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=TIED\n",
    );
    near(run("tied-behavior", &(tied + &pull)).u(17)[2], 0.008, 1e-6);
    let tie = pair(0.0, "SURFACE TO SURFACE", "");
    let from = tie.find("*SURFACE INTERACTION").expect("it is there");
    let to = tie.find("*BOUNDARY").expect("it is there");
    let tie = format!(
        "{}*TIE, NAME=T, POSITION TOLERANCE=.1\nSLAVE, MASTER\n{}",
        &tie[..from],
        &tie[to..]
    );
    near(run("tie", &(tie + &pull)).u(17)[2], 0.008, 1e-6);
}

#[test]
fn clearances_count_from_what_the_deck_says() {
    // A gap of 0.001 in the meshes counts as none.
    let closed = pair(0.001, "SURFACE TO SURFACE", "")
        + "*CLEARANCE, MASTER=MASTER, SLAVE=SLAVE, VALUE=0.\n";
    near(run("clearance", &(closed + PRESS)).u(17)[2], -0.008, 1e-6);
    let open = pair(0.001, "SURFACE TO SURFACE", "");
    near(run("gap", &(open + PRESS)).u(17)[2], -0.009, 1e-6);
    let adjusted = pair(0.001, "SURFACE TO SURFACE", "")
        .replace("SURFACE\nSLAVE", "SURFACE, ADJUST=.002\nSLAVE");
    near(run("adjust", &(adjusted + PRESS)).u(17)[2], -0.008, 2e-3);
}

#[test]
fn printed_at_slave_nodes_the_slave_keeps_its_role() {
    let text = pair(0.0, "SURFACE TO SURFACE", "") + PRESS;
    let kept = |text: &str| translate(text).toml.contains("roles = \"as-named\"");
    assert!(!kept(&text));
    assert!(kept(
        &text.replace("*END STEP", "*CONTACT PRINT\nCSTR\n*END STEP")
    ));
    assert!(!kept(
        &text.replace("*END STEP", "*CONTACT PRINT\nCNUM\n*END STEP")
    ));
}

#[test]
fn friction_holds_up_to_its_limit_and_changes_with_steps() {
    // Pressed by 0.04 the interface carries half of it, and a quarter from the third step on. The forces are small so that the
    // lower cube hardly tilts.
    let slide = "*STEP\n*STATIC\n*BOUNDARY\nB, 1, 1, 0.\n*DLOAD\nEB, P2, .04\n*END STEP\n\
                 *STEP\n*STATIC\n.5, 1.\n*BOUNDARY\nB, 1, 1, .02\n*NODE PRINT, NSET=B, TOTALS=ONLY\nRF\n*CONTACT PRINT\nCSTR\n*END STEP\n\
                 *STEP\n*CHANGE FRICTION, INTERACTION=SI\n*FRICTION\n.25, 1.E4\n*STATIC\n.5, 1.\n*BOUNDARY\nB, 1, 1, .04\n\
                 *NODE PRINT, NSET=B, TOTALS=ONLY\nRF\n*END STEP\n";
    let text = pair(
        0.0,
        "SURFACE TO SURFACE",
        "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n1.E5\n*FRICTION\n.5, 1.E4\n",
    ) + slide;
    let r = run("friction", &text);
    let force: Vec<f64> = r.all("total force").iter().map(|b| b.2[0][0]).collect();
    near(force[force.len() / 2 - 1], 0.02, 1e-3);
    near(*force.last().expect("it is printed"), 0.01, 1e-3);
    for row in &r.all("contact stress")[1].2 {
        near(row[2].abs() / row[1], 0.5, 1e-5);
    }
    // Before it slides, it sticks like a spring of the slope that is given.
    let stick = text
        .split("*STEP\n*CHANGE")
        .next()
        .expect("a part")
        .replace("B, 1, 1, .02", "ATOP, 1\nB, 1, 1, .000001");
    let r = run("stick", &stick);
    near(r.last("total force")[0], 1e-6 * 1e4, 1e-4);
}

#[test]
fn behaviours_change_with_steps() {
    let text = pair(
        0.0,
        "SURFACE TO SURFACE",
        "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n800.\n",
    ) + PRESS
        + "*STEP\n*CHANGE SURFACE BEHAVIOR, INTERACTION=SI\n*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n400.\n*STATIC\n*END STEP\n";
    near(run("change-behavior", &text).u(17)[2], -0.018, 1e-4);
}

#[test]
fn springs_equations_and_rigid_bodies_tie_nodes() {
    // Springs of 100 at each node of the end, from it to the ground: 4 * 100 beside the 1000 of the rod.
    let ground = |kind: &str, elements: &str, directions: &str| {
        format!(
            "{}*ELEMENT, TYPE={kind}, ELSET=SP\n{elements}*SPRING, ELSET=SP\n{directions}\n100.\n*STEP\n*STATIC\n*CLOAD\nNTOP, 3, 3.5\n*END STEP\n",
            column()
        )
    };
    let text = ground("SPRING1", "11, 5\n12, 6\n13, 7\n14, 8\n", "3");
    near(run("spring1", &text).u(7)[2], 0.01, 1e-9);
    let text = ground(
        "SPRING2",
        "11, 5, 1\n12, 6, 2\n13, 7, 3\n14, 8, 4\n",
        "3, 3",
    );
    near(run("spring2", &text).u(7)[2], 0.01, 1e-9);
    let text = ground("SPRINGA", "11, 5, 1\n12, 6, 2\n13, 7, 3\n14, 8, 4\n", "");
    near(run("springa", &text).u(7)[2], 0.01, 1e-6);
    // One end of the springs is a node of no cell that is held.
    let text = ground("SPRINGA", "11, 5, 25\n12, 6, 26\n13, 7, 27\n14, 8, 28\n", "").replace(
        "*ELEMENT, TYPE=SPRINGA",
        "*NODE, NSET=GROUND\n25, 0., 0., 3.\n26, 1., 0., 3.\n27, 1., 1., 3.\n28, 0., 1., 3.\n*BOUNDARY\nGROUND, 1, 3\n*ELEMENT, TYPE=SPRINGA",
    );
    near(run("springa-ground", &text).u(7)[2], 0.01, 1e-6);

    // All of the force at one node, the others move with it.
    let text = format!(
        "{}*EQUATION\n2\n5, 3, 1., 6, 3, -1.\n2\n7, 3, 1., 6, 3, -1.\n2\n8, 3, 1., 6, 3, -1.\n*STEP\n*STATIC\n*CLOAD\n6, 3, 10.\n*END STEP\n",
        column()
    );
    near(run("equation", &text).u(7)[2], 0.01, 1e-9);

    // The upper cube is rigid and is moved by its reference node; the lower one is pressed by 0.008.
    let text = pair(0.0, "SURFACE TO SURFACE", "")
        + "*NODE\n99, .5, .5, 2.\n*RIGID BODY, ELSET=EB, REF NODE=99\n*STEP\n*STATIC\n*BOUNDARY\n99, 1, 2\n99, 4, 6\n99, 3, 3, -.008\n\
           *NODE PRINT, NSET=ABOT, TOTALS=ONLY\nRF\n*END STEP\n";
    let r = run(
        "rigid",
        &text.replace("*BOUNDARY\nA, 2\nB, 2\n", "*BOUNDARY\nA, 2\n"),
    );
    near(r.u(3)[2], 0.0, 1e-12);
    near(r.u(7)[2], -0.008, 1e-6);
    near(r.last("total force")[2], 8.0, 1e-5);
}

#[test]
fn a_rigid_set_of_nodes_follows_its_reference_node() {
    // PrePoMax ties the nodes of a face to a reference node.
    let text = format!(
        "{}*NODE\n99, .5, .5, 2.\n98, .5, .5, 2.\n*RIGID BODY, NSET=NTOP, REF NODE=99, ROT NODE=98\n*STEP\n*STATIC\n*BOUNDARY\n98, 1, 3\n99, 1, 2\n99, 3, 3, .01\n\
         *NODE PRINT, NSET=NTOP, TOTALS=ONLY\nRF\n*END STEP\n",
        cube("N", 1, 0.0) + &sections(&["EN"]) + "*BOUNDARY\nNBOT, 1, 3\n"
    );
    let r = run("rigid-nodes", &text);
    near3(r.u(7), [0.0, 0.0, 0.01], 1e-9);
    near(r.last("total force")[2], 10.0, 1e-6);
}

#[test]
fn normal_and_shear_forces_of_contact_are_printed_apart() {
    let text = pair(
        0.0,
        "SURFACE TO SURFACE",
        "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n1.E5\n*FRICTION\n.5, 1.E4\n",
    ) + "*STEP\n*STATIC\n*BOUNDARY\nB, 1, 1, .000001\nATOP, 1\nBTOP, 3, 3, -.0001\n*CONTACT PRINT, SLAVE=SLAVE, MASTER=MASTER\nCF\nCFN\nCFS\n*END STEP\n";
    let r = run("contact-forces", &text);
    let forces: Vec<Vec<f64>> = r
        .all("total surface force")
        .iter()
        .map(|b| b.2[0].clone())
        .collect();
    let [all, normal, shear] = forces.try_into().unwrap_or_else(|f| panic!("{f:?}"));
    // Forces and moments about the origin add up; pressure is along z and shear along x.
    for k in 0..6 {
        assert!(
            (all[k] - normal[k] - shear[k]).abs() <= 2e-6 * all[2],
            "{k}"
        );
    }
    near(normal[2], all[2], 1e-6);
    near(shear[0], all[0], 1e-6);
    assert!(normal[2] > 0.0 && shear[0] < 0.0 && shear[2].abs() < 1e-9);
    let sizes = r.all("area,");
    assert!(sizes[1].2[0][2].abs() < 1e-9 && sizes[2].2[0][1].abs() < 1e-9);
    near(sizes[2].2[0][2], -all[0], 1e-6);
}

#[test]
fn laws_that_programs_read_differently_are_said_or_refused() {
    let table = |rows: &str| format!("*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=TABULAR\n{rows}");
    let deck = |interaction: &str| {
        pair(0.0, "NODE TO SURFACE", interaction)
            + "*STEP\n*STATIC\n*BOUNDARY\nBTOP, 3, 3, -.001\n*END STEP\n"
    };
    let message = crate::support::refused(&deck(&table("5., 0.\n10., .001\n")));
    assert!(message.contains("begins with a pressure of 5"), "{message}");
    let said = |text: &str| -> String {
        let notes = crate::support::translate(text).notes;
        notes.iter().map(|n| n.to_string()).collect()
    };
    // CalculiX 2.20: two such cubes, between nodes and faces and pressed by 0.01, carry 3.
    let beyond = said(&deck(&table("0., 0.\n1., .0005\n3., .002\n")));
    assert!(
        beyond.contains("beyond an overclosure of 0.002") && beyond.contains("keeps it at 3"),
        "{beyond}"
    );
    // CalculiX 2.20: the four nodes below a cube have three times its face.
    let nodes = |law: &str| {
        deck(law).replace(
            "*SURFACE, NAME=SLAVE\nEB, S1\n",
            "*SURFACE, NAME=SLAVE, TYPE=NODE\nBBOT\n",
        )
    };
    let linear = said(&nodes(
        "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n1.E5\n",
    ));
    assert!(
        linear.contains("the nodes of SLAVE have the areas"),
        "{linear}"
    );
    let hard = said(&nodes("*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD\n"));
    assert!(!hard.contains("have the areas"), "{hard}");
}

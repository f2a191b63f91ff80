//! Temperatures of decks: what CalculiX 2.20 has for the same text, and what is refused.

use crate::support::{refused, run, translate};

/// The corners of a unit cube in the order of the formats.
const CORNERS: [[f64; 3]; 8] = [
    [0.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [1.0, 1.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 0.0, 1.0],
    [1.0, 0.0, 1.0],
    [1.0, 1.0, 1.0],
    [0.0, 1.0, 1.0],
];

/// Corners and the middles of these edges.
fn with_middles(corners: &[[f64; 3]], edges: &[[usize; 2]]) -> Vec<[f64; 3]> {
    let middle =
        |e: &[usize; 2]| std::array::from_fn(|i| 0.5 * (corners[e[0]][i] + corners[e[1]][i]));
    let middles = edges.iter().map(middle);
    corners.iter().copied().chain(middles).collect()
}

/// The nodes of one element of a type. Around an axis it begins at the radius 1.
fn nodes(kind: &str) -> Vec<[f64; 3]> {
    let square = [[0, 1], [1, 2], [2, 3], [3, 0]];
    match kind {
        "CPE4" => CORNERS[..4].to_vec(),
        "CAX4" => CORNERS[..4]
            .iter()
            .map(|x| [1.0 + x[0], x[1], 0.0])
            .collect(),
        "CPE8" => with_middles(&CORNERS[..4], &square),
        "C3D10" => {
            let corners = [CORNERS[0], CORNERS[1], CORNERS[3], CORNERS[4]];
            with_middles(&corners, &[[0, 1], [1, 2], [2, 0], [0, 3], [1, 3], [2, 3]])
        }
        "C3D20" => {
            let top = square.map(|e| e.map(|n| n + 4));
            let up = [[0, 4], [1, 5], [2, 6], [3, 7]];
            with_middles(&CORNERS, &[square, top, up].concat())
        }
        _ => CORNERS.to_vec(),
    }
}

/// The temperature of a node. `C3D8I` has that of the mean of its nodes in CalculiX, and one that is linear here: it is the same all over.
fn warm(kind: &str, [x, y, z]: [f64; 3]) -> f64 {
    match kind {
        "C3D8I" => 115.0,
        _ => 50.0 + 40.0 * x + 60.0 * y + 30.0 * z,
    }
}

/// One element that stands on its base, warmer to the right and to the top, of an orthotropic expansion by temperature.
fn block(kind: &str) -> String {
    let nodes = nodes(kind);
    let plane = kind.starts_with("CP") || kind.starts_with("CA");
    let up = if plane { 1 } else { 2 };
    let mut text = "*NODE, NSET=N\n".to_string();
    for (i, [x, y, z]) in nodes.iter().enumerate() {
        text += &format!("{}, {x}, {y}, {z}\n", i + 1);
    }
    let list: Vec<String> = (1..=nodes.len()).map(|n| n.to_string()).collect();
    text += &format!(
        "*ELEMENT, TYPE={kind}, ELSET=E\n1, {}\n",
        list.join(", ").replacen(", 11", ",\n11", 1)
    );
    text += "*MATERIAL, NAME=M\n*ELASTIC\n2000., .3\n*EXPANSION, TYPE=ORTHO, ZERO=10.\n1.E-3, 2.E-3, 5.E-4, 0.\n2.E-3, 3.E-3, 1.E-3, 200.\n";
    text += "*SOLID SECTION, ELSET=E, MATERIAL=M\n*BOUNDARY\n";
    for (i, x) in nodes.iter().enumerate() {
        if x[up] == 0.0 {
            text += &format!("{}, 1, {}\n", i + 1, up + 1);
        }
    }
    text += "*INITIAL CONDITIONS, TYPE=TEMPERATURE\nN, 20.\n*STEP\n*STATIC\n1., 1.\n*TEMPERATURE\n";
    for (i, x) in nodes.iter().enumerate() {
        text += &format!("{}, {}\n", i + 1, warm(kind, *x));
    }
    text + "*NODE PRINT, NSET=N\nU, NT\n*EL PRINT, ELSET=E\nS, E, ME\n*END STEP\n"
}

/// What CalculiX 2.20 prints of these blocks: the displacement of a node of the top, and the stress sxx at the first point of integration.
/// Rings are thin slices of solids there. Plane stress is left out: there it is a solid whose thickness changes as one, and a single cell of `C3D20R` has motions that
/// nothing holds.
const CALCULIX: &[(&str, u64, [f64; 3], f64)] = &[
    ("C3D8", 5, [-0.09955208, -0.1628854, 0.13775], -440.7702),
    ("C3D8I", 5, [-0.1157812, -0.1870312, 0.1204464], -344.0395),
    ("C3D8R", 5, [-0.153423, -0.2469638, 0.07862889], -3.682152),
    ("C3D20", 5, [-0.108777, -0.164759, 0.00409626], -149.5511),
    ("C3D10", 4, [-0.08804675, -0.1519283, -0.0180805], -126.1028),
    ("CPE4", 3, [0.0935082, 0.2436393, 0.0], -253.2436),
    ("CPE8", 3, [0.04732164, 0.2842812, 0.0], -91.75442),
    ("CAX4", 3, [0.2377701, 0.3433222, 0.0], -409.5934),
];

#[test]
fn every_element_grows_as_in_calculix() {
    let mut apart = Vec::new();
    for &(kind, node, u, sxx) in CALCULIX {
        let run = run(&format!("warm-{kind}"), &block(kind));
        let found = run.u(node);
        let stress = run.all("stresses")[0].2[0][2];
        let size = u.iter().fold(0.0_f64, |m, u| m.max(u.abs()));
        let tolerance = if kind == "CAX4" { 2e-4 } else { 1e-5 };
        let near = (0..3).all(|i| (found[i] - u[i]).abs() <= tolerance * size)
            && (stress - sxx).abs() <= tolerance * sxx.abs();
        if !near {
            apart.push(format!("{kind}: {found:?} for {u:?}, {stress} for {sxx}"));
        }
        let temperatures = run.all("temperatures");
        assert_eq!(temperatures[0].2[1][1], warm(kind, nodes(kind)[1]));
    }
    assert!(apart.is_empty(), "{apart:#?}");
}

/// 2 x 2 x 4 bricks on a base that holds them.
fn column() -> String {
    let mut text = "*NODE, NSET=N\n".to_string();
    let id = |i: usize, j: usize, k: usize| 9 * k + 3 * j + i + 1;
    for k in 0..5 {
        for j in 0..3 {
            for i in 0..3 {
                text += &format!(
                    "{}, {}, {}, {k}\n",
                    id(i, j, k),
                    0.5 * i as f64,
                    0.5 * j as f64
                );
            }
        }
    }
    text += "*ELEMENT, TYPE=C3D8, ELSET=E\n";
    for k in 0..4 {
        for j in 0..2 {
            for i in 0..2 {
                let face = |k| {
                    format!(
                        "{}, {}, {}, {}",
                        id(i, j, k),
                        id(i + 1, j, k),
                        id(i + 1, j + 1, k),
                        id(i, j + 1, k)
                    )
                };
                text += &format!("{}, {}, {}\n", 4 * k + 2 * j + i + 1, face(k), face(k + 1));
            }
        }
    }
    text + "*NSET, NSET=BOT, GENERATE\n1, 9, 1\n*MATERIAL, NAME=M\n*ELASTIC\n210000., .3\n*EXPANSION\n1.E-5\n*SOLID SECTION, ELSET=E, MATERIAL=M\n*BOUNDARY\nBOT, 1, 3\n"
}

#[test]
fn a_column_on_a_base_that_holds_it_expands_as_in_calculix() {
    let text = column()
        + "*STEP\n*STATIC\n1., 1.\n*TEMPERATURE\nN, 100.\n*NODE PRINT, NSET=N\nRF\n*END STEP\n";
    let run = run("warm-column", &text);
    for (node, expected) in [
        (10, [-5.771508e-4, -5.771508e-4, 1.284341e-3]),
        (14, [0.0, 0.0, 1.440895e-3]),
        (19, [-4.893804e-4, -4.893804e-4, 2.324691e-3]),
        (37, [-4.993004e-4, -4.993004e-4, 4.311167e-3]),
    ] {
        for (found, expected) in run.u(node).into_iter().zip(expected) {
            assert!(
                (found - expected).abs() < 2e-6 * 4.3e-3,
                "{node}: {found} {expected}"
            );
        }
    }
    // Nothing acts on the nodes above the base.
    let forces = &run.all("forces")[0].2;
    assert!(
        forces[40][1..].iter().all(|f| f.abs() < 1e-8),
        "{:?}",
        forces[40]
    );
    assert!(forces[0][3].abs() > 1.0);
}

#[test]
fn temperatures_go_on_from_step_to_step() {
    let steps = |first: &str, second: &str| {
        format!(
            "*STEP\n*STATIC\n.5, 1.\n*TEMPERATURE\n{first}\n*END STEP\n*STEP\n*STATIC\n.5, 1.\n{second}*NODE PRINT, NSET=TIP\nU, NT\n*END STEP\n"
        )
    };
    let base = column()
        + "*NSET, NSET=TIP\n41\n*INITIAL CONDITIONS, TYPE=TEMPERATURE\nN, 20.\n*AMPLITUDE, NAME=A\n0., 1., 1., 3.\n";
    let warm = |name: &str, second: &str| -> Vec<f64> {
        let text = base.clone() + &steps("N, 100.", second);
        let run = run(&format!("warm-steps-{name}"), &text);
        run.course("temperatures", 1)
            .into_iter()
            .map(|c| c.1)
            .collect()
    };
    for (name, second, expected) in [
        ("kept", "", [100.0, 100.0]),
        ("changed", "*TEMPERATURE\nN, 200.\n", [150.0, 200.0]),
        ("new", "*TEMPERATURE, OP=NEW\nBOT, 300.\n", [60.0, 20.0]),
        (
            "amplitude",
            "*TEMPERATURE, AMPLITUDE=A\nN, 50.\n",
            [100.0, 150.0],
        ),
        ("back", "*TEMPERATURE\nN, 20.\n", [60.0, 20.0]),
    ] {
        let found = warm(name, second);
        assert!(
            (0..2).all(|i| (found[i] - expected[i]).abs() < 1e-9),
            "{name}: {found:?}"
        );
    }
}

#[test]
fn expansion_is_written_with_its_axes_and_its_zero() {
    let toml = |expansion: &str, section: &str| {
        let text = column().replace("*EXPANSION\n1.E-5\n", expansion).replace(
            "MATERIAL=M\n*BOUNDARY",
            &format!("MATERIAL=M{section}\n*BOUNDARY"),
        );
        translate(&(text + "*STEP\n*STATIC\n*TEMPERATURE\nN, 100.\n*END STEP\n")).toml
    };
    let plain = toml("*EXPANSION\n1.E-5\n", "");
    assert!(
        plain.contains("expansion = 0.00001") || plain.contains("expansion = 1e-5"),
        "{plain}"
    );
    let axes =
        "*ORIENTATION, NAME=O\n0., 1., 0., -1., 0., 0.\n*EXPANSION, TYPE=ORTHO\n1., 2., 3.\n";
    let (orientation, expansion) = axes.split_once("*EXPANSION").expect("two cards");
    let turned = toml(
        &format!("*EXPANSION{expansion}"),
        &format!(", ORIENTATION=O\n{}", orientation.trim_end()),
    );
    assert!(
        turned.contains("axes = [[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]]"),
        "{turned}"
    );
    let zero = toml("*EXPANSION, ZERO=25.\n1.E-5, 0.\n2.E-5, 100.\n", "");
    assert!(zero.contains("zero = 25"), "{zero}");
}

#[test]
fn what_heat_there_is_not_is_said_at_its_line() {
    let text = |card: &str, step: &str| {
        column().replace("*EXPANSION\n1.E-5\n", card) + "*STEP\n*STATIC\n" + step + "*END STEP\n"
    };
    let says = |card: &str, step: &str, wanted: &str| {
        let message = refused(&text(card, step));
        assert!(message.contains(wanted), "{message}");
    };
    let iso = "*EXPANSION\n1.E-5\n";
    says(
        "*EXPANSION, TYPE=ANISO\n1., 2., 3., 4., 5., 6.\n",
        "",
        "*EXPANSION of type ANISO is not supported",
    );
    says(
        iso,
        "*TEMPERATURE, FILE=heat.frd\n",
        "write the temperature of each node on data lines",
    );
    says(
        iso,
        "*TEMPERATURE\nNOWHERE, 5.\n",
        "there is no set of nodes NOWHERE",
    );
    says(iso, "*TEMPERATURE, AMPLITUDE=NONE\nN, 5.\n", "NONE");
    says(iso, "*CFLUX\n1, 11, 5.\n", "heat does not flow");
    says(
        iso,
        "*BOUNDARY\nN, 11, 11, 5.\n",
        "give them by *TEMPERATURE",
    );
    let step = "*STEP\n*HEAT TRANSFER\n*END STEP\n";
    let message = refused(&(column() + step));
    assert!(message.contains("heat does not flow"), "{message}");
}

//! Every element type under uniform stress: order of the nodes, numbers of the faces, material and space.

use crate::support::{near, run};

/// A node of the lattice with three nodes along each edge of the unit cube.
fn node(x: [f64; 3]) -> u64 {
    let [i, j, k] = x.map(|c| (2.0 * c).round() as u64);
    1 + i + 3 * j + 9 * k
}

fn coordinates(node: u64) -> [f64; 3] {
    let n = node - 1;
    [n % 3, n / 3 % 3, n / 9].map(|c| 0.5 * c as f64)
}

/// Corners of the cube in the order of C3D8.
const CUBE: [[f64; 3]; 8] = [
    [0.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [1.0, 1.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 0.0, 1.0],
    [1.0, 0.0, 1.0],
    [1.0, 1.0, 1.0],
    [0.0, 1.0, 1.0],
];

/// Corner pairs whose middles follow the corners.
type Edges = &'static [(usize, usize)];
const HEX: Edges = &[
    (1, 2),
    (2, 3),
    (3, 4),
    (4, 1),
    (5, 6),
    (6, 7),
    (7, 8),
    (8, 5),
    (1, 5),
    (2, 6),
    (3, 7),
    (4, 8),
];
const TET: Edges = &[(1, 2), (2, 3), (3, 1), (1, 4), (2, 4), (3, 4)];
const WEDGE: Edges = &[
    (1, 2),
    (2, 3),
    (3, 1),
    (4, 5),
    (5, 6),
    (6, 4),
    (1, 4),
    (2, 5),
    (3, 6),
];
const QUAD: Edges = &[(1, 2), (2, 3), (3, 4), (4, 1)];
const TRI: Edges = &[(1, 2), (2, 3), (3, 1)];

/// Corners of the faces as both manuals number them.
type Faces = &'static [&'static [usize]];
const HEX_FACES: Faces = &[
    &[1, 2, 3, 4],
    &[5, 8, 7, 6],
    &[1, 5, 6, 2],
    &[2, 6, 7, 3],
    &[3, 7, 8, 4],
    &[4, 8, 5, 1],
];
const TET_FACES: Faces = &[&[1, 2, 3], &[1, 4, 2], &[2, 4, 3], &[3, 4, 1]];
const WEDGE_FACES: Faces = &[
    &[1, 2, 3],
    &[4, 5, 6],
    &[1, 2, 5, 4],
    &[2, 3, 6, 5],
    &[3, 1, 4, 6],
];
const QUAD_FACES: Faces = &[&[1, 2], &[2, 3], &[3, 4], &[4, 1]];
const TRI_FACES: Faces = &[&[1, 2], &[2, 3], &[3, 1]];

/// Cells of the cube or square by corners of the cube, edges and faces.
fn cells(kind: &str) -> (Vec<Vec<usize>>, Edges, Faces) {
    let digits: String = kind[3..].chars().take_while(char::is_ascii_digit).collect();
    match (&kind[..3], digits.as_str()) {
        ("C3D", "8" | "20") => (vec![(1..=8).collect()], HEX, HEX_FACES),
        ("C3D", "6" | "15") => (
            vec![vec![1, 2, 3, 5, 6, 7], vec![1, 3, 4, 5, 7, 8]],
            WEDGE,
            WEDGE_FACES,
        ),
        // Around the diagonal from 1 to 7.
        ("C3D", _) => (
            [[2, 3], [3, 4], [4, 8], [8, 5], [5, 6], [6, 2]]
                .map(|[a, b]| vec![1, a, b, 7])
                .to_vec(),
            TET,
            TET_FACES,
        ),
        (_, "4" | "8") => (vec![vec![1, 2, 3, 4]], QUAD, QUAD_FACES),
        _ => (vec![vec![1, 2, 3], vec![1, 3, 4]], TRI, TRI_FACES),
    }
}

/// A cube (square, disc) pulled by a stress of 10 at its end by `load`, with Young's modulus 1000 and Poisson's ratio 0.25.
fn deck(kind: &str, load: &str) -> String {
    let (cells, edges, faces) = cells(kind);
    let solid = kind.starts_with("C3D");
    let count = kind[3..]
        .chars()
        .take_while(char::is_ascii_digit)
        .collect::<String>();
    let count: usize = count.parse().expect("a number of nodes");
    // The end that is pulled: z = 1, y = 1 in the plane.
    let axis = if solid { 2 } else { 1 };
    let (mut elements, mut ends, mut used) = (String::new(), Vec::new(), Vec::new());
    for (i, cell) in cells.iter().enumerate() {
        let mut nodes: Vec<u64> = cell.iter().map(|c| node(CUBE[c - 1])).collect();
        if count > nodes.len() {
            let middles = edges.iter().map(|(a, b)| {
                let (a, b) = (coordinates(nodes[a - 1]), coordinates(nodes[b - 1]));
                node(std::array::from_fn(|k| 0.5 * (a[k] + b[k])))
            });
            let middles: Vec<u64> = middles.collect();
            nodes.extend(middles);
        }
        assert_eq!(nodes.len(), count, "{kind}");
        let end = |face: &&[usize]| face.iter().all(|c| coordinates(nodes[c - 1])[axis] == 1.0);
        if let Some(face) = faces.iter().position(end) {
            ends.push((i + 1, face + 1));
        }
        let list: Vec<String> = nodes.iter().map(u64::to_string).collect();
        // Fifteen numbers a line.
        let lines: Vec<String> = list.chunks(10).map(|c| c.join(", ")).collect();
        elements += &format!("{}, {}\n", i + 1, lines.join(",\n"));
        used.extend(nodes);
    }
    used.sort_unstable();
    used.dedup();
    let nodes: Vec<String> = used
        .iter()
        .map(|&n| {
            let [x, y, z] = coordinates(n);
            format!("{n}, {x}, {y}, {z}\n")
        })
        .collect();
    let mut sets = String::new();
    for (name, k) in [("X0", 0), ("Y0", 1), ("Z0", 2)] {
        let on: Vec<String> = used
            .iter()
            .filter(|n| coordinates(**n)[k] == 0.0)
            .map(|n| format!("{n},\n"))
            .collect();
        sets += &format!("*NSET, NSET={name}\n{}", on.concat());
    }
    let supports = if solid {
        "X0,1\nY0,2\nZ0,3\n"
    } else {
        "X0,1\nY0,2\n"
    };
    let surface: String = ends.iter().map(|(e, f)| format!("{e}, S{f}\n")).collect();
    let load = match load {
        "DLOAD" => {
            let lines = ends.iter().map(|(e, f)| format!("{e}, P{f}, -10.\n"));
            format!("*DLOAD\n{}", lines.collect::<String>())
        }
        _ => "*DSLOAD\nEND, P, -10.\n".into(),
    };
    format!(
        "*NODE\n{}*ELEMENT, TYPE={kind}, ELSET=E\n{elements}{sets}*SURFACE, NAME=END\n{surface}*MATERIAL, NAME=M\n*ELASTIC\n1000., .25\n\
         *SOLID SECTION, ELSET=E, MATERIAL=M\n*BOUNDARY\n{supports}*STEP\n*STATIC\n{load}*NODE PRINT, NSET=X0\nU\n*EL PRINT, ELSET=E\nS, E\n*EL PRINT, ELSET=E, TOTALS=ONLY\nELSE, EVOL\n*END STEP\n",
        nodes.concat()
    )
}

#[test]
fn every_element_type_carries_uniform_stress() {
    for kind in [
        "C3D4", "C3D6", "C3D8", "C3D8R", "C3D8I", "C3D10", "C3D15", "C3D20", "C3D20R", "CPS3",
        "CPS4", "CPS4R", "CPS6", "CPS8", "CPS8R", "CPE3", "CPE4", "CPE4R", "CPE6", "CPE8", "CPE8R",
        "CAX3", "CAX4", "CAX4R", "CAX6", "CAX8", "CAX8R",
    ] {
        let load = if kind.len() % 2 == 0 {
            "DLOAD"
        } else {
            "DSLOAD"
        };
        let run = run(&format!("uniform-{kind}"), &deck(kind, load));
        let solid = kind.starts_with("C3D");
        // Plane strain: E / (1 - nu²), nu / (1 - nu).
        let (modulus, ratio) = match &kind[..3] {
            "CPE" => (1000.0 / (1.0 - 0.0625), 0.25 / 0.75),
            _ => (1000.0, 0.25),
        };
        let (far, axis) = match solid {
            true => (node([1.0, 1.0, 1.0]), 2),
            false => (node([1.0, 1.0, 0.0]), 1),
        };
        let u = run.u(far);
        near(u[axis], 10.0 / modulus, 1e-9);
        near(u[0], -ratio * 10.0 / modulus, 1e-9);
        let stresses = run.all("stresses");
        for row in &stresses[0].2 {
            near(row[2 + axis], 10.0, 1e-6);
            assert!(row[2].abs() < 1e-5 || axis == 0, "{kind}: {row:?}");
        }
        for row in &run.all("strains")[0].2 {
            near(row[2 + axis], 10.0 / modulus, 1e-6);
        }
        let volume = match &kind[..3] {
            "CAX" => std::f64::consts::PI,
            _ => 1.0,
        };
        near(run.last("total volume")[0], volume, 1e-6);
        let energy = 0.5 * 100.0 / modulus * volume;
        near(run.last("total internal energy")[0], energy, 1e-6);
    }
}

//! Surface-to-surface contact between meshes that do not match: uniform states come out uniform, whatever the cells.

use crate::support;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::Path;
use stickslip::contact::look;

use stickslip::problem::Document;
use stickslip::run::Simulation;

/// A cell kind by its number in Gmsh's format, and its nodes as corners of a hexahedron; middle nodes follow by edge.
struct Kind {
    name: &'static str,
    code: usize,
    cells: &'static [&'static [usize]],
    edges: &'static [[usize; 2]],
}

const HEXAHEDRON: &[&[usize]] = &[&[0, 1, 2, 3, 4, 5, 6, 7]];
const TETRAHEDRA: &[&[usize]] = &[
    &[0, 1, 2, 6],
    &[0, 2, 3, 6],
    &[0, 3, 7, 6],
    &[0, 7, 4, 6],
    &[0, 4, 5, 6],
    &[0, 5, 1, 6],
];

/// On triangles, and on their sides, with triangles at the front and the back.
const STANDING: &[&[usize]] = &[&[0, 1, 2, 4, 5, 6], &[0, 2, 3, 4, 6, 7]];
const LYING: &[&[usize]] = &[&[0, 5, 1, 3, 6, 2], &[0, 4, 5, 3, 7, 6]];

const KINDS: [Kind; 6] = [
    Kind {
        name: "hex8",
        code: 5,
        cells: HEXAHEDRON,
        edges: &[],
    },
    Kind {
        name: "tet4",
        code: 4,
        cells: TETRAHEDRA,
        edges: &[],
    },
    Kind {
        name: "hex20",
        code: 17,
        cells: HEXAHEDRON,
        edges: &[
            [0, 1],
            [0, 3],
            [0, 4],
            [1, 2],
            [1, 5],
            [2, 3],
            [2, 6],
            [3, 7],
            [4, 5],
            [4, 7],
            [5, 6],
            [6, 7],
        ],
    },
    Kind {
        name: "tet10",
        code: 11,
        cells: TETRAHEDRA,
        edges: &[[0, 1], [1, 2], [0, 2], [0, 3], [2, 3], [1, 3]],
    },
    Kind {
        name: "wedge6",
        code: 6,
        cells: STANDING,
        edges: &[],
    },
    Kind {
        name: "wedge15",
        code: 18,
        cells: LYING,
        edges: &[
            [0, 1],
            [0, 2],
            [0, 3],
            [1, 2],
            [1, 4],
            [2, 5],
            [3, 4],
            [3, 5],
            [4, 5],
        ],
    },
];

/// A unit square column of one layer between two heights, its cells skewed at the height of `skewed`.
fn mesh(kind: &Kind, cells: [usize; 2], heights: [f64; 2], skewed: f64) -> String {
    let [nx, ny] = cells;
    let corner = |i: usize, j: usize, z: f64| {
        let (mut x, mut y) = (i as f64 / nx as f64, j as f64 / ny as f64);
        if i > 0 && i < nx && j > 0 && j < ny && z == skewed {
            // as good as random
            let noise = |a: f64| (a * (1.3 + i as f64 + 2.7 * j as f64)).sin();
            x += 0.2 * noise(12.9) / nx as f64;
            y += 0.2 * noise(78.2) / ny as f64;
        }
        [x, y, z]
    };
    let mut points: Vec<[f64; 3]> = Vec::new();
    let mut known: BTreeMap<[i64; 3], usize> = BTreeMap::new();
    let mut number = |p: [f64; 3]| {
        let key = p.map(|x| (x * 1e9).round() as i64);
        *known.entry(key).or_insert_with(|| {
            points.push(p);
            points.len()
        })
    };
    let mut lines = String::new();
    let mut count = 0;
    for i in 0..nx {
        for j in 0..ny {
            let ring = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)];
            let around: Vec<[f64; 3]> = (heights.iter())
                .flat_map(|&z| ring.map(|(i, j)| corner(i, j, z)))
                .collect();
            for cell in kind.cells {
                let at = |k: usize| around[cell[k]];
                let mut nodes: Vec<usize> = (0..cell.len()).map(|k| number(at(k))).collect();
                for &[a, b] in kind.edges {
                    nodes.push(number([0, 1, 2].map(|c| 0.5 * (at(a)[c] + at(b)[c]))));
                }
                count += 1;
                let nodes: Vec<String> = nodes.iter().map(usize::to_string).collect();
                writeln!(lines, "{count} {} 2 1 1 {}", kind.code, nodes.join(" ")).unwrap();
            }
        }
    }
    let mut text = format!(
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n3 1 \"all\"\n$EndPhysicalNames\n$Nodes\n{}\n",
        points.len()
    );
    for (k, p) in points.iter().enumerate() {
        writeln!(text, "{} {:?} {:?} {:?}", k + 1, p[0], p[1], p[2]).unwrap();
    }
    write!(text, "$EndNodes\n$Elements\n{count}\n{lines}$EndElements\n").unwrap();
    text
}

/// Two blocks one on the other, the lower one held.
fn blocks(poisson: f64, rest: &str) -> String {
    let mut text = format!(
        "format = 1\nmodel.space = \"solid\"\nmaterial.m.isotropic = {{ young = 10.0, poisson = {poisson:?} }}\n"
    );
    for (body, low, high) in [("low", 0.0, 0.5), ("up", 0.5, 1.0)] {
        writeln!(
            text,
            "body.{body} = {{ gmsh = {{ file = \"{body}.msh\" }}, material = \"m\" }}"
        )
        .unwrap();
        let faces = [
            ("bottom", [0.0, 0.0, low], [1.0, 1.0, low]),
            ("top", [0.0, 0.0, high], [1.0, 1.0, high]),
            ("left", [0.0, 0.0, low], [0.0, 1.0, high]),
            ("right", [1.0, 0.0, low], [1.0, 1.0, high]),
            ("front", [0.0, 0.0, low], [1.0, 0.0, high]),
        ];
        for (name, from, to) in faces {
            writeln!(
                text,
                "set.{body}-{name} = {{ of = \"{body}.all\", box = {{ from = {from:?}, to = {to:?} }} }}"
            )
            .unwrap();
        }
    }
    text + "load.top = { set = \"up-top\", pressure = { value = 1.0 } }\n\
        step = [{ increments = { fixed = 1 } }]\nsolver.tolerance = 1e-13\n"
        + rest
}

/// Largest deviations of pressure and shear from `pressure` and `shear` over the interface; `None` where shear is not looked at.
fn deviation(folder: &Path, text: &str, pressure: f64, shear: Option<f64>) -> f64 {
    let path = folder.join("case.toml");
    std::fs::write(&path, text).expect("a file");
    let document = Document::read(&path).unwrap_or_else(|e| panic!("{e}"));
    let problem = document.problem().unwrap_or_else(|e| panic!("{e}"));
    let model = problem.build(folder).unwrap_or_else(|e| panic!("{e}"));
    let mut simulation = Simulation::new(model).unwrap_or_else(|e| panic!("{e}"));
    simulation.run(&mut []).unwrap_or_else(|e| panic!("{e}"));
    let mut worst: f64 = 0.0;
    for interface in simulation.view().contacts() {
        let (names, columns) = look::table(interface, &simulation.frame.state.u);
        let column = |name: &str| &columns[names.iter().position(|n| n == name).unwrap()];
        assert!(!column("CPRESS").is_empty());
        for (p, s) in column("CPRESS").iter().zip(column("CSHEAR1")) {
            let off = shear.map_or(0.0, |shear| (s.abs() - shear).abs());
            worst = worst.max((p - pressure).abs()).max(off);
        }
    }
    worst
}

/// Runs `text` for every pair of cell kinds, the meshes 2 × 3 against 3 × 2 and 3 × 3 against 4 × 5. Wedges, whose faces are those of the
/// others, meet hexahedra and each other in the smaller ones.
fn every_pair(name: &str, text: &str, pressure: f64, shear: Option<f64>) {
    // Multipliers that supports share with the interface leave their rounding in the others.
    let most = if shear.is_some() { 1e-10 } else { 1e-9 };
    for (cells, others) in [([2, 3], [3, 2]), ([3, 3], [4, 5])] {
        for low in &KINDS {
            for up in &KINDS {
                let wedge = |kind: &Kind| kind.name.starts_with("wedge");
                let plain = |kind: &Kind| wedge(kind) || kind.name == "hex8";
                let small = plain(low) && plain(up) && cells == [2, 3];
                if (wedge(low) || wedge(up)) && !small {
                    continue;
                }
                let folder = support::folder(&format!("mortar-{name}-{}-{}", low.name, up.name));
                let below = mesh(low, cells, [0.0, 0.5], 0.5);
                let above = mesh(up, others, [0.5, 1.0], 0.5);
                std::fs::write(folder.join("low.msh"), below).expect("a file");
                std::fs::write(folder.join("up.msh"), above).expect("a file");
                let worst = deviation(&folder, text, pressure, shear);
                assert!(
                    worst <= most,
                    "{name}, {} under {}, {cells:?} under {others:?}: {worst:e}",
                    low.name,
                    up.name
                );
            }
        }
    }
}

const PRESSED: &str = r#"
support.base = { set = "low-bottom", z = 0 }
support.low-left = { set = "low-left", x = 0 }
support.up-left = { set = "up-left", x = 0 }
support.low-front = { set = "low-front", y = 0 }
support.up-front = { set = "up-front", y = 0 }
"#;

/// A pressure of one passes from body to body as it is, in a body that spreads as well.
#[test]
fn a_uniform_pressure_stays_uniform() {
    let text = blocks(
        0.3,
        &format!(
            "{PRESSED}
[interface.joint]
secondary = \"up-bottom\"
primary = \"low-top\"
kinematics.small-sliding = {{}}
enforcement.augmented-lagrangian = {{ error = 1e-13, factor = 1.0 }}
"
        ),
    );
    every_pair("pressure", &text, 1.0, Some(0.0));
}

/// Glued surfaces carry the same state, in compression and in tension. Where supports hold both sides already, the shear between them is anybody's.
/// Where edges of both sides of a tie coincide, pieces between their faces come and go by strains of rounding size: rows that followed them jumped by more than the
/// tolerance, which a level face of quadratic cells shows.
#[test]
fn ties_converge_where_edges_of_both_sides_coincide() {
    let text = r#"
format = 1
model.space = "solid"
support.base = { set = "lower.bottom", x = 0, y = 0, z = 0 }
set.corner = { of = "upper", point = [-0.0432, -0.036, 0.083664] }
coupling.level.equation.terms = [
    { set = "upper.top", component = "z" },
    { set = "corner", component = "z", factor = -1 },
]
load.press = { set = "cap.top", pressure.value = 1.2608e8 }

[body.lower]
generate.box = { from = [-0.072, -0.036, -0.050688], to = [0.072, 0.036, 0], cells = [3, 2, 2], element = "tet4" }
material = "soft"
[body.upper]
generate.box = { from = [-0.0432, -0.036, 0], to = [0.0432, 0.036, 0.083664], cells = [1, 1, 1], element = "hex20" }
material = "stiff"
[body.cap]
generate.box = { from = [-0.0432, -0.036, 0.083664], to = [0.0432, 0.036, 0.112464], cells = [1, 1, 1], element = "hex8" }
material = "soft"
[material.soft]
isotropic = { young = 1.97e11, poisson = 0.34 }
[material.stiff]
isotropic = { young = 3.2899e11, poisson = 0.109 }

[interface]
joint = { secondary = "upper.bottom", primary = "lower.top", tied = true }
cap = { secondary = "cap.bottom", primary = "upper.top", tied = true }

[[step]]
increments = { initial = 0.5, largest = 0.5 }
"#;
    let record = support::run(&support::problem(text)).expect("an equilibrium");
    assert_eq!(record.cutbacks, 0);
}

#[test]
fn tied_surfaces_pass_uniform_states() {
    let tied = format!(
        "{PRESSED}
[interface.joint]
secondary = \"up-bottom\"
primary = \"low-top\"
tied = true
kinematics.small-sliding = {{}}
enforcement.augmented-lagrangian = {{ error = 1e-13, factor = 1.0 }}
"
    );
    every_pair("tied", &blocks(0.3, &tied), 1.0, None);
    let pulled = blocks(0.3, &tied).replace("value = 1.0", "value = -1.0");
    every_pair("pulled", &pulled, -1.0, None);
}

/// Uniform shear below the limit sticks, and is carried uniformly.
#[test]
fn uniform_shear_sticks() {
    let text = blocks(
        0.0,
        r#"
support.base = { set = "low-bottom", x = 0, y = 0, z = 0 }
load.push = { set = "up-top", traction = { value = [0.2, 0.0, 0.0] } }
load.low-left = { set = "low-left", traction = { value = [0.0, 0.0, -0.2] } }
load.low-right = { set = "low-right", traction = { value = [0.0, 0.0, 0.2] } }
load.up-left = { set = "up-left", traction = { value = [0.0, 0.0, -0.2] } }
load.up-right = { set = "up-right", traction = { value = [0.0, 0.0, 0.2] } }

[interface.joint]
secondary = "up-bottom"
primary = "low-top"
friction.coulomb = { mu = 0.5 }
kinematics.small-sliding = {}
enforcement.augmented-lagrangian = { error = 1e-13, factor = 1.0 }
"#,
    );
    every_pair("stick", &text, 1.0, Some(0.2));
}

/// Uniform slip: the limit everywhere.
#[test]
fn uniform_slip_is_carried_at_the_limit() {
    let text = blocks(
        0.0,
        r#"
support.base = { set = "low-bottom", x = 0, y = 0, z = 0 }
support.push = { set = "up-top", x = 1.0, y = 0 }
load.low-left = { set = "low-left", traction = { value = [0.0, 0.0, -0.3] } }
load.low-right = { set = "low-right", traction = { value = [0.0, 0.0, 0.3] } }
load.up-left = { set = "up-left", traction = { value = [0.0, 0.0, -0.3] } }
load.up-right = { set = "up-right", traction = { value = [0.0, 0.0, 0.3] } }

[interface.joint]
secondary = "up-bottom"
primary = "low-top"
friction.coulomb = { mu = 0.3 }
kinematics.small-sliding = {}
enforcement.augmented-lagrangian = { error = 1e-13, factor = 1.0 }
"#,
    );
    every_pair("slip", &text, 1.0, Some(0.3));
}

/// The tangent leaves out that normals jump where facets meet, of the size of pressure over modulus: with a thousandth each step gains a digit and a half
/// or more.
#[test]
fn iterations_gain_what_pressure_over_modulus_says() {
    for mu in ["0.0", "0.3"] {
        let text = format!(
            r#"
format = 1
model.space = "plane-strain"
body.lower = {{ generate.rectangle = {{ to = [3, 1], cells = [17, 5] }}, material = "m" }}
body.upper = {{ generate.half-disc = {{ centre = [1.5, 2], radius = 1, size = 0.2 }}, material = "m" }}
material.m.isotropic = {{ young = 1000.0, poisson = 0.3 }}
interface.joint = {{ secondary = "lower.top", primary = "upper.arc", friction.coulomb.mu = {mu} }}
support.base = {{ set = "lower.bottom", x = 0, y = 0 }}
support.press = {{ set = "upper.flat", y = -2e-4, x = 0 }}
support.drag = {{ set = "upper.flat", x = 0.3, amplitude = "drag" }}
amplitude.drag.table = [[0, 0], [1, 0], [2, 1]]
step = [{{ increments.fixed = 2 }}, {{ increments.fixed = 8 }}]
solver.linear.tolerance = 1e-12
"#
        )
        .replace("y = -2e-4, x = 0", "y = -2e-4");
        let record = support::run(&support::problem(&text)).unwrap_or_else(|e| panic!("{e}"));
        let mut judged = 0;
        for (iterations, _) in &record.increments {
            for pair in iterations.windows(2) {
                let settled = pair.iter().all(|p| p.tally.changed == 0 && p.step == 1.0);
                if settled
                    && pair[0].residual < 0.1
                    && pair[1].residual > 1e-10
                    && pair[1].round == pair[0].round
                {
                    judged += 1;
                    let gain = pair[1].residual / pair[0].residual;
                    assert!(gain < 0.05, "mu {mu}: {gain:e} at {:e}", pair[0].residual);
                }
            }
        }
        assert!(judged > 0, "nothing judged");
    }
}

/// A quarter of a ball of radius 10 pressed by 1000 on an obstacle whose surface has this curvature, positive if hollow: the worst deviation from Hertz's
/// pressure within 0.8 of his radius of contact, relative to its peak, and the force in the quarter.
fn ball_on_obstacle(element: &str, obstacle: &str, curvature: f64) -> (f64, f64) {
    let text = format!(
        r#"format = 1
model.space = "solid"
body.ball = {{ generate.half-ball = {{ radius = 10, sector = "quarter", size = 4, element = "{element}", refine = {{ finest = 0.1, width = 0.45, growth = 1.8 }} }}, material = "m" }}
material.m.isotropic = {{ young = 1e5, poisson = 0.3 }}
obstacle.floor.{obstacle}
interface.contact = {{ secondary = "ball.arc", primary = "floor" }}
support.sx = {{ set = "ball.symmetry-x", x = 0 }}
support.sy = {{ set = "ball.symmetry-y", y = 0 }}
load.f = {{ set = "ball.flat", pressure.value = 3.183098861837907 }}
step = [{{ increments = {{ fixed = 2 }} }}]
"#
    );
    let problem = support::problem(&text);
    let mut simulation = support::build(&problem).unwrap_or_else(|e| panic!("{e}"));
    simulation.run(&mut []).unwrap_or_else(|e| panic!("{e}"));
    // E* = E / (1 - ν²) on what is rigid, 1/R = 1/10 - curvature; a³ = 3 F R / 4 E*, p₀ = 3 F / 2 π a².
    let (force, radius) = (1000.0, 1.0 / (0.1 - curvature));
    let a = f64::cbrt(0.75 * force * radius / (1e5 / (1.0 - 0.09)));
    let peak = 1.5 * force / (std::f64::consts::PI * a * a);
    let interface = support::contact(&simulation);
    let (names, columns) = look::table(interface, &simulation.frame.state.u);
    let column = |name: &str| &columns[names.iter().position(|n| n == name).unwrap()];
    let mut worst: f64 = 0.0;
    let mut points = 0;
    for ((x, y), p) in column("x").iter().zip(column("y")).zip(column("CPRESS")) {
        let r = x.hypot(*y) / a;
        if r < 0.8 {
            points += 1;
            worst = worst.max((p - peak * (1.0 - r * r).sqrt()).abs() / peak);
        }
    }
    assert!(points > 20, "{element}: {points}");
    assert!(simulation.summary.quality.met);
    (
        worst,
        look::resultant(interface, &simulation.frame.state.u).total,
    )
}

/// Quadratic faces carry pressure on obstacles as they do on bodies: not at points within faces, whose pressures are noise.
#[test]
fn quadratic_faces_on_obstacles_have_the_pressure_of_hertz() {
    let plane = "plane = { point = [0, 0, -10], normal = [0, 0, 1] }";
    let wear_gap = "sphere = { centre = [0, 0, 15], radius = 25, inside = true }";
    for (element, obstacle, curvature) in [("hex20", plane, 0.0), ("tet10", wear_gap, 0.04)] {
        let (worst, force) = ball_on_obstacle(element, obstacle, curvature);
        assert!(worst < 0.05, "{element} on {obstacle}: {worst}");
        assert!((force / 250.0 - 1.0).abs() < 1e-3, "{element}: {force}");
    }
}

/// Points on the axis of a ring have no area of their own where faces are quadratic: what they carry must be no more than what their neighbours do.
#[test]
fn quadratic_faces_that_meet_the_axis_have_the_pressure_of_hertz() {
    let floor = "obstacle.floor.plane = { point = [0, -10], normal = [0, 1] }";
    let slab = r#"body.slab = { generate.rectangle = { from = [0, -10.6], to = [1.2, -10], cells = [30, 8], element = "ELEMENT" }, material = "hard" }
material.hard.isotropic = { young = 1e9, poisson = 0.3 }
support.below = { set = "slab", x = 0, y = 0 }"#;
    let on_floor = r#"primary = "floor""#;
    let on_slab = r#"primary = "slab.top", discretisation.node-to-facet = {}"#;
    let cases = [("quad8", floor, on_floor), ("tri6", floor, on_floor)];
    for (element, below, primary) in cases.into_iter().chain([("quad8", slab, on_slab)]) {
        let below = below.replace("ELEMENT", element);
        let text = format!(
            r#"format = 1
model.space = "axisymmetric"
body.ball = {{ generate.half-disc = {{ radius = 10, symmetric = true, size = 4, element = "{element}", refine = {{ finest = 0.05, width = 0.5, growth = 1.6 }} }}, material = "m" }}
material.m.isotropic = {{ young = 1e5, poisson = 0.3 }}
{below}
interface.contact = {{ secondary = "ball.arc", {primary} }}
support.axis = {{ set = "ball.axis", x = 0 }}
load.f = {{ set = "ball.flat", pressure.value = 3.183098861837907 }}
step = [{{ increments = {{ fixed = 2 }} }}]
"#
        );
        let problem = support::problem(&text);
        let mut simulation = support::build(&problem).unwrap_or_else(|e| panic!("{e}"));
        simulation.run(&mut []).unwrap_or_else(|e| panic!("{e}"));
        // E* = E / (1 - ν²) on what is as good as rigid; a³ = 3 F R / 4 E*, p₀ = 3 F / 2 π a².
        let a = f64::cbrt(0.75 * 1000.0 * 10.0 / (1e5 / (1.0 - 0.09)));
        let peak = 1500.0 / (std::f64::consts::PI * a * a);
        let interface = support::contact(&simulation);
        let (names, columns) = look::table(interface, &simulation.frame.state.u);
        let column = |name: &str| &columns[names.iter().position(|n| n == name).unwrap()];
        let mut points = 0;
        for (x, p) in column("x").iter().zip(column("CPRESS")) {
            let r = x / a;
            if r < 0.8 {
                points += 1;
                let off = (p - peak * (1.0 - r * r).sqrt()) / peak;
                assert!(off.abs() < 0.05, "{element}, {primary}, r = {r} a: {off}");
            }
        }
        assert!(points >= 10, "{element}: {points}");
        let force = look::resultant(interface, &simulation.frame.state.u).total;
        assert!((force / 1000.0 - 1.0).abs() < 1e-3, "{element}: {force}");
    }
}

/// Where both surfaces are secondary a node shows the slip of its own surface, not the opposite one of the other half.
#[test]
fn fields_of_two_sided_contact_are_those_of_the_own_surface() {
    let text = r#"format = 1
model.space = "plane-strain"
body.lower = { generate.rectangle = { from = [-2, -1], to = [2, 0], cells = [8, 2] }, material = "m" }
body.upper = { generate.rectangle = { from = [-1, 0], to = [1, 1], cells = [5, 2] }, material = "m" }
material.m.isotropic = { young = 1e3, poisson = 0.3 }
interface.joint = { secondary = "upper.bottom", primary = "lower.top", enforcement.penalty = {}, discretisation.mortar = { two-sided = true } }
support.base = { set = "lower.bottom", x = 0, y = 0 }
support.top = { set = "upper.top", x = 0.01, y = -0.01 }
step = [{ increments.fixed = 1 }]
"#;
    let problem = support::problem(text);
    let mut simulation = support::build(&problem).unwrap_or_else(|e| panic!("{e}"));
    simulation.run(&mut []).unwrap_or_else(|e| panic!("{e}"));
    let mut fields = stickslip::system::Fields::default();
    for interface in simulation.view().contacts() {
        look::fields(interface, &mut fields);
    }
    let points = &simulation.model.mesh.points;
    for (interface, sign) in simulation.view().contacts().zip([1.0, -1.0]) {
        let (names, columns) = look::table(interface, &simulation.frame.state.u);
        let column = |name: &str| &columns[names.iter().position(|n| n == name).unwrap()];
        let set = if sign > 0.0 {
            "upper.bottom"
        } else {
            "lower.top"
        };
        let mut judged = 0;
        for (row, status) in column("CSTATUS").iter().enumerate() {
            let node = interface.nodes[interface.points[row].nodes[0]];
            assert_eq!(points[node][0], column("x")[row]);
            for name in ["CSLIP1", "CPRESS", "COPEN"] {
                let shown = fields.all.iter().find(|f| f.name == name).unwrap().values[node];
                let own = column(name)[row];
                let lonely = !column("COPEN")[row].is_finite();
                let same = lonely || (shown - own).abs() <= 1e-12 * own.abs();
                assert!(same, "{set}, {name} of node {node}: {shown}, not {own}");
            }
            if *status > 0.0 {
                judged += 1;
                assert!(sign * column("CSLIP1")[row] > 5e-3, "{set}, node {node}");
            }
        }
        assert!(judged >= 5, "{set}: {judged}");
    }
}

/// Resultant and moment of the contact forces of both sides, relative to force and size. Two blocks whose surfaces tilt and bend under pressure and shear, on a law
/// so soft that they overlap by a twentieth of a cell.
fn sums_over_both_sides(dim: usize, element: &str, interface: &str) -> [f64; 2] {
    let (space, shape, fixed, moved) = match dim {
        2 => (
            "plane-strain",
            "rectangle",
            "x = 0, y = 0",
            "x = 0.03, y = -0.02",
        ),
        _ => (
            "solid",
            "box",
            "x = 0, y = 0, z = 0",
            "x = 0.03, y = 0.01, z = -0.02",
        ),
    };
    let block = |from: [f64; 3], to: [f64; 3], cells: [usize; 3]| {
        let skip = 3 - dim;
        let (from, to, cells) = (&from[skip..], &to[skip..], &cells[skip..]);
        format!(
            "generate.{shape} = {{ from = {from:?}, to = {to:?}, cells = {cells:?}, element = \"{element}\" }}"
        )
    };
    let text = format!(
        r#"
format = 1
model.space = "{space}"
body.lower = {{ {}, material = "m" }}
body.upper = {{ {}, material = "m" }}
material.m.isotropic = {{ young = 1000.0, poisson = 0.3 }}
interface.joint = {{ secondary = "upper.bottom", primary = "lower.top", friction.coulomb.mu = 0.3, normal.linear.c = 800.0, {interface} }}
support.base = {{ set = "lower.bottom", {fixed} }}
support.press = {{ set = "upper.top", {moved} }}
step = [{{ increments.fixed = 2 }}]
quality.gate = "off"
"#,
        block([-0.8, -1.0, -1.0], [1.1, 1.3, 0.0], [3, 4, 2]),
        block([-0.5, -0.5, 0.0], [0.5, 0.6, 0.7], [2, 3, 2]),
    );
    let mut simulation = support::build(&support::problem(&text)).unwrap_or_else(|e| panic!("{e}"));
    let what = format!("{element}, {interface}");
    (simulation.run(&mut [])).unwrap_or_else(|e| panic!("{what}: {e}"));
    let interface = support::contact(&simulation);
    let u = &simulation.frame.state.u;
    let shear = stickslip::math::norm(look::resultant(interface, u).shear);
    let b = look::balance(interface, u);
    assert!(shear > 0.05 * b.scale, "{what}: {shear} of {}", b.scale);
    let [force, moment] = [b.force, b.moment].map(stickslip::math::norm);
    [force / b.scale, moment / (b.scale * b.size)]
}

#[test]
fn shear_acts_on_both_sides_at_one_place_however_deep_they_overlap() {
    for (dim, element) in [
        (2, "quad4"),
        (2, "quad8"),
        (2, "tri3"),
        (3, "hex8"),
        (3, "hex20"),
    ] {
        for interface in [
            "discretisation.mortar = {}",
            "discretisation.node-to-facet = {}",
        ] {
            let sums = sums_over_both_sides(dim, element, interface);
            assert!(
                sums.iter().all(|sum| *sum < 1e-10),
                "{element}, {interface}: {sums:?}"
            );
        }
    }
}

/// Between meshes that match a node has one opposite; on a plane of symmetry the moment about axes within it is the mirror image's.
#[test]
fn planes_of_symmetry_leave_what_the_whole_has() {
    let block = |half: bool, z: [f64; 2], cells: usize| {
        let x = if half { 0.0 } else { -1.0 };
        let across = if half { cells } else { 2 * cells };
        format!(
            "generate.box = {{ from = [{x:?}, 0, {:?}], to = [1, 1, {:?}], cells = [{across}, 2, 1] }}",
            z[0], z[1]
        )
    };
    let forces = |half: bool, cells: usize| {
        let mirror = match half {
            true => {
                "support.mirror = { set = \"lower.left\", x = 0 }\nsupport.image = { set = \"upper.left\", x = 0 }\n"
            }
            false => "",
        };
        let text = format!(
            r#"
format = 1
model.space = "solid"
body.lower = {{ {}, material = "m" }}
body.upper = {{ {}, material = "m" }}
material.m.isotropic = {{ young = 1000.0, poisson = 0.3 }}
interface.joint = {{ secondary = "upper.bottom", primary = "lower.top", friction.coulomb.mu = 0.3, normal.linear.c = 800.0 }}
support.base = {{ set = "lower.bottom", x = 0, y = 0, z = 0 }}
support.press = {{ set = "upper.top", x = 0, y = 0.03, z = -0.02 }}
{mirror}step = [{{ increments.fixed = 2 }}]
solver.tolerance = 1e-12
quality.gate = "off"
"#,
            block(half, [-1.0, 0.0], 2),
            block(half, [0.0, 0.7], cells),
        );
        let mut simulation =
            support::build(&support::problem(&text)).unwrap_or_else(|e| panic!("{e}"));
        simulation.run(&mut []).unwrap_or_else(|e| panic!("{e}"));
        let interface = support::contact(&simulation);
        let r = look::resultant(interface, &simulation.frame.state.u);
        let part = if half { 2.0 } else { 1.0 };
        [r.normal[1], r.normal[2], r.shear[1], r.shear[2]].map(|f| part * f)
    };
    for cells in [2, 3] {
        let (whole, half) = (forces(false, cells), forces(true, cells));
        for (a, b) in whole.iter().zip(half) {
            assert!((a - b).abs() < 1e-9 * whole[1].abs(), "{whole:?} {half:?}");
        }
    }
}

//! What only meshes and matrices can tell: every mistake ends in a message that says what is wrong, where, and what to do.
//!
//! Mistakes that the text of a problem file shows by itself are tested in `problem_files.rs`.

use crate::support;
use std::path::Path;

use stickslip::Error;
use stickslip::problem::Document;
use stickslip::run::Simulation;

/// A block of two cells on a rigid floor.
const CASE: &str = r#"
format = 1
model.space = "plane-strain"
body.block = { generate.rectangle = { to = [0.04, 0.02], cells = [2, 1] }, material = "steel" }
material.steel.isotropic = { young = 210e9, poisson = 0.3 }
obstacle.floor.plane = { point = [0, 0], normal = [0, 1] }
interface.base = { secondary = "block.bottom", primary = "floor" }
support.top = { set = "block.top", x = 0, y = -1e-5 }
step = [{ name = "press" }]
"#;

/// The same block as a mesh of Gmsh, lengths in metres.
const MESH: &str = "$MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
3
1 1 \"bottom\"
1 2 \"top\"
2 3 \"steel\"
$EndPhysicalNames
$Nodes
6
1 0 0 0
2 0.02 0 0
3 0.04 0 0
4 0 0.02 0
5 0.02 0.02 0
6 0.04 0.02 0
$EndNodes
$Elements
6
11 1 2 1 1 1 2
12 1 2 1 1 2 3
13 1 2 2 2 4 5
14 1 2 2 2 5 6
21 3 2 3 3 1 2 5 4
22 3 2 3 3 2 3 6 5
$EndElements
";

/// The case with the mesh from the file `block.msh`.
fn from_file() -> String {
    let (a, b) = (
        "generate.rectangle = { to = [0.04, 0.02], cells = [2, 1] }",
        "gmsh.file = \"block.msh\"",
    );
    assert!(CASE.contains(a));
    CASE.replace(a, b)
}

/// Builds and runs the problem in `text`, with mesh files in `folder`.
fn outcome(text: &str, folder: &Path) -> Result<(), Error> {
    let document = Document::new(text, None);
    let model = document.problem()?.build(folder)?;
    Simulation::new(model)?.run(&mut [])
}

/// The message of a problem that must fail.
fn message(text: &str, folder: &Path) -> String {
    match outcome(text, folder) {
        Ok(()) => panic!("the mistake goes unnoticed"),
        Err(e) => e.to_string(),
    }
}

/// The message with one thing changed in the case.
fn wrong(right: &str, wrong: &str) -> String {
    assert!(CASE.contains(right), "{right}");
    message(&CASE.replacen(right, wrong, 1), Path::new("."))
}

/// The message with one thing changed in the mesh.
fn wrong_mesh(name: &str, change: impl Fn(&str) -> String) -> String {
    let folder = support::folder(name);
    let mesh = change(MESH);
    assert_ne!(mesh, MESH);
    std::fs::write(folder.join("block.msh"), mesh).expect("a mesh file");
    message(&from_file(), &folder)
}

fn says(message: &str, parts: &[&str]) {
    for part in parts {
        assert!(message.contains(part), "`{part}` is missing in:\n{message}");
    }
}

#[test]
fn the_case_is_sound_with_either_mesh() {
    outcome(CASE, Path::new(".")).unwrap_or_else(|e| panic!("{e}"));
    let folder = support::folder("sound-mesh");
    std::fs::write(folder.join("block.msh"), MESH).expect("a mesh file");
    outcome(&from_file(), &folder).unwrap_or_else(|e| panic!("{e}"));
}

#[test]
fn a_mesh_file_that_is_not_there() {
    let folder = support::folder("missing-mesh");
    let message = message(&from_file(), &folder);
    let file = folder.join("block.msh").display().to_string();
    says(
        &message,
        &[
            &file,
            "the mesh cannot be read",
            "relative to the problem file",
        ],
    );
}

#[test]
fn a_set_that_the_mesh_does_not_have() {
    let expected = [
        "`block.botom` has no points: there is no such set",
        "block.bottom, block.bottom-left",
    ];
    let interface = wrong("block.bottom", "block.botom");
    says(&interface, &["interface.base.secondary"]);
    says(&interface, &expected);
    let load = wrong(
        "step =",
        "load.weight = { set = \"block.botom\", pressure.value = 1.0 }\nstep =",
    );
    says(&load, &["load.weight.set"]);
    says(&load, &expected);
}

#[test]
fn a_place_where_no_point_is() {
    let message = wrong(
        "support.top = { set = \"block.top\"",
        "set.A = { of = \"block\", point = [0.03, 0.05] }\nsupport.top = { set = \"A\"",
    );
    says(
        &message,
        &["set.A: no point of `block` lies there", "widen `tolerance`"],
    );
}

#[test]
fn supports_that_contradict_each_other() {
    let side =
        "support.side = { set = \"block.left\", y = 1e-6 }\nsupport.top = { set = \"block.top\"";
    let message = wrong("support.top = { set = \"block.top\"", side);
    says(
        &message,
        &[
            "support.top",
            "supports side and top prescribe different displacements of node",
            "leave the common points out of one of the two sets",
        ],
    );
}

#[test]
fn an_interface_without_facets() {
    let message = wrong(
        "interface.base = { secondary = \"block.bottom\"",
        "set.A = { of = \"block\", point = [0.04, 0] }\ninterface.base = { secondary = \"A\"",
    );
    says(
        &message,
        &[
            "interface.base.secondary: `A` has no facets: no boundary facet has all its points in it",
            "`A` holds 1 point",
        ],
    );
}

#[test]
fn a_mesh_of_the_wrong_dimension() {
    let message = wrong(
        "generate.rectangle = { to = [0.04, 0.02], cells = [2, 1] }",
        "generate.box = { to = [0.04, 0.02, 0.01], cells = [2, 1, 1] }",
    );
    says(
        &message,
        &[
            "body.block: the mesh has 3 dimensions, but `model.space` is plane-strain",
            "change `model.space` or the mesh",
        ],
    );
}

#[test]
fn primary_and_secondary_with_common_nodes() {
    let message = wrong("primary = \"floor\"", "primary = \"block.left\"");
    says(
        &message,
        &[
            "interface.base.primary: primary and secondary share points (node 1)",
            "duplicate the nodes",
        ],
    );
}

#[test]
fn surfaces_that_run_through_themselves() {
    // The top of one body and the left side of another that stands in it.
    let bodies = r#"support.top =
body.a = { generate.rectangle = { from = [0, -0.02], to = [0.02, -0.004], cells = [2, 2] }, material = "steel" }
body.b = { generate.rectangle = { from = [0.012, -0.01], to = [0.03, 0], cells = [2, 2] }, material = "steel" }
set.skin.union = ["a.top", "b.left"]
support.below = { set = "a", x = 0, y = 0 }
support.beside = { set = "b", x = 0, y = 0 }
support.top ="#;
    let bodies = bodies.trim_start_matches("support.top =\n");
    let both = CASE.replace("support.top =", bodies);
    outcome(&both, Path::new(".")).unwrap_or_else(|e| panic!("{e}"));
    for (side, text) in [
        (
            "primary",
            both.replace("primary = \"floor\"", "primary = \"skin\""),
        ),
        (
            "secondary",
            both.replace("secondary = \"block.bottom\"", "secondary = \"skin\""),
        ),
    ] {
        let message = message(&text, Path::new("."));
        says(
            &message,
            &[
                &format!("interface.base.{side}: the surface runs through itself"),
                "of body a and",
                "of body b, near (0.02, -0.004)",
                "mend the mesh there",
            ],
        );
    }
    // Two sides that overlap are not a mistake of this kind: contact pushes them apart.
    let overlap = both.replace(
        "\"block.bottom\", primary = \"floor\"",
        "\"b.left\", primary = \"a.top\"",
    );
    assert_ne!(overlap, both);
    let document = Document::new(&overlap, None);
    let problem = document.problem().unwrap_or_else(|e| panic!("{e}"));
    assert!(problem.build(Path::new(".")).is_ok());
}

#[test]
fn a_body_that_nothing_holds() {
    let loose = wrong(
        "support.top =",
        "body.loose = { generate.rectangle = { from = [0, 1], to = [1, 2], cells = [2, 2] }, material = \"steel\" }\nsupport.top =",
    );
    says(
        &loose,
        &[
            "is free to move as a rigid body",
            "body loose: translation x is held neither by supports nor by springs nor by contact",
            "body loose: translation y is held",
            "body loose: rotation about z is held",
            "nothing drives it",
            "support these motions",
        ],
    );
    let sideways = wrong("x = 0, y = -1e-5", "y = -1e-5");
    says(&sideways, &["body block: translation x is held neither"]);
    assert!(!sideways.contains("rotation"), "{sideways}");
}

#[test]
fn a_mesh_with_a_number_that_is_none() {
    let message = wrong_mesh("nan", |m| m.replace("5 0.02 0.02 0", "5 0.02 nan 0"));
    says(
        &message,
        &[
            "block.msh:16: a coordinate of node 5 is NaN",
            "finite numbers",
        ],
    );
}

#[test]
fn a_mesh_file_cut_short() {
    for (left, expected) in [
        (40, "the file ends where a node number should be"),
        (14, "expected $EndElements"),
        (300, "the file ends where the file type should be"),
    ] {
        let message = wrong_mesh(&format!("cut-{left}"), |m| m[..m.len() - left].to_string());
        says(&message, &["block.msh:", expected, "the file is truncated"]);
    }
}

#[test]
fn a_mesh_that_refers_to_a_node_it_does_not_have() {
    let message = wrong_mesh("no-node", |m| m.replace("2 3 6 5", "2 3 7 5"));
    says(
        &message,
        &["block.msh:26: element 22 refers to node 7, which is not in $Nodes"],
    );
}

#[test]
fn a_cell_folded_over() {
    let message = wrong_mesh("folded", |m| m.replace("5 0.02 0.02 0", "5 0.02 -0.02 0"));
    says(
        &message,
        &["body block: cell 2", "negative Jacobian", "repair the mesh"],
    );
}

#[test]
fn a_number_of_increments_belongs_into_their_table() {
    says(
        &wrong(
            "{ name = \"press\" }",
            "{ name = \"press\", increments = 10 }",
        ),
        &["expected a table", "write `increments.fixed = 10`"],
    );
}

#[test]
fn what_is_no_problem_file_is_told_for_what_it_is() {
    let folder = support::folder("no-problems");
    let said = |name: &str, content: &[u8]| {
        let file = folder.join(name);
        std::fs::write(&file, content).expect("a file");
        match Document::read(&file) {
            Ok(_) => panic!("{name} is taken for a problem"),
            Err(e) => e.to_string(),
        }
    };
    says(
        &said("block.msh", MESH.as_bytes()),
        &["block.msh", "a mesh of Gmsh", "gmsh.file"],
    );
    says(
        &said("binary.msh", b"$MeshFormat\n4.1 1 8\n\x01\0\0\0\xff\xfe"),
        &["a mesh of Gmsh"],
    );
    says(
        &said("fields.vtu", b"<?xml version=\"1.0\"?>\n<VTKFile/>"),
        &["XML", "problem files are TOML"],
    );
    says(
        &said("job.txt", b"** a comment\n*HEADING\n"),
        &["input deck", "`.inp`"],
    );
    std::fs::write(folder.join("case.toml"), CASE).expect("a file");
    let message = match Document::read(&folder) {
        Ok(_) => panic!("a folder is taken for a problem"),
        Err(e) => e.to_string(),
    };
    says(&message, &["this is a folder", "case.toml"]);
}

#[test]
fn a_negative_radius_is_that_of_its_body() {
    let case = r#"
format = 1
model.space = "axisymmetric"
body.q = { generate.rectangle = { from = [-0.001, 0], to = [0.02, 0.002], cells = [20, 2] }, material = "steel" }
body.b = { generate.rectangle = { from = [0.03, 0], to = [0.04, 0.002], cells = [20, 2] }, material = "steel" }
material.steel.isotropic = { young = 210e9, poisson = 0.3 }
support.s = { set = "q.bottom", y = 0 }
support.t = { set = "b.bottom", y = 1e-5 }
step = [{ name = "press" }]
"#;
    let message = message(case, Path::new("."));
    says(&message, &["body q: point 1", "the negative radius -0.001"]);
    assert!(!message.contains("body b"), "{message}");
}

#[test]
fn a_run_that_does_not_converge() {
    // A law that is no straight line is not found by one linear problem.
    let law = "primary = \"floor\", normal.power-law = { c = 1e20, m = 2.0 } }";
    let text = CASE
        .replace("primary = \"floor\" }", law)
        .replace("\"press\" }", "\"press\", increments.fixed = 1 }");
    let solver = "solver = { max-iterations = 1, tolerance = 1e-15 }";
    let message = message(&format!("{text}{solver}\n"), Path::new(""));
    says(
        &message,
        &[
            "step press: no equilibrium in 1 iterations",
            "interface base, node 1 at (",
            "smaller increments",
        ],
    );
}

#[test]
fn a_stop_between_points_that_supports_move() {
    let stop = "coupling.stop.gap = { terms = [{ set = \"block.top-left\", component = \"y\" }, { set = \"block.top-right\", component = \"y\", factor = -1 }], clearance = 1e-6 }\n";
    let message = message(&format!("{CASE}{stop}"), Path::new(""));
    says(
        &message,
        &[
            "coupling.stop.gap.terms",
            "in step press",
            "let one of its points be free",
        ],
    );
}

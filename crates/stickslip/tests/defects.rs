//! Planted defects: sound models, each spoilt by one mistake, which an error, `check` or the findings of the run have to name.

mod support;

use std::path::Path;

use stickslip::Error;
use stickslip::problem::Document;
use stickslip::simulation::Simulation;
use stickslip::simulation::doctor::{DoctorCause, Finding, Severity};

/// Two blocks in the plane, pressed together by a prescribed displacement. Lengths in m.
const PRESS: &str = r#"
format = 1
model.space = "plane-strain"
body.lower = { generate.rectangle = { to = [0.04, 0.02], cells = [8, 4] }, material = "steel" }
body.upper = { generate.rectangle = { from = [0.01, 0.02], to = [0.03, 0.04], cells = [6, 6] }, material = "iron" }
material.steel.isotropic = { young = 210e9, poisson = 0.3, density = 7850 }
material.iron.isotropic = { young = 170e9, poisson = 0.3, density = 7200 }
interface.joint = { secondary = "upper.bottom", primary = "lower.top", friction.coulomb = { mu = 0.3 } }
support.base = { set = "lower.bottom", x = 0, y = 0 }
support.top = { set = "upper.top", x = 0, y = -1e-5 }
step = [{ name = "press" }]
"#;

/// A block on a rigid floor under a pressure, held by friction alone.
const LOAD: &str = r#"
format = 1
model.space = "plane-strain"
body.block = { generate.rectangle = { to = [0.04, 0.02], cells = [8, 4] }, material = "steel" }
material.steel.isotropic = { young = 210e9, poisson = 0.3 }
obstacle.floor.plane = { point = [0, 0], normal = [0, 1] }
interface.base = { secondary = "block.bottom", primary = "floor", friction.coulomb = { mu = 0.3 } }
load.weight = { set = "block.top", pressure.value = 1e8 }
load.push = { set = "block.left", traction.value = [1e7, 0] }
step = [{ name = "load" }]
"#;

/// Two cubes in space, pressed and slid. Lengths in mm, moduli in MPa.
const CUBES: &str = r#"
format = 1
model.space = "solid"
body.lower = { generate.box = { to = [10, 10, 10], cells = [3, 3, 3] }, material = "steel" }
body.upper = { generate.box = { from = [1, 1, 10], to = [9, 9, 18], cells = [4, 4, 4] }, material = "steel" }
material.steel.isotropic = { young = 210e3, poisson = 0.3 }
interface.joint = { secondary = "upper.bottom", primary = "lower.top", friction.coulomb = { mu = 0.3 } }
support.base = { set = "lower.bottom", x = 0, y = 0, z = 0 }
support.top = { set = "upper.top", x = 2e-3, y = 0, z = -2e-2 }
step = [{ name = "press" }]
"#;

/// A block that is thrown at a floor.
const THROW: &str = r#"
format = 1
model.space = "plane-strain"
body.block = { generate.rectangle = { from = [0, 0.001], to = [0.04, 0.021], cells = [4, 2] }, material = "steel" }
material.steel.isotropic = { young = 210e9, poisson = 0.3, density = 7850 }
obstacle.floor.plane = { point = [0, 0], normal = [0, 1] }
interface.base = { secondary = "block.bottom", primary = "floor" }
initial.fall = { set = "block", velocity = [0, -10] }
step = [{ name = "fall", duration = 2e-5, increments = { fixed = 20 }, dynamic = {} }]
"#;

/// Two cells of Gmsh on a floor; the mesh is written next to the case.
const MESHED: &str = r#"
format = 1
model.space = "plane-strain"
body.block = { gmsh.file = "block.msh", material = "steel" }
material.steel.isotropic = { young = 210e9, poisson = 0.3 }
obstacle.floor.plane = { point = [0, 0], normal = [0, 1] }
interface.base = { secondary = "block.bottom", primary = "floor" }
support.top = { set = "block.top", x = 0, y = -1e-5 }
step = [{ name = "press" }]
"#;

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
8
1 0 0 0
2 0.02 0 0
3 0.04 0 0
4 0 0.02 0
5 0.02 0.02 0
6 0.04 0.02 0
7 0.02 0 0
8 0.02 0.02 0
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

/// What has to be said of a defect.
enum Expected {
    /// The file or a mesh is refused with these words.
    Refused(&'static str),
    /// `check` or the run finds this cause, and names this.
    Found(DoctorCause, &'static str),
}
use Expected::{Found, Refused};

struct Defect {
    name: &'static str,
    base: &'static str,
    /// What is replaced by what, once each.
    changes: &'static [(&'static str, &'static str)],
    /// The same in the mesh file.
    mesh: &'static [(&'static str, &'static str)],
    expected: Expected,
}

const fn defect(
    name: &'static str,
    base: &'static str,
    changes: &'static [(&'static str, &'static str)],
    expected: Expected,
) -> Defect {
    Defect {
        name,
        base,
        changes,
        mesh: &[],
        expected,
    }
}

const fn meshed(
    name: &'static str,
    mesh: &'static [(&'static str, &'static str)],
    expected: Expected,
) -> Defect {
    Defect {
        name,
        base: MESHED,
        changes: &[],
        mesh,
        expected,
    }
}

const DEFECTS: &[Defect] = &[
    defect(
        "a support holds one direction too few",
        PRESS,
        &[
            ("friction.coulomb = { mu = 0.3 }", "friction.none = {}"),
            ("set = \"upper.top\", x = 0,", "set = \"upper.top\","),
        ],
        Found(DoctorCause::FreeRigidMode, "upper"),
    ),
    defect(
        "the support of the lower body is missing",
        PRESS,
        &[(
            "support.base = { set = \"lower.bottom\", x = 0, y = 0 }\n",
            "",
        )],
        Found(DoctorCause::FreeRigidMode, "lower"),
    ),
    defect(
        "a body that nothing holds",
        PRESS,
        &[(
            "step =",
            "body.loose = { generate.rectangle = { from = [0, 1], to = [0.02, 1.02], cells = [2, 2] }, material = \"steel\" }\nstep =",
        )],
        Found(DoctorCause::FreeRigidMode, "loose"),
    ),
    defect(
        "no friction where friction has to hold the block",
        LOAD,
        &[("friction.coulomb = { mu = 0.3 }", "friction.none = {}")],
        Found(DoctorCause::FreeRigidMode, "block"),
    ),
    defect(
        "a cube without lateral support",
        CUBES,
        &[
            ("friction.coulomb = { mu = 0.3 }", "friction.none = {}"),
            ("x = 2e-3, y = 0, z = -2e-2", "z = -2e-2"),
        ],
        Found(DoctorCause::FreeRigidMode, "upper"),
    ),
    defect(
        "the secondary is the far side of its body",
        PRESS,
        &[("upper.bottom", "upper.top")],
        Found(DoctorCause::NormalsNotOpposed, "joint"),
    ),
    defect(
        "the primary is the far side of its body",
        CUBES,
        &[
            ("primary = \"lower.top\"", "primary = \"lower.bottom\""),
            ("set = \"lower.bottom\"", "set = \"lower.front\""),
        ],
        Found(DoctorCause::NormalsNotOpposed, "joint"),
    ),
    defect(
        "the primary is a side wall",
        PRESS,
        &[("lower.top", "lower.right")],
        Found(DoctorCause::NormalsNotOpposed, "joint"),
    ),
    defect(
        "the normal of the floor points down",
        LOAD,
        &[("normal = [0, 1]", "normal = [0, -1]")],
        Found(DoctorCause::NormalsNotOpposed, "base"),
    ),
    defect(
        "the floor lies above the block",
        LOAD,
        &[("point = [0, 0]", "point = [0, 0.05]")],
        Found(DoctorCause::NormalsNotOpposed, "base"),
    ),
    defect(
        "a gap that the prescribed displacement cannot close",
        PRESS,
        &[(
            "from = [0.01, 0.02], to = [0.03, 0.04]",
            "from = [0.01, 0.022], to = [0.03, 0.042]",
        )],
        Found(DoctorCause::InitialGap, "joint"),
    ),
    defect(
        "a block under load far above its floor",
        LOAD,
        &[("point = [0, 0]", "point = [0, -0.05]")],
        Found(DoctorCause::InitialGap, "block"),
    ),
    defect(
        "the bodies overlap",
        PRESS,
        &[(
            "from = [0.01, 0.02], to = [0.03, 0.04]",
            "from = [0.01, 0.016], to = [0.03, 0.036]",
        )],
        Found(DoctorCause::InitialOverlap, "joint"),
    ),
    defect(
        "the upper body lies beside the lower one",
        PRESS,
        &[(
            "from = [0.01, 0.02], to = [0.03, 0.04]",
            "from = [0.06, 0.02], to = [0.08, 0.04]",
        )],
        Found(DoctorCause::NothingOpposite, "joint"),
    ),
    meshed(
        "a cell is folded over",
        &[("5 0.02 0.02 0", "5 0.02 -0.02 0")],
        Refused("cell 21"),
    ),
    meshed(
        "a cell has collapsed",
        &[("5 0.02 0.02 0", "5 0.04 0.02 0")],
        Refused("cell 22 (quad4) has a collapsed"),
    ),
    meshed(
        "a cell is there twice",
        &[
            ("$Elements\n6", "$Elements\n7"),
            (
                "22 3 2 3 3 2 3 6 5",
                "22 3 2 3 3 2 3 6 5\n23 3 2 3 3 1 2 5 4",
            ),
        ],
        Refused("23 share one face"),
    ),
    meshed(
        "coincident nodes were not merged",
        &[
            ("22 3 2 3 3 2 3 6 5", "22 3 2 3 3 7 3 6 8"),
            ("12 1 2 1 1 2 3", "12 1 2 1 1 7 3"),
            ("14 1 2 2 2 5 6", "13 1 2 2 2 4 5"),
        ],
        Found(DoctorCause::DisconnectedBody, "block"),
    ),
    meshed(
        "a coordinate is no number",
        &[("5 0.02 0.02 0", "5 0.02 nan 0")],
        Refused("node 5"),
    ),
    defect(
        "friction too large by a decimal",
        PRESS,
        &[("mu = 0.3", "mu = 3")],
        Found(DoctorCause::LargeFriction, "joint"),
    ),
    defect(
        "friction above the coupling limit of a skewed material",
        LOAD,
        &[
            (
                "material.steel.isotropic = { young = 210e9, poisson = 0.3 }",
                "material.steel.anisotropic = { stiffness = [[30e9, 10e9, 10e9, 0, 0, 0], [10e9, 100e9, 10e9, 70e9, 0, 0], [10e9, 10e9, 100e9, 0, 0, 0], [0, 70e9, 0, 55e9, 0, 0], [0, 0, 0, 0, 50e9, 0], [0, 0, 0, 0, 0, 50e9]] }",
            ),
            ("mu = 0.3", "mu = 1.4"),
        ],
        Found(DoctorCause::CoulombNonUniqueness, "base"),
    ),
    defect(
        "one modulus in MPa",
        PRESS,
        &[("young = 170e9", "young = 170e3")],
        Found(DoctorCause::MixedUnits, "upper"),
    ),
    defect(
        "one modulus in GPa",
        CUBES,
        &[
            (
                "cells = [4, 4, 4] }, material = \"steel\"",
                "cells = [4, 4, 4] }, material = \"iron\"",
            ),
            (
                "step =",
                "material.iron.isotropic = { young = 170, poisson = 0.3 }\nstep =",
            ),
        ],
        Found(DoctorCause::MixedUnits, "upper"),
    ),
    defect(
        "moduli in Pa and lengths in mm",
        CUBES,
        &[
            ("young = 210e3", "young = 210e9"),
            ("to = [10, 10, 10], cells", "to = [40, 10, 10], cells"),
        ],
        Found(DoctorCause::MixedUnits, "lower"),
    ),
    defect(
        "moduli in MPa and lengths in m",
        PRESS,
        &[
            (
                "young = 210e9, poisson = 0.3, density = 7850",
                "young = 210e3, poisson = 0.3",
            ),
            (
                "young = 170e9, poisson = 0.3, density = 7200",
                "young = 170e3, poisson = 0.3",
            ),
        ],
        Found(DoctorCause::MixedUnits, "lower"),
    ),
    defect(
        "one mesh in mm and one in m",
        PRESS,
        &[(
            "material = \"steel\" }",
            "material = \"steel\", scale = 1e3 }",
        )],
        Found(DoctorCause::MixedUnits, "lower"),
    ),
    defect(
        "a density in tonnes",
        THROW,
        &[("density = 7850", "density = 7.85e-9")],
        Found(DoctorCause::MixedUnits, "block"),
    ),
    defect(
        "supports contradict each other",
        PRESS,
        &[(
            "step =",
            "support.side = { set = \"upper.left\", x = 1e-6 }\nstep =",
        )],
        Found(DoctorCause::ContradictingSupports, "top"),
    ),
    defect(
        "friction without anything that presses",
        PRESS,
        &[("x = 0, y = -1e-5", "x = 1e-5, y = 0")],
        Found(DoctorCause::FrictionWithoutPressure, "joint"),
    ),
    defect(
        "a coarse primary against a fine secondary",
        PRESS,
        &[
            ("cells = [8, 4]", "cells = [1, 1]"),
            ("cells = [6, 6]", "cells = [12, 6]"),
        ],
        Found(DoctorCause::MeshMismatch, "lower"),
    ),
    defect(
        "a secondary that is far too coarse",
        PRESS,
        &[
            ("cells = [8, 4]", "cells = [40, 4]"),
            ("cells = [6, 6]", "cells = [2, 2]"),
        ],
        Found(DoctorCause::MeshMismatch, "joint"),
    ),
    defect(
        "a prescribed displacement of zero",
        PRESS,
        &[("y = -1e-5", "y = 0")],
        Found(DoctorCause::NothingActs, "step"),
    ),
    defect(
        "one row of a law in other units",
        PRESS,
        &[(
            "friction.coulomb",
            "normal.tabular.table = [[0, 0], [1e-7, 1e4], [2e-7, 2e7], [3e-7, 4e7]], friction.coulomb",
        )],
        Found(DoctorCause::LawTangentJump, "joint"),
    ),
    defect(
        "a push beyond the limit of friction",
        LOAD,
        &[("traction.value = [1e7, 0]", "traction.value = [2e8, 0]")],
        Found(DoctorCause::SlidesAway, "block"),
    ),
    defect(
        "a slide over several facets in one increment",
        PRESS,
        &[
            ("x = 0, y = -1e-5", "x = 0.012, y = -1e-5"),
            (
                "step = [{ name = \"press\" }]",
                "step = [{ name = \"press\", increments = { fixed = 1 } }]\nsolver = { max-iterations = 2, tolerance = 1e-14 }",
            ),
        ],
        Found(DoctorCause::TooLargeSlip, "joint"),
    ),
    defect(
        "an explicit increment above the stable one",
        THROW,
        &[
            (
                "dynamic = {}",
                "dynamic = { scheme.central-difference = {} }",
            ),
            ("fixed = 20", "fixed = 2"),
        ],
        Found(DoctorCause::Stopped, "stable"),
    ),
    defect(
        "a set that is misspelt",
        PRESS,
        &[("upper.bottom", "upper.botom")],
        Refused("upper.botom"),
    ),
    defect(
        "a body in contact with itself",
        PRESS,
        &[("primary = \"lower.top\"", "primary = \"upper.left\"")],
        Refused("interface.joint.primary"),
    ),
];

fn changed(text: &str, changes: &[(&str, &str)]) -> String {
    changes.iter().fold(text.to_string(), |text, (from, to)| {
        assert!(text.contains(from), "`{from}` is not in\n{text}");
        text.replacen(from, to, 1)
    })
}

/// Findings before and of a run, and how it ended.
type Examined = (Vec<Finding>, Vec<Finding>, Option<Error>);

/// What is said of a model: the error that refuses it, or the findings before and of the run.
fn examined(text: &str, folder: &Path) -> Result<Examined, Error> {
    let document = Document::new(text, None);
    let model = document.problem()?.build(folder)?;
    let before = Simulation::new(model)?.check().findings;
    let model = document.problem()?.build(folder)?;
    let mut simulation = Simulation::new(model)?;
    let outcome = simulation.run(&mut []);
    Ok((before, simulation.summary.findings, outcome.err()))
}

fn folder(name: &str, mesh: &[(&str, &str)]) -> std::path::PathBuf {
    let folder = support::folder(&format!("defects-{}", name.replace(' ', "-")));
    std::fs::write(folder.join("block.msh"), changed(MESH, mesh)).expect("a mesh file");
    folder
}

#[test]
fn sound_models_raise_no_alarm() {
    for (name, base) in [
        ("press", PRESS),
        ("load", LOAD),
        ("cubes", CUBES),
        ("throw", THROW),
        ("meshed", MESHED),
    ] {
        let (before, during, error) =
            examined(base, &folder(name, &[])).unwrap_or_else(|e| panic!("{name}: {e}"));
        if let Some(error) = error {
            panic!("{name}: {error}");
        }
        for finding in before.iter().chain(&during) {
            assert!(finding.severity < Severity::Warning, "{name}: {finding}");
        }
    }
}

#[test]
fn planted_defects_are_named() {
    let mut missed = Vec::new();
    for defect in DEFECTS {
        let text = changed(defect.base, defect.changes);
        let said = examined(&text, &folder(defect.name, defect.mesh));
        let named = match (&defect.expected, &said) {
            (Refused(words), Err(error)) => error.to_string().contains(words),
            (Found(cause, entity), Ok((before, during, _))) => before
                .iter()
                .chain(during)
                .any(|f| f.cause == *cause && f.to_string().contains(entity)),
            _ => false,
        };
        if !named {
            let said = match said {
                Err(e) => e.to_string(),
                Ok((before, during, error)) => {
                    let all: Vec<String> = before
                        .iter()
                        .chain(&during)
                        .map(Finding::to_string)
                        .collect();
                    let end = error.map_or("finished".to_string(), |e| e.to_string());
                    format!("{}\n=> {end}", all.join("\n"))
                }
            };
            missed.push(format!("## {}\n{said}", defect.name));
        }
    }
    assert!(DEFECTS.len() >= 27);
    assert!(
        missed.is_empty(),
        "{} of {} missed:\n{}",
        missed.len(),
        DEFECTS.len(),
        missed.join("\n\n")
    );
}

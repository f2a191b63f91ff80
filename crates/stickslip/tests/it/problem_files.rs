//! Problem files: what a stranger gets wrong, and what he is told.

use std::path::Path;

use stickslip::error::line_column;
use stickslip::problem::{Document, Interface, Load, Material, MeshSource, Problem, Temperature};
use stickslip::problem::{brief_toml, families, schema};
use stickslip::registry::Family;

const SOUND: &str = r#"format = 1
title = "a block on a floor"

[model]
space = "plane-strain"

[body.block]
gmsh.file = "block.msh"
material = "steel"

[material.steel.isotropic]
young = 210e9
poisson = 0.3

[obstacle.floor.plane]
point = [0, 0]
normal = [0, 1]

[set.A]
of = "block"
point = [0.04, 0.0]

[interface.base]
secondary = "block.bottom"
primary = "floor"
friction.coulomb = { mu = 1.0 }

[support.left]
set = "block.left"
x = 0.0
amplitude = "press"

[amplitude.press]
table = [[0, 0], [1, 1]]

[[step]]
name = "press"
interfaces = ["base"]

[probe.A]
point = [0.04, 0.0]
"#;

fn findings(text: &str) -> Vec<String> {
    let Err(error) = Problem::from_toml(text, None) else {
        return Vec::new();
    };
    let place = |span: &Option<std::ops::Range<usize>>| {
        span.as_ref().map_or("-".to_string(), |span| {
            let (line, column) = line_column(text, span.start);
            format!("{line}:{column}")
        })
    };
    error
        .findings
        .iter()
        .map(|f| format!("{} {}", place(&f.span), f.message))
        .collect()
}

/// `SOUND` with one passage replaced, and the place and message of every finding.
const WRONG: &[(&str, &str, &[&str])] = &[
    // syntax
    (
        "young = 210e9",
        "young = ",
        &["12:9 not TOML: string values must be quoted, expected literal string"],
    ),
    // format
    ("format = 1\n", "", &["- the key `format` is missing"]),
    (
        "format = 1",
        "format = 2",
        &["1:10 the file has format 2; this version reads format 1"],
    ),
    ("format = 1", "format = 0", &["1:10 there is no format 0"]),
    (
        "format = 1",
        "format = \"1\"",
        &["1:10 expected a whole number, found a string"],
    ),
    // keys and kinds
    ("secondary =", "slave =", &["24:1 unknown key `slave`"]),
    ("young", "yuong", &["12:1 unknown key `yuong`"]),
    ("[probe.A]", "[prob.A]", &["40:2 unknown key `prob`"]),
    (
        "friction.coulomb",
        "friction.colomb",
        &["26:10 unknown key `colomb`"],
    ),
    (
        "friction.coulomb = { mu = 1.0 }",
        "friction = \"coulomb\"",
        &["26:12 expected a table, found a string"],
    ),
    (
        "friction.coulomb = { mu = 1.0 }",
        "friction.coulomb = {}",
        &["26:10 the key `mu` is missing"],
    ),
    (
        "plane-strain",
        "plain-strain",
        &["5:9 `plain-strain` is not known here"],
    ),
    (
        "secondary = \"block.bottom\"\n",
        "",
        &["23:12 the key `secondary` is missing"],
    ),
    (
        "point = [0.04, 0.0]\n\n[interface",
        "point = [0.04, 0.0]\nball = { centre = [0, 0], radius = 1 }\n\n[interface",
        &["22:1 `point` and `ball` exclude each other"],
    ),
    (
        "gmsh.file = \"block.msh\"\n",
        "",
        &["7:7 one of these keys is missing: generate, gmsh, mesh"],
    ),
    (
        "[[step]]\nname = \"press\"\ninterfaces = [\"base\"]\n",
        "",
        &["- the key `step` is missing"],
    ),
    // types and ranges
    (
        "210e9",
        "\"210e9\"",
        &["12:9 expected a number, found a string"],
    ),
    ("210e9", "nan", &["12:9 must be a finite number, found nan"]),
    (
        "name = \"press\"\n",
        "duration = -1\n",
        &["37:12 must be greater than 0, found -1"],
    ),
    (
        "[[0, 0], [1, 1]]",
        "[[0, 0], [1]]",
        &["34:18 expected 2 entries, found 1"],
    ),
    (
        "[[0, 0], [1, 1]]",
        "[]",
        &["34:9 expected at least 1 entries, found 0"],
    ),
    (
        "space = \"plane-strain\"",
        "space = \"plane-strain\"\nthickness = 0",
        &["6:13 must be greater than 0, found 0"],
    ),
    // parameters of models
    (
        "210e9",
        "-210e9",
        &["12:9 young = -210000000000 is not positive"],
    ),
    (
        "0.3",
        "0.6",
        &[
            "13:11 poisson = 0.6 is outside the open interval (-1, 0.5); the smallest eigenvalue of the stiffness is -1.05e12",
        ],
    ),
    (
        "mu = 1.0",
        "mu = -1.0",
        &["26:27 `mu` must not be negative, but is -1"],
    ),
    (
        "normal = [0, 1]",
        "normal = [0, 0]",
        &["17:10 `normal` is zero"],
    ),
    (
        "friction.coulomb = { mu = 1.0 }",
        "friction.power-law = { c = 1e9, m = 2 }",
        &[
            "26:1 friction `power-law` depends on the penetration, which normal `unilateral` does not allow",
        ],
    ),
    (
        "friction.coulomb = { mu = 1.0 }",
        "friction.tabular = { speeds = [0, 0], mu = [[0.4, 0.3]] }",
        &["26:31 `speeds` must increase; entry 2 does not"],
    ),
    (
        "friction.coulomb = { mu = 1.0 }",
        "friction.tabular = { pressures = [1e6, 1e7], speeds = [0, 1], mu = [[0.4, 0.3], [0.3]] }",
        &["26:68 `mu` must have 2 numbers in a row, one for each speed; row 2 has 1"],
    ),
    (
        "friction.coulomb = { mu = 1.0 }",
        "friction.static-kinetic = { static = 0.3, kinetic = 0.5 }",
        &["26:53 `kinetic` must not be larger than `static`, 0.3, but is 0.5"],
    ),
    (
        "friction.coulomb = { mu = 1.0 }",
        "friction.stribeck = { static = 0.5, kinetic = 0.3, velocity = 0.1, exponent = 0.5 }",
        &["26:79 `exponent` must be at least 1, not 0.5"],
    ),
    (
        "friction.coulomb",
        "normal.linear = { c = 1e12 }\ndamping.viscous = { coefficient = 0 }\nfriction.coulomb",
        &["27:35 `coefficient` must be positive and finite, not 0"],
    ),
    (
        "friction.coulomb",
        "damping.hunt-crossley = { coefficient = 0.3 }\nfriction.coulomb",
        &["26:1 damping needs a pressure that follows from the gap"],
    ),
    // dimensions
    (
        "normal = [0, 1]",
        "normal = [0, 1, 0]",
        &["17:10 `normal` has 3 components, but the problem has 2 dimensions"],
    ),
    (
        "of = \"block\"\npoint = [0.04, 0.0]",
        "of = \"block\"\npoint = [0.04]",
        &["21:9 expected 2 components (x, y) because the model is plane-strain, found 1"],
    ),
    (
        "x = 0.0",
        "z = 0.0",
        &["30:5 there is no component z because the model is plane-strain"],
    ),
    (
        "plane-strain\"",
        "axisymmetric\"\nthickness = 2.0",
        &["6:13 a thickness has no meaning where the model is axisymmetric"],
    ),
    // names
    (
        "material = \"steel\"",
        "material = \"steal\"",
        &["9:12 `steal` is not among the materials"],
    ),
    (
        "material = \"steel\"\n",
        "",
        &["7:7 the body `block` has no material"],
    ),
    (
        "\"block.bottom\"",
        "\"blok.bottom\"",
        &["24:13 `blok` is not among the bodies"],
    ),
    (
        "primary = \"floor\"",
        "primary = \"flor\"",
        &["25:11 there is no set, body or obstacle `flor`"],
    ),
    (
        "primary = \"floor\"",
        "primary = \"block.bottom\"",
        &["25:11 primary and secondary are the same surface"],
    ),
    (
        "\"block.bottom\"",
        "\"floor\"",
        &[
            "24:13 `floor` is an obstacle, and obstacles are primary",
            "25:11 primary and secondary are the same surface",
        ],
    ),
    (
        "amplitude = \"press\"",
        "amplitude = \"pres\"",
        &["31:13 `pres` is not among the amplitudes"],
    ),
    (
        "[\"base\"]",
        "[\"bas\"]",
        &["38:15 `bas` is not among the interfaces"],
    ),
    (
        "[\"base\"]",
        "[\"base\", \"base\"]",
        &["38:23 `base` is listed twice"],
    ),
    (
        "interfaces = [\"base\"]",
        "interfaces = []\nsupports = []",
        &[
            "36:1 nothing acts in this step: no support, no load, no temperature, no interface, no coupling",
        ],
    ),
    (
        "[obstacle.floor.plane]",
        "[obstacle.block.plane]",
        &[
            "15:11 `block` is the name of a body already",
            "25:11 there is no set, body or obstacle `floor`",
        ],
    ),
    (
        "[set.A]",
        "[set.\"A.B\"]",
        &["19:6 `A.B` cannot be the name of a set"],
    ),
    (
        "of = \"block\"\npoint",
        "point",
        &["19:6 the set `A` does not say of which body it is"],
    ),
    (
        "point = [0.04, 0.0]\n\n",
        "union = [\"A\"]\n\n",
        &[
            "20:6 a union has no `of`",
            "21:9 the set `A` is a part of itself",
        ],
    ),
    (
        "x = 0.0\n",
        "",
        &["28:10 the support `left` holds no component"],
    ),
    // loads, generators
    (
        "[probe.A]",
        "[load.p]\nset = \"block.top\"\npresure = { value = 1e6 }\n\n[probe.A]",
        &["42:1 unknown key `presure`"],
    ),
    (
        "[probe.A]",
        "[load.p]\nset = \"top\"\npressure = { value = 1e6 }\n\n[probe.A]",
        &["41:7 there is no set or body `top`"],
    ),
    (
        "[probe.A]",
        "[load.p]\nset = \"A\"\n\n[probe.A]",
        &[
            "40:7 one of these keys is missing: traction, pressure, body-force, gravity, centrifugal, nodal-force, moment, spring",
        ],
    ),
    (
        "gmsh.file = \"block.msh\"",
        "generate.rectangle = { to = [1, 2], cels = [4, 4] }",
        &["8:37 unknown key `cels`"],
    ),
    (
        "gmsh.file = \"block.msh\"",
        "generate.rectangle = { to = [1, 2, 3], cells = [4, 4] }",
        &["8:29 expected 2 entries, found 3"],
    ),
    (
        "gmsh.file = \"block.msh\"",
        "generate.rectangle = { to = [1, 2], element = \"quad5\" }",
        &["8:47 `quad5` is not known here"],
    ),
    (
        "friction.coulomb",
        "kinematics.pop-1995 = {}\nfacets = \"bilinear\"\nfriction.coulomb",
        &["27:10 kinematics `pop-1995` needs triangles"],
    ),
    // time
    (
        "[[0, 0], [1, 1]]",
        "[[1, 0], [1, 1]]",
        &["34:18 the time does not increase"],
    ),
    (
        "[probe.A]",
        "[output]\ntimes = [0.5, 2]\n\n[probe.A]",
        &["41:15 the analysis ends at 1, before 2"],
    ),
    (
        "[probe.A]",
        "[[step]]\nname = \"press\"\n\n[probe.A]",
        &["41:8 there is a step `press` already"],
    ),
    (
        "interfaces = [\"base\"]",
        "increments = { fixed = 10, initial = 0.2 }",
        &["38:1 `fixed` excludes `initial`, `smallest`, `largest` and `state-change`"],
    ),
    (
        "interfaces = [\"base\"]",
        "increments.largest = 0.01",
        &["38:1 `initial` (0.1) is larger than `largest` (0.01)"],
    ),
];

#[test]
fn the_sound_file_is_sound() {
    assert_eq!(findings(SOUND), Vec::<String>::new());
}

#[test]
fn every_mistake_is_found_where_it_is() {
    let mut surprises = Vec::new();
    for (right, wrong, expected) in WRONG {
        assert!(SOUND.contains(right), "{right}");
        let found = findings(&SOUND.replacen(right, wrong, 1));
        if found != *expected {
            surprises.push(format!("{wrong}: found {found:#?}, expected {expected:#?}"));
        }
    }
    assert!(surprises.is_empty(), "{}", surprises.join("\n"));
}

#[test]
fn damping_goes_with_a_pressure_that_follows_from_the_gap() {
    for beside in [
        "enforcement.penalty = {}",
        "normal.power-law = { c = 1e20, m = 2.0 }",
    ] {
        for damping in ["viscous", "hunt-crossley"] {
            let laws = format!("{beside}\ndamping.{damping} = {{ coefficient = 0.3 }}\nfriction");
            let text = SOUND.replace("friction", &laws);
            assert_eq!(findings(&text), Vec::<String>::new(), "{beside} {damping}");
        }
    }
    let none = SOUND.replace("friction", "damping.none = {}\nfriction");
    assert_eq!(findings(&none), Vec::<String>::new());
}

#[test]
fn several_mistakes_are_found_at_once() {
    let text = SOUND
        .replace("young", "yuong")
        .replace("secondary", "slave")
        .replace("plane-strain", "flat");
    assert_eq!(
        findings(&text),
        [
            "5:9 `flat` is not known here",
            "12:1 unknown key `yuong`",
            "24:1 unknown key `slave`",
        ]
    );
}

#[test]
fn help_names_the_nearest_and_what_there_is() {
    let help = |right: &str, wrong: &str| {
        let text = SOUND.replacen(right, wrong, 1);
        let error = Problem::from_toml(&text, None).unwrap_err();
        error.findings[0].help.clone().unwrap_or_default()
    };
    assert_eq!(
        help("young", "yuong"),
        "did you mean `young`? allowed here: density, poisson, young"
    );
    let kind = help("friction.coulomb = { mu = 1.0 }", "friction = \"coulom\"");
    let expected = "the kind is a key: `friction.coulomb.mu = …`; kinds: none, coulomb, orthotropic, power-law, ";
    assert!(kind.starts_with(expected), "{kind}");
    let number = help("friction.coulomb = { mu = 1.0 }", "friction = 0.2");
    let expected = "write `friction.coulomb.mu = 0.2`; kinds: none, coulomb, ";
    assert!(number.starts_with(expected), "{number}");
    let stiffness = help(
        "friction.coulomb = { mu = 1.0 }",
        "friction.coulomb = { mu = 1.0 }\nnormal = 1e14",
    );
    let expected = "write `normal.linear.c = 1e14`; kinds: unilateral, ";
    assert!(stiffness.starts_with(expected), "{stiffness}");
    assert_eq!(
        help("primary = \"floor\"", "primary = \"B\""),
        "sets, bodies and obstacles: A, block, floor; sets of a mesh are written body.set"
    );
    assert_eq!(
        help(
            "space = \"plane-strain\"",
            "space = \"plane-strain\"\nthickness = -2"
        ),
        "Thickness [length] of a plane problem, 1 if not given"
    );
}

#[test]
fn display_has_file_line_and_column() {
    let text = SOUND.replacen("young", "yuong", 1);
    let error = Problem::from_toml(&text, Some(Path::new("case.toml"))).unwrap_err();
    assert_eq!(
        error.to_string(),
        "case.toml:12:1: material.steel.isotropic.yuong: unknown key `yuong`\n  \
         help: did you mean `young`? allowed here: density, poisson, young"
    );
}

#[test]
fn round_trip() {
    let problem = Problem::from_toml(SOUND, None).unwrap();
    let text = problem.to_toml().unwrap();
    assert_eq!(Problem::from_toml(&text, None).unwrap(), problem);
    assert!(problem.check().is_empty());
}

#[test]
fn a_brief_text_says_what_is_not_usual() {
    let mut problem = Problem::from_toml(SOUND, None).unwrap();
    problem.output.every = 3;
    let text = brief_toml(&problem).unwrap();
    assert_eq!(Problem::from_toml(&text, None).unwrap(), problem);
    assert!(text.contains("\n[output]\nevery = 3\n"), "{text}");
    for usual in ["[solver]", "[quality]", "history-every", "checkpoint"] {
        assert!(!text.contains(usual), "{usual}: {text}");
    }
}

#[test]
fn data_made_by_hand_obeys_the_same_rules() {
    let mut problem = Problem::from_toml(SOUND, None).unwrap();
    problem.step[0].duration = -1.0;
    problem.support.get_mut("left").unwrap().set = "blok".into();
    let keys: Vec<String> = problem.check().into_iter().map(|f| f.key).collect();
    assert_eq!(keys, ["step.1.duration", "support.left.set"]);
}

#[test]
fn overrides_are_checked_like_the_text() {
    let with = |text: &str| {
        Document::new(SOUND, None)
            .with_overrides([text.to_string()])
            .problem()
    };
    let problem = with("interface.base.friction.coulomb.mu=0.25").unwrap();
    let friction = serde_json::to_value(&problem.interface["base"].friction).unwrap();
    assert_eq!(friction["coulomb"]["mu"], 0.25);
    let error = with("interface.base.friction.coulomb.my=0.25").unwrap_err();
    assert_eq!(error.findings[0].message, "unknown key `my`");
    assert_eq!(error.findings[0].span, None);
    assert_eq!(error.findings[0].key, "interface.base.friction.coulomb.my");
}

#[test]
fn missing_file_is_named() {
    let error = Problem::from_file(Path::new("no/such.toml")).unwrap_err();
    assert!(error.to_string().starts_with("no/such.toml: "), "{error}");
}

#[test]
fn the_schema_describes_every_key() {
    fn undescribed(schema: &serde_json::Value, at: &str, out: &mut Vec<String>) {
        let properties = schema["properties"].as_object().into_iter().flatten();
        for (name, property) in properties {
            let described = property
                .get("description")
                .or_else(|| schema.get("description"));
            if described.is_none() {
                out.push(format!("{at}.{name}"));
            }
        }
        for alternative in schema["oneOf"].as_array().into_iter().flatten() {
            undescribed(alternative, at, out);
        }
    }
    let schema = schema();
    let mut out = Vec::new();
    undescribed(&schema, "", &mut out);
    let tables = schema["$defs"].as_object().unwrap();
    for (name, table) in tables {
        undescribed(table, name, &mut out);
    }
    assert_eq!(out, Vec::<String>::new());
    for table in [
        "Body",
        "Interface",
        "Obstacle",
        "Set",
        "Support",
        "Step",
        "Solver",
        "Probe",
    ] {
        assert!(tables.contains_key(table), "{table}");
    }
}

/// Every sample of a family, in a problem made by `place`, survives the way to text and back.
fn survives<F: Family>(place: impl Fn(&mut Problem, F)) {
    for sample in F::samples() {
        let kind = sample.kind();
        let mut problem = Problem::from_toml(SOUND, None).unwrap();
        place(&mut problem, sample);
        let text = problem.to_toml().unwrap();
        let unknown = problem.check().into_iter().map(|f| f.message);
        let unknown: Vec<String> = unknown.filter(|m| m.contains("unknown key")).collect();
        assert_eq!(unknown, Vec::<String>::new(), "{} {kind}", F::KEY);
        let table: toml::Table = text.parse().unwrap();
        let back: Problem = table.try_into().unwrap();
        assert_eq!(back, problem, "{} {kind}", F::KEY);
        let table: toml::Table = brief_toml(&problem).unwrap().parse().unwrap();
        let back: Problem = table.try_into().unwrap();
        assert_eq!(back, problem, "{} {kind}, in brief", F::KEY);
    }
}

#[test]
fn every_model_survives_the_way_to_text_and_back() {
    fn base(problem: &mut Problem) -> &mut Interface {
        problem.interface.get_mut("base").unwrap()
    }
    survives(|p, generator| {
        p.body.get_mut("block").unwrap().mesh = MeshSource::Generate(generator);
    });
    survives(|p, material: stickslip::material::Material| {
        p.material.insert("steel".into(), Material::from(material));
    });
    survives(|p, shape| {
        p.obstacle.get_mut("floor").unwrap().shape = shape;
    });
    survives(|p, normal| base(p).normal = normal);
    survives(|p, damping| base(p).damping = damping);
    survives(|p, friction| base(p).friction = friction);
    survives(|p, slip| base(p).slip = slip);
    survives(|p, enforcement| base(p).enforcement = enforcement);
    survives(|p, kinematics| base(p).kinematics = kinematics);
    survives(|p, kind| {
        let load = Load {
            set: "block.top".into(),
            amplitude: None,
            follow: false,
            kind,
        };
        p.load.insert("push".into(), load);
    });
    survives(|p, kind| {
        let temperature = Temperature {
            set: "block.top".into(),
            amplitude: None,
            kind,
        };
        p.temperature.insert("warm".into(), temperature);
    });
}

#[test]
fn every_family_is_listed() {
    let schema = schema().to_string();
    for family in families() {
        assert!(!family.entries.is_empty());
        for entry in family.entries {
            let key = format!("\"{}\":", entry.name);
            assert!(schema.contains(&key), "{} {}", family.key, entry.name);
        }
    }
}

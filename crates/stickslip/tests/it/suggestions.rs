//! A number, a word or a list where a table is wanted: the finding has file, line and key, and its help is a key that exists.

use serde_json::Value;
use stickslip::error::{Diagnostic, ProblemError, line_column};
use stickslip::problem::{Document, schema};

/// Stands for a name of the user's own.
const OWN: &str = "some";

/// Stands for an entry of a list.
const ENTRY: &str = "1";

/// What people write where a table is wanted.
const WRITTEN: [&str; 7] = [
    "5",
    "0.3",
    "-1.5",
    "true",
    "\"word\"",
    "[0, -10]",
    "[\"a.b\"]",
];

/// References, and the `X or null` of optional keys, resolved.
fn resolved<'s>(root: &'s Value, mut schema: &'s Value) -> &'s Value {
    loop {
        let some = |all: &'s Value| all.as_array()?.iter().find(|s| s["type"] != "null");
        let next = match schema["$ref"].as_str() {
            Some(path) => root.pointer(path.trim_start_matches('#')),
            None => some(&schema["anyOf"]),
        };
        match next {
            Some(next) => schema = next,
            None => return schema,
        }
    }
}

fn is(schema: &Value, kind: &str) -> bool {
    match &schema["type"] {
        Value::Array(all) => all.iter().any(|t| t == kind),
        one => one == kind,
    }
}

/// Keys of a table with what they want, kinds among them.
fn keys(schema: &Value) -> Vec<(String, &Value)> {
    let alternatives = schema["oneOf"].as_array().into_iter().flatten();
    let all = std::iter::once(schema).chain(alternatives);
    let all = all.filter_map(|s| s["properties"].as_object()).flatten();
    let mut keys: Vec<_> = all.map(|(key, schema)| (key.clone(), schema)).collect();
    if schema["additionalProperties"].is_object() {
        keys.push((OWN.into(), &schema["additionalProperties"]));
    }
    keys
}

/// The paths of all keys that take a table, or a list of tables.
fn tables(root: &Value) -> Vec<Vec<String>> {
    let mut out = Vec::new();
    let mut open = vec![(Vec::<String>::new(), root)];
    while let Some((path, schema)) = open.pop() {
        let schema = resolved(root, schema);
        let entries = resolved(root, &schema["items"]);
        let below = match is(schema, "array") {
            true if is(entries, "object") => {
                out.push(path.clone());
                vec![(ENTRY.to_string(), entries)]
            }
            true => continue,
            false => keys(schema),
        };
        if below.is_empty() && !is(schema, "object") {
            continue;
        }
        if !path.is_empty() && !is(schema, "array") {
            out.push(path.clone());
        }
        for (key, schema) in below {
            open.push(([path.as_slice(), &[key]].concat(), schema));
        }
    }
    out
}

/// `text` with a path in front of it: entries of lists stand in brackets.
fn behind(path: &[String], text: &str) -> String {
    let Some((key, rest)) = path.split_first() else {
        return text.to_string();
    };
    if rest.is_empty() && text.starts_with("= ") {
        return format!("{key} {text}");
    }
    match rest.split_first() {
        Some((entry, [])) if entry == ENTRY && text.starts_with("= ") => {
            format!("{key} = [{}]", &text[2..])
        }
        Some((entry, below)) if entry == ENTRY => {
            format!("{key} = [{{ {} }}]", behind(below, text))
        }
        _ => format!("{key}.{}", behind(rest, text)),
    }
}

fn findings(line: &str) -> ProblemError {
    let text = format!("format = 1\n{line}\n");
    let document = Document::new(text, Some(std::path::Path::new("case.toml")));
    document.problem().expect_err("most is missing")
}

/// The first example in a help: `key = value`.
fn example(help: &str) -> Option<&str> {
    let mut code = help.split('`').skip(1).step_by(2);
    code.find(|text| text.contains(" = "))
}

/// What is wrong with the help of a finding, if anything is.
fn fault(path: &[String], finding: &Diagnostic) -> Option<String> {
    let help = finding.help.as_deref().unwrap_or("");
    let Some(example) = example(help) else {
        return Some(format!("no example: {help}"));
    };
    let applied = example.replace('…', "0").replace("NAME", OWN);
    // It begins where the value stands, or above it where names need their kind.
    let first = applied.split(['.', ' ']).next().unwrap_or("");
    let Some(above) = path.iter().rposition(|key| key == first) else {
        return Some(format!("it belongs nowhere: {help}"));
    };
    let line = behind(&path[..above], &applied);
    let open = example.contains('…');
    let here = path.join(".");
    let wrong = findings(&line).findings.into_iter().find(|f| {
        let unknown = f.message.starts_with("unknown key") || f.message.contains("not TOML");
        let refused = f.message.starts_with("expected");
        unknown || refused && (f.key == here || !open && f.key.starts_with(&here))
    });
    wrong.map(|f| format!("{help}\n    {line}: {} {}", f.key, f.message))
}

#[test]
fn every_key_that_takes_a_table_says_where_a_value_belongs() {
    let root = schema();
    let tables = tables(&root);
    assert!(tables.len() > 100, "only {} tables", tables.len());
    let mut faults = Vec::new();
    for path in &tables {
        for written in WRITTEN {
            let line = behind(path, &format!("= {written}"));
            let error = findings(&line);
            let mut mine = error.findings.iter();
            let key = path.join(".");
            let Some(finding) = mine.find(|f| f.key == key && f.message.starts_with("expected"))
            else {
                // A list may be what is wanted, and its entries are not.
                let below = |f: &Diagnostic| f.key.starts_with(&format!("{key}."));
                // Some words are, and all of them are listed.
                let listed = |f: &Diagnostic| {
                    let help = f.help.as_deref().unwrap_or("");
                    f.key == key
                        && f.message.ends_with("is not known here")
                        && help.starts_with("allowed: ")
                };
                if !error.findings.iter().any(|f| below(f) || listed(f)) {
                    faults.push(format!("{line}: {:?}", error.findings));
                }
                continue;
            };
            assert!(error.file.is_some());
            let place = finding
                .span
                .as_ref()
                .map(|s| line_column(&error.source, s.start).0);
            assert_eq!(place, Some(2), "{line}");
            faults.extend(fault(path, finding).map(|why| format!("{line}: {why}")));
        }
    }
    assert!(faults.is_empty(), "{}\n{}", faults.len(), faults.join("\n"));
}

/// What is written, and how the help of its finding begins.
const SAYS: &[(&str, &str)] = &[
    (
        "load.a.traction = [0, -10]",
        "write `traction.value = [0, -10]`",
    ),
    ("load.a.pressure = 5", "write `pressure.value = 5`"),
    (
        "load.a.gravity = 9.81",
        "write `gravity.acceleration = [0, -9.81]`",
    ),
    (
        "interface.a.friction = 0.3",
        "write `friction.coulomb.mu = 0.3`",
    ),
    ("interface.a.mu = 0.3", "write `friction.coulomb.mu = 0.3`"),
    (
        "interface.a.wear = 1e-9",
        "write `wear.archard.coefficient = 1e-9`",
    ),
    (
        "interface.a.gap = 0.1",
        "the initial gap follows from the meshes",
    ),
    (
        "support.a.set = [\"b.left\", \"b.right\"]",
        "one set is wanted here: join several by `set.all.union = [\"b.left\", \"b.right\"]`, and write `set = \"all\"`",
    ),
    (
        "interface.a.kinematics = \"small\"",
        "the kind is a key: `kinematics.",
    ),
    (
        "step = [{ increments = 10 }]",
        "write `increments.fixed = 10`",
    ),
    (
        "step = [{ increments = 0.1 }]",
        "write `increments.initial = 0.1`",
    ),
    (
        "step = [{ dynamic = \"newmark\" }]",
        "write `dynamic.scheme.newmark = {}`",
    ),
    ("step = 5", "write `step = [{ duration = 5 }]`"),
    (
        "step.duration = 5",
        "it is a list of tables: write `[[step]]`",
    ),
    (
        "material.young = 5.0",
        "a name stands between the two: write `material.NAME.isotropic = { young = 5.0, poisson = … }`",
    ),
    (
        "material.steel.young = 5.0",
        "write `isotropic = { young = 5.0, poisson = … }`",
    ),
    (
        "body.a.young = 5.0",
        "it belongs elsewhere: `material.NAME.isotropic = { young = 5.0, poisson = … }`",
    ),
    (
        "young = 5.0",
        "write `material.NAME.isotropic = { young = 5.0, poisson = … }`",
    ),
    (
        "gravity = 9.81",
        "write `load.NAME = { set = …, gravity.acceleration = [0, -9.81] }`",
    ),
    (
        "model = \"plane-strain\"",
        "write `model.space = \"plane-strain\"`",
    ),
    ("output = 5", "write `output.every = 5`"),
    ("model.space = \"3d\"", "three dimensions are `solid`"),
    ("model.space = \"2d\"", "two dimensions are `plane-strain`"),
    (
        "material.steel.elastic = { young = 1.0 }",
        "linear elasticity is `isotropic",
    ),
    (
        "material.steel.plastic = { yield = 1.0 }",
        "bodies are linear elastic: there is no plasticity",
    ),
    (
        "material.steel.neo-hooke = { c = 1.0 }",
        "bodies are linear elastic, with small strains",
    ),
    (
        "material.steel.isotropic.conductivity = 1.0",
        "there is no heat conduction",
    ),
    (
        "support.a.fixed = true",
        "a support prescribes displacements",
    ),
    ("support.a.u2 = 0", "displacements are `x`, `y` and `z`"),
    ("support.a.force = 3", "forces and pressures are loads"),
    ("body.a.shell = { thickness = 1 }", "bodies are solids"),
    (
        "material.steel.isotropic.young = \"210 GPa\"",
        "numbers have no units: any consistent set will do; in metres, kilograms and seconds this is 210e9",
    ),
    (
        "model.thickness = \"5mm\"",
        "numbers have no units: any consistent set will do; in metres, kilograms and seconds this is 0.005",
    ),
];

#[test]
fn what_people_write_is_answered_by_what_they_mean() {
    for (line, says) in SAYS {
        let error = findings(line);
        let helps = error.findings.iter().filter_map(|f| f.help.as_deref());
        let helps: Vec<&str> = helps.collect();
        let said = helps.iter().any(|help| help.starts_with(says));
        assert!(said, "{line}: {helps:#?}");
    }
}

/// The beginning of a file, its name, and what it is called.
const FILES: &[(&str, &str, &str, &str)] = &[
    (
        "hole.msh",
        "$MeshFormat\n4.1 0 8\n",
        "a mesh of Gmsh",
        "body.NAME.gmsh.file",
    ),
    (
        "job.inp",
        "*HEADING\n",
        "an input deck",
        "stickslip convert",
    ),
    (
        "fields.vtu",
        "<?xml version=\"1.0\"?>\n",
        "a file in XML",
        "stickslip plot",
    ),
    (
        "old.vtk",
        "# vtk DataFile Version 3.0\n",
        "a file of the old VTK format",
        ".vtu",
    ),
    (
        "summary.json",
        "{ \"title\": 1 }\n",
        "a file in JSON",
        "stickslip explain",
    ),
    ("run.py", "# a script\nx = 1\n", "a Python script", "python"),
    ("other", "import stickslip\n", "a Python script", "python"),
    ("part.stl", "solid part\n", "a surface in STL", "Gmsh"),
    ("part.step", "ISO-10303-21;\n", "a geometry in STEP", "Gmsh"),
];

#[test]
fn files_of_other_kinds_are_named_with_what_takes_them() {
    let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("suggestions");
    std::fs::create_dir_all(&folder).expect("a folder");
    for (name, text, what, help) in FILES {
        let file = folder.join(name);
        std::fs::write(&file, text).expect("a file");
        let Err(stickslip::Error::Problem(error)) = Document::read(&file) else {
            panic!("{name} is read");
        };
        let finding = &error.findings[0];
        assert!(finding.message.contains(what), "{name}: {finding:?}");
        let said = finding.help.as_deref().unwrap_or("");
        assert!(said.contains(help), "{name}: {said}");
    }
    let results = folder.join("case.out");
    std::fs::create_dir_all(&results).expect("a folder");
    std::fs::write(results.join("summary.json"), "{}").expect("a file");
    let error = Document::read(&results).expect_err("a folder").to_string();
    assert!(error.contains("this is a folder of results"), "{error}");
}

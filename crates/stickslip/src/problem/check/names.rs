//! Names that are used must exist, and mean one thing.

use std::collections::{BTreeMap, BTreeSet};

use super::super::key;
use super::super::nearest::suggest;
use super::super::{Problem, Section, Select};
use super::findings::Findings;
use crate::registry::Family;

pub(super) fn check(problem: &Problem, findings: &mut Findings) {
    spelled(problem, findings);
    declared(problem, findings);
    bodies(problem, findings);
    sets(problem, findings);
    interfaces(problem, findings);
    for (name, support) in &problem.support {
        points(problem, findings, &["support", name, "set"], &support.set);
        let key = ["support", name, "amplitude"];
        one_of(
            findings,
            &key,
            support.amplitude.as_deref(),
            "amplitudes",
            &problem.amplitude,
        );
    }
    for (name, load) in &problem.load {
        points(problem, findings, &["load", name, "set"], &load.set);
        let key = ["load", name, "amplitude"];
        one_of(
            findings,
            &key,
            load.amplitude.as_deref(),
            "amplitudes",
            &problem.amplitude,
        );
    }
    for (name, temperature) in &problem.temperature {
        let key = |last| ["temperature", name, last];
        set(problem, findings, &key("set"), &temperature.set);
        one_of(
            findings,
            &key("amplitude"),
            temperature.amplitude.as_deref(),
            "amplitudes",
            &problem.amplitude,
        );
    }
    for (name, coupling) in &problem.coupling {
        let kind = coupling.kind.kind();
        for (below, named) in coupling.kind.as_dyn().sets() {
            let mut key = vec!["coupling", name.as_str(), kind];
            key.extend(below.split('.'));
            points(problem, findings, &key, named);
        }
        let key = ["coupling", name, "amplitude"];
        one_of(
            findings,
            &key,
            coupling.amplitude.as_deref(),
            "amplitudes",
            &problem.amplitude,
        );
    }
    for (name, pretension) in &problem.pretension {
        if let Some(of) = &pretension.of {
            set(problem, findings, &["pretension", name, "of"], of);
        }
        if let Section::Facets(facets) = &pretension.section {
            let key = ["pretension", name, "facets", "set"];
            set(problem, findings, &key, &facets.set);
        }
    }
    for (name, mass) in &problem.mass {
        points(problem, findings, &["mass", name, "set"], &mass.set);
    }
    for (name, initial) in &problem.initial {
        points(problem, findings, &["initial", name, "set"], &initial.set);
    }
    probes(problem, findings);
}

/// Most characters of a name: with what is put before and behind it, it stays a name of a file everywhere.
const LONGEST_NAME: usize = 100;

/// Tables whose names begin names of columns.
const COLUMN_TABLES: [&str; 7] = [
    "body",
    "reference",
    "interface",
    "support",
    "coupling",
    "pretension",
    "probe",
];

/// What a spreadsheet takes for the beginning of a formula, which may run programs.
const FORMULA: [char; 4] = ['=', '+', '-', '@'];

/// Why a text cannot be a name, and what could: names become names of files, of columns and of sets, on all systems.
fn misspelled(name: &str) -> Option<&'static str> {
    let wrong = |c: char| c.is_control() || r#"/\<>:"|?*"#.contains(c);
    if name.trim().is_empty() {
        Some("it is empty")
    } else if name.chars().count() > LONGEST_NAME {
        Some("it has more than 100 characters")
    } else if name.starts_with('.') || name.ends_with('.') {
        Some("it begins or ends with a dot")
    } else if name.trim() != name {
        Some("it begins or ends with a blank")
    } else if name.contains(wrong) {
        Some(r#"it has one of / \ < > : " | ? * or a control character"#)
    } else {
        None
    }
}

/// All names of tables; those that differ by nothing but capitals are one name on some file systems, and in decks.
fn spelled(problem: &Problem, findings: &mut Findings) {
    let tables: [(&str, Vec<&String>); 15] = [
        ("body", problem.body.keys().collect()),
        ("material", problem.material.keys().collect()),
        ("obstacle", problem.obstacle.keys().collect()),
        ("set", problem.set.keys().collect()),
        ("reference", problem.reference.keys().collect()),
        ("interface", problem.interface.keys().collect()),
        ("support", problem.support.keys().collect()),
        ("load", problem.load.keys().collect()),
        ("temperature", problem.temperature.keys().collect()),
        ("mass", problem.mass.keys().collect()),
        ("coupling", problem.coupling.keys().collect()),
        ("pretension", problem.pretension.keys().collect()),
        ("amplitude", problem.amplitude.keys().collect()),
        ("initial", problem.initial.keys().collect()),
        ("probe", problem.probe.keys().collect()),
    ];
    for (table, names) in tables {
        let mut seen: BTreeMap<String, &str> = BTreeMap::new();
        for name in names {
            let formula = COLUMN_TABLES.contains(&table) && name.starts_with(FORMULA);
            let why = formula.then_some("it begins with = + - or @, and a spreadsheet takes a column of that name for a formula");
            if let Some(why) = misspelled(name).or(why) {
                let article = match table.starts_with(['a', 'e', 'i', 'o', 'u']) {
                    true => "an",
                    false => "a",
                };
                findings.add(
                    &[table, name],
                    format!(
                        "`{}` cannot be the name of {article} {table}: {why}",
                        name.escape_debug()
                    ),
                    "letters, digits, - and _ make good names",
                );
            }
            if let Some(other) = seen.insert(name.to_lowercase(), name) {
                findings.add(
                    &[table, name],
                    format!("`{other}` and `{name}` differ by nothing but capitals"),
                    "give them different names",
                );
            }
        }
    }
    // Steps are only talked about.
    for (i, step) in problem.step.iter().enumerate() {
        let name = step.name.as_deref().unwrap_or("step");
        if name.is_empty() || name.chars().count() > LONGEST_NAME || name.contains(char::is_control)
        {
            let key = ["step", &key::entry(i), "name"];
            let message = format!("`{}` cannot be the name of a step", name.escape_debug());
            findings.add(&key, message, "give it 1 to 100 printable characters");
        }
    }
}

/// Bodies, obstacles, sets and reference points share their names: `set = "block"` and `primary = "floor"` look into all of them.
fn declared(problem: &Problem, findings: &mut Findings) {
    let shared: [(&str, Vec<&String>); 4] = [
        ("body", problem.body.keys().collect()),
        ("obstacle", problem.obstacle.keys().collect()),
        ("set", problem.set.keys().collect()),
        ("reference", problem.reference.keys().collect()),
    ];
    let mut seen: BTreeMap<&str, &str> = BTreeMap::new();
    for (table, names) in &shared {
        for name in names {
            match seen.get(name.as_str()) {
                Some(other) => findings.add(
                    &[table, name],
                    format!("`{name}` is the name of a {other} already"),
                    "bodies, obstacles, sets and reference points need names of their own",
                ),
                None => {
                    seen.insert(name, table);
                }
            }
            if name.is_empty() || name.contains('.') {
                findings.add(
                    &[table, name],
                    format!("`{name}` cannot be the name of a {table}"),
                    "a name is not empty and has no dot: the dot separates a body from its sets",
                );
            }
        }
    }
}

fn bodies(problem: &Problem, findings: &mut Findings) {
    if problem.body.is_empty() {
        findings.add(&[], "there is no body", "add a table [body.NAME]");
    }
    for (name, body) in &problem.body {
        if body.material.is_none() && body.regions.is_empty() {
            let help = match problem.material.keys().next() {
                Some(material) => format!("add material = \"{material}\""),
                None => "add material = \"NAME\" and a table [material.NAME]".into(),
            };
            findings.add(
                &["body", name],
                format!("the body `{name}` has no material"),
                help,
            );
        }
        let key = ["body", name, "material"];
        one_of(
            findings,
            &key,
            body.material.as_deref(),
            "materials",
            &problem.material,
        );
        for (region, material) in &body.regions {
            let key = ["body", name, "regions", region];
            one_of(
                findings,
                &key,
                Some(material),
                "materials",
                &problem.material,
            );
        }
    }
}

fn sets(problem: &Problem, findings: &mut Findings) {
    for (name, set) in &problem.set {
        if let Select::Union(parts) = &set.select {
            for (i, part) in parts.iter().enumerate() {
                self::set(
                    problem,
                    findings,
                    &["set", name, "union", &key::entry(i)],
                    part,
                );
            }
            if parts.is_empty() {
                findings.add(&["set", name, "union"], "a union of nothing", "");
            }
            if reaches(problem, name, name, &mut BTreeSet::new()) {
                let message = format!("the set `{name}` is a part of itself");
                findings.add(&["set", name, "union"], message, "");
            }
            if set.of.is_some() {
                findings.add(
                    &["set", name, "of"],
                    "a union has no `of`",
                    "remove the key",
                );
            }
        } else if let Some(of) = &set.of {
            let key = ["set", name, "of"];
            if of.contains('.') {
                self::set(problem, findings, &key, of);
            } else {
                one_of(findings, &key, Some(of), "bodies", &problem.body);
            }
        } else {
            let help = match problem.body.keys().next() {
                Some(body) => format!("add of = \"{body}\", or of = \"{body}.SET\""),
                None => String::new(),
            };
            let message = format!("the set `{name}` does not say of which body it is");
            findings.add(&["set", name], message, help);
        }
    }
}

/// Whether the union `from` contains the set `target`, directly or not.
fn reaches<'p>(
    problem: &'p Problem,
    from: &'p str,
    target: &str,
    seen: &mut BTreeSet<&'p str>,
) -> bool {
    let Some(Select::Union(parts)) = problem.set.get(from).map(|s| &s.select) else {
        return false;
    };
    parts
        .iter()
        .any(|part| part == target || (seen.insert(part) && reaches(problem, part, target, seen)))
}

fn interfaces(problem: &Problem, findings: &mut Findings) {
    for (name, interface) in &problem.interface {
        let key = |side| ["interface", name.as_str(), side];
        if problem.obstacle.contains_key(&interface.secondary) {
            findings.add(
                &key("secondary"),
                format!(
                    "`{}` is an obstacle, and obstacles are primary",
                    interface.secondary
                ),
                "swap secondary and primary",
            );
        } else {
            set(problem, findings, &key("secondary"), &interface.secondary);
        }
        if !problem.obstacle.contains_key(&interface.primary) {
            let obstacles: Vec<&str> = problem.obstacle.keys().map(String::as_str).collect();
            let at = &key("primary");
            set_among(problem, findings, at, &interface.primary, &obstacles);
        }
        if let Some(points) = &interface.initial_set {
            set(problem, findings, &key("initial-set"), points);
        }
        if interface.primary == interface.secondary {
            findings.add(
                &key("primary"),
                "primary and secondary are the same surface",
                "a surface in contact with itself is two interfaces' worth of sets: divide it",
            );
        }
    }
}

fn probes(problem: &Problem, findings: &mut Findings) {
    for (name, probe) in &problem.probe {
        let key = ["probe", name, "of"];
        one_of(findings, &key, probe.of.as_deref(), "bodies", &problem.body);
    }
}

/// `name`, if given, must be a key of `table`.
pub(super) fn one_of<T>(
    findings: &mut Findings,
    key: &[&str],
    name: Option<&str>,
    what: &str,
    table: &BTreeMap<String, T>,
) {
    let Some(name) = name.filter(|n| !table.contains_key(*n)) else {
        return;
    };
    let names: Vec<&str> = table.keys().map(String::as_str).collect();
    let message = format!("`{name}` is not among the {what}");
    findings.add(key, message, suggest(name, what, &names));
}

/// `name` must be a set, a body, `body.set`, or a reference point.
fn points(problem: &Problem, findings: &mut Findings, key: &[&str], name: &str) {
    if !problem.reference.contains_key(name) {
        set(problem, findings, key, name);
    }
}

/// `name` must be a set, a body, or `body.set`; whether the mesh has the set is not known here.
pub(super) fn set(problem: &Problem, findings: &mut Findings, key: &[&str], name: &str) {
    set_among(problem, findings, key, name, &[]);
}

/// The same where obstacles may be meant as well.
fn set_among(
    problem: &Problem,
    findings: &mut Findings,
    key: &[&str],
    name: &str,
    obstacles: &[&str],
) {
    match name.split_once('.') {
        Some((body, set)) => {
            if set.is_empty() {
                findings.add(key, format!("`{name}` names no set after the dot"), "");
            }
            one_of(findings, key, Some(body), "bodies", &problem.body);
        }
        None if problem.set.contains_key(name) || problem.body.contains_key(name) => {}
        None => {
            let mut names: Vec<&str> = problem.set.keys().map(String::as_str).collect();
            names.extend(problem.body.keys().map(String::as_str));
            names.extend(obstacles);
            names.extend(problem.reference.keys().map(String::as_str));
            let (what, all) = match obstacles.is_empty() {
                true => ("set or body", "sets and bodies"),
                false => ("set, body or obstacle", "sets, bodies and obstacles"),
            };
            let help = suggest(name, all, &names);
            findings.add(
                key,
                format!("there is no {what} `{name}`"),
                format!("{help}; sets of a mesh are written body.set"),
            );
        }
    }
}

//! What was solved: the tables of the problem as it was run.

use serde_json::Value as Json;
use toml::{Table, Value};

use super::escape::text;
use crate::results::Results;
use stickslip::number::figure;

/// The tables that are shown, in this order, with what they are.
const TABLES: &[(&str, &str)] = &[
    ("body", "Bodies"),
    ("material", "Materials"),
    ("obstacle", "Obstacles"),
    ("interface", "Interfaces"),
    ("support", "Supports"),
    ("load", "Loads"),
    ("initial", "Initial conditions"),
    ("amplitude", "Amplitudes"),
    ("probe", "Probes"),
];

/// Entries that are lists of more numbers than this are cut.
const LONG: usize = 12;

/// Text of a problem longer than this many bytes is not repeated in the page.
const LONGEST_TEXT: usize = 200_000;

/// The section.
pub fn section(results: &Results) -> String {
    let problem = &results.problem;
    if problem.is_empty() {
        return "<p class=\"quiet\">The folder has no problem.toml, so this is not known.</p>\n"
            .into();
    }
    let schema = stickslip::problem::schema();
    let mut out = String::new();
    let space = problem.get("model").and_then(|m| m.get("space"));
    if let Some(space) = space.and_then(Value::as_str) {
        out += &format!("<p>Space: <b>{}</b></p>\n", text(space));
    }
    out += "<div class=\"cards\">\n";
    for (key, heading) in TABLES {
        if let Some(table) = problem.get(*key).and_then(Value::as_table) {
            for (name, value) in table {
                let kind = heading.trim_end_matches('s').replace("Bodie", "Body");
                out += &card(&schema, &[key, name], &kind, name, value);
            }
        }
    }
    let steps = problem.get("step").and_then(Value::as_array);
    for (i, step) in steps.into_iter().flatten().enumerate() {
        let name = step.get("name").and_then(Value::as_str);
        let name = name.map_or_else(|| (i + 1).to_string(), str::to_string);
        out += &card(
            &schema,
            &["step", "1"],
            &format!("Step {}", i + 1),
            &name,
            step,
        );
    }
    for (key, heading) in [("solver", "Solver"), ("quality", "Quality limits")] {
        if let Some(value) = problem.get(key) {
            out += &card(&schema, &[key], heading, "", value);
        }
    }
    out += "</div>\n";
    if results.problem_text.len() <= LONGEST_TEXT {
        out += &format!(
            "<details><summary>The whole problem file</summary><pre class=\"source\" tabindex=\"0\">{}</pre></details>\n",
            text(&results.problem_text)
        );
    }
    out
}

/// One table, its entries a row each.
fn card(schema: &Json, path: &[&str], kind: &str, name: &str, value: &Value) -> String {
    let Value::Table(table) = value else {
        return String::new();
    };
    let mut rows = Vec::new();
    let mut at: Vec<String> = path.iter().map(|p| p.to_string()).collect();
    flatten(table, &mut at, path.len(), schema, &mut rows);
    if rows.is_empty() {
        return String::new();
    }
    let rows: String = rows
        .iter()
        .map(|row| {
            format!(
                "<tr><th scope=\"row\" title=\"{}\">{}</th><td>{}</td></tr>",
                text(&row.words),
                text(&row.key),
                text(&row.value),
            )
        })
        .collect();
    format!(
        "<article class=\"card\"><h3><span class=\"kind\">{kind}</span> {}</h3><table>{rows}</table></article>\n",
        text(name)
    )
}

struct Row {
    key: String,
    value: String,
    words: String,
}

fn flatten(table: &Table, at: &mut Vec<String>, skip: usize, schema: &Json, rows: &mut Vec<Row>) {
    for (key, value) in table {
        at.push(key.clone());
        match value {
            Value::Table(inner) if chosen(inner).is_some() => {
                // A model without parameters is a choice, not a yes: `normal: unilateral`.
                let model = chosen(inner).unwrap_or_default();
                at.push(model.to_string());
                let words = describe(schema, at).and_then(|e| e.get("description"));
                let words = words.and_then(Json::as_str).unwrap_or_default();
                at.pop();
                rows.push(Row {
                    key: at[skip..].join(" › ").replace('-', " "),
                    value: model.replace('-', " "),
                    words: without_units(words),
                });
            }
            Value::Table(inner) if !inner.is_empty() => flatten(inner, at, skip, schema, rows),
            _ => {
                let entry = describe(schema, at);
                // What has its default needs no row.
                let plain = entry.and_then(|e| e.get("default")).map(from_json);
                if plain.as_ref() != Some(value) && !(key == "name" && skip + 1 == at.len()) {
                    let words = entry.and_then(|e| e.get("description"));
                    let words = words.and_then(Json::as_str).unwrap_or_default();
                    rows.push(Row {
                        key: at[skip..].join(" › ").replace('-', " "),
                        value: shown(value),
                        words: without_units(words),
                    });
                }
            }
        }
        at.pop();
    }
}

/// The name of the only entry of a table, if that has nothing in it.
fn chosen(table: &Table) -> Option<&str> {
    let mut entries = table.iter();
    match (entries.next(), entries.next()) {
        (Some((name, Value::Table(inner))), None) if inner.is_empty() => Some(name),
        _ => None,
    }
}

/// The part of a schema about the value at a path.
fn describe<'a>(schema: &'a Json, path: &[String]) -> Option<&'a Json> {
    walk(schema, schema, path, 0)
}

fn walk<'a>(root: &'a Json, node: &'a Json, path: &[String], depth: usize) -> Option<&'a Json> {
    if depth > 40 {
        return None;
    }
    if let Some(name) = node["$ref"].as_str() {
        let target = root.pointer(name.trim_start_matches('#'))?;
        // What stands beside a reference says more of this place than its target.
        if path.is_empty() && node.get("description").is_some() {
            return Some(node);
        }
        return walk(root, target, path, depth + 1);
    }
    let Some((first, rest)) = path.split_first() else {
        return Some(node);
    };
    let down = |next: &'a Json| walk(root, next, rest, depth + 1);
    if let Some(found) = node["properties"].get(first).and_then(down) {
        return Some(found);
    }
    if let Some(found) = node.get("additionalProperties").filter(|n| n.is_object())
        && let Some(found) = down(found)
    {
        return Some(found);
    }
    if let Some(found) = node.get("items").and_then(down) {
        return Some(found);
    }
    ["oneOf", "anyOf", "allOf"]
        .iter()
        .filter_map(|key| node[*key].as_array())
        .flatten()
        .find_map(|next| walk(root, next, path, depth + 1))
}

/// A description without the units in brackets, which are those of SI, and not of the problem: `Young's modulus [Pa]`. Brackets with commas, names of tables or much text
/// are no units.
fn without_units(words: &str) -> String {
    let words = words.replace('`', "");
    let (mut out, mut rest) = (String::new(), words.as_str());
    while let Some((before, (inside, behind))) = rest
        .split_once(" [")
        .and_then(|(before, after)| Some((before, after.split_once(']')?)))
    {
        out += before;
        let other = inside.len() > 24 || inside.contains([',', '_']) || inside.contains("NAME");
        if other {
            out += &format!(" [{inside}]");
        }
        rest = behind;
    }
    out + rest
}

fn shown(value: &Value) -> String {
    match value {
        Value::String(s) => s.clone(),
        Value::Float(f) => figure(*f),
        Value::Array(list) => {
            let mut items: Vec<String> = list.iter().take(LONG).map(shown).collect();
            if list.len() > LONG {
                items.push(format!("… ({} in all)", list.len()));
            }
            match list.iter().any(Value::is_array) {
                true => items
                    .iter()
                    .map(|i| format!("({i})"))
                    .collect::<Vec<_>>()
                    .join(" "),
                false => items.join(", "),
            }
        }
        Value::Table(inner) if inner.is_empty() => "yes".into(),
        Value::Table(inner) => {
            let items: Vec<String> = inner
                .iter()
                .map(|(k, v)| format!("{k} {}", shown(v)))
                .collect();
            items.join("; ")
        }
        Value::Boolean(true) => "yes".into(),
        Value::Boolean(false) => "no".into(),
        other => other.to_string(),
    }
}

/// A default of the schema as TOML has it.
fn from_json(value: &Json) -> Value {
    match value {
        Json::Bool(b) => Value::Boolean(*b),
        Json::Number(n) => match n.as_i64() {
            Some(i) => Value::Integer(i),
            None => Value::Float(n.as_f64().unwrap_or(f64::NAN)),
        },
        Json::String(s) => Value::String(s.clone()),
        Json::Array(list) => Value::Array(list.iter().map(from_json).collect()),
        _ => Value::Table(Table::new()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_value_is_found_in_the_schema_and_no_unit_is_said() {
        let schema = stickslip::problem::schema();
        let find = |path: &str| {
            let path: Vec<String> = path.split('.').map(str::to_string).collect();
            let found = describe(&schema, &path)?["description"].as_str()?;
            Some(without_units(found))
        };
        let young = find("material.x.isotropic.young").expect("it is described");
        assert!(young.contains("Young") && !young.contains("Pa"), "{young}");
        assert!(find("interface.x.friction.coulomb.mu").is_some());
        assert!(find("interface.x.friction.coulomb.no").is_none());
        assert!(find("step.1.duration").is_some());
    }

    #[test]
    fn a_model_without_parameters_is_named() {
        let table: Table = "normal.unilateral = {}\nfriction.coulomb.mu = 0.3"
            .parse()
            .unwrap();
        let (mut rows, mut at) = (Vec::new(), vec!["interface".into(), "x".into()]);
        flatten(&table, &mut at, 2, &stickslip::problem::schema(), &mut rows);
        let shown: Vec<String> = rows
            .iter()
            .map(|r| format!("{}: {}", r.key, r.value))
            .collect();
        assert!(
            shown.contains(&"normal: unilateral".to_string()),
            "{shown:?}"
        );
        assert!(
            shown.contains(&"friction › coulomb › mu: 0.3".to_string()),
            "{shown:?}"
        );
    }

    #[test]
    fn long_lists_are_cut() {
        let list = |n: i64| Value::Array((0..n).map(Value::Integer).collect());
        assert_eq!(shown(&list(3)), "0, 1, 2");
        assert!(shown(&list(100)).ends_with("… (100 in all)"));
        let pairs = Value::Array(vec![list(2), list(2)]);
        assert_eq!(shown(&pairs), "(0, 1) (0, 1)");
    }
}

use std::process::ExitCode;

use serde_json::Value;
use stickslip::model::capability::matrix;
use stickslip::problem::{FamilyListing, families, nearest};

use super::completions::Words;
use crate::failure::{Failure, Outcome};
use crate::print;

/// Width of the printed text in characters.
const WIDTH: usize = 100;

/// List model families and their entries, or the parameters of one entry.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// A family (`friction`), an entry (`coulomb`), or both (`friction.coulomb`).
    #[arg(value_parser = Words(names), hide_possible_values = true)]
    name: Option<String>,
    /// Print which steps, methods, loads and supports work with which kinds of bodies.
    #[arg(long, conflicts_with = "name")]
    matrix: bool,
}

/// Families and entries, for completions.
fn names() -> Vec<&'static str> {
    let mut names: Vec<&str> = Vec::new();
    for family in families() {
        names.push(family.key);
        names.extend(family.entries.iter().map(|e| e.name));
    }
    names.sort_unstable();
    names.dedup();
    names
}

/// Prints the listing.
pub fn run(arguments: &Arguments) -> Outcome {
    if arguments.matrix {
        print::out(&matrix())?;
        return Ok(ExitCode::SUCCESS);
    }
    let families = families();
    let Some(name) = &arguments.name else {
        let text: Vec<String> = families.iter().map(family).collect();
        print::out(
            &(text.join("\n") + "\n`stickslip models NAME` prints the parameters of one.\n"),
        )?;
        return Ok(ExitCode::SUCCESS);
    };
    let (wanted_family, wanted_entry) = match name.split_once('.') {
        Some((family, entry)) => (Some(family), entry),
        None => (None, name.as_str()),
    };
    let mut text = Vec::new();
    for listing in &families {
        if wanted_family.is_none() && listing.key == name {
            text.push(family(listing));
        }
        for entry in &listing.entries {
            let here = wanted_family.is_none_or(|f| f == listing.key);
            let all = wanted_family.is_none() && listing.key == name;
            if all || here && entry.name == wanted_entry {
                let name = format!("{}.{}", listing.key, entry.name);
                text.push(parameters(&name, &entry.schema));
            }
        }
    }
    if text.is_empty() {
        let known: Vec<&str> = families.iter().map(|f| f.key).collect();
        let meant = match meant(&families, wanted_family, wanted_entry) {
            Some(meant) => format!("did you mean `{meant}`? "),
            None => String::new(),
        };
        return Err(Failure::Arguments(
            format!("there is no model or family `{name}`"),
            format!(
                "{meant}families: {}; `stickslip models` lists all entries",
                known.join(", ")
            ),
        ));
    }
    print::out(&text.join("\n"))?;
    Ok(ExitCode::SUCCESS)
}

/// The name that was probably meant: of an entry in the family that is named, or in the one nearest to it, or of anything.
fn meant(families: &[FamilyListing], family: Option<&str>, entry: &str) -> Option<String> {
    let keys: Vec<&str> = families.iter().map(|f| f.key).collect();
    let Some(family) = family else {
        let entries = families
            .iter()
            .flat_map(|f| f.entries.iter().map(|e| e.name));
        let all: Vec<&str> = keys.iter().copied().chain(entries).collect();
        return nearest(entry, &all).map(str::to_string);
    };
    let family = nearest(family, &keys)?;
    let listing = families.iter().find(|f| f.key == family)?;
    let entries: Vec<&str> = listing.entries.iter().map(|e| e.name).collect();
    Some(match nearest(entry, &entries) {
        Some(entry) => format!("{family}.{entry}"),
        None => family.to_string(),
    })
}

fn family(family: &FamilyListing) -> String {
    let mut text = format!("{}  ({})\n", family.key, family.place);
    let width = family
        .entries
        .iter()
        .map(|e| e.name.len())
        .max()
        .unwrap_or(0);
    for entry in &family.entries {
        text += &format!("  {:width$}  {}\n", entry.name, entry.summary);
    }
    text
}

fn paragraphs(schema: &Value) -> impl Iterator<Item = String> {
    let description = schema["description"].as_str().unwrap_or_default();
    description
        .split("\n\n")
        .map(|p| p.split_whitespace().collect::<Vec<_>>().join(" "))
}

fn parameters(name: &str, schema: &Value) -> String {
    let mut text = format!("{name}\n");
    for paragraph in paragraphs(schema) {
        text += &print::wrap(&paragraph, 2, WIDTH);
    }
    let required: Vec<&str> = schema["required"]
        .as_array()
        .into_iter()
        .flatten()
        .filter_map(Value::as_str)
        .collect();
    let properties = schema["properties"].as_object();
    for (key, property) in properties.into_iter().flatten() {
        let default = match property.get("default") {
            Some(default) => format!("default {default}"),
            None if required.contains(&key.as_str()) => "required".to_string(),
            None => "optional".to_string(),
        };
        text += &format!("  {key}: {} ({default})\n", kind(schema, property));
        text += &print::wrap(
            &paragraphs(property).collect::<Vec<_>>().join(" "),
            6,
            WIDTH,
        );
    }
    if properties.is_none_or(|p| p.is_empty()) {
        text += "  no parameters\n";
    }
    text
}

/// The type of a parameter in words.
fn kind(root: &Value, property: &Value) -> String {
    if let Some(target) = property["$ref"]
        .as_str()
        .and_then(|r| root.pointer(r.strip_prefix('#')?))
    {
        return kind(root, target);
    }
    if let Some(all) = property["anyOf"]
        .as_array()
        .or(property["oneOf"].as_array())
    {
        let constant = |v: &Value| v["const"].as_str().map(|s| format!("\"{s}\""));
        let names: Vec<String> = all
            .iter()
            .filter(|v| v["type"] != "null")
            .map(|v| constant(v).unwrap_or_else(|| kind(root, v)))
            .collect();
        return names.join(" | ");
    }
    let name = match &property["type"] {
        Value::Array(all) => all.iter().filter_map(Value::as_str).find(|t| *t != "null"),
        other => other.as_str(),
    };
    match name {
        Some("array") => match property["minItems"]
            .as_u64()
            .filter(|n| Some(*n) == property["maxItems"].as_u64())
        {
            Some(n) => format!("list of {n} × {}", kind(root, &property["items"])),
            None => format!("list of {}", kind(root, &property["items"])),
        },
        Some("integer") => "whole number".into(),
        Some("boolean") => "true or false".into(),
        Some("object") => "table".into(),
        Some(other) => other.into(),
        None => "value".into(),
    }
}

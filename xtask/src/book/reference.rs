//! The reference of the problem file, one page a table, from the JSON schema.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;

use serde_json::{Map, Value};

use xtask::workspace;

const NOTE: &str = "<!-- Generated from stickslip.schema.json by `cargo xtask book`. -->\n";

/// The pages as `(name, text)`, the list of them first.
pub fn pages() -> Result<Vec<(String, String)>, String> {
    let file = workspace::root().join("stickslip.schema.json");
    let text = std::fs::read_to_string(&file).map_err(|e| format!("{}: {e}", file.display()))?;
    let schema: Value =
        serde_json::from_str(&text).map_err(|e| format!("{}: {e}", file.display()))?;
    let schema = Schema { root: &schema };
    let keys = schema.root["properties"]
        .as_object()
        .ok_or("the schema has no properties")?;
    let tables = || {
        keys.iter()
            .filter_map(|(key, p)| Some((key, schema.target(p)?)))
    };
    // A table that is part of another page, too, is described on its own.
    let mut described = tables()
        .map(|(key, name)| (name, format!("{key}.md")))
        .collect();
    let mut pages = vec![("problem-file.md".to_string(), schema.overview(keys))];
    for (key, name) in tables() {
        let text = format!("# `{}`\n\n{NOTE}\n", title(key, &keys[key]));
        let file = format!("{key}.md");
        let mut page = Page {
            text,
            file: &file,
            described: &mut described,
        };
        schema.section(&mut page, &Section::root(key, &name));
        let text = page.text;
        pages.push((file, text));
    }
    Ok(pages)
}

/// How the table of a key is opened in a problem file.
fn title(key: &str, property: &Value) -> String {
    match (
        property["additionalProperties"].is_object(),
        &property["type"],
    ) {
        (true, _) => format!("[{key}.NAME]"),
        (_, Value::String(t)) if t == "array" => format!("[[{key}]]"),
        _ => format!("[{key}]"),
    }
}

/// A page that is being written.
struct Page<'a> {
    text: String,
    file: &'a str,
    /// Where each definition is described, on any page: each is described once.
    described: &'a mut BTreeMap<String, String>,
}

impl Page<'_> {
    /// Where a definition is described: where it is already, or else at a path of this page, where it then has to be written.
    fn place(&mut self, definition: &str, path: &str) -> (String, bool) {
        if let Some(place) = self.described.get(definition) {
            return (place.clone(), false);
        }
        let place = format!("{}#{}", self.file, anchor(path));
        self.described.insert(definition.to_string(), place.clone());
        (place, true)
    }
}

/// A definition that is to be described.
struct Section {
    path: String,
    definition: String,
    level: usize,
    /// What the list of keys above has said about it.
    said: String,
}

impl Section {
    fn root(key: &str, definition: &str) -> Self {
        Section {
            path: key.to_string(),
            definition: definition.to_string(),
            level: 1,
            said: String::new(),
        }
    }

    fn below(&self, key: &str, definition: &str, said: &str) -> Self {
        Section {
            path: format!("{}.{key}", self.path),
            definition: definition.to_string(),
            level: (self.level + 1).min(4),
            said: said.to_string(),
        }
    }
}

/// A key and what a list says about it.
struct Said<'a> {
    name: &'a str,
    text: &'a str,
}

/// The schema, and how its parts are said in words.
struct Schema<'a> {
    root: &'a Value,
}

impl Schema<'_> {
    fn definition(&self, name: &str) -> &Value {
        &self.root["$defs"][name]
    }

    /// The list of tables.
    fn overview(&self, keys: &Map<String, Value>) -> String {
        let mut page = format!("# The problem file\n\n{NOTE}\n");
        page += "A problem file is [TOML](https://toml.io). Other keys are errors. `NAME` stands for a name of your choice. \
            Use any consistent set of units; the units of keys show their dimensions.\n\n\
            | key | | required | |\n|---|---|---|---|\n";
        let required = required(self.root);
        for (key, property) in keys {
            let named = match self.target(property) {
                Some(_) => format!("[`{}`]({key}.md)", title(key, property)),
                None => format!("`{key}`"),
            };
            let kind = match self.target(property) {
                Some(_) => "table".to_string(),
                None => self.kind(property),
            };
            let must = if required.contains(key.as_str()) {
                "yes"
            } else {
                ""
            };
            let _ = writeln!(
                page,
                "| {named} | {kind} | {must} | {} |",
                cell(text(property))
            );
        }
        page
    }

    /// The text, keys and kinds of a definition, then the definitions that it refers to.
    fn section(&self, page: &mut Page, section: &Section) {
        let definition = self.definition(&section.definition);
        let what = untitled(text(definition));
        if what != untitled(&section.said) {
            let _ = writeln!(page.text, "{}\n", prose(&what));
        }
        let mut keys = Vec::new();
        let required = required(definition);
        for (key, property) in definition["properties"].as_object().into_iter().flatten() {
            let table = self.target(property).filter(|t| self.words(t).is_none());
            let link = self.link(
                page,
                section,
                Said {
                    name: key,
                    text: text(property),
                },
                table,
                &mut keys,
            );
            self.key(page, &link, property, required.contains(key.as_str()));
        }
        if !definition["properties"].is_null() && !page.text.ends_with("\n\n") {
            page.text.push('\n');
        }
        let kinds = self.kinds(definition);
        // Kinds come before the tables of other keys: most readers look for them.
        let mut next = Vec::new();
        if !kinds.is_empty() {
            page.text.push_str("One of\n\n");
            for (kind, what, target) in &kinds {
                let table = target.clone().filter(|t| !self.is_said(t, what));
                let link = self.link(
                    page,
                    section,
                    Said {
                        name: kind,
                        text: what,
                    },
                    table,
                    &mut next,
                );
                let _ = writeln!(page.text, "- {link}: {}", item(what));
            }
            page.text.push('\n');
        }
        next.append(&mut keys);
        for below in next {
            let (marks, path) = ("#".repeat(below.level), &below.path);
            let _ = writeln!(
                page.text,
                "{marks} <a id=\"{}\"></a>`{path}`\n",
                anchor(path)
            );
            self.section(page, &below);
        }
    }

    /// A key, as a link to where its table is described; one that is not described anywhere yet is to be written `later`.
    fn link(
        &self,
        page: &mut Page,
        section: &Section,
        key: Said,
        table: Option<String>,
        later: &mut Vec<Section>,
    ) -> String {
        let Some(table) = table else {
            return format!("`{}`", key.name);
        };
        let below = section.below(key.name, &table, key.text);
        let (place, new) = page.place(&table, &below.path);
        if new {
            later.push(below);
        }
        let place = place.strip_prefix(page.file).unwrap_or(&place);
        format!("[`{}`]({place})", key.name)
    }

    /// Whether a definition has nothing but the text that stands in a list already.
    fn is_said(&self, definition: &str, what: &str) -> bool {
        let definition = self.definition(definition);
        let empty = |key: &str| definition[key].as_object().is_none_or(Map::is_empty);
        let parts = definition["oneOf"].is_null() && empty("properties");
        parts && untitled(text(definition)) == untitled(what)
    }

    /// The entry of a key in the list of keys.
    fn key(&self, page: &mut Page, link: &str, property: &Value, required: bool) {
        let mut what = text(property).to_string();
        let mut about = vec![self.kind(property)];
        if let Some(unit) = unit(&what, self.root).map(str::to_string) {
            what = what.replacen(&format!(" [{unit}]"), "", 1);
            if unit != "1" && unit != "-" {
                about.push(unit);
            }
        }
        match (&property["default"], required) {
            (_, true) => about.push("required".to_string()),
            (Value::Null, _) => {}
            (Value::Object(map), _) if map.len() > 1 => {}
            (value, _) => about.push(format!("default `{}`", toml(value))),
        }
        let words = self.target(property).and_then(|t| self.words(&t));
        let words = words.unwrap_or_default();
        let _ = writeln!(
            page.text,
            "- {link} ({}): {}",
            about.join(", "),
            item(&what)
        );
        for (word, meaning) in words {
            let _ = writeln!(page.text, "  - `\"{word}\"`: {}", item(&meaning));
        }
    }

    /// `(name, text, definition)` of the kinds one of which is chosen by key.
    fn kinds(&self, definition: &Value) -> Vec<(String, String, Option<String>)> {
        let mut kinds = Vec::new();
        for entry in definition["oneOf"].as_array().into_iter().flatten() {
            for (key, property) in entry["properties"].as_object().into_iter().flatten() {
                let what = match (text(entry), text(property)) {
                    ("", inner) => inner.to_string(),
                    (outer, _) => outer.to_string(),
                };
                kinds.push((key.clone(), what, self.target(property)));
            }
        }
        kinds
    }

    /// `(word, meaning)` where a definition is a choice of words.
    fn words(&self, name: &str) -> Option<Vec<(String, String)>> {
        let mut words = Vec::new();
        for entry in self.definition(name)["oneOf"].as_array()? {
            words.push((
                entry["const"].as_str()?.to_string(),
                text(entry).to_string(),
            ));
        }
        Some(words)
    }

    /// The definition that a property, its entries or its alternatives refer to.
    fn target(&self, property: &Value) -> Option<String> {
        let inside = [
            &property["additionalProperties"],
            &property["items"],
            &property["anyOf"][0],
        ];
        let direct = property["$ref"].as_str();
        let found = direct.or_else(|| inside.iter().find_map(|p| p["$ref"].as_str()))?;
        let name = found.strip_prefix("#/$defs/")?;
        // Of alternatives the one that is a table has keys to be listed; the others are said in the row.
        match self.definition(name)["anyOf"].as_array() {
            None => Some(name.to_string()),
            Some(all) => all.iter().find_map(|one| self.target(one)),
        }
    }

    /// What a property may be, where that is more than one thing.
    fn alternatives(&self, property: &Value) -> Option<&Vec<Value>> {
        let direct = property["$ref"].as_str();
        let name = direct.or_else(|| property["anyOf"][0]["$ref"].as_str())?;
        self.definition(name.strip_prefix("#/$defs/")?)["anyOf"].as_array()
    }

    /// The type of a property in words.
    fn kind(&self, property: &Value) -> String {
        if let Some(all) = self.alternatives(property) {
            let kinds: Vec<String> = all.iter().map(|one| self.kind(one)).collect();
            return kinds.join(" or ");
        }
        let name = match &property["type"] {
            Value::String(name) => name.as_str(),
            Value::Array(names) => names
                .iter()
                .find_map(|n| n.as_str().filter(|n| *n != "null"))
                .unwrap_or(""),
            _ => match self.target(property) {
                Some(target) if self.words(&target).is_some() => return "word".to_string(),
                Some(target) if !self.kinds(self.definition(&target)).is_empty() => {
                    return "kind".to_string();
                }
                Some(_) => return "table".to_string(),
                None => return "list".to_string(),
            },
        };
        let bounds = bounds(property);
        match name {
            "array" => {
                let count = match (property["minItems"].as_u64(), property["maxItems"].as_u64()) {
                    (Some(a), Some(b)) if a == b => format!("{a} × "),
                    _ => "list of ".to_string(),
                };
                format!("{count}{}", self.kind(&property["items"]))
            }
            "object" => "table".to_string(),
            "integer" => format!("whole number{bounds}"),
            "boolean" => "true, false".to_string(),
            "string" => "text".to_string(),
            other => format!("{other}{bounds}"),
        }
    }
}

fn text(value: &Value) -> &str {
    value["description"].as_str().unwrap_or("")
}

fn required(definition: &Value) -> BTreeSet<&str> {
    let list = definition["required"].as_array().into_iter().flatten();
    list.filter_map(Value::as_str).collect()
}

fn bounds(property: &Value) -> String {
    let signs = [
        ("exclusiveMinimum", ">"),
        ("minimum", "≥"),
        ("maximum", "≤"),
        ("exclusiveMaximum", "<"),
    ];
    let mut list: Vec<String> = signs
        .iter()
        .filter(|(key, _)| property[*key].is_number())
        .map(|(key, sign)| format!("{sign} {}", toml(&property[*key])))
        .collect();
    if property["infinite"] == Value::Bool(true) {
        list.push("or `inf`".to_string());
    }
    match list.is_empty() {
        true => String::new(),
        false => format!(" {}", list.join(", ")),
    }
}

/// A value as it is written in a problem file.
fn toml(value: &Value) -> String {
    match value {
        Value::Object(map) if map.is_empty() => "{}".to_string(),
        Value::Object(map) => {
            let entries: Vec<String> = map
                .iter()
                .map(|(k, v)| format!("{k} = {}", toml(v)))
                .collect();
            format!("{{ {} }}", entries.join(", "))
        }
        Value::Array(list) => {
            let entries: Vec<String> = list.iter().map(toml).collect();
            format!("[{}]", entries.join(", "))
        }
        other => other.to_string(),
    }
}

/// The unit in brackets in a description; other brackets are names of tables, examples and rows.
fn unit<'t>(description: &'t str, root: &Value) -> Option<&'t str> {
    let mut rest = description;
    while let Some(open) = rest.find('[') {
        rest = &rest[open + 1..];
        let end = rest.find([']', '['])?;
        let inside = &rest[..end];
        let table = root["properties"].get(inside).is_some()
            || inside.contains("NAME")
            || inside.contains('.');
        if rest[end..].starts_with(']')
            && !table
            && !inside.contains([',', '"', '{', '`', '='])
            && !inside.is_empty()
        {
            return Some(inside);
        }
    }
    None
}

/// A description as a paragraph; angle brackets and stars outside of code must not become HTML.
fn prose(text: &str) -> String {
    let mut out = String::new();
    for (i, part) in text.split('`').enumerate() {
        let code = i % 2 == 1;
        if i > 0 {
            out.push('`');
        }
        out.push_str(&match code {
            true => part.replace('\n', " "),
            false => part.replace('<', "&lt;").replace('*', "\\*"),
        });
    }
    out
}

/// A description in a cell of a table.
fn cell(text: &str) -> String {
    prose(text)
        .replace("\n\n", "<br>")
        .replace('\n', " ")
        .replace('|', "\\|")
}

/// A description as an entry of a list, on one line.
fn item(text: &str) -> String {
    prose(text).split_whitespace().collect::<Vec<_>>().join(" ")
}

/// A description without the name of its table, which the title says.
fn untitled(text: &str) -> String {
    let body = match text.split_once("]: ") {
        Some((table, body)) if table.starts_with('[') && !table.contains(' ') => body,
        _ => text,
    };
    let mut letters = body.chars();
    match letters.next() {
        Some(letter) => letter.to_uppercase().chain(letters).collect(),
        None => String::new(),
    }
}

fn anchor(path: &str) -> String {
    path.replace('.', "-")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_reference_in_the_book_is_current() {
        let folder = workspace::root().join("book/src/reference");
        let summary =
            std::fs::read_to_string(workspace::root().join("book/src/SUMMARY.md")).unwrap();
        for (name, text) in pages().unwrap() {
            let there = std::fs::read_to_string(folder.join(&name)).unwrap_or_default();
            assert!(
                there == text,
                "reference/{name} is stale: run `cargo xtask book --pages`"
            );
            assert!(
                summary.contains(&format!("reference/{name}")),
                "{name} is not in SUMMARY.md"
            );
        }
    }

    #[test]
    fn units_are_told_from_other_brackets() {
        let root = serde_json::json!({ "properties": { "model": {} } });
        assert_eq!(unit("Young's modulus [Pa], positive.", &root), Some("Pa"));
        assert_eq!(
            unit("The [material.NAME] of [model], `[20, 10]`", &root),
            None
        );
        assert_eq!(unit("Rows of [time, angle [rad]]", &root), Some("rad"));
    }
}

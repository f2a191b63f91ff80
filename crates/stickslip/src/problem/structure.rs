//! Holds the parsed text against the JSON schema: unknown keys, wrong types, missing keys, numbers out of range.
//!
//! Deserialisation stops at its first complaint. Here all of them are found at once, each with its place and with the
//! names that are allowed there. The schema comes from the structs themselves, so a new model needs nothing here.

use std::ops::Range;

use serde_json::Value as Json;
use toml::Spanned;
use toml::de::DeValue;

use super::advice;
use super::expected::{Expected, alternative, strings};
use super::nearest::suggest;
use super::prose::first_sentence;
use super::tree::{self, Table, Value};
use super::{key, tree::number};
use crate::error::Diagnostic;

/// Nothing here is counted so far: of increments, modes or cells no machine makes a thousand million. A key may have a smaller limit of its own.
const MOST_COUNTED: f64 = 1e9;

/// Everything in which `table` departs from `schema`.
pub(super) fn check(schema: &Json, table: &Table) -> Vec<Diagnostic> {
    let mut walk = Walk {
        root: schema,
        path: Vec::new(),
        findings: Vec::new(),
    };
    let all = Expected::of(schema, schema);
    walk.table(&all, table, tree::ELSEWHERE);
    walk.findings
}

/// What the schema says about the value at a path, in a sentence; `None` if there is no such key or it has no description.
pub(super) fn description(schema: &Json, path: &[String]) -> Option<String> {
    let mut expected = Expected::of(schema, schema);
    let mut found = None;
    for segment in path {
        let named = expected.properties.iter().chain(&expected.kinds);
        let named = named.copied().find(|(name, _)| name == segment);
        let own = expected.own;
        let first = own.get("prefixItems").and_then(Json::as_array);
        let position = key::index(segment);
        let next = named.map(|(_, schema)| schema).or_else(|| {
            position
                .and_then(|i| first?.get(i))
                .or_else(|| own.get("items"))
                .or_else(|| own.get("additionalProperties"))
        })?;
        expected = Expected::of(schema, next);
        // Entries of a list have no description of their own.
        found = match (expected.description, position) {
            (None, Some(_)) => found,
            (own, _) => own,
        };
    }
    found.map(first_sentence)
}

struct Walk<'s> {
    root: &'s Json,
    path: Vec<String>,
    findings: Vec<Diagnostic>,
}

impl<'s> Walk<'s> {
    fn report(&mut self, span: Range<usize>, message: String, help: Option<String>) {
        self.findings.push(Diagnostic {
            message,
            key: key::join(&self.path),
            span: tree::place(span),
            help,
        });
    }

    /// `at` is the place of the key.
    fn value(&mut self, schema: &'s Json, value: &Spanned<Value>, at: Range<usize>) {
        let fitting = alternative(self.root, schema, value.get_ref());
        let expected = Expected {
            description: Expected::of(self.root, schema).description,
            ..Expected::of(self.root, fitting)
        };
        let span = tree::show(at.clone(), value);
        match value.get_ref() {
            DeValue::Table(table) if expected.allows("object") => self.table(&expected, table, at),
            DeValue::Array(list) if expected.allows("array") => self.list(&expected, list, span),
            DeValue::String(word) if expected.allows("string") => {
                if !expected.words.is_empty() && !expected.words.contains(&&**word) {
                    let help = match advice::instead(word) {
                        Some(instead) => instead.to_string(),
                        None => suggest(word, "allowed", &expected.words),
                    };
                    self.report(span, format!("`{word}` is not known here"), Some(help));
                }
            }
            DeValue::Boolean(_) if expected.allows("boolean") => {}
            DeValue::Integer(_) if expected.allows("integer") || expected.allows("number") => {
                self.number(&expected, value, span)
            }
            DeValue::Float(_) if expected.allows("number") => self.number(&expected, value, span),
            found => {
                let name = expected.name();
                // A schema without a type allows anything.
                if !name.is_empty() {
                    let message =
                        format!("expected {name}, found {}", found_name(found.type_str()));
                    let unit = match found {
                        DeValue::String(text) if expected.allows("number") => {
                            advice::without_unit(text)
                        }
                        _ => None,
                    };
                    let help = unit
                        .or_else(|| advice::place(self.root, &self.path, &expected, found))
                        .or_else(|| expected.description.map(first_sentence));
                    self.report(span, message, help);
                }
            }
        }
    }

    fn number(&mut self, expected: &Expected, value: &Spanned<Value>, span: Range<usize>) {
        let Some(x) = number(value.get_ref()) else {
            return;
        };
        let text = match value.get_ref() {
            DeValue::Integer(i) => i.as_str().to_string(),
            DeValue::Float(f) => f.as_str().to_string(),
            _ => String::new(),
        };
        if let DeValue::Integer(i) = value.get_ref()
            && i64::from_str_radix(&i.as_str().replace('_', ""), i.radix()).is_err()
        {
            let message = format!("the whole number {text} has more than 64 bits");
            self.report(span, message, expected.description.map(first_sentence));
            return;
        }
        let limits = [
            ("minimum", "at least", true),
            ("exclusiveMinimum", "greater than", true),
            ("maximum", "at most", false),
            ("exclusiveMaximum", "less than", false),
        ];
        for (keyword, words, below) in limits {
            let Some(limit) = expected.limit(keyword) else {
                continue;
            };
            let beyond = if below { x < limit } else { x > limit };
            let on = keyword.starts_with("exclusive") && x == limit;
            if beyond || on {
                let message = format!("must be {words} {limit}, found {text}");
                self.report(span, message, expected.description.map(first_sentence));
                return;
            }
        }
        // Whole numbers that count something; others, as the seed of a random surface, have another format.
        let counts = expected.own.get("format").and_then(Json::as_str) == Some("uint");
        if counts && expected.limit("maximum").is_none() && x > MOST_COUNTED {
            let message = format!("must be at most {MOST_COUNTED}, found {text}");
            self.report(span, message, expected.description.map(first_sentence));
            return;
        }
        // A limit may be infinite where its schema says so: TOML can write it, JSON has no word for it.
        let unlimited = x == f64::INFINITY && expected.own.get("infinite").is_some();
        if !x.is_finite() && !unlimited {
            let message = format!("must be a finite number, found {text}");
            self.report(span, message, expected.description.map(first_sentence));
        }
    }

    fn list(&mut self, expected: &Expected<'s>, list: &[Spanned<Value>], span: Range<usize>) {
        let count = list.len() as f64;
        let (least, most) = (expected.limit("minItems"), expected.limit("maxItems"));
        let wanted = match (least, most) {
            (Some(a), Some(b)) if a == b && count != a => Some(format!("{a}")),
            (Some(a), _) if count < a => Some(format!("at least {a}")),
            (_, Some(b)) if count > b => Some(format!("at most {b}")),
            _ => None,
        };
        if let Some(wanted) = wanted {
            let message = format!("expected {wanted} entries, found {}", list.len());
            self.report(span, message, expected.description.map(first_sentence));
        }
        let first = expected.own.get("prefixItems").and_then(Json::as_array);
        let rest = expected.own.get("items");
        let before = self.findings.len();
        for (i, value) in list.iter().enumerate() {
            if let Some(schema) = first.and_then(|f| f.get(i)).or(rest) {
                self.path.push(key::entry(i));
                self.value(schema, value, value.span());
                self.path.pop();
            }
        }
        // Entries have no description of their own.
        for finding in &mut self.findings[before..] {
            if finding.help.is_none() {
                finding.help = expected.description.map(first_sentence);
            }
        }
    }

    fn table(&mut self, expected: &Expected<'s>, table: &Table, at: Range<usize>) {
        let rest = expected.own.get("additionalProperties");
        let names: Vec<&str> = (expected.properties.iter())
            .chain(&expected.kinds)
            .map(|(name, _)| *name)
            .collect();
        let mut chosen: Option<String> = None;
        let mut unknown = false;
        for (name, value) in tree::in_order(table) {
            let span = name.span();
            let name: &str = name.get_ref();
            let find = |list: &[(&str, &'s Json)]| {
                list.iter()
                    .find(|(n, _)| *n == name)
                    .map(|(_, schema)| *schema)
            };
            let kind = find(&expected.kinds);
            let schema = kind
                .or_else(|| find(&expected.properties))
                .or(rest.filter(|r| r.is_object()));
            self.path.push(name.to_string());
            match schema {
                Some(schema) => self.value(schema, value, span.clone()),
                None if rest == Some(&Json::Bool(true)) => {}
                None => {
                    unknown = true;
                    let found = value.get_ref();
                    let help = advice::elsewhere(self.root, &self.path, expected, &names, found);
                    self.report(span.clone(), format!("unknown key `{name}`"), Some(help));
                }
            }
            self.path.pop();
            if kind.is_some() {
                match &chosen {
                    None => chosen = Some(name.to_string()),
                    Some(first) => {
                        let message = format!("`{first}` and `{name}` exclude each other");
                        self.report(span, message, Some("keep one of the two".into()));
                    }
                }
            }
        }
        // An unknown key is probably the missing one, misspelt: one message is enough.
        if unknown {
            return;
        }
        for name in strings(expected.own.get("required")) {
            if !table.contains_key(name) {
                let schema = expected.properties.iter().find(|(n, _)| *n == name);
                let help = schema.and_then(|(_, s)| Expected::of(self.root, s).description);
                let message = format!("the key `{name}` is missing");
                self.report(at.clone(), message, help.map(first_sentence));
            }
        }
        if chosen.is_none() && !expected.kinds.is_empty() {
            let kinds: Vec<&str> = expected.kinds.iter().map(|(k, _)| *k).collect();
            let message = match &kinds[..] {
                [one] => format!("the key `{one}` is missing"),
                _ => format!("one of these keys is missing: {}", kinds.join(", ")),
            };
            let help = format!(
                "for example `{}.{} = {{ … }}`; see `stickslip models`",
                key::join(&self.path),
                kinds[0]
            );
            self.report(at, message, Some(help));
        }
    }
}

fn found_name(kind: &str) -> &str {
    match kind {
        "table" => "a table",
        "array" => "a list",
        "integer" => "a whole number",
        "float" => "a number with a decimal point",
        "string" => "a string",
        "boolean" => "true or false",
        "datetime" => "a date",
        other => other,
    }
}

//! A problem as people write it: headings, one key a line, and nothing that goes without saying.

use std::borrow::Cow;

use serde::Deserialize;
use toml::Spanned;
use toml::de::{DeArray, DeValue, Deserializer};

use super::tree::{self, Table, Value};
use super::{Problem, key};
use crate::error::ProblemError;

/// A problem in which nothing is said, to which one table is added to see what it reads as.
const BARE: &str = "format = 1\nmodel.space = \"solid\"\nbody = {}\nstep = []";

/// Where a table of the problem stands.
#[derive(Clone, Copy)]
enum Among<'a> {
    /// `[solver]`
    Alone,
    /// `[body.NAME]`
    Named(&'a str),
    /// `[[step]]`
    Listed,
}

/// A problem as a short text, which gives the same problem again: keys that say what holds without them are left out.
///
/// # Errors
/// As [`Problem::to_toml`].
pub fn brief_toml(problem: &Problem) -> Result<String, ProblemError> {
    let text = super::data::to_toml(problem)?;
    let root = Table::parse_recoverable(&text).0.into_inner();
    let mut out = String::new();
    for (kind, value) in tree::in_order(&root) {
        match value.get_ref() {
            DeValue::Table(all) if all.values().all(|v| v.get_ref().is_table()) => {
                for (name, table) in tree::in_order(all) {
                    section(
                        &mut out,
                        kind.get_ref(),
                        Among::Named(name.get_ref()),
                        table,
                    );
                }
            }
            DeValue::Table(_) => section(&mut out, kind.get_ref(), Among::Alone, value),
            DeValue::Array(all) => {
                let tables = all.iter();
                tables.for_each(|t| section(&mut out, kind.get_ref(), Among::Listed, t));
            }
            value => out += &format!("{kind} = {}\n", text_of(value), kind = kind.get_ref()),
        }
    }
    Ok(out)
}

/// Writes a table under its heading, or nothing if that would say as much.
fn section(out: &mut String, kind: &str, among: Among, table: &Spanned<Value>) {
    let Some(table) = table.get_ref().as_table() else {
        return;
    };
    let whole = read(kind, among, table);
    let short = shortened(table.clone(), &|t| read(kind, among, t) == whole);
    let heading = match among {
        Among::Alone if short.is_empty() => return,
        Among::Alone => format!("[{kind}]"),
        Among::Named(name) => format!("[{}]", key::join(&[kind, name])),
        Among::Listed => format!("[[{kind}]]"),
    };
    *out += &format!("\n{heading}\n");
    for entry in entries(&short) {
        *out += &format!("{entry}\n");
    }
}

/// What a table reads as where nothing else is said.
fn read(kind: &str, among: Among, table: &Table) -> Option<Problem> {
    let one = |name: &str, value| Table::from_iter([(tree::key_elsewhere(name.into()), value)]);
    let table = Spanned::new(tree::ELSEWHERE, DeValue::Table(table.clone()));
    let entry = match among {
        Among::Alone => table,
        Among::Named(name) => Spanned::new(tree::ELSEWHERE, DeValue::Table(one(name, table))),
        Among::Listed => {
            let mut list = DeArray::new();
            list.push(table);
            Spanned::new(tree::ELSEWHERE, DeValue::Array(list))
        }
    };
    let mut root = Table::parse_recoverable(BARE).0;
    root.get_mut()
        .insert(tree::key_elsewhere(kind.into()), entry);
    Problem::deserialize(Deserializer::from(root)).ok()
}

/// A table without the keys that can be left out, at any depth.
fn shortened<'i>(mut table: Table<'i>, same: &dyn Fn(&Table<'i>) -> bool) -> Table<'i> {
    let keys = tree::in_order(&table).into_iter();
    let keys: Vec<String> = keys.map(|(name, _)| name.get_ref().to_string()).collect();
    for name in keys {
        let mut without = table.clone();
        without.remove(name.as_str());
        if same(&without) {
            table = without;
            continue;
        }
        let with = |inner: Table<'i>| {
            let mut all = without.clone();
            let value = Spanned::new(tree::ELSEWHERE, DeValue::Table(inner));
            all.insert(tree::key_elsewhere(name.clone()), value);
            all
        };
        if let Some(inner) = table[name.as_str()].get_ref().as_table() {
            let inner = shortened(inner.clone(), &|t| same(&with(t.clone())));
            if let Some(value) = table.get_mut(name.as_str()) {
                *value.get_mut() = DeValue::Table(inner);
            }
        }
    }
    table
}

/// The entries of a table, in order: `key = value`.
fn entries(table: &Table) -> Vec<String> {
    let entry = |(name, value): (&Spanned<Cow<str>>, &Spanned<Value>)| {
        let (mut path, mut value) = (vec![name.get_ref().to_string()], value.get_ref());
        // The kind of a model is part of the path: `friction.coulomb = { mu = 0.3 }`.
        while let DeValue::Table(inner) = value
            && let [(name, next)] = tree::in_order(inner)[..]
            && next.get_ref().is_table()
        {
            path.push(name.get_ref().to_string());
            value = next.get_ref();
        }
        format!("{} = {}", key::join(&path), text_of(value))
    };
    tree::in_order(table).into_iter().map(entry).collect()
}

/// A value in one line, numbers as short as they are exact.
fn text_of(value: &Value) -> String {
    match value {
        DeValue::Table(table) if table.is_empty() => "{}".into(),
        DeValue::Table(table) => format!("{{ {} }}", entries(table).join(", ")),
        DeValue::Array(list) => {
            let list: Vec<String> = list.iter().map(|v| text_of(v.get_ref())).collect();
            format!("[{}]", list.join(", "))
        }
        DeValue::Float(_) => match tree::number(value) {
            // Negative zero reads oddly.
            Some(0.0) | None => "0.0".into(),
            Some(x) => format!("{x:?}"),
        },
        DeValue::String(word) => toml::Value::String(word.to_string()).to_string(),
        DeValue::Integer(i) => i.as_str().to_string(),
        DeValue::Boolean(b) => b.to_string(),
        DeValue::Datetime(d) => d.to_string(),
    }
}

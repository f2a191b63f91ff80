//! `--set path=value`: changes to a problem file without editing it.

use toml::Spanned;
use toml::de::DeValue;

use super::key;
use super::tree::{self, Table, Value};
use crate::error::Diagnostic;

/// Applies one override, `interface.base.friction.coulomb.mu=0.3`, to the parsed text. Tables that are missing on
/// the way are made; entries of a list are counted from 1, as in `step.1.duration`, or called by their `name`, as in
/// `step.press.duration`.
///
/// The value is read as TOML; a bare word that is not TOML is taken as a string (`model.space=solid`).
pub(super) fn apply<'i>(root: &mut Table<'i>, text: &'i str) -> Result<(), Diagnostic> {
    let (path, value) = split(text).ok_or_else(|| {
        Diagnostic::new("", format!("the override `{text}` has no `=`"))
            .help("write path=value, for example interface.base.friction.coulomb.mu=0.3")
    })?;
    let wrong = |message: String| Diagnostic::new("", format!("override `{text}`: {message}"));
    let path = key::parse(path).map_err(wrong)?;
    let value = parse(value).map_err(wrong)?;
    let (last, parents) = path
        .split_last()
        .ok_or_else(|| wrong("the path is empty".into()))?;

    let mut node = Place::Table(root);
    for (depth, segment) in parents.iter().enumerate() {
        let name = key::join(&path[..=depth]);
        node = match node.enter(segment) {
            Some(place) => place,
            None => {
                return Err(wrong(format!(
                    "`{name}` is neither a table nor an entry of a list; entries are counted from 1, or called by their `name`"
                )));
            }
        };
    }
    match node {
        Place::Table(table) => {
            // `insert` keeps the old key, whose place shows the line that was overridden; the value is elsewhere.
            table.insert(tree::key_elsewhere(last.clone()), value);
            Ok(())
        }
        Place::List(list) => {
            let count = list.len();
            let entry = position(list, last).ok_or_else(|| {
                wrong(format!(
                    "there is no entry `{last}`: the list has {count}, counted from 1"
                ))
            })?;
            list[entry] = value;
            Ok(())
        }
    }
}

enum Place<'a, 'i> {
    Table(&'a mut Table<'i>),
    List(&'a mut [Spanned<Value<'i>>]),
}

impl<'a, 'i> Place<'a, 'i> {
    fn enter(self, segment: &str) -> Option<Place<'a, 'i>> {
        let value = match self {
            Place::Table(table) => table
                .entry(tree::key_elsewhere(segment.to_string()))
                .or_insert_with(|| tree::elsewhere(DeValue::Table(Table::new()))),
            Place::List(list) => {
                let entry = position(list, segment)?;
                list.get_mut(entry)?
            }
        };
        match value.get_mut() {
            DeValue::Table(table) => Some(Place::Table(table)),
            DeValue::Array(list) => Some(Place::List(&mut *list)),
            _ => None,
        }
    }
}

/// The entry of a list by its number or its name.
fn position(list: &[Spanned<Value>], segment: &str) -> Option<usize> {
    let by_number = key::index(segment).filter(|i| *i < list.len());
    let named = |entry: &Spanned<Value>| {
        let name = entry.get_ref().as_table().and_then(|t| t.get("name"));
        name.and_then(|n| n.get_ref().as_str()) == Some(segment)
    };
    by_number.or_else(|| list.iter().position(named))
}

/// At the first `=` outside quotes.
fn split(text: &str) -> Option<(&str, &str)> {
    let mut quote = None;
    for (i, c) in text.char_indices() {
        match (quote, c) {
            (None, '=') => return Some((&text[..i], &text[i + 1..])),
            (None, '"' | '\'') => quote = Some(c),
            (Some(q), c) if q == c => quote = None,
            _ => {}
        }
    }
    None
}

fn parse(text: &str) -> Result<Spanned<Value<'_>>, String> {
    let text = text.trim();
    match DeValue::parse(text) {
        Ok(value) => Ok(tree::elsewhere(value.into_inner())),
        Err(_) if is_word(text) => Ok(tree::elsewhere(DeValue::String(text.into()))),
        Err(e) => Err(format!("`{text}` is not a TOML value: {}", e.message())),
    }
}

fn is_word(text: &str) -> bool {
    let allowed = |c: char| c.is_ascii_alphanumeric() || matches!(c, '-' | '_' | '.' | '/');
    text.starts_with(|c: char| c.is_ascii_alphabetic()) && text.chars().all(allowed)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn set(source: &str, text: &str) -> Result<toml::Table, String> {
        let mut root = toml::de::DeTable::parse(source).unwrap();
        apply(root.get_mut(), text).map_err(|d| d.message)?;
        let deserializer = toml::de::Deserializer::from(root);
        Ok(serde::Deserialize::deserialize(deserializer).unwrap())
    }

    fn table(text: &str) -> toml::Table {
        text.parse().unwrap()
    }

    #[test]
    fn replaces_adds_and_counts() {
        let source = "[interface.base.friction.coulomb]\nmu = 1.0\n[[step]]\nduration = 1.0\n";
        let changed = set(source, "interface.base.friction.coulomb.mu = 0.3").unwrap();
        assert_eq!(changed, table(&source.replace("mu = 1.0", "mu = 0.3")));
        let changed = set(source, "step.1.duration=2.5").unwrap();
        assert_eq!(
            changed,
            table(&source.replace("duration = 1.0", "duration = 2.5"))
        );
        assert_eq!(
            set("", "a.\"b.c\".d={x=[1,2]}").unwrap(),
            table("a.\"b.c\".d = {x=[1,2]}")
        );
        assert_eq!(
            set("a.v = [1, 2]", "a.v.2=5").unwrap(),
            table("a.v = [1, 5]")
        );
    }

    #[test]
    fn a_bare_word_is_a_string() {
        assert_eq!(
            set("", "model.space=plane-strain").unwrap(),
            table("model.space = 'plane-strain'")
        );
        assert_eq!(set("", "a=true").unwrap(), table("a = true"));
        assert_eq!(set("", "a=inf").unwrap(), table("a = inf"));
    }

    #[test]
    fn says_what_is_wrong() {
        let source = "a = 1\n[[step]]\nduration = 1.0\n";
        for (text, message) in [
            ("a.b", "the override `a.b` has no `=`"),
            (
                "a.b=1",
                "override `a.b=1`: `a` is neither a table nor an entry of a list; entries are counted from 1, or called by their `name`",
            ),
            (
                "step.2.duration=1",
                "override `step.2.duration=1`: `step.2` is neither a table nor an entry of a list; entries are counted from 1, or called by their `name`",
            ),
            (
                "step.0=1",
                "override `step.0=1`: there is no entry `0`: the list has 1, counted from 1",
            ),
            ("a..b=1", "override `a..b=1`: `a..b` has an empty part"),
        ] {
            assert_eq!(set(source, text).unwrap_err(), message);
        }
        assert!(
            set(source, "a=[1,")
                .unwrap_err()
                .contains("is not a TOML value")
        );
    }
}

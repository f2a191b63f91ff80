//! The parsed text with the place of every key and value.

use super::key;
use std::borrow::Cow;
use std::ops::Range;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// A table of the parsed text.
pub(super) type Table<'i> = DeTable<'i>;
/// A value of the parsed text.
pub(super) type Value<'i> = DeValue<'i>;

/// The place of what did not come from the text but from an override.
pub(super) const ELSEWHERE: Range<usize> = usize::MAX..usize::MAX;

/// A place in the text, or `None` if it is [`ELSEWHERE`].
pub(super) fn place(span: Range<usize>) -> Option<Range<usize>> {
    (span != ELSEWHERE).then_some(span)
}

/// The bytes that best show the value at `path`: a scalar or list itself, otherwise the key; where the path ends
/// early (a key is missing), the last table on it.
pub(super) fn find(root: &Table, path: &[String]) -> Option<Range<usize>> {
    let mut best = None;
    let mut table = Some(root);
    let mut list: Option<&[Spanned<Value>]> = None;
    for segment in path {
        let (key, value) = if let Some(t) = table {
            let Some((key, value)) = t.get_key_value(segment.as_str()) else {
                break;
            };
            (key.span(), value)
        } else if let Some(value) = list.and_then(|l| l.get(key::index(segment)?)) {
            (value.span(), value)
        } else {
            break;
        };
        best = Some(show(key, value));
        table = value.get_ref().as_table();
        list = value.get_ref().as_array().map(|a| &**a);
    }
    best.and_then(place)
}

/// The path to the innermost value whose place in the text holds another.
pub(super) fn path(root: &Table, place: &Range<usize>) -> Vec<String> {
    let mut path = Vec::new();
    let mut children: Vec<(String, &Spanned<Value>)> = entries(root);
    let holds = |value: &Spanned<Value>| {
        let span = value.span();
        span.start <= place.start && place.end <= span.end
    };
    while let Some((name, value)) = children.into_iter().find(|(_, value)| holds(value)) {
        path.push(name);
        children = match value.get_ref() {
            DeValue::Table(table) => entries(table),
            DeValue::Array(list) => {
                let numbers = list.iter().enumerate();
                numbers.map(|(i, value)| (key::entry(i), value)).collect()
            }
            _ => break,
        };
    }
    path
}

fn entries<'a, 'i>(table: &'a Table<'i>) -> Vec<(String, &'a Spanned<Value<'i>>)> {
    let entries = table.iter();
    entries
        .map(|(key, value)| (key.get_ref().to_string(), value))
        .collect()
}

/// The bytes to underline for a finding about a value: the key of a table or list of tables, otherwise the value.
pub(super) fn show(key: Range<usize>, value: &Spanned<Value>) -> Range<usize> {
    match value.get_ref() {
        DeValue::Table(_) => key,
        DeValue::Array(a) if a.iter().any(|v| v.get_ref().is_table()) => key,
        _ => value.span(),
    }
}

/// The same value with every place set to [`ELSEWHERE`].
pub(super) fn elsewhere<'i>(value: Value<'i>) -> Spanned<Value<'i>> {
    let value = match value {
        DeValue::Table(table) => {
            let mut all = Table::new();
            for (key, value) in table {
                all.insert(
                    Spanned::new(ELSEWHERE, key.into_inner()),
                    elsewhere(value.into_inner()),
                );
            }
            DeValue::Table(all)
        }
        DeValue::Array(array) => {
            let mut all = toml::de::DeArray::new();
            for value in array {
                all.push(elsewhere(value.into_inner()));
            }
            DeValue::Array(all)
        }
        other => other,
    };
    Spanned::new(ELSEWHERE, value)
}

/// A key that did not come from the text.
pub(super) fn key_elsewhere<'i>(key: String) -> Spanned<Cow<'i, str>> {
    Spanned::new(ELSEWHERE, Cow::Owned(key))
}

/// The entries of a table in the order of the text.
pub(super) fn in_order<'t, 'i>(
    table: &'t Table<'i>,
) -> Vec<(&'t Spanned<Cow<'i, str>>, &'t Spanned<Value<'i>>)> {
    let mut all: Vec<_> = table.iter().collect();
    all.sort_by_key(|(name, _)| name.span().start);
    all
}

/// The number a value stands for, if it is one.
pub(super) fn number(value: &Value) -> Option<f64> {
    match value {
        DeValue::Integer(i) => {
            let digits = i.as_str().replace('_', "");
            i128::from_str_radix(&digits, i.radix())
                .ok()
                .map(|n| n as f64)
        }
        DeValue::Float(x) => x.as_str().replace('_', "").parse().ok(),
        _ => None,
    }
}

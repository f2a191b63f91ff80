//! Parameters of functions that are tuples: what goes together has a struct with names.

use super::tokens::{Token, tokens};

/// The functions of a file, but for those of tests, with a parameter that is a tuple or a reference to one: `LINE: NAME`.
pub fn tuples(text: &str) -> Vec<String> {
    let (all, _) = tokens(text);
    let functions = all.iter().enumerate().filter(|(_, t)| t.text == "fn");
    let named = functions.filter_map(|(i, _)| Some((all.get(i + 1)?, &all[i + 2..])));
    let found = named.filter(|(name, behind)| name.is_word() && has_tuple(behind));
    found
        .map(|(name, _)| format!("{}: {}", name.line, name.text))
        .collect()
}

/// Whether the parameters behind the name of a function have a tuple among them.
fn has_tuple(behind: &[Token]) -> bool {
    let start = match behind.first().is_some_and(|t| t.text == "<") {
        true => generics(behind),
        false => 0,
    };
    let list = inside(&behind[start..]);
    let mut depth = 0;
    list.iter().enumerate().any(|(i, token)| {
        depth += step(token);
        depth == 0 && token.text == ":" && is_tuple(&list[i + 1..])
    })
}

/// Whether a type is a tuple, or a reference to one.
fn is_tuple(of: &[Token]) -> bool {
    let marks = |t: &&Token| ["&", "mut"].contains(&t.text.as_str());
    let of = &of[of.iter().take_while(marks).count()..];
    let list = match of.first().is_some_and(|t| t.text == "(") {
        true => inside(of),
        false => &[],
    };
    let mut depth = 0;
    list.iter().enumerate().any(|(i, token)| {
        depth += step(token);
        depth += match token.text.as_str() {
            "<" => 1,
            ">" if list[i - 1].text != "-" => -1,
            _ => 0,
        };
        depth == 0 && token.text == ","
    })
}

/// What stands between the parenthesis that a list begins with, if it does, and the one that closes it.
fn inside(all: &[Token]) -> &[Token] {
    let mut depth = 0;
    for (i, token) in all.iter().enumerate() {
        depth += step(token);
        if depth == 0 {
            return if i == 0 { &[] } else { &all[1..i] };
        }
    }
    &[]
}

fn step(token: &Token) -> i32 {
    match token.text.as_str() {
        "(" | "[" | "{" => 1,
        ")" | "]" | "}" => -1,
        _ => 0,
    }
}

/// Tokens of the generic parameters that a list begins with.
fn generics(all: &[Token]) -> usize {
    let mut depth = 0;
    for (i, token) in all.iter().enumerate() {
        match token.text.as_str() {
            "<" => depth += 1,
            ">" if all[i - 1].text != "-" => depth -= 1,
            _ => {}
        }
        if depth == 0 {
            return i + 1;
        }
    }
    all.len()
}

//! What a file imports, and which paths its code mentions.

use super::tokens::{Token, tokens};

/// A path of the code, such as `super::bodies::Bodies`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Path {
    /// Its names.
    pub names: Vec<String>,
    /// The name by which an import makes it known; the last one, or that behind `as`.
    pub alias: String,
    /// Line, from 1.
    pub line: usize,
}

/// The imports of a file.
#[derive(Debug, Clone, Default)]
pub struct Imports {
    /// What is imported.
    pub uses: Vec<Path>,
    /// What is imported and handed on.
    pub exports: Vec<Path>,
    /// Paths of the code outside imports; single names, too, as they may have been imported.
    pub mentions: Vec<Path>,
    /// Names of items that are defined here.
    pub items: Vec<String>,
    /// Macros that are defined here for the whole crate.
    pub macros: Vec<String>,
    /// Modules that are declared for tests only.
    pub tests: Vec<String>,
}

impl Imports {
    /// Reads the text of a file.
    pub fn read(text: &str) -> Self {
        let (all, tests) = tokens(text);
        let mut out = Imports {
            tests,
            ..Imports::default()
        };
        let mut at = 0;
        while at < all.len() {
            let before = at.checked_sub(1).map_or("", |i| all[i].text.as_str());
            let next = all.get(at + 1).map_or("", |t| t.text.as_str());
            // `use<'a>` is no import but says what a type captures.
            if all[at].text == "use" && next != "<" {
                let mut found = Vec::new();
                let start = at + 1;
                at = tree(&all, start, &[], &mut found);
                match before {
                    "pub" | ")" => out.exports.extend(found),
                    _ => out.uses.extend(found),
                }
            } else if all[at].is_word() && ![".", "::"].contains(&before) {
                let names = path(&all[at..]);
                let length = 2 * names.len() - 1;
                out.define(before, &all, at);
                let alias = names[names.len() - 1].clone();
                let line = all[at].line;
                out.mentions.push(Path { names, alias, line });
                at += length;
            } else {
                at += 1;
            }
        }
        out
    }

    /// Notes the name of a definition, by the word before it.
    fn define(&mut self, before: &str, all: &[Token], at: usize) {
        const KINDS: [&str; 7] = ["struct", "enum", "trait", "fn", "const", "static", "type"];
        if KINDS.contains(&before) {
            self.items.push(all[at].text.clone());
        }
        let exported = all[..at]
            .iter()
            .rev()
            .take(5)
            .any(|t| t.text == "macro_export");
        if all[at].text == "macro_rules" && exported {
            self.macros.extend(all.get(at + 2).map(|t| t.text.clone()));
        }
    }
}

/// The names of the path that begins here.
fn path(all: &[Token]) -> Vec<String> {
    let mut names = vec![all[0].text.clone()];
    for pair in all[1..].chunks_exact(2) {
        if pair[0].text != "::" || !pair[1].is_word() {
            break;
        }
        names.push(pair[1].text.clone());
    }
    names
}

/// Reads a tree of imports that begins at `at` and returns where it ends; `stem` is the path before it.
fn tree(all: &[Token], mut at: usize, stem: &[String], out: &mut Vec<Path>) -> usize {
    let mut names = stem.to_vec();
    let mut line = all.get(at).map_or(0, |t| t.line);
    let mut alias = None;
    while let Some(token) = all.get(at) {
        match token.text.as_str() {
            "{" => {
                at += 1;
                while all.get(at).is_some_and(|t| t.text != "}") {
                    at = tree(all, at, &names, out);
                    at += usize::from(all.get(at).is_some_and(|t| t.text == ","));
                }
                return at + 1;
            }
            "," | "}" | ";" => break,
            "as" => {
                alias = all.get(at + 1).map(|t| t.text.clone());
                at += 1;
            }
            "::" => {}
            // `a::{self}` is `a`.
            "self" if !names.is_empty() => {}
            name => {
                names.push(name.to_string());
                line = token.line;
            }
        }
        at += 1;
    }
    let alias = alias.or_else(|| names.last().cloned()).unwrap_or_default();
    out.push(Path { names, alias, line });
    at
}

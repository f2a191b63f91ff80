//! Methods of types: which files have them, and which files of one type call each other.

use std::collections::{BTreeMap, BTreeSet};

use super::rooms::Plan;
use super::tokens::{Token, tokens};
use super::tree::{Arrow, Module, Tree};

/// The methods of a type.
#[derive(Debug, Default)]
pub struct Methods {
    /// By name, the modules that define one; those of traits are left out.
    defined: BTreeMap<String, BTreeSet<Module>>,
    /// What is called of `self` and `Self`, by traits of the type too, with the name as path.
    calls: Vec<Arrow>,
}

/// The methods of all types, by where the type is defined.
pub fn methods(tree: &Tree, read: impl Fn(&Module) -> String) -> BTreeMap<String, Methods> {
    let mut out: BTreeMap<String, Methods> = BTreeMap::new();
    for module in tree.files.keys() {
        let (all, _) = tokens(&read(module));
        for at in (0..all.len()).filter(|at| begins(&all, *at)) {
            if let Some(block) = Block::read(&all[at + 1..]) {
                let kind = tree.defined(module, &block.path).join("::");
                out.entry(kind).or_default().add(tree, module, &block);
            }
        }
    }
    out
}

impl Methods {
    /// How many modules have some.
    pub fn modules(&self) -> usize {
        let all: BTreeSet<&Module> = self.defined.values().flatten().collect();
        all.len()
    }

    /// Calls from a module to another that has the method.
    pub fn plan(&self) -> Plan {
        let mut plan = Plan::new();
        for call in &self.calls {
            let found = self.defined.get(&call.path).into_iter().flatten();
            for to in found.filter(|to| **to != call.from) {
                let known = plan.entry(call.from.join("::")).or_default();
                known.entry(to.join("::")).or_insert_with(|| Arrow {
                    to: to.clone(),
                    ..call.clone()
                });
            }
        }
        plan
    }

    fn add(&mut self, tree: &Tree, module: &Module, block: &Block) {
        let text = |i: usize| block.body.get(i).map_or("", |t| t.text.as_str());
        let mut depth = 0;
        for (i, token) in block.body.iter().enumerate() {
            match [0, 1, 2, 3].map(|k| text(i + k)) {
                ["{", ..] => depth += 1,
                ["}", ..] => depth -= 1,
                ["fn", name, ..] if depth == 1 && !block.of_trait => {
                    let known = self.defined.entry(name.to_string()).or_default();
                    known.insert(module.clone());
                }
                ["self", ".", name, "(" | "::"] | ["Self", "::", name, _] => {
                    self.calls.push(Arrow {
                        from: module.clone(),
                        to: Module::new(),
                        file: tree.files[module].clone(),
                        line: token.line,
                        path: name.to_string(),
                    });
                }
                _ => {}
            }
        }
    }
}

/// A block of methods.
struct Block<'a> {
    /// The type as it is written.
    path: Vec<String>,
    of_trait: bool,
    body: &'a [Token],
}

impl<'a> Block<'a> {
    /// What stands behind `impl`; `None` of types that have no name.
    fn read(behind: &'a [Token]) -> Option<Self> {
        let open = behind.iter().position(|t| t.text == "{")?;
        let (head, rest) = behind.split_at(open);
        let text = |i: usize| head.get(i).map_or("", |t| t.text.as_str());
        let of = (0..head.len()).find(|&i| text(i) == "for" && text(i + 1) != "<");
        let start = match of {
            Some(of) => of + 1,
            None if text(0) == "<" => closed(head, ["<", ">"]),
            None => 0,
        };
        let path = head[start..].iter().map(|t| t.text.as_str());
        let path = path.take_while(|t| !["<", "where"].contains(t));
        let path: Vec<&str> = path.filter(|t| *t != "::").collect();
        let named = path.iter().all(|t| t.starts_with(char::is_alphabetic));
        (named && !path.is_empty() && path[0] != "dyn").then(|| Block {
            path: path.into_iter().map(str::to_string).collect(),
            of_trait: of.is_some(),
            body: &rest[..closed(rest, ["{", "}"])],
        })
    }
}

/// Whether an `impl` begins here that is an item, not a type.
fn begins(all: &[Token], at: usize) -> bool {
    let before = at.checked_sub(1).map_or(";", |i| all[i].text.as_str());
    all[at].text == "impl" && ["{", "}", ";", "]", "unsafe"].contains(&before)
}

/// How many tokens there are up to the one that closes the first.
fn closed(all: &[Token], [open, close]: [&str; 2]) -> usize {
    let mut depth = 0;
    for (i, token) in all.iter().enumerate() {
        if token.text == open {
            depth += 1;
        } else if token.text == close && all[i - 1].text != "-" {
            // The head of an arrow closes nothing.
            depth -= 1;
        }
        if depth == 0 {
            return i + 1;
        }
    }
    all.len()
}

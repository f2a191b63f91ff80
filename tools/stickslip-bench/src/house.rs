//! `cargo xtask house`: the code of the library in numbers, room by room, tests left out.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use syn::spanned::Spanned;
use syn::visit::{self, Visit};
use xtask::workspace;

/// Lines that no function should exceed, and fields that no struct should.
const LONG: usize = 100;
const WIDE: usize = 16;

/// Types and functions that are listed, the largest first.
const LISTED: usize = 12;

/// What a room holds.
#[derive(Default)]
struct Room {
    files: usize,
    lines: usize,
    structs: usize,
    traits: usize,
    functions: usize,
}

/// What all rooms hold together.
#[derive(Default)]
struct House {
    rooms: BTreeMap<String, Room>,
    /// By type, of its own methods: how many, and the files that have some.
    methods: BTreeMap<String, (usize, BTreeSet<String>)>,
    /// By name, the values of constants.
    constants: BTreeMap<String, BTreeSet<String>>,
    /// Lines of functions, and where they are.
    lengths: Vec<(usize, String)>,
    /// Fields of structs that have too many.
    wide: Vec<(usize, String)>,
    /// Parameters that are tuples.
    tuples: usize,
    /// Calls that take something out to put it back.
    put_backs: usize,
}

/// A file that is looked through.
struct Walk<'a> {
    house: &'a mut House,
    room: String,
    file: String,
}

/// Whether an item is compiled for tests alone.
fn for_tests(attributes: &[syn::Attribute]) -> bool {
    attributes.iter().any(|a| {
        let path = a.path();
        path.is_ident("test")
            || path.is_ident("cfg")
                && (a.parse_args::<syn::Ident>()).is_ok_and(|only| only == "test")
    })
}

/// The name of a type without its parameters.
fn name_of(kind: &syn::Type) -> Option<String> {
    match kind {
        syn::Type::Path(path) => path.path.segments.last().map(|s| s.ident.to_string()),
        _ => None,
    }
}

impl Walk<'_> {
    fn room(&mut self) -> &mut Room {
        self.house.rooms.entry(self.room.clone()).or_default()
    }

    fn function(&mut self, signature: &syn::Signature, whole: proc_macro2::Span) {
        self.room().functions += 1;
        let lines = whole.end().line - whole.start().line + 1;
        let place = format!("{} in {}", signature.ident, self.file);
        self.house.lengths.push((lines, place));
        for input in &signature.inputs {
            let syn::FnArg::Typed(parameter) = input else {
                continue;
            };
            let mut kind = &*parameter.ty;
            while let syn::Type::Reference(inner) = kind {
                kind = &inner.elem;
            }
            if matches!(kind, syn::Type::Tuple(t) if t.elems.len() > 1) {
                self.house.tuples += 1;
            }
        }
    }
}

impl<'ast> Visit<'ast> for Walk<'_> {
    fn visit_item_mod(&mut self, item: &'ast syn::ItemMod) {
        if !for_tests(&item.attrs) {
            visit::visit_item_mod(self, item);
        }
    }

    fn visit_item_struct(&mut self, item: &'ast syn::ItemStruct) {
        self.room().structs += 1;
        if item.fields.len() > WIDE {
            let place = format!("{} in {}", item.ident, self.file);
            self.house.wide.push((item.fields.len(), place));
        }
    }

    fn visit_item_trait(&mut self, item: &'ast syn::ItemTrait) {
        self.room().traits += 1;
        visit::visit_item_trait(self, item);
    }

    fn visit_item_const(&mut self, item: &'ast syn::ItemConst) {
        let value = item.expr.span().source_text().unwrap_or_default();
        let values = self.house.constants.entry(item.ident.to_string());
        values.or_default().insert(value);
    }

    fn visit_item_fn(&mut self, item: &'ast syn::ItemFn) {
        if !for_tests(&item.attrs) {
            self.function(&item.sig, item.span());
            visit::visit_item_fn(self, item);
        }
    }

    fn visit_item_impl(&mut self, item: &'ast syn::ItemImpl) {
        if for_tests(&item.attrs) {
            return;
        }
        for part in &item.items {
            let syn::ImplItem::Fn(method) = part else {
                continue;
            };
            self.function(&method.sig, method.span());
            if let (None, Some(name)) = (&item.trait_, name_of(&item.self_ty)) {
                let own = self.house.methods.entry(name).or_default();
                own.0 += 1;
                own.1.insert(self.file.clone());
            }
        }
        visit::visit_item_impl(self, item);
    }
}

/// All files of code beneath a folder, those of tests left out.
fn sources(folder: &Path, found: &mut Vec<PathBuf>) -> Result<(), String> {
    let say = |e: std::io::Error| format!("{}: {e}", folder.display());
    for entry in fs::read_dir(folder).map_err(say)? {
        let path = entry.map_err(say)?.path();
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        if name.contains("test") {
            continue;
        }
        match path.is_dir() {
            true => sources(&path, found)?,
            false if name.ends_with(".rs") => found.push(path),
            false => {}
        }
    }
    Ok(())
}

/// Lines of code: not empty, no comments, before the tests of a file.
fn code_lines(text: &str) -> usize {
    let tests = text.find("#[cfg(test)]\nmod ").unwrap_or(text.len());
    let lines = text[..tests].lines().map(str::trim);
    lines
        .filter(|l| !l.is_empty() && !l.starts_with("//"))
        .count()
}

impl House {
    fn add(&mut self, root: &Path, path: &Path) -> Result<(), String> {
        let text = fs::read_to_string(path).map_err(|e| format!("{}: {e}", path.display()))?;
        let file = path.strip_prefix(root).unwrap_or(path);
        let parts: Vec<_> = file.iter().map(|p| p.to_string_lossy()).collect();
        // crates/NAME/src/ROOM/...
        let room = match &parts[..] {
            [_, name, _, room, _, ..] => format!("{name}/{room}"),
            [_, name, ..] => name.to_string(),
            _ => String::new(),
        };
        let entry = self.rooms.entry(room.clone()).or_default();
        entry.files += 1;
        entry.lines += code_lines(&text);
        for call in ["mem::take(", "mem::replace(", "mem::swap("] {
            self.put_backs += text.matches(call).count();
        }
        let parsed = syn::parse_file(&text).map_err(|e| format!("{}: {e}", path.display()))?;
        let file = file.display().to_string();
        Walk {
            house: self,
            room,
            file,
        }
        .visit_file(&parsed);
        Ok(())
    }

    fn print(mut self) {
        println!(
            "| room | files | lines of code | structs | traits | functions |\n|---|---|---|---|---|---|"
        );
        let mut all = Room::default();
        for (name, r) in &self.rooms {
            println!(
                "| {name} | {} | {} | {} | {} | {} |",
                r.files, r.lines, r.structs, r.traits, r.functions
            );
            all.files += r.files;
            all.lines += r.lines;
            all.structs += r.structs;
            all.traits += r.traits;
            all.functions += r.functions;
        }
        println!(
            "| all | {} | {} | {} | {} | {} |\n",
            all.files, all.lines, all.structs, all.traits, all.functions
        );
        let many = self.constants.values().filter(|v| v.len() > 1).count();
        self.lengths.sort_by(|a, b| b.cmp(a));
        let long = self.lengths.iter().filter(|l| l.0 > LONG).count();
        let spread = self.methods.values().filter(|m| m.1.len() > 1).count();
        println!("| | |\n|---|---|");
        println!("| parameters that are tuples | {} |", self.tuples);
        println!("| put-backs | {} |", self.put_backs);
        println!(
            "| structs of more than {WIDE} fields | {} |",
            self.wide.len()
        );
        println!("| functions of more than {LONG} lines | {long} |");
        println!("| names of constants | {} |", self.constants.len());
        println!("| of these with several values | {many} |");
        println!("| types with methods in several files | {spread} |\n");
        println!("| type | methods | files |\n|---|---|---|");
        let mut types: Vec<_> = self.methods.iter().collect();
        types.sort_by_key(|(name, (count, _))| (std::cmp::Reverse(*count), (*name).clone()));
        for (name, (count, files)) in types.into_iter().take(LISTED) {
            println!("| {name} | {count} | {} |", files.len());
        }
        println!("\n| function | lines |\n|---|---|");
        for (lines, place) in self.lengths.iter().take(LISTED) {
            println!("| {place} | {lines} |");
        }
        self.wide.sort_by(|a, b| b.cmp(a));
        println!("\n| struct | fields |\n|---|---|");
        for (fields, place) in &self.wide {
            println!("| {place} | {fields} |");
        }
    }
}

/// Counts and prints tables in Markdown.
pub fn count() -> Result<(), String> {
    let root = workspace::root();
    let mut files = Vec::new();
    let crates = fs::read_dir(root.join("crates")).map_err(|e| e.to_string())?;
    for folder in crates.flatten() {
        sources(&folder.path().join("src"), &mut files)?;
    }
    files.sort();
    let mut house = House::default();
    for file in &files {
        house.add(&root, file)?;
    }
    house.print();
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tests_and_comments_are_no_lines_of_code() {
        let text = "// why\nfn f() {}\n\n/// what\nstruct S;\n#[cfg(test)]\nmod tests {\n}\n";
        assert_eq!(code_lines(text), 2);
    }

    #[test]
    fn what_an_item_has_is_counted_once() {
        let text = "impl S { fn a(&self, x: &(f64, f64)) {} fn b(&self) { fn c() {} } }\n\
                    #[cfg(test)] mod tests { fn d() {} }\nconst E: f64 = 1.0;";
        let mut house = House::default();
        let parsed = syn::parse_file(text).expect("code");
        let (room, file) = (String::new(), String::new());
        Walk {
            house: &mut house,
            room,
            file,
        }
        .visit_file(&parsed);
        assert_eq!((house.tuples, house.methods["S"].0), (1, 2));
        assert_eq!((house.rooms[""].functions, house.constants.len()), (3, 1));
    }
}

//! The files of a crate and the arrows between them: who imports what from whom.
//!
//! An arrow ends at the file that defines what is imported, however many `pub use` lie between: a `mod.rs` that only declares and hands on is in nobody's
//! way. What it hands on of the folders beneath it is its table of contents and no arrow. If its own code uses such a name, or if it defines something
//! that the files beneath it import, there are arrows like any other. Globs count as imports of the module. Methods are not seen: they belong to their type, see [`methods`](super::methods).

use std::collections::BTreeMap;
use std::path::{Path as FilePath, PathBuf};

use super::imports::{Imports, Path};

/// A module by its names from the root of the crate.
pub type Module = Vec<String>;

/// Where something is imported.
#[derive(Debug, Clone)]
pub struct Arrow {
    pub from: Module,
    pub to: Module,
    /// File of `from`.
    pub file: PathBuf,
    /// Line, from 1.
    pub line: usize,
    /// The path as it is written.
    pub path: String,
}

/// The source files of a crate.
#[derive(Debug, Default)]
pub struct Tree {
    pub files: BTreeMap<Module, PathBuf>,
    imports: BTreeMap<Module, Imports>,
    macros: BTreeMap<String, Module>,
}

/// All source files below `folder`, in a fixed order.
fn sources(folder: &FilePath) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).expect("a folder of sources");
    let mut entries: Vec<PathBuf> = entries.map(|e| e.expect("an entry").path()).collect();
    entries.sort();
    let mut out = Vec::new();
    for path in entries {
        if path.is_dir() {
            out.extend(sources(&path));
        } else if path.extension().is_some_and(|e| e == "rs") {
            out.push(path);
        }
    }
    out
}

/// The module of a file of the folder `src`.
fn module(src: &FilePath, file: &FilePath) -> Module {
    let below = file.strip_prefix(src).expect("a file of the folder");
    let mut names: Module = below
        .with_extension("")
        .iter()
        .map(|n| n.to_string_lossy().into_owned())
        .collect();
    if names.last().is_some_and(|n| n == "mod") || ["lib", "main"].contains(&names[0].as_str()) {
        names.pop();
    }
    names
}

impl Tree {
    /// Reads all files of folders `src`, lowest first: the root of the last one is the root of all, and hands on the rooms of the others. A `main.rs`
    /// beside a `lib.rs` is a program that uses the library, and left out.
    pub fn read(folders: &[&FilePath]) -> Self {
        let mut texts = Vec::new();
        for src in folders {
            let library = src.join("lib.rs").exists();
            for file in sources(src) {
                if library && file == src.join("main.rs") {
                    continue;
                }
                let text = std::fs::read_to_string(&file).expect("a source file");
                texts.push((module(src, &file), file, text));
            }
        }
        Self::of(texts)
    }

    /// The same of modules, files and their texts.
    pub fn of(texts: Vec<(Module, PathBuf, String)>) -> Self {
        let mut tree = Tree::default();
        for (module, file, text) in texts {
            tree.imports.insert(module.clone(), Imports::read(&text));
            tree.files.insert(module, file);
        }
        let of_tests: Vec<Module> = tree.modules_of_tests();
        let keep = |m: &Module| !of_tests.iter().any(|t| m.starts_with(t));
        tree.files.retain(|m, _| keep(m));
        tree.imports.retain(|m, _| keep(m));
        for (module, imports) in &tree.imports {
            let own = imports
                .macros
                .iter()
                .map(|name| (name.clone(), module.clone()));
            tree.macros.extend(own);
        }
        tree
    }

    fn modules_of_tests(&self) -> Vec<Module> {
        let declared = self.imports.iter().flat_map(|(module, imports)| {
            imports.tests.iter().map(|name| {
                let mut path = module.clone();
                path.push(name.clone());
                path
            })
        });
        declared.collect()
    }

    /// A path as it is written in `module`, from the root of the crate; `None` for what is of other crates.
    fn absolute(&self, module: &Module, names: &[String]) -> Option<Module> {
        let ups = names.iter().take_while(|n| *n == "super").count();
        let stem = match names[0].as_str() {
            "crate" => return Some(names[1..].to_vec()),
            "self" => return Some([module, &names[1..]].concat()),
            "super" => &module[..module.len().saturating_sub(ups)],
            _ => {
                let whole = [module.as_slice(), names].concat();
                return self
                    .files
                    .contains_key(&whole[..=module.len()])
                    .then_some(whole);
            }
        };
        Some([stem, &names[ups..]].concat())
    }

    /// The file that defines what a path from the root names.
    fn definer(&self, path: &[String], depth: usize) -> Module {
        let longest = (0..=path.len())
            .rev()
            .find(|n| self.files.contains_key(&path[..*n]));
        let (base, rest) = path.split_at(longest.unwrap_or(0));
        let base = base.to_vec();
        let (Some(name), Some(imports)) = (rest.first(), self.imports.get(&base)) else {
            return base;
        };
        if base.is_empty()
            && let Some(module) = self.macros.get(name)
        {
            return module.clone();
        }
        if imports.items.contains(name) || depth > 8 {
            return base;
        }
        for import in imports.exports.iter().chain(&imports.uses) {
            let Some(target) = self.absolute(&base, &import.names) else {
                continue;
            };
            if import.alias == *name {
                return self.definer(&[&target, &rest[1..]].concat(), depth + 1);
            }
            if import.alias == "*" {
                let inner = [&target[..target.len() - 1], rest].concat();
                let found = self.definer(&inner, depth + 1);
                if self
                    .imports
                    .get(&found)
                    .is_some_and(|i| i.items.contains(name))
                {
                    return found;
                }
            }
        }
        base
    }

    /// What a path of the code of a module names, from the root; a name that nothing imports is one of the module.
    pub fn defined(&self, module: &Module, names: &[String]) -> Module {
        let imports = &self.imports[module];
        let known = imports.uses.iter().chain(&imports.exports);
        let found = match { known }.find(|i| i.alias == names[0]) {
            Some(import) => {
                (self.absolute(module, &import.names)).map(|stem| [&stem, &names[1..]].concat())
            }
            None => self.absolute(module, names),
        };
        let home = found.map_or_else(|| module.clone(), |path| self.definer(&path, 0));
        [&home, &names[names.len() - 1..]].concat()
    }

    /// All arrows of a file, at most one to each other file: that of the first line.
    fn arrows_of(&self, module: &Module) -> Vec<Arrow> {
        let imports = &self.imports[module];
        let mut out: BTreeMap<Module, Arrow> = BTreeMap::new();
        let mut add = |target: &[String], path: &Path, contents: bool| {
            let to = self.definer(target, 0);
            if to == *module || contents && to.starts_with(module) {
                return;
            }
            let arrow = Arrow {
                from: module.clone(),
                to: to.clone(),
                file: self.files[module].clone(),
                line: path.line,
                path: path.names.join("::"),
            };
            let known = out.entry(to).or_insert_with(|| arrow.clone());
            if arrow.line < known.line {
                *known = arrow;
            }
        };
        for (list, contents) in [(&imports.uses, false), (&imports.exports, true)] {
            for path in list {
                if let Some(target) = self.absolute(module, &path.names) {
                    add(&target, path, contents);
                }
            }
        }
        let known = || imports.uses.iter().chain(&imports.exports);
        for path in &imports.mentions {
            if let Some(import) = known().find(|i| i.alias == path.names[0]) {
                if let Some(stem) = self.absolute(module, &import.names) {
                    add(&[&stem, &path.names[1..]].concat(), path, false);
                }
            } else if path.names.len() > 1
                && let Some(target) = self.absolute(module, &path.names)
            {
                add(&target, path, false);
            }
        }
        out.into_values().collect()
    }

    /// All arrows of the crate.
    pub fn arrows(&self) -> Vec<Arrow> {
        self.files.keys().flat_map(|m| self.arrows_of(m)).collect()
    }

    /// The other crates that the code names, of those given.
    pub fn crates(&self, names: &[String]) -> Vec<String> {
        let heads = |i: &Imports| -> Vec<String> {
            let all = i.uses.iter().chain(&i.exports).chain(&i.mentions);
            all.map(|p| p.names[0].clone()).collect()
        };
        let mut out: Vec<String> = self.imports.values().flat_map(heads).collect();
        out.retain(|n| names.contains(n));
        out.sort();
        out.dedup();
        out
    }
}

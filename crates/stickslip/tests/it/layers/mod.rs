//! The map of `ARCHITECTURE.md`, held against the code of the whole workspace.
//!
//! A module of the library knows only the layers below it, and inside every folder of every crate files and folders have an order: nothing imports from
//! what comes later. Every import is followed to the file that defines what it names ([`tree`]), so a group, `super::` or a name that is handed on hides
//! nothing.

mod imports;
mod methods;
mod parameters;
mod picture;
mod rooms;
mod tokens;
mod tree;
mod words;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use methods::Methods;
use tree::{Arrow, Module, Tree};

/// The crates of the library, lowest first, and the layers in each. Modules of one layer do not know each other.
const LIBRARY: &[(&str, &[&[&str]])] = &[
    (
        "stickslip_base",
        &[
            &["number"],
            &[
                "error",
                "keep",
                "machine",
                "math",
                "owner",
                "references",
                "registry",
                "tolerance",
                "units",
            ],
            &["linear"],
        ],
    ),
    (
        "stickslip_mechanics",
        &[
            &["friction", "material", "shape"],
            &["mesh"],
            &["system"],
            &["body", "contact", "newton"],
        ],
    ),
    (
        "stickslip",
        &[
            &["io", "time"],
            &["fatigue", "roughness"],
            &["model"],
            &["solve"],
            &["integrate", "modal"],
            &["assess"],
            &["results"],
            &["run"],
            &["problem"],
        ],
    ),
];

/// What the numbers-only parts of contact may import besides themselves.
const NUMBERS: &[&str] = &["math", "references", "registry", "tolerance"];

/// Types whose files still call each other in circles: the list may only become shorter.
const CIRCULAR: &[&str] = &[];

/// Types with methods in more than one file, and in how many: the list may only become shorter.
const SPREAD: &[(&str, usize)] = &[("results::Results", 2)];

/// Where this variable is set the picture is written instead of compared: `cargo xtask rooms` does that.
const WRITE: &str = "STICKSLIP_WRITE_ROOMS";

fn workspace() -> PathBuf {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    here.ancestors()
        .nth(2)
        .expect("the workspace")
        .to_path_buf()
}

/// All crates, those of `tools` too, by the name under which code imports them, with their folder `src`.
fn crates() -> BTreeMap<String, PathBuf> {
    let folder = |path: PathBuf| {
        let name = path.file_name()?.to_string_lossy().replace('-', "_");
        Some((name, path.join("src"))).filter(|(_, src)| src.is_dir())
    };
    let mut paths = vec![workspace().join("xtask")];
    for all in ["crates", "tools"] {
        let entries = std::fs::read_dir(workspace().join(all)).expect("a folder of crates");
        paths.extend(entries.map(|e| e.expect("an entry").path()));
    }
    paths.into_iter().filter_map(folder).collect()
}

/// The library as one tree: each crate of it knows the rooms of those below by the same names.
fn library() -> Tree {
    let crates = crates();
    let all: Vec<&Path> = LIBRARY
        .iter()
        .map(|(name, _)| crates[*name].as_path())
        .collect();
    Tree::read(&all)
}

/// The library, and the other crates by name.
fn trees() -> Vec<(String, Tree)> {
    let others = crates().into_iter().filter(|(name, _)| !in_library(name));
    let others = others.map(|(name, src)| (name, Tree::read(&[&src])));
    [("the library".to_string(), library())]
        .into_iter()
        .chain(others)
        .collect()
}

/// The methods of all types of all crates.
fn all_methods() -> Vec<(String, Methods)> {
    let read = |tree: &Tree| {
        methods::methods(tree, |module| {
            std::fs::read_to_string(&tree.files[module]).expect("a source file")
        })
    };
    trees().iter().flat_map(|(_, tree)| read(tree)).collect()
}

fn in_library(name: &str) -> bool {
    LIBRARY.iter().any(|(own, _)| *own == name)
}

fn layer(module: &str) -> Option<usize> {
    let mut layers = LIBRARY.iter().flat_map(|(_, layers)| *layers);
    layers.position(|modules| modules.contains(&module))
}

/// `FILE:LINE: PATH` of an arrow.
fn place(arrow: &Arrow) -> String {
    format!("{}:{}: `{}`", arrow.file.display(), arrow.line, arrow.path)
}

#[test]
fn modules_know_only_the_layers_below() {
    let arrows = library().arrows();
    let between = arrows.iter().filter_map(|a| {
        let (from, to) = (a.from.first()?, a.to.first()?);
        (from != to).then_some((a, layer(from), layer(to)))
    });
    let between: Vec<_> = between.collect();
    assert!(
        between.len() > 100,
        "the scan is broken: {} arrows",
        between.len()
    );
    let up = between.iter().filter(|(_, from, to)| to >= from);
    let up: Vec<String> = up.map(|(a, ..)| place(a)).collect();
    assert!(up.is_empty(), "arrows up or aside:\n{}", up.join("\n"));
}

#[test]
fn every_room_has_an_order() {
    let mut wrong = Vec::new();
    for (name, tree) in trees() {
        let arrows = tree.arrows();
        for room in rooms::rooms(&tree) {
            for circle in rooms::circles(&rooms::plan(&arrows, &room)) {
                let room = room.join("::");
                wrong.push(format!("{name} {room}:\n{}", rooms::sentence(&circle)));
            }
        }
    }
    assert!(wrong.is_empty(), "circles in\n{}", wrong.join("\n"));
}

#[test]
fn methods_of_a_type_call_down_its_files() {
    let mut left = CIRCULAR.to_vec();
    let mut wrong = Vec::new();
    for (kind, methods) in all_methods() {
        let circles = rooms::circles(&methods.plan());
        if !circles.is_empty() && left.contains(&kind.as_str()) {
            left.retain(|l| *l != kind);
            continue;
        }
        let sentences = circles.iter().map(|c| rooms::sentence(c));
        wrong.extend(sentences.map(|s| format!("{kind}:\n{s}")));
    }
    assert!(wrong.is_empty(), "circles of calls\n{}", wrong.join("\n"));
    assert!(
        left.is_empty(),
        "no circles any more, take them off the list: {left:?}"
    );
}

#[test]
fn the_methods_of_a_type_are_in_one_file() {
    let files = all_methods();
    let files = files.iter().map(|(kind, m)| (kind.as_str(), m.modules()));
    let spread: BTreeMap<&str, usize> = files.filter(|(_, files)| *files > 1).collect();
    let listed: BTreeMap<&str, usize> = SPREAD.iter().copied().collect();
    assert_eq!(
        spread, listed,
        "methods of a type in several files: the list may only become shorter"
    );
}

#[test]
fn laws_and_enforcement_see_numbers_only() {
    let own = |m: &Module| {
        m.len() > 1 && m[0] == "contact" && ["law", "enforcement"].contains(&m[1].as_str())
    };
    let arrows = library().arrows();
    let of_laws: Vec<&Arrow> = arrows.iter().filter(|a| own(&a.from)).collect();
    assert!(
        of_laws.len() > 20,
        "the scan is broken: {} arrows",
        of_laws.len()
    );
    let wrong = of_laws.into_iter().filter(|a| {
        let numbers =
            a.to.first()
                .is_some_and(|to| NUMBERS.contains(&to.as_str()));
        // What friction allows is numbers as well, which the friction problem shares with the laws.
        !own(&a.to) && !numbers && a.to != ["friction", "cone"] && a.to != ["friction", "ellipse"]
    });
    let wrong: Vec<String> = wrong.map(place).collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn every_module_of_the_library_has_a_layer_and_exists() {
    for (name, layers) in LIBRARY {
        let tree = Tree::read(&[&crates()[*name]]);
        let mut tops: Vec<&str> = tree
            .files
            .keys()
            .filter_map(|m| Some(m.first()?.as_str()))
            .collect();
        tops.dedup();
        let mut listed: Vec<&str> = layers.iter().copied().flatten().copied().collect();
        listed.sort_unstable();
        assert_eq!(tops, listed, "{name}");
    }
}

#[test]
fn identifiers_are_words_of_the_field() {
    let mut wrong = Vec::new();
    for (_, src) in crates() {
        for file in Tree::read(&[&src]).files.values() {
            let text = std::fs::read_to_string(file).expect("a source file");
            let found = words::refused(&text);
            wrong.extend(found.iter().map(|f| format!("{}:{f}", file.display())));
        }
    }
    assert!(wrong.is_empty(), "write instead:\n{}", wrong.join("\n"));
}

/// Files under a folder whose names end so.
fn texts(folder: &Path, ending: &str, out: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            texts(&path, ending, out);
        } else if path.to_string_lossy().ends_with(ending) {
            out.push(path);
        }
    }
}

#[test]
fn comments_messages_and_pages_are_plain_english() {
    let mut files = Vec::new();
    for (_, src) in crates() {
        texts(&src, ".rs", &mut files);
    }
    texts(&workspace().join("book"), ".md", &mut files);
    texts(&workspace().join("examples"), "README.md", &mut files);
    let pages = ["README.md", "ARCHITECTURE.md"];
    files.extend(pages.map(|page| workspace().join(page)));
    let guide = workspace().join("CONTRIBUTING.md");
    let guide_text = std::fs::read_to_string(&guide).expect("the style guide");
    let phrases = words::phrases(&guide_text);
    assert!(phrases.len() >= 30, "only {} phrases", phrases.len());
    let texts = files.into_iter().map(|file| {
        let text = std::fs::read_to_string(&file).expect("a text");
        (file, text)
    });
    let mut wrong = Vec::new();
    for (file, text) in texts.chain([(guide, words::without_table(&guide_text))]) {
        let found = words::refused_phrases(&text, &phrases);
        wrong.extend(found.iter().map(|f| format!("{}:{f}", file.display())));
    }
    assert!(wrong.is_empty(), "write instead:\n{}", wrong.join("\n"));
}

#[test]
fn parameters_have_names() {
    let mut wrong = Vec::new();
    for (_, src) in crates() {
        for file in Tree::read(&[&src]).files.values() {
            let text = std::fs::read_to_string(file).expect("a source file");
            let found = parameters::tuples(&text);
            wrong.extend(found.iter().map(|f| format!("{}:{f}", file.display())));
        }
    }
    let wrong = wrong.join("\n");
    assert!(
        wrong.is_empty(),
        "give tuples a struct with names:\n{wrong}"
    );
}

#[test]
fn the_picture_of_the_rooms_is_current() {
    let names: Vec<String> = crates().into_keys().collect();
    let mut between = picture::Arrows::new();
    for (name, src) in crates() {
        let mut used = Tree::read(&[&src]).crates(&names);
        // The programs of a crate use its own library.
        used.retain(|u| *u != name);
        between.insert(name, used.into_iter().collect());
    }
    let mut rooms = picture::Arrows::new();
    for arrow in library().arrows() {
        if let (Some(from), Some(to)) = (arrow.from.first(), arrow.to.first())
            && from != to
        {
            rooms.entry(from.clone()).or_default().insert(to.clone());
        }
    }
    let file = workspace().join("ARCHITECTURE.md");
    let text = std::fs::read_to_string(&file).expect("ARCHITECTURE.md");
    let drawn = picture::draw(LIBRARY, &rooms, &between);
    let current =
        picture::placed(&text, &drawn).expect("the marks of the picture in ARCHITECTURE.md");
    if std::env::var_os(WRITE).is_some() {
        std::fs::write(&file, current).expect("ARCHITECTURE.md can be written");
        return;
    }
    assert!(
        text == current,
        "the picture in ARCHITECTURE.md is not current: run `cargo xtask rooms`"
    );
}

/// A crate of the given files, as `(module, text)`.
fn sample(texts: &[(&str, &str)]) -> Tree {
    let one = |(module, text): &(&str, &str)| {
        let names: Module = module
            .split("::")
            .filter(|n| !n.is_empty())
            .map(str::to_string)
            .collect();
        (names, PathBuf::from(module), text.to_string())
    };
    Tree::of(texts.iter().map(one).collect())
}

#[test]
fn a_circle_of_calls_between_files_of_a_type_is_found() {
    let files = [
        ("", "mod a; mod b; mod c;"),
        (
            "a",
            "pub struct S<T>(T);\nimpl<T: Fn() -> u8> S<T> where T: Copy { fn one(&self) { self.two() } }",
        ),
        (
            "b",
            "use crate::a::S;\nimpl<T> S<T> { pub fn two(&self) { self.last(); self.three.one() } }",
        ),
        (
            "c",
            "use super::a;\nimpl<T> Clone for a::S<T> { fn clone(&self) -> Self { Self::one(self) } }\nstruct S;\n\
            impl S { fn one(&self) -> impl Fn() { || self.two() } fn last(&self) {} }",
        ),
    ];
    let found = |more: &str| -> Vec<(String, usize, Vec<String>)> {
        let mut files = files.map(|(name, text)| (name, text.to_string()));
        files[2].1 += more;
        let tree = sample(&files.each_ref().map(|(name, text)| (*name, text.as_str())));
        let read = |m: &Module| {
            files
                .iter()
                .find(|f| f.0 == m.join("::"))
                .expect("it")
                .1
                .clone()
        };
        let all = methods::methods(&tree, read).into_iter();
        let circles = |m: &Methods| {
            rooms::circles(&m.plan())
                .iter()
                .map(|c| rooms::sentence(c))
                .collect()
        };
        all.map(|(kind, m)| (kind, m.modules(), circles(&m)))
            .collect()
    };
    assert_eq!(
        found(""),
        [("a::S".into(), 2, vec![]), ("c::S".into(), 1, vec![])]
    );
    let up = "\n#[cfg(test)]\nimpl<T> S<T> { fn f(&self) { self.one() } }\nimpl<T> S<T> { fn g() { Self::one() } }";
    let circle = "  a:2: `two`: a -> b\n  b:5: `one`: b -> a";
    assert_eq!(found(up)[0], ("a::S".into(), 2, vec![circle.into()]));
}

/// The arrows of a sample as `from -> to:line`.
fn arrows(texts: &[(&str, &str)]) -> Vec<String> {
    let line = |a: Arrow| format!("{} -> {}:{}", a.from.join("::"), a.to.join("::"), a.line);
    sample(texts).arrows().into_iter().map(line).collect()
}

#[test]
fn imports_are_followed_to_where_things_are_defined() {
    let found = arrows(&[
        ("", "mod a; mod b; mod c;"),
        (
            "a",
            "mod inner;\npub use inner::Deep as Named;\npub fn of_a() {}",
        ),
        ("a::inner", "pub struct Deep;"),
        (
            "b",
            "use crate::{c::{self, Third}, a::Named};\nfn f() { c::third(); super::a::of_a(); }",
        ),
        ("c", "pub struct Third; pub fn third() {}"),
    ]);
    assert_eq!(found, ["b -> a:2", "b -> a::inner:1", "b -> c:1"]);
}

#[test]
fn a_table_of_contents_is_no_arrow_and_its_use_is() {
    let contents = ("room", "mod part;\npub use part::Part;");
    let using = (
        "room",
        "mod part;\npub use part::Part;\npub enum All { Part(Part) }",
    );
    let part = ("room::part", "use super::All;\npub struct Part;");
    assert_eq!(
        arrows(&[("", "mod room;"), contents, part]),
        ["room::part -> room:1"]
    );
    let both = ["room -> room::part:3", "room::part -> room:1"];
    assert_eq!(arrows(&[("", "mod room;"), using, part]), both);
}

#[test]
fn comments_strings_and_tests_import_nothing() {
    let text = "// use crate::b::B;\n/* crate::b::B /* nested */ crate::b::B */\nconst S: &str = \"crate::b::\\\"B\"; const R: &str = r#\"crate::b\"B\"#;\n\
        const Q: char = '\"'; fn f<'a>(x: &'a str) -> impl Iterator<Item = u8> + use<'a> {}\n#[cfg(test)]\nmod tests { use crate::b::B; }\n#[cfg(test)]\nuse crate::b::{B, C};\n\
        #[cfg(test)]\nmod helper;\nfn last() { crate::c::third() }";
    let found = arrows(&[
        ("a", text),
        ("a::helper", "use crate::b::B;"),
        ("b", "pub struct B;"),
        ("c", "pub fn third() {}"),
    ]);
    assert_eq!(found, ["a -> c:11"]);
}

#[test]
fn tuples_among_parameters_are_found_and_what_looks_like_them_is_not() {
    let text = "fn plain(a: f64, f: &mut (dyn FnMut(&[usize], &[f64]) + Send), [x, y]: [f64; 2], b: &[Block<f32, 1>]) {}\n\
        fn pair<T: Fn(f64) -> f64>(t: T, (a, b): (f64, &str)) {}\nfn named(of: &'static (u8, u8)) -> (u8, u8) { of.clone() }\n\
        fn within(all: Vec<(usize, f64)>, f: impl Fn((u8, u8))) { let c = |(a, b): (u8, u8)| a + b; }\n#[cfg(test)]\nfn test((a, b): (u8, u8)) {}";
    assert_eq!(parameters::tuples(text), ["2: pair", "3: named"]);
}

#[test]
fn a_circle_of_rooms_is_found_with_its_imports() {
    let tree = sample(&[
        ("", "mod law; mod side;"),
        ("law", "mod first; mod second;"),
        ("law::first", "use crate::side::near::Near;"),
        ("law::second", "pub struct Second;"),
        ("side", "mod near; mod far;"),
        ("side::near", "pub struct Near;"),
        ("side::far", "\nuse crate::law::second::Second;"),
    ]);
    let found = rooms::circles(&rooms::plan(&tree.arrows(), &[]));
    let expected = "  law::first:1: `crate::side::near::Near`: law::first -> side::near\n  side::far:2: `crate::law::second::Second`: side::far -> law::second";
    assert_eq!(
        found.iter().map(|c| rooms::sentence(c)).collect::<Vec<_>>(),
        [expected]
    );
    assert!(rooms::circles(&rooms::plan(&tree.arrows(), &["law".to_string()])).is_empty());
}

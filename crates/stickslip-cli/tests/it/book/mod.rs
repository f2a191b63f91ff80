//! What the book says is so: its problem files are sound, its commands do what is said, its links lead somewhere.
//!
//! Rules for pages that are written by hand:
//!
//! - a block that begins with `# file: NAME` (or `**`, for decks) is saved under that name for the commands of the page;
//! - a `toml` block with `format = 1` is a whole problem file and must be sound; `toml,fragment` is part of one, with keys that exist;
//! - commands in `sh` blocks that begin with `stickslip`, or make a file by `sed`, are run in the order of the page; others are for people. The line says the exit code if it is not 0:
//!   `# exit code 2`;
//! - a `text` block behind commands is what they print, line by line;
//! - what the text claims of results stands in comments behind the commands, and is held against the results: see `asserted.rs`.

mod asserted;

use crate::support;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Command;

use stickslip::problem::Document;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn source() -> PathBuf {
    root().join("book/src")
}

/// The second book: verification and internals.
fn second() -> PathBuf {
    root().join("book/verification/src")
}

/// All pages of the book for users.
fn pages() -> Vec<PathBuf> {
    pages_of(&source())
}

fn pages_of(book: &Path) -> Vec<PathBuf> {
    fn collect(folder: &Path, out: &mut Vec<PathBuf>) {
        for entry in std::fs::read_dir(folder).expect("a folder of the book") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                collect(&path, out);
            } else if path.extension().is_some_and(|e| e == "md") {
                out.push(path);
            }
        }
    }
    let mut out = Vec::new();
    collect(book, &mut out);
    out.sort();
    out
}

/// Pages that a program writes have no snippets to follow.
fn generated(page: &Path) -> bool {
    let name = page.strip_prefix(source()).expect("a page");
    name.starts_with("reference")
}

fn read(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

/// The marks of a comment among those of blocks.
const COMMENT: &str = "<!--";

/// `(language and marks, text)` of the fenced blocks of a page, and of its comments; those inside of lists too.
fn blocks(text: &str) -> Vec<(String, String)> {
    let mut out = Vec::new();
    let mut open: Option<(String, usize, String)> = None;
    let mut comment: Option<String> = None;
    for line in text.lines() {
        let begun = line.trim_start().strip_prefix(COMMENT);
        if let Some(text) = begun.filter(|_| open.is_none() && comment.is_none()) {
            comment = Some(String::new());
            // Its end may stand on the same line.
            if let Some(all) = &mut comment {
                all.push_str(text);
            }
        } else if let Some(all) = &mut comment {
            all.push('\n');
            all.push_str(line);
        }
        if let Some(all) = comment.as_ref().and_then(|all| all.split_once("-->")) {
            out.push((COMMENT.to_string(), all.0.to_string()));
            comment = None;
            continue;
        }
        if comment.is_some() {
            continue;
        }
        let indent = line.len() - line.trim_start().len();
        match (&mut open, line.trim_start().strip_prefix("```")) {
            (None, Some(marks)) => open = Some((marks.trim().to_string(), indent, String::new())),
            (Some(_), Some(_)) => out.extend(open.take().map(|(marks, _, text)| (marks, text))),
            (Some((_, indent, text)), None) => {
                text.push_str(line.get(*indent..).unwrap_or("").trim_end());
                text.push('\n');
            }
            (None, None) => {}
        }
    }
    out
}

/// The name under which a block is to be saved.
fn file_name(block: &str) -> Option<&str> {
    let first = block.lines().next()?;
    ["# file:", "** file:", "// file:"]
        .iter()
        .find_map(|mark| first.strip_prefix(mark))
        .map(str::trim)
}

fn copy(from: &Path, to: &Path) {
    std::fs::create_dir_all(to).expect("a folder");
    for entry in std::fs::read_dir(from).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.is_file() {
            std::fs::copy(&path, to.join(path.file_name().expect("a name"))).expect("a copy");
        }
    }
}

/// An empty folder for a page, with the examples that it names.
fn folder(page: &Path, text: &str) -> PathBuf {
    let name = page.strip_prefix(source()).expect("a page");
    let name = name.with_extension("").to_string_lossy().replace('/', "-");
    let folder = support::folder("book", &name);
    for part in text.split("examples/").skip(1) {
        let end = part
            .find(|c: char| !c.is_alphanumeric() && c != '-')
            .unwrap_or(part.len());
        let from = root().join("examples").join(&part[..end]);
        if end > 0 && from.is_dir() {
            copy(&from, &folder.join("examples").join(&part[..end]));
        }
    }
    folder
}

/// Runs a line as a person would type it: the exit code, and what it prints.
fn follow(line: &str, folder: &Path) -> (Option<i32>, String) {
    let binary = Path::new(env!("CARGO_BIN_EXE_stickslip"));
    let mut path = binary.parent().expect("a folder").as_os_str().to_owned();
    path.push(":");
    path.push(std::env::var_os("PATH").unwrap_or_default());
    let output = Command::new("sh")
        .args(["-c", line])
        .current_dir(folder)
        .env("PATH", path)
        .output()
        .expect("a shell");
    let printed = [output.stdout, output.stderr];
    let printed = printed.map(|bytes| String::from_utf8_lossy(&bytes).into_owned());
    (output.status.code(), printed.concat())
}

#[test]
#[cfg(unix)]
fn commands_do_what_the_book_says() {
    let (mut followed, mut held, mut wrong) = (0, 0, Vec::new());
    for page in pages().into_iter().filter(|p| !generated(p)) {
        let text = read(&page);
        let blocks = blocks(&text);
        let mine = |line: &str| line.starts_with("stickslip ") || line.starts_with("sed ");
        let commands = |marks: &str| marks == "sh" || marks == "console";
        if !blocks
            .iter()
            .any(|(marks, text)| commands(marks) && text.lines().any(mine))
        {
            continue;
        }
        let folder = folder(&page, &text);
        let mut said = String::new();
        for (marks, block) in &blocks {
            if marks == COMMENT {
                let Some(claim) = asserted::claim(block) else {
                    continue;
                };
                let said = asserted::Said(&said);
                if let Err(why) = asserted::hold(claim, &folder, &said) {
                    wrong.push(format!("{}: {claim}\n{why}", page.display()));
                }
                held += 1;
            }
            if let Some(name) = file_name(block) {
                std::fs::write(folder.join(name), block).expect("the folder can be written to");
            }
            if marks == "text" && !said.is_empty() && file_name(block).is_none() {
                for line in block.lines() {
                    let printed = asserted::says(line, &asserted::Said(&said));
                    assert!(printed.is_ok(), "{}: {printed:?}", page.display());
                }
            }
            if !commands(marks) || !block.lines().any(mine) {
                continue;
            }
            said.clear();
            for line in block.lines().filter(|l| mine(l)) {
                let (command, wanted) = match line.split_once("# exit code ") {
                    Some((command, code)) => (command, code.trim().parse().ok()),
                    None => (line, Some(0)),
                };
                assert!(wanted.is_some(), "{}: {line}", page.display());
                let (code, printed) = follow(command, &folder);
                said += &printed;
                assert_eq!(code, wanted, "{}: {line}", page.display());
                let wide = printed.lines().find(|l| l.chars().count() > 100);
                let runs = line.starts_with("stickslip run") && wanted == Some(0);
                assert!(
                    !runs || wide.is_none(),
                    "{}: {line}: {wide:?}",
                    page.display()
                );
                followed += 1;
            }
        }
    }
    assert!(followed > 40, "only {followed} commands were found");
    assert!(wrong.is_empty(), "{}", wrong.join("\n\n"));
    assert!(held > 20, "only {held} claims were found");
}

#[test]
fn formulas_are_ones_that_the_book_can_typeset() {
    let known = read(&source().join("katex/katex.min.js"));
    let mut seen = 0;
    for page in [pages(), pages_of(&second())].concat() {
        let (text, name) = (read(&page), page.display());
        let blocks = blocks(&text);
        let blocks = blocks.iter().filter(|(marks, _)| marks == "math");
        let within = text.split("$`").skip(1);
        let within = within.filter_map(|rest| Some(rest.split_once("`$")?.0));
        for formula in blocks.map(|(_, formula)| formula.as_str()).chain(within) {
            seen += 1;
            let count = |part: &str| formula.matches(part).count();
            assert_eq!(count("{"), count("}"), "{name}: braces of {formula}");
            assert_eq!(count("\\begin"), count("\\end"), "{name}: {formula}");
            for word in formula.split('\\').skip(1) {
                let end = word.find(|c: char| !c.is_ascii_alphabetic());
                let word = &word[..end.unwrap_or(word.len())];
                let quoted = format!("\"\\\\{word}\"");
                assert!(
                    word.is_empty() || known.contains(&quoted),
                    "{name}: there is no command \\{word}"
                );
            }
        }
    }
    assert!(seen > 10, "only {seen} formulas were found");
}

#[test]
fn problem_files_in_the_book_are_sound() {
    let mut seen = 0;
    for page in pages().into_iter().filter(|p| !generated(p)) {
        for (marks, block) in blocks(&read(&page)) {
            let whole = block.lines().any(|l| l.trim() == "format = 1");
            let fragment = marks == "toml,fragment";
            if !marks.starts_with("toml") || !(whole || fragment) {
                continue;
            }
            seen += 1;
            let text = match whole {
                true => block,
                false => format!("format = 1\n{block}"),
            };
            let Err(error) = Document::new(text, None).problem() else {
                continue;
            };
            let left_out =
                ["model", "body", "step"].map(|key| format!("the key `{key}` is missing"));
            let real: Vec<&str> = error
                .findings
                .iter()
                .map(|f| f.message.as_str())
                .filter(|m| !fragment || !left_out.iter().any(|l| l == m))
                .collect();
            assert!(real.is_empty(), "{}: {real:?}", page.display());
        }
    }
    assert!(seen > 12, "only {seen} problem files were found");
}

/// The anchor that mdBook gives a heading.
fn anchor(heading: &str) -> String {
    heading
        .trim()
        .to_lowercase()
        .chars()
        .filter_map(|c| match c {
            ' ' => Some('-'),
            c if c.is_alphanumeric() || c == '-' || c == '_' => Some(c),
            _ => None,
        })
        .collect()
}

fn anchors(text: &str) -> BTreeSet<String> {
    let mut out = BTreeSet::new();
    for line in text.lines() {
        if let Some((_, rest)) = line.split_once("<a id=\"") {
            out.extend(rest.split('"').next().map(str::to_string));
        }
        if line.starts_with('#') {
            out.insert(anchor(line.trim_start_matches('#')));
        }
    }
    out
}

/// Targets of the links of a page, outside of code.
fn links(text: &str) -> Vec<String> {
    let mut prose = String::new();
    let mut code = false;
    for line in text.lines() {
        match line.trim_start().starts_with("```") {
            true => code = !code,
            false if !code => {
                // Code within a line.
                for (i, part) in line.split('`').enumerate() {
                    prose.push_str(if i % 2 == 0 { part } else { "code" });
                }
                prose.push('\n');
            }
            false => {}
        }
    }
    prose
        .split("](")
        .skip(1)
        .filter_map(|rest| rest.split(')').next().map(str::to_string))
        .collect()
}

#[test]
fn links_lead_to_pages_and_headings_that_exist() {
    let books = [source(), second()].map(|book| book.canonicalize().expect("a book"));
    for page in [pages(), pages_of(&second())].concat() {
        let here = page.parent().expect("a folder");
        for link in links(&read(&page)) {
            if link.starts_with("http") {
                continue;
            }
            let (file, heading) = link.split_once('#').unwrap_or((&link, ""));
            let target = match file.is_empty() {
                true => page.clone(),
                false => here.join(file),
            };
            assert!(target.is_file(), "{}: {link}", page.display());
            let inside = target
                .canonicalize()
                .is_ok_and(|t| books.iter().any(|book| t.starts_with(book)));
            assert!(inside, "{}: {link} is not in the books", page.display());
            if !heading.is_empty() {
                let there = anchors(&read(&target));
                assert!(there.contains(heading), "{}: {link}", page.display());
            }
        }
    }
}

#[test]
fn figures_are_shown_somewhere_and_those_of_examples_are_current() {
    let examples = std::fs::read_dir(root().join("examples")).expect("the examples");
    let guides = examples.map(|entry| entry.expect("an entry").path().join("README.md"));
    let guides = guides.filter(|guide| guide.is_file());
    let shown: String = pages()
        .into_iter()
        .chain(guides)
        .chain([root().join("README.md")])
        .map(|page| read(&page))
        .collect();
    let mut seen = 0;
    for entry in std::fs::read_dir(source().join("figures")).expect("the figures") {
        let figure = entry.expect("an entry").path();
        let name = figure.file_name().expect("a name").to_string_lossy();
        assert!(
            shown.contains(&format!("figures/{name}")),
            "{name} is not shown"
        );
        let example = root()
            .join("examples")
            .join(figure.file_stem().expect("a name"));
        if let Ok(original) = std::fs::read(example.join("figure.png")) {
            let copy = std::fs::read(&figure).expect("a figure");
            assert!(copy == original, "copy {}/figure.png", example.display());
        }
        seen += 1;
    }
    assert!(seen > 20, "only {seen} figures were found");
}

#[test]
fn every_picture_has_its_command() {
    for page in pages() {
        let text = read(&page);
        let count = |part: &str| text.matches(part).count();
        let commands = count("stickslip plot") + count("savefig");
        let pictures = count("](figures/") + count("](../figures/");
        assert!(
            pictures <= commands,
            "{}: {pictures} pictures, {commands} commands that draw",
            page.display()
        );
    }
}

#[test]
fn every_page_is_in_the_summary() {
    for book in [source(), second()] {
        let summary = read(&book.join("SUMMARY.md"));
        for page in pages_of(&book) {
            let name = page.strip_prefix(&book).expect("a page");
            let name = name.to_string_lossy();
            assert!(
                name == "SUMMARY.md" || summary.contains(&format!("({name})")),
                "{name} is not in SUMMARY.md"
            );
        }
    }
}

/// The words that the book for users may have.
const WORDS: usize = 70_000;

#[test]
fn the_book_for_users_is_not_longer_than_it_may_be() {
    let words: usize = pages()
        .iter()
        .map(|page| read(page).split_whitespace().count())
        .sum();
    assert!(
        words <= WORDS,
        "{words} words: shorten pages, or move what only developers need to book/verification"
    );
    assert!(words > WORDS / 2, "only {words} words were counted");
}

#[test]
fn the_page_of_what_goes_with_what_is_current() {
    let page = read(&source().join("reference/combinations.md"));
    let output = Command::new(env!("CARGO_BIN_EXE_stickslip"))
        .args(["models", "--matrix"])
        .output()
        .expect("the binary runs");
    let table = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(
        table.len() > 1000 && page.ends_with(&table),
        "run `cargo xtask book --pages`"
    );
}

#[test]
fn the_page_of_commands_is_current() {
    let page = read(&source().join("reference/command-line.md"));
    let output = Command::new(env!("CARGO_BIN_EXE_stickslip"))
        .arg("--help")
        .output()
        .expect("the binary runs");
    let help = String::from_utf8_lossy(&output.stdout).into_owned();
    let names = help
        .lines()
        .skip_while(|l| !l.starts_with("Commands:"))
        .skip(1)
        .take_while(|l| !l.trim().is_empty());
    for name in names.filter_map(|l| l.split_whitespace().next()) {
        if name == "help" {
            continue;
        }
        let output = Command::new(env!("CARGO_BIN_EXE_stickslip"))
            .args([name, "--help"])
            .output()
            .expect("the binary runs");
        let help = String::from_utf8_lossy(&output.stdout).into_owned();
        let lines: Vec<&str> = help.lines().map(str::trim_end).collect();
        let stale = "is stale: run `cargo xtask book --pages`";
        assert!(
            page.contains(lines.join("\n").trim()),
            "the help of {name} {stale}"
        );
    }
}

#[test]
fn the_deck_of_the_tutorial_is_there_as_a_file() {
    let page = read(&source().join("tutorial/own-deck.md"));
    let deck = read(&source().join("tutorial/job.inp"));
    assert!(page.contains(&deck));
}

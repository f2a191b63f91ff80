//! Decks that are wrong in every way we could think of, or that fuzzing found: each with the message it must give.
//!
//! `malformed/NAME.inp` has its message in `NAME.message` beside it; with `BLESS=1` in the environment the messages are written anew.
//! Read them: each has to say which file, where, what is wrong and what to do.

use std::path::{Path, PathBuf};

use stickslip_deck::Translation;

fn message(path: &Path) -> String {
    let translation: Translation =
        match stickslip_deck::read(path).and_then(|d| stickslip_deck::translate(&d, path)) {
            Ok(t) => t,
            Err(e) => return format!("{e}\n"),
        };
    let built = translation
        .document(Vec::new())
        .problem()
        .map_err(Into::into)
        .and_then(|p| p.build_with(Path::new("."), &translation.meshes()));
    match built.map_err(|e| translation.located(e)) {
        Ok(_) => panic!("{}: the mistake goes unnoticed", path.display()),
        Err(Ok(e)) => format!("{e}\n"),
        Err(Err(e)) => format!("{e}\n"),
    }
}

#[test]
fn decks_that_are_wrong_say_where_and_what_to_do() {
    let bless = std::env::var_os("BLESS").is_some();
    let entries = std::fs::read_dir("tests/malformed").expect("a folder of files");
    let mut paths: Vec<PathBuf> = entries
        .map(|entry| entry.expect("an entry").path())
        // What begins with an underscore is included by others.
        .filter(|path| path.extension().is_some_and(|e| e == "inp"))
        .filter(|path| {
            !path
                .file_name()
                .is_some_and(|n| n.to_string_lossy().starts_with('_'))
        })
        .collect();
    paths.sort();
    assert!(paths.len() >= 30, "{} files", paths.len());
    let mut wrong = Vec::new();
    for path in paths {
        let found = message(&path);
        let expected = path.with_extension("message");
        if bless {
            std::fs::write(&expected, &found).expect("the folder can be written to");
        }
        let wanted = std::fs::read_to_string(&expected).unwrap_or_default();
        let name = path.display().to_string();
        if found != wanted {
            wrong.push(format!("{name}\n--- expected\n{wanted}--- found\n{found}"));
        }
        if !found.contains("tests/malformed/") || !found.contains("help: ") {
            wrong.push(format!("{name}: no file or no help in\n{found}"));
        }
        if found.len() > 3000 {
            wrong.push(format!("{name}: a message of {} bytes", found.len()));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

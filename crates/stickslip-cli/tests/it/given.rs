//! What is given by mistake is named as what it is, with what was probably meant.

use std::path::{Path, PathBuf};

use crate::support::{CASE, code, command, folder, text};

/// A folder with a problem, a folder of results that has only what tells it is one, and files of other kinds.
fn desk(name: &str) -> PathBuf {
    let folder = folder("given", name);
    let write = |name: &str, content: &[u8]| {
        std::fs::write(folder.join(name), content).expect("the folder can be written to");
    };
    std::fs::create_dir_all(folder.join("case.out/interfaces")).expect("a folder");
    write("case.toml", CASE.as_bytes());
    write("other.toml", CASE.as_bytes());
    write("picture.png", b"\x89PNG\r\n\x1a\n");
    write("part.step", b"ISO-10303-21;\nHEADER;\n");
    write("crash.k", b"*KEYWORD\n*NODE\n");
    write("model.FCStd", b"PK\x03\x04");
    write("unnamed", b"\x89HDF\r\n\x1a\n");
    write("mesh.msh", b"$MeshFormat\n4.1 0 8\n");
    write("case.out/history.csv", b"TIME,base.CFN2\n1.0,2.0\n");
    write("case.out/interfaces/base.csv", b"x,CPRESS\n0.0,2.0\n");
    folder
}

fn says(folder: &Path, line: &str, parts: &[&str]) {
    let output = command(folder)
        .args(line.split(' '))
        .output()
        .expect("the binary runs");
    let err = text(&output.stderr);
    assert_eq!(code(&output), Some(1), "{line}: {err}");
    for part in parts {
        assert!(err.contains(part), "{line}: {part} in\n{err}");
    }
}

#[test]
fn a_file_for_a_folder_of_results_leads_to_the_folder() {
    let folder = desk("results");
    for command in ["plot", "report", "explain", "compare", "resume"] {
        let says = |what: &str, parts: &[&str]| says(&folder, &format!("{command} {what}"), parts);
        says(
            "case.toml",
            &["this is a problem file", "its results are in case.out"],
        );
        says("other.toml", &["run it first: `stickslip run other.toml`"]);
        says(
            "other.out",
            &["no such folder", "run it first: `stickslip run other.toml`"],
        );
        says("caes.out", &["no such folder", "did you mean `case.out`?"]);
        says(
            "case.out/history.csv",
            &["this is a table", "name the folder that it is in: case.out"],
        );
        says(
            "case.out/interfaces/base.csv",
            &["name the folder that it is in: case.out"],
        );
        says(
            "picture.png",
            &["this is a picture, and a folder of results is wanted"],
        );
        says("nowhere/case.out", &["there is no folder nowhere"]);
    }
    for command in ["plot", "report", "explain", "compare"] {
        says(
            &folder,
            &format!("{command} ."),
            &[
                "there are no results in this folder",
                "results are in ./case.out",
            ],
        );
    }
    says(
        &folder,
        "compare case.out",
        &[
            "expected.toml: there is no such file",
            "stickslip compare A.out B.out",
        ],
    );
    says(
        &folder,
        "compare case.out case.out/interfaces",
        &["there are no results in this folder"],
    );
}

#[test]
fn a_file_of_another_kind_is_named_as_what_it_is() {
    let folder = desk("kinds");
    for command in ["run", "check", "curve", "sweep --set a=1"] {
        let says = |what: &str, parts: &[&str]| says(&folder, &format!("{command} {what}"), parts);
        says("picture.png", &["picture.png: this is a picture"]);
        says("part.step", &["a geometry in STEP", "mesh it with Gmsh"]);
        says(
            "crash.k",
            &["this is an input deck of LS-DYNA", "export the mesh"],
        );
        says("model.FCStd", &["this is a document of FreeCAD", ".inp"]);
        says("unnamed", &["this is a file in HDF5 or MED"]);
        says("mesh.msh", &["this is a mesh of Gmsh"]);
        says("case.out", &["this is a folder"]);
        says(
            "caes.toml",
            &["there is no such file", "did you mean `case.toml`?"],
        );
        says(
            "zzzzzz.toml",
            &["there is no such file", "there are case.toml, other.toml"],
        );
    }
    says(&folder, "friction picture.png", &["this is a picture"]);
    says(&folder, "friction nothing.txt", &["there is no such file"]);
    says(
        &folder,
        "convert . a.msh",
        &["this is a folder, and a mesh or a deck is wanted"],
    );
    says(
        &folder,
        "convert mesj.msh a.vtu",
        &["did you mean `mesh.msh`?"],
    );
    says(
        &folder,
        "convert model.FCStd a.vtu",
        &["this is a document of FreeCAD"],
    );
}

#[test]
fn names_have_a_nearest_match() {
    let folder = desk("names");
    says(&folder, "models coulumb", &["did you mean `coulomb`?"]);
    says(
        &folder,
        "models fricton.coulumb",
        &["did you mean `friction.coulomb`?"],
    );
    says(
        &folder,
        "curve case.toml bese",
        &["there is no interface `bese`", "did you mean `base`?"],
    );
    says(
        &folder,
        "plot case.out --history base.CFN3",
        &["no column `base.CFN3`", "near: base.CFN2"],
    );
    says(
        &folder,
        "plot case.out --history base.CFN2 --against TME",
        &["near: TIME"],
    );
    let run = command(&folder)
        .args(["run", "case.toml", "-q", "-o", "ran.out"])
        .output();
    assert_eq!(code(&run.expect("the binary runs")), Some(0));
    says(
        &folder,
        "plot ran.out --field CPRES",
        &["did you mean `CPRESS`?"],
    );
    says(
        &folder,
        "plot ran.out --body blok",
        &["did you mean `block`?", "there are block"],
    );
    for (set, parts) in [
        (
            "interface.base.secondary=\"block.botom\"",
            "did you mean `block.bottom`?",
        ),
        ("interface.base.primary=\"flor\"", "did you mean `floor`?"),
        ("support.top.set=\"block.tpo\"", "did you mean `block.top`?"),
        ("probe.corner.of=\"blok\"", "did you mean `block`?"),
        ("body.block.material=\"steal\"", "did you mean `steel`?"),
    ] {
        let line = ["check", "case.toml", "--set", set];
        let output = command(&folder)
            .args(line)
            .output()
            .expect("the binary runs");
        let err = text(&output.stderr);
        assert!(
            code(&output) == Some(1) && err.contains(parts),
            "{set}: {err}"
        );
    }
    says(
        &folder,
        "sweep case.toml --set support.top.y=-1e-5 --column base.CFN3",
        &["near: base.CFN"],
    );
}

#[test]
fn shells_complete_models_and_fields() {
    let folder = desk("shells");
    for shell in ["bash", "zsh", "fish"] {
        let output = command(&folder)
            .args(["completions", shell])
            .output()
            .expect("the binary runs");
        let script = text(&output.stdout);
        // What stands without an option before it has no values in fish.
        let models = ["coulomb", "augmented-lagrangian"].into_iter();
        let models = models.filter(|_| shell != "fish");
        for word in models.chain(["CPRESS", "CSTATUS", "MISES", "demo"]) {
            assert!(script.contains(word), "{shell}: {word}");
        }
    }
    // Others are taken as well, and the help stays readable.
    let help = command(&folder)
        .args(["models", "--help"])
        .output()
        .expect("the binary runs");
    assert!(!text(&help.stdout).contains("augmented-lagrangian"));
}

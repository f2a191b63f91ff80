//! `stickslip convert`, `completions` and `man` from outside.

use crate::support::{stickslip, text};
use std::path::{Path, PathBuf};

fn place(name: &str) -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join(name)
}

fn convert(from: &Path, to: &Path) -> (String, String) {
    let output = stickslip(&[
        "convert",
        &from.display().to_string(),
        &to.display().to_string(),
    ]);
    let (out, err) = (text(&output.stdout), text(&output.stderr));
    assert_eq!(output.status.code(), Some(0), "{err}");
    (out, err)
}

#[test]
fn a_mesh_goes_from_format_to_format_and_back_unchanged() {
    let mesh =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../stickslip/tests/meshes/blocks-2-msh22.msh");
    let [msh, vtu, again] = ["there.msh", "there.vtu", "back.msh"].map(place);
    let (_, notes) = convert(&mesh, &msh);
    assert_eq!(notes, "");
    let (out, notes) = convert(&msh, &vtu);
    assert_eq!(notes, "");
    assert!(
        out.contains("there.vtu: ") && out.contains("facet sets: "),
        "{out}"
    );
    convert(&vtu, &again);
    let read = |path: &Path| std::fs::read_to_string(path).expect("a file");
    assert!(read(&msh) == read(&again));
    let inp = place("there.inp");
    convert(&vtu, &inp);
    assert!(read(&inp).contains("*ELEMENT, TYPE=C3D"));
}

#[test]
fn endings_that_are_not_known_are_refused() {
    for (from, to, message) in [
        ("a.msh", "b.stl", "b.stl: the ending .stl is not known"),
        ("a.msh", "b", "b: the name has no ending"),
        ("a.nas", "b.vtu", "a.nas: the ending .nas is not known"),
        ("no-such.vtu", "b.msh", "no-such.vtu: there is no such file"),
    ] {
        let output = stickslip(&["convert", from, to]);
        let err = text(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{err}");
        assert!(err.contains(message), "{err}");
    }
}

#[test]
fn completions_and_pages_name_every_command() {
    for shell in ["bash", "zsh", "fish", "powershell"] {
        let output = stickslip(&["completions", shell]);
        let script = text(&output.stdout);
        assert_eq!(output.status.code(), Some(0));
        assert!(
            script.contains("sweep") && script.contains("threads"),
            "{shell}"
        );
    }
    let page = text(&stickslip(&["man"]).stdout);
    assert!(page.contains(".TH stickslip 1"), "{page}");
    let folder = place("man");
    let output = stickslip(&["man", "-o", &folder.display().to_string()]);
    assert_eq!(output.status.code(), Some(0));
    let run = std::fs::read_to_string(folder.join("stickslip-run.1")).expect("a page");
    assert!(run.contains("threads"));
}

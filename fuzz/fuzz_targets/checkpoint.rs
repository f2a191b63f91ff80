//! Files of factors (`--cache`): with any damage the run gives the results of a run without the file.
//!
//! The input is a list of edits, three bytes of place and one of value, of a sound file; its last byte chooses how much is cut off.
#![no_main]

use std::path::PathBuf;
use std::sync::{Arc, OnceLock};

use libfuzzer_sys::fuzz_target;
use stickslip::newton::condensed::Library;
use stickslip::problem::Document;
use stickslip::run::Simulation;

const CASE: &str = r#"format = 1
model.space = "plane-strain"
body.block = { generate.rectangle = { to = [0.04, 0.02], cells = [8, 4] }, material = "steel" }
material.steel.isotropic = { young = 210e9, poisson = 0.3 }
obstacle.floor.plane = { point = [0, 0], normal = [0, 1] }
interface.base = { secondary = "block.bottom", primary = "floor" }
load.top = { set = "block.top", pressure.value = 1e6 }
support.side = { set = "block.left", x = 0.0 }
step = [{ name = "press" }]
"#;

/// The folder, its file, and the bytes of it.
fn sound() -> &'static (PathBuf, PathBuf, Vec<u8>) {
    static SOUND: OnceLock<(PathBuf, PathBuf, Vec<u8>)> = OnceLock::new();
    SOUND.get_or_init(|| {
        let folder = std::env::temp_dir().join(format!("stickslip-fuzz-{}", std::process::id()));
        run(&folder);
        let file = std::fs::read_dir(&folder)
            .expect("a folder")
            .map(|entry| entry.expect("an entry").path())
            .find(|path| path.extension().is_some_and(|e| e == "sub"))
            .expect("a file of factors");
        let bytes = std::fs::read(&file).expect("its bytes");
        (folder, file, bytes)
    })
}

fn run(folder: &std::path::Path) {
    let problem = Document::new(CASE, None).problem().expect("a sound case");
    let model = problem.build(std::path::Path::new(".")).expect("a model");
    let library = Library::in_directory(1 << 24, folder).expect("a folder");
    let mut simulation = Simulation::with_library(model, Arc::new(library)).expect("a simulation");
    simulation.run(&mut []).expect("a result");
}

fuzz_target!(|edits: &[u8]| {
    let (folder, file, bytes) = sound();
    let mut bytes = bytes.clone();
    let (fours, rest) = edits.as_chunks::<4>();
    for [a, b, c, value] in fours {
        let at = u32::from_le_bytes([*a, *b, *c, 0]) as usize % bytes.len();
        bytes[at] = *value;
    }
    if let Some(cut) = rest.first() {
        let left = bytes.len() * usize::from(255 - cut) / 255;
        bytes.truncate(left);
    }
    std::fs::write(file, bytes).expect("the folder can be written to");
    run(folder);
});

//! Small decks, their runs, and what they printed.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use stickslip::results::Observer;
use stickslip::run::Simulation;
use stickslip_deck::{Printer, Status, Translation};

/// A file of one test.
pub fn place(name: &str) -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join(name)
}

/// A deck that must be read and translated.
pub fn translate(text: &str) -> Translation {
    let path = Path::new("job.inp");
    let deck = stickslip_deck::parse(text.as_bytes(), path).unwrap_or_else(|e| panic!("{e}"));
    stickslip_deck::translate(&deck, path).unwrap_or_else(|e| panic!("{e}"))
}

/// What is said about a deck that must be refused.
pub fn refused(text: &str) -> String {
    let path = Path::new("job.inp");
    let outcome = stickslip_deck::parse(text.as_bytes(), path)
        .and_then(|d| stickslip_deck::translate(&d, path));
    match outcome {
        Ok(t) => panic!("the deck is read:\n{}", t.toml),
        Err(e) => e.to_string(),
    }
}

/// What was printed: title without set and time, time, rows.
pub type Block = (String, f64, Vec<Vec<f64>>);

/// A deck that was run.
pub struct Run {
    pub blocks: Vec<Block>,
    pub notes: Vec<String>,
    u: BTreeMap<u64, [f64; 3]>,
}

impl Run {
    /// The displacement of a node at the end.
    pub fn u(&self, node: u64) -> [f64; 3] {
        self.u[&node]
    }

    /// The last row of the last block with a title that begins so.
    pub fn last(&self, title: &str) -> Vec<f64> {
        let block = self
            .all(title)
            .pop()
            .unwrap_or_else(|| panic!("no {title}"));
        block.2.last().expect("a row").clone()
    }

    /// The blocks with a title that begins so.
    pub fn all(&self, title: &str) -> Vec<Block> {
        let named = self.blocks.iter().filter(|b| b.0.starts_with(title));
        named.cloned().collect()
    }

    /// The first value of the first row of each block with a title, by time.
    pub fn course(&self, title: &str, column: usize) -> Vec<(f64, f64)> {
        self.all(title)
            .iter()
            .map(|(_, t, rows)| (*t, rows[0][column]))
            .collect()
    }
}

/// Runs a deck. It is kept in the temporary folder of the tests, so that it can be given to other programs.
pub fn run(name: &str, text: &str) -> Run {
    run_before(name, text, None)
}

/// The same, before an observer that comes behind those that write `NAME.dat` and `NAME.sta`.
pub fn run_before(name: &str, text: &str, last: Option<&mut dyn Observer>) -> Run {
    std::fs::write(place(&format!("{name}.inp")), text).expect("a file");
    let translation = translate(text);
    let document = translation.document(Vec::new());
    let failed = |e: stickslip::Error| -> stickslip::Error {
        match translation.located(e) {
            Ok(e) => panic!("{e}\n{}", translation.toml),
            Err(e) => panic!("{e}"),
        }
    };
    let problem = document
        .problem()
        .unwrap_or_else(|e| panic!("{}", failed(e.into())));
    let model = problem
        .build_with(Path::new("."), &translation.meshes())
        .unwrap_or_else(|e| panic!("{}", failed(e)));
    let mut simulation = Simulation::new(model).expect("a sound model");
    let dat = place(&format!("{name}.dat"));
    let mut printer = Printer::new(&translation, &dat);
    let mut status = Status::new(&place(&format!("{name}.sta")));
    let mut observers: Vec<&mut dyn Observer> = Vec::new();
    observers.extend(printer.as_mut().map(|p| p as &mut dyn Observer));
    observers.push(&mut status);
    if let Some(last) = last {
        observers.push(last);
    }
    simulation
        .run(&mut observers)
        .unwrap_or_else(|e| panic!("{name}: {e}\n{}", translation.toml));
    let model = &simulation.model;
    let ids = model.mesh.point_ids.iter().enumerate();
    let u = ids.map(|(i, id)| (*id, model.dofs.vector(&simulation.frame.state.u, i)));
    Run {
        u: u.collect(),
        blocks: printer.map_or(Vec::new(), |_| {
            blocks(&std::fs::read_to_string(&dat).expect("a .dat file"))
        }),
        notes: translation.notes.iter().map(ToString::to_string).collect(),
    }
}

/// The blocks of a `.dat` file.
pub fn blocks(text: &str) -> Vec<Block> {
    let mut out: Vec<Block> = Vec::new();
    for line in text.lines() {
        let begins = line
            .trim_start()
            .starts_with(|c: char| c.is_ascii_lowercase());
        if begins {
            let (title, time) = line.split_once(" time").unwrap_or((line, "0"));
            let title = title.trim().split(" for ").next().unwrap_or_default();
            let time = time.trim().parse().unwrap_or(0.0);
            let time = match line.contains(" time") {
                true => time,
                // The parts of the statistics have the time of the first.
                false => out.last().map_or(0.0, |b| b.1),
            };
            out.push((title.to_string(), time, Vec::new()));
        } else if let Some(block) = out.last_mut()
            && !line.trim().is_empty()
        {
            let row: Result<Vec<f64>, _> = line.split_whitespace().map(str::parse).collect();
            if let Ok(row) = row {
                block.2.push(row);
            }
        }
    }
    out
}

/// Whether two numbers agree to a fraction of the second.
#[track_caller]
pub fn near(found: f64, wanted: f64, tolerance: f64) {
    let scale = wanted.abs().max(1e-12);
    assert!(
        (found - wanted).abs() <= tolerance * scale,
        "{found} is not {wanted}"
    );
}

#[track_caller]
pub fn near3(found: [f64; 3], wanted: [f64; 3], tolerance: f64) {
    let scale = wanted.iter().fold(1e-12_f64, |m, c| m.max(c.abs()));
    for (f, w) in found.iter().zip(wanted) {
        assert!(
            (f - w).abs() <= tolerance * scale,
            "{found:?} is not {wanted:?}"
        );
    }
}

/// A unit cube of one C3D8 from node `first` on, its lowest corner at `(0, 0, z)`: nodes and element, with the sets `NAME`, `NAMEBOT` and
/// `NAMETOP` of nodes and `ENAME`.
pub fn cube(name: &str, first: u64, z: f64) -> String {
    let mut out = format!("*NODE, NSET={name}\n");
    let corners = [[0, 0], [1, 0], [1, 1], [0, 1]];
    for (k, height) in [z, z + 1.0].into_iter().enumerate() {
        for (i, [x, y]) in corners.iter().enumerate() {
            let id = first as usize + 4 * k + i;
            out += &format!("{id}, {x}., {y}., {height}\n");
        }
    }
    let ids: Vec<String> = (first..first + 8).map(|n| n.to_string()).collect();
    out += &format!(
        "*ELEMENT, TYPE=C3D8, ELSET=E{name}\n{first}, {}\n*NSET, NSET={name}BOT, GENERATE\n{first}, {}\n*NSET, NSET={name}TOP, GENERATE\n{}, {}\n",
        ids.join(", "),
        first + 3,
        first + 4,
        first + 7
    );
    out
}

/// Sections of the sets of elements with `E = 1000`, no lateral contraction and a density of 1.
pub fn sections(sets: &[&str]) -> String {
    let mut out = String::from("*MATERIAL, NAME=EL\n*ELASTIC\n1000., 0.\n*DENSITY\n1.\n");
    for set in sets {
        out += &format!("*SOLID SECTION, ELSET={set}, MATERIAL=EL\n");
    }
    out
}

/// A cube on `z = 0` whose bottom is held and whose nodes move along z only.
pub fn column() -> String {
    let cube = cube("N", 1, 0.0);
    format!(
        "{cube}{}*BOUNDARY\nN, 1, 2\nNBOT, 3, 3\n",
        sections(&["EN"])
    )
}

/// Two such cubes, the upper one at a distance, with a contact pair and this interaction; nodes move along z and x only, and the top
/// along z only as far as steps say.
pub fn pair(gap: f64, kind: &str, interaction: &str) -> String {
    format!(
        "{}{}{}*SURFACE, NAME=SLAVE\nEB, S1\n*SURFACE, NAME=MASTER\nEA, S2\n*SURFACE INTERACTION, NAME=SI\n{interaction}\
         *CONTACT PAIR, INTERACTION=SI, TYPE={kind}\nSLAVE, MASTER\n*BOUNDARY\nA, 2\nB, 2\nABOT, 1, 3\n",
        cube("A", 1, 0.0),
        cube("B", 11, 1.0 + gap),
        sections(&["EA", "EB"]),
    )
}

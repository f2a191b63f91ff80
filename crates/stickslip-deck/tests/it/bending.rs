//! `NLGEOM` at rest: bars that bend by a right angle, against CalculiX 2.20 on the same decks.

use std::collections::BTreeMap;

use stickslip::results::{Analysis, Event, Observer};

use crate::support::{run, run_before, translate};

/// Cells along the bar, and its length; it is one wide and high.
const CELLS: usize = 40;
const LENGTH: f64 = 100.0;

const CORNERS: [[usize; 3]; 8] = [
    [0, 0, 0],
    [2, 0, 0],
    [2, 2, 0],
    [0, 2, 0],
    [0, 0, 2],
    [2, 0, 2],
    [2, 2, 2],
    [0, 2, 2],
];

const MIDDLES: [[usize; 3]; 12] = [
    [1, 0, 0],
    [2, 1, 0],
    [1, 2, 0],
    [0, 1, 0],
    [1, 0, 2],
    [2, 1, 2],
    [1, 2, 2],
    [0, 1, 2],
    [0, 0, 1],
    [2, 0, 1],
    [2, 2, 1],
    [0, 2, 1],
];

/// A bar of steel along z, clamped where z is zero, under these cards; `TOP` has the corners of its other end.
fn bar(kind: &str, nonlinear: &str, load: &str) -> String {
    let mut nodes = BTreeMap::new();
    let mut elements = String::new();
    for cell in 0..CELLS {
        let middles = MIDDLES.iter().filter(|_| kind.starts_with("C3D20"));
        elements += &(cell + 1).to_string();
        for (i, at) in CORNERS.iter().chain(middles).enumerate() {
            let next = nodes.len() + 1;
            let node = *nodes
                .entry([at[2] + 2 * cell, at[1], at[0]])
                .or_insert(next);
            elements += if i == 10 { ",\n" } else { ", " };
            elements += &node.to_string();
        }
        elements += "\n";
    }
    let line = |(at, id): (&[usize; 3], &usize)| {
        let z = at[0] as f64 * LENGTH / (2 * CELLS) as f64;
        format!(
            "{id}, {}, {}, {z}\n",
            at[2] as f64 / 2.0,
            at[1] as f64 / 2.0
        )
    };
    let lines: String = nodes.iter().map(line).collect();
    let set = |keep: &dyn Fn(&[usize; 3]) -> bool| -> String {
        let own = nodes.iter().filter(|(at, _)| keep(at));
        own.map(|(_, id)| format!("{id},\n")).collect()
    };
    let bottom = set(&|at| at[0] == 0);
    let top = set(&|at| at[0] == 2 * CELLS && at[1] != 1 && at[2] != 1);
    format!(
        "*NODE, NSET=NALL\n{lines}*ELEMENT, TYPE={kind}, ELSET=EALL\n{elements}*NSET, NSET=BOT\n{bottom}*NSET, NSET=TOP\n{top}\
         *MATERIAL, NAME=M\n*ELASTIC\n210000., .3\n*SOLID SECTION, ELSET=EALL, MATERIAL=M\n*BOUNDARY\nBOT, 1, 3\n\
         *STEP{nonlinear}\n*STATIC\n.1, 1.\n{load}*NODE PRINT, NSET=TOP\nU\n*END STEP\n"
    )
}

/// The mean displacement of the corners of the end, along x and z.
fn tip(name: &str, text: &str) -> [f64; 2] {
    let run = run(name, text);
    let (_, _, rows) = run.all("displacements").pop().expect("a table");
    [1, 3].map(|column| rows.iter().map(|row| row[column]).sum::<f64>() / rows.len() as f64)
}

const FORCE: &str = "*CLOAD\nTOP, 1, 1.6\n";
const PRESSURE: &str = "*DLOAD\nEALL, P6, .12\n";

/// Where the energy is the bar is strained by 0.59 % by the force and by 0.74 % by the pressure, which CalculiX takes as strains of Green.
const STRAIN: f64 = 0.0075;

/// By how much the two kinds of elements of CalculiX differ, in the last place: incompatible modes are another thing in each program where cells turn.
const KINDS: f64 = 0.0087;

#[test]
fn a_bar_bends_by_a_right_angle_as_in_calculix() {
    for (name, kind, load, wanted) in [
        ("bend-force-8", "C3D8I", FORCE, [65.02762, -30.67702]),
        ("bend-force-20", "C3D20", FORCE, [64.87362, -30.41192]),
        ("bend-pressure-8", "C3D8I", PRESSURE, [69.97275, -35.62287]),
        ("bend-pressure-20", "C3D20", PRESSURE, [69.84764, -35.47931]),
    ] {
        let found = tip(name, &bar(kind, ", NLGEOM", load));
        let most = if kind == "C3D8I" { KINDS } else { STRAIN };
        for (found, wanted) in found.iter().zip(wanted) {
            let off = (found / wanted - 1.0).abs();
            assert!(off < most, "{name}: {found} for {wanted}");
        }
    }
    // Without, it goes 122 across and not down at all.
    let found = tip("bend-linear", &bar("C3D8I", "", FORCE));
    assert!(found[0] > 110.0 && found[1].abs() < 1e-6, "{found:?}");
}

#[test]
fn what_cannot_turn_yet_is_told() {
    let text = bar("C3D8I", ", NLGEOM", FORCE);
    let turns = translate(&text);
    assert_eq!(turns.toml.matches("rotation = \"corotational\"").count(), 1);
    let both = format!("{text}*STEP\n*FREQUENCY\n2\n*END STEP\n")
        .replace("*ELASTIC", "*DENSITY\n7.8E-9\n*ELASTIC");
    assert!(!translate(&both).toml.contains("rotation"));
}

/// A cube that is drawn out, under `NLGEOM`, with these cards before and steps after.
fn drawn(by: f64, before: &str, after: &str) -> String {
    format!(
        "*NODE, NSET=NALL\n1,0,0,0\n2,1,0,0\n3,1,1,0\n4,0,1,0\n5,0,0,1\n6,1,0,1\n7,1,1,1\n8,0,1,1\n*ELEMENT, TYPE=C3D8, ELSET=EALL\n1,1,2,3,4,5,6,7,8\n\
         *NSET, NSET=BOT\n1,2,3,4\n*NSET, NSET=TOP\n5,6,7,8\n*MATERIAL, NAME=M\n*ELASTIC\n200000.,0.\n*EXPANSION\n1.E-5\n*DENSITY\n7.8E-9\n\
         *SOLID SECTION, ELSET=EALL, MATERIAL=M\n*BOUNDARY\nBOT,1,3\nTOP,1,2\n{before}*STEP, NLGEOM\n*STATIC\n1.,1.\n*BOUNDARY\nTOP,3,3,{by}\n*END STEP\n{after}"
    )
}

#[test]
fn strains_are_judged_where_nlgeom_falls_back_to_small_rotations() {
    let frequency = "*STEP\n*FREQUENCY\n2\n*END STEP\n";
    let warm = "*INITIAL CONDITIONS, TYPE=TEMPERATURE\nNALL,0.\n";
    // Warm by 1e-5 only: what is thermal is no strain here, and next to nothing.
    for (name, before, after) in [("drawn-modes", "", frequency), ("drawn-warm", warm, "")] {
        for (by, met) in [(0.4, false), (0.02, true)] {
            let mut text = drawn(by, before, after);
            if !before.is_empty() {
                text = text.replace("*END STEP", "*TEMPERATURE\nNALL,1.\n*END STEP");
            }
            let toml = translate(&text).toml;
            assert!(toml.contains("strain = 0.05"), "{toml}");
            let mut judged = Judged::default();
            run_before(name, &text, Some(&mut judged));
            let (value, kept) = judged.strain.expect("judged");
            assert!((value / by - 1.0).abs() < 1e-3, "{value}");
            assert_eq!(kept, met, "{name} {by}");
        }
    }
    // Where nothing is asked for, linear theory is what is meant.
    let linear = drawn(0.4, "", frequency).replace(", NLGEOM", "");
    assert!(!translate(&linear).toml.contains("strain"));
}

/// The strain of the first body, and whether its limit is kept.
#[derive(Default)]
struct Judged {
    strain: Option<(f64, bool)>,
}

impl Observer for Judged {
    fn see(&mut self, analysis: &Analysis, _: Event) -> Result<(), stickslip::Error> {
        let figures = analysis.summary.quality.figures.iter();
        let strain = figures.into_iter().find(|f| f.figure == "strain");
        self.strain = strain.map(|f| (f.value, f.met)).or(self.strain);
        Ok(())
    }
}

#[test]
fn what_a_step_that_looks_for_modes_does_not_print_is_told() {
    let asked = "*NODE PRINT, NSET=TOP\nU\n*NODE FILE\nU\n";
    let text = drawn(
        0.01,
        "",
        &format!("*STEP\n*FREQUENCY\n2\n{asked}*END STEP\n"),
    );
    let notes: Vec<String> = translate(&text)
        .notes
        .iter()
        .map(ToString::to_string)
        .collect();
    let told = notes
        .iter()
        .filter(|n| n.contains("*NODE PRINT") && n.contains("*NODE FILE"));
    assert_eq!(told.count(), 1, "{notes:?}");
    let silent = drawn(0.01, "", "*STEP\n*FREQUENCY\n2\n*END STEP\n");
    let notes = translate(&silent).notes;
    assert!(notes.iter().all(|n| !n.to_string().contains(".frd")));
}

//! The impact of a steel bar as a CalculiX deck, and how it is run.
//!
//! A bar of 0.1 m × 0.1 m × 1 m with 8 × 8 × 80 cells, no lateral contraction, meets a fixed block at 10 m/s after a gap of 1 µm. Node-to-face
//! contact with 1e13 Pa/m, no friction; implicit with increments of 5 µs.

use std::fmt::Write;

use super::bench::{Bench, example, ratio, seconds};
use super::table::Table;

/// Cells across and along.
const CELLS: [usize; 2] = [8, 80];

/// Displacement dofs of the bar.
pub const DOFS: usize = 3 * (CELLS[0] + 1) * (CELLS[0] + 1) * (CELLS[1] + 1);

/// Explicit increments of stickslip, as many as its peers take.
pub const EXPLICIT: usize = 1000;

/// Implicit increments over half a millisecond.
pub const IMPLICIT: usize = 100;

/// Label of the node at `(x, y, z)` of the bar.
fn node([x, y, z]: [usize; 3]) -> usize {
    let edge = CELLS[0] + 1;
    1 + x + edge * (y + edge * z)
}

/// The deck.
pub fn deck() -> String {
    let [across, along] = CELLS;
    let mut out = String::from("*NODE\n");
    let mut put = |text: std::fmt::Arguments| {
        // writing to a string cannot fail
        let _ = writeln!(out, "{text}");
    };
    let at = |i: usize, n: usize| i as f64 / n as f64;
    for z in 0..=along {
        for y in 0..=across {
            for x in 0..=across {
                let label = node([x, y, z]);
                let (a, b) = (0.1 * at(x, across) - 0.05, 0.1 * at(y, across) - 0.05);
                put(format_args!("{label}, {a}, {b}, {}", 1e-6 + at(z, along)));
            }
        }
    }
    let wall = node([across, across, along]);
    let square = [(-0.15, -0.15), (0.15, -0.15), (0.15, 0.15), (-0.15, 0.15)];
    for (k, z) in [-0.1, 0.0].into_iter().enumerate() {
        for (i, (x, y)) in square.into_iter().enumerate() {
            put(format_args!("{}, {x}, {y}, {z}", wall + 4 * k + i + 1));
        }
    }
    put(format_args!("*ELEMENT, TYPE=C3D8, ELSET=BAR"));
    let mut cell = 0;
    for z in 0..along {
        for y in 0..across {
            for x in 0..across {
                cell += 1;
                let mut labels = vec![cell];
                for up in [z, z + 1] {
                    for [i, j] in [[x, y], [x + 1, y], [x + 1, y + 1], [x, y + 1]] {
                        labels.push(node([i, j, up]));
                    }
                }
                let labels: Vec<String> = labels.iter().map(usize::to_string).collect();
                put(format_args!("{}", labels.join(", ")));
            }
        }
    }
    let block: Vec<String> = (1..=8).map(|i| (wall + i).to_string()).collect();
    put(format_args!(
        "*ELEMENT, TYPE=C3D8, ELSET=BLOCK\n{}, {}",
        cell + 1,
        block.join(", ")
    ));
    put(format_args!("*NSET, NSET=NBAR, GENERATE\n1, {wall}"));
    put(format_args!(
        "*NSET, NSET=NBLOCK, GENERATE\n{}, {}",
        wall + 1,
        wall + 8
    ));
    put(format_args!(
        "*NSET, NSET=FOOT, GENERATE\n1, {}",
        node([across, across, 0])
    ));
    put(format_args!("*SURFACE, NAME=SFOOT, TYPE=NODE\nFOOT"));
    put(format_args!(
        "*SURFACE, NAME=STOP, TYPE=ELEMENT\n{}, S2",
        cell + 1
    ));
    put(format_args!(
        "*MATERIAL, NAME=STEEL\n*ELASTIC\n210e9, 0.\n*DENSITY\n7800.\n*SOLID SECTION, ELSET=BAR, MATERIAL=STEEL\n\
         *SOLID SECTION, ELSET=BLOCK, MATERIAL=STEEL\n*SURFACE INTERACTION, NAME=HIT\n\
         *SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n1e13, 0.\n*CONTACT PAIR, INTERACTION=HIT, TYPE=NODE TO SURFACE\n\
         SFOOT, STOP\n*INITIAL CONDITIONS, TYPE=VELOCITY\nNBAR, 3, -10.\n*BOUNDARY\nNBLOCK, 1, 3\n*STEP, INC=1000000\n\
         *DYNAMIC, DIRECT\n{}, 5e-4\n*NODE PRINT, NSET=NBLOCK, TOTALS=ONLY, FREQUENCY=1\nRF\n*END STEP",
        5e-4 / IMPLICIT as f64
    ));
    out
}

/// Runs the impact: explicit by itself, implicit against CalculiX.
pub fn measure(bench: &Bench) -> Result<(), String> {
    let case = example("steel-bar/case.toml")?;
    let fixed = |n: usize| format!("step.1.increments.fixed={n}");
    let explicit = bench.analyse(&case, &[fixed(EXPLICIT)])?;
    let settings = [
        fixed(IMPLICIT),
        // springs and masses as CalculiX has them
        "step.1.dynamic={scheme={hht={}},contact-mass=\"as-meshed\"}".to_string(),
    ];
    let implicit = bench.analyse(&case, &settings)?;
    let theirs = match bench.calculix {
        true => {
            let folder = bench.folder("calculix-bar")?;
            let file = folder.join("bar.inp");
            std::fs::write(&file, deck()).map_err(|e| format!("{}: {e}", file.display()))?;
            Some(bench.calculix(&folder, "bar")?.cpu)
        }
        false => None,
    };
    let table = Table::new(
        &format!("Impact of a bar, {DOFS} dofs, one thread, CPU seconds of the whole process"),
        &[
            "",
            "increments",
            "iterations",
            "stickslip",
            "CalculiX",
            "stickslip / CalculiX",
        ],
    );
    for (name, run, theirs) in [
        ("explicit", &explicit, None),
        ("implicit", &implicit, theirs),
    ] {
        table.row([
            name.to_string(),
            run.number("/increments").to_string(),
            run.number("/iterations").to_string(),
            seconds(Some(run.run.cpu)),
            seconds(theirs),
            ratio(run.run.cpu, theirs),
        ]);
    }
    println!(
        "\n- explicit: {:.2e} s a step and dof",
        explicit.run.cpu / (EXPLICIT * DOFS) as f64
    );
    let (increment, factor) = (implicit.increment(), implicit.one_factor());
    println!(
        "- implicit: an increment takes {increment:.4} s, one factorisation {factor:.3} s: {:.2} % of it",
        100.0 * increment / factor
    );
    println!("- implicit: {} s", implicit.phases());
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_deck_is_whole() {
        let deck = deck();
        let nodes = 9 * 9 * 81;
        assert_eq!(DOFS, 3 * nodes);
        let last = format!("\n{nodes}, 0.05, 0.05, 1.000001\n");
        assert!(deck.contains(&last), "no line {last}");
        assert!(deck.contains(&format!("\n{}, ", 8 * 8 * 80 + 1)));
        assert!(deck.ends_with("*END STEP\n"));
    }
}

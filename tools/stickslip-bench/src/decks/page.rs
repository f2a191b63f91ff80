//! The page of the book.

use std::fmt::Write as _;

use super::outcome::{Outcome, Variant};

/// Why a deck differs by more than a hundredth, or what else is to be said about it.
const REASONS: &[(&str, &str)] = &[
    (
        "punch1",
        "One row of quadratic faces touches, and its pressure rises at the rim: the result depends on the points at which springs of 1e7 act. \
         CalculiX cuts the faces along each other first, and has others. With the nodes moved by hand instead of by ADJUST it agrees with itself \
         to 0.05 %.",
    ),
    ("contact4", "Hard contact: see the column before."),
    (
        "contact15lin",
        "CalculiX takes the mass of the nodes that may touch away and gives it to nobody: of the upper body, one cell, a third \
         of its mass m is left. Its first increment, 4.808e-5, is F dt² / (m/3): with that third, and with velocity zero half \
         an increment before the start. Here the loaded nodes have their half of m, and velocity zero at the start: F dt² / 2 / \
         (m/2), a third of that. Columns with all of their mass (`TYPE=SURFACE TO SURFACE`) differ by 104 % from CalculiX's \
         massless ones with one cell over the height of the upper body, by 56 % with 8 and by 26 % with 16: the two approach \
         each other as the layer of cells that touch gets thin.",
    ),
    ("contact16", "As contact15lin."),
    (
        "contact13",
        "See the known differences: strains of a tenth, and springs of fifty times Young's modulus.",
    ),
    ("contact14", "As contact13."),
    (
        "contactenergy",
        "The energies of single contact elements are compared by their sum.",
    ),
];

/// What stands behind the table.
const KNOWN: &str = include_str!("known.md");

/// A line for the terminal.
pub fn line(outcome: &Outcome) -> String {
    let mut out = outcome.name.clone();
    if let Some(refusal) = &outcome.refusal {
        let _ = write!(out, ": refused: {refusal}");
    }
    for (variant, found) in &outcome.found {
        let _ = write!(
            out,
            ": {variant:?} {} numbers, {} rows missing, worst {:.1e}",
            found.count(),
            found.missing,
            found.worst()
        );
        for (name, (_, worst)) in &found.quantities {
            let _ = write!(out, "; {name} {worst:.1e}");
        }
    }
    out
}

/// The page.
pub fn text(outcomes: &[Outcome]) -> String {
    let mut out = String::from(
        "<!-- Written by `cargo xtask decks`. -->\n\n# Input decks of CalculiX\n\n\
         Decks from CalculiX's own test suite, run as they are by `stickslip run`. Every number that CalculiX prints to its `.dat` file is\n\
         compared with ours at the same node or integration point and time; what was printed at other times is interpolated linearly. A\n\
         difference is relative to the largest number of the same kind (displacements, forces, moments, stresses) in the same block of the\n\
         file, or in the history of a single point. Where contact is hard CalculiX takes a stiffness of fifty times Young's modulus; contact is exact here. The column *with their\n\
         stiffness* has the difference with that stiffness as the law of the interface.\n\n\
         | deck | compared | numbers | worst difference | with their stiffness | remarks |\n|---|---|---:|---:|---:|---|\n",
    );
    for o in outcomes {
        let reason = REASONS.iter().find(|r| r.0 == o.name).map_or("", |r| r.1);
        let of = |v: Variant| o.found.iter().find(|f| f.0 == v).map(|f| &f.1);
        let (compared, numbers, worst) = match (&o.refusal, of(Variant::Plain)) {
            (Some(refusal), _) => (
                format!("refused: `{refusal}`"),
                String::new(),
                String::new(),
            ),
            (None, Some(f)) if f.count() > 0 => {
                let names: Vec<&str> = f.quantities.keys().map(String::as_str).collect();
                (names.join(", "), f.count().to_string(), percent(f.worst()))
            }
            _ => (
                "runs; the reference is empty".into(),
                String::new(),
                String::new(),
            ),
        };
        let stiff = of(Variant::Stiffness).map_or(String::new(), |f| percent(f.worst()));
        let missing = of(Variant::Plain).map_or(0, |f| f.missing);
        let missing = match missing {
            0 => String::new(),
            n => format!("{n} rows have no counterpart. "),
        };
        let _ = writeln!(
            out,
            "| {} | {compared} | {numbers} | {worst} | {stiff} | {missing}{reason} |",
            o.name
        );
    }
    out + KNOWN
}

fn percent(x: f64) -> String {
    match x {
        x if x < 1e-6 => "< 0.0001 %".into(),
        x => format!("{:.2} %", 100.0 * x).replace("0.00 %", "< 0.01 %"),
    }
}

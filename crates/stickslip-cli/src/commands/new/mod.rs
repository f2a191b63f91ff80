//! `stickslip new`: problem files sized from a few numbers, with what theory says of them. One file a kind, and a template beside it.

mod belt;
mod bolt;
mod fretting;
mod gear;
mod grid;
mod hertz;
mod quantity;
mod round;
mod target;
mod written;

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use stickslip::Error;

use crate::failure::{Failure, Outcome};
use crate::print;
use crate::style::WIDTH;
use written::Written;

/// Write a problem file from a few numbers with units, with a mesh sized to the expected contact, and a file with the theoretical results.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  stickslip new hertz --radius 10mm --load 100N/mm                   cylinder on a flat
  stickslip new hertz --radius 10mm --load 50N -o ball.toml          ball on a flat
  stickslip new fretting --radius 6mm --load 18.5N/mm --amplitude 25um --friction 0.9 --wear 2.9e-8/MPa
  stickslip new bolt --diameter 10mm --preload 20kN --grip 40mm --pull 5kN
  stickslip new belt --mass 1kg --load 10N --stiffness 100N/m --speed 0.1m/s --static 0.5 --kinetic 0.3
  stickslip new gear --teeth 20 --wheel 30 --module 2mm --width 10mm --torque 20Nm
All options have defaults. Existing files are not overwritten.")]
pub struct Arguments {
    #[command(subcommand)]
    kind: Kind,
}

#[derive(Debug, clap::Subcommand)]
enum Kind {
    Hertz(round::Arguments),
    Fretting(fretting::Arguments),
    Bolt(bolt::Arguments),
    Belt(belt::Arguments),
    Gear(gear::Arguments),
}

/// Writes the files and tells what is expected.
pub fn run(arguments: &Arguments) -> Outcome {
    let (name, target, written) = match &arguments.kind {
        Kind::Hertz(a) => ("hertz", &a.target, round::write(a)?),
        Kind::Fretting(a) => ("fretting", &a.target, fretting::write(a)?),
        Kind::Bolt(a) => ("bolt", &a.target, bolt::write(a)?),
        Kind::Belt(a) => ("belt", &a.target, belt::write(a)?),
        Kind::Gear(a) => ("gear", &a.target, gear::write(a)?),
    };
    let output = target.output.clone();
    let problem = output.unwrap_or_else(|| PathBuf::from(format!("{name}.toml")));
    let expected = problem.with_extension("expected.toml");
    for path in [&problem, &expected] {
        free(path)?;
    }
    save(&problem, &written.problem)?;
    save(&expected, &written.expected)?;
    print::out(&printed(&written, &problem, &expected))?;
    Ok(ExitCode::SUCCESS)
}

/// Refuses a name that is taken: it may be somebody's work.
fn free(path: &Path) -> Result<(), Failure> {
    match path.symlink_metadata() {
        Ok(_) => Err(Failure::Arguments(
            format!(
                "{}: there is a file of this name, and it is not written over",
                path.display()
            ),
            "give another name with `-o`, or remove it".into(),
        )),
        Err(_) => Ok(()),
    }
}

/// Makes a file that was not there a moment ago.
fn save(path: &Path, text: &str) -> Result<(), Failure> {
    let made = std::fs::File::create_new(path)
        .and_then(|mut file| std::io::Write::write_all(&mut file, text.as_bytes()));
    made.map_err(|e| Failure::Library(Error::io(path, e)))
}

fn printed(written: &Written, problem: &Path, expected: &Path) -> String {
    let figures = || {
        written
            .figures
            .lines()
            .filter_map(|line| line.split_once(": "))
    };
    let widest = figures().map(|(name, _)| name.len()).max().unwrap_or(0);
    let mut text = print::wrap(&written.title, 0, WIDTH);
    for (name, value) in figures() {
        // A formula stands behind its value, which follows the name in a column of its own.
        let value = match value.split_once("    ") {
            Some((value, formula)) => format!("{value} ({formula})"),
            None => value.into(),
        };
        let lines = print::wrap(&value, widest + 4, WIDTH);
        text += &format!("  {name:<widest$}  {}", lines.trim_start());
    }
    for note in written.notes.lines() {
        text += &print::wrap(&format!("note: {note}"), 0, WIDTH);
    }
    let (problem, expected) = (problem.display(), expected.display());
    text + &format!(
        "written: {problem}, {expected}\nnext: stickslip run {problem}\n      stickslip compare {} {expected}\n",
        problem
            .to_string()
            .strip_suffix(".toml")
            .map_or_else(|| format!("{problem}.out"), |stem| format!("{stem}.out"))
    )
}

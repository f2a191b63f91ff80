use std::path::PathBuf;
use std::process::ExitCode;

use clap::ValueHint;
use stickslip_report::plot::{self, Picture, View, When};

use super::completions::Words;
use crate::failure::{Failure, Outcome};
use crate::given;
use crate::print;

/// Make a picture of results, PNG or SVG, or plot columns of the history.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// The folder with the results of a run.
    #[arg(value_hint = ValueHint::DirPath)]
    directory: PathBuf,
    /// The file to write, ending with .png or .svg; `plot.png` or `history.png` in the folder if not given.
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// The field in colour, as ParaView lists it, or a component: CPRESS, CSTATUS, MISES, U, U1, S11. The von Mises stress if not
    /// given.
    #[arg(long, value_name = "NAME", value_parser = Words(fields), hide_possible_values = true)]
    field: Option<String>,
    /// Which of the times at which fields were written: `last`, a number from 1, or `all`, a file each.
    #[arg(long, value_name = "last|N|all", default_value = "last", value_parser = when)]
    time: When,
    /// Factor of the displacements; with `auto` the largest is about a twentieth of the model.
    #[arg(long, value_name = "auto|X", default_value = "auto", value_parser = scale)]
    scale: Scale,
    /// From where one looks: iso, x, y, z, -x, -y, -z. Plane models are seen from z.
    #[arg(long, value_name = "VIEW", allow_hyphen_values = true, value_parser = view)]
    view: Option<View>,
    /// Draw this body only; may be repeated.
    #[arg(long, value_name = "NAME")]
    body: Vec<String>,
    /// Width and height in pixels.
    #[arg(long, value_name = "WxH", default_value = "1200x900", value_parser = size)]
    size: [u32; 2],
    /// Plot these columns of history.csv instead of the bodies.
    #[arg(long, value_name = "COLUMN,...", value_delimiter = ',', conflicts_with_all = ["field", "view", "body"])]
    history: Vec<String>,
    /// The column along the horizontal axis.
    #[arg(
        long,
        value_name = "COLUMN",
        default_value = "TIME",
        requires = "history"
    )]
    against: String,
}

/// Fields that results mostly have, for completions.
fn fields() -> Vec<&'static str> {
    stickslip_report::NAMES.to_vec()
}

/// A factor, or the one that suits.
#[derive(Debug, Clone, Copy)]
struct Scale(Option<f64>);

fn when(text: &str) -> Result<When, String> {
    match text {
        "last" => Ok(When::Last),
        "all" => Ok(When::All),
        _ => match text.parse() {
            Ok(n) => Ok(When::Number(n)),
            Err(_) => Err("`last`, `all` or a number from 1".into()),
        },
    }
}

fn scale(text: &str) -> Result<Scale, String> {
    match text {
        "auto" => Ok(Scale(None)),
        _ => match text.parse::<f64>() {
            Ok(x) if x.is_finite() => Ok(Scale(Some(x))),
            _ => Err("`auto` or a number".into()),
        },
    }
}

fn view(text: &str) -> Result<View, String> {
    text.parse()
}

fn size(text: &str) -> Result<[u32; 2], String> {
    let pair = text.split_once('x').and_then(|(w, h)| {
        let n = |t: &str| t.trim().parse().ok();
        Some([n(w)?, n(h)?])
    });
    pair.ok_or_else(|| "width and height like 1200x900".into())
}

/// Draws, and prints where the pictures are.
pub fn run(arguments: &Arguments) -> Outcome {
    let (files, notes) = draw(arguments)?;
    let files = files.iter().map(|file| format!("{}\n", file.display()));
    let notes = notes.iter().map(|note| format!("note: {note}\n"));
    print::out(&files.chain(notes).collect::<String>())?;
    Ok(ExitCode::SUCCESS)
}

/// The files that were written, and what is to be said about them.
pub fn draw(arguments: &Arguments) -> Result<(Vec<PathBuf>, Vec<String>), Failure> {
    given::results(&arguments.directory)?;
    let output = arguments.output.as_deref();
    if arguments.history.is_empty() {
        let picture = Picture {
            field: arguments.field.clone(),
            when: arguments.time,
            scale: arguments.scale.0,
            view: arguments.view,
            bodies: arguments.body.clone(),
            size: arguments.size,
        };
        return Ok(plot::picture(&arguments.directory, output, &picture)?);
    }
    let named = arguments.history.iter().filter(|name| !name.is_empty());
    let columns: Vec<String> = named.cloned().collect();
    if columns.is_empty() {
        return Err(Failure::Arguments(
            "no column is named".into(),
            "--history takes names of columns of history.csv, with commas between them".into(),
        ));
    }
    let (directory, against) = (&arguments.directory, &arguments.against);
    let file = plot::columns(directory, output, &columns, against, arguments.size)?;
    Ok((vec![file], Vec::new()))
}

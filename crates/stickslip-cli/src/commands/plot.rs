use std::path::PathBuf;
use std::process::ExitCode;

use clap::ValueHint;
use stickslip_report::plot::{
    self, Along, Apart, Colours, Columns, Line, Picture, Plane, Units, View, When, Zoom,
};

use super::completions::Words;
use crate::failure::{Failure, Outcome};
use crate::given;
use crate::print;

/// Draw results as PNG or SVG: bodies, interfaces, columns of the history, or tables of a sweep.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// The result folder of a run; with --regimes, --stability and --coupling the table of a sweep (or, with --coupling, of a map); with --waterfall the
    /// table of spectra.
    #[arg(value_hint = ValueHint::DirPath)]
    directory: PathBuf,
    /// The file to write, .png or .svg; default: `plot.png`, `INTERFACE.png` or `history.png` in the folder. With --along also .csv, a table.
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    #[command(flatten)]
    framing: Framing,
    #[command(flatten)]
    motion: Motion,
    #[command(flatten)]
    tables: Tables,
    /// Draw pressure, shear and status along this interface: in 2D curves over the arc length, in 3D maps in plan or unrolled. With --field that field
    /// alone; in 2D with --time all a line for each time. CWEAR and CDISS of the opposite surface go into a second file (NAME-opposite.svg).
    #[arg(long, value_name = "INTERFACE", conflicts_with_all = ["view", "bodies", "range", "bands", "threshold", "apart", "at", "arrows", "cut", "mirror", "loads", "history"])]
    along: Option<String>,
    /// Draw the field along a straight line through the bodies, between two undeformed places: `0,0,0:10,0,0`. With --time all a line for each time; with -o NAME.csv a
    /// table.
    #[arg(long, value_name = "X,Y[,Z]:X,Y[,Z]", allow_hyphen_values = true, value_parser = segment, conflicts_with_all = ["along", "view", "bodies", "range", "bands", "threshold", "apart", "at", "arrows", "cut", "mirror", "loads", "history", "script", "mode", "animate", "regimes", "stability", "coupling", "waterfall"])]
    path: Option<Segment>,
    /// Draw tractions as arrows in the colours of stick and slip. Default: yes for contact fields in 2D.
    #[arg(long, value_name = "yes|no", value_parser = yes)]
    arrows: Option<bool>,
    /// Draw only cells below this plane, to look inside. Default place: the middle of the model.
    #[arg(long, value_name = "x|y|z[=PLACE]", value_parser = plane)]
    cut: Option<Plane>,
    /// Add the mirrored half beyond a plane of symmetry. Default place: the side of the model nearer to zero. Repeat it with a second plane for a quarter
    /// model.
    #[arg(long, value_name = "x|y|z[=PLACE]", value_parser = plane)]
    mirror: Vec<Plane>,
    /// Draw supports and loads as symbols, and the undeformed outline. Needs the mesh files of the problem beside the result folder.
    #[arg(long)]
    loads: bool,
    /// Write a PyVista script beside the picture that draws it: `plot.py` for `plot.png`.
    #[arg(long, conflicts_with_all = ["along", "history", "animate", "regimes", "stability", "coupling", "waterfall"])]
    script: bool,
    /// Units of length and stress in the legend: `mm,MPa`. Numbers are not converted.
    #[arg(long, value_name = "LENGTH,STRESS", value_parser = units)]
    units: Option<Units>,
    /// Width and height in pixels.
    #[arg(long, value_name = "WxH", default_value = "1200x900", value_parser = size)]
    size: [u32; 2],
    #[command(flatten)]
    lines: Lines,
}

/// Columns of a table.
#[derive(Debug, clap::Args)]
struct Lines {
    /// Plot these columns of history.csv instead of bodies.
    #[arg(long, value_name = "COLUMN,...", value_delimiter = ',', conflicts_with_all = ["field", "view", "bodies", "range", "bands", "threshold", "apart", "loads"])]
    history: Vec<String>,
    /// Plot these columns on a second vertical axis, at the right.
    #[arg(
        long,
        value_name = "COLUMN,...",
        value_delimiter = ',',
        requires = "history"
    )]
    right: Vec<String>,
    /// Take the columns from this table instead of history.csv, for example `modes-2-map.csv`. The picture gets its name.
    #[arg(long, value_name = "FILE", requires = "history")]
    table: Option<String>,
    /// The column of the horizontal axis.
    #[arg(
        long,
        value_name = "COLUMN",
        default_value = "TIME",
        requires = "history"
    )]
    against: String,
}

/// What is seen, and from where.
#[derive(Debug, clap::Args)]
struct Framing {
    /// Field in colour: a field, a component or an invariant, such as CPRESS, CSTATUS, MISES, U, U1, S11, S1 (the largest principal stress). Default: the
    /// contact pressure, or the von Mises stress without contact.
    #[arg(long, value_name = "NAME", value_parser = Words(fields), hide_possible_values = true)]
    field: Option<String>,
    /// Output time: `peak`, when the contact pressure or the chosen field is largest (for wear and dissipation the last); `last`; a number from 1; or
    /// `all`, a file each.
    #[arg(long, value_name = "peak|last|N|all", default_value = "peak", value_parser = when)]
    time: When,
    /// Factor of the displacements. `auto`: 1 for fields of contact, otherwise the largest becomes about a twentieth of the model, or less where that
    /// would open or close gaps.
    #[arg(long, value_name = "auto|X", default_value = "auto", value_parser = scale)]
    scale: Scale,
    /// View direction: iso, x, y, z, -x, -y, -z. Plane models are seen from z.
    #[arg(long, value_name = "VIEW", allow_hyphen_values = true, value_parser = view)]
    view: Option<View>,
    /// Draw these bodies only. Can be repeated.
    #[arg(long, alias = "body", value_name = "NAME,...", value_delimiter = ',')]
    bodies: Vec<String>,
    /// Values at the ends of the colours. Default: the least and the largest value, or 99 % of the area where single points are far above the rest.
    #[arg(long, value_name = "LO,HI", allow_hyphen_values = true, value_parser = range)]
    range: Option<Range>,
    /// Number of colours.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(2..=64))]
    bands: Option<u32>,
    /// Do not draw values below this one.
    #[arg(long, value_name = "LO", allow_hyphen_values = true, value_parser = number)]
    threshold: Option<f64>,
    /// Distance at which bodies in contact are drawn apart. `auto`: as far as needed to see fields of contact in 3D; 0: not at all.
    #[arg(long, value_name = "auto|LENGTH", default_value = "auto", value_parser = apart)]
    apart: Apart,
    /// Part of the model: `contact`, `whole`, or a factor. `auto`: the contact, if it is small and a field of contact is shown.
    #[arg(long, value_name = "auto|contact|whole|X", default_value = "auto", value_parser = zoom)]
    zoom: Zoom,
    /// Centre of the picture.
    #[arg(long, value_name = "X,Y[,Z]", allow_hyphen_values = true, value_parser = place)]
    at: Option<Place>,
}

/// What moves.
#[derive(Debug, clap::Args)]
struct Motion {
    /// Draw a mode shape or a harmonic response: its number in the last modal step, or STEP:MODE with the name or number of the step.
    #[arg(long, value_name = "MODE", conflicts_with_all = ["along", "history", "regimes", "stability", "coupling", "waterfall"])]
    mode: Option<String>,
    /// Write an animation through all output times, or the phases of a mode: animated PNG or GIF.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["along", "history", "output", "time", "regimes", "stability", "coupling", "waterfall"])]
    animate: Option<PathBuf>,
    /// Pictures per second.
    #[arg(long, value_name = "N", default_value = "10", value_parser = rate, requires = "animate")]
    rate: f64,
}

/// What is drawn of a table of many runs, modes or spectra.
#[derive(Debug, clap::Args)]
struct Tables {
    /// Draw which runs of a sweep stick, slip partially and slide, over two axes: `amplitude,load`; the ends of their names suffice.
    #[arg(long, value_name = "ACROSS,UP", value_parser = pair, conflicts_with_all = ["along", "field", "view", "bodies", "history"])]
    regimes: Option<Pair>,
    /// Draw in which runs of a sweep steady sliding is stable, flutters or diverges, over two axes, with the boundary from `sweep --critical`.
    #[arg(long, value_name = "ACROSS,UP", value_parser = pair, conflicts_with_all = ["along", "field", "view", "bodies", "history", "regimes"])]
    stability: Option<Pair>,
    /// Draw mode coupling, frequencies and growth, over a column of a map (`pad.out/modes-2-map.csv --coupling mu`) or an axis of a sweep, a picture
    /// each.
    #[arg(long, value_name = "COLUMN", conflicts_with_all = ["along", "field", "view", "bodies", "history", "regimes", "stability"])]
    coupling: Option<String>,
    /// Draw a waterfall of spectra over time and frequency: `pad.out/modes-3-waterfall.csv --waterfall`.
    #[arg(long, conflicts_with_all = ["along", "field", "view", "bodies", "history", "regimes", "stability", "coupling"])]
    waterfall: bool,
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
        "peak" => Ok(When::Peak),
        "last" => Ok(When::Last),
        "all" => Ok(When::All),
        _ => match text.parse() {
            Ok(n) => Ok(When::Number(n)),
            Err(_) => Err("`peak`, `last`, `all` or a number from 1".into()),
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

fn zoom(text: &str) -> Result<Zoom, String> {
    text.parse()
}

fn plane(text: &str) -> Result<Plane, String> {
    text.parse()
}

fn units(text: &str) -> Result<Units, String> {
    text.parse()
}

fn apart(text: &str) -> Result<Apart, String> {
    text.parse()
}

fn number(text: &str) -> Result<f64, String> {
    let number = text.trim().parse().ok().filter(|x: &f64| x.is_finite());
    number.ok_or_else(|| "a number".into())
}

/// The ends of the colours.
#[derive(Debug, Clone, Copy)]
struct Range([f64; 2]);

fn range(text: &str) -> Result<Range, String> {
    let ends = text
        .split_once(',')
        .map(|(low, high)| [number(low), number(high)]);
    match ends {
        Some([Ok(low), Ok(high)]) if low < high => Ok(Range([low, high])),
        _ => Err("the values at the ends of the colours, the lower first: `0,120`".into()),
    }
}

fn rate(text: &str) -> Result<f64, String> {
    let rate = number(text).ok().filter(|n| (0.1..=100.0).contains(n));
    rate.ok_or_else(|| "a number from 0.1 to 100".into())
}

fn yes(text: &str) -> Result<bool, String> {
    match text {
        "yes" => Ok(true),
        "no" => Ok(false),
        _ => Err("`yes` or `no`".into()),
    }
}

/// A place in the model.
#[derive(Debug, Clone, Copy)]
struct Place([f64; 3]);

fn place(text: &str) -> Result<Place, String> {
    let numbers: Option<Vec<f64>> = text.split(',').map(|t| t.trim().parse().ok()).collect();
    let numbers = numbers.filter(|all| all.iter().all(|x| x.is_finite()));
    match numbers.as_deref() {
        Some(&[x, y]) => Ok(Place([x, y, 0.0])),
        Some(&[x, y, z]) => Ok(Place([x, y, z])),
        _ => Err("two or three coordinates with commas between them".into()),
    }
}

/// The ends of a line.
#[derive(Debug, Clone, Copy)]
struct Segment([[f64; 3]; 2]);

fn segment(text: &str) -> Result<Segment, String> {
    let ends = text.split_once(':').map(|(a, b)| [place(a), place(b)]);
    match ends {
        Some([Ok(a), Ok(b)]) if a.0 != b.0 => Ok(Segment([a.0, b.0])),
        _ => Err("two places with a colon between them: `0,0,0:10,0,0`".into()),
    }
}

/// The names of two columns.
#[derive(Debug, Clone)]
struct Pair([String; 2]);

fn pair(text: &str) -> Result<Pair, String> {
    match text.split_once(',') {
        Some((a, b)) if !a.trim().is_empty() && !b.trim().is_empty() => {
            Ok(Pair([a, b].map(|t| t.trim().to_string())))
        }
        _ => Err("the names of two columns with a comma between them".into()),
    }
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

/// The files that were written of a table of many runs, modes or spectra, if that is what is asked for.
fn of_table(arguments: &Arguments) -> Result<Option<Vec<PathBuf>>, Failure> {
    let (table, output, size) = (
        &arguments.directory,
        arguments.output.as_deref(),
        arguments.size,
    );
    let tables = &arguments.tables;
    let asked = [&tables.regimes, &tables.stability];
    let of_two = asked.iter().any(|pair| pair.is_some());
    if !of_two && tables.coupling.is_none() && !tables.waterfall {
        return Ok(None);
    }
    // Elsewhere a table is a file by mistake.
    if !table.is_file() {
        given::file(table, &["csv"])?;
    }
    if let Some(against) = &tables.coupling {
        return Ok(Some(plot::coupling(table, output, against, size)?));
    }
    let file = match asked {
        [Some(Pair([across, up])), _] => plot::regimes(table, output, [across, up], size)?,
        [_, Some(Pair([across, up]))] => plot::stability(table, output, [across, up], size)?,
        _ => plot::waterfall(table, output, size)?,
    };
    Ok(Some(vec![file]))
}

/// The files that were written, and what is to be said about them.
pub fn draw(arguments: &Arguments) -> Result<(Vec<PathBuf>, Vec<String>), Failure> {
    let output = arguments.output.as_deref();
    if let Some(files) = of_table(arguments)? {
        return Ok((files, Vec::new()));
    }
    given::results(&arguments.directory)?;
    if let Some(interface) = arguments
        .along
        .as_ref()
        .filter(|_| arguments.lines.history.is_empty())
    {
        let wanted = Along {
            interface: interface.clone(),
            field: arguments.framing.field.clone(),
            when: arguments.framing.time,
            zoom: arguments.framing.zoom,
            size: arguments.size,
            units: arguments.units.clone(),
        };
        let files = plot::along(&arguments.directory, output, &wanted)?;
        return Ok((files, Vec::new()));
    }
    if let Some(Segment(ends)) = arguments.path {
        let line = Line {
            ends,
            field: arguments.framing.field.clone(),
            when: arguments.framing.time,
        };
        let file = plot::path(&arguments.directory, output, &line, arguments.size)?;
        return Ok((vec![file], Vec::new()));
    }
    if arguments.lines.history.is_empty() {
        let picture = Picture {
            field: arguments.framing.field.clone(),
            when: arguments.framing.time,
            mode: arguments.motion.mode.clone(),
            scale: arguments.framing.scale.0,
            view: arguments.framing.view,
            bodies: arguments.framing.bodies.clone(),
            size: arguments.size,
            zoom: arguments.framing.zoom,
            at: arguments.framing.at.map(|at| at.0),
            arrows: arguments.arrows,
            cut: arguments.cut,
            mirrors: arguments.mirror.clone(),
            colours: Colours {
                range: arguments.framing.range.map(|range| range.0),
                bands: arguments.framing.bands,
                threshold: arguments.framing.threshold,
            },
            apart: arguments.framing.apart,
            loads: arguments.loads,
            units: arguments.units.clone(),
        };
        if let Some(file) = &arguments.motion.animate {
            let rate = arguments.motion.rate;
            let notes = plot::animate(&arguments.directory, file, &picture, rate)?;
            return Ok((vec![file.clone()], notes));
        }
        let (mut files, notes) = plot::picture(&arguments.directory, output, &picture)?;
        if arguments.script {
            files.extend(plot::scripts(&arguments.directory, output, &picture)?);
        }
        return Ok((files, notes));
    }
    let named = |names: &[String]| names.iter().filter(|n| !n.is_empty()).cloned().collect();
    let columns = Columns {
        left: named(&arguments.lines.history),
        right: named(&arguments.lines.right),
        against: arguments.lines.against.clone(),
        label: String::new(),
    };
    if columns.left.is_empty() {
        return Err(Failure::Arguments(
            "no column is named".into(),
            "--history takes names of columns of history.csv, with commas between them".into(),
        ));
    }
    let directory = &arguments.directory;
    let size = arguments.size;
    let file = match &arguments.lines.table {
        Some(name) => plot::table(directory, output, name, &columns, size)?,
        None => plot::columns(directory, output, &columns, size)?,
    };
    Ok((vec![file], Vec::new()))
}

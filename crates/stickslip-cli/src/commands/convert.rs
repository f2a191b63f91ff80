use std::path::{Path, PathBuf};
use std::process::ExitCode;

use stickslip::io::{abaqus, gmsh, vtu};

use super::spare;
use stickslip::mesh::{Mesh, check};

use crate::failure::{Failure, Outcome};
use crate::given;
use crate::print;

/// Convert a mesh between Gmsh (.msh), VTK (.vtu) and Abaqus or CalculiX (.inp), or a deck (.inp) to a problem file (.toml) with its mesh. File endings
/// choose the formats.
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Numbers of points and cells, and sets of points, cells and facets, are kept. What cannot be kept is noted on \
                  standard error. In .vtu files sets are arrays of whole numbers: of zeros and ones, or one set for each value."
)]
pub struct Arguments {
    /// The file to read: .msh (2.2 or 4.1), .vtu or .inp.
    input: PathBuf,
    /// The file to write: .msh (4.1), .vtu or .inp; .toml for a deck.
    output: PathBuf,
    /// Element types of a plane mesh in an .inp file.
    #[arg(long, value_enum, default_value_t = Plane::Strain)]
    plane: Plane,
}

/// What plane elements stand for.
#[derive(Debug, Clone, Copy, clap::ValueEnum)]
enum Plane {
    /// CPE
    #[value(name = "plane-strain")]
    Strain,
    /// CPS
    #[value(name = "plane-stress")]
    Stress,
    /// CAX
    Axisymmetric,
}

impl Plane {
    fn space(self) -> abaqus::Space {
        match self {
            Plane::Strain => abaqus::Space::PlaneStrain,
            Plane::Stress => abaqus::Space::PlaneStress,
            Plane::Axisymmetric => abaqus::Space::Axisymmetric,
        }
    }
}

/// What is read, and what meshes are written as.
const READ: [&str; 3] = ["msh", "vtu", "inp"];
const FROM: &str = "read from .msh, .vtu and .inp files";
const WRITTEN: &str = "written as .msh, .vtu or .inp";

/// Converts the file.
pub fn run(arguments: &Arguments) -> Outcome {
    let (input, output) = (&arguments.input, &arguments.output);
    spare(output, std::slice::from_ref(input))?;
    let (from, to) = (ending(input), ending(output));
    if !["msh", "vtu", "inp", "toml"].contains(&to.as_str()) {
        return Err(unknown(output, &to, WRITTEN));
    }
    // What is there is looked at, and named as what it is.
    if !READ.contains(&from.as_str()) && !input.exists() {
        return Err(unknown(input, &from, FROM));
    }
    given::file(input, &READ)?;
    if input.is_dir() {
        return Err(Failure::Arguments(
            format!(
                "{}: this is a folder, and a mesh or a deck is wanted",
                input.display()
            ),
            "name a file that ends in .msh, .vtu or .inp".into(),
        ));
    }
    if ending(output) == "toml" {
        return problem(input, output);
    }
    let write = match ending(output).as_str() {
        "msh" => |path: &Path, mesh: &Mesh, _: Plane| gmsh::write(path, mesh),
        "vtu" => |path: &Path, mesh: &Mesh, _: Plane| vtu::write_mesh(path, mesh),
        "inp" => |path: &Path, mesh: &Mesh, plane: Plane| abaqus::write(path, mesh, plane.space()),
        other => return Err(unknown(output, other, WRITTEN)),
    };
    let mesh = match ending(input).as_str() {
        "msh" => gmsh::read(input),
        "vtu" => vtu::read_mesh(input),
        "inp" => Ok(stickslip_deck::read_mesh(input).map_err(Failure::Deck)?),
        other => return Err(unknown(input, other, FROM)),
    };
    let mesh = mesh.map_err(stickslip::Error::Mesh)?;
    let mut notes = write(output, &mesh, arguments.plane)?;
    if let Err(e) = check::check(&mesh) {
        notes.push(format!("an analysis would refuse this mesh: {}", e.message));
    }
    for note in notes {
        print::err(&format!("note: {note}\n"));
    }
    print::out(&summary(output, &mesh))?;
    Ok(ExitCode::SUCCESS)
}

/// A deck to a problem file, with its mesh beside it.
fn problem(input: &Path, output: &Path) -> Outcome {
    if !given::is_deck(input) {
        return Err(Failure::Arguments(
            format!(
                "{}: only decks (.inp) become problem files",
                input.display()
            ),
            "write `body.NAME.gmsh.file` into a problem file of your own for a mesh alone".into(),
        ));
    }
    let deck = crate::input::translate(input)?;
    for note in &deck.notes {
        crate::progress::say(&note.to_string());
    }
    let mesh = output.with_file_name(&deck.mesh_name);
    spare(&mesh, deck.files())?;
    spare(output, deck.files())?;
    for note in gmsh::write(&mesh, &deck.mesh)? {
        crate::progress::say(&format!("note: {note}"));
    }
    stickslip::io::write_atomically(output, deck.toml.as_bytes())?;
    print::out(&summary(&mesh, &deck.mesh))?;
    print::out(&format!("{}: the problem\n", output.display()))?;
    Ok(ExitCode::SUCCESS)
}

/// The ending of a name in small letters; empty if it has none.
fn ending(path: &Path) -> String {
    let ending = path.extension().unwrap_or_default();
    ending.to_string_lossy().to_ascii_lowercase()
}

fn unknown(path: &Path, ending: &str, formats: &str) -> Failure {
    let message = match ending {
        "" => format!("{}: the name has no ending", path.display()),
        _ => format!("{}: the ending .{ending} is not known", path.display()),
    };
    Failure::Arguments(message, format!("meshes are {formats}"))
}

/// What was written, a line for each kind of thing.
fn summary(path: &Path, mesh: &Mesh) -> String {
    let kinds: Vec<String> = mesh
        .blocks
        .iter()
        .map(|block| format!("{} {}", block.cell_ids.len(), block.kind))
        .collect();
    let mut out = format!(
        "{}: {} points, {}\n",
        path.display(),
        mesh.points.len(),
        kinds.join(", ")
    );
    let mut line = |what: &str, names: Vec<&String>| {
        if !names.is_empty() {
            let names: Vec<&str> = names.into_iter().map(String::as_str).collect();
            out += &format!("{what}: {}\n", names.join(", "));
        }
    };
    line("cell sets", mesh.cell_sets.keys().collect());
    line("facet sets", mesh.facet_sets.keys().collect());
    line("point sets", mesh.point_sets.keys().collect());
    out
}

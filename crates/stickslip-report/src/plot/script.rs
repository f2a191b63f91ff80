//! The picture of the bodies as a script for PyVista, from which people go on.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use super::paint::Look;
use super::picture::Picture;
use crate::colour::{STATUSES, Scale, hex};
use crate::field::{Field, Part};
use crate::results::Frame;

/// What a script draws.
pub struct Drawn<'a> {
    pub look: &'a Look,
    pub wanted: &'a Picture,
    /// The time, or the phase of a mode.
    pub frame: &'a Frame,
    /// The names of the bodies.
    pub names: &'a [String],
    pub title: &'a str,
    /// Cells below this place of an axis are drawn.
    pub cut: Option<(usize, f64)>,
}

/// The script; it stands at `file`, and what it draws is also in the picture of that name.
pub fn text(drawn: &Drawn, file: &Path) -> String {
    let look = drawn.look;
    let name = |file: &Path| {
        let name = file.file_name().unwrap_or_default();
        name.to_string_lossy().into_owned()
    };
    let title = look.field.as_ref().map_or("", |f| f.name.as_str());
    let mut out = format!(
        "\"\"\"Draws {title} with PyVista (`pip install pyvista`): `python {0}`, or `python {0} FILE.png` without a window.\"\"\"\n\n",
        name(file)
    );
    out += "import sys\nfrom pathlib import Path\n\nimport numpy as np\nimport pyvista as pv\n\n";
    let _ = writeln!(out, "FILE = {}", place(&drawn.frame.file, file));
    let _ = writeln!(
        out,
        "SCALE = {:?}  # factor of the displacements",
        look.scale
    );
    let [low, high] = look.colours.range;
    let _ = writeln!(
        out,
        "RANGE = [{low:?}, {high:?}]  # the ends of the colours"
    );
    out += "BODIES = {  # number: name, by how much it is moved aside\n";
    for (k, name) in drawn.names.iter().enumerate() {
        if look.shown.get(k).is_some_and(|shown| *shown) {
            let aside = look.offsets.get(k).copied().unwrap_or_default();
            let _ = writeln!(out, "    {k}: ({name:?}, {aside:?}),");
        }
    }
    out += "}\n";
    let mirrors = look.mirrors.iter().map(|(axis, at)| {
        let turns = look.field.as_ref().is_some_and(|f| f.turns(*axis));
        format!("({axis}, {at:?}, {})", if turns { -1 } else { 1 })
    });
    let mirrors: Vec<String> = mirrors.collect();
    let _ = writeln!(
        out,
        "MIRRORS = [{}]  # axis, place, factor of the field beyond it",
        mirrors.join(", ")
    );
    out += "\ngrid = pv.read(FILE)\n";
    if let Some((axis, at)) = drawn.cut {
        let _ = writeln!(
            out,
            "grid = grid.extract_cells(np.flatnonzero(grid.cell_centers().points[:, {axis}] < {at:?}))"
        );
    }
    out += &displacements(drawn.frame);
    if let Some(field) = &look.field {
        out += &values(field);
    }
    out += &drawing(drawn, title);
    out
}

/// A file as a script that stands at `file` finds it: beside it, or by its full path.
fn place(wanted: &Path, file: &Path) -> String {
    let folder = |path: &Path| -> Option<PathBuf> {
        let parent = path.parent().filter(|p| !p.as_os_str().is_empty());
        parent.unwrap_or(Path::new(".")).canonicalize().ok()
    };
    let (from, to) = (folder(file), folder(wanted));
    let name = wanted.file_name().unwrap_or_default().to_string_lossy();
    match (from, to) {
        (Some(from), Some(to)) if from == to => format!("Path(__file__).parent / {name:?}"),
        (_, Some(to)) => format!("Path({:?})", to.join(&*name).to_string_lossy()),
        _ => format!("Path({:?})", wanted.to_string_lossy()),
    }
}

fn displacements(frame: &Frame) -> String {
    match &frame.phase {
        None => "moved = np.asarray(grid.point_data[\"U\"]) if \"U\" in grid.point_data else np.zeros_like(grid.points)\n".into(),
        Some(phase) => format!(
            "real = np.asarray(grid.point_data[\"PHI\"])\n\
             imaginary = np.asarray(grid.point_data[\"PHI_IMAGINARY\"]) if \"PHI_IMAGINARY\" in grid.point_data else np.zeros_like(real)\n\
             largest = np.sqrt((real**2 + imaginary**2).sum(axis=1).max())\n\
             PHASE = {:?}  # in radians\n\
             moved = (np.cos(PHASE) * real - np.sin(PHASE) * imaginary) / largest\n",
            phase.angle
        ),
    }
}

/// The field at the points.
fn values(field: &Field) -> String {
    let array = match field.array.as_str() {
        // Displacements of a mode have no array of their own.
        "U" => "moved".to_string(),
        name => format!("np.asarray(grid.point_data[{name:?}])"),
    };
    let tensor = "np.linalg.eigvalsh(stress[:, [[0, 3, 5], [3, 1, 4], [5, 4, 2]]])[:, ::-1]";
    match field.part {
        Part::Component(c) => {
            format!("values = {array}\nif values.ndim > 1:\n    values = values[:, {c}]\n")
        }
        Part::Magnitude => format!("values = np.linalg.norm({array}, axis=1)\n"),
        Part::Invariant(_) => {
            let number = match field.name.as_str() {
                "S1" => "principal[:, 0]",
                "S2" => "principal[:, 1]",
                "S3" => "principal[:, 2]",
                "TRESCA" => "principal[:, 0] - principal[:, 2]",
                _ => "-principal.mean(axis=1)",
            };
            format!("stress = {array}\nprincipal = {tensor}\nvalues = {number}\n")
        }
    }
}

fn drawing(drawn: &Drawn, title: &str) -> String {
    let look = drawn.look;
    let [width, height] = drawn.wanted.size;
    let mut out = format!(
        "\nplotter = pv.Plotter(off_screen=len(sys.argv) > 1, window_size=[{width}, {height}])\n\
         grid.point_data[\"moved\"] = moved\n"
    );
    let colours = match look.field {
        Some(_) => {
            let _ = writeln!(out, "grid.point_data[{title:?}] = values");
            format!(", scalars={title:?}{}", colours(&look.colours))
        }
        None => String::new(),
    };
    out += "for number, (name, aside) in BODIES.items():\n\
            \x20   numbers = grid.cell_data.get(\"BODY\", np.zeros(grid.n_cells))\n\
            \x20   body = grid.extract_cells(np.flatnonzero(numbers == number))\n\
            \x20   body.points = body.points + SCALE * np.asarray(body.point_data[\"moved\"]) + np.asarray(aside)\n\
            \x20   parts = [body]\n\
            \x20   for axis, at, factor in MIRRORS:\n\
            \x20       for part in list(parts):\n\
            \x20           normal, point = np.eye(3)[axis], at * np.eye(3)[axis]\n\
            \x20           other = part.reflect(normal, point=point)\n";
    if look.field.is_some() {
        let _ = writeln!(
            out,
            "            other.point_data[{title:?}] = factor * np.asarray(part.point_data[{title:?}])"
        );
    }
    let _ = writeln!(
        out,
        "            parts.append(other)\n    for part in parts:\n        plotter.add_mesh(part{colours})"
    );
    let words = match &drawn.frame.phase {
        Some(phase) => format!(
            "{}, phase {:.0} degrees",
            phase.label,
            phase.angle.to_degrees()
        ),
        None => format!("time {}", stickslip::number::digits(drawn.frame.time, 5)),
    };
    let text = format!("{}\n{words}", drawn.title);
    let _ = writeln!(out, "plotter.add_text({text:?}, font_size=10)");
    let up = look.camera.up;
    let out_of = look.camera.out;
    let _ = writeln!(
        out,
        "plotter.enable_parallel_projection()\nplotter.view_vector({out_of:?}, viewup={up:?})\n\
         plotter.show(screenshot=sys.argv[1] if len(sys.argv) > 1 else None)"
    );
    out
}

/// The colours of a field, as arguments of `add_mesh`.
fn colours(scale: &Scale) -> String {
    if scale.status {
        let list: Vec<String> = STATUSES
            .iter()
            .map(|(_, c)| format!("{:?}", hex(*c)))
            .collect();
        return format!(", clim=[-0.5, 3.5], cmap=[{}]", list.join(", "));
    }
    let map = match (scale.signed, scale.carried) {
        (true, _) => "RdBu_r",
        (_, true) => "magma_r",
        _ => "viridis",
    };
    let bands = scale
        .bands
        .map_or(String::new(), |n| format!(", n_colors={n}"));
    let below = scale.threshold.map_or(String::new(), |low| {
        format!(", clim=[{low:?}, RANGE[1]], below_color=\"lightgrey\"")
    });
    let limits = if below.is_empty() { ", clim=RANGE" } else { "" };
    format!("{limits}{below}, cmap={map:?}{bands}")
}

//! What is done to the bodies: supports, loads and steps.

use std::fmt::Write as _;

use super::body::{Body, Form, Space, point};
use super::random::Random;

/// How far and how hard.
pub struct Drive {
    /// Displacement of the upper body towards the lower one.
    pub press: f64,
    /// Pressure on the far side of the upper body that presses about as much.
    pub pressure: f64,
    /// Displacement sideways.
    pub slide: f64,
    /// Displacement by which the bodies surely touch.
    pub touch: f64,
    /// Coefficient of friction.
    pub mu: f64,
}

/// The tables of a path, and what it is in a few words.
pub struct Path {
    /// The tables.
    pub text: String,
    /// For the description.
    pub words: String,
}

/// Rows of [time, down, along, across].
type Rows = &'static [[f64; 4]];

/// Paths by displacements.
const PATHS: [(&str, Rows); 6] = [
    (
        "press, slide",
        &[[0., 0., 0., 0.], [1., 1., 0., 0.], [2., 1., 1., 0.]],
    ),
    (
        "press, slide, lift, press, slide back",
        &[
            [0., 0., 0., 0.],
            [1., 1., 0., 0.],
            [2., 1., 1., 0.],
            [3., -0.2, 1., 0.],
            [4., 1., 1., 0.],
            [5., 1., 0., 0.],
        ],
    ),
    (
        "press, back and forth",
        &[
            [0., 0., 0., 0.],
            [1., 1., 0., 0.],
            [2., 1., 1., 0.],
            [3., 1., -1., 0.],
            [4., 1., 1., 0.],
        ],
    ),
    (
        "press, round a circle",
        &[
            [0., 0., 0., 0.],
            [1., 0.8, 0., 0.],
            [1.25, 0.9, 0.7, 0.29],
            [1.5, 1.0, 1., 1.],
            [1.75, 0.9, 0.7, 1.7],
            [2., 0.8, 0., 2.],
            [2.25, 0.7, -0.7, 1.7],
            [2.5, 0.6, -1., 1.],
            [2.75, 0.7, -0.7, 0.29],
            [3., 0.8, 0., 0.],
        ],
    ),
    (
        "press and slide at once",
        &[[0., 0., 0., 0.], [1., 1., 1., 0.], [2., 0.5, 1.5, 0.]],
    ),
    (
        "press, slide, half unload, slide back",
        &[
            [0., 0., 0., 0.],
            [1., 1., 0., 0.],
            [2., 1., 1., 0.],
            [3., 0.5, 1., 0.],
            [4., 0.5, -0.5, 0.],
        ],
    ),
];

/// Draws a path. Sliding goes along x, or along y where x = 0 is a plane of symmetry.
pub fn path(random: &mut Random, lower: &Body, upper: &Body, drive: &Drive) -> Path {
    let mut text = String::new();
    hold(&mut text, lower, upper);
    let flats = lower.form == Form::Flat && upper.form == Form::Flat;
    let broad = flats && upper.width <= lower.width && !upper.mirrored;
    let words = match random.whole(1, 10) {
        // The far side of a full disc has no facets of its own, and a guide needs points at two heights.
        1..=2 if upper.form != Form::Round && upper.depth() > 5.0 * upper.cell => {
            by_force(random, &mut text, upper, drive)
        }
        3 if broad && upper.space != Space::Axisymmetric => push(random, &mut text, upper, drive),
        _ => by_displacement(random, &mut text, upper, drive),
    };
    Path { text, words }
}

/// The lower body is held, and so are cuts.
fn hold(text: &mut String, lower: &Body, upper: &Body) {
    let z = if lower.space == Space::Solid {
        ", z = 0"
    } else {
        ""
    };
    let _ = writeln!(
        text,
        "[support]\nbase = {{ set = \"{}\", x = 0, y = 0{z} }}",
        lower.far()
    );
    // What the base holds already need not be held again.
    for body in [lower, upper] {
        if let Some(cut) = body.cut() {
            let _ = writeln!(text, "{}-cut = {{ set = \"{cut}\", x = 0 }}", body.name);
        }
    }
}

/// The names of the axes: down, along the slide, across it.
fn axes(upper: &Body) -> (&'static str, Option<&'static str>, Option<&'static str>) {
    match (upper.space, upper.mirrored) {
        (Space::Axisymmetric, _) => ("y", None, None),
        (Space::Solid, false) => ("z", Some("x"), Some("y")),
        (Space::Solid, true) => ("z", Some("y"), None),
        _ => ("y", Some("x"), None),
    }
}

fn by_displacement(random: &mut Random, text: &mut String, upper: &Body, drive: &Drive) -> String {
    let (name, rows) = random.pick(&PATHS);
    let (down, along, across) = axes(upper);
    let far = upper.far();
    let mut amplitudes = String::new();
    let mut support = |key: &str, axis: &str, value: f64, column: usize| {
        let _ = writeln!(
            text,
            "{key} = {{ set = \"{far}\", {axis} = {value:e}, amplitude = \"{key}\" }}"
        );
        let table: Vec<String> = rows
            .iter()
            .map(|row| format!("[{}, {}]", row[0], row[column]))
            .collect();
        let _ = writeln!(amplitudes, "{key}.table = [{}]", table.join(", "));
    };
    support("press", down, -drive.press, 1);
    if let Some(axis) = along {
        support("slide", axis, drive.slide, 2);
    }
    if let Some(axis) = across {
        support("across", axis, drive.slide, 3);
    }
    let _ = writeln!(text, "\n[amplitude]\n{amplitudes}");
    let end = rows.last().map_or(1.0, |row| row[0]);
    for _ in 0..end as usize {
        step(random, text, "");
    }
    name.to_string()
}

/// Pressed by a force while a guide carries the upper body sideways.
fn by_force(random: &mut Random, text: &mut String, upper: &Body, drive: &Drive) -> String {
    let (down, along, across) = axes(upper);
    let far = upper.far();
    let _ = writeln!(
        text,
        "close = {{ set = \"{far}\", {down} = {:e} }}",
        -drive.touch
    );
    let mut held = String::from("\"base\"");
    if upper.cut().is_some() {
        held.push_str(", \"lower-cut\", \"upper-cut\"");
    }
    if let Some(axis) = along {
        let _ = writeln!(
            text,
            "guide = {{ set = \"guide\", {axis} = {:e}, amplitude = \"slide\" }}",
            drive.slide
        );
        held.push_str(", \"guide\"");
    }
    if let Some(axis) = across {
        let _ = writeln!(text, "across = {{ set = \"guide\", {axis} = 0 }}");
        held.push_str(", \"across\"");
    }
    if along.is_some() {
        // Points at several heights, so that the body cannot turn.
        let _ = writeln!(text, "\n[set.guide]\n{}", upper.above(0.55));
        let _ = writeln!(
            text,
            "\n[amplitude]\nslide.table = [[2, 0], [3, 1], [4, 0.5]]"
        );
    }
    let _ = writeln!(
        text,
        "\n[load.weight]\nset = \"{far}\"\npressure = {{ value = {:e} }}\namplitude = \"weight\"\n",
        drive.pressure
    );
    let _ = writeln!(
        text,
        "[amplitude.weight]\ntable = [[1, 0.2], [2, 1], [3, 1], [4, 0.4]]\n"
    );
    let all = format!("{held}, \"close\"");
    step(random, text, &format!("supports = [{all}]\nloads = []\n"));
    for _ in 0..3 {
        step(random, text, &format!("supports = [{held}]\n"));
    }
    "pressed by a force, guided".to_string()
}

/// Pressed and pushed by forces; nothing but contact holds the upper body.
fn push(random: &mut Random, text: &mut String, upper: &Body, drive: &Drive) -> String {
    let far = upper.far();
    let flat = upper.space != Space::Solid;
    let (down, _, _) = axes(upper);
    let z = if flat { "" } else { ", y = 0" };
    let _ = writeln!(
        text,
        "close = {{ set = \"{far}\", x = 0{z}, {down} = {:e} }}\n",
        -drive.touch
    );
    // Less than friction can bear, and less than tips the block.
    let most = (drive.mu).min(0.3 * upper.width / upper.height);
    let push = drive.pressure * most * random.between(0.2, 0.8);
    let _ = writeln!(
        text,
        "[load.weight]\nset = \"{far}\"\npressure = {{ value = {:e} }}\n",
        drive.pressure
    );
    let _ = writeln!(
        text,
        "[load.push]\nset = \"{far}\"\ntraction = {{ value = {} }}\namplitude = \"push\"\n",
        point(flat, [push, 0.0, 0.0])
    );
    let _ = writeln!(
        text,
        "[amplitude]\npush.table = [[2, 0], [3, 1], [4, -1]]\n"
    );
    // Without friction the block is unconstrained sideways.
    let free = drive.mu == 0.0;
    let slipping = if free { ", \"aside\"" } else { "" };
    if free {
        let _ = writeln!(
            text,
            "[support.aside]\nset = \"{far}\"\nx = 0{}\n",
            z.replace(", ", "\n")
        );
    }
    step(
        random,
        text,
        "supports = [\"base\", \"close\"]\nloads = []\n",
    );
    for loads in ["\"weight\"", "\"weight\", \"push\"", "\"weight\", \"push\""] {
        step(
            random,
            text,
            &format!("supports = [\"base\"{slipping}]\nloads = [{loads}]\n"),
        );
    }
    "pressed and pushed by forces".to_string()
}

/// A step of one to ten increments.
fn step(random: &mut Random, text: &mut String, keys: &str) {
    let n = random.whole(1, 10);
    let size = 1.0 / n as f64;
    let _ = writeln!(
        text,
        "[[step]]\n{keys}increments = {{ initial = {size}, largest = {size} }}\n"
    );
}

//! A body on a rigid shape that moves or turns beneath it.

use std::fmt::Write as _;

use super::body::{Body, Form, Space, point};
use super::draft::{Draft, beginning};
use super::law::laws;
use super::options::{formulation, options};
use super::random::{Random, digits};
use super::scene::{Scene, scene};

/// A shape whose top is at height zero.
pub struct Shape {
    /// Its table without motion.
    pub text: String,
    /// In a word.
    pub word: &'static str,
    /// Radius, if it is round.
    pub radius: Option<f64>,
}

/// Draws a shape that a body of this width can lie on.
pub fn shape(random: &mut Random, body: &Body) -> Shape {
    let flat = body.space != Space::Solid;
    let ring = body.space == Space::Axisymmetric;
    let radius = digits(body.width * random.between(2.0, 8.0));
    let centre = point(flat, [0.0, 0.0, -radius]);
    match random.whole(1, 3) {
        1 if !ring => {
            let axis = if flat { "" } else { ", axis = [0, 1, 0]" };
            let text = format!("cylinder = {{ centre = {centre}, radius = {radius:e}{axis} }}\n");
            Shape {
                text,
                word: "cylinder",
                radius: Some(radius),
            }
        }
        2 if !flat || ring => {
            let text = format!("sphere = {{ centre = {centre}, radius = {radius:e} }}\n");
            Shape {
                text,
                word: "sphere",
                radius: Some(radius),
            }
        }
        _ => {
            let up = point(flat, [0.0, 0.0, 1.0]);
            let at = point(flat, [0.0, 0.0, 0.0]);
            let text = format!("plane = {{ point = {at}, normal = {up} }}\n");
            Shape {
                text,
                word: "plane",
                radius: None,
            }
        }
    }
}

/// Draws a problem of one body and an obstacle.
pub fn draw(random: &mut Random) -> Draft {
    let mut scene = scene(random);
    let laws = laws(random, &scene.scale);
    scene.upper.mirrored = false;
    scene.upper.keys = format!("formulation = \"{}\"\n", formulation(random, &scene.upper));
    let Scene {
        upper,
        scale,
        drive,
        ..
    } = &scene;
    let shape = shape(random, upper);
    let small = shape.radius.is_none() && scale.slide < 0.3 * upper.cell;
    let options = options(random, &laws, None, small);
    let solid = upper.space == Space::Solid;
    let mut text = beginning(upper.space);
    text.push_str(&upper.text(random));
    // Round bodies on round shapes touch later.
    let press = digits(
        drive.press
            * if upper.form == Form::Flat && shape.radius.is_some() {
                2.0
            } else {
                1.0
            },
    );
    let _ = writeln!(text, "[obstacle.floor]\n{}", shape.text);
    let far = upper.far();
    let (down, aside) = if solid {
        ("z", Some("x"))
    } else {
        ("y", (upper.space != Space::Axisymmetric).then_some("x"))
    };
    let across = if solid { ", y = 0" } else { "" };
    let slide = match shape.radius {
        Some(radius) => scale.slide.min(0.05 * radius),
        None => scale.slide,
    };
    let mut words = "pressed";
    let mut moves = false;
    let mut sideways = 0.0;
    if aside.is_some() {
        match random.whole(1, 4) {
            1 => {
                words = "pressed and slid";
                sideways = slide;
            }
            2 | 3 if shape.radius.is_some() => {
                words = "on a turning obstacle";
                moves = true;
                let angle = digits(random.pick(&[0.02, 0.2, 1.0]));
                let spin = if solid { ", axis = [0, 1, 0]" } else { "" };
                let centre = point(!solid, [0.0, 0.0, -shape.radius.unwrap_or(0.0)]);
                let _ = writeln!(
                    text,
                    "motion.rotation = {{ centre = {centre}{spin}, angle = [[1, 0], [2, {angle}], [3, {}]] }}",
                    digits(0.3 * angle)
                );
            }
            2 if solid => {
                words = "on an obstacle that turns about its normal";
                moves = true;
                let angle = digits(random.pick(&[0.02, 0.2, 1.0]));
                let _ = writeln!(
                    text,
                    "motion.rotation = {{ centre = [0, 0, 0], axis = [0, 0, 1], angle = [[1, 0], [2, {angle}], [3, {}]] }}",
                    digits(-0.3 * angle)
                );
            }
            _ => {
                words = "on an obstacle that moves";
                moves = true;
                let row = |t: f64, x: f64| {
                    if solid {
                        format!("[{t}, {x:e}, {:e}, 0]", 0.5 * x)
                    } else {
                        format!("[{t}, {x:e}, 0]")
                    }
                };
                let rows = [row(1.0, 0.0), row(2.0, slide), row(3.0, -0.5 * slide)];
                let _ = writeln!(text, "motion.translation = [{}]", rows.join(", "));
            }
        }
    }
    let _ = writeln!(
        text,
        "\n[interface.joint]\nsecondary = \"{}\"\nprimary = \"floor\"\n{}{}",
        upper.contact(),
        laws.text,
        options.text
    );
    let _ = writeln!(
        text,
        "[support]\npress = {{ set = \"{far}\", {down} = {:e}, amplitude = \"press\" }}",
        -press
    );
    if let Some(aside) = aside {
        let _ = writeln!(
            text,
            "slide = {{ set = \"{far}\", {aside} = {sideways:e}{across}, amplitude = \"slide\" }}"
        );
    } else if let Some(cut) = upper.cut() {
        let _ = writeln!(text, "cut = {{ set = \"{cut}\", x = 0 }}");
    }
    let last = random.pick(&[1.0, 0.5, -0.2]);
    let _ = writeln!(
        text,
        "\n[amplitude]\npress.table = [[0, 0], [1, 1], [2, 1], [3, {last}]]\nslide.table = [[1, 0], [2, 1], [3, -0.5]]\n"
    );
    for _ in 0..if moves || sideways > 0.0 { 3 } else { 2 } {
        let n = random.whole(2, 8);
        let _ = writeln!(
            text,
            "[[step]]\nincrements = {{ initial = {0}, largest = {0} }}\n",
            digits(1.0 / n as f64)
        );
    }
    let words = format!(
        "{}, {:?} {} on a {}; {}{}; {words}",
        upper.space.name(),
        upper.form,
        upper.element,
        shape.word,
        laws.words,
        options.words
    );
    Draft {
        family: "obstacle",
        words,
        text,
    }
}

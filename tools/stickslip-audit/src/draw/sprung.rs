//! A block that springs hold and equations keep level, pressed and pushed by forces.

use std::fmt::Write as _;

use super::body::{Form, Space, point};
use super::draft::{Draft, beginning};
use super::law::laws;
use super::options::{formulation, options};
use super::random::{Random, digits};
use super::scene::{Scene, scene};

/// Draws a problem with springs and equations.
pub fn draw(random: &mut Random) -> Draft {
    let mut scene = scene(random);
    let laws = laws(random, &scene.scale);
    for body in [&mut scene.lower, &mut scene.upper] {
        body.mirrored = false;
        body.form = Form::Flat;
        body.width = body.width.min(scene.unit);
        body.height = digits(0.4 * scene.unit);
        body.cell = body.cell.max(
            scene.unit
                / if body.space == Space::Solid {
                    6.0
                } else {
                    24.0
                },
        );
        body.keys = format!("formulation = \"{}\"\n", formulation(random, body));
    }
    let Scene {
        lower,
        upper,
        scale,
        drive,
        unit,
    } = &scene;
    let (solid, ring) = (
        upper.space == Space::Solid,
        upper.space == Space::Axisymmetric,
    );
    let options = options(random, &laws, Some(lower), scale.slide < 0.2 * lower.cell);
    let mut text = beginning(upper.space);
    for body in [lower, upper] {
        text.push_str(&body.text(random));
    }
    let z = if solid { ", z = 0" } else { "" };
    let _ = writeln!(
        text,
        "[interface.joint]\nsecondary = \"upper.bottom\"\nprimary = \"lower.top\"\n{}{}",
        laws.text, options.text
    );
    let _ = writeln!(
        text,
        "[support]\nbase = {{ set = \"lower.bottom\", x = 0, y = 0{z} }}"
    );
    if ring {
        text.push_str("hub = { set = \"upper.left\", x = 0 }\n");
    }
    // Springs that let the block slide by about what the laws expect.
    let thick = if solid { 0.5 * *unit } else { 1.0 };
    let force = drive.pressure.max(0.1 * scale.pressure) * upper.width * thick;
    let per_point = upper.width / upper.cell * if solid { upper.width / upper.cell } else { 1.0 };
    let k = digits(0.3 * force / scale.slide.max(scale.approach) / per_point);
    let springs = match (ring, solid) {
        (true, _) => [0.0, 0.1 * k, 0.0],
        (_, true) => [k, k, 0.1 * k],
        _ => [k, 0.1 * k, 0.0],
    };
    let values: Vec<String> = springs[..if solid { 3 } else { 2 }]
        .iter()
        .map(|k| format!("{:e}", digits(*k)))
        .collect();
    let _ = writeln!(
        text,
        "\n[load.springs]\nset = \"upper.top\"\nspring.stiffness = [{}]\n",
        values.join(", ")
    );
    let down = if solid { "z" } else { "y" };
    let level = random.chance(0.6);
    if level {
        let corner = if solid {
            "upper.top-left-front"
        } else {
            "upper.top-left"
        };
        let _ = writeln!(
            text,
            "[coupling.level]\nequation.terms = [{{ set = \"upper.top\", component = \"{down}\" }}, {{ set = \"corner\", component = \"{down}\", factor = -1 }}]\n"
        );
        let at = [
            if ring { 0.0 } else { -0.5 * upper.width },
            -0.5 * upper.width,
            upper.gap + upper.height,
        ];
        let _ = corner;
        let _ = writeln!(
            text,
            "[set.corner]\nof = \"upper\"\npoint = {}\n",
            point(!solid, at)
        );
    }
    let _ = writeln!(
        text,
        "[load.weight]\nset = \"upper.top\"\npressure.value = {:e}\namplitude = \"weight\"\n",
        drive.pressure
    );
    if !ring {
        let push = digits(drive.pressure * (laws.mu + 0.1).min(0.5) * random.between(0.3, 2.0));
        let _ = writeln!(
            text,
            "[load.push]\nset = \"upper.top\"\ntraction.value = {}\namplitude = \"push\"\n",
            point(!solid, [push, 0.3 * push * 0.0, 0.0])
        );
        text.push_str("[amplitude.push]\ntable = [[1, 0], [2, 1], [3, -1]]\n\n");
    }
    text.push_str("[amplitude.weight]\ntable = [[0, 0], [1, 1], [2, 1], [3, 0.6]]\n\n");
    for _ in 0..3 {
        let n = random.whole(2, 8);
        let _ = writeln!(
            text,
            "[[step]]\nincrements = {{ initial = {0}, largest = {0} }}\n",
            digits(1.0 / n as f64)
        );
    }
    let words = format!(
        "{}, {} on {} on springs{}; {}{}",
        upper.space.name(),
        upper.element,
        lower.element,
        if level { ", kept level" } else { "" },
        laws.words,
        options.words
    );
    Draft {
        family: "springs",
        words,
        text,
    }
}

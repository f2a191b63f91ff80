//! Three bodies on top of each other: the one in the middle elastic or rigid, one of the joints perhaps glued.

use std::fmt::Write as _;

use super::body::{Body, Form, Space};
use super::draft::{Draft, beginning};
use super::law::laws;
use super::options::{formulation, options};
use super::random::{Random, digits};
use super::scene::{Scene, scene};

/// Draws a problem of three bodies.
pub fn draw(random: &mut Random) -> Draft {
    let mut scene = scene(random);
    let Scene {
        lower,
        upper,
        scale,
        drive,
        unit,
    } = &mut scene;
    let solid = upper.space == Space::Solid;
    let ring = upper.space == Space::Axisymmetric;
    for body in [&mut *lower, &mut *upper] {
        body.mirrored = false;
        body.form = Form::Flat;
    }
    lower.width = *unit;
    lower.height = digits(0.35 * *unit);
    upper.width = digits(*unit * random.pick(&[0.5, 0.7, 1.0]));
    upper.height = digits(0.3 * *unit);
    let coarsest = *unit / if solid { 4.0 } else { 12.0 };
    let mut cell = || digits(coarsest / random.between(1.0, if solid { 1.4 } else { 2.0 }));
    (lower.cell, upper.cell) = (cell(), cell());
    let mut middle = Body {
        name: "middle",
        space: upper.space,
        upper: true,
        form: Form::Flat,
        element: if random.chance(0.5) {
            lower.element
        } else {
            upper.element
        },
        mirrored: false,
        width: digits(*unit * 0.83),
        height: digits(0.25 * *unit),
        cell: digits(coarsest / 1.3),
        zone: 0.0,
        gap: 0.0,
        young: digits(lower.young * random.spread(0.2, 5.0)),
        poisson: random.between(0.0, 0.4),
        density: lower.density,
        keys: String::new(),
    };
    upper.gap = middle.height;
    let rigid = !ring && random.chance(0.3);
    middle.keys = match rigid {
        true => "rigid = true\n".into(),
        false => format!("formulation = \"{}\"\n", formulation(random, &middle)),
    };
    for body in [&mut *lower, &mut *upper] {
        body.keys = format!("formulation = \"{}\"\n", formulation(random, body));
    }
    let (lower, upper, scale, middle) = (&*lower, &*upper, &*scale, &middle);
    // With slips against the least of the cells, whatever the scene had.
    let small = scale.slide < 0.2 * coarsest / 2.0;
    let glued = match random.whole(1, 4) {
        1 => Some(0),
        2 => Some(1),
        _ => None,
    };
    let mut text = beginning(upper.space);
    for body in [lower, middle, upper] {
        text.push_str(&body.text(random));
    }
    let mut words = Vec::new();
    for (i, (below, above)) in [(lower, middle), (middle, upper)].into_iter().enumerate() {
        let bottom = format!("{}.bottom", above.name);
        let top = format!("{}.top", below.name);
        let fine = below.cell < above.cell;
        // What is rigid carries the normal.
        let below_first = if rigid { i == 0 } else { fine };
        let (secondary, primary, facets) = match below_first {
            true => (&top, &bottom, above),
            false => (&bottom, &top, below),
        };
        let _ = writeln!(
            text,
            "[interface.j{}]\nsecondary = \"{secondary}\"\nprimary = \"{primary}\"",
            i + 1
        );
        if glued == Some(i) {
            text.push_str("tied = true\n\n");
            words.push("glued".to_string());
            continue;
        }
        let mut laws = laws(random, scale);
        while laws.mu == 0.0 {
            laws = super::law::laws(random, scale);
        }
        let options = options(random, &laws, Some(facets), small);
        let _ = writeln!(text, "{}{}", laws.text, options.text);
        words.push(format!("{}{}", laws.words, options.words));
    }
    let (down, aside) = if solid { ("z", "x") } else { ("y", "x") };
    let depth = if solid { ", y = 0" } else { "" };
    let base = if solid { ", z = 0" } else { "" };
    let _ = writeln!(
        text,
        "[support]\nbase = {{ set = \"lower.bottom\", x = 0, y = 0{base} }}"
    );
    let press = digits(drive.press.min(0.01 * *unit));
    let _ = writeln!(
        text,
        "press = {{ set = \"upper.top\", {down} = {:e}, amplitude = \"press\" }}",
        -press
    );
    let slide = digits(scale.slide.min(0.05 * *unit));
    if ring {
        let _ = writeln!(
            text,
            "hub = {{ set = \"middle.left\", x = 0 }}\ntop-hub = {{ set = \"upper.left\", x = 0 }}"
        );
    } else {
        let _ = writeln!(
            text,
            "slide = {{ set = \"upper.top\", {aside} = {slide:e}{depth}, amplitude = \"slide\" }}"
        );
    }
    let last = random.pick(&[1.0, 0.5]);
    let _ = writeln!(
        text,
        "\n[amplitude]\npress.table = [[0, 0], [1, 1], [2, 1], [3, {last}]]\nslide.table = [[1, 0], [2, 1], [3, -0.5]]\n"
    );
    for _ in 0..3 {
        let n = random.whole(2, 6);
        let _ = writeln!(
            text,
            "[[step]]\nincrements = {{ initial = {0}, largest = {0} }}\n",
            digits(1.0 / n as f64)
        );
    }
    let words = format!(
        "{}, {} on {}{} on {}; {}",
        upper.space.name(),
        upper.element,
        if rigid { "rigid " } else { "" },
        middle.element,
        lower.element,
        words.join("; ")
    );
    Draft {
        family: "stack",
        words,
        text,
    }
}

//! Bodies in motion: thrown, or pressed and then shaken, on a body or a floor.

use std::fmt::Write as _;

use super::body::{Form, Space, point};
use super::draft::{Draft, beginning};
use super::law::laws;
use super::options::{formulation, options};
use super::random::{Random, digits};
use super::scene::{Scene, scene};

/// Draws a problem in motion.
pub fn draw(random: &mut Random, explicit: bool) -> Draft {
    let mut scene = scene(random);
    let laws = laws(random, &scene.scale);
    let solid = scene.upper.space == Space::Solid;
    let base = scene.lower.young.min(scene.upper.young);
    for body in [&mut scene.lower, &mut scene.upper] {
        body.mirrored = false;
        if body.form == Form::Round {
            body.form = Form::Half;
        }
        let (coarse, fine) = if solid { (5.0, 3.0) } else { (14.0, 7.0) };
        body.cell = body.cell.clamp(scene.unit / coarse, scene.unit / fine);
        body.width = body.width.min(scene.unit);
        body.young = digits(body.young.clamp(base, 10.0 * base));
        body.keys = format!(
            "formulation = \"{}\"\n",
            if explicit {
                "standard"
            } else {
                formulation(random, body)
            }
        );
        if random.chance(0.3) {
            body.keys.push_str("rayleigh.stiffness = @DAMP\n");
        }
    }
    let Scene {
        lower,
        upper,
        scale,
        unit,
        ..
    } = &scene;
    let ring = upper.space == Space::Axisymmetric;
    let floor = random.chance(0.4);
    // Time of a wave through the body.
    let wave = upper.depth() / (upper.young / upper.density).sqrt();
    let mut text = beginning(upper.space);
    if !floor {
        text.push_str(&lower.text(random));
    }
    text.push_str(&upper.text(random));
    if floor {
        let (at, up) = (point(!solid, [0.0; 3]), point(!solid, [0.0, 0.0, 1.0]));
        let _ = writeln!(
            text,
            "[obstacle.floor]\nplane = {{ point = {at}, normal = {up} }}\n"
        );
    }
    let options = options(random, &laws, (!floor).then_some(lower), false);
    let kinematics = options.text.contains("small-sliding");
    let primary = if floor {
        "floor".to_string()
    } else {
        lower.contact()
    };
    let _ = writeln!(
        text,
        "[interface.joint]\nsecondary = \"{}\"\nprimary = \"{primary}\"\n{}{}",
        upper.contact(),
        laws.text,
        options.text
    );
    let _ = kinematics;
    text.push_str("[support]\n");
    let z = if solid { ", z = 0" } else { "" };
    if !floor {
        let _ = writeln!(
            text,
            "base = {{ set = \"{}\", x = 0, y = 0{z} }}",
            lower.far()
        );
    }
    if ring {
        for body in [lower, upper].into_iter().skip(usize::from(floor)) {
            let _ = writeln!(
                text,
                "{}-cut = {{ set = \"{}\", x = 0 }}",
                body.name,
                body.cut().unwrap_or_default()
            );
        }
    }
    let (scheme, word) = match explicit {
        true => ("central-difference = {}".to_string(), "explicit"),
        false => match random.whole(1, 3) {
            1 => ("newmark = {}".into(), "newmark"),
            2 => (
                format!("hht = {{ alpha = {} }}", random.pick(&[-0.05, -0.2])),
                "hht",
            ),
            _ => (
                format!(
                    "generalised-alpha = {{ rho = {} }}",
                    random.pick(&[0.9, 0.5])
                ),
                "generalised-alpha",
            ),
        },
    };
    let meshed = if explicit {
        ""
    } else {
        random.pick(&["", "contact-mass = \"as-meshed\"\n", "mass = \"lumped\"\n"])
    };
    let count = random.whole(40, 90);
    let thrown = random.chance(0.6);
    let waves = if explicit { 3.0 } else { 8.0 };
    let duration = digits(waves * wave);
    let increments = match explicit {
        true => String::new(),
        false => format!(
            "increments = {{ initial = {0}, largest = {0} }}\n",
            digits(1.0 / count as f64)
        ),
    };
    let dynamic = format!("dynamic = {{ scheme.{scheme} }}\n")
        .replace(" }\n", &format!("{} }}\n", inline(meshed)));
    let speed = digits(scale.approach.min(0.01 * unit) / wave);
    let words = if thrown {
        let aside = if ring { 0.0 } else { 0.5 * speed };
        let _ = writeln!(
            text,
            "\n[initial.throw]\nset = \"upper\"\nvelocity = {}\n",
            point(!solid, [aside, 0.0, -speed])
        );
        let _ = writeln!(
            text,
            "[[step]]\nduration = {duration:e}\n{dynamic}{increments}"
        );
        "thrown"
    } else {
        let far = upper.far();
        let press = digits(scene.drive.press.min(0.01 * unit));
        let (down, across) = if solid { ("z", ", y = 0") } else { ("y", "") };
        let _ = writeln!(
            text,
            "press = {{ set = \"{far}\", {down} = {:e}, amplitude = \"press\" }}",
            -press
        );
        if !ring {
            let slide = digits(scale.slide.min(0.02 * unit));
            let _ = writeln!(
                text,
                "shake = {{ set = \"{far}\", x = {slide:e}{across}, amplitude = \"shake\" }}"
            );
        }
        let _ = writeln!(
            text,
            "\n[amplitude]\npress.table = [[0, 0], [1, 1], [{:e}, 1]]\nshake.table = [[0, 0], [1, 0], [{:e}, 1], [{:e}, -1], [{:e}, 0.5]]\n",
            1.0 + duration,
            1.0 + 0.25 * duration,
            1.0 + 0.6 * duration,
            1.0 + duration
        );
        let first = match explicit {
            true => String::new(),
            false => "[[step]]\nincrements.fixed = 4\n\n".to_string(),
        };
        // An analysis of explicit steps alone begins at rest and presses as it shakes.
        if explicit {
            text = text.replace(
                &format!("press.table = [[0, 0], [1, 1], [{:e}, 1]]", 1.0 + duration),
                &format!(
                    "press.table = [[0, 0], [{:e}, 1], [{duration:e}, 1]]",
                    0.5 * duration
                ),
            );
            let shake = format!(
                "shake.table = [[0, 0], [{:e}, 0], [{duration:e}, 1]]",
                0.5 * duration
            );
            let from = text.find("shake.table").unwrap_or(text.len());
            let to = text[from..].find('\n').map_or(text.len(), |n| from + n);
            text.replace_range(from..to, &shake);
        }
        let _ = writeln!(
            text,
            "{first}[[step]]\nduration = {duration:e}\n{dynamic}{increments}"
        );
        "pressed and shaken"
    };
    let text = text.replace("@DAMP", &format!("{:e}", digits(0.01 * wave)));
    let words = format!(
        "{}, {:?} {} on {}, {word}, {words}; {}{}",
        upper.space.name(),
        upper.form,
        upper.element,
        if floor {
            "a floor".to_string()
        } else {
            format!("{:?} {}", lower.form, lower.element)
        },
        laws.words,
        options.words
    );
    Draft {
        family: if explicit { "explicit" } else { "implicit" },
        words,
        text,
    }
}

/// A line as an entry of an inline table.
fn inline(line: &str) -> String {
    match line.trim() {
        "" => String::new(),
        entry => format!(", {entry}"),
    }
}

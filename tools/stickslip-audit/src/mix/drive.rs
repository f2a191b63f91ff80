//! Features of the way: what presses and slides the upper body.

use super::bodies::block;
use super::feature::{Feature, row};
use super::laws::{PRESSURE, alike};
use super::sheet::{Motion, Sheet, Step, number};
use super::structure::{ends, plain, tie};
use crate::draw::Random;

/// The rows.
pub const FEATURES: &[Feature] = &[
    row("path", "press-only", 2.0, &[], |s, r| {
        rest(s, r.whole(1, 4) as usize);
        s.amplitude("press", &[[0.0, 0.0], [1.0, 1.0]]);
        s.amplitude("slide", &[[0.0, 0.0], [1.0, 0.0]]);
    }),
    row(
        "path",
        "press-and-slide",
        4.0,
        &["plane-strain", "plane-stress", "solid"],
        |s, r| {
            rest(s, r.whole(1, 4) as usize);
            rest(s, 2 * r.whole(1, 3) as usize);
            s.amplitude("press", &[[0.0, 0.0], [1.0, 1.0]]);
            s.amplitude("slide", &[[1.0, 0.0], [2.0, 1.0]]);
        },
    ),
    row("path", "press-and-release", 1.0, &[], |s, r| {
        rest(s, r.whole(1, 4) as usize);
        rest(s, 2 * r.whole(1, 3) as usize);
        let left = r.pick(&[0.3, 0.0]);
        s.amplitude("press", &[[0.0, 0.0], [1.0, 1.0], [2.0, left]]);
        s.amplitude("slide", &[[0.0, 0.0], [1.0, 1.0]]);
    }),
    row("drive", "displaced", 3.0, &[], |s, _| {
        let (set, press) = (s.driven.clone(), s.press);
        s.support("press", &set, [None, None, Some(-press)], Some("press"));
        guide(s, &set, false);
    }),
    row("drive", "pressed", 3.0, &[], |s, r| {
        pressure(s, r);
        let set = s.driven.clone();
        guide(s, &set, false);
    }),
    row(
        "drive",
        "loose",
        1.5,
        &["coulomb", "static-kinetic"],
        |s, r| {
            let p = pressure(s, r);
            let push = s.vector([0.05 * p, 0.0], s.view.modulus);
            s.table(format!(
                "load.push = {{ set = \"{}\", traction.value = {push}, amplitude = \"press\" }}",
                s.driven
            ));
        },
    ),
    row("drive", "kinematic", 1.5, &[], |s, _| {
        head(s, "kinematic");
        let press = s.press;
        s.support("press", "head", [None, None, Some(-press)], Some("press"));
        guide(s, "head", true);
    }),
    row("drive", "kinematic-force", 1.0, &[], |s, r| {
        head(s, "kinematic");
        on_head(s, r);
        guide(s, "head", true);
    }),
    row("drive", "distributing-force", 1.0, &[], |s, r| {
        head(s, "distributing");
        on_head(s, r);
        let set = s.driven.clone();
        guide(s, &set, false);
    }),
    row("drive", "distributing-held", 0.7, &[], |s, _| {
        head(s, "distributing");
        let press = s.press;
        s.support("press", "head", [None, None, Some(-press)], Some("press"));
        guide(s, "head", true);
    }),
    row("drive", "weight", 1.0, &[], |s, r| {
        let height = ends(s, "upper").map_or(0.5, |e| e.1[1]);
        let unit = s.view.length / s.view.time().powi(2);
        let g = s.vector([0.0, -PRESSURE / height * r.spread(0.01, 1.0)], unit);
        s.table(format!(
            "load.weight = {{ set = \"upper\", gravity.acceleration = {g}, amplitude = \"press\" }}"
        ));
        let set = s.driven.clone();
        guide(s, &set, false);
    }),
    row(
        "drive",
        "jack",
        1.0,
        &["elastic", "rigid-lower", "floor"],
        |s, r| {
            let Some((from, to)) = ends(s, "upper") else {
                return;
            };
            let at = s.place([0.5 * (from[0] + to[0]), 0.5 * (from[1] + to[1])], 0.0);
            let normal = s.vector([0.0, 1.0], 1.0);
            s.table(format!(
            "pretension.jack = {{ of = \"upper\", plane = {{ point = {at}, normal = {normal} }} }}"
        ));
            let set = s.driven.clone();
            s.support("roof", &set, [None, None, Some(0.0)], None);
            guide(s, &set, false);
            let first = match r.chance(0.5) {
                true => format!(
                    "pretension.jack = {{ shortening = {} }}",
                    s.length(-s.press)
                ),
                false => {
                    let part = area(s, &[from, to]) * PRESSURE * r.between(0.3, 1.0);
                    format!("pretension.jack = {{ force = {} }}", scalar(s, -part))
                }
            };
            s.steps[0].keys.push(first);
            if let Some(second) = s.steps.get_mut(1) {
                second.keys.push("pretension.jack = { hold = true }".into());
            }
        },
    ),
    row(
        "drive",
        "bolt",
        1.0,
        &["coulomb", "static-kinetic"],
        |s, r| {
            // Bolts beside the upper body, one on each side unless half of it is there, draw a cap down onto it.
            let (Some((_, top)), Some(_)) = (ends(s, "upper"), ends(s, "lower")) else {
                return;
            };
            let half = s.half;
            let reach = |x: f64| if half { 0.0 } else { -x };
            if let Some(lower) = s.block("lower") {
                let size = (lower.to[0] - lower.from[0]) / lower.cells[0] as f64;
                (lower.from[0], lower.to[0]) = (reach(0.9), 0.9);
                lower.cells[0] = ((0.9 - reach(0.9)) / size).round() as usize;
            }
            block(
                s,
                r,
                "cap",
                [reach(0.85), top[1]],
                [0.85, top[1] + 0.3],
                1.0,
            );
            let keys = alike(s);
            s.joints
                .push(plain("second", "upper.top", "cap.bottom", keys));
            let part = 0.2 * PRESSURE * if s.solid() { s.depth } else { 1.0 };
            let force = scalar(s, part * r.between(0.3, 1.0));
            let young = r.spread(0.5, 5.0);
            let sides: &[(&'static str, &'static str, &'static str, f64)] = &[
                ("bolt", "bolt-foot", "bolt-head", 1.0),
                ("other", "other-foot", "other-head", -1.0),
            ];
            for (name, foot, on, side) in sides.iter().take(if half { 1 } else { 2 }) {
                let (a, b) = (0.65 * side, 0.8 * side);
                block(s, r, name, [a.min(b), 0.0], [a.max(b), top[1]], young);
                tie(s, foot, &format!("{name}.bottom"), "lower.top");
                tie(s, on, &format!("{name}.top"), "cap.bottom");
                let at = s.place([0.5 * (a + b), 0.5 * top[1]], 0.0);
                let normal = s.vector([0.0, 1.0], 1.0);
                s.table(format!(
                "pretension.{name} = {{ of = \"{name}\", plane = {{ point = {at}, normal = {normal} }} }}"
            ));
                s.steps[0]
                    .keys
                    .push(format!("pretension.{name} = {{ force = {force} }}"));
                if let Some(second) = s.steps.get_mut(1) {
                    second
                        .keys
                        .push(format!("pretension.{name} = {{ hold = true }}"));
                }
            }
        },
    ),
    row("ending", "no-more", 5.0, &[], |_, _| {}),
    row("ending", "modes", 1.5, &[], |s, _| {
        modes(s, "modes = { count = 4 }")
    }),
    row("ending", "complex-modes", 1.0, &["coulomb"], |s, _| {
        if !s.half {
            let unit = s.view.length / s.view.time();
            let velocity = s.vector([0.01, 0.0], unit);
            rest(s, 2);
            let keys = &mut s.steps.last_mut().map(|step| &mut step.keys);
            if let Some(keys) = keys {
                keys.push(format!("steady.velocity.joint = {velocity}"));
            }
        }
        modes(s, "complex-modes = { count = 4 }");
    }),
    row("ending", "implicit", 1.5, &[], |s, _| {
        moving(s, 0.5, 8, "dynamic = {}")
    }),
    row("ending", "explicit", 1.5, &[], |s, _| explicit(s)),
    row("ending", "implicit-explicit", 1.0, &[], |s, _| {
        moving(s, 0.5, 8, "dynamic = {}");
        explicit(s);
    }),
    row("ending", "cycles", 1.5, &["press-only"], |s, r| {
        s.amplitudes.retain(|a| a.0 != "slide");
        s.amplitude(
            "slide",
            &[[1.0, 0.0], [1.25, 1.0], [1.75, -1.0], [2.0, 0.0]],
        );
        let jump = r.pick(&["", ", jump = 2"]);
        step(
            s,
            1.0,
            8,
            Motion::Rest,
            format!("cycles = {{ count = 4{jump} }}"),
        );
    }),
    row(
        "ending",
        "let-go",
        0.7,
        &["coulomb", "static-kinetic"],
        |s, _| {
            let stay = s.supports.iter().filter(|x| x.name != "guide");
            let names: Vec<String> = stay.map(|x| format!("\"{}\"", x.name)).collect();
            step(
                s,
                1.0,
                2,
                Motion::Rest,
                format!("supports = [{}]", names.join(", ")),
            );
        },
    ),
];

/// A force along the direction of pressing as a number.
pub fn scalar(s: &Sheet, part: f64) -> String {
    number(part * s.force_unit())
}

/// The area of the section of a body.
fn area(s: &Sheet, [from, to]: &[[f64; 2]; 2]) -> f64 {
    match s.space {
        super::sheet::Space::Ring => std::f64::consts::PI * (to[0] * to[0] - from[0] * from[0]),
        super::sheet::Space::Solid => (to[0] - from[0]) * s.depth,
        _ => to[0] - from[0],
    }
}

/// Adds a step.
fn step(s: &mut Sheet, duration: f64, increments: usize, motion: Motion, key: String) {
    s.steps.push(Step {
        duration,
        increments,
        motion,
        keys: if key.is_empty() { vec![] } else { vec![key] },
    });
}

fn rest(s: &mut Sheet, increments: usize) {
    step(s, 1.0, increments, Motion::Rest, String::new());
}

fn modes(s: &mut Sheet, key: &str) {
    step(s, 1.0, 0, Motion::Modes, key.into());
}

/// A step with inertia, in which a load comes at once.
fn moving(s: &mut Sheet, duration: f64, increments: usize, key: &str) {
    if !s.amplitudes.iter().any(|a| a.0 == "kick") {
        let start = s.end();
        s.amplitude("kick", &[[start, 0.0], [start + 0.1 * duration, 1.0]]);
        let kick = s.vector([0.1 * PRESSURE, -0.2 * PRESSURE], s.view.modulus);
        let right = s.right();
        s.table(format!(
            "load.kick = {{ set = \"upper.{right}\", traction.value = {kick}, amplitude = \"kick\" }}"
        ));
    }
    step(s, duration, increments, Motion::Moving, key.into());
}

fn explicit(s: &mut Sheet) {
    let stiffest = s.blocks.iter().map(|b| b.young).fold(1.0, f64::max);
    let finest = s
        .blocks
        .iter()
        .map(|b| (b.to[0] - b.from[0]) / b.cells[0] as f64)
        .fold(1.0, f64::min);
    moving(
        s,
        20.0 * finest / stiffest.sqrt(),
        0,
        "dynamic.scheme.central-difference = {}",
    );
}

/// Pressure on the driven set, which is returned.
fn pressure(s: &mut Sheet, r: &mut Random) -> f64 {
    let size = PRESSURE * r.spread(0.1, 1.0);
    let p = s.stress(size);
    s.table(format!(
        "load.press = {{ set = \"{}\", pressure.value = {p}, amplitude = \"press\" }}",
        s.driven
    ));
    size
}

/// Slides a set, and holds it across.
fn guide(s: &mut Sheet, set: &str, upright: bool) {
    let x = match (s.half, s.has("clamp")) {
        (true, _) if upright => Some(0.0),
        (true, _) | (_, true) => None,
        _ => Some(s.slide),
    };
    let x = if s.space == super::sheet::Space::Ring {
        None
    } else {
        x
    };
    if x.is_none() && !s.solid() && !upright || s.space == super::sheet::Space::Ring {
        return;
    }
    let moves = x.is_some_and(|x| x != 0.0) && (!s.has("press-only") || s.has("cycles"));
    match moves {
        true => s.support("guide", set, [x, Some(0.0), None], Some("slide")),
        false => s.support("guide", set, [x.map(|_| 0.0), Some(0.0), None], None),
    }
    if let Some(guide) = s.supports.last_mut() {
        guide.upright = upright;
    }
}

/// A reference point on the driven set, and what binds the two.
fn head(s: &mut Sheet, how: &str) {
    let body = s.driven.split('.').next().unwrap_or("upper").to_string();
    let Some((from, to)) = ends(s, &body) else {
        return;
    };
    let x = if s.half { 0.0 } else { 0.5 * (from[0] + to[0]) };
    let at = s.place([x, to[1]], 0.0);
    let mut keys = format!("point = {at}");
    if s.has("explicit") || s.has("implicit-explicit") {
        let solid = s.solid();
        let mass = 0.2 * s.mass_unit();
        let turns = number(0.05 * mass * s.view.length * s.view.length);
        let turns = if solid {
            format!("{turns}, {turns}, {turns}")
        } else {
            turns
        };
        keys = format!("{keys}, mass = {}", number(mass));
        if s.space != super::sheet::Space::Ring {
            keys = format!("{keys}, inertia = [{turns}]");
        }
    }
    s.table(format!("reference.head = {{ {keys} }}"));
    s.table(format!(
        "coupling.head.{how} = {{ reference = \"head\", set = \"{}\" }}",
        s.driven
    ));
}

/// A force on the reference point.
fn on_head(s: &mut Sheet, r: &mut Random) {
    let Some((from, to)) = ends(s, "upper") else {
        return;
    };
    let part = area(s, &[from, to]) * PRESSURE * r.spread(0.1, 1.0);
    let force = s.force([0.0, -part]);
    s.table(format!(
        "load.press = {{ set = \"head\", nodal-force.value = {force}, amplitude = \"press\" }}"
    ));
}

//! Features of the structure: bodies besides the two, and what holds their sides.

use super::bodies::{block, floor};
use super::feature::{Feature, row};
use super::laws::alike;
use super::sheet::{Joint, Sheet};

/// The rows.
pub const FEATURES: &[Feature] = &[
    row("", "tied-cap", 1.0, &[], |s, r| {
        let Some((from, to)) = ends(s, "upper") else {
            return;
        };
        let wide = r.pick(&[0.8, 1.0]) * to[0];
        let low = if s.half { 0.0 } else { from[0] };
        block(s, r, "cap", [low, to[1]], [wide, to[1] + 0.2], 1.0);
        tie(s, "cap-tie", "cap.bottom", "upper.top");
        s.driven = "cap.top".into();
    }),
    row("", "tied-foot", 1.0, &["elastic", "rigid-upper"], |s, r| {
        let Some((from, to)) = ends(s, "lower") else {
            return;
        };
        let young = r.spread(0.1, 10.0);
        block(
            s,
            r,
            "foot",
            [from[0], from[1] - 0.3],
            [to[0], from[1]],
            young,
        );
        tie(s, "foot-tie", "lower.bottom", "foot.top");
        s.held = "foot.bottom".into();
    }),
    row(
        "",
        "third-body",
        0.8,
        &["coulomb", "static-kinetic"],
        |s, r| {
            let Some((from, to)) = ends(s, "upper") else {
                return;
            };
            let low = if s.half { 0.0 } else { from[0] - 0.05 };
            block(s, r, "cap", [low, to[1]], [to[0] + 0.1, to[1] + 0.2], 1.0);
            let keys = alike(s);
            s.joints
                .push(plain("second", "upper.top", "cap.bottom", keys));
            s.driven = "cap.top".into();
        },
    ),
    row("", "side-body", 1.0, &["flush"], |s, r| {
        let Some((_, top)) = ends(s, "upper") else {
            return;
        };
        let low = ends(s, "lower").map_or(0.0, |e| e.0[1]);
        block(
            s,
            r,
            "side",
            [top[0], low],
            [top[0] + 0.3, 0.8 * top[1]],
            1.0,
        );
        let (left, right, keys) = (s.left(), s.right(), alike(s));
        for (name, body) in [("side-low", "lower"), ("side-up", "upper")] {
            if ends(s, body).is_some() {
                let (own, other) = (format!("{body}.{right}"), format!("side.{left}"));
                s.joints.push(plain(name, &own, &other, keys.clone()));
            }
        }
        let push = -r.between(0.0003, 0.002);
        s.support(
            "side",
            &format!("side.{right}"),
            [Some(push), Some(0.0), Some(0.0)],
            Some("press"),
        );
    }),
    row(
        "",
        "wall",
        1.0,
        &["plane-strain", "plane-stress", "solid"],
        |s, _| {
            let Some((_, to)) = ends(s, "upper") else {
                return;
            };
            floor(s, "wall", [to[0], 0.0], [-1.0, 0.0]);
            let (own, keys) = (format!("upper.{}", s.right()), alike(s));
            let mut joint = plain("wall", &own, "wall", keys);
            joint.obstacle = true;
            s.joints.push(joint);
        },
    ),
    row(
        "",
        "clamp",
        1.5,
        &["plane-strain", "plane-stress", "solid"],
        |s, r| {
            // Both bodies are clamped at the same end, the lower one perhaps nowhere else.
            let right = s.right();
            for (name, body) in [("clamp-lower", "lower"), ("clamp-upper", "upper")] {
                if ends(s, body).is_some() {
                    s.support(name, &format!("{body}.{right}"), [Some(0.0); 3], None);
                }
            }
            s.slide = 0.0;
            if r.chance(0.5) && ends(s, "lower").is_some() {
                s.held = String::new();
            }
        },
    ),
    row(
        "",
        "periodic",
        1.0,
        &["plane-strain", "plane-stress"],
        |s, _| {
            for body in ["lower", "upper"] {
                if ends(s, body).is_none()
                    || s.has("inside")
                    || s.has("rigid-upper") && body == "upper"
                {
                    continue;
                }
                for axis in ["x", "y"] {
                    s.table(format!(
                    "coupling.{body}-{axis}.equation.terms = [{{ set = \"{body}.left\", component = \"{axis}\" }}, {{ set = \"{body}.right\", component = \"{axis}\", factor = -1 }}]"
                ));
                }
            }
        },
    ),
    row(
        "",
        "kept-level",
        1.0,
        &["pressed", "loose", "weight", "distributing-force"],
        |s, _| {
            let Some((from, to)) = ends(s, "upper") else {
                return;
            };
            let (at, down) = (s.place([from[0], to[1]], -0.5), s.down());
            s.table(format!("set.corner = {{ of = \"upper\", point = {at} }}"));
            s.table(format!(
            "coupling.level.equation.terms = [{{ set = \"upper.top\", component = \"{down}\" }}, {{ set = \"corner\", component = \"{down}\", factor = -1 }}]"
        ));
        },
    ),
];

/// Where a body begins and ends.
pub fn ends(s: &Sheet, name: &str) -> Option<([f64; 2], [f64; 2])> {
    let block = s.blocks.iter().find(|b| b.name == name)?;
    Some((block.from, block.to))
}

/// An interface without a tie.
pub fn plain(name: &'static str, secondary: &str, primary: &str, keys: Vec<String>) -> Joint {
    Joint {
        name,
        secondary: secondary.into(),
        primary: primary.into(),
        obstacle: false,
        tied: false,
        keys,
    }
}

/// Glues two surfaces together.
pub fn tie(s: &mut Sheet, name: &'static str, secondary: &str, primary: &str) {
    let mut joint = plain(name, secondary, primary, Vec::new());
    joint.tied = true;
    s.joints.push(joint);
}

/// Cuts the lower body between two layers of cells, whose sides a tie joins again.
pub fn cut(s: &mut Sheet) {
    let Some(lower) = s.block("lower").filter(|b| b.cells[1] > 1) else {
        return;
    };
    let mut under = lower.clone();
    let beneath = lower.cells[1] / 2;
    let middle =
        lower.from[1] + (lower.to[1] - lower.from[1]) * beneath as f64 / lower.cells[1] as f64;
    lower.from[1] = middle;
    lower.cells[1] -= beneath;
    under.name = "under";
    under.to[1] = middle;
    under.cells[1] = beneath;
    s.blocks.push(under);
    tie(s, "cut", "lower.bottom", "under.top");
    s.held = "under.bottom".into();
}

/// What holds the lower body, and the cuts of symmetry.
pub fn hold(s: &mut Sheet) {
    if ends(s, "lower").is_some() && !s.held.is_empty() {
        let x = if s.half { None } else { Some(0.0) };
        let set = s.held.clone();
        s.support("base", &set, [x, Some(0.0), Some(0.0)], None);
    }
    if s.half {
        let names: Vec<&'static str> = s
            .blocks
            .iter()
            .filter(|b| b.from[0] == 0.0)
            .map(|b| b.name)
            .collect();
        let left = s.left();
        for name in names {
            let label = match name {
                "lower" => "axis-lower",
                "upper" => "axis-upper",
                "cap" => "axis-cap",
                "under" => "axis-under",
                _ => "axis-foot",
            };
            s.support(
                label,
                &format!("{name}.{left}"),
                [Some(0.0), None, None],
                None,
            );
        }
    }
}

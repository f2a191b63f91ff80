//! Features of bodies: where they live, how they are meshed, what they are made of, how they lie on each other.

use super::feature::{Feature, nothing, row};
use super::sheet::{Block, Joint, Sheet, Space};
use crate::draw::Random;

/// The rows, in the order in which they add to a sheet.
pub const FEATURES: &[Feature] = &[
    row("space", "plane-strain", 3.0, &[], |s, _| {
        s.space = Space::Strain
    }),
    row("space", "plane-stress", 2.0, &[], |s, _| {
        s.space = Space::Stress
    }),
    row("space", "axisymmetric", 2.0, &[], |s, _| {
        s.space = Space::Ring;
        s.half = true;
    }),
    row("space", "solid", 3.0, &[], |s, _| s.space = Space::Solid),
    row(
        "",
        "symmetry",
        1.0,
        &["plane-strain", "plane-stress", "solid"],
        |s, _| s.half = true,
    ),
    // Who touches whom.
    row("bodies", "elastic", 6.0, &[], |s, r| {
        lower(s, r);
        upper(s, r);
        joint(s, "lower.top");
    }),
    row(
        "bodies",
        "rigid-upper",
        1.0,
        &["loose", "kinematic", "kinematic-force"],
        |s, r| {
            lower(s, r);
            upper(s, r);
            joint(s, "lower.top");
            rigid(s, "upper");
        },
    ),
    row("bodies", "rigid-lower", 1.0, &[], |s, r| {
        lower(s, r);
        upper(s, r);
        joint(s, "lower.top");
        rigid(s, "lower");
    }),
    row("bodies", "floor", 1.0, &[], |s, r| {
        upper(s, r);
        floor(s, "floor", [0.0, 0.0], [0.0, 1.0]);
        joint(s, "floor");
        s.joints[0].obstacle = true;
    }),
    // How the upper one lies on the lower.
    row("ends", "inside", 2.0, &[], |s, _| width(s, [-0.3, 0.3])),
    row("ends", "flush", 3.0, &[], |s, _| width(s, [-0.5, 0.5])),
    row(
        "ends",
        "overhang",
        1.5,
        &["elastic", "rigid-upper", "rigid-lower"],
        |s, r| {
            width(s, [-0.2, r.between(0.51, 0.8)]);
        },
    ),
    row(
        "ends",
        "wider",
        1.0,
        &["elastic", "rigid-upper", "rigid-lower"],
        |s, r| {
            let reach = r.between(0.51, 0.7);
            width(s, [-reach, reach]);
        },
    ),
    row("mesh", "linear", 4.0, &[], nothing),
    row("mesh", "quadratic", 2.0, &[], |s, _| {
        s.blocks.iter_mut().for_each(|b| b.quadratic = true);
        fewer(s);
    }),
    row("mesh", "simplices", 1.5, &[], |s, _| {
        s.blocks.iter_mut().for_each(|b| b.simplex = true)
    }),
    row("mesh", "quadratic-simplices", 1.0, &[], |s, _| {
        for block in &mut s.blocks {
            (block.simplex, block.quadratic) = (true, true);
        }
        fewer(s);
    }),
    row("mesh", "mixed", 2.0, &["elastic"], |s, r| {
        if let Some(upper) = s.block("upper") {
            upper.simplex = r.chance(0.5);
            upper.quadratic = r.chance(0.5);
        }
        if let Some(lower) = s.block("lower") {
            lower.simplex = r.chance(0.3);
            lower.quadratic = r.chance(0.3);
        }
        fewer(s);
    }),
    row("match", "matching", 1.0, &["flush"], |s, _| {
        meet(s, 0);
    }),
    row("match", "not-matching", 2.0, &[], |s, r| {
        let more = r.whole(1, 3) as usize;
        meet(s, more);
    }),
    row(
        "",
        "mean-dilatation",
        0.5,
        &["plane-strain", "axisymmetric", "solid"],
        |s, _| {
            keys(s, "formulation = \"mean-dilatation\"");
        },
    ),
    row("", "incompatible-modes", 0.5, &["linear"], |s, _| {
        keys(s, "formulation = \"incompatible-modes\"")
    }),
    row("", "mesh-in-other-units", 0.5, &[], |s, _| {
        if let Some(upper) = s.block("upper") {
            upper.scale = 1e-3;
        }
    }),
    row("", "orthotropic", 0.5, &["elastic"], |s, _| {
        let e = |x: f64| s.stress(x);
        let line = format!(
            "orthotropic = {{ e1 = {}, e2 = {}, e3 = {}, nu12 = 0.25, nu13 = 0.2, nu23 = 0.3, g12 = {}, g13 = {}, g23 = {}, density = {} }}",
            e(1.0),
            e(0.6),
            e(1.4),
            e(0.3),
            e(0.5),
            e(0.4),
            super::sheet::number(s.view.density)
        );
        if let Some(lower) = s.block("lower") {
            lower.material = Some(line);
        }
    }),
];

/// A body that others lie on.
fn lower(s: &mut Sheet, r: &mut Random) {
    let left = if s.half { 0.0 } else { -0.5 };
    let height = r.between(0.3, 0.6);
    block(s, r, "lower", [left, -height], [0.5, 0.0], 1.0);
}

fn upper(s: &mut Sheet, r: &mut Random) {
    let left = if s.half { 0.0 } else { -0.5 };
    let height = r.between(0.3, 0.6);
    let mut young = r.spread(0.5, 20.0);
    if r.chance(0.2) {
        young = r.spread(1.0, 1e3);
    }
    block(s, r, "upper", [left, 0.0], [0.5, height], young);
}

/// Adds a block with cells of about the same size.
pub fn block(
    s: &mut Sheet,
    r: &mut Random,
    name: &'static str,
    from: [f64; 2],
    to: [f64; 2],
    young: f64,
) {
    let finest = if s.solid() { 4.0 } else { 8.0 };
    let across = r.between(0.6 * finest, finest);
    let count = |length: f64, most: f64| (length * across).round().clamp(1.0, most) as usize;
    let cells = [
        count(to[0] - from[0], 12.0),
        count(to[1] - from[1], 6.0).max(2),
    ];
    s.blocks.push(Block {
        name,
        from,
        to,
        cells,
        deep: 2,
        young,
        poisson: r.between(0.0, 0.45),
        expansion: 0.0,
        simplex: false,
        quadratic: false,
        keys: Vec::new(),
        scale: 1.0,
        material: None,
    });
}

fn joint(s: &mut Sheet, primary: &str) {
    s.joints.push(Joint {
        name: "joint",
        secondary: "upper.bottom".into(),
        primary: primary.into(),
        obstacle: false,
        tied: false,
        keys: Vec::new(),
    });
}

/// An obstacle: a plane with its normal.
pub fn floor(s: &mut Sheet, name: &str, at: [f64; 2], normal: [f64; 2]) {
    let (at, normal) = (s.place(at, 0.0), s.vector(normal, 1.0));
    s.table(format!(
        "obstacle.{name}.plane = {{ point = {at}, normal = {normal} }}"
    ));
}

fn rigid(s: &mut Sheet, name: &str) {
    if let Some(block) = s.block(name) {
        block.keys.push("rigid = true".into());
    }
}

fn keys(s: &mut Sheet, key: &str) {
    for block in s
        .blocks
        .iter_mut()
        .filter(|b| !b.quadratic && !b.simplex && b.keys.is_empty())
    {
        block.keys.push(key.to_string());
    }
}

/// The upper body from one x to another; its cells keep their size.
fn width(s: &mut Sheet, [from, to]: [f64; 2]) {
    let half = s.half;
    if let Some(upper) = s.block("upper") {
        let size = (upper.to[0] - upper.from[0]) / upper.cells[0] as f64;
        upper.from[0] = if half { 0.0 } else { from };
        upper.to[0] = to;
        upper.cells[0] = ((upper.to[0] - upper.from[0]) / size).round().max(2.0) as usize;
    }
}

/// Quadratic cells are larger.
fn fewer(s: &mut Sheet) {
    for block in s.blocks.iter_mut().filter(|b| b.quadratic) {
        block.cells = block.cells.map(|n| n.div_ceil(2).max(2));
    }
}

/// Cells of the upper body as those of the lower one beneath, or so many more. The other mesh of a view is the other of the two.
fn meet(s: &mut Sheet, more: usize) {
    let Some(lower) = s.block("lower").map(|b| {
        (
            (b.to[0] - b.from[0]) / b.cells[0] as f64,
            b.quadratic,
            b.simplex,
        )
    }) else {
        if let Some(upper) = s.view.remeshed.then(|| s.block("upper")).flatten() {
            upper.cells[0] += 1;
        }
        return;
    };
    let remeshed = s.view.remeshed;
    let linear = s.has("linear") || s.has("simplices");
    if let Some(upper) = s.block("upper") {
        let alike = ((upper.to[0] - upper.from[0]) / lower.0).round().max(1.0) as usize;
        upper.cells[0] = match (more, remeshed) {
            (0, false) => alike,
            (0, true) => alike + if linear { 2 } else { 1 },
            (more, false) => alike + more,
            (_, true) => alike,
        };
    }
}

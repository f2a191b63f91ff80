//! Features that come on top: heat, springs, masses, bodies that turn, more output, ways to solve.

use super::feature::{Feature, nothing, row};
use super::laws::PRESSURE;
use super::sheet::{Sheet, number};
use super::structure::ends;
use crate::draw::Random;

/// The rows.
pub const FEATURES: &[Feature] = &[
    row(
        "",
        "heated-upper",
        1.0,
        &["elastic", "rigid-lower", "floor"],
        |s, r| heat(s, r, "upper"),
    ),
    row(
        "",
        "heated-lower",
        0.7,
        &["elastic", "rigid-upper"],
        |s, r| heat(s, r, "lower"),
    ),
    row("", "bed-of-springs", 0.7, &[], |s, r| {
        let k = stiffness(s, r.spread(1e-3, 1.0));
        let values = if s.solid() {
            format!("[{k}, {k}, {k}]")
        } else {
            format!("[{k}, {k}]")
        };
        let right = s.right();
        s.table(format!(
            "load.bed = {{ set = \"upper.{right}\", spring.stiffness = {values} }}"
        ));
    }),
    row("", "spring-across", 0.7, &["elastic"], |s, r| {
        let k = stiffness(s, r.spread(1e-3, 10.0));
        s.table(format!(
            "coupling.across.spring = {{ {}, stiffness = {k} }}",
            across(s)
        ));
    }),
    row("", "stop-across", 0.7, &["loose"], |s, r| {
        let gap = s.length(r.between(0.0, 0.002));
        s.table(format!(
            "coupling.across.gap = {{ {}, clearance = {gap} }}",
            across(s)
        ));
    }),
    row(
        "",
        "dashpot-across",
        0.7,
        &["implicit", "explicit", "complex-modes"],
        |s, _| {
            let c = number(0.05 * s.force_unit() / s.view.length * s.view.time());
            s.table(format!(
                "coupling.across.dashpot = {{ {}, coefficient = {c} }}",
                across(s)
            ));
        },
    ),
    row(
        "",
        "rayleigh",
        0.7,
        &["implicit", "explicit", "complex-modes"],
        |s, _| {
            let (mass, stiffness) = (number(0.1 / s.view.time()), number(1e-3 * s.view.time()));
            if let Some(upper) = s.block("upper") {
                upper.keys.push(format!(
                    "rayleigh = {{ mass = {mass}, stiffness = {stiffness} }}"
                ));
            }
        },
    ),
    row(
        "",
        "point-mass",
        0.7,
        &["modes", "implicit", "explicit", "complex-modes"],
        |s, _| {
            let mass = number(0.05 * s.mass_unit());
            let set = corner(s, "upper", true);
            s.table(format!("mass.extra = {{ set = \"{set}\", mass = {mass} }}"));
        },
    ),
    row(
        "",
        "turning",
        1.0,
        &["plane-strain", "plane-stress"],
        |s, r| {
            let at = s.place([0.0, 0.0], 0.0);
            let angle = number(s.view.x() * r.between(0.1, 1.5));
            let factor = if s.view.unturned { 0 } else { 1 };
            for block in &mut s.blocks {
                block.keys.push("rotation.with = \"axle\"".into());
            }
            s.amplitude("turn", &[[0.0, 0.0], [1.0, f64::from(factor)]]);
            s.table(format!(
            "reference.axle.point = {at}\nsupport.axle = {{ set = \"axle\", x = 0, y = 0 }}\nsupport.turn = {{ set = \"axle\", rotation-z = {angle}, amplitude = \"turn\" }}"
        ));
        },
    ),
    row("", "side-load", 0.7, &[], |s, r| {
        let size = r.between(-0.1, 0.1) * PRESSURE;
        // A light body would be lifted off by a push upwards.
        let size = if s.has("weight") { size.abs() } else { size };
        let load = s.vector([size, -0.5 * size], s.view.modulus);
        let right = s.right();
        s.table(format!(
            "load.side = {{ set = \"upper.{right}\", traction.value = {load}, amplitude = \"press\" }}"
        ));
    }),
    row(
        "",
        "centrifugal",
        0.4,
        &["plane-strain", "axisymmetric"],
        |s, _| {
            let speed = number(0.05 / s.view.time());
            // About a point below it the upper body would be thrown off the lower one where little presses it.
            let top = ends(s, "upper").map_or(0.0, |e| e.1[1]);
            let point = s.place([0.0, top], 0.0);
            let point = if s.space == super::sheet::Space::Ring {
                String::new()
            } else {
                format!(", point = {point}")
            };
            s.table(format!(
            "load.whirl = {{ set = \"upper\", centrifugal = {{ speed = {speed}{point} }}, amplitude = \"press\" }}"
        ));
        },
    ),
    row(
        "",
        "other-friction-later",
        0.7,
        &["press-and-slide", "press-and-release"],
        |s, r| {
            let mu = r.between(0.05, 0.5);
            // Friction has to hold an unconstrained body as it did, against a push of a twentieth of what presses it.
            let mu = if s.has("loose") { mu.max(0.1) } else { mu };
            s.steps[1].keys.push(format!(
                "change.joint = {{ friction.coulomb = {{ mu = {mu} }} }}"
            ));
        },
    ),
    row("", "text-frd", 0.3, &[], |s, _| {
        s.table("output.frd = \"text\"".into())
    }),
    row("", "fatigue", 0.4, &["cycles"], |s, _| {
        s.table("output.fatigue.criteria = [{ findley = { k = 0.3 } }, { ruiz = {} }, { smith-watson-topper = {} }]".into());
    }),
    row("method", "automatic", 2.0, &[], nothing),
    row("method", "condensed", 2.0, &[], |s, _| {
        s.solver.push("method = \"condensed\"".into())
    }),
    row("method", "sparse", 2.0, &[], |s, _| {
        s.solver.push("method = \"sparse\"".into())
    }),
    row("method", "multigrid", 0.7, &[], |s, _| {
        s.solver.push("method = \"multigrid\"".into())
    }),
];

/// A stiffness.
fn stiffness(s: &Sheet, part: f64) -> String {
    number(part * s.force_unit() / s.view.length)
}

/// A corner of a body: the upper one on the right, or the lower one on the right.
fn corner(s: &Sheet, body: &str, top: bool) -> String {
    let end = if top { "top" } else { "bottom" };
    match s.solid() {
        true => format!("{body}.{end}-front-{}", s.right()),
        false => format!("{body}.{end}-{}", s.right()),
    }
}

/// The opening between two corners, along x.
fn across(s: &Sheet) -> String {
    let (a, b) = (corner(s, "upper", true), corner(s, "lower", false));
    let sign = s.view.x();
    format!(
        "terms = [{{ set = \"{a}\", component = \"x\", factor = {sign} }}, {{ set = \"{b}\", component = \"x\", factor = {} }}]",
        -sign
    )
}

/// A temperature that makes a body grow by about a thousandth.
fn heat(s: &mut Sheet, r: &mut Random, body: &'static str) {
    let strain = r.between(-0.001, 0.002);
    let set = match body {
        "lower" if s.blocks.iter().any(|b| b.name == "under") => vec!["lower", "under"],
        body => vec![body],
    };
    for name in set {
        if let Some(block) = s.block(name) {
            block.expansion = strain / 50.0;
        }
        s.table(format!(
            "temperature.{name} = {{ set = \"{name}\", uniform.value = 50, amplitude = \"press\" }}"
        ));
    }
}

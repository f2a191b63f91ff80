//! Features of the interface: laws, and how they are enforced.

use super::feature::{Feature, nothing, row};
use super::sheet::{Sheet, number};

/// A pressure as it will be.
pub const PRESSURE: f64 = 0.005;

/// The rows.
pub const FEATURES: &[Feature] = &[
    row("normal", "unilateral", 5.0, &[], nothing),
    row("normal", "linear-law", 1.0, &[], |s, r| {
        let yields = r.spread(1e-5, 1e-3);
        let c = s.view.modulus / s.view.length * PRESSURE / yields;
        key(s, format!("normal.linear = {{ c = {} }}", number(c)));
    }),
    row("normal", "power-law", 1.0, &[], |s, r| {
        let (yields, m) = (r.spread(1e-5, 1e-3), r.between(1.2, 3.0));
        let c = s.view.modulus * PRESSURE / (yields * s.view.length).powf(m);
        key(
            s,
            format!("normal.power-law = {{ c = {}, m = {m} }}", number(c)),
        );
    }),
    row("normal", "exponential", 0.5, &[], |s, r| {
        let c0 = s.length(r.spread(1e-5, 1e-3));
        let p0 = s.stress(PRESSURE * r.spread(0.01, 1.0));
        key(
            s,
            format!("normal.exponential = {{ p0 = {p0}, c0 = {c0} }}"),
        );
    }),
    row("friction", "no-friction", 2.0, &[], nothing),
    row("friction", "coulomb", 5.0, &[], |s, r| {
        let mu = r.between(0.1, 0.8);
        key(s, format!("friction.coulomb = {{ mu = {mu} }}"));
    }),
    row("friction", "static-kinetic", 1.0, &[], |s, r| {
        let mu = r.between(0.1, 0.6);
        key(
            s,
            format!(
                "friction.static-kinetic = {{ static = {mu}, kinetic = {} }}",
                number(0.75 * mu)
            ),
        );
    }),
    row("friction", "capped", 1.0, &[], |s, r| {
        let mu = r.between(0.1, 0.8);
        let cap = s.stress(0.7 * mu * PRESSURE);
        key(
            s,
            format!("friction.coulomb = {{ mu = {mu}, cap = {cap} }}"),
        );
    }),
    row("enforcement", "augmented", 4.0, &[], nothing),
    row("enforcement", "perturbed", 1.0, &[], |s, _| {
        key(s, "enforcement.perturbed-lagrangian = {}".into())
    }),
    row("enforcement", "penalty", 1.0, &[], |s, _| {
        key(s, "enforcement.penalty = {}".into())
    }),
    row("discretisation", "mortar", 3.0, &[], nothing),
    row("discretisation", "node-to-facet", 1.0, &[], |s, _| {
        if !s.has("floor") {
            key(s, "discretisation.node-to-facet = {}".into());
        }
    }),
    row("roles", "by-mesh", 1.0, &[], nothing),
    row("roles", "as-named", 2.0, &[], |s, _| {
        key(s, "roles = \"as-named\"".into())
    }),
    row("", "small-sliding", 0.7, &[], |s, _| {
        key(s, "kinematics.small-sliding = {}".into())
    }),
    row(
        "",
        "regularised",
        0.5,
        &["coulomb", "static-kinetic", "capped"],
        |s, r| {
            let epsilon = 0.003 * r.spread(0.01, 0.3) * s.view.length / s.view.time();
            key(
                s,
                format!("slip.regularised = {{ epsilon = {} }}", number(epsilon)),
            );
        },
    ),
    row("", "two-sided", 0.5, &["penalty"], |s, _| {
        key(s, "discretisation.mortar = { two-sided = true }".into())
    }),
    row("", "roughness", 0.7, &[], |s, r| {
        let height = s.length(r.spread(1e-5, 5e-4));
        let wave = s.length(r.between(0.5, 1.0));
        key(
            s,
            format!("roughness.wave = {{ amplitude = {height}, wavelength = [{wave}] }}"),
        );
    }),
    row(
        "",
        "belt",
        0.7,
        &["coulomb", "static-kinetic", "capped"],
        |s, _| {
            let unit = 0.002 * s.view.length / s.view.time();
            let velocity = s.vector([1.0, 0.0], unit);
            key(s, format!("primary-velocity = {velocity}"));
        },
    ),
    row(
        "",
        "damped-contact",
        0.5,
        &["implicit", "explicit", "implicit-explicit"],
        |s, _| {
            let c = 0.05 * s.view.modulus * s.view.time() / s.view.length;
            key(
                s,
                format!("damping.viscous = {{ coefficient = {} }}", number(c)),
            );
        },
    ),
    row("", "gap-taken-away", 0.7, &[], |s, r| {
        let gap = r.between(-0.002, 0.003);
        if let Some(upper) = s.block("upper") {
            upper.from[1] += gap;
            upper.to[1] += gap;
        }
        key(s, "initial = \"offset\"".into());
    }),
    row("", "interference", 0.5, &["elastic", "floor"], |s, r| {
        let overlap = r.between(0.0003, 0.002);
        if let Some(upper) = s.block("upper") {
            upper.from[1] -= overlap;
            upper.to[1] -= overlap;
        }
        key(s, "initial = \"ramp\"".into());
    }),
    row("", "wears", 0.8, &["cycles"], |s, r| {
        let rate = r.between(0.3, 3.0) / s.view.modulus;
        let other = if r.chance(0.5) { rate } else { 0.0 };
        key(
            s,
            format!(
                "wear.archard = {{ coefficient = {}, primary-coefficient = {} }}",
                number(rate),
                number(other)
            ),
        );
    }),
];

fn key(s: &mut Sheet, key: String) {
    s.joints[0].keys.push(key);
}

/// What the first interface says of laws and their enforcement, for others that are like it.
pub fn alike(s: &Sheet) -> Vec<String> {
    let shared = ["normal", "friction", "enforcement", "slip"];
    let keys = s.joints[0].keys.iter();
    keys.filter(|k| shared.iter().any(|name| k.starts_with(name)))
        .cloned()
        .collect()
}

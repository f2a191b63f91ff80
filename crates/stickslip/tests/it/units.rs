//! A problem in metres, kilograms and seconds and the same in millimetres, tonnes and seconds take the same way to the same answer.

use crate::support;
use support::Record;

/// Units of length and stress, as multiples of the metre and the pascal of the numbers in the texts below.
#[derive(Clone, Copy)]
struct Units {
    length: f64,
    stress: f64,
}

const SI: Units = Units {
    length: 1.0,
    stress: 1.0,
};

/// Millimetre, tonne, second: newton, megapascal.
const MILLIMETRES: Units = Units {
    length: 1e3,
    stress: 1e-6,
};

fn run(text: &str) -> Record {
    let problem = support::problem(text);
    support::run(&problem).unwrap_or_else(|e| panic!("{e}"))
}

/// A block on a rigid floor that spreads against friction: the published benchmark of `examples/greco`.
fn greco(u: Units) -> String {
    let l = |x: f64| x * u.length;
    format!(
        r#"
format = 1
model.space = "plane-strain"
model.thickness = {thickness:?}
body.block = {{ generate.rectangle = {{ to = [{a:?}, {a:?}], cells = [32, 10] }}, material = "steel" }}
material.steel.isotropic = {{ young = {young:?}, poisson = 0.2 }}
obstacle.floor.plane = {{ point = [0, 0], normal = [0, 1] }}
set.S = {{ of = "block", point = [{a:?}, 0] }}
support.symmetry = {{ set = "block.right", x = 0 }}
support.corner = {{ set = "S", y = 0 }}
load.top = {{ set = "block.top", pressure = {{ value = {top:?} }} }}
load.side = {{ set = "block.left", pressure = {{ value = {side:?} }} }}
probe.A = {{ point = [0, 0] }}
probe.C = {{ point = [{c:?}, 0] }}
step = [{{ increments = {{ fixed = 2 }} }}]

[interface.base]
secondary = "block.bottom"
primary = "floor"
friction.coulomb = {{ mu = 1.0 }}
"#,
        thickness = l(1.0),
        a = l(0.04),
        c = l(0.005),
        young = 130e9 * u.stress,
        top = 5e7 * u.stress,
        side = 15e7 * u.stress,
    )
}

/// Two cubes, pressed and then sheared until part of the face slips, on springs given in pascals per metre.
fn press_and_slide(u: Units) -> String {
    let l = |x: f64| x * u.length;
    format!(
        r#"
format = 1
model.space = "solid"
body.lower = {{ generate.box = {{ to = [{one:?}, {one:?}, {one:?}], cells = [4, 4, 4] }}, material = "steel" }}
body.upper = {{ generate.box = {{ from = [0, 0, {one:?}], to = [{one:?}, {one:?}, {two:?}], cells = [3, 3, 3] }}, material = "steel" }}
material.steel.isotropic = {{ young = {young:?}, poisson = 0.3 }}
support.base = {{ set = "lower.bottom", x = 0, y = 0, z = 0 }}
support.top = {{ set = "upper.top", x = {slide:?}, y = 0, amplitude = "slide" }}
support.press = {{ set = "upper.top", z = {press:?}, amplitude = "press" }}
amplitude.press.table = [[0, 0], [1, 1]]
amplitude.slide.table = [[1, 0], [2, 1]]
probe.corner = {{ of = "upper", point = [{one:?}, 0, {one:?}] }}

[interface.joint]
secondary = "upper.bottom"
primary = "lower.top"
friction.coulomb = {{ mu = 0.3 }}
enforcement.penalty = {{ stiffness = {stiffness:?}, tangential-stiffness = {stiffness:?} }}

[[step]]
name = "press"
increments.fixed = 2

[[step]]
name = "slide"
increments.initial = 0.25
"#,
        one = l(1.0),
        two = l(2.0),
        young = 210e9 * u.stress,
        slide = l(2e-3),
        press = l(-1e-3),
        stiffness = 1e13 * u.stress / u.length,
    )
}

/// A rod thrown at a wall with friction, with inertia and damping; `scheme` integrates it. Seconds in both systems: masses in kg and t.
fn impact(u: Units, scheme: &str) -> String {
    let l = |x: f64| x * u.length;
    format!(
        r#"
format = 1
model = {{ space = "plane-strain", thickness = {one:?} }}
body.rod = {{ generate.rectangle = {{ from = [0, 0], to = [{one:?}, {part:?}], cells = [10, 2] }}, material = "steel", rayleigh = {{ mass = 10.0, stiffness = 1e-7 }} }}
material.steel.isotropic = {{ young = {young:?}, poisson = 0.3, density = {density:?} }}
obstacle.wall.plane = {{ point = [{wall:?}, 0], normal = [1, 0] }}
interface.hit = {{ secondary = "rod.left", primary = "wall", friction.coulomb = {{ mu = 0.3 }}, enforcement.penalty = {{ stiffness = {stiffness:?} }} }}
initial.throw = {{ set = "rod", velocity = [{vx:?}, {vy:?}] }}
probe.end = {{ of = "rod", point = [{one:?}, 0] }}

[[step]]
duration = 6e-4
{scheme}
"#,
        one = l(1.0),
        part = l(0.2),
        wall = 0.0,
        young = 210e9 * u.stress,
        density = 7800.0 * u.stress / (u.length * u.length),
        vx = l(-10.0),
        vy = l(4.0),
        stiffness = 1e12 * u.stress / u.length,
    )
}

/// What a column of the history holds, by its name, and the size of its unit.
fn quantity(name: &str, u: Units) -> (&'static str, f64) {
    let force = u.stress * u.length * u.length;
    let last = name.rsplit('.').next().unwrap_or(name);
    let component = last.trim_end_matches(|c: char| c.is_ascii_digit());
    match component {
        "S" | "CPRESSMAX" => ("stress", u.stress),
        "ALLSE" | "ALLCE" | "ALLFD" | "ALLWK" | "ALLKE" | "ALLVD" | "ALLCD" | "ALLND" | "ALLAE"
        | "EINITIAL" => ("energy", force * u.length),
        "CFN" | "CFS" | "RF" => ("force", force),
        "CAREA" => ("area", u.length * u.length),
        "XN" => ("place", u.length),
        "U" => ("displacement", u.length),
        "V" => ("velocity", u.length),
        "A" => ("acceleration", u.length),
        "STEP" | "INC" | "ATT" | "ITRS" | "AUGMENTATIONS" | "OPEN" | "STICK" | "SLIP" => {
            ("count", 1.0)
        }
        "TIME" | "DT" => ("time", 1.0),
        _ => panic!("a column without a known unit: {name}"),
    }
}

fn compare(text: impl Fn(Units) -> String) {
    let (si, mm) = (run(&text(SI)), run(&text(MILLIMETRES)));
    assert_eq!(si.cutbacks, mm.cutbacks);
    assert_eq!(si.increments.len(), mm.increments.len());
    let mut compared = 0;
    for ((a, row), (b, other)) in si.increments.iter().zip(&mm.increments) {
        assert_eq!(a.len(), b.len(), "iterations differ");
        for (p, q) in a.iter().zip(b) {
            assert_eq!((p.round, p.step, p.tally), (q.round, q.step, q.tally));
        }
        assert_eq!(row.names, other.names);
        for (name, (&x, &y)) in row.names.iter().zip(row.values.iter().zip(&other.values)) {
            // What is left of the balances of force and energy is rounding.
            if name.ends_with("RESIDUAL") {
                continue;
            }
            let (kind, unit) = quantity(name, MILLIMETRES);
            let y = y / unit;
            // Compared with the largest value of its kind: a force that should vanish has no size of its own.
            let all = row.names.iter().zip(&row.values);
            let size = all
                .filter(|(n, _)| !n.ends_with("RESIDUAL") && quantity(n, SI).0 == kind)
                .fold(0.0_f64, |m, (_, v)| m.max(v.abs()));
            assert!(
                (x - y).abs() <= 1e-9 * size,
                "{name}: {x:e} in metres, {y:e} in millimetres, largest {kind} {size:e}"
            );
            compared += 1;
        }
    }
    assert!(compared > 50);
}

#[test]
fn greco_in_millimetres() {
    compare(greco);
}

#[test]
fn press_and_slide_in_millimetres() {
    compare(press_and_slide);
}

#[test]
fn impact_in_millimetres() {
    compare(|u| impact(u, "increments.fixed = 60\ndynamic = { error = 1.0 }"));
}

#[test]
fn explicit_impact_in_millimetres() {
    compare(|u| impact(u, "dynamic = { scheme.central-difference = {} }"));
}

//! Maps of modes over friction, speed and load against closed forms and analyses of their own.

use std::f64::consts::TAU;

use crate::modes::{block, mass_on_a_belt, modes, near, worst};
use crate::support::complaint;
use stickslip::modal::ModalOutcome;

/// Other speeds and loads than those of the step, from its matrices: `λ² + (2 - 20 f exp(-10 s V)) λ + 100 = 0`.
#[test]
fn maps_over_speed_and_load_have_the_roots_of_the_mass_on_a_belt() {
    let speed = 0.1;
    for (over, range, critical, side) in [
        ("speed", "from = 0.5, to = 3", 10.0_f64.ln(), "below"),
        ("load", "from = 0, to = 2", 0.1 * 1.0_f64.exp(), "above"),
    ] {
        let asked = format!(", map = {{ over = \"{over}\", {range}, points = 26 }}");
        let outcome = mass_on_a_belt(speed, &asked);
        let map = outcome.map.as_ref().expect("a map");
        assert_eq!(map.rows.len(), 26);
        for row in &map.rows {
            let [s, f] = match over {
                "speed" => [row.factor, 1.0],
                _ => [1.0, row.factor],
            };
            let c = 2.0 - 20.0 * f * (-10.0 * s * speed).exp();
            let [[frequency, growth]] = row.modes[..] else {
                panic!("{:?}", row.modes);
            };
            near(growth, -0.5 * c, 1e-9);
            near(TAU * frequency, (100.0 - 0.25 * c * c).sqrt(), 1e-9);
            near(row.mu, 0.3 + 0.2 * (-10.0 * s * speed).exp(), 1e-12);
        }
        assert_eq!(map.critical.len(), 1, "{:?}", map.critical);
        near(map.critical[0][0], critical, 1e-8);
        near(TAU * map.critical[0][1], 10.0, 1e-6);
        let told = format!("unstable {side} {critical:.6} times the {over}");
        assert!(
            outcome.notes.iter().any(|n| n.contains(&told)),
            "{:?}",
            outcome.notes
        );
    }
    assert!(
        complaint(&block(
            "-1",
            "friction.coulomb = { mu = 0.5 }",
            "[[step]]\nsteady = {}\n[[step]]\ncomplex-modes = { map = { over = \"speed\" } }\n"
        ))
        .contains("begins above 0")
    );
}

/// What a map says of another load is what an analysis finds there: springs that couple, contact that damps the approach, and friction with a slope.
#[test]
fn a_map_over_the_load_agrees_with_an_analysis_there() {
    let at = |load: f64, asked: &str| {
        let springs = r#"
coupling.a.spring = { stiffness = 11.0, terms = [{ set = "centre", component = "x", factor = -0.8 }, { set = "centre", component = "y", factor = 0.6 }] }
coupling.b.spring = { stiffness = 20.0, terms = [{ set = "centre", component = "x", factor = 0.8 }, { set = "centre", component = "y", factor = 0.6 }] }
"#;
        let law = "normal.linear = { c = 11.0 }, damping.viscous = { coefficient = 0.05 }, friction.exponential-decay = { static = 0.8, kinetic = 0.4, decay = 2 }";
        let force = -0.3 * load;
        let steps = format!(
            "load.press = {{ set = \"centre\", nodal-force = {{ value = [0, {force:?}] }} }}\n[[step]]\nsteady = {{}}\n"
        );
        let asked = format!("[[step]]\ncomplex-modes = {{ count = 3{asked} }}\n");
        modes(&block("-0.4", law, &format!("{springs}{steps}{asked}")))
    };
    let all = at(1.0, ", map = { over = \"load\", to = 4, points = 5 }");
    agrees(&all, &[(1, &at(1.0, "")), (4, &at(4.0, ""))]);
}

/// Rows of a map are the modes of analyses, and not all the same.
fn agrees(map: &ModalOutcome, alone: &[(usize, &ModalOutcome)]) {
    let rows = &map.map.as_ref().expect("a map").rows;
    let mut worst_of_all: f64 = 0.0;
    for (row, alone) in alone {
        // A map keeps the contact state: where an analysis of its own has another, they differ.
        assert_eq!(alone.points, map.points);
        assert_eq!(rows[*row].modes.len(), alone.modes.len());
        for ([frequency, growth], mode) in rows[*row].modes.iter().zip(&alone.modes) {
            let size = mode.growth.hypot(TAU * mode.frequency);
            let off = (growth - mode.growth).hypot(TAU * (frequency - mode.frequency));
            worst_of_all = worst_of_all.max(off / size);
        }
    }
    println!("{worst_of_all:e} from analyses");
    assert!(worst_of_all < 1e-7, "{worst_of_all:e}");
    let [one, other] = [alone[0].1, alone[1].1].map(worst);
    assert!((one[0] - other[0]).abs() > 1e-3 * one[0].abs());
}

/// A pad with a back, pressed on a disc that slides below.
fn pad_in_space([speed, mu]: [f64; 2], asked: &str) -> ModalOutcome {
    modes(&format!(
        r#"
format = 1
model.space = "solid"
body.pad = {{ generate.box = {{ to = [0.1, 0.05, 0.02], cells = [8, 4, 2] }}, material = "lining", rayleigh = {{ stiffness = 1e-6 }} }}
body.back = {{ generate.box = {{ from = [0, 0, 0.02], to = [0.1, 0.05, 0.03], cells = [8, 4, 1] }}, material = "steel", rayleigh = {{ stiffness = 1e-6 }} }}
material.lining.isotropic = {{ young = 2e9, poisson = 0.3, density = 2500 }}
material.steel.isotropic = {{ young = 2e11, poisson = 0.3, density = 7850 }}
obstacle.disc.plane = {{ point = [0, 0, 0], normal = [0, 0, 1] }}
interface.glue = {{ secondary = "pad.top", primary = "back.bottom", tied = true }}
interface.rub = {{ secondary = "pad.bottom", primary = "disc", normal.linear = {{ c = 5e11 }}, friction.coulomb = {{ mu = {mu:?} }}, primary-velocity = [{speed:?}, 0, 0] }}
set.left = {{ of = "back", point = [0, 0.025, 0.03] }}
set.right = {{ of = "back", point = [0.1, 0.025, 0.03] }}
coupling.lean.spring = {{ stiffness = 2e8, terms = [{{ set = "left", component = "x", factor = 0.8 }}, {{ set = "left", component = "z", factor = -0.6 }}] }}
coupling.guide.spring = {{ stiffness = 1e8, terms = [{{ set = "right", component = "x" }}] }}
support.left = {{ set = "left", y = 0 }}
support.right = {{ set = "right", y = 0 }}
load.press = {{ set = "back.top", pressure = {{ value = 1e6 }} }}
output.every = 0
[[step]]
steady = {{}}
[[step]]
complex-modes = {{ shapes = false, {asked} }}
"#
    ))
}

#[test]
fn a_map_over_the_speed_agrees_with_an_analysis_there() {
    let all = pad_in_space(
        [0.1, 0.5],
        "count = 6, map = { over = \"speed\", from = 1, to = 3, points = 3 }",
    );
    let [slow, fast] = [0.1, 0.3].map(|speed| pad_in_space([speed, 0.5], "count = 6"));
    agrees(&all, &[(0, &slow), (2, &fast)]);
}

/// Fifty coefficients need no factor beside that of one analysis, fewer solutions than it, and few states; and what they say is what analyses with such friction find.
#[test]
fn a_map_of_a_pad_in_space_costs_no_more_than_one_analysis() {
    // Up to 0.69 no point opens.
    const MU: f64 = 0.28;
    let asked = "count = 20, friction-damping = false";
    let one = pad_in_space([5.0, MU], asked);
    let all = pad_in_space(
        [5.0, MU],
        &format!("{asked}, map = {{ to = 2.45, points = 50 }}"),
    );
    assert!(one.points[1] > 40, "{:?}", one.points);
    let map = all.map.as_ref().expect("a map");
    println!(
        "{} solutions for one, {} for the map, in {} dimensions, residual {:e}, critical {:?}",
        one.solves, map.solves, map.dimension, map.residual, map.critical
    );
    assert_eq!(map.rows.len(), 50);
    assert!(map.residual < 1e-5, "{:e}", map.residual);
    let estimates = map.rows.iter().map(|row| row.residual);
    let estimate = estimates.fold(0.0, f64::max);
    assert!(
        estimate < map.residual && map.residual < 10.0 * estimate,
        "{estimate:e}"
    );
    assert_eq!([one.factorisations, all.factorisations], [1, 1]);
    assert_eq!(all.solves, one.solves + map.solves);
    assert!(map.solves <= one.solves, "{} {}", one.solves, map.solves);
    assert!(map.dimension < 250, "{}", map.dimension);
    // Friction changes nothing else: stiffness of contact does not depend on the pressure.
    let rows = (1..50).step_by(4).chain([49]);
    let others: Vec<_> = rows
        .map(|row| {
            let mu = MU * map.rows[row].factor;
            (row, pad_in_space([5.0, mu], asked))
        })
        .collect();
    let mut alone = vec![(20, &one)];
    alone.extend(others.iter().map(|(row, of)| (*row, of)));
    agrees(&all, &alone);
    // Where stability is lost an analysis finds it lost.
    let [factor, frequency] = map.critical[0];
    let [below, above] = [0.999, 1.001].map(|f| pad_in_space([5.0, MU * factor * f], asked));
    let (below, above) = (worst(&below), worst(&above));
    assert!(below[0] < 0.0 && above[0] > 0.0, "{below:?} {above:?}");
    near(above[1], TAU * frequency, 1e-3 * above[1]);
}

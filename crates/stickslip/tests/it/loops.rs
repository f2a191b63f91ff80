//! Loops of partial slip against Cattaneo and Mindlin: the shear along the contact on the way there and back, and a ball over a thousand cycles.

use crate::fretting::{Cycles, FORCE, LOAD, MU, cylinder, hertz};
use crate::support;
use std::collections::BTreeMap;
use std::f64::consts::PI;
use std::path::Path;
use stickslip::contact::look;
use stickslip::run::Simulation;

/// A column of the contact.
fn column(simulation: &Simulation, name: &str) -> Vec<f64> {
    let (names, columns) = look::table(support::contact(simulation), &simulation.frame.state.u);
    let found = names.into_iter().zip(columns).find(|(n, _)| n == name);
    found.unwrap_or_else(|| panic!("no column {name}")).1
}

/// Shear of half-planes of one material at `x`, loaded to `FORCE` and then by `back` the other way: what a limit `μ p` leaves that nothing exceeds, less twice that of half the way back
/// (Cattaneo; Mindlin and Deresiewicz).
fn shear(x: f64, back: f64) -> f64 {
    let (_, a) = hertz();
    let peak = MU * 2.0 * LOAD / (PI * a);
    let bulge = |c: f64| c / a * (1.0 - (x / c).powi(2)).max(0.0).sqrt();
    let slipped = |force: f64| {
        let c = a * (1.0 - force / (MU * LOAD)).sqrt();
        peak * (bulge(a) - bulge(c))
    };
    slipped(FORCE) - 2.0 * slipped(0.5 * back)
}

/// The mean difference of the shear along the contact, in parts of the mean limit, when the force is at its largest, half of that and nothing on the way back, half of it the other way, and all.
#[test]
fn the_shear_of_a_loop_is_that_of_cattaneo_and_mindlin() {
    let mut off = Vec::new();
    for size in [0.01, 0.005] {
        let mut simulation = cylinder(size, "count = 1", 16, "");
        let mut found: BTreeMap<usize, f64> = BTreeMap::new();
        while simulation
            .advance(&mut [])
            .unwrap_or_else(|e| panic!("{e}"))
        {
            let sixteenth = (simulation.frame.state.t - 2.0) * 16.0;
            let quarter = sixteenth.round();
            if !(4.0..=12.0).contains(&quarter)
                || (sixteenth - quarter).abs() > 1e-6
                || quarter % 2.0 != 0.0
            {
                continue;
            }
            // From the largest force at a quarter of the cycle to the least at three.
            let back = FORCE * (quarter - 4.0) / 4.0;
            let (x, q) = (column(&simulation, "x"), column(&simulation, "CSHEAR1"));
            let areas = column(&simulation, "CNORMF");
            let pressed = areas.iter().zip(column(&simulation, "CPRESS"));
            let areas: Vec<f64> = pressed
                .map(|(f, p)| if p > 0.0 { f / p } else { 0.0 })
                .collect();
            let force: f64 = q.iter().zip(&areas).map(|(q, a)| q * a).sum();
            assert!(
                (force - (FORCE - back)).abs() < 5e-3 * FORCE,
                "{quarter}: {force}"
            );
            let differences = x.iter().zip(&q).zip(&areas);
            let sum: f64 = differences
                .map(|((x, q), area)| (q - shear(*x, back)).abs() * area)
                .sum();
            found.insert(quarter as usize, sum / (MU * LOAD));
        }
        assert_eq!(found.len(), 5, "{found:?}");
        off.push(found);
    }
    println!("{off:?}");
    for (quarter, coarse) in &off[0] {
        let fine = off[1][quarter];
        assert!(fine < 0.02 && fine < *coarse, "{off:?}");
    }
}

/// A ball on a block of the same material, as in the example, back and forth.
fn ball(cycles: &str) -> Cycles {
    let case = include_str!("../../../../examples/fretting-sphere/case.toml");
    let (model, _) = case
        .split_once("# 100 increments in all.")
        .expect("the steps");
    let text = format!(
        r#"{model}
[[step]]
name = "press"
increments.fixed = 2

[[step]]
name = "out"
increments.fixed = 4

[[step]]
name = "fret"
duration = 2
cycles = {{ {cycles} }}
increments.fixed = 8
"#
    );
    let problem =
        stickslip::problem::Problem::from_toml(&text, None).unwrap_or_else(|e| panic!("{e}"));
    let setup = problem
        .build(Path::new("."))
        .unwrap_or_else(|e| panic!("{e}"));
    let mut simulation = Simulation::new(setup).unwrap_or_else(|e| panic!("{e}"));
    Cycles::of(&mut simulation)
}

/// A thousand cycles of which few are computed: the work of each is Mindlin's as well as that of the example, and that of cycles which are all computed to the error that is asked for.
#[test]
fn a_thousand_cycles_of_a_ball_cost_no_more_than_ten() {
    let cycles = ball("count = 1000, jump = { error = 1e-3 }");
    let computed = cycles.0.len();
    assert!(computed <= 10, "{computed}");
    assert_eq!(cycles.last("CYCLES"), 1000.0);
    // Half of the ball is modelled.
    let (p, q) = (
        2.0 * cycles.last("contact.FN"),
        2.0 * cycles.last("contact.FT"),
    );
    let (young, poisson, radius, mu) = (1e5, 0.3, 10.0, 0.3);
    let modulus = young / (2.0 * (1.0 - poisson * poisson));
    let a = (0.75 * p * radius / modulus).cbrt();
    let soft = 2.0 * (2.0 - poisson) * 2.0 * (1.0 + poisson) / young;
    let r = q / (mu * p);
    let left = 1.0 - r;
    let bracket = 1.0 - left.powf(5.0 / 3.0) - 5.0 * r / 6.0 * (1.0 + left.powf(2.0 / 3.0));
    let work = 0.5 * 9.0 * (mu * p).powi(2) / (10.0 * a) * soft * bracket;
    let found = cycles.last("contact.ED");
    println!("{computed} cycles, work {found}, Mindlin {work}, P {p}, Q {q}");
    // 4.5 cells on the radius: the example says 8 to 10 %, and 2.3 % with 12.
    assert!((found / work - 1.0).abs() < 0.12, "{found} {work}");
    let sum = cycles.last("contact.EDSUM");
    let all = ball("count = 20");
    let settled = all.last("contact.ED");
    // What the first cycles differ by, over a thousand of them, and cycles like the twentieth.
    let exact = all.last("contact.EDSUM") + 980.0 * settled;
    println!("{sum} {exact}, {settled}");
    assert!((found / settled - 1.0).abs() < 1e-3, "{found} {settled}");
    assert!((sum / exact - 1.0).abs() < 1e-3, "{sum} {exact}");
}

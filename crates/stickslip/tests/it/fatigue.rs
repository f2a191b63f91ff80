//! Criteria of fretting fatigue over cycles: a bar that is pulled and pushed along a rigid flat, against closed forms.

use crate::support;
use stickslip::Error;
use stickslip::results::{Analysis, Event, Observer, Row, fields};
use stickslip::run::Simulation;

const PULL: f64 = 100.0;
const PRESS: f64 = 1.0;
/// So little that the moment of the shear about the middle of the bar does not shift the pressure.
const MU: f64 = 1e-3;
const YOUNG: f64 = 2e5;
const LONG: f64 = 4.0;
const K: f64 = 0.3;

#[derive(Default)]
struct Cycles(Vec<Row>);

impl Observer for Cycles {
    fn see(&mut self, _: &Analysis, event: Event) -> Result<(), Error> {
        if let Event::Cycle(row) = event {
            self.0.push(row.clone());
        }
        Ok(())
    }
}

/// A bar held at its left end, pressed on a flat with little friction, pulled and pushed at its right end.
fn bar(dim: usize, more: &str) -> String {
    let (space, block, normal, sides, pull) = match dim {
        2 => (
            "\"plane-stress\"",
            "rectangle = { to = [4, 1], cells = [8, 2] }",
            "[0, 1]",
            "",
            "[100, 0]",
        ),
        _ => (
            "\"solid\"",
            "box = { to = [4, 1, 1], cells = [8, 2, 2] }",
            "[0, 0, 1]",
            "support.side = { set = \"bar.front\", y = 0.0 }",
            "[100, 0, 0]",
        ),
    };
    format!(
        r#"format = 1
model.space = {space}
body.bar = {{ generate.{block}, material = "steel" }}
material.steel.isotropic = {{ young = {YOUNG}, poisson = 0.3 }}
obstacle.flat.plane = {{ point = {point}, normal = {normal} }}
support.left = {{ set = "bar.left", x = 0.0 }}
{sides}
load.press = {{ set = "bar.top", pressure.value = {PRESS} }}
load.pull = {{ set = "bar.right", traction.value = {pull}, amplitude = "cycle" }}
amplitude.cycle.table = [[0, 0], [1, 0], [1.25, 1], [1.75, -1], [2, 0]]
step = [{{ name = "press", increments.fixed = 1 }}, {{ name = "pull", cycles = {{ count = 2 }}, increments.fixed = 8 }}]
interface.base = {{ secondary = "bar.bottom", primary = "flat", friction.coulomb = {{ mu = {MU} }} }}
{more}
"#,
        point = if dim == 2 { "[0, 0]" } else { "[0, 0, 0]" },
    )
}

const ALL: &str = "criteria = [{ findley = { k = 0.3 } }, { smith-watson-topper = {} }, { dang-van = { a = 0.4 } }, { ruiz = {} }, { ruiz-work = {} }]";

fn run(text: &str) -> (Simulation, Vec<Row>) {
    let mut simulation = support::build(&support::problem(text)).unwrap_or_else(|e| panic!("{e}"));
    let mut cycles = Cycles::default();
    let run = simulation.run(&mut [&mut cycles]);
    run.unwrap_or_else(|e| panic!("{e}"));
    (simulation, cycles.0)
}

/// With `σ_x` from `-S` to `S` and `-p` across it the shear of a plane at `θ` goes over `S sin 2θ`, and the normal stress up to `S cos²θ - p sin²θ`.
fn expected() -> [(&'static str, f64, f64); 5] {
    let (s, p) = (PULL, PRESS);
    let findley = 0.5 * (s.hypot(K * (s + p)) + K * (s - p));
    let slip = 2.0 * s * LONG / YOUNG;
    [
        ("FINDLEY", findley, 2e-3),
        ("SWT", s * s / YOUNG, 3e-3),
        ("DANGVAN", 0.5 * s + 0.4 * (s - p) / 3.0, 2e-3),
        ("RUIZ", s * MU * p * slip, 5e-3),
        ("RUIZWORK", MU * p * slip, 5e-3),
    ]
}

#[test]
fn a_bar_that_is_pulled_and_pushed_has_the_values_of_closed_forms() {
    for dim in [2, 3] {
        let (simulation, cycles) = run(&bar(dim, &format!("output.fatigue = {{ {ALL} }}")));
        assert_eq!(cycles.len(), 2);
        let all = fields(&simulation.view());
        for (name, value, tolerance) in expected() {
            let what = format!("{dim}D {name}");
            let row = cycles[1].get(name).expect("a column");
            assert!(
                (row / value - 1.0).abs() < tolerance,
                "{what}: {row} {value}"
            );
            let summary = &simulation.summary.fatigue;
            let told = summary.iter().find(|m| m.criterion == name).expect("told");
            assert_eq!((told.value, told.cycle, told.step), (row, 2, 2), "{what}");
            for (c, letter) in ["X1", "X2", "X3"].iter().enumerate().take(dim) {
                assert_eq!(
                    cycles[1].get(&format!("{name}.{letter}")),
                    Some(told.place[c])
                );
            }
            let field = all.get(name).expect("a field");
            let values = field.values.iter().copied().filter(|v| !v.is_nan());
            assert_eq!(values.clone().fold(f64::MIN, f64::max), row, "{what}");
            // The stress is uniform, and slip grows with the distance from the end that is held; only points of the surface slide.
            let least = values.clone().fold(f64::MAX, f64::min);
            if name.starts_with("RUIZ") {
                assert_eq!(told.place[0], LONG, "{what}");
                assert_eq!(values.count(), if dim == 2 { 9 } else { 27 }, "{what}");
                assert!(least < 1e-3 * row, "{what}: {least}");
            } else {
                assert!(least > 0.99 * row, "{what}: {least} {row}");
            }
            let normals = all.get(&format!("{name}_PLANE")).expect("a field");
            assert_eq!(normals.components, 3);
        }
        // The plane across the bar, and the surface.
        let plane = |name: &str| {
            let all = &simulation.summary.fatigue;
            all.iter()
                .find(|m| m.criterion == name)
                .expect("told")
                .plane
        };
        assert!(plane("SWT")[0].abs() > 0.9999, "{:?}", plane("SWT"));
        assert!(plane("RUIZ")[dim - 1].abs() > 0.9999, "{:?}", plane("RUIZ"));
        let lean = plane("FINDLEY")[0].abs().acos();
        let angle = 0.5 * (1.0 / (K * (PULL + PRESS) / PULL)).atan();
        assert!((lean - angle).abs() < 0.01, "{lean} {angle}");
    }
}

#[test]
fn points_near_the_interface_have_the_values_that_they_have_among_all() {
    let whole = run(&bar(2, &format!("output.fatigue = {{ {ALL} }}"))).0;
    let some = run(&bar(
        2,
        &format!("output.fatigue = {{ depth = 0.6, {ALL} }}"),
    ))
    .0;
    let [whole, some] = [whole, some].map(|s| fields(&s.view()));
    for (name, ..) in expected() {
        let [whole, some] = [&whole, &some].map(|f| &f.get(name).expect("a field").values);
        let known = some.iter().filter(|v| !v.is_nan()).count();
        // Of three rows of nodes two, or the one on the flat.
        assert_eq!(
            known,
            if name.starts_with("RUIZ") { 9 } else { 18 },
            "{name}"
        );
        let same = whole.iter().zip(some);
        assert!(
            same.filter(|(_, b)| !b.is_nan()).all(|(a, b)| a == b),
            "{name}"
        );
    }
}

#[test]
fn what_cannot_be_evaluated_is_refused() {
    for (more, said) in [
        ("criteria = []", "there is no criterion"),
        (
            "criteria = [{ findley = { k = -1 } }]",
            "`k` must be zero or positive",
        ),
        (
            "criteria = [{ dang-van = { a = 0.1 } }, { dang-van = { a = 0.2 } }]",
            "a second criterion DANGVAN",
        ),
        (
            "criteria = [{ ruiz = {} }], depth = 0",
            "must be greater than 0",
        ),
        ("criteria = [{ brown-miller = {} }]", "brown-miller"),
    ] {
        let told = support::complaint(&bar(2, &format!("output.fatigue = {{ {more} }}")));
        assert!(told.contains(said), "{more}: {told}");
    }
    let text = bar(2, "output.fatigue = { criteria = [{ ruiz = {} }] }");
    let told = support::complaint(&text.replace("cycles = { count = 2 }, ", ""));
    assert!(told.contains("no step has any"), "{told}");
}

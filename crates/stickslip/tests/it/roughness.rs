//! Rough surfaces: waves whose contact is known in closed form, maps from files, and a random surface.

use std::f64::consts::PI;
use std::fs;

use crate::support;
use stickslip::Error;
use stickslip::problem::Document;
use stickslip::run::Simulation;
use support::{Record, Row, complaint, folder, problem};

const YOUNG: f64 = 1000.0;
const POISSON: f64 = 0.3;
const AMPLITUDE: f64 = 1e-3;

fn stiffness() -> f64 {
    YOUNG / (1.0 - POISSON * POISSON)
}

/// Half a wave of length 1 beneath a block, with `n` cells on it, pressed down by `depth` from where crests touch.
fn wavy(n: usize, depth: f64, roughness: &str) -> String {
    format!(
        r#"
format = 1
model.space = "plane-strain"
body.block = {{ generate.rectangle = {{ to = [0.5, 1.5], cells = [{n}, 48], grading.y.ratio = 20 }}, material = "m" }}
material.m.isotropic = {{ young = {YOUNG:?}, poisson = {POISSON:?} }}
obstacle.floor.plane = {{ point = [0, -{AMPLITUDE:?}], normal = [0, 1] }}
interface.base = {{ secondary = "block.bottom", primary = "floor", roughness = {roughness} }}
support.left = {{ set = "block.left", x = 0 }}
support.right = {{ set = "block.right", x = 0 }}
support.press = {{ set = "block.top", y = -{depth:?} }}
step = [{{ increments.fixed = 2 }}]
"#
    )
}

const WAVE: &str = "{ wave = { amplitude = 1e-3, wavelength = [1.0] } }";

fn last(text: &str) -> Row {
    let record = support::run(&problem(text)).unwrap_or_else(|e| panic!("{e}\n{text}"));
    record.increments.last().expect("an increment").1.clone()
}

fn value(row: &Row, name: &str) -> f64 {
    row.get(name).unwrap_or_else(|| panic!("no column {name}"))
}

/// Westergaard 1939: where crests of `Δ cos(2πx/λ)` touch on `|x| < a`, the mean pressure is `p* sin²(πa/λ)` with `p* = π E* Δ/λ`, and the largest
/// `2 p̄/sin(πa/λ)`; in full contact it is `p̄ + p*`.
#[test]
fn a_wavy_surface_presses_as_westergaard_says() {
    let full = PI * stiffness() * AMPLITUDE;
    // Of the depth a third squeezes the block, about.
    for depth in [1.2e-3, 2.4e-3, 7.0e-3] {
        let row = last(&wavy(96, depth, WAVE));
        let mean = value(&row, "base.CFN2") / 0.5;
        let peak = value(&row, "base.CPRESSMAX");
        let area = value(&row, "base.CAREA") / 0.5;
        let (should, covered) = match mean < full {
            true => {
                let sine = (mean / full).sqrt();
                (2.0 * mean / sine, 2.0 * sine.asin() / PI)
            }
            false => (mean + full, 1.0),
        };
        assert!(
            (peak / should - 1.0).abs() < 5e-3,
            "{depth}: {peak} {should} at {mean} of {full}"
        );
        assert!(
            (area - covered).abs() < 1.0 / 96.0,
            "{depth}: {area} {covered}"
        );
    }
    // Both sides of the limit were met.
    let mean = |depth| value(&last(&wavy(24, depth, WAVE)), "base.CFN2") / 0.5;
    assert!(mean(2.4e-3) < full && mean(7.0e-3) > full);
}

/// The same wave from a file, as a profile and with a plane added, gives the same contact; without repetition only where the file has heights.
#[test]
fn measured_profiles_are_the_surfaces_that_were_measured() {
    let folder = folder("roughness-measured");
    let profile = |n: usize, tilt: f64| -> String {
        let line = |k: usize| {
            let s = k as f64 / n as f64;
            let h = 1e3 * (AMPLITUDE * (2.0 * PI * s).cos() + tilt * s + 0.3);
            format!("{:?} {h:?}\n", 1e3 * s)
        };
        (0..n).map(line).collect()
    };
    // The tilt of a cosine sampled over one period, from crest to before the next, is not zero; that of two halves of one is what is left out here.
    fs::write(folder.join("kept.txt"), profile(48, 0.0)).expect("written");
    let run = |roughness: &str| -> Result<Row, Error> {
        let document = Document::new(wavy(24, 2.4e-3, roughness), Some(&folder.join("case.toml")));
        let problem = document.problem()?;
        let setup = problem.build(&folder)?;
        let said = setup.notes.join("\n");
        assert!(
            said.contains("sigma = 70") && said.contains("heights at 25 points"),
            "{said}"
        );
        let mut simulation = Simulation::new(setup)?;
        let mut record = Record::default();
        simulation.run(&mut [&mut record])?;
        Ok(record.increments.last().expect("an increment").1.clone())
    };
    let wave = last(&wavy(24, 2.4e-3, WAVE));
    let kept =
        "{ measured = { file = \"kept.txt\", unit = 1e-3, tilt = \"keep\", repeat = true } }";
    let kept = run(kept).expect("a run");
    // 0.3 above the wave: the block would have to be lifted by as much.
    assert!(value(&kept, "base.CFN2") > 50.0 * value(&wave, "base.CFN2"));
    let levelled = "{ measured = { file = \"kept.txt\", unit = 1e-3, repeat = true } }";
    let levelled = run(levelled).expect("a run");
    fs::write(folder.join("tilted.txt"), profile(48, 0.01)).expect("written");
    let tilted = "{ measured = { file = \"tilted.txt\", unit = 1e-3, repeat = true } }";
    let tilted = run(tilted).expect("a run");
    for name in ["base.CFN2", "base.CPRESSMAX", "base.CAREA"] {
        let (a, b) = (value(&levelled, name), value(&tilted, name));
        assert!((a / b - 1.0).abs() < 1e-6, "{name}: {a} {b}");
    }
    // Of 48 samples of a cosine the line nearest to them is not level; the wave itself is what is left of it.
    let (a, b) = (value(&levelled, "base.CFN2"), value(&wave, "base.CFN2"));
    assert!((a / b - 1.0).abs() < 0.05, "{a} {b}");
    let once = run("{ measured = { file = \"kept.txt\", unit = 5e-4 } }").expect_err("no heights");
    assert!(
        once.to_string().contains("beyond the edges of the map"),
        "{once}"
    );
    let none = run("{ measured = { file = \"none.txt\" } }").expect_err("no file");
    assert!(none.to_string().contains("none.txt"), "{none}");
    fs::write(folder.join("map.csv"), "1,2,3\n4,5,6\n").expect("written");
    let map = "{ measured = { file = \"map.csv\", spacing = [1] } }";
    assert!(
        run(map)
            .expect_err("a map")
            .to_string()
            .contains("takes a profile")
    );
}

#[test]
fn what_means_nothing_is_said_at_its_key() {
    let cases = [
        (
            "{ wave = { amplitude = 0, wavelength = [1] } }",
            "`amplitude` is 0",
        ),
        (
            "{ wave = { amplitude = 1, wavelength = [1, 1] } }",
            "give 1 to 1",
        ),
        (
            "{ self-affine = { period = [1], shortest = 0.1, hurst = 0.8 } }",
            "has to be given, and not both",
        ),
        (
            "{ self-affine = { period = [1], shortest = 2, hurst = 0.8, rms = 1e-3 } }",
            "there is no wave between",
        ),
        (
            "{ self-affine = { period = [1], shortest = 1e-5, hurst = 0.8, rms = 1e-3 } }",
            "more than 512 waves",
        ),
        (
            "{ origin = [0, 0, 0], wave = { amplitude = 1, wavelength = [1] } }",
            "expected 2 components",
        ),
    ];
    for (roughness, says) in cases {
        let said = complaint(&wavy(8, 1e-3, roughness));
        assert!(
            said.contains(says) && said.contains("roughness"),
            "{roughness}: {said}"
        );
    }
    let tied =
        wavy(8, 1e-3, WAVE).replace("primary = \"floor\",", "primary = \"floor\", tied = true,");
    let said = complaint(&tied);
    assert!(said.contains("heights have no meaning"), "{said}");
}

/// A self-affine profile pressed on an elastic block until most of it touches. Where all of it touches pressures vary by
/// `V = (E* h')²/4` (each wave by `E* q a/2`, as in Westergaard's solution); in Persson's theory `erf(p/√(2V))` touches. Numbers lie above that, the more the lighter the
/// load, where the few highest waves carry it.
#[test]
fn a_rough_profile_touches_as_theory_has_it() {
    let case = |depth: f64, seed: usize| {
        format!(
            r#"
format = 1
model.space = "plane-strain"
body.block = {{ generate.rectangle = {{ to = [1, 0.6], cells = [256, 30], grading.y.ratio = 60 }}, material = "m" }}
material.m.isotropic = {{ young = {YOUNG:?}, poisson = {POISSON:?} }}
obstacle.floor.plane = {{ point = [0, -0.004], normal = [0, 1] }}
interface.base = {{ secondary = "block.bottom", primary = "floor", roughness.self-affine = {{ period = [1], longest = 0.25, shortest = 0.0625, hurst = 0.8, slope = 0.05, seed = {seed} }} }}
support.left = {{ set = "block.left", x = 0 }}
support.right = {{ set = "block.right", x = 0 }}
support.press = {{ set = "block.top", y = -{depth:?} }}
step = [{{ increments.fixed = 20 }}]
"#
        )
    };
    let mut ratios = Vec::new();
    for seed in 0..4 {
        let record = support::run(&problem(&case(0.02, seed))).unwrap_or_else(|e| panic!("{e}"));
        let rows = record.increments.iter().map(|(_, row)| row);
        let points: Vec<[f64; 2]> = rows
            .map(|row| {
                [
                    value(row, "base.CFN2") / (stiffness() * 0.05),
                    value(row, "base.CAREA"),
                ]
            })
            .collect();
        assert!(points.windows(2).all(|p| p[0][1] <= p[1][1]), "{points:?}");
        let middle = points.iter().filter(|p| (0.6..0.95).contains(&p[1]));
        ratios.extend(middle.map(|&[load, area]| area / error_function(2.0_f64.sqrt() * load)));
    }
    let mean = ratios.iter().sum::<f64>() / ratios.len() as f64;
    assert!(ratios.len() >= 8, "{ratios:?}");
    assert!((1.0..1.25).contains(&mean), "{mean} of {ratios:?}");
}

/// By its series, which suits arguments up to three.
fn error_function(x: f64) -> f64 {
    let mut term = x;
    let mut sum = x;
    for k in 1..60 {
        term *= -x * x / f64::from(k);
        sum += term / f64::from(2 * k + 1);
    }
    2.0 / PI.sqrt() * sum
}

//! Bodies of several shapes: the method that is chosen, and what each method takes.

use std::fs;

use super::bench::{Bench, example, seconds};
use super::slide::cells;
use super::table::Table;

/// How much slower than the best the choice may be.
const GOAL: f64 = 1.3;

/// Ways to solve, each of which is forced.
const METHODS: [&str; 3] = ["condensed", "sparse", "multigrid"];

/// How many shapes there are.
pub const COUNT: usize = 6;

/// A box pressed on a rigid plane over a whole face and pushed sideways.
fn on_a_plane(size: [f64; 3], cells: [usize; 3]) -> String {
    let [x, y, z] = size;
    format!(
        r#"format = 1
model.space = "solid"
body.slab = {{ generate.box = {{ to = [{x}, {y}, {z}], cells = {cells:?} }}, material = "steel" }}
material.steel.isotropic = {{ young = 210e9, poisson = 0.3 }}
obstacle.floor.plane = {{ point = [0, 0, 0], normal = [0, 0, 1] }}
interface.base = {{ secondary = "slab.bottom", primary = "floor", friction.coulomb.mu = 0.3 }}
support.top-y = {{ set = "slab.top", y = 0.0 }}
support.top-z = {{ set = "slab.top", z = {press:e}, amplitude = "press" }}
support.top-x = {{ set = "slab.top", x = {push:e}, amplitude = "push" }}
amplitude.press.table = [[0, 0], [1, 1]]
amplitude.push.table = [[1, 0], [2, 1]]
step = [{{ name = "press", increments.fixed = 5 }}, {{ name = "push", increments.fixed = 10 }}]
"#,
        press = -1e-3 * z,
        push = 1e-3 * z
    )
}

/// A small ball on a large block.
const BALL_ON_BLOCK: &str = r#"format = 1
model.space = "solid"
body.ball = { generate.half-ball = { centre = [0, 0, 1], radius = 1, size = 0.2 }, material = "steel" }
body.block = { generate.box = { from = [-2, -2, -2], to = [2, 2, 0], cells = [28, 28, 14] }, material = "steel" }
material.steel.isotropic = { young = 210e9, poisson = 0.3 }
interface.joint = { secondary = "ball.arc", primary = "block.top", friction.coulomb.mu = 0.3, kinematics.small-sliding = {} }
support.base = { set = "block.bottom", x = 0.0, y = 0.0, z = 0.0 }
support.top-y = { set = "ball.flat", y = 0.0 }
support.top-z = { set = "ball.flat", z = -0.02, amplitude = "press" }
support.top-x = { set = "ball.flat", x = 0.004, amplitude = "push" }
amplitude.press.table = [[0, 0], [1, 1]]
amplitude.push.table = [[1, 0], [2, 1]]
step = [{ name = "press", increments.fixed = 5 }, { name = "push", increments.fixed = 10 }]
"#;

/// Runs the shapes with these numbers, from 1; all if none is given.
pub fn measure(bench: &Bench, wanted: &[usize]) -> Result<(), String> {
    let slab = |n: usize, layers: usize| {
        let thickness = layers as f64 / n as f64;
        on_a_plane([1.0, 1.0, thickness], [n, n, layers])
    };
    let shapes: [_; COUNT] = [
        ("cube on cube, 18³ on 17³", None),
        ("slab 40 × 40 × 10 on a plane", Some(slab(40, 10))),
        ("slab 40 × 40 × 4 on a plane", Some(slab(40, 4))),
        ("slab 60 × 60 × 3 on a plane", Some(slab(60, 3))),
        (
            "bar 8 × 8 × 120 on its end",
            Some(on_a_plane([1.0, 1.0, 15.0], [8, 8, 120])),
        ),
        (
            "small ball on a block 28 × 28 × 14",
            Some(BALL_ON_BLOCK.to_string()),
        ),
    ];
    let table = Table::new(
        "Shapes: 15 increments, one thread, CPU seconds of the whole process",
        &[
            "shape",
            "dofs",
            "chosen",
            "automatic",
            "condensed",
            "sparse",
            "multigrid",
            "automatic / best",
            "within 1.3",
        ],
    );
    let mut reasons = Vec::new();
    for (k, (name, text)) in shapes.into_iter().enumerate() {
        if !wanted.is_empty() && !wanted.contains(&(k + 1)) {
            continue;
        }
        let (case, settings) = match text {
            None => (example("press-and-slide/case.toml")?, cells(18)),
            Some(text) => {
                let file = bench.folder("shapes")?.join(format!("{}.toml", k + 1));
                fs::write(&file, text).map_err(|e| format!("{}: {e}", file.display()))?;
                (file, Vec::new())
            }
        };
        let run = |method: &str| {
            let mut settings = settings.clone();
            settings.push(format!("solver.method=\"{method}\""));
            bench.analyse(&case, &settings)
        };
        let automatic = run("automatic")?;
        let mut best = f64::INFINITY;
        let mut cells = vec![
            name.to_string(),
            automatic.dofs().to_string(),
            automatic.method().to_string(),
            format!("{:.2}", automatic.run.cpu),
        ];
        for method in METHODS {
            // A method that a shape is beyond is no reason to measure no other.
            let cpu = match bench.has_method(method)? {
                true => run(method).ok().map(|a| a.run.cpu),
                false => None,
            };
            best = best.min(cpu.unwrap_or(f64::INFINITY));
            cells.push(seconds(cpu));
        }
        let over = automatic.run.cpu / best;
        cells.push(format!("{over:.2}"));
        cells.push(if over <= GOAL { "yes" } else { "no" }.to_string());
        table.row(cells);
        reasons.push(format!("{name}: {}", automatic.text("/method-reason")));
    }
    println!();
    for line in reasons {
        println!("- {line}");
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::on_a_plane;

    #[test]
    fn a_slab_is_pressed_in_proportion_to_its_height() {
        let text = on_a_plane([1.0, 1.0, 0.25], [4, 4, 1]);
        assert!(text.contains("cells = [4, 4, 1]"));
        assert!(text.contains("z = -2.5e-4"));
    }
}

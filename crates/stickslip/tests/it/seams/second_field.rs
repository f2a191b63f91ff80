//! A second field with a matrix of its own: temperatures that are found, with heat that flows where surfaces press, and expansion that presses them.

use std::path::Path;
use std::sync::Arc;

use crate::{restart, support};
use stickslip::contact::look;
use stickslip::mesh::Mesh;
use stickslip::model::{FieldIncrement, SecondField, Setup};
use stickslip::problem::Problem;
use stickslip::run::Simulation;
use stickslip::system::Dofs;

/// Steady conduction in rectangles of four-node cells, plane, with unit thickness.
#[derive(Debug)]
struct Conduction {
    mesh: Arc<Mesh>,
    conductivity: f64,
    /// Heat that flows where surfaces press `[W/m²K]`.
    conductance: f64,
    /// Young's modulus over `1 - ν`, times the expansion: stress of a plane part that is held and warmer by one degree.
    stress: f64,
    reference: f64,
    /// Temperatures at the ends by time: `(time, left, right)`; constant between.
    ends: Vec<(f64, f64, f64)>,
}

/// Two bars and a gap that heat closes: the public verification problem VM23.
const BARS: [f64; 4] = [0.0, 0.4, 0.4035, 0.9035];
const STRESS: f64 = 10e6 / (1.0 - 0.3) * 12e-6;

impl Conduction {
    /// Corners of a cell and its sides.
    fn cells(&self) -> impl Iterator<Item = (&[usize], [f64; 2])> {
        let block = &self.mesh.blocks;
        let all = block.iter().flat_map(|b| b.connectivity.chunks(4));
        all.map(|c| {
            let [a, d] = [0, 2].map(|k| self.mesh.points[c[k]]);
            (c, [d[0] - a[0], d[1] - a[1]])
        })
    }
}

/// Signs of the corners of a cell along both sides.
const CORNERS: [[f64; 2]; 4] = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];

/// Solves a dense system by elimination; the matrix of heat conduction with ends that are given needs no pivots.
fn solve(mut a: Vec<Vec<f64>>, mut b: Vec<f64>) -> Vec<f64> {
    let n = b.len();
    for k in 0..n {
        for i in k + 1..n {
            let f = a[i][k] / a[k][k];
            if f != 0.0 {
                let row = a[k].clone();
                a[i].iter_mut().zip(&row).for_each(|(x, y)| *x -= f * y);
                b[i] -= f * b[k];
            }
        }
    }
    for k in (0..n).rev() {
        let known: f64 = (k + 1..n).map(|j| a[k][j] * b[j]).sum();
        b[k] = (b[k] - known) / a[k][k];
    }
    b
}

impl SecondField for Conduction {
    fn name(&self) -> &str {
        "NT"
    }

    fn dofs(&self) -> Dofs {
        Dofs {
            dim: 1,
            points: self.mesh.points.len(),
        }
    }

    fn initial(&self) -> Vec<f64> {
        vec![self.reference; self.dofs().count()]
    }

    fn advance(&self, increment: &FieldIncrement) -> Vec<f64> {
        let n = self.dofs().count();
        let (mut a, mut b) = (vec![vec![0.0; n]; n], vec![0.0; n]);
        for (c, [w, h]) in self.cells() {
            for (i, p) in CORNERS.iter().enumerate() {
                for (j, q) in CORNERS.iter().enumerate() {
                    let along = |k: usize| p[k] * q[k] / 4.0;
                    let across = |k: usize| (3.0 + p[k] * q[k]) / 12.0;
                    let flow =
                        along(0) * across(1) * 4.0 * h / w + along(1) * across(0) * 4.0 * w / h;
                    a[c[i]][c[j]] += self.conductivity * flow;
                }
            }
        }
        let joined = increment.contacts.iter().flat_map(|c| look::joined(*c));
        for point in joined {
            let other = point.primary.iter().map(|&(p, w)| (p, -w));
            let both: Vec<(usize, f64)> = point.secondary.iter().copied().chain(other).collect();
            for (p, v) in &both {
                for (q, w) in &both {
                    a[*p][*q] += self.conductance * point.area * v * w;
                }
            }
        }
        // Ends that are given, and a little film at the reference elsewhere is not needed: both bars have one.
        let now = self.ends.iter().rev().find(|e| e.0 < increment.state.t);
        let (_, left, right) = now
            .copied()
            .unwrap_or((0.0, self.reference, self.reference));
        for (p, x) in self.mesh.points.iter().enumerate() {
            let given = [(BARS[0], left), (BARS[3], right)];
            if let Some((_, t)) = given.iter().find(|(at, _)| (x[0] - at).abs() < 1e-9) {
                a[p].fill(0.0);
                a[p][p] = 1.0;
                b[p] = *t;
            }
        }
        solve(a, b)
    }

    fn add_forces(&self, values: &[f64], times: f64, out: &mut [f64]) {
        for (c, size) in self.cells() {
            let mean = c.iter().map(|&p| values[p]).sum::<f64>() / 4.0;
            let stress = times * self.stress * (mean - self.reference);
            for (k, &p) in c.iter().enumerate() {
                for axis in 0..2 {
                    // The gradient of a shape function, over the cell.
                    out[2 * p + axis] += stress * CORNERS[k][axis] * size[1 - axis] / 2.0;
                }
            }
        }
    }
}

/// The bars with the steps in which their ends have these temperatures.
fn problem(method: &str) -> Problem {
    let bar = |name: &str, k: usize| {
        let [from, to] = [BARS[k], BARS[k + 1]];
        let cells = if k == 0 { 8 } else { 10 };
        format!(
            "[body.{name}]\nmaterial = \"m\"\ngenerate.rectangle = {{ from = [{from}, 0], to = [{to}, 0.1], cells = [{cells}, 2] }}\n"
        )
    };
    let text = format!(
        r#"
format = 1
model.space = "plane-stress"
solver.method = "{method}"
quality.gate = "off"

{}
{}
[material.m]
isotropic = {{ young = 10e6, poisson = 0.3 }}

[interface.gap]
secondary = "one.right"
primary = "two.left"

[support.left]
set = "one.left"
x = 0

[support.right]
set = "two.right"
x = 0

[support.first]
set = "one.bottom"
y = 0

[support.second]
set = "two.bottom"
y = 0

[[step]]
increments.fixed = 4

[[step]]
increments.fixed = 12

[[step]]
increments.fixed = 12

[[step]]
increments.fixed = 8
"#,
        bar("one", 0),
        bar("two", 2)
    );
    support::problem(&text)
}

fn setup(problem: &Problem) -> Setup {
    let built = problem.build(Path::new("."));
    let mut setup = built.unwrap_or_else(|e| panic!("{e}"));
    let field = Conduction {
        mesh: Arc::clone(&setup.model.mesh),
        conductivity: 250.0,
        conductance: 2000.0,
        stress: STRESS,
        reference: 100.0,
        ends: vec![
            (0.0, 500.0, 100.0),
            (1.0, 500.0, 600.0),
            (2.0, 500.0, 850.0),
            (3.0, 500.0, 100.0),
        ],
    };
    setup.model.actions.fields.push(Arc::new(field));
    setup
}

/// The temperature at the right end of the left bar, and whether the bars touch.
fn end(simulation: &Simulation) -> (f64, bool) {
    let view = simulation.view();
    let mesh = &view.model.mesh;
    let corner = mesh.points.iter();
    let corner = corner
        .enumerate()
        .find(|(_, x)| x[0] == BARS[1] && x[1] == 0.1);
    let (p, _) = corner.expect("a corner");
    let touches = !look::joined(support::contact(simulation)).is_empty();
    (view.frame.fields[0][p], touches)
}

#[test]
fn heat_closes_a_gap_and_flows_through_it() {
    for method in ["sparse", "condensed"] {
        let problem = problem(method);
        // Temperature at the gap, with the flow 0.1 ΔT / (0.4/250 + 1/2000 + 0.5/250) where it is closed. Faces have the area of bars that have expanded.
        let wanted = [
            (500.0, false),
            (539.0244, true),
            (636.5854, true),
            (500.0, false),
        ];
        for (steps, (temperature, touches)) in wanted.into_iter().enumerate() {
            let mut problem = problem.clone();
            problem.step.truncate(steps + 1);
            let mut simulation = Simulation::new(setup(&problem)).expect("a sound problem");
            simulation
                .run(&mut [])
                .unwrap_or_else(|e| panic!("{method}: {e}"));
            let (found, touching) = end(&simulation);
            assert_eq!(touching, touches, "{method}, step {steps}: {found}");
            let close = (found - temperature).abs() < 2e-5 * (temperature - 100.0);
            assert!(close, "{method}, step {steps}: {found}");
        }
    }
}

#[test]
fn a_checkpoint_holds_the_field() {
    for method in ["sparse", "condensed"] {
        let problem = problem(method);
        restart::check_setups(method, &|| setup(&problem), 3);
    }
}

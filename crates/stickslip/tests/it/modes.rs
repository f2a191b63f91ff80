//! Modes: real ones against closed forms and dense solutions of the same matrices, those of steady sliding against models of a few degrees of freedom and an exact continuum.

use std::f64::consts::{PI, TAU};

use crate::support;
use stickslip::linear::{DenseLu, general};
use stickslip::modal::{Export, ModalOutcome};
use support::{build, complaint, problem};

/// What the last step without increments of a problem has found.
pub fn modes(text: &str) -> ModalOutcome {
    let mut simulation = build(&problem(text)).unwrap_or_else(|e| panic!("{e}\n{text}"));
    simulation
        .run(&mut [])
        .unwrap_or_else(|e| panic!("{e}\n{text}"));
    simulation.run.modes.pop().expect("modes")
}

pub fn near(found: f64, expected: f64, tolerance: f64) {
    assert!(
        (found - expected).abs() <= tolerance,
        "{found:.12} is not {expected:.12}: {:e} apart",
        found - expected
    );
}

/// An exported matrix written out.
fn dense(outcome: &ModalOutcome, name: &str) -> (usize, Vec<f64>) {
    let matrix = outcome.export.iter().find(|e| e.name == name);
    let Export {
        shape: [rows, columns],
        symmetric,
        ref entries,
        ..
    } = *matrix.unwrap_or_else(|| panic!("no matrix {name}"));
    let mut out = vec![0.0; rows * columns];
    for &(i, j, v) in entries {
        out[i * columns + j] += v;
        if symmetric && i != j {
            out[j * columns + i] += v;
        }
    }
    (rows, out)
}

/// `K`, `C` and `M` with friction, written out, from exported parts.
pub fn matrices(outcome: &ModalOutcome) -> (usize, [Vec<f64>; 3]) {
    let (n, mut k) = dense(outcome, "stiffness");
    let (_, m) = dense(outcome, "mass");
    let has = outcome.export.iter().any(|e| e.name == "damping");
    let mut c = if has {
        dense(outcome, "damping").1
    } else {
        vec![0.0; n * n]
    };
    for (name, to) in [("friction", &mut k), ("drag", &mut c)] {
        let (_, left) = dense(outcome, &format!("{name}-left"));
        let (_, right) = dense(outcome, &format!("{name}-right"));
        let q = left.len() / n;
        for i in 0..n {
            for j in 0..n {
                let pairs = (0..q).map(|p| left[i * q + p] * right[j * q + p]);
                to[i * n + j] += pairs.sum::<f64>();
            }
        }
    }
    (n, [k, c, m])
}

/// `A⁻¹ B` with `columns` columns, by rows.
fn solved(n: usize, a: &[f64], b: &[f64], columns: usize) -> Vec<f64> {
    let lu = DenseLu::new(n, a);
    let mut out = vec![0.0; n * columns];
    for j in 0..columns {
        let mut x: Vec<f64> = (0..n).map(|i| b[i * columns + j]).collect();
        lu.solve(&mut x);
        x.iter()
            .enumerate()
            .for_each(|(i, x)| out[i * columns + j] = *x);
    }
    out
}

/// All eigenvalues of `λ² M + λ C + K` that do not lie below the real axis, by dense matrices alone.
fn companion(outcome: &ModalOutcome) -> Vec<[f64; 2]> {
    companion_of(matrices(outcome))
}

fn companion_of((n, [k, c, m]): (usize, [Vec<f64>; 3])) -> Vec<[f64; 2]> {
    let (k, c) = (solved(n, &m, &k, n), solved(n, &m, &c, n));
    let mut a = vec![0.0; 4 * n * n];
    for i in 0..n {
        a[i * 2 * n + n + i] = 1.0;
        for j in 0..n {
            a[(n + i) * 2 * n + j] = -k[i * n + j];
            a[(n + i) * 2 * n + n + j] = -c[i * n + j];
        }
    }
    let mut all = general(2 * n, &a).unwrap().0;
    all.retain(|z| z[1] >= 0.0);
    all.sort_by(|a, b| a[0].hypot(a[1]).total_cmp(&b[0].hypot(b[1])));
    all
}

/// A rod that only stretches, held at one end.
fn rod(cells: usize) -> String {
    format!(
        r#"
format = 1
model.space = "plane-stress"
body.rod = {{ generate.rectangle = {{ to = [2, 0.1], cells = [{cells}, 1] }}, material = "m" }}
material.m.isotropic = {{ young = 4.0, poisson = 0.0, density = 1.0 }}
support.wall = {{ set = "rod.left", x = 0 }}
support.guide = {{ set = "rod", y = 0 }}
[[step]]
modes = {{ count = 3 }}
"#
    )
}

#[test]
fn a_rod_vibrates_as_waves_run_to_and_fro() {
    let errors = [20, 40].map(|cells| {
        let outcome = modes(&rod(cells));
        assert_eq!(outcome.modes.len(), 3);
        // c/(4 L), and odd multiples of it.
        let exact = |k: usize| (2 * k + 1) as f64 * 2.0 / 8.0;
        for (k, mode) in outcome.modes.iter().enumerate() {
            assert!(mode.frequency > exact(k), "a consistent mass is too fast");
            assert!(mode.residual < 1e-9, "{:e}", mode.residual);
            // 8 / ((2 k + 1)² π²) of the mass moves along.
            let odd = (2 * k + 1) as f64;
            let part = mode.effective_mass[0] / outcome.masses[0];
            near(part, 8.0 / (odd * PI).powi(2), 2e-2);
        }
        near(outcome.masses[0], 0.2, 1e-12);
        outcome.modes[0].frequency / exact(0) - 1.0
    });
    // (π h / 4 L)² / 6 of the frequency, of the second order.
    near(
        errors[0],
        (PI / 4.0 * 0.1 / 2.0_f64).powi(2) * 4.0 / 24.0,
        2e-6,
    );
    near(errors[0] / errors[1], 4.0, 2e-2);
}

const BRICK: &str = r#"
format = 1
model.space = "solid"
body.brick = { generate.box = { to = [3, 1.1, 0.7], cells = [5, 2, 2] }, material = "m" }
material.m.isotropic = { young = 2e3, poisson = 0.3, density = 5.0 }
"#;

#[test]
fn a_free_body_has_six_modes_without_strain() {
    let outcome = modes(&format!("{BRICK}\n[[step]]\nmodes = {{ count = 9 }}\n"));
    assert_eq!(outcome.modes.len(), 9);
    for mode in &outcome.modes[..6] {
        assert_eq!(mode.frequency, 0.0);
    }
    assert!(outcome.modes[6].frequency > 0.1);
    // They take along all of the mass, the others none.
    for (i, &mass) in outcome.masses.iter().enumerate() {
        let of = |modes: &[stickslip::modal::Mode]| {
            modes.iter().map(|m| m.effective_mass[i]).sum::<f64>()
        };
        near(of(&outcome.modes[..6]) / mass, 1.0, 1e-7);
        near(of(&outcome.modes[6..]) / mass, 0.0, 1e-7);
    }
    near(outcome.masses[0], 5.0 * 3.0 * 1.1 * 0.7, 1e-10);
    assert!(outcome.notes.iter().any(|n| n.contains("without strain")));
}

/// A stack that was pressed, has been let go and lies on one point: what nothing holds has no frequency, whatever rounding makes of it, and what strains keeps its own.
#[test]
fn modes_of_what_nothing_holds_any_more_are_found() {
    for cells in [1, 2] {
        let outcome = modes(&format!(
            r#"
format = 1
model.space = "plane-stress"
material.a.isotropic = {{ young = 5e5, poisson = 0.25, density = 9e-8 }}
material.b.isotropic = {{ young = 1.2e6, poisson = 0.24, density = 9e-8 }}
body.lower = {{ generate.rectangle = {{ from = [-70, -70], to = [70, 0], cells = [8, 4] }}, material = "a" }}
body.upper = {{ generate.rectangle = {{ from = [-44, 0], to = [44, 70], cells = [6, 3] }}, material = "b" }}
body.cap = {{ generate.rectangle = {{ from = [-44, 70], to = [44, 99], cells = [5, {cells}] }}, material = "a" }}
interface.joint = {{ secondary = "upper.bottom", primary = "lower.top", friction.coulomb.mu = 0.45, roles = "as-named" }}
interface.cap-tie = {{ secondary = "cap.bottom", primary = "upper.top", tied = true }}
support.base = {{ set = "lower.bottom", x = 0, y = 0 }}
support.guide = {{ set = "cap.top", x = 0.44, amplitude = "slide" }}
amplitude.press.table = [[0, 0], [1, 1], [2, 0]]
amplitude.slide.table = [[0, 0], [1, 1]]
load.press = {{ set = "cap.top", pressure.value = 357, amplitude = "press" }}
quality.gate = "off"
step = [
    {{ increments.fixed = 2 }},
    {{ increments.fixed = 6 }},
    {{ name = "slide", increments.fixed = 2, steady.velocity.joint = [2e4, 0] }},
    {{ complex-modes.count = 4 }},
]
"#
        ));
        assert_eq!(outcome.modes.len(), 4, "{cells}");
        for mode in &outcome.modes {
            assert!(mode.residual < 1e-7, "{cells}: {}", mode.residual);
        }
        // The lower body by itself does not strain below this.
        assert!(outcome.modes[0].frequency < 1.0 && outcome.modes[3].frequency > 4e3);
    }
}

/// A block that was pressed with 10⁹ Pa, dragged and released: points that keep 10⁻⁵ Pa are no contact, and modes are those of two bodies.
#[test]
fn a_pressure_that_is_rounding_is_no_contact_in_modes() {
    let text = r#"
format = 1
model.space = "solid"
support.base = { set = "lower.bottom", x = 0, y = 0, z = 0 }
support.press = { set = "head", z = -0.0146, amplitude = "press" }
support.guide = { set = "head", x = 0.01095, y = 0, rotation-x = 0, rotation-y = 0, rotation-z = 0, amplitude = "slide" }
amplitude.press.table = [[0, 0], [1, 1], [2, 0]]
amplitude.slide.table = [[0, 0], [1, 1]]
reference.head = { point = [0, 0, 1.33955] }
coupling.head.kinematic = { reference = "head", set = "upper.top" }
body.lower = { generate.box = { from = [-1.825, -0.9125, -1.54395], to = [1.825, 0.9125, 0], cells = [2, 2, 2] }, material = "low" }
material.low.isotropic = { young = 4.08e10, poisson = 0.178, density = 11700 }
body.upper = { generate.box = { from = [-1.095, -0.9125, 0], to = [1.095, 0.9125, 1.33955], cells = [2, 2, 2], element = "tet4" }, material = "up" }
material.up.isotropic = { young = 1.787e11, poisson = 0.273, density = 11700 }
"#;
    let joint = r#"
interface.joint = { secondary = "upper.bottom", primary = "lower.top", friction.coulomb.mu = 0.234, roles = "as-named" }
step = [
    { increments.fixed = 4 },
    { increments.fixed = 4 },
    { increments.fixed = 2, steady.velocity.joint = [18.7, 0, 0] },
    { complex-modes.count = 4 },
]
"#;
    let apart = "step = [{}, { modes.count = 4 }]\n";
    let [released, apart] = [joint, apart].map(|rest| modes(&format!("{text}{rest}")).modes);
    assert_eq!((released.len(), apart.len()), (4, 4));
    for (a, b) in released.iter().zip(&apart) {
        near(a.frequency, b.frequency, 1e-6);
        assert!(a.growth.abs() < 1e-6, "{}", a.growth);
    }
}

#[test]
fn real_modes_are_those_of_the_dense_matrices() {
    let held = "support.left = { set = \"brick.left\", x = 0, y = 0, z = 0 }";
    let asked = "[[step]]\ncomplex-modes = { count = 1, export = true }\n[[step]]\nmodes = { count = 25 }\n";
    let mut simulation = build(&problem(&format!("{BRICK}{held}\n{asked}"))).unwrap();
    simulation.run(&mut []).unwrap();
    let (n, [k, _, m]) = matrices(&simulation.modes[0]);
    let of_inverse = general(n, &solved(n, &m, &k, n)).unwrap().0;
    let mut dense: Vec<f64> = of_inverse.iter().map(|z| z[0]).collect();
    dense.sort_by(f64::total_cmp);
    assert_eq!(dense.len(), n);
    let ours = &simulation.modes[1].modes;
    assert_eq!(ours.len(), 25);
    for (mode, value) in ours.iter().zip(&dense) {
        near(mode.frequency, value.sqrt() / TAU, 1e-9 * mode.frequency);
        assert!(mode.residual < 1e-8, "{:e}", mode.residual);
    }
    // A range is the part of the list that lies in it.
    let (a, b) = (ours[4].frequency * 0.999, ours[11].frequency * 1.001);
    let range = format!("[[step]]\nmodes = {{ count = 100, from = {a:?}, to = {b:?} }}\n");
    let some = modes(&format!("{BRICK}{held}\n{range}"));
    assert_eq!(some.modes.len(), 8);
    for (mode, all) in some.modes.iter().zip(&ours[4..]) {
        near(mode.frequency, all.frequency, 1e-9 * all.frequency);
    }
    let above = format!("[[step]]\nmodes = {{ count = 5, from = {a:?} }}\n");
    let above = modes(&format!("{BRICK}{held}\n{above}"));
    near(
        above.modes[4].frequency,
        ours[8].frequency,
        1e-9 * ours[8].frequency,
    );
}

/// Two halves of the rod above, one on the other.
fn halves(join: &str) -> String {
    format!(
        r#"
format = 1
model.space = "plane-stress"
body.a = {{ generate.rectangle = {{ to = [1, 0.1], cells = [20, 1] }}, material = "m" }}
body.b = {{ generate.rectangle = {{ from = [1, 0], to = [2, 0.1], cells = [20, 1] }}, material = "m" }}
material.m.isotropic = {{ young = 4.0, poisson = 0.0, density = 1.0 }}
support.wall = {{ set = "a.left", x = 0 }}
support.guide-a = {{ set = "a", y = 0 }}
support.guide-b = {{ set = "b", y = 0 }}
{join}
"#
    )
}

#[test]
fn ties_equations_and_closed_contacts_join_as_one_mesh_does() {
    let whole = modes(&rod(40));
    let tied = r#"interface.join = { secondary = "b.left", primary = "a.right", tied = true }
[[step]]
modes = { count = 3 }"#;
    let equation = r#"coupling.join.equation = { terms = [{ set = "a.right", component = "x" }, { set = "b.left", component = "x", factor = -1 }] }
[[step]]
modes = { count = 3 }"#;
    let pressed = r#"interface.join = { secondary = "b.left", primary = "a.right", friction.coulomb = { mu = 0.3 } }
load.press = { set = "b.right", traction = { value = [-0.01, 0] } }
[[step]]
[[step]]
modes = { count = 3 }"#;
    for (join, tolerance) in [(tied, 1e-5), (equation, 1e-6), (pressed, 1e-5)] {
        let outcome = modes(&halves(join));
        for (a, b) in outcome.modes.iter().zip(&whole.modes) {
            near(a.frequency / b.frequency, 1.0, tolerance);
        }
    }
    let open = modes(&halves("[[step]]\nmodes = { count = 3 }"));
    assert_eq!(open.modes[0].frequency, 0.0, "nothing joins them");
}

/// A flat rigid block of mass 1 on a belt, pressed by `load`, with its own friction and springs.
pub fn block(belt: &str, law: &str, more: &str) -> String {
    format!(
        r#"
format = 1
model.space = "plane-strain"
body.block = {{ rigid = true, generate.rectangle = {{ from = [-0.5, 0], to = [0.5, 0.1], cells = [2, 2] }}, material = "any" }}
material.any.isotropic = {{ young = 1e6, poisson = 0.0, density = 10.0 }}
set.centre = {{ of = "block", point = [0, 0.05] }}
obstacle.belt.plane = {{ point = [0, 0], normal = [0, 1] }}
output.every = 0
interface.rub = {{ secondary = "block.bottom", primary = "belt", {law}, primary-velocity = [{belt}, 0] }}
{more}
"#
    )
}

/// [Hoffmann et al. 2002]: two springs that couple what friction drives.
fn hoffmann(mu: f64, dashpots: [f64; 2], steps: &str) -> String {
    let springs: String = [(11.0, 150.0_f64), (20.0, 30.0)]
        .iter()
        .enumerate()
        .map(|(i, (k, degrees))| {
            let (s, c) = degrees.to_radians().sin_cos();
            format!("coupling.k{i}.spring = {{ stiffness = {k:?}, terms = [{{ set = \"centre\", component = \"x\", factor = {c:?} }}, {{ set = \"centre\", component = \"y\", factor = {s:?} }}] }}\n")
        })
        .collect();
    let dashpots: String = ["x", "y"]
        .iter()
        .zip(dashpots)
        .filter(|(_, c)| *c > 0.0)
        .map(|(axis, c)| format!("coupling.d{axis}.dashpot = {{ coefficient = {c:?}, terms = [{{ set = \"centre\", component = \"{axis}\" }}] }}\n"))
        .collect();
    let law = format!("normal.linear = {{ c = 11.0 }}, friction.coulomb = {{ mu = {mu:?} }}");
    let more = format!(
        "{springs}{dashpots}load.press = {{ set = \"centre\", nodal-force = {{ value = [0, -1e-3] }} }}\n[[step]]\nsteady = {{}}\n{steps}"
    );
    block("-1", &law, &more)
}

const COMPLEX: &str = "[[step]]\ncomplex-modes = { count = 3 }\n";

/// The fastest growth, with its angular frequency.
pub fn worst(outcome: &ModalOutcome) -> [f64; 2] {
    let all = outcome.modes.iter();
    let worst = all.max_by(|a, b| a.growth.total_cmp(&b.growth));
    let worst = worst.expect("a mode");
    [worst.growth, TAU * worst.frequency]
}

#[test]
fn two_degrees_of_freedom_flutter_as_their_characteristic_equation_says() {
    for (mu, growth, omega) in [
        (0.8, 0.407292624, 4.600639877),
        (1.0, 0.515653192, 4.611496310),
    ] {
        let outcome = modes(&hoffmann(mu, [0.0; 2], COMPLEX));
        let [g, w] = worst(&outcome);
        near(g, growth, 1e-9);
        near(w, omega, 1e-9);
        for mode in &outcome.modes {
            assert!(mode.residual < 1e-11, "{:e}", mode.residual);
            near(mode.feed.iter().sum(), mode.growth, 1e-9);
        }
        assert_eq!(outcome.sliding, ["rub"]);
    }
    // Stable below.
    let [g, _] = worst(&modes(&hoffmann(0.47, [0.0; 2], COMPLEX)));
    near(g, 0.0, 1e-9);
}

/// What is found without motion is what motion does: a block that is kicked as it slides swings ever more widely, at the rate and frequency of the eigenvalue, and
/// less and less where that decays.
#[test]
fn motion_grows_and_decays_as_eigenvalues_say() {
    let run = "[[step]]\nname = \"run\"\nduration = 14\nincrements.fixed = 7000\ndynamic = { scheme.newmark = {} }\n";
    let kick = "initial.kick = { set = \"block\", velocity = [2e-4, 0], step = \"run\" }\nprobe.m = { of = \"block\", point = [0, 0.05] }\n";
    for damping in [0.0, 1.2] {
        let dashpots = [damping; 2];
        // Equal dashpots make λ² + cλ of λ².
        let [re, im] = [0.407292624_f64, 4.600639877];
        let square = [0.25 * damping * damping + re * re - im * im, 2.0 * re * im];
        let size = square[0].hypot(square[1]);
        let growth = (0.5 * (size + square[0])).sqrt() - 0.5 * damping;
        let omega = (0.5 * (size - square[0])).sqrt();
        let text = hoffmann(0.8, dashpots, run)
            .replacen("-1e-3", "-1", 1)
            .replacen("load.press", &format!("{kick}load.press"), 1);
        let record = support::run(&problem(&text)).unwrap_or_else(|e| panic!("{e}"));
        let rows = record.increments.iter().map(|(_, row)| row);
        let course: Vec<[f64; 2]> = rows
            .filter(|row| row.get("STEP") == Some(2.0))
            .map(|row| ["TIME", "m.U1"].map(|name| row.get(name).expect("a column")))
            .collect();
        // Turning points, after the partner of the mode, which decays by as much more, has gone; from one to the next it does not matter about what they swing.
        let turns: Vec<[f64; 2]> = course
            .windows(3)
            .filter(|w| (w[1][1] - w[0][1]) * (w[2][1] - w[1][1]) <= 0.0 && w[1][0] > 9.0)
            .map(|w| w[1])
            .collect();
        let n = turns.len();
        assert!(n >= 5, "{turns:?}");
        let swing = |k: usize| (turns[k + 1][1] - turns[k][1]).abs();
        let time = turns[n - 2][0] - turns[0][0];
        let rate = (swing(n - 2) / swing(0)).ln() / time;
        let turning = PI * (n - 2) as f64 / time;
        assert_eq!(growth > 0.0, damping == 0.0);
        near(rate, growth, 1e-2 * growth.abs());
        near(turning, omega, 1e-2 * omega);
    }
}

/// A motion that begins along the unstable mode grows as the eigenvalue says from its first cycle on, and the other mode that was found decays with its own.
#[test]
fn a_motion_that_begins_along_a_mode_has_its_eigenvalue() {
    let run = |kick: &str| {
        let steps = format!(
            "{COMPLEX}[[step]]\nname = \"run\"\nduration = 8\nincrements.fixed = 3200\ndynamic = {{ scheme.newmark = {{}} }}\nkick = {{ {kick} }}\n"
        );
        let text = hoffmann(0.8, [0.0; 2], &steps).replacen("-1e-3", "-1", 1);
        let mut simulation = build(&problem(&text)).unwrap_or_else(|e| panic!("{e}"));
        simulation.run(&mut []).unwrap_or_else(|e| panic!("{e}"));
        simulation
    };
    let fastest = run("amplitude = 1e-4");
    let [growing] = &fastest.summary.vibrations.growth[..] else {
        panic!("{:?}", fastest.summary.vibrations.growth);
    };
    near(growing.growth, 0.407292624, 1e-8);
    near(growing.measured_growth, 0.407292624, 1e-3 * 0.4);
    near(growing.measured_frequency, 4.600639877 / TAU, 1e-4);
    near(growing.cycles, 8.0 * growing.frequency, 1e-2);
    let grown = growing.amplitudes[1] / growing.amplitudes[0];
    near(grown / (8.0 * growing.growth).exp(), 1.0, 5e-3);
    let last = &fastest.summary.last;
    assert!(last["MODE.REST"] < 1e-3, "{last:?}");
    // What the kick brought in is in the ledger, but for what it stored in the contact.
    let energy = &fastest.summary.balance.energy;
    assert!(energy.residual.abs() < 1e-5 * energy.friction, "{energy:?}");
    let modes = &fastest.modes[0].modes;
    let decaying = (0..modes.len()).min_by(|&a, &b| modes[a].growth.total_cmp(&modes[b].growth));
    let number = decaying.unwrap() + 1;
    let slowest = run(&format!("amplitude = 1e-3, mode = {number}"))
        .run
        .summary
        .vibrations
        .growth;
    near(slowest[0].growth, -0.407292624, 1e-8);
    // Its partner comes up out of rounding.
    let grown = slowest[0].amplitudes[1] / slowest[0].amplitudes[0];
    assert!(grown < 0.1, "{slowest:?}");
}

#[test]
fn a_motion_along_a_mode_needs_one_and_has_to_move() {
    let along = |steps: &str| complaint(&hoffmann(0.8, [0.0; 2], steps));
    let moving = "dynamic = { scheme.newmark = {} }\n";
    for (steps, words) in [
        (
            format!("[[step]]\n{moving}kick = {{ amplitude = 1 }}\n"),
            "no modes are known",
        ),
        (
            format!("{COMPLEX}[[step]]\nkick = {{ amplitude = 1 }}\n"),
            "by an implicit scheme",
        ),
        (
            format!("{COMPLEX}[[step]]\n{moving}kick = {{ amplitude = 1, mode = 4 }}\n"),
            "there is no mode 4",
        ),
    ] {
        let text = along(&steps);
        assert!(text.contains(words), "{steps}: {text}");
    }
}

/// The map over the friction of 0.5.
fn hoffmann_map(dashpots: [f64; 2]) -> ModalOutcome {
    let map = "[[step]]\ncomplex-modes = { count = 3, map = { to = 2, points = 21 } }\n";
    modes(&hoffmann(0.5, dashpots, map))
}

#[test]
fn a_map_finds_where_stability_is_lost_and_what_damping_does_to_it() {
    let outcome = hoffmann_map([0.0; 2]);
    assert_eq!(outcome.points[1], 3, "points that slide");
    let map = outcome.map.as_ref().unwrap();
    near(map.mu, 0.5, 1e-12);
    assert_eq!(map.rows.len(), 21);
    assert_eq!(map.critical.len(), 1);
    let [factor, frequency] = map.critical[0];
    near(0.5 * factor, 0.472377493, 1e-9);
    near(TAU * frequency, 4.582575695, 1e-5);
    assert!(map.residual < 1e-10, "{:e}", map.residual);
    // The last row is twice the friction.
    let last = &map.rows[20].modes;
    let growth = last.iter().fold(0.0, |m: f64, v| m.max(v[1]));
    near(growth, 0.515653192, 1e-9);
    // Damping of both stabilises, damping of one more than of the other does the opposite.
    let equal = hoffmann_map([0.1, 0.1]);
    near(
        0.5 * equal.map.as_ref().unwrap().critical[0][0],
        0.477276223,
        1e-9,
    );
    assert!(!equal.notes.iter().any(|n| n.contains("earlier")));
    let unequal = hoffmann_map([0.02, 0.2]);
    let map = unequal.map.as_ref().unwrap();
    assert!(0.5 * map.critical[0][0] < 0.4723, "{:?}", map.critical);
    near(0.5 * map.undamped.unwrap(), 0.472377493, 1e-9);
    assert!(unequal.notes.iter().any(|n| n.contains("earlier")));
}

/// VERIFICATION F2, and the form of Hultén: matrices with a unit mass, by springs along and across, and friction.
#[test]
fn mode_coupling_begins_at_the_closed_form() {
    // K = [[2, 0.3 - 2 μ], [0.3, 1.5]]: what couples is a spring along the diagonal.
    let (a, b, c, kc) = (2.0, 1.5, 0.3, 2.0);
    // Contact has more than the whole of the stiffness across: springs take from it what is too much.
    let springs = format!(
        "coupling.x.spring = {{ stiffness = {:?}, terms = [{{ set = \"centre\", component = \"x\" }}] }}\n\
         coupling.d.spring = {{ stiffness = {c:?}, terms = [{{ set = \"centre\", component = \"x\" }}, {{ set = \"centre\", component = \"y\" }}] }}\n",
        a - c
    );
    // With a contact stiffness of what is left across.
    let across = b - c;
    let mu_of = |mu: f64| mu * kc / across;
    let law = |mu: f64| {
        format!(
            "normal.linear = {{ c = {across:?} }}, friction.coulomb = {{ mu = {:?} }}",
            mu_of(mu)
        )
    };
    let steps = "load.press = { set = \"centre\", nodal-force = { value = [0, -1e-3] } }\n[[step]]\nsteady = {}\n[[step]]\ncomplex-modes = { count = 3, map = { to = 1, points = 11 } }\n";
    let outcome = modes(&block("-1", &law(0.5), &format!("{springs}{steps}")));
    near(worst(&outcome)[0], 0.144304, 5e-7);
    let map = outcome.map.unwrap();
    near(0.5 * map.critical[0][0], 0.2541666667, 1e-9);
    near(TAU * map.critical[0][1], 1.3228757, 1e-5);
}

/// BENCHMARKS Q2, the form of Hultén: a mass between two belts at right angles, each of which drives what the other presses. `K = [[k₁, -μ k₂], [μ k₁, k₂]]` of a unit mass, with dashpots.
fn hulten(mu: f64, [eta_1, eta_2]: [f64; 2], steps: &str) -> ModalOutcome {
    let [w1, w2] = [TAU * 100.0, TAU * 75.0];
    let dashpots: String = [("x", eta_1 * w1), ("y", eta_2 * w2)]
        .iter()
        .filter(|(_, c)| *c > 0.0)
        .map(|(axis, c)| format!("coupling.d{axis}.dashpot = {{ coefficient = {c:?}, terms = [{{ set = \"centre\", component = \"{axis}\" }}] }}\n"))
        .collect();
    // It is pressed where the forces of both belts meet, so that nothing turns it.
    let t = 0.5 * (1.0 - mu) / (1.0 + mu * mu);
    let [x, y] = [t - 0.5, mu * t];
    let text = format!(
        r#"
format = 1
model.space = "plane-strain"
body.block = {{ rigid = true, generate.rectangle = {{ x = [-0.5, {x:?}, 0, 0.5], y = [-0.5, 0, {y:?}, 0.5] }}, material = "any" }}
material.any.isotropic = {{ young = 1e6, poisson = 0.0, density = 1.0 }}
set.centre = {{ of = "block", point = [0, 0] }}
set.pressed = {{ of = "block", point = [{x:?}, {y:?}] }}
obstacle.floor.plane = {{ point = [0, -0.5], normal = [0, 1] }}
obstacle.wall.plane = {{ point = [-0.5, 0], normal = [1, 0] }}
output.every = 0
interface.floor = {{ secondary = "block.bottom", primary = "floor", normal.linear = {{ c = {k2:?} }}, friction.coulomb = {{ mu = {mu:?} }}, primary-velocity = [-1, 0] }}
interface.wall = {{ secondary = "block.left", primary = "wall", normal.linear = {{ c = {k1:?} }}, friction.coulomb = {{ mu = {mu:?} }}, primary-velocity = [0, 1] }}
{dashpots}
load.press = {{ set = "pressed", nodal-force = {{ value = [{fx:?}, {fy:?}] }} }}
[[step]]
steady = {{}}
{steps}
"#,
        k1 = w1 * w1,
        k2 = w2 * w2,
        fx = -(1.0 - mu) * 1e-3,
        fy = -(1.0 + mu) * 1e-3,
    );
    modes(&text)
}

#[test]
fn a_mass_between_two_belts_flutters_as_the_form_of_hulten_says() {
    let map = "[[step]]\ncomplex-modes = { count = 3, map = { to = 1, points = 11 } }\n";
    for (damping, critical) in [
        ([0.0, 0.0], 0.291666667),
        ([0.02, 0.02], 0.289367126),
        ([0.02, 0.06], 0.271790034),
    ] {
        let outcome = hulten(0.4, damping, map);
        let map = outcome.map.as_ref().unwrap();
        assert_eq!(map.critical.len(), 1, "{:?}", map.critical);
        near(0.4 * map.critical[0][0], critical, 1e-9);
        let exact = match damping {
            [0.0, 0.0] => [72.358621299, 560.054379155],
            [0.02, 0.02] => [66.881360038, 559.191752923],
            _ => continue,
        };
        let [g, w] = worst(&outcome);
        near(g, exact[0], 1e-9 * exact[1]);
        near(w, exact[1], 1e-9 * exact[1]);
    }
}

/// VERIFICATION F1, the block of Oden and Martins: friction that pitches it and a pressure `c δ²` let it flutter. Its sums over contact points stand for the integrals.
#[test]
fn a_block_pitches_as_its_two_equations_say() {
    let (mu, h, cells) = (0.7, 0.45, 8);
    // Half the width, mass and weight are one.
    let density = 1.0 / (4.0 * h);
    let text = format!(
        r#"
format = 1
model.space = "plane-strain"
body.block = {{ rigid = true, generate.rectangle = {{ from = [-1, -{h}], to = [1, {h}], cells = [{cells}, 2] }}, material = "any" }}
material.any.isotropic = {{ young = 1e6, poisson = 0.0, density = {density:?} }}
set.centre = {{ of = "block", point = [0, 0] }}
obstacle.belt.plane = {{ point = [0, -{h}], normal = [0, 1] }}
output.every = 0
interface.rub = {{ secondary = "block.bottom", primary = "belt", normal.power-law = {{ c = 1.0, m = 2.0 }}, friction.coulomb = {{ mu = {mu} }}, primary-velocity = [1, 0] }}
coupling.pull.spring = {{ stiffness = 50.0, terms = [{{ set = "centre", component = "x" }}] }}
load.weight = {{ set = "centre", nodal-force = {{ value = [0, -1] }} }}
solver.tolerance = 1e-13
[[step]]
steady = {{}}
[[step]]
complex-modes = {{ count = 3 }}
"#
    );
    let outcome = modes(&text);
    let size = 2.0 / cells as f64;
    let points: Vec<[f64; 2]> = (0..=cells)
        .map(|i| {
            let inside = i > 0 && i < cells;
            [
                -1.0 + size * i as f64,
                if inside { size } else { 0.5 * size },
            ]
        })
        .collect();
    let sum = |of: &dyn Fn(f64) -> f64| points.iter().map(|[s, w]| w * of(*s)).sum::<f64>();
    // Penetration d + e s in balance with the weight and the moment of friction, by Newton's method.
    let (mut d, mut e) = (0.7, 0.0);
    for _ in 0..50 {
        let p = |s: f64| (d + e * s).powi(2);
        let slope = |s: f64| 2.0 * (d + e * s);
        let rest = [sum(&p) - 1.0, sum(&|s| p(s) * s) - mu * h];
        let [a, b, c] = [0, 1, 2].map(|k| sum(&|s| slope(s) * s.powi(k)));
        let determinant = a * c - b * b;
        d -= (c * rest[0] - b * rest[1]) / determinant;
        e -= (a * rest[1] - b * rest[0]) / determinant;
    }
    let [k0, k1, k2] = [0, 1, 2].map(|k| sum(&|s| 2.0 * (d + e * s) * s.powi(k)));
    let inertia = (4.0 + 4.0 * h * h) / 12.0;
    let (a, d) = (k0, (k2 - mu * h * k1) / inertia);
    let product = k1 * (k1 - mu * h * k0) / inertia;
    // (a - ω²)(d - ω²) = product.
    let (mean, under) = (0.5 * (a + d), 0.25 * (a - d).powi(2) + product);
    assert!(under < 0.0, "flutter");
    let size = mean.hypot((-under).sqrt());
    let (g, w) = ((0.5 * (size - mean)).sqrt(), (0.5 * (size + mean)).sqrt());
    for exact in [[g, w], [-g, w]] {
        let found = nearest(&outcome, exact);
        near(found[0], exact[0], 1e-9);
        near(found[1], exact[1], 1e-9);
    }
    let along = nearest(&outcome, [0.0, 50.0_f64.sqrt()]);
    near(along[1], 50.0_f64.sqrt(), 1e-9);
}

/// Two pads that are equal, each on a belt of its own: every mode comes twice.
#[test]
fn modes_of_equal_bodies_come_as_often_as_there_are_bodies() {
    let one = pad([0.6, 0.2], [100.0, 1e-2], "");
    let (head, tail) = one.split_once("[[step]]").unwrap();
    let copy: String = head
        .lines()
        .filter(|l| {
            l.starts_with("body.") || l.starts_with("interface.") || l.starts_with("support.")
        })
        .map(|l| {
            l.replace("body.", "body.second-")
                .replace("interface.", "interface.second-")
        })
        .map(|l| {
            l.replace("support.", "support.second-")
                .replace("\"pad.", "\"second-pad.")
                .replace("\"back.", "\"second-back.")
        })
        .map(|l| format!("{l}\n"))
        .collect();
    let asked = "[[step]]\ncomplex-modes = { count = 16 }\n";
    let both = modes(&format!("{head}{copy}[[step]]{tail}{asked}"));
    let single = modes(&format!("{head}[[step]]{tail}{}", asked.replace("16", "8")));
    assert_eq!(both.modes.len(), 16);
    for (k, mode) in both.modes.iter().enumerate() {
        let other = &single.modes[k / 2];
        let size = other.growth.hypot(TAU * other.frequency);
        near(mode.growth, other.growth, 1e-7 * size);
        near(mode.frequency, other.frequency, 1e-7 * size);
    }
}

/// BENCHMARKS Q2: a mass on a belt, with friction that falls with the speed.
pub fn mass_on_a_belt(speed: f64, asked: &str) -> ModalOutcome {
    let law = "friction.exponential-decay = { static = 0.5, kinetic = 0.3, decay = 10 }";
    let more = r#"
load.press = { set = "centre", nodal-force = { value = [0, -10] } }
coupling.k.spring = { stiffness = 100.0, terms = [{ set = "centre", component = "x" }] }
coupling.d.dashpot = { coefficient = 2.0, terms = [{ set = "centre", component = "x" }] }
support.guide = { set = "block", hold = ["y"] }
[[step]]
supports = []
steady = {}
"#;
    let asked = format!("{more}[[step]]\ncomplex-modes = {{ count = 1{asked} }}\n");
    modes(&block(&format!("{speed:?}"), law, &asked))
}

#[test]
fn a_mass_on_a_belt_loses_stability_at_the_speed_of_hopf() {
    let at = |speed: f64| worst(&mass_on_a_belt(speed, ""));
    for (speed, growth, omega) in [
        (0.05, 5.065306597, 8.622219498),
        (0.1, 2.678794412, 9.634524404),
        (0.2, 0.353352832, 9.993755139),
    ] {
        let [g, w] = at(speed);
        near(g, growth, 1e-9);
        near(w, omega, 1e-9);
    }
    let hopf = 0.1 * 10.0_f64.ln();
    near(at(hopf)[0], 0.0, 1e-9);
    assert!(at(hopf * 1.001)[0] < 0.0);
}

/// A pad that a belt drags along, of which friction falls with speed, and one that sticks to a wall.
pub fn pad([mu, fall]: [f64; 2], [young, press]: [f64; 2], asked: &str) -> String {
    format!(
        r#"
format = 1
model.space = "plane-strain"
body.pad = {{ generate.rectangle = {{ from = [0, 0], to = [1, 0.4], cells = [6, 3] }}, material = "m", rayleigh = {{ mass = 0.01, stiffness = 1e-4 }} }}
body.back = {{ generate.rectangle = {{ from = [0, 0.4], to = [1, 0.6], cells = [5, 1] }}, material = "n" }}
material.m.isotropic = {{ young = {young:?}, poisson = 0.3, density = 1.0 }}
material.n.isotropic = {{ young = 300.0, poisson = 0.2, density = 2.0 }}
obstacle.belt.plane = {{ point = [0, 0], normal = [0, 1] }}
output.every = 0
interface.rub = {{ secondary = "pad.bottom", primary = "belt", normal.linear = {{ c = 500.0 }}, friction.exponential-decay = {{ static = {}, kinetic = {mu:?}, decay = 0.5 }}, primary-velocity = [1, 0] }}
interface.stick = {{ secondary = "pad.top", primary = "back.bottom", normal.linear = {{ c = 2000.0 }}, friction.coulomb = {{ mu = 5.0 }}, enforcement.penalty = {{ stiffness = 3000.0 }} }}
support.back = {{ set = "back.top", x = 0, y = {:?} }}
[[step]]
steady = {{}}
{asked}
"#,
        mu + fall,
        -press
    )
}

#[test]
fn modes_of_a_sliding_pad_are_those_of_the_dense_matrices() {
    let asked = "[[step]]\ncomplex-modes = { count = 24, export = true }\n";
    let outcome = modes(&pad([0.6, 0.2], [100.0, 1e-2], asked));
    let [stick, slide, _] = outcome.points;
    assert_eq!(slide, 7);
    assert!(stick > 4, "{stick}");
    let dense = companion(&outcome);
    assert_eq!(outcome.modes.len(), 24);
    for mode in &outcome.modes {
        let ours = [mode.growth, TAU * mode.frequency];
        let away = |z: &[f64; 2]| (z[0] - ours[0]).hypot(z[1] - ours[1]);
        let off = dense.iter().map(away).fold(f64::INFINITY, f64::min);
        assert!(off < 1e-8 * ours[0].hypot(ours[1]), "{ours:?}: {off:e}");
        assert!(mode.residual < 1e-9, "{:e}", mode.residual);
        near(
            mode.feed.iter().sum(),
            mode.growth,
            1e-7 * ours[0].hypot(ours[1]),
        );
    }
    // None of the lowest is missing.
    let size = |m: &stickslip::modal::Mode| m.growth.hypot(TAU * m.frequency);
    let largest = outcome.modes.iter().map(size).fold(0.0, f64::max);
    let below = dense
        .iter()
        .filter(|z| z[0].hypot(z[1]) <= largest * (1.0 + 1e-9));
    assert_eq!(below.count(), 24);
    assert!(
        outcome.modes.iter().any(|m| m.growth > 1e-3),
        "none is unstable"
    );
}

#[test]
fn a_map_by_projection_has_the_modes_of_all_dofs() {
    let asked = "[[step]]\ncomplex-modes = { count = 12, map = { to = 2, points = 5 } }\n";
    let outcome = modes(&pad([0.6, 0.2], [100.0, 1e-2], asked));
    let map = outcome.map.unwrap();
    assert!(map.residual < 1e-6, "{:e}", map.residual);
    let row = &map.rows[2];
    assert_eq!(row.factor, 1.0);
    for (mode, [frequency, growth]) in outcome.modes.iter().zip(&row.modes) {
        let size = mode.growth.hypot(TAU * mode.frequency);
        near(*growth, mode.growth, 1e-8 * size);
        near(TAU * frequency, TAU * mode.frequency, 1e-8 * size);
    }
}

#[test]
fn sensitivities_are_what_differences_say() {
    let asked = "[[step]]\ncomplex-modes = { count = 8, sensitivity = true }\n";
    // Friction that does not depend on the speed, and next to no strain: pressure and areas change with all of these as well, and the contact state is kept.
    let text = pad([0.6, 0.0], [100.0, 1e-6], asked);
    let outcome = modes(&text);
    let h = 1e-4;
    let with = |words: &str, changed: &dyn Fn(f64) -> String| {
        [1.0 - h, 1.0 + h].map(|f| {
            assert_eq!(text.matches(words).count(), 1, "{words}");
            modes(&text.replace(words, &changed(f)))
        })
    };
    let number = |words: &str, value: f64| {
        let put = |v: f64| words.replace('#', &format!("{v:?}"));
        with(&put(value), &|f| put(f * value))
    };
    for (of, [low, high]) in [
        (
            "friction.rub",
            with("static = 0.6, kinetic = 0.6", &|f| {
                format!("static = {:?}, kinetic = {:?}", 0.6 * f, 0.6 * f)
            }),
        ),
        ("contact.rub", number("{ c = # }", 500.0)),
        ("modulus.pad", number("young = #", 100.0)),
        ("density.pad", number("density = # }\nmaterial.n", 1.0)),
        (
            "damping.pad",
            with("mass = 0.01, stiffness = 1e-4", &|f| {
                format!("mass = {:?}, stiffness = {:?}", 0.01 * f, 1e-4 * f)
            }),
        ),
    ] {
        let told: Vec<_> = outcome
            .sensitivities
            .iter()
            .filter(|s| s.of == of)
            .collect();
        assert_eq!(told.len(), 8, "{of}");
        let mut largest: f64 = 0.0;
        for s in told {
            let k = s.mode - 1;
            let [a, b] = [&low.modes[k], &high.modes[k]];
            let growth = (b.growth - a.growth) / (2.0 * h);
            let frequency = (b.frequency - a.frequency) / (2.0 * h);
            let scale = outcome.modes[k].frequency;
            near(s.growth, growth, 1e-5 * scale);
            near(s.frequency, frequency, 1e-5 * scale);
            largest = largest.max(s.growth.hypot(s.frequency) / scale);
        }
        assert!(largest > 1e-3, "{of}: nothing to tell, {largest:e}");
    }
    let own = outcome.sensitivities.iter().filter(|s| s.mode == 1);
    let names: Vec<&str> = own.map(|s| s.of.as_str()).collect();
    assert_eq!(
        names,
        [
            "friction.rub",
            "contact.rub",
            "modulus.back",
            "density.back",
            "modulus.pad",
            "density.pad",
            "damping.pad"
        ]
    );
}

/// Damping of bodies: of a mode with the frequency `ω` there remains `λ² + (α + β ω²) λ + ω² = 0`.
#[test]
fn bodies_are_damped_as_rayleigh_says() {
    let (alpha, beta) = (0.02, 3e-3);
    let real = modes(&rod(20));
    let damped =
        format!("material = \"m\", rayleigh = {{ mass = {alpha:?}, stiffness = {beta:?} }}");
    let text = rod(20).replace("material = \"m\"", &damped);
    let complex = modes(&text.replace("modes = {", "complex-modes = {"));
    assert_eq!(complex.modes.len(), 3);
    for (mode, real) in complex.modes.iter().zip(&real.modes) {
        let omega = TAU * real.frequency;
        let c = alpha + beta * omega * omega;
        near(mode.growth, -0.5 * c, 1e-9 * omega);
        let swing = (omega * omega - 0.25 * c * c).sqrt();
        near(TAU * mode.frequency, swing, 1e-9 * omega);
    }
}

/// Damping of the approach: a block that slides moves up and down by `λ² + c λ + k = 0`, whatever friction makes of that along the surface.
#[test]
fn contact_damps_the_approach_of_what_slides() {
    let law = "normal.linear = { c = 11.0 }, damping.viscous = { coefficient = 0.4 }, friction.coulomb = { mu = 0.3 }";
    let more = "coupling.k.spring = { stiffness = 100.0, terms = [{ set = \"centre\", component = \"x\" }] }\nload.press = { set = \"centre\", nodal-force = { value = [0, -0.1] } }\n[[step]]\nsteady = {}\n";
    let outcome = modes(&block("-1", law, &format!("{more}{COMPLEX}")));
    let found = nearest(&outcome, [-0.2, (11.0_f64 - 0.04).sqrt()]);
    near(found[0], -0.2, 1e-9);
    near(found[1], (11.0_f64 - 0.04).sqrt(), 1e-9);
}

/// What sticks has all of its stiffness along the surface: a block on springs `k` up and `κ` along slides and pitches as its two equations say.
#[test]
fn points_that_stick_have_stiffness_along_the_surface() {
    let (k, along): (f64, f64) = (2000.0, 3000.0);
    let law = format!(
        "friction.coulomb = {{ mu = 0.5 }}, enforcement.penalty = {{ stiffness = {k:?}, tangential-stiffness = {along:?} }}"
    );
    let more = "load.press = { set = \"centre\", nodal-force = { value = [0, -10] } }\n[[step]]\n";
    let text = block("0", &law, &format!("{more}{COMPLEX}"));
    let outcome = modes(&text.replace(", primary-velocity = [0, 0]", ""));
    assert_eq!(outcome.points, [3, 0, 0]);
    // Three points at -1/2, 0 and 1/2, that in the middle for half of the surface, and all h below the centre.
    let (h, pitch, inertia) = (0.05, 0.125 * k, 1.01 / 12.0);
    let (a, b) = (along, (along * h * h + pitch) / inertia);
    let product = (along * h).powi(2) / inertia;
    let (mean, half) = (0.5 * (a + b), (0.25 * (a - b).powi(2) + product).sqrt());
    for square in [mean - half, mean + half, k] {
        let found = nearest(&outcome, [0.0, square.sqrt()]);
        near(found[0], 0.0, 1e-9 * square.sqrt());
        near(found[1], square.sqrt(), 1e-9 * square.sqrt());
    }
}

/// BENCHMARKS Q1: a layer that slides on a rigid plane, one wave long, periodic.
fn layer(mu: f64, normal: &str, damping: f64, cells: [usize; 2], count: usize) -> ModalOutcome {
    let text = format!(
        r#"
format = 1
model.space = "plane-strain"
body.layer = {{ generate.rectangle = {{ to = [{TAU:?}, 1], cells = {cells:?}, element = "quad8" }}, material = "m", rayleigh = {{ mass = {damping:?} }} }}
material.m.isotropic = {{ young = 1.0, poisson = 0.3, density = 1.0 }}
obstacle.plane.plane = {{ point = [0, 0], normal = [0, 1] }}
interface.rub = {{ secondary = "layer.bottom", primary = "plane", {normal}friction.coulomb = {{ mu = {mu:?} }}, primary-velocity = [1, 0] }}
support.top = {{ set = "layer.top", x = 0, y = -1e-6 }}
coupling.x.equation = {{ terms = [{{ set = "layer.left", component = "x" }}, {{ set = "layer.right", component = "x", factor = -1 }}] }}
coupling.y.equation = {{ terms = [{{ set = "layer.left", component = "y" }}, {{ set = "layer.right", component = "y", factor = -1 }}] }}
output.every = 0
[[step]]
steady = {{}}
[[step]]
complex-modes = {{ count = {count}, shapes = false }}
"#
    );
    modes(&text)
}

/// The mode nearest to an eigenvalue.
fn nearest(outcome: &ModalOutcome, [growth, omega]: [f64; 2]) -> [f64; 2] {
    let all = outcome.modes.iter().map(|m| [m.growth, TAU * m.frequency]);
    let away = |m: &[f64; 2]| (m[0] - growth).hypot(m[1] - omega);
    all.min_by(|a, b| away(a).total_cmp(&away(b)))
        .expect("a mode")
}

#[test]
fn a_layer_slides_with_the_growth_of_the_continuum() {
    let compliant = "normal.linear = { c = 10.0 }, ";
    for (mu, normal, exact) in [
        (0.3, compliant, [0.028722558, 1.459434395]),
        (0.3, compliant, [0.138716364, 2.799646502]),
        (0.3, "", [0.030216147, 1.460764526]),
        (0.3, "", [0.136675349, 2.919056325]),
        (0.6, "", [0.059763471, 1.456310908]),
        (0.6, "", [0.252094065, 2.885957981]),
    ] {
        let [coarse, fine] = [[12, 4], [24, 8]].map(|cells| layer(mu, normal, 0.0, cells, 14));
        // One wave grows, the one that runs the other way decays.
        for sign in [1.0, -1.0] {
            let exact = [sign * exact[0], exact[1]];
            let [a, b] = [nearest(&coarse, exact), nearest(&fine, exact)];
            let off = |z: [f64; 2]| (z[0] - exact[0]).hypot(z[1] - exact[1]);
            let order = (off(a) / off(b)).log2();
            let what = format!("{mu} {normal} {sign}: {a:?} {b:?} order {order}");
            assert!((3.6..4.4).contains(&order), "{what}");
            // What the order promises of both together.
            let limit = [0, 1].map(|q| b[q] + (b[q] - a[q]) / 15.0);
            assert!(
                off(limit) < 0.15 * off(b) && off(b) < 1e-4 * exact[1],
                "{what} {:e}",
                off(limit)
            );
        }
    }
}

#[test]
fn damping_by_mass_stabilises_a_layer_where_the_closed_form_says() {
    let normal = "normal.linear = { c = 10.0 }, ";
    let at = |damping: f64| layer(0.3, normal, damping, [12, 3], 14);
    let [g, w] = nearest(&at(0.0), [0.138716364, 2.799646502]);
    // λ² + α λ of the damped mode is λ² of the undamped one.
    let limit = 2.0 * g * w / (w * w - g * g).sqrt();
    near(limit, 0.28, 0.02);
    let [below, above] = [0.999, 1.001].map(|f| nearest(&at(f * limit), [0.0, w])[0]);
    assert!(below > 0.0 && above < 0.0, "{below} {above}");
    near(below, -above, 0.02 * below);
}

#[test]
fn what_has_no_meaning_in_a_step_without_increments_is_refused() {
    let block = "format = 1\nmodel.space = \"plane-strain\"\nbody.a = { generate.rectangle = { to = [1, 1], cells = [1, 1] }, material = \"m\" }\nmaterial.m.isotropic = { young = 1.0, poisson = 0.3, density = 1.0 }\n";
    for (step, words) in [
        ("modes = {}\ncomplex-modes = {}", "not both"),
        (
            "modes = {}\nincrements.fixed = 2",
            "`increments` has no meaning",
        ),
        ("modes = {}\ndynamic = {}", "`dynamic` has no meaning"),
        ("modes = { from = 2, to = 1 }", "is not below"),
        (
            "complex-modes = { map = { from = 2, to = 1 } }",
            "is not below",
        ),
        (
            "steady = {}\ndynamic = {}",
            "`steady` is for quasi-static steps",
        ),
        (
            "steady.turning.rub = { speed = 1 }",
            "is not among the interfaces",
        ),
        (
            "steady.velocity.rub = [1, 0]",
            "is not among the interfaces",
        ),
        ("steady.velocity.rub = [1]", "has 2 components"),
        (
            "steady.turning.rub = { speed = 0, axis = [0, 0, 1] }",
            "across the plane",
        ),
    ] {
        let text = complaint(&format!("{block}[[step]]\n{step}\n"));
        assert!(text.contains(words), "{step}: {text}");
    }
    let massless = block.replace(", density = 1.0", "");
    let text = format!("{massless}[[step]]\nmodes = {{}}\n");
    let outcome = build(&problem(&text)).map(|mut s| s.run(&mut []));
    let error = format!("{outcome:?}");
    assert!(error.contains("density"), "{error}");
}

/// A rigid block of mass 1 that a surface drags along x while a spring holds it across: only across it may move.
fn dragged_across(sliding: &str, steady: &str, asked: &str) -> [f64; 2] {
    let text = format!(
        r#"
format = 1
model.space = "solid"
body.block = {{ rigid = true, generate.box = {{ from = [-0.5, -0.5, 0], to = [0.5, 0.5, 0.1], cells = [2, 2, 2] }}, material = "any" }}
material.any.isotropic = {{ young = 1e6, poisson = 0.0, density = 10.0 }}
set.centre = {{ of = "block", point = [0, 0, 0] }}
obstacle.belt.plane = {{ point = [0, 0, 0], normal = [0, 0, 1] }}
output.every = 0
interface.rub = {{ secondary = "block.bottom", primary = "belt", normal.linear = {{ c = 1e4 }}, friction.coulomb = {{ mu = 0.4 }}{sliding} }}
coupling.y.spring = {{ stiffness = 100.0, terms = [{{ set = "centre", component = "y" }}] }}
support.guide = {{ set = "block", x = 0, z = -5e-4 }}
[[step]]
steady = {steady}
[[step]]
complex-modes = {{ count = 1{asked} }}
"#
    );
    worst(&modes(&text))
}

#[test]
fn friction_damps_what_moves_across_the_sliding() {
    // λ² + λ μ N / v + 100 = 0 with μ N = 2 and v = 0.5.
    let c: f64 = 0.4 * 5.0 / 0.5;
    let exact = [-0.5 * c, (100.0 - 0.25 * c * c).sqrt()];
    let belt = dragged_across(", primary-velocity = [0.5, 0, 0.1]", "{}", "");
    // The velocity of the step beside that of the belt.
    let step = "{ velocity.rub = [0.2, 0, 0.1] }";
    let both = dragged_across(", primary-velocity = [0.3, 0, 0]", step, "");
    // About an axis so far away that all points go the same way.
    let disc = "{ turning.rub = { centre = [0, -1e6, 0], axis = [0, 0, -2], speed = 5e-7 } }";
    let disc = dragged_across("", disc, "");
    for q in 0..2 {
        near(belt[q], exact[q], 1e-9);
        near(both[q], exact[q], 1e-9);
        near(disc[q], exact[q], 1e-5);
    }
    let [growth, omega] = dragged_across(
        ", primary-velocity = [0.5, 0, 0.1]",
        "{}",
        ", friction-damping = false",
    );
    near(growth, 0.0, 1e-9);
    near(omega, 10.0, 1e-9);
}

/// A rigid block of mass 1 that may move along x and, without turning, along y.
fn upright(more: &str) -> String {
    format!(
        r#"
format = 1
model.space = "plane-strain"
body.mass = {{ rigid = true, generate.rectangle = {{ from = [-0.5, 0], to = [0.5, 0.2], cells = [1, 1] }}, material = "any" }}
material.any.isotropic = {{ young = 1e6, poisson = 0, density = 5 }}
set.a = {{ of = "mass", point = [-0.5, 0] }}
set.b = {{ of = "mass", point = [0.5, 0] }}
coupling.upright.equation.terms = [{{ set = "a", component = "y" }}, {{ set = "b", component = "y", factor = -1 }}]
coupling.kx.spring = {{ stiffness = 100.0, terms = [{{ set = "a", component = "x" }}] }}
output.every = 0
{more}
"#
    )
}

#[test]
fn equations_on_rigid_bodies_leave_as_many_modes_as_freedoms() {
    let spring =
        r#"coupling.ky.spring = { stiffness = 400.0, terms = [{ set = "b", component = "y" }] }"#;
    let outcome = modes(&upright(&format!(
        "{spring}\n[[step]]\nmodes = {{ count = 4 }}"
    )));
    assert_eq!(outcome.modes.len(), 2);
    for (mode, omega) in outcome.modes.iter().zip([10.0, 20.0]) {
        near(TAU * mode.frequency, omega, 1e-10 * omega);
        // What does not turn moves alike everywhere.
        let shape = &mode.shape[0];
        near(shape[1], shape[3], 1e-12);
        near(mode.effective_mass.iter().take(2).sum(), 1.0, 1e-10);
    }
    // Twice the same equation says it once.
    let twice = r#"coupling.again.equation.terms = [{ set = "b", component = "y", factor = 3 }, { set = "a", component = "y", factor = -3 }]"#;
    let outcome = modes(&upright(&format!(
        "{spring}\n{twice}\n[[step]]\nmodes = {{ count = 4 }}"
    )));
    assert_eq!(outcome.modes.len(), 2);
    // The answer to a force is that of one mass on a spring: at resonance the dashpot alone resists.
    let shaken = r#"coupling.d.dashpot = { coefficient = 2.0, terms = [{ set = "b", component = "y" }] }
load.shake = { set = "a", nodal-force.value = [0, 3.0] }
probe.b = { of = "mass", point = [0.5, 0] }
[[step]]
loads = []
[[step]]
harmonic = { loads = ["shake"], frequencies = [3.183098861837907] }"#;
    let outcome = modes(&upright(&format!("{spring}\n{shaken}")));
    let response = outcome.response.expect("an answer");
    let [re, im] = response.rows[0].values[1];
    near(re.hypot(im), 3.0 / (2.0 * 20.0), 1e-9);
}

#[test]
fn equations_on_rigid_bodies_that_slide_make_no_mode_of_their_own() {
    let more = r#"
obstacle.belt.plane = { point = [0, 0], normal = [0, 1] }
load.press = { set = "mass.top", pressure = { value = 10 } }
coupling.d.dashpot = { coefficient = 2.0, terms = [{ set = "a", component = "x" }] }
interface.rub = { secondary = "mass.bottom", primary = "belt", normal.linear = { c = 1e4 }, friction.stribeck = { static = 0.5, kinetic = 0.3, velocity = 0.1 }, primary-velocity = [0.1, 0] }
step = [{ name = "slide", steady = {} }, { complex-modes = { count = 4 } }]
"#;
    let outcome = modes(&upright(more));
    assert_eq!(outcome.modes.len(), 2);
    // Friction that falls with speed, N dμ/dv = -10 · 2 / e, is a damping beside that of the dashpot.
    let damping = 2.0 - 20.0 / std::f64::consts::E;
    let growth = -0.5 * damping;
    near(outcome.modes[0].growth, growth, 1e-8);
    let omega = (100.0 - growth * growth).sqrt();
    near(TAU * outcome.modes[0].frequency, omega, 1e-7);
    near(TAU * outcome.modes[1].frequency, 100.0, 1e-6);
    near(outcome.modes[1].growth, 0.0, 1e-9);
}

#[test]
fn a_cell_whose_points_follow_a_reference_is_a_rigid_body() {
    let text = r#"
format = 1
model.space = "plane-strain"
body.cell = { generate.rectangle = { from = [-0.5, -0.1], to = [0.5, 0.1], cells = [1, 1] }, material = "m" }
material.m.isotropic = { young = 1e3, poisson = 0.3, density = 5 }
reference.middle.point = [0, 0]
coupling.all.kinematic = { reference = "middle", set = "cell" }
set.a = { of = "cell", point = [-0.5, -0.1] }
set.b = { of = "cell", point = [0.5, -0.1] }
coupling.ya.spring = { stiffness = 50.0, terms = [{ set = "a", component = "y" }] }
coupling.yb.spring = { stiffness = 50.0, terms = [{ set = "b", component = "y" }] }
coupling.x.spring = { stiffness = 400.0, terms = [{ set = "middle", component = "x" }] }
output.every = 0
step = [{ modes = { count = 10 } }]
"#;
    let outcome = modes(text);
    assert_eq!(outcome.modes.len(), 3);
    // Mass 1; moments of inertia of a rectangle, 1.04 / 12, on two springs half a length to each side.
    let turning = f64::sqrt(2.0 * 50.0 * 0.25 / (1.04 / 12.0));
    for (mode, omega) in outcome.modes.iter().zip([10.0, turning, 20.0]) {
        near(TAU * mode.frequency, omega, 1e-9 * omega);
    }
    let total: f64 = outcome.modes.iter().map(|m| m.effective_mass[0]).sum();
    near(total, outcome.masses[0], 1e-10);
}

/// Matrices of all dofs as those of the dofs that are left by equations `x[i] = Σ a x[j]`, by dense products.
fn left_by(
    (n, all): (usize, [Vec<f64>; 3]),
    equations: &[(usize, Vec<(usize, f64)>)],
) -> (usize, [Vec<f64>; 3]) {
    let kept: Vec<usize> = (0..n)
        .filter(|i| equations.iter().all(|(dof, _)| dof != i))
        .collect();
    let m = kept.len();
    let mut t = vec![0.0; n * m];
    for (column, &dof) in kept.iter().enumerate() {
        t[dof * m + column] = 1.0;
    }
    for (dof, row) in equations {
        for &(other, a) in row {
            let column = kept.iter().position(|k| *k == other).expect("it is kept");
            t[dof * m + column] = a;
        }
    }
    let reduced = all.map(|a| {
        let mut out = vec![0.0; m * m];
        for i in 0..n {
            for j in 0..n {
                for p in (0..m).filter(|p| t[i * m + p] != 0.0) {
                    for q in (0..m).filter(|q| t[j * m + q] != 0.0) {
                        out[p * m + q] += t[i * m + p] * a[i * n + j] * t[j * m + q];
                    }
                }
            }
        }
        out
    });
    (m, reduced)
}

#[test]
fn equations_between_points_leave_the_modes_of_dense_matrices_without_them() {
    let text = r#"
format = 1
model.space = "plane-strain"
body.pad = { generate.rectangle = { to = [1, 0.3], cells = [3, 2] }, material = "m", rayleigh = { mass = 0.05, stiffness = 1e-4 } }
material.m.isotropic = { young = 1e3, poisson = 0.3, density = 2.0 }
obstacle.belt.plane = { point = [0, 0], normal = [0, 1] }
interface.rub = { secondary = "pad.bottom", primary = "belt", normal.linear = { c = 1e4 }, friction.coulomb = { mu = 0.6 }, primary-velocity = [0.1, 0] }
support.back = { set = "pad.right", x = 0 }
load.press = { set = "pad.top", pressure = { value = 1 } }
set.p = { of = "pad", point = [0, 0.3] }
set.q = { of = "pad", point = [0.66666667, 0.3] }
set.r = { of = "pad", point = [0, 0] }
coupling.one.equation.terms = [{ set = "p", component = "x", factor = 2 }, { set = "q", component = "y", factor = 0.7 }, { set = "r", component = "x", factor = -0.4 }]
coupling.two.equation.terms = [{ set = "r", component = "y" }, { set = "p", component = "y", factor = -1.5 }]
output.every = 0
step = [
    { steady = {}, couplings = [] },
    { complex-modes = { count = 1, export = true }, couplings = [] },
    { complex-modes = { count = 12 }, couplings = ["one", "two"] },
]
"#;
    let mut simulation = build(&problem(text)).unwrap_or_else(|e| panic!("{e}"));
    simulation.run(&mut []).unwrap_or_else(|e| panic!("{e}"));
    let (free, bound) = (&simulation.modes[0], &simulation.modes[1]);
    let (_, numbers) = dense(free, "dofs");
    let points = &simulation.model.mesh.points;
    let unknown = |x: [f64; 2], component: usize| -> usize {
        let away = |p: &[f64; 3]| (p[0] - x[0]).hypot(p[1] - x[1]);
        let mut all = 0..points.len();
        let point = all.find(|i| away(&points[*i]) < 1e-6).expect("a point");
        let dof = simulation.model.dofs.of(point, component) as f64;
        numbers.iter().position(|n| *n == dof).expect("an unknown")
    };
    let [p, q, r] = [[0.0, 0.3], [2.0 / 3.0, 0.3], [0.0, 0.0]];
    let equations = [
        (
            unknown(p, 0),
            vec![(unknown(q, 1), -0.35), (unknown(r, 0), 0.2)],
        ),
        (unknown(r, 1), vec![(unknown(p, 1), 1.5)]),
    ];
    let exact = companion_of(left_by(matrices(free), &equations));
    assert_eq!(bound.modes.len(), 12);
    for (mode, [growth, omega]) in bound.modes.iter().zip(&exact) {
        let size = growth.hypot(*omega);
        let ours = [mode.growth, TAU * mode.frequency];
        let off = (ours[0] - growth).hypot(ours[1] - omega);
        let nearest = exact
            .iter()
            .map(|z| (ours[0] - z[0]).hypot(ours[1] - z[1]))
            .fold(off, f64::min);
        assert!(nearest < 1e-8 * size, "{ours:?}: {nearest:e}");
        assert!(mode.residual < 1e-8, "{:e}", mode.residual);
        // Shapes obey the equations.
        for shape in &mode.shape {
            let at = |x, c| shape[numbers[unknown(x, c)] as usize];
            near(2.0 * at(p, 0) + 0.7 * at(q, 1) - 0.4 * at(r, 0), 0.0, 1e-12);
            near(at(r, 1) - 1.5 * at(p, 1), 0.0, 1e-12);
        }
    }
}

/// A column that is clamped at both ends and pressed by this part of its length.
fn pressed_column(pressed: f64) -> String {
    format!(
        r#"format = 1
model.space = "plane-stress"
body.column = {{ generate.rectangle = {{ to = [8, 0.4], cells = [40, 2], element = "quad8" }}, material = "m" }}
material.m.isotropic = {{ young = 1e6, poisson = 0, density = 1 }}
support.left = {{ set = "column.left", x = 0, y = 0 }}
support.right = {{ set = "column.right", x = {}, y = 0 }}
step = [{{ increments.fixed = 1 }}, {{ modes.count = 1 }}]
"#,
        -8.0 * pressed
    )
}

#[test]
fn what_stress_would_do_to_frequencies_is_estimated_and_judged() {
    let judged = |pressed: f64| {
        let mut simulation = build(&problem(&pressed_column(pressed))).expect("a model");
        simulation.run(&mut []).expect("modes");
        let figures = &simulation.summary.quality.figures;
        let figure = figures.iter().find(|f| f.figure == "prestress").cloned();
        let notes = simulation.modes[0].notes.clone();
        (figure, notes)
    };
    // Euler and Bernoulli: the first mode of a beam that is clamped at both ends has ∫ φ'² L² / ∫ φ''² L⁴ = 12.30 / 500.6, and a force P lowers its squared frequency by P L² / E I times that;
    // here P = E A ε and A / I = 12 / h².
    for strain in [2e-3, -2e-3] {
        let part = strain * 12.0 * (8.0_f64 / 0.4).powi(2) * 12.30 / 500.6;
        let change = (1.0 - part).sqrt() - 1.0;
        let (figure, notes) = judged(strain);
        let figure = figure.expect("judged");
        assert!(!figure.met, "{figure:?}");
        assert!(
            (figure.value / change.abs() - 1.0).abs() < 0.05,
            "{figure:?} {change}"
        );
        let percent = format!("{:+.0}", 100.0 * change);
        assert!(notes.iter().any(|n| n.contains(&percent[..2])), "{notes:?}");
    }
    let (figure, notes) = judged(1e-4);
    assert!(figure.expect("judged").met && notes.is_empty(), "{notes:?}");
    // Where there is no stress there is nothing to say.
    assert_eq!(judged(0.0).0.map(|f| f.value), None);
}

//! The answer to harmonic loads, sensitivities of modes that come several times, and the condensed model for other programs.

use std::f64::consts::TAU;

use crate::modes::{matrices, modes, near, pad};
use crate::support::{build, complaint, problem};
use stickslip::io::npy::Numbers;
use stickslip::linear::{DenseLu, general};
use stickslip::modal::{ModalOutcome, Response};

/// A rigid block of mass 1 between a spring and a dashpot.
fn oscillator(harmonic: &str) -> String {
    format!(
        r#"
format = 1
model.space = "plane-strain"
body.block = {{ rigid = true, generate.rectangle = {{ from = [-0.5, 0], to = [0.5, 0.1], cells = [2, 2] }}, material = "any" }}
material.any.isotropic = {{ young = 1e6, poisson = 0.0, density = 10.0 }}
set.centre = {{ of = "block", point = [0, 0.05] }}
probe.m = {{ point = [0, 0.05] }}
output.every = 0
coupling.k.spring = {{ stiffness = 100.0, terms = [{{ set = "centre", component = "x" }}] }}
coupling.d.dashpot = {{ coefficient = 2.0, terms = [{{ set = "centre", component = "x" }}] }}
support.guide = {{ set = "block", hold = ["y"] }}
load.shake = {{ set = "centre", nodal-force = {{ value = [3, 0] }} }}
load.turned = {{ set = "centre", nodal-force = {{ value = [4, 0] }} }}
[[step]]
loads = []
[[step]]
harmonic = {{ {harmonic} }}
"#
    )
}

fn response(outcome: ModalOutcome) -> Response {
    outcome.response.expect("a response")
}

#[test]
fn a_mass_on_a_spring_and_a_dashpot_answers_as_its_equation_says() {
    let answer = response(modes(&oscillator(
        "loads = [\"shake\"], from = 0, to = 5, points = 26",
    )));
    assert_eq!(answer.columns, ["m.U1", "m.U2"]);
    assert_eq!(answer.rows.len(), 26);
    for (k, row) in answer.rows.iter().enumerate() {
        near(row.frequency, 0.2 * k as f64, 1e-12);
        assert!(row.residual < 1e-10, "{:e}", row.residual);
        // 3 / (100 - ω² + 2 i ω).
        let omega = TAU * row.frequency;
        let (still, damped) = (100.0 - omega * omega, 2.0 * omega);
        let square = still * still + damped * damped;
        near(row.values[0][0], 3.0 * still / square, 1e-10);
        near(row.values[0][1], -3.0 * damped / square, 1e-10);
        assert_eq!(row.values[1], [0.0, 0.0]);
    }
    // A quarter of a cycle ahead is i times as much: 3 + 4 i.
    let both = "loads = [\"shake\", \"turned\"], phases.turned = 90, frequencies = [1.2]";
    let both = response(modes(&oscillator(both)));
    let one = response(modes(&oscillator(
        "loads = [\"shake\"], frequencies = [1.2]",
    )));
    let [a, b] = one.rows[0].values[0].map(|v| v / 3.0);
    let found = both.rows[0].values[0];
    near(found[0], 3.0 * a - 4.0 * b, 1e-10);
    near(found[1], 3.0 * b + 4.0 * a, 1e-10);
}

#[test]
fn modes_have_damping_of_their_own_and_frequencies_crowd_at_them() {
    // ω = 10: twice the ratio times that beside the dashpot, or mass + stiffness ω².
    for (damping, more) in [
        ("ratios = [0.05]", 1.0),
        ("mass = 0.5, stiffness = 0.01", 1.5),
        ("ratios = [0.05], mass = 0.5", 1.5),
    ] {
        let asked = format!(
            "loads = [\"shake\"], from = 1, to = 5, points = 5, bias = 3, damping = {{ {damping} }}"
        );
        let answer = response(modes(&oscillator(&asked)));
        let mode = 10.0 / TAU;
        let inner = 0.5_f64.cbrt();
        let between =
            |a: f64, b: f64| [-inner, 0.0, inner].map(|part| 0.5 * (a + b) + 0.5 * (b - a) * part);
        let mut wanted = vec![1.0];
        wanted.extend(between(1.0, mode));
        wanted.push(mode);
        wanted.extend(between(mode, 5.0));
        wanted.push(5.0);
        assert_eq!(answer.rows.len(), wanted.len());
        for (row, frequency) in answer.rows.iter().zip(wanted) {
            near(row.frequency, frequency, 1e-9);
            assert!(row.residual < 1e-10, "{:e}", row.residual);
            let omega = TAU * row.frequency;
            let (still, damped) = (100.0 - omega * omega, (2.0 + more) * omega);
            let square = still * still + damped * damped;
            near(row.values[0][0], 3.0 * still / square, 1e-9);
            near(row.values[0][1], -3.0 * damped / square, 1e-9);
        }
    }
}

/// Where all modes are superposed, Rayleigh's damping of a body is the same, said of the body or of its modes.
#[test]
fn damping_of_all_modes_is_that_of_the_body() {
    let plate = |rayleigh: &str, damping: &str| {
        let text = format!(
            r#"
format = 1
model.space = "plane-stress"
body.plate = {{ generate.rectangle = {{ to = [2, 1], cells = [3, 2] }}, material = "m"{rayleigh} }}
material.m.isotropic = {{ young = 50.0, poisson = 0.3, density = 1.0 }}
support.wall = {{ set = "plate.left", x = 0, y = 0 }}
set.corner = {{ of = "plate", point = [2, 1] }}
probe.corner = {{ point = [2, 1] }}
output.every = 0
load.shake = {{ set = "corner", nodal-force = {{ value = [1, 2] }} }}
[[step]]
loads = []
[[step]]
harmonic = {{ loads = ["shake"], from = 0.2, to = 30, points = 40{damping} }}
"#
        );
        response(modes(&text))
    };
    let of_body = plate(", rayleigh = { mass = 0.3, stiffness = 0.002 }", "");
    let of_modes = plate("", ", damping = { mass = 0.3, stiffness = 0.002 }");
    let free = plate("", "");
    let mut moved = 0.0_f64;
    for ((a, b), none) in of_body.rows.iter().zip(&of_modes.rows).zip(&free.rows) {
        for ((a, b), none) in a.values.iter().zip(&b.values).zip(&none.values) {
            let size = a[0].hypot(a[1]);
            assert!(
                (a[0] - b[0]).hypot(a[1] - b[1]) < 1e-8 * size,
                "{a:?} {b:?}"
            );
            moved = moved.max((a[0] - none[0]).hypot(a[1] - none[1]) / size);
        }
    }
    assert!(moved > 0.1, "{moved:e}");
}

/// `x` of `(K + i ω C - ω² M) x = f`, by one dense matrix.
fn direct(outcome: &ModalOutcome, forces: &[f64], omega: f64) -> Vec<[f64; 2]> {
    let (n, [k, c, m]) = matrices(outcome);
    let mut a = vec![0.0; 4 * n * n];
    for i in 0..n {
        for j in 0..n {
            let still = k[i * n + j] - omega * omega * m[i * n + j];
            let damped = omega * c[i * n + j];
            a[i * 2 * n + j] = still;
            a[(n + i) * 2 * n + n + j] = still;
            a[i * 2 * n + n + j] = -damped;
            a[(n + i) * 2 * n + j] = damped;
        }
    }
    let mut x = [forces, &vec![0.0; n]].concat();
    DenseLu::new(2 * n, &a).solve(&mut x);
    (0..n).map(|i| [x[i], x[n + i]]).collect()
}

#[test]
fn a_sliding_pad_answers_as_the_dense_matrices_do() {
    let more = "load.shake = { set = \"corner\", nodal-force = { value = [0.3, -0.2] } }\nset.corner = { of = \"pad\", point = [1, 0.4] }\nprobe.here = { of = \"pad\", point = [1, 0.4] }\nprobe.there = { of = \"pad\", point = [0, 0] }\n";
    let asked = "[[step]]\ncomplex-modes = { count = 30, export = true }\n[[step]]\nharmonic = { loads = [\"shake\"], from = 0.5, to = 12, points = 47 }\n";
    let text = pad([0.6, 0.2], [100.0, 1e-2], asked).replacen(
        "[[step]]\nsteady",
        &format!("{more}[[step]]\nloads = []\nsteady"),
        1,
    );
    let mut simulation = build(&problem(&text)).unwrap_or_else(|e| panic!("{e}"));
    simulation.run(&mut []).unwrap_or_else(|e| panic!("{e}"));
    let [complex, harmonic] = [0, 1].map(|k| &simulation.modes[k]);
    assert_eq!(harmonic.points[1], 7, "it slides");
    let unknowns = complex.export.iter().find(|e| e.name == "dofs").unwrap();
    let unknown = |dof: usize| {
        unknowns
            .entries
            .iter()
            .position(|e| e.2 == dof as f64)
            .unwrap()
    };
    let at: Vec<usize> = (simulation.model.reports.probes.iter())
        .flat_map(|p| [0, 1].map(|c| unknown(2 * p.point + c)))
        .collect();
    let mut forces = vec![0.0; unknowns.shape[0]];
    (forces[at[0]], forces[at[1]]) = (0.3, -0.2);
    let answer = harmonic.response.as_ref().expect("a response");
    // The modes between which the frequencies lie.
    let among = complex.modes.iter().filter(|m| m.frequency < 12.0).count();
    assert!(among > 4, "{among}");
    assert!(answer.dimension < unknowns.shape[0], "fewer than all");
    let mut worst = 0.0_f64;
    for row in &answer.rows {
        let exact = direct(complex, &forces, TAU * row.frequency);
        let size = at
            .iter()
            .map(|i| exact[*i][0].hypot(exact[*i][1]))
            .fold(0.0, f64::max);
        for (i, value) in at.iter().zip(&row.values) {
            let off = (value[0] - exact[*i][0]).hypot(value[1] - exact[*i][1]);
            worst = worst.max(off / size);
        }
        assert!(row.residual < 1e-3, "{:e}", row.residual);
    }
    assert!(worst < 1e-4, "{worst:e}");
    assert!(
        harmonic.notes.iter().any(|n| n.contains("unstable"))
            == complex.modes.iter().any(|m| m.growth > 1e-6),
        "{:?}",
        harmonic.notes
    );
}

#[test]
fn what_cannot_shake_is_refused() {
    for (harmonic, words) in [
        ("", "no load shakes"),
        ("loads = [\"shake\"]", "frequencies are not given"),
        ("loads = [\"shaker\"], to = 3", "did you mean `shake`"),
        ("loads = [\"shake\"], to = 3, from = 4", "is not below"),
        ("loads = [\"shake\"], to = 3, frequencies = [1]", "exclude"),
        ("loads = [\"shake\"], frequencies = [-1]", "not negative"),
        (
            "loads = [\"shake\"], to = 3, bias = 0.5",
            "must be at least 1",
        ),
        (
            "loads = [\"shake\"], frequencies = [1], bias = 3",
            "exclude",
        ),
        (
            "loads = [\"shake\"], to = 3, damping.ratios = [-0.1]",
            "damping of modes is not negative",
        ),
        (
            "loads = [\"shake\"], to = 3, phases.turned = 9",
            "not among the `loads`",
        ),
    ] {
        let said = complaint(&oscillator(harmonic));
        assert!(said.contains(words), "{harmonic}: {said}");
    }
    let text = oscillator("loads = [\"shake\"], to = 3");
    let both = text.replace("harmonic =", "modes = {}\nharmonic =");
    assert!(complaint(&both).contains("not both"));
    let unasked = text.replace("probe.m = { point = [0, 0.05] }\n", "");
    assert!(complaint(&unasked).contains("nothing asks for the answer"));
    let spring = text.replace(
        "nodal-force = { value = [3, 0] }",
        "spring = { stiffness = [1, 1] }",
    );
    assert!(complaint(&spring).contains("is a spring"));
}

/// Two rods of their own that are equal: modes come twice, and their vectors are any two of a plane. A stiffer rod moves one frequency by half as much and the
/// other not at all; a heavier one likewise, downwards.
#[test]
fn equal_eigenvalues_split_as_each_rod_says() {
    let rod = |name: &str| {
        format!(
            "body.{name} = {{ generate.rectangle = {{ to = [2, 0.1], cells = [9, 1] }}, material = \"m\" }}\nsupport.wall-{name} = {{ set = \"{name}.left\", x = 0 }}\nsupport.guide-{name} = {{ set = \"{name}\", y = 0 }}\n"
        )
    };
    let text = format!(
        "format = 1\nmodel.space = \"plane-stress\"\nmaterial.m.isotropic = {{ young = 4.0, poisson = 0.0, density = 1.0 }}\n{}{}[[step]]\ncomplex-modes = {{ count = 6, sensitivity = true }}\n",
        rod("a"),
        rod("b")
    );
    let outcome = modes(&text);
    assert_eq!(outcome.modes.len(), 6);
    assert_eq!(outcome.sensitivities.len(), 24, "{:?}", outcome.notes);
    for pair in [0, 2, 4] {
        let frequency = outcome.modes[pair].frequency;
        near(
            outcome.modes[pair + 1].frequency,
            frequency,
            1e-9 * frequency,
        );
        for (of, half) in [("modulus", 0.5), ("density", -0.5)] {
            for rod in ["a", "b"] {
                let name = format!("{of}.{rod}");
                let here = outcome
                    .sensitivities
                    .iter()
                    .filter(|s| s.of == name && (s.mode == pair + 1 || s.mode == pair + 2));
                let mut found: Vec<f64> = here.map(|s| s.frequency / frequency).collect();
                found.sort_by(|a, b| a.abs().total_cmp(&b.abs()));
                near(found[0], 0.0, 1e-7);
                near(found[1], half, 1e-7);
            }
        }
    }
}

/// What other programs get of the condensed model has the eigenvalues that are found here.
#[test]
fn the_condensed_model_has_the_same_modes() {
    let outcome = modes(&pad(
        [0.6, 0.2],
        [100.0, 1e-2],
        "[[step]]\ncomplex-modes = { count = 8, export = true }\n",
    ));
    let floats = |name: &str| {
        let array = outcome.arrays.iter().find(|a| a.name == name);
        let array = array.unwrap_or_else(|| panic!("no {name}"));
        match &array.numbers {
            Numbers::Floats(all) => (array.shape, all.clone()),
            Numbers::Integers(_) => panic!("{name} is whole"),
        }
    };
    let ([r, _], mut k) = floats("reduced-stiffness");
    let (_, m) = floats("reduced-mass");
    let (_, mut c) = floats("reduced-damping");
    for (name, to) in [("friction", &mut k), ("drag", &mut c)] {
        let ([_, q], left) = floats(&format!("reduced-{name}-left"));
        let (_, right) = floats(&format!("reduced-{name}-right"));
        for i in 0..r * r {
            let pairs = (0..q).map(|p| left[i / r * q + p] * right[i % r * q + p]);
            to[i] += pairs.sum::<f64>();
        }
    }
    let lu = DenseLu::new(r, &k);
    let solved = |a: &[f64]| {
        let mut by_columns: Vec<f64> = (0..r * r).map(|i| a[i % r * r + i / r]).collect();
        lu.solve(&mut by_columns);
        by_columns
    };
    // 1/λ of (x, λ x): x = -K⁻¹ (C x + M λ x) / λ.
    let (c, m) = (solved(&c), solved(&m));
    let mut a = vec![0.0; 4 * r * r];
    for i in 0..r {
        a[(r + i) * 2 * r + i] = 1.0;
        for j in 0..r {
            a[i * 2 * r + j] = -c[j * r + i];
            a[i * 2 * r + r + j] = -m[j * r + i];
        }
    }
    let inverse = general(2 * r, &a).unwrap().0;
    for mode in &outcome.modes {
        let ours = [mode.growth, TAU * mode.frequency];
        let off = inverse.iter().map(|z| {
            let square = z[0] * z[0] + z[1] * z[1];
            (z[0] / square - ours[0]).hypot(-z[1] / square - ours[1])
        });
        let off = off.fold(f64::INFINITY, f64::min);
        assert!(off < 1e-7 * ours[0].hypot(ours[1]), "{ours:?}: {off:e}");
    }
    // Displacements of the basis, by unknown: the mass is what the whole one makes of them.
    let ([n, _], basis) = floats("reduced-basis");
    let (_, [_, _, whole]) = matrices(&outcome);
    let (_, reduced) = floats("reduced-mass");
    for (i, j) in [(0, 0), (1, 3), (r - 1, 2)] {
        let sum: f64 = (0..n * n)
            .map(|e| basis[e / n * r + i] * whole[e] * basis[e % n * r + j])
            .sum();
        near(sum, reduced[i * r + j], 1e-9 * reduced[0].abs());
    }
}

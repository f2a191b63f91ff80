//! Criteria against closed forms, and the search for planes against one that tries them all.

use super::*;
use crate::registry::Family;
use std::f64::consts::{PI, TAU};

const YOUNG: f64 = 2e5;
const POISSON: f64 = 0.3;

/// Strain of an isotropic material by Hooke's law.
fn strain(s: &[f64; 6]) -> [f64; 6] {
    let trace = s[0] + s[1] + s[2];
    let direct = |x: f64| ((1.0 + POISSON) * x - POISSON * trace) / YOUNG;
    let shear = |x: f64| 2.0 * (1.0 + POISSON) * x / YOUNG;
    [
        direct(s[0]),
        direct(s[1]),
        direct(s[2]),
        shear(s[3]),
        shear(s[4]),
        shear(s[5]),
    ]
}

/// A cycle of 40 increments, with the stress at each phase.
fn cycle(stress: impl Fn(f64) -> [f64; 6]) -> History {
    let stress: Vec<[f64; 6]> = (1..=40)
        .map(|i| stress(TAU * f64::from(i) / 40.0))
        .collect();
    History {
        strain: stress.iter().map(strain).collect(),
        stress,
    }
}

fn value(criterion: &dyn Criterion, history: &History, directions: Directions) -> f64 {
    let worst = worst(criterion, history, directions).expect("looks at planes");
    worst.value
}

const BOTH: [Directions; 2] = [Directions::Plane, Directions::Space];

fn close(found: f64, expected: f64, what: &str) {
    assert!(
        (found - expected).abs() <= 1e-6 * expected.abs(),
        "{what}: {found} for {expected}"
    );
}

/// Tension that goes back and forth by `a` about `m`: on the plane at an angle `θ` the shear is `σ sin 2θ / 2` and the normal stress `σ (1 + cos 2θ) / 2`, so that Findley's is
/// `(√(a² + k² (m + a)²) + k (m + a)) / 2`.
#[test]
fn tension_along_an_axis() {
    for (a, m) in [(200.0, 0.0), (150.0, 80.0), (120.0, -60.0)] {
        let history = cycle(|t| [m + a * t.sin(), 0.0, 0.0, 0.0, 0.0, 0.0]);
        let top: f64 = m + a;
        for directions in BOTH {
            let what = format!("{a} {m} {directions:?}");
            for k in [0.0, 0.25, 0.9] {
                let expected = 0.5 * (a.hypot(k * top) + k * top);
                close(value(&Findley { k }, &history, directions), expected, &what);
            }
            let swt = value(&SmithWatsonTopper {}, &history, directions);
            close(swt, top * a / YOUNG, &what);
            // The largest shear is there when the hydrostatic stress is largest.
            let dang_van = value(&DangVan { a: 0.4 }, &history, directions);
            close(dang_van, 0.5 * a + 0.4 * top / 3.0, &what);
        }
    }
    let plane = |criterion: &dyn Criterion| {
        let history = cycle(|t| [200.0 * t.sin(), 0.0, 0.0, 0.0, 0.0, 0.0]);
        let found = worst(criterion, &history, Directions::Plane).expect("planes");
        found.normal[0].abs().acos().to_degrees()
    };
    assert!(plane(&SmithWatsonTopper {}) < 0.05);
    // tan 2θ = 1/k
    let k = 0.3_f64;
    let angle = 0.5 * (1.0 / k).atan().to_degrees();
    assert!((plane(&Findley { k }) - angle).abs() < 0.05);
}

/// Shear that goes back and forth: on the plane at `θ` there is shear `τ cos 2θ` and normal stress `τ sin 2θ`.
#[test]
fn pure_shear() {
    let t = 130.0;
    for at in [3, 4, 5] {
        let history = cycle(|phase| {
            let mut s = [0.0; 6];
            s[at] = t * phase.sin();
            s
        });
        let k = 0.3_f64;
        let all = Directions::Space;
        let findley = value(&Findley { k }, &history, all);
        close(findley, t * (1.0 + k * k).sqrt(), "findley");
        let swt = value(&SmithWatsonTopper {}, &history, all);
        close(swt, t * t * (1.0 + POISSON) / YOUNG, "swt");
        close(value(&DangVan { a: 0.4 }, &history, all), t, "dang van");
    }
}

/// Loads in proportion, in any direction: with the principal stresses `σ₁ > σ₂ > σ₃` of the amplitude about no mean, Findley's is that of Mohr's circle of `σ₁` and `σ₃`:
/// `√(1 + k²) (σ₁ - σ₃)/2 + k (σ₁ + σ₃)/2`, where the top of the cycle is the worse end.
#[test]
fn loads_in_proportion() {
    let principal = [180.0, 60.0, -40.0];
    let turn = {
        // Columns: three directions at right angles.
        let [a, b] = [0.7_f64, -0.4_f64];
        [
            [a.cos(), -a.sin() * b.cos(), a.sin() * b.sin()],
            [a.sin(), a.cos() * b.cos(), -a.cos() * b.sin()],
            [0.0, b.sin(), b.cos()],
        ]
    };
    let s = |i: usize, j: usize| -> f64 {
        (0..3).map(|k| turn[i][k] * principal[k] * turn[j][k]).sum()
    };
    let amplitude = [s(0, 0), s(1, 1), s(2, 2), s(0, 1), s(1, 2), s(0, 2)];
    let history = cycle(|t| amplitude.map(|x| x * t.sin()));
    let (half, mean) = (0.5 * (180.0 + 40.0), 0.5 * (180.0 - 40.0));
    for k in [0.0, 0.3] {
        let expected = (1.0_f64 + k * k).sqrt() * half + k * mean;
        let found = value(&Findley { k }, &history, Directions::Space);
        close(found, expected, "findley");
    }
    let found = value(&DangVan { a: 0.5 }, &history, Directions::Space);
    close(found, half + 0.5 * 200.0 / 3.0, "dang van");
    let strain = (180.0 - POISSON * 20.0) / YOUNG;
    let found = value(&SmithWatsonTopper {}, &history, Directions::Space);
    close(found, 180.0 * strain, "swt");
}

/// What a plane says by brute force, with formulas of its own: components turned by a matrix, the amplitude of shear from all pairs and triples of points.
fn by_hand(model: &FatigueModel, stress: &[[f64; 6]], [polar, around]: [f64; 2]) -> f64 {
    let (s, c) = polar.sin_cos();
    let (u, v) = around.sin_cos();
    let axes = [[s * v, s * u, c], [c * v, c * u, -s], [-u, v, 0.0]];
    let part = |t: &[f64; 6], i: usize, j: usize| {
        let full = [[t[0], t[3], t[5]], [t[3], t[1], t[4]], [t[5], t[4], t[2]]];
        let mut sum = 0.0;
        for a in 0..3 {
            for b in 0..3 {
                sum += axes[i][a] * full[a][b] * axes[j][b];
            }
        }
        sum
    };
    let normal: Vec<f64> = stress.iter().map(|t| part(t, 0, 0)).collect();
    let shear: Vec<[f64; 2]> = (stress.iter())
        .map(|t| [part(t, 0, 1), part(t, 0, 2)])
        .collect();
    let strain: Vec<f64> = (stress.iter().zip(&normal))
        .map(|(t, n)| ((1.0 + POISSON) * n - POISSON * (t[0] + t[1] + t[2])) / YOUNG)
        .collect();
    let most = |values: &[f64]| values.iter().copied().fold(f64::MIN, f64::max);
    let least = |values: &[f64]| values.iter().copied().fold(f64::MAX, f64::min);
    match model {
        FatigueModel::SmithWatsonTopper(_) => {
            most(&normal).max(0.0) * 0.5 * (most(&strain) - least(&strain))
        }
        FatigueModel::Findley(f) => circle(&shear).1 + f.k * most(&normal),
        FatigueModel::DangVan(d) => {
            let (m, _) = circle(&shear);
            let values = shear.iter().zip(stress);
            let values = values
                .map(|(t, s)| (t[0] - m[0]).hypot(t[1] - m[1]) + d.a * (s[0] + s[1] + s[2]) / 3.0);
            most(&values.collect::<Vec<_>>())
        }
        FatigueModel::Ruiz(_) | FatigueModel::RuizWork(_) => unreachable!("not of planes"),
    }
}

/// The middle of the smallest circle by steps toward the farthest point, ever smaller (Bădoiu and Clarkson).
fn circle(points: &[[f64; 2]]) -> ([f64; 2], f64) {
    let far = |c: [f64; 2]| {
        let away = |p: &[f64; 2]| (p[0] - c[0]).hypot(p[1] - c[1]);
        let all = points.iter().map(|p| (away(p), *p));
        all.fold((0.0, c), |a, b| if b.0 > a.0 { b } else { a })
    };
    let mut c = points[0];
    for i in 1..400 {
        let (_, p) = far(c);
        let step = 1.0 / f64::from(i + 1);
        c = [0, 1].map(|k| c[k] + step * (p[k] - c[k]));
    }
    (c, far(c).0)
}

/// Stresses that turn and change out of phase: all planes four degrees apart, and half a degree around the worst of them, find no worse one, and none that is as bad is missed.
#[test]
fn the_worst_of_all_planes_is_found() {
    let cycles = [
        cycle(|t| [150.0 * t.sin(), 0.0, 0.0, 90.0 * t.cos(), 0.0, 0.0]),
        cycle(|t| {
            [
                40.0 + 100.0 * t.sin(),
                -80.0 * (t + 0.8).sin(),
                30.0 * (2.0 * t).cos(),
                50.0 * t.cos(),
                60.0 * (t - 0.5).sin(),
                -20.0 * (2.0 * t).sin(),
            ]
        }),
    ];
    let planes = |m: &FatigueModel| m.as_dyn().on_surface(&Rubbed::default()).is_none();
    for model in FatigueModel::samples().into_iter().filter(planes) {
        for (i, history) in cycles.iter().enumerate() {
            let found = worst(model.as_dyn(), history, Directions::Space).expect("planes");
            let look = |middle: [f64; 2], step: f64, steps: [i32; 2]| {
                let mut best = (f64::MIN, middle);
                for a in -steps[0]..=steps[0] {
                    for b in -steps[1]..=steps[1] {
                        let at = [
                            middle[0] + f64::from(a) * step,
                            middle[1] + f64::from(b) * step,
                        ];
                        let value = by_hand(&model, &history.stress, at);
                        if value > best.0 {
                            best = (value, at);
                        }
                    }
                }
                best
            };
            // Half a sphere, and a closer look.
            let (_, near) = look([0.5 * PI, 0.5 * PI], PI / 45.0, [22, 22]);
            let (value, _) = look(near, PI / 360.0, [8, 8]);
            let off = found.value / value - 1.0;
            // Half a degree, and the circle of 400 steps, which is a little too large.
            assert!((-3e-3..1e-3).contains(&off), "{model:?} {i}: {off:e}");
        }
    }
}

#[test]
fn what_rubs_counts_in_proportion_and_pressure_along_the_surface_not() {
    let at = Rubbed {
        tension: 100.0,
        shear: 30.0,
        slip: 0.02,
    };
    assert!((Ruiz {}.on_surface(&at).unwrap() - 60.0).abs() < 1e-12);
    assert!((RuizWork {}.on_surface(&at).unwrap() - 0.6).abs() < 1e-15);
    for model in FatigueModel::samples() {
        let criterion = model.as_dyn();
        let of_surface = criterion.on_surface(&at).is_some();
        assert_ne!(
            of_surface,
            criterion.on_plane(&OnPlane::default()).is_some()
        );
        assert_eq!(criterion.faults(), []);
    }
    assert_eq!(Findley { k: -0.1 }.faults().len(), 1);
    assert_eq!(DangVan { a: f64::NAN }.faults().len(), 1);
}

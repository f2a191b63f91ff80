//! Friction that depends on the direction: every method against the words of the law, and one point against a search.

use super::random::Random;
use crate::friction::ellipse::{Ellipse, SlipDirection};
use crate::friction::*;

/// Points whose friction depends on the direction, with an operator that couples them and slips of both.
fn scratched(random: &mut Random, points: usize) -> FrictionProblem {
    let n = 3 * points;
    let roots: Vec<f64> = (0..n * n).map(|_| random.between(-1.0, 1.0)).collect();
    let mut operator = vec![0.0; n * n];
    for i in 0..n {
        for j in 0..n {
            let product: f64 = (0..n).map(|k| roots[i * n + k] * roots[j * n + k]).sum();
            let own = if i == j { 0.5 } else { 0.0 };
            operator[i * n + j] = product / n as f64 + own;
        }
    }
    let laws = (0..points).map(|k| {
        let flow = match k % 2 {
            0 => SlipDirection::Associated,
            _ => SlipDirection::AgainstTraction,
        };
        let half = match (random.between(0.0, 1.0) < 0.5, flow) {
            (true, _) => [1.0, random.between(0.1, 0.9)],
            // Nothing rubs across the axis.
            (false, SlipDirection::Associated) if random.between(0.0, 1.0) < 0.3 => [1.0, 0.0],
            _ => [random.between(0.1, 0.9), 1.0],
        };
        let angle = random.between(0.0, std::f64::consts::PI);
        PointLaw {
            mu: random.between(0.05, 0.3),
            adhesion: if random.between(0.0, 1.0) < 0.3 {
                0.02
            } else {
                0.0
            },
            ellipse: Some(Ellipse { half, angle, flow }),
        }
    });
    FrictionProblem {
        dimension: 3,
        operator,
        laws: laws.collect(),
        free: (0..n)
            .map(|i| match i % 3 {
                0 => random.between(-1.0, 0.3),
                _ => random.between(-1.0, 1.0),
            })
            .collect(),
    }
}

/// How far forces and motion are from friction on ellipses, by the words of the law: nothing here projects, and what the associated rule says is that no admissible shear dissipates more.
fn ellipse_error(problem: &FrictionProblem, forces: &[f64]) -> f64 {
    let motion = problem.motion(forces);
    let mut worst = 0.0_f64;
    for (k, law) in problem.laws.iter().enumerate() {
        let [r, u] = [forces, &motion].map(|x| &x[3 * k..3 * k + 3]);
        worst = worst.max(-r[0]).max(-u[0]).max((r[0] * u[0]).abs());
        let ellipse = law.ellipse.unwrap();
        let (sine, cosine) = ellipse.angle.sin_cos();
        let turn = |v: &[f64]| [cosine * v[1] + sine * v[2], cosine * v[2] - sine * v[1]];
        let (t, w) = (turn(r), turn(u));
        let axes = ellipse.half.map(|h| h * (law.adhesion + law.mu * r[0]));
        let (slides, size) = (w[0].hypot(w[1]), t[0].hypot(t[1]));
        match ellipse.flow {
            SlipDirection::Associated => {
                let dissipated = -(t[0] * w[0] + t[1] * w[1]);
                let most = (axes[0] * w[0]).hypot(axes[1] * w[1]);
                worst = worst.max((dissipated - most).abs());
            }
            SlipDirection::AgainstTraction if slides > 1e-7 => {
                let limit = slides / (w[0] / axes[0]).hypot(w[1] / axes[1]);
                let turned = (t[0] * w[1] - t[1] * w[0]).abs() / slides;
                let along = (t[0] * w[0] + t[1] * w[1]) / slides;
                worst = worst.max(turned).max((along + limit).abs());
            }
            SlipDirection::AgainstTraction => {}
        }
        // |t| beyond the boundary in its direction
        let beyond = |i: usize| {
            if t[i].abs() < 1e-9 {
                0.0
            } else {
                t[i] / axes[i]
            }
        };
        worst = worst.max(size * (1.0 - 1.0 / beyond(0).hypot(beyond(1)).max(1.0)));
    }
    worst
}

/// One point: the direction of slip with the least residual among all directions, or none.
#[test]
fn one_point_on_an_ellipse_has_the_solution_that_a_search_over_all_directions_finds() {
    let mut slid = 0;
    for seed in 0..60 {
        let mut random = Random::new(7000 + seed);
        let problem = scratched(&mut random, 2);
        // The second point is the one against the traction.
        let k = (seed % 2) as usize;
        let own = problem.own(k);
        let free: [f64; 3] = std::array::from_fn(|a| problem.free[3 * k + a]);
        let alone = FrictionProblem {
            dimension: 3,
            operator: own.to_vec(),
            free: free.to_vec(),
            laws: vec![problem.laws[k]],
        };
        let found = is_sound(&format!("{seed}"), &alone);
        let law = alone.laws[0];
        let Some(thin) = law.ellipse.map(|e| e.half.contains(&0.0)) else {
            continue;
        };
        let motion = alone.motion(&found);
        let slides = motion[1].hypot(motion[2]) > 1e-6 && found[0] > 0.0;
        if !slides || thin {
            continue;
        }
        slid += 1;
        let residual = |angle: f64| {
            let t = [angle.cos(), angle.sin()];
            let cone = law.cone(1.0);
            let d = cone.against(t);
            let m = d.along.map(|v| v / d.size);
            let across = own[1] * m[0] + own[2] * m[1];
            let push = (law.adhesion * across - free[0]) / (own[0] - law.mu * across);
            let limit = law.adhesion + law.mu * push;
            let u = alone.motion(&[push, -limit * m[0], -limit * m[1]]);
            let along = u[1] * t[0] + u[2] * t[1];
            match along > 0.0 && push > 0.0 {
                true => (u[1] * t[1] - u[2] * t[0]).abs() / along,
                false => f64::INFINITY,
            }
        };
        let angles = (0..36_000).map(|k| f64::from(k) * std::f64::consts::TAU / 36_000.0);
        let best = angles.min_by(|a, b| residual(*a).total_cmp(&residual(*b)));
        let angle = motion[2].atan2(motion[1]);
        let off = (best.unwrap() - angle).rem_euclid(std::f64::consts::TAU);
        let off = off.min(std::f64::consts::TAU - off);
        assert!(off < 2e-4, "{seed}: {off}");
    }
    assert!(slid > 20, "{slid}");
}

/// Solves a problem by the portfolio, and judges it by the words of the law.
fn is_sound(what: &str, problem: &FrictionProblem) -> Vec<f64> {
    assert_eq!(problem.fault(), None);
    let solution = solve(problem, None, 1e-11);
    assert!(solution.solved, "{what}: {:?}", solution.tried);
    let error = ellipse_error(problem, &solution.forces);
    assert!(error < 1e-7, "{what}: {error:e}; {:?}", solution.tried);
    solution.forces
}

#[test]
fn friction_on_ellipses_is_solved_by_every_method() {
    let methods: [(&str, &dyn FrictionSolver); 4] = [
        ("gauss-seidel", &GaussSeidel { sweeps: 2000 }),
        (
            "newton",
            &NewtonInForces::new(Step::LeastSquares, Length::Falling),
        ),
        (
            "proximal newton",
            &NewtonInForces::new(Step::Proximal, Length::Falling),
        ),
        ("proximal", &ProximalPoint),
    ];
    let mut solved = [0; 4];
    for seed in 0..40 {
        let mut random = Random::new(8000 + seed);
        let problem = scratched(&mut random, 2 + seed as usize % 4);
        let reference = is_sound(&format!("{seed}"), &problem);
        let start = vec![0.0; problem.size()];
        for (k, (name, method)) in methods.iter().enumerate() {
            let found = method.solve(&problem, &start, 1e-11);
            if found.error > 1e-11 {
                continue;
            }
            solved[k] += 1;
            let error = ellipse_error(&problem, &found.forces);
            assert!(error < 1e-7, "{name} {seed}: {error:e}");
            let off = found
                .forces
                .iter()
                .zip(&reference)
                .map(|(a, b)| (a - b).abs());
            assert!(off.fold(0.0, f64::max) < 1e-6, "{name} {seed}");
        }
    }
    assert!(solved.iter().all(|n| *n >= 30), "{solved:?}");
}

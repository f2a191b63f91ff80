mod ellipses;
mod random;
mod rigid;

use super::*;
use random::Random;

/// The error that is usual in the literature (Acary, Brémond and Huber 2018): `|r - P_K(r - û)| / |q|` with the projection onto Coulomb's cone and
/// `û = u + μ |u_t| n`. Nothing is scaled and the cone is another way to write the laws, so that it shares nothing with the map that is solved.
fn cone_error(problem: &FrictionProblem, forces: &[f64]) -> f64 {
    let (d, n) = (problem.dimension, problem.size());
    let mut squares = 0.0;
    for (k, law) in problem.laws.iter().enumerate() {
        let mut u = vec![0.0; d];
        for (a, u) in u.iter_mut().enumerate() {
            let i = k * d + a;
            *u = problem.free[i];
            for (j, r) in forces.iter().enumerate() {
                *u += problem.operator[i * n + j] * r;
            }
        }
        let length = |x: &[f64]| x.iter().map(|x| x * x).sum::<f64>().sqrt();
        u[0] += law.mu * length(&u[1..]);
        let r = &forces[k * d..(k + 1) * d];
        let z: Vec<f64> = r.iter().zip(&u).map(|(r, u)| r - u).collect();
        let (push, shear) = (z[0], length(&z[1..]));
        let mut p = z.clone();
        if law.mu * shear <= -push {
            p.fill(0.0);
        } else if shear > law.mu * push {
            p[0] = (push + law.mu * shear) / (1.0 + law.mu * law.mu);
            for a in 1..d {
                p[a] = law.mu * p[0] * z[a] / shear;
            }
        }
        squares += r.iter().zip(&p).map(|(r, p)| (r - p).powi(2)).sum::<f64>();
    }
    squares.sqrt() / problem.free.iter().map(|q| q * q).sum::<f64>().sqrt()
}

fn is_solved(what: &str, problem: &FrictionProblem) -> Solution {
    let solution = solve(problem, None, 1e-10);
    let tried = &solution.tried;
    assert!(solution.solved, "{what}: {tried:?}");
    let error = cone_error(problem, &solution.forces);
    assert!(error < 1e-8, "{what}: the cone says {error:e}; {tried:?}");
    solution
}

const SICONOS: [(&str, &str); 5] = [
    ("rover4396", include_str!("../problems/rover4396.txt")),
    ("rover1040", include_str!("../problems/rover1040.txt")),
    (
        "nespheres_10_1",
        include_str!("../problems/nespheres_10_1.txt"),
    ),
    (
        "slider crank",
        include_str!("../problems/fc2d_slidercranklagrangian00000.txt"),
    ),
    (
        "374",
        include_str!("../problems/frictioncontactproblem00374.txt"),
    ),
];

#[test]
fn problems_of_siconos_are_solved() {
    for (name, text) in SICONOS {
        is_solved(name, &text::read(text).unwrap());
    }
}

/// Friction on two sides is all that holds the block: Newton's method finds no way, and only patience does.
#[test]
fn a_block_that_is_dragged_between_two_others_is_solved() {
    let problem = text::read(include_str!("../problems/block_between.txt")).unwrap();
    let solution = solve(&problem, None, 1e-10);
    assert!(solution.solved, "{:?}", solution.tried);
    let size = |of: &[f64]| of.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    let (small, few) = (1e-8 * size(&problem.free), 1e-8 * size(&solution.forces));
    for (k, law) in problem.laws.iter().enumerate() {
        let of = |x: &[f64]| (x[2 * k], x[2 * k + 1]);
        let ((push, shear), (gap, slip)) = (of(&solution.forces), of(&solution.motion));
        let (limit, _) = law.limit(push);
        assert!(
            push >= 0.0 && gap > -small && (push < few || gap < small),
            "{k}"
        );
        assert!(shear.abs() <= limit + few, "{k}");
        assert!(
            push == 0.0 || slip.abs() < small || (limit - shear.abs() < few && shear * slip <= 0.0),
            "{k}"
        );
    }
}

#[test]
fn stacks_of_boxes_are_solved() {
    for seed in 0..40 {
        let mut random = Random::new(seed);
        let mu = [0.0, 0.1, 0.3, 0.7, 1.0, 1.5][seed as usize % 6];
        let problem = rigid::stack(&mut random, 2 + seed as usize % 6, mu);
        is_solved(&format!("stack {seed}, mu {mu}"), &problem);
    }
}

#[test]
fn heaps_of_balls_are_solved() {
    for seed in 0..30 {
        let mut random = Random::new(1000 + seed);
        let mu = [0.1, 0.3, 0.7, 1.0, 1.5][seed as usize % 5];
        let problem = rigid::heap(&mut random, 4 + seed as usize % 14, mu);
        is_solved(&format!("heap {seed}, mu {mu}"), &problem);
    }
}

/// The stacks and heaps need more than one method: none of them solves all.
#[test]
fn no_member_is_all_of_the_portfolio() {
    let mut last = std::collections::BTreeMap::new();
    for seed in 0..60 {
        let mut random = Random::new(seed);
        let problem = match seed % 2 {
            0 => rigid::stack(&mut random, 2 + seed as usize % 6, 1.0),
            _ => rigid::heap(&mut random, 6 + seed as usize % 12, 1.0),
        };
        let solution = solve(&problem, None, 1e-10);
        if let Some(tried) = solution.tried.last() {
            *last.entry(tried.solver.clone()).or_insert(0) += 1;
        }
    }
    assert!(last.len() > 1, "{last:?}");
}

/// A block of mass one on a slope, pushed down with gravity for a unit of time: it stays or slides by what is left of the push.
#[test]
fn a_block_on_a_slope_sticks_below_the_angle_of_friction_and_slides_above() {
    for dimension in [2, 3] {
        for (mu, slope) in [(0.5, 0.4_f64), (0.5, 0.6), (0.0, 0.3), (2.0, 1.2)] {
            let n = dimension;
            let mut operator = vec![0.0; n * n];
            (0..n).for_each(|i| operator[i * (n + 1)] = 1.0);
            let mut free = vec![0.0; n];
            (free[0], free[1]) = (-slope.cos(), slope.sin());
            let laws = vec![PointLaw::coulomb(mu)];
            let problem = FrictionProblem {
                dimension,
                operator,
                free,
                laws,
            };
            let solution = is_solved("slope", &problem);
            let held = (mu * slope.cos()).min(slope.sin());
            assert!((solution.forces[0] - slope.cos()).abs() < 1e-12);
            assert!((solution.forces[1] + held).abs() < 1e-12);
            assert!((solution.motion[1] - (slope.sin() - held)).abs() < 1e-12);
        }
    }
}

#[test]
fn adhesion_holds_what_friction_does_not() {
    let problem = |adhesion| FrictionProblem {
        dimension: 2,
        operator: vec![1.0, 0.0, 0.0, 1.0],
        free: vec![-1.0, 3.0],
        laws: vec![PointLaw {
            mu: 0.5,
            adhesion,
            ..PointLaw::default()
        }],
    };
    let slides = solve(&problem(1.0), None, 1e-12);
    assert!((slides.forces[1] + 1.5).abs() < 1e-12, "{slides:?}");
    let sticks = solve(&problem(4.0), None, 1e-12);
    assert!((sticks.forces[1] + 3.0).abs() < 1e-12, "{sticks:?}");
    assert!(sticks.motion[1].abs() < 1e-12);
}

#[test]
fn every_solver_knows_a_heap_without_friction() {
    let mut random = Random::new(7);
    let problem = rigid::heap(&mut random, 8, 0.0);
    let solvers: [&dyn FrictionSolver; 3] = [
        &NewtonInForces::new(Step::LeastSquares, Length::Falling),
        &GaussSeidel { sweeps: 3000 },
        &ProximalPoint,
    ];
    for solver in solvers {
        let found = solver.solve(&problem, &vec![0.0; problem.size()], 1e-8);
        let error = cone_error(&problem, &found.forces);
        assert!(error < 1e-7, "{}: {error:e}", solver.name());
    }
}

#[test]
fn units_make_no_difference() {
    let mut random = Random::new(5);
    let problem = rigid::stack(&mut random, 4, 0.7);
    let mut other = problem.clone();
    // forces in other units, motions in others; both by powers of two
    other
        .operator
        .iter_mut()
        .for_each(|w| *w *= 1024.0 / 65536.0);
    other.free.iter_mut().for_each(|q| *q *= 1024.0);
    let (one, two) = (solve(&problem, None, 1e-10), solve(&other, None, 1e-10));
    let counts = |s: &Solution| s.tried.iter().map(|t| t.iterations).collect::<Vec<_>>();
    assert_eq!(counts(&one), counts(&two));
    let worst = one
        .forces
        .iter()
        .zip(&two.forces)
        .map(|(a, b)| (a * 65536.0 - b).abs());
    assert!(worst.fold(0.0, f64::max) < 1e-6 * 65536.0);
}

#[test]
fn a_problem_goes_through_text_to_the_last_bit() {
    let mut random = Random::new(3);
    let mut problem = rigid::heap(&mut random, 5, 0.3);
    problem.laws[0].adhesion = 0.1;
    for (k, flow) in [
        (1, ellipse::SlipDirection::Associated),
        (2, ellipse::SlipDirection::AgainstTraction),
    ] {
        problem.laws[k].ellipse = Some(ellipse::Ellipse {
            half: [1.0, 1.0 / 3.0],
            angle: 0.1 + k as f64,
            flow,
        });
    }
    let written = text::write(&problem, "one\ntwo");
    assert!(written.starts_with("# one\n# two\ndim 3"), "{written}");
    assert_eq!(text::read(&written), Ok(problem));
}

#[test]
fn what_is_wrong_with_a_text_is_said_with_its_line() {
    let good = "# x\ndim 2 contacts 1\nmu 0.5\nq\n-1\n0\nW 2\n0 0 1\n1 1 1\n";
    assert!(text::read(good).is_ok());
    for (from, to, line, says) in [
        ("dim 2", "dim 4", 2, "2 or 3"),
        ("dim 2", "size 2", 2, "`dim D contacts N`"),
        ("mu 0.5", "mu 0.5 0.5", 3, "2 values, and 1 are wanted"),
        ("mu 0.5", "mu -0.5", 3, "not negative"),
        ("mu 0.5", "mu nan", 3, "no finite number"),
        ("q\n", "p\n", 4, "`q` alone"),
        ("-1\n", "one\n", 5, "`one`"),
        ("W 2", "V 2", 7, "`W`"),
        ("W 2", "W 3", 9, "ends where entry 2 of 3"),
        ("W 2", "W 1", 9, "nothing is wanted"),
        ("0 0 1", "2 0 1", 8, "below 2"),
        ("1 1 1", "0 0 1", 9, "given twice"),
        ("1 1 1", "1 1 inf", 9, "no finite number"),
        ("contacts 1", "contacts 999999", 2, "more than"),
    ] {
        let fault = text::read(&good.replacen(from, to, 1)).unwrap_err();
        assert_eq!(fault.line, line, "{from} -> {to}: {fault:?}");
        assert!(fault.message.contains(says), "{fault:?}");
    }
}

#[test]
fn what_is_no_problem_is_named() {
    let good = text::read(SICONOS[0].1).unwrap();
    assert_eq!(good.fault(), None);
    let mut bad = good.clone();
    bad.operator[0] = -1.0;
    assert!(bad.fault().unwrap().contains("row 0"));
    let mut bad = good.clone();
    bad.laws[0].ellipse = Some(ellipse::Ellipse {
        half: [1.0, 0.0],
        angle: 0.0,
        flow: ellipse::SlipDirection::AgainstTraction,
    });
    assert!(bad.fault().unwrap().contains("ellipse of point 0"));
    let mut bad = good;
    bad.free.pop();
    assert!(bad.fault().is_some());
}

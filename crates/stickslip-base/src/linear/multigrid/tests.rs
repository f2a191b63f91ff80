use super::super::testing::{dense_of, noise};
use super::super::{GmresSettings, LinearError, gmres};
use super::model::{Model, Pair, Status};
use super::{GapVariables, MeshHints, Multigrid, MultigridSettings};

fn weights(pairs: &[Pair]) -> Vec<(usize, Vec<(usize, f64)>)> {
    let list = pairs.iter().map(|p| (p.point, p.terms.clone()));
    list.collect()
}

/// A hierarchy of three levels at least.
fn multigrid(model: &Model) -> (GapVariables, Multigrid) {
    let gaps = GapVariables::new(model.block, &model.fixed, &weights(&model.pairs));
    let normals: Vec<(usize, [f64; 3])> = model.pairs.iter().map(|p| (p.point, p.normal)).collect();
    let hints = MeshHints {
        coordinates: &model.coordinates,
        bodies: &model.bodies,
        gaps: &normals,
    };
    let stiffness = gaps.transform(&model.matrix);
    let settings = MultigridSettings {
        coarsest_dofs: 100,
        ..MultigridSettings::default()
    };
    let multigrid = Multigrid::new(&stiffness, &model.fixed, hints, settings).unwrap();
    assert!(multigrid.levels().len() > 2, "{:?}", multigrid.levels());
    (gaps, multigrid)
}

/// Iterations to 1e-8 in one state, from one hierarchy.
fn iterations(
    model: &Model,
    (gaps, multigrid): &mut (GapVariables, Multigrid),
    pairs: &[Pair],
    factor: f64,
    status: &dyn Fn(&Pair) -> Status,
) -> (usize, Vec<u64>) {
    let tangents = model.tangents(pairs, factor, status);
    let added: Vec<(usize, [f64; 9])> = pairs
        .iter()
        .zip(&tangents)
        .map(|(pair, tangent)| (pair.point, tangent.1))
        .collect();
    multigrid.update(&added);
    let mut b = noise(&mut 3, model.matrix.rows());
    for (b, &fixed) in b.iter_mut().zip(&model.fixed) {
        *b = if fixed { 0.0 } else { *b };
    }
    let mut x = vec![0.0; b.len()];
    let settings = GmresSettings {
        tolerance: 1e-8,
        restart: 60,
        max_iterations: 60,
    };
    let report = gmres(
        &mut |x, y| model.product(pairs, &tangents, x, y),
        &mut |v| {
            gaps.transpose(v);
            multigrid.cycle(v);
            gaps.apply(v);
        },
        &b,
        &mut x,
        settings,
    );
    assert!(report.converged, "{report:?}");
    let held = x.iter().zip(&model.fixed).filter(|(_, f)| **f);
    assert!(held.into_iter().all(|(x, _)| *x == 0.0));
    (
        report.iterations,
        x.iter().map(|x| x.to_bits()).collect::<Vec<_>>(),
    )
}

/// The upper block is held at its top; at every other point its normal component stays free.
fn held(n: usize, dimension: usize, bulge: f64) -> Model {
    let mut model = Model::new(n, dimension, bulge, 1.0);
    for &point in &model.top {
        let last = point * dimension + dimension - 1;
        model.fixed[point * dimension..last].fill(true);
        model.fixed[last] = point % 2 == 0;
    }
    model
}

fn mixed(pair: &Pair) -> Status {
    match pair.point % 4 {
        0 => Status::Stick,
        1 => Status::Slip,
        2 => Status::Frictionless,
        _ => Status::Open,
    }
}

#[test]
fn one_hierarchy_serves_every_status_and_stiffness() {
    for (model, bounds) in [
        (held(8, 3, 0.0), [20, 22, 24, 34]),
        (held(8, 3, 0.2), [22, 24, 28, 36]),
        (held(24, 2, 0.0), [20, 22, 26, 34]),
    ] {
        let mut levels = multigrid(&model);
        let states: [&dyn Fn(&Pair) -> Status; 4] = [
            &|_| Status::Stick,
            &|_| Status::Frictionless,
            &|_| Status::Slip,
            &mixed,
        ];
        for (state, bound) in states.iter().zip(bounds) {
            let count = |levels: &mut _, w| iterations(&model, levels, &model.pairs, w, *state).0;
            let soft = count(&mut levels, 10.0);
            let stiff = count(&mut levels, 1e5);

            assert!(soft <= bound && stiff <= bound, "{soft} {stiff} {bound}");
        }
        let open = iterations(&model, &mut levels, &model.pairs, 1.0, &|_| Status::Open).0;
        assert!(open <= bounds[1], "{open}");
    }
}

#[test]
fn a_floating_body_is_held_by_contact_alone() {
    let model = Model::new(7, 3, 0.0, 1.0);
    let mut levels = multigrid(&model);
    for w in [10.0, 1e4] {
        let count = iterations(&model, &mut levels, &model.pairs, w, &|_| Status::Stick).0;
        assert!(count <= 22, "{count}");
    }
}

#[test]
fn the_finest_level_follows_pairs_that_drift() {
    // On a curved face normals turn, which coarse levels do not see: stiff contact feels it.
    for (bulge, w) in [(0.1, 10.0), (0.0, 1e4)] {
        let model = held(8, 3, bulge);
        let (_, mut levels) = multigrid(&model);
        let pairs = model.pairs_shifted([0.06, 0.03], 1.0);
        let gaps = GapVariables::new(3, &model.fixed, &weights(&pairs));
        levels.refresh(&gaps.transform(&model.matrix)).unwrap();
        let count = iterations(&model, &mut (gaps, levels), &pairs, w, &|_| Status::Slip).0;
        assert!(count <= 26, "{count}");
    }
}

#[test]
fn the_cycle_is_symmetric_and_positive() {
    for model in [held(7, 3, 0.1), held(20, 2, 0.0)] {
        let (_, mut levels) = multigrid(&model);
        let tangents = model.tangents(&model.pairs, 100.0, &mixed);
        let pairs = model.pairs.iter().zip(&tangents);
        levels.update(&pairs.map(|(p, t)| (p.point, t.1)).collect::<Vec<_>>());
        let n = model.matrix.rows();
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let mut seed = 5;
        for _ in 0..5 {
            let (a, b) = (noise(&mut seed, n), noise(&mut seed, n));
            let (mut ma, mut mb) = (a.clone(), b.clone());
            levels.cycle(&mut ma);
            levels.cycle(&mut mb);
            let (aa, bb, ab, ba) = (dot(&a, &ma), dot(&b, &mb), dot(&a, &mb), dot(&b, &ma));
            assert!(aa > 0.0 && bb > 0.0);
            assert!((ab - ba).abs() < 1e-5 * (aa * bb).sqrt(), "{ab} {ba} {aa}");
            let free = model.fixed.iter().zip(&ma).all(|(f, m)| !f || *m == 0.0);
            assert!(free);
        }
    }
}

#[test]
fn bits_do_not_depend_on_threads() {
    let solve = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        pool.build().unwrap().install(|| {
            let model = held(12, 3, 0.1);
            let mut levels = multigrid(&model);
            iterations(&model, &mut levels, &model.pairs, 10.0, &mixed)
        })
    };
    assert_eq!(solve(1), solve(3));
}

#[test]
fn transform_matches_the_dense_product() {
    for dimension in [2, 3] {
        let mut model = held(3, dimension, 0.1);
        // A fixed component on either side of the interface.
        let pair = model.pairs[1].clone();
        model.fixed[pair.point * dimension] = true;
        model.fixed[pair.terms[1].0 * dimension + 1] = true;
        let gaps = GapVariables::new(dimension, &model.fixed, &weights(&model.pairs));
        let n = model.matrix.rows();
        let columns: Vec<Vec<f64>> = (0..n)
            .map(|j| {
                let mut x = vec![0.0; n];
                if !model.fixed[j] {
                    x[j] = 1.0;
                }
                gaps.apply(&mut x);
                x
            })
            .collect();
        let (k, kt) = (dense_of(&model.matrix), gaps.transform(&model.matrix));
        let size = model.matrix.norm_inf();
        let times = |x: &[f64]| -> Vec<f64> {
            let rows = k.chunks(n);
            rows.map(|row| row.iter().zip(x).map(|(k, x)| k * x).sum())
                .collect()
        };
        for j in (0..n).filter(|&j| !model.fixed[j]) {
            let kx = times(&columns[j]);
            for i in (0..n).filter(|&i| !model.fixed[i]) {
                let expected: f64 = columns[i].iter().zip(&kx).map(|(t, k)| t * k).sum();
                assert!((kt.entry(i, j) - expected).abs() < 1e-12 * size, "{i} {j}");
            }
            // The transposed map, and the way back.
            let mut f = kx.clone();
            gaps.transpose(&mut f);
            for i in (0..n).filter(|&i| !model.fixed[i]) {
                assert!((kt.entry(i, j) - f[i]).abs() < 1e-12 * size);
            }
            let mut x = columns[j].clone();
            gaps.to_gaps(&mut x);
            assert!((0..n).all(|i| (x[i] - if i == j { 1.0 } else { 0.0 }).abs() < 1e-14));
        }
    }
}

#[test]
fn chains_of_pairs_are_left_out() {
    let pairs = [
        (2, vec![(0, 0.5), (1, 0.5)]),
        // Leans on a gap point; is leaned on; leans on itself; named twice.
        (3, vec![(2, 1.0)]),
        (0, vec![(4, 1.0)]),
        (5, vec![(5, 1.0)]),
        (2, vec![(4, 1.0)]),
        (6, vec![(4, 1.0)]),
    ];
    let gaps = GapVariables::new(2, &[false; 14], &pairs);
    assert_eq!(gaps.points().collect::<Vec<_>>(), [2, 6]);
    assert!(gaps.is_gap(6) && !gaps.is_gap(0));
    let mut x = vec![0.0; 14];
    (x[0], x[2], x[8]) = (1.0, 3.0, 7.0);
    gaps.apply(&mut x);
    assert_eq!((x[4], x[12]), (2.0, 7.0));
}

#[test]
fn says_what_is_wrong_with_a_matrix() {
    let mut model = Model::new(3, 2, 0.0, 1.0);
    let new = |model: &Model| {
        let hints = MeshHints {
            coordinates: &model.coordinates,
            bodies: &model.bodies,
            gaps: &[],
        };
        let settings = MultigridSettings::default();
        Multigrid::new(&model.matrix, &model.fixed, hints, settings).map(|m| m.levels().len())
    };
    assert!(new(&model).is_ok());
    model.matrix.add_diagonal(20, -1e15);
    assert_eq!(new(&model), Err(LinearError::NotPositive { dof: 20 }));
    model.matrix.add_diagonal(21, f64::NAN);
    assert_eq!(new(&model), Err(LinearError::NotFinite { dof: 21 }));
}

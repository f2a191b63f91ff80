//! Against the built-in engine. These tests are ignored unless asked for, since they need the program of the ranks; `.ci/run` builds it and runs them.

use std::sync::Arc;

use super::{Mumps, MumpsOptions};
use crate::linear::testing::{grid, noise};
use crate::linear::{
    BlockCsr, Compliance, Engine, Interior, LinearError, Matrix, Multifrontal, Schur, Summands,
    Workspace,
};

const PLAIN: MumpsOptions = MumpsOptions {
    ranks: 1,
    out_of_core: false,
    low_rank: None,
    memory: None,
    spread: Some(false),
};

/// A matrix whose entries are not kept: each entry comes in two parts, one behind all first ones.
#[derive(Debug)]
struct Unkept(BlockCsr);

impl Matrix for Unkept {
    fn points(&self) -> usize {
        self.0.points()
    }

    fn block_size(&self) -> usize {
        self.0.block_size()
    }

    fn mul_all(&self, all: &[&[f64]]) -> Vec<Vec<f64>> {
        self.0.mul_all(all)
    }

    fn diagonal(&self) -> Vec<f64> {
        self.0.diagonal()
    }

    fn summands(&self, points: std::ops::Range<usize>, visit: &mut Summands) {
        for part in [0.25, 0.75] {
            let mut scaled = |i: usize, j: usize, value: f64| visit(i, j, part * value);
            self.0.summands(points.clone(), &mut scaled);
        }
    }

    fn kept(&self) -> Result<&BlockCsr, [u64; 2]> {
        Err([1, 2])
    }

    fn make(&self) -> BlockCsr {
        self.0.clone()
    }
}

fn start(options: MumpsOptions) -> Arc<Mumps> {
    Arc::new(Mumps::start(options).unwrap_or_else(|error| panic!("{error}")))
}

type Factored = (Box<dyn Interior>, Schur);

fn factor(
    engine: Arc<dyn Engine>,
    matrix: &dyn Matrix,
    (fixed, kept): (&[bool], &[bool]),
) -> Result<Factored, LinearError> {
    let ordered = engine.order(matrix, (0..matrix.points(), fixed, kept))?;
    ordered.factor(matrix, &Workspace::default())
}

fn close(a: &[f64], b: &[f64], tolerance: f64) {
    assert_eq!(a.len(), b.len());
    let size = b.iter().fold(f64::MIN_POSITIVE, |m, x| m.max(x.abs()));
    for (a, b) in a.iter().zip(b) {
        assert!((a - b).abs() <= tolerance * size, "{a} instead of {b}");
    }
}

/// The values of what is here.
fn values(schur: &Schur) -> &[f64] {
    match schur {
        Schur::Here(values) => values,
        Schur::DistributedOperator(_) => panic!("it is spread"),
    }
}

/// Forces by dof of the matrix, reduced, and displacements for given ones of the kept dofs; by dof again.
fn reduced_and_recovered(factor: &dyn Interior, columns: usize) -> (Vec<f64>, Vec<f64>) {
    let ordered = factor.ordered();
    let take = |dofs: &[u32], seed: u64| -> Vec<f64> {
        let of_column = |k: usize| {
            let all = noise(&mut (seed + k as u64), 1000);
            dofs.iter()
                .map(move |&d| all[d as usize])
                .collect::<Vec<_>>()
        };
        (0..columns).flat_map(of_column).collect()
    };
    let (mut interior, mut root) = (take(ordered.interior(), 1), take(ordered.root(), 1));
    factor.reduce(&mut interior, &mut root, columns).unwrap();
    let at = take(ordered.root(), 77);
    let mut once = interior.clone();
    factor.recover(&mut once, &at, columns).unwrap();
    // The same where the ranks do not have the forces any more.
    factor.recover(&mut interior, &at, columns).unwrap();
    close(&interior, &once, 1e-12);
    let n = ordered.interior().len();
    let mut by_dof = vec![0.0; 1000 * columns];
    for (k, column) in once.chunks(n.max(1)).enumerate() {
        for (&dof, value) in ordered.interior().iter().zip(column) {
            by_dof[1000 * k + dof as usize] = *value;
        }
    }
    (root, by_dof)
}

#[test]
#[ignore = "needs the MUMPS engine: `cargo xtask engine mumps`, then `cargo test --tests -- --ignored`"]
fn the_schur_complement_and_vectors_are_those_of_the_built_in_engine() {
    let cases = [
        PLAIN,
        MumpsOptions { ranks: 2, ..PLAIN },
        MumpsOptions {
            ranks: 3,
            out_of_core: true,
            low_rank: Some(1e-13),
            ..PLAIN
        },
    ];
    let a = grid([7, 6, 6], 3);
    let fixed: Vec<bool> = (0..a.rows()).map(|dof| dof < 60 || dof == 201).collect();
    let some: Vec<bool> = (0..a.points()).map(|p| p % 9 == 8).collect();
    let (none, all) = (vec![false; a.points()], vec![true; a.points()]);
    for options in cases {
        let engine = start(options);
        for kept in [&some, &none, &all] {
            let builtin = factor(Arc::new(Multifrontal), &a, (&fixed, kept)).unwrap();
            let mumps = factor(Arc::clone(&engine) as _, &a, (&fixed, kept)).unwrap();
            assert_eq!(mumps.0.ordered().root(), builtin.0.ordered().root());
            close(values(&mumps.1), values(&builtin.1), 1e-12);
            for columns in [1, 5] {
                let (root, inner) = reduced_and_recovered(&*mumps.0, columns);
                let (root_0, inner_0) = reduced_and_recovered(&*builtin.0, columns);
                close(&root, &root_0, 1e-11);
                close(&inner, &inner_0, 1e-11);
            }
        }
    }
}

#[test]
#[ignore = "needs the MUMPS engine: `cargo xtask engine mumps`, then `cargo test --tests -- --ignored`"]
fn a_matrix_that_nobody_keeps_and_a_compliance_that_is_spread_are_the_same() {
    let a = grid([7, 6, 7], 3);
    // Half of the points are kept: more rows than a block of the grid of ranks has.
    let kept: Vec<bool> = (0..a.points()).map(|p| p % 2 == 1).collect();
    let fixed: Vec<bool> = (0..a.rows()).map(|dof| dof < 60 || dof == 201).collect();
    let marks = (&fixed[..], &kept[..]);
    let (builtin, schur) = factor(Arc::new(Multifrontal), &a, marks).unwrap();
    let n = builtin.ordered().root().len();
    let mut seed = 5;
    let vectors: Vec<Vec<f64>> = (0..3).map(|_| noise(&mut seed, n)).collect();
    let modes = &vectors[..2];
    let (trace, felt) = (schur.trace(n), schur.products(&vectors).unwrap());
    let pieces = schur.pieces(n, |_, _| false);
    let work = Workspace::default();
    let compliance = schur.invert(n, modes, 3.0, &work).unwrap();
    let all = vectors.concat();
    let moved = |compliance: &Compliance, x: &[f64]| {
        let mut out = vec![0.0; x.len()];
        compliance.mul_all(x, &mut out);
        out
    };
    for ranks in [1, 2, 3, 6] {
        let spread = MumpsOptions {
            ranks,
            spread: Some(true),
            ..PLAIN
        };
        let engine = start(spread);
        let (factor, schur) = factor(engine, &Unkept(a.clone()), marks).unwrap();
        assert!(!factor.ordered().compliance_is_here());
        assert!((schur.trace(n) / trace - 1.0).abs() < 1e-12);
        close(
            &schur.products(&vectors).unwrap().concat(),
            &felt.concat(),
            1e-12,
        );
        assert_eq!(schur.pieces(n, |_, _| false), pieces);
        let (root, inner) = reduced_and_recovered(&*factor, 3);
        let (root_0, inner_0) = reduced_and_recovered(&*builtin, 3);
        close(&root, &root_0, 1e-11);
        close(&inner, &inner_0, 1e-11);
        let far = schur.invert(n, modes, 3.0, &work).unwrap();
        assert!(!far.is_here() && far.bytes() == 0);
        close(&moved(&far, &all), &moved(&compliance, &all), 1e-11);
        let some = (0..n)
            .filter(|i| i % 3 == 0)
            .collect::<Vec<_>>()
            .into_iter();
        let x = &all[..2 * some.len()];
        let both = [far.cut(some.clone()), compliance.cut(some)];
        close(&moved(&both[0], x), &moved(&both[1], x), 1e-11);
    }
}

#[test]
#[ignore = "needs the MUMPS engine: `cargo xtask engine mumps`, then `cargo test --tests -- --ignored`"]
fn an_inverse_that_does_not_exist_is_refused_where_it_is_spread() {
    let spread = MumpsOptions {
        ranks: 2,
        spread: Some(true),
        ..PLAIN
    };
    let engine = start(spread);
    let a = grid([7, 6, 6], 3);
    let kept: Vec<bool> = (0..a.points()).map(|p| p % 9 == 8).collect();
    let fixed = vec![false; a.rows()];
    let (factor, schur) = factor(engine, &a, (&fixed, &kept)).unwrap();
    let n = factor.ordered().root().len();
    let mode = vec![vec![1.0; n]];
    let refused = schur.invert(n, &mode, -1e3, &Workspace::default());
    assert_eq!(refused.err(), Some(LinearError::Indefinite));
}

#[test]
#[ignore = "needs the MUMPS engine: `cargo xtask engine mumps`, then `cargo test --tests -- --ignored`"]
fn bodies_that_nothing_holds_and_those_without_memory_are_refused() {
    let engine = start(PLAIN);
    let a = grid([7, 6, 6], 3);
    let (fixed, kept) = (vec![false; a.rows()], vec![false; a.points()]);
    let free = factor(Arc::clone(&engine) as _, &a, (&fixed, &kept));
    assert_eq!(free.err(), Some(LinearError::Indefinite));

    let tight = MumpsOptions {
        memory: Some(1),
        ..PLAIN
    };
    let engine = start(tight);
    let a = grid([14, 14, 14], 3);
    let fixed: Vec<bool> = (0..a.rows()).map(|dof| dof < 600).collect();
    let refused = factor(engine, &a, (&fixed, &vec![false; a.points()]));
    let message = refused.err().map(|e| e.to_string()).unwrap_or_default();
    assert!(
        message.contains("the memory that a rank may take"),
        "{message}"
    );
}

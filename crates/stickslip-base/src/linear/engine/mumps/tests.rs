//! Against the built-in engine, where the program of the ranks has been built.

use std::sync::Arc;

use super::{Mumps, MumpsOptions};
use crate::linear::testing::{grid, noise};
use crate::linear::{BlockCsr, Engine, Interior, LinearError, Multifrontal, Numbers, Workspace};

const PLAIN: MumpsOptions = MumpsOptions {
    ranks: 1,
    out_of_core: false,
    low_rank: None,
    memory: None,
};

/// The engine; `None` and a word where its program has not been built. Whatever else is wrong with it is a failure.
fn start(options: MumpsOptions) -> Option<Arc<Mumps>> {
    match Mumps::start(options) {
        Ok(engine) => Some(Arc::new(engine)),
        Err(LinearError::Engine { message, .. }) if message.contains("a program of its own") => {
            println!("NOT RUN: {message}");
            None
        }
        Err(error) => panic!("{error}"),
    }
}

type Factored = (Box<dyn Interior>, Numbers);

fn factor(
    engine: Arc<dyn Engine>,
    matrix: &BlockCsr,
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
    let none = vec![false; a.points()];
    for options in cases {
        let Some(engine) = start(options) else {
            return;
        };
        for kept in [&some, &none] {
            let builtin = factor(Arc::new(Multifrontal), &a, (&fixed, kept)).unwrap();
            let mumps = factor(Arc::clone(&engine) as _, &a, (&fixed, kept)).unwrap();
            assert_eq!(mumps.0.ordered().root(), builtin.0.ordered().root());
            close(&mumps.1, &builtin.1, 1e-12);
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
fn bodies_that_nothing_holds_and_those_without_memory_are_refused() {
    let Some(engine) = start(PLAIN) else {
        return;
    };
    let a = grid([7, 6, 6], 3);
    let (fixed, kept) = (vec![false; a.rows()], vec![false; a.points()]);
    let free = factor(Arc::clone(&engine) as _, &a, (&fixed, &kept));
    assert_eq!(free.err(), Some(LinearError::Indefinite));

    let tight = MumpsOptions {
        memory: Some(1),
        ..PLAIN
    };
    let Some(engine) = start(tight) else {
        return;
    };
    let a = grid([14, 14, 14], 3);
    let fixed: Vec<bool> = (0..a.rows()).map(|dof| dof < 600).collect();
    let refused = factor(engine, &a, (&fixed, &vec![false; a.points()]));
    let message = refused.err().map(|e| e.to_string()).unwrap_or_default();
    assert!(
        message.contains("the memory that a rank may take"),
        "{message}"
    );
}

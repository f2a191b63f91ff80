use std::ops::Range;
use std::sync::Arc;

use super::super::testing::{dense_of, grid, noise};
use super::super::{BlockCsr, LinearError, Symbolic};
use super::{Fronts, PartialFactor, Workspace};
use crate::linear::multifrontal::sweep;

pub(super) fn factor(
    a: &BlockCsr,
    points: Range<usize>,
    fixed: &[bool],
    kept: &[bool],
) -> Result<(PartialFactor, Vec<f64>), LinearError> {
    let fronts = Arc::new(Fronts::analyze(a, points, fixed, kept)?);
    let (factor, schur) = PartialFactor::new(&fronts, a, &Workspace::default())?;
    Ok((factor, schur.to_vec()))
}

/// Marks with a given probability, the same on every run.
fn marks(seed: &mut u64, count: usize, share: f64) -> Vec<bool> {
    noise(seed, count)
        .iter()
        .map(|v| 0.5 * (v + 1.0) < share)
        .collect()
}

fn assert_close(x: &[f64], y: &[f64], size: f64) {
    assert_eq!(x.len(), y.len());
    for (i, (a, b)) in x.iter().zip(y).enumerate() {
        assert!((a - b).abs() < 1e-10 * size, "{i}: {a} instead of {b}");
    }
}

/// Dense elimination of `order`'s first `n` dofs: the factor's columns, and what is left, row by row.
fn eliminate(a: &BlockCsr, order: &[u32], n: usize) -> Vec<f64> {
    let (m, dense, rows) = (order.len(), dense_of(a), a.rows());
    let mut k: Vec<f64> = (0..m * m)
        .map(|at| dense[order[at / m] as usize * rows + order[at % m] as usize])
        .collect();
    for j in 0..n {
        let pivot = k[j * m + j].sqrt();
        for i in j..m {
            k[i * m + j] /= pivot;
        }
        for i in j + 1..m {
            for l in j + 1..=i {
                k[i * m + l] -= k[i * m + j] * k[l * m + j];
            }
        }
    }
    k
}

/// Compares the Schur complement and the sweeps with dense elimination; returns the sizes.
fn compare(a: &BlockCsr, points: Range<usize>, fixed: &[bool], kept: &[bool]) -> (usize, usize) {
    let (factor, schur) = factor(a, points.clone(), fixed, kept).unwrap();
    let fronts = factor.fronts();
    let (n, c) = (fronts.interior().len(), fronts.root().len());
    let order: Vec<u32> = [fronts.interior(), fronts.root()].concat();
    let mut sorted = order.clone();
    sorted.sort_unstable();
    let b = a.block_size();
    let free = points.start * b..points.end * b;
    let expected: Vec<u32> = free
        .filter(|&dof| !fixed[dof])
        .map(|dof| dof as u32)
        .collect();
    assert_eq!(sorted, expected);
    assert!(fronts.root().is_sorted());
    assert!(fronts.root().iter().all(|&dof| kept[dof as usize / b]));
    assert!(fronts.interior().iter().all(|&dof| !kept[dof as usize / b]));

    let m = n + c;
    let l = eliminate(a, &order, n);
    assert_eq!(schur.len(), c * c);
    let size = a.norm_inf();
    for j in 0..c {
        for i in 0..c {
            let expected = if i < j { 0.0 } else { l[(n + i) * m + n + j] };
            let found = schur[j * c + i];
            assert!(
                (found - expected).abs() < 1e-11 * size,
                "S {i} {j}: {found} {expected}"
            );
        }
    }
    for columns in [0, 1, 2, 5, 33] {
        let f = noise(&mut 9, n * columns);
        let g = noise(&mut 10, c * columns);
        let (mut x, mut w) = (f.clone(), g.clone());
        sweep::forward(&factor, &mut x, &mut w, columns);
        let (mut y, mut z) = (f, g);
        for k in 0..columns {
            let (y, z) = (&mut y[k * n..][..n], &mut z[k * c..][..c]);
            for j in 0..n {
                y[j] /= l[j * m + j];
                for i in j + 1..m {
                    let change = l[i * m + j] * y[j];
                    *if i < n { &mut y[i] } else { &mut z[i - n] } -= change;
                }
            }
        }
        let size = x.iter().fold(1.0, |m: f64, v| m.max(v.abs()));
        assert_close(&x, &y, size);
        assert_close(&w, &z, size.max(10.0));
        let u = noise(&mut 11, c * columns);
        sweep::backward(&factor, &mut x, &u, columns);
        for k in 0..columns {
            let (y, u) = (&mut y[k * n..][..n], &u[k * c..][..c]);
            for j in (0..n).rev() {
                for i in j + 1..m {
                    y[j] -= l[i * m + j] * if i < n { y[i] } else { u[i - n] };
                }
                y[j] /= l[j * m + j];
            }
        }
        let size = x.iter().fold(1.0, |m: f64, v| m.max(v.abs()));
        assert_close(&x, &y, size);
    }
    (n, c)
}

#[test]
fn is_dense_elimination_whatever_is_held_and_kept() {
    let mut seed = 5;
    for (counts, block) in [
        ([4, 3, 1], 2),
        ([13, 11, 1], 2),
        ([3, 3, 2], 3),
        ([6, 5, 4], 3),
    ] {
        let mut a = grid(counts, block);
        // So that nothing has to be held.
        for dof in 0..a.rows() {
            a.add_diagonal(dof, 0.05);
        }
        let points = a.points();
        for (held, kept) in [(0.0, 0.0), (0.1, 0.1), (0.3, 0.5), (0.6, 0.2), (0.2, 1.0)] {
            let fixed = marks(&mut seed, a.rows(), held);
            let kept = marks(&mut seed, points, kept);
            let (n, c) = compare(&a, 0..points, &fixed, &kept);
            assert_eq!(n + c, fixed.iter().filter(|f| !**f).count());
        }
        // A face kept, as a contact does.
        let kept: Vec<bool> = (0..points).map(|p| p >= points - counts[0]).collect();
        compare(&a, 0..points, &vec![false; a.rows()], &kept);
        compare(&a, 0..points, &vec![true; a.rows()], &kept);
        compare(&a, 1..1, &vec![false; a.rows()], &kept);
    }
}

/// Two grids and lonely points between them, which only the diagonal holds.
fn bodies(block: usize) -> BlockCsr {
    let one = grid([4, 4, 1], block);
    let (n, gap) = (one.points(), 60);
    let mut a = BlockCsr::from_couplings(2 * n + gap, block, &mut |add| {
        for start in [0, n + gap] {
            for point in 0..n {
                for &other in one.neighbours(point) {
                    add(&[start + point, start + other as usize]);
                }
            }
        }
    });
    for start in [0, n + gap] {
        for point in 0..n {
            for &other in one
                .neighbours(point)
                .iter()
                .filter(|&&q| q as usize > point)
            {
                let (p, q) = (point * block, other as usize * block);
                let dofs: Vec<usize> = (p..p + block).chain(q..q + block).collect();
                let mut dense = vec![0.0; dofs.len() * dofs.len()];
                for (i, row) in dofs.iter().enumerate() {
                    for (j, column) in dofs.iter().enumerate() {
                        if i / block != j / block {
                            dense[i * dofs.len() + j] = one.entry(*row, *column);
                        }
                    }
                }
                a.add_group(&[start + point, start + other as usize], &dense);
            }
        }
    }
    for dof in 0..a.rows() {
        a.add_diagonal(dof, 20.0);
    }
    a
}

#[test]
fn parts_of_a_matrix_and_parts_without_couplings() {
    for block in [2, 3] {
        let a = bodies(block);
        let points = a.points();
        let fixed = marks(&mut 3, a.rows(), 0.1);
        let kept = marks(&mut 4, points, 0.2);
        compare(&a, 0..points, &fixed, &kept);
        compare(&a, 16..76, &fixed, &kept);
        compare(&a, 40..points, &fixed, &kept);
        compare(&a, 0..16, &fixed, &vec![false; points]);
    }
    // Couplings to fixed points outside are none, others are refused.
    let mut a = grid([6, 5, 4], 3);
    let kept = vec![false; a.points()];
    let mut fixed: Vec<bool> = (0..a.rows()).map(|dof| dof < 90).collect();
    compare(&a, 30..120, &fixed, &kept);
    fixed[89] = false;
    let error = factor(&a, 30..120, &fixed, &kept).unwrap_err();
    assert!(
        matches!(error, LinearError::NotAnalysed { dofs: [_, 89] }),
        "{error:?}"
    );
    a.clear();
}

#[test]
fn without_kept_dofs_it_solves() {
    let a = grid([9, 8, 7], 3);
    let fixed: Vec<bool> = (0..a.rows())
        .map(|dof| dof < 72 * 3 || dof == 1000)
        .collect();
    let (factor, schur) = factor(&a, 0..a.points(), &fixed, &vec![false; a.points()]).unwrap();
    assert!(schur.is_empty());
    let interior = factor.fronts().interior();
    let mut u = vec![0.0; a.rows()];
    for (&dof, value) in interior.iter().zip(noise(&mut 1, interior.len())) {
        u[dof as usize] = value;
    }
    let mut f = vec![0.0; a.rows()];
    a.mul(&u, &mut f);
    let mut x: Vec<f64> = interior.iter().map(|&dof| f[dof as usize]).collect();
    sweep::forward(&factor, &mut x, &mut [], 1);
    sweep::backward(&factor, &mut x, &[], 1);
    let expected: Vec<f64> = interior.iter().map(|&dof| u[dof as usize]).collect();
    assert_close(&x, &expected, 1.0);
}

/// A cube large enough for tasks and shared fronts, its lower face held and its upper one kept.
pub(super) fn cube(n: usize) -> (BlockCsr, Vec<bool>, Vec<bool>) {
    let a = grid([n, n, n], 3);
    let fixed = (0..a.rows()).map(|dof| dof < 3 * n * n).collect();
    let kept = (0..a.points())
        .map(|point| point >= a.points() - n * n)
        .collect();
    (a, fixed, kept)
}

#[test]
fn sizes_are_known_before() {
    let (a, fixed, kept) = cube(11);
    let (factor, _) = factor(&a, 0..a.points(), &fixed, &kept).unwrap();
    let fronts = factor.fronts();
    assert!(fronts.pieces.len() > 4, "{}", fronts.pieces.len());
    let nothing = vec![false; a.points()];
    let complete = Fronts::analyze(&a, 0..a.points(), &fixed, &nothing).unwrap();
    let columns = Symbolic::analyze(&a, &fixed, &[]).unwrap();
    let share = complete.nonzeros() as f64 / columns.factor_nonzeros() as f64;
    assert!((1.0..1.25).contains(&share), "{share}");
    let share = complete.flops() / columns.flops();
    assert!((1.0..1.3).contains(&share), "{share}");
    let c = fronts.root().len() as f64;
    let n = fronts.interior().len() as f64;
    assert!(fronts.flops() > n * c && fronts.flops() < (n + c).powi(3));
    assert!(fronts.peak_bytes() > 8 * fronts.nonzeros() as u64);
    assert!(fronts.peak_bytes() < 80 * fronts.nonzeros() as u64);
}

#[test]
fn bits_do_not_depend_on_threads() {
    let (a, fixed, kept) = cube(15);
    let fronts = Arc::new(Fronts::analyze(&a, 0..a.points(), &fixed, &kept).unwrap());
    let large = (0..fronts.len()).filter(|&f| super::dense::is_large(fronts.tree.flops_of(f)));
    assert!(large.count() > 2);
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| {
            let (factor, schur) = PartialFactor::new(&fronts, &a, &Workspace::default()).unwrap();
            let mut bits: Vec<u64> = schur.iter().map(|v| v.to_bits()).collect();
            bits.extend(factor.panels.iter().flatten().map(|v| v.to_bits()));
            for columns in [1, 3] {
                let mut x = noise(&mut 1, fronts.interior().len() * columns);
                let mut w = noise(&mut 2, fronts.root().len() * columns);
                sweep::forward(&factor, &mut x, &mut w, columns);
                sweep::backward(&factor, &mut x, &w, columns);
                bits.extend(x.iter().chain(&w).map(|v| v.to_bits()));
            }
            bits
        })
    };
    let one = run(1);
    for threads in 1..=4 {
        assert!(one == run(threads), "{threads} threads");
    }
}

#[test]
fn singular_interiors_are_named() {
    // The kept face is not enough if a second body has nothing that holds it.
    let a = bodies(3);
    let mut free = a.zeros_like();
    free.add_scaled(1.0, &a);
    for dof in 0..16 * 3 {
        free.add_diagonal(dof, -20.0);
    }
    let held = vec![false; a.rows()];
    let kept: Vec<bool> = (0..a.points()).map(|p| p >= 76).collect();
    let error = factor(&free, 0..a.points(), &held, &kept).unwrap_err();
    assert!(
        matches!(error, LinearError::NotPositive { dof } if dof < 48),
        "{error:?}"
    );

    let a = grid([6, 6, 6], 3);
    let nothing = vec![false; a.points()];
    let error = factor(&a, 0..216, &vec![false; a.rows()], &nothing).unwrap_err();
    let named = match error {
        LinearError::Singular { ratio, .. } => ratio < 1e-10,
        LinearError::NotPositive { .. } => true,
        _ => false,
    };
    assert!(named, "{error:?}");
    // One kept point is enough for springs that resist rotation; the rest is then in the Schur complement.
    let one: Vec<bool> = (0..216).map(|p| p == 100).collect();
    let (_, schur) = factor(&a, 0..216, &vec![false; a.rows()], &one).unwrap();
    assert!(schur.iter().all(|v| v.abs() < 1e-10));

    for kept in [nothing, one, vec![true; 216]] {
        let mut bad = grid([6, 6, 6], 3);
        bad.add_diagonal(301, f64::NAN);
        let fixed: Vec<bool> = (0..a.rows()).map(|dof| dof < 9).collect();
        let error = factor(&bad, 0..216, &fixed, &kept).unwrap_err();
        assert_eq!(error, LinearError::NotFinite { dof: 301 });
    }
}

//! `cargo bench --bench explicit_kernel`: internal forces without a matrix, in cells a second, next to what the machine
//! can do.
//!
//! The bandwidth is that of a triad `a = b + s c` on arrays too large for the caches, three numbers of eight bytes
//! counted an entry; the flops are those of independent fused multiplications and additions, two counted each. Counted
//! for a cell are
//!
//! - bytes: two for the number of each of its nodes; for its share of the points of the chunks (1.8 a hexahedron, 0.3 a
//!   tetrahedron) number, place, displacement, force written, its place in the sum and force read, 128 a point; for its
//!   share of the points of the mesh the sum, 28 a point;
//! - flops: those of the formulas of the kernel, a fused operation as two.
//!
//! Times are the least of several runs. They are those of this machine now.

use std::hint::black_box;
use std::sync::Arc;
use std::time::Instant;

use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;
use stickslip::body::internal::InternalForce;
use stickslip::body::{Elastic, Formulation, Part, Space};
use stickslip::material::{Anisotropic, Elasticity, Isotropic, Stiffness};
use stickslip::mesh::Mesh;
use stickslip::mesh::generators::{Cuboid, Generate};
use stickslip::registry::Samples;
use stickslip::shape::ElementKind;
use stickslip::system::Dofs;

/// The least time of `runs` calls in seconds.
fn least(runs: usize, mut call: impl FnMut()) -> f64 {
    (0..runs)
        .map(|_| {
            let start = Instant::now();
            call();
            start.elapsed().as_secs_f64()
        })
        .fold(f64::INFINITY, f64::min)
}

/// Bytes a second of a triad.
fn bandwidth() -> f64 {
    const ENTRIES: usize = 1 << 25;
    let (b, c) = (vec![1.0_f64; ENTRIES], vec![2.0_f64; ENTRIES]);
    let mut a = vec![0.0_f64; ENTRIES];
    let seconds = least(6, || {
        a.par_chunks_mut(1 << 15)
            .zip(b.par_chunks(1 << 15))
            .zip(c.par_chunks(1 << 15))
            .for_each(|((a, b), c)| {
                for ((a, b), c) in a.iter_mut().zip(b).zip(c) {
                    *a = b + 3.0 * c;
                }
            });
        black_box(&a);
    });
    (24 * ENTRIES) as f64 / seconds
}

/// A chain of fused operations on 12 registers.
struct Fused(usize);

impl WithSimd for Fused {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> f64 {
        let (factor, summand) = (simd.splat_f64s(0.999), simd.splat_f64s(black_box(1e-3)));
        let mut sums = [simd.splat_f64s(black_box(1.0)); 12];
        for _ in 0..self.0 {
            for sum in &mut sums {
                *sum = simd.mul_add_e_f64s(*sum, factor, summand);
            }
        }
        let total = sums
            .into_iter()
            .fold(simd.splat_f64s(0.0), |a, b| simd.add_f64s(a, b));
        black_box(simd.reduce_sum_f64s(total));
        (2 * 12 * self.0 * S::F64_LANES) as f64
    }
}

/// Flops a second of all threads.
fn flops() -> f64 {
    let threads = rayon::current_num_threads();
    let mut count = 0.0;
    let seconds = least(6, || {
        count = (0..threads)
            .into_par_iter()
            .map(|_| Arch::new().dispatch(Fused(10_000_000)))
            .sum();
    });
    count / seconds
}

/// What is counted for a cell.
struct Cost {
    bytes: f64,
    flops: f64,
}

/// Bytes of `nodes` nodes a cell, `chunked` points of chunks a cell and `points` points of the mesh a cell.
fn bytes(nodes: f64, chunked: f64, points: f64) -> f64 {
    2.0 * nodes + 128.0 * chunked + 28.0 * points
}

/// The flops of the kernels; see their formulas. `stress` is what the law takes at a point.
fn hexahedron(stress: f64) -> f64 {
    // Modes and derivatives of places and displacements, cofactors and determinants, strains, tractions, and back.
    let point = (9.0 * 3.0 + 5.0) + (3.0 * 5.0 + 3.0 * 11.0) + 1.0 + stress + 54.0;
    6.0 * (24.0 + 4.0 + 24.0) + 8.0 * point + 3.0 * (29.0 + 27.0)
}

fn parallelepiped(stress: f64) -> f64 {
    let columns = |n: f64| n * (6.0 + 12.0) - 6.0 + 18.0 * n + stress;
    3.0 * 28.0 + 9.0 + 33.0 + columns(3.0) + 3.0 * columns(2.0) + 3.0 * columns(1.0) + 3.0 * 27.0
}

fn tetrahedron(stress: f64) -> f64 {
    18.0 + 33.0 + 48.0 + stress + 54.0 + 9.0
}

/// Flops of the stress of an isotropic material.
const ISOTROPIC: f64 = 15.0;
/// Of that of any other.
const GENERAL: f64 = 72.0;
/// Of mean dilatation, at each point of a hexahedron.
const MEAN: f64 = 51.0;

fn mesh(element: ElementKind, cells: [usize; 3], distorted: bool) -> Mesh {
    let mut box_ = Cuboid::new([0.0; 3], [1.0, 1.1, 0.9], cells);
    box_.element = element;
    let mut mesh = box_.generate().expect("a box");
    if distorted {
        for x in &mut mesh.points {
            let [a, b, c] = *x;
            *x = [
                a + 0.05 * (5.0 * b + c).sin(),
                b + 0.05 * (4.0 * c - a).cos(),
                c + 0.05 * (6.0 * a * b).sin(),
            ];
        }
    }
    mesh
}

fn general() -> Stiffness {
    Anisotropic::samples()[0].stiffness().expect("sound")
}

fn isotropic() -> Stiffness {
    Isotropic {
        young: 210e9,
        poisson: 0.3,
        density: 7800.0,
    }
    .stiffness()
    .expect("sound")
}

fn run(
    what: &str,
    mesh: &Arc<Mesh>,
    stiffness: Stiffness,
    formulation: Formulation,
    cost: &Cost,
    machine: [f64; 2],
    threads: usize,
) {
    let part = Part {
        block: 0,
        stiffness,
        density: 7800.0,
        ..Part::default()
    };
    let body = Elastic::new("bench", mesh.clone(), Space::Solid, formulation, vec![part])
        .expect("a sound body");
    let dofs = Dofs {
        dim: 3,
        points: mesh.points.len(),
    };
    let mut internal = InternalForce::new(&[&body], dofs);
    let u: Vec<f64> = (0..dofs.count()).map(|i| (0.7 * i as f64).sin()).collect();
    let mut f = vec![0.0; dofs.count()];
    internal.apply(&u, &mut f);
    let seconds = least(40, || internal.apply(black_box(&u), black_box(&mut f)));
    let rate = internal.cells() as f64 / seconds;
    println!(
        "{what:<34} {:>7} cells {threads:>2} threads {:>7.2} M/s {:>7.2} M/s each | {:>4.0} B {:>5.1} GB/s {:>3.0} % | {:>5.0} flops {:>6.1} Gflop/s {:>3.0} %",
        internal.cells(),
        1e-6 * rate,
        1e-6 * rate / threads as f64,
        cost.bytes,
        1e-9 * rate * cost.bytes,
        100.0 * rate * cost.bytes / machine[0],
        cost.flops,
        1e-9 * rate * cost.flops,
        100.0 * rate * cost.flops / machine[1],
    );
}

/// How wide the registers in use are.
fn registers() -> String {
    struct Width;
    impl WithSimd for Width {
        type Output = usize;

        #[inline(always)]
        fn with_simd<S: Simd>(self, _simd: S) -> usize {
            S::F64_LANES
        }
    }
    format!("{} numbers a register", Arch::new().dispatch(Width))
}

fn all(threads: usize) {
    let machine = [bandwidth(), flops()];
    println!(
        "{threads} threads, {}: triad {:.1} GB/s, fused operations {:.1} Gflop/s",
        registers(),
        1e-9 * machine[0],
        1e-9 * machine[1]
    );
    use Formulation::{MeanDilatation, Standard};
    let straight = Arc::new(mesh(ElementKind::Hex8, [46, 46, 46], false));
    let bent = Arc::new(mesh(ElementKind::Hex8, [46, 46, 46], true));
    let tets = Arc::new(mesh(ElementKind::Tet4, [26, 26, 26], true));
    let hex = bytes(8.0, 1.8, 1.0);
    let cost = |bytes, flops| Cost { bytes, flops };
    for (what, mesh, stiffness, formulation, cost) in [
        (
            "hex8 distorted isotropic",
            &bent,
            isotropic(),
            Standard,
            cost(hex, hexahedron(ISOTROPIC)),
        ),
        (
            "hex8 distorted general",
            &bent,
            general(),
            Standard,
            cost(hex, hexahedron(GENERAL)),
        ),
        (
            "hex8 distorted isotropic mean dil.",
            &bent,
            isotropic(),
            MeanDilatation,
            cost(hex, hexahedron(ISOTROPIC + MEAN)),
        ),
        (
            "hex8 box isotropic",
            &straight,
            isotropic(),
            Standard,
            cost(hex, parallelepiped(ISOTROPIC)),
        ),
        (
            "hex8 box general",
            &straight,
            general(),
            Standard,
            cost(hex, parallelepiped(GENERAL)),
        ),
        (
            "tet4 isotropic",
            &tets,
            isotropic(),
            Standard,
            cost(bytes(4.0, 0.3, 1.0 / 6.0), tetrahedron(ISOTROPIC)),
        ),
        (
            "tet4 general",
            &tets,
            general(),
            Standard,
            cost(bytes(4.0, 0.3, 1.0 / 6.0), tetrahedron(GENERAL)),
        ),
    ] {
        run(what, mesh, stiffness, formulation, &cost, machine, threads);
    }
}

fn main() {
    let most = std::thread::available_parallelism().map_or(1, usize::from);
    let mut counts = vec![1, most];
    counts.dedup();
    for threads in counts {
        rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .expect("a pool of threads")
            .install(|| all(threads));
    }
}

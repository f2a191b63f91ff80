use std::sync::{Arc, Mutex, PoisonError};
use std::time::Instant;

use faer::Mat;

use super::identity::Identity;
use crate::linear::{
    Analysed, Compliance, Digest, Interior, LinearError, Matrix, Schur, Workspace,
};
use crate::math::Vec3;
use crate::math::vector::{dot, norm};

/// Times of a factorisation `[s]`.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Seconds {
    /// Partial factorisation of the sparse matrix.
    pub factor: f64,
    /// Inverse of what remains.
    pub condense: f64,
}

/// A body without its interior: the dofs where it may touch others, and their compliance.
///
/// Of the stiffness `K` of the body remains `S = K_CC - K_CI K_II⁻¹ K_IC` at the kept dofs `C`, and of that the inverse. Where the supports
/// leave the body free to move, artificial springs `σ R Rᵀ` along its rigid motions `R` make the inverse exist; whoever uses it takes them away
/// again.
#[derive(Debug)]
pub struct Substructure {
    /// What it was made from.
    pub identity: Identity,
    /// Factor of the interior.
    pub interior: Box<dyn Interior>,
    /// `(S + σ R Rᵀ)⁻¹`.
    pub compliance: Compliance,
    /// Rigid motions with artificial springs.
    pub floating: Option<Floating>,
    /// Times of the factorisation.
    pub seconds: Seconds,
    /// Load patterns that were swept forward.
    pub(super) swept: SweptPatterns,
}

/// What is left of forces at the kept dofs, and what the interior keeps of them.
pub(super) type SweptPart = (Vec<f64>, Vec<f64>);

/// Load patterns that were swept through the factor, by their digest, the last ones: runs with the same body mostly have the same loads.
#[derive(Debug, Default)]
pub(super) struct SweptPatterns(Mutex<Vec<([u64; 2], Arc<SweptPart>)>>);

/// Most patterns that are kept with a factor. Each takes as much as a vector by dof.
const MOST_SWEPT: usize = 16;

/// Rigid motions of a body, or of each of its pieces, that are almost unconstrained.
#[derive(Debug)]
pub struct Floating {
    /// Orthonormal motions `R` at the kept dofs, one after the other.
    pub modes: Vec<Vec<f64>>,
    /// Stiffness of the artificial springs `[N/m]`.
    pub sigma: f64,
    /// Compliance products `Z = (S + σ R Rᵀ)⁻¹ R`.
    pub products: Vec<Vec<f64>>,
}

impl Floating {
    /// Motions held by artificial springs that are part of the compliance.
    pub(super) fn new(modes: Vec<Vec<f64>>, sigma: f64, compliance: &Compliance) -> Self {
        let products = modes.iter().map(|mode| {
            let mut z = vec![0.0; mode.len()];
            compliance.mul(mode, &mut z);
            z
        });
        Floating {
            products: products.collect(),
            modes,
            sigma,
        }
    }
}

/// What holds motions of a part that nothing else does.
#[derive(Clone, Copy)]
pub struct ArtificialSprings<'a> {
    /// The position of a point, `None` for the hidden points of rigid bodies.
    pub places: &'a (dyn Fn(usize) -> Option<Vec3> + Sync),
    /// A stiffness for springs where there is no other `[N/m]`.
    pub typical: f64,
}

impl Substructure {
    /// Factors a body.
    ///
    /// # Errors
    /// Those of the factorisation: the interior is singular if the kept points do not hold it.
    pub fn new(
        identity: Identity,
        ordered: &Arc<dyn Analysed>,
        matrix: &dyn Matrix,
        springs: ArtificialSprings,
        workspace: &Workspace,
    ) -> Result<Substructure, LinearError> {
        let started = Instant::now();
        let (interior, schur) = Arc::clone(ordered).factor(matrix, workspace)?;
        let factor = started.elapsed().as_secs_f64();
        let started = Instant::now();
        let root = ordered.root();
        let floating = free_motions(root, matrix.block_size(), &schur, springs)?;
        let (modes, sigma) = floating
            .as_ref()
            .map_or((&[][..], 0.0), |(modes, sigma)| (&modes[..], *sigma));
        let compliance = schur.invert(root.len(), modes, sigma, workspace);
        let compliance = compliance.map_err(|e| match e {
            LinearError::NotPositive { dof } => LinearError::NotPositive {
                dof: ordered.root().get(dof).map_or(0, |&d| d as usize),
            },
            other => other,
        })?;
        let floating = floating.map(|(modes, sigma)| Floating::new(modes, sigma, &compliance));
        Ok(Substructure {
            identity,
            interior,
            compliance,
            floating,
            seconds: Seconds {
                factor,
                condense: started.elapsed().as_secs_f64(),
            },
            swept: SweptPatterns::default(),
        })
    }

    /// Sweeps forces over all dofs forward: what is left of them at the kept dofs, and what the interior keeps.
    pub(super) fn sweep(&self, forces: &[f64]) -> Result<SweptPart, LinearError> {
        let (mut root, mut interior) = self.own(forces);
        self.interior.reduce(&mut interior, &mut root, 1)?;
        Ok((root, interior))
    }

    /// The same of forces that other runs are likely to have, too.
    pub(super) fn sweep_pattern(&self, forces: &[f64]) -> Result<SweptPart, LinearError> {
        let (mut root, mut interior) = self.own(forces);
        let mut digest = Digest::default();
        digest.floats(&root);
        digest.floats(&interior);
        let digest = digest.finish();
        let known = || self.swept.0.lock().unwrap_or_else(PoisonError::into_inner);
        let found = known()
            .iter()
            .find(|(of, _)| *of == digest)
            .map(|(_, swept)| Arc::clone(swept));
        if let Some(found) = found {
            return Ok(SweptPart::clone(&found));
        }
        self.interior.reduce(&mut interior, &mut root, 1)?;
        let swept = (root, interior);
        let mut known = known();
        if known.len() == MOST_SWEPT {
            known.remove(0);
        }
        known.push((digest, Arc::new(swept.clone())));
        Ok(swept)
    }

    /// Forces at the kept dofs, and in the interior.
    fn own(&self, forces: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let take = |dofs: &[u32]| dofs.iter().map(|&d| forces[d as usize]).collect();
        let ordered = self.interior.ordered();
        (take(ordered.root()), take(ordered.interior()))
    }

    /// About the memory held `[bytes]`, with the compliance in single precision that Newton's method makes.
    pub fn bytes(&self) -> u64 {
        let n = self.root().len() as u64;
        let modes = self.floating.as_ref().map_or(0, |f| f.modes.len() as u64);
        let dense = if self.compliance.is_here() { 12 } else { 0 };
        self.interior.bytes() + self.interior.ordered().bytes() + dense * n * n + 16 * modes * n
    }

    /// The kept dofs, ascending.
    pub fn root(&self) -> &[u32] {
        self.interior.ordered().root()
    }
}

/// Orthonormal rigid motions that meet next to no stiffness, and what springs to hold them with.
fn free_motions(
    root: &[u32],
    dim: usize,
    stiffness: &Schur,
    springs: ArtificialSprings,
) -> Result<Option<FreeMotions>, LinearError> {
    let ArtificialSprings {
        places: place,
        typical,
    } = springs;
    let n = root.len();
    if n == 0 {
        return Ok(None);
    }
    let trace: f64 = stiffness.trace(n) / n as f64;
    let hidden = root.iter().all(|&dof| place(dof as usize / dim).is_none());
    let sigma = if hidden { trace.max(typical) } else { trace };
    let motions: Vec<Vec<f64>> = if hidden {
        // The dofs of a rigid body are its motions.
        (0..n)
            .map(|i| (0..n).map(|j| f64::from(u8::from(i == j))).collect())
            .collect()
    } else {
        let of_part = |part: Vec<usize>| {
            let dofs: Vec<u32> = part.iter().map(|&i| root[i]).collect();
            let motions = rigid_motions(&dofs, dim, place).into_iter();
            motions.map(move |motion| {
                let mut whole = vec![0.0; n];
                part.iter().zip(motion).for_each(|(&i, m)| whole[i] = m);
                whole
            })
        };
        // Parts hang together by stiffness, dofs of a point always: there is one, but for bodies in pieces, as a cut through a bolt makes them.
        let of_point = |i: usize, j: usize| root[i] as usize / dim == root[j] as usize / dim;
        let parts = stiffness.pieces(n, of_point).into_iter();
        parts.flat_map(of_part).collect()
    };
    let basis = orthonormal(motions);
    // Artificial springs are added where the stiffness against a rigid motion is below this part of the mean of the diagonal. They are
    // exactly taken away again: more of them than needed do no harm.
    let soft = softest(&basis, &stiffness.products(&basis)?, 1e-6 * sigma);
    Ok((!soft.is_empty()).then_some((soft, sigma)))
}

/// Motions, and the stiffness of springs that hold them.
type FreeMotions = (Vec<Vec<f64>>, f64);

/// Translations and rotations at the dofs; those about the centre of the points have their size.
fn rigid_motions(root: &[u32], dim: usize, place: &dyn Fn(usize) -> Option<Vec3>) -> Vec<Vec<f64>> {
    let at: Vec<(Vec3, usize)> = root
        .iter()
        .map(|&dof| {
            let x = place(dof as usize / dim).unwrap_or_default();
            (x, dof as usize % dim)
        })
        .collect();
    let count = at.len() as f64;
    let centre: Vec3 = std::array::from_fn(|c| at.iter().map(|(x, _)| x[c]).sum::<f64>() / count);
    let turns: &[usize] = if dim == 2 { &[2] } else { &[0, 1, 2] };
    let mut motions: Vec<Vec<f64>> = (0..dim)
        .map(|c| {
            at.iter()
                .map(|&(_, k)| if k == c { 1.0 } else { 0.0 })
                .collect()
        })
        .collect();
    for &axis in turns {
        let (a, b) = ((axis + 1) % 3, (axis + 2) % 3);
        let turned = at.iter().map(|(x, k)| match *k {
            k if k == a => -(x[b] - centre[b]),
            k if k == b => x[a] - centre[a],
            _ => 0.0,
        });
        motions.push(turned.collect());
    }
    motions
}

/// An orthonormal basis of what vectors span.
fn orthonormal(vectors: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
    let mut basis: Vec<Vec<f64>> = Vec::new();
    for mut v in vectors {
        let before = norm(&v);
        for _ in 0..2 {
            for q in &basis {
                let s = dot(q, &v);
                v.iter_mut().zip(q).for_each(|(v, q)| *v -= s * q);
            }
        }
        let after = norm(&v);
        if after > 1e-8 * before {
            v.iter_mut().for_each(|v| *v /= after);
            basis.push(v);
        }
    }
    basis
}

/// Combinations of the basis that meet less than `limit` of the stiffness, of which there are the products with it.
fn softest(basis: &[Vec<f64>], products: &[Vec<f64>], limit: f64) -> Vec<Vec<f64>> {
    let m = basis.len();
    let n = basis.first().map_or(0, Vec::len);
    let small = Mat::from_fn(m, m, |i, j| dot(&basis[i], &products[j]));
    let Ok(eigen) = small.self_adjoint_eigen(faer::Side::Lower) else {
        return Vec::new();
    };
    (0..m)
        .filter(|&k| eigen.S()[k] <= limit)
        .map(|k| {
            let mut v = vec![0.0; n];
            for (i, q) in basis.iter().enumerate() {
                let s = eigen.U()[(i, k)];
                v.iter_mut().zip(q).for_each(|(v, q)| *v += s * q);
            }
            v
        })
        .collect()
}

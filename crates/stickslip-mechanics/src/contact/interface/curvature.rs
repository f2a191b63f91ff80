//! How gaps and slips over facets curve, face by face for a mortar and point by point for others: what the tangent has beside their gradients.

use rayon::prelude::*;

use super::cache::Cache;
use super::definition::Primary;
use super::evaluation::Evaluations;
use super::input::InterfaceInput;
use super::on_facet::curvature_of_point;
use crate::contact::facet_point::{FACET_NODES, evaluate};
use crate::contact::kinematics::{Convective, Kinematics, Pair};
use crate::contact::mortar::{Face, FaceIntegral, Mortar, Piece};
use crate::contact::projection::invert2;
use crate::contact::surface::Facet;
use crate::math::{Vec3, add_scaled, dot};
use crate::system::{Assembler, Dofs, Tangent};

/// Faces or points handled by one task.
const ITEMS_PER_TASK: usize = 8;

/// The second derivatives over one face, or of one point.
#[derive(Debug, Default)]
struct Block {
    dofs: Vec<usize>,
    hessian: Vec<f64>,
}

/// Adds how the shear forces of a piece change that carries the shear `t`: its place on the facet moves, and it turns with the facet.
///
/// The residual of a node of weight σ is `-σ t`. `δσ_k = -N_k,α δξ^α` with `δξ^α = a^α·(δx_s - δx̄)`, and
/// `δt = n (t·a^β) (n·δa_β)`, as shear stays in the facet and keeps its size.
fn add_shear(pair: &Pair, t: Vec3, out: &mut [f64]) {
    let foot = pair.foot;
    let d = pair.kind.dim();
    let metric: [[f64; 2]; 2] =
        std::array::from_fn(|i| std::array::from_fn(|j| dot(foot.a[i], foot.a[j])));
    let Some(inverse) = invert2(&metric) else {
        return;
    };
    let dual: [Vec3; 2] = std::array::from_fn(|i| {
        let first = foot.a[0].map(|x| inverse[i][0] * x);
        add_scaled(first, inverse[i][1], foot.a[1])
    });
    let own = pair.weights.len();
    let nodes = own + pair.facet.len();
    let sigma = |k: usize| match k.checked_sub(own) {
        None => pair.weights[k],
        Some(j) => -foot.n[j],
    };
    let n = nodes * pair.dim;
    for i in 0..nodes {
        for j in 0..nodes {
            let theirs = (i.checked_sub(own), j.checked_sub(own));
            let mut left = [0.0; 3];
            let mut turn = 0.0;
            for (beta, dual) in dual.iter().enumerate().take(d) {
                if let Some(i) = theirs.0 {
                    left = add_scaled(left, foot.dn[beta][i] * sigma(j), *dual);
                }
                if let Some(j) = theirs.1 {
                    turn -= sigma(i) * foot.dn[beta][j] * dot(t, *dual);
                }
            }
            for c in 0..pair.dim {
                for e in 0..pair.dim {
                    out[(i * pair.dim + c) * n + j * pair.dim + e] +=
                        t[c] * left[e] + turn * foot.normal[c] * foot.normal[e];
                }
            }
        }
    }
}

/// Pressure and shear in space of a point, over its share of the area.
type Carried = (f64, Vec3);

/// Faces of a mortar and where they are.
struct Curvature<'a> {
    dim: usize,
    dofs: Dofs,
    /// Points of the mesh by node of the interface.
    nodes: &'a [usize],
    x: &'a [Vec3],
    facets: &'a [Facet],
}

impl Curvature<'_> {
    /// The block of a face whose nodes carry something; `None` if they do not.
    fn block(
        &self,
        face: &Face,
        integral: &FaceIntegral,
        own: &[Option<Carried>],
        room: &mut Vec<f64>,
    ) -> Option<Block> {
        if own.iter().all(Option::is_none) || integral.pieces.is_empty() {
            return None;
        }
        let nodes = face.nodes.iter().chain(&integral.nodes);
        let dofs: Vec<usize> = nodes
            .flat_map(|&node| (0..self.dim).map(move |c| (node, c)))
            .map(|(node, c)| self.dofs.of(self.nodes[node], c))
            .collect();
        let n = dofs.len();
        let mut block = Block {
            dofs,
            hessian: vec![0.0; n * n],
        };
        for piece in &integral.pieces {
            let (mut pressure, mut shear) = (0.0, [0.0; 3]);
            for (own, share) in own.iter().zip(piece.shares) {
                if let Some((p, t)) = own {
                    pressure += share * p;
                    shear = add_scaled(shear, share, *t);
                }
            }
            if piece.area > 0.0 && (pressure != 0.0 || shear != [0.0; 3]) {
                self.element(face, piece, (pressure, shear), room);
                self.put(face, integral, piece, room, &mut block.hessian);
            }
        }
        Some(block)
    }

    /// The second derivatives of the contact element of a piece at its middle, in `room`.
    fn element(&self, face: &Face, piece: &Piece, carried: Carried, room: &mut Vec<f64>) {
        let (pressure, shear) = carried;
        let facet = &self.facets[piece.facet];
        let mut corners = [[0.0; 3]; FACET_NODES];
        let corners = facet.gather(self.x, &mut corners);
        let place = piece.place.map(|p| p / piece.area);
        let foot = evaluate(facet.kind, corners, place);
        let weights = piece.own.map(|w| w / piece.area);
        let weights = &weights[..face.nodes.len()];
        let point = (face.nodes.iter().zip(weights))
            .fold([0.0; 3], |s, (&node, &w)| add_scaled(s, w, self.x[node]));
        let pair = Pair {
            dim: self.dim,
            weights,
            point,
            kind: facet.kind,
            facet: corners,
            foot: &foot,
            anchor: &foot,
            point_before: point,
            belt: [0.0; 3],
        };
        room.clear();
        room.resize(pair.dofs() * pair.dofs(), 0.0);
        Convective {}.add_hessian(&pair, [-pressure, 0.0, 0.0], room);
        add_shear(&pair, shear, room);
    }

    /// Adds those of a piece to the block of its face.
    fn put(
        &self,
        face: &Face,
        integral: &FaceIntegral,
        piece: &Piece,
        room: &[f64],
        hessian: &mut [f64],
    ) {
        let (dim, facet) = (self.dim, &self.facets[piece.facet]);
        let n = (face.nodes.len() + integral.nodes.len()) * dim;
        let m = (face.nodes.len() + facet.nodes.len()) * dim;
        // where the nodes of the pair stand in the block
        let theirs = facet.nodes.iter().filter_map(|node| {
            let k = integral.nodes.iter().position(|n| n == node)?;
            Some(face.nodes.len() + k)
        });
        let at: Vec<usize> = (0..face.nodes.len()).chain(theirs).collect();
        for (i, &a) in at.iter().enumerate() {
            for (j, &b) in at.iter().enumerate() {
                for c in 0..dim {
                    for d in 0..dim {
                        hessian[(a * dim + c) * n + b * dim + d] +=
                            room[(i * dim + c) * m + j * dim + d];
                    }
                }
            }
        }
    }
}

/// Pressure and shear of a point at the node of a face; `None` if it carries nothing.
fn carried(interface: InterfaceInput, evaluations: &Evaluations, point: usize) -> Option<Carried> {
    let e = evaluations.points.get(point)?;
    let t = match interface.unknown() {
        true => e.kept.multiplier,
        false => e.response.traction,
    };
    (t != [0.0; 3]).then(|| {
        let [first, second] = e.frames.now;
        let along = first.map(|x| interface.share * t[1] * x);
        (
            interface.share * t[0],
            add_scaled(along, interface.share * t[2], second),
        )
    })
}

/// Adds the curvature of the gaps and slips over facets that carry something. A mortar adds none where surfaces keep the way they have turned.
pub(super) fn add_curvature(interface: InterfaceInput, cache: &Cache, out: &mut Assembler) {
    let Primary::Facets(facets) = &interface.primary else {
        return;
    };
    if !out.wants_tangent || interface.kinematics.as_dyn().frozen() {
        return;
    }
    let blocks = match &interface.mortar {
        Some(_) if out.holds_turns => return,
        Some(mortar) => curvature_of_faces(interface, mortar, facets, cache),
        None => curvature_of_points(interface, facets, cache),
    };
    let mut zeros = Vec::new();
    for block in blocks.iter().flatten() {
        let n = block.dofs.len();
        zeros.resize(zeros.len().max(n * n).max(3 * n), 0.0);
        let wanted = if out.wants_surrogate { n * n } else { 0 };
        let tangent = Tangent {
            rows: &zeros[..3 * n],
            change: &zeros[..3 * n],
            area: 1.0,
            hessian: &block.hessian,
            surrogate: &zeros[..wanted],
        };
        out.add_tangent(&block.dofs, tangent);
    }
}

/// By chunks of points.
fn curvature_of_points(
    interface: InterfaceInput,
    facets: &[Facet],
    cache: &Cache,
) -> Vec<Vec<Block>> {
    let evaluations = &cache.last;
    let points: Vec<usize> = (0..evaluations.points.len()).collect();
    let block = |&i: &usize| {
        let hessian = curvature_of_point(interface, i, facets, cache)?;
        let dofs = evaluations.batch(i).dofs(&evaluations.points[i]).to_vec();
        Some(Block { dofs, hessian })
    };
    let chunks = points.par_chunks(ITEMS_PER_TASK);
    chunks
        .map(|points| points.iter().filter_map(block).collect())
        .collect()
}

/// By chunks of faces: of the contact element of each piece at its middle, weighted by what the piece carries.
fn curvature_of_faces(
    interface: InterfaceInput,
    mortar: &Mortar,
    facets: &[Facet],
    cache: &Cache,
) -> Vec<Vec<Block>> {
    let curvature = Curvature {
        dim: interface.dofs.dim,
        dofs: interface.dofs,
        nodes: &interface.nodes,
        x: &cache.geometry.x,
        facets,
    };
    let faces = mortar.faces.par_chunks(ITEMS_PER_TASK);
    faces
        .zip(cache.geometry.integrals.par_chunks(ITEMS_PER_TASK))
        .map(|(faces, integrals)| {
            let mut room = Vec::new();
            let block = |(face, integral): (&Face, &FaceIntegral)| {
                let points = face.points.iter();
                let own: Vec<_> = points
                    .map(|&p| carried(interface, &cache.last, p))
                    .collect();
                curvature.block(face, integral, &own, &mut room)
            };
            faces.iter().zip(integrals).filter_map(block).collect()
        })
        .collect()
}

//! Some cells of a body, with all that another process needs to make their stiffness: the ranks of an engine assemble what they are dealt.
//!
//! It travels as bytes. In front of them stands what they mean, so that a program of another version refuses them. Numbers of points are those within the portion.

use std::sync::Arc;

use super::elastic::{acting_stiffness, to_nodes};
use super::{Elastic, Formulation, Part, Space};
use crate::keep::{Broken, Keep, Kept, layout};
use crate::linear::{BlockCsr, Digest};
use crate::material::Stiffness;
use crate::mesh::{Block, Mesh};

/// Cells of a body that are to be computed elsewhere.
#[derive(Debug, crate::keep::Keep)]
pub struct Portion {
    mesh: Mesh,
    /// Which space, and its thickness.
    space: (u8, f64),
    formulation: Formulation,
    /// What each block is made of: all of it, or each cell.
    materials: Vec<(Stiffness, Option<Vec<Stiffness>>)>,
}

/// What bytes mean to this program.
fn meaning() -> [u64; 2] {
    let mut digest = Digest::default();
    digest.bytes(env!("CARGO_PKG_VERSION").as_bytes());
    digest.bytes(layout::<Portion>().as_bytes());
    digest.finish()
}

/// Some of its cells, whose numbers are their places among all that [`couplings`](Elastic::couplings) hands out, ascending; and the points of the body that are theirs,
/// ascending.
pub fn portion(body: &Elastic, cells: &[u32]) -> (Vec<usize>, Portion) {
    let mut left = cells;
    let (mut first, mut blocks, mut materials) = (0, Vec::new(), Vec::new());
    for part in &body.parts {
        let block = &body.mesh.blocks[part.block];
        let nodes = block.kind.node_count();
        let behind = first + block.connectivity.len() / nodes;
        let (own, rest) = left.split_at(left.partition_point(|&c| (c as usize) < behind));
        let own = || own.iter().map(|&cell| cell as usize - first);
        blocks.push(Block {
            kind: block.kind,
            connectivity: own()
                .flat_map(|c| &block.connectivity[c * nodes..(c + 1) * nodes])
                .copied()
                .collect(),
            cell_ids: Vec::new(),
        });
        let graded = part.cells.as_ref();
        let graded = graded.map(|cells| own().map(|c| cells[c]).collect());
        materials.push((part.stiffness, graded));
        (left, first) = (rest, behind);
    }
    let mut points: Vec<usize> = blocks
        .iter()
        .flat_map(|b| &b.connectivity)
        .copied()
        .collect();
    points.sort_unstable();
    points.dedup();
    for point in blocks.iter_mut().flat_map(|b| &mut b.connectivity) {
        *point = points.partition_point(|p| p < point);
    }
    let mesh = Mesh {
        dim: body.mesh.dim,
        points: points.iter().map(|&p| body.mesh.points[p]).collect(),
        blocks,
        ..Mesh::default()
    };
    let space = match body.space {
        Space::PlaneStrain { thickness } => (0, thickness),
        Space::PlaneStress { thickness } => (1, thickness),
        Space::Axisymmetric => (2, 1.0),
        Space::Solid => (3, 1.0),
    };
    let portion = Portion {
        mesh,
        space,
        formulation: body.formulation,
        materials,
    };
    (points, portion)
}

impl Portion {
    /// All of it as bytes.
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut out = Vec::new();
        meaning().keep(&mut out);
        self.keep(&mut out);
        out
    }

    /// What was written by [`to_bytes`](Portion::to_bytes).
    ///
    /// # Errors
    /// [`Broken`] if the bytes are of another version, or of something else.
    pub fn from_bytes(bytes: &[u8]) -> Result<Portion, Broken> {
        let mut from = Kept::new(bytes);
        let theirs: [u64; 2] = Keep::back(&mut from)?;
        if theirs != meaning() {
            return Err(Broken);
        }
        let portion = Portion::back(&mut from)?;
        let Mesh {
            dim,
            points,
            blocks,
            ..
        } = &portion.mesh;
        let sound = |(block, (_, graded)): (&Block, &(Stiffness, Option<Vec<Stiffness>>))| {
            let nodes = block.kind.node_count();
            block.kind.dim() == *dim
                && block.connectivity.len().is_multiple_of(nodes)
                && block.connectivity.iter().all(|&p| p < points.len())
                && (graded.as_ref()).is_none_or(|g| g.len() == block.connectivity.len() / nodes)
        };
        let all = blocks.len() == portion.materials.len()
            && portion.space().is_some_and(|space| space.dim() == *dim)
            && blocks.iter().zip(&portion.materials).all(sound);
        all.then_some(portion).ok_or(Broken)
    }

    fn space(&self) -> Option<Space> {
        let (space, thickness) = self.space;
        Some(match space {
            0 => Space::PlaneStrain { thickness },
            1 => Space::PlaneStress { thickness },
            2 => Space::Axisymmetric,
            3 => Space::Solid,
            _ => return None,
        })
    }

    /// The sum of the stiffness of its cells `[N/m]`, over its points. The cells were checked with the body that they are of.
    pub fn stiffness(self) -> BlockCsr {
        let space = self.space().unwrap_or(Space::Solid);
        let of_block = |(block, (stiffness, graded)): (usize, (Stiffness, Option<Vec<_>>))| Part {
            block,
            stiffness,
            cells: graded.map(Arc::new),
            ..Part::default()
        };
        let parts: Vec<Part> = self
            .materials
            .into_iter()
            .enumerate()
            .map(of_block)
            .collect();
        let body = Elastic {
            name: String::new(),
            space,
            formulation: self.formulation,
            acting: acting_stiffness(space, &parts),
            to_nodes: to_nodes(&self.mesh, &parts, space, self.formulation),
            parts,
            points: Vec::new(),
            mesh: Arc::new(self.mesh),
            temperatures: None,
            corotational: false,
        };
        let Mesh { dim, points, .. } = &**body.mesh();
        let couplings = &mut |visit: &mut dyn FnMut(&[usize])| body.couplings(visit);
        let mut stiffness = BlockCsr::from_couplings(points.len(), *dim, couplings);
        body.stiffness(&mut stiffness);
        stiffness
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{anisotropic, combinations, distort, grid, isotropic, matrix};
    use super::*;
    use crate::linear::Matrix;

    /// A block of one material and another whose cells differ, side by side with the same points.
    fn two_blocks(kind: crate::shape::ElementKind, space: Space, way: Formulation) -> Elastic {
        let mut mesh = grid(kind, [3, 3, 2], &distort);
        let nodes = kind.node_count();
        let mut other = mesh.blocks[0].clone();
        let half = mesh.blocks[0].cell_ids.len() / 2;
        other.connectivity = mesh.blocks[0].connectivity.split_off(half * nodes);
        other.cell_ids = mesh.blocks[0].cell_ids.split_off(half);
        let soft = |cell: usize| isotropic(1.0 / (1.0 + (cell % 4) as f64), 0.3);
        let graded = Part {
            block: 1,
            stiffness: soft(0),
            cells: Some(Arc::new((0..other.cell_ids.len()).map(soft).collect())),
            ..Part::default()
        };
        let plain = Part {
            stiffness: anisotropic(),
            ..Part::default()
        };
        mesh.blocks.push(other);
        Elastic::new("two", Arc::new(mesh), space, way, vec![graded, plain]).expect("sound")
    }

    #[test]
    fn portions_add_up_to_the_body_in_every_space_and_formulation() {
        for (kind, space, way) in combinations() {
            let body = two_blocks(kind, space, way);
            let whole = matrix(&body);
            let mut count = 0;
            body.couplings(&mut |_| count += 1);
            let mut sum = whole.zeros_like();
            for rank in 0..3 {
                let cells: Vec<u32> = (0..count).filter(|c| 7 * c % 5 % 3 == rank).collect();
                assert!(!cells.is_empty());
                let (points, portion) = portion(&body, &cells);
                let back = Portion::from_bytes(&portion.to_bytes()).expect("sound bytes");
                let own = back.stiffness();
                let b = own.block_size();
                own.summands(0..own.points(), &mut |i, j, value| {
                    let at = [points[i / b], points[j / b]];
                    let mut dense = vec![0.0; 4 * b * b];
                    let two = at[0] != at[1];
                    let width = if two { 2 * b } else { b };
                    dense[i % b * width + if two { b } else { 0 } + j % b] = value;
                    let group = if two { &at[..] } else { &at[..1] };
                    sum.add_group(group, &dense[..width * width]);
                });
            }
            let size = whole.diagonal().iter().fold(0.0_f64, |m, x| m.max(x.abs()));
            for i in 0..whole.rows() {
                let b = whole.block_size();
                let beside = whole.neighbours(i / b).iter();
                for j in beside.flat_map(|&p| p as usize * b..(p as usize + 1) * b) {
                    let off = sum.entry(i, j) - whole.entry(i, j);
                    assert!(
                        off.abs() < 1e-14 * size,
                        "{kind:?} {space:?} {way:?}: {off}"
                    );
                }
            }
        }
    }

    #[test]
    fn bytes_that_are_cut_or_of_another_version_are_refused() {
        let (kind, space, way) = combinations()[0];
        let (_, portion) = portion(&two_blocks(kind, space, way), &[1, 2, 5]);
        let bytes = portion.to_bytes();
        assert!(Portion::from_bytes(&bytes).is_ok());
        assert!(Portion::from_bytes(&bytes[..bytes.len() - 1]).is_err());
        let mut other = bytes.clone();
        other[8] ^= 1;
        assert!(Portion::from_bytes(&other).is_err());
    }
}

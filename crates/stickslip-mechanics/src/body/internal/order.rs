//! An order of cells in which neighbours in the list are neighbours in space.

use crate::math::{Vec3, add, scale, sub};
use crate::mesh::Block;

/// Bits of a coordinate in the key.
const BITS: u32 = 20;

/// The given cells of a block along a Z-shaped curve through their centres, so that a chunk of them shares its points
/// with few others, whatever the order of the mesh is.
pub fn along_curve(points: &[Vec3], block: &Block, cells: &mut [u32]) {
    let n = block.kind.node_count();
    let centre = |cell: u32| {
        let nodes = &block.connectivity[cell as usize * n..][..n];
        let sum = nodes.iter().fold([0.0; 3], |s, &p| add(s, points[p]));
        scale(1.0 / n as f64, sum)
    };
    let mut low = [f64::INFINITY; 3];
    let mut high = [f64::NEG_INFINITY; 3];
    for &cell in &*cells {
        let x = centre(cell);
        for i in 0..3 {
            low[i] = low[i].min(x[i]);
            high[i] = high[i].max(x[i]);
        }
    }
    // One scale for all directions: cubes, not slabs.
    let extent = sub(high, low).into_iter().fold(0.0, f64::max);
    let per_length = if extent > 0.0 {
        f64::from((1_u32 << BITS) - 1) / extent
    } else {
        0.0
    };
    cells.sort_by_cached_key(|&cell| {
        let x = sub(centre(cell), low);
        (key(x.map(|x| (x * per_length) as u64)), cell)
    });
}

/// The bits of three numbers in turn, the highest first.
fn key(x: [u64; 3]) -> u64 {
    let mut key = 0;
    for bit in (0..BITS).rev() {
        for coordinate in x {
            key = key << 1 | (coordinate >> bit & 1);
        }
    }
    key
}

#[cfg(test)]
mod tests {
    use super::super::super::testing::grid;
    use super::*;
    use crate::shape::ElementKind;

    #[test]
    fn a_grid_is_taken_cube_by_cube() {
        let mesh = grid(ElementKind::Hex8, [4, 4, 4], &|x| x);
        let block = &mesh.blocks[0];
        let mut cells: Vec<u32> = (0..64).rev().collect();
        along_curve(&mesh.points, block, &mut cells);
        for cube in cells.chunks(8) {
            let mut points: Vec<usize> = cube
                .iter()
                .flat_map(|&c| &block.connectivity[c as usize * 8..][..8])
                .copied()
                .collect();
            points.sort_unstable();
            points.dedup();
            assert_eq!(points.len(), 27);
        }
        cells.sort_unstable();
        assert!(cells.into_iter().eq(0..64));
    }

    #[test]
    fn the_key_takes_one_bit_of_each_in_turn() {
        assert_eq!(key([1, 0, 0]), 4);
        assert_eq!(key([0, 3, 2]), 0b011_010);
        assert_eq!(key([(1 << BITS) - 1; 3]), (1 << (3 * BITS)) - 1);
    }
}

//! Numbers for files that want every point and every cell to have one of its own.

use crate::mesh::Mesh;

/// The numbers that points and cells get in a file.
pub(super) struct Numbers {
    /// Of the points.
    pub points: Vec<u64>,
    /// Of the cells, blocks in order.
    pub cells: Vec<u64>,
    /// What was changed, a sentence each: empty if the numbers are those of the mesh.
    pub notes: Vec<String>,
}

impl Numbers {
    /// Those of the mesh, or 1, 2, … where one is zero or there twice (as in the joined meshes of several bodies).
    pub fn of(mesh: &Mesh) -> Numbers {
        let mut notes = Vec::new();
        let ids = mesh.blocks.iter().flat_map(|block| &block.cell_ids);
        Numbers {
            points: usable("point", mesh.point_ids.clone(), &mut notes),
            cells: usable("cell", ids.copied().collect(), &mut notes),
            notes,
        }
    }

    /// The first number behind those of the cells.
    pub fn next_cell(&self) -> u64 {
        self.cells.iter().max().map_or(1, |last| last + 1)
    }
}

/// Numbers beyond this are not signed 32-bit integers, which other programs use.
const LARGEST: u64 = i32::MAX as u64;

fn usable(what: &str, mut ids: Vec<u64>, notes: &mut Vec<String>) -> Vec<u64> {
    let mut sorted = ids.clone();
    sorted.sort_unstable();
    let fault = match sorted.windows(2).find(|pair| pair[0] == pair[1]) {
        Some(pair) => Some(format!("several {what}s have the number {}", pair[0])),
        None if sorted.first() == Some(&0) => Some(format!("a {what} has the number 0")),
        None => sorted
            .last()
            .filter(|&&last| last > LARGEST - ids.len() as u64)
            .map(|last| format!("a {what} has the number {last}, beyond 32 bits")),
    };
    if let Some(fault) = fault {
        notes.push(format!("{fault}: {what}s are numbered anew from 1"));
        ids = (1..=ids.len() as u64).collect();
    }
    ids
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_kept_where_they_are_unique() {
        let mut notes = Vec::new();
        assert_eq!(usable("cell", vec![7, 3], &mut notes), [7, 3]);
        assert!(notes.is_empty());
        assert_eq!(usable("cell", vec![7, 7], &mut notes), [1, 2]);
        assert_eq!(usable("point", vec![0, 4], &mut notes), [1, 2]);
        assert_eq!(usable("point", vec![1, 1 << 40], &mut notes), [1, 2]);
        assert_eq!(notes.len(), 3);
        assert!(notes[0].contains("several cells have the number 7"));
    }
}

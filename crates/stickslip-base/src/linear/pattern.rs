//! Which points are coupled: the sorted sparsity pattern shared by the matrices on one mesh.

use rayon::prelude::*;

/// A visitor of groups of coupled points: it is called with a sink and hands it every group.
pub type Couplings<'a> = dyn FnMut(&mut dyn FnMut(&[usize])) + 'a;

/// Rows handled by one task; fixed, so that results never depend on the number of threads.
const PATTERN_ROWS_PER_TASK: usize = 4096;

/// The coupling graph of points with sorted rows; every point is coupled to itself.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Pattern {
    /// Where the columns of a row start; length `points + 1`.
    pub starts: Vec<usize>,
    /// Coupled points, row by row, ascending.
    pub columns: Vec<u32>,
}

/// Groups of points, flat.
struct Groups {
    starts: Vec<usize>,
    members: Vec<u32>,
}

impl Pattern {
    /// The pattern in which every group of points is a clique.
    pub fn from_cliques(points: usize, visit: &mut Couplings) -> Pattern {
        assert!(points < u32::MAX as usize, "more than 2^32 - 2 points");
        let mut groups = Groups {
            starts: vec![0],
            members: Vec::new(),
        };
        visit(&mut |group| {
            for &point in group {
                assert!(point < points, "point {point} of {points} in a coupling");
                groups.members.push(point as u32);
            }
            groups.starts.push(groups.members.len());
        });
        let (of_point_starts, of_point) = invert(points, &groups);

        let tasks: Vec<usize> = (0..points).step_by(PATTERN_ROWS_PER_TASK).collect();
        // Each task returns the lengths of its rows and their columns.
        let rows: Vec<(Vec<usize>, Vec<u32>)> = tasks
            .into_par_iter()
            .map_init(
                || vec![u32::MAX; points],
                |seen, first| {
                    let mut lengths = Vec::with_capacity(PATTERN_ROWS_PER_TASK);
                    let mut columns = Vec::new();
                    for row in first..(first + PATTERN_ROWS_PER_TASK).min(points) {
                        let start = columns.len();
                        seen[row] = row as u32;
                        columns.push(row as u32);
                        for &group in &of_point[of_point_starts[row]..of_point_starts[row + 1]] {
                            let group = group as usize;
                            let range = groups.starts[group]..groups.starts[group + 1];
                            for &other in &groups.members[range] {
                                if seen[other as usize] != row as u32 {
                                    seen[other as usize] = row as u32;
                                    columns.push(other);
                                }
                            }
                        }
                        columns[start..].sort_unstable();
                        lengths.push(columns.len() - start);
                    }
                    (lengths, columns)
                },
            )
            .collect();

        let mut starts = Vec::with_capacity(points + 1);
        starts.push(0);
        let mut columns = Vec::with_capacity(rows.iter().map(|(_, c)| c.len()).sum());
        let mut end = 0;
        for (lengths, part) in rows {
            for length in lengths {
                end += length;
                starts.push(end);
            }
            columns.extend_from_slice(&part);
        }
        Pattern { starts, columns }
    }

    /// Number of points.
    pub fn points(&self) -> usize {
        self.starts.len() - 1
    }

    /// The points coupled to `row`, ascending.
    #[inline]
    pub fn row(&self, row: usize) -> &[u32] {
        &self.columns[self.starts[row]..self.starts[row + 1]]
    }
}

/// The groups of each point, by counting.
fn invert(points: usize, groups: &Groups) -> (Vec<usize>, Vec<u32>) {
    let mut starts = vec![0; points + 1];
    for &point in &groups.members {
        starts[point as usize + 1] += 1;
    }
    for i in 0..points {
        starts[i + 1] += starts[i];
    }
    let mut next = starts.clone();
    let mut of_point = vec![0; groups.members.len()];
    for (group, ends) in groups.starts.windows(2).enumerate() {
        for &point in &groups.members[ends[0]..ends[1]] {
            of_point[next[point as usize]] = group as u32;
            next[point as usize] += 1;
        }
    }
    (starts, of_point)
}

#[cfg(test)]
mod tests {
    use super::Pattern;

    #[test]
    fn cliques_become_sorted_rows() {
        let groups: [&[usize]; 3] = [&[4, 1], &[1, 2, 0], &[1, 4]];
        let pattern = Pattern::from_cliques(6, &mut |add| groups.iter().for_each(|g| add(g)));
        assert_eq!(pattern.points(), 6);
        let rows: Vec<&[u32]> = (0..6).map(|i| pattern.row(i)).collect();
        let expected: [&[u32]; 6] = [&[0, 1, 2], &[0, 1, 2, 4], &[0, 1, 2], &[3], &[1, 4], &[5]];
        assert_eq!(rows, expected);
    }
}

//! Graphs of points: what is coupled, and what elimination couples.

use std::ops::Range;

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::SymbolicSparseColMatRef;
use faer::sparse::linalg::cholesky::simplicial;

use super::super::ordering::{Graph, NONE};
use super::super::{BlockCsr, LinearError};

/// Refuses couplings of a free dof of the points to a free dof elsewhere.
pub(super) fn check_closed(
    matrix: &BlockCsr,
    points: &Range<usize>,
    fixed: &[bool],
) -> Result<(), LinearError> {
    let b = matrix.block_size();
    let free = |point: usize| (point * b..(point + 1) * b).find(|&dof| !fixed[dof]);
    for point in points.clone() {
        let Some(dof) = free(point) else { continue };
        let outside = (matrix.neighbours(point).iter())
            .map(|&other| other as usize)
            .filter(|other| !points.contains(other))
            .find_map(free);
        if let Some(other) = outside {
            return Err(LinearError::NotAnalysed { dofs: [dof, other] });
        }
    }
    Ok(())
}

/// The couplings of the points of `nodes`, by nodes, as far as `wanted` says of the other and the own node.
pub(super) fn couplings(
    matrix: &BlockCsr,
    nodes: &[u32],
    wanted: impl Fn(u32, u32) -> bool,
    node_of: impl Fn(u32) -> u32,
) -> Graph {
    let mut graph = Graph {
        starts: vec![0],
        neighbours: Vec::new(),
    };
    for (own, &point) in nodes.iter().enumerate() {
        let others = matrix.neighbours(point as usize).iter();
        graph.neighbours.extend(
            others
                .map(|&other| node_of(other))
                .filter(|&other| wanted(other, own as u32)),
        );
        graph.starts.push(graph.neighbours.len());
    }
    graph
}

/// Entries in every column of the factor of the graph of points, by step of elimination.
pub(super) fn column_counts(
    matrix: &BlockCsr,
    inner: &[u32],
    outer: &[u32],
    order: &[u32],
    step_of: &[u32],
    node_of: impl Fn(u32) -> u32,
) -> Result<Vec<usize>, LinearError> {
    let n = step_of.len();
    // The upper triangle, column by column; couplings among the kept points do not matter here.
    let mut starts = vec![0];
    let mut rows = Vec::new();
    for step in 0..n {
        let point = match order.get(step) {
            Some(&node) => inner[node as usize],
            None => outer[step - inner.len()],
        };
        let others = matrix.neighbours(point as usize).iter();
        rows.extend(
            others
                .map(|&other| node_of(other))
                .filter(|&node| node != NONE)
                .map(|node| step_of[node as usize] as usize)
                .filter(|&other| other < step && other < inner.len()),
        );
        rows.push(step);
        starts.push(rows.len());
    }
    let upper = SymbolicSparseColMatRef::new_unsorted_checked(n, n, &starts, None, &rows);
    let scratch = simplicial::prefactorize_symbolic_cholesky_scratch::<usize>(n, rows.len());
    let mut memory =
        MemBuffer::try_new(scratch).map_err(|_| LinearError::OutOfMemory { bytes: 0 })?;
    let mut parents = vec![0isize; n];
    let mut counts = vec![0usize; n];
    let stack = MemStack::new(&mut memory);
    simplicial::prefactorize_symbolic_cholesky(&mut parents, &mut counts, upper, stack);
    Ok(counts)
}

/// The places of points coupled to each group behind its own ones, ascending: its couplings and those of its children.
pub(super) fn rows_of_groups<I: Iterator<Item = u32>>(
    groups: &[Vec<u32>],
    parents: &[u32],
    coupled: impl Fn(u32) -> I,
    places: usize,
) -> Vec<Vec<u32>> {
    let mut rows: Vec<Vec<u32>> = vec![Vec::new(); groups.len()];
    let mut seen_by = vec![NONE; places];
    let mut end = 0;
    for (at, group) in groups.iter().enumerate() {
        let start = end;
        end += group.len() as u32;
        let mut own = std::mem::take(&mut rows[at]);
        own.retain(|&place| {
            place >= end && std::mem::replace(&mut seen_by[place as usize], at as u32) != at as u32
        });
        for place in start..end {
            for other in coupled(place) {
                if other >= end
                    && std::mem::replace(&mut seen_by[other as usize], at as u32) != at as u32
                {
                    own.push(other);
                }
            }
        }
        own.sort_unstable();
        if let Some(above) = rows.get_mut(parents[at] as usize) {
            above.extend_from_slice(&own);
        }
        rows[at] = own;
    }
    rows
}

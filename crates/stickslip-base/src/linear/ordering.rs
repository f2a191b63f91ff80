//! In which order to eliminate the nodes of a graph: nested dissection, or minimum degree for small graphs.

use std::sync::{Mutex, PoisonError};

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::SymbolicSparseColMatRef;
use faer::sparse::linalg::amd;

/// Below this number of nodes dissection has nothing to gain.
const SMALL_DISSECTION: usize = 50;

/// An undirected graph; a node is not its own neighbour.
#[derive(Debug, Clone, Default)]
pub(super) struct Graph {
    /// Where the neighbours of a node start; length `nodes + 1`.
    pub starts: Vec<usize>,
    /// Neighbours, node by node.
    pub neighbours: Vec<u32>,
}

impl Graph {
    /// Number of nodes.
    pub fn nodes(&self) -> usize {
        self.starts.len() - 1
    }

    /// The neighbours of a node.
    pub fn of(&self, node: usize) -> &[u32] {
        &self.neighbours[self.starts[node]..self.starts[node + 1]]
    }
}

/// The nodes in an order of elimination that keeps the factor sparse, postordered: every subtree of the elimination
/// tree is contiguous, which supernodes are made of.
pub(super) fn elimination_order(graph: &Graph) -> Vec<u32> {
    let order = if graph.nodes() < SMALL_DISSECTION || graph.neighbours.is_empty() {
        minimum_degree(graph)
    } else {
        nested_dissection(graph).unwrap_or_else(|| minimum_degree(graph))
    };
    let parents = elimination_tree(graph, &order);
    postorder(&parents)
        .into_iter()
        .map(|at| order[at as usize])
        .collect()
}

/// METIS keeps its random numbers and its error traps in globals: one call at a time, for safety and reproducibility.
pub(super) static METIS: Mutex<()> = Mutex::new(());

/// Nested dissection by METIS; `None` if it fails or the graph is too large for its 32-bit indices.
fn nested_dissection(graph: &Graph) -> Option<Vec<u32>> {
    let mut nodes = i32::try_from(graph.nodes()).ok()?;
    i32::try_from(graph.neighbours.len()).ok()?;
    let mut starts: Vec<i32> = graph.starts.iter().map(|&s| s as i32).collect();
    let mut neighbours: Vec<i32> = graph.neighbours.iter().map(|&n| n as i32).collect();
    let mut order = vec![0i32; graph.nodes()];
    let mut position = vec![0i32; graph.nodes()];
    let status = {
        let _one_at_a_time = METIS.lock().unwrap_or_else(PoisonError::into_inner);
        // SAFETY: `starts` has `nodes + 1` entries that index `neighbours`, whose entries are nodes; the two outputs
        // have `nodes` entries; null weights and options mean the defaults. METIS keeps no pointer.
        unsafe {
            metis_sys::METIS_NodeND(
                &mut nodes,
                starts.as_mut_ptr(),
                neighbours.as_mut_ptr(),
                std::ptr::null_mut(),
                std::ptr::null_mut(),
                order.as_mut_ptr(),
                position.as_mut_ptr(),
            )
        }
    };
    if status != metis_sys::rstatus_et_METIS_OK {
        return None;
    }
    is_permutation(&order).then(|| order.into_iter().map(|n| n as u32).collect())
}

/// What comes back from C is checked before it is used as indices.
fn is_permutation(order: &[i32]) -> bool {
    let mut seen = vec![false; order.len()];
    for &node in order {
        let place = usize::try_from(node).ok();
        match place.and_then(|node| seen.get_mut(node)) {
            Some(seen) if !*seen => *seen = true,
            _ => return false,
        }
    }
    true
}

/// Approximate minimum degree; the given order if it runs out of memory.
fn minimum_degree(graph: &Graph) -> Vec<u32> {
    let n = graph.nodes();
    let rows: Vec<usize> = graph.neighbours.iter().map(|&r| r as usize).collect();
    let mut order = vec![0usize; n];
    let mut position = vec![0usize; n];
    let done = MemBuffer::try_new(amd::order_maybe_unsorted_scratch::<usize>(n, rows.len()))
        .ok()
        .and_then(|mut memory| {
            amd::order_maybe_unsorted(
                &mut order,
                &mut position,
                SymbolicSparseColMatRef::new_unsorted_checked(n, n, &graph.starts, None, &rows),
                amd::Control::default(),
                MemStack::new(&mut memory),
            )
            .ok()
        });
    match done {
        Some(_) => order.into_iter().map(|node| node as u32).collect(),
        None => (0..n as u32).collect(),
    }
}

/// No parent, or not numbered.
pub(super) const NONE: u32 = u32::MAX;

/// The parent of each step of the elimination, by step (Liu's algorithm with path compression).
pub(super) fn elimination_tree(graph: &Graph, order: &[u32]) -> Vec<u32> {
    let n = order.len();
    let mut step_of = vec![NONE; n];
    for (step, &node) in order.iter().enumerate() {
        step_of[node as usize] = step as u32;
    }
    let mut parents = vec![NONE; n];
    // A shortcut towards the root of the part of the tree built so far.
    let mut ancestors = vec![NONE; n];
    for (step, &node) in order.iter().enumerate() {
        let step = step as u32;
        for &neighbour in graph.of(node as usize) {
            let mut at = step_of[neighbour as usize];
            if at >= step {
                continue;
            }
            loop {
                let next = ancestors[at as usize];
                ancestors[at as usize] = step;
                if next == step {
                    break;
                }
                if next == NONE {
                    parents[at as usize] = step;
                    break;
                }
                at = next;
            }
        }
    }
    parents
}

/// The steps so that children come right before their parents, subtree by subtree.
fn postorder(parents: &[u32]) -> Vec<u32> {
    let n = parents.len();
    let mut first_child = vec![NONE; n];
    let mut next_sibling = vec![NONE; n];
    for step in (0..n).rev() {
        if let Some(first) = first_child.get_mut(parents[step] as usize) {
            next_sibling[step] = *first;
            *first = step as u32;
        }
    }
    let mut order = Vec::with_capacity(n);
    let mut stack = Vec::new();
    for root in (0..n).filter(|&step| parents[step] == NONE) {
        stack.push(root as u32);
        while let Some(&top) = stack.last() {
            let child = first_child[top as usize];
            if child == NONE {
                order.push(top);
                stack.pop();
            } else {
                first_child[top as usize] = next_sibling[child as usize];
                stack.push(child);
            }
        }
    }
    order
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A grid of `w × h` nodes with four neighbours each.
    fn grid(w: usize, h: usize) -> Graph {
        let mut graph = Graph::default();
        graph.starts.push(0);
        for y in 0..h {
            for x in 0..w {
                let mut add = |x: usize, y: usize| graph.neighbours.push((y * w + x) as u32);
                if y > 0 {
                    add(x, y - 1);
                }
                if x > 0 {
                    add(x - 1, y);
                }
                if x + 1 < w {
                    add(x + 1, y);
                }
                if y + 1 < h {
                    add(x, y + 1);
                }
                graph.starts.push(graph.neighbours.len());
            }
        }
        graph
    }

    fn sorted(order: &[u32]) -> Vec<u32> {
        let mut sorted = order.to_vec();
        sorted.sort_unstable();
        sorted
    }

    /// Entries of the factor, by elimination on sets.
    fn fill(graph: &Graph, order: &[u32]) -> usize {
        use std::collections::BTreeSet;
        let mut step_of = vec![0; order.len()];
        for (step, &node) in order.iter().enumerate() {
            step_of[node as usize] = step;
        }
        let mut later: Vec<BTreeSet<usize>> = order
            .iter()
            .enumerate()
            .map(|(step, &node)| {
                let steps = graph.of(node as usize).iter();
                steps
                    .map(|&n| step_of[n as usize])
                    .filter(|&s| s > step)
                    .collect()
            })
            .collect();
        for step in 0..order.len() {
            let column = later[step].clone();
            if let Some(&parent) = column.first() {
                later[parent].extend(column.into_iter().skip(1));
            }
        }
        later.iter().map(BTreeSet::len).sum()
    }

    #[test]
    fn dissection_orders_every_node_once_and_saves_fill() {
        let graph = grid(30, 30);
        let order = elimination_order(&graph);
        let natural: Vec<u32> = (0..900).collect();
        assert_eq!(sorted(&order), natural);
        assert!(fill(&graph, &order) * 2 < fill(&graph, &natural));
        assert!(nested_dissection(&graph).is_some());
        assert_eq!(order, elimination_order(&graph));
    }

    #[test]
    fn small_and_edgeless_graphs_are_ordered_too() {
        for (w, h) in [(5, 4), (1, 1)] {
            let graph = grid(w, h);
            let n = (w * h) as u32;
            assert_eq!(
                sorted(&elimination_order(&graph)),
                (0..n).collect::<Vec<_>>()
            );
        }
        let lonely = Graph {
            starts: vec![0; 101],
            neighbours: Vec::new(),
        };
        assert_eq!(sorted(&elimination_order(&lonely)).len(), 100);
        let empty = Graph {
            starts: vec![0],
            neighbours: Vec::new(),
        };
        assert!(elimination_order(&empty).is_empty());
    }

    #[test]
    fn tree_of_a_path_and_postorder_of_two_trees() {
        let path = grid(5, 1);
        // Ends first, then the middle: 0 1 | 4 3 | 2.
        assert_eq!(
            elimination_tree(&path, &[0, 1, 4, 3, 2]),
            [1, 4, 3, 4, NONE]
        );
        // Two interleaved trees: 0 -> 2 -> 4 and 1 -> 3 -> 5.
        assert_eq!(postorder(&[2, 3, 4, 5, NONE, NONE]), [0, 2, 4, 1, 3, 5]);
    }

    #[test]
    fn refuses_what_is_no_permutation() {
        assert!(is_permutation(&[2, 0, 1]));
        assert!(!is_permutation(&[2, 0, 2]));
        assert!(!is_permutation(&[3, 0, 1]));
        assert!(!is_permutation(&[-1, 0, 1]));
    }
}

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::SymbolicSparseColMatRef;
use faer::sparse::linalg::SymbolicSupernodalParams;
use faer::sparse::linalg::cholesky::{simplicial, supernodal};

use super::ordering::{Graph, elimination_order};
use super::{BlockCsr, LinearError};

/// Marks a dof that is left out.
pub(super) const FIXED: u32 = u32::MAX;

/// Where the entries of a Cholesky factor are, for one pattern and one set of fixed dofs.
///
/// The points are ordered by nested dissection of their coupling graph
/// ([Karypis and Kumar 1998](crate::references::karypis_kumar_1998)), which in 3D leaves a third of the work of a
/// minimum-degree ordering of the dofs. The free dofs of a point follow each other.
#[derive(Debug)]
pub struct Symbolic {
    /// The dof eliminated at each step.
    pub(super) order: Vec<u32>,
    /// The step of each dof, or [`FIXED`].
    pub(super) step_of: Vec<u32>,
    /// The supernode of each step.
    supernode_of: Vec<u32>,
    pub(super) supernodes: supernodal::SymbolicSupernodalCholesky<usize>,
    /// Points and block size of the matrix analysed.
    pub(super) shape: (usize, usize),
    nonzeros: usize,
    flops: f64,
}

impl Symbolic {
    /// Analyses `matrix` without the dofs marked in `fixed`, together with groups of dofs that are `extra` coupled,
    /// such as the candidates of a contact.
    ///
    /// # Errors
    /// [`LinearError::OutOfMemory`].
    ///
    /// # Panics
    /// If `fixed` has not one entry a dof or a group names a dof that does not exist.
    pub fn analyze(
        matrix: &BlockCsr,
        fixed: &[bool],
        extra: &[Vec<usize>],
    ) -> Result<Symbolic, LinearError> {
        assert_eq!(fixed.len(), matrix.rows(), "length of `fixed`");
        let b = matrix.block_size();
        let free = |point: usize| (point * b..(point + 1) * b).filter(|&dof| !fixed[dof]);

        let active: Vec<u32> = (0..matrix.points())
            .filter(|&point| free(point).next().is_some())
            .map(|point| point as u32)
            .collect();
        let graph = coupling_graph(matrix, &active, extra);

        // The steps of a node's free dofs are `first_step[node]..` in the order of elimination of the nodes.
        let node_order = elimination_order(&graph);
        let mut order = Vec::new();
        let mut step_of = vec![FIXED; matrix.rows()];
        let mut steps_of_node = vec![0..0; graph.nodes()];
        for &node in &node_order {
            let first = order.len();
            for dof in free(active[node as usize] as usize) {
                step_of[dof] = order.len() as u32;
                order.push(dof as u32);
            }
            steps_of_node[node as usize] = first..order.len();
        }

        let n = order.len();
        // The upper triangle, column by column.
        let mut starts = Vec::with_capacity(n + 1);
        starts.push(0);
        let mut rows = Vec::new();
        for &node in &node_order {
            let own = steps_of_node[node as usize].clone();
            let column = rows.len();
            for &other in graph.of(node as usize) {
                let other = &steps_of_node[other as usize];
                if other.start < own.start {
                    rows.extend(other.clone());
                }
            }
            let above = column..rows.len();
            for step in own.clone() {
                if step > own.start {
                    rows.extend_from_within(above.clone());
                }
                rows.extend(own.start..=step);
                starts.push(rows.len());
            }
        }
        let upper = SymbolicSparseColMatRef::new_unsorted_checked(n, n, &starts, None, &rows);
        let (supernodes, counts) = find_supernodes(upper)?;

        let mut supernode_of = vec![0; n];
        let begins = supernodes.supernode_begin().iter();
        for (s, (&begin, &end)) in begins.zip(supernodes.supernode_end()).enumerate() {
            supernode_of[begin..end].fill(s as u32);
        }
        Ok(Symbolic {
            order,
            step_of,
            supernode_of,
            supernodes,
            shape: (matrix.points(), b),
            nonzeros: counts.iter().sum(),
            flops: counts.iter().map(|&c| (c as f64) * (c as f64)).sum(),
        })
    }

    /// Whether the free ones of these dofs may all be coupled to each other without a new analysis.
    ///
    /// What the factor stores counts, not what the matrix couples: fill can be used by any later block.
    pub fn covers(&self, dofs: &[usize]) -> bool {
        self.first_uncovered(dofs).is_none()
    }

    /// The first two dofs whose coupling was not foreseen.
    pub(super) fn first_uncovered(&self, dofs: &[usize]) -> Option<[usize; 2]> {
        for (i, &a) in dofs.iter().enumerate() {
            for &b in &dofs[i + 1..] {
                let (low, high) = {
                    let (a, b) = (self.step_of[a], self.step_of[b]);
                    (a.min(b), a.max(b))
                };
                if high != FIXED && !self.stores(high as usize, low as usize) {
                    return Some([a, b]);
                }
            }
        }
        None
    }

    /// Whether the factor stores the entry at two steps, `row >= column`.
    fn stores(&self, row: usize, column: usize) -> bool {
        let s = self.supernode_of[column] as usize;
        row < self.supernodes.supernode_end()[s]
            || self
                .supernodes
                .supernode(s)
                .pattern()
                .binary_search(&row)
                .is_ok()
    }

    /// Number of dofs that are not fixed.
    pub fn free(&self) -> usize {
        self.order.len()
    }

    /// Entries of the factor, without the zeros stored to make its blocks larger.
    pub fn factor_nonzeros(&self) -> usize {
        self.nonzeros
    }

    /// Additions and multiplications of one factorisation.
    pub fn flops(&self) -> f64 {
        self.flops
    }
}

/// The couplings among the `active` points (ascending), numbered along that list.
fn coupling_graph(matrix: &BlockCsr, active: &[u32], extra: &[Vec<usize>]) -> Graph {
    let mut node_of = vec![FIXED; matrix.points()];
    for (node, &point) in active.iter().enumerate() {
        node_of[point as usize] = node as u32;
    }
    // Pairs from the extra groups, in both directions.
    let mut pairs: Vec<(u32, u32)> = Vec::new();
    for group in extra {
        let mut nodes: Vec<u32> = group
            .iter()
            .map(|dof| node_of[dof / matrix.block_size()])
            .filter(|&node| node != FIXED)
            .collect();
        nodes.sort_unstable();
        nodes.dedup();
        for &i in &nodes {
            pairs.extend(nodes.iter().filter(|&&j| j != i).map(|&j| (i, j)));
        }
    }
    pairs.sort_unstable();
    pairs.dedup();

    let mut graph = Graph {
        starts: vec![0],
        neighbours: Vec::new(),
    };
    let mut pairs = pairs.into_iter().peekable();
    for (node, &point) in active.iter().enumerate() {
        let start = graph.neighbours.len();
        let coupled = matrix.neighbours(point as usize).iter();
        graph.neighbours.extend(
            coupled
                .map(|&other| node_of[other as usize])
                .filter(|&other| other != FIXED && other != node as u32),
        );
        let own = graph.neighbours.len();
        while let Some((_, other)) = pairs.next_if(|pair| pair.0 == node as u32) {
            // `active` ascends, so the neighbours from the matrix are sorted.
            if graph.neighbours[start..own].binary_search(&other).is_err() {
                graph.neighbours.push(other);
            }
        }
        graph.starts.push(graph.neighbours.len());
    }
    graph
}

/// The supernodes of a postordered pattern and the entries in every column of its factor.
fn find_supernodes(
    upper: SymbolicSparseColMatRef<'_, usize>,
) -> Result<(supernodal::SymbolicSupernodalCholesky<usize>, Vec<usize>), LinearError> {
    let n = upper.nrows();
    let scratch =
        simplicial::prefactorize_symbolic_cholesky_scratch::<usize>(n, upper.row_idx().len())
            .or(supernodal::factorize_supernodal_symbolic_cholesky_scratch::<usize>(n));
    let Ok(mut memory) = MemBuffer::try_new(scratch) else {
        return Err(LinearError::OutOfMemory { bytes: 0 });
    };
    let stack = MemStack::new(&mut memory);
    let mut parents = vec![0isize; n];
    let mut counts = vec![0usize; n];
    let tree = simplicial::prefactorize_symbolic_cholesky(&mut parents, &mut counts, upper, stack);
    let supernodes = supernodal::factorize_supernodal_symbolic_cholesky(
        upper,
        tree,
        &counts,
        stack,
        SymbolicSupernodalParams::default(),
    )
    // Its other error, an index overflow, is a factor larger than any memory.
    .map_err(|_| LinearError::OutOfMemory { bytes: 0 })?;
    Ok((supernodes, counts))
}

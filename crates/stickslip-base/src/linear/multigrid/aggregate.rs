//! Groups of neighbouring nodes that share the unknowns of one coarse node.

use super::blocks::{Block, Rows};

/// A node that takes part in no aggregate.
pub(super) const OUTSIDE: u32 = u32::MAX;

/// The aggregate of every node, and their number. Nodes of different `groups` never meet; those of group [`OUTSIDE`]
/// are left out.
///
/// Two nodes are neighbours if `|a_ij|² > strength² |a_ii| |a_jj|` in the Frobenius norm
/// ([Vaněk et al. 1996](crate::references::vanek_1996), algorithm 5.1).
pub(super) fn aggregate<const B: usize>(
    matrix: &impl Rows<B>,
    groups: &[u32],
    strength: f64,
) -> (Vec<u32>, usize) {
    let count = matrix.count();
    let sizes: Vec<f64> = (0..count).map(|i| norm(&matrix.diagonal(i))).collect();
    // The neighbours of a node and how strong they are, squared and relative.
    let visit = |i: usize, each: &mut dyn FnMut(usize, f64)| {
        let (columns, blocks) = matrix.row(i);
        for (&j, block) in columns.iter().zip(blocks) {
            let j = j as usize;
            if j == i || groups[j] != groups[i] {
                continue;
            }
            let value = norm(block) * norm(block) / (sizes[i] * sizes[j]);
            if value > strength * strength {
                each(j, value);
            }
        }
    };

    let mut of = vec![OUTSIDE; count];
    let mut next = 0;
    // A node and all its neighbours, where none of them is taken.
    let mut members = Vec::new();
    for i in 0..count {
        if groups[i] == OUTSIDE || of[i] != OUTSIDE {
            continue;
        }
        members.clear();
        let mut taken = false;
        visit(i, &mut |j, _| {
            taken |= of[j] != OUTSIDE;
            members.push(j);
        });
        // A node without neighbours waits: it may be alone only in this direction.
        if taken || members.is_empty() {
            continue;
        }
        of[i] = next;
        members.iter().for_each(|&j| of[j] = next);
        next += 1;
    }
    // What is left joins the neighbour it is coupled to most.
    let first = of.clone();
    for i in 0..count {
        if groups[i] == OUTSIDE || of[i] != OUTSIDE {
            continue;
        }
        let mut best = 0.0;
        visit(i, &mut |j, value| {
            if first[j] != OUTSIDE && value > best {
                best = value;
                of[i] = first[j];
            }
        });
    }
    // The rest is far from all of them.
    for i in 0..count {
        if groups[i] == OUTSIDE || of[i] != OUTSIDE {
            continue;
        }
        members.clear();
        visit(i, &mut |j, _| {
            if of[j] == OUTSIDE {
                members.push(j);
            }
        });
        of[i] = next;
        members.iter().for_each(|&j| of[j] = next);
        next += 1;
    }
    (of, next as usize)
}

fn norm<const B: usize>(block: &Block<f64, B, B>) -> f64 {
    block
        .as_flattened()
        .iter()
        .map(|v| v * v)
        .sum::<f64>()
        .sqrt()
}

#[cfg(test)]
mod tests {
    use super::super::super::testing::grid;
    use super::{OUTSIDE, aggregate};

    #[test]
    fn aggregates_are_cubes_and_respect_groups() {
        let a = grid([9, 9, 9], 3);
        let (of, count) = aggregate::<3>(&a, &[0; 729], 0.0);
        // Cubes of 27 points, and some of odd shape where they do not fit.
        assert!((20..=40).contains(&count), "{count}");
        assert!(of.iter().all(|&node| (node as usize) < count));

        let groups: Vec<u32> = (0..729)
            .map(|i| match i / 81 {
                0 => OUTSIDE,
                layer => layer as u32 % 2,
            })
            .collect();
        let (of, count) = aggregate::<3>(&a, &groups, 0.0);
        for node in 0..count as u32 {
            let mut members = (0..729).filter(|&i| of[i] == node).map(|i| groups[i]);
            let first = members.next().unwrap();
            assert!(members.all(|group| group == first));
        }
        assert!((0..729).all(|i| (of[i] == OUTSIDE) == (i < 81)));
    }

    #[test]
    fn a_node_without_neighbours_is_its_own_aggregate() {
        let a = grid([3, 1, 1], 2);
        assert_eq!(aggregate::<2>(&a, &[0, 1, 0], 0.0), (vec![0, 1, 2], 3));
        assert_eq!(aggregate::<2>(&a, &[0, 0, 0], 0.0), (vec![0, 0, 0], 1));
    }
}

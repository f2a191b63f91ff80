//! Which columns are eliminated together.

use super::super::ordering::NONE;

/// Columns and zeros up to which a child joins its parent: at most this many columns, at most this share of zeros.
/// Small fronts cost more by their overhead than by their zeros.
const RELAXED: [(usize, f64); 4] = [(12, 1.0), (48, 0.5), (128, 0.1), (usize::MAX, 0.03)];

/// Groups of steps eliminated together, children before parents and subtree by subtree.
pub(super) struct Supernodes {
    /// The steps of each group, in an order of elimination.
    pub groups: Vec<Vec<u32>>,
    /// The group that takes the contribution, or [`NONE`].
    pub parents: Vec<u32>,
}

/// A group while groups are joined; sizes in steps.
struct Group {
    steps: Vec<u32>,
    rows: usize,
    zeros: f64,
    parent: u32,
    children: Vec<u32>,
}

impl Group {
    /// Stored entries, explicit zeros included.
    fn size(&self) -> f64 {
        size(self.steps.len(), self.rows)
    }
}

/// Entries of `columns` columns on and below the diagonal, with `rows` rows below.
fn size(columns: usize, rows: usize) -> f64 {
    let columns = columns as f64;
    columns * (0.5 * (columns + 1.0) + rows as f64)
}

impl Supernodes {
    /// From the postordered elimination tree, the entries of each column of the factor (the diagonal included) and
    /// the number of dofs a step stands for.
    pub fn new(parents: &[u32], counts: &[usize], block: usize) -> Supernodes {
        let mut groups = fundamental(parents, counts);
        let mut gone = vec![false; groups.len()];
        for at in 0..groups.len() {
            join_children(&mut groups, &mut gone, at, block);
        }
        postordered(groups, &gone)
    }
}

/// Runs of columns with the same rows.
fn fundamental(parents: &[u32], counts: &[usize]) -> Vec<Group> {
    let n = parents.len();
    let mut group_of = vec![NONE; n];
    let mut groups: Vec<Group> = Vec::new();
    for step in 0..n {
        let continues =
            step > 0 && parents[step - 1] as usize == step && counts[step - 1] == counts[step] + 1;
        match groups.last_mut() {
            Some(group) if continues => {
                group.steps.push(step as u32);
                group.rows = counts[step] - 1;
            }
            _ => groups.push(Group {
                steps: vec![step as u32],
                rows: counts[step] - 1,
                zeros: 0.0,
                parent: NONE,
                children: Vec::new(),
            }),
        }
        group_of[step] = groups.len() as u32 - 1;
    }
    for at in 0..groups.len() {
        let last = groups[at].steps[groups[at].steps.len() - 1];
        let parent = parents[last as usize];
        if parent != NONE {
            let parent = group_of[parent as usize];
            groups[at].parent = parent;
            groups[parent as usize].children.push(at as u32);
        }
    }
    groups
}

/// Joins to a group those of its children that bring few zeros, the ones with most rows first.
fn join_children(groups: &mut [Group], gone: &mut [bool], at: usize, block: usize) {
    let mut children: Vec<u32> = groups[at].children.drain(..).collect();
    let mut tried = children.clone();
    tried.sort_by_key(|&child| std::cmp::Reverse(groups[child as usize].rows));
    let mut before: Vec<u32> = Vec::new();
    for &child in &tried {
        let (parent, joined) = (&groups[at], &groups[child as usize]);
        let columns = parent.steps.len() + joined.steps.len() + before.len();
        let all = size(columns, parent.rows);
        let own = size(parent.steps.len() + before.len(), parent.rows);
        let zeros = parent.zeros + joined.zeros + (all - own - joined.size());
        let few = RELAXED
            .iter()
            .any(|&(most, share)| columns * block <= most && zeros <= share * all);
        if !few {
            continue;
        }
        let child = child as usize;
        gone[child] = true;
        before.append(&mut groups[child].steps);
        let grandchildren: Vec<u32> = groups[child].children.drain(..).collect();
        for &grandchild in &grandchildren {
            groups[grandchild as usize].parent = at as u32;
        }
        children.extend(grandchildren);
        groups[at].zeros = zeros;
    }
    children.retain(|&child| !gone[child as usize]);
    children.sort_unstable();
    before.append(&mut groups[at].steps);
    groups[at].steps = before;
    groups[at].children = children;
}

/// The groups that are left, in postorder.
fn postordered(groups: Vec<Group>, gone: &[bool]) -> Supernodes {
    let mut number = vec![NONE; groups.len()];
    let mut count = 0;
    let mut stack = Vec::new();
    for root in (0..groups.len()).filter(|&at| !gone[at] && groups[at].parent == NONE) {
        stack.push((root, 0));
        while let Some((at, next)) = stack.pop() {
            if let Some(&child) = groups[at].children.get(next) {
                stack.push((at, next + 1));
                stack.push((child as usize, 0));
            } else {
                number[at] = count;
                count += 1;
            }
        }
    }
    let mut left: Vec<(u32, Group)> = number.iter().copied().zip(groups).collect();
    left.retain(|(place, _)| *place != NONE);
    left.sort_unstable_by_key(|(place, _)| *place);
    let parent = |group: &Group| number.get(group.parent as usize).copied();
    Supernodes {
        parents: left
            .iter()
            .map(|(_, group)| parent(group).unwrap_or(NONE))
            .collect(),
        groups: left.into_iter().map(|(_, group)| group.steps).collect(),
    }
}

use std::collections::{BTreeMap, HashMap};

use crate::shape::ElementKind;

/// What the sections of a file say, before it is a mesh.
#[derive(Default)]
pub(super) struct Raw {
    /// Names of physical groups by dimension and tag.
    pub names: BTreeMap<(usize, i64), String>,
    /// In the order of the file.
    pub nodes: Vec<Node>,
    /// In the order of the file.
    pub elements: Vec<Element>,
    /// Node tags of all elements, one after the other, in our node order.
    pub element_nodes: Vec<u64>,
    /// The lists of groups that elements refer to.
    pub groups: Vec<Vec<Group>>,
    /// Version 4: index into `groups` of an entity, by dimension and tag.
    pub entities: HashMap<(usize, i64), usize>,
}

/// A node.
pub(super) struct Node {
    /// Its number.
    pub tag: u64,
    /// Where in the file.
    pub at: usize,
    /// Coordinates.
    pub x: [f64; 3],
}

/// An element.
pub(super) struct Element {
    /// Its kind; `None` is a point.
    pub kind: Option<ElementKind>,
    /// Its number.
    pub tag: u64,
    /// Number of the geometrical entity it lies on, unique within a dimension.
    pub entity: i64,
    /// Index into [`Raw::groups`].
    pub groups: usize,
    /// Index of its first node in [`Raw::element_nodes`].
    pub first: usize,
    /// Where in the file.
    pub at: usize,
}

/// Membership in a physical group.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub(super) struct Group {
    /// Number of the group, unique within a dimension.
    pub tag: i64,
    /// Whether the group counts the element with opposite orientation.
    pub reversed: bool,
}

impl Group {
    /// From a tag whose sign is the orientation.
    pub fn signed(tag: i64) -> Group {
        Group {
            tag: tag.saturating_abs(),
            reversed: tag < 0,
        }
    }
}

impl Element {
    /// 0 for points, then lines, surfaces, volumes.
    pub fn dim(&self) -> usize {
        self.kind.map_or(0, ElementKind::dim)
    }

    /// Its nodes.
    pub fn nodes<'a>(&self, all: &'a [u64]) -> &'a [u64] {
        &all[self.first..self.first + self.kind.map_or(1, ElementKind::node_count)]
    }
}

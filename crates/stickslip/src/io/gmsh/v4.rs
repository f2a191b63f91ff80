//! The sections of version 4.1.

use crate::error::MeshError;

use super::cursor::Cursor;
use super::raw::{Element, Group, Node, Raw};
use super::v2::{accepted, reorder};

/// `$Entities`: which physical groups each point, curve, surface and volume is in.
pub(super) fn entities(cursor: &mut Cursor, raw: &mut Raw) -> Result<(), MeshError> {
    let counts = entity_counts(cursor)?;
    for (dim, count) in counts.into_iter().enumerate() {
        for _ in 0..count {
            let tag = cursor.int("an entity tag")?;
            entity(cursor, raw, dim, tag, None)?;
        }
    }
    Ok(())
}

/// `$PartitionedEntities`: the same for the parts that a partition cuts the entities into. Their elements are in the
/// groups listed here, or in those of the entity they are a part of.
pub(super) fn partitioned(cursor: &mut Cursor, raw: &mut Raw) -> Result<(), MeshError> {
    cursor.size("the number of partitions")?;
    let ghosts = cursor.count("the number of ghost entities", 2, 8)?;
    for _ in 0..ghosts {
        cursor.int("a ghost entity")?;
        cursor.int("its partition")?;
    }
    let counts = entity_counts(cursor)?;
    for (dim, count) in counts.into_iter().enumerate() {
        for _ in 0..count {
            let tag = cursor.int("an entity tag")?;
            let parent_dim = cursor.int("the dimension of the parent entity")?;
            let parent = cursor.int("the tag of the parent entity")?;
            let partitions = cursor.count("the number of partitions of an entity", 1, 4)?;
            for _ in 0..partitions {
                cursor.int("a partition")?;
            }
            let inherits = (parent_dim == dim as i64).then_some((dim, parent));
            entity(cursor, raw, dim, tag, inherits)?;
        }
    }
    Ok(())
}

fn entity_counts(cursor: &mut Cursor) -> Result<[usize; 4], MeshError> {
    let mut counts = [0; 4];
    for (dim, count) in counts.iter_mut().enumerate() {
        let numbers = if dim == 0 { 5 } else { 8 };
        let bytes = if dim == 0 { 36 } else { 60 };
        *count = cursor.count("the number of entities", numbers, bytes)?;
    }
    Ok(counts)
}

/// Coordinates or bounds, physical tags, and the entities it is bounded by.
fn entity(
    cursor: &mut Cursor,
    raw: &mut Raw,
    dim: usize,
    tag: i64,
    inherits: Option<(usize, i64)>,
) -> Result<(), MeshError> {
    for _ in 0..if dim == 0 { 3 } else { 6 } {
        cursor.float("the bounds of an entity")?;
    }
    let count = cursor.count("the number of physical groups of an entity", 1, 4)?;
    let mut groups = Vec::with_capacity(count);
    for _ in 0..count {
        groups.push(Group::signed(cursor.int("a physical tag")?));
    }
    if dim > 0 {
        let bounding = cursor.count("the number of bounding entities", 1, 4)?;
        for _ in 0..bounding {
            cursor.int("a bounding entity")?;
        }
    }
    let list = match inherits.and_then(|parent| raw.entities.get(&parent)) {
        Some(&parent) if groups.is_empty() => parent,
        _ => {
            raw.groups.push(groups);
            raw.groups.len() - 1
        }
    };
    raw.entities.insert((dim, tag), list);
    Ok(())
}

/// Dimension and tag of the entity of a block of nodes or elements.
fn owner(cursor: &mut Cursor) -> Result<(usize, i64), MeshError> {
    let at = cursor.next_position();
    let dim = cursor.int("the dimension of an entity")?;
    let tag = cursor.int("the tag of an entity")?;
    match usize::try_from(dim) {
        Ok(dim) if dim <= 3 => Ok((dim, tag)),
        _ => Err(cursor
            .error_at(at, format!("the dimension of an entity is {dim}"))
            .help("the counts of the block before may be wrong: save the file again with Gmsh")),
    }
}

/// `$Nodes`: blocks of tags, then of coordinates (with parameters on the entity, if saved).
pub(super) fn nodes(cursor: &mut Cursor, raw: &mut Raw) -> Result<(), MeshError> {
    let blocks = cursor.count("the number of node blocks", 4, 20)?;
    let total = cursor.count("the number of nodes", 4, 32)?;
    cursor.size("the smallest node tag")?;
    cursor.size("the largest node tag")?;
    raw.nodes.reserve(total);
    for _ in 0..blocks {
        let (dim, _) = owner(cursor)?;
        let parameters = match cursor.int("whether the block is parametric")? {
            0 => 0,
            _ => dim,
        };
        let count = cursor.count("the number of nodes in a block", 4, 32)?;
        let first = raw.nodes.len();
        for _ in 0..count {
            let at = cursor.next_position();
            let tag = cursor.size("a node tag")?;
            let x = [0.0; 3];
            raw.nodes.push(Node { tag, at, x });
        }
        for node in &mut raw.nodes[first..] {
            node.at = cursor.next_position();
            node.x = cursor.coordinates(node.tag)?;
            for _ in 0..parameters {
                cursor.float("a parameter of a node")?;
            }
        }
    }
    matches_total(cursor, "nodes", raw.nodes.len(), total)
}

/// `$Elements`: blocks of one kind on one entity.
pub(super) fn elements(cursor: &mut Cursor, raw: &mut Raw) -> Result<(), MeshError> {
    let blocks = cursor.count("the number of element blocks", 4, 20)?;
    let total = cursor.count("the number of elements", 2, 16)?;
    cursor.size("the smallest element tag")?;
    cursor.size("the largest element tag")?;
    raw.elements.reserve(total);
    raw.groups.push(Vec::new());
    let no_groups = raw.groups.len() - 1;
    for _ in 0..blocks {
        let (dim, entity) = owner(cursor)?;
        let gmsh_type = cursor.int("an element type")?;
        let groups = *raw.entities.get(&(dim, entity)).unwrap_or(&no_groups);
        let count = cursor.count("the number of elements in a block", 2, 16)?;
        for _ in 0..count {
            let at = cursor.next_position();
            let tag = cursor.size("an element tag")?;
            let (kind, order) = accepted(cursor, gmsh_type, tag, at)?;
            let first = raw.element_nodes.len();
            for _ in 0..kind.map_or(1, |k| k.node_count()) {
                raw.element_nodes.push(cursor.size("a node tag")?);
            }
            reorder(&mut raw.element_nodes[first..], order);
            raw.elements.push(Element {
                kind,
                tag,
                entity,
                groups,
                first,
                at,
            });
        }
    }
    matches_total(cursor, "elements", raw.elements.len(), total)
}

fn matches_total(cursor: &Cursor, what: &str, read: usize, total: usize) -> Result<(), MeshError> {
    if read == total {
        return Ok(());
    }
    Err(cursor
        .error(format!(
            "the section announces {total} {what} but its blocks hold {read}"
        ))
        .help("the file is damaged: save it again with Gmsh"))
}

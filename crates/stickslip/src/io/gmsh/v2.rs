//! The sections of version 2.2.

use std::collections::HashMap;

use crate::error::MeshError;

use super::cursor::{Cursor, Mode};
use super::kinds::{Kind, kind};
use super::raw::{Element, Group, Node, Raw};

fn tag(cursor: &mut Cursor, what: &str) -> Result<u64, MeshError> {
    let at = cursor.next_position();
    let value = cursor.int(what)?;
    u64::try_from(value).map_err(|_| {
        cursor
            .error_at(at, format!("{what} is negative: {value}"))
            .help("numbers of nodes and elements count from 1: save the mesh again with Gmsh")
    })
}

/// `$Nodes`: a count, then number and coordinates.
pub(super) fn nodes(cursor: &mut Cursor, raw: &mut Raw) -> Result<(), MeshError> {
    let count = section_count(cursor, "the number of nodes", 4 * 2, 4 + 24)?;
    raw.nodes.reserve(count);
    for _ in 0..count {
        let at = cursor.next_position();
        let tag = tag(cursor, "a node number")?;
        let x = cursor.coordinates(tag)?;
        raw.nodes.push(Node { tag, at, x });
    }
    Ok(())
}

/// A count that is text in binary files too; the numbers begin on the next line.
fn section_count(
    cursor: &mut Cursor,
    what: &str,
    ascii: usize,
    binary: usize,
) -> Result<usize, MeshError> {
    let at = cursor.position();
    let n = cursor.text_count(what)?;
    let least = if cursor.mode == Mode::Ascii {
        ascii
    } else {
        cursor.rest_of_line();
        binary
    };
    cursor.held(at, what, n as u64, least)
}

/// `$Elements`: in text `number type tag-count tags nodes`; in binary runs of one type and tag count behind a header.
/// The first tag is the physical group, the second the entity.
pub(super) fn elements(cursor: &mut Cursor, raw: &mut Raw) -> Result<(), MeshError> {
    let count = section_count(cursor, "the number of elements", 4 * 2, 8)?;
    raw.elements.reserve(count);
    let mut lists = HashMap::new();
    let mut read = 0;
    while read < count {
        if cursor.mode == Mode::Ascii {
            let at = cursor.next_position();
            let number = tag(cursor, "an element number")?;
            let head = Head::read(cursor)?;
            element(cursor, raw, &mut lists, number, &head, at)?;
            read += 1;
        } else {
            let at = cursor.position();
            let gmsh_type = cursor.int("an element type")?;
            let run = cursor.int("a number of elements")?;
            let tags = cursor.int("a number of tags")?;
            let head = Head {
                gmsh_type,
                tags,
                at,
            };
            let run = usize::try_from(run).unwrap_or(0);
            if run == 0 || run > count - read {
                return Err(cursor
                    .error_at(at, "a run of elements is empty or longer than the section")
                    .help("the file is damaged: save it again with Gmsh"));
            }
            for _ in 0..run {
                let at = cursor.position();
                let number = tag(cursor, "an element number")?;
                element(cursor, raw, &mut lists, number, &head, at)?;
            }
            read += run;
        }
    }
    Ok(())
}

struct Head {
    gmsh_type: i64,
    tags: i64,
    at: usize,
}

impl Head {
    fn read(cursor: &mut Cursor) -> Result<Head, MeshError> {
        let at = cursor.next_position();
        Ok(Head {
            gmsh_type: cursor.int("an element type")?,
            tags: cursor.int("a number of tags")?,
            at,
        })
    }
}

fn element(
    cursor: &mut Cursor,
    raw: &mut Raw,
    lists: &mut HashMap<i64, usize>,
    number: u64,
    head: &Head,
    at: usize,
) -> Result<(), MeshError> {
    let tags = u64::try_from(head.tags).unwrap_or(u64::MAX);
    let tags = cursor.held(head.at, "the number of tags", tags, 1)?;
    let (mut physical, mut entity) = (0, 0);
    for i in 0..tags {
        let value = cursor.int("an element tag")?;
        match i {
            0 => physical = value,
            1 => entity = value,
            _ => {}
        }
    }
    let groups = *lists.entry(physical).or_insert_with(|| {
        let none = physical == 0;
        raw.groups.push(if none {
            Vec::new()
        } else {
            vec![Group::signed(physical)]
        });
        raw.groups.len() - 1
    });
    let (kind, order) = accepted(cursor, head.gmsh_type, number, at)?;
    let first = raw.element_nodes.len();
    let count = kind.map_or(1, |k| k.node_count());
    for _ in 0..count {
        let node = tag(cursor, "a node number")?;
        raw.element_nodes.push(node);
    }
    reorder(&mut raw.element_nodes[first..], order);
    raw.elements.push(Element {
        kind,
        tag: number,
        entity,
        groups,
        first,
        at,
    });
    Ok(())
}

/// The kind and node order of a Gmsh type, or why it is refused.
pub(super) fn accepted(
    cursor: &Cursor,
    gmsh_type: i64,
    number: u64,
    at: usize,
) -> Result<(Option<crate::shape::ElementKind>, &'static [usize]), MeshError> {
    match kind(gmsh_type) {
        Kind::Point => Ok((None, &[])),
        Kind::Solid(kind, order) => Ok((Some(kind), order)),
        Kind::Refused(name, help) => Err(cursor
            .error_at(
                at,
                format!("element {number} is of Gmsh type {gmsh_type} ({name}), which is not read"),
            )
            .help(help)),
    }
}

/// Brings the nodes of an element from Gmsh's order into ours.
pub(super) fn reorder(nodes: &mut [u64], order: &[usize]) {
    let mut copy = [0; crate::shape::MAX_NODES];
    copy[..nodes.len()].copy_from_slice(nodes);
    for (node, &from) in nodes.iter_mut().zip(order) {
        *node = copy[from];
    }
}

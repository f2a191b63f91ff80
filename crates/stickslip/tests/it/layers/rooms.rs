//! Rooms: the folders of a crate. What lies in one has an order, in which nothing imports from what comes later.

use std::collections::{BTreeMap, BTreeSet, VecDeque};

use super::tree::{Arrow, Module, Tree};

/// Arrows between the entries of a room, files and folders, with one import that each stands for. The `mod.rs` of the room is an entry of its own.
pub type Plan = BTreeMap<String, BTreeMap<String, Arrow>>;

/// The plan of a room of a tree.
pub fn plan(arrows: &[Arrow], room: &[String]) -> Plan {
    let entry = |module: &Module| -> Option<String> {
        let below = module.strip_prefix(room)?;
        Some(below.first().map_or("mod.rs", String::as_str).to_string())
    };
    let mut plan = Plan::new();
    for arrow in arrows {
        if let (Some(from), Some(to)) = (entry(&arrow.from), entry(&arrow.to))
            && from != to
        {
            let known = plan.entry(from).or_default();
            known.entry(to).or_insert_with(|| arrow.clone());
        }
    }
    plan
}

/// All rooms of a crate, from the outside in.
pub fn rooms(tree: &Tree) -> BTreeSet<Module> {
    let of = |m: &Module| (0..m.len()).map(|n| m[..n].to_vec()).collect::<Vec<_>>();
    tree.files.keys().flat_map(of).collect()
}

/// A shortest circle through an entry.
fn through(plan: &Plan, start: &str) -> Option<Vec<Arrow>> {
    let mut came: BTreeMap<&str, (&str, &Arrow)> = BTreeMap::new();
    let mut next = VecDeque::from([start]);
    while let Some(at) = next.pop_front() {
        for (to, arrow) in plan.get(at).into_iter().flatten() {
            if came.contains_key(to.as_str()) {
                continue;
            }
            came.insert(to, (at, arrow));
            next.push_back(to);
        }
    }
    let mut circle = Vec::new();
    let mut at = start;
    while let Some((from, arrow)) = came.get(at) {
        circle.push((*arrow).clone());
        at = from;
        if at == start {
            circle.reverse();
            return Some(circle);
        }
    }
    None
}

/// Circles of a room: for every entry that is part of one the shortest through it, each circle once.
pub fn circles(plan: &Plan) -> Vec<Vec<Arrow>> {
    let mut seen = BTreeSet::new();
    let mut out = Vec::new();
    for start in plan.keys() {
        if seen.contains(start.as_str()) {
            continue;
        }
        if let Some(circle) = through(plan, start) {
            seen.insert(start.as_str());
            for (from, to) in plan {
                if to
                    .values()
                    .any(|a| circle.iter().any(|c| c.from == a.from && c.to == a.to))
                {
                    seen.insert(from.as_str());
                }
            }
            out.push(circle);
        }
    }
    out
}

/// A circle as a sentence: every import on its way.
pub fn sentence(circle: &[Arrow]) -> String {
    let name = |m: &Module| match m.is_empty() {
        true => "the root".to_string(),
        false => m.join("::"),
    };
    let lines = circle.iter().map(|a| {
        let (file, line, path) = (a.file.display(), a.line, &a.path);
        format!(
            "  {file}:{line}: `{path}`: {} -> {}",
            name(&a.from),
            name(&a.to)
        )
    });
    lines.collect::<Vec<_>>().join("\n")
}

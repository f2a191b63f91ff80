//! `*NGEN`, `*NFILL` and `*NCOPY`: nodes that are made of others, as in Abaqus.

use stickslip::math::{Vec3, add, cross, dot, norm, scale, sub};

use super::fields::{Nodes, line, named_nodes, number, parameter, required, whole};
use super::messages::Messages;
use super::reader::Reader;
use super::sets::add as join;
use crate::axes::polar;
use crate::card::{Card, Data, Place};
use crate::motion::Motion;
use crate::text::{self, clip};

/// Most nodes or elements that one line makes: a short deck must not ask for more than there is memory.
pub(super) const MOST_OF_A_LINE: u64 = 10_000_000;

/// A curve from one node to another, by the fraction of the way.
enum Curve {
    Line([Vec3; 2]),
    Parabola([Vec3; 3]),
    /// Center, radius vector of the start, the vector that it turns to after a right angle, angle, and radii at both ends.
    Arc(Vec3, [Vec3; 2], f64, [f64; 2]),
}

impl Curve {
    fn at(&self, t: f64) -> Vec3 {
        match self {
            Curve::Line([a, b]) => blend(*a, *b, t),
            Curve::Parabola([a, m, b]) => {
                let of = [
                    (1.0 - t) * (1.0 - 2.0 * t),
                    4.0 * t * (1.0 - t),
                    t * (2.0 * t - 1.0),
                ];
                add(add(scale(of[0], *a), scale(of[1], *m)), scale(of[2], *b))
            }
            Curve::Arc(center, [x, y], angle, [first, last]) => {
                let (s, c) = (t * angle).sin_cos();
                let out = add(scale(c, *x), scale(s, *y));
                add(*center, scale(first + t * (last - first), out))
            }
        }
    }
}

fn blend(a: Vec3, b: Vec3, t: f64) -> Vec3 {
    add(scale(1.0 - t, a), scale(t, b))
}

/// How nodes are copied.
enum Copy {
    Moved(Motion),
    /// At a point or at the line or plane through it: what is along the line or normal to the plane.
    Reflected(Vec3, Mirror),
}

enum Mirror {
    Point,
    Line(Vec3),
    Plane(Vec3),
}

impl Copy {
    fn of(&self, x: Vec3) -> Vec3 {
        match self {
            Copy::Moved(motion) => motion.point(x),
            Copy::Reflected(a, mirror) => {
                let r = sub(x, *a);
                match mirror {
                    Mirror::Point => sub(*a, r),
                    Mirror::Line(d) => add(*a, sub(scale(2.0 * dot(r, *d), *d), r)),
                    Mirror::Plane(n) => add(*a, sub(r, scale(2.0 * dot(r, *n), *n))),
                }
            }
        }
    }
}

/// Puts nodes into the deck, by their numbers in it; the last coordinates count.
pub(super) fn put_node(reader: &mut Reader, id: u64, x: Vec3, place: Place) {
    let before = reader.deck.nodes.insert(id, x);
    let far = |b: &Vec3| norm(sub(x, *b)) > 1e-9 * norm(x).max(norm(*b));
    if before.as_ref().is_some_and(far) {
        let message = format!(
            "node {} is given twice; the last one counts",
            reader.scope.label(id)
        );
        reader.messages.warn(place, message, "");
    }
}

/// The number of a node of the scope that exists, from a field.
fn node_at(reader: &mut Reader, data: &Data, field: usize) -> Option<(u64, Vec3)> {
    let messages = &mut reader.messages;
    let own = whole(messages, data, field)?;
    let id = reader.scope.of(own);
    let place = reader.deck.nodes.get(&id).copied();
    if place.is_none() {
        let message = format!("there is no node {}", reader.scope.label(id));
        let help = "*NODE must stand before what is made of its nodes";
        messages.error(data.place, message, help);
    }
    Some((own, place?))
}

/// Makes sets sorted, as those of generated nodes are.
fn collect(reader: &mut Reader, card: &Card, parameter: &str, nodes: Vec<u64>) {
    if let Some(name) = card.get(parameter) {
        let name = reader.scope.scoped(name);
        let set = reader.deck.node_sets.entry(name).or_default();
        join(set, nodes);
        set.sort_unstable();
    }
}

/// `*NGEN`: nodes on a line between two.
pub(super) fn generate_nodes(reader: &mut Reader, card: &Card) {
    let mut made = Vec::new();
    for data in &card.data {
        let ends = (node_at(reader, data, 0), node_at(reader, data, 1));
        let (Some((first, a)), Some((last, b))) = ends else {
            continue;
        };
        let by = match data.fields.get(2).map_or("", String::as_str) {
            "" => 1,
            // The sign is that of the way from the first node to the last.
            text => match text::whole(text.trim_start_matches('-')) {
                Some(by) => by,
                None => {
                    whole(&mut reader.messages, data, 2);
                    continue;
                }
            },
        };
        let span = first.abs_diff(last);
        if span == 0 || !span.is_multiple_of(by) || span / by > MOST_OF_A_LINE {
            let message =
                format!("the numbers from {first} to {last} do not divide into steps of {by}");
            let help =
                "write the first node, the last node and the increment of the numbers between them";
            reader.messages.error(data.place, message, help);
            continue;
        }
        let Some(curve) = curve(reader, card, data, [a, b]) else {
            continue;
        };
        let count = span / by;
        for k in 0..=count {
            let own = match last > first {
                true => first + k * by,
                false => first - k * by,
            };
            let id = reader.scope.of(own);
            if k > 0 && k < count {
                put_node(reader, id, curve.at(k as f64 / count as f64), data.place);
            }
            made.push(id);
        }
    }
    collect(reader, card, "NSET", made);
}

/// The curve of a line of `*NGEN`.
fn curve(reader: &mut Reader, card: &Card, data: &Data, [a, b]: [Vec3; 2]) -> Option<Curve> {
    let kind = card.get("LINE").unwrap_or("");
    if kind.is_empty() {
        return Some(Curve::Line([a, b]));
    }
    let extra = extra_point(reader, card, data)?;
    match kind {
        "P" => Some(Curve::Parabola([a, extra, b])),
        "C" => arc(reader, data, extra, [a, b]),
        other => {
            let message = format!("*NGEN, LINE={} is not known", clip(other));
            let help = "LINE is C (circular arc) or P (parabola)";
            reader.messages.error(card.place, message, help);
            None
        }
    }
}

/// The point that makes a curve of a line: a node, or coordinates.
fn extra_point(reader: &mut Reader, card: &Card, data: &Data) -> Option<Vec3> {
    if data.fields.get(3).is_some_and(|f| !f.is_empty()) {
        return node_at(reader, data, 3).map(|(_, x)| x);
    }
    let messages = &mut reader.messages;
    if reader.system != Motion::NONE {
        let message = "*NGEN gives coordinates while a *SYSTEM counts";
        let help = "give the extra point as a node, by its number in the fourth field";
        messages.error(data.place, message, help);
        return None;
    }
    let x = [4, 5, 6].map(|i| number(messages, data, i, 0.0));
    let x = match card.get("SYSTEM") {
        Some("C") => polar(x),
        None | Some("" | "R" | "RC") => x,
        Some(_) => {
            let message = "*NGEN: only rectangular and cylindrical coordinates are read";
            messages.error(card.place, message, "give x, y and z of the extra point");
            return None;
        }
    };
    Some(reader.scope.motion().point(x))
}

fn arc(reader: &mut Reader, data: &Data, center: Vec3, ends: [Vec3; 2]) -> Option<Curve> {
    let messages = &mut reader.messages;
    let help = "the fields are: first node, last node, increment, node of the center or nothing, x, y, z of the center, and x, y, z of the normal, about which the arc turns from first to last";
    let [a, b] = ends.map(|e| sub(e, center));
    let radii = [norm(a), norm(b)];
    if !(radii[0] > 0.0 && (radii[0] - radii[1]).abs() <= 1e-2 * radii[0]) {
        let message = format!(
            "the ends of the arc are {} and {} from its center",
            radii[0], radii[1]
        );
        messages.error(data.place, message, help);
        return None;
    }
    let given = [7, 8, 9].map(|i| number(messages, data, i, 0.0));
    let given = reader.scope.motion().vector(given);
    let across = cross(a, b);
    let straight = norm(across) <= 1e-6 * radii[0] * radii[1];
    let normal = match norm(given) > 0.0 {
        true => scale(1.0 / norm(given), given),
        false if straight => {
            let message =
                "the ends of the arc and its center lie on one line: its plane is not known";
            messages.error(data.place, message, help);
            return None;
        }
        false => scale(1.0 / norm(across), across),
    };
    if dot(normal, a).abs() > 1e-3 * radii[0] || dot(normal, b).abs() > 1e-3 * radii[1] {
        let message = "the normal of the arc is not normal to the radii of its ends";
        messages.error(data.place, message, help);
        return None;
    }
    let turn = dot(normal, across).atan2(dot(a, b));
    let full = std::f64::consts::TAU;
    let angle = if turn > 1e-9 { turn } else { turn + full };
    let x = scale(1.0 / radii[0], a);
    Some(Curve::Arc(center, [x, cross(normal, x)], angle, radii))
}

/// `*NFILL`: nodes between two sets.
pub(super) fn fill_nodes(reader: &mut Reader, card: &Card) {
    let messages = &mut reader.messages;
    let bias = parameter(messages, card, "BIAS").unwrap_or(1.0);
    if bias <= 0.0 {
        let help = "it is the ratio of a distance to the next one, and above 0";
        messages.error(card.place, format!("*NFILL: BIAS is {bias}"), help);
        return;
    }
    let two = card.has("TWOSTEP");
    let mut made = Vec::new();
    for data in &card.data {
        let bounds = (bound(reader, data, 0), bound(reader, data, 1));
        let (Some(first), Some(last)) = bounds else {
            continue;
        };
        let by = match data.fields.get(3).is_none_or(String::is_empty) {
            true => Some(1),
            false => whole(&mut reader.messages, data, 3),
        };
        let (Some(count), Some(by)) = (whole(&mut reader.messages, data, 2), by) else {
            continue;
        };
        let lines = first.len().min(last.len());
        if first.len() != last.len() {
            let message = format!(
                "*NFILL: {} and {} nodes bound the region: {lines} of them are joined in the order of the sets",
                first.len(),
                last.len()
            );
            let help = "let both sets have as many nodes";
            reader.messages.warn(data.place, message, help);
        }
        if count * lines as u64 > MOST_OF_A_LINE || (two && !count.is_multiple_of(2)) {
            let message = format!("*NFILL: {count} intervals cannot be made");
            let help =
                "their number is even with TWO STEP, and nodes are not more than ten million";
            reader.messages.error(data.place, message, help);
            continue;
        }
        let way = fractions(count, bias, two);
        for (from, to) in first.iter().zip(&last) {
            let (a, b) = (reader.deck.nodes[from], reader.deck.nodes[to]);
            let own = reader.scope.numbering.parts(*from).1;
            for (k, t) in way.iter().enumerate().take(count as usize).skip(1) {
                let id = reader.scope.of(own + k as u64 * by);
                put_node(reader, id, blend(a, b, *t), data.place);
                made.push(id);
            }
        }
        made.extend(first);
        made.extend(last);
    }
    collect(reader, card, "NSET", made);
}

/// The nodes of a bounding set, which are sorted unless the set says that they are not.
fn bound(reader: &mut Reader, data: &Data, field: usize) -> Option<Vec<u64>> {
    let text = data.fields.get(field).map_or("", String::as_str);
    let mut nodes = match named_nodes(reader, text, reader.scope.name(text)) {
        Nodes::One(n) => vec![n],
        Nodes::Set(name) => {
            let nodes = reader.deck.node_sets[&name].clone();
            if reader.sets.unsorted.contains(&name) {
                return Some(nodes);
            }
            nodes
        }
        _ => {
            let message = format!("there is no set of nodes {}", clip(text));
            let help = "the fields are: first set, second set, number of intervals, increment of the numbers";
            reader.messages.error(data.place, message, help);
            return None;
        }
    };
    nodes.sort_unstable();
    Some(nodes)
}

/// `*NCOPY`: nodes of a set once more, at another place.
pub(super) fn copy_nodes(reader: &mut Reader, card: &Card) {
    let messages = &mut reader.messages;
    let (Some(old), Some(text)) = (
        required(messages, card, "OLDSET"),
        required(messages, card, "CHANGENUMBER"),
    ) else {
        return;
    };
    let Some(change) = text::number(&text).filter(|n| n.fract() == 0.0 && n.abs() < 4e9) else {
        let message = format!("*NCOPY: CHANGE NUMBER is `{}`", clip(&text));
        let help = "it is a whole number, which is added to the numbers of the nodes";
        messages.error(card.place, message, help);
        return;
    };
    let name = reader.scope.scoped(&old);
    let Some(nodes) = reader.deck.node_sets.get(&name).cloned() else {
        let message = format!("there is no set of nodes {}", clip(&old));
        messages.error(card.place, message, "define it with *NSET before");
        return;
    };
    let Some(copy) = copy(reader, card) else {
        return;
    };
    let mut made = Vec::with_capacity(nodes.len());
    for n in nodes {
        let own = reader.scope.numbering.parts(n).1 as f64 + change;
        if own < 1.0 {
            let message = format!("node {} would have the number {own}", reader.scope.label(n));
            let help = "numbers are above 0";
            reader.messages.error(card.place, message, help);
            return;
        }
        let id = reader.scope.of(own as u64);
        put_node(reader, id, copy.of(reader.deck.nodes[&n]), card.place);
        made.push(id);
    }
    if reader.sets.unsorted.contains(&name)
        && let Some(new) = card.get("NEWSET").map(|n| reader.scope.scoped(n))
        && !reader.deck.node_sets.contains_key(&new)
    {
        reader.sets.unsorted.insert(new.clone());
        reader.deck.node_sets.insert(new, made);
        return;
    }
    collect(reader, card, "NEWSET", made);
}

/// How a `*NCOPY` copies.
fn copy(reader: &mut Reader, card: &Card) -> Option<Copy> {
    let messages = &mut reader.messages;
    let motion = reader.scope.motion();
    let point = |messages: &mut Messages, data: &Data, from: usize| {
        motion.point([0, 1, 2].map(|i| number(messages, data, from + i, 0.0)))
    };
    let help = "write SHIFT, with a line of the translation and one of two points of the axis and the angle, or REFLECT=POINT, LINE or MIRROR with one, two or three points";
    let first = line(messages, card)?;
    let a = point(messages, first, 0);
    let b = point(messages, first, 3);
    let along = |v: Vec3| (norm(v) > 0.0).then(|| scale(1.0 / norm(v), v));
    let copy = match (card.has("SHIFT"), card.get("REFLECT").unwrap_or("")) {
        (true, "") => {
            let shift = [0, 1, 2].map(|i| number(messages, first, i, 0.0));
            let moved = Motion::by(motion.vector(shift));
            match card.data.get(1) {
                None => Some(Copy::Moved(moved)),
                Some(second) => {
                    let ends = [point(messages, second, 0), point(messages, second, 3)];
                    match number(messages, second, 6, 0.0) {
                        0.0 => Some(Copy::Moved(moved)),
                        angle => moved.then_turned(ends[0], ends[1], angle).map(Copy::Moved),
                    }
                }
            }
        }
        (false, "POINT") => Some(Copy::Reflected(a, Mirror::Point)),
        (false, "LINE") => along(sub(b, a)).map(|d| Copy::Reflected(a, Mirror::Line(d))),
        (false, "MIRROR") => {
            let second = card.data.get(1);
            let c = second.map(|d| point(messages, d, 0));
            c.and_then(|c| along(cross(sub(b, a), sub(c, a))))
                .map(|n| Copy::Reflected(a, Mirror::Plane(n)))
        }
        _ => None,
    };
    if copy.is_none() {
        let message = "*NCOPY does not say where the nodes are put";
        messages.error(card.place, message, help);
    }
    copy
}

/// How far along the way the ends of intervals are, from 0 to 1. A distance is `bias` times the next one; in two steps that is so of pairs of intervals, which are halved.
fn fractions(count: u64, bias: f64, two: bool) -> Vec<f64> {
    let steps = if two { count / 2 } else { count };
    let mut ends = vec![0.0];
    let mut length = 1.0;
    let mut end = 0.0;
    for _ in 0..steps {
        end += length;
        ends.push(end);
        length /= bias;
    }
    let whole = end;
    let ends: Vec<f64> = ends.into_iter().map(|e| e / whole).collect();
    if !two {
        return ends;
    }
    let halves = ends.windows(2).flat_map(|w| [w[0], 0.5 * (w[0] + w[1])]);
    halves.chain([1.0]).collect()
}

#[cfg(test)]
mod tests {
    use super::fractions;

    #[test]
    fn distances_have_the_ratio_of_the_bias() {
        let ends = fractions(3, 0.5, false);
        let lengths: Vec<f64> = ends.windows(2).map(|w| w[1] - w[0]).collect();
        for (found, wanted) in lengths.iter().zip([1.0 / 7.0, 2.0 / 7.0, 4.0 / 7.0]) {
            assert!((found - wanted).abs() < 1e-15, "{lengths:?}");
        }
        let two = fractions(4, 0.5, true);
        for (found, wanted) in two.iter().zip([0.0, 1.0 / 6.0, 1.0 / 3.0, 2.0 / 3.0, 1.0]) {
            assert!((found - wanted).abs() < 1e-15, "{two:?}");
        }
    }
}

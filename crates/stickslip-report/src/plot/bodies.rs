//! Which bodies are drawn, and from where, so that the field can be seen.

use stickslip::math::cross;
use stickslip::problem::nearest;

use super::apart::{Contact, Row, Stage, in_view, middles, row, views};
use super::axis;
use super::camera::{Camera, View, unit};
use super::picture::{Apart, Picture, Zoom};
use crate::skin::Skin;

type Vec3 = [f64; 3];

/// What is drawn.
#[derive(Debug, Clone, PartialEq)]
pub struct Shown {
    /// Whether each body is.
    pub bodies: Vec<bool>,
    /// From where.
    pub view: View,
    /// By how much each is moved, so that what touches is seen `[length]`.
    pub offsets: Vec<Vec3>,
    /// The part of the faces in contact that is seen; `None` where no field of contact in space is drawn.
    pub in_view: Option<f64>,
    /// For the caption, if it is not everything.
    pub words: Option<String>,
    /// What was chosen for the reader.
    pub notes: Vec<String>,
}

/// How the surfaces in contact are seen in space: as the picture of the contact pressure shows them.
pub struct Arrangement {
    /// Whether each body is drawn.
    pub bodies: Vec<bool>,
    /// By how much each is moved `[length]`.
    pub offsets: Vec<[f64; 3]>,
    /// Towards the eye.
    pub view: [f64; 3],
}

/// What is known when bodies and view are chosen.
#[derive(Clone, Copy)]
pub struct Known<'a> {
    /// Names of the bodies.
    pub names: &'a [String],
    /// The values of the field on the skin.
    pub values: &'a [f64],
    /// All bodies, as they are drawn where nothing is moved.
    pub stage: Stage<'a>,
    /// What touches.
    pub contacts: &'a [Contact],
    /// The unit of length; may be empty.
    pub length: &'a str,
}

/// Distances to which bodies are drawn apart, parts of the model, the first that shows enough.
const DISTANCES: [f64; 8] = [0.0, 0.1, 0.2, 0.35, 0.5, 0.75, 1.0, 1.4];

/// The part of the faces that is enough, and the part below which one side alone may be better.
const ENOUGH_IN_VIEW: [f64; 2] = [0.95, 0.6];

/// Chooses bodies and view. A field that only surfaces of contact carry is hidden between the bodies in 3D: these are drawn apart, or, where the patch that touches is small, one side
/// of the contact alone, from where it looks.
pub fn choose(known: &Known, wanted: &Picture) -> Result<Shown, String> {
    let skin = known.stage.skin;
    let mut shown = named(known, wanted)?;
    let drawn = |c: &&Contact| c.bodies.iter().flatten().any(|&b| shown.bodies[b]);
    let contacts: Vec<Contact> = known.contacts.iter().filter(drawn).cloned().collect();
    let known = &Known {
        contacts: &contacts,
        ..*known
    };
    let missing = known.values.iter().filter(|v| v.is_nan()).count();
    if skin.dim != 3 || missing == 0 || missing == known.values.len() {
        return Ok(shown);
    }
    let near = wanted.zoom == Zoom::Contact || wanted.zoom == Zoom::Auto && small(known);
    let apart = (wanted.apart != Apart::Auto || !near)
        .then(|| row(known.contacts, &middles(known.stage), known.stage.mirrors))
        .flatten();
    if apart.is_some() || wanted.apart != Apart::Auto {
        spread(known, wanted, apart.as_ref(), &mut shown);
    }
    if shown.in_view.is_some_and(|part| part >= ENOUGH_IN_VIEW[1]) || wanted.apart != Apart::Auto {
        return Ok(shown);
    }
    let mut alone = named(known, wanted)?;
    one_side(known, wanted, &mut alone);
    match shown.in_view > alone.in_view {
        true => Ok(shown),
        false => Ok(alone),
    }
}

/// The bodies that are asked for, where they are.
fn named(known: &Known, wanted: &Picture) -> Result<Shown, String> {
    let count = known.stage.skin.ends.len();
    let mut shown = Shown {
        bodies: vec![wanted.bodies.is_empty(); count],
        view: wanted.view.unwrap_or(View::Iso),
        offsets: vec![[0.0; 3]; count],
        in_view: None,
        words: None,
        notes: Vec::new(),
    };
    for name in &wanted.bodies {
        match known.names.iter().take(count).position(|n| n == name) {
            Some(i) => shown.bodies[i] = true,
            None => {
                let names = known.names.iter().take(count).map(String::as_str);
                let names: Vec<&str> = names.collect();
                let meant = nearest(name, &names).map(|meant| format!("did you mean `{meant}`? "));
                let (meant, names) = (meant.unwrap_or_default(), names.join(", "));
                return Err(format!(
                    "there is no body `{name}`; {meant}there are {names}"
                ));
            }
        }
    }
    if !wanted.bodies.is_empty() {
        shown.words = Some(format!("only {}", wanted.bodies.join(", ")));
    }
    Ok(shown)
}

/// Whether what touches is so small beside the bodies that it is looked at from near.
fn small(known: &Known) -> bool {
    let mut bounds = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
    for x in known.contacts.iter().flat_map(|c| c.bounds) {
        for c in 0..3 {
            bounds[0][c] = bounds[0][c].min(x[c]);
            bounds[1][c] = bounds[1][c].max(x[c]);
        }
    }
    let span = (0..3).map(|c| bounds[1][c] - bounds[0][c]);
    span.fold(0.0, f64::max) < 0.25 * known.stage.skin.size()
}

/// Draws bodies apart by the least distance, and from the side, that show what touches.
fn spread(known: &Known, wanted: &Picture, row: Option<&Row>, shown: &mut Shown) {
    let size = known.stage.skin.size();
    let along = row.map_or([0.0, 0.0, 1.0], |row| row.along);
    let distances: Vec<f64> = match wanted.apart {
        Apart::By(distance) => vec![distance],
        Apart::Auto => DISTANCES.map(|part| part * size).to_vec(),
    };
    let views = wanted.view.map_or_else(|| views(along), |view| vec![view]);
    let stage = Stage {
        bodies: &shown.bodies.clone(),
        ..known.stage
    };
    let offsets = |distance: f64| -> Vec<Vec3> {
        let places = (0..shown.bodies.len()).map(|b| row.map_or(0, |row| row.places[b]));
        let far = places.map(|place| place as f64 * distance);
        far.map(|far| along.map(|x| far * x)).collect()
    };
    let mut best = (-1.0, 0.0, shown.view);
    'found: for distance in distances {
        let offsets = offsets(distance);
        for &view in &views {
            let part = in_view(&stage, known.contacts, &Camera::new(view, 3), &offsets);
            if part > best.0 + 0.02 {
                best = (part, distance, view);
            }
            if part >= ENOUGH_IN_VIEW[0] {
                break 'found;
            }
        }
    }
    let (part, distance, view) = best;
    shown.offsets = offsets(distance);
    (shown.in_view, shown.view) = (Some(part), view);
    if let Some(row) = row.filter(|_| distance > 0.0) {
        let words = apart_words(distance, row, known, &shown.bodies);
        shown.notes.push(format!(
            "{words}; the picture shows {:.0} % of the faces in contact (--apart 0 leaves bodies where they are)",
            100.0 * part
        ));
        shown.words = Some(match shown.words.take() {
            Some(only) => format!("{only}, {words}"),
            None => words,
        });
    }
}

/// More bodies than this are not named in a caption.
const NAMED_BODIES: usize = 6;

/// By how much bodies are drawn apart, in which direction, and in which order they stand there.
fn apart_words(distance: f64, row: &Row, known: &Known, shown: &[bool]) -> String {
    let length = format!("{} {}", axis::number(distance, 3), known.length);
    let mut words = format!("bodies drawn apart by {}", length.trim_end());
    let axis = (0..3).find(|&c| row.along[c].abs() > 0.99);
    let drawn: Vec<usize> = (0..shown.len()).filter(|&b| shown[b]).collect();
    if let Some(axis) = axis.filter(|_| drawn.len() <= NAMED_BODIES) {
        let mut places: Vec<usize> = drawn.iter().map(|&b| row.places[b]).collect();
        places.sort_unstable();
        places.dedup();
        if row.along[axis] < 0.0 {
            places.reverse();
        }
        let at = |place: &usize| {
            let here = drawn.iter().filter(|&&b| row.places[b] == *place);
            let names: Vec<&str> = here.map(|&b| known.names[b].as_str()).collect();
            names.join(" and ")
        };
        let names: Vec<String> = places.iter().map(at).collect();
        words += &format!(" along {}: {}", ["x", "y", "z"][axis], names.join(", "));
    }
    words
}

/// Leaves one side of the contact, and looks at it.
fn one_side(known: &Known, wanted: &Picture, shown: &mut Shown) {
    let (skin, values) = (known.stage.skin, known.values);
    let count = skin.ends.len();
    let sums: Vec<Vec3> = (0..count).map(|body| outward(skin, values, body)).collect();
    let size = |v: Vec3| v.iter().map(|x| x * x).sum::<f64>().sqrt();
    let mut most = 0;
    for body in 1..count {
        // Sides of a contact are about equally large: the first of them, whatever the meshes.
        let better = size(sums[body]) > 1.05 * size(sums[most]);
        if (better || !shown.bodies[most]) && shown.bodies[body] {
            most = body;
        }
    }
    let mut normal = unit(sums[most]);
    if size(normal) == 0.0 {
        return;
    }
    if let Some(view) = wanted.view {
        normal = Camera::new(view, 3).out;
    }
    if wanted.bodies.is_empty() && count > 1 {
        let along = |body: usize| (0..3).map(|c| sums[body][c] * normal[c]).sum::<f64>();
        let looks: Vec<bool> = (0..count).map(|b| along(b) > 0.0).collect();
        if looks.contains(&true) {
            shown.bodies = looks;
        }
        let kept: Vec<&str> = (0..count)
            .filter(|&b| shown.bodies[b])
            .map(|b| known.names[b].as_str())
            .collect();
        shown.words = Some(format!("only {}", kept.join(", ")));
        shown.notes.push(format!(
            "the contact surface is hidden: showing body {} only, from the side of the contact (--bodies and --view choose otherwise)",
            kept.join(", ")
        ));
    }
    if wanted.view.is_none() {
        // Not straight on, so that the body has a shape.
        let aside = match normal[2].abs() > 0.7 {
            true => [0.45, -0.6, 0.0],
            false => [0.0, 0.0, 0.45],
        };
        shown.view = View::From([0, 1, 2].map(|c| normal[c] + 0.8 * aside[c]));
    }
    let stage = Stage {
        bodies: &shown.bodies,
        ..known.stage
    };
    let camera = Camera::new(shown.view, 3);
    shown.in_view = Some(in_view(&stage, known.contacts, &camera, &shown.offsets));
}

/// The sum of the areas, as vectors, of the faces of a body that carry values, weighted by their magnitude; without weights if all
/// are zero. Of a ball on a floor the side that touches counts.
fn outward(skin: &Skin, values: &[f64], body: usize) -> [f64; 3] {
    let (mut loaded, mut whole) = ([0.0; 3], [0.0; 3]);
    for t in skin.triangles_of(body) {
        let weight = t.iter().map(|i| values[*i as usize].abs()).sum::<f64>() / 3.0;
        if weight.is_nan() {
            continue;
        }
        let [a, b, c] = t.map(|i| skin.positions[i as usize]);
        let edge = |p: [f64; 3]| [0, 1, 2].map(|k| p[k] - a[k]);
        let area = cross(edge(b), edge(c));
        for k in 0..3 {
            whole[k] += area[k] / 2.0;
            loaded[k] += weight * area[k] / 2.0;
        }
    }
    if loaded == [0.0; 3] { whole } else { loaded }
}

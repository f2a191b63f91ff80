//! The bodies and their fields over time, packed for the 3D view.

use serde_json::{Value, json};
use stickslip::Error;
use stickslip::io::vtu::PointArray;

use super::modes;
use crate::field::{self, Field};
use crate::obstacle::{self, Outline};
use crate::pack;
use crate::results::{Results, fault};
use crate::shapes;
use crate::sheet::Sheet;
use crate::skin::Skin;

/// What the view needs: a description, and packed arrays by their keys.
#[derive(Debug, Clone, Default)]
pub struct Packed {
    /// The description; `null` where there is nothing to show.
    pub meta: Value,
    /// Key and text of each array.
    pub blobs: Vec<(String, String)>,
}

/// Packs the skin and the fields of as many times as fit into `limit` bytes.
pub fn pack(results: &Results, limit: u64, notes: &mut Vec<String>) -> Result<Packed, Error> {
    if results.frames.is_empty() {
        // What has modes and nothing else is shown by them.
        return match shapes::all(results)?.first() {
            Some(first) => {
                let name = format!("{}:{}", first.step, first.mode);
                pack(&shapes::at_phases(results, &name, 1)?, limit, notes)
            }
            None => Ok(Packed::default()),
        };
    }
    let grid = results.grid(0)?;
    let skin = Skin::of(&grid);
    if skin.triangles.is_empty() {
        notes.push("the fields have no cells that could be shown".into());
        return Ok(Packed::default());
    }
    let list = field::fields(&grid.points.arrays);
    let moves = grid
        .points
        .arrays
        .get("U")
        .is_some_and(|u| u.components == 3);
    let points = skin.points.len();
    let per_frame = 2 * points * (list.len() + if moves { 3 } else { 0 });
    let total = results.frames.len();
    let room = (limit / per_frame.max(1) as u64).max(1);
    let kept = pack::spread(total, usize::try_from(room).unwrap_or(usize::MAX));
    if kept.len() < total {
        notes.push(format!(
            "the 3D view has {} of the {total} times at which fields were written: all of them would need more than the limit of {} MB",
            kept.len(),
            limit >> 20
        ));
    }
    let mut columns = vec![Vec::with_capacity(points * kept.len()); list.len()];
    let mut motion: Vec<f32> = Vec::new();
    for &frame in &kept {
        let file = &results.frames[frame].file;
        let read = results.points(frame)?;
        if read.points.len() != grid.points.points.len() {
            return Err(fault(
                file,
                "it has another number of points than the first file of the run",
            ));
        }
        for (field, column) in list.iter().zip(&mut columns) {
            let array = array(&read.arrays, field, &grid.points.arrays);
            column.extend(skin.points.iter().map(|&p| match array {
                Some(array) => field.value(array, p) as f32,
                None => f32::NAN,
            }));
        }
        if moves {
            let u = read.arrays.get("U").filter(|u| u.components == 3);
            motion.extend(skin.points.iter().flat_map(|&p| match u {
                Some(u) => [0, 1, 2].map(|c| u.values[3 * p + c] as f32),
                None => [0.0; 3],
            }));
        }
    }
    let mut packed = describe(results, &skin, &kept, &list, &columns, &motion);
    // It opens where contact presses most, and moves no surface visibly to or from another.
    let peak = results.of_peak()?;
    let start = (0..kept.len()).min_by_key(|&i| kept[i].abs_diff(peak));
    packed.meta["start"] = json!(start);
    if let Some(at) = start {
        let contact = crate::plot::arrangement(results, kept[at])?;
        packed.meta["contact"] = json!(
            contact.map(|c| { json!({"bodies": c.bodies, "offsets": c.offsets, "view": c.view}) })
        );
    }
    let sheets = kept.iter().map(|&frame| results.sheets(frame));
    let sheets: Vec<Vec<Sheet>> = sheets.collect::<Result<_, Error>>()?;
    let largest = packed.meta["largest"].as_f64().unwrap_or(0.0);
    let factor = crate::plot::scale(skin.size(), largest, sheets.iter().flatten());
    packed.meta["scale"] = json!(factor);
    let shapes = modes::pack(results, &skin, limit / 4, notes)?;
    packed.meta["modes"] = json!(shapes.meta);
    packed.blobs.extend(shapes.blobs);
    Ok(packed)
}

/// The array of a field, if this file has it as the first one has.
fn array<'a>(
    arrays: &'a std::collections::BTreeMap<String, PointArray>,
    field: &Field,
    first: &std::collections::BTreeMap<String, PointArray>,
) -> Option<&'a PointArray> {
    let wanted = first[&field.array].components;
    arrays
        .get(&field.array)
        .filter(|array| array.components == wanted)
}

fn describe(
    results: &Results,
    skin: &Skin,
    kept: &[usize],
    list: &[Field],
    columns: &[Vec<f32>],
    motion: &[f32],
) -> Packed {
    let [low, high] = skin.bounds();
    // About the middle, so that single precision keeps the digits of bodies far from the origin.
    let middle = [0, 1, 2].map(|c| (low[c] + high[c]) / 2.0);
    let positions = skin
        .positions
        .iter()
        .flat_map(|x| [0, 1, 2].map(|c| x[c] - middle[c]));
    let mut blobs = vec![
        ("positions".to_string(), pack::singles(positions)),
        (
            "triangles".to_string(),
            pack::indices(skin.triangles.iter().flatten().copied()),
        ),
        (
            "edges".to_string(),
            pack::indices(skin.edges.iter().flatten().copied()),
        ),
        (
            "owner".to_string(),
            pack::indices(skin.owner.iter().copied()),
        ),
    ];
    let mut shown = Vec::new();
    for (i, (field, column)) in list.iter().zip(columns).enumerate() {
        let q = pack::quantise(column);
        if q.values.iter().all(|&v| v == pack::NO_NUMBER) {
            continue;
        }
        let (span, signed) = field::span_of(Some(field), q.range);
        shown.push(json!({
            "key": format!("f{i}"), "name": field.name, "label": field.label(), "range": q.range,
            "span": span, "signed": signed, "carried": field.carried(), "contact": field.of_contact(), "status": field.name == field::STATUS,
            "partial": q.values.contains(&pack::NO_NUMBER),
        }));
        blobs.push((format!("f{i}"), pack::shorts(&q.values)));
    }
    let moved = pack::quantise(motion);
    let largest = motion
        .as_chunks::<3>()
        .0
        .iter()
        .map(|u| u.iter().map(|v| f64::from(*v).powi(2)).sum::<f64>().sqrt())
        .fold(0.0, f64::max);
    if !motion.is_empty() {
        blobs.push(("motion".to_string(), pack::shorts(&moved.values)));
    }
    let times: Vec<f64> = kept.iter().map(|&i| results.frames[i].time).collect();
    let outlines = obstacle::outlines(&results.problem, skin);
    let moving = outlines.iter().any(Outline::moves);
    blobs.extend(obstacles(&outlines, middle, &times, moving));
    let colours = |list: &[crate::colour::Rgb]| json!(list);
    let statuses: Vec<Value> = crate::colour::STATUSES[..crate::colour::TIED]
        .iter()
        .map(|(name, colour)| json!({"name": name, "colour": colour}))
        .collect();
    let meta = json!({
        "dim": skin.dim,
        "points": skin.points.len(),
        "middle": middle,
        "size": skin.size(),
        "largest": largest,
        "motion": (!motion.is_empty()).then_some(moved.range),
        "times": times,
        "obstacles": {"any": !outlines.is_empty(), "move": moving},
        "bodies": results.bodies(skin.ends.len()),
        "ends": skin.ends,
        "fields": shown,
        "ordered": colours(crate::colour::ORDERED),
        "signed": colours(crate::colour::SIGNED),
        "carried": colours(crate::colour::CARRIED),
        "nothing": crate::colour::NOTHING,
        "statuses": statuses,
        "counts": times.iter().map(|t| results.statuses_at(*t)).collect::<Vec<_>>(),
    });
    Packed { meta, blobs }
}

/// Lines of the obstacles: points at the first time, what they move to, and the lines between them.
fn obstacles(
    outlines: &[Outline],
    middle: [f64; 3],
    times: &[f64],
    moving: bool,
) -> Vec<(String, String)> {
    if outlines.is_empty() {
        return Vec::new();
    }
    let all = |t: f64| outlines.iter().flat_map(move |o| o.at(t)).flatten();
    let start = 0.0;
    let relative = all(start).enumerate().map(|(i, x)| x - middle[i % 3]);
    let mut first = 0;
    let mut lines = Vec::new();
    for outline in outlines {
        lines.extend(outline.lines.iter().flatten().map(|i| i + first));
        first += outline.at(start).len() as u32;
    }
    let mut blobs = vec![
        ("obstacles".to_string(), pack::singles(relative)),
        (
            "obstacle-lines".to_string(),
            pack::indices(lines.into_iter()),
        ),
    ];
    if moving {
        let from: Vec<f64> = all(start).collect();
        let moved = times.iter().flat_map(|&t| {
            all(t)
                .zip(&from)
                .map(|(x, x0)| x - x0)
                .collect::<Vec<f64>>()
        });
        blobs.push(("obstacle-motion".to_string(), pack::singles(moved)));
    }
    blobs
}

//! Shapes of modes, packed for the 3D view: real and imaginary part, so that it can go through the phase.

use std::path::Path;

use serde_json::{Value, json};
use stickslip::Error;
use stickslip::io::{csv, vtu};
use stickslip::modal::grows;
use stickslip::number::figure;

use crate::pack;
use crate::phase::SHAPE_ARRAYS;
use crate::results::{Results, fault};
use crate::shapes::{self, Shape};
use crate::skin::Skin;

/// Tables of the modes of all steps, and how they depend on what a map varies.
///
/// # Errors
/// [`Error::Io`] if a table is damaged.
pub fn section(results: &Results) -> Result<String, Error> {
    let mut out = String::new();
    for step in 1..=results.steps() {
        let file = results.directory.join(format!("modes-{step}.csv"));
        if !file.is_file() {
            continue;
        }
        let table = csv::read(&file)?;
        let of = |name: &str| table.column(name).unwrap_or_default();
        let (frequencies, growths, ratios) = (of("frequency"), of("growth"), of("damping-ratio"));
        let rows: String = (0..table.rows())
            .map(|k| {
                let at = |values: &[f64]| values.get(k).map_or("–".into(), |v| figure(*v));
                let ratio = ratios.get(k).copied().unwrap_or(0.0);
                let verdict = match grows(ratio) {
                    true => "<strong>unstable</strong>",
                    false if grows(-ratio) => "stable",
                    false => "undamped",
                };
                format!(
                    "<tr><th scope=\"row\">{}</th><td>{}</td><td>{verdict}</td><td>{}</td><td>{}</td></tr>\n",
                    k + 1,
                    at(frequencies),
                    at(growths),
                    at(ratios),
                )
            })
            .collect();
        out += &format!(
            "<h3>Step {step}</h3>\n<div class=\"wide\"><table class=\"figures\"><thead><tr><th scope=\"col\">mode</th><th scope=\"col\">frequency</th>\
             <th scope=\"col\">verdict</th><th scope=\"col\">growth</th><th scope=\"col\">damping ratio</th></tr></thead>\n<tbody>\n{rows}</tbody></table></div>\n"
        );
        for svg in crate::plot::couplings(results, step)? {
            out += &format!("<figure class=\"along\">{svg}</figure>\n");
        }
    }
    Ok(out)
}

/// What the view needs of shapes: their descriptions, and packed arrays by their keys.
#[derive(Debug, Clone, Default)]
pub struct Shapes {
    pub meta: Vec<Value>,
    pub blobs: Vec<(String, String)>,
}

/// Packs as many shapes as fit into `limit` bytes, those that grow fastest first.
///
/// # Errors
/// [`Error::Io`] if a file that is listed is missing or damaged.
pub fn pack(
    results: &Results,
    skin: &Skin,
    limit: u64,
    notes: &mut Vec<String>,
) -> Result<Shapes, Error> {
    let shapes = shapes::all(results)?;
    let room = usize::try_from(limit / (12 * skin.points.len().max(1)) as u64);
    let kept = fastest(&shapes, room.unwrap_or(usize::MAX).max(1));
    if kept.len() < shapes.len() {
        notes.push(format!(
            "the 3D view has {} of {} shapes of modes, those that grow fastest: all of them would need more than the limit",
            kept.len(),
            shapes.len()
        ));
    }
    let mut out = Shapes::default();
    for (k, shape) in kept.into_iter().map(|k| &shapes[k]).enumerate() {
        let file = results.directory.join(&shape.file);
        let (parts, values) = packed(&file, skin)?;
        let quantised = pack::quantise(&values);
        let key = format!("mode{k}");
        out.meta.push(json!({
            "key": key, "label": shape.label, "parts": parts, "range": quantised.range,
        }));
        out.blobs.push((key, pack::shorts(&quantised.values)));
    }
    Ok(out)
}

/// Which shapes there is room for, in their order.
fn fastest(shapes: &[Shape], room: usize) -> Vec<usize> {
    let mut order: Vec<usize> = (0..shapes.len()).collect();
    order.sort_by(|&a, &b| shapes[b].growth.total_cmp(&shapes[a].growth));
    order.truncate(room);
    order.sort_unstable();
    order
}

/// How many parts a shape has, and its displacements at the points of the skin, part by part, the largest of them one.
fn packed(file: &Path, skin: &Skin) -> Result<(usize, Vec<f32>), Error> {
    let read = vtu::read(file)?;
    let parts: Vec<&[f64]> = SHAPE_ARRAYS
        .iter()
        .filter_map(|name| read.arrays.get(*name))
        .filter(|array| array.components == 3)
        .map(|array| array.values.as_slice())
        .collect();
    let fits = |part: &&[f64]| skin.points.iter().all(|&p| 3 * p + 2 < part.len());
    if parts.is_empty() || !parts.iter().all(fits) {
        return Err(fault(file, "it has no shape of a mode of this mesh"));
    }
    let at = |p: usize| parts.iter().flat_map(move |part| &part[3 * p..3 * p + 3]);
    let sizes = skin
        .points
        .iter()
        .map(|&p| at(p).map(|v| v * v).sum::<f64>());
    let largest = sizes.fold(0.0, f64::max).sqrt().max(f64::MIN_POSITIVE);
    let values = parts.iter().flat_map(|part| {
        let points = skin.points.iter();
        points.flat_map(move |&p| [0, 1, 2].map(|c| (part[3 * p + c] / largest) as f32))
    });
    Ok((parts.len(), values.collect()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_grows_fastest_is_kept_in_its_order() {
        let shape = |growth: f64| Shape {
            step: 1,
            mode: 1,
            label: String::new(),
            growth,
            unstable: growth > 0.0,
            file: String::new(),
        };
        let shapes = [1.0, -2.0, 5.0, 3.0].map(shape);
        assert_eq!(fastest(&shapes, 2), [2, 3]);
        assert_eq!(fastest(&shapes, 3), [0, 2, 3]);
        assert_eq!(fastest(&shapes, 9), [0, 1, 2, 3]);
    }
}

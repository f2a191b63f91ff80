//! Shapes of modes, packed for the 3D view: real and imaginary part, so that it can go through the phase.

use std::path::Path;

use serde_json::{Value, json};
use stickslip::Error;
use stickslip::io::{csv, pvd, vtu};

use crate::pack;
use crate::results::{Results, fault};
use crate::skin::Skin;

/// The arrays of a shape.
const PARTS: [&str; 2] = ["PHI", "PHI_IMAGINARY"];

/// A shape that may be shown.
struct Shape {
    label: String,
    growth: f64,
    file: String,
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
    let mut shapes = Vec::new();
    for step in 1..=results.steps() {
        shapes.extend(listed(&results.directory, step)?);
    }
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

/// The shapes that a step has written.
fn listed(directory: &Path, step: usize) -> Result<Vec<Shape>, Error> {
    let list = directory.join(format!("modes-{step}.pvd"));
    if !list.is_file() {
        return Ok(Vec::new());
    }
    let table = directory.join(format!("modes-{step}.csv"));
    let table = table.is_file().then(|| csv::read(&table)).transpose()?;
    let column = |name: &str, k: usize| {
        let values = table.as_ref().and_then(|t| t.column(name));
        values.and_then(|v| v.get(k).copied())
    };
    let all = pvd::read(&list)?.into_iter().enumerate();
    let shapes = all.map(|(k, (at, file))| {
        let growth = column("growth", k).unwrap_or(0.0);
        let label = match column("frequency", k) {
            Some(f) if growth == 0.0 => format!("step {step}, mode {}: {f:.6}", k + 1),
            Some(f) => format!("step {step}, mode {}: {f:.6}, growth {growth:.4}", k + 1),
            // Answers to harmonic loads are listed by their frequency.
            None => format!("step {step}, answer at {at}"),
        };
        Shape {
            label,
            growth,
            file,
        }
    });
    Ok(shapes.collect())
}

/// How many parts a shape has, and its displacements at the points of the skin, part by part, the largest of them one.
fn packed(file: &Path, skin: &Skin) -> Result<(usize, Vec<f32>), Error> {
    let read = vtu::read(file)?;
    let parts: Vec<&[f64]> = PARTS
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
            label: String::new(),
            growth,
            file: String::new(),
        };
        let shapes = [1.0, -2.0, 5.0, 3.0].map(shape);
        assert_eq!(fastest(&shapes, 2), [2, 3]);
        assert_eq!(fastest(&shapes, 3), [0, 2, 3]);
        assert_eq!(fastest(&shapes, 9), [0, 1, 2, 3]);
    }
}

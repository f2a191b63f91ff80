//! Which bodies are drawn, and from where, so that the field can be seen.

use stickslip::problem::nearest;

use super::camera::{View, cross, unit};
use super::picture::Picture;
use crate::skin::Skin;

/// What is drawn.
#[derive(Debug, Clone, PartialEq)]
pub struct Shown {
    /// Whether each body is.
    pub bodies: Vec<bool>,
    /// From where.
    pub view: View,
    /// For the caption, if it is not everything.
    pub words: Option<String>,
    /// What was chosen for the reader.
    pub notes: Vec<String>,
}

/// Chooses bodies and view. A field that only surfaces of contact carry is hidden between the bodies in 3D: then one side of the
/// contact is shown alone, from where it looks, unless bodies or view are given.
pub fn choose(
    skin: &Skin,
    names: &[String],
    wanted: &Picture,
    values: &[f64],
) -> Result<Shown, String> {
    let count = skin.ends.len();
    let mut shown = Shown {
        bodies: vec![wanted.bodies.is_empty(); count],
        view: wanted.view.unwrap_or(View::Iso),
        words: None,
        notes: Vec::new(),
    };
    for name in &wanted.bodies {
        match names.iter().take(count).position(|n| n == name) {
            Some(i) => shown.bodies[i] = true,
            None => {
                let known: Vec<&str> = names.iter().take(count).map(String::as_str).collect();
                let meant = nearest(name, &known).map(|meant| format!("did you mean `{meant}`? "));
                let (meant, known) = (meant.unwrap_or_default(), known.join(", "));
                return Err(format!(
                    "there is no body `{name}`; {meant}there are {known}"
                ));
            }
        }
    }
    if !wanted.bodies.is_empty() {
        shown.words = Some(format!("only {}", wanted.bodies.join(", ")));
    }
    let partial = values.iter().any(|v| v.is_nan()) && values.iter().any(|v| !v.is_nan());
    if skin.dim != 3 || !partial || wanted.view.is_some() {
        return Ok(shown);
    }
    let sums: Vec<[f64; 3]> = (0..count).map(|body| outward(skin, values, body)).collect();
    let size = |v: [f64; 3]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
    let mut most = 0;
    for body in 1..count {
        // Sides of a contact are about equally large: the first of them, whatever the meshes.
        let better = size(sums[body]) > 1.05 * size(sums[most]);
        if (better || !shown.bodies[most]) && shown.bodies[body] {
            most = body;
        }
    }
    let normal = unit(sums[most]);
    if size(normal) == 0.0 {
        return Ok(shown);
    }
    if wanted.bodies.is_empty() && count > 1 {
        let along = |body: usize| (0..3).map(|c| sums[body][c] * normal[c]).sum::<f64>();
        shown.bodies = (0..count).map(|b| b == most || along(b) > 0.0).collect();
        let kept: Vec<&str> = (0..count)
            .filter(|&b| shown.bodies[b])
            .map(|b| names[b].as_str())
            .collect();
        shown.words = Some(format!("only {}", kept.join(", ")));
        shown.notes.push(format!(
            "the field is hidden between the bodies: only {} is shown, from the side of the contact (--body and --view choose otherwise)",
            kept.join(", ")
        ));
    }
    // Not straight on, so that the body has a shape.
    let aside = match normal[2].abs() > 0.7 {
        true => [0.45, -0.6, 0.0],
        false => [0.0, 0.0, 0.45],
    };
    shown.view = View::From([0, 1, 2].map(|c| normal[c] + 0.8 * aside[c]));
    Ok(shown)
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

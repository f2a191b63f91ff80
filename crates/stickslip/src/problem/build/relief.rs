//! Heights of rough surfaces at the points of interfaces.

use std::path::Path;

use super::super::{Problem, Roughness};
use super::fault::problem_error;
use crate::contact::interface::InterfaceDefinition;
use crate::error::{Diagnostic, Error};
use crate::math::{Vec3, add, add_scaled, cross, dot, normalize, sub};
use crate::number::{digits, figure};
use crate::roughness::Figures;

/// Gives interfaces the heights that the problem says they have; what there is to say of them.
///
/// # Errors
/// Those of files; [`Error::Problem`] if there is no height at a point.
pub(super) fn apply(
    problem: &Problem,
    folder: &Path,
    interfaces: &mut [InterfaceDefinition],
) -> Result<Vec<String>, Error> {
    let mut notes = Vec::new();
    for interface in interfaces {
        let table = problem.interface.get(&interface.name);
        let Some(roughness) = table.and_then(|t| t.roughness.as_ref()) else {
            continue;
        };
        let profile = interface.dofs.dim == 2;
        let relief = roughness.kind.as_dyn().heights(folder, profile)?;
        let places = places(roughness, interface);
        let found: Vec<Option<f64>> = places.iter().map(|&p| relief.heights.at(p)).collect();
        let beyond = found.iter().filter(|h| h.is_none()).count();
        if beyond > 0 {
            let key = format!("interface.{}.roughness", interface.name);
            let count = found.len();
            let message = format!(
                "{beyond} of {count} points of the surface lie beyond the edges of the map"
            );
            let help = "add `repeat = true`, move its `origin`, or make the surface smaller";
            return Err(problem_error(vec![
                Diagnostic::new(key, message).help(help),
            ]));
        }
        interface.mesh_mut().relief = found.into_iter().flatten().collect();
        notes.push(note(interface));
        if let Some(measured) = &relief.measured {
            notes.push(figures(&interface.name, measured));
        }
    }
    Ok(notes)
}

/// Interfaces whose roughness is a sum of waves, and the shortest of these `[length]`.
pub(super) fn waves(problem: &Problem) -> Vec<(String, f64)> {
    let rough = problem.interface.iter();
    let shortest = rough.filter_map(|(name, table)| {
        let shortest = table.roughness.as_ref()?.kind.as_dyn().shortest()?;
        Some((name.clone(), shortest))
    });
    shortest.collect()
}

/// What is known of a measured surface, in the words of who measures and of the law that takes it as a statistic.
fn figures(name: &str, map: &Figures) -> String {
    let s = &map.statistics;
    let [density, radius, bandwidth] = s.summits().unwrap_or_default();
    let holes = match map.holes {
        0 => String::new(),
        n => format!("; {n} points had not been measured"),
    };
    format!(
        "interface {name}: the map of {} by {} points has Sq {}, Sa {}, skewness {:.2}, kurtosis {:.2}, Sdq {}, {density} summits of radius {radius} an area, bandwidth {bandwidth:.3}; as a statistic it is normal.micro-contact with sigma = {}, slope = {}{holes}",
        map.columns,
        map.rows,
        figure(s.rq),
        figure(s.ra),
        s.skewness,
        s.kurtosis,
        figure(s.slope),
        digits(s.rq, 5),
        digits(s.mean_slope, 5),
        density = figure(density),
        radius = figure(radius)
    )
}

fn note(interface: &InterfaceDefinition) -> String {
    let heights = &interface.relief;
    let n = heights.len() as f64;
    let mean = heights.iter().sum::<f64>() / n;
    let square = heights.iter().map(|h| (h - mean).powi(2)).sum::<f64>() / n;
    let [low, high] = [f64::min, f64::max].map(|f| heights.iter().copied().fold(heights[0], f));
    format!(
        "interface {}: heights at {n} points from {low} to {high}, root mean square {} about their mean of {mean}",
        interface.name,
        figure(square.sqrt()),
        low = figure(low),
        high = figure(high),
        mean = figure(mean)
    )
}

/// Coordinates of all points along the axes of the surface.
fn places(roughness: &Roughness, interface: &InterfaceDefinition) -> Vec<[f64; 2]> {
    let points = &interface.points;
    let sum = points
        .iter()
        .fold([0.0; 3], |s, p| add_scaled(s, p.area, p.normal));
    let normal = normalize(sum).unwrap_or([0.0, 0.0, 1.0]);
    let axes = axes(roughness, normal, interface.dofs.dim);
    let positions: Vec<Vec3> = points
        .iter()
        .map(|p| add(p.place(&interface.reference), interface.origin))
        .collect();
    let along = |x: Vec3| axes.map(|e| dot(x, e));
    let least = positions.iter().fold([f64::INFINITY; 2], |least, &x| {
        let here = along(x);
        [least[0].min(here[0]), least[1].min(here[1])]
    });
    let origin = roughness
        .origin
        .as_deref()
        .map_or(least, |o| along(padded(o)));
    let places = positions.into_iter().map(along);
    places
        .map(|p| [p[0] - origin[0], p[1] - origin[1]])
        .collect()
}

/// Both axes of a surface with this normal; in the plane the second one is zero.
fn axes(roughness: &Roughness, normal: Vec3, dim: usize) -> [Vec3; 2] {
    let wished = roughness.along.as_deref().map(padded);
    // From this cosine of the angle between an axis and the normal on, the axis is none of the surface.
    let first = wished.unwrap_or(match normal[0].abs() > 0.9 {
        true => [0.0, 1.0, 0.0],
        false => [1.0, 0.0, 0.0],
    });
    let along = sub(first, normal.map(|n| n * dot(first, normal)));
    let along = normalize(along).unwrap_or(first);
    match dim {
        2 => [along, [0.0; 3]],
        _ => [along, cross(normal, along)],
    }
}

fn padded(v: &[f64]) -> Vec3 {
    std::array::from_fn(|i| v.get(i).copied().unwrap_or(0.0))
}

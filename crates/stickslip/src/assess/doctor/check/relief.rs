//! Heights of rough surfaces that contact points cannot show, or that are as steep as no surface that first order holds for.

use super::super::finding::{DoctorCause, Finding};
use super::super::suspect::Suspect;
use super::common::median;
use super::strains::LARGE_STRAIN;
use crate::contact::interface::InterfaceDefinition;
use crate::contact::surface::spacing;
use crate::math::distance;
use crate::model::definition::Model;
use crate::number::{digits, figure};

pub(super) fn check(model: &Model, interface: &InterfaceDefinition) -> Option<Finding> {
    if interface.relief.is_empty() {
        return None;
    }
    aliased(model, interface).or_else(|| steep(interface))
}

/// Waves that are shorter than two distances of points.
fn aliased(model: &Model, interface: &InterfaceDefinition) -> Option<Finding> {
    let waves = model.waves.iter().find(|w| w.0 == interface.name)?;
    let facets = interface
        .skin
        .iter()
        .map(|s| spacing(&s.facet, &interface.reference));
    let apart = median(facets.collect());
    let (name, shortest) = (&interface.name, waves.1);
    // A wave needs two points at the least to be told from a longer one (Nyquist).
    (shortest < 2.0 * apart).then(|| {
        DoctorCause::UnresolvedRoughness.warning(format!(
            "interface {name}: the shortest wavelength of its roughness is {shortest} and its contact points are {apart} apart: the mesh does not resolve the roughness",
            shortest = figure(shortest),
            apart = figure(apart),
        ))
        .blame(Suspect::key(format!("interface.{name}.roughness"), format!("waves of {}", figure(shortest))))
        .blame(Suspect::interface(name, format!("points {} apart", figure(apart))))
        .advise(format!(
            "refine the secondary until a wave has several points, {} apart and less, or leave short waves out",
            digits(0.25 * shortest, 2),
        ))
        .advise("refine the mesh, or represent short wavelengths by a contact law: `normal.micro-contact`")
    })
}

/// Heights between neighbouring points that are a good part of their distance. A cosine of amplitude `a` and length `λ` is pressed flat by the pressure `π E* a / λ`
/// ([Westergaard 1939](crate::references::westergaard_1939)), a strain of half its steepest slope, which is `√2` times the root mean square.
fn steep(interface: &InterfaceDefinition) -> Option<Finding> {
    let mut height = vec![None; interface.nodes.len()];
    for (point, h) in interface.points.iter().zip(&interface.relief) {
        if let Some(node) = point.node() {
            height[node] = Some(*h);
        }
    }
    let (mut squares, mut lengths) = (0.0, 0.0);
    for facet in interface.skin.iter().map(|s| &s.facet) {
        let nodes = facet.nodes.iter();
        let known: Vec<usize> = nodes.copied().filter(|&n| height[n].is_some()).collect();
        for pair in known.windows(2) {
            let length = distance(interface.reference[pair[0]], interface.reference[pair[1]]);
            let [a, b] = [height[pair[0]]?, height[pair[1]]?];
            squares += (b - a).powi(2) / length.max(f64::MIN_POSITIVE);
            lengths += length;
        }
    }
    let slope = (squares / lengths).sqrt();
    let strain = slope * std::f64::consts::FRAC_1_SQRT_2;
    let name = &interface.name;
    (strain > LARGE_STRAIN && strain.is_finite()).then(|| {
        DoctorCause::LargeStrain.warning(format!(
            "interface {name}: its roughness has a slope of {slope:.2} in the root mean square between points: to press it flat takes strains of about {strain:.2}, and heights change gaps to first order"
        ))
        .blame(Suspect::key(format!("interface.{name}.roughness"), format!("slope {slope:.2}")))
        .blame(Suspect::interface(name, ""))
        .advise("check the unit of the heights: roughness is micrometres, in a model in metres 1e-6")
        .advise("a shape that is as steep as that belongs into the mesh")
    })
}

//! Gaps that cannot close, overlaps that are too deep.

use super::super::finding::{DoctorCause, Finding};
use super::super::places::secondary;
use super::super::suspect::Suspect;
use super::common::{forced_by_loads, travel};
use super::driven::flight;
use super::measured::Measured;
use crate::assess::view::View;
use crate::contact::interface::{InterfaceDefinition, Primary, Start};
use crate::contact::surface::{Facet, turns};
use crate::number::{digits, figure};
use crate::tolerance::SAME;

/// Overlap relative to the cell beneath that is a mistake: it strains cells by half. Tests of planted defects pass with 0.15 and
/// 0.95. It decides what is said, and no result.
const DEEP_OVERLAP: f64 = 0.5;
/// Overlap or gap relative to the cell beneath that is worth a word: a strain of one in a hundred is beyond the yield of metals. It decides what is said, and no result.
const SHALLOW_OVERLAP: f64 = 0.01;

pub(super) fn check(
    view: &View,
    interface: &InterfaceDefinition,
    measured: &Measured,
) -> Vec<Finding> {
    let finite = measured.gaps.iter().enumerate();
    let mut gaps: Vec<(usize, f64)> = finite
        .filter(|(_, g)| g.is_finite())
        .map(|(i, &g)| (i, g))
        .collect();
    gaps.sort_by(|a, b| a.1.total_cmp(&b.1));
    let Some(&(first, smallest)) = gaps.first() else {
        return vec![nothing_opposite(interface, measured)];
    };
    let model = view.model;
    let mut out = Vec::new();
    let size = interface.points[first].size;
    // What is to be done with overlaps has been said where `initial` says it.
    let meant = interface.initial.start != Start::AsMeshed;
    if smallest < -SHALLOW_OVERLAP * size && !(meant && smallest > -DEEP_OVERLAP * size) {
        let overlapping = gaps.iter().filter(|(_, g)| *g < 0.0).count();
        let finding = DoctorCause::InitialOverlap.warning(format!(
            "interface {}: {overlapping} points overlap at the start, by up to {}, {:.2} of the cell there",
            interface.name,
            figure(-smallest),
            -smallest / size
        ))
        .note_unless(smallest < -DEEP_OVERLAP * size);
        let deep = gaps
            .iter()
            .take_while(|(_, g)| *g < -SHALLOW_OVERLAP * size);
        let finding = finding.blame_all(
            deep.map(|&(i, gap)| secondary(interface, i, format!("gap {}", figure(gap)))),
        );
        out.push(match interface.initial.start {
            Start::Ramp => finding
                .advise("the fit is deeper than half a cell: take finer increments, or check the sizes of the bodies"),
            Start::Offset | Start::Snap => finding
                .advise("check the positions and sizes of the bodies: the gap that is removed is as large as the cells"),
            Start::AsMeshed => finding
                .advise("move a body by the overlap (`body.NAME.translate`) or mend the mesh")
                .advise("if the overlap is an interference fit, resolve it over the first step (`initial = \"ramp\"`)"),
        });
    }
    out.extend(faceted(interface, &gaps));
    let reach = travel(view) + flight(model);
    // The bodies may amplify prescribed motion by a factor of ten on its way to an interface.
    if smallest > 10.0 * reach && smallest > SHALLOW_OVERLAP * size && !forced_by_loads(view) {
        out.push(
            DoctorCause::InitialGap.warning(format!(
                "interface {} cannot close: its smallest gap is {smallest}, and supports and velocities move the bodies by {reach} at most",
                interface.name,
                smallest = figure(smallest),
                reach = figure(reach),
            ))
            .blame(secondary(interface, first, format!("gap {}", figure(smallest))))
            .blame(Suspect::interface(&interface.name, "stays open"))
            .advise("move a body by the gap (`body.NAME.translate`), or check the units of its mesh"),
        );
    }
    out
}

/// How far straight facets stand off the smooth surface that they stand for, on average `[m]`: an eighth of their length times the angle between
/// them. Quadratic ones follow it.
fn standing_off(facets: &[&Facet], interface: &InterfaceDefinition) -> f64 {
    let straight: Vec<&Facet> = facets
        .iter()
        .copied()
        .filter(|f| f.kind.order() == 1)
        .collect();
    let turns = turns(&straight, &interface.reference);
    let count = turns.len().max(1) as f64;
    let depths = turns.iter().map(|[angle, length]| angle * length / 8.0);
    depths.sum::<f64>() / count
}

/// An overlap that is not much deeper than the facets of a curved surface are off it: the meshes have another fit than the bodies.
fn faceted(interface: &InterfaceDefinition, gaps: &[(usize, f64)]) -> Option<Finding> {
    let overlaps: Vec<f64> = gaps.iter().map(|g| -g.1).take_while(|&g| g > 0.0).collect();
    let typical = overlaps[..].get(overlaps.len() / 2).copied()?;
    let ours: Vec<&Facet> = interface.skin.iter().map(|s| &s.facet).collect();
    let theirs: Vec<&Facet> = match &interface.primary {
        Primary::Facets(facets) => facets.iter().collect(),
        Primary::Rigid(..) => Vec::new(),
    };
    let off = standing_off(&ours, interface) + standing_off(&theirs, interface);
    let size = interface.points[gaps[0].0].size;
    // Surfaces that only touch overlap by rounding.
    // Facets may stand off by a tenth of the overlap.
    if off <= 0.1 * typical || typical <= SAME * size || 2 * overlaps.len() < gaps.len() {
        return None;
    }
    let name = &interface.name;
    let part = 100.0 * off / typical;
    Some(
        DoctorCause::CoarseFacets.warning(format!(
            "interface {name}: straight facets stand off the curved surfaces by {off}, {part:.0} % of the overlap at the start ({typical}): the pressure of the fit is uncertain by more than that",
            off = digits(off, 3),
            typical = digits(typical, 3),
        ))
        .blame(Suspect::interface(name, format!("overlap {typical}, facets off by {off}", typical = digits(typical, 3), off = digits(off, 3))))
        .advise("refine both surfaces, or use quadratic cells, until the facets are off by a twentieth of the overlap")
        .advise("divide both surfaces alike: then the facets are off by the same"),
    )
}

fn nothing_opposite(interface: &InterfaceDefinition, measured: &Measured) -> Finding {
    let points = measured.nearest.iter().enumerate();
    let near = points.filter_map(|(i, n)| Some((i, n.as_ref()?.distance)));
    let near = near.min_by(|a, b| a.1.total_cmp(&b.1));
    let mut finding = DoctorCause::NothingOpposite
        .warning(format!(
            "interface {}: no point of the secondary has anything opposite",
            interface.name
        ))
        .blame(Suspect::interface(
            &interface.name,
            "the surfaces lie beside each other",
        ));
    if let Some((i, distance)) = near {
        let remark = format!(
            "the nearest facet is {distance} away, to the side",
            distance = figure(distance)
        );
        finding = finding.blame(secondary(interface, i, remark));
    }
    finding
        .advise("check the positions of the bodies and which surfaces the interface names; `stickslip check` lists the boxes of bodies")
}

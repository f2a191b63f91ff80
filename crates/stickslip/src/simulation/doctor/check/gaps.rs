//! Gaps that cannot close, overlaps that are too deep.

use super::super::finding::{DoctorCause, Finding, Guilty, Severity};
use super::driven::flight;
use super::{Measured, forced_by_loads, secondary, travel};
use crate::contact::interface::Interface;
use crate::contact::interface::Start;
use crate::simulation::run::Simulation;

/// Overlap relative to the cell beneath that is a mistake, and that is worth a word.
const DEEP: f64 = 0.5;
const SHALLOW: f64 = 0.01;

/// By how much prescribed motion may be amplified by the bodies on its way to an interface.
const LEVER: f64 = 10.0;

pub(super) fn check(
    simulation: &Simulation,
    interface: &Interface,
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
    let model = &simulation.model;
    let mut out = Vec::new();
    let size = interface.points[first].size;
    // What is to be done with overlaps has been said where `initial` says it.
    let meant = interface.initial.start != Start::AsMeshed;
    if smallest < -SHALLOW * size && !(meant && smallest > -DEEP * size) {
        let severity = match smallest < -DEEP * size {
            true => Severity::Warning,
            false => Severity::Note,
        };
        let overlapping = gaps.iter().filter(|(_, g)| *g < 0.0).count();
        let mut finding = Finding::new(
            DoctorCause::InitialOverlap,
            severity,
            format!(
                "interface {}: {overlapping} points overlap at the start, by up to {:.3e}, {:.2} of the cell there",
                interface.name,
                -smallest,
                -smallest / size
            ),
        );
        for &(i, gap) in gaps.iter().take_while(|(_, g)| *g < -SHALLOW * size) {
            finding = finding.blame(secondary(interface, i, format!("gap {gap:.3e}")));
        }
        out.push(match interface.initial.start {
            Start::Ramp => finding
                .advise("the fit is deeper than half a cell: take finer increments, or check the sizes of the bodies"),
            Start::Offset | Start::Snap => finding
                .advise("check the positions and sizes of the bodies: what is taken away is of the size of cells"),
            Start::AsMeshed => finding
                .advise("move a body by the overlap (`body.NAME.translate`) or mend the mesh")
                .advise("if the overlap is an interference fit, resolve it over the first step (`initial = \"ramp\"`)"),
        });
    }
    let reach = travel(model) + flight(model);
    if smallest > LEVER * reach && smallest > SHALLOW * size && !forced_by_loads(model) {
        out.push(
            Finding::new(
                DoctorCause::InitialGap,
                Severity::Warning,
                format!(
                    "interface {} cannot close: its smallest gap is {smallest:.3e}, and what is prescribed, supports and velocities, moves {reach:.3e} at most",
                    interface.name
                ),
            )
            .blame(secondary(interface, first, format!("gap {smallest:.3e}")))
            .blame(Guilty::interface(&interface.name, "stays open"))
            .advise("move a body by the gap (`body.NAME.translate`), or check the units of its mesh"),
        );
    }
    out
}

fn nothing_opposite(interface: &Interface, measured: &Measured) -> Finding {
    let points = measured.nearest.iter().enumerate();
    let near = points.filter_map(|(i, n)| Some((i, n.as_ref()?.distance)));
    let near = near.min_by(|a, b| a.1.total_cmp(&b.1));
    let mut finding = Finding::new(
        DoctorCause::NothingOpposite,
        Severity::Warning,
        format!(
            "interface {}: no point of the secondary has anything opposite",
            interface.name
        ),
    )
    .blame(Guilty::interface(&interface.name, "cannot close from here"));
    if let Some((i, distance)) = near {
        let remark = format!("the nearest facet is {distance:.3e} away, to the side");
        finding = finding.blame(secondary(interface, i, remark));
    }
    finding
        .advise("check the positions of the bodies and which surfaces the interface names; `stickslip check` lists the boxes of bodies")
}

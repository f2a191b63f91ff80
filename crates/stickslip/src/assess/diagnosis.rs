//! What can be said of a model before it runs, and of an unconstrained body.

use std::fmt;

use super::doctor::{Finding, singular_help};
use super::view::View;
use crate::contact::interface::{Conditions, InterfaceDefinition, gaps_at};
use crate::error::RunError;
use crate::math::add;
use crate::model::contact::Contact;
use crate::model::definition::Model;
use crate::model::frame::Frame;
use crate::model::rigid::free_bodies;
use crate::number::digits;
use crate::system::{Stage, State, StepFailure};

/// A rigid-body mode that neither supports nor springs hold.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub struct FreeMode {
    /// The body.
    pub body: String,
    /// What the motion is: `translation x`, or a mixture.
    pub motion: String,
}

/// What `stickslip check` says.
#[derive(Debug, Clone, Default, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub struct CheckReport {
    /// The bodies.
    pub bodies: Vec<BodyReport>,
    /// The interfaces.
    pub interfaces: Vec<InterfaceReport>,
    /// Motions that only contact can hold, at the start.
    pub free: Vec<FreeMode>,
    /// Steps, in words.
    pub steps: Vec<String>,
    /// What the doctor found, worst first.
    pub findings: Vec<Finding>,
}

/// A body in numbers.
#[derive(Debug, Clone, Default, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub struct BodyReport {
    /// Name.
    pub name: String,
    /// Points.
    pub points: usize,
    /// Cells.
    pub cells: usize,
    /// Kinds of cells.
    pub kinds: String,
    /// Mass if it is rigid.
    pub rigid: Option<f64>,
    /// Corners of its box.
    pub low: [f64; 3],
    /// Corners of its box.
    pub high: [f64; 3],
    /// Its sets.
    pub sets: Vec<String>,
}

/// An interface in numbers.
#[derive(Debug, Clone, Default, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub struct InterfaceReport {
    /// Name.
    pub name: String,
    /// Points of the secondary.
    pub points: usize,
    /// Area of the secondary.
    pub area: f64,
    /// Points with something opposite.
    pub paired: usize,
    /// Smallest gap `[m]`; infinite without a paired point.
    pub smallest: f64,
    /// The middle one of the gaps of paired points `[m]`.
    pub median: f64,
    /// Largest gap of paired points `[m]`.
    pub largest: f64,
    /// User's number of the node with the smallest gap, where the point is one.
    pub nearest_node: Option<u64>,
    /// Its reference coordinates `[m]`.
    pub nearest_at: Option<[f64; 3]>,
    /// Points that overlap at the start.
    pub overlapping: usize,
    /// Its laws in words.
    pub laws: String,
}

/// Motions of each body that the supports and springs acting at `t` do not hold.
pub fn free_modes(view: &View, t: f64) -> Vec<FreeMode> {
    let bodies = free_bodies::free_bodies(view, t).into_iter();
    let modes = bodies.flat_map(|free| {
        let body = free.name(view.model);
        let modes = free.motions.into_iter();
        modes.map(move |(motion, _)| FreeMode {
            body: body.clone(),
            motion,
        })
    });
    modes.collect()
}

/// The error for a singular system in which every body is held: something inside a body is not.
pub(crate) fn explain_singular(view: &View, failure: &StepFailure) -> RunError {
    let model = view.model;
    // A hidden point has no number.
    let meshed = |dof: &usize| model.dofs.locate(*dof).0 < model.mesh.points.len();
    let place = failure.dof.filter(meshed).map(|dof| {
        let (point, component) = model.dofs.locate(dof);
        let body = model.bodies.iter().find(|b| b.points.contains(&point));
        format!(
            "found at node {} of body {}, direction {}",
            model.mesh.point_ids[point],
            body.map_or("?", |b| b.name.as_str()),
            ["x", "y", "z"][component]
        )
    });
    RunError {
        message: "the system is singular although supports hold every body".to_string(),
        time: view.frame.state.t,
        culprits: place.into_iter().collect(),
        help: Some(singular_help(model, failure.dof)),
    }
}

/// Gaps at the start, by interface.
pub(crate) fn start_gaps(
    model: &Model,
    frame: &Frame,
    contact: &mut Contact,
    conditions: &[Conditions],
) -> Vec<Vec<f64>> {
    let end = soon(model, &frame.state);
    let stage = beginning(&frame.state, &end);
    let mut forces = contact.forces(&frame.contacts, conditions).interfaces;
    forces.iter_mut().map(|i| gaps_at(i, &stage)).collect()
}

/// A state at the start of the analysis as it is a moment later.
pub(crate) fn soon(model: &Model, start: &State) -> State {
    let steps = model.steps.first();
    State {
        t: start.t + steps.map_or(1.0, |s| 1e-9 * (s.end - s.start)),
        ..start.clone()
    }
}

/// The first moment of the analysis.
pub(crate) fn beginning<'a>(start: &'a State, end: &'a State) -> Stage<'a> {
    Stage {
        from: start,
        at: end,
        dt: end.t - start.t,
        rate: None,
        frames: None,
    }
}

/// What there is to say of a model before it runs, given the gaps at its start by interface.
pub(crate) fn check(view: &View, gaps: &[Vec<f64>], findings: Vec<Finding>) -> CheckReport {
    let start = view.frame.state.t;
    let steps = view.model.steps.first();
    let end = start + steps.map_or(1.0, |s| 1e-9 * (s.end - s.start));
    let interfaces = view.contact.interfaces.iter().zip(gaps);
    let interfaces = interfaces.map(|(i, gaps)| inspect(i, gaps)).collect();
    let mesh = &view.model.mesh;
    let bodies = view
        .model
        .bodies
        .iter()
        .map(|b| {
            let blocks = &mesh.blocks[b.blocks.clone()];
            let mut kinds: Vec<&str> = blocks.iter().map(|x| x.kind.name()).collect();
            kinds.dedup();
            let mut low = [f64::INFINITY; 3];
            let mut high = [f64::NEG_INFINITY; 3];
            for p in &mesh.points[b.points.clone()] {
                for c in 0..3 {
                    low[c] = low[c].min(p[c]);
                    high[c] = high[c].max(p[c]);
                }
            }
            let prefix = format!("{}.", b.name);
            let mut sets: Vec<String> = mesh
                .point_sets
                .keys()
                .chain(mesh.facet_sets.keys())
                .chain(mesh.cell_sets.keys())
                .filter_map(|k| k.strip_prefix(&prefix).map(str::to_string))
                .collect();
            sets.sort();
            sets.dedup();
            BodyReport {
                name: b.name.clone(),
                points: b.points.len(),
                cells: blocks.iter().map(|x| x.cell_ids.len()).sum(),
                kinds: kinds.join(", "),
                rigid: b.rigid.map(|r| r.mass),
                low,
                high,
                sets,
            }
        })
        .collect();
    CheckReport {
        bodies,
        interfaces,
        free: free_modes(view, end),
        steps: view
            .model
            .steps
            .iter()
            .map(|s| format!("{}: {} to {}", s.name, s.start, s.end))
            .collect(),
        findings,
    }
}

fn inspect(interface: &InterfaceDefinition, gaps: &[f64]) -> InterfaceReport {
    let mut finite: Vec<(f64, usize)> = gaps.iter().copied().zip(0..).collect();
    finite.retain(|(gap, _)| gap.is_finite());
    finite.sort_by(|a, b| a.0.total_cmp(&b.0));
    let nearest = finite.first().map(|&(_, i)| &interface.points[i]);
    let gap = |at: Option<&(f64, usize)>, none: f64| at.map_or(none, |&(gap, _)| gap);
    InterfaceReport {
        name: interface.name.clone(),
        points: interface.points.len(),
        area: interface.points.iter().map(|p| p.area).sum(),
        paired: finite.len(),
        smallest: gap(finite.first(), f64::INFINITY),
        median: gap(finite.get(finite.len() / 2), f64::INFINITY),
        largest: gap(finite.last(), f64::NEG_INFINITY),
        nearest_node: nearest.and_then(|p| Some(interface.node_ids[p.node()?])),
        nearest_at: nearest.map(|p| add(p.place(&interface.reference), interface.origin)),
        overlapping: finite.iter().filter(|(gap, _)| *gap < 0.0).count(),
        laws: interface.laws.describe(),
    }
}

/// A coordinate of a body of this size, for people: rounding errors of meshers are zero.
fn coordinate(x: f64, size: f64) -> String {
    match x.abs() < 1e-9 * size {
        true => "0".into(),
        false => digits(x, 7),
    }
}

impl fmt::Display for CheckReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "bodies")?;
        for b in &self.bodies {
            let size = (0..3).map(|c| b.high[c] - b.low[c]).fold(0.0, f64::max);
            let corner = |x: [f64; 3]| x.map(|v| coordinate(v, size)).join(", ");
            writeln!(
                f,
                "  {}: {} points, {} cells ({}), from ({}) to ({})",
                b.name,
                b.points,
                b.cells,
                b.kinds,
                corner(b.low),
                corner(b.high)
            )?;
            if let Some(mass) = b.rigid {
                writeln!(f, "    rigid, of mass {mass}", mass = digits(mass, 5))?;
            }
            writeln!(f, "    sets: {}", b.sets.join(", "))?;
        }
        writeln!(f, "interfaces")?;
        for i in &self.interfaces {
            writeln!(
                f,
                "  {}: {} points, area {}, {}",
                i.name,
                i.points,
                digits(i.area, 5),
                i.laws
            )?;
            if i.paired == 0 {
                writeln!(
                    f,
                    "    no point has the primary opposite: the surfaces lie beside each other"
                )?;
            } else {
                writeln!(
                    f,
                    "    gaps {} to {}, median {}, {} of {} points have something opposite, {} overlap",
                    digits(i.smallest, 5),
                    digits(i.largest, 5),
                    digits(i.median, 5),
                    i.paired,
                    i.points,
                    i.overlapping
                )?;
                if let Some([x, y, z]) = i.nearest_at {
                    let what = match i.smallest < 0.0 {
                        true => "deepest overlap",
                        false => "smallest gap",
                    };
                    let node = match i.nearest_node {
                        Some(id) => format!("node {id} "),
                        None => String::new(),
                    };
                    writeln!(
                        f,
                        "    {what} at {node}({x}, {y}, {z})",
                        x = digits(x, 5),
                        y = digits(y, 5),
                        z = digits(z, 5)
                    )?;
                }
            }
        }
        writeln!(f, "free rigid-body modes (held by contact alone)")?;
        if self.free.is_empty() {
            writeln!(f, "  none")?;
        }
        for m in &self.free {
            writeln!(f, "  {}: {}", m.body, m.motion)?;
        }
        writeln!(f, "steps")?;
        for s in &self.steps {
            writeln!(f, "  {s}")?;
        }
        writeln!(f, "findings")?;
        if self.findings.is_empty() {
            writeln!(f, "  none")?;
        }
        for finding in &self.findings {
            writeln!(f, "  {}", finding.to_string().replace('\n', "\n  "))?;
        }
        Ok(())
    }
}

//! What interfaces did over a whole run: those that never carried anything, those whose contact is too small for their mesh.

use serde::Serialize;

use super::finding::{DoctorCause, Finding};
use super::places;
use super::suspect::Suspect;
use crate::assess::scale;
use crate::assess::view::View;
use crate::body::turning;
use crate::contact::interface::{ContactView, InterfaceDefinition};
use crate::contact::look;
use crate::contact::look::{Resolution, Resultant};
use crate::math::Vec3;
use crate::model::Body;
use crate::number::digits;
use crate::tolerance::{NEGLIGIBLE, SAME};

/// What is remembered of an interface.
#[derive(Debug, Clone, Default, crate::keep::Keep)]
pub(crate) struct Watch {
    /// The largest force so far `[N]`, its time and how finely contact was resolved then.
    force: f64,
    time: f64,
    resolution: Option<Resolution>,
    /// It has acted.
    acted: bool,
    /// The largest turn of normals that small sliding leaves out so far `[rad]`, and its time.
    turn: f64,
    turned_at: f64,
    /// The largest pressure so far, of tied surfaces the largest traction.
    peak: Peak,
    /// When it carried something last, and the points that did.
    carried_at: f64,
    carriers: Vec<usize>,
}

/// The largest pressure of an interface over a run, or the largest traction of tied surfaces.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, crate::keep::Keep)]
#[serde(rename_all = "kebab-case")]
pub struct Peak {
    /// The pressure or traction `[Pa]`; 0 where nothing ever acted.
    pub value: f64,
    /// The contact point that carried it `[m]`, displaced.
    pub at: Vec3,
    /// When `[s]`; the first time where it stays.
    pub time: f64,
}

impl Watch {
    /// The largest pressure so far.
    pub fn peak(&self) -> Peak {
        self.peak
    }

    /// Looks at the last accepted state, of which `r` are the forces.
    pub fn note(&mut self, interface: ContactView, r: &Resultant, u: &[f64], t: f64) {
        let force = r.carried;
        // A pressure that stays as it is differs by rounding from increment to increment.
        if r.peak > (1.0 + SAME) * self.peak.value {
            self.peak = Peak {
                value: r.peak,
                at: r.peak_at,
                time: t,
            };
        }
        self.acted |= interface.schedule.active(t);
        let turn = look::normals_turned(interface, u);
        if turn > self.turn {
            self.turn = turn;
            self.turned_at = t;
        }
        // An interface with less of its largest force carries nothing any more: the tolerance of Newton's method leaves as much.
        if force > NEGLIGIBLE * self.force {
            self.carried_at = t;
            self.carriers = look::closed(interface);
        }
        if force > self.force {
            self.force = force;
            self.time = t;
            self.resolution = look::resolution(interface);
        }
    }
}

/// What there is to say at the end of a run.
pub(crate) fn watched(view: &View, watches: &[Watch]) -> Vec<Finding> {
    let interfaces = view.contacts();
    let pairs = interfaces.zip(watches);
    // A force below this part of what the displacements would make as strains is rounding.
    let nothing = 1e-11 * scale::strain_force(view);
    let mut out = strained(view);
    out.extend(
        pairs
            .filter(|(_, watch)| watch.acted)
            .flat_map(|(interface, watch)| match watch.force > nothing {
                // One half of a pair may be idle where the other one carries.
                false if interface.share < 1.0 => [None, None, None, None],
                false => [
                    Some(never_carried(&interface, view.model.moves())),
                    None,
                    None,
                    None,
                ],
                true => [
                    coarse(&interface, watch),
                    turned(&interface, watch),
                    deep(interface),
                    left(view, interface, watch),
                ],
            })
            .flatten(),
    );
    out
}

/// Bodies without frames of their own that are strained, where their energy is, by more than forces of a linear theory may be wrong. With frames there is a figure for it.
fn strained(view: &View) -> Vec<Finding> {
    let limits = &view.model.reports.quality;
    let limit = limits.strain_limit();
    // Where a limit is given the gate judges all bodies.
    let judged = |b: &&Body| view.model.has_frames(b) || limits.strain.is_some();
    let bodies = view.model.elastic().filter(|b| !judged(b));
    let strained = bodies.filter_map(|body| {
        let strain = turning::strain_level(&body.elastic, &view.frame.state);
        let name = &body.name;
        (strain > limit && strain.is_finite()).then(|| {
            DoctorCause::LargeStrain.warning(format!(
                "body {name} is strained by {strain:.2} in the end, in the mean of its energy: bodies are linear, with small strains, and forces are wrong by about that part"
            ))
            .blame(places::body(view.model, name, format!("strain {strain:.2}")))
            .advise("if that is not meant, look for a load, a way or a stiffness in the wrong unit; for what strains as much as rubber does take another program")
        })
    });
    strained.collect()
}

fn turned(interface: &InterfaceDefinition, watch: &Watch) -> Option<Finding> {
    // A larger turn of normals is worth a word: shear over pressure is off by as much.
    if watch.turn <= 0.02 {
        return None;
    }
    let name = &interface.name;
    let finding = DoctorCause::TurnedNormals.warning(format!(
        "interface {name}: its surfaces have turned by up to {:.3} rad where they press, and small sliding keeps the normals of the start: shear over pressure is off by up to {:.1} %",
        watch.turn,
        100.0 * watch.turn.tan()
    ));
    let finding = Finding {
        time: Some(watch.turned_at),
        ..finding
    };
    Some(
        finding
            .blame(Suspect::interface(name, "kinematics.small-sliding"))
            .advise(format!("leave out `interface.{name}.kinematics.small-sliding`: the default follows the surfaces")),
    )
}

fn deep(interface: ContactView) -> Option<Finding> {
    let profile = look::wear_profile(interface)?;
    let mut said = Vec::new();
    // A scar of a larger slope is no small change of the surface.
    if profile.slope > 0.1 {
        said.push(format!("has a slope of up to {:.2}", profile.slope));
    }
    // Nor is one of a larger depth over the radius of the surface.
    if profile.curved > 1e-2 {
        said.push(format!(
            "is up to {:.3} of the radius of the surface deep",
            profile.curved
        ));
    }
    if said.is_empty() {
        return None;
    }
    let name = &interface.name;
    let finding = DoctorCause::DeepWear.warning(format!(
        "interface {name}: the wear depth {}. Wear depth is added to the gaps while normals and surfaces stay as meshed, which is a first-order approximation",
        said.join(" and ")
    ));
    Some(
        finding
            .blame(Suspect::interface(name, "worn beyond first order"))
            .advise(format!("end the run here and begin another one on the worn surfaces, with `worn` of `interface.{name}`")),
    )
}

/// Contact that has ended over the edge of the primary: what carried last has nothing opposite any more.
fn left(view: &View, interface: ContactView, watch: &Watch) -> Option<Finding> {
    let now = view.frame.state.t;
    if interface.rigid() || watch.carried_at >= now || !interface.schedule.active(now) {
        return None;
    }
    let gaps = look::initial_gaps(interface);
    let beyond = watch.carriers.iter().filter(|&&i| !gaps[i].is_finite());
    let count = beyond.clone().count();
    if count == 0 || 2 * count < watch.carriers.len() {
        return None;
    }
    let name = &interface.name;
    // What is thrown may well fly on.
    let finding = DoctorCause::LeftPrimary.warning(format!(
        "interface {name} lost contact after time {}: its last loaded points slid over the edge of the primary",
        digits(watch.carried_at, 5),
    ))
    .note_unless(!view.model.moves());
    let finding = Finding {
        time: Some(watch.carried_at),
        ..finding
    }
    .blame(Suspect::interface(
        name,
        "its secondary has left its primary",
    ));
    let beyond = beyond.map(|&i| places::secondary(&interface, i, "beyond the edge"));
    Some(
        finding
            .blame_all(beyond)
            .advise("let the primary reach as far as the motion goes, or let the motion end before its edge")
            .advise("if the bodies are meant to separate, the result is right; after that time this interface supports nothing"),
    )
}

fn never_carried(interface: &InterfaceDefinition, moves: bool) -> Finding {
    let name = &interface.name;
    // What is thrown may land later than anybody wants to know.
    DoctorCause::NeverCarried
        .warning(format!("interface {name} never carried anything in the whole run"))
        .note_unless(!moves)
        .blame(Suspect::interface(name, "no force at any time"))
        .advise("check that supports and loads press the two bodies together, and the gap between them (`stickslip check`)")
        .advise("where the bodies do meet, choose the finer surface as secondary")
}

fn coarse(interface: &InterfaceDefinition, watch: &Watch) -> Option<Finding> {
    // Half of the force has to be carried where contact is three points across.
    let found = watch.resolution.filter(|r| r.resolved < 0.5)?;
    let name = &interface.name;
    let points = match found.points {
        1 => "1 point".to_string(),
        n => format!("{n} points"),
    };
    let finding = DoctorCause::CoarseContact.warning(format!(
        "interface {name}: contact is resolved by fewer than three points across, {points} of {} in contact at its largest force",
        found.of
    ));
    let mut finding = Finding {
        time: Some(watch.time),
        ..finding
    }
    .blame(Suspect::interface(name, format!("{points} in contact")));
    finding = finding.advise(
        "refine the secondary in the contact: pressures and contact width need several points across it. Halve the cells to estimate the error of the force",
    );
    Some(finding)
}

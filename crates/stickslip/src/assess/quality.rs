//! The quality gate: figures by which accepted increments are judged, and their limits.

use serde::Serialize;

use super::doctor::{Peak, Watch, longest_way};
use super::figures::{
    self, ACTION_REACTION, COMPLEMENTARITY, CONE_VIOLATION, ELASTIC_SLIP, ENERGY, EQUILIBRIUM,
    EXPLICIT_OPENING, EXPLICIT_PENETRATION, EXPLICIT_WEAR, FRICTION_LAW, Kind, MOMENT, OSCILLATION,
    OUTDATED_NORMALS, PENETRATION_TO_APPROACH, PENETRATION_TO_SIZE, SCHEME_DISSIPATION,
    TIE_OPENING, UNDETECTED_APPROACH, UNDETECTED_PENETRATION,
};
use super::gate::Gate;
use super::view::View;
use super::{equilibrium, scale, travel};
use crate::body::couplings::explicit;
use crate::contact::interface::ContactView;
use crate::contact::look;
use crate::contact::look::{Between, Quality};
use crate::math::{Vec3, norm};
use crate::model::definition::Model;
use crate::model::ledger::EnergyQuality;
use crate::model::limits::{GateMode, Limits};
use crate::number::{digits, figure};
use crate::system::Tally;
use crate::tolerance::NEGLIGIBLE;

/// The energy that forces of this size stand for where nothing moves `[J]`.
pub(crate) fn still_energy(model: &Model, forces: f64) -> f64 {
    // Forces that move by less than this part of the size of the model do no work worth a balance.
    NEGLIGIBLE * model.size * forces
}

fn ratio(value: f64, scale: f64) -> f64 {
    if value == 0.0 || scale <= 0.0 {
        0.0
    } else {
        value / scale
    }
}

/// Judges the last accepted state.
pub(crate) fn judge_quality(view: &View, limits: &Limits, gate: &mut Gate) {
    gate.gate = limits.gate;
    if limits.gate != GateMode::Off {
        judge_interfaces(view, limits, gate);
        if view.explicit.is_none() {
            equilibrium::judge_bodies(view, limits, gate);
        }
    }
}

/// Takes note of what interfaces do.
pub(crate) fn watch(view: &View, watches: &mut [Watch]) {
    let (u, t) = (&view.frame.state.u, view.frame.state.t);
    for (watch, interface) in watches.iter_mut().zip(view.contacts()) {
        watch.note(interface, &look::resultant(interface, u), u, t);
    }
}

fn judge_interfaces(view: &View, limits: &Limits, gate: &mut Gate) {
    let t = view.frame.state.t;
    // What rounding stores where a body is carried along is no elastic approach, least of all beside a contact that carries next to nothing.
    let energy = match view.elastic_energy() {
        energy if energy > scale::rounded_energy(view) => energy,
        _ => 0.0,
    };
    let tied = view.contacts();
    let tied =
        tied.filter_map(|i| Some((format!("interface {}", i.name), look::tie_spring_energy(i)?)));
    let coupled =
        explicit::spring_energies(&view.contact.couplings, &view.frame.contacts.couplings)
            .into_iter();
    let coupled = coupled.map(|(name, stored)| (format!("coupling {name}"), stored));
    for (place, stored) in tied.chain(coupled) {
        let limit = limits.explicit_opening;
        gate.note_in_motion(&EXPLICIT_OPENING, &place, [stored, energy], limit, t);
    }
    let ways = view.model.bodies.iter().map(|body| travel::way(view, body));
    let way = ways.fold(0.0, f64::max);
    let all = view.contact.interfaces.iter().zip(&view.solver.conditions);
    for ((acting, conditions), interface) in all.zip(view.contacts()) {
        let q = look::quality(interface);
        let r = look::resultant(interface, &view.frame.state.u);
        let place = format!("interface {}", interface.name);
        let whole = 2.0 * energy / r.carried.max(f64::MIN_POSITIVE);
        let approach = match r.carried > 0.0 {
            true => whole.max(q.layer),
            false => 0.0,
        };
        if interface.laws.tied && approach > 0.0 {
            let pair = [
                look::opening(interface, &view.frame.state.u),
                approach.min(way),
            ];
            gate.note_in_motion(&TIE_OPENING, &place, pair, limits.tie_opening, t);
        }
        let between = look::between(interface, &view.frame.state.u, t);
        judge_between(interface, between, approach, limits, gate, &place, t);
        if r.carried <= 0.0 {
            continue;
        }
        if look::on_springs(interface) && !interface.laws.tied {
            let pair = [0.5 * q.violation_work, energy];
            let limit = limits.explicit_penetration;
            gate.note_in_motion(&EXPLICIT_PENETRATION, &place, pair, limit, t);
        }
        let mut note = |kind, pair, limit| gate.note(kind, &place, pair, limit, t);
        if !look::on_springs(interface) {
            let size = [q.relative_to_size, 1.0];
            let bridged = [q.complementarity * q.pressed, q.pressed];
            note(&PENETRATION_TO_SIZE, size, limits.penetration_to_size);
            note(&COMPLEMENTARITY, bridged, limits.complementarity);
            // Of the elastic approach, 2 U / F or the compression of one layer of cells: both sides times the force.
            let elastic = (2.0 * energy).max(r.carried * q.layer);
            let pair = [q.penetration * r.carried, elastic];
            let limit = limits.penetration_to_approach;
            if view.inertia().is_some() {
                gate.note_in_motion(&PENETRATION_TO_APPROACH, &place, pair, limit, t);
            } else {
                note(&PENETRATION_TO_APPROACH, pair, limit);
                let elastic_slip = [q.elastic_slip * r.carried, elastic];
                note(&ELASTIC_SLIP, elastic_slip, limits.elastic_slip);
            }
        }
        let mut note = |kind, pair, limit| gate.note(kind, &place, pair, limit, t);
        let uneven = [q.oscillation * r.total, r.total];
        note(&OSCILLATION, uneven, limits.oscillation);
        if let Some(limit) = longest_way(view.model, &interface) {
            let way = [look::slid(acting, conditions), limit];
            note(&EXPLICIT_WEAR, way, limits.explicit_wear);
        }
        if let Some(pair) = look::outdated_normals(interface, &view.frame.state.u) {
            note(&OUTDATED_NORMALS, pair, limits.outdated_normals);
        }
        let excess = [q.cone_violation * q.limit, q.limit];
        note(&CONE_VIOLATION, excess, limits.cone_violation);
        let wrong = [q.friction_law * q.limit, q.limit];
        note(&FRICTION_LAW, wrong, limits.friction_law);
        let b = look::balance(interface, &view.frame.state.u);
        if b.scale > 0.0 {
            let force = [norm(b.force), b.scale];
            let moment = [norm(b.moment), b.scale * b.size];
            note(&ACTION_REACTION, force, limits.action_reaction);
            note(&MOMENT, moment, limits.moment);
        }
    }
}

/// Judges the energy balance, once all is done; what a user should know of it goes to `notes`.
pub(crate) fn judge_energy(
    view: &View,
    limits: &Limits,
    quality: &EnergyQuality,
    gate: &mut Gate,
    notes: &mut Vec<String>,
) {
    if limits.gate == GateMode::Off {
        return;
    }
    let ledger = &view.frame.ledger;
    let moves = view.model.moves();
    let limit = limits.energy.unwrap_or(view.model.solution.energy_limit);
    // Where nothing happens there are no energies to compare with, but forces that have moved by their rounding.
    let forces = gate.largest(&EQUILIBRIUM, None);
    let least = still_energy(view.model, forces);
    let least = least.max(scale::rounded_energy(view));
    let pair = [quality.largest, quality.scale.max(least)];
    let t = view.frame.state.t;
    let (open, scale) = (pair[0], pair[1].max(f64::MIN_POSITIVE));
    let unknown = ledger.uncertain;
    // A quasi-static energy balance that is off by more than a thousandth of the energy stored and dissipated is worth a note.
    if !moves && open > 1e-3 * scale {
        notes.push(format!(
            "energy balance error: {:.1} % of the energy stored and dissipated; expect this error in works and losses. Smaller increments reduce the part from changes of contact status within increments; the rest comes from contact forces along other directions than the gaps, as at edges or with small rotations",
            100.0 * open / scale
        ));
    }
    // The same of what is not known of friction.
    if !moves && unknown > 1e-2 * scale {
        notes.push(format!(
            "frictional dissipation: {} ± {unknown}. Points begin to slide within increments, and the time within the increment is not resolved. Smaller increments reduce this uncertainty",
            figure(ledger.friction),
            unknown = digits(unknown, 2),
        ));
    }
    if moves {
        let lost = [ledger.numerical.max(0.0), pair[1]];
        let limit = limits.scheme_dissipation;
        gate.note(&SCHEME_DISSIPATION, "model", lost, limit, t);
    }
    gate.note(&ENERGY, "model", pair, limit, t);
    gate.settle();
}

/// Judges what lies between the points of an interface whose bodies have come nearer elastically by `approach`.
fn judge_between(
    interface: ContactView,
    between: Between,
    approach: f64,
    limits: &Limits,
    gate: &mut Gate,
    place: &str,
    t: f64,
) {
    let mut missed = between.penetration.max(between.apart);
    if approach == 0.0 && missed > 0.0 {
        // Facets of curved surfaces may overlap in the meshes where nothing presses.
        missed = (missed - look::overlap_between(interface, t)).max(0.0);
    }
    if missed > 0.0 || approach > 0.0 {
        let size = [between.relative_to_size, 1.0];
        gate.note(
            &UNDETECTED_PENETRATION,
            place,
            size,
            limits.undetected_penetration,
            t,
        );
        let part = [missed, missed + approach];
        let limit = limits.undetected_approach;
        gate.note_in_motion(&UNDETECTED_APPROACH, place, part, limit, t);
    }
}

/// An interface at the end of a run.
#[derive(Debug, Clone, Default, Serialize)]
#[serde(rename_all = "kebab-case")]
pub struct InterfaceSummary {
    /// Name.
    pub name: String,
    /// Whether contact points are those of the side that the problem calls primary, see [`InterfaceDefinition::exchanged`].
    ///
    /// [`InterfaceDefinition::exchanged`]: crate::contact::interface::InterfaceDefinition::exchanged
    pub exchanged: bool,
    /// Whether its surfaces are tied: then it has tractions, and no pressure, no points that stick, slip or open and no friction.
    pub tied: bool,
    /// The largest pressure of the whole run, with its place and time.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub peak_pressure: Option<Peak>,
    /// The largest pressure at the end `[Pa]`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pressure: Option<f64>,
    /// The largest traction of tied surfaces over the whole run, with its place and time.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub peak_traction: Option<Peak>,
    /// The largest traction of tied surfaces at the end `[Pa]`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub traction: Option<f64>,
    /// Sum of pressure forces on the secondary, as it is named, at the end `[N]`.
    pub normal_force: Vec3,
    /// Sum of shear forces on it at the end `[N]`.
    pub shear_force: Vec3,
    /// Area in contact at the end `[m²]`.
    pub area: f64,
    /// Contact points by what they do at the end.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub points: Option<Points>,
    /// What friction took over the whole run `[J]`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub friction_work: Option<f64>,
    /// Largest unwanted penetration and false slip.
    pub quality: Quality,
    /// Largest unwanted penetration relative to the elastic approach, `2 U / F` of the model's strain energy and this interface's
    /// force.
    pub relative_to_approach: f64,
    /// How far what the two sides receive is out of balance.
    #[serde(flatten)]
    pub balance: Imbalance,
    /// What the numerical stiffness of the enforcement does to the result; `null` where there is none.
    pub numerical_stiffness: Option<NumericalStiffness>,
}

/// How far what the two sides of an interface receive is out of balance.
#[derive(Debug, Clone, Copy, Default, Serialize)]
#[serde(rename_all = "kebab-case")]
pub struct Imbalance {
    /// Out-of-balance between what the two sides receive, relative to the force.
    pub action_reaction: f64,
    /// Sum of the moments of what the two sides receive, relative to the force times the size of the interface.
    pub moment: f64,
}

/// Contact points by what they do.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub struct Points {
    /// In contact without slip.
    pub stick: usize,
    /// In contact and sliding.
    pub slip: usize,
    /// Not in contact.
    pub open: usize,
}

impl From<Tally> for Points {
    fn from(tally: Tally) -> Self {
        Points {
            stick: tally.stick,
            slip: tally.slip,
            open: tally.open,
        }
    }
}

/// How much a result depends on the numerical stiffness of an enforcement.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub struct NumericalStiffness {
    /// The stiffness in use, the smallest of any point in contact, as a multiple of the bodies' own.
    pub factor: f64,
    /// By how much the force of the interface would rise, relative to what it is, if the stiffness became infinite and supports stayed where
    /// they are. Bodies and the springs of the enforcement are in series: the violations `v` that are left are to the elastic
    /// approach `2 U / F` as that rise is to the force, and so it is `Σ A (p |v_n| + |t| |v_t|) / 2 U` `[-]`.
    pub independent_to: f64,
}

/// The interfaces at the last accepted state.
pub(crate) fn interfaces(view: &View, gate: &Gate, watches: &[Watch]) -> Vec<InterfaceSummary> {
    let energy = view.elastic_energy();
    let all = view.contacts().zip(watches);
    all.map(|(interface, watch)| {
        let quality = look::quality(interface);
        let r = look::resultant(interface, &view.frame.state.u);
        let b = look::balance(interface, &view.frame.state.u);
        let place = format!("interface {}", interface.name);
        let floor = |kind| gate.floor(kind, &place);
        let strain = view.frame.ledger.strain;
        let whole = 2.0 * strain / r.carried.max(f64::MIN_POSITIVE);
        let factor = look::numerical_factor(interface);
        let tied = interface.laws.tied;
        InterfaceSummary {
            name: interface.name.clone(),
            exchanged: interface.exchanged,
            tied,
            peak_pressure: (!tied).then(|| watch.peak()),
            pressure: (!tied).then_some(r.peak),
            peak_traction: tied.then(|| watch.peak()),
            traction: tied.then_some(r.peak),
            normal_force: r.normal,
            shear_force: r.shear,
            area: r.area,
            points: (!tied).then(|| look::committed_tally(interface).into()),
            friction_work: (!tied).then(|| look::energy(interface).dissipated),
            quality,
            relative_to_approach: ratio(quality.penetration, whole),
            balance: Imbalance {
                action_reaction: ratio(norm(b.force), b.scale.max(floor(&ACTION_REACTION))),
                moment: ratio(norm(b.moment), (b.scale * b.size).max(floor(&MOMENT))),
            },
            numerical_stiffness: factor
                .filter(|_| energy > 0.0)
                .map(|factor| NumericalStiffness {
                    factor,
                    independent_to: quality.violation_work / (2.0 * energy),
                }),
        }
    })
    .collect()
}

stickslip_base::keep_by_name!(&'static Kind, one of figures::ALL, by |kind| kind.name);

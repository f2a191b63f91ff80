//! The quality gate: figures by which accepted increments are judged, and their limits.

use serde::Serialize;

use super::doctor::{Finding, Peak, Watch, longest_way};
use super::figures::{
    self, ACTION_REACTION, COMPLEMENTARITY, ENERGY, EQUILIBRIUM, EXCESS_SHEAR, EXPLICIT_OPENING,
    EXPLICIT_PENETRATION, EXPLICIT_WEAR, FALSE_SHEAR, FALSE_SLIP, FRICTION_LAW, Kind, MOMENT,
    OSCILLATION, PENETRATION_TO_APPROACH, PENETRATION_TO_SIZE, SCHEME_DISSIPATION, TIE_OPENING,
    Track, UNSEEN_TO_APPROACH, UNSEEN_TO_SIZE,
};
use super::view::View;
use crate::assess::{equilibrium, travel};
use crate::body::couplings::explicit;
use crate::contact::interface::ContactView;
use crate::contact::look;
use crate::contact::look::{Between, Quality};
use crate::math::{Vec3, norm};
use crate::model::definition::Model;
use crate::model::ledger::EnergyQuality;
use crate::model::limits::{GateMode, Limits};
use crate::system::Tally;
use crate::tolerance::NEGLIGIBLE;

/// The outcome of the quality gate.
#[derive(Debug, Clone, Default, Serialize, crate::keep::Keep)]
#[serde(rename_all = "kebab-case")]
pub struct Gate {
    /// What becomes of a figure above its limit.
    pub gate: GateMode,
    /// Whether all figures kept their limits.
    pub met: bool,
    /// The worst of each figure at each place.
    pub figures: Vec<Figure>,
    /// What the figures are made of, in their order.
    #[serde(skip)]
    tracks: Vec<Track>,
}

/// A figure at its worst.
#[derive(Debug, Clone, Serialize, crate::keep::Keep)]
#[serde(rename_all = "kebab-case")]
pub struct Figure {
    /// Its name: the key of its limit in `[quality]`.
    pub figure: &'static str,
    /// Where: `interface NAME`, `body NAME`, `reference point NAME` or `model`.
    pub place: String,
    /// Its largest value `[-]`.
    pub value: f64,
    /// The limit; `null` where it is not judged.
    pub limit: Option<f64>,
    /// Whether the value does not exceed it.
    pub met: bool,
    /// Time of the increment that it comes from `[s]`.
    pub time: f64,
    #[serde(skip)]
    kind: &'static Kind,
}

impl Figure {
    /// Its value and its limit with as many digits as it takes to tell one from the other.
    pub fn compared(&self) -> [String; 2] {
        let limit = self.limit.unwrap_or(f64::INFINITY);
        told_apart(self.value, limit)
    }

    /// Where, which, how much and how much too much.
    pub fn brief(&self) -> String {
        let [value, limit] = self.compared();
        format!(
            "{}: {} is {value}, above its limit {limit}",
            self.place, self.figure
        )
    }

    /// What is wrong and what may help, for a figure above its limit, in a run with these findings.
    pub fn sentence(&self, findings: &[Finding]) -> String {
        let (what, help) = (self.kind.what, figures::advice(self.kind.help, findings));
        format!(
            "{} (at time {:.4e}): {what}; {help}",
            self.brief(),
            self.time
        )
    }
}

impl Figure {
    /// What it means that a figure is above its limit, and what may help in a run with these findings, by its name; `None` of one that is not known.
    pub fn meaning(figure: &str, findings: &[Finding]) -> Option<(&'static str, String)> {
        let kind = figures::ALL.iter().find(|kind| kind.name == figure)?;
        Some((kind.what, figures::advice(kind.help, findings)))
    }
}

impl Gate {
    /// The figures above their limits.
    pub fn violations(&self) -> impl Iterator<Item = &Figure> {
        self.figures.iter().filter(|f| !f.met)
    }

    /// Whether the run has to end with an error.
    pub fn failed(&self) -> bool {
        self.gate == GateMode::Error && !self.met
    }

    /// Notes a figure after an increment: how much is wrong, and what there is to compare it with. What it comes to is found by
    /// [`settle`](Self::settle), when the largest of the run is known.
    pub(crate) fn note(
        &mut self,
        kind: &'static Kind,
        place: &str,
        [amount, scale]: [f64; 2],
        limit: f64,
        time: f64,
    ) {
        self.track(kind, place, limit).add(amount, scale, time);
    }

    /// The same for a figure in motion, where what it is relative to comes and goes: the largest amount of the run is compared with the largest
    /// scale of the run.
    pub(crate) fn note_in_motion(
        &mut self,
        kind: &'static Kind,
        place: &str,
        [amount, scale]: [f64; 2],
        limit: f64,
        time: f64,
    ) {
        (self.track(kind, place, limit)).add_in_motion(amount, scale, time);
    }

    fn track(&mut self, kind: &'static Kind, place: &str, limit: f64) -> &mut Track {
        let mut known = self.figures.iter();
        let known = known.position(|f| f.figure == kind.name && f.place == place);
        let i = known.unwrap_or_else(|| {
            self.tracks.push(Track::default());
            self.figures.push(Figure {
                figure: kind.name,
                place: place.to_string(),
                value: 0.0,
                // An infinite limit is none, and JSON has no infinity.
                limit: limit.is_finite().then_some(limit),
                met: true,
                time: 0.0,
                kind,
            });
            self.figures.len() - 1
        });
        &mut self.tracks[i]
    }

    /// The largest scale of a figure so far, anywhere or at one place.
    pub(crate) fn largest(&self, kind: &Kind, place: Option<&str>) -> f64 {
        let both = self.figures.iter().zip(&self.tracks);
        let same = both.filter(|(f, _)| f.figure == kind.name);
        let there = same.filter(|(f, _)| place.is_none_or(|place| f.place == place));
        there.map(|(_, t)| t.largest).fold(0.0, f64::max)
    }

    /// What `scale` is at least, at a place.
    pub(crate) fn floor(&self, kind: &Kind, place: &str) -> f64 {
        let own = kind.own * self.largest(kind, Some(place));
        own.max(kind.model * self.largest(kind, None))
    }

    /// Works out all figures with the largest scales of the run so far: what looked bad beside small forces may be nothing beside those that came
    /// later.
    pub(crate) fn settle(&mut self) {
        for i in 0..self.figures.len() {
            let figure = &self.figures[i];
            let floor = self.floor(figure.kind, &figure.place);
            let (value, time) = self.tracks[i].worst(floor);
            let figure = &mut self.figures[i];
            figure.value = value;
            if value > 0.0 {
                figure.time = time;
            }
            // What is not a number is above every limit.
            figure.met = figure.limit.is_none_or(|limit| value <= limit);
        }
        self.met = self.figures.iter().all(|f| f.met);
    }
}

/// The energy that forces of this size stand for where nothing moves `[J]`.
pub(crate) fn still_energy(model: &Model, forces: f64) -> f64 {
    // Forces that move by less than this part of the size of the model do no work worth a balance.
    NEGLIGIBLE * model.size * forces
}

/// Digits behind the point of a value and of its limit, where these tell them apart.
const DIGITS: [usize; 2] = [2, 1];

/// Two numbers with as many digits as it takes to tell one from the other.
pub fn told_apart(value: f64, limit: f64) -> [String; 2] {
    let [few, fewer] = DIGITS;
    let said = |x: f64, digits: usize| format!("{x:.digits$e}");
    let usual = |digits: usize| said(value, digits) == said(limit, digits);
    let digits = (few..=17).find(|&digits| !usual(digits)).unwrap_or(17);
    match digits == few {
        true => [said(value, few), said(limit, fewer)],
        false => [said(value, digits), said(limit, digits)],
    }
}

fn ratio(value: f64, scale: f64) -> f64 {
    if value == 0.0 || scale <= 0.0 {
        0.0
    } else {
        value / scale
    }
}

/// The energy that may be nothing but rounding of the strains `[J]`.
fn rounded_energy(view: &View) -> f64 {
    let moved = farthest(view);
    // Energies below this part of what the model would store if it strained as far as it moves are rounding.
    1e-13 * stiffness(view) * moved * moved
}

/// The largest displacement or rotation of a dof.
fn farthest(view: &View) -> f64 {
    (view.frame.state.u.iter()).fold(0.0, |m, u| f64::max(m, u.abs()))
}

/// Force `[N]` in the stiffest body if the largest displacement were its strain, beside which forces may be nothing but rounding.
pub(crate) fn strain_force(view: &View) -> f64 {
    stiffness(view) * farthest(view)
}

/// Stiffness `[N/m]` of a body of the stiffest material and the size of the model.
fn stiffness(view: &View) -> f64 {
    let blocks = 0..view.model.mesh.blocks.len();
    let moduli = view.model.elastic().flat_map(|b| {
        let of = |k: usize| b.elastic.constrained_modulus(k);
        blocks.clone().filter_map(of)
    });
    let stiffest = moduli.fold(0.0_f64, f64::max);
    stiffest * view.model.size.powi(view.model.mesh.dim as i32 - 2)
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
        energy if energy > rounded_energy(view) => energy,
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
                let false_slip = [q.false_slip * r.carried, elastic];
                note(&FALSE_SLIP, false_slip, limits.false_slip);
            }
        }
        let mut note = |kind, pair, limit| gate.note(kind, &place, pair, limit, t);
        let uneven = [q.oscillation * r.total, r.total];
        note(&OSCILLATION, uneven, limits.oscillation);
        if let Some(limit) = longest_way(view.model, &interface) {
            let way = [look::slid(acting, conditions), limit];
            note(&EXPLICIT_WEAR, way, limits.explicit_wear);
        }
        if let Some(pair) = look::false_shear(interface, &view.frame.state.u) {
            note(&FALSE_SHEAR, pair, limits.false_shear);
        }
        let excess = [q.excess_shear * q.limit, q.limit];
        note(&EXCESS_SHEAR, excess, limits.excess_shear);
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
    let least = least.max(rounded_energy(view));
    let pair = [quality.largest, quality.scale.max(least)];
    let t = view.frame.state.t;
    let (open, scale) = (pair[0], pair[1].max(f64::MIN_POSITIVE));
    let unknown = ledger.uncertain;
    // A note says so if a quasi-static ledger leaves more of the energy in play open.
    if !moves && open > 1e-3 * scale {
        notes.push(format!(
            "the ledger of energies is open by {:.1} % of the energy in play: works and losses are known to no more than that. Smaller increments make what comes of the course within them less; what they leave says that forces act along other directions than gaps have, as at edges that press or with small rotations",
            100.0 * open / scale
        ));
    }
    // The same of what is not known of friction.
    if !moves && unknown > 1e-2 * scale {
        notes.push(format!(
            "friction took {:.3e}, ± {unknown:.1e}: points began to slide within increments, at times that are not known. Smaller increments make it less",
            ledger.friction
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
        gate.note(&UNSEEN_TO_SIZE, place, size, limits.unseen_to_size, t);
        let part = [missed, missed + approach];
        let limit = limits.unseen_to_approach;
        gate.note_in_motion(&UNSEEN_TO_APPROACH, place, part, limit, t);
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::keep::{Keep, Kept};

    #[test]
    fn a_value_just_above_its_limit_is_told_from_it() {
        assert_eq!(told_apart(0.4, 1e-4), ["4.00e-1", "1.0e-4"]);
        assert_eq!(told_apart(0.151, 0.15), ["1.51e-1", "1.5e-1"]);
        assert_eq!(told_apart(0.150004, 0.15), ["1.50004e-1", "1.50000e-1"]);
        assert_eq!(told_apart(f64::INFINITY, 0.15), ["inf", "1.5e-1"]);
    }

    #[test]
    fn every_figure_comes_back_as_what_it_was() {
        let mut gate = Gate::default();
        for kind in figures::ALL {
            gate.note(kind, "model", [2.0, 1.0], 0.5, 0.25);
        }
        gate.settle();
        let mut bytes = Vec::new();
        gate.keep(&mut bytes);
        let back = Gate::back(&mut Kept::new(&bytes)).expect("its bytes");
        let known = |gate: &Gate| format!("{:?}", gate.figures);
        assert_eq!(known(&back), known(&gate));
        for (a, b) in back.figures.iter().zip(&gate.figures) {
            assert!(std::ptr::eq(a.kind, b.kind), "{}", a.figure);
        }
    }
}

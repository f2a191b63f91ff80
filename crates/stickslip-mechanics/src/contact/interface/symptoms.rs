//! What points of an interface did in an attempt that failed.

use super::attempt::Attempt;
use super::cache::Cache;
use super::definition::{InterfaceDefinition, Primary};
use super::parts::Interface;
use crate::contact::law::normal::NormalLaw;
use crate::contact::response::Status;
use crate::math::{add, distance, norm};
use crate::number::{digits, figure};
use crate::system::{Culprit, Evidence, Tally};

/// Most culprits of one interface.
const MOST_CULPRITS: usize = 10;

/// Slip over an increment, relative to the facet, above which a point is suspect though its status does not change: it has left the half of the facet on which
/// it began. It decides what is said, and no result.
pub const LARGE_SLIP: f64 = 0.5;

/// Halvings by which a kink of the normal law is looked for.
const KINK_HALVINGS: usize = 40;

/// Ratio of slopes that counts as a kink: a smooth law is halved until its slopes agree, one with a kink keeps their ratio. It decides what is said, and no
/// result.
const SLOPE_RATIO_OF_KINK: f64 = 4.0;

/// An interface in the present attempt.
#[derive(Clone, Copy)]
pub(in crate::contact) struct LastAttempt<'a> {
    pub interface: &'a InterfaceDefinition,
    pub attempt: &'a Attempt,
    pub cache: &'a Cache,
}

impl<'a> From<&'a Interface> for LastAttempt<'a> {
    fn from(interface: &'a Interface) -> Self {
        LastAttempt {
            interface: &interface.definition,
            attempt: &interface.attempt,
            cache: &interface.cache,
        }
    }
}

impl LastAttempt<'_> {
    /// Its points by status.
    pub fn tally(self) -> Tally {
        let mut tally = Tally {
            changed: self.attempt.changed,
            ..Tally::default()
        };
        // Tied surfaces neither stick nor slip.
        let tied = self.interface.laws.tied;
        for e in self.cache.last.points.iter().filter(|_| !tied) {
            match e.response.status {
                Status::Open => tally.open += 1,
                Status::Stick => tally.stick += 1,
                Status::Slip => tally.slip += 1,
            }
        }
        tally
    }
}

impl Status {
    /// In a word.
    pub fn word(self) -> &'static str {
        match self {
            Status::Open => "open",
            Status::Stick => "stick",
            Status::Slip => "slip",
        }
    }
}

/// A point as a place to look at.
pub(super) fn culprit(attempted: LastAttempt, i: usize) -> Culprit {
    said(evidence_of(attempted, i))
}

/// What a point did in the present attempt.
pub fn evidence(interface: &Interface, i: usize) -> Evidence {
    evidence_of(interface.into(), i)
}

fn evidence_of(attempted: LastAttempt, i: usize) -> Evidence {
    let LastAttempt {
        interface,
        attempt,
        cache,
    } = attempted;
    let point = &interface.points[i];
    let mut evidence = Evidence {
        interface: interface.name.clone(),
        node: point.node().map(|one| interface.node_ids[one]),
        points: point.nodes.iter().map(|&n| interface.nodes[n]).collect(),
        position: add(point.position(&interface.reference), interface.origin),
        normal: point.normal.map(|c| -c),
        kink: 1.0,
        ..Evidence::default()
    };
    if let Some(flips) = attempt.flips.get(i) {
        evidence.flips = flips.count;
        evidence.left = flips.left;
        let course = flips.last.iter().rev().flatten();
        evidence.course = course.map(|s| s.word()).collect();
    }
    let Some(e) = cache.last.points.get(i) else {
        return evidence;
    };
    if e.frames.normal != [0.0; 3] {
        evidence.normal = e.frames.normal;
    }
    evidence.gap = e.gap;
    evidence.pressure = e.response.traction[0];
    evidence.shear = e.response.traction[1].hypot(e.response.traction[2]);
    evidence.limit = e.response.limit_along();
    evidence.slip = norm(e.moved);
    if let (Primary::Facets(facets), Some(f)) = (&interface.primary, e.foot.facet) {
        let x = |k: usize| interface.reference[facets[f].nodes[k]];
        evidence.facet = distance(x(0), x(1));
        evidence.cell = Some(facets[f].cell);
    }
    if let Some(before) = cache.trial.points.get(i) {
        evidence.kink = kink(interface.laws.normal_law(), before.gap, e.gap);
    }
    evidence
}

/// The points that changed status most often in this attempt, then those that slid farthest or lie at a kink of the normal law.
pub(super) fn culprits(attempted: LastAttempt) -> Vec<Culprit> {
    let mut all: Vec<Evidence> = (0..attempted.cache.last.points.len())
        .map(|i| evidence_of(attempted, i))
        .filter(|e| {
            let slid = e.facet > 0.0 && e.slip > LARGE_SLIP * e.facet;
            e.flips > 0 || e.left > 0 || e.kink > SLOPE_RATIO_OF_KINK || slid
        })
        .collect();
    // The sort is stable: points of equal guilt keep their order.
    all.sort_by(|a, b| {
        let slid = |e: &Evidence| e.slip / e.facet.max(f64::MIN_POSITIVE);
        let flips = b.flips.cmp(&a.flips);
        flips.then_with(|| slid(b).total_cmp(&slid(a)))
    });
    all.truncate(MOST_CULPRITS);
    all.into_iter().map(said).collect()
}

/// Evidence with its prose.
fn said(e: Evidence) -> Culprit {
    let who = match e.node {
        Some(id) => format!("node {id}"),
        None => "point".to_string(),
    };
    let x = e.position;
    let mut what = Vec::new();
    if e.flips > 0 {
        let course = e.course.join(" → ");
        what.push(format!("changed status {} times ({course})", e.flips));
    }
    if e.left > 0 {
        what.push(format!("left the edge of the primary {} times", e.left));
    }
    if e.facet > 0.0 && e.slip > LARGE_SLIP * e.facet {
        what.push(format!(
            "slid over {:.2} facets in one increment",
            e.slip / e.facet
        ));
    }
    if e.kink > SLOPE_RATIO_OF_KINK {
        what.push(format!(
            "lies at a kink of the normal law, slopes 1 to {:.1}",
            e.kink
        ));
    }
    what.push(format!(
        "gap {}, pressure {}, shear {} of {}",
        figure(e.gap),
        figure(e.pressure),
        figure(e.shear),
        figure(e.limit)
    ));
    Culprit {
        place: format!(
            "interface {}, {who} at ({}, {}, {})",
            e.interface,
            digits(x[0], 5),
            digits(x[1], 5),
            digits(x[2], 5)
        ),
        what: what.join(", "),
        evidence: Some(Box::new(e)),
    }
}

/// The ratio of the slopes on both sides of the sharpest kink of a compliant law between two gaps; 1 where it is smooth. Where contact begins is
/// no kink.
fn kink(law: &dyn NormalLaw, a: f64, b: f64) -> f64 {
    let slope = |gap: f64| law.pressure(gap).map_or(0.0, |p| -p.slope);
    let ratio = |a: f64, b: f64| {
        let (low, high) = (slope(a).min(slope(b)), slope(a).max(slope(b)));
        if low > 0.0 { high / low } else { 1.0 }
    };
    let (mut a, mut b) = (a, b);
    if !(a.is_finite() && b.is_finite()) || ratio(a, b) <= SLOPE_RATIO_OF_KINK {
        return 1.0;
    }
    // A smooth law has less and less of it in ever smaller intervals; a kink keeps all of it.
    for _ in 0..KINK_HALVINGS {
        let middle = 0.5 * (a + b);
        if ratio(a, middle) > ratio(middle, b) {
            b = middle;
        } else {
            a = middle;
        }
    }
    match ratio(a, b) {
        kept if kept > SLOPE_RATIO_OF_KINK => kept,
        _ => 1.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::law::normal::{Linear, NormalModel, PowerLaw, Tabular};
    use crate::registry::Family;

    #[test]
    fn a_kink_is_told_from_a_steep_curve() {
        let table = vec![[0.0, 0.0], [1e-6, 1e3], [2e-6, 1e6]];
        let kinked = NormalModel::Tabular(Tabular { table });
        let found = kink(kinked.as_dyn(), -0.2e-6, -1.9e-6);
        assert!((found / 999.0 - 1.0).abs() < 1e-6, "{found}");
        assert_eq!(kink(kinked.as_dyn(), -0.2e-6, -0.9e-6), 1.0);
        let samples = NormalModel::samples();
        for law in samples.iter().filter(|l| {
            matches!(
                l,
                NormalModel::PowerLaw(PowerLaw { .. }) | NormalModel::Linear(Linear { .. })
            )
        }) {
            assert_eq!(kink(law.as_dyn(), -1e-9, -1e-5), 1.0, "{law:?}");
            assert_eq!(kink(law.as_dyn(), 1e-5, -1e-5), 1.0, "{law:?}");
        }
    }
}

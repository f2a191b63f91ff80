//! What can be told of a model before it runs.

mod axles;
mod bolts;
mod cells;
mod common;
mod conditions;
mod curved;
mod driven;
mod friction;
mod gaps;
mod heat;
mod laws;
mod locking;
mod measured;
mod meshes;
mod motions;
mod normals;
mod relief;
mod schedules;
mod speeds;
mod strains;
mod surfaces;
mod turned;
mod unguided;
mod units;
mod unmoved;
mod unused;
mod wear;

pub use curved::WIDEST_CONTACT;
pub(super) use meshes::disconnected;
pub(crate) use wear::longest_way;

use super::finding::Finding;
use super::unjoined::MissingInterface;
use crate::assess::view::View;
use crate::contact::look;
use crate::contact::look::Opposite;
use crate::model::definition::Model;
use crate::model::scene::Scene;
use measured::{Measured, measure};

/// All findings about a model, given the gaps at its start by interface; worst first.
pub(crate) fn examine(view: &View, unjoined: &MissingInterface, gaps: &[Vec<f64>]) -> Vec<Finding> {
    let t = view.frame.state.t;
    let interfaces = view.contact.interfaces.iter().zip(gaps);
    let measured: Vec<Measured> = interfaces
        .map(|(interface, gaps)| measure(interface, gaps, t))
        .collect();
    let model = view.model;
    let mut out = roots(view);
    out.extend(disconnected(model));
    out.extend(motions::check(view, &measured));
    for (interface, measured) in view.contact.interfaces.iter().zip(&measured) {
        match normals::check(view, interface, measured) {
            // Gaps to a surface that looks the other way mean nothing.
            Some(finding) => out.push(finding),
            None => {
                let apart = speeds::apart(view, interface, measured);
                match apart {
                    // What is never in contact rubs on nothing and closes no gap.
                    Some(finding) => out.push(finding),
                    None => {
                        out.extend(gaps::check(view, interface, measured));
                        out.extend(friction::pressureless(view, interface, measured));
                    }
                }
                out.extend(strains::pressed(view, interface, measured));
                out.extend(meshes::check(view, interface, measured));
                out.extend(surfaces::check(view, interface));
                out.extend(curved::check(model, interface, t));
                out.extend(relief::check(model, interface));
                out.extend(unguided::check(view, interface));
            }
        }
        out.extend(friction::check(view, interface, measured));
        out.extend(wear::check(view, interface));
    }
    out.extend(conditions::check(view, &measured));
    out.extend(schedules::check(view));
    out.extend(super::released::check(view));
    out.extend(bolts::check(view));
    out.extend(axles::check(view));
    out.extend(heat::check(model));
    out.extend(unmoved::check(view));
    out.extend(unused::check(model));
    out.extend(unjoined.check(view));
    out.extend(strains::check(model));
    out.extend(turned::check(view, &measured));
    out.extend(locking::check(model));
    out.extend(units::check(model));
    out.sort_by_key(|f| std::cmp::Reverse(f.severity));
    out
}

/// The first interface whose sides do not face each other, as far as the state of the run shows.
pub(super) fn opposed(view: &View) -> Option<Finding> {
    let mut found = view.contacts().filter_map(|i| {
        let measured = measure(&i, &look::initial_gaps(i), view.frame.state.t);
        normals::check(view, &i, &measured)
    });
    found.next()
}

/// The first interface between two surfaces of one body whose material lies between them.
pub(super) fn same_body(view: &View) -> Option<Finding> {
    let t = view.frame.state.t;
    let interfaces = view.contact.interfaces.iter();
    let mut found = interfaces.filter_map(|i| {
        let mut opposite = Opposite::new(i, t);
        let gaps: Vec<f64> = (i.points.iter())
            .map(|p| opposite.nearest(p.position(&i.reference)))
            .map(|nearest| nearest.map_or(f64::INFINITY, |n| n.gap))
            .collect();
        normals::through(view, i, &measure(i, &gaps, t))
    });
    found.next()
}

/// Mistakes that may be why the iteration does not converge: sizes and numbers of single bodies that are those of no body, strains that are not small. Densities
/// are among them where bodies are `moving` or have weight.
pub(super) fn suspects(model: &Model, moving: bool) -> Vec<Finding> {
    let mut out = units::impossible(model, moving);
    out.extend(strains::check(model));
    out.extend(heat::strained(model));
    out
}

/// Mistakes that keep a system from being solved, whatever is done to solve it: cells, laws, surfaces that are joined twice, units of velocities.
pub(super) fn roots(scene: &Scene) -> Vec<Finding> {
    let model = scene.model;
    let mut out = cells::slivers(model);
    out.extend(laws::check(scene));
    out.extend(surfaces::doubled(scene));
    out.extend(speeds::fast(scene));
    out.extend(wear::fast(scene));
    out
}

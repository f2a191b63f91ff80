//! How fast the springs and dashpots of an interface let masses swing: what bounds explicit increments.

use crate::contact::interface::initial::TOUCHING;
use crate::contact::interface::sides::weights_of;
use crate::contact::interface::stiffness::spring;
use crate::contact::interface::{History, Interface};
use crate::system::Links;

/// An upper bound of the squared frequency `[1/s²]` that the springs of the interface have with these inverse masses by dof: by the
/// rows of its stiffness (Gershgorin). Springs that are not in contact count as well where they have a stiffness of their own. For
/// a rigid body the springs at all its points add up, each with what the body gives way there, `1/m + |arm|²/I` as inverse mass.
pub fn highest_frequency(
    interface: &Interface,
    state: &History,
    inverse_mass: &[f64],
    links: &Links,
) -> f64 {
    if interface.view(state).holds_exactly() {
        return 0.0;
    }
    let inverse = |node: usize| inverse_mass[interface.dofs.of(node, 0)];
    highest_eigenvalue(
        interface,
        &|i| stiffest(interface, state, i, links),
        &inverse,
        links,
    )
}

/// The same of compliant laws and springs alone, as they were pressed in the last evaluation, with inverse masses by point of the mesh: what is
/// held by multipliers has no frequency.
pub fn pressed_frequency(
    interface: &Interface,
    state: &History,
    inverse_mass: &[f64],
    links: &Links,
) -> f64 {
    if interface.view(state).unknown() && interface.laws.needs_normal_stiffness() {
        return 0.0;
    }
    let last = &interface.cache.last.points;
    let pressed = |i: usize| {
        last.get(i)
            .map_or(0.0, |e| e.response.d_gap[0][0] - e.response.d_rate[0])
    };
    highest_eigenvalue(
        interface,
        &|i| pressed(i).abs(),
        &|node| inverse_mass[node],
        links,
    )
}

/// An upper bound of the rate `[1/s]` at which what laws add with the velocity takes it away, in the same way.
pub fn highest_rate(interface: &Interface, inverse_mass: &[f64], links: &Links) -> f64 {
    let last = &interface.cache.last.points;
    let damping = interface.laws.damping.as_dyn();
    // A point about to touch.
    let touched = |i: usize| {
        let depth = TOUCHING * interface.points[i].size;
        let own = interface.laws.normal_law().pressure(-depth);
        own.map_or(interface.points[i].stiffness * depth, |p| p.value)
    };
    let viscosity = |i: usize| {
        let now = last.get(i).map_or(0.0, |e| e.viscosity);
        // No frequency bounds the step on the way to a dashpot.
        match damping.active() {
            true => now.max(damping.extra(touched(i), 0.0).d_rate),
            false => now,
        }
    };
    let inverse = |node: usize| inverse_mass[interface.dofs.of(node, 0)];
    highest_eigenvalue(interface, &viscosity, &inverse, links)
}

/// The spring of a point `[Pa/m]`: what there is, and what there will be when it touches.
fn stiffest(interface: &Interface, state: &History, i: usize, links: &Links) -> f64 {
    let point = &interface.points[i];
    let own = if interface.laws.needs_normal_stiffness() {
        spring(
            interface.view(state),
            &interface.attempt,
            interface.laws.enforcement.as_dyn().normal(),
            point.stiffness,
        )
    } else {
        0.0
    };
    let now = interface
        .cache
        .last
        .points
        .get(i)
        .map_or(0.0, |e| e.slope());
    // A rigid body has no cells whose frequency would bound the step on the way to a compliant surface.
    let rigid = |&node: &usize| links.of_point(interface.nodes[node]).is_some();
    let touched = || interface.laws.normal_law().pressure(-TOUCHING * point.size);
    let ahead = match point.nodes.iter().any(rigid) {
        true => -touched().map_or(0.0, |p| p.slope),
        false => 0.0,
    };
    own.max(now).max(ahead)
}

/// A bound of the largest eigenvalue of something per area at the points over the masses.
fn highest_eigenvalue(
    interface: &Interface,
    of: &dyn Fn(usize) -> f64,
    inverse_mass: &dyn Fn(usize) -> f64,
    links: &Links,
) -> f64 {
    let mut rows: Vec<f64> = vec![0.0; interface.nodes.len()];
    let sides = if interface.rigid() { 1.0 } else { 2.0 };
    for (i, point) in interface.points.iter().enumerate() {
        // Of a mortar less than the whole of a point may have something opposite.
        let whole = sides * point.area * of(i);
        if whole == 0.0 {
            continue;
        }
        for (node, w) in weights_of(interface, &interface.cache.last, i) {
            rows[node] += whole * w.abs();
        }
    }
    let mut highest = 0.0_f64;
    let mut rigid = vec![0.0; links.all().len()];
    for (k, &node) in rows.iter().zip(&interface.nodes) {
        let own = k * inverse_mass(node);
        match links.of_point(node) {
            None => highest = highest.max(own),
            Some(body) => rigid[body] += own,
        }
    }
    rigid.into_iter().fold(highest, f64::max)
}

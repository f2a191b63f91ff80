//! Loads that no forces of contact can balance, known before anything is solved.
//!
//! For bodies that move as wholes there is an equilibrium only if the loads along all free motions are a sum of forces in the cones of friction of the points that may
//! touch: a problem of linear inequalities in as many unknowns as there are free motions. Where there is no such sum, what is left of the loads is the motion
//! that nothing stops. Of contact the most is believed: every point meets what it faces, and friction is as large as it may be.

use super::doctor::{DoctorCause, FACING_COSINE, Finding, Opposite, Suspect, body_at, let_go};
use super::view::View;
use crate::contact::interface::{InterfaceDefinition, Primary};
use crate::contact::law::friction::FrictionPoint;
use crate::error::RunError;
use crate::friction::cone::Cone;
use crate::math::{
    Vec3, add, add_scaled, cross, distance, dot, norm, normalize, rest_of_nonnegative, vector,
};
use crate::model::rigid::drivers::named;
use crate::model::rigid::held::{NO_PART, Unheld};
use crate::model::rigid::modes::{Mode, modes};
use crate::model::rigid::{drivers, held};
use crate::number::digits;

/// Displacements and gaps over the size of the smallest body up to which points are where they were meshed. Tuned.
const UNMOVED: f64 = 1e-3;

/// Part by which friction is widened, as points move and surfaces bend a little. Tuned.
const WIDER_FRICTION: f64 = 1e-3;

/// The part that may be left where a figure is wanted as of the mesh. Tuned.
const EXACT_REST: f64 = 1e-7;

/// Coefficient of friction that counts as unlimited. No pair of surfaces has as much.
const UNLIMITED: f64 = 1e3;

/// Pressures, over the stiffness of the cells beneath, and speeds, in sizes of a cell in a unit of time, at which friction is asked for.
const PRESSURES: [f64; 4] = [1e-6, 1e-4, 1e-3, 1e-1];
const SPEEDS: [f64; 4] = [0.0, 1e-3, 1.0, 1e3];

/// Most motions, and most points, that are looked at.
const MOST_MOTIONS: usize = 60;
const MOST_POINTS: usize = 50_000;

/// Halvings by which a coefficient or a time is found.
const HALVINGS: usize = 20;

/// A place where contact may push, or the stop of a coupling.
struct Spot {
    /// The push and the directions across, as forces along the motions; none of a stop, which has no friction.
    normal: Vec<f64>,
    across: Vec<Vec<f64>>,
    /// The largest coefficient of friction.
    mu: f64,
}

/// What may hold free motions.
struct Holds {
    all: Vec<Mode>,
    motions: Vec<Unheld>,
    spots: Vec<Spot>,
    /// The largest coefficient at a spot.
    mu: f64,
    /// Whether surfaces touch as meshed.
    close: bool,
}

impl Holds {
    /// What is left of loads along the motions, if it is more than this part of them: friction is what it is made of the coefficient at each spot.
    fn rest(&self, loads: &[f64], friction: impl Fn(f64) -> f64, left: f64) -> Option<Vec<f64>> {
        let target: Vec<f64> = loads.iter().map(|f| -f).collect();
        let mut columns = Vec::new();
        for spot in &self.spots {
            let cone = Cone {
                limit: friction(spot.mu),
                skew: 0.0,
            };
            let edge = |corner: [f64; 2]| -> Vec<f64> {
                let mut out = spot.normal.clone();
                for (factor, across) in corner.into_iter().zip(&spot.across) {
                    out.iter_mut()
                        .zip(across)
                        .for_each(|(o, t)| *o += factor * t);
                }
                out
            };
            columns.extend(cone.corners(spot.across.len()).into_iter().map(edge));
        }
        let rest = rest_of_nonnegative(&columns, &target);
        (vector::norm(&rest) > left * vector::norm(&target)).then_some(rest)
    }
}

/// What ends a quasi-static step, or an attempt that failed, from one time to another: at its end no forces of contact can balance the loads.
pub(crate) fn refuse_unbalanced(view: &View, from: f64, to: f64) -> Option<(Finding, RunError)> {
    let holds = holds(view, to)?;
    let loads = |t: f64| -> Vec<f64> {
        let each = holds.motions.iter();
        each.map(|m| drivers::push(view, &holds.all, m, t).total)
            .collect()
    };
    let at_end = loads(to);
    // Of the loads 2e-3 may be left, as points move and surfaces bend a little; friction is wider by a thousandth for the same reason.
    let rest = holds.rest(
        &at_end,
        |mu| mu * (1.0 + WIDER_FRICTION) + WIDER_FRICTION,
        2e-3,
    )?;
    // What is left pushes against the loads.
    let mut motion = vec![0.0; holds.all.len()];
    for (part, own) in rest.iter().zip(&holds.motions) {
        motion.iter_mut().zip(own).for_each(|(m, o)| *m -= part * o);
    }
    let largest = motion
        .iter()
        .fold(f64::MIN_POSITIVE, |m, v| f64::max(m, v.abs()));
    motion.iter_mut().for_each(|v| *v /= largest);
    let (mut good, mut bad) = (from, to);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (good + bad);
        match holds.rest(&loads(middle), |mu| mu, EXACT_REST) {
            None => good = middle,
            Some(_) => bad = middle,
        }
    }
    if bad - from < UNMOVED * (to - from) {
        bad = from;
    }
    Some(say_unbalanced(
        view,
        &holds,
        &motion,
        to,
        bad,
        least(&holds, &at_end),
    ))
}

fn say_unbalanced(
    view: &View,
    holds: &Holds,
    motion: &Unheld,
    t: f64,
    first: f64,
    wanted: Option<f64>,
) -> (Finding, RunError) {
    let push = drivers::push(view, &holds.all, motion, t);
    let (body, what) = drivers::describe(view, &holds.all, motion);
    let by = named(&push.drivers(), "drives", "drive");
    let called = view.called();
    let index = view.model.bodies.iter().position(|b| b.name == body);
    let touches = holds.close || index.is_some_and(|b| view.touches(b));
    // What no friction would hold, and turns, is pressed beside what it lies on.
    let turns = holds.all.iter().zip(motion);
    let turns = turns
        .filter(|(_, part)| part.abs() > NO_PART)
        .any(|(mode, _)| mode.name.starts_with("rotation"));
    let (cause, sentence) = match touches {
        true if wanted.is_none() && turns => (
            DoctorCause::SlidesAway,
            format!("body {body} tips over or lifts off as a whole ({what})"),
        ),
        true => (
            DoctorCause::SlidesAway,
            format!("body {body} slides, rolls or lifts off as a whole ({what})"),
        ),
        false => (
            DoctorCause::FreeRigidMode,
            format!("body {body} is free to move as a rigid body ({what})"),
        ),
    };
    let friction = match wanted {
        Some(mu) => format!(
            "friction of {mu:.4} would hold it, {:.4} is the largest there is",
            holds.mu
        ),
        None => "no friction would hold it".to_string(),
    };
    let when = match first > view.frame.state.t {
        true => format!(" from {} on", digits(first, 6)),
        false => String::new(),
    };
    let message = format!(
        "{called}: there is no equilibrium{when}: {sentence}, {by} it, and contact and friction cannot balance that; {friction}"
    );
    let help = match touches {
        true if wanted.is_none() && turns => {
            "let the loads press within what the body lies on, or that reach farther, support the motion or hold it by weak springs (`[load.NAME] spring = { stiffness = [...] }`), \
             or make the step dynamic if the body is meant to tip"
        }
        true => {
            "lower what drives the body, raise friction, support the motion or hold it by weak springs (`[load.NAME] spring = { stiffness = [...] }`), \
             or make the step dynamic if the body is meant to slide or take off"
        }
        false => {
            "support these motions, hold them by weak springs (`[load.NAME] spring = { stiffness = [...] }`), or move the bodies until they touch"
        }
    };
    let drivers = push.drivers();
    let moved = holds.all.iter().zip(motion);
    let moved = moved.filter(|(_, part)| part.abs() > NO_PART);
    let moved: Vec<String> = moved
        .map(|(mode, _)| view.model.bodies[mode.body].name.clone())
        .collect();
    let gone = let_go(view, &moved);
    let first: String = gone.iter().map(|g| format!("{}; ", g.advice)).collect();
    let help = format!("{first}{help}");
    let mut finding = cause
        .error(message.clone())
        .blame(body_at(
            view.model,
            &body,
            format!("{what} is held by contact alone"),
        ))
        .advise(help.clone());
    let mut culprits = vec![format!("body {body}: {what} is held by contact alone")];
    for driver in drivers {
        culprits.push(format!("{} {}", driver.key, driver.what));
        finding = finding.blame(Suspect::key(driver.key, driver.what));
    }
    for gone in gone {
        culprits.push(format!("{} {}", gone.key, gone.what));
        finding = finding.blame(Suspect::key(gone.key, gone.what));
    }
    finding.step = Some(view.step_name().to_string());
    finding.time = Some(view.frame.state.t);
    let error = RunError {
        message,
        time: view.frame.state.t,
        culprits,
        help: Some(help),
    };
    (finding, error)
}

/// What may hold the motions that supports, springs and couplings leave free; `None` where there are none, or nothing certain can be said.
fn holds(view: &View, t: f64) -> Option<Holds> {
    let all = modes(view.model);
    let motions = held::unheld(view, t, &all, false);
    if motions.is_empty() || motions.len() > MOST_MOTIONS {
        return None;
    }
    let size = smallest_body(view);
    let moved = view.constraints(t);
    let moved = moved.fixed.iter().zip(&moved.values).filter(|(f, _)| **f);
    let moved = moved
        .map(|(_, v)| v.abs())
        .chain(view.frame.state.u.iter().map(|u| u.abs()));
    if moved.fold(0.0, f64::max) > UNMOVED * size {
        return None;
    }
    let mut holds = Holds {
        all,
        motions,
        spots: Vec::new(),
        mu: 0.0,
        close: false,
    };
    let interfaces = view.contact.interfaces.iter();
    for interface in interfaces.filter(|i| i.schedule.active(t) && !i.laws.tied) {
        let gap = spots(view, interface, t, &mut holds)?;
        if gap > UNMOVED * size {
            return None;
        }
        holds.close |= gap <= 1e-9 * size;
    }
    for row in view.couplings().stops(t) {
        let speed = |motion: &Unheld| -> f64 {
            let parts = holds.all.iter().zip(motion);
            parts.map(|(m, c)| c * m.along(view.model, row)).sum()
        };
        let normal = holds.motions.iter().map(speed).collect();
        holds.spots.push(Spot {
            normal,
            across: Vec::new(),
            mu: 0.0,
        });
    }
    (!holds.spots.is_empty()).then_some(holds)
}

/// The extent of the smallest body `[m]`.
fn smallest_body(view: &View) -> f64 {
    let bodies = view.model.bodies.iter().map(|b| {
        let points = &view.model.mesh.points[b.points.clone()];
        let first = points.first().copied().unwrap_or_default();
        points
            .iter()
            .map(|&x| distance(x, first))
            .fold(0.0, f64::max)
    });
    bodies.fold(f64::INFINITY, f64::min)
}

/// Adds the places of an interface where contact may push free motions; the smallest gap. `None` where that cannot be told.
fn spots(view: &View, interface: &InterfaceDefinition, t: f64, holds: &mut Holds) -> Option<f64> {
    let facing = match &interface.primary {
        Primary::Facets(facets) => Some(interface.nodes[facets.first()?.nodes[0]]),
        Primary::Rigid(..) => None,
    };
    let mu = largest_friction(interface)?;
    if interface.points.len() + holds.spots.len() > MOST_POINTS {
        return None;
    }
    let mut opposite = Opposite::new(interface, t);
    let mut gap = f64::INFINITY;
    for point in &interface.points {
        let Some(nearest) = opposite.nearest(point.position(&interface.reference)) else {
            continue;
        };
        if dot(nearest.normal, point.normal) >= FACING_COSINE {
            continue;
        }
        gap = gap.min(nearest.gap.abs());
        // Beside the primary nothing pushes; the farthest that contact may is its edge.
        let x = match opposite.edge(&nearest, point.position(&interface.reference)) {
            Some(edge) => add(edge, interface.origin),
            None => interface.place(point),
        };
        let own = interface.nodes[point.nodes[0]];
        let along = |d: Vec3| -> Vec<f64> {
            let speed = |motion: &Unheld| -> f64 {
                let parts = holds.all.iter().zip(motion);
                let parts = parts
                    .filter(|(_, c)| **c != 0.0)
                    .map(|(m, c)| m.relative(view.model, own, facing) * c * dot(d, m.velocity(x)));
                parts.sum()
            };
            holds.motions.iter().map(speed).collect()
        };
        let normal = along(nearest.normal);
        let across: Vec<Vec<f64>> = tangents(nearest.normal, interface.dofs.dim)
            .into_iter()
            .map(along)
            .collect();
        holds.mu = holds.mu.max(mu);
        holds.spots.push(Spot { normal, across, mu });
    }
    // Surfaces that do not face each other hold nothing yet.
    gap.is_finite().then_some(gap)
}

/// The coefficient of friction that would balance loads along the motions, if there is one.
fn least(holds: &Holds, loads: &[f64]) -> Option<f64> {
    if holds.rest(loads, |_| UNLIMITED, EXACT_REST).is_some() {
        return None;
    }
    let (mut low, mut high) = (0.0, UNLIMITED);
    for _ in 0..2 * HALVINGS {
        // Halvings of its size first.
        let middle = f64::midpoint(low, f64::min(high, 2.0 * low + 0.1));
        match holds.rest(loads, |_| middle, EXACT_REST) {
            Some(_) => low = middle,
            None => high = middle,
        }
    }
    Some(high)
}

/// Directions across a normal.
fn tangents(normal: Vec3, dim: usize) -> Vec<Vec3> {
    if dim == 2 {
        return vec![[-normal[1], normal[0], 0.0]];
    }
    let smallest = (0..3).min_by(|&a, &b| normal[a].abs().total_cmp(&normal[b].abs()));
    let mut axis = [0.0; 3];
    axis[smallest.unwrap_or(0)] = 1.0;
    let first = add_scaled(axis, -dot(axis, normal), normal);
    let first = normalize(first).unwrap_or(axis);
    debug_assert!(norm(first) > 0.0);
    vec![first, cross(normal, first)]
}

/// The largest coefficient of friction of an interface, whatever the pressure and speed; `None` where it is not known, or not limited by pressure.
fn largest_friction(interface: &InterfaceDefinition) -> Option<f64> {
    let law = interface.laws.friction_law();
    if interface.laws.user.any() || !law.states().is_empty() {
        return None;
    }
    if !law.frictional() {
        return Some(0.0);
    }
    if law.needs_penetration() {
        return None;
    }
    let point = interface.points.first()?;
    let mut most = 0.0_f64;
    for pressure in PRESSURES.map(|p| p * point.stiffness * point.size) {
        for speed in SPEEDS.map(|v| v * point.size) {
            for sticking in [true, false] {
                let limit = law.limit(&FrictionPoint {
                    speed,
                    sticking,
                    ..FrictionPoint::at_rest(law, pressure)
                });
                most = most.max(limit.value / pressure);
            }
        }
    }
    (most.is_finite() && most < UNLIMITED).then_some(most)
}

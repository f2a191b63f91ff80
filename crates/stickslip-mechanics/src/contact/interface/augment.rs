//! Updates of the multipliers between equilibrium solves.

use super::evaluation::Evaluations;
use super::input::InterfaceInput;
use super::parts::InterfaceForce;
use super::stiffness::own_stiffness;
use crate::contact::enforcement::Multipliers;
use crate::contact::response::Status;
use crate::math::{distance, larger, norm};
use crate::system::{Augmentation, Stage};

/// Moves the centres of an augmented Lagrangian to the multipliers, and tightens the enforcement where that gains little.
pub(super) fn update_multipliers(interface: &mut InterfaceForce, stage: &Stage) -> Augmentation {
    let Multipliers::Augmented { error } = interface.laws.enforcement.as_dyn().multipliers() else {
        return Augmentation::Done;
    };
    let approach = elastic_approach(interface.input(), &interface.cache.last, stage);
    let worst = centre(interface);
    let largest = interface.cache.geometry.search.at().iter();
    let largest = largest.chain(&interface.reference);
    let largest = largest.map(|&x| norm(x)).fold(0.0, f64::max);
    // A violation below 16 roundings of the largest coordinate is none.
    if worst <= (error * approach).max(16.0 * f64::EPSILON * largest) {
        return Augmentation::Done;
    }
    // An update that gains little says that the stiffness is low for what presses on it.
    let attempt = &mut interface.attempt;
    if attempt
        .violation
        // An update of the multipliers may leave this part of a violation before the enforcement is tightened.
        .is_some_and(|before| worst > 0.1 * before)
    {
        attempt.tightened += 1;
    }
    attempt.violation = Some(worst);
    Augmentation::Again(worst / (error * approach).max(f64::MIN_POSITIVE))
}

/// What violations, which are lengths, are compared with: the compression of one layer of cells under the largest pressure, or the way that the
/// pressure moves the mass of a point over the increment `[m]`.
fn elastic_approach(interface: InterfaceInput, last: &Evaluations, stage: &Stage) -> f64 {
    let moving = stage.rate.map(|_| stage.dt);
    (last.points.iter().enumerate())
        .map(|(i, e)| {
            let [p, t1, t2] = e.response.traction;
            let largest = if interface.laws.tied {
                p.abs().max(t1.hypot(t2))
            } else {
                p
            };
            largest / own_stiffness(interface, i, moving)
        })
        .fold(0.0, f64::max)
}

/// Makes the multipliers the centres of the next round; the largest length by which that moves them `[m]`.
fn centre(interface: &mut InterfaceForce) -> f64 {
    let mut worst: f64 = 0.0;
    let multipliers = interface.attempt.multipliers.iter_mut();
    for (m, e) in multipliers.zip(&interface.cache.last.points) {
        let r = &e.response;
        // A point that carries nothing has no stiffness either: what does not change is no violation.
        let change = (r.traction[0] - m.centre_pressure).abs();
        if e.stiffness[0].is_finite() && change != 0.0 {
            worst = larger(worst, change / e.stiffness[0]);
        }
        let shear = e.along(&e.frames.before);
        let change = distance(shear, m.centre_shear);
        if r.status == Status::Stick && e.stiffness[1].is_finite() && change != 0.0 {
            worst = larger(worst, change / e.stiffness[1]);
        }
        m.centre_pressure = r.traction[0];
        m.centre_shear = shear;
        m.centre_normal = e.frames.normal_before;
    }
    worst
}

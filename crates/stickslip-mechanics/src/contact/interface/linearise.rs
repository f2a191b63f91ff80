//! What small motions about an accepted state meet at each contact point.

use super::cache::Geometry;
use super::evaluation::{Batch, Evaluation};
use super::input::InterfaceInput;
use super::parts::InterfaceForce;
use super::pass::evaluate_all;
use super::scene::Wants;
use crate::contact::enforcement::{Multipliers, condensed_slope, inverse_of_rows};
use crate::contact::response::Status;
use crate::math::{Mat3, Vec3, add};
use crate::system::{Force, Stage};

/// Stiffness that stands for a constraint, relative to that of the bodies beside it: what it gives is a part of about its inverse of what a cell gives, and rounding
/// of displacements leaves as many digits more than it as are wanted of frequencies.
const CONSTRAINT_STIFFNESS: f64 = 1e5;

/// A contact point that carries something, linearised: small displacements and velocities `x`, `v` of its dofs meet the force `-Rᵀ (K R x + C R v)`, with the
/// gradients `R` of the gap and of the two components of slip.
#[derive(Debug, Clone, PartialEq)]
pub struct LinearPoint {
    /// Its number in the interface.
    pub point: usize,
    /// Stick or slip.
    pub status: Status,
    /// Whether it slides all the time, so that friction has a direction.
    pub steady: bool,
    /// Dofs on which it acts.
    pub dofs: Vec<usize>,
    /// Gradients, row by row, shape `(3, n)`.
    pub rows: Vec<f64>,
    /// `K` `[N/m]`: pressure in the first row, shear in the others. Of a point that slides the first column alone.
    pub stiffness: Mat3,
    /// `C` `[N s/m]`: how shear turns with the direction of sliding and follows its speed, and what damps the approach.
    pub damping: Mat3,
    /// Place `[m]`.
    pub position: Vec3,
    /// Area it stands for `[m²]`.
    pub area: f64,
    /// Pressure `[Pa]`.
    pub pressure: f64,
    /// Largest shear traction in the direction of the shear `[Pa]`.
    pub limit: f64,
}

/// All points that carry something at a stage that goes nowhere, from the accepted state to itself.
///
/// Points that slide have no stiffness along the surface, also those that slid in the last increment of a step that was not steady; what sticks has all of
/// it. Constraints that multipliers hold exactly are as stiff as rounding allows. How gradients turn with displacements is left out: that is of the size of
/// pressure over modulus.
pub fn linearise(interface: &mut InterfaceForce, stage: &Stage) -> Vec<LinearPoint> {
    if !interface.schedule.active(stage.at.t) {
        return Vec::new();
    }
    interface.prepare(stage);
    interface.begin();
    // What just touches carries nothing.
    interface.attempt.before_first_contact = false;
    let wants = Wants {
        tangent: true,
        ..Wants::default()
    };
    let (input, cache) = interface.parts();
    evaluate_all(input, cache, stage, wants);
    let (evaluations, geometry) = (&cache.trial, &cache.geometry);
    let points = evaluations.points.iter().enumerate();
    let lines =
        points.filter_map(|(i, e)| line(input, i, e, evaluations.batch(i), geometry, stage.dt));
    lines.collect()
}

fn line(
    interface: InterfaceInput,
    i: usize,
    e: &Evaluation,
    batch: &Batch,
    geometry: &Geometry,
    dt: f64,
) -> Option<LinearPoint> {
    let tangent = batch.tangent(e)?;
    let status = match interface.laws.tied {
        true => Status::Stick,
        false => e.response.status,
    };
    // Surfaces that have just separated are open: rounding of the gap or of the pressure would count them as closed.
    let (before, point) = (interface.state.points[i].status, &interface.points[i]);
    // A pressure that strains the cell beneath a point by no more than this is rounding: some hundred times the relative rounding of a
    // strain of one.
    let rounding = 1e-13 * point.stiffness * point.size;
    let open = before == Status::Open || e.response.traction[0] <= rounding;
    let parted = interface.state.acting && !interface.laws.tied && open;
    if status == Status::Open || parted {
        return None;
    }
    let slid = !interface.laws.tied && before == Status::Slip;
    let (stiffness, damping) = stiffness_and_damping(interface, i, e, slid, dt);
    let (mut dofs, mut rows) = (batch.dofs(e).to_vec(), tangent.rows.to_vec());
    geometry.in_space.gradients(&mut dofs, &mut rows);
    Some(LinearPoint {
        point: i,
        status: if slid { Status::Slip } else { status },
        steady: e.steady,
        dofs,
        rows,
        stiffness,
        damping,
        position: add(interface.origin, interface.points[i].position(&geometry.x)),
        area: e.area,
        pressure: e.response.traction[0],
        limit: e.response.limit_along(),
    })
}

/// Stiffness and damping of a point `[N/m, N s/m]`.
fn stiffness_and_damping(
    interface: InterfaceInput,
    i: usize,
    e: &Evaluation,
    slid: bool,
    dt: f64,
) -> (Mat3, Mat3) {
    let r = &e.response;
    let d = match interface.unknown() {
        true => condensed_slope(&inverse_of_rows(&r.d_multiplier), &r.d_gap),
        false => r.d_gap,
    };
    let [normal, tangential] = firmness(interface, i, e);
    // Of the slope against the gap that part which is there because the approach is damped.
    let damped = match d[0][0] {
        0.0 => 0.0,
        slope => r.d_rate[0] / slope,
    };
    let (mut stiffness, mut damping) = ([[0.0; 3]; 3], [[0.0; 3]; 3]);
    for q in 0..3 {
        stiffness[q][0] = -e.area * normal * (1.0 - damped) * d[q][0];
        damping[q][0] = -e.area * dt * damped * d[q][0];
        for j in 1..3 {
            match e.steady {
                true => damping[q][j] = -e.area * dt * d[q][j],
                false if slid => {}
                false => stiffness[q][j] = -e.area * tangential * d[q][j],
            }
        }
        // Friction of what slid without a direction that lasts does not follow the pressure either.
        if q > 0 && !e.steady && !interface.laws.tied {
            stiffness[q][0] = 0.0;
            damping[q][0] = 0.0;
        }
    }
    (stiffness, damping)
}

/// By how much more the constraints against penetration and slip are to hold than they do.
fn firmness(interface: InterfaceInput, i: usize, e: &Evaluation) -> [f64; 2] {
    let exact = matches!(
        interface.laws.enforcement.as_dyn().multipliers(),
        Multipliers::Augmented { .. }
    );
    let own = interface.points[i].stiffness;
    let more = |needed: bool, stiffness: f64| match needed && exact && stiffness.is_finite() {
        true => (CONSTRAINT_STIFFNESS * own / stiffness).max(1.0),
        false => 1.0,
    };
    [
        more(interface.laws.needs_normal_stiffness(), e.stiffness[0]),
        more(interface.laws.needs_tangential_stiffness(), e.stiffness[1]),
    ]
}

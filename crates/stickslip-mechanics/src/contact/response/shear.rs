//! The tangential part of a response.

use super::input::LawInput;
use super::laws::Laws;
use super::outcome::{Response, Status};
use crate::contact::kinematics::Stencil;
use crate::contact::law::friction::{FrictionPoint, Limit};
use crate::contact::law::slip::{SlipRule, SlipState, Tangential};

/// The part of the multiplier that its row keeps; zero where multipliers are no unknowns.
fn kept(at: &LawInput) -> f64 {
    if at.kept.unknown && at.stiffness.tangential.is_finite() {
        1.0 - at.stiffness.weight / at.stiffness.tangential
    } else {
        0.0
    }
}

/// The motion as the slip rule sees it.
fn tangential(stencil: &Stencil, at: &LawInput, keep: f64) -> Tangential {
    let (stiffness, base) = match at.kept.unknown {
        true => (
            at.stiffness.weight,
            [1, 2].map(|i| keep * at.kept.multiplier[i] + (1.0 - keep) * at.kept.centre[i]),
        ),
        false => (at.stiffness.tangential, at.kept.shear),
    };
    Tangential {
        slip: at.slip.seen,
        dt: at.dt,
        stiffness,
        base,
        skew: stencil.skew,
        ellipse: at.ellipse,
        slack: at.slip.slack,
    }
}

/// The shear of a point that slides all the time, at the limit against its motion: `-limit s/|s|`, or what belongs to it on an ellipse. How it turns with the motion shows at once, as nothing elastic is
/// in between.
fn sliding(limit: f64, motion: &Tangential) -> SlipState {
    let cone = motion.cone(limit);
    let against = cone.against(motion.slip.map(|s| -s));
    if against.size <= 0.0 {
        return SlipState::default();
    }
    let slips = cone.boundary(&against, -1.0);
    SlipState {
        traction: slips.shear,
        d_slip: slips.d_motion,
        d_limit: slips.d_limit,
        d_skew: slips.d_skew,
        sliding: true,
        sliding_path: motion.slip,
    }
}

/// Iterations by which the way of a point that flows is found to rounding: halvings of 700 units of its logarithm, at worst.
const FLOW_ITERATIONS: usize = 80;

/// The shear of a point that slides under any shear, by a spring in series: `limit(s) + k s = |t*|` with the trial `t* = base - k slip` is solved for the way `s` that the
/// spring does not take. Rising and smooth in the trial, its slope between that of the spring and none, whatever the law: Newton's method over all points has no steeper
/// function to follow. The limit that is returned holds along that line, with no speed left to depend on.
fn flowing(limit: impl Fn(f64) -> Limit, motion: &Tangential) -> (Limit, SlipState) {
    let (k, dt) = (motion.stiffness, motion.dt);
    let trial = [0, 1].map(|i| motion.base[i] - k * motion.slip[i]);
    let size = motion.length(trial);
    let (way, found) = flow(&limit, size, motion);
    // By how much of a change of the trial the limit changes, and how much of a change of the law is left of it.
    let rising = (found.d_speed / dt).max(-0.5 * k);
    let (by_trial, by_law) = (rising / (k + rising), k / (k + rising));
    let along = Limit {
        d_pressure: by_law * found.d_pressure,
        d_penetration: by_law * found.d_penetration,
        d_speed: 0.0,
        ..found
    };
    if size == 0.0 {
        let own = -k * by_trial;
        let shear = SlipState {
            d_slip: [[own, 0.0], [0.0, own]],
            ..SlipState::default()
        };
        return (along, shear);
    }
    let cone = motion.cone(found.value);
    let slips = cone.boundary(&cone.radial(trial), -k);
    let toward = motion.length_slope(trial, size);
    let mut d_slip = slips.d_motion;
    for (row, direction) in d_slip.iter_mut().zip(slips.d_limit) {
        for (d, toward) in row.iter_mut().zip(toward) {
            *d -= k * by_trial * direction * toward;
        }
    }
    // d|t*|/dskew = t*₁ t*₂ / |t*|
    let d_size = trial[0] * trial[1] / size;
    let shear = SlipState {
        traction: slips.shear,
        d_slip,
        d_limit: slips.d_limit,
        d_skew: [0, 1].map(|i| slips.d_skew[i] + slips.d_limit[i] * by_trial * d_size),
        sliding: true,
        sliding_path: trial.map(|t| -way * t / size),
    };
    (along, shear)
}

/// The way of a point that flows, and the limit there. It is looked for by its logarithm, as it may be of any size.
fn flow(limit: &impl Fn(f64) -> Limit, size: f64, motion: &Tangential) -> (f64, Limit) {
    let (k, dt) = (motion.stiffness, motion.dt);
    let rest = |way: f64| {
        let at = limit(way);
        (at.value + k * way - size, at.d_speed / dt + k, at)
    };
    // It goes no farther than the spring would without friction, and to no more digits than the traction has.
    let (mut low, mut high) = (f64::MIN_POSITIVE.ln(), (size / k).ln());
    if !high.is_finite() || high <= low {
        return (0.0, limit(0.0));
    }
    // Newton's method starts from the right end of the interval.
    let mut log = high;
    for _ in 0..FLOW_ITERATIONS {
        let way = log.exp();
        let (off, slope, at) = rest(way);
        match off > 0.0 {
            true => high = log,
            false => low = log,
        }
        let newton = log - off / (slope * way);
        let next = match newton > low && newton < high {
            true => newton,
            false => 0.5 * (low + high),
        };
        if off.abs() <= f64::EPSILON * size || (next - log).abs() <= f64::EPSILON * log.abs() {
            return (way, at);
        }
        log = next;
    }
    let way = log.exp();
    (way, limit(way))
}

/// By how much a sliding path gets longer with the pressure, of which the limit grows by `d_limit`, and with the slips. Of a rule with a `spring` the path is what
/// the spring does not take.
fn lengthens(shear: &SlipState, motion: &Tangential, d_limit: f64, spring: bool) -> [f64; 3] {
    let length = motion.length(shear.sliding_path);
    if length == 0.0 {
        return [0.0; 3];
    }
    let yields = if spring { 1.0 / motion.stiffness } else { 0.0 };
    let toward = motion.length_slope(shear.sliding_path, length);
    let along = |way: [f64; 2]| toward[0] * way[0] + toward[1] * way[1];
    let taken = |j: usize| along([0, 1].map(|i| yields * shear.d_slip[i][j]));
    [
        along(shear.d_limit.map(|d| yields * d * d_limit)),
        toward[0] + taken(0),
        toward[1] + taken(1),
    ]
}

/// What a friction law is asked, of a point that has come this way.
pub(super) fn friction_point(
    stencil: &Stencil,
    at: &LawInput,
    pressure: f64,
    path: f64,
) -> FrictionPoint {
    FrictionPoint {
        pressure: pressure.max(0.0),
        penetration: (-stencil.gap - at.worn.depth(pressure)).max(0.0),
        speed: path / at.dt,
        speed_at_end: at.slip.path.is_some(),
        sticking: at.sticking,
        dt: at.dt,
        state: at.state,
        place: at.place,
    }
}

/// The largest shear that may be carried.
fn limit(laws: &Laws, stencil: &Stencil, at: &LawInput, pressure: f64, path: f64) -> Limit {
    let asked = || {
        let point = friction_point(stencil, at, pressure, path);
        laws.friction_law().limit(&point)
    };
    let mut limit = at.answers.limit.unwrap_or_else(asked);
    if pressure < 0.0 {
        limit.d_pressure = 0.0;
    }
    limit
}

/// The tangential part, added to a response with pressure.
pub(super) fn shear(laws: &Laws, stencil: &Stencil, at: &LawInput, response: &mut Response) {
    let keep = kept(at);
    let motion = tangential(stencil, at, keep);
    let path = motion.length(motion.slip);
    let rule: &dyn SlipRule = laws.slip.as_dyn();
    let flows = laws.friction_law().flows() && !at.pressed && !at.slip.steady;
    let (limit, shear) = match flows {
        true => {
            let law = |path: f64| limit(laws, stencil, at, response.traction[0], path);
            flowing(law, &motion)
        }
        false => {
            let limit = limit(laws, stencil, at, response.traction[0], path);
            let shear = match (at.pressed, at.slip.sprung) {
                (true, _) => rule.stuck(limit.value, &motion),
                _ if at.slip.steady && rule.sticks() => sliding(limit.value, &motion),
                (false, true) => rule.sprung(limit.value, &motion),
                (false, false) => rule.traction(limit.value, &motion),
            };
            (limit, shear)
        }
    };
    response.limit = limit.value;
    response.ellipse = at.ellipse;
    response.state = limit.state;
    response.sliding_path = at.slip.path.unwrap_or(shear.sliding_path);
    if shear.sliding {
        response.status = Status::Slip;
    }
    // penetration = -gap where closed
    let d_penetration = if stencil.gap + at.worn.depth(response.traction[0]) < 0.0 {
        limit.d_penetration * (1.0 + at.worn.slope * response.d_gap[0][0])
    } else {
        0.0
    };
    let d_limit_gap = limit.d_pressure * response.d_gap[0][0] - d_penetration;
    response.d_limit = match response.d_gap[0][0] {
        0.0 => limit.d_pressure,
        slope => d_limit_gap / slope,
    };
    let toward = if path > 0.0 && limit.d_speed != 0.0 {
        motion.length_slope(motion.slip, path)
    } else {
        [0.0; 2]
    };
    response.d_path = match at.slip.path {
        None => lengthens(
            &shear,
            &motion,
            response.d_limit,
            rule.sticks() || at.slip.sprung,
        ),
        Some(_) => [0.0; 3],
    };
    for i in 0..2 {
        let d_limit = shear.d_limit[i];
        response.traction[i + 1] = shear.traction[i];
        response.d_gap[i + 1][0] = d_limit * d_limit_gap;
        response.d_skew[i + 1] = shear.d_skew[i];
        response.d_multiplier[i + 1][0] = d_limit * limit.d_pressure * response.d_multiplier[0][0];
        // slip over the increment is the speed that the limit depends on, and that of a rule without a spring
        let own = match rule.sticks() || at.slip.sprung {
            true => 0.0,
            false => shear.d_slip[i][i],
        };
        response.d_rate[i + 1] = own + d_limit * limit.d_speed * toward[i] / at.dt;
        for (j, toward) in toward.iter().enumerate() {
            response.d_gap[i + 1][j + 1] =
                shear.d_slip[i][j] + d_limit * limit.d_speed * toward / at.dt;
            if keep != 0.0 && (rule.sticks()) && !at.slip.steady {
                // the trial traction is keep Σ_t + … - r s
                response.d_multiplier[i + 1][j + 1] =
                    -keep * shear.d_slip[i][j] / at.stiffness.weight;
            }
        }
    }
}

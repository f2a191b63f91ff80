//! From gap and slip to traction, in the frame of a stencil: normal law × friction law × slip rule × enforcement.

use super::input::LawInput;
use super::laws::Laws;
use super::outcome::{Response, Status};
use crate::contact::enforcement::pressure;
use crate::contact::kinematics::Stencil;
use crate::contact::law::friction::FrictionPoint;
use crate::contact::law::normal::NormalLaw;
use crate::contact::law::slip::Tangential;
use crate::contact::response::shear;
use crate::math::Slope;

/// Gap and slip tied to zero, in tension too.
fn tie(stencil: &Stencil, at: &LawInput) -> Response {
    let mut response = Response {
        status: Status::Stick,
        limit: f64::INFINITY,
        ..Response::default()
    };
    let moved = [stencil.gap - at.rest, at.slip.seen[0], at.slip.seen[1]];
    let carried = [0.0, at.kept.shear[0], at.kept.shear[1]];
    for q in 0..3 {
        let stiffness = match q {
            0 => at.stiffness.normal,
            _ => at.stiffness.tangential,
        };
        let (stiffness, base) = if at.kept.unknown {
            let keep = 1.0 - at.stiffness.weight / stiffness;
            response.d_multiplier[q][q] = keep;
            let base = keep * at.kept.multiplier[q] + (1.0 - keep) * at.kept.centre[q];
            (at.stiffness.weight, base)
        } else {
            (stiffness, carried[q])
        };
        response.traction[q] = base - stiffness * moved[q];
        response.d_gap[q][q] = -stiffness;
    }
    response
}

/// Penetrations of a body `[m]` among whose pressures one is looked for.
const PENETRATIONS: [f64; 2] = [1e-18, 1e6];

/// What the line says at a gap that touches a law where it is as stiff as the body, or as stiff as it ever gets; `body` is in Pa/m.
fn under_load(law: &dyn NormalLaw, gap: f64, body: f64) -> Slope {
    let [mut low, mut high] = PENETRATIONS.map(|depth| depth * body);
    while high > 2.0 * low {
        let middle = (low * high).sqrt();
        // the slope of the inverse law is negative, or not finite where the law ends
        if -law.gap(middle).slope * body > 1.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    let touched = law.gap(low);
    let slope = 1.0 / touched.slope;
    Slope {
        value: low + slope * (gap - touched.value),
        slope,
    }
}

/// A pressure that falls along a straight line with a gap that itself opens by `worn` times the pressure.
fn in_series(p: Slope, worn: f64) -> Slope {
    let part = 1.0 / (1.0 - p.slope * worn);
    Slope {
        value: part * p.value,
        slope: part * p.slope,
    }
}

/// Solves `p = P(gap + worn p)`: what is worn off over the increment is a compliance in series with the law `P`.
fn yielding(law: impl Fn(f64) -> Slope, gap: f64, worn: f64) -> Slope {
    let first = law(gap);
    if worn == 0.0 || first.value <= 0.0 {
        return first;
    }
    // p - P(gap + worn p) rises with p.
    let (mut low, mut high, mut p) = (0.0, first.value, first.value);
    let mut found = first;
    for _ in 0..100 {
        found = law(gap + worn * p);
        let rest = p - found.value;
        match rest > 0.0 {
            true => high = p,
            false => low = p,
        }
        let newton = p - rest / (1.0 - found.slope * worn);
        let next = match newton > low && newton < high {
            true => newton,
            false => 0.5 * (low + high),
        };
        let settled = (next - p).abs() <= 1e-15 * p;
        p = next;
        if settled {
            break;
        }
    }
    Slope {
        value: p,
        slope: found.slope / (1.0 - found.slope * worn),
    }
}

/// Evaluates the laws at a stencil.
///
/// Where multipliers are unknowns the traction returned is what the multipliers `Σ` have to equal,
/// `Σ = P(Σ - r C)`: `P` cuts off tension and shear beyond the limit, `C_n = g + (Σ_n - λ_n)/ω` (with λ = 0 the paper's
/// `G - Σ/ω`, whose `Σ_n` is negative in compression) and `C_t = s + (Σ_t - λ_t)/ω`. In contact and stick this is `C = 0` whatever the weight `r`;
/// a weight of the order of the bodies' stiffness makes status change when multiplier and gap together say so, where `ω` would
/// send points from slip in one direction to slip in the other.
pub fn respond(laws: &Laws, stencil: &Stencil, at: &LawInput) -> Response {
    let unknown = at.kept.unknown;
    if laws.tied {
        return tie(stencil, at);
    }
    let mut response = press(laws, stencil.gap + at.worn.base - at.rest, at, unknown);
    let pressure = response.traction[0];
    let friction = laws.friction_law();
    let pressed = pressure > 0.0 || at.pressed;
    if pressed {
        response.status = if friction.frictional() {
            Status::Stick
        } else {
            Status::Slip
        };
    } else if at.stiffness.first_contact > 0.0 {
        let sides = if friction.frictional() { 3 } else { 1 };
        for i in 0..sides {
            response.d_gap[i][i] = -at.stiffness.first_contact;
        }
    }
    if !friction.frictional() || !pressed {
        return response;
    }
    shear::shear(laws, stencil, at, &mut response);
    response
}

/// The normal part: pressure and its derivatives.
fn press(laws: &Laws, gap: f64, at: &LawInput, unknown: bool) -> Response {
    let normal = laws.normal_law();
    let set_valued = || at.answers.pressure.is_none() && normal.pressure(gap).is_none();
    let mut response = Response::default();
    if unknown && set_valued() {
        let keep = 1.0 - at.stiffness.weight / at.stiffness.normal;
        let p = keep * at.kept.multiplier[0] + (1.0 - keep) * at.kept.centre[0]
            - at.stiffness.weight * gap;
        if p > 0.0 || at.pressed {
            let part = 1.0 / (1.0 + at.stiffness.weight * at.worn.slope);
            response.traction[0] = part * p;
            response.d_gap[0][0] = -part * at.stiffness.weight;
            response.d_multiplier[0][0] = part * keep;
        }
        return response;
    }
    if at.pressed && set_valued() {
        response.traction[0] = -at.stiffness.normal * gap;
        response.d_gap[0][0] = -at.stiffness.normal;
        return response;
    }
    let p = match at.answers.pressure {
        // It was asked once, at the gap before anything is worn off.
        Some(p) => in_series(p, at.worn.slope),
        None => yielding(
            |gap| pressure(normal, gap, at.stiffness.normal),
            gap,
            at.worn.slope,
        ),
    };
    // A law with a smaller slope, relative to the stiffness of the body, is hardly touched.
    let loose = -p.slope < 1e-3 * at.stiffness.weight;
    let p = match at.pressed && loose {
        true => under_load(normal, gap, at.stiffness.weight),
        false => p,
    };
    response.traction[0] = p.value;
    response.d_gap[0][0] = p.slope;
    damp(laws, at, &mut response);
    response
}

/// Adds what damping does to a pressure that follows from the gap. Surfaces do not pull: what would is cut off.
fn damp(laws: &Laws, at: &LawInput, response: &mut Response) {
    let damping = laws.damping.as_dyn();
    let elastic = response.traction[0];
    if !damping.active() || elastic <= 0.0 {
        return;
    }
    let extra = damping.extra(elastic, at.closing);
    if elastic + extra.value <= 0.0 {
        response.damping = -elastic;
        response.traction[0] = 0.0;
        response.d_gap[0][0] = 0.0;
        return;
    }
    response.damping = extra.value;
    response.traction[0] += extra.value;
    // the closing velocity falls with the gap
    response.d_rate[0] = -extra.d_rate / at.dt;
    response.d_gap[0][0] = response.d_gap[0][0] * (1.0 + extra.d_pressure) + response.d_rate[0];
}

/// What a friction law is asked at a stencil, if it is; `at` tells the pressure where the normal law is the program's own.
pub fn question(laws: &Laws, stencil: &Stencil, at: &LawInput) -> Option<FrictionPoint> {
    if laws.tied || !laws.friction_law().frictional() {
        return None;
    }
    let pressure = press(
        laws,
        stencil.gap + at.worn.base - at.rest,
        at,
        at.kept.unknown,
    )
    .traction[0];
    let motion = Tangential {
        skew: stencil.skew,
        ..Tangential::default()
    };
    let path = motion.length(at.slip.seen);
    (pressure > 0.0 || at.pressed).then(|| shear::friction_point(stencil, at, pressure, path))
}

#[cfg(test)]
mod tests {
    use super::{under_load, yielding};
    use crate::contact::enforcement::pressure;
    use crate::contact::law::normal::NormalModel;
    use crate::registry::Family;

    #[test]
    fn a_law_under_load_is_the_line_that_touches_it_where_it_is_about_as_stiff_as_the_body() {
        for model in NormalModel::samples() {
            let law = model.as_dyn();
            if law.pressure(0.0).is_none() {
                continue;
            }
            let body = 1e12;
            let [near, far] = [0.0, 1e-3].map(|gap| under_load(law, gap, body));
            let slope = near.slope;
            assert!(slope < 0.0 && far.slope == slope, "{model:?}");
            // The line goes through the law where it has that slope.
            let gap = (0..2000)
                .map(|k| -1e-2 * 0.97_f64.powi(k))
                .chain((0..2000).map(|k| 1e-3 * 0.97_f64.powi(k)))
                .min_by(|a, b| {
                    let off = |gap: &f64| {
                        let p = law.pressure(*gap).expect("a pressure");
                        (p.value - near.value - slope * gap).abs() / (p.value + 1e-3 * body * 1e-6)
                    };
                    off(a).total_cmp(&off(b))
                });
            let touched = law.pressure(gap.expect("a gap")).expect("a pressure");
            let stiff = -touched.slope / -slope;
            assert!((0.3..3.0).contains(&stiff), "{model:?}: {stiff}");
        }
    }

    #[test]
    fn what_is_worn_off_opens_the_gap_under_every_law() {
        for model in NormalModel::samples() {
            let law = model.as_dyn();
            let Some(scale) = [1e-9, 1e-8, 1e-7, 1e-6, 1e-5]
                .into_iter()
                .find(|&d| pressure(law, -d, 1e14).value > 1e5)
            else {
                panic!("{model:?} carries nothing");
            };
            for gap in [-scale, -0.3 * scale] {
                for worn in [1e-18, 1e-14, 1e-11] {
                    let at = |gap: f64| yielding(|g| pressure(law, g, 1e14), gap, worn);
                    let p = at(gap);
                    let opened = pressure(law, gap + worn * p.value, 1e14);
                    assert!(
                        (opened.value - p.value).abs() <= 1e-8 * p.value,
                        "{model:?} {worn}: {p:?} {opened:?}"
                    );
                    let d = 1e-5 * scale;
                    let slope = (at(gap + d).value - at(gap - d).value) / (2.0 * d);
                    assert!(
                        (p.slope - slope).abs() <= 1e-4 * slope.abs(),
                        "{model:?} {worn}: {} {slope}",
                        p.slope
                    );
                }
            }
        }
    }
}

//! Friction that depends on the direction: the shape of the set of admissible shear.

use serde::{Deserialize, Serialize};

/// How a point slips whose shear is on the boundary of an ellipse.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum SlipDirection {
    /// Along the normal of the ellipse, as of all admissible shear that which dissipates most. For a slip direction `d` the shear is
    /// `-p (μ₁² d₁, μ₂² d₂) / √(μ₁² d₁² + μ₂² d₂²)`.
    #[default]
    Associated,
    /// Against the shear: for a slip direction `d` it is `-p d / √((d₁/μ₁)² + (d₂/μ₂)²)`.
    AgainstTraction,
}

/// The shape of an ellipse of admissible shear, in a contact frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ellipse {
    /// Half axes over the limit, between 0 and 1; the larger one is 1.
    pub half: [f64; 2],
    /// Angle of the first axis from the first direction of the frame, towards the second `[rad]`.
    pub angle: f64,
    /// The direction of slip.
    pub flow: SlipDirection,
}

/// The principal point nearest to a trial, with its derivatives.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Nearest {
    pub shear: [f64; 2],
    /// Derivative with respect to the trial, row: shear.
    pub d_trial: [[f64; 2]; 2],
    pub d_limit: [f64; 2],
    /// Whether the limit is reached.
    pub slides: bool,
}

/// Most steps for the one equation of a nearest point: with halvings to rounding.
const MOST_STEPS: usize = 100;

impl Ellipse {
    /// What turns components in a frame with this skew into those along the axes of the ellipse, its inverse, and its derivative with respect to the skew.
    pub(super) fn axes(&self, skew: f64) -> [[[f64; 2]; 2]; 3] {
        let (sine, cosine) = self.angle.sin_cos();
        let across = (1.0 - skew * skew).sqrt();
        let lean = skew / across;
        [
            [
                [cosine, cosine * skew + sine * across],
                [-sine, cosine * across - sine * skew],
            ],
            [
                [cosine - lean * sine, -sine - lean * cosine],
                [sine / across, cosine / across],
            ],
            [[0.0, cosine - sine * lean], [0.0, -sine - cosine * lean]],
        ]
    }

    /// The shear nearest to a trial `p` in series with a spring, both along the axes: `tᵢ = hᵢ² pᵢ / (hᵢ² + λ)` with the one unknown `λ >= 0` for which the shear has the size that
    /// the rule gives its slip. `give`: the traction by which the spring is relieved at the velocity from which the full limit `T` acts; the trial is held where it is zero. With
    /// `N² = Σ (tᵢ/hᵢ)²` the equation is
    ///
    /// ```text
    /// N(λ) = T φ(λ)      φ = 1 - y², y = give/(λ T) - 1 from λ = give/(2 T), where nothing is carried, to λ = give/T, and 1 beyond
    /// ```
    ///
    /// `N` falls and `φ` rises with `λ`. Without `give` it is the closest-point projection on the ellipse.
    pub(super) fn nearest(&self, p: [f64; 2], limit: f64, give: f64) -> Nearest {
        let square = self.half.map(|h| h * h);
        let sum = |of: &dyn Fn(usize) -> f64| of(0) + of(1);
        let part = |i: usize, lambda: f64| match square[i] > 0.0 {
            true => square[i] / (square[i] + lambda),
            false => 0.0,
        };
        // tᵢ/hᵢ
        let scaled = |i: usize, lambda: f64| match square[i] > 0.0 {
            true => p[i] * self.half[i] / (square[i] + lambda),
            false => 0.0,
        };
        let size = |lambda: f64| sum(&|i| scaled(i, lambda).powi(2)).sqrt();
        let falls = |lambda: f64, size: f64| {
            let square_over = |i: usize| match square[i] > 0.0 {
                true => scaled(i, lambda).powi(2) / (square[i] + lambda),
                false => 0.0,
            };
            sum(&square_over) / size
        };
        // φ and its derivative with respect to λ T
        let mobilised = |lambda: f64| {
            let way = lambda * limit;
            match way < give {
                true => {
                    let y = (give / way - 1.0).min(1.0);
                    (1.0 - y * y, 2.0 * y * give / (way * way))
                }
                false => (1.0, 0.0),
            }
        };
        let first = 0.5 * give / limit;
        let mut lambda = first;
        let inside = size(first) <= limit * mobilised(first).0;
        if !inside {
            let most = (self.half[0] * p[0]).hypot(self.half[1] * p[1]);
            let (mut low, mut high) = (first, (most / limit).max(give / limit));
            for _ in 0..MOST_STEPS {
                let (n, (phi, slope)) = (size(lambda), mobilised(lambda));
                match n > limit * phi {
                    true => low = lambda,
                    false => high = lambda,
                }
                // Newton's method for T φ/N = 1, which is nearly linear.
                let rise = limit * (slope * limit / n + phi * falls(lambda, n) / (n * n));
                let newton = lambda - (limit * phi / n - 1.0) / rise;
                let next = match newton > low && newton < high {
                    true => newton,
                    false => 0.5 * (low + high),
                };
                let settled =
                    (next - lambda).abs() <= f64::EPSILON * next || next <= low || next >= high;
                lambda = next;
                if settled {
                    break;
                }
            }
        }
        let shear = [0, 1].map(|i| part(i, lambda) * p[i]);
        let mut out = Nearest {
            shear,
            d_trial: [[part(0, lambda), 0.0], [0.0, part(1, lambda)]],
            d_limit: [0.0; 2],
            slides: !inside && lambda * limit >= give,
        };
        if inside {
            return out;
        }
        let n = size(lambda);
        let (phi, slope) = mobilised(lambda);
        let rise = falls(lambda, n) + limit * limit * slope;
        let with_limit = -(phi + limit * lambda * slope) / rise;
        let with_trial = [0, 1].map(|i| match square[i] > 0.0 {
            true => scaled(i, lambda) * self.half[i] / ((square[i] + lambda) * n * rise),
            false => 0.0,
        });
        for i in (0..2).filter(|&i| square[i] > 0.0) {
            let change = -shear[i] / (square[i] + lambda);
            out.d_limit[i] = change * with_limit;
            for (d, part) in out.d_trial[i].iter_mut().zip(with_trial) {
                *d += change * part;
            }
        }
        out
    }
}

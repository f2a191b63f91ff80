//! Slip rules: from limit and motion to shear traction.

mod regularised;
mod return_mapping;
mod rule;

pub use regularised::{Regularised, creep, phi, psi};
pub use return_mapping::ReturnMapping;
pub use rule::{SlipRule, SlipState, Tangential};

crate::family! {
    /// The slip rule: shear traction as a function of relative motion.
    SlipModel: "slip", dyn SlipRule {
        /// Stick until the limit.
        ReturnMapping(ReturnMapping) = "return-mapping",
        /// The paper's smooth friction.
        Regularised(Regularised) = "regularised",
    }
}

impl Default for SlipModel {
    fn default() -> Self {
        SlipModel::ReturnMapping(ReturnMapping {})
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::friction::ellipse::{Ellipse, SlipDirection};
    use crate::registry::Family;

    fn motion(scale: f64, skew: f64) -> Tangential {
        Tangential {
            slip: [0.7 * scale, -0.4 * scale],
            dt: 0.5,
            stiffness: 2.0,
            base: [0.11, -0.2],
            skew,
            ..Tangential::default()
        }
    }

    #[test]
    fn derivatives_agree_with_differences() {
        let ellipse = |half, flow| {
            let angle = 0.6;
            Some(Ellipse { half, angle, flow })
        };
        let shapes = [
            None,
            ellipse([1.0, 0.4], SlipDirection::Associated),
            ellipse([0.2, 1.0], SlipDirection::Associated),
            ellipse([1.0, 0.0], SlipDirection::Associated),
            ellipse([1.0, 0.4], SlipDirection::AgainstTraction),
            ellipse([0.2, 1.0], SlipDirection::AgainstTraction),
        ];
        let models = SlipModel::samples();
        let all = (models.iter()).flat_map(|m| shapes.map(|ellipse| (m, ellipse)));
        for (model, ellipse) in all {
            let rule = model.as_dyn();
            for (scale, skew) in [(0.1, 0.0), (0.3, 0.4), (0.7, 0.2), (2.0, 0.0), (3.0, -0.3)] {
                let at = Tangential {
                    ellipse,
                    ..motion(scale, skew)
                };
                let limit = 0.9;
                for sprung in [false, true] {
                    let traction = |limit: f64, at: &Tangential| match sprung {
                        true => rule.sprung(limit, at),
                        false => rule.traction(limit, at),
                    };
                    let s = traction(limit, &at);
                    let h = 1e-6;
                    let close = |a: f64, b: f64| (a - b).abs() < 1e-8 * (1.0 + b.abs());
                    for j in 0..2 {
                        let shifted = |h: f64| {
                            let mut m = at;
                            m.slip[j] += h;
                            traction(limit, &m).traction
                        };
                        let (a, b) = (shifted(-h), shifted(h));
                        for i in 0..2 {
                            assert!(
                                close(s.d_slip[i][j], (b[i] - a[i]) / (2.0 * h)),
                                "{model:?} {ellipse:?} {scale} {skew}"
                            );
                        }
                    }
                    let (a, b) = (traction(limit - h, &at), traction(limit + h, &at));
                    let turned = |h: f64| {
                        traction(
                            limit,
                            &Tangential {
                                skew: skew + h,
                                ..at
                            },
                        )
                    };
                    let (c, d) = (turned(-h), turned(h));
                    for i in 0..2 {
                        assert!(close(
                            s.d_limit[i],
                            (b.traction[i] - a.traction[i]) / (2.0 * h)
                        ));
                        assert!(close(
                            s.d_skew[i],
                            (d.traction[i] - c.traction[i]) / (2.0 * h)
                        ));
                    }
                    // Of the line of the third shape rounding alone would be beyond the limit.
                    let line = ellipse.is_some_and(|e| e.half.contains(&0.0));
                    let size = match line {
                        true => at.length(s.traction),
                        false => at.cone(limit).size(s.traction),
                    };
                    assert!(size <= limit * (1.0 + 1e-13));
                }
            }
        }
    }
}

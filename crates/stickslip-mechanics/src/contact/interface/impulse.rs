//! Contact of masses with what does not give way: the points that are pressed, as an impact sees them.

use super::parts::InterfaceForce;
use super::pass::evaluate_all;
use super::scene::Wants;
use crate::system::Stage;

/// A point that multipliers press, in motion.
#[derive(Debug, Clone, PartialEq)]
pub struct Pressed {
    /// The dofs that take part.
    pub dofs: Vec<usize>,
    /// Gradient of the gap over them `[-]`.
    pub gap: Vec<f64>,
    /// Force against penetration `[N]`.
    pub force: f64,
}

/// The points that are pressed at the end of an increment that has been solved.
pub fn pressed_points(interface: &mut InterfaceForce, stage: &Stage) -> Vec<Pressed> {
    if !interface.schedule.active(stage.at.t) {
        return Vec::new();
    }
    let wants = Wants {
        tangent: true,
        ..Wants::default()
    };
    let (input, cache) = interface.parts();
    evaluate_all(input, cache, stage, wants);
    let (evaluations, in_space) = (&cache.trial, &cache.geometry.in_space);
    let points = evaluations.points.iter().enumerate();
    let pressed = points.filter(|(_, e)| e.saddle.is_some() && e.kept.multiplier[0] > 0.0);
    let found = pressed.filter_map(|(i, e)| {
        let batch = evaluations.batch(i);
        let mut dofs = batch.dofs(e).to_vec();
        let mut gap = batch.tangent(e)?.rows[..dofs.len()].to_vec();
        in_space.gradients(&mut dofs, &mut gap);
        Some(Pressed {
            gap,
            dofs,
            force: e.area * e.kept.multiplier[0],
        })
    });
    found.collect()
}

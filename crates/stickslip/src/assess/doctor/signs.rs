//! What suspect points show by themselves, and what supports ask of them.

use super::finding::{DoctorCause, Finding};
use super::suspect::Suspect;
use crate::assess::view::View;
use crate::contact::interface::{InterfaceDefinition, LARGE_SLIP, Primary};
use crate::math::{Vec3, add_scaled, dot, norm, sub};
use crate::system::Evidence;
use crate::time::Trial;

/// What the suspect points show by themselves, the rarest sign first.
pub(super) fn signs(evidence: &[&Evidence]) -> Option<Finding> {
    let worst = |measure: &dyn Fn(&Evidence) -> f64| {
        let all = evidence.iter().map(|e| (measure(e), *e));
        all.max_by(|a, b| a.0.total_cmp(&b.0))
    };
    if let Some((kink, e)) = worst(&|e| e.kink).filter(|w| w.0 > 1.0) {
        let finding = DoctorCause::LawTangentJump.warning(format!(
            "the normal law of interface {} has a kink where points are: its slope changes by a factor {kink:.1}",
            e.interface
        ));
        return Some(
            finding.advise("smooth the table of the law by more rows, or take smaller increments"),
        );
    }
    // A point that has left the edge of the primary twice has lost its projection.
    if let Some((left, e)) = worst(&|e| e.left as f64).filter(|w| w.0 >= 2.0) {
        let finding = DoctorCause::LostProjection.warning(format!(
            "points of interface {} leave the outer edge of the primary and come back, up to {left} times",
            e.interface
        ));
        return Some(
            finding
                .advise("let the primary surface reach farther than the secondary, or swap the two sides")
                .advise("smaller increments"),
        );
    }
    let slid = |e: &Evidence| match e.facet > 0.0 {
        true => e.slip / e.facet,
        false => 0.0,
    };
    if let Some((slip, e)) = worst(&slid).filter(|w| w.0 > LARGE_SLIP) {
        return Some(too_large_slip(slip, &e.interface));
    }
    // Four status changes of a point in one attempt count as chatter.
    let (flips, e) = worst(&|e| e.flips as f64).filter(|w| w.0 >= 4.0)?;
    let finding = DoctorCause::Chatter.warning(format!(
        "points of interface {} go back and forth, the worst with {flips} changes of status ({})",
        e.interface,
        e.course.join(" → ")
    ));
    Some(
        finding
            .advise("smaller increments")
            .advise("a finer mesh at these points, or a compliant normal law"),
    )
}

/// A finding about slip, in facets.
pub(super) fn too_large_slip(slip: f64, interface: &str) -> Finding {
    DoctorCause::TooLargeSlip.warning(format!("points of interface {interface} slide over {slip:.2} facets in one increment"))
        .blame(Suspect::interface(interface, format!("{slip:.2} facets")))
        .advise(format!(
            "increments that are {} times smaller, so that a point slides over half a facet at most",
            (2.0 * slip).ceil()
        ))
}

/// The largest slip that supports prescribe over the increment, in facets, and its interface; `None` where it is small.
pub(super) fn prescribed_slip(view: &View, trial: &Trial) -> Option<(f64, String)> {
    let model = view.model;
    let constraints = view.constraints(trial.to);
    let before = view.constraints(trial.from);
    let moved = |local: usize, interface: &InterfaceDefinition| -> Option<Vec3> {
        let point = interface.nodes[local];
        let body = model.bodies.iter().find(|b| b.points.contains(&point))?;
        // The mean over the supported points of its body.
        let mut sum = [0.0; 3];
        for (c, sum) in sum.iter_mut().enumerate().take(model.dofs.dim) {
            let dofs = body.points.clone().map(|p| model.dofs.of(p, c));
            let fixed = dofs.filter(|&d| constraints.fixed[d] && before.fixed[d]);
            let changes: Vec<f64> = fixed
                .map(|d| constraints.values[d] - before.values[d])
                .collect();
            *sum = changes.iter().sum::<f64>() / changes.len().max(1) as f64;
        }
        Some(sum)
    };
    let slips = view.contact.interfaces.iter().filter_map(|interface| {
        let Primary::Facets(facets) = &interface.primary else {
            return None;
        };
        let (point, facet) = (interface.points.first()?, facets.first()?);
        let ours = moved(*point.nodes.first()?, interface)?;
        let theirs = moved(*facet.nodes.first()?, interface)?;
        let slip = sub(ours, theirs);
        let along = add_scaled(slip, -dot(slip, point.normal), point.normal);
        let size = crate::contact::surface::spacing(facet, &interface.reference);
        Some((norm(along) / size, interface.name.clone()))
    });
    let largest = slips.max_by(|a, b| a.0.total_cmp(&b.0));
    largest.filter(|s| s.0 > LARGE_SLIP)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_points_tell_what_went_wrong() {
        let quiet = Evidence {
            interface: "base".into(),
            facet: 1e-3,
            kink: 1.0,
            ..Evidence::default()
        };
        let cause = |e: Evidence| signs(&[&quiet, &e]).map(|f| (f.cause, f.message));
        assert_eq!(cause(quiet.clone()), None);
        let flips = Evidence {
            flips: 7,
            course: vec!["open", "stick", "open", "stick"],
            ..quiet.clone()
        };
        let (found, message) = cause(flips.clone()).expect("a sign");
        assert_eq!(found, DoctorCause::Chatter);
        assert!(
            message.contains("7 changes of status (open → stick → open → stick)"),
            "{message}"
        );
        let slid = Evidence {
            slip: 2.5e-3,
            ..flips.clone()
        };
        assert_eq!(cause(slid).expect("a sign").0, DoctorCause::TooLargeSlip);
        let lost = Evidence {
            left: 2,
            ..flips.clone()
        };
        assert_eq!(cause(lost).expect("a sign").0, DoctorCause::LostProjection);
        let kinked = Evidence {
            kink: 50.0,
            ..flips
        };
        assert_eq!(
            cause(kinked).expect("a sign").0,
            DoctorCause::LawTangentJump
        );
    }
}

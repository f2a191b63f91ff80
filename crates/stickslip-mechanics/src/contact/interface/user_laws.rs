//! Laws of the program, asked for all points of an evaluation at once.

use std::sync::Arc;

use super::definition::InterfaceDefinition;
use super::evaluate::evaluate_points;
use super::evaluation::{Evaluations, Question};
use super::scene::{LawQuery, Scene, Wants};
use crate::contact::law::friction::FrictionLaw;
use crate::contact::law::user::{
    LimitFunction, PressureFunction, UserFriction, UserLaws, UserNormal,
};
use crate::contact::pairing::Anchor;
use crate::contact::response::{Answers, Laws, OwnFriction};
use crate::tolerance::ROUNDING;

/// The interface with functions of the program in place of the normal law and the friction law of the problem. To be asked for before the analysis
/// begins.
pub fn with_user_laws(
    interface: &InterfaceDefinition,
    normal: Option<Arc<dyn PressureFunction>>,
    friction: Option<Arc<dyn LimitFunction>>,
) -> InterfaceDefinition {
    let sizes = interface.points.iter().map(|p| p.size).sum::<f64>();
    let length = sizes / interface.points.len().max(1) as f64;
    let user = UserLaws {
        normal: normal.map(|f| UserNormal::new(f, length)),
        friction: friction.map(UserFriction::new),
    };
    interface.with_laws(Laws {
        user,
        ..interface.laws.clone()
    })
}

/// The interface with a friction law of the program in place of that of the problem, which may keep [state variables](FrictionLaw::states). To be asked for before
/// the analysis begins.
pub fn with_friction_law(
    interface: &InterfaceDefinition,
    law: Arc<dyn FrictionLaw>,
) -> InterfaceDefinition {
    interface.with_laws(Laws {
        own_friction: Some(OwnFriction(law)),
        ..interface.laws.clone()
    })
}

/// What laws of the program say at the points of a scene; nothing where there are none.
///
/// The points are gone through once for each of the laws, to find what it is asked: that costs geometry twice, but calls the
/// function once.
pub(super) fn ask(
    scene: &Scene,
    out: &mut Evaluations,
    anchors: &mut [Option<Anchor>],
) -> Vec<Answers> {
    let interface = scene.interface;
    let user = &interface.laws.user;
    if !user.any() || interface.laws.tied {
        return Vec::new();
    }
    let mut answers = vec![Answers::default(); interface.points.len()];
    if let Some(normal) = &user.normal {
        let questions = questions(scene, &answers, LawQuery::Gaps, out, anchors);
        let gaps: Vec<f64> = questions.iter().map(|q| q.gap).collect();
        for (q, answer) in questions.iter().zip(normal.pressures(&gaps)) {
            answers[q.point].pressure = Some(answer);
        }
    }
    if let Some(friction) = &user.friction {
        let questions = questions(scene, &answers, LawQuery::Friction, out, anchors);
        let points: Vec<_> = questions.iter().map(|q| q.friction).collect();
        for (q, mut answer) in questions.iter().zip(friction.limits(&points)) {
            // A negative limit would push where friction resists: the iteration stops instead.
            // A limit that is negative by no more than rounding is none.
            if answer.value < -ROUNDING * q.friction.pressure.abs() {
                answer.value = f64::NAN;
            }
            answer.value = match answer.value < 0.0 {
                true => 0.0,
                false => answer.value,
            };
            answers[q.point].limit = Some(answer);
        }
    }
    answers
}

fn questions(
    scene: &Scene,
    answers: &[Answers],
    query: LawQuery,
    out: &mut Evaluations,
    anchors: &mut [Option<Anchor>],
) -> Vec<Question> {
    let scene = Scene {
        answers,
        query,
        wants: Wants {
            tangent: false,
            surrogate: false,
            ..scene.wants
        },
        ..*scene
    };
    evaluate_points(&scene, out, anchors);
    let batches = out.batches.iter();
    batches.flat_map(|b| b.questions.iter().copied()).collect()
}

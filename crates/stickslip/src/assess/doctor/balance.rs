//! Loads that no forces of contact can balance.

use super::finding::{DoctorCause, Finding};
use super::places;
use super::released::{Gone, let_go};
use super::suspect::Suspect;
use crate::assess::view::View;
use crate::error::RunError;
use crate::math::vector;
use crate::model::rigid::balance::{Balance, EXACT_REST, UNMOVED};
use crate::model::rigid::drivers;
use crate::model::rigid::drivers::named;
use crate::model::rigid::held::Unheld;
use crate::number::digits;
use crate::tolerance::NEGLIGIBLE;

/// Halvings by which a time is found.
const HALVINGS: usize = 20;

/// What ends a quasi-static step, or an attempt that failed, from one time to another: at its end no forces of contact can balance the loads.
pub(crate) fn refuse_unbalanced(view: &View, from: f64, to: f64) -> Option<(Finding, RunError)> {
    let balance = Balance::new(view, to)?;
    let at_end = balance.loads(view, to);
    let rest = balance.rest(&at_end, widened, 2.0 * UNMOVED)?;
    let (mut good, mut bad) = (from, to);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (good + bad);
        match balance.rest(&balance.loads(view, middle), |mu| mu, EXACT_REST) {
            None => good = middle,
            Some(_) => bad = middle,
        }
    }
    if bad - from < UNMOVED * (to - from) {
        bad = from;
    }
    let unbalanced = Unbalanced::new(view, &balance, &rest, to);
    let when = match bad > view.frame.state.t {
        true => format!(" from {} on", digits(bad, 6)),
        false => String::new(),
    };
    Some(unbalanced.refuse(&when))
}

/// Free bodies that contact cannot hold at a time: loads that it cannot balance, or none while it pushes bodies away.
pub(super) fn unbalanced(view: &View, t: f64) -> Option<Finding> {
    beyond(view, t, widened, 2.0 * UNMOVED)
}

/// The same of loads that come to the limit of friction, where nothing is left to hold a body.
pub(super) fn at_limit(view: &View, t: f64) -> Option<Finding> {
    beyond(view, t, |mu| mu * (1.0 - UNMOVED), EXACT_REST)
}

/// Friction with room for what points move and surfaces bend.
fn widened(mu: f64) -> f64 {
    mu * (1.0 + UNMOVED) + UNMOVED
}

/// Loads of which contact with this friction leaves more than the part `left`.
fn beyond(view: &View, t: f64, friction: impl Fn(f64) -> f64, left: f64) -> Option<Finding> {
    let balance = Balance::new(view, t)?;
    let loads = balance.loads(view, t);
    if vector::norm(&loads) == 0.0 {
        let one_sided = balance.close && balance.is_one_sided();
        return one_sided.then(|| pushed_away(view, &balance));
    }
    let rest = balance.rest(&loads, friction, left)?;
    Some(Unbalanced::new(view, &balance, &rest, t).warn())
}

/// Bodies that contact pushes away while no load presses them against it.
fn pushed_away(view: &View, balance: &Balance) -> Finding {
    let described = balance.motions.iter();
    let described = described.map(|m| drivers::describe(view, &balance.all, m));
    let mut bodies: Vec<String> = described.map(|(body, _)| body).collect();
    bodies.dedup();
    let name = bodies.first().cloned().unwrap_or_default();
    let places = bodies.iter();
    let places = places.map(|b| places::body(view.model, b, "held by contact alone"));
    DoctorCause::FreeRigidMode
        .warning(format!(
            "contact pushes body {name} away and nothing pushes back: no support, no spring and no load holds it"
        ))
        .blame_all(places)
        .advise("support the body on its other side, or hold it by springs")
}

/// Loads that contact cannot balance, and the motion that they drive.
struct Unbalanced<'a> {
    view: &'a View<'a>,
    motion: Unheld,
    push: drivers::Push,
    /// The body that moves the most, and how it moves.
    body: String,
    what: String,
    touches: bool,
    /// No friction would keep it from turning.
    tips: bool,
    /// What friction would hold it, for a sentence.
    friction: String,
    all: &'a Balance,
}

impl<'a> Unbalanced<'a> {
    fn new(view: &'a View<'a>, balance: &'a Balance, rest: &[f64], t: f64) -> Self {
        let motion = balance.driven(rest);
        let (body, what) = drivers::describe(view, &balance.all, &motion);
        let index = view.model.bodies.iter().position(|b| b.name == body);
        let wanted = balance.least_friction(&balance.loads(view, t));
        // What no friction would hold, and turns, is pressed beside what it lies on.
        let mut moving =
            (balance.all.iter().zip(&motion)).filter(|(_, part)| part.abs() > NEGLIGIBLE);
        let turns = moving.any(|(mode, _)| mode.name.starts_with("rotation"));
        Unbalanced {
            push: drivers::push(view, &balance.all, &motion, t),
            touches: balance.close || index.is_some_and(|b| view.touches(b)),
            tips: wanted.is_none() && turns,
            friction: match wanted {
                Some(mu) => format!(
                    "friction of {mu:.4} would hold it, {:.4} is the largest there is",
                    balance.mu
                ),
                None => "no friction would hold it".to_string(),
            },
            view,
            motion,
            body,
            what,
            all: balance,
        }
    }

    fn sentence(&self, when: &str) -> String {
        let Unbalanced { body, what, .. } = self;
        let moves = match self.touches {
            true if self.tips => format!("body {body} tips over or lifts off as a whole ({what})"),
            true => format!("body {body} slides, rolls or lifts off as a whole ({what})"),
            false => format!("body {body} is free to move as a rigid body ({what})"),
        };
        format!(
            "{}: there is no equilibrium{when}: {moves}, {} it, and contact and friction cannot balance that; {}",
            self.view.called(),
            named(&self.push.drivers(), "drives", "drive"),
            self.friction
        )
    }

    fn cause(&self) -> DoctorCause {
        match self.touches {
            true => DoctorCause::SlidesAway,
            false => DoctorCause::FreeRigidMode,
        }
    }

    /// What to do.
    fn help(&self) -> &'static str {
        match self.touches {
            true if self.tips => {
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
        }
    }

    /// Supports and loads of the step before that held the bodies.
    fn gone(&self) -> Vec<Gone> {
        let moved = self.all.all.iter().zip(&self.motion);
        let moved = moved.filter(|(_, part)| part.abs() > NEGLIGIBLE);
        let name = |body: usize| self.view.model.bodies[body].name.clone();
        let moved: Vec<String> = moved.map(|(mode, _)| name(mode.body)).collect();
        let_go(self.view, &moved)
    }

    /// The finding with the bodies, what drives them, and what held them before.
    fn blamed(&self, finding: Finding) -> Finding {
        let remark = format!("{} is held by contact alone", self.what);
        let drivers = self.push.drivers().into_iter();
        finding
            .blame(places::body(self.view.model, &self.body, remark))
            .blame_all(drivers.map(|d| Suspect::key(d.key, d.what)))
            .blame_all((self.gone().into_iter()).map(|g| Suspect::key(g.key, g.what)))
    }

    /// A finding before the run, or of an attempt.
    fn warn(&self) -> Finding {
        let finding = self.blamed(self.cause().warning(self.sentence("")));
        let gone = self.gone().into_iter().map(|g| g.advice);
        let finding = gone.fold(finding, Finding::advise);
        finding.advise(self.help())
    }

    /// The error that ends a step, with its finding.
    fn refuse(&self, when: &str) -> (Finding, RunError) {
        let message = self.sentence(when);
        let gone: String = (self.gone().iter())
            .map(|g| format!("{}; ", g.advice))
            .collect();
        let help = format!("{gone}{}", self.help());
        let time = self.view.frame.state.t;
        let finding = self.blamed(self.cause().error(message.clone()));
        let error = RunError {
            message,
            time,
            culprits: finding.suspects.iter().map(Suspect::to_string).collect(),
            help: Some(help.clone()),
        };
        let finding = Finding {
            step: Some(self.view.step_name().to_string()),
            time: Some(time),
            ..finding.advise(help)
        };
        (finding, error)
    }
}

//! Pretensions that hold nothing: that push their sides apart, that draw them together with next to nothing, or that a later step lets go.

use super::super::finding::{DoctorCause, Finding};
use super::super::places::body;
use super::super::suspect::Suspect;
use crate::assess::view::View;
use crate::body::couplings::{Coupling, Course, Draw, Pretension, Tie};
use crate::model::definition::{Body, Model};
use crate::number::{digits, figure};

/// Strain of a bolt below which its force is none. Surfaces that are pressed together for the first time settle by 3 µm and more (VDI 2230, part 1), and a bolt of 3 m,
/// longer than most, that is stretched by less than that has lost its force by then.
const SLACK_STRAIN: f64 = 1e-6;

pub(super) fn check(view: &View) -> Vec<Finding> {
    let mut out = Vec::new();
    for coupling in view.contact.couplings.all() {
        let Tie::Pretension(pretension) = &coupling.tie else {
            continue;
        };
        let bolt = Bolt {
            model: view.model,
            name: &coupling.name,
            pretension,
            body: owner(view.model, coupling),
        };
        match bolt.pushes() {
            Some(finding) => out.push(finding),
            None => {
                out.extend(bolt.slack());
                out.extend(bolt.let_go());
            }
        }
    }
    out
}

/// A cut through a bolt, and what is done with it.
struct Bolt<'a> {
    model: &'a Model,
    name: &'a str,
    pretension: &'a Pretension,
    body: Option<&'a Body>,
}

/// The body that a cut goes through.
fn owner<'a>(model: &'a Model, cut: &Coupling) -> Option<&'a Body> {
    let point = model.dofs.locate(*cut.rows.first()?.dofs.first()?).0;
    model.bodies.iter().find(|b| b.points.contains(&point))
}

/// What a course comes to within a step: the least and the largest value.
fn range(course: &Course, from: f64, to: f64) -> [f64; 2] {
    let Some(table) = &course.table else {
        return [course.value; 2];
    };
    let rows = table.rows().iter().map(|r| r[0]);
    let times = rows.filter(|t| *t > from && *t < to).chain([to]);
    let values = times.map(|t| course.value * table.at(t));
    values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], v| {
        [low.min(v), high.max(v)]
    })
}

impl Bolt<'_> {
    fn step_name(&self, step: usize) -> &str {
        self.model.steps.get(step).map_or("", |s| s.name.as_str())
    }

    fn key(&self, step: usize) -> String {
        format!("step.{}.pretension.{}", step + 1, self.name)
    }

    /// A finding about what a step does with it.
    fn finding(&self, step: usize, message: String) -> Finding {
        let finding = DoctorCause::LooseBolt
            .warning(message)
            .blame(Suspect::key(self.key(step), ""));
        match self.body {
            Some(b) => finding.blame(body(self.model, &b.name, "cut by it")),
            None => finding,
        }
    }

    /// A force or a shortening below zero.
    fn pushes(&self) -> Option<Finding> {
        let mut steps = self.pretension.steps.iter().enumerate();
        steps.find_map(|(step, (from, to, draw))| {
            let (course, what) = match draw {
                Draw::Force(course) => (course, "force"),
                Draw::Shortening(course) => (course, "shortening"),
                Draw::Hold => return None,
            };
            let least = range(course, *from, *to)[0];
            (least < 0.0).then(|| {
                self.finding(
                    step,
                    format!(
                        "pretension {} has the {what} {least} in step {}: below zero it pushes the two sides of the bolt apart, and the joint opens",
                        self.name,
                        self.step_name(step),
                        least = digits(least, 5),
                    ),
                )
                .advise("a bolt that is tightened has a positive force, whichever way its normal points")
            })
        })
    }

    /// A force that stretches the bolt by less than surfaces settle.
    fn slack(&self) -> Option<Finding> {
        let bolt = self.body?;
        let moduli = bolt.blocks.clone();
        let moduli = moduli.filter_map(|b| bolt.elastic.constrained_modulus(b));
        let stiffness = moduli.reduce(f64::min)? * self.pretension.area;
        let steps = self.pretension.steps.iter().enumerate();
        let forces = steps.filter_map(|(step, (from, to, draw))| match draw {
            Draw::Force(course) => Some((step, range(course, *from, *to)[1])),
            Draw::Shortening(_) | Draw::Hold => None,
        });
        let (step, force) = forces.max_by(|a, b| a.1.total_cmp(&b.1))?;
        let strain = force / stiffness;
        (force > 0.0 && strain < SLACK_STRAIN).then(|| {
            self.finding(
                step,
                format!(
                    "pretension {} reaches {force} at most, a strain of {strain} in the bolt ({} on a section of {}): real surfaces settle by more, and the joint would be loose",
                    self.name,
                    figure(force / self.pretension.area),
                    figure(self.pretension.area), force = digits(force, 5), strain = digits(strain, 2)),
            )
            .advise("check the unit of the force: is it meant in kilonewtons?")
        })
    }

    /// A step in which the force falls to zero.
    fn let_go(&self) -> Option<Finding> {
        let largest = |draw: &Draw, from, to| match draw {
            Draw::Force(course) | Draw::Shortening(course) => Some(range(course, from, to)[1]),
            Draw::Hold => None,
        };
        let mut before = None;
        for (step, (from, to, draw)) in self.pretension.steps.iter().enumerate() {
            let Some(value) = largest(draw, *from, *to) else {
                continue;
            };
            let table = match draw {
                Draw::Force(course) | Draw::Shortening(course) => course.table.is_some(),
                Draw::Hold => false,
            };
            // One that an amplitude takes away is meant to go.
            if let Some(was) = before.filter(|_| value == 0.0 && !table) {
                return Some(
                    DoctorCause::LetGo.note(format!(
                        "step {} lets the bolt of pretension {} go: its value is 0 there after {was} before",
                        self.step_name(step),
                        self.name,
                        was = digits(was, 5),
                    ))
                    .blame(Suspect::key(self.key(step), "0"))
                    .advise(format!(
                        "if it is to stay tightened, write `pretension.{} = {{ hold = true }}` in step {}: the bolt keeps its length, and the force changes with what the joint carries",
                        self.name,
                        self.step_name(step)
                    )),
                );
            }
            before = (value != 0.0).then_some(value);
        }
        None
    }
}

//! Steps and how they are solved.

use super::fields::parameter;
use super::reader::Reader;
use crate::card::{Card, Place};
use crate::deck::{Action, Procedure, Step};
use crate::text::clip;

impl Reader<'_> {
    pub(super) fn heading(&mut self, card: &Card) {
        let first = card.data.first().map(|d| d.fields.join(", "));
        self.deck.output.title = self.deck.output.title.take().or(first);
    }

    pub(super) fn step(&mut self, card: &Card) {
        if self.position.in_step {
            self.step_without_procedure();
            self.warn(card.place, "the step before has no *END STEP", "");
        }
        let nonlinear = card.get("NLGEOM").is_some_and(|v| v != "NO");
        if nonlinear && !self.deck.steps.iter().any(|s| s.nonlinear) {
            self.note(
                card.place,
                "NLGEOM: contact follows the surfaces as they move; strains of the bodies are taken as small, and the run says how large strains and rotations become",
            );
        }
        let abrupt = match card.get("AMPLITUDE") {
            None => None,
            Some("STEP") => Some(true),
            Some("RAMP") => Some(false),
            Some(other) => {
                let message = format!("*STEP, AMPLITUDE={} is not known", clip(other));
                self.error(card.place, message, "AMPLITUDE of *STEP is RAMP or STEP");
                None
            }
        };
        // What is printed and written goes on until cards of the same kind say otherwise.
        let before = self.deck.steps.last();
        self.deck.steps.push(Step {
            nonlinear,
            perturbation: card.has("PERTURBATION"),
            abrupt,
            place: card.place,
            prints: before.map_or_else(Vec::new, |s| s.prints.clone()),
            filed: before.map_or_else(Vec::new, |s| s.filed.clone()),
            output_every: before.and_then(|s| s.output_every),
            output_times: before.map_or_else(Vec::new, |s| s.output_times.clone()),
            ..Step::default()
        });
        self.position.in_step = true;
        self.position.procedure = false;
        self.position.touched.clear();
        self.position.asked.clear();
    }

    pub(super) fn end_step(&mut self, card: &Card) {
        if !self.position.in_step {
            self.error(
                card.place,
                "*END STEP without *STEP",
                "a step begins with *STEP",
            );
            return;
        }
        self.step_without_procedure();
        self.position.in_step = false;
    }

    /// The step that the card belongs to.
    pub(super) fn own_step(&mut self, card: &Card) -> Option<&mut Step> {
        if !self.position.in_step {
            self.error(
                card.place,
                format!("{} stands outside of a step", card.written),
                "write it between *STEP and *END STEP",
            );
            return None;
        }
        self.deck.steps.last_mut()
    }

    pub(super) fn times(&mut self, card: &Card) -> [f64; 4] {
        let Some(data) = card.data.first() else {
            return [0.0; 4];
        };
        let times = [0, 1, 2, 3].map(|i| self.number(data, i, 0.0));
        if times.iter().any(|t| *t < 0.0) {
            self.error(
                data.place,
                "times cannot be negative",
                "write initial increment, period, smallest, largest increment",
            );
            return [0.0; 4];
        }
        if times[1] > 0.0 && times[0] > times[1] {
            self.error(
                data.place,
                "the first increment is longer than the step",
                "write initial increment, period",
            );
            return [0.0; 4];
        }
        times
    }

    pub(super) fn proceed(&mut self, card: &Card, procedure: Procedure) {
        if self.position.procedure && self.position.in_step {
            self.error(
                card.place,
                "a second procedure in one step",
                "a step has one *STATIC or *DYNAMIC",
            );
            return;
        }
        if self.deck.steps.last().is_some_and(|s| s.perturbation) && !procedure.is_modal() {
            self.error(
                card.place,
                format!(
                    "{} in a step with PERTURBATION is not computed",
                    card.written
                ),
                "take PERTURBATION out of *STEP: a step from the deformed state is computed",
            );
        }
        if let Some(step) = self.own_step(card) {
            step.procedure = procedure;
            self.position.procedure = true;
        }
    }

    pub(super) fn statics(&mut self, card: &Card) {
        let times = self.times(card);
        self.proceed(
            card,
            Procedure::Static {
                times,
                direct: card.has("DIRECT"),
            },
        );
    }

    pub(super) fn dynamics(&mut self, card: &Card) {
        if card
            .get("APPLICATION")
            .is_some_and(|a| a != "TRANSIENTFIDELITY")
        {
            self.error(
                card.place,
                "*DYNAMIC: only APPLICATION=TRANSIENT FIDELITY is read",
                "leave APPLICATION out and give ALPHA, or use *STATIC for what is slow",
            );
        }
        if card.get("INITIAL") == Some("NO") {
            self.error(
                card.place,
                "*DYNAMIC, INITIAL=NO is not supported",
                "accelerations at the start follow from what acts then: leave INITIAL out",
            );
        }
        let times = self.times(card);
        let alpha = parameter(self, card, "ALPHA");
        if alpha.is_some_and(|a| !(-1.0 / 3.0..=0.0).contains(&a)) {
            self.error(
                card.place,
                "ALPHA must lie between -1/3 and 0",
                "the default is -0.05",
            );
        }
        self.proceed(
            card,
            Procedure::Dynamic {
                times,
                direct: card.has("DIRECT"),
                explicit: card.has("EXPLICIT"),
                alpha,
            },
        );
    }

    pub(super) fn frequency(&mut self, card: &Card) {
        let Some(data) = card.data.first() else {
            self.error(
                card.place,
                "*FREQUENCY does not say how many modes",
                "write number of modes, lowest frequency, highest frequency",
            );
            return self.proceed(card, Procedure::default());
        };
        let [from, to] = [1, 2].map(|i| self.number(data, i, 0.0));
        let asked = self.number(data, 0, if to > 0.0 { 1e4 } else { 0.0 });
        if !(asked >= 1.0 && from >= 0.0 && (to == 0.0 || to > from)) {
            self.error(
                data.place,
                "the number of modes is at least 1, and their frequencies go from a lower to a higher one",
                "write number of modes, lowest frequency, highest frequency",
            );
        }
        if self.deck.steps.len() > 1 {
            self.note(
                card.place,
                "*FREQUENCY: vibrations about the state of the step before, with its closed contacts; stress does not stiffen bodies. The run says what it would do to the frequencies, and ends with exit code 2 where that is more than a twentieth",
            );
        }
        let count = asked.clamp(1.0, 1e6) as usize;
        let range = [from, to];
        self.proceed(card, Procedure::Frequency { count, range });
    }

    pub(super) fn complex_frequency(&mut self, card: &Card) {
        let fields = card.data.first();
        let [asked, from, highest, shift] =
            [0, 1, 2, 3].map(|i| fields.map_or(0.0, |data| self.number(data, i, 0.0)));
        let place = fields.map_or(card.place, |data| data.place);
        if from != 0.0 || shift != 0.0 {
            self.error(
                place,
                "*COMPLEX FREQUENCY: modes are found from the lowest frequency on",
                "leave the lowest frequency and the shift out, and ask for as many modes as reach that far",
            );
        }
        let known = |s: &Step| match s.procedure {
            Procedure::Frequency { count, .. } => Some(count),
            _ => None,
        };
        let before = self.deck.steps.iter().rev().find_map(known);
        let count = match (asked == 0.0, before) {
            (true, Some(count)) => count,
            (true, None) => {
                self.error(
                    place,
                    "*COMPLEX FREQUENCY does not say how many modes, and no *FREQUENCY before it does",
                    "write number of modes, , highest frequency",
                );
                1
            }
            (false, _) => asked.clamp(1.0, 1e6) as usize,
        };
        if asked < 0.0 || highest < 0.0 {
            self.error(
                place,
                "the number of modes and their highest frequency are not negative",
                "write number of modes, , highest frequency",
            );
        }
        let friction_damping = match card.get("FRICTIONDAMPING") {
            None | Some("NO") => false,
            Some("YES") => true,
            Some(other) => {
                let message = format!("FRICTION DAMPING={} is not known", clip(other));
                self.error(card.place, message, "FRICTION DAMPING is YES or NO");
                false
            }
        };
        let procedure = Procedure::ComplexFrequency {
            count,
            highest,
            friction_damping,
        };
        self.proceed(card, procedure);
    }

    pub(super) fn act(&mut self, action: Action) {
        if let Some(step) = self.deck.steps.last_mut() {
            step.actions.push(action);
        }
    }

    pub(super) fn step_without_procedure(&mut self) {
        if !self.position.procedure {
            let place = self.deck.steps.last().map_or(Place::default(), |s| s.place);
            self.error(
                place,
                "the step does not say how it is solved",
                "write *STATIC, *DYNAMIC, *FREQUENCY, *COMPLEX FREQUENCY or *STEADY STATE DYNAMICS in it",
            );
        }
    }
}

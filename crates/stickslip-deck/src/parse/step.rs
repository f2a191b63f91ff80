//! Steps: procedure, loads, supports, output.

use std::collections::BTreeSet;

use super::{Reader, keys, parameter, whole};
use crate::deck::{
    Action, Boundary, Distributed, Print, Procedure, Step, SurfaceParts, Target, Totals, When,
};
use crate::source::{Card, Data, Place, label, squeeze};

impl Reader<'_> {
    pub(super) fn step(&mut self, card: &Card) {
        if self.in_step {
            self.step_without_procedure();
            self.warn(card.place, "the step before has no *END STEP", "");
        }
        let nonlinear = card.get("NLGEOM").is_some_and(|v| v != "NO");
        if nonlinear && !self.deck.steps.iter().any(|s| s.nonlinear) {
            self.note(
                card.place,
                "NLGEOM: contact follows the surfaces as they move; strains and rotations of the bodies are taken as small, and the run says how large they become",
            );
        }
        let abrupt = match card.get("AMPLITUDE") {
            None => None,
            Some("STEP") => Some(true),
            Some("RAMP") => Some(false),
            Some(other) => {
                let message = format!("*STEP, AMPLITUDE={} is not known", super::clip(other));
                self.error(card.place, message, "AMPLITUDE of *STEP is RAMP or STEP");
                None
            }
        };
        // What is printed and written goes on until cards of the same kind say otherwise.
        let before = self.deck.steps.last();
        self.deck.steps.push(Step {
            nonlinear,
            abrupt,
            place: card.place,
            prints: before.map_or_else(Vec::new, |s| s.prints.clone()),
            output_every: before.and_then(|s| s.output_every),
            output_times: before.map_or_else(Vec::new, |s| s.output_times.clone()),
            ..Step::default()
        });
        self.in_step = true;
        self.procedure = false;
        self.touched.clear();
        self.asked.clear();
    }

    pub(super) fn end_step(&mut self, card: &Card) {
        if !self.in_step {
            self.error(
                card.place,
                "*END STEP without *STEP",
                "a step begins with *STEP",
            );
            return;
        }
        self.step_without_procedure();
        self.in_step = false;
    }

    /// The step that the card belongs to.
    fn own_step(&mut self, card: &Card) -> Option<&mut Step> {
        if !self.in_step {
            self.error(
                card.place,
                format!("{} stands outside of a step", card.written),
                "write it between *STEP and *END STEP",
            );
            return None;
        }
        self.deck.steps.last_mut()
    }

    fn times(&mut self, card: &Card) -> [f64; 4] {
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

    fn proceed(&mut self, card: &Card, procedure: Procedure) {
        if self.procedure && self.in_step {
            self.error(
                card.place,
                "a second procedure in one step",
                "a step has one *STATIC or *DYNAMIC",
            );
            return;
        }
        if let Some(step) = self.own_step(card) {
            step.procedure = procedure;
            self.procedure = true;
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

    fn act(&mut self, action: Action) {
        if let Some(step) = self.deck.steps.last_mut() {
            step.actions.push(action);
        }
    }

    /// `OP=NEW` takes away what was prescribed before. It counts on the first card of its kind in a step, as in CalculiX; Abaqus wants it
    /// on all of them, which comes to the same.
    fn operation(&mut self, card: &Card, clear: Action) {
        let first = !self.touched.contains(&clear);
        if first {
            self.touched.push(clear.clone());
        }
        match card.get("OP") {
            Some("NEW") if first => self.act(clear),
            None | Some("MOD" | "NEW") => {}
            Some(other) => self.error(
                card.place,
                format!("OP={other} is not known"),
                "OP is MOD or NEW",
            ),
        }
    }

    pub(super) fn boundary(&mut self, card: &Card) {
        if card.get("TYPE").is_some_and(|t| t != "DISPLACEMENT") {
            self.error(
                card.place,
                "*BOUNDARY: only displacements are prescribed",
                "give a velocity as a displacement that grows over the step",
            );
            return;
        }
        if self.in_step {
            self.operation(card, Action::ClearBoundaries);
        }
        let amplitude = self.course(card);
        for data in &card.data {
            let Some(target) = self.target(data, 0) else {
                continue;
            };
            let components: Vec<usize> = match data.fields.get(1).map(|f| squeeze(f)).as_deref() {
                Some("ENCASTRE") => (0..6).collect(),
                Some("PINNED") => (0..3).collect(),
                Some("XSYMM") => vec![0, 4, 5],
                Some("YSYMM") => vec![1, 3, 5],
                Some("ZSYMM") => vec![2, 3, 4],
                _ => {
                    if data.fields.get(1).and_then(|f| whole(f)) == Some(11)
                        || data.fields.get(1).is_some_and(|f| f == "0")
                    {
                        self.error(
                            data.place,
                            "temperatures are not computed",
                            "take the thermal part out",
                        );
                        continue;
                    }
                    let Some(first) = self.direction(data, 1, 6) else {
                        continue;
                    };
                    let last = match data.fields.get(2).filter(|f| !f.is_empty()) {
                        Some(_) => self.direction(data, 2, 6).unwrap_or(first),
                        None => first,
                    };
                    if last < first {
                        self.error(
                            data.place,
                            "the last direction is below the first",
                            "write node, first direction, last direction, value",
                        );
                        continue;
                    }
                    (first..=last).collect()
                }
            };
            let value = self.number(data, 3, 0.0);
            if !self.in_step && value != 0.0 {
                self.error(
                    data.place,
                    "before the first step only zero displacements are prescribed",
                    "move the line into a *STEP",
                );
                continue;
            }
            let boundary = Boundary {
                target,
                components,
                value,
                amplitude: amplitude.clone(),
                fixed: card.has("FIXED"),
                place: data.place,
            };
            match self.in_step {
                true => self.act(Action::Boundary(boundary)),
                false => self.deck.supports.push(boundary),
            }
        }
    }

    pub(super) fn forces(&mut self, card: &Card) {
        if self.own_step(card).is_none() {
            return;
        }
        self.operation(card, Action::ClearForces);
        let amplitude = self.course(card);
        for data in &card.data {
            let (Some(target), Some(component)) =
                (self.target(data, 0), self.direction(data, 1, 3))
            else {
                continue;
            };
            if let Target::Set(name) = &target {
                self.once(0, name, data.place);
            }
            let value = self.number(data, 2, 0.0);
            self.act(Action::Force {
                target,
                component,
                value,
                amplitude: amplitude.clone(),
                place: data.place,
            });
        }
    }

    /// The amplitude of a card. With TIME DELAY it is one of its own, which is that much later.
    fn course(&mut self, card: &Card) -> Option<String> {
        let name = card
            .get("AMPLITUDE")
            .filter(|n| !n.is_empty())
            .map(str::to_string);
        let Some(delay) = parameter(self, card, "TIMEDELAY") else {
            return name;
        };
        let known = name
            .as_ref()
            .and_then(|n| self.deck.amplitudes.get(n))
            .cloned();
        let (Some(name), Some(mut amplitude)) = (name, known) else {
            self.error(
                card.place,
                format!(
                    "{}, TIME DELAY needs an amplitude that it delays",
                    card.written
                ),
                "write AMPLITUDE=..., with the *AMPLITUDE before this card",
            );
            return None;
        };
        for row in &mut amplitude.rows {
            row[0] += delay;
        }
        let later = format!("{name} after {delay}");
        self.deck.amplitudes.insert(later.clone(), amplitude);
        Some(later)
    }

    /// It is an error if a line has more fields than the kind of load reads.
    fn no_more(&mut self, data: &Data, count: usize, kind: &str) {
        let means = |text: &String| !text.is_empty() && super::number(text) != Some(0.0);
        if let Some(at) = data.fields.iter().skip(count).position(means) {
            let field = count + at;
            let message = format!(
                "field {} of this line, `{}`, is not read",
                field + 1,
                super::clip(&data.fields[field])
            );
            self.error(
                data.place,
                message,
                &format!("a line with {kind} has {count} fields"),
            );
        }
    }

    fn distribute(&mut self, amplitude: &Option<String>, load: Distributed, place: Place) {
        let amplitude = amplitude.clone();
        self.act(Action::Distributed {
            load,
            amplitude,
            place,
        });
    }

    pub(super) fn distributed(&mut self, card: &Card) {
        if self.own_step(card).is_none() {
            return;
        }
        self.operation(card, Action::ClearDistributed);
        let amplitude = self.course(card);
        for data in &card.data {
            let Some(first) = data.fields.first().cloned() else {
                continue;
            };
            let what = data.fields.get(1).map(|f| squeeze(f)).unwrap_or_default();
            // `*DLOAD` of a surface is what some pre-processors write.
            if what == "P" && self.deck.surfaces.contains_key(&label(&first)) {
                self.faces_once(&label(&first), data.place);
                let p = self.number(data, 2, 0.0);
                self.distribute(
                    &amplitude,
                    Distributed::Surface(label(&first), p),
                    data.place,
                );
                continue;
            }
            let elements = match first.is_empty() && matches!(what.as_str(), "GRAV" | "CENTRIF") {
                true => self.deck.elements.keys().copied().collect(),
                false => self.elements_of(&first, data.place),
            };
            if elements.is_empty() {
                continue;
            }
            self.once(1, &label(&first), data.place);
            let value = self.number(data, 2, 0.0);
            let count = match what.as_str() {
                "GRAV" => 6,
                "CENTRIF" => 9,
                _ => 3,
            };
            self.no_more(data, count, &what);
            let load = match what.as_str() {
                "GRAV" => {
                    let d = [3, 4, 5].map(|i| self.number(data, i, 0.0));
                    let Some(d) = stickslip::math::normalize(d) else {
                        self.error(
                            data.place,
                            "GRAV needs a direction",
                            "write set, GRAV, acceleration, x, y, z",
                        );
                        continue;
                    };
                    Distributed::Gravity(elements, label(&first), value, d)
                }
                "CENTRIF" => {
                    let p = [3, 4, 5].map(|i| self.number(data, i, 0.0));
                    let d = [6, 7, 8].map(|i| self.number(data, i, 0.0));
                    if value < 0.0 || d == [0.0; 3] {
                        self.error(data.place, "CENTRIF needs the square of the angular speed, a point and a direction of the axis", "write set, CENTRIF, omega squared, px, py, pz, dx, dy, dz");
                        continue;
                    }
                    Distributed::Centrifugal(elements, label(&first), value, p, d)
                }
                "BX" => Distributed::Body(elements, 0, value),
                "BY" => Distributed::Body(elements, 1, value),
                "BZ" => Distributed::Body(elements, 2, value),
                "P" => {
                    self.error(
                        data.place,
                        "the load `P` is a pressure on a shell or on a surface",
                        "on solid elements name the face, P1 to P6; on a surface use *DSLOAD",
                    );
                    continue;
                }
                _ if what.starts_with('P') => {
                    let Some(face) = self.face(&what, 'P', data.place) else {
                        continue;
                    };
                    let mut faces = Vec::new();
                    for e in elements {
                        if self.has_face(e, face, data.place) {
                            faces.push((e, face));
                        }
                    }
                    Distributed::Pressure(faces, value)
                }
                _ => {
                    let message = format!(
                        "the distributed load `{}` is not supported",
                        super::clip(&what)
                    );
                    self.error(
                        data.place,
                        message,
                        "P1 to P6 (pressure), GRAV, CENTRIF and BX, BY, BZ are",
                    );
                    continue;
                }
            };
            self.distribute(&amplitude, load, data.place);
        }
    }

    pub(super) fn surface_loads(&mut self, card: &Card) {
        if self.own_step(card).is_none() {
            return;
        }
        self.operation(card, Action::ClearDistributed);
        let amplitude = self.course(card);
        for data in &card.data {
            let name = data.fields.first().map(|f| label(f)).unwrap_or_default();
            let what = data.fields.get(1).map(|f| squeeze(f)).unwrap_or_default();
            if what != "P" {
                self.error(
                    data.place,
                    format!("the surface load `{}` is not supported", super::clip(&what)),
                    "P (pressure) is",
                );
                continue;
            }
            self.faces_once(&name, data.place);
            let p = self.number(data, 2, 0.0);
            self.distribute(&amplitude, Distributed::Surface(name, p), data.place);
        }
    }

    /// It is an error to load a surface that names one of its faces twice.
    fn faces_once(&mut self, name: &str, place: Place) {
        let Some(SurfaceParts::Faces(faces)) = self.deck.surfaces.get(name).map(|s| &s.parts)
        else {
            return;
        };
        let mut seen = BTreeSet::new();
        let again = faces.iter().copied().find(|f| !seen.insert(*f));
        if let Some((element, Some(face))) = again {
            let message = format!(
                "face {face} of element {element} stands in the surface {name} more than once: it is loaded as often in CalculiX, and once in Abaqus"
            );
            self.error(place, message, "let the surface name each face once");
        }
    }

    /// Every so many increments, or at times; `None` is never.
    fn when(&mut self, card: &Card) -> Option<When> {
        if let Some(name) = card.get("TIMEPOINTS").map(str::to_string) {
            if let Some(step) = self.deck.steps.last_mut() {
                step.output_times.push(name.clone());
            }
            return Some(When::Times(name));
        }
        let name = ["FREQUENCY", "FREQUENCYF"]
            .into_iter()
            .find(|n| card.has(n));
        let every = name
            .and_then(|n| parameter(self, card, n))
            .unwrap_or(1.0)
            .max(0.0);
        (every >= 1.0).then_some(When::Every(every.min(1e9) as usize))
    }

    pub(super) fn print(&mut self, card: &Card) {
        if self.own_step(card).is_none() {
            return;
        }
        let kind = |p: &Print| match p {
            Print::Node { .. } => "NODEPRINT",
            Print::Element { .. } => "ELPRINT",
            Print::Contact { .. } => "CONTACTPRINT",
        };
        if self.asked.insert(card.keyword.clone())
            && let Some(step) = self.deck.steps.last_mut()
        {
            step.prints.retain(|p| kind(p) != card.keyword);
        }
        let totals = match card.get("TOTALS") {
            Some("YES") => Totals::Yes,
            Some("ONLY") => Totals::Only,
            _ => Totals::No,
        };
        let Some(when) = self.when(card) else { return };
        let keys = keys(card);
        let known: &[&str] = match card.keyword.as_str() {
            "NODEPRINT" => &["U", "RF", "V", "A"],
            "ELPRINT" => &["S", "E", "ELSE", "EVOL"],
            _ => &[
                "CDIS", "CDISP", "CSTR", "CSTRESS", "CELS", "CF", "CNUM", "CFN", "CFS",
            ],
        };
        for key in &keys {
            if !known.contains(&key.as_str()) {
                let message = format!(
                    "{}: {} is left out: it is not printed",
                    card.written,
                    super::clip(key)
                );
                self.note(card.place, message);
            }
        }
        let keys: Vec<String> = keys
            .into_iter()
            .filter(|k| known.contains(&k.as_str()))
            .collect();
        let sums = match card.keyword.as_str() {
            "NODEPRINT" => card.get("NSET").map(|s| (0, s.to_string())),
            "ELPRINT" => card.get("ELSET").map(|s| (1, s.to_string())),
            _ => None,
        };
        if let (true, Some((kind, set))) = (totals != Totals::No, sums) {
            self.once(kind, &set, card.place);
        }
        let print = match card.keyword.as_str() {
            "NODEPRINT" => match card.get("NSET").map(str::to_string) {
                Some(set) if !self.deck.node_sets.contains_key(&set) => {
                    self.error(
                        card.place,
                        format!("there is no set of nodes {set}"),
                        "define it with *NSET before it is printed",
                    );
                    return;
                }
                Some(set) => Print::Node {
                    set,
                    keys,
                    totals,
                    global: card.get("GLOBAL") == Some("YES"),
                    when,
                },
                None => {
                    let message = format!("{} names no set: nothing is printed", card.written);
                    self.note(card.place, message);
                    return;
                }
            },
            "ELPRINT" => match card.get("ELSET").map(str::to_string) {
                Some(set) if !self.deck.element_sets.contains_key(&set) => {
                    self.error(
                        card.place,
                        format!("there is no set of elements {set}"),
                        "define it with *ELSET before it is printed",
                    );
                    return;
                }
                Some(set) => Print::Element {
                    set,
                    keys,
                    totals,
                    global: card.get("GLOBAL") == Some("YES"),
                    when,
                },
                None => {
                    let message = format!("{} names no set: nothing is printed", card.written);
                    self.note(card.place, message);
                    return;
                }
            },
            _ => {
                let pair = card.get("SLAVE").zip(card.get("MASTER"));
                Print::Contact {
                    pair: pair.map(|(s, m)| (s.to_string(), m.to_string())),
                    keys,
                    totals,
                    when,
                }
            }
        };
        if let Some(step) = self.deck.steps.last_mut() {
            step.prints.push(print);
        }
    }

    pub(super) fn output(&mut self, card: &Card) {
        if self.own_step(card).is_none() {
            return;
        }
        if self.asked.insert("OUTPUT".into())
            && let Some(step) = self.deck.steps.last_mut()
        {
            step.output_every = None;
        }
        let when = self.when(card);
        if let (Some(When::Every(n)), Some(step)) = (when, self.deck.steps.last_mut()) {
            step.output_every = Some(step.output_every.map_or(n, |e| e.min(n)));
        }
    }
}

//! Cards to a [`Deck`].

mod contact;
mod material;
mod mesh;
mod step;

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

pub(crate) use material::frame;

use crate::deck::{Deck, Target};
use crate::finding::{DeckError, Finding, Severity};
use crate::source::{Card, Data, Place, Source, label, squeeze};
use crate::table::{self, Fate, Row};

impl Deck {
    /// Reads a deck and all it includes.
    ///
    /// # Errors
    /// Everything that is wrong or not supported, each with file and line.
    pub fn read(path: &Path) -> Result<Deck, DeckError> {
        Deck::from_source(&Source::read(path)?)
    }

    /// The same from the bytes of the first file; `path` is for messages, and for the folder of included files.
    ///
    /// # Errors
    /// Those of [`Deck::read`].
    pub fn parse(bytes: &[u8], path: &Path) -> Result<Deck, DeckError> {
        Deck::from_source(&Source::parse(bytes, path)?)
    }

    /// The meaning of cards.
    ///
    /// # Errors
    /// Those of [`Deck::read`].
    pub fn from_source(source: &Source) -> Result<Deck, DeckError> {
        let mut reader = Reader::new(source);
        for (place, message) in &source.forgiven {
            reader.note(*place, message.clone());
        }
        for card in &source.cards {
            reader.card(card);
        }
        reader.finish()
    }
}

/// What of a material or interaction the next cards are about.
#[derive(Debug, Clone, PartialEq)]
enum Context {
    None,
    Material(String),
    Interaction(String),
    /// After `*CHANGE FRICTION`.
    ChangeFriction(String),
    /// After `*CHANGE SURFACE BEHAVIOR`.
    ChangeBehavior(String),
}

/// Reads cards one after the other.
struct Reader<'a> {
    source: &'a Source,
    deck: Deck,
    errors: Vec<Finding>,
    context: Context,
    in_step: bool,
    /// Whether the step has its procedure.
    procedure: bool,
    /// What cards with `OP` have been met in the step, each by what clears it.
    touched: Vec<Action>,
    /// Kinds of output that the step has asked for.
    asked: BTreeSet<String>,
    /// Sets of nodes and of elements that name one twice, with its number.
    doubled: [BTreeMap<String, u64>; 2],
    /// Elements of types that are not supported, and sets of them: one error is enough.
    skipped: std::collections::BTreeSet<u64>,
    skipped_sets: std::collections::BTreeSet<String>,
    /// Types of elements that may bound others, where they were met first.
    bounding: Vec<(String, Place)>,
    /// Parameters that a note has been made of.
    noted: std::collections::BTreeSet<(&'static str, String)>,
    /// Nodes and elements that sets name and that are not there: set, what, where.
    absent: Vec<(String, String, Place)>,
    /// The deck goes on from what is not there: the rest means nothing.
    stopped: bool,
}

/// After so many errors no more are looked for: something else is wrong than single lines.
const ENOUGH: usize = 50;

impl<'a> Reader<'a> {
    fn new(source: &'a Source) -> Self {
        let deck = Deck {
            files: source.files.clone(),
            ..Deck::default()
        };
        Reader {
            source,
            deck,
            errors: Vec::new(),
            context: Context::None,
            in_step: false,
            procedure: false,
            touched: Vec::new(),
            asked: BTreeSet::new(),
            doubled: Default::default(),
            skipped: Default::default(),
            skipped_sets: Default::default(),
            bounding: Vec::new(),
            noted: Default::default(),
            absent: Vec::new(),
            stopped: false,
        }
    }

    fn finding(&self, severity: Severity, place: Place, message: String, help: &str) -> Finding {
        Finding {
            severity,
            file: self
                .source
                .files
                .get(place.file)
                .cloned()
                .unwrap_or_default(),
            line: place.line,
            message,
            help: (!help.is_empty()).then(|| help.to_string()),
        }
    }

    fn error(&mut self, place: Place, message: impl Into<String>, help: &str) {
        if self.errors.len() < ENOUGH {
            let finding = self.finding(Severity::Error, place, message.into(), help);
            self.errors.push(finding);
        }
    }

    fn warn(&mut self, place: Place, message: impl Into<String>, help: &str) {
        let finding = self.finding(Severity::Warning, place, message.into(), help);
        self.deck.notes.push(finding);
    }

    fn note(&mut self, place: Place, message: impl Into<String>) {
        let finding = self.finding(Severity::Note, place, message.into(), "");
        self.deck.notes.push(finding);
    }

    fn finish(mut self) -> Result<Deck, DeckError> {
        let end = Place::default();
        if self.stopped {
            return Err(DeckError {
                findings: self.errors,
            });
        }
        self.judge_bounding();
        self.judge_absent();
        if self.deck.nodes.is_empty() && self.errors.is_empty() {
            self.error(end, "the deck has no nodes", "give them with *NODE");
        }
        if self.deck.elements.is_empty() && self.errors.is_empty() {
            self.error(
                end,
                "the deck has no elements",
                "give them with *ELEMENT, TYPE=...",
            );
        }
        if self.in_step {
            self.step_without_procedure();
            let place = self.deck.steps.last().map_or(end, |s| s.place);
            self.warn(place, "the last step has no *END STEP", "");
        }
        self.check_names();
        self.deck.unused = crate::lint::unused(self.source);
        if self.errors.is_empty() {
            Ok(self.deck)
        } else {
            Err(DeckError {
                findings: self.errors,
            })
        }
    }

    fn step_without_procedure(&mut self) {
        if !self.procedure {
            let place = self.deck.steps.last().map_or(Place::default(), |s| s.place);
            self.error(
                place,
                "the step does not say how it is solved",
                "write *STATIC or *DYNAMIC in it",
            );
        }
    }

    fn card(&mut self, card: &Card) {
        if self.stopped {
            return;
        }
        let Some(row) = table::row(&card.keyword) else {
            let help = match table::nearest(&card.keyword) {
                Some(name) => format!("did you mean *{name}? (blanks and case do not matter)"),
                None => "it is no keyword of CalculiX or Abaqus that stickslip knows; comments begin with **".into(),
            };
            let message = format!("unknown keyword {}", card.written);
            self.error(card.place, message, &help);
            return;
        };
        match row.fate {
            Fate::Read => {}
            Fate::Harmless(why) | Fate::Idle(why) => {
                self.note(card.place, format!("{} is left out: {why}", card.written));
                return;
            }
            Fate::Refused(help) => {
                if matches!(
                    card.keyword.as_str(),
                    "COUPLEDTEMPERATURE-DISPLACEMENT" | "FREQUENCY" | "HEATTRANSFER" | "BUCKLE"
                ) {
                    // One finding a cause: the step has a procedure, if not one of ours.
                    self.procedure = true;
                }
                self.error(
                    card.place,
                    format!("{} is not supported", card.written),
                    help,
                );
                return;
            }
        }
        let sound = self.judge(card, row);
        let beneath = matches!(
            card.keyword.as_str(),
            "ELASTIC" | "DENSITY" | "DAMPING" | "SURFACEBEHAVIOR" | "FRICTION" | "CONTACTDAMPING"
        );
        if !beneath {
            self.context = Context::None;
        }
        // What is named is looked for later: a set that is missing as well would only be a second error.
        let names = matches!(
            card.keyword.as_str(),
            "NODE"
                | "ELEMENT"
                | "NSET"
                | "ELSET"
                | "SURFACE"
                | "MATERIAL"
                | "SURFACEINTERACTION"
                | "AMPLITUDE"
                | "STEP"
                | "STATIC"
                | "DYNAMIC"
        );
        if !(sound || names) {
            // What follows builds on what is not there.
            self.stopped = card.keyword == "RESTART";
            return;
        }
        match card.keyword.as_str() {
            "HEADING" => {
                let first = card.data.first().map(|d| d.fields.join(", "));
                self.deck.title = self.deck.title.take().or(first);
            }
            "NODE" => self.nodes(card),
            "ELEMENT" => self.elements(card),
            "NSET" => self.node_set(card),
            "ELSET" => self.element_set(card),
            "SURFACE" => self.surface(card),
            "TRANSFORM" => self.transform(card),
            "EQUATION" => self.equation(card),
            "RIGIDBODY" => self.rigid_body(card),
            "SPRING" => self.spring(card),
            "MASS" => self.mass(card),
            "INITIALCONDITIONS" => self.initial_conditions(card),
            "MATERIAL" => self.material(card),
            "ELASTIC" => self.elastic(card),
            "DENSITY" => self.density(card),
            "DAMPING" => self.damping(card),
            "SOLIDSECTION" => self.solid_section(card),
            "ORIENTATION" => self.orientation(card),
            "AMPLITUDE" => self.amplitude(card),
            "SURFACEINTERACTION" => self.interaction(card),
            "SURFACEBEHAVIOR" => self.behavior(card),
            "FRICTION" => self.friction(card),
            "CONTACTDAMPING" => self.contact_damping(card),
            "CHANGEFRICTION" => self.change(card, Context::ChangeFriction),
            "CHANGESURFACEBEHAVIOR" => self.change(card, Context::ChangeBehavior),
            "CONTACTPAIR" => self.contact_pair(card),
            "CLEARANCE" => self.clearance(card),
            "TIE" => self.tie(card),
            "TIMEPOINTS" => self.time_points(card),
            "STEP" => self.step(card),
            "ENDSTEP" => self.end_step(card),
            "STATIC" => self.statics(card),
            "DYNAMIC" => self.dynamics(card),
            "BOUNDARY" => self.boundary(card),
            "CLOAD" => self.forces(card),
            "DLOAD" => self.distributed(card),
            "DSLOAD" => self.surface_loads(card),
            "NODEPRINT" | "ELPRINT" | "CONTACTPRINT" => self.print(card),
            "NODEFILE" | "ELFILE" | "CONTACTFILE" | "NODEOUTPUT" | "ELEMENTOUTPUT"
            | "CONTACTOUTPUT" | "OUTPUT" => {
                self.output(card);
            }
            // What is refused of it has been said, and nothing else of it matters.
            "RESTART" => {}
            "NORMAL" => self.normal(card),
            other => unreachable_row(other),
        }
    }

    /// Whether a card says nothing that would be dropped although it changes the answer: it is an error if it does.
    fn judge(&mut self, card: &Card, row: &'static Row) -> bool {
        let before = self.errors.len();
        for (i, p) in card.parameters.iter().enumerate() {
            let name = p.name.as_str();
            if card.parameters[..i].iter().any(|q| q.name == p.name) {
                let message = format!("{}: {name} is given twice", card.written);
                self.error(card.place, message, "leave one of the two out");
            }
            match row.parameter(name) {
                Some(Fate::Read | Fate::Idle(_)) => {}
                Some(Fate::Harmless(why)) => {
                    if self.noted.insert((row.keyword, p.name.clone())) {
                        let message = format!("{}: {name} is left out: {why}", card.written);
                        self.note(card.place, message);
                    }
                }
                Some(Fate::Refused(help)) => {
                    let message = format!("{}, {name} is not supported", card.written);
                    self.error(card.place, message, help);
                }
                None => {
                    let known = match row.nearest(name) {
                        Some(near) => format!("did you mean {near}?"),
                        None if row.known().is_empty() => "it has no parameters".into(),
                        None => format!("known here: {}", row.known().join(", ")),
                    };
                    let message = format!("{} has no parameter {}", card.written, clip(name));
                    self.error(card.place, message, &known);
                }
            }
        }
        if let Some((line, field, fields)) = row.data.beyond(card) {
            let data = &card.data[line];
            let message = format!(
                "{}: field {} of this line, `{}`, is not read",
                card.written,
                field + 1,
                clip(&data.fields[field])
            );
            let help = match fields {
                "" => "the card has no data lines".to_string(),
                _ => format!("the fields are: {fields}"),
            };
            self.error(data.place, message, &help);
        }
        self.errors.len() == before
    }

    /// A parameter that must have a value.
    fn required(&mut self, card: &Card, name: &str) -> Option<String> {
        match card.get(name) {
            Some(value) if !value.is_empty() => Some(value.to_string()),
            _ => {
                let message = format!("{} needs the parameter {name}", card.written);
                self.error(
                    card.place,
                    message,
                    &format!("write {}, {name}=...", card.written),
                );
                None
            }
        }
    }

    /// A field as a number, the default where it is empty or missing.
    fn number(&mut self, data: &Data, field: usize, default: f64) -> f64 {
        let text = data.fields.get(field).map_or("", String::as_str);
        if text.is_empty() {
            return default;
        }
        match number(text) {
            Some(value) => value,
            None => {
                let message = format!(
                    "field {} is `{}`: a finite number is expected",
                    field + 1,
                    clip(text)
                );
                self.error(
                    data.place,
                    message,
                    "write numbers as 1.5, 2.E-3 or 1D4, separated by commas",
                );
                default
            }
        }
    }

    /// A field as a whole number above zero.
    fn whole(&mut self, data: &Data, field: usize) -> Option<u64> {
        let text = data.fields.get(field).map_or("", String::as_str);
        let value = whole(text);
        if value.is_none() {
            let message = format!(
                "field {} is `{}`: a whole number above 0 is expected",
                field + 1,
                clip(text)
            );
            self.error(
                data.place,
                message,
                "numbers of nodes and elements and directions count from 1",
            );
        }
        value
    }

    /// The first data line.
    fn line<'c>(&mut self, card: &'c Card) -> Option<&'c Data> {
        if card.data.is_empty() {
            self.error(
                card.place,
                format!("{} has no data line", card.written),
                "the numbers stand in the line after the keyword",
            );
        }
        card.data.first()
    }

    /// A node or a set of nodes.
    fn target(&mut self, data: &Data, field: usize) -> Option<Target> {
        let text = data.fields.get(field).map_or("", String::as_str);
        if text.is_empty() {
            self.error(
                data.place,
                "a node or a set of nodes is expected in the first field",
                "write node or set, direction, value",
            );
            return None;
        }
        Some(match whole(text) {
            Some(node) => Target::One(node),
            None => Target::Set(label(text)),
        })
    }

    /// A direction 1 to `most` as 0 to `most - 1`.
    fn direction(&mut self, data: &Data, field: usize, most: u64) -> Option<usize> {
        let d = self.whole(data, field)?;
        if d > most {
            let help = match most {
                3 => "directions are 1 (x), 2 (y) and 3 (z)",
                _ => {
                    "directions are 1 (x), 2 (y), 3 (z) and, at the reference node of a rigid body, 4 to 6"
                }
            };
            self.error(data.place, format!("there is no direction {d} here"), help);
            return None;
        }
        Some(d as usize - 1)
    }

    /// Elements by number or set.
    fn elements_of(&mut self, text: &str, place: Place) -> Vec<u64> {
        match whole(text) {
            Some(n) if self.deck.elements.contains_key(&n) => vec![n],
            Some(n) if self.skipped.contains(&n) => Vec::new(),
            Some(n) => {
                self.error(
                    place,
                    format!("there is no element {n}"),
                    "elements must stand before what refers to them",
                );
                Vec::new()
            }
            None => match self.deck.element_sets.get(&label(text)) {
                Some(set) => set.clone(),
                None if self.skipped_sets.contains(&label(text)) => Vec::new(),
                None => {
                    let help = listing("sets of elements", self.deck.element_sets.keys());
                    self.error(
                        place,
                        format!("there is no set of elements {}", clip(text)),
                        &help,
                    );
                    Vec::new()
                }
            },
        }
    }

    /// Names that may stand before what they name are looked up at the end.
    fn check_names(&mut self) {
        let mut findings: Vec<(Place, String, String)> = Vec::new();
        let deck = &self.deck;
        let mut nodes = |target: &Target, place: Place| match target {
            Target::One(n) if !deck.nodes.contains_key(n) => {
                findings.push((
                    place,
                    format!("there is no node {n}"),
                    "nodes are given by *NODE".into(),
                ));
            }
            Target::Set(s) if !deck.node_sets.contains_key(s) => {
                findings.push((
                    place,
                    format!("there is no set of nodes {s}"),
                    listing("sets of nodes", deck.node_sets.keys()),
                ));
            }
            _ => {}
        };
        for b in &deck.supports {
            nodes(&b.target, b.place);
        }
        for i in &deck.initial {
            nodes(&i.target, i.place);
        }
        for t in &deck.temperatures {
            nodes(&t.target, t.place);
        }
        for p in &deck.pairs {
            if let Some(crate::deck::Adjust::Set(name)) = &p.adjust {
                nodes(&Target::Set(name.clone()), p.place);
            }
        }
        for e in &deck.equations {
            e.terms.iter().for_each(|t| nodes(&t.target, e.place));
        }
        for a in deck.steps.iter().flat_map(|s| &s.actions) {
            match a {
                Action::Boundary(b) => nodes(&b.target, b.place),
                Action::Force { target, place, .. } => nodes(target, *place),
                _ => {}
            }
        }
        let mut named = |what: &str, name: &str, place: Place, known: Vec<&String>| {
            if !known.iter().any(|k| *k == name) {
                findings.push((
                    place,
                    format!("there is no {what} {name}"),
                    listing(&format!("known {what}s"), known),
                ));
            }
        };
        let surfaces = || deck.surfaces.keys().collect::<Vec<_>>();
        for p in &deck.pairs {
            named("surface", &p.slave, p.place, surfaces());
            named("surface", &p.master, p.place, surfaces());
            named(
                "surface interaction",
                &p.interaction,
                p.place,
                deck.interactions.keys().collect(),
            );
        }
        for t in &deck.ties {
            named("surface", &t.slave, t.place, surfaces());
            named("surface", &t.master, t.place, surfaces());
        }
        for s in &deck.sections {
            named(
                "set of elements",
                &s.set,
                s.place,
                deck.element_sets.keys().collect(),
            );
            named(
                "material",
                &s.material,
                s.place,
                deck.materials.keys().collect(),
            );
            if let Some(o) = &s.orientation {
                named(
                    "orientation",
                    o,
                    s.place,
                    deck.orientations.keys().collect(),
                );
            }
        }
        let amplitudes = || deck.amplitudes.keys().collect::<Vec<_>>();
        for a in deck.steps.iter().flat_map(|s| &s.actions) {
            match a {
                Action::Boundary(Boundary {
                    amplitude: Some(name),
                    place,
                    ..
                })
                | Action::Force {
                    amplitude: Some(name),
                    place,
                    ..
                }
                | Action::Distributed {
                    amplitude: Some(name),
                    place,
                    ..
                } => named("amplitude", name, *place, amplitudes()),
                Action::ChangeFriction(name, _, place) | Action::ChangeBehavior(name, _, place) => {
                    named(
                        "surface interaction",
                        name,
                        *place,
                        deck.interactions.keys().collect(),
                    );
                }
                _ => {}
            }
            if let Action::Distributed {
                load: Distributed::Surface(name, _),
                place,
                ..
            } = a
            {
                named("surface", name, *place, surfaces());
            }
        }
        for (place, message, help) in findings {
            self.error(place, message, &help);
        }
        self.errors.sort_by_key(|f| {
            self.source
                .files
                .iter()
                .position(|p| *p == f.file)
                .map(|p| (p, f.line))
        });
    }
}

use crate::deck::{Action, Boundary, Distributed};

/// The table calls a card read for which there is no reader: a mistake here, which the test of the table finds.
fn unreachable_row(keyword: &str) {
    debug_assert!(false, "*{keyword} is read by nothing");
}

/// A number as Fortran reads it: `1.D5` is 1e5.
pub(crate) fn number(text: &str) -> Option<f64> {
    let mut text = text.trim().replace(['d', 'D'], "e");
    // Rust reads words as numbers that decks must not contain.
    let plain = text
        .bytes()
        .all(|b| b.is_ascii_digit() || b"+-.eE".contains(&b));
    if !plain {
        return None;
    }
    // `1.5+3`: Fortran leaves the letter out where the exponent is long, and reads it so.
    if !text.contains(['e', 'E'])
        && let Some(at) = text.char_indices().skip(1).find(|(_, c)| "+-".contains(*c))
    {
        text.insert(at.0, 'e');
    }
    text.parse().ok().filter(|v: &f64| v.is_finite())
}

pub(crate) fn whole(text: &str) -> Option<u64> {
    let text = text.trim();
    // A few programs write node numbers with a point.
    let digits = text.strip_suffix('.').unwrap_or(text);
    digits
        .parse()
        .ok()
        .filter(|n| (1..=u64::from(u32::MAX)).contains(n))
}

/// A text that is short enough for a message.
pub(crate) fn clip(text: &str) -> String {
    match text.char_indices().nth(40) {
        Some((at, _)) => format!("{}...", &text[..at]),
        None => text.to_string(),
    }
}

/// What there is, for a help.
fn listing<S: AsRef<str>>(what: &str, names: impl IntoIterator<Item = S>) -> String {
    let names: Vec<String> = names
        .into_iter()
        .take(20)
        .map(|n| n.as_ref().to_string())
        .collect();
    match names.is_empty() {
        true => format!("the deck has no {what}"),
        false => format!("{what}: {}", names.join(", ")),
    }
}

/// The value of a parameter that is a number.
fn parameter(reader: &mut Reader, card: &Card, name: &str) -> Option<f64> {
    let text = card.get(name)?;
    let value = number(text);
    if value.is_none() {
        let message = format!(
            "{}: {name} is `{}`: a number is expected",
            card.written,
            clip(text)
        );
        reader.error(card.place, message, "write it as 1.5 or 2.E-3");
    }
    value
}

/// A list of keys such as `U, RF`, over all data lines.
fn keys(card: &Card) -> Vec<String> {
    card.data
        .iter()
        .flat_map(|d| d.fields.iter().map(|f| squeeze(f)))
        .filter(|k| !k.is_empty())
        .collect()
}

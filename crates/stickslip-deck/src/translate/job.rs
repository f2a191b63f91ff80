//! A translation under way: what has been written and said.

use std::collections::BTreeMap;

use stickslip::problem::{self, Increments, Problem, SpaceKind};

use super::part::Part;
use super::spans::duration;
use crate::card::Place;
use crate::deck::{Deck, Target};
use crate::finding::{DeckError, Finding, Severity};

/// A translation under way.
pub(super) struct Job<'a> {
    pub(super) deck: &'a Deck,
    pub(super) problem: Problem,
    pub(super) errors: Vec<Finding>,
    pub(super) notes: Vec<Finding>,
    pub(super) places: Vec<(String, Place)>,
    pub(super) pairs: Vec<(String, String, String)>,
    /// Tables that act in some steps only.
    pub(super) active: Vec<Active>,
    /// Which loads are written.
    pub(super) part: Part,
    /// Loads that shake: name, part, by step.
    pub(super) shaking: Vec<(String, Part, Vec<bool>)>,
    /// Starts and lengths of the steps.
    pub(super) spans: Vec<[f64; 2]>,
    /// Whether the deck asks for large strains (`NLGEOM`), and bodies do not turn: how large they become has to be judged.
    pub(super) strains: bool,
}

impl<'a> Job<'a> {
    pub(super) fn new(deck: &'a Deck) -> Self {
        let model = problem::Model {
            space: SpaceKind::Solid,
            thickness: None,
        };
        let mut problem = Problem::new(model);
        problem.step = deck.steps.iter().map(|s| step(duration(s))).collect();
        let mut start = 0.0;
        let spans = deck.steps.iter().map(|s| {
            let length = duration(s);
            start += length;
            [start - length, length]
        });
        Job {
            deck,
            problem,
            errors: Vec::new(),
            notes: Vec::new(),
            places: Vec::new(),
            pairs: Vec::new(),
            active: Vec::new(),
            part: Part::Lasting,
            shaking: Vec::new(),
            spans: spans.collect(),
            strains: false,
        }
    }

    pub(super) fn failed(mut self) -> DeckError {
        let files = &self.deck.output.files;
        self.errors
            .sort_by_key(|f| (files.iter().position(|p| *p == f.file), f.line));
        DeckError {
            findings: self.errors,
        }
    }

    pub(super) fn finding(
        &self,
        severity: Severity,
        place: Place,
        message: String,
        help: &str,
    ) -> Finding {
        Finding {
            severity,
            file: self
                .deck
                .output
                .files
                .get(place.file)
                .cloned()
                .unwrap_or_default(),
            line: place.line,
            message,
            help: (!help.is_empty()).then(|| help.to_string()),
        }
    }

    pub(super) fn error(&mut self, place: Place, message: impl Into<String>, help: &str) {
        let finding = self.finding(Severity::Error, place, message.into(), help);
        // A line may say something of many nodes; that it is wrong is said once.
        let same = |f: &Finding| {
            f.line == finding.line && f.message == finding.message && f.file == finding.file
        };
        if !self.errors.iter().any(same) {
            self.errors.push(finding);
        }
    }

    pub(super) fn note(&mut self, place: Place, message: impl Into<String>) {
        let finding = self.finding(Severity::Note, place, message.into(), "");
        self.notes.push(finding);
    }

    pub(super) fn warn(&mut self, place: Place, message: impl Into<String>, help: &str) {
        let finding = self.finding(Severity::Warning, place, message.into(), help);
        self.notes.push(finding);
    }

    /// Adds a table that comes from a place of the deck.
    pub(super) fn add<T: Named>(&mut self, name: impl Into<String>, place: Place, table: T) {
        let name = name.into();
        self.places.push((format!("{}.{name}", T::KIND), place));
        T::all(&mut self.problem).insert(name, table);
    }

    /// Says in which steps a table acts.
    pub(super) fn acts<T: Listed>(&mut self, name: String, steps: Vec<bool>) {
        let kind = T::KIND;
        self.active.push(Active { kind, name, steps });
    }

    /// The nodes of a card.
    pub(super) fn nodes(&self, target: &Target) -> Vec<u64> {
        match target {
            Target::One(n) => vec![*n],
            Target::Set(name) => self.deck.node_sets.get(name).cloned().unwrap_or_default(),
        }
    }

    /// A name that no other table of the kind has yet.
    pub(super) fn fresh<T: Named>(&mut self, wanted: &str) -> String {
        let all = T::all(&mut self.problem);
        if !all.contains_key(wanted) {
            return wanted.to_string();
        }
        let more = (2..).map(|i| format!("{wanted}-{i}"));
        let mut free = more.filter(|name| !all.contains_key(name));
        free.next().unwrap_or_default()
    }
}

/// A kind of table of which a problem has any number, by name.
pub(super) trait Named: Sized {
    /// Its key in the problem.
    const KIND: &'static str;

    fn all(problem: &mut Problem) -> &mut BTreeMap<String, Self>;
}

macro_rules! named {
    ($($table:ident $kind:ident),+) => {
        $(impl Named for problem::$table {
            const KIND: &'static str = stringify!($kind);

            fn all(problem: &mut Problem) -> &mut BTreeMap<String, Self> {
                &mut problem.$kind
            }
        })+
    };
}

named!(
    AmplitudeTable amplitude, Body body, Coupling coupling, Initial initial, Interface interface, Load load, Mass mass,
    Material material, Pretension pretension, Probe probe, Reference reference, Support support, Temperature temperature
);

/// A kind of table of which a step can list those that act in it.
pub(super) trait Listed: Named {
    fn list(step: &mut problem::Step) -> &mut Option<Vec<String>>;
}

macro_rules! listed {
    ($($table:ident $list:ident),+) => {
        $(impl Listed for problem::$table {
            fn list(step: &mut problem::Step) -> &mut Option<Vec<String>> {
                &mut step.$list
            }
        })+
    };
}

listed!(
    Support supports, Load loads, Temperature temperatures, Interface interfaces, Coupling couplings
);

/// The steps in which a table acts.
pub(super) struct Active {
    /// [`Named::KIND`]
    pub(super) kind: &'static str,
    pub(super) name: String,
    pub(super) steps: Vec<bool>,
}

/// A step in which nothing is said but how long it takes.
fn step(duration: f64) -> problem::Step {
    problem::Step {
        name: None,
        duration,
        supports: None,
        loads: None,
        temperatures: None,
        interfaces: None,
        couplings: None,
        pretension: BTreeMap::new(),
        change: BTreeMap::new(),
        cycles: None,
        steady: None,
        modes: None,
        complex_modes: None,
        harmonic: None,
        increments: Increments::default(),
        dynamic: None,
        kick: None,
    }
}

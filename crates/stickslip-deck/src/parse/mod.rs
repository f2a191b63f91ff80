//! Cards to a [`Deck`].

mod elements;
mod fields;
mod initial;
mod interaction;
mod judge;
mod links;
mod loads;
mod material;
mod names;
mod nodes;
mod orientation;
mod output;
mod pairs;
mod reader;
mod sets;
mod step;
mod surfaces;
mod times;
mod unused;

use std::path::Path;

use reader::{Context, Reader};

use crate::card::{Card, Place};
use crate::deck::Deck;
use crate::finding::DeckError;
use crate::source::Source;
use crate::table::{self, Fate};

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

impl Reader<'_> {
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
        self.deck.unused = unused::unused(self.source);
        if self.errors.is_empty() {
            Ok(self.deck)
        } else {
            Err(DeckError {
                findings: self.errors,
            })
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
}

/// The table calls a card read for which there is no reader: a mistake here, which the test of the table finds.
fn unreachable_row(keyword: &str) {
    debug_assert!(false, "*{keyword} is read by nothing");
}

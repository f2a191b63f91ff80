//! Cards to a [`Deck`].

mod beyond;
mod couplings;
mod elements;
mod fields;
mod generate;
mod generate_elements;
mod harmonic;
mod initial;
mod instances;
mod interaction;
mod judge;
mod known;
mod links;
mod loads;
mod material;
mod material_motion;
mod names;
mod nodes;
mod orientation;
mod output;
mod pairs;
mod reader;
mod scope;
mod sets;
mod step;
mod structure;
mod surfaces;
mod table;
mod times;
mod uncomputed;
mod unused;

use std::path::Path;

use reader::{Context, Reader};
use structure::Level;
use table::{Fate, Row};

use crate::card::{Card, Place};
use crate::deck::Deck;
use crate::finding::DeckError;
use crate::source::Source;

impl Deck {
    /// Reads a deck and all it includes.
    ///
    /// # Errors
    /// Everything that is wrong or not supported, each with file and line.
    pub fn read(path: &Path) -> Result<Deck, DeckError> {
        Deck::from_source(&Source::read(path, parameters)?)
    }

    /// The same from the bytes of the first file; `path` is for messages, and for the folder of included files.
    ///
    /// # Errors
    /// Those of [`Deck::read`].
    pub fn parse(bytes: &[u8], path: &Path) -> Result<Deck, DeckError> {
        Deck::from_source(&Source::parse(bytes, path, parameters)?)
    }

    /// The meaning of cards.
    ///
    /// # Errors
    /// Those of [`Deck::read`].
    pub fn from_source(source: &Source) -> Result<Deck, DeckError> {
        let mut reader = Reader::new(source);
        reader.deck.numbering = instances::numbering(source);
        for (place, message) in &source.forgiven {
            reader.note(*place, message.clone());
        }
        for (at, card) in source.cards.iter().enumerate() {
            reader.structure.at = at;
            reader.card(card);
        }
        reader.finish()
    }
}

/// The names of the parameters of a keyword.
fn parameters(keyword: &str) -> Option<Vec<&'static str>> {
    table::row(keyword).map(Row::names)
}

impl Reader<'_> {
    fn finish(mut self) -> Result<Deck, DeckError> {
        let end = Place::default();
        if !self.messages.stopped {
            self.close_all();
        }
        if self.messages.stopped || self.structure.incomplete {
            return Err(DeckError {
                findings: self.verdict(),
            });
        }
        self.judge_waiting();
        self.judge_bounding();
        self.judge_absent();
        if self.deck.nodes.is_empty() && self.sound() {
            self.error(end, "the deck has no nodes", "give them with *NODE");
        }
        if self.deck.elements.is_empty() && self.sound() {
            self.error(
                end,
                "the deck has no elements",
                "give them with *ELEMENT, TYPE=...",
            );
        }
        if self.position.in_step {
            self.step_without_procedure();
            let place = self.deck.steps.last().map_or(end, |s| s.place);
            self.warn(place, "the last step has no *END STEP", "");
        }
        self.check_names();
        self.deck.unused = unused::unused(self.source);
        match self.sound() {
            true => Ok(self.deck),
            false => Err(DeckError {
                findings: self.verdict(),
            }),
        }
    }

    /// The row of a card that is read; says what is to be said of others.
    fn row(&mut self, card: &Card) -> Option<&'static Row> {
        let Some(row) = table::row(&card.keyword) else {
            let help = match table::nearest(&card.keyword) {
                Some(name) => format!("did you mean *{name}? (blanks and case do not matter)"),
                None => "it is no keyword of CalculiX or Abaqus that stickslip knows; comments begin with **".into(),
            };
            let message = format!("unknown keyword {}", card.written);
            self.messages.formal.insert(card.place);
            self.error(card.place, message, &help);
            return None;
        };
        match row.fate {
            Fate::Read => return Some(row),
            Fate::Harmless(why) | Fate::Idle(why) => {
                self.note(card.place, format!("{} is left out: {why}", card.written));
            }
            Fate::Refused(help) => {
                // One finding a cause: the step has a procedure, if not one of ours.
                self.position.procedure |= row.procedure;
                self.card_beyond(card, help);
            }
        }
        None
    }

    fn card(&mut self, card: &Card) {
        if self.messages.stopped {
            return;
        }
        let Some(row) = self.row(card) else {
            return;
        };
        let sound = self.judge(card, row);
        self.close_before(card, row);
        if !self.in_its_place(card, row) {
            return;
        }
        if self.structure.incomplete && row.level != Level::Structure {
            return;
        }
        if !row.beneath {
            self.position.context = Context::None;
        }
        if !(sound || row.kept) {
            // What follows builds on what is not there.
            self.messages.stopped = card.keyword == "RESTART";
            if self.messages.stopped {
                self.messages.beyond.clear();
                self.messages.errors.retain(|f| f.line == card.place.line);
            }
            return;
        }
        if self.record(row) {
            return;
        }
        if let Some(read) = row.reader {
            read(self, card);
        }
    }
}

//! Cards to a [`Deck`].

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
mod messages;
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
use crate::motion::Motion;
use crate::source::Source;

/// Reads a deck and all it includes.
///
/// # Errors
/// Everything that is wrong or not supported, each with file and line.
pub fn read(path: &Path) -> Result<Deck, DeckError> {
    from_source(&Source::read(path, parameters)?)
}

/// The same from the bytes of the first file; `path` is for messages, and for the folder of included files.
///
/// # Errors
/// Those of [`read`].
pub fn parse(bytes: &[u8], path: &Path) -> Result<Deck, DeckError> {
    from_source(&Source::parse(bytes, path, parameters)?)
}

/// The meaning of cards.
///
/// # Errors
/// Those of [`read`].
pub fn from_source(source: &Source) -> Result<Deck, DeckError> {
    let mut reader = Reader::new(source);
    reader.scope.numbering = instances::numbering(source);
    for (place, message) in &source.forgiven {
        reader.messages.note(*place, message.clone());
    }
    for (at, card) in source.cards.iter().enumerate() {
        reader.structure.at = at;
        read_card(&mut reader, card);
    }
    finish(reader)
}

/// The names of the parameters of a keyword.
fn parameters(keyword: &str) -> Option<Vec<&'static str>> {
    table::row(keyword).map(Row::names)
}

fn finish(mut reader: Reader) -> Result<Deck, DeckError> {
    let end = Place::default();
    if !reader.messages.stopped {
        instances::close_all(&mut reader);
    }
    if reader.messages.stopped || reader.structure.incomplete {
        let findings = reader.messages.verdict();
        return Err(DeckError { findings });
    }
    elements::judge_waiting(&mut reader);
    elements::judge_bounding(&mut reader);
    sets::judge_absent(&mut reader);
    let messages = &mut reader.messages;
    if reader.deck.nodes.is_empty() && messages.sound() {
        messages.error(end, "the deck has no nodes", "give them with *NODE");
    }
    if reader.deck.elements.is_empty() && messages.sound() {
        let help = "give them with *ELEMENT, TYPE=...";
        messages.error(end, "the deck has no elements", help);
    }
    if reader.position.in_step {
        step::step_without_procedure(&mut reader);
        let place = reader.deck.steps.last().map_or(end, |s| s.place);
        let message = "the last step has no *END STEP";
        reader.messages.warn(place, message, "");
    }
    reader.deck.numbering.clone_from(&reader.scope.numbering);
    names::check_names(&mut reader);
    reader.deck.unused = unused::unused(reader.source);
    if !reader.messages.sound() {
        let findings = reader.messages.verdict();
        return Err(DeckError { findings });
    }
    reader.deck.notes = reader.messages.notes;
    Ok(reader.deck)
}

/// The row of a card that is read; says what is to be said of others.
fn row(reader: &mut Reader, card: &Card) -> Option<&'static Row> {
    let messages = &mut reader.messages;
    let Some(row) = table::row(&card.keyword) else {
        let help = match table::nearest(&card.keyword) {
            Some(name) => format!("did you mean *{name}? (blanks and case do not matter)"),
            None => "it is no keyword of CalculiX or Abaqus that stickslip knows; comments begin with **".into(),
        };
        let message = format!("unknown keyword {}", card.written);
        messages.misspelt(card.place);
        messages.error(card.place, message, &help);
        return None;
    };
    match row.fate {
        Fate::Read => return Some(row),
        Fate::Harmless(why) | Fate::Idle(why) => {
            messages.note(card.place, format!("{} is left out: {why}", card.written));
        }
        Fate::Refused(help) => {
            // One finding a cause: the step has a procedure, if not one of ours.
            reader.position.procedure |= row.procedure;
            let kind = table::kind_of_card(&card.keyword, help);
            messages.card_beyond(card, kind, help);
        }
    }
    None
}

fn read_card(reader: &mut Reader, card: &Card) {
    if reader.messages.stopped {
        return;
    }
    let Some(row) = row(reader, card) else {
        return;
    };
    let sound = judge::judge(&mut reader.messages, card, row);
    instances::close_before(reader, card, row.level);
    if !instances::in_its_place(reader, card, row.level, row.beneath) {
        return;
    }
    if reader.structure.incomplete && row.level != Level::Structure {
        return;
    }
    if !row.beneath {
        reader.position.context = Context::None;
    }
    if !(sound || row.kept) {
        // What follows builds on what is not there.
        if card.keyword == "RESTART" {
            reader.messages.stop(card.place);
        }
        return;
    }
    if instances::record(&mut reader.structure, row.level) {
        return;
    }
    if let Some(read) = row.reader {
        read(reader, card);
        read_part(reader);
    }
}

/// Reads the cards of a part for the instance that has been opened.
fn read_part(reader: &mut Reader) {
    let Some(name) = reader.structure.due.take() else {
        return;
    };
    let part = &reader.structure.parts[&name];
    reader.messages.again = part.instances > 1;
    for i in part.cards.clone() {
        let card = &reader.source.cards[i];
        if let Some(read) = table::row(&card.keyword).and_then(|r| r.reader) {
            read(reader, card);
        }
    }
    reader.messages.again = false;
    // Axes of the part are not those of what the instance adds.
    reader.system = Motion::NONE;
}

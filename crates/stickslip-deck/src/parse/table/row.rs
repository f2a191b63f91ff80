//! A row of the table: what becomes of a card, of its parameters and of its data.

use crate::card::Card;
use crate::parse::reader::Reader;
use crate::parse::structure::Level;
use crate::text::number;

/// What becomes of a card or a parameter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Fate {
    /// It is read.
    Read,
    /// It is left out, as it cannot change the answer; why. A note says so.
    Harmless(&'static str),
    /// The same, and so usual that no note is worth reading.
    Idle(&'static str),
    /// It changes the answer and is not supported; what to do.
    Refused(&'static str),
}

/// What may stand in the data lines of a card.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Data {
    /// Lists of any length, or lines that the parser judges.
    Any,
    /// Nothing.
    Nothing,
    /// Lines of these fields.
    Lines(&'static str),
    /// One line of these fields.
    Line(&'static str),
}

/// A parameter of a card.
#[derive(Debug, Clone, Copy)]
pub struct Parameter {
    /// In capitals, without blanks.
    pub name: &'static str,
    pub fate: Fate,
}

/// What reads a card.
pub type Read = fn(&mut Reader<'_>, &Card);

/// What becomes of a card.
#[derive(Debug, Clone, Copy)]
pub struct Row {
    /// In capitals, without blanks and star.
    pub keyword: &'static str,
    pub fate: Fate,
    /// Of a card whose fate is to be read.
    pub reader: Option<Read>,
    pub level: Level,
    /// Whether it stands beneath a material or an interaction.
    pub beneath: bool,
    /// Whether it is read in spite of errors: that what it names is missing would only be a second one.
    pub kept: bool,
    /// Whether it is a procedure of a step that is refused.
    pub procedure: bool,
    pub data: Data,
    pub parameters: &'static [Parameter],
    /// What becomes of parameters that are not listed; they are errors if nothing is said.
    pub others: Option<Fate>,
}

impl Row {
    /// The same at a level.
    pub const fn at(mut self, level: Level) -> Row {
        self.level = level;
        self
    }

    /// The same beneath a material or an interaction.
    pub const fn beneath(mut self) -> Row {
        self.beneath = true;
        self
    }

    /// The same, read in spite of errors.
    pub const fn kept(mut self) -> Row {
        self.kept = true;
        self
    }

    /// The same as a procedure.
    pub const fn procedure(mut self) -> Row {
        self.procedure = true;
        self
    }

    /// The names of all parameters.
    pub fn names(&self) -> Vec<&'static str> {
        self.parameters.iter().map(|p| p.name).collect()
    }

    /// What becomes of a parameter; `None` if the card has no such parameter.
    pub fn parameter(&self, name: &str) -> Option<Fate> {
        let listed = self.parameters.iter().find(|p| p.name == name);
        listed.map(|p| p.fate).or(self.others)
    }

    /// The parameters that have a meaning.
    pub fn known(&self) -> Vec<&'static str> {
        let read = self.parameters.iter().filter(|p| p.fate == Fate::Read);
        read.map(|p| p.name).collect()
    }

    /// The parameter that is most like this one.
    pub fn nearest(&self, name: &str) -> Option<&'static str> {
        nearest_of(name, self.parameters.iter().map(|p| p.name))
    }
}

impl Data {
    /// The first field of a card that stands where nothing is read, with its line: `(data line, field, what is read)`. Fields that are empty or zero
    /// say nothing.
    pub fn beyond(self, card: &Card) -> Option<(usize, usize, &'static str)> {
        let (fields, lines) = match self {
            Data::Any => return None,
            Data::Nothing => ("", 0),
            Data::Line(fields) => (fields, 1),
            Data::Lines(fields) => (fields, usize::MAX),
        };
        let count = fields.split(", ").filter(|f| !f.is_empty()).count();
        let means = |text: &String| !text.is_empty() && number(text) != Some(0.0);
        card.data.iter().enumerate().find_map(|(i, data)| {
            let from = if i < lines { count } else { 0 };
            let field = data.fields.iter().skip(from).position(means)?;
            Some((i, from + field, fields))
        })
    }
}

/// A card that is read.
pub(super) const fn card(
    keyword: &'static str,
    reader: Read,
    data: Data,
    parameters: &'static [Parameter],
) -> Row {
    Row {
        reader: Some(reader),
        data,
        parameters,
        ..unread(keyword, Fate::Read)
    }
}

const fn unread(keyword: &'static str, fate: Fate) -> Row {
    Row {
        keyword,
        fate,
        reader: None,
        level: Level::Model,
        beneath: false,
        kept: false,
        procedure: false,
        data: Data::Any,
        parameters: &[],
        others: None,
    }
}

/// A card that is left out because of what it is about, whatever its parameters are.
pub(super) const fn harmless_card(keyword: &'static str, why: &'static str) -> Row {
    Row {
        others: Some(Fate::Harmless(why)),
        ..unread(keyword, Fate::Harmless(why))
    }
}

/// A card that is refused.
pub(super) const fn refused_card(keyword: &'static str, help: &'static str) -> Row {
    unread(keyword, Fate::Refused(help))
}

pub(super) const fn read(name: &'static str) -> Parameter {
    Parameter {
        name,
        fate: Fate::Read,
    }
}

pub(super) const fn harmless(name: &'static str, why: &'static str) -> Parameter {
    Parameter {
        name,
        fate: Fate::Harmless(why),
    }
}

pub(super) const fn idle(name: &'static str, why: &'static str) -> Parameter {
    Parameter {
        name,
        fate: Fate::Idle(why),
    }
}

pub(super) const fn refused(name: &'static str, help: &'static str) -> Parameter {
    Parameter {
        name,
        fate: Fate::Refused(help),
    }
}

/// What several cards say of a parameter.
pub(super) const INPUT: Parameter = refused(
    "INPUT",
    "put the lines of that file here by *INCLUDE, INPUT=...",
);

/// Why what controls the solution of equations is left out.
pub(super) const NUMERICS: &str =
    "it controls how equations are solved, not what their solution is";

/// What to do instead of a user subroutine.
pub(super) const SUBROUTINE: &str =
    "user subroutines are not called: write the values into the deck";

/// Of several words the one that is most like this one, if one is.
pub(super) fn nearest_of(
    word: &str,
    known: impl Iterator<Item = &'static str>,
) -> Option<&'static str> {
    // Of a line of anything that stands where a word should the beginning is enough.
    let start: String = word.chars().take(64).collect();
    let edits = |k: &'static str| (strsim::levenshtein(&start, k), k);
    let best = known.map(edits).min()?;
    (best.0 <= 2 + word.len() / 8).then_some(best.1)
}

//! What becomes of every card of the format, of its parameters and of its data: one row a keyword.
//!
//! Nothing is dropped without being here. A card or parameter is read, left out because it cannot change the answer (the row says why, and so does a
//! note), or refused (the row says what to do); what is in no row is an error at its line. The parser asks for no parameter that its row does not
//! call read, and the row calls none read that the parser does not ask for; a test holds the two together.

mod contact;
mod material;
mod mesh;
mod output;
mod refused;
mod step;
#[cfg(test)]
mod tests;

use crate::source::Card;

/// What becomes of a card or a parameter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Fate {
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
pub(crate) enum Data {
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
pub(crate) struct Parameter {
    /// In capitals, without blanks.
    pub name: &'static str,
    pub fate: Fate,
}

/// What becomes of a card.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Row {
    /// In capitals, without blanks and star.
    pub keyword: &'static str,
    pub fate: Fate,
    pub data: Data,
    pub parameters: &'static [Parameter],
    /// What becomes of parameters that are not listed; they are errors if nothing is said.
    pub others: Option<Fate>,
}

/// A card that is read.
const fn card(keyword: &'static str, data: Data, parameters: &'static [Parameter]) -> Row {
    Row {
        keyword,
        fate: Fate::Read,
        data,
        parameters,
        others: None,
    }
}

/// A card that is left out because of what it is about, whatever its parameters are.
const fn harmless_card(keyword: &'static str, why: &'static str) -> Row {
    Row {
        keyword,
        fate: Fate::Harmless(why),
        data: Data::Any,
        parameters: &[],
        others: Some(Fate::Harmless(why)),
    }
}

/// A card that is refused.
const fn refused_card(keyword: &'static str, help: &'static str) -> Row {
    Row {
        keyword,
        fate: Fate::Refused(help),
        data: Data::Any,
        parameters: &[],
        others: None,
    }
}

const fn read(name: &'static str) -> Parameter {
    Parameter {
        name,
        fate: Fate::Read,
    }
}

const fn harmless(name: &'static str, why: &'static str) -> Parameter {
    Parameter {
        name,
        fate: Fate::Harmless(why),
    }
}

const fn idle(name: &'static str, why: &'static str) -> Parameter {
    Parameter {
        name,
        fate: Fate::Idle(why),
    }
}

const fn refused(name: &'static str, help: &'static str) -> Parameter {
    Parameter {
        name,
        fate: Fate::Refused(help),
    }
}

/// What several cards say of a parameter.
const INPUT: Parameter = refused(
    "INPUT",
    "put the lines of that file here by *INCLUDE, INPUT=...",
);
const NUMERICS: &str = "it controls how equations are solved, not what their solution is";
const SUBROUTINE: &str = "user subroutines are not called: write the values into the deck";

/// All rows.
pub(crate) fn rows() -> impl Iterator<Item = &'static Row> {
    [
        mesh::ROWS,
        material::ROWS,
        contact::ROWS,
        step::ROWS,
        output::ROWS,
        refused::ROWS,
    ]
    .into_iter()
    .flatten()
}

/// The row of a keyword, in capitals without blanks.
pub(crate) fn row(keyword: &str) -> Option<&'static Row> {
    rows().find(|r| r.keyword == keyword)
}

impl Row {
    /// Whether a parameter is listed.
    pub fn lists(&self, name: &str) -> bool {
        self.parameters.iter().any(|p| p.name == name)
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
        let means = |text: &String| !text.is_empty() && crate::parse::number(text) != Some(0.0);
        card.data.iter().enumerate().find_map(|(i, data)| {
            let from = if i < lines { count } else { 0 };
            let field = data.fields.iter().skip(from).position(means)?;
            Some((i, from + field, fields))
        })
    }
}

/// The keyword that is most like this one, if one is.
pub(crate) fn nearest(keyword: &str) -> Option<&'static str> {
    nearest_of(keyword, rows().map(|r| r.keyword))
}

fn nearest_of(word: &str, known: impl Iterator<Item = &'static str>) -> Option<&'static str> {
    // Of a line of anything that stands where a word should the beginning is enough.
    let start: String = word.chars().take(64).collect();
    let edits = |k: &'static str| (strsim::levenshtein(&start, k), k);
    let best = known.map(edits).min()?;
    (best.0 <= 2 + word.len() / 8).then_some(best.1)
}

//! A row of the table: what becomes of a card, of its parameters and of its data.

use crate::card::Card;
use crate::text::number;

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

impl Row {
    /// Whether a parameter is listed.
    pub fn lists(&self, name: &str) -> bool {
        self.parameters.iter().any(|p| p.name == name)
    }

    /// The parameter that begins with a name of at least four letters, where others that do only go on from it.
    pub fn abbreviated(&self, name: &str) -> Option<&'static str> {
        if name.len() < 4 || self.lists(name) {
            return None;
        }
        let all = || {
            let names = self.parameters.iter().map(|p| p.name);
            names.filter(|n| n.starts_with(name))
        };
        let shortest = all().min_by_key(|n| n.len())?;
        all().all(|n| n.starts_with(shortest)).then_some(shortest)
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
    data: Data,
    parameters: &'static [Parameter],
) -> Row {
    Row {
        keyword,
        fate: Fate::Read,
        data,
        parameters,
        others: None,
    }
}

/// A card that is left out because of what it is about, whatever its parameters are.
pub(super) const fn harmless_card(keyword: &'static str, why: &'static str) -> Row {
    Row {
        keyword,
        fate: Fate::Harmless(why),
        data: Data::Any,
        parameters: &[],
        others: Some(Fate::Harmless(why)),
    }
}

/// A card that is refused.
pub(super) const fn refused_card(keyword: &'static str, help: &'static str) -> Row {
    Row {
        keyword,
        fate: Fate::Refused(help),
        data: Data::Any,
        parameters: &[],
        others: None,
    }
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

//! What becomes of every card of the format, of its parameters and of its data, where it may stand and what reads it: one row a keyword.
//!
//! Nothing is dropped without being here. A card or parameter is read, left out because it cannot change the answer (the row says why, and so does a
//! note), or refused (the row says what to do); what is in no row is an error at its line. The parser asks for no parameter that its row does not
//! call read, and the row calls none read that the parser does not ask for; a test holds the two together.

mod contact;
mod kinds;
mod material;
mod mesh;
mod output;
mod refused;
mod row;
mod step;
#[cfg(test)]
mod tests;

pub(super) use kinds::kind_of_card;
use row::nearest_of;
pub(super) use row::{Fate, Row};

/// All rows.
pub(super) fn rows() -> impl Iterator<Item = &'static Row> {
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
pub(super) fn row(keyword: &str) -> Option<&'static Row> {
    rows().find(|r| r.keyword == keyword)
}

/// The keyword that is most like this one, if one is.
pub(super) fn nearest(keyword: &str) -> Option<&'static str> {
    nearest_of(keyword, rows().map(|r| r.keyword))
}

//! Nothing that a card says is dropped: its parameters and data are held against its row of the table.

use super::messages::Messages;
use super::table::{Fate, Row};
use crate::card::Card;
use crate::text::clip;

/// Whether a card says nothing that would be dropped although it changes the answer: it is an error if it does.
pub(super) fn judge(messages: &mut Messages, card: &Card, row: &'static Row) -> bool {
    let before = messages.count();
    let mut refused = 0;
    for (i, p) in card.parameters.iter().enumerate() {
        let name = p.name.as_str();
        if card.parameters[..i].iter().any(|q| q.name == p.name) {
            let message = format!("{}: {name} is given twice", card.written);
            messages.error(card.place, message, "leave one of the two out");
        }
        match row.parameter(name) {
            Some(Fate::Read | Fate::Idle(_)) => {}
            Some(Fate::Harmless(why)) => messages.note_parameter(card, row.keyword, name, why),
            Some(Fate::Refused(help)) => {
                let message = format!("{}, {name} is not supported", card.written);
                messages.error(card.place, message, help);
                refused += 1;
            }
            None => {
                let known = match row.nearest(name) {
                    Some(near) => format!("did you mean {near}?"),
                    None if row.known().is_empty() => "it has no parameters".into(),
                    None => format!("known here: {}", row.known().join(", ")),
                };
                let message = format!("{} has no parameter {}", card.written, clip(name));
                messages.error(card.place, message, &known);
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
        messages.error(data.place, message, &help);
    }
    // What is refused of a card goes with what is not computed, if there is such; what is misspelt is wrong whatever else there is.
    let wrong = messages.count() - before;
    if wrong > refused {
        messages.misspelt(card.place);
    }
    wrong == 0
}

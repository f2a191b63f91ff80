//! Materials and sections.

use super::fields::{line, number, parameter, required, required_name};
use super::messages::Messages;
use super::reader::{Context, Reader};
use crate::card::{Card, Data};
use crate::deck::{Elastic, Expansion, Material, Section};
use crate::text::clip;

/// Constants of a material by temperature: `count` numbers and a temperature a row, eight numbers a line, whatever is missing at its end.
fn rows(messages: &mut Messages, card: &Card, count: usize) -> Vec<(f64, Vec<f64>)> {
    let lines = (count + 1).div_ceil(8);
    let last = (count + 1) - 8 * (lines - 1);
    let mut out = Vec::new();
    for row in card.data.chunks(lines) {
        let mut numbers: Vec<f64> = Vec::with_capacity(8 * lines);
        for data in row {
            numbers.extend((0..8).map(|i| number(messages, data, i, 0.0)));
        }
        numbers.resize(8 * lines, 0.0);
        if numbers[count + 1..].iter().any(|n| *n != 0.0) {
            let place = row.last().map_or(card.place, |d| d.place);
            let message = format!(
                "{}: field {} of this line is not read",
                card.written,
                last + 1
            );
            let help =
                format!("a row has {count} constants and a temperature, eight numbers a line");
            messages.error(place, message, &help);
        }
        let temperature = numbers[count];
        numbers.truncate(count);
        out.push((temperature, numbers));
    }
    if let Some(i) = (1..out.len()).find(|&i| out[i - 1].0 >= out[i].0) {
        let place = card.data[i * lines].place;
        let message = format!("temperature {} does not follow {}", out[i].0, out[i - 1].0);
        messages.error(place, message, "temperatures of a material increase");
    }
    out
}

pub(super) fn material(reader: &mut Reader, card: &Card) {
    let messages = &mut reader.messages;
    let Some(name) = required(messages, card, "NAME") else {
        return;
    };
    let material = Material {
        place: card.place,
        ..Material::default()
    };
    if reader
        .deck
        .properties
        .materials
        .insert(name.clone(), material)
        .is_some()
    {
        let message = format!("the material {name} is given twice");
        let help = "names are unique: blanks and case do not count";
        messages.error(card.place, message, help);
    }
    reader.position.context = Context::Material(name);
}

/// The material that the card belongs to.
pub(super) fn own<'r>(reader: &'r mut Reader, card: &Card) -> Option<&'r mut Material> {
    if let Context::Material(name) = reader.position.context.clone() {
        return reader.deck.properties.materials.get_mut(&name);
    }
    let message = format!("{} belongs to no material", card.written);
    let help = "write it beneath *MATERIAL";
    reader.messages.error(card.place, message, help);
    None
}

pub(super) fn elastic(reader: &mut Reader, card: &Card) {
    let messages = &mut reader.messages;
    let kind = card.get("TYPE").unwrap_or("ISO").to_string();
    if line(messages, card).is_none() {
        return;
    }
    let (count, make): (usize, fn(&[f64]) -> Elastic) = match kind.as_str() {
        "ISO" | "ISOTROPIC" | "" => (2, |v| Elastic::Isotropic([v[0], v[1]])),
        "ENGINEERINGCONSTANTS" => (9, |v| Elastic::Engineering(std::array::from_fn(|i| v[i]))),
        "ORTHO" | "ORTHOTROPIC" => (9, orthotropic),
        "ANISO" | "ANISOTROPIC" => (21, anisotropic),
        other => {
            let message = format!("*ELASTIC of type {} is not supported", clip(other));
            let help = "types are ISO, ORTHO, ENGINEERING CONSTANTS and ANISO";
            messages.error(card.place, message, help);
            return;
        }
    };
    let rows = rows(messages, card, count);
    let rows: Vec<(f64, Elastic)> = rows.iter().map(|(t, v)| (*t, make(v))).collect();
    if let Some(material) = own(reader, card) {
        material.elastic = rows.first().map(|(_, e)| e.clone());
        material.elastic_at = rows;
    }
}

pub(super) fn density(reader: &mut Reader, card: &Card) {
    let messages = &mut reader.messages;
    if line(messages, card).is_none() {
        return;
    }
    let rows = rows(messages, card, 1);
    let rows: Vec<(f64, f64)> = rows.iter().map(|(t, v)| (*t, v[0])).collect();
    if let Some(material) = own(reader, card) {
        material.density = rows.first().map(|(_, d)| *d);
        material.density_at = rows;
    }
}

pub(super) fn damping(reader: &mut Reader, card: &Card) {
    let [alpha, beta] =
        ["ALPHA", "BETA"].map(|name| parameter(&mut reader.messages, card, name).unwrap_or(0.0));
    if let Some(material) = own(reader, card) {
        material.damping = Some([alpha, beta]);
    }
}

pub(super) fn expansion(reader: &mut Reader, card: &Card) {
    let messages = &mut reader.messages;
    if line(messages, card).is_none() {
        return;
    }
    let count = match card.get("TYPE").unwrap_or("ISO") {
        "ISO" | "ISOTROPIC" | "" => 1,
        "ORTHO" | "ORTHOTROPIC" => 3,
        other => {
            let message = format!("*EXPANSION of type {} is not supported", clip(other));
            let help =
                "types are ISO and ORTHO: give the coefficients along the axes of an *ORIENTATION";
            messages.error(card.place, message, help);
            return;
        }
    };
    let zero = parameter(messages, card, "ZERO").unwrap_or(0.0);
    let rows = rows(messages, card, count);
    if let Some(material) = own(reader, card) {
        material.expansion = Some(Expansion { rows, zero });
    }
}

pub(super) fn solid_section(reader: &mut Reader, card: &Card) {
    let (Some(set), Some(material)) = (
        required_name(reader, card, "ELSET"),
        required(&mut reader.messages, card, "MATERIAL"),
    ) else {
        return;
    };
    let thickness = card
        .data
        .first()
        .map(|d: &Data| number(&mut reader.messages, d, 0, 0.0))
        .filter(|t| *t > 0.0);
    let orientation = card.get("ORIENTATION").map(|o| reader.scope.scoped(o));
    reader.deck.properties.sections.push(Section {
        set,
        material,
        orientation,
        thickness,
        place: card.place,
    });
}

/// `*ELASTIC, TYPE=ORTHO`: D1111, D1122, D2222, D1133, D2233, D3333, D1212, D1313, D2323.
fn orthotropic(v: &[f64]) -> Elastic {
    let mut c = [[0.0; 6]; 6];
    for (k, (i, j)) in [
        (0, 0),
        (0, 1),
        (1, 1),
        (0, 2),
        (1, 2),
        (2, 2),
        (3, 3),
        (4, 4),
        (5, 5),
    ]
    .into_iter()
    .enumerate()
    {
        c[i][j] = v[k];
        c[j][i] = v[k];
    }
    Elastic::Full(Box::new(c))
}

/// `*ELASTIC, TYPE=ANISO`: the upper triangle, column by column.
fn anisotropic(v: &[f64]) -> Elastic {
    let mut c = [[0.0; 6]; 6];
    let upper = (0..6).flat_map(|j| (0..=j).map(move |i| (i, j)));
    for ((i, j), value) in upper.zip(v) {
        c[i][j] = *value;
        c[j][i] = *value;
    }
    Elastic::Full(Box::new(c))
}

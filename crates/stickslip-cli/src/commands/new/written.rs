//! What is written: a template with its numbers, what is expected of it, and the figures of theory that are printed.
//!
//! A template has parts, each after a line `#: name`: `title`, `figures` (lines of a name and a value), `notes`, `expected` and `problem`. In them `@name@` stands
//! for a number with eight digits, more than any of it is worth, or for a text, `@name:4@` for a number with four, `@name:0@` for a whole one and
//! `@name:all@` for one with all its digits. What is between lines `@if name@`, `@else@` and `@end@` depends on whether that holds.

use stickslip::number::digits;

/// Millimetres in a metre, for lengths of files in mm, N, MPa.
pub const MM: f64 = 1e3;
/// Megapascals in a pascal; also N/mm in a N/m times [`MM`].
pub const MPA: f64 = 1e-6;

/// The first line of a problem file, by which editors find its schema: `stickslip schema` writes it.
const SCHEMA: &str = "#:schema ./stickslip.schema.json";

/// What stands for the names in a template.
#[derive(Debug, Default)]
pub struct Values<'a> {
    pub numbers: &'a [(&'a str, f64)],
    pub texts: &'a [(&'a str, String)],
    pub holds: &'a [(&'a str, bool)],
}

/// One problem with what is known of it.
#[derive(Debug)]
pub struct Written {
    /// What it is, in a line.
    pub title: String,
    /// The problem file.
    pub problem: String,
    /// The file of what is expected.
    pub expected: String,
    /// Figures: lines of a name and a value with its unit and formula.
    pub figures: String,
    /// What else is to be said, a line each.
    pub notes: String,
}

impl Written {
    /// A template with its values.
    pub fn of(template: &str, values: &Values) -> Written {
        let part = |name: &str, title: &str| {
            let begun = template.split_once(&format!("#: {name}\n"));
            let text = begun.map_or("", |(_, rest)| rest);
            let text = text.split("#: ").next().unwrap_or_default();
            values.fill(&text.replace("@title@", title))
        };
        let title = part("title", "").trim_end().to_string();
        let checks = part("expected", &title);
        Written {
            problem: format!("{SCHEMA}\n{}", part("problem", &title)),
            expected: format!(
                "# What theory says of it: {title}.\nformat = 1\nsource = \"closed forms\"\n{checks}"
            ),
            figures: part("figures", &title),
            notes: part("notes", &title),
            title,
        }
    }
}

impl Values<'_> {
    fn fill(&self, template: &str) -> String {
        let mut text = String::new();
        let mut shown = true;
        for line in template.lines() {
            match line.strip_prefix("@if ") {
                Some(name) => shown = *named(self.holds, name.trim_end_matches('@')),
                None if line == "@else@" => shown = !shown,
                None if line == "@end@" => shown = true,
                None if !shown => {}
                None => {
                    for (i, word) in line.split('@').enumerate() {
                        text += &if i % 2 == 1 {
                            self.of(word)
                        } else {
                            word.into()
                        };
                    }
                    text.push('\n');
                }
            }
        }
        text
    }

    fn of(&self, word: &str) -> String {
        if let Some((_, text)) = self.texts.iter().find(|(name, _)| *name == word) {
            return text.clone();
        }
        let (name, form) = word.split_once(':').unwrap_or((word, "8"));
        let x = *named(self.numbers, name);
        match form {
            "all" => format!("{x:?}"),
            "0" => format!("{x:.0}"),
            _ => digits(x, form.parse().unwrap_or(8)),
        }
    }
}

fn named<'a, T>(all: &'a [(&str, T)], name: &str) -> &'a T {
    let found = all.iter().find(|(known, _)| *known == name);
    &found
        .unwrap_or_else(|| panic!("a template has a value for `{name}`"))
        .1
}

/// A number as files have it.
pub fn number(x: f64) -> String {
    digits(x, 8)
}

//! Texts that fit into their place, and their inks.

use crate::colour::Rgb;
use crate::draw::text_width;

/// Ink of titles and names.
pub const INK: Rgb = [27, 36, 48];
/// Ink of what is less important.
pub const SOFT: Rgb = [86, 97, 111];

/// The beginning of a text that fits.
pub fn shorten(text: &str, size: f64, width: f64) -> String {
    if text_width(text, size) <= width {
        return text.to_string();
    }
    let mut short: Vec<char> = text.chars().collect();
    while let Some(_last) = short.pop() {
        let text: String = short.iter().collect::<String>().trim_end().to_string() + "…";
        if text_width(&text, size) <= width {
            return text;
        }
    }
    String::new()
}

/// Lines that fit, broken at spaces.
pub fn wrap(text: &str, size: f64, width: f64) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if text_width(&format!("{line} {word}"), size) <= width => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_string()),
        }
    }
    lines
}

//! How words on standard error look: colours where somebody sees them, numbers with the digits that say something, lines that fit.

use std::io::IsTerminal;
use std::sync::LazyLock;

use stickslip::number::figure;
use stickslip::tolerance::SAME;

/// Columns of a line.
pub const WIDTH: usize = 100;

/// How a word looks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Look {
    /// A heading.
    Strong,
    /// All is well.
    Good,
    /// Worth a look.
    Warning,
    /// Something is wrong.
    Wrong,
}

/// Whether standard error shows colours: it is a terminal with colours, and they are not switched off (<https://no-color.org>).
pub fn coloured() -> bool {
    static COLOURED: LazyLock<bool> = LazyLock::new(|| {
        let is = |name: &str| std::env::var_os(name).unwrap_or_default();
        wanted(
            std::io::stderr().is_terminal(),
            !is("NO_COLOR").is_empty(),
            is("TERM") == "dumb",
        )
    });
    *COLOURED
}

fn wanted(terminal: bool, refused: bool, dumb: bool) -> bool {
    terminal && !refused && !dumb
}

/// A word as it looks on standard error.
pub fn paint(look: Look, text: &str) -> String {
    painted(coloured(), look, text)
}

fn painted(coloured: bool, look: Look, text: &str) -> String {
    let code = match look {
        Look::Strong => "1",
        Look::Good => "32",
        Look::Warning => "33",
        Look::Wrong => "31",
    };
    match coloured {
        true => format!("\x1b[{code}m{text}\x1b[0m"),
        false => text.to_string(),
    }
}

/// A text in parts: such as give it a colour, if it has some, and all others.
pub fn parts(text: &str, coloured: bool) -> Vec<(bool, &str)> {
    let mut out = Vec::new();
    let (mut from, mut at) = (0, 0);
    while let Some(begin) = text[at..].find("\x1b[").filter(|_| coloured) {
        let begin = at + begin;
        at = begin + 2;
        let codes = &text[at..];
        let Some(end) = codes.find('m') else {
            break;
        };
        if !codes[..end].split(';').all(is_look) {
            continue;
        }
        at += end + 1;
        out.push((false, &text[from..begin]));
        out.push((true, &text[begin..at]));
        from = at;
    }
    out.push((false, &text[from..]));
    out
}

/// Whether a code says no more than how letters look: none, bold, underlined, or of a colour.
fn is_look(code: &str) -> bool {
    matches!(code.parse::<u8>(), Ok(0 | 1 | 4 | 30..=37 | 39 | 90..=97))
}

/// A vector, in which components that are rounding beside `scale` are zero.
pub fn vector(components: &[f64], scale: f64) -> String {
    let each = components.iter().map(|c| match c.abs() <= SAME * scale {
        true => "0".to_string(),
        false => figure(*c),
    });
    format!("({})", each.collect::<Vec<_>>().join(", "))
}

/// A name in so many columns.
pub fn short(name: &str, most: usize) -> String {
    match name.chars().count() > most {
        true => name.chars().take(most - 1).chain(['…']).collect(),
        false => name.to_string(),
    }
}

/// A sentence in lines that fit, all but the first two columns further in.
pub fn sentence(text: &str) -> String {
    let indent = text.len() - text.trim_start().len();
    let mut lines: Vec<String> = Vec::new();
    let mut line = " ".repeat(indent);
    let mut begun = false;
    for word in text.split_whitespace() {
        if begun && line.chars().count() + 1 + word.chars().count() > WIDTH {
            lines.push(line);
            line = " ".repeat(indent + 2);
            begun = false;
        }
        if begun {
            line.push(' ');
        }
        line += word;
        begun = true;
    }
    lines.push(line);
    lines.join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_are_for_terminals_where_nobody_minds() {
        assert!(wanted(true, false, false));
        for (terminal, refused, dumb) in [
            (false, false, false),
            (true, true, false),
            (true, false, true),
        ] {
            assert!(!wanted(terminal, refused, dumb));
        }
        assert_eq!(painted(true, Look::Wrong, "error"), "\x1b[31merror\x1b[0m");
        assert_eq!(painted(false, Look::Wrong, "error"), "error");
    }

    #[test]
    fn colours_are_told_from_all_else_that_acts() {
        let text = "\x1b[1m\x1b[31merror\x1b[0m: a\x1b[8mb\x1b]0;t\x07\x1b[2Jm";
        let own: Vec<&str> = parts(text, true)
            .iter()
            .filter(|(own, _)| *own)
            .map(|(_, part)| *part)
            .collect();
        assert_eq!(own, ["\x1b[1m", "\x1b[31m", "\x1b[0m"]);
        for coloured in [true, false] {
            let all: String = parts(text, coloured).iter().map(|(_, p)| *p).collect();
            assert_eq!(all, text);
        }
        assert_eq!(parts(text, false), [(false, text)]);
    }

    #[test]
    fn components_that_are_rounding_are_zero() {
        assert_eq!(vector(&[1e-12, 2.0], 2.0), "(0, 2)");
    }

    #[test]
    fn long_sentences_go_on_in_the_next_line() {
        let text = format!("  note: {}", "word ".repeat(40));
        let lines = sentence(&text);
        assert!(lines.lines().all(|l| l.chars().count() <= WIDTH), "{lines}");
        assert!(lines.starts_with("  note: word"), "{lines}");
        assert!(lines.lines().skip(1).all(|l| l.starts_with("    word")));
        assert_eq!(sentence("short"), "short");
        assert_eq!(short("a long name", 6), "a lon…");
    }
}

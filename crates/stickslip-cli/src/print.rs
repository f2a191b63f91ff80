//! What goes out: the one place that writes to standard output and standard error. Text of files, paths and names is in all that is said, and acts on no terminal.

use std::io::{ErrorKind, Write};

use stickslip::error::shown;

use crate::style;

/// Writes `text` to standard error, in own colours if it is a terminal that has them. A closed standard error is no reason to stop.
pub fn err(text: &str) {
    let mut clean = String::with_capacity(text.len());
    for (own, part) in style::parts(text, style::coloured()) {
        match own {
            true => clean += part,
            false => clean += &shown(part),
        }
    }
    let _ = std::io::stderr().lock().write_all(clean.as_bytes());
}

/// Begins a line of standard error anew, over one of so many characters.
pub fn again(characters: usize) {
    let blank = " ".repeat(characters);
    let _ = write!(std::io::stderr().lock(), "\r{blank}\r");
}

/// Writes `text` to standard output. That the reader has gone (`stickslip models | head`) is not an error.
pub fn out(text: &str) -> std::io::Result<()> {
    let mut out = std::io::stdout().lock();
    match out
        .write_all(shown(text).as_bytes())
        .and_then(|()| out.flush())
    {
        Err(e) if e.kind() == ErrorKind::BrokenPipe => Ok(()),
        other => other,
    }
}

/// Lines of at most `width` characters, each after `indent` spaces.
pub fn wrap(text: &str, indent: usize, width: usize) -> String {
    let mut lines = String::new();
    let mut line = String::new();
    for word in text.split_whitespace() {
        if !line.is_empty() && indent + line.chars().count() + 1 + word.chars().count() > width {
            lines += &format!("{:indent$}{line}\n", "");
            line.clear();
        }
        if !line.is_empty() {
            line.push(' ');
        }
        line += word;
    }
    if !line.is_empty() {
        lines += &format!("{:indent$}{line}\n", "");
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::wrap;

    #[test]
    fn wraps_between_words() {
        assert_eq!(wrap("aa bb cc", 2, 7), "  aa bb\n  cc\n");
        assert_eq!(wrap("", 2, 7), "");
        assert_eq!(wrap("longer than that", 0, 4), "longer\nthan\nthat\n");
    }
}

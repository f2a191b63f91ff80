//! Writing TOML that people can read: tables in order, numbers as short as they are exact.

/// Displacements and rotations, in the order of directions 1 to 6.
pub(super) const COMPONENTS: [&str; 6] = ["x", "y", "z", "rotation-x", "rotation-y", "rotation-z"];

/// A problem file under way.
#[derive(Debug, Default)]
pub(super) struct Writer {
    text: String,
}

impl Writer {
    pub fn line(&mut self, line: &str) {
        self.text.push_str(line);
        self.text.push('\n');
    }

    pub fn tables(&mut self, tables: Vec<String>) {
        for table in tables {
            self.line("");
            self.line(&table);
        }
    }

    pub fn finish(self) -> String {
        self.text
    }
}

/// A key, in quotes where it needs them.
pub(super) fn key(name: &str) -> String {
    let bare = !name.is_empty()
        && name
            .chars()
            .all(|c| c.is_ascii_alphanumeric() || "-_".contains(c));
    match bare {
        true => name.to_string(),
        false => text(name),
    }
}

/// A string.
pub(super) fn text(value: &str) -> String {
    let mut out = String::from("\"");
    for c in value.chars() {
        match c {
            '"' => out.push_str("\\\""),
            '\\' => out.push_str("\\\\"),
            c if c.is_control() => out.push_str(&format!("\\u{:04X}", c as u32)),
            c => out.push(c),
        }
    }
    out.push('"');
    out
}

/// A number.
pub(super) fn number(value: f64) -> String {
    // Negative zero and the like read oddly.
    match value == 0.0 {
        true => "0.0".into(),
        false => format!("{value:?}"),
    }
}

/// A list of numbers.
pub(super) fn numbers(values: &[f64]) -> String {
    let values: Vec<String> = values.iter().map(|v| number(*v)).collect();
    format!("[{}]", values.join(", "))
}

/// A list of strings.
pub(super) fn texts<S: AsRef<str>>(values: &[S]) -> String {
    let values: Vec<String> = values.iter().map(|v| text(v.as_ref())).collect();
    format!("[{}]", values.join(", "))
}

/// A name of the deck as one of the problem: a point would separate a body from a set.
pub(super) fn name(label: &str) -> String {
    let plain = |c: char| match c {
        '.' | '"' | '\\' => '-',
        c if c.is_control() => '-',
        c => c,
    };
    label.chars().map(plain).collect()
}

//! Cards: a keyword with its parameters and data lines, before anybody asks what they mean.

/// Where a line is: number of the file in [`Source::files`](crate::source::Source::files), and line from 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
pub struct Place {
    /// Index of the file.
    pub file: usize,
    /// Line, from 1.
    pub line: usize,
}

/// A parameter of a keyword line.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Parameter {
    /// Its name, in capitals and without blanks.
    pub name: String,
    /// What follows the equals sign: in capitals and without blanks, unless it was quoted or names a file.
    pub value: Option<String>,
}

/// A data line.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Data {
    /// Its fields, without blanks around them; an empty field is the default. Empty fields at the end are dropped.
    pub fields: Vec<String>,
    /// Where it is.
    pub place: Place,
}

/// A keyword with its parameters and the data lines that follow.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Card {
    /// The keyword in capitals without blanks and star: `SOLIDSECTION`.
    pub keyword: String,
    /// As it was written, for messages: `*Solid Section`.
    pub written: String,
    /// Its parameters.
    pub parameters: Vec<Parameter>,
    /// Where it is.
    pub place: Place,
    /// Its data lines.
    pub data: Vec<Data>,
}

impl Card {
    /// The value of a parameter; `Some("")` if it was given without one.
    pub fn get(&self, name: &str) -> Option<&str> {
        #[cfg(test)]
        asked::note(&self.keyword, name);
        let found = self.parameters.iter().find(|p| p.name == name)?;
        Some(found.value.as_deref().unwrap_or(""))
    }

    /// Whether a parameter was given.
    pub fn has(&self, name: &str) -> bool {
        self.get(name).is_some()
    }
}

/// Which parameters cards have been asked for: the test of the table compares.
#[cfg(test)]
pub(crate) mod asked {
    use std::cell::RefCell;
    use std::collections::BTreeSet;

    thread_local! {
        static ASKED: RefCell<BTreeSet<(String, String)>> = const { RefCell::new(BTreeSet::new()) };
    }

    pub fn note(keyword: &str, parameter: &str) {
        ASKED.with_borrow_mut(|a| a.insert((keyword.into(), parameter.into())));
    }

    pub fn all() -> BTreeSet<(String, String)> {
        ASKED.with_borrow(Clone::clone)
    }
}

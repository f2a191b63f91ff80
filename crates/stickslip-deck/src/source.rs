//! Files to cards: comments, continuation lines, `*INCLUDE`, blanks and case.

use std::path::{Path, PathBuf};

use stickslip::io::input;

pub use crate::card::{Card, Data, Parameter, Place};
use crate::finding::{DeckError, Finding, Severity};
use crate::text::{label, squeeze};

/// The names of the parameters of a keyword, in capitals without blanks; nothing of one that is not known.
pub type ParametersOf = fn(&str) -> Option<Vec<&'static str>>;

/// A deck as cards.
#[derive(Debug, Clone)]
pub struct Source {
    /// The file and those it includes, in the order they were met.
    pub files: Vec<PathBuf>,
    /// The cards in order.
    pub cards: Vec<Card>,
    /// What was forgiven, and where.
    pub forgiven: Vec<(Place, String)>,
    parameters_of: ParametersOf,
}

/// Deepest nesting of included files.
const INCLUDE_DEPTH: usize = 16;

/// Most files of one deck, with repetitions.
const MOST_FILES_OF_A_DECK: usize = 1000;

struct Line {
    text: String,
    place: Place,
}

impl Source {
    /// Reads a file and all it includes.
    ///
    /// # Errors
    /// Files that cannot be read, that include each other in a circle, and lines that belong to no keyword.
    pub fn read(path: &Path, parameters_of: ParametersOf) -> Result<Source, DeckError> {
        let bytes =
            input::read(path, input::MOST_TEXT_BYTES).map_err(|e| DeckError::io(path, &e, None))?;
        Source::parse(&bytes, path, parameters_of)
    }

    /// The same from the bytes of the first file; `path` is for messages, and for the folder of what it includes.
    ///
    /// # Errors
    /// Those of [`Source::read`].
    pub fn parse(
        bytes: &[u8],
        path: &Path,
        parameters_of: ParametersOf,
    ) -> Result<Source, DeckError> {
        let mut source = Source {
            files: Vec::new(),
            cards: Vec::new(),
            forgiven: Vec::new(),
            parameters_of,
        };
        let mut lines = Vec::new();
        let mut open = vec![path.to_path_buf()];
        source.join(bytes, path, &mut open, &mut lines)?;
        source.cut(lines)?;
        Ok(source)
    }

    fn error(&self, place: Place, message: String, help: &str) -> DeckError {
        DeckError {
            findings: vec![Finding {
                severity: Severity::Error,
                file: self.files.get(place.file).cloned().unwrap_or_default(),
                line: place.line,
                message,
                help: Some(help.into()),
            }],
        }
    }

    /// The lines of a file without comments and blank lines, with included files in place.
    fn join(
        &mut self,
        bytes: &[u8],
        path: &Path,
        open: &mut Vec<PathBuf>,
        lines: &mut Vec<Line>,
    ) -> Result<(), DeckError> {
        let file = self.files.len();
        self.files.push(path.to_path_buf());
        // Decks come from programs that write titles in whatever encoding they like; only titles can have such letters.
        let text = String::from_utf8_lossy(bytes);
        let mut pending: Option<Line> = None;
        for (i, raw) in text.lines().enumerate() {
            let place = Place { file, line: i + 1 };
            let line = raw.trim_start_matches('\u{feff}').trim();
            // `>**` is how one of CalculiX's own decks begins.
            if line.is_empty() || line.starts_with("**") || line.starts_with(">**") {
                continue;
            }
            let line = match pending.take() {
                Some(mut begun) if self.continues(&begun.text, line) => {
                    begun.text.push_str(line);
                    begun
                }
                Some(begun) => {
                    if line.starts_with(char::is_alphabetic) {
                        let message = "the comma at the end of the line is taken as one too many: no parameters follow";
                        self.forgiven.push((begun.place, message.into()));
                    }
                    self.take(begun, path, open, lines)?;
                    Line {
                        text: line.to_string(),
                        place,
                    }
                }
                None => Line {
                    text: line.to_string(),
                    place,
                },
            };
            // A keyword line that ends with a comma goes on.
            if line.text.starts_with('*') && line.text.ends_with(',') {
                pending = Some(line);
                continue;
            }
            self.take(line, path, open, lines)?;
        }
        if let Some(line) = pending {
            self.take(line, path, open, lines)?;
        }
        Ok(())
    }

    fn take(
        &mut self,
        line: Line,
        path: &Path,
        open: &mut Vec<PathBuf>,
        lines: &mut Vec<Line>,
    ) -> Result<(), DeckError> {
        if !line.text.starts_with('*')
            || squeeze(&line.text[1..]).split(',').next() != Some("INCLUDE")
        {
            lines.push(line);
            return Ok(());
        }
        let input = parameters(&line.text)
            .into_iter()
            .find(|p| p.name == "INPUT");
        let Some(name) = input.and_then(|p| p.value).filter(|v| !v.is_empty()) else {
            return Err(self.error(
                line.place,
                "*INCLUDE names no file".into(),
                "write *INCLUDE, INPUT=file.inp",
            ));
        };
        // Decks written on Windows name files with backslashes.
        let name = name.replace('\\', "/");
        let beside = |file: &Path| file.parent().unwrap_or(Path::new("")).join(&name);
        let mut inner = beside(path);
        if !inner.exists() && open.first().is_some_and(|root| beside(root).exists()) {
            // Both programs look from the folder of the job.
            inner = beside(&open[0]);
        }
        if open.contains(&inner)
            || open.len() >= INCLUDE_DEPTH
            || self.files.len() >= MOST_FILES_OF_A_DECK
        {
            return Err(self.error(
                line.place,
                format!("the files include each other in a circle, are {INCLUDE_DEPTH} deep, or more than {MOST_FILES_OF_A_DECK}: {name}"),
                "each *INCLUDE must name a file that does not lead back here",
            ));
        }
        let here = self.files[line.place.file].clone();
        if inner.exists() && !inner.is_file() {
            // A device might never end.
            return Err(self.error(
                line.place,
                format!("{} is no file", inner.display()),
                "*INCLUDE names an ordinary file",
            ));
        }
        let bytes = input::read(&inner, input::MOST_TEXT_BYTES)
            .map_err(|e| DeckError::io(&inner, &e, Some((&here, line.place.line))))?;
        open.push(inner.clone());
        self.join(&bytes, &inner, open, lines)?;
        open.pop();
        Ok(())
    }

    /// Whether a line after a keyword line that ends with a comma goes on with its parameters, as it does in Abaqus. They begin with a letter and are
    /// parameters of the keyword, or have a value: what else follows is data, and the comma is one too many, as it always is in CalculiX.
    fn continues(&self, begun: &str, line: &str) -> bool {
        let word =
            line.starts_with(|c: char| !(c == '*' || c.is_ascii_digit() || "+-.,".contains(c)));
        let keyword = begun.trim_start_matches('*').split(',').next();
        let keyword = squeeze(keyword.unwrap_or_default());
        let Some(names) = (self.parameters_of)(&keyword) else {
            return word;
        };
        let named = |part: &String| part.contains('=') || names.contains(&squeeze(part).as_str());
        let parts = split(line);
        word && parts.iter().filter(|p| !p.trim().is_empty()).all(named)
    }

    /// Parameters whose names are cut short, as Abaqus lets them be where only one begins so.
    fn spell_out(&mut self, keyword: &str, parameters: &mut [Parameter], place: Place) {
        let Some(names) = (self.parameters_of)(keyword) else {
            return;
        };
        for p in parameters {
            if let Some(full) = spelled_out(&names, &p.name) {
                let message = format!("{} is taken as {full}", p.name);
                self.forgiven.push((place, message));
                p.name = full.into();
            }
        }
    }

    fn cut(&mut self, lines: Vec<Line>) -> Result<(), DeckError> {
        for line in lines {
            if let Some(rest) = line.text.strip_prefix('*') {
                let written = rest.split(',').next().unwrap_or_default().trim();
                let keyword = squeeze(written);
                let mut parameters = parameters(&line.text);
                self.spell_out(&keyword, &mut parameters, line.place);
                self.cards.push(Card {
                    keyword,
                    written: format!("*{written}"),
                    parameters,
                    place: line.place,
                    data: Vec::new(),
                });
                continue;
            }
            let mut fields: Vec<String> = match line.text.contains('"') {
                true => split(&line.text)
                    .iter()
                    .map(|f| f.trim().to_string())
                    .collect(),
                false => line.text.split(',').map(|f| f.trim().to_string()).collect(),
            };
            while fields.last().is_some_and(String::is_empty) {
                fields.pop();
            }
            match self.cards.last_mut() {
                Some(card) => card.data.push(Data {
                    fields,
                    place: line.place,
                }),
                None => {
                    return Err(self.error(
                        line.place,
                        "data before the first keyword".into(),
                        "an input deck consists of keyword lines that begin with * and of their data; comments begin with **",
                    ));
                }
            }
        }
        if self.cards.is_empty() {
            return Err(self.error(
                Place::default(),
                "the file has no keyword".into(),
                "an input deck has lines that begin with *, such as *NODE and *ELEMENT",
            ));
        }
        Ok(())
    }
}

/// The name that begins with one of at least four letters, where others that do only go on from it.
fn spelled_out(names: &[&'static str], name: &str) -> Option<&'static str> {
    if name.len() < 4 || names.contains(&name) {
        return None;
    }
    let all = || names.iter().copied().filter(|n| n.starts_with(name));
    let shortest = all().min_by_key(|n| n.len())?;
    all().all(|n| n.starts_with(shortest)).then_some(shortest)
}

fn parameters(line: &str) -> Vec<Parameter> {
    let mut out = Vec::new();
    for part in split(line).into_iter().skip(1) {
        let (name, value) = match part.split_once('=') {
            Some((name, value)) => (squeeze(name), Some(value)),
            None => (squeeze(&part), None),
        };
        if name.is_empty() {
            continue;
        }
        let value = value.map(|v| match name.as_str() {
            "INPUT" | "FILE" => v.trim().trim_matches('"').to_string(),
            _ => label(v),
        });
        out.push(Parameter { name, value });
    }
    out
}

/// At commas outside quotes.
fn split(line: &str) -> Vec<String> {
    let mut out = vec![String::new()];
    let mut quoted = false;
    for c in line.chars() {
        match c {
            '"' => quoted = !quoted,
            ',' if !quoted => {
                out.push(String::new());
                continue;
            }
            _ => {}
        }
        if let Some(last) = out.last_mut() {
            last.push(c);
        }
    }
    out
}

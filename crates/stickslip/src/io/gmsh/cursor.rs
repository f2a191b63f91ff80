use std::path::Path;

use crate::error::MeshError;

/// How the numbers of mesh sections are written.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Mode {
    Ascii,
    Little,
    Big,
}

/// A place in the bytes of a mesh file, which it reads on from.
pub(super) struct Cursor<'a> {
    bytes: &'a [u8],
    at: usize,
    path: &'a Path,
    /// How numbers are written; the header decides.
    pub mode: Mode,
}

const TRUNCATED: &str = "the file is truncated or damaged: save it again with Gmsh";

impl<'a> Cursor<'a> {
    pub fn new(bytes: &'a [u8], path: &'a Path) -> Self {
        Cursor {
            bytes,
            at: 0,
            path,
            mode: Mode::Ascii,
        }
    }

    /// Byte at which it stands.
    pub fn position(&self) -> usize {
        self.at
    }

    fn rest(&self) -> &'a [u8] {
        &self.bytes[self.at..]
    }

    /// An error here.
    pub fn error(&self, message: impl Into<String>) -> MeshError {
        self.error_at(self.at, message)
    }

    /// An error at a byte: named by its line in a text file.
    pub fn error_at(&self, at: usize, message: impl Into<String>) -> MeshError {
        let at = at.min(self.bytes.len());
        let mut error = MeshError::new(message);
        error.file = Some(self.path.to_path_buf());
        if self.mode == Mode::Ascii {
            error.line = Some(1 + self.bytes[..at].iter().filter(|&&b| b == b'\n').count());
        } else {
            error.message += &format!(" (at byte {at})");
        }
        error
    }

    fn skip_space(&mut self) {
        let space = self.rest().iter().take_while(|b| b.is_ascii_whitespace());
        self.at += space.count();
    }

    /// The name of the next section, `None` at the end of the file.
    pub fn section(&mut self) -> Result<Option<&'a str>, MeshError> {
        self.skip_space();
        if self.rest().is_empty() {
            return Ok(None);
        }
        let at = self.at;
        match self.rest_of_line().trim().strip_prefix('$') {
            Some(name) if !name.is_empty() && !name.starts_with("End") => Ok(Some(name)),
            _ => Err(self
                .error_at(at, "expected the start of a section, such as $Nodes")
                .help("check that the counts in the section before match its lines")),
        }
    }

    /// Reads `$End<name>`.
    pub fn end_section(&mut self, name: &str) -> Result<(), MeshError> {
        self.skip_space();
        let at = self.at;
        let line = self.rest_of_line().trim();
        if line.strip_prefix("$End") == Some(name) {
            return Ok(());
        }
        let help = if self.rest().is_empty() {
            TRUNCATED
        } else {
            "the section holds more or less than its counts say"
        };
        Err(self.error_at(at, format!("expected $End{name}")).help(help))
    }

    /// Goes on after `$End<name>`.
    pub fn skip_section(&mut self, name: &str) -> Result<(), MeshError> {
        let end = format!("$End{name}");
        let found = self
            .rest()
            .windows(end.len())
            .position(|w| w == end.as_bytes());
        match found {
            Some(offset) => {
                self.at += offset + end.len();
                self.rest_of_line();
                Ok(())
            }
            None => Err(self
                .error(format!("the section ${name} has no {end}"))
                .help(TRUNCATED)),
        }
    }

    /// Text up to the end of the line, which is left behind. Bytes that are no UTF-8 end it early.
    pub fn rest_of_line(&mut self) -> &'a str {
        let rest = self.rest();
        let length = rest.iter().position(|&b| b == b'\n');
        let line = &rest[..length.unwrap_or(rest.len())];
        self.at += length.map_or(rest.len(), |n| n + 1);
        let valid = line.utf8_chunks().next().map_or("", |chunk| chunk.valid());
        valid.strip_suffix('\r').unwrap_or(valid)
    }

    /// The next word of a text.
    pub fn word(&mut self, what: &str) -> Result<&'a str, MeshError> {
        self.skip_space();
        let rest = self.rest();
        let end = rest.iter().position(|b| b.is_ascii_whitespace());
        let word = &rest[..end.unwrap_or(rest.len())];
        if word.is_empty() {
            return Err(self
                .error(format!("the file ends where {what} should be"))
                .help(TRUNCATED));
        }
        let Ok(word) = std::str::from_utf8(word) else {
            return Err(self
                .error(format!("expected {what}, found bytes that are no text"))
                .help(TRUNCATED));
        };
        self.at += word.len();
        Ok(word)
    }

    fn parsed<T: std::str::FromStr>(&mut self, what: &str) -> Result<T, MeshError> {
        let word = self.word(what)?;
        word.parse().map_err(|_| {
            let shown: String = word.chars().take(40).collect();
            self.error_at(
                self.at - word.len(),
                format!("expected {what}, found `{shown}`"),
            )
            .help(
                "check that the counts at the top of the section match its lines, and that numbers have a decimal point",
            )
        })
    }

    /// The next `N` bytes.
    pub fn array<const N: usize>(&mut self, what: &str) -> Result<[u8; N], MeshError> {
        match self.rest().first_chunk::<N>() {
            Some(chunk) => {
                self.at += N;
                Ok(*chunk)
            }
            None => Err(self
                .error(format!("the file ends where {what} should be"))
                .help(TRUNCATED)),
        }
    }

    /// An `int` of the format: 4 bytes in binary.
    pub fn int(&mut self, what: &str) -> Result<i64, MeshError> {
        Ok(match self.mode {
            Mode::Ascii => self.parsed(what)?,
            Mode::Little => i32::from_le_bytes(self.array(what)?).into(),
            Mode::Big => i32::from_be_bytes(self.array(what)?).into(),
        })
    }

    /// A `size_t` of the format: 8 bytes in binary.
    pub fn size(&mut self, what: &str) -> Result<u64, MeshError> {
        match self.mode {
            Mode::Ascii => self.parsed(what),
            Mode::Little => Ok(u64::from_le_bytes(self.array(what)?)),
            Mode::Big => Ok(u64::from_be_bytes(self.array(what)?)),
        }
    }

    /// A `double`.
    pub fn float(&mut self, what: &str) -> Result<f64, MeshError> {
        match self.mode {
            Mode::Ascii => self.parsed(what),
            Mode::Little => Ok(f64::from_le_bytes(self.array(what)?)),
            Mode::Big => Ok(f64::from_be_bytes(self.array(what)?)),
        }
    }

    /// The coordinates of a node.
    pub fn coordinates(&mut self, tag: u64) -> Result<[f64; 3], MeshError> {
        let mut x = [0.0; 3];
        for value in &mut x {
            self.skip_line_space();
            let at = self.at;
            *value = self.float("a coordinate")?;
            if !value.is_finite() {
                return Err(self
                    .error_at(at, format!("a coordinate of node {tag} is {value}"))
                    .help("coordinates must be finite numbers: mesh the geometry again"));
            }
        }
        Ok(x)
    }

    /// So that positions taken before a number are those of the number.
    fn skip_line_space(&mut self) {
        if self.mode == Mode::Ascii {
            self.skip_space();
        }
    }

    /// Position of the next number.
    pub fn next_position(&mut self) -> usize {
        self.skip_line_space();
        self.at
    }

    /// A count (`size_t`) of things of at least `numbers` numbers, or `bytes` bytes in binary. It is refused if the file
    /// is too short to hold them, so that it can be trusted with an allocation.
    pub fn count(&mut self, what: &str, numbers: usize, bytes: usize) -> Result<usize, MeshError> {
        let at = self.next_position();
        let n = self.size(what)?;
        // A number in text takes a digit and a space, but for the last.
        let least = match self.mode {
            Mode::Ascii => 2 * numbers,
            _ => bytes,
        };
        self.held(at, what, n, least)
    }

    /// A count written as text in binary files too.
    pub fn text_count(&mut self, what: &str) -> Result<usize, MeshError> {
        self.skip_space();
        let at = self.at;
        let n = self.parsed(what)?;
        self.held(at, what, n, 1)
    }

    /// `n` as a length, if the rest of the file can hold `n` times `least` bytes.
    pub fn held(&self, at: usize, what: &str, n: u64, least: usize) -> Result<usize, MeshError> {
        let room = (self.rest().len() + 1) / least.max(1);
        match usize::try_from(n) {
            Ok(n) if n <= room => Ok(n),
            _ => Err(self
                .error_at(
                    at,
                    format!("{what} is {n}, but the rest of the file holds {room} at most"),
                )
                .help(TRUNCATED)),
        }
    }
}

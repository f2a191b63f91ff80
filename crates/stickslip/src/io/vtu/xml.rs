//! The little of XML that VTK files use, read tag by tag.
//!
//! Written by hand: bytes that are no XML follow the tag of appended data, faults are to name the line and what is missing there, and a general
//! reader (`quick-xml`) would leave the path of elements, the lines and all of these messages to be written around it.

/// What stands next in a text.
pub(in crate::io) enum Event<'a> {
    /// An element begins: [`Scanner::path`] ends with it.
    Open(Vec<(&'a str, String)>),
    /// Text, not only space, in the element at the end of the path.
    Text(&'a [u8]),
    /// The element at the end of the path has ended and was taken off it.
    Close,
}

/// A place in a text, which it reads on from. Faults name the line.
pub(in crate::io) struct Scanner<'a> {
    bytes: &'a [u8],
    at: usize,
    path: Vec<&'a str>,
    /// The last tag was `<a/>`, which is its own end.
    closing: bool,
}

/// The line of a byte, from 1.
pub(super) fn line(bytes: &[u8], at: usize) -> usize {
    1 + bytes[..at].iter().filter(|&&b| b == b'\n').count()
}

impl<'a> Scanner<'a> {
    pub fn new(bytes: &'a [u8]) -> Self {
        Scanner {
            bytes,
            at: 0,
            path: Vec::new(),
            closing: false,
        }
    }

    /// The elements around this place, outermost first.
    pub fn path(&self) -> &[&'a str] {
        &self.path
    }

    /// What has not been read.
    pub fn rest(&self) -> &'a [u8] {
        &self.bytes[self.at..]
    }

    /// A message about this place.
    pub fn fault(&self, message: impl std::fmt::Display) -> String {
        format!("line {}: {message}", line(self.bytes, self.at))
    }

    /// Byte at which it stands.
    pub fn position(&self) -> usize {
        self.at
    }

    /// The next event; `None` at the end. Comments and declarations are passed over.
    pub fn next(&mut self) -> Result<Option<Event<'a>>, String> {
        if self.closing {
            self.closing = false;
            self.path.pop();
            return Ok(Some(Event::Close));
        }
        loop {
            let rest = self.rest();
            if rest.starts_with(b"<?") {
                self.skip_past("?>")?;
            } else if rest.starts_with(b"<!--") {
                self.skip_past("-->")?;
            } else if rest.starts_with(b"<!") {
                return Err(self.fault("`<!` begins nothing that a VTK file has"));
            } else if rest.starts_with(b"</") {
                return self.close().map(Some);
            } else if rest.starts_with(b"<") {
                return self.open().map(Some);
            } else if let Some(text) = self.text() {
                return Ok(Some(Event::Text(text)));
            } else if self.rest().is_empty() {
                return match self.path.last() {
                    Some(open) => Err(self.fault(format!("the file ends inside <{open}>"))),
                    None => Ok(None),
                };
            }
        }
    }

    fn text(&mut self) -> Option<&'a [u8]> {
        let rest = self.rest();
        let end = rest.iter().position(|&b| b == b'<').unwrap_or(rest.len());
        self.at += end;
        let text = rest[..end].trim_ascii();
        (!text.is_empty()).then_some(text)
    }

    fn open(&mut self) -> Result<Event<'a>, String> {
        self.at += 1;
        let name = self.name()?;
        let mut attributes = Vec::new();
        loop {
            self.skip_space();
            if self.skip("/>") {
                self.closing = true;
                break;
            }
            if self.skip(">") {
                break;
            }
            let key = self.name()?;
            attributes.push((key, self.value(key)?));
        }
        self.path.push(name);
        Ok(Event::Open(attributes))
    }

    fn close(&mut self) -> Result<Event<'a>, String> {
        let start = self.at;
        self.at += 2;
        let name = self.name()?;
        self.skip_space();
        if !self.skip(">") {
            return Err(self.fault(format!("`</{name}` is not closed by `>`")));
        }
        match self.path.pop() {
            Some(open) if open == name => Ok(Event::Close),
            other => {
                self.at = start;
                let wanted = other.map_or("nothing is open".into(), |o| format!("<{o}> is open"));
                Err(self.fault(format!("</{name}> where {wanted}")))
            }
        }
    }

    /// What follows the name of an attribute.
    fn value(&mut self, key: &str) -> Result<String, String> {
        self.skip_space();
        let equals = self.skip("=");
        self.skip_space();
        let rest = self.rest();
        let quote = match rest.first() {
            Some(&quote @ (b'"' | b'\'')) if equals => quote,
            _ => return Err(self.fault(format!("attribute {key} has no value in quotes"))),
        };
        let Some(length) = rest[1..].iter().position(|&b| b == quote) else {
            return Err(self.fault(format!("the value of {key} is cut off")));
        };
        let value = std::str::from_utf8(&rest[1..1 + length])
            .ok()
            .and_then(unescape)
            .ok_or_else(|| self.fault(format!("the value of {key} is no valid text")))?;
        self.at += length + 2;
        Ok(value)
    }

    fn name(&mut self) -> Result<&'a str, String> {
        let rest = self.rest();
        let ends = |b: &u8| b.is_ascii_whitespace() || b"<>/='\"".contains(b);
        let length = rest.iter().position(ends).unwrap_or(rest.len());
        match std::str::from_utf8(&rest[..length]) {
            Ok(name) if length > 0 => {
                self.at += length;
                Ok(name)
            }
            _ => Err(self.fault("a tag is cut off or has no valid name")),
        }
    }

    fn skip_space(&mut self) {
        self.at += self.rest().len() - self.rest().trim_ascii_start().len();
    }

    fn skip(&mut self, what: &str) -> bool {
        let found = self.rest().starts_with(what.as_bytes());
        if found {
            self.at += what.len();
        }
        found
    }

    fn skip_past(&mut self, end: &str) -> Result<(), String> {
        let found = self
            .rest()
            .windows(end.len())
            .position(|w| w == end.as_bytes());
        match found {
            Some(length) => {
                self.at += length + end.len();
                Ok(())
            }
            None => Err(self.fault(format!("`{end}` is missing"))),
        }
    }
}

/// A value with its entities replaced; `None` if there is one that XML does not know.
fn unescape(text: &str) -> Option<String> {
    let mut pieces = text.split('&');
    let mut out = pieces.next()?.to_string();
    for piece in pieces {
        let (entity, rest) = piece.split_once(';')?;
        out.push(match entity {
            "amp" => '&',
            "lt" => '<',
            "gt" => '>',
            "quot" => '"',
            "apos" => '\'',
            _ => {
                let number = entity.strip_prefix('#')?;
                let code = match number.strip_prefix('x') {
                    Some(hex) => u32::from_str_radix(hex, 16),
                    None => number.parse(),
                };
                char::from_u32(code.ok()?)?
            }
        });
        out += rest;
    }
    Some(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The events of a text, each with the path at its time.
    fn events(text: &str) -> Result<Vec<String>, String> {
        let mut scanner = Scanner::new(text.as_bytes());
        let mut out = Vec::new();
        while let Some(event) = scanner.next()? {
            let shown = match event {
                Event::Open(attributes) => format!("+{attributes:?}"),
                Event::Text(text) => String::from_utf8_lossy(text).into_owned(),
                Event::Close => "-".to_string(),
            };
            out.push(format!("{} {shown}", scanner.path().join("/")));
        }
        Ok(out)
    }

    #[test]
    fn tags_text_and_their_nesting_are_found() {
        let text = "<?xml version='1.0'?>\n<a x = 'say \"1 > 0\"'\n y=\"&lt;&#65;&#x42;&apos;&amp;lt;\"><!-- <no> -->\n \
                    one <b/>two</a >\n";
        let expected = [
            r#"a +[("x", "say \"1 > 0\""), ("y", "<AB'&lt;")]"#,
            "a one",
            "a/b +[]",
            "a -",
            "a two",
            " -",
        ];
        assert_eq!(events(text).unwrap(), expected);
        assert!(events("").unwrap().is_empty());
    }

    #[test]
    fn what_is_wrong_is_said_with_its_line() {
        for (text, message) in [
            ("<a>\n</b>", "line 2: </b> where <a> is open"),
            ("</b>", "line 1: </b> where nothing is open"),
            ("<a>\n\n<b></b>", "line 3: the file ends inside <a>"),
            ("<a x=1>", "line 1: attribute x has no value in quotes"),
            ("<a x'1'>", "line 1: attribute x has no value in quotes"),
            ("<a x='1>", "line 1: the value of x is cut off"),
            ("<a x='&no;'/>", "line 1: the value of x is no valid text"),
            (
                "<a x='&#xD800;'/>",
                "line 1: the value of x is no valid text",
            ),
            ("<a x='&amp'/>", "line 1: the value of x is no valid text"),
            ("<a", "line 1: a tag is cut off or has no valid name"),
            ("<>", "line 1: a tag is cut off or has no valid name"),
            ("<a></a", "line 1: `</a` is not closed by `>`"),
            ("<!-- a", "line 1: `-->` is missing"),
            (
                "<!DOCTYPE a>",
                "line 1: `<!` begins nothing that a VTK file has",
            ),
        ] {
            assert_eq!(events(text).unwrap_err(), message, "{text}");
        }
    }
}

//! One `DataArray` of a file: what its tag says, and its values.

use super::stream::{Packing, Stream};

/// The number types of the format, each read by the Rust type of its width.
macro_rules! numbers {
    ($($name:ident: $type:ty),+ $(,)?) => {
        /// The type of the values of an array.
        #[derive(Debug, Clone, Copy, PartialEq)]
        pub(super) enum Number {
            $($name),+
        }

        impl Number {
            fn named(name: &str) -> Option<Self> {
                match name {
                    $(stringify!($name) => Some(Number::$name),)+
                    _ => None,
                }
            }

            /// Bytes of a value.
            fn size(self) -> usize {
                match self {
                    $(Number::$name => size_of::<$type>()),+
                }
            }

            /// The values in little-endian bytes.
            fn decode(self, bytes: &[u8]) -> Vec<f64> {
                match self {
                    $(Number::$name => {
                        let (values, _) = bytes.as_chunks();
                        values.iter().map(|&v| <$type>::from_le_bytes(v) as f64).collect()
                    })+
                }
            }

            /// A value as text.
            fn parse(self, word: &str) -> Option<f64> {
                match self {
                    $(Number::$name => Some(word.parse::<$type>().ok()? as f64)),+
                }
            }
        }
    };
}

numbers! {
    Float32: f32,
    Float64: f64,
    Int8: i8,
    Int16: i16,
    Int32: i32,
    Int64: i64,
    UInt8: u8,
    UInt16: u16,
    UInt32: u32,
    UInt64: u64,
}

/// Where the values of an array are.
#[derive(Debug, PartialEq)]
enum Place {
    /// Between its tags, as numbers.
    Ascii,
    /// Between its tags, in base64.
    Inline,
    /// In the appended data, from this byte on.
    Appended(usize),
}

/// An array that has been found and not yet read.
#[derive(Debug)]
pub(super) struct Array<'a> {
    /// Its name; empty if it has none.
    pub name: String,
    /// Numbers a point or cell.
    pub components: usize,
    /// Where its tag ends in the file.
    pub at: usize,
    /// The text between its tags.
    pub text: &'a [u8],
    number: Number,
    place: Place,
}

/// The data at the end of a file.
#[derive(Debug, Clone, Copy)]
pub(super) enum Appended<'a> {
    /// The file has none.
    None,
    /// As bytes.
    Raw(&'a [u8]),
    /// In base64.
    Base64(&'a [u8]),
}

/// The value of an attribute.
pub(super) fn attribute<'t>(attributes: &'t [(&str, String)], key: &str) -> Option<&'t str> {
    let found = attributes.iter().find(|(k, _)| *k == key);
    found.map(|(_, value)| value.as_str())
}

/// The value of an attribute that is a count; `default` where it is missing, which is a fault where there is none.
pub(super) fn count(
    attributes: &[(&str, String)],
    key: &str,
    default: Option<usize>,
) -> Result<usize, String> {
    match attribute(attributes, key) {
        Some(text) => text
            .trim()
            .parse()
            .map_err(|_| format!("{key} is `{text}`, which is no count")),
        None => default.ok_or_else(|| format!("{key} is missing")),
    }
}

impl Array<'_> {
    /// An array by its tag, which ends at this byte, without its text.
    pub fn new(attributes: &[(&str, String)], at: usize) -> Result<Self, String> {
        let name = attribute(attributes, "Name").unwrap_or_default();
        let read = || -> Result<Self, String> {
            let kind = attribute(attributes, "type").ok_or("its type is missing")?;
            let number = Number::named(kind)
                .ok_or_else(|| format!("values of type `{kind}` are not read, only numbers"))?;
            let place = match attribute(attributes, "format").unwrap_or("ascii") {
                "ascii" => Place::Ascii,
                "binary" => Place::Inline,
                "appended" => Place::Appended(count(attributes, "offset", None)?),
                other => return Err(format!("its format is `{other}`, which VTK does not have")),
            };
            Ok(Array {
                name: name.to_string(),
                components: count(attributes, "NumberOfComponents", Some(1))?,
                at,
                text: &[],
                number,
                place,
            })
        };
        read().map_err(|message| format!("array `{name}`: {message}"))
    }

    /// Whether its values are whole numbers.
    pub fn whole(&self) -> bool {
        !matches!(self.number, Number::Float32 | Number::Float64)
    }

    /// The values on so many points or cells.
    pub fn values(
        &self,
        count: usize,
        packing: &Packing,
        appended: Appended,
    ) -> Result<Vec<f64>, String> {
        self.read(count, packing, appended)
            .map_err(|message| format!("array `{}`: {message}", self.name))
    }

    fn read(
        &self,
        count: usize,
        packing: &Packing,
        appended: Appended,
    ) -> Result<Vec<f64>, String> {
        let bytes = count
            .checked_mul(self.components)
            .and_then(|n| n.checked_mul(self.number.size()))
            .ok_or("it has more values than any file can hold")?;
        if bytes == 0 {
            // Writers differ in the header that nothing has.
            return Ok(Vec::new());
        }
        let stream = match self.place {
            Place::Ascii => return self.numbers(count * self.components),
            Place::Inline => Stream::base64(self.text),
            Place::Appended(offset) => {
                let beyond = "its offset is beyond the end of the file";
                match appended {
                    Appended::None => return Err("the file has no appended data".into()),
                    Appended::Raw(bytes) => Stream::Raw(bytes.get(offset..).ok_or(beyond)?),
                    Appended::Base64(text) => Stream::base64(text.get(offset..).ok_or(beyond)?),
                }
            }
        };
        Ok(self.number.decode(&packing.unpack(stream, bytes)?))
    }

    fn numbers(&self, wanted: usize) -> Result<Vec<f64>, String> {
        let text = std::str::from_utf8(self.text).map_err(|_| "its values are no text")?;
        let mut values = Vec::new();
        for word in text.split_ascii_whitespace() {
            let value = self.number.parse(word).ok_or_else(|| {
                let shown: String = word.chars().take(40).collect();
                format!("`{shown}` is no {:?}", self.number)
            })?;
            values.push(value);
        }
        if values.len() != wanted {
            return Err(format!(
                "it has {} values where the grid needs {wanted}",
                values.len()
            ));
        }
        Ok(values)
    }
}

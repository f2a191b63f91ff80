//! From what a file holds to the bytes of an array: base64, headers and compressed blocks.
//!
//! Base64 is decoded here, in thirty lines: VTK encodes a header and its data one after the other, each with padding of its own, over line breaks,
//! and how much is to be taken follows from what was taken. The crates for it want a whole text, or none of that.

use std::borrow::Cow;
use std::io::Read;

/// Bytes that are read from front to back.
pub(super) enum Stream<'a> {
    /// As they are.
    Raw(&'a [u8]),
    /// As text in base64 (RFC 4648) with or without line breaks. Padding ends a run of bytes but not the text: writers
    /// encode a header for itself.
    Base64 {
        /// What has not been decoded.
        text: &'a [u8],
        /// Decoded bytes, two at most, that have not been taken.
        spare: Vec<u8>,
    },
}

/// What the root of a file says of all its binary arrays.
pub(super) struct Packing {
    /// Bytes of a number in a header: 4 or 8.
    pub word: usize,
    /// Name of the compressor, if there is one.
    pub compressor: Option<String>,
}

const ENDS: &str = "the file ends within it: it is truncated or damaged";

impl<'a> Stream<'a> {
    pub fn base64(text: &'a [u8]) -> Self {
        Stream::Base64 {
            text,
            spare: Vec::new(),
        }
    }

    /// The next `n` bytes. No memory is set aside for more than there can be.
    pub fn take(&mut self, n: usize) -> Result<Cow<'a, [u8]>, String> {
        match self {
            Stream::Raw(bytes) => {
                let (taken, rest) = bytes.split_at_checked(n).ok_or(ENDS)?;
                *bytes = rest;
                Ok(Cow::Borrowed(taken))
            }
            Stream::Base64 { text, spare } => {
                if n > spare.len() + text.len() / 4 * 3 {
                    return Err(ENDS.into());
                }
                let mut taken = Vec::with_capacity(n + 2);
                taken.append(spare);
                while taken.len() < n {
                    taken.extend_from_slice(decode(next_four(text)?)?.as_slice());
                }
                *spare = taken.split_off(n);
                Ok(Cow::Owned(taken))
            }
        }
    }
}

/// The next four characters that are no space.
fn next_four(text: &mut &[u8]) -> Result<[u8; 4], String> {
    let mut four = [0; 4];
    for slot in &mut four {
        loop {
            let (&first, rest) = text.split_first().ok_or(ENDS)?;
            *text = rest;
            if !first.is_ascii_whitespace() {
                *slot = first;
                break;
            }
        }
    }
    Ok(four)
}

/// One to three bytes.
struct Decoded([u8; 3], usize);

impl Decoded {
    fn as_slice(&self) -> &[u8] {
        &self.0[..self.1]
    }
}

fn decode(four: [u8; 4]) -> Result<Decoded, String> {
    let length = match four {
        [_, _, b'=', b'='] => 1,
        [_, _, _, b'='] => 2,
        _ => 3,
    };
    let mut bits = 0;
    for (i, character) in four.into_iter().enumerate() {
        let six = match character {
            b'A'..=b'Z' => character - b'A',
            b'a'..=b'z' => character - b'a' + 26,
            b'0'..=b'9' => character - b'0' + 52,
            b'+' => 62,
            b'/' => 63,
            b'=' if i > length => 0,
            _ => {
                let shown = char::from(character).escape_default();
                return Err(format!("`{shown}` is out of place in base64"));
            }
        };
        bits = bits << 6 | u32::from(six);
    }
    let [_, a, b, c] = bits.to_be_bytes();
    Ok(Decoded([a, b, c], length))
}

impl Packing {
    /// The bytes of an array that should have `wanted` of them, by what its header says.
    pub fn unpack<'a>(
        &self,
        mut stream: Stream<'a>,
        wanted: usize,
    ) -> Result<Cow<'a, [u8]>, String> {
        match self.compressor.as_deref() {
            None => {
                let size = self.words(&mut stream, 1)?[0];
                fits(size as u128, wanted)?;
                stream.take(wanted)
            }
            Some("vtkZLibDataCompressor") => self.inflate(stream, wanted).map(Cow::Owned),
            Some(other) => Err(format!(
                "compression by {other} is not read: write the file with zlib or without compression"
            )),
        }
    }

    /// Blocks behind a header: number of blocks, size of a block and of an incomplete last one (zero if there is none),
    /// compressed sizes.
    fn inflate(&self, mut stream: Stream, wanted: usize) -> Result<Vec<u8>, String> {
        let head = self.words(&mut stream, 3)?;
        let (blocks, size, last) = (head[0], head[1], head[2]);
        let last = if last == 0 { size } else { last };
        let full = u128::from(blocks.saturating_sub(1)) * u128::from(size);
        fits(
            if blocks == 0 {
                0
            } else {
                full + u128::from(last)
            },
            wanted,
        )?;
        let packed = self.words(&mut stream, blocks)?;
        let mut bytes = Vec::new();
        for (i, packed) in (1..).zip(packed) {
            let block = stream.take(usize::try_from(packed).map_err(|_| ENDS)?)?;
            let before = bytes.len();
            let length = if i < blocks { size } else { last };
            flate2::bufread::ZlibDecoder::new(&block[..])
                .take(length.saturating_add(1))
                .read_to_end(&mut bytes)
                .map_err(|e| format!("a compressed block is damaged: {e}"))?;
            let found = (bytes.len() - before) as u64;
            if found != length {
                return Err(format!(
                    "a compressed block holds {found} bytes where its header says {length}"
                ));
            }
        }
        Ok(bytes)
    }

    /// Numbers of a header.
    fn words(&self, stream: &mut Stream, count: u64) -> Result<Vec<u64>, String> {
        let bytes = usize::try_from(count)
            .ok()
            .and_then(|n| n.checked_mul(self.word))
            .ok_or(ENDS)?;
        let bytes = stream.take(bytes)?;
        let word = |w: &[u8]| w.iter().rev().fold(0, |n, &byte| n << 8 | u64::from(byte));
        Ok(bytes.chunks_exact(self.word).map(word).collect())
    }
}

fn fits(found: u128, wanted: usize) -> Result<(), String> {
    if found == wanted as u128 {
        return Ok(());
    }
    Err(format!(
        "it has {found} bytes where the grid needs {wanted}"
    ))
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// Bytes in base64, for files made by tests.
    pub fn encode(bytes: &[u8]) -> String {
        let alphabet = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
        let mut text = String::new();
        for three in bytes.chunks(3) {
            let byte = |i: usize| u32::from(three.get(i).copied().unwrap_or(0));
            let bits = byte(0) << 16 | byte(1) << 8 | byte(2);
            for i in 0..4 {
                let six = alphabet[(bits >> (18 - 6 * i)) as usize & 63];
                text.push(if i <= three.len() { six.into() } else { '=' });
            }
        }
        text
    }

    /// Bytes compressed by zlib.
    pub fn deflate(bytes: &[u8]) -> Vec<u8> {
        let mut out = Vec::new();
        flate2::bufread::ZlibEncoder::new(bytes, flate2::Compression::best())
            .read_to_end(&mut out)
            .unwrap();
        out
    }

    #[test]
    fn base64_is_that_of_the_standard() {
        // Test vectors of RFC 4648, section 10, and the two last characters of the alphabet.
        for (plain, text) in [
            (&b""[..], ""),
            (b"f", "Zg=="),
            (b"fo", "Zm8="),
            (b"foo", "Zm9v"),
            (b"foob", "Zm9vYg=="),
            (b"fooba", "Zm9vYmE="),
            (b"foobar", "Zm9vYmFy"),
            (b"\xfb\xef\xff", "++//"),
        ] {
            assert_eq!(encode(plain), text);
            let mut stream = Stream::base64(text.as_bytes());
            assert_eq!(stream.take(plain.len()).unwrap(), plain);
            assert!(stream.take(1).is_err());
        }
    }

    #[test]
    fn base64_is_taken_in_any_portions_over_space_and_padding() {
        let text = b" Zm9v\n\tYm Fy Zg== Zm8=\n";
        for portion in 1..=9 {
            let mut stream = Stream::base64(text);
            let mut all = Vec::new();
            while all.len() < 9 {
                let n = portion.min(9 - all.len());
                all.extend_from_slice(&stream.take(n).unwrap());
            }
            assert_eq!(all, b"foobarffo");
            assert!(stream.take(1).is_err());
        }
    }

    #[test]
    fn what_is_no_base64_is_refused() {
        for text in ["Zm9", "Zm9_", "Z===", "=m9v", "Zm=v", "Zm9v!", "Zm9é"] {
            let mut stream = Stream::base64(text.as_bytes());
            let taken = stream.take(3).and_then(|_| stream.take(1));
            assert!(taken.is_err(), "{text}");
        }
    }

    fn packing(word: usize, compressor: Option<&str>) -> Packing {
        Packing {
            word,
            compressor: compressor.map(str::to_string),
        }
    }

    fn header(words: &[u64]) -> Vec<u8> {
        words.iter().flat_map(|n| n.to_le_bytes()).collect()
    }

    #[test]
    fn sizes_beyond_the_file_are_refused_before_memory_is_set_aside() {
        let huge = 1_usize << 60;
        let plain = header(&[huge as u64, 1, 2]);
        let zlib = Some("vtkZLibDataCompressor");
        // Many blocks; a large block; compressed sizes beyond the end and beyond any number.
        let many = header(&[1 << 40, 1 << 20, 0]);
        let large = header(&[1, huge as u64, 0, 9]);
        let long = header(&[1, huge as u64, 0, huge as u64]);
        let longer = header(&[u64::MAX, u64::MAX, u64::MAX, u64::MAX]);
        for (bytes, compressor) in [
            (&plain, None),
            (&many, zlib),
            (&large, zlib),
            (&long, zlib),
            (&longer, zlib),
        ] {
            let packing = packing(8, compressor);
            assert!(packing.unpack(Stream::Raw(bytes), huge).is_err());
            let text = encode(bytes);
            let text = Stream::base64(text.as_bytes());
            assert!(packing.unpack(text, huge).is_err());
        }
    }

    #[test]
    fn blocks_have_the_size_that_their_header_says() {
        let block = deflate(b"twelve bytes");
        let zlib = packing(8, Some("vtkZLibDataCompressor"));
        let file = |size: u64, last: u64| {
            let mut bytes = header(&[1, size, last, block.len() as u64]);
            bytes.extend(&block);
            bytes
        };
        // A last block that is full may be given or not.
        for bytes in [file(12, 0), file(12, 12), file(32, 12)] {
            let read = zlib.unpack(Stream::Raw(&bytes), 12).unwrap();
            assert_eq!(&read[..], b"twelve bytes");
        }
        for (bytes, wanted) in [(file(11, 0), 11), (file(13, 0), 13), (file(12, 0), 24)] {
            let error = zlib.unpack(Stream::Raw(&bytes), wanted).unwrap_err();
            assert!(error.contains("12 bytes"), "{error}");
        }
        let mut damaged = file(12, 0);
        let end = damaged.len();
        damaged[end - 1] ^= 1;
        let error = zlib.unpack(Stream::Raw(&damaged), 12).unwrap_err();
        assert!(error.contains("damaged"), "{error}");
    }
}

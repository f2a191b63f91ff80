//! Substructures as files: a header, the numbers, and a digest of all of it.

use std::fs::{self, File};
use std::io::{self, Read, Write};
use std::path::Path;

use super::identity::{Identity, Part};
use super::substructure::{Floating, Seconds, Substructure, SweptPatterns};
use crate::linear::{Compliance, Digest, PartialFactor};
use crate::linear::{read_factor, write_factor};
use crate::owner;

/// Names the format.
const FORMAT_NAME: &[u8; 8] = b"slipsub\0";

/// Version of the format.
const FILE_FORMAT: u64 = 2;

/// Bytes of the header: magic, format, version of the program, identity, length of what follows up to the digest.
const HEADER_BYTES: usize = 8 + 8 + VERSION_BYTES + 16 + 8;

/// Bytes of a version, padded with zeros.
const VERSION_BYTES: usize = 24;

/// Bytes of the digest at the end.
const DIGEST: usize = 16;

/// Bytes read, written and digested at a time.
const BYTES_AT_A_TIME: usize = 1 << 18;

/// Kept dofs up to which a part without interior is not worth a file.
pub(super) const SMALL_PART: usize = 12;

fn version() -> [u8; VERSION_BYTES] {
    let mut version = [0; VERSION_BYTES];
    let text = env!("CARGO_PKG_VERSION").as_bytes();
    let length = text.len().min(VERSION_BYTES);
    version[..length].copy_from_slice(&text[..length]);
    version
}

fn header(identity: Identity, length: u64) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(HEADER_BYTES);
    bytes.extend(FORMAT_NAME);
    bytes.extend(FILE_FORMAT.to_le_bytes());
    bytes.extend(version());
    bytes.extend(identity.words().iter().flat_map(|w| w.to_le_bytes()));
    bytes.extend(length.to_le_bytes());
    bytes
}

fn invalid(what: &str) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidData, what.to_string())
}

/// A substructure and its factor, which is one for files.
pub(super) type Whole<'a> = (&'a Substructure, &'a PartialFactor);

/// Writes a substructure aside and renames it: other processes see all of it or nothing.
pub(super) fn write(path: &Path, whole: Whole) -> io::Result<()> {
    let aside = owner::aside(path);
    let written = write_all(&aside, whole).and_then(|()| fs::rename(&aside, path));
    if written.is_err() {
        // The first error is the one to report.
        let _ = fs::remove_file(&aside);
    }
    written
}

fn write_all(path: &Path, whole: Whole) -> io::Result<()> {
    let mut counter = Counter(0);
    encode(whole, &mut counter)?;
    let header = header(whole.0.identity, counter.0);
    let mut digest = Digest::default();
    digest.bytes(&header);
    let mut file = File::create(path)?;
    file.write_all(&header)?;
    let mut writer = Writer {
        file,
        digest,
        buffer: Vec::with_capacity(BYTES_AT_A_TIME),
    };
    encode(whole, &mut writer)?;
    writer.flush()?;
    let digest = writer.digest.finish();
    let bytes: Vec<u8> = digest.iter().flat_map(|w| w.to_le_bytes()).collect();
    writer.file.write_all(&bytes)
}

fn encode((substructure, factor): Whole, out: &mut dyn Write) -> io::Result<()> {
    write_factor(factor, out)?;
    substructure.compliance.encode(out)?;
    let modes = substructure.floating.as_ref();
    let (modes, sigma) = modes.map_or((&[][..], 0.0), |f| (&f.modes[..], f.sigma));
    out.write_all(&(modes.len() as u64).to_le_bytes())?;
    out.write_all(&sigma.to_le_bytes())?;
    for mode in modes {
        let bytes: Vec<u8> = mode.iter().flat_map(|v| v.to_le_bytes()).collect();
        out.write_all(&bytes)?;
    }
    Ok(())
}

/// Reads a substructure; `None` if there is no file. Memory grows with what is read, whatever the file says.
///
/// # Errors
/// Those of the file system; [`io::ErrorKind::InvalidData`] and [`io::ErrorKind::UnexpectedEof`] if it is not the file of this part, made by this
/// version, whole and undamaged.
pub(super) fn read(
    path: &Path,
    identity: Identity,
    part: &Part,
) -> io::Result<Option<Substructure>> {
    let mut file = match File::open(path) {
        Ok(file) => file,
        Err(e) if e.kind() == io::ErrorKind::NotFound => return Ok(None),
        Err(e) => return Err(e),
    };
    let all = file.metadata()?.len();
    let mut begin = [0; HEADER_BYTES];
    file.read_exact(&mut begin)
        .map_err(|_| invalid("it is cut short"))?;
    if !begin.starts_with(FORMAT_NAME) {
        return Err(invalid("it is something else"));
    }
    let length = all.saturating_sub((HEADER_BYTES + DIGEST) as u64);
    let expected = header(identity, length);
    if begin != expected[..] {
        let made_alike = begin[..16 + VERSION_BYTES] == expected[..16 + VERSION_BYTES];
        return Err(invalid(match made_alike {
            false => "it was made by another version",
            true if begin[..HEADER_BYTES - 8] == expected[..HEADER_BYTES - 8] => {
                "it has another length"
            }
            true => "it is for something else",
        }));
    }
    let mut digest = Digest::default();
    digest.bytes(&begin);
    let mut reader = Reader {
        file,
        digest,
        left: length,
        buffer: Vec::new(),
        at: 0,
    };
    let decoded = decode(&mut reader, identity, part);
    // Whatever a damaged file led to, that it is damaged is the reason.
    reader.check()?;
    decoded.map(Some)
}

fn decode(input: &mut Reader, identity: Identity, part: &Part) -> io::Result<Substructure> {
    let partial = read_factor(input)?;
    let fronts = partial.fronts();
    let b = part.matrix.block_size();
    let free = |p: usize| (p * b..(p + 1) * b).filter(|&dof| !part.fixed[dof]);
    let kept = part.points().filter(|&p| part.kept[p]).flat_map(free);
    let suits = fronts.points() == part.points()
        && fronts.block_size() == b
        && kept.eq(fronts.root().iter().map(|&dof| dof as usize));
    if !suits {
        return Err(invalid("it is of another body"));
    }
    let n = fronts.root().len();
    let compliance = Compliance::decode(n, input)?;
    let mut word = || -> io::Result<[u8; 8]> {
        let mut bytes = [0; 8];
        input.read_exact(&mut bytes)?;
        Ok(bytes)
    };
    let count = u64::from_le_bytes(word()?);
    let sigma = f64::from_le_bytes(word()?);
    if count > n as u64 || !sigma.is_finite() {
        return Err(invalid("it has wrong numbers"));
    }
    let mut modes = Vec::new();
    let mut bytes = vec![0; 8 * n];
    for _ in 0..count {
        input.read_exact(&mut bytes)?;
        let (numbers, _) = bytes.as_chunks::<8>();
        let mode: Vec<f64> = numbers.iter().map(|&b| f64::from_le_bytes(b)).collect();
        modes.push(mode);
    }
    if input.left > 0 || input.at < input.buffer.len() {
        return Err(invalid("it is too long"));
    }
    let floating = (!modes.is_empty()).then(|| Floating::new(modes, sigma, &compliance));
    Ok(Substructure {
        identity,
        interior: Box::new(partial),
        compliance,
        floating,
        seconds: Seconds::default(),
        swept: SweptPatterns::default(),
    })
}

/// Counts bytes.
struct Counter(u64);

impl Write for Counter {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0 += bytes.len() as u64;
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// Writes and digests whole chunks.
struct Writer {
    file: File,
    digest: Digest,
    buffer: Vec<u8>,
}

impl Write for Writer {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let taken = bytes.len().min(BYTES_AT_A_TIME - self.buffer.len());
        self.buffer.extend_from_slice(&bytes[..taken]);
        if self.buffer.len() == BYTES_AT_A_TIME {
            self.flush()?;
        }
        Ok(taken)
    }

    fn flush(&mut self) -> io::Result<()> {
        if !self.buffer.is_empty() {
            self.digest.bytes(&self.buffer);
            self.file.write_all(&self.buffer)?;
            self.buffer.clear();
        }
        Ok(())
    }
}

/// Reads and digests whole chunks, up to the digest at the end.
struct Reader {
    file: File,
    digest: Digest,
    /// Bytes not yet read.
    left: u64,
    buffer: Vec<u8>,
    /// How much of the buffer was handed out.
    at: usize,
}

impl Reader {
    fn fill(&mut self) -> io::Result<()> {
        let length = self.left.min(BYTES_AT_A_TIME as u64) as usize;
        self.buffer.resize(length, 0);
        self.at = 0;
        self.file.read_exact(&mut self.buffer)?;
        self.digest.bytes(&self.buffer);
        self.left -= length as u64;
        Ok(())
    }

    /// Reads what is left and compares digests.
    fn check(&mut self) -> io::Result<()> {
        while self.left > 0 {
            self.fill()?;
        }
        let mut end = [0; DIGEST];
        self.file.read_exact(&mut end)?;
        let digest = self.digest.finish();
        let expected = digest.iter().flat_map(|w| w.to_le_bytes());
        if end.into_iter().eq(expected) {
            Ok(())
        } else {
            Err(invalid("it is damaged"))
        }
    }
}

impl Read for Reader {
    fn read(&mut self, out: &mut [u8]) -> io::Result<usize> {
        if self.at == self.buffer.len() && self.left > 0 {
            self.fill()?;
        }
        let ready = &self.buffer[self.at..];
        let taken = ready.len().min(out.len());
        out[..taken].copy_from_slice(&ready[..taken]);
        self.at += taken;
        Ok(taken)
    }
}

//! Files of words, eight bytes each: what they are, how many there are, the words, a checksum. Both sides run on machines of one kind.

use std::fs::File;
use std::io::{self, BufReader, BufWriter, Read, Write};
use std::path::Path;

/// Names the format: `spslump1` in little endian.
const MAGIC: u64 = 0x3170_6d75_736c_7073;

/// Bytes read and written at a time.
const CHUNK: usize = 1 << 16;

fn mix(sum: u64, word: u64) -> u64 {
    let mixed = (sum ^ word).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    mixed ^ (mixed >> 32)
}

/// Writes a file whose number of words is known beforehand.
pub(super) struct WordWriter {
    file: BufWriter<File>,
    left: u64,
    sum: u64,
}

impl WordWriter {
    pub fn new(path: &Path, count: u64) -> io::Result<Self> {
        let mut file = BufWriter::with_capacity(CHUNK, File::create(path)?);
        file.write_all(&MAGIC.to_ne_bytes())?;
        file.write_all(&count.to_ne_bytes())?;
        Ok(WordWriter {
            file,
            left: count,
            sum: 0,
        })
    }

    pub fn word(&mut self, word: u64) -> io::Result<()> {
        self.sum = mix(self.sum, word);
        self.left = self.left.wrapping_sub(1);
        self.file.write_all(&word.to_ne_bytes())
    }

    pub fn numbers(&mut self, numbers: &[f64]) -> io::Result<()> {
        numbers.iter().try_for_each(|x| self.word(x.to_bits()))
    }

    pub fn finish(mut self) -> io::Result<()> {
        if self.left != 0 {
            return Err(io::Error::other("another number of words than announced"));
        }
        self.file.write_all(&self.sum.to_ne_bytes())?;
        self.file.flush()
    }
}

/// Reads a file of a number of words that is known, and deletes it.
pub(super) struct WordReader<'a> {
    path: &'a Path,
    file: BufReader<File>,
    sum: u64,
}

impl<'a> WordReader<'a> {
    pub fn new(path: &'a Path, count: usize) -> io::Result<Self> {
        let file = File::open(path)?;
        let mut reader = WordReader {
            path,
            file: BufReader::with_capacity(CHUNK, file),
            sum: 0,
        };
        if reader.raw()? != MAGIC {
            return Err(io::Error::other("it is something else"));
        }
        if reader.raw()? != count as u64 {
            return Err(io::Error::other("it has another length"));
        }
        Ok(reader)
    }

    fn raw(&mut self) -> io::Result<u64> {
        let mut bytes = [0; 8];
        self.file.read_exact(&mut bytes)?;
        Ok(u64::from_ne_bytes(bytes))
    }

    pub fn numbers(&mut self, out: &mut [f64]) -> io::Result<()> {
        for x in out {
            let word = self.raw()?;
            self.sum = mix(self.sum, word);
            *x = f64::from_bits(word);
        }
        Ok(())
    }

    pub fn finish(mut self) -> io::Result<()> {
        if self.raw()? != self.sum {
            return Err(io::Error::other("it is damaged"));
        }
        std::fs::remove_file(self.path)
    }
}

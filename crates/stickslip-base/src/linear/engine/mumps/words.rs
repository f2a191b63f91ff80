//! Files of words, eight bytes each: what they are, how many there are, the words, a checksum. Both sides run on machines of one kind.

use std::fs::File;
use std::io::{self, BufReader, BufWriter, Read, Seek, SeekFrom, Write};
use std::path::Path;

/// Names the format: `spslump1` in little endian.
const FORMAT_WORD: u64 = 0x3170_6d75_736c_7073;

/// Bytes read and written at a time.
const PIPE_BYTES: usize = 1 << 16;

fn mix(sum: u64, word: u64) -> u64 {
    let mixed = (sum ^ word).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    mixed ^ (mixed >> 32)
}

/// Writes a file, whose number of words is entered in the end.
pub(super) struct WordWriter {
    file: BufWriter<File>,
    count: u64,
    sum: u64,
}

impl WordWriter {
    pub fn new(path: &Path) -> io::Result<Self> {
        let mut file = BufWriter::with_capacity(PIPE_BYTES, File::create(path)?);
        file.write_all(&FORMAT_WORD.to_ne_bytes())?;
        file.write_all(&0_u64.to_ne_bytes())?;
        Ok(WordWriter {
            file,
            count: 0,
            sum: 0,
        })
    }

    pub fn word(&mut self, word: u64) -> io::Result<()> {
        self.sum = mix(self.sum, word);
        self.count += 1;
        self.file.write_all(&word.to_ne_bytes())
    }

    pub fn numbers(&mut self, numbers: &[f64]) -> io::Result<()> {
        numbers.iter().try_for_each(|x| self.word(x.to_bits()))
    }

    pub fn finish(mut self) -> io::Result<()> {
        self.file.write_all(&self.sum.to_ne_bytes())?;
        self.file
            .seek(SeekFrom::Start(size_of_val(&FORMAT_WORD) as u64))?;
        self.file.write_all(&self.count.to_ne_bytes())?;
        self.file.flush()
    }
}

/// Reads a file, and deletes it.
pub(super) struct WordReader<'a> {
    path: &'a Path,
    file: BufReader<File>,
    left: u64,
    sum: u64,
}

impl<'a> WordReader<'a> {
    pub fn new(path: &'a Path) -> io::Result<Self> {
        let file = File::open(path)?;
        let mut reader = WordReader {
            path,
            file: BufReader::with_capacity(PIPE_BYTES, file),
            left: 0,
            sum: 0,
        };
        if reader.raw()? != FORMAT_WORD {
            return Err(io::Error::other("it is something else"));
        }
        reader.left = reader.raw()?;
        Ok(reader)
    }

    fn raw(&mut self) -> io::Result<u64> {
        let mut bytes = [0; 8];
        self.file.read_exact(&mut bytes)?;
        Ok(u64::from_ne_bytes(bytes))
    }

    pub fn word(&mut self) -> io::Result<u64> {
        let other = || io::Error::other("it has another length");
        self.left = self.left.checked_sub(1).ok_or_else(other)?;
        let word = self.raw()?;
        self.sum = mix(self.sum, word);
        Ok(word)
    }

    pub fn numbers(&mut self, out: &mut [f64]) -> io::Result<()> {
        for x in out {
            *x = f64::from_bits(self.word()?);
        }
        Ok(())
    }

    pub fn finish(mut self) -> io::Result<()> {
        if self.left != 0 {
            return Err(io::Error::other("it has another length"));
        }
        if self.raw()? != self.sum {
            return Err(io::Error::other("it is damaged"));
        }
        std::fs::remove_file(self.path)
    }
}

//! A fast hash of numbers, the same on every machine: XXH3 in 128 bits, over numbers as little-endian bytes.

use std::fmt;

use xxhash_rust::xxh3::Xxh3;

/// Makes 128 bits of any sequence of numbers. It finds accidents and tells contents apart: that different ones have the same digest is not to be
/// expected in practice. It keeps no secrets.
///
/// Each slice is mixed with its length, so that the same numbers cut otherwise have another digest.
#[derive(Clone, Default)]
pub struct Digest(Xxh3);

/// Numbers turned into bytes at a time.
const DIGESTED_AT_A_TIME: usize = 512;

impl Digest {
    /// A digest that starts with a word, to tell uses apart.
    pub fn of(word: u64) -> Self {
        let mut digest = Digest::default();
        digest.word(word);
        digest
    }

    fn slice<T: Copy, const BYTES: usize>(
        &mut self,
        all: &[T],
        to_bytes: impl Fn(T) -> [u8; BYTES],
    ) {
        self.word(all.len() as u64);
        let mut buffer = [[0; BYTES]; DIGESTED_AT_A_TIME];
        for chunk in all.chunks(DIGESTED_AT_A_TIME) {
            for (bytes, &number) in buffer.iter_mut().zip(chunk) {
                *bytes = to_bytes(number);
            }
            self.0.update(buffer[..chunk.len()].as_flattened());
        }
    }

    /// Mixes one word.
    pub fn word(&mut self, word: u64) {
        self.0.update(&word.to_le_bytes());
    }

    /// Mixes numbers, by their bits.
    pub fn floats(&mut self, all: &[f64]) {
        self.slice(all, f64::to_le_bytes);
    }

    /// Mixes indices.
    pub fn indices(&mut self, all: &[u32]) {
        self.slice(all, u32::to_le_bytes);
    }

    /// Mixes bytes.
    pub fn bytes(&mut self, all: &[u8]) {
        self.word(all.len() as u64);
        self.0.update(all);
    }

    /// Mixes marks.
    pub fn marks(&mut self, all: &[bool]) {
        self.slice(all, |mark| [u8::from(mark)]);
    }

    /// The digest of everything so far.
    pub fn finish(&self) -> [u64; 2] {
        let all = self.0.digest128();
        [all as u64, (all >> 64) as u64]
    }
}

impl fmt::Debug for Digest {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Digest({:x?})", self.finish())
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::super::testing::noise;
    use super::Digest;

    fn of(mix: impl FnOnce(&mut Digest)) -> [u64; 2] {
        let mut digest = Digest::default();
        mix(&mut digest);
        digest.finish()
    }

    #[test]
    fn every_bit_of_every_number_counts() {
        let numbers = noise(&mut 1, 37);
        let mut seen = BTreeSet::from([of(|d| d.floats(&numbers))]);
        let mut halves = BTreeSet::new();
        for at in 0..numbers.len() {
            for bit in 0..64 {
                let mut changed = numbers.clone();
                changed[at] = f64::from_bits(changed[at].to_bits() ^ (1 << bit));
                let digest = of(|d| d.floats(&changed));
                assert!(seen.insert(digest), "number {at}, bit {bit}");
                halves.extend(digest);
            }
        }
        assert_eq!(halves.len(), 2 * 37 * 64);
        // Half of the bits change, more or less.
        let turned = (0..64).map(|bit| {
            let digest = of(|d| d.word(1 << bit));
            let other = of(|d| d.word(0));
            (digest[0] ^ other[0]).count_ones() + (digest[1] ^ other[1]).count_ones()
        });
        assert!(turned.into_iter().all(|n| (30..99).contains(&n)));
    }

    #[test]
    fn order_lengths_and_cuts_count() {
        let mut seen = BTreeSet::new();
        for length in 0..100 {
            assert!(seen.insert(of(|d| d.bytes(&vec![0; length]))));
        }
        let all: Vec<u32> = (0..40).collect();
        for cut in 0..40 {
            let digest = of(|d| {
                d.indices(&all[..cut]);
                d.indices(&all[cut..]);
            });
            assert!(seen.insert(digest), "{cut}");
        }
        for (i, j) in (0..40).flat_map(|i| (0..i).map(move |j| (i, j))) {
            let mut swapped = all.clone();
            swapped.swap(i, j);
            assert!(seen.insert(of(|d| d.indices(&swapped))), "{i} {j}");
        }
        let mut marks = vec![false; 130];
        for at in 0..marks.len() {
            marks[at] = true;
            assert!(seen.insert(of(|d| d.marks(&marks))), "{at}");
        }
    }

    #[test]
    fn digests_stay_as_they_are() {
        // Of nothing, as the specification of XXH3 has it; and files are found by digests.
        let nothing = Digest::default().finish();
        assert_eq!(nothing, [0x6001_c324_468d_497f, 0x99aa_06d3_0147_98d8]);
        let digest = of(|d| {
            d.word(7);
            d.floats(&[1.0, -2.5, 1e-300]);
            d.indices(&[1, 2, 3]);
            d.bytes(b"digest");
            d.marks(&[true, false, true]);
        });
        assert_eq!(
            digest,
            [15_829_074_300_007_986_465, 9_174_140_344_924_180_496]
        );
    }
}

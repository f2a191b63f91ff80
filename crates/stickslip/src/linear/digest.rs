//! A fast hash of numbers, the same on every machine.

/// Words mixed at a time, each into chains of its own.
const LANES: usize = 4;

/// Odd constants with about as many ones as zeros: parts of the square roots of 2, 3, 5 and 7.
const FIRST: [u64; LANES] = [
    0x6a09_e667_f3bc_c909,
    0xbb67_ae85_84ca_a73b,
    0x3c6e_f372_fe94_f82b,
    0xa54f_f53a_5f1d_36f1,
];
/// The same of 11, 13, 17 and 19.
const SECOND: [u64; LANES] = [
    0x510e_527f_ade6_82d1,
    0x9b05_688c_2b3e_6c1f,
    0x1f83_d9ab_fb41_bd6b,
    0x5be0_cd19_137e_2179,
];

/// Makes 128 bits of any sequence of numbers. It finds accidents and tells contents apart: that different ones have the same digest is not to be
/// expected in practice. It keeps no secrets.
///
/// Every word goes into two chains of multiplications and shifts. Each slice is mixed with its length, so that the same numbers cut otherwise have
/// another digest.
#[derive(Debug, Clone)]
pub struct Digest {
    first: [u64; LANES],
    second: [u64; LANES],
    words: u64,
}

impl Default for Digest {
    fn default() -> Self {
        Digest {
            first: FIRST,
            second: SECOND,
            words: 0,
        }
    }
}

impl Digest {
    /// A digest that starts with a word, to tell uses apart.
    pub fn of(word: u64) -> Self {
        let mut digest = Digest::default();
        digest.word(word);
        digest
    }

    #[inline(always)]
    fn block(&mut self, words: [u64; LANES]) {
        for lane in 0..LANES {
            // both steps can be undone, so no word is lost
            let a = (self.first[lane] ^ words[lane]).wrapping_mul(SECOND[lane]);
            self.first[lane] = a ^ (a >> 32);
            let b = (self.second[lane].wrapping_add(words[lane])).wrapping_mul(FIRST[lane]);
            self.second[lane] = b ^ (b >> 29);
        }
    }

    /// Mixes blocks of numbers that make whole words; what is missing from the last one is zero.
    #[inline(always)]
    fn slice<T: Copy, const PER_BLOCK: usize>(
        &mut self,
        all: &[T],
        to_words: impl Fn(&[T; PER_BLOCK]) -> [u64; LANES],
        zero: T,
    ) {
        self.words = self.words.wrapping_add(all.len() as u64 + 1);
        let (blocks, rest) = all.as_chunks::<PER_BLOCK>();
        for block in blocks {
            self.block(to_words(block));
        }
        let mut last = [zero; PER_BLOCK];
        last[..rest.len()].copy_from_slice(rest);
        if !rest.is_empty() {
            self.block(to_words(&last));
        }
        self.block([all.len() as u64, self.words, 0, 0]);
    }

    /// Mixes one word.
    pub fn word(&mut self, word: u64) {
        self.words = self.words.wrapping_add(1);
        self.block([word, self.words, 0, 0]);
    }

    /// Mixes numbers, by their bits.
    pub fn floats(&mut self, all: &[f64]) {
        self.slice(all, |b: &[f64; LANES]| b.map(f64::to_bits), 0.0);
    }

    /// Mixes indices.
    pub fn indices(&mut self, all: &[u32]) {
        self.slice(
            all,
            |b: &[u32; 2 * LANES]| {
                std::array::from_fn(|l| u64::from(b[2 * l]) | (u64::from(b[2 * l + 1]) << 32))
            },
            0,
        );
    }

    /// Mixes bytes.
    pub fn bytes(&mut self, all: &[u8]) {
        self.slice(
            all,
            |b: &[u8; 8 * LANES]| {
                std::array::from_fn(|l| {
                    let word: [u8; 8] = std::array::from_fn(|k| b[8 * l + k]);
                    u64::from_le_bytes(word)
                })
            },
            0,
        );
    }

    /// Mixes marks.
    pub fn marks(&mut self, all: &[bool]) {
        self.slice(
            all,
            |b: &[bool; 64]| {
                let bits = |marks: &[bool]| {
                    let ones = marks.iter().enumerate();
                    ones.fold(0, |word, (k, &mark)| word | (u64::from(mark) << k))
                };
                [
                    bits(&b[..16]),
                    bits(&b[16..32]),
                    bits(&b[32..48]),
                    bits(&b[48..]),
                ]
            },
            false,
        );
    }

    /// The digest of everything so far.
    pub fn finish(&self) -> [u64; 2] {
        let mut end = self.clone();
        // every lane meets every other
        for round in 0..2 * LANES {
            let (a, b) = (end.first, end.second);
            end.block(std::array::from_fn(|l| {
                b[(l + round) % LANES].rotate_left(23) ^ a[(l + round + 1) % LANES]
            }));
        }
        let fold = |lanes: [u64; LANES], by: [u64; LANES]| {
            lanes.iter().zip(by).fold(0u64, |sum, (lane, by)| {
                let mixed = (sum ^ lane).wrapping_mul(by);
                mixed ^ (mixed >> 31)
            })
        };
        [fold(end.first, SECOND), fold(end.second, FIRST)]
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
        // Files are found by them.
        let digest = of(|d| {
            d.word(7);
            d.floats(&[1.0, -2.5, 1e-300]);
            d.indices(&[1, 2, 3]);
            d.bytes(b"digest");
            d.marks(&[true, false, true]);
        });
        assert_eq!(
            digest,
            [15_386_621_094_104_780_417, 14_912_162_299_251_296_838]
        );
    }
}

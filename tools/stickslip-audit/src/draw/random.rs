//! Random numbers that are the same everywhere and for ever.

/// SplitMix64 (Steele, Lea and Flood 2014): a counter, scrambled. Every seed is a good one, zero too.
pub struct Random(u64);

impl Random {
    /// The sequence of a seed.
    pub fn new(seed: u64) -> Self {
        Random(seed)
    }

    /// 64 random bits.
    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// From 0 to 1, without 1.
    fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// A number of an interval, with three digits: files stay readable.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        digits(low + (high - low) * self.unit())
    }

    /// The same, uniform in the logarithm.
    pub fn spread(&mut self, low: f64, high: f64) -> f64 {
        digits(low * (high / low).powf(self.unit()))
    }

    /// A whole number, both ends included.
    pub fn whole(&mut self, low: u64, high: u64) -> u64 {
        low + self.bits() % (high - low + 1)
    }

    /// True in this fraction of cases.
    pub fn chance(&mut self, fraction: f64) -> bool {
        self.unit() < fraction
    }

    /// One of a list.
    pub fn pick<T: Copy>(&mut self, list: &[T]) -> T {
        list[(self.bits() % list.len() as u64) as usize]
    }
}

/// Rounded to three significant digits.
pub fn digits(x: f64) -> f64 {
    format!("{x:.2e}").parse().unwrap_or(x)
}

#[cfg(test)]
mod tests {
    use super::{Random, digits};

    #[test]
    fn the_sequence_is_that_of_the_published_algorithm() {
        let mut random = Random::new(1234567);
        assert_eq!(random.bits(), 6457827717110365317);
        assert_eq!(random.bits(), 3203168211198807973);
    }

    #[test]
    fn numbers_stay_in_their_interval_and_fill_it() {
        let mut random = Random::new(1);
        let drawn: Vec<f64> = (0..1000).map(|_| random.spread(0.01, 100.0)).collect();
        assert!(drawn.iter().all(|x| (0.01..=100.0).contains(x)));
        let below = drawn.iter().filter(|x| **x < 1.0).count();
        assert!((400..600).contains(&below), "{below}");
        assert!((0..100).all(|_| (2..=4).contains(&random.whole(2, 4))));
    }

    #[test]
    fn three_digits_are_left() {
        assert_eq!(digits(0.123456), 0.123);
        assert_eq!(digits(-98765.0), -98800.0);
    }
}

//! Numbers of nodes and elements where instances of parts count each for themselves.
//!
//! A deck has one list of nodes and one of elements. Every instance has a range of numbers of its own in them, as wide as the longest number of
//! the deck has digits, so that a number shows whose it is: 2012 is node 12 of the third instance where numbers have up to three digits. Numbers outside
//! of instances come behind those of all instances. Flat decks keep their numbers.

use std::collections::BTreeMap;

use crate::text::squeeze;

/// Numbers from here on are those of no range: what a deck names and cannot have.
const FIRST_OUTSIDE: u64 = 1 << 62;

/// Room for the numbers of an instance that it cannot have.
const RANGE_SIZE: u64 = 1 << 32;

/// How numbers of instances become numbers of the deck.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Numbering {
    /// Instances in the order of the deck.
    names: Vec<String>,
    /// Their indices by name, and by name in capitals without blanks.
    index: BTreeMap<String, usize>,
    /// How many instances there will be.
    count: u64,
    /// Width of a range, 0 for a flat deck.
    stride: u64,
}

impl Numbering {
    /// Ranges for so many instances, and numbers up to `most`.
    pub(crate) fn new(count: usize, most: u64) -> Self {
        let mut stride = 0;
        if count > 0 {
            stride = 10;
            while stride <= most.min(RANGE_SIZE) {
                stride *= 10;
            }
        }
        Numbering {
            names: Vec::new(),
            index: BTreeMap::new(),
            count: count as u64,
            stride,
        }
    }

    /// The instances so far.
    pub fn instances(&self) -> &[String] {
        &self.names
    }

    /// Adds an instance.
    pub(crate) fn add(&mut self, name: String) -> usize {
        let at = self.names.len();
        self.index.entry(squeeze(&name)).or_insert(at);
        self.index.insert(name.clone(), at);
        self.names.push(name);
        at
    }

    /// The index of an instance. Names that were quoted are found by others that differ in blanks and case only.
    pub(crate) fn find(&self, name: &str) -> Option<usize> {
        let exact = self.index.get(name);
        exact.or_else(|| self.index.get(&squeeze(name))).copied()
    }

    fn range(&self, instance: Option<usize>) -> u64 {
        instance.map_or(self.count, |i| i as u64)
    }

    /// The number in the deck of number `n` of an instance, or of what stands outside of all.
    pub fn of(&self, instance: Option<usize>, n: u64) -> u64 {
        let range = self.range(instance);
        match self.stride == 0 || n < self.stride {
            true => range * self.stride + n,
            // Behind the end of the range the next instance begins, which is not meant.
            false => FIRST_OUTSIDE + range * RANGE_SIZE + n.min(RANGE_SIZE - 1),
        }
    }

    /// All numbers of an instance, or outside of all, from `a` to `b`.
    pub(crate) fn span(&self, instance: Option<usize>, a: u64, b: u64) -> Option<(u64, u64)> {
        let last = match self.stride {
            0 => u64::MAX,
            stride => stride - 1,
        };
        let b = b.min(last);
        (a <= b).then(|| (self.of(instance, a), self.of(instance, b)))
    }

    /// The instance of a number of the deck, and its number there.
    pub fn parts(&self, n: u64) -> (Option<&str>, u64) {
        if self.stride == 0 {
            return (None, n);
        }
        let (range, own) = match n.checked_sub(FIRST_OUTSIDE) {
            Some(rest) => (rest / RANGE_SIZE, rest % RANGE_SIZE),
            None => (n / self.stride, n % self.stride),
        };
        (self.names.get(range as usize).map(String::as_str), own)
    }

    /// A number of the deck as the deck writes it: `PART-1-1.12`.
    pub fn label(&self, n: u64) -> String {
        match self.parts(n) {
            (Some(instance), own) => format!("{instance}.{own}"),
            (None, own) => own.to_string(),
        }
    }

    /// The name of a set without the instance that has it.
    pub(crate) fn bare<'n>(&self, name: &'n str) -> &'n str {
        self.within(name).map_or(name, |(_, bare)| bare)
    }

    /// The instance that a name begins with, and what follows.
    pub(crate) fn within<'n>(&self, name: &'n str) -> Option<(usize, &'n str)> {
        if self.names.is_empty() {
            return None;
        }
        name.match_indices('.').find_map(|(at, _)| {
            let instance = self.find(&name[..at])?;
            Some((instance, &name[at + 1..]))
        })
    }
}

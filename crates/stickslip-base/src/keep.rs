//! State as bytes and back, to the bit: what a checkpoint is written with.
//!
//! `#[derive(Keep)]` keeps all fields of a struct, and variants of an enum with what they carry. Numbers are little-endian, floats keep
//! every bit, NaN included, lists have their length in front. There is neither a name nor a type in the bytes: they are read by a program that keeps the same
//! fields in the same order, and who stores them puts a digest of that in front: of the [`layout`], a text that follows from the definitions, so
//! that it is not forgotten where a field comes in. General formats were considered. Those that serde feeds skip what is skipped in `summary.json`, which
//! here must not be, and cannot say of what layout they are; borsh refuses NaN.

use std::any::type_name;
use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::sync::Arc;

pub use stickslip_derive::Keep;

/// Bytes that are read from the front.
#[derive(Debug)]
pub struct Kept<'a> {
    bytes: &'a [u8],
}

/// Bytes that do not hold what is asked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Broken;

/// State that can be written and read back.
pub trait Keep: Sized {
    /// Appends it.
    fn keep(&self, out: &mut Vec<u8>);

    /// Takes it from the front.
    ///
    /// # Errors
    /// [`Broken`] where the bytes end too early or cannot be what is asked for.
    fn back(from: &mut Kept) -> Result<Self, Broken>;

    /// Says what its bytes are: names and types of all that is kept of it.
    fn layout_of(out: &mut Layout);
}

/// What bytes of a type are: equal for two types, or one type of two programs, only where the bytes of one can be read as the other.
pub fn layout<T: Keep>() -> String {
    let mut out = Layout::default();
    T::layout_of(&mut out);
    out.text
}

/// A layout that is being composed.
#[derive(Debug, Default)]
pub struct Layout {
    text: String,
    /// Types that have been told, by their paths: each is told once, and one that contains itself comes to an end.
    told: BTreeSet<&'static str>,
}

impl Layout {
    /// Adds a word.
    pub fn word(&mut self, word: &str) {
        self.text += word;
        self.text.push(' ');
    }

    /// Adds a type by its name and, the first time, what it is made of.
    pub fn of<T>(&mut self, name: &str, parts: impl FnOnce(&mut Self)) {
        self.word(name);
        if self.told.insert(type_name::<T>()) {
            self.word("{");
            parts(self);
            self.word("}");
        }
    }
}

impl<'a> Kept<'a> {
    /// These bytes.
    pub fn new(bytes: &'a [u8]) -> Self {
        Kept { bytes }
    }

    /// Whether all of them have been read.
    pub fn is_empty(&self) -> bool {
        self.bytes.is_empty()
    }

    /// What has not been read.
    pub fn rest(&self) -> &'a [u8] {
        self.bytes
    }

    fn take(&mut self, count: usize) -> Result<&'a [u8], Broken> {
        let (taken, rest) = self.bytes.split_at_checked(count).ok_or(Broken)?;
        self.bytes = rest;
        Ok(taken)
    }
}

/// Keeps one of a list by the name it has there: what stands in the list is no layout, as its order does not count.
#[macro_export]
macro_rules! keep_by_name {
    ($name:ty, one of $all:expr, by $called:expr) => {
        impl $crate::keep::Keep for $name {
            fn keep(&self, out: &mut Vec<u8>) {
                let called: fn(&Self) -> &'static str = $called;
                $crate::keep::Keep::keep(&called(self).to_string(), out);
            }

            fn back(from: &mut $crate::keep::Kept) -> Result<Self, $crate::keep::Broken> {
                let called: fn(&Self) -> &'static str = $called;
                let name: String = $crate::keep::Keep::back(from)?;
                let mut all = $all.iter().copied();
                all.find(|one| called(one) == name)
                    .ok_or($crate::keep::Broken)
            }

            fn layout_of(out: &mut $crate::keep::Layout) {
                <String as $crate::keep::Keep>::layout_of(out);
            }
        }
    };
}

macro_rules! keep_numbers {
    ($($number:ty),*) => { $(
        impl Keep for $number {
            fn keep(&self, out: &mut Vec<u8>) {
                out.extend_from_slice(&self.to_le_bytes());
            }

            fn back(from: &mut Kept) -> Result<Self, Broken> {
                let bytes = from.take(size_of::<$number>())?;
                Ok(<$number>::from_le_bytes(bytes.try_into().map_err(|_| Broken)?))
            }

            fn layout_of(out: &mut Layout) {
                out.word(stringify!($number));
            }
        }
    )* };
}

keep_numbers!(u8, u32, u64, i32, f64);

impl Keep for usize {
    fn keep(&self, out: &mut Vec<u8>) {
        (*self as u64).keep(out);
    }

    fn back(from: &mut Kept) -> Result<Self, Broken> {
        usize::try_from(u64::back(from)?).map_err(|_| Broken)
    }

    fn layout_of(out: &mut Layout) {
        out.word("usize");
    }
}

impl Keep for bool {
    fn keep(&self, out: &mut Vec<u8>) {
        out.push(u8::from(*self));
    }

    fn back(from: &mut Kept) -> Result<Self, Broken> {
        match u8::back(from)? {
            0 => Ok(false),
            1 => Ok(true),
            _ => Err(Broken),
        }
    }

    fn layout_of(out: &mut Layout) {
        out.word("bool");
    }
}

impl Keep for String {
    fn keep(&self, out: &mut Vec<u8>) {
        self.len().keep(out);
        out.extend_from_slice(self.as_bytes());
    }

    fn back(from: &mut Kept) -> Result<Self, Broken> {
        let count = usize::back(from)?;
        let bytes = from.take(count)?.to_vec();
        String::from_utf8(bytes).map_err(|_| Broken)
    }

    fn layout_of(out: &mut Layout) {
        out.word("text");
    }
}

impl Keep for &'static str {
    fn keep(&self, out: &mut Vec<u8>) {
        self.to_string().keep(out);
    }

    /// Names are those of the program, a few and short: one that is read stays for as long as the process.
    fn back(from: &mut Kept) -> Result<Self, Broken> {
        Ok(String::leak(String::back(from)?))
    }

    fn layout_of(out: &mut Layout) {
        out.word("text");
    }
}

impl<T: Keep> Keep for Option<T> {
    fn keep(&self, out: &mut Vec<u8>) {
        self.is_some().keep(out);
        if let Some(value) = self {
            value.keep(out);
        }
    }

    fn back(from: &mut Kept) -> Result<Self, Broken> {
        match bool::back(from)? {
            true => Ok(Some(T::back(from)?)),
            false => Ok(None),
        }
    }

    fn layout_of(out: &mut Layout) {
        out.word("option");
        T::layout_of(out);
    }
}

impl<T: Keep> Keep for Vec<T> {
    fn keep(&self, out: &mut Vec<u8>) {
        self.len().keep(out);
        self.iter().for_each(|value| value.keep(out));
    }

    fn back(from: &mut Kept) -> Result<Self, Broken> {
        let count = usize::back(from)?;
        // No more room than there are bytes: a length may be wrong.
        let most = from.bytes.len() / size_of::<T>().max(1);
        let mut out = Vec::with_capacity(count.min(most));
        for _ in 0..count {
            out.push(T::back(from)?);
        }
        Ok(out)
    }

    fn layout_of(out: &mut Layout) {
        out.word("list");
        T::layout_of(out);
    }
}

impl<T: Keep> Keep for VecDeque<T> {
    fn keep(&self, out: &mut Vec<u8>) {
        self.len().keep(out);
        self.iter().for_each(|value| value.keep(out));
    }

    fn back(from: &mut Kept) -> Result<Self, Broken> {
        Vec::back(from).map(VecDeque::from)
    }

    fn layout_of(out: &mut Layout) {
        Vec::<T>::layout_of(out);
    }
}

impl<T: Keep> Keep for Box<T> {
    fn keep(&self, out: &mut Vec<u8>) {
        self.as_ref().keep(out);
    }

    fn back(from: &mut Kept) -> Result<Self, Broken> {
        T::back(from).map(Box::new)
    }

    fn layout_of(out: &mut Layout) {
        T::layout_of(out);
    }
}

impl<T: Keep> Keep for Arc<T> {
    fn keep(&self, out: &mut Vec<u8>) {
        self.as_ref().keep(out);
    }

    fn back(from: &mut Kept) -> Result<Self, Broken> {
        T::back(from).map(Arc::new)
    }

    fn layout_of(out: &mut Layout) {
        T::layout_of(out);
    }
}

impl<T: Keep, const N: usize> Keep for [T; N] {
    fn keep(&self, out: &mut Vec<u8>) {
        self.iter().for_each(|value| value.keep(out));
    }

    fn back(from: &mut Kept) -> Result<Self, Broken> {
        let mut all = Vec::with_capacity(N);
        for _ in 0..N {
            all.push(T::back(from)?);
        }
        all.try_into().map_err(|_| Broken)
    }

    fn layout_of(out: &mut Layout) {
        out.word(&format!("{N} of"));
        T::layout_of(out);
    }
}

macro_rules! keep_tuples {
    ($(($($part:ident $at:tt),+))*) => { $(
        impl<$($part: Keep),+> Keep for ($($part,)+) {
            fn keep(&self, out: &mut Vec<u8>) {
                $(self.$at.keep(out);)+
            }

            fn back(from: &mut Kept) -> Result<Self, Broken> {
                Ok(($($part::back(from)?,)+))
            }

            fn layout_of(out: &mut Layout) {
                out.word("(");
                $($part::layout_of(out);)+
                out.word(")");
            }
        }
    )* };
}

keep_tuples!((A 0)(A 0, B 1)(A 0, B 1, C 2));

impl<A: Keep + Ord, B: Keep> Keep for BTreeMap<A, B> {
    fn keep(&self, out: &mut Vec<u8>) {
        self.len().keep(out);
        for (key, value) in self {
            key.keep(out);
            value.keep(out);
        }
    }

    fn back(from: &mut Kept) -> Result<Self, Broken> {
        let all: Vec<(A, B)> = Vec::back(from)?;
        Ok(all.into_iter().collect())
    }

    fn layout_of(out: &mut Layout) {
        Vec::<(A, B)>::layout_of(out);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Debug, PartialEq, Keep)]
    enum Name {
        One,
        Both(usize, [f64; 2]),
        Other,
    }

    #[derive(Debug, PartialEq, Keep)]
    struct Some {
        bits: Vec<u64>,
        name: Option<Name>,
        by: BTreeMap<String, (usize, bool)>,
        all: [i32; 3],
    }

    fn some() -> Some {
        Some {
            bits: vec![f64::NAN.to_bits() | 5, (-0.0_f64).to_bits()],
            name: Option::Some(Name::Other),
            by: [("é".to_string(), (7, true))].into(),
            all: [-1, 0, 1],
        }
    }

    #[test]
    fn what_was_kept_comes_back() {
        let mut bytes = Vec::new();
        some().keep(&mut bytes);
        let mut kept = Kept::new(&bytes);
        assert_eq!(Some::back(&mut kept), Ok(some()));
        assert!(kept.is_empty());
    }

    #[test]
    fn every_variant_comes_back_with_what_it_carries() {
        let all = [Name::One, Name::Both(3, [0.5, -0.0]), Name::Other];
        for one in all {
            let mut bytes = Vec::new();
            one.keep(&mut bytes);
            let mut kept = Kept::new(&bytes);
            assert_eq!(Name::back(&mut kept), Ok(one));
            assert!(kept.is_empty());
        }
        assert_eq!(Name::back(&mut Kept::new(&[3])), Err(Broken));
    }

    #[test]
    fn what_is_made_again_is_neither_written_nor_part_of_the_layout() {
        #[derive(Debug, PartialEq, Keep)]
        struct Half {
            kept: u8,
            #[keep(again)]
            empty: Vec<u8>,
            #[keep(again = usize::MAX)]
            full: usize,
        }
        let mut bytes = Vec::new();
        let half = |empty, full| Half {
            kept: 3,
            empty,
            full,
        };
        half(vec![1], 2).keep(&mut bytes);
        assert_eq!(bytes, [3]);
        let back = Half::back(&mut Kept::new(&bytes));
        assert_eq!(back, Ok(half(Vec::new(), usize::MAX)));
        assert_eq!(layout::<Half>(), "Half { kept u8 } ");
    }

    #[test]
    fn floats_keep_every_bit() {
        let odd = f64::from_bits(f64::NAN.to_bits() | 5);
        let mut bytes = Vec::new();
        vec![odd, -0.0, 5e-324, f64::NEG_INFINITY].keep(&mut bytes);
        let back = Vec::<f64>::back(&mut Kept::new(&bytes)).unwrap_or_default();
        let bits: Vec<u64> = back.iter().map(|x| x.to_bits()).collect();
        let same = [odd, -0.0, 5e-324, f64::NEG_INFINITY].map(f64::to_bits);
        assert_eq!(bits, same);
    }

    #[test]
    fn bytes_cut_anywhere_are_refused() {
        let mut bytes = Vec::new();
        some().keep(&mut bytes);
        for end in 0..bytes.len() {
            assert_eq!(Some::back(&mut Kept::new(&bytes[..end])), Err(Broken));
        }
        // A length of nearly all the memory there is.
        let long = u64::MAX.to_le_bytes();
        assert_eq!(Vec::<u8>::back(&mut Kept::new(&long)), Err(Broken));
    }

    /// What is kept of a thing in six versions of a program.
    mod versions {
        macro_rules! version {
            ($name:ident: $($field:ident: $type:ty),*) => {
                pub mod $name {
                    #[derive(crate::keep::Keep)]
                    pub struct Thing { $(pub $field: $type),* }
                }
            };
        }
        version!(first: count: usize, length: f64);
        version!(again: count: usize, length: f64);
        version!(more: count: usize, length: f64, width: f64);
        version!(moved: length: f64, count: usize);
        version!(called: count: usize, width: f64);
        version!(typed: count: usize, length: [f64; 1]);
    }

    #[test]
    fn a_field_that_is_added_moved_renamed_or_of_another_type_makes_another_layout() {
        use versions::*;
        assert_eq!(
            layout::<first::Thing>(),
            "Thing { count usize length f64 } "
        );
        assert_eq!(layout::<first::Thing>(), layout::<again::Thing>());
        let all = [
            layout::<first::Thing>(),
            layout::<more::Thing>(),
            layout::<moved::Thing>(),
            layout::<called::Thing>(),
            layout::<typed::Thing>(),
            layout::<(usize, f64)>(),
        ];
        for (i, one) in all.iter().enumerate() {
            assert!(!all[..i].contains(one), "{one}");
        }
        // However deep it is.
        let deep = layout::<Vec<Option<Box<first::Thing>>>>();
        assert_ne!(deep, layout::<Vec<Option<Box<more::Thing>>>>());
    }

    #[test]
    fn a_layout_has_what_variants_carry_and_tells_each_type_once() {
        let name = "Name { One Both ( usize 2 of f64 ) Other }";
        assert_eq!(
            layout::<(Name, Vec<Name>, Some)>(),
            format!(
                "( {name} list Name Some {{ bits list u64 name option Name by list ( text ( usize bool ) ) all 3 of i32 }} ) "
            )
        );
    }
}

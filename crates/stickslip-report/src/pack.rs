//! Numbers as text that a browser unpacks: quantised, compressed by zlib, in base64.

use std::io::Write;

use crate::field;

/// What stands for a missing value.
pub const NO_NUMBER: i16 = i16::MIN;

/// Values over all times as whole numbers between -32767 and 32767: each is off by less than a 65534th of the range.
#[derive(Debug, Clone, PartialEq)]
pub struct Quantised {
    /// The smallest and the largest value; zero twice if there is none.
    pub range: [f64; 2],
    /// The numbers.
    pub values: Vec<i16>,
}

/// Makes whole numbers of values. What is no finite number becomes [`NO_NUMBER`].
pub fn quantise(values: &[f32]) -> Quantised {
    let range = field::range(values.iter().map(|&v| f64::from(v))).unwrap_or([0.0; 2]);
    let [low, high] = range;
    let number = |v: f32| -> i16 {
        if !v.is_finite() {
            return NO_NUMBER;
        }
        match high > low {
            true => (((f64::from(v) - low) / (high - low) * 65534.0).round() - 32767.0) as i16,
            false => 0,
        }
    };
    Quantised {
        range,
        values: values.iter().map(|&v| number(v)).collect(),
    }
}

/// Whole numbers as text: all low bytes, then all high bytes, which compress better apart.
pub fn shorts(values: &[i16]) -> String {
    let low = values.iter().map(|v| v.to_le_bytes()[0]);
    let high = values.iter().map(|v| v.to_le_bytes()[1]);
    packed(&low.chain(high).collect::<Vec<u8>>())
}

/// Single precision as text.
pub fn singles(values: impl Iterator<Item = f64>) -> String {
    let bytes: Vec<u8> = values.flat_map(|v| (v as f32).to_le_bytes()).collect();
    packed(&bytes)
}

/// Double precision as text.
pub fn doubles(values: impl Iterator<Item = f64>) -> String {
    let bytes: Vec<u8> = values.flat_map(f64::to_le_bytes).collect();
    packed(&bytes)
}

/// Indices as text.
pub fn indices(values: impl Iterator<Item = u32>) -> String {
    let bytes: Vec<u8> = values.flat_map(u32::to_le_bytes).collect();
    packed(&bytes)
}

/// Bytes as text.
pub fn packed(bytes: &[u8]) -> String {
    let mut encoder = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::default());
    let written = encoder.write_all(bytes).and_then(|()| encoder.finish());
    base64(&written.expect("writing to memory does not fail"))
}

/// Base64 (RFC 4648). Written here as nothing is ever decoded, and encoding is these few lines.
pub fn base64(bytes: &[u8]) -> String {
    const ALPHABET: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for three in bytes.chunks(3) {
        let byte = |i: usize| u32::from(three.get(i).copied().unwrap_or(0));
        let bits = byte(0) << 16 | byte(1) << 8 | byte(2);
        for i in 0..4 {
            let six = ALPHABET[(bits >> (18 - 6 * i)) as usize & 63];
            text.push(if i <= three.len() { six.into() } else { '=' });
        }
    }
    text
}

/// `count` of `of` positions, spread evenly, the first and the last among them.
pub fn spread(of: usize, count: usize) -> Vec<usize> {
    if count >= of {
        return (0..of).collect();
    }
    match count {
        0 => Vec::new(),
        1 => vec![of - 1],
        _ => (0..count)
            .map(|i| (i * (of - 1) + (count - 1) / 2) / (count - 1))
            .collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whole_numbers_are_near_the_values() {
        let values = [1.0, f32::NAN, 2.0, 3.5, f32::INFINITY, -4.0];
        let q = quantise(&values);
        assert_eq!(q.range, [-4.0, 3.5]);
        for (v, n) in values.iter().zip(&q.values) {
            if v.is_finite() {
                let back = -4.0 + 7.5 * (f64::from(*n) + 32767.0) / 65534.0;
                assert!((back - f64::from(*v)).abs() <= 7.5 / 65534.0);
            } else {
                assert_eq!(*n, NO_NUMBER);
            }
        }
        assert_eq!(q.values[5], -32767);
        assert_eq!(q.values[3], 32767);
        assert_eq!(quantise(&[5.0, 5.0]).values, [0, 0]);
        assert_eq!(quantise(&[]).range, [0.0, 0.0]);
    }

    #[test]
    fn base64_is_that_of_the_standard() {
        for (plain, text) in [
            ("", ""),
            ("f", "Zg=="),
            ("fo", "Zm8="),
            ("foob", "Zm9vYg=="),
        ] {
            assert_eq!(base64(plain.as_bytes()), text);
        }
    }

    #[test]
    fn what_is_kept_has_both_ends() {
        assert_eq!(spread(5, 9), [0, 1, 2, 3, 4]);
        assert_eq!(spread(100, 2), [0, 99]);
        assert_eq!(spread(7, 1), [6]);
        for count in 2..50 {
            let kept = spread(50, count);
            assert_eq!(kept.len(), count);
            assert_eq!((kept[0], kept[count - 1]), (0, 49));
            assert!(kept.is_sorted_by(|a, b| a < b));
        }
        assert!(spread(0, 3).is_empty());
    }
}

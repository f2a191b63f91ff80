//! Surface data files (ISO 25178-71, formerly EUNA 15178): a header and heights, as text or in binary.

use super::map::HeightMap;

/// How such files begin: as text, and in binary.
const SDF_BEGINNINGS: [&[u8]; 2] = [b"aISO-1.0", b"aBCR-1.0"];
const BINARY: [&[u8]; 2] = [b"bISO-1.0", b"bBCR-1.0"];

/// Bytes of a binary header.
const HEADER: usize = 81;

/// What a header says.
#[derive(Debug, Clone, Copy, Default)]
struct Header {
    points: usize,
    profiles: usize,
    /// Lengths of a step along rows, across them and in height `[m]`.
    scale: [f64; 3],
    kind: u8,
}

impl Header {
    fn map(self, heights: impl Iterator<Item = f64>) -> Result<HeightMap, String> {
        let [x, y, z] = self.scale;
        if !(x > 0.0 && z != 0.0 && z.is_finite() && (y > 0.0 || self.profiles == 1)) {
            return Err(format!("the header has the scales {x:e}, {y:e} and {z:e}"));
        }
        // So many that their number is none follow in no file.
        let wanted = self.points.saturating_mul(self.profiles);
        let heights: Vec<f64> = heights.take(wanted).map(|h| h * z).collect();
        if heights.len() < wanted || wanted == 0 {
            return Err(format!(
                "the header announces {} profiles of {} points, {} heights follow",
                self.profiles,
                self.points,
                heights.len()
            ));
        }
        Ok(HeightMap {
            columns: self.points,
            rows: self.profiles,
            spacing: [x, if self.profiles == 1 { x } else { y }],
            heights,
            repeat: false,
        })
    }
}

/// Reads such a file; `None` if it is none.
pub(super) fn read(bytes: &[u8]) -> Option<Result<HeightMap, String>> {
    if BINARY.iter().any(|begin| bytes.starts_with(begin)) {
        return Some(binary(bytes));
    }
    let begins = SDF_BEGINNINGS.iter().any(|begin| bytes.starts_with(begin));
    begins.then(|| text(&String::from_utf8_lossy(bytes)))
}

fn text(text: &str) -> Result<HeightMap, String> {
    // Parts are parted by lines with an asterisk.
    let mut parts = text.split('*');
    let mut header = Header::default();
    for (at, line) in parts.next().unwrap_or_default().lines().enumerate() {
        let Some((key, value)) = line.split_once('=') else {
            continue;
        };
        let value = value.trim();
        let wrong = || format!("line {}: `{}` is {value}", at + 1, key.trim());
        let number = || value.parse::<f64>().map_err(|_| wrong());
        let count = || value.parse::<usize>().map_err(|_| wrong());
        match key.trim().to_ascii_lowercase().as_str() {
            "numpoints" => header.points = count()?,
            "numprofiles" => header.profiles = count()?,
            "xscale" => header.scale[0] = number()?,
            "yscale" => header.scale[1] = number()?,
            "zscale" => header.scale[2] = number()?,
            _ => {}
        }
    }
    let words = parts.next().unwrap_or_default().split_whitespace();
    let mut heights = Vec::new();
    for word in words {
        // Points that were not measured.
        let height = match word.to_ascii_uppercase().as_str() {
            "BAD" | "INV" => f64::NAN,
            _ => word
                .parse()
                .map_err(|_| format!("a height is {word:.20}"))?,
        };
        heights.push(height);
    }
    header.map(heights.into_iter())
}

fn binary(bytes: &[u8]) -> Result<HeightMap, String> {
    let Some((header, data)) = bytes.split_at_checked(HEADER) else {
        return Err("it ends within its header".into());
    };
    // Eight bytes of version, ten of the maker, twice twelve of dates.
    let short = |at: usize| usize::from(u16::from_le_bytes([header[at], header[at + 1]]));
    let double = |at: usize| {
        let mut eight = [0; 8];
        eight.copy_from_slice(&header[at..at + 8]);
        f64::from_le_bytes(eight)
    };
    let header = Header {
        points: short(42),
        profiles: short(44),
        scale: [double(46), double(54), double(62)],
        kind: header[79],
    };
    // The least of all whole numbers stands for a point that was not measured.
    match header.kind {
        5 => header.map(
            data.as_chunks()
                .0
                .iter()
                .map(|&b| match i16::from_le_bytes(b) {
                    i16::MIN => f64::NAN,
                    h => f64::from(h),
                }),
        ),
        6 => header.map(
            data.as_chunks()
                .0
                .iter()
                .map(|&b| match i32::from_le_bytes(b) {
                    i32::MIN => f64::NAN,
                    h => f64::from(h),
                }),
        ),
        3 => header.map(
            data.as_chunks()
                .0
                .iter()
                .map(|&b| f64::from(f32::from_le_bytes(b))),
        ),
        7 => header.map(data.as_chunks().0.iter().map(|&b| f64::from_le_bytes(b))),
        kind => Err(format!(
            "its heights are numbers of kind {kind}; those read are 3, 5, 6 and 7 (float, 16 and 32 bits, double)"
        )),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ASCII: &str = "aISO-1.0\nManufacID = x\nNumPoints = 3\nNumProfiles = 2\nXscale = 1e-6\nYscale = 2E-6\nZscale = 1e-9\nCompression = 0\nDataType = 5\nCheckType = 0\n*\n10 20 30\n40 BAD 60\n*\n";

    fn bytes(kind: u8, data: &[u8]) -> Vec<u8> {
        let mut out = b"bISO-1.0".to_vec();
        out.resize(42, b' ');
        out.extend(3u16.to_le_bytes());
        out.extend(2u16.to_le_bytes());
        for scale in [1e-6, 2e-6, 1e-9, -1.0_f64] {
            out.extend(scale.to_le_bytes());
        }
        out.extend([0, kind, 0]);
        assert_eq!(out.len(), HEADER);
        out.extend(data);
        out
    }

    #[test]
    fn text_and_binary_say_the_same() {
        let of_text = read(ASCII.as_bytes()).expect("one").expect("sound");
        assert_eq!((of_text.columns, of_text.rows), (3, 2));
        assert_eq!(of_text.spacing, [1e-6, 2e-6]);
        let whole = [10, 20, 30, 40, i16::MIN, 60];
        let short: Vec<u8> = whole.iter().flat_map(|v| v.to_le_bytes()).collect();
        let double = whole.map(|v| {
            if v == i16::MIN {
                f64::NAN
            } else {
                f64::from(v)
            }
        });
        let double: Vec<u8> = double.iter().flat_map(|v| v.to_le_bytes()).collect();
        for (kind, data) in [(5, short), (7, double)] {
            let map = read(&bytes(kind, &data)).expect("one").expect("sound");
            for (a, b) in map.heights.iter().zip(&of_text.heights) {
                assert!(
                    (a - b).abs() < 1e-24 || (a.is_nan() && b.is_nan()),
                    "{a} {b}"
                );
            }
        }
        assert!(read(b"1,2,3").is_none());
    }

    #[test]
    fn what_is_cut_off_or_unknown_is_said() {
        let says = |bytes: &[u8]| read(bytes).expect("one").expect_err("not sound");
        assert!(says(b"bISO-1.0").contains("header"));
        assert!(says(&bytes(5, &[0; 8])).contains("4 heights follow"));
        assert!(says(&bytes(9, &[0; 80])).contains("kind 9"));
        let cut = ASCII.replace("40 BAD 60", "");
        assert!(says(cut.as_bytes()).contains("3 heights follow"));
        let wrong = ASCII.replace("NumPoints = 3", "NumPoints = many");
        assert!(says(wrong.as_bytes()).contains("line 3"));
        assert!(says(ASCII.replace("Zscale = 1e-9", "").as_bytes()).contains("scales"));
    }
}

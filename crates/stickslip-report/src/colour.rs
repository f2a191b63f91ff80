//! Colours of numbers and of the status of contact.

/// Red, green, blue.
pub type Rgb = [u8; 3];

/// From low to high: anchors of *viridis* (Smith and van der Walt, CC0), which grows in lightness and is told apart by people who
/// are colour-blind.
pub const ORDERED: &[Rgb] = &[
    [68, 1, 84],
    [71, 45, 123],
    [59, 82, 139],
    [44, 114, 142],
    [33, 145, 140],
    [40, 174, 128],
    [94, 201, 98],
    [173, 220, 48],
    [253, 231, 37],
];

/// From nothing to much, for what surfaces carry: pale where nothing is, so that the spot that carries stands out on a body that is lit. *magma* (Smith and van
/// der Walt, CC0) backwards, which darkens all the way and is told apart by people who are colour-blind.
pub const CARRIED: &[Rgb] = &[
    [247, 246, 240],
    [253, 231, 170],
    [254, 202, 141],
    [253, 150, 104],
    [241, 96, 93],
    [205, 63, 113],
    [158, 47, 127],
    [113, 31, 129],
    [68, 15, 118],
];

/// From negative over zero to positive: blue, light grey, red.
pub const SIGNED: &[Rgb] = &[
    [33, 74, 147],
    [67, 118, 183],
    [122, 165, 208],
    [178, 205, 225],
    [232, 232, 229],
    [240, 196, 172],
    [222, 141, 108],
    [194, 84, 66],
    [148, 23, 42],
];

/// Where there is no value.
pub const NOTHING: Rgb = [196, 200, 206];

/// The status of contact: name and colour, by its number. Blue, vermilion and green of the palette of Okabe and Ito, and a yellow that is
/// pale, as most of a surface is open. Tied surfaces have no status in files: they neither stick nor slip.
pub const STATUSES: [(&str, Rgb); 4] = [
    ("open", [243, 229, 150]),
    ("stick", [0, 114, 178]),
    ("slip", [213, 94, 0]),
    ("tied", [0, 158, 115]),
];

/// The number of what is tied.
pub const TIED: usize = 3;

/// The colour at `t` between 0 and 1 along a list of anchors.
pub fn along(anchors: &[Rgb], t: f64) -> Rgb {
    if t.is_nan() {
        return NOTHING;
    }
    let last = anchors.len() - 1;
    let x = t.clamp(0.0, 1.0) * last as f64;
    let i = (x as usize).min(last - 1);
    let f = x - i as f64;
    let mix = |c: usize| {
        let (a, b) = (f64::from(anchors[i][c]), f64::from(anchors[i + 1][c]));
        (a + f * (b - a)).round() as u8
    };
    [mix(0), mix(1), mix(2)]
}

/// The colour of a value: by its place in a range, along one of the two lists.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Scale {
    /// What the ends of the list stand for.
    pub range: [f64; 2],
    /// Whether zero is in the middle.
    pub signed: bool,
    /// Whether the numbers are the status of contact.
    pub status: bool,
    /// Whether they are what a surface carries, from zero.
    pub carried: bool,
    /// How many colours there are; as many as there are values if not given.
    pub bands: Option<u32>,
    /// What is below is drawn as nothing.
    pub threshold: Option<f64>,
}

impl Scale {
    /// The list of anchors.
    pub fn anchors(&self) -> &'static [Rgb] {
        match (self.signed, self.carried) {
            (true, _) => SIGNED,
            (_, true) => CARRIED,
            _ => ORDERED,
        }
    }

    /// Whether a value is drawn as nothing.
    pub fn nothing(&self, value: f64) -> bool {
        value.is_nan() || self.threshold.is_some_and(|low| value < low)
    }

    /// The colour of a value.
    pub fn colour(&self, value: f64) -> Rgb {
        if self.nothing(value) {
            return NOTHING;
        }
        if self.status {
            return STATUSES[value.round().clamp(0.0, TIED as f64) as usize].1;
        }
        let width = self.range[1] - self.range[0];
        let t = match width > 0.0 {
            true => (value - self.range[0]) / width,
            false => 0.5,
        };
        // A band has the colour of its middle, the first and the last those of the ends.
        let t = match self.bands.map(f64::from) {
            Some(n) if n > 1.0 => (t.clamp(0.0, 1.0) * n).floor().min(n - 1.0) / (n - 1.0),
            Some(_) => 0.5,
            None => t,
        };
        along(self.anchors(), t)
    }
}

/// As in HTML and SVG: `#1a2b3c`.
pub fn hex([r, g, b]: Rgb) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_go_from_end_to_end() {
        assert_eq!(along(ORDERED, 0.0), ORDERED[0]);
        assert_eq!(along(ORDERED, 1.0), ORDERED[8]);
        assert_eq!(along(ORDERED, 7.0), ORDERED[8]);
        assert_eq!(along(SIGNED, 0.5), SIGNED[4]);
        assert_eq!(along(SIGNED, f64::NAN), NOTHING);
        let scale = Scale {
            range: [1.0, 1.0],
            ..Scale::default()
        };
        assert_eq!(scale.colour(1.0), ORDERED[4]);
        assert_eq!(hex([1, 160, 255]), "#01a0ff");
    }

    #[test]
    fn bands_have_one_colour_each_and_what_is_below_the_threshold_has_none() {
        let scale = Scale {
            range: [0.0, 8.0],
            bands: Some(4),
            threshold: Some(1.0),
            ..Scale::default()
        };
        let colours: Vec<Rgb> = (0..80).map(|i| scale.colour(f64::from(i) / 10.0)).collect();
        assert!(colours[..10].iter().all(|c| *c == NOTHING));
        for (band, colour) in [(10..20, ORDERED[0]), (60..80, ORDERED[8])] {
            assert!(colours[band].iter().all(|c| *c == colour));
        }
        let mut different = colours[10..].to_vec();
        different.dedup();
        assert_eq!(different.len(), 4);
        assert_eq!(scale.colour(100.0), ORDERED[8]);
    }

    #[test]
    fn lightness_grows_along_the_ordered_list() {
        let light = |c: &Rgb| 2 * u32::from(c[0]) + 7 * u32::from(c[1]) + u32::from(c[2]);
        assert!(ORDERED.is_sorted_by_key(light));
        assert!(CARRIED.is_sorted_by(|a, b| light(a) > light(b)));
    }
}

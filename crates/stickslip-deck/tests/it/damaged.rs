//! Decks that were damaged: findings or a problem, and no panic. `cargo xtask walk` damages more of them.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

/// The same numbers each time.
struct Dice(u64);

impl Dice {
    /// Below a count.
    fn below(&mut self, count: usize) -> usize {
        // Marsaglia's xorshift.
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 % count.max(1) as u64) as usize
    }
}

/// What a field of a card may have become.
const FIELDS: [&str; 8] = [
    "nan",
    "-1",
    "1e300",
    "99999999999",
    "",
    "*NODE",
    "\u{1b}[2J",
    "=",
];

/// A deck of which a line is gone, doubled or moved, or a field another.
fn damaged(text: &str, dice: &mut Dice) -> String {
    let mut lines: Vec<String> = text.lines().map(str::to_string).collect();
    if lines.is_empty() {
        return String::new();
    }
    for _ in 0..1 + dice.below(2) {
        let at = dice.below(lines.len());
        match dice.below(4) {
            0 if lines.len() > 1 => drop(lines.remove(at)),
            1 => {
                let line = lines[at].clone();
                let to = dice.below(lines.len());
                lines.insert(to, line);
            }
            _ => {
                let mut fields: Vec<&str> = lines[at].split(',').collect();
                let k = dice.below(fields.len());
                fields[k] = FIELDS[dice.below(FIELDS.len())];
                lines[at] = fields.join(",");
            }
        }
    }
    lines.join("\n")
}

fn read(bytes: &[u8]) {
    let path = Path::new("a.inp");
    let translated =
        stickslip_deck::parse(bytes, path).and_then(|deck| stickslip_deck::translate(&deck, path));
    let Ok(translation) = translated else {
        return;
    };
    if let Ok(problem) = translation.document(Vec::new()).problem() {
        let _ = problem.build_with(Path::new("."), &translation.meshes());
    }
}

#[test]
fn damaged_decks_make_no_panic() {
    let mut broken = Vec::new();
    for folder in ["tests/jobs", "tests/malformed"] {
        let entries = std::fs::read_dir(folder).expect("a folder");
        let mut paths: Vec<_> = entries.map(|e| e.expect("an entry").path()).collect();
        paths.retain(|path| path.extension().is_some_and(|e| e == "inp"));
        paths.sort();
        for (k, path) in paths.iter().enumerate() {
            let bytes = std::fs::read(path).expect("a deck");
            let text = String::from_utf8_lossy(&bytes);
            // Large ones take long.
            if text.len() > 20_000 || text.to_ascii_lowercase().contains("include") {
                continue;
            }
            for i in 1..=3 {
                let seed = (k as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ i;
                let deck = damaged(&text, &mut Dice(seed));
                if catch_unwind(AssertUnwindSafe(|| read(deck.as_bytes()))).is_err() {
                    broken.push(format!("{}, damage {i}", path.display()));
                }
            }
        }
    }
    assert!(broken.is_empty(), "panics: {broken:#?}");
}

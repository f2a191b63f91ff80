//! Random problems, the same for a seed for ever: bodies, laws, ways to evaluate contact, paths and motions.

mod body;
mod draft;
mod law;
mod moving;
mod obstacle;
mod options;
mod pair;
mod path;
mod random;
mod scene;
mod sprung;
mod stack;

pub use draft::Draft;
pub use random::{Random, digits};

/// The families, of which one problem after the other is drawn.
pub const FAMILIES: [&str; 6] = [
    "pair", "obstacle", "stack", "springs", "implicit", "explicit",
];

/// The problem with a number of the series of a seed.
pub fn problem(seed: u64, number: u64) -> Draft {
    let random = &mut Random::new(number.wrapping_add(seed.wrapping_mul(0x1000_0000)));
    let mut draft = match number % 10 {
        0..=2 => pair::draw(random),
        3..=4 => obstacle::draw(random),
        5 => stack::draw(random),
        6 => sprung::draw(random),
        7 | 8 => moving::draw(random, false),
        _ => moving::draw(random, true),
    };
    draft.text = draft.text.replace(
        "@TITLE",
        &format!("Random problem {number} of series {seed}"),
    );
    draft
}

#[cfg(test)]
mod tests {
    use super::{FAMILIES, problem};

    #[test]
    fn a_number_is_one_problem_and_all_families_come() {
        let mut seen = std::collections::BTreeSet::new();
        for number in 1..=60 {
            let once = problem(1, number);
            assert_eq!(once, problem(1, number));
            assert!(!once.text.contains("NaN") && !once.text.contains("inf"));
            assert!(!once.text.contains('@'));
            seen.insert(once.family);
        }
        assert_eq!(seen.len(), FAMILIES.len());
        assert_ne!(problem(1, 1).text, problem(2, 1).text);
    }
}

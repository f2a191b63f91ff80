//! Names of the deck as names of the problem.

/// A name of the deck as one of the problem: a point would separate a body from a set.
pub(super) fn problem_name(label: &str) -> String {
    let plain = |c: char| match c {
        '.' | '"' | '\\' => '-',
        c if c.is_control() => '-',
        c => c,
    };
    label.chars().map(plain).collect()
}

//! What single words of a deck mean: names, numbers.

/// Capitals without blanks.
pub(crate) fn squeeze(text: &str) -> String {
    let kept = text.chars().filter(|c| !c.is_whitespace());
    kept.collect::<String>().to_uppercase()
}

/// A name of the user's: quotes keep blanks and case.
pub(crate) fn label(text: &str) -> String {
    if !text.contains('"') {
        return squeeze(text);
    }
    // An instance and its set can be quoted each for itself.
    let pieces = text.trim().split('"').enumerate();
    let kept = pieces.map(|(i, piece)| match i % 2 {
        0 => squeeze(piece),
        _ => piece.to_string(),
    });
    kept.collect()
}

/// A number as Fortran reads it: `1.D5` is 1e5.
pub(crate) fn number(text: &str) -> Option<f64> {
    let mut text = text.trim().replace(['d', 'D'], "e");
    // Rust reads words as numbers that decks must not contain.
    let plain = text
        .bytes()
        .all(|b| b.is_ascii_digit() || b"+-.eE".contains(&b));
    if !plain {
        return None;
    }
    // `1.5+3`: Fortran leaves the letter out where the exponent is long, and reads it so.
    if !text.contains(['e', 'E'])
        && let Some(at) = text.char_indices().skip(1).find(|(_, c)| "+-".contains(*c))
    {
        text.insert(at.0, 'e');
    }
    text.parse().ok().filter(|v: &f64| v.is_finite())
}

pub(crate) fn whole(text: &str) -> Option<u64> {
    let text = text.trim();
    // A few programs write node numbers with a point.
    let digits = text.strip_suffix('.').unwrap_or(text);
    digits
        .parse()
        .ok()
        .filter(|n| (1..=u64::from(u32::MAX)).contains(n))
}

/// A text that is short enough for a message.
pub(crate) fn clip(text: &str) -> String {
    match text.char_indices().nth(40) {
        Some((at, _)) => format!("{}...", &text[..at]),
        None => text.to_string(),
    }
}

//! Documentation comments as text for people who do not read Rust.

/// `[text](target)` and `` [`text`](target) `` become `text`, and units, which rustdoc wants as code, lose their
/// backticks; everything else stays.
#[cfg(any(test, feature = "schema"))]
pub(super) fn without_links(text: &str) -> String {
    let code = |(i, part): (usize, &str)| match i % 2 == 0
        || part.starts_with('[') && part.ends_with(']')
    {
        true => part.to_string(),
        false => format!("`{part}`"),
    };
    let text: String = text.split('`').enumerate().map(code).collect();
    let mut out = String::new();
    let mut rest = text.as_str();
    while let Some(middle) = rest.find("](") {
        let (before, after) = (&rest[..middle], &rest[middle + 2..]);
        match (before.rfind('['), after.find(')')) {
            (Some(open), Some(close)) => {
                out += &before[..open];
                out += before[open + 1..].trim_matches('`');
                rest = &after[close + 1..];
            }
            _ => {
                out += &rest[..middle + 2];
                rest = after;
            }
        }
    }
    out + rest
}

/// The first sentence of the first paragraph, in one line, without its full stop.
pub(super) fn first_sentence(text: &str) -> String {
    let paragraph = text.split("\n\n").next().unwrap_or(text);
    let line = paragraph.split_whitespace().collect::<Vec<_>>().join(" ");
    let ends = |&(i, _): &(usize, &str)| {
        let abbreviated = [" eq", " al", "e.g", "i.e"];
        let goes_on = line[i + 2..].starts_with(|c: char| !c.is_uppercase());
        !goes_on && !abbreviated.iter().any(|a| line[..i].ends_with(a))
    };
    let end = line.match_indices(". ").find(ends).map(|(i, _)| i);
    line[..end.unwrap_or(line.len())]
        .trim_end_matches('.')
        .to_string()
}

#[cfg(test)]
mod tests {
    use super::{first_sentence, without_links};

    #[test]
    fn links_become_their_text() {
        assert_eq!(
            without_links("A [law](crate::x) `[m]` of [`y`](crate::y), `z = [1]`, entry [1](2"),
            "A law [m] of y, `z = [1]`, entry [1](2"
        );
        assert_eq!(without_links("a_[i] and (b)"), "a_[i] and (b)");
    }

    #[test]
    fn abbreviations_do_not_end_sentences() {
        assert_eq!(
            first_sentence("As in Pop, eq. (2),\nby Zavarise et al. 1992. More.\n\nRest."),
            "As in Pop, eq. (2), by Zavarise et al. 1992"
        );
        assert_eq!(first_sentence("One."), "One");
        assert_eq!(first_sentence(""), "");
    }
}

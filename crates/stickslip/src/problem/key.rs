//! Paths of keys, as people write them: `interface.base.friction`, `set."a b".of`, `step.1.duration`. Entries of lists are counted from 1.

/// The segment of an entry of a list.
pub(super) fn entry(index: usize) -> String {
    (index + 1).to_string()
}

/// The index of an entry of a list.
pub(super) fn index(segment: &str) -> Option<usize> {
    segment.parse::<usize>().ok()?.checked_sub(1)
}

/// Splits the path of a key into its segments. Segments with other characters than letters, digits, `-` and `_` are
/// quoted, with `"` or `'`; there are no escapes.
pub(super) fn parse(path: &str) -> Result<Vec<String>, String> {
    let mut segments = Vec::new();
    let mut rest = path.trim();
    loop {
        let (segment, after) = match rest.chars().next() {
            Some(quote @ ('"' | '\'')) => rest[1..]
                .split_once(quote)
                .ok_or_else(|| format!("the quote {quote} in `{path}` is not closed"))?,
            _ => rest.split_at(rest.find('.').unwrap_or(rest.len())),
        };
        let quoted = rest.starts_with(['"', '\'']);
        let segment = if quoted { segment } else { segment.trim() };
        if !quoted && !is_bare(segment) {
            return Err(match segment {
                "" => format!("`{path}` has an empty part"),
                _ => format!(
                    "`{segment}` in `{path}` is no key: entries of lists are counted from 1 or called by their name (`step.2`, `step.press`), other signs need quotes"
                ),
            });
        }
        segments.push(segment.to_string());
        let after = after.trim_start();
        if after.is_empty() {
            return Ok(segments);
        }
        rest = after
            .strip_prefix('.')
            .ok_or_else(|| format!("a dot is missing after `{segment}` in `{path}`"))?
            .trim_start();
    }
}

/// Joins segments to a path that [`parse`] splits again.
pub(super) fn join<S: AsRef<str>>(segments: &[S]) -> String {
    let quoted: Vec<String> = segments
        .iter()
        .map(|s| match s.as_ref() {
            s if is_bare(s) => s.to_string(),
            s if s.contains('"') => format!("'{s}'"),
            s => format!("\"{s}\""),
        })
        .collect();
    quoted.join(".")
}

fn is_bare(segment: &str) -> bool {
    let allowed = |c: char| c.is_ascii_alphanumeric() || c == '-' || c == '_';
    !segment.is_empty() && segment.chars().all(allowed)
}

#[cfg(test)]
mod tests {
    use super::{join, parse};

    #[test]
    fn quoted_parts_survive() {
        for path in ["a", "a.b-c.0", "set.\"a b\".of", "set.'a\"b'.of"] {
            assert_eq!(join(&parse(path).unwrap()), path);
        }
        assert_eq!(parse(" a . \"b.c\" ").unwrap(), ["a", "b.c"]);
    }

    #[test]
    fn refuses_what_is_no_path() {
        for path in ["", "a..b", "a.", "a b", "\"a", "\"a\"b"] {
            assert!(parse(path).is_err(), "{path}");
        }
    }
}

//! The text of an axis: `path=v1,v2,...`, where each `v` is a TOML value or a range `from..to:count`.

/// Most runs of a sweep: more are a mistake in a range, or a matter for several sweeps.
pub const MOST_RUNS: usize = 100_000;

/// A key of the problem file and the values it takes.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Axis {
    /// The key, as it was written.
    pub path: String,
    /// The values as TOML. Whether they are, is found when they are put into the problem file.
    pub values: Vec<String>,
}

/// Reads `path=v1,v2,...`.
///
/// # Errors
/// What is wrong, in a sentence that says where.
pub fn axis(text: &str) -> Result<Axis, String> {
    let (path, list) = split(text)?;
    let mut values = Vec::new();
    for item in items(list).map_err(|message| format!("`{text}`: {message}"))? {
        if item.is_empty() {
            return Err(format!(
                "`{text}`: value {} is empty; an empty string is \"\"",
                values.len() + 1
            ));
        }
        if is_range(item) {
            values.extend(range(item).map_err(|message| format!("range `{item}`: {message}"))?);
        } else {
            values.push(item.to_string());
        }
    }
    Ok(Axis {
        path: path.to_string(),
        values,
    })
}

/// Path and value, on both sides of the first `=` outside quotes.
///
/// # Errors
/// If there is no `=`, or nothing before it.
pub fn split(text: &str) -> Result<(&str, &str), String> {
    let mut quote = None;
    for (i, letter) in text.char_indices() {
        match (quote, letter) {
            (None, '=') if !text[..i].trim().is_empty() => {
                return Ok((text[..i].trim(), text[i + 1..].trim()));
            }
            (None, '=') => return Err(format!("`{text}` has no path before the `=`")),
            (None, '"' | '\'') => quote = Some(letter),
            (Some(q), letter) if q == letter => quote = None,
            _ => {}
        }
    }
    Err(format!("`{text}` has no `=`"))
}

/// The parts of a list between commas, but not those within strings, brackets or braces.
fn items(text: &str) -> Result<Vec<&str>, String> {
    let mut all = Vec::new();
    let mut open: Vec<char> = Vec::new();
    let (mut start, mut at) = (0, 0);
    while let Some(letter) = text[at..].chars().next() {
        match letter {
            '"' | '\'' => {
                at += string(&text[at..])
                    .ok_or_else(|| format!("the quote in `{}` is not closed", &text[at..]))?;
                continue;
            }
            '[' | '{' => open.push(letter),
            ']' | '}' => {
                let begin = if letter == ']' { '[' } else { '{' };
                if open.pop() != Some(begin) {
                    return Err(format!("a `{letter}` has no `{begin}` before it"));
                }
            }
            ',' if open.is_empty() => {
                all.push(text[start..at].trim());
                start = at + 1;
            }
            _ => {}
        }
        at += letter.len_utf8();
    }
    match open.last() {
        Some(letter) => Err(format!("a `{letter}` is not closed")),
        None => {
            all.push(text[start..].trim());
            Ok(all)
        }
    }
}

/// Bytes of the TOML string with which `text` begins; `None` if it does not end.
fn string(text: &str) -> Option<usize> {
    let marks = ["\"\"\"", "'''", "\"", "'"];
    let mark = marks.into_iter().find(|mark| text.starts_with(mark))?;
    let mut at = mark.len();
    loop {
        let rest = &text[at..];
        if rest.starts_with(mark) {
            return Some(at + mark.len());
        }
        let mut letters = rest.chars();
        let letter = letters.next()?;
        at += letter.len_utf8();
        // Only strings in double quotes have escapes.
        if letter == '\\' && mark.starts_with('"') {
            at += letters.next()?.len_utf8();
        }
    }
}

/// Dots that no TOML value has outside strings, and no number. A path of a file may have them.
fn is_range(item: &str) -> bool {
    item.contains("..") && !item.contains(['/', '\\']) && !item.starts_with(['"', '\'', '[', '{'])
}

/// The values of `from..to:count`, both ends included. They are whole numbers if the ends are written so and all
/// between them are whole; keys that take numbers of any kind take those too.
fn range(item: &str) -> Result<Vec<String>, String> {
    const RANGE_FORM: &str = "write from..to:count, for example 0.1..0.5:50";
    let (from, rest) = item.split_once("..").ok_or(RANGE_FORM)?;
    let (to, count) = rest
        .split_once(':')
        .ok_or_else(|| format!("it does not say how many values; {RANGE_FORM}"))?;
    let ends = (number(from)?, number(to)?);
    let count = match count.trim().parse::<usize>() {
        Ok(count) if (2..=MOST_RUNS).contains(&count) => count,
        Ok(_) => return Err(format!("it needs 2 to {MOST_RUNS} values")),
        Err(_) => {
            return Err(format!(
                "`{}` is not a number of values; {RANGE_FORM}",
                count.trim()
            ));
        }
    };
    if ends.0 == ends.1 {
        return Err("its ends are equal".into());
    }
    let parts = count - 1;
    if let (Ok(first), Ok(last)) = (from.trim().parse::<i32>(), to.trim().parse::<i32>()) {
        let (first, length) = (i64::from(first), i64::from(last) - i64::from(first));
        // `parts` is below MOST_RUNS.
        let parts = parts as i64;
        if length % parts == 0 {
            let value = |i: i64| (first + length / parts * i).to_string();
            return Ok((0..=parts).map(value).collect());
        }
    }
    // Weighing the ends gives them exactly, and rounds once where they are whole.
    let value = |i: usize| (ends.0 * (parts - i) as f64 + ends.1 * i as f64) / parts as f64;
    let values: Vec<f64> = (0..count)
        .map(|i| match i {
            0 => ends.0,
            i if i == parts => ends.1,
            i => value(i),
        })
        .collect();
    if values.iter().any(|x| !x.is_finite()) {
        return Err("its ends are too large".into());
    }
    // In the shortest form that reads back to the same bits; always with a point or exponent, as TOML wants it.
    Ok(values.iter().map(|x| format!("{x:?}")).collect())
}

/// An end of a range.
fn number(text: &str) -> Result<f64, String> {
    let text = text.trim();
    let bare = text.strip_prefix(['+', '-']).unwrap_or(text);
    let digit = |c: char| c.is_ascii_digit();
    // `parse` takes `.5`, `5.` and `inf` as well; here they are more likely mistakes.
    if bare.starts_with(digit)
        && bare.ends_with(digit)
        && let Ok(value) = text.parse::<f64>()
        && value.is_finite()
    {
        return Ok(value);
    }
    Err(match text {
        "" => "an end is missing".into(),
        _ => format!("`{text}` is not a number"),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn values(text: &str) -> Vec<String> {
        axis(&format!("a={text}")).unwrap().values
    }

    fn message(text: &str) -> String {
        axis(text).unwrap_err()
    }

    #[test]
    fn commas_split_values_but_not_what_is_inside_them() {
        assert_eq!(values("1, 2 ,3"), ["1", "2", "3"]);
        assert_eq!(values("[1,2,3],[4, [5,6]]"), ["[1,2,3]", "[4, [5,6]]"]);
        assert_eq!(
            values("{ x = 1, y = [2,3] },{}"),
            ["{ x = 1, y = [2,3] }", "{}"]
        );
        assert_eq!(
            values(r#""a,b",'c,"d','e',plane-strain"#),
            [r#""a,b""#, r#"'c,"d'"#, "'e'", "plane-strain"]
        );
        assert_eq!(values(r#""a\",b",2"#), [r#""a\",b""#, "2"]);
        assert_eq!(values(r#"'a\',2"#), [r"'a\'", "2"]);
        assert_eq!(values("\"\",''"), ["\"\"", "''"]);
        assert_eq!(values("'''a',b''',\"\""), ["'''a',b'''", "\"\""]);
        assert_eq!(values("\"ü,ß\",ä"), ["\"ü,ß\"", "ä"]);
    }

    #[test]
    fn the_first_equals_sign_outside_quotes_ends_the_path() {
        let axis = axis(" set.'a=b'.of = {x=1},{x=2}").unwrap();
        assert_eq!(axis.path, "set.'a=b'.of");
        assert_eq!(axis.values, ["{x=1}", "{x=2}"]);
    }

    #[test]
    fn a_range_includes_its_ends_exactly() {
        let fine = values("0.1..0.5:50");
        assert_eq!(fine.len(), 50);
        assert_eq!((fine[0].as_str(), fine[49].as_str()), ("0.1", "0.5"));
        let numbers: Vec<f64> = fine.iter().map(|x| x.parse().unwrap()).collect();
        for (i, x) in numbers.iter().enumerate() {
            assert!((x - (0.1 + 0.4 * i as f64 / 49.0)).abs() < 1e-15);
        }
        assert_eq!(values("0..1:5"), ["0.0", "0.25", "0.5", "0.75", "1.0"]);
        assert_eq!(values("-1e-5..1e-5:3"), ["-1e-5", "0.0", "1e-5"]);
        assert_eq!(values("2..-2:3"), ["2", "0", "-2"]);
        assert_eq!(values("10..50:5,70"), ["10", "20", "30", "40", "50", "70"]);
        // one rounding each: what people would write
        assert_eq!(values("0..1:11")[3], "0.3");
    }

    #[test]
    fn a_path_or_a_string_with_dots_is_no_range() {
        assert_eq!(values("meshes/../a.msh"), ["meshes/../a.msh"]);
        assert_eq!(values("\"0..1:2\",'..'"), ["\"0..1:2\"", "'..'"]);
    }

    #[test]
    fn what_is_malformed_is_refused_with_its_reason() {
        for (text, reason) in [
            ("mu", "`mu` has no `=`"),
            ("=1", "has no path"),
            ("a=", "value 1 is empty"),
            ("a=1,,2", "value 2 is empty"),
            ("a=1,", "value 2 is empty"),
            ("a=[1,2", "a `[` is not closed"),
            ("a={x=[1}", "a `}` has no `{`"),
            ("a=1]", "a `]` has no `[`"),
            ("a=\"b,c", "is not closed"),
            ("a=0.1..0.5", "does not say how many"),
            ("a=0.1..0.5:", "`` is not a number of values"),
            ("a=0.1..0.5:x", "`x` is not a number of values"),
            ("a=0.1..0.5:-3", "`-3` is not a number of values"),
            ("a=0.1..0.5:1", "needs 2 to"),
            ("a=0.1..0.5:1000000000", "needs 2 to"),
            ("a=0.1...5:3", "`.5` is not a number"),
            ("a=..0.5:3", "an end is missing"),
            ("a=0.1..:3", "an end is missing"),
            ("a=x..y:3", "`x` is not a number"),
            ("a=0..inf:3", "`inf` is not a number"),
            ("a=1..1.0:3", "its ends are equal"),
            ("a=-1e308..1e308:12345", "its ends are too large"),
        ] {
            assert!(message(text).contains(reason), "{text}: {}", message(text));
        }
    }
}

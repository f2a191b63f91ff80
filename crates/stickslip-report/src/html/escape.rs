//! Text of users inside a page: it must never become part of the page itself.

use serde_json::Value;

/// As text between tags or within quotes of an attribute.
pub fn text(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&#39;"),
            // Other control characters are not allowed in a page.
            '\t' | '\n' => out.push(c),
            c if c.is_control() => out.push('\u{fffd}'),
            c => out.push(c),
        }
    }
    out
}

/// JSON within `<script>`: a browser looks for `</script` and `<!--` whatever quotes are around.
pub fn json(value: &Value) -> String {
    value
        .to_string()
        .replace('<', "\\u003c")
        .replace('>', "\\u003e")
        .replace('&', "\\u0026")
        .replace('\u{2028}', "\\u2028")
        .replace('\u{2029}', "\\u2029")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_gets_out_of_its_place() {
        let evil = "</script><b title=\"x\" a='y'>&amp;\u{0}<!--";
        let shown = text(evil);
        assert!(!shown.contains(['<', '>', '"', '\'', '\u{0}']), "{shown}");
        assert!(shown.contains("&amp;amp;"));
        let value = Value::from(evil);
        let script = json(&value);
        assert!(!script.contains(['<', '>', '&']));
        assert_eq!(serde_json::from_str::<Value>(&script).unwrap(), value);
    }
}

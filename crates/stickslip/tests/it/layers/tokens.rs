//! Rust source as far as imports need it: words and signs with their lines, without comments, strings and what is compiled for tests only.

/// A word or a sign of the code.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Token {
    /// A name, `::`, or one other character.
    pub text: String,
    /// Line, from 1.
    pub line: usize,
}

impl Token {
    /// Whether it is a name or a keyword.
    pub fn is_word(&self) -> bool {
        self.text
            .starts_with(|c: char| c.is_alphabetic() || c == '_')
    }
}

/// The tokens of a file, and the names of the modules that it declares for tests only.
pub fn tokens(text: &str) -> (Vec<Token>, Vec<String>) {
    without_tests(lex(text))
}

/// All tokens. Comments and literals are left out; a string leaves a `"`, so that what stands before and after it does not meet.
fn lex(text: &str) -> Vec<Token> {
    let c: Vec<char> = text.chars().collect();
    let (mut out, mut at, mut line) = (Vec::new(), 0, 1);
    while at < c.len() {
        let (length, token) = match c[at] {
            '/' if c.get(at + 1) == Some(&'/') => (until(&c, at, '\n'), None),
            '/' if c.get(at + 1) == Some(&'*') => (comment(&c, at), None),
            '"' => (string(&c, at), Some("\"".to_string())),
            '\'' => (quoted(&c, at), None),
            'r' | 'b' | 'c' if raw(&c, at).is_some() => {
                (raw(&c, at).unwrap_or(1), Some("\"".to_string()))
            }
            w if w.is_alphanumeric() || w == '_' => {
                let word: String = c[at..]
                    .iter()
                    .take_while(|w| w.is_alphanumeric() || **w == '_')
                    .collect();
                (word.chars().count(), Some(word))
            }
            ':' if c.get(at + 1) == Some(&':') => (2, Some("::".to_string())),
            w if w.is_whitespace() => (1, None),
            w => (1, Some(w.to_string())),
        };
        out.extend(token.map(|text| Token { text, line }));
        line += c[at..(at + length).min(c.len())]
            .iter()
            .filter(|w| **w == '\n')
            .count();
        at += length.max(1);
    }
    out
}

/// Characters from `at` to the next `end`, without it.
fn until(c: &[char], at: usize, end: char) -> usize {
    c[at..].iter().take_while(|w| **w != end).count()
}

/// Length of a comment between `/*` and `*/`, which may hold others.
fn comment(c: &[char], at: usize) -> usize {
    let (mut depth, mut i) = (0, at);
    while i + 1 < c.len() {
        match (c[i], c[i + 1]) {
            ('/', '*') => (depth, i) = (depth + 1, i + 2),
            ('*', '/') => (depth, i) = (depth - 1, i + 2),
            _ => i += 1,
        }
        if depth == 0 {
            break;
        }
    }
    i - at
}

/// Length of a string in quotation marks.
fn string(c: &[char], at: usize) -> usize {
    let mut i = at + 1;
    while i < c.len() && c[i] != '"' {
        i += if c[i] == '\\' { 2 } else { 1 };
    }
    i + 1 - at
}

/// Length of a character; a lifetime is a mark before a word.
fn quoted(c: &[char], at: usize) -> usize {
    match (c.get(at + 1), c.get(at + 2)) {
        (Some('\\'), _) => 3 + until(c, at + 3, '\'') + 1,
        (Some(_), Some('\'')) => 3,
        _ => {
            1 + c[at + 1..]
                .iter()
                .take_while(|w| w.is_alphanumeric() || **w == '_')
                .count()
        }
    }
}

/// Length of a string with a prefix, such as `r#"..."#` or `b"..."`, if one begins here.
fn raw(c: &[char], at: usize) -> Option<usize> {
    let prefix = c[at..].iter().take_while(|w| w.is_alphabetic()).count();
    let hashes = c[at + prefix..].iter().take_while(|w| **w == '#').count();
    let mark = at + prefix + hashes;
    if prefix > 2 || c.get(mark) != Some(&'"') {
        return None;
    }
    if !c[at..at + prefix].contains(&'r') {
        return (hashes == 0).then(|| prefix + string(c, mark));
    }
    let end = (mark + 1..c.len())
        .find(|i| c[*i] == '"' && c[i + 1..].iter().take_while(|w| **w == '#').count() >= hashes)?;
    Some(end + 1 + hashes - at)
}

/// Leaves out items behind `#[cfg(test)]`.
fn without_tests(all: Vec<Token>) -> (Vec<Token>, Vec<String>) {
    const MARK: [&str; 7] = ["#", "[", "cfg", "(", "test", ")", "]"];
    let (mut out, mut modules, mut at) = (Vec::new(), Vec::new(), 0);
    while at < all.len() {
        let here = &all[at..];
        if here.len() < MARK.len() || !here.iter().zip(MARK).all(|(t, m)| t.text == m) {
            out.push(all[at].clone());
            at += 1;
            continue;
        }
        let length = item(&here[MARK.len()..]);
        let body = &here[MARK.len()..MARK.len() + length];
        let name = body.windows(2).find(|w| w[0].text == "mod");
        modules.extend(name.map(|w| w[1].text.clone()));
        at += MARK.len() + length;
    }
    (out, modules)
}

/// Number of tokens of an item: to its semicolon, or to the end of its block.
fn item(all: &[Token]) -> usize {
    let import = all
        .iter()
        .find(|t| !["pub", "(", "crate", "super", ")"].contains(&t.text.as_str()))
        .is_some_and(|t| t.text == "use");
    let mut depth = 0;
    for (i, token) in all.iter().enumerate() {
        match token.text.as_str() {
            "{" | "(" | "[" => depth += 1,
            "}" | ")" | "]" => depth -= 1,
            _ => {}
        }
        let block = token.text == "}" && !import;
        if depth == 0 && (token.text == ";" || block) {
            return i + 1;
        }
    }
    all.len()
}

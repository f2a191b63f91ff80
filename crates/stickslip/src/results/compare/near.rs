//! Names that come near one that does not exist.

/// `; near: a, b` with the few names most like `word`, or what there is if it is little, or nothing.
pub fn near<'a>(word: &str, names: impl Iterator<Item = &'a str>) -> String {
    let names: Vec<&str> = names.collect();
    let mut ranked: Vec<(usize, &str)> = names
        .iter()
        .map(|name| (distance(word, name), *name))
        .filter(|(d, name)| *d <= word.len().max(3) / 2 || contains(name, word))
        .collect();
    ranked.sort();
    ranked.truncate(5);
    let list = |names: Vec<&str>| names.join(", ");
    match (ranked.is_empty(), names.len()) {
        (false, _) => format!(
            "; near: {}",
            list(ranked.into_iter().map(|r| r.1).collect())
        ),
        (true, 1..=12) => format!("; there are: {}", list(names)),
        _ => String::new(),
    }
}

/// Whether one is a part of the other, of three letters or more.
fn contains(name: &str, word: &str) -> bool {
    let (name, word) = (name.to_lowercase(), word.to_lowercase());
    name.len().min(word.len()) >= 3 && (name.contains(&word) || word.contains(&name))
}

/// Letters to insert, delete or replace, ignoring case.
fn distance(a: &str, b: &str) -> usize {
    strsim::levenshtein(&a.to_lowercase(), &b.to_lowercase())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_what_is_near_or_what_there_is() {
        let names = ["A.U1", "A.U2", "time"];
        assert_eq!(near("A.U3", names.into_iter()), "; near: A.U1, A.U2");
        assert_eq!(
            near("zzz", names.into_iter()),
            "; there are: A.U1, A.U2, time"
        );
        assert_eq!(near("zzz", std::iter::empty()), "");
    }
}

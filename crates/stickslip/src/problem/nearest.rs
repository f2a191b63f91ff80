//! The name that was probably meant.

/// Words of other programs and of older literature, and the word of this one.
const SYNONYMS: &[(&str, &str)] = &[
    ("master", "primary"),
    ("slave", "secondary"),
    ("source", "secondary"),
    ("target", "primary"),
    ("bodies", "body"),
    ("materials", "material"),
    ("interfaces", "interface"),
    ("contact", "interface"),
    ("steps", "step"),
    ("loads", "load"),
    ("boundary", "support"),
    ("supports", "support"),
    ("probes", "probe"),
    ("sets", "set"),
    ("E", "young"),
    ("youngs-modulus", "young"),
    ("nu", "poisson"),
    ("poissons-ratio", "poisson"),
    ("friction-coefficient", "mu"),
    ("time", "duration"),
    ("mesh", "generate"),
    // Names of before 0.1.
    ("unseen-to-size", "undetected-penetration"),
    ("unseen-to-approach", "undetected-approach"),
    ("false-slip", "elastic-slip"),
    ("excess-shear", "cone-violation"),
    ("false-shear", "outdated-normals"),
];

/// The one of `names` that `word` probably stands for: a synonym, or the nearest if at most a third of it differs.
pub fn nearest<'a>(word: &str, names: &[&'a str]) -> Option<&'a str> {
    let synonym = SYNONYMS.iter().filter(|(other, _)| *other == word);
    if let Some(name) = synonym
        .flat_map(|(_, name)| names.iter().find(|n| *n == name))
        .next()
    {
        return Some(name);
    }
    let word = simplify(word);
    let (distance, name) = names
        .iter()
        .map(|name| (strsim::osa_distance(&word, &simplify(name)), *name))
        .min()?;
    let length = word.chars().count();
    (distance <= (length / 3).max(1) && distance < length).then_some(name)
}

/// The word of this program for one of another.
pub(super) fn synonym(word: &str) -> Option<&'static str> {
    let known = SYNONYMS.iter().find(|(other, _)| *other == word);
    known.map(|(_, name)| *name)
}

/// `help` for a name that is not among `names`: what was probably meant and what there is.
pub(super) fn suggest(word: &str, what: &str, names: &[&str]) -> String {
    let all = match names {
        [] => format!("there are no {what}"),
        _ => format!("{what}: {}", names.join(", ")),
    };
    match nearest(word, names) {
        Some(name) => format!("did you mean `{name}`? {all}"),
        None => all,
    }
}

fn simplify(word: &str) -> String {
    word.to_lowercase().replace('_', "-")
}

#[cfg(test)]
mod tests {
    use super::{nearest, suggest};

    #[test]
    fn finds_typing_errors_and_synonyms() {
        let names = ["primary", "secondary", "friction", "primary-velocity"];
        for (word, meant) in [
            ("frction", "friction"),
            ("frcition", "friction"),
            ("Friction", "friction"),
            ("primary_velocity", "primary-velocity"),
            ("slave", "secondary"),
        ] {
            assert_eq!(nearest(word, &names), Some(meant));
        }
        assert_eq!(nearest("banana", &names), None);
        assert_eq!(nearest("x", &["y"]), None);
    }

    #[test]
    fn lists_what_there_is() {
        assert_eq!(
            suggest("steal", "materials", &["steel", "wood"]),
            "did you mean `steel`? materials: steel, wood"
        );
        assert_eq!(suggest("a", "sets", &[]), "there are no sets");
    }
}

//! What there is of a kind, for messages about what is missing.

use crate::numbering::Numbering;
use crate::text::clip;

/// What is said of a name that nothing has: the message, and a help.
pub(super) fn absent<'n>(
    numbering: &Numbering,
    what: &str,
    name: &str,
    known: impl Iterator<Item = &'n String>,
) -> (String, String) {
    let whose = |n: &str| numbering.within(n).map(|(i, _)| i);
    if let Some((instance, _)) = name.split_once('.')
        && !numbering.instances().is_empty()
        && whose(name).is_none()
    {
        let message = format!(
            "there is no {what} {}: no instance is called {}",
            clip(name),
            clip(instance)
        );
        return (
            message,
            nearest(instance, "instances", numbering.instances()),
        );
    }
    let message = format!("there is no {what} {}", clip(name));
    // Of an instance where none is said: most likely it has been forgotten.
    let known: Vec<&String> = known.collect();
    let alike = |n: &&&String| numbering.within(n).is_some_and(|(_, bare)| bare == name);
    let inner: Vec<&str> = known
        .iter()
        .filter(alike)
        .take(3)
        .map(|n| n.as_str())
        .collect();
    if !inner.is_empty() {
        return (message, format!("did you mean {}?", inner.join(" or ")));
    }
    let own = known.into_iter().filter(|n| whose(n) == whose(name));
    (message, listing(&plural(what), own))
}

fn plural(what: &str) -> String {
    match what.strip_prefix("set of ") {
        Some(members) => format!("sets of {members}"),
        None => format!("{what}s"),
    }
}

/// The name that is most like this one, and all there are, for a help.
pub(super) fn nearest<S: AsRef<str>>(name: &str, what: &str, known: &[S]) -> String {
    let edits = |k: &S| strsim::levenshtein(&clip(name), &clip(k.as_ref()));
    let all = listing(what, known.iter().take(20));
    match known.iter().min_by_key(|k| edits(k)) {
        Some(best) if edits(best) <= 3 => format!("did you mean {}? {all}", best.as_ref()),
        _ => all,
    }
}

/// What there is, for a help.
pub(super) fn listing<S: AsRef<str>>(what: &str, names: impl IntoIterator<Item = S>) -> String {
    let names: Vec<String> = names
        .into_iter()
        .take(20)
        .map(|n| n.as_ref().to_string())
        .collect();
    match names.is_empty() {
        true => format!("the deck has no {what}"),
        false => format!("{what}: {}", names.join(", ")),
    }
}

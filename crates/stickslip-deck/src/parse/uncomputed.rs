//! Kinds of things that are not computed.

use crate::card::Place;

pub(super) const SHELLS: &str = "shells";
pub(super) const BEAMS: &str = "beams";
pub(super) const MEMBRANES: &str = "membranes";
pub(super) const NETWORKS: &str = "networks of flows";
pub(super) const CONNECTORS: &str = "connectors";
pub(super) const COHESIVE: &str = "cohesive elements";
pub(super) const USER_ELEMENTS: &str = "elements of the user";
pub(super) const HEAT_TRANSFER: &str = "temperatures by heat transfer";

/// Something that is not computed, wherever the deck has it.
#[derive(Debug, Clone)]
pub(super) struct Beyond {
    /// What it is, in the plural; `None` if cards of this keyword are a kind of their own.
    pub kind: Option<&'static str>,
    /// How many there are of what: `*PLASTIC`, `elements of type S4`.
    pub counts: Vec<(String, usize)>,
    pub place: Place,
    pub help: &'static str,
}

/// What elements are, as a kind of things.
pub(super) fn kind_of_elements(what: &'static str) -> Option<&'static str> {
    Some(match what {
        "a shell" | "a continuum shell" => SHELLS,
        "a beam" | "a pipe" => BEAMS,
        "a truss" => "trusses",
        "a membrane" => MEMBRANES,
        "a connector" => CONNECTORS,
        "a cohesive element" => COHESIVE,
        "an acoustic element" => "acoustic elements",
        "an element of heat transfer" => HEAT_TRANSFER,
        "an element of a network of flows" => NETWORKS,
        "an element of the user" => USER_ELEMENTS,
        _ => return None,
    })
}

impl Beyond {
    pub fn message(&self) -> String {
        let count = |(what, n): &(String, usize)| match what.strip_prefix("elements") {
            Some(rest) if *n == 1 => format!("1 element{rest}"),
            _ => format!("{n} {what}"),
        };
        // Elements first, then what is said of them.
        let (mut counts, cards): (Vec<_>, Vec<_>) =
            (self.counts.iter().cloned()).partition(|(what, _)| what.starts_with("elements"));
        counts.extend(cards);
        match (self.kind, counts.as_slice()) {
            (Some(kind), counts) => {
                let list: Vec<String> = counts.iter().map(count).collect();
                format!("{kind} are not computed: {}", list.join(", "))
            }
            (None, [(what, 1)]) if what.starts_with('*') => format!("{what} is not supported"),
            (None, [(what, n)]) if what.starts_with('*') => {
                format!("{what} is not supported ({n} cards)")
            }
            (None, counts) => {
                let list: Vec<String> = counts.iter().map(count).collect();
                format!("{} are not supported", list.join(", "))
            }
        }
    }
}

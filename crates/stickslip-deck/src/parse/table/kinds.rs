//! Cards that are refused for one reason, as a kind of things.

use super::refused::{LAW, NO_HEAT, TIME};
use crate::parse::uncomputed::{
    BEAMS, COHESIVE, CONNECTORS, HEAT_TRANSFER, MEMBRANES, NETWORKS, SHELLS, USER_ELEMENTS,
};

/// The kind of a refused card, in the plural, from what it is about, or from the help that it has in common with others.
pub fn kind_of_card(keyword: &str, help: &str) -> Option<&'static str> {
    Some(match keyword {
        "SHELLSECTION" | "SHELLGENERALSECTION" | "NODALTHICKNESS" | "SHELLTOSOLIDCOUPLING" => {
            SHELLS
        }
        "BEAMSECTION" | "BEAMGENERALSECTION" => BEAMS,
        "MEMBRANESECTION" => MEMBRANES,
        "FLUIDSECTION" | "FLUIDSECTIONS" => NETWORKS,
        "CONNECTORSECTION" | "CONNECTORBEHAVIOR" => CONNECTORS,
        "COHESIVESECTION" => COHESIVE,
        "USERELEMENT" | "UEL" | "USERSECTION" => USER_ELEMENTS,
        _ if help == LAW => "materials that are not linear elastic",
        _ if help == NO_HEAT => HEAT_TRANSFER,
        _ if help == TIME => {
            "analyses other than *STATIC, *DYNAMIC, *FREQUENCY, *COMPLEX FREQUENCY and *STEADY STATE DYNAMICS"
        }
        _ => return None,
    })
}

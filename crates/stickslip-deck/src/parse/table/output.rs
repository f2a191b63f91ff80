//! What is printed and written.

use super::row::{Data, Fate, Parameter, Row, card, harmless, harmless_card, idle, read, refused};
use crate::parse::output;

const ONLY_WRITTEN: &str = "it only chooses what is written";

/// When something is written.
const WHEN: &[Parameter] = &[read("FREQUENCY"), read("FREQUENCYF"), read("TIMEPOINTS")];

/// A card that asks for fields: which and when is read; they are written of the whole model.
const fn fields(keyword: &'static str) -> Row {
    Row {
        others: Some(Fate::Idle(ONLY_WRITTEN)),
        ..card(keyword, output::output, Data::Any, WHEN)
    }
}

pub(super) const ROWS: &[Row] = &[
    card(
        "NODEPRINT",
        output::print,
        Data::Any,
        &[
            read("NSET"),
            read("TOTALS"),
            read("FREQUENCY"),
            read("FREQUENCYF"),
            read("TIMEPOINTS"),
            read("GLOBAL"),
            harmless("SUMMARY", ONLY_WRITTEN),
        ],
    ),
    card(
        "ELPRINT",
        output::print,
        Data::Any,
        &[
            read("ELSET"),
            read("TOTALS"),
            read("FREQUENCY"),
            read("FREQUENCYF"),
            read("TIMEPOINTS"),
            read("GLOBAL"),
            harmless("SUMMARY", ONLY_WRITTEN),
            refused(
                "POSITION",
                "values are printed at the points of integration: leave it out",
            ),
        ],
    ),
    card(
        "CONTACTPRINT",
        output::print,
        Data::Any,
        &[
            read("SLAVE"),
            read("MASTER"),
            read("TOTALS"),
            read("FREQUENCY"),
            read("FREQUENCYF"),
            read("TIMEPOINTS"),
            harmless("SUMMARY", ONLY_WRITTEN),
            harmless("LASTITERATIONS", ONLY_WRITTEN),
            harmless("CONTACTELEMENTS", ONLY_WRITTEN),
            harmless(
                "NSET",
                "all contact pairs are printed, or the one of SLAVE and MASTER",
            ),
            harmless(
                "SET",
                "all contact pairs are printed, or the one of SLAVE and MASTER",
            ),
        ],
    ),
    card(
        "SECTIONPRINT",
        output::section_print,
        Data::Any,
        &[
            read("SURFACE"),
            read("FREQUENCY"),
            read("FREQUENCYF"),
            read("TIMEPOINTS"),
            idle("NAME", "it is used for nothing"),
            harmless(
                "AXES",
                "forces and moments are printed along the global axes",
            ),
            harmless(
                "ANCHOR",
                "moments are printed about the origin and about the centre of the surface",
            ),
            harmless("UPDATE", "surfaces are as they were at first"),
        ],
    ),
    fields("NODEFILE"),
    fields("ELFILE"),
    fields("CONTACTFILE"),
    fields("NODEOUTPUT"),
    fields("ELEMENTOUTPUT"),
    fields("CONTACTOUTPUT"),
    Row {
        parameters: &[
            read("FREQUENCY"),
            read("FREQUENCYF"),
            read("TIMEPOINTS"),
            read("HISTORY"),
        ],
        ..fields("OUTPUT")
    },
    harmless_card("PREPRINT", ONLY_WRITTEN),
    harmless_card("PRINT", ONLY_WRITTEN),
    harmless_card("MONITOR", ONLY_WRITTEN),
    harmless_card("DIAGNOSTICS", ONLY_WRITTEN),
    harmless_card("FILTER", ONLY_WRITTEN),
    harmless_card("FILEFORMAT", ONLY_WRITTEN),
    harmless_card("FILEOUTPUT", ONLY_WRITTEN),
    harmless_card("INCREMENTATIONOUTPUT", ONLY_WRITTEN),
    harmless_card("MODALOUTPUT", ONLY_WRITTEN),
    harmless_card("ENERGYFILE", "energies are in history.csv"),
    harmless_card("ENERGYPRINT", "energies are in history.csv"),
    harmless_card("ENERGYOUTPUT", "energies are in history.csv"),
    harmless_card(
        "INTEGRATEDOUTPUT",
        "resultants of interfaces and supports are in history.csv",
    ),
    harmless_card(
        "INTEGRATEDOUTPUTSECTION",
        "resultants of interfaces and supports are in history.csv",
    ),
    harmless_card(
        "SECTIONFILE",
        "*SECTION PRINT prints what a surface carries; resultants of interfaces and supports are in history.csv",
    ),
    harmless_card(
        "NOANALYSIS",
        "`stickslip check` reads a deck without running it",
    ),
];

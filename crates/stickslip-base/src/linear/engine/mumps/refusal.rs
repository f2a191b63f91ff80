use crate::linear::LinearError;

/// What to try where memory does not suffice.
const MEMORY_OF_RANKS: &str = "more ranks on more machines, `solver.engine.mumps.out-of-core = true`, a larger `solver.engine.mumps.memory`, or `low-rank`";

/// No code of MUMPS: the row where the matrix that a rank has computed is no number.
const NOT_FINITE: &str = "1";

/// The row in which cells that a rank has computed are no numbers, if it complains of that.
pub(super) fn not_finite(words: &[String]) -> Option<usize> {
    match words {
        [code, row, ..] if code == NOT_FINITE => row.parse().ok(),
        _ => None,
    }
}

/// What MUMPS complains of: `INFOG(1) INFOG(2) PHASE`.
pub(super) fn refusal(words: &[String]) -> LinearError {
    let number = |at: usize| words.get(at).and_then(|w| w.parse::<i64>().ok());
    let (code, detail) = (number(0).unwrap_or(0), number(1).unwrap_or(0));
    let phase = words.get(2..).map_or(String::new(), |rest| rest.join(" "));
    let (what, help) = match code {
        -10 | -6 => return LinearError::Indefinite,
        -5 | -7 | -13 => ("memory could not be had", MEMORY_OF_RANKS),
        -8 | -9 | -11 | -14 | -15 | -17 | -19 | -20 => (
            "the memory that a rank may take does not suffice",
            MEMORY_OF_RANKS,
        ),
        -90 => (
            "factors could not be written to disk",
            "let STICKSLIP_MUMPS_DIR name a folder with enough space, or leave `out-of-core` out",
        ),
        -51 | -52 => (
            "the body is too large for the integers of this MUMPS",
            "a MUMPS with 64-bit integers",
        ),
        _ => (
            "it gave up",
            "the users' guide of MUMPS says what INFOG means; leave `solver.engine` out to use the built-in engine",
        ),
    };
    LinearError::Engine {
        message: format!("MUMPS, {phase}: {what} (INFOG(1) = {code}, INFOG(2) = {detail})"),
        help: help.into(),
    }
}

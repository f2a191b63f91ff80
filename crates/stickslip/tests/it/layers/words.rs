//! Words of the field: identifiers that only this program used, each with what textbooks say. They are refused.

use super::tokens::tokens;

/// Identifiers that are refused, and what to write instead.
const REFUSED: &[(&str, &str)] = &[
    ("Bare", "Undivided"),
    ("CurvedBulk", "NonlinearBulk"),
    ("Flips", "StatusHistory"),
    ("Follower", "DependentNode"),
    ("Guilty", "Suspect"),
    ("Hollows", "OppositeWear"),
    ("Meeting", "TimeOfImpact"),
    ("Ordered", "Analysed"),
    ("NodalWear", "OppositeWear"),
    ("PointAlone", "StickTrial"),
    ("Rub", "FrictionTerms"),
    ("Scar", "WearProfile"),
    ("Sight", "InertialFrame"),
    ("Spinning", "IncrementalRotation"),
    ("Spread", "DistributedOperator"),
    ("Standing", "StepProgress"),
    ("Trying", "CycleBlockTrial"),
    ("Unjoined", "MissingInterface"),
    ("Voice", "ProgressPrinter"),
    ("Working", "AttemptState"),
    ("adopt_forces", "set_multipliers"),
    ("ask_first", "check_model"),
    ("come_to_rest", "end_dynamics"),
    ("enter_here", "an argument"),
    ("forget_direction", "reset_predictor"),
    ("goes_to_and_fro", "oscillates"),
    ("hold_axles", "damp_axles"),
    ("hold_back", "levenberg_marquardt_damping"),
    ("hollow", "wear_gap"),
    ("hollow_out", "add_nodal_wear"),
    ("hollowed", "worn_volume"),
    ("hollows", "opposite_wear"),
    ("into_axes", "to_body_axes"),
    ("judge_friction", "friction_error"),
    ("lay_out", "layout_of"),
    ("lend", "an argument"),
    ("moved_over", "relative_slip"),
    ("never_in_contact", "before_first_contact"),
    ("passes_through", "undetected penetration"),
    ("points_alone", "stick_trials"),
    ("put_out", "write_fields"),
    ("scar", "wear_profile"),
    ("see_rate", "use_end_velocity"),
    ("see_steady", "use_steady_velocity"),
    ("softness", "wear_compliance"),
    ("stranded", "off_edge"),
    ("vain", "no_progress"),
    ("wears_off", "wear_increment"),
];

/// The refused identifiers of a file: `LINE: WORD: INSTEAD`.
pub fn refused(text: &str) -> Vec<String> {
    let (all, _) = tokens(text);
    let found = all.iter().filter_map(|token| {
        let (word, instead) = REFUSED.iter().find(|(word, _)| *word == token.text)?;
        Some(format!("{}: `{word}`: {instead}", token.line))
    });
    found.collect()
}

/// Where the table of the style guide begins and ends in CONTRIBUTING.md.
const TABLE: [&str; 2] = [
    "<!-- refused phrases -->",
    "<!-- end of refused phrases -->",
];

/// A phrase that is refused in comments, messages and pages, and what to write instead.
pub struct Phrase<'a> {
    refused: &'a str,
    instead: &'a str,
}

/// The text of the style guide before, in and after its table of refused phrases.
fn parts(guide: &str) -> [&str; 3] {
    let [begin, end] = TABLE;
    let (before, rest) = guide.split_once(begin).expect("the table of phrases");
    let (table, after) = rest.split_once(end).expect("the end of the table");
    [before, table, after]
}

/// The refused phrases: the rows of the table in the style guide.
pub fn phrases(guide: &str) -> Vec<Phrase<'_>> {
    let [_, table, _] = parts(guide);
    let rows = table.lines().filter_map(|row| row.strip_prefix("| `"));
    let phrases = rows.filter_map(|row| {
        let (refused, instead) = row.split_once("` | ")?;
        let instead = instead.trim_end_matches([' ', '|']);
        Some(Phrase { refused, instead })
    });
    phrases.collect()
}

/// The style guide without its table.
pub fn without_table(guide: &str) -> String {
    let [before, _, after] = parts(guide);
    format!("{before}{after}")
}

/// The refused phrases of a text: `LINE: PHRASE: INSTEAD`.
pub fn refused_phrases(text: &str, phrases: &[Phrase]) -> Vec<String> {
    let lines = text.lines().enumerate();
    let found = lines.flat_map(|(line, text)| {
        let text = text.to_lowercase();
        let here = phrases.iter().filter(move |p| text.contains(p.refused));
        here.map(move |p| format!("{}: `{}`: {}", line + 1, p.refused, p.instead))
    });
    found.collect()
}

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

/// Phrases that are refused in comments, messages and pages, and what to write instead.
const PHRASES: &[(&str, &str)] = &[
    ("another shear than", "differs from the friction limit"),
    ("forces shake", "harmonic forces"),
    ("all of their stiffness", "full stiffness"),
    ("energy ledger", "energy balance"),
    ("enter each other", "penetrate"),
    ("equal bits", "bitwise reproducible"),
    (
        "equations of motion are left",
        "residual of the equations of motion",
    ),
    ("kept from entering", "may not penetrate"),
    ("ledger of energies", "energy balance"),
    (
        "list the wrong things",
        "wrong boundary conditions are active",
    ),
    ("neither theory nor", "outside the valid range"),
    ("not given has a default", "all other keys are optional"),
    ("out of nothing", "spurious"),
    ("said of velocities", "stated in terms of velocity"),
    ("stop at once makes", "impact nodes"),
    ("told not to", "does not"),
    ("until contact holds them", "until contact is established"),
    ("who factors", "linear solver"),
    ("without strain until", "rigid-body motion"),
    ("give or take", "±"),
    ("has the word", "decides"),
    ("have the word", "decide"),
    ("in vain", "without progress"),
    ("know nothing", "do not include"),
    ("knows nothing", "does not include"),
    ("loose bod", "unconstrained bodies"),
    ("matter goes by", "material moves past"),
    ("nobody ", "no process, or is not known"),
    ("nothing holds", "unconstrained"),
    ("stand still in steady", "base excitation"),
    ("stand-in", "approximation"),
    ("to and fro", "back and forth"),
    ("what happens is told", "messages go to"),
];

/// The refused phrases of a text: `LINE: PHRASE: INSTEAD`.
pub fn refused_phrases(text: &str) -> Vec<String> {
    let lines = text.lines().enumerate();
    let found = lines.flat_map(|(line, text)| {
        let text = text.to_lowercase();
        let here = PHRASES
            .iter()
            .filter(move |(phrase, _)| text.contains(phrase));
        here.map(move |(phrase, instead)| format!("{}: `{phrase}`: {instead}", line + 1))
    });
    found.collect()
}

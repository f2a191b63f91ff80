use std::path::{Path, PathBuf};

use stickslip::Error;
use stickslip::newton::condensed::Library;
use stickslip::results::{FolderClaim, Lent, ResultFiles, Saved, Source};
use stickslip::run::{Checkpoint, Simulation};

use super::run::{Manner, Session, claim, go, stem};
use super::{library, use_threads};
use crate::failure::{Failure, Outcome};
use crate::given;
use crate::input::Input;
use crate::voice::ProgressPrinter;
use stickslip::number::digits;
use stickslip::problem::changes;

/// Continue an interrupted analysis from its last checkpoint.
///
/// The results are bitwise those of an uninterrupted run. The problem is `problem.toml` in the result folder. Before resuming you may change the duration
/// of the current step, later steps, `output` and `title` there.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// The result folder.
    #[arg(value_hint = clap::ValueHint::DirPath)]
    directory: PathBuf,
    /// Continue from the checkpoint after N increments; default: the last one.
    #[arg(long, value_name = "N")]
    from: Option<usize>,
    /// Change a value that may be changed, for example step.1.duration=2.
    #[arg(long = "set", value_name = "PATH=VALUE")]
    set: Vec<String>,
    #[command(flatten)]
    manner: Manner,
}

/// Goes on.
pub fn run(arguments: &Arguments) -> Outcome {
    let manner = &arguments.manner;
    use_threads(manner.threads, manner.quiet);
    let voice = ProgressPrinter::new();
    voice.does("reading and assembling");
    let heartbeat = manner.heartbeat(&voice);
    let directory = &arguments.directory;
    if !directory.is_dir() {
        given::results(directory)?;
    }
    // No other process writes there from here on, as long as it may take to assemble.
    let held = FolderClaim::take(directory)?;
    let (saved, notes) = Saved::find(directory, arguments.from)?;
    for note in &notes {
        crate::progress::say(note);
    }
    saved.check_lent(directory, &Lent::default())?;
    saved.check_inputs()?;
    let input = open(&saved.source, directory, &arguments.set)?;
    changes::check_changes(&input.document, &input.problem, &saved)?;
    let setup = input.build()?;
    let cache = saved.source.cache.as_deref().map(Path::new);
    let library = library(Library::small_limit(), cache)?;
    let checkpoint = Checkpoint::of(&saved, directory)?;
    let simulation = Simulation::resume(setup, library, checkpoint)?;
    let stem = stem(Path::new(&saved.source.file));
    let source = Source {
        problem: input.problem.to_toml().map_err(Error::Problem)?,
        ..saved.source.clone()
    };
    let claim = claim(&input, &stem, source);
    let files = ResultFiles::resume(held, &claim, &saved)?;
    if manner.loud() {
        crate::progress::say(&format!(
            "goes on after {} increments, at time {}",
            saved.snapshot.increments,
            digits(saved.snapshot.time, 6)
        ));
    }
    go(
        Session {
            input,
            simulation,
            files,
            directory: directory.clone(),
            stem,
            resumed: true,
            voice,
            heartbeat,
            dump_failures: None,
        },
        manner,
    )
}

/// The problem of the folder, or the deck that it was translated from.
fn open(source: &Source, directory: &Path, set: &[String]) -> Result<Input, Failure> {
    let file = Path::new(&source.file);
    if given::is_deck(file) {
        let overrides: Vec<String> = source.overrides.iter().chain(set).cloned().collect();
        return Input::open(file, &overrides);
    }
    let document = changes::of_results(directory, source)?.with_overrides(set.to_vec());
    let folder = file.parent().unwrap_or(Path::new("")).to_path_buf();
    Input::of(document, folder)
}

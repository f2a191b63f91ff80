use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

use stickslip::Error;
use stickslip::friction::text;
use stickslip::io::write_atomically;
use stickslip::newton::condensed::Library;
use stickslip::results::{
    Claim, FrdPlan, Lent, Observer, ResultFiles, Source, checkpoints, digest_of,
};
use stickslip::run::Simulation;
use stickslip_deck::{Printer, Status};

use super::{EngineArguments, library, use_threads};

use crate::failure::{Failure, Outcome};
use crate::input::Input;
use crate::lines::Lines;
use crate::progress::Progress;
use crate::style::sentence;
use crate::voice::{Heartbeat, ProgressPrinter};

/// Run an analysis and write its results.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// The problem file, or an input deck of Abaqus or CalculiX (`.inp`).
    file: PathBuf,
    /// Result folder; default: `<file>.out` beside the file.
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    /// Change a value, for example interface.base.friction.coulomb.mu=0.3.
    #[arg(long = "set", value_name = "PATH=VALUE")]
    set: Vec<String>,
    /// Keep factorisations of bodies in DIR and reuse them: other loads, contact laws and steps need no new factorisation. DIR can be deleted at any
    /// time.
    #[arg(long, value_name = "DIR")]
    cache: Option<PathBuf>,
    #[command(flatten)]
    engine: EngineArguments,
    /// Write an increment that no solver solves to DIR as a friction problem, for `stickslip friction`.
    #[arg(long, value_name = "DIR")]
    dump_failures: Option<PathBuf>,
    #[command(flatten)]
    manner: Manner,
}

impl Arguments {
    /// A file as it is.
    pub fn of(file: &Path, output: &Path, manner: Manner) -> Self {
        Arguments {
            file: file.to_path_buf(),
            output: Some(output.to_path_buf()),
            set: Vec::new(),
            cache: None,
            engine: EngineArguments::default(),
            dump_failures: None,
            manner,
        }
    }
}

/// How an analysis is run and what is said of it.
#[derive(Debug, clap::Args)]
pub struct Manner {
    /// Number of threads; default: all processors. Results do not depend on it.
    #[arg(long, value_name = "N")]
    pub threads: Option<usize>,
    /// No progress on standard error.
    #[arg(short, long)]
    pub quiet: bool,
    /// Show every Newton iteration and details of the solver.
    #[arg(short, long)]
    verbose: bool,
    /// Print events as lines of JSON on standard output.
    #[arg(long)]
    json: bool,
}

impl Manner {
    /// What is said to people.
    pub fn new(threads: Option<usize>, quiet: bool) -> Self {
        Manner {
            threads,
            quiet,
            verbose: false,
            json: false,
        }
    }

    /// Messages that the run is still going on.
    pub fn heartbeat(&self, voice: &ProgressPrinter) -> Option<Heartbeat> {
        match (self.json, self.quiet) {
            (true, _) => Some(Heartbeat::to_program(voice)),
            (false, true) => None,
            (false, false) => Some(Heartbeat::start(voice)),
        }
    }

    /// Whether progress is shown.
    pub fn loud(&self) -> bool {
        !self.quiet && !self.json
    }
}

/// What an analysis is run with.
pub struct Session {
    pub input: Input,
    pub simulation: Simulation,
    pub files: ResultFiles,
    pub directory: PathBuf,
    /// The name of the deck without its ending.
    pub stem: String,
    /// It goes on.
    pub resumed: bool,
    /// What says what is being worked on.
    pub voice: ProgressPrinter,
    pub heartbeat: Option<Heartbeat>,
    /// Where an increment that nothing solves is written to.
    pub dump_failures: Option<PathBuf>,
}

/// Runs the analysis.
pub fn run(arguments: &Arguments) -> Outcome {
    let manner = &arguments.manner;
    use_threads(manner.threads, manner.quiet);
    let started = Instant::now();
    let voice = ProgressPrinter::new();
    voice.does("reading and assembling");
    let heartbeat = manner.heartbeat(&voice);
    let overrides = arguments.engine.overrides(&arguments.set);
    let input = Input::open(&arguments.file, &overrides)?;
    let setup = input.build()?;
    let directory = arguments
        .output
        .clone()
        .unwrap_or_else(|| arguments.file.with_extension("out"));
    for note in input.notes(manner.loud()) {
        crate::progress::say(&sentence(&note));
    }
    let read = started.elapsed().as_secs_f64();
    let library = library(Library::small_limit(), arguments.cache.as_deref())?;
    let mut simulation = Simulation::with_library(setup, library)?;
    simulation.run.summary.cost.phases.read = read;
    if let Some(warning) = crate::space::warning(&simulation.sizes(), &directory) {
        crate::progress::say(&sentence(&warning));
    }
    let stem = stem(&arguments.file);
    let source = source(&input, arguments, overrides)?;
    let claim = claim(&input, &stem, source);
    let files = ResultFiles::new(&directory, &claim)?;
    for note in files.notes() {
        crate::progress::say(&sentence(note));
    }
    go(
        Session {
            input,
            simulation,
            files,
            directory,
            stem,
            resumed: false,
            voice,
            heartbeat,
            dump_failures: arguments.dump_failures.clone(),
        },
        manner,
    )
}

/// What the run was called with, for its checkpoints.
fn source(input: &Input, arguments: &Arguments, overrides: Vec<String>) -> Result<Source, Failure> {
    let name = |path: &Path| {
        let whole = std::path::absolute(path).unwrap_or_else(|_| path.to_path_buf());
        whole.to_string_lossy().into_owned()
    };
    let mut inputs = Vec::new();
    for file in input.files() {
        inputs.push((name(&file), digest_of(&file)?));
    }
    Ok(Source {
        problem: input.problem.to_toml().map_err(Error::Problem)?,
        file: name(&arguments.file),
        overrides,
        inputs,
        cache: arguments.cache.as_deref().map(name),
        lent: Lent::default(),
    })
}

/// The name of a file without its ending.
pub fn stem(file: &Path) -> String {
    let stem = file.file_stem().unwrap_or_default();
    stem.to_string_lossy().into_owned()
}

/// The files that a run reads and writes.
pub fn claim(input: &Input, stem: &str, source: Source) -> Claim {
    Claim {
        inputs: input.files(),
        also: match input.deck {
            Some(_) => vec![format!("{stem}.dat"), format!("{stem}.sta")],
            None => Vec::new(),
        },
        frd: (input.deck.as_ref()).map_or_else(FrdPlan::default, |deck| deck.frd(stem)),
        source: Some(source),
        ..Claim::default()
    }
}

/// Runs what there is to run.
pub fn go(session: Session, manner: &Manner) -> Outcome {
    let Session {
        input,
        mut simulation,
        mut files,
        directory,
        stem,
        resumed,
        voice,
        heartbeat,
        dump_failures,
    } = session;
    let loud = manner.loud();
    simulation.set_interrupt(crate::interrupt::watch());
    simulation.set_watch(voice.watch());
    super::report::keep_problem(&directory, &input.problem)?;
    let mut lines = Lines::new(voice.clone());
    let mut progress = Progress::new(manner.verbose, voice);
    let beside = |extension: &str| directory.join(format!("{stem}.{extension}"));
    let mut printer = input
        .deck
        .as_ref()
        .and_then(|deck| Printer::new(deck, &beside("dat")));
    let mut status = input.deck.is_some().then(|| Status::new(&beside("sta")));
    if resumed {
        printer = printer.map(Printer::resume).transpose()?;
        status = status.map(Status::resume).transpose()?;
    }
    // Files that grow come before what notes how far they are.
    let mut observers: Vec<&mut dyn Observer> = Vec::new();
    observers.extend(printer.as_mut().map(|p| p as &mut dyn Observer));
    observers.extend(status.as_mut().map(|s| s as &mut dyn Observer));
    observers.push(&mut files);
    if loud {
        observers.push(&mut progress);
    }
    if manner.json {
        observers.push(&mut lines);
    }
    let outcome = simulation.run(&mut observers);
    if let (Err(Error::Run(_)), Some(folder)) = (&outcome, &dump_failures) {
        dump(folder, &stem, &simulation)?;
    }
    let stopped = matches!(outcome, Err(Error::Interrupted(_))) && loud;
    if stopped && !checkpoints(&directory).is_empty() {
        crate::progress::say(&format!(
            "`stickslip resume {}` goes on from here",
            directory.display()
        ));
    }
    if let Some(why) = files.unsaved().filter(|_| manner.quiet) {
        crate::progress::say(&format!("warning: {why}"));
    }
    outcome?;
    drop(heartbeat);
    if loud {
        crate::closing::closing(&simulation.analysis(), &directory, manner.verbose);
    }
    let quality = &simulation.summary.quality;
    if quality.failed() || loud {
        crate::closing::gate(quality, &simulation.summary.findings);
    }
    Ok(match quality.failed() {
        true => ExitCode::from(crate::failure::CHECK),
        false => ExitCode::SUCCESS,
    })
}

/// Writes the increment that nothing has solved.
fn dump(folder: &Path, stem: &str, simulation: &Simulation) -> Result<(), Failure> {
    let Some(problem) = simulation.unsolved() else {
        crate::progress::say(
            "no friction problem is written: only an increment of condensed bodies that does not converge is one",
        );
        return Ok(());
    };
    fs::create_dir_all(folder).map_err(|e| Error::io(folder, e))?;
    let path = folder.join(format!("{stem}.txt"));
    let remarks = format!(
        "{stem}: an increment that did not converge, after time {:e}\nu = W r + q in the units of the problem; normal component first",
        simulation.view().frame.state.t
    );
    write_atomically(&path, text::write(problem, &remarks).as_bytes())?;
    crate::progress::say(&format!(
        "the increment as a friction problem: {}",
        path.display()
    ));
    Ok(())
}

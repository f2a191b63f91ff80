//! `sweep`: a problem file or a deck, many values, one table; in one process, or in parts that are merged.

mod columns;
mod critical;
mod done;
mod effort;
mod idle;
mod merge;
mod one;
mod plan;
mod shard;
mod table;
mod values;

use std::path::{Path, PathBuf};
use std::time::Instant;

use stickslip::Error;
use stickslip::assess::doctor::Severity;
use stickslip::io::drop_leftovers;
use stickslip::newton::condensed::Library;
use stickslip::results::FileClaim;

use super::{EngineArguments, library, spare, use_threads};

use crate::failure::{Failure, Outcome};
use crate::input::Case;
use crate::progress::found;
use crate::voice::{Heartbeat, ProgressPrinter};
use columns::Columns;
use done::{Done, Row, ended};
use one::{Ended, Shared, analyse};
use plan::{Plan, folder_of_run, runs};
use shard::{Shard, Share, Sweep, processor};
use table::Table;

/// Run an analysis for many values and write one table with a row for each run.
#[derive(Debug, clap::Args)]
#[command(override_usage = "\
stickslip sweep [OPTIONS] --set <PATH=V1,V2,...> <FILE>
       stickslip sweep --merge <DIR>... [-o <FILE>] [--results <DIR>]")]
#[command(after_help = "\
Values are TOML: numbers, true, \"text\", [1, 2], { x = 1 }; commas inside do not separate. A range from..to:count
includes both ends. Bodies that do not change are factored once. The columns of the table are run, the axes, outcome, increments, iterations, cutbacks,
and the last row of the history; time and memory are in TABLE.effort.csv. All values are checked before the first run. A failed run
does not stop the others: its outcome has the reason, and the exit code is 1. If a run fails the quality gate and none failed otherwise,
the exit code is 2.

On several machines each process runs one part, --shard 1/4 to --shard 4/4, with the same other arguments; the same command continues a killed part.
--merge writes the table of all parts, byte for byte that of one process.

Examples:
  stickslip sweep case.toml --set interface.base.friction.coulomb.mu=0.1..0.5:5 --set support.top.y=-1e-5,-2e-5
  stickslip sweep case.toml --zip --set step.1.duration=1,2 --set step.1.increments.fixed=10,20 --column ALLSE
  stickslip sweep case.toml --set interface.base.friction.coulomb.mu=0.1..0.5:50 --cache factors --shard 2/4
  stickslip sweep --merge case.sweep.shards")]
pub struct Arguments {
    /// The problem file, or an input deck of Abaqus or CalculiX (`.inp`) with the keys that `convert` writes.
    #[arg(required_unless_present = "merge")]
    file: Option<PathBuf>,
    /// An axis: a key and its values. Several axes make all combinations; the last one changes fastest.
    #[arg(
        long = "set",
        value_name = "PATH=V1,V2,...",
        required_unless_present = "merge"
    )]
    set: Vec<String>,
    /// A value for all runs, as `run --set`.
    #[arg(long = "fix", value_name = "PATH=VALUE")]
    fix: Vec<String>,
    /// Combine axes of equal length value by value, instead of all combinations.
    #[arg(long)]
    zip: bool,
    /// A column of the history for the table; default: all. Can be repeated.
    #[arg(long = "column", value_name = "NAME")]
    column: Vec<String>,
    /// Find values of the last axis where a column, such as MODES.GROWTH, changes sign, by additional runs, and write TABLE.critical.csv.
    #[arg(long, value_name = "NAME", conflicts_with_all = ["shard", "zip", "merge"])]
    critical: Option<String>,
    /// The table, TABLE.csv; default: `<file>.sweep.csv` beside the file. It is complete after every run. Shards are in `TABLE.shards`.
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Keep the result files of every run in DIR/0001 and so on. With --merge: check that all exist.
    #[arg(long, value_name = "DIR")]
    results: Option<PathBuf>,
    /// Keep factorisations of bodies in DIR and reuse them; see `run --cache`.
    #[arg(long, value_name = "DIR")]
    cache: Option<PathBuf>,
    #[command(flatten)]
    engine: EngineArguments,
    /// Number of threads; default: all processors. Results do not depend on it.
    #[arg(long, value_name = "N")]
    threads: Option<usize>,
    /// Continue an interrupted sweep: finished runs are not repeated. Shards always continue.
    #[arg(long)]
    resume: bool,
    /// Run only part I of N, for N processes on one or more machines.
    #[arg(long, value_name = "I/N")]
    shard: Option<String>,
    /// Merge shards into one table: their folders, or the folder that contains them.
    #[arg(
        long,
        value_name = "DIR",
        num_args = 1..,
        conflicts_with_all = ["file", "set", "fix", "zip", "column", "cache", "threads", "resume", "shard"]
    )]
    merge: Vec<PathBuf>,
    /// No progress on standard error.
    #[arg(short, long)]
    quiet: bool,
}

/// Runs all, or a part, or merges parts.
pub fn run(arguments: &Arguments) -> Outcome {
    let voice = ProgressPrinter::new();
    if !arguments.merge.is_empty() {
        let tell = |text: &str| {
            if !arguments.quiet {
                voice.line(text);
            }
        };
        let (output, results) = (arguments.output.as_deref(), arguments.results.as_deref());
        return merge::merge(&arguments.merge, output, results, &tell);
    }
    let Some(file) = &arguments.file else {
        return Err(Failure::Arguments(
            "no problem file is given".into(),
            "stickslip sweep FILE --set PATH=V1,V2".into(),
        ));
    };
    let share = arguments.shard.as_deref().map(Share::parse).transpose()?;
    use_threads(arguments.threads, arguments.quiet);
    let fixed = arguments.engine.overrides(&arguments.fix);
    let plan = Plan::new(&arguments.set, &fixed, arguments.zip)?;
    let case = Case::read(file)?.keeping_meshes();
    let read = plan.check(&case.document);
    let files = case.files(read.map_err(|e| case.failure(e.into()))?);
    let output = arguments.output.clone();
    let output = output.unwrap_or_else(|| file.with_extension("sweep.csv"));
    spare(&output, std::slice::from_ref(file))?;
    let _heartbeat = (!arguments.quiet).then(|| Heartbeat::start(&voice));
    let runs = Runs {
        arguments,
        plan: &plan,
        case: &case,
        shared: Shared {
            watch: voice.watch(),
            library: library(Library::usual_limit(), arguments.cache.as_deref())?,
            interrupt: crate::interrupt::watch(),
            dead: None,
        },
        voice: &voice,
        wanted: &arguments.column,
        told: Vec::new(),
    };
    match share {
        None => whole(runs, &files, output),
        Some(share) => part(runs, &files, &output, share),
    }
}

/// All runs, in one table.
fn whole(mut all: Runs, files: &[PathBuf], output: PathBuf) -> Outcome {
    let started = Instant::now();
    let (plan, arguments) = (all.plan, all.arguments);
    let axes = plan.axes.iter().map(|axis| axis.path.clone()).collect();
    let mut table = Table::new(output, axes, &arguments.column);
    // That the file cannot be written should not be found after the first run.
    table.try_file()?;
    let _claim = FileClaim::take(&table.path)?;
    drop_leftovers(&table.path)?;
    all.tell(&heading(plan));
    let folder = table.path.with_extension("runs");
    let mut first = 0.0;
    if arguments.resume && !Shard::is_one(&folder) && table.path.is_file() {
        all.complete(&mut table)?;
    } else {
        if !arguments.resume {
            Shard::remove(&folder)?;
        }
        // Columns, and whether results are kept, are no matter of what is known of runs.
        let sweep = Sweep::of(plan, files, &[], false)?;
        let shard = Shard::begin(&folder, sweep, Share { index: 1, of: 1 })?;
        let mut shard = shard.map_err(|what| {
            shard::fault(&table.path, &format!("this is no table of the same sweep: {what}; rows of both do not belong in one table; run it anew into another file"))
        })?;
        let before = (0..plan.count()).take_while(|run| shard.done.contains_key(run));
        let before = before.count();
        if before > 0 {
            shard
                .done
                .range(..before)
                .for_each(|(_, done)| table.add(done));
            table.write()?;
            all.tell(&format!("{} in the table already", runs(before)));
        }
        all.goes_on(before > 0);
        for run in before..plan.count() {
            let begun = Instant::now();
            let over = all.make(run);
            if matches!(over, Err(Failure::Library(Error::Interrupted(_)))) {
                all.tell(&format!(
                    "the table in {} has the runs before",
                    table.path.display()
                ));
            }
            let over = over?;
            if run == before {
                first = begun.elapsed().as_secs_f64();
            }
            table.add(&over);
            shard.push(run, over)?;
            table.write()?;
        }
    }
    if let Some(quantity) = &arguments.critical {
        all.find_critical(&table, quantity)?;
    }
    // What is left would only be found done when the sweep were to go on.
    let _ = Shard::remove(&folder);
    for axis in idle::idle(plan.axes.len(), table.rows()) {
        all.tell(&format!(
            "{} changes nothing: all runs that differ in it alone have the same results to the last digit. Is it a key of what acts in no step, or that another key overrides?",
            plan.axes[axis].path
        ));
    }
    all.tell(&format!(
        "{} in {:.3} s, the first in {first:.3} s; table in {}",
        runs(plan.count()),
        started.elapsed().as_secs_f64(),
        table.path.display()
    ));
    ended(table.rows().iter(), table.path.clone())
}

/// One part of the runs, in a folder of its own.
fn part(mut all: Runs, files: &[PathBuf], output: &Path, share: Share) -> Outcome {
    let started = Instant::now();
    let (plan, arguments) = (all.plan, all.arguments);
    let parts = output.with_extension("shards");
    let above = parts.parent().filter(|above| *above != Path::new(""));
    if let Some(above) = above.filter(|above| !above.is_dir()) {
        return Err(Failure::Arguments(
            format!(
                "{}: there is no folder {}",
                output.display(),
                above.display()
            ),
            "make it first, or choose another table with -o".into(),
        ));
    }
    let folder = parts.join(format!("{}-of-{}", share.index, share.of));
    let own = share.runs(plan.count());
    all.tell(&format!(
        "shard {share}: {} of {}",
        own.len(),
        heading(plan)
    ));
    let sweep = Sweep::of(plan, files, &arguments.column, arguments.results.is_some())?;
    let waits = |holder: &str| {
        all.tell(&format!(
            "looking whether {holder}, which has this shard, still lives"
        ));
    };
    let (_lease, dead) = shard::take(&folder, &waits)?;
    let shard = Shard::begin(&folder, sweep, share)?;
    let mut shard = shard.map_err(|what| shard::another(&folder, &what))?;
    all.shared.dead = dead;
    if !shard.done.is_empty() {
        all.tell(&format!(
            "{} in {} already",
            runs(shard.done.len()),
            folder.display()
        ));
    }
    all.goes_on(shard.done.values().any(|done| !done.names.is_empty()));
    for &run in &own {
        if !shard.done.contains_key(&run) {
            let over = all.make(run)?;
            shard.push(run, over)?;
        }
    }
    all.tell(&format!(
        "{} in {:.3} s; when all shards are there: stickslip sweep --merge {} -o {}",
        runs(own.len()),
        started.elapsed().as_secs_f64(),
        parts.display(),
        output.display()
    ));
    ended(shard.done.values().map(|done| &done.row), folder)
}

/// The runs of a sweep, made one after the other.
struct Runs<'a> {
    arguments: &'a Arguments,
    plan: &'a Plan,
    case: &'a Case,
    shared: Shared,
    voice: &'a ProgressPrinter,
    /// Columns that the next run must have.
    wanted: &'a [String],
    /// What was said of the model.
    told: Vec<String>,
}

impl Runs<'_> {
    fn tell(&self, text: &str) {
        if !self.arguments.quiet {
            self.voice.line(text);
        }
    }

    /// Takes over a table that nothing beside it says to be going on: it ought to be complete.
    fn complete(&self, table: &mut Table) -> Result<(), Failure> {
        let plan = self.plan;
        let done =
            table.take_over(|run| plan.values(run).into_iter().map(str::to_string).collect())?;
        self.tell(&format!("{} in the table already", runs(done)));
        match done < plan.count() {
            true => Err(shard::fault(&table.path, "rows are missing, and nothing beside this table says that they are of the same sweep: its folder `.runs` was removed; without `--resume` it is run anew").into()),
            false => Ok(()),
        }
    }

    /// Others were made before: a later run may lack a column; its place stays empty.
    fn goes_on(&mut self, others: bool) {
        if others {
            self.wanted = &[];
        }
    }

    /// Looks between the runs of a table for where a quantity goes through zero.
    fn find_critical(&mut self, table: &Table, quantity: &str) -> Result<(), Failure> {
        if !table
            .rows()
            .iter()
            .any(|row| row.last.contains_key(quantity))
        {
            return Err(Failure::Arguments(
                format!("--critical: no run has a column `{quantity}`"),
                "the table has all columns that there are".into(),
            ));
        }
        let axes: Vec<String> = self.plan.axes.iter().map(|a| a.path.clone()).collect();
        let (last, others) = axes.split_last().expect("a sweep has an axis");
        let mut found = Vec::new();
        for bracket in critical::brackets(table.rows(), quantity) {
            let chosen = others.iter().zip(&bracket.others);
            let mut fixed = self.plan.fixed.clone();
            fixed.extend(chosen.map(|(axis, value)| format!("{axis}={value}")));
            let mut run = |value: f64| {
                let mut overrides = fixed.clone();
                overrides.push(format!("{last}={value:?}"));
                let mut columns = Columns::new(&[]);
                let ended = analyse(
                    self.case.input(&overrides),
                    None,
                    &mut columns,
                    &self.shared,
                );
                match ended.error {
                    Some(error) => Err(error),
                    None => Ok(ended.summary.and_then(|s| s.last.get(quantity).copied())),
                }
            };
            let [value, there] = critical::narrow(&bracket, &mut run)?;
            let mut all = bracket.others.clone();
            all.push(format!("{value:.9}"));
            self.tell(&format!(
                "{quantity} goes through zero at {last} = {}",
                all.join("  ")
            ));
            found.push((bracket.others, [value, there]));
        }
        let path = table.path.with_extension("critical.csv");
        critical::write(&path, &axes, quantity, &found)
    }

    /// Makes a run, counted from 0.
    ///
    /// # Errors
    /// [`Failure`] where the sweep ends with it: a column that there is not, or the wish of the user. A run that fails is one that is over.
    fn make(&mut self, run: usize) -> Result<Done, Failure> {
        let (plan, count) = (self.plan, self.plan.count());
        let begun = Instant::now();
        self.voice.begins(&format!("run {} of {count}", run + 1));
        let directory = self.arguments.results.as_ref();
        let directory = directory.map(|d| folder_of_run(d, run));
        let mut columns = Columns::new(self.wanted);
        let input = self.case.input(&plan.overrides(run));
        let ended = analyse(input, directory.as_deref(), &mut columns, &self.shared);
        if let Some(refusal) = columns.refusal() {
            return Err(refusal);
        }
        self.goes_on(!columns.names.is_empty());
        let outcome = ended.outcome();
        let Ended { error, summary } = ended;
        if let Some(stopped @ Failure::Library(Error::Interrupted(_))) = error {
            return Err(stopped);
        }
        let seconds = begun.elapsed().as_secs_f64();
        let values = plan.values(run);
        self.tell(&format!(
            "{:>width$}/{count}  {}  {outcome}  {seconds:.3} s",
            run + 1,
            values.join("  "),
            width = count.to_string().len()
        ));
        for finding in summary.iter().flat_map(|s| &s.findings) {
            // What is wrong with the model is mostly wrong with it in every run.
            let line = found(finding);
            let before_the_run = finding.step.is_none() && finding.severity >= Severity::Warning;
            if before_the_run && !self.told.contains(&line) {
                self.tell(&format!("  {line}"));
                self.told.push(line);
            }
        }
        for note in summary.iter().flat_map(|s| &s.notes) {
            self.tell(&format!("  {note}"));
        }
        let row = Row {
            values: values.into_iter().map(str::to_string).collect(),
            outcome,
            ..Row::default()
        };
        Ok(Done {
            effort: effort::line(run + 1, seconds, summary.as_ref()),
            row: row.with_summary(summary),
            names: columns.names,
            processor: processor(),
        })
    }
}

/// The axes, in the order in which the lines below have their values.
fn heading(plan: &Plan) -> String {
    let axes = plan.axes.iter();
    let axes: Vec<String> = axes
        .map(|axis| format!("{} ({})", axis.path, axis.values.len()))
        .collect();
    let by = if plan.zip { ", " } else { " × " };
    format!("{}: {}", runs(plan.count()), axes.join(by))
}

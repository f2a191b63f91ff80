//! `sweep --merge`: the folders of shards, one table: that of the sweep in one process, byte for byte.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use stickslip::Error;
use stickslip::results::FileClaim;

use super::done::{Done, ended};
use super::plan::{folder_of_run, runs};
use super::shard::Shard;
use super::table::Table;
use crate::failure::{Failure, Outcome};

/// Most runs and reasons that are named one by one.
const MOST_NAMED: usize = 12;

/// Merges the shards in these folders. `results` is the folder that has those of the runs, to see whether all are there.
pub fn merge(
    folders: &[PathBuf],
    output: Option<&Path>,
    results: Option<&Path>,
    tell: &dyn Fn(&str),
) -> Outcome {
    let found = find(folders)?;
    let shards = found.iter().map(|folder| Shard::read(folder));
    let shards = shards.collect::<Result<Vec<_>, Error>>()?;
    let output = match output {
        Some(output) => output.to_path_buf(),
        None => beside(&found)?,
    };
    let Some(first) = shards.first() else {
        return Err(none(&folders[0]));
    };
    for other in &shards {
        if let Some(what) = other.foreign_to(first) {
            return Err(Failure::Arguments(
                format!(
                    "{} and {} are shards of different sweeps: {what}",
                    first.folder.display(),
                    other.folder.display()
                ),
                "name the folders of one sweep".into(),
            ));
        }
    }
    let rows = one_row_a_run(&shards)?;
    refuse_missing(&shards, &rows)?;
    if let Some(results) = results {
        refuse_without_results(first, results, &rows)?;
    }
    tell_processors(&rows, tell);

    let axes = first.sweep.plan.axes.iter().map(|axis| axis.path.clone());
    let mut table = Table::new(output, axes.collect(), &first.sweep.columns);
    spare_inputs(first, &table.path)?;
    table.try_file()?;
    let _claim = FileClaim::take(&table.path)?;
    rows.values().for_each(|(_, done)| table.add(done));
    table.write()?;
    let parts = match shards.len() {
        1 => "1 shard".to_string(),
        n => format!("{n} shards"),
    };
    tell(&format!(
        "{} of {parts}; table in {}",
        runs(rows.len()),
        table.path.display()
    ));
    ended(table.rows().iter(), table.path.clone())
}

/// Refuses to write over a file that the sweep reads.
fn spare_inputs(shard: &Shard, output: &Path) -> Result<(), Failure> {
    if output.is_file() && shard.sweep.reads(output)? {
        return Err(Failure::Arguments(
            format!("{}: an input is never written to", output.display()),
            "give the output another name".into(),
        ));
    }
    Ok(())
}

/// The folders of shards: those that are named, and those in folders that are named.
fn find(folders: &[PathBuf]) -> Result<Vec<PathBuf>, Failure> {
    let mut found: Vec<PathBuf> = Vec::new();
    let mut known = Vec::new();
    for folder in folders {
        if !folder.is_dir() {
            let what = match folder.exists() {
                true => "this is a file, and folders of shards are merged",
                false => "there is no such folder",
            };
            return Err(Failure::Arguments(
                format!("{}: {what}", folder.display()),
                HELP.into(),
            ));
        }
        let mut inside = vec![folder.clone()];
        if !Shard::is_one(folder) {
            let entries = fs::read_dir(folder).map_err(|e| Error::io(folder, e))?;
            let entries = entries.flatten().map(|entry| entry.path());
            inside = entries.filter(|path| Shard::is_one(path)).collect();
            inside.sort();
        }
        if inside.is_empty() {
            return Err(none(folder));
        }
        for path in inside {
            // The same folder by two names is one.
            let same = path.canonicalize().map_err(|e| Error::io(&path, e))?;
            if !known.contains(&same) {
                known.push(same);
                found.push(path);
            }
        }
    }
    Ok(found)
}

const HELP: &str = "`stickslip sweep FILE --set ... --shard i/n` makes folders of shards, in `TABLE.shards` where TABLE.csv is the table";

/// What is said of a folder without shards.
fn none(folder: &Path) -> Failure {
    let what = match folder.join("summary.json").is_file() {
        true => "these are results of a run, and no shard of a sweep",
        false => "there is no shard of a sweep in this folder",
    };
    Failure::Arguments(format!("{}: {what}", folder.display()), HELP.into())
}

/// The table that goes with folders in `TABLE.shards`.
fn beside(found: &[PathBuf]) -> Result<PathBuf, Failure> {
    let first = found.first().and_then(|folder| folder.parent());
    let shards = first.filter(|folder| folder.extension().is_some_and(|e| e == "shards"));
    let table = shards.map(|folder| folder.with_extension("csv"));
    table.ok_or_else(|| {
        Failure::Arguments(
            "these folders do not say where the table belongs".into(),
            "name it: -o TABLE.csv".into(),
        )
    })
}

/// Rows with the shard they are of, by run.
type Rows<'a> = BTreeMap<usize, (&'a Shard, &'a Done)>;

fn one_row_a_run(shards: &[Shard]) -> Result<Rows<'_>, Failure> {
    let mut rows = Rows::new();
    for shard in shards {
        for (&run, done) in &shard.done {
            if let Some((other, _)) = rows.insert(run, (shard, done)) {
                return Err(Failure::Arguments(
                    format!(
                        "run {} is in two shards: {} and {}",
                        run + 1,
                        other.folder.display(),
                        shard.folder.display()
                    ),
                    "name one of them: copies of a folder, and parts of different divisions, have the same runs"
                        .into(),
                ));
            }
        }
    }
    Ok(rows)
}

/// Refuses to make half of a table: says which runs are missing, and whose they are.
fn refuse_missing(shards: &[Shard], rows: &Rows) -> Result<(), Failure> {
    let count = shards.first().map_or(0, |shard| shard.sweep.plan.count());
    let missing: Vec<usize> = (0..count).filter(|run| !rows.contains_key(run)).collect();
    if missing.is_empty() {
        return Ok(());
    }
    let mut left = missing.clone();
    let mut reasons = Vec::new();
    for shard in shards {
        let own = |run: &usize| run % shard.share.of == shard.share.index - 1;
        let of_it: Vec<usize> = left.iter().copied().filter(own).collect();
        left.retain(|run| !own(run));
        if !of_it.is_empty() {
            let state = match shard.holder() {
                Some(holder) => format!("{holder} is at it"),
                None => "it goes on with the command that began it".into(),
            };
            reasons.push(format!(
                "shard {} in {} lacks {}: {state}",
                shard.share,
                shard.folder.display(),
                named(&of_it)
            ));
        }
    }
    let of = shards.first().map_or(1, |shard| shard.share.of);
    if !left.is_empty() {
        let mut indices: Vec<usize> = left.iter().map(|run| run % of + 1).collect();
        indices.sort_unstable();
        indices.dedup();
        let names: Vec<String> = indices
            .iter()
            .take(MOST_NAMED)
            .map(|i| format!("{i}/{of}"))
            .collect();
        let more = match indices.len() > MOST_NAMED {
            true => ", …",
            false => "",
        };
        reasons.push(format!(
            "{} would be in shards that are not named: {}{more}",
            named(&left),
            names.join(", ")
        ));
    }
    Err(Failure::Arguments(
        format!(
            "{} of {count} runs are missing: {}",
            missing.len(),
            named(&missing)
        ),
        reasons.join("; "),
    ))
}

/// Runs in a few words: `runs 2, 6 to 9, 12`.
fn named(all: &[usize]) -> String {
    let mut spans: Vec<(usize, usize)> = Vec::new();
    for &run in all {
        match spans.last_mut() {
            Some((_, last)) if *last + 1 == run => *last = run,
            _ => spans.push((run, run)),
        }
    }
    let words = spans
        .iter()
        .take(MOST_NAMED)
        .map(|&(from, to)| match to - from {
            0 => format!("{}", from + 1),
            1 => format!("{}, {}", from + 1, to + 1),
            _ => format!("{} to {}", from + 1, to + 1),
        });
    let words: Vec<String> = words.collect();
    let more = if spans.len() > MOST_NAMED {
        ", …"
    } else {
        ""
    };
    let noun = if all.len() == 1 { "run" } else { "runs" };
    format!("{noun} {}{more}", words.join(", "))
}

/// Refuses where results of runs are not in the folder that shall have them.
fn refuse_without_results(first: &Shard, results: &Path, rows: &Rows) -> Result<(), Failure> {
    if !first.sweep.results {
        return Err(Failure::Arguments(
            format!(
                "{}: these shards kept no results of runs",
                results.display()
            ),
            "merge without --results, or make the shards with it".into(),
        ));
    }
    // A run that could not be built has none.
    let made = rows
        .iter()
        .filter(|(_, (_, done))| done.row.counts.is_some());
    let lacks = |run: usize| !folder_of_run(results, run).join("summary.json").is_file();
    let lacking: Vec<usize> = made
        .map(|(run, _)| *run)
        .filter(|run| lacks(*run))
        .collect();
    match lacking.is_empty() {
        true => Ok(()),
        false => Err(Failure::Arguments(
            format!("{}: results of {} are not there", results.display(), named(&lacking)),
            "bring the folders of runs together first: their numbers are those of the whole sweep, so that none has the name of another".into(),
        )),
    }
}

/// Says so where runs were made on processors of several kinds.
fn tell_processors(rows: &Rows, tell: &dyn Fn(&str)) {
    let mut kinds: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
    for (&run, (_, done)) in rows {
        kinds.entry(&done.processor).or_default().push(run);
    }
    if kinds.len() > 1 {
        let kinds: Vec<String> = kinds
            .iter()
            .map(|(kind, all)| format!("{kind} ({})", named(all)))
            .collect();
        tell(&format!(
            "runs were made on processors of different kinds, so that last digits may not be those of one machine: {}",
            kinds.join(", ")
        ));
    }
}

#[cfg(test)]
mod tests {
    use super::named;

    #[test]
    fn runs_are_named_in_a_few_words() {
        assert_eq!(named(&[4]), "run 5");
        assert_eq!(named(&[0, 1, 3, 4, 5, 9]), "runs 1, 2, 4 to 6, 10");
        let many: Vec<usize> = (0..40).step_by(2).collect();
        assert!(named(&many).ends_with(", 21, 23, …"), "{}", named(&many));
    }
}

use std::path::PathBuf;
use std::process::ExitCode;

use stickslip::machine::bytes;
use stickslip::problem::Problem;
use stickslip::run::Sizes;

use crate::failure::Outcome;
use crate::input::Input;
use crate::print;

/// Read a problem file or a deck, and report errors, warnings and what was understood.
#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// The problem file, or an input deck of Abaqus or CalculiX (`.inp`).
    file: PathBuf,
    /// Change a value, for example interface.base.friction.coulomb.mu=0.3.
    #[arg(long = "set", value_name = "PATH=VALUE")]
    set: Vec<String>,
    /// Print the report as JSON: bodies, interfaces with their gaps, rigid-body modes, findings.
    #[arg(long)]
    json: bool,
}

/// Checks the file.
pub fn run(arguments: &Arguments) -> Outcome {
    let input = Input::open(&arguments.file, &arguments.set)?;
    let mut notes = input.notes(true);
    let lint = input.deck.iter().flat_map(|d| &d.lint);
    notes.extend(lint.map(ToString::to_string));
    if !arguments.json {
        print::out(&summary(&input.problem))?;
        if !notes.is_empty() {
            print::out(&(notes.join("\n") + "\n"))?;
        }
    }
    let setup = input.build()?;
    let mut simulation = stickslip::run::Simulation::new(setup)?;
    let sizes = simulation.sizes();
    let report = simulation.check();
    let text = match arguments.json {
        false => report.to_string() + &files(&sizes),
        true => {
            let mut value = serde_json::to_value(&report).map_err(std::io::Error::other)?;
            if let Some(all) = value.as_object_mut() {
                all.insert("files".into(), serde_json::json!(sizes));
            }
            format!("{value:#}\n")
        }
    };
    print::out(&text)?;
    Ok(ExitCode::SUCCESS)
}

/// What a run will write.
fn files(sizes: &Sizes) -> String {
    let Sizes {
        increments,
        checkpoint,
        fields,
        outputs,
        row,
        rows,
        ..
    } = *sizes;
    format!(
        "files of a run of about {increments} increments\n  history.csv: {rows} rows, up to {}\n  fields: {outputs} times, up to {} each before compression\n  checkpoints: up to {}, two are kept\n",
        bytes(rows.saturating_mul(row)),
        bytes(fields),
        bytes(checkpoint)
    )
}

/// What was understood, a line a table.
fn summary(problem: &Problem) -> String {
    let mut lines = Vec::new();
    if let Some(title) = &problem.title {
        lines.push(title.clone());
    }
    lines.push(format!("model: {}", problem.model.space.name()));
    for (table, names) in [
        ("bodies", names(&problem.body)),
        ("materials", names(&problem.material)),
        ("obstacles", names(&problem.obstacle)),
        ("sets", names(&problem.set)),
        ("reference points", names(&problem.reference)),
        ("loads", names(&problem.load)),
        ("temperatures", names(&problem.temperature)),
        ("supports", names(&problem.support)),
        ("probes", names(&problem.probe)),
    ] {
        if !names.is_empty() {
            lines.push(format!("{table}: {names}"));
        }
    }
    for (name, interface) in &problem.interface {
        use stickslip::registry::Family;
        lines.push(format!(
            "interface {name}: {} on {}; {}, {}, {}, {}, {}",
            interface.secondary,
            interface.primary,
            interface.normal.kind(),
            interface.friction.kind(),
            interface.slip.kind(),
            interface.enforcement.kind(),
            interface.kinematics.kind(),
        ));
    }
    let mut start = 0.0;
    for (i, step) in problem.step.iter().enumerate() {
        let name = step.name.clone().unwrap_or(format!("step {}", i + 1));
        let end = start + step.duration;
        lines.push(format!("step {}: {name}, time {start} to {end}", i + 1));
        start = end;
    }
    lines.join("\n") + "\n"
}

fn names<T>(table: &std::collections::BTreeMap<String, T>) -> String {
    let names: Vec<&str> = table.keys().map(String::as_str).collect();
    names.join(", ")
}

//! Developer tasks: `cargo xtask TASK`.

mod book;
mod browser;
mod dist;
mod engine;
mod fuzz;
mod published;
mod release;
mod tools;

use std::process::ExitCode;

const USAGE: &str = "\
usage: cargo xtask TASK

tasks:
  book [--pages] [--verification [--full]]
                            write the generated pages of the book and build it into target/book, with mdBook, which is installed into
                            target/tools where it is missing; --pages only writes pages; --verification runs all examples first and
                            writes their numbers, with --full those that take minutes too
  browser [--if-possible]   open reports of two examples in headless Chromium and use them; installs Chromium (apt-get) and
                            playwright-core (npm) where it may. With --if-possible it says NOT RUN where they cannot be had
  engine mumps [--if-possible]
                            compile engines/mumps into target/engines, where `solver.engine.mumps` finds it; needs mpicc and MUMPS, which it
                            installs (apt-get) where it may. With --if-possible it says NOT RUN where they cannot be had
  schema                    write stickslip.schema.json, the JSON schema of problem files
  rooms                     draw the picture of the rooms in ARCHITECTURE.md from the imports of the code
  dist                      build a static binary and pack it with completions, manual pages, schema and licences into dist/
  release --dry-run [--archive FILE] [--wheel FILE]
                            build what a release gives away into dist/ (the archive of `dist`, the wheel, a list of the crates in them, checksums)
                            and try it where there is no compiler and no environment; or what has been built elsewhere. Says NOT RUN where
                            cargo-deny is not installed
  decks [FOLDER]            run decks with the numbers that CalculiX prints (NAME.inp, NAME.dat.ref; default: ../shared/decks/calculix)
                            and write book/verification/src/decks.md
  digests FILE [--problems N] [DECKS]
                            run all tested examples, N random problems (default 60) and the decks of a folder (default as above), and write
                            digests of their histories, fields and other files to FILE; where FILE is there already, compare with it and list
                            what differs, with the largest difference of a history. For changes that shall not change results
  fuzz TARGET SECONDS       fuzz what reads files: toml, msh, vtu, checkpoint or inp (needs cargo-fuzz)
  kill [--kills N] [--seed S] [CASE ...]
                            kill runs of seven cases (statics, implicit, explicit, sweep, deck, multigrid, condensed) at N random times (default 200)
                            and take them up again; fails if one comes to other files than a run that never stopped
  walk [--damages N] [--seed S]
                            set every numeric key of the examples to numbers that make no sense, check and begin to run them, and check N damaged
                            meshes, decks and problem files (default 3000); fails if the binary panics, or if a check does not end
  house                     count the code of the library, room by room: lines, types, methods, functions that are long, put-backs, constants
  chatter                   run cases in which many points change status and print a table of iterations and fallbacks
  peers [FIGURE] [N ...]    measure, side by side with CalculiX where `ccx` is installed, and print tables in Markdown.
                            Without a figure: slide and bar
  robustness [--seed S] [--from N] [--count N] [--keep DIR] [FILE ...]
                            run random problems (default: numbers 1 to 300 of series 1) or the given files, audit what they write by
                            means of their own, and print a table, a verdict on each and a summary in Markdown; fails if a result is
                            wrong with exit 0 or if the quality gate fails a result for nothing. Results are kept in DIR; those that
                            are not sound in target/robustness in any case
  mixes [--seed S] [--from N] [--count N] [--keep DIR] [--binary FILE]
                            run random mixes of features (default: numbers 1 to 300 of series 1), each of them and a second run or two that must
                            agree with it: in other units, mirrored, on another mesh, by another way to solve, resumed. Prints a table and a summary
                            as `robustness` does; results that are not sound are kept in target/mixes

figures:
  slide [N ...]             press-and-slide with N cells an edge (default 11 18), stick and slip
  bar                       the impact of a steel bar, explicit and implicit
  growth [METHOD] [N ...]   time and memory over the number of unknowns, condensed and multigrid or one of them; writes growth.svg
  fretting                  100 increments of a fretting loop, two sizes
  sweep [N [RUNS]]          a parameter study of 50 coefficients of friction (default N = 18)
  shapes [K ...]            six shapes: the chosen method and what each method takes; K from 1 chooses some
  threads [N]               one and two threads on two equal bodies (default N = 24)

The release binary is built first, unless STICKSLIP names one. CCX names CalculiX if it is not `ccx`.";

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let result = match arguments.split_first() {
        Some((task, _)) if tools::TASKS.contains(&task.as_str()) => return tools::run(&arguments),
        Some((task, [])) if task == "schema" => published::schema(),
        Some((task, [])) if task == "rooms" => published::rooms(),
        Some((task, what)) if task == "engine" => engine::build(what),
        Some((task, [])) if task == "dist" => dist::pack().map(|_| ()),
        Some((task, what)) if task == "release" => release::run(what),
        Some((task, what)) if task == "book" => book::build(what),
        Some((task, what)) if task == "fuzz" => fuzz::run(what),
        Some((task, what)) if task == "browser" => browser::check(what),
        _ => Err(USAGE.to_string()),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("{message}");
            ExitCode::FAILURE
        }
    }
}

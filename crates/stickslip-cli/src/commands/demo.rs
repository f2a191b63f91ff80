use std::path::{Path, PathBuf};

use stickslip::Error;
use stickslip::io::{csv, write_atomically};
use stickslip::number::digits;
use stickslip_report::{Limits, plot};

use super::run::{self, Manner};

use crate::browser;
use crate::failure::{Failure, Outcome};
use crate::print;
use crate::style::WIDTH;

/// The example `lug`, with its mesh: what it computes is checked by the tests of the library.
const DEMO_FILES: [(&str, &str); 2] = [
    (
        "lug.toml",
        include_str!("../../../../examples/lug/case.toml"),
    ),
    ("lug.msh", include_str!("../../../../examples/lug/lug.msh")),
];

const STORY: &str = "A steel pin is pressed into the bronze bush of an aluminium lug, pulled with 20 kN, and let go. Nothing but contact holds \
     the pin: its rim sticks, slips and lifts off as the load comes and goes.";

/// Run a built-in example, a pin in a lug, and open its report in the browser.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
The folder gets the problem (lug.toml) with its mesh, to be changed and run again, and the results in lug.out.
The environment variable BROWSER chooses the browser; default: that of the system.")]
pub struct Arguments {
    /// The folder to write; created if it does not exist.
    #[arg(default_value = "stickslip-demo")]
    directory: PathBuf,
    /// Do not open the report.
    #[arg(long)]
    no_open: bool,
    /// Number of threads; default: all processors. Results do not depend on it.
    #[arg(long, value_name = "N")]
    threads: Option<usize>,
    /// No progress on standard error.
    #[arg(short, long)]
    quiet: bool,
}

/// Writes the example, runs it, and shows what came of it.
pub fn run(arguments: &Arguments) -> Outcome {
    let folder = &arguments.directory;
    write(folder)?;
    print::out(&print::wrap(STORY, 0, WIDTH))?;
    let (problem, results) = (folder.join(DEMO_FILES[0].0), folder.join("lug.out"));
    let manner = Manner::new(arguments.threads, arguments.quiet);
    let code = run::run(&run::Arguments::of(&problem, &results, manner))?;
    let (pictures, _) = plot::picture(&results, None, &plot::Picture::default())?;
    let report = stickslip_report::report(&results, None, Limits::default())?;

    let mut text = seen(&results)?;
    let mut place = |what: &str, path: &Path| text += &format!("{what:<9}{}\n", path.display());
    place("problem", &problem);
    for picture in &pictures {
        place("picture", picture);
    }
    place("report", &report.file);
    print::out(&text)?;
    let next = match !arguments.no_open && browser::open(&report.file) {
        true => "the report is open in your browser: turn the bodies, go through the times",
        false => "open the report in a browser: turn the bodies, go through the times",
    };
    print::out(&format!(
        "{next}\nnext: change the friction and run it again, and see how much more or less of the pin slips\n  \
         stickslip run {} --set interface.fit.friction.coulomb.mu=0.1 -o {}\n",
        problem.display(),
        folder.join("smoother.out").display()
    ))?;
    Ok(code)
}

/// Writes the files of the example. What is there already under their names has to be the same: it may be somebody's work.
fn write(folder: &Path) -> Result<(), Failure> {
    for (name, content) in DEMO_FILES {
        // In the folder of the example the schema is that of the repository.
        let content = content.replacen("#:schema ../../", "#:schema ./", 1);
        let path = folder.join(name);
        match std::fs::read(&path) {
            Ok(there) if there == content.as_bytes() => continue,
            Ok(_) => {
                return Err(Failure::Arguments(
                    format!("{}: this file has been changed, and is not written over", path.display()),
                    "name another folder for the demo, or run the changed problem with `stickslip run`".into(),
                ));
            }
            Err(_) => {}
        }
        std::fs::create_dir_all(folder).map_err(|e| Error::io(folder, e))?;
        write_atomically(&path, content.as_bytes())?;
    }
    Ok(())
}

/// What came out, in a few sentences, from the results themselves.
fn seen(results: &Path) -> Result<String, Error> {
    let history = csv::read(&results.join("history.csv"))?;
    let columns = [
        "TIME", "fit.CFN2", "fit.CFS2", "ALLFD", "OPEN", "STICK", "SLIP",
    ];
    let columns = columns.map(|name| history.column(name).unwrap_or_default());
    let [time, ..] = columns;
    let value = |column: usize, row: usize| columns[column].get(row).copied().unwrap_or(f64::NAN);
    let full = time.iter().position(|t| *t >= 2.0).unwrap_or_default();
    let last = time.len().saturating_sub(1);
    let kilo = |force: f64| digits(force / 1e3, 3);
    let text = format!(
        "At 20 kN pressure carries {} kN and friction {} kN of the load; {} points of the hole slip, {} stick, {} have lifted off. \
         After the release pressure and friction still hold each other in balance with {} kN, and {} J are lost to friction: \
         a joint remembers its load.",
        kilo(value(1, full)),
        kilo(value(2, full)),
        value(6, full),
        value(5, full),
        value(4, full),
        kilo(value(1, last).abs()),
        digits(value(3, last), 3),
    );
    Ok(print::wrap(&text, 0, WIDTH))
}

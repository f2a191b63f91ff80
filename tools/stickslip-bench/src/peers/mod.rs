//! `cargo xtask peers`: what stickslip takes, and what CalculiX takes for the same problems, one thread each, one after the other.

mod bar;
mod bench;
mod cpu;
mod deck;
mod fretting;
mod growth;
mod plot;
mod shapes;
mod slide;
mod sweep;
pub mod table;
mod threads;

use bench::Bench;

/// Measures what the command line names and prints tables.
pub fn compare(words: &[String]) -> Result<(), String> {
    let (figure, rest) = match words.split_first() {
        Some((word, rest)) if word.parse::<usize>().is_err() => (word.as_str(), rest),
        _ => ("", words),
    };
    let sizes = |least: usize, most: usize| {
        let counts = rest.iter().map(|s| s.parse().ok());
        let counts = counts.map(|n| n.filter(|n| (least..=most).contains(n)));
        let counts: Option<Vec<usize>> = counts.collect();
        counts.ok_or_else(|| format!("{figure}: sizes are whole numbers from {least} to {most}"))
    };
    let none = || match rest {
        [] => Ok(()),
        [word, ..] => Err(format!("{figure} takes nothing more, but there is {word}")),
    };
    let bench = Bench::new()?;
    println!("load averages at the start: {}", cpu::load());
    match figure {
        "" => {
            slide::measure(&bench, &sizes(2, 200)?)?;
            bar::measure(&bench)?;
        }
        "slide" => slide::measure(&bench, &sizes(2, 200)?)?,
        "bar" => none().and_then(|()| bar::measure(&bench))?,
        "growth" => growth::measure(&bench, rest)?,
        "fretting" => none().and_then(|()| fretting::measure(&bench))?,
        "sweep" => sweep::measure(&bench, &sizes(2, 1000)?)?,
        "shapes" => shapes::measure(&bench, &sizes(1, shapes::COUNT)?)?,
        "threads" => threads::measure(&bench, &sizes(2, 200)?)?,
        _ => {
            return Err(format!(
                "no figure {figure}: there are slide, bar, growth, fretting, sweep, shapes and threads"
            ));
        }
    }
    println!(
        "\nload averages at the end: {}; results: {}",
        cpu::load(),
        bench.scratch.display()
    );
    Ok(())
}

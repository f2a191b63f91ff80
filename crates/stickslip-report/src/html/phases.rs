//! Where the time went.

use super::facts::seconds;
use crate::results::Results;
use stickslip::number::figure;

/// Bars of the phases of the run.
pub fn section(results: &Results) -> String {
    let p = &results.summary["phases"];
    let Some(total) = p["total"].as_f64().filter(|t| *t > 0.0) else {
        return String::new();
    };
    let words = [
        ("read", "reading and meshing"),
        ("assemble", "assembly of the bodies"),
        ("order", "ordering"),
        ("factor", "factorisation"),
        ("condense", "condensation"),
        ("iterate", "linear systems of Newton"),
        ("contact", "contact search and assembly"),
        ("recover", "interiors of bodies"),
        ("write", "writing results"),
    ];
    let mut rows: Vec<(&str, f64)> = words
        .iter()
        .filter_map(|(key, word)| Some((*word, p[*key].as_f64()?)))
        .collect();
    let known: f64 = rows.iter().map(|(_, t)| t).sum();
    rows.push(("everything else", (total - known).max(0.0)));
    rows.retain(|(_, t)| *t > 0.0);
    rows.sort_by(|a, b| b.1.total_cmp(&a.1));
    let mut out = String::from("<ul class=\"phases\">\n");
    for (word, t) in &rows {
        let share = 100.0 * t / total.max(known);
        out += &format!(
            "<li><span>{word}</span><span class=\"bar\" aria-hidden=\"true\"><i style=\"width:{share:.1}%\"></i></span><span class=\"n\">{} ({share:.0} %)</span></li>\n",
            seconds(*t)
        );
    }
    out += "</ul>\n";
    let s = &results.summary;
    let mut facts = vec![format!("{} in all", seconds(total))];
    if let Some(n) = s["threads"].as_u64() {
        facts.push(match n {
            1 => "1 thread".into(),
            n => format!("{n} threads"),
        });
    }
    if let Some(bytes) = s["peak-memory"].as_f64().filter(|b| *b > 0.0) {
        facts.push(format!("{:.0} MB of memory at most", bytes / 1e6));
    }
    if let Some(times) = s["relative-to-linear"].as_f64().filter(|t| *t > 0.0) {
        facts.push(format!(
            "{} times one linear solution of the same bodies",
            figure(times)
        ));
    }
    out += &format!("<p class=\"quiet\">{}</p>\n", facts.join(" · "));
    out
}

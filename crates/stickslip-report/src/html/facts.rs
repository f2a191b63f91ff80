//! What the summary says: outcome, quality, convergence, energies, times.

use serde_json::Value;
use stickslip::simulation::doctor::Finding;

use super::escape::text;
use crate::results::Results;

/// A number in few digits.
pub fn number(value: f64) -> String {
    let size = value.abs();
    if value == 0.0 {
        "0".into()
    } else if !value.is_finite() {
        value.to_string()
    } else if (1e-3..1e6).contains(&size) {
        let digits = (3 - size.log10().floor() as i32).clamp(0, 6) as usize;
        let shown = format!("{value:.digits$}");
        match shown.contains('.') {
            true => shown.trim_end_matches('0').trim_end_matches('.').into(),
            false => shown,
        }
    } else {
        let text = format!("{value:.3e}");
        match text.split_once('e') {
            Some((mantissa, exponent)) => {
                let mantissa = mantissa.trim_end_matches('0').trim_end_matches('.');
                format!("{mantissa}e{exponent}")
            }
            None => text,
        }
    }
}

fn count(value: &Value) -> String {
    value.as_u64().map_or_else(|| "-".into(), |n| n.to_string())
}

fn seconds(value: f64) -> String {
    match value {
        v if v >= 100.0 => format!("{v:.0} s"),
        v if v >= 1.0 => format!("{v:.1} s"),
        v => format!("{:.0} ms", 1e3 * v),
    }
}

/// A mark that says by word and shape, not by colour alone.
fn mark(kind: &str, words: &str) -> String {
    let sign = match kind {
        "good" => "✓",
        "bad" => "✕",
        _ => "!",
    };
    format!("<span class=\"mark {kind}\"><span aria-hidden=\"true\">{sign}</span> {words}</span>")
}

/// A table; the first row holds the headings. The cells are HTML.
fn table(class: &str, caption: &str, heads: &[&str], rows: &[Vec<String>]) -> String {
    let mut out = format!(
        "<div class=\"wide\" tabindex=\"0\" role=\"region\" aria-label=\"{caption}\"><table class=\"{class}\"><caption>{caption}</caption><thead><tr>"
    );
    for head in heads {
        out += &format!("<th scope=\"col\">{head}</th>");
    }
    out += "</tr></thead><tbody>";
    for row in rows {
        out += "<tr>";
        for (i, cell) in row.iter().enumerate() {
            out += &match i {
                0 => format!("<th scope=\"row\">{cell}</th>"),
                _ => format!("<td>{cell}</td>"),
            };
        }
        out += "</tr>";
    }
    out + "</tbody></table></div>\n"
}

/// Title and outcome.
pub fn header(results: &Results, title: &str) -> String {
    let s = &results.summary;
    let mut marks = String::new();
    let mut outcome = String::new();
    if s.is_null() {
        marks += &mark("warn", "not finished");
    } else if s["completed"].as_bool() == Some(true) {
        marks += &mark("good", "finished");
    } else {
        marks += &mark("bad", "stopped");
        let said = s["outcome"].as_str().unwrap_or_default();
        outcome = format!("<p class=\"outcome\">{}</p>", text(said));
    }
    let quality = &s["quality"];
    let judged = quality["figures"].as_array().map_or(0, Vec::len);
    match (quality["met"].as_bool(), judged) {
        (_, 0) | (None, _) => marks += &mark("warn", "quality not judged"),
        (Some(true), _) => marks += &mark("good", "quality limits kept"),
        (Some(false), _) => marks += &mark("bad", "quality limits missed"),
    }
    let findings = s["findings"].as_array().map_or(0, Vec::len);
    if findings > 0 {
        let words = match findings {
            1 => "1 finding of the doctor".into(),
            n => format!("{n} findings of the doctor"),
        };
        marks += &mark("warn", &words);
    }
    let mut facts = Vec::new();
    let size = &s["size"];
    for (key, word) in [
        ("points", "points"),
        ("cells", "cells"),
        ("contact-points", "contact points"),
    ] {
        if let Some(n) = size[key].as_u64() {
            facts.push(format!("<b>{n}</b> {word}"));
        }
    }
    for (key, word) in [
        ("increments", "increments"),
        ("iterations", "Newton iterations"),
    ] {
        if let Some(n) = s[key].as_u64() {
            facts.push(format!("<b>{n}</b> {word}"));
        }
    }
    if let Some(total) = s["phases"]["total"].as_f64() {
        facts.push(format!("<b>{}</b>", seconds(total)));
    }
    let list: String = facts.iter().map(|f| format!("<li>{f}</li>")).collect();
    format!(
        "<header>\n<div class=\"inner\"><p class=\"brand\">stickslip report</p>\n<h1>{title}</h1>\n<p class=\"marks\">{marks}</p>\n{outcome}<ul class=\"facts\">{list}</ul>\n\
         <nav aria-label=\"Sections\"><a href=\"#result\">Result</a><a href=\"#solved\">Problem</a><a href=\"#quality\">Quality</a>\
         <a href=\"#convergence\">Convergence</a><a href=\"#energy\">Energy</a><a href=\"#history\">History</a><a href=\"#time\">Time</a></nav></div>\n</header>\n"
    )
}

/// The figures of the quality gate beside their limits.
pub fn quality(results: &Results) -> String {
    let gate = &results.summary["quality"];
    let Some(figures) = gate["figures"].as_array().filter(|f| !f.is_empty()) else {
        return "<p class=\"quiet\">No figure was judged.</p>\n".into();
    };
    let mut rows: Vec<(bool, Vec<String>)> = figures
        .iter()
        .map(|f| {
            let (value, limit) = (f["value"].as_f64(), f["limit"].as_f64());
            let met = f["met"].as_bool().unwrap_or(true);
            let share = match (value, limit) {
                (Some(v), Some(l)) if l > 0.0 => Some(v / l),
                _ => None,
            };
            let verdict = match (met, share) {
                (false, _) => mark("bad", "above the limit"),
                (true, Some(s)) if s > 0.5 => mark("warn", "near the limit"),
                (true, Some(_)) => mark("good", "kept"),
                (true, None) => "<span class=\"quiet\">not judged</span>".into(),
            };
            let bar = share.map_or_else(String::new, |s| {
                format!(
                    "<span class=\"bar\" aria-hidden=\"true\"><i style=\"width:{:.1}%\" class=\"{}\"></i></span>",
                    100.0 * s.clamp(0.0, 1.0),
                    if !met { "bad" } else if s > 0.5 { "warn" } else { "good" }
                )
            });
            let shown = |v: Option<f64>| v.map_or_else(|| "-".into(), number);
            let cells = vec![
                text(f["figure"].as_str().unwrap_or("?")).replace('-', " "),
                text(f["place"].as_str().unwrap_or("?")),
                verdict,
                shown(value),
                shown(limit),
                bar,
                shown(f["time"].as_f64()),
            ];
            (met, cells)
        })
        .collect();
    rows.sort_by_key(|(met, _)| *met);
    let rows: Vec<Vec<String>> = rows.into_iter().map(|(_, cells)| cells).collect();
    let lead = match gate["met"].as_bool() {
        Some(false) => {
            "<p>At least one figure is above its limit: look at it before you use the results.</p>\n"
        }
        _ => {
            "<p>The worst of each figure over all increments, beside the limit of the problem. All are without dimension.</p>\n"
        }
    };
    lead.to_string()
        + &table(
            "figures",
            "Quality figures",
            &[
                "figure",
                "where",
                "verdict",
                "value",
                "limit",
                "value over limit",
                "at time",
            ],
            &rows,
        )
}

/// Iterations, and what went wrong on the way.
pub fn convergence(results: &Results) -> String {
    let s = &results.summary;
    let mut out = String::new();
    if let Some(method) = s["method"].as_str().filter(|m| !m.is_empty()) {
        out += &format!(
            "<p>Systems of equations were solved by the method <b>{}</b>. {} increments were accepted with {} Newton iterations; \
             {} attempts were cut back, {} more to find changes of status in time.</p>\n",
            text(method),
            count(&s["increments"]),
            count(&s["iterations"]),
            count(&s["cutbacks"]),
            count(&s["events"]),
        );
    }
    out += "<div class=\"plots\" id=\"convergence-plots\"></div>\n";
    let findings = s["findings"].as_array().map_or(&[][..], Vec::as_slice);
    if !findings.is_empty() {
        out += "<h3>What the doctor found</h3>\n<ul class=\"findings\">\n";
        for f in findings {
            out += &format!("<li>{}</li>\n", finding(f));
        }
        out += "</ul>\n";
    }
    out += &listed("Notes", &s["notes"], true);
    out += &listed("Cut-backs", &s["cutback-reasons"], false);
    let fallbacks = s["fallbacks"].as_array().map_or(&[][..], Vec::as_slice);
    if !fallbacks.is_empty() {
        let shown = |v: &Value| v.as_f64().map_or_else(|| "-".into(), number);
        let rows: Vec<Vec<String>> = fallbacks
            .iter()
            .map(|f| {
                vec![
                    text(f["step"].as_str().unwrap_or("?")),
                    shown(&f["from"]),
                    shown(&f["to"]),
                    text(f["kind"].as_str().unwrap_or("?")).replace('-', " "),
                    count(&f["iterations"]),
                    match f["converged"].as_bool() {
                        Some(true) => mark("good", "converged"),
                        _ => mark("warn", "did not converge"),
                    },
                ]
            })
            .collect();
        out += &format!(
            "<details><summary>Where plain iteration did not converge: {} attempts by other ways</summary>\n{}</details>\n",
            rows.len(),
            table(
                "plain",
                "Fallbacks",
                &["step", "from", "to", "way", "iterations", "outcome"],
                &rows
            )
        );
    }
    out
}

fn listed(heading: &str, list: &Value, open: bool) -> String {
    let Some(list) = list.as_array().filter(|l| !l.is_empty()) else {
        return String::new();
    };
    let items: String = list
        .iter()
        .map(|line| format!("<li>{}</li>", text(line.as_str().unwrap_or_default())))
        .collect();
    let open = if open && list.len() <= 6 { " open" } else { "" };
    format!(
        "<details{open}><summary>{heading}: {}</summary><ul>{items}</ul></details>\n",
        list.len()
    )
}

fn finding(value: &Value) -> String {
    match serde_json::from_value::<Finding>(value.clone()) {
        Ok(f) => {
            let when = match (&f.step, f.time) {
                (Some(step), Some(t)) => format!("step {}, time {}: ", text(step), number(t)),
                (None, Some(t)) => format!("time {}: ", number(t)),
                _ => String::new(),
            };
            format!("{when}<pre>{}</pre>", text(&f.to_string()))
        }
        // Of another version: what it says all the same.
        Err(_) => text(value["message"].as_str().unwrap_or_default()),
    }
}

/// The ledger at the end, and the plots of its course.
pub fn energy(results: &Results) -> String {
    let e = &results.summary["energy"];
    let mut out = String::from("<div class=\"plots\" id=\"energy-plots\"></div>\n");
    if !e.is_object() {
        return out;
    }
    let groups: [(&str, &[(&str, &str)]); 3] = [
        (
            "supplied",
            &[
                ("external-work", "work of loads and supports"),
                ("belt-work", "work of moving primary surfaces"),
                ("initial", "brought in by initial conditions"),
            ],
        ),
        (
            "stored",
            &[
                ("strain", "strain energy of bodies and springs"),
                ("kinetic", "kinetic energy"),
                ("contact", "recoverable energy of interfaces"),
            ],
        ),
        (
            "dissipated",
            &[
                ("friction", "friction"),
                ("contact-damping", "damping of interfaces"),
                ("rayleigh-damping", "Rayleigh damping"),
                ("numerical", "scheme of integration"),
                ("artificial", "lost on the way into contact"),
            ],
        ),
    ];
    let mut rows = Vec::new();
    for (group, entries) in groups {
        let mut sum = 0.0;
        for (key, words) in entries {
            let value = e[*key].as_f64().unwrap_or(0.0);
            sum += value;
            if value != 0.0 {
                rows.push(vec![words.to_string(), group.to_string(), number(value)]);
            }
        }
        rows.push(vec![
            format!("<b>{group} in all</b>"),
            String::new(),
            format!("<b>{}</b>", number(sum)),
        ]);
    }
    let residual = e["residual"].as_f64().unwrap_or(0.0);
    rows.push(vec![
        "<b>left of the balance</b>".into(),
        String::new(),
        format!("<b>{}</b>", number(residual)),
    ]);
    out += &table(
        "plain",
        "Energies at the end",
        &["energy", "", "value"],
        &rows,
    );
    let q = &results.summary["energy-quality"];
    if let (Some(residual), Some(limit)) = (q["residual"].as_f64(), q["limit"].as_f64()) {
        let verdict = match q["met"].as_bool() {
            Some(true) => mark("good", "within its limit"),
            _ => mark("warn", "beyond its limit"),
        };
        out += &format!(
            "<p>The largest residual of the balance is {} of the energies in play; the limit is {}. {verdict}</p>\n",
            number(residual),
            number(limit)
        );
    }
    out
}

/// Bars of the phases of the run.
pub fn phases(results: &Results) -> String {
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
            number(times)
        ));
    }
    out += &format!("<p class=\"quiet\">{}</p>\n", facts.join(" · "));
    out
}

/// Who made the page.
pub fn footer(results: &Results) -> String {
    let version = results.summary["version"].as_str().unwrap_or("?");
    format!(
        "<footer><p>Results of stickslip {}, report of stickslip {}. Numbers are in the units of the problem file. \
         Plots by uPlot, 3D view by three.js (MIT licences).</p></footer>\n",
        text(version),
        env!("CARGO_PKG_VERSION")
    )
}

#[cfg(test)]
mod tests {
    use super::number;

    #[test]
    fn numbers_are_short() {
        for (value, text) in [
            (0.0, "0"),
            (1.0, "1"),
            (-0.25, "-0.25"),
            (1234.56, "1235"),
            (123_456.0, "123456"),
            (100.0, "100"),
            (0.01, "0.01"),
            (2.5e-5, "2.5e-5"),
            (7.654e9, "7.654e9"),
            (f64::NAN, "NaN"),
        ] {
            assert_eq!(number(value), text);
        }
    }
}

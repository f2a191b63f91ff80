//! The head and the foot of a page, and how numbers, verdicts and tables look.

use serde_json::Value;

use super::escape::text;
use crate::results::Results;

/// A whole number.
pub fn count(value: &Value) -> String {
    value.as_u64().map_or_else(|| "-".into(), |n| n.to_string())
}

/// A time of the run.
pub fn seconds(value: f64) -> String {
    match value {
        v if v >= 100.0 => format!("{v:.0} s"),
        v if v >= 1.0 => format!("{v:.1} s"),
        v => format!("{:.0} ms", 1e3 * v),
    }
}

/// A mark that says by word and shape, not by colour alone.
pub fn mark(kind: &str, words: &str) -> String {
    let sign = match kind {
        "good" => "✓",
        "bad" => "✕",
        _ => "!",
    };
    format!("<span class=\"mark {kind}\"><span aria-hidden=\"true\">{sign}</span> {words}</span>")
}

/// A table; the first row holds the headings. The cells are HTML.
pub fn table(class: &str, caption: &str, heads: &[&str], rows: &[Vec<String>]) -> String {
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
pub fn header(results: &Results, title: &str, modes: bool) -> String {
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
    let counts = [
        (&size["points"], "point"),
        (&size["cells"], "cell"),
        (&size["contact-points"], "contact point"),
        (&s["increments"], "increment"),
        (&s["iterations"], "Newton iteration"),
    ];
    for (count, word) in counts {
        if let Some(n) = count.as_u64() {
            let end = if n == 1 { "" } else { "s" };
            facts.push(format!("<b>{n}</b> {word}{end}"));
        }
    }
    if let Some(total) = s["phases"]["total"].as_f64() {
        facts.push(format!("<b>{}</b>", seconds(total)));
    }
    let modes = match modes {
        true => "<a href=\"#modes\">Modes</a>",
        false => "",
    };
    let list: String = facts.iter().map(|f| format!("<li>{f}</li>")).collect();
    format!(
        "<header>\n<div class=\"inner\"><p class=\"brand\">stickslip report</p>\n<h1>{title}</h1>\n<p class=\"marks\">{marks}</p>\n{outcome}<ul class=\"facts\">{list}</ul>\n\
         <nav aria-label=\"Sections\"><a href=\"#result\">Result</a>{modes}<a href=\"#solved\">Problem</a><a href=\"#quality\">Quality</a>\
         <a href=\"#convergence\">Convergence</a><a href=\"#energy\">Energy</a><a href=\"#history\">History</a><a href=\"#time\">Time</a></nav></div>\n</header>\n"
    )
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

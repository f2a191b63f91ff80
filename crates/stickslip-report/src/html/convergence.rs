//! How hard the run was, and what went wrong on the way.

use serde_json::Value;
use stickslip::assess::doctor::Finding;
use stickslip::number::figure;

use super::escape::text;
use super::facts::{count, mark, table};
use crate::results::Results;

/// Iterations, and what went wrong on the way.
pub fn section(results: &Results) -> String {
    let s = &results.summary;
    let mut out = String::new();
    if let Some(method) = s["method"].as_str().filter(|m| !m.is_empty()) {
        out += &format!(
            "<p>Linear solver: <b>{}</b>. Accepted increments: {}. Newton iterations: {}. Increments repeated after failures: {}; \
             repeated to locate changes of contact status: {}.</p>\n",
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
        let shown = |v: &Value| v.as_f64().map_or_else(|| "-".into(), figure);
        let rows: Vec<Vec<String>> = fallbacks
            .iter()
            .map(|f| {
                vec![
                    text(f["step"].as_str().unwrap_or("?")),
                    shown(&f["from"]),
                    shown(&f["to"]),
                    text(f["kind"].as_str().unwrap_or("?")).replace('-', " "),
                    text(f["solver"].as_str().unwrap_or("-")),
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
                &[
                    "step",
                    "from",
                    "to",
                    "way",
                    "solver",
                    "iterations",
                    "outcome"
                ],
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
                (Some(step), Some(t)) => format!("step {}, time {}: ", text(step), figure(t)),
                (None, Some(t)) => format!("time {}: ", figure(t)),
                _ => String::new(),
            };
            format!("{when}<pre>{}</pre>", text(&f.to_string()))
        }
        // Of another version: what it says all the same.
        Err(_) => text(value["message"].as_str().unwrap_or_default()),
    }
}

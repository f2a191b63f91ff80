//! The quality gate.

use stickslip::assess::told_apart;
use stickslip::number::figure;

use super::escape::text;
use super::facts::{mark, table};
use crate::results::Results;

/// The figures of the quality gate beside their limits.
pub fn section(results: &Results) -> String {
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
            let shown = |v: Option<f64>| v.map_or_else(|| "-".into(), figure);
            let mut compared = [shown(value), shown(limit)];
            // A value that is just above its limit needs more digits.
            if let (false, Some(v), Some(l)) = (met, value, limit)
                && compared[0] == compared[1]
            {
                compared = told_apart(v, l);
            }
            let cells = vec![
                text(f["figure"].as_str().unwrap_or("?")).replace('-', " "),
                text(f["place"].as_str().unwrap_or("?")),
                verdict,
                compared[0].clone(),
                compared[1].clone(),
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
            "<p>The largest value of each figure over all increments, beside its limit. All figures are dimensionless.</p>\n"
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

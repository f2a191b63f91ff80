//! The energy balance.

use super::facts::{mark, table};
use crate::results::Results;
use stickslip::number::figure;

/// The ledger at the end, and the plots of its course.
pub fn section(results: &Results) -> String {
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
                rows.push(vec![words.to_string(), group.to_string(), figure(value)]);
            }
        }
        rows.push(vec![
            format!("<b>{group} in all</b>"),
            String::new(),
            format!("<b>{}</b>", figure(sum)),
        ]);
    }
    let residual = e["residual"].as_f64().unwrap_or(0.0);
    rows.push(vec![
        "<b>left of the balance</b>".into(),
        String::new(),
        format!("<b>{}</b>", figure(residual)),
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
            "<p>The largest error of the balance is {} of the energy stored and dissipated; the limit is {}. {verdict}</p>\n",
            figure(residual),
            figure(limit)
        );
    }
    out
}

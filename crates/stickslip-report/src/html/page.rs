//! The page around everything: head, sections, data, scripts.

use serde_json::json;

use super::model::Packed;
use super::{convergence, energy, escape, facts, phases, problem, quality};
use crate::results::Results;

const STYLE: &str = include_str!("../../assets/page.css");
const PLOT_STYLE: &str = include_str!("../../assets/vendor/uPlot.min.css");
const PLOT: &str = include_str!("../../assets/vendor/uPlot.iife.min.js");
const THREE_JS: &str = include_str!("../../assets/vendor/three.bundle.min.js");
const DATA: &str = include_str!("../../assets/data.js");
const PLOTS: &str = include_str!("../../assets/plots.js");
const VIEW_JS: &str = include_str!("../../assets/view.js");

/// Nothing may be loaded from anywhere: a page that tries is stopped by the browser.
const POLICY: &str =
    "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data:";

/// The controls of the 3D view. They stay hidden until the script has read the data.
const VIEW_BODY: &str = include_str!("../../assets/view.html");
const HISTORY_BODY: &str = include_str!("../../assets/history.html");

/// Sections that are ready.
pub struct Drawn {
    /// Tables of modes.
    pub modes: String,
    /// What interfaces carry, as SVG.
    pub along: Vec<String>,
    /// Vibrations over time and frequency, as SVG.
    pub waterfalls: Vec<String>,
}

/// Writes the page.
pub fn write(
    results: &Results,
    model: &Packed,
    history: &Packed,
    drawn: &Drawn,
    notes: &[String],
) -> String {
    let title = results.title();
    let shown = escape::text(&title);
    let mut page = format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta http-equiv=\"Content-Security-Policy\" content=\"{POLICY}\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <meta name=\"color-scheme\" content=\"light dark\">\n\
         <link rel=\"icon\" href=\"data:,\">\n\
         <title>{shown}</title>\n<style>{PLOT_STYLE}\n{STYLE}</style>\n</head>\n<body>\n"
    );
    page += &facts::header(results, &shown, !drawn.modes.is_empty());
    page += "<main>\n<p id=\"trouble\" role=\"alert\" hidden></p>\n\
             <noscript><p class=\"note\">The 3D view and the plots need JavaScript.</p></noscript>\n";
    page += &notes_of(notes);
    let none = |what: &str| format!("<p class=\"quiet\">{what}</p>");
    let mut section = |id: &str, heading: &str, body: String| {
        if !body.is_empty() {
            page += &format!(
                "<section id=\"{id}\" aria-labelledby=\"{id}-h\">\n<h2 id=\"{id}-h\">{heading}</h2>\n{body}</section>\n"
            );
        }
    };
    section(
        "result",
        "Result",
        match model.meta.is_null() {
            true => none("There are no fields that could be shown."),
            false => VIEW_BODY.to_string(),
        },
    );
    let figures = |all: &[String]| -> String {
        let all = all.iter();
        all.map(|svg| format!("<figure class=\"along\">{svg}</figure>\n"))
            .collect()
    };
    section("along", "Along the interfaces", figures(&drawn.along));
    section("modes", "Modes", drawn.modes.clone());
    section(
        "vibration",
        "Vibration over time and frequency",
        figures(&drawn.waterfalls),
    );
    section("solved", "What was solved", problem::section(results));
    section("quality", "Quality", quality::section(results));
    section("convergence", "Convergence", convergence::section(results));
    section("energy", "Energy", energy::section(results));
    section(
        "history",
        "History",
        match history.meta.is_null() {
            true => none("There is no history."),
            false => HISTORY_BODY.to_string(),
        },
    );
    section("time", "Where the time went", phases::section(results));
    page += "</main>\n";
    page += &facts::footer(results);
    let meta = json!({"title": title, "model": model.meta, "history": history.meta});
    page += &format!(
        "<script type=\"application/json\" id=\"meta\">{}</script>\n",
        escape::json(&meta)
    );
    // Keys are made here and the text is base64: neither can end the element.
    for (key, text) in model.blobs.iter().chain(&history.blobs) {
        page += &format!("<script type=\"text/plain\" id=\"blob-{key}\">{text}</script>\n");
    }
    if !model.meta.is_null() {
        // Most of a small page: packed, and only where there is something to show.
        let text = crate::pack::packed(THREE_JS.as_bytes());
        page += &format!("<script type=\"text/plain\" id=\"blob-three\">{text}</script>\n");
    }
    for script in [PLOT, DATA, PLOTS, VIEW_JS] {
        page += &format!("<script>{script}</script>\n");
    }
    page += "</body>\n</html>\n";
    page
}

fn notes_of(notes: &[String]) -> String {
    if notes.is_empty() {
        return String::new();
    }
    let items: String = notes
        .iter()
        .map(|note| format!("<li>{}</li>", escape::text(note)))
        .collect();
    format!("<aside class=\"note\" aria-label=\"About this page\"><ul>{items}</ul></aside>\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scripts_that_are_built_in_cannot_end_their_element() {
        for script in [PLOT, THREE_JS, DATA, PLOTS, VIEW_JS] {
            let lower = script.to_ascii_lowercase();
            assert!(!lower.contains("</script") && !lower.contains("<!--"));
        }
        for style in [STYLE, PLOT_STYLE] {
            assert!(!style.to_ascii_lowercase().contains("</style"));
            assert!(!style.contains("url(") && !style.contains("@import"));
        }
    }
}

//! Errors on standard error: file, line, the line itself with the place underlined, what to do.

use annotate_snippets::{AnnotationKind, Group, Level, Renderer, Snippet};
use stickslip::Error;
use stickslip::error::{ProblemError, shown};

use crate::failure::Failure;
use crate::print;
use stickslip::number::digits;

/// Prints why a command failed.
pub fn failure(failure: &Failure) {
    let renderer = if crate::style::coloured() {
        Renderer::styled()
    } else {
        Renderer::plain()
    };
    print::err(&format!("{}\n", text(failure, &renderer)));
}

/// Why a command failed, without colours.
pub fn plain(failure: &Failure) -> String {
    shown(&text(failure, &Renderer::plain())).into_owned()
}

fn text(failure: &Failure, renderer: &Renderer) -> String {
    match failure {
        Failure::Library(Error::Problem(error)) => problem(error, renderer),
        Failure::Library(Error::Interrupted(time)) => {
            format!(
                "interrupted at time {time}; the results up to there are complete",
                time = digits(time, 6)
            )
        }
        Failure::Library(other) => format!("error: {other}"),
        Failure::Deck(error) => error.to_string(),
        Failure::Arguments(message, help) => format!("error: {message}\n  help: {help}"),
        Failure::Runs { failed, all, table } => format!(
            "error: {failed} of {all} runs failed\n  help: the {} `outcome` of {} says why",
            match table.is_dir() {
                true => "entry",
                false => "column",
            },
            table.display()
        ),
        Failure::Output(error) => format!("error: standard output: {error}"),
    }
}

/// Every finding with its line.
fn problem(error: &ProblemError, renderer: &Renderer) -> String {
    let path = error.file.as_ref().map(|f| f.display().to_string());
    let mut blocks = Vec::new();
    for finding in &error.findings {
        let message = match finding.key.as_str() {
            "" => finding.message.clone(),
            key => format!("{key}: {}", finding.message),
        };
        let title = Level::ERROR.primary_title(message);
        let mut group = match &finding.span {
            Some(span) => {
                let end = span.end.min(error.source.len());
                let mark = AnnotationKind::Primary.span(span.start.min(end)..end);
                let snippet = Snippet::source(error.source.as_str()).annotation(mark);
                title.element(match &path {
                    Some(path) => snippet.path(path.as_str()),
                    None => snippet,
                })
            }
            None => match &path {
                Some(path) => title.element(annotate_snippets::Origin::path(path.as_str())),
                None => Group::with_title(title),
            },
        };
        if let Some(help) = &finding.help {
            group = group.element(Level::HELP.message(help.as_str()));
        }
        blocks.push(renderer.render(&[group]));
    }
    blocks.join("\n\n")
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;
    use stickslip::problem::Problem;

    #[test]
    fn the_line_is_shown_and_underlined() {
        let text = "format = 1\n\n[model]\nspace = \"solid\"\n\n[body]\n\n[[step]]\ndurtion = 1\n";
        let error = Problem::from_toml(text, Some(Path::new("case.toml"))).unwrap_err();
        assert_eq!(
            problem(&error, &Renderer::plain()),
            "error: step.1.durtion: unknown key `durtion`\n \
             --> case.toml:9:1\n  \
             |\n\
             9 | durtion = 1\n  \
             | ^^^^^^^\n  \
             |\n  \
             = help: did you mean `duration`? allowed here: change, complex-modes, couplings, cycles, duration, dynamic, \
             harmonic, increments, interfaces, kick, loads, modes, name, pretension, steady, supports, temperatures"
        );
    }

    #[test]
    fn findings_without_a_place_name_the_file() {
        let error = Problem::from_toml("", Some(Path::new("case.toml"))).unwrap_err();
        let text = problem(&error, &Renderer::plain());
        assert!(
            text.starts_with("error: the key `format` is missing\n"),
            "{text}"
        );
        assert!(text.contains("case.toml"), "{text}");
    }
}

use std::path::{Path, PathBuf};

use serde::Deserialize;
use toml::Spanned;

use super::tree::{self, Table};
use super::{FORMAT, MeshSource, Problem, check, foreign, key, overrides, schema, structure};
use crate::error::{Diagnostic, Error, ProblemError, line_column};
use crate::io::input;

/// The text of a problem file with its overrides: it becomes a [`Problem`], and shows where in the text a finding is.
#[derive(Debug, Clone)]
pub struct Document {
    /// The file, if the text came from one. Mesh files are looked up relative to its folder.
    pub file: Option<PathBuf>,
    /// The text.
    pub source: String,
    /// Changes `path=value`, applied in order before anything is checked.
    pub overrides: Vec<String>,
}

impl Document {
    /// A text; `file` is named in messages.
    pub fn new(source: impl Into<String>, file: Option<&Path>) -> Self {
        Document {
            file: file.map(Path::to_path_buf),
            source: source.into(),
            overrides: Vec::new(),
        }
    }

    /// The text of a file.
    ///
    /// # Errors
    /// [`Error::Io`] if it cannot be read, [`Error::Problem`] if it is not UTF-8 or a file of another kind.
    pub fn read(file: &Path) -> Result<Self, Error> {
        if file.is_dir() {
            return Err(foreign::folder(file));
        }
        let bytes = input::read(file, input::MOST_TEXT_BYTES).map_err(|e| Error::io(file, e))?;
        if let Some(finding) = foreign::kind(file, &bytes) {
            return Err(Error::Problem(ProblemError {
                file: Some(file.to_path_buf()),
                source: String::new(),
                findings: vec![finding],
            }));
        }
        let source = String::from_utf8(bytes).map_err(|e| not_text(file, &e))?;
        Ok(Document::new(source, Some(file)))
    }

    /// Adds overrides `path=value`, for example `interface.base.friction.coulomb.mu=0.3` or `step.1.duration=2`.
    pub fn with_overrides(mut self, overrides: impl IntoIterator<Item = String>) -> Self {
        self.overrides.extend(overrides);
        self
    }

    /// The folder relative to which the problem names files; empty if unknown.
    pub fn folder(&self) -> PathBuf {
        let parent = self.file.as_deref().and_then(Path::parent);
        parent.map(Path::to_path_buf).unwrap_or_default()
    }

    /// The files that the problem is read from: this one, meshes, and results that it starts from.
    pub fn inputs(&self, problem: &Problem) -> Vec<PathBuf> {
        let folder = self.folder();
        let meshes = problem.body.values().filter_map(|body| match &body.mesh {
            MeshSource::Gmsh(mesh) => Some(&mesh.file),
            MeshSource::Generate(_) | MeshSource::Mesh(_) => None,
        });
        let results = problem.initial.values().filter_map(|i| i.result.as_ref());
        let roughness = problem
            .interface
            .values()
            .filter_map(|i| i.roughness.as_ref());
        let maps = roughness.filter_map(|r| r.kind.as_dyn().file());
        let named = meshes.chain(results).map(|file| folder.join(file));
        let worn = problem.interface.values().flat_map(|i| &i.worn);
        let named = named.chain(maps.map(|file| folder.join(file)));
        let named = named.chain(worn.map(|file| folder.join(file)));
        self.file.iter().cloned().chain(named).collect()
    }

    /// Reads and checks the text.
    ///
    /// # Errors
    /// All findings of the first stage that has any: syntax, then keys and types, then the rules of
    /// [`Problem::check`].
    pub fn problem(&self) -> Result<Problem, ProblemError> {
        let tree = self.tree().map_err(|f| self.error(f))?;
        if let Some(finding) = other_format(tree.get_ref()) {
            return Err(self.error(vec![finding]));
        }
        let findings = structure::check(schema::shared(), tree.get_ref());
        if !findings.is_empty() {
            return Err(self.error(findings));
        }
        let problem: Problem = deserialize(tree).map_err(|f| self.error(vec![f]))?;
        let findings = check::check(&problem);
        if !findings.is_empty() {
            return Err(self.error(findings));
        }
        Ok(problem)
    }

    /// Findings, made elsewhere, about this text: the place of each is looked up by its key.
    pub fn error(&self, mut findings: Vec<Diagnostic>) -> ProblemError {
        if findings.iter().any(|f| f.span.is_none())
            && let Ok(tree) = self.tree()
        {
            for finding in findings.iter_mut().filter(|f| f.span.is_none()) {
                let path = key::parse(&finding.key).ok();
                finding.span = path.and_then(|path| tree::find(tree.get_ref(), &path));
            }
        }
        for finding in findings.iter_mut().filter(|f| f.help.is_none()) {
            let path = key::parse(&finding.key).ok();
            finding.help = path.and_then(|path| structure::description(schema::shared(), &path));
        }
        // Findings without a place, about the whole file, come first; `sort_by_key` keeps the order of equals.
        findings.sort_by_key(|f| f.span.as_ref().map(|s| s.start));
        ProblemError {
            file: self.file.clone(),
            source: self.source.clone(),
            findings,
        }
    }

    /// Where the text departs from the schema, without places.
    pub(super) fn departures(&self) -> Vec<Diagnostic> {
        let findings = self
            .tree()
            .map(|tree| structure::check(schema::shared(), tree.get_ref()));
        let mut findings = findings.unwrap_or_else(|findings| findings);
        findings.iter_mut().for_each(|f| f.span = None);
        findings
    }

    fn tree(&self) -> Result<Spanned<Table<'_>>, Vec<Diagnostic>> {
        let (mut tree, errors) = Table::parse_recoverable(&self.source);
        let mut findings = syntax_findings(&self.source, &errors);
        if findings.is_empty() {
            let mut wrong = |text| overrides::apply(tree.get_mut(), text).err();
            findings.extend(self.overrides.iter().filter_map(|o| wrong(o)));
        }
        if findings.is_empty() {
            Ok(tree)
        } else {
            Err(findings)
        }
    }
}

/// Lines with mistakes of syntax that are reported: where a bracket is not closed all lines behind it have one.
const MOST_MISTAKES: usize = 5;

/// The first mistake of each line.
fn syntax_findings(source: &str, errors: &[toml::de::Error]) -> Vec<Diagnostic> {
    let line = |e: &toml::de::Error| e.span().map(|span| line_column(source, span.start).0);
    let mut lines = Vec::new();
    let mut out = Vec::new();
    for error in errors {
        let line = line(error);
        if !lines.contains(&line) && lines.len() < MOST_MISTAKES {
            lines.push(line);
            out.push(syntax(error));
        }
    }
    out
}

fn syntax(error: &toml::de::Error) -> Diagnostic {
    Diagnostic {
        message: format!("not TOML: {}", error.message()),
        key: String::new(),
        span: error.span(),
        help: Some(syntax_help(error.message()).into()),
    }
}

/// What to do about a mistake of syntax, by the words of the parser.
fn syntax_help(message: &str) -> &'static str {
    let says = |words: &str| message.contains(words);
    if says("duplicate key") {
        "every key and every table is given once: join the two, or remove one"
    } else if says("escape") {
        "in double quotes a backslash is written twice; in single quotes it stands for itself"
    } else if says("recurse") {
        "no value of a problem file is nested that deeply"
    } else if says("leading zero") {
        "write the number without leading zeros"
    } else if says("with no value") || says("must be quoted") {
        "write `key = value`, and texts in double quotes"
    } else if says("unexpected key or value") {
        "write one `key = value` a line, and numbers with a decimal point and no unit"
    } else {
        "TOML has lines `key = value`, headings `[table]`, texts in double quotes, and lists in brackets that are closed"
    }
}

/// A file that is no text: shown up to where it stops being one.
fn not_text(file: &Path, error: &std::string::FromUtf8Error) -> Error {
    let at = error.utf8_error().valid_up_to();
    let byte = error.as_bytes().get(at).copied().unwrap_or_default();
    let finding = Diagnostic {
        span: Some(at..at),
        ..Diagnostic::new(
            "",
            format!("the file is not UTF-8 text: byte {at} is 0x{byte:02X}"),
        )
        .help("save it as UTF-8; problem files are TOML, not results or meshes")
    };
    Error::Problem(ProblemError {
        file: Some(file.to_path_buf()),
        source: String::from_utf8_lossy(error.as_bytes()).into_owned(),
        findings: vec![finding],
    })
}

/// A finding if the file is of another format than this version reads: anything else said about it would mislead.
fn other_format(root: &Table) -> Option<Diagnostic> {
    let format = root.get("format").map(|v| tree::number(v.get_ref()));
    let finding = match format {
        Some(Some(number)) if number == f64::from(FORMAT) => return None,
        // The check of the structure says that the type is wrong.
        Some(None) => return None,
        Some(Some(number)) if number > f64::from(FORMAT) => Diagnostic::new(
            "format",
            format!("the file has format {number}; this version reads format {FORMAT}"),
        )
        .help("use a newer version of stickslip"),
        Some(Some(number)) => Diagnostic::new("format", format!("there is no format {number}"))
            .help(format!("write `format = {FORMAT}`")),
        None => Diagnostic::new("", "the key `format` is missing").help(format!(
            "write `format = {FORMAT}` in the first line, so that later versions know how to read the file"
        )),
    };
    Some(finding)
}

/// The last stage. [`structure`] has found what people get wrong; what it does not know about still has a place, and the key that stands there.
fn deserialize(tree: Spanned<Table<'_>>) -> Result<Problem, Diagnostic> {
    let places = tree.clone();
    Problem::deserialize(toml::de::Deserializer::from(tree)).map_err(|e| {
        let span = e.span().and_then(tree::place);
        let path = span.as_ref().map(|span| tree::path(places.get_ref(), span));
        Diagnostic {
            message: e.message().to_string(),
            key: key::join(&path.unwrap_or_default()),
            span: span.filter(|s| !s.is_empty()),
            help: None,
        }
    })
}

//! A [`Deck`] to a problem file and its mesh.

mod bodies;
mod contact;
mod links;
mod loads;
mod materials;
mod sets;
mod steps;
mod supports;
mod toml;
mod volumes;

pub(crate) use bodies::Bodies;

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use stickslip::error::{Diagnostic, Error, ProblemError};
use stickslip::mesh::Mesh;
use stickslip::problem::{Document, Meshes};

use crate::deck::{Deck, Print};
use crate::finding::{DeckError, Finding, Severity};
use crate::source::Place;
use sets::Sets;
use toml::Writer;

/// A deck as a stickslip problem.
#[derive(Debug, Clone)]
pub struct Translation {
    /// The problem file.
    pub toml: String,
    /// The name under which it asks for its mesh: `job.msh`.
    pub mesh_name: PathBuf,
    /// The mesh of all bodies, with the numbers and sets of the deck.
    pub mesh: Arc<Mesh>,
    /// Warnings and notes, of reading and translation.
    pub notes: Vec<Finding>,
    /// What is most likely not meant, or would be refused by CalculiX; `stickslip check` shows it.
    pub lint: Vec<Finding>,
    /// What is printed, by step.
    pub prints: Vec<Vec<Print>>,
    /// Nodes of the printed sets, in the order of the deck.
    pub node_sets: BTreeMap<String, Vec<u64>>,
    /// Elements of the printed sets.
    pub element_sets: BTreeMap<String, Vec<u64>>,
    /// Interfaces by slave and master, in the order of the deck: `(name, slave, master)`.
    pub pairs: Vec<(String, String, String)>,
    /// Times of `*TIME POINTS` in the time of the analysis.
    pub(crate) times: BTreeMap<String, Vec<f64>>,
    /// Local axes (rows) of nodes with a `*TRANSFORM`, and of elements with an `*ORIENTATION`.
    pub(crate) node_axes: BTreeMap<u64, [[f64; 3]; 3]>,
    pub(crate) element_axes: BTreeMap<u64, [[f64; 3]; 3]>,
    /// Where elements are, for messages.
    elements: BTreeMap<u64, Place>,
    /// The deck, for messages.
    path: PathBuf,
    /// Where tables of the problem come from.
    places: Vec<(String, Place)>,
    files: Vec<PathBuf>,
}

impl Translation {
    /// The problem file as a document, with changes `path=value`.
    pub fn document(&self, overrides: Vec<String>) -> Document {
        Document::new(self.toml.clone(), Some(&self.path)).with_overrides(overrides)
    }

    /// The files that the deck was read from.
    pub fn files(&self) -> &[PathBuf] {
        &self.files
    }

    /// The mesh under its name.
    pub fn meshes(&self) -> Meshes {
        Meshes::from([(self.mesh_name.clone(), self.mesh.clone())])
    }

    /// Findings about the translated problem as findings about the deck.
    pub fn located(&self, error: Error) -> Result<DeckError, Error> {
        match error {
            Error::Problem(ProblemError { findings, .. }) => Ok(DeckError {
                findings: findings.iter().map(|d| self.locate(d)).collect(),
            }),
            Error::Mesh(e) => {
                // Messages about meshes name cells by their numbers.
                let number = |text: &str| -> Option<u64> {
                    let after = text.split("cell ").nth(1)?;
                    after.split(' ').next()?.parse().ok()
                };
                let place = number(&e.message).and_then(|n| self.elements.get(&n));
                let place = place.copied().unwrap_or_default();
                let file = self.files.get(place.file).filter(|_| place.line > 0);
                Ok(DeckError {
                    findings: vec![Finding {
                        severity: Severity::Error,
                        file: file.unwrap_or(&self.path).clone(),
                        line: place.line,
                        message: e.message,
                        help: e.help,
                    }],
                })
            }
            other => Err(other),
        }
    }

    fn locate(&self, finding: &Diagnostic) -> Finding {
        // The longest table the key lies in.
        let within = |key: &str| {
            finding.key == key
                || finding
                    .key
                    .strip_prefix(key)
                    .is_some_and(|rest| rest.starts_with('.'))
        };
        let place = self
            .places
            .iter()
            .filter(|(key, _)| within(key))
            .max_by_key(|(key, _)| key.len());
        let place = place.map(|(_, place)| *place).unwrap_or_default();
        let file = self.files.get(place.file).filter(|_| place.line > 0);
        let key = match finding.key.is_empty() {
            true => String::new(),
            false => format!("{}: ", finding.key),
        };
        Finding {
            severity: Severity::Error,
            file: file.unwrap_or(&self.path).clone(),
            line: place.line,
            message: format!("{key}{}", finding.message),
            help: finding.help.clone(),
        }
    }
}

impl Deck {
    /// The problem that the deck describes. `path` is the deck: its name gives that of the mesh.
    ///
    /// # Errors
    /// What has no counterpart here, with its line.
    pub fn translate(&self, path: &Path) -> Result<Translation, DeckError> {
        let mut job = Job::new(self);
        let stem = path.file_stem().map(|s| s.to_string_lossy().into_owned());
        let mesh_name = PathBuf::from(format!("{}.msh", stem.as_deref().unwrap_or("job")));
        let Some(bodies) = bodies::find(&mut job) else {
            return Err(job.failed());
        };
        let mut sets = Sets::new(self, &bodies);
        job.out.line("format = 1");
        if let Some(title) = self.title.as_deref().filter(|t| !t.trim().is_empty()) {
            job.out
                .line(&format!("title = {}", toml::text(title.trim())));
        }
        bodies::write(&mut job, &bodies, &mut sets, &mesh_name);
        materials::write(&mut job, &bodies);
        contact::write(&mut job, &bodies, &mut sets);
        supports::write(&mut job, &bodies, &mut sets);
        loads::write(&mut job, &bodies, &mut sets);
        links::write(&mut job, &bodies, &mut sets);
        let (stick, soft) = (deck_has_stick(self), deck_ties_by_springs(self));
        if stick || soft {
            // The slip and the stretch of springs that the deck gives are no errors of the solution.
            job.out.line("");
            job.out.line("[quality]");
            job.out.line("false-slip = 1e300");
        }
        if soft {
            job.out.line("penetration-to-approach = 1e300");
        }
        steps::write(&mut job);
        for step in &self.steps {
            for print in &step.prints {
                let Print::Node { set, .. } = print else {
                    continue;
                };
                let all = self.node_sets.get(set).into_iter().flatten();
                let none = all.filter(|n| !bodies.of_node.contains_key(n)).count();
                if none > 0 {
                    let message = format!(
                        "*NODE PRINT of {set}: {none} nodes that are in no body, such as reference nodes, are not printed"
                    );
                    job.note(step.place, message);
                }
            }
        }
        job.out.tables(sets.tables());
        if !job.errors.is_empty() {
            return Err(job.failed());
        }
        let mesh = Arc::new(sets.into_mesh(&bodies));
        let mut notes = self.notes.clone();
        notes.append(&mut job.notes);
        let printed = |p: &Print| match p {
            Print::Node { set, .. } | Print::Element { set, .. } => Some(set.clone()),
            Print::Contact { .. } => None,
        };
        let names: Vec<String> = self
            .steps
            .iter()
            .flat_map(|s| &s.prints)
            .filter_map(printed)
            .collect();
        let of = |sets: &BTreeMap<String, Vec<u64>>| {
            names
                .iter()
                .filter_map(|n| Some((n.clone(), sets.get(n)?.clone())))
                .collect()
        };
        let node_axes = self.transforms.iter().filter_map(|(n, t)| {
            let x = *self.nodes.get(n)?;
            Some((*n, supports::axes(t, x)?))
        });
        let element_axes = bodies.section.iter().filter_map(|(e, s)| {
            let o = self.sections[*s].orientation.as_ref()?;
            let o = self.orientations.get(o).filter(|o| o.uniform)?;
            Some((*e, o.axes))
        });
        let mut times: BTreeMap<String, Vec<f64>> = BTreeMap::new();
        for (step, span) in self.steps.iter().zip(&job.spans) {
            for name in &step.output_times {
                let points = steps::points(self, name, *span);
                times.entry(name.clone()).or_default().extend(points);
            }
        }
        Ok(Translation {
            elements: self.elements.iter().map(|(n, e)| (*n, e.place)).collect(),
            lint: crate::lint::findings(self, &bodies),
            times,
            node_axes: node_axes.collect(),
            element_axes: element_axes.collect(),
            toml: job.out.finish(),
            mesh_name,
            mesh,
            notes,
            prints: self.steps.iter().map(|s| s.prints.clone()).collect(),
            node_sets: of(&self.node_sets),
            element_sets: of(&self.element_sets),
            pairs: job.pairs,
            path: path.to_path_buf(),
            places: job.places,
            files: self.files.clone(),
        })
    }
}

/// The mesh of a deck with all its sets and surfaces, whatever else it says: it may consist of a mesh alone.
///
/// # Errors
/// What is wrong with its nodes, elements, sets and surfaces.
pub fn read_mesh(path: &Path) -> Result<Mesh, DeckError> {
    let deck = Deck::read(path)?;
    let mut job = Job::new(&deck);
    let Some(bodies) = bodies::connected(&mut job) else {
        return Err(job.failed());
    };
    let mut sets = Sets::new(&deck, &bodies);
    for (name, nodes) in &deck.node_sets {
        sets.keep_points(&bodies, &toml::name(name), nodes);
    }
    for (name, elements) in &deck.element_sets {
        sets.keep_cells(&bodies, &toml::name(name), elements);
    }
    for (name, elements) in &deck.element_sets {
        // What bounds cells in a file of Gmsh is what its user has named.
        let faces =
            crate::deck::SurfaceParts::Faces(elements.iter().map(|e| (*e, Some(0))).collect());
        let by = bodies.faces(&faces);
        if by.values().any(|list| !list.is_empty()) {
            sets.keep_facets(&toml::name(name), &by);
        }
    }
    for (name, surface) in &deck.surfaces {
        match &surface.parts {
            crate::deck::SurfaceParts::Nodes(nodes) => {
                sets.keep_points(&bodies, &toml::name(name), nodes)
            }
            faces => sets.keep_facets(&toml::name(name), &bodies.faces(faces)),
        }
    }
    Ok(sets.into_mesh(&bodies))
}

/// Whether sticking is a spring of the deck's own.
fn deck_has_stick(deck: &Deck) -> bool {
    let mut all = deck.interactions.values();
    all.any(|i| contact::compliant(i) && i.friction.as_ref().is_some_and(|f| f.stick.is_some()))
}

/// Whether surfaces are tied by springs of the deck's own.
fn deck_ties_by_springs(deck: &Deck) -> bool {
    let mut used = deck
        .pairs
        .iter()
        .filter_map(|p| deck.interactions.get(&p.interaction));
    used.any(|i| matches!(i.behavior, Some(crate::deck::Behavior::Tied(Some(_)))))
}

/// A translation under way.
struct Job<'a> {
    deck: &'a Deck,
    out: Writer,
    errors: Vec<Finding>,
    notes: Vec<Finding>,
    places: Vec<(String, Place)>,
    /// The tables there are, for their names.
    tables: BTreeSet<String>,
    pairs: Vec<(String, String, String)>,
    /// Names of tables that act in some steps only: kind (`supports`, `loads`, ...), name, by step.
    active: Vec<(&'static str, String, Vec<bool>)>,
    /// Changes of laws: step, interface, key and value.
    changes: Vec<(usize, String, String)>,
    /// Rigid bodies whose reference node is prescribed.
    led: BTreeSet<usize>,
    /// Starts and lengths of the steps.
    spans: Vec<[f64; 2]>,
}

impl<'a> Job<'a> {
    fn new(deck: &'a Deck) -> Self {
        let mut start = 0.0;
        let spans = deck.steps.iter().map(|s| {
            let length = steps::duration(s);
            start += length;
            [start - length, length]
        });
        Job {
            deck,
            out: Writer::default(),
            errors: Vec::new(),
            notes: Vec::new(),
            places: Vec::new(),
            tables: BTreeSet::new(),
            pairs: Vec::new(),
            active: Vec::new(),
            changes: Vec::new(),
            led: BTreeSet::new(),
            spans: spans.collect(),
        }
    }

    fn failed(mut self) -> DeckError {
        let files = &self.deck.files;
        self.errors
            .sort_by_key(|f| (files.iter().position(|p| *p == f.file), f.line));
        DeckError {
            findings: self.errors,
        }
    }

    fn finding(&self, severity: Severity, place: Place, message: String, help: &str) -> Finding {
        Finding {
            severity,
            file: self.deck.files.get(place.file).cloned().unwrap_or_default(),
            line: place.line,
            message,
            help: (!help.is_empty()).then(|| help.to_string()),
        }
    }

    fn error(&mut self, place: Place, message: impl Into<String>, help: &str) {
        let finding = self.finding(Severity::Error, place, message.into(), help);
        self.errors.push(finding);
    }

    fn note(&mut self, place: Place, message: impl Into<String>) {
        let finding = self.finding(Severity::Note, place, message.into(), "");
        self.notes.push(finding);
    }

    fn warn(&mut self, place: Place, message: impl Into<String>, help: &str) {
        let finding = self.finding(Severity::Warning, place, message.into(), help);
        self.notes.push(finding);
    }

    /// Opens a table of the problem that comes from a place of the deck.
    fn table(&mut self, kind: &str, name: &str, place: Place) {
        let header = format!("{kind}.{}", toml::key(name));
        self.out.line("");
        self.out.line(&format!("[{header}]"));
        self.tables.insert(format!("{kind}.{name}"));
        self.places.push((format!("{kind}.{name}"), place));
    }

    /// The nodes of a card.
    fn nodes(&self, target: &crate::deck::Target) -> Vec<u64> {
        match target {
            crate::deck::Target::One(n) => vec![*n],
            crate::deck::Target::Set(name) => {
                self.deck.node_sets.get(name).cloned().unwrap_or_default()
            }
        }
    }

    /// A name that no other table of the kind has yet.
    fn fresh(&self, kind: &str, wanted: &str) -> String {
        let taken = |name: &str| self.tables.contains(&format!("{kind}.{name}"));
        if !taken(wanted) {
            return wanted.to_string();
        }
        let more = (2..).map(|i| format!("{wanted}-{i}"));
        more.into_iter().find(|n| !taken(n)).unwrap_or_default()
    }
}

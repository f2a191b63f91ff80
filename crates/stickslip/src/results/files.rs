//! The result directory: `fields.pvd` and `.vtu` files, `interfaces.pvd` and `interfaces/*.vtp`, `interfaces/*.csv`, `history.csv`, `cycles.csv`, `summary.json`,
//! an `.frd` file where the problem asks for one, and `culprits.vtu` where the doctor found something.

use crate::contact::look;
use std::path::Path;
use std::sync::Arc;
use std::thread::JoinHandle;

use super::analysis::Analysis;
use super::fatigue;
use super::folder::{Claim, Folder, FolderClaim, INTERFACES, OPPOSITE, SURFACES, surface_name};
use super::frd;
use super::history::Row;
use super::modes;
use super::observer::{Event, Observer, Snapshot};
use super::saved::{self, Come, Positions, Saved, Source};
use super::slip_events;
use super::summary::Summary;
use crate::assess::doctor;
use crate::assess::view::View;
use crate::contact::look::Sheet;
use crate::error::Error;
use crate::io::frd::{END_LINE, end_again};
use crate::io::{csv, own, pvd, vtu, write_atomically};
use crate::system::{Field, Fields, Location, Motion};

/// Writes results into a directory as the run goes on; what is there at any time is complete.
pub struct ResultFiles {
    folder: Folder,
    pvd: pvd::Collection,
    history: Option<csv::History>,
    cycles: Option<csv::History>,
    count: usize,
    /// What all files of fields share.
    mesh: Option<Arc<vtu::PackedMesh>>,
    writing: Option<Writing>,
    source: Option<Source>,
    /// Other files that grow.
    also: Vec<String>,
    frd: frd::Writer,
    /// Why a checkpoint could not be written, and whether it was asked for.
    unsaved: Option<(String, bool)>,
    /// See [`Claim::alike`].
    alike: bool,
}

impl ResultFiles {
    /// Makes the directory and takes it for one run: until this is dropped no other gets it. Results of an earlier run are removed, files of others
    /// are not touched, and `summary.json` says `running` until the end.
    ///
    /// # Errors
    /// [`Error::Io`]: what the system says; another run is in the directory; a result would replace an input, or a file that no run has written.
    pub fn new(directory: &Path, claim: &Claim) -> Result<Self, Error> {
        Ok(ResultFiles {
            folder: Folder::take(directory, claim)?,
            pvd: pvd::Collection::new(&directory.join("fields.pvd")),
            history: None,
            cycles: None,
            count: 0,
            mesh: None,
            writing: None,
            source: claim.source.clone(),
            also: claim.also.clone(),
            frd: frd::Writer::new(&claim.frd, None),
            unsaved: None,
            alike: claim.alike,
        })
    }

    /// Goes on in a folder where a run was stopped: its files are cut back to where they were at a checkpoint, and checkpoints after that one removed.
    ///
    /// # Errors
    /// [`Error::Io`] if a file cannot be cut or removed.
    pub fn resume(held: FolderClaim, claim: &Claim, saved: &Saved) -> Result<Self, Error> {
        let folder = Folder::take_again(held, claim)?;
        let directory = &folder.directory.clone();
        // First what is no longer true when files are cut: killed from here on, the run goes on from the same checkpoint.
        saved::drop_later(directory, saved.snapshot.increments)?;
        let positions = &saved.positions;
        positions.restore(directory)?;
        folder.keep_fields(&positions.fields)?;
        let there = positions.there(directory);
        keep_surfaces(directory, &there)?;
        let history = directory.join("history.csv");
        let frd = directory.join(&claim.frd.name);
        match positions.frd {
            Some(_) => end_again(&frd)?,
            // It was begun after the checkpoint.
            None => remove(&frd)?,
        }
        Ok(ResultFiles {
            folder,
            pvd: pvd::Collection::resume(&directory.join("fields.pvd"), &there)?,
            unsaved: None,
            history: match positions.columns {
                0 => None,
                columns => Some(csv::History::resume(&history, columns)?),
            },
            cycles: resume_cycles(directory, positions)?,
            count: positions.outputs,
            alike: claim.alike,
            mesh: None,
            writing: None,
            source: claim.source.clone(),
            also: claim.also.clone(),
            frd: frd::Writer::new(&claim.frd, positions.frd),
        })
    }

    /// Writes a checkpoint.
    fn save(&mut self, snapshot: &Snapshot) -> Result<(), Error> {
        let Some(source) = &self.source else {
            return Ok(());
        };
        let directory = &self.folder.directory;
        let mut lengths = Vec::new();
        let growing = self.history.iter().map(|_| "history.csv");
        let growing = growing.chain(self.cycles.iter().map(|_| CYCLES));
        let growing = growing.chain(self.also.iter().map(String::as_str));
        let frd = Some(self.frd.reached()).filter(|reached| reached.tally.outputs > 0);
        for name in growing.chain(frd.map(|_| self.frd.name())) {
            let path = directory.join(name);
            if let Ok(file) = std::fs::File::open(&path) {
                // Its last line is written over by what comes next, and is not there where a full disk has taken that.
                let last = match name == self.frd.name() {
                    true => END_LINE.len() as u64,
                    false => 0,
                };
                let come = || -> std::io::Result<Come> {
                    file.sync_all()?;
                    let length = file.metadata()?.len().saturating_sub(last);
                    Ok(Come {
                        length,
                        tail: saved::tail(&file, length)?,
                    })
                };
                lengths.push((name.to_string(), come().map_err(|e| Error::io(&path, e))?));
            }
        }
        let saved = Saved {
            source: source.clone(),
            snapshot: snapshot.clone(),
            positions: Positions {
                fields: self.pvd.entries().to_vec(),
                outputs: self.count,
                lengths,
                columns: self.history.as_ref().map_or(0, csv::History::columns),
                frd,
            },
        };
        saved.write(directory)
    }

    /// What a user should know of what was in the directory.
    pub fn notes(&self) -> &[String] {
        &self.folder.notes
    }

    /// Why the first checkpoint that could not be written was not.
    pub fn unsaved(&self) -> Option<&str> {
        self.unsaved.as_ref().map(|(why, _)| why.as_str())
    }

    /// What all files of fields share.
    fn mesh(&mut self, view: &View) -> Arc<vtu::PackedMesh> {
        let mesh = || Arc::new(vtu::PackedMesh::new(&view.model.mesh, Some(&owners(view))));
        Arc::clone(self.mesh.get_or_insert_with(mesh))
    }

    /// Hands fields and tables of the interfaces to a thread that writes them while the run goes on.
    fn output(&mut self, view: &View) -> Result<(), Error> {
        self.written()?;
        let name = format!("fields_{:05}.vtu", self.count);
        self.count += 1;
        let mesh = self.mesh(view);
        let fields = fields(view);
        let interfaces = view.contacts();
        let (u, time) = (&view.frame.state.u, view.frame.state.t);
        let tables: Vec<(String, csv::Table, Sheet)> = interfaces
            .map(|interface| {
                let (names, columns) = look::table(interface, u);
                let table = csv::Table { names, columns };
                (
                    interface.name.clone(),
                    table,
                    look::sheet(interface, u, time),
                )
            })
            .collect();
        let opposite = view.contacts();
        let opposite: Vec<(String, Sheet)> = opposite
            .filter_map(|i| Some((format!("{}{OPPOSITE}", i.name), look::opposite_sheet(i, u)?)))
            .collect();
        let parts = tables.iter().map(|(name, ..)| name);
        let parts = parts.chain(opposite.iter().map(|(name, _)| name));
        let parts: Vec<String> = parts.cloned().collect();
        let path = self.folder.directory.join(&name);
        let folder = self.folder.directory.join(INTERFACES);
        let frd = self
            .frd
            .job(view, &self.folder.directory, || owners(view))?;
        let (file, fields_name) = (path.clone(), name.clone());
        let write = move || {
            mesh.write(&path, &fields)?;
            frd.map_or(Ok(()), |frd| frd.write(&fields))?;
            if !tables.is_empty() {
                own::make_folder(&folder).map_err(|e| Error::io(&folder, e))?;
            }
            for (interface, table, sheet) in &tables {
                csv::write(&folder.join(format!("{interface}.csv")), table)?;
                write_sheet(&folder.join(surface_name(interface, &fields_name)), sheet)?;
            }
            for (name, sheet) in &opposite {
                write_sheet(&folder.join(surface_name(name, &fields_name)), sheet)?;
            }
            Ok(())
        };
        let thread = std::thread::Builder::new().spawn(write);
        self.writing = Some(Writing {
            time: view.frame.state.t,
            name,
            parts,
            thread: thread.map_err(|e| Error::io(&file, e))?,
        });
        Ok(())
    }

    /// Waits for the files that are being written, and enters them into the list of all.
    fn written(&mut self) -> Result<(), Error> {
        let Some(writing) = self.writing.take() else {
            return Ok(());
        };
        let Writing {
            time,
            name,
            parts,
            thread,
        } = writing;
        match thread.join() {
            Ok(outcome) => outcome?,
            Err(panic) => std::panic::resume_unwind(panic),
        }
        self.frd.written();
        self.pvd.push(time, &name)?;
        match parts.is_empty() {
            true => Ok(()),
            false => list_surfaces(&self.folder.directory, self.pvd.entries(), &parts),
        }
    }

    fn end(&mut self, summary: &Summary) -> Result<(), Error> {
        let text = match self.alike {
            false => serde_json::to_string_pretty(summary),
            true => (summary.without_process()).and_then(|s| serde_json::to_string_pretty(&s)),
        };
        let text = text.map_err(|e| Error::io(&self.folder.directory, std::io::Error::other(e)))?;
        let path = self.folder.directory.join("summary.json");
        write_atomically(&path, text.as_bytes())?;
        let places = self.folder.directory.join("culprits.vtu");
        let findings = &summary.findings;
        if findings.iter().all(|f| f.suspects.is_empty()) {
            // Those of an earlier run would mislead.
            return remove(&places);
        }
        doctor::write_culprits(&places, findings)
    }
}

/// Lists the surfaces of interfaces, a block each at every time.
fn list_surfaces(
    directory: &Path,
    fields: &[(f64, String)],
    parts: &[String],
) -> Result<(), Error> {
    let file = |part: &str, whole: &str| format!("{INTERFACES}/{}", surface_name(part, whole));
    pvd::write_parts(&directory.join(SURFACES), fields, parts, file)
}

/// Cuts the list of surfaces back to the fields that are known: which interfaces there are it says itself.
fn keep_surfaces(directory: &Path, fields: &[(f64, String)]) -> Result<(), Error> {
    let path = directory.join(SURFACES);
    match path.is_file() {
        true if !fields.is_empty() => list_surfaces(directory, fields, &pvd::parts(&path)?),
        _ => remove(&path),
    }
}

fn write_sheet(path: &Path, sheet: &Sheet) -> Result<(), Error> {
    let surface = vtu::Surface {
        points: &sheet.points,
        nodes: &sheet.nodes,
        faces: &sheet.faces,
        cells: &sheet.cells,
        fields: &sheet.fields,
    };
    vtu::write_surface(path, &surface)
}

/// What cycles took, a row each that is computed.
const CYCLES: &str = "cycles.csv";

/// Adds a row to a table, whose file is made with the first.
fn add_row(table: &mut Option<csv::History>, path: &Path, row: &Row) -> Result<(), Error> {
    if table.is_none() {
        *table = Some(csv::History::create(path, &row.names)?);
    }
    table.as_mut().map_or(Ok(()), |t| t.row(&row.values))
}

/// The table of cycles as it was at a checkpoint.
fn resume_cycles(directory: &Path, positions: &Positions) -> Result<Option<csv::History>, Error> {
    let path = directory.join(CYCLES);
    if !positions.lengths.iter().any(|(name, _)| name == CYCLES) {
        // It was begun after the checkpoint.
        return remove(&path).map(|()| None);
    }
    let columns = csv::read(&path)?.names.len();
    csv::History::resume(&path, columns).map(Some)
}

/// Removes a file that need not be there.
fn remove(path: &Path) -> Result<(), Error> {
    match std::fs::remove_file(path) {
        Err(e) if e.kind() != std::io::ErrorKind::NotFound => Err(Error::io(path, e)),
        _ => Ok(()),
    }
}

/// Files that a thread of their own writes.
struct Writing {
    /// `[the problem's unit of time]`.
    time: f64,
    /// The file of fields.
    name: String,
    /// The interfaces whose surfaces go with it.
    parts: Vec<String>,
    thread: JoinHandle<Result<(), Error>>,
}

/// Nothing is written into a folder that is no longer held, and none says for ever that a run goes on which a fault has ended.
impl Drop for ResultFiles {
    fn drop(&mut self) {
        if let Some(writing) = self.writing.take() {
            // Whoever wants to know how it went waits for the end of the run.
            let _ = writing.thread.join();
        }
        if std::thread::panicking() && self.folder.check().is_ok() {
            // What has happened is said elsewhere.
            let _ = self.folder.say_broken();
        }
    }
}

/// All fields of the last accepted state.
pub fn fields(view: &View) -> Fields {
    let model = view.model;
    let mut fields = Fields::default();
    let dofs = model.dofs;
    let vectors = |values: &[f64]| -> Vec<f64> {
        (0..model.mesh.points.len())
            .flat_map(|p| dofs.vector(values, p))
            .collect()
    };
    fields.all.push(Field {
        name: "U".into(),
        location: Location::Point,
        components: 3,
        values: vectors(&view.displacements()),
    });
    for (name, values) in ["V", "A"].into_iter().zip(view.velocities()) {
        if model.moves() {
            fields.all.push(Field {
                name: name.into(),
                location: Location::Point,
                components: 3,
                values: match values.is_empty() {
                    true => vec![0.0; 3 * model.mesh.points.len()],
                    false => vectors(&values),
                },
            });
        }
    }
    fields.all.push(Field {
        name: "RF".into(),
        location: Location::Point,
        components: 3,
        values: vectors(&reactions(view)),
    });
    let strained = view.strained();
    for body in &model.bodies {
        body.fields(&strained, &mut fields);
    }
    view.turn_tensors(&mut fields);
    for interface in view.contacts() {
        look::fields(interface, &mut fields);
    }
    fatigue::add_fields(view, &mut fields);
    view.add_second_fields(&mut fields);
    fields
}

/// The forces of supports by dof, in space `[N]`. One that holds a rigid body acts on it as a whole: its points have equal parts of it.
fn reactions(view: &View) -> Vec<f64> {
    let (model, fixed) = (view.model, view.held_dofs());
    let forces = view.frame.forces.iter().zip(&fixed);
    let mut out: Vec<f64> = forces
        .map(|(f, &held)| if held { *f } else { 0.0 })
        .collect();
    (model.frames).turn_out(&view.frame.state.u, &mut out);
    let mut swinging = vec![0.0; out.len()];
    let each = view.swinging().into_iter();
    each.for_each(|(dof, force)| swinging[dof] += force);
    for rigid in model.bodies.iter().filter_map(|b| b.rigid) {
        let link = &model.links.all()[rigid.link];
        for (dof, motion) in link.motions(model.dofs) {
            let Motion::Translation(axis) = motion else {
                continue;
            };
            if fixed[dof] {
                let part = (out[dof] + swinging[dof]) / link.points.len() as f64;
                link.points
                    .clone()
                    .for_each(|p| out[model.dofs.of(p, axis)] += part);
            }
        }
    }
    out
}

/// The number of its body for every cell.
fn owners(view: &View) -> Vec<usize> {
    let model = view.model;
    let bodies = model.bodies.iter().enumerate();
    bodies
        .flat_map(|(i, body)| {
            let blocks = &model.mesh.blocks[body.blocks.clone()];
            let cells = blocks.iter().map(|b| b.cell_ids.len()).sum();
            std::iter::repeat_n(i, cells)
        })
        .collect()
}

impl Observer for ResultFiles {
    fn see(&mut self, analysis: &Analysis, event: Event) -> Result<(), Error> {
        // A run that was stopped may go on.
        self.folder.resume()?;
        if matches!(
            event,
            Event::Output | Event::Modes(_) | Event::Checkpoint(_) | Event::End
        ) {
            self.folder.check()?;
        }
        let done = self.writing.as_ref().map(|w| w.thread.is_finished());
        if done == Some(true) || matches!(event, Event::Checkpoint(_)) {
            self.written()?;
        }
        match event {
            Event::Increment(row) => {
                self.frd.see(analysis, row);
                let path = self.folder.directory.join("history.csv");
                add_row(&mut self.history, &path, row)?;
            }
            Event::Cycle(row) => {
                let path = self.folder.directory.join(CYCLES);
                add_row(&mut self.cycles, &path, row)?;
            }
            Event::Output => self.output(analysis)?,
            Event::Modes(outcome) => {
                let mesh = self.mesh(analysis);
                modes::write(&self.folder.directory, analysis, &mesh, outcome)?;
            }
            // Hours of work are not given up because they cannot be kept twice.
            Event::Checkpoint(snapshot) => {
                if let Err(e) = self.save(snapshot) {
                    self.unsaved.get_or_insert((e.to_string(), false));
                }
            }
            Event::End => {
                let growth = &analysis.summary.vibrations.growth;
                let grown = modes::write_growth(&self.folder.directory, growth);
                let names = analysis.contacts().map(|c| c.name.clone());
                let events = analysis.model.reports.output.slip_events;
                let slipped = events.map_or(Ok(()), |plan| {
                    slip_events::write(&self.folder.directory, names, plan)
                });
                let ended = self.end(analysis.summary).and(grown).and(slipped);
                self.folder.release();
                ended?;
            }
            Event::Iteration(_)
            | Event::Accepted(_)
            | Event::Cutback(..)
            | Event::Note(_)
            | Event::Finding(_) => {}
        }
        Ok(())
    }

    fn settle(&mut self) -> Result<(), Error> {
        self.written()
    }

    fn remarks(&mut self) -> Vec<String> {
        match &mut self.unsaved {
            Some((why, told)) if !*told => {
                *told = true;
                vec![why.clone()]
            }
            _ => Vec::new(),
        }
    }
}

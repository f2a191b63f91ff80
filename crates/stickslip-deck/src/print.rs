//! `*NODE PRINT`, `*EL PRINT` and `*CONTACT PRINT` as CalculiX writes them to its `.dat` file.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::fs::File;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use stickslip::contact::look;

use stickslip::Error;
use stickslip::body::{CellState, cells};
use stickslip::contact::interface::ContactView;
use stickslip::io::Growing;
use stickslip::math::{Vec3, add, cross, dot, norm, scale, sub};
use stickslip::results::{Analysis, Event, Observer};

use crate::deck::{Print, Totals, When};
use crate::fortran::{row, time};
use crate::section;
use crate::translate::{PrintPlan, Translation};

/// Writes the `.dat` file of a deck while it runs: what an increment prints is in the file when its fields are.
#[derive(Debug)]
pub struct Printer {
    path: PathBuf,
    /// Made by the first thing that is to be in it, or to be read from it.
    file: Option<Growing>,
    plan: PrintPlan,
    /// The nodes of the deck that are points of its mesh.
    known: BTreeSet<u64>,
    /// Point by node, found at the first output.
    points: BTreeMap<u64, usize>,
    step: usize,
    increment: usize,
    time: f64,
    /// Increment that was printed last.
    done: Option<(usize, usize)>,
    last: bool,
}

/// Step and increment that stand last in a file.
fn last_printed(path: &Path) -> std::io::Result<Option<(usize, usize)>> {
    let number = |line: &str, head: &str| -> Option<usize> {
        line.trim().strip_prefix(head)?.trim().parse().ok()
    };
    let (mut step, mut increment) = (None, None);
    // Line by line: the file may be longer than there is memory.
    for line in BufReader::new(File::open(path)?).lines() {
        let line = line?;
        step = number(&line, "S T E P").or(step);
        increment = number(&line, "INCREMENT").or(increment);
    }
    Ok(step.zip(increment))
}

/// What elements resist with, and at reference points what acts on them from outside.
fn resisting(analysis: &Analysis) -> Vec<f64> {
    let mut out = analysis.internal_forces();
    let (model, frame) = (analysis.model, analysis.frame);
    for reference in &model.references {
        let hidden = model.links.all()[reference.link].hidden;
        let own = model.dofs.of(hidden, 0)..model.dofs.of(hidden + 2, 0);
        let outside = frame.forces[own.clone()]
            .iter()
            .zip(&frame.load[own.clone()]);
        for (out, (force, load)) in out[own].iter_mut().zip(outside) {
            *out = force + load;
        }
    }
    out
}

/// What a point has of a field; of the second point of a reference point rotations and moments. Points of bodies have none.
fn vector(
    analysis: &Analysis,
    values: &[f64],
    point: usize,
    turns: bool,
    key: &str,
) -> Option<Vec3> {
    let model = analysis.model;
    let links = &model.links;
    let Some(link) = links.of_hidden(point).map(|i| &links.all()[i]) else {
        return (!turns).then(|| model.dofs.vector(values, point));
    };
    if !turns && point == link.hidden {
        return Some(model.dofs.vector(values, point));
    }
    // Unknowns are lengths and what acts on them forces.
    let forces = key.starts_with('R');
    let unit = if forces {
        link.length
    } else {
        1.0 / link.length
    };
    let v = scale(unit, model.dofs.vector(values, link.hidden + 1));
    Some(match model.dofs.dim {
        2 => [0.0, 0.0, v[0]],
        _ => v,
    })
}

impl Printer {
    /// A printer for a deck, or none if the deck prints nothing.
    pub fn new(translation: &Translation, path: &Path) -> Option<Self> {
        translation
            .plan
            .prints
            .iter()
            .any(|p| !p.is_empty())
            .then(|| Printer {
                path: path.to_path_buf(),
                file: None,
                plan: translation.plan.clone(),
                known: translation.mesh.point_ids.iter().copied().collect(),
                points: BTreeMap::new(),
                step: 0,
                increment: 0,
                time: 0.0,
                done: None,
                last: false,
            })
    }

    /// Goes on with the file that is there.
    ///
    /// # Errors
    /// [`Error::Io`] if it cannot be read.
    pub fn resume(self) -> Result<Self, Error> {
        Ok(Printer {
            done: last_printed(&self.path).map_err(|e| Error::io(&self.path, e))?,
            file: Some(Growing::resume(&self.path)?),
            ..self
        })
    }

    fn add(&mut self, text: &str) -> Result<(), Error> {
        let file = match self.file.take() {
            Some(file) => file,
            None => Growing::create(&self.path, "")?,
        };
        self.file.insert(file).add(text)
    }

    fn due(&self, when: &When) -> bool {
        let near = |t: &f64| (t - self.time).abs() <= 1e-9 * self.time.abs();
        self.last
            || match when {
                When::Every(n) => self.increment.is_multiple_of((*n).max(1)),
                When::Times(name) => self
                    .plan
                    .times
                    .get(name)
                    .is_some_and(|t| t.iter().any(near)),
            }
    }

    fn print(&mut self, analysis: &Analysis) -> Result<(), Error> {
        let key = (self.step, self.increment);
        if self.done == Some(key) {
            return Ok(());
        }
        if self.points.is_empty() {
            let ids = &analysis.model.mesh.point_ids;
            self.points = ids.iter().enumerate().map(|(i, id)| (*id, i)).collect();
            // Numbers of points that cuts have doubled are none of the deck.
            self.points.retain(|id, _| self.known.contains(id));
            for (node, (name, turned)) in &self.plan.references {
                let mut all = analysis.model.references.iter();
                if let Some(reference) = all.find(|r| r.name == *name) {
                    let hidden = analysis.model.links.all()[reference.link].hidden;
                    self.points.insert(*node, hidden + usize::from(*turned));
                }
            }
        }
        let Some(prints) = self.plan.prints.get(self.step - 1).cloned() else {
            return Ok(());
        };
        let mut out = String::new();
        for p in &prints {
            match p {
                Print::Node {
                    set,
                    keys,
                    totals,
                    global,
                    when,
                } if self.due(when) => {
                    self.nodes(analysis, &mut out, set, keys, *totals, *global);
                }
                Print::Element {
                    set,
                    keys,
                    totals,
                    global,
                    when,
                } if self.due(when) => {
                    self.elements(analysis, &mut out, set, keys, *totals, *global);
                }
                Print::Section { surface, when } if self.due(when) => {
                    let faces = self
                        .plan
                        .surfaces
                        .get(surface)
                        .map_or(&[][..], Vec::as_slice);
                    section::print(analysis, &mut out, surface, faces, self.time);
                }
                Print::Contact {
                    pair,
                    keys,
                    totals,
                    when,
                } if self.due(when) => {
                    self.contact(analysis, &mut out, pair.as_ref(), keys, *totals)
                }
                _ => {}
            }
        }
        if out.is_empty() {
            return Ok(());
        }
        let mut head = String::new();
        if self.done.is_none_or(|(step, _)| step != self.step) {
            let _ = write!(
                head,
                "\n                        S T E P  {:>6}\n\n",
                self.step
            );
        }
        let _ = write!(
            head,
            "\n                                INCREMENT{:>6}\n\n",
            self.increment
        );
        self.add(&(head + &out))?;
        self.done = Some(key);
        Ok(())
    }

    fn nodes(
        &self,
        analysis: &Analysis,
        out: &mut String,
        set: &str,
        keys: &[String],
        totals: Totals,
        global: bool,
    ) {
        let dofs = analysis.model.dofs;
        let Some(nodes) = self.plan.node_sets.get(set) else {
            return;
        };
        let u = &analysis.frame.state.u;
        // The first direction of the node of a pretension is the shortening, its force that of the bolt.
        let drawn = |node: &u64, key: &str| {
            let name = self.plan.drawn.get(node)?;
            let mut all = analysis.couplings().report(u);
            let (_, force, shortening) = all.find(|(n, ..)| n == name)?;
            let value = match key {
                "U" => shortening,
                "RF" => force,
                _ => 0.0,
            };
            Some([value, 0.0, 0.0])
        };
        let zero = vec![0.0; dofs.count()];
        let or_zero = |v: &[f64]| {
            if v.is_empty() {
                zero.clone()
            } else {
                v.to_vec()
            }
        };
        for key in keys {
            if key.starts_with("NT") {
                let of = |t: f64| {
                    let heat = analysis.model.actions.heat.as_ref();
                    heat.map(|h| h.temperatures.at(t))
                };
                let all = of(analysis.frame.state.t);
                let _ = write!(
                    out,
                    "\n temperatures for set {set} and time {}\n\n",
                    time(self.time)
                );
                for (node, point) in nodes.iter().filter_map(|n| Some((n, self.points.get(n)?))) {
                    let known = all.as_ref().and_then(|all| all.get(*point));
                    let t = known.copied().unwrap_or(0.0);
                    row(out, &self.label(*node), &[t]);
                }
                continue;
            }
            let turns = key.starts_with("UR") || key.starts_with("RM");
            let (title, values) = match key.as_str() {
                "UR" => ("rotations (rx,ry,rz)", analysis.frame.state.u.clone()),
                "RM" => ("moments (mx,my,mz)", resisting(analysis)),
                "U" => ("displacements (vx,vy,vz)", analysis.frame.state.u.clone()),
                "V" => ("velocities (vx,vy,vz)", or_zero(&analysis.frame.state.v)),
                "A" => ("accelerations (vx,vy,vz)", or_zero(&analysis.frame.state.a)),
                // In motion too CalculiX prints what the elements resist with: no inertia, no damping, and no loads.
                "RF" => ("forces (fx,fy,fz)", resisting(analysis)),
                _ => continue,
            };
            let mut sum = [0.0; 3];
            if totals != Totals::Only {
                let _ = write!(
                    out,
                    "\n {title} for set {set} and time {}\n\n",
                    time(self.time)
                );
            }
            for node in nodes {
                let at_point = self.points.get(node);
                let at_point = at_point.and_then(|p| vector(analysis, &values, *p, turns, key));
                let Some(mut v) = at_point.or_else(|| drawn(node, key)) else {
                    continue;
                };
                // Nodes may have different axes: a sum has those of the model.
                sum = add(sum, v);
                if let Some(axes) = self.plan.node_axes.get(node).filter(|_| !global) {
                    v = axes.map(|axis| dot(axis, v));
                }
                if totals != Totals::Only {
                    row(out, &self.label(*node), &v);
                }
            }
            if totals != Totals::No && key == "RF" {
                let _ = write!(
                    out,
                    "\n total force (fx,fy,fz) for set {set} and time {}\n\n",
                    time(self.time)
                );
                row(out, "      ", &sum);
            }
        }
    }

    fn elements(
        &self,
        analysis: &Analysis,
        out: &mut String,
        set: &str,
        keys: &[String],
        totals: Totals,
        global: bool,
    ) {
        let Some(elements) = self.plan.element_sets.get(set) else {
            return;
        };
        let model = analysis.model;
        let mut by_id = BTreeMap::new();
        for body in &model.bodies {
            cells::each_cell_state(
                &body.elastic,
                &analysis.frame.state,
                &mut |state: &CellState| {
                    let block = &model.mesh.blocks[state.cell.block];
                    by_id.insert(block.cell_ids[state.cell.cell], state.clone());
                },
            );
        }
        let title =
            |what: &str| format!("\n {what} for set {set} and time {}\n\n", time(self.time));
        for key in keys {
            match key.as_str() {
                "S" | "E" | "ME" => {
                    let what = match key.as_str() {
                        "S" => "stresses (elem, integ.pnt.,sxx,syy,szz,sxy,sxz,syz)",
                        "ME" => "mechanical strains (elem, integ.pnt.,exx,eyy,ezz,exy,exz,eyz)",
                        _ => "strains (elem, integ.pnt.,exx,eyy,ezz,exy,exz,eyz)",
                    };
                    out.push_str(&title(what));
                    for (id, cell) in elements.iter().filter_map(|id| Some((id, by_id.get(id)?))) {
                        let axes = self.plan.element_axes.get(id).filter(|_| !global);
                        tensors(out, &self.label(*id), cell, key, axes);
                    }
                }
                "ELSE" | "EVOL" => {
                    let energy = key == "ELSE";
                    let mut sum = 0.0;
                    if totals != Totals::Only {
                        out.push_str(&title(if energy {
                            "internal energy (element, energy)"
                        } else {
                            "volume (element, volume)"
                        }));
                    }
                    for (id, cell) in elements.iter().filter_map(|id| Some((id, by_id.get(id)?))) {
                        // CalculiX counts no energy of hourglass control.
                        let v = if energy {
                            cell.energy - cell.hourglass
                        } else {
                            cell.volume
                        };
                        sum += v;
                        if totals != Totals::Only {
                            row(out, &self.label(*id), &[v]);
                        }
                    }
                    if totals != Totals::No {
                        out.push_str(&title(if energy {
                            "total internal energy"
                        } else {
                            "total volume"
                        }));
                        row(out, "      ", &[sum]);
                    }
                }
                _ => {}
            }
        }
    }

    fn contact(
        &self,
        analysis: &Analysis,
        out: &mut String,
        pair: Option<&(String, String)>,
        keys: &[String],
        totals: Totals,
    ) {
        let of_pair = |i: &ContactView| match pair {
            Some((slave, master)) => self
                .plan
                .pairs
                .iter()
                .any(|(name, s, m)| *name == i.name && s == slave && m == master),
            None => self.plan.pairs.iter().any(|(name, ..)| *name == i.name),
        };
        let interfaces = || analysis.contacts().filter(of_pair);
        let all = |what: &str| {
            format!(
                "\n {what} for all contact elements and time{}\n\n",
                time(self.time)
            )
        };
        for key in keys {
            match key.as_str() {
                "CDIS" | "CDISP" | "CSTR" | "CSTRESS" => {
                    let gaps = key.starts_with("CD");
                    out.push_str(&all(match gaps {
                        true => "relative contact displacement (slave node,normal,tang1,tang2)",
                        false => "contact stress (slave node,press,tang1,tang2)",
                    }));
                    for interface in interfaces() {
                        self.points_in_contact(analysis, interface, out, gaps);
                    }
                }
                "CNUM" => {
                    out.push_str(&format!(
                        "\n total number of contact elements for time {}\n\n",
                        time(self.time)
                    ));
                    let n: usize = interfaces().map(|i| count_in_contact(analysis, i)).sum();
                    let _ = writeln!(out, "{n:>10}");
                }
                "CELS" => {
                    if totals != Totals::Only {
                        out.push_str(&all("contact print energy (slave node,energy)"));
                        for interface in interfaces() {
                            self.energies_in_contact(analysis, interface, out);
                        }
                    }
                    if totals == Totals::No {
                        continue;
                    }
                    out.push_str(&format!(
                        "\n total contact spring energy for time {}\n\n",
                        time(self.time)
                    ));
                    let sum: f64 = interfaces().map(|i| look::energy(i).stored).sum();
                    row(out, "      ", &[sum]);
                }
                "CF" | "CFN" | "CFS" => {
                    for interface in interfaces() {
                        let named = self
                            .plan
                            .pairs
                            .iter()
                            .find(|(name, ..)| *name == interface.name);
                        let Some((_, slave, master)) = named else {
                            continue;
                        };
                        let part = match key.as_str() {
                            "CFN" => Part::Normal,
                            "CFS" => Part::Shear,
                            _ => Part::Whole,
                        };
                        statistics(analysis, interface, out, part, slave, master, self.time);
                    }
                }
                _ => {}
            }
        }
    }

    /// Gap and slip, or pressure and shear, of the points of an interface that are in contact.
    fn points_in_contact(
        &self,
        analysis: &Analysis,
        interface: ContactView,
        out: &mut String,
        gaps: bool,
    ) {
        let (names, columns) = look::table(interface, &analysis.frame.state.u);
        let column = |name: &str| names.iter().position(|n| n == name).map(|i| &columns[i]);
        let value = |name: &str, i: usize| column(name).map_or(0.0, |c| c[i]);
        let count = columns.first().map_or(0, Vec::len);
        for i in (0..count).filter(|&i| value("CSTATUS", i) > 0.0) {
            // Shear here is what acts on the slave; there it has the sign of the slip.
            let values = match gaps {
                true => [value("COPEN", i), value("CSLIP1", i), value("CSLIP2", i)],
                false => [
                    value("CPRESS", i),
                    -value("CSHEAR1", i),
                    -value("CSHEAR2", i),
                ],
            };
            row(out, &self.label(value("node", i) as u64), &values);
        }
    }

    /// What is stored at the points of an interface that are in contact.
    fn energies_in_contact(&self, analysis: &Analysis, interface: ContactView, out: &mut String) {
        let (names, columns) = look::table(interface, &analysis.frame.state.u);
        let column = |name: &str| names.iter().position(|n| n == name).map(|i| &columns[i]);
        let (Some(nodes), Some(status)) = (column("node"), column("CSTATUS")) else {
            return;
        };
        let stored = look::stored_by_point(interface);
        for (energy, (node, status)) in stored.iter().zip(nodes.iter().zip(status)) {
            if *status > 0.0 {
                row(out, &self.label(*node as u64), &[*energy]);
            }
        }
    }

    /// The number of a node or element, as the deck writes it, in its column.
    fn label(&self, number: u64) -> String {
        format!("{:>10}", self.plan.numbering.label(number))
    }
}

/// How many points of an interface are in contact.
fn count_in_contact(analysis: &Analysis, interface: ContactView) -> usize {
    let (names, columns) = look::table(interface, &analysis.frame.state.u);
    let at = names.iter().position(|n| n == "CSTATUS");
    at.map_or(0, |c| columns[c].iter().filter(|s| **s > 0.0).count())
}

/// Stresses, or strains, of an element at its points.
fn tensors(out: &mut String, label: &str, cell: &CellState, key: &str, axes: Option<&[Vec3; 3]>) {
    for (i, p) in cell.points.iter().enumerate() {
        // Shear strains are those of the tensor, half of ours.
        let v = match key {
            "S" => tensor(&p.stress, 1.0, axes),
            "E" => tensor(&p.strain, 0.5, axes),
            _ => {
                let elastic = std::array::from_fn(|v| p.strain[v] - p.thermal[v]);
                tensor(&elastic, 0.5, axes)
            }
        };
        row(out, &format!("{label} {:>3}", i + 1), &v);
    }
}

/// Components xx yy zz xy xz yz of a symmetric tensor along axes, from ours, which run xx yy zz xy yz xz.
fn tensor(v: &[f64; 6], shear: f64, axes: Option<&[Vec3; 3]>) -> [f64; 6] {
    let [xy, yz, xz] = [v[3], v[4], v[5]].map(|s| shear * s);
    let Some(a) = axes else {
        return [v[0], v[1], v[2], xy, xz, yz];
    };
    let m = [[v[0], xy, xz], [xy, v[1], yz], [xz, yz, v[2]]];
    let at = |i: usize, j: usize| dot(a[i], m.map(|row| dot(row, a[j])));
    [at(0, 0), at(1, 1), at(2, 2), at(0, 1), at(0, 2), at(1, 2)]
}

/// Which forces of a pair are summed.
#[derive(Debug, Clone, Copy)]
enum Part {
    Whole,
    Normal,
    Shear,
}

/// What `CF`, `CFN` and `CFS` print of a pair.
fn statistics(
    analysis: &Analysis,
    interface: ContactView,
    out: &mut String,
    part: Part,
    slave: &str,
    master: &str,
    t: f64,
) {
    let u = &analysis.frame.state.u;
    let r = look::resultant(interface, u);
    let (force, moment) = match part {
        Part::Whole => (add(r.normal, r.shear), r.moment),
        Part::Normal => (r.normal, sub(r.moment, r.moment_of_shear)),
        Part::Shear => (r.shear, r.moment_of_shear),
    };
    let (centre, normal) = look::centre_and_normal(interface, u);
    let about = sub(moment, cross(centre, force));
    let _ = write!(
        out,
        "\n statistics for slave set {slave}, master set {master} and time {}\n",
        time(t)
    );
    out.push_str("\n   total surface force (fx,fy,fz) and moment about the origin (mx,my,mz)\n\n");
    row(out, "  ", &[force, moment].concat());
    out.push_str("\n   center of gravity and mean normal\n\n");
    row(out, "  ", &[centre, normal].concat());
    out.push_str("\n   moment about the center of gravity(mx,my,mz)\n\n");
    row(out, "  ", &about);
    // Towards the slave it pushes; tension is positive there.
    let pull: f64 = normal.iter().zip(force).map(|(n, f)| n * f).sum();
    let shear = norm(sub(force, scale(pull, normal)));
    out.push_str("\n   area,  normal force (+ = tension) and shear force (size)\n\n");
    row(out, "  ", &[r.area, pull, shear]);
}

impl Observer for Printer {
    fn see(&mut self, analysis: &Analysis, event: Event) -> Result<(), Error> {
        match event {
            Event::Increment(row) => {
                let column = |name: &str| row.get(name).unwrap_or(0.0);
                self.step = column("STEP") as usize;
                self.increment = column("INC") as usize;
                self.time = column("TIME");
                let ends = analysis
                    .model
                    .steps
                    .get(self.step.saturating_sub(1))
                    .map(|s| s.end);
                self.last = ends.is_some_and(|end| self.time >= end * (1.0 - 1e-12));
            }
            Event::Output if self.step > 0 => self.print(analysis)?,
            // What is noted of how far it is has to find it; and at the end it is there, be it empty.
            Event::Checkpoint(_) | Event::End => self.add("")?,
            _ => {}
        }
        Ok(())
    }
}

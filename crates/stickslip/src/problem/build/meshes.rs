//! The meshes of all bodies, joined into one.

use std::collections::BTreeMap;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::super::{Body, MeshSource, Problem};
use super::cuts::{self, BuiltCut};
use super::fault::problem_error;
use super::heat::Law;
use crate::body::Part;
use crate::error::{Diagnostic, Error, MeshError};
use crate::io::gmsh;
use crate::math::{add, scale};
use crate::mesh::{Block, CellRef, Mesh, check, combine, cut};

/// Meshes from memory, by the name under which a problem asks for them, `mesh = { name = "NAME" }`, or that of a file that they stand for.
pub type Meshes = BTreeMap<PathBuf, Arc<Mesh>>;

/// All bodies in one mesh.
pub(super) struct Built {
    pub mesh: Mesh,
    pub bodies: Vec<BuiltBody>,
    pub cuts: Vec<BuiltCut>,
}

/// One of them.
pub(super) struct BuiltBody {
    pub name: String,
    pub points: Range<usize>,
    pub blocks: Range<usize>,
    pub parts: Vec<Part>,
    /// Points of its parts that are cut off from the first.
    pub pieces: Vec<Vec<usize>>,
    /// The material of each part.
    pub materials: Vec<String>,
}

pub(super) fn build(
    problem: &Problem,
    folder: &Path,
    given: &Meshes,
    laws: &BTreeMap<&str, Law>,
) -> Result<Built, Error> {
    let mut files: Meshes = BTreeMap::new();
    let mut mesh = Mesh::default();
    let (mut bodies, mut all_cuts) = (Vec::new(), Vec::new());
    for (name, body) in &problem.body {
        let mut own = source(name, body, folder, given, &mut files)?;
        place(body, &mut own);
        if own.dim != problem.model.space.dim() {
            return Err(problem_error(vec![
                Diagnostic::new(
                    format!("body.{name}"),
                    format!(
                        "the mesh has {} dimensions, but `model.space` is {}",
                        own.dim,
                        problem.model.space.name()
                    ),
                )
                .help("change `model.space` or the mesh"),
            ]));
        }
        check::check(&own).map_err(|mut e| {
            e.message = format!("body {name}: {}", e.message);
            if let MeshSource::Gmsh(file) = &body.mesh {
                e.file = Some(folder.join(&file.file));
            }
            e
        })?;
        let assigned = split(name, body, &mut own)?;
        let cuts = cuts::cut(problem, name, &mut own)?;
        let mut pieces = Vec::new();
        if !cuts.is_empty() {
            let cells: Vec<CellRef> = own.cells().collect();
            pieces = cut::pieces(&own, &cells).split_off(1);
        }
        let at = combine::append(&mut mesh, &own, name)?;
        let place = |piece: Vec<usize>| piece.into_iter().map(|p| p + at.points.start).collect();
        let pieces = pieces.into_iter().map(place).collect();
        let parts = assigned
            .iter()
            .zip(at.blocks.clone())
            .map(|(material, block)| {
                let law = &laws[material.as_str()];
                Part {
                    block,
                    stiffness: law.stiffness,
                    density: law.density,
                    dilation: law.dilation.clone(),
                    cells: None,
                }
            })
            .collect();
        bodies.push(BuiltBody {
            name: name.clone(),
            points: at.points.clone(),
            blocks: at.blocks.clone(),
            parts,
            pieces,
            materials: assigned,
        });
        all_cuts.extend(cuts.into_iter().map(|cut| cut.moved(&at)));
    }
    // New points have numbers of their own among those of all bodies.
    let doubled = all_cuts.iter().flat_map(|c: &BuiltCut| &c.pairs);
    let doubled: Vec<usize> = doubled.map(|[_, q]| *q).collect();
    doubled.iter().for_each(|q| mesh.point_ids[*q] = 0);
    let next = mesh.point_ids.iter().max().map_or(0, |n| n + 1);
    for (number, q) in (next..).zip(doubled) {
        mesh.point_ids[q] = number;
    }
    Ok(Built {
        mesh,
        bodies,
        cuts: all_cuts,
    })
}

fn source(
    name: &str,
    body: &Body,
    folder: &Path,
    given: &Meshes,
    files: &mut Meshes,
) -> Result<Mesh, Error> {
    match &body.mesh {
        MeshSource::Generate(generator) => Ok(generator.as_dyn().generate().map_err(|e| {
            let key = format!("body.{name}.generate");
            let mut finding = Diagnostic::new(key, e.message);
            finding.help = e.help;
            problem_error(vec![finding])
        })?),
        MeshSource::Gmsh(file) => {
            let path = folder.join(&file.file);
            let mesh = match given.get(Path::new(&file.file)) {
                Some(mesh) => mesh,
                None => {
                    if !files.contains_key(&path) {
                        files.insert(path.clone(), Arc::new(gmsh::read(&path)?));
                    }
                    &files[&path]
                }
            };
            let Some(group) = &file.group else {
                return Ok(Mesh::clone(mesh));
            };
            part(mesh, group).map_err(|help| {
                let key = format!("body.{name}.gmsh.group");
                let file = path.display();
                let what = format!("{file} has no physical group of cells `{group}`");
                problem_error(vec![Diagnostic::new(key, what).help(help)])
            })
        }
        MeshSource::Mesh(wanted) => {
            let Some(mesh) = given.get(Path::new(&wanted.name)) else {
                let key = format!("body.{name}.mesh.name");
                let what = format!("no mesh `{}` was given", wanted.name);
                let known: Vec<_> = given.keys().map(|k| k.display().to_string()).collect();
                let help = match known.is_empty() {
                    true => "Python gives meshes: `Problem.from_toml(FILE, meshes={\"NAME\": mesh})`; a mesh in a file is `gmsh.file`".to_string(),
                    false => format!("these were given: {}", known.join(", ")),
                };
                return Err(problem_error(vec![Diagnostic::new(key, what).help(help)]));
            };
            let Some(group) = &wanted.group else {
                return Ok(Mesh::clone(mesh));
            };
            part(mesh, group).map_err(|help| {
                let key = format!("body.{name}.mesh.group");
                let what = format!("mesh `{}` has no cell set `{group}`", wanted.name);
                problem_error(vec![Diagnostic::new(key, what).help(help)])
            })
        }
    }
}

/// The cells of a set as a mesh of their own; the names of those that there are if it is none of them.
fn part(mesh: &Mesh, group: &str) -> Result<Mesh, String> {
    match mesh.cell_sets.get(group) {
        Some(cells) => Ok(combine::extract(mesh, cells)),
        None => {
            let known: Vec<&str> = mesh.cell_sets.keys().map(String::as_str).collect();
            Err(format!("its groups of cells are: {}", known.join(", ")))
        }
    }
}

/// Scale, then shift.
fn place(body: &Body, mesh: &mut Mesh) {
    let shift = body.translate.as_deref().unwrap_or_default();
    let shift: [f64; 3] = std::array::from_fn(|i| shift.get(i).copied().unwrap_or(0.0));
    for x in &mut mesh.points {
        *x = add(scale(body.scale, *x), shift);
    }
}

/// Splits blocks so that each has one material; the material of each block.
fn split(name: &str, body: &Body, mesh: &mut Mesh) -> Result<Vec<String>, Error> {
    let fallback = body.material.clone();
    let mut of: Vec<Vec<Option<String>>> = mesh
        .blocks
        .iter()
        .map(|b| vec![fallback.clone(); b.cell_ids.len()])
        .collect();
    for (set, material) in &body.regions {
        let Some(cells) = mesh.cell_sets.get(set) else {
            let known: Vec<&str> = mesh.cell_sets.keys().map(String::as_str).collect();
            return Err(problem_error(vec![
                Diagnostic::new(
                    format!("body.{name}.regions.{set}"),
                    format!("the mesh has no cell set `{set}`"),
                )
                .help(format!("its cell sets are: {}", known.join(", "))),
            ]));
        };
        for c in cells {
            of[c.block][c.cell] = Some(material.clone());
        }
    }
    let mut materials = Vec::new();
    let mut blocks: Vec<Block> = Vec::new();
    let mut moved: BTreeMap<CellRef, CellRef> = BTreeMap::new();
    for (b, block) in mesh.blocks.iter().enumerate() {
        let n = block.kind.node_count();
        let mut here: BTreeMap<String, usize> = BTreeMap::new();
        for (cell, id) in block.cell_ids.iter().enumerate() {
            let Some(material) = of[b][cell].clone() else {
                return Err(
                    MeshError::new(format!("cell {id} of body {name} has no material"))
                        .help(format!(
                            "give `body.{name}.material`, or cover all cells by `regions`"
                        ))
                        .into(),
                );
            };
            let target = *here.entry(material.clone()).or_insert_with(|| {
                materials.push(material);
                blocks.push(Block {
                    kind: block.kind,
                    connectivity: Vec::new(),
                    cell_ids: Vec::new(),
                });
                blocks.len() - 1
            });
            let to = CellRef {
                block: target,
                cell: blocks[target].cell_ids.len(),
            };
            moved.insert(CellRef { block: b, cell }, to);
            blocks[target].cell_ids.push(*id);
            blocks[target]
                .connectivity
                .extend_from_slice(&block.connectivity[cell * n..(cell + 1) * n]);
        }
    }
    mesh.blocks = blocks;
    for cells in mesh.cell_sets.values_mut() {
        for c in cells.iter_mut() {
            *c = moved[c];
        }
    }
    for facets in mesh.facet_sets.values_mut() {
        for f in facets.iter_mut() {
            f.cell = moved[&f.cell];
        }
    }
    Ok(materials)
}

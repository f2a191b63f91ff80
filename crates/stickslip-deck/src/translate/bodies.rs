//! Connected cells are bodies.

use std::collections::{BTreeMap, BTreeSet};

use stickslip::io::abaqus::{self, ElementType, Space};
use stickslip::mesh::{Block, CellRef, FacetRef, Mesh};

use super::job::Job;
use super::names::problem_name;
use crate::card::Place;
use crate::deck::{Deck, SurfaceParts};

/// A body of the deck.
#[derive(Debug)]
pub(super) struct Body {
    pub name: String,
    /// Its elements.
    pub elements: BTreeSet<u64>,
    /// Index of its `*RIGID BODY`.
    pub rigid: Option<usize>,
    pub place: Place,
}

/// A material as elements have it: one of the deck, turned into axes.
#[derive(Debug)]
pub(super) struct Turned {
    pub name: String,
    /// Section of the first element.
    pub section: usize,
    /// Rows are the axes; none where the material has no directions.
    pub axes: Option<[[f64; 3]; 3]>,
}

/// All bodies.
#[derive(Debug)]
pub(super) struct Bodies {
    pub all: Vec<Body>,
    pub mesh: Mesh,
    pub space: Space,
    /// Body of a node.
    pub of_node: BTreeMap<u64, usize>,
    /// Cell, and body, of an element.
    pub of_element: BTreeMap<u64, (CellRef, usize)>,
    /// Face of a cell, and body, of an element that bounds one.
    pub of_face: BTreeMap<u64, (FacetRef, usize)>,
    /// Nodes of a `*RIGID BODY` that are part of bodies that are elastic: they follow its reference node.
    pub rigid_nodes: BTreeMap<usize, Vec<u64>>,
    /// Nodes that are reference points of the problem, with the names of these.
    pub references: BTreeMap<u64, String>,
    /// Section of an element: index into the deck's.
    pub section: BTreeMap<u64, usize>,
    /// Materials as elements have them, and which of them an element has.
    pub materials: Vec<Turned>,
    pub material: BTreeMap<u64, usize>,
}

impl Bodies {
    /// The mesh of all.
    pub fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    pub fn dim(&self) -> usize {
        self.mesh.dim
    }

    /// Whether a node is a reference point and nothing else.
    pub fn refers(&self, node: u64) -> bool {
        self.references.contains_key(&node) && !self.of_node.contains_key(&node)
    }

    /// Faces of the mesh, by body. Faces that both neighbours share are inside and left out where all are asked for.
    pub fn faces(&self, parts: &SurfaceParts) -> BTreeMap<usize, Vec<FacetRef>> {
        let mut out: BTreeMap<usize, Vec<FacetRef>> = BTreeMap::new();
        let SurfaceParts::Faces(faces) = parts else {
            return out;
        };
        let outside = match faces.iter().any(|(_, f)| f.is_none()) {
            true => self.mesh.boundary().into_iter().collect(),
            false => BTreeSet::new(),
        };
        for (element, face) in faces {
            let Some((cell, body)) = self.of_element.get(element) else {
                if let Some((facet, body)) = self.of_face.get(element) {
                    out.entry(*body).or_default().push(*facet);
                }
                continue;
            };
            let kind = self.mesh.blocks[cell.block].kind;
            let list = out.entry(*body).or_default();
            match face {
                Some(n) => list.extend(
                    abaqus::face_index(kind, *n).map(|face| FacetRef { cell: *cell, face }),
                ),
                None => list.extend(
                    outside
                        .range(
                            FacetRef {
                                cell: *cell,
                                face: 0,
                            }..,
                        )
                        .take_while(|f| f.cell == *cell),
                ),
            }
        }
        for list in out.values_mut() {
            let mut seen = BTreeSet::new();
            list.retain(|f| seen.insert(*f));
        }
        out
    }
}

/// Root of a tree of joined nodes.
fn root(parent: &mut BTreeMap<u64, u64>, mut n: u64) -> u64 {
    loop {
        let up = *parent.entry(n).or_insert(n);
        if up == n {
            return n;
        }
        // Shorter every time it is walked.
        let next = *parent.entry(up).or_insert(up);
        parent.insert(n, next);
        n = next;
    }
}

/// The bodies of a deck with their names and sections.
pub(super) fn find(job: &mut Job) -> Option<Bodies> {
    let mut bodies = connected(job)?;
    names(job, &mut bodies);
    sections(job, &mut bodies);
    rigid(job, &mut bodies);
    Some(bodies)
}

/// Cells by their elements, joined where they share nodes, and the space that they live in.
struct Joined {
    cells: BTreeMap<u64, ElementType>,
    parent: BTreeMap<u64, u64>,
    space: Space,
}

/// Joins the cells of a deck.
fn join(job: &mut Job, bounding: &BTreeSet<u64>) -> Option<Joined> {
    let deck = job.deck;
    let mut parent: BTreeMap<u64, u64> = BTreeMap::new();
    let mut space: Option<(Space, u64)> = None;
    let mut cells = BTreeMap::new();
    for (id, e) in &deck.elements {
        let Ok(t) = abaqus::element_type(&e.kind) else {
            continue;
        };
        if bounding.contains(id) {
            continue;
        }
        match space {
            None => space = Some((t.space, *id)),
            Some((s, _)) if s == t.space => {}
            Some((_, first)) => {
                let message = format!(
                    "element {} ({}) lives in another space than element {} ({})",
                    deck.label(*id),
                    e.kind,
                    deck.label(first),
                    deck.elements[&first].kind
                );
                job.error(
                    e.place,
                    message,
                    "solid, plane strain, plane stress and axisymmetric elements cannot be mixed",
                );
                return None;
            }
        }
        let first = root(&mut parent, e.nodes[0]);
        for &n in &e.nodes[1..] {
            let other = root(&mut parent, n);
            let (low, high) = (first.min(other), first.max(other));
            if low != high {
                parent.insert(high, low);
            }
        }
        // The lowest root may have moved.
        root(&mut parent, e.nodes[0]);
        cells.insert(*id, t);
    }
    let Some((space, _)) = space else {
        job.error(
            Place::default(),
            "the deck has no solid or plane elements",
            "bodies are made of C3D, CPE, CPS or CAX elements",
        );
        return None;
    };
    Some(Joined {
        cells,
        parent,
        space,
    })
}

/// The nodes of cells as points of a mesh without cells, and the index of each.
fn points(
    deck: &Deck,
    cells: &BTreeMap<u64, ElementType>,
    dim: usize,
) -> (Mesh, BTreeMap<u64, usize>) {
    let mut mesh = Mesh {
        dim,
        ..Mesh::default()
    };
    let used: BTreeSet<u64> = cells
        .keys()
        .flat_map(|id| deck.elements[id].nodes.iter().copied())
        .collect();
    let mut index = BTreeMap::new();
    for n in used {
        let mut x = deck.nodes[&n];
        if dim == 2 {
            x[2] = 0.0;
        }
        index.insert(n, mesh.points.len());
        mesh.points.push(x);
        mesh.point_ids.push(n);
    }
    (mesh, index)
}

/// The bodies as connected cells, without names.
pub(super) fn connected(job: &mut Job) -> Option<Bodies> {
    let deck = job.deck;
    let bounding = bounding(job);
    let Joined {
        cells,
        mut parent,
        space,
    } = join(job, &bounding)?;
    let dim = if space == Space::Solid { 3 } else { 2 };
    let (mut mesh, index) = points(deck, &cells, dim);
    // One block a kind of cell and way to integrate, in the order of the numbers.
    let mut blocks = BTreeMap::new();
    let (mut groups, mut all): (BTreeMap<u64, usize>, Vec<Body>) = (BTreeMap::new(), Vec::new());
    let (mut of_node, mut of_element) = (BTreeMap::new(), BTreeMap::new());
    for (id, t) in &cells {
        let e = &deck.elements[id];
        let group = root(&mut parent, e.nodes[0]);
        let body = *groups.entry(group).or_insert_with(|| {
            all.push(Body {
                name: String::new(),
                elements: BTreeSet::new(),
                rigid: None,
                place: e.place,
            });
            all.len() - 1
        });
        let at = *blocks.entry(t.kind.name()).or_insert_with(|| {
            mesh.blocks.push(Block {
                kind: t.kind,
                connectivity: Vec::new(),
                cell_ids: Vec::new(),
            });
            mesh.blocks.len() - 1
        });
        let block = &mut mesh.blocks[at];
        of_element.insert(
            *id,
            (
                CellRef {
                    block: at,
                    cell: block.cell_ids.len(),
                },
                body,
            ),
        );
        block.cell_ids.push(*id);
        let order = abaqus::node_order(t.kind);
        let nodes = (0..e.nodes.len()).map(|i| e.nodes[order.get(i).copied().unwrap_or(i)]);
        block.connectivity.extend(nodes.map(|n| index[&n]));
        e.nodes.iter().for_each(|n| {
            of_node.insert(*n, body);
        });
        all[body].elements.insert(*id);
    }
    let of_face = faces_of(job, &bounding, &mesh, &of_node);
    Some(Bodies {
        all,
        mesh,
        space,
        of_node,
        of_element,
        of_face,
        rigid_nodes: BTreeMap::new(),
        references: BTreeMap::new(),
        section: BTreeMap::new(),
        materials: Vec::new(),
        material: BTreeMap::new(),
    })
}

/// Elements that bound others: those that are no cells, and plane ones without section beside solid ones.
fn bounding(job: &mut Job) -> BTreeSet<u64> {
    let deck = job.deck;
    let space = |id: &u64| {
        let t = abaqus::element_type(&deck.elements[id].kind);
        t.ok().map(|t| t.space == Space::Solid)
    };
    let solid = deck.elements.keys().any(|id| space(id) == Some(true));
    let sectioned: BTreeSet<u64> = (deck.properties.sections.iter())
        .filter_map(|s| deck.element_sets.get(&s.set))
        .flatten()
        .copied()
        .collect();
    let mut out = BTreeSet::new();
    let mut plane: BTreeMap<&str, Place> = BTreeMap::new();
    for (id, e) in &deck.elements {
        match space(id) {
            None => out.insert(*id),
            Some(false) if solid && !sectioned.contains(id) => {
                plane.entry(&e.kind).or_insert(e.place);
                out.insert(*id)
            }
            Some(_) => false,
        };
    }
    for (kind, place) in plane {
        job.note(
            place,
            format!(
                "elements of type {kind} have no section: they are taken as faces of the solid ones, for their sets"
            ),
        );
    }
    out
}

/// The faces of cells that have the nodes of elements that bound them.
fn faces_of(
    job: &Job,
    bounding: &BTreeSet<u64>,
    mesh: &Mesh,
    of_node: &BTreeMap<u64, usize>,
) -> BTreeMap<u64, (FacetRef, usize)> {
    let deck = job.deck;
    let nodes = |id: &u64| -> Vec<u64> {
        let mut nodes = deck.elements[id].nodes.clone();
        nodes.sort_unstable();
        nodes
    };
    let least = mesh.dim;
    let wanted: BTreeMap<Vec<u64>, Vec<u64>> = bounding
        .iter()
        .filter(|id| deck.elements[id].nodes.len() >= least)
        .fold(BTreeMap::new(), |mut all, id| {
            all.entry(nodes(id)).or_default().push(*id);
            all
        });
    let mut out = BTreeMap::new();
    if wanted.is_empty() {
        return out;
    }
    for facet in mesh.boundary() {
        let (_, points) = mesh.facet_points(facet);
        let mut key: Vec<u64> = points.iter().map(|p| mesh.point_ids[*p]).collect();
        key.sort_unstable();
        let body = key.first().and_then(|n| of_node.get(n));
        if let (Some(ids), Some(body)) = (wanted.get(&key), body) {
            out.extend(ids.iter().map(|id| (*id, (facet, *body))));
        }
    }
    out
}

/// The instance that a body is the whole of.
fn instance(deck: &Deck, body: &Body) -> Option<String> {
    let numbering = &deck.numbering;
    let (name, _) = numbering.parts(*body.elements.first()?);
    let (first, last) = numbering.span(Some(numbering.find(name?)?), 0, u64::MAX)?;
    let mut all = deck.elements.range(first..=last);
    let whole = body.elements.range(..first).next().is_none()
        && all.all(|(id, _)| body.elements.contains(id));
    whole.then(|| problem_name(name.unwrap_or_default()))
}

/// A body is called like its instance, or the set of just its elements, or by a number.
fn names(job: &Job, bodies: &mut Bodies) {
    let deck = job.deck;
    let sectioned: Vec<&String> = deck.properties.sections.iter().map(|s| &s.set).collect();
    let mut taken = BTreeSet::new();
    for (i, body) in bodies.all.iter_mut().enumerate() {
        let same = |name: &&String| {
            let set = &deck.element_sets[*name];
            set.len() == body.elements.len() && set.iter().all(|e| body.elements.contains(e))
        };
        let known = sectioned
            .iter()
            .copied()
            .filter(|n| deck.element_sets.contains_key(*n));
        // Sets that a pre-processor made for itself are the last that one would name a body by.
        let own = |n: &&String| {
            let bare = deck.numbering.bare(n);
            !bare.starts_with("INTERNAL") && !bare.starts_with('_')
        };
        let all = deck.element_sets.keys();
        let mut sets = known.chain(all.clone()).filter(own).chain(all);
        let of_set = || sets.find(same).map(|n| problem_name(n));
        body.name = instance(deck, body)
            .or_else(of_set)
            .filter(|n| !taken.contains(n))
            .unwrap_or_else(|| format!("body-{}", i + 1));
        taken.insert(body.name.clone());
    }
}

fn sections(job: &mut Job, bodies: &mut Bodies) {
    let deck = job.deck;
    for (i, s) in deck.properties.sections.iter().enumerate() {
        for e in deck.element_sets.get(&s.set).into_iter().flatten() {
            bodies.section.insert(*e, i);
        }
    }
    let bare = bodies
        .of_element
        .keys()
        .find(|e| !bodies.section.contains_key(e));
    if let Some(e) = bare {
        let place = deck.elements[e].place;
        job.error(
            place,
            format!("element {} has no section", deck.label(*e)),
            "give its set a *SOLID SECTION with a material",
        );
    }
}

fn rigid(job: &mut Job, bodies: &mut Bodies) {
    let deck = job.deck;
    for (i, r) in deck.connectors.rigid.iter().enumerate() {
        let elements: Vec<u64> = r
            .elements
            .iter()
            .flat_map(|s| deck.element_sets.get(s).into_iter().flatten().copied())
            .collect();
        let nodes: Vec<u64> = r
            .nodes
            .iter()
            .flat_map(|s| deck.node_sets.get(s).into_iter().flatten().copied())
            .collect();
        let owners: BTreeSet<usize> = elements
            .iter()
            .filter_map(|e| bodies.of_element.get(e).map(|(_, b)| *b))
            .chain(nodes.iter().filter_map(|n| bodies.of_node.get(n).copied()))
            .collect();
        let whole = |b: &usize| {
            let body = &bodies.all[*b];
            let mine: BTreeSet<u64> = elements.iter().copied().collect();
            let points: BTreeSet<u64> = nodes.iter().copied().collect();
            body.elements.iter().all(|e| {
                mine.contains(e) || deck.elements[e].nodes.iter().all(|n| points.contains(n))
            })
        };
        if elements.is_empty() && !owners.is_empty() && !owners.iter().any(whole) {
            bodies.rigid_nodes.insert(i, nodes);
            continue;
        }
        if owners.is_empty() || !owners.iter().all(whole) {
            job.error(
                r.place,
                "the rigid body is not the whole of a connected body",
                "a body is rigid as a whole: name all its elements, or cut it off and glue it on with *TIE",
            );
            continue;
        }
        if owners.len() > 1 {
            job.error(
                r.place,
                "the rigid body consists of several parts that do not touch",
                "give each part a *RIGID BODY",
            );
            continue;
        }
        for b in owners {
            bodies.all[b].rigid = Some(i);
        }
    }
}

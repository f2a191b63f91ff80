//! The `.frd` file, read by a reader of its own that takes every column at its word, and compared with the `.vtu` files of the same run.

use std::collections::BTreeMap;
use std::path::Path;

use crate::support::{build, dragged, folder, problem};
use stickslip::io::vtu::{self, PointFields};
use stickslip::results::{ResultFiles, fields};

/// What a file holds.
#[derive(Debug, Default)]
struct Read {
    nodes: BTreeMap<u64, [f64; 3]>,
    /// Type and nodes by number.
    elements: BTreeMap<u64, (usize, Vec<u64>)>,
    blocks: Vec<BlockRead>,
}

#[derive(Debug, Default)]
struct BlockRead {
    name: String,
    step: usize,
    increment: usize,
    output: usize,
    time: f64,
    components: Vec<String>,
    values: BTreeMap<u64, Vec<f64>>,
}

/// The number in some columns, counted from 0, which must be all of it.
fn number<T: std::str::FromStr>(line: &str, from: usize, to: usize) -> T {
    let text = line.get(from..to).unwrap_or_else(|| panic!("{line:?}"));
    let parsed = text.trim_start().parse();
    parsed.unwrap_or_else(|_| panic!("{text:?} in {line:?}"))
}

fn values(line: &str, count: usize) -> Vec<f64> {
    assert_eq!(line.len(), 13 + 12 * count, "{line:?}");
    let column = |i| number(line, 13 + 12 * i, 25 + 12 * i);
    (0..count).map(column).collect()
}

/// Nodes of the types 1 to 12.
const NODES: [usize; 12] = [8, 6, 4, 20, 15, 10, 3, 6, 4, 8, 2, 3];

/// The bytes of a file, line by line, with what has no lines between them.
struct Cursor<'a> {
    bytes: &'a [u8],
    binary: bool,
}

impl Cursor<'_> {
    fn line(&mut self) -> String {
        let end = self.bytes.iter().position(|&b| b == b'\n');
        let (line, rest) = self.bytes.split_at(end.expect("a line ends"));
        self.bytes = &rest[1..];
        String::from_utf8(line.to_vec()).expect("lines are text")
    }

    fn take<const N: usize>(&mut self) -> [u8; N] {
        let (first, rest) = self.bytes.split_first_chunk().expect("bytes");
        self.bytes = rest;
        *first
    }

    fn int(&mut self) -> u64 {
        u64::try_from(i32::from_le_bytes(self.take())).expect("a number")
    }

    /// A number of entries behind a head like `2C`.
    fn count(&mut self, head: &str, [text, binary]: [&str; 2]) -> usize {
        let line = self.line();
        assert!(line.starts_with(head), "{line:?}");
        let flag = if self.binary { binary } else { text };
        assert!(line.len() == 74 && line.ends_with(flag), "{line:?}");
        number(&line, 24, 36)
    }

    fn end_block(&mut self) {
        if !self.binary {
            assert_eq!(self.line(), " -3");
        }
    }

    fn nodes(&mut self, read: &mut Read) {
        for _ in 0..self.count("    2C", ["1", "3"]) {
            let (node, x) = match self.binary {
                true => {
                    let node = self.int();
                    let x: [f64; 3] = std::array::from_fn(|_| f64::from_le_bytes(self.take()));
                    (node, x.to_vec())
                }
                false => {
                    let line = self.line();
                    assert!(line.starts_with(" -1"), "{line:?}");
                    (number(&line, 3, 13), values(&line, 3))
                }
            };
            let x = x.try_into().expect("three coordinates");
            assert!(
                read.nodes.insert(node, x).is_none(),
                "{node} is there twice"
            );
        }
        self.end_block();
    }

    fn elements(&mut self, read: &mut Read) {
        for _ in 0..self.count("    3C", ["1", "2"]) {
            let (id, kind, nodes) = match self.binary {
                true => {
                    let [id, kind, group, body] = std::array::from_fn(|_| self.int());
                    assert!(group == 0 && body > 0);
                    let count = NODES[kind as usize - 1];
                    (id, kind, (0..count).map(|_| self.int()).collect())
                }
                false => {
                    let line = self.line();
                    assert!(line.starts_with(" -1") && line.len() == 28, "{line:?}");
                    let kind: u64 = number(&line, 13, 18);
                    let mut nodes = Vec::new();
                    while nodes.len() < NODES[kind as usize - 1] {
                        let line = self.line();
                        assert!(line.starts_with(" -2"), "{line:?}");
                        let here = (line.len() - 3) / 10;
                        assert!(here <= 10 && line.len() == 3 + 10 * here);
                        nodes.extend(
                            (0..here).map(|i| number::<u64>(&line, 3 + 10 * i, 13 + 10 * i)),
                        );
                    }
                    (number(&line, 3, 13), kind, nodes)
                }
            };
            let known = |node: &u64| read.nodes.contains_key(node);
            assert!(nodes.iter().all(known), "{id}");
            read.elements.insert(id, (kind as usize, nodes));
        }
        self.end_block();
    }

    /// A block of values behind its first line.
    fn block(&mut self, first: &str, so_many: usize) -> BlockRead {
        assert_eq!(first.len(), 70, "{first:?}");
        assert_eq!(number::<usize>(first, 10, 36), so_many);
        let head = self.line();
        assert!(head.starts_with("  100CL") && head.len() == 75, "{head:?}");
        assert!(head.ends_with(if self.binary { " 2" } else { " 1" }));
        let mut block = BlockRead {
            increment: number(first, 36, 48),
            step: number(first, 48, 60),
            time: number(&head, 12, 24),
            output: number(&head, 58, 63),
            ..BlockRead::default()
        };
        assert_eq!(number::<usize>(&head, 7, 12), 100 + block.output);
        let name = self.line();
        assert!(name.starts_with(" -4  ") && name.len() == 23, "{name:?}");
        block.name = name[5..13].trim_end().to_string();
        // The last of them may be one that readers compute.
        let named = number::<usize>(&name, 13, 18);
        let mut count = named;
        for _ in 0..named {
            let line = self.line();
            assert!(line.starts_with(" -5  "), "{line:?}");
            if line.ends_with("    1ALL") {
                count -= 1;
            } else {
                assert_eq!(line.len(), 33, "{line:?}");
                block.components.push(line[5..13].trim_end().to_string());
            }
        }
        for _ in 0..number::<usize>(&head, 24, 36) {
            let (node, values) = match self.binary {
                true => {
                    let node = self.int();
                    let value = |_| f64::from(f32::from_le_bytes(self.take()));
                    (node, (0..count).map(value).collect())
                }
                false => {
                    let line = self.line();
                    assert!(line.starts_with(" -1"), "{line:?}");
                    (number(&line, 3, 13), values(&line, count))
                }
            };
            block.values.insert(node, values);
        }
        self.end_block();
        block
    }
}

fn read(path: &Path, binary: bool) -> Read {
    let bytes = std::fs::read(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let mut cursor = Cursor {
        bytes: &bytes,
        binary,
    };
    let mut read = Read::default();
    assert!(cursor.line().starts_with("    1C"));
    while cursor.bytes.starts_with(b"    1U") {
        assert_eq!(cursor.line().len(), 66);
    }
    cursor.nodes(&mut read);
    cursor.elements(&mut read);
    loop {
        let line = cursor.line();
        match line.strip_prefix("    1PSTEP") {
            Some(_) => {
                let block = cursor.block(&line, read.blocks.len() + 1);
                read.blocks.push(block);
            }
            None => {
                assert_eq!(line, " 9999");
                assert!(cursor.bytes.is_empty(), "something is behind the end");
                return read;
            }
        }
    }
}

impl Read {
    fn block(&self, name: &str, output: usize) -> &BlockRead {
        let mut blocks = self.blocks.iter();
        let found = blocks.find(|b| b.name == name && b.output == output);
        found.unwrap_or_else(|| panic!("no {name} of output {output}"))
    }
}

/// Whether a number is that which was written with six digits, or with 24 bits.
fn same(a: f64, b: f64) -> bool {
    (a - b).abs() <= 5.001e-6 * b.abs() + 1e-99
}

/// Compares components of a block with those of an array of the `.vtu` of the same time.
fn compare(block: &BlockRead, vtu: &PointFields, name: &str, factors: &[f64]) {
    let ids = &vtu.arrays["NODE_ID"].values;
    let array = &vtu.arrays[name];
    assert_eq!(block.values.len(), ids.len(), "{name}");
    let mut largest = 0.0f64;
    for (id, theirs) in ids.iter().zip(array.values.chunks_exact(array.components)) {
        let ours = &block.values[&(*id as u64)];
        assert_eq!(ours.len(), theirs.len());
        for ((a, b), factor) in ours.iter().zip(theirs).zip(factors) {
            assert!(same(*a, factor * b), "{name} of node {id}: {a} and {b}");
            largest = largest.max(a.abs());
        }
    }
    assert!(largest > 0.0, "{name} is nothing but zeros");
}

fn compare_contact(block: &BlockRead, vtu: &PointFields) {
    let names = ["COPEN", "CSLIP1", "CSLIP2", "CPRESS", "CSHEAR1", "CSHEAR2"];
    assert_eq!(block.components, names);
    let ids = &vtu.arrays["NODE_ID"].values;
    let mut there = 0;
    for (p, id) in ids.iter().enumerate() {
        if vtu.arrays["CPRESS"].values[p].is_nan() {
            assert!(!block.values.contains_key(&(*id as u64)));
            continue;
        }
        there += 1;
        for (value, name) in block.values[&(*id as u64)].iter().zip(names) {
            let sign = if name.starts_with("CSHEAR") {
                -1.0
            } else {
                1.0
            };
            let wanted = vtu.arrays.get(name).map_or(0.0, |a| sign * a.values[p]);
            assert!(same(*value, wanted), "{name} of {id}: {value} {wanted}");
        }
    }
    assert!(there > 0 && there == block.values.len());
}

/// Runs a problem and returns the folder of its results.
fn run(text: &str, name: &str) -> std::path::PathBuf {
    let folder = folder(name);
    let mut simulation = build(&problem(text)).unwrap_or_else(|e| panic!("{e}"));
    let mut files =
        ResultFiles::new(&folder, &Default::default()).unwrap_or_else(|e| panic!("{e}"));
    simulation
        .run(&mut [&mut files])
        .unwrap_or_else(|e| panic!("{e}"));
    assert!(fields(&simulation.view()).get("S").is_some());
    folder
}

/// A block on a base in the plane; its mesh has numbers that are there twice, so that nodes are numbered anew.
fn case(frd: &str) -> String {
    let dragged = dragged("sparse", ["[6, 2]", "[3, 3]", "1e12", "1e-3", "2"]);
    format!(
        "{dragged}\nmaterial.m.isotropic = {{ young = 1e9, poisson = 0.3 }}\noutput.frd = \"{frd}\"\n{}",
        "step = [{ duration = 1, increments = { fixed = 2 } }, { duration = 1, increments = { fixed = 2 } }]\n"
    )
}

/// The same with tables in an order that TOML takes.
fn text_of(frd: &str) -> String {
    let all = case(frd);
    let at = all.find("[body.base]").expect("a body");
    let tail = all.find("material.m.isotropic").expect("a material");
    // Keys of the root come before the first table.
    format!("{}{}{}", &all[..at], &all[tail..], &all[at..tail])
}

#[test]
fn the_file_has_the_fields_of_the_vtu_files() {
    for (frd, binary) in [("text", false), ("binary", true)] {
        let folder = run(&text_of(frd), &format!("frd-{frd}"));
        let read = read(&folder.join("fields.frd"), binary);
        let series = stickslip::io::pvd::read(&folder.join("fields.pvd")).expect("a collection");
        assert_eq!(series.len(), 4);
        for (i, (time, name)) in series.iter().enumerate() {
            let mut vtu = vtu::read(&folder.join(name)).expect("a grid");
            // The bodies are numbered one by one: in the file they have numbers from 1 together.
            let count = vtu.points.len();
            let numbers = (1..=count).map(|n| n as f64).collect();
            vtu.arrays.get_mut("NODE_ID").expect("numbers").values = numbers;
            for (id, x) in (1..).zip(&vtu.points) {
                assert!(read.nodes[&id].iter().zip(x).all(|(a, b)| same(*a, *b)));
            }
            let disp = read.block("DISP", i + 1);
            assert!(same(disp.time, *time));
            assert_eq!((disp.step, disp.increment), (1 + i / 2, 1 + i % 2));
            compare(disp, &vtu, "U", &[1.0; 3]);
            compare(read.block("STRESS", i + 1), &vtu, "S", &[1.0; 6]);
            compare_contact(read.block("CONTACT", i + 1), &vtu);
            let names = read.blocks.iter().filter(|b| b.output == i + 1);
            let names: Vec<&str> = names.map(|b| b.name.as_str()).collect();
            let all = ["DISP", "STRESS", "TOSTRAIN", "FORC", "ENER", "CONTACT"];
            assert_eq!(names, all);
        }
        let kinds: Vec<usize> = read.elements.values().map(|(kind, _)| *kind).collect();
        assert_eq!(kinds, vec![9; 12 + 9]);
    }
}

/// A block of one cell that is pulled along z by a strain of 1e-3, whatever its cells are.
fn pulled(generate: &str) -> String {
    format!(
        r#"format = 1
model.space = "solid"
body.b = {{ generate.box = {{ from = [0, 0, 0], to = [1, 1, 1], cells = [1, 1, 1]{generate} }}, material = "m" }}
material.m.isotropic = {{ young = 1e9, poisson = 0.25 }}
support.x = {{ set = "b.left", x = 0 }}
support.y = {{ set = "b.front", y = 0 }}
support.z = {{ set = "b.bottom", z = 0 }}
support.top = {{ set = "b.top", z = 1e-3 }}
output.frd = "text"
step = [{{ increments = {{ fixed = 1 }} }}]
"#
    )
}

#[test]
fn a_uniform_strain_is_written_as_it_is_and_nodes_stand_amid_their_edges() {
    for (order, kind) in [("", 1), (", element = \"hex20\"", 4)] {
        let folder = run(&pulled(order), &format!("frd-pulled-{kind}"));
        let read = read(&folder.join("fields.frd"), false);
        let (found, nodes) = &read.elements[&1];
        assert_eq!(*found, kind);
        // Edges of the bottom, from bottom to top, of the top.
        let edges = [
            [0, 1],
            [1, 2],
            [2, 3],
            [3, 0],
            [0, 4],
            [1, 5],
            [2, 6],
            [3, 7],
            [4, 5],
            [5, 6],
            [6, 7],
            [7, 4],
        ];
        for (node, [a, b]) in nodes[8..].iter().zip(edges) {
            let [x, a, b] = [*node, nodes[a], nodes[b]].map(|n| read.nodes[&n]);
            assert!((0..3).all(|i| (x[i] - 0.5 * (a[i] + b[i])).abs() < 1e-6));
        }
        let near = |a: f64, b: f64| (a - b).abs() < 1e-8 + 1e-5 * b.abs();
        for e in read.block("TOSTRAIN", 1).values.values() {
            let wanted = [-2.5e-4, -2.5e-4, 1e-3, 0.0, 0.0, 0.0];
            assert!(e.iter().zip(wanted).all(|(a, b)| near(*a, b)), "{e:?}");
        }
        for energy in read.block("ENER", 1).values.values() {
            assert!(near(energy[0], 500.0), "{energy:?}");
        }
        // A force of 1e6 on either end, and none else.
        let forces = &read.block("FORC", 1).values;
        let sum = |z: f64| -> f64 {
            let at = forces.iter().filter(|(n, _)| read.nodes[n][2] == z);
            at.map(|(_, f)| f[2]).sum()
        };
        assert!((sum(1.0) - 1e6).abs() < 10.0 && (sum(0.0) + 1e6).abs() < 10.0);
        assert!(
            read.blocks
                .iter()
                .all(|b| b.name != "CONTACT" && b.name != "VELO")
        );
    }
}

#[test]
fn shear_strains_are_those_of_the_tensor() {
    let text = pulled("").replace(
        "support.top = { set = \"b.top\", z = 1e-3 }",
        "support.top = { set = \"b.top\", x = 1e-3, y = 0, z = 0 }\nsupport.held = { set = \"b.bottom\", x = 0, y = 0 }",
    );
    let text = text.replace("support.x = { set = \"b.left\", x = 0 }\n", "");
    let text = text.replace("support.y = { set = \"b.front\", y = 0 }\n", "");
    let folder = run(&text, "frd-sheared");
    let read = read(&folder.join("fields.frd"), false);
    for e in read.block("TOSTRAIN", 1).values.values() {
        assert!((e[5] - 5e-4).abs() < 1e-8, "{e:?}");
    }
}

/// A square that is stretched, sheared and turned, by the places of its corners; in a frame with an axle by what they are displaced by in it.
#[test]
fn strains_of_bodies_that_turn_are_along_the_axes_of_space() {
    let [xx, yy, xy] = [2e-3, -1e-3, 1.5e-3];
    let corners = [("left", -1.0), ("right", 1.0)];
    let corners =
        corners.map(|(side, x)| [("bottom", -1.0), ("top", 1.0)].map(|(end, y)| (side, end, x, y)));
    for (kind, angle) in [
        ("rotation = \"corotational\"", 0.5),
        ("rotation = \"large\"", 0.5),
        ("rotation = \"large\"", std::f64::consts::FRAC_PI_2),
        ("rotation.with = \"axle\"", 0.5),
        ("rotation.with = \"axle\"", -2.0),
    ] {
        let own: f64 = if kind.contains("axle") { 0.0 } else { angle };
        let support = |&(side, end, x, y): &(&str, &str, f64, f64)| {
            let strained = [x + xx * x + xy * y, y + xy * x + yy * y];
            let (s, c) = own.sin_cos();
            let place = [
                c * strained[0] - s * strained[1],
                s * strained[0] + c * strained[1],
            ];
            let [u, v] = [place[0] - x, place[1] - y];
            format!(
                "support.{end}-{side} = {{ set = \"block.{end}-{side}\", x = {u:e}, y = {v:e} }}\n"
            )
        };
        let supports: String = corners.as_flattened().iter().map(support).collect();
        let axle = match kind.contains("axle") {
            true => format!(
                "reference.axle.point = [0, 0]\nsupport.axle = {{ set = \"axle\", x = 0.3, y = 0, rotation-z = {angle} }}\n"
            ),
            false => String::new(),
        };
        let text = format!(
            r#"format = 1
model.space = "plane-strain"
body.block = {{ generate.rectangle = {{ from = [-1, -1], to = [1, 1], cells = [1, 1] }}, material = "m", {kind} }}
body.other = {{ generate.rectangle = {{ from = [5, 0], to = [6, 1], cells = [1, 1] }}, material = "m" }}
material.m.isotropic = {{ young = 1e5, poisson = 0.3 }}
support.other = {{ set = "other.bottom", x = 0, y = 0 }}
output.frd = "text"
step = [{{ increments = {{ fixed = 1 }} }}]
{supports}{axle}"#
        );
        let folder = run(&text, "frd-turned");
        let read = read(&folder.join("fields.frd"), false);
        // R ε Rᵀ by the double angle.
        let (mean, half) = (0.5 * (xx + yy), 0.5 * (xx - yy));
        let (s, c) = (2.0 * angle).sin_cos();
        let along = half * c - xy * s;
        let wanted = [mean + along, mean - along, 0.0, half * s + xy * c, 0.0, 0.0];
        let strains = read.block("TOSTRAIN", 1).values.iter();
        let mut own = strains
            .filter(|(node, _)| read.nodes[*node][0] < 2.0)
            .peekable();
        assert!(own.peek().is_some());
        for (node, found) in own {
            for (a, b) in found.iter().zip(wanted) {
                assert!(
                    (a - b).abs() < 2e-8,
                    "{kind} {angle} {node}: {found:?} {wanted:?}"
                );
            }
        }
    }
}

#[test]
fn velocities_are_written_in_motion_and_no_file_where_none_is_asked_for() {
    let text = pulled("").replace(
        "step = [{ increments = { fixed = 1 } }]",
        "step = [{ duration = 1e-3, increments = { fixed = 2 }, dynamic = {} }]",
    );
    let text = text.replace("poisson = 0.25", "poisson = 0.25, density = 1000");
    let folder = run(&text, "frd-motion");
    let read = read(&folder.join("fields.frd"), false);
    let vtu = vtu::read(&folder.join("fields_00001.vtu")).expect("a grid");
    compare(read.block("VELO", 2), &vtu, "V", &[1.0; 3]);
    let folder = run(
        &pulled("").replace("output.frd = \"text\"\n", ""),
        "frd-none",
    );
    assert!(!folder.join("fields.frd").exists());
}

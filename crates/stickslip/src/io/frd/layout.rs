use super::{columns, kinds};
use crate::io::numbers::Numbers;
use crate::mesh::Mesh;

/// How numbers are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Encoding {
    /// As text.
    Text,
    /// As bytes, in little-endian order.
    Binary,
}

/// Nodes a line in the long format.
const NODES_A_LINE: usize = 10;

/// What all blocks of a file have in common: which points of the mesh are in it, and under which numbers.
#[derive(Debug, Clone)]
pub struct Layout {
    pub(super) encoding: Encoding,
    /// Points that cells have, ascending.
    points: Vec<usize>,
    /// The number of every point of the mesh.
    numbers: Vec<u64>,
    /// What a file begins with.
    pub(super) head: Vec<u8>,
}

impl Layout {
    /// The layout of a mesh, whose cells are owned by these bodies, a number for every cell, blocks in order.
    ///
    /// Bodies stand where the format has materials. Points and cells have the numbers of the mesh, or 1, 2, … where one is there twice or too large. Points
    /// without cells are left out, as programs that read the format draw every node.
    pub fn new(
        mesh: &Mesh,
        title: &str,
        bodies: &[&str],
        owners: &[usize],
        encoding: Encoding,
    ) -> Layout {
        let mut used = vec![false; mesh.points.len()];
        for block in &mesh.blocks {
            for &point in &block.connectivity {
                used[point] = true;
            }
        }
        let numbers = Numbers::of(mesh);
        let mut layout = Layout {
            encoding,
            points: (0..used.len()).filter(|&p| used[p]).collect(),
            numbers: numbers.points,
            head: Vec::new(),
        };
        layout.add_title(title, bodies);
        layout.add_nodes(mesh);
        layout.add_elements(mesh, &numbers.cells, owners);
        layout
    }

    /// Points of the mesh that are in the file, ascending.
    pub fn points(&self) -> &[usize] {
        &self.points
    }

    /// The number of a point of the mesh.
    pub(super) fn number(&self, point: usize) -> u64 {
        self.numbers[point]
    }

    fn line(&mut self, text: &str) {
        self.head.extend(text.bytes());
        self.head.push(b'\n');
    }

    /// There is no date: what a run writes does not depend on when it ran.
    fn add_title(&mut self, title: &str, bodies: &[&str]) {
        self.line(format!("    1C{}", plain(title, 40)).trim_end());
        let version = concat!("Version ", env!("CARGO_PKG_VERSION"));
        for (key, value) in [("PGM", "stickslip"), ("VERSION", version)] {
            self.line(&format!("    1U{key:<18}{value:<42}"));
        }
        for (i, body) in bodies.iter().enumerate() {
            let number = columns::whole(i + 1, 5);
            self.line(&format!("    1UMAT{number}{:<52}", plain(body, 52)));
        }
    }

    fn add_nodes(&mut self, mesh: &Mesh) {
        let flag = match self.encoding {
            Encoding::Text => 1,
            Encoding::Binary => 3,
        };
        self.line(&format!(
            "    2C{:18}{:>12}{:37}{flag}",
            "",
            self.points.len(),
            ""
        ));
        for &point in &self.points {
            let number = self.numbers[point];
            match self.encoding {
                Encoding::Text => {
                    let head = &mut self.head;
                    head.extend(format!(" -1{number:>10}").bytes());
                    mesh.points[point]
                        .iter()
                        .for_each(|&x| columns::push_value(head, x));
                    head.push(b'\n');
                }
                Encoding::Binary => {
                    self.head.extend((number as i32).to_le_bytes());
                    let x = mesh.points[point].iter();
                    self.head.extend(x.flat_map(|x| x.to_le_bytes()));
                }
            }
        }
        self.end_block();
    }

    fn add_elements(&mut self, mesh: &Mesh, numbers: &[u64], owners: &[usize]) {
        let flag = match self.encoding {
            Encoding::Text => 1,
            Encoding::Binary => 2,
        };
        let count = numbers.len();
        self.line(&format!("    3C{:18}{count:>12}{:37}{flag}", "", ""));
        let mut cells = numbers.iter().zip(owners);
        for block in &mesh.blocks {
            let kind = kinds::number(block.kind);
            let order = kinds::order(block.kind);
            let all = block.connectivity.chunks_exact(block.kind.node_count());
            for (nodes, (&number, &owner)) in all.zip(cells.by_ref()) {
                let node = |i: usize| self.numbers[nodes[order.get(i).copied().unwrap_or(i)]];
                let nodes: Vec<u64> = (0..nodes.len()).map(node).collect();
                self.add_element(number, kind, owner + 1, &nodes);
            }
        }
        self.end_block();
    }

    fn add_element(&mut self, number: u64, kind: usize, body: usize, nodes: &[u64]) {
        if self.encoding == Encoding::Binary {
            let first = [number as i32, kind as i32, 0, body as i32];
            let all = first
                .into_iter()
                .chain(nodes.iter().map(|&node| node as i32));
            self.head.extend(all.flat_map(i32::to_le_bytes));
            return;
        }
        let body = columns::whole(body, 5);
        self.line(&format!(" -1{number:>10}{kind:>5}{:>5}{body}", 0));
        for nodes in nodes.chunks(NODES_A_LINE) {
            let nodes: String = nodes.iter().map(|node| format!("{node:>10}")).collect();
            self.line(&format!(" -2{nodes}"));
        }
    }

    /// Bytes have a length that is known, text has a last line.
    fn end_block(&mut self) {
        if self.encoding == Encoding::Text {
            self.line(" -3");
        }
    }
}

/// A text without characters that take more than one column.
fn plain(text: &str, width: usize) -> String {
    let columns = text.chars().map(|c| match c {
        ' '..='~' => c,
        _ => '_',
    });
    columns.take(width).collect()
}

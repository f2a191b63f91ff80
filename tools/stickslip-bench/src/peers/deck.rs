//! The press-and-slide problem as a CalculiX deck.
//!
//! Two stacked unit cubes of steel, `n³` cells below and `(n - 1)³` above. The top face is pressed down by 1 mm in five
//! increments and moved sideways in ten. Node-to-face contact with a normal and a tangential stiffness of
//! 1e13 Pa/m and a coefficient of friction of 0.3; the upper cube is the secondary.

use std::fmt::Write;

/// A cube of `n³` hexahedra of edge 1 `[m]` that stands on the plane `z = base`; labels continue after those of another.
struct Cube {
    n: usize,
    base: usize,
    nodes_before: usize,
    cells_before: usize,
}

impl Cube {
    fn node(&self, x: usize, y: usize, z: usize) -> usize {
        let edge = self.n + 1;
        self.nodes_before + x + edge * (y + edge * z) + 1
    }

    /// Labels of the nodes of a layer.
    fn layer(&self, z: usize) -> impl Iterator<Item = usize> {
        self.node(0, 0, z)..self.node(0, 0, z + 1)
    }

    /// Labels of the cells of a layer.
    fn cells(&self, z: usize) -> impl Iterator<Item = usize> {
        let layer = self.n * self.n;
        let first = self.cells_before + layer * z + 1;
        first..first + layer
    }

    fn write_nodes(&self, deck: &mut String) {
        let at = |i: usize| i as f64 / self.n as f64;
        for z in 0..=self.n {
            for y in 0..=self.n {
                for x in 0..=self.n {
                    let height = self.base as f64 + at(z);
                    line(
                        deck,
                        format_args!("{}, {}, {}, {height}", self.node(x, y, z), at(x), at(y)),
                    );
                }
            }
        }
    }

    fn write_cells(&self, deck: &mut String, set: &str) {
        line(deck, format_args!("*ELEMENT, TYPE=C3D8, ELSET={set}"));
        let mut label = self.cells_before;
        for z in 0..self.n {
            for y in 0..self.n {
                for x in 0..self.n {
                    label += 1;
                    let _ = write!(deck, "{label}");
                    for up in [z, z + 1] {
                        for (x, y) in [(x, y), (x + 1, y), (x + 1, y + 1), (x, y + 1)] {
                            let _ = write!(deck, ", {}", self.node(x, y, up));
                        }
                    }
                    deck.push('\n');
                }
            }
        }
    }
}

/// Writing to a string cannot fail.
fn line(deck: &mut String, text: std::fmt::Arguments) {
    let _ = writeln!(deck, "{text}");
}

fn write_set(deck: &mut String, name: &str, nodes: impl Iterator<Item = usize>) {
    line(deck, format_args!("*NSET, NSET={name}"));
    for node in nodes {
        line(deck, format_args!("{node},"));
    }
}

/// The deck for `n` cells an edge of the lower cube, at least 2, with the top face moved sideways by `slide` `[m]`.
pub fn press_and_slide(n: usize, slide: f64) -> String {
    let lower = Cube {
        n,
        base: 0,
        nodes_before: 0,
        cells_before: 0,
    };
    let upper = Cube {
        n: n - 1,
        base: 1,
        nodes_before: (n + 1).pow(3),
        cells_before: n.pow(3),
    };
    let mut deck = String::from("*NODE, NSET=ALL\n");
    lower.write_nodes(&mut deck);
    upper.write_nodes(&mut deck);
    lower.write_cells(&mut deck, "LOWER");
    upper.write_cells(&mut deck, "UPPER");
    write_set(&mut deck, "BOTTOM", lower.layer(0));
    write_set(&mut deck, "TOP", upper.layer(upper.n));
    write_set(&mut deck, "SECONDARY", upper.layer(0));
    deck.push_str("*SURFACE, NAME=POINTS, TYPE=NODE\nSECONDARY\n");
    // Face 2 of a C3D8 holds its last four nodes: the upper face here.
    deck.push_str("*SURFACE, NAME=FACES, TYPE=ELEMENT\n");
    for cell in lower.cells(n - 1) {
        line(&mut deck, format_args!("{cell}, S2"));
    }
    deck.push_str(
        "*MATERIAL, NAME=STEEL
*ELASTIC
210e9, 0.3
*SOLID SECTION, ELSET=LOWER, MATERIAL=STEEL
*SOLID SECTION, ELSET=UPPER, MATERIAL=STEEL
*SURFACE INTERACTION, NAME=RUBBING
*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR
1e13, 0.
*FRICTION
0.3, 1e13
*CONTACT PAIR, INTERACTION=RUBBING, TYPE=NODE TO SURFACE
POINTS, FACES
*BOUNDARY
BOTTOM, 1, 3
",
    );
    for (increment, sideways) in [("0.2", 0.0), ("0.1", slide)] {
        line(
            &mut deck,
            format_args!(
                "*STEP, INC=1000
*STATIC, DIRECT, SOLVER=ITERATIVE CHOLESKY
{increment}, 1.
*BOUNDARY
TOP, 1, 1, {sideways:e}
TOP, 2, 2, 0.
TOP, 3, 3, -1e-3
*NODE PRINT, NSET=TOP, TOTALS=ONLY
RF
*END STEP"
            ),
        );
    }
    deck
}

#[cfg(test)]
mod tests {
    use super::press_and_slide;

    #[test]
    fn labels_are_complete_and_sets_lie_where_they_should() {
        let deck = press_and_slide(3, 5e-4);
        let numbers =
            |l: &str| -> Vec<f64> { l.split(',').flat_map(|x| x.trim().parse()).collect() };
        let section = |start: &str| -> Vec<Vec<f64>> {
            let lines = deck.lines().skip_while(|l| *l != start).skip(1);
            lines
                .take_while(|l| !l.starts_with('*'))
                .map(numbers)
                .collect()
        };
        let nodes = section("*NODE, NSET=ALL");
        assert_eq!(nodes.len(), 64 + 27);
        assert!(
            nodes
                .iter()
                .enumerate()
                .all(|(i, n)| n[0] == (i + 1) as f64)
        );
        let height = |label: f64| nodes[label as usize - 1][3];
        for (set, z, count) in [("BOTTOM", 0.0, 16), ("TOP", 2.0, 9), ("SECONDARY", 1.0, 9)] {
            let labels = section(&format!("*NSET, NSET={set}"));
            assert_eq!(labels.len(), count);
            assert!(labels.iter().all(|l| height(l[0]) == z));
        }
        let mut next = 1.0;
        for (set, count) in [("LOWER", 27), ("UPPER", 8)] {
            let cells = section(&format!("*ELEMENT, TYPE=C3D8, ELSET={set}"));
            assert_eq!(cells.len(), count);
            for cell in cells {
                assert_eq!(cell[0], next);
                next += 1.0;
                assert!((1..5).all(|k| height(cell[k]) < height(cell[k + 4])));
            }
        }
        assert!(deck.contains("TOP, 1, 1, 5e-4\n"));
        let faces = section("*SURFACE, NAME=FACES, TYPE=ELEMENT");
        let faces: Vec<f64> = faces.iter().map(|l| l[0]).collect();
        assert_eq!(faces, (19..28).map(f64::from).collect::<Vec<_>>());
    }
}

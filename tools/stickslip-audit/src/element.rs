//! Reference elements: nodes, shape functions, faces and rules.
//!
//! Nodes are numbered as in VTK. Shape functions are those of Zienkiewicz, Taylor and Zhu 2005, *The Finite Element Method: Its Basis and
//! Fundamentals*, sections 4.6 (serendipity), 4.7 and 4.8 (triangles, tetrahedra) and 4.10 (wedges). Their derivatives are taken by the
//! difference formula with five points, which is exact for the polynomials of degree four that they are at most.

/// A reference element.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// Line of two or three nodes.
    Line(usize),
    /// Triangle of three or six nodes.
    Triangle(usize),
    /// Quadrilateral of four or eight nodes.
    Quad(usize),
    /// Tetrahedron of four or ten nodes.
    Tetrahedron(usize),
    /// Wedge of six or fifteen nodes.
    Wedge(usize),
    /// Hexahedron of eight or twenty nodes.
    Hexahedron(usize),
}

/// A point of a rule and its weight.
pub type Rule = Vec<([f64; 3], f64)>;

const HEX: [[f64; 3]; 20] = [
    [-1., -1., -1.],
    [1., -1., -1.],
    [1., 1., -1.],
    [-1., 1., -1.],
    [-1., -1., 1.],
    [1., -1., 1.],
    [1., 1., 1.],
    [-1., 1., 1.],
    [0., -1., -1.],
    [1., 0., -1.],
    [0., 1., -1.],
    [-1., 0., -1.],
    [0., -1., 1.],
    [1., 0., 1.],
    [0., 1., 1.],
    [-1., 0., 1.],
    [-1., -1., 0.],
    [1., -1., 0.],
    [1., 1., 0.],
    [-1., 1., 0.],
];
const QUAD: [[f64; 3]; 8] = [
    [-1., -1., 0.],
    [1., -1., 0.],
    [1., 1., 0.],
    [-1., 1., 0.],
    [0., -1., 0.],
    [1., 0., 0.],
    [0., 1., 0.],
    [-1., 0., 0.],
];
/// Pairs of corners between which the nodes in the middle lie.
const TRIANGLE_EDGES: [[usize; 2]; 3] = [[0, 1], [1, 2], [2, 0]];
const TETRAHEDRON_EDGES: [[usize; 2]; 6] = [[0, 1], [1, 2], [2, 0], [0, 3], [1, 3], [2, 3]];

impl Kind {
    /// By VTK's number.
    pub fn of_vtk(number: u8) -> Option<Kind> {
        Some(match number {
            5 => Kind::Triangle(3),
            22 => Kind::Triangle(6),
            9 => Kind::Quad(4),
            23 => Kind::Quad(8),
            10 => Kind::Tetrahedron(4),
            24 => Kind::Tetrahedron(10),
            13 => Kind::Wedge(6),
            26 => Kind::Wedge(15),
            12 => Kind::Hexahedron(8),
            25 => Kind::Hexahedron(20),
            _ => return None,
        })
    }

    /// Number of nodes.
    pub fn nodes(self) -> usize {
        match self {
            Kind::Line(n) | Kind::Triangle(n) | Kind::Quad(n) => n,
            Kind::Tetrahedron(n) | Kind::Wedge(n) | Kind::Hexahedron(n) => n,
        }
    }

    /// Number of reference coordinates.
    pub fn dim(self) -> usize {
        match self {
            Kind::Line(_) => 1,
            Kind::Triangle(_) | Kind::Quad(_) => 2,
            _ => 3,
        }
    }

    /// Number of corners; the nodes behind them are in the middle of edges.
    pub fn corners(self) -> usize {
        match self {
            Kind::Line(_) => 2,
            Kind::Triangle(_) => 3,
            Kind::Quad(_) | Kind::Tetrahedron(_) => 4,
            Kind::Wedge(_) => 6,
            Kind::Hexahedron(_) => 8,
        }
    }

    /// Whether there are nodes in the middle of edges.
    pub fn quadratic(self) -> bool {
        self.nodes() > self.corners()
    }

    /// Values of the shape functions.
    pub fn values(self, x: [f64; 3]) -> Vec<f64> {
        match self {
            Kind::Line(2) => vec![0.5 * (1.0 - x[0]), 0.5 * (1.0 + x[0])],
            Kind::Line(_) => {
                let s = x[0];
                vec![0.5 * s * (s - 1.0), 0.5 * s * (s + 1.0), 1.0 - s * s]
            }
            Kind::Triangle(n) => simplex(&[1.0 - x[0] - x[1], x[0], x[1]], &TRIANGLE_EDGES, n > 3),
            Kind::Tetrahedron(n) => {
                let l = [1.0 - x[0] - x[1] - x[2], x[0], x[1], x[2]];
                simplex(&l, &TETRAHEDRON_EDGES, n > 4)
            }
            Kind::Quad(n) => (0..n).map(|a| serendipity(x, QUAD[a], 2, n > 4)).collect(),
            Kind::Hexahedron(n) => (0..n).map(|a| serendipity(x, HEX[a], 3, n > 8)).collect(),
            Kind::Wedge(n) => wedge(x, n > 6),
        }
    }

    /// Derivatives `[node][direction]`.
    pub fn gradients(self, x: [f64; 3]) -> Vec<[f64; 3]> {
        const H: f64 = 0.25;
        let mut d = vec![[0.0; 3]; self.nodes()];
        for k in 0..self.dim() {
            let at = |s: f64| {
                let mut y = x;
                y[k] += s * H;
                self.values(y)
            };
            let v = [at(-2.0), at(-1.0), at(1.0), at(2.0)];
            for (a, d) in d.iter_mut().enumerate() {
                d[k] = (v[0][a] - 8.0 * v[1][a] + 8.0 * v[2][a] - v[3][a]) / (12.0 * H);
            }
        }
        d
    }

    /// The rule of the stiffness: Gauss with two points a direction for linear cells and three for quadratic ones; on triangles one
    /// and three points, on tetrahedra one and four (Zienkiewicz, Taylor and Zhu 2005, tables 5.2 and 5.3).
    pub fn rule(self) -> Rule {
        let a = (5.0 - 5f64.sqrt()) / 20.0;
        let b = (5.0 + 3.0 * 5f64.sqrt()) / 20.0;
        match self {
            Kind::Line(n) => product(gauss(n), 1),
            Kind::Quad(n) => product(gauss(if n > 4 { 3 } else { 2 }), 2),
            Kind::Hexahedron(n) => product(gauss(if n > 8 { 3 } else { 2 }), 3),
            Kind::Triangle(3) => vec![([1.0 / 3.0, 1.0 / 3.0, 0.0], 0.5)],
            Kind::Triangle(_) => triangle(),
            Kind::Tetrahedron(4) => vec![([0.25; 3], 1.0 / 6.0)],
            Kind::Tetrahedron(_) => [[a, a, a], [b, a, a], [a, b, a], [a, a, b]]
                .map(|x| (x, 1.0 / 24.0))
                .to_vec(),
            Kind::Wedge(n) => {
                let line = gauss(if n > 6 { 3 } else { 2 });
                let layer = |(z, w): (f64, f64)| {
                    triangle()
                        .into_iter()
                        .map(move |(x, v)| ([x[0], x[1], z], v * w))
                };
                line.into_iter().flat_map(layer).collect()
            }
        }
    }

    /// A rule of one point fewer a direction, for reduced integration.
    pub fn reduced_rule(self) -> Rule {
        match self {
            Kind::Quad(8) => product(gauss(2), 2),
            Kind::Hexahedron(20) => product(gauss(2), 3),
            _ => self.rule(),
        }
    }

    /// A rule for masses: it integrates products of two shape functions on straight cells exactly with as few points as codes take. On curved cells no rule
    /// is exact, and what another one makes of them is no error of the motion.
    pub fn mass_rule(self) -> Rule {
        match self {
            Kind::Line(_) | Kind::Quad(_) | Kind::Hexahedron(_) => product(gauss(3), self.dim()),
            _ => self.fine_rule(),
        }
    }

    /// A rule that integrates products of two shape functions on straight cells exactly, with some to spare: four Gauss points a direction, on simplices
    /// collapsed onto a corner (Stroud 1971, section 2.5).
    pub fn fine_rule(self) -> Rule {
        let unit: Vec<(f64, f64)> = gauss(4)
            .into_iter()
            .map(|(x, w)| (0.5 * (1.0 + x), 0.5 * w))
            .collect();
        let mut rule = Vec::new();
        match self {
            Kind::Line(_) | Kind::Quad(_) | Kind::Hexahedron(_) => {
                return product(gauss(4), self.dim());
            }
            Kind::Triangle(_) | Kind::Wedge(_) => {
                let line = match self {
                    Kind::Wedge(_) => gauss(3),
                    _ => vec![(0.0, 1.0)],
                };
                for &(z, wz) in &line {
                    for &(a, wa) in &unit {
                        for &(b, wb) in &unit {
                            rule.push(([a, b * (1.0 - a), z], wa * wb * wz * (1.0 - a)));
                        }
                    }
                }
            }
            Kind::Tetrahedron(_) => {
                for &(a, wa) in &unit {
                    for &(b, wb) in &unit {
                        for &(c, wc) in &unit {
                            let x = [a, b * (1.0 - a), c * (1.0 - a) * (1.0 - b)];
                            let w = (1.0 - a).powi(2) * (1.0 - b);
                            rule.push((x, wa * wb * wc * w));
                        }
                    }
                }
            }
        }
        rule
    }

    /// The sides of a cell: their kinds and nodes.
    pub fn sides(self) -> Vec<(Kind, Vec<usize>)> {
        let quadratic = self.quadratic();
        let corners: Vec<Vec<usize>> = match self {
            Kind::Line(_) => Vec::new(),
            Kind::Triangle(_) => vec![vec![0, 1], vec![1, 2], vec![2, 0]],
            Kind::Quad(_) => vec![vec![0, 1], vec![1, 2], vec![2, 3], vec![3, 0]],
            Kind::Tetrahedron(_) => {
                vec![vec![0, 2, 1], vec![0, 1, 3], vec![1, 2, 3], vec![2, 0, 3]]
            }
            Kind::Wedge(_) => vec![
                vec![0, 2, 1],
                vec![3, 4, 5],
                vec![0, 1, 4, 3],
                vec![1, 2, 5, 4],
                vec![2, 0, 3, 5],
            ],
            Kind::Hexahedron(_) => vec![
                vec![0, 3, 2, 1],
                vec![4, 5, 6, 7],
                vec![0, 1, 5, 4],
                vec![1, 2, 6, 5],
                vec![2, 3, 7, 6],
                vec![3, 0, 4, 7],
            ],
        };
        let edges = self.edges();
        let side = |nodes: Vec<usize>| {
            let mut all = nodes.clone();
            let n = nodes.len();
            if quadratic {
                let pairs = (0..if n == 2 { 1 } else { n }).map(|i| [nodes[i], nodes[(i + 1) % n]]);
                for pair in pairs {
                    let sorted = |p: [usize; 2]| [p[0].min(p[1]), p[0].max(p[1])];
                    let edge = edges.iter().position(|e| sorted(*e) == sorted(pair));
                    all.extend(edge.map(|e| self.corners() + e));
                }
            }
            let kind = match n {
                2 => Kind::Line(all.len()),
                3 => Kind::Triangle(all.len()),
                _ => Kind::Quad(all.len()),
            };
            (kind, all)
        };
        corners.into_iter().map(side).collect()
    }

    /// The corners at the ends of each edge, in the order of the nodes in their middles.
    fn edges(self) -> Vec<[usize; 2]> {
        match self {
            Kind::Line(_) => vec![[0, 1]],
            Kind::Triangle(_) => TRIANGLE_EDGES.to_vec(),
            Kind::Quad(_) => vec![[0, 1], [1, 2], [2, 3], [3, 0]],
            Kind::Tetrahedron(_) => TETRAHEDRON_EDGES.to_vec(),
            Kind::Wedge(_) => {
                let mut edges = TRIANGLE_EDGES.to_vec();
                edges.extend(TRIANGLE_EDGES.map(|e| e.map(|i| i + 3)));
                edges.extend([[0, 3], [1, 4], [2, 5]]);
                edges
            }
            Kind::Hexahedron(_) => {
                let ring = [[0, 1], [1, 2], [2, 3], [3, 0]];
                let mut edges = ring.to_vec();
                edges.extend(ring.map(|e| e.map(|i| i + 4)));
                edges.extend([[0, 4], [1, 5], [2, 6], [3, 7]]);
                edges
            }
        }
    }

    /// Reference coordinates of the middle.
    pub fn middle(self) -> [f64; 3] {
        match self {
            Kind::Triangle(_) | Kind::Wedge(_) => [1.0 / 3.0, 1.0 / 3.0, 0.0],
            Kind::Tetrahedron(_) => [0.25; 3],
            _ => [0.0; 3],
        }
    }
}

/// Points and weights of Gauss on [-1, 1].
fn gauss(n: usize) -> Vec<(f64, f64)> {
    let (third, fifth) = ((1.0f64 / 3.0).sqrt(), 0.6f64.sqrt());
    match n {
        2 => vec![(-third, 1.0), (third, 1.0)],
        3 => vec![(-fifth, 5.0 / 9.0), (0.0, 8.0 / 9.0), (fifth, 5.0 / 9.0)],
        _ => {
            let root = |s: f64| (3.0 / 7.0 + s * 2.0 / 7.0 * 1.2f64.sqrt()).sqrt();
            let weight = |s: f64| (18.0 - s * 30f64.sqrt()) / 36.0;
            [(-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0), (1.0, 1.0)]
                .map(|(sign, s)| (sign * root(s), weight(s)))
                .to_vec()
        }
    }
}

fn product(line: Vec<(f64, f64)>, dim: usize) -> Rule {
    let mut rule: Rule = vec![([0.0; 3], 1.0)];
    for k in 0..dim {
        let longer = rule.iter().flat_map(|&(x, w)| {
            line.iter().map(move |&(s, v)| {
                let mut x = x;
                x[k] = s;
                (x, w * v)
            })
        });
        rule = longer.collect();
    }
    rule
}

fn triangle() -> Rule {
    let (a, b) = (1.0 / 6.0, 2.0 / 3.0);
    [[a, a, 0.0], [b, a, 0.0], [a, b, 0.0]]
        .map(|x| (x, 1.0 / 6.0))
        .to_vec()
}

fn simplex(l: &[f64], edges: &[[usize; 2]], quadratic: bool) -> Vec<f64> {
    if !quadratic {
        return l.to_vec();
    }
    let mut n: Vec<f64> = l.iter().map(|l| l * (2.0 * l - 1.0)).collect();
    n.extend(edges.iter().map(|&[i, j]| 4.0 * l[i] * l[j]));
    n
}

/// The function of a node of a quadrilateral or hexahedron.
fn serendipity(x: [f64; 3], node: [f64; 3], dim: usize, quadratic: bool) -> f64 {
    let linear = |k: usize| 0.5 * (1.0 + node[k] * x[k]);
    match node[..dim].iter().position(|c| *c == 0.0) {
        Some(m) => {
            let others: f64 = (0..dim).filter(|k| *k != m).map(linear).product();
            (1.0 - x[m] * x[m]) * others
        }
        None => {
            let corner: f64 = (0..dim).map(linear).product();
            let sum: f64 = (0..dim).map(|k| node[k] * x[k]).sum();
            match quadratic {
                true => corner * (sum - (dim as f64 - 1.0)),
                false => corner,
            }
        }
    }
}

fn wedge(x: [f64; 3], quadratic: bool) -> Vec<f64> {
    let l = [1.0 - x[0] - x[1], x[0], x[1]];
    let ends = [-1.0, 1.0].map(|end| 0.5 * (1.0 + end * x[2]));
    let corner = |z: usize| {
        l.map(|l| match quadratic {
            true => l * (2.0 * l - 1.0) * ends[z] - 0.5 * l * (1.0 - x[2] * x[2]),
            false => l * ends[z],
        })
    };
    let mut n = [corner(0), corner(1)].concat();
    if quadratic {
        for end in ends {
            n.extend(TRIANGLE_EDGES.map(|[i, j]| 4.0 * l[i] * l[j] * end));
        }
        n.extend(l.map(|l| l * (1.0 - x[2] * x[2])));
    }
    n
}

#[cfg(test)]
mod tests {
    use super::Kind;

    const ALL: [u8; 10] = [5, 22, 9, 23, 10, 24, 13, 26, 12, 25];

    #[test]
    fn shape_functions_add_up_to_one_and_their_derivatives_to_zero() {
        for kind in ALL.map(|n| Kind::of_vtk(n).expect("a kind")) {
            let x = [0.21, 0.13, 0.37];
            let sum: f64 = kind.values(x).iter().sum();
            assert!((sum - 1.0).abs() < 1e-14, "{kind:?}");
            for k in 0..kind.dim() {
                let slope: f64 = kind.gradients(x).iter().map(|d| d[k]).sum();
                assert!(slope.abs() < 1e-12, "{kind:?}");
            }
        }
    }

    #[test]
    fn rules_measure_the_element_and_sides_have_as_many_nodes_as_their_kind() {
        for kind in ALL.map(|n| Kind::of_vtk(n).expect("a kind")) {
            let size = |rule: super::Rule| rule.iter().map(|(_, w)| w).sum::<f64>();
            assert!(
                (size(kind.rule()) - size(kind.fine_rule())).abs() < 1e-12,
                "{kind:?}"
            );
            for (side, nodes) in kind.sides() {
                assert_eq!(side.nodes(), nodes.len(), "{kind:?}");
            }
        }
    }
}

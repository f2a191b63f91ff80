use super::*;
use crate::math::{Vec3, add_scaled, cross, dot, sub};

/// A point inside the reference element, off every symmetry.
fn inside(kind: ElementKind) -> [f64; 3] {
    let point = [0.23, 0.31, 0.17];
    std::array::from_fn(|i| if i < kind.dim() { point[i] } else { 0.0 })
}

fn values(kind: ElementKind, xi: [f64; 3]) -> Vec<f64> {
    let mut n = vec![f64::NAN; kind.node_count()];
    kind.reference().values(xi, &mut n);
    n
}

fn gradients(kind: ElementKind, xi: [f64; 3]) -> Vec<[f64; 3]> {
    let mut d = vec![[f64::NAN; 3]; kind.node_count()];
    kind.reference().gradients(xi, &mut d);
    d
}

fn seconds(kind: ElementKind, xi: [f64; 3]) -> Vec<[f64; 3]> {
    let mut d = vec![[f64::NAN; 3]; kind.node_count()];
    kind.reference().second_derivatives(xi, &mut d);
    d
}

fn shifted(mut xi: [f64; 3], direction: usize, by: f64) -> [f64; 3] {
    xi[direction] += by;
    xi
}

const STEP: f64 = 1e-5;

#[test]
fn sizes_agree_with_the_tables() {
    for kind in ElementKind::ALL {
        let reference = kind.reference();
        assert_eq!(reference.nodes().len(), kind.node_count(), "{kind}");
        assert!(kind.node_count() <= MAX_NODES);
        assert_eq!(kind.order() == 1, kind.node_count() == kind.corner_count());
        let json = format!("\"{}\"", kind.name());
        assert_eq!(serde_json::from_str::<ElementKind>(&json).ok(), Some(kind));
    }
}

#[test]
fn each_shape_function_is_one_at_its_node_only() {
    for kind in ElementKind::ALL {
        for (i, &node) in kind.reference().nodes().iter().enumerate() {
            for (j, n) in values(kind, node).into_iter().enumerate() {
                let expected = if i == j { 1.0 } else { 0.0 };
                assert!((n - expected).abs() < 1e-14, "{kind} {i} {j}");
            }
        }
    }
}

#[test]
fn they_reproduce_constants_and_coordinates() {
    for kind in ElementKind::ALL {
        let xi = inside(kind);
        let n = values(kind, xi);
        assert!((n.iter().sum::<f64>() - 1.0).abs() < 1e-14, "{kind}");
        let mut x = [0.0; 3];
        for (n, &node) in n.iter().zip(kind.reference().nodes()) {
            x = add_scaled(x, *n, node);
        }
        assert!(dot(sub(x, xi), sub(x, xi)) < 1e-28, "{kind}");
    }
}

#[test]
fn gradients_match_differences() {
    for kind in ElementKind::ALL {
        let xi = inside(kind);
        let d = gradients(kind, xi);
        for direction in 0..3 {
            if direction >= kind.dim() {
                assert!(d.iter().all(|d| d[direction] == 0.0), "{kind}");
                continue;
            }
            let above = values(kind, shifted(xi, direction, STEP));
            let below = values(kind, shifted(xi, direction, -STEP));
            for i in 0..kind.node_count() {
                let difference = (above[i] - below[i]) / (2.0 * STEP);
                assert!((d[i][direction] - difference).abs() < 1e-9, "{kind} {i}");
            }
        }
    }
}

#[test]
fn second_and_third_derivatives_match_differences() {
    for kind in ElementKind::ALL.into_iter().filter(|kind| kind.dim() < 3) {
        let xi = inside(kind);
        let second = seconds(kind, xi);
        let mut third = vec![[f64::NAN; 4]; kind.node_count()];
        kind.reference().third_derivatives(xi, &mut third);
        for direction in 0..kind.dim() {
            let (up, down) = (shifted(xi, direction, STEP), shifted(xi, direction, -STEP));
            let (g_up, g_down) = (gradients(kind, up), gradients(kind, down));
            let (s_up, s_down) = (seconds(kind, up), seconds(kind, down));
            for i in 0..kind.node_count() {
                let close = |exact: f64, above: f64, below: f64| {
                    let difference = (above - below) / (2.0 * STEP);
                    assert!((exact - difference).abs() < 1e-9, "{kind} {i}");
                };
                close(
                    second[i][direction],
                    g_up[i][direction],
                    g_down[i][direction],
                );
                close(
                    second[i][2],
                    g_up[i][1 - direction],
                    g_down[i][1 - direction],
                );
                // [ξξξ, ξξη, ξηη, ηηη] from [ξξ, ηη, ξη] and one more derivative.
                let columns = if direction == 0 { [0, 2, 1] } else { [1, 3, 2] };
                for (entry, column) in columns.into_iter().enumerate() {
                    close(third[i][column], s_up[i][entry], s_down[i][entry]);
                }
            }
        }
    }
}

/// `∫ x^a y^b z^c` over the reference element.
fn monomial(kind: ElementKind, powers: [u32; 3]) -> f64 {
    if kind.linear() == ElementKind::Wedge6 {
        let triangle = monomial(ElementKind::Tri3, [powers[0], powers[1], 0]);
        return triangle * monomial(ElementKind::Line2, [powers[2], 0, 0]);
    }
    if kind.is_simplex() {
        let factorial = |n: u32| (1..=n).map(f64::from).product::<f64>();
        let total = powers.iter().sum::<u32>() + kind.dim() as u32;
        return powers.iter().map(|&p| factorial(p)).product::<f64>() / factorial(total);
    }
    (0..kind.dim())
        .map(|i| {
            if powers[i] % 2 == 1 {
                0.0
            } else {
                2.0 / f64::from(powers[i] + 1)
            }
        })
        .product()
}

/// How far a rule is from the integrals of all monomials of at most these degrees: in total in the directions of a simplex, in each
/// direction elsewhere.
fn error_of(rule: &[QuadraturePoint], kind: ElementKind, degree: u32, along: u32) -> f64 {
    let wedge = kind.linear() == ElementKind::Wedge6;
    let highest = |direction: usize| match direction {
        d if d >= kind.dim() => 0,
        2 if wedge => along,
        _ => degree,
    };
    let mut worst: f64 = 0.0;
    for a in 0..=highest(0) {
        for b in 0..=highest(1) {
            for c in 0..=highest(2) {
                let total = if wedge { a + b } else { a + b + c };
                if (kind.is_simplex() || wedge) && total > degree {
                    continue;
                }
                let sum: f64 = rule
                    .iter()
                    .map(|q| {
                        let power = |i: usize, p: u32| q.xi[i].powi(p as i32);
                        q.weight * power(0, a) * power(1, b) * power(2, c)
                    })
                    .sum();
                worst = worst.max((sum - monomial(kind, [a, b, c])).abs());
            }
        }
    }
    worst
}

#[test]
fn quadrature_integrates_polynomials() {
    for kind in ElementKind::ALL {
        let (degree, along) = match (kind.linear(), kind.order()) {
            (ElementKind::Wedge6, 1) => (2, 3),
            (ElementKind::Wedge6, _) => (2, 5),
            (_, order) if kind.is_simplex() => (order as u32, 0),
            (_, 1) => (3, 0),
            _ => (5, 0),
        };
        let error = error_of(kind.reference().quadrature(), kind, degree, along);
        assert!(error < 1e-14, "{kind} {error}");
    }
}

#[test]
fn reduced_rules_integrate_what_their_points_allow() {
    use ElementKind::*;
    for (kind, points, degree, along) in [
        (Quad4, 1, 1, 0),
        (Quad8, 4, 3, 0),
        (Hex8, 1, 1, 0),
        (Hex20, 8, 3, 0),
        (Wedge6, 2, 1, 3),
        (Tet10, 4, 2, 0),
    ] {
        let rule = kind.reference().reduced_quadrature();
        assert_eq!(rule.len(), points, "{kind}");
        assert!(error_of(rule, kind, degree, along) < 1e-14, "{kind}");
    }
}

#[test]
fn mass_rules_integrate_products_of_shape_functions() {
    for kind in ElementKind::ALL {
        // The highest power in one direction of a shape function, in total on a simplex.
        let order = kind.order() as u32;
        let error = error_of(&mass_rule(kind), kind, 2 * order, 2 * order);
        assert!(error < 1e-14, "{kind} {error}");
    }
}

#[test]
fn faces_point_outwards_and_close_the_element() {
    for kind in ElementKind::ALL.into_iter().filter(|kind| kind.dim() > 1) {
        let nodes = kind.reference().nodes();
        let mut flux = 0.0;
        let mut closure = [0.0; 3];
        for face in kind.reference().faces() {
            assert_eq!(face.kind.dim() + 1, kind.dim());
            assert_eq!(face.kind.order(), kind.order());
            let points: Vec<Vec3> = face.nodes.iter().map(|&i| nodes[i]).collect();
            for q in face.kind.reference().quadrature() {
                let n = values(face.kind, q.xi);
                let d = gradients(face.kind, q.xi);
                let (mut x, mut t1, mut t2) = ([0.0; 3], [0.0; 3], [0.0; 3]);
                for (i, &p) in points.iter().enumerate() {
                    x = add_scaled(x, n[i], p);
                    t1 = add_scaled(t1, d[i][0], p);
                    t2 = add_scaled(t2, d[i][1], p);
                }
                let normal = if kind.dim() == 2 {
                    [t1[1], -t1[0], 0.0]
                } else {
                    cross(t1, t2)
                };
                assert!(dot(normal, sub(x, kind.centre())) > 0.0, "{kind}");
                flux += q.weight * dot(normal, x);
                closure = add_scaled(closure, q.weight, normal);
            }
        }
        // The divergence theorem with the field x: its flux is the dimension times the measure.
        let measure = monomial(kind, [0; 3]);
        assert!((flux - kind.dim() as f64 * measure).abs() < 1e-13, "{kind}");
        assert!(dot(closure, closure) < 1e-26, "{kind}");
    }
}

#[test]
fn mid_side_nodes_of_faces_lie_between_their_corners() {
    for kind in ElementKind::ALL.into_iter().filter(|kind| kind.dim() > 1) {
        let nodes = kind.reference().nodes();
        for face in kind.reference().faces() {
            let own = face.kind.reference().nodes();
            let corners = face.kind.corner_count();
            for (local, &node) in face.nodes.iter().enumerate().skip(corners) {
                // The linear face maps the reference position of its node onto the node of the element.
                let n = values(face.kind.linear(), own[local]);
                let mut x = [0.0; 3];
                for (n, &corner) in n.iter().zip(face.nodes) {
                    x = add_scaled(x, *n, nodes[corner]);
                }
                assert!(
                    dot(sub(x, nodes[node]), sub(x, nodes[node])) < 1e-28,
                    "{kind}"
                );
            }
        }
    }
}

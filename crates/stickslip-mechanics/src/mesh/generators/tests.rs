use std::f64::consts::PI;

use super::*;
use crate::error::MeshError;
use crate::math::{cross, distance, dot, scale, sub};
use crate::mesh::{FacetRef, Mesh, check, geometry};
use crate::registry::{Family, Samples};
use crate::shape::ElementKind;

fn message(generated: Result<Mesh, MeshError>) -> String {
    let error = generated.unwrap_err();
    assert!(error.help.is_some(), "{error}");
    error.message
}

/// The names of the facet sets that make up the boundary, each facet once.
fn assert_sets_cover_the_boundary(mesh: &Mesh, kind: &str) {
    let mut named: Vec<FacetRef> = mesh.facet_sets.values().flatten().copied().collect();
    named.sort_unstable();
    assert_eq!(named, mesh.boundary(), "{kind}");
    assert!(
        mesh.facet_sets.values().all(|set| !set.is_empty()),
        "{kind}"
    );
    assert!(mesh.point_sets.values().all(|set| set.len() == 1), "{kind}");
}

/// The measure from the boundary alone, by the divergence theorem: it equals the one from the cells if the boundary
/// is closed and all facets point outwards.
fn measure_by_boundary(mesh: &Mesh) -> f64 {
    let origin = mesh.points[0];
    let mut flux = 0.0;
    for facet in mesh.boundary() {
        let (kind, points) = mesh.facet_points(facet);
        let reference = kind.reference();
        let mut n = vec![0.0; points.len()];
        let mut d = vec![[0.0; 3]; points.len()];
        for q in reference.quadrature() {
            reference.values(q.xi, &mut n);
            reference.gradients(q.xi, &mut d);
            let sum = |w: &dyn Fn(usize) -> f64| {
                points.iter().enumerate().fold([0.0; 3], |s, (i, &p)| {
                    crate::math::add_scaled(s, w(i), sub(mesh.points[p], origin))
                })
            };
            let (x, t1, t2) = (sum(&|i| n[i]), sum(&|i| d[i][0]), sum(&|i| d[i][1]));
            let normal = if mesh.dim == 2 {
                [t1[1], -t1[0], 0.0]
            } else {
                cross(t1, t2)
            };
            flux += q.weight * dot(normal, x);
        }
    }
    flux / mesh.dim as f64
}

#[test]
fn every_sample_is_a_sound_mesh() {
    for generator in Generator::samples() {
        let kind = generator.kind();
        let mesh = generator.as_dyn().generate().unwrap();
        check::check(&mesh).unwrap_or_else(|e| panic!("{kind}: {e}"));
        assert!(check::unused_points(&mesh).is_empty(), "{kind}");
        assert_sets_cover_the_boundary(&mesh, kind);
        // The rules on curved faces are not exact: 1e-3 for those, rounding for straight ones.
        let (inside, outside) = (geometry::measure(&mesh), measure_by_boundary(&mesh));
        let straight = mesh.blocks[0].kind.order() == 1 || ["rectangle", "box"].contains(&kind);
        let exact_rule = mesh.dim == 2 || matches!(mesh.blocks[0].kind, ElementKind::Hex8);
        let tolerance = if straight || exact_rule { 1e-12 } else { 1e-3 };
        assert!(
            (inside / outside - 1.0).abs() < tolerance,
            "{kind}: {inside} {outside}"
        );
    }
}

#[test]
fn a_generator_survives_its_problem_file() {
    for generator in Generator::samples() {
        let text = toml::to_string(&generator).unwrap();
        assert_eq!(
            toml::from_str::<Generator>(&text).unwrap(),
            generator,
            "{text}"
        );
    }
    let short = "half-disc = { radius = 1.0, refine = { finest = 0.01 } }";
    assert!(
        toml::from_str::<Generator>(short)
            .unwrap()
            .as_dyn()
            .generate()
            .is_ok()
    );
    assert!(toml::from_str::<Generator>("half-disc = { radius = 1.0, radios = 2.0 }").is_err());
}

#[test]
fn rectangles_and_boxes_fill_their_space() {
    for rectangle in Rectangle::samples() {
        let mesh = rectangle.generate().unwrap();
        assert!((geometry::measure(&mesh) / 4e-4 - 1.0).abs() < 1e-12);
        assert_eq!(
            geometry::bounding_box(&mesh),
            Some(([-0.01, 0.02, 0.0], [0.03, 0.03, 0.0]))
        );
        let corner = mesh.point_sets["top-left"][0];
        assert_eq!(mesh.points[corner], [-0.01, 0.03, 0.0]);
    }
    for cuboid in Cuboid::samples() {
        let mesh = cuboid.generate().unwrap();
        assert!((geometry::measure(&mesh) / 8e-6 - 1.0).abs() < 1e-12);
        assert_eq!(mesh.point_sets.len(), 8);
        let corner = mesh.point_sets["bottom-back-right"][0];
        assert_eq!(mesh.points[corner], [0.03, 0.03, 0.0]);
        for &p in &mesh.facet_set_points("front").unwrap() {
            assert_eq!(mesh.points[p][1], 0.02);
        }
    }
}

#[test]
fn every_diagonal_gives_a_sound_mesh() {
    for diagonal in [
        Diagonal::Up,
        Diagonal::Down,
        Diagonal::Alternating,
        Diagonal::UnionJack,
    ] {
        for element in [ElementKind::Tri3, ElementKind::Tri6] {
            let rectangle = Rectangle::new([0.0, 0.0], [2.0, 1.0], [4, 3]);
            let mesh = Rectangle {
                element,
                diagonal,
                ..rectangle
            }
            .generate()
            .unwrap();
            check::check(&mesh).unwrap();
            assert_eq!(mesh.cell_count(), 24);
            assert_eq!(mesh.boundary().len(), 14);
        }
    }
}

#[test]
fn grid_lines_follow_the_grading_or_the_list() {
    let grading = Grading {
        x: Some(Stretch { ratio: 3.0 }),
        ..Grading::default()
    };
    let rectangle = Rectangle {
        grading,
        y: vec![0.0, 0.1, 1.0],
        ..Rectangle::new([0.0, 0.0], [4.0, 9.0], [2, 7])
    };
    let mesh = rectangle.generate().unwrap();
    let line = |axis: usize| {
        let mut x: Vec<f64> = mesh.points.iter().map(|p| p[axis]).collect();
        x.sort_by(f64::total_cmp);
        x.dedup();
        x
    };
    assert_eq!(line(1), [0.0, 0.1, 1.0]);
    let x = line(0);
    assert!(x.len() == 3 && (x[1] - 1.0).abs() < 1e-14 && x[2] == 4.0);
}

#[test]
fn surface_points_lie_on_the_circle_or_sphere() {
    let check = |mesh: Mesh, centre: [f64; 3], radius: f64, direction: [f64; 3]| {
        for p in mesh.facet_set_points("arc").unwrap() {
            assert!((distance(mesh.points[p], centre) / radius - 1.0).abs() < 1e-14);
        }
        let pole = mesh.points[mesh.point_sets["pole"][0]];
        let length = dot(direction, direction).sqrt();
        let expected = crate::math::add(centre, scale(radius / length, direction));
        assert!(distance(pole, expected) < 1e-15);
        let middle = mesh.points[mesh.point_sets["centre"][0]];
        assert!(distance(middle, centre) < 1e-15);
        if let Some(flat) = mesh.facet_set_points("flat") {
            for p in flat {
                assert!(dot(sub(mesh.points[p], centre), direction).abs() < 1e-15 * length);
            }
        }
    };
    let flat = |v: [f64; 2]| [v[0], v[1], 0.0];
    for d in Disc::samples() {
        check(
            d.generate().unwrap(),
            flat(d.centre),
            d.radius,
            flat(d.direction),
        );
    }
    for d in HalfDisc::samples() {
        check(
            d.generate().unwrap(),
            flat(d.centre),
            d.radius,
            flat(d.direction),
        );
    }
    for b in Ball::samples() {
        check(b.generate().unwrap(), b.centre, b.radius, b.direction);
    }
    for b in HalfBall::samples() {
        check(b.generate().unwrap(), b.centre, b.radius, b.direction);
    }
}

#[test]
fn round_bodies_have_the_measure_of_round_bodies() {
    let fine = Some(0.02);
    let area = |symmetric| {
        let disc = HalfDisc {
            radius: 1.0,
            ..HalfDisc::samples()[3].clone()
        };
        let disc = HalfDisc {
            size: fine,
            symmetric,
            ..disc
        };
        geometry::measure(&disc.generate().unwrap())
    };
    assert!((area(false) / (PI / 2.0) - 1.0).abs() < 1e-7);
    assert!((area(true) / (PI / 4.0) - 1.0).abs() < 1e-7);
    let disc = Disc {
        radius: 1.0,
        size: fine,
        ..Disc::samples()[3].clone()
    };
    assert!((geometry::measure(&disc.generate().unwrap()) / PI - 1.0).abs() < 1e-7);

    let ball = |sector| Ball {
        radius: 1.0,
        size: Some(0.2),
        element: ElementKind::Hex20,
        sector,
        ..Ball::samples()[0].clone()
    };
    for (sector, part) in [
        (Sector::Full, 1.0),
        (Sector::Half, 0.5),
        (Sector::Quarter, 0.25),
    ] {
        let volume = geometry::measure(&ball(sector).generate().unwrap());
        assert!(
            (volume / (4.0 / 3.0 * PI * part) - 1.0).abs() < 1e-4,
            "{volume}"
        );
    }
}

#[test]
fn the_upper_symmetric_half_stays_on_the_right() {
    for direction in [[0.0, -1.0], [0.0, 1.0]] {
        let disc = HalfDisc {
            direction,
            symmetric: true,
            ..HalfDisc::samples()[0].clone()
        };
        let mesh = disc.generate().unwrap();
        check::check(&mesh).unwrap();
        assert!(mesh.points.iter().all(|x| x[0] >= disc.centre[0]));
        for p in mesh.facet_set_points("axis").unwrap() {
            assert_eq!(mesh.points[p][0], disc.centre[0]);
        }
    }
    for direction in [[0.0, 0.0, -1.0], [0.0, 0.0, 1.0]] {
        let ball = HalfBall {
            direction,
            sector: Sector::Quarter,
            ..HalfBall::samples()[0].clone()
        };
        let mesh = ball.generate().unwrap();
        check::check(&mesh).unwrap();
        let c = ball.centre;
        assert!(mesh.points.iter().all(|x| x[0] >= c[0] && x[1] >= c[1]));
    }
}

#[test]
fn cells_at_the_pole_are_as_fine_as_asked() {
    let refine = Refinement {
        finest: 0.002,
        width: 0.02,
        growth: 1.2,
    };
    let disc = HalfDisc {
        radius: 1.0,
        refine: Some(refine),
        ..HalfDisc::samples()[2].clone()
    };
    let mesh = disc.generate().unwrap();
    check::check(&mesh).unwrap();
    let pole = mesh.points[mesh.point_sets["pole"][0]];
    let arc = mesh.facet_set_points("arc").unwrap();
    let near = arc
        .iter()
        .filter(|&&p| distance(mesh.points[p], pole) < 0.0201)
        .count();
    assert!(near >= 21, "ten cells on either side of the pole: {near}");
    let depth = mesh
        .points
        .iter()
        .filter(|x| x[0] == pole[0] && x[1] < pole[1] + 0.0201)
        .count();
    assert!(depth >= 11, "ten cells down: {depth}");
    assert!(mesh.cell_count() < 20_000, "{}", mesh.cell_count());
}

#[test]
fn nonsense_is_refused_with_advice() {
    let rectangle = |from, to, cells| Rectangle::new(from, to, cells);
    let unit = || rectangle([0.0, 0.0], [1.0, 1.0], [2, 2]);
    assert!(message(rectangle([0.0, 0.0], [1.0, 1.0], [0, 2]).generate()).contains("along x"));
    assert!(message(rectangle([0.0, 2.0], [1.0, 1.0], [2, 2]).generate()).contains("along y"));
    assert!(message(rectangle([0.0, f64::NAN], [1.0, 1.0], [2, 2]).generate()).contains("along y"));
    assert!(message(rectangle([0.0, 0.0], [1.0, 1.0], [100_000; 2]).generate()).contains("cells"));
    assert!(message(Rectangle { to: None, ..unit() }.generate()).contains("\"to\""));
    assert!(
        message(
            Rectangle {
                x: vec![1.0, 1.0],
                ..unit()
            }
            .generate()
        )
        .contains("\"x\"")
    );
    let grading = Grading {
        y: Some(Stretch { ratio: -1.0 }),
        ..Grading::default()
    };
    assert!(message(Rectangle { grading, ..unit() }.generate()).contains("ratio -1"));
    let grading = Grading {
        z: Some(Stretch { ratio: 2.0 }),
        ..Grading::default()
    };
    assert!(message(Rectangle { grading, ..unit() }.generate()).contains("z"));
    let element = ElementKind::Hex8;
    assert!(message(Rectangle { element, ..unit() }.generate()).contains("hex8"));
    let box_of_lines = Cuboid {
        element: ElementKind::Line2,
        ..Cuboid::samples()[0].clone()
    };
    assert!(message(box_of_lines.generate()).contains("line2"));

    let disc = || HalfDisc::samples()[2].clone();
    assert!(
        message(
            HalfDisc {
                radius: -1.0,
                ..disc()
            }
            .generate()
        )
        .contains("radius")
    );
    assert!(
        message(
            HalfDisc {
                size: Some(0.0),
                ..disc()
            }
            .generate()
        )
        .contains("size")
    );
    assert!(
        message(
            HalfDisc {
                direction: [0.0; 2],
                ..disc()
            }
            .generate()
        )
        .contains("direction")
    );
    assert!(
        message(
            HalfDisc {
                centre: [f64::INFINITY, 0.0],
                ..disc()
            }
            .generate()
        )
        .contains("centre")
    );
    let refined = |finest, width, growth| {
        let refine = Some(Refinement {
            finest,
            width,
            growth,
        });
        message(HalfDisc { refine, ..disc() }.generate())
    };
    assert!(refined(1.0, 0.0, 1.2).contains("finest"));
    assert!(refined(1e-3, -1.0, 1.2).contains("width"));
    assert!(refined(1e-3, 0.0, 0.9).contains("growth"));
    assert!(refined(1e-12, 0.0, 1.0).contains("in a row"));
}

#[test]
fn a_refined_ball_of_any_element_is_sound() {
    for element in [
        ElementKind::Hex8,
        ElementKind::Hex20,
        ElementKind::Tet4,
        ElementKind::Tet10,
    ] {
        let refine = Refinement {
            finest: 0.01,
            width: 0.04,
            growth: 1.4,
        };
        let ball = HalfBall {
            radius: 1.0,
            direction: [0.0, 0.0, 1.0],
            size: Some(0.2),
            refine: Some(refine),
            element,
            sector: Sector::Quarter,
            ..HalfBall::samples()[0].clone()
        };
        let mesh = ball.generate().unwrap();
        check::check(&mesh).unwrap_or_else(|e| panic!("{element}: {e}"));
        let volume = geometry::measure(&mesh) / (PI / 6.0);
        if element.order() == 1 {
            // Chords of length h lie at most h² / 8 R inside of the sphere in each of two directions.
            let least = (1.0_f64 - 2.0 * 0.2 * 0.2 / 8.0).powi(3);
            assert!(least < volume && volume < 1.0, "{element}: {volume}");
        } else {
            assert!((volume - 1.0).abs() < 1e-4, "{element}: {volume}");
        }
    }
}

#[test]
fn rings_have_their_circles() {
    for ring in Ring::samples() {
        let mesh = ring.generate().unwrap();
        for (set, radius) in [("bore", ring.bore), ("rim", ring.radius)] {
            for p in mesh.facet_set_points(set).unwrap() {
                let [x, y] = ring.centre;
                let away = distance(mesh.points[p], [x, y, 0.0]);
                assert!((away - radius).abs() < 1e-15, "{set}: {away}");
            }
        }
        let area = PI * (ring.radius.powi(2) - ring.bore.powi(2));
        // Twelve chords, or as many parabolas.
        let tolerance = if ring.element.order() == 1 {
            0.05
        } else {
            1e-3
        };
        assert!((geometry::measure(&mesh) / area - 1.0).abs() < tolerance);
    }
    let bad = |change: fn(&mut Ring)| {
        let mut ring = Ring::samples()[0].clone();
        change(&mut ring);
        message(ring.generate())
    };
    assert!(bad(|r| r.bore = 0.06).contains("not inside the rim"));
    assert!(bad(|r| r.cells[0] = 2).contains("do not go round"));
    assert!(bad(|r| r.cells[1] = 0).contains("no cells"));
    assert!(bad(|r| r.ratio = f64::NAN).contains("not a length"));
}

/// The normal of an involute touches its base circle, wherever on a flank; on the pitch circle teeth are as thick as their play says.
#[test]
fn flanks_of_gears_are_involutes() {
    for gear in Gear::samples() {
        let mesh = gear.generate().unwrap();
        let pitch = 0.5 * gear.module * gear.teeth as f64;
        let base = pitch * gear.pressure_angle.cos();
        let [x, y] = gear.centre;
        let polar = |p: usize| {
            let arm = sub(mesh.points[p], [x, y, 0.0]);
            (crate::math::norm(arm), arm[1].atan2(arm[0]))
        };
        let step = 2.0 * PI / gear.teeth as f64;
        let mut flanks = 0;
        for p in mesh.facet_set_points("teeth").unwrap() {
            let (radius, angle) = polar(p);
            let root = pitch - gear.dedendum * gear.module;
            let tip = pitch + gear.addendum * gear.module;
            assert!(radius > root - 1e-12 && radius < tip + 1e-12);
            let away = (angle - gear.angle).rem_euclid(step);
            let away = away.min(step - away);
            // The angle at which a string wound off the base circle ends, from the middle of the tooth.
            let rolled = ((radius / base).powi(2) - 1.0).max(0.0).sqrt();
            let involute = rolled - rolled.atan();
            let at_pitch = gear.pressure_angle.tan() - gear.pressure_angle;
            let half = 0.5 * (0.5 * step * pitch - 0.5 * gear.backlash) / pitch;
            let flank = half + at_pitch - involute;
            let edge = radius > root + 1e-9 && radius < tip - 1e-9;
            if edge {
                assert!((away - flank).abs() < 1e-9, "{radius}: {away} {flank}");
                flanks += 1;
            }
        }
        let rows = gear.cells[0] * gear.element.order() - 1;
        assert_eq!(flanks, 2 * gear.teeth * rows);
    }
    let bad = |change: fn(&mut Gear)| {
        let mut gear = Gear::samples()[0].clone();
        change(&mut gear);
        message(gear.generate())
    };
    assert!(bad(|g| g.teeth = 3).contains("no involute gear"));
    assert!(bad(|g| g.pressure_angle = 20.0).contains("none of a gear"));
    assert!(bad(|g| g.bore = 0.02).contains("reaches the root circle"));
    assert!(bad(|g| g.addendum = 5.0).contains("ends in a point"));
    assert!(bad(|g| g.cells = [0, 1, 1, 1]).contains("no cells"));
    assert!(!bad(|g| g.teeth = usize::MAX / 2).is_empty());
    assert!(bad(|g| g.backlash = f64::INFINITY).contains("heights"));
}

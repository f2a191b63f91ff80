use crate::shape::ElementKind;

/// The corners of the faces `S1`, `S2`, …, counted from 1 as in the manuals.
fn corners(kind: ElementKind) -> &'static [&'static [usize]] {
    match kind.linear() {
        ElementKind::Tri3 => &[&[1, 2], &[2, 3], &[3, 1]],
        ElementKind::Quad4 => &[&[1, 2], &[2, 3], &[3, 4], &[4, 1]],
        ElementKind::Tet4 => &[&[1, 2, 3], &[1, 4, 2], &[2, 4, 3], &[3, 4, 1]],
        ElementKind::Wedge6 => &[
            &[1, 2, 3],
            &[4, 6, 5],
            &[1, 4, 5, 2],
            &[2, 5, 6, 3],
            &[3, 6, 4, 1],
        ],
        ElementKind::Hex8 => &[
            &[1, 2, 3, 4],
            &[5, 8, 7, 6],
            &[1, 5, 6, 2],
            &[2, 6, 7, 3],
            &[3, 7, 8, 4],
            &[4, 8, 5, 1],
        ],
        _ => &[],
    }
}

/// The face of the reference element (`FacetRef::face`) that Abaqus calls `S<number>` (and `P<number>` in `*DLOAD`);
/// `None` if the kind has no such face.
pub fn face_index(kind: ElementKind, number: usize) -> Option<usize> {
    let wanted = *corners(kind).get(number.checked_sub(1)?)?;
    let faces = kind.reference().faces();
    faces.iter().position(|face| {
        let own = &face.nodes[..face.kind.corner_count()];
        own.len() == wanted.len() && own.iter().all(|node| wanted.contains(&(node + 1)))
    })
}

/// The number in `S<number>` of a face of the reference element; `None` if the kind has no such face.
pub fn face_number(kind: ElementKind, face: usize) -> Option<usize> {
    (1..=corners(kind).len()).find(|&number| face_index(kind, number) == Some(face))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_face_of_a_cell_has_one_number() {
        for kind in ElementKind::ALL.into_iter().filter(|kind| kind.dim() > 1) {
            let faces = kind.reference().faces().len();
            let mut seen = vec![false; faces];
            for number in 1..=faces {
                let face = face_index(kind, number).expect("a face");
                assert!(!seen[face], "{kind}: two numbers for face {face}");
                seen[face] = true;
                assert_eq!(face_number(kind, face), Some(number));
            }
            assert_eq!(face_index(kind, 0), None);
            assert_eq!(face_index(kind, faces + 1), None);
            assert_eq!(face_number(kind, faces), None);
        }
        assert_eq!(face_index(ElementKind::Line2, 1), None);
    }

    #[test]
    fn faces_are_where_the_manual_draws_them() {
        // The corner that a tetrahedron's face does not have; the direction a hexahedron's face looks in.
        for (number, opposite) in [(1, 3), (2, 2), (3, 0), (4, 1)] {
            let face = face_index(ElementKind::Tet10, number).expect("a face");
            assert!(
                !ElementKind::Tet10.reference().faces()[face]
                    .nodes
                    .contains(&opposite)
            );
        }
        for (number, axis, side) in [
            (1, 2, -1.0),
            (2, 2, 1.0),
            (3, 1, -1.0),
            (4, 0, 1.0),
            (5, 1, 1.0),
            (6, 0, -1.0),
        ] {
            let element = ElementKind::Hex20.reference();
            let face = face_index(ElementKind::Hex20, number).expect("a face");
            let on = |&node: &usize| element.nodes()[node][axis] == side;
            assert!(element.faces()[face].nodes.iter().all(on), "S{number}");
        }
    }
}

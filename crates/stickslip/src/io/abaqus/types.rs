use crate::shape::ElementKind;

/// What an element type such as `C3D8R` stands for.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ElementType {
    /// Its shape and order.
    pub kind: ElementKind,
    /// The space it is for.
    pub space: Space,
    /// How its stiffness is made.
    pub integration: Integration,
    /// What it has in Abaqus that it does not have here, a sentence without a final stop each. Empty for most.
    pub notes: Vec<&'static str>,
}

/// The space of an element type.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Space {
    /// `C3D…`
    Solid,
    /// `CPS…`
    PlaneStress,
    /// `CPE…`
    PlaneStrain,
    /// `CAX…`: the axis is y, the radius x.
    Axisymmetric,
}

/// The stiffness that an element type asks for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Integration {
    /// No suffix.
    Full,
    /// `R`: one order less.
    Reduced,
    /// `I`: incompatible modes, of linear quadrilaterals and hexahedra.
    Incompatible,
}

/// Why an element type is not one of ours.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Unsupported {
    /// What it is: `a beam`.
    pub what: &'static str,
    /// What to do.
    pub help: &'static str,
}

const SOLIDS: &str = "the element types that are read are C3D4, C3D6, C3D8, C3D10, C3D15, C3D20 and CPS, CPE, CAX with 3, \
     4, 6 or 8 nodes, with the suffixes R, I, M, H and T";

const MODIFIED: &str = "modified elements (M) are treated as the ordinary ones with the same nodes";
const HYBRID: &str = "hybrid elements (H) are treated as the ordinary ones: they are too stiff where Poisson's ratio is near 0.5";
const THERMAL: &str = "coupled temperature-displacement elements (T) are treated as the ordinary ones, without a temperature";
const SURFACE: &str =
    "elements with improved surface stress (S, and I of C3D10) are treated as the ordinary ones";

/// The meaning of an element type, in any case: `C3D8R`, `cpe4i`, `C3D10MH`.
///
/// # Errors
/// What the type is, if it is known and has no counterpart here, and what to do.
pub fn element_type(name: &str) -> Result<ElementType, Unsupported> {
    let upper = name.trim().to_ascii_uppercase();
    let (space, rest) = [
        ("C3D", Space::Solid),
        ("CPS", Space::PlaneStress),
        ("CPE", Space::PlaneStrain),
        ("CAX", Space::Axisymmetric),
    ]
    .into_iter()
    .find_map(|(prefix, space)| Some((space, upper.strip_prefix(prefix)?)))
    .ok_or_else(|| other(&upper))?;
    let digits = rest.bytes().take_while(u8::is_ascii_digit).count();
    let (nodes, suffix) = rest.split_at(digits);
    let kind = kind(space, nodes).ok_or(Unsupported {
        what: "a solid element with a number of nodes that is not read",
        help: SOLIDS,
    })?;
    let mut found = ElementType {
        kind,
        space,
        integration: Integration::Full,
        notes: Vec::new(),
    };
    // Where a reduced or incompatible element exists.
    let tensor = !kind.is_simplex() && kind.reference().faces().len() != 5;
    let bilinear = tensor && kind.order() == 1;
    for letter in suffix.chars() {
        match letter {
            'R' if tensor => found.integration = Integration::Reduced,
            'I' if bilinear => found.integration = Integration::Incompatible,
            'M' if kind.is_simplex() && kind.order() == 2 => found.notes.push(MODIFIED),
            'H' => found.notes.push(HYBRID),
            'T' => found.notes.push(THERMAL),
            'S' | 'I' if space == Space::Solid => found.notes.push(SURFACE),
            'P' | 'E' => {
                return Err(Unsupported {
                    what: "an element with pore pressure or electric potential",
                    help: SOLIDS,
                });
            }
            _ => {
                return Err(Unsupported {
                    what: "no element type of Abaqus or CalculiX that is known here",
                    help: SOLIDS,
                });
            }
        }
    }
    Ok(found)
}

fn kind(space: Space, nodes: &str) -> Option<ElementKind> {
    Some(match (space, nodes) {
        (Space::Solid, "4") => ElementKind::Tet4,
        (Space::Solid, "6") => ElementKind::Wedge6,
        (Space::Solid, "8") => ElementKind::Hex8,
        (Space::Solid, "10") => ElementKind::Tet10,
        (Space::Solid, "15") => ElementKind::Wedge15,
        (Space::Solid, "20") => ElementKind::Hex20,
        (Space::Solid, _) => return None,
        (_, "3") => ElementKind::Tri3,
        (_, "4") => ElementKind::Quad4,
        (_, "6") => ElementKind::Tri6,
        (_, "8") => ElementKind::Quad8,
        _ => return None,
    })
}

/// Elements that are not read, by how their names begin, longer beginnings first: what they are and what to do.
const TYPE_BEGINNINGS: &[(&str, &str, &str)] = &[
    (
        "CGAX",
        "an axisymmetric element with twist",
        "use CAX elements: motions out of the plane are not solved",
    ),
    (
        "SPRING",
        "a spring",
        "springs are SPRINGA, SPRING1 and SPRING2 with *SPRING",
    ),
    ("MASS", "a point mass", "it is read with *MASS"),
    (
        "ROTARYI",
        "a rotary inertia",
        "give the rigid body a density instead",
    ),
    ("DASHPOT", "a dashpot", "use *DAMPING of the material"),
    (
        "GAP",
        "a gap element",
        "use a contact pair between the surfaces",
    ),
    (
        "DCOUP",
        "a distributing coupling",
        "write the coupling as *EQUATION or *RIGID BODY",
    ),
    (
        "CONN",
        "a connector",
        "write the connection as *EQUATION or springs",
    ),
    ("R3D", "a rigid facet", "use a solid with *RIGID BODY"),
    ("R2D", "a rigid edge", "use a plane solid with *RIGID BODY"),
    ("RAX", "a rigid edge", "use CAX elements with *RIGID BODY"),
    (
        "B2",
        "a beam",
        "model it with solid elements: beams are not solved",
    ),
    (
        "B3",
        "a beam",
        "model it with solid elements: beams are not solved",
    ),
    (
        "PIPE",
        "a pipe",
        "model it with solid elements: beams are not solved",
    ),
    (
        "T2D",
        "a truss",
        "replace it by springs, SPRINGA with *SPRING",
    ),
    (
        "T3D",
        "a truss",
        "replace it by springs, SPRINGA with *SPRING",
    ),
    (
        "M3D",
        "a membrane",
        "model it with solid elements: membranes are not solved",
    ),
    (
        "SC",
        "a continuum shell",
        "use C3D8I or C3D20R elements with the same nodes",
    ),
    (
        "SAX",
        "a shell",
        "model it with solid elements (CAX8R, say): shells are not solved",
    ),
    (
        "STRI",
        "a shell",
        "model it with solid elements (C3D20R, say): shells are not solved",
    ),
    (
        "S",
        "a shell",
        "model it with solid elements (C3D20R, say): shells are not solved",
    ),
    ("DC", "an element of heat transfer", SOLIDS),
    ("AC", "an acoustic element", SOLIDS),
    ("COH", "a cohesive element", "tie the surfaces with *TIE"),
    ("F3D", "a fluid element", SOLIDS),
    ("U", "an element of the user", SOLIDS),
];

/// What other types are, by their first letters.
fn other(upper: &str) -> Unsupported {
    let found = TYPE_BEGINNINGS
        .iter()
        .find(|(start, ..)| upper.starts_with(start));
    let (what, help) = match found {
        _ if upper == "D" => (
            "an element of a network of flows",
            "leave the network out, and prescribe what it does as pressures",
        ),
        Some(&(_, what, help)) => (what, help),
        None => (
            "no element type of Abaqus or CalculiX that is known here",
            SOLIDS,
        ),
    };
    Unsupported { what, help }
}

/// The position in Abaqus's list of our node `i` of a cell; empty where the two agree, which is everywhere.
pub fn node_order(_kind: ElementKind) -> &'static [usize] {
    &[]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn types_are_known_with_their_suffixes_in_any_case() {
        use Integration::*;
        for (name, kind, space, integration) in [
            ("C3D4", ElementKind::Tet4, Space::Solid, Full),
            ("c3d10", ElementKind::Tet10, Space::Solid, Full),
            (" C3D8 ", ElementKind::Hex8, Space::Solid, Full),
            ("C3D6", ElementKind::Wedge6, Space::Solid, Full),
            ("C3D15", ElementKind::Wedge15, Space::Solid, Full),
            ("C3D8R", ElementKind::Hex8, Space::Solid, Reduced),
            ("C3D8i", ElementKind::Hex8, Space::Solid, Incompatible),
            ("C3D6", ElementKind::Wedge6, Space::Solid, Full),
            ("C3D15", ElementKind::Wedge15, Space::Solid, Full),
            ("C3D20R", ElementKind::Hex20, Space::Solid, Reduced),
            ("CPS3", ElementKind::Tri3, Space::PlaneStress, Full),
            (
                "CPE4I",
                ElementKind::Quad4,
                Space::PlaneStrain,
                Incompatible,
            ),
            ("CPE6", ElementKind::Tri6, Space::PlaneStrain, Full),
            ("CAX8R", ElementKind::Quad8, Space::Axisymmetric, Reduced),
        ] {
            let found = element_type(name).expect(name);
            assert_eq!(
                (found.kind, found.space, found.integration),
                (kind, space, integration),
                "{name}"
            );
            assert!(found.notes.is_empty(), "{name}");
        }
    }

    #[test]
    fn what_is_treated_as_something_else_is_noted() {
        for (name, notes) in [
            ("C3D10M", 1),
            ("CPE6MH", 2),
            ("C3D8RH", 1),
            ("C3D20RT", 1),
            ("C3D10I", 1),
            ("C3D10HS", 2),
        ] {
            assert_eq!(element_type(name).expect(name).notes.len(), notes, "{name}");
        }
    }

    #[test]
    fn other_types_are_named_with_what_to_do() {
        for (name, what) in [
            ("B32R", "a beam"),
            ("S4R", "a shell"),
            ("SPRINGA", "a spring"),
            ("MASS", "a point mass"),
            ("C3D27", "a number of nodes"),
            ("C3D8P", "pore pressure"),
            ("C3D4R", "no element type"),
            ("CPS", "a number of nodes"),
            ("", "no element type"),
            ("C3D8é", "no element type"),
        ] {
            let found = element_type(name).expect_err(name);
            assert!(found.what.contains(what), "{name}: {}", found.what);
            assert!(!found.help.is_empty());
        }
    }

    #[test]
    fn middles_of_edges_come_as_in_the_manual() {
        // Element guide: node numbers of the middles between corners.
        let tet: &[(usize, [usize; 2])] = &[
            (5, [1, 2]),
            (6, [2, 3]),
            (7, [3, 1]),
            (8, [1, 4]),
            (9, [2, 4]),
            (10, [3, 4]),
        ];
        let hex: &[(usize, [usize; 2])] = &[
            (9, [1, 2]),
            (10, [2, 3]),
            (11, [3, 4]),
            (12, [4, 1]),
            (13, [5, 6]),
            (14, [6, 7]),
            (15, [7, 8]),
            (16, [8, 5]),
            (17, [1, 5]),
            (18, [2, 6]),
            (19, [3, 7]),
            (20, [4, 8]),
        ];
        let wedge: &[(usize, [usize; 2])] = &[
            (7, [1, 2]),
            (8, [2, 3]),
            (9, [3, 1]),
            (10, [4, 5]),
            (11, [5, 6]),
            (12, [6, 4]),
            (13, [1, 4]),
            (14, [2, 5]),
            (15, [3, 6]),
        ];
        let quad: &[(usize, [usize; 2])] = &[(5, [1, 2]), (6, [2, 3]), (7, [3, 4]), (8, [4, 1])];
        let tri: &[(usize, [usize; 2])] = &[(4, [1, 2]), (5, [2, 3]), (6, [3, 1])];
        for (kind, middles) in [
            (ElementKind::Tet10, tet),
            (ElementKind::Hex20, hex),
            (ElementKind::Wedge15, wedge),
            (ElementKind::Quad8, quad),
            (ElementKind::Tri6, tri),
        ] {
            assert!(node_order(kind).is_empty());
            let nodes = kind.reference().nodes();
            for &(middle, [a, b]) in middles {
                let mean = [0, 1, 2].map(|i| 0.5 * (nodes[a - 1][i] + nodes[b - 1][i]));
                assert_eq!(nodes[middle - 1], mean, "{kind} node {middle}");
            }
        }
    }
}

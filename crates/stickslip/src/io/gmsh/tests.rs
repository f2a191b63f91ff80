use std::path::{Path, PathBuf};

use super::{parse, read};
use crate::error::MeshError;
use crate::math::{add, norm, scale, sub};
use crate::mesh::{FacetRef, Mesh, check};
use crate::shape::ElementKind;

const FORMATS: [&str; 4] = ["msh22", "msh22-bin", "msh41", "msh41-bin"];

fn file(case: &str, format: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("tests/meshes/{case}-{format}.msh"))
}

fn load(case: &str, format: &str) -> Mesh {
    read(&file(case, format)).unwrap_or_else(|e| panic!("{e}"))
}

fn refused(text: &str) -> MeshError {
    parse(text.as_bytes(), Path::new("a.msh")).expect_err("this should be refused")
}

fn facet_points(mesh: &Mesh, facet: FacetRef) -> Vec<usize> {
    mesh.facet_points(facet).1
}

/// Middle nodes, as pairs of corners, in our order.
fn edges(kind: ElementKind) -> &'static [[usize; 2]] {
    match kind {
        ElementKind::Tri6 => &[[0, 1], [1, 2], [2, 0]],
        ElementKind::Quad8 => &[[0, 1], [1, 2], [2, 3], [3, 0]],
        ElementKind::Tet10 => &[[0, 1], [1, 2], [2, 0], [0, 3], [1, 3], [2, 3]],
        ElementKind::Hex20 => &[
            [0, 1],
            [1, 2],
            [2, 3],
            [3, 0],
            [4, 5],
            [5, 6],
            [6, 7],
            [7, 4],
            [0, 4],
            [1, 5],
            [2, 6],
            [3, 7],
        ],
        _ => &[],
    }
}

fn assert_middle_nodes(mesh: &Mesh) {
    for block in &mesh.blocks {
        let n = block.kind.node_count();
        let corners = n - edges(block.kind).len();
        for cell in block.connectivity.chunks_exact(n) {
            for (i, &[a, b]) in edges(block.kind).iter().enumerate() {
                let middle = mesh.points[cell[corners + i]];
                let ends = add(mesh.points[cell[a]], mesh.points[cell[b]]);
                let error = norm(sub(middle, scale(0.5, ends)));
                assert!(error < 1e-9, "{:?} node {}", block.kind, corners + i);
            }
        }
    }
}

/// The mesh without what version 2.2 does differently: it sorts cells by kind and numbers them anew, because it repeats
/// those in several groups. Cells and facets are told by their points.
fn canonical(mesh: &Mesh) -> Vec<(String, Vec<Vec<usize>>)> {
    let cell_points = |cell| mesh.cell_points(cell).to_vec();
    let mut parts = Vec::new();
    for block in &mesh.blocks {
        let cells = block.connectivity.chunks_exact(block.kind.node_count());
        parts.push((
            format!("{:?}", block.kind),
            cells.map(<[usize]>::to_vec).collect(),
        ));
    }
    for (name, cells) in &mesh.cell_sets {
        let cells = cells.iter().map(|&c| cell_points(c)).collect();
        parts.push((format!("cells {name}"), cells));
    }
    for (name, facets) in &mesh.facet_sets {
        let facets = facets
            .iter()
            .map(|&f| [facet_points(mesh, f), cell_points(f.cell)].concat())
            .collect();
        parts.push((format!("facets {name}"), facets));
    }
    for (name, points) in &mesh.point_sets {
        parts.push((format!("points {name}"), vec![points.clone()]));
    }
    parts.iter_mut().for_each(|(_, lists)| lists.sort());
    parts.sort();
    parts
}

#[test]
fn formats_agree() {
    for case in ["plate-1", "plate-2", "blocks-1", "blocks-2"] {
        let reference = load(case, "msh41-bin");
        assert_eq!(check::check(&reference).map_err(|e| e.to_string()), Ok(()));
        assert_middle_nodes(&reference);
        for format in FORMATS {
            let mesh = load(case, format);
            assert_eq!(mesh.point_ids, reference.point_ids);
            assert_eq!(canonical(&mesh), canonical(&reference), "{case} {format}");
            // Text has 16 digits: the last bit may be lost.
            for (p, q) in mesh.points.iter().zip(&reference.points) {
                for k in 0..3 {
                    assert!((p[k] - q[k]).abs() <= 1e-15 * q[k].abs(), "{case} {format}");
                }
            }
        }
        for version in ["msh22", "msh41"] {
            let (text, binary) = (load(case, version), load(case, &format!("{version}-bin")));
            assert_eq!(text.blocks, binary.blocks);
        }
    }
}

#[test]
fn plane_mesh_has_its_sets() {
    for order in [1, 2] {
        let mesh = load(&format!("plate-{order}"), "msh22");
        assert_eq!(mesh.dim, 2);
        let mut kinds: Vec<_> = mesh.blocks.iter().map(|b| b.kind).collect();
        kinds.sort();
        let expected = match order {
            1 => [ElementKind::Tri3, ElementKind::Quad4],
            _ => [ElementKind::Tri6, ElementKind::Quad8],
        };
        assert_eq!(kinds, expected);
        assert!(mesh.points.iter().all(|p| p[2] == 0.0));
        assert_eq!(mesh.cell_sets["left part"].len(), 4);
        assert_eq!(mesh.cell_sets["right part"].len(), 8);
        assert_eq!(mesh.cell_sets["all"].len(), 12);
        assert_eq!(mesh.facet_sets["bottom"].len(), 4);
        for &facet in &mesh.facet_sets["bottom"] {
            assert!(
                facet_points(&mesh, facet)
                    .iter()
                    .all(|&p| mesh.points[p][1] == 0.0)
            );
        }
        assert_eq!(mesh.facet_sets["physical-77"].len(), 2);
        let corner = mesh.point_sets["corner"][0];
        assert_eq!(mesh.points[corner], [0.0; 3]);
        assert_eq!(mesh.point_ids[corner], 1);
        assert_eq!(mesh.point_sets["bottom"].len(), 4 * order + 1);
        assert_eq!(
            mesh.point_sets["left part"].len(),
            if order == 1 { 9 } else { 21 }
        );
    }
}

#[test]
fn orientation_chooses_the_owner_of_an_interior_facet() {
    for format in FORMATS {
        for order in [1, 2] {
            let mesh = load(&format!("plate-{order}"), format);
            for (set, kinds) in [
                ("between", [ElementKind::Quad4, ElementKind::Quad8]),
                (
                    "between, seen from the right",
                    [ElementKind::Tri3, ElementKind::Tri6],
                ),
            ] {
                let facets = &mesh.facet_sets[set];
                assert_eq!(facets.len(), 2);
                // The curve goes up: the quadrilaterals are on its left.
                assert!(
                    facets
                        .iter()
                        .all(|f| kinds.contains(&mesh.blocks[f.cell.block].kind)),
                    "{format} {set}"
                );
                for &facet in facets {
                    assert!(
                        facet_points(&mesh, facet)
                            .iter()
                            .all(|&p| mesh.points[p][0] == 1.0)
                    );
                }
            }
        }
    }
}

#[test]
fn solid_mesh_has_its_sets() {
    for (order, kinds) in [
        (1, [ElementKind::Tet4, ElementKind::Hex8]),
        (2, [ElementKind::Tet10, ElementKind::Hex20]),
    ] {
        let mesh = load(&format!("blocks-{order}"), "msh41-bin");
        assert_eq!(mesh.dim, 3);
        assert!(
            kinds
                .iter()
                .all(|k| mesh.blocks.iter().any(|b| b.kind == *k))
        );
        assert_eq!(mesh.cell_sets["brick"].len(), 1);
        let cells: usize = mesh.blocks.iter().map(|b| b.cell_ids.len()).sum();
        assert_eq!(mesh.cell_sets["wedges"].len(), cells - 1);
        for (set, k, value) in [("top", 2, 1.0), ("inside", 0, 3.0)] {
            assert!(mesh.facet_sets[set].len() > 1);
            for &facet in &mesh.facet_sets[set] {
                assert!(
                    facet_points(&mesh, facet)
                        .iter()
                        .all(|&p| mesh.points[p][k] == value)
                );
            }
        }
        assert_eq!(mesh.point_sets["edge"].len(), order + 1);
        assert!(!mesh.facet_sets.contains_key("edge"));
        assert_eq!(mesh.point_sets["foot"].len(), 1);
    }
}

#[test]
fn cut_short_never_panics() {
    for case in ["plate-1", "plate-2", "blocks-1", "blocks-2"] {
        for format in FORMATS {
            let bytes = std::fs::read(file(case, format)).unwrap();
            // Short of the last line, something is always missing.
            let last = bytes.len() - "$EndElements\n".len();
            for length in (0..last).step_by(7) {
                let error = parse(&bytes[..length], Path::new("cut.msh")).unwrap_err();
                assert!(error.help.is_some(), "{case} {format} {length}: {error}");
                assert_eq!(
                    error.line.is_none(),
                    error.message.contains("at byte"),
                    "{error}"
                );
            }
        }
    }
}

#[test]
fn damaged_bytes_never_panic() {
    for format in FORMATS {
        let bytes = std::fs::read(file("plate-2", format)).unwrap();
        for at in 0..bytes.len() {
            let mut damaged = bytes.clone();
            damaged[at] ^= 0x91;
            let _ = parse(&damaged, Path::new("damaged.msh"));
        }
    }
}

/// Swaps the bytes of the binary parts of a version 2.2 file.
#[test]
fn big_endian_is_read() {
    let mut bytes: Vec<u8> = b"$MeshFormat\n2.2 1 8\n".to_vec();
    bytes.extend(1i32.to_be_bytes());
    bytes.extend(b"\n$EndMeshFormat\n$Nodes\n3\n");
    for (tag, x) in [
        (5i32, [0.0f64, 0.0, 0.0]),
        (6, [1.5, 0.0, 0.0]),
        (9, [0.0, 2.5, 0.0]),
    ] {
        bytes.extend(tag.to_be_bytes());
        x.iter().for_each(|x| bytes.extend(x.to_be_bytes()));
    }
    bytes.extend(b"\n$EndNodes\n$Elements\n1\n");
    for value in [2i32, 1, 2, 41, 0, 1, 5, 6, 9] {
        bytes.extend(value.to_be_bytes());
    }
    bytes.extend(b"\n$EndElements\n");
    let mesh = parse(&bytes, Path::new("big.msh")).unwrap();
    assert_eq!(mesh.point_ids, [5, 6, 9]);
    assert_eq!(mesh.points[2], [0.0, 2.5, 0.0]);
    assert_eq!(mesh.blocks[0].cell_ids, [41]);
}

/// A triangle of version 2.2 with the given nodes and elements.
fn triangle(nodes: &str, elements: &str) -> String {
    let count = |text: &str| text.lines().count();
    format!(
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{}\n{nodes}\n$EndNodes\n$Elements\n{}\n{elements}\n$EndElements\n",
        count(nodes),
        count(elements)
    )
}

const NODES: &str = "1 0 0 0\n2 1 0 0\n3 0 1 0";

#[test]
fn unused_nodes_are_dropped_and_unknown_sections_skipped() {
    let text = triangle(
        "8 9 9 9\n1 0 0 0\n2 1 0 0\n3 0 1 0",
        "1 15 2 4 1 8\n2 2 2 0 1 1 2 3",
    ) + "$NodeData\nanything 1 2 3\n$EndNodeData\n";
    let mesh = parse(text.as_bytes(), Path::new("a.msh")).unwrap();
    assert_eq!(mesh.point_ids, [1, 2, 3]);
    assert!(mesh.point_sets.is_empty() && mesh.cell_sets.is_empty());
}

#[test]
fn errors_name_the_line_and_the_remedy() {
    let quad9 =
        "1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 .5 0 0\n6 1 .5 0\n7 .5 1 0\n8 0 .5 0\n9 .5 .5 0";
    for (text, line, message, help) in [
        (String::new(), 1, "not a Gmsh mesh", "2.2 or 4.1"),
        ("$NOD\n3\n".into(), 2, "version 1", "msh41"),
        ("$MeshFormat\n4.0 0 8\n".into(), 2, "version 4.0", "msh41"),
        ("$MeshFormat\n4.1 0 4\n".into(), 2, "4 bytes", "msh41"),
        (
            triangle("1 0 0 0\n2 nan 0 0\n3 0 1 0", "1 2 2 0 1 1 2 3"),
            7,
            "node 2 is NaN",
            "finite",
        ),
        (
            triangle("1 0 0 0\n2 1 1e999 0\n3 0 1 0", "1 2 2 0 1 1 2 3"),
            7,
            "node 2 is inf",
            "finite",
        ),
        (
            triangle("1 0 0 0\n2 x 0 0\n3 0 1 0", "1 2 2 0 1 1 2 3"),
            7,
            "found `x`",
            "counts",
        ),
        (
            triangle("1 0 0 0\n1 1 0 0\n3 0 1 0", "1 2 2 0 1 1 2 3"),
            7,
            "two nodes 1",
            "unique",
        ),
        (
            triangle(NODES, "1 2 2 0 1 1 2 4"),
            12,
            "node 4, which is not",
            "save it again",
        ),
        (
            triangle(NODES, "1 1 2 0 1 1 2"),
            14,
            "neither surface nor volume",
            "Mesh.SaveAll",
        ),
        (
            triangle(NODES, "1 7 2 0 1 1 2 3 1 2"),
            12,
            "5-node pyramid",
            "tetrahedra",
        ),
        (
            triangle(quad9, "7 10 2 0 1 1 2 3 4 5 6 7 8 9"),
            18,
            "element 7 is of Gmsh type 10 (9-node",
            "SecondOrderIncomplete = 1",
        ),
        (
            triangle("1 0 0 0\n2 1 0 0\n3 0 1 0.5", "1 2 2 0 1 1 2 3"),
            8,
            "not planar",
            "volume",
        ),
        (
            triangle(NODES, "1 2 2 0 1 1 2 3").replace("$Nodes\n3\n", "$Nodes\n4\n"),
            9,
            "found `$EndNodes`",
            "counts",
        ),
        (
            triangle(NODES, "1 2 2 0 1 1 2 3").replace("$Nodes\n3\n", "$Nodes\n2\n"),
            8,
            "expected $EndNodes",
            "counts",
        ),
        (
            triangle(NODES, "1 2 2 0 1 1 2 3").replace("$Nodes\n3\n", "$Nodes\n99999999999999\n"),
            5,
            "number of nodes is 99999999999999",
            "truncated",
        ),
        (
            triangle(NODES, "1 1 2 5 1 1 2\n2 1 2 5 1 2 2\n3 2 2 0 1 1 2 3"),
            13,
            "not a face",
            "group of its own",
        ),
    ] {
        let error = refused(&text);
        assert!(
            error.message.contains(message),
            "{error}\nexpected {message}"
        );
        assert!(
            error.help.as_ref().is_some_and(|h| h.contains(help)),
            "{error}\nexpected {help}"
        );
        assert_eq!(error.line, Some(line), "{error}");
        assert_eq!(error.file.as_deref(), Some(Path::new("a.msh")));
    }
    let parametric = triangle(NODES, "1 2 2 0 1 1 2 3").replace("Nodes\n", "ParametricNodes\n");
    let error = refused(&parametric).to_string();
    assert!(error.contains("Mesh.SaveParametric = 0"), "{error}");
    let error = read(Path::new("no/such/file.msh")).unwrap_err();
    assert!(error.message.contains("cannot be read"));
}

#[test]
fn a_name_shared_by_dimensions_keeps_the_points_of_the_lowest() {
    let text = triangle(NODES, "1 1 2 1 1 1 2\n2 2 2 1 1 1 2 3");
    let mesh = parse(text.as_bytes(), Path::new("a.msh")).unwrap();
    assert_eq!(mesh.point_sets["physical-1"], [0, 1]);
    assert_eq!(mesh.facet_sets["physical-1"].len(), 1);
    assert_eq!(mesh.cell_sets["physical-1"].len(), 1);
}

#[test]
fn a_sheet_beside_the_body_is_no_facet_set() {
    let nodes = "1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 5 0 0\n6 6 0 0\n7 5 1 0";
    let text = triangle(nodes, "1 2 2 3 1 5 6 7\n2 4 2 0 1 1 2 3 4");
    let mesh = parse(text.as_bytes(), Path::new("a.msh")).unwrap();
    assert!(mesh.facet_sets.is_empty() && mesh.point_sets.is_empty());
    assert_eq!(mesh.points.len(), 4);
}

#[test]
fn parts_of_a_partition_are_in_the_groups_of_their_parents() {
    let text = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n\
        $PhysicalNames\n1\n2 3 \"plate\"\n$EndPhysicalNames\n\
        $Entities\n0 0 1 0\n1 0 0 0 1 1 0 1 3 0\n$EndEntities\n\
        $PartitionedEntities\n2\n1\n9 1\n0 0 1 0\n2 2 1 1 1 0 0 0 1 1 0 0 0\n$EndPartitionedEntities\n\
        $Nodes\n1 3 1 3\n2 2 1 3\n1\n2\n3\n0 0 0 0 0\n1 0 0 1 0\n0 1 0 0 1\n$EndNodes\n\
        $Elements\n1 1 1 1\n2 2 2 1\n1 1 2 3\n$EndElements\n";
    let mesh = parse(text.as_bytes(), Path::new("a.msh")).unwrap();
    assert_eq!(mesh.cell_sets["plate"].len(), 1);
    assert_eq!(mesh.points[1], [1.0, 0.0, 0.0]);
}

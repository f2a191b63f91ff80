use std::path::{Path, PathBuf};

use crate::io::gmsh;
use crate::mesh::{Block, CellRef, Mesh, check};
use crate::shape::ElementKind;
use crate::system::Fields;

use super::{parse_mesh, read_mesh, write, write_mesh};

fn temporary(name: &str) -> PathBuf {
    std::env::temp_dir().join(format!("stickslip-grid-{}-{name}", std::process::id()))
}

fn again(mesh: &Mesh, name: &str) -> Mesh {
    let path = temporary(name);
    let notes = write_mesh(&path, mesh).unwrap();
    assert!(notes.is_empty(), "{notes:?}");
    let found = read_mesh(&path).unwrap();
    std::fs::remove_file(&path).unwrap();
    found
}

#[test]
fn meshes_of_gmsh_come_back_equal() {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/meshes");
    for name in ["blocks-1", "blocks-2", "plate-1", "plate-2"] {
        let mesh = gmsh::read(&folder.join(format!("{name}-msh41.msh"))).unwrap();
        assert_eq!(again(&mesh, name), mesh, "{name}");
    }
}

#[test]
fn both_sides_of_a_facet_inside_come_back() {
    let kind = ElementKind::Quad4;
    let mut mesh = Mesh {
        dim: 2,
        points: [[0, 0], [1, 0], [2, 0], [0, 1], [1, 1], [2, 1]]
            .map(|[x, y]| [f64::from(x), f64::from(y), 0.0])
            .into(),
        point_ids: (11..17).collect(),
        blocks: vec![Block {
            kind,
            connectivity: vec![0, 1, 4, 3, 1, 2, 5, 4],
            cell_ids: vec![8, 5],
        }],
        ..Mesh::default()
    };
    for (cell, face, name) in [(0, 1, "left side"), (1, 3, "right side")] {
        let cell = CellRef { block: 0, cell };
        let facet = crate::mesh::FacetRef { cell, face };
        mesh.facet_sets.insert(name.into(), vec![facet]);
        mesh.point_sets.insert(name.into(), vec![1, 4]);
    }
    mesh.point_sets.insert("corner".into(), vec![0]);
    assert_eq!(again(&mesh, "sides"), mesh);
}

#[test]
fn results_are_meshes_with_a_set_for_every_body() {
    let mesh = gmsh::read(
        &PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/meshes/plate-1-msh41.msh"),
    )
    .unwrap();
    let path = temporary("bodies");
    let bodies: Vec<usize> = (0..mesh.cell_count()).map(|c| c % 2).collect();
    write(&path, &mesh, &Fields::default(), Some(&bodies)).unwrap();
    let zero_one = read_mesh(&path).unwrap();
    let three: Vec<usize> = bodies.iter().map(|b| b + 1).collect();
    write(&path, &mesh, &Fields::default(), Some(&three)).unwrap();
    let from_one = read_mesh(&path).unwrap();
    std::fs::remove_file(&path).unwrap();
    assert_eq!(zero_one.blocks, mesh.blocks);
    assert_eq!(zero_one.point_ids, mesh.point_ids);
    assert_eq!(zero_one.cell_sets["BODY"].len(), mesh.cell_count() / 2);
    assert_eq!(from_one.cell_sets["BODY-2"], zero_one.cell_sets["BODY"]);
    assert!(from_one.cell_sets.contains_key("BODY-1"));
}

/// A grid as text: points, connectivity, offsets, types, more sections.
fn text(points: &str, connectivity: &str, offsets: &str, types: &str, more: &str) -> String {
    let count = points.split_whitespace().count() / 3;
    let cells = types.split_whitespace().count();
    format!(
        "<VTKFile type='UnstructuredGrid'>\n<UnstructuredGrid>\n\
         <Piece NumberOfPoints='{count}' NumberOfCells='{cells}'>\n\
         <Points><DataArray type='Float32' NumberOfComponents='3'>{points}</DataArray></Points>\n\
         <Cells>\n<DataArray type='Int32' Name='connectivity'>{connectivity}</DataArray>\n\
         <DataArray type='Int32' Name='offsets'>{offsets}</DataArray>\n\
         <DataArray type='UInt8' Name='types'>{types}</DataArray>\n</Cells>\n{more}\
         </Piece>\n</UnstructuredGrid>\n</VTKFile>\n"
    )
}

const POINTS: &str = "9 9 4 0 0 4 1 0 4 0 1 4 1 1 4";

fn parse(text: &str) -> Mesh {
    parse_mesh(text.as_bytes(), Path::new("a.vtu")).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

#[test]
fn grids_of_other_programs_are_brought_into_shape() {
    // A pixel, whose points come row by row; an unused point; a plane that is not z = 0; an edge and its set; a vertex.
    let data = "<CellData><DataArray type='Int64' Name='group'>7 3 4</DataArray>\
                <DataArray type='String' Name='text'>65</DataArray>\
                <DataArray type='Float64' Name='p'>1 0 0</DataArray></CellData>\n\
                <PointData><DataArray type='Int8' Name='tip'>1 0 0 0 1</DataArray></PointData>";
    let mesh = parse(&text(POINTS, "1 2 3 4 1 2 4", "4 6 7", "8 3 1", data));
    assert_eq!(mesh.dim, 2);
    assert_eq!(mesh.points.len(), 4);
    assert_eq!(mesh.points[3], [1.0, 1.0, 0.0]);
    assert_eq!(mesh.point_ids, [1, 2, 3, 4]);
    assert_eq!(mesh.blocks[0].connectivity, [0, 1, 3, 2]);
    assert_eq!(mesh.cell_sets["group-7"].len(), 1);
    assert_eq!(mesh.facet_sets["group-3"][0].face, 0);
    assert_eq!(mesh.point_sets["group-3"], [0, 1]);
    assert_eq!(mesh.point_sets["group-4"], [3]);
    assert_eq!(mesh.point_sets["tip"], [3]);
    assert_eq!(mesh.point_sets.len(), 4);
    check::check(&mesh).unwrap();
    // Turned over as a whole; one of two cells is left as it is.
    let clockwise = text(POINTS, "1 3 2 2 3 4", "3 6", "5 5", "");
    check::check(&parse(&clockwise)).unwrap();
    assert!(check::check(&parse(&clockwise.replace("2 3 4", "3 2 4"))).is_err());
}

#[test]
fn what_is_wrong_with_a_grid_is_said_with_what_to_do() {
    let cases = [
        (text("", "", "", "", ""), "neither surface nor solid", None),
        (
            text(POINTS, "1 2 9", "3", "5", ""),
            "cell 0 (counted from 0) uses point 9, but the points are 0 to 4",
            Some(6),
        ),
        (
            text(POINTS, "1 2 -1", "3", "5", ""),
            "uses point -1",
            Some(6),
        ),
        (
            text(POINTS, "1 2 3", "3", "9", ""),
            "is a quad4, which has 4 points, but `offsets` gives it 3",
            Some(6),
        ),
        (
            text(POINTS, "1 2 3", "3", "14", ""),
            "VTK type 14 (pyramid)",
            Some(6),
        ),
        (
            text(POINTS, "1 2 3 2 3 4", "3 2", "5 5", ""),
            "array `connectivity`: it has 6 values where the grid needs 2",
            Some(6),
        ),
        (
            text(POINTS, "1 2 3 2 3 4", "9 6", "5 5", ""),
            "cell 0 (counted from 0): its entry in `offsets` is 9, where 0 to 6",
            Some(7),
        ),
        (
            text(POINTS, "1 2 3", "-3", "5", ""),
            "the last of `offsets` is no count of points: -3",
            Some(7),
        ),
        (
            text(POINTS, "1 2 3", "3", "5", "").replace("types", "kinds"),
            "the piece has no array `types` in <Cells>",
            Some(3),
        ),
        (
            text(POINTS, "1 2 3", "3", "5", "").replace("UInt8", "String"),
            "array `types`: values of type `String` are not read",
            Some(8),
        ),
        (
            text(&POINTS.replace("1 1 4", "1 nan 4"), "1 2 3", "3", "5", ""),
            "point 4 (counted from 0) has a coordinate that is not finite",
            Some(4),
        ),
        (
            text(&POINTS.replace("1 1 4", "1 1 5"), "1 2 4", "3", "5", ""),
            "not planar: z is 4e0 to 5e0",
            None,
        ),
    ];
    for (text, message, line) in cases {
        let error = parse_mesh(text.as_bytes(), Path::new("a.vtu")).unwrap_err();
        assert!(
            error.message.contains(message),
            "{error}\nexpected {message}"
        );
        assert_eq!(error.line, line, "{error}");
        assert!(error.help.is_some(), "{error}");
        assert_eq!(error.file.as_deref(), Some(Path::new("a.vtu")));
    }
}

#[test]
fn every_kind_comes_back_and_wedges_from_either_order() {
    for kind in ElementKind::ALL.into_iter().filter(|kind| kind.dim() > 1) {
        let points = kind.reference().nodes();
        let mut mesh = Mesh {
            dim: kind.dim(),
            points: points.to_vec(),
            point_ids: (0..points.len() as u64).map(|i| 100 - i).collect(),
            blocks: vec![Block {
                kind,
                connectivity: (0..points.len()).collect(),
                cell_ids: vec![3],
            }],
            ..Mesh::default()
        };
        for (i, facet) in mesh.boundary().into_iter().enumerate() {
            let points = mesh.points_of_facets(&[facet]);
            mesh.facet_sets.insert(format!("face {i}"), vec![facet]);
            mesh.point_sets.insert(format!("face {i}"), points);
        }
        assert_eq!(again(&mesh, kind.name()), mesh, "{kind}");
    }
    let points = "0 0 0 1 0 0 0 1 0 0 0 1 1 0 1 0 1 1";
    for nodes in ["0 1 2 3 4 5", "0 2 1 3 5 4"] {
        let mesh = parse(&text(points, nodes, "6", "13", ""));
        assert_eq!(mesh.blocks[0].connectivity, [0, 1, 2, 3, 4, 5]);
        check::check(&mesh).unwrap();
    }
}

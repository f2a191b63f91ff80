use std::path::PathBuf;

use crate::mesh::{Block, Mesh};
use crate::shape::ElementKind;
use crate::system::{Field, Fields, Location};

use super::read::point_fields as parse;
use super::stream::tests::{deflate, encode};
use super::{PointArray, PointFields, read, write};

fn temporary(name: &str) -> PathBuf {
    std::env::temp_dir().join(format!("stickslip-vtu-{}-{name}", std::process::id()))
}

/// A mesh of one cell with so many points, and fields with every kind of number on it.
fn model(points: usize, kind: ElementKind) -> (Mesh, Fields) {
    let mesh = Mesh {
        dim: kind.dim(),
        point_ids: (0..points as u64).map(|i| (1 << 53) - i).collect(),
        points: (0..points)
            .map(|i| [(i as f64).sin(), -1.0 / (i as f64 + 0.1), 1e-300])
            .collect(),
        blocks: vec![Block {
            kind,
            connectivity: (0..kind.node_count()).collect(),
            cell_ids: vec![7],
        }],
        ..Mesh::default()
    };
    let odd = [
        f64::NAN,
        -f64::NAN,
        f64::from_bits(0x7ff0_0000_0000_0001),
        f64::INFINITY,
        -0.0,
        f64::MIN_POSITIVE / 8.0,
        f64::MAX,
    ];
    let field = |name: &str, location, components, count: usize| Field {
        name: name.to_string(),
        location,
        components,
        values: (0..count * components)
            .map(|i| match odd.get(i % 100) {
                Some(&value) => value,
                None => (i as f64).cos() / 3.0,
            })
            .collect(),
    };
    let all = vec![
        field("CPRESS", Location::Point, 1, points),
        field("U", Location::Point, 3, points),
        field("S", Location::Point, 6, points),
        field("S", Location::Cell, 6, 1),
        field("<a b=\"c\"> & 'Ω'", Location::Point, 2, points),
    ];
    (mesh, Fields { all })
}

fn bits(values: &[f64]) -> Vec<u64> {
    values.iter().map(|v| v.to_bits()).collect()
}

/// The whole of what was read, for comparisons that NaN does not spoil.
fn all_bits(fields: &PointFields) -> Vec<(String, usize, Vec<u64>)> {
    let points = ("points".to_string(), 3, bits(fields.points.as_flattened()));
    let arrays = fields.arrays.iter();
    std::iter::once(points)
        .chain(arrays.map(|(name, a)| (name.clone(), a.components, bits(&a.values))))
        .collect()
}

#[test]
fn what_was_written_reads_back_to_the_bit() {
    // The first has arrays of several blocks; the second a block that is exactly full.
    for (points, kind) in [
        (40_001, ElementKind::Hex20),
        (1 << 15, ElementKind::Tet4),
        (8, ElementKind::Quad8),
        (3, ElementKind::Tri3),
    ] {
        let (mesh, fields) = model(points, kind);
        let path = temporary(&format!("bits-{points}.vtu"));
        write(&path, &mesh, &fields, Some(&[1])).unwrap();
        let found = read(&path).unwrap();
        std::fs::remove_file(&path).unwrap();
        let mut expected = PointFields {
            points: mesh.points,
            ..PointFields::default()
        };
        let ids = Field {
            name: "NODE_ID".to_string(),
            location: Location::Point,
            components: 1,
            values: mesh.point_ids.iter().map(|&id| id as f64).collect(),
        };
        for field in fields.all.into_iter().chain([ids]) {
            if field.location == Location::Point {
                let (components, values) = (field.components, field.values);
                let array = PointArray { components, values };
                expected.arrays.insert(field.name, array);
            }
        }
        assert_eq!(all_bits(&found), all_bits(&expected), "{points} points");
    }
}

#[test]
fn an_empty_mesh_reads_back() {
    let path = temporary("empty.vtu");
    write(&path, &Mesh::default(), &Fields::default(), None).unwrap();
    let found = read(&path).unwrap();
    std::fs::remove_file(&path).unwrap();
    assert!(found.points.is_empty());
    assert_eq!(found.arrays.keys().collect::<Vec<_>>(), ["NODE_ID"]);
    assert!(found.arrays["NODE_ID"].values.is_empty());
}

/// A grid of two points with these arrays of point data.
fn file(root: &str, arrays: &str, appended: &str) -> String {
    format!(
        "<VTKFile type='UnstructuredGrid' {root}><UnstructuredGrid>\
         <Piece NumberOfPoints='2' NumberOfCells='0'><PointData>{arrays}</PointData>\
         <Points><DataArray type='Float64' NumberOfComponents='3'>0 0 0 1 2 3</DataArray></Points>\
         </Piece></UnstructuredGrid>{appended}</VTKFile>"
    )
}

#[test]
fn a_file_in_ascii_is_read() {
    let text = r#"<?xml version="1.0"?>
        <!-- a comment with <tags> -->
        <VTKFile byte_order='LittleEndian' compressor="vtkLZMADataCompressor" type='UnstructuredGrid'>
          <UnstructuredGrid>
            <FieldData><DataArray type="Float64" Name="TimeValue" format="ascii">2</DataArray></FieldData>
            <Piece NumberOfCells="1" NumberOfPoints = "3" >
              <CellData Scalars="A"><DataArray type="Nothing" Name="A" format="none"> 9 </DataArray></CellData>
              <Points>
                <DataArray NumberOfComponents='3' format='ascii' type='Float32'>
                  0 0 0   1 0 0
                  0.1 -2.5e-3 7
                </DataArray>
              </Points>
              <PointData Vectors='V'>
                <DataArray Name='V' format="ascii" type="Float64" NumberOfComponents="2" RangeMin='&gt;'>
                  1 nan -inf 0.1 1e-320 -0
                  <InformationKey name="range" length="1"><Value index="0">5 6</Value></InformationKey>
                </DataArray>
                <DataArray type="Int8" Name="a &amp; b">-128 0 127</DataArray>
                <DataArray type="UInt64" Name="N"><!-- first -->1 2 3</DataArray>
              </PointData>
            </Piece>
          </UnstructuredGrid>
        </VTKFile>
    "#;
    let found = parse(text.as_bytes()).unwrap();
    let third = [f64::from(0.1_f32), f64::from(-2.5e-3_f32), 7.0];
    assert_eq!(found.points, [[0.0; 3], [1.0, 0.0, 0.0], third]);
    let names: Vec<&str> = found.arrays.keys().map(String::as_str).collect();
    assert_eq!(names, ["N", "V", "a & b"]);
    let v = &found.arrays["V"];
    assert_eq!(v.components, 2);
    assert!(v.values[1].is_nan());
    assert_eq!(v.values[0], 1.0);
    let rest = [f64::NEG_INFINITY, 0.1, 1e-320, -0.0];
    assert_eq!(bits(&v.values[2..]), bits(&rest));
    assert_eq!(found.arrays["a & b"].values, [-128.0, 0.0, 127.0]);
    assert_eq!(found.arrays["N"].values, [1.0, 2.0, 3.0]);
}

/// An array with its header, in the ways that differ by program.
fn packed(bytes: &[u8], word: usize, zlib: bool) -> (Vec<u8>, Vec<u8>) {
    let mut words = vec![bytes.len()];
    let mut body = bytes.to_vec();
    if zlib {
        // Blocks of seven bytes, so that there are several and values lie in two.
        let blocks: Vec<Vec<u8>> = bytes.chunks(7).map(deflate).collect();
        words = vec![blocks.len(), 7, bytes.len() % 7];
        words.extend(blocks.iter().map(Vec::len));
        body = blocks.concat();
    }
    let header = words.iter().map(|&n| (n as u64).to_le_bytes());
    (header.flat_map(|n| n[..word].to_vec()).collect(), body)
}

#[test]
fn binary_arrays_are_read_however_they_are_packed() {
    let values = [[1.5, f64::NAN, -2.0], [1e300, 0.0, 1.0 / 3.0]];
    let bytes: Vec<u8> = values
        .as_flattened()
        .iter()
        .flat_map(|v| v.to_le_bytes())
        .collect();
    for (word, root) in [
        (4, "header_type='UInt32'"),
        (8, "header_type='UInt64'"),
        (4, ""),
    ] {
        for (zlib, compressor) in [(false, ""), (true, " compressor='vtkZLibDataCompressor'")] {
            let root = format!("{root}{compressor}");
            let (header, body) = packed(&bytes, word, zlib);
            let whole = [header.clone(), body.clone()].concat();
            let apart = format!("{}{}", encode(&header), encode(&body));
            let array = |format: &str, text: &str| {
                format!(
                    "<DataArray type='Float64' Name='V' NumberOfComponents='3' {format}>{text}</DataArray>"
                )
            };
            let inline = |text: &str| file(&root, &array("format='binary'", text), "").into_bytes();
            let appended = |encoding: &str, data: &[u8]| {
                let array = array("format='appended' offset='4'", "");
                let frame =
                    format!("<AppendedData encoding='{encoding}'>\n _AAAA@\n</AppendedData>");
                let text = file(&root, &array, &frame);
                let (before, after) = text.split_once('@').unwrap();
                [before.as_bytes(), data, after.as_bytes()].concat()
            };
            for file in [
                inline(&apart),
                inline(&format!("\n  {}\n", encode(&whole))),
                appended("base64", apart.as_bytes()),
                appended("base64", encode(&whole).as_bytes()),
                appended("raw", &whole),
            ] {
                let found = parse(&file).unwrap();
                assert_eq!(found.points, [[0.0; 3], [1.0, 2.0, 3.0]]);
                let array = &found.arrays["V"];
                assert_eq!(bits(&array.values), bits(values.as_flattened()));
                assert_eq!(array.components, 3);
            }
        }
    }
}

#[test]
fn every_type_of_number_is_read() {
    fn array<const N: usize>(kind: &str, values: [[u8; N]; 2]) -> String {
        let (header, body) = packed(values.as_flattened(), 4, false);
        let text = encode(&[header, body].concat());
        format!("<DataArray type='{kind}' Name='{kind}' format='binary'>{text}</DataArray>")
    }
    let arrays = [
        array("Float32", [0.1_f32.to_le_bytes(), f32::NAN.to_le_bytes()]),
        array("Float64", [0.1_f64.to_le_bytes(), f64::MAX.to_le_bytes()]),
        array("Int8", [(-2_i8).to_le_bytes(), i8::MAX.to_le_bytes()]),
        array("Int16", [(-2_i16).to_le_bytes(), i16::MAX.to_le_bytes()]),
        array("Int32", [(-2_i32).to_le_bytes(), i32::MAX.to_le_bytes()]),
        array("Int64", [(-2_i64).to_le_bytes(), i64::MAX.to_le_bytes()]),
        array("UInt8", [2_u8.to_le_bytes(), u8::MAX.to_le_bytes()]),
        array("UInt16", [2_u16.to_le_bytes(), u16::MAX.to_le_bytes()]),
        array("UInt32", [2_u32.to_le_bytes(), u32::MAX.to_le_bytes()]),
        array("UInt64", [2_u64.to_le_bytes(), u64::MAX.to_le_bytes()]),
    ];
    let found = parse(file("", &arrays.concat(), "").as_bytes()).unwrap();
    let two = |kind: &str| {
        let values = &found.arrays[kind].values;
        assert_eq!(values.len(), 2, "{kind}");
        (values[0], values[1])
    };
    let small = two("Float32");
    assert_eq!(small.0, f64::from(0.1_f32));
    assert!(small.1.is_nan());
    assert_eq!(two("Float64"), (0.1, f64::MAX));
    assert_eq!(two("Int8"), (-2.0, 127.0));
    assert_eq!(two("Int16"), (-2.0, 32767.0));
    assert_eq!(two("Int32"), (-2.0, 2147483647.0));
    // Rounded to 53 bits.
    assert_eq!(two("Int64"), (-2.0, 9223372036854775808.0));
    assert_eq!(two("UInt8"), (2.0, 255.0));
    assert_eq!(two("UInt16"), (2.0, 65535.0));
    assert_eq!(two("UInt32"), (2.0, 4294967295.0));
    assert_eq!(two("UInt64"), (2.0, 18446744073709551616.0));
}

#[test]
fn pieces_are_joined() {
    let piece = |points: usize, numbers: &str, name: &str| {
        format!(
            "<Piece NumberOfPoints='{points}'>\
             <Points><DataArray type='Float64' NumberOfComponents='3'>{numbers}</DataArray></Points>\
             <PointData><DataArray type='Float64' Name='{name}' NumberOfComponents='3'>{numbers}</DataArray></PointData>\
             </Piece>"
        )
    };
    let grid = |pieces: &[String]| {
        let pieces = pieces.concat();
        format!(
            "<VTKFile type='UnstructuredGrid'><UnstructuredGrid>{pieces}</UnstructuredGrid></VTKFile>"
        )
    };
    let (one, two) = (piece(1, "1 2 3", "V"), piece(2, "4 5 6 7 8 9", "V"));
    let none = "<Piece NumberOfPoints='0'><Points></Points><PointData/></Piece>".to_string();
    let text = grid(&[none.clone(), one.clone(), none, two]);
    let found = parse(text.as_bytes()).unwrap();
    let expected = [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0], [7.0, 8.0, 9.0]];
    assert_eq!(found.points, expected);
    assert_eq!(found.arrays["V"].values, expected.as_flattened());

    let other = piece(1, "1 2 3", "W");
    let scalar = one.replace("Name='V' NumberOfComponents='3'>1 2 3", "Name='V'>1");
    let more = one.replace(
        "<PointData>",
        "<PointData><DataArray type='Int8' Name='W'>1</DataArray>",
    );
    for (second, message) in [
        (other, "array `V` is not the same in all pieces"),
        (scalar, "array `V` is not the same in all pieces"),
        (more, "array `W` is not in all pieces"),
    ] {
        let text = grid(&[one.clone(), second]);
        assert_eq!(parse(text.as_bytes()).unwrap_err(), message);
    }
}

#[test]
fn a_file_that_is_cut_anywhere_is_refused() {
    let (mesh, fields) = model(500, ElementKind::Quad4);
    let path = temporary("cut.vtu");
    write(&path, &mesh, &fields, None).unwrap();
    let whole = std::fs::read(&path).unwrap();
    let expected = all_bits(&read(&path).unwrap());
    let cuts: Vec<usize> = (0..whole.len()).step_by(97).collect();
    assert!(cuts.len() > 200, "only {} cuts", cuts.len());
    let mut refused = 0;
    for &cut in &cuts {
        let part = &whole[..cut];
        let error = parse(part).unwrap_err();
        let message = if cut == 0 { "no VTK file" } else { "truncated" };
        assert!(error.contains(message), "cut at {cut}: {error}");
        // With its end put back, the loss has to be found where the data are missing, unless only cells have lost some.
        let mended = [part, b"\n</AppendedData>\n</VTKFile>\n"].concat();
        match parse(&mended) {
            Err(_) => refused += 1,
            Ok(found) => assert_eq!(all_bits(&found), expected, "cut at {cut}"),
        }
    }
    assert!(refused * 10 > cuts.len() * 9, "only {refused} refused");

    // The message names the file.
    std::fs::write(&path, &whole[..whole.len() / 2]).unwrap();
    let error = read(&path).unwrap_err().to_string();
    std::fs::remove_file(&path).unwrap();
    let message = format!(
        "the file is truncated: it ends at byte {} without </VTKFile>",
        whole.len() / 2
    );
    assert_eq!(error, format!("{}: {message}", path.display()));
    let error = read(&path).unwrap_err().to_string();
    assert!(error.starts_with(path.to_str().unwrap()), "{error}");
}

#[test]
fn no_damage_makes_a_panic() {
    let (mesh, fields) = model(20, ElementKind::Quad4);
    let path = temporary("damage.vtu");
    write(&path, &mesh, &fields, None).unwrap();
    let whole = std::fs::read(&path).unwrap();
    std::fs::remove_file(&path).unwrap();
    for at in 0..whole.len() {
        for damage in [0, b'<', b'9', whole[at] ^ 1, 255] {
            let mut file = whole.clone();
            file[at] = damage;
            // Some of it is in names or in what is passed over.
            let _ = parse(&file);
        }
    }
}

#[test]
fn what_cannot_be_read_is_said() {
    let array = |attributes: &str, text: &str| {
        file(
            "",
            &format!("<DataArray Name='V' {attributes}>{text}</DataArray>"),
            "",
        )
    };
    let root = |root: &str| file(root, "", "");
    let zlib = "compressor='vtkLZMADataCompressor'";
    let packed = "<DataArray type='Int8' Name='V' format='binary'>AAAA</DataArray>";
    let appended = "<DataArray type='Int8' Name='V' format='appended' offset='9'/>";
    let data = |encoding: &str, data: &str| {
        let data = format!("<AppendedData encoding='{encoding}'>{data}</AppendedData>");
        file("", appended, &data)
    };
    let points = |points: &str| {
        format!(
            "<VTKFile type='UnstructuredGrid'><UnstructuredGrid>\n{points}</UnstructuredGrid></VTKFile>"
        )
    };
    for (text, message) in [
        ("", "this is no VTK file: it does not begin with <VTKFile>"),
        ("# vtk DataFile Version 3.0\n", "this is no VTK file"),
        ("<html></html>", "this is no VTK file"),
        (
            "<VTKFile type='PolyData'></VTKFile>",
            "line 1: the file holds a PolyData; only an UnstructuredGrid is read",
        ),
        (
            "<VTKFile></VTKFile>",
            "the file holds a data set without a type",
        ),
        (
            &root("byte_order='BigEndian'"),
            "line 1: the byte order is BigEndian; only LittleEndian is read",
        ),
        (
            &root("header_type='UInt16'"),
            "headers of type UInt16 are not read",
        ),
        (
            &file(zlib, packed, ""),
            "array `V`: compression by vtkLZMADataCompressor is not read: write the file with zlib",
        ),
        (
            &array("type='String'", "65 0 66 0"),
            "line 1: array `V`: values of type `String` are not read, only numbers",
        ),
        (&array("", "1 2"), "array `V`: its type is missing"),
        (
            &array("type='Int8'", "1 200"),
            "array `V`: `200` is no Int8",
        ),
        (
            &array("type='Int32'", "1 2.5"),
            "array `V`: `2.5` is no Int32",
        ),
        (
            &array("type='UInt8'", "1 -2"),
            "array `V`: `-2` is no UInt8",
        ),
        (
            &array("type='Float64'", "1 x"),
            "array `V`: `x` is no Float64",
        ),
        (
            &array("type='Float64'", "1 2 3"),
            "array `V`: it has 3 values where the grid needs 2",
        ),
        (
            &array("type='Float64'", ""),
            "it has 0 values where the grid needs 2",
        ),
        (
            &array("type='Int8' format='hex'", "1 2"),
            "array `V`: its format is `hex`, which VTK does not have",
        ),
        (
            &array("type='Int8' NumberOfComponents='-1'", "1 2"),
            "array `V`: NumberOfComponents is `-1`, which is no count",
        ),
        (
            &array(
                "type='Int8' NumberOfComponents='10000000000000000000'",
                "1 2",
            ),
            "array `V`: it has more values than any file can hold",
        ),
        (
            &array(
                "type='Int8' NumberOfComponents='1000000000000000000'",
                "1 2",
            ),
            "array `V`: it has 2 values where the grid needs 2000000000000000000",
        ),
        // Three bytes after a header that says three.
        (
            &array("type='Int8' format='binary'", "AwAAAAECAw=="),
            "array `V`: it has 3 bytes where the grid needs 2",
        ),
        (
            &array("type='Int8' format='binary'", "AgAAAAE="),
            "array `V`: the file ends within it",
        ),
        (
            &array("type='Int8' format='binary'", "AgAA*AEC"),
            "array `V`: `*` is out of place in base64",
        ),
        (
            &array("type='Int8' format='appended'", ""),
            "array `V`: offset is missing",
        ),
        (
            &file("", appended, ""),
            "array `V`: the file has no appended data",
        ),
        (
            &data("raw", "_12345678"),
            "array `V`: its offset is beyond the end of the file",
        ),
        (
            &data("raw", "_1234567890123"),
            "array `V`: it has 858927408 bytes",
        ),
        (
            &data("raw", "1234567890"),
            "the appended data do not begin with `_`",
        ),
        (
            &data("hex", "_1234"),
            "appended data in the encoding hex are not read",
        ),
        (
            &file(
                "",
                &packed
                    .replace("binary", "ascii")
                    .replace("AAAA", "1 2")
                    .repeat(2),
                "",
            ),
            "a second array `V`",
        ),
        (&points("<Piece/>"), "line 2: NumberOfPoints is missing"),
        (
            &points("<Piece NumberOfPoints='1'/>"),
            "the piece has no array of points",
        ),
        (
            &points(
                "<Piece NumberOfPoints='1'><Points><DataArray type='Int8' NumberOfComponents='2'>1 2\
                 </DataArray></Points></Piece>",
            ),
            "the points have 2 components, not 3",
        ),
        (
            "<VTKFile type='UnstructuredGrid'>\n<a></VTKFile>",
            "line 2: </VTKFile> where <a> is open",
        ),
    ] {
        let error = parse(text.as_bytes()).unwrap_err();
        assert!(error.contains(message), "{error}\nfor {text}");
    }
}

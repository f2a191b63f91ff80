use std::collections::BTreeSet;
use std::path::Path;

use crate::error::{Error, IoError};
use crate::io::sets::{memberships, own_point_sets};
use crate::io::write_atomically;
use crate::mesh::{Mesh, check};
use crate::shape::ElementKind;
use crate::system::{Fields, Location};

use super::kinds::{vtk_order, vtk_type};

/// Bytes compressed at a time.
const BLOCK_BYTES: usize = 1 << 18;

/// Writes a mesh at its reference coordinates with the fields on it.
///
/// Point data are `NODE_ID` (the user's numbers) and the point fields; cell data are `ELEMENT_ID`, `BODY` if `bodies` gives
/// a number for every cell (blocks in order), and the cell fields. Six components are named `XX YY ZZ XY YZ XZ`.
///
/// # Errors
/// [`Error::Io`] if the file cannot be written or the length of a field does not fit the mesh.
pub fn write(
    path: &Path,
    mesh: &Mesh,
    fields: &Fields,
    bodies: Option<&[usize]>,
) -> Result<(), Error> {
    PackedMesh::new(mesh, bodies).write(path, fields)
}

/// Writes the points of a mesh as vertices, with the fields on them; cells are left out.
///
/// # Errors
/// As [`write()`].
pub fn write_vertices(path: &Path, mesh: &Mesh, fields: &Fields) -> Result<(), Error> {
    PackedMesh::vertices(mesh).write(path, fields)
}

/// What all files of one mesh share: its points, its cells and their numbers, packed once.
pub struct PackedMesh {
    points: usize,
    cells: usize,
    /// Node numbers.
    nodes: Array,
    /// Element numbers and bodies.
    elements: Vec<Array>,
    places: Array,
    topology: Vec<Array>,
}

impl PackedMesh {
    /// The cells of a mesh. `bodies` gives a number for every cell, blocks in order.
    pub fn new(mesh: &Mesh, bodies: Option<&[usize]>) -> PackedMesh {
        let ids = mesh.blocks.iter().flat_map(|block| &block.cell_ids);
        let mut elements = vec![Array::integers("ELEMENT_ID", ids.map(|&id| id as i64))];
        if let Some(bodies) = bodies {
            let bodies = bodies.iter().map(|&body| body as i64);
            elements.push(Array::integers("BODY", bodies));
        }
        PackedMesh {
            cells: mesh.blocks.iter().map(|block| block.cell_ids.len()).sum(),
            elements,
            topology: Array::cells(mesh, &[]),
            ..PackedMesh::vertices(mesh)
        }
    }

    /// The points of a mesh as vertices.
    pub fn vertices(mesh: &Mesh) -> PackedMesh {
        let points = mesh.points.len();
        let last = points as i64;
        PackedMesh {
            points,
            cells: points,
            nodes: Array::integers("NODE_ID", mesh.point_ids.iter().map(|&id| id as i64)),
            elements: Vec::new(),
            places: Array::floats("Points", 3, mesh.points.as_flattened()),
            topology: vec![
                Array::integers("connectivity", 0..last),
                Array::integers("offsets", 1..=last),
                Array::new("UInt8", "types", 1, &vec![1; points]),
            ],
        }
    }

    /// Writes the file with these fields.
    ///
    /// # Errors
    /// As [`write()`].
    pub fn write(&self, path: &Path, fields: &Fields) -> Result<(), Error> {
        let fits = |name: &str, found: usize, wanted: usize| {
            if found == wanted {
                return Ok(());
            }
            Err(Error::Io(IoError {
                file: path.to_path_buf(),
                message: format!("{name} has {found} values where the mesh has {wanted}"),
            }))
        };
        fits("the list of node numbers", self.nodes.values, self.points)?;
        if let Some(bodies) = self.elements.get(1) {
            fits("the list of bodies", bodies.values, self.cells)?;
        }
        let mut file = Writer::default();
        file.begin(self.points, self.cells);
        let nodes = std::slice::from_ref(&self.nodes);
        for (location, element, count, own) in [
            (Location::Point, "PointData", self.points, nodes),
            (Location::Cell, "CellData", self.cells, &self.elements),
        ] {
            file.text += &format!("<{element}>\n");
            own.iter().for_each(|array| file.add(array));
            for field in fields.all.iter().filter(|f| f.location == location) {
                let wanted = count * field.components;
                fits(&format!("field {}", field.name), field.values.len(), wanted)?;
                file.floats(&field.name, field.components, &field.values);
            }
            file.text += &format!("</{element}>\n");
        }
        file.text += "<Points>\n";
        file.add(&self.places);
        file.text += "</Points>\n<Cells>\n";
        self.topology.iter().for_each(|array| file.add(array));
        write_atomically(path, &file.end())
    }
}

/// Numbers that are no sets.
const RESERVED: [&str; 2] = ["NODE_ID", "ELEMENT_ID"];

/// Writes a mesh with its sets, as [`read_mesh`](super::read_mesh) reads it, and returns notes about what was changed.
///
/// Point sets are arrays of zeros and ones. So are cell sets and facet sets; the facets are cells of their own, behind those of
/// the mesh. A point set that has the name and the points of a facet or cell set is left out, as readers derive it.
///
/// # Errors
/// [`Error::Mesh`] if the structure of the mesh is wrong (see [`check_structure`](crate::mesh::check::check_structure)), [`Error::Io`] if the file cannot be
/// written.
pub fn write_mesh(path: &Path, mesh: &Mesh) -> Result<Vec<String>, Error> {
    check::check_structure(mesh)?;
    let mut notes = Vec::new();
    let mut named = |name: &str| {
        if !RESERVED.contains(&name) {
            return name.to_string();
        }
        notes.push(format!("the set {name} is written as {name}_SET"));
        format!("{name}_SET")
    };
    let facets = memberships(mesh.facet_sets.iter());
    let shapes: Vec<_> = facets
        .keys()
        .map(|&facet| mesh.facet_points(facet))
        .collect();
    let ids = || mesh.blocks.iter().flat_map(|block| &block.cell_ids);
    let next = ids().max().map_or(1, |&last| last.saturating_add(1));
    let cells: Vec<_> = mesh.cells().collect();

    let mut file = Writer::default();
    file.begin(mesh.points.len(), cells.len() + shapes.len());
    file.text += "<PointData>\n";
    file.integers("NODE_ID", mesh.point_ids.iter().map(|&id| id as i64));
    for (name, points) in own_point_sets(mesh) {
        let mut ones = vec![0; mesh.points.len()];
        points.iter().for_each(|&p| ones[p] = 1);
        file.add(&Array::new("UInt8", &named(name), 1, &ones));
    }
    file.text += "</PointData>\n<CellData>\n";
    let behind = (next..).take(shapes.len());
    file.integers(
        "ELEMENT_ID",
        ids().copied().chain(behind).map(|id| id as i64),
    );
    let names: BTreeSet<&String> = mesh
        .cell_sets
        .keys()
        .chain(mesh.facet_sets.keys())
        .collect();
    for name in names {
        let members: BTreeSet<_> = mesh.cell_sets.get(name).into_iter().flatten().collect();
        let of_cells = cells.iter().map(|cell| u8::from(members.contains(cell)));
        let of_facets = facets
            .values()
            .map(|names| u8::from(names.contains(&name.as_str())));
        let ones: Vec<u8> = of_cells.chain(of_facets).collect();
        file.add(&Array::new("UInt8", &named(name), 1, &ones));
    }
    file.text += "</CellData>\n<Points>\n";
    file.floats("Points", 3, mesh.points.as_flattened());
    file.text += "</Points>\n<Cells>\n";
    (Array::cells(mesh, &shapes).iter()).for_each(|array| file.add(array));
    write_atomically(path, &file.end())?;
    Ok(notes)
}

/// The header of the file and the data that follow it.
#[derive(Default)]
pub(super) struct Writer {
    pub text: String,
    appended: Vec<u8>,
}

impl Writer {
    fn begin(&mut self, points: usize, cells: usize) {
        self.head("UnstructuredGrid");
        self.text += &format!("<Piece NumberOfPoints=\"{points}\" NumberOfCells=\"{cells}\">\n");
    }

    /// The head of a surface with so many vertices, lines and faces.
    pub fn begin_surface(&mut self, points: usize, [verts, lines, polys]: [usize; 3]) {
        self.head("PolyData");
        self.text += &format!(
            "<Piece NumberOfPoints=\"{points}\" NumberOfVerts=\"{verts}\" NumberOfLines=\"{lines}\" NumberOfStrips=\"0\" NumberOfPolys=\"{polys}\">\n"
        );
    }

    /// The whole file, after the cells.
    fn end(mut self) -> Vec<u8> {
        self.text += "</Cells>\n";
        self.close("UnstructuredGrid")
    }

    /// The whole file of a surface.
    pub fn end_surface(self) -> Vec<u8> {
        self.close("PolyData")
    }

    fn head(&mut self, kind: &str) {
        self.text += &format!(
            "<?xml version=\"1.0\"?>\n\
             <VTKFile type=\"{kind}\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\" \
             compressor=\"vtkZLibDataCompressor\">\n<{kind}>\n"
        );
    }

    fn close(mut self, kind: &str) -> Vec<u8> {
        self.text += &format!("</Piece>\n</{kind}>\n<AppendedData encoding=\"raw\">\n_");
        let mut bytes = self.text.into_bytes();
        bytes.append(&mut self.appended);
        bytes.extend(b"\n</AppendedData>\n</VTKFile>\n");
        bytes
    }

    fn floats(&mut self, name: &str, components: usize, values: &[f64]) {
        self.add(&Array::floats(name, components, values));
    }

    fn integers(&mut self, name: &str, values: impl Iterator<Item = i64>) {
        self.add(&Array::integers(name, values));
    }

    pub fn add(&mut self, array: &Array) {
        self.text += &format!(
            "<DataArray {} format=\"appended\" offset=\"{}\"/>\n",
            array.attributes,
            self.appended.len()
        );
        self.appended.extend_from_slice(&array.packed);
    }
}

/// An array as it stands in a file.
pub(super) struct Array {
    /// Type, name and components.
    attributes: String,
    /// How many values it has.
    values: usize,
    packed: Vec<u8>,
}

impl Array {
    fn new(kind: &str, name: &str, components: usize, bytes: &[u8]) -> Array {
        // One is what readers assume; some make a matrix of a column where it is written.
        let mut names = match components {
            1 => String::new(),
            n => format!(" NumberOfComponents=\"{n}\""),
        };
        if components == 6 {
            for (i, component) in ["XX", "YY", "ZZ", "XY", "YZ", "XZ"].iter().enumerate() {
                names += &format!(" ComponentName{i}=\"{component}\"");
            }
        }
        let size = if kind == "UInt8" { 1 } else { 8 };
        let mut packed = Vec::new();
        compress(bytes, &mut packed);
        Array {
            attributes: format!("type=\"{kind}\" Name=\"{}\"{names}", escape(name)),
            values: bytes.len() / size,
            packed,
        }
    }

    pub fn floats(name: &str, components: usize, values: &[f64]) -> Array {
        let bytes: Vec<[u8; 8]> = values.iter().map(|v| v.to_le_bytes()).collect();
        Array::new("Float64", name, components, bytes.as_flattened())
    }

    pub fn integers(name: &str, values: impl Iterator<Item = i64>) -> Array {
        let bytes: Vec<[u8; 8]> = values.map(i64::to_le_bytes).collect();
        Array::new("Int64", name, 1, bytes.as_flattened())
    }

    /// The cells of the blocks, and more cells, of kinds whose order VTK shares, behind them.
    fn cells(mesh: &Mesh, more: &[(ElementKind, Vec<usize>)]) -> Vec<Array> {
        let mut connectivity = Vec::new();
        for block in &mesh.blocks {
            let cells = block.connectivity.chunks_exact(block.kind.node_count());
            match vtk_order(block.kind) {
                [] => connectivity.extend(cells.flatten().map(|&point| point as i64)),
                order => connectivity
                    .extend(cells.flat_map(|cell| order.iter().map(|&i| cell[i] as i64))),
            }
        }
        let more_nodes = more.iter().flat_map(|(_, nodes)| nodes);
        connectivity.extend(more_nodes.map(|&point| point as i64));
        let mut end = 0;
        let mut offsets = Vec::new();
        let mut types = Vec::new();
        let kinds = mesh.blocks.iter();
        let kinds = kinds.flat_map(|block| block.cell_ids.iter().map(|_| block.kind));
        for kind in kinds.chain(more.iter().map(|(kind, _)| *kind)) {
            end += kind.node_count() as i64;
            offsets.push(end);
            types.push(vtk_type(kind));
        }
        vec![
            Array::integers("connectivity", connectivity.into_iter()),
            Array::integers("offsets", offsets.into_iter()),
            Array::new("UInt8", "types", 1, &types),
        ]
    }
}

/// What is tried to find out: so many pieces of so many bytes, all over the block.
const TRIED_PIECES: usize = 4;
const PIECE: usize = 1 << 12;

/// Appends the blocks of an array behind their header: number of blocks, size of a block and of an incomplete last one
/// (zero if there is none), compressed sizes.
fn compress(bytes: &[u8], out: &mut Vec<u8>) {
    let packed = |block: &[u8]| match is_noise(block) {
        true => deflate(block, flate2::Compression::none()),
        false => deflate(block, flate2::Compression::fast()),
    };
    let blocks: Vec<Vec<u8>> = bytes.chunks(BLOCK_BYTES).map(packed).collect();
    let mut header = vec![blocks.len(), BLOCK_BYTES, bytes.len() % BLOCK_BYTES];
    header.extend(blocks.iter().map(Vec::len));
    out.extend(header.iter().flat_map(|&n| (n as u64).to_le_bytes()));
    out.extend(blocks.iter().flatten());
}

/// Whether compression would save next to nothing.
fn is_noise(block: &[u8]) -> bool {
    if block.len() < 2 * TRIED_PIECES * PIECE {
        return false;
    }
    let step = block.len() / TRIED_PIECES;
    let pieces: Vec<&[u8]> = (0..TRIED_PIECES)
        .map(|k| &block[k * step..k * step + PIECE])
        .collect();
    let left = deflate(&pieces.concat(), flate2::Compression::fast()).len();
    // Compression is worth its time if it saves a quarter of a block: fields are of digits that look like noise, indices and what is zero
    // are not.
    left as f64 > (1.0 - 0.25) * (TRIED_PIECES * PIECE) as f64
}

fn deflate(bytes: &[u8], level: flate2::Compression) -> Vec<u8> {
    let mut encoder = flate2::bufread::ZlibEncoder::new(bytes, level);
    let mut packed = Vec::with_capacity(bytes.len() + bytes.len() / 64);
    std::io::Read::read_to_end(&mut encoder, &mut packed)
        .expect("reading from memory does not fail");
    packed
}

/// A text as the value of an XML attribute.
pub(in crate::io) fn escape(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
        .replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Block;
    use crate::system::Field;
    use std::io::Read;

    /// Many points, so that arrays take several blocks, and one cell of two kinds.
    fn mesh() -> Mesh {
        let points: Vec<_> = (0..20_000)
            .map(|i| {
                let t = i as f64;
                [t.sin(), 1.0 / (t + 0.1), -t]
            })
            .collect();
        let block = |kind: ElementKind, id| Block {
            kind,
            connectivity: (0..kind.node_count()).rev().collect(),
            cell_ids: vec![id],
        };
        Mesh {
            dim: 3,
            point_ids: (0..20_000).map(|i| 3 * i + 5).collect(),
            points,
            blocks: vec![block(ElementKind::Tet10, 70), block(ElementKind::Hex20, 7)],
            ..Mesh::default()
        }
    }

    fn fields() -> Fields {
        let field = |name: &str, location, components, count: usize| Field {
            name: name.to_string(),
            location,
            components,
            values: (0..count * components)
                .map(|i| (i as f64).cos() / 3.0)
                .collect(),
        };
        let mut all = vec![
            field("U", Location::Point, 3, 20_000),
            field("S", Location::Cell, 6, 2),
            field("a<\"b\"&c", Location::Point, 1, 20_000),
        ];
        all[0].values[4] = f64::NAN;
        Fields { all }
    }

    /// The bytes of the array of this name, decoded as VTK does.
    fn array(file: &[u8], name: &str) -> (String, Vec<u8>) {
        let marker = b"<AppendedData encoding=\"raw\">\n_";
        let start = file
            .windows(marker.len())
            .position(|w| w == marker)
            .unwrap();
        let text = std::str::from_utf8(&file[..start]).unwrap();
        let wanted = format!("Name=\"{name}\"");
        let line = text.lines().find(|l| l.contains(&wanted)).unwrap();
        let (_, offset) = line.split_once("offset=\"").unwrap();
        let offset: usize = offset.split_once('"').unwrap().0.parse().unwrap();
        let mut at = start + marker.len() + offset;
        let mut word = || {
            let value = u64::from_le_bytes(*file[at..].first_chunk().unwrap()) as usize;
            at += 8;
            value
        };
        let (blocks, size, last) = (word(), word(), word());
        let packed: Vec<usize> = (0..blocks).map(|_| word()).collect();
        let mut bytes = Vec::new();
        for (i, length) in packed.into_iter().enumerate() {
            let before = bytes.len();
            flate2::read::ZlibDecoder::new(&file[at..at + length])
                .read_to_end(&mut bytes)
                .unwrap();
            at += length;
            let full = i + 1 < blocks || last == 0;
            assert_eq!(bytes.len() - before, if full { size } else { last });
        }
        (line.to_string(), bytes)
    }

    fn floats(bytes: &[u8]) -> Vec<u64> {
        let words = bytes.chunks_exact(8);
        words
            .map(|w| u64::from_le_bytes(*w.first_chunk().unwrap()))
            .collect()
    }

    #[test]
    fn arrays_read_back_to_the_bit() {
        let path = std::env::temp_dir().join(format!("stickslip-{}.vtu", std::process::id()));
        let (mesh, fields) = (mesh(), fields());
        write(&path, &mesh, &fields, Some(&[1, 2])).unwrap();
        let file = std::fs::read(&path).unwrap();
        std::fs::remove_file(&path).unwrap();
        assert!(file.ends_with(b"\n</AppendedData>\n</VTKFile>\n"));
        for (name, values) in [
            ("U", fields.all[0].values.as_slice()),
            ("S", &fields.all[1].values),
            ("a&lt;&quot;b&quot;&amp;c", &fields.all[2].values),
            ("Points", mesh.points.as_flattened()),
        ] {
            let expected: Vec<u64> = values.iter().map(|v| v.to_bits()).collect();
            assert_eq!(floats(&array(&file, name).1), expected, "{name}");
        }
        assert_eq!(floats(&array(&file, "NODE_ID").1), mesh.point_ids);
        assert_eq!(floats(&array(&file, "ELEMENT_ID").1), [70, 7]);
        assert_eq!(floats(&array(&file, "BODY").1), [1, 2]);
        assert_eq!(floats(&array(&file, "offsets").1), [10, 30]);
        assert_eq!(array(&file, "types").1, [24, 25]);
        let connectivity: Vec<u64> = (0..10).rev().chain((0..20).rev()).collect();
        assert_eq!(floats(&array(&file, "connectivity").1), connectivity);
        assert!(array(&file, "S").0.contains("ComponentName3=\"XY\""));
    }

    #[test]
    fn a_field_that_does_not_fit_is_refused() {
        let path = std::env::temp_dir().join("stickslip-never-written.vtu");
        let (mesh, mut fields) = (mesh(), fields());
        assert!(write(&path, &mesh, &fields, Some(&[1])).is_err());
        fields.all[1].values.pop();
        let error = write(&path, &mesh, &fields, None).unwrap_err();
        assert!(error.to_string().contains("field S has 11"), "{error}");
        assert!(!path.exists());
    }

    #[test]
    fn points_are_written_as_vertices() {
        let path = std::env::temp_dir().join(format!("stickslip-v-{}.vtu", std::process::id()));
        let (mut mesh, mut fields) = (mesh(), fields());
        mesh.points.truncate(3);
        mesh.point_ids.truncate(3);
        fields.all.truncate(1);
        fields.all[0].values.truncate(9);
        write_vertices(&path, &mesh, &fields).unwrap();
        let file = std::fs::read(&path).unwrap();
        std::fs::remove_file(&path).unwrap();
        assert_eq!(array(&file, "types").1, [1, 1, 1]);
        assert_eq!(floats(&array(&file, "offsets").1), [1, 2, 3]);
        assert_eq!(floats(&array(&file, "connectivity").1), [0, 1, 2]);
        assert_eq!(floats(&array(&file, "NODE_ID").1), mesh.point_ids);
    }

    #[test]
    fn an_empty_mesh_is_written() {
        let path = std::env::temp_dir().join(format!("stickslip-e-{}.vtu", std::process::id()));
        write(&path, &Mesh::default(), &Fields::default(), None).unwrap();
        let file = std::fs::read(&path).unwrap();
        std::fs::remove_file(&path).unwrap();
        assert!(array(&file, "connectivity").1.is_empty());
    }
}

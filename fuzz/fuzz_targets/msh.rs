//! Gmsh meshes: any bytes give a mesh or an error with help, and a mesh with a sound structure is written and read back.
#![no_main]

use std::path::Path;

use libfuzzer_sys::fuzz_target;
use stickslip::io::gmsh;
use stickslip::mesh::check;

fuzz_target!(|bytes: &[u8]| {
    let path = Path::new("fuzz.msh");
    match gmsh::parse(bytes, path) {
        Err(error) => assert!(!error.message.is_empty() && error.file.is_some()),
        Ok(mesh) => {
            check::check_structure(&mesh)
                .expect("what is read has a sound structure");
            let _ = check::check(&mesh);
            let (text, notes) = gmsh::text(&mesh).expect("and can be written");
            if notes.is_empty() {
                let again = gmsh::parse(text.as_bytes(), path).expect("and read back");
                assert_eq!(again.points, mesh.points);
                assert_eq!(again.cell_count(), mesh.cell_count());
            }
            let _ = stickslip::io::abaqus::text(&mesh, stickslip::io::abaqus::Space::PlaneStrain);
        }
    }
});

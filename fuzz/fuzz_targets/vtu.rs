//! VTU files, as meshes and as fields on points: any bytes give one or an error.
#![no_main]

use std::path::Path;

use libfuzzer_sys::fuzz_target;
use stickslip::io::vtu;
use stickslip::mesh::check;

fuzz_target!(|bytes: &[u8]| {
    let path = Path::new("fuzz.vtu");
    let _ = vtu::parse(bytes, path);
    match vtu::parse_mesh(bytes, path) {
        Err(error) => assert!(!error.message.is_empty() && error.help.is_some()),
        Ok(mesh) => {
            check::check_structure(&mesh)
                .expect("what is read has a sound structure");
            let _ = check::check(&mesh);
            stickslip::io::gmsh::text(&mesh).expect("and can be written");
        }
    }
});

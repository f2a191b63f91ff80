//! The places of the last findings as a point cloud for ParaView.

use std::path::Path;

use super::finding::{DoctorCause, Finding};
use super::suspect::{LocationKind, Severity};
use crate::error::Error;
use crate::io::vtu;
use crate::mesh::Mesh;
use crate::system::{Field, Fields, Location};

/// Findings whose places are written when nothing is worse than a warning.
const MOST_SHOWN: usize = 200;

/// Writes the places of findings as vertices: those of the failure that ended the run, or of all findings of a run that went well.
///
/// Point data: `NODE_ID` (0 where the place is no node), `CAUSE` ([`DoctorCause::code`]), `SEVERITY` (0 note, 1 warning, 2 error), `WHAT` (0 node,
/// 1 facet, 2 cell, 3 body, 4 interface, 5 key), `FINDING` and `RANK`, the positions from 0 in the `findings` of `summary.json` and in their
/// `suspects` lists, where the remark stands, and `TIME`.
///
/// # Errors
/// [`Error::Io`].
pub(crate) fn write(path: &Path, findings: &[Finding]) -> Result<(), Error> {
    let fatal = findings.iter().any(|f| f.severity == Severity::Error);
    let shown = findings.iter().enumerate().filter(|(_, f)| match fatal {
        true => f.severity == Severity::Error,
        false => true,
    });
    let mut mesh = Mesh {
        dim: 3,
        ..Mesh::default()
    };
    let mut rows: Vec<[f64; 6]> = Vec::new();
    for (i, finding) in shown.take(MOST_SHOWN) {
        for (rank, suspects) in finding.suspects.iter().enumerate() {
            let Some(x) = suspects.position else {
                continue;
            };
            mesh.points.push(x);
            let node = suspects.id.filter(|_| suspects.what == LocationKind::Node);
            mesh.point_ids.push(node.unwrap_or(0));
            rows.push([
                DoctorCause::code(finding.cause) as f64,
                finding.severity as u8 as f64,
                suspects.what as u8 as f64,
                i as f64,
                rank as f64,
                finding.time.unwrap_or(f64::NAN),
            ]);
        }
    }
    let names = ["CAUSE", "SEVERITY", "WHAT", "FINDING", "RANK", "TIME"];
    let fields = names.iter().enumerate().map(|(k, name)| Field {
        name: name.to_string(),
        location: Location::Point,
        components: 1,
        values: rows.iter().map(|row| row[k]).collect(),
    });
    let fields = Fields {
        all: fields.collect(),
    };
    vtu::write_vertices(path, &mesh, &fields)
}

//! Named sets in files that know only groups of elements.

use std::collections::BTreeMap;

use crate::mesh::Mesh;

/// The names of the sets that each member is in, sorted.
pub(super) fn memberships<'a, T: Ord + Copy + 'a>(
    sets: impl Iterator<Item = (&'a String, &'a Vec<T>)>,
) -> BTreeMap<T, Vec<&'a str>> {
    let mut out: BTreeMap<T, Vec<&str>> = BTreeMap::new();
    for (name, members) in sets {
        for &member in members {
            let names = out.entry(member).or_default();
            if names.last() != Some(&name.as_str()) {
                names.push(name);
            }
        }
    }
    out
}

/// The point sets that readers would not make of the facet or cell sets of the same name, or, where there are both, of the
/// facets.
pub(super) fn own_point_sets(mesh: &Mesh) -> impl Iterator<Item = (&String, &Vec<usize>)> {
    let derived = |name: &str, points: &[usize]| {
        let facets = mesh.facet_sets.get(name).filter(|f| !f.is_empty());
        let made = match (facets, mesh.cell_sets.get(name)) {
            (Some(facets), _) => mesh.points_of_facets(facets),
            (None, Some(cells)) => mesh.points_of_cells(cells),
            (None, None) => return false,
        };
        made == points
    };
    let sets = mesh.point_sets.iter();
    sets.filter(move |(name, points)| !derived(name, points))
}

//! Points whose two sides are both clamped.

use super::definition::InterfaceDefinition;
use crate::math::{Vec3, dot, scale};

/// Whether supports prescribe how all nodes of a point move along `normal`, and most of what lies opposite: then its gap is given, and a multiplier would act on the
/// little that is left. Where pressure follows from the gap it is known all the same. `sides`: nodes and their weights, positive on the secondary.
pub(super) fn clamped_pair(
    definition: &InterfaceDefinition,
    sides: &[(usize, f64)],
    normal: Vec3,
) -> bool {
    let size = dot(normal, normal).sqrt();
    if definition.clamped.is_empty() || size == 0.0 || !definition.laws.needs_normal_stiffness() {
        return false;
    }
    let normal = scale(1.0 / size, normal);
    let given = |node: usize| {
        let axes = definition.clamped[node];
        if definition.laws.tied {
            return axes[..definition.dofs.dim] == [true; 3][..definition.dofs.dim];
        }
        let free: Vec3 = std::array::from_fn(|c| if axes[c] { 0.0 } else { normal[c] });
        // A node that is not clamped has more than half of a motion along the normal left.
        axes.contains(&true) && dot(free, free).sqrt() <= 0.5
    };
    let (mut own, mut sums) = (true, [0.0; 2]);
    for &(node, w) in sides {
        match node >= definition.primary_nodes {
            true => own &= w == 0.0 || given(node),
            false => sums[usize::from(given(node))] += w.abs(),
        }
        if !own {
            return false;
        }
    }
    // Half of what lies opposite has to be free to move for a clamped point to press on it.
    sums[0] <= 0.5 * (sums[0] + sums[1])
}

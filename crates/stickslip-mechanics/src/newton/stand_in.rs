use crate::system::ContactBlock;

/// The dofs of a contact block and the symmetric matrix that stands in for it in a factor.
pub(super) type StandIn = (Vec<usize>, Vec<f64>);

/// What of contact goes into a factor.
pub(super) fn stand_ins(blocks: &[ContactBlock]) -> Vec<StandIn> {
    let of = |b: &ContactBlock| (b.dofs.clone(), b.surrogate.clone());
    blocks.iter().map(of).collect()
}

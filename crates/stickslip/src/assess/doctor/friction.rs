//! How strong the friction of an interface is.

use crate::contact::interface::InterfaceDefinition;
use crate::contact::law::friction::FrictionPoint;

/// The coefficient of friction of an interface at rest, under a pressure that strains the cells beneath by a thousandth; `None` where the limit
/// does not depend on pressure.
pub(super) fn friction_coefficient(interface: &InterfaceDefinition) -> Option<f64> {
    let law = interface.laws.friction_law();
    if !law.frictional() || law.needs_penetration() {
        return None;
    }
    let point = interface.points.first()?;
    let pressure = 1e-3 * point.stiffness * point.size;
    let limit = law.limit(&FrictionPoint::at_rest(law, pressure));
    (pressure > 0.0).then(|| limit.value / pressure)
}

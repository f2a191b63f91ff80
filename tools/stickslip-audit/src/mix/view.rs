//! How the text of a mix is written: in which units, mirrored or not, with which mesh. A relation is between the texts of two views.

/// One way to write a mix.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct View {
    /// The length that is 1 in a sheet.
    pub length: f64,
    /// The modulus that is 1 in a sheet.
    pub modulus: f64,
    /// The density that is 1 in a sheet.
    pub density: f64,
    /// Whether x changes its sign.
    pub mirrored: bool,
    /// By how many lengths everything is shifted: along x, and in space along the other axes as well.
    pub shift: f64,
    /// Whether secondary and primary of interfaces change their places.
    pub swapped: bool,
    /// Whether the upper body is meshed otherwise: so as to match the lower one, or not to match it any more.
    pub remeshed: bool,
    /// Whether the lower body is cut in two that are tied.
    pub cut: bool,
    /// Whether each quasi-static step is written as two.
    pub split: bool,
    /// Whether bodies, and with them their order, have other names.
    pub renamed: bool,
    /// Whether the bodies that turn with an axle are left as they are.
    pub unturned: bool,
    /// Whether contact is enforced by multipliers, whatever the mix says.
    pub exact: bool,
    /// The way to solve, instead of the one of the mix.
    pub method: Option<&'static str>,
}

impl View {
    /// The unit of time: how long a wave takes for a length.
    pub fn time(&self) -> f64 {
        self.length * (self.density / self.modulus).sqrt()
    }

    /// The unit of force, in the plane for a thickness of one length.
    pub fn force(&self) -> f64 {
        self.modulus * self.length * self.length
    }

    /// What a component along x is multiplied by.
    pub fn x(&self) -> f64 {
        if self.mirrored { -1.0 } else { 1.0 }
    }
}

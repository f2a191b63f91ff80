//! Built-in meshes, so that the common cases need no mesh file.
//!
//! All of them are made on an integer lattice that is mapped into space (`lattice.rs`): a grid for the rectangle and
//! the box, a core with layers around it for the round bodies (`round.rs`), columns that close round a hole for rings and gears (`annulus.rs`).

mod annulus;
mod ball;
mod cuboid;
mod disc;
mod gear;
mod generate;
mod grading;
mod lattice;
mod rectangle;
mod ring;
mod round;
mod round_options;

#[cfg(test)]
mod tests;

pub use ball::{Ball, HalfBall};
pub use cuboid::Cuboid;
pub use disc::{Disc, HalfDisc};
pub use gear::Gear;
pub use generate::Generate;
pub use grading::{Grading, Stretch};
pub use lattice::Diagonal;
pub use rectangle::Rectangle;
pub use ring::Ring;
pub use round_options::{Refinement, Sector};

crate::family! {
    /// The built-in meshes.
    Generator: "generate", dyn Generate {
        /// A rectangle with sides parallel to the axes.
        Rectangle(Rectangle) = "rectangle",
        /// A box with faces parallel to the axes.
        Box(Cuboid) = "box",
        /// A disc, or half of one cut along the line of contact.
        Disc(Disc) = "disc",
        /// A half-disc that touches with the middle of its arc.
        HalfDisc(HalfDisc) = "half-disc",
        /// A ball, or a half or quarter of one cut along the line of contact.
        Ball(Ball) = "ball",
        /// A half-ball that touches with its pole, or a half or quarter of one.
        HalfBall(HalfBall) = "half-ball",
        /// A ring, or a disc with a bore.
        Ring(Ring) = "ring",
        /// A spur gear with involute flanks.
        Gear(Gear) = "gear",
    }
}

use std::fmt;
use std::ops::Range;

use crate::linear::{Digest, Matrix};
use crate::math::Vec3;

/// A digest of all that decides what a factorisation or an analysis results in: what has the same one is the same, whatever it was made for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Identity([u64; 2]);

/// Changes whenever other results are made of the same input.
const GENERATION: u64 = 2;

/// A part of a matrix: some points, dofs of the matrix that are no unknowns, and points that are not eliminated.
#[derive(Debug, Clone, Copy)]
pub struct Part<'a> {
    /// The matrix.
    pub matrix: &'a dyn Matrix,
    /// First point of the part, and the one behind the last.
    pub points: (usize, usize),
    /// One mark a dof of the matrix.
    pub fixed: &'a [bool],
    /// One mark a point of the matrix.
    pub kept: &'a [bool],
}

impl Part<'_> {
    /// The points.
    pub fn points(&self) -> Range<usize> {
        self.points.0..self.points.1
    }

    /// Of its symbolic analysis: couplings, unknowns and kept points.
    pub fn analysis(&self) -> Identity {
        let mut digest = self.structure();
        // An analysis is of a matrix of this size.
        digest.word(self.matrix.points() as u64);
        Identity(digest.finish())
    }

    /// Of its substructure: that of the analysis, the values of the matrix, and what the artificial springs of floating bodies are made from.
    /// Other bodies have no part in it.
    pub fn substructure(&self, place: &dyn Fn(usize) -> Option<Vec3>, typical: f64) -> Identity {
        let mut digest = self.structure();
        if let Ok(matrix) = self.matrix.kept() {
            matrix.mix_values(self.points(), &mut digest);
        }
        let kept = self.points().filter(|&point| self.kept[point]);
        let mut places = Vec::new();
        for point in kept {
            match place(point) {
                Some(x) => places.extend(x),
                None => places.extend([f64::NAN, typical]),
            }
        }
        digest.floats(&places);
        Identity(digest.finish())
    }

    fn structure(&self) -> Digest {
        let (points, b) = (self.points(), self.matrix.block_size());
        let mut digest = Digest::of(GENERATION);
        for word in [b, points.start, points.end] {
            digest.word(word as u64);
        }
        match self.matrix.kept() {
            Ok(matrix) => matrix.mix_pattern(points.clone(), &mut digest),
            Err(made_of) => made_of.iter().for_each(|&word| digest.word(word)),
        }
        digest.marks(&self.fixed[points.start * b..points.end * b]);
        digest.marks(&self.kept[points.clone()]);
        // A part is coupled to dofs elsewhere only if they are no unknowns.
        let Ok(matrix) = self.matrix.kept() else {
            return digest;
        };
        for point in points.clone() {
            let others = matrix.neighbours(point);
            let ends = [others.first(), others.last()].into_iter().flatten();
            if ends.into_iter().all(|&p| points.contains(&(p as usize))) {
                continue;
            }
            for &other in others {
                let other = other as usize;
                if !points.contains(&other) {
                    digest.marks(&self.fixed[other * b..(other + 1) * b]);
                }
            }
        }
        digest
    }
}

impl Identity {
    /// Of what was mixed into a digest.
    pub fn of(digest: &Digest) -> Self {
        Identity(digest.finish())
    }

    /// The same as an engine makes it: factors of two have other last digits. Those of the built-in one, 0, are what they always were.
    pub fn made_by(self, engine: u64) -> Self {
        Identity([self.0[0] ^ engine, self.0[1] ^ engine.rotate_left(32)])
    }

    /// The digest itself.
    pub fn words(self) -> [u64; 2] {
        self.0
    }
}

impl fmt::Display for Identity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:016x}{:016x}", self.0[0], self.0[1])
    }
}

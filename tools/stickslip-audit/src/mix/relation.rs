//! Pairs of runs that must agree.

use std::collections::BTreeSet;

use super::view::View;

/// What is done a second time.
#[derive(Clone, Copy)]
pub enum Again {
    /// Another text of the same problem.
    Text(fn(&mut View)),
    /// The same text on two threads.
    Threads,
    /// The same text, gone on with from the middle.
    Resume,
}

/// How well the two have to agree.
#[derive(Clone, Copy, PartialEq)]
pub enum Agreement {
    /// In all bytes of the history.
    Bytes,
    /// But for the tolerance of the solver and rounding.
    Solver,
    /// But for the size of cells.
    Mesh,
}

/// A pair.
#[derive(Clone, Copy)]
pub struct Relation {
    /// Its name.
    pub name: &'static str,
    /// What is done.
    pub again: Again,
    /// What has to agree.
    pub agreement: Agreement,
    /// Features with which the relation does not hold; of words apart, all of them together.
    pub not_with: &'static [&'static str],
    /// Features of which it needs one, if any are named.
    pub needs: &'static [&'static str],
}

impl Relation {
    /// Whether it holds for a mix.
    pub fn fits(&self, features: &BTreeSet<&'static str>) -> bool {
        let all = |names: &str| names.split(' ').all(|name| features.contains(name));
        let any = |names: &[&str]| names.iter().any(|names| all(names));
        !any(self.not_with) && (self.needs.is_empty() || any(self.needs))
    }
}

const fn relation(
    name: &'static str,
    again: Again,
    agreement: Agreement,
    not_with: &'static [&'static str],
    needs: &'static [&'static str],
) -> Relation {
    Relation {
        name,
        again,
        agreement,
        not_with,
        needs,
    }
}

/// What a penalty leaves: run where the quality gate finds that it is too much, as no audit of the one result can tell.
pub const WITHOUT_PENALTY: Relation = relation(
    "without penalty",
    Again::Text(|v| v.exact = true),
    Agreement::Solver,
    &[],
    &["penalty"],
);

/// All of them.
pub const RELATIONS: &[Relation] = &[
    relation(
        "units",
        Again::Text(|v| {
            // mm, MPa and t/mm³ for m, Pa and kg/m³: seconds stay.
            v.length *= 1e3;
            v.modulus *= 1e-6;
            v.density *= 1e-12;
        }),
        Agreement::Solver,
        &[],
        &[],
    ),
    // Hexahedra alone are cut into tetrahedra the same way from either side.
    relation(
        "mirrored",
        Again::Text(|v| v.mirrored = true),
        Agreement::Solver,
        &["axisymmetric", "roughness"],
        &["plane-strain", "plane-stress", "linear", "quadratic"],
    ),
    relation(
        "shifted",
        Again::Text(|v| v.shift = 3.0),
        Agreement::Solver,
        &[],
        &[],
    ),
    relation(
        "renamed",
        Again::Text(|v| v.renamed = true),
        Agreement::Solver,
        &[],
        &[],
    ),
    relation(
        "sparse",
        Again::Text(|v| v.method = Some("sparse")),
        Agreement::Solver,
        &["sparse"],
        &[],
    ),
    relation(
        "condensed",
        Again::Text(|v| v.method = Some("condensed")),
        Agreement::Solver,
        &["condensed"],
        &[],
    ),
    relation(
        "two steps for one",
        Again::Text(|v| v.split = true),
        Agreement::Solver,
        &[
            "cycles",
            "jack",
            "bolt",
            "complex-modes",
            "let-go",
            "interference",
            "other-friction-later",
        ],
        &["press-and-slide", "press-and-release"],
    ),
    relation(
        "remeshed",
        Again::Text(|v| v.remeshed = true),
        Agreement::Mesh,
        &[
            // A load between the clamp of the upper body and the surface below, which ends before it or where it begins, is shared by distances of a few cells.
            "clamp overhang",
            "clamp wider",
            "clamp inside",
            "roughness",
            "bed-of-springs",
            "modes",
            "complex-modes",
            "implicit",
            "explicit",
            "implicit-explicit",
        ],
        &[],
    ),
    relation(
        "swapped",
        Again::Text(|v| v.swapped = true),
        Agreement::Mesh,
        &[
            "clamp overhang",
            "clamp wider",
            "roughness",
            "belt",
            "wears",
            "gap-taken-away",
            "floor",
            "rigid-upper",
            "rigid-lower",
            "modes",
            "complex-modes",
            "implicit",
            "explicit",
            "implicit-explicit",
        ],
        &[],
    ),
    relation(
        "cut and tied",
        Again::Text(|v| v.cut = true),
        Agreement::Solver,
        &[
            "rigid-lower",
            "floor",
            "clamp",
            "periodic",
            "side-body",
            "orthotropic",
            "tied-foot",
            "bolt",
            "turning",
            "simplices",
            // Masses of points in contact are given to eight layers of cells, as far as their body goes.
            "implicit",
            "explicit",
            "implicit-explicit",
            "centrifugal",
            "spring-across",
            "stop-across",
            "dashpot-across",
            "fatigue",
        ],
        &[],
    ),
    relation(
        "not turned",
        Again::Text(|v| v.unturned = true),
        Agreement::Solver,
        &[],
        &["turning"],
    ),
    relation("two threads", Again::Threads, Agreement::Bytes, &[], &[]),
    relation("resumed", Again::Resume, Agreement::Bytes, &[], &[]),
];

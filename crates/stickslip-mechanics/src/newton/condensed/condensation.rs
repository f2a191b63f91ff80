use std::ops::Range;
use std::sync::Arc;
use std::time::Instant;

use rayon::prelude::*;

use super::file;
use super::identity::{Identity, Part};
use super::library::{Library, Reserved, Source};
use super::substructure::{ArtificialSprings, Seconds, Substructure, SweptPart};
use crate::linear::{Analysed, Engine, FactorEffort, LinearError, Matrix, Workspace};
use crate::math::vector::dot;
use crate::owner::Owner;

/// What is to be condensed: known before any arithmetic.
#[derive(Debug)]
pub struct Plan {
    parts: Vec<Planned>,
    /// Points that may come into contact.
    kept: Vec<bool>,
    /// Whether what is made can be written to files, for which others would wait.
    filed: bool,
    /// What it took.
    pub effort: Effort,
}

/// One part of the model.
#[derive(Debug)]
struct Planned {
    points: (usize, usize),
    identity: Identity,
    what: Made,
}

/// Whether a substructure was made before.
#[derive(Debug)]
enum Made {
    Before(Arc<Substructure>, Source),
    Not(Arc<dyn Analysed>),
}

impl Planned {
    /// Whether it was made before.
    fn is_known(&self) -> bool {
        matches!(self.what, Made::Before(..))
    }

    fn ordered(&self) -> &dyn Analysed {
        match &self.what {
            Made::Before(part, _) => part.interior.ordered(),
            Made::Not(ordered) => &**ordered,
        }
    }
}

/// What was made, and what was there.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Effort {
    /// Symbolic analyses.
    pub analysed: usize,
    /// Substructures factored.
    pub made: usize,
    /// Substructures made before in this process.
    pub shared: usize,
    /// Substructures read from files.
    pub read: usize,
    /// Seconds of looking for what was made before, reading included.
    pub seconds_find: f64,
    /// Seconds of waiting for other processes, reading what they made included.
    pub seconds_wait: f64,
    /// Seconds of ordering and symbolic factorisation.
    pub seconds_order: f64,
    /// Seconds of factoring; parts are factored side by side.
    pub seconds: Seconds,
    /// What factoring took.
    pub factor: FactorEffort,
    /// What the user should know about files.
    pub notes: Vec<String>,
}

/// What a plan costs.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Cost {
    /// Additions and multiplications of the partial factorisations, whoever makes them.
    pub factor: f64,
    /// Those of the inverses.
    pub condense: f64,
    /// Those of both that are left to do, as others were made before.
    pub left: f64,
    /// Entries of the sparse factors.
    pub nonzeros: f64,
    /// Entries of the inverses.
    pub dense: f64,
    /// Candidate dofs.
    pub candidates: usize,
    /// Peak memory `[bytes]`.
    pub bytes: u64,
}

impl Plan {
    /// Looks for the substructures of every part of the model, given by its points, and lets the engine order those that were not made before. Parts must not be
    /// coupled. `fixed` marks dofs that are no unknowns, `kept` the points that may come into contact.
    ///
    /// # Errors
    /// Those of [`Engine::order`].
    pub fn new(
        matrix: &dyn Matrix,
        parts: &[Range<usize>],
        fixed: &[bool],
        kept: &[bool],
        springs: ArtificialSprings,
        library: &Library,
        engine: &Arc<dyn Engine>,
    ) -> Result<Plan, LinearError> {
        let started = Instant::now();
        let find = |points: &Range<usize>| {
            let part = Part {
                matrix,
                points: (points.start, points.end),
                fixed,
                kept,
            };
            let (identity, analysis) = (
                part.substructure(springs.places, springs.typical)
                    .made_by(engine.identity()),
                part.analysis().made_by(engine.identity()),
            );
            let (known, note) = library.find(identity, &part);
            let before = match &known {
                Some(_) => None,
                None => library.analysis(analysis),
            };
            (part, (identity, analysis), known, note, before)
        };
        let found: Vec<_> = parts.par_iter().map(find).collect();
        let mut effort = Effort {
            seconds_find: started.elapsed().as_secs_f64(),
            ..Effort::default()
        };
        let started = Instant::now();
        let ordered: Result<Vec<Option<Arc<dyn Analysed>>>, LinearError> = found
            .par_iter()
            .map(
                |(part, (_, analysis), known, _, before)| match (known, before) {
                    (Some(_), _) => Ok(None),
                    (None, Some(before)) => Ok(Some(Arc::clone(before))),
                    (None, None) => {
                        let made =
                            Arc::clone(engine).order(matrix, (part.points(), fixed, kept))?;
                        library.keep_analysis(*analysis, &made);
                        Ok(Some(made))
                    }
                },
            )
            .collect();
        let mut parts = Vec::with_capacity(found.len());
        for ((part, (identity, _), known, note, before), ordered) in found.into_iter().zip(ordered?)
        {
            effort.analysed += usize::from(known.is_none() && before.is_none());
            match &known {
                Some((_, Source::Memory)) => effort.shared += 1,
                Some((_, Source::Disk)) => effort.read += 1,
                _ => effort.made += 1,
            }
            effort.notes.extend(note);
            let what = match (known, ordered) {
                (Some((part, source)), _) => Made::Before(part, source),
                (None, Some(ordered)) => {
                    effort.notes.extend(ordered.note());
                    Made::Not(ordered)
                }
                (None, None) => unreachable!("what is not known was ordered"),
            };
            parts.push(Planned {
                points: part.points,
                identity,
                what,
            });
        }
        effort.seconds_order = started.elapsed().as_secs_f64();
        Ok(Plan {
            parts,
            kept: kept.to_vec(),
            filed: engine.keeps_files(),
            effort,
        })
    }

    /// What it would cost to carry it out, were nothing known: how to solve must not depend on who was here before.
    pub fn cost(&self) -> Cost {
        let mut cost = Cost::default();
        for part in &self.parts {
            let ordered = part.ordered();
            let (effort, root) = (ordered.effort(), ordered.root().len());
            let n = root as f64;
            cost.factor += effort.flops;
            cost.condense += n * n * n;
            if let Made::Not(_) = part.what {
                cost.left += effort.flops + n * n * n;
            }
            cost.nonzeros += effort.nonzeros;
            cost.dense += n * n;
            cost.candidates += root;
            cost.bytes += effort.bytes;
            if ordered.compliance_is_here() {
                // the inverse, its copy in single precision and the work space
                cost.bytes += (28.0 * n * n) as u64;
            }
        }
        cost
    }
}

/// A substructure, where it comes from, and what the user should know about its file.
type Got = (Arc<Substructure>, Source, Option<String>);

/// Who makes a part that does not exist.
enum Maker {
    /// This process, with a lease if there is a directory.
    Here(Option<Owner>),
    /// Another.
    Elsewhere,
}

impl Plan {
    /// Factors what was not made before. First what this process has leases for, side by side, and each is given back when its part is there: whoever waits
    /// holds none, so that no two processes wait for each other.
    fn carry_out(
        self,
        matrix: &dyn Matrix,
        held: &[bool],
        springs: ArtificialSprings,
        library: &Library,
        waits: &dyn Fn() -> bool,
    ) -> Result<(Vec<Arc<Substructure>>, Effort), LinearError> {
        let Plan {
            parts,
            kept,
            filed,
            mut effort,
        } = self;
        let reserve = |part: &Planned| match part.is_known() || !filed || part.is_tiny() {
            true => Maker::Here(None),
            false => match library.reserve(part.identity) {
                Reserved::Ours(lease) => Maker::Here(lease),
                Reserved::Theirs => Maker::Elsewhere,
            },
        };
        let makers: Vec<Maker> = parts.iter().map(reserve).collect();
        let new = parts.iter().filter(|part| !part.is_known());
        let workspace = Workspace::of(new.map(|part| part.ordered().longest()));
        let make = |part: &Planned, ordered: &Arc<dyn Analysed>, lease: Option<Owner>| {
            let of_matrix = Part {
                matrix,
                points: part.points,
                fixed: held,
                kept: &kept,
            };
            // It may have come since it was looked for.
            let looked = lease.is_some();
            if let Some(found) = looked.then(|| library.find(part.identity, &of_matrix))
                && let (Some((found, source)), note) = found
            {
                return Ok((found, source, note));
            }
            let made = Substructure::new(part.identity, ordered, matrix, springs, &workspace)?;
            let made = Arc::new(made);
            let note = library.keep(&made);
            drop(lease);
            Ok((made, Source::Made, note))
        };
        let here = parts
            .par_iter()
            .zip(makers)
            .map(|(part, maker)| match (&part.what, maker) {
                (Made::Before(known, source), _) => Some(Ok((Arc::clone(known), *source, None))),
                (Made::Not(ordered), Maker::Here(lease)) => Some(make(part, ordered, lease)),
                (Made::Not(_), Maker::Elsewhere) => None,
            });
        let here: Vec<Option<Result<Got, LinearError>>> = here.collect();
        let mut all = Vec::new();
        for (part, got) in parts.iter().zip(here) {
            let (made, source, note) = match (got, &part.what) {
                (Some(got), _) => got?,
                (None, Made::Before(..)) => unreachable!("what is known is not made elsewhere"),
                (None, Made::Not(ordered)) => {
                    let of_matrix = Part {
                        matrix,
                        points: part.points,
                        fixed: held,
                        kept: &kept,
                    };
                    let started = Instant::now();
                    let ((found, note), lease) = library.wait(part.identity, &of_matrix, waits);
                    effort.seconds_wait += started.elapsed().as_secs_f64();
                    effort.notes.extend(note);
                    match found {
                        Some((found, source)) => (found, source, None),
                        None => make(part, ordered, lease)?,
                    }
                }
            };
            effort.count(part.is_known(), source, &made);
            effort.notes.extend(note);
            all.push(made);
        }
        Ok((all, effort))
    }
}

impl Planned {
    /// Whether it is not worth a file.
    fn is_tiny(&self) -> bool {
        let ordered = self.ordered();
        ordered.root().len() <= file::SMALL_PART && ordered.interior().is_empty()
    }
}

impl Effort {
    /// Counts a part by where it has come from in the end; those that were `planned` were known before.
    fn count(&mut self, planned: bool, source: Source, part: &Substructure) {
        if planned {
            return;
        }
        match source {
            Source::Made => {
                self.seconds.factor += part.seconds.factor;
                self.seconds.condense += part.seconds.condense;
                let taken = part.interior.effort();
                self.factor.flops += taken.flops;
                self.factor.nonzeros += taken.nonzeros;
                return;
            }
            Source::Memory => self.shared += 1,
            Source::Disk => self.read += 1,
        }
        self.made -= 1;
    }
}

/// All bodies without their interiors.
#[derive(Debug)]
pub struct Condensation {
    /// The bodies.
    pub parts: Vec<Arc<Substructure>>,
    /// Where the candidates of each part start in [`dofs`](Condensation::dofs), and their number.
    pub starts: Vec<usize>,
    /// The candidate dofs, part by part.
    pub dofs: Vec<usize>,
    /// Dofs that are no candidates.
    pub fixed: Vec<bool>,
    /// Dofs that are neither candidates nor interior: prescribed ones.
    pub held: Vec<bool>,
    place: Vec<u32>,
}

/// Forces swept forward: what is left of them at the candidates, and what the interiors keep, part by part.
pub type Swept = (Vec<f64>, Vec<Vec<f64>>);

/// No candidate.
const NONE: u32 = u32::MAX;

impl Condensation {
    /// Carries out a plan: factors what was not made before, and gives it to the library. While another process makes a part `waits` is asked again and
    /// again; if it says no the part is made here as well.
    ///
    /// # Errors
    /// Those of [`Substructure::new`].
    pub fn new(
        plan: Plan,
        matrix: &dyn Matrix,
        held: &[bool],
        springs: ArtificialSprings,
        library: &Library,
        waits: &dyn Fn() -> bool,
    ) -> Result<(Condensation, Effort), LinearError> {
        let (parts, effort) = plan.carry_out(matrix, held, springs, library, waits)?;
        let (mut starts, mut dofs) = (vec![0], Vec::new());
        for part in &parts {
            dofs.extend(part.root().iter().map(|&d| d as usize));
            starts.push(dofs.len());
        }
        let mut place = vec![NONE; held.len()];
        let mut fixed = vec![true; held.len()];
        for (i, &dof) in dofs.iter().enumerate() {
            place[dof] = i as u32;
            fixed[dof] = false;
        }
        let condensation = Condensation {
            parts,
            starts,
            dofs,
            fixed,
            held: held.to_vec(),
            place,
        };
        Ok((condensation, effort))
    }

    /// Number of candidate dofs.
    pub fn size(&self) -> usize {
        self.dofs.len()
    }

    /// The position of a dof among the candidates.
    pub fn place(&self, dof: usize) -> Option<usize> {
        match self.place[dof] {
            NONE => None,
            at => Some(at as usize),
        }
    }

    /// The entries of a vector over all dofs at the candidates.
    pub fn gather(&self, all: &[f64]) -> Vec<f64> {
        self.dofs.iter().map(|&dof| all[dof]).collect()
    }

    /// Writes entries at the candidates into a vector over all dofs.
    pub fn scatter(&self, values: &[f64], all: &mut [f64]) {
        for (&dof, &value) in self.dofs.iter().zip(values) {
            all[dof] = value;
        }
    }

    /// Why the engine that has a factor cannot go on, if it cannot.
    pub fn fault(&self) -> Option<LinearError> {
        self.parts.iter().find_map(|part| part.interior.fault())
    }

    /// The compliance product `W s`.
    pub fn apply_compliance(&self, s: &[f64]) -> Vec<f64> {
        let parts: Vec<Vec<f64>> = self
            .parts
            .par_iter()
            .zip(self.starts.par_windows(2))
            .map(|(part, range)| {
                let mut u = vec![0.0; range[1] - range[0]];
                part.compliance.mul(&s[range[0]..range[1]], &mut u);
                u
            })
            .collect();
        parts.concat()
    }

    /// Takes the forces of the artificial springs, `σ R Rᵀ u`, away from `s`.
    pub fn release(&self, u: &[f64], s: &mut [f64]) {
        for (part, range) in self.parts.iter().zip(self.starts.windows(2)) {
            let Some(floating) = &part.floating else {
                continue;
            };
            let u = &u[range[0]..range[1]];
            for mode in &floating.modes {
                let force = floating.sigma * dot(mode, u);
                for (s, m) in s[range[0]..range[1]].iter_mut().zip(mode) {
                    *s -= force * m;
                }
            }
        }
    }

    /// Sweeps forces over all dofs forward. Returns what is left of them at the candidates, and in the interiors what
    /// [`recover`](Condensation::recover) needs of them.
    ///
    /// # Errors
    /// Those of [`Interior::reduce`](crate::linear::Interior::reduce).
    pub fn sweep(&self, forces: &[f64]) -> Result<Swept, LinearError> {
        self.sweep_with(|part| part.sweep(forces))
    }

    /// The same of forces that other runs with the same bodies are likely to have, too.
    ///
    /// # Errors
    /// As for [`sweep`](Condensation::sweep).
    pub fn sweep_pattern(&self, forces: &[f64]) -> Result<Swept, LinearError> {
        self.sweep_with(|part| part.sweep_pattern(forces))
    }

    fn sweep_with(
        &self,
        sweep: impl Fn(&Substructure) -> Result<SweptPart, LinearError> + Sync,
    ) -> Result<Swept, LinearError> {
        let swept: Result<Vec<SweptPart>, LinearError> =
            self.parts.par_iter().map(|part| sweep(part)).collect();
        let (roots, interiors): (Vec<_>, Vec<_>) = swept?.into_iter().unzip();
        Ok((roots.concat(), interiors))
    }

    /// Finds the interiors of several states in one sweep. For each state `swept` has forces as [`sweep`](Condensation::sweep) leaves them, part
    /// by part, and `at` the displacements of the candidates; both are written into the states' vectors over all dofs.
    ///
    /// # Errors
    /// Those of [`Interior::recover`](crate::linear::Interior::recover).
    pub fn recover(
        &self,
        mut swept: Vec<Vec<Vec<f64>>>,
        at: &[Vec<f64>],
        all: &mut [&mut Vec<f64>],
    ) -> Result<(), LinearError> {
        let columns = at.len();
        let found: Result<Vec<Vec<f64>>, LinearError> = (0..self.parts.len())
            .map(|k| {
                let mut interior = Vec::new();
                for state in &mut swept {
                    interior.append(&mut state[k]);
                }
                interior
            })
            .collect::<Vec<_>>()
            .into_par_iter()
            .enumerate()
            .map(|(k, mut interior)| {
                let range = self.starts[k]..self.starts[k + 1];
                let root: Vec<f64> = at.iter().flat_map(|u| u[range.clone()].to_vec()).collect();
                let part = &self.parts[k].interior;
                part.recover(&mut interior, &root, columns)?;
                Ok(interior)
            })
            .collect();
        for (part, interior) in self.parts.iter().zip(&found?) {
            let dofs = part.interior.ordered().interior();
            for (all, values) in all.iter_mut().zip(interior.chunks(dofs.len().max(1))) {
                for (&dof, &value) in dofs.iter().zip(values) {
                    all[dof as usize] = value;
                }
            }
        }
        for (all, values) in all.iter_mut().zip(at) {
            self.scatter(values, all);
        }
        Ok(())
    }
}

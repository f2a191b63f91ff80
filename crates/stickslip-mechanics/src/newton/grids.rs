//! Multigrid in place of a factor.

use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::Instant;

use super::failure::{describe, not_finite};
use super::operator::Operator;
use super::stand_in::{StandIn, stand_ins};
use super::statistics::Statistics;
use crate::linear::{
    BlockCsr, GapVariables, GmresReport, GmresSettings, LinearError, MeshHints, Multigrid,
    MultigridSettings, gmres,
};
use crate::math::Vec3;
use crate::system::{Cause, ContactBlock, ContactPair, StepFailure};

/// What multigrid has to know of the points that have dofs.
#[derive(Debug, Clone, PartialEq)]
pub struct BodyPoints {
    /// Their coordinates `[m]`.
    pub coordinates: Vec<Vec3>,
    /// The body of each.
    pub bodies: Vec<u32>,
    /// How many of them belong to elastic bodies; those that follow have the dofs of rigid ones.
    pub elastic: usize,
}

/// Iterations after which a hierarchy is made anew if it is not fresh.
const HIERARCHY_PATIENCE: usize = 40;

/// Iterations after which a fresh hierarchy is given up.
const MOST_GRID_ITERATIONS: usize = 200;

/// Iterations after which GMRES starts again.
const RESTART: usize = 60;

/// Part of a facet that points may move along it before the finest level is made anew: stiff contact feels it. With 0.009 and 0.09 the example `rough-block` has
/// the same digits.
const FINEST_LEVEL_DRIFT: f64 = 0.03;

/// The same where the iteration has become slow: a level that is made anew although nothing moved does not help. With 1e-4 and
/// 1e-2 the tests of multigrid pass.
const SLOW_DRIFT: f64 = 1e-3;

/// A hierarchy that outlives the state it was made at.
///
/// The stiffness of contact at points that have gap variables is put on it in every iteration. Other contact, of points between nodes for
/// one, is part of the matrix it is made of.
#[derive(Debug)]
pub(super) struct Grids {
    points: Arc<BodyPoints>,
    made: Option<Made>,
    /// Set when multigrid does not work here.
    given_up: bool,
    note: Option<String>,
}

#[derive(Debug)]
struct Made {
    fixed: Vec<bool>,
    gaps: GapVariables,
    levels: Multigrid,
    /// Contact that is part of the matrix: the trace of its stiffness by point.
    assembled: BTreeMap<usize, f64>,
    /// Nothing has changed but what [`Multigrid::update`] takes.
    fresh: bool,
    /// The last solution took too many iterations.
    slow: bool,
    /// Contact at the set-up, and when the finest level was made anew last.
    at_setup: Arc<Seen>,
    at_refresh: Option<Arc<Seen>>,
}

/// What of contact a hierarchy is made of.
#[derive(Debug, Clone, Default, crate::keep::Keep)]
struct Seen {
    blocks: Vec<StandIn>,
    pairs: Vec<ContactPair>,
}

impl Seen {
    fn of(operator: Operator) -> Arc<Self> {
        Arc::new(Seen {
            blocks: stand_ins(operator.blocks),
            pairs: operator.pairs.to_vec(),
        })
    }

    /// As it was, but for what no hierarchy looks at.
    fn contact(&self) -> (Vec<ContactBlock>, Vec<ContactPair>) {
        let block = |(dofs, surrogate): &StandIn| ContactBlock {
            dofs: dofs.clone(),
            surrogate: surrogate.clone(),
            rows: Vec::new(),
            change: Vec::new(),
            hessian: Vec::new(),
        };
        (self.blocks.iter().map(block).collect(), self.pairs.clone())
    }
}

/// What [`Grids`] were made of: enough to make them again, with the same bits.
#[derive(Debug, Clone, Default, crate::keep::Keep)]
pub(super) struct GridsRecipe {
    given_up: bool,
    made: Option<MadeRecipe>,
}

#[derive(Debug, Clone, Default, crate::keep::Keep)]
struct MadeRecipe {
    fixed: Vec<bool>,
    at_setup: Arc<Seen>,
    at_refresh: Option<Arc<Seen>>,
    fresh: bool,
    slow: bool,
}

impl Made {
    /// Makes the finest level anew with other gap variables of the same points; `false` where other contact has changed too much for that.
    fn refresh(&mut self, operator: Operator, gaps: GapVariables) -> Result<bool, LinearError> {
        self.gaps = gaps;
        self.fresh = false;
        self.slow = false;
        let (added, assembled) = split(operator, &self.gaps);
        if changed(&self.assembled, &assembled) {
            return Ok(false);
        }
        self.levels
            .refresh(&transformed(operator.matrix, &self.gaps, &assembled))?;
        self.assembled = traces(&assembled);
        self.levels.update(&added);
        self.at_refresh = Some(Seen::of(operator));
        Ok(true)
    }

    /// Iterates, a fresh hierarchy as long as it may, another at most so often.
    fn gmres(
        &mut self,
        operator: Operator,
        b: &[f64],
        x: &mut [f64],
        tolerance: f64,
        most: usize,
    ) -> GmresReport {
        gmres(
            &mut |v, out| operator.apply(v, out),
            &mut |v| {
                self.gaps.transpose(v);
                self.levels.cycle(v);
                self.gaps.apply(v);
                // Gap variables reach prescribed dofs too, and the operator takes what is there for zero in its rows only.
                let fixed = v.iter_mut().zip(operator.fixed);
                fixed
                    .filter(|(_, fixed)| **fixed)
                    .for_each(|(v, _)| *v = 0.0);
            },
            b,
            x,
            GmresSettings {
                tolerance,
                max_iterations: if self.fresh {
                    MOST_GRID_ITERATIONS
                } else {
                    most
                },
                restart: RESTART,
            },
        )
    }
}

/// Symmetric stiffnesses over the dofs of a few points.
type Groups = Vec<(Vec<usize>, Vec<f64>)>;

impl Grids {
    pub fn new(points: Arc<BodyPoints>) -> Self {
        Grids {
            points,
            made: None,
            given_up: false,
            note: None,
        }
    }

    /// The same for another matrix.
    pub fn without_levels(&self) -> Self {
        Grids {
            given_up: self.given_up,
            ..Grids::new(Arc::clone(&self.points))
        }
    }

    /// What they were made of; without levels where their matrix is not `used` any more.
    pub fn recipe(&self, used: bool) -> GridsRecipe {
        GridsRecipe {
            given_up: self.given_up,
            made: self.made.as_ref().filter(|_| used).map(|made| MadeRecipe {
                fixed: made.fixed.clone(),
                at_setup: Arc::clone(&made.at_setup),
                at_refresh: made.at_refresh.clone(),
                fresh: made.fresh,
                slow: made.slow,
            }),
        }
    }

    /// Makes them again; without levels where the matrix is not used any more.
    pub fn again(
        recipe: GridsRecipe,
        matrix: Option<&BlockCsr>,
        points: &Arc<BodyPoints>,
    ) -> Result<Self, LinearError> {
        let mut grids = Grids {
            given_up: recipe.given_up,
            ..Grids::new(Arc::clone(points))
        };
        let (Some(made), Some(matrix)) = (recipe.made, matrix) else {
            return Ok(grids);
        };
        // Counts are those of the run that goes on.
        let mut statistics = Statistics::default();
        for (step, seen) in [Some(&made.at_setup), made.at_refresh.as_ref()]
            .into_iter()
            .enumerate()
        {
            let Some(seen) = seen else {
                continue;
            };
            let (blocks, pairs) = seen.contact();
            let operator = Operator {
                matrix,
                stand_in: matrix,
                fixed: &made.fixed,
                blocks: &blocks,
                couplings: &[],
                pairs: &pairs,
            };
            match &mut grids.made {
                Some(known) if step > 0 => {
                    known.refresh(operator, variables(operator))?;
                }
                _ => grids.set_up(operator, &mut statistics)?,
            }
        }
        if let Some(known) = &mut grids.made {
            (known.fresh, known.slow) = (made.fresh, made.slow);
        }
        Ok(grids)
    }

    /// Whether multigrid has not been given up.
    pub fn works(&self) -> bool {
        !self.given_up
    }

    /// Why it has been given up, once.
    pub fn note(&mut self) -> Option<String> {
        self.note.take()
    }

    fn give_up(&mut self, why: &str) {
        self.given_up = true;
        self.made = None;
        self.note = Some(format!(
            "multigrid gives way to a sparse factorisation: {why}"
        ));
    }

    /// Solves `(bulk + blocks) x = b` on the free dofs. Returns `x` and the iterations; `None` where a factor has to take over.
    pub fn solve(
        &mut self,
        operator: Operator,
        b: &[f64],
        tolerance: f64,
        statistics: &mut Statistics,
    ) -> Result<Option<(Vec<f64>, usize)>, StepFailure> {
        let dim = operator.matrix.block_size();
        if operator.fixed[self.points.elastic * dim..]
            .iter()
            .any(|fixed| !fixed)
        {
            self.give_up("rigid bodies move");
            return Ok(None);
        }
        let started = Instant::now();
        self.follow(operator, statistics).map_err(describe)?;
        statistics.seconds.factor += started.elapsed().as_secs_f64();
        let mut x = vec![0.0; b.len()];
        let mut spent = 0;
        for most in [2 * HIERARCHY_PATIENCE, MOST_GRID_ITERATIONS] {
            let Some(made) = &mut self.made else {
                return Ok(None);
            };
            let started = Instant::now();
            let report = made.gmres(operator, b, &mut x, tolerance, most);
            spent += report.iterations;
            statistics.krylov += report.iterations;
            statistics.seconds.solve += started.elapsed().as_secs_f64();
            if !report.relative_residual.is_finite() {
                return Err(not_finite());
            }
            made.slow = report.iterations > HIERARCHY_PATIENCE;
            if report.converged {
                return Ok(Some((x, spent)));
            }
            if made.fresh {
                break;
            }
            let started = Instant::now();
            self.set_up(operator, statistics).map_err(describe)?;
            statistics.seconds.factor += started.elapsed().as_secs_f64();
        }
        if self
            .made
            .as_ref()
            .is_some_and(|made| made.levels.singular())
        {
            return Err(StepFailure::new(
                Cause::Singular,
                "the stiffness is singular: something is free to move",
            ));
        }
        self.give_up(&format!(
            "the tolerance was not reached in {spent} iterations"
        ));
        Ok(None)
    }

    /// Makes the hierarchy follow the operator, as far as is needed.
    fn follow(
        &mut self,
        operator: Operator,
        statistics: &mut Statistics,
    ) -> Result<(), LinearError> {
        let made = match &mut self.made {
            Some(made) if made.fixed == operator.fixed => made,
            _ => return self.set_up(operator, statistics),
        };
        let drift = drift(operator, &made.gaps);
        if drift
            > if made.slow {
                SLOW_DRIFT
            } else {
                FINEST_LEVEL_DRIFT
            }
        {
            let gaps = variables(operator);
            if !gaps.points().eq(made.gaps.points()) {
                return self.set_up(operator, statistics);
            }
            if !made.refresh(operator, gaps)? {
                return self.set_up(operator, statistics);
            }
            statistics.hierarchies.refreshes += 1;
            return Ok(());
        }
        let (added, assembled) = split(operator, &made.gaps);
        if changed(&made.assembled, &assembled) || made.slow && !made.fresh {
            return self.set_up(operator, statistics);
        }
        made.levels.update(&added);
        Ok(())
    }

    fn set_up(
        &mut self,
        operator: Operator,
        statistics: &mut Statistics,
    ) -> Result<(), LinearError> {
        // the memory is needed
        self.made = None;
        let gaps = variables(operator);
        let mut normals = Vec::new();
        let mut known = vec![false; operator.matrix.points()];
        for pair in operator.pairs {
            if gaps.is_gap(pair.point) && !known[pair.point] {
                known[pair.point] = true;
                normals.push((pair.point, pair.normal));
            }
        }
        let (added, assembled) = split(operator, &gaps);
        let hints = MeshHints {
            coordinates: &self.points.coordinates,
            bodies: &self.points.bodies,
            gaps: &normals,
        };
        let mut settings = MultigridSettings::default();
        if floats(operator, &self.points) {
            // halves the iterations, at half as much again for each
            settings.smoother_steps = 3;
            settings.smoother_ratio = 20.0;
        }
        let matrix = transformed(operator.matrix, &gaps, &assembled);
        let mut levels = Multigrid::new(&matrix, operator.fixed, hints, settings)?;
        levels.update(&added);
        statistics.hierarchies.setups += 1;
        statistics.hierarchies.levels = levels.levels().len();
        statistics.hierarchies.operator_complexity = levels.operator_complexity();
        statistics.hierarchies.bytes = levels.bytes();
        self.made = Some(Made {
            fixed: operator.fixed.to_vec(),
            gaps,
            levels,
            assembled: traces(&assembled),
            fresh: true,
            slow: false,
            at_setup: Seen::of(operator),
            at_refresh: None,
        });
        Ok(())
    }
}

/// Gap variables for as many points as there may be: those that act come first where two would be in each other's way.
fn variables(operator: Operator) -> GapVariables {
    let dim = operator.matrix.block_size();
    let acting = acting(operator);
    let rank = |pair: &ContactPair| match (acting[pair.point], pair.facet.is_empty()) {
        (true, false) => 0,
        (_, false) => 1,
        _ => 2,
    };
    let free = |pair: &&ContactPair| {
        let dofs = pair.point * dim..(pair.point + 1) * dim;
        operator.fixed[dofs].iter().any(|fixed| !fixed)
    };
    let mut pairs: Vec<&ContactPair> = operator.pairs.iter().filter(free).collect();
    pairs.sort_by_key(|pair| (rank(pair), pair.point));
    let pairs: Vec<(usize, Vec<(usize, f64)>)> = pairs
        .into_iter()
        .map(|pair| (pair.point, pair.facet.clone()))
        .collect();
    GapVariables::new(dim, operator.fixed, &pairs)
}

/// Points whose first dof is that of a block.
fn acting(operator: Operator) -> Vec<bool> {
    let dim = operator.matrix.block_size();
    let mut acting = vec![false; operator.matrix.points()];
    for block in operator.blocks {
        acting[block.dofs[0] / dim] = true;
    }
    acting
}

/// The pairs of each acting point that meets a facet, and how far they are from its gap variables, as the part of the facet.
fn drifts<'a>(
    operator: Operator<'a>,
    gaps: &GapVariables,
) -> BTreeMap<usize, Vec<(f64, &'a ContactPair)>> {
    let acting = acting(operator);
    let mut out: BTreeMap<usize, Vec<(f64, &ContactPair)>> = BTreeMap::new();
    for pair in operator.pairs {
        if !pair.facet.is_empty() && acting[pair.point] && gaps.is_gap(pair.point) {
            let list = out.entry(pair.point).or_default();
            list.push((distance(pair, gaps), pair));
        }
    }
    out
}

/// Half the sum of the differences of weights.
fn distance(pair: &ContactPair, gaps: &GapVariables) -> f64 {
    let mut sum = 0.0;
    for &(point, now) in &pair.facet {
        let before = gaps.facet(pair.point).find(|(p, _)| *p == point);
        sum += (now - before.map_or(0.0, |(_, w)| w)).abs();
    }
    for (point, before) in gaps.facet(pair.point) {
        if pair.facet.iter().all(|(p, _)| *p != point) {
            sum += before.abs();
        }
    }
    0.5 * sum
}

/// How far points have moved since the gap variables were made. Where a point meets several facets, the one that it has a gap to counts.
fn drift(operator: Operator, gaps: &GapVariables) -> f64 {
    let of_point = |list: &Vec<(f64, &ContactPair)>| {
        list.iter().map(|(d, _)| *d).fold(f64::INFINITY, f64::min)
    };
    let all = drifts(operator, gaps);
    all.values().map(of_point).fold(0.0, f64::max)
}

/// The symmetric approximations of the blocks: those that are stiffnesses of a gap, added up by point, and all others.
fn split(operator: Operator, gaps: &GapVariables) -> (Vec<(usize, [f64; 9])>, Groups) {
    let dim = operator.matrix.block_size();
    let mut added: Vec<(usize, [f64; 9])> = Vec::new();
    let mut assembled = Vec::new();
    let drifts = drifts(operator, gaps);
    for block in operator.blocks {
        if block.surrogate.iter().all(|s| *s == 0.0) {
            continue;
        }
        let point = block.dofs[0] / dim;
        if !is_gap_stiffness(block, operator, gaps, &drifts) {
            assembled.push(group(block, dim));
            continue;
        }
        let mut stiffness = [0.0; 9];
        for r in 0..dim {
            for c in 0..dim {
                stiffness[r * dim + c] = block.surrogate[r * block.dofs.len() + c];
            }
        }
        added.push((point, stiffness));
    }
    // The sort is stable: sums do not depend on chance.
    added.sort_by_key(|(point, _)| *point);
    added.dedup_by(|later, first| {
        let same = later.0 == first.0;
        if same {
            first.1.iter_mut().zip(later.1).for_each(|(f, l)| *f += l);
        }
        same
    });
    (added, assembled)
}

/// Whether a block acts on the gap of its first point: on nothing free but the point and the facet it has a gap to.
fn is_gap_stiffness(
    block: &ContactBlock,
    operator: Operator,
    gaps: &GapVariables,
    drifts: &BTreeMap<usize, Vec<(f64, &ContactPair)>>,
) -> bool {
    let dim = operator.matrix.block_size();
    let point = block.dofs[0] / dim;
    let own = |(c, dof): (usize, &usize)| *dof == point * dim + c;
    if !block.dofs.iter().take(dim).enumerate().all(own) || !gaps.is_gap(point) {
        return false;
    }
    let mut others = block.dofs[dim..]
        .iter()
        .filter(|dof| !operator.fixed[**dof]);
    let near = drifts.get(&point).map_or(&[][..], |list| list.as_slice());
    let mut near = near
        .iter()
        .filter(|(drift, _)| *drift <= FINEST_LEVEL_DRIFT);
    match near.next() {
        Some((_, pair)) => others.all(|dof| pair.facet.iter().any(|(p, _)| *p == dof / dim)),
        None => others.next().is_none(),
    }
}

/// The symmetric approximation of a block over all dofs of its points.
fn group(block: &ContactBlock, dim: usize) -> (Vec<usize>, Vec<f64>) {
    let mut points: Vec<usize> = block.dofs.iter().map(|dof| dof / dim).collect();
    points.sort_unstable();
    points.dedup();
    let width = points.len() * dim;
    let places: Vec<usize> = block
        .dofs
        .iter()
        .map(|dof| points.partition_point(|p| *p < dof / dim) * dim + dof % dim)
        .collect();
    let mut dense = vec![0.0; width * width];
    for (row, &r) in block.surrogate.chunks_exact(block.dofs.len()).zip(&places) {
        for (value, &c) in row.iter().zip(&places) {
            dense[r * width + c] += value;
        }
    }
    (points, dense)
}

/// Traces of stiffnesses by point.
fn traces(assembled: &Groups) -> BTreeMap<usize, f64> {
    let mut out = BTreeMap::new();
    for (points, dense) in assembled {
        let width = dense.len().isqrt();
        let dim = width / points.len();
        for (k, diagonal) in dense.iter().step_by(width + 1).enumerate() {
            *out.entry(points[k / dim]).or_insert(0.0) += diagonal;
        }
    }
    out
}

/// Whether stiffnesses are not nearly those of before.
fn changed(before: &BTreeMap<usize, f64>, now: &Groups) -> bool {
    let now = traces(now);
    let at = |all: &BTreeMap<usize, f64>, point| all.get(&point).copied().unwrap_or(0.0);
    let gone = before.keys().filter(|point| !now.contains_key(point));
    let apart = |point: &usize| (at(&now, *point) - at(before, *point)).abs();
    let apart: f64 = now.keys().chain(gone).map(apart).sum();
    let whole: f64 = now.values().chain(before.values()).sum();
    // Part of the stiffnesses that are no gap stiffnesses that may change before the hierarchy is made anew. What single points do, one
    // that opens or comes to lie on another facet, costs single iterations, and a hierarchy as many as a whole solution.
    apart > 0.1 * whole
}

/// The matrix in gap variables.
fn transformed(matrix: &BlockCsr, gaps: &GapVariables, assembled: &Groups) -> BlockCsr {
    if assembled.is_empty() {
        gaps.transform(matrix)
    } else {
        gaps.transform(&matrix.with_groups(assembled))
    }
}

/// Whether a body may be shifted at next to no cost.
fn floats(operator: Operator, points: &BodyPoints) -> bool {
    let dim = operator.matrix.block_size();
    let count = points.bodies.iter().max().map_or(0, |m| *m as usize + 1);
    let diagonal = operator.matrix.diagonal();
    let mut out = vec![0.0; diagonal.len()];
    (0..dim).any(|c| {
        let moves = |dof: usize| dof % dim == c && !operator.fixed[dof];
        let shift: Vec<f64> = (0..diagonal.len())
            .map(|dof| if moves(dof) { 1.0 } else { 0.0 })
            .collect();
        operator.matrix.mul(&shift, &mut out);
        let (mut cost, mut scale) = (vec![0.0; count], vec![0.0; count]);
        for dof in (c..diagonal.len()).step_by(dim).filter(|&dof| moves(dof)) {
            let body = points.bodies[dof / dim] as usize;
            cost[body] += out[dof];
            scale[body] += diagonal[dof];
        }
        // A body that resists a rigid motion by less than this part of the diagonals counts as floating.
        cost.iter().zip(&scale).any(|(c, s)| c.abs() < 1e-8 * s)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of twenty points in a row, each on two of the other side with these parts of a stiffness.
    fn row(first: usize, part: f64, stiffness: f64) -> Groups {
        let group = |k: usize| {
            let points = vec![k, 100 + k + first, 101 + k + first];
            let diagonal = [stiffness, part * stiffness, (1.0 - part) * stiffness];
            let mut dense = vec![0.0; 9];
            (0..3).for_each(|i| dense[4 * i] = diagonal[i]);
            (points, dense)
        };
        (0..20).map(group).collect()
    }

    #[test]
    fn a_hierarchy_outlives_what_single_points_do() {
        let before = traces(&row(0, 0.5, 1.0));
        assert_eq!(before.values().sum::<f64>(), 40.0);
        assert!(!changed(&before, &row(0, 0.45, 1.1)));
        let mut parted = row(0, 0.5, 1.0);
        parted.remove(7);
        parted[3].0[2] = 200;
        assert!(!changed(&before, &parted));
        // Most points parted, the stiffness rose, or the surface went on by several facets.
        assert!(changed(&before, &parted.split_off(15)));
        assert!(changed(&before, &row(0, 0.5, 1.5)));
        assert!(changed(&before, &row(10, 0.5, 1.0)));
        assert!(changed(&traces(&Groups::new()), &row(0, 0.5, 1.0)));
        assert!(!changed(&traces(&Groups::new()), &Groups::new()));
    }
}

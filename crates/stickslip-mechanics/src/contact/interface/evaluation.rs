//! What an evaluation leaves: the outcome at each point, and the numbers of all of them in batches.

use crate::contact::kinematics::{NodeSums, Stencil, carried_over};
use crate::contact::law::friction::FrictionPoint;
use crate::contact::response::Response;
use crate::math::{Vec3, add_scaled, dot, scale};
use crate::system::Tangent;

/// Contact points evaluated by one task. Fixed, so that no number depends on how many threads there are.
pub(in crate::contact) const EVALUATED_PER_TASK: usize = 16;

/// An evaluation of all points.
#[derive(Debug, Clone, Default)]
pub(in crate::contact) struct Evaluations {
    pub points: Vec<Evaluation>,
    pub batches: Vec<Batch>,
}

impl Evaluations {
    /// What goes beyond the increment that they are of: how fast tractions change, and where something lies opposite the nodes that take part.
    pub fn traces(&self) -> Vec<Trace> {
        let points = self.points.iter().enumerate();
        points
            .map(|(i, e)| Trace {
                slope: e.slope(),
                viscosity: e.viscosity,
                over: e.over,
                sides: match e.over {
                    true => self.batch(i).sides(e).to_vec(),
                    false => Vec::new(),
                },
            })
            .collect()
    }

    /// Evaluations of which nothing else is known.
    pub fn of_traces(traces: Vec<Trace>) -> Self {
        let mut batches = Vec::new();
        batches.resize_with(traces.len().div_ceil(EVALUATED_PER_TASK), Batch::default);
        let traces = traces.into_iter().enumerate();
        let points = traces.map(|(i, trace)| {
            let mut e = Evaluation {
                over: trace.over,
                ..Evaluation::default()
            };
            e.response.d_gap[0][0] = trace.slope;
            e.viscosity = trace.viscosity;
            let batch: &mut Batch = &mut batches[i / EVALUATED_PER_TASK];
            e.slots.sides = batch.sides.len();
            e.slots.nodes = trace.sides.len();
            batch.sides.extend(trace.sides);
            e
        });
        Evaluations {
            points: points.collect(),
            batches,
        }
    }

    /// Gives a point whose rows are known this traction, and its force.
    pub fn pull(&mut self, i: usize, traction: [f64; 3]) {
        let e = &mut self.points[i];
        e.response.traction = traction;
        let batch = &mut self.batches[i / EVALUATED_PER_TASK];
        if let (Some(force), Some(rows)) = (e.slots.force, e.slots.rows) {
            let rows = &batch.rows[rows..rows + 3 * e.slots.n];
            for (k, f) in batch.force[force..force + e.slots.n].iter_mut().enumerate() {
                let along = (0..3).map(|q| traction[q] * rows[q * e.slots.n + k]);
                *f = -e.area * along.sum::<f64>();
            }
        }
    }

    /// The numbers of a point.
    pub fn batch(&self, i: usize) -> &Batch {
        &self.batches[i / EVALUATED_PER_TASK]
    }
}

/// What an evaluation of a point leaves for the length of an explicit increment after it.
#[derive(Debug, Clone, crate::keep::Keep)]
pub(in crate::contact) struct Trace {
    /// The largest change of a traction with its own gap or slip `[Pa/m]`, and with the velocity along it `[Pa s/m]`.
    slope: f64,
    viscosity: f64,
    /// Whether something lies opposite, and the nodes that take part there with their weights.
    over: bool,
    sides: Vec<(usize, f64)>,
}

/// What a law is asked at a point.
#[derive(Debug, Clone, Copy)]
pub(in crate::contact) struct Question {
    pub point: usize,
    pub gap: f64,
    pub friction: FrictionPoint,
}

/// The outcome at one point. What has a size of its own lies in a [`Batch`].
#[derive(Debug, Clone, Copy, Default)]
pub(in crate::contact) struct Evaluation {
    pub slots: Slots,
    pub response: Response,
    /// Where multipliers are unknowns: the residual of their rows, and after a tangent evaluation `K_ll⁻¹` times that.
    pub saddle: Option<([f64; 3], [f64; 3])>,
    /// Tractions from before.
    pub kept: Before,
    /// Force that rounding may leave.
    pub rounding: f64,
    pub gap: f64,
    /// By how much what is worn off opens it, at the end of the increment.
    pub wear_gap: f64,
    pub frames: Frames,
    /// Relative slip since the last accepted state, belt included, along the frame of that state.
    pub moved: Vec3,
    /// Where it meets facets.
    pub foot: FacetContact,
    /// Whether something lies opposite.
    pub over: bool,
    /// Whether it slides all the time.
    pub steady: bool,
    /// Gap and slip of a tie that explicit increments hold exactly.
    pub off: [f64; 3],
    /// Area that the point stands for.
    pub area: f64,
    /// Stiffness of the enforcement against penetration and slip `[Pa/m]`.
    pub stiffness: [f64; 2],
    /// The largest change of a traction with the velocity along it `[Pa s/m]`, where that resists.
    pub viscosity: f64,
}

/// Tractions of a point from before an evaluation, as components in the frame.
#[derive(Debug, Clone, Copy, Default)]
pub(in crate::contact) struct Before {
    /// Multipliers, where they are unknowns.
    pub multiplier: [f64; 3],
    /// Shear traction at the last accepted state.
    pub shear: [f64; 2],
}

/// Where a point meets the facets of the primary.
#[derive(Debug, Clone, Copy, Default)]
pub(in crate::contact) struct FacetContact {
    /// The facet, and the place of the projection on it.
    pub facet: Option<usize>,
    pub xi: [f64; 2],
    /// It stays off the outer edge of the primary, but lies beneath its surface.
    pub off_edge: bool,
}

/// Where the numbers of a point lie in its [`Batch`].
#[derive(Debug, Clone, Copy, Default)]
pub(in crate::contact) struct Slots {
    /// Number of dofs, zero where there is no force, and where they start.
    pub n: usize,
    pub dofs: usize,
    /// Number of nodes that take part, and where their weights start.
    pub nodes: usize,
    pub sides: usize,
    /// Where force, `3 × n` gradients and changes, and matrices start, where there are such.
    pub force: Option<usize>,
    pub rows: Option<usize>,
    pub hessian: Option<usize>,
    pub surrogate: Option<usize>,
}

/// Directions at a point.
#[derive(Debug, Clone, Copy, Default)]
pub(in crate::contact) struct Frames {
    pub normal: Vec3,
    /// Directions of the shear traction now, and at the last accepted state, in which multipliers are kept.
    pub now: [Vec3; 2],
    pub before: [Vec3; 2],
    /// Unit normal to the directions at the last accepted state.
    pub normal_before: Vec3,
}

impl Evaluation {
    /// The largest change of a traction with its own gap or slip `[Pa/m]`, but for what follows their velocities.
    pub fn slope(&self) -> f64 {
        let Response { d_gap, d_rate, .. } = &self.response;
        (0..3).fold(0.0, |m: f64, i| m.max((d_gap[i][i] - d_rate[i]).abs()))
    }

    /// The gap; infinite where nothing lies opposite.
    pub fn known_gap(&self) -> f64 {
        match self.over {
            true => self.gap,
            false => f64::INFINITY,
        }
    }

    /// A point that carries nothing.
    pub fn open(gap: f64) -> Self {
        Evaluation {
            gap,
            ..Evaluation::default()
        }
    }
}

/// Numbers of the points of one chunk, one point after the other, and room to work in. The memory is used again by the next evaluation.
#[derive(Debug, Clone, Default)]
pub(in crate::contact) struct Batch {
    pub dofs: Vec<usize>,
    /// Nodes and their weights in gap and slip: positive on the secondary, negative on the primary.
    pub sides: Vec<(usize, f64)>,
    pub force: Vec<f64>,
    /// Gradients of gap and slip and how the tractions along them change, multipliers eliminated; `(3, n)` a point.
    pub rows: Vec<f64>,
    pub change: Vec<f64>,
    pub hessian: Vec<f64>,
    pub surrogate: Vec<f64>,
    pub stencil: Stencil,
    /// Gradients of the slip as friction sees it; empty where they are those of the slip.
    pub rated: [Vec<f64>; 2],
    /// What the nodes of a mortar's point have beside their weights.
    pub sums: Vec<NodeSums>,
    /// What laws are to be asked for all points at once.
    pub questions: Vec<Question>,
}

impl Batch {
    pub fn clear(&mut self) {
        self.questions.clear();
        self.dofs.clear();
        self.sides.clear();
        self.force.clear();
        self.rows.clear();
        self.change.clear();
        self.hessian.clear();
        self.surrogate.clear();
    }

    /// Dofs of a point; none where there is no force.
    pub fn dofs(&self, e: &Evaluation) -> &[usize] {
        &self.dofs[e.slots.dofs..e.slots.dofs + e.slots.n]
    }

    /// Nodes that take part and their weights: positive on the secondary, negative on the primary.
    pub fn sides(&self, e: &Evaluation) -> &[(usize, f64)] {
        &self.sides[e.slots.sides..e.slots.sides + e.slots.nodes]
    }

    /// Force on them; `None` where a point carries nothing.
    pub fn force(&self, e: &Evaluation) -> Option<&[f64]> {
        e.slots
            .force
            .map(|start| &self.force[start..start + e.slots.n])
    }

    /// What a tangent evaluation leaves for the assembler.
    pub fn tangent(&self, e: &Evaluation) -> Option<Tangent<'_>> {
        let start = e.slots.rows?;
        let matrix = |all: &'_ [f64], start: Option<usize>| -> std::ops::Range<usize> {
            start.map_or(all.len()..all.len(), |s| s..s + e.slots.n * e.slots.n)
        };
        Some(Tangent {
            rows: &self.rows[start..start + 3 * e.slots.n],
            change: &self.change[start..start + 3 * e.slots.n],
            area: e.area,
            hessian: &self.hessian[matrix(&self.hessian, e.slots.hessian)],
            surrogate: &self.surrogate[matrix(&self.surrogate, e.slots.surrogate)],
        })
    }
}

/// Components `c` with `v ≈ c₁ e₁ + c₂ e₂`, for directions that need not be orthogonal.
pub(in crate::contact) fn components(v: Vec3, e: &[Vec3; 2], dim: usize) -> [f64; 2] {
    let g11 = dot(e[0], e[0]);
    let b1 = dot(v, e[0]);
    if dim == 2 {
        return [b1 / g11, 0.0];
    }
    let (g12, g22, b2) = (dot(e[0], e[1]), dot(e[1], e[1]), dot(v, e[1]));
    let det = g11 * g22 - g12 * g12;
    if det == 0.0 {
        return [0.0; 2];
    }
    [(g22 * b1 - g12 * b2) / det, (g11 * b2 - g12 * b1) / det]
}

impl Evaluation {
    /// Shear traction on the secondary along the given directions.
    pub fn along(&self, frame: &[Vec3; 2]) -> Vec3 {
        let t = self.response.traction;
        add_scaled(scale(t[1], frame[0]), t[2], frame[1])
    }

    /// A tangent vector of the last accepted state, where the normal was `normal`, as it is carried into the tangent plane of now.
    pub fn forward(&self, v: Vec3, normal: Vec3, dim: usize) -> Vec3 {
        if normal == [0.0; 3] || self.frames.normal_before == [0.0; 3] {
            return v;
        }
        let there = carried_over(v, normal, self.frames.normal_before);
        let [a, b] = components(there, &self.frames.before, dim);
        add_scaled(scale(a, self.frames.now[0]), b, self.frames.now[1])
    }
}

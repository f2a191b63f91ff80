//! Mass and damping of the bodies, and the matrices of implicit increments made of them.

use std::borrow::Cow;
use std::sync::Arc;

use super::spin::mobility;
use crate::body::couplings::motion;
use crate::body::{MassKind, mass};
use crate::contact::interface::Interface;
use crate::linear::{BlockCsr, Factor, GmresSettings, Isotropic, Symbolic, gmres};
use crate::math::vector::dot;
use crate::model::contact::Contact;
use crate::model::definition::{ContactMass, Dynamic, Model};
use crate::system::{Cause, Links, StepFailure};
use crate::time::scheme::Alphas;
use crate::tolerance::SAME;

/// What resists acceleration and velocity.
pub(crate) struct Inertia {
    mass_kind: MassKind,
    /// Whether the points of each interface have none.
    redistributed: Vec<bool>,
    /// `M`, over all dofs.
    mass: BlockCsr,
    /// The same in fewer numbers, where no rigid body turns.
    masses: Option<Isotropic>,
    /// `C`, where a body has Rayleigh damping.
    pub damping: Option<BlockCsr>,
    /// Dofs whose mass was given to their neighbours.
    pub light: Vec<bool>,
    /// Dofs of reference points that have no mass or no moment of inertia: what couplings tie to them says where they go.
    pub bare: Vec<bool>,
    matrices: Vec<Matrix>,
    keys: u64,
}

/// The matrix of increments of one length.
struct Matrix {
    key: u64,
    dt: f64,
    alphas: Alphas,
    weight: f64,
    damped: bool,
    values: BlockCsr,
    diagonal: Vec<f64>,
}

/// What [`Inertia`] was made of: enough to make it again, with the same bits.
#[derive(Debug, Clone, crate::keep::Keep)]
pub(crate) struct InertiaRecipe {
    mass_kind: MassKind,
    redistributed: Vec<bool>,
    matrices: Vec<MatrixRecipe>,
    keys: u64,
}

#[derive(Debug, Clone, Copy, crate::keep::Keep)]
struct MatrixRecipe {
    key: u64,
    dt: f64,
    alphas: Alphas,
    weight: f64,
    damped: bool,
}

/// What the matrix of an increment depends on.
pub(crate) struct IncrementMatrix {
    /// The scheme.
    pub alphas: Alphas,
    /// About its length.
    pub dt: f64,
    /// The weight that interfaces have in the balance.
    pub weight: f64,
    /// Whether Rayleigh damping acts.
    pub damped: bool,
}

/// Most matrices that are kept.
const MOST_MATRICES: usize = 4;

impl Inertia {
    /// Assembles the mass; `stiffness` gives the pattern.
    pub fn new(
        model: &Model,
        contact: &Contact,
        stiffness: &BlockCsr,
        dynamic: &Dynamic,
        before: u64,
    ) -> Self {
        let redistributed = redistributed(contact, dynamic);
        Inertia::of(
            model,
            contact,
            stiffness,
            dynamic.mass,
            redistributed,
            before,
        )
    }

    /// The same with masses that are given to points in a way that is known.
    fn of(
        model: &Model,
        contact: &Contact,
        stiffness: &BlockCsr,
        mass_kind: MassKind,
        redistributed: Vec<bool>,
        before: u64,
    ) -> Self {
        let dim = model.dofs.dim;
        let mut light = light_points(model, contact, &redistributed);
        let mut mass = stiffness.zeros_like();
        for body in &model.bodies {
            if body.rigid.is_some() {
                light[body.points.clone()].fill(false);
            } else if !mass::add_mass(&body.elastic, mass_kind, &light, &mut mass) {
                body.points.clone().for_each(|p| light[p] = false);
            }
        }
        add_rigid_mass(model, &mut mass);
        for &(point, m) in &model.actions.masses {
            (0..dim).for_each(|i| mass.add_diagonal(model.dofs.of(point, i), m));
        }
        let damping = damping(model, stiffness, &mass);
        let bare = bare(model, &mass.diagonal());
        Inertia {
            mass_kind,
            redistributed,
            masses: Isotropic::of(&mass),
            mass,
            damping,
            bare,
            light: light
                .iter()
                .flat_map(|&l| std::iter::repeat_n(l, dim))
                .collect(),
            matrices: Vec::new(),
            keys: before,
        }
    }

    /// That of modes: all points have their masses.
    pub fn of_modes(
        model: &Model,
        contact: &Contact,
        stiffness: &BlockCsr,
        kind: MassKind,
    ) -> Self {
        let none = vec![false; contact.interfaces.len()];
        Inertia::of(model, contact, stiffness, kind, none, 0)
    }

    /// Mass and damping.
    pub fn into_matrices(self) -> (BlockCsr, Option<BlockCsr>) {
        (self.mass, self.damping)
    }

    /// The mass that a push on a point of the mesh meets `[kg]`; of a rigid body all of it, turned as it is by the push.
    pub fn at_points(&self, model: &Model) -> Vec<f64> {
        let size = model.dofs.dim * model.dofs.dim;
        let rigid = mobility(model);
        (0..model.mesh.points.len())
            .map(|p| {
                let row = self.mass.row_blocks(p).chunks(size);
                let own: f64 = row.map(|block| block[0]).sum();
                if rigid[p] > 0.0 { 1.0 / rigid[p] } else { own }
            })
            .collect()
    }

    /// Whether it serves a step with these settings.
    pub fn suits(&self, contact: &Contact, dynamic: &Dynamic) -> bool {
        self.mass_kind == dynamic.mass && self.redistributed == redistributed(contact, dynamic)
    }

    /// The last key given to a matrix.
    pub fn keys(&self) -> u64 {
        self.keys
    }

    /// Dofs that have the mean velocity of an increment; of the points of rigid bodies those that only fixed dofs move.
    pub fn plain(&self, fixed: &[bool], links: &Links, damped: bool) -> Vec<bool> {
        let damped = damped && self.damping.is_some();
        let light = self.light.iter().map(|&l| l && !damped);
        let mut plain: Vec<bool> = light.zip(fixed).map(|(l, &f)| l || f).collect();
        links.still(fixed, &mut plain);
        plain
    }

    /// Lets what has no inertia go on at `t` as what it is tied to does, where it is free to: `x` are velocities or accelerations that impulses have changed.
    pub fn lead(&self, model: &Model, contact: &Contact, t: f64, fixed: &[bool], x: &mut [f64]) {
        let free = self.bare.iter().zip(fixed).map(|(b, f)| *b && !f);
        let free: Vec<bool> = free.collect();
        motion::follow(&contact.couplings, t, &model.links, &free, x);
    }

    /// Makes the matrix for increments of about `dt` ready and returns the `dt` it is for.
    ///
    /// `A = [(1 - α_m) / (β dt²) M + (1 - α_f) (γ / (β dt) C + K)] / weight`, the derivative of the balance at the stage with respect to the
    /// displacement at the end, over the weight that the interfaces have in it.
    pub fn ready(&mut self, stiffness: &BlockCsr, wanted: IncrementMatrix) -> f64 {
        let IncrementMatrix {
            alphas,
            dt,
            weight,
            damped,
        } = wanted;
        let found = self.matrices.iter().position(|m| {
            // Rounding of times leaves such a difference of lengths.
            (m.dt - dt).abs() <= SAME * dt
                && m.alphas == alphas
                && m.weight == weight
                && m.damped == damped
        });
        let matrix = match found {
            Some(i) => self.matrices.remove(i),
            None => {
                self.keys += 1;
                let recipe = MatrixRecipe {
                    key: self.keys,
                    dt,
                    alphas,
                    weight,
                    damped,
                };
                self.make(stiffness, recipe)
            }
        };
        if self.matrices.len() == MOST_MATRICES {
            self.matrices.remove(0);
        }
        let dt = matrix.dt;
        self.matrices.push(matrix);
        dt
    }

    fn make(&self, stiffness: &BlockCsr, recipe: MatrixRecipe) -> Matrix {
        let MatrixRecipe {
            key,
            dt,
            alphas,
            weight,
            damped,
        } = recipe;
        let [mass, damping, elastic] = factors(alphas, dt, weight);
        let mut values = self.mass.zeros_like();
        values.add_scaled(mass, &self.mass);
        if let Some(matrix) = self.damping.as_ref().filter(|_| damped) {
            values.add_scaled(damping, matrix);
        }
        values.add_scaled(elastic, stiffness);
        Matrix {
            key,
            dt,
            alphas,
            weight,
            damped,
            diagonal: values.diagonal(),
            values,
        }
    }

    /// What it was made of.
    pub fn recipe(&self) -> InertiaRecipe {
        let recipe = |m: &Matrix| MatrixRecipe {
            key: m.key,
            dt: m.dt,
            alphas: m.alphas,
            weight: m.weight,
            damped: m.damped,
        };
        InertiaRecipe {
            mass_kind: self.mass_kind,
            redistributed: self.redistributed.clone(),
            matrices: self.matrices.iter().map(recipe).collect(),
            keys: self.keys,
        }
    }

    /// Makes it again.
    pub fn again(
        model: &Model,
        contact: &Contact,
        stiffness: &BlockCsr,
        recipe: InertiaRecipe,
    ) -> Self {
        let (kind, redistributed, keys) = (recipe.mass_kind, recipe.redistributed, recipe.keys);
        let mut inertia = Inertia::of(model, contact, stiffness, kind, redistributed, keys);
        for matrix in recipe.matrices {
            let made = inertia.make(stiffness, matrix);
            inertia.matrices.push(made);
        }
        inertia
    }

    /// The matrix of a key, as long as it is kept.
    pub fn matrix_of(&self, key: u64) -> Option<&BlockCsr> {
        let mut all = self.matrices.iter();
        all.find(|m| m.key == key).map(|m| &m.values)
    }

    /// The matrix made ready last, its diagonal and its key.
    pub fn matrix(&self) -> (&BlockCsr, &[f64], u64) {
        let m = (self.matrices.last()).expect("the matrix of this length was made");
        (&m.values, &m.diagonal, m.key)
    }

    /// `A x` of the matrix made ready last, from `K x`.
    pub fn stage_times(&self, x: &[f64], stiffness_x: &[f64]) -> Vec<f64> {
        let Some(m) = self.matrices.last() else {
            return vec![0.0; x.len()];
        };
        let [mass, damping, stiffness] = factors(m.alphas, m.dt, m.weight);
        let mut out = self.mass_times(x);
        for (o, k) in out.iter_mut().zip(stiffness_x) {
            *o = mass * *o + stiffness * k;
        }
        if let Some(c) = self.damping.as_ref().filter(|_| m.damped) {
            for (o, c) in out.iter_mut().zip(times(c, x)) {
                *o += damping * c;
            }
        }
        out
    }

    /// `M x`.
    pub fn mass_times(&self, x: &[f64]) -> Vec<f64> {
        let mut out = vec![0.0; x.len()];
        match &self.masses {
            Some(masses) => masses.mul(x, &mut out),
            None => self.mass.mul(x, &mut out),
        }
        out
    }

    /// `vᵀ M v / 2`.
    pub fn kinetic_energy(&self, v: &[f64]) -> f64 {
        0.5 * dot(v, &self.mass_times(v))
    }

    /// Gives the accelerations that forces cause of the dofs that are neither fixed nor without mass: `(M + h C) a = f`.
    ///
    /// Damping that is stiff needs many iterations; then the matrix is factored, once.
    pub fn accelerator<'a>(
        &'a self,
        fixed: &[bool],
        lag: f64,
    ) -> impl FnMut(&[f64]) -> Result<Vec<f64>, StepFailure> + 'a {
        let none = self.light.iter().zip(&self.bare).map(|(l, b)| l | b);
        let out: Vec<bool> = fixed.iter().zip(none).map(|(f, n)| f | n).collect();
        let matrix = match &self.damping {
            Some(damping) if lag > 0.0 => {
                let mut both = self.mass.clone();
                both.add_scaled(lag, damping);
                Cow::Owned(both)
            }
            _ => Cow::Borrowed(&self.mass),
        };
        let diagonal = matrix.diagonal();
        let mut factor: Option<Factor> = None;
        move |force| {
            let mut b: Vec<f64> = force
                .iter()
                .zip(&out)
                .map(|(f, &out)| if out { 0.0 } else { *f })
                .collect();
            if let Some(factor) = &factor {
                factor.solve(&mut b);
                return Ok(b);
            }
            let mut a = vec![0.0; b.len()];
            let report = gmres(
                &mut |v, result| {
                    matrix.mul(v, result);
                    for (r, &out) in result.iter_mut().zip(&out) {
                        if out {
                            *r = 0.0;
                        }
                    }
                },
                &mut |v| {
                    for ((v, d), &out) in v.iter_mut().zip(&diagonal).zip(&out) {
                        *v = if out { 0.0 } else { *v / d };
                    }
                },
                &b,
                &mut a,
                GmresSettings {
                    tolerance: 1e-13,
                    max_iterations: 400,
                    restart: 60,
                },
            );
            if report.relative_residual <= 1e-9 {
                return Ok(a);
            }
            let singular = || {
                StepFailure::new(
                    Cause::Singular,
                    "the acceleration at the start cannot be found: the mass matrix is singular",
                )
                .help("give every material a density")
            };
            let symbolic = Symbolic::analyze(&matrix, &out, &[]).map_err(|_| singular())?;
            let made = Factor::new(&Arc::new(symbolic), &matrix, &[]).map_err(|_| singular())?;
            made.solve(&mut b);
            factor = Some(made);
            Ok(b)
        }
    }
}

/// Interfaces whose points have their mass given to their neighbours. What is tied neither closes nor opens: it moves as one, and keeps its inertia.
fn redistributed(contact: &Contact, dynamic: &Dynamic) -> Vec<bool> {
    let wanted = |interface: &Interface| match dynamic.contact_mass {
        Some(ContactMass::Redistributed) => true,
        Some(ContactMass::AsMeshed) => false,
        // A compliant law stops a mass gently.
        None => interface.laws.set_valued(),
    };
    let interfaces = contact.interfaces.iter();
    interfaces.map(|i| !i.laws.tied && wanted(i)).collect()
}

/// Points whose mass is to be given to their neighbours. Where a body has no others, and in rigid bodies, they keep it all the same.
pub(crate) fn light(model: &Model, contact: &Contact, dynamic: &Dynamic) -> Vec<bool> {
    light_points(model, contact, &redistributed(contact, dynamic))
}

/// The same where it is known which interfaces hand on their masses.
fn light_points(model: &Model, contact: &Contact, redistributed: &[bool]) -> Vec<bool> {
    let mut light = vec![false; model.dofs.points];
    for (interface, &wanted) in contact.interfaces.iter().zip(redistributed) {
        if wanted {
            // The numbering of an interface has the nodes of both sides. A primary point with mass would ring against the secondary
            // as a secondary one does against a wall.
            for &node in &interface.nodes {
                light[node] = true;
            }
        }
    }
    // What is fixed to a point keeps it from following others without inertia.
    model
        .actions
        .masses
        .iter()
        .for_each(|(p, _)| light[*p] = false);
    light
}

/// Dofs of reference points that have no inertia, given the diagonal of the mass.
fn bare(model: &Model, diagonal: &[f64]) -> Vec<bool> {
    let mut bare = vec![false; diagonal.len()];
    for reference in &model.references {
        let hidden = model.links.all()[reference.link].hidden;
        let first = model.dofs.of(hidden, 0);
        for dof in first..first + 2 * model.dofs.dim {
            bare[dof] = diagonal[dof] == 0.0;
        }
    }
    bare
}

/// The factors of mass, damping and stiffness in the matrix of an increment.
fn factors(alphas: Alphas, dt: f64, weight: f64) -> [f64; 3] {
    let Alphas {
        alpha_m,
        alpha_f,
        beta,
        gamma,
    } = alphas;
    [
        (1.0 - alpha_m) / (beta * dt * dt * weight),
        (1.0 - alpha_f) * gamma / (beta * dt * weight),
        (1.0 - alpha_f) / weight,
    ]
}

/// Lumped masses of the elastic bodies and of what is fixed to points, by point.
pub(crate) fn lumped(model: &Model) -> Vec<f64> {
    let mut masses = vec![0.0; model.dofs.points];
    for body in model.elastic() {
        mass::add_lumped_mass(&body.elastic, &mut masses);
    }
    for &(point, m) in &model.actions.masses {
        masses[point] += m;
    }
    masses
}

/// Adds the masses and moments of inertia of rigid bodies at their hidden points.
fn add_rigid_mass(model: &Model, matrix: &mut BlockCsr) {
    let dim = model.dofs.dim;
    for rigid in model.rigid() {
        let hidden = model.links.all()[rigid.link].hidden;
        for i in 0..dim {
            matrix.add_diagonal(model.dofs.of(hidden, i), rigid.mass);
        }
        let rows = rigid.spin.iter().take(dim);
        let dense: Vec<f64> = rows.flat_map(|row| row[..dim].to_vec()).collect();
        matrix.add_group(&[hidden + 1], &dense);
    }
}

/// `Σ α M + β K` over the bodies that have Rayleigh damping.
fn damping(model: &Model, stiffness: &BlockCsr, mass: &BlockCsr) -> Option<BlockCsr> {
    if model.bodies.iter().all(|b| b.rayleigh == [0.0; 2]) {
        return None;
    }
    let mut out = stiffness.zeros_like();
    for body in &model.bodies {
        let [alpha, beta] = body.rayleigh;
        if beta != 0.0 {
            body.elastic.element_matrices(&mut |points, dense| {
                let dense: Vec<f64> = dense.iter().map(|k| beta * k).collect();
                out.add_group(points, &dense);
            });
        }
        if alpha != 0.0 {
            // Bodies share no points: the rows of a body in `mass` are its own.
            out.add_scaled_rows(alpha, mass, body.points.clone());
        }
    }
    Some(out)
}

/// `A x`.
pub(crate) fn times(matrix: &BlockCsr, x: &[f64]) -> Vec<f64> {
    let mut out = vec![0.0; x.len()];
    matrix.mul(x, &mut out);
    out
}

/// What was made ready when a step in motion began.
pub(crate) fn in_motion(inertia: &Option<Inertia>) -> &Inertia {
    (inertia.as_ref()).expect("a step in motion has begun with its masses")
}

//! The numbers that a scheme of integration is.

/// The parameters of the implicit kernel `[-]`.
///
/// Balance is asked for at a stage between the ends of the increment,
/// `M a_m + C v_f + f(u_f) = F_f` with `x_f = (1 - α_f) x₁ + α_f x₀` and `a_m = (1 - α_m) a₁ + α_m a₀`, and displacements and velocities follow
/// [`newmark_1959`](crate::references::newmark_1959).
#[derive(Debug, Clone, Copy, PartialEq, crate::keep::Keep)]
pub struct Alphas {
    /// Weight of the old acceleration.
    pub alpha_m: f64,
    /// Weight of the old displacement, velocity and load.
    pub alpha_f: f64,
    /// Newmark's β.
    pub beta: f64,
    /// Newmark's γ.
    pub gamma: f64,
}

impl Alphas {
    /// The time over which damping should have acted on the accelerations at the start, in first increments `[-]`; zero where it need not.
    ///
    /// The velocity of a strongly damped motion follows from the balance at the end of the increment, and Newmark's relations then leave
    /// `(½ - β/γ) dt² a₀` of the acceleration at the start in the displacements, however soon damping has put an end to it: without bound where damping is
    /// stiff against the increment. Three times the ratio of that to `dt²/2` keeps it below a third of the displacement at the velocity to which
    /// loads and damping come.
    pub fn lag(&self) -> f64 {
        3.0 * (1.0 - 2.0 * self.beta / self.gamma).abs()
    }
}

/// What a scheme comes down to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Method {
    /// Equations are solved in every increment.
    Implicit(Alphas),
    /// No equations; the increment is bounded by stability.
    Explicit {
        /// Fraction of the stable increment that is used.
        safety: f64,
        /// Increment `[s]` to which masses are raised where the stable one is smaller.
        mass_scaling: Option<f64>,
    },
}

/// A scheme.
pub trait Scheme: Send + Sync {
    /// How it integrates.
    fn method(&self) -> Method;

    /// What is wrong with the parameters, as `(key, message)`; empty if nothing.
    fn faults(&self) -> Vec<(&'static str, String)>;
}

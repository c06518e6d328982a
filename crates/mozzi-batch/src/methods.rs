//! The methods of a batch, one for each quantity: their tables, numbers a state, and the kernel.

use crate::quantity as q;
use crate::{Batch, BatchEnvironment, Error};
use mozzi::simulation::Method;
use mozzi::{Environment, FrameId, Task};

/// The wrenches alone.
fn of_wrenches<T>(all: BatchEnvironment<T>) -> BatchEnvironment<T> {
    let environment =
        Environment { applied: all.environment.applied, ..Environment::with_gravity(mozzi::Vec3::zero()) };
    BatchEnvironment { environment, ..all }
}

/// Methods: their tables, numbers a state, and the kernel.
macro_rules! methods {
    ($(
        $(#[$doc:meta])*
        $name:ident($([$frame:ident])? $($input:ident: $in_width:ident),*; $($surroundings:ident $(|$given:ident| $part:expr)?)?) -> $($output:ident: |$n:ident| $out_width:expr),* => $Q:expr;
    )*) => {
        methods!(@of f64; $($(#[$doc])* $name($([$frame])? $($input: $in_width),*; $($surroundings $(|$given| $part)?)?) -> $($output: |$n| $out_width),* => $Q;)*);
        methods!(@of f32; $($(#[$doc])* $name($([$frame])? $($input: $in_width),*; $($surroundings $(|$given| $part)?)?) -> $($output: |$n| $out_width),* => $Q;)*);
    };
    // of each number, not of any: so they are compiled once, here
    (@of $T:ty; $(
        $(#[$doc:meta])*
        $name:ident($([$frame:ident])? $($input:ident: $in_width:ident),*; $($surroundings:ident $(|$given:ident| $part:expr)?)?) -> $($output:ident: |$n:ident| $out_width:expr),* => $Q:expr;
    )*) => { impl Batch<$T> { $(
        $(#[$doc])*
        #[allow(clippy::too_many_arguments)] // the kernel's
        pub fn $name(
            &self, $($frame: FrameId,)? $($input: &[$T],)* $($surroundings: &BatchEnvironment<$T>,)? $($output: &mut [$T]),*
        ) -> Result<(), Error> {
            $(self.model().check_frame($frame)?;)?
            let inputs = [$((stringify!($input), ($input, self.model().$in_width()))),*];
            let outputs = vec![$((stringify!($output), ($output, { let $n = self.model().n(); $out_width }))),*];
            #[allow(unused_mut, unused_assignments)] // of a quantity that nothing surrounds
            let mut all = BatchEnvironment::from(Environment::with_gravity(mozzi::Vec3::zero()));
            $(all = *$surroundings; $(let $given = all; all = $part;)?)?
            self.run(&$Q, &inputs, outputs, all)
        }
    )*
        /// Λ (N, k, k) and η (N, k) of the k rows of a task, of θ and θ̇: see [`mozzi::task_space_dynamics`].
        ///
        /// # Errors
        /// A task that is none; tables of a wrong length; a state's error with its number: of a singular mass matrix or a singular task the
        /// first, after all states are computed.
        pub fn task_space_dynamics(
            &self,
            task: Task,
            theta: &[$T],
            dtheta: &[$T],
            surroundings: &BatchEnvironment<$T>,
            Lambda: &mut [$T],
            eta: &mut [$T],
        ) -> Result<(), Error> {
            task.check(self.model())?;
            let (nq, n, k) = (self.model().nq(), self.model().n(), task.rows.len());
            let inputs = [("theta", (theta, nq)), ("dtheta", (dtheta, n))];
            let outputs = vec![("Lambda", (Lambda, k * k)), ("eta", (eta, k))];
            self.run(&q::TaskSpaceDynamics(task), &inputs, outputs, *surroundings)
        }

        /// (θ, θ̇) (N, nq) and (N, n) of every robot after `steps` steps of a method over `duration` seconds, in place, under torques τ (N, n)
        /// and surroundings that stay as they are: a controller's interval. See [`mozzi::simulation`].
        ///
        /// # Errors
        /// Tables of a wrong length; a state's error with its number: of a singular mass matrix, or of one that left the numbers, after its
        /// neighbours were computed.
        #[allow(clippy::too_many_arguments)] // a state, what drives it, and how
        pub fn simulate(
            &self,
            theta: &mut [$T],
            dtheta: &mut [$T],
            tau: &[$T],
            surroundings: &BatchEnvironment<$T>,
            method: Method,
            duration: f64,
            steps: usize,
        ) -> Result<(), Error> {
            self.simulate_all([theta, dtheta], tau, surroundings, (method, duration, steps))
        }
    } };
}

methods! {
    /// τ (N, n) of θ (N, nq), θ̇ and θ̈ (N, n): see [`mozzi::inverse_dynamics`].
    ///
    /// # Errors
    /// Tables of a wrong length; a state's error with its number.
    inverse_dynamics(theta: nq, dtheta: n, ddtheta: n; surroundings) -> tau: |n| n => q::InverseDynamics;
    /// θ̈ (N, n) of θ (N, nq), θ̇ and τ (N, n): see [`mozzi::forward_dynamics`].
    ///
    /// # Errors
    /// Tables of a wrong length; a state's error with its number: of a singular mass matrix the first, after all states are computed.
    forward_dynamics(theta: nq, dtheta: n, tau: n; surroundings) -> ddtheta: |n| n => q::ForwardDynamics;
    /// M (N, n, n) of θ: see [`mozzi::mass_matrix`].
    ///
    /// # Errors
    /// Tables of a wrong length; a state's error with its number.
    mass_matrix(theta: nq; ) -> M: |n| n * n => q::MassMatrix;
    /// Ṁ (N, n, n) of θ and θ̇: see [`mozzi::mass_matrix_rate`].
    ///
    /// # Errors
    /// Tables of a wrong length; a state's error with its number.
    mass_matrix_rate(theta: nq, dtheta: n; ) -> dM: |n| n * n => q::CoriolisMatrix { rate: true };
    /// C (N, n, n) of θ and θ̇: see [`mozzi::coriolis_matrix`].
    ///
    /// # Errors
    /// Tables of a wrong length; a state's error with its number.
    coriolis_matrix(theta: nq, dtheta: n; ) -> C: |n| n * n => q::CoriolisMatrix { rate: false };
    /// c (N, n) of θ and θ̇: see [`mozzi::velocity_product`].
    ///
    /// # Errors
    /// Tables of a wrong length; a state's error with its number.
    velocity_product(theta: nq, dtheta: n; ) -> c: |n| n => q::BiasForces { at_rest: false };
    /// g (N, n) of θ, in the environment's gravity: see [`mozzi::gravity_forces`].
    ///
    /// # Errors
    /// Tables of a wrong length; a state's error with its number.
    gravity_forces(theta: nq; surroundings |given| Environment::with_gravity(given.environment.gravity).into()) -> g: |n| n => q::BiasForces { at_rest: true };
    /// h = c + g and what the surroundings add (N, n), of θ and θ̇: see [`mozzi::bias_forces`].
    ///
    /// # Errors
    /// Tables of a wrong length; a state's error with its number.
    bias_forces(theta: nq, dtheta: n; surroundings) -> h: |n| n => q::BiasForces { at_rest: false };
    /// JᵀF (N, n) of the surroundings' wrenches: see [`mozzi::tip_forces`].
    ///
    /// # Errors
    /// Tables of a wrong length; a state's error with its number.
    tip_forces(theta: nq; surroundings |given| of_wrenches(given)) -> tau: |n| n => q::BiasForces { at_rest: true };
    /// ½θ̇ᵀMθ̇ (N): see [`mozzi::kinetic_energy`]; the surroundings' base twist counts.
    ///
    /// # Errors
    /// Tables of a wrong length; a state's error with its number.
    kinetic_energy(theta: nq, dtheta: n; surroundings) -> energy: |_n| 1 => q::KineticEnergy;
    /// The potential energy (N) in the surroundings' gravity: see [`mozzi::potential_energy`].
    ///
    /// # Errors
    /// Tables of a wrong length; a state's error with its number.
    potential_energy(theta: nq; surroundings) -> energy: |_n| 1 => q::PotentialEnergy;
    /// `T_sb` (N, 4, 4) of a frame {b}: see [`mozzi::forward_kinematics`].
    ///
    /// # Errors
    /// A frame of another model; tables of a wrong length; a state's error with its number.
    forward_kinematics([frame] theta: nq; ) -> T: |_n| 16 => q::ForwardKinematics(frame);
    /// `J_s` (N, 6, n): see [`mozzi::space_jacobian`].
    ///
    /// # Errors
    /// A frame of another model; tables of a wrong length; a state's error with its number.
    space_jacobian([frame] theta: nq; ) -> J: |n| 6 * n => q::SpaceJacobian(frame);
    /// `J_b` (N, 6, n): see [`mozzi::body_jacobian`].
    ///
    /// # Errors
    /// A frame of another model; tables of a wrong length; a state's error with its number.
    body_jacobian([frame] theta: nq; ) -> J: |n| 6 * n => q::BodyJacobian(frame);
    /// d`J_s`/dt (N, 6, n): see [`mozzi::space_jacobian_rate`].
    ///
    /// # Errors
    /// A frame of another model; tables of a wrong length; a state's error with its number.
    space_jacobian_rate([frame] theta: nq, dtheta: n; ) -> dJ: |n| 6 * n => q::SpaceJacobianRate(frame);
    /// d`J_b`/dt (N, 6, n): see [`mozzi::body_jacobian_rate`].
    ///
    /// # Errors
    /// A frame of another model; tables of a wrong length; a state's error with its number.
    body_jacobian_rate([frame] theta: nq, dtheta: n; ) -> dJ: |n| 6 * n => q::BodyJacobianRate(frame);
    /// ∂τ/∂θ, ∂τ/∂θ̇ and ∂τ/∂θ̈ = M (N, n, n): see [`mozzi::inverse_dynamics_derivatives`].
    ///
    /// # Errors
    /// Tables of a wrong length; a state's error with its number.
    inverse_dynamics_derivatives(theta: nq, dtheta: n, ddtheta: n; surroundings)
        -> d_theta: |n| n * n, d_dtheta: |n| n * n, d_ddtheta: |n| n * n => q::InverseDynamicsDerivatives;
    /// θ̈ (N, n); ∂θ̈/∂θ, ∂θ̈/∂θ̇ and ∂θ̈/∂τ = M⁻¹ (N, n, n): see [`mozzi::forward_dynamics_derivatives`].
    ///
    /// # Errors
    /// Tables of a wrong length; a state's error with its number: of a singular mass matrix the first, after all states are computed.
    forward_dynamics_derivatives(theta: nq, dtheta: n, tau: n; surroundings)
        -> ddtheta: |n| n, d_theta: |n| n * n, d_dtheta: |n| n * n, d_tau: |n| n * n => q::ForwardDynamicsDerivatives;
}

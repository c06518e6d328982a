//! What can be recorded of a robot.

use crate::program::Program;
use crate::record::record;
use crate::traced::Traced;
use mozzi::{self as kernel, Environment, FrameId, Model, SE3, Scalar, Twist, Vec3, Workspace, Wrench};

/// A quantity of a robot, with its inputs and outputs in the program's order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Quantity {
    /// τ(θ, θ̇, θ̈), see [`inverse_dynamics`](kernel::inverse_dynamics()).
    InverseDynamics,
    /// M(θ), n × n by rows, see [`mass_matrix`](kernel::mass_matrix()).
    MassMatrix,
    /// θ̈(θ, θ̇, τ), and the pivots that it divides by, see [`forward_dynamics`](kernel::forward_dynamics()). By articulated bodies or by
    /// the mass matrix, whichever is less work for this robot.
    ForwardDynamics,
    /// h(θ, θ̇), see [`bias_forces`](kernel::bias_forces()).
    BiasForces,
    /// c(θ, θ̇), see [`velocity_product`](kernel::velocity_product).
    VelocityProduct,
    /// g(θ), see [`gravity_forces`](kernel::gravity_forces).
    GravityForces,
    /// `T_sb`(θ) of a frame: R by rows, then p. See [`forward_kinematics`](kernel::forward_kinematics).
    ForwardKinematics(FrameId),
    /// `J_b`(θ) of a frame, by columns of six. See [`body_jacobian`](kernel::body_jacobian).
    BodyJacobian(FrameId),
    /// `J_s`(θ) of a frame, by columns of six. See [`space_jacobian`](kernel::space_jacobian).
    SpaceJacobian(FrameId),
    /// ∂τ/∂θ, ∂τ/∂θ̇ and ∂τ/∂θ̈ = M at (θ, θ̇, θ̈), see [`inverse_dynamics_derivatives`](kernel::inverse_dynamics_derivatives()).
    InverseDynamicsDerivatives,
    /// θ̈, ∂θ̈/∂θ, ∂θ̈/∂θ̇, ∂θ̈/∂τ = M⁻¹ at (θ, θ̇, τ), and the pivots; see
    /// [`forward_dynamics_derivatives`](kernel::forward_dynamics_derivatives()).
    ForwardDynamicsDerivatives,
}

use Quantity::*;

/// What of the robot stays an input of the program, further arrays after the state in this order. By default nothing does: all numbers
/// of the robot are in the program, and what is multiplied by a zero of them is not.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Arguments {
    /// `parameters`: [`Model::parameters`], the masses, inertias and frictions. Geometry stays fixed.
    pub parameters: bool,
    /// `gravity`: three numbers, in {s}.
    pub gravity: bool,
    /// `wrench`: six numbers (m, f), what this frame applies to the environment, in its own coordinates: a tool's load, a push.
    pub wrench: Option<FrameId>,
}

impl Quantity {
    /// Its name, as of the kernel.
    pub fn name(self) -> &'static str {
        match self {
            InverseDynamics => "inverse_dynamics",
            MassMatrix => "mass_matrix",
            ForwardDynamics => "forward_dynamics",
            BiasForces => "bias_forces",
            VelocityProduct => "velocity_product",
            GravityForces => "gravity_forces",
            ForwardKinematics(_) => "forward_kinematics",
            BodyJacobian(_) => "body_jacobian",
            SpaceJacobian(_) => "space_jacobian",
            InverseDynamicsDerivatives => "inverse_dynamics_derivatives",
            ForwardDynamicsDerivatives => "forward_dynamics_derivatives",
        }
    }

    /// The frame that it is of.
    pub fn frame(self) -> Option<FrameId> {
        match self {
            ForwardKinematics(frame) | BodyJacobian(frame) | SpaceJacobian(frame) => Some(frame),
            _ => None,
        }
    }

    /// The arrays of the state that it depends on.
    pub fn state(self) -> &'static [&'static str] {
        match self {
            MassMatrix | GravityForces | ForwardKinematics(_) | BodyJacobian(_) | SpaceJacobian(_) => &["theta"],
            BiasForces | VelocityProduct => &["theta", "dtheta"],
            InverseDynamics | InverseDynamicsDerivatives => &["theta", "dtheta", "ddtheta"],
            ForwardDynamics | ForwardDynamicsDerivatives => &["theta", "dtheta", "tau"],
        }
    }

    /// Its program for this robot.
    ///
    /// # Panics
    /// When a frame is not this model's.
    pub fn record(self, model: &Model, open: Arguments) -> Program {
        match self {
            ForwardDynamics if !model.has_mimic_joints() => {
                let by = [false, true].map(|by_mass_matrix| self.record_by(model, open, by_mass_matrix));
                by.into_iter().min_by_key(work).expect("two ways")
            }
            _ => self.record_by(model, open, false),
        }
    }

    fn record_by(self, model: &Model, open: Arguments, by_mass_matrix: bool) -> Program {
        let model = &model.reduced();
        let length = |name: &str| if name == "theta" { model.nq() } else { model.n() };
        let mut inputs: Vec<(&str, usize)> = self.state().iter().map(|&name| (name, length(name))).collect();
        let state = inputs.len();
        inputs.extend(open.parameters.then(|| ("parameters", model.parameter_count())));
        inputs.extend(open.gravity.then_some(("gravity", 3)));
        inputs.extend(open.wrench.map(|_| ("wrench", 6)));
        record(self.name(), &inputs, |arrays| {
            let (state, mut rest) = arrays.split_at(state);
            let state: Vec<&[Traced]> = state.iter().map(Vec::as_slice).collect();
            let mut further = |is_open: bool| {
                let (first, others) = rest.split_first().filter(|_| is_open)?;
                rest = others;
                Some(&first[..])
            };
            let parameters = further(open.parameters);
            let gravity = further(open.gravity).and_then(<[_]>::first_chunk).copied();
            let wrench = further(open.wrench.is_some()).and_then(<[_]>::first_chunk).copied();
            let applied: Vec<_> = open.wrench.zip(wrench.map(Wrench::from_array)).into_iter().collect();
            let gravity = Vec3(gravity.unwrap_or(model.gravity().0.map(Traced::from)));
            let environment = Environment { applied: &applied, ..Environment::with_gravity(gravity) };
            match parameters {
                Some(parameters) => {
                    self.compute(&model.with_parameters(parameters), &state, &environment, by_mass_matrix)
                }
                None => self.compute(model, &state, &environment, by_mass_matrix),
            }
        })
    }

    /// Its outputs with their names, by the kernels.
    pub(crate) fn compute<S: Scalar + From<C>, C: Scalar>(
        self,
        model: &Model<C>,
        state: &[&[S]],
        environment: &Environment<S>,
        by_mass_matrix: bool,
    ) -> Vec<(&'static str, Vec<S>)> {
        let (n, mut w) = (model.n(), Workspace::<S>::new(model));
        let theta = state[0];
        let (dtheta, third) = (state.get(1).unwrap_or(&theta), state.get(2).unwrap_or(&theta));
        let (mut x, mut X) = (vec![S::zero(); n], vec![S::zero(); n * n]);
        match self {
            InverseDynamics => {
                kernel::inverse_dynamics(model, theta, dtheta, third, environment, &mut w, &mut x);
                vec![("tau", x)]
            }
            MassMatrix => {
                kernel::mass_matrix(model, theta, &mut w, &mut X);
                vec![("M", X)]
            }
            ForwardDynamics => {
                if by_mass_matrix {
                    let M = &mut X;
                    kernel::forward_dynamics_by_mass_matrix(
                        model,
                        theta,
                        dtheta,
                        third,
                        environment,
                        &mut w,
                        M,
                        &mut x,
                    );
                } else {
                    kernel::forward_dynamics(model, theta, dtheta, third, environment, &mut w, &mut x);
                }
                vec![("ddtheta", x), ("pivots", w.pivots().to_vec())]
            }
            BiasForces => {
                kernel::bias_forces(model, theta, dtheta, environment, &mut w, &mut x);
                vec![("h", x)]
            }
            VelocityProduct => {
                kernel::velocity_product(model, theta, dtheta, &mut w, &mut x);
                vec![("c", x)]
            }
            GravityForces => {
                kernel::gravity_forces(model, theta, environment.gravity, &mut w, &mut x);
                vec![("g", x)]
            }
            ForwardKinematics(frame) => {
                let SE3 { R, p } = kernel::forward_kinematics(model, theta, frame);
                vec![("R", R.matrix().rows().concat()), ("p", p.0.to_vec())]
            }
            BodyJacobian(frame) => {
                let mut J = vec![Twist::zero(); n];
                kernel::body_jacobian(model, theta, frame, &mut J);
                vec![("J", J.into_iter().flat_map(Twist::to_array).collect())]
            }
            SpaceJacobian(frame) => {
                let mut J = vec![Twist::zero(); n];
                kernel::space_jacobian(model, theta, frame, &mut J);
                vec![("J", J.into_iter().flat_map(Twist::to_array).collect())]
            }
            InverseDynamicsDerivatives => {
                let mut by = [X.clone(), X.clone(), X];
                let slices = by.each_mut().map(|matrix| &mut matrix[..]);
                kernel::inverse_dynamics_derivatives(model, theta, dtheta, third, environment, &mut w, slices);
                ["d_theta", "d_dtheta", "d_ddtheta"].into_iter().zip(by).collect()
            }
            ForwardDynamicsDerivatives => {
                let mut by = [X.clone(), X.clone(), X];
                let slices = by.each_mut().map(|matrix| &mut matrix[..]);
                kernel::forward_dynamics_derivatives(model, theta, dtheta, third, environment, &mut w, &mut x, slices);
                let derivatives = ["d_theta", "d_dtheta", "d_tau"].into_iter().zip(by);
                [("ddtheta", x)].into_iter().chain(derivatives).chain([("pivots", w.pivots().to_vec())]).collect()
            }
        }
    }
}

/// Instructions, a division being as long as eight.
fn work(program: &Program) -> usize {
    let count = program.count();
    count.instructions() + 7 * (count.div + count.sqrt)
}

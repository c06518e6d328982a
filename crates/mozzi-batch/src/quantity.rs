//! What can be asked of a batch: each quantity is the kernel of that name on one register of states. Inputs and outputs lie one after the
//! other, in the kernel's order.

use crate::lanes::Lane;
use mozzi::dynamics as kernel;
use mozzi::{Environment, FrameId, Model, Task, TaskMemory, Twist, Workspace};

/// A kernel on registers.
pub(crate) trait Quantity: Sync {
    /// Does it divide by pivots that must be looked at?
    const PIVOTS: bool = false;

    fn evaluate<L: Lane>(
        &self,
        model: &Model<L::Number>,
        input: &[L],
        environment: &Environment<L>,
        memory: &mut Memory<L>,
        output: &mut [L],
    );

    /// A state whose pivots spread far, at one state and in f64: its error, if it has one.
    fn again(&self, _model: &Model, _state: &[Vec<f64>], _environment: &Environment) -> Result<(), mozzi::Error> {
        Ok(())
    }
}

/// Memory without meaning between calls.
pub(crate) struct Memory<L: Lane> {
    pub workspace: Workspace<L>,
    /// Columns of a Jacobian.
    pub columns: Vec<Twist<L>>,
    /// n of them.
    pub zeros: Vec<L>,
    /// Of task-space dynamics, with its rows, from the first call on.
    pub task: Option<(usize, TaskMemory<L>)>,
}

impl<L: Lane> Memory<L> {
    pub fn new(model: &Model<L::Number>) -> Self {
        Memory {
            workspace: Workspace::new(model),
            columns: vec![Twist::zero(); model.n()],
            zeros: vec![L::zero(); model.n()],
            task: None,
        }
    }
}

/// The first numbers of a list, and the rest.
macro_rules! split {
    ($list:expr => $($name:ident: $count:expr),*) => {
        let rest = $list;
        $(let ($name, rest) = rest.split_at($count);)*
        let _ = rest;
    };
}

macro_rules! quantity {
    ($Q:ident, $this:pat, [$model:ident, $environment:pat, $memory:pat, $output:ident]; $($name:ident: $count:expr),*; $(PIVOTS = $pivots:expr, $again:ident;)? $body:block) => {
        impl Quantity for $Q {
            $(const PIVOTS: bool = $pivots;)?
            #[inline(always)]
            fn evaluate<L: Lane>(
                &self, $model: &Model<L::Number>, input: &[L], $environment: &Environment<L>, $memory: &mut Memory<L>, $output: &mut [L],
            ) {
                let $this = self;
                split!(input => $($name: $count),*);
                $body
            }
            $(fn again(&self, model: &Model, state: &[Vec<f64>], environment: &Environment) -> Result<(), mozzi::Error> {
                $again(model, state, environment)
            })?
        }
    };
}

pub(crate) struct InverseDynamics;
quantity!(InverseDynamics, _, [model, environment, Memory { workspace, .. }, output]; theta: model.nq(), dtheta: model.n(), ddtheta: model.n(); {
    kernel::inverse_dynamics(model, theta, dtheta, ddtheta, environment, workspace, output);
});

fn forward_dynamics_again(model: &Model, state: &[Vec<f64>], environment: &Environment) -> Result<(), mozzi::Error> {
    model.forward_dynamics(&state[0], &state[1], &state[2], environment).map(drop)
}

pub(crate) struct ForwardDynamics;
quantity!(ForwardDynamics, _, [model, environment, Memory { workspace, .. }, output]; theta: model.nq(), dtheta: model.n(), tau: model.n(); PIVOTS = true, forward_dynamics_again; {
    kernel::forward_dynamics(model, theta, dtheta, tau, environment, workspace, output);
});

pub(crate) struct MassMatrix;
quantity!(MassMatrix, _, [model, _, Memory { workspace, .. }, output]; theta: model.nq(); {
    kernel::mass_matrix(model, theta, workspace, output);
});

/// C, or Ṁ = C + Cᵀ.
pub(crate) struct CoriolisMatrix {
    pub rate: bool,
}
quantity!(CoriolisMatrix, &CoriolisMatrix { rate }, [model, _, Memory { workspace, .. }, output]; theta: model.nq(), dtheta: model.n(); {
    kernel::coriolis_matrix(model, theta, dtheta, workspace, output);
    if rate {
        mozzi::linalg::add_transpose(model.n(), output);
    }
});

/// h, and with less around the robot, or at rest, its parts: c without gravity, g and JᵀF at θ̇ = 0. Newton and Euler's recursion is
/// compiled once for the four.
pub(crate) struct BiasForces {
    pub at_rest: bool,
}
impl Quantity for BiasForces {
    #[inline(always)]
    fn evaluate<L: Lane>(
        &self,
        model: &Model<L::Number>,
        input: &[L],
        environment: &Environment<L>,
        memory: &mut Memory<L>,
        output: &mut [L],
    ) {
        let Memory { workspace, zeros, .. } = memory;
        let (theta, dtheta) = input.split_at(model.nq());
        let dtheta = if self.at_rest { zeros } else { dtheta };
        kernel::bias_forces(model, theta, dtheta, environment, workspace, output);
    }
}

pub(crate) struct KineticEnergy;
quantity!(KineticEnergy, _, [model, environment, Memory { workspace, .. }, output]; theta: model.nq(), dtheta: model.n(); {
    output[0] = kernel::kinetic_energy(model, theta, dtheta, environment.base_twist, workspace);
});

pub(crate) struct PotentialEnergy;
quantity!(PotentialEnergy, _, [model, environment, Memory { workspace, .. }, output]; theta: model.nq(); {
    output[0] = kernel::potential_energy(model, theta, environment.gravity, workspace);
});

pub(crate) struct InverseDynamicsDerivatives;
quantity!(InverseDynamicsDerivatives, _, [model, environment, Memory { workspace, .. }, output]; theta: model.nq(), dtheta: model.n(), ddtheta: model.n(); {
    kernel::inverse_dynamics_derivatives(model, theta, dtheta, ddtheta, environment, workspace, thirds(output));
});

pub(crate) struct ForwardDynamicsDerivatives;
quantity!(ForwardDynamicsDerivatives, _, [model, environment, Memory { workspace, .. }, output]; theta: model.nq(), dtheta: model.n(), tau: model.n(); PIVOTS = true, forward_dynamics_again; {
    let (ddtheta, derivatives) = output.split_at_mut(model.n());
    kernel::forward_dynamics_derivatives(model, theta, dtheta, tau, environment, workspace, ddtheta, thirds(derivatives));
});

#[inline(always)]
fn thirds<L>(list: &mut [L]) -> [&mut [L]; 3] {
    let third = list.len() / 3;
    let (a, rest) = list.split_at_mut(third);
    let (b, c) = rest.split_at_mut(third);
    [a, b, c]
}

pub(crate) struct ForwardKinematics(pub FrameId);
quantity!(ForwardKinematics, &ForwardKinematics(frame), [model, _, _, output]; theta: model.nq(); {
    let T = mozzi::kinematics::forward_kinematics(model, theta, frame);
    output.copy_from_slice(T.to_matrix().as_flattened());
});

/// A 6 × n matrix by rows, from its columns.
#[inline(always)]
fn by_rows<L: Lane>(columns: &[Twist<L>], output: &mut [L]) {
    for (j, column) in columns.iter().enumerate() {
        for (row, entry) in column.to_array().into_iter().enumerate() {
            output[row * columns.len() + j] = entry;
        }
    }
}

pub(crate) struct SpaceJacobian(pub FrameId);
quantity!(SpaceJacobian, &SpaceJacobian(frame), [model, _, Memory { columns, .. }, output]; theta: model.nq(); {
    mozzi::kinematics::space_jacobian(model, theta, frame, columns);
    by_rows(columns, output);
});

pub(crate) struct BodyJacobian(pub FrameId);
quantity!(BodyJacobian, &BodyJacobian(frame), [model, _, Memory { columns, .. }, output]; theta: model.nq(); {
    mozzi::kinematics::body_jacobian(model, theta, frame, columns);
    by_rows(columns, output);
});

pub(crate) struct SpaceJacobianRate(pub FrameId);
quantity!(SpaceJacobianRate, &SpaceJacobianRate(frame), [model, _, Memory { workspace, columns, .. }, output]; theta: model.nq(), dtheta: model.n(); {
    mozzi::kinematics::space_jacobian_rate(model, theta, dtheta, frame, workspace, columns);
    by_rows(columns, output);
});

pub(crate) struct BodyJacobianRate(pub FrameId);
quantity!(BodyJacobianRate, &BodyJacobianRate(frame), [model, _, Memory { columns, .. }, output]; theta: model.nq(), dtheta: model.n(); {
    mozzi::kinematics::body_jacobian_rate(model, theta, dtheta, frame, columns);
    by_rows(columns, output);
});

pub(crate) struct TaskSpaceDynamics<'a>(pub Task<'a>);
impl Quantity for TaskSpaceDynamics<'_> {
    const PIVOTS: bool = true;

    #[inline(always)]
    fn evaluate<L: Lane>(
        &self,
        model: &Model<L::Number>,
        input: &[L],
        environment: &Environment<L>,
        memory: &mut Memory<L>,
        output: &mut [L],
    ) {
        let (task, k) = (self.0, self.0.rows.len());
        let (theta, dtheta) = input.split_at(model.nq());
        memory.task.take_if(|(rows, _)| *rows != k);
        let (_, own) = memory.task.get_or_insert_with(|| (k, TaskMemory::new(model, k)));
        let (Lambda, eta) = output.split_at_mut(k * k);
        kernel::task_space_dynamics(model, theta, dtheta, task, environment, &mut memory.workspace, own, Lambda, eta);
    }

    fn again(&self, model: &Model, state: &[Vec<f64>], environment: &Environment) -> Result<(), mozzi::Error> {
        model.task_space_dynamics(&state[0], &state[1], self.0, environment).map(drop)
    }
}

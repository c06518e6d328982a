//! A robot whose quantities are machine code.

use crate::jit::{Kernel, Refusal, Shape};
use crate::quantity::{Arguments, Quantity};
use mozzi::model::are_regular;
use mozzi::nalgebra::{DMatrix, DVector};
use mozzi::scalar::Float;
use mozzi::{
    Error, ForwardDynamicsDerivatives, FrameId, InverseDynamicsDerivatives, Jacobian, Mat3, Model, SE3, SO3, Twist,
    Vec3,
};
use mozzi_batch::{Batch, InstructionSet};
use std::fmt;

/// A robot with the quantities that were asked for as machine code, in its own gravity, its base at rest, touching nothing. Its methods
/// are the model's, with the same results to rounding and the same errors. What was not asked for, or has no machine code here (see
/// [`engine`](Self::engine)), the kernels compute.
///
/// It is constant and belongs to no thread: share it.
#[derive(Debug)]
pub struct Compiled {
    pub(crate) model: Model,
    pub(crate) batch: Batch,
    pub(crate) quantities: Vec<Machine>,
}

#[derive(Debug)]
pub(crate) struct Machine {
    quantity: Quantity,
    one: Result<Kernel, Refusal>,
    /// The lengths of its outputs.
    lengths: Vec<usize>,
    pub lanes: Result<Kernel, Refusal>,
    /// The same, pivots condensed to two numbers.
    pub lane_lengths: Vec<usize>,
}

/// The machine code of these quantities of a robot. About a quarter of a millisecond for an arm's inverse dynamics.
///
/// ```
/// use mozzi_codegen::{Quantity, compile};
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let model = mozzi_urdf::open("panda")?.build()?;
/// let robot = compile(&model, &[Quantity::InverseDynamics, Quantity::MassMatrix])?;
///
/// let (theta, dtheta, ddtheta) = (vec![0.3; 8], vec![0.1; 8], vec![0.2; 8]);
/// let tau = robot.inverse_dynamics(&theta, &dtheta, &ddtheta)?;
/// let reference = model.inverse_dynamics(&theta, &dtheta, &ddtheta, &model.environment())?;
/// assert!((tau - reference).amax() < 1e-12);
/// println!("{}", robot.engine(Quantity::InverseDynamics));
/// # Ok(()) }
/// ```
///
/// # Errors
/// [`Error::BadArgument`] for a frame of another model.
pub fn compile(model: &Model, quantities: &[Quantity]) -> Result<Compiled, Error> {
    Compiled::of(Batch::new(model), quantities)
}

impl Machine {
    fn new(model: &Model, quantity: Quantity, set: InstructionSet) -> Self {
        let program = quantity.record(model, Arguments::default());
        let lengths: Vec<usize> = program.outputs().iter().map(|output| output.values.len()).collect();
        let divides = matches!(quantity, Quantity::ForwardDynamics | Quantity::ForwardDynamicsDerivatives);
        let pivots = divides.then_some(lengths.len() - 1);
        let mut lane_lengths = lengths.clone();
        pivots.into_iter().for_each(|last| lane_lengths[last] = 2);
        let lanes = match set {
            InstructionSet::Avx512 => Kernel::condensing(&program, Shape::EightF64, pivots),
            InstructionSet::Avx2 => Kernel::condensing(&program, Shape::FourF64, pivots),
            _ => Err(Refusal::Processor),
        };
        Machine { quantity, one: Kernel::new(&program, Shape::OneF64), lengths, lanes, lane_lengths }
    }
}

/// What computes a quantity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Engine {
    /// Machine code of this shape, and its length in bytes.
    MachineCode(Shape, usize),
    /// The kernels, and why.
    Kernels(Refusal),
}

impl fmt::Display for Engine {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Engine::MachineCode(shape, bytes) => write!(f, "machine code ({}), {bytes} bytes", shape.instruction_set()),
            Engine::Kernels(refusal) => write!(f, "kernels: {refusal}"),
        }
    }
}

fn engine(kernel: Option<&Result<Kernel, Refusal>>) -> Engine {
    match kernel {
        Some(Ok(kernel)) => Engine::MachineCode(kernel.shape(), kernel.code_bytes()),
        Some(Err(refusal)) => Engine::Kernels(*refusal),
        None => Engine::Kernels(Refusal::NotAsked),
    }
}

impl Compiled {
    /// Many states as this batch has them: its instructions, its threads, its layout. See [`compile`].
    ///
    /// # Errors
    /// As there.
    pub fn of(batch: Batch, quantities: &[Quantity]) -> Result<Self, Error> {
        let model = batch.model().clone();
        quantities.iter().filter_map(|quantity| quantity.frame()).try_for_each(|frame| model.check_frame(frame))?;
        let machine = |&quantity: &Quantity| Machine::new(&model, quantity, batch.instruction_set());
        Ok(Compiled { quantities: quantities.iter().map(machine).collect(), model, batch })
    }

    /// The robot.
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// What computes this quantity at one state.
    pub fn engine(&self, quantity: Quantity) -> Engine {
        engine(self.machine(quantity).map(|machine| &machine.one))
    }

    /// What computes this quantity at many states.
    pub fn batch_engine(&self, quantity: Quantity) -> Engine {
        engine(self.machine(quantity).map(|machine| &machine.lanes))
    }

    pub(crate) fn machine(&self, quantity: Quantity) -> Option<&Machine> {
        self.quantities.iter().find(|machine| machine.quantity == quantity)
    }

    /// All outputs of a quantity at one state, for control loops: where there is machine code nothing is allocated. Arrays and their
    /// lengths are those of [`Quantity`]; arguments are not looked at otherwise, so that singular matrices and quaternions of any length
    /// go through.
    ///
    /// # Panics
    /// On another number of arrays, or one of a wrong length.
    pub fn evaluate(&self, quantity: Quantity, state: &[&[f64]], outputs: &mut [&mut [f64]]) {
        if let Some(machine) = self.machine(quantity)
            && let Ok(kernel) = &machine.one
        {
            let mut squares = [0.0];
            assert!(outputs.iter().map(|x| x.len()).eq(machine.lengths.iter().copied()), "outputs of other lengths");
            kernel.call(state, outputs, &mut squares);
            if kernel.is_exact(squares[0]) {
                return;
            }
        }
        let computed = quantity.compute(&self.model, state, &self.model.environment(), false);
        for (output, (_, values)) in outputs.iter_mut().zip(computed) {
            output.copy_from_slice(&values);
        }
    }

    fn vector(&self, quantity: Quantity, state: &[&[f64]]) -> DVector<f64> {
        let mut x = DVector::zeros(self.model.n());
        self.evaluate(quantity, state, &mut [x.as_mut_slice()]);
        x
    }

    /// τ: see [`Model::inverse_dynamics`].
    ///
    /// # Errors
    /// As there.
    pub fn inverse_dynamics(&self, theta: &[f64], dtheta: &[f64], ddtheta: &[f64]) -> Result<DVector<f64>, Error> {
        self.model.check_lengths(theta, [("dtheta", dtheta), ("ddtheta", ddtheta)])?;
        Ok(self.vector(Quantity::InverseDynamics, &[theta, dtheta, ddtheta]))
    }

    /// h: see [`Model::bias_forces`].
    ///
    /// # Errors
    /// As there.
    pub fn bias_forces(&self, theta: &[f64], dtheta: &[f64]) -> Result<DVector<f64>, Error> {
        self.model.check_lengths(theta, [("dtheta", dtheta)])?;
        Ok(self.vector(Quantity::BiasForces, &[theta, dtheta]))
    }

    /// c: see [`Model::velocity_product`].
    ///
    /// # Errors
    /// As there.
    pub fn velocity_product(&self, theta: &[f64], dtheta: &[f64]) -> Result<DVector<f64>, Error> {
        self.model.check_lengths(theta, [("dtheta", dtheta)])?;
        Ok(self.vector(Quantity::VelocityProduct, &[theta, dtheta]))
    }

    /// g: see [`Model::gravity_forces`].
    ///
    /// # Errors
    /// As there.
    pub fn gravity_forces(&self, theta: &[f64]) -> Result<DVector<f64>, Error> {
        self.model.check_lengths(theta, [])?;
        Ok(self.vector(Quantity::GravityForces, &[theta]))
    }

    /// M: see [`Model::mass_matrix`].
    ///
    /// # Errors
    /// As there.
    pub fn mass_matrix(&self, theta: &[f64]) -> Result<DMatrix<f64>, Error> {
        self.model.check_lengths(theta, [])?;
        let n = self.model.n();
        let mut M = DMatrix::zeros(n, n); // symmetric: by rows is by columns
        self.evaluate(Quantity::MassMatrix, &[theta], &mut [M.as_mut_slice()]);
        Ok(M)
    }

    /// θ̈: see [`Model::forward_dynamics`].
    ///
    /// # Errors
    /// As there.
    pub fn forward_dynamics(&self, theta: &[f64], dtheta: &[f64], tau: &[f64]) -> Result<DVector<f64>, Error> {
        self.model.check_lengths(theta, [("dtheta", dtheta), ("tau", tau)])?;
        let (mut ddtheta, mut pivots) = (DVector::zeros(self.model.n()), vec![0.0; self.model.n()]);
        let outputs = &mut [ddtheta.as_mut_slice(), &mut pivots];
        self.evaluate(Quantity::ForwardDynamics, &[theta, dtheta, tau], outputs);
        if are_regular(&pivots) {
            return Ok(ddtheta);
        }
        self.model.forward_dynamics(theta, dtheta, tau, &self.model.environment())
    }

    /// `T_sb`: see [`Model::forward_kinematics`].
    ///
    /// # Errors
    /// As there.
    pub fn forward_kinematics(&self, theta: &[f64], frame: FrameId) -> Result<SE3, Error> {
        self.model.check_lengths(theta, [])?;
        self.model.check_frame(frame)?;
        let (mut R, mut p) = ([0.0; 9], [0.0; 3]);
        self.evaluate(Quantity::ForwardKinematics(frame), &[theta], &mut [&mut R, &mut p]);
        let [a, b, c, d, e, f, g, h, i] = R;
        match SO3::from_matrix(Mat3::from_rows([[a, b, c], [d, e, f], [g, h, i]])) {
            Ok(R) => Ok(SE3::new(R, Vec3(p))),
            Err(_) => self.model.forward_kinematics(theta, frame), // of NaN, or of a quaternion that has lost digits
        }
    }

    /// `J_b`: see [`Model::body_jacobian`].
    ///
    /// # Errors
    /// As there.
    pub fn body_jacobian(&self, theta: &[f64], frame: FrameId) -> Result<Jacobian, Error> {
        self.jacobian(Quantity::BodyJacobian(frame), theta, frame)
    }

    /// `J_s`: see [`Model::space_jacobian`].
    ///
    /// # Errors
    /// As there.
    pub fn space_jacobian(&self, theta: &[f64], frame: FrameId) -> Result<Jacobian, Error> {
        self.jacobian(Quantity::SpaceJacobian(frame), theta, frame)
    }

    fn jacobian(&self, quantity: Quantity, theta: &[f64], frame: FrameId) -> Result<Jacobian, Error> {
        self.model.check_lengths(theta, [])?;
        self.model.check_frame(frame)?;
        let mut J = vec![0.0; 6 * self.model.n()];
        self.evaluate(quantity, &[theta], &mut [&mut J]);
        Ok(Jacobian(J.as_chunks().0.iter().map(|&column| Twist::from_array(column)).collect()))
    }

    /// ∂τ: see [`Model::inverse_dynamics_derivatives`].
    ///
    /// # Errors
    /// As there.
    pub fn inverse_dynamics_derivatives(
        &self,
        theta: &[f64],
        dtheta: &[f64],
        ddtheta: &[f64],
    ) -> Result<InverseDynamicsDerivatives, Error> {
        self.model.check_lengths(theta, [("dtheta", dtheta), ("ddtheta", ddtheta)])?;
        let n = self.model.n();
        let [mut a, mut b, mut c] = [(); 3].map(|()| vec![0.0; n * n]);
        let outputs = &mut [&mut a[..], &mut b, &mut c];
        self.evaluate(Quantity::InverseDynamicsDerivatives, &[theta, dtheta, ddtheta], outputs);
        let [d_theta, d_dtheta, d_ddtheta] = [a, b, c].map(|rows| DMatrix::from_row_slice(n, n, &rows));
        Ok(InverseDynamicsDerivatives { d_theta, d_dtheta, d_ddtheta })
    }

    /// θ̈ and ∂θ̈: see [`Model::forward_dynamics_derivatives`].
    ///
    /// # Errors
    /// As there.
    pub fn forward_dynamics_derivatives(
        &self,
        theta: &[f64],
        dtheta: &[f64],
        tau: &[f64],
    ) -> Result<ForwardDynamicsDerivatives, Error> {
        self.model.check_lengths(theta, [("dtheta", dtheta), ("tau", tau)])?;
        let n = self.model.n();
        let (mut ddtheta, mut pivots) = (DVector::zeros(n), vec![0.0; n]);
        let [mut a, mut b, mut c] = [(); 3].map(|()| vec![0.0; n * n]);
        let outputs = &mut [ddtheta.as_mut_slice(), &mut a, &mut b, &mut c, &mut pivots];
        self.evaluate(Quantity::ForwardDynamicsDerivatives, &[theta, dtheta, tau], outputs);
        if !are_regular(&pivots) {
            return self.model.forward_dynamics_derivatives(theta, dtheta, tau, &self.model.environment());
        }
        let [d_theta, d_dtheta, d_tau] = [a, b, c].map(|rows| DMatrix::from_row_slice(n, n, &rows));
        Ok(ForwardDynamicsDerivatives { ddtheta, d_theta, d_dtheta, d_tau })
    }
}

/// Of their least and their sum alone: are pivots of M far from rounding? Nearer, the model's method looks again.
pub(crate) fn is_regular<T: Float>(least: T, sum: T) -> bool {
    least > T::from_f64(1e-8) * sum && sum * T::zero() == T::zero()
}

//! A robot with quantities as machine code.

use crate::{Arguments, Batch, Engine, Form, Kernel, Refusal, Shape, is_too_long, pivot_names, record_quantity};
use mozzi::quantities::{ForwardDynamics, Of, Query};
use mozzi::{Error, Model, fast, least_is_clear};
use mozzi_sim::{Input, Options, Simulation};
use std::sync::{Arc, Mutex, PoisonError};

/// A robot with some quantities as machine code, at one state and at many, in its own gravity, its base at rest, no
/// wrenches applied. Results are equal to the model's up to rounding; errors are the same. Quantities that were not
/// compiled, or cannot be (see [`engine`](Self::engine)), are computed by the kernels.
///
/// It is immutable and can be shared between threads. Clones share the code.
#[derive(Clone, Debug)]
pub struct Compiled {
    batch: Batch,
    machines: Arc<[Machine]>,
    /// Memory for the kernels; a call that finds it locked allocates its own.
    workspace: Arc<Mutex<fast::Workspace>>,
}

/// A quantity at one state.
#[derive(Debug)]
struct Machine {
    index: usize,
    /// The quantity has no frame, task or point, so that its index identifies it.
    is_of_robot: bool,
    /// The task's rows, owned.
    rows: Vec<usize>,
    subject: (Option<mozzi::FrameId>, mozzi::TaskFrame, mozzi::Vec3),
    code: Result<Arc<Kernel>, Refusal>,
    /// The number of pivot outputs after the quantity's own.
    pivots: usize,
}

impl Machine {
    fn new(model: &Model, query: Query) -> Result<Self, Error> {
        query.check_subject(model)?;
        let code = if is_too_long(model, query) {
            Err(Refusal::Long)
        } else {
            let program = record_quantity(model, query, Arguments::default())?;
            let own = program.outputs().len() - pivot_names(&query).len();
            Kernel::shared(&program, Shape::one_f64(), Form::Blocks, own)
        };
        let pivots = pivot_names(&query).len();
        let subject = query.subject;
        Ok(Machine {
            index: query.index(),
            is_of_robot: query.declaration().of == Of::Robot,
            rows: subject.rows.to_vec(),
            subject: (subject.frame, subject.coordinates, subject.point),
            code,
            pivots,
        })
    }

    #[inline(always)]
    fn is_of(&self, query: &Query) -> bool {
        let subject = &query.subject;
        let is_of = || self.subject == (subject.frame, subject.coordinates, subject.point) && self.rows == subject.rows;
        self.index == query.index() && (self.is_of_robot || is_of())
    }
}

/// Compiles these quantities of a robot to machine code. An arm's inverse dynamics takes about a quarter of a
/// millisecond. Robots with the same numbers share their code.
///
/// ```
/// use mozzi::quantities::{InverseDynamics, MassMatrix, Query};
/// use mozzi_engine::compile;
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let model = mozzi_urdf::open("panda")?.build()?;
/// let robot = compile(&model, &[InverseDynamics.into(), MassMatrix.into()])?;
///
/// let (theta, dtheta, ddtheta, mut tau) = (vec![0.3; 8], vec![0.1; 8], vec![0.2; 8], vec![0.0; 8]);
/// robot.compute(InverseDynamics, &[&theta, &dtheta, &ddtheta], &mut [&mut tau])?;
/// let reference = model.inverse_dynamics(&theta, &dtheta, &ddtheta, &model.environment())?;
/// assert!(tau.iter().zip(&reference).all(|(a, b)| (a - b).abs() < 1e-12));
/// println!("{}; arrays: {}", robot.engine(InverseDynamics), robot.batch().engine(InverseDynamics));
/// # Ok(()) }
/// ```
///
/// # Errors
/// [`Error::BadArgument`] if the frame is missing or belongs to another model.
pub fn compile(model: &Model, queries: &[Query]) -> Result<Compiled, Error> {
    Compiled::of(Batch::new(model), queries)
}

impl Compiled {
    /// Compiles for many states with this batch's shape and threads. See [`compile`].
    ///
    /// # Errors
    /// See [`compile`].
    pub fn of(batch: Batch, queries: &[Query]) -> Result<Self, Error> {
        let machines =
            queries.iter().map(|&query| Machine::new(batch.model(), query)).collect::<Result<Vec<_>, _>>()?;
        let machines = Arc::from(machines);
        let batch = batch.compile(queries).map_err(|error| match error {
            crate::Error::Model(error) => error,
            other => unreachable!("of the quantity alone: {other}"),
        })?;
        let workspace = Arc::new(Mutex::new(fast::Workspace::new(batch.model())));
        Ok(Compiled { batch, machines, workspace })
    }

    /// The robot's model.
    pub fn model(&self) -> &Model {
        self.batch.model()
    }

    /// A batch that uses the machine code of these quantities in the robot's own environment.
    pub fn batch(&self) -> &Batch {
        &self.batch
    }

    /// As [`Batch::with_threads`]; by default on all cores.
    ///
    /// # Errors
    /// [`Error::Threads`](crate::Error::Threads) for 0 threads.
    pub fn with_threads(self, threads: usize) -> Result<Self, crate::Error> {
        Ok(Compiled { batch: self.batch.with_threads(threads)?, ..self })
    }

    /// The engine that computes this quantity at one state.
    pub fn engine<'q>(&self, query: impl Into<Query<'q>>) -> Engine {
        self.machine(&query.into()).map_or(Engine::Kernels(Refusal::NotAsked), |machine| Engine::of(&machine.code))
    }

    #[inline(always)]
    fn machine(&self, query: &Query) -> Option<&Machine> {
        self.machines.iter().find(|machine| machine.is_of(query))
    }

    /// Computes the outputs of a quantity at one state, for control loops: nothing is allocated if there is machine
    /// code. Only the lengths of the arguments are checked: singular matrices and quaternions of any length are
    /// accepted. Returns true if every pivot is well above rounding error.
    ///
    /// # Panics
    /// If the number of arrays or the length of one is wrong.
    #[inline]
    pub fn evaluate<'q>(&self, query: impl Into<Query<'q>>, state: &[&[f64]], outputs: &mut [&mut [f64]]) -> bool {
        let query = query.into();
        match self.evaluate_code(&query, state, outputs) {
            Some(are_clear) => are_clear,
            None => self.evaluate_by_kernels(query, state, outputs),
        }
    }

    /// [`evaluate`](Self::evaluate) by machine code alone: none if there is none for this quantity, or if an angle is
    /// beyond its range; the outputs then mean nothing.
    ///
    /// # Panics
    /// If the number of arrays or the length of one is wrong.
    #[inline]
    pub fn evaluate_code(&self, query: &Query, state: &[&[f64]], outputs: &mut [&mut [f64]]) -> Option<bool> {
        let machine = self.machine(query)?;
        machine.run(machine.code.as_ref().ok()?, state, outputs)
    }

    #[cold]
    fn evaluate_by_kernels(&self, query: Query, state: &[&[f64]], outputs: &mut [&mut [f64]]) -> bool {
        let mut shared = match self.workspace.try_lock() {
            Ok(workspace) => Some(workspace),
            Err(std::sync::TryLockError::Poisoned(poisoned)) => Some(PoisonError::into_inner(poisoned)),
            Err(std::sync::TryLockError::WouldBlock) => None,
        };
        let mut own = None;
        let workspace = match &mut shared {
            Some(workspace) => &mut **workspace,
            None => own.insert(fast::Workspace::new(self.model())),
        };
        fast::evaluate(&query, self.model(), state, &self.model().environment(), workspace, outputs);
        workspace.are_pivots_clear(&query)
    }

    /// [`evaluate`](Self::evaluate) with checked arguments and checked pivots: see [`Model::compute`].
    ///
    /// # Errors
    /// See [`Model::compute`].
    pub fn compute<'q>(
        &self,
        query: impl Into<Query<'q>>,
        inputs: &[&[f64]],
        outputs: &mut [&mut [f64]],
    ) -> Result<(), Error> {
        let (query, environment) = (query.into(), self.model().environment());
        query.check(self.model(), inputs, &environment)?;
        if !self.evaluate(query, inputs, outputs) {
            for (output, values) in outputs.iter_mut().zip(self.model().compute(query, inputs, &environment)?) {
                output.copy_from_slice(&values);
            }
        }
        Ok(())
    }
}

impl Machine {
    /// None if an angle is NaN or beyond the range of exact reduction; else, whether the pivots are well above rounding
    /// error.
    #[inline]
    fn run(&self, kernel: &Kernel, state: &[&[f64]], outputs: &mut [&mut [f64]]) -> Option<bool> {
        let mut squares = [0.0];
        if self.pivots == 0 {
            kernel.call(state, outputs, &mut squares);
            return kernel.is_exact(squares[0]).then_some(true);
        }
        // the smallest pivot and the sum, for each kind of pivots
        let [mut pivots, mut of_task] = [[0.0; 2]; 2];
        let mut all: [&mut [f64]; MOST_OUTPUTS] = Default::default();
        let own = outputs.len();
        for (place, output) in all.iter_mut().zip(outputs) {
            *place = output;
        }
        all[own] = &mut pivots;
        all[own + 1] = &mut of_task;
        kernel.call(state, &mut all[..own + self.pivots], &mut squares);
        let is_clear = |[least, sum]: [f64; 2]| least_is_clear(least, sum);
        let are_clear = is_clear(pivots) && (self.pivots == 1 || is_clear(of_task));
        kernel.is_exact(squares[0]).then_some(are_clear)
    }
}

/// The most outputs of a program: a quantity's, and two kinds of pivots.
const MOST_OUTPUTS: usize = mozzi::quantities::MOST_OUTPUTS + 2;

impl mozzi_sim::ForwardDynamics for Compiled {
    fn model(&self) -> &Model {
        self.model()
    }

    fn write(&self, theta: &[f64], dtheta: &[f64], tau: &[f64], ddtheta: &mut [f64]) -> bool {
        self.evaluate(ForwardDynamics, &[theta, dtheta, tau], &mut [ddtheta])
    }
}

impl Compiled {
    /// Machine code for θ̈, if there is any: the [`forward_dynamics`](Simulation::forward_dynamics) of a simulation
    /// with events, recorders or progress.
    pub fn simulator(&self) -> Option<&dyn mozzi_sim::ForwardDynamics> {
        let is_code = matches!(self.engine(ForwardDynamics), Engine::MachineCode(..));
        is_code.then_some(self as &dyn mozzi_sim::ForwardDynamics)
    }

    /// Simulates the motion from (θ(0), θ̇(0)): see [`mozzi_sim::simulate`]. Forward dynamics is machine code if it was
    /// compiled, no wrenches are applied and gravity is the robot's own.
    ///
    /// ```
    /// use mozzi::quantities::ForwardDynamics;
    /// use mozzi_sim::{Options, Zero};
    /// # fn main() -> Result<(), Box<dyn std::error::Error>> {
    /// let model = mozzi_urdf::open("ur5")?.build()?;
    /// let robot = mozzi_engine::compile(&model, &[ForwardDynamics.into()])?;
    /// let fall = robot.simulate(&[0.1; 6], &[0.0; 6], Zero, &Options::new(0.2, 200))?;
    /// assert!(fall.largest_drift() < 1e-6);
    /// # Ok(()) }
    /// ```
    ///
    /// # Errors
    /// See [`mozzi_sim::simulate`].
    pub fn simulate(
        &self,
        theta: &[f64],
        dtheta: &[f64],
        input: impl Input,
        options: &Options,
    ) -> Result<mozzi_sim::Trajectory, mozzi_sim::Error> {
        let simulation = Simulation { forward_dynamics: self.simulator(), ..Simulation::new(*options) };
        simulation.run(self.model(), theta, dtheta, input).map(|run| run.motion)
    }
}

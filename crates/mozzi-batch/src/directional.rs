//! Any quantity with its derivative along a direction, at many states: its kernel on dual numbers.

use crate::chunk::{Fixed, Table, TableMut};
use crate::request::Request;
use crate::{Batch, BatchEnvironment, Error};
use mozzi::kinematics::integrate;
use mozzi::model::least_is_clear;
use mozzi::quantities::{Dim, Input, Memory, Query};
use mozzi::{Dual, Environment, FrameId, Model, Vec3, Wrench};

/// The states of a piece of work.
const TOGETHER: usize = 32;

/// A direction at each of N states: the rates of the inputs and of the inertial parameters. `None` is zero.
#[derive(Clone, Copy, Debug)]
pub struct Direction<'a> {
    /// One table (N, n) for each input of the quantity, (N, 6) for w. The rate of θ has n numbers, like a velocity: for
    /// a floating base, a ball and a free joint a body twist in its own coordinates.
    pub inputs: &'a [Option<&'a [f64]>],
    /// A table (N, p): the rate of the [`parameters`](mozzi::Model::parameters).
    pub parameters: Option<&'a [f64]>,
}

/// The memory of one thread.
struct Worker {
    /// The model with its own parameters.
    constant: Model<Dual>,
    memory: Memory<Dual>,
    inputs: Vec<Vec<Dual>>,
    outputs: Vec<Vec<Dual>>,
    rate: Vec<Dual>,
    applied: Vec<(FrameId, Wrench<Dual>)>,
}

impl Worker {
    fn new(model: &Model) -> Self {
        Worker {
            constant: model.map(Dual::constant),
            memory: Memory::new(model),
            inputs: Vec::new(),
            outputs: Vec::new(),
            rate: Vec::new(),
            applied: Vec::new(),
        }
    }
}

/// One call: its tables are the inputs, the environment's tables, the rates of the inputs, and that of the parameters.
struct Directional<'a> {
    request: Request<'a, f64>,
    tables: Vec<Table<'a, f64>>,
    direction: Direction<'a>,
    /// The model's own parameters, if only their rate was given.
    own: Vec<f64>,
}

/// Some states: the first one's index, the values, the derivatives.
type Piece<'a> = (usize, Fixed<TableMut<'a, f64>>, Fixed<TableMut<'a, f64>>);

impl Batch<f64> {
    /// Computes a quantity and its derivative along a direction at many states, by its kernel on dual numbers: exact,
    /// without a step size. The derivative along the velocities e_j is column j of a derivative by θ. The direction of
    /// the environment is zero.
    ///
    /// Tables are row-major, whatever the [layout](Batch::layout); `values` and `derivatives` have one table for each
    /// output. Cost: two to three times the quantity at one state, on this batch's threads, without wide registers.
    ///
    /// ```
    /// use mozzi::quantities::InverseDynamics;
    /// use mozzi_batch::{Batch, Direction};
    /// # use mozzi::{Description, HomeFrames, SE3, ScrewAxis, Screws, Solid};
    /// # let rod = Solid::Box([1.0, 0.02, 0.02]).inertia(1.0);
    /// # let home = [0.5, 1.5, 2.0].map(|x| SE3::translation([x, 0.0, 0.0]));
    /// # let S = [0.0, 1.0].map(|x| ScrewAxis::from_line([0.0, -1.0, 0.0], [x, 0.0, 0.0], 0.0).expect("unit"));
    /// # let model = Description::from_screws("arm", HomeFrames::Base(&home), &[rod; 2], Screws::Space(&S))?.build()?;
    /// let batch = Batch::new(&model);
    /// let (theta, dtheta, ddtheta) = ([0.3, -0.5], [0.2, 0.4], [0.0, 1.0]);
    /// let direction = Direction { inputs: &[Some(&[1.0, 0.0]), None, None], parameters: None };
    /// let (mut tau, mut rate) = ([0.0; 2], [0.0; 2]);
    /// let (inputs, environment) = ([&theta[..], &dtheta, &ddtheta], model.environment().into());
    /// let query = InverseDynamics;
    /// batch.directional_derivative(query, &inputs, direction, &environment, &mut [&mut tau], &mut [&mut rate])?;
    /// let full = model.inverse_dynamics_derivatives(&theta, &dtheta, &ddtheta, &model.environment())?;
    /// assert!((rate[1] - full.d_theta[(1, 0)]).abs() < 1e-13);
    /// # Ok::<(), mozzi_batch::Error>(())
    /// ```
    ///
    /// # Errors
    /// Those of [`compute`](Batch::compute); a table of the direction has the wrong length.
    ///
    /// # Panics
    /// If the number of inputs, rates or outputs is not the quantity's.
    pub fn directional_derivative<'q>(
        &self,
        query: impl Into<Query<'q>>,
        inputs: &[&[f64]],
        direction: Direction,
        environment: &BatchEnvironment,
        values: &mut [&mut [f64]],
        derivatives: &mut [&mut [f64]],
    ) -> Result<(), Error> {
        let query = query.into();
        let (model, declaration) = (self.model(), query.declaration());
        query.check_subject(model)?;
        let (k, outputs) = (declaration.inputs.len(), declaration.outputs);
        let name = query.name();
        assert!(inputs.len() == k && direction.inputs.len() == k, "{name} has {k} inputs");
        assert!(values.len() == outputs.len() && derivatives.len() == outputs.len(), "{name} has {}", outputs.len());

        let request = Request::new(query, model, environment);
        let state = declaration.inputs.iter().zip(inputs).zip(query.input_lengths(model));
        let mut tables: Vec<Table<f64>> =
            state.map(|((input, &numbers), width)| Table { name: input.name, numbers, width }).collect();
        tables.extend(request.further());
        let width = |(input, width): (&Input, usize)| if input.dim == Dim::Nq { model.n() } else { width };
        let lengths = declaration.inputs.iter().zip(query.input_lengths(model)).map(width);
        let given = direction.inputs.iter().zip(lengths).filter_map(|(numbers, width)| Some(((*numbers)?, width)));
        let given = given.chain(direction.parameters.map(|numbers| (numbers, model.parameter_count())));
        tables.extend(given.map(|(numbers, width)| Table { name: "a rate of the direction", numbers, width }));

        let widths: Fixed<usize> = query.output_lengths(model).collect();
        let size = |((output, table), &width): ((&mozzi::quantities::Output, &&mut [f64]), &usize)| {
            (output.name, table.len(), width)
        };
        let sizes = outputs.iter().zip(&*values).zip(&*widths).map(size);
        let sizes = sizes.chain(outputs.iter().zip(&*derivatives).zip(&*widths).map(size));
        let frames = request.wrenches.iter().map(|&(frame, _)| frame);
        let states = self.check(&tables, sizes, &request.environment, frames)?;

        let own = match (request.parameters, direction.parameters) {
            (None, Some(_)) => model.parameters(),
            _ => Vec::new(),
        };
        let mut values = values.iter_mut().zip(&*widths).map(|(table, &width)| (&mut **table, width)).collect();
        let mut derivatives = derivatives.iter_mut().zip(&*widths).map(|(table, &w)| (&mut **table, w)).collect();
        let mut pieces: Vec<Piece> = Vec::with_capacity(states.div_ceil(TOGETHER));
        for first in (0..states).step_by(TOGETHER) {
            let count = TOGETHER.min(states - first);
            pieces.push((first, split(&mut values, count), split(&mut derivatives, count)));
        }
        let call = Directional { request, tables, direction, own };
        let results = self.workers().map(
            pieces,
            || self.pool().lend::<Worker>(),
            |lent, piece| call.run(lent.get(|| Worker::new(model)), piece),
        );
        results.into_iter().collect()
    }
}

/// Takes the first states off each table.
fn split<'a>(tables: &mut Fixed<TableMut<'a, f64>>, states: usize) -> Fixed<TableMut<'a, f64>> {
    let first = |(table, width): &mut TableMut<'a, f64>| {
        let (first, rest) = core::mem::take(table).split_at_mut(states * *width);
        *table = rest;
        (first, *width)
    };
    tables.iter_mut().map(first).collect()
}

impl Directional<'_> {
    /// The numbers of this state in a table.
    fn row(&self, table: usize, state: usize) -> &[f64] {
        let Table { numbers, width, .. } = self.tables[table];
        &numbers[state * width..][..width]
    }

    fn run(&self, worker: &mut Worker, (first, mut values, mut derivatives): Piece) -> Result<(), Error> {
        let count = values.iter().map(|(table, width)| table.len() / (*width).max(1)).max().unwrap_or(0);
        for k in 0..count {
            self.at(worker, first + k).map_err(|source| Error::State { index: first + k, source })?;
            let tables = values.iter_mut().zip(derivatives.iter_mut());
            for (((values, width), (derivatives, _)), found) in tables.zip(&worker.outputs) {
                let places = values[k * *width..].iter_mut().zip(&mut derivatives[k * *width..]);
                places.zip(found).for_each(|((value, derivative), x)| (*value, *derivative) = (x.value, x.derivative));
            }
        }
        Ok(())
    }

    /// Fills the worker's outputs at this state.
    fn at(&self, worker: &mut Worker, state: usize) -> Result<(), mozzi::Error> {
        let Directional { request, direction, own, .. } = self;
        let Worker { constant, memory, inputs, outputs, rate, applied } = worker;
        let declared = request.query.declaration().inputs;
        inputs.resize(declared.len(), Vec::new());
        let further = declared.len() + request.further().count();
        let mut next = further; // the next table of the direction
        for (k, (input, numbers)) in declared.iter().zip(&mut *inputs).enumerate() {
            numbers.clear();
            let value = self.row(k, state);
            let given = direction.inputs[k].is_some().then(|| self.row(next, state));
            next += usize::from(given.is_some());
            match given {
                None => numbers.extend(value.iter().map(|&x| Dual::constant(x))),
                Some(given) if input.dim == Dim::Nq => {
                    numbers.extend(value.iter().map(|&x| Dual::constant(x)));
                    rate.clear();
                    rate.extend(given.iter().map(|&x| Dual::constant(x)));
                    integrate(request.model, numbers, rate, Dual { value: 0.0, derivative: 1.0 }); // θ ⊕ δθ ε
                }
                Some(given) => {
                    numbers.extend(value.iter().zip(given).map(|(&value, &derivative)| Dual { value, derivative }));
                }
            }
        }
        let mut table = declared.len();
        let mut row = |is_given: bool| {
            table += usize::from(is_given);
            is_given.then(|| self.row(table - 1, state))
        };
        let (parameters, gravity) = (row(request.parameters.is_some()), row(request.gravity.is_some()));
        let mut environment = Environment {
            gravity: request.environment.gravity.map(Dual::constant),
            base_twist: request.environment.base_twist.map(Dual::constant),
            base_acceleration: request.environment.base_acceleration.map(Dual::constant),
            applied: &[],
        };
        if let Some(g) = gravity {
            environment.gravity = Vec3(core::array::from_fn(|k| Dual::constant(g[k])));
        }
        applied.clear();
        applied.extend(request.environment.applied.iter().map(|&(frame, F)| (frame, F.map(Dual::constant))));
        for &(frame, _) in request.wrenches {
            let F = row(true).unwrap_or(&[0.0; 6]);
            applied.push((frame, Wrench::from_array(core::array::from_fn(|k| Dual::constant(F[k])))));
        }
        environment.applied = applied;
        let changed = (parameters.is_some() || direction.parameters.is_some()).then(|| {
            let value = parameters.unwrap_or(own);
            let rate = direction.parameters.map(|_| self.row(next, state));
            let pi = rate.map_or_else(|| Dual::constants(value), |rate| Dual::list(value, rate));
            request.model.with_parameters(&pi)
        });
        let model = changed.as_ref().unwrap_or(constant);

        let lengths = request.query.output_lengths(request.model);
        outputs.resize(request.query.declaration().outputs.len(), Vec::new());
        outputs.iter_mut().zip(lengths).for_each(|(output, length)| output.resize(length, Dual::constant(0.0)));
        let given: Fixed<&[Dual]> = inputs.iter().map(Vec::as_slice).collect();
        let mut slices: Fixed<&mut [Dual]> = outputs.iter_mut().map(Vec::as_mut_slice).collect();
        request.query.evaluate(model, &given, &environment, memory, &mut slices);
        if request.query.declaration().divides && !memory.pivots().all(are_clear) {
            let numbers: Vec<Vec<f64>> = (0..further).map(|table| self.row(table, state).to_vec()).collect();
            request.at_one_state(&numbers)?; // the error names the joint
        }
        Ok(())
    }
}

/// The quick test of pivots, on their values.
fn are_clear(pivots: &[Dual]) -> bool {
    let Some(first) = pivots.first() else { return true };
    let (mut least, mut sum) = (first.value, 0.0);
    for pivot in pivots {
        least = if pivot.value < least || pivot.value.is_nan() { pivot.value } else { least };
        sum += pivot.value;
    }
    least_is_clear(least, sum)
}

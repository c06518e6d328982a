//! Any quantity with its derivative along a direction, at many states: its program, differentiated operation by
//! operation (forward mode).

use crate::batch::cut;
use crate::chunk::{Chunk, Fixed, Table};
use crate::request::Request;
use crate::{Batch, BatchEnvironment, Error, code};
use mozzi::least_is_clear;
use mozzi::quantities::{Dim, Input, Query};
use mozzi_codegen::{Arguments, Program, Rates};

/// A direction at each of N states: the rates of the inputs and of the inertial parameters. `None` is zero.
#[derive(Clone, Copy, Debug)]
pub struct Direction<'a> {
    /// One table (N, n) for each input of the quantity, (N, 6) for w. The rate of θ has n numbers, like a velocity: for
    /// a floating base, a ball and a free joint a body twist in its own coordinates.
    pub inputs: &'a [Option<&'a [f64]>],
    /// A table (N, p): the rate of the [`parameters`](mozzi::Model::parameters).
    pub parameters: Option<&'a [f64]>,
}

/// One call: its tables are the inputs, the environment's tables, the rates of the inputs, and that of the parameters.
struct Directional<'a> {
    request: Request<'a, f64>,
    program: &'a Program,
    /// The program's inputs that are the same in all states; for `None`, the next table.
    given: &'a [Option<Vec<f64>>],
    /// The number of tables before those of rates.
    of_values: usize,
}

impl Batch<f64> {
    /// Computes a quantity and its derivative along a direction at many states, by its program with the derivative of
    /// each operation: exact, without a step size. The derivative along the velocities e_j is column j of a derivative
    /// by θ. The direction of the environment is zero.
    ///
    /// `values` and `derivatives` have one table for each output. Cost: about twice the quantity's machine code, once
    /// that pays as in [`compute`](Batch::compute); before, the program is evaluated step by step.
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
    /// Those of [`compute`](Batch::compute); a table of the direction has the wrong length; the program of a robot so
    /// large would be too long.
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
        let mut tables = request.tables(inputs);
        let of_values = tables.len();
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
        let states = self.check(&tables, sizes, &request.environment, request.frames())?;

        let mut frames = Vec::new();
        let its = request.arguments(&mut frames);
        let parameters = its.parameters || direction.parameters.is_some();
        let moving = direction.inputs.iter().map(Option::is_some).chain([direction.parameters.is_some()]);
        let rates = Rates::Of(moving.enumerate().fold(0, |bits, (k, moves)| bits | u32::from(moves) << k));
        let arguments = Arguments { parameters, rates, ..its };
        let mut further = request.constants(&arguments);
        if request.parameters.is_none() && parameters {
            further[0] = Some(model.parameters());
        }
        let of_rates = tables[of_values..].iter().map(|_| None);
        let given: Vec<_> = declaration.inputs.iter().map(|_| None).chain(further).chain(of_rates).collect();

        let values = values.iter_mut().zip(&*widths).map(|(table, &width)| (&mut **table, width));
        let derivatives = derivatives.iter_mut().zip(&*widths).map(|(table, &width)| (&mut **table, width));
        let chunks = cut(states, &tables, values.chain(derivatives).collect());
        self.code(&query, &arguments, states)?;
        let entry = self.programs().entry(&query, &arguments, false);
        let program = entry.program(model, query, arguments)?;
        let call = Directional { request, program, given: &given, of_values };
        let recompute = |chunk: &mut Chunk<f64>, state: usize| call.one(chunk, state);
        let errors = match entry.made() {
            Some(Ok(made)) => self.workers().map(
                chunks,
                || self.pool().lend::<code::Worker<f64>>(),
                |lent, chunk| code::run(made, &given, &recompute, lent.get(code::Worker::default), chunk),
            ),
            _ => self.workers().map(
                chunks,
                || (),
                |(), mut chunk| {
                    let (first, states) = (chunk.first, chunk.states);
                    let failed = |state| Some((first + state, recompute(&mut chunk, state).err()?));
                    (0..states).filter_map(failed).collect()
                },
            ),
        };
        Error::of_first(errors)
    }
}

impl Directional<'_> {
    /// Computes a state of a chunk step by step, with all checks.
    fn one(&self, chunk: &mut Chunk<f64>, state: usize) -> Result<(), mozzi::Error> {
        let mut tables = chunk.inputs.iter();
        let inputs: Vec<&[f64]> = self
            .given
            .iter()
            .map(|constant| match constant {
                Some(numbers) => numbers.as_slice(),
                None => tables.next().map(|table| table.row(chunk.first + state)).unwrap_or_default(),
            })
            .collect();
        let found = self.program.evaluate(&inputs);
        let (own, pivots) = found.split_at(chunk.outputs.len());
        let are_clear = |pivots: &Vec<f64>| {
            let least = pivots.iter().fold(f64::INFINITY, |least, &x| if x < least || x.is_nan() { x } else { least });
            pivots.is_empty() || least_is_clear(least, pivots.iter().sum())
        };
        if !pivots.iter().all(are_clear) {
            let tables = chunk.inputs[..self.of_values].iter();
            let values: Vec<Vec<f64>> = tables.map(|table| table.row(chunk.first + state).to_vec()).collect();
            self.request.at_one_state(&values)?; // the error names the joint
        }
        for ((table, width), found) in chunk.outputs.iter_mut().zip(own) {
            table[state * *width..][..*width].copy_from_slice(found);
        }
        Ok(())
    }
}

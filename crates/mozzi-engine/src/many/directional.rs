//! Derivatives of any quantity along directions, and products with derivatives, at many states: its program,
//! differentiated step by step.

use crate::many::batch::cut;
use crate::many::check::Size;
use crate::many::chunk::{Chunk, Fixed, Table};
use crate::many::code;
use crate::many::request::Request;
use crate::{Arguments, Batch, BatchEnvironment, Derivative, Error, Product, Program};
use mozzi::least_is_clear;
use mozzi::quantities::{Dim, Input, Query};

/// A direction at each of N states: the rates of the inputs and of the inertial parameters. `None` is zero.
#[derive(Clone, Copy, Debug)]
pub struct Direction<'a> {
    /// One table (N, n) for each input of the quantity, (N, 6) for w. The rate of θ has n numbers, like a velocity: for
    /// a floating base, a ball and a free joint a body twist in its own coordinates.
    pub inputs: &'a [Option<&'a [f64]>],
    /// A table (N, p): the rate of the [`parameters`](mozzi::Model::parameters).
    pub parameters: Option<&'a [f64]>,
}

/// One call: its tables are the inputs, the environment's tables, and the directions.
struct Directional<'a> {
    request: Request<'a, f64>,
    program: &'a Program,
    /// The program's inputs that are the same in all states; for `None`, the next table.
    given: &'a [Option<Vec<f64>>],
    /// The number of tables before the directions.
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
    /// use mozzi_engine::{Batch, Direction};
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
    /// # Ok::<(), mozzi_engine::Error>(())
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
        let moving = direction.inputs.iter().map(Option::is_some).chain([direction.parameters.is_some()]);
        let moving = moving.enumerate().fold(0, |bits, (k, moves)| bits | u32::from(moves) << k);

        let widths: Fixed<usize> = query.output_lengths(model).collect();
        let values = values.iter_mut().map(|table| &mut **table);
        let derivatives = derivatives.iter_mut().map(|table| &mut **table);
        let sizes = outputs.iter().zip(&*widths).chain(outputs.iter().zip(&*widths));
        let results = sizes.zip(values.chain(derivatives));
        let results = results.map(|((output, &width), table)| (output.name, table, width)).collect();
        self.differentiate(request, Derivative::Rates(moving), &tables, of_values, results)
    }

    /// Computes a [`Product`] of derivatives of a quantity with vectors, such as wᵀ∂f or a Hessian's product, at many
    /// states, by its program's steps, forward and backward: exact, without the matrices.
    ///
    /// `further` are the tables (N, …) that the product has: u, v, w. An input's bit in U, V and X is its place among
    /// the quantity's inputs; the bit after them is that of the inertial parameters. `product` has (N, …): the outputs
    /// one after the other, or the gradients.
    ///
    /// ```
    /// use mozzi::quantities::PotentialEnergy;
    /// use mozzi_engine::{Batch, Product};
    /// # use mozzi::{Description, HomeFrames, SE3, ScrewAxis, Screws, Solid};
    /// # let rod = Solid::Box([1.0, 0.02, 0.02]).inertia(1.0);
    /// # let home = [0.5, 1.5, 2.0].map(|x| SE3::translation([x, 0.0, 0.0]));
    /// # let S = [0.0, 1.0].map(|x| ScrewAxis::from_line([0.0, -1.0, 0.0], [x, 0.0, 0.0], 0.0).expect("unit"));
    /// # let model = Description::from_screws("arm", HomeFrames::Base(&home), &[rod; 2], Screws::Space(&S))?.build()?;
    /// let (theta, u, environment) = ([0.3, -0.5], [1.0, 0.0], model.environment().into());
    /// // the Hessian of the potential energy times u: the derivative of g along u
    /// let hessian = Product { along: [0b1, 0], gradient: 0b1 };
    /// let mut found = [0.0; 2];
    /// Batch::new(&model).product(PotentialEnergy, &[&theta], hessian, &[&u, &[1.0]], &environment, &mut found)?;
    /// let expected = model.gravity_forces_derivative(&theta)?;
    /// assert!((found[1] - expected[(1, 0)]).abs() < 1e-13);
    /// # Ok::<(), mozzi_engine::Error>(())
    /// ```
    ///
    /// # Errors
    /// Those of [`compute`](Batch::compute); a table of the product has the wrong length; the program of a robot so
    /// large would be [too long](crate::TooLong).
    ///
    /// # Panics
    /// If the number of inputs or of further tables is not the product's, or a bit is of no input.
    pub fn product<'q>(
        &self,
        query: impl Into<Query<'q>>,
        inputs: &[&[f64]],
        of: Product,
        further: &[&[f64]],
        environment: &BatchEnvironment,
        product: &mut [f64],
    ) -> Result<(), Error> {
        let query = query.into();
        let (model, name) = (self.model(), query.name());
        query.check_subject(model)?;
        let request = Request::new(query, model, environment);
        let mut tables = request.tables(inputs);
        let of_values = tables.len();
        let widths: Fixed<usize> = query.input_lengths(model).chain([model.parameter_count()]).collect();
        let sum = |set: u32| {
            assert!(
                set.checked_shr(widths.len() as u32).is_none_or(|rest| rest == 0),
                "{name} has no input of {set:b}"
            );
            widths.iter().enumerate().filter(|&(k, _)| set >> k & 1 == 1).map(|(_, width)| width).sum::<usize>()
        };
        let length: usize = query.output_lengths(model).sum();
        let along = of.along.into_iter().filter(|&set| set != 0);
        let expected = along.map(|set| ("a direction", sum(set))).chain((of.gradient != 0).then_some(("w", length)));
        let expected: Fixed<(&'static str, usize)> = expected.collect();
        assert!(inputs.len() + 1 == widths.len(), "{name} has {} inputs", widths.len() - 1);
        assert!(further.len() == expected.len(), "the product has {} tables beside the inputs", expected.len());
        let given = expected.iter().zip(further);
        tables.extend(given.map(|(&(name, width), &numbers)| Table { name, numbers, width }));
        let width = if of.gradient == 0 { length } else { sum(of.gradient) };
        let results = [("product", product, width)].into_iter().collect();
        self.differentiate(request, Derivative::Product(of), &tables, of_values, results)
    }

    /// Computes a derivative's program. The tables are those of the request, `of_values` in number, then those of the
    /// directions.
    fn differentiate(
        &self,
        request: Request<f64>,
        derivative: Derivative,
        tables: &[Table<f64>],
        of_values: usize,
        results: Fixed<(&'static str, &mut [f64], usize)>,
    ) -> Result<(), Error> {
        let (query, model) = (request.query, self.model());
        let inputs = query.declaration().inputs;
        let sizes: Fixed<Size> = results.iter().map(|(name, table, width)| (*name, table.len(), *width)).collect();
        let states = self.check(tables, sizes.iter().copied(), &request.environment, request.frames())?;
        let mut frames = Vec::new();
        let its = request.arguments(&mut frames);
        let changed = match derivative {
            Derivative::None => 0,
            Derivative::Rates(moving) => moving,
            Derivative::Product(Product { along: [u, v], gradient }) => u | v | gradient,
        };
        let parameters = its.parameters || changed >> inputs.len() & 1 == 1;
        let arguments = Arguments { parameters, derivative, ..its };
        let mut further = request.constants(&arguments);
        if request.parameters.is_none() && parameters {
            further[0] = Some(model.parameters());
        }
        let directions = tables[of_values..].iter().map(|_| None);
        let given: Vec<_> = inputs.iter().map(|_| None).chain(further).chain(directions).collect();

        let chunks = cut(states, tables, results.into_iter().map(|(_, table, width)| (table, width)).collect());
        let entry = self.programs().entry(&query, &arguments, false);
        let program = entry.program(model, query, arguments)?; // before its code, which is made of it
        self.code(&query, &arguments, states)?;
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

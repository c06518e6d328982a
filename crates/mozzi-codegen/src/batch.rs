//! The compiled robot at many states: its machine code in the place of a batch's kernels.

use crate::compiled::{Compiled, is_regular};
use crate::jit::Kernel;
use crate::quantity::Quantity;
use mozzi::scalar::Float;
use mozzi_batch::{Batch, BlockKernel, Error, Layout};
use std::sync::atomic::{AtomicBool, Ordering};

/// A kernel of as many lanes as the batch's registers have.
struct Block<'k> {
    kernel: &'k Kernel,
    inputs: &'k [usize],
    outputs: &'k [usize],
    /// Its last output is what it divided by: the least and the sum.
    has_pivots: bool,
    means: Means<'k>,
}

/// What becomes of the numbers that tell whether a state's results mean something: pivots, and the squares of the angles.
enum Means<'k> {
    /// They are looked at, and one that does not pass is told here.
    Look(&'k AtomicBool),
    /// They are outputs, too.
    Tell,
}

/// The most inputs or outputs of a quantity.
const MOST: usize = 6;
/// The most lanes.
const LANES: usize = 16;

impl BlockKernel for Block<'_> {
    fn evaluate<T: Float>(&self, inputs: &[T], outputs: &mut [T]) {
        let lanes = self.kernel.shape().lanes();
        let (mut given, mut found): ([&[T]; MOST], [&mut [T]; MOST]) = Default::default();
        let mut rest = inputs;
        for (slice, length) in given.iter_mut().zip(self.inputs) {
            (*slice, rest) = rest.split_at(length * lanes);
        }
        let (mut own_pivots, mut own_squares) = ([T::zero(); 2 * LANES], [T::zero(); LANES]);
        let is_looked_at = matches!(self.means, Means::Look(_));
        let told = self.outputs.len() - usize::from(is_looked_at && self.has_pivots);
        let mut rest = outputs;
        for (slice, length) in found.iter_mut().zip(&self.outputs[..told]) {
            (*slice, rest) = rest.split_at_mut(length * lanes);
        }
        if told < self.outputs.len() {
            found[told] = &mut own_pivots;
        }
        let squares = if is_looked_at { &mut own_squares[..lanes] } else { rest };
        self.kernel.call(&given[..self.inputs.len()], &mut found[..self.outputs.len()], squares);
        if let Means::Look(suspect) = self.means {
            let passes = |lane: usize| {
                self.kernel.is_exact(own_squares[lane])
                    && (!self.has_pivots || is_regular(own_pivots[lane], own_pivots[lanes + lane]))
            };
            if !(0..lanes).all(passes) {
                suspect.store(true, Ordering::Relaxed);
            }
        }
    }
}

impl Compiled {
    /// On this many threads; by default on all cores.
    ///
    /// # Errors
    /// [`Error::Threads`] for none, or where the system gives no more.
    pub fn with_threads(self, threads: usize) -> Result<Self, Error> {
        Ok(Compiled { batch: self.batch.with_threads(threads)?, ..self })
    }

    /// With the tables of many states in this layout; by default in rows.
    pub fn with_layout(self, layout: Layout) -> Self {
        Compiled { batch: self.batch.with_layout(layout), ..self }
    }

    /// What transposes and distributes the states.
    pub fn batch(&self) -> &Batch {
        &self.batch
    }

    /// Fills the outputs by machine code; where there is none, false. Then those states anew at one state whose angles are beyond the
    /// reduction, or whose pivots come near to rounding: `again` answers with their outputs.
    fn fill<const K: usize>(
        &self,
        quantity: Quantity,
        inputs: [(&'static str, &[f64]); K],
        outputs: &mut [(&'static str, &mut [f64])],
        again: impl Fn([&[f64]; K]) -> Result<Vec<Vec<f64>>, mozzi::Error>,
    ) -> Result<bool, Error> {
        let Some(machine) = self.machine(quantity) else { return Ok(false) };
        let (Ok(kernel), n, nq) = (&machine.lanes, self.model.n(), self.model.nq()) else { return Ok(false) };
        let width = |name: &str| if name == "theta" { nq } else { n };
        let widths: Vec<usize> = inputs.iter().map(|(name, _)| width(name)).collect();
        let has_pivots = machine.lane_lengths.len() > outputs.len();
        let given: Vec<_> = inputs.iter().zip(&widths).map(|(&(name, table), &width)| (name, table, width)).collect();
        fn tables<'t>(
            outputs: &'t mut [(&'static str, &mut [f64])],
            lengths: &[usize],
        ) -> Vec<(&'static str, &'t mut [f64], usize)> {
            outputs.iter_mut().zip(lengths).map(|((name, table), &width)| (*name, &mut **table, width)).collect()
        }
        let block = |means| Block { kernel, inputs: &widths, outputs: &machine.lane_lengths, has_pivots, means };
        let suspect = AtomicBool::new(false);
        self.batch.run_kernel(&block(Means::Look(&suspect)), &given, tables(outputs, &machine.lane_lengths))?;
        if !suspect.load(Ordering::Relaxed) {
            return Ok(true);
        }

        // rarely: the same with the numbers that tell which states they are
        let states = inputs[0].1.len() / nq.max(1);
        let (mut pivots, mut squares) = (vec![0.0; if has_pivots { 2 * states } else { 0 }], vec![0.0; states]);
        let mut all = tables(outputs, &machine.lane_lengths);
        all.extend(has_pivots.then_some(("pivots", &mut pivots[..], 2)));
        all.push(("squares", &mut squares, 1));
        self.batch.run_kernel(&block(Means::Tell), &given, all)?;

        let place = self.places();
        let of = |table: &[f64], width: usize, state: usize| -> Vec<f64> {
            (0..width).map(|column| table[place(width, state, column)]).collect()
        };
        for index in 0..states {
            let pivot = |k| pivots[place(2, index, k)];
            if kernel.is_exact(squares[index]) && (!has_pivots || is_regular(pivot(0), pivot(1))) {
                continue;
            }
            let mut k = 0;
            let state: [Vec<f64>; K] = inputs.map(|(_, table)| {
                k += 1;
                of(table, widths[k - 1], index)
            });
            let found = again(state.each_ref().map(Vec::as_slice)).map_err(|source| Error::State { index, source })?;
            for ((_, table), values) in outputs.iter_mut().zip(found) {
                let width = values.len();
                values.iter().enumerate().for_each(|(column, &x)| table[place(width, index, column)] = x);
            }
        }
        Ok(true)
    }

    /// Where a state's number of a column is in a table of some width.
    fn places(&self) -> impl Fn(usize, usize, usize) -> usize + use<> {
        let lanes = match self.batch.layout() {
            Layout::Rows => 1,
            Layout::Blocks => self.batch.lanes(),
        };
        move |width, state, column| (state / lanes * width + column) * lanes + state % lanes
    }
}

/// Methods: tables as of [`Batch`]'s, the machine code or the batch's kernels, and one state's method for states that need a second look.
macro_rules! methods {
    ($(
        $name:ident = $method:ident($($input:ident),*; $($environment:ident)?) -> $($output:ident),* => $quantity:ident, |$found:ident| $columns:expr;
    )*) => { impl Compiled { $(
        #[doc = concat!("See [`Batch::", stringify!($method), "`], in the model's own surroundings.")]
        ///
        /// # Errors
        /// As there.
        #[allow(clippy::too_many_arguments)] // the kernel's
        pub fn $name(&self, $($input: &[f64],)* $($output: &mut [f64]),*) -> Result<(), Error> {
            $(let $environment = self.model.environment();)?
            let again = |state: [&[f64]; [$(stringify!($input)),*].len()]| {
                let [$($input),*] = state;
                let $found = self.model.$method($($input,)* $(&$environment)?)?;
                Ok($columns)
            };
            let outputs = &mut [$((stringify!($output), &mut *$output)),*];
            if self.fill(Quantity::$quantity, [$((stringify!($input), $input)),*], outputs, again)? {
                return Ok(());
            }
            self.batch.$method($($input,)* $(&$environment.into(),)? $($output),*)
        }
    )* } };
}

methods! {
    inverse_dynamics_batch = inverse_dynamics(theta, dtheta, ddtheta; environment) -> tau => InverseDynamics, |tau| vec![tau.as_slice().to_vec()];
    forward_dynamics_batch = forward_dynamics(theta, dtheta, tau; environment) -> ddtheta => ForwardDynamics, |x| vec![x.as_slice().to_vec()];
    bias_forces_batch = bias_forces(theta, dtheta; environment) -> h => BiasForces, |h| vec![h.as_slice().to_vec()];
    velocity_product_batch = velocity_product(theta, dtheta; ) -> c => VelocityProduct, |c| vec![c.as_slice().to_vec()];
    mass_matrix_batch = mass_matrix(theta; ) -> M => MassMatrix, |M| vec![M.as_slice().to_vec()];
    inverse_dynamics_derivatives_batch = inverse_dynamics_derivatives(theta, dtheta, ddtheta; environment)
        -> d_theta, d_dtheta, d_ddtheta => InverseDynamicsDerivatives,
        |d| [d.d_theta, d.d_dtheta, d.d_ddtheta].map(|M| M.transpose().as_slice().to_vec()).to_vec();
    forward_dynamics_derivatives_batch = forward_dynamics_derivatives(theta, dtheta, tau; environment)
        -> ddtheta, d_theta, d_dtheta, d_tau => ForwardDynamicsDerivatives,
        |d| [vec![d.ddtheta.as_slice().to_vec()], [d.d_theta, d.d_dtheta, d.d_tau].map(|M| M.transpose().as_slice().to_vec()).to_vec()].concat();
}

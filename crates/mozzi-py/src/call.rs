//! From arguments to results: one state directly if nothing needs converting; all other calls go through NumPy and a
//! batch.

use crate::arguments::{Arguments, Given};
use crate::array::{Numbers, common_leading, wrong_shape};
use crate::environment::ArrayEnvironment;
use crate::failure::{of_batch, of_model};
use crate::numpy::{self, Fresh};
use crate::results::{Results, callers_arrays};
use crate::robot::{HasEngines, Robot};
use crate::signature::Slot;
use crate::threads::Threads;
use mozzi::quantities::{Declaration, Dim, INPUTS, Input, LIST, MOST_INPUTS, Output, Query};
use pyo3::prelude::*;
use pyo3::types::PyFloat;

/// The most axes of a result at one state.
const MOST_AXES: usize = 3;

// each input has a length of the robot alone, as `Robot::length` assumes
const _: () = {
    let (mut input, mut quantity) = (0, 0);
    while input < INPUTS.len() {
        assert!(matches!(INPUTS[input].dim, Dim::N | Dim::Nq | Dim::Is(_)));
        input += 1;
    }
    while quantity < LIST.len() {
        assert!(LIST[quantity].outputs[0].dims.len() <= MOST_AXES);
        quantity += 1;
    }
};

impl Robot {
    /// The quantity's result: an array, a float, or a named tuple of several.
    pub fn compute<'py>(
        &self,
        py: Python<'py>,
        query: &Query,
        given: &Arguments<'_, 'py>,
        threads: Option<Threads>,
    ) -> PyResult<Bound<'py, PyAny>> {
        query.check_subject(&self.model).map_err(of_model)?;
        let environment = ArrayEnvironment::new(&self.model, given)?;
        let inputs = query.declaration().inputs.iter().zip(given.state());
        let state = inputs.map(|(input, given)| Numbers::new(input.name, given)).collect::<PyResult<Vec<_>>>()?;
        state.iter().try_for_each(|numbers| self.check_shape(numbers))?;
        let out = given.get(Slot::Out);
        if state.iter().all(|numbers| numbers.is_single) && environment.is_single {
            self.at_many::<f32>(py, query, state, environment, out, threads)
        } else {
            self.at_many::<f64>(py, query, state, environment, out, threads)
        }
    }

    /// The single result at one state, for arrays that need no conversion and the robot's own environment; `None` for
    /// all other calls.
    #[inline]
    pub fn at_one_state<'py>(
        &self,
        py: Python<'py>,
        query: &Query,
        given: &Arguments<'_, 'py>,
    ) -> PyResult<Option<Bound<'py, PyAny>>> {
        let &Declaration { inputs: declared, outputs: &[output], .. } = query.declaration() else { return Ok(None) };
        if given.have_environment() {
            return Ok(None);
        }
        let mut inputs: [&[f64]; MOST_INPUTS] = [&[]; MOST_INPUTS];
        for ((slice, array), input) in inputs.iter_mut().zip(given.state()).zip(declared) {
            let Some(numbers) = numpy::vector(array, self.length(input)) else { return Ok(None) };
            *slice = numbers;
        }
        let mut shape = [0; MOST_AXES];
        let shape = &mut shape[..output.dims.len()];
        shape.iter_mut().zip(output.dims).for_each(|(length, dim)| *length = dim.size(&self.model, &query.subject));
        let compute = |out: &mut [f64]| self.one(query, &inputs[..declared.len()], None, &mut [out]).map_err(of_model);
        Ok(Some(match given.get(Slot::Out) {
            Some(out) => match numpy::view_mut::<f64>(out, given.state()) {
                Some((found, numbers)) if found == shape => {
                    compute(numbers)?;
                    out.clone()
                }
                _ => return Ok(None),
            },
            None if shape.is_empty() => {
                let mut number = 0.0;
                compute(std::slice::from_mut(&mut number))?;
                PyFloat::new(py, number).into_any()
            }
            None => {
                let mut fresh = Fresh::<f64>::new(py, shape)?;
                compute(fresh.numbers())?;
                fresh.into_array()
            }
        }))
    }

    /// The length of an input at one state.
    #[inline(always)]
    fn length(&self, input: &Input) -> usize {
        match input.dim {
            Dim::Nq => self.model.nq(),
            Dim::Is(length) => length,
            _ => self.model.n(),
        }
    }

    /// Checks the length of the last axis.
    pub fn check_shape(&self, numbers: &Numbers) -> PyResult<()> {
        self.check_shape_as(numbers, numbers.name)
    }

    /// Like [`check_shape`](Self::check_shape), for an argument with another name but the same kind: a guess is a
    /// `theta`.
    pub fn check_shape_as(&self, numbers: &Numbers, kind: &str) -> PyResult<()> {
        let length = INPUTS.iter().find(|input| input.name == kind).map_or(self.model.n(), |input| self.length(input));
        if numbers.shape.last() == Some(&length) {
            return Ok(());
        }
        let expected = format!("(..., {length}): {}", self.entries(kind));
        Err(wrong_shape(numbers.name, &numbers.shape, expected))
    }

    /// The meaning of an argument's numbers: `one value per joint of 'ur5' (shoulder_pan_joint, …)`.
    fn entries(&self, name: &str) -> String {
        let (model, joints) = (&self.model, self.model.joint_names().len());
        let first = model
            .joint_names()
            .next()
            .map(|first| if joints > 1 { format!(" ({first}, …)") } else { format!(" ({first})") });
        let (robot, first) = (&model.description().name, first.unwrap_or_default());
        match (model.is_floating(), name) {
            (_, "w") => "an angular and a linear part of three numbers".to_string(),
            (false, "theta") if !model.configuration_space().is_flat() => {
                format!("{} positions of {joints} joints of '{robot}'{first}: see position_names", model.nq())
            }
            (false, _) if !model.configuration_space().is_flat() => {
                format!("{} velocities of {joints} joints of '{robot}'{first}: see velocity_names", model.n())
            }
            (false, _) => format!("one value per joint of '{robot}'{first}"),
            (true, "theta") => {
                format!("base quaternion (w, x, y, z), base origin, then {joints} joints of '{robot}'{first}")
            }
            (true, "tau") => format!("wrench (m, f) on the base, then {joints} joints of '{robot}'{first}"),
            (true, _) => format!("base (ω, v), then {joints} joints of '{robot}'{first}"),
        }
    }

    fn at_many<'py, T: HasEngines>(
        &self,
        py: Python<'py>,
        query: &Query,
        mut state: Vec<Numbers<'py>>,
        mut environment: ArrayEnvironment<'py>,
        out: Given<'_, 'py>,
        threads: Option<Threads>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let tables = state.iter().chain(environment.tables());
        let leading = common_leading(tables.map(|table| (table.name, table.leading(1))))?;
        state.iter_mut().chain(environment.tables_mut()).try_for_each(|table| table.spread::<T>(&leading, 1))?;

        let shape = |output: &'static Output| {
            leading.iter().copied().chain(output.shape(&self.model, &query.subject)).collect()
        };
        let shapes: Vec<Vec<usize>> = query.declaration().outputs.iter().map(shape).collect();
        let arrays = callers_arrays(query, out)?;
        let mut results = match &arrays {
            Some(arrays) => {
                let inputs: Vec<_> = state.iter().chain(environment.tables()).map(|table| &table.array).collect();
                Results::<T>::in_arrays(query, &shapes, arrays, &inputs)?
            }
            None => Results::<T>::new(py, &shapes)?,
        };
        let inputs = state.iter().map(Numbers::slice::<T>).collect::<PyResult<Vec<_>>>()?;
        let (same, slices) = (environment.environment(), &mut results.slices()[..]);
        let is_one_state = leading.is_empty() && environment.tables().next().is_none();
        let other = (!environment.is_own).then_some(&same);
        if is_one_state && let Some(found) = T::one_state(self, query, &inputs, other, slices) {
            found.map_err(of_model)?;
        } else {
            let (batch, wrenches) = (self.batch::<T>(threads)?, environment.wrenches()?);
            let environment = environment.of_batch(&wrenches)?;
            py.detach(|| batch.compute(*query, &inputs, &environment, slices))
                .map_err(|error| of_batch(error, &leading))?;
        }
        results.finish(py, query)
    }
}

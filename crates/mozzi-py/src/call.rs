//! From arguments to results: one state at once where nothing needs converting, everything else through NumPy and a batch.

use crate::array::{Numbers, common_leading, function, wrong_shape};
use crate::environment::{Arguments, Around, Given};
use crate::failure::{of_batch, of_model, of_state};
use crate::numpy::{self, Element, Fresh};
use crate::quantity::{AtMany, Quantity};
use crate::robot::{HasEngines, Robot, batch};
use crate::threads::Threads;
use mozzi::FrameId;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyFloat, PyTuple};

/// The last arguments of a method.
#[derive(Default)]
pub struct Options<'a, 'py> {
    pub out: Given<'a, 'py>,
    pub threads: Option<Threads>,
}

/// An argument's name, and what it is.
pub type Named<'a, 'py> = (&'static str, &'a Bound<'py, PyAny>);

impl Robot {
    /// The quantity's result: an array, or of one state's energy a float.
    #[inline(always)]
    pub fn ask<'py, const K: usize>(
        &self,
        py: Python<'py>,
        quantity: Quantity,
        state: [Named<'_, 'py>; K],
        around: Arguments<'_, 'py>,
        options: Options<'_, 'py>,
    ) -> PyResult<Bound<'py, PyAny>> {
        if around.are_none()
            && let Some(found) = self.at_one_state(py, quantity, state, options.out)?
        {
            return Ok(found);
        }
        let mut found = self.ask_all(py, quantity, &state, &around, options)?;
        Ok(found.swap_remove(0))
    }

    /// τ, θ̈, h, c and matrices of arrays that need no conversion; `None` for all others.
    #[inline(always)]
    fn at_one_state<'py, const K: usize>(
        &self,
        py: Python<'py>,
        quantity: Quantity,
        state: [Named<'_, 'py>; K],
        out: Given<'_, 'py>,
    ) -> PyResult<Option<Bound<'py, PyAny>>> {
        let (n, nq) = (self.model.n(), self.model.nq());
        let shape: &[usize] = match quantity {
            Quantity::InverseDynamics
            | Quantity::ForwardDynamics
            | Quantity::BiasForces
            | Quantity::VelocityProduct
            | Quantity::GravityForces => &[n],
            Quantity::MassMatrix | Quantity::CoriolisMatrix | Quantity::MassMatrixRate => &[n, n],
            Quantity::ForwardKinematics(_) => &[4, 4],
            Quantity::SpaceJacobian(_) | Quantity::BodyJacobian(_) => &[6, n],
            _ => return Ok(None),
        };
        let mut slices: [&[f64]; K] = [&[]; K];
        for (k, (_, array)) in state.iter().enumerate() {
            match numpy::view::<f64>(array) {
                Some((&[length], numbers)) if length == if k == 0 { nq } else { n } => slices[k] = numbers,
                _ => return Ok(None),
            }
        }
        let compute = |out: &mut [f64]| self.one(quantity, &slices, None, &mut [out]).map_err(of_model);
        if let Some(out) = out {
            return match numpy::view_mut::<f64>(out, &state.map(|(_, array)| array)) {
                Some((found, numbers)) if found == shape => compute(numbers).map(|()| Some(out.clone())),
                _ => Ok(None),
            };
        }
        let mut fresh = Fresh::<f64>::new(py, shape)?;
        compute(fresh.numbers())?;
        Ok(Some(fresh.into_array()))
    }

    /// All results of the quantity.
    pub fn ask_all<'py>(
        &self,
        py: Python<'py>,
        quantity: Quantity,
        state: &[Named<'_, 'py>],
        around: &Arguments<'_, 'py>,
        options: Options<'_, 'py>,
    ) -> PyResult<Vec<Bound<'py, PyAny>>> {
        if let Quantity::TaskSpaceDynamics(task) = quantity {
            task.check(&self.model).map_err(of_model)?;
        }
        let around = Around::new(&self.model, around)?;
        let state = state.iter().map(|&(name, given)| Numbers::new(name, given)).collect::<PyResult<Vec<_>>>()?;
        state.iter().try_for_each(|numbers| self.check_shape(numbers))?;
        if state.iter().all(|numbers| numbers.is_single) && around.is_single {
            self.at_many::<f32>(py, quantity, state, around, options)
        } else {
            self.at_many::<f64>(py, quantity, state, around, options)
        }
    }

    /// Is the last axis as long as it must be?
    pub fn check_shape(&self, numbers: &Numbers) -> PyResult<()> {
        let length = if numbers.name == "theta" { self.model.nq() } else { self.model.n() };
        if numbers.shape.last() == Some(&length) {
            return Ok(());
        }
        let expected = format!("(..., {length}): {}", self.entries(numbers.name));
        Err(wrong_shape(numbers.name, &numbers.shape, expected))
    }

    /// What the numbers of an argument are: `one value per joint of 'ur5' (shoulder_pan_joint, …)`.
    fn entries(&self, name: &str) -> String {
        let (model, joints) = (&self.model, self.model.joint_names().len());
        let first = model
            .joint_names()
            .next()
            .map(|first| if joints > 1 { format!(" ({first}, …)") } else { format!(" ({first})") });
        let (robot, first) = (&model.description().name, first.unwrap_or_default());
        match (model.is_floating(), name) {
            (false, _) => format!("one value per joint of '{robot}'{first}"),
            (true, "theta") => {
                format!("base quaternion (w, x, y, z), base origin, then {joints} joints of '{robot}'{first}")
            }
            (true, "tau") => format!("wrench (m, f) on the base, then {joints} joints of '{robot}'{first}"),
            (true, _) => format!("base (ω, v), then {joints} joints of '{robot}'{first}"),
        }
    }

    fn at_many<'py, T: Element + HasEngines + AtMany>(
        &self,
        py: Python<'py>,
        quantity: Quantity,
        mut state: Vec<Numbers<'py>>,
        mut around: Around<'py>,
        options: Options<'_, 'py>,
    ) -> PyResult<Vec<Bound<'py, PyAny>>> {
        let tables = around.tables.iter().map(|(_, table)| table);
        let leadings: Vec<_> = state.iter().chain(tables).map(|table| (table.name, table.leading(1))).collect();
        let leading = common_leading(&leadings)?;
        state.iter_mut().try_for_each(|numbers| numbers.spread::<T>(&leading, 1))?;
        around.tables.iter_mut().try_for_each(|(_, table)| table.spread::<T>(&leading, 1))?;

        let shapes: Vec<Vec<usize>> =
            quantity.shapes(&self.model).into_iter().map(|tail| [&leading[..], &tail].concat()).collect();
        if let Some(out) = options.out {
            return self.write_out::<T>(py, quantity, &state, &around, &options, (&leading, &shapes[0]), out);
        }
        let mut fresh = shapes.iter().map(|shape| Fresh::<T>::new(py, shape)).collect::<PyResult<Vec<_>>>()?;
        let mut slices: Vec<&mut [T]> = fresh.iter_mut().map(Fresh::numbers).collect();
        self.compute::<T>(py, quantity, &state, &around, options.threads, &leading, &mut slices)?;
        let scalar = leading.is_empty() && matches!(quantity, Quantity::KineticEnergy | Quantity::PotentialEnergy);
        let finish = |mut array: Fresh<'py, T>| match scalar {
            true => PyFloat::new(py, array.numbers()[0].to_f64()).into_any(),
            false => array.into_array(),
        };
        Ok(fresh.into_iter().map(finish).collect())
    }

    /// Results in the caller's array: written there if it can be, else converted by NumPy.
    #[allow(clippy::too_many_arguments)]
    fn write_out<'py, T: Element + HasEngines + AtMany>(
        &self,
        py: Python<'py>,
        quantity: Quantity,
        state: &[Numbers<'py>],
        around: &Around<'py>,
        options: &Options<'_, 'py>,
        (leading, shape): (&[usize], &[usize]),
        out: &Bound<'py, PyAny>,
    ) -> PyResult<Vec<Bound<'py, PyAny>>> {
        if !out.is_instance(&function(py, "ndarray")?)? {
            return Err(PyTypeError::new_err("out is no array, expected a numpy.ndarray"));
        }
        let found: Vec<usize> = out.getattr("shape")?.extract()?;
        if found != shape {
            return Err(wrong_shape("out", &found, crate::array::shown(shape)));
        }
        let tables = around.tables.iter().map(|(_, table)| &table.array);
        let inputs: Vec<_> = state.iter().map(|numbers| &numbers.array).chain(tables).collect();
        match numpy::view_mut::<T>(out, &inputs) {
            Some((_, numbers)) => {
                self.compute::<T>(py, quantity, state, around, options.threads, leading, &mut [numbers])?;
            }
            None => {
                let mut fresh = Fresh::<T>::new(py, shape)?;
                self.compute::<T>(py, quantity, state, around, options.threads, leading, &mut [fresh.numbers()])?;
                function(py, "copyto")?.call1((out, fresh.into_array()))?;
            }
        }
        Ok(vec![out.clone()])
    }

    #[allow(clippy::too_many_arguments)]
    fn compute<'py, T: Element + HasEngines + AtMany>(
        &self,
        py: Python<'py>,
        quantity: Quantity,
        state: &[Numbers<'py>],
        around: &Around<'py>,
        threads: Option<Threads>,
        leading: &[usize],
        out: &mut [&mut [T]],
    ) -> PyResult<()> {
        let slices = state.iter().map(Numbers::slice::<T>).collect::<PyResult<Vec<_>>>()?;
        let tables: Vec<(FrameId, &[T])> = around.slices()?;
        let states: usize = leading.iter().product();
        let alone = leading.is_empty() && tables.is_empty() && T::PLACE == f64::PLACE;
        if let Some(compiled) = self.compiled_for_many(threads)
            && (!alone && around.is_own)
            && let Some(result) = py.detach(|| T::many_compiled(compiled, quantity, &slices, out))
        {
            return result.map_err(|error| of_batch(error, leading));
        }
        if !alone && self.model.nq() > 0 {
            let batch = batch::<T>(self, threads)?;
            let surroundings = around.surroundings(&tables);
            let found = py.detach(|| T::many(quantity, &batch, &slices, &surroundings, out));
            if let Some(result) = found {
                return result.map_err(|error| of_batch(error, leading));
            }
        }
        // one after the other, in f64
        let widths: Vec<usize> = state.iter().map(|numbers| numbers.shape[numbers.shape.len() - 1]).collect();
        let lengths: Vec<usize> = out.iter().map(|out| out.len() / states.max(1)).collect();
        let environment = around.environment();
        let mut applied = environment.applied.to_vec();
        let fixed = applied.len();
        let mut found: Vec<Vec<f64>> = lengths.iter().map(|&length| vec![0.0; length]).collect();
        for index in 0..states {
            let row = |table: &[T], width: usize| -> Vec<f64> {
                table[index * width..][..width].iter().map(|&x| x.to_f64()).collect()
            };
            let rows: Vec<Vec<f64>> = slices.iter().zip(&widths).map(|(table, &width)| row(table, width)).collect();
            let rows: Vec<&[f64]> = rows.iter().map(Vec::as_slice).collect();
            applied.truncate(fixed);
            for (frame, table) in &tables {
                let mut wrench = [0.0; 6];
                wrench.copy_from_slice(&row(table, 6));
                applied.push((*frame, mozzi::Wrench::from_array(wrench)));
            }
            let environment = mozzi::Environment { applied: &applied, ..environment };
            let mut results: Vec<&mut [f64]> = found.iter_mut().map(Vec::as_mut_slice).collect();
            let environment = (!around.is_own).then_some(&environment);
            self.one(quantity, &rows, environment, &mut results).map_err(|error| of_state(error, index, leading))?;
            for ((out, found), &length) in out.iter_mut().zip(&found).zip(&lengths) {
                let place = &mut out[index * length..][..length];
                place.iter_mut().zip(found).for_each(|(out, &x)| *out = T::from_f64(x));
            }
        }
        Ok(())
    }
}

/// Results as a named tuple of `mozzi._results`.
pub fn named<'py>(py: Python<'py>, class: &str, fields: Vec<Bound<'py, PyAny>>) -> PyResult<Bound<'py, PyAny>> {
    py.import("mozzi._results")?.getattr(class)?.call1(PyTuple::new(py, fields)?)
}

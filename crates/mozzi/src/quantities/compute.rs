//! Quantities at one state: checked, computed, pivots judged.

use super::{Declaration, MassMatrix, Memory, Of, Query};
use crate::linalg::Vec3;
use crate::model::{Environment, Error, Model, Pivots};
use crate::scalar::Scalar;
use crate::spatial::Wrench;
use alloc::vec;
use alloc::vec::Vec;
use nalgebra::{DMatrix, DVector};

impl Model<f64> {
    /// Any quantity at one state: its outputs in their order, matrices by rows. Parts of the environment that the
    /// quantity does not use have no effect.
    ///
    /// # Errors
    /// [`Error::WrongLength`] and [`Error::BadArgument`] naming the argument; [`Error::SingularMassMatrix`] naming the
    /// joint, [`Error::SingularTask`].
    ///
    /// # Panics
    /// On another number of inputs than its [declaration](Query::declaration) has.
    pub fn compute<'q>(
        &self,
        query: impl Into<Query<'q>>,
        inputs: &[&[f64]],
        environment: &Environment,
    ) -> Result<Vec<Vec<f64>>, Error> {
        self.compute_in(&mut Memory::new(self), query.into(), inputs, environment)
    }

    /// [`compute`](Self::compute) with this memory.
    pub(crate) fn compute_in(
        &self,
        memory: &mut Memory,
        query: Query,
        inputs: &[&[f64]],
        environment: &Environment,
    ) -> Result<Vec<Vec<f64>>, Error> {
        query.check(self, inputs, environment)?;
        let mut outputs: Vec<Vec<f64>> = query.output_lengths(self).map(|length| vec![0.0; length]).collect();
        let mut slices: Vec<&mut [f64]> = outputs.iter_mut().map(Vec::as_mut_slice).collect();
        query.evaluate_f64(self, inputs, environment, memory, &mut slices);
        query.check_pivots(self, inputs[0], memory)?;
        Ok(outputs)
    }

    /// The first output of a quantity.
    pub(crate) fn first<'q>(
        &self,
        query: impl Into<Query<'q>>,
        inputs: &[&[f64]],
        environment: &Environment,
    ) -> Result<Vec<f64>, Error> {
        Ok(self.compute(query, inputs, environment)?.swap_remove(0))
    }

    pub(crate) fn vector<'q>(
        &self,
        query: impl Into<Query<'q>>,
        inputs: &[&[f64]],
        environment: &Environment,
    ) -> Result<DVector<f64>, Error> {
        Ok(DVector::from_vec(self.first(query, inputs, environment)?))
    }

    /// The first output, with n columns.
    pub(crate) fn matrix<'q>(
        &self,
        query: impl Into<Query<'q>>,
        inputs: &[&[f64]],
        environment: &Environment,
    ) -> Result<DMatrix<f64>, Error> {
        Ok(self.rows(&self.first(query, inputs, environment)?))
    }

    /// A matrix of n columns from its rows.
    pub(crate) fn rows(&self, entries: &[f64]) -> DMatrix<f64> {
        let columns = self.n();
        DMatrix::from_row_slice(entries.len().checked_div(columns).unwrap_or(0), columns, entries)
    }

    pub(crate) fn point(&self, query: impl Into<Query<'static>>, inputs: &[&[f64]]) -> Result<Vec3, Error> {
        let found = self.first(query, inputs, &self.environment())?;
        Ok(Vec3(core::array::from_fn(|k| found[k])))
    }

    pub(crate) fn wrench(&self, query: Query, inputs: &[&[f64]]) -> Result<Wrench, Error> {
        let found = self.first(query, inputs, &self.environment())?;
        Ok(Wrench::from_array(core::array::from_fn(|k| found[k])))
    }

    /// M(θ) by rows, lengths being checked.
    pub(crate) fn mass_matrix_rows(&self, theta: &[f64]) -> Vec<f64> {
        let mut M = vec![0.0; self.n() * self.n()];
        let (memory, environment) = (&mut Memory::new(self), self.environment());
        Query::from(MassMatrix).evaluate_f64(self, &[theta], &environment, memory, &mut [&mut M]);
        M
    }
}

impl Query<'_> {
    /// On plain `f64`, compiled in this crate.
    pub(crate) fn evaluate_f64(
        &self,
        model: &Model,
        inputs: &[&[f64]],
        environment: &Environment,
        memory: &mut Memory,
        outputs: &mut [&mut [f64]],
    ) {
        self.evaluate(model, inputs, environment, memory, outputs);
    }

    /// Checks that the pivots of the quantity are regular.
    ///
    /// # Errors
    /// [`Error::SingularMassMatrix`], [`Error::SingularTask`].
    pub(crate) fn check_pivots(&self, model: &Model, theta: &[f64], memory: &Memory) -> Result<(), Error> {
        let Declaration { divides, of, .. } = self.declaration();
        if !divides {
            return Ok(());
        }
        Pivots::new(memory.workspace.pivots()).check(model, theta, || model.mass_matrix_rows(theta))?;
        match memory.task() {
            Some(task) if *of == Of::Task => task.check(model.n(), theta),
            _ => Ok(()),
        }
    }
}

/// True if every pivot of a quantity's last call is well above rounding error. If false, [`Model::compute`] checks each
/// pivot.
pub(crate) fn are_clear<S: Scalar + Into<f64>>(declaration: &Declaration, memory: &Memory<S>) -> bool {
    // an earlier task's pivots do not matter to other quantities
    let pivots = || memory.pivots().take(if declaration.of == Of::Task { 2 } else { 1 });
    !declaration.divides || pivots().all(|pivots| Pivots::new(pivots).are_clear())
}

pub(crate) fn vectors<const K: usize>(found: Vec<Vec<f64>>) -> [DVector<f64>; K] {
    let mut found = found.into_iter();
    core::array::from_fn(|_| DVector::from_vec(found.next().unwrap_or_default()))
}

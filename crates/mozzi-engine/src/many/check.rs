//! The lengths of tables, frames and quaternions, checked before a call computes anything.

use crate::many::chunk::Table;
use crate::{Batch, Error, Number};
use mozzi::{Environment, FrameId, Freedom};

/// A table's name, its length and its number of columns for each state.
pub(crate) type Size = (&'static str, usize, usize);

impl<T: Number> Batch<T> {
    /// The number of states: from the length of the first table; for a robot without joints, of the first table that
    /// has numbers for each state.
    ///
    /// # Errors
    /// A table's length does not match it, a frame belongs to another model, or a quaternion has not length 1.
    pub(crate) fn check(
        &self,
        inputs: &[Table<T>],
        outputs: impl Iterator<Item = Size> + Clone,
        environment: &Environment,
        frames: impl Iterator<Item = FrameId>,
    ) -> Result<usize, Error> {
        let model = self.model();
        let mut all = inputs.iter().map(|table| (table.name, table.numbers.len(), table.width)).chain(outputs);
        let states = match all.clone().find(|&(_, _, width)| width > 0) {
            Some((what, found, width)) if !found.is_multiple_of(width) => {
                return Err(Error::IncompleteState { what, found, width });
            }
            Some((_, found, width)) => found / width,
            None => 0,
        };
        if let Some((what, found, width)) = all.find(|&(_, found, width)| found != states * width) {
            return Err(Error::WrongLength { what, found, expected: states * width, states, width });
        }
        frames.into_iter().try_for_each(|frame| model.check_frame(frame))?;
        model.check_environment(environment)?;
        match inputs.first() {
            Some(theta) if theta.name == "theta" => self.check_quaternions(theta, states)?,
            _ => {}
        }
        Ok(states)
    }

    /// Checks the length of each quaternion, of a floating base, balls and free joints.
    fn check_quaternions(&self, theta: &Table<T>, states: usize) -> Result<(), Error> {
        let (near, one) = (T::from_f64(1e-4), T::one());
        let joints = self.model().configuration_space().places().iter().filter(|joint| joint.freedom != Freedom::One);
        let first: Vec<usize> = joints.map(|joint| joint.q).collect();
        if first.is_empty() {
            return Ok(());
        }
        for index in 0..states {
            let row = theta.row(index);
            let square = |first: usize| row[first..][..4].iter().fold(T::zero(), |sum, &x| sum + x * x);
            let is_unit = |square: T| (square - one) <= near && (one - square) <= near;
            if !first.iter().all(|&first| is_unit(square(first))) {
                let row: Vec<f64> = row.iter().map(|&x| x.into()).collect();
                self.model()
                    .check_configuration(&row)
                    .map_err(|source| Error::State { index, source: source.into() })?;
            }
        }
        Ok(())
    }
}

//! Recorders: they receive the rows of a simulation.

use crate::{Energy, Sample, Trajectory};
use core::ops::ControlFlow;
use mozzi::model::Model;

/// Takes the rows of a simulation one by one, in the order of time: a [`Trajectory`] keeps them, [`Thinned`] keeps
/// some, [`Account`] keeps a summary of their energy, and a recorder of your own can write them to a file. A pair of
/// recorders passes each row to both.
pub trait Recorder {
    /// One row. `ControlFlow::Break(())` ends the simulation there, for instance because a disk is full.
    fn take(&mut self, row: &Sample) -> ControlFlow<()>;
}

impl<R: Recorder + ?Sized> Recorder for &mut R {
    fn take(&mut self, row: &Sample) -> ControlFlow<()> {
        (**self).take(row)
    }
}

/// Both.
impl<A: Recorder, B: Recorder> Recorder for (A, B) {
    fn take(&mut self, row: &Sample) -> ControlFlow<()> {
        self.0.take(row)?;
        self.1.take(row)
    }
}

/// None, or the one.
impl<R: Recorder> Recorder for Option<R> {
    fn take(&mut self, row: &Sample) -> ControlFlow<()> {
        self.as_mut().map_or(ControlFlow::Continue(()), |recorder| recorder.take(row))
    }
}

impl Recorder for Trajectory {
    fn take(&mut self, row: &Sample) -> ControlFlow<()> {
        self.record(*row);
        ControlFlow::Continue(())
    }
}

/// The energy summary of a motion's rows: [`Trajectory::largest_drift`] and [`Trajectory::largest_kinetic_energy`]
/// without the rows.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Account {
    /// Rows so far.
    pub rows: usize,
    /// The energies of the first row.
    pub first: Energy,
    /// The energies of the last row.
    pub last: Energy,
    /// max |drift|, J.
    pub largest_drift: f64,
    /// max 𝒦, J.
    pub largest_kinetic_energy: f64,
}

/// A drift above this part of the largest kinetic energy is an error of the step.
const OFF: f64 = 0.01;
/// Smaller motions have too little energy to judge, as a part of the energies' size.
const MOVES: f64 = 1e-3;

impl Account {
    /// True if the drift is more than a hundredth of the largest kinetic energy, of a robot that moves.
    pub fn is_off(&self) -> bool {
        let size = self.first.potential.abs().max(self.last.potential.abs());
        self.largest_kinetic_energy > MOVES * size && self.largest_drift > OFF * self.largest_kinetic_energy
    }
}

impl Recorder for Account {
    fn take(&mut self, row: &Sample) -> ControlFlow<()> {
        if self.rows == 0 {
            self.first = row.energy;
        }
        self.rows += 1;
        self.last = row.energy;
        self.largest_drift = self.largest_drift.max(row.energy.drift_since(&self.first).abs());
        self.largest_kinetic_energy = self.largest_kinetic_energy.max(row.energy.kinetic);
        ControlFlow::Continue(())
    }
}

/// The stride s for keeping every s-th row, and the last, in at most `at_most` rows, at least two: the first of 1, 2,
/// 10, 20, 100, … that suffices, so that time steps stay decimal.
pub fn stride(rows: usize, at_most: usize) -> usize {
    let last = rows.saturating_sub(1);
    let (mut stride, mut factors) = (1, [2, 5].into_iter().cycle());
    while last.div_ceil(stride) >= at_most.max(2) {
        stride *= factors.next().unwrap_or(2);
    }
    stride
}

/// Every s-th row of a motion, and the last: at most a given number, however long the motion is. See [`stride`].
#[derive(Clone, Debug)]
pub struct Thinned {
    at_most: usize,
    stride: usize,
    rows: usize,
    kept: Trajectory,
    last: Trajectory,
}

impl Thinned {
    /// For this robot, with at most `at_most` rows, at least two.
    pub fn new(model: &Model, at_most: usize) -> Self {
        Thinned { at_most, stride: 1, rows: 0, kept: Trajectory::new(model), last: Trajectory::new(model) }
    }

    /// The number of rows received.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// The rows that were kept, with the last.
    pub fn into_trajectory(mut self) -> Trajectory {
        if self.rows > 0 && !(self.rows - 1).is_multiple_of(self.stride) {
            self.kept.record(self.last.last());
        }
        self.kept
    }
}

impl Recorder for Thinned {
    fn take(&mut self, row: &Sample) -> ControlFlow<()> {
        self.rows += 1;
        let stride = stride(self.rows, self.at_most);
        if stride != self.stride {
            self.kept.keep_every(stride / self.stride);
            self.stride = stride;
        }
        if (self.rows - 1).is_multiple_of(self.stride) {
            self.kept.record(*row);
        } else {
            self.last.clear();
            self.last.record(*row);
        }
        ControlFlow::Continue(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simulate;
    use crate::tests::robots::double_pendulum;
    use crate::{Method, Options, Simulation, Zero};
    use alloc::vec::Vec;

    #[test]
    fn strides_stay_decimal_and_within_the_bound() {
        assert_eq!([11, 21, 22, 101, 10_001].map(|rows| stride(rows, 11)), [1, 2, 10, 10, 1000]);
        for rows in 0..3000 {
            for at_most in [2, 3, 10, 77] {
                let s = stride(rows, at_most);
                let kept = (0..rows).filter(|row| row % s == 0 || row + 1 == rows).count();
                assert!(kept <= at_most && s <= stride(rows + 1, at_most), "{rows} {at_most} {s}");
            }
        }
    }

    #[test]
    fn recorders_agree_with_the_whole_motion() {
        let (model, simulation) = (double_pendulum(), Simulation::new(Options::new(1.0, 1000)));
        let start = ([1.0, 0.5], [0.0, 0.0]);
        let whole = simulate(&model, &start.0, &start.1, Zero, &simulation.options).expect("a motion");
        for at_most in [2, 30, 500, 1002, 5000] {
            let (mut thinned, mut account) = (Thinned::new(&model, at_most), Account::default());
            let mut both = (&mut thinned, &mut account);
            let ending = simulation.stream(&model, &start.0, &start.1, Zero, &mut both, |_| ControlFlow::Continue(()));
            assert!(ending.expect("a motion").complete);
            assert_eq!((account.rows, account.last), (1001, whole.last().energy));
            assert_eq!(account.largest_drift, whole.largest_drift());
            assert_eq!(account.largest_kinetic_energy, whole.largest_kinetic_energy());
            let (s, kept) = (stride(1001, at_most), thinned.into_trajectory());
            assert!(kept.len() <= at_most, "{}", kept.len());
            let expected: Vec<_> = (0..1001).filter(|k| k % s == 0 || *k == 1000).map(|k| whole.sample(k)).collect();
            assert!(kept.samples().eq(expected));
        }
    }

    #[test]
    fn a_recorder_can_end_the_simulation() {
        struct Full(usize);
        impl Recorder for Full {
            fn take(&mut self, _: &Sample) -> ControlFlow<()> {
                self.0 -= 1;
                if self.0 == 0 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
            }
        }
        let model = double_pendulum();
        let methods = [(Method::RungeKutta4, 4), (Method::Midpoint, 4), (Method::DormandPrince { tolerance: 1e-3 }, 1)];
        for (method, steps) in methods {
            let simulation = Simulation::new(Options { method, ..Options::new(1.0, 1000) });
            for (room, steps) in [(1, 0), (5, steps)] {
                let mut full = Full(room);
                let going = |_| ControlFlow::Continue(());
                let ending = simulation.stream(&model, &[1.0, 0.5], &[0.0; 2], Zero, &mut full, going);
                let ending = ending.expect("a motion");
                assert!(!ending.complete && full.0 == 0 && (ending.steps > 0) == (steps > 0), "{ending:?}");
                assert!(method.is_adaptive() || ending.steps == steps);
            }
        }
    }
}

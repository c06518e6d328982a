//! `mozzi.InverseKinematics`.

use super::goals::Goals;
use super::solutions::{Found, solution};
use crate::arguments::Given;
use crate::array::{Numbers, common_leading};
use crate::counts::count;
use crate::describe::refused;
use crate::failure::{of_motion, of_one_motion};
use crate::interrupt::Interrupt;
use crate::model::{PyModel, array};
use crate::threads::Threads;
use mozzi::{FrameId, Model};
use mozzi_motion::inverse_kinematics::{Method, Options, Secondary};
use mozzi_motion::{Error, Goal, InverseKinematics};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use std::cell::RefCell;
use std::panic::resume_unwind;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Inverse kinematics: joint positions θ that place a frame at a desired pose, position or orientation.
///
/// See Modern Robotics, chapter 6. A step is δ = Jᵀ(JJᵀ + λI)⁻¹e with the body twist e = log(T⁻¹T_d) and the body
/// Jacobian J. A joint at its limit is held there. A start without progress is replaced by a random one. An iteration
/// costs O(n).
///
/// Parameters
/// ----------
/// model : Model
///     The robot.
/// frame : str, optional
///     The frame to be placed. Default: the end effector.
/// method : {'levenberg-marquardt', 'newton'}
///     Damping: λ = ‖e‖²/50, or λ = 0 (Newton-Raphson by the pseudo-inverse).
/// angle_tolerance, distance_tolerance : float
///     Tolerances on the angle, rad, and on the distance, m, to the goal.
/// iterations : int
///     Maximum number of iterations of one start.
/// starts : int
///     Maximum number of starts: the first is the guess, the others are random positions within the limits.
/// seed : int
///     Seed of the random starts; results are reproducible.
/// length : float
///     Length that is weighted like one radian, m.
/// limits : bool
///     True to keep the joints within their position limits.
///
/// Raises
/// ------
/// ValueError
///     For an unknown frame, and for options outside of their domain.
///
/// Examples
/// --------
/// >>> import mozzi
/// >>> ur5 = mozzi.models.ur5()
/// >>> goal = ur5.forward_kinematics([0.3, -1.2, 1.4, -0.5, 0.9, 2.0])
/// >>> found = mozzi.InverseKinematics(ur5).solve([0.0] * 6, pose=goal)
/// >>> found.reached, bool(abs(ur5.forward_kinematics(found.theta) - goal).max() < 1e-7)
/// (True, True)
#[pyclass(frozen, name = "InverseKinematics", module = "mozzi")]
pub struct PyInverseKinematics {
    model: Py<PyModel>,
    frame: FrameId,
    options: Options,
}

impl PyInverseKinematics {
    fn robot(&self) -> &Model {
        &self.model.get().robot().model
    }

    fn solver(&self) -> Result<InverseKinematics<'_>, Error> {
        InverseKinematics::with_options(self.robot(), self.frame, self.options)
    }

    /// Solves all targets on this many threads; each thread takes the next unsolved target.
    fn solve_on_threads(&self, count: usize, tasks: &[Task], interrupt: &Interrupt) -> Result<Vec<Found>, Failure> {
        let next = AtomicUsize::new(0);
        let work = |stop: &dyn Fn() -> bool| -> Result<Vec<(usize, Found)>, Failure> {
            let mut found = Vec::new();
            let mut solver = self.solver().map_err(|error| Box::new((0, error)))?;
            loop {
                let index = next.fetch_add(1, Ordering::Relaxed);
                let Some(Task { goal, guess, near }) = tasks.get(index).filter(|_| !stop()) else { return Ok(found) };
                let secondary = near.map_or(Secondary::None, Secondary::Near);
                let one =
                    Found::of(solver.solve_with(*goal, guess, &secondary)).map_err(|error| Box::new((index, error)))?;
                found.push((index, one));
            }
        };
        let mut parts = std::thread::scope(|scope| {
            let others: Vec<_> =
                (1..count.min(tasks.len())).map(|_| scope.spawn(|| work(&|| interrupt.is_raised()))).collect();
            let mut parts = vec![work(&|| interrupt.stop())];
            parts.extend(others.into_iter().map(|other| other.join().unwrap_or_else(|panic| resume_unwind(panic))));
            parts
        });
        // if several targets failed, the first one's error
        parts.sort_by_key(|part| part.as_ref().err().map_or(usize::MAX, |failure| failure.0));
        let mut all: Vec<(usize, Found)> =
            parts.into_iter().collect::<Result<Vec<_>, Failure>>()?.into_iter().flatten().collect();
        all.sort_by_key(|(index, _)| *index);
        Ok(all.into_iter().map(|(_, found)| found).collect())
    }

    /// Solves all targets, one after the other, with H given by a Python function.
    fn solve_minimizing(&self, function: &Bound<'_, PyAny>, tasks: &[Task], leading: &[usize]) -> PyResult<Vec<Found>> {
        let (py, raised) = (function.py(), RefCell::new(None));
        let H = |theta: &[f64], gradient: &mut [f64]| {
            minimized(py, function, theta, gradient).unwrap_or_else(|error| {
                gradient.fill(0.0); // with a zero gradient the solver stops
                raised.borrow_mut().get_or_insert(error);
                0.0
            })
        };
        let mut solver = self.solver().map_err(of_motion)?;
        let mut all = Vec::with_capacity(tasks.len());
        for (index, Task { goal, guess, .. }) in tasks.iter().enumerate() {
            let found = solver.solve_with(*goal, guess, &Secondary::Minimize(&H));
            if let Some(error) = raised.borrow_mut().take() {
                return Err(error);
            }
            all.push(Found::of(found).map_err(|error| of_one_motion(error, index, leading))?);
            py.check_signals()?;
        }
        Ok(all)
    }
}

/// The index of a target, and its error.
type Failure = Box<(usize, Error)>;

/// One target.
struct Task<'a> {
    goal: Goal,
    guess: &'a [f64],
    near: Option<&'a [f64]>,
}

/// H(θ) and its gradient, by a Python function that returns both.
fn minimized(py: Python<'_>, function: &Bound<'_, PyAny>, theta: &[f64], gradient: &mut [f64]) -> PyResult<f64> {
    let answer = function.call1((array(py, &[theta.len()], theta.iter().copied())?,))?;
    let (H, slope): (f64, Bound<'_, PyAny>) = answer.extract().map_err(|_| {
        PyValueError::new_err(format!("minimize answered {answer}, expected H, a float, and its gradient"))
    })?;
    let slope = crate::array::list("the gradient of minimize", &slope, &[gradient.len()])?;
    gradient.copy_from_slice(&slope);
    Ok(H)
}

#[pymethods]
impl PyInverseKinematics {
    #[new]
    #[pyo3(signature = (
        model, frame=None, *, method="levenberg-marquardt", angle_tolerance=1e-8, distance_tolerance=1e-8,
        iterations=60, starts=200, seed=0, length=1.0, limits=true,
    ))]
    #[allow(clippy::too_many_arguments)] // Python's
    fn new(
        model: Py<PyModel>,
        frame: Option<&str>,
        method: &str,
        angle_tolerance: f64,
        distance_tolerance: f64,
        iterations: i64,
        starts: i64,
        seed: u64,
        length: f64,
        limits: bool,
    ) -> PyResult<Self> {
        let method = match method {
            "levenberg-marquardt" => Method::LevenbergMarquardt,
            "newton" => Method::Newton,
            other => return Err(refused(format!("method is '{other}', expected 'levenberg-marquardt' or 'newton'"))),
        };
        let (angle, distance) = (angle_tolerance, distance_tolerance);
        let (iterations, starts) = (count("iterations", iterations)?, count("starts", starts)?);
        let options = Options { method, angle, distance, iterations, starts, seed, length, limits };
        let frame = model.get().frame(frame)?;
        let solver = PyInverseKinematics { model, frame, options };
        solver.solver().map_err(of_motion)?; // checks the options
        Ok(solver)
    }

    /// Find joint positions that reach a goal, for one target or for many.
    ///
    /// Many targets are divided among all cores, unless `minimize` is given.
    ///
    /// Parameters
    /// ----------
    /// guess : array_like, shape (..., nq)
    ///     Positions from which the search starts: rad or m.
    /// pose : array_like, shape (..., 4, 4), optional
    ///     T_sb, the pose of the frame seen from {s}. One of `pose`, `position` and `orientation` is the goal.
    /// position : array_like, shape (..., 3), optional
    ///     The frame's origin in {s}, m, whatever its orientation.
    /// orientation : array_like, shape (..., 3, 3), optional
    ///     R_sb, the frame's orientation in {s}, wherever its origin is.
    /// near : array_like, shape (..., nq), optional
    ///     Minimize ½‖θ ⊖ near‖² along the null space of the goal.
    /// minimize : callable, optional
    ///     Minimize H along the null space of the goal: `minimize(theta)` returns H(θ), a float, and its gradient,
    ///     shape (n,). Instead of `near`.
    /// must_reach : bool
    ///     True to raise `MotionError` if a goal is not reached.
    /// threads : int, optional
    ///     Maximum number of threads for many targets. Default: all cores.
    ///
    /// Returns
    /// -------
    /// Solution
    ///     A named tuple: `theta`, shape (..., nq), the best positions found; `reached`; the remaining `angle`, rad,
    ///     and `distance`, m, None if they are not part of the goal; `iterations` of all starts; `starts`; `reason`,
    ///     why a goal was not reached, '' if it was. For many targets they are arrays of shape (...).
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     For shapes that do not fit, matrices that are not poses, and numbers that are not finite.
    /// MotionError
    ///     With `must_reach`, if a goal is not reached.
    ///
    /// Examples
    /// --------
    /// >>> import mozzi
    /// >>> import numpy as np
    /// >>> ur5 = mozzi.models.ur5()
    /// >>> solver = mozzi.InverseKinematics(ur5)
    /// >>> points = np.linspace([0.4, -0.3, 0.4], [0.4, 0.3, 0.4], 50)
    /// >>> found = solver.solve([0, -1.2, 1.5, 0.3, 1.1, 0], position=points)
    /// >>> found.theta.shape, bool(found.reached.all()), found.angle
    /// ((50, 6), True, None)
    /// >>> solver.solve([0] * 6, position=[2, 0, 0]).reached
    /// False
    #[pyo3(signature = (
        guess, *, pose=None, position=None, orientation=None, near=None, minimize=None, must_reach=false, threads=None,
    ))]
    #[allow(clippy::too_many_arguments)] // Python's
    fn solve<'py>(
        &self,
        py: Python<'py>,
        guess: &Bound<'py, PyAny>,
        pose: Given<'_, 'py>,
        position: Given<'_, 'py>,
        orientation: Given<'_, 'py>,
        near: Given<'_, 'py>,
        minimize: Given<'_, 'py>,
        must_reach: bool,
        threads: Option<Threads>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let (robot, nq) = (self.model.get().robot(), self.robot().nq());
        if near.is_some() && minimize.is_some() {
            return Err(PyValueError::new_err("near and minimize are both given, expected one of them or none"));
        }
        let positions = |name, given| -> PyResult<Numbers<'py>> {
            let numbers = Numbers::new(name, given)?;
            robot.check_shape_as(&numbers, "theta")?;
            Ok(numbers)
        };
        let mut goals = Goals::new(pose, position, orientation)?;
        let mut guess = positions("guess", guess)?;
        let mut near = near.map(|near| positions("near", near)).transpose()?;
        let axes = goals.axes();
        let leading = {
            let tables = [(&guess, 1), (&goals.numbers, axes)].into_iter().chain(near.iter().map(|near| (near, 1)));
            common_leading(tables.map(|(table, axes)| (table.name, table.leading(axes))))?
        };
        goals.numbers.spread::<f64>(&leading, axes)?;
        guess.spread::<f64>(&leading, 1)?;
        near.iter_mut().try_for_each(|near| near.spread::<f64>(&leading, 1))?;
        let near = near.as_ref().map(Numbers::slice::<f64>).transpose()?;
        let guess = guess.slice::<f64>()?;
        let row = |k: usize| k * nq..(k + 1) * nq;
        let task = |(k, goal)| Task { goal, guess: &guess[row(k)], near: near.map(|near| &near[row(k)]) };
        let tasks: Vec<Task> = goals.each(&leading)?.into_iter().enumerate().map(task).collect();
        let all = match minimize {
            Some(function) => self.solve_minimizing(function, &tasks, &leading)?,
            None => {
                let cores = || std::thread::available_parallelism().map_or(1, usize::from);
                let count = threads.map_or_else(cores, |Threads(count)| count);
                let failed = |failure: Failure| of_one_motion(failure.1, failure.0, &leading);
                let interrupt = Interrupt::new();
                let found = py.detach(|| self.solve_on_threads(count, &tasks, &interrupt));
                interrupt.check()?;
                found.map_err(failed)?
            }
        };
        if must_reach && let Some((index, found)) = all.iter().enumerate().find(|(_, found)| !found.is_reached()) {
            return Err(found.not_reached(index, &leading));
        }
        solution(py, &all, &leading, nq)
    }

    /// The robot.
    #[getter]
    fn model(&self, py: Python<'_>) -> Py<PyModel> {
        self.model.clone_ref(py)
    }

    /// The frame to be placed.
    #[getter]
    fn frame(&self) -> &str {
        self.robot().frame_name(self.frame)
    }

    fn __repr__(&self) -> String {
        format!("<mozzi.InverseKinematics of '{}' of '{}'>", self.frame(), self.robot().description().name)
    }
}

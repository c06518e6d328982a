//! One start: what drives the robot, from Python's arguments, and the motion with its energies as arrays.

use super::Torque;
use crate::array::Numbers;
use crate::failure::of_model;
use crate::model::{PyModel, array};
use crate::results::named;
use crate::robot::Robot;
use mozzi::Error;
use mozzi::simulation::{Energy, GravityCompensation, Input, Options, Trajectory, Zero};
use pyo3::prelude::*;
use std::cell::RefCell;
use std::ops::ControlFlow;

/// Motors: constant torques.
struct Constant(Vec<f64>);
impl Input for Constant {
    fn torque(&mut self, _: f64, _: &[f64], _: &[f64], tau: &mut [f64]) -> Result<(), Error> {
        tau.iter_mut().zip(&self.0).for_each(|(tau, x)| *tau += x);
        Ok(())
    }
}

/// Motors: a function of Python. What it raises is kept, and ends the simulation.
struct Function<'a, 'py> {
    model: &'a PyModel,
    function: &'a Bound<'py, PyAny>,
    raised: &'a RefCell<Option<PyErr>>,
}

impl Function<'_, '_> {
    fn call(&self, t: f64, theta: &[f64], dtheta: &[f64], tau: &mut [f64]) -> PyResult<()> {
        let py = self.function.py();
        let list = |x: &[f64]| array(py, &[x.len()], x.iter().copied());
        let answer = self.function.call1((t, list(theta)?, list(dtheta)?))?;
        let mut answer = Numbers::new("tau", &answer)?;
        self.model.robot().check_shape(&answer)?;
        answer.spread::<f64>(&[], 1)?;
        tau.iter_mut().zip(answer.slice::<f64>()?).for_each(|(tau, x)| *tau += x);
        Ok(())
    }
}

impl Input for Function<'_, '_> {
    fn torque(&mut self, t: f64, theta: &[f64], dtheta: &[f64], tau: &mut [f64]) -> Result<(), Error> {
        self.call(t, theta, dtheta, tau).map_err(|error| {
            *self.raised.borrow_mut() = Some(error);
            Error::BadArgument { what: "the torque's function", found: "an exception".into(), expected: "torques" }
        })
    }
}

/// The motion of one robot.
pub fn simulate<'py>(
    robot: &Bound<'py, PyModel>,
    [theta, dtheta]: [&[f64]; 2],
    torque: Torque<'_, 'py>,
    options: &Options,
) -> PyResult<Bound<'py, PyAny>> {
    let (py, this) = (robot.py(), robot.get());
    let (model, start, raised) = (&this.robot().model, [theta, dtheta], RefCell::new(None));
    let found = match torque {
        Torque::None => run(py, this.robot(), start, Zero, options, &raised)?,
        Torque::Constant(tau) => {
            run(py, this.robot(), start, Constant(tau.slice::<f64>()?.to_vec()), options, &raised)?
        }
        Torque::GravityCompensation => {
            let motors = GravityCompensation::against(model, options.gravity.unwrap_or(model.gravity()));
            run(py, this.robot(), start, motors, options, &raised)?
        }
        Torque::Function(function) => {
            run(py, this.robot(), start, Function { model: this, function, raised: &raised }, options, &raised)?
        }
    };
    trajectory(py, robot, found)
}

/// Simulates, by machine code where there is some for θ̈, and looks now and then whether Python was interrupted.
fn run(
    py: Python<'_>,
    robot: &Robot,
    start: [&[f64]; 2],
    input: impl Input,
    options: &Options,
    raised: &RefCell<Option<PyErr>>,
) -> PyResult<Trajectory> {
    let progress = |_, _| match py.check_signals() {
        Ok(()) => ControlFlow::Continue(()),
        Err(error) => {
            *raised.borrow_mut() = Some(error);
            ControlFlow::Break(())
        }
    };
    let found = match &robot.compiled {
        Some(machine) => machine.code.simulate_with_progress(start[0], start[1], input, options, progress),
        None => robot.model.simulate_with_progress(start[0], start[1], input, options, progress),
    };
    match raised.borrow_mut().take() {
        Some(error) => Err(error),
        None => found.map_err(of_model),
    }
}

fn trajectory<'py>(py: Python<'py>, robot: &Bound<'py, PyModel>, found: Trajectory) -> PyResult<Bound<'py, PyAny>> {
    let rows = found.len();
    let names = |names: Vec<&str>| names.into_pyobject(py);
    let energies = |part: fn(&Energy) -> f64| array(py, &[rows], found.energy.iter().map(part));
    let model = &robot.get().robot().model;
    let fields = vec![
        array(py, &[rows], found.t.iter().copied())?,
        array(py, &[rows, found.nq], found.theta.iter().copied())?,
        array(py, &[rows, found.n], found.dtheta.iter().copied())?,
        array(py, &[rows, found.n], found.ddtheta.iter().copied())?,
        array(py, &[rows, found.n], found.tau.iter().copied())?,
        energies(|energy| energy.kinetic)?,
        energies(|energy| energy.potential)?,
        energies(|energy| energy.motor_work)?,
        energies(|energy| energy.friction_loss)?,
        energies(|energy| energy.applied_work)?,
        names(model.position_names().collect())?,
        names(model.velocity_names().collect())?,
        robot.clone().into_any(),
    ];
    named(py, "Trajectory", fields)
}

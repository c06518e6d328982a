//! One start: the motors' torques from Python's arguments, and the motion with its energies as arrays.

use super::Torque;
use super::contacts::forces;
use super::watched::{Watched, happened, stopped};
use crate::arguments::Given;
use crate::array::Numbers;
use crate::failure::of_model;
use crate::model::{PyModel, array};
use crate::results::named;
use crate::robot::Robot;
use mozzi_sim::Error;
use mozzi_sim::{
    ContactEvent, Contacts, Energy, GravityCompensation, Input, OneSidedAccount, Options, Run, Simulation, Zero,
};
use pyo3::prelude::*;
use std::cell::RefCell;
use std::ops::ControlFlow;

/// Motors: constant torques.
pub struct Constant(pub Vec<f64>);
impl Input for Constant {
    fn torque(&mut self, _: f64, _: &[f64], _: &[f64], tau: &mut [f64]) -> Result<(), Error> {
        tau.iter_mut().zip(&self.0).for_each(|(tau, x)| *tau += x);
        Ok(())
    }
}

/// Motors: a Python function. An exception is kept, and ends the simulation.
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
            let (what, expected) = ("the torque's function", "torques");
            mozzi::Error::BadArgument { what, found: "an exception".into(), expected }.into()
        })
    }
}

/// Steps between two checks for an interrupt from Python.
const BETWEEN_LOOKS: usize = 500;

/// Contact points and planes: as Python gave them, and as the library's.
pub struct Touched<'a, 'py> {
    pub given: [Given<'a, 'py>; 2],
    pub contacts: Contacts<'static>,
}

/// The motion of one robot.
pub fn simulate<'py>(
    robot: &Bound<'py, PyModel>,
    [theta, dtheta]: [&[f64]; 2],
    torque: Torque<'_, 'py>,
    options: &Options,
    (watched, Touched { given, contacts }): (Watched<'_, 'py>, Touched<'_, 'py>),
) -> PyResult<Bound<'py, PyAny>> {
    let (py, this) = (robot.py(), robot.get());
    let (model, raised) = (&this.robot().model, RefCell::new(None));
    let names: Vec<String> = contacts.names().collect();
    let simulation = Simulation {
        contacts,
        options: *options,
        events: watched.events(model, [theta, dtheta], &raised)?,
        forward_dynamics: this.robot().compiled.as_ref().and_then(|machine| machine.code.simulator()),
    };
    let go = |input: &mut dyn Input| run(py, this.robot(), [theta, dtheta], input, &simulation, &raised);
    let found = match torque {
        Torque::None => go(&mut Zero)?,
        Torque::Constant(tau) => go(&mut Constant(tau.slice::<f64>()?.to_vec()))?,
        Torque::GravityCompensation => {
            go(&mut GravityCompensation::against(model, options.gravity.unwrap_or(model.gravity())))?
        }
        Torque::Function(function) => go(&mut Function { model: this, function, raised: &raised })?,
    };
    trajectory(py, robot, found, names, given)
}

/// Checks at intervals whether Python was interrupted or a function raised an exception.
fn run(
    py: Python<'_>,
    robot: &Robot,
    start: [&[f64]; 2],
    input: &mut dyn Input,
    simulation: &Simulation,
    raised: &RefCell<Option<PyErr>>,
) -> PyResult<Run> {
    let mut steps = 0;
    let progress = |_| {
        steps += 1;
        if steps % BETWEEN_LOOKS == 0
            && let Err(error) = py.check_signals()
        {
            *raised.borrow_mut() = Some(error);
        }
        if raised.borrow().is_some() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    };
    let found = simulation.run_with_progress(&robot.model, start[0], start[1], input, progress);
    match raised.borrow_mut().take() {
        Some(error) => Err(error),
        None => found.map_err(of_model),
    }
}

/// How well the laws of one-sided forces were satisfied.
pub fn account(py: Python<'_>, found: OneSidedAccount) -> PyResult<Bound<'_, PyAny>> {
    let fields = vec![
        found.largest_residual.into_pyobject(py)?.into_any(),
        found.last_residual.into_pyobject(py)?.into_any(),
        found.unsolved.into_pyobject(py)?.into_any(),
        found.halvings.into_pyobject(py)?.into_any(),
        found.unsettled.into_pyobject(py)?.into_any(),
    ];
    named(py, "OneSided", fields)
}

fn trajectory<'py>(
    py: Python<'py>,
    robot: &Bound<'py, PyModel>,
    run: Run,
    contacts: Vec<String>,
    given: [Given<'_, 'py>; 2],
) -> PyResult<Bound<'py, PyAny>> {
    let Run { motion: found, events, stops, closing, method, one_sided, contact_events } = run;
    let of_event = |event: ContactEvent| {
        let fields = vec![
            event.t.into_pyobject(py)?.into_any(),
            event.contact.into_pyobject(py)?.into_any(),
            event.change.name().into_pyobject(py)?.into_any(),
        ];
        named(py, "ContactEvent", fields)
    };
    let contact_events = contact_events.into_iter().map(of_event).collect::<PyResult<Vec<_>>>()?;
    let rows = found.len();
    let names = |names: Vec<&str>| names.into_pyobject(py);
    let number = |x: f64| -> PyResult<_> { Ok(x.into_pyobject(py)?.into_any()) };
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
        happened(py, events)?,
        stopped(py, stops)?,
        named(py, "Closing", vec![number(closing.residual)?, number(closing.corrected)?])?,
        method.name().into_pyobject(py)?.into_any(),
        contacts.clone().into_pyobject(py)?,
        forces(py, &[rows, contacts.len(), 3], [&found].into_iter())?,
        contact_events.into_pyobject(py)?,
        match one_sided {
            Some(found) => account(py, found)?,
            None => py.None().into_bound(py),
        },
        given[0].cloned().unwrap_or_else(|| py.None().into_bound(py)),
        given[1].cloned().unwrap_or_else(|| py.None().into_bound(py)),
    ];
    named(py, "Trajectory", fields)
}

//! Many starts, each robot as alone, on all cores: dry friction that sticks, contacts, stops, other methods.

use super::Torque;
use super::contacts::{Fixed, forces};
use super::many::Table;
use super::one::{Constant, account};
use crate::arguments::Given;
use crate::failure::{of_batch, of_model};
use crate::model::{PyModel, array};
use crate::results::named;
use crate::threads::Threads;
use mozzi_sim::{GravityCompensation, Input, OneSidedAccount, Options, Run, Simulation, Zero};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::time::Duration;

/// The time before the first check for an interrupt from Python, and the longest between two, doubled from check to
/// check.
const FIRST_LOOK: Duration = Duration::from_micros(100);
const BETWEEN_LOOKS: Duration = Duration::from_millis(50);

/// The motions of robots that start at these states, (B, nq) and (B, n).
pub fn simulate<'py>(
    robot: &Bound<'py, PyModel>,
    leading: &[usize],
    [theta, dtheta]: [&[f64]; 2],
    torque: Torque<'_, 'py>,
    options: &Options,
    [points, planes]: [Given<'_, 'py>; 2],
    threads: Option<Threads>,
) -> PyResult<Bound<'py, PyAny>> {
    let (py, own) = (robot.py(), robot.get().robot());
    let (model, n) = (&own.model, own.model.n());
    options.check().map_err(of_model)?;
    let fixed = Fixed::new(model, points, planes)?;
    let names: Vec<String> = fixed.contacts().names().collect();
    enum Motors<'a> {
        None,
        Constant(&'a [f64]),
        Gravity,
    }
    let motors = match &torque {
        Torque::None => Motors::None,
        Torque::Constant(tau) => Motors::Constant(tau.slice::<f64>()?),
        Torque::GravityCompensation => Motors::Gravity,
        Torque::Function(_) => {
            return Err(PyTypeError::new_err(
                "torque is a function, expected an array, 'gravity_compensation' or None: robots with dry friction, \
                 contacts, stops or a method other than 'rk4', 'semi-implicit-euler' and 'euler' move one by one. \
                 sticking=False moves robots with dry friction together, under μ sgn θ̇",
            ));
        }
    };
    let gravity = options.gravity.unwrap_or(model.gravity());
    let input = |k: usize| -> Box<dyn Input + '_> {
        match motors {
            Motors::None => Box::new(Zero),
            Motors::Constant(tau) => Box::new(Constant(tau[k * n..][..n].to_vec())),
            Motors::Gravity => Box::new(GravityCompensation::against(model, gravity)),
        }
    };
    let simulation = |_| Simulation {
        contacts: fixed.contacts(),
        options: *options,
        events: Vec::new(),
        forward_dynamics: own.compiled.as_ref().and_then(|machine| machine.code.simulator()),
    };
    let (batch, is_over) = (own.batch::<f64>(threads)?, AtomicBool::new(false));
    let progress = |_| if is_over.load(Relaxed) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) };
    let (mut raised, mut wait) = (None, FIRST_LOOK);
    let found = std::thread::scope(|scope| {
        let motions = scope.spawn(|| batch.simulate_each([theta, dtheta], simulation, input, progress));
        while !motions.is_finished() {
            py.detach(|| std::thread::sleep(wait));
            wait = (2 * wait).min(BETWEEN_LOOKS);
            if raised.is_none()
                && let Err(error) = py.check_signals()
            {
                raised = Some(error);
                is_over.store(true, Relaxed);
            }
        }
        motions.join()
    });
    if let Some(error) = raised {
        return Err(error);
    }
    let runs = found.unwrap_or_else(|panic| std::panic::resume_unwind(panic));
    trajectories(robot, leading, runs.map_err(|error| of_batch(error, leading))?, names, options)
}

fn trajectories<'py>(
    robot: &Bound<'py, PyModel>,
    leading: &[usize],
    runs: Vec<Run>,
    names: Vec<String>,
    options: &Options,
) -> PyResult<Bound<'py, PyAny>> {
    let py = robot.py();
    let model = &robot.get().robot().model;
    let rows = 1 + options.steps.div_ceil(options.record_every);
    let times = (0..=options.steps).filter(|&k| options.is_recorded(k)).map(|k| options.time(k));
    let table = |width: usize, numbers: &dyn Fn(&Run) -> Vec<f64>| -> PyResult<Bound<'py, PyAny>> {
        let mut table = Table::new(py, leading, rows, width)?;
        runs.iter().enumerate().for_each(|(k, run)| table.write_robot(k, &numbers(run)));
        Ok(table.into_array())
    };
    let energies = |part: fn(&mozzi_sim::Energy) -> f64| -> PyResult<Bound<'py, PyAny>> {
        let all = runs.iter().flat_map(|run| run.motion.energy.iter().map(part));
        array(py, &[leading, &[rows]].concat(), all.collect::<Vec<_>>())
    };
    let accounts = runs.iter().filter_map(|run| run.one_sided);
    let worst = accounts.reduce(|a, b| OneSidedAccount {
        largest_residual: a.largest_residual.max(b.largest_residual),
        last_residual: a.last_residual.max(b.last_residual),
        unsolved: a.unsolved + b.unsolved,
        halvings: a.halvings + b.halvings,
        unsettled: a.unsettled + b.unsettled,
        ..a
    });
    let fields = vec![
        array(py, &[rows], times.collect::<Vec<_>>())?,
        table(model.nq(), &|run| run.motion.theta.clone())?,
        table(model.n(), &|run| run.motion.dtheta.clone())?,
        table(model.n(), &|run| run.motion.ddtheta.clone())?,
        table(model.n(), &|run| run.motion.tau.clone())?,
        energies(|energy| energy.kinetic)?,
        energies(|energy| energy.potential)?,
        model.position_names().collect::<Vec<_>>().into_pyobject(py)?,
        model.velocity_names().collect::<Vec<_>>().into_pyobject(py)?,
        robot.clone().into_any(),
        forces(py, &[leading, &[rows, names.len(), 3]].concat(), runs.iter().map(|run| &run.motion))?,
        names.into_pyobject(py)?,
        worst.map_or(Ok(py.None().into_bound(py)), |worst| account(py, worst))?,
    ];
    named(py, "Trajectories", fields)
}

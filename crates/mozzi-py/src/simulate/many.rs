//! Many starts at once, in registers: the batch's forward dynamics, and motions as arrays.

use super::Torque;
use crate::arguments::{Arguments, Given};
use crate::array::{Numbers, shown, wrong_shape};
use crate::failure::{of_batch, of_model, of_state};
use crate::model::{PyModel, array};
use crate::numpy::Fresh;
use crate::results::named;
use crate::signature::{INPUTS, Slot};
use crate::threads::Threads;
use mozzi::quantities::{KineticEnergy, PotentialEnergy, Query};
use mozzi::{Environment, Model};
use mozzi_engine::{Batch, BatchEnvironment};
use mozzi_sim::Error;
use mozzi_sim::{GravityCompensation, Input, LARGEST, Motion, Options, forward_dynamics_of};
use pyo3::prelude::*;

/// Steps of all robots together between two checks for an interrupt from Python: a fraction of a second. The number is
/// fixed and does not depend on the clock, because the division of steps into pieces may change a last bit.
const BETWEEN_LOOKS: usize = 5_000;
/// With fewer consecutive steps, the state at the beginning of each piece would cost too much.
const FEWEST_STEPS: usize = 8;

/// Rows of one quantity, robot after robot.
pub struct Table<'py> {
    array: Fresh<'py, f64>,
    rows: usize,
    width: usize,
}

impl<'py> Table<'py> {
    pub fn new(py: Python<'py>, leading: &[usize], rows: usize, width: usize) -> PyResult<Self> {
        Ok(Table { array: Fresh::new(py, &[leading, &[rows, width]].concat())?, rows, width })
    }

    /// All rows of one robot.
    pub fn write_robot(&mut self, robot: usize, rows: &[f64]) {
        self.array.numbers()[robot * self.rows * self.width..][..rows.len()].copy_from_slice(rows);
    }

    pub fn into_array(self) -> Bound<'py, PyAny> {
        self.array.into_array()
    }

    fn write(&mut self, row: usize, states: &[f64]) {
        let (rows, width) = (self.rows, self.width);
        for (robot, state) in states.chunks_exact(width.max(1)).enumerate() {
            self.array.numbers()[(robot * rows + row) * width..][..width].copy_from_slice(state);
        }
    }
}

/// The rows recorded while robots move.
struct Record<'py> {
    t: Vec<f64>,
    theta: Table<'py>,
    dtheta: Table<'py>,
    tau: Table<'py>,
}

impl Record<'_> {
    fn write(&mut self, t: f64, theta: &[f64], dtheta: &[f64], tau: &[f64]) {
        let row = self.t.len();
        self.t.push(t);
        self.theta.write(row, theta);
        self.dtheta.write(row, dtheta);
        self.tau.write(row, tau);
    }
}

/// The robots, and how they are simulated.
struct Robots<'a> {
    model: &'a Model,
    batch: Batch<f64>,
    environment: BatchEnvironment<'a, f64>,
    leading: &'a [usize],
    options: &'a Options,
}

impl Robots<'_> {
    /// The error of one robot.
    fn wrong(&self, index: usize, error: Error) -> PyErr {
        of_state(error, index, self.leading)
    }

    fn check_finite(&self, what: &'static str, numbers: &[f64], at: impl Fn(usize) -> String) -> PyResult<()> {
        let Some(k) = numbers.iter().position(|x| !x.is_finite()) else { return Ok(()) };
        let width = if what == "theta" { self.model.nq() } else { self.model.n() };
        let found = format!("{}{}", numbers[k], at(k % width));
        Err(self.wrong(k / width, mozzi::Error::BadArgument { what, found, expected: "a finite number" }.into()))
    }

    /// Checks that every state is finite. `place` maps a state's index to its robot and its step.
    fn check_bounded(
        &self,
        quantity: &'static str,
        numbers: &[f64],
        place: impl Fn(usize) -> (usize, usize),
    ) -> PyResult<()> {
        let Some(k) = numbers.iter().position(|x| !(x.abs() < LARGEST)) else { return Ok(()) };
        let (model, value) = (self.model, numbers[k]);
        let (state, joint) = match quantity {
            "theta" => (k / model.nq(), model.position_names().nth(k % model.nq())),
            _ => (k / model.n(), model.velocity_names().nth(k % model.n())),
        };
        let (robot, step) = place(state);
        let (joint, time) = (joint.unwrap_or_default().to_string(), self.options.time(step));
        let step_size = self.options.step();
        Err(self.wrong(robot, Error::Diverged { quantity, joint, value, step, time, step_size }))
    }

    /// Under constant torques: the batch takes many steps at once.
    fn move_steadily(&self, py: Python, start: [&[f64]; 2], tau: &[f64], record: &mut Record) -> PyResult<()> {
        let [mut theta, mut dtheta] = start.map(<[f64]>::to_vec);
        let Options { method, steps, record_every, .. } = *self.options;
        let piece = (BETWEEN_LOOKS / (dtheta.len() / self.model.n())).max(FEWEST_STEPS);
        record.write(0.0, &theta, &dtheta, tau);
        let mut done = 0;
        while done < steps {
            let some = piece.min(record_every - done % record_every).min(steps - done);
            let duration = some as f64 * self.options.step();
            let (theta, dtheta) = (&mut theta, &mut dtheta);
            py.detach(|| self.batch.simulate(theta, dtheta, tau, &self.environment, method, duration, some))
                .map_err(|error| self.later(error, done))?;
            done += some;
            self.check_bounded("theta", theta, |robot| (robot, done))?;
            self.check_bounded("dtheta", dtheta, |robot| (robot, done))?;
            py.check_signals()?;
            if self.options.is_recorded(done) {
                record.write(self.options.time(done), theta, dtheta, tau);
            }
        }
        Ok(())
    }

    /// Adds the number of steps before this piece to the step in an error.
    fn later(&self, error: mozzi_engine::Error, done: usize) -> PyErr {
        match error {
            mozzi_engine::Error::State {
                index,
                source: Error::Diverged { quantity, joint, value, step, step_size, .. },
            } => {
                let (step, time) = (done + step, self.options.time(done + step));
                self.wrong(index, Error::Diverged { quantity, joint, value, step, time, step_size })
            }
            mozzi_engine::Error::State { index, source: Error::Opened { constraint, residual, time } } => {
                let time = self.options.time(done) + time;
                self.wrong(index, Error::Opened { constraint, residual, time })
            }
            mozzi_engine::Error::State { index, source: Error::Jumped { joint, change, time } } => {
                let time = self.options.time(done) + time;
                self.wrong(index, Error::Jumped { joint, change, time })
            }
            error => of_batch(error, self.leading),
        }
    }

    /// With torques computed by the function at each stage of each step.
    fn move_driven(
        &self,
        py: Python,
        [theta, dtheta]: [&[f64]; 2],
        mut torque: impl FnMut(f64, &[f64], &[f64], &mut [f64]) -> PyResult<()>,
        record: &mut Record,
    ) -> PyResult<()> {
        let robots = dtheta.len() / self.model.n();
        let m = self.model.constraint_rows();
        let (mut tau, mut lambda) = (vec![0.0; dtheta.len()], vec![0.0; robots * m]);
        let query = forward_dynamics_of(self.model);
        let mut accelerations = |tau: &mut [f64], t: f64, theta: &[f64], dtheta: &[f64], ddtheta: &mut [f64]| {
            torque(t, theta, dtheta, tau)?;
            let inputs: [&[f64]; 3] = [theta, dtheta, tau];
            let outputs = &mut [ddtheta, &mut lambda][..query.declaration().outputs.len()];
            py.detach(|| self.batch.compute(query, &inputs, &self.environment, outputs))
                .map_err(|error| of_batch(error, self.leading))?;
            Ok::<[f64; 0], PyErr>([])
        };
        let space = self.model.configuration_space();
        let method = self.options.method.explicit().map_err(of_model)?;
        let mut motion =
            Motion::start_many(space, robots, 0.0, theta, dtheta, |t, q, v, a| accelerations(&mut tau, t, q, v, a))?;
        record.write(0.0, &motion.theta, &motion.dtheta, &tau);
        for step in 1..=self.options.steps {
            let (h, t) = (self.options.step(), self.options.time(step));
            motion.advance(method, h, t, |t, q, v, a| accelerations(&mut tau, t, q, v, a))?;
            let closed = self.batch.close(t, &mut motion.theta, &mut motion.dtheta);
            closed.map_err(|error| of_batch(error, self.leading))?;
            motion.find_rates(|t, q, v, a| accelerations(&mut tau, t, q, v, a))?;
            for (quantity, numbers) in
                [("theta", &motion.theta), ("dtheta", &motion.dtheta), ("ddtheta", &motion.ddtheta)]
            {
                self.check_bounded(quantity, numbers, |robot| (robot, step))?;
            }
            py.check_signals()?;
            if self.options.is_recorded(step) {
                record.write(t, &motion.theta, &motion.dtheta, &tau);
            }
        }
        Ok(())
    }

    /// The function's torques for all robots.
    fn ask(
        &self,
        robot: &PyModel,
        function: &Bound<'_, PyAny>,
        t: f64,
        theta: &[f64],
        dtheta: &[f64],
        tau: &mut [f64],
    ) -> PyResult<()> {
        let py = function.py();
        let table = |x: &[f64], width: usize| array(py, &[self.leading, &[width]].concat(), x.iter().copied());
        let answer = function.call1((t, table(theta, self.model.nq())?, table(dtheta, self.model.n())?))?;
        let mut answer = Numbers::new("tau", &answer)?;
        robot.robot().check_shape(&answer)?;
        if answer.leading(1) != self.leading {
            let expected = shown(&[self.leading, &[self.model.n()]].concat());
            let expected = format!("{expected}: the torque's function is called once for all starts");
            return Err(wrong_shape("tau", &answer.shape, expected));
        }
        answer.spread::<f64>(self.leading, 1)?;
        tau.copy_from_slice(answer.slice::<f64>()?);
        let joint = |j| self.model.velocity_names().nth(j).unwrap_or_default().to_string();
        self.check_finite("the input's torque", tau, |j| format!(" at joint `{}`, t = {t} s", joint(j)))
    }
}

/// The motions of robots that start at these states.
pub fn simulate<'py>(
    robot: &Bound<'py, PyModel>,
    leading: &[usize],
    start: [&[f64]; 2],
    torque: Torque<'_, 'py>,
    options: &Options,
    gravity: Given<'_, 'py>,
    threads: Option<Threads>,
) -> PyResult<Bound<'py, PyAny>> {
    let (py, this) = (robot.py(), robot.get());
    let model = &this.robot().model;
    options.check().map_err(of_model)?;
    let environment = Environment::with_gravity(options.gravity.unwrap_or(model.gravity()));
    let environment = BatchEnvironment::from(environment);
    // robots with dry friction that sticks move one by one
    let batch = this.robot().batch(threads)?.with_sticking(false);
    // the steps are several calls: by one engine
    let states = leading.iter().product::<usize>().saturating_mul(options.steps);
    let batch = batch.for_job_of(&[forward_dynamics_of(model)], &environment, states);
    let batch = batch.map_err(|error| of_batch(error, leading))?;
    let robots = Robots { model, batch, environment, leading, options };
    let everywhere = |_| String::new();
    robots.check_finite("theta", start[0], everywhere)?;
    robots.check_finite("dtheta", start[1], everywhere)?;
    robots.batch.check_closed(start[0], start[1]).map_err(|error| of_batch(error, leading))?;

    let (n, rows) = (model.n(), 1 + options.steps.div_ceil(options.record_every));
    let table = |width| Table::new(py, leading, rows, width);
    // memory is refused by NumPy, as an exception
    let (theta, dtheta, tau) = (table(model.nq())?, table(n)?, table(n)?);
    let mut record = Record { t: Vec::new(), theta, dtheta, tau };
    match torque {
        _ if start[1].is_empty() => {
            record.t.extend((0..=options.steps).filter(|&k| options.is_recorded(k)).map(|k| options.time(k)))
        }
        Torque::None => robots.move_steadily(py, start, &vec![0.0; start[1].len()], &mut record)?,
        Torque::Constant(tau) => {
            robots.check_finite("tau", tau.slice()?, everywhere)?;
            robots.move_steadily(py, start, tau.slice()?, &mut record)?;
        }
        Torque::GravityCompensation => {
            let gravity = options.gravity.unwrap_or(model.gravity());
            let mut input = GravityCompensation::against(model, gravity);
            let nq = model.nq();
            let compensation = |t, theta: &[f64], dtheta: &[f64], tau: &mut [f64]| {
                tau.fill(0.0);
                for (k, tau) in tau.chunks_exact_mut(n).enumerate() {
                    let held = input.torque(t, &theta[k * nq..][..nq], &dtheta[k * n..][..n], tau);
                    held.map_err(|error| robots.wrong(k, error))?;
                }
                Ok(())
            };
            robots.move_driven(py, start, compensation, &mut record)?;
        }
        Torque::Function(function) => {
            let motors =
                |t, theta: &[f64], dtheta: &[f64], tau: &mut [f64]| robots.ask(this, function, t, theta, dtheta, tau);
            robots.move_driven(py, start, motors, &mut record)?;
        }
    }

    let t = array(py, &[rows], record.t)?;
    let [theta, dtheta, tau] = [record.theta, record.dtheta, record.tau].map(|table| table.array.into_array());
    let compute = |query: Query, state: &[&Bound<'py, PyAny>], gravity| {
        let state = INPUTS.into_iter().zip(state.iter().map(|&table| Some(table)));
        let given = Arguments::of(state.chain([(Slot::Gravity, gravity)]));
        this.robot().compute(py, &query, &given, threads)
    };
    let mut ddtheta = compute(forward_dynamics_of(model), &[&theta, &dtheta, &tau], gravity)?;
    if model.constraint_rows() > 0 {
        ddtheta = ddtheta.getattr("ddtheta")?; // without the multipliers
    }
    let recorded = |state: usize| (state / rows, (state % rows * options.record_every).min(options.steps));
    robots.check_bounded("ddtheta", Numbers::new("ddtheta", &ddtheta)?.slice()?, recorded)?;
    let fields = vec![
        t,
        theta.clone(),
        dtheta.clone(),
        ddtheta,
        tau,
        compute(KineticEnergy.into(), &[&theta, &dtheta], None)?,
        compute(PotentialEnergy.into(), &[&theta], gravity)?,
        model.position_names().collect::<Vec<_>>().into_pyobject(py)?,
        model.velocity_names().collect::<Vec<_>>().into_pyobject(py)?,
        robot.clone().into_any(),
        array(py, &[leading, &[rows, 0, 3]].concat(), [])?,
        Vec::<String>::new().into_pyobject(py)?,
        py.None().into_bound(py),
    ];
    named(py, "Trajectories", fields)
}

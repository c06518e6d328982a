//! Simulation: the arguments, for one start and for many.

mod contacts;
mod many;
mod one;
mod rollout;
mod watched;

use crate::arguments::Given;
use crate::array::{Numbers, common_leading};
use crate::model::PyModel;
use crate::threads::Threads;
use mozzi::Vec3;
use mozzi::simulation::{Friction, Method, Options, Policy};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyString;
use watched::Watched;

/// The torques of the motors.
enum Torque<'a, 'py> {
    None,
    Constant(Numbers<'py>),
    GravityCompensation,
    Function(&'a Bound<'py, PyAny>),
}

impl<'a, 'py> Torque<'a, 'py> {
    fn new(robot: &PyModel, given: Given<'a, 'py>) -> PyResult<Self> {
        let Some(given) = given else { return Ok(Torque::None) };
        if given.is_callable() {
            return Ok(Torque::Function(given));
        }
        if given.is_instance_of::<PyString>() {
            return match given.extract::<String>()?.as_str() {
                "gravity_compensation" => Ok(Torque::GravityCompensation),
                other => {
                    let expected = "a function, an array or 'gravity_compensation'";
                    Err(PyTypeError::new_err(format!("torque is '{other}', expected {expected}")))
                }
            };
        }
        let tau = Numbers::new("tau", given)?;
        robot.robot().check_shape(&tau)?;
        Ok(Torque::Constant(tau))
    }
}

/// A method of simulations; those of rollouts are the others than 'auto' and 'moreau'.
fn simulation_method(name: &str, tolerance: f64) -> PyResult<Method> {
    match name {
        "auto" => Ok(Method::Automatic),
        "moreau" => Ok(Method::MoreauJean),
        other => method(other, tolerance).map_err(|_| {
            let expected = "'auto', 'moreau', 'rk4', 'semi-implicit-euler', 'euler', 'dopri' or 'midpoint'";
            PyValueError::new_err(format!("method is '{name}', expected {expected}"))
        }),
    }
}

fn method(name: &str, tolerance: f64) -> PyResult<Method> {
    match name {
        "rk4" => Ok(Method::RungeKutta4),
        "semi-implicit-euler" => Ok(Method::SemiImplicitEuler),
        "euler" => Ok(Method::Euler),
        "dopri" => Ok(Method::DormandPrince { tolerance }),
        "midpoint" => Ok(Method::Midpoint),
        _ => {
            let expected = "'rk4', 'semi-implicit-euler', 'euler', 'dopri' or 'midpoint'";
            Err(PyValueError::new_err(format!("method is '{name}', expected {expected}")))
        }
    }
}

fn policy(name: &str) -> PyResult<Policy> {
    match name {
        "ignore" => Ok(Policy::Ignore),
        "report" => Ok(Policy::Report),
        "respect" => Ok(Policy::Respect),
        _ => Err(PyValueError::new_err(format!("joint_limits is '{name}', expected 'ignore', 'report' or 'respect'"))),
    }
}

#[pymethods]
impl PyModel {
    /// The motion from (θ(0), θ̇(0)) over `duration` seconds, in `steps` equal steps; from many starts, many motions at
    /// once, on all cores.
    ///
    /// Parameters
    /// ----------
    /// theta : array_like, shape (..., nq)
    ///     Positions at the start: rad or m.
    /// dtheta : array_like, shape (..., n)
    ///     Velocities at the start: rad/s or m/s.
    /// duration : float
    ///     s.
    /// steps : int
    ///     At least 1. With 'dopri', whose steps are its own, the number of intervals between rows.
    /// torque : callable, array_like, 'gravity_compensation' or None
    ///     The motors' τ: `torque(t, theta, dtheta)`, asked at each stage of each step; constant, shape (..., n); τ =
    ///     g(θ) + k(θ − θ₀), what holds gravity and springs; or none. Of many
    ///     starts the function is asked once for all of them, with arrays of shapes (..., nq) and (..., n), and answers
    ///     (..., n).
    /// method : {'auto', 'moreau', 'rk4', 'semi-implicit-euler', 'euler', 'dopri', 'midpoint'}
    ///     How a step is taken. 'auto' is 'moreau' if there is dry friction or a contact, else 'rk4'; many starts take
    ///     'rk4', in which dry friction does not stick. 'moreau' is Moreau and Jean's step for one-sided forces.
    ///     'dopri', of order 5, finds its steps by a tolerance; 'midpoint' is implicit and symplectic: the energy's
    ///     error stays bounded. These two take one start.
    /// tolerance : float
    ///     'dopri' only: tolerance on the local error, absolute for θ (rad, m), relative to 1 + |θ̇| for θ̇.
    /// record_every : int
    ///     Record the start, every k-th step and the last.
    /// until : str, callable, or a list of them, optional
    ///     End the motion where one of these becomes true: a condition in words, such as 'elbow > 1.2' (as it rises
    ///     through it), '<' (falls), '=' (either), of a joint, 'theta_2', 'dtheta_2' or 'tool0.z'; 'joint-limit'; or a
    ///     zero of `function(t, theta, dtheta)`. One start only.
    /// events : str, callable, or a list of them, optional
    ///     Likewise, reported in the result's `events`; the motion goes on. One start only.
    /// joint_limits : {'report', 'ignore', 'respect'}
    ///     How to treat the joints' position limits: 'report' lists them in the result's `joint_limits`, 'respect'
    ///     brings a joint to rest at its limit. 'respect' takes one start; many starts report no limits.
    /// gravity : array_like, shape (3,), optional
    ///     In place of the model's own: m/s².
    /// slip_speed : float, optional
    ///     Coulomb friction μ tanh(θ̇ / slip_speed) in place of dry friction that sticks. One start only.
    /// contacts : list of str or dict, optional
    ///     Points of the robot that planes stop: the origins of frames by name, or {'frame': …, 'at': (x, y, z),
    ///     'radius': …, 'friction': 0.7, 'restitution': 0, 'name': …}. One start only.
    /// planes : list of dict, optional
    ///     {'name': …, 'pose': (qw, qx, qy, qz, x, y, z), 'velocity': (x, y, z)}: the z-axis points towards the robot,
    ///     the surface moves with the velocity. By default the ground z = 0.
    /// threads : int, optional
    ///     As many at most; by default all cores. Many starts only.
    ///
    /// Returns
    /// -------
    /// Trajectory, or Trajectories where there are leading axes
    ///     `t`, shape (rows,); `theta`, shape (..., rows, nq); `dtheta`, `ddtheta`, `tau`, shape (..., rows, n); and
    ///     the energies, shape (..., rows). Works, such as `motor_work`, of one start alone, and `closing`: by how much
    ///     the constraints of a robot that has some are violated.
    ///
    /// Raises
    /// ------
    /// DivergedError
    ///     If a state becomes infinite or NaN; of many starts, the message names which.
    ///
    /// Examples
    /// --------
    /// >>> import mozzi
    /// >>> pendulum = mozzi.models.double_pendulum()
    /// >>> fall = pendulum.simulate([1.0, 0.0], [0.0, 0.0], 1.0, 1000)
    /// >>> fall.theta.shape
    /// (1001, 2)
    /// >>> bool(abs(fall.energy - fall.energy[0]).max() < 1e-6)
    /// True
    /// >>> import numpy as np
    /// >>> starts = np.random.default_rng(1).uniform(-1, 1, (50, 2))
    /// >>> falls = pendulum.simulate(starts, [0.0, 0.0], 1.0, 100, record_every=10)
    /// >>> falls.t.shape, falls.theta.shape
    /// ((11,), (50, 11, 2))
    #[pyo3(signature = (theta, dtheta, duration, steps, *, torque=None, method="auto", tolerance=1e-9, record_every=1, until=None, events=None, joint_limits="report", gravity=None, slip_speed=None, contacts=None, planes=None, threads=None))]
    #[allow(clippy::too_many_arguments)] // Python's
    fn simulate<'py>(
        slf: &Bound<'py, Self>,
        theta: &Bound<'py, PyAny>,
        dtheta: &Bound<'py, PyAny>,
        duration: f64,
        steps: usize,
        torque: Given<'_, 'py>,
        method: &str,
        tolerance: f64,
        record_every: usize,
        until: Given<'_, 'py>,
        events: Given<'_, 'py>,
        joint_limits: &str,
        gravity: Given<'_, 'py>,
        slip_speed: Option<f64>,
        contacts: Given<'_, 'py>,
        planes: Given<'_, 'py>,
        threads: Option<Threads>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let this = slf.get();
        let numbers = |name, given| -> PyResult<Numbers<'py>> {
            let numbers = Numbers::new(name, given)?;
            this.robot().check_shape(&numbers)?;
            Ok(numbers)
        };
        let (mut theta, mut dtheta) = (numbers("theta", theta)?, numbers("dtheta", dtheta)?);
        let (method, joint_limits) = (simulation_method(method, tolerance)?, policy(joint_limits)?);
        let mut options = Options { method, record_every, joint_limits, ..Options::new(duration, steps) };
        let watched = Watched { until, events };
        if let Some(gravity) = gravity {
            options.gravity = Some(Vec3(Numbers::fixed("gravity", gravity, "(3,): m/s²")?));
        }
        if let Some(slip_speed) = slip_speed {
            options.friction = Friction::Smooth { slip_speed };
        }
        let mut torque = Torque::new(this, torque)?;
        let mut tables = vec![&mut theta, &mut dtheta];
        if let Torque::Constant(tau) = &mut torque {
            tables.push(tau);
        }
        let leading = common_leading(tables.iter().map(|table| (table.name, table.leading(1))))?;
        tables.into_iter().try_for_each(|table| table.spread::<f64>(&leading, 1))?;
        let start = [theta.slice()?, dtheta.slice()?];
        if leading.is_empty() {
            let contacts = contacts::contacts(&this.robot().model, contacts, planes)?;
            return one::simulate(slf, start, torque, &options, (watched, contacts));
        }
        let only_one = [
            ("slip_speed", slip_speed.map(|speed| speed.to_string()), "None"),
            ("contacts", contacts.map(|_| "given".into()), "None"),
            ("until or events", (!watched.is_empty()).then(|| "given".into()), "None"),
            ("joint_limits", (joint_limits == Policy::Respect).then(|| "'respect'".into()), "'report' or 'ignore'"),
        ];
        for (name, found, expected) in only_one {
            if let Some(found) = found {
                return Err(PyValueError::new_err(format!("{name} is {found}, expected {expected} of many starts")));
            }
        }
        many::simulate(slf, &leading, start, torque, &options, gravity, threads)
    }
}

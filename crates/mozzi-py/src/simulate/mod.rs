//! Simulation: the arguments, for one start and for many.

pub mod contacts;
mod each;
mod many;
mod one;
mod rollout;
mod watched;

use crate::arguments::Given;
use crate::array::{Numbers, common_leading, shown};
use crate::counts;
use crate::model::PyModel;
use crate::motion::check_motors;
use crate::threads::Threads;
use mozzi::Vec3;
use mozzi_sim::{Friction, Method, Options, Policy};
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
            check_motors(&robot.robot().model, given)?;
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

/// A method of simulations.
fn simulation_method(name: &str, tolerance: Option<f64>) -> PyResult<Method> {
    if let Some(tolerance) = tolerance.filter(|_| name != "dopri") {
        let message = format!("tolerance is {tolerance} and method '{name}', expected 'dopri' or no tolerance");
        return Err(PyValueError::new_err(message));
    }
    match name {
        "auto" => Ok(Method::Automatic),
        "moreau" => Ok(Method::MoreauJean),
        "dopri" => Ok(Method::DormandPrince { tolerance: tolerance.unwrap_or(1e-9) }),
        other => rollout_method(other).map_err(|_| {
            let expected = "'auto', 'moreau', 'rk4', 'semi-implicit-euler', 'euler', 'dopri' or 'midpoint'";
            PyValueError::new_err(format!("method is '{name}', expected {expected}"))
        }),
    }
}

/// A method of rollouts.
fn rollout_method(name: &str) -> PyResult<Method> {
    match name {
        "rk4" => Ok(Method::RungeKutta4),
        "semi-implicit-euler" => Ok(Method::SemiImplicitEuler),
        "euler" => Ok(Method::Euler),
        "midpoint" => Ok(Method::Midpoint),
        _ => {
            let expected = "'rk4', 'semi-implicit-euler', 'euler' or 'midpoint'";
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
    /// Simulate the motion from (θ(0), θ̇(0)) over `duration` seconds, in `steps` equal steps.
    ///
    /// Several starts, given by leading axes, are simulated at once on all cores.
    ///
    /// Parameters
    /// ----------
    /// theta : array_like, shape (..., nq)
    ///     Positions at the start: rad or m.
    /// dtheta : array_like, shape (..., n), optional
    ///     Velocities at the start: rad/s or m/s. Default: at rest.
    /// duration : float
    ///     Duration, s.
    /// steps : int, optional
    ///     Number of steps, at least 1; for 'dopri', which chooses its steps, the number of intervals between rows.
    ///     Default: steps of a millisecond.
    /// torque : callable, array_like, 'gravity_compensation' or None
    ///     The motors' τ, N m or N. A function `torque(t, theta, dtheta)` is called at each stage of each step and
    ///     returns shape (n,); with several starts it is called once per stage for all of them, on arrays of shapes
    ///     (..., nq) and (..., n), and returns shape (..., n). An array of shape (..., n) is constant.
    ///     'gravity_compensation' balances gravity and springs, τ = g(θ) + k(θ − θ₀). None is zero torque.
    /// method : {'auto', 'moreau', 'rk4', 'semi-implicit-euler', 'euler', 'dopri', 'midpoint'}
    ///     Integration method. 'auto' is 'moreau' if there is dry friction, a contact or a limit to respect, else
    ///     'rk4'. 'moreau' is Moreau and Jean's step for one-sided forces, which the other methods refuse. 'dopri', of
    ///     order 5, chooses its steps by a tolerance; 'midpoint' is implicit and symplectic: its energy error stays
    ///     bounded.
    /// tolerance : float or None
    ///     'dopri' only: tolerance on the local error, absolute for θ (rad, m), relative to 1 + |θ̇| for θ̇. Default:
    ///     1e-9.
    /// record_every : int
    ///     Record the start, every k-th step and the last.
    /// until : str, callable, or a list of them, optional
    ///     Conditions that end the motion: a text such as 'elbow > 1.2', which holds when the quantity rises through
    ///     the value ('<': falls, '=': either), for a joint, 'theta_2', 'dtheta_2' or 'tool0.z'; 'joint-limit'; or a
    ///     function, by a zero of `function(t, theta, dtheta)`, or, if it returns a bool, where it becomes True. One
    ///     start only.
    /// events : str, callable, or a list of them, optional
    ///     Conditions of the same form, which are reported in the result's `events` and do not end the motion. One
    ///     start only.
    /// joint_limits : {'report', 'ignore', 'respect'}
    ///     How to treat the joints' position limits: 'report' lists them in the result's `joint_limits`, 'respect'
    ///     brings a joint to rest at its limit, by 'moreau'. Many starts report no limits.
    /// gravity : array_like, shape (3,), optional
    ///     Gravity in the axes of {s}, m/s². Default: the model's.
    /// slip_speed : float, optional
    ///     Coulomb friction μ tanh(θ̇ / slip_speed) in place of dry friction that sticks: rad/s or m/s.
    /// contacts : list of str or dict, optional
    ///     Contact points of the robot: origins of frames by name, or {'frame': …, 'at': (x, y, z), 'radius': …,
    ///     'friction': 0.7, 'restitution': 0, 'name': …}, lengths in m.
    /// planes : list of dict, optional
    ///     {'name': …, 'pose': (qw, qx, qy, qz, x, y, z), 'velocity': (x, y, z)}: the z-axis points towards the robot,
    ///     the surface moves with the velocity. Default: the ground z = 0.
    /// sticking : bool
    ///     Several starts only: False replaces sticking dry friction by μ sgn θ̇, under which joints creep and chatter,
    ///     and integrates all robots together by machine code, which is much faster. Robots with sticking dry friction,
    ///     contacts, stops or a slip speed, and the methods 'moreau', 'dopri' and 'midpoint', are integrated one at a
    ///     time; `torque` must then not be a function.
    /// threads : int, optional
    ///     Maximum number of threads; several starts only. Default: all cores.
    ///
    /// Returns
    /// -------
    /// Trajectory, or Trajectories if there are leading axes
    ///     `t`, shape (rows,), s; `theta`, shape (..., rows, nq); `dtheta`, `ddtheta`, `tau`, shape (..., rows, n); and
    ///     the energies, shape (..., rows), J. One start also has works, such as `motor_work`, and `closing`, the
    ///     largest violation of the constraints.
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     For shapes that do not match, and for options that exclude each other.
    /// DivergedError
    ///     If a state becomes infinite or NaN; the message contains the start's index.
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
    #[pyo3(signature = (theta, dtheta=None, duration=2.0, steps=None, *, torque=None, method="auto", tolerance=None, record_every=1, until=None, events=None, joint_limits="report", gravity=None, slip_speed=None, contacts=None, planes=None, sticking=true, threads=None))]
    #[allow(clippy::too_many_arguments)] // Python's
    fn simulate<'py>(
        slf: &Bound<'py, Self>,
        theta: &Bound<'py, PyAny>,
        dtheta: Given<'_, 'py>,
        duration: f64,
        steps: Given<'_, 'py>,
        torque: Given<'_, 'py>,
        method: &str,
        tolerance: Option<f64>,
        record_every: i64,
        until: Given<'_, 'py>,
        events: Given<'_, 'py>,
        joint_limits: &str,
        gravity: Given<'_, 'py>,
        slip_speed: Option<f64>,
        contacts: Given<'_, 'py>,
        planes: Given<'_, 'py>,
        sticking: bool,
        threads: Option<Threads>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let this = slf.get();
        let numbers = |name, given| -> PyResult<Numbers<'py>> {
            let numbers = Numbers::new(name, given)?;
            this.robot().check_shape(&numbers)?;
            Ok(numbers)
        };
        let at_rest = vec![0.0; this.robot().model.n()].into_pyobject(slf.py())?;
        let (mut theta, mut dtheta) = (numbers("theta", theta)?, numbers("dtheta", dtheta.unwrap_or(&at_rest))?);
        let (steps, record_every) = (counts::steps(steps, duration)?, counts::count("record_every", record_every)?);
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
        // a row of torques for each step, as a rollout takes them, is no torque of many starts
        let states = tables[..2].iter().all(|table| table.leading(1).is_empty());
        if let Some(tau) = tables.get(2).filter(|tau| states && steps > 1 && tau.leading(1) == [steps]) {
            let (found, n) = (shown(&tau.shape), this.robot().model.n());
            let expected = format!("({n},), constant, or a function: torques of each step are those of `rollout`");
            return Err(PyValueError::new_err(format!("torque has shape {found}, expected {expected}")));
        }
        let leading = common_leading(tables.iter().map(|table| (table.name, table.leading(1))))?;
        if duration.is_finite() && until.is_none() {
            counts::check_size(&this.robot().model, leading.iter().product(), steps, record_every)?;
        }
        tables.into_iter().try_for_each(|table| table.spread::<f64>(&leading, 1))?;
        let start = [theta.slice()?, dtheta.slice()?];
        let model = &this.robot().model;
        let listed = |name, given: Given<'_, 'py>| given.map(|given| contacts::listed(name, given)).transpose();
        let given = [listed("contacts", contacts)?, listed("planes", planes)?];
        let given = [given[0].as_ref(), given[1].as_ref()];
        if leading.is_empty() {
            if !sticking {
                return Err(PyValueError::new_err("sticking is False, expected True of one start"));
            }
            let contacts = contacts::Fixed::new(model, given[0], given[1])?.contacts();
            return one::simulate(slf, start, torque, &options, (watched, one::Touched { given, contacts }));
        }
        if !watched.is_empty() {
            return Err(PyValueError::new_err("until or events is given, expected None of many starts"));
        }
        let is_dry = slip_speed.is_none() && model.has_dry_friction();
        let is_alone = given.iter().any(Option::is_some)
            || slip_speed.is_some()
            || joint_limits == Policy::Respect
            || options.method.explicit().is_err();
        if is_alone && is_dry && !sticking {
            let expected = "True of robots that move one by one: with contacts, joint_limits='respect', or this method";
            return Err(PyValueError::new_err(format!("sticking is False, expected {expected}")));
        }
        if is_alone || (is_dry && sticking) {
            // many starts report no limits
            let is_respected = joint_limits == Policy::Respect;
            options.joint_limits = if is_respected { Policy::Respect } else { Policy::Ignore };
            return each::simulate(slf, &leading, start, torque, &options, given, threads);
        }
        many::simulate(slf, &leading, start, torque, &options, gravity, threads)
    }
}

//! Simulation: the arguments, for one start and for many.

pub mod contacts;
mod each;
mod many;
mod one;
mod rollout;
mod watched;

use crate::arguments::Given;
use crate::array::{Numbers, common_leading};
use crate::model::PyModel;
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
fn simulation_method(name: &str, tolerance: Option<f64>) -> PyResult<Method> {
    if let Some(tolerance) = tolerance.filter(|_| name != "dopri") {
        let message = format!("tolerance is {tolerance} and method '{name}', expected 'dopri' or no tolerance");
        return Err(PyValueError::new_err(message));
    }
    match name {
        "auto" => Ok(Method::Automatic),
        "moreau" => Ok(Method::MoreauJean),
        other => method(other, tolerance.unwrap_or(1e-9)).map_err(|_| {
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
    ///     How a step is taken. 'auto' is 'moreau' if there is dry friction, a contact or a limit to respect, else
    ///     'rk4'. 'moreau' is Moreau and Jean's step for one-sided forces, which the others refuse. 'dopri', of order
    ///     5, finds its steps by a tolerance; 'midpoint' is implicit and symplectic: the energy's error stays bounded.
    /// tolerance : float or None
    ///     'dopri' only: tolerance on the local error, absolute for θ (rad, m), relative to 1 + |θ̇| for θ̇; 1e-9 if
    ///     none is given.
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
    ///     brings a joint to rest at its limit, by 'moreau'. Many starts report no limits.
    /// gravity : array_like, shape (3,), optional
    ///     In place of the model's own: m/s².
    /// slip_speed : float, optional
    ///     Coulomb friction μ tanh(θ̇ / slip_speed) in place of dry friction that sticks.
    /// contacts : list of str or dict, optional
    ///     Points of the robot that planes stop: the origins of frames by name, or {'frame': …, 'at': (x, y, z),
    ///     'radius': …, 'friction': 0.7, 'restitution': 0, 'name': …}.
    /// planes : list of dict, optional
    ///     {'name': …, 'pose': (qw, qx, qy, qz, x, y, z), 'velocity': (x, y, z)}: the z-axis points towards the robot,
    ///     the surface moves with the velocity. By default the ground z = 0.
    /// sticking : bool
    ///     Many starts only: whether dry friction holds joints still. Robots with dry friction, contacts, stops, a slip
    ///     speed, or by 'moreau', 'dopri' or 'midpoint' move one by one, each as alone, under a torque that is no
    ///     function. With False dry friction is μ sgn θ̇, under which joints creep and chatter, and all robots move
    ///     together in registers, which is much faster.
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
    #[pyo3(signature = (theta, dtheta, duration, steps, *, torque=None, method="auto", tolerance=None, record_every=1, until=None, events=None, joint_limits="report", gravity=None, slip_speed=None, contacts=None, planes=None, sticking=true, threads=None))]
    #[allow(clippy::too_many_arguments)] // Python's
    fn simulate<'py>(
        slf: &Bound<'py, Self>,
        theta: &Bound<'py, PyAny>,
        dtheta: &Bound<'py, PyAny>,
        duration: f64,
        steps: usize,
        torque: Given<'_, 'py>,
        method: &str,
        tolerance: Option<f64>,
        record_every: usize,
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
        let model = &this.robot().model;
        let [contacts, planes] = [contacts, planes].map(|given| given.map(contacts::listed).transpose());
        let given = [contacts?, planes?];
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
        let is_dry = slip_speed.is_none() && model.joints().any(|joint| joint.friction != 0.0);
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

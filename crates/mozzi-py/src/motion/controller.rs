//! `mozzi.controllers.Controller` and its kinds.

use super::limits::one_or_each;
use super::reference::{PyReference, SharedReference};
use super::repr;
use super::states::States;
use crate::failure::{of_model, of_motion, of_state};
use crate::model::PyModel;
use crate::numpy::Fresh;
use mozzi::{FrameId, Model, SE3};
use mozzi_motion::Error;
use mozzi_motion::controllers::{ComputedTorque, Gains, Law, PdGravity, Standing, TaskSpace};
use mozzi_sim::{ContactPoint, Input};
use pyo3::prelude::*;

/// A controller: the motors' τ that make a robot follow a reference (Modern Robotics, chapter 11).
///
/// It is a `PdGravity`, a `ComputedTorque`, a `TaskSpace`, an `Impedance` or a `Standing`, called as
/// `controller(t, theta, dtheta)`; `Model.simulate` takes it as `torque`. The controller's model may differ from the
/// simulated robot.
///
/// The errors are e = θ_d ⊖ θ and ė = θ̇_d − θ̇; for a frame, X_e = log(T⁻¹T_d) and 𝒱_e = [Ad_{T⁻¹T_d}]𝒱_d − 𝒱, in its
/// own coordinates.
#[pyclass(frozen, subclass, name = "Controller", module = "mozzi.controllers")]
pub struct PyController {
    model: Py<PyModel>,
    reference: Py<PyReference>,
    law: ControlLaw,
}

#[derive(Clone)]
pub(super) enum ControlLaw {
    PdGravity(Gains),
    ComputedTorque(Gains),
    Standing { gains: Gains, feet: Vec<ContactPoint> },
    TaskSpace { frame: FrameId, law: Law, posture: Gains },
}

impl PyController {
    pub(super) fn checked(model: Py<PyModel>, reference: Py<PyReference>, law: ControlLaw) -> PyResult<Self> {
        let same = model.get().robot().model.check_same_joints("the reference's robot", reference.get().model());
        same.map_err(of_model)?;
        let controller = PyController { model, reference, law };
        controller.motors()?;
        Ok(controller)
    }

    pub(super) fn robot(&self) -> &Model {
        &self.model.get().robot().model
    }

    /// As an input of a simulation, with memory of its own.
    ///
    /// # Errors
    /// `ValueError` for gains, frames or robots that do not fit.
    pub fn motors(&self) -> PyResult<Box<dyn Input + '_>> {
        self.law(self.reference.get().reference()?).map_err(of_motion)
    }

    fn law<'a>(&'a self, reference: SharedReference<'a>) -> Result<Box<dyn Input + 'a>, Error> {
        let model = self.robot();
        Ok(match self.law.clone() {
            ControlLaw::PdGravity(gains) => Box::new(PdGravity::new(model, reference, gains)?),
            ControlLaw::ComputedTorque(gains) => Box::new(ComputedTorque::new(model, reference, gains)?),
            ControlLaw::Standing { gains, feet } => {
                Box::new(Standing::new(model, reference, gains, feet, SE3::identity())?)
            }
            ControlLaw::TaskSpace { frame, law, posture } => {
                Box::new(TaskSpace::new(model, reference, frame, law, posture)?)
            }
        })
    }
}

#[pymethods]
impl PyController {
    /// Compute the motors' τ at one state or at many.
    ///
    /// Parameters
    /// ----------
    /// t : array_like, shape (...)
    ///     Times, s.
    /// theta : array_like, shape (..., nq)
    ///     Positions: rad or m.
    /// dtheta : array_like, shape (..., n)
    ///     Velocities: rad/s or m/s.
    ///
    /// Returns
    /// -------
    /// numpy.ndarray, shape (..., n)
    ///     τ: N m or N.
    ///
    /// Raises
    /// ------
    /// SingularError
    ///     If a task is singular at a state.
    fn __call__<'py>(
        &self,
        py: Python<'py>,
        t: &Bound<'py, PyAny>,
        theta: &Bound<'py, PyAny>,
        dtheta: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let states = States::new(self.model.get(), t, theta, dtheta)?;
        let (mut motors, n) = (self.motors()?, self.robot().n());
        let mut tau = Fresh::<f64>::new(py, &[&states.leading[..], &[n]].concat())?;
        for (index, ((t, theta, dtheta), tau)) in
            states.rows()?.zip(tau.numbers().chunks_exact_mut(n.max(1))).enumerate()
        {
            motors.torque(t, theta, dtheta, tau).map_err(|error| of_state(error, index, &states.leading))?;
        }
        Ok(tau.into_array())
    }

    /// The controller's model of the robot.
    #[getter]
    fn model(&self, py: Python<'_>) -> Py<PyModel> {
        self.model.clone_ref(py)
    }

    /// The reference that the controller follows.
    #[getter]
    fn reference(&self, py: Python<'_>) -> Py<PyReference> {
        self.reference.clone_ref(py)
    }

    fn __repr__(&self) -> String {
        let robot = self.robot();
        let (kind, frame, first, second) = match &self.law {
            ControlLaw::PdGravity(Gains { p, d }) => ("PdGravity", None, ("p", &p[..]), ("d", &d[..])),
            ControlLaw::ComputedTorque(Gains { p, d }) => ("ComputedTorque", None, ("p", &p[..]), ("d", &d[..])),
            ControlLaw::Standing { gains: Gains { p, d }, .. } => ("Standing", None, ("p", &p[..]), ("d", &d[..])),
            ControlLaw::TaskSpace { frame, law: Law::Acceleration { p, d }, .. } => {
                ("TaskSpace", Some(*frame), ("p", &p[..]), ("d", &d[..]))
            }
            ControlLaw::TaskSpace { frame, law: Law::Impedance { stiffness, damping }, .. } => {
                ("Impedance", Some(*frame), ("stiffness", &stiffness[..]), ("damping", &damping[..]))
            }
        };
        let gain = |(name, list): (&str, &[f64])| format!("{name} = {}", repr::gains(list));
        let frame = frame.map_or_else(String::new, |frame| format!("'{}' of ", robot.frame_name(frame)));
        let robot = &robot.description().name;
        format!("<mozzi.controllers.{kind} of {frame}'{robot}': {}, {}>", gain(first), gain(second))
    }
}

/// K_p and K_d of each velocity, from one number for all or one for each.
pub(super) fn gains(model: &Py<PyModel>, [p, d]: [(&'static str, &Bound<'_, PyAny>); 2]) -> PyResult<Gains> {
    let n = model.get().robot().model.n();
    Ok(Gains { p: one_or_each(p.0, p.1, n)?, d: one_or_each(d.0, d.1, n)? })
}

/// One number for all six rows of a twist, or one for each.
fn six(name: &'static str, given: &Bound<'_, PyAny>) -> PyResult<[f64; 6]> {
    let list = one_or_each(name, given, 6)?;
    Ok(std::array::from_fn(|row| list[row]))
}

/// PD control with gravity compensation, τ = g(θ) + k(θ − θ₀) + K_p e + K_d ė (Modern Robotics, section 11.4.2).
///
/// The robot comes to rest where the reference rests, and lags behind a moving reference. A floating base and a free
/// joint have no motors.
///
/// Parameters
/// ----------
/// model : Model
///     The controller's model of the robot.
/// reference : Reference
///     The desired motion.
/// p, d : array_like, shape (n,) or ()
///     K_p, N m/rad or N/m, and K_d, N m s/rad or N s/m, of each velocity, or one for all: not negative.
///
/// Examples
/// --------
/// >>> import mozzi
/// >>> from mozzi.controllers import PdGravity
/// >>> from mozzi.trajectories import Hold
/// >>> pendulum = mozzi.models.double_pendulum()
/// >>> control = PdGravity(pendulum, Hold(pendulum, [1.0, 0.5]), p=5.0, d=1.0)
/// >>> motion = pendulum.simulate([0.0, 0.0], [0.0, 0.0], 8.0, 1000, torque=control)
/// >>> bool(abs(motion.theta[-1] - [1.0, 0.5]).max() < 1e-3)
/// True
#[pyclass(frozen, extends = PyController, name = "PdGravity", module = "mozzi.controllers")]
pub struct PyPdGravity;

#[pymethods]
impl PyPdGravity {
    #[new]
    #[pyo3(signature = (model, reference, *, p, d))]
    fn new(
        model: Py<PyModel>,
        reference: Py<PyReference>,
        p: &Bound<'_, PyAny>,
        d: &Bound<'_, PyAny>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let law = ControlLaw::PdGravity(gains(&model, [("p", p), ("d", d)])?);
        Ok(PyClassInitializer::from(PyController::checked(model, reference, law)?).add_subclass(PyPdGravity))
    }
}

/// Computed torque, τ = M(θ)(θ̈_d + K_d ė + K_p e) + h(θ, θ̇) + f(θ, θ̇) (Modern Robotics 11.37).
///
/// For an exact model the error obeys ë + K_d ė + K_p e = 0, critically damped with K_p = ω², K_d = 2ω. For robots with
/// a fixed base; one inverse dynamics a call.
///
/// Parameters
/// ----------
/// model : Model
///     The controller's model of the robot.
/// reference : Reference
///     The desired motion.
/// p, d : array_like, shape (n,) or ()
///     K_p, 1/s², and K_d, 1/s, of each velocity, or one for all: not negative.
///
/// Examples
/// --------
/// >>> import mozzi
/// >>> from mozzi.controllers import ComputedTorque, tracking_error
/// >>> from mozzi.trajectories import Line, Profile, Timed
/// >>> arm = mozzi.models.two_link_planar()
/// >>> motion = Timed(Line(arm, [0.0, 0.0], [1.0, -1.5]), Profile.quintic(1.0))
/// >>> followed = arm.simulate([0.0, 0.0], [0.0, 0.0], 1.0, 200, torque=ComputedTorque(arm, motion, p=400.0, d=40.0))
/// >>> bool(tracking_error(followed, motion).worst < 1e-6)
/// True
#[pyclass(frozen, extends = PyController, name = "ComputedTorque", module = "mozzi.controllers")]
pub struct PyComputedTorque;

#[pymethods]
impl PyComputedTorque {
    #[new]
    #[pyo3(signature = (model, reference, *, p, d))]
    fn new(
        model: Py<PyModel>,
        reference: Py<PyReference>,
        p: &Bound<'_, PyAny>,
        d: &Bound<'_, PyAny>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let law = ControlLaw::ComputedTorque(gains(&model, [("p", p), ("d", d)])?);
        Ok(PyClassInitializer::from(PyController::checked(model, reference, law)?).add_subclass(PyComputedTorque))
    }
}

/// Task-space control of a frame, τ = Jᵀ(Λ(a + K_d 𝒱_e + K_p X_e) + η) (Modern Robotics, section 11.4.3).
///
/// For an exact model the error obeys 𝒱̇_e + K_d 𝒱_e + K_p X_e = 0. The frame follows the pose that the joints'
/// reference gives it. If the robot has more than six joints, the motion that the task leaves free follows the
/// reference with the posture gains.
///
/// Parameters
/// ----------
/// model : Model
///     The controller's model of the robot, with a fixed base.
/// reference : Reference
///     The desired motion of the joints.
/// frame : str, optional
///     The controlled frame. Default: the end effector.
/// p, d : array_like, shape (6,) or ()
///     K_p, 1/s², and K_d, 1/s, of each row of (ω, v) in the frame's coordinates, or one for all: not negative.
/// posture_p, posture_d : array_like, shape (n,) or (), optional
///     The posture's K_p, 1/s², and K_d, 1/s. Default: 100 and 20, critically damped.
///
/// Examples
/// --------
/// >>> import mozzi
/// >>> from mozzi.controllers import TaskSpace
/// >>> from mozzi.trajectories import Hold
/// >>> ur5, theta = mozzi.models.ur5(), [0.0, -1.2, 1.5, 0.3, 1.1, 0.0]
/// >>> control = TaskSpace(ur5, Hold(ur5, theta), p=400.0, d=40.0)
/// >>> bool(abs(control(0.0, theta, [0.0] * 6) - ur5.gravity_forces(theta)).max() < 1e-9)
/// True
#[pyclass(frozen, extends = PyController, name = "TaskSpace", module = "mozzi.controllers")]
pub struct PyTaskSpace;

#[pymethods]
impl PyTaskSpace {
    #[new]
    #[pyo3(signature = (model, reference, frame=None, *, p, d, posture_p=None, posture_d=None))]
    #[allow(clippy::too_many_arguments)] // Python's
    fn new(
        model: Py<PyModel>,
        reference: Py<PyReference>,
        frame: Option<&str>,
        p: &Bound<'_, PyAny>,
        d: &Bound<'_, PyAny>,
        posture_p: Option<&Bound<'_, PyAny>>,
        posture_d: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let law = Law::Acceleration { p: six("p", p)?, d: six("d", d)? };
        let law = task(&model, frame, law, [posture_p, posture_d])?;
        Ok(PyClassInitializer::from(PyController::checked(model, reference, law)?).add_subclass(PyTaskSpace))
    }
}

/// A control law for a frame, with the posture's K_p and K_d.
fn task(
    model: &Py<PyModel>,
    frame: Option<&str>,
    law: Law,
    [p, d]: [Option<&Bound<'_, PyAny>>; 2],
) -> PyResult<ControlLaw> {
    let n = model.get().robot().model.n();
    let mut posture = Gains::critical(n, POSTURE);
    for (name, place, given) in [("posture_p", &mut posture.p, p), ("posture_d", &mut posture.d, d)] {
        if let Some(given) = given {
            *place = one_or_each(name, given, n)?;
        }
    }
    Ok(ControlLaw::TaskSpace { frame: model.get().frame(frame)?, law, posture })
}

/// ω of the default posture gains, rad/s.
const POSTURE: f64 = 10.0;

/// Impedance control of a frame, τ = Jᵀ(Λa + η + B𝒱_e + KX_e) (Modern Robotics, section 11.7; Hogan 1985).
///
/// The frame yields like a spring and a damper, with the robot's own inertia: Λ𝒱̇_e + B𝒱_e + KX_e = 𝓕, the wrench that
/// it applies to the environment. The motion that the task leaves free follows the reference with the posture gains.
///
/// Parameters
/// ----------
/// model : Model
///     The controller's model of the robot, with a fixed base.
/// reference : Reference
///     The desired motion of the joints.
/// frame : str, optional
///     The controlled frame. Default: the end effector.
/// stiffness, damping : array_like, shape (6,) or ()
///     K, N m/rad and N/m, and B, N m s/rad and N s/m, of each row of (ω, v) in the frame's coordinates, or one for
///     all: not negative.
/// posture_p, posture_d : array_like, shape (n,) or (), optional
///     The posture's K_p, 1/s², and K_d, 1/s. Default: 100 and 20, critically damped.
///
/// Examples
/// --------
/// >>> import mozzi
/// >>> from mozzi.controllers import Impedance
/// >>> from mozzi.trajectories import Hold
/// >>> ur5, theta = mozzi.models.ur5(), [0.0, -1.2, 1.5, 0.3, 1.1, 0.0]
/// >>> K, B = [20, 20, 20, 1000, 1000, 1000], [1.5, 1.5, 1.5, 90, 90, 90]
/// >>> control = Impedance(ur5, Hold(ur5, theta), stiffness=K, damping=B)
/// >>> bool(abs(control(0.0, theta, [0.0] * 6) - ur5.gravity_forces(theta)).max() < 1e-9)
/// True
#[pyclass(frozen, extends = PyController, name = "Impedance", module = "mozzi.controllers")]
pub struct PyImpedance;

#[pymethods]
impl PyImpedance {
    #[new]
    #[pyo3(signature = (model, reference, frame=None, *, stiffness, damping, posture_p=None, posture_d=None))]
    #[allow(clippy::too_many_arguments)] // Python's
    fn new(
        model: Py<PyModel>,
        reference: Py<PyReference>,
        frame: Option<&str>,
        stiffness: &Bound<'_, PyAny>,
        damping: &Bound<'_, PyAny>,
        posture_p: Option<&Bound<'_, PyAny>>,
        posture_d: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<PyClassInitializer<Self>> {
        let law = Law::Impedance { stiffness: six("stiffness", stiffness)?, damping: six("damping", damping)? };
        let law = task(&model, frame, law, [posture_p, posture_d])?;
        Ok(PyClassInitializer::from(PyController::checked(model, reference, law)?).add_subclass(PyImpedance))
    }
}

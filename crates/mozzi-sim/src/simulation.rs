//! A simulation of one robot, and its results.

use crate::Error;
use crate::closing::Closing;
use crate::contacts::{ContactEvent, Contacts};
use crate::course::Course;
use crate::events::stops::Stopped;
use crate::events::{Event, Occurrence};
use crate::impulses::OneSidedAccount;
use crate::{ForwardDynamics, Input, Method, Options, Policy, Recorder, Trajectory};
use alloc::vec::Vec;
use core::ops::ControlFlow;
use mozzi::model::Model;

/// A simulation of one robot: its options, events, and implementation of θ̈. [`simulate`] is one without events,
/// by the kernels.
///
/// ```
/// # use mozzi::{Description, HomeFrames, SE3, ScrewAxis, Screws, Solid};
/// use mozzi_sim::{Event, Method, Options, Simulation, Zero};
/// # let rod = Solid::Box([1.0, 0.02, 0.02]).inertia(1.0);
/// # let home = [0.5, 1.5, 2.0].map(|x| SE3::translation([x, 0.0, 0.0]));
/// # let S = [0.0, 1.0].map(|x| ScrewAxis::from_line([0.0, 1.0, 0.0], [x, 0.0, 0.0], 0.0).expect("unit"));
/// # let model = Description::from_screws("arm", HomeFrames::Base(&home), &[rod; 2], Screws::Space(&S))?.build()?;
/// let simulation = Simulation {
///     events: vec![Event::new("the first rod hangs", |_, theta, _| theta[0] - 1.57)],
///     ..Simulation::new(Options { method: Method::DormandPrince { tolerance: 1e-9 }, ..Options::new(2.0, 100) })
/// };
/// let run = simulation.run(&model, &[0.0, 0.5], &[0.0, 0.0], Zero)?;
/// assert!((run.events[0].theta[0] - 1.57).abs() < 1e-12 && run.motion.largest_drift() < 1e-6);
/// # Ok::<(), mozzi_sim::Error>(())
/// ```
pub struct Simulation<'a> {
    /// Method, duration, rows, gravity, friction, limits.
    pub options: Options,
    /// The events to locate.
    pub events: Vec<Event<'a>>,
    /// θ̈ by machine code instead of the kernels, such as `mozzi_engine::Compiled::simulator` returns.
    pub forward_dynamics: Option<&'a dyn ForwardDynamics>,
    /// Contact points and planes.
    pub contacts: Contacts<'a>,
}

/// A simulated motion, with its events and stops.
#[derive(Clone, Debug, PartialEq)]
pub struct Run {
    /// The rows.
    pub motion: Trajectory,
    /// In the order of time.
    pub events: Vec<Occurrence>,
    /// Joints that reached their limits; none if limits are ignored.
    pub stops: Vec<Stopped>,
    /// The largest violation of the robot's constraints.
    pub closing: Closing,
    /// The method that took the steps.
    pub method: Method,
    /// The solutions for dry friction, stops and contacts; `None` if there are none.
    pub one_sided: Option<OneSidedAccount>,
    /// Touch-downs, lift-offs, and where contacts begin or cease to slide: the first 10,000, in the order of time.
    pub contact_events: Vec<ContactEvent>,
}

/// The result of a simulation whose rows went to a recorder.
#[derive(Clone, Debug, PartialEq)]
pub struct Ending {
    /// Steps taken.
    pub steps: usize,
    /// True if it reached t_f; false if an event, the progress callback or the recorder ended it.
    pub complete: bool,
    /// In the order of time.
    pub events: Vec<Occurrence>,
    /// Joints that reached their limits; none if limits are ignored.
    pub stops: Vec<Stopped>,
    /// The largest violation of the robot's constraints.
    pub closing: Closing,
    /// The method that took the steps.
    pub method: Method,
    /// The solutions for dry friction, stops and contacts; `None` if there are none.
    pub one_sided: Option<OneSidedAccount>,
    /// Touch-downs, lift-offs, and where contacts begin or cease to slide: the first 10,000, in the order of time.
    pub contact_events: Vec<ContactEvent>,
}

impl Ending {
    /// Before the first step.
    pub(crate) fn new(method: Method) -> Self {
        Ending {
            steps: 0,
            complete: false,
            events: Vec::new(),
            stops: Vec::new(),
            closing: Closing::default(),
            method,
            one_sided: None,
            contact_events: Vec::new(),
        }
    }
}

impl<'a> Simulation<'a> {
    /// Without events, by the kernels.
    pub fn new(options: Options) -> Self {
        Simulation { options, events: Vec::new(), forward_dynamics: None, contacts: Contacts::default() }
    }

    /// The motion from (θ(0), θ̇(0)) under an input.
    ///
    /// # Errors
    /// Those of [`simulate`].
    pub fn run(&self, model: &Model, theta: &[f64], dtheta: &[f64], input: impl Input) -> Result<Run, Error> {
        self.run_with_progress(model, theta, dtheta, input, |_| ControlFlow::Continue(()))
    }

    /// As [`run`](Self::run); after each step `progress(t)` is called. `ControlFlow::Break(())` stops the simulation:
    /// the result is then the motion so far, not [`complete`](Trajectory::complete).
    ///
    /// # Errors
    /// Those of [`simulate`].
    pub fn run_with_progress(
        &self,
        model: &Model,
        theta: &[f64],
        dtheta: &[f64],
        input: impl Input,
        progress: impl FnMut(f64) -> ControlFlow<()>,
    ) -> Result<Run, Error> {
        let mut motion = Trajectory::new(model);
        let Ending { steps, complete, events, stops, closing, method, one_sided, contact_events } =
            self.stream(model, theta, dtheta, input, &mut motion, progress)?;
        (motion.steps, motion.complete) = (steps, complete);
        Ok(Run { motion, events, stops, closing, method, one_sided, contact_events })
    }

    /// As [`run_with_progress`](Self::run_with_progress), but passes the rows to a recorder one by one: memory does not
    /// grow with them.
    ///
    /// # Errors
    /// Those of [`simulate`]; the rows before the error were recorded.
    pub fn stream(
        &self,
        model: &Model,
        theta: &[f64],
        dtheta: &[f64],
        mut input: impl Input,
        recorder: &mut dyn Recorder,
        mut progress: impl FnMut(f64) -> ControlFlow<()>,
    ) -> Result<Ending, Error> {
        let mut course = Course::new(self, model, [theta, dtheta], &mut input, recorder)?;
        course.run(&mut progress)?;
        course.ending.closing = course.driven.closing();
        course.ending.one_sided = course.impulses.as_ref().map(|impulses| impulses.account);
        course.ending.stops = course.stops.noted();
        Ok(course.ending)
    }
}

/// The motion from (θ(0), θ̇(0)) under an input, by N steps of δt = t_f / N.
///
/// The input is called at the time and in the state of each stage of each step. A step costs one
/// forward dynamics (O(n)) for the Euler methods and four for Runge-Kutta 4, and allocates nothing; six for
/// Dormand-Prince.
///
/// ```
/// use mozzi::model::description::{Joint, JointKind};
/// use mozzi::{Description, SE3, ScrewAxis, SpatialInertia, Vec3};
/// use mozzi_sim::{Options, Zero, simulate, torque};
/// // a pendulum of 1 kg at 1 m, hanging along −z at θ = 0, turning about y
/// let axis = JointKind::Screw(ScrewAxis::new([0.0, 1.0, 0.0], [0.0; 3])?);
/// let pendulum = Description::new("pendulum")
///     .link("base", SpatialInertia::zero())
///     .link("bob", SpatialInertia::point_mass(1.0, Vec3([0.0, 0.0, -1.0])))
///     .joint(Joint::new("pivot", "base", "bob", SE3::identity(), axis))
///     .build()?;
///
/// let fall = simulate(&pendulum, &[1.0], &[0.0], Zero, &Options::new(2.0, 2000))?;
/// assert_eq!(fall.len(), 2001);
/// assert!(fall.largest_drift() < 1e-10);
///
/// let brake = torque(|_t, _theta, dtheta, tau| tau[0] -= 5.0 * dtheta[0]);
/// let end = simulate(&pendulum, &[1.0], &[0.0], brake, &Options::with_step(20.0, 0.01)?)?;
/// assert!(end.last().theta[0].abs() < 1e-10);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// [`Simulation::run`] [reports](Policy::Report) limits that were exceeded; this method does not.
///
/// # Errors
/// [`Error::Model`] for an invalid start, invalid options, an input that is not finite, or a singular mass matrix;
/// [`Error::Diverged`] if the state becomes infinite or NaN; [`Error::Stalled`], [`Error::NoConvergence`]; the input's
/// own errors.
pub fn simulate(
    model: &Model,
    theta: &[f64],
    dtheta: &[f64],
    input: impl Input,
    options: &Options,
) -> Result<Trajectory, Error> {
    let unseen = options.joint_limits == Policy::Report;
    let joint_limits = if unseen { Policy::Ignore } else { options.joint_limits };
    let simulation = Simulation::new(Options { joint_limits, ..*options });
    simulation.run(model, theta, dtheta, input).map(|run| run.motion)
}

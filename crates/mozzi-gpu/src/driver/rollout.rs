//! Rollouts on a device.

use super::{Device, Kernel, Stream};
use crate::{Binary, Error, Number, Source};
use mozzi_engine::Precision;
use std::ffi::c_void;

/// Rollouts of many robots of one model: see [`Source::rollout`].
#[derive(Clone, Debug)]
pub struct Rollout {
    kernel: Kernel,
}

/// The steps of rollouts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Steps {
    /// h > 0, s.
    pub step: f64,
    /// K.
    pub steps: usize,
    /// The states after each this many steps are stored; it divides K.
    pub every: usize,
}

/// Addresses of a device's arrays. Each robot's part is a row, or a column in layout
/// [`Columns`](mozzi_engine::CudaLayout::Columns).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RolloutArrays {
    /// θ\[0\], nq numbers a robot.
    pub theta: u64,
    /// θ̇\[0\], n numbers a robot.
    pub dtheta: u64,
    /// Torques, K n numbers a robot, those of a step side by side; `None` for zeros.
    pub tau: Option<u64>,
    /// Feedback: the gains G, n × 2n by rows, for all robots; and the desired states, nq + n numbers a robot.
    pub feedback: Option<[u64; 2]>,
    /// θ after each `every` steps, K/every · nq numbers a robot.
    pub theta_table: u64,
    /// θ̇ likewise, K/every · n numbers.
    pub dtheta_table: u64,
}

/// Arrays of the host: see [`RolloutArrays`].
#[derive(Clone, Copy, Debug)]
pub struct RolloutInputs<'a, T> {
    /// θ\[0\].
    pub theta: &'a [T],
    /// θ̇\[0\].
    pub dtheta: &'a [T],
    /// Torques.
    pub tau: Option<&'a [T]>,
    /// Gains and desired states.
    pub feedback: Option<[&'a [T]; 2]>,
}

impl Steps {
    fn check(&self) -> Result<(), Error> {
        let wrong = |what, found: String, expected| Err(mozzi::Error::BadArgument { what, found, expected }.into());
        if !(self.step > 0.0 && self.step.is_finite()) {
            return wrong("the step", self.step.to_string(), "a positive number of seconds");
        }
        match self.every > 0 && self.steps.is_multiple_of(self.every) {
            true => Ok(()),
            false => wrong("every", self.every.to_string(), "a divisor of the number of steps"),
        }
    }
}

impl Rollout {
    /// Compiles a text of [`Source::rollout`] for this device, and loads it.
    ///
    /// # Errors
    /// See [`Device::kernel`].
    pub fn new(device: &Device, source: &Source) -> Result<Rollout, Error> {
        Ok(Rollout { kernel: device.kernel(source)? })
    }

    /// Loads such a text's code.
    ///
    /// # Errors
    /// See [`Device::load`].
    pub fn load(device: &Device, source: &Source, binary: &Binary) -> Result<Rollout, Error> {
        Ok(Rollout { kernel: device.load(source, binary)? })
    }

    /// Launches it on arrays of the device for this many robots. It neither waits nor allocates.
    ///
    /// # Errors
    /// [`Error::Model`] if the steps are invalid, [`Error::Driver`].
    ///
    /// # Safety
    /// As for [`Kernel::launch`], with the numbers of [`RolloutArrays`].
    pub unsafe fn launch(
        &self,
        arrays: &RolloutArrays,
        steps: &Steps,
        robots: usize,
        stream: Stream,
    ) -> Result<(), Error> {
        steps.check()?;
        let [gains, target] = arrays.feedback.unwrap_or_default();
        let inputs = [arrays.theta, arrays.dtheta, arrays.tau.unwrap_or(0), gains, target];
        let outputs = [arrays.theta_table, arrays.dtheta_table];
        let (h, h_f32) = (steps.step, steps.step as f32);
        let counts = [steps.steps as u64, steps.every as u64, robots as u64];
        fn address<T>(x: &T) -> *mut c_void {
            std::ptr::from_ref(x).cast_mut().cast()
        }
        let mut parameters: Vec<*mut c_void> = inputs.iter().chain(&outputs).map(address).collect();
        let is_f64 = self.kernel.source().form().precision == Precision::F64;
        parameters.push(if is_f64 { address(&h) } else { address(&h_f32) });
        parameters.extend(counts.iter().map(address));
        // SAFETY: the parameters are those of the text; the caller answers for the arrays and the stream
        unsafe { self.kernel.launch_with(&mut parameters, robots, stream) }
    }

    /// Copies arrays of the host to the device, runs the steps, and returns the tables of θ and θ̇.
    ///
    /// # Errors
    /// [`Error::WrongPrecision`], [`Error::WrongLength`]; see [`launch`](Self::launch).
    pub fn compute<T: Number>(&self, inputs: &RolloutInputs<T>, steps: &Steps) -> Result<[Vec<T>; 2], Error> {
        steps.check()?;
        let source = self.kernel.source();
        let robots = source.states::<T>(&[inputs.theta.len(), inputs.dtheta.len()])?;
        let [nq, n] = [0, 1].map(|k| source.inputs()[k].length);
        let check = |what: &str, found: usize, states: usize, width: usize| match found == states * width {
            true => Ok(()),
            false => Err(Error::WrongLength { what: what.into(), found, expected: states * width, states, width }),
        };
        inputs.tau.map_or(Ok(()), |tau| check("tau", tau.len(), robots, steps.steps * n))?;
        if let Some([gains, target]) = inputs.feedback {
            check("gains", gains.len(), n, 2 * n)?;
            check("target", target.len(), robots, nq + n)?;
        }
        let device = self.kernel.device();
        let [theta, dtheta] = [device.copy(inputs.theta)?, device.copy(inputs.dtheta)?];
        let tau = inputs.tau.map(|tau| device.copy(tau)).transpose()?;
        let feedback = match inputs.feedback {
            Some([gains, target]) => Some([device.copy(gains)?, device.copy(target)?]),
            None => None,
        };
        let rows = robots * (steps.steps / steps.every);
        let tables = [device.zeros::<T>(rows * nq)?, device.zeros::<T>(rows * n)?];
        let arrays = RolloutArrays {
            theta: theta.pointer(),
            dtheta: dtheta.pointer(),
            tau: tau.as_ref().map(|tau| tau.pointer()),
            feedback: feedback.as_ref().map(|pair| pair.each_ref().map(|array| array.pointer())),
            theta_table: tables[0].pointer(),
            dtheta_table: tables[1].pointer(),
        };
        // SAFETY: living arrays of checked lengths; copying waits for the kernel
        unsafe { self.launch(&arrays, steps, robots, Stream::default()) }?;
        let [theta, dtheta] = tables;
        Ok([theta.to_vec()?, dtheta.to_vec()?])
    }
}

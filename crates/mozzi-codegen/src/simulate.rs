//! Simulation by machine code.

use crate::{Compiled, Engine, Quantity};
use mozzi::simulation::{Equation, ForwardDynamics, Input, Options};
use mozzi::{Error, Model, Trajectory};
use std::ops::ControlFlow;

impl ForwardDynamics for Compiled {
    fn model(&self) -> &Model {
        self.model()
    }

    fn write(&self, theta: &[f64], dtheta: &[f64], tau: &[f64], ddtheta: &mut [f64], pivots: &mut [f64]) {
        self.evaluate(Quantity::ForwardDynamics, &[theta, dtheta, tau], &mut [ddtheta, pivots]);
    }
}

impl Compiled {
    /// Machine code for θ̈, where there is some.
    pub fn simulator(&self) -> Option<&dyn ForwardDynamics> {
        let is_code = matches!(self.engine(Quantity::ForwardDynamics), Engine::MachineCode(..));
        is_code.then_some(self as &dyn ForwardDynamics)
    }

    /// The motion from (θ(0), θ̇(0)): see [`Model::simulate`], with forward dynamics by machine code where it was asked for, nothing is
    /// touched and gravity is the robot's own.
    ///
    /// ```
    /// use mozzi::simulation::{Options, Zero};
    /// use mozzi_codegen::{Quantity, compile};
    /// # fn main() -> Result<(), Box<dyn std::error::Error>> {
    /// let model = mozzi_urdf::open("ur5")?.build()?;
    /// let robot = compile(&model, &[Quantity::ForwardDynamics])?;
    /// let fall = robot.simulate(&[0.1; 6], &[0.0; 6], Zero, &Options::new(0.2, 200))?;
    /// assert!(fall.largest_drift() < 1e-6);
    /// # Ok(()) }
    /// ```
    ///
    /// # Errors
    /// As there.
    pub fn simulate(
        &self,
        theta: &[f64],
        dtheta: &[f64],
        input: impl Input,
        options: &Options,
    ) -> Result<Trajectory, Error> {
        self.simulate_with_progress(theta, dtheta, input, options, |_, _| ControlFlow::Continue(()))
    }

    /// As [`simulate`](Self::simulate), telling `progress` as [`Model::simulate_with_progress`] does.
    ///
    /// # Errors
    /// As there.
    pub fn simulate_with_progress(
        &self,
        theta: &[f64],
        dtheta: &[f64],
        input: impl Input,
        options: &Options,
        progress: impl FnMut(usize, usize) -> ControlFlow<()>,
    ) -> Result<Trajectory, Error> {
        Equation::new(self.model(), input, options)
            .with_forward_dynamics(self.simulator())?
            .simulate(theta, dtheta, progress)
    }
}

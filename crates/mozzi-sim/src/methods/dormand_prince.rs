//! Dormand and Prince's pair of orders 5 and 4 with its dense output (Hairer, Nørsett and Wanner 1993, section II.5 and
//! II.6).

use crate::Error;
use crate::driven::Driven;
use crate::methods::dense::{Dense, rate};
use crate::stall::{Trouble, too_short};
use crate::state::State;
use crate::{Equation, Input, Motion, Options};
use alloc::vec;
use alloc::vec::Vec;
use mozzi::model::Model;
use mozzi::model::integrate;
use mozzi::scalar::Scalar;

const C: [f64; 7] = [0.0, 0.2, 0.3, 0.8, 8.0 / 9.0, 1.0, 1.0];
const A: [[f64; 6]; 7] = [
    [0.0; 6],
    [0.2, 0.0, 0.0, 0.0, 0.0, 0.0],
    [3.0 / 40.0, 9.0 / 40.0, 0.0, 0.0, 0.0, 0.0],
    [44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0, 0.0, 0.0, 0.0],
    [19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0, 0.0, 0.0],
    [9017.0 / 3168.0, -355.0 / 33.0, 46732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18656.0, 0.0],
    [35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0],
];
/// The difference of the two orders.
const E: [f64; 7] =
    [71.0 / 57600.0, 0.0, -71.0 / 16695.0, 71.0 / 1920.0, -17253.0 / 339200.0, 22.0 / 525.0, -1.0 / 40.0];
/// Coefficients of the fourth-order dense output.
const D: [f64; 7] = [
    -12715105075.0 / 11282082432.0,
    0.0,
    87487479700.0 / 32700410799.0,
    -10690763975.0 / 1880347072.0,
    701980252875.0 / 199316789632.0,
    -1453857185.0 / 822651844.0,
    69997945.0 / 29380423.0,
];

/// Steps as long as the tolerance allows.
#[derive(Clone, Debug)]
pub(crate) struct DormandPrince {
    tolerance: f64,
    /// The largest length of the next step.
    h: f64,
    pub trouble: Trouble,
    /// Rates of (u, θ̇, w) at the stages; memory.
    k: [Vec<f64>; 7],
    y: Vec<f64>,
    theta: Vec<f64>,
}

impl DormandPrince {
    pub fn new(n: usize, nq: usize, tolerance: f64) -> Self {
        let zeros = vec![0.0; 2 * n + 3];
        let k = core::array::from_fn(|_| zeros.clone());
        DormandPrince { tolerance, h: 1e-3, trouble: Trouble::new(n), k, y: zeros, theta: vec![0.0; nq] }
    }

    /// A step to `until` at most.
    pub fn step(&mut self, from: &State, until: f64, driven: &mut Driven) -> Result<(State, Dense), Error> {
        let (model, n) = (driven.model, from.dtheta.len());
        let start = [&vec![0.0; n][..], &from.dtheta, &from.works].concat();
        self.k[0] = [&from.dtheta[..], &from.ddtheta, &from.powers].concat();
        let mut changes = vec![false; n];
        loop {
            let room = until - from.t;
            // no tiny remainder is left for a last step
            let h = if self.h >= 0.99 * room { room } else { self.h };
            if !(h > 1e-13 * from.t.abs().max(1e-3).max(1e-6 * until)) && room > h {
                return Err(too_short(model, [from.t, h], self.tolerance, self.trouble.sensitive));
            }
            changes.fill(false);
            for stage in 1..7 {
                for i in 0..self.y.len() {
                    self.y[i] = start[i] + h * (0..stage).map(|r| A[stage][r] * self.k[r][i]).sum::<f64>();
                }
                let (u, rest) = self.y.split_at(n);
                let dtheta = &rest[..n];
                (0..n).for_each(|j| changes[j] |= dtheta[j] * from.dtheta[j] < 0.0);
                self.theta.copy_from_slice(&from.theta);
                integrate(model, &mut self.theta, u, 1.0);
                let k = &mut self.k[stage];
                rate(model, u, dtheta, &mut k[..n]);
                let t = if stage >= 5 { from.t + h } else { from.t + C[stage] * h };
                let powers = driven.evaluate(t, &self.theta, dtheta, &mut k[n..2 * n])?;
                k[2 * n..].copy_from_slice(&powers);
            }
            // the works are not part of the estimate: the motion does not depend on them
            let error = |i: usize| {
                let estimate = h * (0..7).map(|r| E[r] * self.k[r][i]).sum::<f64>();
                let size = if i < n { 0.0 } else { start[i].abs().max(self.y[i].abs()) };
                estimate / (self.tolerance * (1.0 + size))
            };
            self.trouble.changes.iter_mut().zip(&changes).for_each(|(count, &change)| *count += usize::from(change));
            self.trouble.sensitive = (0..n).max_by(|&i, &j| error(n + i).abs().total_cmp(&error(n + j).abs()));
            let mean = (0..2 * n).map(|i| squared(error(i))).sum::<f64>() / (2 * n).max(1) as f64;
            let mean = Scalar::sqrt(mean);
            let factor = if mean > 0.0 { (0.9 * power(mean, -0.2)).clamp(0.2, 5.0) } else { 5.0 };
            if !(mean <= 1.0) {
                self.h = h * if mean.is_finite() { factor } else { 0.2 };
                continue;
            }
            // a step that `until` cuts short is no basis for the next step's length
            self.h = if h < self.h { self.h.max(h * factor) } else { h * factor };
            return Ok(self.finish(from, start, h, until));
        }
    }

    fn finish(&self, from: &State, start: Vec<f64>, h: f64, until: f64) -> (State, Dense) {
        let (n, k) = (from.dtheta.len(), &self.k);
        let way: Vec<f64> = self.y.iter().zip(&start).map(|(b, a)| b - a).collect();
        let bend: Vec<f64> = (0..way.len()).map(|i| h * k[0][i] - way[i]).collect();
        let twist = (0..way.len()).map(|i| way[i] - h * k[6][i] - bend[i]).collect();
        let fourth = (0..way.len()).map(|i| h * (0..7).map(|r| D[r] * k[r][i]).sum::<f64>()).collect();
        let array = |list: &[f64]| [list[0], list[1], list[2]];
        let state = State {
            t: if h == until - from.t { until } else { from.t + h },
            theta: self.theta.clone(),
            dtheta: self.y[n..2 * n].to_vec(),
            ddtheta: k[6][n..2 * n].to_vec(),
            powers: array(&k[6][2 * n..]),
            works: array(&self.y[2 * n..]),
        };
        (state, Dense::new(from, h, [start, way, bend, twist, fourth]))
    }
}

/// θ at the end of N equal steps of this method, whatever their errors, to measure its order. Only the options'
/// duration, steps, gravity and friction are used.
///
/// # Errors
/// Those of [`simulate`](crate::simulate).
pub fn dormand_prince_by_equal_steps(
    model: &Model,
    [theta, dtheta]: [&[f64]; 2],
    mut input: impl Input,
    options: &Options,
) -> Result<Vec<f64>, Error> {
    options.check()?;
    model.check_lengths(theta, [("dtheta", dtheta)])?;
    let input: &mut dyn Input = &mut input;
    let mut driven = Driven::new(Equation::new(model, input, options));
    let motion =
        Motion::start(model.configuration_space(), 0.0, theta, dtheta, |t, q, dq, ddq| driven.evaluate(t, q, dq, ddq))?;
    let mut state = State::of(&motion);
    let mut method = DormandPrince::new(model.n(), model.nq(), f64::MAX);
    for k in 1..=options.steps {
        driven.at_step(k, options.step());
        method.h = f64::INFINITY; // until the step's end
        (state, _) = method.step(&state, options.time(k), &mut driven)?;
    }
    Ok(state.theta)
}

fn squared(x: f64) -> f64 {
    x * x
}

#[cfg(feature = "std")]
fn power(x: f64, y: f64) -> f64 {
    x.powf(y)
}

#[cfg(not(feature = "std"))]
use libm::pow as power;

//! How exact each method of a simulation is, and at what cost.

use crate::error::check;
use mozzi::simulation::{Method, Options, Policy, Simulation, torque};
use mozzi::{Error, Model, difference};
use std::cell::Cell;
use std::ops::ControlFlow;

/// The reference takes so many times as many steps as the finest that is compared with it, by Runge-Kutta 4.
const FINER: usize = 4;
/// Smaller errors, in rad or m, tell nothing of a method.
const ROUNDING: f64 = 1e-13;

/// Motions by one method compared with the reference.
#[derive(Clone, Debug, PartialEq)]
pub struct Convergence {
    /// The method's.
    pub name: &'static str,
    /// The order that its error has in the length of a step.
    pub order: u32,
    /// From the coarsest to the finest; those that left the numbers, or had no solution, are left out.
    pub measured: Vec<Measured>,
}

/// One of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measured {
    /// Seconds; of [`Method::DormandPrince`] the tolerance.
    pub step: f64,
    /// How often θ̈ was computed.
    pub evaluations: usize,
    /// The largest entry of θ(t_f) ⊖ θ_reference(t_f).
    pub error: f64,
}

impl Convergence {
    /// The order that errors show: of given steps the last two, by the steps; of Dormand-Prince the last and the one in
    /// the middle, by the evaluations. None where they are rounding.
    pub fn measured_order(&self) -> Option<f64> {
        let (many, fine) = (self.measured.len(), self.measured.last()?);
        let coarse = if self.is_adaptive() { self.measured[many / 2] } else { self.measured[many.checked_sub(2)?] };
        let work = |of: &Measured| if self.is_adaptive() { of.evaluations as f64 } else { 1.0 / of.step };
        let order = (coarse.error / fine.error).ln() / (work(fine) / work(&coarse)).ln();
        Some(order).filter(|order| order.is_finite() && fine.error > ROUNDING)
    }

    /// Are its steps found by a tolerance?
    pub fn is_adaptive(&self) -> bool {
        self.name == (Method::DormandPrince { tolerance: 1.0 }).name()
    }
}

/// The error of every method at the end of a motion with motors off. Fixed-step methods begin with the given number of
/// steps, which is doubled for each further error; adaptive ones take as many tolerances, each a tenth of the one
/// before, from 10⁻³ on. The reference is Runge-Kutta 4 with a quarter of the shortest step. `progress(done, all)`
/// counts evaluations of θ̈; `all` is an estimate.
///
/// # Errors
/// [`mozzi::Error`]s as of [`Model::simulate`].
pub fn convergence(
    model: &Model,
    [theta, dtheta]: [&[f64]; 2],
    duration: f64,
    coarsest: usize,
    halvings: usize,
    mut progress: impl FnMut(usize, usize),
) -> Result<Vec<Convergence>, crate::Error> {
    check(duration > 0.0 && duration.is_finite(), "the duration", duration, "a positive, finite number of seconds")?;
    check(coarsest >= 1, "the number of steps", coarsest, "at least 1")?;
    let finest = coarsest << halvings;
    let counted = Cell::new(0_usize);
    // Runge-Kutta's four a step of the reference are most of them; the others are of some 20 a step, twice the finest's
    let all = 4 * FINER * finest + 40 * finest;
    let mut end = |method, steps| {
        let before = counted.get();
        let count = torque(|_, _, _, _| counted.set(counted.get() + 1));
        let rows =
            Options { method, record_every: steps, joint_limits: Policy::Ignore, ..Options::new(duration, steps) };
        let run = Simulation::new(rows).run_with_progress(model, theta, dtheta, count, |_| {
            progress(counted.get().min(all), all);
            ControlFlow::Continue(())
        })?;
        Ok::<_, Error>((run.motion.last().theta.to_vec(), counted.get() - before))
    };
    let (reference, _) = end(Method::RungeKutta4, FINER * finest)?;
    let of_method = |method: Method| {
        let steps = (0..=halvings).map(|halving| coarsest << halving);
        steps.map(|steps| (duration / steps as f64, method, steps)).collect::<Vec<_>>()
    };
    let tolerances = (0..=halvings).map(|k| 10_f64.powi(-3 - k as i32));
    let ways = [
        of_method(Method::Euler),
        of_method(Method::SemiImplicitEuler),
        of_method(Method::Midpoint),
        of_method(Method::RungeKutta4),
        tolerances.map(|tolerance| (tolerance, Method::DormandPrince { tolerance }, 1)).collect(),
    ];
    let mut found = Vec::new();
    for each in ways {
        let (_, method, _) = each[0];
        let mut measured = Vec::new();
        for (step, method, steps) in each {
            let (theta, evaluations) = match end(method, steps) {
                Ok(end) => end,
                // too long a step for this one: no point of the curve
                Err(Error::Diverged { .. } | Error::NoConvergence { .. } | Error::TooStiff { .. }) => continue,
                Err(other) => return Err(other.into()),
            };
            let mut apart = vec![0.0; model.n()];
            difference(model, &reference, &theta, &mut apart);
            let error = apart.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
            measured.push(Measured { step, evaluations, error });
        }
        found.push(Convergence { name: method.name(), order: method.order(), measured });
    }
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn methods_have_their_orders() {
        let model = mozzi_urdf::open("double_pendulum").and_then(mozzi_urdf::Loaded::build).expect("embedded");
        let found = convergence(&model, [&[1.0, 0.3], &[0.0; 2]], 0.5, 8, 6, |_, _| ()).expect("errors");
        assert_eq!(found.len(), 5);
        for each in &found {
            let order = each.measured_order().expect("four errors");
            // of tolerances the number of steps is rounded
            let margin = if each.is_adaptive() { 1.5 } else { 0.5 };
            assert!((order - f64::from(each.order)).abs() < margin, "{order} {each:?}");
        }
        let of = |k: usize| found[k].measured[0];
        // 8 steps: an evaluation each and one at the start; four of each
        assert_eq!((of(0).evaluations, of(3).evaluations), (9, 33));
    }
}

//! Accuracy and cost of each simulation method.

use crate::error::check;
use mozzi::Model;
use mozzi::model::difference;
use mozzi_sim::{Error, Method, Options, Policy, Simulation, dormand_prince_by_equal_steps, torque};
use std::cell::Cell;

/// The reference, by Dormand-Prince, takes this many times the steps of the finest motion that is compared with it.
const FINER: usize = 4;
/// To measure Dormand-Prince's order, the number of steps is doubled this often, from the longest step on.
const COARSER: u32 = 4;
/// Errors below this, in rad or m, are close to rounding and are not significant.
const ROUNDING: f64 = 1e-12;

/// Motions by one method compared with the reference.
#[derive(Clone, Debug, PartialEq)]
pub struct Convergence {
    /// The method's name.
    pub name: &'static str,
    /// The order that its error has in the length of a step.
    pub order: u32,
    /// From the coarsest to the finest; motions that diverged, or had no solution, are left out.
    pub measured: Vec<Measured>,
    /// Dormand-Prince only: the same by equal steps, without a tolerance, for its order.
    pub equal_steps: Vec<Measured>,
}

/// One measured motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measured {
    /// Seconds; for [`Method::DormandPrince`] the tolerance.
    pub step: f64,
    /// How often θ̈ was computed.
    pub evaluations: usize,
    /// The largest entry of θ(t_f) ⊖ θ_reference(t_f).
    pub error: f64,
}

impl Convergence {
    /// The order measured with equal steps: d ln(error)/d ln(step) of the two finest whose errors are not rounding.
    pub fn measured_order(&self) -> Option<f64> {
        let points = if self.is_adaptive() { &self.equal_steps } else { &self.measured };
        let pair = points.windows(2).rfind(|pair| pair[1].error > ROUNDING)?;
        let (coarse, fine) = (pair[0], pair[1]);
        let order = (coarse.error / fine.error).ln() / (coarse.step / fine.step).ln();
        Some(order).filter(|order| order.is_finite())
    }

    /// True if the method chooses its steps by a tolerance.
    pub fn is_adaptive(&self) -> bool {
        self.name == (Method::DormandPrince { tolerance: 1.0 }).name()
    }
}

/// The error of every method at the end of a motion with motors off. Fixed-step methods begin with the given number of
/// steps, which is doubled for each further error. Adaptive methods take the same number of tolerances, each a tenth of
/// the one before, from 10⁻³ on. The reference is Dormand-Prince with a quarter of the shortest step.
/// Dry friction is left out: the methods are those of smooth motions.
/// `progress(done, all)` counts evaluations of θ̈; `all` is an estimate.
///
/// # Errors
/// Those of [`mozzi_sim::simulate`].
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
    let mut smooth = model.described()?;
    smooth.joints.iter_mut().for_each(|joint| joint.friction = 0.0);
    let model = &smooth.build()?;
    let finest = coarsest << halvings;
    let counted = Cell::new(0_usize);
    // most are the reference's, six per step; the others take some 30 per step, for twice the finest number of steps
    let all = 6 * FINER * finest + 60 * finest;
    let mut end = |method, steps, is_equal| {
        let before = counted.get();
        let count = torque(|_, _, _, _| {
            counted.set(counted.get() + 1);
            progress(counted.get().min(all), all);
        });
        let rows =
            Options { method, record_every: steps, joint_limits: Policy::Ignore, ..Options::new(duration, steps) };
        if is_equal && matches!(method, Method::DormandPrince { .. }) {
            let end = dormand_prince_by_equal_steps(model, [theta, dtheta], count, &rows)?;
            return Ok((end, counted.get() - before));
        }
        let run = Simulation::new(rows).run(model, theta, dtheta, count)?;
        Ok::<_, Error>((run.motion.last().theta.to_vec(), counted.get() - before))
    };
    let (reference, _) = end(Method::DormandPrince { tolerance: 1.0 }, FINER * finest, true)?;
    let of_method = |method: Method| {
        let steps = (0..=halvings).map(|halving| coarsest << halving);
        steps.map(|steps| (duration / steps as f64, method, steps)).collect::<Vec<_>>()
    };
    // at the finest steps of the others its errors are rounding
    let coarse = |method: Method| {
        let mut steps = of_method(method);
        let longer = (1..=COARSER).map(|k| coarsest >> k).take_while(|&steps| steps > 0);
        longer.for_each(|count| steps.insert(0, (duration / count as f64, method, count)));
        steps
    };
    let tolerances = (0..=halvings).map(|k| 10_f64.powi(-3 - k as i32));
    let ways = [
        of_method(Method::Euler),
        of_method(Method::SemiImplicitEuler),
        of_method(Method::Midpoint),
        of_method(Method::RungeKutta4),
        tolerances.map(|tolerance| (tolerance, Method::DormandPrince { tolerance }, 1)).collect(),
    ];
    let mut measure = |each: Vec<(f64, Method, usize)>, is_equal| {
        let mut measured = Vec::new();
        for (step, method, steps) in each {
            let (theta, evaluations) = match end(method, steps, is_equal) {
                Ok(end) => end,
                // too long a step for this method: this point is left out
                Err(Error::Diverged { .. } | Error::NoConvergence { .. } | Error::Stalled { .. }) => continue,
                Err(other) => return Err(other),
            };
            let mut apart = vec![0.0; model.n()];
            difference(model, &reference, &theta, &mut apart);
            let error = apart.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
            measured.push(Measured { step, evaluations, error });
        }
        Ok::<_, Error>(measured)
    };
    let mut found = Vec::new();
    for each in ways {
        let (_, method, _) = each[0];
        let measured = measure(each, !method.is_adaptive())?;
        let equal_steps = if method.is_adaptive() { measure(coarse(method), true)? } else { Vec::new() };
        found.push(Convergence { name: method.name(), order: method.order(), measured, equal_steps });
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
            let order = each.measured_order().expect("errors");
            assert!((order - f64::from(each.order)).abs() < 0.4, "{order} {each:?}");
        }
        let of = |k: usize| found[k].measured[0];
        // 8 steps: an evaluation each and one at the start; four of each
        assert_eq!((of(0).evaluations, of(3).evaluations), (9, 33));
        // Dormand-Prince: six per step, the last of which is the next step's first
        assert_eq!(found[4].equal_steps[3].evaluations, 6 * 8 + 1);
    }

    #[test]
    fn the_order_does_not_depend_on_the_motion() {
        for (name, theta, step) in [("double_pendulum", [0.2, -1.0], 50), ("furuta_pendulum", [0.3, 0.5], 50)] {
            let model = mozzi_urdf::open(name).and_then(mozzi_urdf::Loaded::build).expect("embedded");
            let found = convergence(&model, [&theta, &[0.0; 2]], 1.0, step, 5, |_, _| ()).expect("errors");
            let order = found[4].measured_order().expect("errors");
            assert!((order - 5.0).abs() < 0.4, "{name}: {order} {:?}", found[4].equal_steps);
        }
    }
}

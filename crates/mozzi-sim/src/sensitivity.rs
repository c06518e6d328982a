//! How the end of a simulation changes with its start, its torques and the robot: exact derivatives of the discrete
//! map, by dual numbers (forward mode).

use crate::Error;
use crate::closing::{Closer, Corrections};
use crate::options::check;
use crate::{Explicit, Motion, Options};
use alloc::format;
use alloc::vec;
use alloc::vec::Vec;
use mozzi::ConstraintMemory;
use mozzi::Workspace;
use mozzi::constraints::constrained_forward_dynamics;
use mozzi::dynamics::forward_dynamics;
use mozzi::dynamics::mass_matrix;
use mozzi::model::{Environment, Model, Pivots, Variation};
use mozzi::model::{difference, seed_direction};
use mozzi::scalar::{Dual, Real, Scalar};
use nalgebra::{DMatrix, DVector};

/// One step x\[k+1\] = Φ(x\[k\], τ\[k\]) with x = (θ, θ̇) and τ held, and its derivatives. A change of θ is given by n
/// numbers, along θ ⊕ δθ (see [`integrate`](mozzi::model::integrate)); for a floating base they are a twist (ω, v)
/// in its own coordinates, at either end of the step.
#[derive(Clone, Debug)]
pub struct StepSensitivity {
    /// θ\[k+1\].
    pub theta: Vec<f64>,
    /// θ̇\[k+1\].
    pub dtheta: Vec<f64>,
    /// ∂x\[k+1\]/∂x\[k\], 2n × 2n.
    pub A: DMatrix<f64>,
    /// ∂x\[k+1\]/∂τ\[k\], 2n × n.
    pub B: DMatrix<f64>,
    /// ∂x\[k+1\]/∂p at the same x\[k\], 2n × the number of changes of the robot.
    pub P: DMatrix<f64>,
}

/// The derivatives of the last state of a trajectory.
#[derive(Clone, Debug)]
pub struct EndSensitivity {
    /// ∂x\[N\]/∂x\[0\] = A\[N−1\] … A\[0\], 2n × 2n.
    pub start: DMatrix<f64>,
    /// ∂x\[N\]/∂τ\[k\] = A\[N−1\] … A\[k+1\] B\[k\] of each step k, 2n × n.
    pub tau: Vec<DMatrix<f64>>,
    /// ∂x\[N\]/∂p = Σ A\[N−1\] … A\[k+1\] P\[k\], 2n × the number of changes of the robot.
    pub parameters: DMatrix<f64>,
}

impl EndSensitivity {
    /// Applies the chain rule along the steps, from the last to the first. `None` if there are no steps.
    ///
    /// # Panics
    /// When the steps are of different robots.
    pub fn of(steps: &[StepSensitivity]) -> Option<Self> {
        let last = steps.last()?;
        let mut after = DMatrix::identity(last.A.nrows(), last.A.nrows()); // ∂x[N]/∂x[k+1]
        let (mut tau, mut parameters) = (Vec::new(), DMatrix::zeros(last.P.nrows(), last.P.ncols()));
        for StepSensitivity { A, B, P, .. } in steps.iter().rev() {
            tau.push(&after * B);
            parameters += &after * P;
            after *= A;
        }
        tau.reverse();
        Some(EndSensitivity { start: after, tau, parameters })
    }
}

/// One step of δt = t_f / N from (θ, θ̇), τ held: the state (θ, θ̇) after it. The method, friction and gravity are
/// those of the options, {s} is at rest, no wrenches are applied. The Euler methods' steps are those of
/// [`simulate`](crate::simulate). A robot with constraints is brought back onto them after the step.
///
/// # Errors
/// [`Error::Model`] for slices of a wrong length, invalid options, a method that is not
/// [explicit](crate::Method::explicit), or a singular mass matrix; [`Error::OpenStart`], [`Error::Opened`],
/// [`Error::Jumped`].
pub fn held_step(
    model: &Model,
    theta: &[f64],
    dtheta: &[f64],
    tau: &[f64],
    options: &Options,
) -> Result<(Vec<f64>, Vec<f64>), Error> {
    let (end, _) = held(model, theta, dtheta, tau, options)?;
    Ok((end.theta, end.dtheta))
}

/// The state after a held step, and how it was brought back onto the constraints.
fn held(
    model: &Model,
    theta: &[f64],
    dtheta: &[f64],
    tau: &[f64],
    options: &Options,
) -> Result<(Motion, Option<Corrections>), Error> {
    model.check_lengths(theta, [("dtheta", dtheta), ("tau", tau)])?;
    options.check()?;
    let mut closer = Closer::new(model);
    if let Some(closer) = &mut closer {
        closer.check_start(model, theta, dtheta)?;
    }
    let fine = |theta: &[f64], workspace: &mut Workspace| {
        Pivots::new(workspace.pivots()).check(model, theta, || {
            let mut M = vec![0.0; model.n() * model.n()];
            mass_matrix(model, theta, &mut Workspace::new(model), &mut M);
            M
        })
    };
    let way = (options.method.explicit()?, options);
    let mut end = step(model, theta, dtheta, tau, way, &mut Workspace::new(model), fine)?;
    if let Some(closer) = &mut closer {
        closer.close(model, options.step(), &mut end.theta, &mut end.dtheta)?;
    }
    Ok((end, closer.map(|closer| closer.corrections)))
}

/// [`held_step`] with its derivatives with respect to the start, the torque, and each of these
/// changes of the robot: exact to rounding for the step as it is taken, whatever its size. At θ̇ = 0 Coulomb
/// friction has the derivative 0.
///
/// Cost: 3n steps on dual numbers, and one for each change.
///
/// # Errors
/// Those of [`held_step`] and of [`Model::with_parameter_tangent`].
pub fn step_sensitivity(
    model: &Model,
    theta: &[f64],
    dtheta: &[f64],
    tau: &[f64],
    options: &Options,
    changes: &[Variation],
) -> Result<StepSensitivity, Error> {
    let (end, corrections) = held(model, theta, dtheta, tau, options)?;
    let way = (options.method.explicit()?, options, corrections);
    let (n, mut workspace) = (model.n(), Workspace::<Dual>::new(model));
    let zero = vec![0.0; n];
    let unit = |j: usize| {
        let mut e = zero.clone();
        e[j] = 1.0;
        e
    };
    let still = model.map(Dual::constant);
    let mut along = |of: [&[f64]; 3]| {
        let (theta, dtheta, tau) =
            (seed_direction(model, theta, of[0]), Dual::list(dtheta, of[1]), Dual::list(tau, of[2]));
        column(&still, &theta, &dtheta, &tau, way, &mut workspace)
    };
    let columns = |of: &mut dyn FnMut(&[f64]) -> DVector<f64>| -> Vec<_> { (0..n).map(|j| of(&unit(j))).collect() };
    let d_theta = columns(&mut |e| along([e, &zero, &zero]));
    let d_dtheta = columns(&mut |e| along([&zero, e, &zero]));
    let d_tau = columns(&mut |e| along([&zero, &zero, e]));
    let (theta, dtheta, tau) = (Dual::constants(theta), Dual::constants(dtheta), Dual::constants(tau));
    let mut P = DMatrix::zeros(2 * n, changes.len());
    for (k, &change) in changes.iter().enumerate() {
        let with_parameter_tangent = model.with_parameter_tangent(&[change])?;
        P.set_column(k, &column(&with_parameter_tangent, &theta, &dtheta, &tau, way, &mut workspace));
    }
    let matrix = |columns: &[DVector<f64>]| DMatrix::from_fn(2 * n, columns.len(), |i, j| columns[j][i]);
    let A = matrix(&[d_theta, d_dtheta].concat());
    Ok(StepSensitivity { theta: end.theta, dtheta: end.dtheta, A, B: matrix(&d_tau), P })
}

/// [`step_sensitivity`] along a trajectory of N steps, τ\[k\] held during step k: each step
/// starts where the one before it ended. For the derivatives of the end see [`EndSensitivity::of`].
///
/// # Errors
/// Those of [`step_sensitivity`]; [`mozzi::Error::BadArgument`] unless there are N torques.
pub fn sensitivities<T: AsRef<[f64]>>(
    model: &Model,
    theta: &[f64],
    dtheta: &[f64],
    tau: &[T],
    options: &Options,
    changes: &[Variation],
) -> Result<Vec<StepSensitivity>, Error> {
    check(tau.len() == options.steps, "the list of torques", format!("{} long", tau.len()), "one for each step")?;
    let (mut theta, mut dtheta, mut steps) = (theta.to_vec(), dtheta.to_vec(), Vec::with_capacity(tau.len()));
    for tau in tau {
        let step = step_sensitivity(model, &theta, &dtheta, tau.as_ref(), options, changes)?;
        (theta, dtheta) = (step.theta.clone(), step.dtheta.clone());
        steps.push(step);
    }
    Ok(steps)
}

/// The derivative of (θ, θ̇) after a step of dual numbers. Constants are dual numbers, too: one copy of the kernels.
fn column(
    model: &Model<Dual>,
    theta: &[Dual],
    dtheta: &[Dual],
    tau: &[Dual],
    (method, options, corrections): (Explicit, &Options, Option<Corrections>),
    workspace: &mut Workspace<Dual>,
) -> DVector<f64> {
    let way = (method, options);
    let end = step(model, theta, dtheta, tau, way, workspace, |_, _| Ok::<_, core::convert::Infallible>(()));
    let Ok(mut end) = end;
    if let Some(corrections) = corrections {
        let memory = &mut ConstraintMemory::new(model);
        corrections.repeat(model, &mut end.theta, &mut end.dtheta, workspace, memory);
    }
    let still: Vec<f64> = end.theta.iter().map(|x| x.value).collect();
    let mut way = vec![Dual::zero(); model.n()];
    difference(model, &Dual::constants(&still), &end.theta, &mut way);
    DVector::from_iterator(2 * model.n(), way.iter().chain(&end.dtheta).map(|x| x.derivative))
}

/// Φ: one step of any number type, τ held. `check` is called after each forward dynamics.
fn step<S: Real + From<C>, C: Scalar, E>(
    model: &Model<C>,
    theta: &[S],
    dtheta: &[S],
    tau: &[S],
    (method, options): (Explicit, &Options),
    workspace: &mut Workspace<S>,
    mut check: impl FnMut(&[S], &mut Workspace<S>) -> Result<(), E>,
) -> Result<Motion<S>, E> {
    let gravity = options.gravity.map_or(model.gravity().map(S::from), |g| g.map(S::from_f64));
    let environment = Environment::with_gravity(gravity);
    let mut force = tau.to_vec();
    let m = model.constraint_rows();
    let (mut memory, mut lambda) = ((m > 0).then(|| ConstraintMemory::new(model)), vec![S::zero(); m]);
    let mut F = |_: f64, theta: &[S], dtheta: &[S], ddtheta: &mut [S]| {
        options.friction.force(model, tau, dtheta, &mut force);
        match &mut memory {
            None => forward_dynamics(model, theta, dtheta, &force, &environment, workspace, ddtheta),
            Some(memory) => {
                let (environment, lambda) = (&environment, &mut lambda);
                let dynamics = constrained_forward_dynamics;
                dynamics(model, theta, dtheta, &force, environment, workspace, memory, ddtheta, lambda);
            }
        }
        check(theta, workspace)?;
        Ok([])
    };
    let h = options.step();
    let mut motion = Motion::start(model.configuration_space(), 0.0, theta, dtheta, &mut F)?;
    motion.step(method, h, h, &mut F)?;
    Ok(motion)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simulate;
    use crate::{Friction, Method, torque};
    use mozzi::model::integrate;
    use mozzi::testing::{Random, floating_tree, mixed_tree, state, tree};

    const METHODS: [Method; 3] = [Method::Euler, Method::SemiImplicitEuler, Method::RungeKutta4];

    fn models() -> [Model; 4] {
        [tree(3, 5, 0), tree(5, 6, 2), floating_tree(2, 4, 0), mixed_tree(4, 4, 0)]
    }

    fn options(method: Method, steps: usize) -> Options {
        Options { method, friction: Friction::Smooth { slip_speed: 0.5 }, ..Options::new(0.01 * steps as f64, steps) }
    }

    /// x after the steps minus x₀, in the tangent space at x₀.
    fn end(
        model: &Model,
        x: (&[f64], &[f64]),
        tau: &[Vec<f64>],
        options: &Options,
        from: (&[f64], &[f64]),
    ) -> DVector<f64> {
        let (mut theta, mut dtheta) = (x.0.to_vec(), x.1.to_vec());
        for tau in tau {
            (theta, dtheta) = held_step(model, &theta, &dtheta, tau, options).expect("regular");
        }
        let mut way = vec![0.0; model.n()];
        difference(model, from.0, &theta, &mut way);
        DVector::from_iterator(2 * model.n(), way.into_iter().chain(dtheta.iter().zip(from.1).map(|(a, b)| a - b)))
    }

    #[test]
    fn derivatives_of_a_trajectory_equal_differences() {
        let (steps, h) = (4, 1e-5);
        for model in models() {
            for method in METHODS {
                let (n, options) = (model.n(), options(method, steps));
                let [theta, dtheta, _] = state(&model, 3);
                let dtheta: Vec<f64> = dtheta.iter().map(|x| 0.3 * x).collect();
                let mut random = Random(1);
                let tau: Vec<_> = (0..steps).map(|_| random.vector(n, 1.0)).collect();
                let change = Variation::Mass { link: "link2" };
                let parts = sensitivities(&model, &theta, &dtheta, &tau, &options, &[change]).expect("regular");
                let whole = EndSensitivity::of(&parts).expect("steps");
                let last = parts.last().expect("steps");
                let last = (&*last.theta, &*last.dtheta);
                let close = |found: DVector<f64>, plus: DVector<f64>, minus: DVector<f64>, what: &str| {
                    let difference = (plus - minus) / (2.0 * h);
                    let error = (&found - &difference).amax() / difference.amax().max(1.0);
                    assert!(error < 1e-6, "{}, {what}: {error:e}", method.name());
                };
                for j in 0..n {
                    let mut e = vec![0.0; n];
                    e[j] = 1.0;
                    let d_theta = |h: f64| {
                        let mut moved = theta.clone();
                        integrate(&model, &mut moved, &e, h);
                        end(&model, (&moved, &dtheta), &tau, &options, last)
                    };
                    close(whole.start.column(j).into(), d_theta(h), d_theta(-h), "by theta");
                    let d_dtheta = |h: f64| {
                        let mut moved = dtheta.clone();
                        moved[j] += h;
                        end(&model, (&theta, &moved), &tau, &options, last)
                    };
                    close(whole.start.column(n + j).into(), d_dtheta(h), d_dtheta(-h), "by dtheta");
                    let d_tau = |h: f64| {
                        let mut moved = tau.clone();
                        moved[1][j] += h;
                        end(&model, (&theta, &dtheta), &moved, &options, last)
                    };
                    close(whole.tau[1].column(j).into(), d_tau(h), d_tau(-h), "by tau");
                }
                let by_mass = |h: f64| {
                    let mut robot = model.description().clone();
                    let link = robot.links.iter_mut().find(|link| link.name == "link2").expect("a link");
                    let (G, c) = (link.inertia, link.inertia.center_of_mass());
                    link.inertia = mozzi::SpatialInertia::new(G.mass + h, c, G.about_center_of_mass());
                    end(&robot.build().expect("sound"), (&theta, &dtheta), &tau, &options, last)
                };
                close(whole.parameters.column(0).into(), by_mass(h), by_mass(-h), "by a mass");
            }
        }
    }

    #[test]
    fn the_product_of_the_steps_is_the_derivative_of_the_whole_map() {
        for model in models() {
            for method in METHODS {
                let options = options(method, 5);
                let way = (method.explicit().expect("explicit"), &options, None);
                let [theta, dtheta, _] = state(&model, 4);
                let tau = vec![vec![0.7; model.n()]; 5];
                let parts = sensitivities(&model, &theta, &dtheta, &tau, &options, &[]).expect("regular");
                let whole = EndSensitivity::of(&parts).expect("steps").start;
                // all steps in one run of dual numbers, along one direction
                let along = Random(9).vector(2 * model.n(), 1.0);
                let (along_theta, along_dtheta) = along.split_at(model.n());
                let (mut q, mut dq) = (seed_direction(&model, &theta, along_theta), Dual::list(&dtheta, along_dtheta));
                let (tau, mut workspace) = (Dual::constants(&tau[0]), Workspace::<Dual>::new(&model));
                for _ in 1..5 {
                    let fine = |_: &[Dual], _: &mut _| Ok::<_, Error>(());
                    let next = step(&model, &q, &dq, &tau, (way.0, way.1), &mut workspace, fine).expect("fine");
                    (q, dq) = (next.theta, next.dtheta);
                }
                let found = column(&model.map(Dual::constant), &q, &dq, &tau, way, &mut workspace);
                let expected = whole * DVector::from_vec(along);
                let error = (&found - &expected).amax() / expected.amax();
                assert!(error < 1e-12, "{}: {error:e}", method.name());
            }
        }
    }

    #[test]
    fn steps_are_those_of_a_simulation() {
        for model in models() {
            let [theta, dtheta, _] = state(&model, 3);
            let tau: Vec<f64> = (0..model.n()).map(|j| j as f64 - 1.0).collect();
            for method in METHODS {
                let options = options(method, 3);
                let held = torque(|_, _, _, out: &mut [f64]| out.copy_from_slice(&tau));
                let motion = simulate(&model, &theta, &dtheta, held, &options).expect("a motion");
                let steps = sensitivities(&model, &theta, &dtheta, &[&tau; 3], &options, &[]).expect("regular");
                for (k, step) in steps.iter().enumerate() {
                    let sample = motion.sample(k + 1);
                    let error = step.theta.iter().chain(&step.dtheta).zip(sample.theta.iter().chain(sample.dtheta));
                    assert!(error.fold(0.0_f64, |m, (a, b)| m.max((a - b).abs())) < 1e-12);
                }
            }
            let few = sensitivities(&model, &theta, &dtheta, &[&tau; 2], &options(Method::Euler, 3), &[]);
            assert!(few.expect_err("too few").to_string().contains("one for each step"));
        }
    }
}

//! Integration of a state: explicit Euler (Modern Robotics, section 8.5), semi-implicit Euler, Runge-Kutta.

use crate::Explicit;
use alloc::vec;
use alloc::vec::Vec;
use mozzi::model::ConfigurationSpace;
use mozzi::scalar::{Real, Scalar};

/// A state with its rates, and with the integrals of K further rates (such as work, the integral of power). Or the
/// states of many robots of one model.
#[derive(Clone, Debug)]
pub struct Motion<S = f64, const K: usize = 0> {
    space: ConfigurationSpace,
    robots: usize,
    /// Time in seconds.
    pub t: f64,
    /// θ, nq positions.
    pub theta: Vec<S>,
    /// θ̇, n velocities.
    pub dtheta: Vec<S>,
    /// θ̈ = F(t, θ, θ̇).
    pub ddtheta: Vec<S>,
    /// Further rates that are integrated: ẇ.
    pub rates: [S; K],
    /// w = ∫ ẇ dt, by the same method.
    pub integrals: [S; K],
    stage: Stage<S>,
}

/// Memory of Runge-Kutta's stages.
#[derive(Clone, Debug)]
struct Stage<S> {
    theta: Vec<S>,
    dtheta: Vec<S>,
    ddtheta: Vec<S>,
    /// The velocities that led to this stage.
    u: Vec<S>,
    /// Weighted sums over the stages.
    mean_dtheta: Vec<S>,
    mean_ddtheta: Vec<S>,
}

/// θ ← θ ⊕ θ̇h of each robot.
fn advance_each<S: Real>(space: &ConfigurationSpace, robots: usize, theta: &mut [S], dtheta: &[S], h: S) {
    let (nq, n) = (theta.len() / robots.max(1), dtheta.len() / robots.max(1));
    if space.is_flat() {
        add(theta, dtheta, h); // number by number
    } else {
        for (theta, dtheta) in theta.chunks_exact_mut(nq).zip(dtheta.chunks_exact(n)) {
            space.advance(theta, dtheta, h);
        }
    }
}

/// x ← x + kh.
fn add<S: Scalar>(x: &mut [S], k: &[S], h: S) {
    for (x, &k) in x.iter_mut().zip(k) {
        *x += k * h;
    }
}

impl<S: Real, const K: usize> Motion<S, K> {
    /// A motion at time t, of a robot with this configuration space, with rates from F: `F(t, θ, θ̇, θ̈)` writes the
    /// accelerations and returns the further rates.
    ///
    /// # Errors
    /// Those of F.
    pub fn start<E>(
        space: &ConfigurationSpace,
        t: f64,
        theta: &[S],
        dtheta: &[S],
        F: impl FnMut(f64, &[S], &[S], &mut [S]) -> Result<[S; K], E>,
    ) -> Result<Self, E> {
        Self::start_many(space, 1, t, theta, dtheta, F)
    }

    /// As [`start`](Self::start), for this many robots: θ has the positions of one after the other, θ̇ their
    /// velocities, and F is called once for all of them.
    ///
    /// # Errors
    /// Those of F.
    pub fn start_many<E>(
        space: &ConfigurationSpace,
        robots: usize,
        t: f64,
        theta: &[S],
        dtheta: &[S],
        mut F: impl FnMut(f64, &[S], &[S], &mut [S]) -> Result<[S; K], E>,
    ) -> Result<Self, E> {
        let zeros = vec![S::zero(); dtheta.len()];
        let mut ddtheta = zeros.clone();
        let rates = F(t, theta, dtheta, &mut ddtheta)?;
        Ok(Motion {
            space: space.clone(),
            robots,
            t,
            theta: theta.to_vec(),
            dtheta: dtheta.to_vec(),
            ddtheta,
            rates,
            integrals: [S::zero(); K],
            stage: Stage {
                theta: theta.to_vec(),
                dtheta: zeros.clone(),
                ddtheta: zeros.clone(),
                u: zeros.clone(),
                mean_dtheta: zeros.clone(),
                mean_ddtheta: zeros,
            },
        })
    }

    /// One step of size h to the time `t_next` (t + h up to rounding), and the rates there. F is called at the stages
    /// in between (Runge-Kutta: three) and at the end; no allocation.
    ///
    /// # Errors
    /// Those of F; the motion is then left between two states.
    pub fn step<E>(
        &mut self,
        method: Explicit,
        h: f64,
        t_next: f64,
        mut F: impl FnMut(f64, &[S], &[S], &mut [S]) -> Result<[S; K], E>,
    ) -> Result<(), E> {
        self.advance(method, h, t_next, &mut F)?;
        self.find_rates(F)
    }

    /// The rates of this state, such as after [`advance`](Self::advance) or a change of it.
    ///
    /// # Errors
    /// Those of F.
    pub fn find_rates<E>(
        &mut self,
        mut F: impl FnMut(f64, &[S], &[S], &mut [S]) -> Result<[S; K], E>,
    ) -> Result<(), E> {
        self.rates = F(self.t, &self.theta, &self.dtheta, &mut self.ddtheta)?;
        Ok(())
    }

    /// [`step`](Self::step) without the rates at its end, which are then those of its start.
    ///
    /// # Errors
    /// Those of F; the motion is then left between two states.
    pub fn advance<E>(
        &mut self,
        method: Explicit,
        h: f64,
        t_next: f64,
        mut F: impl FnMut(f64, &[S], &[S], &mut [S]) -> Result<[S; K], E>,
    ) -> Result<(), E> {
        let dt = S::from_f64(h);
        match method {
            Explicit::Euler => {
                advance_each(&self.space, self.robots, &mut self.theta, &self.dtheta, dt);
                add(&mut self.dtheta, &self.ddtheta, dt);
                add(&mut self.integrals, &self.rates, dt);
            }
            Explicit::SemiImplicitEuler => {
                add(&mut self.dtheta, &self.ddtheta, dt);
                advance_each(&self.space, self.robots, &mut self.theta, &self.dtheta, dt);
                add(&mut self.integrals, &self.rates, dt);
            }
            Explicit::RungeKutta4 => self.runge_kutta_4(h, t_next, &mut F)?,
        }
        self.t = t_next;
        Ok(())
    }

    /// x ⊕ h/6 (k₁ + 2k₂ + 2k₃ + k₄) with x = (θ, θ̇, w) and k = (θ̇, θ̈, ẇ); k₁ is known, each further stage starts
    /// from x again, along the k before it. For a ball and a floating base, k is the rate of log(T₀⁻¹T) (Munthe-Kaas).
    fn runge_kutta_4<E>(
        &mut self,
        h: f64,
        t_next: f64,
        F: &mut impl FnMut(f64, &[S], &[S], &mut [S]) -> Result<[S; K], E>,
    ) -> Result<(), E> {
        let Stage { theta, dtheta, ddtheta, u, mean_dtheta, mean_ddtheta } = &mut self.stage;
        let sixth = S::from_f64(1.0 / 6.0);
        dtheta.copy_from_slice(&self.dtheta);
        ddtheta.copy_from_slice(&self.ddtheta);
        mean_dtheta.fill(S::zero());
        mean_ddtheta.fill(S::zero());
        let mut mean_rates = [S::zero(); K];
        add(mean_dtheta, dtheta, sixth);
        add(mean_ddtheta, ddtheta, sixth);
        add(&mut mean_rates, &self.rates, sixth);

        let (half, third) = (0.5 * h, S::from_f64(1.0 / 3.0));
        let stages = [(half, self.t + half, third), (half, self.t + half, third), (h, t_next, sixth)];
        for (along, t, weight) in stages {
            let along = S::from_f64(along);
            theta.copy_from_slice(&self.theta);
            advance_each(&self.space, self.robots, theta, dtheta, along); // with the velocity of the stage before
            u.copy_from_slice(dtheta);
            dtheta.copy_from_slice(&self.dtheta);
            add(dtheta, ddtheta, along);
            let rates = F(t, theta, dtheta, ddtheta)?;
            if !self.space.is_flat() {
                let n = dtheta.len() / self.robots;
                u.iter_mut().for_each(|u| *u = *u * along);
                for (V, u) in dtheta.chunks_exact_mut(n).zip(u.chunks_exact(n)) {
                    self.space.rate(u, V);
                }
            }
            add(mean_dtheta, dtheta, weight);
            add(mean_ddtheta, ddtheta, weight);
            add(&mut mean_rates, &rates, weight);
        }
        let dt = S::from_f64(h);
        advance_each(&self.space, self.robots, &mut self.theta, mean_dtheta, dt);
        add(&mut self.dtheta, mean_ddtheta, dt);
        add(&mut self.integrals, &mean_rates, dt);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simulate;
    use crate::tests::robots::{difference, smooth_tree};
    use crate::{Method, Options, torque};
    use core::convert::Infallible;
    use mozzi::Workspace;
    use mozzi::dynamics::forward_dynamics;
    use mozzi::model::Model;
    use mozzi::{Dual, fast, testing};

    /// A smooth motor torque of t, θ and θ̇.
    fn motors(t: f64, theta: &[f64], dtheta: &[f64], tau: &mut [f64]) {
        for j in 0..tau.len() {
            let (sin, _) = (3.0 * t + j as f64).sin_cos();
            tau[j] = sin * 2.0 - 0.5 * theta[j] - 0.2 * dtheta[j];
        }
    }

    fn end(model: &Model, method: Method, steps: usize) -> Vec<f64> {
        let [theta, dtheta, _] = testing::state(model, 5);
        let options = Options { method, record_every: steps, ..Options::new(0.2, steps) };
        let motion = simulate(model, &theta, &dtheta, torque(motors), &options).expect("a motion");
        assert_eq!(motion.len(), 2);
        [motion.last().theta, motion.last().dtheta].concat()
    }

    #[test]
    fn errors_fall_with_the_order_of_the_method() {
        for (seed, mimics) in [(1, 0), (2, 2)] {
            let model = smooth_tree(seed, 7, mimics);
            let reference = end(&model, Method::RungeKutta4, 8000);
            for (method, steps) in [(Method::Euler, 2000), (Method::SemiImplicitEuler, 2000), (Method::RungeKutta4, 50)]
            {
                let error = |refine: usize| difference(&end(&model, method, refine * steps), &reference);
                let (coarse, half, quarter) = (error(1), error(2), error(4));
                for ratio in [coarse / half, half / quarter] {
                    let expected = 2_u32.pow(method.order()) as f64;
                    assert!(
                        ratio > 0.85 * expected && ratio < 1.2 * expected,
                        "{}, tree {seed}: errors {coarse:e}, {half:e}, {quarter:e}",
                        method.name()
                    );
                }
            }
        }
    }

    #[test]
    fn euler_is_the_books_loop() {
        let model = smooth_tree(3, 6, 0);
        let [mut theta, mut dtheta, _] = testing::state(&model, 5);
        let (t_f, N) = (0.3, 77);
        let options = Options { method: Method::Euler, ..Options::new(t_f, N) };
        let motion = simulate(&model, &theta, &dtheta, torque(motors), &options).expect("a motion");
        let dt = t_f / N as f64;
        let mut workspace = fast::Workspace::new(&model);
        for k in 0..=N {
            let (mut tau, mut ddtheta) = (vec![0.0; model.n()], vec![0.0; model.n()]);
            motors(if k == N { t_f } else { k as f64 * dt }, &theta, &dtheta, &mut tau);
            let environment = model.environment();
            let (query, state) =
                (mozzi::quantities::Query::from(mozzi::quantities::ForwardDynamics), [&theta[..], &dtheta, &tau]);
            fast::evaluate(&query, &model, &state, &environment, &mut workspace, &mut [&mut ddtheta]);
            let sample = motion.sample(k);
            assert_eq!((sample.theta, sample.dtheta), (theta.as_slice(), dtheta.as_slice()), "step {k}");
            assert_eq!((sample.ddtheta, sample.tau), (ddtheta.as_slice(), tau.as_slice()), "step {k}");
            for j in 0..model.n() {
                theta[j] += dtheta[j] * dt;
                dtheta[j] += ddtheta[j] * dt;
            }
        }
    }

    #[test]
    fn one_dimension_by_hand() {
        // ẍ = −x + t from (1, 0): one step of h = ½, by hand
        let step = |method| {
            let mut F = |t: f64, x: &[f64], _: &[f64], a: &mut [f64]| {
                a[0] = t - x[0];
                Ok::<_, Infallible>([x[0]])
            };
            let mut motion =
                Motion::start(&ConfigurationSpace::of_numbers(1), 0.0, &[1.0], &[0.0], &mut F).expect("infallible");
            motion.step(method, 0.5, 0.5, &mut F).expect("infallible");
            [motion.theta[0], motion.dtheta[0], motion.ddtheta[0], motion.integrals[0]]
        };
        assert_eq!(step(Explicit::Euler), [1.0, -0.5, -0.5, 0.5]);
        assert_eq!(step(Explicit::SemiImplicitEuler), [0.75, -0.5, -0.25, 0.5]);
        // stages (x, v, a): (1, 0, −1), (1, −¼, −¾), (15/16, −3/16, −11/16), (29/32, −11/32, −13/32)
        let x = 1.0 + 0.5 / 6.0 * (-2.0 / 4.0 - 2.0 * 3.0 / 16.0 - 11.0 / 32.0);
        let v = 0.5 / 6.0 * (-1.0 - 2.0 * 3.0 / 4.0 - 2.0 * 11.0 / 16.0 - 13.0 / 32.0);
        let w = 0.5 / 6.0 * (1.0 + 2.0 + 2.0 * 15.0 / 16.0 + 29.0 / 32.0);
        assert!(difference(&step(Explicit::RungeKutta4), &[x, v, 0.5 - x, w]) < 1e-15);
    }

    /// One Runge-Kutta step on any number type, with τ = u in every joint.
    fn one_step<S: Real + From<f64> + 'static>(model: &Model, theta: &[S], dtheta: &[S], u: S) -> Vec<S> {
        let (tau, mut workspace) = (vec![u; model.n()], Workspace::new(model));
        let mut F = |_: f64, q: &[S], dq: &[S], ddq: &mut [S]| {
            forward_dynamics(model, q, dq, &tau, &model.environment(), &mut workspace, ddq);
            Ok::<_, Infallible>([])
        };
        let mut motion = Motion::start(model.configuration_space(), 0.0, theta, dtheta, &mut F).expect("infallible");
        motion.step(Explicit::RungeKutta4, 0.01, 0.01, &mut F).expect("infallible");
        [motion.theta, motion.dtheta].concat()
    }

    #[test]
    fn duals_run_through_a_step() {
        let model = smooth_tree(4, 5, 1);
        let [theta, dtheta, direction] = testing::state(&model, 6);
        let dual = |x: &[f64]| -> Vec<Dual> {
            x.iter().zip(&direction).map(|(&value, &derivative)| Dual { value, derivative }).collect()
        };
        let u = Dual { value: 0.7, derivative: 1.0 };
        let exact: Vec<f64> = one_step(&model, &dual(&theta), &dual(&dtheta), u).iter().map(|x| x.derivative).collect();
        let moved = |e: f64| {
            let along = |x: &[f64]| -> Vec<f64> { x.iter().zip(&direction).map(|(x, d)| x + e * d).collect() };
            one_step(&model, &along(&theta), &along(&dtheta), 0.7 + e)
        };
        let e = 1e-6;
        let differences: Vec<f64> = moved(e).iter().zip(moved(-e)).map(|(a, b)| (a - b) / (2.0 * e)).collect();
        assert!(difference(&exact, &differences) < 1e-6, "{exact:?}\n{differences:?}");
    }
}

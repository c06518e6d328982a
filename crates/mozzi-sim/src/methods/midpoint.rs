//! The implicit midpoint rule in (θ, p = Mθ̇).
//!
//! > θ_m = θ[k] ⊕ ½hv,  M(θ_m)v = p[k] + ½h ṗ(θ_m, v),  θ[k+1] = θ[k] ⊕ hv,  p[k+1] = p[k] + hṗ
//!
//! ṗ = Cᵀθ̇ − g + τ − f − JᵀF is Mθ̈ + Ṁθ̇ of forward dynamics. The rule is symplectic in (θ, p), so that the energy's
//! error stays bounded; in (θ, θ̇) it would not be, because M depends on θ. v is found by iteration, in which viscous
//! friction d is implicit, (M + ½hd)v' = p + ½h(ṗ + dv): light joints with much friction, hd > M, would else diverge.
//!
//! On SE(3), and on SO(3) of a ball, with p_b the rows of p there and F those of ṗ less `[ad_v]`ᵀp_b, the rule is the
//! variational integrator of the Lagrangian at the midpoint (Bou-Rabee and Marsden 2009), which keeps momentum exactly:
//!
//! > P = p_b[k] + h`[Ad_e^{−½hv}]`ᵀF,  p_b(θ_m, v) = Σ (`[ad_hv]`ᵀ)ʲP/(j+1)! − ½h Σ (−½`[ad_hv]`ᵀ)ʲF/(j+1)!,
//! > p_b[k+1] = `[Ad_e^{hv}]`ᵀP

use crate::Error;
use crate::Input;
use crate::driven::Driven;
use crate::rollout::series;
use crate::stall::velocity;
use crate::state::State;
use alloc::vec;
use alloc::vec::Vec;
use mozzi::Workspace;
use mozzi::dynamics::{mass_matrix, mass_matrix_rate};
use mozzi::lie::SE3;
use mozzi::model::integrate;
use mozzi::model::{Freedom, Model, Place};
use mozzi::scalar::{Real, Scalar};
use mozzi::spatial::{Twist, Wrench};
use nalgebra::{DMatrix, DVector};

/// v is found by iteration, to rounding; more than this many means that the step is too long.
const ITERATIONS: usize = 60;
/// Velocities this many times the first guess, plus 1, mean that the iteration diverges.
const AWAY: f64 = 1e3;
/// A step is halved at most to this part of it.
const SHORTEST: f64 = 1.0 / 64.0;

#[derive(Clone, Debug)]
pub(crate) struct Midpoint {
    /// p at the end of the last step, and the time of that end.
    momentum: Option<(f64, DVector<f64>)>,
    /// v of the last part.
    velocity: Vec<f64>,
    workspace: Workspace,
    M: Vec<f64>,
    dM: Vec<f64>,
    ddtheta: Vec<f64>,
}

impl Midpoint {
    pub fn new(model: &Model) -> Self {
        let n = model.n();
        let (velocity, workspace) = (vec![0.0; n], Workspace::new(model));
        let zeros = || vec![0.0; n * n];
        Midpoint { momentum: None, velocity, workspace, M: zeros(), dM: zeros(), ddtheta: vec![0.0; n] }
    }

    /// Restarts after the state was changed from outside: p is then Mθ̇.
    pub fn restart(&mut self) {
        self.momentum = None;
    }

    fn mass_matrix(&mut self, model: &Model, theta: &[f64]) -> DMatrix<f64> {
        mass_matrix(model, theta, &mut self.workspace, &mut self.M);
        DMatrix::from_row_slice(model.n(), model.n(), &self.M)
    }

    /// A step of h seconds, which ends at a time: in parts of half the length, and so on, where its iteration does not
    /// converge, or a loop does not close.
    pub fn step<I: Input>(
        &mut self,
        from: &State,
        h: f64,
        end: f64,
        driven: &mut Driven<'_, I>,
    ) -> Result<State, Error> {
        self.step_in_parts(from, h, end, driven, |_, _, _, _| ())
    }

    /// [`step`](Self::step), with each part's start, length, v and end.
    pub fn step_in_parts<I: Input>(
        &mut self,
        from: &State,
        h: f64,
        end: f64,
        driven: &mut Driven<'_, I>,
        mut part_taken: impl FnMut(&State, f64, &[f64], &State),
    ) -> Result<State, Error> {
        let (mut state, mut length) = (from.clone(), h);
        loop {
            let part = length.min(end - state.t);
            let is_last = state.t + 1.000_001 * part >= end;
            let then = if is_last { end } else { state.t + part };
            match self.part(&state, part, then, driven) {
                Ok(to) => {
                    part_taken(&state, part, &self.velocity, &to);
                    if is_last {
                        return Ok(to);
                    }
                    state = to;
                }
                Err(Error::NoConvergence { .. } | Error::Opened { .. } | Error::Jumped { .. })
                    if part > SHORTEST * h =>
                {
                    self.restart();
                    length = 0.5 * part;
                }
                Err(error) => return Err(error),
            }
        }
    }

    /// A part of a step, closed.
    fn part<I: Input>(&mut self, from: &State, h: f64, end: f64, driven: &mut Driven<'_, I>) -> Result<State, Error> {
        let mut to = self.rule(from, h, end, driven)?;
        if driven.has_constraints() {
            driven.close(end, &mut to.theta, &mut to.dtheta)?;
            driven.complete(&mut to)?;
            self.restart();
        }
        Ok(to)
    }

    /// The rule.
    fn rule<I: Input>(&mut self, from: &State, h: f64, end: f64, driven: &mut Driven<'_, I>) -> Result<State, Error> {
        let (model, n) = (driven.model, from.dtheta.len());
        let (middle, half) = (from.t + 0.5 * h, 0.5 * h);
        let p = match self.momentum.take() {
            Some((t, p)) if t == from.t => p,
            _ => self.mass_matrix(model, &from.theta) * DVector::from_column_slice(&from.dtheta),
        };
        let mut v = DVector::from_iterator(n, from.dtheta.iter().zip(&from.ddtheta).map(|(v, a)| v + half * a));
        let (mut theta, mut last, mut done) = (from.theta.clone(), f64::INFINITY, false);
        let curved = || model.configuration_space().places().iter().filter(|place| place.freedom != Freedom::One);
        let (mut worst, most) = (None, AWAY * (1.0 + v.amax()));
        let (mut powers, mut M, mut after) = ([0.0; 3], DMatrix::zeros(0, 0), DVector::zeros(n));
        for _ in 0..ITERATIONS {
            theta.copy_from_slice(&from.theta);
            integrate(model, &mut theta, v.as_slice(), half);
            powers = driven.evaluate(middle, &theta, v.as_slice(), &mut self.ddtheta)?;
            mass_matrix_rate(model, &theta, v.as_slice(), &mut self.workspace, &mut self.dM);
            M = self.mass_matrix(model, &theta);
            driven.mass.factor(&theta, half, model.damping())?;
            let dM = DMatrix::from_row_slice(n, n, &self.dM); // symmetric
            let rate = &M * DVector::from_column_slice(&self.ddtheta) + dM * &v; // ṗ
            let mut momentum = &p + &rate * half;
            let Mv = &M * &v;
            for place in curved() {
                let of_place = |x: &DVector<f64>| padded(x.as_slice(), place);
                let found = on_the_group(of_place(&p), of_place(&rate), of_place(&Mv), of_place(&v), h);
                let k = place.velocities().len();
                momentum.rows_mut(place.j, k).copy_from_slice(&found.middle[..k]);
                after.rows_mut(place.j, k).copy_from_slice(&found.end[..k]);
            }
            for (j, &damping) in model.damping().iter().enumerate() {
                momentum[j] += half * damping * v[j];
            }
            let mut next = momentum;
            driven.mass.divide(next.as_mut_slice());
            if next.amax() > most {
                worst = (n > 0).then(|| next.iamax());
                break; // θ without meaning, and M without its rank, come next
            }
            let differences = &next - &v;
            worst = (n > 0).then(|| differences.iamax());
            let change = differences.amax() / (1.0 + next.amax());
            v = next;
            if done || change == 0.0 {
                done = true;
                break;
            }
            // one more iteration close to rounding, and no more
            done = change < 1e-14 || (change < 1e-11 && change >= last);
            last = change;
        }
        if !done {
            return Err(Error::NoConvergence {
                joint: velocity(model, worst),
                time: from.t,
                step: h,
                iterations: ITERATIONS,
            });
        }
        self.velocity.copy_from_slice(v.as_slice());
        let mut p = M * &v * 2.0 - p;
        for place in curved() {
            p.as_mut_slice()[place.velocities()].copy_from_slice(&after.as_slice()[place.velocities()]);
        }
        let mut to = State { t: end, ..from.clone() };
        to.theta.copy_from_slice(&from.theta);
        integrate(model, &mut to.theta, v.as_slice(), h);
        (0..3).for_each(|k| to.works[k] += h * powers[k]);
        driven.mass.factor(&to.theta, 0.0, &[])?;
        to.dtheta.copy_from_slice(p.as_slice());
        driven.mass.divide(&mut to.dtheta);
        self.momentum = Some((to.t, p));
        driven.complete(&mut to)?;
        Ok(to)
    }
}

/// The rows of a place as (ω, v) or (m, f): a ball's are followed by zeros.
pub(crate) fn padded<S: Scalar>(x: &[S], place: &Place) -> [S; 6] {
    core::array::from_fn(|k| if k < place.velocities().len() { x[place.j + k] } else { S::zero() })
}

/// The momentum of a floating base, a free joint or a ball at the midpoint and at the end of a step.
pub(crate) struct GroupMomentum<S> {
    pub middle: [S; 6],
    pub end: [S; 6],
}

/// From p at the step's start, ṗ and Mv at its middle.
pub(crate) fn on_the_group<S: Real>(p: [S; 6], rate: [S; 6], Mv: [S; 6], v: [S; 6], h: S) -> GroupMomentum<S> {
    let (V, half) = (Twist::from_array(v), S::from_f64(0.5));
    let F = Wrench::from_array(rate) - V.ad().transpose() * Wrench::from_array(Mv);
    let way = V * h;
    let half_way_back = SE3::exp(way * -half).Ad().transpose();
    let P = Wrench::from_array(p) + half_way_back * F * h;
    GroupMomentum {
        middle: (series(way, P) - series(way * -half, F) * (half * h)).to_array(),
        end: (SE3::exp(way).Ad().transpose() * P).to_array(),
    }
}

#[cfg(test)]
mod tests {
    use crate::simulate;
    use crate::tests::robots::{INERTIA, pendulum};
    use crate::{Method, Options, Zero};

    #[test]
    fn much_friction_on_little_inertia_converges() {
        let (d, h, start) = (2000.0, 1e-2, 0.7);
        assert!(0.5 * h * d > INERTIA); // where v ← M⁻¹(p + ½hṗ(v)) moves away from its fixed point
        let model = pendulum(d, 0.0).with_gravity([0.0; 3]).expect("sound");
        let options = Options { method: Method::Midpoint, ..Options::new(h, 1) };
        let end = simulate(&model, &[0.2], &[start], Zero, &options).expect("a step");
        // Iθ̈ = −dθ̇ at the middle: I(v − θ̇) = −½hdv
        let v = start * INERTIA / (INERTIA + 0.5 * h * d);
        let last = end.last();
        assert!((last.theta[0] - (0.2 + h * v)).abs() < 1e-14 && (last.dtheta[0] - (2.0 * v - start)).abs() < 1e-12);
    }
}

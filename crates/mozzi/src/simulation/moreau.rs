//! Moreau and Jean's step with θ = ½ (Jean 1999), second order as long as no contact changes.
//!
//! > θ_m = θ ⊕ ½Δt θ̇,  M̂(θ̇⁺ − θ̇) = Δt F(θ_m, ½(θ̇ + θ̇⁺)) − Jᵀp,  θ⁺ = θ ⊕ ½Δt(θ̇ + θ̇⁺)
//!
//! with M̂ = M + ½Δt D + ¼Δt² K for damping D and stiffness K of joints and motors, which makes the step implicit in
//! them, and impulses p of constraints, stops, dry friction and contacts. A step is divided where a joint with dry
//! friction comes to rest.

use super::equation::Equation;
use super::events::bisect;
use super::impulses::{Impulses, Key, Solved, System};
use super::{Input, Powers};
use crate::kinematics::integrate;
use crate::model::{Error, Freedom, Model};
use crate::one_sided::Law;
use alloc::vec;
use alloc::vec::Vec;

/// Evaluations of the smooth forces: with θ̇, then with ½(θ̇ + θ̇⁺).
const PASSES: usize = 2;
/// A step is divided at most this often.
const DIVISIONS: usize = 8;
/// Joints slower than this are at rest, rad/s or m/s.
const AT_REST: f64 = 1e-9;

/// Memory of the step.
pub(super) struct Moreau {
    /// Damping and stiffness that are implicit in the step: of the joints, and with the motors'.
    joints: [Vec<f64>; 2],
    gains: [Vec<f64>; 2],
    implicit: [Vec<f64>; 2],
    /// Is the step divided where a joint comes to rest?
    pub divides: bool,
}

/// Where a step starts.
#[derive(Clone, Debug)]
pub(super) struct Phase {
    pub t: f64,
    pub theta: Vec<f64>,
    pub dtheta: Vec<f64>,
    pub works: Powers,
}

/// A step that may count.
struct Trial {
    h: f64,
    system: System,
    solved: Solved,
    dtheta: Vec<f64>,
    works: Powers,
}

impl Moreau {
    pub fn new(model: &Model) -> Self {
        let n = model.n();
        let mut stiffness = vec![0.0; n];
        for spring in model.springs.iter().filter(|spring| spring.place.freedom == Freedom::One) {
            stiffness[spring.place.j] += spring.stiffness;
        }
        let zeros = || [vec![0.0; n], vec![0.0; n]];
        Moreau { joints: [stiffness, model.damping.clone()], gains: zeros(), implicit: zeros(), divides: true }
    }

    /// A step of h seconds.
    pub fn step<I: Input>(
        &mut self,
        equation: &mut Equation<'_, I>,
        impulses: &mut Impulses<'_>,
        state: &mut Phase,
        h: f64,
    ) -> Result<(), Error> {
        self.gains.iter_mut().for_each(|list| list.fill(0.0));
        let [stiffness, damping] = &mut self.gains;
        equation.input.gains(stiffness, damping);
        for k in 0..2 {
            let sums = self.joints[k].iter().zip(&self.gains[k]).map(|(joint, motor)| joint + motor);
            self.implicit[k] = sums.collect();
        }
        let mut rest = h;
        for division in 0..=DIVISIONS {
            let trial = self.trial(equation, impulses, state, rest, &[])?;
            let stopping = if self.divides && division < DIVISIONS { stopping(&trial, state) } else { Vec::new() };
            let Some((s, trial_there)) = self.first_rest(equation, impulses, state, rest, &stopping)? else {
                commit(impulses, state, &trial);
                return Ok(());
            };
            commit(impulses, state, &trial_there);
            for &j in &stopping {
                if state.dtheta[j].abs() < AT_REST {
                    state.dtheta[j] = 0.0;
                }
            }
            rest -= s;
            if rest <= 1e-14 * h {
                return Ok(());
            }
        }
        Ok(())
    }

    /// The time at which the first of these joints comes to rest, while they slide, and the step until then.
    fn first_rest<I: Input>(
        &mut self,
        equation: &mut Equation<'_, I>,
        impulses: &mut Impulses<'_>,
        state: &Phase,
        h: f64,
        stopping: &[usize],
    ) -> Result<Option<(f64, Trial)>, Error> {
        if stopping.is_empty() {
            return Ok(None);
        }
        let least = |trial: &[f64]| {
            let speeds = stopping.iter().map(|&j| trial[j] * state.dtheta[j].signum());
            speeds.fold(f64::INFINITY, f64::min)
        };
        let (mut failure, start) = (None, least(&state.dtheta));
        let mut speed = |s: f64| match self.trial(equation, impulses, state, s, stopping) {
            Ok(trial) => least(&trial.dtheta),
            Err(error) => {
                failure.get_or_insert(error);
                f64::NAN
            }
        };
        let end = speed(h);
        let s = if end <= 0.0 { bisect(&mut speed, (0.0, start), (h, end)) } else { f64::NAN };
        if let Some(error) = failure {
            return Err(error);
        }
        if !(s > 0.0) {
            return Ok(None); // the joints come to rest only by a force that another law produces
        }
        Ok(Some((s, self.trial(equation, impulses, state, s, stopping)?)))
    }

    /// A step of h seconds without its positions; `sliding` joints keep their full dry friction.
    fn trial<I: Input>(
        &self,
        equation: &mut Equation<'_, I>,
        impulses: &mut Impulses<'_>,
        state: &Phase,
        h: f64,
        sliding: &[usize],
    ) -> Result<Trial, Error> {
        let (model, v) = (impulses.model, &state.dtheta);
        let (n, [stiffness, damping]) = (model.n(), &self.implicit);
        let mut theta = state.theta.clone();
        integrate(model, &mut theta, v, 0.5 * h);
        let middle = state.t + 0.5 * h;
        let diagonal: Vec<f64> =
            (0..n).map(|j| 0.5 * h * damping[j] + 0.25 * h * h * stiffness[j]).collect();
        let system = impulses.system(middle, &theta, h, &diagonal, sliding)?;
        let before = system.relative(v);
        let mut p = impulses.guess(&system, h);
        let (mut v_m, mut force) = (v.clone(), vec![0.0; n]);
        let (mut after, mut solved) = (v.clone(), None);
        let (mut motors, mut last) = ([0.0; 3], v.clone());
        for _ in 0..PASSES {
            motors = equation.smooth_force(middle, &theta, &v_m, &mut force)?;
            for j in 0..n {
                force[j] = h * (force[j] + damping[j] * (v_m[j] - v[j]));
            }
            sliding.iter().for_each(|&j| force[j] -= h * model.friction[j] * v[j].signum());
            impulses.divide(&mut force);
            after.copy_from_slice(v);
            after.iter_mut().zip(&force).for_each(|(rate, change)| *rate += change);
            if !system.rows.is_empty() {
                let found = impulses.solve(&system, system.relative(&after), &before, &p);
                impulses.apply(&system, &found.p, &mut after);
                p.copy_from(&found.p);
                solved = Some(found);
            }
            last.copy_from_slice(&v_m);
            (0..n).for_each(|j| v_m[j] = 0.5 * (v[j] + after[j]));
        }
        equation.check_velocities(middle, &after)?;
        let solved = solved.unwrap_or(Solved { u: before.clone(), p, residual: 0.0 });
        // works at the mean velocity
        let mut works = [motors[0], 0.0, motors[2]].map(|power| h * power);
        let [gain_stiffness, gain_damping] = &self.gains;
        works[0] = 0.0;
        for j in 0..n {
            let change = v_m[j] - last[j];
            let tau = equation.tau()[j] - gain_damping[j] * change - 0.5 * h * gain_stiffness[j] * (v_m[j] - v[j]);
            works[0] += h * tau * v_m[j];
            works[1] += h * model.damping[j] * v_m[j] * v_m[j];
        }
        works[1] += h * equation.smooth_friction_power(&v_m);
        sliding.iter().for_each(|&j| works[1] += h * model.friction[j] * v[j].signum() * v_m[j]);
        let given = solved.p.dot(&system.w);
        works[1] += -0.5 * solved.p.dot(&(&before + system.relative(&after)));
        works[2] += given;
        Ok(Trial { h, system, solved, dtheta: after, works })
    }
}

/// The joints with dry friction that move at the start and are at rest, or move back, at the end.
fn stopping(trial: &Trial, state: &Phase) -> Vec<usize> {
    let mut found = Vec::new();
    for &(key, first, law) in &trial.system.rows {
        let (Key::Dry(j), Law::Dry { most }) = (key, law) else { continue };
        let rests = trial.solved.p[first].abs() < most;
        if state.dtheta[j].abs() > AT_REST && (rests || trial.dtheta[j] * state.dtheta[j] < 0.0) {
            found.push(j);
        }
    }
    found
}

/// Takes the step.
fn commit(impulses: &mut Impulses<'_>, state: &mut Phase, trial: &Trial) {
    let h = trial.h;
    let mean: Vec<f64> = state.dtheta.iter().zip(&trial.dtheta).map(|(a, b)| 0.5 * (a + b)).collect();
    integrate(impulses.model, &mut state.theta, &mean, h);
    state.dtheta.copy_from_slice(&trial.dtheta);
    state.t += h;
    (0..3).for_each(|k| state.works[k] += trial.works[k]);
    impulses.keep(&trial.system, &trial.solved, h);
}

//! Moreau and Jean's step with θ = ½ (Jean 1999), second order as long as no contact changes.
//!
//! > θ_m = θ ⊕ ½Δt θ̇,  M̂(θ̇⁺ − θ̇) = Δt F(θ_m, ½(θ̇ + θ̇⁺)) − Jᵀp,  θ⁺ = θ ⊕ ½Δt(θ̇ + θ̇⁺)
//!
//! with M̂ = M + ½Δt D + ¼Δt² K for damping D and stiffness K of joints and motors, which makes the step implicit in
//! them, and impulses p of constraints, stops, dry friction and contacts. A step is divided where a joint with dry
//! friction comes to rest.

use crate::Error;
use crate::driven::Driven;
use crate::equation::Equation;
use crate::events::bisect_until;
use crate::impulses::{Impulses, Key, Solved, System};
use crate::methods::free_bodies::{end_of, frame_rates, straight, turned};
use crate::one_sided::Law;
use crate::{Input, Powers};
use alloc::vec;
use alloc::vec::Vec;
use mozzi::model::Model;

/// Evaluations of the smooth forces: with θ̇, then with ½(θ̇ + θ̇⁺), until θ̇⁺ changes by less than `SETTLED`, relative
/// to 1 + |θ̇⁺|.
const PASSES: usize = 6;
const SETTLED: f64 = 1e-10;
/// A change that is above this after the last pass means that the step is too long, as does one that does not shrink.
const UNSETTLED: f64 = 1e-6;
/// A step is halved until it settles and loops close, at most to this part of it: of a robot with loops, and of others,
/// whose steps do not settle where contacts begin or end to hold, at any length.
const SHORTEST: [f64; 2] = [1.0 / 64.0, 1.0 / 8.0];
/// A step that lifts contacts by more than this part of the largest kinetic energy so far is too long, unless the robot
/// starts at rest, or is lifted by less than `LEAST_LIFT`, m.
const LIFTED: f64 = 5e-4;
const LEAST_LIFT: f64 = 1e-6;
/// A step is divided at most this often.
const DIVISIONS: usize = 8;
/// The time at which a joint comes to rest is found in fewer tries, unless its speed jumps: by an impact.
const TRIES: usize = 8;
/// Joints slower than this are at rest, relative to the largest of 1 and |θ̇|: velocities are not known better.
const AT_REST: f64 = 10.0 * SETTLED;

/// Memory of the step.
pub(crate) struct Moreau {
    /// Damping and stiffness that are implicit in the step: of the joints, and with the motors'.
    joints: [Vec<f64>; 2],
    gains: [Vec<f64>; 2],
    implicit: [Vec<f64>; 2],
    /// The largest kinetic energy so far, J.
    largest: f64,
}

/// Where a step starts.
#[derive(Clone, Debug)]
pub(crate) struct Phase {
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
    to: Phase,
    /// True if the iteration for θ̇⁺ converged.
    settles: bool,
}

impl Moreau {
    pub fn new(model: &Model) -> Self {
        let n = model.n();
        let zeros = || [vec![0.0; n], vec![0.0; n]];
        Moreau {
            joints: [model.stiffness(), model.damping().to_vec()],
            gains: zeros(),
            implicit: zeros(),
            largest: 0.0,
        }
    }

    /// A step of h seconds: in parts of half the length, and so on, where its iteration does not contract, or a loop
    /// does not close.
    pub fn step<I: Input>(
        &mut self,
        driven: &mut Driven<'_, I>,
        impulses: &mut Impulses<'_>,
        state: &mut Phase,
        h: f64,
    ) -> Result<(), Error> {
        self.gains.iter_mut().for_each(|list| list.fill(0.0));
        let [stiffness, damping] = &mut self.gains;
        driven.equation.input.gains(stiffness, damping);
        for k in 0..2 {
            let sums = self.joints[k].iter().zip(&self.gains[k]).map(|(joint, motor)| joint + motor);
            self.implicit[k] = sums.collect();
        }
        let (mut done, mut length) = (0.0, h);
        let shortest = h * SHORTEST[usize::from(!driven.has_constraints())];
        while done < h * (1.0 - 1e-12) {
            let part = length.min(h - done);
            let is_shortest = part <= shortest;
            let start = (state.clone(), impulses.memory.clone(), impulses.forces.clone());
            match self.part(driven, impulses, state, part, is_shortest) {
                Ok(true) => done += part,
                Err(error) if is_shortest || !is_too_long(&error) => return Err(error),
                Ok(false) | Err(_) => {
                    (*state, impulses.memory, impulses.forces) = start;
                    length = 0.5 * part;
                    impulses.account.halvings += 1;
                }
            }
        }
        Ok(())
    }

    /// A part of a step, of h seconds, then positions and loops put right. False if its iteration does not contract, it
    /// lifts the robot by much energy, or a joint is beyond its stop, unless it counts nevertheless.
    fn part<I: Input>(
        &mut self,
        driven: &mut Driven<'_, I>,
        impulses: &mut Impulses<'_>,
        state: &mut Phase,
        h: f64,
        counts: bool,
    ) -> Result<bool, Error> {
        let (equation, end) = (&mut driven.equation, state.t + h);
        self.largest = self.largest.max(equation.energy(&state.theta, &state.dtheta, state.works).kinetic);
        let mut rest = h;
        for division in 0..=DIVISIONS {
            impulses.passed.clear();
            impulses.pressed.clear();
            let mut trial = self.trial(equation, impulses, state, rest, &[])?;
            while impulses.add_passed(&trial.system, end, &trial.to.theta, &trial.to.dtheta) {
                trial = self.trial(equation, impulses, state, rest, &[])?;
            }
            if !trial.settles {
                if !counts {
                    return Ok(false);
                }
                impulses.account.unsettled += 1;
            }
            let stopping = if division < DIVISIONS { stopping(&trial, state) } else { Vec::new() };
            let Some((s, trial_there)) = self.first_rest(equation, impulses, state, rest, &stopping)? else {
                commit(impulses, state, trial);
                break;
            };
            let at_rest = at_rest(state);
            commit(impulses, state, trial_there);
            for &j in &stopping {
                if state.dtheta[j].abs() < at_rest {
                    state.dtheta[j] = 0.0;
                }
            }
            rest -= s;
            if rest <= 1e-14 * h {
                break;
            }
        }
        state.t = end;
        let before =
            (!impulses.memory.carrying.is_empty()).then(|| equation.energy(&state.theta, &state.dtheta, state.works));
        let fastest = state.dtheta.iter().fold(0.0_f64, |most, rate| most.max(rate.abs()));
        let corrects = impulses.correct(end, &mut state.theta, h, h * fastest)?;
        impulses.put_within_stops(&mut state.theta);
        driven.close(end, &mut state.theta, &mut state.dtheta)?;
        if let (true, Some(before)) = (corrects, before) {
            let after = driven.equation.energy(&state.theta, &state.dtheta, state.works);
            let lifted = after.kinetic + after.potential - before.kinetic - before.potential;
            let weight = impulses.model.mass() * driven.equation.gravity.norm();
            if !counts && self.largest > 0.0 && lifted > LIFTED * self.largest + LEAST_LIFT * weight {
                return Ok(false);
            }
            impulses.account.lifted += lifted;
            // what touched did so earlier or later in the step, at another speed: the contacts' loss is that much less
            state.works[1] -= lifted;
        }
        Ok(counts || !impulses.is_beyond_a_stop(&state.theta))
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
        let start = least(&state.dtheta);
        let rests = at_rest(state);
        let (mut failure, mut last, mut tries) = (None, None, 0);
        let mut speed = |s: f64| {
            tries += 1;
            if tries > TRIES {
                return 0.0; // ends the search
            }
            match self.trial(equation, impulses, state, s, stopping) {
                Ok(trial) => least(&last.insert(trial).to.dtheta),
                Err(error) => {
                    failure.get_or_insert(error);
                    f64::NAN
                }
            }
        };
        let end = speed(h);
        let s = if end <= 0.0 { bisect_until([rests, 1e-9 * h], &mut speed, (0.0, start), (h, end)) } else { f64::NAN };
        if let Some(error) = failure {
            return Err(error);
        }
        if !(s > 0.0) || tries > TRIES {
            return Ok(None); // the joints come to rest only by a force that another law produces, or their speed jumps
        }
        match last {
            Some(trial) if trial.h == s => Ok(Some((s, trial))),
            _ => Ok(Some((s, self.trial(equation, impulses, state, s, stopping)?))),
        }
    }

    /// A step of h seconds that may count; `sliding` joints keep their full dry friction.
    fn trial<I: Input>(
        &self,
        equation: &mut Equation<'_, I>,
        impulses: &mut Impulses<'_>,
        state: &Phase,
        h: f64,
        sliding: &[usize],
    ) -> Result<Trial, Error> {
        let (model, n, [stiffness, damping]) = (impulses.model, impulses.model.n(), &self.implicit);
        let (middle, end) = (state.t + 0.5 * h, state.t + h);
        let mut theta = state.theta.clone();
        straight(model, &mut theta, &state.dtheta, 0.5 * h);
        let v = turned(model, &state.dtheta, &state.dtheta, -0.5 * h); // in the axes of the middle
        let diagonal: Vec<f64> = (0..n).map(|j| 0.5 * h * damping[j] + 0.25 * h * h * stiffness[j]).collect();
        let mut next = state.theta.clone();
        straight(model, &mut next, &state.dtheta, h);
        let mut system =
            impulses.system(middle, &theta, [&state.theta, &state.dtheta, &next], h, &diagonal, sliding)?;
        let before = impulses.relative_at(&system, state.t, &state.theta, &state.dtheta);
        system.start = system.relative(&v);
        let mut p = impulses.guess(&system, h);
        let (mut v_m, mut force) = (v.clone(), vec![0.0; n]);
        let (mut after, mut last, mut solved, mut given) = (v.clone(), v.clone(), None, 0.0);
        let mut to = state.clone();
        let (mut change, mut settles) = (f64::INFINITY, true);
        for pass in 0..PASSES {
            let start = after.clone();
            let rates = frame_rates(model, &v_m);
            given = equation.smooth_force(middle, &theta, &v_m, &rates, &mut force)?;
            for j in 0..n {
                force[j] = h * (force[j] + damping[j] * (v_m[j] - v[j]));
            }
            sliding.iter().for_each(|&j| force[j] -= h * model.friction()[j] * v[j].signum());
            impulses.mass.divide(&mut force);
            if !system.rows.is_empty() {
                // the laws hold for the velocities at the end, where the rows differ from those at the middle
                end_of(model, state, &v, &after, h, &mut to);
                system.turns = impulses.relative_at(&system, end, &to.theta, &to.dtheta) - system.relative(&after);
                add(&v, &force, &mut after);
                let b = system.relative(&after) + &system.turns;
                let found = impulses.solve(&mut system, b, &before, &p, h);
                impulses.apply(&system, &found.p, &mut after);
                p.copy_from(&found.p);
                solved = Some(found);
            } else {
                add(&v, &force, &mut after);
            }
            last.copy_from_slice(&v_m);
            (0..n).for_each(|j| v_m[j] = 0.5 * (v[j] + after[j]));
            let before = core::mem::replace(&mut change, apart(&start, &after));
            // the next change is expected to be smaller by as much as this one is
            if pass > 0 && (change <= SETTLED || pass > 1 && change * change <= SETTLED * before && change < before) {
                settles = true;
                break;
            }
            settles = pass == 0 || change <= UNSETTLED || change < 0.5 * before && pass + 1 < PASSES;
            if !settles && pass > 1 {
                break;
            }
        }
        equation.check_velocities(middle, &after)?;
        end_of(model, state, &v, &after, h, &mut to);
        let solved = solved.unwrap_or_else(Solved::none);
        // works at the mean velocity
        let [lost, moved] = solved.works(&system, &v, &after);
        let mut works = [0.0, lost + h * equation.smooth_friction_power(&v_m), moved + h * given];
        let [gain_stiffness, gain_damping] = &self.gains;
        for j in 0..n {
            let (change, way) = (v_m[j] - last[j], 0.5 * h * (v_m[j] - v[j]));
            let tau = equation.tau()[j] - gain_damping[j] * change - gain_stiffness[j] * way;
            works[0] += h * tau * v_m[j];
            works[1] += h * model.damping()[j] * v_m[j] * v_m[j];
        }
        sliding.iter().for_each(|&j| works[1] += h * model.friction()[j] * v[j].signum() * v_m[j]);
        (0..3).for_each(|k| to.works[k] += works[k]);
        Ok(Trial { h, system, solved, to, settles })
    }
}

/// True for errors that a shorter step may avoid.
fn is_too_long(error: &Error) -> bool {
    matches!(error, Error::Opened { .. } | Error::Jumped { .. } | Error::Diverged { .. })
}

/// The speed below which a joint is at rest.
fn at_rest(state: &Phase) -> f64 {
    AT_REST * state.dtheta.iter().fold(1.0, |most: f64, rate| most.max(rate.abs()))
}

/// The largest difference, relative to 1 + the largest number.
fn apart(a: &[f64], b: &[f64]) -> f64 {
    let size = b.iter().fold(1.0_f64, |most, x| most.max(x.abs()));
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) / size
}

/// x ← v + change.
fn add(v: &[f64], change: &[f64], x: &mut [f64]) {
    x.copy_from_slice(v);
    x.iter_mut().zip(change).for_each(|(x, change)| *x += change);
}

/// The joints with dry friction that move at the start and are at rest, or move back, at the end, but for those that a
/// stop brings to rest.
fn stopping(trial: &Trial, state: &Phase) -> Vec<usize> {
    let (mut found, at_rest) = (Vec::new(), at_rest(state));
    for &(key, first, law) in &trial.system.rows {
        let (Key::Dry(j), Law::Dry { most }) = (key, law) else { continue };
        let stops = |&(key, row, _): &(Key, usize, Law)| {
            matches!(key, Key::Stop(..)) && trial.solved.p[row] > 0.0 && trial.system.J[(row, j)] != 0.0
        };
        if trial.system.rows.iter().any(stops) {
            continue;
        }
        let rests = trial.solved.p[first].abs() < most;
        if state.dtheta[j].abs() > at_rest && (rests || trial.to.dtheta[j] * state.dtheta[j] < 0.0) {
            found.push(j);
        }
    }
    found
}

/// Takes the step.
fn commit(impulses: &mut Impulses<'_>, state: &mut Phase, trial: Trial) {
    *state = trial.to;
    impulses.keep(trial.system, &trial.solved, trial.h);
}

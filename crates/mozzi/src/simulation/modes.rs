//! Motions with one-sided forces between events: which joints and contacts hold, which slide, and how long.
//!
//! Between two events the rows that hold do not accelerate and sliding ones have known friction, so the motion is
//! smooth and an adaptive method can follow it. At an event (a touch-down, a force that falls to 0, friction that
//! reaches its bound, a slip that ends) velocities may jump, and new modes are those of a step of 1 µs.

use super::dense::Dense;
use super::driven::Driven;
use super::equation::Equation;
use super::events::bisect;
use super::impulses::{Choice, Impulses, Key};
use super::moreau::{Moreau, Phase};
use super::state::State;
use super::{Input, Powers};
use crate::kinematics::integrate;
use crate::model::{Error, Model};
use crate::one_sided::{Law, least_squares};
use crate::scalar::Scalar;
use alloc::vec;
use alloc::vec::Vec;
use nalgebra::{DMatrix, DVector};

/// Velocities below this are 0, m/s or rad/s.
const AT_REST: f64 = 1e-9;
/// Impacts slower than this do not rebound, m/s.
const REBOUND: f64 = 1e-6;
/// Contacts at most this far act, m.
pub(super) const REACH: f64 = 1e-9;
/// The length of the step that finds the modes, s.
const INSTANT: f64 = 1e-6;
/// For rates of rows, by central differences, s.
const DIFFERENCE: f64 = 1e-4;
/// What slides may move against its direction (m/s, rad/s), or pull (N), by this much.
const BACKWARDS: f64 = 1e-6;
/// Parts of a step at whose ends margins are compared.
const PARTS: usize = 4;

/// Whether a joint or a contact holds, or in which direction it slides: the sign of θ̇, or the unit vector of u_t.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Mode {
    Holds,
    Slides([f64; 2]),
}

/// The modes of a motion.
pub(super) struct Modes<'r> {
    pub impulses: Impulses<'r>,
    pub(super) moreau: Moreau,
    /// ‖g‖, m/s²: contacts within ‖g‖h² act in a step of h seconds.
    pub(super) gravity: f64,
    active: Vec<(Key, Mode)>,
    keys: Vec<Key>,
    /// The forces of the active rows at the last evaluation, and the velocities of the surroundings.
    force: DVector<f64>,
    u: DVector<f64>,
    rows: Vec<(Key, usize, Law)>,
}

impl<'r> Modes<'r> {
    pub fn new(model: &Model, mut impulses: Impulses<'r>, gravity: f64) -> Self {
        (impulses.reach, impulses.slowest) = (REACH, REBOUND);
        let none = || DVector::zeros(0);
        let (moreau, active, keys) = (Moreau::new(model), Vec::new(), Vec::new());
        Modes { impulses, moreau, gravity, active, keys, force: none(), u: none(), rows: Vec::new() }
    }

    /// θ̈ ← θ̈ − M⁻¹Jᵀf, with the f of the active rows. Returns the power that friction dissipates, and that given to
    /// moving planes.
    pub fn accelerate(
        &mut self,
        t: f64,
        theta: &[f64],
        dtheta: &[f64],
        ddtheta: &mut [f64],
    ) -> Result<[f64; 2], Error> {
        let model = self.impulses.model;
        let n = model.n();
        if self.active.is_empty() {
            (self.force, self.u) = (DVector::zeros(0), DVector::zeros(0));
            self.rows.clear();
            return Ok([0.0; 2]);
        }
        let system = self.impulses.system(t, theta, 1.0, &[], Choice::Only(&self.keys))?;
        let u = self.impulses.relative_at(&system, t, theta, dtheta);
        let mut moved = |s: f64| {
            let mut theta = theta.to_vec();
            integrate(model, &mut theta, dtheta, s);
            self.impulses.relative_at(&system, t + s, &theta, dtheta)
        };
        let rates = (moved(DIFFERENCE) - moved(-DIFFERENCE)) / (2.0 * DIFFERENCE);
        let mut known = vec![0.0; n];
        let (mut C, mut B, mut target, mut held) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        for &(key, first, law) in &system.rows {
            let mode = self.active.iter().find(|(other, _)| *other == key).map_or(Mode::Holds, |(_, mode)| *mode);
            match (law, mode) {
                (Law::Dry { .. }, Mode::Slides([sign, _])) => {
                    if let Key::Dry(j) = key {
                        known[j] = -sign * model.friction[j];
                    }
                }
                (Law::Contact { mu }, Mode::Slides(reference)) => {
                    let d = slip([u[first + 1], u[first + 2]], reference);
                    C.push(system.J.row(first).into_owned());
                    let across = system.J.row(first + 1) * d[0] + system.J.row(first + 2) * d[1];
                    B.push(system.J.row(first) - across * mu);
                    target.push(rates[first]);
                    held.push((first, [-mu * d[0], -mu * d[1]]));
                }
                _ => {
                    for r in first..first + law.rows() {
                        C.push(system.J.row(r).into_owned());
                        B.push(system.J.row(r).into_owned());
                        target.push(rates[r]);
                        held.push((r, [0.0; 2]));
                    }
                }
            }
        }
        self.impulses.mass.divide(&mut known);
        ddtheta.iter_mut().zip(&known).for_each(|(x, change)| *x += change);
        let mut p = DVector::zeros(u.len());
        if !C.is_empty() {
            let (C, mut X) = (DMatrix::from_rows(&C), DMatrix::from_rows(&B).transpose());
            X.column_iter_mut().for_each(|mut column| self.impulses.mass.divide(column.as_mut_slice()));
            let right = &C * DVector::from_column_slice(ddtheta) - DVector::from_vec(target);
            let found = least_squares(&C * &X, right).unwrap_or_else(|| DVector::zeros(held.len()));
            let change = X * &found;
            ddtheta.iter_mut().zip(change.iter()).for_each(|(x, change)| *x -= change);
            for (&f, (r, across)) in found.iter().zip(held) {
                p[r] = f;
                (0..2).filter(|&k| across[k] != 0.0).for_each(|k| p[r + 1 + k] = f * across[k]);
            }
        }
        for &(key, first, law) in &system.rows {
            if let (Key::Dry(j), Law::Dry { .. }, true) = (key, law, p[first] == 0.0) {
                let sliding = self.active.iter().find(|(other, _)| *other == key);
                if let Some((_, Mode::Slides([sign, _]))) = sliding {
                    p[first] = sign * model.friction[j];
                }
            }
        }
        let powers = [-p.dot(&u), p.dot(&system.w)];
        self.impulses.forces.fill(0.0);
        self.impulses.set_forces(&system, &p);
        (self.force, self.u, self.rows) = (p, u, system.rows);
        Ok(powers)
    }

    /// The margins of the last evaluation at (t, θ, θ̇): the modes end where one falls through 0. Distances first.
    fn margins(&self, t: f64, theta: &[f64], dtheta: &[f64]) -> (Vec<f64>, usize) {
        let is_active = |key: Key| self.keys.contains(&key);
        let mut found: Vec<f64> = Vec::new();
        for (point, plane, touch) in self.impulses.touches(t, theta) {
            found.push(if is_active(Key::Contact(point, plane)) { 1.0 } else { touch.gap });
        }
        for &(k, side) in self.impulses.sides() {
            found.push(if is_active(Key::Stop(k, side)) { 1.0 } else { self.impulses.room(theta, k, side) });
        }
        let distances = found.len();
        for &(key, first, law) in &self.rows {
            let mode = self.active.iter().find(|(other, _)| *other == key).map_or(Mode::Holds, |(_, mode)| *mode);
            let (f, u) = (&self.force, &self.u);
            match (key, law, mode) {
                (Key::Dry(j), _, Mode::Holds) => found.push(self.impulses.model.friction[j] - f[first].abs()),
                (Key::Dry(j), _, Mode::Slides([sign, _])) => found.push(sign * dtheta[j]),
                (Key::Stop(..), ..) => found.push(f[first]),
                (_, Law::Contact { mu }, Mode::Holds) => {
                    let t = Scalar::sqrt(f[first + 1] * f[first + 1] + f[first + 2] * f[first + 2]);
                    found.extend([f[first], mu * f[first] - t]);
                }
                (_, Law::Contact { .. }, Mode::Slides(d)) => {
                    found.extend([f[first], u[first + 1] * d[0] + u[first + 2] * d[1] - AT_REST]);
                }
                _ => {}
            }
        }
        (found, distances)
    }
}

/// The direction of a slip; the reference if it is against it.
fn slip([x, y]: [f64; 2], reference: [f64; 2]) -> [f64; 2] {
    let size = Scalar::sqrt(x * x + y * y);
    if size > 1e-12 && x * reference[0] + y * reference[1] > 0.0 { [x / size, y / size] } else { reference }
}

impl<I: Input> Driven<'_, I> {
    /// The first time within a step, up to `until`, at which a mode ends.
    pub fn first_change(&mut self, dense: &Dense, until: f64) -> Result<Option<f64>, Error> {
        if self.modes.is_none() {
            return Ok(None);
        }
        let mut before = self.margins_at(dense, dense.t)?;
        let time = |k: usize| if k == PARTS { until } else { dense.t + (until - dense.t) * k as f64 / PARTS as f64 };
        for k in 1..=PARTS {
            let after = self.margins_at(dense, time(k))?;
            let mut start = time(k - 1);
            let mut falling: Vec<usize> =
                (0..after.0.len()).filter(|&i| before.0[i] > 0.0 && after.0[i] <= 0.0).collect();
            // what leaves 0 and comes back within this part
            let again = (0..after.1).find(|&i| before.0[i] <= 0.0 && after.0[i] < -1e-10);
            if let (Some(i), true) = (again, falling.is_empty()) {
                let mut part = 0.5;
                while part > 1e-12 && self.margins_at(dense, start + part * (time(k) - start))?.0[i] <= 0.0 {
                    part *= 0.5;
                }
                start += part * (time(k) - start);
                if part <= 1e-12 {
                    return Ok(Some(dense.t));
                }
                falling = vec![i];
            }
            // what begins to slide may be slower than rounding; against its direction or pulling it would gain energy
            let is_broken = |i: usize| match self.slides(i, after.1) {
                true => after.0[i] < -BACKWARDS,
                false => after.0[i] < -1e-9 && after.0[i] < before.0[i],
            };
            if falling.is_empty() && (after.1..after.0.len()).any(|i| before.0[i] <= 0.0 && is_broken(i)) {
                return Ok(Some(dense.t));
            }
            if !falling.is_empty() {
                let mut failure = None;
                let mut least = |t: f64| match self.margins_at(dense, t) {
                    Ok((margins, _)) => falling.iter().map(|&i| margins[i]).fold(f64::INFINITY, f64::min),
                    Err(error) => {
                        failure.get_or_insert(error);
                        f64::NAN
                    }
                };
                let ends = [(start, least(start)), (time(k), least(time(k)))];
                let t = bisect(&mut least, ends[0], ends[1]);
                return failure.map_or(Ok(Some(t)), Err);
            }
            before = after;
        }
        Ok(None)
    }

    /// Is this the margin of something that slides?
    fn slides(&self, margin: usize, distances: usize) -> bool {
        let Some(modes) = &self.modes else { return false };
        let mut next = distances;
        for &(key, ..) in &modes.rows {
            next += match key {
                Key::Dry(_) | Key::Stop(..) => 1,
                Key::Contact(..) => 2,
                Key::Constraint(_) => 0,
            };
            if margin < next {
                let mode = modes.active.iter().find(|(other, _)| *other == key).map(|(_, mode)| *mode);
                return matches!(mode, Some(Mode::Slides(_)));
            }
        }
        false
    }

    fn margins_at(&mut self, dense: &Dense, t: f64) -> Result<(Vec<f64>, usize), Error> {
        let mut state = dense.at(self.model, t);
        self.complete(&mut state)?;
        let modes = self.modes.as_ref().map(|modes| modes.margins(t, &state.theta, &state.dtheta));
        Ok(modes.unwrap_or_default())
    }

    /// Jumps of velocities and new modes at an event.
    pub fn switch(&mut self, state: &mut State) -> Result<(), Error> {
        let Some(mut modes) = self.modes.take() else { return Ok(()) };
        let result = modes.switch(&mut self.equation, state);
        self.modes = Some(modes);
        result?;
        self.complete(state)
    }

    /// Removes what a step left of gaps and velocities of rows that hold.
    pub fn keep_modes(&mut self, state: &mut State) -> Result<(), Error> {
        let Some(modes) = &mut self.modes else { return Ok(()) };
        modes.project(state)
    }
}

impl Modes<'_> {
    fn switch<I: Input>(&mut self, equation: &mut Equation<'_, I>, state: &mut State) -> Result<(), Error> {
        self.strike(state)?;
        for &j in &self.impulses.dry {
            if state.dtheta[j].abs() <= AT_REST {
                state.dtheta[j] = 0.0;
            }
        }
        let phase =
            Phase { t: state.t, theta: state.theta.clone(), dtheta: state.dtheta.clone(), works: Powers::default() };
        let trial = self.moreau.trial(equation, &mut self.impulses, &phase, INSTANT, &[])?;
        let u = self.impulses.relative_at(&trial.system, state.t, &state.theta, &state.dtheta);
        let p = &trial.solved.p;
        self.impulses.account.keep(trial.solved.residual, p.len());
        let carried = core::mem::take(&mut self.impulses.carrying);
        self.active.clear();
        for &(key, first, law) in &trial.system.rows {
            let mode = match (key, law) {
                (Key::Dry(j), Law::Dry { most }) => {
                    let rate = state.dtheta[j];
                    match (rate == 0.0, p[first].abs() < most) {
                        (true, true) => Mode::Holds,
                        (true, false) => Mode::Slides([p[first].signum(), 0.0]),
                        _ => Mode::Slides([rate.signum(), 0.0]),
                    }
                }
                (Key::Stop(..), _) if p[first] > 0.0 && u[first].abs() < 1e-7 => Mode::Holds,
                (Key::Contact(..), Law::Contact { .. }) if p[first] > 0.0 && u[first].abs() < 1e-7 => {
                    let after = &trial.solved.u;
                    let (now, then) = ([u[first + 1], u[first + 2]], [after[first + 1], after[first + 2]]);
                    let size = |x: [f64; 2]| Scalar::sqrt(x[0] * x[0] + x[1] * x[1]);
                    if size(now) > 10.0 * AT_REST {
                        Mode::Slides(now.map(|x| x / size(now)))
                    } else if trial.solved.sticks(&trial.system, first, law) {
                        Mode::Holds
                    } else {
                        Mode::Slides(then.map(|x| x / size(then).max(f64::MIN_POSITIVE)))
                    }
                }
                (Key::Constraint(_), _) => Mode::Holds,
                _ => continue,
            };
            self.active.push((key, mode));
            if matches!(key, Key::Contact(..) | Key::Stop(..)) {
                self.impulses.carrying.push((key, mode == Mode::Holds));
                if let (Key::Stop(k, side), true) = (key, carried.iter().all(|(other, _)| *other != key)) {
                    self.impulses.struck.push((k, side));
                }
            }
        }
        if self.active.iter().all(|(key, _)| matches!(key, Key::Constraint(_))) {
            self.active.clear();
        }
        self.keys = self.active.iter().map(|(key, _)| *key).collect();
        self.project(state)
    }

    /// The impulses of contacts and stops that close.
    fn strike(&mut self, state: &mut State) -> Result<(), Error> {
        let dry = self.impulses.dry.clone();
        let mut system = self.impulses.system(state.t, &state.theta, 1.0, &[], Choice::Near(&dry))?;
        let u = self.impulses.relative_at(&system, state.t, &state.theta, &state.dtheta);
        let closes = system
            .rows
            .iter()
            .any(|&(key, first, _)| matches!(key, Key::Contact(..) | Key::Stop(..)) && u[first] < -1e-12);
        if !closes {
            return Ok(());
        }
        let solved = self.impulses.solve(&mut system, u.clone(), &u, &DVector::zeros(u.len()));
        self.impulses.account.keep(solved.residual, u.len());
        self.impulses.apply(&system, &solved.p, &mut state.dtheta);
        let [lost, given] = solved.works(&system, &u);
        state.works[1] += lost;
        state.works[2] += given;
        Ok(())
    }

    fn project(&mut self, state: &mut State) -> Result<(), Error> {
        if self.active.is_empty() {
            return Ok(());
        }
        self.impulses.correct(state.t, &mut state.theta, 0.0)?;
        let model = self.impulses.model;
        let system = self.impulses.system(state.t, &state.theta, 1.0, &[], Choice::Only(&self.keys))?;
        let u = self.impulses.relative_at(&system, state.t, &state.theta, &state.dtheta);
        let rows: Vec<usize> = system
            .rows
            .iter()
            .flat_map(|&(key, first, law)| {
                let holds = self.active.contains(&(key, Mode::Holds));
                let count = match law {
                    Law::Contact { .. } if !holds => 1,
                    Law::Dry { .. } if !holds => 0,
                    law => law.rows(),
                };
                first..first + count
            })
            .collect();
        if rows.is_empty() {
            return Ok(());
        }
        let (J, u) = (system.J.select_rows(&rows), u.select_rows(&rows));
        if u.amax() > 1e-15 {
            let G = self.impulses.delassus(&J);
            if let Some(p) = least_squares(G, u) {
                let mut change = J.tr_mul(&p);
                self.impulses.mass.divide(change.as_mut_slice());
                state.dtheta.iter_mut().zip(change.iter()).for_each(|(rate, x)| *rate += x);
            }
        }
        for &(key, mode) in &self.active {
            if let (Key::Dry(j), Mode::Holds) = (key, mode) {
                state.dtheta[j] = 0.0;
            }
        }
        debug_assert!(state.dtheta.len() == model.n());
        Ok(())
    }
}

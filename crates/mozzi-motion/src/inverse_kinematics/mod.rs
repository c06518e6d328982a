//! Inverse kinematics: joint positions θ that place a frame at a desired pose (Modern Robotics, chapter 6).
//!
//! > e = log(T_sb(θ)⁻¹T_sd),  δ = Jᵀ(JJᵀ + λI)⁻¹e,  θ ← θ ⊕ δ
//!
//! A joint at a bound that δ would take beyond it is held there, and δ is recomputed for the others. A start that makes
//! no progress is replaced by another. If the robot is redundant, a [`Secondary`] goal chooses among the solutions:
//! steps in the null space of J, each followed by steps back to the goal.

mod ball;
mod bounds;
mod goal;
mod options;
mod reach;
mod secondary;
mod step;

pub use goal::{Goal, Residual};
pub use options::Options;
pub use secondary::Secondary;
pub use step::Method;

use crate::Error;
use crate::error::{check, check_open};
use ball::Ball;
use bounds::Within;
use mozzi::kinematics::{body_jacobian, forward_kinematics};
use mozzi::model::Bounds;
use mozzi::model::integrate;
use mozzi::nalgebra::Vector6;
use mozzi::random::Random;
use mozzi::{FrameId, Model, Twist};
use step::Step;

/// A start is given up when this many iterations have not halved its error.
const PATIENCE: usize = 6;

/// Starts towards a goal beyond the robot's reach: for the best that there is.
const OUTSIDE: usize = 20;

/// Positions that reach a goal.
#[derive(Clone, Debug, PartialEq)]
pub struct Solution {
    /// θ.
    pub theta: Vec<f64>,
    /// The remaining error.
    pub residual: Residual,
    /// Starts that were needed, at least 1.
    pub starts: usize,
    /// Iterations of all starts.
    pub iterations: usize,
}

/// The end of a search: see [`InverseKinematics::search`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Found {
    /// True if the goal is reached.
    pub is_reached: bool,
    /// The remaining error.
    pub residual: Residual,
    /// Starts that were needed, at least 1.
    pub starts: usize,
    /// Iterations of all starts.
    pub iterations: usize,
}

/// Memory of a search.
#[derive(Clone, Debug, Default)]
struct Room {
    /// The best θ of one start, and of all.
    best: Vec<f64>,
    nearest: Vec<f64>,
    /// The guess; then the next θ of the secondary goal.
    next: Vec<f64>,
    /// Its gradient, the step against it, and memory for that step.
    z: Vec<f64>,
    way: Vec<f64>,
    back: Vec<f64>,
}

impl Room {
    fn new(model: &Model) -> Self {
        let [best, nearest, next] = [(); 3].map(|()| vec![0.0; model.nq()]);
        let [z, way, back] = [(); 3].map(|()| vec![0.0; model.n()]);
        Room { best, nearest, next, z, way, back }
    }
}

/// A solver for one frame of a robot, with its memory.
#[derive(Clone, Debug)]
pub struct InverseKinematics<'m> {
    model: &'m Model,
    frame: FrameId,
    options: Options,
    bounds: Bounds,
    /// Where the frame can be.
    ball: Option<Ball>,
    step: Step,
    delta: Vec<f64>,
    iterations: usize,
    room: Room,
}

impl<'m> InverseKinematics<'m> {
    /// For this frame, with the default [`Options`].
    ///
    /// # Errors
    /// [`mozzi::Error::BadArgument`] for a frame of another model, or a robot with constraints.
    pub fn new(model: &'m Model, frame: FrameId) -> Result<Self, Error> {
        Self::with_options(model, frame, Options::default())
    }

    /// For this frame.
    ///
    /// # Errors
    /// [`mozzi::Error::BadArgument`] for a frame of another model, a robot with constraints, or options outside their
    /// domain.
    pub fn with_options(model: &'m Model, frame: FrameId, options: Options) -> Result<Self, Error> {
        model.check_frame(frame)?;
        check_open(model, "a robot under inverse kinematics")?; // φ = 0 is not among the equations
        options.check()?;
        let mut bounds = Bounds::of(model);
        if !options.limits {
            bounds.joints.fill([f64::NEG_INFINITY, f64::INFINITY]);
        }
        let n = model.n();
        // at most one for each ball
        let cones = Vec::with_capacity(bounds.places.len());
        let step = Step { columns: vec![Twist::zero(); n], held: vec![false; n], cones, rows: 0..6 };
        let (room, ball) = (Room::new(model), Ball::of(model, frame, &bounds));
        Ok(InverseKinematics { model, frame, options, bounds, ball, step, delta: vec![0.0; n], iterations: 0, room })
    }

    /// Positions that reach the goal, from a guess and, if that fails, from random ones. An iteration costs O(n).
    ///
    /// # Errors
    /// [`Error::NotReached`] with the best that was found; [`Error::Model`] for an invalid guess or goal.
    pub fn solve(&mut self, goal: Goal, guess: &[f64]) -> Result<Solution, Error> {
        self.solve_with(goal, guess, &Secondary::None)
    }

    /// As [`solve`](Self::solve), with a solution at which a secondary goal has a minimum, as far as the null space
    /// leads.
    ///
    /// # Errors
    /// As [`solve`](Self::solve).
    pub fn solve_with(&mut self, goal: Goal, guess: &[f64], secondary: &Secondary) -> Result<Solution, Error> {
        let mut theta = guess.to_vec();
        let Found { is_reached, residual, starts, iterations } = self.search(goal, secondary, &mut theta)?;
        if is_reached {
            return Ok(Solution { theta, residual, starts, iterations });
        }
        let joints = self.model.joint_names().enumerate();
        let at_limit = joints.filter(|&(k, _)| self.bounds.side(&theta, k) != 0.0);
        let limits = at_limit.map(|(_, name)| name.to_string()).collect();
        let frame = self.model.frame_name(self.frame).to_string();
        Err(Error::NotReached { frame, theta, residual, limits, starts, iterations })
    }

    /// As [`solve_with`](Self::solve_with), from the guess in θ, for control loops: nothing is allocated. θ becomes the
    /// solution, or the best that was found.
    ///
    /// # Errors
    /// [`Error::Model`] for an invalid guess or goal.
    pub fn search(&mut self, goal: Goal, secondary: &Secondary, theta: &mut [f64]) -> Result<Found, Error> {
        self.model.check_configuration(theta)?;
        check(theta.iter().all(|x| x.is_finite()), "the guess", format_args!("{theta:?}"), "finite numbers")?;
        check(goal.is_finite(), "the goal", format_args!("{goal:?}"), "finite numbers")?;
        if let Secondary::Near(reference) = secondary {
            self.model.check_configuration(reference)?;
        }
        self.step.rows = goal.rows();
        self.iterations = 0;
        let mut random = Random(self.options.seed);
        let mut room = core::mem::take(&mut self.room); // empty lists allocate nothing
        let found = self.search_in(&mut room, &goal, secondary, theta, &mut random);
        self.room = room;
        Ok(found)
    }

    fn search_in(
        &mut self,
        room: &mut Room,
        goal: &Goal,
        secondary: &Secondary,
        theta: &mut [f64],
        random: &mut Random,
    ) -> Found {
        let mut least = f64::INFINITY;
        // the guess, from which random starts begin
        room.next.copy_from_slice(theta);
        room.nearest.copy_from_slice(theta);
        let starts = if self.is_out_of_reach(goal) { OUTSIDE.min(self.options.starts) } else { self.options.starts };
        for start in 1..=starts {
            theta.copy_from_slice(&room.next);
            if start > 1 {
                self.bounds.randomize(theta, random);
                self.keep_idle(theta, &room.next);
            }
            let left = self.approach(goal, theta, self.options.iterations, &mut room.best);
            if self.is_reached(goal, theta) {
                self.descend(room, goal, theta, secondary);
                return self.found(true, goal, theta, start);
            }
            if left < least || start == 1 {
                least = left;
                room.nearest.copy_from_slice(theta);
            }
        }
        theta.copy_from_slice(&room.nearest);
        self.found(false, goal, theta, starts)
    }

    /// Joints that do not move the frame stay at the guess.
    fn keep_idle(&mut self, theta: &mut [f64], guess: &[f64]) {
        self.linearize(theta);
        let columns = &self.step.columns;
        for place in self.model.configuration_space().places() {
            if place.velocities().all(|j| columns[j] == Twist::zero()) {
                let positions = place.positions();
                theta[positions.clone()].copy_from_slice(&guess[positions]);
            }
        }
    }

    /// True if no lengths of the robot lead so far.
    fn is_out_of_reach(&self, goal: &Goal) -> bool {
        let outside = self.ball.zip(reach::position(*goal)).map(|(ball, p)| ball.outside(p));
        outside.is_some_and(|outside| outside > self.options.distance + 1e-9)
    }

    fn found(&self, is_reached: bool, goal: &Goal, theta: &[f64], starts: usize) -> Found {
        let residual = self.residual(goal, theta);
        Found { is_reached, residual, starts, iterations: self.iterations }
    }

    fn error(&self, goal: &Goal, theta: &[f64]) -> Twist {
        goal.error(forward_kinematics(self.model, theta, self.frame))
    }

    fn residual(&self, goal: &Goal, theta: &[f64]) -> Residual {
        goal.residual(forward_kinematics(self.model, theta, self.frame))
    }

    fn is_reached(&self, goal: &Goal, theta: &[f64]) -> bool {
        let Residual { angle, distance } = self.residual(goal, theta);
        angle.is_none_or(|x| x <= self.options.angle) && distance.is_none_or(|x| x <= self.options.distance)
    }

    /// e, with v in units of the length in the options.
    fn scaled(&self, V: Twist) -> Vector6<f64> {
        Twist { v: V.v * (1.0 / self.options.length), ..V }.to_array().into()
    }

    /// Computes J at θ, with no joint held.
    fn linearize(&mut self, theta: &[f64]) {
        body_jacobian(self.model, theta, self.frame, &mut self.step.columns);
        let one_over = 1.0 / self.options.length;
        self.step.columns.iter_mut().for_each(|column| column.v = column.v * one_over);
        self.step.let_go();
    }

    /// Steps towards the goal until it is reached, or there is no more progress; leaves the best θ on the way and
    /// returns ‖e‖ there.
    fn approach(&mut self, goal: &Goal, theta: &mut [f64], iterations: usize, best: &mut [f64]) -> f64 {
        self.bounds.clamp(theta);
        best.copy_from_slice(theta);
        let (mut least, mut mark, mut since) = (f64::INFINITY, f64::INFINITY, 0);
        for done in 0..=iterations {
            let e = self.scaled(self.error(goal, theta));
            let size = e.norm();
            if size < least {
                least = size;
                best.copy_from_slice(theta);
            }
            since = if size < 0.5 * mark { 0 } else { since + 1 };
            mark = if since == 0 { size } else { mark };
            if self.is_reached(goal, theta) || since > PATIENCE || !size.is_finite() || done == iterations {
                break;
            }
            self.iterations += 1;
            self.linearize(theta);
            loop {
                self.step.towards(&e, self.options.method, &mut self.delta);
                if !self.step.hold_at_bounds(&self.bounds, theta, &self.delta) {
                    break;
                }
            }
            integrate(self.model, theta, &self.delta, 1.0);
            self.bounds.clamp(theta);
        }
        theta.copy_from_slice(best);
        least
    }

    /// From a solution to better ones: along −∂H in the null space, then back to the goal, as long as H falls.
    fn descend(&mut self, room: &mut Room, goal: &Goal, theta: &mut [f64], secondary: &Secondary) {
        if matches!(secondary, Secondary::None) {
            return;
        }
        let Room { best, next, z, way, back, .. } = room;
        let mut along = 1.0;
        let mut H = secondary.evaluate(self.model, theta, z);
        for _ in 0..10 * self.options.iterations {
            self.linearize(theta);
            loop {
                way.iter_mut().zip(&*z).for_each(|(way, z)| *way = -z);
                self.step.within_null_space(way, back);
                if !self.step.hold_at_bounds(&self.bounds, theta, way) {
                    break;
                }
            }
            let square: f64 = way.iter().map(|x| x * x).sum();
            if square.sqrt() < 1e-7 {
                return;
            }
            loop {
                next.copy_from_slice(theta);
                integrate(self.model, next, way, along);
                self.approach(goal, next, 10, best);
                let better = secondary.evaluate(self.model, next, z);
                if self.is_reached(goal, next) && better < H - 1e-4 * along * square {
                    (H, along) = (better, (2.0 * along).min(1.0));
                    theta.copy_from_slice(next);
                    break;
                }
                along *= 0.5;
                if along < 1e-6 {
                    return;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests;

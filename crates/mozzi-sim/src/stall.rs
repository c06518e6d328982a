//! Detection of a stalled simulation: many steps that hardly advance time.
//!
//! The steps of an integrator are counted in windows of a fixed number. If a window covers less time than
//!
//! > window / 10⁸ · t_f (adaptive: the whole motion would take 10⁸ steps),  window / 1000 · δt (steps of given length)
//!
//! the simulation would practically never end, and is stopped with an error. For adaptive steps around a velocity that
//! changes its sign again and again, as under an input with sgn θ̇, or whose damping alone makes the steps short, the
//! bound is 10⁶ steps instead of 10⁸.

use crate::Error;
use crate::Options;
use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec;
use alloc::vec::Vec;
use mozzi::model::Model;

/// Steps of a window.
const WINDOW: usize = 20_000;
/// Maximum numbers of adaptive steps of a whole motion: of any, and of one that chatters.
const MOST: f64 = 1e8;
const MOST_CHATTER: f64 = 1e6;
/// A velocity chatters if it changes its sign in this many steps of a window, taken or rejected.
const CHATTER: usize = WINDOW / 20;

/// The causes of an adaptive method's short steps.
#[derive(Clone, Debug)]
pub(crate) struct Trouble {
    /// The velocity with the largest error of the last estimate.
    pub sensitive: Option<usize>,
    /// For each velocity, the number of steps of this window, taken or rejected, in which it changes its sign.
    pub changes: Vec<usize>,
}

impl Trouble {
    pub fn new(n: usize) -> Self {
        Trouble { sensitive: None, changes: vec![0; n] }
    }

    /// The velocity that changes its sign most often, if that is chatter.
    fn chatter(&self) -> Option<usize> {
        let most = (0..self.changes.len()).max_by_key(|&j| self.changes[j]);
        most.filter(|&j| self.changes[j] > CHATTER)
    }
}

#[derive(Clone, Debug)]
pub(crate) struct Stall {
    /// The least time of a window, s: for any motion, and for one that chatters.
    least: [f64; 2],
    steps: usize,
    /// When the window began.
    start: f64,
}

impl Stall {
    pub fn new(options: &Options) -> Self {
        let window = WINDOW as f64;
        let least = if options.method.is_adaptive() {
            [window / MOST * options.duration, window / MOST_CHATTER * options.duration]
        } else {
            [1e-3 * window * options.step(), 0.0]
        };
        Stall { least, steps: 0, start: 0.0 }
    }

    /// Called after each step, with the causes that an adaptive method knows.
    pub fn check(&mut self, model: &Model, t: f64, known: Option<&mut Trouble>) -> Result<(), Error> {
        self.steps += 1;
        if self.steps < WINDOW {
            return Ok(());
        }
        let (advance, steps) = (t - self.start, self.steps);
        (self.steps, self.start) = (0, t);
        let chatter = known.as_ref().and_then(|known| known.chatter());
        let is_slow = advance < self.least[1];
        let damped = if is_slow && chatter.is_none() { damped(model, advance / steps as f64) } else { None };
        if advance < self.least[0] || is_slow && (chatter.is_some() || damped.is_some()) {
            let j = chatter.or(damped).or(known.and_then(|known| known.sensitive));
            let cause = if damped.is_some() { DAMPED } else { cause(chatter.is_some()) };
            let cause = format!("{steps} steps advanced by {advance:e} s only; {cause}");
            return Err(Error::Stalled { time: t, joint: velocity(model, j), cause });
        }
        if let Some(known) = known {
            known.changes.fill(0);
        }
        Ok(())
    }
}

/// The error of an adaptive step that would be below rounding of t.
pub(crate) fn too_short(model: &Model, [time, step]: [f64; 2], tolerance: f64, j: Option<usize>) -> Error {
    let cause = format!("a tolerance of {tolerance:e} needs steps below {step:e} s; {}", cause(false));
    Error::Stalled { time, joint: velocity(model, j), cause }
}

/// The name of a velocity, such as its joint's; empty if there is none.
pub(crate) fn velocity(model: &Model, j: Option<usize>) -> String {
    j.and_then(|j| model.velocity_names().nth(j)).unwrap_or_default().to_string()
}

/// The velocity whose damping d requires steps as short as h. Explicit methods are stable up to about h = 3 M/d.
fn damped(model: &Model, h: f64) -> Option<usize> {
    let M = model.mass_matrix(&model.start().theta).ok()?;
    let rate = |j: usize| {
        (mozzi::dynamics::joint_friction(model, j, 2.0) - mozzi::dynamics::joint_friction(model, j, 1.0)) / M[(j, j)]
    };
    let fastest = (0..model.n()).max_by(|&a, &b| rate(a).total_cmp(&rate(b)))?;
    (rate(fastest) * h > 1.0).then_some(fastest)
}

const DAMPED: &str = "its damping stops it within less than a step, which makes the motion stiff; the methods `midpoint` \
                      and `moreau` take longer steps";

fn cause(chatters: bool) -> &'static str {
    if chatters {
        "the sign of its velocity alternates: the input jumps there, as sgn does"
    } else {
        "the motion is stiff, or its input jumps; a larger tolerance may help, or the methods `midpoint` and `moreau`"
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simulate;
    use crate::tests::robots::pendulum;
    use crate::{Method, torque};

    fn options(tolerance: f64, duration: f64) -> Options {
        Options { method: Method::DormandPrince { tolerance }, ..Options::new(duration, 100) }
    }

    #[test]
    fn an_input_that_jumps_ends_with_an_error() {
        let bang = torque(|_, theta, dtheta, tau| tau[0] = -50.0 * (theta[0] + dtheta[0]).signum());
        let error = simulate(&pendulum(0.0, 0.0), &[0.5], &[0.0], bang, &options(1e-10, 5.0)).expect_err("sliding");
        assert!(matches!(&error, Error::Stalled { joint, .. } if joint == "pivot"), "{error}");
    }

    #[test]
    fn stiff_damping_ends_with_the_methods_that_take_it() {
        let begin = |damping: f64| simulate(&pendulum(damping, 0.0), &[0.5], &[0.0], crate::Zero, &options(1e-9, 1.0));
        assert!(begin(1.0).is_ok());
        let error = begin(1e8).expect_err("stiff");
        assert!(matches!(&error, Error::Stalled { joint, .. } if joint == "pivot"), "{error}");
        let said = error.to_string();
        assert!(said.contains("its damping") && said.contains("`midpoint` and `moreau`"), "{said}");
    }

    #[test]
    fn steps_that_do_not_advance_are_counted() {
        let model = pendulum(0.0, 0.0);
        let options = Options::new(1.0, 1000);
        let mut stall = Stall::new(&options);
        let mut window =
            |t: f64| -> Vec<Error> { (0..WINDOW).filter_map(|_| stall.check(&model, t, None).err()).collect() };
        // the first window has advanced to 0.25 s, the second by nothing
        assert!(window(0.25).is_empty());
        assert!(matches!(&window(0.25)[..], [Error::Stalled { time: 0.25, .. }]));
    }
}

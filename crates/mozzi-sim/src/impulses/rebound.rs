//! Restitution: Newton's law at the time within the step at which the contact touches.

use super::rows::Touching;
use super::{Impulses, Solved, System};
use mozzi::scalar::Scalar;

/// An impact rebounds if it is faster than this many times what the contact gains in the step without contact forces: a
/// loaded foot would else jump for ever.
const REBOUND: f64 = 4.0;

/// The end of a step in which a contact touched and left again.
pub(super) struct Rebound {
    /// The rate of the gap, m/s.
    pub speed: f64,
    /// m
    gap: f64,
}

impl Impulses<'_> {
    /// With a = (u_free − u₀)/h, the contact touches after t_c, where gap + u₀ t_c + ½ a t_c² = 0, at u_c = u₀ + a t_c;
    /// it leaves at −e u_c, and goes on with a. None if it does not rebound.
    pub(super) fn rebound(&self, touching: &Touching, before: f64, free: f64, h: f64) -> Option<Rebound> {
        let e = self.contacts.points[touching.pair.0].restitution;
        let gain = free - before;
        if e == 0.0 || -before <= REBOUND * (-gain).max(0.0) {
            return None;
        }
        let (a, gap) = (gain / h, (touching.gap - 0.5 * h * before).max(0.0)); // the gap at the start
        let u_c = -Scalar::sqrt((before * before - 2.0 * a * gap).max(0.0));
        let rest = h - (2.0 * gap / -(before + u_c)).min(h);
        let (speed, leaves) = (a * rest - e * u_c, -e * u_c);
        (speed > 0.0).then(|| Rebound { speed, gap: (leaves * rest + 0.5 * a * rest * rest).max(0.0) })
    }

    /// The gaps of contacts that rebounded within the step.
    pub(super) fn note_rebounds(&mut self, system: &System, solved: &Solved, h: f64) {
        let mut found = core::mem::take(&mut self.memory.rebounds);
        found.clear();
        for touching in &system.touches {
            let first = touching.first;
            let (comes, goes) = (solved.before[first], solved.u[first]);
            if comes < 0.0 && goes > 0.0 && solved.p[first] > 0.0 {
                let rebound = self.rebound(touching, comes, solved.free[first], h);
                found.extend(rebound.map(|rebound| (touching.pair, rebound.gap)));
            }
        }
        self.memory.rebounds = found;
    }
}

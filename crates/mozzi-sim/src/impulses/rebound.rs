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
    /// The contact touches after t_c, where gap + u₀ t_c + ½ a t_c² = 0, at u_c = u₀ + a t_c; it leaves at −e u_c, and
    /// goes on. Its acceleration a is a_F of the smooth forces and that of the turning row, which an impact changes:
    /// the law holds along the row at the middle of the step, u⁺ = −e(u + a_F t_c) + a_F(h − t_c), where the impulse
    /// works. None if it does not rebound.
    pub(super) fn rebound(
        &self,
        system: &System,
        touching: &Touching,
        before: f64,
        free: f64,
        h: f64,
    ) -> Option<Rebound> {
        let e = self.contacts.points[touching.pair.0].restitution;
        if e == 0.0 || -before <= REBOUND * (before - free).max(0.0) {
            return None;
        }
        let [middle, turns] = [&system.start, &system.turns].map(|u| u[touching.first]);
        let a_F = (free - turns - middle) / h;
        let a = a_F + 2.0 * (middle - before) / h;
        let gap = (touching.gap - 0.5 * h * before).max(0.0); // at the start
        let u_c = -Scalar::sqrt((before * before - 2.0 * a * gap).max(0.0));
        let t_c = 2.0 * gap / -(before + u_c); // it may be a little after the step
        let (rest, leaves) = ((h - t_c).max(0.0), -e * u_c);
        let speed = a_F * rest - e * (middle + a_F * t_c) + turns;
        let after = a_F + 2.0 * turns / h;
        (speed > 0.0).then(|| Rebound { speed, gap: (leaves * rest + 0.5 * after * rest * rest).max(0.0) })
    }

    /// The gaps of contacts that rebounded within the step.
    pub(super) fn note_rebounds(&mut self, system: &System, solved: &Solved, h: f64) {
        let mut found = core::mem::take(&mut self.memory.rebounds);
        found.clear();
        for touching in &system.touches {
            let first = touching.first;
            let (comes, goes) = (solved.before[first], solved.u[first]);
            if comes < 0.0 && goes > 0.0 && solved.p[first] > 0.0 {
                let rebound = self.rebound(system, touching, comes, solved.free[first], h);
                found.extend(rebound.map(|rebound| (touching.pair, rebound.gap)));
            }
        }
        self.memory.rebounds = found;
    }
}

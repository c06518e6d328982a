//! The memory of one-sided forces between steps.

use super::{CARRIES, Impulses, Key, SLIDES, STICKS, Solved, System, slip};
use crate::contacts::ContactChange;
use alloc::collections::BTreeMap;
use alloc::vec::Vec;
use mozzi::linalg::Vec3;

/// The state that a step passes to the next one.
#[derive(Clone, Default)]
pub(crate) struct Memory {
    /// The forces of the last step, in the order of their keys.
    pub(super) warm: Vec<(Key, [f64; 3])>,
    /// Where sticking contact points touch: in the coordinates of the plane.
    pub(super) anchors: BTreeMap<(usize, usize), Vec3>,
    /// The gaps of contacts that rebounded within the step, m.
    pub(super) rebounds: BTreeMap<(usize, usize), f64>,
    /// How far points that came to rest within the step would have to go back, along t₁ and t₂.
    pub(super) stopped: BTreeMap<(usize, usize), [f64; 2]>,
    /// Points within reach for which others of their body act.
    pub(super) stands_for: Vec<(usize, usize)>,
    /// The contacts and stops that carried in the last step, and whether they stick.
    pub carrying: Vec<(Key, bool)>,
    /// The contacts and stops that carried since they were near, and whether they stick.
    pub touching: Vec<(Key, bool)>,
    /// Contacts that began or ceased to carry or to slide, and were not reported yet.
    pub changes: Vec<(Key, ContactChange)>,
    /// Joints and sides of stops that were struck and not reported yet.
    pub struck: Vec<(usize, usize)>,
}

impl Memory {
    /// Whether this block of rows acted in the last step.
    pub(super) fn acted(&self, key: Key) -> bool {
        self.warm.binary_search_by_key(&key, |(key, _)| *key).is_ok()
    }

    /// The forces alone.
    pub fn guess(self) -> Self {
        Memory { warm: self.warm, ..Memory::default() }
    }
}

impl Impulses<'_> {
    /// Remembers the impulses of a step of h seconds that counts.
    pub fn keep(&mut self, system: System, solved: &Solved, h: f64) {
        self.account.keep(solved.residual, solved.p.len());
        let Memory { warm, carrying, touching, changes, struck, stands_for, .. } = &mut self.memory;
        let mut touched = core::mem::take(touching);
        carrying.clear();
        warm.clear();
        let least = CARRIES * solved.free.iter().fold(0.0_f64, |most, u| most.max(u.abs()));
        for &(key, first, law) in &system.rows {
            let mut force = [0.0; 3];
            (0..law.rows()).for_each(|k| force[k] = solved.p[first + k] / h);
            warm.push((key, force));
            let carries = solved.p[first] * system.G[(first, first)] > least;
            let sticks = solved.sticks(&system, first, law);
            match key {
                Key::Contact(..) => {
                    let before = touched.iter().find(|(other, _)| *other == key).map(|&(_, sticks)| sticks);
                    let speed = slip(&solved.u, first);
                    let now = match before {
                        Some(true) => Some(!(carries && speed > SLIDES)),
                        Some(false) => Some(speed < STICKS),
                        None => carries.then_some(sticks),
                    };
                    touching.extend(now.map(|sticks| (key, sticks)));
                    match (before, now) {
                        (None, Some(_)) => changes.push((key, ContactChange::TouchDown)),
                        (Some(false), Some(true)) => changes.push((key, ContactChange::Sticks)),
                        (Some(true), Some(false)) => changes.push((key, ContactChange::Slides)),
                        _ => {}
                    }
                }
                Key::Stop(k, side) => {
                    let touched = touched.iter().any(|&(other, _)| other == key);
                    if carries && !touched {
                        struck.push((k, side));
                    }
                    touching.extend((carries || touched).then_some((key, true)));
                }
                _ => {}
            }
            if carries && matches!(key, Key::Contact(..) | Key::Stop(..)) {
                carrying.push((key, sticks));
            }
        }
        warm.sort_unstable_by_key(|(key, _)| *key);
        touched.retain(|(key, _)| !touching.iter().any(|(other, _)| other == key));
        // what others stand for has not lifted off
        let stands = |key: Key| matches!(key, Key::Contact(k, plane) if stands_for.contains(&(k, plane)));
        for (key, sticks) in touched {
            if stands(key) {
                touching.push((key, sticks));
            } else if let Key::Contact(..) = key {
                changes.push((key, ContactChange::LiftOff));
            }
        }
        self.note_rebounds(&system, solved, h);
        self.note_stopped(&system, solved, h);
        self.add_impulses(&system, &solved.p);
        self.last = Some((system.rows.into_iter().map(|(key, ..)| key).collect(), system.solver));
    }
}

//! Conversion of a robot's `qpos` and `qvel` in MuJoCo, which include mimic joints, to states of mozzi.

use super::tree::Tree;
use crate::urdf::vocabulary::shown;
use mozzi::conventions::MuJoCo;
use mozzi::model::State;
use mozzi::model::description::{JointKind, Link, Source};
use mozzi::{Description, Model, SpatialInertia};
use std::ops::Range;

/// A joint's numbers in `qpos` and `qvel`.
pub(crate) struct Slot {
    /// Its index among the description's joints; None for the base's.
    joint: Option<usize>,
    /// Its name in messages.
    pub shown: String,
    /// The file's own configuration.
    pub qpos0: Vec<f64>,
}

impl Slot {
    /// Its number of entries in `qvel`.
    pub fn velocities(&self) -> usize {
        match self.qpos0.len() {
            1 => 1,
            more => more - 1,
        }
    }

    /// Whether the file's own configuration is at 0.
    pub fn is_neutral(&self) -> bool {
        let one = self.quaternion().map(|range| range.start);
        self.qpos0.iter().enumerate().all(|(k, &x)| x == if one == Some(k) { 1.0 } else { 0.0 })
    }

    /// Index of its quaternion among its entries of `qpos`.
    pub fn quaternion(&self) -> Option<Range<usize>> {
        match self.qpos0.len() {
            4 => Some(0..4),
            7 => Some(3..7),
            _ => None,
        }
    }
}

impl Tree {
    /// The joints that move, in the order of `qpos`, which is the file's.
    pub fn slots(&self) -> Vec<Slot> {
        let at = |T: mozzi::SE3| {
            let [w, x, y, z, px, py, pz] = T.to_pose();
            vec![px, py, pz, w, x, y, z]
        };
        let base = self.free.iter().map(|free| Slot {
            joint: None,
            shown: free.joint.as_deref().map_or_else(|| self.links[free.link].name.shown(), shown),
            qpos0: at(free.start),
        });
        let joints = self.joints.iter().enumerate().filter_map(|(i, joint)| {
            let qpos0 = match joint.joint.kind {
                JointKind::Fixed => return None,
                JointKind::Screw(_) => vec![joint.reference],
                JointKind::Ball(_) => vec![1.0, 0.0, 0.0, 0.0],
                JointKind::Free => at(joint.start),
            };
            Some(Slot { joint: Some(i), shown: joint.name.shown(), qpos0 })
        });
        base.chain(joints).collect()
    }
}

/// A robot's slots and how they become θ and θ̇.
pub(crate) struct Coordinates<'s> {
    slots: &'s [Slot],
    /// The robot without its inertias.
    model: Model,
    mujoco: MuJoCo,
    /// For each slot of a mimic joint: the source joint's slot, the ratio and the offset.
    sources: Vec<Option<Source>>,
}

impl<'s> Coordinates<'s> {
    /// `None` if the description is invalid.
    pub fn new(slots: &'s [Slot], description: &Description) -> Option<Self> {
        let massless = |link: &Link| Link { name: link.name.clone(), inertia: SpatialInertia::zero() };
        let links = description.links.iter().map(massless).collect();
        let model = Description { links, ..description.clone() }.build().ok()?;
        let of = |slot: &Slot| slot.joint.map(|i| &description.joints[i]);
        let is_free = |slot: &&Slot| of(slot).is_some_and(|joint| joint.mimic.is_none());
        let independent: Vec<&str> =
            slots.iter().filter(is_free).filter_map(of).map(|joint| joint.name.as_str()).collect();
        if !model.joint_names().eq(independent) {
            return None; // never: both are numbered depth first, in the order of the file
        }
        let mujoco = MuJoCo::new(&model);
        let mut slot_of = vec![0; description.joints.len()];
        slots
            .iter()
            .enumerate()
            .filter_map(|(k, slot)| Some((k, slot.joint?)))
            .for_each(|(k, joint)| slot_of[joint] = k);
        let number: std::collections::BTreeMap<&str, usize> =
            description.joints.iter().enumerate().map(|(i, joint)| (joint.name.as_str(), i)).collect();
        let names: Vec<&str> = model.joint_names().collect();
        let mut sources: Vec<Option<Source>> = slots.iter().map(|_| None).collect();
        for (joint, source) in model.moving_joints().zip(model.sources()).filter(|(joint, _)| joint.mimic.is_some()) {
            let at = |name: &str| number.get(name).map(|&i| slot_of[i]);
            let (follower, leader) = (at(&joint.name)?, at(names[source.joint])?);
            sources[follower] = Some(Source { joint: leader, ..source });
        }
        Some(Coordinates { slots, mujoco, sources, model })
    }

    /// The state of `qpos`, with its quaternions normalized, and `qvel`.
    pub fn state(&self, time: f64, qpos: &[f64], qvel: &[f64]) -> Option<State> {
        let qpos = self.independent(qpos, |slot| slot.qpos0.len());
        let qvel = self.independent(qvel, Slot::velocities);
        let theta = self.mujoco.from_configuration(&qpos).ok()?;
        let dtheta = self.mujoco.from_velocity(&qpos, &qvel).ok()?;
        Some(State { time, theta: theta.as_slice().to_vec(), dtheta: dtheta.as_slice().to_vec() })
    }

    /// True for the neutral configuration.
    pub fn is_neutral(&self, state: &State) -> bool {
        state.theta == self.model.neutral_configuration::<f64>()
    }

    /// Adds a state to the description.
    pub fn name(&self, name: String, state: &State, description: &mut Description) {
        description.states.extend(self.model.named_state(name, state)); // no error: the lengths are this model's
    }

    /// The numbers of the independent joints.
    fn independent(&self, list: &[f64], width: impl Fn(&Slot) -> usize) -> Vec<f64> {
        let (mut kept, mut rest) = (Vec::with_capacity(list.len()), list);
        for (slot, source) in self.slots.iter().zip(&self.sources) {
            let (own, others) = rest.split_at(width(slot));
            rest = others;
            if source.is_none() {
                kept.extend(own);
            }
        }
        kept
    }

    /// A message for each mimic joint whose position (or rate) disagrees with its source joint's.
    pub fn contradictions(&self, list: &[f64], is_rate: bool, tolerance: f64) -> Vec<String> {
        let width = |slot: &Slot| if is_rate { slot.velocities() } else { slot.qpos0.len() };
        let starts: Vec<usize> = self
            .slots
            .iter()
            .scan(0, |at, slot| {
                *at += width(slot);
                Some(*at - width(slot))
            })
            .collect();
        let told = |(k, source): (usize, &Option<Source>)| {
            let Source { joint, ratio, offset } = source.as_ref()?;
            let (found, x) = (list[starts[k]], list[starts[*joint]]);
            let expected = ratio * x + if is_rate { 0.0 } else { *offset };
            let (follower, leader) = (&self.slots[k].shown, &self.slots[*joint].shown);
            ((found - expected).abs() > tolerance * expected.abs().max(1.0)).then(|| {
                format!(
                    "number {} is {found}, but joint `{follower}` follows `{leader}`, which takes it to {expected}",
                    starts[k] + 1
                )
            })
        };
        self.sources.iter().enumerate().filter_map(told).collect()
    }
}

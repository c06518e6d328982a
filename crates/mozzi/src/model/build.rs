//! From a description to the screw normal form.

use super::ConfigurationSpace;
use super::description::{self, Joint, JointKind};
use super::frame::last_frame;
use super::places::names_of;
use super::tie::ties;
use super::{
    Base, Description, Error, Frame, FrameId, Freedom, Link, Model, Motion, Place, Rotor, Severity, Spring, Structure,
};
use crate::lie::{SE3, SO3};
use crate::linalg::{Mat3, Vec3, ldlt::Pattern};
use crate::scalar::Real;
use crate::spatial::{JointAxis, ScrewAxis, SpatialInertia};
use alloc::collections::BTreeMap;
use alloc::sync::Arc;
use alloc::vec;
use alloc::vec::Vec;

impl<C: Real + Into<f64>> Description<C> {
    /// The model of this robot, with constants of the description's number type; the checks use them rounded to `f64`.
    /// Joints are numbered depth first, siblings in the order of the file; a mimic joint takes no number. Fixed links
    /// are folded into the link that carries them.
    ///
    /// # Errors
    /// [`Error::Invalid`] with all errors that [`check`](Description::check) finds.
    pub fn build(self) -> Result<Model<C>, Error> {
        let rounded = self.map(Into::into);
        let problems = rounded.check();
        if problems.iter().any(|problem| problem.severity == Severity::Error) {
            return Err(Error::Invalid { robot: self.name, problems });
        }
        Ok(normal_form(&self, rounded))
    }
}

/// The model of a checked description. The model keeps `rounded`, the description in `f64`.
pub(super) fn normal_form<C: Real>(description: &Description<C>, rounded: Description) -> Model<C> {
    let link_index = index(description.links.iter().map(|link| link.name.as_str()));
    let (joints_of, base) = branches(description, &link_index);

    // depth first: each link's frame on its slot, the moving links, and each slot's inertia
    let mut frames = vec![Frame { slot: 0, T: SE3::identity() }; description.links.len()];
    let mut inertias = vec![SpatialInertia::zero()];
    let (mut links, mut moving_joints) = (Vec::new(), Vec::new());
    let mut stack: Vec<(usize, Option<usize>)> = vec![(base, None)];
    while let Some((link, joint)) = stack.pop() {
        if let Some(i) = joint {
            let joint = &description.joints[i];
            let carrier = frames[link_index[joint.parent.as_str()]];
            let home = carrier.T * joint.origin; // the child's frame at 0, relative to the carrier's normal frame
            frames[link] = match joint.kind {
                JointKind::Fixed => Frame { slot: carrier.slot, T: home },
                JointKind::Screw(A) => {
                    let (axis, normal) = normal_frame(A);
                    links.push(massless(carrier.slot, Motion::Screw, axis, (home * normal).inverse()));
                    Frame { slot: links.len(), T: normal.inverse() }
                }
                JointKind::Ball(center) => {
                    let normal = SE3::translation(center.0);
                    let M = (home * normal).inverse();
                    several(&mut links, carrier.slot, Motion::Ball, M, &[TURN; 3]);
                    Frame { slot: links.len(), T: normal.inverse() }
                }
                JointKind::Free => {
                    several(
                        &mut links,
                        carrier.slot,
                        Motion::Free,
                        home.inverse(),
                        &[TURN, TURN, TURN, SLIDE, SLIDE, SLIDE],
                    );
                    Frame { slot: links.len(), T: SE3::identity() }
                }
            };
        }
        moving_joints.resize(links.len(), joint.unwrap_or_default());
        inertias.resize(links.len() + 1, SpatialInertia::zero());
        let Frame { slot, T } = frames[link];
        inertias[slot] += description.links[link].inertia.transformed(T);
        stack
            .extend(joints_of[link].iter().rev().map(|&i| (link_index[description.joints[i].child.as_str()], Some(i))));
    }
    for (link, &G) in links.iter_mut().zip(&inertias[1..]) {
        link.G = G;
    }

    let leaves =
        (0..description.links.len()).filter(|&i| joints_of[i].is_empty() && (frames[i].slot > 0 || links.is_empty()));
    let leaves: Vec<FrameId> = leaves.map(FrameId).collect();
    for frame in &description.frames {
        let Frame { slot, T } = frames[link_index[frame.link.as_str()]];
        frames.push(Frame { slot, T: T * frame.T });
    }
    let frame_names =
        description.links.iter().map(|link| &link.name).chain(description.frames.iter().map(|frame| &frame.name));
    let end_effector = match &description.end_effector {
        Some(name) => frame_names.into_iter().position(|known| known == name).map(FrameId),
        None => last_frame(&leaves, &frames, |leaf| description.links[leaf].name.as_str()),
    };

    let (joints, places) = couple(description, &moving_joints, &mut links);
    let base_name = (description.base == Base::Floating).then_some("base");
    let owners = base_name.into_iter().chain(joints.iter().map(|&i| description.joints[i].name.as_str()));
    let names = names_of(owners.zip(places.iter().map(|place| place.freedom)));
    let n = places.last().map_or(0, |place: &Place| place.velocities().end);
    let sum = |of: fn(&Joint<C>, C) -> C| {
        let mut total = vec![C::zero(); n];
        for (link, &i) in links.iter().zip(&moving_joints) {
            total[link.j] += of(&description.joints[i], link.ratio);
        }
        total
    };
    let joint_places = &places[usize::from(base_name.is_some())..];
    let rotors = rotors(description, &moving_joints, &links);
    let (springs, spring_energy) = springs(description, &moving_joints, &links, &places);
    let coupled_free = rotors.is_empty() && moving_joints.iter().all(|&i| description.joints[i].mimic.is_none());
    let pattern = Pattern::coupled(
        description.base.velocities(),
        n,
        links.iter().map(|link| (link.parent, link.j)),
        rotors.iter().map(Rotor::joints),
    );
    let is_floating = description.base == Base::Floating;
    let siblings = siblings(&links, n);
    Model {
        ties: ties(description, &frames, &links, &moving_joints, &pattern, is_floating),
        base_inertia: inertias[0],
        armature: sum(|joint, ratio| ratio * ratio * joint.armature),
        damping: sum(|joint, ratio| ratio * ratio * joint.damping),
        friction: sum(|joint, ratio| ratio.abs() * joint.friction),
        springs,
        spring_energy,
        frames,
        gravity: Vec3(description.gravity),
        base: description.base,
        solves_by_mass_matrix: siblings.is_none() || !rotors.is_empty(),
        is_described: true,
        structure: Arc::new(Structure {
            pattern,
            has_mimic_joints: moving_joints.iter().any(|&i| description.joints[i].mimic.is_some()),
            siblings: siblings.unwrap_or_default(),
            free: joint_places.iter().filter(|place| place.freedom == Freedom::Free).map(|place| place.j).collect(),
            has_long_limbs: coupled_free && mean_depth_exceeds(LONG, &links),
            forks: forks(&links),
            of_one_axis: joint_places.iter().all(|place| place.freedom == Freedom::One),
            moving_links: moving_joints.iter().map(|&i| link_index[description.joints[i].child.as_str()]).collect(),
            base,
            moving_joints,
            names,
            joints,
            space: ConfigurationSpace(places.into()),
            end_effector,
            leaves,
            description: rounded,
        }),
        links,
        rotors,
    }
}

fn index<'n>(names: impl Iterator<Item = &'n str>) -> BTreeMap<&'n str, usize> {
    names.enumerate().map(|(i, name)| (name, i)).collect()
}

/// The joints that each link carries, and the base: the link that no joint moves.
fn branches<C>(description: &Description<C>, link_index: &BTreeMap<&str, usize>) -> (Vec<Vec<usize>>, usize) {
    let mut joints_of = vec![Vec::new(); description.links.len()];
    let mut is_child = vec![false; description.links.len()];
    for (i, joint) in description.joints.iter().enumerate() {
        joints_of[link_index[joint.parent.as_str()]].push(i);
        is_child[link_index[joint.child.as_str()]] = true;
    }
    let base = is_child.iter().position(|&child| !child).unwrap_or(0);
    (joints_of, base)
}

/// Numbers the independent joints in the order of their links, and gives each mimic joint its source joint's number,
/// ratio and offset, through chains of mimic joints. Returns the description's joint for each number, and the places of
/// a floating base and of these joints.
fn couple<C: Real>(
    description: &Description<C>,
    moving_joints: &[usize],
    links: &mut [Link<C>],
) -> (Vec<usize>, Vec<Place>) {
    let joint_index = index(description.joints.iter().map(|joint| joint.name.as_str()));
    let mut joints: Vec<usize> =
        moving_joints.iter().copied().filter(|&i| description.joints[i].mimic.is_none()).collect();
    joints.dedup();
    let base = (description.base == Base::Floating).then_some(Freedom::Free);
    let (mut places, mut q, mut j) = (Vec::new(), 0, 0);
    for freedom in base.into_iter().chain(joints.iter().filter_map(|&i| description.joints[i].kind.freedom())) {
        let place = Place { freedom, q, j };
        (q, j) = (place.positions().end, place.velocities().end);
        places.push(place);
    }
    let mut place_of = vec![Place { freedom: Freedom::One, q: 0, j: 0 }; description.joints.len()];
    for (&i, &place) in joints.iter().zip(&places[usize::from(base.is_some())..]) {
        place_of[i] = place;
    }
    let mut axis = 0; // of its joint
    for (link, &i) in links.iter_mut().zip(moving_joints) {
        axis = if link.motion == Motion::Next { axis + 1 } else { 0 };
        let source = description.source_by(i, |name| joint_index.get(name).copied());
        (link.ratio, link.offset) = (source.ratio, source.offset);
        link.A = link.screw.map(|x| x * source.ratio);
        (link.q, link.j) = (place_of[source.joint].q, place_of[source.joint].j + axis);
    }
    (joints, places)
}

/// See [`Structure::siblings`]; none if a mimic joint and its source joint are on different links.
fn siblings<C>(links: &[Link<C>], n: usize) -> Option<Vec<usize>> {
    let (mut first_of, mut siblings) = (vec![0; n], vec![0; links.len() + 1]);
    for (slot, link) in (1..).zip(links) {
        match first_of[link.j] {
            0 => first_of[link.j] = slot,
            first if links[first - 1].parent == link.parent => (siblings[first], siblings[slot]) = (first, first),
            _ => return None,
        }
    }
    if siblings.iter().all(|&first| first == 0) {
        siblings.clear();
    }
    Some(siblings)
}

/// The mean number of links between a link and the base above which articulated bodies give ∂θ̈ sooner; measured, see
/// `docs/performance-log.md`.
const LONG: usize = 10;
const TURN: [bool; 2] = [true, false];
const SLIDE: [bool; 2] = [false, true];

/// A massless link that has no index in θ yet.
fn massless<C: Real>(parent: usize, motion: Motion, screw: JointAxis<C>, M: SE3<C>) -> Link<C> {
    let (ratio, offset) = (C::one(), C::zero());
    Link { parent, q: 0, j: 0, screw, A: screw, motion, is_last: true, M, G: SpatialInertia::zero(), ratio, offset }
}

/// A link for each axis of a joint: the first has the joint's configuration.
fn several<C: Real>(links: &mut Vec<Link<C>>, parent: usize, motion: Motion, M: SE3<C>, axes: &[[bool; 2]]) {
    let one = |is: bool| if is { C::one() } else { C::zero() };
    for (k, &[turns, slides]) in axes.iter().enumerate() {
        let A = JointAxis { a: one(turns), b: one(slides) };
        let link = match k {
            0 => massless(parent, motion, A, M),
            _ => massless(links.len(), Motion::Next, A, SE3::identity()),
        };
        links.push(Link { is_last: k + 1 == axes.len(), ..link });
    }
}

/// For each slot, whether a link is carried by it but does not come next.
fn forks<C>(links: &[Link<C>]) -> Vec<bool> {
    let mut forks = vec![false; links.len() + 1];
    for (k, link) in links.iter().enumerate() {
        forks[link.parent] |= link.parent != k;
    }
    forks
}

/// True if the mean number of links between a link and the base is above `mean`.
fn mean_depth_exceeds<C>(mean: usize, links: &[Link<C>]) -> bool {
    let mut depths = vec![0];
    for link in links {
        depths.push(depths[link.parent] + 1);
    }
    depths.iter().sum::<usize>() > mean * links.len()
}

/// The rotors that several joints turn, expressed by independent joints. Locked joints do not turn them.
fn rotors<C: Real>(description: &Description<C>, moving_joints: &[usize], links: &[Link<C>]) -> Vec<Rotor<C>> {
    let of = |rotor: &description::Rotor<C>| {
        let mut J = BTreeMap::new();
        for gear in &rotor.gears {
            let moves = |i: &usize| description.joints[*i].name == gear.joint;
            if let Some(link) = moving_joints.iter().position(moves).map(|k| &links[k]) {
                *J.entry(link.j).or_insert(C::zero()) += gear.ratio * link.ratio;
            }
        }
        Rotor { armature: rotor.armature, J: J.into_iter().collect() }
    };
    description.rotors.iter().map(of).collect()
}

/// The springs, expressed by independent joints, and their energy at θ = 0.
fn springs<C: Real>(
    description: &Description<C>,
    moving_joints: &[usize],
    links: &[Link<C>],
    places: &[Place],
) -> (Vec<Spring<C>>, C) {
    let (mut springs, mut energy) = (BTreeMap::new(), C::zero());
    for (link, &i) in links.iter().zip(moving_joints).filter(|(link, _)| link.motion != Motion::Next) {
        let Joint { stiffness, spring_reference, .. } = description.joints[i];
        if stiffness.is_identically_zero() {
            continue;
        }
        let (moment, stretch) = (link.ratio * stiffness, spring_reference - link.offset);
        let place = places[places.partition_point(|place| place.j <= link.j) - 1];
        let spring = springs.entry(place.j).or_insert(Spring { place, stiffness: C::zero(), preload: C::zero() });
        spring.stiffness += link.ratio * moment;
        spring.preload += moment * stretch;
        energy += C::from_f64(0.5) * stiffness * stretch * stretch;
    }
    (springs.into_values().collect(), energy)
}

/// The joint's axis in the normal form, and the normal frame relative to the link's: z along the screw, the origin on
/// it. If the screw is along one of the link's axes, the other axes are the link's own too, so that zeros stay zeros.
fn normal_frame<C: Real>(A: ScrewAxis<C>) -> (JointAxis<C>, SE3<C>) {
    let V = A.twist();
    let (axis, z, p) = if A.is_prismatic() {
        (JointAxis { a: C::zero(), b: C::one() }, V.v, Vec3::zero())
    } else {
        (JointAxis { a: C::one(), b: V.w.dot(V.v) }, V.w, V.w.cross(V.v))
    };
    let size = z.map(C::abs).0;
    let least = (1..3).fold(0, |least, i| if size[i] < size[least] { i } else { least });
    let mut e = [C::zero(); 3];
    e[least] = C::one();
    let x = Vec3(e) - z * z.0[least];
    let x = x * (C::one() / x.norm());
    let R = Mat3 { x, y: z.cross(x), z }.transpose();
    (axis, SE3 { R: SO3(R), p })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::Random;

    #[test]
    fn the_normal_frame_holds_the_screw_on_its_z_axis() {
        let mut random = Random(3);
        for k in 0..20 {
            let mut V = crate::Twist::from_array(random.array());
            if k % 3 == 0 {
                V.w = Vec3::zero();
            }
            let (A, _) = ScrewAxis::normalize(V).expect("a screw");
            let (axis, normal) = normal_frame(A);
            assert!(((normal.Ad() * axis.twist()) - A.twist()).norm() < 1e-14);
            assert!(SO3::from_matrix(normal.R.matrix()).is_ok());
        }
    }

    #[test]
    fn axes_of_the_link_give_exact_zeros() {
        for axis in [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0]] {
            let A = ScrewAxis::new(axis, [0.0; 3]).expect("unit");
            let entries = normal_frame(A).1.R.matrix().rows();
            assert!(entries.as_flattened().iter().all(|x| [0.0, 1.0, -1.0].contains(x)));
        }
    }
}

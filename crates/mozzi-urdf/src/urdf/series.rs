//! Replaces a joint of several axes by a series of joints of one degree of freedom, with massless links between them.
//!
//! Planar joint: the child slides in the plane normal to the axis, by x, then y, and turns about the normal n, by
//! theta. In the axes of the joint at 0, its frame is at x x̂ + y ŷ, turned by theta about n. x̂ is the joint frame's
//! x-axis projected onto the plane, or its y-axis if the normal is nearly parallel to x (|n_x| > 0.9); ŷ = n × x̂. With
//! the axis `0 0 1` these are the frame's own x and y.
//!
//! Universal joint: it turns about x, by rx, then about the rotated y-axis, by ry.

use crate::report::places::{Place, Places};
use crate::urdf::axis;
use mozzi::model::description::{Joint, JointKind, Link};
use mozzi::{Description, SE3, ScrewAxis, SpatialInertia, Vec3};

/// One of the joints: the suffix of its name, its motion, its damping.
pub(crate) struct Part {
    pub ending: &'static str,
    pub screw: ScrewAxis,
    pub damping: f64,
}

/// The slides along x̂ and ŷ, and the turn about the normal, which is a unit vector.
pub(crate) fn planar(normal: Vec3, damping: [f64; 3]) -> Option<Vec<Part>> {
    let along = if normal.0[0].abs() > 0.9 { [0.0, 1.0, 0.0] } else { [1.0, 0.0, 0.0] };
    let x = Vec3(along) - normal * normal.dot(Vec3(along));
    let parts = [("x", "prismatic", x), ("y", "prismatic", normal.cross(x)), ("theta", "revolute", normal)];
    series(&parts, &damping)
}

/// The turns about x and y.
pub(crate) fn universal(damping: f64) -> Option<Vec<Part>> {
    let axis = |i: usize| Vec3(core::array::from_fn(|k| f64::from(u8::from(k == i))));
    series(&[("rx", "revolute", axis(0)), ("ry", "revolute", axis(1))], &[damping; 2])
}

fn series(parts: &[(&'static str, &str, Vec3)], damping: &[f64]) -> Option<Vec<Part>> {
    let part = |(&(ending, kind, direction), &damping): (&(&'static str, &str, Vec3), &f64)| {
        Some(Part { ending, screw: axis::screw(kind, direction)?.0, damping })
    };
    parts.iter().zip(damping).map(part).collect()
}

/// Adds the joints `j.x`, `j.y` … of a joint `j`, and a link of the same name for each of them but the last.
pub(crate) fn add(joint: Joint, parts: &[Part], place: &Place, description: &mut Description, places: &mut Places) {
    let Joint { name, mut parent, child, mut origin, .. } = joint;
    for (i, Part { ending, screw, damping }) in parts.iter().enumerate() {
        let part = format!("{name}.{ending}");
        let is_last = i + 1 == parts.len();
        let moved = if is_last { child.clone() } else { part.clone() };
        let mut joint = Joint::new(&part, &parent, &moved, origin, JointKind::Screw(*screw));
        joint.damping = *damping;
        description.joints.push(joint);
        places.joints.push(place.clone());
        if !is_last {
            description.links.push(Link { name: moved.clone(), inertia: SpatialInertia::zero() });
            places.links.push(place.clone());
        }
        (parent, origin) = (moved, SE3::identity());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_axes_are_right_handed_and_in_the_plane() {
        for normal in
            [[0.0, 0.0, 1.0], [0.0, 0.0, -1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.6, 0.0, 0.8], [0.96, 0.28, 0.0]]
        {
            let n = Vec3(normal);
            let parts = planar(n, [0.0; 3]).expect("a plane");
            let [x, y, turn] = parts.as_slice() else { panic!("three joints") };
            let [x, y, turn] = [x, y, turn].map(|part| part.screw);
            let (x, y) = (x.twist().v, y.twist().v);
            assert!((x.cross(y) - n).norm() < 1e-15 && (turn.twist().w - n).norm() < 1e-15, "{normal:?}");
            assert!(x.dot(n).abs() < 1e-15);
        }
        let [x, y, _] = &planar(Vec3([0.0, 0.0, 1.0]), [0.0; 3]).expect("a plane")[..] else { panic!("three joints") };
        let (x, y) = (x.screw, y.screw);
        assert_eq!((x.twist().v.0, y.twist().v.0), ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0]));
    }
}

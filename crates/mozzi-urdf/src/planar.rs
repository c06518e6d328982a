//! A planar joint: three joints of one freedom, with massless links between.
//!
//! The child slides in the plane normal to the axis, by x, then y, and turns about the normal, by theta: in the axes of the joint
//! at 0 its frame is at x x̂ + y ŷ, turned by theta about n. Along x̂ is the joint frame's x-axis, projected onto the plane;
//! where the normal is nearly along that (|n_x| > 0.9), its y-axis. ŷ = n × x̂. With the axis `0 0 1` these are the frame's own x and y.

use crate::axis;
use crate::places::{Place, Places};
use mozzi::model::description::{Joint, JointKind, Link};
use mozzi::{Description, SE3, ScrewAxis, SpatialInertia, Vec3};

/// The joints of a planar joint, as they end its name.
const JOINTS: [&str; 3] = ["x", "y", "theta"];

/// The slides along x̂ and ŷ, and the turn about the normal, which is a unit vector.
pub(crate) fn screws(normal: Vec3) -> Option<[ScrewAxis; 3]> {
    let along = if normal.0[0].abs() > 0.9 { [0.0, 1.0, 0.0] } else { [1.0, 0.0, 0.0] };
    let x = Vec3(along) - normal * normal.dot(Vec3(along));
    let slide = |direction| Some(axis::screw("prismatic", direction)?.0);
    Some([slide(x)?, slide(normal.cross(x))?, axis::screw("revolute", normal)?.0])
}

/// Adds the joints `j.x`, `j.y` and `j.theta` of a planar joint `j`, and the links `j.x` and `j.y` that the slides move.
pub(crate) fn add(
    joint: Joint,
    screws: [ScrewAxis; 3],
    place: &Place,
    description: &mut Description,
    places: &mut Places,
) {
    let Joint { name, mut parent, child, mut origin, .. } = joint;
    for (which, screw) in JOINTS.into_iter().zip(screws) {
        let part = format!("{name}.{which}");
        let is_last = which == "theta";
        let moved = if is_last { child.clone() } else { part.clone() };
        description.joints.push(Joint::new(&part, &parent, &moved, origin, JointKind::Screw(screw)));
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
            let [x, y, turn] = screws(n).expect("a plane");
            let (x, y) = (x.twist().v, y.twist().v);
            assert!((x.cross(y) - n).norm() < 1e-15 && (turn.twist().w - n).norm() < 1e-15, "{normal:?}");
            assert!(x.dot(n).abs() < 1e-15);
        }
        let [x, y, _] = screws(Vec3([0.0, 0.0, 1.0])).expect("a plane");
        assert_eq!((x.twist().v.0, y.twist().v.0), ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0]));
    }
}

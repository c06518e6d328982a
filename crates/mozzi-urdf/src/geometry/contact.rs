//! Points of shapes that a plane can touch.

use super::vertices::mesh_corners;
use super::{Form, Shape, locate};
use crate::files;
use mozzi::model::description::{Joint, JointKind};
use mozzi::model::{ContactPoint, Support};
use mozzi::{Model, Vec3};
use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::{FRAC_PI_2, PI};
use std::path::{Path, PathBuf};

/// More contact points are left out: each costs time at every step.
const MOST_POINTS: usize = 100_000;
/// A larger mesh is refused.
const MOST_BYTES: u64 = 64 << 20;
/// Points of a cylinder's rim, from the lowest: it may stand on them.
const TURNS: [f64; 4] = [0.0, FRAC_PI_2, PI, 1.5 * PI];

/// The contact points of a robot's shapes, and the shapes that have none, each with the reason.
#[derive(Clone, Debug, Default)]
pub struct ShapeContacts {
    /// In the order of the shapes, named `LINK` or `LINK.k`.
    pub points: Vec<ContactPoint>,
    /// Shapes that planes do not touch.
    pub left_out: Vec<String>,
}

/// The coefficient of friction of a shape that has none.
pub const FRICTION: f64 = 0.7;

/// The points at which planes touch shapes, of links that move: the corners of boxes, spheres, the two ends of
/// capsules, four points of each rim of a cylinder, the lowest first, ellipsoids, and the extreme vertices of meshes
/// (STL and OBJ; of the 2,000 directions of a sphere, so at most that many). All get the restitution e and the friction
/// coefficient μ that is given, or else their own, or [`FRICTION`].
pub fn contact_points(
    model: &Model,
    shapes: &[Shape],
    robot_file: &Path,
    root: Option<&Path>,
    (mu, restitution): (Option<f64>, f64),
) -> ShapeContacts {
    let (mut found, mut meshes) = (ShapeContacts::default(), Meshes::new());
    let (mut counts, mut locked_out) = (BTreeMap::new(), 0);
    let theta = model.neutral_configuration::<f64>();
    let moves = |frame| model.body_jacobian(&theta, frame).is_ok_and(|J| J.matrix().amax() > 0.0);
    for shape in shapes.iter().filter(|shape| shape.touches) {
        let Some(frame) = model.frame(&shape.link).ok().filter(|&frame| moves(frame)) else { continue };
        let mu = mu.or(shape.friction).unwrap_or(FRICTION);
        let places = match supports(shape, robot_file, root, &mut meshes) {
            Ok(places) => places,
            Err(reason) => {
                found.left_out.push(format!("collision shape of `{}`: {reason}", shape.link));
                continue;
            }
        };
        if found.points.len() + places.len() > MOST_POINTS {
            locked_out += 1;
            continue;
        }
        for (center, support) in places {
            let count = counts.entry(&shape.link).or_insert(0_usize);
            let name = if *count == 0 { shape.link.clone() } else { format!("{}.{count}", shape.link) };
            *count += 1;
            found.points.push(ContactPoint { name, frame, center, support, mu, restitution });
        }
    }
    if locked_out > 0 {
        found.left_out.push(format!(
            "{locked_out} collision shapes: a robot has at most {MOST_POINTS} contact points, which cost time at every step"
        ));
    }
    found
}

/// The origins of the last links, for robots whose shapes cannot touch: of those behind a joint that is not fixed, if
/// there are any.
pub fn end_points(model: &Model, mu: f64, restitution: f64) -> Vec<ContactPoint> {
    let joints = &model.description().joints;
    let before: BTreeMap<&str, &Joint> = joints.iter().map(|joint| (joint.child.as_str(), joint)).collect();
    let parents: BTreeSet<&str> = joints.iter().map(|joint| joint.parent.as_str()).collect();
    let is_behind_joint = |link: &str| {
        let chain = std::iter::successors(before.get(link), |joint| before.get(joint.parent.as_str()));
        chain.take(joints.len()).any(|joint| joint.kind != JointKind::Fixed)
    };
    let links = model.description().links.iter().map(|link| link.name.as_str());
    let ends: Vec<&str> = links.filter(|name| !parents.contains(name)).collect();
    let moving: Vec<&str> = ends.iter().copied().filter(|link| is_behind_joint(link)).collect();
    let point = |name: &str| {
        let frame = model.frame(name).ok()?;
        Some(ContactPoint { restitution, ..ContactPoint::new(name, frame, Vec3::zero(), mu) })
    };
    if moving.is_empty() { ends } else { moving }.into_iter().filter_map(point).collect()
}

/// The extreme vertices of each file: several shapes may show it.
type Meshes = BTreeMap<PathBuf, Result<Vec<Vec3>, String>>;

fn read(path: &Path) -> Result<Vec<Vec3>, String> {
    let place = |error: &dyn std::fmt::Display| format!("{}: {error}", path.display());
    let bytes = files::read(path, MOST_BYTES).map_err(|error| place(&error))?;
    let format = path.extension().and_then(|ending| ending.to_str()).unwrap_or_default().to_ascii_lowercase();
    mesh_corners(&format, &bytes).map_err(|error| place(&error))
}

/// The points of one shape, in the frame of its link.
fn supports(
    shape: &Shape,
    robot_file: &Path,
    root: Option<&Path>,
    meshes: &mut Meshes,
) -> Result<Vec<(Vec3, Support)>, String> {
    let T = shape.T;
    let at = |x: f64, y: f64, z: f64| T * Vec3([x, y, z]);
    let axis = T.R * Vec3([0.0, 0.0, 1.0]);
    Ok(match &shape.form {
        Form::Box { size } => {
            let [x, y, z] = size.map(|edge| 0.5 * edge);
            let signs = [-1.0, 1.0];
            let corners = signs.iter().flat_map(|a| signs.iter().flat_map(move |b| signs.map(|c| (*a, *b, c))));
            corners.map(|(a, b, c)| (at(a * x, b * y, c * z), Support::Point)).collect()
        }
        Form::Sphere { radius } => vec![(T.p, Support::Sphere { radius: *radius })],
        Form::Capsule { radius, length } => {
            [-0.5, 0.5].map(|s| (at(0.0, 0.0, s * length), Support::Sphere { radius: *radius })).to_vec()
        }
        Form::Cylinder { radius, length } => {
            let rim = |s: f64, turn: f64| (at(0.0, 0.0, s * length), Support::Disc { axis, radius: *radius, turn });
            [-0.5, 0.5].into_iter().flat_map(|s| TURNS.map(|turn| rim(s, turn))).collect()
        }
        Form::Ellipsoid { radii } => vec![(T.p, Support::Ellipsoid { axes: T.R, radii: *radii })],
        Form::Mesh { file, scale } => {
            let path = locate(robot_file, file, root).map_err(|error| error.to_string())?;
            let vertices = meshes.entry(path).or_insert_with_key(|path| read(path)).clone()?;
            let place = |v: Vec3| at(v.0[0] * scale[0], v.0[1] * scale[1], v.0[2] * scale[2]);
            vertices.into_iter().map(|v| (place(v), Support::Point)).collect()
        }
    })
}

#[cfg(test)]
mod tests {
    use super::super::parse;
    use super::*;

    const ROBOT: &str = r#"<robot name="foot">
  <link name="base"/>
  <link name="foot">
    <inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><origin xyz="0 0 0.5"/><geometry><box size="1 2 3"/></geometry></collision>
    <collision><geometry><sphere radius="0.1"/></geometry></collision>
    <collision><origin rpy="1.5707963267948966 0 0"/><geometry><cylinder radius="0.2" length="1"/></geometry></collision>
    <collision><geometry><capsule radius="0.3" length="2"/></geometry></collision>
    <collision><geometry><mesh filename="nowhere.stl"/></geometry></collision>
    <visual><geometry><sphere radius="9"/></geometry></visual>
  </link>
  <joint name="j" type="revolute"><parent link="base"/><child link="foot"/><limit effort="1" velocity="1"/></joint>
</robot>"#;

    #[test]
    fn shapes_have_points_of_support() {
        let model = crate::parse("foot.urdf", ROBOT).expect("sound").description.build().expect("sound");
        let shapes = parse("foot.urdf", ROBOT).shapes;
        let found = contact_points(&model, &shapes, Path::new("foot.urdf"), None, (Some(0.5), 0.1));
        assert_eq!(found.points.len(), 8 + 1 + 8 + 2);
        assert!(found.points.iter().all(|point| point.mu == 0.5 && point.restitution == 0.1));
        assert_eq!((&*found.points[0].name, &*found.points[3].name), ("foot", "foot.3"));
        // the farthest down: the capsule's lower end at −1.3, the box at −1, the lying cylinder at −0.2
        let contacts = mozzi_sim::Contacts { points: found.points, planes: vec![mozzi_sim::Plane::ground()] };
        let gaps = contacts.gaps(&model, 0.0, &[0.0]);
        let lowest = |range: std::ops::Range<usize>| gaps[range].iter().fold(f64::INFINITY, |a, b| a.min(*b));
        for (range, z) in [(0..8, -1.0), (8..9, -0.1), (9..17, -0.2), (17..19, -1.3)] {
            assert!((lowest(range.clone()) - z).abs() < 1e-12, "{range:?} {gaps:?}");
        }
        assert!(found.left_out.len() == 1 && found.left_out[0].contains("nowhere.stl"), "{:?}", found.left_out);
    }
}

//! A robot's constants in the base frame at home, with all joints at 0: two libraries can compare these whatever link
//! frames they use.

use crate::compare::Result;
use mozzi::model::description::{Joint, JointKind};
use mozzi::{Description, Place, SE3, SpatialInertia, Sym3, Vec3};
use std::collections::BTreeMap;

/// A joint, and the body that it moves, including all links fixed to it.
#[derive(Clone, Debug)]
pub struct JointConstants {
    /// The name in mozzi.
    pub name: String,
    /// The name in the library.
    pub called: String,
    /// The parent joint.
    pub parent: Option<usize>,
    /// The numbers of its positions and of its velocities.
    pub nq: usize,
    pub nv: usize,
    /// Its screw axes, one for each velocity: (ω, v). Zeros for a joint of several velocities, here and in MuJoCo.
    pub axes: Vec<[f64; 6]>,
    pub body: SpatialInertia,
    pub armature: f64,
    pub damping: f64,
    pub friction: f64,
    /// 0 for a library, whose springs are reported by their forces.
    pub stiffness: f64,
}

#[derive(Clone, Debug)]
pub struct Constants {
    pub joints: Vec<JointConstants>,
    pub gravity: [f64; 3],
}

/// The robot with independent mimic joints.
pub fn freed(robot: &Description) -> Description {
    let mut robot = robot.clone();
    robot.joints.iter_mut().for_each(|joint| joint.mimic = None);
    robot
}

/// Each link's pose with every joint, including mimic joints, at 0, and a floating base at {s}.
pub fn home(robot: &Description) -> Result<BTreeMap<String, SE3>> {
    let model = freed(robot).build()?;
    let poses = model.frame_poses(&model.neutral_configuration::<f64>())?;
    Ok(model.frames().zip(poses).map(|((_, name), T)| (name.to_string(), T)).collect())
}

impl Constants {
    pub fn of(robot: &Description) -> Result<Self> {
        let (model, home) = (freed(robot).build()?, home(robot)?);
        let inertia: BTreeMap<&str, SpatialInertia> =
            robot.links.iter().map(|link| (link.name.as_str(), link.inertia)).collect();
        let moving: Vec<&Joint> = model.moving_joints().collect();
        let up: BTreeMap<&str, &Joint> = robot.joints.iter().map(|joint| (joint.child.as_str(), joint)).collect();
        let carrier = |joint: &Joint| {
            let mut link = joint.parent.as_str();
            loop {
                if let Some(k) = moving.iter().position(|joint| joint.child == link) {
                    return Some(k);
                }
                link = &up.get(link)?.parent;
            }
        };
        let bodies = model.folded_links();
        let joint = |((joint, body), place): ((&&Joint, &mozzi::model::FoldedBody), &Place)| {
            let freedom = place.freedom;
            let sum = (body.links.iter())
                .fold(SpatialInertia::zero(), |sum, (link, _)| sum + inertia[link].transformed(home[*link]));
            let axis = match joint.kind {
                JointKind::Screw(A) => A.transformed(home[&joint.child]).twist().to_array(),
                _ => [0.0; 6],
            };
            JointConstants {
                name: joint.name.clone(),
                called: joint.name.clone(),
                parent: carrier(joint),
                nq: freedom.positions(),
                nv: freedom.velocities(),
                axes: vec![axis; freedom.velocities()],
                body: sum,
                armature: joint.armature,
                damping: joint.damping,
                friction: joint.friction,
                stiffness: joint.stiffness,
            }
        };
        let joints = moving.iter().zip(&bodies[1..]).zip(model.places()).map(joint).collect();
        Ok(Constants { joints, gravity: robot.gravity })
    }

    pub fn joint(&self, name: &str) -> Option<&JointConstants> {
        self.joints.iter().find(|joint| joint.name == name)
    }
}

/// A body: its mass, its centre of mass and the inertia about it, along the base's axes.
pub fn body(mass: f64, center: [f64; 3], inertia: [[f64; 3]; 3]) -> SpatialInertia {
    SpatialInertia::new(mass, Vec3(center), Sym3::symmetric_part(mozzi::Mat3::from_rows(inertia)))
}

/// True if these bodies agree to the digits that a file has.
pub fn same_body(a: &SpatialInertia, b: &SpatialInertia) -> bool {
    let (rows, others) = (a.to_matrix(), b.to_matrix());
    let size = |r: usize, c: usize| {
        let block = |k: usize| if k < 3 { 0..3 } else { 3..6 };
        let entries = block(r).flat_map(|i| block(c).map(move |j| (i, j)));
        entries.fold(0.0_f64, |m, (i, j)| m.max(rows[i][j].abs()).max(others[i][j].abs()))
    };
    (0..6).all(|r| (0..6).all(|c| (rows[r][c] - others[r][c]).abs() <= 1e-9 * size(r, c)))
}

//! Why a goal cannot be reached, in words: a direction in which no joint moves the frame, or an arm that is too short.

use super::bounds::Within;
use super::{Goal, InverseKinematics};
use mozzi::model::integrate;
use mozzi::nalgebra::{Matrix3, Vector3};
use mozzi::{FrameId, Model, SO3, Vec3};

/// Configurations that show in which directions a frame can move.
const SAMPLES: usize = 6;
/// A direction of so small a part of the motion (squared) is none.
const STILL: f64 = 1e-20;
/// A goal this far off is not reached, m or rad.
const OFF: f64 = 1e-6;

impl InverseKinematics<'_> {
    /// Why no positions reach this goal, as far as the robot's shape shows it. `theta` is the best that was found. It
    /// takes some thousand forward kinematics.
    pub fn why_not(&self, goal: Goal, theta: &[f64]) -> Option<String> {
        let (model, frame) = (self.model, self.frame);
        still_direction(model, frame, goal, theta).or_else(|| self.too_far(goal, theta)).or_else(|| {
            let n = model.n();
            let is_pose = matches!(goal, Goal::Pose(_));
            (is_pose && n < 6)
                .then(|| format!("{n} joints reach few poses: a position and an orientation are six conditions"))
        })
    }

    /// The arm's reach from the first joint's axis, and the goal's distance.
    fn too_far(&self, goal: Goal, theta: &[f64]) -> Option<String> {
        let goal = position(goal)?;
        let shoulder = shoulder(self.model, self.frame, theta)?;
        let reach = self.reach(shoulder, theta)?;
        let distance = (goal - shoulder).norm();
        let [x, y, z] = shoulder.0.map(short);
        (distance > reach + OFF).then(|| {
            format!(
                "the goal is {} m out of reach: it is {} m from the shoulder at ({x}, {y}, {z}), the arm reaches {} m",
                short(distance - reach),
                short(distance),
                short(reach)
            )
        })
    }

    /// The largest distance of the frame from a point within the joints' limits: joint by joint, from several starts.
    fn reach(&self, from: Vec3, theta: &[f64]) -> Option<f64> {
        let distance = |theta: &[f64]| {
            let T = self.model.forward_kinematics(theta, self.frame).ok()?;
            Some((T.p - from).norm())
        };
        let mut most = distance(theta)?;
        for start in 0..4 {
            let mut at = moved(self.model, theta, start);
            for _ in 0..4 {
                for k in 0..self.bounds.joints.len() {
                    let [low, high] = self.bounds.joints[k];
                    if !self.bounds.turns[k] && (high - low).is_infinite() {
                        return None; // an endless slide reaches everything
                    }
                    at = self.farthest(&at, k, &distance)?;
                }
            }
            most = most.max(distance(&at)?);
        }
        Some(most)
    }

    /// θ with the joint's position that is farthest, by a grid that becomes finer.
    fn farthest(&self, theta: &[f64], k: usize, distance: &dyn Fn(&[f64]) -> Option<f64>) -> Option<Vec<f64>> {
        let place = self.bounds.places[k].positions();
        if place.len() != 1 {
            return Some(theta.to_vec()); // a ball at the tip does not change the reach
        }
        let [low, high] = self.bounds.range(k, theta[place.start]);
        let (mut best, mut at) = (theta.to_vec(), theta.to_vec());
        let mut most = distance(theta)?;
        let (mut center, mut width) = (0.5 * (low + high), 0.5 * (high - low));
        for _ in 0..6 {
            for step in -4..=4 {
                at[place.start] = (center + width * f64::from(step) / 4.0).clamp(low, high);
                let found = distance(&at)?;
                if found > most {
                    (most, best) = (found, at.clone());
                }
            }
            (center, width) = (best[place.start], width / 4.0);
        }
        Some(best)
    }
}

/// θ moved by a fixed pattern, other for each sample.
fn moved(model: &Model, theta: &[f64], sample: usize) -> Vec<f64> {
    let step: Vec<f64> = (0..model.n()).map(|j| (1.7 * (sample * (j + 3)) as f64).sin()).collect();
    let mut found = theta.to_vec();
    integrate(model, &mut found, &step, 1.0);
    found
}

/// The point of the first joint's axis that is nearest to the second's; `None` if the first joint is not revolute.
fn shoulder(model: &Model, frame: FrameId, theta: &[f64]) -> Option<Vec3> {
    if model.is_floating() || model.joints().next()?.kind.name() != "revolute" {
        return None;
    }
    let J = model.space_jacobian(theta, frame).ok()?;
    let axes: Vec<(Vec3, Vec3)> = J.0.iter().map(|column| (column.w, column.v)).collect();
    let (w, v) = *axes.first()?;
    let point = w.cross(v);
    let Some((w2, v2)) = axes.get(1).filter(|(w2, _)| w.cross(*w2).norm() > 1e-6) else { return Some(point) };
    // p + s w nearest to the line of the second axis
    let (between, across) = (w2.cross(*v2) - point, w.cross(*w2));
    let s = between.cross(*w2).dot(across) / across.dot(across);
    Some(point + w * s)
}

pub(super) fn position(goal: Goal) -> Option<Vec3> {
    match goal {
        Goal::Pose(T) => Some(T.p),
        Goal::Position(p) => Some(p),
        Goal::Orientation(_) => None,
    }
}

fn orientation(goal: Goal) -> Option<SO3> {
    match goal {
        Goal::Pose(T) => Some(T.R),
        Goal::Orientation(R) => Some(R),
        Goal::Position(_) => None,
    }
}

/// A direction of {s} in which no joint moves the frame's origin, or about which none turns it, if the goal needs it.
fn still_direction(model: &Model, frame: FrameId, goal: Goal, theta: &[f64]) -> Option<String> {
    let name = model.frame_name(frame);
    let (mut moves, mut turns) = (Matrix3::zeros(), Matrix3::zeros());
    for sample in 0..SAMPLES {
        let theta = moved(model, theta, sample);
        let T = model.forward_kinematics(&theta, frame).ok()?;
        for column in &model.body_jacobian(&theta, frame).ok()?.0 {
            let [w, v] = [column.w, column.v].map(|x| Vector3::from((T.R * x).0));
            moves += v * v.transpose();
            turns += w * w.transpose();
        }
    }
    let T = model.forward_kinematics(theta, frame).ok()?;
    if let Some(goal) = position(goal) {
        for axis in still_axes(&moves) {
            let [now, wanted] = [T.p, goal].map(|p| axis.dot(&Vector3::from(p.0)));
            if (wanted - now).abs() > OFF {
                let (label, now, wanted) = (label(&axis), short(now), short(wanted));
                return Some(format!(
                    "no joint moves `{name}` along {label}: it stays at {label} = {now} m, and the goal is at {wanted} m"
                ));
            }
        }
    }
    if let Some(goal) = orientation(goal) {
        let turn = Vector3::from((goal * T.R.inverse()).log().0);
        let still = still_axes(&turns);
        let off = still.iter().map(|axis| axis.dot(&turn).abs()).fold(0.0, f64::max);
        if off > OFF && !still.is_empty() {
            let labels: Vec<String> = still.iter().map(label).collect();
            return Some(format!(
                "no joint turns `{name}` about {}: the goal's orientation cannot be reached; --position alone may be",
                labels.join(" and ")
            ));
        }
    }
    None
}

/// The eigenvectors of the smallest eigenvalues; along the axes of {s} if those are among them.
fn still_axes(sum: &Matrix3<f64>) -> Vec<Vector3<f64>> {
    let eigen = sum.symmetric_eigen();
    let most = eigen.eigenvalues.max().max(f64::MIN_POSITIVE);
    let is_still = |axis: &Vector3<f64>| (axis.transpose() * sum * axis)[0] <= STILL.max(1e-18) * most;
    let own = (0..3).map(|k| Vector3::ith(k, 1.0)).filter(is_still).collect::<Vec<_>>();
    let still: Vec<Vector3<f64>> = eigen.eigenvectors.column_iter().map(|c| c.into_owned()).filter(is_still).collect();
    if own.len() == still.len() { own } else { still }
}

/// "z", or the components of another direction.
fn label(axis: &Vector3<f64>) -> String {
    match (0..3).find(|&k| axis[k].abs() > 1.0 - 1e-9) {
        Some(k) => ["x", "y", "z"][k].to_string(),
        None => format!("({}, {}, {})", short(axis[0]), short(axis[1]), short(axis[2])),
    }
}

/// Three decimals without zeros at the end.
fn short(x: f64) -> String {
    let text = format!("{x:.3}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_string() } else { text.to_string() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use mozzi::SE3;

    fn why(robot: &str, goal: Goal) -> Option<String> {
        let model = mozzi_urdf::open(robot).expect("embedded").build().expect("sound");
        let solver = InverseKinematics::new(&model, model.end_effector().expect("one")).expect("sound");
        solver.why_not(goal, &model.start().theta)
    }

    #[test]
    fn a_short_arm_is_told_with_its_reach() {
        let told = why("ur5", Goal::Position(Vec3([1.5, 0.0, 0.089]))).expect("a reason");
        assert!(told.contains("out of reach") && told.contains("the arm reaches 0.9"), "{told}");
        assert_eq!(why("ur5", Goal::Position(Vec3([0.4, 0.2, 0.3]))), None);
    }

    #[test]
    fn limits_beyond_half_a_turn_have_a_reach() {
        let mut robot = mozzi_urdf::open("ur5").expect("embedded").description;
        robot.joints.iter_mut().filter(|joint| joint.limits.position.is_some()).for_each(|joint| {
            joint.limits.position = Some([3.5, 6.0]);
        });
        let model = robot.build().expect("sound");
        let solver = InverseKinematics::new(&model, model.end_effector().expect("one")).expect("sound");
        let why = solver.why_not(Goal::Position(Vec3([2.0, 2.0, 2.0])), &[4.0; 6]).expect("a reason");
        assert!(why.contains("out of reach"), "{why}");
    }

    #[test]
    fn a_planar_arm_stays_in_its_plane() {
        let told = why("two_link_planar", Goal::Position(Vec3([0.5, 0.5, 0.5]))).expect("a reason");
        assert!(told.contains("no joint moves") && told.contains("along"), "{told}");
        let turned = SE3::new(SO3::from_rpy(0.3, 0.4, 0.5), Vec3([0.0; 3]));
        let told = why("two_link_planar", Goal::Orientation(turned.R)).expect("a reason");
        assert!(told.contains("no joint turns"), "{told}");
    }
}

//! The robot as the page reads it: each body in the frame of its link in the file.

use crate::drawing::Drawing;
use mozzi::model::description::{JointKind, Source};
use mozzi::{Error, Model, SE3, Twist};
use serde_json::{Value, json};

/// Body 0 is the base, body k the k-th moving link.
pub fn to_json(model: &Model, drawing: &Drawing) -> Result<Value, Error> {
    let folded = model.folded_links();
    let body_of = |link: &str| folded.iter().position(|body| body.links.iter().any(|(name, _)| *name == link));
    let poses = model.frame_poses(&model.neutral_configuration())?;
    let frames: Vec<&str> = model.frames().map(|(_, name)| name).collect();
    let frame_of = |name: &str| frames.iter().position(|known| *known == name);
    // where each body's own link is when all joints are at 0
    let home =
        |k: usize| folded[k].links.first().and_then(|(link, _)| frame_of(link)).map_or(SE3::identity(), |f| poses[f]);

    let links = model.description().links.len();
    let carrier = |k: usize, name: &str| {
        let further = k.checked_sub(links).map(|k| model.description().frames[k].link.as_str());
        body_of(further.unwrap_or(name)).unwrap_or(0)
    };
    let named: Value = (frames.iter().enumerate())
        .map(|(k, name)| {
            let body = carrier(k, name);
            json!({ "name": name, "body": body, "T": rows(home(body).inverse() * poses[k]) })
        })
        .collect();

    let (parameters, names) = (model.parameters(), model.parameter_names());
    let is_floating = model.is_floating();
    let mut inertias = parameters.chunks(10);
    let base_inertia = match is_floating {
        true => inertias.next().map(<[f64]>::to_vec).unwrap_or_default(),
        false => model.base_inertia().to_parameters().to_vec(),
    };
    let of_joints = names.iter().zip(&parameters).filter(|(name, _)| name.ends_with(".armature")).map(|(_, &x)| x);
    let armature: Vec<f64> = std::iter::repeat_n(0.0, model.base().velocities()).chain(of_joints).collect();
    let joints = model.moving_joints().zip(model.sources());
    let bodies: Value = (joints.zip(inertias).enumerate())
        .map(|(k, ((joint, Source { joint: j, ratio, offset }), inertia))| {
            let parent = body_of(&joint.parent).unwrap_or(0);
            let A = match joint.kind {
                JointKind::Screw(A) => A.twist(),
                _ => Twist::from_array([0.0; 6]), // of a ball and a free joint its kind and its quaternion tell
            };
            let M = home(parent).inverse() * home(k + 1) * SE3::exp(A * -offset);
            json!({
                "name": folded[k + 1].links.first().map(|(name, _)| name), "joint": joint.name, "kind": joint.kind.name(),
                "parent": parent, "M": rows(M), "A": A.to_array(), "ratio": ratio, "offset": offset,
                "q": j + model.base().positions(), "j": j + model.base().velocities(), "inertia": inertia,
            })
        })
        .collect();

    Ok(json!({
        "name": model.description().name,
        "base": if is_floating { "floating" } else { "fixed" },
        "baseName": folded[0].links.first().map(|(name, _)| name),
        "gravity": model.gravity().0,
        "positions": model.position_names().collect::<Vec<_>>(),
        "velocities": model.velocity_names().collect::<Vec<_>>(),
        "slides": model.joints().map(|joint| joint.kind.name() == "prismatic").collect::<Vec<_>>(),
        "limits": model.joints().map(|joint| joint.limits.position).collect::<Vec<_>>(),
        "bodies": bodies,
        "baseInertia": base_inertia,
        "armature": armature,
        "frames": named,
        "endEffector": model.end_effector().ok().and_then(|frame| frame_of(model.frame_name(frame))),
        "shapes": drawing.shapes_to_json(&|link| frame_of(link)),
    }))
}

/// The first three rows of a configuration's matrix.
pub fn rows(T: SE3) -> Vec<f64> {
    T.to_matrix()[..3].concat()
}

#[cfg(test)]
mod tests {
    use super::*;
    use mozzi::Model;

    fn numbers(value: &Value) -> Vec<f64> {
        value.as_array().expect("a list").iter().map(|x| x.as_f64().expect("a number")).collect()
    }

    fn pose(value: &Value) -> SE3 {
        let x = numbers(value);
        let row = |r: usize| [x[4 * r], x[4 * r + 1], x[4 * r + 2], x[4 * r + 3]];
        SE3::from_matrix([row(0), row(1), row(2), [0.0, 0.0, 0.0, 1.0]]).expect("a configuration")
    }

    /// Poses from what the page is told alone, by the product of exponentials.
    fn poses(robot: &Value, theta: &[f64], base: SE3) -> Vec<SE3> {
        let mut T = vec![base];
        for body in robot["bodies"].as_array().expect("bodies") {
            let [parent, q] = [&body["parent"], &body["q"]].map(|x| x.as_u64().expect("a place") as usize);
            let [ratio, offset] = [&body["ratio"], &body["offset"]].map(|x| x.as_f64().expect("a number"));
            let A = Twist::from_array(numbers(&body["A"]).try_into().expect("six"));
            T.push(T[parent] * pose(&body["M"]) * SE3::exp(A * (ratio * theta[q] + offset)));
        }
        let frames = robot["frames"].as_array().expect("frames");
        frames.iter().map(|f| T[f["body"].as_u64().expect("a place") as usize] * pose(&f["T"])).collect()
    }

    #[test]
    fn the_page_is_told_all_that_moves() {
        let mimic_joint = include_str!("../../../oracles/test_tree.urdf");
        let tree = mozzi_urdf::parse("test_tree.urdf", mimic_joint).expect("sound").description;
        let open = |name| mozzi_urdf::open(name).expect("embedded").description;
        for description in [open("ur5"), open("panda"), tree, open("anymal").floating()] {
            let model: Model = description.build().expect("sound");
            let robot = to_json(&model, &Drawing::default()).expect("a robot");
            let theta: Vec<f64> = (0..model.nq()).map(|k| 0.3 + 0.17 * k as f64).collect();
            let base = match model.is_floating() {
                true => SE3::from_pose([0.3, 0.47, 0.64, 0.81, theta[4], theta[5], theta[6]]),
                false => SE3::identity(),
            };
            let mut theta = theta;
            if model.is_floating() {
                let size = theta[..4].iter().map(|x| x * x).sum::<f64>().sqrt();
                theta[..4].iter_mut().for_each(|x| *x /= size);
            }
            let (found, expected) = (poses(&robot, &theta, base), model.frame_poses(&theta).expect("poses"));
            for (found, expected) in found.iter().zip(&expected) {
                let apart = (found.inverse() * *expected).log().to_array();
                assert!(apart.iter().all(|x| x.abs() < 1e-12), "{} {apart:?}", model.description().name);
            }
            let bodies = robot["bodies"].as_array().expect("bodies");
            let mass: f64 = bodies.iter().map(|body| numbers(&body["inertia"])[0]).sum();
            let of_base = if model.is_floating() { numbers(&robot["baseInertia"])[0] } else { 0.0 };
            assert!((mass + of_base - model.mass()).abs() < 1e-12 * model.mass());
            assert_eq!(numbers(&robot["armature"]).len(), model.n());
        }
    }
}

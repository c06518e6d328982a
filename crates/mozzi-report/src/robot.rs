//! The robot in the form that the page reads: each body in the frame of its link in the file.

use crate::drawing::Drawing;
use mozzi::model::description::{Anchor, ConstraintKind, JointKind, Source};
use mozzi::{Error, Model, SE3, Twist};
use serde_json::{Value, json};

/// Body 0 is the base, body k the k-th moving link.
pub fn to_json(model: &Model, drawing: &Drawing) -> Result<Value, Error> {
    let folded = model.folded_links();
    let body_of = |link: &str| folded.iter().position(|body| body.links.iter().any(|(name, _)| *name == link));
    let poses = model.frame_poses(&model.neutral_configuration())?;
    let frames: Vec<&str> = model.frames().map(|(_, name)| name).collect();
    let frame_of = |name: &str| frames.iter().position(|known| *known == name);
    // the pose of each body's own link with all joints at 0
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

    // the body of each anchor, and its point in that body; none for {s}
    let anchor = |anchor: &Anchor| match &anchor.frame {
        None => json!({ "body": null, "p": anchor.T.p.0 }),
        Some(name) => {
            let k = frame_of(name).unwrap_or(0);
            let body = carrier(k, name);
            json!({ "body": body, "p": (home(body).inverse() * poses[k] * anchor.T).p.0 })
        }
    };
    let constraints = model.constraints().iter().filter_map(|constraint| match &constraint.kind {
        ConstraintKind::Frames { a, b, .. } => Some(json!({ "name": constraint.name, "a": anchor(a), "b": anchor(b) })),
        ConstraintKind::Joint { .. } => None,
    });
    let constraints: Value = constraints.collect();

    // ten numbers for each body, followed by those of the joints
    let parameters = model.parameters();
    let is_floating = model.is_floating();
    let mut inertias = parameters.chunks(10);
    let base_inertia = match is_floating {
        true => inertias.next().map(<[f64]>::to_vec).unwrap_or_default(),
        false => model.base_inertia().to_parameters().to_vec(),
    };
    let moving = model.moving_joints().zip(model.sources());
    let bodies: Value = (moving.zip(inertias).enumerate())
        .map(|(k, ((joint, Source { joint: source, ratio, offset }), inertia))| {
            let parent = body_of(&joint.parent).unwrap_or(0);
            let (A, center) = match joint.kind {
                JointKind::Screw(A) => (Some(A.twist()), None),
                JointKind::Ball(center) => (None, Some(center.0)),
                JointKind::Free | JointKind::Fixed => (None, None),
            };
            let at_zero = A.map_or(SE3::identity(), |A| SE3::exp(A * -offset));
            let M = home(parent).inverse() * home(k + 1) * at_zero;
            let place = model.places()[source];
            json!({
                "name": folded[k + 1].links.first().map(|(name, _)| name), "joint": joint.name, "kind": joint.kind.name(),
                "parent": parent, "M": rows(M), "A": A.map(Twist::to_array), "center": center, "ratio": ratio, "offset": offset,
                "q": place.q, "j": place.j, "inertia": inertia,
            })
        })
        .collect();
    let joints: Value = (model.joints().zip(model.places()))
        .map(|(joint, place)| {
            json!({ "name": joint.name, "kind": joint.kind.name(), "q": place.q, "j": place.j, "limits": joint.limits.position })
        })
        .collect();

    let armature = model.armature_matrix();
    let states = model.state_names().map(|name| Ok(json!({ "name": name, "theta": model.state(name)?.theta })));
    Ok(json!({
        "name": model.description().name,
        "states": states.collect::<Result<Value, Error>>()?,
        "start": model.start().theta,
        "base": if is_floating { "floating" } else { "fixed" },
        "baseName": folded[0].links.first().map(|(name, _)| name),
        "gravity": model.gravity().0,
        "positions": model.position_names().collect::<Vec<_>>(),
        "velocities": model.velocity_names().collect::<Vec<_>>(),
        "joints": joints,
        "bodies": bodies,
        "baseInertia": base_inertia,
        "armature": armature.row_iter().map(|row| row.iter().copied().collect()).collect::<Vec<Vec<f64>>>(),
        "constraints": constraints,
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
    use mozzi::model::State;
    use mozzi::{Model, Vec3};

    fn numbers(value: &Value) -> Vec<f64> {
        value.as_array().expect("a list").iter().map(|x| x.as_f64().expect("a number")).collect()
    }

    fn pose(value: &Value) -> SE3 {
        let x = numbers(value);
        let row = |r: usize| [x[4 * r], x[4 * r + 1], x[4 * r + 2], x[4 * r + 3]];
        SE3::from_matrix([row(0), row(1), row(2), [0.0, 0.0, 0.0, 1.0]]).expect("a configuration")
    }

    /// A unit quaternion and an origin.
    fn posed(theta: &[f64], p: Vec3) -> SE3 {
        SE3::from_pose([theta[0], theta[1], theta[2], theta[3], p.0[0], p.0[1], p.0[2]])
    }

    /// Poses from the page's data alone, by the product of exponentials.
    fn poses(robot: &Value, theta: &[f64]) -> Vec<SE3> {
        let is_floating = robot["base"] == "floating";
        let mut T =
            vec![if is_floating { posed(theta, Vec3([theta[4], theta[5], theta[6]])) } else { SE3::identity() }];
        for body in robot["bodies"].as_array().expect("bodies") {
            let [parent, q] = [&body["parent"], &body["q"]].map(|x| x.as_u64().expect("a place") as usize);
            let [ratio, offset] = [&body["ratio"], &body["offset"]].map(|x| x.as_f64().expect("a number"));
            let moved = match body["kind"].as_str() {
                Some("free") => posed(&theta[q..], Vec3([theta[q + 4], theta[q + 5], theta[q + 6]])),
                Some("ball") => {
                    let center = numbers(&body["center"]).try_into().expect("three");
                    SE3::translation(center) * posed(&theta[q..], Vec3::zero()) * SE3::translation(center).inverse()
                }
                _ => {
                    let A = Twist::from_array(numbers(&body["A"]).try_into().expect("six"));
                    SE3::exp(A * (ratio * theta[q] + offset))
                }
            };
            T.push(T[parent] * pose(&body["M"]) * moved);
        }
        let frames = robot["frames"].as_array().expect("frames");
        frames.iter().map(|f| T[f["body"].as_u64().expect("a place") as usize] * pose(&f["T"])).collect()
    }

    #[test]
    fn the_page_is_told_all_that_moves() {
        let mimic_joint = include_str!("../../../oracles/test_tree.urdf");
        let tree = mozzi_urdf::parse("test_tree.urdf", mimic_joint).expect("sound").description;
        let open = |name| mozzi_urdf::open(name).expect("embedded").description;
        let balls = crate::testing::balls();
        let models = [open("ur5"), open("panda"), tree, open("anymal").floating(), balls.clone(), balls.floating()];
        for description in models {
            let model: Model = description.build().expect("sound");
            let theta = crate::testing::configuration(&model);
            let state = State { time: 0.0, theta: theta.clone(), dtheta: vec![0.0; model.n()] };
            let model = model.with_state("home", &state).expect("sound");
            let robot = to_json(&model, &Drawing::default()).expect("a robot");
            assert_eq!(numbers(&robot["start"]), model.start().theta);
            let home = robot["states"].as_array().and_then(|states| states.last()).expect("a state");
            assert_eq!((&home["name"], numbers(&home["theta"])), (&json!("home"), theta.clone()));
            let (found, expected) = (poses(&robot, &theta), model.frame_poses(&theta).expect("poses"));
            for (found, expected) in found.iter().zip(&expected) {
                let apart = (found.inverse() * *expected).log().to_array();
                assert!(apart.iter().all(|x| x.abs() < 1e-12), "{} {apart:?}", model.description().name);
            }
            let bodies = robot["bodies"].as_array().expect("bodies");
            let mass: f64 = bodies.iter().map(|body| numbers(&body["inertia"])[0]).sum();
            let of_base = if model.is_floating() { numbers(&robot["baseInertia"])[0] } else { 0.0 };
            assert!((mass + of_base - model.mass()).abs() < 1e-12 * model.mass());
            // M without its links is only the armature
            let massless: Vec<f64> = (model.parameters().iter().zip(model.parameter_names()))
                .map(|(&x, name)| if name.ends_with(".armature") { x } else { 0.0 })
                .collect();
            let M = model.with_parameters(&massless).mass_matrix(&theta).expect("M");
            let rows = robot["armature"].as_array().expect("rows");
            assert_eq!(rows.iter().flat_map(numbers).collect::<Vec<f64>>(), M.transpose().as_slice());
            for (joint, place) in robot["joints"].as_array().expect("joints").iter().zip(model.places()) {
                let name = joint["name"].as_str().expect("a name");
                let [q, j] = ["q", "j"].map(|key| joint[key].as_u64().expect("a place") as usize);
                assert_eq!((q, j), (place.q, place.j));
                assert!(model.position_names().nth(q).is_some_and(|known| known.starts_with(name)));
                assert!(model.velocity_names().nth(j).is_some_and(|known| known.starts_with(name)));
            }
        }
    }
}

//! Everything about a robot that does not depend on its state, in the form that the page reads.

use crate::bodies::Bodies;
use crate::drawn;
use mozzi::model::description::{Anchor, ConstraintKind, Joint, JointKind};
use mozzi::nalgebra::Matrix3;
use mozzi::quantities::{INPUTS, LIST, Of};
use mozzi::{Error, Model, SE3, SpatialInertia, Sym3, Vec3};
use serde_json::{Value, json};

/// Body 0 is the base, body k the k-th moving link, each in the frame of its link in the file.
pub fn about(model: &Model, bodies: &Bodies, inputs: &[Vec<f64>]) -> Result<Value, Error> {
    let poses = model.frame_poses(&model.neutral_configuration())?;
    let frames: Vec<&str> = model.frames().map(|(_, name)| name).collect();
    let frame_of = |name: &str| frames.iter().position(|known| *known == name);
    // the pose of each body's own link with all joints at 0
    let home = |k: usize| frame_of(&bodies.names[k]).map_or(SE3::identity(), |place| poses[place]);
    let named: Value = (frames.iter().zip(&poses))
        .map(|(name, T)| {
            let body = bodies.of_frame(model, name);
            json!({ "name": name, "body": body, "p": (home(body).inverse() * *T).p.0 })
        })
        .collect();

    let body = |k: usize, joint: Option<&Joint>| {
        let parent = joint.map(|joint| bodies.of_frame(model, &joint.parent));
        let at = parent.map(|parent| (home(parent).inverse() * home(k) * bodies.points[k]).0);
        json!({
            "name": bodies.names[k], "frame": frame_of(&bodies.names[k]), "parent": parent, "at": at,
            "joint": joint.map(|joint| &joint.name), "kind": joint.map(|joint| joint.kind.name()),
            "point": bodies.points[k].0, "lines": joint.map_or_else(Vec::new, |joint| lines(joint.kind)),
            "center": bodies.inertias[k].center_of_mass().0, "ellipsoid": ellipsoid(&bodies.inertias[k]),
        })
    };
    let places: Vec<_> = model.sources().map(|source| model.places()[source.joint].j).collect();
    let moving = model.moving_joints().zip(places).enumerate();
    let moving: Vec<Value> = (moving.map(|(k, (joint, j))| {
        let mut body = body(k + 1, Some(joint));
        body["j"] = json!(j);
        body
    }))
    .collect();
    let joints: Value = (model.joints().zip(model.places()))
        .map(|(joint, place)| {
            json!({ "name": joint.name, "kind": joint.kind.name(), "q": place.q, "j": place.j, "limits": joint.limits.position })
        })
        .collect();

    let anchor = |anchor: &Anchor| json!(anchor.frame);
    let constraints = model.constraints().iter().filter_map(|constraint| match &constraint.kind {
        ConstraintKind::Frames { a, b, .. } => Some(json!({ "name": constraint.name, "a": anchor(a), "b": anchor(b) })),
        ConstraintKind::Joint { .. } => None,
    });
    let states = model.state_names().map(|name| Ok(json!({ "name": name, "theta": model.state(name)?.theta })));
    Ok(json!({
        "name": model.description().name,
        "states": states.collect::<Result<Value, Error>>()?,
        "start": model.start().theta,
        "neutral": model.neutral_configuration::<f64>(),
        "base": if model.is_floating() { "floating" } else { "fixed" },
        "positions": model.position_names().collect::<Vec<_>>(),
        "velocities": model.velocity_names().collect::<Vec<_>>(),
        "joints": joints,
        "bodies": std::iter::once(body(0, None)).chain(moving).collect::<Value>(),
        "constraints": constraints.collect::<Value>(),
        "frames": named,
        "endEffector": model.end_effector().ok().and_then(|frame| frame_of(model.frame_name(frame))),
        "weighs": model.mass() > 0.0,
        "inputs": INPUTS.iter().zip(inputs).map(|(input, numbers)| json!({
            "name": input.name, "symbol": input.symbol, "unit": input.unit, "about": input.about, "length": numbers.len(),
        })).collect::<Value>(),
        "quantities": quantities(),
    }))
}

/// The lines about or along which a joint moves, each by a point and a direction: none of a free joint.
fn lines(kind: JointKind) -> Vec<Value> {
    let line = |point: Vec3, direction: Vec3| json!({ "point": point.0, "direction": direction.0 });
    match kind {
        JointKind::Screw(A) if A.is_prismatic() => vec![line(Vec3::zero(), A.twist().v)],
        JointKind::Screw(A) => vec![line(A.twist().w.cross(A.twist().v), A.twist().w)],
        JointKind::Ball(center) => {
            [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|axis| line(center, Vec3(axis))).to_vec()
        }
        JointKind::Free | JointKind::Fixed => Vec::new(),
    }
}

/// The homogeneous ellipsoid with this mass and inertia about its centre: unit vectors and lengths of its semi-axes.
/// None of a massless body.
fn ellipsoid(G: &SpatialInertia) -> Value {
    if !(G.mass > 0.0) {
        return Value::Null;
    }
    let Sym3 { xx, xy, xz, yy, yz, zz } = G.about_center_of_mass();
    let principal = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz).symmetric_eigen();
    let [a, b, c] = principal.eigenvalues.into();
    let length = |x: f64, y: f64, z: f64| (5.0 * (y + z - x) / (2.0 * G.mass)).max(0.0).sqrt();
    let axes: Vec<[f64; 3]> = principal.eigenvectors.column_iter().map(|column| column.into_owned().into()).collect();
    json!({ "axes": axes, "lengths": [length(a, b, c), length(b, c, a), length(c, a, b)] })
}

/// Names, formulas, inputs and outputs of all quantities.
fn quantities() -> Value {
    let of_list = LIST.iter().map(|quantity| {
        let of = match quantity.of {
            Of::Robot => "robot",
            Of::Frame => "frame",
            Of::Task => "task",
            Of::Point => "point",
        };
        let inputs: Vec<_> = quantity.inputs.iter().map(|input| input.name).collect();
        let outputs: Vec<_> = quantity.outputs.iter().map(|output| output.name).collect();
        json!({ "name": quantity.name, "formula": quantity.formula, "of": of, "inputs": inputs, "outputs": outputs })
    });
    let drawn = drawn::LIST.iter().map(|drawn| {
        let of = if drawn.of_frame { "frame" } else { "robot" };
        json!({ "name": drawn.name, "formula": drawn.formula, "of": of, "inputs": drawn.inputs })
    });
    of_list.chain(drawn).collect()
}

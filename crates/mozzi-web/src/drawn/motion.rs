//! Velocities of the bodies, and the wrenches that their joints transmit, in {s}.

use super::{Call, Drawn, output};
use crate::request::Output;
use mozzi::{BodyFrame, Error, Model, SE3, Twist, Wrench};

/// Motion and joint wrench of the base and of each moving link.
pub const BODY_MOTION: Drawn = Drawn {
    name: "body_motion",
    formula: "of each body the centre of mass c and its velocity, ω, the point p at which its joint acts, and the \
              moment about p and the force that the joint transmits; all in {s}",
    inputs: &["theta", "dtheta", "ddtheta"],
    of_frame: false,
    outputs,
    compute,
};

fn outputs(model: &Model) -> Vec<Output> {
    let of_each = |name, unit| output(name, [model.moving_joints().count() + 1, 3], unit);
    vec![
        of_each("center", "m"),
        of_each("center_velocity", "m/s"),
        of_each("angular_velocity", "rad/s"),
        of_each("point", "m"),
        of_each("moment", "N m"),
        of_each("force", "N"),
    ]
}

fn compute(call: &Call) -> Result<Vec<f64>, Error> {
    let Call { model, bodies, inputs, environment, .. } = call;
    let [theta, dtheta, ddtheta] = inputs else { unreachable!("three inputs") };
    let found = model.newton_euler(theta, dtheta, ddtheta, environment, BodyFrame::Link)?;
    let poses = model.frame_poses(theta)?;
    let ids: Vec<_> = model.frames().map(|(id, _)| id).collect();
    let pose = |k: usize| {
        let place = bodies.frames[k].and_then(|frame| ids.iter().position(|id| *id == frame));
        place.map_or(SE3::identity(), |place| poses[place])
    };
    let of_base = match (model.is_floating(), dtheta.first_chunk()) {
        (true, Some(&V)) => Twist::from_array(V),
        _ => environment.base_twist,
    };
    let twists = std::iter::once(of_base).chain(found.twists);
    let wrenches = std::iter::once(found.base_reaction).chain(found.wrenches);
    let mut columns: [Vec<f64>; 6] = Default::default();
    for (k, (V, F)) in twists.zip(wrenches).enumerate() {
        let (T, c, p) = (pose(k), bodies.inertias[k].center_of_mass(), bodies.points[k]);
        let at_center: Twist = SE3::translation(c.0).inverse().Ad() * V;
        let at_point: Wrench = SE3::translation(p.0).Ad().transpose() * F;
        let vectors = [T * c, T.R * at_center.v, T.R * V.w, T * p, T.R * at_point.m, T.R * F.f];
        columns.iter_mut().zip(vectors).for_each(|(column, vector)| column.extend(vector.0));
    }
    Ok(columns.concat())
}

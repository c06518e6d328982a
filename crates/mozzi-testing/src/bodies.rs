//! Poses and motions of the links, straight from the description: exponentials along the joints' own screws, link by
//! link.

use mozzi::model::description::{Joint, JointKind};
use mozzi::{Base, Description, Model, Place, Real, SE3, SO3, Scalar, SpatialInertia, Twist, Vec3, Wrench};
use std::collections::HashMap;

/// A link of the description.
pub struct Body<S> {
    /// Its name.
    pub name: String,
    /// `T_sb`.
    pub T: SE3<S>,
    /// The columns of its body Jacobian.
    pub J: Vec<Twist<S>>,
    /// In its own frame; none if a fixed base carries it.
    pub G: Option<SpatialInertia<S>>,
}

/// The source joint of a joint, itself if independent: θ of the joint = ratio · θ of the source + offset.
pub fn source<'r, C: Scalar>(robot: &'r Description<C>, joint: &'r Joint<C>) -> (&'r Joint<C>, C, C) {
    let (mut source, mut ratio, mut offset) = (joint, C::one(), C::zero());
    while let Some(mimic) = &source.mimic {
        (offset, ratio) = (offset + ratio * mimic.offset, ratio * mimic.ratio);
        source = robot.joints.iter().find(|other| other.name == mimic.joint).expect("a joint");
    }
    (source, ratio, offset)
}

/// The links of a robot, parents before children. `model` gives only the order of its joints; all numbers are from
/// `robot`.
pub fn bodies<S: Real>(robot: &Description<S>, model: &Model<S>, theta: &[S]) -> Vec<Body<S>> {
    let n = model.n();
    let index: HashMap<&str, Place> = model.joint_names().zip(model.places().iter().copied()).collect();
    let is_child = |name: &str| robot.joints.iter().any(|joint| joint.child == name);
    let root = robot.links.iter().find(|link| !is_child(&link.name)).expect("a root");
    let floats = model.base() == Base::Floating;
    let mut J = vec![Twist::zero(); n];
    let mut T = SE3::identity();
    if let (true, Some(&pose)) = (floats, theta.first_chunk()) {
        T = SE3::from_pose(pose);
        J[..6].copy_from_slice(&Twist::axes());
    }
    let mut all = vec![Body { name: root.name.clone(), T, J, G: floats.then_some(root.inertia) }];
    let mut at = 0;
    while at < all.len() {
        let name = all[at].name.clone();
        for joint in robot.joints.iter().filter(|joint| joint.parent == name) {
            let (source, ratio, offset) = source(robot, joint);
            let parent = &all[at];
            let (mut inverse, mut moves) = (joint.origin.inverse(), parent.G.is_some());
            let mut columns = Vec::new();
            if let Some(Place { q, j, .. }) = index.get(source.name.as_str()) {
                let theta = &theta[*q..];
                let moved = match joint.kind {
                    JointKind::Fixed => SE3::identity(),
                    JointKind::Screw(axis) => {
                        columns.push((*j, axis.twist() * ratio));
                        SE3::exp(axis.twist() * (ratio * theta[0] + offset))
                    }
                    JointKind::Ball(center) => {
                        let (there, back) =
                            (SE3 { p: center, ..SE3::identity() }, SE3 { p: -center, ..SE3::identity() });
                        columns.extend((0..3).map(|k| (*j + k, there.Ad() * Twist::axes()[k])));
                        there
                            * SE3 {
                                R: SO3::from_quaternion(theta[0], Vec3([theta[1], theta[2], theta[3]])),
                                p: Vec3::zero(),
                            }
                            * back
                    }
                    JointKind::Free => {
                        columns.extend((0..6).map(|k| (*j + k, Twist::axes()[k])));
                        SE3::from_pose(std::array::from_fn(|k| theta[k]))
                    }
                };
                inverse = moved.inverse() * inverse;
                moves |= joint.kind != JointKind::Fixed;
            }
            let mut J: Vec<Twist<S>> = parent.J.iter().map(|&column| inverse.Ad() * column).collect();
            for (j, A) in columns {
                J[j] += A;
            }
            let inertia = robot.links.iter().find(|link| link.name == joint.child).expect("a link").inertia;
            let T = parent.T * inverse.inverse();
            all.push(Body { name: joint.child.clone(), T, J, G: moves.then_some(inertia) });
        }
        at += 1;
    }
    all
}

/// A frame's configuration and body Jacobian, by its name.
pub fn frame<S: Real>(robot: &Description<S>, model: &Model<S>, theta: &[S], name: &str) -> (SE3<S>, Vec<Twist<S>>) {
    let all = bodies(robot, model, theta);
    let added = robot.frames.iter().find(|frame| frame.name == name);
    let (link, fixed) = added.map_or((name, SE3::identity()), |frame| (&frame.link, frame.T));
    let body = all.into_iter().find(|body| body.name == link).expect("a link");
    (body.T * fixed, body.J.into_iter().map(|column| fixed.inverse().Ad() * column).collect())
}

/// Jθ̇.
pub fn twist<S: Real>(J: &[Twist<S>], dtheta: &[S]) -> Twist<S> {
    J.iter().zip(dtheta).fold(Twist::zero(), |V, (&column, &rate)| V + column * rate)
}

/// The columns of the momentum matrix about the origin of {s}: Σ [Ad_T⁻¹]ᵀ 𝒢 J.
pub fn momentum_columns<S: Real>(robot: &Description<S>, model: &Model<S>, theta: &[S]) -> Vec<Wrench<S>> {
    let mut columns = vec![Wrench::zero(); model.n()];
    for body in bodies(robot, model, theta) {
        let Some(G) = body.G else { continue };
        for (sum, &column) in columns.iter_mut().zip(&body.J) {
            *sum += body.T.inverse().Ad().transpose() * (G * column);
        }
    }
    columns
}

/// The mass, and the mass times the centre of mass in {s}.
pub fn moments<S: Real>(robot: &Description<S>, model: &Model<S>, theta: &[S]) -> (S, Vec3<S>) {
    let masses = bodies(robot, model, theta).into_iter().filter_map(|body| Some((body.G?, body.T)));
    masses.fold((S::zero(), Vec3::zero()), |(mass, first), (G, T)| {
        (mass + G.mass, if G.mass > S::zero() { first + (T.R * G.mc + T.p * G.mass) } else { first })
    })
}

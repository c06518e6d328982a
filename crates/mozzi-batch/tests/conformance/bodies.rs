//! Where each link is and how it moves, straight from the description: exponentials along the joints' own screws, link by link.

use mozzi::model::description::JointKind;
use mozzi::{Base, Model, Real, SE3, SpatialInertia, Twist, Vec3, Wrench};
use std::collections::HashMap;

/// A link of the description.
pub struct Body<S> {
    pub name: String,
    /// `T_sb`.
    pub T: SE3<S>,
    /// The columns of its body Jacobian.
    pub J: Vec<Twist<S>>,
    /// In its own frame; none of what a fixed base carries.
    pub G: Option<SpatialInertia>,
}

/// The links of a robot, parents before children.
pub fn bodies<S: Real>(model: &Model, theta: &[S]) -> Vec<Body<S>> {
    let (robot, n) = (model.description(), model.n());
    let (positions, velocities) = (model.base().positions(), model.base().velocities());
    let index: HashMap<&str, usize> = model.joint_names().enumerate().map(|(k, name)| (name, k)).collect();
    let joint_of: HashMap<&str, _> = robot.joints.iter().map(|joint| (joint.name.as_str(), joint)).collect();
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
            // θ of the joint = ratio · θ of the source joint + offset, along a chain of mimic joints
            let (mut source, mut ratio, mut offset) = (joint, 1.0, 0.0);
            while let Some(mimic) = &source.mimic {
                (offset, ratio) = (offset + ratio * mimic.offset, ratio * mimic.ratio);
                source = joint_of[mimic.joint.as_str()];
            }
            let parent = &all[at];
            let (mut inverse, mut moves) = (joint.origin.map(S::from_f64).inverse(), parent.G.is_some());
            let mut column = None;
            if let JointKind::Screw(axis) = joint.kind {
                let (j, A) = (index[source.name.as_str()], axis.twist().map(S::from_f64));
                let turned = SE3::exp(A * (S::from_f64(ratio) * theta[positions + j] + S::from_f64(offset)));
                inverse = turned.inverse() * inverse;
                column = Some((velocities + j, A * S::from_f64(ratio)));
                moves = true;
            }
            let mut J: Vec<Twist<S>> = parent.J.iter().map(|&column| inverse.Ad() * column).collect();
            if let Some((j, A)) = column {
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
pub fn frame<S: Real>(model: &Model, theta: &[S], name: &str) -> (SE3<S>, Vec<Twist<S>>) {
    let all = bodies(model, theta);
    let added = model.description().frames.iter().find(|frame| frame.name == name);
    let (link, fixed) = added.map_or((name, SE3::identity()), |frame| (&frame.link, frame.T));
    let body = all.into_iter().find(|body| body.name == link).expect("a link");
    let fixed = fixed.map(S::from_f64);
    (body.T * fixed, body.J.into_iter().map(|column| fixed.inverse().Ad() * column).collect())
}

/// Jθ̇.
pub fn twist<S: Real>(J: &[Twist<S>], dtheta: &[S]) -> Twist<S> {
    J.iter().zip(dtheta).fold(Twist::zero(), |V, (&column, &rate)| V + column * rate)
}

/// The columns of the momentum's matrix about the origin of {s}: Σ [Ad_T⁻¹]ᵀ 𝒢 J.
pub fn momentum_columns<S: Real>(model: &Model, theta: &[S]) -> Vec<Wrench<S>> {
    let mut columns = vec![Wrench::zero(); model.n()];
    for body in bodies(model, theta) {
        let Some(G) = body.G.map(|G| G.map(S::from_f64)) else { continue };
        for (sum, &column) in columns.iter_mut().zip(&body.J) {
            *sum += body.T.inverse().Ad().transpose() * (G * column);
        }
    }
    columns
}

/// The mass, and the mass times the centre of mass in {s}.
pub fn moments(model: &Model, theta: &[f64]) -> (f64, Vec3) {
    let masses = bodies(model, theta).into_iter().filter_map(|body| Some((body.G?, body.T)));
    masses.fold((0.0, Vec3::zero()), |(mass, first), (G, T)| {
        (mass + G.mass, if G.mass > 0.0 { first + (T.R * G.mc + T.p * G.mass) } else { first })
    })
}

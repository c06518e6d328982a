//! `springdamper`: the stiffness and the damping that MuJoCo chooses for a joint.

use super::tree::Joint;
use crate::report::finding::Finding;
use crate::text::context::Context;
use mozzi::quantities::MassMatrixInverse;
use mozzi::{Description, Freedom, Place};

/// MuJoCo's springdamper: time constant and damping ratio instead of stiffness and damping.
#[derive(Clone, Copy)]
pub(crate) struct SpringDamper {
    /// T, s.
    pub time: f64,
    /// ζ.
    pub ratio: f64,
    /// Whether springs are enabled.
    pub spring: bool,
    /// Whether dampers are enabled.
    pub damper: bool,
}

/// A joint's own configuration, its [`SpringDamper`], and its place in the file.
pub(crate) type Tuning = (f64, Option<(SpringDamper, std::ops::Range<usize>)>);

/// The data that the description needs from the joints of a tree, in joint order.
pub(crate) fn tunings(joints: &[Joint]) -> Vec<Tuning> {
    let tuning = |joint: &Joint| {
        let spring_damper = joint.spring_damper.map(|tuned| (tuned, joint.place.span("springdamper")));
        (joint.reference, spring_damper)
    };
    joints.iter().map(tuning).collect()
}

/// As MuJoCo's compiler: k = I / (T ζ)² and d = 2 I / T with the inertia I = 1 / (M⁻¹)_jj at the file's configuration,
/// all joints independent. Nothing is computed for a robot that is refused for another reason.
pub(crate) fn tune(robot: &mut Description, tunings: &[Tuning], cx: &mut Context) {
    if tunings.iter().all(|(_, tuned)| tuned.is_none()) {
        return;
    }
    let mut free = robot.clone();
    free.joints.iter_mut().for_each(|joint| joint.mimic = None);
    let Ok(model) = free.build() else { return };
    let place = |name: &str| robot.joints.iter().position(|joint| joint.name == name);
    let of_one_axis = |(place, _): &(&Place, usize)| place.freedom == Freedom::One;
    let places = model.places().iter().zip(model.joint_names().filter_map(place)).filter(of_one_axis);
    let joints: Vec<(&Place, usize)> = places.collect();
    let mut theta = model.neutral_configuration::<f64>();
    for &(place, i) in &joints {
        theta[place.q] = tunings[i].0;
    }
    let inverse = model.compute(MassMatrixInverse, &[&theta], &model.environment());
    for (&Place { j, .. }, i) in joints {
        let Some((tuned, span)) = &tunings[i].1 else { continue };
        let Ok(inverse) = &inverse else {
            let message = format!(
                "joint `{}`: springdamper: the mass matrix is singular, expected an inertia",
                robot.joints[i].name
            );
            let help = "write `stiffness` and `damping` instead";
            cx.findings.add(Finding::error("unsupported_attribute", span.clone(), message).help(help));
            continue;
        };
        let (inertia, joint) = (1.0 / inverse[0][j * (model.n() + 1)], &mut robot.joints[i]);
        joint.stiffness = if tuned.spring { inertia / (tuned.time * tuned.ratio).powi(2) } else { 0.0 };
        joint.damping = if tuned.damper { 2.0 * inertia / tuned.time } else { 0.0 };
    }
}

//! `springdamper` and `dampratio`: the stiffness and the damping that MuJoCo chooses for joints and actuators.

use super::actuator::Actuator;
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

/// The mobility of a robot at its file's configuration with all joints independent, as in MuJoCo's compiler.
struct Mobility {
    /// Each joint of one axis: its place in θ̇, and its number in the description.
    joints: Vec<(usize, usize)>,
    n: usize,
    /// M⁻¹, if M is regular.
    inverse: Option<Vec<f64>>,
}

impl Mobility {
    /// None for a robot that is refused for another reason.
    fn of(robot: &Description, tunings: &[Tuning]) -> Option<Self> {
        let mut free = robot.clone();
        free.joints.iter_mut().for_each(|joint| joint.mimic = None);
        let model = free.build().ok()?;
        let number = |name: &str| robot.joints.iter().position(|joint| joint.name == name);
        let of_one_axis = |(place, _): &(&Place, usize)| place.freedom == Freedom::One;
        let places = model.places().iter().zip(model.joint_names().filter_map(number)).filter(of_one_axis);
        let mut theta = model.neutral_configuration::<f64>();
        let mut joints = Vec::new();
        for (place, i) in places {
            theta[place.q] = tunings[i].0;
            joints.push((place.j, i));
        }
        let inverse = model.compute(MassMatrixInverse, &[&theta], &model.environment());
        let inverse = inverse.ok().and_then(|found| found.into_iter().next());
        Some(Mobility { joints, n: model.n(), inverse })
    }

    /// The inertia 1 / (J M⁻¹Jᵀ) that moves with l = Jθ, given by joints and ∂l/∂θ; None if M is singular.
    fn inertia(&self, gears: &[(usize, f64)]) -> Option<f64> {
        let inverse = self.inverse.as_ref()?;
        let entry = |j: usize, k: usize| inverse[j * self.n + k];
        let row = |&(j, a): &(usize, f64)| gears.iter().map(|&(k, b)| a * b * entry(j, k)).sum::<f64>();
        Some(1.0 / gears.iter().map(row).sum::<f64>()).filter(|inertia| inertia.is_finite())
    }
}

/// A positive b₂ of a position actuator is its damping ratio ζ: the damping is 2ζ √(k I) with the inertia I that its
/// length moves.
pub(crate) fn damp(actuators: &mut [Option<Actuator>], robot: &Description, tunings: &[Tuning]) {
    let has_ratio = |one: &&mut Actuator| one.bias[2] > 0.0 && one.gain[0] == -one.bias[1];
    let mut known = None;
    for one in actuators.iter_mut().flatten().filter(has_ratio) {
        let Some(mobility) = known.get_or_insert_with(|| Mobility::of(robot, tunings)) else { return };
        let place = |name: &str| mobility.joints.iter().find(|(_, i)| robot.joints[*i].name == name).map(|(j, _)| *j);
        let gears: Vec<_> = one.gears.iter().filter_map(|(name, gear)| Some((place(name)?, *gear))).collect();
        one.bias[2] *= -2.0 * (one.gain[0] * mobility.inertia(&gears).unwrap_or(0.0)).sqrt();
    }
}

/// As MuJoCo's compiler: k = I / (T ζ)² and d = 2 I / T with the inertia I = 1 / (M⁻¹)_jj.
pub(crate) fn tune(robot: &mut Description, tunings: &[Tuning], cx: &mut Context) {
    if tunings.iter().all(|(_, tuned)| tuned.is_none()) {
        return;
    }
    let Some(mobility) = Mobility::of(robot, tunings) else { return };
    for &(j, i) in &mobility.joints {
        let Some((tuned, span)) = &tunings[i].1 else { continue };
        let Some(inertia) = mobility.inertia(&[(j, 1.0)]) else {
            let message = format!(
                "joint `{}`: springdamper: the mass matrix is singular, expected an inertia",
                robot.joints[i].name
            );
            let help = "write `stiffness` and `damping` instead";
            cx.findings.add(Finding::error("unsupported_attribute", span.clone(), message).help(help));
            continue;
        };
        let joint = &mut robot.joints[i];
        joint.stiffness = if tuned.spring { inertia / (tuned.time * tuned.ratio).powi(2) } else { 0.0 };
        joint.damping = if tuned.damper { 2.0 * inertia / tuned.time } else { 0.0 };
    }
}
